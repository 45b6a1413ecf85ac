/* SPDX-License-Identifier: GPL-3.0-or-later
 * fuzz.h: what a fuzzer expects of the library besides not crashing. The replay program brings its own
 * FUZZ_BROKEN. */
#ifndef PERIGAL_TEST_FUZZ_H
#define PERIGAL_TEST_FUZZ_H
#include "perigal/base.h"
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#ifndef FUZZ_BROKEN
#define FUZZ_BROKEN(what) \
    do { \
        fprintf (stderr, "broken: %s; last error: %s\n", (what), pg_last_error ()); \
        __builtin_trap (); \
    } while (0)
#endif
#define FUZZ_EXPECT(condition) do { if (!(condition)) FUZZ_BROKEN (#condition); } while (0)

enum { LONGEST = 1 << 13 };                            /* bytes of an input */
#endif
int LLVMFuzzerTestOneInput (const uint8_t *data, size_t size);

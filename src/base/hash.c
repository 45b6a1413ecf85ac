/* SPDX-License-Identifier: GPL-3.0-or-later
 * A fingerprint of bytes, FNV-1a of 64 bits: each byte is folded in by an exclusive or and a
 * multiplication with a prime that is odd, so that one changed byte always changes the result. Fast, and
 * no protection against people: for that there is SHA-256 (src/scene).
 * http://www.isthe.com/chongo/tech/comp/fnv/ */
#include "perigal/base.h"
#include <string.h>

uint64_t pg_fingerprint (uint64_t so_far, const void *data, size_t bytes)
{
    const unsigned char *byte = data;
    for (size_t i = 0; data && i < bytes; i++) so_far = (so_far ^ byte[i]) * 1099511628211u;
    return so_far;
}

uint64_t pg_fingerprint_numbers (uint64_t so_far, size_t n, size_t step, const double *value)
{
    for (size_t k = 0; k < n; k += step) {
        uint64_t bits;
        memcpy (&bits, value + k, sizeof bits);
        so_far = (so_far ^ bits) * 0xff51afd7ed558ccdu;
        so_far ^= so_far >> 32;
    }
    return so_far;
}

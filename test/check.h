/* SPDX-License-Identifier: GPL-3.0-or-later
 * check.h: cmocka with comparisons of doubles that print both numbers; every test program includes this
 * first. */
#ifndef PERIGAL_TEST_CHECK_H
#define PERIGAL_TEST_CHECK_H
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "perigal/base.h"

/* 1 if the tests are to run in full size (PERIGAL_TEST_SIZE=long, make test-long). */
static inline int longer (void)
{
    const char *size = getenv ("PERIGAL_TEST_SIZE");
    return size && strcmp (size, "long") == 0;
}

/* renamed by the build when all tests of a folder become one program, which test/main.c starts */
int main (void);

/* Fails the test unless |a - b| <= tolerance * max (|b|, scale), which is never true for NaN. */
static inline void check_near_at (double a, double b, double tolerance, double scale, const char *what,
                                  const char *file, int line)
{
    double size = fabs (b) > scale ? fabs (b) : scale;
    if (fabs (a - b) <= tolerance * size) return;
    print_error ("%s = %.17g, expected %.17g, off by %.3g of %.3g (allowed %.3g)\n", what, a, b, fabs (a - b),
                 size, tolerance);
    _fail (file, line);
}
/* check_near_at with scale 0, with scale 1 (for small numbers), and with a given scale. */
#define check_relative(a, b, tolerance) check_near_at ((a), (b), (tolerance), 0, #a, __FILE__, __LINE__)
#define check_absolute(a, b, tolerance) check_near_at ((a), (b), (tolerance), 1, #a, __FILE__, __LINE__)
#define check_scaled(a, b, tolerance, scale) \
    check_near_at ((a), (b), (tolerance), (scale), #a, __FILE__, __LINE__)
/* Fails the test, with the error message of the program, unless the call returns PG_OK. */
#define check_ok(call) \
    do { \
        pg_status s_ = (call); \
        if (s_ != PG_OK) { \
            print_error ("%s: %s: %s\n", #call, pg_status_text (s_), pg_last_error ()); \
            _fail (__FILE__, __LINE__); \
        } \
    } while (0)
#define check_fails(call, code) \
    do { \
        pg_status s_ = (call); \
        if (s_ != (code)) { \
            print_error ("%s gave '%s', expected '%s'\n", #call, pg_status_text (s_), \
                         pg_status_text (code)); \
            _fail (__FILE__, __LINE__); \
        } \
    } while (0)
#define check_below(a, limit) do { double a_ = (a), l_ = (limit); if (!(a_ <= l_)) { \
    print_error ("%s = %.6g, must be <= %.6g\n", #a, a_, l_); _fail (__FILE__, __LINE__); } } while (0)
#define check_contains(text, part) do { if (!strstr ((text), (part))) { \
    print_error ("'%s' does not contain '%s'\n", (text), (part)); _fail (__FILE__, __LINE__); } } while (0)
#endif

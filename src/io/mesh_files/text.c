/* SPDX-License-Identifier: GPL-3.0-or-later
 * Lines and numbers of text files. Mesh files are long, so that numbers are converted here; strtod is
 * called only where the quick way would not give the last bit. */
#include "format.h"
#include <limits.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* A file may begin with the byte order mark of UTF-8. */
mesh_cursor mesh_begin (const mesh_file *file)
{
    size_t mark = file->size >= 3 && !memcmp (file->text, "\xEF\xBB\xBF", 3) ? 3 : 0;
    return (mesh_cursor) { file, file->text + mark, file->text + file->size, 0 };
}

/* Lines are counted from 1; the last one may lack its end. */
int mesh_line (mesh_cursor *c, const char **first, const char **last)
{
    if (c->at >= c->end) return 0;
    const char *stop = memchr (c->at, '\n', (size_t) (c->end - c->at));
    *first = c->at;
    *last = stop ? stop : c->end;
    c->at = stop ? stop + 1 : c->end;
    if (*last > *first && (*last)[-1] == '\r') --*last;
    c->line++;
    return 1;
}

/* Moves *at behind blanks and tabs. */
static void skip_blanks (const char **at, const char *last)
{
    while (*at < last && (**at == ' ' || **at == '\t')) ++*at;
}

/* Numbers that do not fit a long are no numbers. */
int mesh_whole (const char **at, const char *last, long *value)
{
    skip_blanks (at, last);
    const char *p = *at;
    int minus = p < last && *p == '-';
    unsigned long sum = 0;
    p += p < last && (*p == '-' || *p == '+');
    const char *digits = p;
    for (; p < last && *p >= '0' && *p <= '9'; p++) {
        /* The next digit could overflow. */
        if (sum > (LONG_MAX - 9) / 10) return 0;
        sum = 10 * sum + (unsigned long) (*p - '0');
    }
    if (p == digits) return 0;
    *value = minus ? -(long) sum : (long) sum;
    *at = p;
    return 1;
}

/* Converts a number by strtod, after D exponents of Fortran have become e. 0: no number, not finite, or too
 * long to be one. */
static int slow_real (const char *first, const char *last, double *value)
{
    enum { LONGEST = 400 };
    char text[LONGEST], *end;
    size_t n = (size_t) (last - first);
    if (n >= LONGEST) return 0;
    /* strtod does not know Fortran's exponents. */
    for (size_t k = 0; k < n; k++) text[k] = first[k] == 'D' || first[k] == 'd' ? 'e' : first[k];
    text[n] = '\0';
    *value = strtod (text, &end);
    return end == text + n && isfinite (*value);
}

static int is_digit (char c) { return c >= '0' && c <= '9'; }

/* The digits of a decimal number: their value as a whole number while it fits 2^53 (exact), how many there
 * are, and how many stand behind the point. */
typedef struct { uint64_t sum; long count, behind_point; int exact; } digits;

/* Reads digits with at most one decimal point between them; returns the position behind them. */
static const char *read_digits (const char *p, const char *last, digits *d)
{
    int point = 0;
    *d = (digits) { .exact = 1 };
    for (; p < last && (is_digit (*p) || (*p == '.' && !point)); p++) {
        if (*p == '.') {
            point = 1;
            continue;
        }
        d->count++, d->behind_point += point;
        /* Below 2^53 / 10 another digit keeps the sum exact. */
        if (d->sum < UINT64_C (900719925474099)) d->sum = 10 * d->sum + (uint64_t) (*p - '0');
        else d->exact = 0;
    }
    return p;
}

/* Reads an exponent such as e-3 or D+02, if there is one. Returns the position behind it; NULL: a letter
 * without a number. */
static const char *read_exponent (const char *p, const char *last, long *exponent)
{
    if (p >= last || !*p || !strchr ("eEdD", *p)) return p;
    const char *q = p + 1;
    if (q >= last || *q == ' ' || *q == '\t' || !mesh_whole (&q, last, exponent)) return NULL;
    return q;
}

/* Where the digits fit 2^53 and the power of ten is at most 10^22, both are exact in binary and one
 * rounding remains: the result is the nearest double (Clinger 1990). */
int mesh_real (const char **at, const char *last, double *value)
{
    static const double power[] = { 1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                    1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22 };
    skip_blanks (at, last);
    const char *p = *at, *first = p;
    digits d;
    long exponent = 0;
    int minus = p < last && *p == '-';
    p += p < last && (*p == '-' || *p == '+');
    p = read_digits (p, last, &d);
    if (d.count == 0) return 0;
    p = read_exponent (p, last, &exponent);
    if (!p) return 0;
    *at = p;
    exponent -= d.behind_point;
    /* Too many digits or too large a power for one exact operation. */
    if (!d.exact || exponent < -22 || exponent > 22) return slow_real (first, p, value);
    *value = exponent < 0 ? (double) d.sum / power[-exponent] : (double) d.sum * power[exponent];
    if (minus) *value = -*value;
    return 1;
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * SHA-256 after FIPS 180-4. The constants are computed as the standard defines them, from roots of primes,
 * instead of being copied. */
#include "sha256.h"
#include <pthread.h>
#include <stdio.h>
#include <string.h>

/* Constants of the rounds and of the first state. */
static uint32_t K[64], H0[8];
static pthread_once_t once = PTHREAD_ONCE_INIT;

/* First 32 bits of the fractional part of the square (order 2) or cube root (3) of p: the largest x / 2^32
 * with x^order <= p, in whole numbers. */
static uint32_t root_bits (unsigned p, int order)
{
    uint64_t x = 0;
    for (int bit = 35; bit >= 0; bit--) {
        unsigned __int128 y = x | (uint64_t) 1 << bit,
                          limit = (unsigned __int128) p << (order == 2 ? 64 : 96);
        if (order == 2 ? y * y <= limit : y * y <= limit / y) x = (uint64_t) y;
    }
    return (uint32_t) x;
}

/* From the first 64 primes. */
static void constants (void)
{
    unsigned n = 0;
    for (unsigned p = 2; n < 64; p++) {
        unsigned d = 2;
        while (d < p && p % d) d++;
        if (d < p) continue;
        if (n < 8) H0[n] = root_bits (p, 2);
        K[n++] = root_bits (p, 3);
    }
}

/* Rotation to the right. */
static uint32_t turn (uint32_t x, int n) { return x >> n | x << (32 - n); }

/* One block of 64 bytes into the state (section 6.2.2 of the standard). */
static void mix (uint32_t h[8], const unsigned char *block)
{
    uint32_t w[64], v[8];
    for (int t = 0; t < 16; t++)
        w[t] = (uint32_t) block[4 * t] << 24 | (uint32_t) block[4 * t + 1] << 16
               | (uint32_t) block[4 * t + 2] << 8 | block[4 * t + 3];
    for (int t = 16; t < 64; t++) {
        uint32_t a = w[t - 15], b = w[t - 2];
        w[t] = w[t - 16] + (turn (a, 7) ^ turn (a, 18) ^ a >> 3) + w[t - 7]
               + (turn (b, 17) ^ turn (b, 19) ^ b >> 10);
    }
    memcpy (v, h, sizeof v);
    for (int t = 0; t < 64; t++) {
        uint32_t a = v[0], e = v[4];
        uint32_t one = v[7] + (turn (e, 6) ^ turn (e, 11) ^ turn (e, 25)) + ((e & v[5]) ^ (~e & v[6])) + K[t]
                       + w[t];
        uint32_t two = (turn (a, 2) ^ turn (a, 13) ^ turn (a, 22))
                       + ((a & v[1]) ^ (a & v[2]) ^ (v[1] & v[2]));
        memmove (v + 1, v, 7 * sizeof *v);
        v[4] += one;
        v[0] = one + two;
    }
    for (int k = 0; k < 8; k++) h[k] += v[k];
}

void pg_sha256_start (pg_sha256 *s)
{
    pthread_once (&once, constants);
    memset (s, 0, sizeof *s);
    memcpy (s->h, H0, sizeof H0);
}

/* Blocks of 64 bytes are mixed as they become full. */
void pg_sha256_add (pg_sha256 *s, const void *data, size_t n)
{
    const unsigned char *p = data;
    for (size_t k = 0; k < n; k++) {
        s->block[s->length++ % 64] = p[k];
        if (s->length % 64 == 0) mix (s->h, s->block);
    }
}

/* Padding: a bit, zeros, the length in bits. */
void pg_sha256_end (pg_sha256 *s, char hex[65])
{
    uint64_t bits = s->length * 8;
    unsigned char size[8];
    for (int k = 0; k < 8; k++) size[k] = (unsigned char) (bits >> (56 - 8 * k));
    pg_sha256_add (s, "\x80", 1);
    while (s->length % 64 != 56) pg_sha256_add (s, "", 1);
    pg_sha256_add (s, size, 8);
    for (int k = 0; k < 8; k++) snprintf (hex + 8 * k, 9, "%08x", (unsigned) s->h[k]);
}

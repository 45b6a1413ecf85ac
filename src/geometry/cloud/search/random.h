/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: random numbers that are the same on every machine: a generator of whole numbers (Mersenne twister,
 * Matsumoto and Nishimura 1998) and distributions from additions, multiplications, divisions and square roots
 * alone, which IEEE 754 defines to the last bit. log, exp, sin and cos of the C library are not so defined:
 * two libraries may differ in the last digit, and a crack that just fits on one machine might not on
 * another. */
#ifndef PERIGAL_CLOUD_RANDOM_H
#define PERIGAL_CLOUD_RANDOM_H
#include <stdint.h>

/* State of the generator. */
typedef struct { uint32_t word[624]; int at; } random_source;
void     random_start (random_source *r, uint32_t seed);
uint32_t random_word  (random_source *r);
/* Uniform in (0, 1): 52 bits, never an end. */
double random_uniform (random_source *r);
/* Mean 0, deviation 1 (Marsaglia's polar method). */
double random_normal  (random_source *r);
/* Direction (cos, sin) of an angle of von Mises' distribution about 0 (Best and Fisher 1979). */
void   random_von_mises (random_source *r, double concentration, double direction[2]);
/* Unit vector of Fisher's distribution about the z axis; concentration 0: uniform on the sphere. */
void   random_fisher    (random_source *r, double concentration, double direction[3]);

/* Uniform in [-1, 1), a function of seed, site and axis only: independent of order and threads. */
double pg_place_shift (uint64_t seed, uint64_t site, int axis);

/* Elementary functions to a few units in the last place, the same bits everywhere. */
double settled_log (double x);
double settled_exp (double x);
/* x^y, x > 0 */
double settled_power (double x, double y);
/* cos and sin of an angle, rad. */
void   settled_angle (double angle, double *cosine, double *sine);
#endif

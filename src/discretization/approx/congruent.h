/* SPDX-License-Identifier: GPL-3.0-or-later
 * congruent.h: positions around which the nodes lie alike have the same shape functions, and on a lattice
 * almost all do: in a body of 4 x 1 x 1 m with 40 x 10 x 10 cells 32 000 Gauss points have some 1 000
 * different surroundings. Each is evaluated once and copied for the others.
 *
 * "Alike" must depend neither on rounding nor on which of several positions came first, which would make the
 * answer depend on the number of threads: bonds are rounded to 2^-40 horizons before anything is computed of
 * them, and positions whose rounded bonds have the same bits are alike. A row is a function of its own
 * rounded bonds; whether it was computed or copied changes no bit of it. Compared with unrounded bonds shape
 * functions change by a relative 1e-12 or so, as much as by the rounding of coordinates in a body of 1 000
 * horizons. */
#ifndef PERIGAL_APPROX_CONGRUENT_H
#define PERIGAL_APPROX_CONGRUENT_H
#include "moment.h"

/* Surroundings that were evaluated lately, each in the slot that its fingerprint selects, where a later one
 * replaces it. One such cache for each thread; with_N, with_dN: 0: the call does not ask for these values,
 * and they are not kept. */
typedef struct {
    int     dim, with_N, with_dN;
    /* Number of slots (a power of two; 0: nothing is kept); number of bonds that a slot has room for. */
    size_t  slots, most;
    struct congruent_slot *slot;
    /* For each slot: bonds in horizons (most x dim), volumes (most), then the values of the row: w
     * (most), N (most), dN (most x dim). */
    double *store;
    /* Number of rows copied, and of their bonds; number of rows since the last copied one for which none was
     * found. */
    size_t  copied, copied_bonds, missed;
} congruent;

/* Allocates the cache for a call that evaluates `count` rows of at most `most` bonds. */
pg_status congruent_create (congruent *out, const pg_rows *rows, size_t count, size_t most);
void      congruent_clear  (congruent *c);
/* Rounds the n numbers z (bond vectors in horizons) to multiples of 2^-40. */
void      congruent_round  (size_t n, double *z);
/* Writes row i, all of whose bonds are intact, and returns 1 if an equal one is known. Else returns 0, and
 * *slot is where congruent_keep is to store it (SIZE_MAX: nowhere). volume: of every point of the cloud,
 * m^3. */
int       congruent_find   (congruent *c, const pg_neighbourhood *s, const double *volume, pg_rows *rows,
                            size_t i, size_t *slot);
/* Keeps row i, which has just been computed. */
void      congruent_keep   (congruent *c, size_t slot, const pg_rows *rows, size_t i, const double *volume);
#endif

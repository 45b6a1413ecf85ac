/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: list of pairs of points without an intact bond that may come nearer than their contact distance;
 * valid until some point has moved by half the skin (the margin of the search). */
#ifndef PG_NEAR_PAIRS_H
#define PG_NEAR_PAIRS_H
#include "perigal/contact.h"

/* A pair, in one of its two directions. */
typedef struct {
    int    i, j;
    double reach, full;  /* contact distance now; usual contact distance, m */
    double k, share;  /* normal stiffness, N/m; shear over normal stiffness */
} near_pair;
/* Data of a pair kept between lists: stretch of its friction spring (of j relative to i), m; reduced contact
 * distance, m, 0: the usual one. */
typedef struct { int i, j; double slip[3], reach; } near_memory;

typedef struct {
    const pg_problem *problem;
    size_t  stride, dim;
    double  distance, skin;                            /* in spacings */
    double  stiffness;                                 /* contact.stiffness */
    int     slips;                                     /* 1: pairs have friction */
    /* 1: contact by impulses: pairs must be listed one time step before they touch */
    int     impulses;
    double *modulus, *shear, *local;                   /* M, mu_s per law, Pa; V / s^2 per point, m */
    double  finest;                                    /* smallest spacing, m */
    double *start;                                     /* displacements at the last search, m (n x stride) */
    double *most;  size_t nblock;                      /* largest change in each block of unknowns, m */
    double  way;  /* bound of the motion of points since the last search, m */
    int     valid;                                     /* 0: a new search is needed */
    near_pair *pair;  size_t n, cap;                   /* sorted by i, then j; both directions of each pair */
    double *slip;  size_t cap_slip;                    /* stretch of friction springs, m (n x 3) */
    size_t *row, nrow, cap_row;  /* pairs of one first point: row[r] .. row[r + 1] - 1 */
    near_memory *memory;  size_t nmemory, cap_memory;  /* data for the next list */
    long    searches;
} near_pairs;
pg_status near_create (near_pairs *s, const pg_problem *problem, const pg_contact_setting *setting,
                       size_t stride);
void      near_free   (near_pairs *s);
/* Updates the list for the state: unchanged, with newly broken bonds added, or by a new search. */
pg_status near_update (near_pairs *s, const pg_state *state, const pg_changes *broken, int changed,
                       double way);
/* Collects nonzero slips and reduced contact distances in `memory`. */
pg_status near_collect (near_pairs *s);

/* Short-range contact of a run: data of springs (short_range.c) and impulses (point_impulses.c). */
typedef struct held_pair held_pair;
struct pg_short_range {
    near_pairs near;
    pg_contact_setting setting;
    double *force;                                     /* forces of the last evaluation, N (n x stride) */
    double *sum;  size_t cap;                          /* sums of each row */
    double taken, taken0;                              /* work that friction springs took, J; at step start */
    pg_short_range_report now;
    near_memory *start;  size_t nstart, cap_start;     /* slips at the start of the step */
    /* impulses: held: pairs with contact forces; mark: 0 apart, 1 would overlap, 2 in `held` (per pair);
     * pending: work of friction in the next half step, J; at the start of the step */
    held_pair *held;  size_t nheld, cap_held;
    unsigned char *mark;  size_t cap_mark;
    double pending, pending0;
};
#endif

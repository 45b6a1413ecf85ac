/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: pairs of points that no live bond joins and that may come nearer than their contact distance,
 * found by search; a list serves until some point has moved half the skin, which is the most that its reach
 * has to spare. */
#ifndef PG_NEAR_PAIRS_H
#define PG_NEAR_PAIRS_H
#include "perigal/contact.h"

/* One of the two directions of a pair. */
typedef struct {
    int    i, j;
    double reach, full;  /* contact distance, m; that of a pair whose bond did not break under pressure */
    double k, share;                                   /* stiffness, N/m; that across over that along */
} near_pair;
/* What pairs remember: the spring of friction, the displacement of j past i that it bears, m; their contact
 * distance, m, 0: in full. */
typedef struct { int i, j; double slip[3], reach; } near_memory;

typedef struct {
    const pg_problem *problem;
    size_t  stride, dim;
    double  distance, skin;                            /* in spacings */
    double  stiffness;                                 /* factor */
    int     slips;                                     /* 1: pairs have friction */
    /* 1: pairs must be known a time step before they touch */
    int     impulses;
    double *modulus, *shear, *local;                   /* M, mu_s of materials, Pa; V / s^2 of points, m */
    double  finest;                                    /* smallest spacing, m */
    double *start;                                     /* displacements at the last search, m (n x stride) */
    double *most;  size_t nblock;                      /* of every block of unknowns */
    double  way;  /* that points have moved since, at most, m */
    int     valid;                                     /* 0: the list has to be made anew */
    near_pair *pair;  size_t n, cap;                   /* by i, then j; each pair in both directions */
    double *slip;  size_t cap_slip;                    /* n x 3 */
    size_t *row, nrow, cap_row;                        /* pairs of a point: row[r] .. row[r + 1] - 1 */
    near_memory *memory;  size_t nmemory, cap_memory;  /* slips for the next list */
    long    searches;
} near_pairs;
pg_status near_create (near_pairs *s, const pg_problem *problem, const pg_contact_setting *setting,
                       size_t stride);
void      near_free   (near_pairs *s);
/* Brings the list in line with the state: unchanged, with bonds that broke added, or by another search. */
pg_status near_update (near_pairs *s, const pg_state *state, const pg_changes *broken, int changed,
                       double way);
/* The slips that are not zero and distances that are not full, into `memory`. */
pg_status near_collect (near_pairs *s);

/* Short-range contact of a run: what springs (short_range.c) and impulses (point_impulses.c) know. */
typedef struct held_pair held_pair;
struct pg_short_range {
    near_pairs near;
    pg_contact_setting setting;
    double *force;                                     /* of the last evaluation, N (n x stride) */
    double *sum;  size_t cap;                          /* of each row */
    double taken, taken0;                              /* J; at the start of the step */
    pg_short_range_report now;
    near_memory *start;  size_t nstart, cap_start;     /* slips at the start of the step */
    /* impulses: the pairs that are held; 0 .. 2 of every pair: apart, would overlap, listed; work of friction
     * in the half step to come, J; at the start of the step */
    held_pair *held;  size_t nheld, cap_held;
    unsigned char *mark;  size_t cap_mark;
    double pending, pending0;
};
#endif

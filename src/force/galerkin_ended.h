/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: cells of consistent integration that end at cracks (galerkin_ended.c, galerkin_ended_plan.c). */
#ifndef PG_GALERKIN_ENDED_H
#define PG_GALERKIN_ENDED_H
#include "galerkin.h"

/* Lengths in spacings: what counts as none; how far beside a face a place looks from. */
#define ENDED_NOTHING 1e-9
#define ENDED_BESIDE  (5 * PG_NO_LENGTH)
#define ENDED_RADIUS 3.0 /* how far places on cracks and on pieces of sides see */

/* How a cell near a crack is treated: as it was without this; by its own border, whose values are of live
 * bonds; the same in parts. */
enum { ENDED_NOT, ENDED_PLAIN, ENDED_PARTS };
/* A cell near a crack. */
typedef struct {
    size_t cell;
    int    kind, failed, blocked;  /* blocked: a crack runs through it, and it keeps direct derivatives */
    pg_cell_parts parts;
    int host[PG_PARTS][2]; /* place in the list and part whose evaluation points stand for each part */
    int    guest;                  /* 1: parts of other cells lean on its points */
} ended_cell;

struct galerkin_ended {
    size_t n, cap;  ended_cell *near;                  /* ascending by cell */
    int   *at;                                         /* place + 1 in the list of every cell */
    double *seen;  size_t nseen, cap_seen;             /* cracks that the list belongs to */
    pg_rows face;                                      /* faces of all cells: values of live bonds */
    unsigned char *alive, *weak;                       /* weak: faces from which too little is seen */
    /* Points on pieces of faces and on cracks: of each, its eye, flux out of the part it belongs to, m^2,
     * that part (place in the list, part); 1: on a crack. */
    pg_rows extra;
    size_t  nextra, cap_x, cap_eye, cap_flux, cap_part, cap_crack, cap_start, cap_node;
    double *eye, *flux;
    int   (*part)[2];
    unsigned char *crack;
    unsigned char *sight;  size_t cap_sight;           /* live bonds of these points */
    size_t  cap_N, cap_grade, cap_own, cap_wide;
    /* Whole sides of parts: the face, and the part (place in the list, part). */
    struct { size_t face; int part[2]; } *side;  size_t nside, cap_side;
    /* The points and sides of part p of the cell at place k: a chain from first[PG_PARTS k + p], numbers + 1;
     * those of sides are negative. */
    long   *first, *next_point, *next_side;  size_t cap_first, cap_next_point, cap_next_side;
    size_t blocked; /* cells that a crack runs through, left as they were */
};

/* Cells near the cracks of the state, how each is treated, and all values on borders. */
pg_status ended_plan  (galerkin *g, const pg_state *state);
/* Are the cracks others than at the last call? */
int       ended_moved (const galerkin *g, const pg_state *state);
/* Values on borders for the bonds that the cracks leave; cells with places that see too little fail: 1. */
pg_status ended_values (galerkin *g, const pg_cracks *cracks, int *again);
#endif

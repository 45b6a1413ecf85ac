/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: cells of consistent integration that end at cracks (galerkin_ended.c, galerkin_ended_plan.c). */
#ifndef PG_GALERKIN_ENDED_H
#define PG_GALERKIN_ENDED_H
#include "galerkin.h"

/* Lengths in spacings: how far beside a face a place looks from. */
#define ENDED_BESIDE  (5 * PG_NO_LENGTH)
#define ENDED_RADIUS 3.0 /* how far places on cracks and on pieces of sides see */

/* How a cell near a crack is treated: as it was without this; by its own border, whose values are of live
 * bonds; the same in parts. */
enum { ENDED_NOT, ENDED_PLAIN, ENDED_PARTS };
/* Whose evaluation points stand for a part: places in the list and parts, each for an equal share. */
enum { ENDED_HOSTS = 4 };
typedef struct { int n, at[ENDED_HOSTS], part[ENDED_HOSTS]; } ended_hosts;
/* A cell near a crack. */
typedef struct {
    size_t cell;
    int    kind, failed, blocked;  /* blocked: a crack runs through it, and it keeps direct derivatives */
    pg_cell_parts parts;
    ended_hosts host[PG_PARTS];
    int    guest;                  /* 1: parts of other cells lean on its points */
} ended_cell;

/* Capacities of the arrays that grow, by their names. */
typedef struct {
    size_t near, seen, x, eye, flux, part, crack, start, node, sight, N, grade, own, wide, side, first,
        next_point, next_side;
} ended_capacities;
struct galerkin_ended {
    ended_capacities cap;
    size_t n;  ended_cell *near;                  /* ascending by cell */
    int   *at;                                         /* place + 1 in the list of every cell */
    double *seen;  size_t nseen;             /* cracks that the list belongs to */
    pg_rows face;                                      /* faces of all cells: values of live bonds */
    unsigned char *alive, *weak;                       /* weak: faces from which too little is seen */
    /* Points on pieces of faces and on cracks: of each, its eye, flux out of the part it belongs to, m^2,
     * that part (place in the list, part); 1: on a crack. */
    pg_rows extra;
    size_t  nextra;
    double *eye, *flux;
    int   (*part)[2];
    unsigned char *crack;
    unsigned char *sight;           /* live bonds of these points */
    /* Whole sides of parts: the face, and the part (place in the list, part). */
    struct { size_t face; int part[2]; } *side;  size_t nside;
    /* The points and sides of part p of the cell at place k: a chain from first[PG_PARTS k + p], numbers + 1;
     * those of sides are negative. */
    long   *first, *next_point, *next_side;
    size_t blocked; /* cells that a crack runs through, left as they were */
};

/* Cells near the cracks of the state, how each is treated, and all values on borders. */
pg_status ended_plan  (galerkin *g, const pg_state *state);
/* Does part p of the cell at place k stand for itself? */
static inline int ended_stands (const struct galerkin_ended *e, size_t k, int p)
{
    const ended_hosts *h = &e->near[k].host[p];
    return h->n == 1 && h->at[0] == (int) k && h->part[0] == p;
}
/* The share of a part that part p of the cell at place k stands for. */
double    ended_share (const ended_hosts *of, size_t k, int p);
/* Are the cracks others than at the last call? */
int       ended_moved (const galerkin *g, const pg_state *state);
/* Values on borders for the bonds that the cracks leave; cells with places that see too little fail: 1. */
pg_status ended_values (galerkin *g, const pg_cracks *cracks, int *again);
#endif

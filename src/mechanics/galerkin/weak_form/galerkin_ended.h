/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: cells of consistent integration that end at cracks (galerkin_ended.c, galerkin_ended_plan.c). */
#ifndef PG_GALERKIN_ENDED_H
#define PG_GALERKIN_ENDED_H
#include "galerkin.h"

/* Distance from the face to the eye of a point, from which bonds are judged, in spacings. */
#define ENDED_BESIDE  (5 * PG_NO_LENGTH)
#define ENDED_RADIUS 3.0 /* least support radius of points on cracks and pieces of sides, in spacings */

/* How a cell near a crack is treated: not; corrected by its whole border, with values of intact bonds there;
 * corrected in the parts into which cracks divide it. */
enum { ENDED_NOT, ENDED_PLAIN, ENDED_PARTS };
/* Parts whose evaluation points stand for a part, with equal shares: positions of their cells in the list
 * `near`, and numbers of the parts. */
enum { ENDED_HOSTS = 4 };
typedef struct { int n, at[ENDED_HOSTS], part[ENDED_HOSTS]; } ended_hosts;
/* A cell near a crack. */
typedef struct {
    size_t cell;
    /* failed: keeps uncorrected derivatives; blocked: though a crack runs through it */
    int    kind, failed, blocked;
    pg_cell_parts parts;
    ended_hosts host[PG_PARTS];
    int    guest;                  /* 1: its points stand for parts of other cells */
} ended_cell;

/* Capacities of the arrays of galerkin_ended with these names. */
typedef struct {
    size_t near, seen, x, eye, flux, part, crack, start, node, sight, N, grade, own, wide, side, first,
        next_point, next_side;
} ended_capacities;
struct galerkin_ended {
    ended_capacities cap;
    size_t n;  ended_cell *near;                  /* cells near cracks, ascending by cell */
    int   *at;                                        /* position in `near` + 1 of every cell; 0: not there */
    double *seen;  size_t nseen;             /* cracks for which `near` was made, 6 doubles each */
    pg_rows face;                                    /* points on the faces of all cells, with intact bonds */
    unsigned char *alive, *weak;                       /* weak: faces with too few intact bonds for a basis */
    /* Points on pieces of faces and on cracks: of each, its eye (m), the flux out of the part it belongs to
     * (m^2), that part (position in `near`, number); crack: 1: it lies on a crack. */
    pg_rows extra;
    size_t  nextra;
    double *eye, *flux;
    int   (*part)[2];
    unsigned char *crack;
    unsigned char *sight;           /* 1: intact bonds of the points in `extra` */
    /* Sides of cells that are whole sides of parts: the face, and the part (position in `near`, number). */
    struct { size_t face; int part[2]; } *side;  size_t nside;
    /* Linked lists of the points and sides of part p of cell k of `near`: first[PG_PARTS k + p], then
     * next_...; numbers + 1, those of sides negative; 0 ends a list. */
    long   *first, *next_point, *next_side;
    size_t blocked; /* number of cells that a crack runs through, left uncorrected */
};

/* Finds the cells near the cracks of the state, how each is treated, and all values on borders. */
pg_status ended_plan  (galerkin *g, const pg_state *state);
/* Do evaluation points of its own stand for part p of cell k of `near`? */
static inline int ended_stands (const struct galerkin_ended *e, size_t k, int p)
{
    const ended_hosts *h = &e->near[k].host[p];
    return h->n == 1 && h->at[0] == (int) k && h->part[0] == p;
}
/* The share by which part p of cell k of `near` stands for the part with the hosts `of`. */
double    ended_share (const ended_hosts *of, size_t k, int p);
/* Have the cracks changed since the last call of ended_plan? */
int       ended_moved (const galerkin *g, const pg_state *state);
/* Evaluates the values on borders for the bonds that the cracks leave intact. *again: 1: some points have too
 * few neighbours, and their cells fail. */
pg_status ended_values (galerkin *g, const pg_cracks *cracks, int *again);
#endif

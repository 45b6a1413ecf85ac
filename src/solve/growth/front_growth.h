/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: fronts of cracks that grow in 3D. All vertices of all fronts are one set: each has a load factor
 * at which it would advance; those near the smallest one advance together, the nearer the more. */
#ifndef PG_FRONT_GROWTH_H
#define PG_FRONT_GROWTH_H
#include "facet_growth.h"
#include "hot_spot.h"

/* A vertex of a crack front at the present load factor. */
typedef struct {
    double J, ratio;  /* energy release rate, J/m^2; share of it that drives growth */
    /* energy that the material takes, J/m^2; 0: no growth possible */
    double need;
    double share;                                      /* sqrt (J ratio / need); 0: it does not grow */
    /* kink angle, rad; rise of the surface along the front that K_III asks for */
    double kink, slope;
    /* next advance, m: length, and its component along the normal */
    double way, rise;
    double width;                                      /* length of front that a vertex represents, m */
} front_vertex;

typedef struct front_growth {
    /* n vertices of all fronts; those of front k begin at first[k]; a closed front has none. */
    size_t n, *first, nfront, cap_first;
    unsigned char *blind;                              /* per front: no vertex has room for a tube */
    size_t cap_blind;
    front_vertex *vertex; size_t cap_vertex;           /* vertices as of the last plan (n) */
    double *d, *theta, *row; size_t cap_d, cap_theta, cap_row;         /* workspaces */
    /* front_ways.c: influence of advances on each other (n x n), with lengths of front; workspaces */
    double *couple, *factor, *forward, *line; size_t cap_couple, cap_factor, cap_forward, cap_line;
    size_t *going, cap_going; unsigned char *goes; size_t cap_goes;
} front_growth;

/* ---- front_growth.c ------------------------------------------------------------------------------------ */
void      fronts_free    (front_growth **fronts);
/* Measures the fronts of the state under the displacement fields of growth (facet_measure). */
pg_status fronts_measure (break_loop *b, const pg_state *state, const double *const *d, const double *t);
/* Warns of what users should know of the fronts, each once. */
void      fronts_tell    (const break_loop *b, const pg_state *state);
/* Counts vertices and finds what depends on the shape of the fronts alone. */
pg_status fronts_lay_out (break_loop *b, const pg_state *state);
/* Advances fronts by the plan at that factor and begins new cracks, each with a utilisation of at least
 * `least`; fills g->event; b->changes: bonds cut. */
pg_status fronts_grow    (break_loop *b, pg_state *state, double factor, double least);
/* Extends fronts that have grown and have no room left anywhere straight on by a facet; *grew 1: there were
 * some. */
pg_status fronts_run_out (break_loop *b, pg_state *state, int *grew);
/* ---- front_initiation.c -------------------------------------------------------------------------------- */
/* Offers new cracks (facet_offer) where strength and energy allow them below g->best. */
pg_status fronts_offer_starts (break_loop *b, const search *g);
/* Begins a new crack that was offered, a disc: adds its surface and breaks the bonds through it. */
pg_status fronts_start   (break_loop *b, pg_state *state, const facet_candidate *c);

/* Fills J, T stress, K and utilisation at the vertices of crack fronts, for results. */
pg_status fronts_show    (pg_solver *s, const pg_state *state, double factor);

/* ---- front_direction.c --------------------------------------------------------------------------------- */
/* Finds share, kink and slope of one vertex at the load factor. */
void front_judge (const break_loop *b, const pg_tip_field *f, double factor, front_vertex *out);
/* Plans the next advance at a load factor: way and rise of all vertices; returns its utilisation, sqrt of the
 * energy that the advance releases over what it takes. */
double fronts_plan (const break_loop *b, const pg_state *state, double factor);
/* ---- front_ways.c -------------------------------------------------------------------------------------- */
/* Finds the widths of all vertices and the influence of their advances on each other; once for a
 * measurement. */
pg_status fronts_couple   (front_growth *f, const pg_front *front);
/* Sets vertex[].way from vertex[].share; l: length of a facet at each vertex, m (n). */
void      fronts_set_ways (front_growth *f, const double *l);
#endif

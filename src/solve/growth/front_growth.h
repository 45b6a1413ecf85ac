/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: fronts of cracks that grow in space. All vertices of all fronts are one set: each has a load
 * factor at which it would go on, those near the least of them advance together, by the more the nearer they
 * are. */
#ifndef PG_FRONT_GROWTH_H
#define PG_FRONT_GROWTH_H
#include "facet_growth.h"
#include "hot_spot.h"

/* A vertex at the load factor at hand. */
typedef struct {
    double J, ratio;                                   /* J/m^2; share of it that counts for growth */
    /* energy that the material takes, J/m^2; 0: none grows */
    double need;
    double share;                                      /* sqrt (J ratio / need); 0: it does not grow */
    /* rad; rise of the surface along the front that K_III asks */
    double kink, slope;
    /* of the next advance: its length and its part along n, m */
    double way, rise;
    double width;                                      /* length of front that belongs to it, m */
} front_vertex;

typedef struct front_growth {
    /* Vertices of all fronts, front by front; front k has those from first[k] on. A front that is closed has
     * none. */
    size_t n, *first, nfront, cap_first;
    unsigned char *blind;                              /* per front: no vertex has room for a tube */
    size_t cap_blind;
    front_vertex *vertex; size_t cap_vertex;           /* as of the last plan (n) */
    double *d, *theta, *row; size_t cap_d, cap_theta, cap_row;         /* workspaces */
    /* front_ways.c: what advances make of each other (n x n), lengths of front included; workspaces */
    double *couple, *factor, *forward, *line; size_t cap_couple, cap_factor, cap_forward, cap_line;
    size_t *going, cap_going; unsigned char *goes; size_t cap_goes;
} front_growth;

/* ---- front_growth.c ------------------------------------------------------------------------------------ */
void      fronts_free    (front_growth **fronts);
/* Measures the fronts of the state under the fields of growth (facet_measure). */
pg_status fronts_measure (break_loop *b, const pg_state *state, const double *const *d, const double *t);
/* What the user should know of them, each said once. */
void      fronts_tell    (const break_loop *b, const pg_state *state);
/* How many vertices there are, and what depends on the shape of the fronts alone. */
pg_status fronts_lay_out (break_loop *b, const pg_state *state);
/* Advances by the plan at that factor, and lets new cracks begin, each where its utilisation is `least` or
 * more; g->closed, going and energies of the event; b->changes: bonds cut. */
pg_status fronts_grow    (break_loop *b, pg_state *state, double factor, double least);
/* Fronts that have grown and lost their room everywhere go straight on by a facet: *grew. */
pg_status fronts_run_out (break_loop *b, pg_state *state, int *grew);
/* ---- front_initiation.c -------------------------------------------------------------------------------- */
/* Offers new cracks (facet_offer) where strength and energy allow them below g->best. */
pg_status fronts_offer_starts (break_loop *b, const search *g);
/* Begins a new crack that was offered, a disc: its surface comes into being, and the bonds through it die. */
pg_status fronts_start   (break_loop *b, pg_state *state, const facet_candidate *c);

/* Fills J, T stress, K and utilisation at the vertices of crack fronts, for results. */
pg_status fronts_show    (pg_solver *s, const pg_state *state, double factor);

/* ---- front_direction.c --------------------------------------------------------------------------------- */
/* Share, kink and slope of one vertex at the load factor. */
void front_judge (const break_loop *b, const pg_tip_field *f, double factor, front_vertex *out);
/* The plan of the next advance at a load factor: how far all vertices go and rise; returns its utilisation,
 * sqrt of the energy that the advance sets free over what it takes. */
double fronts_plan (const break_loop *b, const pg_state *state, double factor);
/* ---- front_ways.c -------------------------------------------------------------------------------------- */
/* Widths of all vertices, and what their advances make of each other; once for a measurement. */
pg_status fronts_couple   (front_growth *f, const pg_front *front);
/* vertex[].way from vertex[].share; l: length of a facet at each vertex, m (n). */
void      fronts_set_ways (front_growth *f, const double *l);
#endif

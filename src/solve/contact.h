/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: contact of crack faces in equilibria of linear systems (perigal/contact.h). The stiffness and its
 * factor are those of the open cracks; forces of contact stand beside the loads and are found from the
 * condensed compliance of the pieces. Files: contact_solve.c (equilibria), contact_memory.c (what was before:
 * slips, work of friction; checkpoints). */
#ifndef PG_SOLVE_CONTACT_H
#define PG_SOLVE_CONTACT_H
#include "solve.h"

/* What pieces bore and how far they had slipped in a state: it outlives the pieces, which are others after a
 * crack has grown, and is then taken over place by place. */
typedef struct {
    size_t  n, room;
    double *value;                                     /* of each piece: contact_layout */
    double  friction;                                  /* work of friction so far, J */
} contact_memory;
/* Place of the middle (dim), length, shear force over area and slip when work was last booked, slip of the
 * last accepted step: numbers along the path in the plane, vectors in space. */
typedef struct { size_t length, shear, slip, accepted, values, parts; } contact_layout;
static inline contact_layout contact_layout_of (size_t dim)
{
    size_t m = dim == 3 ? 3 : 1;
    return (contact_layout){ .length = dim, .shear = dim + 1, .slip = dim + 1 + m, .accepted = dim + 1 + 2*m,
                             .values = dim + 1 + 3*m, .parts = m };
}

struct system_contact {
    pg_contact_setting setting;
    pg_contact_pieces  pieces;
    pg_sparse G;                                       /* G', ndof x dim n */
    size_t    poor;                                    /* points that see too little */
    unsigned long made;                                /* revision of K that Z and C belong to, + 1 */
    double   *Z, *C;                                   /* K^-1 G' (ndof x dim n); G Z (dim n x dim n), m/N */
    double   *coefficient, *cohesion;                  /* mu, c A (N), of each piece (n) */
    double   *before;                                  /* slip before (n x (dim - 1)) */
    double   *force, *gap, *open;                      /* f; g; gaps without contact (dim n each) */
    double   *initial;                                 /* gaps without displacement, m (dim n) */
    unsigned char *status;                             /* of each piece (n) */
    double   *nodal;                                   /* G' f, N (ndof) */
    int       active;                                  /* some force is not zero */
    int       history;                                 /* 1: slip has a memory from step to step */
    pg_contact_values *shown;  size_t nshown, cap_shown;         /* of the last step, for results */
    contact_memory now, start;                         /* start: of the step, for one that is refused */
};

/* ---- contact_solve.c ----------------------------------------------------------------------------------- */
pg_status contact_create  (pg_system *s);              /* where the options ask for it, else nothing */
void      contact_free    (pg_system *s);
/* After the force was refreshed: pieces and rows of the cracks of the state. */
pg_status contact_refresh (pg_system *s, const pg_state *state);
/* As system_solve, at rest. */
pg_status contact_solve   (pg_system *s, double t, double *d, double *residual);
/* What the report says of the pieces. */
void contact_count (pg_system *s);
/* Forces of contact on the nodes, N (ndof); NULL: none. */
const double *contact_forces (const pg_system *s);
/* At the start of a run: tips that are closed at full load cut bonds up to an offset of their own. */
pg_status contact_settle_tips (pg_system *s, pg_state *state);
/* Mean tractions on the face behind a tip, as stresses in its frame, Pa: across the crack (negative: it is
 * closed) and along it. *nearest: distance to the next closed piece, m; INFINITY: none. */
void contact_at_tip (const pg_system *s, const pg_state *state, size_t tip, double stress[2],
                     double *nearest);

/* The pieces of the state at hand for results, loads scaled. */
pg_status contact_show (pg_system *s, double scale);

/* ---- contact_memory.c ---------------------------------------------------------------------------------- */
/* Numbers along the tangents of piece k, times scale, as a vector (space: 3) or a number (plane: 1). */
void      contact_vector   (const pg_contact_pieces *pieces, size_t k, const double *along, double scale,
                            double *out);
/* Values of the memory at the pieces at hand. */
pg_status contact_remember (struct system_contact *c);
/* Work of friction from the state booked last to the one at hand, loads scaled. */
void      contact_book    (pg_system *s, double scale);
void      contact_accept  (pg_system *s);              /* a step has ended: its slips are kept */
pg_status contact_save    (pg_system *s);
void      contact_return  (pg_system *s);
pg_status contact_keep    (pg_system *s, const pg_keeper *k);
#endif

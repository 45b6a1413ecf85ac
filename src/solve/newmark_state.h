/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: state of Newmark's method; where it starts, and supports by elimination (newmark_start.c). */
#ifndef PG_SOLVE_NEWMARK_H
#define PG_SOLVE_NEWMARK_H
#include "solve.h"

typedef struct {
    double   *work1, *work2, *work3, *work4;           /* room for vectors (ndof; work4: 3 x ndof) */
    double   *force0;  /* with alpha: loads less resistance at the last step's end, N */
    dynamics  dyn;                                     /* coefficients of the matrix */
    double   *support;                                 /* motion z, z', z'' of prescribed nodes (3 x ndof) */
    long      support_updates;  /* report.updates when it was found: breaking changes z */
} newmark;
static inline newmark *newmark_of (const pg_solver *s) { return s->own; }

pg_status newmark_start    (pg_solver *s, pg_state *state);
pg_status newmark_supports (pg_solver *s, double t, int start);        /* fills `support` for time t */
/* V and A of prescribed nodes from support */
void      newmark_follow   (pg_solver *s, double t, double *v, double *a);
/* -= M a + C v */
void      newmark_resist   (pg_solver *s, const double *v, const double *a, double *residual);
void      newmark_damp     (pg_solver *s, const double *v, double *residual);                  /* -= C v */
pg_status newmark_remember (pg_solver *s, double t, const pg_state *state);  /* fills force0 */
double    newmark_kinetic  (pg_solver *s, const double *v);            /* J */
#endif

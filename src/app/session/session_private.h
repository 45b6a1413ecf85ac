/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: a session, and what its files share. */
#ifndef PG_SESSION_PRIVATE_H
#define PG_SESSION_PRIVATE_H
#include "perigal/session.h"

struct pg_session {
    pg_scene   *scene;
    pg_problem *problem;
    pg_solver_options options;
    pg_solver  *solver;
    pg_state   *state;
    int         begun;                                 /* 1: a step was tried, or a state read back */
    pg_step     step;                                  /* the last step */
    double     *field;                                 /* the field asked for last (points x 6 values) */
};

/* Index of point i in the family of point j, whose neighbours ascend. If i is no neighbour of j: some other
 * entry of j, whose family must not be empty. */
size_t session_mirror (const pg_family *f, int i, int j);
/* A new solver for the session's problem and the state that it starts from. */
pg_status session_begin (const pg_session *s, pg_solver **solver, pg_state **state);
#endif

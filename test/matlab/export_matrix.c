/* SPDX-License-Identifier: GPL-3.0-or-later
 * export_matrix SCENE FILE: the stiffness matrix that the force of a scene shows, without what mex and
 * session put around it, as a Matrix Market file; test_mex.sh compares it with the one that MATLAB gets. */
#include "perigal.h"
#include <stdio.h>

int main (int argc, char **argv)
{
    pg_status status = PG_OK;
    pg_scene *scene = NULL;
    pg_problem *problem = NULL;
    pg_state *state = NULL;
    void *self = NULL;
    pg_field field[8];
    int components = 0;
    if (argc != 3) return 2;
    PG_TRY (pg_scene_load (&scene, argv[1]));
    PG_TRY (pg_problem_build (&problem, scene, 1));
    const pg_force_type *force = pg_force_of (problem);
    PG_TRY (force->create (&self, problem));
    size_t n = force->fields (self, 8, field);
    for (size_t k = 0; k < n; k++) components += field[k].components;
    PG_TRY (pg_state_create (&state, problem, components));
    PG_TRY (force->refresh (self, state, NULL));
    PG_TRY (pg_force_assemble (force, self, NULL));
    PG_TRY (pg_matrix_market_write (pg_force_matrix (force, self), argv[2], NULL));
done:
    if (status != PG_OK) fprintf (stderr, "%s\n", pg_last_error ());
    return status != PG_OK;
}

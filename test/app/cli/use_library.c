/* SPDX-License-Identifier: GPL-3.0-or-later
 * A program of a user of the library: runs a scene and prints the largest displacement. Compiled by
 * test_install.sh. */
#include <math.h>
#include <perigal.h>
#include <stdio.h>

int main (int argc, char **argv)
{
    pg_status status = PG_OK;
    pg_scene *scene = NULL;
    pg_problem *problem = NULL;
    pg_solver *solver = NULL;
    pg_state *state = NULL;
    pg_solver_options options;
    pg_step step;
    double *u = NULL, top = 0;
    void *self;
    const char *unit;
    int components;
    if (argc != 2) return 64;
    PG_TRY (pg_scene_load (&scene, argv[1]));
    PG_TRY (pg_problem_build (&problem, scene, 1));
    PG_TRY (pg_solver_options_read (&options, problem, scene));
    PG_TRY (pg_solver_create (&solver, problem, &options));
    PG_TRY (pg_state_create (&state, problem, pg_solver_components (solver)));
    while (!pg_solver_done (solver, state)) PG_TRY (pg_solver_step (solver, state, &step));

    PG_ALLOC (u, 6 * problem->cloud.n);
    const pg_force_type *force = pg_solver_force (solver, &self);
    PG_TRY (force->field (self, state, state->d, "displacement", &components, &unit, u));
    for (size_t i = 0; i < problem->cloud.n * (size_t) components; i++) top = fmax (top, fabs (u[i]));
    printf ("%ld steps, largest displacement %.6g %s\n", state->step, top, unit);
done:
    if (status != PG_OK) fprintf (stderr, "%s\n", pg_last_error ());
    pg_free (u);
    pg_state_free (&state);
    pg_solver_free (&solver);
    pg_problem_free (&problem);
    pg_scene_free (&scene);
    return status != PG_OK;
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * perigal check: everything that a run checks before its first step, and what the scene
 * amounts to. The order is that of a run, so that a scene that passes here does not fail
 * there. Nothing is written, except with --spectrum -o DIR
 * and --matrix DIR. */
#include "cli.h"
#include <math.h>

/* --echo: the scene as it was understood, for programs that change scenes. */
static int echo (const command *c)
{
    pg_status status = PG_OK;
    pg_scene *scene = NULL;
    char *json = NULL;
    PG_TRY (pg_scene_load_with (&scene, c->scene, c->nset, c->set));
    PG_TRY (pg_scene_echo (&json, scene));
    puts (json);
done:
    if (status == PG_E_FILE) status = PG_E_SCENE;
    if (status != PG_OK) command_complain (status, pg_last_error ());
    pg_free (json);
    pg_scene_free (&scene);
    return pg_exit_code (status);
}

/* For explicit and relaxation solvers the solver itself is created, because only it knows its
 * time step. --solve and --spectrum come last, since they take the longest and everything else
 * must be right for them. */
int pg_cli_check (int argc, char **argv)
{
    pg_status status = PG_OK;
    command c;
    pg_scene *scene = NULL;
    pg_problem *p = NULL;
    pg_solver_options o;
    pg_forecast f;
    pg_first_break first = { 0 };
    spectrum waves = { 0 };
    pg_solver *solver = NULL;
    pg_cracks cracks = { 0 };
    pg_crack_statistics network = { 0 };
    const char *from = "";
    double stable = NAN;
    int wrong = command_parse (&c, argc, argv);
    if (wrong >= 0) return wrong;
    if (c.echo) return echo (&c);
    if (c.ranks) return check_ranks (&c);
    PG_TRY (command_scene (&c, &scene));
    PG_TRY (afford_scene (&c, &f));
    PG_TRY (command_problem (&c, scene, &p, &o));
    PG_TRY (afford_problem (&c, &f, p, 1));
    PG_TRY (pg_patch_probe (p));
    if ((o.flags & PG_SOLVER_EXPLICIT) || (o.flags & PG_SOLVER_STAGED)) {
        PG_TRY (pg_solver_create (&solver, p, &o));
        o = *pg_solver_settled (solver);
        stable = pg_solver_stable (solver, &from);
    }
    PG_TRY (pg_patch_refuse (p, scene));
    if (c.solve) PG_TRY (pg_first_break_find (&first, p, &o));
    if (c.spectrum) PG_TRY (spectrum_find (&waves, scene, p));
    PG_TRY (pg_network_read (&cracks, scene));
    PG_TRY (pg_crack_statistics_measure (&network, &cracks, scene));
    PG_TRY (matrix_write (p, &o, c.matrix));
    plan all = { p, &o, &f, afford_available (&c), &first, &waves, stable, from, &network, solver };
    if (c.json) PG_TRY (plan_print_json (&all));
    else printf ("%s: the scene is valid\n", c.scene);
    if (!c.quiet && !c.json) plan_print_long (&all);
    if (c.spectrum && !c.json) spectrum_print (&waves, p);
    if (c.spectrum && c.folder) PG_TRY (spectrum_write (&waves, p, c.folder));
done:
    if (status != PG_OK) command_complain (status, pg_last_error ());
    pg_cracks_clear (&cracks);
    spectrum_free (&waves);
    pg_solver_free (&solver);
    pg_problem_free (&p);
    pg_scene_free (&scene);
    return pg_exit_code (status);
}

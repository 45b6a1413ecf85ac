/* SPDX-License-Identifier: GPL-3.0-or-later
 * perigal check: everything that a run checks before its first step, and what the scene
 * amounts to. The order is that of a run, so that a scene that passes here does not fail
 * there. Nothing is written, except with --spectrum -o DIR
 * and --matrix DIR. */
#include "app/cli/preparation/cli.h"
#include <math.h>

/* Runs check --echo: prints the scene as it was understood, for programs that change scenes. */
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

/* Creates the solver and does all that precedes its first step if the body has at most PLAN_MOST_TRIED
 * points; an explicit or relaxing solver is created for any body, because only it knows its time step. */
static pg_status try_start (preparation *r, plan *all, pg_statistics *warned)
{
    pg_status status = PG_OK;
    int fits = !((double) r->problem->cloud.n > PLAN_MOST_TRIED),
        steps = (r->options.flags & (PG_SOLVER_EXPLICIT | PG_SOLVER_STAGED)) != 0;
    if (!fits && !steps) {
        PG_TRY (pg_patch_refuse (r->problem, r->scene));
        pg_solver_doubts (warned, r->problem, &r->options);
        goto done;
    }
    PG_TRY (prepare_solver (r));
    if (fits) PG_TRY (prepare_start (r));
    all->solver = r->solver, all->begun = fits;
    *warned = *pg_solver_report_now (r->solver);
    if (!steps) goto done;
    r->options = *pg_solver_settled (r->solver);
    all->stable = pg_solver_stable (r->solver, &all->from);
done:
    return status;
}

/* Checks a scene. --solve and --spectrum come last, since they take the longest and need everything else to
 * be right. */
int pg_cli_check (int argc, char **argv)
{
    pg_status status = PG_OK;
    command c;
    preparation r = { .scene = NULL };
    pg_first_break first = { 0 };
    spectrum waves = { 0 };
    pg_statistics warned = { 0 };
    pg_cracks cracks = { 0 };
    pg_crack_statistics network = { 0 };
    int wrong = command_parse (&c, argc, argv);
    if (wrong >= 0) return wrong;
    if (c.echo) return echo (&c);
    if (c.ranks) return check_ranks (&c);
    PG_TRY (command_scene (&c, &r.scene));
    PG_TRY (prepare_problem (&r, &c, 1));
    plan all = { .problem = r.problem, .options = &r.options, .forecast = &r.forecast,
                 .available = afford_available (&c), .first = &first, .waves = &waves, .stable = NAN,
                 .from = "", .network = &network,
                 .warned = &warned };
    PG_TRY (try_start (&r, &all, &warned));
    if (c.solve) PG_TRY (pg_first_break_find (&first, r.problem, &r.options));
    if (c.spectrum) PG_TRY (spectrum_find (&waves, r.scene, r.problem));
    PG_TRY (pg_network_read (&cracks, r.scene));
    PG_TRY (pg_crack_statistics_measure (&network, &cracks, r.scene));
    PG_TRY (matrix_write (r.problem, &r.options, c.matrix));
    if (c.json) PG_TRY (plan_print_json (&all));
    else printf ("%s: the scene is valid\n", c.scene);
    if (!c.quiet && !c.json) plan_print_long (&all);
    if (c.spectrum && !c.json) spectrum_print (&waves, r.problem);
    if (c.spectrum && c.folder) PG_TRY (spectrum_write (&waves, r.problem, c.folder));
done:
    if (status != PG_OK) command_complain (status, pg_last_error ());
    pg_cracks_clear (&cracks);
    spectrum_free (&waves);
    prepare_free (&r);
    return pg_exit_code (status);
}

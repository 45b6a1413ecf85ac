/* SPDX-License-Identifier: GPL-3.0-or-later
 * The work of a process that perigal bench or perigal converge has started (study.h): one run, or one finite
 * element result, is measured; the numbers go to stdout as lines "name value". Users have no need of these
 * two options. */
#include "app/cli/preparation/cli.h"

/* Runs --row SCENE -o DIR ...: the words are those of `perigal run`, so argv[0] is changed to its name.
 * Memory is forecast unless the scene fits any machine; the numbers go to stdout. */
int pg_cli_trial (int argc, char **argv)
{
    pg_status status = PG_OK;
    command c;
    pg_scene *scene = NULL;
    pg_forecast forecast;
    pg_trial t;
    double start = pg_seconds ();
    argv[0] = "run";
    int wrong = command_parse (&c, argc, argv);
    if (wrong >= 0) return wrong;
    if (!c.folder) PG_FAIL (PG_E_USAGE, "--row needs -o DIR");
    PG_TRY (command_scene (&c, &scene));
    if (c.memory > 0 || !afford_tiny (scene)) PG_TRY (afford_scene (&c, &forecast));
    PG_TRY (pg_trial_measure (&t, scene, c.folder, c.threads, start));
    pg_trial_write (&t, stdout);
done:
    if (status != PG_OK) command_complain (status, pg_last_error ());
    pg_scene_free (&scene);
    return pg_exit_code (status);
}

/* Runs --fem-row SCENE FILE UNIT [--set KEY=VALUE]...: measures FILE against the reference of SCENE. */
int pg_cli_trial_of_mesh (int argc, char **argv)
{
    pg_status status = PG_OK;
    pg_scene *scene = NULL;
    size_t nset = 0;
    const char *set[PG_TRIAL_SETS];
    char text[64];
    double unit;
    pg_trial t;
    if (argc < 4) PG_FAIL (PG_E_USAGE, "--fem-row needs SCENE FILE UNIT");
    for (int k = 4; k + 1 < argc && nset < PG_TRIAL_SETS; k += 2) set[nset++] = argv[k + 1];
    snprintf (text, sizeof text, "1 %.48s", argv[3]);
    PG_TRY (pg_unit_parse (&unit, text, "m"));
    PG_TRY (pg_scene_load_with (&scene, argv[1], nset, set));
    PG_TRY (pg_trial_of_mesh (&t, scene, argv[2], unit));
    pg_trial_write (&t, stdout);
done:
    if (status != PG_OK) command_complain (status, pg_last_error ());
    pg_scene_free (&scene);
    return pg_exit_code (status);
}

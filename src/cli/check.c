/* SPDX-License-Identifier: GPL-3.0-or-later
 * perigal check, list, help: what a scene means, what this build holds, what a key means. */
#include "cli.h"
#include <string.h>

int pg_cli_check (int argc, char **argv)
{
    pg_status status = PG_OK;
    command c;
    pg_scene *scene = NULL;
    pg_problem *p = NULL;
    pg_solver_options o;
    char text[512] = "none: nothing breaks";
    if (command_parse (&c, argc, argv)) return EXIT_USAGE;
    PG_TRY (pg_scene_load_with (&scene, c.scene, c.nset, c.set));
    PG_TRY (pg_problem_build (&p, scene, c.threads));
    PG_TRY (pg_solver_options_read (&o, p, scene));
    if (p->criterion.type) p->criterion.type->describe (&p->criterion, text, sizeof text);
    printf ("%s: the scene is right\n", c.scene);
    printf ("  title               %s\n  points              %zu (spacing per axis %.6g %.6g %.6g m)\n", p->title, p->cloud.n, p->cloud.step[0], p->cloud.step[1],
            p->cloud.step[2]);
    printf ("  background cells    %zu, boundary facets %zu\n", p->cells.n, p->cells.nfacet);
    printf ("  bonds               node-node %zu, point-node %zu, facet-node %zu\n", p->first_bond[1], p->first_bond[2] - p->first_bond[1],
            p->first_bond[3] - p->first_bond[2]);
    printf ("  unknowns            %zu\n  horizon             %.6g m\n  criterion           %s\n", p->cloud.n * (size_t) p->dim, p->approx.horizon, text);
    printf ("  solver              %s%s\n", o.kind, strcmp (o.kind, "static") ? "" : o.event ? ", event stepping" : ", fixed load steps");
    for (size_t s = 0; s < p->nload; s++)
        printf ("  boundary %-10s %zu points, %zu facets\n", p->load[s].name, p->load[s].set->npoint, p->load[s].set->nfacet);
    if (p->eroded) printf ("  eroded              %zu points lie on a pre-crack\n", p->eroded);
done:
    if (status != PG_OK) fprintf (stderr, "%s%s\n", status == PG_E_SCENE ? "" : "perigal: ", pg_last_error ());
    pg_problem_free (&p);
    pg_scene_free (&scene);
    return exit_code (status);
}

int pg_cli_list (int argc, char **argv)
{
    (void) argc, (void) argv;
    const struct { const char *what, *names; } rows[] = {
        { "force", pg_force_names () }, { "approximation", pg_approx_names () }, { "integration", pg_integration_names () },
        { "kernel", pg_kernel_names () }, { "material", pg_material_names () }, { "criterion", pg_criterion_names () },
        { "solver", pg_solver_names () }, { "linear", pg_linear_names () } };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) printf ("%-14s %s\n", rows[k].what, rows[k].names);
    return EXIT_DONE;
}

int pg_cli_help (int argc, char **argv)
{
    pg_status status = PG_OK;
    if (argc > 1 && strcmp (argv[1], "--manual") == 0) status = pg_scene_manual (stdout);
    else if (argc > 1) status = pg_scene_help (stdout, argv[1]);
    else {
        size_t n;
        const pg_key_table *table = pg_scene_tables (&n);
        printf ("keys of the scene file (perigal help KEY explains one, perigal help --manual prints all):\n");
        for (size_t t = 0; t < n; t++)
            for (size_t k = 0; k < table[t].n; k++) printf ("  %s\n", table[t].key[k].path);
    }
    if (status != PG_OK) fprintf (stderr, "perigal: %s\n", pg_last_error ());
    return exit_code (status);
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * perigal list and perigal help: what this build holds, and what a key of the scene means.
 * Both read the catalogues and the tables of keys, so that they cannot differ from what the
 * program does: a new entry of a catalogue appears here without another line. */
#include "app/cli/preparation/cli.h"
#include <string.h>

/* The line of description of a catalogue entry; one function per catalogue follows. */
typedef const char *(*summary_of) (const char *name);
/* Returns the line of description of a force, "" for an unknown name. The functions after it do so for the
 * other catalogues. */
static const char *of_force (const char *n)
{
    const pg_force_type *t = pg_force_find (n);
    return t ? t->method.summary : "";
}
static const char *of_approx (const char *n)
{
    const pg_approx_type *t = pg_approx_find (n);
    return t ? t->summary : "";
}
static const char *of_integration (const char *n)
{
    const pg_integration_type *t = pg_integration_find (n);
    return t ? t->summary : "";
}
static const char *of_kernel (const char *n)
{
    const pg_kernel *t = pg_kernel_find (n);
    return t ? t->summary : "";
}
static const char *of_material (const char *n)
{
    const pg_material_type *t = pg_material_find (n);
    return t ? t->summary : "";
}
static const char *of_criterion (const char *n)
{
    const pg_criterion_type *t = pg_criterion_find (n);
    return t ? t->summary : "";
}
/* "auto" is a choice of solver.linear but no entry of the catalogue. */
static const char *of_linear (const char *n)
{
    const pg_linear_type *t = pg_linear_find (n);
    return t ? t->summary : "chosen by the matrix";
}
static const char *of_solver (const char *n)
{
    const pg_solver_type *t = pg_solver_find (n);
    return t ? t->summary : "";
}

static const char *of_writer (const char *n)
{
    const pg_writer *t = pg_writer_find (n);
    return t ? t->summary : "";
}

/* The catalogues that scenes choose from: the key of the scene, the names, the line of
 * description. */
static const struct { const char *key; const char *(*names) (void); summary_of summary;
} catalogues[] = {
    { "method.force", pg_force_names, of_force },
    { "method.approximation", pg_approx_names, of_approx },
    { "method.integration", pg_integration_names, of_integration },
    { "method.kernel", pg_kernel_names, of_kernel },
    { "materials.{}.model", pg_material_names, of_material },
    { "failure.criterion", pg_criterion_names, of_criterion },
    { "solver.kind", pg_solver_names, of_solver },
    { "solver.linear", pg_linear_names, of_linear },
    { "output.format", pg_writer_names, of_writer },
};

/* Prints one block per catalogue, headed by the key of the scene that chooses from it. */
int pg_cli_list (int argc, char **argv)
{
    char name[64];
    if (argc > 1) {
        int asked = strcmp (argv[1], "--help") == 0;
        fprintf (asked ? stdout : stderr, "usage: perigal list     (no arguments)\n");
        return asked ? PG_EXIT_DONE : PG_EXIT_USAGE;
    }
    for (size_t k = 0; k < sizeof catalogues / sizeof *catalogues; k++) {
        printf ("%s\n", catalogues[k].key);
        for (const char *s = catalogues[k].names (); *s; s += strcspn (s, "|"), s += *s == '|') {
            snprintf (name, sizeof name, "%.*s", (int) strcspn (s, "|"), s);
            const char *text = catalogues[k].summary (name);
            printf ("  %-18s%s%s\n", name, *text ? " " : "", text);
        }
    }
    return PG_EXIT_DONE;
}

/* Prints all keys of the scene, one per line, in the order of the source folders that define them. */
static void all_keys (void)
{
    const pg_key *key;
    printf ("keys of the scene file (perigal help KEY explains one, perigal help --manual prints all):\n");
    for (size_t k = 0; (key = pg_scene_key (k)); k++) printf ("  %s\n", key->path);
}

/* A word is first looked for among the commands, then among the keys; without one all keys are
 * listed, --manual prints doc/input.md, and --schema the keys as a JSON schema. */
int pg_cli_help (int argc, char **argv)
{
    pg_status status = PG_OK;
    if (argc < 2) all_keys ();
    else if (strcmp (argv[1], "--manual") == 0) status = pg_scene_manual (stdout);
    else if (strcmp (argv[1], "--schema") == 0) status = pg_scene_json_schema (stdout);
    else if (command_usage (stdout, argv[1])) return PG_EXIT_DONE;
    else status = pg_scene_help (stdout, argv[1]);
    const char *near =
        status == PG_E_USAGE
            ? pg_nearest_name (argv[1], "run|check|plot|cracks|compare|bench|converge|sweep|new|list|help")
            : NULL;
    if (status != PG_OK)
        fprintf (stderr, "perigal: %s%s%s%s\n", pg_last_error (), near ? "; or the command " : "",
                 near ? near : "", near ? "?" : "");
    return pg_exit_code (status);
}

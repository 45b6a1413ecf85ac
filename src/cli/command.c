/* SPDX-License-Identifier: GPL-3.0-or-later
 * Options that run and check share; what each command is told by. */
#include "cli.h"
#include <getopt.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const struct { const char *name, *text; } usages[] = {
    { "run", "perigal run SCENE.yaml [-o DIR] [--threads N] [--set KEY=VALUE]... [--quiet]\n"
             "  -o, --out DIR        result folder, made if need be; default out/NAME, NAME from the scene's folder or file\n"
             "      --threads N      0 (the default): one per processor\n"
             "  -s, --set KEY=VALUE  replaces or adds one value of the scene, such as method.horizon='2.5 spacing'\n"
             "  -q, --quiet          neither progress nor summary; warnings are in DIR/report.json\n"
             "  Ctrl-C ends the run after the step at hand; what was written stays readable.\n" },
    { "check", "perigal check SCENE.yaml [--set KEY=VALUE]... [--quiet]\n"
               "  All faults of the scene with line and column, or what it amounts to: points, bonds, unknowns, constants.\n" },
    { "plot", "perigal plot DIR [--field NAME] [--component x|xx|magnitude] [--step N] [--magnify FACTOR] [--section AXIS=VALUE] [--out FILE]\n"
              "perigal plot DIR --curve X Y [--out FILE]\n"
              "  A field of DIR/result.e (damage, last step), or two columns of DIR/history.csv, as PNG or SVG.\n" },
    { "list", "perigal list\n  Methods, kernels, criteria, solvers of this build, one line each.\n" },
    { "help", "perigal help [KEY | COMMAND | --manual]\n  All keys of the scene file; one key; one command; or all keys as markdown.\n" },
};

int command_usage (FILE *to, const char *name)
{
    for (size_t k = 0; k < sizeof usages / sizeof *usages; k++)
        if (strcmp (usages[k].name, name) == 0) return fputs (usages[k].text, to) >= 0;
    return 0;
}

static int read_threads (command *c, const char *text)
{
    char *end;
    long n = strtol (text, &end, 10);
    if (end == text || *end || n < 0 || n > 64) {
        fprintf (stderr, "perigal: --threads %s: a number from 0 (all) to 64 is needed\n", text);
        return EXIT_USAGE;
    }
    c->threads = (int) n;
    return -1;
}

static int read_set (command *c, const char *text)
{
    if (c->nset >= sizeof c->set / sizeof *c->set || !strchr (text, '=')) {
        fprintf (stderr, "perigal: --set %s: KEY=VALUE is needed, at most %zu times\n", text, sizeof c->set / sizeof *c->set);
        return EXIT_USAGE;
    }
    c->set[c->nset++] = text;
    return -1;
}

static int refuse (const char *name, int option, const char *argument)
{
    if (option == ':') fprintf (stderr, "perigal %s: %s needs a value\n", name, argument);
    else fprintf (stderr, "perigal %s: there is no option %s\n", name, argument);
    command_usage (stderr, name);
    return EXIT_USAGE;
}

int command_parse (command *c, int argc, char **argv)
{
    static const struct option options[] = {
        { "out", required_argument, NULL, 'o' }, { "threads", required_argument, NULL, 't' }, { "set", required_argument, NULL, 's' },
        { "quiet", no_argument, NULL, 'q' }, { "help", no_argument, NULL, 'h' }, { NULL, 0, NULL, 0 } };
    memset (c, 0, sizeof *c);
    optind = 1, opterr = 0;
    for (int k, wrong = -1; (k = getopt_long (argc, argv, ":o:qs:h", options, NULL)) != -1;) {
        if (k == 'h') return command_usage (stdout, argv[0]) ? EXIT_DONE : EXIT_USAGE;
        if (k == 'o') c->folder = optarg;
        else if (k == 't') wrong = read_threads (c, optarg);
        else if (k == 's') wrong = read_set (c, optarg);
        else if (k == 'q') c->quiet = 1;
        else wrong = refuse (argv[0], k, argv[optind - 1]);
        if (wrong >= 0) return wrong;
    }
    if (optind + 1 != argc) {
        fprintf (stderr, "perigal: %s needs exactly one scene file\n", argv[0]);
        command_usage (stderr, argv[0]);
        return EXIT_USAGE;
    }
    c->scene = argv[optind];
    if (c->threads < 1) c->threads = (int) sysconf (_SC_NPROCESSORS_ONLN);
    return -1;
}

pg_status command_scene (const command *c, pg_scene **scene)
{
    pg_status status = pg_scene_load_with (scene, c->scene, c->nset, c->set);
    return status == PG_E_FILE ? PG_E_SCENE : status;
}

/* Faults of a scene begin with their place; all else names the program. */
void command_complain (pg_status status, const char *text)
{
    fprintf (stderr, "%s%s\n", status == PG_E_SCENE ? "" : "perigal: ", text);
}

int exit_code (pg_status status)
{
    return status == PG_OK ? EXIT_DONE : status == PG_E_SCENE ? EXIT_SCENE : status == PG_E_USAGE ? EXIT_USAGE
         : status == PG_E_INTERRUPTED ? EXIT_INTERRUPTED : EXIT_FAILED;
}

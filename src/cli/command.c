/* SPDX-License-Identifier: GPL-3.0-or-later
 * Options that run and check share. */
#include "cli.h"
#include <getopt.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

int command_parse (command *c, int argc, char **argv)
{
    static const struct option options[] = {
        { "out", required_argument, NULL, 'o' }, { "threads", required_argument, NULL, 't' }, { "set", required_argument, NULL, 's' },
        { "quiet", no_argument, NULL, 'q' }, { NULL, 0, NULL, 0 } };
    memset (c, 0, sizeof *c);
    optind = 1;
    for (int k; (k = getopt_long (argc, argv, "o:qs:", options, NULL)) != -1;) {
        if (k == 'o') c->folder = optarg;
        else if (k == 't') {
            char *end;
            c->threads = (int) strtol (optarg, &end, 10);
            if (*end || c->threads < 0 || c->threads > 64) {
                fprintf (stderr, "perigal: --threads %s: a number from 0 (all) to 64 is needed\n", optarg);
                return EXIT_USAGE;
            }
        } else if (k == 's') {
            if (c->nset >= sizeof c->set / sizeof *c->set || !strchr (optarg, '=')) {
                fprintf (stderr, "perigal: --set %s: key=value is needed, at most 64 times\n", optarg);
                return EXIT_USAGE;
            }
            c->set[c->nset++] = optarg;
        } else if (k == 'q') c->quiet = 1;
        else return EXIT_USAGE;
    }
    if (optind + 1 != argc) {
        fprintf (stderr, "perigal: %s needs exactly one scene file\n", argv[0]);
        return EXIT_USAGE;
    }
    c->scene = argv[optind];
    if (c->threads < 1) c->threads = (int) sysconf (_SC_NPROCESSORS_ONLN);
    return 0;
}

int exit_code (pg_status status)
{
    return status == PG_OK ? EXIT_DONE : status == PG_E_SCENE ? EXIT_SCENE : status == PG_E_USAGE ? EXIT_USAGE
         : status == PG_E_INTERRUPTED ? EXIT_INTERRUPTED : EXIT_FAILED;
}

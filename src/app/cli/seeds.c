/* SPDX-License-Identifier: GPL-3.0-or-later
 * perigal run SCENE --seeds N: runs the scene N times, with the seeds 1 to N for everything random in it, and
 * measures the spread of the peak loads (study.h). Called again it continues: finished runs are not
 * repeated. */
#include "app/cli/preparation/cli.h"
#include <string.h>

int command_seeds (const command *c)
{
    pg_status status = PG_OK;
    pg_spread peaks;
    char memory[32];
    int jobs = c->jobs ? c->jobs : 1, threads = c->given ? c->threads : 0;
    pg_seeds_request q = { .scene = c->scene,
                           .folder = c->folder ? c->folder : "out/seeds",
                           .first = 1,
                           .count = (size_t) c->seeds,
                           .threads = c->threads,
                           .jobs = c->jobs,
                           .stop = command_stops (),
                           .out = c->quiet ? NULL : stdout };
    if (c->force)
        PG_FAIL (PG_E_USAGE,
                 "--seeds goes on where it was; --force is for a single run: remove %s to begin anew",
                 q.folder);
    command_share (jobs, &threads, c->memory, memory);
    q.threads = threads;
    if (jobs > 1 || c->memory > 0) q.memory = memory;
    for (size_t k = 0; k < c->nset; k++) q.set[q.nset++] = c->set[k];
    if (q.out) fprintf (q.out, "%s: %ld runs in %s\n", c->scene, c->seeds, q.folder);
    PG_TRY (pg_seeds_run (&q, &peaks));
done:
    if (status != PG_OK) command_complain (status, pg_last_error ());
    return pg_exit_code (status);
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * CalculiX, compared with Perigal: the program ccx runs in a process on one thread, and its result (.frd) is
 * measured in another one with the norms that are used for Perigal. */
#include "process.h"
#include "bench.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* Returns what is missing to solve this scene by CalculiX, in words; NULL: nothing. */
static const char *missing (const char *path, const char *scene)
{
    return pg_bench_body_find (scene) && !pg_process_finds ("ccx")
               ? "ccx is not installed (Debian package calculix-ccx)"
               : pg_bench_mesh_missing (path, scene);
}

/* Adds a curve for each kind of element with a case for each mesh size (elements along the side), those asked
 * for or the default ones. If something is missing a single case with that message is added. */
pg_status pg_bench_fem_add (pg_bench_cases *out, const pg_bench_request *q, size_t s, const char *name)
{
    pg_status status = PG_OK;
    static const char *const usual[2][2] = { { "CPS4", "CPS8" }, { "C3D8I", "C3D20" } };
    static const char *const sizes[2][4] = { { "8", "16", "32", "64" }, { "2", "4", "8", NULL } };
    const char *why = missing (q->scene[s], name);
    const pg_bench_body *body = pg_bench_body_find (name);
    int solid = body && body->dim == 3, again = 0;
    size_t nelement = q->element.n ? q->element.n : 2, nsize = q->size.n ? q->size.n : solid ? 3 : 4;
    for (size_t i = 0; body && i < out->n; i++)        /* the body is there already, on other meshes */
        again |= out->at[i].fem && strcmp (out->at[i].group, body->group) == 0;
    for (size_t e = 0; e < (why ? 1 : nelement); e++, out->ncurve++)
        for (size_t k = 0; k < (why ? 1 : nsize); k++) {
            PG_GROW (out->at, out->cap, out->n + 1);
            pg_bench_case *c = &out->at[out->n++];
            memset (c, 0, sizeof *c);
            c->scene = s, c->curve = out->ncurve, c->fem = 1;
            pg_trial_read (&c->best, "");
            snprintf (c->name, sizeof c->name, "%s", name);
            snprintf (c->group, sizeof c->group, "%s", body ? body->group : name);
            snprintf (c->element, sizeof c->element, "%.15s",
                      q->element.n ? q->element.word[e] : usual[solid][e]);
            snprintf (c->method, sizeof c->method, "ccx %s%s", why ? "" : c->element, again ? " mesh" : "");
            c->size = strtol (q->size.n ? q->size.word[k] : sizes[solid][k], NULL, 10);
            if (why) snprintf (c->trouble, sizeof c->trouble, "skipped: %s", why);
        }
done:
    return status;
}

/* Measures errors and sizes of a result by `bench --fem-row` in a process of its own. Elements with
 * incompatible modes (C3D8I) have strains that do not follow from their displacement, so no energy error can
 * be derived from it. */
static pg_status measure (pg_trial *t, const pg_bench_case *c, const pg_bench_request *q, const char *job)
{
    pg_status status = PG_OK;
    pg_process *child = NULL;
    char result[4200], log[4200], text[512];
    const char *argv[2 * PG_TRIAL_SETS + 16] = { "perigal",   "bench",
                                        "--fem-row", q->scene[c->scene],
                                        result,      pg_bench_body_find (c->name)->unit };
    size_t n = 6;
    PG_ALLOC (child, 1);
    snprintf (result, sizeof result, "%s.frd", job);
    snprintf (log, sizeof log, "%s.log", job);
    for (size_t k = 0; k < q->nset; k++) argv[n++] = "--set", argv[n++] = q->set[k];
    PG_TRY (pg_process_run (child, NULL, argv, NULL, log, 1));
    pg_process_complaint (log, text, sizeof text);
    if (child->code != 0)
        PG_FAIL (PG_E_FILE, "%s", text[0] ? text : "the result of ccx could not be measured");
    pg_trial_read (t, child->text);
    /* its strains do not follow from its displacement */
    if (strchr (c->element, 'I')) t->value[PG_TRIAL_ENERGY] = NAN;
done:
    pg_free (child);
    return status;
}

/* Makes the mesh, runs ccx and, in the first run, measures the result. Repeats only find the least CPU
 * seconds, since the result is the same each time. */
pg_status pg_bench_fem_run (pg_bench_case *c, const pg_bench_request *q)
{
    pg_status status = PG_OK;
    pg_process *child = NULL;
    pg_trial t;
    char folder[4096], job[4160], name[64], log[4200];
    const char *argv[] = { "ccx", name, NULL };
    struct stat made;
    PG_ALLOC (child, 1);
    snprintf (folder, sizeof folder, "%s/fem", q->folder);
    pg_bench_mesh_name (c, name, sizeof name);
    snprintf (job, sizeof job, "%s/%s", folder, name);
    PG_TRY (pg_bench_mesh_make (c, q));
    PG_TRY (pg_process_run (child, "ccx", argv, folder, NULL, 1));
    /* remove the log of the equation solver, which ccx writes into its current folder */
    snprintf (log, sizeof log, "%s/spooles.out", folder);
    remove (log);
    snprintf (log, sizeof log, "%s.frd", job);
    if (child->code != 0 || stat (log, &made) != 0 || made.st_size == 0)
        PG_FAIL (PG_E_EQUILIBRIUM, "ccx %s ended with code %d and without a result", name, child->code);
    if (c->runs == 0) PG_TRY (measure (&c->best, c, q, job));
    t = c->best;
    if (c->runs < PG_BENCH_REPEATS) c->cpu[c->runs] = child->cpu;
    if (!c->runs++ || child->cpu < c->best.value[PG_TRIAL_CPU]) {
        t.value[PG_TRIAL_CPU] = child->cpu, t.value[PG_TRIAL_WALL] = child->wall,
        t.value[PG_TRIAL_PEAK] = (double) child->peak;
        c->best = t;
    }
done:
    pg_free (child);
    return status;
}

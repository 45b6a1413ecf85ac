/* SPDX-License-Identifier: GPL-3.0-or-later
 * Orders of convergence: a scene at decreasing spacings, each run a process of its own, and the order of
 * every number that it gives. Two limits are of interest in peridynamics (Bobaru et al. 2009):
 * delta-convergence, in which horizon and spacing decrease together, leads to the local solution;
 * m-convergence, in which the horizon is kept, to the nonlocal one of that horizon. */
#include "bench.h"
#include "converge.h"
#include <math.h>
#include <string.h>

/* Takes the errors at size k, as far as they are known. */
static pg_status take_errors (pg_study *s, size_t k, const pg_trial *t)
{
    pg_status status = PG_OK;
    static const struct { int id; const char *name;
    } errors[] = { { PG_TRIAL_L2, "L2 error" },
                   { PG_TRIAL_ENERGY, "energy error" },
                   { PG_TRIAL_MAXIMUM, "maximum error" },
                   { PG_TRIAL_LINES, "error on lines" } };
    for (size_t e = 0; e < sizeof errors / sizeof *errors; e++) {
        if (isnan (t->value[errors[e].id])) continue;
        pg_quantity *q = pg_study_quantity (s, errors[e].name, "1");
        if (!q) PG_FAIL (PG_E_MEMORY, "no memory for %s", errors[e].name);
        q->error = 1, q->value[k] = t->value[errors[e].id];
    }
done:
    return status;
}

/* Runs all sizes for one horizon, each in a folder of its own whose history.csv is read afterwards. Spacing
 * and horizon come after the overrides of the user, and the later value counts. A spacing that did not
 * decrease shows that the scene takes its points from elsewhere. */
static pg_status run_study (pg_study *s, const pg_converge_request *q, const pg_bench_base *b)
{
    pg_status status = PG_OK;
    for (size_t k = 0; k < q->sizes; k++) {
        char folder[4096], spacing[64], horizon[64];
        double h = b->spacing / pow (q->ratio, (double) k);
        pg_trial_request run = { .scene = q->scene, .folder = folder, .threads = q->threads };
        pg_trial t;
        snprintf (folder, sizeof folder, "%s/%s%g_%zu", q->folder, q->fixed ? "m" : "h", s->horizon, k + 1);
        snprintf (spacing, sizeof spacing, "spacing=%.15g", h);
        if (q->fixed) snprintf (horizon, sizeof horizon, "method.horizon=%.15g m", s->horizon * b->spacing);
        else snprintf (horizon, sizeof horizon, "method.horizon=%.15g spacing", s->horizon);
        for (size_t i = 0; i < q->nset; i++) run.set[run.nset++] = q->set[i];
        /* a later value of a key counts */
        run.set[run.nset++] = spacing, run.set[run.nset++] = horizon;
        PG_TRY (pg_trial_run (&t, &run));
        if (k && !(t.value[PG_TRIAL_SPACING] < s->h[k - 1]))
            PG_FAIL (PG_E_SCENE,
                     "%s: spacing %g m is no smaller than the one before: does the scene take its points "
                     "from a file?",
                     q->scene, t.value[PG_TRIAL_SPACING]);
        s->h[k] = t.value[PG_TRIAL_SPACING], s->n = k + 1;
        PG_TRY (take_errors (s, k, &t));
        PG_TRY (pg_converge_history (s, k, folder));
        if (q->out)
            fprintf (q->out, "  horizon %g, spacing %.6g m: %.0f points, %.2f s CPU\n", s->horizon, s->h[k],
                    t.value[PG_TRIAL_POINTS], t.value[PG_TRIAL_CPU]),
                fflush (q->out);
    }
done:
    return status;
}

/* Makes the studies of all horizons, then prints, writes and draws them. Without a list the horizon of the
 * scene is taken. */
static pg_status study_all (pg_study *list, pg_converge_request *q)
{
    pg_status status = PG_OK;
    pg_bench_base b;
    PG_TRY (pg_bench_look (&b, q->scene, q->nset, q->set));
    if (!(b.spacing > 0))
        PG_FAIL (PG_E_SCENE,
                 "%s: converge changes the spacing, and this scene has none: it needs a body and spacing",
                 q->scene);
    if (!q->nhorizon) q->horizon[q->nhorizon++] = b.horizon;
    PG_TRY (pg_folder_make (q->folder));
    for (size_t k = 0; k < q->nhorizon; k++) {
        list[k].horizon = q->horizon[k];
        PG_TRY (run_study (&list[k], q, &b));
    }
    for (size_t k = 0; k < q->nhorizon && q->out; k++) pg_converge_print (&list[k], q->fixed, q->out);
    PG_TRY (pg_converge_table (list, q->nhorizon, q->folder));
    int drawn = 0;
    PG_TRY (pg_converge_picture (list, q->nhorizon, q->folder, b.name, &drawn));
    if (q->out)
        fprintf (q->out, "  table %s/convergence.csv%s%s%s\n", q->folder, drawn ? ", picture " : "",
                drawn ? q->folder : "", drawn ? "/convergence.png" : "");
done:
    return status;
}

/* Runs a study of convergence; the list of studies is allocated, as it is too large for the stack. */
pg_status pg_converge_run (pg_converge_request *q)
{
    pg_status status = PG_OK;
    pg_study *list = NULL;
    PG_ALLOC (list, PG_CONVERGE_STUDIES);
    PG_TRY (study_all (list, q));
done:
    for (size_t k = 0; list && k < PG_CONVERGE_STUDIES; k++) pg_free (list[k].list);
    pg_free (list);
    return status;
}

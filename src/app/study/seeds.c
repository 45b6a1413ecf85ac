/* SPDX-License-Identifier: GPL-3.0-or-later
 * One scene with many seeds: the spread of its peak load. seeds.csv has a row for each run; the picture is a
 * histogram. */
#include "perigal/picture.h"
#include "series.h"
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The runs, their overrides of the scene as text, and their results. */
typedef struct {
    size_t n;
    pg_series_run *run;
    pg_series_result *result;
    char (*text)[PG_SERIES_SETS][64];
} series;

/* ---- what has a seed ----------------------------------------------------------------------------------- */
/* Writes the overrides that give every random item of the scene the seed s: the k-th of them s + 1000000 k,
 * so that two networks of one scene are not the same; fields: random fields in expressions come first, with s
 * + 1000000 j for the j-th different seed among them (random_field.seed). Returns the number of overrides. */
static size_t set_seeds (char text[PG_SERIES_SETS][64], const pg_scene *scene, int fields, long s)
{
    size_t n = 0;
    if (fields) snprintf (text[n++], sizeof *text, "random_field.seed=%ld", s);
    for (size_t i = 0, cracks = pg_scene_count (scene, "cracks"); i < cracks && n < PG_SERIES_SETS; i++)
        if (pg_scene_given (scene, "cracks[%zu].random", i)) {
            snprintf (text[n], sizeof *text, "cracks[%zu].random.seed=%ld", i, s + 1000000 * (long) n);
            n++;
        }
    if (pg_scene_given (scene, "perturb") && n < PG_SERIES_SETS) {
        snprintf (text[n], sizeof *text, "perturb.seed=%ld", s + 1000000 * (long) n);
        n++;
    }
    return n;
}

static pg_status name_runs (series *s, const pg_seeds_request *q)
{
    pg_status status = PG_OK;
    pg_scene *scene = NULL;
    char *text = NULL;
    PG_TRY (pg_scene_load_with (&scene, q->scene, q->nset, q->set));
    PG_TRY (pg_scene_echo (&text, scene));
    int fields = strstr (text, "random_field") != NULL;
    s->n = q->count;
    PG_ALLOC (s->run, s->n);
    PG_ALLOC (s->result, s->n);
    PG_ALLOC (s->text, s->n);
    for (size_t k = 0; k < s->n; k++) {
        pg_series_run *r = &s->run[k];
        long seed = q->first + (long) k;
        r->value = (double) seed;
        r->nset = set_seeds (s->text[k], scene, fields, seed);
        snprintf (r->name, sizeof r->name, "seed_%ld", seed);
        for (size_t i = 0; i < r->nset; i++) r->set[i] = s->text[k][i];
        if (r->nset == 0)
            PG_FAIL (PG_E_SCENE,
                     "%s: nothing in this scene has a seed: give random cracks (cracks: [{random: "
                     "...}]), perturb, or random_field in an expression",
                     q->scene);
    }
done:
    pg_scene_free (&scene);
    pg_free (text);
    return status;
}

/* ---- results ------------------------------------------------------------------------------------------- */
/* Writes a number as a cell, empty if it is not known. */
static void write_number (FILE *f, double x)
{
    if (isnan (x)) fprintf (f, ",");
    else fprintf (f, ",%.17g", x);
}

static pg_status write_table (const series *s, const char *folder)
{
    pg_status status = PG_OK;
    char path[4096];
    FILE *f = NULL;
    snprintf (path, sizeof path, "%s/seeds.csv", folder);
    f = fopen (path, "w");
    if (!f) PG_FAIL (PG_E_FILE, "%s: %s", path, strerror (errno));
    fprintf (f,
             "seed [1],peak [N],displacement [m],energy_dissipated [J],broken [1],seconds [s],failed [1]\n");
    for (size_t k = 0; k < s->n; k++) {
        const pg_series_result *r = &s->result[k];
        fprintf (f, "%.0f", s->run[k].value);
        write_number (f, r->peak), write_number (f, r->displacement), write_number (f, r->dissipated);
        write_number (f, r->broken), write_number (f, r->seconds);
        fprintf (f, ",%d\n", r->code != PG_EXIT_DONE);
    }
    int bad = ferror (f);
    if (fclose (f) != 0 || bad) status = PG_E_FILE;
    f = NULL;
    if (status != PG_OK) PG_FAIL (PG_E_FILE, "%s could not be written", path);
done:
    if (f) fclose (f);
    return status;
}

static void tell (FILE *out, const pg_spread *s, size_t runs, const char *folder)
{
    char mean[64], deviation[64], least[64], median[64], most[64];
    if (s->n == 0) {
        fprintf (out, "  no run has a peak load; table %s/seeds.csv\n", folder);
        return;
    }
    pg_picture_quantity (s->mean, "N", mean, sizeof mean);
    pg_picture_quantity (s->deviation, "N", deviation, sizeof deviation);
    pg_picture_quantity (s->least, "N", least, sizeof least);
    pg_picture_quantity (s->median, "N", median, sizeof median);
    pg_picture_quantity (s->most, "N", most, sizeof most);
    fprintf (out, "  peak load of %zu of %zu runs: mean %s", s->n, runs, mean);
    if (s->n > 1)
        fprintf (out, ", standard deviation %s (%.3g %%)", deviation, 100 * s->deviation / fabs (s->mean));
    fprintf (out, ", least %s, median %s, largest %s\n  table %s/seeds.csv%s%s%s\n", least, median, most,
             folder, s->n > 1 && s->most > s->least ? ", histogram " : "",
             s->n > 1 && s->most > s->least ? folder : "",
             s->n > 1 && s->most > s->least ? "/seeds.png" : "");
}

/* Ends the study if the scene or the command line of run k is wrong: it is then wrong for all seeds. */
static pg_status look (void *context, size_t k)
{
    pg_status status = PG_OK;
    const pg_series_result *r = &((const series *) context)->result[k];
    if (r->code == PG_EXIT_SCENE || r->code == PG_EXIT_USAGE) PG_FAIL (PG_E_SCENE, "%s", r->trouble);
done:
    return status;
}

pg_status pg_seeds_run (const pg_seeds_request *q, pg_spread *spread)
{
    pg_status status = PG_OK;
    series s = { 0 };
    double *peak = NULL;
    size_t failed = 0;
    char path[4096];
    int drawn;
    PG_TRY (name_runs (&s, q));
    pg_series_request all = { .scene = q->scene, .folder = q->folder, .nset = q->nset, .n = s.n, .run = s.run,
                              .threads = q->threads, .jobs = q->jobs, .memory = q->memory, .stop = q->stop,
                              .out = q->out, .ended = look,
                              .context = &s };
    for (size_t k = 0; k < q->nset; k++) all.set[k] = q->set[k];
    PG_ALLOC (peak, s.n);
    PG_TRY (pg_series_run_all (s.result, &all));
    for (size_t k = 0; k < s.n; k++) {
        failed += s.result[k].code != PG_EXIT_DONE;
        peak[k] = s.result[k].code == PG_EXIT_DONE ? s.result[k].peak : NAN;
    }
    PG_TRY (write_table (&s, q->folder));
    pg_spread_of (spread, s.n, peak);
    snprintf (path, sizeof path, "%s/seeds.png", q->folder);
    PG_TRY (pg_histogram_draw (&drawn, path, spread, peak, "peak load", "N", q->scene));
    if (q->out) tell (q->out, spread, s.n, q->folder);
    if (failed)
        PG_FAIL (PG_E_EQUILIBRIUM, "%zu of %zu runs failed: see %s/seed_*.log", failed, s.n, q->folder);
done:
    pg_free (peak), pg_free (s.run), pg_free (s.result), pg_free (s.text);
    return status;
}

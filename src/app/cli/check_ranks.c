/* SPDX-License-Identifier: GPL-3.0-or-later
 * perigal check SCENE --ranks N: what N processes (perigal-mpi) would do with a scene, without any of them:
 * which points each would hold, its memory, its messages; or the reason for which they would refuse it, in
 * the words of the run. The body is divided as the ranks divide it, part after part, so that scenes that no
 * machine can hold as a whole are answered too. */
#include "app/cli/preparation/cli.h"
#include <math.h>
#include <stdlib.h>

/* Results of check --ranks. divided 1: the ranks share the body; 0: each of them has all of it. */
typedef struct {
    const command *c;
    pg_forecast whole, largest;                        /* of one process; of the rank with the largest peak */
    /* peak bytes of each rank (c->ranks); points of the body */
    double     *peak, total;
    pg_part_size *part;                                /* sizes of each rank's part */
    int         divided, components, rank;             /* values a point exchanges; rank of `largest` */
    const char *occasion;                              /* when ghosts are exchanged: "a time step" ... */
    pg_statistics warned;                              /* warnings of the built problem */
} outlook;

/* ---- forecast of the ranks ----------------------------------------------------------------------------- */
/* Looks for all faults that a run on so many ranks would report, and for its warnings. If the whole body does
 * not fit this machine the problem is not built, and faults that show only then are not looked for (*built
 * 0). */
static pg_status look_for_faults (outlook *o, const pg_scene *scene, int *built)
{
    pg_status status = PG_OK;
    pg_ranks all;
    pg_problem *p = NULL;
    pg_solver_options options;
    pg_ranks_stand_in (&all, o->c->ranks);
    pg_ranks_join (&all);
    pg_ranks_divide (o->divided);
    *built = !(o->whole.peak > afford_available (o->c));
    if (*built) PG_TRY (command_problem (o->c, scene, &p, &options));
    else if (o->divided) PG_TRY (pg_subdomain_check (o->whole.method, scene));
done:
    pg_ranks_join (NULL);
    if (status == PG_OK && p) pg_solver_doubts (&o->warned, p, &options);
    pg_problem_free (&p);
    return status;
}

/* Finds the points, ghosts and messages of every rank where the ranks share the body. */
static pg_status divide (outlook *o, const pg_scene *scene)
{
    pg_status status = PG_OK;
    pg_body body = { 0 };
    double width, h;
    PG_TRY (pg_body_read (&body, scene));
    PG_TRY (pg_scene_verdict (scene));
    PG_TRY (pg_cloud_spacing (&h, &body, scene));
    PG_TRY (pg_subdomain_width (&width, o->whole.method, scene, body.dim, h));
    PG_TRY (pg_cloud_parts (o->part, &body, scene, width, o->c->ranks));
done:
    pg_body_clear (&body);
    return status;
}

/* Forecasts the memory of every rank, and finds the rank that needs most. */
static void foresee (outlook *o, const pg_scene *scene)
{
    for (int r = 0; r < o->c->ranks; r++) o->total += o->part[r].owned;
    if (!o->divided) o->total = o->whole.count.points;
    for (int r = 0; r < o->c->ranks; r++) {
        pg_forecast f = o->divided ? pg_forecast_of_part (&o->whole, &o->part[r], o->total,
                                                          r == 0 && pg_result_joins (scene, o->total))
                                   : pg_forecast_in_step (&o->whole, o->c->ranks);
        o->peak[r] = f.peak;
        if (r == 0 || f.peak > o->largest.peak) o->largest = f, o->rank = r;
    }
}

/* ---- printing ------------------------------------------------------------------------------------------ */
/* Least, largest and mean over the ranks of a number of each part. */
typedef struct { double least, most, mean; } spread;
static spread spread_of (const outlook *o, double (*number) (const pg_part_size *))
{
    spread s = { INFINITY, 0, 0 };
    for (int r = 0; r < o->c->ranks; r++) {
        double x = number (&o->part[r]);
        s.least = fmin (s.least, x), s.most = fmax (s.most, x), s.mean += x / o->c->ranks;
    }
    return s;
}
static double owned_by (const pg_part_size *p) { return p->owned; }
static double ghosts_of (const pg_part_size *p) { return p->ghosts; }
static double neighbours_of (const pg_part_size *p) { return p->neighbours; }
static double sent_by (const pg_part_size *p) { return p->sent; }

/* Prints sizes of the subdomains and of the messages between them. */
static void print_parts (const outlook *o)
{
    spread owned = spread_of (o, owned_by), ghosts = spread_of (o, ghosts_of),
           near = spread_of (o, neighbours_of), sent = spread_of (o, sent_by);
    printf ("  %-18s  subdomains: each rank holds its part of the %.0f points, and ghosts around it\n",
            "division", o->total);
    printf ("  %-18s  %.0f to %.0f, %.1f on average: the largest part has %.3f times the mean\n",
            "points of a rank", owned.least, owned.most, owned.mean, owned.most / owned.mean);
    printf ("  %-18s  %.0f to %.0f, %.1f on average: %.3g a point\n", "ghosts of a rank", ghosts.least,
            ghosts.most, ghosts.mean, ghosts.mean / owned.mean);
    printf ("  %-18s  %.0f to %.0f\n", "neighbours", near.least, near.most);
    printf ("  %-18s  once %s: a rank sends at most %.0f message%s and %.3g kB, all together %.3g kB\n",
            "exchange of ghosts", o->occasion, near.most, near.most > 1 ? "s" : "",
            8e-3 * o->components * sent.most, 8e-3 * o->components * sent.mean * o->c->ranks);
}

static void print_bytes (double bytes)
{
    if (bytes < 999.5e6) printf ("%.3g MB", bytes * 1e-6);
    else if (bytes < 999.5e9) printf ("%.3g GB", bytes * 1e-9);
    else printf ("%.3g TB", bytes * 1e-12);
}

static void print_all (const outlook *o)
{
    const pg_forecast *f = &o->largest;
    double sum = 0;
    for (int r = 0; r < o->c->ranks; r++) sum += o->peak[r];
    if (o->divided) print_parts (o);
    else {
        printf ("  %-18s  matrices: every rank holds all %.0f points and makes the same steps\n", "division",
                o->total);
        printf ("  %-18s  %s\n", "shared",
                o->whole.linear
                    ? "the factor of the matrix lies on all ranks (PETSc, MUMPS), which send each other what "
                      "belongs to it"
                    : "nothing: no matrix is factored; solver.linear: petsc factors on all ranks");
    }
    printf ("  %-18s  about ", "memory"), print_bytes (f->peak);
    printf (" on rank %d, which needs most, ", o->rank);
    print_bytes (sum), printf (" on all %d\n", o->c->ranks);
    for (int k = 0; k < PG_BYTES_COUNT; k++) {
        if (f->bytes[k] < 5e4) continue;
        printf ("    %-16s  ", pg_forecast_item (k)), print_bytes (f->bytes[k]), printf ("\n");
    }
}

static pg_status write_outlook (const void *what, const char *path)
{
    pg_status status = PG_OK;
    const outlook *o = what;
    pg_json *j = NULL;
    PG_TRY (pg_json_create (&j, path));
    pg_json_open (j, NULL, '{');
    pg_json_count (j, "ranks", (size_t) o->c->ranks);
    pg_json_text (j, "division", o->divided ? "subdomains" : "matrices");
    pg_json_count (j, "points", (size_t) o->total);
    if (o->divided) pg_json_text (j, "exchange", o->occasion);
    pg_json_open (j, "parts", '[');
    for (int r = 0; r < o->c->ranks; r++) {
        const pg_part_size *p = &o->part[r];
        pg_json_open (j, NULL, '{');
        pg_json_count (j, "owned", (size_t) (o->divided ? p->owned : o->total));
        pg_json_count (j, "ghosts", (size_t) p->ghosts);
        pg_json_count (j, "neighbours", (size_t) p->neighbours);
        pg_json_count (j, "sent", (size_t) p->sent);
        pg_json_count (j, "bytes_sent", (size_t) p->sent * sizeof (double) * (size_t) o->components);
        pg_json_number (j, "peak_bytes", o->peak[r]);
        pg_json_shut (j);
    }
    pg_json_shut (j);
    pg_json_shut (j);
    PG_TRY (pg_json_close (&j));
done:
    return status;
}

/* 1: c->ranks processes would share the body. */
static int would_divide (const command *c, const pg_scene *scene)
{
    pg_ranks all;
    pg_ranks_stand_in (&all, c->ranks);
    pg_ranks_join (&all);
    int divided = pg_subdomain_wanted (scene, pg_force_methods ());
    pg_ranks_join (NULL);
    return divided;
}

int check_ranks (const command *c)
{
    pg_status status = PG_OK;
    pg_scene *scene = NULL, *counted = NULL;
    outlook o = { .c = c, .occasion = "a time step" };
    int built = 1;
    PG_ALLOC (o.part, (size_t) c->ranks);
    PG_ALLOC (o.peak, (size_t) c->ranks);
    PG_TRY (command_scene (c, &scene));
    PG_TRY (command_scene (c, &counted));              /* faults are reported when the problem is built */
    if (pg_forecast_scene (&o.whole, counted, pg_force_methods ()) != PG_OK) o.whole.peak = 0;
    o.divided = would_divide (c, counted);
    PG_TRY (look_for_faults (&o, scene, &built));
    if (!(o.whole.peak > 0)) PG_TRY (pg_forecast_scene (&o.whole, counted, pg_force_methods ()));
    o.components = o.whole.dim + o.whole.rotations;
    if (pg_solver_is (pg_scene_text (scene, "solver.kind"), PG_SOLVER_IMPLICIT))
        o.occasion = "a product with the stiffness matrix";
    if (o.divided) PG_TRY (divide (&o, counted));
    foresee (&o, scene);
    if (c->json) {
        PG_TRY (json_to_stdout (write_outlook, &o));
        goto done;
    }
    printf ("%s: the scene is valid for %d rank%s\n", c->scene, c->ranks, c->ranks > 1 ? "s" : "");
    if (!built)
        printf ("  too large to be built by this machine as a whole: faults that show only then are not "
                "known\n");
    if (!c->quiet) print_all (&o);
    if (!c->quiet) plan_warnings (&o.warned, NULL);
done:
    if (status != PG_OK) command_complain (status, pg_last_error ());
    pg_scene_free (&counted), pg_scene_free (&scene);
    pg_free (o.part), pg_free (o.peak);
    return pg_exit_code (status);
}

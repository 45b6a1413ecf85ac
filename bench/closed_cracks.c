/* SPDX-License-Identifier: GPL-3.0-or-later
 * closed_cracks: cracks whose faces touch against closed forms (closed_crack_scenes.h).
 *
 *     build/release/bench/closed_cracks [show] [GROUP...]
 *
 * prints one line of comma-separated values for each case, over five lattices: stress intensity factor over
 * the right one (over that of the free crack where it sticks), mean, least, largest over lattices and tips;
 * pressure over the exact one, mean over the pieces but two at either tip, and the largest deviation of one;
 * the largest overlap of the mean gap of a piece and between points, over the slip of the free crack, 4
 * |tau| a / E; shares of pieces that are open and that stick; processor seconds of a run. show: every
 * lattice as well. */
#include "closed_crack_scenes.h"
#include <time.h>

typedef struct { const char *name, *plane; double nu; int n, bending; } group;
static const group groups[] = {
    { "stress-0.25-15", "stress", 0.25, 15, 0 }, { "stress-0.25-30", "stress", 0.25, 30, 0 },
    { "stress-0.45-15", "stress", 0.45, 15, 0 }, { "strain-0.2-15", "strain", 0.2, 15, 0 },
    { "strain-0.45-15", "strain", 0.45, 15, 0 }, { "strain-0.2-30", "strain", 0.2, 30, 0 },
    { "strain-0.45-30", "strain", 0.45, 30, 0 }, { "bending-15", "stress", 0.25, 15, 1 },
    { "bending-30", "stress", 0.25, 30, 1 },     { "bending-strain-0.45-15", "strain", 0.45, 15, 1 },
};
static const double degrees[] = { 30, 45, 60 }, frictions[] = { 0, 0.3, 0.6 };

/* What is gathered over lattices. */
typedef struct {
    int    n, runs;
    double sum, least, most, pressure, swing, overlap, between, seconds, factor, contact;
    long   open, stick, pieces, points;
} tally;

static void add_tip (tally *t, double K)
{
    t->least = t->n ? fmin (t->least, K) : K, t->most = t->n ? fmax (t->most, K) : K;
    t->sum += K, t->n++;
}

/* Pressure of the pieces but two at either tip over the exact one. */
static void add_pressure (tally *t, const closed_case *c, const pg_contact_values *v, size_t n)
{
    double sum = 0, exact = closed_exact_of (c).normal;
    for (size_t k = 2; k + 2 < n && !c->bending; k++) {
        sum += v[k].pressure / exact;
        t->swing = fmax (t->swing, fabs (v[k].pressure / exact - 1));
    }
    if (n > 4) t->pressure += sum / (double) (n - 4);
}

static pg_status measure (const closed_case *c, tally *t, int show)
{
    pg_status status = PG_OK;
    char *text = closed_text (c);
    pg_scene *scene = NULL;
    pg_problem *problem = NULL;
    pg_solver *solver = NULL;
    pg_state *state = NULL;
    pg_solver_options options;
    pg_step step = { 0 };
    size_t n;
    clock_t begun = clock ();
    if (!text) PG_FAIL (PG_E_MEMORY, "out of memory");
    PG_TRY (pg_scene_parse (&scene, text, "closed.yaml"));
    PG_TRY (pg_problem_build (&problem, scene, 1));
    PG_TRY (pg_solver_options_read (&options, problem, scene));
    PG_TRY (pg_solver_create (&solver, problem, &options));
    PG_TRY (pg_state_create (&state, problem, pg_solver_components (solver)));
    while (!pg_solver_done (solver, state)) PG_TRY (pg_solver_step (solver, state, &step));
    t->seconds += (double) (clock () - begun) / CLOCKS_PER_SEC;
    const pg_statistics *r = pg_solver_report (solver, state);
    const pg_contact_values *v = pg_solver_contact (solver, &n);
    double shear = closed_exact_of (c).shear, right = closed_right (c),
           slip = 4 * (c->bending ? 0.25 : fabs (shear)) * c->unit / 1000;
    if (fabs (right) < 1e-9) right = shear * sqrt (acos (-1) * c->unit);
    add_pressure (t, c, v, n);
    for (size_t i = 0; i < state->paths->ntip; i++) {
        const pg_tip_values *tip = pg_solver_tip (solver, state->paths->tip[i].id);
        double ahead = state->paths->tip[i].x[0] * cos (c->turn) + state->paths->tip[i].x[1] * sin (c->turn);
        if (c->bending && ahead < 0) continue;
        add_tip (t, tip->K[c->bending ? 0 : 1] / right);
        if (show) printf ("#   K %.4f\n", tip->K[c->bending ? 0 : 1] / right);
    }
    for (size_t k = 0; show && k < n; k++)
        printf ("#   piece at %.3f a: pressure %.4g, shear %.4g, gap %.3g, slip %.4g\n",
                v[k].arc / c->unit, v[k].pressure, v[k].shear[0], v[k].gap, v[k].slip[0]);
    t->overlap = fmax (t->overlap, r->contact.overlap / slip);
    t->between = fmax (t->between, r->contact.overlap_max / slip);
    t->factor += r->seconds[PG_SECONDS_FACTOR], t->contact += r->contact.seconds;
    t->open += r->contact.open, t->stick += r->contact.stick, t->pieces += r->contact.pieces;
    t->points = (long) problem->cloud.n, t->runs++;
done:
    pg_state_free (&state), pg_solver_free (&solver), pg_problem_free (&problem), pg_scene_free (&scene);
    pg_free (text);
    return status;
}

static pg_status run_case (const group *g, double load, double friction, int show)
{
    pg_status status = PG_OK;
    tally t = { 0 };
    for (size_t k = 0; k < CLOSED_LATTICES; k++) {
        const closed_lattice *l = &closed_lattices[k];
        closed_case c = { .bending = g->bending, .load = load * acos (-1) / 180, .friction = friction,
                          .turn = l->turn, .shift = { l->shift[0], l->shift[1] }, .perturb = l->perturb,
                          .unit = 1, .n = g->n, .plane = g->plane, .nu = g->nu };
        if (show) printf ("# %s, %g degrees, friction %g, %s\n", g->name, load, friction, l->name);
        PG_TRY (measure (&c, &t, show));
    }
    double all = (double) t.pieces, runs = t.runs;
    printf ("%s,%g,%g,%ld,%.4f,%.4f,%.4f,%.4f,%.3f,%.1e,%.1e,%.3f,%.3f,%.2f,%.3f,%.3f\n", g->name, load,
            friction,
            t.points, t.sum / t.n, t.least, t.most, t.pressure / runs, t.swing, t.overlap, t.between,
            (double) t.open / all, (double) t.stick / all, t.seconds / runs, t.factor / runs,
            t.contact / runs);
    fflush (stdout);
done:
    return status;
}

int main (int argc, char **argv)
{
    pg_status status = PG_OK;
    int show = argc > 1 && strcmp (argv[1], "show") == 0, first = show ? 2 : 1;
    printf ("group,degrees,friction,points,K,least,most,pressure,swing,overlap,between,open,stick,run_s,"
            "factor_s,contact_s\n");
    for (size_t k = 0; k < sizeof groups / sizeof *groups; k++) {
        const group *g = &groups[k];
        int wanted = argc <= first;
        for (int i = first; i < argc; i++) wanted |= strcmp (argv[i], g->name) == 0;
        for (int i = 0; wanted && i < (g->bending ? 1 : 9); i++)
            PG_TRY (run_case (g, g->bending ? 90 : degrees[i / 3], g->bending ? 0 : frictions[i % 3], show));
    }
done:
    if (status != PG_OK) fprintf (stderr, "closed_cracks: %s\n", pg_last_error ());
    return status != PG_OK;
}

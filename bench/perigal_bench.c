/* SPDX-License-Identifier: GPL-3.0-or-later
 * perigal_bench: runs one case of cases.h through the library and prints one CSV row: what was solved, how
 * well, how fast.
 *     perigal_bench list [GROUP] names of the cases perigal_bench header column names perigal_bench NAME a
 *         row
 * One process per row, so that the peak memory is that of the case. Nothing is written but the row. */
#include "perigal.h"
#include "cases.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

typedef struct {
    double peak_load, across, along;                   /* N; relative errors (NAN: no reference) */
    double build, total, cpu;                          /* s */
} outcome;

/* Force on the body through the load named top, along y. */
static double top_force (const pg_problem *p, const pg_step *step)
{
    for (size_t l = 0; l < p->nload; l++)
        if (strcmp (p->load[l].name, "top") == 0) return fabs (step->reaction[3 * l + 1]);
    return NAN;
}

/* Stress at the point nearest to the origin against the disk under two point loads P (Timoshenko and Goodier,
 * section 41). */
static pg_status against_disk (const pg_problem *p, pg_solver *solver, const pg_state *state, double load,
                               outcome *out)
{
    pg_status status = PG_OK;
    void *self;
    const pg_force_type *force = pg_solver_force (solver, &self);
    double *stress = NULL,
           unit = load / (acos (-1.0) * (p->cloud.high[1] - p->cloud.low[1]) * p->cloud.thickness);
    size_t centre = 0;
    int components;
    const char *si;
    PG_ALLOC (stress, 6 * p->cloud.n);
    PG_TRY (force->field (self, state, state->d, "stress", &components, &si, stress));
    for (size_t i = 0; i < p->cloud.n; i++)
        if (hypot (p->cloud.x[2 * i], p->cloud.x[2 * i + 1])
            < hypot (p->cloud.x[2 * centre], p->cloud.x[2 * centre + 1]))
            centre = i;
    out->across = stress[centre * (size_t) components] / (2 * unit) - 1;
    out->along = stress[centre * (size_t) components + 1] / (-6 * unit) - 1;
done:
    pg_free (stress);
    return status;
}

static void print_header (void)
{
    puts ("group,case,method,points,evaluation_points,bonds,dofs,error_across,error_along,peak_load_N,load_"
          "factor,steps,events,rounds,bonds_broken,"
          "factorizations,solves,residual_max,build_s,shape_s,analyse_s,factor_s,solve_s,force_s,break_s,"
          "assemble_s,update_s,total_s,cpu_s,ms_per_round,peak_bytes,outcome");
}

static void print_error (double error)
{
    if (isnan (error)) putchar (',');
    else printf ("%.6e,", error);
}

static void print_row (const bench_case *c, const pg_problem *p, const pg_solver_options *o,
                       const pg_state *state, const pg_statistics *r, const outcome *out)
{
    static const char *const rule[] = { "worst", "fraction", "all" };
    printf ("%s,%s,%s %s %s %s,%zu,%zu,%zu,%zu,", c->group, c->name, p->approx.type->name,
            p->integration->name, o->event ? "event" : "fixed",
            p->criterion->type ? rule[o->break_mode] : "-", p->cloud.n, p->rows[PG_POINTS].n,
            p->first_bond[PG_BOND_SETS], state->ndof);
    print_error (out->across);
    print_error (out->along);
    printf ("%.6g,%.6g,%ld,%ld,%ld,%ld,%ld,%ld,%.3e,%.4f,", out->peak_load, state->factor, r->steps,
            r->events, r->iterations, r->broken, r->factorizations, r->solves, r->residual_max, out->build);
    for (int k = 0; k < PG_SECONDS_COUNT; k++) printf ("%.4f,", r->seconds[k]);
    printf ("%.4f,%.4f,%.4f,%zu,%s\n", out->total, out->cpu,
            r->iterations ? 1e3 * (out->total - out->build) / (double) r->iterations : 0,
            pg_memory_process_peak (), r->nwarning ? "warned" : "done");
    for (size_t k = 0; k < r->nwarning; k++) fprintf (stderr, "    %s: %s\n", c->name, r->warning[k]);
}

static pg_status run_case (const bench_case *c, int threads)
{
    pg_status status = PG_OK;
    pg_scene *scene = NULL;
    pg_problem *problem = NULL;
    pg_solver *solver = NULL;
    pg_state *state = NULL;
    pg_solver_options options;
    pg_step step;
    outcome out = { 0, NAN, NAN, 0, 0, 0 };
    double start = pg_seconds ();
    size_t nset = 0;
    while (nset < OVERRIDES && c->set[nset]) nset++;
    PG_TRY (pg_scene_load_with (&scene, c->scene, nset, c->set));
    PG_TRY (pg_problem_build (&problem, scene, threads));
    PG_TRY (pg_solver_options_read (&options, problem, scene));
    PG_TRY (pg_solver_create (&solver, problem, &options));
    PG_TRY (pg_state_create (&state, problem, pg_solver_components (solver)));
    out.build = pg_seconds () - start;
    while (!pg_solver_done (solver, state)) {
        PG_TRY (pg_solver_step (solver, state, &step));
        out.peak_load = fmax (out.peak_load, top_force (problem, &step));
    }
    out.total = pg_seconds () - start, out.cpu = (double) clock () / CLOCKS_PER_SEC;
    if (c->reference == DISK_CENTRE) PG_TRY (against_disk (problem, solver, state, out.peak_load, &out));
    print_row (c, problem, &options, state, pg_solver_report (solver, state), &out);
done:
    pg_state_free (&state);
    pg_solver_free (&solver);
    pg_problem_free (&problem);
    pg_scene_free (&scene);
    return status;
}

int main (int argc, char **argv)
{
    const char *threads = getenv ("PERIGAL_BENCH_THREADS");
    if (argc >= 2 && strcmp (argv[1], "list") == 0) {
        for (size_t k = 0; k < CASES; k++)
            if (argc < 3 || strcmp (argv[2], cases[k].group) == 0) puts (cases[k].name);
        return 0;
    }
    if (argc == 2 && strcmp (argv[1], "header") == 0) {
        print_header ();
        return 0;
    }
    for (size_t k = 0; argc == 2 && k < CASES; k++) {
        if (strcmp (argv[1], cases[k].name) != 0) continue;
        if (run_case (&cases[k], threads && atoi (threads) > 0 ? atoi (threads) : 1) == PG_OK) return 0;
        fprintf (stderr, "perigal_bench: %s: %s\n", cases[k].name, pg_last_error ());
        return 70;
    }
    fprintf (stderr, "usage: perigal_bench list [GROUP] | header | NAME\n");
    return 64;
}

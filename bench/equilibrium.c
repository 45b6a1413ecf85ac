/* SPDX-License-Identifier: GPL-3.0-or-later
 * Times the equilibrium of bond-based bodies (plate with a hole, the same with a crack through most of
 * it, cantilever, irregular points, cube) and of micropolar ones (the same plate, and the cube with a
 * penny-shaped flaw of data/chen_cube). A CSV row for each body, size and method: conjugate gradients
 * with the multilevel preconditioner, conjugate gradients with the diagonal, and the factorization of K
 * by CHOLMOD.
 *     equilibrium [BODY [POINTS ALONG ITS EDGE]]      without arguments: all
 * Set-up and solution in processor seconds of all threads, the solution in wall seconds too, each as
 * least, median and largest of three (CHOLMOD: one). Relative residual 1e-8. error: largest difference to
 * the factorization, over the largest displacement, where a factorization was made: up to 4e4 unknowns in
 * 2D and 15e3 in 3D. The diagonal is tried up to 5e5 unknowns. PERIGAL_BENCH_THREADS: threads (1). */
#include "perigal/force.h"
#include "perigal/scene.h"
#include "spread.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double tolerance = 1e-8;
enum { REPEATS = 3 };

/* ---- bodies -------------------------------------------------------------------------------------------- */
#define ROCK2 \
    "thickness: 1\nmaterials: {rock: {youngs_modulus: 10, poissons_ratio: 0.333333333333, density: 3}}\n"
#define HOLE \
    "body: [{add: {box: {low: [0, 0], high: [1, 1]}}}, {subtract: {disk: {center: [0.5, 0.5], diameter: " \
    "0.2}}}]\ncells: staircase\n"
#define PULL2 \
    "boundary: [{set: bottom, displacement: {x: 0, y: 0}}, {set: top, displacement: {x: 0, y: 0.01}}]\n"
typedef struct { const char *name; int dim; double length; size_t sizes[5]; const char *text; } body;
static const body bodies[] = {
    { "hole",
      2,
      1,
      { 100, 200, 400, 1000 },
      "dimension: 2\nlattice: cells\nmethod: {force: bond, kernel: constant, horizon: 3.015 spacing}\n" ROCK2
          HOLE PULL2 },
    { "crack",
      2,
      1,
      { 100, 200, 400 },
      "dimension: 2\nlattice: cells\nmethod: {force: bond, kernel: constant, horizon: 3.015 spacing}\n" ROCK2
          HOLE PULL2 "cracks: [{from: [0.1, 0.7003], to: [0.9, 0.7503]}]\n" },
    { "cantilever",
      2,
      10,
      { 500, 1000, 2000 },
      "dimension: 2\nlattice: cells\nmethod: {force: bond, kernel: quadratic, horizon: 3.015 spacing}\n" ROCK2
      "body: [{add: {box: {low: [0, 0], high: [10, 1]}}}]\nboundary: [{set: left, displacement: {x: 0, y: "
      "0}}, {set: right, traction: {y: -0.01}}]\n" },
    { "irregular",
      2,
      1,
      { 100, 200, 400 },
      "dimension: 2\nperturb: {amount: 0.2}\nmethod: {force: bond, kernel: constant, horizon: 3.015 "
      "spacing}\n" ROCK2 HOLE PULL2 },
    { "cube",
      3,
      1,
      { 16, 32, 64 },
      "dimension: 3\nlattice: cells\nmethod: {force: bond, kernel: constant, horizon: 3.015 spacing}\n"
      "materials: {rock: {youngs_modulus: 10, poissons_ratio: 0.25, density: 3}}\nbody: [{add: {box: {low: "
      "[0, 0, 0], high: [1, 1, 1]}}}]\n"
      "boundary: [{set: bottom, displacement: {x: 0, y: 0, z: 0}}, {set: top, displacement: {y: 0.01}}]\n" },
    { "beams",
      2,
      1,
      { 100, 400 },
      "dimension: 2\nlattice: cells\nmethod: {force: gmpd, horizon: 3 spacing}\n"
      "thickness: 1\nmaterials: {rock: {youngs_modulus: 10, poissons_ratio: 0.2, density: 3}}\n" HOLE PULL2 },
    { "flaw",
      3,
      0.04,
      { 10, 20, 40 },
      "dimension: 3\nlattice: cells\nmethod: {force: gmpd, horizon: 3 spacing}\n"
      "materials: {resin: {youngs_modulus: 3.81 GPa, poissons_ratio: 0.2, density: 1210 kg/m3}}\n"
      "body: [{add: {box: {low: [-20 mm, -20 mm, -20 mm], high: [20 mm, 20 mm, 20 mm]}}}]\n"
      "layers: [{name: foot, side: bottom, thickness: 3 spacing}, {name: head, side: top, thickness: 3 "
      "spacing}]\n"
      "cracks: [{disc: {center: [0, 0, 0], normal: [-0.5, 0.8660254, 0], radius: 5 mm}}]\n"
      "boundary: [{set: foot, displacement: {x: 0, y: 0.348 mm, z: 0}}, {set: head, displacement: {x: 0, y: "
      "-0.348 mm, z: 0}}]\n" },
};
enum { BODIES = sizeof bodies / sizeof *bodies };

typedef struct {
    const char *name;
    pg_scene *scene;  pg_problem *problem;  pg_state *state;
    const pg_force_type *force;  void *self;
    const pg_operator *K;
    unsigned char *fixed;
    double *r, *x, *exact;                             /* exact: by the factor, NULL: not made */
    size_t n;
    int components;                                    /* unknowns of a point */
} job;

static pg_status start (job *j, const body *b, size_t along, int threads)
{
    pg_status status = PG_OK;
    char text[2000];
    double reference;
    pg_field field[2];
    snprintf (text, sizeof text, "%sspacing: %.17g\nsolver: {kind: static}\n", b->text,
              b->length / (double) along);
    *j = (job) { .name = b->name };
    PG_TRY (pg_scene_parse (&j->scene, text, b->name));
    PG_TRY (pg_problem_build (&j->problem, j->scene, threads));
    j->force = pg_force_of (j->problem);
    PG_TRY (j->force->create (&j->self, j->problem));
    size_t nfield = j->force->fields (j->self, 2, field);
    for (size_t k = 0; k < nfield && k < 2; k++) j->components += field[k].components;
    PG_TRY (pg_state_create (&j->state, j->problem, j->components));
    PG_TRY (j->force->refresh (j->self, j->state, NULL));
    j->K = j->force->operator_ (j->self), j->n = j->K->n;
    PG_ALLOC (j->fixed, j->n);
    PG_ALLOC (j->r, j->n);
    PG_ALLOC (j->x, j->n);
    const pg_sparse *T = j->force->basis (j->self);
    memset (j->fixed, 1, j->n);
    for (size_t k = 0; k < T->ncol; k++) j->fixed[T->row[k]] = 0;
    j->force->impose (j->self, 1, j->x);
    PG_TRY (j->force->balance (j->self, 1, j->x, j->r, &reference));
    for (size_t i = 0; i < j->n; i++) if (j->fixed[i]) j->r[i] = 0;
done:
    return status;
}

static void stop (job *j)
{
    if (j->self) j->force->free (&j->self);
    pg_free (j->fixed), pg_free (j->r), pg_free (j->x), pg_free (j->exact);
    pg_state_free (&j->state), pg_problem_free (&j->problem), pg_scene_free (&j->scene);
}

static void apply (void *context, const double *x, double *y)
{
    const job *j = context;
    j->K->apply (j->K->context, x, y);
    for (size_t i = 0; i < j->n; i++) if (j->fixed[i]) y[i] = 0;
}

static void diagonal (void *context, double *d) { const job *j = context; j->K->diagonal (j->K->context, d); }

/* ---- methods ------------------------------------------------------------------------------------------- */
static void row (const job *j, const char *way, const char *levels, size_t iterations, spread *set_up,
                 spread *solve, spread *wall)
{
    double worst = 0, top = 0;
    for (size_t i = 0; j->exact && i < j->n; i++)
        worst = fmax (worst, fabs (j->x[i] - j->exact[i])), top = fmax (top, fabs (j->exact[i]));
    printf ("%s,%zu,%zu,%d,%s,%s,%zu,", j->name, j->problem->cloud.n, j->n, j->problem->threads, way, levels,
            iterations);
    spread_print (set_up, 1);
    spread_print (solve, 1);
    spread_print (wall, 1);
    if (j->exact) printf ("%.2e\n", worst / top);
    else puts ("");
    fflush (stdout);
}

static pg_status by_factor (job *j)
{
    pg_status status = PG_OK;
    const pg_linear_type *cholmod = pg_linear_find ("cholmod");
    const pg_sparse *T = j->force->basis (j->self);
    pg_sparse A = { 0 };
    void *factor = NULL;
    spread set_up = { 0 }, solve = { 0 }, wall = { 0 };
    double t0 = spread_processor (), *b = NULL, *q = NULL;
    pg_linear_options o = { 1, j->problem->dim, j->problem->threads, 0, 0 };
    PG_ALLOC (b, j->n);
    PG_ALLOC (q, j->n);
    PG_ALLOC (j->exact, j->n);
    PG_TRY (pg_force_assemble (j->force, j->self, NULL));
    PG_TRY (pg_sparse_congruence (&A, pg_force_matrix (j->force, j->self), T));
    PG_TRY (cholmod->analyse (&factor, &A, &o));
    PG_TRY (cholmod->factor (factor, &A));
    double t1 = spread_processor (), w1 = pg_seconds ();
    pg_sparse_multiply_transposed (T, j->r, b);
    PG_TRY (cholmod->solve (factor, 1, b, q));
    pg_sparse_multiply (T, q, j->exact);
    spread_add (&set_up, t1 - t0), spread_add (&solve, spread_processor () - t1);
    spread_add (&wall, pg_seconds () - w1);
    memcpy (j->x, j->exact, j->n * sizeof *j->x);
    row (j, "cholmod", "", 0, &set_up, &solve, &wall);
done:
    if (factor) cholmod->free (&factor);
    pg_sparse_clear (&A);
    pg_free (b), pg_free (q);
    return status;
}

static pg_status by_gradients (job *j, int multilevel)
{
    pg_status status = PG_OK;
    pg_multilevel_setting s = { .dim = j->problem->dim,
                                .block = j->components,
                                .threads = j->problem->threads,
                                .n = j->problem->cloud.n,
                                .x = j->problem->cloud.x,
                                .fixed = j->fixed,
                                .A = j->K };
    pg_operator A = { j->n, j, apply, diagonal };
    pg_multilevel *m = NULL;
    pg_multilevel_info info = { 0 };
    spread set_up = { 0 }, solve = { 0 }, wall = { 0 };
    size_t used = 0;
    char levels[100] = "";
    for (int k = 0; k < REPEATS; k++) {
        pg_multilevel_free (&m);
        double t0 = spread_processor ();
        if (multilevel) PG_TRY (j->force->spares.couplings (j->self, &s.rows));
        if (multilevel) PG_TRY (pg_multilevel_create (&m, &s));
        double t1 = spread_processor (), w1 = pg_seconds ();
        pg_preconditioner P = { 0 };
        if (m) P = pg_multilevel_preconditioner (m);
        memset (j->x, 0, j->n * sizeof *j->x);
        PG_TRY (pg_conjugate_gradients_with (&A, m ? &P : NULL, j->r, j->x, tolerance, 100000, &used));
        spread_add (&set_up, t1 - t0), spread_add (&solve, spread_processor () - t1);
        spread_add (&wall, pg_seconds () - w1);
    }
    if (m) pg_multilevel_describe (m, &info);
    for (int k = 0, at = 0; k < info.levels; k++)
        at += snprintf (levels + at, sizeof levels - (size_t) at, "%s%zu", k ? " " : "", info.unknowns[k]);
    row (j, m ? "multilevel" : "diagonal", levels, used, &set_up, &solve, &wall);
done:
    pg_multilevel_free (&m);
    return status;
}

int main (int argc, char **argv)
{
    pg_status status = PG_OK;
    const char *text = getenv ("PERIGAL_BENCH_THREADS");
    int threads = text ? atoi (text) : 1;
    puts ("body,points,dofs,threads,way,levels,iterations,set_up_s_min,set_up_s_median,set_up_s_max,"
          "solve_s_min,solve_s_median,solve_s_max,wall_s_min,wall_s_median,wall_s_max,error");
    for (int b = 0; b < BODIES; b++) {
        if (argc > 1 && strcmp (argv[1], bodies[b].name) != 0) continue;
        for (int k = 0; k < 5 && bodies[b].sizes[k]; k++) {
            job j = { 0 };
            size_t along = argc > 2 ? strtoul (argv[2], NULL, 10) : bodies[b].sizes[k];
            PG_TRY (start (&j, &bodies[b], along, threads));
            if (j.n <= (j.problem->dim == 3 ? 15000 : 40000)) PG_TRY (by_factor (&j));
            if (j.n <= 500000) PG_TRY (by_gradients (&j, 0));
            PG_TRY (by_gradients (&j, 1));
            stop (&j);
            if (argc > 2) break;
        }
    }
done:
    if (status != PG_OK) fprintf (stderr, "equilibrium: %s\n", pg_last_error ());
    return status != PG_OK;
}

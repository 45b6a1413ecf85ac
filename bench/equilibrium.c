/* SPDX-License-Identifier: GPL-3.0-or-later
 * Draft: multilevel tuning. equilibrium N step degree threads [jacobi] */
#include "perigal/force.h"
#include "perigal/scene.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <math.h>
#include <time.h>
static double cpu (void) { struct timespec t; clock_gettime (CLOCK_PROCESS_CPUTIME_ID, &t); return (double) t.tv_sec + 1e-9 * (double) t.tv_nsec; }
static const pg_operator *K;
static unsigned char *fixed;
static void apply (void *c, const double *x, double *y) { (void) c; K->apply (K->context, x, y); for (size_t i = 0; i < K->n; i++) if (fixed[i]) y[i] = 0; }
static void diagonal (void *c, double *d) { (void) c; K->diagonal (K->context, d); for (size_t i = 0; i < K->n; i++) if (fixed[i]) d[i] = 0; }
int main (int argc, char **argv)
{
    if (argc < 5) return 1;
    int n = atoi (argv[1]), degree = atoi (argv[3]), threads = atoi (argv[4]), dim = 2;
    double step = atof (argv[2]);
    const char *kind = argc > 5 ? argv[5] : "plate";
    char text[4000];
    if (strcmp (kind, "cube") == 0) {
        dim = 3;
        snprintf (text, sizeof text, "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [1, 1, 1]}}}]\nspacing: %.17g\nlattice: cells\n"
            "materials: {rock: {youngs_modulus: 10, poissons_ratio: 0.25, density: 3}}\nmethod: {force: bond, kernel: constant, horizon: 3.015 spacing}\n"
            "sets: {a: {where: \"y < %.17g\"}, b: {where: \"y > %.17g\"}}\n"
            "boundary: [{set: a, displacement: {x: 0, y: 0, z: 0}}, {set: b, displacement: {y: 0.01}}]\nsolver: {kind: static}\n", 1.0 / n, 3.0 / n, 1 - 3.0 / n);
    } else if (strcmp (kind, "beam") == 0)
        snprintf (text, sizeof text, "dimension: 2\nplane: stress\nbody: [{add: {box: {low: [0, 0], high: [10, 1]}}}]\nspacing: %.17g\nlattice: cells\nthickness: 1\n"
            "materials: {rock: {youngs_modulus: 10, poissons_ratio: 0.3333333333, density: 3}}\nmethod: {force: bond, kernel: quadratic, horizon: 3.015 spacing}\n"
            "sets: {a: {where: \"x < %.17g\"}, b: {where: \"x > %.17g\"}}\n"
            "boundary: [{set: a, displacement: {x: 0, y: 0}}, {set: b, force: {y: -0.01}}]\nsolver: {kind: static}\n", 10.0 / n, 3 * 10.0 / n, 10 - 10.0 / n);
    else
        snprintf (text, sizeof text, "dimension: 2\nplane: stress\nbody: [{add: {box: {low: [0, 0], high: [1, 1]}}}, {subtract: {disk: {center: [0.5, 0.5], diameter: 0.2}}}]\nspacing: %.17g\nlattice: cells\ncells: staircase\nthickness: 1\n"
            "materials: {rock: {youngs_modulus: 10, poissons_ratio: 0.3333333333, density: 3}}\nmethod: {force: bond, kernel: constant, horizon: 3.015 spacing}\n%s"
            "sets: {a: {where: \"y < %.17g\"}, b: {where: \"y > %.17g\"}}\n"
            "boundary: [{set: a, displacement: {x: 0, y: 0}}, {set: b, displacement: {x: 0, y: 0.01}}]\nsolver: {kind: static}\n", 1.0 / n,
            strcmp (kind, "crack") == 0 ? "cracks: [{from: [0.1, 0.7003], to: [0.9, 0.7503]}]\n" : "", 3.0 / n, 1 - 3.0 / n);
    pg_scene *scene; pg_problem *p; pg_state *state; void *self; const pg_force_type *force = pg_force_find ("bond");
    double t0 = cpu ();
    if (pg_scene_parse (&scene, text, "bench") || pg_problem_build (&p, scene, threads) || pg_state_create (&state, p, dim) || force->create (&self, p)
        || force->refresh (self, state, NULL)) { puts (pg_last_error ()); return 1; }
    printf ("problem %.3f s cpu, %zu points\n", cpu () - t0, p->cloud.n);
    K = force->operator_ (self);
    fixed = calloc (K->n, 1);
    const pg_sparse *T = force->basis (self);
    memset (fixed, 1, K->n);
    for (size_t j = 0; j < T->ncol; j++) fixed[T->row[j]] = 0;
    double *x = calloc (K->n, 8), *r = calloc (K->n, 8), *d = calloc (K->n, 8), ref;
    force->impose (self, 1, d);
    force->balance (self, 1, d, r, &ref);
    for (size_t i = 0; i < K->n; i++) if (fixed[i]) r[i] = 0;
    pg_couplings rows;
    t0 = cpu (); double w0 = pg_seconds ();
    force->couplings (self, &rows);
    pg_multilevel_setting s = { .dim = dim, .block = dim, .threads = threads, .n = p->cloud.n, .x = p->cloud.x, .fixed = fixed, .A = K, .rows = rows, .step = step, .degree = degree };
    pg_multilevel *m = NULL;
    if (pg_multilevel_create (&m, &s)) { puts (pg_last_error ()); return 1; }
    double t1 = cpu (), w1 = pg_seconds ();
    pg_multilevel_info info;
    pg_multilevel_describe (m, &info);
    printf ("set-up %.3f s cpu %.3f wall; levels", t1 - t0, w1 - w0);
    for (int k = 0; k < info.levels; k++) printf (" %zu (%.2f)", info.unknowns[k], info.top[k]);
    printf ("; split %zu\n", info.split);
    pg_preconditioner P = pg_multilevel_preconditioner (m);
    pg_operator A = { K->n, NULL, apply, diagonal };
    size_t used = 0;
    for (int k = 0; k < 3; k++) {
        memset (x, 0, K->n * 8);
        t0 = cpu (), w0 = pg_seconds ();
        pg_status now = pg_conjugate_gradients_with (&A, &P, r, x, 1e-10, 1000, &used);
        printf ("multilevel: %zu iterations %.3f s cpu %.3f s wall %s\n", used, cpu () - t0, pg_seconds () - w0, now ? pg_last_error () : "");
    }
    t0 = cpu (), w0 = pg_seconds ();
    for (int k = 0; k < 10; k++) K->apply (K->context, r, x);
    printf ("product %.2f ms cpu %.2f wall\n", (cpu () - t0) * 100, (pg_seconds () - w0) * 100);
    if (argc > 6) {
        memset (x, 0, K->n * 8);
        t0 = cpu (), w0 = pg_seconds ();
        pg_status now = pg_conjugate_gradients_with (&A, NULL, r, x, 1e-10, 100000, &used);
        printf ("jacobi: %zu iterations %.3f s cpu %.3f wall %s\n", used, cpu () - t0, pg_seconds () - w0, now ? pg_last_error () : "");
    }
    return 0;
}

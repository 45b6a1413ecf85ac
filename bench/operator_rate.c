/* SPDX-License-Identifier: GPL-3.0-or-later
 * Products K x of galerkin without a matrix, beside what the memory of the machine can do. A CSV row for each
 * kind of body: unknowns, bonds (entries of the rows that a product reads), their bytes, milliseconds of a
 * product, bytes over seconds (GB/s), and the share of the rate of a plain copy of large vectors.
 *     operator_rate [BODY [POINTS ALONG ITS EDGE]]      without arguments: all bodies
 *     operator_rate FILE.yaml [FILE.yaml ...]           scenes with this force
 * A product reads, of every bond, the derivatives of a shape function (8 bytes a component) and the number
 * of a node (4), and of a body with Silling's stabilisation the weight of the bond (8) as well. Times are
 * processor seconds of all threads; each row has the least, the median and the largest of repeats over half a
 * second. `copy`: a = b of 64 MB, read and write both counted (McCalpin's STREAM).
 * PERIGAL_BENCH_THREADS: threads (1). */
#include "perigal/force.h"
#include "perigal/scene.h"
#include "spread.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double least_time = 0.5;                  /* of a row, s */
enum { COPY = 8 << 20 };                               /* numbers copied at a time */

/* ---- bodies -------------------------------------------------------------------------------------------- */
#define STEEL "materials: {steel: {youngs_modulus: 200 GPa, poissons_ratio: 0.3, density: 7800}}\n"
#define CUBE \
    "dimension: 3\n" STEEL "body: [{add: {box: {low: [0, 0, 0], high: [1, 1, 1]}}}]\n" \
    "boundary: [{set: bottom, displacement: {x: 0, y: 0, z: 0}}, {set: top, traction: {y: 1 MPa}}]\n"
#define SQUARE \
    "dimension: 2\nthickness: 1\n" STEEL "body: [{add: {box: {low: [0, 0], high: [1, 1]}}}]\n" \
    "boundary: [{set: bottom, displacement: {x: 0, y: 0}}, {set: top, traction: {y: 1 MPa}}]\n"
#define GAUSS(HORIZON) "approximation: rkpm, integration: gauss, kernel: cubic_spline, horizon: " HORIZON
typedef struct { const char *name; size_t along; const char *text; } body;
static const body bodies[] = {
    { "cube", 24, CUBE "method: {" GAUSS ("2 spacing") "}\n" },
    { "cube_perturbed", 24, CUBE "method: {" GAUSS ("2 spacing") "}\nperturb: {amount: 0.2}\n" },
    { "cube_consistent", 24,
      CUBE "method: {approximation: rkpm, integration: consistent, kernel: cubic_spline, horizon: 2 "
           "spacing}\n" },
    { "cube_nodal", 24,
      CUBE "method: {approximation: nosb, integration: nodal, horizon: 2 spacing, stabilization: "
           "none}\n" },
    { "cube_silling", 24,
      CUBE "method: {approximation: nosb, integration: nodal, horizon: 2 spacing, stabilization: "
           "silling}\n" },
    { "square", 150, SQUARE "method: {" GAUSS ("2 spacing") "}\n" },
    { "square_perturbed", 150, SQUARE "method: {" GAUSS ("2 spacing") "}\nperturb: {amount: 0.2}\n" },
    { "square_consistent", 150,
      SQUARE "method: {approximation: rkpm, integration: consistent, kernel: cubic_spline, horizon: 2 "
             "spacing}\n" },
    { "square_silling", 150,
      SQUARE "method: {approximation: nosb, integration: nodal, horizon: 3 spacing, stabilization: "
             "silling}\n" },
};
enum { BODIES = sizeof bodies / sizeof *bodies };

/* Reads and writes per second of a copy, GB/s. */
static pg_status copy_rate (double *rate)
{
    pg_status status = PG_OK;
    double *a = NULL, *b = NULL;
    spread seconds = { 0 };
    PG_ALLOC (a, COPY);
    PG_ALLOC (b, COPY);
    for (double begin = spread_processor (); spread_processor () - begin < least_time; ) {
        double t = spread_processor ();
        b[seconds.n % COPY] = t;
        memcpy (a, b, COPY * sizeof *a);
        spread_add (&seconds, spread_processor () - t);
    }
    *rate = 2e-9 * COPY * sizeof *a / spread_quantile (&seconds, 0);
done:
    pg_free (a), pg_free (b);
    return status;
}

/* Bonds of the evaluation points: of cells with Gauss points those of the points, else those of nodes. */
static double bonds_of (const pg_problem *p)
{
    if (p->form.consistency) return (double) p->form.consistency->family.start[p->form.consistency->family.n];
    return (double) (p->form.integration->at_nodes ? p->bonds.first[PG_NODES + 1] - p->bonds.first[PG_NODES]
                                              : p->bonds.first[PG_POINTS + 1] - p->bonds.first[PG_POINTS]);
}

/* One scene: builds it, multiplies, prints its row. Takes over the scene. */
static pg_status measure (pg_scene *scene, const char *name, int threads, double copy)
{
    pg_status status = PG_OK;
    pg_problem *problem = NULL;  pg_state *state = NULL;
    const pg_force_type *force = NULL;
    void *self = NULL;
    double *x = NULL, *y = NULL;
    spread seconds = { 0 };
    PG_TRY (pg_problem_build (&problem, scene, threads));
    force = pg_force_of (problem);
    PG_TRY (force->create (&self, problem));
    PG_TRY (pg_state_create (&state, problem, problem->dim));
    PG_TRY (force->refresh (self, state, NULL));
    const pg_operator *K = force->operator_ (self);
    PG_ALLOC (x, K->n);
    PG_ALLOC (y, K->n);
    for (size_t i = 0; i < K->n; i++) x[i] = (double) (i * 7919 % 1000) * 1e-6;
    K->apply (K->context, x, y);
    for (double begin = spread_processor (); spread_processor () - begin < least_time; ) {
        double t = spread_processor ();
        K->apply (K->context, x, y);
        spread_add (&seconds, spread_processor () - t);
    }
    double bonds = bonds_of (problem);
    double bytes = bonds * (8.0 * problem->dim + 4 + (strstr (name, "silling") ? 8 : 0));
    printf ("%s,%zu,%.0f,%.0f,%d,", name, K->n, bonds, bytes, threads);
    spread_print (&seconds, 1e3);
    spread_print_rate (&seconds, 1e-9 * bytes);
    printf ("%.4g\n", 1e-9 * bytes / spread_quantile (&seconds, 0) / copy);
    fflush (stdout);
done:
    pg_free (x), pg_free (y);
    if (self) force->free (&self);
    pg_state_free (&state), pg_problem_free (&problem), pg_scene_free (&scene);
    return status;
}

int main (int argc, char **argv)
{
    pg_status status = PG_OK;
    const char *text = getenv ("PERIGAL_BENCH_THREADS");
    int threads = text ? atoi (text) : 1;
    double copy = 0;
    puts ("body,unknowns,bonds,bytes,threads,product_ms_min,product_ms_median,product_ms_max,"
          "GB_s_min,GB_s_median,GB_s_max,share_of_copy");
    PG_TRY (copy_rate (&copy));
    printf ("copy,%d,0,%.0f,1,,,,%.4g,%.4g,%.4g,1\n", COPY, 2.0 * COPY * sizeof (double), copy, copy, copy);
    for (int k = 1; k < argc; k++) {
        pg_scene *scene = NULL;
        if (!strstr (argv[k], ".yaml")) continue;
        PG_TRY (pg_scene_load (&scene, argv[k]));
        PG_TRY (measure (scene, argv[k], threads, copy));
    }
    for (int k = 0; k < BODIES; k++) {
        size_t along = argc > 2 ? strtoul (argv[2], NULL, 10) : bodies[k].along;
        char scene_text[2000];
        pg_scene *scene = NULL;
        if (argc > 1 && strcmp (argv[1], bodies[k].name) != 0) continue;
        snprintf (scene_text, sizeof scene_text, "%sspacing: %.17g\nsolver: {kind: static}\n", bodies[k].text,
                  1.0 / (double) along);
        PG_TRY (pg_scene_parse (&scene, scene_text, bodies[k].name));
        PG_TRY (measure (scene, bodies[k].name, threads, copy));
    }
done:
    if (status != PG_OK) fprintf (stderr, "operator_rate: %s\n", pg_last_error ());
    return status != PG_OK;
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * A rigid motion strains nothing and the tractions of a uniform stress balance it, wherever the lattice
 * lies: bodies cut out of lattices with random offsets, turns of straight edges against them, moves of the
 * points, kernels and horizons. "Strain" is the largest at any evaluation point or point of a facet, for a
 * translation by one spacing and a turn by one radian; "patch" the largest unbalanced nodal force of a
 * uniform stress on the whole surface, over the largest force of its tractions. Few lattices as a rule,
 * more with PERIGAL_TEST_SIZE=long; PERIGAL_SEED: others (the table of doc/accuracy.md, which names its
 * seed). */
#include "bond.h"
#include <stdlib.h>
#include "mechanics/galerkin/weak_form/galerkin.h"

static const char *const plane_bodies[] = {
    "{add: {disk: {center: [0, 0], radius: 0.5}}}",
    "{add: {disk: {center: [0, 0], radius: 0.5}}}, {subtract: {disk: {center: [0, 0], radius: 0.22}}}",
    ("{add: {polygon: {vertices: [(-0.5 -0.5), (0.5 -0.5), (0.5 0.5), (-0.5 0.5)]}}}, "
     "{subtract: {disk: {center: [0.03, 0.01], radius: 0.2}}}"),
    ("{add: {disk: {center: [0, 0], radius: 0.5}}}, {subtract: {polygon: {vertices: "
     "[(-0.06 -0.6), (0.05 -0.6), (0.05 -0.1), (-0.06 -0.1)]}}}"),
};
static const char *const solid_bodies[] = {
    "{add: {cylinder: {center: [0, 0, -0.25], axis: [0, 0, 1], length: 0.5, radius: 0.4}}}",
    "{add: {sphere: {center: [0, 0, 0], radius: 0.45}}}",
    ("{add: {prism: {vertices: [(-0.4 -0.4), (0.4 -0.4), (0.4 0.4), (-0.4 0.4)], low: -0.2, high: 0.2}}}, "
     "{subtract: {cylinder: {center: [0.02, 0.01, -0.3], axis: [0, 0, 1], length: 0.6, radius: 0.15}}}"),
};
static const char *const kernels[] = { "cubic_spline", "quartic_spline", "gaussian", "conical", "quadratic" };

typedef struct { double translation, rotation, patch, sum; } rigid;

/* The largest strain of the points of some rows under u = H x (m; x about the middle) or a translation. */
static double largest (const pg_rows *r, const pg_cloud *c, const double H[9], const double *shift)
{
    double worst = 0;
    size_t dim = (size_t) r->dim;
    for (size_t p = 0; p < r->n; p++) {
        double G[9] = { 0 };
        size_t offset = pg_rows_offset (r, p);
        for (size_t e = r->family.start[p]; e < r->family.start[p + 1]; e++) {
            const double *x = c->x + (size_t) r->family.node[e] * dim;
            for (size_t a = 0; a < dim; a++) {
                double u = shift ? shift[a] : 0;
                for (size_t b = 0; b < dim && !shift; b++) u += H[a * 3 + b] * x[b];
                for (size_t b = 0; b < dim; b++) G[a * 3 + b] += r->dN[(e + offset) * dim + b] * u;
            }
        }
        for (size_t a = 0; a < dim; a++)
            for (size_t b = 0; b < dim; b++) worst = fmax (worst, fabs (0.5 * (G[a*3 + b] + G[b*3 + a])));
    }
    return worst;
}

/* On the bare problem, whose facets are the whole surface. */
static rigid measure (const pg_problem *problem)
{
    rigid out = { 0 };
    pg_problem *bare;
    void *self;
    pg_state *state;
    check_ok (pg_problem_bare (&bare, problem));
    const pg_force_type *force = pg_force_of (bare);
    check_ok (pg_state_create (&state, bare, bare->dim));
    check_ok (force->create (&self, bare));
    check_ok (force->refresh (self, state, NULL));
    galerkin *g = self;
    double h = bare->cloud.h, H[9] = { 0, -1, 0.5, 1, 0, -0.3, -0.5, 0.3, 0 }, t[3] = { h, h, h };
    const pg_rows *rows[] = { &g->sums, &g->rows[PG_FACETS] };
    for (int k = 0; k < 2; k++) {
        out.translation = fmax (out.translation, largest (rows[k], &bare->cloud, H, t));
        out.rotation = fmax (out.rotation, largest (rows[k], &bare->cloud, H, NULL));
    }
    size_t dim = (size_t) bare->dim, ndof = bare->cloud.n * dim;
    double *P = pg_calloc (ndof, sizeof *P);
    for (int v = 0; v < pg_voigt_size (bare->dim); v++) {
        double stress[6] = { 0 }, top = 0, worst = 0;
        stress[v] = 1;
        memset (P, 0, ndof * sizeof *P);
        check_ok (force->surfaces.surface (self, stress, P));
        for (size_t i = 0; i < ndof; i++) top = fmax (top, fabs (P[i]));
        for (size_t p = 0; p < g->sums.n; p++)
            for (size_t e = g->sums.family.start[p]; e < g->sums.family.start[p + 1]; e++)
                for (size_t a = 0; a < dim; a++)
                    for (size_t b = 0; b < dim; b++)
                        P[(size_t) g->sums.family.node[e] * dim + a]
                            -= g->sums.weight[p] * stress[pg_voigt_at (bare->dim, (int) a, (int) b)]
                               * g->sums.dN[(e + pg_rows_offset (&g->sums, p)) * dim + b];
        for (size_t i = 0; i < ndof; i++) worst = fmax (worst, fabs (P[i]));
        out.patch = fmax (out.patch, worst / top);
    }
    pg_free (P);
    force->free (&self);
    pg_state_free (&state);
    pg_problem_bare_free (&bare);
    return out;
}

static double between (unsigned *seed, double low, double high)
{
    return low + (high - low) * 0.5 * (any (seed) + 1);
}

/* The body with its places in brackets turned by an angle. */
static void turned (const char *body, double angle, char *out, size_t size)
{
    size_t at = 0;
    double x, y;
    int length;
    for (; *body && at + 80 < size; body++) {
        if (sscanf (body, "(%lf %lf)%n", &x, &y, &length) != 2) {
            out[at++] = *body;
            continue;
        }
        at += (size_t) snprintf (out + at, size - at, "[%.15g, %.15g]", x * cos (angle) - y * sin (angle),
                                 x * sin (angle) + y * cos (angle));
        body += length - 1;
    }
    out[at] = 0;
}

/* One body on one random lattice. */
static rigid one (int dim, const char *body, const char *basis, const char *integration, unsigned *seed)
{
    char text[2000], third[40] = "", as_it_lies[900], moved[60] = "";
    int quadratic = basis[0] == 'q';
    double horizon = quadratic ? between (seed, 2.4, dim == 3 ? 2.8 : 3.5)
                               : between (seed, 1.5, dim == 3 ? 2.6 : 3.5);
    double offset[3] = { between (seed, 0, 1), between (seed, 0, 1), between (seed, 0, 1) };
    const char *kernel = kernels[(int) between (seed, 0, 4.999)],
               *lattice = between (seed, 0, 1) < 0.5 ? "cells" : "nodes";
    double angle = between (seed, 0, 1) < 0.5 ? between (seed, 0, 1.5) : 0;
    if (dim == 3) snprintf (third, sizeof third, ", %g", offset[2]);
    if (between (seed, 0, 1) < 0.3)
        snprintf (moved, sizeof moved, "perturb: {amount: 0.2, seed: %d}\n", (int) between (seed, 1, 999));
    turned (body, angle, as_it_lies, sizeof as_it_lies);
    snprintf (text, sizeof text,
              "dimension: %d\nbody: [%s]\nspacing: %g\nlattice: %s\nlattice_offset: [%g, %g%s]\n%s"
              "materials: {m: {youngs_modulus: 1, poissons_ratio: 0.3}}\n"
              "method: {integration: %s, basis: %s, kernel: %s, horizon: %g spacing}\n"
              "boundary: [{set: all, pressure: 0}]\nsolver: {kind: static}\n",
              dim, as_it_lies, dim == 3 ? 0.15 : 0.1, lattice, offset[0], offset[1], third, moved,
              integration, basis, kernel, horizon);
    bonded b = bonded_of (text);
    rigid r = measure (b.problem);
    if (getenv ("SHOW"))
        print_message ("  %s offset %.3f %.3f %.3f, turned %.3f, %s%s, horizon %.3g: %.1e %.1e %.1e\n",
                       lattice, offset[0], offset[1], offset[2], angle, moved, kernel, horizon, r.translation,
                       r.rotation, r.patch);
    unbonded (&b);
    return r;
}

static int compare (const void *a, const void *b)
{
    double x = *(const double *) a, y = *(const double *) b;
    return (x > y) - (x < y);
}

static void row (const char *name, int n, double *value)
{
    qsort (value, (size_t) n, sizeof *value, compare);
    print_message ("%s: median %.1e, worst %.1e\n", name, value[n / 2], value[n - 1]);
}

static unsigned first_seed (void)
{
    const char *seed = getenv ("PERIGAL_SEED");
    return seed ? (unsigned) atoi (seed) : 0;
}

static void family (int dim, size_t nbody, const char *const *body, const char *basis, int n, double limit)
{
    enum { MOST = 64 };
    double t[MOST], r[MOST], p[MOST];
    for (size_t k = 0; k < nbody; k++) {
        unsigned seed = 7 + (unsigned) k * 13 + (unsigned) dim + first_seed ();
        for (int i = 0; i < n; i++) {
            rigid m = one (dim, body[k], basis, getenv ("GAUSS") ? "gauss" : "consistent", &seed);
            t[i] = m.translation, r[i] = m.rotation, p[i] = m.patch;
        }
        print_message ("%dD body %zu, %s, %d lattices\n", dim, k, basis, n);
        row ("  translation", n, t), row ("  rotation", n, r), row ("  patch", n, p);
        if (!getenv ("GAUSS")) {
            check_below (t[n - 1], limit);
            check_below (r[n - 1], 10 * limit);
            check_below (p[n - 1], limit);
        }
    }
}

static int lattices (int few, int many)
{
    return longer () ? many : few;
}

static void plane_linear (void **unused)
{
    (void) unused;
    family (2, 4, plane_bodies, "linear", lattices (3, 20), 1e-11);
}

static void plane_quadratic (void **unused)
{
    (void) unused;
    family (2, 4, plane_bodies, "quadratic", lattices (2, 20), 1e-11);
}

static void solid_linear (void **unused)
{
    (void) unused;
    family (3, 3, solid_bodies, "linear", lattices (1, 20), 1e-11);
}

static void solid_quadratic (void **unused)
{
    (void) unused;
    family (3, 3, solid_bodies, "quadratic", lattices (1, 5), 1e-11);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (plane_linear),
        cmocka_unit_test (plane_quadratic),
        cmocka_unit_test (solid_linear),
        cmocka_unit_test (solid_quadratic),
    };
    return cmocka_run_group_tests (tests, NULL, NULL);
}

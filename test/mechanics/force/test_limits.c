/* SPDX-License-Identifier: GPL-3.0-or-later
 * What a bond is judged by: the mean of the stresses at its two ends (Cui 2022 section 1.1), found anew from
 * the force's own shape functions, in every set of bonds; and limits that go with the spacing: a body twice
 * as large, strained alike, is nearer to every limit of energy by the root of two. */
#define _DEFAULT_SOURCE                                 /* mkstemps */
#include <stdlib.h>
#include <unistd.h>
#include "bond.h"

/* ---- stresses of both ends ----------------------------------------------------------------------------- */
static const double tension = 1e6, cohesion = 3e6, friction = 35 * 3.14159265358979323846 / 180;

/* s1 and s3 of points by sampling: not the stresses that the force keeps */
static double *principals (const bonded *b, const double *d, size_t n, const double *x)
{
    double *u = pg_calloc (3 * n, sizeof *u), *s = pg_calloc (6 * n, sizeof *s),
           *out = pg_calloc (2 * n, sizeof *out);
    check_ok (b->force->sample (b->self, b->state, d, n, x, u, s, NULL));
    for (size_t i = 0; i < n; i++) {
        const double *v = s + 6 * i, A[9] = { v[0], v[3], v[5], v[3], v[1], v[4], v[5], v[4], v[2] };
        double lambda[3];
        pg_dense_eigen (3, A, lambda, NULL);
        out[2 * i] = lambda[0], out[2 * i + 1] = lambda[2];
    }
    pg_free (u), pg_free (s);
    return out;
}

static double use_of (int mohr_coulomb, double s1, double s3)
{
    double t = fmax (s1, 0) / tension,
           shear = ((s1 - s3) / 2 + (s1 + s3) / 2 * sin (friction)) / (cohesion * cos (friction));
    return mohr_coulomb ? fmax (t, shear) : t;
}

typedef struct { const char *body, *method; } scene;

static void check_means (const scene *a, int mohr_coulomb)
{
    char text[1200];
    snprintf (text, sizeof text,
              "%smaterials: {rock: {youngs_modulus: 10 GPa, poissons_ratio: 0.25}}\nmethod: {%s}\nboundary: "
              "[{set: left, displacement: {x: 0, y: 0}}]\n"
              "failure: {criterion: %s}\n",
              a->body, a->method,
              mohr_coulomb ? "mohr_coulomb, tensile_strength: 1 MPa, cohesion: 3 MPa, friction_angle: 35 deg"
                           : "principal_stress, tensile_strength: 1 MPa");
    bonded b = bonded_of (text);
    const pg_problem *p = b.problem;
    double *d = pg_calloc (b.ndof, sizeof *d), *u = pg_calloc (b.state->nbond, sizeof *u),
           *f = pg_calloc (b.state->nbond, sizeof *f), size = p->cloud.high[0];
    for (size_t i = 0; i < b.n; i++)                   /* strains that vary: ends differ */
        for (size_t k = 0; k < b.dim; k++) {
            const double *x = p->cloud.x + i * b.dim;
            d[i * b.dim + k] = 3e-4 * size
                               * (sin (2 * x[0] / size + (double) k)
                                  + 0.7 * cos (3 * x[1] / size - (double) k)
                                  + (b.dim == 3 ? 0.5 * sin (2.5 * x[2] / size) : 0));
        }
    check_ok (b.force->judge (b.self, b.state, d, &(pg_judging){ .utilisation = u, .factor = f }));
    double *node = principals (&b, d, b.n, p->cloud.x);
    size_t sets = 0, apart = 0;
    for (int set = 0; set < PG_BOND_SETS; set++) {
        const pg_rows *r = &p->bonds.rows[set];
        /* consistent strains of cells: not those of any place */
        if (r->n == 0 || (p->form.consistency && set != PG_NODES)) continue;
        double *point = principals (&b, d, r->n, r->x);
        sets++;
        for (size_t i = 0; i < r->n; i++)
            for (size_t e = r->family.start[i]; e < r->family.start[i + 1]; e++) {
                size_t j = (size_t) r->family.node[e];
                if ((int) j == r->own[i]) continue;
                double want = use_of (mohr_coulomb, (point[2 * i] + node[2 * j]) / 2,
                                      (point[2 * i + 1] + node[2 * j + 1]) / 2),
                       found = u[p->bonds.first[set] + e];
                check_scaled (found, want, 1e-9, 1);
                if (found > 1e-6) check_relative (f[p->bonds.first[set] + e] * found, 1, 1e-12);
                apart += fabs (use_of (mohr_coulomb, point[2 * i], point[2 * i + 1]) - want) > 0.02 * want
                         && fabs (use_of (mohr_coulomb, node[2 * j], node[2 * j + 1]) - want) > 0.02 * want;
            }
        pg_free (point);
    }
    assert_true (sets > 0 && apart > b.n);  /* and either end alone would have told another story */
    pg_free (d), pg_free (u), pg_free (f), pg_free (node);
    unbonded (&b);
}

/* Nor is anything left of what was there before. */
static void dead_bonds_have_no_utilisation (void **unused)
{
    (void) unused;
    static const struct { const char *nu, *method, *criterion;
    } laws[] = {
        { "0.2", "integration: gauss", "principal_stress, tensile_strength: 1 Pa" },
        { "0.2", "integration: nodal",
          "mohr_coulomb, tensile_strength: 1 Pa, cohesion: 2 Pa, friction_angle: 35 deg" },
        { "0.3333333333", "force: bond", "stretch, critical_stretch: 1e-3" },
        { "0.3333333333", "force: fcbm", "node_energy, fracture_energy: 1 J/m2" },
        { "0.2", "force: lps", "stretch, critical_stretch: 1e-3" },
        { "0.2", "force: gmpd", "beam_limits, fracture_energy: 1 J/m2" },
    };
    for (size_t l = 0; l < sizeof laws / sizeof *laws; l++) {
        char text[1200];
        snprintf (
            text, sizeof text,
            "dimension: 2\nplane: stress\nbody: [{add: {box: {low: [0, 0], high: [1, 0.7]}}}]\nspacing: "
            "0.1\nthickness: 0.2\nmaterials: {rock: {youngs_modulus: 10, poissons_ratio: %s}}\n"
            "method: {%s}\nfailure: {criterion: %s}\n",
            laws[l].nu, laws[l].method, laws[l].criterion);
        bonded b = bonded_of (text);
        size_t n = b.state->nbond, live = 0;
        double *d = random_vector (b.ndof, 5), *u = pg_calloc (n, sizeof *u), *f = pg_calloc (n, sizeof *f);
        char *kind = pg_calloc (n, 1);
        for (size_t i = 0; i < n; i++) b.state->alive[i] = i % 3 > 0, u[i] = f[i] = 7;
        for (size_t i = 0; b.problem->sums && i < b.n; i++)                 /* both directions of a bond */
            for (size_t e = b.problem->bonds.rows[PG_NODES].family.start[i];
                 e < b.problem->bonds.rows[PG_NODES].family.start[i + 1]; e++)
                b.state->alive[e] = (i + (size_t) b.problem->bonds.rows[PG_NODES].family.node[e]) % 3 > 0;
        check_ok (b.force->refresh (b.self, b.state, NULL));
        check_ok (b.force->judge (b.self, b.state, d,
                                  &(pg_judging){ .utilisation = u, .kind = kind, .factor = f }));
        for (size_t i = 0; i < n; i++) {
            if (!b.state->alive[i]) assert_true (u[i] == 0 && f[i] == INFINITY);
            live += b.state->alive[i] && u[i] > 0;
        }
        assert_true (live > n / 4);
        pg_free (d), pg_free (u), pg_free (f), pg_free (kind);
        unbonded (&b);
    }
}

static void bonds_are_judged_by_the_mean_of_both_ends (void **unused)
{
    (void) unused;
    static const char
        plane_stress[] = "dimension: 2\nplane: stress\nbody: [{add: {box: {low: [0, 0], high: [10 mm, 7 "
                         "mm]}}}]\nspacing: 1 mm\nthickness: 2 mm\n",
        plane_strain[] = "dimension: 2\nplane: strain\nbody: [{add: {box: {low: [0, 0], high: [10 mm, 7 "
                         "mm]}}}]\nspacing: 1 mm\nperturb: {amount: 0.15}\n",
        solid[] =
            "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [5 mm, 4 mm, 4 mm]}}}]\nspacing: 1 mm\n";
    static const scene scenes[] = {
        { plane_stress, "approximation: rkpm, integration: gauss" },
        { plane_strain, "approximation: rkpm, integration: nodal, essential: penalty" },
        { plane_strain, "approximation: pddo, integration: gauss, essential: nitsche" },
        { plane_stress, "approximation: nosb, integration: nodal" },
        { plane_stress, "approximation: rkpm, integration: consistent" },
        { plane_strain, "approximation: rkpm, basis: quadratic, horizon: 3.01 spacing, integration: gauss" },
        { solid, "approximation: rkpm, integration: gauss" },
        { solid, "approximation: pddo, integration: nodal" }
    };
    for (size_t k = 0; k < sizeof scenes / sizeof *scenes; k++)
        for (int law = 0; law < 2; law++) check_means (&scenes[k], law);
}

/* ---- spacings that differ ------------------------------------------------------------------------------ */
/* A lattice of side^dim points and, far away, its copy of twice the size; returns the points of each. */
static size_t write_twins (char *path, int dim, size_t side)
{
    size_t n = 1;
    FILE *out = fdopen (mkstemps (path, 4), "w");
    assert_non_null (out);
    fprintf (out, dim == 2 ? "x,y,volume,spacing\n" : "x,y,z,volume,spacing\n");
    for (int k = 0; k < dim; k++) n *= side;
    for (int twin = 1; twin <= 2; twin++)
        for (size_t i = 0; i < n; i++) {
            double size = 0.1 * twin;
            for (size_t k = 0, rest = i; k < (size_t) dim; k++, rest /= side)
                fprintf (out, "%.17g,",
                         size * ((double) (rest % side) + 0.11 * sin (7.0 * (double) (i + k * k)))
                             + 10 * (twin - 1));
            fprintf (out, "%.17g,%.17g\n", dim == 2 ? size * size * 0.2 : size * size * size, size);
        }
    fclose (out);
    return n;
}

/* Strains of both twins are the same, and so are utilisations but for the horizon, whose root energies per
 * area bring in. */
static void check_twins (int dim, const char *method, const char *failure)
{
    char path[] = "/tmp/perigal_twins_XXXXXX.csv", text[1000];
    size_t n = write_twins (path, dim, dim == 2 ? 8 : 5);
    snprintf (text, sizeof text,
              "dimension: %d\n%spoints: %s\nmaterials: {rock: {youngs_modulus: 10, poissons_ratio: 0.2, "
              "density: 3}}\nmethod: {%s, horizon: 2.5 spacing}\n"
              "failure: {%s}\n",
              dim, dim == 2 ? "plane: stress\nthickness: 0.2\n" : "", path, method, failure);
    bonded b = bonded_of (text);
    unlink (path);
    assert_non_null (b.problem->cloud.size);
    assert_int_equal (b.n, 2 * n);
    const pg_family *family = &b.problem->bonds.rows[PG_NODES].family;
    double *d = random_vector (b.ndof, 17), *u = pg_calloc (b.state->nbond, sizeof *u),
           *f = pg_calloc (b.state->nbond, sizeof *f), top = 0;
    for (size_t i = 0; i < n; i++)                     /* twice the displacement, the same rotation */
        for (size_t k = 0; k < b.stride; k++)
            d[(n + i) * b.stride + k] = (k < b.dim ? 2 : 1) * d[i * b.stride + k];
    check_ok (b.force->judge (b.self, b.state, d, &(pg_judging){ .utilisation = u, .factor = f }));
    size_t half = family->start[n], broken = 0;
    assert_int_equal (family->start[2 * n], 2 * half);
    for (size_t e = 0; e < half; e++) {
        assert_int_equal ((size_t) family->node[half + e], (size_t) family->node[e] + n);
        check_relative (u[half + e], sqrt (2) * u[e], 1e-9);
        if (u[e] > 0) check_relative (f[half + e], f[e] / sqrt (2), 1e-9), top = fmax (top, u[half + e]);
    }
    assert_true (top > 0);
    /* explicit methods: what breaks of itself is what is over its limit */
    double *r = pg_calloc (b.ndof, sizeof *r);
    pg_changes dead = { 0 };
    for (size_t i = 0; i < b.ndof; i++) d[i] *= 1.1 / top;
    check_ok (b.force->motion.balance_and_break (b.self, 0, d, r, NULL, &dead));
    for (size_t e = 0; e < 2 * half; e++) {
        int now = broken < dead.n && dead.bond[broken] == e;
        if (fabs (1.1 * u[e] / top - 1) > 1e-9) assert_int_equal (now, 1.1 * u[e] / top >= 1);
        broken += (size_t) now;
    }
    assert_true (dead.n > 0 && broken == dead.n);
    pg_free (d), pg_free (u), pg_free (f), pg_free (r), pg_free (dead.bond);
    unbonded (&b);
}

static void limits_of_energy_go_with_the_horizon_of_the_point (void **unused)
{
    (void) unused;
    for (int dim = 2; dim <= 3; dim++) {
        check_twins (dim, "force: gmpd", "criterion: beam_limits, fracture_energy: 1");
        check_twins (dim, "force: gmpd, beam: timoshenko",
                     "criterion: beam_limits, modes: single, fracture_energy: 1");
        check_twins (dim, "force: bond", "criterion: node_energy, fracture_energy: 1");
        check_twins (dim, "force: bond", "criterion: stretch, fracture_energy: 1");
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (dead_bonds_have_no_utilisation),
                                        cmocka_unit_test (bonds_are_judged_by_the_mean_of_both_ends),
                                        cmocka_unit_test (
                                            limits_of_energy_go_with_the_horizon_of_the_point) };
    return cmocka_run_group_tests_name ("mechanics/force/limits", tests, NULL, NULL);
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * Rule and cloud together: sites, families against brute force, weights of bonds, calibration and surface,
 * what is refused. */
#include "check.h"
#include "perigal/criterion.h"
#include "perigal/sums.h"
#include <stdlib.h>

static double next (uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return (*seed >> 8) / 16777216.0;
}

/* ---- clouds made by hand ------------------------------------------------------------------------------- */
enum { MOST = 4096 };
typedef struct { pg_cloud cloud; pg_lattice lattice; double x[3 * MOST], volume[MOST], size[MOST]; } body;

/* Cells of a lattice that keep (i, j, k) lets stay */
static body *lattice_body (int dim, int nx, int ny, int nz, const double *step, int (*keep) (int, int, int))
{
    body *b = calloc (1, sizeof *b);
    double cell = dim == 3 ? 1 : 0.01;
    int count[3] = {nx, ny, nz};
    b->cloud = (pg_cloud) {.dim = dim, .x = b->x, .volume = b->volume, .thickness = cell};
    b->lattice.dim = dim;
    for (int k = 0; k < dim; k++)
        b->cloud.step[k] = b->lattice.step[k] = step[k], b->lattice.count[k] = count[k], cell *= step[k];
    b->cloud.h = pow (cell / b->cloud.thickness, 1.0 / dim);
    for (int k = 0; k < nz; k++) for (int j = 0; j < ny; j++) for (int i = 0; i < nx; i++) {
        int at[3] = {i, j, k};
        if (keep && !keep (i, j, k)) continue;
        assert_true (b->cloud.n < MOST);
        for (int d = 0; d < dim; d++)
            b->x[b->cloud.n * (size_t) dim + (size_t) d] = 17.25 * step[d] + (at[d] + 0.5) * step[d];
        b->volume[b->cloud.n++] = cell;
    }
    return b;
}

static int ring (int i, int j, int k)
{
    (void) k;
    int r2 = (2 * i - 19) * (2 * i - 19) + (2 * j - 19) * (2 * j - 19);
    return r2 <= 400 && r2 >= 60;
}
static int holes (int i, int j, int k) { return (i * 7 + j * 13 + k * 5) % 11 != 3; }

static body *random_body (int dim, size_t n, double h, int sizes)
{
    body *b = calloc (1, sizeof *b);
    uint32_t seed = 5;
    b->cloud = (pg_cloud){
        .dim = dim, .n = n, .x = b->x, .volume = b->volume, .h = h, .thickness = dim == 3 ? 1 : 0.01
    };
    for (size_t i = 0; i < n * (size_t) dim; i++) b->x[i] = next (&seed);
    for (size_t i = 0; i < n; i++)
        b->volume[i] = b->cloud.thickness * (0.5 + next (&seed)) / (double) n,
        b->size[i] = h * (0.5 + next (&seed));
    if (sizes) b->cloud.size = b->size;
    return b;
}

static pg_sum_rule rule_of (int dim, const char *kernel, double horizon, pg_partial partial,
                            pg_surface surface)
{
    return (pg_sum_rule){ .mode = dim == 1   ? PG_LINE
                                  : dim == 2 ? PG_PLANE_STRESS
                                             : PG_SOLID,
                          .kernel = pg_kernel_find (kernel),
                          .horizon = horizon,
                          .partial = partial,
                          .surface = surface,
                          .calibrate = 1 };
}

/* Of which no cloud here is made: for points that shall not be found on one */
static pg_lattice no_lattice (int dim)
{
    return (pg_lattice){ .dim = dim, .count = { 9, 9, 9 }, .step = { 0.377, 0.377, 0.377 } };
}

/* ---- sites --------------------------------------------------------------------------------------------- */
static void points_find_their_sites (void **state)
{
    (void) state;
    static const int size[][4] = { { 1, 9, 1, 1 },  { 2, 20, 20, 1 }, { 2, 30, 2, 1 }, { 2, 1, 12, 1 },
                                   { 3, 10, 7, 5 }, { 3, 9, 8, 1 },   { 3, 12, 3, 2 } };
    const double step[3] = {0.1 / 3, 0.02, 0.05};
    for (size_t k = 0; k < sizeof size / sizeof *size; k++) {
        int dim = size[k][0], nx = size[k][1], ny = size[k][2];
        body *b = lattice_body (dim, nx, ny, size[k][3], step,
                                k == 1               ? ring
                                : dim == 3 && ny > 3 ? holes
                                                     : NULL);
        pg_sites s;
        check_ok (pg_sites_build (&s, &b->cloud, &b->lattice));
        assert_int_equal (s.count[0], nx);
        assert_int_equal (s.count[1], ny);
        assert_int_equal (s.count[2], size[k][3]);
        size_t found = 0;
        for (int i = 0; i < s.count[0] * s.count[1] * s.count[2]; i++) {
            if (s.point[i] < 0) continue;
            found++;
            assert_int_equal (s.site[s.point[i]], i);
            int at[3] = {i % nx, i / nx % ny, i / nx / ny};
            for (int d = 0; d < dim; d++)
                check_absolute (b->x[s.point[i] * dim + d], (17.75 + at[d]) * step[d], 1e-12);
        }
        assert_int_equal (found, b->cloud.n);
        pg_sites_clear (&s);
        free (b);
    }
}

static void points_off_a_lattice_are_none (void **state)
{
    (void) state;
    const double step[3] = {1, 1, 1};
    for (int k = 0; k < 4; k++) {
        body *b = lattice_body (2, 8, 6, 1, step, NULL);
        pg_sites s;
        if (k == 0) b->x[21] += 1e-5;                              /* moved */
        if (k == 1) memcpy (b->x + 20, b->x + 22, 2 * sizeof (double));    /* two at one place */
        if (k == 2) {                                              /* spacings of their own */
            for (size_t i = 0; i < b->cloud.n; i++) b->size[i] = 1 + 0.1 * (i == 9);
            b->cloud.size = b->size;
        }
        if (k == 3) b->lattice.step[1] = 1.001;
        check_ok (pg_sites_build (&s, &b->cloud, &b->lattice));
        assert_int_equal (s.count[0], 0);
        assert_null (s.site);
        free (b);
    }
    body *b = lattice_body (2, 8, 6, 1, step, NULL);  /* moved by less than counts; equal spacings */
    pg_sites s;
    b->x[21] += 1e-8;
    for (size_t i = 0; i < b->cloud.n; i++) b->size[i] = 1;
    b->cloud.size = b->size;
    check_ok (pg_sites_build (&s, &b->cloud, &b->lattice));
    assert_int_equal (s.count[0], 8);
    pg_sites_clear (&s);
    free (b);
}

/* No lattice given: the same sites from the points alone; no lattice, no sites */
static void lattices_are_found (void **state)
{
    (void) state;
    static const int size[][4] = {{1, 9, 1, 1}, {2, 20, 20, 1}, {2, 30, 2, 1}, {3, 10, 7, 5}, {3, 12, 3, 2}};
    const double step[3] = {0.1 / 3, 0.02, 0.05};
    for (int k = 0; k < 5; k++) {
        body *b = lattice_body (size[k][0], size[k][1], size[k][2], size[k][3], step,
                                k == 1   ? ring
                                : k == 3 ? holes
                                         : NULL);
        pg_sites s, t;
        /* as if read from a file */
        for (size_t i = 0; i < b->cloud.n * (size_t) b->cloud.dim; i++)
            b->x[i] *= 1 + 3e-10 * (double) (i % 3);
        check_ok (pg_sites_build (&s, &b->cloud, &b->lattice));
        check_ok (pg_sites_build (&t, &b->cloud, NULL));
        assert_memory_equal (s.count, t.count, sizeof s.count);
        assert_memory_equal (s.site, t.site, b->cloud.n * sizeof *s.site);
        for (int d = 0; d < b->cloud.dim; d++) check_relative (t.step[d], step[d], 1e-6);
        pg_sites_clear (&s), pg_sites_clear (&t);
        b->x[4] += 1e-3 * b->cloud.h;
        check_ok (pg_sites_build (&t, &b->cloud, NULL));
        assert_int_equal (t.count[0], 0);
        free (b);
    }
    for (int dim = 1; dim <= 3; dim++) {  /* scattered; in one row; few and far between */
        body *b = random_body (dim, 100, 0.1, 0);
        pg_sites s;
        check_ok (pg_sites_build (&s, &b->cloud, NULL));
        assert_int_equal (s.count[0], 0);
        for (size_t i = 0; i < b->cloud.n * (size_t) dim; i++)
            b->x[i] = dim == 1 ? 1000.0 * (double) i * (double) i : i % (size_t) dim ? 5 : (double) i;
        check_ok (pg_sites_build (&s, &b->cloud, NULL));
        assert_int_equal (s.count[0], 0);
        free (b);
    }
}

/* ---- families and weights ------------------------------------------------------------------------------ */
static double ratio (const pg_cloud *c, size_t i, size_t j)
{
    return c->size ? (c->size[i] + c->size[j]) / (2 * c->h) : 1;
}

/* The bond between i and j, from the definition */
static double share_of (const pg_sum_rule *rule, const pg_cloud *c, size_t i, size_t j, double *r,
                        double *weight)
{
    double sum = 0, q, horizon = rule->horizon * ratio (c, i, j), h = c->h * ratio (c, i, j), beta, w;
    for (int k = 0; k < c->dim; k++)
        sum += pow (c->x[j * (size_t) c->dim + (size_t) k] - c->x[i * (size_t) c->dim + (size_t) k], 2);
    *r = sqrt (sum), q = *r / horizon;
    beta = rule->partial == PG_PARTIAL_NONE ? q <= 1 + 1e-9 : fmin (1, fmax (0, (horizon + h / 2 - *r) / h));
    rule->kernel->value (1, &q, &w, NULL);
    *weight = w * beta * pow (1 / ratio (c, i, j), c->dim + 1);
    return w > 0 ? beta : 0;
}

static void check_family (const pg_sums *s, const pg_sum_rule *rule, int exact)
{
    const pg_cloud *c = s->cloud;
    pg_family f;
    size_t dim = (size_t) c->dim;
    double *xi = malloc (c->n * dim * sizeof *xi), *weight = malloc (c->n * sizeof *weight),
           *beta = malloc (c->n * sizeof *beta);
    double *back = malloc (c->n * sizeof *back), *all = calloc (c->n * c->n, sizeof *all);
    check_ok (pg_sums_family (&f, s, NULL));
    assert_int_equal (f.n, c->n);
    for (size_t i = 0; i < c->n; i++) {
        size_t e = f.start[i], n = f.start[i + 1] - e;
        pg_sums_bonds (s, &f, i, xi, weight, beta);
        for (size_t j = 0; j < c->n; j++) {
            double r = 0, w = 0, b = i == j ? 0 : share_of (rule, c, i, j, &r, &w);
            int here = e < f.start[i + 1] && f.node[e] == (int) j;
            if (exact) {
                if (b > 1e-8) assert_true (here);
                if (b <= 0) assert_false (here);
            }
            if (!here) continue;
            size_t at = e++ - f.start[i];
            double length = 0;
            for (size_t k = 0; k < dim; k++) {
                check_scaled (xi[at*dim + k], c->x[j*dim + k] - c->x[i*dim + k], 1e-12, rule->horizon);
                length += xi[at*dim + k] * xi[at*dim + k];
            }
            if (exact) {
                check_absolute (beta[at], b, 1e-9);
                check_scaled (weight[at], w, 1e-9, 1);
                check_relative (sqrt (length), r, 1e-12);
            }
            assert_true (weight[at] > 0 && beta[at] > 0);
            all[i * c->n + j] = weight[at];
        }
        assert_int_equal (e, f.start[i + 1]);                      /* ascending, none left over */
        if (n == 0) continue;
        pg_sums_bonds (s, &f, i, NULL, back, NULL);                /* only what is wanted */
        assert_memory_equal (back, weight, n * sizeof *back);
    }
    for (size_t i = 0; i < c->n; i++)
        for (size_t j = 0; j < i; j++)
            assert_memory_equal (&all[i * c->n + j], &all[j * c->n + i], sizeof *all);
    pg_family_clear (&f);
    free (xi), free (weight), free (beta), free (back), free (all);
}

static void families_of_lattices_match_brute_force (void **state)
{
    (void) state;
    static const int size[][4] = { { 1, 15, 1, 1 }, { 2, 20, 20, 1 }, { 2, 14, 2, 1 }, { 2, 1, 12, 1 },
                                   { 3, 8, 7, 6 },  { 3, 9, 8, 1 },   { 3, 12, 3, 2 } };
    const double step[3] = {0.1 / 3, 0.1 / 3, 0.1 / 3};
    for (size_t k = 0; k < sizeof size / sizeof *size; k++)
        for (int p = 0; p < 3; p++)
            for (int v = 0; v < 3; v++) {
                static const char *const kernel[] = {"constant", "quadratic", "inverse_r"};
                int dim = size[k][0];
                pg_sum_rule rule = rule_of (dim, kernel[v], 3.015 * step[0], (pg_partial) p, PG_SURFACE_NONE);
                body *b = lattice_body (dim, size[k][1], size[k][2], size[k][3], step,
                                        k == 1   ? ring
                                        : k == 4 ? holes
                                                 : NULL);
                pg_sums *s;
                check_ok (pg_sums_create (&s, &rule, &b->cloud, &b->lattice));
                assert_true (s->stencil.n > 0 && s->ordered);
                assert_null (s->share);
                check_family (s, &rule, p < 2);
                pg_sums_free (&s);
                assert_null (s);
                free (b);
            }
}

/* Any number of threads: the same families, of points numbered as their sites and otherwise */
static void threads_find_the_same_families (void **state)
{
    (void) state;
    const double step[3] = {1, 1, 1};
    for (int k = 0; k < 2; k++) {
        body *b = lattice_body (2, 20, 20, 1, step, k ? ring : NULL);
        pg_family f[4];
        for (int t = 0; t < 4; t++) {
            pg_sum_rule rule = rule_of (2, "constant", 3.015, PG_PARTIAL_OVERLAP, PG_SURFACE_NONE);
            pg_sums *s;
            rule.threads = (int[]) {0, 2, 3, 7}[t];
            for (size_t i = 0; t == 0 && k && i < b->cloud.n / 2; i++)
                for (int d = 0; d < 2; d++) {
                    double *p = &b->x[2 * i + (size_t) d], *q = &b->x[2 * (b->cloud.n - 1 - i) + (size_t) d],
                           x = *p;
                    *p = *q, *q = x;
                }
            check_ok (pg_sums_create (&s, &rule, &b->cloud, &b->lattice));
            assert_int_equal (s->ordered, !k);
            check_ok (pg_sums_family (&f[t], s, NULL));
            if (t) assert_memory_equal (f[t].start, f[0].start, (b->cloud.n + 1) * sizeof *f->start);
            if (t) assert_memory_equal (f[t].node, f[0].node, f[0].start[b->cloud.n] * sizeof *f->node);
            pg_sums_free (&s);
        }
        for (int t = 0; t < 4; t++) pg_family_clear (&f[t]);
        free (b);
    }
}

/* Points numbered otherwise than their sites: the same bonds */
static void the_numbering_of_points_changes_nothing (void **state)
{
    (void) state;
    const double step[3] = {1, 0.8, 1};
    body *a = lattice_body (2, 20, 20, 1, step, ring), *b = lattice_body (2, 20, 20, 1, step, ring);
    pg_sum_rule rule = rule_of (2, "conical", 3.1, PG_PARTIAL_OVERLAP, PG_SURFACE_PRODUCT);
    pg_sums *s, *t;
    pg_family f, g;
    size_t n = a->cloud.n;
    for (size_t i = 0; i < n; i++) memcpy (b->x + 2 * (i * 5 % n), a->x + 2*i, 2 * sizeof (double));
    assert_true (n % 5 != 0);
    check_ok (pg_sums_create (&s, &rule, &a->cloud, &a->lattice));
    check_ok (pg_sums_create (&t, &rule, &b->cloud, &b->lattice));
    assert_true (s->ordered && !t->ordered);
    check_family (t, &rule, 0);
    check_ok (pg_sums_family (&f, s, NULL));
    check_ok (pg_sums_family (&g, t, NULL));
    for (size_t i = 0; i < n; i++) {
        double w[100], v[100];
        size_t k = i * 5 % n, m = f.start[i + 1] - f.start[i];
        assert_int_equal (m, g.start[k + 1] - g.start[k]);
        assert_memory_equal (&s->family_volume[i], &t->family_volume[k], sizeof (double));
        pg_sums_bonds (s, &f, i, NULL, w, NULL);
        pg_sums_bonds (t, &g, k, NULL, v, NULL);
        for (size_t e = 0; e < m; e++) {
            int j = (int) ((size_t) f.node[f.start[i] + e] * 5 % n);
            size_t at = 0;
            while (g.node[g.start[k] + at] != j) assert_true (++at < m);
            assert_memory_equal (&w[e], &v[at], sizeof (double));
        }
    }
    pg_family_clear (&f), pg_family_clear (&g);
    pg_sums_free (&s), pg_sums_free (&t);
    free (a), free (b);
}

static void families_of_irregular_clouds_match_brute_force (void **state)
{
    (void) state;
    for (int dim = 1; dim <= 3; dim++)
        for (int k = 0; k < 8; k++) {
            double h = dim == 1 ? 0.01 : dim == 2 ? 0.06 : 0.15;
            body *b = random_body (dim, dim == 1 ? 100 : 300, h, k % 2);
            pg_sum_rule rule = rule_of (dim, k & 2 ? "cubic_spline" : "linear_r", 2.7 * h,
                                        k & 4 ? PG_PARTIAL_LINEAR : PG_PARTIAL_NONE, PG_SURFACE_NONE);
            pg_sums *s;
            check_ok (pg_sums_create (&s, &rule, &b->cloud, NULL));
            assert_int_equal (s->stencil.n, 0);
            check_family (s, &rule, 1);
            pg_sums_free (&s);
            free (b);
        }
}

/* A lattice and the same points handed over as a cloud: the same bonds to rounding, the same constants where
 * families are whole */
static void a_lattice_is_a_cloud (void **state)
{
    (void) state;
    for (int dim = 1; dim <= 3; dim++)
        for (int p = 0; p < 2; p++)
            for (int f = 0; f < 3; f++) {
                const double step[3] = {0.25, 0.25, 0.25};
                int n = dim == 1 ? 40 : dim == 2 ? 30 : 13;
                pg_sum_rule rule = rule_of (dim, "quadratic", 3.1 * step[0], (pg_partial) p, (pg_surface) f);
                body *b = lattice_body (dim, n, dim > 1 ? n : 1, dim > 2 ? n : 1, step, NULL);
                pg_sums *s, *t;
                check_ok (pg_sums_create (&s, &rule, &b->cloud, &b->lattice));
                pg_lattice none = no_lattice (dim);
                check_ok (pg_sums_create (&t, &rule, &b->cloud, &none));
                assert_true (s->stencil.n > 0 && t->stencil.n == 0);
                check_relative (t->calibration, s->calibration, dim == 3 ? 0.05 : 1e-9);
                check_relative (t->full, s->full, dim == 3 ? 0.05 : 1e-9);
                for (size_t i = 0; f && i < b->cloud.n; i++)
                    check_relative (t->family_volume[i] * t->full, s->family_volume[i] * s->full, 1e-9);
                pg_sums_free (&s), pg_sums_free (&t);
                free (b);
            }
}

/* ---- volumes, surface, calibration --------------------------------------------------------------------- */
/* Points on the boundary with half the volume (lattice of vertices) */
static void volumes_of_points_count (void **state)
{
    (void) state;
    const double step[3] = {1, 1, 1};
    body *b = lattice_body (2, 12, 9, 1, step, NULL);
    pg_sum_rule rule = rule_of (2, "constant", 2.2, PG_PARTIAL_OVERLAP, PG_SURFACE_VOLUME);
    pg_sums *s;
    pg_family f;
    for (size_t i = 0; i < b->cloud.n; i++)
        b->volume[i] *= (i % 12 == 0 || i % 12 == 11 ? 0.5 : 1) * (i / 12 == 0 || i / 12 == 8 ? 0.5 : 1);
    check_ok (pg_sums_create (&s, &rule, &b->cloud, &b->lattice));
    check_ok (pg_sums_family (&f, s, NULL));
    check_relative (s->share[0], 0.25, 1e-12);
    check_relative (s->share[5], 0.5, 1e-12);
    check_relative (s->share[17], 1, 1e-12);
    check_relative (s->full, 0.01 * (3.14159265358979323846 * 2.2 * 2.2 - 1), 1e-12);
    for (size_t i = 0; i < b->cloud.n; i++) {
        double beta[60], sum = 0;
        pg_sums_bonds (s, &f, i, NULL, NULL, beta);
        for (size_t e = f.start[i]; e < f.start[i + 1]; e++)
            sum += beta[e - f.start[i]] * b->volume[f.node[e]];
        check_relative (s->family_volume[i], sum / s->full, 1e-12);
    }
    check_relative (s->family_volume[12 * 4 + 6], 1, 1e-12);       /* in the middle */
    pg_family_clear (&f);
    pg_sums_free (&s);
    free (b);
}

/* g_ij of theory A3: 1, 1 / sqrt (v_i v_j), 2 / (v_i + v_j) */
static void surface_factors_are_those_of_the_volumes (void **state)
{
    (void) state;
    for (int how = 0; how < 2; how++) {
        const double step[3] = {0.5, 0.5, 0.5};
        body *b = how ? random_body (2, 300, 0.06, 1) : lattice_body (3, 9, 8, 5, step, holes);
        double horizon = how ? 0.2 : 1.3;
        int dim = b->cloud.dim;
        pg_sums *s[3];
        pg_family f;
        for (int k = 0; k < 3; k++) {
            pg_sum_rule rule = rule_of (dim, "constant", horizon, PG_PARTIAL_LINEAR, (pg_surface) k);
            check_ok (pg_sums_create (&s[k], &rule, &b->cloud, how ? NULL : &b->lattice));
            assert_true (!s[k]->family_volume == (k == 0));
        }
        check_ok (pg_sums_family (&f, s[0], NULL));
        for (size_t i = 0; i < b->cloud.n; i++) {
            double w[3][400];
            assert_true (f.start[i + 1] - f.start[i] <= 400);
            for (int k = 0; k < 3; k++) pg_sums_bonds (s[k], &f, i, NULL, w[k], NULL);
            for (size_t e = 0; e < f.start[i + 1] - f.start[i]; e++) {
                double a = s[1]->family_volume[i], c = s[1]->family_volume[f.node[f.start[i] + e]];
                check_relative (w[1][e], w[0][e] / sqrt (a * c), 1e-14);
                check_relative (w[2][e], w[0][e] * 2 / (a + c), 1e-14);
            }
        }
        pg_family_clear (&f);
        for (int k = 0; k < 3; k++) pg_sums_free (&s[k]);
        free (b);
    }
}

/* Calibration and toughness of a lattice: theory A2 and the row of cuts; 1 where not wanted */
static void constants_of_a_lattice_are_the_printed_ones (void **state)
{
    (void) state;
    const double step[3] = {1e-3, 1e-3, 1e-3};
    for (int calibrate = 0; calibrate < 2; calibrate++) {
        body *b = lattice_body (2, 9, 9, 1, step, NULL);
        pg_sum_rule rule = rule_of (2, "constant", 3.015e-3, PG_PARTIAL_NONE, PG_SURFACE_NONE);
        pg_sums *s;
        rule.calibrate = calibrate;
        check_ok (pg_sums_create (&s, &rule, &b->cloud, &b->lattice));
        check_absolute (s->calibration, calibrate ? 0.97523 : 1, 1e-5);
        check_absolute (s->toughness, 1.00587 * (calibrate ? 0.97523 : 1), 2e-5);
        pg_sums_free (&s);
        free (b);
    }
    /* rectangular cells: the mean of three cuts */
    body *b = lattice_body (3, 6, 5, 4, (double[]) {1, 0.8, 0.7}, NULL);
    pg_sum_rule rule = rule_of (3, "quadratic", 2.7, PG_PARTIAL_OVERLAP, PG_SURFACE_NONE);
    pg_sums *s;
    double G0 = pg_bond_fracture_energy (PG_SOLID, rule.kernel, 2.7, 1, 1, 0.01), G = 0;
    check_ok (pg_sums_create (&s, &rule, &b->cloud, &b->lattice));
    for (int k = 0; k < 3; k++) G += pg_stencil_fracture_energy (&s->stencil, s->calibration, 1, 0.01, k) / 3;
    check_relative (s->toughness, G / G0, 1e-12);
    pg_sums_free (&s);
    free (b);
}

/* A straight cut between the rows of a square lattice whose points see four neighbours: a quarter of a family
 * is beyond it, from the row beside it alone. G = h (A d / 16 + B / 4) s0^2. */
static void a_cut_of_a_state_based_lattice (void **state)
{
    (void) state;
    const double h = 2e-3, step[3] = { h, h, h }, E = 3, nu = 0.2;
    double A, B;
    body *b = lattice_body (2, 9, 9, 1, step, NULL);
    pg_sum_rule rule = rule_of (2, "constant", 1.2 * h, PG_PARTIAL_NONE, PG_SURFACE_NONE);
    pg_criterion_setting setting = { .mode = rule.mode,
                                     .horizon = rule.horizon,
                                     .modulus = E,
                                     .poisson = nu,
                                     .kernel = "constant",
                                     .state = 1 };
    pg_sums *s;
    rule.state = 1;
    check_ok (pg_sums_create (&s, &rule, &b->cloud, &b->lattice));
    pg_state_moduli (rule.mode, E, nu, &A, &B);
    check_relative (pg_sums_toughness (s, E, nu),
                    h * (A / 8 + B / 4) / pg_state_fracture_energy (&setting, 1), 1e-12);
    pg_sums_free (&s);
    free (b);
}

/* A cloud shaken by a fifth of its spacing: its calibration stays near the lattice's, and inside the
 * hydrostatic energy is nearly that of elasticity */
static void a_shaken_lattice_is_calibrated_by_its_inner_points (void **state)
{
    (void) state;
    for (int dim = 2; dim <= 3; dim++) {
        const double step[3] = {1, 1, 1};
        int n = dim == 2 ? 40 : 15;
        body *b = lattice_body (dim, n, n, dim == 3 ? n : 1, step, NULL);
        pg_sum_rule rule = rule_of (dim, "constant", 3.015, PG_PARTIAL_LINEAR, PG_SURFACE_NONE);
        pg_sums *even, *s;
        uint32_t seed = 9;
        check_ok (pg_sums_create (&even, &rule, &b->cloud, &b->lattice));
        for (size_t i = 0; i < b->cloud.n * (size_t) dim; i++) b->x[i] += 0.2 * (2 * next (&seed) - 1);
        check_ok (pg_sums_create (&s, &rule, &b->cloud, &b->lattice));
        assert_int_equal (s->sites.count[0], 0);
        check_relative (s->calibration, even->calibration, dim == 2 ? 0.02 : 0.06);
        check_relative (s->full, even->full, dim == 2 ? 0.02 : 0.06);
        assert_true (s->toughness == 1);
        pg_sums_free (&s), pg_sums_free (&even);
        free (b);
    }
}

/* ---- failures ------------------------------------------------------------------------------------------ */
static void wrong_input_is_refused (void **state)
{
    (void) state;
    const double step[3] = {1, 1, 1};
    body *b = lattice_body (2, 8, 8, 1, step, NULL);
    pg_lattice none = no_lattice (2);
    pg_sum_rule good = rule_of (2, "constant", 3, PG_PARTIAL_LINEAR, PG_SURFACE_PRODUCT), bad = good;
    pg_sums *s;
    bad.partial = PG_PARTIAL_OVERLAP;
    check_fails (pg_sums_create (&s, &bad, &b->cloud, &none), PG_E_USAGE);
    check_contains (pg_last_error (), "linear");
    assert_null (s);
    bad = good, bad.mode = PG_SOLID;
    check_fails (pg_sums_create (&s, &bad, &b->cloud, &b->lattice), PG_E_USAGE);
    bad = good, bad.horizon = 0.4;
    check_fails (pg_sums_create (&s, &bad, &b->cloud, &b->lattice), PG_E_USAGE);
    check_fails (pg_sums_create (&s, &bad, &b->cloud, &none), PG_E_USAGE);
    bad.horizon = -1;
    check_fails (pg_sums_create (&s, &bad, &b->cloud, &none), PG_E_USAGE);
    b->x[31] = NAN;
    check_fails (pg_sums_create (&s, &good, &b->cloud, &b->lattice), PG_E_USAGE);
    memcpy (b->x + 30, b->x + 34, 2 * sizeof (double));
    check_fails (pg_sums_create (&s, &good, &b->cloud, &b->lattice), PG_E_USAGE);
    check_contains (pg_last_error (), "15 and 17 coincide");
    b->x[30] += 1e-9;                                              /* not the same bits, the same place */
    check_fails (pg_sums_create (&s, &good, &b->cloud, &b->lattice), PG_E_USAGE);
    check_contains (pg_last_error (), "15 and 17 coincide");
    b->cloud.n = 0;
    check_fails (pg_sums_create (&s, &good, &b->cloud, &b->lattice), PG_E_USAGE);
    pg_sums_free (&s);                                             /* NULL is fine */
    free (b);
}

static void running_out_of_memory_leaves_nothing (void **state)
{
    (void) state;
    const double step[3] = {1, 1, 1};
    body *b = lattice_body (2, 8, 8, 1, step, NULL);
    pg_lattice none = no_lattice (2);
    b->volume[3] *= 0.5;
    for (int how = 0; how < 2; how++) {
        pg_sum_rule rule = rule_of (2, "constant", 3, PG_PARTIAL_LINEAR, PG_SURFACE_PRODUCT);
        size_t held = pg_memory_used (), failures = 0;
        for (size_t k = 1; ; k++) {
            pg_sums *s = NULL;
            pg_family f = {0};
            pg_memory_fail_at (k);
            pg_status status = pg_sums_create (&s, &rule, &b->cloud, how ? &b->lattice : &none);
            if (status == PG_OK) status = pg_sums_family (&f, s, NULL);
            pg_memory_fail_at (0);
            pg_family_clear (&f);
            pg_sums_free (&s);
            assert_int_equal (pg_memory_used (), held);
            if (status == PG_OK) break;
            assert_int_equal (status, PG_E_MEMORY);
            failures++;
        }
        assert_true (failures >= 10);
    }
    free (b);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (points_find_their_sites),
        cmocka_unit_test (points_off_a_lattice_are_none),
        cmocka_unit_test (a_cut_of_a_state_based_lattice),
        cmocka_unit_test (lattices_are_found),
        cmocka_unit_test (families_of_lattices_match_brute_force),
        cmocka_unit_test (threads_find_the_same_families),
        cmocka_unit_test (the_numbering_of_points_changes_nothing),
        cmocka_unit_test (families_of_irregular_clouds_match_brute_force),
        cmocka_unit_test (a_lattice_is_a_cloud),
        cmocka_unit_test (volumes_of_points_count),
        cmocka_unit_test (surface_factors_are_those_of_the_volumes),
        cmocka_unit_test (constants_of_a_lattice_are_the_printed_ones),
        cmocka_unit_test (a_shaken_lattice_is_calibrated_by_its_inner_points),
        cmocka_unit_test (wrong_input_is_refused),
        cmocka_unit_test (running_out_of_memory_leaves_nothing),
    };
    return cmocka_run_group_tests_name ("sums over bonds", tests, NULL, NULL);
}

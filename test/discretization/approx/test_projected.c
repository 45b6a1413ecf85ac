/* SPDX-License-Identifier: GPL-3.0-or-later
 * degenerate: projected. Points whose neighbours lie on a line or a plane keep the derivatives along it:
 * theory F3 item 3, value F-4. */
#include "lattice.h"
#include "discretization/approx/moment.h"
#include "scene_runs/run.h"

static const char *const type[] = { "rkpm", "pddo", "nosb" };

static pg_approx projecting (const char *name, const char *kernel, int order, int shape, double horizon)
{
    pg_approx a = make (name, kernel, order, shape, horizon);
    a.projected = 1;
    return a;
}

static unsigned char *random_alive (const pg_rows *r, double probability)
{
    size_t nnz = r->family.start[r->n];
    unsigned char *alive = pg_calloc (nnz, 1);
    for (size_t e = 0; e < nnz; e++) alive[e] = rnd () < 2 * probability - 1;
    return alive;
}

static void check_same (const pg_rows *a, const pg_rows *b)
{
    size_t nnz = a->family.start[a->n];
    assert_memory_equal (a->grade, b->grade, a->n);
    assert_memory_equal (a->N, b->N, nnz * sizeof *a->N);
    assert_memory_equal (a->dN, b->dN, nnz * (size_t) a->dim * sizeof *a->dN);
    assert_memory_equal (a->w, b->w, nnz * sizeof *a->w);
}

/* ---- value F-4 ---- */
static double line[8] = { 0, 0, 1, 1, -1, -1, 2, 2 };
static double given[4] = { 1, 1, 1, 0.5 };
static const double F4[4] = { .30769231, .23076923, .38461538, .07692308 };

static void prescribed_weights_give_the_tabled_values (void **state)
{
    (void) state;
    double z[8], w[4], p[12], N[4], dN[8], b[3];
    size_t entry[4] = { 0, 1, 2, 3 };
    for (int i = 0; i < 8; i++) z[i] = line[i] / 2;
    for (int j = 0; j < 4; j++) w[j] = given[j] / 3.5;
    pg_neighbourhood s = {
        .dim = 2, .constant = 1, .a = 2, .n = 4, .entry = entry, .z = z, .w = w, .p = p, .project = 1
    };
    assert_int_equal (pg_neighbourhood_grade (&s, 1, 1), PG_GRADE_PROJECTED);
    pg_neighbourhood_solve (&s, 0, b);
    pg_neighbourhood_shape (&s, b, N);
    pg_neighbourhood_differential (&s, dN);
    for (int j = 0; j < 4; j++) check_absolute (N[j], F4[j], 1e-8);
    for (int k = 0; k < 2; k++)
        for (int l = 0; l < 2; l++) {
            double sum = 0;
            for (int j = 0; j < 4; j++) sum += dN[2*j + k] * line[2*j + l];
            check_absolute (sum, 0.5, 1e-8);
        }
}

/* The same weights as volumes under the constant kernel */
static void every_approximation_gives_the_tabled_values (void **state)
{
    (void) state;
    const double at[2] = { 0, 0 };
    for (int t = 0; t < 4; t++) {
        int own = t == 3 ? 0 : -1;                     /* nosb at a node, too */
        pg_cloud c = { .dim = 2, .n = 4, .x = line, .volume = given, .h = 1, .thickness = 1 };
        pg_approx a = projecting (type[t > 2 ? 2 : t], "constant", 1, PG_TENSOR, 2);
        a.use_volume = 1;
        pg_rows r = rows_at (&a, &c, 1, at, &own);
        assert_int_equal (r.grade[0], PG_GRADE_PROJECTED);
        for (int j = 0; j < 4; j++) check_absolute (N_of (&r, 0, j), own == 0 ? j == 0 : F4[j], 1e-8);
        for (int k = 0; k < 2; k++)
            for (int l = 0; l < 2; l++) {
                double sum = 0;
                for (int j = 0; j < 4; j++) sum += dN_of (&r, 0, j, k) * line[2*j + l];
                check_absolute (sum, 0.5, 1e-8);
            }
        pg_rows_clear (&r);
    }
}

static void by_default_the_same_point_carries_no_stress (void **state)
{
    (void) state;
    const double at[2] = { 0, 0 };
    for (int t = 0; t < 3; t++) {
        pg_cloud c = { .dim = 2, .n = 4, .x = line, .volume = given, .h = 1, .thickness = 1 };
        pg_approx a = make (type[t], "constant", 1, PG_TENSOR, 2);
        a.use_volume = 1;
        pg_rows r = rows_at (&a, &c, 1, at, NULL);
        assert_int_equal (r.grade[0], PG_GRADE_SHEPARD);
        for (int j = 0; j < 4; j++) check_absolute (N_of (&r, 0, j), given[j] / 3.5, 1e-15);
        for (int e = 0; e < 8; e++) assert_true (r.dN[e] == 0);
        pg_rows_clear (&r);
    }
}

/* ---- lines and planes in any direction ---- */
enum { MOST = 40 };
typedef struct {
    int      dim, flat;  /* dimension of the space, of the line (1) or plane (2) */
    double   frame[9];                                 /* rows: directions, first those along it */
    double   x[3 * MOST], volume[MOST];
    pg_cloud cloud;
} sheet;

static void frame_of (sheet *s)
{
    for (int k = 0; k < s->dim; k++) {
        double *q = s->frame + 3*k, size = 0;
        for (int c = 0; c < s->dim; c++) q[c] = rnd ();
        for (int l = 0; l < k; l++) {
            double part = 0;
            for (int c = 0; c < s->dim; c++) part += q[c] * s->frame[3*l + c];
            for (int c = 0; c < s->dim; c++) q[c] -= part * s->frame[3*l + c];
        }
        for (int c = 0; c < s->dim; c++) size += q[c] * q[c];
        for (int c = 0; c < s->dim; c++) q[c] /= sqrt (size);
    }
}

/* Nodes about h = 1 apart on a line or a plane through the origin, up to `thick` beside it */
static void sheet_create (sheet *s, int dim, int flat, double thick)
{
    size_t n = flat == 1 ? 7 : 25;
    *s = (sheet) { .dim = dim, .flat = flat };
    frame_of (s);
    for (size_t i = 0; i < n; i++) {
        double along[3] = { (double) (flat == 1 ? i : i % 5) - (flat == 1 ? 3 : 2) + 0.2 * rnd (),
                            (double) (i / 5) - 2 + 0.2 * rnd () };
        for (int k = flat; k < dim; k++) along[k] = thick * rnd ();
        for (int c = 0; c < dim; c++)
            for (int k = 0; k < dim; k++) s->x[i * (size_t) dim + (size_t) c] += along[k] * s->frame[3*k + c];
        s->volume[i] = 1 + 0.3 * rnd ();
    }
    s->cloud = (pg_cloud) { .dim = dim, .n = n, .x = s->x, .volume = s->volume, .h = 1, .thickness = 1 };
}

/* A point at `along` on the sheet and `beside` it */
static void place (const sheet *s, double along, double beside, double *x)
{
    for (int c = 0; c < s->dim; c++) {
        x[c] = beside * s->frame[3 * (s->dim - 1) + c];
        for (int k = 0; k < s->flat; k++) x[c] += (along + 0.1 * k) * s->frame[3*k + c];
    }
}

static double along (const sheet *s, int k, const double *x)
{
    double sum = 0;
    for (int c = 0; c < s->dim; c++) sum += s->frame[3*k + c] * x[c];
    return sum;
}

/* Sums over the row: of N, of dN, of N and dN with the coordinate in direction `d` */
static void check_row (const sheet *s, const pg_rows *r, const double *x, double tight, double exact)
{
    double one = 0, rate[3] = { 0 };
    size_t dim = (size_t) s->dim;
    assert_int_equal (r->grade[0], PG_GRADE_PROJECTED);
    for (size_t e = 0; e < r->family.start[1]; e++) {
        one += r->N[e];
        for (size_t k = 0; k < dim; k++) rate[k] += r->dN[e*dim + k];
    }
    check_absolute (one, 1, tight);
    for (size_t k = 0; k < dim; k++) check_absolute (rate[k], 0, tight);
    for (int d = 0; d < s->dim; d++) {
        double value = 0, slope[3] = { 0 };
        for (size_t e = 0; e < r->family.start[1]; e++) {
            double y = along (s, d, s->x + (size_t) r->family.node[e] * dim);
            value += r->N[e] * y;
            for (size_t k = 0; k < dim; k++) slope[k] += r->dN[e*dim + k] * y;
        }
        check_absolute (value, d < s->flat ? along (s, d, x) : 0, exact);  /* across: the foot of the point */
        for (size_t k = 0; k < dim; k++)
            check_absolute (slope[k], d < s->flat ? s->frame[3 * d + (int) k] : 0, exact);
    }
}

static void fields_along_a_line_or_plane_are_reproduced (void **state)
{
    (void) state;
    for (int t = 0; t < 3 * 60; t++) {
        sheet s;
        double x[3];
        int three = t / 3 % 3, on_a_node = t % 3 == 2 && t % 4 == 0, middle;
        sheet_create (&s, three ? 3 : 2, three == 2 ? 2 : 1, 0);
        middle = s.flat == 1 ? 3 : 12;
        place (&s, 0.1 * rnd (), t % 2 ? 0.4 * rnd () : 0, x);
        if (on_a_node) memcpy (x, s.x + middle * s.dim, (size_t) s.dim * sizeof *x);
        pg_approx a = projecting (type[t % 3], t % 5 ? "cubic_spline" : "quadratic", 1,
                                  t % 7 ? PG_RADIAL : PG_TENSOR, 2.7);
        pg_rows r = rows_at (&a, &s.cloud, 1, x, on_a_node ? &middle : NULL);
        check_row (&s, &r, x, 1e-14, 1e-12);
        pg_rows_clear (&r);
    }
}

/* Rigid translation must not strain a point beside its neighbours: there p (0) is not in the range of A. */
static void the_partition_of_unity_holds_far_beside_the_line (void **state)
{
    (void) state;
    for (int t = 0; t < 3; t++)
        for (double beside = 0.25; beside < 2; beside *= 2) {
            sheet s;
            double x[3];
            sheet_create (&s, 3, 1 + t % 2, 0);
            place (&s, 0.05, beside, x);
            pg_approx a = projecting (type[t], "gaussian", 1, PG_RADIAL, 3);
            pg_rows r = rows_at (&a, &s.cloud, 1, x, NULL);
            check_row (&s, &r, x, 1e-14, 1e-12);
            pg_rows_clear (&r);
        }
}

/* A spread that the plain rule calls none must not become a derivative of 1 / spread. */
static void a_nearly_flat_sheet_is_flat (void **state)
{
    (void) state;
    for (int t = 0; t < 3 * 20; t++)
        for (double thick = 3e-2; thick > 1e-6; thick /= 7) {
            sheet s;
            double x[3], one = 0, rate[3] = { 0 }, P[9] = { 0 }, trace = 0;
            int dim = 2 + t / 3 % 2;
            size_t m = (size_t) dim;
            sheet_create (&s, dim, dim == 3 && t % 2 ? 2 : 1, thick);
            place (&s, 0.1, t % 4 < 2 ? 0 : 0.3, x);
            pg_approx a = projecting (type[t % 3], "cubic_spline", 1, PG_RADIAL, 2.7);
            pg_rows r = rows_at (&a, &s.cloud, 1, x, NULL);
            assert_int_equal (r.grade[0], PG_GRADE_PROJECTED);
            for (size_t e = 0; e < r.family.start[1]; e++) {
                one += r.N[e];
                for (size_t k = 0; k < m; k++) {
                    check_below (fabs (r.dN[e*m + k]), 2);
                    rate[k] += r.dN[e*m + k];
                    for (size_t l = 0; l < m; l++)
                        P[k * m + l] += r.dN[e * m + k] * s.x[(size_t) r.family.node[e] * m + l];
                }
            }
            check_absolute (one, 1, 1e-14);
            for (size_t k = 0; k < m; k++) check_absolute (rate[k], 0, 1e-14);
            pg_rows_clear (&r);
            if (t % 3 == 0) continue;                  /* rkpm: exact along the sheet only */
            for (size_t k = 0; k < m; k++)  /* gradients of the coordinates: a projector of rank `flat` */
                for (size_t l = 0; l < m; l++) {
                    double square = 0;
                    for (size_t c = 0; c < m; c++) square += P[k*m + c] * P[c*m + l];
                    check_absolute (square, P[k*m + l], 1e-12);
                    check_absolute (P[l*m + k], P[k*m + l], 1e-12);
                    if (k == l) trace += P[k*m + k];
                }
            check_absolute (trace, s.flat, 1e-12);
        }
}

/* On an exactly flat sheet the projector is constant: nothing is neglected in rkpm's derivative, whichever
 * way the point moves. */
static void the_derivative_of_rkpm_is_that_of_its_shape_functions (void **state)
{
    (void) state;
    const double step = 1e-4;
    for (int t = 0; t < 30; t++) {
        sheet s;
        double x[7 * 3];
        sheet_create (&s, t % 3 ? 3 : 2, t % 3 == 2 ? 2 : 1, 0);
        size_t dim = (size_t) s.dim;
        for (int q = 0; q < 7; q++) {
            place (&s, 0.07, t % 2 ? 0.3 : 0, x + (size_t) q * dim);
            if (q > 0 && q <= 2 * s.dim) x[(size_t) q * dim + (size_t) (q - 1) / 2] += q % 2 ? step : -step;
        }
        pg_approx a = projecting ("rkpm", "gaussian", 1, PG_RADIAL, 3.2);
        pg_rows r = rows_at (&a, &s.cloud, 1 + 2 * dim, x, NULL);
        for (int j = 0; j < (int) s.cloud.n; j++) {
            if (place_of (&r, 0, j) == (size_t) -1) continue;
            for (int k = 0; k < s.dim; k++) {
                size_t up = (size_t) (1 + 2*k), down = up + 1;
                check_absolute (dN_of (&r, 0, j, k), (N_of (&r, up, j) - N_of (&r, down, j)) / (2 * step),
                                1e-6);
            }
        }
        pg_rows_clear (&r);
    }
}

static void no_unit_is_special (void **state)
{
    (void) state;
    for (int t = 0; t < 3; t++) {
        sheet s;
        double x[3];
        sheet_create (&s, 3, 2, 1e-3);
        place (&s, 0.1, 0.2, x);
        pg_approx a = projecting (type[t], "cubic_spline", 1, PG_RADIAL, 2.7);
        pg_rows r = rows_at (&a, &s.cloud, 1, x, NULL);
        const double unit = ldexp (1, -30);
        for (size_t i = 0; i < 3 * s.cloud.n; i++) s.x[i] *= unit;
        for (int c = 0; c < 3; c++) x[c] *= unit;
        a.horizon *= unit, s.cloud.h *= unit;
        pg_rows small = rows_at (&a, &s.cloud, 1, x, NULL);
        assert_int_equal (small.grade[0], PG_GRADE_PROJECTED);
        assert_int_equal (small.family.start[1], r.family.start[1]);
        for (size_t e = 0; e < r.family.start[1]; e++) {
            assert_true (small.N[e] == r.N[e]);
            for (size_t k = 0; k < 3; k++) assert_true (small.dN[3*e + k] * unit == r.dN[3*e + k]);
        }
        pg_rows_clear (&r);
        pg_rows_clear (&small);
    }
}

/* ---- where nothing is left, and where nothing changes ---- */
static void too_little_is_left_for_a_direction (void **state)
{
    (void) state;
    double x[8] = { 0.5, 0.1, 0.5, 0.1, 0.5, 0.1, 0.51, 0.1 }, volume[4] = { 1, 1, 1, 1 };
    const double at[2] = { 0.3, 0 };
    for (int t = 0; t < 3; t++)
        for (size_t n = 0; n <= 4; n++) {  /* none, one, two and three at one place, one 0.01 h beside them */
            pg_cloud c = { .dim = 2, .n = n, .x = x, .volume = volume, .h = 1, .thickness = 1 };
            pg_approx a = projecting (type[t], "quadratic", 1, PG_RADIAL, 2);
            if (n == 0) continue;
            pg_rows r = rows_at (&a, &c, 1, at, NULL);
            const unsigned char dead[4] = { 0 };
            assert_int_equal (r.grade[0], PG_GRADE_SHEPARD);
            for (size_t e = 0; e < n; e++) assert_true (r.N[e] > 0 && r.dN[2*e] == 0 && r.dN[2*e + 1] == 0);
            check_ok (a.type->evaluate (&a, &c, &r, dead, 1, NULL, 1));
            assert_int_equal (r.grade[0], PG_GRADE_DEAD);
            pg_rows_clear (&r);
        }
}

static void two_neighbours_leave_the_direction_between_them (void **state)
{
    (void) state;
    double x[4] = { 0, 0, 3, 4 }, volume[2] = { 1, 1 };
    const double at[2] = { 1.5, 2 };
    for (int t = 0; t < 3; t++) {
        pg_cloud c = { .dim = 2, .n = 2, .x = x, .volume = volume, .h = 5, .thickness = 1 };
        pg_approx a = projecting (type[t], "quadratic", 1, PG_RADIAL, 8);
        pg_rows r = rows_at (&a, &c, 1, at, NULL);
        assert_int_equal (r.grade[0], PG_GRADE_PROJECTED);
        for (int j = 0; j < 2; j++) {                  /* u,t = (u_1 - u_0) / 5 along t = (0.6, 0.8) */
            check_absolute (N_of (&r, 0, j), 0.5, 1e-14);
            check_absolute (dN_of (&r, 0, j, 0), (j ? 1 : -1) * 0.12, 1e-14);
            check_absolute (dN_of (&r, 0, j, 1), (j ? 1 : -1) * 0.16, 1e-14);
        }
        pg_rows_clear (&r);
    }
}

/* Its basis has no 1: a line that misses the node spans the plane. */
static void a_node_of_nosb_beside_a_line_has_both_derivatives (void **state)
{
    (void) state;
    double x[8] = { 0, 0, 1, -1, 1, 0.1, 1, 1.2 }, volume[4] = { 1, 1, 1, 1 };
    const int own = 0;
    for (size_t n = 3; n <= 4; n++) {
        pg_cloud c = { .dim = 2, .n = n, .x = x, .volume = volume, .h = 1, .thickness = 1 };
        pg_approx a = projecting ("nosb", "cubic_spline", 1, PG_RADIAL, 2);
        pg_rows r = rows_at (&a, &c, 1, x, &own);
        assert_int_equal (r.grade[0], PG_GRADE_PROJECTED);
        for (int k = 0; k < 2; k++) {
            double sum[3] = { 0 };
            for (int j = 0; j < (int) n; j++) {
                sum[2] += dN_of (&r, 0, j, k);
                for (int l = 0; l < 2; l++) sum[l] += dN_of (&r, 0, j, k) * x[2*j + l];
            }
            for (int l = 0; l < 3; l++) check_absolute (sum[l], k == l, 1e-13);
        }
        pg_rows_clear (&r);
    }
}

static void only_points_of_the_plain_rule_change (void **state)
{
    (void) state;
    size_t changed = 0;
    for (int t = 0; t < 3 * 12; t++) {
        int dim = 1 + t / 3 % 3, order = 1 + t % 2;
        pg_cloud c = lattice (dim, dim == 1 ? 30 : dim == 2 ? 9 : 5, 1e-3, t % 4 > 1 ? 0.2 : 0);
        pg_approx on = projecting (type[t % 3], "cubic_spline", order, PG_RADIAL, 2.6e-3), off = on;
        off.projected = 0;
        pg_rows a = rows_at_nodes (&on, &c), b = rows_at_nodes (&off, &c);
        unsigned char *alive = random_alive (&a, dim == 3 ? 0.1 : 0.3);
        check_ok (on.type->evaluate (&on, &c, &a, alive, c.n, NULL, 1));
        check_ok (off.type->evaluate (&off, &c, &b, alive, c.n, NULL, 1));
        assert_int_equal (pg_rows_count (&b, PG_GRADE_PROJECTED), 0);
        assert_true (pg_rows_count (&b, PG_GRADE_SHEPARD) > 0);
        if (order == 2 || dim == 1) check_same (&a, &b);  /* the quadratic basis never projects */
        for (size_t i = 0; i < a.n; i++) {
            size_t first = a.family.start[i], m = a.family.start[i + 1] - first;
            if (a.grade[i] != b.grade[i]) {
                assert_int_equal (a.grade[i], PG_GRADE_PROJECTED);
                assert_int_equal (b.grade[i], PG_GRADE_SHEPARD);
                changed++;
                continue;
            }
            assert_memory_equal (a.N + first, b.N + first, m * sizeof *a.N);
            assert_memory_equal (a.dN + first * (size_t) dim, b.dN + first * (size_t) dim,
                                 m * (size_t) dim * sizeof *a.dN);
        }
        pg_free (alive);
        pg_rows_clear (&a);
        pg_rows_clear (&b);
        lattice_clear (&c);
    }
    assert_true (changed > 100);
}

/* rkpm's derivative is a difference of terms up to 1e2 times as large where all that lives is close to the
 * support's edge. */
static void random_deaths_keep_the_partition_of_unity (void **state)
{
    (void) state;
    size_t seen[PG_GRADE_DEAD + 1] = { 0 };
    for (int t = 0; t < 3 * 20; t++) {
        int dim = 2 + t / 3 % 2;
        pg_cloud c = lattice (dim, dim == 2 ? 8 : 5, 1e-3, t % 2 ? 0.2 : 0);
        pg_approx a = projecting (type[t % 3], "cubic_spline", 1, PG_RADIAL, 2.6e-3);
        pg_rows r = rows_at_nodes (&a, &c);
        unsigned char *alive = random_alive (&r, 0.02 * (t % 20));
        check_ok (a.type->evaluate (&a, &c, &r, alive, r.n, NULL, 1));
        for (size_t i = 0; i < r.n; i++) {
            double sum = 0, size = 1, slope[3] = { 0 };
            for (size_t e = r.family.start[i]; e < r.family.start[i + 1]; e++) {
                sum += r.N[e], size += fabs (r.N[e]);
                for (int k = 0; k < dim; k++) {
                    double d = 1e-3 * r.dN[e * (size_t) dim + (size_t) k];
                    slope[k] += d, size += fabs (d);
                }
            }
            seen[r.grade[i]]++;
            if (r.grade[i] != PG_GRADE_PROJECTED) continue;
            check_scaled (sum, 1, 1e-14, size);
            for (int k = 0; k < dim; k++) check_scaled (slope[k], 0, t % 3 == 0 ? 1e-12 : 1e-14, size);
        }
        pg_free (alive);
        pg_rows_clear (&r);
        lattice_clear (&c);
    }
    assert_true (seen[PG_GRADE_PROJECTED] > 100 && seen[PG_GRADE_SHEPARD] > 0 && seen[PG_GRADE_DEAD] > 0);
}

static void threads_do_not_change_a_bit (void **state)
{
    (void) state;
    for (int t = 0; t < 3; t++) {
        pg_cloud c = lattice (3, 6, 1, 0.2);
        pg_approx a = projecting (type[t], "quartic_spline", 1, PG_TENSOR, 2.2);
        pg_rows one = rows_at_nodes (&a, &c), two = rows_at_nodes (&a, &c);
        unsigned char *alive = random_alive (&one, 0.05);
        check_ok (a.type->evaluate (&a, &c, &one, alive, c.n, NULL, 1));
        assert_true (pg_rows_count (&one, PG_GRADE_PROJECTED) > 10);
        for (int threads = 2; threads <= 5; threads += 3) {
            check_ok (a.type->evaluate (&a, &c, &two, alive, c.n, NULL, threads));
            check_same (&one, &two);
        }
        pg_free (alive);
        pg_rows_clear (&one);
        pg_rows_clear (&two);
        lattice_clear (&c);
    }
}

static void no_point_allocates (void **state)
{
    (void) state;
    pg_cloud c = lattice (3, 6, 1, 0.2);
    pg_approx a = projecting ("rkpm", "cubic_spline", 1, PG_RADIAL, 2.2), off = a;
    off.projected = 0;
    pg_rows r = rows_at_nodes (&a, &c);
    unsigned char *alive = random_alive (&r, 0.05);
    size_t before = pg_memory_calls (), calls[3];
    check_ok (off.type->evaluate (&off, &c, &r, alive, 1, NULL, 1));
    calls[0] = pg_memory_calls () - before, before = pg_memory_calls ();
    check_ok (a.type->evaluate (&a, &c, &r, alive, 1, NULL, 1));
    calls[1] = pg_memory_calls () - before, before = pg_memory_calls ();
    check_ok (a.type->evaluate (&a, &c, &r, alive, c.n, NULL, 1));
    calls[2] = pg_memory_calls () - before;
    assert_true (pg_rows_count (&r, PG_GRADE_PROJECTED) > 10);
    assert_int_equal (calls[1], calls[0]);
    assert_int_equal (calls[2], calls[0]);
    pg_free (alive);
    pg_rows_clear (&r);
    lattice_clear (&c);
}

/* ---- the scene ---- */
static void the_scene_chooses (void **state)
{
    (void) state;
    static const char *const text[] = { "{horizon: 7 mm}", "{degenerate: shepard}",
                                        "{degenerate: projected}" };
    for (int t = 0; t < 3; t++) {
        pg_scene *s = NULL;
        pg_approx a;
        char scene[200];
        snprintf (scene, sizeof scene, "dimension: 2\nmethod: %s\n", text[t]);
        check_ok (pg_scene_parse (&s, scene, "m.yaml"));
        check_ok (pg_approx_read (&a, s, 2e-3));
        assert_int_equal (a.projected, t == 2);
        pg_scene_free (&s);
    }
    pg_scene *s = NULL;
    check_fails (pg_scene_parse (&s, "dimension: 2\nmethod: {degenerate: project}\n", "m.yaml"), PG_E_SCENE);
    check_contains (pg_last_error (), "projected");
    pg_scene_free (&s);
}

/* A row of points cut off from those above and below, in a plate that is pulled along it: nothing, or the bar
 * of one dimension. */
#define BAR \
    "spacing: 0.1\nmaterials: {rock: {youngs_modulus: 10 GPa, poissons_ratio: 0}}\nsolver: {stepping: " \
    "fixed, steps: 1}\n" \
    "output: {at: {levels: 1}}\nmethod: {approximation: %s, integration: nodal, stabilization: none, " \
    "essential: transformation, degenerate: %s}\n"
static void a_row_between_two_cuts_carries_the_stress_of_a_bar (void **state)
{
    (void) state;
    for (int t = 0; t < 4; t++) {
        const char *rule = t / 2 ? "projected" : "shepard";
        run bar = scene_of (
            1,
            BAR "dimension: 1\nbody: [{add: {box: {low: [0], high: [1]}}}]\n"
                "boundary: [{set: left, displacement: {x: 0}}, {set: right, displacement: {x: 1 mm}}]\n",
            type[t % 2], rule);
        run plate = scene_of (
            1,
            BAR "dimension: 2\nthickness: 20 mm\nbody: [{add: {box: {low: [0, 0], high: [1, 0.8]}}}]\n"
                "cracks: [{from: [-0.2, 0.35], to: [1.2, 0.35]}, {from: [-0.2, 0.45], to: [1.2, 0.45]}]\n"
                "boundary: [{set: left, displacement: {x: 0, y: 0}}, {set: right, displacement: {x: 1 mm, y: "
                "0}}]\n",
            type[t % 2], rule);
        size_t row = 0;
        pg_census left = { 0 };
        int components;
        void *self;
        to_the_end (&bar);
        to_the_end (&plate);
        double *s = field_of (&plate, NULL, "stress", &components),
               *exact = field_of (&bar, NULL, "stress", NULL);
        for (size_t i = 0; i < plate.problem->cloud.n; i++) {
            const double *x = plate.problem->cloud.x + 2*i, *stress = s + i * (size_t) components;
            if (fabs (x[1] - 0.4) > 0.01) continue;
            check_scaled (stress[0], t / 2 ? exact[lround (10 * x[0])] : 0, 1e-9, 10e9 * 1e-3);
            row++;
        }
        assert_int_equal (row, 11);
        check_relative (exact[5], 10e9 * 1e-3, 0.1);
        const pg_force_type *force = pg_solver_force (plate.solver, &self);
        check_ok (force->census (self, &left));
        assert_int_equal (left.degenerate, t / 2 ? 0 : 11);
        pg_free (s), pg_free (exact);
        clear (&plate);
        clear (&bar);
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (prescribed_weights_give_the_tabled_values),
        cmocka_unit_test (every_approximation_gives_the_tabled_values),
        cmocka_unit_test (by_default_the_same_point_carries_no_stress),
        cmocka_unit_test (fields_along_a_line_or_plane_are_reproduced),
        cmocka_unit_test (the_partition_of_unity_holds_far_beside_the_line),
        cmocka_unit_test (a_nearly_flat_sheet_is_flat),
        cmocka_unit_test (the_derivative_of_rkpm_is_that_of_its_shape_functions),
        cmocka_unit_test (no_unit_is_special),
        cmocka_unit_test (too_little_is_left_for_a_direction),
        cmocka_unit_test (two_neighbours_leave_the_direction_between_them),
        cmocka_unit_test (a_node_of_nosb_beside_a_line_has_both_derivatives),
        cmocka_unit_test (only_points_of_the_plain_rule_change),
        cmocka_unit_test (random_deaths_keep_the_partition_of_unity),
        cmocka_unit_test (threads_do_not_change_a_bit),
        cmocka_unit_test (no_point_allocates),
        cmocka_unit_test (the_scene_chooses),
        cmocka_unit_test (a_row_between_two_cuts_carries_the_stress_of_a_bar),
    };
    return cmocka_run_group_tests_name ("discretization/approx/projected", tests, NULL, NULL);
}

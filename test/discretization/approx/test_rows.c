/* SPDX-License-Identifier: GPL-3.0-or-later
 * Rows: creation, partial evaluation, threads, dead bonds, degenerate points, failing memory. */
#include "check.h"
#include "lattice.h"

static const char *const type[3] = { "rkpm", "pddo", "nosb" };

static void check_same (const pg_rows *a, const pg_rows *b)
{
    size_t nnz = a->family.start[a->n];
    assert_int_equal (nnz, b->family.start[b->n]);
    assert_memory_equal (a->N, b->N, nnz * sizeof *a->N);
    assert_memory_equal (a->dN, b->dN, nnz * (size_t) a->dim * sizeof *a->dN);
    assert_memory_equal (a->w, b->w, nnz * sizeof *a->w);
    assert_memory_equal (a->grade, b->grade, a->n);
}

/* About every third bond is dead. */
static unsigned char *random_alive (const pg_rows *r)
{
    size_t nnz = r->family.start[r->n];
    unsigned char *alive = pg_calloc (nnz, 1);
    for (size_t e = 0; e < nnz; e++) alive[e] = rnd () > -0.3;
    return alive;
}

static void the_catalogue_lists_three (void **state)
{
    (void) state;
    assert_string_equal (pg_approx_names (), "rkpm|pddo|nosb");
    assert_null (pg_approx_find ("mls"));
    assert_int_equal (pg_approx_find ("rkpm")->use_volume, 0);
    assert_int_equal (pg_approx_find ("pddo")->use_volume, 1);
    assert_int_equal (pg_approx_find ("nosb")->use_volume, 1);
}

static void creation_copies_points_and_leaves_them_dead (void **state)
{
    (void) state;
    pg_cloud c = lattice (2, 5, 1, 0);
    pg_approx a = make ("rkpm", "cubic_spline", 1, PG_RADIAL, 2);
    double x[4] = { 1.5, 1.5, 3, 2 };
    const double weight[2] = { 0.25, 0.5 };
    const int own[2] = { -1, 13 }, cell[2] = { 7, 9 };
    pg_rows r, bare;
    check_ok (pg_rows_create (&r, &a, &c, 2, x, weight, own, cell));
    check_ok (pg_rows_create (&bare, &a, &c, 2, x, NULL, NULL, NULL));
    x[0] = 100;
    assert_true (r.x[0] == 1.5 && r.weight[1] == 0.5 && r.own[1] == 13 && r.cell[0] == 7);
    assert_true (bare.weight[1] == 0 && bare.own[1] == -1 && bare.cell[0] == -1);
    assert_int_equal (pg_rows_count (&r, PG_GRADE_DEAD), 2);
    check_ok (a.type->evaluate (&a, &c, &r, NULL, 2, NULL, 1));
    assert_int_equal (pg_rows_count (&r, PG_GRADE_DEAD), 0);
    assert_int_equal (pg_rows_count (&r, PG_GRADE_FULL), 2);
    pg_rows_clear (&r);
    pg_rows_clear (&r);
    pg_rows_clear (&bare);
    lattice_clear (&c);
}

static void a_list_gives_the_bits_of_the_whole (void **state)
{
    (void) state;
    for (int t = 0; t < 3; t++) {
        pg_cloud c = lattice (2, 9, 1e-3, 0.2);
        pg_approx a = make (type[t], "cubic_spline", 2, PG_RADIAL, 3.1e-3);
        pg_rows all = rows_at_nodes (&a, &c), part = rows_at_nodes (&a, &c);
        unsigned char *alive = random_alive (&all);
        size_t list[27];
        for (size_t k = 0; k < 27; k++) {
            list[k] = 80 - 3 * k;
            for (size_t i = list[k] - 2; i < list[k]; i++)  /* the other rows keep all their bonds */
                for (size_t e = all.family.start[i]; e < all.family.start[i + 1]; e++) alive[e] = 1;
        }
        check_ok (a.type->evaluate (&a, &c, &all, alive, all.n, NULL, 1));
        check_ok (a.type->evaluate (&a, &c, &part, alive, 27, list, 1));
        check_same (&all, &part);
        pg_free (alive);
        pg_rows_clear (&all);
        pg_rows_clear (&part);
        lattice_clear (&c);
    }
}

static void what_is_left_out_changes_no_bit (void **state)
{
    (void) state;
    for (int t = 0; t < 3 * 2; t++) {
        pg_cloud c = lattice (2, 9, 1e-3, 0.2);
        pg_approx a = make (type[t / 2], "cubic_spline", 2, PG_RADIAL, 3.1e-3);
        pg_rows all = rows_at_nodes (&a, &c), values = rows_at_nodes (&a, &c),
                grades = rows_at_nodes (&a, &c);
        /* dead bonds: steep derivatives lower the grade */
        unsigned char *alive = t % 2 ? random_alive (&all) : NULL;
        pg_free (values.dN), values.dN = NULL;
        pg_free (grades.dN), pg_free (grades.N), pg_free (grades.w);
        grades.dN = grades.N = grades.w = NULL;
        memset (values.grade, 99, c.n);
        memset (grades.grade, 99, c.n);
        check_ok (a.type->evaluate (&a, &c, &all, alive, c.n, NULL, 1));
        check_ok (a.type->evaluate (&a, &c, &values, alive, c.n, NULL, 1));
        check_ok (a.type->evaluate (&a, &c, &grades, alive, c.n, NULL, 1));
        size_t nnz = all.family.start[c.n];
        assert_memory_equal (values.N, all.N, nnz * sizeof *all.N);
        assert_memory_equal (values.w, all.w, nnz * sizeof *all.w);
        assert_memory_equal (values.grade, all.grade, c.n);
        assert_memory_equal (grades.grade, all.grade, c.n);
        pg_free (alive);
        pg_rows_clear (&all);
        pg_rows_clear (&values);
        pg_rows_clear (&grades);
        lattice_clear (&c);
    }
}

static void threads_do_not_change_a_bit (void **state)
{
    (void) state;
    for (int t = 0; t < 3; t++) {
        pg_cloud c = lattice (3, 6, 1, 0.2);
        pg_approx a = make (type[t], "quartic_spline", 1, PG_TENSOR, 2.2);
        pg_rows one = rows_at_nodes (&a, &c), two = rows_at_nodes (&a, &c);
        unsigned char *alive = random_alive (&one);
        check_ok (a.type->evaluate (&a, &c, &one, alive, c.n, NULL, 1));
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

/* Row 0 with some bonds dead against the row in a cloud that lacks these nodes. */
static void dead_bonds_equal_missing_nodes (void **state)
{
    (void) state;
    for (int t = 0; t < 3 * 20; t++) {
        pg_cloud c = lattice (2, 7, 1, 0.2), d = lattice (2, 7, 1, 0);
        pg_approx a = make (type[t % 3], "cubic_spline", 1 + t % 2, PG_RADIAL, 3.1);
        int own = t % 4 < 2 ? 24 : -1, keep[49];
        const double *x = own >= 0 ? c.x + 48 : (const double[]) { 3.3, 2.6 };
        pg_rows r = rows_at (&a, &c, 1, x, &own);
        unsigned char *alive = pg_calloc (r.family.start[1], 1);
        d.n = 0;
        for (int j = 0; j < 49; j++) {
            keep[j] = rnd () > 0 || j == own ? (int) d.n : -1;
            size_t e = place_of (&r, 0, j);
            if (e != (size_t) -1) alive[e] = keep[j] >= 0;
            if (keep[j] < 0) continue;
            memcpy (d.x + 2 * d.n, c.x + 2 * j, 2 * sizeof *d.x);
            d.volume[d.n++] = c.volume[j];
        }
        check_ok (a.type->evaluate (&a, &c, &r, alive, 1, NULL, 1));
        int moved = own >= 0 ? keep[own] : -1;
        pg_rows s = rows_at (&a, &d, 1, x, &moved);
        assert_int_equal (r.grade[0], s.grade[0]);
        for (int j = 0; j < 49; j++)
            for (int k = 0; k < 2; k++) {
                double N = keep[j] < 0 ? 0 : N_of (&s, 0, keep[j]),
                       dN = keep[j] < 0 ? 0 : dN_of (&s, 0, keep[j], k);
                assert_true (N_of (&r, 0, j) == N && dN_of (&r, 0, j, k) == dN);
            }
        pg_free (alive);
        pg_rows_clear (&r);
        pg_rows_clear (&s);
        lattice_clear (&c);
        lattice_clear (&d);
    }
}

static void the_rows_hold_influence_times_volume (void **state)
{
    (void) state;
    for (int t = 0; t < 3; t++) {
        pg_cloud c = lattice (2, 5, 1, 0.2);
        pg_approx a = make (type[t], "quadratic", 1, PG_RADIAL, 2.2);
        pg_rows r = rows_at_nodes (&a, &c);
        unsigned char *alive = random_alive (&r);
        check_ok (a.type->evaluate (&a, &c, &r, alive, c.n, NULL, 1));
        for (size_t i = 0; i < c.n; i++)
            for (size_t e = r.family.start[i]; e < r.family.start[i + 1]; e++) {
                size_t j = (size_t) r.family.node[e];
                double q = hypot (c.x[2*j] - c.x[2*i], c.x[2*j + 1] - c.x[2*i + 1]) / 2.2;
                int counts = alive[e] && !(t == 2 && i == j);
                check_absolute (r.w[e], counts ? (1 - q * q) * c.volume[j] : 0, 1e-15);
            }
        pg_free (alive);
        pg_rows_clear (&r);
        lattice_clear (&c);
    }
}

/* ---- degenerate points ---- */
/* One point among given nodes of a plane, spacing 1 */
static pg_rows among (const char *name, int order, size_t n, double *x, const double *at, int own)
{
    double volume[16];
    for (size_t i = 0; i < n; i++) volume[i] = 1;
    const pg_cloud c = { .dim = 2, .n = n, .x = x, .volume = volume, .h = 1, .thickness = 1 };
    pg_approx a = make (name, "quadratic", order, PG_RADIAL, 4);
    return rows_at (&a, &c, 1, at, &own);
}

static void check_shepard (const pg_rows *r, const double *x, const double *at)
{
    size_t n = r->family.start[1];
    double total = 0, w[16];
    assert_int_equal (r->grade[0], PG_GRADE_SHEPARD);
    for (size_t e = 0; e < n; e++) {
        const double *y = x + 2 * r->family.node[e];
        w[e] = 1 - (pow (y[0] - at[0], 2) + pow (y[1] - at[1], 2)) / 16;
        total += w[e];
    }
    for (size_t e = 0; e < n; e++) {
        check_absolute (r->N[e], w[e] / total, 1e-15);
        check_absolute (r->dN[2*e], 0, 0);
        check_absolute (r->dN[2*e + 1], 0, 0);
    }
}

static void nodes_on_a_line_leave_a_weighted_mean (void **state)
{
    (void) state;
    double x[8] = { 0, 0, 1, 1, -1, -1, 2, 2 };
    const double at[2] = { 0, 0 }, beside[2] = { 0.2, -0.1 };
    for (int t = 0; t < 2; t++)
        for (int order = 1; order <= 2; order++) {
            pg_rows r = among (type[t], order, 4, x, at, 0), s = among (type[t], order, 4, x, beside, -1);
            check_shepard (&r, x, at);
            check_shepard (&s, x, beside);
            pg_rows_clear (&r);
            pg_rows_clear (&s);
        }
}

static void a_strip_thinner_than_the_limit_is_a_line (void **state)
{
    (void) state;
    const double at[2] = { 0, 0 }, limit = sqrt (1e-3);                /* smallest second moment: height^2 */
    for (int t = 0; t < 3; t++)
        for (int thick = 0; thick < 2; thick++) {
            double y = limit * (thick ? 1.01 : 0.99), x[8] = { 1, y, -1, y, 1, -y, -1, -y };
            pg_rows r = among (type[t], 1, 4, x, at, -1);
            assert_int_equal (r.grade[0], thick ? PG_GRADE_FULL : PG_GRADE_SHEPARD);
            pg_rows_clear (&r);
        }
}

static void two_nodes_leave_a_weighted_mean (void **state)
{
    (void) state;
    double x[4] = { 0, 0, 1, 0.3 };
    const double at[2] = { 0.4, 0.4 };
    for (int t = 0; t < 3; t++) {
        pg_rows r = among (type[t], 1, 2, x, at, -1);
        check_shepard (&r, x, at);
        pg_rows_clear (&r);
    }
}

static void nosb_at_a_degenerate_node_keeps_the_node_alone (void **state)
{
    (void) state;
    double x[8] = { 0, 0, 1, 1, -1, -1, 2, 2 };
    const double at[2] = { 0, 0 };
    for (size_t n = 1; n <= 4; n++) {
        pg_rows r = among ("nosb", 1, n, x, at, 0);
        assert_int_equal (r.grade[0], PG_GRADE_SHEPARD);
        for (size_t e = 0; e < n; e++) {
            assert_true (r.N[e] == (e == 0));
            assert_true (r.dN[2*e] == 0 && r.dN[2*e + 1] == 0);
        }
        pg_rows_clear (&r);
    }
}

static void nosb_needs_neighbours_beside_the_node_itself (void **state)
{
    (void) state;
    /* two neighbours: three points, yet no basis; three: a full one */
    double x[8] = { 0, 0, 1, 0, 0, 1, -1, -0.5 };
    const double at[2] = { 0, 0 };
    pg_rows two = among ("nosb", 1, 3, x, at, 0), three = among ("nosb", 1, 4, x, at, 0),
            pd = among ("pddo", 1, 3, x, at, 0);
    assert_int_equal (two.grade[0], PG_GRADE_SHEPARD);
    assert_int_equal (three.grade[0], PG_GRADE_FULL);
    assert_int_equal (pd.grade[0], PG_GRADE_FULL);
    pg_rows_clear (&two);
    pg_rows_clear (&three);
    pg_rows_clear (&pd);
}

static void a_point_without_live_bonds_is_dead (void **state)
{
    (void) state;
    double x[6] = { 0, 0, 1, 0, 0, 1 };
    const double at[2] = { 0.3, 0.3 };
    const unsigned char alive[3] = { 0, 0, 0 };
    for (int t = 0; t < 3; t++) {
        pg_rows r = among (type[t], 1, 3, x, at, -1);
        double volume[3] = { 1, 1, 1 };
        const pg_cloud c = { .dim = 2, .n = 3, .x = x, .volume = volume, .h = 1 };
        pg_approx a = make (type[t], "quadratic", 1, PG_RADIAL, 4);
        assert_int_equal (r.grade[0], PG_GRADE_FULL);
        check_ok (a.type->evaluate (&a, &c, &r, alive, 1, NULL, 1));
        assert_int_equal (r.grade[0], PG_GRADE_DEAD);
        for (int e = 0; e < 3; e++)
            assert_true (r.N[e] == 0 && r.w[e] == 0 && r.dN[2 * e] == 0 && r.dN[2 * e + 1] == 0);
        pg_rows_clear (&r);
    }
}

static void too_few_nodes_for_a_quadratic_give_a_linear_basis (void **state)
{
    (void) state;
    double x[12] = { 0, 0, 1, 0.1, 0, 1, -1, -0.2, 0.2, -1, 1, 1 };
    /* six nodes on two lines: xy is zero on all of them */
    double cross[12] = { 0, 0, 1, 0, 0, 1, -1, 0, 0, -1, 2, 0 };
    const double at[2] = { 0.1, 0.1 };
    for (int t = 0; t < 2; t++) {
        pg_rows five = among (type[t], 2, 5, x, at, -1), linear = among (type[t], 1, 5, x, at, -1);
        pg_rows six = among (type[t], 2, 6, x, at, -1), lines = among (type[t], 2, 6, cross, at, -1);
        assert_int_equal (five.grade[0], PG_GRADE_LOWERED);
        assert_int_equal (six.grade[0], PG_GRADE_FULL);
        assert_int_equal (lines.grade[0], PG_GRADE_LOWERED);
        assert_memory_equal (five.N, linear.N, 5 * sizeof (double));
        assert_memory_equal (five.dN, linear.dN, 10 * sizeof (double));
        pg_rows_clear (&five);
        pg_rows_clear (&linear);
        pg_rows_clear (&six);
        pg_rows_clear (&lines);
    }
}

/* A grade says what the derivatives of a point reproduce, whatever bonds have died: FULL all polynomials of
 * the basis, LOWERED those of degree one. */
static void grades_say_what_is_reproduced (void **state)
{
    (void) state;
    size_t seen[PG_GRADE_DEAD + 1] = { 0 };
    for (int t = 0; t < 60; t++) {
        pg_cloud c = lattice (2, 9, 1, t % 2 ? 0.2 : 0);
        pg_approx a = make (type[t % 2], "cubic_spline", 2, PG_RADIAL, 2.6);
        pg_rows r = rows_at_nodes (&a, &c);
        size_t nnz = r.family.start[r.n];
        unsigned char *alive = pg_calloc (nnz, 1);
        double share = 0.4 * (t / 2 % 5) - 0.6;
        for (size_t e = 0; e < nnz; e++) alive[e] = rnd () > share;
        for (size_t i = 0; i < r.n; i++)
            for (size_t e = r.family.start[i]; e < r.family.start[i + 1]; e++)
                if (r.family.node[e] == (int) i) alive[e] = 1;
        check_ok (a.type->evaluate (&a, &c, &r, alive, r.n, NULL, 1));
        for (size_t i = 0; i < r.n; i++) {
            /* by degree: dN of 1, of x and y, of products about the point */
            double worst[3] = { 0 }, steep = 0;
            seen[r.grade[i]]++;
            if (r.grade[i] > PG_GRADE_LOWERED) continue;
            for (int k = 0; k < 2; k++) {
                double sum[6] = { 0 };
                for (size_t e = r.family.start[i]; e < r.family.start[i + 1]; e++) {
                    const double *y = c.x + 2 * (size_t) r.family.node[e],
                                 z[2] = { y[0] - c.x[2 * i], y[1] - c.x[2 * i + 1] },
                                 p[6] = { 1, z[0], z[1], z[0] * z[0], z[0] * z[1], z[1] * z[1] };
                    for (int m = 0; m < 6; m++) sum[m] += r.dN[2*e + (size_t) k] * p[m];
                    steep = fmax (steep, fabs (r.dN[2*e + (size_t) k]));
                }
                for (int m = 0; m < 6; m++)
                    worst[m == 0  ? 0
                          : m < 3 ? 1
                                  : 2] = fmax (worst[m == 0  ? 0
                                                     : m < 3 ? 1
                                                             : 2],
                                               fabs (sum[m] - (m == 1 + k)));
            }
            check_below (worst[0] / fmax (1, steep), 1e-6);  /* rounding, where pivots are 1e-10: 1e-8 */
            check_below (worst[1] / fmax (1, steep), 1e-6);
            if (r.grade[i] == PG_GRADE_FULL) check_below (worst[2] / fmax (1, steep), 1e-6);
        }
        pg_free (alive);
        pg_rows_clear (&r);
        lattice_clear (&c);
    }
    assert_true (seen[PG_GRADE_FULL] > 500 && seen[PG_GRADE_LOWERED] > 100);
}

/* Wherever bonds die: never NaN, shape functions sum to 1 where any lives, gradients to 0. A quadratic basis
 * is admitted down to pivots of 1e-10, where the coefficients of p reach 1e5 and rounding 1e-11. */
static void random_deaths_keep_the_partition_of_unity (void **state)
{
    (void) state;
    size_t seen[PG_GRADE_DEAD + 1] = { 0 };
    for (int t = 0; t < 3 * 40; t++) {
        int dim = 1 + t / 3 % 3, order = 1 + t / 9 % 2;
        pg_cloud c = lattice (dim, dim == 1 ? 30 : dim == 2 ? 8 : 5, 1e-3, t % 2 ? 0.2 : 0);
        pg_approx a = make (type[t % 3], "cubic_spline", order, PG_RADIAL, 2.6e-3);
        pg_rows r = rows_at_nodes (&a, &c);
        size_t nnz = r.family.start[r.n];
        unsigned char *alive = pg_calloc (nnz, 1);
        double share = 2 * rnd (), tolerance = order == 1 ? 1e-12 : 1e-10;
        for (size_t e = 0; e < nnz; e++) alive[e] = rnd () < share;
        check_ok (a.type->evaluate (&a, &c, &r, alive, r.n, NULL, 2));
        for (size_t i = 0; i < r.n; i++) {
            double sum = 0, size = 1, slope[3] = { 0 };
            for (size_t e = r.family.start[i]; e < r.family.start[i + 1]; e++) {
                sum += r.N[e], size += fabs (r.N[e]);
                for (int k = 0; k < dim; k++) {
                    double d = 1e-3 * r.dN[e * (size_t) dim + (size_t) k];
                    slope[k] += d, size += fabs (d);
                }
                if (!alive[e] && r.family.node[e] != r.own[i]) assert_true (r.N[e] == 0 && r.w[e] == 0);
            }
            seen[r.grade[i]]++;
            check_scaled (sum, r.grade[i] != PG_GRADE_DEAD, tolerance, size);
            for (int k = 0; k < dim; k++) check_scaled (slope[k], 0, tolerance, size);
        }
        pg_free (alive);
        pg_rows_clear (&r);
        lattice_clear (&c);
    }
    /* not by default */
    for (int g = 0; g <= PG_GRADE_DEAD; g++) assert_true ((seen[g] > 0) == (g != PG_GRADE_PROJECTED));
}

/* ---- failures ---- */
static void any_allocation_may_fail (void **state)
{
    (void) state;
    pg_cloud c = lattice (2, 9, 1, 0.2);
    size_t before = pg_memory_used (), failures = 0;
    for (int t = 0; t < 3; t++) {
        pg_approx a = make (type[t], "cubic_spline", 1, PG_RADIAL, 2.2);
        pg_status status = PG_E_MEMORY;
        for (size_t k = 1; status != PG_OK; k++) {
            pg_rows r = { 0 };
            pg_memory_fail_at (k);
            status = pg_rows_create (&r, &a, &c, c.n, c.x, NULL, NULL, NULL);
            if (status == PG_OK) status = a.type->evaluate (&a, &c, &r, NULL, c.n, NULL, 2);
            pg_memory_fail_at (0);
            if (status != PG_OK) assert_int_equal (status, PG_E_MEMORY), failures++;
            pg_rows_clear (&r);
            assert_int_equal (pg_memory_used (), before);
            assert_true (k < 1000);
        }
    }
    assert_true (failures > 3 * 10);
    lattice_clear (&c);
}

static void a_node_outside_its_own_family_is_an_error_of_nosb (void **state)
{
    (void) state;
    pg_cloud c = lattice (2, 5, 1, 0);
    pg_approx a = make ("nosb", "cubic_spline", 1, PG_RADIAL, 1.5);
    const double x[2] = { 0, 0 };
    const int own = 24;
    pg_rows r;
    check_ok (pg_rows_create (&r, &a, &c, 1, x, NULL, &own, NULL));
    check_fails (a.type->evaluate (&a, &c, &r, NULL, 1, NULL, 1), PG_E_USAGE);
    check_contains (pg_last_error (), "own family");
    pg_rows_clear (&r);
    lattice_clear (&c);
}

static void an_order_beyond_two_is_an_error (void **state)
{
    (void) state;
    pg_cloud c = lattice (1, 5, 1, 0);
    pg_approx a = make ("rkpm", "cubic_spline", 3, PG_RADIAL, 2);
    pg_rows r;
    check_ok (pg_rows_create (&r, &a, &c, c.n, c.x, NULL, NULL, NULL));
    check_fails (a.type->evaluate (&a, &c, &r, NULL, c.n, NULL, 1), PG_E_USAGE);
    pg_rows_clear (&r);
    lattice_clear (&c);
}

static void no_points_are_no_error (void **state)
{
    (void) state;
    pg_cloud c = lattice (1, 5, 1, 0);
    pg_approx a = make ("rkpm", "cubic_spline", 1, PG_RADIAL, 2);
    pg_rows r;
    check_ok (pg_rows_create (&r, &a, &c, 0, NULL, NULL, NULL, NULL));
    check_ok (a.type->evaluate (&a, &c, &r, NULL, 0, NULL, 2));
    assert_int_equal (pg_rows_count (&r, PG_GRADE_FULL), 0);
    pg_rows_clear (&r);
    lattice_clear (&c);
}

/* Infinite or no number at all: neither is a bond that is missing. */
static void weights_that_are_not_finite_are_an_error (void **state)
{
    (void) state;
    static const double bad[] = { NAN, INFINITY, -INFINITY };
    for (int k = 0; k < 3; k++)
        for (int shape = PG_RADIAL; shape <= PG_TENSOR; shape++) {
            pg_cloud c = lattice (2, 5, 1, 0);
            pg_approx a = make ("rkpm", "cubic_spline", 1, shape, 2);
            pg_rows r;
            double at[2] = { 2.3, 2.4 };
            a.use_volume = 1;
            c.volume[12] = bad[k];
            check_ok (pg_rows_create (&r, &a, &c, 1, at, NULL, NULL, NULL));
            check_fails (a.type->evaluate (&a, &c, &r, NULL, 1, NULL, 1), PG_E_USAGE);
            check_contains (pg_last_error (), "at (2.3, 2.4, 0) m are not finite");
            pg_rows_clear (&r);
            lattice_clear (&c);
        }
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (the_catalogue_lists_three),
        cmocka_unit_test (creation_copies_points_and_leaves_them_dead),
        cmocka_unit_test (a_list_gives_the_bits_of_the_whole),
        cmocka_unit_test (what_is_left_out_changes_no_bit),
        cmocka_unit_test (threads_do_not_change_a_bit),
        cmocka_unit_test (dead_bonds_equal_missing_nodes),
        cmocka_unit_test (the_rows_hold_influence_times_volume),
        cmocka_unit_test (nodes_on_a_line_leave_a_weighted_mean),
        cmocka_unit_test (a_strip_thinner_than_the_limit_is_a_line),
        cmocka_unit_test (two_nodes_leave_a_weighted_mean),
        cmocka_unit_test (nosb_at_a_degenerate_node_keeps_the_node_alone),
        cmocka_unit_test (nosb_needs_neighbours_beside_the_node_itself),
        cmocka_unit_test (a_point_without_live_bonds_is_dead),
        cmocka_unit_test (too_few_nodes_for_a_quadratic_give_a_linear_basis),
        cmocka_unit_test (random_deaths_keep_the_partition_of_unity),
        cmocka_unit_test (any_allocation_may_fail),
        cmocka_unit_test (a_node_outside_its_own_family_is_an_error_of_nosb),
        cmocka_unit_test (an_order_beyond_two_is_an_error),
        cmocka_unit_test (no_points_are_no_error),
        cmocka_unit_test (weights_that_are_not_finite_are_an_error),
        cmocka_unit_test (grades_say_what_is_reproduced),  /* last: the others keep their random numbers */
    };
    return cmocka_run_group_tests_name ("discretization/approx/rows", tests, NULL, NULL);
}

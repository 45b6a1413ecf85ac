/* SPDX-License-Identifier: GPL-3.0-or-later
 * Which bonds a crack cuts, against exact integer geometry: bonds and cracks with whole coordinates (u, v,
 * w), w = 0 the crack's plane, mapped to a tilted plane in space. */
#include "check.h"
#include "perigal/cloud.h"
#include <math.h>
#include <string.h>

typedef struct { long u, v, w; } whole;

static uint32_t seed = 1;
static long pick (long n)
{
    seed = seed * 1664525u + 1013904223u;
    return (long) ((seed >> 8) % (uint32_t) (2 * n + 1)) - n;
}
static double real (void) { seed = seed * 1664525u + 1013904223u; return (seed >> 8) / 8388608.0 - 1; }

/* ---- exact planar geometry, closed sets ---------------------------------------------------------------- */
static long turn (whole a, whole b, whole c)
{
    long s = (b.u - a.u) * (c.v - a.v) - (b.v - a.v) * (c.u - a.u);
    return (s > 0) - (s < 0);
}

static int between (long a, long b, long c) { return (a <= c && c <= b) || (b <= c && c <= a); }
static int on (whole a, whole b, whole c)
{
    return !turn (a, b, c) && between (a.u, b.u, c.u) && between (a.v, b.v, c.v);
}

static int meet (whole a, whole b, whole c, whole d)
{
    if (turn (a, b, c) * turn (a, b, d) < 0 && turn (c, d, a) * turn (c, d, b) < 0) return 1;
    return on (a, b, c) || on (a, b, d) || on (c, d, a) || on (c, d, b);
}

/* Inside or on the outline: winding number by quadrant-free ray, exact. */
static int within (int n, const whole *p, whole x)
{
    int wind = 0;
    for (int i = 0; i < n; i++) {
        whole a = p[i], b = p[(i + 1) % n];
        if (on (a, b, x)) return 1;
        if (a.v <= x.v && b.v > x.v && turn (a, b, x) > 0) wind++;
        if (a.v > x.v && b.v <= x.v && turn (a, b, x) < 0) wind--;
    }
    return wind != 0;
}

/* Where the bond x y pierces w = 0, times the denominator. */
static long pierce (whole x, whole y, whole *at)
{
    long m = y.w - x.w;
    *at = (whole) {x.u * m - x.w * (y.u - x.u), x.v * m - x.w * (y.v - x.v), 0};
    return m;
}

static int polygon_meets (int n, const whole *p, whole x, whole y)
{
    whole q[8], at;
    if (x.w * y.w > 0) return 0;
    if (x.w == 0 && y.w == 0) {
        if (within (n, p, x) || within (n, p, y)) return 1;
        for (int i = 0; i < n; i++) if (meet (x, y, p[i], p[(i + 1) % n])) return 1;
        return 0;
    }
    long m = pierce (x, y, &at);
    for (int i = 0; i < n; i++) q[i] = (whole) {p[i].u * m, p[i].v * m, 0};
    return within (n, q, at);
}

static int disc_meets (long radius, whole x, whole y)
{
    whole at;
    if (x.w * y.w > 0) return 0;
    if (x.w != y.w) {
        long m = pierce (x, y, &at);
        return at.u * at.u + at.v * at.v <= radius * radius * m * m;
    }
    long du = y.u - x.u, dv = y.v - x.v, l = du*du + dv*dv, s = -(x.u*du + x.v*dv), c = x.u*dv - x.v*du;
    if (s <= 0 || l == 0) return x.u*x.u + x.v*x.v <= radius*radius;
    if (s >= l) return y.u*y.u + y.v*y.v <= radius*radius;
    return c*c <= radius*radius*l;
}

/* ---- into space ---------------------------------------------------------------------------------------- */
static void to_space (whole a, double *x)              /* orthonormal (2 1 -2)/3, (2 -2 1)/3, (1 2 2)/3 */
{
    double u = (double) a.u / 3, v = (double) a.v / 3, w = (double) a.w / 3;
    x[0] = 0.7 + 2*u + 2*v + w, x[1] = -0.3 + u - 2*v + 2*w, x[2] = 0.1 - 2*u + v + 2*w;
}

static void compare (const pg_crack *c, int dim, const double *x, const double *y, int expected)
{
    assert_int_equal (pg_crack_cuts (c, dim, x, y, 1e-9), expected);
    assert_int_equal (pg_crack_cuts (c, dim, y, x, 1e-9), expected);
}

static void segment (pg_crack *c, double *vertex)
{
    double t[2] = {vertex[2] - vertex[0], vertex[3] - vertex[1]}, l = hypot (t[0], t[1]);
    *c = (pg_crack){
        .kind = PG_CRACK_SEGMENT, .vertex = vertex, .nvertex = 2, .normal = { -t[1] / l, t[0] / l, 0 }
    };
}

static void bonds_and_segments_agree_with_integers (void **state)
{
    (void) state;
    int cut = 0;
    for (int k = 0; k < 200000; k++) {
        whole p = { pick (4), pick (4), 0 }, q = { pick (4), pick (4), 0 }, a = { pick (4), pick (4), 0 },
              b = { pick (4), pick (4), 0 };
        if (p.u == q.u && p.v == q.v) continue;
        double v[4] = { (double) p.u, (double) p.v, (double) q.u, (double) q.v },
               x[2] = { (double) a.u, (double) a.v }, y[2] = { (double) b.u, (double) b.v };
        pg_crack c;
        segment (&c, v);
        compare (&c, 2, x, y, meet (p, q, a, b));
        cut += meet (p, q, a, b);
    }
    assert_true (cut > 20000);
}

static void polygon_agrees (int n, const whole *p)
{
    double v[24], x[3], y[3];
    int cut = 0;
    for (int i = 0; i < n; i++) to_space (p[i], v + 3*i);
    pg_crack c = {
        .kind = PG_CRACK_POLYGON, .vertex = v, .nvertex = (size_t) n, .normal = { 1.0 / 3, 2.0 / 3, 2.0 / 3 }
    };
    for (int k = 0; k < 100000; k++) {
        whole a = {pick (6), pick (6), pick (2)}, b = {pick (6), pick (6), pick (2)};
        to_space (a, x), to_space (b, y);
        compare (&c, 3, x, y, polygon_meets (n, p, a, b));
        assert_int_equal (pg_crack_touches (&c, 3, x, 1e-9), a.w == 0 && within (n, p, a));
        cut += polygon_meets (n, p, a, b);
    }
    assert_true (cut > 5000 && cut < 60000);
}

static void bonds_and_a_convex_polygon_agree_with_integers (void **state)
{
    (void) state;
    polygon_agrees (4, (whole[]) {{-3, -2, 0}, {4, -3, 0}, {5, 2, 0}, {-1, 4, 0}});
}

static void bonds_and_a_concave_polygon_agree_with_integers (void **state)
{
    (void) state;
    polygon_agrees (6, (whole[]) {{-4, -4, 0}, {5, -4, 0}, {5, 5, 0}, {3, 5, 0}, {3, -2, 0}, {-4, -2, 0}});
    polygon_agrees (5, (whole[]) {{0, 5, 0}, {-5, -5, 0}, {0, 0, 0}, {5, -5, 0}, {2, 3, 0}});
}

static void bonds_and_a_disc_agree_with_integers (void **state)
{
    (void) state;
    double x[3], y[3];
    int cut = 0;
    pg_crack c = {.kind = PG_CRACK_DISC, .normal = {1.0/3, 2.0/3, 2.0/3}, .radius = 5};
    to_space ((whole) {0, 0, 0}, c.centre);
    for (int k = 0; k < 200000; k++) {
        whole a = {pick (7), pick (7), pick (2)}, b = {pick (7), pick (7), pick (2)};
        to_space (a, x), to_space (b, y);
        compare (&c, 3, x, y, disc_meets (5, a, b));
        assert_int_equal (pg_crack_touches (&c, 3, x, 1e-9), a.w == 0 && a.u*a.u + a.v*a.v <= 25);
        cut += disc_meets (5, a, b);
    }
    assert_true (cut > 5000);
}

static void swapping_the_ends_never_changes_the_answer (void **state)
{
    (void) state;
    double v[4] = {-0.3, -0.2, 0.4, 0.35}, near = 0;
    pg_crack c;
    segment (&c, v);
    for (int k = 0; k < 200000; k++) {                         /* ends about one tolerance off the line */
        double s = 0.8 * real (), t = 0.8 * real (), d = 2e-9 * real (),
               e = k % 2 ? 2e-9 * real () : 0.5 * real ();
        double x[2] = { 0.05 + s * 0.7 + d * c.normal[0], 0.075 + s * 0.55 + d * c.normal[1] },
               y[2] = { 0.05 + t * 0.7 + e * c.normal[0], 0.075 + t * 0.55 + e * c.normal[1] };
        assert_int_equal (pg_crack_cuts (&c, 2, x, y, 1e-9), pg_crack_cuts (&c, 2, y, x, 1e-9));
        near += pg_crack_cuts (&c, 2, x, y, 1e-9);
    }
    assert_true (near > 1000 && near < 199000);
    near = 0;
    for (int k = 0; k < 200000; k++) {  /* past the tip at exactly the tolerance: rounding decides */
        double a = 0.3 + 0.2 * real (), b = 0.4 + 0.1 * real (), m = real (), tip[2] = { 0.4, 0.35 }, x[2],
               y[2];
        for (int i = 0; i < 2; i++) {
            double t = i ? -c.normal[0] : c.normal[1], corner = tip[i] + 0.01 * t + 0.01 * c.normal[i],
                   along = m * t + c.normal[i] * (1 - fabs (m));
            x[i] = corner - a * along, y[i] = corner + b * along;
        }
        assert_int_equal (pg_crack_cuts (&c, 2, x, y, 0.01), pg_crack_cuts (&c, 2, y, x, 0.01));
        near += pg_crack_cuts (&c, 2, x, y, 0.01);
    }
    assert_true (near > 1000 && near < 199000);
}

static void a_point_on_the_crack_loses_both_sides (void **state)
{
    (void) state;
    double v[4] = {-10.6e-3, -10.6e-3, 10.6e-3, 10.6e-3};  /* the 45 degree crack of the disk, 2 mm lattice */
    int on_crack = 0;
    pg_crack c;
    segment (&c, v);
    for (int i = -8; i <= 8; i++) {
        double x[2] = {0.002 * i, 0.002 * i};
        int touches = pg_crack_touches (&c, 2, x, 2e-12);
        assert_int_equal (touches, i >= -5 && i <= 5);
        on_crack += touches;
        for (int k = 0; k < 4 && touches; k++) {
            double y[2] = {x[0] + (k % 2 ? 0.002 : -0.002), x[1] + (k / 2 ? 0.002 : -0.002)};
            assert_true (pg_crack_cuts (&c, 2, x, y, 2e-12));
        }
    }
    assert_int_equal (on_crack, 11);
}

static void mirrored_and_turned_bonds_and_cracks_agree (void **state)
{
    (void) state;
    double v[4] = {-10.6e-3, -10.6e-3, 10.6e-3, 10.6e-3};
    pg_crack c;
    segment (&c, v);
    for (int j = -8; j <= 8; j++)
        for (int i = -8; i <= 8; i++)
            for (int q = -3; q <= 3; q++)
                for (int p = -3; p <= 3; p++) {
                    double x[2] = { 0.002 * i, 0.002 * j }, y[2] = { 0.002 * (i + p), 0.002 * (j + q) };
                    int cut = pg_crack_cuts (&c, 2, x, y, 2e-12);
                    double mx[2] = { x[1], x[0] }, my[2] = { y[1], y[0] }, tx[2] = { -x[0], -x[1] },
                           ty[2] = { -y[0], -y[1] };
                    assert_int_equal (pg_crack_cuts (&c, 2, mx, my, 2e-12), cut);
                    assert_int_equal (pg_crack_cuts (&c, 2, tx, ty, 2e-12), cut);
                }
}

static void a_bond_that_ends_just_before_the_crack_lives (void **state)
{
    (void) state;
    double v[4] = {-1, 0, 1, 0};
    pg_crack c;
    segment (&c, v);
    assert_true (pg_crack_cuts (&c, 2, (double[]) {0, 1}, (double[]) {0, 0.9e-9}, 1e-9));
    assert_false (pg_crack_cuts (&c, 2, (double[]) {0, 1}, (double[]) {0, 1.1e-9}, 1e-9));
    assert_true (pg_crack_cuts (&c, 2, (double[]) {1 + 0.9e-9, 1}, (double[]) {1 + 0.9e-9, -1}, 1e-9));
    assert_false (pg_crack_cuts (&c, 2, (double[]) {1 + 1.1e-9, 1}, (double[]) {1 + 1.1e-9, -1}, 1e-9));
}

/* ---- sided segments ------------------------------------------------------------------------------------ */
/* On the left is what the line passes on its left or through; a bond between the sides is cut where it leaves
 * the left one, if that is within the segment. */
static int sided_meets (whole p, whole q, whole a, whole b)
{
    long tu = q.u - p.u, tv = q.v - p.v, d = tu * (a.v - p.v) - tv * (a.u - p.u),
         e = tu * (b.v - p.v) - tv * (b.u - p.u), i = tu * (a.u - p.u) + tv * (a.v - p.v),
         j = tu * (b.u - p.u) + tv * (b.v - p.v);
    if ((d >= 0) == (e >= 0)) return 0;
    long at = i * -e + j * d, m = d - e;                 /* along the line, times m */
    if (m < 0) at = -at, m = -m;
    return at >= 0 && at <= (tu * tu + tv * tv) * m;
}

static void sided_segments_agree_with_integers (void **state)
{
    (void) state;
    int cut = 0, unlike = 0;
    for (int k = 0; k < 200000; k++) {
        whole p = { pick (4), pick (4), 0 }, q = { pick (4), pick (4), 0 }, a = { pick (4), pick (4), 0 },
              b = { pick (4), pick (4), 0 };
        if (p.u == q.u && p.v == q.v) continue;
        double v[4] = { (double) p.u, (double) p.v, (double) q.u, (double) q.v },
               x[2] = { (double) a.u, (double) a.v }, y[2] = { (double) b.u, (double) b.v };
        pg_crack c;
        segment (&c, v);
        c.sided = 1, c.width = 1e-6;
        compare (&c, 2, x, y, sided_meets (p, q, a, b));
        /* whichever side it counts to, it lies on the crack */
        assert_int_equal (pg_crack_touches (&c, 2, x, 1e-9), on (p, q, a));
        cut += sided_meets (p, q, a, b), unlike += sided_meets (p, q, a, b) != meet (p, q, a, b);
        pg_crack again = c;
        pg_crack_orient (&again);
        assert_true (again.normal[0] == c.normal[0] && again.normal[1] == c.normal[1]);
    }
    assert_true (cut > 10000 && unlike > 2000);
}

static void the_width_of_a_sided_segment_is_its_left (void **state)
{
    (void) state;
    double v[] = {-1, 0, 1, 0}, over[] = {0, -0.5};
    pg_crack c;
    segment (&c, v);
    c.sided = 1, c.width = 1e-6;
    compare (&c, 2, (double[]) {0, -0.9e-6}, (double[]) {0, 1}, 0);
    compare (&c, 2, (double[]) {0, -0.9e-6}, (double[]) {0, -1}, 1);
    compare (&c, 2, (double[]) {0, -1.1e-6}, (double[]) {0, 1}, 1);
    compare (&c, 2, (double[]) {0, -1.1e-6}, (double[]) {0, -1}, 0);
    compare (&c, 2, (double[]) {1.3, -1}, (double[]) {1.3, 1}, 0);
    c.retreat = over;                                    /* so far beyond its second end */
    compare (&c, 2, (double[]) {1.3, -1}, (double[]) {1.3, 1}, 1);
    compare (&c, 2, (double[]) {1.6, -1}, (double[]) {1.6, 1}, 0);
}

/* Boxes only save time: with them and without the first crack that is cut is the same. */
static void boxes_change_no_answer (void **state)
{
    (void) state;
    enum { MANY = 61 };
    double v[4 * MANY], over[2 * MANY];
    pg_crack c[MANY];
    size_t found = 0;
    for (size_t k = 0; k < MANY; k++) {
        for (int i = 0; i < 4; i++) v[4*k + (size_t) i] = 5 * real ();
        v[4*k + 2] = v[4*k] + 0.3 * real (), v[4*k + 3] = v[4*k + 1] + 0.3 * real ();
        segment (&c[k], v + 4*k);
        over[2*k] = 0.2 * real (), over[2*k + 1] = 0.2 * real ();
        c[k].sided = k % 2, c[k].retreat = over + 2*k;
    }
    pg_cracks plain = { .dim = 2, .crack = c, .n = MANY }, boxed = plain;
    check_ok (pg_cracks_index (&boxed));
    for (int k = 0; k < 100000; k++) {
        double x[2] = { 5 * real (), 5 * real () }, y[2] = { x[0] + real (), x[1] + real () };
        const pg_crack *first = pg_cracks_cut (&plain, x, y, 1e-9);
        assert_ptr_equal (pg_cracks_cut (&boxed, x, y, 1e-9), first);
        assert_ptr_equal (pg_cracks_touch (&boxed, x, 1e-2), pg_cracks_touch (&plain, x, 1e-2));
        found += first != NULL;
    }
    assert_true (found > 1000);
    pg_free (boxed.box), pg_free (boxed.block), pg_free (boxed.order);
}

/* Cracks in space: triangles on a wavy sheet, in the order of its rows, and discs anywhere; few and many. */
static void boxes_change_no_answer_in_space (void **state)
{
    (void) state;
    enum { MOST = 700 };
    static double v[9 * MOST];
    static pg_crack c[MOST];
    const size_t many[] = { 1, 2, 8, 9, 64, 65, 513, MOST };
    for (size_t m = 0; m < sizeof many / sizeof *many; m++) {
        size_t n = many[m], found = 0, missed = 0;
        memset (c, 0, sizeof c);
        for (size_t k = 0; k < n; k++) {
            double low[2] = { -5 + 0.4 * (double) (k % 25), -5 + 0.4 * (double) (k / 25) };
            for (int i = 0; i < 3; i++) {
                double *x = v + 9*k + 3*i;
                x[0] = low[0] + (i == 1 ? 0.5 : 0), x[1] = low[1] + (i == 2 ? 0.5 : 0);
                x[2] = sin (x[0]) + 0.3 * cos (2 * x[1]);
            }
            double *p = v + 9*k, u[3], w[3], N[3];
            for (int i = 0; i < 3; i++) u[i] = p[3 + i] - p[i], w[i] = p[6 + i] - p[i];
            for (int i = 0; i < 3; i++)
                N[i] = u[(i + 1) % 3] * w[(i + 2) % 3] - u[(i + 2) % 3] * w[(i + 1) % 3];
            double size = sqrt (N[0] * N[0] + N[1] * N[1] + N[2] * N[2]);
            c[k].kind = k % 5 == 4 ? PG_CRACK_DISC : PG_CRACK_POLYGON;
            c[k].vertex = p, c[k].nvertex = 3, c[k].radius = k % 5 == 4 ? 0.6 : 0;
            for (int i = 0; i < 3; i++) c[k].normal[i] = N[i] / size, c[k].centre[i] = p[i];
        }
        pg_cracks plain = { .dim = 3, .crack = c, .n = n }, boxed = plain;
        check_ok (pg_cracks_index (&boxed));
        for (int k = 0; k < 20000; k++) {
            double x[3] = { 5 * real (), 5 * real (), 1.5 * real () }, low[3], high[3];
            double y[3] = { x[0] + real (), x[1] + real (), x[2] + real () };
            const pg_crack *first = pg_cracks_cut (&plain, x, y, 1e-9);
            assert_ptr_equal (pg_cracks_cut (&boxed, x, y, 1e-9), first);
            assert_ptr_equal (pg_cracks_touch (&boxed, x, 1e-2), pg_cracks_touch (&plain, x, 1e-2));
            for (int i = 0; i < 3; i++) low[i] = fmin (x[i], y[i]), high[i] = fmax (x[i], y[i]);
            int near = pg_cracks_near (&boxed, low, high);
            assert_true (near || !first);
            found += first != NULL, missed += !near;
        }
        assert_true (missed > 100 && found > (n < 9 ? 0 : 20));
        pg_free (boxed.box), pg_free (boxed.block), pg_free (boxed.order);
    }
}

/* A square less the strips along its four edges: exactly the places further from all of them than these. */
static void strips_along_all_edges (void **state)
{
    (void) state;
    double vertex[12] = { 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0 }, retreat[4] = { 0.1, 0.2, 0.1, 0.05 };
    pg_crack c = { .kind = PG_CRACK_POLYGON, .vertex = vertex, .nvertex = 4, .normal = { 0, 0, 1 },
                   .retreat = retreat };
    for (int i = 0; i < 40; i++)
        for (int j = 0; j < 40; j++) {
            double x = 0.0133 + i * 0.025, y = 0.0133 + j * 0.025, a[3] = { x, y, -1 }, b[3] = { x, y, 1 };
            assert_int_equal (pg_crack_cuts (&c, 3, a, b, 1e-9), x > 0.05 && x < 0.8 && y > 0.1 && y < 0.9);
        }
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (strips_along_all_edges),
        cmocka_unit_test (bonds_and_segments_agree_with_integers),
        cmocka_unit_test (bonds_and_a_convex_polygon_agree_with_integers),
        cmocka_unit_test (bonds_and_a_concave_polygon_agree_with_integers),
        cmocka_unit_test (bonds_and_a_disc_agree_with_integers),
        cmocka_unit_test (swapping_the_ends_never_changes_the_answer),
        cmocka_unit_test (a_point_on_the_crack_loses_both_sides),
        cmocka_unit_test (mirrored_and_turned_bonds_and_cracks_agree),
        cmocka_unit_test (a_bond_that_ends_just_before_the_crack_lives),
        cmocka_unit_test (sided_segments_agree_with_integers),
        cmocka_unit_test (the_width_of_a_sided_segment_is_its_left),
        cmocka_unit_test (boxes_change_no_answer),
        cmocka_unit_test (boxes_change_no_answer_in_space),
    };
    return cmocka_run_group_tests_name ("geometry/cloud/crack", tests, NULL, NULL);
}

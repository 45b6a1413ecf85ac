/* SPDX-License-Identifier: GPL-3.0-or-later
 * The integrals along fronts, fed with exact fields instead of those of a discretisation: straight fronts
 * with all modes and a stress T, and penny-shaped cracks, whose fields know of the curvature. They must give
 * back K_I, K_II, K_III, T and J for any place, direction and unit of length. */
#include "check.h"
#include "penny.h"
#include "perigal/fracture.h"
#include <stdlib.h>

static const double pi = 3.14159265358979323846;

/* What the stand-in for a force shows: fields in axes (rows: e or x, n or y ...) about an origin. */
typedef struct {
    double E, nu, origin[3], axes[9];
    penny crack;                                       /* radius > 0; else a straight front along axis 3 */
    double K[2][3], T, along;                          /* of the straight front; strain along it */
    double b[3];                                       /* body force in those axes, N/m^3 */
} exact;

static void straight_gradient (const exact *m, int at, const double *y, double *G)
{
    double mu = m->E / (2 * (1 + m->nu)), r = hypot (y[0], y[1]), theta = atan2 (y[1], y[0]);
    double plane = (1 - m->nu * m->nu) / m->E, H[4];
    memset (G, 0, 9 * sizeof *G);
    for (int k = 0; k < 2; k++) {
        pg_tip_near_field (k, mu, 3 - 4 * m->nu, r, theta, NULL, H, NULL);
        G[0] += m->K[at][k] * H[0], G[1] += m->K[at][k] * H[1];
        G[3] += m->K[at][k] * H[2], G[4] += m->K[at][k] * H[3];
    }
    G[6] = -m->K[at][2] * sin (theta / 2) / (mu * sqrt (2 * pi * r));
    G[7] = m->K[at][2] * cos (theta / 2) / (mu * sqrt (2 * pi * r));
    if (at) return;
    /* stresses -b_1 y_1 along e, -b_2 y_2 along n, -b_3 y_1 in e and t, which leave the faces free */
    double across = m->nu * (1 + m->nu) / m->E;
    G[0] += across * m->b[1] * y[1] - plane * m->b[0] * y[0];
    G[1] += across * (m->b[1] * y[0] - m->b[0] * y[1]);
    G[3] += across * (m->b[0] * y[1] - m->b[1] * y[0]);
    G[4] += across * m->b[0] * y[0] - plane * m->b[1] * y[1];
    G[6] -= m->b[2] / mu * y[0];
    G[0] += plane * m->T - m->nu * m->along, G[8] += m->along;
    G[4] -= m->nu * (1 + m->nu) / m->E * m->T + m->nu * m->along;
}

/* axes' G axes. */
static void turn_back (const double *axes, const double *G, double *out)
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            out[3*i + j] = 0;
            for (int k = 0; k < 3; k++)
                for (int l = 0; l < 3; l++) out[3*i + j] += axes[3*k + i] * G[3*k + l] * axes[3*l + j];
        }
}

static pg_status sample (void *self, const pg_state *state, const double *d, size_t n, const double *x,
                         double *u, double *stress, double *gradient)
{
    const exact *m = self;
    double mu = m->E / (2 * (1 + m->nu)), lambda = 2 * mu * m->nu / (1 - 2 * m->nu);
    (void) state;
    for (size_t k = 0; k < n; k++) {
        double y[3] = { 0 }, G[9], H[9];
        for (int i = 0; i < 3; i++)
            for (size_t c = 0; c < 3; c++) y[i] += m->axes[3 * (size_t) i + c] * (x[3*k + c] - m->origin[c]);
        if (m->crack.a > 0) penny_free_gradient (&m->crack, y, G);
        else straight_gradient (m, d[0] != 0, y, G);        /* the second field's first number is 1 */
        turn_back (m->axes, G, H);
        double trace = lambda * (H[0] + H[4] + H[8]);
        memset (u + 3*k, 0, 3 * sizeof *u);
        if (gradient) memcpy (gradient + 9*k, H, sizeof H);
        if (!stress) continue;
        double s[6] = { trace + 2 * mu * H[0], trace + 2 * mu * H[4], trace + 2 * mu * H[8],
                        mu * (H[1] + H[3]), mu * (H[5] + H[7]), mu * (H[2] + H[6]) };
        memcpy (stress + 6*k, s, sizeof s);
    }
    return PG_OK;
}

typedef struct { pg_scene *scene; pg_problem *problem; pg_state *state; pg_force_type force; } tested;

/* Component of the body force along a coordinate axis. */
static double along_axis (const exact *m, int k)
{
    return m->b[0] * m->axes[k] + m->b[1] * m->axes[3 + k] + m->b[2] * m->axes[6 + k];
}

/* A cube of half width 1 unit, 20 spacings across it. */
static tested make (const exact *m, double unit, const char *cracks)
{
    tested t = { 0 };
    char text[2000];
    snprintf (text, sizeof text,
              "dimension: 3\nbody: [{add: {box: {low: [%.17g, %.17g, %.17g], high: [%.17g, %.17g, "
              "%.17g]}}}]\nlattice: cells\nspacing: %.17g\n"
              "materials: {a: {youngs_modulus: %g, poissons_ratio: %g}}\n"
              "method: {gauss_points: 1, horizon: 1.3 spacing}\ncracks: [%s]\n"
              "boundary: [{set: bottom, displacement: {x: 0, y: 0, z: 0}}, {set: all, body_force: "
              "{x: %.17g, y: %.17g, z: %.17g}}]\n",
              -unit, -unit, -unit, unit, unit, unit, unit / 10, m->E, m->nu, cracks, along_axis (m, 0),
              along_axis (m, 1), along_axis (m, 2));
    check_ok (pg_scene_parse (&t.scene, text, "test.yaml"));
    check_ok (pg_problem_build (&t.problem, t.scene, 1));
    check_ok (pg_state_create (&t.state, t.problem, 3));
    t.force = *pg_force_of (t.problem);
    t.force.sample = sample;
    return t;
}

static void clear (tested *t)
{
    pg_state_free (&t->state);
    pg_problem_free (&t->problem);
    pg_scene_free (&t->scene);
}

/* Unit vectors: a normal, one in the plane, and the third; rows x, y, z = normal. */
static void axes_about (const double *normal, double *axes)
{
    double *x = axes, *y = axes + 3, *z = axes + 6, size = 0;
    int least = fabs (normal[0]) < 0.5 ? 0 : 1;
    memcpy (z, normal, 3 * sizeof *z);
    for (int k = 0; k < 3; k++) x[k] = (k == least) - z[least] * z[k], size = hypot (size, x[k]);
    for (int k = 0; k < 3; k++) x[k] /= size;
    for (int k = 0; k < 3; k++) y[k] = z[(k + 1) % 3] * x[(k + 2) % 3] - z[(k + 2) % 3] * x[(k + 1) % 3];
}

static double dot (const double *a, const double *b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/* Largest errors along the front of a penny-shaped crack, of the largest K. */
typedef struct { double K[3], wide[3], J, mean_J, T[2]; } errors;
static errors of_penny (exact *m, double unit, const double *normal, double radius)
{
    char crack[300];
    m->crack.a = radius, m->crack.mu = m->E / (2 * (1 + m->nu)), m->crack.nu = m->nu;
    for (int k = 0; k < 3; k++) m->origin[k] = 0.03 * (k + 1) * unit;
    snprintf (crack, sizeof crack,
              "{disc: {center: [%.17g, %.17g, %.17g], normal: [%.17g, %.17g, %.17g], radius: %.17g}}",
              m->origin[0], m->origin[1], m->origin[2], normal[0], normal[1], normal[2], radius);
    tested t = make (m, unit, crack);
    size_t n = t.problem->crack.front[0].n;
    axes_about (t.problem->crack.front[0].normal, m->axes);
    pg_tip_field *f = calloc (n, sizeof *f);
    const double *d = t.state->d, one = 1;
    errors out = { 0 };
    check_ok (pg_front_measure (f, t.problem, &t.force, m, t.state, 0, 1, &d, &one, NULL));
    double largest = 0, length = 0, E = m->E / (1 - m->nu * m->nu);
    for (int pass = 0; pass < 2; pass++)
        for (size_t i = 0; i < n; i++) {
            double r[3], K[3];
            for (int k = 0; k < 3; k++) r[k] = f[i].x[k] - m->origin[k];
            penny_intensities (&m->crack, atan2 (dot (r, m->axes + 3), dot (r, m->axes)), K);
            double J = (K[0]*K[0] + K[1]*K[1]) / E + K[2]*K[2] * (1 + m->nu) / m->E;
            if (pass == 0) {
                largest = fmax (largest, J), length += f[i].length;
                check_relative (dot (r, f[i].e), radius, 1e-4);
                check_relative (dot (f[i].normal, m->axes + 6), 1, 1e-9);
                assert_int_equal (f[i].extrapolated, 0);
                continue;
            }
            double size = sqrt (largest * E);
            out.J = fmax (out.J, fabs (f[i].J[0][0] - J) / largest);
            out.mean_J += (f[i].J[0][0] - J) / largest / (double) n;
            out.T[0] = fmin (out.T[0], f[i].T[0]), out.T[1] = fmax (i ? out.T[1] : -INFINITY, f[i].T[0]);
            for (int k = 0; k < 3; k++) {
                out.K[k] = fmax (out.K[k], fabs (f[i].K[k][0] - K[k]) / size);
                out.wide[k] = fmax (out.wide[k], fabs (f[i].K_wide[k][0] - K[k]) / size);
            }
        }
    check_relative (length, 2 * pi * radius, 1e-3);
    print_message (
        "a/h %.1f p %g tau %g: J %.4f (mean %+.4f)  K_I %.4f %.4f  K_II %.4f %.4f  K_III %.4f %.4f  T %g "
            "%g\n",
        radius / unit * 10, m->crack.p, m->crack.tau, out.J, out.mean_J, out.K[0], out.wide[0], out.K[1],
        out.wide[1], out.K[2], out.wide[2], out.T[0], out.T[1]);
    free (f);
    clear (&t);
    return out;
}

static void pennies_come_back (void **state)
{
    (void) state;
    static const double normal[3][3] = { { 0, 0, 1 }, { 0, 0.6, 0.8 }, { -0.48, 0.6, 0.64 } };
    for (int k = 0; k < 3; k++) {
        double unit = pow (1000, k - 1), radius = 0.5 * unit;
        exact m = { .E = 3e9, .nu = k == 1 ? 0.2 : 0.3 };
        m.crack.p = 1e6;
        errors e = of_penny (&m, unit, normal[k], radius);
        check_below (e.J, 0.0015); check_below (e.K[0], 1e-3); check_below (e.wide[0], 1e-3);
        check_below (e.K[1], 1e-4); check_below (e.K[2], 1e-4);
        /* T = -(1/2 + nu) p; a part of the strain along the front is that of K on a front with a radius */
        for (int end = 0; end < 2; end++) check_relative (e.T[end], -(0.5 + m.nu) * 1e6, 0.06);
        /* K_II and K_III go as the cosine around the front, of which the hat and the smoothing leave 0.960 */
        m.crack.p = 0, m.crack.tau = 1e6;
        e = of_penny (&m, unit, normal[k], radius);
        check_below (e.J, 0.02); check_below (e.K[1], 0.042); check_below (e.K[2], 0.042);
        check_below (fabs (e.mean_J), 0.002);
        m.crack.p = 1e6;
        e = of_penny (&m, unit, normal[k], radius);
        check_below (e.J, 0.015); check_below (e.K[0], 1e-3); check_below (e.K[1], 0.03);
    }
}

/* A cut that ends along a straight front through the origin; axes: e, n, t. All vertices at least `margin`
 * from the ends are looked at. */
static void check_straight (exact *m, double unit, size_t margin, int nfield)
{
    char crack[600];
    double far = 4 * unit, corner[4][3];
    const double *e = m->axes, *t = m->axes + 6;
    for (int k = 0; k < 3; k++) {
        corner[0][k] = m->origin[k] + far * t[k], corner[1][k] = m->origin[k] - far * t[k];
        corner[2][k] = corner[1][k] - far * e[k], corner[3][k] = corner[0][k] - far * e[k];
    }
    int used = snprintf (crack, sizeof crack, "{polygon: [");
    for (int i = 0; i < 4; i++)
        used += snprintf (crack + used, sizeof crack - (size_t) used, "%s[%.17g, %.17g, %.17g]",
                          i ? ", " : "", corner[i][0], corner[i][1], corner[i][2]);
    snprintf (crack + used, sizeof crack - (size_t) used, "]}");
    tested tst = make (m, unit, crack);
    assert_int_equal (tst.problem->crack.nfront, 1);
    size_t n = tst.problem->crack.front[0].n, seen = 0;
    pg_tip_field *f = calloc (n, sizeof *f);
    double *second = calloc (tst.state->ndof, sizeof *second), factor[2] = { 1, 1 },
           E = m->E / (1 - m->nu * m->nu), mu = m->E / (2 * (1 + m->nu));
    const double *d[2] = { tst.state->d, second };
    second[0] = 1;
    check_ok (pg_front_measure (f, tst.problem, &tst.force, m, tst.state, 0, nfield, d, factor, NULL));
    double size = hypot (hypot (m->K[0][0], m->K[0][1]), m->K[0][2]);
    for (size_t i = margin; i + margin < n; i++, seen++) {
        check_relative (dot (f[i].e, e), 1, 1e-9), check_relative (dot (f[i].normal, m->axes + 3), 1, 1e-9);
        check_relative (dot (f[i].tangent, t), 1, 1e-9), check_relative (f[i].modulus, E, 1e-12);
        check_relative (f[i].near, 0.3 * unit, 1e-9);
        assert_true (f[i].wide > 0.299 * unit && f[i].room >= f[i].wide * (1 - 1e-9));
        for (double l = 0; l < 2 * nfield - 1; l++) {
            double both[2] = { 1, l }, K[3], J, T, right[3], G;
            for (int k = 0; k < 3; k++) right[k] = m->K[0][k] + l * m->K[1][k];
            G = (right[0] * right[0] + right[1] * right[1]) / E + right[2] * right[2] / (2 * mu);
            pg_tip_combine (&f[i], nfield, both, &J, K, &T);
            check_relative (J, G, 1e-3);
            for (int k = 0; k < 3; k++) check_scaled (K[k], right[k], 1e-3, size);
            check_scaled (T, m->T, 1e-3, size / sqrt (unit));
            double all = K[0] * K[0] + K[1] * K[1] + K[2] * K[2] / (1 - m->nu), open = K[0] * K[0] / all;
            pg_tip_intensities (&f[i], nfield, both, K);
            check_relative (K[0] * K[0] + K[1] * K[1] + K[2] * K[2] / (1 - m->nu),
                            open * E * J + (1 - open) * all, 1e-9);
        }
    }
    assert_true (seen > 4);
    free (f), free (second);
    clear (&tst);
}

/* J of twice what K makes: what opens takes its magnitude, what slides or tears keeps its own. */
static void intensities_of_what_slides (void **state)
{
    (void) state;
    for (int mode = 0; mode < 3; mode++) {
        pg_tip_field f = { .modulus = 1, .antiplane = 1.25 };
        double K[3];
        const double one = 1;
        f.K[mode][0] = 2, f.J[0][0] = 2 * 4 * (mode == 2 ? 1.25 : 1);
        pg_tip_intensities (&f, 1, &one, K);
        for (int k = 0; k < 3; k++) check_scaled (K[k], k == mode ? (mode ? 2 : 2 * sqrt (2)) : 0, 1e-12, 1);
        f.antiplane = 0;                               /* in the plane J decides */
        f.J[0][0] = 8;
        if (mode == 2) continue;
        pg_tip_intensities (&f, 1, &one, K);
        check_relative (K[mode], 2 * sqrt (2), 1e-12);
    }
}

static void straight_fronts_come_back (void **state)
{
    (void) state;
    exact m = { .E = 3e9, .nu = 0.3, .K = { { 1e6, -4e5, 3e5 }, { 2e5, 5e5, -1e5 } },
                .origin = { 0.02, -0.03, 0 } };
    for (int k = 0; k < 3; k++) {
        /* turned about the front, which runs along z, and mirrored */
        double angle = 0.7 * k,
               axes[9] = { cos (angle), sin (angle), 0, sin (angle), -cos (angle), 0, 0, 0, -1 };
        memcpy (m.axes, axes, sizeof axes);
        m.T = 2e5 * (k - 1), m.along = 1e-4 * k;
        check_straight (&m, 1, 7, 1); /* the ends of this field are not free */
    }
    for (int k = 0; k < 2; k++) {                      /* oblique, in two units of length */
        static const double axes[9] = { 0.8, 0, -0.6, -0.36, 0.8, -0.48, 0.48, 0.6, 0.64 };
        double unit = k ? 1e-3 : 1;
        memcpy (m.axes, axes, sizeof axes);
        for (int c = 0; c < 3; c++) m.origin[c] = 0.02 * unit;
        m.T = 1e5 / sqrt (unit), m.along = 0;
        check_straight (&m, unit, 8, 2);
    }
}

/* Forces in the body, which make the strain at the end of the tube as large as that of the front: J, K and T
 * are those at the front. */
static void forces_in_the_body_count (void **state)
{
    (void) state;
    exact m = { .E = 3e9, .nu = 0.3, .K = { { 1e6, -4e5, 3e5 } }, .origin = { 0.02, -0.03, 0.01 }, .T = 2e5 };
    static const double axes[9] = { 0.8, 0, -0.6, -0.36, 0.8, -0.48, 0.48, 0.6, 0.64 };
    memcpy (m.axes, axes, sizeof axes);
    for (int k = 0; k < 3; k++) {
        memset (m.b, 0, sizeof m.b);
        m.b[k] = 2e6 * (k == 1 ? -1 : 1);
        check_straight (&m, 1, 8, 1);
    }
}

/* Radius of the tube for K at the middle of the first front, in spacings; NAN: none. */
static double radius_of (const char *cracks, double *room)
{
    exact m = { .E = 3e9, .nu = 0.3, .K = { { 1e6, 0, 0 } } };
    tested t = make (&m, 1, cracks);
    size_t n = t.problem->crack.front[0].n;
    memcpy (m.axes, t.problem->crack.front[0].ahead, 3 * sizeof (double));
    memcpy (m.axes + 3, t.problem->crack.front[0].normal, 3 * sizeof (double));
    for (int k = 0; k < 3; k++) {
        int a = (k + 1) % 3, b = (k + 2) % 3;
        m.axes[6 + k] = m.axes[a] * m.axes[3 + b] - m.axes[b] * m.axes[3 + a];
    }
    pg_tip_field *f = calloc (n, sizeof *f);
    const double *d = t.state->d, one = 1;
    memcpy (m.origin, t.problem->crack.front[0].x, sizeof m.origin);
    check_ok (pg_front_measure (f, t.problem, &t.force, &m, t.state, 0, 1, &d, &one, NULL));
    double near = f[n / 2].near / 0.1;
    *room = f[n / 2].room / 0.1;
    for (size_t i = 7; i + 7 < n; i++) {               /* thinner tubes know the same of an exact field */
        assert_int_equal (isnan (f[i].near), isnan (f[i].J[0][0]));
        if (!isnan (f[i].near)) check_relative (f[i].J[0][0], 1e12 * (1 - 0.09) / m.E, 2e-3);
    }
    free (f);
    clear (&t);
    return near;
}

/* A cut from the side up to x, whose tube is thinner beside a face ahead, another crack, another front
 * behind; no thinner for a crack that is farther away. */
static void tubes_hold_nothing_else (void **state)
{
    (void) state;
    double room;
#define CUT(X) "{polygon: [[-3, -3, 0.01], [" X ", -3, 0.01], [" X ", 3, 0.01], [-3, 3, 0.01]]}"
    check_relative (radius_of (CUT ("0.1"), &room), 3, 1e-9), check_relative (room, 4, 1e-9);
    check_relative (radius_of (CUT ("0.74"), &room), 2.25, 1e-9), check_relative (room, 2.6, 1e-6);
    check_relative (radius_of (CUT ("0.81"), &room), 1.5, 1e-9), check_relative (room, 1.9, 1e-6);
    assert_true (isnan (radius_of (CUT ("0.87"), &room))), check_relative (room, 1.3, 1e-6);
    /* above, ahead, above and too far away */
#define PLATE(Z) "{polygon: [[0, -3, " Z "], [0.9, -3, " Z "], [0.9, 3, " Z "], [0, 3, " Z "]]}"
#define WALL(X) "{polygon: [[" X ", -3, -0.5], [" X ", -3, 0.5], [" X ", 3, 0.5], [" X ", 3, -0.5]]}"
    check_relative (radius_of (CUT ("0.1") ", " PLATE ("0.21"), &room), 1.5, 1e-9);
    check_relative (room, 2, 1e-3);
    check_relative (radius_of (CUT ("0.1") ", " WALL ("0.37"), &room), 2.25, 1e-9);
    check_relative (radius_of (CUT ("0.1") ", " PLATE ("0.51"), &room), 3, 1e-9);
    /* a strip 2 spacings wide: its other front lies behind */
#define STRIP "{polygon: [[0.1, -3, 0.01], [0.3, -3, 0.01], [0.3, 3, 0.01], [0.1, 3, 0.01]]}"
    check_relative (radius_of (STRIP, &room), 1.5, 1e-9);
}

static void what_cannot_be_measured (void **state)
{
    (void) state;
    exact m = { .E = 3e9, .nu = 0.3, .K = { { 1e6, 0, 0 } }, .axes = { 1, 0, 0, 0, 0, 1, 0, -1, 0 } };
    tested t = make (&m, 1, CUT ("0.1"));
    size_t n = t.problem->crack.front[0].n;
    pg_tip_field *f = calloc (n, sizeof *f);
    const double *d[3] = { t.state->d, t.state->d, t.state->d }, time[3] = { 1, 1, 1 };
    check_fails (pg_front_measure (f, t.problem, &t.force, &m, t.state, 1, 1, d, time, NULL), PG_E_USAGE);
    check_fails (pg_front_measure (f, t.problem, &t.force, &m, t.state, 0, 3, d, time, NULL), PG_E_USAGE);
    pg_status status = PG_E_MEMORY;
    size_t used = pg_memory_used ();
    for (size_t k = 1; status != PG_OK; k++) {
        pg_memory_fail_at (k);
        status = pg_front_measure (f, t.problem, &t.force, &m, t.state, 0, 1, d, time, NULL);
        pg_memory_fail_at (0);
        assert_true (status == PG_OK || status == PG_E_MEMORY);
        assert_int_equal (pg_memory_used (), used);
    }
    t.force.sample = NULL;
    check_fails (pg_front_measure (f, t.problem, &t.force, &m, t.state, 0, 1, d, time, NULL), PG_E_USAGE);
    free (f);
    clear (&t);
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (straight_fronts_come_back),
                                        cmocka_unit_test (intensities_of_what_slides),
                                        cmocka_unit_test (forces_in_the_body_count),
                                        cmocka_unit_test (pennies_come_back),
                                        cmocka_unit_test (tubes_hold_nothing_else),
                                        cmocka_unit_test (what_cannot_be_measured) };
    return cmocka_run_group_tests_name ("crack/fracture/front_integrals", tests, NULL, NULL);
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * The integrals around a tip, fed with exact fields instead of those of a discretisation: they must give back
 * the K_I, K_II and T that the fields were made of, and J = (K_I^2 + K_II^2) / E', for any direction of the
 * crack, in plane stress and plane strain, in any unit of length, with body forces and in motion. */
#include "check.h"
#include "crack/fracture/kinked_crack.h"
#include "perigal/fracture.h"
#include <stdlib.h>

static const double pi = 3.14159265358979323846;

/* What the stand-in for a force shows. */
typedef struct {
    const pg_state *state;
    pg_mode mode;
    double E, nu, density;
    double x[2], angle;           /* tip, direction of the crack */
    double K[2][2], T[2];         /* of the fields d[0], d[1] */
    double b[2];                  /* body force along the crack, N/m^3 */
    double pressure;              /* on the faces, and in the whole body, Pa */
    double acceleration[2], spin; /* in motion: m/s^2; v = spin (x1 + 0.3, x1 + x2), 1/s */
} exact;

/* Field number `at` in the frame of the tip at (x, y) there. */
static void field_at (const exact *m, int at, double x, double y, double *u, double *H, double *s)
{
    double mu = m->E / (2 * (1 + m->nu)), kappa = pg_tip_kappa (m->mode, m->nu), r = hypot (x, y),
           modulus = 8 * mu / (kappa + 1), nu = (3 - kappa) / (1 + kappa), theta = atan2 (y, x);
    u[0] = (m->T[at] * x - 0.5 * m->b[at] * (x * x + nu * y * y)) / modulus;
    u[1] = (-nu * m->T[at] * y + nu * m->b[at] * x * y) / modulus;
    H[0] = (m->T[at] - m->b[at] * x) / modulus, H[1] = -nu * m->b[at] * y / modulus;
    H[2] = nu * m->b[at] * y / modulus, H[3] = (-nu * m->T[at] + nu * m->b[at] * x) / modulus;
    s[0] = m->T[at] - m->b[at] * x, s[1] = s[2] = 0;
    for (int k = 0; k < 2; k++) {
        double v[2], G[4], t[3];
        pg_tip_near_field (k, mu, kappa, r, theta, v, G, t);
        for (int i = 0; i < 2; i++) u[i] += m->K[at][k] * v[i];
        for (int i = 0; i < 4; i++) H[i] += m->K[at][k] * G[i];
        for (int i = 0; i < 3; i++) s[i] += m->K[at][k] * t[i];
    }
    double strain = m->pressure * (kappa - 1) / (4 * mu);
    for (int i = 0; i < 2; i++) H[3*i] -= strain, s[i] -= m->pressure;
    u[0] -= strain * x, u[1] -= strain * y;
}

/* From the frame of the tip to the scene: R a R'. */
static void turn_back (double angle, const double *a, double *out)
{
    double R[2][2] = { { cos (angle), -sin (angle) }, { sin (angle), cos (angle) } };
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2; j++) {
            out[2 * i + j] = 0;
            for (int k = 0; k < 2; k++)
                for (int l = 0; l < 2; l++) out[2 * i + j] += R[i][k] * a[2 * k + l] * R[j][l];
        }
}

static pg_status sample (void *self, const pg_state *state, const double *d, size_t n, const double *x,
                         double *u, double *stress, double *gradient)
{
    const exact *m = self;
    double c = cos (m->angle), s = sin (m->angle);
    for (size_t k = 0; k < n; k++) {
        double X = x[2 * k] - m->x[0], Y = x[2 * k + 1] - m->x[1], p = c * X + s * Y, q = c * Y - s * X, v[2],
               H[4], t[3];
        if (d == state->v)
            v[0] = m->spin * (p + 0.3), v[1] = m->spin * (p + q), H[0] = H[2] = H[3] = m->spin, H[1] = 0;
        else if (d == state->a)
            v[0] = m->acceleration[0], v[1] = m->acceleration[1], memset (H, 0, sizeof H);
        else
            field_at (m, d[0] != 0, p, q, v, H, t);
        u[3 * k] = c * v[0] - s * v[1], u[3 * k + 1] = s * v[0] + c * v[1], u[3 * k + 2] = 0;
        if (gradient) turn_back (m->angle, H, gradient + 9 * k);
        if (!stress) continue;
        double full[4] = { t[0], t[2], t[2], t[1] }, turned[4];
        turn_back (m->angle, full, turned);
        memset (stress + 6 * k, 0, 6 * sizeof *stress);
        stress[6 * k] = turned[0], stress[6 * k + 1] = turned[3], stress[6 * k + 3] = turned[1];
    }
    return PG_OK;
}

typedef struct {
    pg_scene *scene;
    pg_problem *problem;
    pg_state *state;
    pg_force_type force;
    double *second;
} tested;

/* The second field, which the stand-in knows by its first number; free as the rest is. */
static const double *second_of (tested *t)
{
    t->second = calloc (t->state->ndof, sizeof *t->second);
    t->second[0] = 1;
    return t->second;
}

/* A square of 40 spacings around a crack of 2 x 10 spacings from its middle at an angle; unit: its half
 * width, m. */
static tested make (exact *m, double unit, double angle, const char *more)
{
    tested t = { 0 };
    char text[2000];
    double c = 0.5 * unit * cos (angle), s = 0.5 * unit * sin (angle);
    snprintf (
        text, sizeof text,
        "dimension: 2\nthickness: 0.7\nplane: %s\nbody: [{add: {box: {low: [%.17g, %.17g], high: [%.17g, "
        "%.17g]}}}]\nspacing: %.17g\nmaterials: {a: {youngs_modulus: %g, poissons_ratio: %g, density: "
        "%g}}\ncracks: [{from: [%.17g, %.17g], to: [%.17g, %.17g]}]\n%s",
        m->mode == PG_PLANE_STRAIN ? "strain" : "stress", -unit, -unit, unit, unit, unit / 20, m->E, m->nu,
        m->density > 0 ? m->density : 1, -c, -s, c, s,
        more ? more : "boundary: [{set: bottom, displacement: {x: 0, y: 0}}]\n");
    check_ok (pg_scene_parse (&t.scene, text, "test.yaml"));
    check_ok (pg_problem_build (&t.problem, t.scene, 1));
    check_ok (pg_state_create (&t.state, t.problem, 2));
    t.force = *pg_force_of (t.problem);
    t.force.sample = sample;
    assert_non_null (t.state->paths);
    assert_int_equal (t.state->paths->ntip, 2);
    return t;
}

static void clear (tested *t)
{
    free (t->second);
    pg_state_free (&t->state);
    pg_problem_free (&t->problem);
    pg_scene_free (&t->scene);
}

/* The tip at the end of the crack (`angle` ahead). */
static size_t end_tip (const tested *t, double angle)
{
    const pg_tip *tip = t->state->paths->tip;
    return tip[0].x[0] * cos (angle) + tip[0].x[1] * sin (angle) > 0 ? 0 : 1;
}

/* All numbers of one field. */
static void check_field (exact *m, double unit, double angle, const char *more, double tolerance)
{
    tested t = make (m, unit, angle, more);
    size_t tip = end_tip (&t, angle);
    pg_tip_field f;
    const double *d = m->density > 0 ? t.state->d : t.state->d, factor = 1,
                 E = m->mode == PG_PLANE_STRAIN ? m->E / (1 - m->nu * m->nu) : m->E,
                 K = hypot (m->K[0][0], m->K[0][1]), scale = K / sqrt (pi * unit);
    m->angle = angle, m->x[0] = 0.5 * unit * cos (angle), m->x[1] = 0.5 * unit * sin (angle);
    if (m->density > 0) t.state->v[0] = 1; /* the state moves: the stand-in says how */
    check_ok (pg_tip_measure (&f, t.problem, &t.force, m, t.state, tip, 1, &d, &factor, NULL, 0));
    check_relative (f.modulus, E, 1e-12);
    check_relative (f.h, unit / 20, 1e-9);
    check_scaled (f.e[0], cos (angle), 1e-9, 1), check_scaled (f.e[1], sin (angle), 1e-9, 1);
    check_relative (f.near / f.h, 3, 1e-9), check_relative (f.wide / f.h, 8, 1e-9);
    check_scaled (f.K[0][0], m->K[0][0], tolerance, K), check_scaled (f.K[1][0], m->K[0][1], tolerance, K);
    check_scaled (f.K_wide[0][0], m->K[0][0], tolerance, K),
        check_scaled (f.K_wide[1][0], m->K[0][1], tolerance, K);
    check_relative (f.J[0][0], K * K / E, tolerance), check_relative (f.J_near[0][0], K * K / E, tolerance);
    check_scaled (f.T[0], m->T[0], 10 * tolerance, scale);
    check_below (pg_tip_uncertainty (&f, 1, &factor), 2 * tolerance);
    clear (&t);
}

static void modes_come_back (void **state)
{
    (void) state;
    double angle[] = { 0, 0.3, 1.1, 2.5, -1.9 };
    for (size_t k = 0; k < sizeof angle / sizeof *angle; k++) {
        exact m = { .mode = k % 2 ? PG_PLANE_STRAIN : PG_PLANE_STRESS, .E = 3e9, .nu = 0.3 };
        m.K[0][0] = 1e6;
        check_field (&m, 1, angle[k], NULL, 1e-5);
        m.K[0][0] = 0, m.K[0][1] = -2e6;
        check_field (&m, 1, angle[k], NULL, 1e-5);
        m.K[0][0] = 1.5e6, m.K[0][1] = 0.7e6, m.T[0] = -4e6;
        check_field (&m, 1, angle[k], NULL, 1e-4);
    }
}

/* The same in bodies of 1 mm and of 1 km. */
static void lengths_of_any_size (void **state)
{
    (void) state;
    for (int k = -1; k <= 1; k++) {
        double unit = pow (1000, k);
        exact m = { .mode = PG_PLANE_STRAIN, .E = 70e9, .nu = 0.2, .K = { { 1e6, 3e5 } } };
        m.T[0] = 1e5 / sqrt (unit);
        check_field (&m, unit, 0.4, NULL, 1e-4);
    }
}

/* sigma_11 = - b x_1 bears a body force b along the crack and has no J: without the term of the force, or
 * with its other sign, J and K would be off by b sqrt (r) r. */
static void body_forces_do_not_count_as_energy (void **state)
{
    (void) state;
    for (int k = 0; k < 2; k++) {
        char more[300];
        double angle = k ? 0.6 : 0, b = 2e6;
        exact m = { .mode = k ? PG_PLANE_STRAIN : PG_PLANE_STRESS,
                    .E = 3e9,
                    .nu = 0.3,
                    .K = { { 1e6, 4e5 } },
                    .b = { b } };
        snprintf (
            more, sizeof more,
            "boundary: [{set: bottom, displacement: {x: 0, y: 0}}, {set: all, body_force: {x: %.17g, y: "
            "%.17g}}]\n",
            b * cos (angle), b * sin (angle));
        check_field (&m, 1, angle, more, 1e-3);
    }
}

/* Accelerated as a whole by a body force rho a, with a velocity field without singularity: nothing of it is
 * released at the tip. */
static void motion_does_not_count_as_release (void **state)
{
    (void) state;
    char more[300];
    double angle = 0.3, density = 2000, a[2] = { 3000, -1000 };
    double b[2] = { density * (a[0] * cos (angle) - a[1] * sin (angle)),
                    density * (a[0] * sin (angle) + a[1] * cos (angle)) };
    exact m = { .mode = PG_PLANE_STRESS,
                .E = 3e9,
                .nu = 0.3,
                .K = { { 1e6, 4e5 } },
                .density = density,
                .acceleration = { a[0], a[1] },
                .spin = 50 };
    snprintf (more, sizeof more,
              "boundary: [{set: bottom, displacement: {x: 0, y: 0}}, {set: all, body_force: {x: %.17g, y: "
              "%.17g}}]\n",
              b[0], b[1]);
    check_field (&m, 1, angle, more, 1e-3);
}

/* Two fields: J is a square of their sum. A body force that does not change with the load factor acts on the
 * first alone. */
static void affine_fields (void **state)
{
    (void) state;
    double b = 1e6;
    exact m = { .mode = PG_PLANE_STRESS,
                .E = 3e9,
                .nu = 0.3,
                .K = { { 1e6, 2e5 }, { -3e5, 6e5 } },
                .T = { 1e5, -2e5 },
                .b = { b, 0 },
                .x = { 0.5, 0 } };
    tested t = make (&m, 1, 0,
                     "boundary: [{set: bottom, displacement: {x: 0, y: 0}}, {set: all, body_force: {x: 1e6}, "
                     "ramp: constant}]\n");
    double factor[2] = { 0, 1 }, J, K[3], T, alone[2] = { 1, 0 };
    const double *d[2] = { t.state->d, second_of (&t) };
    pg_tip_field f;
    check_ok (pg_tip_measure (&f, t.problem, &t.force, &m, t.state, end_tip (&t, 0), 2, d, factor, NULL, 0));
    for (double l = -1; l < 4; l += 0.7) {
        double both[2] = { 1, l }, k[2] = { 1e6 - 3e5 * l, 2e5 + 6e5 * l };
        pg_tip_combine (&f, 2, both, &J, K, &T);
        check_scaled (K[0], k[0], 1e-3, 1e6), check_scaled (K[1], k[1], 1e-3, 1e6);
        assert_true (K[2] == 0);
        check_relative (J, (k[0] * k[0] + k[1] * k[1]) / m.E, 1e-3);
        check_scaled (T, 1e5 - 2e5 * l, 1e-2, 1e6);
    }
    assert_true (f.J[0][1] == f.J[1][0]);
    pg_tip_intensities (&f, 2, alone, K);
    check_relative (hypot (K[0], K[1]), sqrt (f.modulus * f.J[0][0]), 1e-12);
    check_relative (K[1] / K[0], f.K[1][0] / f.K[0][0], 1e-12);
    check_fails (pg_tip_measure (&f, t.problem, &t.force, &m, t.state, 2, 1, d, factor, NULL, 0), PG_E_USAGE);
    check_fails (pg_tip_measure (&f, t.problem, &t.force, &m, t.state, 0, 3, d, factor, NULL, 0), PG_E_USAGE);
    clear (&t);
}

/* Around a kink: the tip has grown by two facets, and the fields are still those of the straight crack, T and
 * a body force along it among them. What they do to the end of the facets the weight functions say. The body
 * force stays constant, the rest grows: two fields. */
static void fields_around_a_kink (void **state)
{
    (void) state;
    double angle = 0.3, b = 4e7, h = 0.05, c = cos (angle), s = sin (angle), turn[2] = { 0.9, 0.6 };
    char more[300];
    exact m = { .mode = PG_PLANE_STRAIN, .E = 3e9, .nu = 0.3, .K = { { 0 }, { 1e6, 4e5 } }, .T = { 0, 3e6 },
                .b = { b, 0 }, .angle = angle, .x = { 0.5 * c, 0.5 * s } };
    snprintf (more, sizeof more,
              "boundary: [{set: bottom, displacement: {x: 0, y: 0}}, {set: all, body_force: {x: %.17g, y: "
              "%.17g}, ramp: constant}]\n", b * c, b * s);
    tested t = make (&m, 1, angle, more);
    size_t tip = end_tip (&t, angle);
    double complex vertex[2];
    double to[3] = { m.x[0], m.x[1], 0 }, factor[2] = { 0, 1 };
    pg_changes cut = { 0 };
    for (int k = 0; k < 2; k++) {
        to[0] += h * cos (angle + turn[k]), to[1] += h * sin (angle + turn[k]);
        vertex[k] = (k ? vertex[0] : 0) + h * cexp (_Complex_I * turn[k]);
        check_ok (pg_crack_grow (t.state, t.problem, tip, to, 0, &cut));
    }
    const double *d[2] = { t.state->d, second_of (&t) };
    pg_tip_field f;
    check_ok (pg_tip_measure (&f, t.problem, &t.force, &m, t.state, tip, 2, d, factor, NULL, h));
    assert_int_equal (f.kinked, 1);
    check_scaled (f.e[0], cos (angle + turn[1]), 1e-9, 1);
    kinked_weights w;
    kinked_faces load[2] = { { .b = { b, 0 } }, { .S = { 3e6, 0, 0 } } };
    check_ok (kinked_weights_of (&w, 2, vertex, 2, load, 0));
    for (int k = 0; k < 2; k++) {
        check_scaled (f.K[k][0], w.own[0][k], 1e-3, 1e6 * 0.01);
        check_scaled (f.K[k][1], 1e6 * w.k[0][k] + 4e5 * w.k[1][k] + w.own[1][k], 1e-3, 1e6);
    }
    check_relative (f.J[0][1], (f.K[0][0] * f.K[0][1] + f.K[1][0] * f.K[1][1]) / f.modulus, 1e-9);
    check_below (fabs (f.J_near[1][1] / f.J[1][1] - 1), 3e-3);
    /* the facet to come, and where it goes: K_II vanishes in the mean of its length */
    double complex more_of[3] = { vertex[0], vertex[1], vertex[1] + h * cexp (_Complex_I * (turn[1] + 0.4)) };
    check_ok (kinked_weights_of (&w, 3, more_of, 2, load, 0));
    check_absolute (f.trial, h, 1e-12), check_absolute (f.trial_angle[3], 0.4, 1e-12);
    for (int k = 0; k < 2; k++)
        check_scaled (f.trial_K[3][k][1], 1e6 * w.k[0][k] + 4e5 * w.k[1][k] + w.own[1][k], 2e-3, 1e6);
    double l[2] = { 1, 1 }, theta, K[3];
    assert_int_equal (pg_kink_ahead (&f, 2, l, 0, &theta), 1);
    more_of[2] = vertex[1] + h * cexp (_Complex_I * (turn[1] + theta));
    check_ok (kinked_weights_of (&w, 3, more_of, 2, load, 0));
    pg_tip_combine (&f, 2, l, NULL, K, NULL);
    double end[2];
    for (int k = 0; k < 2; k++) end[k] = 1e6 * w.k[0][k] + 4e5 * w.k[1][k] + w.own[1][k] + w.own[0][k];
    check_absolute (2 * end[1] / end[0] + K[1] / K[0] + theta / 2, 0, 5e-3);
    pg_free (cut.bond);
    clear (&t);
}

/* J along a facet behind a kink, in motion, where there are no weight functions, of the fields of the
 * straight crack; *exact: of both its directions, J_1 cos + J_2 sin, J_2 = - 2 K_I K_II / E'. */
static double behind_a_kink (double turn, double T, double pressure, double *right)
{
    double angle = 0.3, h = 0.05, one = 1;
    char more[200];
    exact m = { .mode = PG_PLANE_STRESS, .E = 3e9, .nu = 0.3, .density = 1, .K = { { 1e6, 4e5 } }, .T = { T },
                .pressure = pressure, .angle = angle, .x = { 0.5 * cos (angle), 0.5 * sin (angle) } };
    snprintf (more, sizeof more, "boundary: [{set: bottom, displacement: {x: 0, y: 0}}%s]\n",
              pressure > 0 ? ", {set: cracks, pressure: 2e6}" : "");
    tested t = make (&m, 1, angle, more);
    size_t tip = end_tip (&t, angle);
    pg_changes cut = { 0 };
    for (int i = 1; i <= 2; i++) {                     /* the end stays within the inner radius of the ring */
        double l = 0.2 * h * i, to[3] = { m.x[0] + l * cos (angle + turn), m.x[1] + l * sin (angle + turn),
                                          0 };
        check_ok (pg_crack_grow (t.state, t.problem, tip, to, 0, &cut));
    }
    const double *d = t.state->d;
    pg_tip_field f;
    t.state->v[0] = 1;
    check_ok (pg_tip_measure (&f, t.problem, &t.force, &m, t.state, tip, 1, &d, &one, NULL, h));
    double beta = atan2 (f.e[1], f.e[0]) - angle;      /* of a chord over the facets and what lies behind */
    assert_true (beta * turn > 0 && fabs (beta) > 0.15 && f.r1 > 0.9 * h);
    *right = ((1e12 + 1.6e11) * cos (beta) - 8e11 * sin (beta)) / m.E;
    pg_free (cut.bond);
    clear (&t);
    return f.J[0][0];
}

/* With a stress T along the crack the faces behind the kink, which look along the facet, have energies that
 * differ, and their part in J (as much as J itself) takes out what the ring has of T: the ring alone, or the
 * part of the other sign, makes J nearly zero or twice as much. What is left is a fifth, from places of the
 * ring on both sides of the jump of the fields. A pressure on the faces has no part in J. */
static void faces_behind_a_kink_in_motion (void **state)
{
    (void) state;
    for (int k = 0; k < 2; k++) {
        double turn = k ? -0.6 : 0.6, right, J = behind_a_kink (turn, 0, 0, &right),
               with = behind_a_kink (turn, 1e7, 0, &right), against = behind_a_kink (turn, -1e7, 0, &right);
        check_relative (J, right, 0.04);
        check_scaled (with, against, 0.45, right);
        check_relative (0.5 * (with + against), right, 0.04);
        check_relative (behind_a_kink (turn, 1e7, 2e6, &right), with, 1e-9);
    }
}

/* A tip in pure shear whose K_I is what rounding makes it: what is shown does not hang on its sign, and has
 * the magnitude of J. */
static void a_sign_of_rounding_changes_nothing (void **state)
{
    (void) state;
    pg_tip_field f = { .J = { { 8 } }, .K = { { 0 }, { 7e5 } }, .modulus = 70e9 };
    double l = 1, shown[3][3];
    for (int k = 0; k < 3; k++) {
        f.K[0][0] = 1e-9 * (k - 1);
        pg_tip_intensities (&f, 1, &l, shown[k]);
        check_relative (shown[k][1], sqrt (70e9 * 8), 1e-12);
    }
    f.K[0][0] = -3e5, pg_tip_intensities (&f, 1, &l, shown[0]);
    f.K[0][0] = 3e5, pg_tip_intensities (&f, 1, &l, shown[1]);
    check_relative (shown[0][0], -shown[1][0], 1e-14), check_relative (shown[0][1], shown[1][1], 1e-14);
}

/* ---- exact fields -------------------------------------------------------------------------------------- */
/* Gradient by differences, stress by Hooke's law, free faces, and the stress ahead. */
static void fields_are_solutions (void **state)
{
    (void) state;
    double nu = 0.3, E = 2, mu = E / (2 * (1 + nu)), r = 0.7, e = 1e-5;
    for (int plane = 0; plane < 2; plane++) {
        pg_mode mode = plane ? PG_PLANE_STRAIN : PG_PLANE_STRESS;
        double kappa = pg_tip_kappa (mode, nu), lambda = mu * (3 - kappa) / (kappa - 1);
        for (int k = 0; k < PG_TIP_FIELDS; k++) {
            double s[3], H[4], low[2], high[2];
            for (double theta = -3; theta <= 3; theta += 0.5) {
                double x[2] = { r * cos (theta), r * sin (theta) };
                pg_tip_near_field (k, mu, kappa, r, theta, NULL, H, s);
                for (int c = 0; c < 2; c++) {
                    double y[2] = { x[0], x[1] };
                    y[c] = x[c] + e, pg_tip_near_field (k, mu, kappa, hypot (y[0], y[1]), atan2 (y[1], y[0]),
                                                        high, NULL, NULL);
                    y[c] = x[c] - e,
                    pg_tip_near_field (k, mu, kappa, hypot (y[0], y[1]), atan2 (y[1], y[0]), low, NULL, NULL);
                    for (int i = 0; i < 2; i++)
                        check_scaled (H[2 * i + c], (high[i] - low[i]) / (2 * e), 1e-8, 1);
                }
                check_scaled (s[0], lambda * (H[0] + H[3]) + 2 * mu * H[0], 1e-12, 1);
                check_scaled (s[1], lambda * (H[0] + H[3]) + 2 * mu * H[3], 1e-12, 1);
                check_scaled (s[2], mu * (H[1] + H[2]), 1e-12, 1);
            }
            for (int side = -1; side <= 1; side += 2) {
                pg_tip_near_field (k, mu, kappa, r, side * pi, NULL, NULL, s);
                check_scaled (s[1], 0, 1e-12, 1), check_scaled (s[2], 0, 1e-12, 1);
            }
            pg_tip_near_field (k, mu, kappa, r, 0, NULL, NULL, s);
            if (k < 2)
                check_relative (s[k == 0 ? 1 : 2], 1 / sqrt (2 * pi * r), 1e-12);
            else
                check_relative (s[0], -1 / (pi * r), 1e-12);
        }
    }
}

/* ---- direction ----------------------------------------------------------------------------------------- */
static void kinks_go_where_the_hoop_stress_is_largest (void **state)
{
    (void) state;
    double angle, K, G;
    assert_int_equal (pg_kink (3, 2, 0, NAN, 1, &angle, &K, &G), 1);
    check_absolute (angle, 0, 1e-15), check_relative (K, 2, 1e-15), check_relative (G, 3, 1e-15);
    assert_int_equal (pg_kink (1, 0, 1, NAN, 1, &angle, &K, &G), 1);
    check_relative (angle, -acos (1.0 / 3), 1e-12), check_relative (K, 2 / sqrt (3), 1e-12);
    assert_int_equal (pg_kink (1, 0, -1, NAN, 1, &angle, &K, &G), 1);
    check_relative (angle, acos (1.0 / 3), 1e-12), check_relative (G, 4.0 / 3, 1e-12);
    assert_int_equal (pg_kink (1, -1, 0, NAN, 1, &angle, &K, &G), 0);
    assert_int_equal (pg_kink (0, 0, 0, NAN, 1, &angle, &K, &G), 0);
    for (double a = -1.5; a <= 1.5; a += 0.3) {
        double best = -1e9, at = 0, K_I = cos (a), K_II = sin (a);
        for (double th = -pi; th <= pi; th += 1e-4) {
            double c = cos (th / 2), hoop = c * (K_I * c * c - 1.5 * K_II * sin (th));
            if (hoop > best) best = hoop, at = th;
        }
        assert_int_equal (pg_kink (2, K_I, K_II, 0, 1, &angle, &K, &G), 1);
        check_absolute (angle, at, 2e-4), check_relative (K, best, 1e-6),
            check_relative (G, 2 * best * best, 1e-6);
    }
    /* a stress along the crack in compression turns it less, one in tension does not count */
    double with, without;
    pg_kink (1, 1, 1, 5, 0.01, &without, &K, &G), pg_kink (1, 1, 1, -5, 0.01, &with, &K, &G);
    pg_kink (1, 1, 1, NAN, 0.01, &angle, &K, &G);
    check_relative (without, angle, 1e-15);
    assert_true (fabs (with) < 0.9 * fabs (angle));
    /* nor does a small one */
    pg_kink (1, 1, 1, -1, 0.01, &with, &K, &G);
    check_relative (with, angle, 1e-15);
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (fields_are_solutions),
                                        cmocka_unit_test (kinks_go_where_the_hoop_stress_is_largest),
                                        cmocka_unit_test (modes_come_back),
                                        cmocka_unit_test (lengths_of_any_size),
                                        cmocka_unit_test (body_forces_do_not_count_as_energy),
                                        cmocka_unit_test (motion_does_not_count_as_release),
                                        cmocka_unit_test (affine_fields),
                                        cmocka_unit_test (a_sign_of_rounding_changes_nothing),
                                        cmocka_unit_test (fields_around_a_kink),
                                        cmocka_unit_test (faces_behind_a_kink_in_motion) };
    return cmocka_run_group_tests_name ("crack/fracture/tip_integrals", tests, NULL, NULL);
}

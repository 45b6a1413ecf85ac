/* SPDX-License-Identifier: GPL-3.0-or-later
 * Gradients for forces without shape functions: exact for linear and quadratic fields on perturbed points,
 * one side of a crack at a time, whether the crack is drawn or only broken bonds; close to the field of a
 * crack tip; none where points lie on a line. */
#include "scene_runs/run.h"
#include "crack/fracture/gradient_fit.h"

static const char plate[] =
    "dimension: 2\nplane: stress\nthickness: 1\nbody: [{add: {box: {low: [0, 0], high: [2, 1]}}}]\n"
    "spacing: 0.1\nlattice: cells\nperturb: {amount: 0.2, seed: 7}\n"
    "materials: {m: {youngs_modulus: 1, poissons_ratio: 0.3333333333333333}}\n"
    "boundary: [{set: top, displacement: {x: 0, y: 1}}, {set: bottom, displacement: {x: 0, y: 0}}]\n"
    "solver: {kind: static}\n";

/* A run of the plate with these further lines; its displacement is not solved for. */
static run made (const char *more) { return scene_of (1, "%s%s", plate, more); }

/* Fills the unknowns of every point, `place` being given its coordinates. */
static void fill (run *r, void (*place) (const double *x, double *u))
{
    size_t stride = (size_t) pg_problem_unknowns (r->problem);
    for (size_t i = 0; i < r->problem->cloud.n; i++) {
        double u[2];
        place (r->problem->cloud.x + 2 * i, u);
        r->state->d[i * stride] = u[0], r->state->d[i * stride + 1] = u[1];
    }
}

static void quadratic (const double *x, double *u)
{
    u[0] = 0.3 + 2 * x[0] - x[1] + 0.7 * x[0] * x[0] + 0.2 * x[0] * x[1];
    u[1] = -1 + 0.5 * x[0] + 4 * x[1] - 1.1 * x[1] * x[1] + 0.3 * x[0] * x[1];
}

static void its_gradient (const double *x, double *H)
{
    H[0] = 2 + 1.4 * x[0] + 0.2 * x[1], H[1] = -1 + 0.2 * x[0];
    H[2] = 0.5 + 0.3 * x[1], H[3] = 4 - 2.2 * x[1] + 0.3 * x[0];
}

/* Another field above y = 0.5 than below. */
static void two_sides (const double *x, double *u)
{
    quadratic (x, u);
    if (x[1] > 0.5) u[0] += 5 + 3 * x[1], u[1] -= 2 * x[0];
}

static void check_gradient (const double *value, const double *exact, double tolerance)
{
    for (int k = 0; k < 4; k++) assert_true (fabs (value[k] - exact[k]) <= tolerance);
}

/* Inside, at an edge, in a corner and outside. */
static void quadratic_fields_are_exact (void **state)
{
    static const double place[][2] = { { 1, 0.52 }, { 0.013, 0.4 }, { 1.99, 0.99 }, { 2.03, -0.02 } };
    static const char *const method[] = { "method: {force: bond}\n", "method: {force: lps}\n",
                                          "method: {force: gmpd, horizon: 4 spacing}\n" };
    (void) state;
    for (size_t m = 0; m < sizeof method / sizeof *method; m++) {
        run r = made (method[m]);
        gradient_fit *fit;
        fill (&r, quadratic);
        check_ok (gradient_fit_create (&fit, r.problem, r.state));
        for (size_t k = 0; k < sizeof place / sizeof *place; k++) {
            double H[18], u[6], exact[4], at[2];
            const double *d[2] = { r.state->d, r.state->d };
            assert_int_equal (gradient_fit_at (fit, place[k], 2, d, u, H), 2);
            its_gradient (place[k], exact);
            quadratic (place[k], at);
            check_gradient (H, exact, 1e-9);
            check_gradient (H + 9, exact, 1e-9);
            assert_true (fabs (u[0] - at[0]) < 1e-10 && fabs (u[4] - at[1]) < 1e-10 && u[2] == 0);
        }
        gradient_fit_free (&fit);
        clear (&r);
    }
}

/* A drawn crack, the same made of dead bonds alone, and a drawn one whose bonds live, as those of forces that
 * open cracks by their shape functions alone. */
static void nothing_is_seen_across_a_crack (void **state)
{
    static const double below[2] = { 1.02, 0.49 }, above[2] = { 1.02, 0.51 };
    (void) state;
    for (int drawn = 0; drawn < 3; drawn++) {
        run r = made (drawn ? "method: {force: bond}\ncracks: [{from: [-0.1, 0.5], to: [2.1, 0.5]}]\n"
                            : "method: {force: bond}\n");
        const pg_problem *p = r.problem;
        const pg_rows *rows = &p->bonds.rows[PG_NODES];
        gradient_fit *fit;
        double H[9], exact[4];
        const double *d = r.state->d;
        for (size_t i = 0; i < rows->n; i++)
            for (size_t e = rows->family.start[i]; e < rows->family.start[i + 1]; e++) {
                double yi = p->cloud.x[2 * i + 1], yj = p->cloud.x[2 * (size_t) rows->family.node[e] + 1];
                if ((yi - 0.5) * (yj - 0.5) < 0) r.state->alive[p->bonds.first[PG_NODES] + e] = drawn == 2;
            }
        fill (&r, two_sides);
        check_ok (gradient_fit_create (&fit, p, r.state));
        for (int side = 0; side < 2; side++) {
            /* of broken bonds alone the nearest point tells the side */
            double x[2] = { side ? above[0] : below[0], side ? above[1] : below[1] };
            if (!drawn) x[1] = side ? 0.56 : 0.44;
            assert_int_equal (gradient_fit_at (fit, x, 1, &d, NULL, H), 2);
            its_gradient (x, exact);
            if (side) exact[1] += 3, exact[2] -= 2;
            check_gradient (H, exact, 1e-9);
        }
        gradient_fit_free (&fit);
        clear (&r);
    }
}

static const char lattice[] =
    "dimension: 2\nthickness: 1\nbody: [{add: {box: {low: [0, 0], high: [2, 1]}}}]\nspacing: 0.1\n"
    "lattice: cells\nmaterials: {m: {youngs_modulus: 1, poissons_ratio: 0.3333333333333333}}\n"
    "boundary: [{set: top, displacement: {x: 0, y: 1}}, {set: bottom, displacement: {x: 0, y: 0}}]\n"
    "solver: {kind: static}\nmethod: {force: bond}\n";

/* A point that keeps one bond, or two in a line, moves across it as it likes: its displacement has no part in
 * gradients beside it. */
static void what_nothing_holds_has_no_part (void **state)
{
    (void) state;
    for (size_t kept = 1; kept < 3; kept++) {
        run r = scene_of (1, "%s", lattice);
        const pg_problem *p = r.problem;
        const pg_family *f = &p->bonds.rows[PG_NODES].family;
        unsigned char *alive = r.state->alive + p->bonds.first[PG_NODES];
        gradient_fit *fit;
        double H[9], exact[4], x[2] = { 1.13, 0.47 };
        const double *d = r.state->d;
        size_t loose = 0, along = 0;
        fill (&r, quadratic);
        for (size_t i = 0; i < p->cloud.n; i++)
            if (hypot (p->cloud.x[2*i] - 1.05, p->cloud.x[2*i + 1] - 0.45) < 0.01) loose = i;
        for (size_t i = 0; i < p->cloud.n; i++)
            for (size_t e = f->start[i]; e < f->start[i + 1]; e++) {
                size_t j = (size_t) f->node[e], other = i == loose ? j : i;
                double x1 = p->cloud.x[2 * other] - p->cloud.x[2 * loose];
                if (i != loose && j != loose) continue;
                alive[e] = fabs (p->cloud.x[2 * other + 1] - p->cloud.x[2 * loose + 1]) < 0.01
                           && fabs (x1) < 0.11 && (x1 > 0 || kept == 2);
                along += alive[e];
            }
        assert_int_equal (along, 2 * kept);
        r.state->d[2 * loose + 1] += 1000;
        check_ok (gradient_fit_create (&fit, p, r.state));
        assert_int_equal (gradient_fit_at (fit, x, 1, &d, NULL, H), 2);
        its_gradient (x, exact);
        check_gradient (H, exact, 1e-9);
        gradient_fit_free (&fit);
        clear (&r);
    }
}

/* u_y = sqrt (r) sin (angle / 2), the opening of a crack that ends at (1, 0.5). */
static void opening (const double *x, double *u)
{
    double a = atan2 (x[1] - 0.5, x[0] - 1), r = hypot (x[0] - 1, x[1] - 0.5);
    u[0] = 0, u[1] = sqrt (r) * sin (a / 2);
}

/* Its gradient at three spacings from the tip, within 2 %; beside the faces, whose points are on one side
 * only, 8 %. */
static void the_field_of_a_tip_is_found (void **state)
{
    enum { PLACES = 24 };
    run r = made ("method: {force: bond}\ncracks: [{from: [-0.1, 0.5], to: [1, 0.5]}]\n");
    gradient_fit *fit;
    const double *d = r.state->d;
    (void) state;
    fill (&r, opening);
    check_ok (gradient_fit_create (&fit, r.problem, r.state));
    for (int k = 0; k < PLACES; k++) {
        double a = acos (-1) * (2 * (k + 0.5) / PLACES - 1), R = 0.3, H[9],
               x[2] = { 1 + R * cos (a), 0.5 + R * sin (a) }, size = 0.5 / sqrt (R);
        assert_true (gradient_fit_at (fit, x, 1, &d, NULL, H) > 0);
        double error = fmax (fabs (H[2] + size * sin (a / 2)), fabs (H[3] - size * cos (a / 2)));
        assert_true (error < (fabs (a) < 2.6 ? 0.02 : 0.08) * size);
    }
    gradient_fit_free (&fit);
    clear (&r);
}

/* All bonds dead but those along rows: no gradient, and it says so. */
static void points_on_a_line_have_none (void **state)
{
    run r = prepare (1, lattice);
    const pg_problem *p = r.problem;
    const pg_rows *rows = &p->bonds.rows[PG_NODES];
    gradient_fit *fit;
    const double *d = r.state->d, x[2] = { 1.05, 0.55 };
    double H[9];
    (void) state;
    for (size_t i = 0; i < rows->n; i++)
        for (size_t e = rows->family.start[i]; e < rows->family.start[i + 1]; e++)
            if (fabs (p->cloud.x[2 * i + 1] - p->cloud.x[2 * (size_t) rows->family.node[e] + 1]) > 0.01)
                r.state->alive[p->bonds.first[PG_NODES] + e] = 0;
    fill (&r, quadratic);
    check_ok (gradient_fit_create (&fit, p, r.state));
    assert_int_equal (gradient_fit_at (fit, x, 1, &d, NULL, H), 0);
    assert_true (isnan (H[0]) && isnan (H[3]));
    gradient_fit_free (&fit);
    clear (&r);
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (quadratic_fields_are_exact),
                                        cmocka_unit_test (nothing_is_seen_across_a_crack),
                                        cmocka_unit_test (what_nothing_holds_has_no_part),
                                        cmocka_unit_test (the_field_of_a_tip_is_found),
                                        cmocka_unit_test (points_on_a_line_have_none) };
    return cmocka_run_group_tests (tests, NULL, NULL);
}

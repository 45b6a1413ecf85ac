/* SPDX-License-Identifier: GPL-3.0-or-later
 * Closed cracks that grow by sliding (failure.shear_fracture_energy). A strip of half height H, pressed
 * together by p and sheared by the displacement of its upper and lower edge, with a crack along its middle
 * from one end: far ahead the shear stress is tau, far behind the friction mu p, so that the faces there
 * have slipped by 2 H (tau - mu p) / G_s, of which
 *
 *     G = H (tau - mu p)^2 / G_s
 *
 * goes to the tip and the rest into friction (A. C. Palmer, J. R. Rice, The growth of slip surfaces in the
 * progressive failure of over-consolidated clay, Proc. R. Soc. Lond. A 332 (1973) 527-548). */
#include "scene_runs/run.h"

typedef struct { double pressure, friction, unit, perturb, offset; int mirrored; const char *plane; } strip;

enum { EVENTS = 6 };
static const double G_II = 1e-3, shear_modulus = 400;  /* E = 1000, nu = 0.25 */

/* Tension takes so many times G_II. At load factor 1 the strip is sheared by 1 Pa and pressed together by
 * `pressure`. */
static run strip_run (const strip *s, double tension)
{
    /* no strain along x */
    double u = s->unit, h = 0.125 * u, modulus;
    modulus = strcmp (s->plane, "strain") == 0 ? 1200 : 1000 / (1 - 0.0625);
    return scene_of (1,
        "dimension: 2\nplane: %s\nthickness: %.17g\n"
        "body: [{add: {box: {low: [%.17g, %.17g], high: [%.17g, %.17g]}}}]\nspacing: %.17g\nlattice: cells\n"
        "perturb: {amount: %g}\ncracks: [{from: [%.17g, %.17g], to: [%.17g, %.17g]}]\n"
        "materials: {m: {youngs_modulus: 1000, poissons_ratio: 0.25}}\n"
        "contact: {kind: friction, coefficient: %.17g}\n"
        "boundary:\n"
        "  - {set: top, displacement: {x: %.17g, y: %.17g}}\n  - {set: bottom, displacement: {x: 0, y: 0}}\n"
        "failure: {criterion: energy_release, fracture_energy: %.17g, shear_fracture_energy: %.17g}\n"
        "solver: {kind: static, stepping: event, max_events: %d}\noutput: {at: {levels: 1}}\n",
        s->plane, u, -4 * u, -u, 4 * u, u, h, s->perturb, (s->mirrored ? 5 : -5) * u, s->offset * h,
        (s->mirrored ? 1 : -1) * u, s->offset * h, s->friction, (s->mirrored ? -2 : 2) * u / shear_modulus,
        -2 * u * s->pressure / modulus, tension * G_II * u, G_II * u, EVENTS);
}

static void slip_surfaces_grow_as_palmer_and_rice (void **state)
{
    (void) state;
    enum { STRIPS = 4 };
    static const strip strips[STRIPS] = { { 0.5, 0, 1, 0, 0, 0, "stress" },
                                          { 0.5, 0.6, 1, 0, 0.3, 0, "stress" },
                                          { 1, 0.3, 1, 0.2, 0.1, 0, "strain" },
                                          { 0.5, 0.6, 1e-3, 0, 0.3, 1, "stress" } };
    double load[STRIPS][EVENTS] = { { 0 } };
    for (size_t k = 0; k < STRIPS; k++) {
        const strip *p = &strips[k];
        run r = strip_run (p, 100);
        double theory = sqrt (G_II * shear_modulus) / (1 - p->friction * p->pressure), h = 0.125 * p->unit,
               line = r.state->paths->tip[0].x[1], sum = 0;
        int n = 0;
        while (!pg_solver_done (r.solver, r.state)) {
            advance (&r);
            if (r.step.event && n < EVENTS) load[k][n++] = r.step.factor;
        }
        assert_int_equal (n, EVENTS);
        for (n = 1; n < EVENTS; n++) {                 /* steady */
            check_relative (load[k][n], load[k][1], 0.02);
            sum += load[k][n] / (EVENTS - 1);
        }
        const pg_tip *tip = &r.state->paths->tip[0];
        const pg_statistics *s = pg_solver_report (r.solver, r.state);
        print_message ("strip %zu: load %.4f of the exact one, %.1f spacings, %.1g off the line, "
                       "dissipated %.4f, friction %.3g of the work\n", k, sum / theory, tip->grown / h,
                       (tip->x[1] - line) / h,
                       s->energy.dissipated / s->energy.fracture, s->energy.friction / s->energy.external);
        check_relative (sum, theory, 0.035);           /* eight spacings to the half height; found: 3.3 % */
        check_relative (tip->grown, 2 * EVENTS * h, 1e-9);
        check_scaled (tip->x[1], line, 1e-6, h);
        check_relative (s->energy.dissipated, s->energy.fracture, 0.1);
        check_relative (s->energy.fracture, G_II * p->unit * tip->grown * p->unit, 1e-9);
        assert_int_equal (s->contact.open, 0);
        assert_int_equal (s->contact.sliding, s->contact.pieces);
        assert_true (p->friction > 0 ? s->energy.friction > 0.1 * s->energy.external
                                     : fabs (s->energy.friction) < 1e-12 * s->energy.external);
        clear (&r);
    }
    for (int n = 0; n < EVENTS; n++) check_relative (load[3][n], load[1][n], 1e-9);
}

/* A material that takes no more in tension than in sliding: the tip leaves the crack. */
static void the_lesser_energy_decides (void **state)
{
    (void) state;
    strip p = { 0.5, 0.3, 1, 0, 0.2, 0, "stress" };
    static const double energy[] = { 1, 1.5 };         /* K_theta^2 / K_II^2 is 4/3 */
    for (int k = 0; k < 2; k++) {
        run r = strip_run (&p, energy[k]);
        do advance (&r); while (!r.step.event);
        const pg_tip *tip = &r.state->paths->tip[0];
        double turn = asin ((tip->x[1] - 0.2 * 0.125) / tip->grown) * 57.29577951;
        check_scaled (fabs (turn), k ? 0 : 70.53, 0.01, 70);
        clear (&r);
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (slip_surfaces_grow_as_palmer_and_rice),
                                        cmocka_unit_test (the_lesser_energy_decides) };
    return cmocka_run_group_tests (tests, NULL, NULL);
}

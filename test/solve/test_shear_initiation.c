/* SPDX-License-Identifier: GPL-3.0-or-later
 * Cracks that begin in shear under compression (failure.cohesion, friction_angle, shear_fracture_energy;
 * faces in contact). A plate under uniform compression sigma_1 and confinement sigma_3 has a weak place: its
 * strength is Coulomb's line
 *
 *     sigma_1 = (2 c cos phi + sigma_3 (1 + sin phi)) / (1 - sin phi)
 *
 * and the crack lies at 45 degrees - phi/2 to the load. With faces that bear mu p a crack of length 2 a sets
 * free pi a^2 (tau - mu p)^2 / E', which gives its length where it reaches 2 a G_II. */
#include "scene_runs/run.h"

typedef struct {
    double degrees, friction, confinement, unit, turn, perturb;
    const char *plane;
} plate;

enum { WIDE = 36, HIGH = 48 };
static const double E = 1000, nu = 0.25, G_II = 0.0117;

/* Cohesion 1 in a disc of ten spacings, a little less in its middle, where the crack is to begin, and 1.2
 * outside; lengths in `unit`. */
static run plate_run (const plate *p)
{
    double u = p->unit, C = cos (p->turn), S = sin (p->turn), q = p->confinement,
           s[2][3] = { { -q * C * C, -q * S * S, -q * C * S },         /* constant: across the load */
                       { -10 * S * S, -10 * C * C, 10 * C * S } };     /* growing: along it */
    char load[2][600];
    for (int k = 0; k < 2; k++) {
        const char *ramp = k ? "" : ", ramp: constant";
        snprintf (load[k], sizeof load[k],
                  "  - {set: right, traction: {x: %.17g, y: %.17g}%s}\n"
                  "  - {set: left, traction: {x: %.17g, y: %.17g}%s}\n"
                  "  - {set: top, traction: {x: %.17g, y: %.17g}%s}\n"
                  "  - {set: bottom, traction: {x: %.17g, y: %.17g}%s}\n",
                  s[k][0], s[k][2], ramp, -s[k][0], -s[k][2], ramp, s[k][2], s[k][1], ramp, -s[k][2],
                  -s[k][1], ramp);
    }
    return scene_of (1,
        "dimension: 2\nplane: %s\nthickness: %.17g\n"
        "body: [{add: {box: {low: [%.17g, %.17g], high: [%.17g, %.17g]}}}]\nspacing: %.17g\nlattice: cells\n"
        "perturb: {amount: %g}\n"
        "materials:\n  rock: {youngs_modulus: 1000, poissons_ratio: 0.25}\n"
        "  seed: {youngs_modulus: 1000, poissons_ratio: 0.25, failure: {cohesion: 1}}\n"
        "  core: {youngs_modulus: 1000, poissons_ratio: 0.25, failure: {cohesion: 0.99}}\n"
        "blocks:\n  - {material: rock, where: x > -1e6 m}\n"
        "  - {material: seed, where: \"hypot (x, y) < %.17g\"}\n"
        "  - {material: core, where: \"hypot (x, y) < %.17g\"}\n"
        "contact: {kind: %s%.17g}\n"
        "sets: {a: {where: \"x < %.17g and y < %.17g\"}, b: {where: \"x > %.17g and y < %.17g\"}}\n"
        "boundary:\n%s%s  - {set: a, essential: penalty, displacement: {x: 0, y: 0}}\n"
        "  - {set: b, essential: penalty, displacement: {y: 0}}\n"
        "failure: {criterion: energy_release, fracture_energy: %.17g, shear_fracture_energy: %.17g, "
        "cohesion: 1.2, friction_angle: %g deg}\n"
        "solver: {kind: static, stepping: event, max_events: 1}\noutput: {at: {levels: 1}}\n",
        p->plane, u, -WIDE / 2 * u, -HIGH / 2 * u, WIDE / 2 * u, HIGH / 2 * u, u, p->perturb, 10 * u, 1.2 * u,
        p->friction > 0 ? "friction, coefficient: " : "normal} #", p->friction, (1 - WIDE / 2) * u,
        (1 - HIGH / 2) * u, (WIDE / 2 - 1) * u, (1 - HIGH / 2) * u, q > 0 ? load[0] : "", load[1],
        100 * G_II * u, G_II * u, p->degrees);
}

static void new_cracks_follow_coulomb (void **state)
{
    (void) state;
    enum { PLATES = 5 };
    /* angle of friction, its tangent on the faces or less */
    static const plate all[PLATES] = { { 30, 0.57735026918962576, 0, 1, 0, 0, "stress" },
                                       { 30, 0.57735026918962576, 0.8, 1, 0, 0, "stress" },
                                       { 20, 0.2, 0.4, 1e-3, 0.3, 0, "strain" },
                                       { 40, 0.8, 0.8, 1, 0, 0.1, "stress" },
                                       { 0, 0, 0.5, 1, 0, 0, "strain" } };
    int some = longer () ? PLATES : 2;
    for (int k = 0; k < some; k++) {
        const plate *p = &all[k];
        run r = plate_run (p);
        do advance (&r); while (!r.step.event && !pg_solver_done (r.solver, r.state));
        assert_int_equal (r.step.event, 1);
        double phi = p->degrees * acos (-1) / 180,
               line = (2 * cos (phi) + p->confinement * (1 + sin (phi))) / (1 - sin (phi)),
               load = 10 * r.step.factor;
        const pg_crack_paths *paths = r.state->paths;
        assert_int_equal (paths->ntip, 2);
        const double *x = paths->tip[0].x, *y = paths->tip[1].x;
        double length = hypot (y[0] - x[0], y[1] - x[1]) / p->unit,
               angle = atan2 (y[1] - x[1], y[0] - x[0]) - p->turn,     /* from the confined axis */
               off = fabs (remainder (acos (-1) / 2 - angle, acos (-1))) * 180 / acos (-1);
        /* drive on that plane; length of a crack in an infinite plate */
        double radius = 0.5 * (load - p->confinement), mean = 0.5 * (load + p->confinement),
               tau = radius * cos (phi), pressure = mean - radius * sin (phi),
               modulus = strcmp (p->plane, "strain") == 0 ? E / (1 - nu * nu) : E,
               drive = tau - p->friction * pressure,
               theory = 4 * G_II * modulus / (acos (-1) * drive * drive);
        const pg_statistics *s = pg_solver_report (r.solver, r.state);
        print_message ("angle of friction %g, confinement %g: load %.5f of Coulomb's line, %.2f degrees "
                       "to the load, length %.2f (infinite plate %.2f), dissipated %.4f of G_II, "
                       "friction %.3g\n",
                       p->degrees, p->confinement, load / line, off, length, theory,
                       s->energy.dissipated / s->energy.fracture,
                       s->energy.friction / s->energy.dissipated);
        /* stresses on points that were moved differ by one or two per cent from place to place */
        check_relative (load, line, p->perturb > 0 ? 0.02 : 0.001);
        check_scaled (off, 45 - p->degrees / 2, p->perturb > 0 ? 0.005 : 1e-3, 45);
        check_relative (length, theory, 0.2);
        check_relative (s->energy.dissipated, s->energy.fracture, 0.15);
        check_relative (s->energy.fracture, G_II * length * p->unit * p->unit * p->unit, 1e-9);
        assert_int_equal (s->contact.open, 0);
        assert_true (s->contact.sliding > 0);
        assert_true (p->friction > 0 ? s->energy.friction > 0.01 * s->energy.dissipated
                                     : fabs (s->energy.friction) < 1e-12);
        clear (&r);
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (new_cracks_follow_coulomb) };
    return cmocka_run_group_tests (tests, NULL, NULL);
}

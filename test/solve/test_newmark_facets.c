/* SPDX-License-Identifier: GPL-3.0-or-later
 * Cracks that grow in motion while their faces touch (Newmark's method). A slip surface runs through a strip
 * that is pressed together and sheared: it starts at the load of Palmer and Rice (1973), and what is lost is
 * the energy of its facets and friction. A plate that is pressed slowly sends out wings from a closed crack
 * at the load and in the direction of its equilibria. What is stored goes on bit by bit. */
#include "scene_runs/run.h"
#include "tape.h"
#include <string.h>

/* ---- a slip surface ------------------------------------------------------------------------------------ */
/* Half height 1, shear modulus 400, G_II 1e-3, so that a slip surface with friction mu under the pressure p,
 * a share of the shear stress tau, is in balance at tau (1 - mu p) = sqrt (G_II 400). The load rises to 1.1
 * times that, and stays. */
static const char strip[] =
    "dimension: 2\nplane: stress\nbody: [{add: {box: {low: [%g, -1], high: [%g, 1]}}}]\nspacing: 0.125\n"
    "lattice: cells\n%scracks: [{from: [%g, %g], to: [%g, %g]}]\n"
    "materials: {m: {youngs_modulus: 1000, poissons_ratio: 0.25, density: 1 kg/m3}}\n"
    "contact: {kind: friction, coefficient: %g}\n"
    "boundary:\n"
    "  - {set: top, displacement: {x: %.17g, y: %.17g}, table: [[0, 0], [%g, 1], [100, 1]]}\n"
    "  - {set: bottom, displacement: {x: 0, y: 0}}\n"
    "failure: {criterion: energy_release, fracture_energy: 0.1, shear_fracture_energy: 1e-3}\n"
    "solver: {kind: newmark, dt: 0.004, end: %g}\n";
typedef struct { double friction, pressure, from, to, ramp, after, offset; int mirrored; const char *more; }
    rupture;

static run rupture_of (const rupture *p)
{
    double tau = 1.1 * sqrt (1e-3 * 400) / (1 - p->friction * p->pressure),
           down = -2 * p->pressure * tau / (1000 / (1 - 0.0625)), s = p->mirrored ? -1 : 1;
    return scene_of (1, strip, p->mirrored ? -p->to : p->from, p->mirrored ? -p->from : p->to, p->more,
                     s * (p->from - 1), p->offset, s * (p->from + 2), p->offset, p->friction,
                     s * tau * 2 / 400, down, p->ramp, p->ramp + p->after);
}

/* Runs until the surface has passed through, b beside it from the middle on; *start: load over that of the
 * balance when it began. */
static void run_rupture (run *a, run *b, const rupture *p, double *start)
{
    tape t = { 0 };
    int kept = 0;
    double all = p->to - p->from - 2, through = 0, least = 0;
    *start = 0;
    while (!pg_solver_done (a->solver, a->state)) {
        if (kept && through == 0) advance_alike (a, b);
        else advance (a);
        const pg_statistics *r = pg_solver_report (a->solver, a->state);
        double length = a->state->paths->length, lost = r->energy.dissipated;
        if (length == 0) {
            *start = 1.1 * fmin (1, a->state->time / p->ramp);
            assert_true (fabs (lost) <= 1e-9 * r->energy.strain);      /* nothing but friction */
        } else least = fmin (least, lost);
        if (!kept && length >= 0.5 * all) {
            keep (a, &t, 0);
            check_ok (pg_state_copy (b->state, a->state));
            keep (b, &t, 1);
            kept = 1;
        }
        if (through == 0 && length >= all * (1 - 1e-9) && r->energy.fracture >= 1e-3 * all * (1 - 1e-9))
            through = lost;
        else if (through > 0) check_relative (lost, through, 1e-9);
    }
    assert_true (kept && through > 0 && least >= -0.2e-3);
    pg_free (t.byte);
}

static void slip_surfaces_run (void **state)
{
    (void) state;
    static const rupture ruptures[] = { { 0.3, 0.6, -3, 3, 1.5, 0.7, 0.0125, 0, "" },
                                        { 0.3, 0.6, -3, 3, 1.5, 0.7, 0.0125, 1, "" },
                                        { 0.5, 0.6, -4, 4, 3, 1, 0.0125, 0, "" },
                                        { 0, 0.6, -4, 4, 3, 1, 0, 0, "perturb: {amount: 0.1}\n" } };
    double taken[4] = { 0 };
    for (int k = 0; k < (longer () ? 4 : 1); k++) {
        const rupture *p = &ruptures[k];
        run a = rupture_of (p), b = rupture_of (p);
        double start;
        run_rupture (&a, &b, p, &start);
        const pg_statistics *r = pg_solver_report (a.solver, a.state);
        taken[k] = r->energy.dissipated / r->energy.fracture;
        print_message ("mu %g: starts at %.4f of the balance, facets took %.4f of their energy, friction "
                       "%.4e, overlap %.1e spacings (of means %.1e)\n", p->friction, start, taken[k],
                       r->energy.friction, r->contact.overlap_max / 0.125, r->contact.overlap / 0.125);
        assert_true (start >= 1 && start <= 1.08);     /* at rest 1.03; the ramp leaves waves of 3 % */
        assert_true (taken[k] >= 0.9 && taken[k] <= 1.2);
        assert_true (p->friction > 0 ? r->energy.friction > 1e-3 : fabs (r->energy.friction) <= 1e-15);
        assert_true (r->contact.overlap_max <= 1e-3 * 0.125 && r->contact.overlap <= 1e-4 * 0.125);
        /* it goes straight on */
        for (size_t i = 0; i < a.state->paths->ntip; i++)
            check_absolute (a.state->paths->tip[i].x[1], p->offset, 1e-9);
        clear (&a), clear (&b);
    }
    if (longer ()) check_relative (taken[1], taken[0], 1e-6);
}

/* ---- wings --------------------------------------------------------------------------------------------- */
static const char flaw[] =
    "dimension: 2\nplane: stress\nbody: [{add: {box: {low: [-14, -18], high: [14, 18]}}}]\nspacing: 1\n"
    "lattice: cells\nmethod: {tip_offset: 0.7}\ncracks: [{from: [-4.1, -4.3], to: [4.1, 4.3]}]\n"
    "materials: {rock: {youngs_modulus: 1 Pa, poissons_ratio: 0.2, density: 1 kg/m3}}\n"
    "contact: {kind: friction, coefficient: 0.3}\n"
    "failure: {criterion: energy_release, fracture_energy: 1e-6}\n"
    "boundary:\n  - {set: bottom, displacement: {x: 0, y: 0.02}%s}\n"
    "  - {set: top, displacement: {x: 0, y: -0.02}%s}\nsolver: {%s}\n";
static const char gently[] = ", table: [[0, 0], [60, 0.03], [120, 0.12], [180, 0.27], [500, 1.2]]";

static void until_it_grows (run *r)
{
    while (r->state->paths->length == 0) advance (r);
}

static void slow_wings_are_those_of_equilibria (void **state)
{
    (void) state;
    run a = scene_of (1, flaw, gently, gently, "kind: newmark, dt: 1, end: 500"),
        b = scene_of (1, flaw, "", "", "kind: static, stepping: event, max_events: 1");
    until_it_grows (&a), until_it_grows (&b);
    double t = a.state->time, load = 0.27 + (t - 180) / 320 * 0.93;
    print_message ("wings at load %.4f in motion, %.4f at rest\n", load, b.state->factor);
    assert_true (t > 180);
    assert_true (fabs (load / b.state->factor - 1) <= 0.06);
    assert_int_equal (a.state->paths->ntip, b.state->paths->ntip);
    for (size_t i = 0; i < 2; i++)
        for (int k = 0; k < 2; k++)
            check_absolute (a.state->paths->tip[i].x[k], b.state->paths->tip[i].x[k], 0.02);
    clear (&a), clear (&b);
}

/* Mean acceleration of the plate by its own forces is none, with impulses of contact as without. */
static void a_free_plate_keeps_its_momentum (void **state)
{
    (void) state;
    static const char thrown[] =
        "dimension: 2\nplane: stress\nbody: [{add: {box: {low: [-12, -16], high: [12, 16]}}}]\nspacing: 1\n"
        "lattice: cells\nmethod: {tip_offset: 0.7}\nperturb: {amount: 0.1}\n"
        "cracks: [{from: [-4.1, -4.3], to: [4.1, 4.3]}]\n"
        "materials: {rock: {youngs_modulus: 1 Pa, poissons_ratio: 0.2, density: 1 kg/m3}}\n"
        "contact: {kind: friction, coefficient: 0.3}\n"
        "failure: {criterion: energy_release, fracture_energy: 1e-5}\n"
        "solver: {kind: newmark, dt: 0.4, end: 16, linear: cholmod}\n";
    run r = scene_of (1, "%s", thrown);
    void *self;
    const pg_force_type *f = pg_solver_force (r.solver, &self);
    double *mass = pg_calloc (r.state->ndof, sizeof *mass), size = 0;
    check_ok (f->mass (self, mass, NULL));
    for (size_t i = 0; i < r.problem->cloud.n; i++) {
        r.state->v[2*i + 1] = -4e-4 * r.problem->cloud.x[2*i + 1];
        size += mass[2*i + 1] * fabs (r.state->v[2*i + 1]);
    }
    double before[2] = { 0 };
    for (size_t i = 0; i < r.state->ndof; i++) before[i % 2] += mass[i] * r.state->v[i];
    while (!pg_solver_done (r.solver, r.state)) {
        double sum[2] = { 0 };
        advance (&r);
        for (size_t i = 0; i < r.state->ndof; i++) sum[i % 2] += mass[i] * r.state->v[i];
        for (int k = 0; k < 2; k++) check_absolute (sum[k], before[k], 1e-11 * size);
    }
    const pg_statistics *s = pg_solver_report (r.solver, r.state);
    print_message ("grown by %.1f, friction took %.2e, overlap of means %.1e\n", r.state->paths->length,
                   s->energy.friction, s->contact.overlap);
    assert_true (r.state->paths->length > 3.999 && s->energy.friction > 0);
    pg_free (mass);
    clear (&r);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (slip_surfaces_run),
        cmocka_unit_test (slow_wings_are_those_of_equilibria),
        cmocka_unit_test (a_free_plate_keeps_its_momentum),
    };
    return cmocka_run_group_tests_name ("solve/newmark_facets", tests, NULL, NULL);
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * Contact of crack faces in Newmark's method: two bars that collide exchange their velocities in twice the
 * time of a wave, in the plane and in space, momentum and energy are kept; a slowly loaded crack comes to its
 * equilibrium; bonds break around closed faces; what is stored goes on bit by bit. */
#include "scene_runs/run.h"
#include "tape.h"

/* A bar of speed 1 m/s of waves, cut in two; its left half flies. */
enum { LENGTH = 20 };
static const char bars[] =
    "dimension: 2\nplane: stress\nbody: [{add: {box: {low: [-20, 0], high: [20, 3]}}}]\nspacing: 1\n"
    "lattice: cells\nmethod: {integration: %s}\n%s"
    "cracks: [{from: [0, -1], to: [0, 4]}]\n"
    "materials: {light: {youngs_modulus: 1 Pa, poissons_ratio: 0, density: 1 kg/m3}}\n"
    "contact: {kind: %s}\nsolver: {kind: newmark, dt: %g, end: %g, linear: cholmod}\n";

typedef struct { double momentum[2], left, right, energy; } motion;

static motion look (run *r)
{
    motion m = { { 0, 0 }, 0, 0, 0 };
    void *self;
    const pg_force_type *f = pg_solver_force (r->solver, &self);
    double *mass = pg_calloc (r->state->ndof, sizeof *mass), half = 0;
    check_ok (f->mass (self, mass, NULL));
    for (size_t i = 0; i < r->state->ndof; i++) m.momentum[i % 2] += mass[i] * r->state->v[i];
    for (size_t i = 0; i < r->state->ndof; i += 2) {
        if (r->problem->cloud.x[i] < 0) m.left += mass[i] * r->state->v[i], half += mass[i];
        else m.right += mass[i] * r->state->v[i];
    }
    m.left /= half, m.right /= half;
    pg_free (mass);
    return m;
}

/* 1e-3 of the speed of waves, so that gaps and their closing are small. */
static const double speed = 1e-3;

static void throw_left (run *r)
{
    for (size_t i = 0; i < r->state->ndof; i += 2)
        r->state->v[i] = r->problem->cloud.x[i] < 0 ? speed : 0;
}

/* Returns the share of the energy that is lost. */
static double collide (const char *integration, const char *more, const char *kind, double dt)
{
    run r = scene_of (1, bars, integration, more, kind, dt, 70.0);
    throw_left (&r);
    motion start = look (&r), m = start;
    double before = INFINITY, grown = 0, begins = -1, ends = 0, overlap = 0, first = 0, mass = 0;
    start.energy = 0.5 * speed * start.momentum[0];
    mass = start.momentum[0] / speed;
    while (!pg_solver_done (r.solver, r.state)) {
        size_t n;
        double force = 0;
        advance (&r);
        m = look (&r);
        const pg_statistics *report = pg_solver_report (r.solver, r.state);
        m.energy = report->energy.kinetic + report->energy.strain;
        const pg_contact_values *v = pg_solver_contact (r.solver, &n);
        assert_true (n >= 1);
        for (size_t k = 0; k < n; k++) {
            force += v[k].pressure * v[k].area, overlap = fmax (overlap, -v[k].gap);
            assert_true (v[k].pressure >= 0);
        }
        if (force > 0 && begins < 0) begins = r.state->time;
        if (force > 0) ends = r.state->time;
        first += force * dt;
        check_scaled (m.momentum[0], start.momentum[0], 1e-12, start.momentum[0]);
        check_scaled (m.momentum[1], 0, 1e-12, start.momentum[0]);
        grown = fmax (grown, m.energy / fmin (before, start.energy) - 1);
        before = m.energy;
    }
    /* the impulse is what the halves have exchanged */
    check_relative (first, mass * m.right, 1e-9);
    print_message ("%s, dt %g: in touch %.2f to %.2f s (2 L / c = %d), left %.4f, right %.4f, energy lost "
                   "%.1e, grown in a step %.1e, overlap %.1e\n", integration, dt, begins, ends, 2 * LENGTH,
                   m.left / speed, m.right / speed, 1 - m.energy / start.energy, grown, overlap);
    assert_true (grown <= 1e-9);
    assert_true (overlap <= 1e-12 * speed * LENGTH);
    assert_true (fabs (ends - 2 * LENGTH) <= 0.08 * 2 * LENGTH);
    assert_true (fabs (m.left) <= 0.04 * speed && fabs (m.right - speed) <= 0.04 * speed);
    double lost = 1 - m.energy / start.energy;
    clear (&r);
    return lost;
}

static void bars_collide (void **state)
{
    (void) state;
    double last = 1;
    for (double dt = 1; dt >= 0.25; dt /= 2) last = collide ("gauss", "", "normal", dt);
    assert_true (last <= 1e-3);
    collide ("nodal", "", "friction, coefficient: 0.5", 0.5);
    collide ("gauss", "perturb: {amount: 0.1}\n", "normal", 0.5);
}

/* ---- in space ------------------------------------------------------------------------------------------ */
/* The same with bars of ten spacings, oblique faces and friction: three numbers of momentum, energy falls by
 * what friction takes and no more, and means stay apart; by a factor and by iterations, which are as good as
 * their tolerance. */
static const char solids[] =
    "dimension: 3\nbody: [{add: {box: {low: [-10, 0, 0], high: [10, 3, 3]}}}]\nspacing: 1\nlattice: cells\n"
    "cracks: [{polygon: [[%g, -1, -1], [%g, 4, -1], [%g, 4, 4], [%g, -1, 4]]}]\n"
    "materials: {light: {youngs_modulus: 1 Pa, poissons_ratio: 0.2, density: 1 kg/m3}}\n"
    "contact: {kind: %s}\nsolver: {kind: newmark, dt: 0.5, end: 28, linear: %s, tolerance: 1e-11}\n";

static void solids_collide (const char *kind, double oblique, const char *linear)
{
    double a = -0.5 - oblique, b = -0.5 + oblique;
    run r = scene_of (1, solids, a, b, b, a, kind, linear),
        again = scene_of (1, solids, a, b, b, a, kind, linear);
    tape t = { 0 };
    int kept = 0;
    void *self;
    const pg_force_type *f = pg_solver_force (r.solver, &self);
    double *mass = pg_calloc (r.state->ndof, sizeof *mass), start = 0, grown = 0, overlap = 0, parted = 0,
           sum[3], right = 0;
    check_ok (f->mass (self, mass, NULL));
    for (size_t i = 0; i < r.state->ndof; i += 3) {
        const double *x = r.problem->cloud.x + i;
        if (x[0] < -0.5 + oblique * (x[1] - 1.5) / 2.5) r.state->v[i] = speed, start += mass[i] * speed;
    }
    while (!pg_solver_done (r.solver, r.state)) {
        size_t n;
        if (kept) advance_alike (&r, &again);
        else advance (&r);
        const pg_statistics *s = pg_solver_report (r.solver, r.state);
        double energy = s->energy.kinetic + s->energy.strain + s->energy.friction;
        const pg_contact_values *v = pg_solver_contact (r.solver, &n);
        assert_true (n >= 2);
        for (size_t k = 0; k < n; k++) {
            overlap = fmax (overlap, -v[k].gap), parted = fmax (parted, v[k].gap);
            assert_true (v[k].pressure >= 0);
        }
        memset (sum, 0, sizeof sum);
        for (size_t i = 0; i < r.state->ndof; i++) sum[i % 3] += mass[i] * r.state->v[i];
        for (int c = 0; c < 3; c++) check_absolute (sum[c], c ? 0 : start, 1e-9 * start);
        grown = fmax (grown, fabs (energy / (0.5 * speed * start) - 1));
        if (kept || r.state->time < 4 || r.state->time > 9) continue;
        keep (&r, &t, 0);
        check_ok (pg_state_copy (again.state, r.state));
        keep (&again, &t, 1);
        kept = 1;
    }
    for (size_t i = 0; i < r.state->ndof; i += 3)
        if (r.problem->cloud.x[i] > 2) right = fmax (right, r.state->v[i]);
    double friction = pg_solver_report (r.solver, r.state)->energy.friction / (0.5 * speed * start);
    print_message ("in space, %s, %s, oblique by %g: energy and friction off by %.1e, friction took %.1e, "
                   "overlap of means %.1e, apart by %.2e\n", kind, linear, oblique, grown, friction, overlap,
                   parted);
    assert_true (grown <= 1e-9);
    assert_true (overlap <= 1e-9 * speed && parted > 0.1 * speed && right > 0.5 * speed);
    assert_true (strstr (kind, "friction") && oblique > 0 ? friction > 1e-4 : fabs (friction) <= 1e-10);
    pg_free (mass), pg_free (t.byte);
    clear (&r), clear (&again);
}

static void bars_collide_in_space (void **state)
{
    (void) state;
    solids_collide ("normal", 0, "cholmod");
    solids_collide ("friction, coefficient: 0.2", 1, "pcg");
}

/* ---- slowly -------------------------------------------------------------------------------------------- */
static const char flaw[] =
    "dimension: 2\nplane: %s\nbody: [{add: {box: {low: [-10, -10], high: [10, 10]}}}]\nspacing: 1\n"
    "lattice: cells\nmethod: {tip_offset: 0.7}\ncracks: [{from: [-4.1, -3.3], to: [4.1, 3.3]}]\n"
    "materials: {rock: {youngs_modulus: 1 Pa, poissons_ratio: 0.25, density: 1 kg/m3}}\n"
    "contact: {kind: friction, coefficient: %g}\n"
    "boundary:\n  - {set: bottom, displacement: {x: 0, y: 0}}\n"
    "  - {set: top, displacement: {x: 0, y: -1e-3}%s}\nsolver: {%s}\n";
static const char slowly[] = "kind: newmark, dt: 4, end: 1200, rayleigh: {mass: 0.05}";

static void a_slow_crack_comes_to_its_equilibrium (void **state)
{
    (void) state;
    const double coefficient[3] = { 0, 0.3, 2 };
    for (int k = 0; k < 3; k++) {
        const char *plane = k == 1 ? "strain" : "stress";
        run a = scene_of (1, flaw, plane, coefficient[k],
                          ", table: [[0, 0], [900, 1], [1200, 1]]", slowly),
            b = scene_of (1, flaw, plane, coefficient[k], "", "kind: static, stepping: fixed, steps: 1");
        to_the_end (&a), to_the_end (&b);
        size_t n, m, sticks = 0;
        const pg_contact_values *v = pg_solver_contact (a.solver, &n), *w = pg_solver_contact (b.solver, &m);
        double pressure = 0, slip = 0, off[2] = { 0, 0 };
        assert_true (n == m && n >= 4);
        for (size_t i = 0; i < n; i++) {
            pressure = fmax (pressure, w[i].pressure), slip = fmax (slip, fabs (w[i].slip[0]));
            off[0] = fmax (off[0], fabs (v[i].pressure - w[i].pressure));
            off[1] = fmax (off[1], fabs (v[i].slip[0] - w[i].slip[0]));
            sticks += v[i].status == PG_CONTACT_STICK;
        }
        double taken = pg_solver_report (a.solver, a.state)->energy.friction,
               rest = pg_solver_report (b.solver, b.state)->energy.friction;
        print_message ("mu %g: pressure off by %.1e, slip by %.1e of %.2e, friction took %.4e (at rest "
                       "%.4e)\n", coefficient[k], off[0] / pressure, off[1] / fmax (slip, 1e-300), slip,
                       taken, rest);
        assert_true (off[0] <= 0.01 * pressure);
        assert_true (k == 2 ? sticks == n && slip <= 1e-12 : off[1] <= 0.01 * slip);
        assert_true (k == 1 ? taken > 0 : fabs (taken) <= 1e-20);
        clear (&a), clear (&b);
    }
}

/* ---- bonds that break ---------------------------------------------------------------------------------- */
/* A plate with a closed crack, pressed fast until bonds break around it. */
static const char breaking[] =
    "dimension: 2\nplane: stress\nbody: [{add: {box: {low: [-7, -7], high: [7, 7]}}}]\nspacing: 1\n"
    "lattice: cells\ncracks: [{from: [-3.1, -2.3], to: [3.1, 2.3]}]\n"
    "materials: {rock: {youngs_modulus: 1 Pa, poissons_ratio: 0.25, density: 1 kg/m3}}\n"
    "failure: {criterion: mohr_coulomb, tensile_strength: 3e-4 Pa, cohesion: 3e-3 Pa, "
    "friction_angle: 30 deg, exclude: [top, bottom]}\ncontact: {kind: friction, coefficient: 0.2}\n"
    "boundary:\n  - {set: bottom, displacement: {x: 0, y: 0}}\n"
    "  - {set: top, displacement: {x: 0, y: -0.03}}\n"
    "solver: {kind: newmark, dt: %g, end: 60, rayleigh: {stiffness: 0.1}, tolerance: 1e-11, plain: %s}\n";

/* Bonds break in steps with contact: the means stay apart, momentum and energy are accounted for, by all
 * shortcuts as without any; a run that is resumed among breaking bonds is the same. PERIGAL_TEST_SIZE=long:
 * until more have broken. */
static void bonds_break_around_closed_faces (void **state)
{
    (void) state;
    const size_t most = longer () ? 150 : 60;
    for (int k = 0; k < 2; k++) {
        double dt = k ? 0.25 : 2;                      /* by the diagonal; by a factor */
        run a = scene_of (1, breaking, dt, "false"), b = scene_of (1, breaking, dt, "true"),
            c = scene_of (1, breaking, dt, "false");
        tape t = { 0 };
        size_t broken = 0, closed = 0, n;
        double overlap = 0;
        int kept = 0;
        while (!pg_solver_done (a.solver, a.state) && broken < most) {
            if (kept) advance_alike (&a, &c);
            else advance (&a);
            advance (&b);
            assert_int_equal (a.step.nbroken, b.step.nbroken);
            for (size_t i = 0; i < a.step.nbroken; i++)
                assert_int_equal (a.step.broken[i].bond, b.step.broken[i].bond);
            broken += a.step.nbroken;
            const pg_contact_values *v = pg_solver_contact (a.solver, &n);
            for (size_t i = 0; i < n; i++) {
                overlap = fmax (overlap, -v[i].gap), closed += v[i].pressure > 0;
                assert_true (v[i].pressure >= 0 && isfinite (v[i].slip[0]));
            }
            if (broken < 20 || kept) continue;
            keep (&a, &t, 0);
            check_ok (pg_state_copy (c.state, a.state));
            keep (&c, &t, 1);
            kept = 1;
        }
        const pg_statistics *r = pg_solver_report (a.solver, a.state),
                            *s = pg_solver_report (b.solver, b.state);
        print_message ("dt %g: %zu bonds, %zu times closed, overlap of means %.1e, friction took %.3e\n", dt,
                       broken, closed, overlap, r->energy.friction);
        assert_true (broken >= 2 * most / 3 && closed > 10 && kept && r->energy.friction > 0);
        assert_true (overlap <= 1e-12 * 0.03);
        check_relative (r->energy.friction, s->energy.friction, 1e-6);
        check_relative (r->energy.strain, s->energy.strain, 1e-6);
        pg_free (t.byte);
        clear (&a), clear (&b), clear (&c);
    }
}

/* ---- kept ---------------------------------------------------------------------------------------------- */
static void a_run_goes_on_bit_by_bit (void **state)
{
    (void) state;
    const char *load = ", table: [[0, 0], [40, 1], [1200, -1]]";
    run a = scene_of (1, flaw, "stress", 0.3, load, slowly),
        b = scene_of (1, flaw, "stress", 0.3, load, slowly);
    tape t = { 0 };
    for (int k = 0; k < 12; k++) advance (&a);
    keep (&a, &t, 0);
    check_ok (pg_state_copy (b.state, a.state));
    keep (&b, &t, 1);
    for (int k = 0; k < 12; k++) {
        size_t n, m;
        advance_alike (&a, &b);
        assert_memory_equal (a.state->v, b.state->v, a.state->ndof * sizeof *a.state->v);
        assert_memory_equal (a.state->a, b.state->a, a.state->ndof * sizeof *a.state->a);
        const pg_contact_values *v = pg_solver_contact (a.solver, &n), *w = pg_solver_contact (b.solver, &m);
        assert_true (n == m && v[0].pressure == w[0].pressure && v[0].slip[0] == w[0].slip[0]);
    }
    assert_true (pg_solver_report (a.solver, a.state)->energy.friction
                 == pg_solver_report (b.solver, b.state)->energy.friction);
    pg_free (t.byte);
    clear (&a), clear (&b);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (bars_collide),
        cmocka_unit_test (bars_collide_in_space),
        cmocka_unit_test (a_slow_crack_comes_to_its_equilibrium),
        cmocka_unit_test (bonds_break_around_closed_faces),
        cmocka_unit_test (a_run_goes_on_bit_by_bit),
    };
    return cmocka_run_group_tests_name ("solve/newmark_contact", tests, NULL, NULL);
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * Several threads: a scene of every force, integration and solver gives the same bits as with one, and (make
 * test MODE=tsan) no two threads touch the same memory unordered. Four threads whatever the machine has;
 * bodies large enough that loops are shared out. */
#include "scene_runs/run.h"

#define PLATE \
    "dimension: 2\nplane: stress\nthickness: 1 mm\nbody: [{add: {box: {low: [0, 0], high: [14 mm, 16 " \
    "mm]}}}]\nspacing: 1 mm\n%s\n" \
    "cracks: [{from: [-1 mm, 8 mm], to: [5 mm, 8 mm]}]\nmaterials: {glass: {youngs_modulus: 72 GPa, " \
    "poissons_ratio: %s, density: 2440 kg/m3}}\nmethod: {%s}\n" \
    "failure: {criterion: %s}\nsets: {up: {where: y > 13 mm}, down: {where: y < 3 mm}}\nboundary: [{set: " \
    "down, displacement: {x: 0, y: 0}}, {set: up, displacement: {%s}}]\n" \
    "solver: {%s}\noutput: {at: {levels: 2}}\n"
#define STRETCH "stretch, critical_stretch: 4e-4, exclude: [up, down]"

typedef struct { const char *name, *lattice, *poisson, *method, *criterion, *solver; } plan;
static const char third[] = "0.333333333333333", cells[] = "lattice: cells",
                  moved[] = "perturb: {amount: 0.2}";
static const plan plans[] = {
    { "bond, static", cells, third, "force: bond, horizon: 2.5 spacing", STRETCH,
      "kind: static, stepping: event, max_events: 4" },
    { "bond, verlet by stencil", cells, third, "force: bond, horizon: 2.5 spacing, evaluation: stencil",
      STRETCH, "kind: verlet, end: 2 us" },
    { "bond, central by list", moved, third, "force: bond, horizon: 2.5 spacing, stretch: finite", STRETCH,
      "kind: central, end: 2 us" },
    { "fcbm, verlet by transforms", cells, third, "force: fcbm, horizon: 2.5 spacing",
      "node_energy, fracture_energy: 1 J/m2, exclude: [up, down]", "kind: verlet, end: 2 us" },
    { "fcbm, relax", cells, third, "force: fcbm, horizon: 2.5 spacing",
      "node_energy, fracture_energy: 1 J/m2, exclude: [up, down]", "kind: relax" },
    { "lps, verlet by stencil", cells, "0.2", "force: lps, horizon: 2.5 spacing", STRETCH,
      "kind: verlet, end: 2 us" },
    { "lps, verlet by list, live volumes", moved, "0.2",
      "force: lps, horizon: 2.5 spacing, weighted_volume: live", STRETCH, "kind: verlet, end: 2 us" },
    { "lps, verlet by transforms", cells, "0.2", "force: lps, horizon: 2.5 spacing, evaluation: fft", STRETCH,
      "kind: verlet, end: 2 us" },
    { "lps, static by conjugate gradients", cells, "0.2", "force: lps, horizon: 2.5 spacing", STRETCH,
      "kind: static, linear: pcg, stepping: event, max_events: 3" },
    { "gmpd, verlet by stencil", cells, "0.2", "force: gmpd, horizon: 2.5 spacing",
      "beam_limits, fracture_energy: 1 J/m2, exclude: [up, down]", "kind: verlet, end: 2 us" },
    { "gmpd, adr by list", moved, "0.2", "force: gmpd, horizon: 2.5 spacing",
      "beam_limits, fracture_energy: 1 J/m2, exclude: [up, down]", "kind: adr" },
    { "gmpd with dilatation, newmark", cells, "0.25",
      "force: gmpd, volumetric: on, bond_poisson: 0.1, horizon: 2.5 spacing",
      "beam_limits, fracture_energy: 1 J/m2, exclude: [up, down]",
      "kind: newmark, linear: pcg, dt: 0.2 us, end: 1 us" },
    { "rkpm, gauss, static", "", "0.2", "approximation: rkpm, integration: gauss",
      "principal_stress, tensile_strength: 40 MPa, exclude: [up, down]",
      "kind: static, stepping: event, max_events: 4" },
    { "rkpm, consistent, newmark", "", "0.2", "approximation: rkpm, integration: consistent",
      "principal_stress, tensile_strength: 40 MPa, exclude: [up, down]",
      "kind: newmark, dt: 0.2 us, end: 1 us" },
    { "pddo, nodal, verlet", "", "0.2", "approximation: pddo, integration: nodal, essential: nitsche",
      STRETCH, "kind: verlet, end: 2 us" },
    { "nosb, nodal, static", "", "0.2", "approximation: nosb, integration: nodal", STRETCH,
      "kind: static, stepping: fixed, steps: 2" },
};

static run ended (const plan *p, int threads)
{
    int timed = strstr (p->solver, "end:") != NULL;
    run r = scene_of (threads, PLATE, p->lattice, p->poisson, p->method, p->criterion,
                      timed ? "x: 0, y: '20 um * t / (1 us)'" : "x: 0, y: 20 um", p->solver);
    to_the_end (&r);
    return r;
}

static void four_threads_give_the_bits_of_one (void **state)
{
    (void) state;
    for (size_t k = 0; k < sizeof plans / sizeof *plans; k++) {
        run one = ended (&plans[k], 1), four = ended (&plans[k], 4);
        printf ("# %s: %ld bonds broken\n", plans[k].name, one.state->broken);
        assert_true (one.problem->cloud.n >= 200 && one.state->broken > 0);
        assert_int_equal (one.state->broken, four.state->broken);
        assert_memory_equal (one.state->d, four.state->d, one.state->ndof * sizeof (double));
        assert_memory_equal (one.state->alive, four.state->alive, one.state->nbond);
        int components;
        static const char *const names[] = { "stress", "damage" };
        for (int f = 0; f < 2; f++) {
            double *a = field_of (&one, NULL, names[f], &components),
                   *b = field_of (&four, NULL, names[f], &components);
            assert_memory_equal (a, b, one.problem->cloud.n * (size_t) components * sizeof *a);
            pg_free (a), pg_free (b);
        }
        clear (&one), clear (&four);
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (four_threads_give_the_bits_of_one) };
    return cmocka_run_group_tests_name ("mechanics/force/threads", tests, NULL, NULL);
}

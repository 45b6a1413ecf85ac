/* SPDX-License-Identifier: GPL-3.0-or-later
 * Forces and moments balance in every way of stepping: explicit, relaxed, by Newmark's method and its form
 * with alpha, with damping, with platens and contact, with supports by elimination, penalty and Nitsche's
 * method: to ten times what the solver of the run leaves unbalanced, and to 1e-10 of the forces with a
 * direct one. */
#include "scene_runs/run.h"
#include <math.h>

#define DISK "body: [{add: {disk: {center: [0.03, 0.02], radius: 1}}}]\nspacing: 0.2\n" \
             "lattice_offset: [0.3, 0.1]\n"
#define ALIGNED "body: [{add: {box: {low: [0, 0], high: [2, 1]}}}]\nspacing: 0.2\n"
#define BOX ALIGNED "lattice_offset: [0.3, 0.1]\n"
#define HELD "{set: left, displacement: {x: 0, y: 0}"
#define PULLED "{set: right, traction: {x: 3, y: -2}}"
#define PULL "boundary: [" HELD "}, " PULLED "]\n"
#define SWUNG "boundary: [{set: left, displacement: {x: 0, y: 0.1 * t}}, {name: g, gravity: [0, -10]}]\n"
#define DIRECT "kind: static, linear: cholmod"
#define NEWMARK "kind: newmark, dt: 0.02, end: 0.2, tolerance: 1e-12"

typedef struct { const char *name, *body, *method, *boundary, *solver; double allowed; } way;

static const way ways[] = {
    { "static, Nitsche", BOX, "", PULL, DIRECT, 1e-10 },
    { "static, Nitsche, aligned", ALIGNED, "integration: consistent", PULL, DIRECT, 1e-10 },
    { "static, penalty", BOX, "", "boundary: [" HELD ", essential: penalty}, " PULLED "]\n", DIRECT, 1e-7 },
    { "static, transformation", BOX, "",
      "boundary: [" HELD ", essential: transformation}, " PULLED "]\n", DIRECT, 1e-10 },
    { "bonds", BOX, "force: bond", PULL, DIRECT, 1e-10 },
    { "micropolar bonds", BOX, "force: gmpd", PULL, DIRECT, 1e-10 },
    { "Newmark, damped, shape functions", DISK, "",
      "boundary: [{name: g, gravity: [0, -10]}, {set: disk.rim, traction: {x: 1, y: 2}}]\n",
      NEWMARK ", rayleigh: {mass: 0.3, stiffness: 0.01}", 1e-9 },
    { "Newmark, supports by Nitsche", BOX, "", SWUNG, NEWMARK, 1e-9 },
    { "Newmark, bonds held", BOX, "force: bond", SWUNG,
      NEWMARK ", rayleigh: {mass: 0.3, stiffness: 0.01}", 1e-9 },
    { "alpha, shape functions", BOX, "", SWUNG, NEWMARK ", alpha: -0.1", 1e-9 },
    { "alpha, bonds held, damped", BOX, "force: bond", SWUNG,
      NEWMARK ", alpha: -0.1, rayleigh: {mass: 0.3, stiffness: 0.01}", 1e-9 },
    { "verlet, bonds held, damped", BOX, "force: bond", SWUNG, "kind: verlet, end: 0.05, rayleigh: {mass: 3}",
      1e-10 },
    { "verlet, states held", BOX, "force: lps", SWUNG, "kind: verlet, end: 0.05", 1e-10 },
    { "central differences, shape functions", BOX, "",
      "boundary: [" PULLED ", {name: g, gravity: [0, -10]}]\n",
      "kind: central, end: 0.05, rayleigh: {mass: 3}", 1e-10 },
    { "adr", BOX, "force: bond", PULL, "kind: adr", 1e-2 },
    { "relax", BOX, "force: bond", PULL, "kind: relax", 1e-2 },
    { "rough platens",
      "body: [{add: {box: {low: [-1, 0], high: [1, 2]}}}]\nspacing: 0.2\nlattice: cells\n", "",
      "platens:\n  - {name: foot, point: [0, 0], normal: [0, 1], friction: 0.2}\n"
      "  - {name: head, point: [0, 2], normal: [0, -1], friction: 0.2, force: {y: -100}, tilt: free}\n",
      DIRECT, 1e-9 },
    { "closed crack",
      BOX "cracks: [{from: [0.8, 0.3], to: [1.3, 0.7]}]\ncontact: {kind: friction, coefficient: 0.3}\n", "",
      "boundary: [" HELD "}, {set: right, traction: {x: -30, y: -2}}]\n", DIRECT, 1e-9 },
    { "states, a load that returns to zero",
      BOX "cracks: [{from: [-0.1, 0.47], to: [2.1, 0.47]}]\ncontact: {kind: normal}\n", "force: lps",
      "boundary: [{set: left, displacement: {x: 0}}, {set: bottom, displacement: {y: 0}}, "
      "{set: top, displacement: {y: -1e-3}, table: [[0, 0], [0.5, 1], [1, -1]]}]\n",
      "stepping: fixed, steps: 4", 1e-7 },
};

static void balanced (const run *r, const char *name, double limit)
{
    const pg_statistics *s = pg_solver_report (r->solver, r->state);
    double allowed = pg_balance_allowed (s, r->problem);
    print_message ("  %-40s forces %.1e, moments %.1e of %.1e, %ld states\n", name, s->balance.force,
                   s->balance.moment, allowed, s->balance.states);
    assert_true (s->balance.states > 0);
    check_below (fmax (s->balance.force, s->balance.moment), allowed);
    check_below (fmax (s->balance.force, s->balance.moment), limit);
    for (size_t k = 0; k < s->nwarning; k++) assert_null (strstr (s->warning[k], "miss balance"));
}

static void every_way_of_stepping_balances (void **state)
{
    (void) state;
    for (size_t k = 0; k < sizeof ways / sizeof *ways; k++) {
        const way *w = &ways[k];
        run r = scene_of (1, "dimension: 2\n%s"
                             "materials: {m: {youngs_modulus: 1e6, poissons_ratio: 0.3, density: 1000}}\n"
                             "method: {%s}\n%ssolver: {%s}\noutput: {at: {levels: 2}}\n",
                          w->body, w->method, w->boundary, w->solver);
        to_the_end (&r);
        balanced (&r, w->name, w->allowed);
        clear (&r);
    }
}

/* A body that is free to expand bears no load at all: what its solver leaves is measured by the forces that
 * would hold it. */
static void free_strains_balance (void **state)
{
    (void) state;
    run r = scene_of (1, "dimension: 3\nspacing: 0.2\n"
                         "body: [{add: {box: {low: [0, 0, 0], high: [1, 1, 1]}}}]\n"
                         "materials: {m: {youngs_modulus: 1e9, poissons_ratio: 0.2, expansion: 1e-5}}\n"
                         "boundary: [{set: left, displacement: {x: 0}}, {set: bottom, displacement: {y: 0}}, "
                         "{set: back, displacement: {z: 0}}, {name: warmer, temperature: 100 K}]\n"
                         "solver: {stepping: fixed, steps: 2}\noutput: {at: {levels: 1}}\n");
    to_the_end (&r);
    balanced (&r, "free strains", 1e-8);
    clear (&r);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (every_way_of_stepping_balances),
        cmocka_unit_test (free_strains_balance),
    };
    return cmocka_run_group_tests_name ("solve/balance", tests, NULL, NULL);
}

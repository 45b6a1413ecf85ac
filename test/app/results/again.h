/* SPDX-License-Identifier: GPL-3.0-or-later
 * again.h: small runs that are stopped at some moment with a checkpoint, and go on from it. */
#ifndef PERIGAL_TEST_AGAIN_H
#define PERIGAL_TEST_AGAIN_H
#include "folder.h"
#include <glob.h>

#define BODY \
    "dimension: 2\nthickness: 0.1\nbody: [{add: {box: {low: [0, 0], high: [0.6, 0.5]}}}]\nspacing: 0.1\n" \
    "cracks: [{from: [-0.1, 0.25], to: [0.15, 0.25]}]\nmaterials: {rock: {youngs_modulus: 1 GPa, " \
    "poissons_ratio: 0.2, density: 2000}}\n" \
    "failure: {criterion: stretch, critical_stretch: 1e-3, exclude: [bottom, top]}\n"
#define PULL \
    "boundary: [{name: foot, set: bottom, displacement: {x: 0, y: 0}}, {name: head, set: top, " \
    "displacement: {y: 2 mm}}]\n"
#define FACETS \
    "dimension: 2\nthickness: 0.1\nbody: [{add: {box: {low: [0, 0], high: [1, 0.9]}}}]\nspacing: 0.05\n" \
    "cracks: [{from: [-0.1, 0.46], to: [0.43, 0.43]}]\nmaterials: {rock: {youngs_modulus: 1 GPa, " \
    "poissons_ratio: 0.2, density: 2000}}\nfailure: {fracture_energy: 400 J/m2}\n"
#define CLOSED_FLAW \
    "dimension: 2\nthickness: 0.1\nbody: [{add: {box: {low: [0, 0], high: [1, 1.2]}}}]\nspacing: 0.05\n" \
    "cracks: [{from: [0.33, 0.41], to: [0.67, 0.76]}]\nmaterials: {rock: {youngs_modulus: 1 GPa, " \
    "poissons_ratio: 0.2, density: 2000}}\nfailure: {fracture_energy: 4 J/m2}\n" \
    "contact: {kind: friction, coefficient: 0.2}\n"
#define WINGS \
    CLOSED_FLAW "boundary: [{name: foot, set: bottom, displacement: {x: 0, y: 0}}, " \
                "{name: head, set: top, displacement: {y: -1 mm}}]\n"
/* whole: nothing is looked at within a step, as an event is one */
static const struct { const char *name, *text; int whole;
} scenes[] = {
    { "event", BODY PULL
      "solver: {stepping: event}\noutput: {pictures: [], at: {levels: 4, events: 3, broken: 10 %}}\n", 1 },
    { "fixed", BODY PULL
      "solver: {stepping: fixed, steps: 3}\noutput: {pictures: [], at: {levels: 2, broken: 4 %}}\n", 0 },
    { "transformation", BODY PULL "method: {essential: transformation}\nsolver: {stepping: fixed, steps: 3, "
                                  "stop: {set: right}}\noutput: {pictures: [], at: {broken: 4 %}}\n", 0 },
    { "nodal", BODY PULL
      "method: {approximation: nosb, integration: nodal, horizon: 2.5 spacing, essential: penalty}\n"
      "solver: {stepping: fixed, steps: 3, break: fraction, break_fraction: 5 %}\noutput: {pictures: [], at: "
      "{broken: 4 %}}\n", 0 },
    { "newmark", BODY "boundary: [{set: bottom, velocity: {x: 0, y: -4 m/s}}, {set: top, velocity: {y: 4 "
                      "m/s}, table: [[0, 0], [1e-3, 1]]}]\n"
                      "method: {essential: transformation}\nsolver: {kind: newmark, dt: 0.1 ms, end: 1 ms, "
                      "rayleigh: {stiffness: 1 us}, break: fraction, break_fraction: 5 %}\n"
                      "output: {pictures: [], at: {levels: 5, broken: 4 %}}\n", 0 },
    { "multilevel",
      "dimension: 2\nthickness: 0.1\nbody: [{add: {box: {low: [0, 0], high: [0.8, 0.9]}}}]\nspacing: 0.1\n"
      "materials: {rock: {youngs_modulus: 1e9, poissons_ratio: 0.3333, density: 2500}}\ncracks: [{from: "
      "[-0.1, 0.45], to: [0.22, 0.45]}]\n"
      "failure: {criterion: stretch, critical_stretch: 1e-3, exclude: [bottom, top]}\nmethod: {force: "
      "bond}\n" PULL "solver: {stepping: event, linear: pcg, max_events: 16}\noutput: {at: {levels: 4, "
                     "broken: 2 %}, pictures: []}\n", 1 },
    { "facets", FACETS PULL "solver: {stepping: event, max_events: 9}\n"
                            "output: {pictures: [], at: {levels: 4, events: 3, broken: 10 %}}\n", 1 },
    { "facets_fixed", FACETS PULL "solver: {stepping: fixed, steps: 4}\n"
                                  "output: {pictures: [], at: {levels: 2, broken: 4 %}}\n", 0 },
    { "fronts", "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [8, 5, 6]}}}]\nspacing: 1\n"
                "perturb: {amount: 0.2}\ncracks: [{polygon: [[-1, -1, 3.1], [3, -1, 3.1], [3, 6, 2.9], "
                "[-1, 6, 2.9]]}]\nmaterials: {rock: {youngs_modulus: 1 GPa, poissons_ratio: 0.2}}\n"
                "failure: {criterion: energy_release, fracture_energy: 400 J/m2}\n"
                "boundary: [{set: back, displacement: {x: 0, y: 0, z: 0}}, {set: front, displacement: "
                "{x: 2 mm, z: 10 mm}}]\nsolver: {stepping: event, max_events: 4}\n"
                "output: {pictures: [], at: {levels: 4, events: 3, broken: 10 %}}\n", 1 },
    { "wings", WINGS "solver: {stepping: event, max_events: 6}\n"
                     "output: {pictures: [], at: {levels: 4, events: 3, broken: 10 %}}\n", 1 },
    { "wings_fixed", WINGS "solver: {stepping: fixed, steps: 4}\n"
                           "output: {pictures: [], at: {levels: 2, broken: 4 %}}\n", 0 },
    { "wings_confined",
      CLOSED_FLAW "sets: {mantle: {boundary: [left, right]}}\nboundary: [{name: foot, set: bottom, "
                  "displacement: {x: 0, y: 0}}, {name: jacket, set: mantle, pressure: 20 kPa}, "
                  "{name: head, set: top, traction: {y: -0.8 MPa}}]\nstages: [{name: confine, boundary: "
                  "{jacket: 1}}, {name: compress, boundary: {head: 1}}]\n"
                  "solver: {stepping: event, max_events: 4}\n"
                  "output: {pictures: [], at: {levels: 4, events: 3, broken: 10 %}}\n", 1 },
    { "platens",
      "dimension: 2\nthickness: 0.1\nbody: [{add: {box: {low: [0, 0], high: [1, 0.6]}}}]\nspacing: 0.1\n"
      "materials: {rock: {youngs_modulus: 1 GPa, poissons_ratio: 0.2, density: 2000}}\nplatens: "
      "[{name: anvil, shape: plane, point: [0.5, 0], normal: [0, 1], friction: 0.3}, {name: die, "
      "shape: cylinder, point: [0.5, 1.1], radius: 0.5, friction: 0.2, displacement: {y: -4 mm}}]\n"
      "solver: {stepping: fixed, steps: 6}\n"
      "output: {pictures: [], at: {levels: 3}}\n", 1 },
    { "drying", BODY
      "boundary: [{name: foot, set: bottom, displacement: {x: 0, y: 0}}, {name: head, set: top, spring: "
      "{all: 1 MN/m}, spring_end: {y: 2 mm}}, {shrinkage: 2e-3 * (1 + y / 1 m)}]\n"
      "solver: {stepping: fixed, steps: 3}\noutput: {pictures: [], at: {levels: 2, broken: 4 %}}\n", 0 }
};
enum { SCENES = sizeof scenes / sizeof *scenes };

/* left: looks until it stops; negative: it stops after this step; looks: how many there were */
typedef struct { pg_result *result; pg_state *state; long left, looks; int within; } visit;

static inline pg_status look (void *context, const pg_state *state, const pg_step *so_far)
{
    visit *v = context;
    pg_status status = pg_result_stage (v->result, state, so_far);
    v->looks++;
    if (status == PG_OK && v->left > 0 && --v->left == 0)
        v->within = 1, status = pg_error (PG_E_INTERRUPTED, PG_HERE, "a test");
    return status;
}

/* Steps until it is done or the `left`-th look at it (between rounds, after steps). 1: it was stopped. */
static inline int go (run *r, visit *v)
{
    v->state = r->state, v->within = 0;
    pg_solver_watch (r->solver, look, v);
    while (!pg_solver_done (r->solver, r->state)) {
        pg_status status = pg_solver_step (r->solver, r->state, &r->step);
        if (v->within) return 1;
        check_ok (status);
        check_ok (pg_result_step (v->result, r->state, &r->step));
        v->looks++;
        if (v->left == -r->state->step || (v->left > 0 && --v->left == 0)) return 1;
    }
    check_ok (pg_result_finish (v->result, r->state, NULL, 0, 0));
    return 0;
}

/* Stops at the k-th look, leaves a checkpoint and a little more than it knows of. 0: the run was over
 * before. *looks: how many there were. */
static inline int stop_after (const char *text, const char *where, long k, long *looks)
{
    run r = prepare (1, text);
    visit v = { .left = k };
    check_ok (pg_result_discard (where));
    check_ok (pg_result_open (&v.result, where, r.scene, r.problem, r.solver));
    int stopped = go (&r, &v);
    *looks = v.looks;
    if (stopped) {
        check_ok (pg_result_checkpoint (v.result, r.state));
        check_ok (pg_result_finish (v.result, r.state, "stopped", 0, 0));
    }
    pg_result_free (&v.result);
    clear (&r);
    return stopped;
}

static inline int stop_at (const char *text, const char *where, long k)
{
    long looks;
    return stop_after (text, where, k, &looks);
}

static inline pg_status resume (const char *text, const char *where, run *r, visit *v, pg_resumed *from)
{
    *r = prepare (1, text);
    *v = (visit) { 0 };
    return pg_result_resume (&v->result, where, r->scene, r->problem, r->solver, r->state, from);
}

/* Both folders have the same files of fields with the same bytes. */
static inline void same_fields (const char *a, const char *b)
{
    glob_t one, other;
    char path[200];
    snprintf (path, sizeof path, "%s/result*", a);
    assert_int_equal (glob (path, 0, NULL, &one), 0);
    snprintf (path, sizeof path, "%s/result*", b);
    assert_int_equal (glob (path, 0, NULL, &other), 0);
    assert_int_equal (one.gl_pathc, other.gl_pathc);
    for (size_t k = 0; k < one.gl_pathc; k++) {
        long n = size_of (one.gl_pathv[k]);
        assert_string_equal (strrchr (one.gl_pathv[k], '/'), strrchr (other.gl_pathv[k], '/'));
        assert_int_equal (n, size_of (other.gl_pathv[k]));
        char *x = slurp (one.gl_pathv[k]), *y = slurp (other.gl_pathv[k]);
        assert_memory_equal (x, y, (size_t) n);
        pg_free (x), pg_free (y);
    }
    globfree (&one), globfree (&other);
}
#endif

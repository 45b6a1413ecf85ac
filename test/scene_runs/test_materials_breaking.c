/* SPDX-License-Identifier: GPL-3.0-or-later
 * What breaks when a body is made of two materials: a bond between them by the weaker of both laws, a weak
 * layer alone, never the one that is told never to; and two names for one material change nothing. */
#include "run.h"

enum { LEFT, RIGHT };                                  /* materials by their place */

typedef struct { const char *criterion, *left, *right; } laws;
typedef struct { double *utilisation, *factor; char *kind; } shown;

static run body_of (int dim, const char *criterion, const char *left, const char *right,
                    const char *integration)
{
    static const char *const box[] = { "low: [0], high: [1]", "low: [0, 0], high: [1, 0.5]",
                                       "low: [0, 0, 0], high: [1, 0.4, 0.4]" };
    static const double spacing[] = { 0.02, 0.05, 0.1 };
    return scene_of (1,
                     "dimension: %d\nbody: [{add: {box: {%s}}}]\nspacing: %g\nmaterials:\n"
                     "  left: {youngs_modulus: 10 GPa, poissons_ratio: 0.2, failure: {%s}}\n  right: "
                     "{youngs_modulus: 10 GPa, poissons_ratio: 0.2, failure: {%s}}\n"
                     "blocks: [{material: left, where: x < 0.43}, {material: right, where: x >= 0.43}]\n"
                     "failure: {%s}\nmethod: {approximation: rkpm, integration: %s, horizon: 2.2 spacing}\n"
                     "boundary: [{set: left, displacement: {x: 0}}, {set: right, displacement: {x: 1 mm}}]\n"
                     "solver: {stepping: fixed, steps: 1}\noutput: {at: {levels: 1}}\n",
                     dim, box[dim - 1], spacing[dim - 1], left, right, criterion, integration);
}

/* What every bond shows under the same displacement, a stretch with a wave on it */
static shown show (run *r)
{
    void *self;
    const pg_force_type *force = pg_solver_force (r->solver, &self);
    size_t dim = (size_t) r->problem->dim, n = r->state->nbond;
    shown s = { pg_calloc (n, sizeof (double)), pg_calloc (n, sizeof (double)), pg_calloc (n, 1) };
    double *d = pg_calloc (r->state->ndof, sizeof *d);
    for (size_t i = 0; i < r->state->ndof; i++) {
        const double *x = r->problem->cloud.x + i / dim * dim;
        d[i] = 1e-3
               * (x[0] * (i % dim == 0) + 0.5 * sin (9 * x[0] + 5 * x[dim - 1] + 2 * (double) (i % dim)));
    }
    refresh (r, NULL);
    check_ok (force->judge (self, r->state, d,
                          &(pg_judging){ .utilisation = s.utilisation, .kind = s.kind, .factor = s.factor }));
    pg_free (d);
    return s;
}

static void hide (shown *s) { pg_free (s->utilisation), pg_free (s->factor), pg_free (s->kind); }

/* both: each law must be the weaker one somewhere */
static void check_mixed (int dim, const laws *l, const char *integration, int both)
{
    run mixed = body_of (dim, l->criterion, l->left, l->right, integration);
    run pure[2] = { body_of (dim, l->criterion, l->left, l->left, integration),
                    body_of (dim, l->criterion, l->right, l->right, integration) };
    shown s = show (&mixed), one[2] = { show (&pure[LEFT]), show (&pure[RIGHT]) };
    const pg_problem *p = mixed.problem;
    size_t across = 0, decided[2] = { 0 };
    for (int set = 0; set < PG_BOND_SETS; set++)
        for (size_t q = 0; q < p->bonds.rows[set].n; q++)
            for (size_t e = p->bonds.rows[set].family.start[q]; e < p->bonds.rows[set].family.start[q + 1];
                 e++) {
                size_t b = p->bonds.first[set] + e;
                int end[2] = { p->block[set][q], p->block[PG_NODES][p->bonds.rows[set].family.node[e]] };
                int weaker = one[end[0]].utilisation[b] > one[end[1]].utilisation[b] ? end[0] : end[1];
                assert_true (s.utilisation[b] == one[weaker].utilisation[b]);
                assert_true (s.factor[b] == fmin (one[end[0]].factor[b], one[end[1]].factor[b]));
                if (end[0] == end[1] || one[LEFT].utilisation[b] == one[RIGHT].utilisation[b]) continue;
                across++, decided[weaker]++;
                assert_int_equal (s.kind[b], one[weaker].kind[b]);
            }
    print_message ("%dD, %s: %zu bonds across, by the law on the left %zu, on the right %zu\n", dim,
                   integration, across, decided[LEFT], decided[RIGHT]);
    assert_true (across > 2 && (!both || (decided[LEFT] && decided[RIGHT])));
    hide (&s), hide (&one[LEFT]), hide (&one[RIGHT]);
    clear (&mixed), clear (&pure[LEFT]), clear (&pure[RIGHT]);
}

static void the_weaker_law_of_both_ends_decides (void **state)
{
    (void) state;
    static const laws all[] = {
        { "criterion: stretch", "critical_stretch: 1e-3", "critical_stretch: 2e-3" },
        { "criterion: stretch, stretch: finite", "critical_stretch: 3e-3", "critical_stretch: 2e-3" },
        { "criterion: principal_stress, tensile_strength: 5 MPa", "tensile_strength: 3 MPa", "" },
        { "criterion: mohr_coulomb, friction_angle: 30 deg", "tensile_strength: 2 MPa, cohesion: 90 MPa",
          "tensile_strength: 60 MPa, cohesion: 2.1 MPa" }
    };
    for (int dim = 1; dim <= 3; dim++)
        for (size_t k = 0; k < 4; k++)
            for (int nodal = 0; nodal < 2; nodal++)
                check_mixed (dim, &all[k], nodal ? "nodal" : "gauss", k == 3 && dim > 1);
}

/* ---- runs ---------------------------------------------------------------------------------------------- */
/* A plate pulled along x, with a layer across it; `layer`, `rest`: what their maps of materials say beyond
 * the elastic constants. */
static run plate_run (int dim, double modulus, const char *layer, const char *rest)
{
    static const char *const box[] = { "low: [0], high: [1]", "low: [0, 0], high: [1, 0.4]",
                                       "low: [0, 0, 0], high: [1, 0.2, 0.2]" };
    run r = scene_of (
        1,
        "dimension: %d\nbody: [{add: {box: {%s}}}]\nspacing: %g\nmaterials:\n"
        "  rest: {youngs_modulus: 10 GPa, poissons_ratio: 0.2%s}\n  layer: {youngs_modulus: %g, "
        "poissons_ratio: 0.2%s}\n"
        "blocks: [{material: rest, where: x >= 0}, {material: layer, where: x > 0.45 and x < 0.65}]\n"
        "failure: {criterion: principal_stress, tensile_strength: 4 MPa}\nmethod: {approximation: rkpm, "
        "integration: gauss, horizon: 2 spacing}\n"
        "boundary: [{set: left, displacement: {x: 0%s}}, {set: right, displacement: {x: 1 mm}}]\n"
        "solver: {stepping: event, max_events: 60}\noutput: {at: {levels: 1}}\n",
        dim, box[dim - 1], dim == 1 ? 0.02 : 0.1, rest, modulus, layer,
        dim == 1   ? ""
        : dim == 2 ? ", y: 0"
                   : ", y: 0, z: 0");
    return r;
}

/* Broken bonds by the number of their ends in the layer; all of a run. */
static void break_plate (run *r, size_t broken[3])
{
    const pg_problem *p = r->problem;
    memset (broken, 0, 3 * sizeof *broken);
    while (!pg_solver_done (r->solver, r->state)) {
        advance (r);
        for (size_t k = 0; k < r->step.nbroken; k++) {
            int set;
            size_t point;
            pg_problem_locate (p, r->step.broken[k].bond, &set, &point);
            int node = p->bonds.rows[set].family.node[r->step.broken[k].bond - p->bonds.first[set]];
            broken[p->block[set][point] + p->block[PG_NODES][node]]++;
        }
    }
}

static void cracks_stay_in_a_weak_layer (void **state)
{
    (void) state;
    for (int dim = 1; dim <= 3; dim++) {
        size_t broken[3];
        run r = plate_run (dim, 10e9, ", failure: {tensile_strength: 2 MPa}", "");
        break_plate (&r, broken);
        print_message ("%dD: broken within the layer %zu, at its faces %zu, outside %zu\n", dim, broken[2],
                       broken[1], broken[0]);
        assert_true (broken[2] > 0);
        assert_int_equal (broken[0], 0);
        clear (&r);
    }
}

/* The layer is the softer part of a bar under one stress, but the weaker material is outside. */
static void cracks_stay_out_of_a_strong_layer (void **state)
{
    (void) state;
    size_t broken[3];
    run r = plate_run (2, 5e9, ", failure: {tensile_strength: 400 MPa}", "");
    break_plate (&r, broken);
    assert_true (broken[0] > 0);
    assert_int_equal (broken[2], 0);
    clear (&r);
}

static void what_never_breaks_stays_whole (void **state)
{
    (void) state;
    for (int dim = 1; dim <= 3; dim++) {
        size_t broken[3];
        run r = plate_run (dim, 10e9, "", ", failure: {never: on}");
        break_plate (&r, broken);
        assert_true (broken[2] > 0);
        assert_int_equal (broken[0] + broken[1], 0);
        clear (&r);
        r = plate_run (dim, 10e9, ", failure: {never: on}", ", failure: {never: on}");
        break_plate (&r, broken);
        assert_int_equal (broken[0] + broken[1] + broken[2], 0);
        clear (&r);
    }
}

static void one_material_under_two_names_changes_nothing (void **state)
{
    (void) state;
    run two = plate_run (2, 10e9, ", failure: {tensile_strength: 4 MPa}", "");
    run one = scene_of (
        1, "dimension: 2\nbody: [{add: {box: {low: [0, 0], high: [1, 0.4]}}}]\nspacing: 0.1\n"
           "materials: {rock: {youngs_modulus: 10 GPa, poissons_ratio: 0.2}}\n"
           "failure: {criterion: principal_stress, tensile_strength: 4 MPa}\nmethod: {approximation: rkpm, "
           "integration: gauss, horizon: 2 spacing}\n"
           "boundary: [{set: left, displacement: {x: 0, y: 0}}, {set: right, displacement: {x: 1 mm}}]\n"
           "solver: {stepping: event, max_events: 60}\noutput: {at: {levels: 1}}\n");
    to_the_end (&two), to_the_end (&one);
    assert_true (one.state->broken > 0);
    assert_int_equal (one.state->nbond, two.state->nbond);
    assert_memory_equal (one.state->alive, two.state->alive, one.state->nbond);
    assert_memory_equal (one.state->d, two.state->d, one.state->ndof * sizeof *one.state->d);
    clear (&two), clear (&one);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (the_weaker_law_of_both_ends_decides),
        cmocka_unit_test (cracks_stay_in_a_weak_layer),
        cmocka_unit_test (cracks_stay_out_of_a_strong_layer),
        cmocka_unit_test (what_never_breaks_stays_whole),
        cmocka_unit_test (one_material_under_two_names_changes_nothing),
    };
    return cmocka_run_group_tests_name ("scene_runs/materials_breaking", tests, NULL, NULL);
}

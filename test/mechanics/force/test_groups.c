/* SPDX-License-Identifier: GPL-3.0-or-later
 * Some bonds looked at alone, and all others for many displacements at once, against a plain look at all
 * bonds: for each way to integrate, criteria of stretch and of stress, several materials, two and three
 * dimensions, after bonds have died. */
#include "scene_runs/run.h"
#include <math.h>
#include <string.h>

#define TWO "dimension: 2\nplane: %s\nbody: [{add: {box: {low: [0, 0], high: [9, 7]}}}]\nspacing: 1\n" \
    "perturb: {amount: 0.15}\nmaterials:\n  a: {youngs_modulus: 10 GPa, poissons_ratio: 0.25}\n" \
    "  b: {youngs_modulus: 30 GPa, poissons_ratio: 0.2%s}\n" \
    "blocks: [{material: a, where: x <= 4.5}, {material: b, where: x > 4.5}]\n"
#define THREE "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [5, 4, 4]}}}]\nspacing: 1\n" \
    "materials: {a: {youngs_modulus: 10 GPa, poissons_ratio: 0.25}}\n"

/* Numbers that follow no pattern, between -1 and 1. */
static double some (size_t i) { return sin (12.9898 * (double) i + 78.233 * cos ((double) i)); }

static double most (const double *a, size_t n)
{
    double top = 0;
    for (size_t i = 0; i < n; i++) top = fmax (top, a[i]);
    return top;
}

enum { COUNT = 5 };

/* The plain look at displacement k of the block, and the two others. dead: above it bonds are broken, by
 * numbers between -1 and 1 without a pattern. */
static void compare (const char *text, double dead)
{
    run r = prepare (1, text);
    void *self;
    const pg_force_type *f = pg_solver_force (r.solver, &self);
    size_t n = r.state->ndof, nbond = r.state->nbond, dim = (size_t) r.problem->dim;
    double *block = pg_calloc (n * COUNT, sizeof *block), *d = pg_calloc (n, sizeof *d),
           *u = pg_calloc (nbond, sizeof *u), *factor = pg_calloc (nbond, sizeof *factor), top[COUNT];
    unsigned char *left_out = pg_calloc (nbond, 1);
    char *kind = pg_calloc (nbond, 1), *kind_of = pg_calloc (nbond, 1);
    for (size_t i = 0; i < nbond; i++) if (some (i) > dead) r.state->alive[i] = 0;
    check_ok (f->refresh (self, r.state, NULL));
    const pg_operator *op = f->operator_ (self);       /* a product finds the points that are alike */
    op->apply (op->context, d, block);
    for (size_t i = 0; i < n; i++)
        for (size_t k = 0; k < COUNT; k++)
            block[i * COUNT + k] = 1e-3 * (r.problem->cloud.x[i] * (i % dim == k % dim) + some (i + 7 * k));
    pg_bond_group group = { 0 };
    group.bond = pg_calloc (nbond, sizeof *group.bond);
    for (size_t i = 0; i < nbond; i++)
        if (some (i / 9 + 5) > 0.5) left_out[i] = 1, group.bond[group.n++] = i;
    assert_true (group.n > 10 && group.n < nbond / 2);
    int can;
    check_ok (f->spares.gather (self, &group, &can));
    assert_true (can && group.nnode <= r.problem->cloud.n);
    double *gu = pg_calloc (group.n, sizeof *gu), *gf = pg_calloc (group.n, sizeof *gf);
    check_ok (f->judge (self, r.state, block,
                        &(pg_judging){ .count = COUNT, .left_out = left_out, .of_unit = 1, .top = top }));
    for (size_t k = 0; k < COUNT; k++) {
        for (size_t i = 0; i < n; i++) d[i] = block[i * COUNT + k];
        check_ok (f->judge (self, r.state, d,
                            &(pg_judging){ .utilisation = u, .kind = kind, .factor = factor }));
        double others = 0, all = most (u, nbond);
        for (size_t i = 0; i < nbond; i++) if (!left_out[i]) others = fmax (others, 1 / factor[i]);
        assert_true (others > 0 && fabs (top[k] - others) <= 1e-12 * all);
        for (size_t i = 0; i < group.nnode; i++)       /* what it must not read */
            for (size_t c = 0; c < dim; c++) d[(size_t) group.node[i] * dim + c] += 1;
        for (size_t i = 0; i < n; i++) d[i] = d[i] > 0.5 ? d[i] - 1 : NAN;
        for (size_t i = 0; i < group.nnode; i++)
            for (size_t c = 0; c < dim; c++)
                d[(size_t) group.node[i] * dim + c] = block[((size_t) group.node[i] * dim + c) * COUNT + k];
        check_ok (f->judge (self, r.state, d,
                         &(pg_judging){ .group = &group, .utilisation = gu, .kind = kind_of, .factor = gf }));
        for (size_t i = 0; i < group.n; i++) {
            size_t b = group.bond[i];
            assert_true (gu[i] == u[b] && gf[i] == factor[b]);
            if (gu[i] > 0) assert_int_equal (kind_of[i], kind[b]);
        }
    }
    check_ok (f->judge (self, r.state, block,
                        &(pg_judging){ .count = COUNT, .left_out = left_out, .top = top }));
    for (size_t i = 0; i < n; i++) d[i] = block[i * COUNT + 2];
    check_ok (f->judge (self, r.state, d, &(pg_judging){ .utilisation = u }));
    double others = 0;
    for (size_t i = 0; i < nbond; i++) if (!left_out[i]) others = fmax (others, u[i]);
    assert_true (fabs (top[2] - others) <= 1e-12 * most (u, nbond));
    pg_bond_group_clear (&group);
    pg_free (block), pg_free (d), pg_free (u), pg_free (factor), pg_free (left_out), pg_free (kind);
    pg_free (kind_of), pg_free (gu), pg_free (gf);
    clear (&r);
}

#define REST "boundary: [{set: left, displacement: {x: 0, y: 0}}, {set: right, displacement: {x: 1 mm}}]\n" \
    "solver: {kind: static, stepping: event}\nfailure: {criterion: %s}\nmethod: {%s}\n"

static void in_the_plane (void **state)
{
    (void) state;
    static const char *const law[] = {
        "stretch, critical_stretch: 1e-3", "stretch, critical_stretch: 1e-3, stretch: finite",
        "principal_stress, tensile_strength: 3 MPa",
        "mohr_coulomb, tensile_strength: 3 MPa, cohesion: 4 MPa, friction_angle: 30 deg"
    };
    static const char *const way[] = { "integration: gauss", "approximation: nosb, integration: nodal",
                                       "integration: consistent" };
    static const char *const own[] = { ", failure: {critical_stretch: 5e-4}", "",
                                       ", failure: {tensile_strength: 1 MPa}", "" };
    char text[4096];
    for (size_t i = 0; i < 4; i++)
        for (size_t k = 0; k < 3; k++) {
            snprintf (text, sizeof text, TWO REST, i % 2 ? "stress" : "strain", own[i], law[i], way[k]);
            compare (text, 0.9);
        }
}

static void in_space (void **state)
{
    (void) state;
    static const char *const law[] = { "stretch, critical_stretch: 1e-3",
                                       "mohr_coulomb, tensile_strength: 3 MPa, cohesion: 4 MPa, "
                                       "friction_angle: 30 deg" };
    char text[4096];
    for (size_t i = 0; i < 2; i++) {
        snprintf (text, sizeof text, THREE REST, law[i], "integration: gauss");
        compare (text, 0.9);
    }
}

#define LATTICE "sets: {held: {where: x < 1 mm}}\n" \
    "boundary: [{set: held, displacement: {x: 0, y: 0}}]\nsolver: {kind: static, stepping: event}\n" \
    "failure: {criterion: %s}\nmethod: {%s}\n"

/* On lattices a look at all measures points of equal rows many at a time, one at the group one by one: the
 * same bits, whole and with some broken bonds, for laws of stretch, which displacements of points enter, and
 * of stress. */
static void in_a_lattice (void **state)
{
    (void) state;
    static const char *const body[] = {
        "dimension: 2\nplane: strain\nbody: [{add: {box: {low: [0, 0], high: [4.1, 1.9]}}}]\nspacing: 0.1\n"
        "materials: {a: {youngs_modulus: 10 GPa, poissons_ratio: 0.25}}\n",
        "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [1.9, 0.6, 0.5]}}}]\nspacing: 0.1\n"
        "materials: {a: {youngs_modulus: 10 GPa, poissons_ratio: 0.25}}\n",
        "dimension: 3\nbody: [{add: {cylinder: {center: [0, 0, 0], axis: [0, 0, 1], length: 10 mm, diameter: "
        "40 mm}}}]\nspacing: 2 mm\ncells: staircase\n"
        "materials: {a: {youngs_modulus: 10 GPa, poissons_ratio: 0.25}}\n",
    };
    static const char *const law[] = { "stretch, critical_stretch: 1e-3",
                                       "principal_stress, tensile_strength: 3 MPa" };
    static const char *const way[] = { "approximation: rkpm, integration: gauss, horizon: 2 spacing",
                                       "approximation: pddo, integration: nodal, horizon: 2 spacing" };
    static const double dead[] = { 2, 0.99999 };
    char text[4096];
    for (size_t i = 0; i < 6; i++)
        for (size_t k = 0; k < 4; k++) {
            snprintf (text, sizeof text, "%s" LATTICE, body[i % 3], law[k % 2], way[i / 3]);
            compare (text, dead[k / 2]);
        }
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (in_the_plane), cmocka_unit_test (in_space),
                                        cmocka_unit_test (in_a_lattice) };
    return cmocka_run_group_tests (tests, NULL, NULL);
}

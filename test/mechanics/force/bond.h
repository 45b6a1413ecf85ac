/* SPDX-License-Identifier: GPL-3.0-or-later
 * bond.h: a problem of bonds from text with its force and state; random displacements; what every such force
 * must bear. */
#ifndef PERIGAL_TEST_BOND_H
#define PERIGAL_TEST_BOND_H
#include "check.h"
#include "perigal/force.h"

#define BODY2 BODY2_OF ("0.3333333333")
#define BODY3 BODY3_OF ("0.25")
#define BODY2_OF(nu) \
    "dimension: 2\nplane: stress\nbody: [{add: {box: {low: [0, 0], high: [1, 0.7]}}}]\nspacing: " \
    "0.1\nthickness: 0.2\n" \
    "materials: {rock: {youngs_modulus: 10, poissons_ratio: " nu ", density: 3}}\n"
#define BODY3_OF(nu) \
    "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [0.6, 0.5, 0.4]}}}]\nspacing: 0.1\n" \
    "materials: {rock: {youngs_modulus: 10, poissons_ratio: " nu ", density: 3}}\n"
#define BODY1 \
    "dimension: 1\ncross_section: 0.3\nbody: [{add: {box: {low: [0], high: [2]}}}]\nspacing: 0.1\n" \
    "materials: {rock: {youngs_modulus: 10, poissons_ratio: 0, density: 3}}\n"

typedef struct {
    pg_scene *scene; pg_problem *problem; pg_state *state;
    const pg_force_type *force; void *self;
    size_t n, ndof, dim, stride;                       /* stride: unknowns of a point */
} bonded;

static inline bonded bonded_with (const char *text, int threads, size_t nset, const char *const *set)
{
    bonded b = { 0 };
    check_ok (pg_scene_parse_with (&b.scene, text, "test.yaml", nset, set));
    check_ok (pg_problem_build (&b.problem, b.scene, threads));
    b.force = pg_force_of (b.problem);
    check_ok (pg_state_create (&b.state, b.problem, pg_problem_unknowns (b.problem)));
    check_ok (b.force->create (&b.self, b.problem));
    check_ok (b.force->refresh (b.self, b.state, NULL));
    b.n = b.problem->cloud.n, b.dim = (size_t) b.problem->dim,
    b.stride = b.dim + (size_t) pg_problem_rotations (b.problem),
    b.ndof = b.n * b.stride;
    return b;
}
static inline bonded bonded_of (const char *text) { return bonded_with (text, 1, 0, NULL); }

static inline void unbonded (bonded *b)
{
    b->force->free (&b->self);
    pg_state_free (&b->state);
    pg_problem_free (&b->problem);
    pg_scene_free (&b->scene);
}

static inline double any (unsigned *seed)
{
    return (double) ((*seed = *seed * 1664525u + 1013904223u) >> 8) / 8388608.0 - 1;
}
static inline double *random_vector (size_t n, unsigned seed)
{
    double *x = pg_calloc (n, sizeof *x);
    for (size_t i = 0; i < n; i++) x[i] = any (&seed);
    return x;
}
static inline double size_of (size_t n, const double *x)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++) sum += x[i] * x[i];
    return sqrt (sum);
}
static inline double product (size_t n, const double *a, const double *b)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++) sum += a[i] * b[i];
    return sum;
}
/* u = H x, the points turning with it: unknowns of rotations are spacing times half the curl */
static inline double *linear_field (const bonded *b, const double *H)
{
    double *u = pg_calloc (b->ndof, sizeof *u);
    double h = b->problem->cloud.h;
    for (size_t i = 0; i < b->n; i++) {
        double *own = u + i * b->stride;
        for (size_t a = 0; a < b->dim; a++)
            for (size_t c = 0; c < b->dim; c++)
                own[a] += H[a * b->dim + c] * b->problem->cloud.x[i * b->dim + c];
        if (pg_problem_rotations (b->problem) == 1) own[2] = 0.5 * h * (H[2] - H[1]);
        for (size_t k = 0; pg_problem_rotations (b->problem) == 3 && k < 3; k++) {
            size_t y = (k + 1) % 3, z = (k + 2) % 3;
            own[3 + k] = 0.5 * h * (H[z * 3 + y] - H[y * 3 + z]);
        }
    }
    return u;
}
/* Kills every `nth` bond and its partner; refreshes by the changes. */
static inline pg_changes kill_some (bonded *b, size_t nth)
{
    pg_changes c = { 0 };
    const pg_family *f = &b->problem->bonds.rows[PG_NODES].family;
    c.bond = pg_calloc (b->state->nbond, sizeof *c.bond);
    for (size_t i = 0; i < b->n; i++)
        for (size_t e = f->start[i]; e < f->start[i + 1]; e++) {
            size_t j = (size_t) f->node[e], low = i < j ? i : j, high = i < j ? j : i;
            if ((low * 31 + high * 17) % nth) continue;
            if (b->state->alive[e]) c.bond[c.n++] = e;
            b->state->alive[e] = 0;
        }
    check_ok (b->force->refresh (b->self, b->state, &c));
    return c;
}
/* The largest overlap of the faces of broken bonds, m. */
static inline double overlap_of (const bonded *b, const double *d)
{
    double overlap = NAN;
    check_ok (b->force->judge (b->self, b->state, d, &(pg_judging){ .overlap = &overlap }));
    return overlap;
}
/* Largest eigenfrequency of K x = omega^2 M x, rad/s, by power iteration: from below */
static inline double largest_frequency (bonded *b)
{
    double *x = random_vector (b->ndof, 11), *y = pg_calloc (b->ndof, sizeof *y),
           *m = pg_calloc (b->ndof, sizeof *m), top = 0;
    const pg_operator *op = b->force->operator_ (b->self);
    check_ok (b->force->mass (b->self, m, NULL));
    for (int it = 0; it < 300; it++) {
        op->apply (op->context, x, y);
        top = 0;
        for (size_t i = 0; i < b->ndof; i++) y[i] /= m[i], top = fmax (top, fabs (y[i]));
        for (size_t i = 0; i < b->ndof; i++) x[i] = y[i] / top;
    }
    pg_free (x), pg_free (y), pg_free (m);
    return sqrt (top);
}
/* Each allocation of making the force and one march fails once: it says so and leaves nothing behind; returns
 * how many calls that took. */
static inline size_t fail_each_allocation (const char *text)
{
    bonded b = bonded_of (text);
    double *d = random_vector (b.ndof, 5), *f = pg_calloc (b.ndof, sizeof *f), reference;
    size_t held = pg_memory_used (), calls = 0;
    pg_changes broken = { 0 };
    for (pg_status now = PG_E_MEMORY; now != PG_OK; calls++) {
        void *self = NULL;
        assert_true (calls < 1000);
        pg_memory_fail_at (calls + 1);
        now = b.force->create (&self, b.problem);
        if (now == PG_OK) now = b.force->motion.balance_and_break (self, 0, d, f, &reference, &broken);
        pg_memory_fail_at (0);
        assert_true (now == PG_OK || now == PG_E_MEMORY);
        if (self) b.force->free (&self);
        pg_free (broken.bond);
        broken = (pg_changes) { 0 };
        assert_int_equal (pg_memory_used (), held);
    }
    pg_free (d), pg_free (f);
    unbonded (&b);
    return calls;
}
/* The scene is wrong, and says so in these words among others. */
static inline void check_problem_refused (const char *text, const char *words)
{
    pg_scene *scene;
    pg_problem *problem = NULL;
    check_ok (pg_scene_parse_with (&scene, text, "test.yaml", 0, NULL));
    check_fails (pg_problem_build (&problem, scene, 1), PG_E_SCENE);
    check_contains (pg_last_error (), words);
    pg_problem_free (&problem), pg_scene_free (&scene);
}
#endif

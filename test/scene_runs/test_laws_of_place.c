/* SPDX-License-Identifier: GPL-3.0-or-later
 * Stiffness and limits as expressions of place: two values by a step are two blocks, for every force; graded
 * bars in closed form; the weakest place breaks first; fields of a seed. */
#include "run.h"

static const struct {
    const char *method, *limits, *criterion;
    int lowest;
} forces[] = {
    { "force: galerkin, approximation: rkpm, integration: gauss, horizon: 2.2 spacing", "tensile_strength",
      "principal_stress", 1 },
    { "force: galerkin, approximation: rkpm, integration: nodal, horizon: 2.2 spacing", "tensile_strength",
      "principal_stress", 1 },
    { "force: galerkin, approximation: rkpm, integration: consistent, horizon: 2.2 spacing",
      "fracture_energy", "stretch", 2 },
    { "force: galerkin, approximation: rkpm, integration: gauss, horizon: 2.2 spacing", "critical_stretch",
      "stretch", 1 },
    { "force: bond", "fracture_energy", "stretch", 1 },
    { "force: bond", "fracture_energy", "node_energy", 2 },
    { "force: lps", "fracture_energy", "stretch", 2 },
    { "force: gmpd", "fracture_energy", "beam_limits", 2 },
};
static const char *const two[][3] = { { "fracture_energy", "40 J/m2", "30 J/m2" },
                                      { "tensile_strength", "3 MPa", "4 MPa" },
                                      { "critical_stretch", "1e-3", "2e-3" } };
enum { FORCES = sizeof forces / sizeof *forces };

/* `place`: the right part has the stiffness 10 GPa + 20 GPa and the limit a + b, by a step at x = 0.43; else
 * by blocks. */
static run strip (int dim, size_t f, int place)
{
    static const char *const box[] = { "low: [0], high: [1]", "low: [0, 0], high: [1, 0.4]",
                                       "low: [0, 0, 0], high: [1, 0.4, 0.4]" };
    static const double spacing[] = { 0.02, 0.05, 0.1 };
    char text[2000];
    size_t l = 0;
    while (strcmp (two[l][0], forces[f].limits) != 0) l++;
    if (place)
        snprintf (text, sizeof text,
                  "materials:\n"
                  "  rock: {youngs_modulus: 10 GPa + 20 GPa * step (x - 0.43), poissons_ratio: 0.2}\n"
                  "failure: {criterion: %s, %s: %s + %s * step (x - 0.43)}\n",
                  forces[f].criterion, two[l][0], two[l][1], two[l][2]);
    else
        snprintf (text, sizeof text,
                  "materials:\n  left: {youngs_modulus: 10 GPa, poissons_ratio: 0.2}\n"
                  "  right: {youngs_modulus: 30 GPa, poissons_ratio: 0.2, failure: {%s: %g%s}}\n"
                  "blocks: [{material: left, where: x < 0.43}, {material: right, where: x >= 0.43}]\n"
                  "failure: {criterion: %s, %s: %s}\n",
                  two[l][0], atof (two[l][1]) + atof (two[l][2]), l == 0 ? " J/m2" : l == 1 ? " MPa" : "",
                  forces[f].criterion, two[l][0], two[l][1]);
    return scene_of (1,
                     "dimension: %d\nbody: [{add: {box: {%s}}}]\nspacing: %g\n%smethod: {%s}\n"
                     "boundary:\n  - {set: left, displacement: {x: 0%s}}\n"
                     "  - {set: right, displacement: {x: 1 mm}}\n"
                     "solver: {stepping: fixed, steps: 1, break: worst}\noutput: {at: {levels: 1}}\n",
                     dim, box[dim - 1], spacing[dim - 1], text, forces[f].method,
                     dim == 1 ? "" : dim == 2 ? ", y: 0" : ", y: 0, z: 0");
}

/* Forces under a given displacement, a stretch with a wave on it, and what every bond shows then. */
static double *shown (run *r, double **u)
{
    void *self;
    const pg_force_type *force = pg_solver_force (r->solver, &self);
    size_t dim = (size_t) r->problem->dim, m = r->state->ndof / r->problem->cloud.n;
    double *d = pg_calloc (r->state->ndof, sizeof *d);
    double *value = pg_calloc (r->state->nbond, sizeof *value), size;
    for (size_t i = 0; i < r->problem->cloud.n; i++)
        for (size_t k = 0; k < dim; k++) {
            const double *x = r->problem->cloud.x + i * dim;
            d[i * m + k] = 1e-3 * (x[0] * (k == 0) + 0.5 * sin (9 * x[0] + 5 * x[dim - 1] + 2 * (double) k));
        }
    check_ok (force->refresh (self, r->state, NULL));
    check_ok (force->judge (self, r->state, d, &(pg_judging){ .utilisation = value }));
    *u = pg_calloc (r->state->ndof, sizeof **u);
    check_ok (force->balance (self, 1, d, *u, &size));
    pg_free (d);
    return value;
}

static void two_values_by_a_step_are_two_blocks (void **state)
{
    (void) state;
    for (int dim = 1; dim <= 3; dim++)
        for (size_t f = 0; f < FORCES; f++) {
            if (dim < forces[f].lowest) continue;
            run a = strip (dim, f, 1), b = strip (dim, f, 0);
            double *fa, *fb, *ua = shown (&a, &fa), *ub = shown (&b, &fb);
            assert_int_equal (a.problem->at.nlaw, 2);
            assert_int_equal (a.state->nbond, b.state->nbond);
            double force = largest_difference (fa, fb, a.state->ndof) / largest_of (fb, b.state->ndof),
                   use = largest_difference (ua, ub, a.state->nbond) / largest_of (ub, b.state->nbond);
            print_message ("%dD, %s, %s: forces %.1e, utilisation %.1e\n", dim, forces[f].method,
                           forces[f].criterion, force, use);
            assert_true (force < 1e-13 && use < 1e-13 && largest_of (ub, b.state->nbond) > 0.1);
            pg_free (fa), pg_free (fb), pg_free (ua), pg_free (ub);
            clear (&a), clear (&b);
        }
}

/* ---- closed form --------------------------------------------------------------------------------------- */
/* A bar of E = E0 (1 + x / L) whose ends are held: u = U log (1 + x / L) / log 2. Error of u at the nodes
 * over its largest value; inside: of the ratio of the strains of two parts far from the ends, which are soft
 * where families are cut off. */
static double graded_bar (const char *method, int dim, double spacing, int inside)
{
    run r = scene_of (1,
                      "dimension: %d\n%sbody: [{add: {box: {%s}}}]\nspacing: %g\n"
                      "materials: {rock: {youngs_modulus: 10 GPa * (1 + x / 1 m), poissons_ratio: 0}}\n"
                      "method: {%s}\nboundary: [{set: left, displacement: {x: 0}}, "
                      "{set: right, displacement: {x: 0.1 mm}}%s]\n"
                      "solver: {stepping: fixed, steps: 1}\noutput: {at: {levels: 1}}\n",
                      dim, dim == 2 ? "plane: stress\n" : "",
                      dim == 1 ? "low: [0], high: [1]" : "low: [0, 0], high: [1, 0.2]", spacing, method,
                      dim == 1 ? "" : ", {set: bottom, displacement: {y: 0}}");
    to_the_end (&r);
    double *u = field_of (&r, NULL, "displacement", NULL), worst = 0, near[3] = { 9, 9, 9 }, at[3][2];
    for (size_t i = 0; i < r.problem->cloud.n; i++) {
        double x = r.problem->cloud.x[i * (size_t) dim], own = u[i * (size_t) dim];
        worst = fmax (worst, fabs (own - 1e-4 * log (1 + x) / log (2)));
        for (int k = 0; k < 3; k++)
            if (fabs (x - 0.3 - 0.2 * k) < near[k])
                near[k] = fabs (x - 0.3 - 0.2 * k), at[k][0] = x, at[k][1] = own;
    }
    if (inside)
        worst = fabs ((at[1][1] - at[0][1]) / (at[2][1] - at[1][1]) * log ((1 + at[2][0]) / (1 + at[1][0]))
                      / log ((1 + at[1][0]) / (1 + at[0][0])) - 1) * 1e-4;
    pg_free (u), clear (&r);
    return worst / 1e-4;
}

static void bars_of_rising_stiffness_stretch_as_the_logarithm (void **state)
{
    (void) state;
    static const struct { const char *method; double most, order; int dim, inside; } all[] = {
        { "approximation: rkpm, integration: gauss, horizon: 2.2 spacing", 1e-4, 0.8, 1, 0 },
        { "approximation: rkpm, integration: consistent, horizon: 2.2 spacing", 1e-5, 1.9, 2, 0 },
        { "approximation: rkpm, integration: nodal, horizon: 2.2 spacing", 6e-4, 0.75, 2, 0 },
        { "force: bond, horizon: 3 spacing", 1e-4, 1.9, 1, 1 },
        { "force: lps, horizon: 3 spacing", 5e-4, 1.8, 2, 1 },
    };
    for (size_t k = 0; k < 5; k++) {
        double coarse = graded_bar (all[k].method, all[k].dim, 0.04, all[k].inside),
               fine = graded_bar (all[k].method, all[k].dim, 0.02, all[k].inside);
        print_message ("%s, %dD: %.2e, %.2e, order %.2f\n", all[k].method, all[k].dim, coarse, fine,
                       log2 (coarse / fine));
        assert_true (fine < all[k].most && log2 (coarse / fine) > all[k].order);
    }
}

/* ---- random fields ------------------------------------------------------------------------------------- */
#define WEIBULL "3 MPa * (-log (1 - phi (random_field (2 mm, %d))))^(1/8)"
static run tension (int seed, const char *extra, const char *method)
{
    char strength[200];
    snprintf (strength, sizeof strength, WEIBULL, seed);
    return scene_of (1,
                     "dimension: 2\nbody: [{add: {box: {low: [0, 0], high: [1, 0.5]}}}]\nspacing: 0.025\n"
                     "materials: {rock: {youngs_modulus: 10 GPa, poissons_ratio: 0.2}}\n"
                     "failure: {criterion: principal_stress, tensile_strength: \"%s\"}\n"
                     "method: {%s}\n"
                     "boundary: [{set: left, displacement: {x: 0}}, {set: right, traction: {x: 2 MPa}}, "
                     "{set: bottom, displacement: {y: 0}}]\n"
                     "solver: {stepping: event, max_events: 12%s}\noutput: {at: {levels: 1}}\n",
                     strength, method, extra);
}

static const char gauss[] = "approximation: rkpm, integration: gauss, horizon: 2.2 spacing";

static const char consistent[] = "approximation: rkpm, integration: consistent, horizon: 2.2 spacing";

/* Under uniform stress the weakest point gives the load factor. */
static void the_weakest_place_breaks_first (void **state)
{
    (void) state;
    run r = tension (3, "", consistent);
    const pg_problem *p = r.problem;
    double least = INFINITY;
    for (size_t k = 0; k < p->at.nlimit; k++) {
        double form[2][2];
        p->at.limit[k].type->planes (&p->at.limit[k], form);
        least = fmin (least, 1 / form[0][0]);
    }
    assert_true (p->at.nlimit > 1000);
    advance (&r);
    print_message ("weakest of %zu points %.6g Pa, first event at %.6g\n", p->at.nlimit, least,
                   r.state->factor);
    assert_true (r.step.nbroken > 0 && fabs (r.state->factor * 2e6 / least - 1) < 1e-9);
    clear (&r);
}

/* What is found together, and by bounds, is what is found bond by bond. */
static void shortcuts_break_the_same_bonds (void **state)
{
    (void) state;
    run a = tension (5, "", gauss), b = tension (5, ", plain: on", gauss);
    size_t events = 0;
    while (!pg_solver_done (b.solver, b.state)) {
        advance (&a), advance (&b);
        events += b.step.nbroken > 0;
        assert_int_equal (a.step.nbroken, b.step.nbroken);
        for (size_t k = 0; k < a.step.nbroken; k++)
            assert_int_equal (a.step.broken[k].bond, b.step.broken[k].bond);
        assert_true (fabs (a.state->factor / b.state->factor - 1) < 1e-8);
    }
    print_message ("%zu events\n", events);
    assert_true (events >= 12);
    clear (&a), clear (&b);
}

/* Fixed steps look for the worst bonds by bounds of points; the numbers are those of a look at all. */
static void the_worst_bonds_are_found_by_bounds (void **state)
{
    (void) state;
    run r = tension (7, "", gauss);
    void *self;
    const pg_force_type *force = pg_solver_force (r.solver, &self);
    double *u = pg_calloc (r.state->nbond, sizeof *u), *v = pg_calloc (r.state->nbond, sizeof *v), top,
           most = 0;
    char *kind = pg_calloc (r.state->nbond, 1);
    pg_changes over = { 0 };
    advance (&r);
    check_ok (force->refresh (self, r.state, NULL));
    check_ok (force->judge (self, r.state, r.state->d, &(pg_judging){ .utilisation = u, .kind = kind }));
    for (size_t b = 0; b < r.state->nbond; b++) most = fmax (most, u[b]);
    for (size_t i = 0; i < r.state->ndof; i++) r.state->d[i] *= 1.3 / most;
    check_ok (force->judge (self, r.state, r.state->d, &(pg_judging){ .utilisation = u, .kind = kind }));
    most = 0;
    for (size_t b = 0; b < r.state->nbond; b++) most = fmax (most, u[b]);
    check_ok (force->judge (self, r.state, r.state->d,
                   &(pg_judging){ .utilisation = v, .kind = kind, .over = &over, .from = 1.0, .top = &top }));
    size_t found = 0;
    for (size_t b = 0; b < r.state->nbond; b++) found += u[b] >= 1;
    print_message ("worst %.6g, %zu bonds over their limit\n", top, found);
    assert_true (top == most && top > 1 && over.n == found && found > 0);
    for (size_t k = 0; k < over.n; k++) assert_true (v[over.bond[k]] == u[over.bond[k]]);
    pg_free (u), pg_free (v), pg_free (kind), pg_free (over.bond);
    clear (&r);
}

/* Weibull's distribution of modulus 8 and scale 3 MPa, sampled at points farther apart than the correlation
 * length: mean 3 MPa gamma (9/8); a seed gives the same bits, another one does not. */
static void fields_have_their_distribution_and_seed (void **state)
{
    (void) state;
    run a = tension (11, "", gauss), b = tension (11, "", gauss), c = tension (12, "", gauss);
    const pg_variation *v = &a.problem->at.vary[0];
    double sum = 0, squares = 0, n = (double) a.problem->at.nlimit, form[2][2];
    for (size_t k = 0; k < a.problem->at.nlimit; k++) {
        a.problem->at.limit[k].type->planes (&a.problem->at.limit[k], form);
        sum += 1 / form[0][0], squares += 1 / (form[0][0] * form[0][0]);
    }
    double mean = sum / n, spread = sqrt (squares / n - mean * mean), exact = 3e6 * tgamma (9. / 8),
           deviation = sqrt (9e12 * tgamma (10. / 8) - exact * exact);
    print_message ("%g values: mean %.5g Pa (%.5g), deviation %.4g Pa (%.4g); nodes %.4g, %.4g, %.4g\n", n,
                   mean, exact, spread, deviation, v->least[PG_OF_TENSION], v->mean[PG_OF_TENSION],
                   v->most[PG_OF_TENSION]);
    assert_true (fabs (mean / exact - 1) < 0.02 && fabs (spread / deviation - 1) < 0.1);
    assert_true (v->least[PG_OF_TENSION] < v->mean[PG_OF_TENSION]
                 && v->mean[PG_OF_TENSION] < v->most[PG_OF_TENSION]);
    assert_int_equal (a.problem->at.nlimit, b.problem->at.nlimit);
    assert_memory_equal (a.problem->at.limit->parameter, b.problem->at.limit->parameter,
                         sizeof a.problem->at.limit->parameter);
    assert_true (memcmp (a.problem->at.limit->parameter, c.problem->at.limit->parameter,
                         sizeof a.problem->at.limit->parameter) != 0);
    clear (&a), clear (&b), clear (&c);
}

/* ---- explicit ------------------------------------------------------------------------------------------ */
/* The stable time step is that of the stiffest part. */
static double stable_step (const char *modulus)
{
    const char *from;
    run r = scene_of (1,
                      "dimension: 2\nbody: [{add: {box: {low: [0, 0], high: [1, 0.5]}}}]\nspacing: 0.05\n"
                      "materials: {rock: {youngs_modulus: \"%s\", poissons_ratio: 0.33, density: 2000}}\n"
                      "method: {force: bond}\nboundary: [{set: left, displacement: {x: 0}}]\n"
                      "solver: {kind: verlet, end: 1 ms}\n",
                      modulus);
    double dt = pg_solver_stable (r.solver, &from);
    clear (&r);
    return dt;
}

static void the_stiffest_place_bounds_the_time_step (void **state)
{
    (void) state;
    double whole = stable_step ("40 GPa"), part = stable_step ("10 GPa + 30 GPa * step (x - 0.4)"),
           soft = stable_step ("10 GPa");
    print_message ("stable steps %.4g s, %.4g s, %.4g s\n", whole, part, soft);
    assert_true (fabs (part / whole - 1) < 0.02 && fabs (soft / whole - 2) < 1e-6);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (two_values_by_a_step_are_two_blocks),
        cmocka_unit_test (bars_of_rising_stiffness_stretch_as_the_logarithm),
        cmocka_unit_test (the_weakest_place_breaks_first),
        cmocka_unit_test (shortcuts_break_the_same_bonds),
        cmocka_unit_test (the_worst_bonds_are_found_by_bounds),
        cmocka_unit_test (fields_have_their_distribution_and_seed),
        cmocka_unit_test (the_stiffest_place_bounds_the_time_step),
    };
    return cmocka_run_group_tests (tests, NULL, NULL);
}

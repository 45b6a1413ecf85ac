/* SPDX-License-Identifier: GPL-3.0-or-later
 * The house takes forces of another kind: a beam with two fields (deflection, rotation) on a one-dimensional
 * cloud, with a matrix or as an operator only, with supports by springs or by elimination, and with every
 * entry missing that may be missing. */
#include "scene_runs/run.h"
#include "io/picture/fonts.h"

#define BAR "dimension: 1\nbody: [{add: {box: {low: [0], high: [1]}}}]\nspacing: 0.05\n" \
    "materials: {steel: {youngs_modulus: 1, poissons_ratio: 0, density: 1}}\n"

/* ---- a chain of Euler-Bernoulli elements, clamped at its left end, loaded at its right end ------------- */
/* N m^2, kg/m, N, N m */
static const double bending = 0.7, line_mass = 1.3, tip_force = 2.0, tip_moment = -0.6;
static int springs, clamps;  /* how the next beam is clamped: springs, or elimination */

typedef struct { const pg_problem *problem; pg_sparse K, T; pg_operator op; size_t ndof, refreshed; } beam;

static void beam_free (void **self)
{
    beam *b = *self;
    if (!b) return;
    pg_sparse_clear (&b->K), pg_sparse_clear (&b->T);
    pg_free (b);
    *self = NULL;
}

static void apply (void *context, const double *x, double *y)
{
    pg_sparse_multiply (&((beam *) context)->K, x, y);
}
static void diagonal (void *context, double *d)
{
    pg_operator op = pg_sparse_operator (&((beam *) context)->K);
    op.diagonal (op.context, d);
}

/* Element matrix of (w, theta, w, theta) */
static void add_element (pg_sparse *K, size_t e, double length)
{
    double c = bending / (length * length * length), l = length;
    double k[4][4] = { { 12, 6 * l, -12, 6 * l },
                       { 6 * l, 4 * l * l, -6 * l, 2 * l * l },
                       { -12, -6 * l, 12, -6 * l },
                       { 6 * l, 2 * l * l, -6 * l, 4 * l * l } };
    for (size_t j = 0; j < 4; j++)
        for (long p = K->start[2*e + j]; p < K->start[2*e + j + 1]; p++) {
            long i = K->row[p] - (long) (2*e);
            if (i >= 0 && i <= (long) j) K->value[p] += c * k[i][j];
        }
}

static pg_status beam_create (void **self, const pg_problem *problem)
{
    pg_status status = PG_OK;
    beam *b = NULL;
    size_t n = problem->cloud.n, at = 0;
    PG_ALLOC (b, 1);
    *self = b;
    b->problem = problem, b->ndof = 2 * n;
    PG_TRY (pg_sparse_create (&b->K, 2*n, 2*n, 7*n, 1));
    for (size_t j = 0; j < 2*n; j++) {  /* columns 2i, 2i + 1: node i - 1, and node i down to the diagonal */
        for (size_t i = j / 2 ? j / 2 * 2 - 2 : 0; i <= j; i++) b->K.row[at++] = (long) i;
        b->K.start[j + 1] = (long) at;
    }
    for (size_t e = 0; e + 1 < n; e++) add_element (&b->K, e, problem->cloud.x[e + 1] - problem->cloud.x[e]);
    for (size_t j = 0; j < 2 && springs; j++) b->K.value[b->K.start[j + 1] - 1] += 1e9 * bending;
    if (clamps) {
        PG_TRY (pg_sparse_create (&b->T, 2*n, 2*n - 2, 2*n - 2, 0));
        for (size_t j = 0; j < 2 * n - 2; j++)
            b->T.row[j] = (long) j + 2, b->T.value[j] = 1, b->T.start[j + 1] = (long) j + 1;
    }
    b->op = (pg_operator) { 2*n, b, apply, diagonal };
done:
    if (status != PG_OK) beam_free (self);
    return status;
}

static size_t beam_fields (const void *self, size_t max, pg_field *out)
{
    (void) self;
    if (max > 0) out[0] = (pg_field) { "deflection", "m", 1 };
    if (max > 1) out[1] = (pg_field) { "rotation", "rad", 1 };
    return 2;
}

static pg_status beam_refresh (void *self, const pg_state *state, const pg_changes *changes)
{
    (void) state, (void) changes;
    ((beam *) self)->refreshed++;
    return PG_OK;
}

static pg_status beam_balance (void *self, double t, const double *d, double *residual, double *reference)
{
    beam *b = self;
    double inside = 0;
    pg_sparse_multiply (&b->K, d, residual);
    for (size_t i = 0; i < b->ndof; i++) inside += residual[i] * residual[i], residual[i] = -residual[i];
    residual[b->ndof - 2] += t * tip_force, residual[b->ndof - 1] += t * tip_moment;
    *reference = fmax (sqrt (inside), t * sqrt (tip_force * tip_force + tip_moment * tip_moment));
    return PG_OK;
}

static pg_status beam_mass (void *self, double *mass, const pg_sparse **consistent)
{
    beam *b = self;
    if (consistent) *consistent = NULL;
    for (size_t i = 0; mass && i < b->ndof / 2; i++)
        mass[2 * i] = line_mass * b->problem->cloud.volume[i], mass[2 * i + 1] = 1e-4 * mass[2 * i];
    return PG_OK;
}

static const pg_operator *beam_operator (void *self) { return &((beam *) self)->op; }
static pg_status beam_matrix (void *self, pg_matrix_want want, const pg_sparse **K)
{
    (void) want;
    *K = &((beam *) self)->K;
    return PG_OK;
}
static pg_status no_matrix (void *self, pg_matrix_want want, const pg_sparse **K)
{
    (void) self, (void) want;
    *K = NULL;
    return PG_OK;
}
static const pg_sparse *beam_basis (void *self)
{
    return ((beam *) self)->T.ncol ? &((beam *) self)->T : NULL;
}
static pg_status beam_impose (void *self, double t, double *d)
{
    (void) self, (void) t;
    d[0] = d[1] = 0;
    return PG_OK;
}

#define FORCE(name_, refresh_, mass_, operator__, matrix_) \
    { \
        .method = { .name = name_, .summary = "a beam" }, \
        .create = beam_create, .free = beam_free, .fields = beam_fields, \
        .refresh = refresh_, .balance = beam_balance, .mass = mass_, .operator_ = operator__, \
        .matrix = matrix_, .basis = beam_basis, .impose = beam_impose \
    }
static const pg_force_type with_matrix = FORCE ("beam", beam_refresh, beam_mass, NULL, beam_matrix);
static const pg_force_type matrix_free = FORCE ("beam_free", beam_refresh, beam_mass, beam_operator,
                                                no_matrix);
static const pg_force_type nothing = FORCE ("beam_of_nothing", NULL, NULL, NULL, NULL);
static const pg_force_type least = { .method = { .name = "least" },
                                     .create = beam_create,
                                     .free = beam_free,
                                     .fields = beam_fields,
                                     .balance = beam_balance,
                                     .matrix = beam_matrix };
static const pg_force_type least_free = { .method = { .name = "least_free" },
                                          .create = beam_create,
                                          .free = beam_free,
                                          .fields = beam_fields,
                                          .balance = beam_balance,
                                          .operator_ = beam_operator };

static run beam_of (const pg_force_type *force, int by_springs, const char *text)
{
    run r = { 0 };
    springs = by_springs, clamps = !by_springs;
    check_ok (pg_scene_parse (&r.scene, text, "beam.yaml"));
    check_ok (pg_problem_build (&r.problem, r.scene, 1));
    check_ok (pg_solver_options_read (&r.options, r.problem, r.scene));
    check_ok (pg_solver_create_with (&r.solver, r.problem, &r.options, force));
    check_ok (pg_state_create (&r.state, r.problem, pg_solver_components (r.solver)));
    return r;
}

/* w = F x^2 (3 L - x) / 6 EI + M x^2 / 2 EI: cubic, so that the nodes are exact */
static double deflection (double x)
{
    return (tip_force * x * x * (3 - x) / 6 + tip_moment * x * x / 2) / bending;
}
static double rotation (double x) { return (tip_force * x * (2 - x) / 2 + tip_moment * x) / bending; }

static void is_the_closed_form (const run *r, double tolerance)
{
    double top = fabs (deflection (1));
    for (size_t i = 0; i < r->problem->cloud.n; i++) {
        double x = r->problem->cloud.x[i];
        check_scaled (r->state->d[2*i], deflection (x), tolerance, top);
        check_scaled (r->state->d[2*i + 1], rotation (x), tolerance, top);
    }
}

/* ---- two fields ---------------------------------------------------------------------------------------- */
static void two_fields_give_two_unknowns_a_point (void **state)
{
    (void) state;
    run r = beam_of (&with_matrix, 0, BAR);
    assert_int_equal (pg_solver_components (r.solver), 2);
    assert_int_equal (r.state->ndof, 2 * r.problem->cloud.n);
    assert_string_equal (pg_solver_force (r.solver, NULL)->method.name, "beam");
    clear (&r);
}

static void the_beam_bends_as_in_the_textbook (void **state)
{
    (void) state;
    static const char *const solvers[] = { "cholmod", "umfpack", "pcg", "auto" };
    for (int s = 0; s < 4; s++)
        for (int by_springs = 0; by_springs < 2; by_springs++)
            for (int event = 0; event < 2; event++) {
                char text[1000];
                snprintf (text, sizeof text,
                          BAR "solver: {kind: static, stepping: %s, steps: 3, linear: %s, tolerance: "
                              "1e-7}\noutput: {at: {levels: 2}}\n",
                          event ? "event" : "fixed", solvers[s]);
                run r = beam_of (&with_matrix, by_springs, text);
                to_the_end (&r);
                is_the_closed_form (&r, by_springs ? 1e-6 : 1e-8);
                check_relative (r.state->factor, 1, 1e-15);
                assert_int_equal (pg_solver_report_now (r.solver)->steps, event ? 2 : 3);
                if (s == 2) assert_true (pg_solver_report_now (r.solver)->linear.cg_iterations > 0);
                else assert_int_equal (pg_solver_report_now (r.solver)->linear.cg_iterations, 0);
                clear (&r);
            }
}

static void loads_grow_with_the_steps (void **state)
{
    (void) state;
    run r = beam_of (&with_matrix, 0, BAR "solver: {stepping: fixed, steps: 4}\n");
    for (int k = 1; k <= 4; k++) {
        advance (&r);
        check_relative (r.step.factor, k / 4.0, 1e-15);
        check_relative (r.state->d[r.state->ndof - 2], deflection (1) * k / 4, 1e-8);
    }
    assert_true (pg_solver_done (r.solver, r.state));
    clear (&r);
}

/* ---- without a matrix ---------------------------------------------------------------------------------- */
static void an_operator_alone_gives_the_same (void **state)
{
    (void) state;
    for (int by_springs = 0; by_springs < 2; by_springs++) {
        const char *text = BAR "solver: {kind: static, tolerance: 1e-9, steps: 2, stepping: fixed}\n";
        run a = beam_of (&with_matrix, by_springs, text), b = beam_of (&matrix_free, by_springs, text);
        to_the_end (&a), to_the_end (&b);
        for (size_t i = 0; i < a.state->ndof; i++)
            check_scaled (b.state->d[i], a.state->d[i], 1e-8, fabs (deflection (1)));
        if (!by_springs) is_the_closed_form (&b, 1e-8);
        const pg_statistics *report = pg_solver_report_now (b.solver);
        assert_true (report->linear.cg_iterations > 10);
        assert_int_equal (report->linear.factorizations, 0);
        assert_string_equal (report->linear.solver, "cg");
        clear (&a), clear (&b);
    }
}

static void dynamics_needs_no_matrix_either (void **state)
{
    (void) state;
    const char *text = BAR "solver: {kind: newmark, dt: 0.01, end: 0.5, tolerance: 1e-10, rayleigh: {mass: "
                           "0.1, stiffness: 1e-3}}\n";
    run a = beam_of (&with_matrix, 0, text), b = beam_of (&matrix_free, 0, text);
    double top = 0;
    while (!pg_solver_done (a.solver, a.state)) {
        advance (&a), advance (&b);
        top = fmax (top, fabs (a.state->d[a.state->ndof - 2]));
        for (size_t i = 0; i < a.state->ndof; i++) check_scaled (b.state->d[i], a.state->d[i], 1e-8, top);
    }
    assert_int_equal (a.state->step, 50);
    assert_true (top > 0.01 * deflection (1));
    assert_true (pg_solver_report_now (b.solver)->linear.cg_iterations > 50);
    clear (&a), clear (&b);
}

static void neither_matrix_nor_operator_is_refused (void **state)
{
    (void) state;
    pg_scene *scene = NULL;
    pg_problem *problem = NULL;
    pg_solver *solver = NULL;
    pg_solver_options options;
    size_t used = pg_memory_used ();
    check_ok (pg_scene_parse (&scene, BAR, "beam.yaml"));
    check_ok (pg_problem_build (&problem, scene, 1));
    check_ok (pg_solver_options_read (&options, problem, scene));
    check_fails (pg_solver_create_with (&solver, problem, &options, &nothing), PG_E_SCENE);
    assert_null (solver);
    check_contains (pg_last_error (), "beam_of_nothing");
    pg_problem_free (&problem);
    pg_scene_free (&scene);
    assert_int_equal (pg_memory_used (), used);
}

/* ---- missing entries ----------------------------------------------------------------------------------- */
/* Loads, gauges, a criterion, a stop set: all that makes a solver ask its force for more. */
#define RICH BAR "failure: {criterion: stretch, critical_stretch: 1e-6}\n" \
    "boundary: [{set: left, displacement: {x: 0}}, {set: right, force: {x: 1}}]\n"

static void missing_entries_are_not_missed (void **state)
{
    (void) state;
    const pg_force_type *const forces[] = { &least, &least_free };
    for (int f = 0; f < 2; f++)
        for (int event = 0; event < 2; event++) {
            run r = beam_of (forces[f], 1,
                             event ? RICH "solver: {stepping: event, stop: {set: right}}\n"
                                   : RICH "solver: {stepping: fixed, steps: 2, stop: {set: right}}\n");
            to_the_end (&r);
            is_the_closed_form (&r, 1e-5);
            const pg_statistics *report = pg_solver_report (r.solver, r.state);
            assert_int_equal (report->broken, 0);
            assert_int_equal (report->nwarning, 0);
            assert_true (report->energy.strain == 0 && report->energy.external == 0);
            assert_true (r.step.reaction && r.step.reaction[0] == 0);
            clear (&r);
        }
}

static void a_force_without_mass_is_refused_by_newmark (void **state)
{
    (void) state;
    run r = beam_of (&least, 1, RICH "solver: {kind: newmark, dt: 0.1, end: 1}\n");
    check_fails (pg_solver_step (r.solver, r.state, &r.step), PG_E_SCENE);
    check_contains (pg_last_error (), "mass");
    clear (&r);
}

static void results_are_written_without_fields (void **state)
{
    (void) state;
    char folder[] = "/tmp/perigal_beam_XXXXXX", command[80];
    assert_non_null (mkdtemp (folder));
    run r = beam_of (&least, 1,
                     RICH "solver: {stepping: event}\n"
                          "output: {at: {levels: 2}, gauges: [{name: g, from: [0], to: [1]}], pictures: "
                          "[damage, displacement.x]}\n");
    pg_result *result = NULL;
    check_ok (pg_result_open (&result, folder, r.scene, r.problem, r.solver));
    while (!pg_solver_done (r.solver, r.state)) {
        advance (&r);
        check_ok (pg_result_step (result, r.state, &r.step));
    }
    check_ok (pg_result_finish (result, r.state, NULL, 0, 0));
    pg_result_free (&result);
    clear (&r);
    snprintf (command, sizeof command, "rm -r %s", folder);
    assert_int_equal (system (command), 0);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (two_fields_give_two_unknowns_a_point),
        cmocka_unit_test (the_beam_bends_as_in_the_textbook),
        cmocka_unit_test (loads_grow_with_the_steps),
        cmocka_unit_test (an_operator_alone_gives_the_same),
        cmocka_unit_test (dynamics_needs_no_matrix_either),
        cmocka_unit_test (neither_matrix_nor_operator_is_refused),
        cmocka_unit_test (missing_entries_are_not_missed),
        cmocka_unit_test (a_force_without_mass_is_refused_by_newmark),
        cmocka_unit_test (results_are_written_without_fields),
    };
    return cmocka_run_group_tests_name ("mechanics/force/architecture", tests, NULL, NULL);
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * The linear system of a scene: its matrix is the force's own to the last bit, also when it was written to a
 * Matrix Market file and read back; its solution is the displacement that a run finds. */
#include "check.h"
#include "perigal/session.h"
#include <stdlib.h>
#include <unistd.h>

/* A notched plate under tension, of any method; `more`: lines of the scene's method. */
static const char *scene_of (const char *method, const char *support)
{
    static char text[2000];
    snprintf (text, sizeof text,
              "dimension: 2\nplane: stress\nthickness: 10 mm\n"
              "body:\n  - add: {box: {low: [0, 0], high: [60 mm, 40 mm]}}\n"
              "  - subtract: {disk: {center: [30 mm, 20 mm], diameter: 14 mm}}\nspacing: 4 mm\n"
              "cracks:\n  - {from: [0, 20 mm], to: [12 mm, 20 mm]}\n"
              "materials:\n  glass: {youngs_modulus: 70 GPa, poissons_ratio: 0.25}\nmethod: {%s}\n"
              "boundary:\n  - {name: low, set: bottom, displacement: {x: 0, y: 0}%s}\n"
              "  - {name: high, set: top, displacement: {y: 20 um}%s}\n"
              "  - {name: side, set: right, traction: {x: 1 MPa}}\nsolver: {kind: static}\n",
              method, support, support);
    return text;
}

typedef struct { pg_scene *scene; pg_problem *problem; pg_solver *solver; pg_state *state; } run;

/* The whole of a static run without breaking. */
static void solve (run *r, const char *text)
{
    pg_solver_options o;
    pg_step step;
    check_ok (pg_scene_parse (&r->scene, text, "plate.yaml"));
    check_ok (pg_problem_build (&r->problem, r->scene, 1));
    check_ok (pg_solver_options_read (&o, r->problem, r->scene));
    check_ok (pg_solver_create (&r->solver, r->problem, &o));
    check_ok (pg_state_create (&r->state, r->problem, pg_solver_components (r->solver)));
    while (!pg_solver_done (r->solver, r->state)) check_ok (pg_solver_step (r->solver, r->state, &step));
}

static void clear (run *r)
{
    pg_state_free (&r->state), pg_solver_free (&r->solver), pg_problem_free (&r->problem);
    pg_scene_free (&r->scene);
}

/* q of (T' K T) q = T' (f - K g), by the library's own solver, and u = N (T q + g). */
static void solve_equations (const pg_equations *e, double *u)
{
    const pg_linear_type *solver = pg_linear_first (1, 1);
    pg_linear_options o = { .block = 1, .dim = e->dim, .threads = 1, .tolerance = 1e-14 };
    pg_sparse A;
    void *self = NULL;
    double *b = pg_calloc (e->n, sizeof *b), *r = pg_calloc (e->n, sizeof *r),
           *q = pg_calloc (e->n, sizeof *q), *d = pg_calloc (e->n, sizeof *d);
    check_ok (pg_sparse_congruence (&A, &e->K, &e->T));
    pg_sparse_multiply (&e->K, e->g, r);
    for (size_t i = 0; i < e->n; i++) r[i] = e->f[i] - r[i];
    pg_sparse_multiply_transposed (&e->T, r, b);
    check_ok (solver->analyse (&self, &A, &o));
    check_ok (solver->factor (self, &A));
    check_ok (solver->solve (self, 1, b, q));
    pg_sparse_multiply (&e->T, q, d);
    for (size_t i = 0; i < e->n; i++) d[i] += e->g[i];
    pg_sparse_multiply (&e->N, d, u);
    solver->free (&self);
    pg_sparse_clear (&A);
    pg_free (b), pg_free (r), pg_free (q), pg_free (d);
}

/* The matrix that the force of a run shows. */
static void check_bits (const pg_equations *e, run *r)
{
    void *self;
    const pg_force_type *force = pg_solver_force (r->solver, &self);
    check_ok (pg_force_assemble (force, self, NULL));
    const pg_sparse *K = pg_force_matrix (force, self);
    size_t nnz = (size_t) K->start[K->ncol];
    assert_int_equal (K->symmetric, 1);
    assert_true (nnz > 1000);
    assert_memory_equal (K->start, e->K.start, (K->ncol + 1) * sizeof *K->start);
    assert_memory_equal (K->row, e->K.row, nnz * sizeof *K->row);
    assert_memory_equal (K->value, e->K.value, nnz * sizeof *K->value);
}

static void check_method (const char *method, const char *support, int selects, double tolerance)
{
    run r = { 0 };
    pg_equations e;
    int components;
    const char *unit;
    void *self;
    double most = 0;
    solve (&r, scene_of (method, support));
    check_ok (pg_equations_create (&e, r.problem, r.state, 1));
    check_bits (&e, &r);
    assert_int_equal (e.selects, selects);
    const pg_force_type *force = pg_solver_force (r.solver, &self);
    size_t n = e.N.nrow;
    double *u = pg_calloc (n, sizeof *u), *expected = pg_calloc (6 * n, sizeof *u);
    check_ok (force->field (self, r.state, r.state->d, "displacement", &components, &unit, expected));
    assert_int_equal (n, r.problem->cloud.n * 2);
    for (size_t i = 0; i < n; i++) most = fmax (most, fabs (expected[i]));
    pg_sparse_multiply (&e.N, r.state->d, u);
    for (size_t i = 0; i < n && e.n == n; i++) check_scaled (u[i], expected[i], 1e-15, most);
    solve_equations (&e, u);
    for (size_t i = 0; i < n; i++) check_scaled (u[i], expected[i], tolerance, most);
    pg_free (u), pg_free (expected);
    pg_equations_clear (&e);
    clear (&r);
}

static void test_solutions (void **state)
{
    (void) state;
    check_method ("approximation: rkpm, integration: gauss, horizon: 2 spacing", "", 1, 1e-10);
    check_method ("approximation: pddo, integration: nodal, horizon: 2.5 spacing", "", 1, 1e-10);
    check_method ("approximation: rkpm, integration: gauss, horizon: 2 spacing",
                  ", essential: transformation", 0, 1e-10);
    check_method ("force: bond, horizon: 3 spacing", "", 1, 1e-10);
    check_method ("force: gmpd, horizon: 3 spacing", "", 1, 1e-10);
}

/* Points inside a slot of broken bonds keep nothing: they are held, and the rest is regular. */
static void test_idle (void **state)
{
    (void) state;
    run r = { 0 };
    pg_equations e;
    solve (&r, scene_of ("force: bond, horizon: 2 spacing", ""));
    const pg_family *f = &r.problem->bonds.rows[PG_NODES].family;
    check_ok (pg_equations_create (&e, r.problem, r.state, 0.5));
    size_t idle = e.idle, kept = e.T.ncol;             /* points on the crack have none from the start */
    pg_equations_clear (&e);
    for (size_t i = 0; i < f->n; i++)                  /* point 40 loses all its bonds */
        for (size_t b = f->start[i]; b < f->start[i + 1]; b++)
            if (i == 40 || f->node[b] == 40) r.state->alive[b] = 0;
    check_ok (pg_equations_create (&e, r.problem, r.state, 0.5));
    assert_int_equal (e.idle, idle + 2);
    assert_int_equal (e.T.ncol, kept - 2);
    for (size_t k = 0; k < e.T.ncol; k++) assert_true (e.free[k] / 2 != 40);
    for (size_t k = 1; k < e.T.ncol; k++) assert_true (e.free[k] > e.free[k - 1]);
    pg_equations_clear (&e);
    clear (&r);
}

/* Written and read back by numbers of the file alone: the same bits. */
static void test_matrix_market (void **state)
{
    (void) state;
    run r = { 0 };
    pg_equations e;
    char path[] = "/tmp/perigal_mm_XXXXXX", line[200];
    size_t nrow, ncol, entry = 0;
    long nnz, row, column;
    double value;
    assert_true (close (mkstemp (path)) == 0);
    solve (&r, scene_of ("approximation: rkpm, integration: gauss, horizon: 2 spacing", ""));
    check_ok (pg_equations_create (&e, r.problem, r.state, 1));
    check_ok (pg_matrix_market_write (&e.K, path, "two lines\nof words"));
    FILE *f = fopen (path, "r");
    assert_true (fgets (line, sizeof line, f) != NULL);
    assert_string_equal (line, "%%MatrixMarket matrix coordinate real symmetric\n");
    assert_true (fgets (line, sizeof line, f) && !strcmp (line, "% two lines\n"));
    assert_true (fgets (line, sizeof line, f) && !strcmp (line, "% of words\n"));
    assert_int_equal (fscanf (f, "%zu %zu %ld", &nrow, &ncol, &nnz), 3);
    assert_true (nrow == e.n && ncol == e.n && nnz == e.K.start[e.n]);
    for (size_t j = 0; j < e.n; j++)
        for (long p = e.K.start[j]; p < e.K.start[j + 1]; p++, entry++) {
            assert_int_equal (fscanf (f, "%ld %ld %lf", &row, &column, &value), 3);
            assert_true (row == (long) j + 1 && column == e.K.row[p] + 1 && value == e.K.value[p]);
        }
    fclose (f);
    check_ok (pg_matrix_market_write (&e.T, path, NULL));
    f = fopen (path, "r");
    assert_true (fgets (line, sizeof line, f) && strstr (line, "real general"));
    assert_int_equal (fscanf (f, "%zu %zu %ld %ld %ld", &nrow, &ncol, &nnz, &row, &column), 5);
    assert_true (nrow == e.n && ncol == e.T.ncol && row == e.T.row[0] + 1 && column == 1);
    fclose (f);
    check_ok (pg_matrix_market_vector (e.n, e.f, path, "loads"));
    f = fopen (path, "r");
    assert_true (fgets (line, sizeof line, f) != NULL);
    assert_string_equal (line, "%%MatrixMarket matrix array real general\n");
    assert_true (fgets (line, sizeof line, f) && fgets (line, sizeof line, f));
    assert_int_equal (strtoul (line, NULL, 10), e.n);
    for (size_t i = 0; i < e.n; i++) assert_true (fscanf (f, "%lf", &value) == 1 && value == e.f[i]);
    fclose (f);
    remove (path);
    check_fails (pg_matrix_market_write (&e.K, "/nowhere/at/all.mtx", NULL), PG_E_FILE);
    assert_int_equal (symlink ("/dev/full", path), 0); /* by a link, so that a fault here costs a link only */
    check_fails (pg_matrix_market_vector (1, e.f, path, NULL), PG_E_FILE);
    assert_int_equal (remove (path), 0);               /* what leads to a device is left where it is */
    pg_equations_clear (&e);
    clear (&r);
}

static void test_refused (void **state)
{
    (void) state;
    run r = { 0 };
    pg_equations e;
    check_ok (pg_scene_parse (&r.scene, scene_of ("force: lps, horizon: 3 spacing", ""), "plate.yaml"));
    check_ok (pg_problem_build (&r.problem, r.scene, 1));
    check_fails (pg_equations_create (&e, r.problem, NULL, 1), PG_E_USAGE);
    check_contains (pg_last_error (), "neighbours of neighbours");
    assert_null (e.f);
    clear (&r);
    check_ok (pg_scene_parse (&r.scene, scene_of ("force: bond, horizon: 3 spacing", ""), "plate.yaml"));
    check_ok (pg_problem_build (&r.problem, r.scene, 1));
    check_fails (pg_equations_create (&e, r.problem, NULL, NAN), PG_E_USAGE);
    clear (&r);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (test_solutions),
        cmocka_unit_test (test_idle),
        cmocka_unit_test (test_matrix_market),
        cmocka_unit_test (test_refused),
    };
    return cmocka_run_group_tests (tests, NULL, NULL);
}

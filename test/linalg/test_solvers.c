/* SPDX-License-Identifier: GPL-3.0-or-later
 * Linear solvers: every entry of the catalogue on lattices in 1, 2 and 3 dimensions with 1 to 3 unknowns per
 * node; what each refuses; one analysis for many factorizations; memory that runs out. */
#include <malloc.h>
#include "systems.h"

static const char *const names[] = { "cholmod", "umfpack", "pcg" };
enum { NAMES = 3, MOST_RHS = 4 };

static pg_status solve_with (const char *name, const pg_sparse *A, const pg_linear_options *options,
                             size_t nrhs, const double *b, double *x)
{
    pg_status status = PG_OK;
    const pg_linear_type *type = pg_linear_find (name);
    void *solver = NULL;
    PG_TRY (type->analyse (&solver, A, options));
    PG_TRY (type->factor (solver, A));
    PG_TRY (type->solve (solver, nrhs, b, x));
done:
    if (solver) type->free (&solver);
    return status;
}

/* One unknown to nine: what is left over of loops in steps of four and of blocks. */
static void systems_of_few_unknowns (void **state)
{
    (void) state;
    for (size_t n = 1; n <= 9; n++) {
        dense D = random_laplacian (n, 1, 1);
        pg_sparse A = sparse_of (&D, 1);
        double b[9], x[9];
        for (size_t i = 0; i < n; i++) b[i] = random_number ();
        for (int k = 0; k < NAMES; k++) {
            check_ok (solve_with (names[k], &A, &(pg_linear_options) { 1, 1, 1, 1e-14, 0 }, 1, b, x));
            check_below (misfit (&D, 1, x, b), 1e-12);
        }
        pg_sparse_clear (&A);
        dense_free (&D);
    }
}

static void the_catalogue_knows_its_entries (void **state)
{
    (void) state;
    for (int k = 0; k < NAMES; k++) {
        const pg_linear_type *type = pg_linear_find (names[k]);
        assert_non_null (type);
        assert_string_equal (type->name, names[k]);
        check_contains (pg_linear_names (), names[k]);
    }
    assert_null (pg_linear_find ("gauss_seidel"));
    assert_null (pg_linear_find ("auto"));
}

static void every_solver_on_every_lattice (void **state)
{
    (void) state;
    static const struct { int dim; size_t side; } lattices[] = { { 1, 300 }, { 2, 17 }, { 3, 6 } };
    for (int l = 0; l < 3; l++)
        for (size_t block = 1; block <= 3; block++) {
            dense D = random_laplacian (lattices[l].side, lattices[l].dim, block);
            pg_sparse A = sparse_of (&D, 1);
            double *b = pg_calloc (MOST_RHS * D.nrow, sizeof *b),
                   *x = pg_calloc (MOST_RHS * D.nrow, sizeof *x);
            for (size_t i = 0; i < MOST_RHS * D.nrow; i++) b[i] = random_number ();
            for (int k = 0; k < NAMES; k++)
                for (size_t nrhs = 1; nrhs <= MOST_RHS; nrhs += MOST_RHS - 1) {
                    pg_linear_options o = { (int) block, lattices[l].dim, 1, 1e-13, 0 };
                    /* NaN: the old content must not count */
                    memset (x, 0xff, MOST_RHS * D.nrow * sizeof *x);
                    check_ok (solve_with (names[k], &A, &o, nrhs, b, x));
                    check_below (misfit (&D, nrhs, x, b), 1e-11);
                }
            pg_free (b), pg_free (x);
            pg_sparse_clear (&A);
            dense_free (&D);
        }
}

/* Right-hand sides of a few unknowns: the way forward leaves out what they do not reach. Solved twice by one
 * factor, as what was reached first must not stay, and against the solve that leaves out nothing. */
static void a_few_places_are_enough (void **state)
{
    (void) state;
    static const struct { int dim; size_t side; } lattices[] = { { 1, 200 }, { 2, 17 }, { 3, 6 } };
    const pg_linear_type *type = pg_linear_find ("cholmod");
    assert_non_null (type->solve_few);
    for (int l = 0; l < 3; l++) {
        dense D = random_laplacian (lattices[l].side, lattices[l].dim, 2);
        size_t n = D.nrow;
        pg_sparse A = sparse_of (&D, 1);
        void *solver = NULL;
        double *b = pg_calloc (3 * n, sizeof *b), *x = pg_calloc (3 * n, sizeof *x),
               *y = pg_calloc (3 * n, sizeof *y);
        check_ok (type->analyse (&solver, &A, &(pg_linear_options) { 2, lattices[l].dim, 1, 0, 0 }));
        check_ok (type->factor (solver, &A));
        for (size_t round = 0; round < 2; round++) {
            memset (b, 0, 3 * n * sizeof *b);
            for (size_t k = 0; k < 3; k++) b[k * n + (n / 5 + k + round * n / 2) % n] = 1 + random_number ();
            b[2 * n + (round ? 0 : n - 1)] = 1;
            for (size_t nrhs = 1; nrhs <= 3; nrhs += 2) {
                memset (x, 0xff, 3 * n * sizeof *x);
                check_ok (type->solve_few (solver, nrhs, b, x));
                check_ok (type->solve (solver, nrhs, b, y));
                check_below (misfit (&D, nrhs, x, b), 1e-11);
                for (size_t i = 0; i < nrhs * n; i++) check_scaled (x[i], y[i], 1e-11, 1);
            }
        }
        type->free (&solver);
        pg_free (b), pg_free (x), pg_free (y);
        pg_sparse_clear (&A);
        dense_free (&D);
    }
}

/* A large cube goes through METIS, whose order takes fewer operations; a small one is not worth asking it.
 * Checked by residual in the sparse matrix. */
static void order_cube (size_t side, const char *ordering)
{
    size_t n = side * side * side, block = 2, nnz = 0, step[3] = { 1, side, side * side };
    pg_sparse A;
    check_ok (pg_sparse_create (&A, n * block, n * block, 9 * n * block, 1));
    for (size_t j = 0; j < n; j++)
        for (size_t b = 0; b < block; b++) {
            for (int k = 2; k >= 0; k--)
                if (j / step[k] % side > 0)
                    for (size_t a = 0; a < block; a++)
                        A.row[nnz] = (long) ((j - step[k]) * block + a), A.value[nnz++] = a == b ? -1 : 0;
            for (size_t a = 0; a <= b; a++)
                A.row[nnz] = (long) (j * block + a), A.value[nnz++] = a == b ? 6.5 : 0.3;
            A.start[j * block + b + 1] = (long) nnz;
        }
    double *x = pg_calloc (n * block, sizeof *x), *b = pg_calloc (n * block, sizeof *b),
           *y = pg_calloc (n * block, sizeof *y);
    for (size_t i = 0; i < n * block; i++) b[i] = random_number ();
    const pg_linear_type *type = pg_linear_find ("cholmod");
    void *solver = NULL;
    pg_linear_info info;
    check_ok (type->analyse (&solver, &A, &(pg_linear_options) { (int) block, 3, 1, 0, 0 }));
    check_ok (type->factor (solver, &A));
    check_ok (type->solve (solver, 1, b, x));
    type->info (solver, &info);
    assert_string_equal (info.ordering, ordering);
    assert_true (info.factor_entries > (double) A.start[n * block] && info.flops > info.factor_entries);
    type->free (&solver);
    assert_null (solver);
    pg_sparse_multiply (&A, x, y);
    for (size_t i = 0; i < n * block; i++) check_absolute (y[i], b[i], 1e-12);
    pg_free (x), pg_free (b), pg_free (y);
    pg_sparse_clear (&A);
}

static void the_order_is_the_one_with_fewer_operations (void **state)
{
    (void) state;
    order_cube (9, "amd");
    order_cube (22, "metis");
}

static void one_analysis_serves_many_factorizations (void **state)
{
    (void) state;
    dense D = random_laplacian (9, 2, 2);
    size_t n = D.nrow;
    pg_sparse A = sparse_of (&D, 1);
    double *b = pg_calloc (n, sizeof *b), *x = pg_calloc (n, sizeof *x),
           *fresh = pg_calloc (n, sizeof *fresh);
    for (size_t i = 0; i < n; i++) b[i] = random_number ();
    for (int k = 0; k < NAMES; k++) {
        const pg_linear_type *type = pg_linear_find (names[k]);
        pg_linear_options o = { 2, 2, 1, 1e-13, 0 };
        void *solver = NULL;
        check_ok (type->analyse (&solver, &A, &o));
        for (int round = 0; round < 5; round++) {
            for (size_t i = 0; i < n; i++) dense_set (&D, i, i, dense_at (&D, i, i) * (1 + 0.3 * round));
            if (round == 3)                            /* a broken tie stays in the pattern as a zero */
                for (size_t i = 0; i < 2; i++)
                    for (size_t j = 2; j < 4; j++) dense_set (&D, i, j, 0), dense_set (&D, j, i, 0);
            pg_sparse now = sparse_of (&D, 1);
            check_ok (type->factor (solver, &now));
            check_ok (type->solve (solver, 1, b, x));
            check_below (misfit (&D, 1, x, b), 1e-11);
            check_ok (solve_with (names[k], &now, &o, 1, b, fresh));
            for (size_t i = 0; i < n; i++) check_scaled (x[i], fresh[i], 1e-11, 1);
            pg_sparse_clear (&now);
        }
        type->free (&solver);
    }
    pg_free (b), pg_free (x), pg_free (fresh);
    pg_sparse_clear (&A);
    dense_free (&D);
}

static void refuses_what_is_not_positive_definite (const char *name)
{
    const pg_linear_type *type = pg_linear_find (name);
    dense D = random_laplacian (7, 2, 2);
    pg_sparse A = sparse_of (&D, 1);
    void *solver = NULL;
    double *b = pg_calloc (D.nrow, sizeof *b), *x = pg_calloc (D.nrow, sizeof *x);
    b[3] = 1;
    check_ok (type->analyse (&solver, &A, &(pg_linear_options) { 2, 2, 1, 0, 0 }));
    for (size_t bad = 0; bad < D.nrow; bad += 9) {
        double keep = A.value[A.start[bad + 1] - 1];
        A.value[A.start[bad + 1] - 1] = -100;
        check_fails (type->factor (solver, &A), PG_E_NOT_SPD);
        assert_int_equal (pg_linear_failed_row (), bad);
        char row[64];
        snprintf (row, sizeof row, "unknown %zu of %zu", bad, D.nrow);
        check_contains (pg_last_error (), row);
        A.value[A.start[bad + 1] - 1] = keep;
        check_ok (type->factor (solver, &A));          /* and recovers */
        check_ok (type->solve (solver, 1, b, x));
        check_below (misfit (&D, 1, x, b), 1e-12);
    }
    type->free (&solver);
    pg_free (b), pg_free (x);
    pg_sparse_clear (&A);
    dense_free (&D);
}

static void cholesky_refuses_what_is_not_positive_definite (void **state)
{
    (void) state;
    refuses_what_is_not_positive_definite ("cholmod");
}

static void conjugate_gradients_refuse_what_is_not_positive_definite (void **state)
{
    (void) state;
    dense D = random_laplacian (7, 2, 1);
    dense_set (&D, 20, 20, -100);
    pg_sparse A = sparse_of (&D, 1);
    double b[49], x[49];
    for (int i = 0; i < 49; i++) b[i] = random_number ();
    check_fails (solve_with ("pcg", &A, &(pg_linear_options) { 1, 2, 1, 1e-12, 0 }, 1, b, x), PG_E_NOT_SPD);
    pg_sparse_clear (&A);
    dense_free (&D);
}

static void conjugate_gradients_say_when_they_do_not_arrive (void **state)
{
    (void) state;
    dense D = random_laplacian (9, 2, 2);
    pg_sparse A = sparse_of (&D, 1);
    pg_operator op = pg_sparse_operator (&A);
    double b[162], x[162] = { 0 };
    size_t used = 0, all = 0;
    for (int i = 0; i < 162; i++) b[i] = random_number ();
    check_fails (pg_conjugate_gradients (&op, b, x, 1e-12, 5, &used), PG_E_EQUILIBRIUM);
    assert_int_equal (used, 5);
    check_ok (pg_conjugate_gradients (&op, b, x, 1e-12, 10000, &used));
    check_below (misfit (&D, 1, x, b), 1e-10);
    double y[162] = { 0 };
    check_ok (pg_conjugate_gradients (&op, b, y, 1e-12, 10000, &all));
    assert_true (used < all);                          /* the first guess was used */
    check_ok (pg_conjugate_gradients (&op, b, y, 1e-11, 10000, &used));
    assert_int_equal (used, 0);                        /* the answer is a fixed point */
    double zero[162] = { 0 }, z[162] = { 0 };
    check_ok (pg_conjugate_gradients (&op, zero, z, 1e-12, 10000, &used));
    for (int i = 0; i < 162; i++) assert_true (z[i] == 0);
    for (int i = 0; i < 162; i++) b[i] *= 1e-160;      /* their squares vanish */
    check_ok (pg_conjugate_gradients (&op, b, z, 1e-12, 10000, &used));
    for (int i = 0; i < 162; i++) check_below (fabs (z[i]), 1e-150);
    pg_sparse_clear (&A);
    dense_free (&D);
}

/* A long chain of masses on springs, heavy enough that what happens at a place is not felt far away. */
typedef struct { size_t n; double looked; } heavy_chain;

static void apply_chain (void *context, const double *x, double *y)
{
    heavy_chain *c = context;
    for (size_t i = 0; i < c->n; i++) {
        y[i] = 4 * x[i] - (i > 0 ? x[i - 1] : 0) - (i + 1 < c->n ? x[i + 1] : 0);
        c->looked += x[i] != 0;
    }
}

static void chain_diagonal (void *context, double *d)
{
    for (size_t i = 0; i < ((heavy_chain *) context)->n; i++) d[i] = 4;
}

/* A push at one place beside a whisper everywhere: the solution is as good, and looks at a few places only.
 * Nothing but whisper, or a push everywhere, is solved all the same. */
static void local_right_hand_sides_are_solved_where_they_are (void **state)
{
    (void) state;
    enum { N = 4000 };
    for (int kind = 0; kind < 3; kind++) {
        heavy_chain chain = { N, 0 };
        pg_operator op = { N, &chain, apply_chain, chain_diagonal };
        double *b = calloc (N, sizeof *b), *x = calloc (N, sizeof *x), *y = calloc (N, sizeof *y), rr = 0,
               bb = 0, off = 0, looked;
        pg_cg_watch watch = { .local = 1 };
        size_t used, all;
        for (size_t i = 0; i < N; i++) b[i] = kind == 2 ? random_number () : 1e-13 * random_number ();
        if (kind == 0) b[1000] = 1, b[1003] = -2;
        check_ok (pg_conjugate_gradients (&op, b, y, 1e-11, 500, &all));
        chain.looked = 0;
        check_ok (pg_conjugate_gradients_watched (&op, NULL, b, x, 1e-10, 500, &used, &watch));
        looked = chain.looked / (double) used;
        apply_chain (&chain, x, y);
        for (size_t i = 0; i < N; i++) rr += (b[i] - y[i]) * (b[i] - y[i]), bb += b[i] * b[i];
        off = sqrt (rr / bb);
        print_message ("%zu iterations (%zu), residual %.1e, %.0f places of %d looked at\n", used, all, off,
                       looked, N);
        assert_true (off <= 1.01e-10 && used <= all + 3);
        assert_true (kind == 0 ? looked < 60 : looked > 0.9 * N);
        free (b), free (x), free (y);
    }
}

/* Room that the caller keeps: one solve after the other, smaller, larger, and after numbers that were none,
 * has the bits of a solve with room of its own. */
static void solves_in_kept_room_are_the_same (void **state)
{
    (void) state;
    static const size_t size[] = { 300, 9000, 40, 9000 };
    pg_cg_room room = { 0 };
    pg_cg_watch watch = { .room = &room };
    for (size_t k = 0; k < sizeof size / sizeof *size; k++) {
        size_t n = size[k], used, other;
        heavy_chain chain = { n, 0 };
        pg_operator op = { n, &chain, apply_chain, chain_diagonal };
        double *b = calloc (3 * n, sizeof *b), *x = b + n, *y = x + n;
        for (size_t i = 0; i < n; i++) b[i] = random_number ();
        check_ok (pg_conjugate_gradients_watched (&op, NULL, b, x, 1e-10, 500, &used, &watch));
        check_ok (pg_conjugate_gradients (&op, b, y, 1e-10, 500, &other));
        assert_int_equal (used, other);
        assert_memory_equal (x, y, n * sizeof *x);
        for (size_t i = 0; i < room.n; i++) room.v[i] = NAN;
        free (b);
    }
    pg_free (room.v);
}

static void lu_sees_a_singular_matrix (void **state)
{
    (void) state;
    dense D = random_laplacian (6, 2, 1);
    for (size_t i = 0; i < 36; i++) {                  /* a free body: rows sum to zero, exactly */
        double sum = 0;
        for (size_t j = 0; j < 36; j++) if (j != i) {
            dense_set (&D, i, j, D.in[i*36 + j] ? -1 : 0);
            sum += dense_at (&D, i, j);
        }
        dense_set (&D, i, i, -sum);
    }
    pg_sparse A = sparse_of (&D, 1);
    double b[36], x[36];
    for (int i = 0; i < 36; i++) b[i] = random_number ();
    check_fails (solve_with ("umfpack", &A, &(pg_linear_options) { 1, 2, 1, 0, 0 }, 1, b, x), PG_E_SINGULAR);
    pg_sparse_clear (&A);
    dense_free (&D);
}

static void lu_solves_indefinite_and_unsymmetric_systems (void **state)
{
    (void) state;
    size_t n = 60;
    for (int symmetric = 0; symmetric < 2; symmetric++) {
        dense D = dense_new (n, n);
        for (size_t i = 0; i < n; i++) dense_set (&D, i, i, i % 3 ? random_number () : 0);
        for (size_t k = 0; k < 6 * n; k++) {
            size_t i = (size_t) (n * (0.5 + 0.5 * random_number ())),
                   j = (size_t) (n * (0.5 + 0.5 * random_number ()));
            dense_set (&D, i, j, random_number ());
            if (symmetric) dense_set (&D, j, i, dense_at (&D, i, j));
        }
        pg_sparse A = sparse_of (&D, symmetric);
        double b[180], x[180];
        for (int i = 0; i < 180; i++) b[i] = random_number ();
        check_ok (solve_with ("umfpack", &A, &(pg_linear_options) { 1, 2, 1, 0, 0 }, 3, b, x));
        check_below (misfit (&D, 3, x, b), 1e-10);
        pg_sparse_clear (&A);
        dense_free (&D);
    }
}

static void each_failed_allocation_is_reported (void **state)
{
    (void) state;
    dense D = random_laplacian (5, 2, 2);
    pg_sparse A = sparse_of (&D, 1);
    double b[50] = { 1 }, x[50];
    size_t used = pg_memory_used ();
    for (int s = 0; s < NAMES; s++) {
        pg_status status = PG_E_MEMORY;
        size_t k = 0;
        while (status != PG_OK) {
            pg_memory_fail_at (++k);
            status = solve_with (names[s], &A, &(pg_linear_options) { 2, 2, 1, 1e-12, 0 }, 1, b, x);
            pg_memory_fail_at (0);
            if (status != PG_OK) assert_int_equal (status, PG_E_MEMORY);
            assert_int_equal (pg_memory_used (), used);
            assert_true (k < 100);
        }
        assert_true (k > 1);
    }
    pg_sparse_clear (&A);
    dense_free (&D);
}

/* Bytes that malloc has given out: libraries allocate past pg_calloc, so pg_memory_used knows nothing of it.
 * Sanitizers have a malloc of their own, which says 0 here and looks for leaks itself. */
static double given_out (void)
{
#if defined (__GLIBC__) && (__GLIBC__ > 2 || __GLIBC_MINOR__ >= 33)
    struct mallinfo2 m = mallinfo2 ();
#else
    struct mallinfo m = mallinfo ();
#endif
    return (double) m.uordblks + (double) m.hblkhd;
}

/* A factor replaces the one before it, after a failure too, and nothing is left when the solver is freed. */
static void a_new_factor_takes_the_place_of_the_old_one (void **state)
{
    (void) state;
    enum { ROUNDS = 40 };
    dense D = random_laplacian (12, 2, 2);
    size_t n = D.nrow;
    pg_sparse A = sparse_of (&D, 1);
    double *b = pg_calloc (n, sizeof *b), *x = pg_calloc (n, sizeof *x), last = A.value[A.start[n] - 1];
    b[3] = 1;
    for (int k = 0; k < NAMES; k++) {
        const pg_linear_type *type = pg_linear_find (names[k]);
        pg_linear_options o = { 2, 2, 1, 1e-12, 0 };
        check_ok (solve_with (names[k], &A, &o, 1, b, x));     /* what a library keeps for good it has now */
        double empty = given_out (), one = 0;
        for (int round = 0; round < ROUNDS; round++) {
            void *solver = NULL;
            check_ok (type->analyse (&solver, &A, &o));
            check_ok (type->factor (solver, &A));
            one = given_out () - empty;
            for (int again = 0; round == 0 && again < ROUNDS; again++) {
                A.value[A.start[n] - 1] = again % 2 ? last : NAN;
                pg_status got = type->factor (solver, &A);
                if (again % 2) check_ok (got);
            }
            check_ok (type->solve (solver, 1, b, x));
            check_below (misfit (&D, 1, x, b), 1e-10);
            check_below (given_out () - empty, 2 * one);
            type->free (&solver);
        }
        printf ("# %s: %.0f bytes for a factor, %.0f left after %d of them\n", names[k], one,
                given_out () - empty, 2 * ROUNDS);
        check_below (given_out () - empty, one);
    }
    pg_free (b), pg_free (x);
    pg_sparse_clear (&A);
    dense_free (&D);
}

/* The matrix goes while it is being factored: the same factor, to the bit. */
static void forget_entries (void *context)
{
    pg_sparse *A = context;
    memset (A->value, 0xff, (size_t) A->start[A->ncol] * sizeof *A->value);
    memset (A->row, 0xff, (size_t) A->start[A->ncol] * sizeof *A->row);
    A->symmetric = 2;
}

static void a_matrix_may_go_before_its_factor_is_made (void **state)
{
    (void) state;
    for (int wrong = 0; wrong < 2; wrong++) {
        dense D = random_laplacian (9, 3, 3);
        pg_sparse A = sparse_of (&D, 1);
        size_t n = D.nrow;
        const pg_linear_type *type = pg_linear_find ("cholmod");
        double *b = pg_calloc (n, sizeof *b), *x = pg_calloc (n, sizeof *x), *y = pg_calloc (n, sizeof *y);
        void *solver = NULL;
        for (size_t i = 0; i < n; i++) b[i] = random_number ();
        check_ok (type->analyse (&solver, &A, &(pg_linear_options) { 3, 3, 1, 1e-13, 0 }));
        if (wrong) A.value[A.start[n / 2 + 1] - 1] *= -1;
        pg_status whole = type->factor (solver, &A);
        long row = pg_linear_failed_row ();
        if (!wrong) check_ok (type->solve (solver, 1, b, x));
        assert_int_equal (type->factor_taking (solver, &A, forget_entries, &A), whole);
        assert_int_equal (A.symmetric, 2);
        assert_int_equal (whole, wrong ? PG_E_NOT_SPD : PG_OK);
        if (wrong) assert_int_equal (pg_linear_failed_row (), row);
        else {
            check_ok (type->solve (solver, 1, b, y));
            assert_memory_equal (x, y, n * sizeof *x);
        }
        type->free (&solver);
        pg_free (b), pg_free (x), pg_free (y);
        pg_sparse_clear (&A);
        dense_free (&D);
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (the_catalogue_knows_its_entries),
        cmocka_unit_test (systems_of_few_unknowns),
        cmocka_unit_test (every_solver_on_every_lattice),
        cmocka_unit_test (a_few_places_are_enough),
        cmocka_unit_test (the_order_is_the_one_with_fewer_operations),
        cmocka_unit_test (one_analysis_serves_many_factorizations),
        cmocka_unit_test (cholesky_refuses_what_is_not_positive_definite),
        cmocka_unit_test (conjugate_gradients_refuse_what_is_not_positive_definite),
        cmocka_unit_test (conjugate_gradients_say_when_they_do_not_arrive),
        cmocka_unit_test (local_right_hand_sides_are_solved_where_they_are),
        cmocka_unit_test (solves_in_kept_room_are_the_same),
        cmocka_unit_test (lu_sees_a_singular_matrix),
        cmocka_unit_test (lu_solves_indefinite_and_unsymmetric_systems),
        cmocka_unit_test (each_failed_allocation_is_reported),
        cmocka_unit_test (a_new_factor_takes_the_place_of_the_old_one),
        cmocka_unit_test (a_matrix_may_go_before_its_factor_is_made),
    };
    return cmocka_run_group_tests_name ("linalg/solvers", tests, NULL, NULL);
}

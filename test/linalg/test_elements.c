/* SPDX-License-Identifier: GPL-3.0-or-later
 * Products behind the preconditioner of finite elements: rows of blocks for any number of unknowns a node;
 * polynomials of N by rows that are alike or not; symmetry; threads. */
#include "systems.h"
#include <math.h>
#include <string.h>

enum { ALONG = 14, ACROSS = 4, NODES = ALONG * ACROSS * ACROSS };

static int node_at (int x, int y, int z) { return (z * ACROSS + y) * ALONG + x; }

/* Bricks of eight nodes of a lattice, each with the same symmetric matrix that is positive definite: pairs of
 * nodes hold each other, and every node the ground. */
static void make_bricks (pg_block_matrix *Q, int block, int threads)
{
    size_t n = (ALONG - 1) * (ACROSS - 1) * (ACROSS - 1), c = 0, width = 8 * (size_t) block;
    size_t *start = pg_calloc (n + 1, sizeof *start);
    int *node = pg_calloc (8 * n, sizeof *node);
    double *K = pg_calloc (width * width, sizeof *K);
    for (int z = 0; z + 1 < ACROSS; z++)
        for (int y = 0; y + 1 < ACROSS; y++)
            for (int x = 0; x + 1 < ALONG; x++, c++) {
                start[c + 1] = 8 * (c + 1);
                for (int k = 0; k < 8; k++)
                    node[8 * c + (size_t) k] = node_at (x + (k & 1), y + (k >> 1 & 1), z + (k >> 2));
            }
    for (size_t i = 0; i < width; i++)
        for (size_t j = 0; j < i; j++) {
            double k = -0.5 + 0.4 * random_number ();
            K[i * width + j] = K[j * width + i] = k;
            K[i * width + i] += fabs (k) + 0.01, K[j * width + j] += fabs (k) + 0.01;
        }
    check_ok (pg_block_create (Q, NODES, block, &(pg_adjacency) { n, start, node }, threads));
    for (c = 0; c < n; c++) pg_block_add (Q, 8, node + 8 * c, K);
    pg_free (start), pg_free (node), pg_free (K);
}

/* Sums of neighbours on the lattice within one step, weighted by 4, 2, 1, 1/2 and divided by their whole
 * sum; `noise`: share by which each is changed at random. */
static void make_N (pg_node_matrix *N, double noise)
{
    size_t e = 0;
    *N = (pg_node_matrix) { NODES, pg_calloc (NODES + 1, sizeof (size_t)),
                            pg_calloc (27 * NODES, sizeof (int)), pg_calloc (27 * NODES, sizeof (float)) };
    for (int i = 0; i < NODES; i++) {
        int at[3] = { i % ALONG, i / ALONG % ACROSS, i / ALONG / ACROSS };
        for (int k = 0; k < 27; k++) {
            int x = at[0] + k % 3 - 1, y = at[1] + k / 3 % 3 - 1, z = at[2] + k / 9 - 1;
            if (x < 0 || y < 0 || z < 0 || x >= ALONG || y >= ACROSS || z >= ACROSS) continue;
            int off = (x != at[0]) + (y != at[1]) + (z != at[2]);
            N->node[e] = node_at (x, y, z);
            N->value[e++] = (float) ((off ? pow (0.5, off) : 4) / 13.5 * (1 + noise * random_number ()));
        }
        N->start[i + 1] = e;
    }
}

static pg_element_preconditioner *make (int block, int threads, double noise, double *x)
{
    pg_element_preconditioner *P;
    pg_elements elements = { .spacing = 1, .reach = 2, .lattice = { 1, 1, 1 },
                             .terms = 6, .low = 0.1, .high = 1.1 };
    systems_seed = 88172645463325252u;
    make_bricks (&elements.Q, block, threads);
    make_N (&elements.N, noise);
    for (int i = 0; i < NODES; i++)
        x[3*i] = i % ALONG, x[3*i + 1] = i / ALONG % ACROSS, x[3*i + 2] = i / ALONG / ACROSS;
    pg_element_setting setting = { .dim = 3, .x = x };
    check_ok (pg_element_preconditioner_create (&P, &elements, &setting));
    assert_null (elements.Q.value);
    return P;
}

/* Against the blocks themselves, as the rows for the multilevel preconditioner tell them: row by row, and,
 * once the matrix is complete, rows that are alike eight at a time, on one thread and on three. One row has a
 * diagonal of its own. */
static void rows_of_blocks_are_multiplied (void **state)
{
    (void) state;
    for (int block = 1; block <= 4; block++) {
        pg_block_matrix Q;
        make_bricks (&Q, block, 1);
        size_t b = (size_t) block, n = NODES * b;
        double *x = pg_calloc (4 * n, sizeof *x), *y = x + n, *z = x + 2 * n, *again = x + 3 * n,
               value[27 * 16];
        int node[27];
        pg_block_add_diagonal (&Q, (size_t) node_at (ALONG / 2, 1, 2) * b, 0.5);
        for (size_t i = 0; i < n; i++) x[i] = random_number ();
        pg_operator op = pg_block_operator (&Q);
        pg_couplings rows = pg_block_couplings (&Q, 2);
        op.apply (op.context, x, y);
        for (size_t i = 0; i < NODES; i++) {
            size_t m = rows.row (rows.context, i, 0, node, value);
            for (size_t e = 0; e < m; e++)
                for (size_t k = 0; k < b * b; k++)
                    z[i * b + k / b] += value[e * b * b + k] * x[(size_t) node[e] * b + k % b];
        }
        for (size_t i = 0; i < n; i++) check_scaled (y[i], z[i], 1e-14, 100);
        check_ok (pg_block_settle (&Q));
        assert_int_equal (Q.alike.n > 0, block == 2 || block == 3);
        op.apply (op.context, x, y);
        for (size_t i = 0; i < n; i++) check_scaled (y[i], z[i], 1e-14, 100);
        Q.threads = 3;
        op.apply (op.context, x, again);
        assert_memory_equal (y, again, n * sizeof *y);
        pg_free (x);
        pg_block_clear (&Q);
    }
}

/* Rows that are alike, and rows that noise below the digits of a preconditioner keeps from being alike: the
 * same up to that noise, and not the same bits, as else nothing would have been alike. */
static void alike_or_not_the_polynomial_is_the_same (void **state)
{
    (void) state;
    for (int block = 2; block <= 3; block++) {
        double at[3 * NODES];
        size_t n = NODES * (size_t) block;
        double *r = pg_calloc (3 * n, sizeof *r), *z = r + n, *other = r + 2 * n, top = 0;
        pg_element_preconditioner *P = make (block, 1, 0, at), *Q = make (block, 1, 4e-6, at);
        for (size_t i = 0; i < n; i++) r[i] = random_number ();
        pg_preconditioner p = pg_element_preconditioner_of (P), q = pg_element_preconditioner_of (Q);
        check_ok (p.solve (p.context, r, z));
        check_ok (q.solve (q.context, r, other));
        for (size_t i = 0; i < n; i++) top = fmax (top, fabs (other[i]));
        for (size_t i = 0; i < n; i++) check_scaled (z[i], other[i], 2e-3, top);
        assert_memory_not_equal (z, other, n * sizeof *z);
        pg_element_preconditioner_free (&P), pg_element_preconditioner_free (&Q);
        pg_free (r);
    }
}

/* noise: 0: rows that are alike; else rows that see the same neighbours by other numbers, which must not be
 * taken for alike: p (N) and p (N') would no longer be transposes of each other. */
static void check_symmetry (double noise)
{
    double at[3 * NODES], ab = 0, ba = 0, aa = 0, bb = 0;
    size_t n = 3 * NODES;
    double *a = pg_calloc (5 * n, sizeof *a), *b = a + n, *Pa = b + n, *Pb = Pa + n, *again = Pb + n;
    pg_element_preconditioner *P = make (3, 1, noise, at), *Q = make (3, 3, noise, at);
    pg_preconditioner p = pg_element_preconditioner_of (P), q = pg_element_preconditioner_of (Q);
    for (size_t i = 0; i < n; i++) a[i] = random_number (), b[i] = random_number ();
    check_ok (p.solve (p.context, a, Pa));
    check_ok (p.solve (p.context, b, Pb));
    check_ok (q.solve (q.context, a, again));
    assert_memory_equal (Pa, again, n * sizeof *a);
    for (size_t i = 0; i < n; i++)
        ab += a[i] * Pb[i], ba += b[i] * Pa[i], aa += a[i] * Pa[i], bb += b[i] * Pb[i];
    assert_true (aa > 0 && bb > 0);
    check_scaled (ab, ba, 1e-6, sqrt (aa * bb));
    pg_element_preconditioner_free (&P), pg_element_preconditioner_free (&Q);
    pg_free (a);
}

static void it_is_symmetric_and_has_the_bits_of_one_thread (void **state)
{
    (void) state;
    check_symmetry (0), check_symmetry (0.2);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (rows_of_blocks_are_multiplied),
        cmocka_unit_test (alike_or_not_the_polynomial_is_the_same),
        cmocka_unit_test (it_is_symmetric_and_has_the_bits_of_one_thread),
    };
    return cmocka_run_group_tests_name ("linalg/elements", tests, NULL, NULL);
}

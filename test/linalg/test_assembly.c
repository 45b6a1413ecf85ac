/* SPDX-License-Identifier: GPL-3.0-or-later
 * The row-owned gather against a naive dense assembly of random families, by blocks and by sums that are
 * finished; redoing rows, adding threads and what is known of a source change no bit. */
#include "check.h"
#include "perigal/linalg.h"

/* Points see random nodes; point p brings sum_r g_r g_r', g_r (p, node, component) from a hash, times a
 * factor of the point. */
typedef struct { pg_adjacency family; int block, salt; double *factor; } random_source;

static uint64_t mix (uint64_t h)
{
    h ^= h >> 30, h *= 0xbf58476d1ce4e5b9u, h ^= h >> 27, h *= 0x94d049bb133111ebu;
    return h ^ h >> 31;
}

static double hash (int salt, size_t p, size_t node, int r, int k)
{
    uint64_t h = mix ((uint64_t) salt * 1000003
                      + mix (p * 7919 + mix (node * 104729 + (uint64_t) (10 * r + k))));
    return (double) (h >> 11) / 4503599627370496.0 - 1;
}

static random_source random_points (size_t npoint, size_t n, double share, int block, int salt)
{
    random_source s = { { npoint, pg_calloc (npoint + 1, sizeof (size_t)),
                          pg_calloc (npoint * n, sizeof (int)) },
                        block,
                        salt,
                        pg_calloc (npoint, sizeof (double)) };
    size_t at = 0;
    for (size_t p = 0; p < npoint; p++) {
        for (size_t i = 0; i < n; i++)
            if (hash (salt, p, i, 7, 7) < 2 * share - 1) s.family.node[at++] = (int) i;
        s.family.start[p + 1] = at;
        s.factor[p] = 1 + (double) (p % 5);
    }
    return s;
}

static void random_free (random_source *s)
{
    pg_free (s->family.start), pg_free (s->family.node), pg_free (s->factor);
}

static void entry (const random_source *s, size_t p, size_t i, size_t j, int alpha, int beta, double *out)
{
    for (int r = 0; r < 3; r++)
        *out += s->factor[p] * hash (s->salt, p, i, r, alpha) * hash (s->salt, p, j, r, beta);
}

static void blocks (void *context, size_t p, size_t a, size_t m, double *out)
{
    random_source *s = context;
    const int *node = s->family.node + s->family.start[p];
    for (size_t b = 0; b < m; b++)
        for (int k = 0; k < s->block * s->block; k++)
            entry (s, p, (size_t) node[a], (size_t) node[b], k / s->block, k % s->block,
                   out + b * (size_t) (s->block * s->block) + k);
}

static double *assemble (size_t n, int block, size_t nsource, const random_source *sources)
{
    size_t m = (size_t) block, ndof = n * m;
    double *K = pg_calloc (ndof * ndof, sizeof *K);
    for (size_t s = 0; s < nsource; s++)
        for (size_t p = 0; p < sources[s].family.n; p++)
            for (size_t a = sources[s].family.start[p]; a < sources[s].family.start[p + 1]; a++)
                for (size_t b = sources[s].family.start[p]; b < sources[s].family.start[p + 1]; b++)
                    for (size_t k = 0; k < m * m; k++) {
                        size_t i = (size_t) sources[s].family.node[a], j = (size_t) sources[s].family.node[b];
                        entry (&sources[s], p, i, j, (int) (k / m), (int) (k % m),
                               &K[(i * m + k / m) * ndof + j * m + k % m]);
                    }
    return K;
}

static pg_assembly *gathered (size_t n, int block, size_t nsource, random_source *sources, int threads)
{
    pg_assembly_source list[3];
    pg_assembly *K = NULL;
    for (size_t s = 0; s < nsource; s++)
        list[s] = (pg_assembly_source) { .seen = &sources[s].family, .context = &sources[s],
                                          .blocks = blocks };
    check_ok (pg_assembly_create (&K, n, block, nsource, list));
    check_ok (pg_assembly_gather (K, n, NULL, threads));
    return K;
}

static void well_formed (const pg_sparse *A)
{
    for (size_t j = 0; j < A->ncol; j++) {
        /* ends on its diagonal */
        assert_true (A->start[j + 1] > A->start[j] && A->row[A->start[j + 1] - 1] == (long) j);
        for (long p = A->start[j] + 1; p < A->start[j + 1]; p++) assert_true (A->row[p] > A->row[p - 1]);
    }
}

static void equals_the_naive_assembly (void **state)
{
    (void) state;
    for (int block = 1; block <= 3; block++)
        for (size_t nsource = 1; nsource <= 3; nsource++) {
            size_t n = 40, ndof = n * (size_t) block;
            random_source s[3] = { random_points (60, n, 0.12, block, 1), random_points (9, n, 0.3, block, 2),
                                   random_points (1, n, 0.0, block, 3) };
            pg_assembly *K = gathered (n, block, nsource, s, 1);
            const pg_sparse *A = pg_assembly_matrix (K);
            double *D = assemble (n, block, nsource, s);
            assert_true (A->symmetric && A->nrow == ndof && A->ncol == ndof);
            well_formed (A);
            for (size_t j = 0; j < ndof; j++)
                for (long p = A->start[j]; p < A->start[j + 1]; p++) {
                    size_t at = (size_t) A->row[p] * ndof + j;
                    check_scaled (A->value[p], D[at], 1e-13, 10);
                    D[at] = 0;
                }
            /* none is missing */
            for (size_t j = 0; j < ndof; j++)
                for (size_t i = 0; i <= j; i++) assert_true (D[i * ndof + j] == 0);
            pg_free (D);
            pg_assembly_free (&K);
            assert_null (K);
            for (int k = 0; k < 3; k++) random_free (&s[k]);
        }
}

static void redone_rows_equal_a_full_gather (void **state)
{
    (void) state;
    for (int block = 1; block <= 3; block++) {
        size_t n = 120;
        random_source s[2] = { random_points (150, n, 0.05, block, 4),
                               random_points (30, n, 0.04, block, 5) };
        pg_assembly *K = gathered (n, block, 2, s, 1);
        static const size_t touched[] = { 3, 4, 77, 149 };
        unsigned char mark[120] = { 0 };
        int list[120];
        size_t count = 0;
        for (int k = 0; k < 4; k++) {
            s[0].factor[touched[k]] = k ? 0.37 * k : 0;
            for (size_t e = s[0].family.start[touched[k]]; e < s[0].family.start[touched[k] + 1]; e++)
                mark[s[0].family.node[e]] = 1;
        }
        for (int i = 0; i < 120; i++) if (mark[i]) list[count++] = i;
        assert_true (count > 0 && count < n);
        check_ok (pg_assembly_gather (K, count, list, 1));
        pg_assembly *fresh = gathered (n, block, 2, s, 1);
        const pg_sparse *A = pg_assembly_matrix (K), *B = pg_assembly_matrix (fresh);
        assert_memory_equal (A->value, B->value, (size_t) A->start[A->ncol] * sizeof *A->value);
        pg_assembly_free (&K), pg_assembly_free (&fresh);
        random_free (&s[0]), random_free (&s[1]);
    }
}

static void threads_change_no_bit (void **state)
{
    (void) state;
    size_t n = 200;
    random_source s[1] = { random_points (250, n, 0.05, 2, 6) };
    pg_assembly *one = gathered (n, 2, 1, s, 1);
    const pg_sparse *A = pg_assembly_matrix (one);
    for (int threads = 2; threads <= 7; threads += 5) {
        pg_assembly *many = gathered (n, 2, 1, s, threads);
        assert_memory_equal (A->value, pg_assembly_matrix (many)->value,
                             (size_t) A->start[A->ncol] * sizeof *A->value);
        pg_assembly_free (&many);
    }
    pg_assembly_free (&one);
    random_free (&s[0]);
}

static void a_node_that_no_point_sees_keeps_its_diagonal (void **state)
{
    (void) state;
    size_t start[] = { 0, 2, 3 };
    int node[] = { 1, 3, 1 };
    double factor[] = { 1, 1 };
    random_source s = { { 2, start, node }, 2, 8, factor };
    pg_assembly *K = gathered (5, 2, 1, &s, 1);
    const pg_sparse *A = pg_assembly_matrix (K);
    well_formed (A);
    assert_int_equal (A->start[10], 5 * 3 + 4);
    for (size_t j = 0; j < 10; j++)
        for (long p = A->start[j]; p < A->start[j + 1]; p++) {
            if (j / 2 != 1 && j / 2 != 3) assert_true (A->value[p] == 0);
            else assert_true (A->value[p] != 0);
        }
    pg_assembly_free (&K);
}

/* The same blocks as rows of sums, which are those of the matrix with rows and columns of every block
 * exchanged, and twice as large, until they are finished. */
static void rows (void *context, size_t p, size_t a, size_t m, double *out)
{
    random_source *s = context;
    size_t block = (size_t) s->block, mm = block * block;
    double *all = pg_calloc (m * mm, sizeof *all);
    blocks (context, p, a, m, all);
    for (size_t b = 0; b < m; b++)
        for (size_t e = 0; e < mm; e++)
            out[(e % block * m + b) * block + e / block] += 2 * all[b * mm + e];
    pg_free (all);
}

/* finish is not told how many unknowns there are: that of the test at hand. */
static size_t finished_block;
static void finish (void *context, size_t m, double *sum)
{
    size_t n = finished_block;
    (void) context;
    for (size_t b = 0; b < m; b++)
        for (size_t i = 0; i < n; i++)
            for (size_t j = 0; j <= i; j++) {
                double *x = &sum[(i * m + b) * n + j], *y = &sum[(j * m + b) * n + i], keep = *x / 2;
                *x = *y / 2, *y = keep;
            }
}

static void sums_that_are_finished_equal_blocks (void **state)
{
    (void) state;
    for (int block = 1; block <= 3; block++) {
        size_t n = 90;
        finished_block = (size_t) block;
        random_source s[2] = { random_points (80, n, 0.1, block, 11),
                               random_points (20, n, 0.06, block, 12) };
        pg_assembly *K = gathered (n, block, 2, s, 1);
        const pg_sparse *A = pg_assembly_matrix (K);
        size_t entries = (size_t) A->start[A->ncol];
        pg_assembly_source list[2] = {
            { .seen = &s[0].family, .context = &s[0], .rows = rows, .finish = finish },
            { .seen = &s[1].family, .context = &s[1], .blocks = blocks }
        };
        pg_assembly *of[2] = { NULL, NULL };
        for (int k = 0; k < 2; k++) {
            check_ok (pg_assembly_create (&of[k], n, block, 2, list));
            check_ok (pg_assembly_gather (of[k], n, NULL, k ? 3 : 1));
        }
        const pg_sparse *B = pg_assembly_matrix (of[0]);
        assert_memory_equal (A->start, B->start, (A->ncol + 1) * sizeof *A->start);
        assert_memory_equal (A->row, B->row, entries * sizeof *A->row);
        for (size_t e = 0; e < entries; e++) check_scaled (B->value[e], A->value[e], 1e-13, 10);
        assert_memory_equal (B->value, pg_assembly_matrix (of[1])->value, entries * sizeof *B->value);
        pg_assembly_free (&of[0]), pg_assembly_free (&of[1]), pg_assembly_free (&K);
        random_free (&s[0]), random_free (&s[1]);
    }
}

/* What an assembly of the first source alone has come to is taken for it, bit by bit; rows that are asked for
 * later are computed. */
static void a_known_source_gives_the_same_bits (void **state)
{
    (void) state;
    for (int block = 1; block <= 3; block++) {
        size_t n = 80;
        random_source s[2] = { random_points (90, n, 0.07, block, 13),
                               random_points (25, n, 0.06, block, 14) };
        pg_assembly *alone = gathered (n, block, 1, s, 1), *both = gathered (n, block, 2, s, 1), *K = NULL;
        pg_assembly_source list[2] = {
            { .seen = &s[0].family, .context = &s[0], .blocks = blocks, .known = alone },
            { .seen = &s[1].family, .context = &s[1], .blocks = blocks }
        };
        pg_assembly_settle (alone);
        check_ok (pg_assembly_create (&K, n, block, 2, list));
        s[0].factor[3] *= 7;                           /* not looked at */
        check_ok (pg_assembly_gather (K, n, NULL, 2));
        pg_assembly_free (&alone);
        for (int again = 0; again < 2; again++) {
            const pg_sparse *A = pg_assembly_matrix (both), *B = pg_assembly_matrix (K);
            size_t entries = (size_t) A->start[A->ncol];
            assert_memory_equal (A->start, B->start, (A->ncol + 1) * sizeof *A->start);
            assert_memory_equal (A->row, B->row, entries * sizeof *A->row);
            assert_memory_equal (A->value, B->value, entries * sizeof *A->value);
            int list_of[80], count = 0;
            for (size_t e = s[0].family.start[3]; e < s[0].family.start[4]; e++)
                list_of[count++] = s[0].family.node[e];
            assert_true (count > 0);
            check_ok (pg_assembly_gather (K, (size_t) count, list_of, 1));
            check_ok (pg_assembly_gather (both, n, NULL, 1));
        }
        pg_assembly_free (&both), pg_assembly_free (&K);
        random_free (&s[0]), random_free (&s[1]);
    }
}

static void each_failed_allocation_is_reported (void **state)
{
    (void) state;
    random_source s[2] = { random_points (20, 30, 0.2, 2, 9), random_points (5, 30, 0.2, 2, 10) };
    pg_assembly_source list[2] = { { .seen = &s[0].family, .context = &s[0], .blocks = blocks },
                                   { .seen = &s[1].family, .context = &s[1], .blocks = blocks } };
    size_t used = pg_memory_used (), k = 0;
    pg_status status = PG_E_MEMORY;
    while (status != PG_OK) {
        pg_assembly *K = NULL;
        pg_memory_fail_at (++k);
        status = pg_assembly_create (&K, 30, 2, 2, list);
        if (status != PG_OK) assert_null (K);
        else status = pg_assembly_gather (K, 30, NULL, 2);
        pg_memory_fail_at (0);
        if (status != PG_OK) assert_int_equal (status, PG_E_MEMORY);
        pg_assembly_free (&K);
        assert_int_equal (pg_memory_used (), used);
        assert_true (k < 100);
    }
    assert_true (k > 15);
    random_free (&s[0]), random_free (&s[1]);
}

/* Graphs for forecasts: two nodes are coupled where a point sees both, or where a bond ties them; every node
 * to itself. */
static void graphs_hold_the_pairs_and_the_diagonal (void **state)
{
    (void) state;
    enum { N = 40 };
    random_source s[2] = { random_points (25, N, 0.1, 1, 3), random_points (10, N, 0.2, 1, 4) };
    const pg_adjacency *of[2] = { &s[0].family, &s[1].family };
    pg_adjacency bonds = { N, pg_calloc (N + 1, sizeof (size_t)), pg_calloc (N * N, sizeof (int)) };
    unsigned char seen[2][N][N] = { { { 0 } } };
    for (int k = 0; k < 2; k++)
        for (size_t p = 0; p < of[k]->n; p++)
            for (size_t a = of[k]->start[p]; a < of[k]->start[p + 1]; a++)
                for (size_t b = of[k]->start[p]; b < of[k]->start[p + 1]; b++)
                    seen[0][of[k]->node[a]][of[k]->node[b]] = 1;
    for (size_t i = 0, at = 0; i < N; i++) {
        for (size_t j = 0; j < N; j++)
            if (i != j && hash (5, i < j ? i : j, i < j ? j : i, 0, 0) > 0.6)
                bonds.node[at++] = (int) j, seen[1][i][j] = 1;
        bonds.start[i + 1] = at;
        seen[0][i][i] = seen[1][i][i] = 1;
    }
    for (int k = 0; k < 2; k++) {
        pg_sparse G;
        size_t at = 0;
        check_ok (k ? pg_assembly_graph_pairwise (&G, &bonds) : pg_assembly_graph (&G, N, 2, of));
        assert_true (G.symmetric && G.nrow == N && G.ncol == N);
        for (size_t j = 0; j < N; j++) {
            assert_int_equal (G.start[j], at);
            for (size_t i = 0; i <= j; i++) if (seen[k][i][j]) assert_int_equal (G.row[at++], i);
        }
        assert_int_equal (G.start[N], at);
        assert_true (at > 2 * N);
        pg_sparse_clear (&G);
    }
    pg_free (bonds.start), pg_free (bonds.node);
    random_free (&s[0]), random_free (&s[1]);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (equals_the_naive_assembly),
        cmocka_unit_test (redone_rows_equal_a_full_gather),
        cmocka_unit_test (threads_change_no_bit),
        cmocka_unit_test (a_node_that_no_point_sees_keeps_its_diagonal),
        cmocka_unit_test (graphs_hold_the_pairs_and_the_diagonal),
        cmocka_unit_test (sums_that_are_finished_equal_blocks),
        cmocka_unit_test (a_known_source_gives_the_same_bits),
        cmocka_unit_test (each_failed_allocation_is_reported),
    };
    return cmocka_run_group_tests_name ("linalg/assembly", tests, NULL, NULL);
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * Coarse functions over scattered nodes: they add up to 1 and to every linear field, collecting is the
 * transpose of spreading, and where no coupling crosses a plane no function has nodes on both sides. */
#include "systems.h"
#include <math.h>

enum { NODES = 900 };
static double place[3 * NODES];
static const double apart = 0.5, sees = 0.23;

/* Nodes within `sees` of each other on the same side of the plane x = apart. */
static size_t couplings (void *context, size_t i, int thread, int *node, double *value)
{
    const int *dim = context;
    size_t m = 0, d = (size_t) *dim;
    (void) thread, (void) value;
    for (size_t j = 0; j < NODES; j++) {
        double s = 0;
        for (size_t k = 0; k < d; k++) s += pow (place[i * d + k] - place[j * d + k], 2);
        if (s < sees * sees && (place[i * d] < apart) == (place[j * d] < apart)) node[m++] = (int) j;
    }
    return m;
}

static void make (pg_hats *h, int *dim, int threads)
{
    systems_seed = 88172645463325252u;
    for (int i = 0; i < *dim * NODES; i++) place[i] = 0.5 + 0.5 * random_number ();
    pg_hats_setting s = { .dim = *dim, .threads = threads, .n = NODES, .x = place, .step = 0.3,
                          .rows = { .context = dim, .widest = NODES, .reach = sees, .row = couplings } };
    check_ok (pg_hats_create (h, &s));
}

static void linear_fields_are_sums_of_functions (void **state)
{
    (void) state;
    for (int dim = 2; dim <= 3; dim++) {
        pg_hats h;
        make (&h, &dim, 1);
        assert_true (h.count < NODES / 4 && h.corners == 1 << dim && h.n == NODES);
        double *c = pg_calloc (2 * h.count, sizeof *c), *u = pg_calloc (2 * NODES, sizeof *u);
        for (size_t f = 0; f < h.count; f++) {
            c[2 * f] = 1, c[2 * f + 1] = 2;
            for (int k = 0; k < dim; k++) c[2 * f + 1] += (k + 1) * h.place[f * (size_t) dim + (size_t) k];
        }
        pg_hats_add (&h, 2, c, u);
        for (size_t i = 0; i < NODES; i++) {
            double want = 2;
            for (int k = 0; k < dim; k++) want += (k + 1) * place[i * (size_t) dim + (size_t) k];
            /* values are floats, those below 1e-5 left out */
            check_scaled (u[2 * i], 1, 1e-4, 1), check_scaled (u[2 * i + 1], want, 1e-4, 8);
        }
        pg_free (c), pg_free (u);
        pg_hats_clear (&h);
    }
}

static void collecting_is_the_transpose_of_spreading (void **state)
{
    (void) state;
    int dim = 3;
    pg_hats h, other;
    make (&h, &dim, 1), make (&other, &dim, 3);
    assert_int_equal (h.count, other.count);
    size_t n = 3 * NODES, m = 3 * h.count;
    double *x = pg_calloc (3 * n, sizeof *x), *Hy = x + n, *Gy = Hy + n, *y = pg_calloc (3 * m, sizeof *y),
           *Hx = y + m, *Gx = Hx + m, a = 0, b = 0, top = 0;
    for (size_t i = 0; i < n; i++) x[i] = random_number ();
    for (size_t i = 0; i < m; i++) y[i] = random_number ();
    pg_hats_restrict (&h, 3, x, Hx), pg_hats_restrict (&other, 3, x, Gx);
    pg_hats_add (&h, 3, y, Hy), pg_hats_add (&other, 3, y, Gy);
    assert_memory_equal (Hx, Gx, m * sizeof *Hx), assert_memory_equal (Hy, Gy, n * sizeof *Hy);
    for (size_t i = 0; i < n; i++) a += x[i] * Hy[i], top += fabs (x[i] * Hy[i]);
    for (size_t i = 0; i < m; i++) b += y[i] * Hx[i];
    check_scaled (a, b, 1e-12, top);
    pg_free (x), pg_free (y);
    pg_hats_clear (&h), pg_hats_clear (&other);
}

static void functions_end_where_no_coupling_crosses (void **state)
{
    (void) state;
    int dim = 3;
    pg_hats h;
    make (&h, &dim, 2);
    for (size_t f = 0; f < h.count; f++) {
        int left = place[3 * (size_t) h.member[h.first[f]]] < apart;
        assert_true (h.first[f + 1] > h.first[f]);
        for (size_t e = h.first[f]; e < h.first[f + 1]; e++)
            assert_int_equal (place[3 * (size_t) h.member[e]] < apart, left);
    }
    pg_hats_clear (&h);
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (linear_fields_are_sums_of_functions),
                                        cmocka_unit_test (collecting_is_the_transpose_of_spreading),
                                        cmocka_unit_test (functions_end_where_no_coupling_crosses) };
    return cmocka_run_group_tests_name ("linalg/hats", tests, NULL, NULL);
}

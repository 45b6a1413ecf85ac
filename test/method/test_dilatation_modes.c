/* SPDX-License-Identifier: GPL-3.0-or-later
 * Modes of a free block as Poisson's ratio goes to 1/2 at the same shear modulus: with the dilatation of
 * patches none is free but the rigid ones, the lowest ones converge, with the ratio and with the spacing;
 * with the dilatation at the points they stiffen. */
#include "method/spectrum.h"
#include <gsl/gsl_sort_vector.h>

typedef struct { int dim, cells; double nu; const char *method, *dilatation; } block;

/* M, ndof x ndof, from one number for each pair of nodes */
static double *dense_mass (assembled *a)
{
    size_t n = a->ndof, dim = (size_t) a->problem->dim;
    double *M = pg_calloc (n * n, sizeof *M);
    const pg_sparse *m;
    check_ok (a->force->mass (a->self, NULL, &m));
    for (size_t j = 0; j < m->ncol; j++)
        for (long e = m->start[j]; e < m->start[j + 1]; e++)
            for (size_t k = 0; k < dim; k++) {
                size_t r = (size_t) m->row[e] * dim + k, c = j * dim + k;
                M[r * n + c] = M[c * n + r] = m->value[e];
            }
    return M;
}

/* Lowest eigenvalues, ascending, of K x = lambda M x, consistent mass; shear modulus, density and edge 1. */
static void modes_of (const block *b, double *lambda, size_t most)
{
    char text[800];
    const char *high = b->dim == 2 ? "low: [0, 0], high: [1, 1]" : "low: [0, 0, 0], high: [1, 1, 1]";
    snprintf (text, sizeof text,
              "dimension: %d\n%sbody: [{add: {box: {%s}}}]\nspacing: %.17g\nmaterials: {soft: "
              "{youngs_modulus: %.17g, poissons_ratio: %.17g, density: 1}}\n"
              "method: {%s, dilatation: %s}\nboundary: []\nsolver: {kind: static}\n",
              b->dim, b->dim == 2 ? "plane: strain\n" : "", high, 1.0 / b->cells, 2 * (1 + b->nu), b->nu,
              b->method, b->dilatation);
    assembled a = assemble (text, "block.yaml");
    size_t n = a.ndof;
    double *K = dense_stiffness (&a), *M = dense_mass (&a), *all = pg_calloc (n, sizeof *all);
    gsl_error_handler_t *handler = gsl_set_error_handler_off ();
    gsl_matrix_view stiffness = gsl_matrix_view_array (K, n, n), mass = gsl_matrix_view_array (M, n, n);
    gsl_vector_view value = gsl_vector_view_array (all, n);
    gsl_eigen_gensymm_workspace *work = gsl_eigen_gensymm_alloc (n);
    assert_non_null (work);
    assert_int_equal (gsl_eigen_gensymm (&stiffness.matrix, &mass.matrix, &value.vector, work), 0);
    gsl_eigen_gensymm_free (work);
    gsl_set_error_handler (handler);
    gsl_sort_vector (&value.vector);
    memcpy (lambda, all, most * sizeof *lambda);
    pg_free (K), pg_free (M), pg_free (all);
    release (&a);
}

static const char *const methods[] = { "integration: gauss", "integration: consistent",
                                       "integration: gauss, basis: quadratic, horizon: 2.6 spacing",
                                       "integration: nodal" };
enum { SHOWN = 12 };

static void check_block (int dim, int cells, const char *method)
{
    size_t rigid = dim == 2 ? 3 : 6;
    double before[SHOWN], now[SHOWN];
    for (double gap = 0.2; gap > 5e-6; gap *= 0.1) {
        block b = { dim, cells, 0.5 - gap, method, "projected" };
        modes_of (&b, now, SHOWN);
        print_message ("  %dD, %s, nu %.6g: %.3g | %.5g %.5g %.5g %.5g\n", dim, method, b.nu, now[rigid - 1],
                       now[rigid], now[rigid + 1], now[rigid + 2], now[rigid + 3]);
        check_below (fabs (now[rigid - 1]), 1e-9 * now[rigid] * fmax (1, 1e-3 / gap));
        assert_true (now[rigid] > 1);                  /* mu / edge^2 is 1: no mode of no energy */
        for (size_t k = rigid; gap < 5e-3 && k < rigid + 4; k++)
            check_below (fabs (now[k] / before[k] - 1), 5 * gap * 10);
        memcpy (before, now, sizeof now);
    }
}

static void a_block_has_no_free_and_no_locked_modes (void **state)
{
    (void) state;
    for (int m = 0; m < 4; m++) check_block (2, 8, methods[m]);
}

static void nor_has_one_in_3d (void **state)
{
    (void) state;
    check_block (3, 4, methods[0]);
}

static void they_converge_with_the_spacing (void **state)
{
    (void) state;
    double coarse[SHOWN], fine[SHOWN], locked[SHOWN];
    for (int m = 0; m < 2; m++) {
        modes_of (&(block) { 2, 8, 0.4999, methods[m], "projected" }, coarse, SHOWN);
        modes_of (&(block) { 2, 16, 0.4999, methods[m], "projected" }, fine, SHOWN);
        modes_of (&(block) { 2, 8, 0.4999, methods[m], "pointwise" }, locked, SHOWN);
        for (size_t k = 3; k < 7; k++) {
            print_message ("  %s: mode %zu: 8 cells %.5g, 16 cells %.5g, 8 cells pointwise %.5g\n",
                           methods[m], k - 2, coarse[k], fine[k], locked[k]);
            check_below (fabs (coarse[k] / fine[k] - 1), 2e-3);
        }
        check_below (fabs (coarse[4] / 19.739208802178716 - 1), 1e-3);  /* Lame's mode, 2 pi^2 at any ratio */
        for (size_t k = 4; k < 7; k++) assert_true (locked[k] > 1.05 * fine[k]);
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (a_block_has_no_free_and_no_locked_modes),
        cmocka_unit_test (nor_has_one_in_3d),
        cmocka_unit_test (they_converge_with_the_spacing),
    };
    return cmocka_run_group_tests_name ("method/dilatation_modes", tests, NULL, NULL);
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * spectrum.h: the Galerkin force of a scene, its dense stiffness, the eigenvalues of a dense symmetric
 * matrix. */
#ifndef PERIGAL_TEST_SPECTRUM_H
#define PERIGAL_TEST_SPECTRUM_H
#include "check.h"
#include "perigal/force.h"
#include <gsl/gsl_eigen.h>
#include <gsl/gsl_errno.h>

/* A problem with its force, every bond alive. */
typedef struct {
    pg_scene *scene;
    pg_problem *problem;
    pg_state *state;
    const pg_force_type *force;
    void *self;
    size_t ndof;
} assembled;

static inline assembled assemble (const char *text, const char *name)
{
    assembled a = { 0 };
    check_ok (pg_scene_parse (&a.scene, text, name));
    check_ok (pg_problem_build (&a.problem, a.scene, 1));
    a.force = pg_force_of (a.problem);
    check_ok (a.force->create (&a.self, a.problem));
    check_ok (pg_state_create (&a.state, a.problem, a.problem->dim));
    check_ok (a.force->refresh (a.self, a.state, NULL));
    a.ndof = a.problem->cloud.n * (size_t) a.problem->dim;
    return a;
}

static inline void release (assembled *a)
{
    a->force->free (&a->self);
    pg_state_free (&a->state);
    pg_problem_free (&a->problem);
    pg_scene_free (&a->scene);
}

static inline void multiply (assembled *a, const double *x, double *y)
{
    const pg_operator *K = a->force->operator_ (a->self);
    K->apply (K->context, x, y);
}

/* K, ndof x ndof; to be freed with pg_free */
static inline double *dense_stiffness (assembled *a)
{
    size_t n = a->ndof;
    double *K = pg_calloc (n * n, sizeof *K), *unit = pg_calloc (n, sizeof *unit);
    for (size_t j = 0; j < n; j++) {
        unit[j] = 1;
        multiply (a, unit, K + j * n);
        unit[j] = 0;
    }
    pg_free (unit);
    return K;
}

/* Eigenvalues, ascending, of symmetric A (n x n, destroyed). */
static inline void eigenvalues (size_t n, double *A, double *lambda)
{
    gsl_error_handler_t *handler = gsl_set_error_handler_off ();
    gsl_matrix_view view = gsl_matrix_view_array (A, n, n);
    gsl_vector_view value = gsl_vector_view_array (lambda, n);
    gsl_eigen_symm_workspace *work = gsl_eigen_symm_alloc (n);
    assert_non_null (work);
    assert_int_equal (gsl_eigen_symm (&view.matrix, &value.vector, work), 0);
    gsl_eigen_symm_free (work);
    gsl_set_error_handler (handler);
    for (size_t i = 1; i < n; i++)                     /* insertion sort: n is a few hundred */
        for (size_t k = i; k > 0 && lambda[k - 1] > lambda[k]; k--) {
            double swap = lambda[k];
            lambda[k] = lambda[k - 1], lambda[k - 1] = swap;
        }
}

/* How many of the ascending eigenvalues are zero: at most `tiny` of the largest in size. */
static inline size_t count_zero (size_t n, const double *lambda, double tiny)
{
    size_t count = 0;
    for (size_t i = 0; i < n; i++) count += fabs (lambda[i]) <= tiny * lambda[n - 1];
    return count;
}
#endif

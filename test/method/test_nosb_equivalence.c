/* SPDX-License-Identifier: GPL-3.0-or-later
 * Nodal Galerkin with NOSB derivatives is NOSB-PD (theory D1, table H D-1): (K u)_i = -V_i L_i with the
 * force-state sum L_i = sum_j w_ij (sigma_i K_i + sigma_j K_j) xi_ij V_j, written here from the points alone,
 * on clouds without any order. */
#include "spectrum.h"
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

enum { MOST = 300 };
/* T = sigma K */
typedef struct { int dim; size_t n; double x[MOST][3], V[MOST], u[MOST][3], T[MOST][3][3]; } cloud;

static unsigned long long seed;
static double rnd (void)                               /* in (-1, 1) */
{
    seed = seed * 6364136223846793005ull + 1442695040888963407ull;
    return (double) (seed >> 11) / 4503599627370496.0 - 1;
}

/* per_axis^dim points near a lattice of spacing h, moved by up to 0.3 h, volumes of their own, random
 * displacements. */
static void scatter (cloud *c, int dim, int per_axis, double h)
{
    seed = 11 + (unsigned) dim;
    *c = (cloud){ .dim = dim,
                  .n = (size_t) (dim == 3 ? per_axis * per_axis * per_axis : per_axis * per_axis) };
    for (size_t i = 0; i < c->n; i++) {
        size_t rest = i;
        for (int k = 0; k < dim; k++, rest /= (size_t) per_axis) {
            c->x[i][k] = h * ((double) (rest % (size_t) per_axis) + 0.3 * rnd ());
            c->u[i][k] = 1e-3 * h * rnd ();
        }
        c->V[i] = pow (h, dim) * (1 + 0.4 * rnd ());
    }
}

/* The scene of these points; the file lies in the folder for temporary files. */
static assembled from_file (const cloud *c, const char *plane, const char *kernel, double horizon)
{
    char path[256], text[1024];
    const char *folder = getenv ("TMPDIR");
    snprintf (path, sizeof path, "%s/perigal-nosb-XXXXXX", folder ? folder : "/tmp");
    int handle = mkstemp (path);
    assert_true (handle >= 0);
    FILE *file = fdopen (handle, "w");
    assert_non_null (file);
    for (size_t i = 0; i < c->n; i++) {
        for (int k = 0; k < c->dim; k++) fprintf (file, "%.17g,", c->x[i][k]);
        fprintf (file, "%.17g\n", c->V[i]);
    }
    fclose (file);
    snprintf (
        text, sizeof text,
        "dimension: %d\n%s%s%spoints: %s\nmaterials: {m: {youngs_modulus: 3 GPa, poissons_ratio: 0.3}}\n"
        "method: {approximation: nosb, integration: nodal, stabilization: none, kernel: %s, horizon: %.17g "
        "m}\n",
        c->dim, plane ? "plane: " : "", plane ? plane : "", plane ? "\n" : "", path, kernel, horizon);
    assembled a = assemble (text, "points.yaml");
    remove (path);
    return a;
}

static double kernel_value (const char *name, double q)
{
    return strcmp (name, "constant") == 0 ? 1 : 1 - q * q;
}

static void invert (int dim, double A[3][3], double B[3][3])
{
    if (dim == 2) {
        double det = A[0][0] * A[1][1] - A[0][1] * A[1][0];
        B[0][0] = A[1][1] / det, B[1][1] = A[0][0] / det, B[0][1] = -A[0][1] / det, B[1][0] = -A[1][0] / det;
        return;
    }
    double det = 0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            int a = (j + 1) % 3, b = (j + 2) % 3, r = (i + 1) % 3, s = (i + 2) % 3;
            B[i][j] = A[a][r] * A[b][s] - A[a][s] * A[b][r];
        }
    for (int j = 0; j < 3; j++) det += A[0][j] * B[j][0];
    for (int i = 0; i < 9; i++) B[i / 3][i % 3] /= det;
}

/* w_ij with the bond; 0 outside of the horizon */
static double bond (const cloud *c, size_t i, size_t j, const char *kernel, double horizon, double *xi)
{
    double r = 0;
    for (int k = 0; k < c->dim; k++) xi[k] = c->x[j][k] - c->x[i][k], r += xi[k] * xi[k];
    r = sqrt (r);
    return i != j && r <= horizon ? kernel_value (kernel, r / horizon) : 0;
}

/* T_i = sigma_i K_i with sigma from eps = sym (sum w eta xi' V K): lambda tr eps I + 2 mu eps */
static void force_state (cloud *c, size_t i, const char *kernel, double horizon, double lambda, double mu)
{
    double A[3][3] = { { 0 } }, K[3][3] = { { 0 } }, M[3][3] = { { 0 } }, H[3][3] = { { 0 } }, sigma[3][3],
           trace = 0, xi[3];
    int dim = c->dim;
    for (size_t j = 0; j < c->n; j++) {
        double w = bond (c, i, j, kernel, horizon, xi) * c->V[j];
        for (int a = 0; a < dim && w > 0; a++)
            for (int b = 0; b < dim; b++)
                A[a][b] += w * xi[a] * xi[b], M[a][b] += w * (c->u[j][a] - c->u[i][a]) * xi[b];
    }
    invert (dim, A, K);
    for (int a = 0; a < dim; a++)
        for (int b = 0; b < dim; b++)
            for (int k = 0; k < dim; k++) H[a][b] += M[a][k] * K[k][b];
    for (int a = 0; a < dim; a++) trace += H[a][a];
    for (int a = 0; a < dim; a++)
        for (int b = 0; b < dim; b++) sigma[a][b] = mu * (H[a][b] + H[b][a]) + (a == b) * lambda * trace;
    for (int a = 0; a < dim; a++)
        for (int b = 0; b < dim; b++) {
            c->T[i][a][b] = 0;
            for (int k = 0; k < dim; k++) c->T[i][a][b] += sigma[a][k] * K[k][b];
        }
}

static void compare (int dim, int per_axis, const char *plane, const char *kernel)
{
    static cloud c;
    double h = 2e-3, horizon = (dim == 3 ? 2.4 : 3.015) * h, E = 3e9, nu = 0.3, mu = E / (2 * (1 + nu));
    double lambda = plane && strcmp (plane, "stress") == 0 ? E * nu / (1 - nu * nu)
                                                           : E * nu / ((1 + nu) * (1 - 2 * nu));
    scatter (&c, dim, per_axis, h);
    assembled a = from_file (&c, plane, kernel, horizon);
    double *u = pg_calloc (a.ndof, sizeof *u), *Ku = pg_calloc (a.ndof, sizeof *Ku), worst = 0, size = 0;
    for (size_t i = 0; i < c.n; i++)
        for (int k = 0; k < dim; k++) u[i * (size_t) dim + (size_t) k] = c.u[i][k];
    multiply (&a, u, Ku);
    for (size_t i = 0; i < c.n; i++) force_state (&c, i, kernel, horizon, lambda, mu);
    for (size_t i = 0; i < c.n; i++) {
        double L[3] = { 0 }, xi[3];
        for (size_t j = 0; j < c.n; j++) {
            double w = bond (&c, i, j, kernel, horizon, xi);
            for (int k = 0; k < dim && w > 0; k++)
                for (int l = 0; l < dim; l++) L[k] += w * (c.T[i][k][l] + c.T[j][k][l]) * xi[l] * c.V[j];
        }
        for (int k = 0; k < dim; k++) {
            worst = fmax (worst, fabs (Ku[i * (size_t) dim + (size_t) k] + c.V[i] * L[k]));
            size = fmax (size, fabs (Ku[i * (size_t) dim + (size_t) k]));
        }
    }
    assert_true (size > 0);
    check_below (worst / size, 1e-13);
    pg_free (u), pg_free (Ku);
    release (&a);
}

static void plane_stress_equals_the_force_state_formula (void **state)
{
    (void) state;
    compare (2, 13, "stress", "constant");
}
static void plane_strain_equals_the_force_state_formula (void **state)
{
    (void) state;
    compare (2, 13, "strain", "quadratic");
}
static void solid_equals_the_force_state_formula (void **state)
{
    (void) state;
    compare (3, 6, NULL, "constant");
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (plane_stress_equals_the_force_state_formula),
        cmocka_unit_test (plane_strain_equals_the_force_state_formula),
        cmocka_unit_test (solid_equals_the_force_state_formula),
    };
    return cmocka_run_group_tests_name ("method/nosb_equivalence", tests, NULL, NULL);
}

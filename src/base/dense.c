/* SPDX-License-Identifier: GPL-3.0-or-later
 * Small dense algebra for moment matrices, shape tensors and principal stresses, row-major: Cholesky
 * factorisation A = L L', solution of A x = b, eigenvalues A = V diag (lambda) V'. */
#include "perigal/base.h"
#include <math.h>

/* Factorises column by column. A pivot is compared with the diagonal entry it came from: the loss of digits
 * by cancellation is what makes it worthless, whatever the scale of the row. */
int pg_dense_cholesky (int n, double *A, double tiny)
{
    for (int j = 0; j < n; j++) {
        double d = A[j*n + j], top = d;
        for (int k = 0; k < j; k++) d -= A[j*n + k] * A[j*n + k];
        /* Written so that a NaN counts as a failed pivot. */
        if (!(d > tiny * top)) return j + 1;
        d = sqrt (d);
        A[j*n + j] = d;
        for (int i = j + 1; i < n; i++) {
            double s = A[i*n + j];
            for (int k = 0; k < j; k++) s -= A[i*n + k] * A[j*n + k];
            A[i*n + j] = s / d;
        }
    }
    return 0;
}

/* Forward, then backward substitution. */
void pg_dense_solve (int n, const double *L, double *b)
{
    for (int i = 0; i < n; i++) {
        for (int k = 0; k < i; k++) b[i] -= L[i*n + k] * b[k];
        b[i] /= L[i*n + i];
    }
    for (int i = n - 1; i >= 0; i--) {
        for (int k = i + 1; k < n; k++) b[i] -= L[k*n + i] * b[k];
        b[i] /= L[i*n + i];
    }
}

/* One Jacobi rotation, M <- R' M R, V <- V R, that makes M[p][q] zero. */
static void rotate (int n, double *M, double *V, int p, int q)
{
    double theta = (M[q*n + q] - M[p*n + p]) / (2 * M[p*n + q]);
    double t = (theta >= 0 ? 1 : -1) / (fabs (theta) + sqrt (theta * theta + 1));
    double c = 1 / sqrt (t * t + 1), s = t * c;
    for (int k = 0; k < n; k++) {
        double a = M[k*n + p], b = M[k*n + q];
        M[k*n + p] = c * a - s * b;
        M[k*n + q] = s * a + c * b;
    }
    for (int k = 0; k < n; k++) {
        double a = M[p*n + k], b = M[q*n + k];
        M[p*n + k] = c * a - s * b;
        M[q*n + k] = s * a + c * b;
        a = V[k*n + p], b = V[k*n + q];
        V[k*n + p] = c * a - s * b;
        V[k*n + q] = s * a + c * b;
    }
}

/* Sorts the eigenvalues on the diagonal of M into lambda, largest first, and with them the eigenvectors, the
 * columns of W (selection sort). */
static void sort_eigen (int n, double *M, double *W, double *lambda)
{
    for (int i = 0; i < n; i++) {
        int top = i;
        for (int j = i + 1; j < n; j++) if (M[j*n + j] > M[top*n + top]) top = j;
        lambda[i] = M[top*n + top];
        M[top*n + top] = M[i*n + i];
        for (int k = 0; k < n; k++) {
            double w = W[k*n + top];
            W[k*n + top] = W[k*n + i];
            W[k*n + i] = w;
        }
    }
}

/* Cyclic Jacobi rotations until the sum of the squares off the diagonal is 1e-32 of that of all entries;
 * small entries are passed over. n <= 16. */
void pg_dense_eigen (int n, const double *A, double *lambda, double *V)
{
    enum { PASSES = 60 };
    double M[256], W[256];
    for (int i = 0; i < n * n; i++) M[i] = A[i], W[i] = 0;
    for (int i = 0; i < n; i++) W[i*n + i] = 1;
    for (int pass = 0; pass < PASSES; pass++) {
        double off = 0, all = 0;
        for (int i = 0; i < n; i++)
            for (int j = 0; j < n; j++) {
                all += M[i*n + j] * M[i*n + j];
                if (i != j) off += M[i*n + j] * M[i*n + j];
            }
        if (!(off > 1e-32 * all)) break;
        for (int p = 0; p < n; p++)
            for (int q = p + 1; q < n; q++)
                if (M[p*n + q] * M[p*n + q] > 1e-36 * all) rotate (n, M, W, p, q);
    }
    sort_eigen (n, M, W, lambda);
    if (V) for (int i = 0; i < n * n; i++) V[i] = W[i];
}

double pg_dense_det (int n, const double *A)
{
    if (n == 1) return A[0];
    if (n == 2) return A[0] * A[3] - A[1] * A[2];
    return A[0] * (A[4] * A[8] - A[5] * A[7]) - A[1] * (A[3] * A[8] - A[5] * A[6])
           + A[2] * (A[3] * A[7] - A[4] * A[6]);
}

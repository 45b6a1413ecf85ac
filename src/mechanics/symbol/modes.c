/* SPDX-License-Identifier: GPL-3.0-or-later
 * The symbol S (k) of a lattice (Fourier transform of its blocks K_0j), its eigenvalues and frequencies for
 * one wave vector k, and its limit for long waves. */
#include "symbol.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { M = PG_UNKNOWNS };

/* cos (a n) and sin (a n) for a = k step. At multiples of pi they are exactly +-1 and 0: at the edges of the
 * Brillouin zone modes without energy would otherwise get rounding instead of zero. */
static void phase (double a, int n, double *c, double *s)
{
    double half = a * n / (4 * atan (1)), whole = nearbyint (half);            /* in units of pi */
    *c = cos (a * n), *s = sin (a * n);
    if (fabs (half - whole) < 1e-13 * (1 + fabs (half))) *c = fmod (whole, 2) == 0 ? 1 : -1, *s = 0;
}

/* Sum of the blocks (`count` numbers each) times exp (i k.(x_j - x_0)). Successive offsets
 * mostly differ along one axis only, so the phases of the last offset are kept. */
static void transform (const pg_symbol *s, const double *k, size_t count, const double *block, double *real,
                       double *imaginary)
{
    double x[3] = { 1, 1, 1 }, y[3] = { 0 };
    int last[3] = { 0 };
    memset (real, 0, count * sizeof *real), memset (imaginary, 0, count * sizeof *imaginary);
    for (size_t j = 0; j < s->n; j++) {
        double c = 1, d = 0;
        for (int a = 0; a < s->dim; a++) {
            double old = c;
            int n = s->offset[3 * j + (size_t) a];
            if (n != last[a]) phase (k[a] * s->step[a], last[a] = n, &x[a], &y[a]);
            c = c * x[a] - d * y[a], d = old * y[a] + d * x[a];
        }
        for (size_t e = 0; e < count; e++)
            real[e] += c * block[j * count + e], imaginary[e] += d * block[j * count + e];
    }
}

void pg_symbol_at (const pg_symbol *s, const double *k, double *real, double *imaginary)
{
    transform (s, k, (size_t) (s->unknowns * s->unknowns), s->block, real, imaginary);
}

double pg_symbol_amplitude (const pg_symbol *s, const double *k)
{
    double real = 1, imaginary;
    if (s->spread) transform (s, k, 1, s->spread, &real, &imaginary);
    return real;
}

/* Replaces shares of modes with nearly equal values by their mean: such modes span a space in which any basis
 * is as good as another, so shares of single modes have no meaning. */
static void level (pg_symbol_modes *o, double scale)
{
    for (int i = 0, j; i < o->n; i = j) {
        double turning = 0, along = 0;
        for (j = i; j < o->n && o->value[j] - o->value[i] <= 1e-9 * scale; j++)
            turning += o->turning[j], along += o->along[j];
        for (int q = i; q < j; q++) o->turning[q] = turning / (j - i), o->along[q] = along / (j - i);
    }
}

/* Solves the eigenvalue problem of the Hermitian matrix A + iB as the real symmetric [A, -B; B, A] of twice
 * the size, which has each eigenvalue twice. Both copies are averaged. Eigenvalues below the rounding of the
 * blocks (1e-14) are set to 0. */
void pg_symbol_solve (const pg_symbol *s, const double *k, int weighted, pg_symbol_modes *o)
{
    double A[M * M], B[M * M], scale[M], W[4 * M * M], value[2 * M], vector[4 * M * M],
        norm = 0, unit[3] = { 0 }, rounding = 0;
    int m = s->unknowns, live[M], n = 0;
    pg_symbol_at (s, k, A, B);
    memset (o, 0, sizeof *o);
    for (int i = 0; i < m; i++) if (!s->held[i]) live[n++] = i;
    for (int i = 0; i < m; i++)
        scale[i] = weighted ? 1 / sqrt (s->mass[i]) : s->h / sqrt (s->material.modulus * s->volume);
    for (int i = 0; i < n; i++) rounding = fmax (rounding, 1e-14 * s->size * scale[live[i]] * scale[live[i]]);
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) {
            double f = scale[live[i]] * scale[live[j]];
            double a = f * 0.5 * (A[live[i] * m + live[j]] + A[live[j] * m + live[i]]),
                   b = f * 0.5 * (B[live[i] * m + live[j]] - B[live[j] * m + live[i]]);
            W[i * 2 * n + j] = W[(n + i) * 2 * n + n + j] = a, W[i * 2 * n + n + j] = -b,
                          W[(n + i) * 2 * n + j] = b;
        }
    pg_dense_eigen (2 * n, W, value, vector);
    for (int a = 0; a < s->dim; a++) norm += k[a] * k[a];
    for (int a = 0; a < s->dim; a++) unit[a] = norm > 0 ? k[a] / sqrt (norm) : 0;
    o->n = n;
    for (int i = 0; i < n; i++) {
        double moved = 0, along = 0;
        for (int q = 2 * (n - 1 - i); q < 2 * (n - i); q++)
            for (int part = 0; part < 2; part++) {
                double dot = 0;
                for (int r = 0; r < n; r++) {
                    double v = vector[(part * n + r) * 2 * n + q];
                    if (live[r] < s->dim) moved += v * v / 2, dot += v * unit[live[r]];
                }
                along += dot * dot / 2;
            }
        o->value[i] = 0.5 * (value[2 * (n - 1 - i)] + value[2 * (n - 1 - i) + 1]);
        if (fabs (o->value[i]) <= rounding) o->value[i] = 0;
        o->turning[i] = 1 - moved, o->along[i] = moved > 1e-12 ? along / moved : 0;
    }
    level (o, fmax (fabs (value[0]), fabs (value[2 * n - 1])));
    for (int i = 0; weighted && i < n; i++) o->value[i] = copysign (sqrt (fabs (o->value[i])), o->value[i]);
}

/* ---- long waves ---------------------------------------------------------------------------------------- */
/* The limit of S for long waves along the unit vector e. For small |k|, S = k^2 P + i k Q' + R
 * in displacements and rotations; with the rotations in equilibrium the displacements have
 *
 *   k^2 (P - Q R^-1 Q'),   P = - 1/2 sum K (e.x)^2,   Q = sum K (e.x),   R = sum K.
 *
 * T = (P - Q R^-1 Q') / V (dim x dim, Pa) is the acoustic tensor; NAN if R is not positive
 * definite. */
static void acoustic (const pg_symbol *s, const double *e, double *T)
{
    int dim = s->dim, m = s->unknowns, live[3], n = 0;
    double P[9] = { 0 }, Q[9] = { 0 }, R[9] = { 0 };
    for (int a = dim; a < m; a++) if (!s->held[a]) live[n++] = a;
    for (size_t j = 0; j < s->n; j++) {
        const double *K = s->block + j * (size_t) (m * m);
        double x = 0;
        for (int a = 0; a < dim; a++) x += e[a] * s->step[a] * s->offset[3 * j + (size_t) a];
        for (int a = 0; a < dim; a++) {
            for (int b = 0; b < dim; b++) P[a * dim + b] -= 0.5 * K[a * m + b] * x * x;
            for (int t = 0; t < n; t++) Q[a * n + t] += K[a * m + live[t]] * x;
        }
        for (int t = 0; t < n; t++) for (int u = 0; u < n; u++) R[t * n + u] += K[live[t] * m + live[u]];
    }
    int stable = pg_dense_cholesky (n, R, 1e-12) == 0;
    for (int b = 0; b < dim; b++) {
        double q[3] = { 0 };
        for (int t = 0; t < n; t++) q[t] = Q[b * n + t];
        if (stable) pg_dense_solve (n, R, q);
        for (int a = 0; a < dim; a++) {
            T[a * dim + b] = P[a * dim + b];
            for (int t = 0; t < n; t++) T[a * dim + b] -= Q[a * n + t] * (stable ? q[t] : NAN);
            T[a * dim + b] /= s->volume;
        }
    }
}

/* D from acoustic tensors T: T_aa along axis a is D_aa, T_bb along a is the shear modulus G, and along the
 * diagonal of a and b T_ab = (D_ab + G) / 2. */
void pg_symbol_tangent (const pg_symbol *s, double *D)
{
    int dim = s->dim, nv = pg_voigt_size (dim);
    double T[9];
    memset (D, 0, (size_t) (nv * nv) * sizeof *D);
    for (int a = 0; a < dim; a++) {
        double e[3] = { a == 0, a == 1, a == 2 };
        acoustic (s, e, T);
        D[a * nv + a] = T[a * dim + a];
    }
    for (int a = 0; a < dim && dim > 1; a++) {         /* shears xy, yz, zx */
        int b = (a + 1) % dim, v = dim == 2 ? 2 : 3 + a;
        double e[3] = { a == 0, a == 1, a == 2 }, G;
        acoustic (s, e, T);
        G = D[v * nv + v] = T[b * dim + b];
        e[a] = e[b] = sqrt (0.5);
        acoustic (s, e, T);                            /* T_ab = (D_ab + G) / 2 */
        D[a * nv + b] = D[b * nv + a] = T[a * dim + b] + T[b * dim + a] - G;
    }
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * Least distance from a position to an element: Gauss-Newton for |x (xi) - place|^2 under the bounds of the
 * reference element. Each step is a small quadratic programme, min |J d - r|^2 with xi + d within the bounds,
 * solved by trying all sets of bounds that may hold with equality (at most three of at most six): with so few
 * that is simpler and safer than an active-set method. */
#include "closest.h"
#include "element.h"
#include <math.h>
#include <string.h>

enum { BOUNDS = 6, UNKNOWNS = 6 };
/* The bounds g[k] . xi <= b[k] of a reference element (n of them). */
typedef struct { int dim, n; double g[BOUNDS][3], b[BOUNDS]; } bounds;

/* The bounds of a pyramid: z >= 0, and four faces that meet in the apex: z + x <= 1 and so on. */
static bounds bounds_of_pyramid (void)
{
    bounds s = { .dim = 3, .n = 5, .g = { { 0, 0, -1 } } };
    for (int k = 0; k < 4; k++) s.g[k + 1][k / 2] = k % 2 ? 1 : -1, s.g[k + 1][2] = s.b[k + 1] = 1;
    return s;
}

/* The bounds of an element: xi >= 0 and sum <= 1 on the axes of a simplex; -1 <= xi <= 1 on other axes. */
static bounds bounds_of (pg_element kind)
{
    if (kind == PG_PYRAMID5) return bounds_of_pyramid ();
    bounds s = { .dim = pg_element_types[kind].dim };
    int corners = pg_element_types[kind].corners, simplex = s.dim > 1 && corners == s.dim + 1 ? s.dim
                                                            : corners == 6                    ? 2
                                                                                              : 0;
    for (int a = 0; a < simplex; a++) s.g[s.n++][a] = -1;
    for (int a = 0; a < simplex; a++) s.g[s.n][a] = 1;
    if (simplex) s.b[s.n++] = 1;
    for (int a = simplex; a < s.dim; a++)
        for (int sign = -1; sign <= 1; sign += 2) s.g[s.n][a] = sign, s.b[s.n++] = 1;
    return s;
}

/* Solves A x = right-hand side (column n) by Gaussian elimination with pivoting; 0: singular. */
static int solve (int n, double A[UNKNOWNS][UNKNOWNS + 1], double *x)
{
    for (int k = 0; k < n; k++) {
        int best = k;
        for (int i = k + 1; i < n; i++) if (fabs (A[i][k]) > fabs (A[best][k])) best = i;
        /* H is scaled to a trace of 1: a smaller pivot is rounding. */
        if (!(fabs (A[best][k]) > 1e-14)) return 0;
        for (int j = k; j <= n; j++) { double t = A[k][j]; A[k][j] = A[best][j]; A[best][j] = t; }
        for (int i = k + 1; i < n; i++) {
            double f = A[i][k] / A[k][k];
            for (int j = k; j <= n; j++) A[i][j] -= f * A[k][j];
        }
    }
    for (int k = n - 1; k >= 0; k--) {
        x[k] = A[k][n];
        for (int j = k + 1; j < n; j++) x[k] -= A[k][j] * x[j];
        x[k] /= A[k][k];
    }
    return 1;
}

/* The optimum with the bounds of `set` (bits) held with equality, by its Karush-Kuhn-Tucker system. 1 if it
 * is the optimum of the programme: all bounds are met and no multiplier is negative. */
static int try_set (const bounds *s, double H[3][3], const double c[3], const double *xi, unsigned set,
                    double to[3])
{
    /* H G' | c ; G 0 | b - G xi, with a row of G for each bound that holds; the right-hand side waits in
     * the last column until the number of rows is known. */
    double A[UNKNOWNS][UNKNOWNS + 1] = { { 0 } }, u[UNKNOWNS];
    int d = s->dim, n = d;
    for (int a = 0; a < d; a++) {
        for (int b = 0; b < d; b++) A[a][b] = H[a][b];
        A[a][UNKNOWNS] = c[a];
    }
    for (int k = 0; k < s->n; k++) {
        if (!(set >> k & 1)) continue;
        A[n][UNKNOWNS] = s->b[k];
        for (int a = 0; a < d; a++) A[n][a] = A[a][n] = s->g[k][a], A[n][UNKNOWNS] -= s->g[k][a] * xi[a];
        n++;
    }
    for (int i = 0; i < n; i++) A[i][n] = A[i][UNKNOWNS];
    if (!solve (n, A, u)) return 0;
    for (int i = d; i < n; i++) if (u[i] < -1e-12) return 0;
    for (int a = 0; a < d; a++) to[a] = xi[a] + u[a];
    for (int k = 0; k < s->n; k++) {
        double v = -s->b[k];
        for (int a = 0; a < d; a++) v += s->g[k][a] * to[a];
        if (v > 1e-12) return 0;
    }
    return 1;
}

/* Finds the optimum, trying the fewest active bounds first. 0: none was found (J is singular). */
static int next_point (const bounds *s, double H[3][3], const double c[3], const double *xi, double to[3])
{
    for (int size = 0; size <= s->dim; size++)
        for (unsigned set = 0; set < 1u << s->n; set++)
            if (__builtin_popcount (set) == size && try_set (s, H, c, xi, set, to)) return 1;
    return 0;
}

/* Writes H = J'J / s, c = J'r / s with r = place - x (xi) and s = trace J'J, so that tolerances have no unit;
 * returns |r|^2. */
static double normal_equations (pg_element kind, int dim, const double *x, const double *place,
                                const double *xi, double H[3][3], double c[3])
{
    int d = pg_element_types[kind].dim, nodes = pg_element_types[kind].nodes;
    double N[PG_ELEMENT_NODES], dN[3 * PG_ELEMENT_NODES], J[3][3] = { { 0 } }, r[3], square = 0,
                                                          trace = d == 0;
    pg_element_shape (kind, xi, N, dN);
    for (int a = 0; a < dim; a++) {
        r[a] = place[a];
        for (int i = 0; i < nodes; i++) {
            r[a] -= N[i] * x[i * dim + a];
            for (int b = 0; b < d; b++) J[a][b] += dN[i * d + b] * x[i * dim + a];
        }
        square += r[a] * r[a];
        for (int b = 0; b < d; b++) trace += J[a][b] * J[a][b];
    }
    for (int a = 0; a < d; a++) {
        c[a] = 0;
        for (int k = 0; k < dim; k++) c[a] += J[k][a] * r[k] / trace;
        for (int b = 0; b < d; b++) {
            H[a][b] = 0;
            for (int k = 0; k < dim; k++) H[a][b] += J[k][a] * J[k][b] / trace;
        }
    }
    return square;
}

/* A step that does not come nearer is halved; if no halved step does either, the search ends. */
double closest_in_element (pg_element kind, int dim, const double *x, const double *place, double *xi)
{
    enum { STEPS = 30, HALVINGS = 6 };
    const bounds s = bounds_of (kind);
    double H[3][3], c[3], to[3], trial[3], unused[3][3], v[3];
    element_centre (kind, xi);
    double best = normal_equations (kind, dim, x, place, xi, H, c);
    for (int k = 0; k < STEPS; k++) {
        double moved = 0, share = 1, now = best;
        if (!next_point (&s, H, c, xi, to)) break;
        /* Full step, half of it, ... until the distance falls. */
        for (int half = 0; half < HALVINGS; half++, share /= 2) {
            for (int a = 0; a < s.dim; a++) trial[a] = xi[a] + share * (to[a] - xi[a]);
            now = normal_equations (kind, dim, x, place, trial, unused, v);
            if (now < best) break;
        }
        if (!(now < best)) break;
        for (int a = 0; a < s.dim; a++) moved = fmax (moved, fabs (trial[a] - xi[a]));
        memcpy (xi, trial, (size_t) s.dim * sizeof *xi);
        best = normal_equations (kind, dim, x, place, xi, H, c);
        if (moved < 1e-12) break;
    }
    return sqrt (best);
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * The first guess of a time step, from the steps before it.
 *
 * The scheme predicts a displacement and corrects it by x = A^-1 R, with A = k K + m M and R the residual of
 * the prediction. Motions are smooth in time, so that the corrections of following steps are nearly linear
 * combinations of one another. Of the last few the pairs (x_i, y_i = A x_i) are kept; y_i is the change of
 * the residual and costs no product. The combination that is nearest to the correction sought, in the norm of
 * A, is X c with
 *
 *     (X' Y) c = X' R                                          (P. F. Fischer, CMAME 163 (1998) 193-204),
 *
 * and what is left for the iterations is R - Y c. That is measured all the same: were it summed up, its
 * rounding would go into the next y, and from step to step with the large coefficients of an extrapolation.
 * Where bonds have broken since, Y is that of another K, and the pairs are forgotten.
 *
 * Corrections are nearly parallel, so that X' Y is close to singular. It is factored with the largest pivot
 * first, as far as it has digits: an entry x' y is as uncertain as y, and y as the rounding of d makes it,
 * eps |diag (A) d| beside |y|. In small time steps that is much more than eps. */
#include "solve/run/solve.h"
#include "perigal/ranks.h"
#include "perigal/vector.h"
#include <math.h>
#include <string.h>

enum { PAIRS = GUESS_PAIRS };
/* Pivots count from this share of their diagonal entry on, and from this multiple of the rounding of y on. */
static const double least_pivot = 1e-11, above_rounding = 100;

static double *pair_x (const pg_system *s, int k) { return s->iterative.guess.x + (size_t) k * s->ndof; }
static double *pair_y (const pg_system *s, int k) { return s->iterative.guess.y + (size_t) k * s->ndof; }

void system_guess_free (pg_system *s)
{
    system_iterations *it = &s->iterative;
    pg_free (it->guess.x), pg_free (it->guess.y);
    it->guess.x = it->guess.y = NULL;
}

/* Allocates the pairs: one more than are used, for the pair in the making. */
static pg_status guess_ready (pg_system *s)
{
    system_iterations *it = &s->iterative;
    pg_status status = PG_OK;
    if (!it->guess.x) PG_ALLOC (it->guess.x, (PAIRS + 1) * s->ndof);
    if (!it->guess.y) PG_ALLOC (it->guess.y, (PAIRS + 1) * s->ndof);
done:
    return status;
}

/* Cholesky's factorization G = L L' with complete pivoting (Higham 2002, section 10.3), as far as pivots are
 * more than noise, and the solution of G c = b of the unknowns that were reached; the others are 0. */
static void solve_nearly_singular (int n, double G[PAIRS][PAIRS], double noise, const double *b, double *c)
{
    int order[PAIRS], rank = 0;
    double first[PAIRS], z[PAIRS];
    for (int i = 0; i < n; i++) order[i] = i, first[i] = G[i][i], c[i] = 0;
    for (; rank < n; rank++) {
        int best = rank;
        for (int i = rank + 1; i < n; i++)
            if (G[order[i]][order[i]] / first[order[i]] > G[order[best]][order[best]] / first[order[best]])
                best = i;
        int p = order[best];
        order[best] = order[rank], order[rank] = p;
        if (!(G[p][p] > noise * first[p])) break;
        double root = sqrt (G[p][p]);
        G[p][p] = root;
        for (int i = rank + 1; i < n; i++) {
            int q = order[i];
            G[q][p] /= root;
            for (int j = rank + 1; j <= i; j++) {
                int r = order[j];
                G[q][r] -= G[q][p] * G[r][p];
                G[r][q] = G[q][r];
            }
        }
    }
    for (int i = 0; i < rank; i++) {
        z[i] = b[order[i]];
        for (int j = 0; j < i; j++) z[i] -= G[order[i]][order[j]] * z[j];
        z[i] /= G[order[i]][order[i]];
    }
    for (int i = rank - 1; i >= 0; i--) {
        c[order[i]] = z[i];
        for (int j = i + 1; j < rank; j++) c[order[i]] -= G[order[j]][order[i]] * c[order[j]];
        c[order[i]] /= G[order[i]][order[i]];
    }
}

/* Error of y by the rounding of d, over the norm of the smallest y. */
static double rounding_of (const pg_system *s, const dynamics *dyn, const double *d, int n, const int *at)
{
    double sum = 0, least = INFINITY, size[PAIRS + 1] = { 0 };
    for (size_t i = 0; i < s->ndof; i++) {
        double part = (dyn->k * s->direct.diagonal0[i] + dyn->m * s->mass[i]) * d[i];
        if (pg_cloud_owns (&s->problem->cloud, i / (size_t) s->components)) sum += part * part;
    }
    size[0] = sum;
    for (int k = 0; k < n; k++) size[k + 1] = pg_dot (s->ndof, pair_y (s, at[k]), pair_y (s, at[k]));
    if (pg_cloud_sum (&s->problem->cloud, PAIRS + 1, size) != PG_OK) return NAN;
    sum = size[0];
    for (int k = 0; k < n; k++) least = fmin (least, size[k + 1]);
    return 2.2e-16 * sqrt (sum / least);
}

/* Adds the combination X c of earlier corrections to d; the caller then measures the residual. Begins the
 * pair of this step: correction so far, residual of the prediction. *used: number of pairs at hand. */
pg_status system_guess (pg_system *s, const dynamics *dyn, double *d, int *used)
{
    pg_status status = PG_OK;
    pg_guess *g = &s->iterative.guess;
    double G[PAIRS][PAIRS] = { { 0 } }, b[PAIRS] = { 0 }, c[PAIRS];
    int at[PAIRS], n, most = 0;
    PG_TRY (guess_ready (s));
    if (!g->fresh) g->n = 0, g->fresh = 1;
    *used = n = g->n;
    double *x = pair_x (s, g->next), *y = pair_y (s, g->next);
    for (size_t i = 0; i < s->ndof; i++) x[i] = 0, y[i] = s->balance.residual[i];
    for (int k = 1; k <= n; k++) at[n - k] = (g->next - k + PAIRS + 1) % (PAIRS + 1);
    for (int i = 0; i < n; i++) {                      /* residuals, and so all y, are 0 at ghosts */
        b[i] = pg_dot (s->ndof, pair_x (s, at[i]), s->balance.residual);
        for (int j = 0; j <= i; j++)
            G[i][j] = G[j][i] = pg_dot (s->ndof, pair_x (s, at[i]), pair_y (s, at[j]));
    }
    PG_TRY (pg_cloud_sum (&s->problem->cloud, PAIRS, b));
    PG_TRY (pg_cloud_sum (&s->problem->cloud, PAIRS * PAIRS, &G[0][0]));
    for (int i = 0; i < n; i++) most += G[i][i] > 0;
    if (most < n) n = 0;                               /* a step without any correction */
    double noise = n > 0 ? fmax (least_pivot, above_rounding * rounding_of (s, dyn, d, n, at)) : 0;
    if (n > 0) solve_nearly_singular (n, G, noise, b, c);
    for (int k = 0; k < n; k++) {
        const double *from = pair_x (s, at[k]);
        for (size_t i = 0; i < s->ndof; i++) d[i] += c[k] * from[i], x[i] += c[k] * from[i];
    }
done:
    return status;
}

/* Takes the first guess of this step off d again, and forgets the earlier corrections that it was made of. */
void system_guess_undo (pg_system *s, double *d)
{
    double *x = pair_x (s, s->iterative.guess.next), *y = pair_y (s, s->iterative.guess.next);
    for (size_t i = 0; i < s->ndof; i++) d[i] -= x[i], x[i] = 0, s->balance.residual[i] = y[i];
    s->iterative.guess.n = 0;
}

/* Adds a refinement to the correction of this step. It is summed up by itself: as the difference of two
 * displacements it would have lost the digits in which corrections differ from one another. */
void system_guess_add (pg_system *s, const double *step)
{
    double *x = pair_x (s, s->iterative.guess.next);
    for (size_t i = 0; i < s->ndof; i++) x[i] += step[i];
}

/* Completes the pair of this step, if the residual of its state is known. */
void system_guess_learn (pg_system *s)
{
    pg_guess *g = &s->iterative.guess;
    double *y = pair_y (s, g->next);
    if (!s->balance.known) return;
    for (size_t i = 0; i < s->ndof; i++) y[i] -= s->balance.residual[i];
    g->next = (g->next + 1) % (PAIRS + 1);
    g->n = g->n < PAIRS ? g->n + 1 : PAIRS;
}

/* Checkpoint: the pairs, on which the next guess depends. */
pg_status system_guess_keep (pg_system *s, const pg_keeper *k)
{
    pg_status status = PG_OK;
    pg_guess *g = &s->iterative.guess;
    PG_TRY (pg_keep_fields (k, "system", "guess", NULL, 1, PG_ROWS (
        PG_KEPT_IN (g->n, 0, PAIRS, "the pairs of a first guess"),
        PG_KEPT_IN (g->next, 0, PAIRS, "the next pair of a first guess"), PG_KEPT (g->fresh),
        PG_KEPT (s->balance.unmeasured))));
    if (g->n == 0) goto done;
    PG_TRY (guess_ready (s));
    PG_TRY (k->numbers (k->context, "system.guess.x", (PAIRS + 1) * s->ndof, g->x));
    PG_TRY (k->numbers (k->context, "system.guess.y", (PAIRS + 1) * s->ndof, g->y));
done:
    return status;
}

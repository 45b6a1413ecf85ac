/* SPDX-License-Identifier: GPL-3.0-or-later
 * How far families have rotated. Strains and stretches that are linear in the displacement take a rotation by
 * an angle for a strain of cos (angle) - 1: a rotating body grows, and bonds break, or do not, for that
 * reason. One warning a run, with the time at which it began and the largest rotation. */
#include "solve/run/solve.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* rad: 0.5 % of strain */
static const double LARGE = 0.1;
static const char BEGINS[] = "families of points turn: ";

/* H = displacement gradient at a point by least squares over its intact bonds, H[c * dim + k] = du_c/dx_k; 0:
 * these do not determine it. */
static int gradient (const pg_problem *p, const pg_state *state, size_t stride, size_t i, double *H)
{
    const pg_family *f = &p->bonds.rows[PG_NODES].family;
    const unsigned char *alive = state->alive + p->bonds.first[PG_NODES];
    size_t dim = (size_t) p->dim;
    double M[9] = { 0 }, B[9] = { 0 };
    for (size_t e = f->start[i]; e < f->start[i + 1]; e++) {
        size_t j = (size_t) f->node[e];
        double xi[3], eta[3];
        if (!alive[e] || j == i) continue;
        for (size_t k = 0; k < dim; k++) {
            xi[k] = (p->cloud.x[j * dim + k] - p->cloud.x[i * dim + k]) / p->cloud.h;
            eta[k] = (state->d[j * stride + k] - state->d[i * stride + k]) / p->cloud.h;
        }
        for (size_t a = 0; a < dim; a++)
            for (size_t b = 0; b < dim; b++)
                M[a * dim + b] += xi[a] * xi[b], B[a * dim + b] += eta[a] * xi[b];
    }
    if (pg_dense_cholesky (p->dim, M, 1e-6)) return 0;
    for (size_t c = 0; c < dim; c++) pg_dense_solve (p->dim, M, B + c * dim);
    memcpy (H, B, dim * dim * sizeof *H);
    return 1;
}

/* Angle of the rotation in 1 + H, rad: its sine is the size of the skew part; in 2D twice its cosine is the
 * trace, in 3D the trace less one. */
static double angle_of (int dim, const double *H)
{
    double sine = 0, trace = 0;
    for (int a = 0; a < dim; a++) {
        trace += 1 + H[a * dim + a];
        for (int b = a + 1; b < dim; b++)
            sine = hypot (sine, 0.5 * (H[b * dim + a] - H[a * dim + b]));
    }
    return atan2 (sine, dim == 3 ? 0.5 * (trace - 1) : 0.5 * trace);
}

/* Largest rotation at a sample of the points, rad: every so many of the whole body, equal for any division
 * into ranks. */
static double largest_turn (const pg_problem *p, const pg_state *state, size_t stride)
{
    enum { SAMPLE = 200 };
    size_t every = pg_cloud_total (&p->cloud) / SAMPLE + 1;
    double most = 0, H[9];
    for (size_t i = 0; i < p->cloud.n; i++) {
        if (!pg_cloud_owns (&p->cloud, i) || pg_cloud_number (&p->cloud, i) % every) continue;
        if (gradient (p, state, stride, i, H)) most = fmax (most, angle_of (p->dim, H));
    }
    return most;
}

/* Takes what a resumed run has reported before from its warning. */
static void read_back (pg_solver *s, const char *words)
{
    double unused;
    const char *most = strstr (words, " on, ");
    if (sscanf (words + sizeof BEGINS - 1, "%lg rad from %lg", &unused, &s->turned_at) == 2 && most)
        sscanf (most, " on, %lg", &s->turned);
}

void solver_note_turns (pg_solver *s, const pg_state *state, const pg_step *step)
{
    const pg_problem *p = s->problem;
    pg_statistics *r = &s->report;
    if (p->dim < 2 || (p->sums && p->sums->rule.finite) || !state->d) return;
    double turn = largest_turn (p, state, (size_t) s->break_loop.system.components);
    turn = system_most (&s->break_loop.system, turn);
    size_t k = 0;
    while (k < r->nwarning && strncmp (r->warning[k], BEGINS, sizeof BEGINS - 1) != 0) k++;
    if (k < r->nwarning && s->turned == 0) read_back (s, r->warning[k]);
    if (turn < LARGE || (k < r->nwarning && turn <= s->turned)) return;
    if (k == r->nwarning) s->turned_at = step->time;
    s->turned = turn;
    if (k < r->nwarning)                               /* the new warning takes its place */
        memmove (r->warning + k, r->warning + k + 1, (--r->nwarning - k) * sizeof *r->warning);
    pg_statistics_warn (r,
                        "%s%.2g rad from %.3g%s on, %.2g rad at most, which linear strains take for a strain "
                        "of %.2g: results are not to be trusted there%s",
                        BEGINS, LARGE, s->turned_at,
                        s->options.flags & PG_SOLVER_QUASI_STATIC ? " of the load" : " s", turn,
                        cos (turn) - 1,
                        p->method->shape_functions ? "" : "; force: bond has stretch: finite");
}

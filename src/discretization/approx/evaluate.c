/* SPDX-License-Identifier: GPL-3.0-or-later
 * The loop over evaluation points that all approximations share: gather the live bonds of a
 * place, weigh them, apply the rule for too few bonds, call the formula. A row depends on
 * nothing but its own bonds, so any list, order or number of threads gives the same bits. On a
 * lattice places whose surroundings are alike are evaluated once (congruent.h). */
#include "congruent.h"
#include "moment.h"
#include <math.h>
#include <string.h>

/* The arguments of one call of pg_moment_evaluate. */
typedef struct {
    const pg_formula *formula;
    const pg_approx *a;
    const pg_cloud *cloud;
    pg_rows *rows;
    const unsigned char *alive;
    const size_t *list;
    /* Scratch space, and the cache of shape functions evaluated lately (congruent.h), one for each thread. */
    pg_neighbourhood *around;
    congruent *known;
    /* A node nearer to a position than this counts as coinciding with it, m. */
    double same;
} evaluation;

#define INLINE static inline __attribute__ ((always_inline))

/* Kernel values k and, if dk is not NULL, its derivatives at q (n). Arguments above 1 are set to 1: a closed
 * family may hold bonds longer by rounding. Those below `nothing` are set to 0: at a node a kernel may have a
 * kink, and rounding would give it a direction. */
static void kernel_at (const pg_kernel *kernel, double nothing, size_t n, double *q, double *k, double *dk)
{
    for (size_t i = 0; i < n; i++) q[i] = q[i] > 1 ? 1 : q[i] < nothing ? 0 : q[i];
    kernel->value (n, q, k, dk);
}

/* Weights and slopes of anisotropic supports: q = sqrt (z' A z) a / a_j, A the measure of the neighbour, and
 * a dw/dx = - w' (a / a_j)^2 A z / q. s->slope holds A z until the kernel is known. */
INLINE void stretched (size_t dim, const pg_kernel *kernel, double nothing, const pg_cloud *cloud,
                       const int *node, pg_neighbourhood *s)
{
    const double *metric = cloud->metric, *z = s->z, *ratio = s->ratio;
    const size_t *entry = s->entry;
    double *slope = s->slope, *q = s->q, *dk = s->dk;
    for (size_t j = 0; j < s->n; j++, z += dim) {
        const double *A = metric + (size_t) node[entry[j]] * dim * dim;
        double sum = 0;
        for (size_t k = 0; k < dim; k++) {
            double row = 0;
            for (size_t l = 0; l < dim; l++) row += A[k * dim + l] * z[l];
            slope[j * dim + k] = row;
            sum += z[k] * row;
        }
        q[j] = sqrt (sum) * ratio[j];
    }
    kernel_at (kernel, nothing, s->n, q, s->k, s->sloped ? dk : NULL);
    memcpy (s->w, s->k, s->n * sizeof *s->w);
    for (size_t j = 0; s->sloped && j < s->n; j++) {
        double rate = q[j] > 0 ? -dk[j] / q[j] * ratio[j] * ratio[j] : 0;
        for (size_t k = 0; k < dim; k++) slope[j * dim + k] *= rate;
    }
}

/* Weights w (|z_j| a / a_j) and slopes a dw/dx = - w' z / |z|. */
INLINE void radial (size_t dim, const pg_kernel *kernel, double nothing, pg_neighbourhood *s)
{
    const double *z = s->z, *ratio = s->ratio;
    double *slope = s->slope, *q = s->q, *dk = s->dk;
    for (size_t j = 0; j < s->n; j++) {
        double sum = 0;
        for (size_t k = 0; k < dim; k++) sum += z[j*dim + k] * z[j*dim + k];
        q[j] = ratio ? sqrt (sum) * ratio[j] : sqrt (sum);
    }
    kernel_at (kernel, nothing, s->n, q, s->k, s->sloped ? dk : NULL);
    memcpy (s->w, s->k, s->n * sizeof *s->w);
    for (size_t j = 0; s->sloped && j < s->n; j++) {
        double rate = q[j] > 0 ? -dk[j] / q[j] : 0;
        if (ratio) rate *= ratio[j] * ratio[j];
        for (size_t k = 0; k < dim; k++) slope[j*dim + k] = rate * z[j*dim + k];
    }
}

/* Weights prod_k w (|z_k|) and their slopes by the product rule. */
static void tensor (const pg_kernel *kernel, double nothing, pg_neighbourhood *s)
{
    size_t dim = (size_t) s->dim;
    for (size_t i = 0; i < s->n * dim; i++)
        s->q[i] = s->ratio ? fabs (s->z[i]) * s->ratio[i / dim] : fabs (s->z[i]);
    kernel_at (kernel, nothing, s->n * dim, s->q, s->k, s->dk);
    for (size_t j = 0; j < s->n; j++) {
        const double *z = s->z + j * dim, *w = s->k + j * dim, *dw = s->dk + j * dim, *q = s->q + j * dim;
        double all = 1;
        for (size_t k = 0; k < dim; k++) {
            double part = q[k] > 0 ? (z[k] > 0 ? -dw[k] : dw[k]) : 0;
            for (size_t l = 0; l < dim; l++) if (l != k) part *= w[l];
            s->slope[j*dim + k] = s->ratio ? part * s->ratio[j] : part;
            all *= w[k];
        }
        s->w[j] = all;
    }
}

/* The node that row i coincides with, else the nearest one in its family; -1: the family is empty. */
INLINE int nearest_node (const evaluation *g, size_t i, size_t dim)
{
    const pg_rows *rows = g->rows;
    const double *x = g->cloud->x, *at = rows->x + i * dim;
    const int *node = rows->family.node;
    int nearest = rows->own[i];
    double best = INFINITY;
    for (size_t e = rows->family.start[i]; rows->own[i] < 0 && e < rows->family.start[i + 1]; e++) {
        double sum = 0;
        for (size_t k = 0; k < dim; k++) {
            double z = x[(size_t) node[e] * dim + k] - at[k];
            sum += z * z;
        }
        if (sum < best) best = sum, nearest = node[e];
    }
    return nearest;
}

/* Sets support radius and spacing at row i: those of its nearest node where spacings differ. */
INLINE void measure_place (const evaluation *g, size_t i, size_t dim, pg_neighbourhood *s)
{
    int nearest = g->cloud->size ? nearest_node (g, i, dim) : -1;
    double ratio = nearest < 0 ? 1 : pg_cloud_ratio (g->cloud, (size_t) nearest);
    s->wide = g->rows->wide ? g->rows->wide[i] : 1;
    s->refined = g->a->refined || s->wide > 1;
    s->a = g->a->horizon * ratio * s->wide;
    s->slender = nearest < 0 ? 1 : pg_cloud_slender (g->cloud, (size_t) nearest);
    s->h = g->cloud->h * ratio / s->slender;
}

/* Collects the intact bonds of row i. A node that expands about its own value is not its own neighbour.
 * ratio: a / a_j, the support radius at the position over that of the neighbour. */
INLINE void gather_those (const evaluation *g, size_t i, size_t dim, pg_neighbourhood *s)
{
    const pg_rows *rows = g->rows;
    const double *x = g->cloud->x, *at = rows->x + i * dim, *size = g->cloud->size;
    const int *node = rows->family.node;
    const unsigned char *alive = g->alive;
    size_t first = rows->family.start[i], last = rows->family.start[i + 1], n = 0, *entry = s->entry;
    int own = g->formula->about_node ? rows->own[i] : -1, seen = 0, lost = 0;
    measure_place (g, i, dim, s);
    double *z = s->z, *ratio = s->ratio, a = s->a, horizon = g->a->horizon * s->wide, h = g->cloud->h;
    for (size_t e = first; e < last; e++) {
        int j = node[e], dead = alive && !alive[e];
        if (j == own) s->own = e - first, seen = 1;
        lost |= dead;
        if (j == own || dead) continue;
        for (size_t k = 0; k < dim; k++) z[n * dim + k] = (x[(size_t) j * dim + k] - at[k]) / a;
        if (ratio) ratio[n] = a / (horizon * (size ? size[j] / h : 1));
        entry[n++] = e - first;
    }
    s->constant = own < 0, s->lost = lost, s->n = n;
    if (own >= 0 && !seen) s->stray = 1;
}

static void gather (const evaluation *g, size_t i, pg_neighbourhood *s)
{
    if (s->dim == 3) gather_those (g, i, 3, s);
    else if (s->dim == 2) gather_those (g, i, 2, s);
    else gather_those (g, i, 1, s);
}

/* Collects the bonds of row i in horizons, rounded (congruent.h), if they are all intact, the row does not
 * expand about a node, and the cloud has one spacing. Returns 0 otherwise. */
static int gather_rounded (const evaluation *g, size_t i, pg_neighbourhood *s)
{
    const pg_rows *rows = g->rows;
    size_t dim = (size_t) s->dim, first = rows->family.start[i], n = rows->family.start[i + 1] - first;
    const int *node = rows->family.node + first;
    double per_horizon = 1 / g->a->horizon;
    if (g->cloud->size || g->a->refined || (rows->wide && rows->wide[i] > 1)
        || (g->formula->about_node && rows->own[i] >= 0)
        || (g->alive && memchr (g->alive + first, 0, n)))
        return 0;
    s->constant = 1, s->lost = 0, s->n = n, s->a = g->a->horizon, s->h = g->cloud->h, s->slender = 1;
    s->wide = 1, s->refined = 0;
    for (size_t k = 0; k < n; k++) s->entry[k] = k;
    for (size_t k = 0; k < dim; k++) {
        double at = rows->x[i * dim + k];
        for (size_t e = 0; e < n; e++)
            s->z[e * dim + k] = (g->cloud->x[(size_t) node[e] * dim + k] - at) * per_horizon;
    }
    congruent_round (n * dim, s->z);
    return 1;
}

/* Writes the influence times volume of each bond into rows->w, drops bonds without a weight,
 * and scales the others to the sum 1. */
INLINE void weigh_those (const evaluation *g, size_t i, size_t dim, pg_neighbourhood *s)
{
    size_t first = g->rows->family.start[i], at = first + pg_rows_offset (g->rows, i), kept = 0;
    double nothing = g->same / s->a;
    if (g->cloud->metric) stretched (dim, g->a->kernel, nothing, g->cloud, g->rows->family.node + first, s);
    else if (g->a->shape == PG_TENSOR) tensor (g->a->kernel, nothing, s);
    else radial (dim, g->a->kernel, nothing, s);
    const int *node = g->rows->family.node + first;
    const double *volume = g->cloud->volume;
    double total = 0, *influence = g->rows->w ? g->rows->w + at : NULL;
    double *z = s->z, *slope = s->slope, *w = s->w;
    size_t n = s->n, *entry = s->entry;
    int by_volume = g->a->use_volume, sloped = s->sloped;
    for (size_t j = 0; j < n; j++) {
        size_t e = entry[j];
        double V = volume[node[e]], scale = by_volume ? V : 1, weight = w[j] * scale;
        if (influence) influence[e] = w[j] * V;
        /* a weight that is not finite is kept, so that the total is not finite either */
        if (weight <= 0 && weight > -INFINITY) continue;
        w[kept] = weight, total += weight;
        for (size_t k = 0; k < dim && sloped; k++) slope[kept*dim + k] = slope[j*dim + k] * scale;
        if (kept < j) {
            entry[kept] = e;
            for (size_t k = 0; k < dim; k++) z[kept*dim + k] = z[j*dim + k];
        }
        kept++;
    }
    s->n = kept;
    if (!isfinite (total) && !s->strange) s->strange = i + 1;
    for (size_t j = 0; j < kept; j++) w[j] /= total;
    for (size_t j = 0; sloped && j < kept * dim; j++) slope[j] /= total;
}

/* Computes the weights of row i; their slopes only where derivatives will be needed (fill). */
static void weigh (const evaluation *g, size_t i, pg_neighbourhood *s)
{
    s->sloped = g->rows->dN || s->lost || (g->rows->N && !g->formula->values);
    if (s->dim == 3) weigh_those (g, i, 3, s);
    else if (s->dim == 2) weigh_those (g, i, 2, s);
    else weigh_those (g, i, 1, s);
}

/* 1 if the position has lost bonds and the derivatives of one of those left exceed PG_STEEPEST / a (intact:
 * up to 3 / a; across an anisotropic support more, by its aspect ratio). Such derivatives come from kernel
 * values near zero, which decay faster than their slopes: the point would feed energy into the body instead
 * of taking it out. */
static int wild (const pg_neighbourhood *s, const double *dN)
{
    double bound = (s->order == 2 ? PG_STEEPEST_QUADRATIC : PG_STEEPEST) / s->a * s->wide * s->slender;
    for (size_t j = 0; s->lost && j < s->n; j++) {
        double sum = 0;
        for (size_t k = 0; k < (size_t) s->dim; k++)
            sum += dN[s->entry[j] * (size_t) s->dim + k] * dN[s->entry[j] * (size_t) s->dim + k];
        if (!(sum <= bound * bound)) return 1;
    }
    return 0;
}

/* Sets the values first to last - 1 of N and dN to zero. */
static void clear (pg_rows *rows, size_t first, size_t last)
{
    size_t dim = (size_t) rows->dim;
    for (size_t e = first; rows->N && e < last; e++) rows->N[e] = 0;
    for (size_t e = first * dim; rows->dN && e < last * dim; e++) rows->dN[e] = 0;
}

/* Is the moment matrix of the neighbours close to singular? With intact supports the least pivot of a
 * quadratic basis is about 1e-3. */
static int frail (const pg_neighbourhood *s)
{
    for (int k = 0; !s->projected && k < s->size; k++)
        if (s->L[k * s->size + k] * s->L[k * s->size + k] < 1e-6) return 1;
    return 0;
}

/* Shape functions by the richest basis that the intact bonds can carry, written to values first .. last - 1
 * of the rows; returns its grade.
 * Derivatives that the caller did not ask for go to scratch space, where the test for steep ones or the
 * formula needs them. */
static int fill (const evaluation *g, pg_neighbourhood *s, pg_rows *rows, size_t first, size_t last)
{
    for (int order = g->a->order; order >= 1; order--) {
        int grade = pg_neighbourhood_grade (s, order, s->h);
        double *dN = rows->dN ? rows->dN + first * (size_t) s->dim : s->q,
               *N = rows->N ? rows->N + first : s->k;
        if (grade > PG_GRADE_PROJECTED) return grade;
        if (s->sloped) g->formula->fill (s, N, dN);
        else if (rows->N) g->formula->values (s, N);
        if (s->refined || frail (s))
            pg_neighbourhood_refine (s, rows->N ? N : NULL, s->sloped ? dN : NULL);
        if (!wild (s, dN)) return order < g->a->order && grade == PG_GRADE_FULL ? PG_GRADE_LOWERED : grade;
        clear (rows, first, last);
    }
    return PG_GRADE_SHEPARD;
}

/* Evaluates row i, or copies it from one with the same surroundings. */
static void row (const evaluation *g, size_t i, pg_neighbourhood *s, congruent *known)
{
    pg_rows *rows = g->rows;
    size_t first = rows->family.start[i] + pg_rows_offset (rows, i), slot = SIZE_MAX,
           last = rows->family.start[i + 1] + pg_rows_offset (rows, i);
    int rounded = g->a->congruent && gather_rounded (g, i, s);
    if (!rounded) gather (g, i, s);
    if (s->stray) return;
    if (rounded && congruent_find (known, s, g->cloud->volume, rows, i, &slot)) return;
    for (size_t e = first; rows->w && e < last; e++) rows->w[e] = 0;
    clear (rows, first, last);
    weigh (g, i, s);
    double *N = rows->N ? rows->N + first : s->k;
    int grade = fill (g, s, rows, first, last);
    if (grade > PG_GRADE_PROJECTED && s->constant) for (size_t j = 0; j < s->n; j++) N[s->entry[j]] = s->w[j];
    /* a node that expands about itself keeps its own displacement, whatever it lost */
    if (grade > PG_GRADE_PROJECTED && !s->constant) {
        N[s->own] = 1;
        grade = PG_GRADE_SHEPARD;
    }
    rows->grade[i] = (unsigned char) grade;
    congruent_keep (known, slot, rows, i, g->cloud->volume);
}

/* Evaluates rows first .. last - 1 of the list; run by each thread. */
static void work (void *context, size_t first, size_t last, int thread)
{
    const evaluation *g = context;
    for (size_t k = first; k < last; k++) 
        row (g, g->list ? g->list[k] : k, &g->around[thread], &g->known[thread]);
}

/* Allocates scratch space for one thread, for families of at most `most` nodes; all vectors are parts of one
 * block. */
static pg_status neighbourhood_create (pg_neighbourhood *s, const pg_approx *a, const pg_cloud *cloud,
                                       int dim, size_t most)
{
    pg_status status = PG_OK;
    size_t vector = most * (size_t) dim;
    *s = (pg_neighbourhood){
        .dim = dim, .a = a->horizon, .h = cloud->h, .project = a->projected, .extrapolates = a->extrapolates
    };
    PG_ALLOC (s->entry, most);
    if (cloud->size) PG_ALLOC (s->ratio, most);
    PG_ALLOC (s->z, 5 * vector + most * (1 + PG_BASIS_MAX));
    s->slope = s->z + vector;
    s->q = s->slope + vector;
    s->k = s->q + vector;
    s->dk = s->k + vector;
    s->w = s->dk + vector;
    s->p = s->w + most;
done:
    return status;
}

/* Fails if a weight is NaN or infinite: left out, such bonds would be missing silently. */
static pg_status refuse_strange (const evaluation *g, size_t slots)
{
    pg_status status = PG_OK;
    size_t row = SIZE_MAX;
    double x[3] = { 0 };
    for (size_t t = 0; t < slots; t++)
        if (g->around[t].strange && g->around[t].strange - 1 < row) row = g->around[t].strange - 1;
    if (row == SIZE_MAX) return PG_OK;
    memcpy (x, g->rows->x + row * (size_t) g->rows->dim, (size_t) g->rows->dim * sizeof *x);
    PG_FAIL (PG_E_USAGE,
             "the weights of the bonds at (%.6g, %.6g, %.6g) m are not finite: kernel %s at a horizon of %g "
             "m, by volume of the points: %s; look at method.kernel and the volumes there",
             x[0], x[1], x[2], g->a->kernel->name, g->a->horizon, g->a->use_volume ? "yes" : "no");
done:
    return status;
}

/* A node missing in its own family is noted by its thread and reported after the loop, since threads cannot
 * fail. */
pg_status pg_moment_evaluate (const pg_formula *formula, const pg_approx *a, const pg_cloud *cloud,
                           pg_rows *rows, const unsigned char *alive, size_t count, const size_t *list,
                           int threads)
{
    pg_status status = PG_OK;
    size_t slots = threads < 1 ? 1 : (size_t) threads, most = 0;
    evaluation g = { formula, a, cloud, rows, alive, list, NULL, NULL, pg_cloud_same (cloud) };
    int dim = rows->dim;
    if (dim < 1 || dim > 3 || a->order < 1 || a->order > 2 || !(a->horizon > 0))
        PG_FAIL (PG_E_USAGE, "approximation of order %d in %d dimensions with horizon %g m", a->order, dim,
                 a->horizon);
    for (size_t k = 0; k < count; k++) {
        size_t i = list ? list[k] : k, n = rows->family.start[i + 1] - rows->family.start[i];
        if (n > most) most = n;
    }
    PG_ALLOC (g.around, slots);
    PG_ALLOC (g.known, slots);
    for (size_t t = 0; t < slots; t++) {
        PG_TRY (neighbourhood_create (&g.around[t], a, cloud, dim, most));
        if (a->congruent) PG_TRY (congruent_create (&g.known[t], rows, count / slots + 1, most));
    }
    pg_parallel (threads, count, work, &g);
    for (size_t t = 0; t < slots; t++)
        if (g.around[t].stray) PG_FAIL (PG_E_USAGE, "%s: a node is missing in its own family", a->type->name);
    PG_TRY (refuse_strange (&g, slots));
done:
    for (size_t t = 0; g.around && t < slots; t++) {
        pg_free (g.around[t].z);
        pg_free (g.around[t].ratio);
        pg_free (g.around[t].entry);
    }
    for (size_t t = 0; g.known && t < slots; t++) {
        rows->copied += g.known[t].copied, rows->copied_bonds += g.known[t].copied_bonds;
        congruent_clear (&g.known[t]);
    }
    pg_free (g.known);
    pg_free (g.around);
    return status;
}

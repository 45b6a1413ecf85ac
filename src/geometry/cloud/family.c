/* SPDX-License-Identifier: GPL-3.0-or-later
 * Families { j : |x_j - c_i| <= reach }: the points are sorted into boxes a spacing wide (boxes.h). Centres
 * that follow each other and lie within one spacing, such as the Gauss points of a cell, share one list of
 * candidates, and each measures its distances from all of them. Points of unequal spacings have unequal
 * reach: they go into boxes by classes, each with a reach up to half as large again as the one before, so
 * that boxes fit their points. Centres are independent of each other: any number of threads finds the same
 * families.
 *
 * Points so thinly scattered that their boxes would mostly be empty are left to the k-d tree of
 * family_tree.c. */
#include "family.h"
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* Classes of reach at most: 1.5^40 = 1e7 times the smallest. */
enum { CLASSES = 40 };

struct pg_family_search {
    const pg_cloud *cloud;
    /* Nominal reach of families; the distance up to which points belong to them, with its margin, m. */
    double   reach, edge;
    pg_nearness near;
    pg_boxes boxes[CLASSES];
    size_t   n;
    /* Width of the finest boxes, m: how far apart centres may lie that share candidates. */
    double   width[3];
    /* own: largest distance at which each point is a member (balls: its square); NULL: `limit` for all. */
    double  *own, limit;
    /* Half-widths of the box around the support of each point, m (n x dim); NULL: all have the same. */
    double  *half;
    /* 0: the points are too scattered for boxes. */
    int      fits;
};

/* ---- sorting the points -------------------------------------------------------------------------------- */
/* Positions and spacings must be finite numbers. */
static pg_status check_points (const pg_cloud *cloud, double reach)
{
    pg_status status = PG_OK;
    if (!(reach >= 0) || !isfinite (reach))
        PG_FAIL (PG_E_USAGE, "reach %g m of a family must be finite and not negative", reach);
    for (size_t i = 0; i < cloud->n * (size_t) cloud->dim; i++)
        if (!isfinite (cloud->x[i]))
            PG_FAIL (PG_E_USAGE, "point %zu has no finite position", i / (size_t) cloud->dim);
    for (size_t i = 0; cloud->size && i < cloud->n; i++)
        if (!(cloud->size[i] > 0) || !isfinite (cloud->size[i]))
            PG_FAIL (PG_E_USAGE, "point %zu has the spacing %g m", i, cloud->size[i]);
done:
    return status;
}

static pg_status check_centres (int dim, size_t n, const double *centre)
{
    pg_status status = PG_OK;
    for (size_t i = 0; i < n * (size_t) dim; i++)
        if (!isfinite (centre[i]))
            PG_FAIL (PG_E_USAGE, "centre %zu of a family is not a finite position", i / (size_t) dim);
done:
    return status;
}

/* Largest distance from a centre at which point i belongs to its family, m. */
static double reach_of (const pg_family_search *s, size_t i)
{
    double far = s->edge;
    return s->cloud->size ? far * pg_cloud_ratio (s->cloud, i) : far;
}

/* Can point i belong to the family of a centre in the box (low, high: 3 + 3 numbers, m)? NULL: no limit. Few
 * centres, such as positions around the tip of a crack, then cost one test for every point of the body. */
static int meets_box (const pg_family_search *s, size_t i, const double *box)
{
    double far = reach_of (s, i) * (1 + 1e-7);
    for (int k = 0; box && k < s->cloud->dim; k++) {
        double x = s->cloud->x[i * (size_t) s->cloud->dim + (size_t) k];
        if (x < box[k] - far || x > box[3 + k] + far) return 0;
    }
    return 1;
}

/* Width of the boxes along each axis, m: the step of the lattice, or the spacing; of a cloud that has neither
 * the spacing of as many points spread evenly over its bounding box. Not below an eighth of the reach, as
 * many empty boxes would be visited. */
static void choose_width (const pg_family_search *s, double least, double *width)
{
    const pg_cloud *c = s->cloud;
    double ratio = least / s->edge, filled = 1, axes = 0, extent[3] = { 0 };
    for (int k = 0; k < c->dim; k++) {
        double low = INFINITY, high = -INFINITY;
        for (size_t i = 0; i < c->n; i++) {
            double x = c->x[i * (size_t) c->dim + (size_t) k];
            low = fmin (low, x), high = fmax (high, x);
        }
        extent[k] = high - low;
        if (extent[k] > 0) filled *= extent[k], axes++;
    }
    double even = axes > 0 ? pow (filled / (double) c->n, 1 / axes) : 0;
    for (int k = 0; k < c->dim; k++) {
        double step = c->step[k] > 0 ? c->step[k] * ratio : c->h > 0 ? c->h * ratio : even;
        width[k] = fmax (step, 0.125 * least);
    }
}

/* Class of a reach: how often the smallest one has grown by half. */
static int class_of (double reach, double least)
{
    double k = least > 0 ? log (reach / least * (1 + 1e-12)) / log (1.5) : 0;
    return k < CLASSES - 1 ? (int) k : CLASSES - 1;
}

/* Sorts the points of one class into boxes. */
static pg_status sort_class (pg_family_search *s, int class, double least, const unsigned char *member)
{
    pg_status status = PG_OK;
    const pg_cloud *c = s->cloud;
    int *list = NULL;
    double width[3] = { 0 }, far = 0;
    size_t n = 0;
    for (size_t i = 0; i < c->n; i++) n += member[i] == class + 1;
    if (n == 0) goto done;
    PG_ALLOC (list, n);
    n = 0;
    for (size_t i = 0; i < c->n; i++) {
        if (member[i] != class + 1) continue;
        far = fmax (far, reach_of (s, i));
        list[n++] = (int) i;
    }
    choose_width (s, least * pow (1.5, class), width);
    PG_TRY (pg_boxes_create (&s->boxes[s->n], &s->fits, c, n, list, width, far * (1 + 1e-7)));
    if (s->n == 0) memcpy (s->width, width, sizeof width);
    s->n += s->fits != 0;
done:
    pg_free (list);
    return status;
}

/* Half-widths of the box around the support of point i, m (dim). An ellipse { z : z' A z <= far^2 } reaches
 * far (A^-1)_kk^(1/2) along axis k. Slightly enlarged against rounding. */
static void measure_box (const pg_family_search *s, size_t i, double *half)
{
    int dim = s->cloud->dim;
    double far = reach_of (s, i) * (1 + 1e-7), L[9];
    for (int k = 0; k < dim; k++) half[k] = far;
    if (!s->cloud->metric) return;
    memcpy (L, s->cloud->metric + i * (size_t) (dim * dim), (size_t) (dim * dim) * sizeof *L);
    if (pg_dense_cholesky (dim, L, 1e-14)) return;
    for (int k = 0; k < dim; k++) {
        double column[3] = { k == 0, k == 1, k == 2 };
        pg_dense_solve (dim, L, column);
        half[k] = fmin (far, far * sqrt (column[k]) * (1 + 1e-7));
    }
}

/* Sorts into boxes all points, or those that can belong to families of centres in `box` (3 + 3 numbers,
 * m). */
static pg_status sort_points (pg_family_search *s, const double *box)
{
    pg_status status = PG_OK;
    unsigned char *member = NULL;                      /* class + 1; 0: in no family */
    double least = INFINITY;
    int most = -1;
    size_t n = s->cloud->n;
    PG_ALLOC (member, n);
    if (s->cloud->size) PG_ALLOC (s->own, n);
    if (s->cloud->size) PG_ALLOC (s->half, n * (size_t) s->cloud->dim);
    for (size_t i = 0; i < n; i++) {
        double far = reach_of (s, i);
        least = fmin (least, far);
        s->limit = s->near.shape == PG_RADIAL ? far * far : far;
        if (s->own) s->own[i] = s->limit;
        if (s->half) measure_box (s, i, s->half + i * (size_t) s->cloud->dim);
    }
    s->fits = 1;
    for (size_t i = 0; i < n; i++) {
        if (!meets_box (s, i, box)) continue;
        int class = s->cloud->size ? class_of (reach_of (s, i), least) : 0;
        member[i] = (unsigned char) (class + 1);
        most = class > most ? class : most;
    }
    for (int class = 0; class <= most && s->fits; class++) PG_TRY (sort_class (s, class, least, member));
done:
    pg_free (member);
    return status;
}

static void clear (pg_family_search *s)
{
    for (size_t k = 0; k < CLASSES; k++) pg_boxes_clear (&s->boxes[k]);
    pg_free (s->own), pg_free (s->half);
}

pg_status pg_family_search_create (pg_family_search **out, const pg_cloud *cloud, double reach, int shape,
                                   int closed)
{
    pg_status status = PG_OK;
    pg_family_search *s = NULL;
    *out = NULL;
    PG_TRY (check_points (cloud, reach));
    PG_ALLOC (s, 1);
    s->cloud = cloud, s->reach = reach, s->near = (pg_nearness) { shape, closed };
    s->edge = pg_family_edge (cloud, reach, s->near);
    PG_TRY (sort_points (s, NULL));
    *out = s, s = NULL;
done:
    pg_family_search_free (&s);
    return status;
}

void pg_family_search_free (pg_family_search **search)
{
    pg_family_search *s = *search;
    if (!s) return;
    clear (s);
    pg_free (s);
    *search = NULL;
}

/* ---- finding the families ------------------------------------------------------------------------------ */
/* A block of members of consecutive families; the blocks of a thread form a chain. */
typedef struct piece { struct piece *next; size_t n, room; int member[]; } piece;

/* Workspace and results of a thread. Candidates of a group of centres, ascending: their numbers, positions
 * axis by axis (m), limits of their distances, and distances from the current centre, all with room for
 * `most`; for stretched supports also their metrics, the entries of the symmetric matrix A of pg_cloud row by
 * row, each an array as long. bits: one for each point of the cloud, all 0 between groups. */
typedef struct {
    size_t n, most;
    int *item, *chosen;
    double *x, *limit, *away, *metric;
    uint64_t *bits;
    piece *first, *last;
    pg_status status;
} candidates;

typedef struct {
    const pg_family_search *s;
    const double *centre;
    pg_family *out;
    /* One for each thread. */
    candidates *of;
} finding;

/* GROUP: the most centres of a group. PIECE: the least room of a piece, in members. FEW: a cloud of at most
 * so many points is small. */
enum { GROUP = 256, PIECE = 1 << 14, FEW = 2048 };

/* Ascending order by Shell's method with Knuth's steps: insertion sort, by steps that shrink. */
static void shell_sort (size_t n, int *a)
{
    size_t step = 1;
    while (step < n / 9) step = 3 * step + 1;
    for (; step > 0; step /= 3)
        for (size_t i = step; i < n; i++) {
            int value = a[i];
            size_t j = i;
            for (; j >= step && a[j - step] > value; j -= step) a[j] = a[j - step];
            a[j] = value;
        }
}

/* Ascending order of different numbers. Those of points near each other mostly lie in a narrow range: then
 * each sets a bit, and the bits are read off word by word, at a cost without comparisons. */
static void ascend (size_t n, int *a, uint64_t *bits)
{
    size_t k = 1;
    int least = n ? a[0] : 0, most = least;
    while (k < n && a[k - 1] < a[k]) k++;
    if (k >= n) return;
    for (size_t i = 0; i < n; i++) least = a[i] < least ? a[i] : least, most = a[i] > most ? a[i] : most;
    size_t from = (size_t) least / 64, to = (size_t) most / 64 + 1, written = 0;
    if (to - from > 4 * n) {
        shell_sort (n, a);
        return;
    }
    for (size_t i = 0; i < n; i++) bits[a[i] / 64] |= (uint64_t) 1 << (a[i] % 64);
    for (size_t w = from; w < to; w++) {
        for (uint64_t word = bits[w]; word; word &= word - 1)
            a[written++] = (int) (64 * w) + __builtin_ctzll (word);
        bits[w] = 0;
    }
}

/* The end of the group that begins with centre `first`: as many as lie within the width of a box along each
 * axis, within three tenths of it along the last one, since thin groups have fewer candidates; low, high: the
 * box around them, m. Where the points have supports of their own the group may be twice as wide: points that
 * do not reach its box are left out later (leave_out). */
static size_t group_of (const finding *f, size_t first, size_t last, double *low, double *high)
{
    size_t dim = (size_t) f->s->cloud->dim, end = first;
    double wide = f->s->half ? 2 : 1, thin = f->s->half || dim == 1 ? wide : 0.3;
    for (; end < last && end < first + GROUP; end++) {
        const double *x = f->centre + end * dim;
        int fits = 1;
        for (size_t k = 0; k < dim; k++) {
            double from = end == first ? x[k] : fmin (low[k], x[k]),
                   to = end == first ? x[k] : fmax (high[k], x[k]);
            fits &= end == first || to - from <= (k + 1 == dim ? thin : wide) * f->s->width[k];
        }
        if (!fits) break;
        for (size_t k = 0; k < dim; k++) {
            low[k] = end == first ? x[k] : fmin (low[k], x[k]);
            high[k] = end == first ? x[k] : fmax (high[k], x[k]);
        }
    }
    return end;
}

/* Room for n candidates of a thread; what was there is not kept. */
static pg_status make_room (candidates *c, const pg_cloud *cloud, size_t n)
{
    pg_status status = PG_OK;
    size_t dim = (size_t) cloud->dim, most = n + n / 2 + 64;
    if (n <= c->most && c->item) goto done;
    pg_free (c->item), pg_free (c->chosen), pg_free (c->x);
    c->item = c->chosen = NULL, c->x = NULL, c->most = 0;
    PG_ALLOC (c->item, most);
    PG_ALLOC (c->chosen, most);
    PG_ALLOC (c->x, (dim + 2 + (cloud->metric ? dim * dim : 0)) * most);
    if (!c->bits) PG_ALLOC (c->bits, cloud->n / 64 + 1);
    c->limit = c->x + dim * most, c->away = c->limit + most, c->metric = c->away + most;
    c->most = most;
done:
    return status;
}

/* Of n candidates keeps those whose supports reach the box low .. high of the centres (m), by the box around
 * each support with the half-widths s->half. Returns how many. */
static size_t leave_out (const pg_family_search *s, const double *low, const double *high, size_t n,
                         int *item)
{
    size_t dim = (size_t) s->cloud->dim, kept = 0;
    for (size_t i = 0; s->half && i < n; i++) {
        const double *x = s->cloud->x + (size_t) item[i] * dim, *half = s->half + (size_t) item[i] * dim;
        int inside = 1;
        for (size_t k = 0; k < dim; k++) inside &= x[k] >= low[k] - half[k] && x[k] <= high[k] + half[k];
        item[kept] = item[i];
        kept += (size_t) inside;
    }
    return s->half ? kept : n;
}

/* Collects the candidates for all centres in the box (m), ascending, with positions, limits and metrics. */
static pg_status look_around (const finding *f, const double *low, const double *high, candidates *c)
{
    pg_status status = PG_OK;
    const pg_family_search *s = f->s;
    size_t n = 0, dim = (size_t) s->cloud->dim, entries = s->cloud->metric ? dim * dim : 0;
    int ball = s->near.shape == PG_RADIAL;
    if (s->cloud->n <= FEW) n = s->cloud->n;           /* room for all costs less than to count them */
    for (size_t k = 0; k < s->n && s->cloud->n > FEW; k++)
        n += pg_boxes_near (&s->boxes[k], low, high, ball, NULL);
    PG_TRY (make_room (c, s->cloud, n));
    n = 0;
    for (size_t k = 0; k < s->n; k++) n += pg_boxes_near (&s->boxes[k], low, high, ball, c->item + n);
    n = leave_out (s, low, high, n, c->item);
    ascend (n, c->item, c->bits);
    for (size_t i = 0; i < n; i++) {
        size_t j = (size_t) c->item[i];
        for (size_t k = 0; k < dim; k++) c->x[k * c->most + i] = s->cloud->x[j * dim + k];
        for (size_t k = 0; k < entries; k++)
            c->metric[k * c->most + i] = s->cloud->metric[j * entries + k];
        c->limit[i] = s->own ? s->own[j] : s->limit;
    }
    c->n = n;
done:
    return status;
}

/* Distances of the candidates from `at` (m; radial: squared, m^2). Loops of known length over all of them,
 * several at a time; the same operations in any instruction set. */
#define INLINE static inline __attribute__ ((always_inline))
INLINE void measure_those (const candidates *c, int dim, int shape, const double *at)
{
    const double *x = c->x, *y = dim > 1 ? x + c->most : x, *z = dim > 2 ? y + c->most : x;
    double *restrict away = c->away;
    for (size_t i = 0; i < c->n; i++) {
        double a = fabs (x[i] - at[0]), b = dim > 1 ? fabs (y[i] - at[1]) : 0,
               e = dim > 2 ? fabs (z[i] - at[2]) : 0, d;
        if (shape == PG_RADIAL) d = dim > 2 ? a * a + b * b + e * e : dim > 1 ? a * a + b * b : a * a;
        else d = a > b ? (a > e ? a : e) : (b > e ? b : e);
        away[i] = d;
    }
}

/* Squared distances z' A z of the candidates, m^2, by the metrics A of their stretched supports; summed over
 * the axes in the order of pg_cloud_length2, so that the tree of family_tree.c agrees about the edge. */
INLINE void measure_anisotropic (const candidates *c, int dim, const double *at)
{
    const double *x = c->x, *y = dim > 1 ? x + c->most : x, *z = dim > 2 ? y + c->most : x, *A[9];
    double *restrict away = c->away;
    for (int k = 0; k < dim * dim; k++) A[k] = c->metric + (size_t) k * c->most;
    for (size_t i = 0; i < c->n; i++) {
        double a = x[i] - at[0], b = dim > 1 ? y[i] - at[1] : 0, e = dim > 2 ? z[i] - at[2] : 0;
        if (dim == 1) away[i] = a * (A[0][i] * a);
        else if (dim == 2) away[i] = a * (A[0][i] * a + A[1][i] * b) + b * (A[2][i] * a + A[3][i] * b);
        else
            away[i] = a * (A[0][i] * a + A[1][i] * b + A[2][i] * e)
                      + b * (A[3][i] * a + A[4][i] * b + A[5][i] * e)
                      + e * (A[6][i] * a + A[7][i] * b + A[8][i] * e);
    }
}

PG_WIDEST static void measure (const candidates *c, int dim, int shape, int anisotropic, const double *at)
{
    if (anisotropic && dim == 3) measure_anisotropic (c, 3, at);
    else if (anisotropic && dim == 2) measure_anisotropic (c, 2, at);
    else if (anisotropic) measure_anisotropic (c, 1, at);
    else if (shape == PG_RADIAL && dim == 3) measure_those (c, 3, PG_RADIAL, at);
    else if (shape == PG_RADIAL && dim == 2) measure_those (c, 2, PG_RADIAL, at);
    else measure_those (c, dim, shape, at);
}

/* Appends the members of the next family to the pieces of the thread. */
static pg_status append (candidates *c, size_t n)
{
    pg_status status = PG_OK;
    if (!c->last || c->last->n + n > c->last->room) {
        size_t room = n > PIECE ? n : PIECE;
        piece *p = pg_calloc (1, sizeof *p + room * sizeof *p->member);
        if (!p) PG_FAIL (PG_E_MEMORY, "no memory for the members of families");
        p->room = room;
        if (c->last) c->last->next = p;
        else c->first = p;
        c->last = p;
    }
    memcpy (c->last->member + c->last->n, c->chosen, n * sizeof *c->chosen);
    c->last->n += n;
done:
    return status;
}

/* Finds the families of the centres first .. last - 1: the number of members of each goes to start[i + 1],
 * the members, ascending as the candidates are, to the pieces of the thread. */
static void find_those (void *context, size_t first, size_t last, int thread)
{
    const finding *f = context;
    const pg_cloud *cloud = f->s->cloud;
    candidates *c = &f->of[thread];
    double low[3], high[3];
    for (size_t end; first < last && c->status == PG_OK; first = end) {
        end = group_of (f, first, last, low, high);
        c->status = look_around (f, low, high, c);
        for (size_t i = first; i < end && c->status == PG_OK; i++) {
            size_t n = 0;
            measure (c, cloud->dim, f->s->near.shape, cloud->metric != NULL,
                     f->centre + i * (size_t) cloud->dim);
            for (size_t k = 0; k < c->n; k++) {
                c->chosen[n] = c->item[k];
                n += c->away[k] < c->limit[k] || (f->s->near.closed && c->away[k] == c->limit[k]);
            }
            f->out->start[i + 1] = n;
            c->status = append (c, n);
        }
    }
}

/* Joins the pieces of all threads in one list; frees them on the way. */
static void join_pieces (pg_family *out, size_t parts, candidates *of)
{
    size_t at = 0;
    for (size_t t = 0; t < parts; t++)
        for (piece *p; (p = of[t].first); of[t].first = p->next, pg_free (p)) {
            memcpy (out->node + at, p->member, p->n * sizeof *p->member);
            at += p->n;
        }
}

/* Searches in one pass: the number of members is known only when all are found, so that they are kept in
 * pieces until then. */
pg_status pg_family_find (pg_family *out, const pg_family_search *s, size_t n, const double *centre,
                          int threads)
{
    pg_status status = PG_OK;
    finding f = { s, centre, out, NULL };
    size_t parts = threads < 1 ? 1 : (size_t) threads;
    memset (out, 0, sizeof *out);
    PG_TRY (check_centres (s->cloud->dim, n, centre));
    if (!s->fits) return pg_family_by_tree (out, s->cloud, n, centre, s->reach, s->near);
    out->n = n;
    PG_ALLOC (out->start, n + 1);
    PG_ALLOC (f.of, parts);
    pg_parallel (threads, n, find_those, &f);
    /* Error messages of other threads are not available in this one. */
    for (size_t t = 0; t < parts; t++)
        if (f.of[t].status != PG_OK) PG_FAIL (f.of[t].status, "no memory for families of %zu places", n);
    for (size_t i = 0; i < n; i++) out->start[i + 1] += out->start[i];
    PG_ALLOC (out->node, out->start[n]);
    join_pieces (out, parts, f.of);
done:
    for (size_t t = 0; f.of && t < parts; t++) {
        for (piece *p; (p = f.of[t].first); pg_free (p)) f.of[t].first = p->next;
        pg_free (f.of[t].item), pg_free (f.of[t].chosen), pg_free (f.of[t].x), pg_free (f.of[t].bits);
    }
    pg_free (f.of);
    if (status != PG_OK) pg_family_clear (out);
    return status;
}

pg_status pg_family_build (pg_family *out, const pg_cloud *cloud, size_t n, const double *centre,
                           double reach, int shape, int closed)
{
    pg_status status = PG_OK;
    pg_family_search s = { .cloud = cloud, .reach = reach, .near = { shape, closed } };
    s.edge = pg_family_edge (cloud, reach, s.near);
    double box[6];
    memset (out, 0, sizeof *out);
    PG_TRY (check_points (cloud, reach));
    PG_TRY (check_centres (cloud->dim, n, centre));
    for (int k = 0; k < cloud->dim; k++) {
        box[k] = INFINITY, box[3 + k] = -INFINITY;
        for (size_t i = 0; i < n; i++) {
            box[k] = fmin (box[k], centre[i * (size_t) cloud->dim + (size_t) k]);
            box[3 + k] = fmax (box[3 + k], centre[i * (size_t) cloud->dim + (size_t) k]);
        }
    }
    PG_TRY (sort_points (&s, box));
    PG_TRY (pg_family_find (out, &s, n, centre, 1));
done:
    clear (&s);
    return status;
}

void pg_family_clear (pg_family *family)
{
    pg_free (family->start);
    pg_free (family->node);
    memset (family, 0, sizeof *family);
}

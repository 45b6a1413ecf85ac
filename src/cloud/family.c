/* SPDX-License-Identifier: GPL-3.0-or-later
 * Families { j : |x_j - c_i| <= reach }: the points are sorted into boxes a spacing wide (boxes.h). Centres
 * that follow each other and lie within one spacing, such as the Gauss points of a cell, share one list of
 * candidates, and each measures its distances from all of them. Points of unequal spacings see, and are
 * seen, unequally far: they go into boxes by classes, each up to half as far again as the one before, so
 * that boxes fit their points. Centres know nothing of each other: any number of threads finds the same
 * families.
 *
 * Points so thinly scattered that their boxes would mostly be empty are left to the k-d tree of
 * family_tree.c. */
#include "family.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Classes of reach at most: 1.5^40 = 1e7 times the smallest. */
enum { CLASSES = 40 };

struct pg_family_search {
    const pg_cloud *cloud;
    double   reach;
    pg_nearness near;
    pg_boxes boxes[CLASSES];
    size_t   n;
    /* Width of the finest boxes, m: how far apart centres may lie that share candidates. */
    double   width[3];
    /* Largest distance of a member, of a ball its square: of each point; NULL: `limit` for all. */
    double  *own, limit;
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

/* How far point i is seen, m. */
static double reach_of (const pg_family_search *s, size_t i)
{
    double far = pg_family_edge (s->reach, s->near);
    return s->cloud->size ? far * pg_cloud_ratio (s->cloud, i) : far;
}

/* Can a centre in the box low .. high see point i? box NULL: there is none. Few centres, such as the places
 * around the tip of a crack, then cost one look at every point of the body. */
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
 * as if its points filled their surroundings evenly. Not below an eighth of the reach, for many empty boxes
 * would be looked at. */
static void choose_width (const pg_family_search *s, double least, double *width)
{
    const pg_cloud *c = s->cloud;
    double ratio = least / pg_family_edge (s->reach, s->near), filled = 1, axes = 0, extent[3] = { 0 };
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

/* One class: its points in a list, and their boxes. */
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

/* All points, or those that centres in a box (low, high: 3 + 3 numbers, m) can see. */
static pg_status sort_points (pg_family_search *s, const double *box)
{
    pg_status status = PG_OK;
    unsigned char *member = NULL;                      /* class + 1; 0: seen from nowhere */
    double least = INFINITY;
    int most = -1;
    size_t n = s->cloud->n;
    PG_ALLOC (member, n);
    if (s->cloud->size) PG_ALLOC (s->own, n);
    for (size_t i = 0; i < n; i++) {
        double far = reach_of (s, i);
        least = fmin (least, far);
        s->limit = s->near.shape == PG_RADIAL ? far * far : far;
        if (s->own) s->own[i] = s->limit;
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
    pg_free (s->own);
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

/* ---- reading off --------------------------------------------------------------------------------------- */
/* Candidates of a group of centres, ascending: their numbers, positions axis by axis (m), how far away they
 * may be, and how far they are from the centre at work. Room for `most`. */
typedef struct { size_t n, most; int *item, *chosen; double *x, *limit, *away; } candidates;
typedef struct {
    const pg_family_search *s;
    const double *centre;
    pg_family *out;
    /* One for each thread. */
    candidates *of;
} finding;

/* Centres of a group at most. */
enum { GROUP = 256 };

/* Ascending order; runs that ascend already, one for each row of boxes, are what insertion sort likes, by
 * steps that shrink (Shell's method with Knuth's steps) for long families. */
static void ascend (size_t n, int *a)
{
    size_t step = 1;
    size_t k = 1;
    while (k < n && a[k - 1] < a[k]) k++;
    if (k >= n) return;
    while (step < n / 9) step = 3 * step + 1;
    for (; step > 0; step /= 3)
        for (size_t i = step; i < n; i++) {
            int value = a[i];
            size_t j = i;
            for (; j >= step && a[j - step] > value; j -= step) a[j] = a[j - step];
            a[j] = value;
        }
}

/* The end of the group that begins with centre `first`: as many as lie within the width of a box along each
 * axis, within three tenths of it along the last one, since thin groups have fewer candidates; low, high: the
 * box around them, m. */
static size_t group_of (const finding *f, size_t first, size_t last, double *low, double *high)
{
    size_t dim = (size_t) f->s->cloud->dim, end = first;
    for (; end < last && end < first + GROUP; end++) {
        const double *x = f->centre + end * dim;
        int fits = 1;
        for (size_t k = 0; k < dim; k++) {
            double from = end == first ? x[k] : fmin (low[k], x[k]),
                   to = end == first ? x[k] : fmax (high[k], x[k]);
            fits &= end == first || to - from <= (k + 1 == dim && dim > 1 ? 0.3 : 1) * f->s->width[k];
        }
        if (!fits) break;
        for (size_t k = 0; k < dim; k++) {
            low[k] = end == first ? x[k] : fmin (low[k], x[k]);
            high[k] = end == first ? x[k] : fmax (high[k], x[k]);
        }
    }
    return end;
}

/* Whom anybody in the box may see: their number; with `c` in ascending order, with all that is asked of
 * them. */
static size_t look_around (const finding *f, const double *low, const double *high, candidates *c)
{
    const pg_family_search *s = f->s;
    size_t n = 0, dim = (size_t) s->cloud->dim;
    for (size_t k = 0; k < s->n; k++)
        n += pg_boxes_near (&s->boxes[k], low, high, s->near.shape == PG_RADIAL, c ? c->item + n : NULL);
    if (!c) return n;
    ascend (n, c->item);
    for (size_t i = 0; i < n; i++) {
        for (size_t k = 0; k < dim; k++) c->x[k * c->most + i] = s->cloud->x[(size_t) c->item[i] * dim + k];
        c->limit[i] = s->own ? s->own[c->item[i]] : s->limit;
    }
    return c->n = n;
}

/* Before the first pass: how many candidates a group has at most. */
static void size_up (void *context, size_t first, size_t last, int thread)
{
    const finding *f = context;
    double low[3], high[3];
    for (size_t end; first < last; first = end) {
        end = group_of (f, first, last, low, high);
        size_t n = look_around (f, low, high, NULL);
        if (n > f->of[thread].most) f->of[thread].most = n;
    }
}

/* Measures how far the candidates are and returns the number of those that the centre sees. Loops of known
 * length over all of them, several at a time; the same operations in any instruction set. */
#define INLINE static inline __attribute__ ((always_inline))
INLINE size_t measure_those (const candidates *c, int dim, int shape, int closed, const double *at)
{
    size_t found = 0;
    const double *x = c->x, *y = dim > 1 ? x + c->most : x, *z = dim > 2 ? y + c->most : x, *limit = c->limit;
    double *restrict away = c->away;
    for (size_t i = 0; i < c->n; i++) {
        double a = fabs (x[i] - at[0]), b = dim > 1 ? fabs (y[i] - at[1]) : 0,
               e = dim > 2 ? fabs (z[i] - at[2]) : 0, d;
        if (shape == PG_RADIAL) d = dim > 2 ? a * a + b * b + e * e : dim > 1 ? a * a + b * b : a * a;
        else d = a > b ? (a > e ? a : e) : (b > e ? b : e);
        away[i] = d;
        found += closed ? d <= limit[i] : d < limit[i];
    }
    return found;
}

/* The same by the measures of stretched supports; the sum over the axes in the order of pg_cloud_length2, so
 * that the tree of family_tree.c agrees about what lies on the edge. */
static size_t measure_anisotropic (const candidates *c, const finding *f, const double *at)
{
    size_t found = 0, dim = (size_t) f->s->cloud->dim;
    for (size_t i = 0; i < c->n; i++) {
        double z[3] = { 0 };
        for (size_t k = 0; k < dim; k++) z[k] = c->x[k * c->most + i] - at[k];
        c->away[i] = pg_cloud_length2 (f->s->cloud, (size_t) c->item[i], z);
        found += f->s->near.closed ? c->away[i] <= c->limit[i] : c->away[i] < c->limit[i];
    }
    return found;
}

PG_WIDEST static size_t measure (const candidates *c, int dim, pg_nearness near, const double *at)
{
    if (near.shape == PG_RADIAL && dim == 3)
        return near.closed ? measure_those (c, 3, PG_RADIAL, 1, at) : measure_those (c, 3, PG_RADIAL, 0, at);
    if (near.shape == PG_RADIAL && dim == 2)
        return near.closed ? measure_those (c, 2, PG_RADIAL, 1, at) : measure_those (c, 2, PG_RADIAL, 0, at);
    return measure_those (c, dim, near.shape, near.closed, at);
}

/* The families of the centres first .. last - 1: in the first pass the number of members of each, at the
 * place where it will end, in the second one, `listing`, the members, ascending as the candidates are. */
static void find_those (const finding *f, size_t first, size_t last, candidates *c, int listing)
{
    double low[3], high[3];
    for (size_t end; first < last; first = end) {
        end = group_of (f, first, last, low, high);
        look_around (f, low, high, c);
        for (size_t i = first; i < end; i++) {
            const double *at = f->centre + i * (size_t) f->s->cloud->dim;
            size_t n = 0, found = f->s->cloud->metric ? measure_anisotropic (c, f, at)
                                                      : measure (c, f->s->cloud->dim, f->s->near, at);
            if (!listing) f->out->start[i + 1] = found;
            for (size_t k = 0; listing && k < c->n; k++) {
                c->chosen[n] = c->item[k];
                n += c->away[k] < c->limit[k] || (f->s->near.closed && c->away[k] == c->limit[k]);
            }
            if (n) memcpy (f->out->node + f->out->start[i], c->chosen, n * sizeof *c->chosen);
        }
    }
}

static void count (void *context, size_t first, size_t last, int thread)
{
    const finding *f = context;
    find_those (f, first, last, &f->of[thread], 0);
}

static void list (void *context, size_t first, size_t last, int thread)
{
    const finding *f = context;
    find_those (f, first, last, &f->of[thread], 1);
}

/* Room for the candidates of one thread, whose number at most is known. */
static pg_status make_room (candidates *c, size_t dim)
{
    pg_status status = PG_OK;
    PG_ALLOC (c->item, c->most);
    PG_ALLOC (c->chosen, c->most + 1);
    PG_ALLOC (c->x, (dim + 2) * c->most);
    c->limit = c->x + dim * c->most, c->away = c->limit + c->most;
done:
    return status;
}

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
    pg_parallel (threads, n, size_up, &f);
    for (size_t t = 0; t < parts; t++) PG_TRY (make_room (&f.of[t], (size_t) s->cloud->dim));
    pg_parallel (threads, n, count, &f);
    for (size_t i = 0; i < n; i++) out->start[i + 1] += out->start[i];
    PG_ALLOC (out->node, out->start[n]);
    pg_parallel (threads, n, list, &f);
done:
    for (size_t t = 0; f.of && t < parts; t++)
        pg_free (f.of[t].item), pg_free (f.of[t].chosen), pg_free (f.of[t].x);
    pg_free (f.of);
    if (status != PG_OK) pg_family_clear (out);
    return status;
}

pg_status pg_family_build (pg_family *out, const pg_cloud *cloud, size_t n, const double *centre,
                           double reach, int shape, int closed)
{
    pg_status status = PG_OK;
    pg_family_search s = { .cloud = cloud, .reach = reach, .near = { shape, closed } };
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

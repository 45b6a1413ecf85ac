/* SPDX-License-Identifier: GPL-3.0-or-later
 * Patches of the dilatation (integration.h): which evaluation points share one mean dilatation.
 *
 * Units are cells, or points with nodal integration. On a lattice `across` units per axis form a group,
 * divided evenly between the ends of the body, so that a mirrored body has mirrored patches. Elsewhere a set
 * of root units is chosen that keep a distance from each other, from the middle of the body outwards, and
 * every unit goes to the nearest root. Groups are then divided by material, and those that are too small
 * join their neighbours: the nearest one, or, in equal shares, all that are equally near, as the two beside
 * the corner of a square. The result depends neither on axes nor on the numbers of cells. */
#include "perigal/integration.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A group with less than this share of the full volume joins a neighbour: a patch that is a sliver would
 * lock, which patches are to prevent. */
static const double too_small = 0.4;
/* Least distance between two roots, in widths of a patch. */
static const double apart = 0.875;
/* Lengths and volumes that differ by less than this, relatively, count as equal. Bodies whose coordinates
 * have fewer digits are refused. */
static const double equal = 1e-6;

/* The patches while they are made. */
typedef struct {
    /* The input. */
    const pg_patch_source *s;
    /* Number of evaluation points, and of units (cells, or points). */
    size_t  n, units;
    /* Dimension of space. */
    int     dim;
    /* Centre of each unit, m (units x dim). */
    double *centre;
    /* Volume of the evaluation points in each unit, m^3; 0: the unit has none and is ignored (units). */
    double *size;
    /* Group of each unit (units). */
    long   *group;
    /* Number of groups. */
    size_t  groups;
    /* Group of each evaluation point; -1: none (n). */
    long   *of;
    /* Of each group: volume of its points (m^3), their centroid (m, groups x dim), volume of a complete
     * group (m^3). */
    double *volume, *middle, *full;
    /* Material of each evaluation point (n). */
    int    *material;
    /* Extent of the centres of units plus one spacing along each axis, m. */
    double  extent[3];
} builder;

/* The unit of evaluation point p. */
static size_t unit_of (const builder *b, size_t p)
{
    return b->s->points->cell[p] >= 0 ? (size_t) b->s->points->cell[p] : p;
}

/* Local spacing at evaluation point p, m. */
static double spacing_at (const builder *b, size_t p)
{
    return b->s->spacing ? b->s->spacing[p] : b->s->cloud->h;
}

/* ---- units --------------------------------------------------------------------------------------------- */
/* Computes centres, volumes and extent of the units. */
static pg_status measure_units (builder *b)
{
    pg_status status = PG_OK;
    const pg_rows *r = b->s->points;
    size_t dim = (size_t) b->dim;
    b->units = b->s->cells ? b->s->cells->n : b->n;
    PG_ALLOC (b->centre, b->units * dim);
    PG_ALLOC (b->size, b->units);
    PG_ALLOC (b->group, b->units);
    for (size_t p = 0; p < b->n; p++) b->size[unit_of (b, p)] += r->weight[p];
    for (size_t u = 0; u < b->units; u++) {
        size_t first = b->s->cells ? b->s->cells->start[u] : u,
               last = b->s->cells ? b->s->cells->start[u + 1] : u + 1;
        const double *x = b->s->cells ? b->s->cells->x : r->x;
        for (size_t v = first; v < last; v++)
            for (size_t k = 0; k < dim; k++)
                b->centre[u * dim + k] += x[v * dim + k] / (double) (last - first);
    }
    for (size_t k = 0; k < dim; k++) {
        double end[2] = { -INFINITY, -INFINITY };      /* minus the lowest, and the highest, over all ranks */
        for (size_t u = 0; u < b->units; u++)
            if (b->size[u] > 0)
                end[0] = fmax (end[0], -b->centre[u * dim + k]),
                end[1] = fmax (end[1], b->centre[u * dim + k]);
        PG_TRY (pg_cloud_most (b->s->cloud, 2, end));
        b->extent[k] = end[1] + end[0] + b->s->cloud->h;
    }
done:
    return status;
}

/* ---- lattices ------------------------------------------------------------------------------------------ */
/* Group of index i among 0 .. n - 1, with about `across` indices in each group. Symmetric under reflection: a
 * middle index (n odd) needs a middle group, so that an even number of groups is then made odd, by one more
 * while each still has two indices, else by one less. */
static long group_of (long i, long n, long across)
{
    long mirrored = n - 1 - i, left = i < mirrored ? i : mirrored, groups = n / across < 1 ? 1 : n / across,
         at;
    if (n % 2 && groups % 2 == 0) groups += n >= 2 * (groups + 1) ? 1 : -1;
    at = (2 * left + 1) * groups / (2 * n);
    return i <= mirrored ? at : groups - 1 - at;
}

/* Indices of unit u on the lattice of the whole body: of its cell, or of the nearest vertex. */
static void index_of (const builder *b, size_t u, long *at)
{
    const pg_lattice *l = b->s->lattice;
    double shift = b->s->cells || b->s->centred ? 0 : 0.5;
    for (int k = 0; k < b->dim; k++)
        at[k] = l->first[k]
                + (long) floor ((b->centre[u * (size_t) b->dim + (size_t) k] - l->origin[k]) / l->step[k]
                                + shift + 1e-9);
}

/* Sets the groups on a lattice, numbered with x fastest. Indices range over the units with a volume on all
 * ranks. */
static pg_status bin_units (builder *b)
{
    pg_status status = PG_OK;
    long low[3] = { 0 }, high[3] = { 0 }, at[3], groups[3] = { 1, 1, 1 };
    double end[6] = { -1e18, -1e18, -1e18, -1e18, -1e18, -1e18 };
    for (size_t u = 0; u < b->units; u++) {
        if (!(b->size[u] > 0)) continue;
        index_of (b, u, at);
        for (int k = 0; k < b->dim; k++)
            end[k] = fmax (end[k], -(double) at[k]), end[3 + k] = fmax (end[3 + k], (double) at[k]);
    }
    PG_TRY (pg_cloud_most (b->s->cloud, 6, end));
    b->groups = 1;
    for (int k = 0; k < b->dim; k++) {
        low[k] = -(long) end[k], high[k] = (long) end[3 + k];
        long n = high[k] - low[k] + 1;
        groups[k] = group_of (n - 1, n, b->s->across) + 1;
        b->groups *= (size_t) groups[k];
    }
    for (size_t u = 0; u < b->units; u++) {
        b->group[u] = 0;
        if (!(b->size[u] > 0)) continue;
        index_of (b, u, at);
        for (int k = b->dim - 1; k >= 0; k--)
            b->group[u] = b->group[u] * groups[k]
                          + group_of (at[k] - low[k], high[k] - low[k] + 1, b->s->across);
    }
done:
    return status;
}

/* ---- clouds and meshes --------------------------------------------------------------------------------- */
/* Distance of the centres of two units, m. */
static double distance (const builder *b, size_t u, size_t v)
{
    double s = 0;
    for (int k = 0; k < b->dim; k++) {
        double d = b->centre[u * (size_t) b->dim + (size_t) k] - b->centre[v * (size_t) b->dim + (size_t) k];
        s += d * d;
    }
    return sqrt (s);
}

/* Sort key by which units become roots: distance from the middle of the body, m; among equal ones a
 * fingerprint of the nodes in its families, which does not depend on how cells are numbered. */
typedef struct { double away; uint64_t seen; size_t unit; } candidate;

/* Order of two candidates, for qsort. */
static int earlier (const void *a, const void *b)
{
    const candidate *c = a, *d = b;
    if (c->away != d->away) return c->away < d->away ? -1 : 1;
    if (c->seen != d->seen) return c->seen < d->seen ? -1 : 1;
    return c->unit < d->unit ? -1 : 1;
}

/* Lists the units in the order in which they may become roots. */
static void order_units (const builder *b, candidate *list)
{
    const pg_family *f = b->s->family;
    size_t dim = (size_t) b->dim;
    double middle[3] = { 0 }, all = 0, class = 0, last = 0;
    for (size_t u = 0; u < b->units; u++) {
        all += b->size[u];
        for (size_t k = 0; k < dim; k++) middle[k] += b->size[u] * (b->centre[u * dim + k] - b->centre[k]);
    }
    for (size_t u = 0; u < b->units; u++) {
        list[u] = (candidate) { .unit = u };
        for (size_t k = 0; k < dim; k++)
            list[u].away = hypot (list[u].away, b->centre[u * dim + k] - b->centre[k] - middle[k] / all);
    }
    for (size_t p = 0; p < b->n; p++)
        for (size_t e = f->start[p]; e < f->start[p + 1]; e++)
            list[unit_of (b, p)].seen += pg_fingerprint (PG_FINGERPRINT, &f->node[e], sizeof f->node[e]);
    pg_sort (list, b->units, sizeof *list, earlier);
    for (size_t i = 0; i < b->units; i++) {                /* distances equal to rounding become equal */
        double away = list[i].away;
        if (i == 0 || away > last + equal * b->s->cloud->h) class = away;
        last = away, list[i].away = class;
    }
    pg_sort (list, b->units, sizeof *list, earlier);
}

/* Chooses roots: a unit becomes one unless a root is near. Every other unit then goes to the nearest root,
 * measured in local spacings; of equally near ones to the first. near: units within reach of each unit. */
static pg_status root_units (builder *b, const double *local, const pg_family *near)
{
    pg_status status = PG_OK;
    candidate *list = NULL;
    long *root = NULL;
    PG_ALLOC (root, b->units);
    PG_ALLOC (list, b->units);
    order_units (b, list);
    b->groups = 0;
    for (size_t u = 0; u < b->units; u++) root[u] = -1;
    for (size_t i = 0; i < b->units; i++) {
        size_t u = list[i].unit;
        int covered = !(b->size[u] > 0);
        for (size_t e = near->start[u]; e < near->start[u + 1] && !covered; e++) {
            size_t v = (size_t) near->node[e];
            covered = root[v] >= 0 && distance (b, u, v) < apart * b->s->across * fmin (local[u], local[v]);
        }
        if (!covered) root[u] = (long) b->groups++;
    }
    for (size_t u = 0; u < b->units; u++) {
        double least = INFINITY;
        b->group[u] = root[u] < 0 ? 0 : root[u];
        for (int pass = 0; pass < 2 && root[u] < 0; pass++)
            for (size_t e = near->start[u], found = 0; e < near->start[u + 1]; e++) {
                size_t v = (size_t) near->node[e];
                double d = root[v] >= 0 ? distance (b, u, v) / local[v] : INFINITY;
                if (pass == 0) least = fmin (least, d);
                else if (d <= least * (1 + equal) && root[v] >= 0 && (!found++ || root[v] < b->group[u]))
                    b->group[u] = root[v];
            }
    }
done:
    pg_free (root), pg_free (list);
    return status;
}

/* Forms groups of irregular points or of a mesh. local: the largest spacing of the points of each unit, m. */
static pg_status group_by_roots (builder *b)
{
    pg_status status = PG_OK;
    double *local = NULL, widest = 0;
    pg_cloud centres = { .dim = b->dim, .n = b->units, .x = b->centre, .h = b->s->cloud->h };
    pg_family near = { 0 };
    PG_ALLOC (local, b->units);
    for (size_t p = 0; p < b->n; p++) local[unit_of (b, p)] = fmax (local[unit_of (b, p)], spacing_at (b, p));
    for (size_t u = 0; u < b->units; u++) widest = fmax (widest, local[u]);
    PG_TRY (pg_family_build (&near, &centres, b->units, b->centre, 1.01 * apart * b->s->across * widest,
                             PG_RADIAL, 1));
    PG_TRY (root_units (b, local, &near));
done:
    pg_family_clear (&near);
    pg_free (local);
    return status;
}

/* ---- groups of one material ---------------------------------------------------------------------------- */
/* Volume of a complete group around point p, m^3: it has `across` spacings along each axis, or the extent of
 * the body where that is less. */
static double complete (const builder *b, size_t p)
{
    double volume = b->dim == 3 ? 1 : b->s->cloud->thickness;
    for (int k = 0; k < b->dim; k++)
        volume *= fmin (b->s->across, b->extent[k] / b->s->cloud->h) * spacing_at (b, p);
    return volume;
}

/* Computes volumes, centroids and complete volumes of the groups of points. */
static pg_status measure_groups (builder *b)
{
    pg_status status = PG_OK;
    const pg_rows *r = b->s->points;
    size_t dim = (size_t) b->dim;
    PG_ALLOC (b->volume, b->groups);
    PG_ALLOC (b->middle, b->groups * dim);
    PG_ALLOC (b->full, b->groups);
    for (size_t p = 0; p < b->n; p++) {
        if (b->of[p] < 0) continue;
        size_t c = (size_t) b->of[p];
        b->volume[c] += r->weight[p];
        b->full[c] = fmax (b->full[c], complete (b, p));
        for (size_t k = 0; k < dim; k++) b->middle[c * dim + k] += r->weight[p] * r->x[p * dim + k];
    }
    for (size_t i = 0; i < b->groups * dim; i++)
        if (b->volume[i / dim] > 0) b->middle[i] /= b->volume[i / dim];
done:
    return status;
}

static int is_small (const builder *b, size_t c)
{
    return b->volume[c] < too_small * b->full[c] * (1 - equal);
}

/* Most groups that are equally near. */
enum { MOST_TIED = 16 };
/* The groups that take the points of a group, each an equal share: the group itself, or those that it
 * joins. */
typedef struct { int n; size_t group[MOST_TIED]; } lodging;

/* Context of `unfit`: the materials of groups, the group that looks for another one, and those that it has
 * found already. */
typedef struct { const builder *b; const int *material; size_t own; const lodging *found; } choice;

/* Refuses groups that are not to be joined (a pg_refuse): found already, the group itself, of another
 * material, too small. */
static int unfit (void *context, const double *place, size_t c)
{
    const choice *h = context;
    (void) place;
    for (int k = 0; k < h->found->n; k++) if (h->found->group[k] == c) return 1;
    return c == h->own || h->material[c] != h->material[h->own] || !(h->b->volume[c] > 0)
           || is_small (h->b, c);
}

/* Distance of two positions, m. */
static double away (const builder *b, const double *x, const double *y)
{
    double s = 0;
    for (int k = 0; k < b->dim; k++) s += (x[k] - y[k]) * (x[k] - y[k]);
    return sqrt (s);
}

/* Finds the nearest groups of the same material that are large enough; the group itself where there is
 * none. */
static void lodge (const builder *b, const pg_nearest *grid, const int *material, size_t c, lodging *out)
{
    const double *x = b->middle + c * (size_t) b->dim;
    choice h = { b, material, c, out };
    double first = INFINITY;
    out->n = 0;
    while (out->n < MOST_TIED) {
        long d = pg_nearest_find (grid, x, unfit, &h);
        double r = d < 0 ? INFINITY : away (b, x, b->middle + (size_t) d * (size_t) b->dim);
        if (d < 0 || r > first * (1 + equal)) break;
        if (out->n == 0) first = r;
        out->group[out->n++] = (size_t) d;
    }
    if (out->n == 0) out->group[out->n++] = c;
}

/* Decides to which groups the points of each group go. */
static pg_status join_small (const builder *b, lodging *to)
{
    pg_status status = PG_OK;
    pg_nearest *grid = NULL;
    int *material = NULL;
    PG_ALLOC (material, b->groups);
    for (size_t p = 0; p < b->n; p++) if (b->of[p] >= 0) material[b->of[p]] = b->material[p];
    PG_TRY (pg_nearest_create (&grid, b->dim, b->groups, b->middle));
    for (size_t c = 0; c < b->groups; c++)
        if (b->volume[c] > 0 && is_small (b, c)) lodge (b, grid, material, c, &to[c]);
        else to[c] = (lodging) { 1, { c } };
done:
    pg_nearest_free (&grid);
    pg_free (material);
    return status;
}

/* Renumbers the groups without gaps, in their order, and splits those of several materials. */
static pg_status number (builder *b, size_t materials)
{
    pg_status status = PG_OK;
    long *name = NULL;
    size_t n = 0, all = b->groups * materials;
    PG_ALLOC (name, all);
    for (size_t p = 0; p < b->n; p++)
        if (b->of[p] >= 0)
            b->of[p] = b->of[p] * (long) materials + b->material[p], name[b->of[p]] = 1;
    for (size_t c = 0; c < all; c++) if (name[c]) name[c] = (long) n++;
    for (size_t p = 0; p < b->n; p++) if (b->of[p] >= 0) b->of[p] = name[b->of[p]];
    b->groups = n;
done:
    pg_free (name);
    return status;
}

/* ---- result -------------------------------------------------------------------------------------------- */
/* Lists the nodes in the families f of the points of each patch, ascending. */
static pg_status see (pg_patches *out, const pg_family *f, size_t nodes)
{
    pg_status status = PG_OK;
    int *seen = NULL;
    size_t cap = 0, n = 0;
    PG_ALLOC (seen, nodes);
    PG_ALLOC (out->family.start, out->n + 1);
    out->family.n = out->n;
    for (size_t c = 0; c < out->n; c++) {
        for (size_t i = out->first[c]; i < out->first[c + 1]; i++)
            for (size_t e = f->start[out->point[i]]; e < f->start[out->point[i] + 1]; e++) {
                int j = f->node[e];
                if (seen[j] == (int) c + 1) continue;
                seen[j] = (int) c + 1;
                PG_GROW (out->family.node, cap, n + 1);
                out->family.node[n++] = j;
            }
        pg_sort (out->family.node + out->family.start[c], n - out->family.start[c], sizeof (int),
                 pg_ascending_ints);
        out->family.start[c + 1] = n;
    }
done:
    pg_free (seen);
    return status;
}

/* Counts the patches, the entries of each, and those of each point. to: the groups that each group joins;
 * name: the patch of each group. */
static pg_status count (pg_patches *out, const builder *b, const lodging *to, size_t *name)
{
    pg_status status = PG_OK;
    for (size_t c = 0; c < b->groups; c++) if (to[c].group[0] == c) name[c] = out->n++;
    PG_ALLOC (out->first, out->n + 1);
    PG_ALLOC (out->full, out->n);
    PG_ALLOC (out->start, b->n + 1);
    for (size_t p = 0; p < b->n; p++) {
        const lodging *l = b->of[p] < 0 ? NULL : &to[b->of[p]];
        out->start[p + 1] = out->start[p] + (l ? (size_t) l->n : 0);
        for (int k = 0; l && k < l->n; k++) out->first[name[l->group[k]] + 1]++;
    }
    for (size_t c = 0; c < out->n; c++) out->first[c + 1] += out->first[c];
done:
    return status;
}

/* Lists the entries of each patch, ascending by their points. */
static pg_status collect (pg_patches *out, const builder *b, const lodging *to)
{
    pg_status status = PG_OK;
    size_t *next = NULL, *name = NULL;
    PG_ALLOC (name, b->groups);
    PG_TRY (count (out, b, to, name));
    size_t entries = out->first[out->n];
    PG_ALLOC (out->point, entries);
    PG_ALLOC (out->share, entries);
    PG_ALLOC (out->of, entries);
    PG_ALLOC (out->entry, entries);
    PG_ALLOC (next, out->n);
    memcpy (next, out->first, out->n * sizeof *next);
    for (size_t p = 0; p < b->n; p++)
        for (size_t k = out->start[p]; k < out->start[p + 1]; k++) {
            const lodging *l = &to[b->of[p]];
            size_t c = name[l->group[k - out->start[p]]], i = next[c]++;
            out->point[i] = p, out->of[i] = c, out->share[i] = 1.0 / l->n, out->entry[k] = i;
            out->full[c] = fmax (out->full[c], complete (b, p));
        }
    PG_TRY (see (out, b->s->family, b->s->cloud->n));
done:
    pg_free (next), pg_free (name);
    return status;
}

/* Points of materials without lambda belong to no patch. */
pg_status pg_patches_create (pg_patches **out, const pg_patch_source *source)
{
    pg_status status = PG_OK;
    builder b = { .s = source, .n = source->points->n, .dim = source->cloud->dim };
    pg_patches *made = NULL;
    lodging *to = NULL;
    PG_ALLOC (made, 1);
    PG_ALLOC (made->lambda, source->materials);
    memcpy (made->lambda, source->lambda, source->materials * sizeof *made->lambda);
    PG_ALLOC (b.material, b.n);
    PG_ALLOC (b.of, b.n);
    PG_TRY (measure_units (&b));
    if (source->lattice) PG_TRY (bin_units (&b));
    else PG_TRY (group_by_roots (&b));
    for (size_t p = 0; p < b.n; p++) {
        b.material[p] = source->block[p];
        b.of[p] = source->lambda[source->block[p]] > 0 ? b.group[unit_of (&b, p)] : -1;
    }
    PG_TRY (number (&b, source->materials));
    PG_TRY (measure_groups (&b));
    PG_ALLOC (to, b.groups);
    PG_TRY (join_small (&b, to));
    PG_TRY (collect (made, &b, to));
    *out = made, made = NULL;
done:
    pg_patches_free (&made);
    pg_free (to), pg_free (b.centre), pg_free (b.size), pg_free (b.group), pg_free (b.of), pg_free (b.volume),
        pg_free (b.middle), pg_free (b.full), pg_free (b.material);
    return status;
}

void pg_patches_free (pg_patches **patches)
{
    pg_patches *p = *patches;
    if (!p) return;
    pg_family_clear (&p->family);
    pg_free (p->first), pg_free (p->point), pg_free (p->share), pg_free (p->of), pg_free (p->start),
        pg_free (p->entry), pg_free (p->full), pg_free (p->lambda);
    pg_free (p);
    *patches = NULL;
}

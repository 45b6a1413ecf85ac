/* SPDX-License-Identifier: GPL-3.0-or-later
 * Memory of the paths of growing cracks (crack_paths.c): creation, copies, checkpoints. */
#include "perigal/crack.h"
#include <math.h>
#include <stdint.h>
#include <string.h>

/* Sets the pointers of pieces to their vertices and retreats, which are in one block of memory. */
static void point_into_store (pg_crack_paths *w)
{
    for (size_t k = 0; k < w->cracks.n; k++)
        w->cracks.crack[k].vertex = w->store + 6*k, w->cracks.crack[k].retreat = w->store + 6*k + 4;
}

/* Reserves memory for n pieces in all arrays. */
pg_status pg_crack_paths_reserve (pg_crack_paths *w, size_t n)
{
    pg_status status = PG_OK;
    PG_GROW_ALSO (w->cracks.crack, 1, w->capacity, n);
    PG_GROW_ALSO (w->parent, 1, w->capacity, n);
    PG_GROW_ALSO (w->path, 1, w->capacity, n);
    PG_GROW_ALSO (w->store, 6, w->capacity, n);
    PG_GROW (w->owner, w->capacity, n);
done:
    if (w->store) point_into_store (w);
    return status;
}

int pg_crack_paths_same (const pg_crack_paths *w, const double *a, const double *b)
{
    double x = a[0] - b[0], y = a[1] - b[1];
    return fabs (x) <= w->nothing && fabs (y) <= w->nothing && hypot (x, y) <= w->nothing;
}

/* Returns 1: pieces k and j share a vertex. */
static int hang_together (const pg_crack_paths *w, size_t k, size_t j)
{
    const double *a = w->cracks.crack[k].vertex, *b = w->cracks.crack[j].vertex;
    for (int end = 0; end < 4; end++)
        if (pg_crack_paths_same (w, a + 2 * (end / 2), b + 2 * (end % 2))) return 1;
    return 0;
}

/* Numbers the paths: cracks of the scene that share vertices form one path, with the number of its first
 * piece. */
static void name_paths (pg_crack_paths *w)
{
    for (size_t k = 0; k < w->cracks.n; k++) {
        w->path[k] = k;
        for (size_t j = 0; j < k; j++) {
            size_t from = w->path[k] > w->path[j] ? w->path[k] : w->path[j],
                   to = w->path[k] > w->path[j] ? w->path[j] : w->path[k];
            if (from == to || !hang_together (w, k, j)) continue;
            for (size_t i = 0; i <= k; i++) if (w->path[i] == from) w->path[i] = to;
        }
    }
}

pg_status pg_paths_of (pg_crack_paths **out, const pg_cracks *cracks, const pg_tip *tip, size_t ntip,
                    double nothing)
{
    pg_status status = PG_OK;
    pg_crack_paths *w = NULL;
    PG_ALLOC (w, 1);
    w->cracks.dim = 2, w->nothing = nothing;
    PG_TRY (pg_crack_paths_reserve (w, cracks->n));
    PG_GROW (w->tip, w->tip_capacity, ntip);
    w->cracks.n = w->nfirst = cracks->n, w->ntip = ntip;
    for (size_t k = 0; k < w->cracks.n; k++) {
        const pg_crack *c = &cracks->crack[k];
        double *store = w->store + 6*k;
        w->cracks.crack[k] = *c, w->parent[k] = SIZE_MAX, w->owner[k] = 0;
        memcpy (store, c->vertex, 4 * sizeof *store);
        store[4] = c->retreat ? c->retreat[0] : 0, store[5] = c->retreat ? c->retreat[1] : 0;
    }
    if (w->store) point_into_store (w);
    if (w->ntip) memcpy (w->tip, tip, w->ntip * sizeof *w->tip);
    name_paths (w);
    PG_TRY (pg_cracks_index (&w->cracks));
    *out = w;
    w = NULL;
done:
    pg_crack_paths_free (&w);
    return status;
}

pg_status pg_crack_paths_copy (pg_crack_paths *to, const pg_crack_paths *from)
{
    pg_status status = PG_OK;
    size_t n = from->cracks.n;
    PG_TRY (pg_crack_paths_reserve (to, n));
    PG_GROW (to->tip, to->tip_capacity, from->ntip);
    to->cracks.n = n, to->nfirst = from->nfirst, to->ntip = from->ntip;
    to->length = from->length, to->nothing = from->nothing;
    if (n) {
        memcpy (to->cracks.crack, from->cracks.crack, n * sizeof *to->cracks.crack);
        memcpy (to->parent, from->parent, n * sizeof *to->parent);
        memcpy (to->path, from->path, n * sizeof *to->path);
        memcpy (to->owner, from->owner, n * sizeof *to->owner);
        memcpy (to->store, from->store, 6 * n * sizeof *to->store);
        point_into_store (to);
    }
    if (from->ntip) memcpy (to->tip, from->tip, from->ntip * sizeof *to->tip);
    PG_TRY (pg_cracks_copy_index (&to->cracks, &from->cracks));
done:
    return status;
}

void pg_crack_paths_free (pg_crack_paths **paths)
{
    pg_crack_paths *w = *paths;
    if (!w) return;
    pg_free (w->cracks.crack), pg_cracks_clear_index (&w->cracks);
    pg_free (w->parent);
    pg_free (w->path), pg_free (w->owner), pg_free (w->store), pg_free (w->tip);
    pg_free (w);
    *paths = NULL;
}

/* ---- checkpoints --------------------------------------------------------------------------------------- */
/* Writes or reads paths: counts first, then arrays. Normals are stored, as recomputing them from the vertices
 * could change their last digit (for split pieces and cracks of the scene). */
pg_status pg_paths_keep (pg_crack_paths *w, long most, const char *name, const pg_keeper *k)
{
    pg_status status = PG_OK;
    size_t n = w->cracks.n, ntip = w->ntip;
    PG_TRY (pg_keep_fields (k, name, "counts", "length", 1, PG_ROWS (
        PG_KEPT_IN (n, w->nfirst, most, "the number of cracks"),
        PG_KEPT_IN (ntip, 0, 2 * most, "the number of tips"), PG_KEPT (w->length))));
    PG_KEEP_BOUND (k, "the number of tips", ntip, 0, 2 * n);
    if (k->reading) {
        PG_TRY (pg_crack_paths_reserve (w, n));
        PG_GROW (w->tip, w->tip_capacity, ntip);
        w->cracks.n = n, w->ntip = ntip;
    }
    pg_crack *c = w->cracks.crack;
    pg_tip *t = w->tip;
    for (size_t i = w->nfirst; i < n && k->reading; i++)
        c[i] = (pg_crack) { .kind = PG_CRACK_SEGMENT, .nvertex = 2 };
    PG_TRY (pg_keep_fields (k, name, "pieces", "places", n, PG_ROWS (
        PG_EACH_IN (c, sided, 0, 1, "the sides of a crack"),
        PG_ITEMS_IN (w->parent, 1, -1, (long) n - 1, "the parent of a crack"),
        PG_ITEMS_IN (w->path, 1, 0, n - 1, "the path of a crack"), PG_ITEMS (w->owner, 1),
        PG_ITEMS (w->store, 6), PG_EACH (c, width), PG_EACH (c, normal[0]), PG_EACH (c, normal[1]))));
    PG_TRY (pg_keep_fields (k, name, "tips", "tip_places", ntip, PG_ROWS (
        PG_EACH (t, id), PG_EACH_IN (t, segment, 0, (long) n - 1, "the piece of a tip"),
        PG_EACH_IN (t, end, 0, 1, "the end of a tip"), PG_EACH_IN (t, open, 0, 1, "whether a tip is open"),
        PG_EACH (t, x[0]), PG_EACH (t, x[1]), PG_EACH (t, offset), PG_EACH (t, grown))));
    if (!k->reading) goto done;
    point_into_store (w);
    PG_TRY (pg_cracks_index (&w->cracks));
done:
    if (status != PG_OK && k->reading) w->cracks.n = w->ntip = 0;
    return status;
}

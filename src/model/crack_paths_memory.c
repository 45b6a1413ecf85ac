/* SPDX-License-Identifier: GPL-3.0-or-later
 * Memory of the paths of growing cracks (crack_paths.c): made with a state, copied with it, kept in its
 * checkpoints. */
#include "model.h"
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

/* Vertices and retreats of the pieces lie in one block, and move with it. */
static void point_into_store (pg_crack_paths *w)
{
    for (size_t k = 0; k < w->cracks.n; k++)
        w->cracks.crack[k].vertex = w->store + 6*k, w->cracks.crack[k].retreat = w->store + 6*k + 4;
}

#define GROW_TO(p, n) \
    do { \
        void *more_ = pg_resize ((p), (n), sizeof *(p)); \
        if (!more_) PG_FAIL (PG_E_MEMORY, "no memory for %zu pieces of a crack", (size_t) (n)); \
        (p) = more_; \
    } while (0)

/* Room for n pieces in all arrays. */
pg_status pg_crack_paths_reserve (pg_crack_paths *w, size_t n)
{
    pg_status status = PG_OK;
    if (n <= w->capacity) return PG_OK;
    size_t most = 2 * n + 16;
    GROW_TO (w->cracks.crack, most);
    GROW_TO (w->parent, most);
    GROW_TO (w->path, most);
    GROW_TO (w->owner, most);
    GROW_TO (w->store, 6 * most);
    w->capacity = most;
done:
    if (w->store) point_into_store (w);
    return status;
}

int pg_crack_paths_same (const pg_crack_paths *w, const double *a, const double *b)
{
    double x = a[0] - b[0], y = a[1] - b[1];
    return fabs (x) <= w->nothing && fabs (y) <= w->nothing && hypot (x, y) <= w->nothing;
}

/* Pieces k and j share a vertex. */
static int hang_together (const pg_crack_paths *w, size_t k, size_t j)
{
    const double *a = w->cracks.crack[k].vertex, *b = w->cracks.crack[j].vertex;
    for (int end = 0; end < 4; end++)
        if (pg_crack_paths_same (w, a + 2 * (end / 2), b + 2 * (end % 2))) return 1;
    return 0;
}

/* Cracks of the scene that share vertices are one path, named after its first piece. */
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

pg_status paths_of (pg_crack_paths **out, const pg_cracks *cracks, const pg_tip *tip, size_t ntip,
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
/* Pieces: four whole numbers and nine numbers each. The normal is one of them: that of a piece of which a
 * part was split off, or of a crack of the scene, is another in its last digit than what its ends would
 * give. */
static void give_piece (void *context, size_t i, long *count, double *number)
{
    const pg_crack_paths *w = context;
    count[0] = w->cracks.crack[i].sided, count[1] = w->parent[i] == SIZE_MAX ? -1 : (long) w->parent[i];
    count[2] = (long) w->path[i], count[3] = w->owner[i];
    memcpy (number, w->store + 6*i, 6 * sizeof *number), number[6] = w->cracks.crack[i].width;
    memcpy (number + 7, w->cracks.crack[i].normal, 2 * sizeof *number);
}

static pg_status take_piece (void *context, size_t i, const long *c, const double *number,
                             const pg_keeper *k)
{
    pg_status status = PG_OK;
    pg_crack_paths *w = context;
    long n = (long) w->cracks.n;
    PG_KEEP_BOUND (k, "the sides of a crack", c[0], 0, 1);
    PG_KEEP_BOUND (k, "the parent of a crack", c[1], -1, n - 1);
    PG_KEEP_BOUND (k, "the path of a crack", c[2], 0, n - 1);
    pg_crack *piece = &w->cracks.crack[i];
    if (i >= w->nfirst) *piece = (pg_crack) { .kind = PG_CRACK_SEGMENT, .nvertex = 2 };
    piece->sided = (int) c[0], piece->width = number[6];
    memcpy (piece->normal, number + 7, 2 * sizeof *number);
    w->parent[i] = c[1] < 0 ? SIZE_MAX : (size_t) c[1], w->path[i] = (size_t) c[2], w->owner[i] = c[3];
    memcpy (w->store + 6*i, number, 6 * sizeof *number);
done:
    return status;
}

/* Tips: four whole numbers and four numbers each. */
static void give_tip (void *context, size_t i, long *count, double *number)
{
    const pg_tip *t = &((const pg_crack_paths *) context)->tip[i];
    const long whole[4] = { t->id, (long) t->segment, t->end, t->open };
    const double real[4] = { t->x[0], t->x[1], t->offset, t->grown };
    memcpy (count, whole, sizeof whole), memcpy (number, real, sizeof real);
}

static pg_status take_tip (void *context, size_t i, const long *c, const double *x, const pg_keeper *k)
{
    pg_status status = PG_OK;
    pg_crack_paths *w = context;
    PG_KEEP_BOUND (k, "the piece of a tip", c[1], 0, (long) w->cracks.n - 1);
    PG_KEEP_BOUND (k, "the end of a tip", c[2], 0, 1);
    PG_KEEP_BOUND (k, "whether a tip is open", c[3], 0, 1);
    w->tip[i] = (pg_tip) { .id = c[0], .segment = (size_t) c[1], .end = (int) c[2], .open = (int) c[3],
                           .x = { x[0], x[1] }, .offset = x[2], .grown = x[3] };
done:
    return status;
}

/* The counts first: arrays of that length follow. A facet has cut one bond at least. */
pg_status paths_keep (pg_crack_paths *w, long most, const char *name, const pg_keeper *k)
{
    pg_status status = PG_OK;
    char part[80];
    long count[2] = { (long) w->cracks.n, (long) w->ntip };
    snprintf (part, sizeof part, "%s.counts", name);
    PG_TRY (k->counts (k->context, part, 2, count));
    PG_KEEP_BOUND (k, "the number of cracks", count[0], (long) w->nfirst, most);
    PG_KEEP_BOUND (k, "the number of tips", count[1], 0, 2 * count[0]);
    snprintf (part, sizeof part, "%s.length", name);
    PG_TRY (k->numbers (k->context, part, 1, &w->length));
    if (k->reading) {
        PG_TRY (pg_crack_paths_reserve (w, (size_t) count[0]));
        PG_GROW (w->tip, w->tip_capacity, (size_t) count[1]);
        w->cracks.n = (size_t) count[0], w->ntip = (size_t) count[1];
    }
    char pieces[80], places[80], tips[80], tip_places[80];
    snprintf (pieces, sizeof pieces, "%s.pieces", name), snprintf (places, sizeof places, "%s.places", name);
    snprintf (tips, sizeof tips, "%s.tips", name);
    snprintf (tip_places, sizeof tip_places, "%s.tip_places", name);
    const pg_records list[2] = {
        { .count_name = pieces, .number_name = places, .n = w->cracks.n, .counts = 4, .numbers = 9,
          .give = give_piece, .take = take_piece, .context = w },
        { .count_name = tips, .number_name = tip_places, .n = w->ntip, .counts = 4, .numbers = 4,
          .give = give_tip, .take = take_tip, .context = w },
    };
    for (int i = 0; i < 2; i++) PG_TRY (pg_keep_records (k, &list[i]));
    if (!k->reading) goto done;
    point_into_store (w);
    PG_TRY (pg_cracks_index (&w->cracks));
done:
    if (status != PG_OK && k->reading) w->cracks.n = w->ntip = 0;
    return status;
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * Memory of the surfaces of growing cracks (crack_surfaces.c) and of their fronts: creation, copies,
 * checkpoints. Checkpoints contain the vertex indices of triangles, so that neighbouring triangles share
 * vertices exactly in a resumed run. */
#include "crack_surfaces.h"
#include <stdint.h>
#include <stdio.h>
#include <string.h>

/* ---- fronts -------------------------------------------------------------------------------------------- */
/* Reserves memory for at least n vertices of a front, with a surplus for growth. */
pg_status pg_front_reserve (pg_front *f, size_t n)
{
    pg_status status = PG_OK;
    PG_GROW_ALSO (f->x, 3, f->capacity, n);
    PG_GROW_ALSO (f->normal, 3, f->capacity, n);
    PG_GROW_ALSO (f->ahead, 3, f->capacity, n);
    PG_GROW_ALSO (f->offset, 1, f->capacity, n);
    PG_GROW_ALSO (f->grown, 1, f->capacity, n);
    PG_GROW (f->meets, f->capacity, n);
done:
    return status;
}

pg_status pg_front_copy (pg_front *to, const pg_front *from)
{
    pg_status status = PG_OK;
    size_t n = from->n;
    PG_TRY (pg_front_reserve (to, n));
    PG_GROW (to->rim, to->rim_capacity, from->nrim);
    to->id = from->id, to->of = from->of;
    to->closed = from->closed, to->open = from->open, to->n = n, to->nrim = from->nrim;
    if (n) {
        memcpy (to->x, from->x, 3 * n * sizeof *to->x);
        memcpy (to->normal, from->normal, 3 * n * sizeof *to->x);
        memcpy (to->ahead, from->ahead, 3 * n * sizeof *to->x);
        memcpy (to->offset, from->offset, n * sizeof *to->x);
        memcpy (to->grown, from->grown, n * sizeof *to->x);
        memcpy (to->meets, from->meets, n);
    }
    if (from->nrim) memcpy (to->rim, from->rim, from->nrim * sizeof *to->rim);
done:
    return status;
}

void pg_front_clear (pg_front *f)
{
    pg_free (f->x), pg_free (f->normal), pg_free (f->ahead), pg_free (f->offset), pg_free (f->grown);
    pg_free (f->meets), pg_free (f->rim);
    memset (f, 0, sizeof *f);
}

pg_status surfaces_reserve_fronts (pg_crack_surfaces *w, size_t n)
{
    pg_status status = PG_OK;
    size_t before = w->front_capacity;
    PG_GROW (w->front, w->front_capacity, n);
    if (w->front_capacity > before)
        memset (w->front + before, 0, (w->front_capacity - before) * sizeof *w->front);
done:
    return status;
}

/* ---- triangles ----------------------------------------------------------------------------------------- */
/* Sets the pointers of triangles to the positions of their corners, which are in one block of memory. */
static void point_into_store (pg_crack_surfaces *w)
{
    for (size_t k = w->nfirst; k < w->cracks.n; k++)
        w->cracks.crack[k].vertex = w->store + 9 * (k - w->nfirst);
}

pg_status surfaces_reserve (pg_crack_surfaces *w, size_t cracks, size_t vertices)
{
    pg_status status = PG_OK;
    PG_GROW (w->vertex, w->vertex_capacity, 3 * vertices);
    PG_GROW_ALSO (w->cracks.crack, 1, w->capacity, cracks);
    PG_GROW_ALSO (w->corner, 3, w->capacity, cracks);
    PG_GROW_ALSO (w->store, 9, w->capacity, cracks);
    PG_GROW (w->owner, w->capacity, cracks);
done:
    if (w->store) point_into_store (w);
    return status;
}

/* ---- creation, copies ---------------------------------------------------------------------------------- */
/* Creates the surfaces of a state. Vertices of cracks of the scene are borrowed from the problem, as they do
 * not change. */
pg_status pg_surfaces_of (pg_crack_surfaces **out, const pg_cracks *cracks, const pg_front *front,
                          size_t nfront, double nothing)
{
    pg_status status = PG_OK;
    pg_crack_surfaces *w = NULL;
    PG_ALLOC (w, 1);
    w->cracks.dim = 3, w->nothing = nothing;
    PG_TRY (surfaces_reserve (w, cracks->n, 0));
    PG_TRY (surfaces_reserve_fronts (w, nfront));
    w->cracks.n = w->nfirst = cracks->n;
    for (size_t k = 0; k < w->nfirst; k++) w->cracks.crack[k] = cracks->crack[k];
    for (size_t f = 0; f < nfront; f++, w->nfront++) PG_TRY (pg_front_copy (&w->front[f], &front[f]));
    PG_TRY (pg_cracks_index (&w->cracks));
    *out = w;
    w = NULL;
done:
    pg_crack_surfaces_free (&w);
    return status;
}

pg_status pg_crack_surfaces_copy (pg_crack_surfaces *to, const pg_crack_surfaces *from)
{
    pg_status status = PG_OK;
    size_t n = from->cracks.n, grown = n - from->nfirst;
    PG_TRY (surfaces_reserve (to, n, from->nvertex));
    PG_TRY (surfaces_reserve_fronts (to, from->nfront));
    for (size_t f = 0; f < from->nfront; f++) PG_TRY (pg_front_copy (&to->front[f], &from->front[f]));
    to->cracks.n = n, to->cracks.dim = 3, to->nfirst = from->nfirst, to->nfront = from->nfront;
    to->area = from->area, to->nothing = from->nothing, to->nvertex = from->nvertex;
    if (n) memcpy (to->cracks.crack, from->cracks.crack, n * sizeof *to->cracks.crack);
    if (from->nvertex) memcpy (to->vertex, from->vertex, 3 * from->nvertex * sizeof *to->vertex);
    if (grown) {
        memcpy (to->corner, from->corner, 3 * grown * sizeof *to->corner);
        memcpy (to->owner, from->owner, grown * sizeof *to->owner);
        memcpy (to->store, from->store, 9 * grown * sizeof *to->store);
    }
    point_into_store (to);
    PG_TRY (pg_cracks_copy_index (&to->cracks, &from->cracks));
done:
    return status;
}

void pg_crack_surfaces_free (pg_crack_surfaces **surfaces)
{
    pg_crack_surfaces *w = *surfaces;
    if (!w) return;
    for (size_t f = 0; w->front && f < w->front_capacity; f++) pg_front_clear (&w->front[f]);
    pg_free (w->cracks.crack), pg_cracks_clear_index (&w->cracks);
    pg_free (w->vertex), pg_free (w->corner), pg_free (w->owner), pg_free (w->store), pg_free (w->front);
    pg_free (w);
    *surfaces = NULL;
}

/* ---- checkpoints --------------------------------------------------------------------------------------- */
/* Writes or reads the vertices of a front, what they meet, and its rim. */
static pg_status keep_front (pg_front *f, const char *name, size_t i, size_t nvertex, const pg_keeper *k)
{
    pg_status status = PG_OK;
    char places[40], meets[40], rim[40];
    snprintf (places, sizeof places, "front.%zu.places", i);
    snprintf (meets, sizeof meets, "front.%zu.meets", i);
    snprintf (rim, sizeof rim, "front.%zu.rim", i);
    PG_TRY (pg_front_reserve (f, f->n));
    PG_GROW (f->rim, f->rim_capacity, f->nrim);
    PG_TRY (pg_keep_fields (k, name, meets, places, f->n, PG_ROWS (
        PG_ITEMS_IN (f->meets, 1, 0, PG_MEETS_CRACK, "what a front meets"), PG_ITEMS (f->x, 3),
        PG_ITEMS (f->normal, 3), PG_ITEMS (f->ahead, 3), PG_ITEMS (f->offset, 1), PG_ITEMS (f->grown, 1))));
    PG_TRY (pg_keep_fields (k, name, rim, NULL, f->nrim, PG_ROWS (
        PG_ITEMS_IN (f->rim, 1, 0, (long) nvertex - 1, "the rim of a front"))));
done:
    return status;
}

static pg_status keep_fronts (pg_crack_surfaces *w, const char *name, size_t n, long most,
                              const pg_keeper *k)
{
    pg_status status = PG_OK;
    pg_front *f = w->front;
    PG_TRY (pg_keep_fields (k, name, "fronts", NULL, n, PG_ROWS (
        PG_EACH_IN (f, n, 0, most, "the vertices of a front"),
        PG_EACH_IN (f, nrim, 0, most, "the length of a rim"), PG_EACH (f, id), PG_EACH (f, of),
        PG_EACH_IN (f, closed, 0, 1, "whether a front is a loop"),
        PG_EACH_IN (f, open, 0, 1, "whether a front is open"))));
    for (size_t i = 0; i < n; i++) PG_TRY (keep_front (&f[i], name, i, w->nvertex, k));
done:
    return status;
}

/* Writes or reads surfaces: counts first, then arrays. Normals of triangles are stored, as they cannot be
 * recomputed for slivers. */
pg_status pg_surfaces_keep (pg_crack_surfaces *w, long most, const char *name, const pg_keeper *k)
{
    pg_status status = PG_OK;
    size_t n = w->cracks.n - w->nfirst, nvertex = w->nvertex, nfront = w->nfront;
    PG_TRY (pg_keep_fields (k, name, "counts", "area", 1, PG_ROWS (
        PG_KEPT_IN (n, 0, most, "the size of the cracks"),
        PG_KEPT_IN (nvertex, 0, most, "the size of the cracks"),
        PG_KEPT_IN (nfront, 0, most, "the size of the cracks"), PG_KEPT (w->area))));
    if (k->reading) {
        w->cracks.n = w->nfirst, w->nvertex = w->nfront = 0;
        PG_TRY (surfaces_reserve (w, w->nfirst + n, nvertex));
        PG_TRY (surfaces_reserve_fronts (w, nfront));
    }
    if (nvertex) PG_TRY (pg_keep_numbers (k, name, "vertices", 3 * nvertex, w->vertex));
    w->nvertex = nvertex;
    pg_crack *c = w->cracks.crack ? w->cracks.crack + w->nfirst : NULL;
    PG_TRY (pg_keep_fields (k, name, "triangles", "normals", n, PG_ROWS (
        PG_ITEMS_IN (w->corner, 3, 0, (long) nvertex - 1, "the corner of a triangle"), PG_ITEMS (w->owner, 1),
        PG_EACH (c, normal), PG_EACH (c, width))));
    for (size_t i = 0; i < n && k->reading; i++)
        surfaces_put_triangle (w, w->corner + 3*i, c[i].normal, c[i].width, w->owner[i]);
    PG_TRY (keep_fronts (w, name, nfront, most, k));
    w->nfront = nfront;
    if (k->reading) PG_TRY (pg_cracks_index (&w->cracks));
done:
    if (status != PG_OK && k->reading) w->cracks.n = w->nfirst, w->nvertex = w->nfront = 0;
    return status;
}

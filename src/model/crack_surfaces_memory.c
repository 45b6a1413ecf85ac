/* SPDX-License-Identifier: GPL-3.0-or-later
 * Memory of the surfaces of growing cracks (crack_surfaces.c) and of their fronts: made with a state, copied
 * with it, kept in its checkpoints. Triangles are kept as their corners among the vertices, so that the
 * neighbours which a resumed run sees are bit by bit those of the run that wrote the checkpoint. */
#include "crack_surfaces.h"
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#define RESIZE(p, n) \
    do { \
        void *more_ = pg_resize ((p), (n), sizeof *(p)); \
        if (!more_) PG_FAIL (PG_E_MEMORY, "no memory for a crack of %zu parts", (size_t) (n)); \
        (p) = more_; \
    } while (0)

/* ---- fronts -------------------------------------------------------------------------------------------- */
/* Makes room for n vertices of a front, and as many more: it seldom moves while it grows one by one. */
pg_status pg_front_reserve (pg_front *f, size_t n)
{
    pg_status status = PG_OK;
    if (n <= f->capacity) return PG_OK;
    size_t most = 2 * n + 16;
    RESIZE (f->x, 3 * most);
    RESIZE (f->normal, 3 * most);
    RESIZE (f->ahead, 3 * most);
    RESIZE (f->offset, most);
    RESIZE (f->grown, most);
    RESIZE (f->meets, most);
    f->capacity = most;
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
/* Places of the corners lie in one block, and move with it. */
static void point_into_store (pg_crack_surfaces *w)
{
    for (size_t k = w->nfirst; k < w->cracks.n; k++)
        w->cracks.crack[k].vertex = w->store + 9 * (k - w->nfirst);
}

pg_status surfaces_reserve (pg_crack_surfaces *w, size_t cracks, size_t vertices)
{
    pg_status status = PG_OK;
    PG_GROW (w->vertex, w->vertex_capacity, 3 * vertices);
    if (cracks <= w->capacity) return PG_OK;
    size_t most = 2 * cracks + 16;
    RESIZE (w->cracks.crack, most);
    RESIZE (w->corner, 3 * most);
    RESIZE (w->owner, most);
    RESIZE (w->store, 9 * most);
    w->capacity = most;
done:
    if (w->store) point_into_store (w);
    return status;
}

/* ---- life ---------------------------------------------------------------------------------------------- */
/* Cracks of the scene are the problem's: a state has their vertices by reference, for they do not change. */
pg_status surfaces_of (pg_crack_surfaces **out, const pg_cracks *cracks, const pg_front *front, size_t nfront,
                       double nothing)
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
typedef struct { pg_crack_surfaces *w; const pg_keeper *k; const char *name; char part[96]; } walk;

static const char *part_of (walk *v, const char *suffix)
{
    snprintf (v->part, sizeof v->part, "%s.%s", v->name, suffix);
    return v->part;
}

/* Triangles: three corners and an owner each; normals as they are, for slivers have theirs from the front. */
static void give_triangle (void *context, size_t i, long *count, double *number)
{
    const pg_crack_surfaces *w = context;
    const pg_crack *c = &w->cracks.crack[w->nfirst + i];
    for (size_t a = 0; a < 3; a++) count[a] = (long) w->corner[3*i + a];
    memcpy (number, c->normal, 3 * sizeof *number);
    count[3] = w->owner[i], number[3] = c->width;
}

static pg_status take_triangle (void *context, size_t i, const long *count, const double *number,
                                const pg_keeper *k)
{
    pg_status status = PG_OK;
    pg_crack_surfaces *w = context;
    size_t corner[3];
    (void) i;                                          /* one after the other */
    for (int a = 0; a < 3; a++) {
        PG_KEEP_BOUND (k, "the corner of a triangle", count[a], 0, (long) w->nvertex - 1);
        corner[a] = (size_t) count[a];
    }
    surfaces_put_triangle (w, corner, number, number[3], count[3]);
done:
    return status;
}

/* Vertices of fronts: eleven numbers and what they meet. */
static void give_vertex (void *context, size_t i, long *count, double *number)
{
    const pg_front *f = context;
    memcpy (number, f->x + 3*i, 3 * sizeof *number), memcpy (number + 3, f->normal + 3*i, 3 * sizeof *number);
    memcpy (number + 6, f->ahead + 3*i, 3 * sizeof *number);
    number[9] = f->offset[i], number[10] = f->grown[i], count[0] = f->meets[i];
}

static pg_status take_vertex (void *context, size_t i, const long *count, const double *number,
                              const pg_keeper *k)
{
    pg_status status = PG_OK;
    pg_front *f = context;
    PG_KEEP_BOUND (k, "what a front meets", count[0], 0, PG_MEETS_CRACK);
    memcpy (f->x + 3*i, number, 3 * sizeof *number), memcpy (f->normal + 3*i, number + 3, 3 * sizeof *number);
    memcpy (f->ahead + 3*i, number + 6, 3 * sizeof *number);
    f->offset[i] = number[9], f->grown[i] = number[10], f->meets[i] = (unsigned char) count[0];
done:
    return status;
}

/* The vertices of a front, of which there are n, and its rim. */
static pg_status keep_front (walk *v, size_t number_of, size_t n, size_t rim)
{
    pg_status status = PG_OK;
    pg_front *f = &v->w->front[number_of];
    char places[96], meets[96], suffix[40];
    long *count = NULL;
    PG_ALLOC (count, rim + 1);
    PG_TRY (pg_front_reserve (f, n));
    PG_GROW (f->rim, f->rim_capacity, rim);
    for (size_t i = 0; !v->k->reading && i < rim; i++) count[i] = (long) f->rim[i];
    snprintf (places, sizeof places, "%s.front.%zu.places", v->name, number_of);
    snprintf (meets, sizeof meets, "%s.front.%zu.meets", v->name, number_of);
    PG_TRY (pg_keep_records (v->k, &(pg_records) { .count_name = meets, .number_name = places, .n = n,
                                                   .counts = 1, .numbers = 11, .give = give_vertex,
                                                   .take = take_vertex, .context = f }));
    snprintf (suffix, sizeof suffix, "front.%zu.rim", number_of);
    PG_TRY (v->k->counts (v->k->context, part_of (v, suffix), rim, count));
    for (size_t i = 0; i < rim; i++) {
        PG_KEEP_BOUND (v->k, "the rim of a front", count[i], 0, (long) v->w->nvertex - 1);
        f->rim[i] = (size_t) count[i];
    }
    f->n = n, f->nrim = rim;
done:
    pg_free (count);
    return status;
}

/* Five whole numbers of each front first: arrays of that length follow. */
static pg_status keep_fronts (walk *v, size_t n, long most)
{
    pg_status status = PG_OK;
    enum { EACH = 6 };
    pg_crack_surfaces *w = v->w;
    long *count = NULL;
    PG_ALLOC (count, EACH * n + 1);
    for (size_t i = 0; !v->k->reading && i < n; i++) {
        const pg_front *f = &w->front[i];
        const long whole[EACH] = { (long) f->n, (long) f->nrim, f->id, f->of, f->closed, f->open };
        memcpy (count + EACH * i, whole, sizeof whole);
    }
    PG_TRY (v->k->counts (v->k->context, part_of (v, "fronts"), EACH * n, count));
    for (size_t i = 0; i < n; i++) {
        const long *c = count + EACH * i;
        PG_KEEP_BOUND (v->k, "the vertices of a front", c[0], 0, most);
        PG_KEEP_BOUND (v->k, "the length of a rim", c[1], 0, most);
        PG_KEEP_BOUND (v->k, "whether a front is a loop", c[4], 0, 1);
        PG_KEEP_BOUND (v->k, "whether a front is open", c[5], 0, 1);
        PG_TRY (keep_front (v, i, (size_t) c[0], (size_t) c[1]));
        w->front[i].id = c[2], w->front[i].of = c[3];
        w->front[i].closed = (int) c[4], w->front[i].open = (int) c[5];
    }
done:
    pg_free (count);
    return status;
}

/* The counts first. */
pg_status surfaces_keep (pg_crack_surfaces *w, long most, const char *name, const pg_keeper *k)
{
    pg_status status = PG_OK;
    walk v = { .w = w, .k = k, .name = name };
    long count[3] = { (long) (w->cracks.n - w->nfirst), (long) w->nvertex, (long) w->nfront };
    PG_TRY (k->counts (k->context, part_of (&v, "counts"), 3, count));
    for (int i = 0; i < 3; i++) PG_KEEP_BOUND (k, "the size of the cracks", count[i], 0, most);
    PG_TRY (k->numbers (k->context, part_of (&v, "area"), 1, &w->area));
    if (k->reading) {
        w->cracks.n = w->nfirst, w->nvertex = w->nfront = 0;
        PG_TRY (surfaces_reserve (w, w->nfirst + (size_t) count[0], (size_t) count[1]));
        PG_TRY (surfaces_reserve_fronts (w, (size_t) count[2]));
    }
    if (count[1])
        PG_TRY (k->numbers (k->context, part_of (&v, "vertices"), 3 * (size_t) count[1], w->vertex));
    w->nvertex = (size_t) count[1];
    char corners[96], normals[96];
    snprintf (corners, sizeof corners, "%s.triangles", name);
    snprintf (normals, sizeof normals, "%s.normals", name);
    PG_TRY (pg_keep_records (k, &(pg_records) { .count_name = corners, .number_name = normals,
                                                .n = (size_t) count[0], .counts = 4, .numbers = 4,
                                                .give = give_triangle, .take = take_triangle,
                                                .context = w }));
    PG_TRY (keep_fronts (&v, (size_t) count[2], most));
    w->nfront = (size_t) count[2];
    if (k->reading) PG_TRY (pg_cracks_index (&w->cracks));
done:
    if (status != PG_OK && k->reading) w->cracks.n = w->nfirst, w->nvertex = w->nfront = 0;
    return status;
}

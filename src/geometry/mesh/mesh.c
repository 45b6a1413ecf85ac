/* SPDX-License-Identifier: GPL-3.0-or-later
 * Meshes: release, keys of faces, and the surface.
 *
 * The surface consists of the faces that belong to one element only. Faces are put into buckets by their
 * smallest node, where equal ones meet: linear time, and a few faces in each bucket. */
#include "element.h"
#include <stdlib.h>
#include <string.h>

/* Frees what a mesh holds and zeroes it, also where it is only half built. */
void pg_mesh_clear (pg_mesh *mesh)
{
    for (size_t i = 0; mesh->nodes && i < mesh->nnodes; i++) pg_free (mesh->nodes[i].node);
    for (size_t i = 0; mesh->sides && i < mesh->nsides; i++)
        pg_free (mesh->sides[i].element), pg_free (mesh->sides[i].side);
    pg_free (mesh->nodes), pg_free (mesh->sides), pg_free (mesh->blocks);
    pg_free (mesh->x), pg_free (mesh->node_id), pg_free (mesh->kind), pg_free (mesh->start),
        pg_free (mesh->node);
    pg_free (mesh->block), pg_free (mesh->element_id), pg_free (mesh->passed), pg_free (mesh->foreign);
    memset (mesh, 0, sizeof *mesh);
}

/* The key of a face: its corners, sorted by insertion, at most four. */
void mesh_face_key (const pg_mesh *mesh, size_t e, int f, int key[4])
{
    int corner[4], n = element_face_corners (mesh->kind[e], f, corner);
    for (int k = 0; k < 4; k++) key[k] = -1;
    for (int k = 0; k < n; k++) {
        int v = mesh->node[mesh->start[e] + (size_t) corner[k]], at = k;
        for (; at > 0 && key[at - 1] > v; at--) key[at] = key[at - 1];
        key[at] = v;
    }
}

/* ---- surface ------------------------------------------------------------------------------------------- */
/* SIDES: most faces of an element. FEW: buckets of up to so many faces are searched pair by pair. */
enum { SIDES = 6, FEW = 48 };
/* A face in a bucket: its other corners, and element * SIDES + side. */
typedef struct { int key[3]; unsigned face; } entry;

/* Do two entries of a bucket have the same corners? */
static int same (const entry *a, const entry *b) { return !memcmp (a->key, b->key, sizeof a->key); }

/* Order of entries: by corners, then by face. */
static int by_key (const void *p, const void *q)
{
    const entry *a = p, *b = q;
    for (int k = 0; k < 3; k++) if (a->key[k] != b->key[k]) return a->key[k] < b->key[k] ? -1 : 1;
    return (a->face > b->face) - (a->face < b->face);
}

/* Marks in `open` the faces of one bucket that no other equals. */
static void open_faces (entry *b, size_t n, unsigned char *open)
{
    /* Large buckets are sorted: equal faces become neighbours. */
    if (n > FEW) {
        pg_sort (b, n, sizeof *b, by_key);
        for (size_t i = 0; i < n; i++)
            open[b[i].face] = !(i > 0 && same (&b[i], &b[i - 1])) && !(i + 1 < n && same (&b[i], &b[i + 1]));
        return;
    }
    for (size_t i = 0; i < n; i++) {
        size_t j = 0;
        while (j < n && (j == i || !same (&b[i], &b[j]))) j++;
        open[b[i].face] = j == n;
    }
}

/* Fills the buckets: those of node k are (*out)[start[k]] .. (*out)[start[k + 1] - 1]. */
static pg_status fill_buckets (const pg_mesh *mesh, size_t *start, entry **out)
{
    pg_status status = PG_OK;
    int key[4];
    for (size_t e = 0; e < mesh->n; e++)
        for (int f = 0; f < pg_element_types[mesh->kind[e]].faces; f++)
            mesh_face_key (mesh, e, f, key), start[key[0] + 2]++;
    for (size_t k = 2; k < mesh->nnode + 2; k++) start[k] += start[k - 1];
    PG_ALLOC (*out, start[mesh->nnode + 1]);
    for (size_t e = 0; e < mesh->n; e++)
        for (int f = 0; f < pg_element_types[mesh->kind[e]].faces; f++) {
            mesh_face_key (mesh, e, f, key);
            entry *b = &(*out)[start[key[0] + 1]++];
            memcpy (b->key, key + 1, sizeof b->key);
            b->face = (unsigned) (e * SIDES + (size_t) f);
        }
done:
    return status;
}

/* The result is ordered by element and side, as the flags `open` are. */
pg_status pg_mesh_surface (const pg_mesh *mesh, size_t *n, int **element, int **side)
{
    pg_status status = PG_OK;
    size_t *start = NULL, k = 0;
    entry *bucket = NULL;
    unsigned char *open = NULL;
    *n = 0, *element = *side = NULL;
    if (mesh->n > (unsigned) -1 / SIDES)
        PG_FAIL (PG_E_LIMIT, "the surface of %zu elements: more than %u", mesh->n, (unsigned) -1 / SIDES);
    PG_ALLOC (start, mesh->nnode + 2);
    PG_ALLOC (open, mesh->n * SIDES);
    PG_TRY (fill_buckets (mesh, start, &bucket));
    for (size_t i = 0; i < mesh->nnode; i++) open_faces (bucket + start[i], start[i + 1] - start[i], open);
    for (size_t i = 0; i < mesh->n * SIDES; i++) *n += open[i];
    PG_ALLOC (*element, *n);
    PG_ALLOC (*side, *n);
    for (size_t i = 0; i < mesh->n * SIDES; i++)
        if (open[i]) (*element)[k] = (int) (i / SIDES), (*side)[k++] = (int) (i % SIDES);
done:
    pg_free (start), pg_free (bucket), pg_free (open);
    if (status != PG_OK) pg_free (*element), pg_free (*side), *element = *side = NULL, *n = 0;
    return status;
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * Background cells from a mesh: its elements become cells, its outer faces facets, its node and side sets
 * named sets. Areas, centroids and normals of facets are integrals over the (possibly curved) faces. */
#include "perigal/cells.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- names of sets ------------------------------------------------------------------------------------- */
/* Is c a letter (any byte beyond ASCII counts as part of one), a digit, - or _? */
static int is_plain (unsigned char c)
{
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '-'
           || c >= 0x80;
}

/* Bytes from 0x80 on are parts of letters in UTF-8 and are kept; a name is not cut off within a letter. */
void pg_set_name (char out[57], const char *name)
{
    size_t n = 0;
    for (; name[n] && n < 56; n++) {
        out[n] = is_plain ((unsigned char) name[n]) ? name[n] : '_';
    }
    /* A letter of several bytes is kept whole or dropped. */
    while (n > 0 && name[n] && ((unsigned char) name[n] & 0xC0) == 0x80) n--;
    out[n] = '\0';
    /* the name `all` is reserved for the whole boundary and all points */
    if (!n || !strcmp (out, "all")) snprintf (out, 57, "mesh_%s", n ? "all" : "set");
}

/* ---- cells and facets ---------------------------------------------------------------------------------- */
/* The mesh and the list of its outer faces: element and side number of each (nfacet). */
typedef struct { const pg_mesh_body *body; size_t nfacet; int *element, *side; } source;

/* Kind of a face of element e, and the numbers of its nodes in the mesh. */
static pg_element face_of (const pg_mesh *m, int e, int side, int node[9])
{
    pg_element kind = pg_element_face ((pg_element) m->kind[e], side, node);
    for (int k = 0; k < pg_element_types[kind].nodes; k++) node[k] = m->node[m->start[e] + (size_t) node[k]];
    return kind;
}

/* Copies the dim coordinates of a node (a mesh always stores three). */
static void put_place (double *to, const pg_mesh *m, int node)
{
    memcpy (to, m->x + 3 * (size_t) node, (size_t) m->dim * sizeof *to);
}

/* Writes nodes, kinds, volumes and blocks of all elements. */
static void put_cells (pg_cells *out, const pg_mesh_body *b)
{
    const pg_mesh *m = &b->mesh;
    for (size_t k = 0; k < m->start[m->n]; k++) put_place (out->x + k * (size_t) m->dim, m, m->node[k]);
    for (size_t e = 0; e < m->n; e++) {
        out->kind[e] = m->kind[e], out->start[e + 1] = m->start[e + 1];
        out->volume[e] = b->volume[e] * out->thickness, out->block[e] = m->block[e];
    }
}

/* Area, centroid and mean normal of facet f by quadrature of order 4, exact for flat faces and sufficient
 * for quadratic ones. The mean normal is the integral of the normals, scaled to unit length. */
static void measure_facet (pg_cells *out, size_t f)
{
    enum { ORDER = 4 };
    size_t dim = (size_t) out->dim;
    pg_element kind = (pg_element) out->facet_kind[f];
    double xi[2 * PG_ELEMENT_POINTS], weight[PG_ELEMENT_POINTS], area = 0, centre[3] = { 0 }, mean[3] = { 0 },
                                                                 size = 0;
    int n = pg_element_rule (kind, ORDER, xi, weight);
    for (int q = 0; q < n; q++) {
        double at[3], normal[3],
            w = weight[q]
                * pg_element_map (kind, out->dim, out->facet_x + out->facet_start[f] * dim,
                                  xi + q * ((int) dim - 1), at, normal);
        area += w;
        for (size_t k = 0; k < dim; k++) centre[k] += w * at[k], mean[k] += w * normal[k];
    }
    for (size_t k = 0; k < dim; k++) size += mean[k] * mean[k];
    for (size_t k = 0; k < dim; k++)
        out->facet_centre[f * dim + k] = centre[k] / area, out->normal[f * dim + k] = mean[k] / sqrt (size);
    out->area[f] = area * out->thickness;
}

/* In 1D a facet is an end of a line: its normal points away from the middle of element e. */
static void point_normal (pg_cells *out, size_t f, const pg_mesh *m, int e)
{
    double middle = 0.5
                    * (m->x[3 * (size_t) m->node[m->start[e]]] + m->x[3 * (size_t) m->node[m->start[e] + 1]]);
    out->facet_centre[f] = out->facet_x[out->facet_start[f]];
    out->normal[f] = out->facet_centre[f] > middle ? 1 : -1;
    out->area[f] = out->thickness;
}

/* Writes nodes, cloud points, area, centroid and normal of all outer faces. */
static void put_facets (pg_cells *out, const source *s)
{
    const pg_mesh *m = &s->body->mesh;
    for (size_t f = 0; f < s->nfacet; f++) {
        int node[9];
        pg_element kind = face_of (m, s->element[f], s->side[f], node);
        size_t first = out->facet_start[f];
        for (int k = 0; k < pg_element_types[kind].nodes; k++) {
            put_place (out->facet_x + (first + (size_t) k) * (size_t) m->dim, m, node[k]);
            out->facet_point[first + (size_t) k] = s->body->point[node[k]];
        }
        out->facet_kind[f] = (unsigned char) kind,
        out->facet_start[f + 1] = first + (size_t) pg_element_types[kind].nodes;
        out->facet_cell[f] = s->element[f], out->facet_surface[f] = -1;
        if (m->dim == 1) point_normal (out, f, m, s->element[f]);
        else measure_facet (out, f);
    }
}

/* ---- sets ---------------------------------------------------------------------------------------------- */
/* Marks from which one set is gathered. first: compressed rows from elements to their outer faces (n + 1).
 * node: nodes of the mesh; point: points of the cloud (npoint); facet: outer faces. */
typedef struct { const source *s; size_t npoint, *first; unsigned char *node, *point, *facet; } marks;

/* The indices, ascending, at which `mark` is set (newly allocated). */
static pg_status pick (int **out, size_t *n, const unsigned char *mark, size_t all)
{
    pg_status status = PG_OK;
    size_t k = 0;
    for (size_t i = 0; i < all; i++) k += mark[i];
    PG_ALLOC (*out, k);
    for (size_t i = k = 0; i < all; i++) if (mark[i]) (*out)[k++] = (int) i;
    *n = k;
done:
    return status;
}

/* Is `name` the plain form (pg_set_name) of the mesh's set name `of_mesh`? */
static int same_name (const char *name, const char *of_mesh)
{
    char clean[57];
    pg_set_name (clean, of_mesh);
    return !strcmp (clean, name);
}

/* Marks outer faces and nodes of all side sets of that name. Faces inside the body bring their nodes but no
 * facet. Returns how many such sets there are. */
static int mark_sides (marks *k, const char *name)
{
    const pg_mesh *m = &k->s->body->mesh;
    int found = 0;
    for (size_t i = 0; i < m->nsides; i++) {
        if (!same_name (name, m->sides[i].name)) continue;
        found++;
        for (size_t j = 0; j < m->sides[i].n; j++) {
            int e = m->sides[i].element[j], node[9];
            for (size_t f = k->first[e]; f < k->first[e + 1]; f++)
                if (k->s->side[f] == m->sides[i].side[j]) k->facet[f] = 1;
            int n = pg_element_types[face_of (m, e, m->sides[i].side[j], node)].nodes;
            for (int a = 0; a < n; a++) k->node[node[a]] = 1;
        }
    }
    return found;
}

/* For node sets: marks the outer faces whose nodes all belong to the set. */
static void mark_whole_facets (marks *k)
{
    const pg_mesh *m = &k->s->body->mesh;
    for (size_t f = 0; f < k->s->nfacet; f++) {
        int node[9], all = 1, n = pg_element_types[face_of (m, k->s->element[f], k->s->side[f], node)].nodes;
        for (int a = 0; a < n && all; a++) all = k->node[node[a]];
        if (all) k->facet[f] = 1;
    }
}

/* Appends the set called `of_mesh` in the mesh, the union of all side and node sets of that name. Where
 * there is a side set it determines the facets, else the nodes do. A name that is there already is
 * skipped. */
static pg_status add_given (pg_cells *out, size_t *capacity, marks *k, const char *of_mesh)
{
    pg_status status = PG_OK;
    const pg_mesh *m = &k->s->body->mesh;
    char name[57];
    pg_set_name (name, of_mesh);
    for (size_t i = 0; i < out->ngiven; i++) if (!strcmp (out->given[i].name, name)) return PG_OK;
    memset (k->node, 0, m->nnode), memset (k->point, 0, k->npoint), memset (k->facet, 0, k->s->nfacet);
    int sides = mark_sides (k, name);
    for (size_t i = 0; i < m->nnodes; i++)
        for (size_t j = 0; same_name (name, m->nodes[i].name) && j < m->nodes[i].n; j++)
            k->node[m->nodes[i].node[j]] = 1;
    if (!sides) mark_whole_facets (k);
    for (size_t i = 0; i < m->nnode; i++)
        if (k->node[i] && k->s->body->point[i] >= 0) k->point[k->s->body->point[i]] = 1;
    PG_GROW (out->given, *capacity, out->ngiven + 1);
    pg_set *set = &out->given[out->ngiven];
    memset (set, 0, sizeof *set);
    snprintf (set->name, sizeof set->name, "%s", name);
    set->by_faces = sides != 0;
    out->ngiven++;
    PG_TRY (pick (&set->point, &set->npoint, k->point, k->npoint));
    PG_TRY (pick (&set->facet, &set->nfacet, k->facet, k->s->nfacet));
done:
    return status;
}

/* All sets of the mesh, side sets first. */
static pg_status put_sets (pg_cells *out, const source *s)
{
    pg_status status = PG_OK;
    const pg_mesh *m = &s->body->mesh;
    size_t capacity = 0;
    marks k = { .s = s };
    for (size_t i = 0; i < m->nnode; i++) k.npoint += s->body->point[i] >= 0;
    PG_ALLOC (k.first, m->n + 1);
    PG_ALLOC (k.node, m->nnode);
    PG_ALLOC (k.point, k.npoint);
    PG_ALLOC (k.facet, s->nfacet);
    for (size_t f = 0; f < s->nfacet; f++) k.first[s->element[f] + 1]++;
    for (size_t e = 0; e < m->n; e++) k.first[e + 1] += k.first[e];
    for (size_t i = 0; i < m->nsides; i++) PG_TRY (add_given (out, &capacity, &k, m->sides[i].name));
    for (size_t i = 0; i < m->nnodes; i++) PG_TRY (add_given (out, &capacity, &k, m->nodes[i].name));
done:
    pg_free (k.first), pg_free (k.node), pg_free (k.point), pg_free (k.facet);
    return status;
}

pg_status pg_cells_from_mesh (pg_cells *out, const pg_mesh_body *body, double thickness)
{
    pg_status status = PG_OK;
    const pg_mesh *m = &body->mesh;
    source s = { .body = body };
    size_t nodes = 0;
    memset (out, 0, sizeof *out);
    PG_TRY (pg_mesh_surface (m, &s.nfacet, &s.element, &s.side));
    for (size_t f = 0; f < s.nfacet; f++) {
        int node[9];
        nodes += (size_t)
                     pg_element_types[pg_element_face ((pg_element) m->kind[s.element[f]], s.side[f], node)]
                         .nodes;
    }
    PG_TRY (pg_cells_reserve (out, m->dim, thickness, m->n, m->start[m->n], s.nfacet, nodes));
    PG_ALLOC (out->facet_point, nodes);
    put_cells (out, body);
    put_facets (out, &s);
    PG_TRY (put_sets (out, &s));
done:
    pg_free (s.element), pg_free (s.side);
    if (status != PG_OK) pg_cells_clear (out);
    return status;
}

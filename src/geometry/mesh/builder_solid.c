/* SPDX-License-Identifier: GPL-3.0-or-later
 * From the numbers of a file to a mesh: nodes are looked up, solid elements are separated from those that
 * only name a set, nodes that no solid element uses are dropped, and elements that were given inside out
 * are mirrored.
 *
 * Solid elements are those of the highest dimension in the file. Faults name the element with file and
 * line: missing or repeated nodes, elements without extent, plane meshes that are not in a plane of
 * constant z. */
#include "builder.h"
#include "element.h"
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Dimension, and number of nodes, of element e. */
static int dimension (const pg_mesh_builder *m, size_t e) { return pg_element_types[m->kind[e]].dim; }
static size_t length (const pg_mesh_builder *m, size_t e) { return m->start[e + 1] - m->start[e]; }

/* Fails with an error of element e that names its position in the file and its kind. */
#define ELEMENT_FAIL(m, e, ...) \
    do { \
        char at_[512], why_[400]; \
        builder_where ((m), (e), at_, sizeof at_); \
        snprintf (why_, sizeof why_, __VA_ARGS__); \
        PG_FAIL (PG_E_FILE, "%s (%s): %s", at_, pg_element_types[(m)->kind[e]].name, why_); \
    } while (0)

/* ---- from numbers of the file to indices --------------------------------------------------------------- */
/* Looks up the nodes of all elements. A solid element may name no node twice: a collapsed hexahedron would
 * have a singular map. */
static pg_status find_nodes (pg_mesh_builder *m)
{
    pg_status status = PG_OK;
    PG_ALLOC (m->made.index, m->nlist);
    for (size_t e = 0; e < m->n; e++)
        for (size_t k = m->start[e]; k < m->start[e + 1]; k++) {
            m->made.index[k] = (int) pg_id_table_find (&m->made.nodes, m->list[k]);
            /* Elements that only name a set must have their nodes in the file, too. */
            if (m->made.index[k] < 0) ELEMENT_FAIL (m, e, "node %ld is not in the file", m->list[k]);
            for (size_t l = m->start[e]; dimension (m, e) == m->made.dim && l < k; l++)
                if (m->made.index[l] == m->made.index[k])
                    ELEMENT_FAIL (m, e,
                                  "node %ld is named twice; write collapsed elements as triangles, "
                                  "tetrahedra, pyramids or wedges",
                                  m->list[k]);
        }
done:
    return status;
}

/* For qsort: ascending. */
static int by_int (const void *p, const void *q)
{
    int a = *(const int *) p, b = *(const int *) q;
    return (a > b) - (a < b);
}

/* Do two elements have the same kind and the same nodes, in whatever order? */
static int same_nodes (const pg_mesh_builder *m, size_t e, size_t f)
{
    int a[PG_ELEMENT_NODES], b[PG_ELEMENT_NODES];
    size_t n = length (m, e);
    if (m->kind[e] != m->kind[f]) return 0;
    memcpy (a, m->made.index + m->start[e], n * sizeof *a),
        memcpy (b, m->made.index + m->start[f], n * sizeof *b);
    pg_sort (a, n, sizeof *a, by_int), pg_sort (b, n, sizeof *b, by_int);
    return !memcmp (a, b, n * sizeof *a);
}

/* Hash of a number. Sums of hashed numbers do not depend on the order of the nodes. */
static uint64_t mix (uint64_t h)
{
    h = (h ^ (h >> 31)) * UINT64_C (0x7FB5D329728EA185);
    h = (h ^ (h >> 27)) * UINT64_C (0x81DADEF4BC2DD44D);
    return h ^ (h >> 33);
}

/* Numbers the solid elements. Some files write an element once for each group it belongs to: the first is the
 * element, later ones only join a set; a hash table over the nodes of elements finds them. */
static pg_status number_solids (pg_mesh_builder *m)
{
    pg_status status = PG_OK;
    size_t slots = 16;
    int *table = NULL, n = 0;
    uint64_t *hash = NULL;
    while (slots < 2 * m->n) slots *= 2;
    PG_ALLOC (table, slots);
    PG_ALLOC (hash, m->n);
    PG_ALLOC (m->made.solid, m->n);
    for (size_t e = 0; e < m->n; e++) {
        m->made.solid[e] = -1;
        if (dimension (m, e) < m->made.dim) continue;
        /* The sum does not depend on the order of the nodes. */
        for (size_t k = m->start[e]; k < m->start[e + 1]; k++)
            hash[e] += mix ((uint64_t) m->made.index[k] + 1);
        size_t s = (size_t) mix (hash[e]) & (slots - 1);
        /* Open addressing: equal hashes are compared node by node. */
        while (table[s] && !(hash[table[s] - 1] == hash[e] && same_nodes (m, e, (size_t) table[s] - 1)))
            s = (s + 1) & (slots - 1);
        m->made.solid[e] = table[s] ? -2 : n++;
        if (!table[s]) table[s] = (int) e + 1;
    }
    m->made.out->n = (size_t) n;
done:
    pg_free (table), pg_free (hash);
    return status;
}

/* Files without nodes, or without elements that have an extent, are refused first. */
pg_status builder_resolve (pg_mesh_builder *m)
{
    pg_status status = PG_OK;
    size_t twice;
    for (size_t e = 0; e < m->n; e++) if (dimension (m, e) > m->made.dim) m->made.dim = dimension (m, e);
    if (m->nnode == 0) PG_FAIL (PG_E_FILE, "%s: there are no nodes", m->path);
    if (m->made.dim == 0)
        PG_FAIL (PG_E_FILE,
                 "%s: points without elements: a mesh needs lines, triangles, quadrilaterals, tetrahedra, "
                 "hexahedra, pyramids or wedges",
                 m->path);
    PG_TRY (pg_id_table_build (&m->made.nodes, m->nnode, m->node_id, &twice));
    if (twice < m->nnode) PG_FAIL (PG_E_FILE, "%s: node %ld is there twice", m->path, m->node_id[twice]);
    PG_TRY (find_nodes (m));
    PG_TRY (number_solids (m));
    m->made.out->dim = m->made.dim;
done:
    return status;
}

/* ---- nodes in use -------------------------------------------------------------------------------------- */
/* Numbers the nodes in use, in the order of the file. */
static pg_status keep_nodes (pg_mesh_builder *m)
{
    pg_status status = PG_OK;
    pg_mesh *out = m->made.out;
    PG_ALLOC (m->made.kept, m->nnode);
    for (size_t e = 0; e < m->n; e++)
        for (size_t k = m->start[e]; m->made.solid[e] >= 0 && k < m->start[e + 1]; k++)
            m->made.kept[m->made.index[k]] = 1;
    for (size_t k = 0; k < m->nnode; k++) m->made.kept[k] = m->made.kept[k] ? (int) out->nnode++ : -1;
    PG_ALLOC (out->x, 3 * out->nnode);
    PG_ALLOC (out->node_id, out->nnode);
    for (size_t k = 0; k < m->nnode; k++) {
        if (m->made.kept[k] < 0) continue;
        memcpy (out->x + 3 * (size_t) m->made.kept[k], m->x + 3 * k, 3 * sizeof *m->x);
        out->node_id[m->made.kept[k]] = m->node_id[k];
    }
done:
    return status;
}

/* Checks that a mesh of lines lies parallel to the x axis, and one of triangles and quadrilaterals parallel
 * to the x-y plane, to 1e-9 of its size. */
static pg_status check_plane (pg_mesh_builder *m)
{
    pg_status status = PG_OK;
    const pg_mesh *out = m->made.out;
    double low[3], high[3], size = 0;
    for (int a = 0; a < 3; a++) {
        low[a] = high[a] = out->x[a];
        for (size_t k = 0; k < out->nnode; k++)
            low[a] = fmin (low[a], out->x[3 * k + (size_t) a]),
            high[a] = fmax (high[a], out->x[3 * k + (size_t) a]);
        size = fmax (size, high[a] - low[a]);
    }
    for (int a = out->dim; a < 3; a++)
        if (high[a] - low[a] > 1e-9 * size)
            PG_FAIL (PG_E_FILE,
                     "%s: the elements are %s, but %c goes from %g to %g; a mesh in %dD lies in %s (was a "
                     "body of higher dimension to be meshed?)",
                     m->path, out->dim == 1 ? "lines" : "triangles and quadrilaterals", 'x' + a, low[a],
                     high[a], out->dim, out->dim == 1 ? "y, z = constant" : "z = constant");
done:
    return status;
}

/* ---- solid elements ------------------------------------------------------------------------------------ */
/* Writes the solid elements in the order of the file. */
static pg_status fill_solids (pg_mesh_builder *m)
{
    pg_status status = PG_OK;
    pg_mesh *out = m->made.out;
    size_t total = 0;
    for (size_t e = 0; e < m->n; e++) if (m->made.solid[e] >= 0) total += length (m, e);
    PG_ALLOC (out->kind, out->n);
    PG_ALLOC (out->start, out->n + 1);
    PG_ALLOC (out->node, total);
    PG_ALLOC (out->block, out->n);
    PG_ALLOC (out->element_id, out->n);
    for (size_t e = 0; e < m->n; e++) {
        if (m->made.solid[e] < 0) continue;
        size_t s = (size_t) m->made.solid[e], at = out->start[s];
        out->kind[s] = m->kind[e], out->element_id[s] = m->element_id[e];
        for (size_t k = m->start[e]; k < m->start[e + 1]; k++)
            out->node[at++] = m->made.kept[m->made.index[k]];
        out->start[s + 1] = at;
    }
done:
    return status;
}

/* Size factor (determinant of the Jacobian) of the map at the centre of element e. *flat: 1: it is below
 * 1e-12 of the cube around the element. */
static double centre_size (const pg_mesh *out, size_t e, int *flat)
{
    double x[3 * PG_ELEMENT_NODES], xi[3], longest = 0;
    size_t dim = (size_t) out->dim, n = out->start[e + 1] - out->start[e];
    for (size_t a = 0; a < dim; a++) {
        double low = HUGE_VAL, high = -HUGE_VAL;
        for (size_t k = 0; k < n; k++) {
            double v = x[k * dim + a] = out->x[3 * (size_t) out->node[out->start[e] + k] + a];
            low = fmin (low, v), high = fmax (high, v);
        }
        /* Longest edge of the box around the element. */
        longest = fmax (longest, high - low);
    }
    element_centre (out->kind[e], xi);
    double size = pg_element_map (out->kind[e], out->dim, x, xi, NULL, NULL);
    *flat = !(fabs (size) > 1e-12 * pow (longest, out->dim));
    return size;
}

/* Mirrors elements with a negative size; a flat element is an error. */
static pg_status turn_outside_out (pg_mesh_builder *m)
{
    pg_status status = PG_OK;
    pg_mesh *out = m->made.out;
    PG_ALLOC (m->made.turned, out->n);
    for (size_t e = 0; e < m->n; e++) {
        int flat, old[PG_ELEMENT_NODES];
        size_t s = (size_t) m->made.solid[e];
        if (m->made.solid[e] < 0) continue;
        double size = centre_size (out, s, &flat);
        if (flat)
            ELEMENT_FAIL (m, e, "is flat: it has no %s",
                          out->dim == 3   ? "volume"
                          : out->dim == 2 ? "area"
                                          : "length");
        if (size > 0) continue;
        size_t n = length (m, e);
        const signed char *mirror = element_mirror (m->kind[e]);
        memcpy (old, out->node + out->start[s], n * sizeof *old);
        for (size_t k = 0; k < n; k++) out->node[out->start[s] + k] = old[mirror[k]];
        m->made.turned[s] = 1;
    }
done:
    return status;
}

/* ---- blocks -------------------------------------------------------------------------------------------- */
static int by_long (const void *p, const void *q)
{
    long a = *(const long *) p, b = *(const long *) q;
    return (a > b) - (a < b);
}

/* Lists the groups of the solid elements, ascending, each once. */
static pg_status list_groups (const pg_mesh_builder *m, size_t *n, long **group)
{
    pg_status status = PG_OK;
    size_t cap = 0, k = 0;
    for (size_t e = 0; e < m->n; e++) {
        if (m->made.solid[e] < 0 || (*n && (*group)[*n - 1] == m->group[e])) continue;
        PG_GROW (*group, cap, *n + 1);
        (*group)[(*n)++] = m->group[e];
    }
    pg_sort (*group, *n, sizeof **group, by_long);
    for (size_t i = 0; i < *n; i++) if (k == 0 || (*group)[i] != (*group)[k - 1]) (*group)[k++] = (*group)[i];
    *n = k;
done:
    return status;
}

/* Makes the blocks, in the order of their numbers. */
static pg_status make_blocks (pg_mesh_builder *m)
{
    pg_status status = PG_OK;
    pg_mesh *out = m->made.out;
    size_t n = 0;
    long *group = NULL;
    PG_TRY (list_groups (m, &n, &group));
    PG_ALLOC (out->blocks, n);
    out->nblock = n;
    for (size_t b = 0; b < n; b++) {
        out->blocks[b].id = (int) group[b];
        builder_name (m, m->made.dim, group[b], out->blocks[b].name);
    }
    for (size_t e = 0, b = 0; e < m->n; e++) {
        if (m->made.solid[e] < 0) continue;
        if (group[b] != m->group[e])
            b = (size_t) ((long *) pg_search (&m->group[e], group, n, sizeof *group, by_long) - group);
        out->block[m->made.solid[e]] = (int) b;
        out->blocks[b].n++;
    }
done:
    pg_free (group);
    return status;
}

/* Makes the solid elements. Their orientation needs the nodes first; blocks come last because they need no
 * more than the elements. */
pg_status builder_solids (pg_mesh_builder *m)
{
    pg_status status = PG_OK;
    PG_TRY (keep_nodes (m));
    PG_TRY (check_plane (m));
    PG_TRY (fill_solids (m));
    PG_TRY (turn_outside_out (m));
    PG_TRY (make_blocks (m));
done:
    return status;
}

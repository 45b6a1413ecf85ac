/* SPDX-License-Identifier: GPL-3.0-or-later
 * The body as a mesh: file, unit, blocks in use, and whether its elements can serve as cells.
 *
 * An element can serve as a cell if its map is invertible: the Jacobian must be positive at all nodes and
 * quadrature points. Its quality, the scaled Jacobian of the element with straight edges, is only reported.
 */
#include "mesh_body.h"
#include "perigal/mesh_files.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- file and unit ------------------------------------------------------------------------------------- */
/* Reads the file that key AT.file names, relative to the input file. Errors are reported as errors of the
 * input file (scene). */
static pg_status read_file (pg_mesh_body *b, const pg_scene *scene, const char *at)
{
    pg_status status = PG_OK;
    char *path = NULL, why[900], key[128];
    snprintf (key, sizeof key, "%.100s.file", at);
    snprintf (b->file, sizeof b->file, "%s", pg_scene_text (scene, "%s", key));
    PG_TRY (pg_scene_beside (&path, scene, pg_scene_text (scene, "%s", key)));
    status = pg_mesh_read (&b->mesh, path);
    /* Lack of memory is no error of the input file. */
    if (status == PG_E_MEMORY) goto done;
    if (status != PG_OK) {
        snprintf (why, sizeof why, "%s", pg_last_error ());
        pg_scene_fault (scene, key, "%s", why);
        PG_TRY (pg_scene_verdict (scene));
    }
    int dim = (int) pg_scene_integer (scene, "dimension");
    if (b->mesh.dim != dim) {
        pg_scene_fault (scene, key, "its elements are of dimension %d, and dimension is %d", b->mesh.dim,
                        dim);
        PG_TRY (pg_scene_verdict (scene));
    }
done:
    pg_free (path);
    return status;
}

/* Scales the mesh to m by the unit of its file: a unit ("mm") or a length ("25.4 mm"). */
static pg_status scale (pg_mesh_body *b, const pg_scene *scene, const char *at)
{
    pg_status status = PG_OK;
    const char *text = pg_scene_text (scene, "%s.unit", at);
    char one[64], key[128];
    snprintf (key, sizeof key, "%.100s.unit", at);
    int number = strchr ("+-.0123456789", text[0]) != NULL;
    snprintf (one, sizeof one, "%s%.50s", number ? "" : "1 ", text);
    if (pg_unit_parse (&b->unit, one, "m") != PG_OK || !(b->unit > 0) || !isfinite (b->unit)) {
        pg_scene_fault (scene, key,
                        "is no unit of length: write m, mm, um, inch, or a length such as 25.4 mm");
        PG_TRY (pg_scene_verdict (scene));
    }
    for (size_t k = 0; k < 3 * b->mesh.nnode; k++) b->mesh.x[k] *= b->unit;
done:
    return status;
}

/* ---- blocks -------------------------------------------------------------------------------------------- */
/* Returns the number of the block with that name or, failing that, that id (a block may be called "2"); -1:
 * none. */
int pg_mesh_body_block (const pg_mesh *m, const char *name)
{
    char number[24];
    for (size_t k = 0; k < m->nblock; k++) if (!strcmp (m->blocks[k].name, name)) return (int) k;
    for (size_t k = 0; k < m->nblock; k++) {
        snprintf (number, sizeof number, "%d", m->blocks[k].id);
        if (!strcmp (number, name)) return (int) k;
    }
    return -1;
}

/* The names of all blocks as "a|b|c", as pg_nearest_name reads them; as many as fit. */
void pg_mesh_body_blocks (const pg_mesh *m, char *out, size_t size)
{
    size_t at = 0;
    out[0] = '\0';
    for (size_t k = 0; k < m->nblock && at + 70 < size; k++)
        at += (size_t) snprintf (out + at, size - at, "%s%s", k ? "|" : "", m->blocks[k].name);
}

/* Removes the elements of blocks that are not in use, and with them their nodes and sides; in place. */
static pg_status keep_elements (pg_mesh *m, const unsigned char *keep)
{
    pg_status status = PG_OK;
    int *element = NULL, *node = NULL;
    size_t n = 0, nnode = 0, at = 0;
    PG_ALLOC (element, m->n);
    PG_ALLOC (node, m->nnode);
    /* Elements move to the front; element[e] becomes their new number, node marks what they use. */
    for (size_t e = 0; e < m->n; e++) {
        element[e] = keep[m->block[e]] ? (int) n : -1;
        if (element[e] < 0) continue;
        size_t first = m->start[e], count = m->start[e + 1] - first;
        for (size_t k = 0; k < count; k++) node[m->node[first + k]] = 1;
        memmove (m->node + at, m->node + first, count * sizeof *m->node);
        m->kind[n] = m->kind[e], m->block[n] = m->block[e], m->element_id[n] = m->element_id[e],
        m->start[n++] = at;
        at += count;
    }
    m->start[n] = at, m->n = n;
    /* Nodes move to the front too; node[i] becomes the new number. */
    for (size_t i = 0; i < m->nnode; i++) {
        if (!node[i]) node[i] = -1;
        else {
            memmove (m->x + 3 * nnode, m->x + 3 * i, 3 * sizeof *m->x);
            m->node_id[nnode] = m->node_id[i], node[i] = (int) nnode++;
        }
    }
    m->nnode = nnode;
    /* Old numbers in elements, node sets and side sets become new ones. */
    for (size_t k = 0; k < at; k++) m->node[k] = node[m->node[k]];
    for (size_t s = 0; s < m->nnodes; s++) {
        size_t left = 0;
        for (size_t k = 0; k < m->nodes[s].n; k++)
            if (node[m->nodes[s].node[k]] >= 0) m->nodes[s].node[left++] = node[m->nodes[s].node[k]];
        m->nodes[s].n = left;
    }
    for (size_t s = 0; s < m->nsides; s++) {
        size_t left = 0;
        for (size_t k = 0; k < m->sides[s].n; k++) {
            if (element[m->sides[s].element[k]] < 0) continue;
            m->sides[s].side[left] = m->sides[s].side[k],
            m->sides[s].element[left++] = element[m->sides[s].element[k]];
        }
        m->sides[s].n = left;
    }
done:
    pg_free (element), pg_free (node);
    return status;
}

/* Reports elements of unknown types, which would be holes of the body, unless key AT.blocks leaves out the
 * blocks that have them. */
static pg_status refuse_foreign (const pg_mesh *m, const pg_scene *scene, const char *at)
{
    char key[128], of[128], name[128];
    snprintf (key, sizeof key, "%.100s.file", at), snprintf (of, sizeof of, "%.100s.blocks", at);
    for (size_t k = 0; k < m->nforeign; k++) {
        const pg_mesh_foreign *f = &m->foreign[k];
        int used = !pg_scene_given (scene, "%s", of) || !f->block[0];
        const char *word;
        for (size_t i = 0; !used && (word = pg_scene_name (scene, i, "%s", of)); i++)
            used = strcmp (word, f->block) == 0;
        if (!used) continue;
        name[0] = 0;
        if (f->block[0]) snprintf (name, sizeof name, " (block %.60s: leave it out by `blocks`)", f->block);
        pg_scene_fault (scene, key, "%s%s", f->words, name);
        break;
    }
    return pg_scene_verdict (scene);
}

/* Keeps only the blocks that key AT.blocks lists, by name or number. */
static pg_status keep_blocks (pg_mesh *m, const pg_scene *scene, const char *at)
{
    pg_status status = PG_OK;
    char key[128];
    unsigned char *keep = NULL;
    const char *name;
    size_t n = 0;
    int *number = NULL;
    snprintf (key, sizeof key, "%.100s.blocks", at);
    if (!pg_scene_given (scene, "%s", key)) return refuse_foreign (m, scene, at);
    PG_TRY (refuse_foreign (m, scene, at));
    PG_ALLOC (keep, m->nblock);
    PG_ALLOC (number, m->nblock);
    /* Every name must be that of a block. */
    for (size_t i = 0; (name = pg_scene_name (scene, i, "%s", key)); i++) {
        char path[160], names[2000];
        int k = pg_mesh_body_block (m, name);
        if (k >= 0) {
            keep[k] = 1;
            continue;
        }
        snprintf (path, sizeof path, "%s[%zu]", key, i);
        pg_mesh_body_blocks (m, names, sizeof names);
        pg_scene_fault (scene, path, "the mesh has no block of this name; there are %s", names);
    }
    PG_TRY (pg_scene_verdict (scene));
    PG_TRY (keep_elements (m, keep));
    /* Blocks in use move to the front. */
    for (size_t k = 0; k < m->nblock; k++) {
        number[k] = (int) n;
        if (keep[k]) m->blocks[n++] = m->blocks[k];
    }
    m->nblock = n;
    for (size_t e = 0; e < m->n; e++) m->block[e] = number[m->block[e]];
    if (m->n == 0) pg_scene_fault (scene, key, "the blocks hold no element");
    PG_TRY (pg_scene_verdict (scene));
done:
    pg_free (keep), pg_free (number);
    return status;
}

/* ---- elements ------------------------------------------------------------------------------------------ */
/* Positions of the nodes of element e, m, dim numbers each: meshes keep three in any dimension. */
void pg_mesh_body_nodes (const pg_mesh *m, size_t e, double *x)
{
    size_t dim = (size_t) m->dim, first = m->start[e];
    for (size_t k = first; k < m->start[e + 1]; k++)
        for (size_t a = 0; a < dim; a++) x[(k - first) * dim + a] = m->x[3 * (size_t) m->node[k] + a];
}

/* Quality of an element: |det| of the unit vectors along the edges at a corner, over that of the regular
 * element; the least of all corners. 1 in 1D. */
static double scaled_jacobian (pg_element kind, int dim, const double *x)
{
    const pg_element_type *t = &pg_element_types[kind];
    static const double best[4][9] = { [2] = { [3] = 0.86602540378443865, [4] = 1 },
                                       [3] = {
                                           [4] = 0.70710678118654752, [6] = 0.86602540378443865, [8] = 1 } };
    double least = 1;
    if (dim == 1) return 1;
    for (int c = 0; c < t->corners; c++) {
        double v[3][3] = { { 0 } };
        int n = 0;
        /* Unit vectors along the edges that meet at corner c: dim of them. */
        for (int e = 0; e < t->edges && n < dim; e++) {
            int end[2];
            pg_element_edge (kind, e, end);
            if (end[0] != c && end[1] != c) continue;
            int other = end[0] == c ? end[1] : end[0];
            double size = 0;
            for (int a = 0; a < dim; a++)
                v[n][a] = x[other * dim + a] - x[c * dim + a], size += v[n][a] * v[n][a];
            for (int a = 0; a < dim && size > 0; a++) v[n][a] /= sqrt (size);
            n++;
        }
        /* Volume spanned by these vectors, over that at a corner of the regular element. */
        double det = dim == 2 ? v[0][0] * v[1][1] - v[0][1] * v[1][0]
                              : v[0][0] * (v[1][1] * v[2][2] - v[1][2] * v[2][1])
                                    - v[0][1] * (v[1][0] * v[2][2] - v[1][2] * v[2][0])
                                    + v[0][2] * (v[1][0] * v[2][1] - v[1][1] * v[2][0]);
        least = fmin (least, fabs (det) / best[dim][t->corners]);
    }
    return least;
}

/* Volume of element e. least: the smallest Jacobian at its nodes and quadrature points over the mean; not
 * positive where the element turns inside out. */
static double measure (const pg_mesh *m, size_t e, double *least)
{
    double x[3 * PG_ELEMENT_NODES], xi[3 * PG_ELEMENT_POINTS], weight[PG_ELEMENT_POINTS],
        volume = 0, low = INFINITY, reference = 0;
    pg_element kind = (pg_element) m->kind[e];
    pg_mesh_body_nodes (m, e, x);
    int n = pg_element_rule (kind, PG_MESH_BODY_ORDER, xi, weight);
    /* Jacobian at the quadrature points, by which the volume is summed. */
    for (int q = 0; q < n; q++) {
        double J = pg_element_map (kind, m->dim, x, xi + q * m->dim, NULL, NULL);
        volume += weight[q] * J, reference += weight[q];
        low = fmin (low, J);
    }
    /* Jacobian at the nodes, where that of curved elements is often smallest. */
    for (int i = 0; i < pg_element_types[kind].nodes; i++) {
        double at[3];
        pg_element_node (kind, i, at);
        low = fmin (low, pg_element_map (kind, m->dim, x, at, NULL, NULL));
    }
    *least = volume > 0 ? low * reference / volume : -1;
    return volume;
}

/* Computes volumes (m^3, in 2D m^2), sizes (their dim-th roots) and quality of all elements; the worst
 * element is remembered for the plan of the run. */
static pg_status check_elements (pg_mesh_body *b, const pg_scene *scene, const char *key)
{
    pg_status status = PG_OK;
    const pg_mesh *m = &b->mesh;
    PG_ALLOC (b->volume, m->n);
    b->smallest = INFINITY, b->largest = 0, b->quality = INFINITY;
    for (size_t e = 0; e < m->n; e++) {
        double x[3 * PG_ELEMENT_NODES], least;
        b->volume[e] = measure (m, e, &least);
        /* Written so that NaN is an error as well. */
        if (!(least > 0)) {
            pg_scene_fault (
                scene, key,
                "element %ld (%s) turns inside out: its Jacobian falls to %.2g of the mean; move its nodes, "
                "or mesh with straight edges",
                m->element_id[e], pg_element_types[m->kind[e]].name, least);
            PG_TRY (pg_scene_verdict (scene));
        }
        pg_mesh_body_nodes (m, e, x);
        double quality = scaled_jacobian ((pg_element) m->kind[e], m->dim, x),
               size = pow (b->volume[e], 1.0 / m->dim);
        if (quality < b->quality) b->quality = quality, b->worst = e;
        b->smallest = fmin (b->smallest, size), b->largest = fmax (b->largest, size);
    }
done:
    return status;
}

/* Reports a mesh too far from the origin, whose size is lost in rounding (pg_body_read does so for
 * shapes). */
static pg_status check_place (const pg_mesh *m, const pg_scene *scene, const char *key)
{
    for (int k = 0; k < m->dim; k++) {
        double low = INFINITY, high = -INFINITY;
        for (size_t i = 0; i < m->nnode; i++)
            low = fmin (low, m->x[3 * i + (size_t) k]), high = fmax (high, m->x[3 * i + (size_t) k]);
        double far = fmax (fabs (low), fabs (high));
        if (high - low > 1e-9 * far) continue;
        pg_scene_fault (scene, key,
                        "lies %.3g m away from the origin along %c and is %.3g m wide: its size is lost in "
                        "rounding; move it nearer",
                        far, "xyz"[k], high - low);
        break;
    }
    return pg_scene_verdict (scene);
}

/* Reads a mesh and checks it. Positions are in m from the call of `scale` on; blocks that are not in use are
 * not checked. */
pg_status mesh_body_at (pg_mesh_body *out, const pg_scene *scene, const char *at)
{
    pg_status status = PG_OK;
    char key[128];
    memset (out, 0, sizeof *out);
    snprintf (key, sizeof key, "%.100s.file", at);
    PG_TRY (read_file (out, scene, at));
    PG_TRY (scale (out, scene, at));
    PG_TRY (keep_blocks (&out->mesh, scene, at));
    PG_TRY (check_place (&out->mesh, scene, key));
    PG_TRY (check_elements (out, scene, key));
done:
    if (status != PG_OK) pg_mesh_body_clear (out);
    return status;
}

/* Reads the mesh of key `mesh`; a shape may be a mesh too (shape_mesh.c). */
pg_status pg_mesh_body_read (pg_mesh_body *out, const pg_scene *scene)
{
    return mesh_body_at (out, scene, "mesh");
}

/* Frees what the body holds and zeroes it, also one that was read in part only. */
void pg_mesh_body_clear (pg_mesh_body *body)
{
    pg_mesh_clear (&body->mesh);
    pg_free (body->volume), pg_free (body->point);
    memset (body, 0, sizeof *body);
}

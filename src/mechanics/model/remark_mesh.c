/* SPDX-License-Identifier: GPL-3.0-or-later
 * Remarks on meshes and graded points: hanging nodes (on faces of other elements); lengths in units of the
 * mean spacing where the local one was perhaps meant; interfaces of materials. */
#include "model.h"
#include "perigal/vector.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Relative tolerance (of the size of a face) for rounding of coordinates in files. */
static const double rounding = 1e-5;

/* A node of the surface, and its coordinate along a direction parallel to no face of usual meshes. */
typedef struct { double along; int node; } spot;

static double along (const double *x) { return x[0] + 0.6180339887 * x[1] + 0.3819660113 * x[2]; }

static int by_place (const void *p, const void *q)
{
    const spot *a = p, *b = q;
    return a->along != b->along ? (a->along < b->along ? -1 : 1) : (a->node > b->node) - (a->node < b->node);
}

/* Returns 1: x lies on the segment a - b, away from its ends. */
static int on_segment (const double *x, const double *a, const double *b)
{
    double length = pg_distance (3, a, b), to_a = pg_distance (3, x, a), to_b = pg_distance (3, x, b);
    return fmin (to_a, to_b) > rounding * length && to_a + to_b < length * (1 + rounding * rounding);
}

/* Returns 1: x lies in the triangle a b c, its edges included. */
static int in_triangle (const double *x, const double *a, const double *b, const double *c)
{
    double u[3], v[3], w[3], uu = 0, uv = 0, vv = 0, uw = 0, vw = 0, off = 0;
    for (int k = 0; k < 3; k++) {
        u[k] = b[k] - a[k], v[k] = c[k] - a[k], w[k] = x[k] - a[k];
        uu += u[k] * u[k], uv += u[k] * v[k], vv += v[k] * v[k], uw += u[k] * w[k], vw += v[k] * w[k];
    }
    double det = uu * vv - uv * uv;
    if (!(det > 0)) return 0;
    double s = (uw * vv - vw * uv) / det, t = (vw * uu - uw * uv) / det;
    for (int k = 0; k < 3; k++) off += pow (w[k] - s * u[k] - t * v[k], 2);
    return s >= -rounding && t >= -rounding && s + t <= 1 + rounding
           && off <= rounding * rounding * (uu + vv);
}

/* Nodes of face f of element e, its corners first, as nodes of the mesh; *nodes: how many. Returns how many
 * of them are corners. */
static int corners_of (const pg_mesh *m, int e, int f, int corner[9], int *nodes)
{
    int local[9];
    pg_element face = pg_element_face ((pg_element) m->kind[e], f, local);
    const int *node = m->node + m->start[e];
    *nodes = pg_element_types[face].nodes;
    for (int k = 0; k < *nodes; k++) corner[k] = node[local[k]];
    return pg_element_types[face].corners;
}

/* Returns 1: the node lies on the face with these nodes (the first n are corners) and is none of its corners.
 * A curved face is represented by its middle nodes and the plane or line of its corners. */
static int hangs (const pg_mesh *m, const int *corner, int n, int nodes, int node)
{
    const double *x = m->x + 3 * (size_t) node, *c[4] = { x, x, x, x };
    double size = 0;
    for (int k = 0; k < n; k++) c[k] = m->x + 3 * (size_t) corner[k];
    for (int k = 1; k < n; k++) size = fmax (size, pg_distance (3, c[0], c[k]));
    /* duplicate nodes of unconnected elements coincide with corners */
    for (int k = 0; k < n; k++) if (pg_distance (3, x, c[k]) <= rounding * size) return 0;
    for (int k = n; k < nodes; k++)
        if (pg_distance (3, x, m->x + 3 * (size_t) corner[k]) <= rounding * size) return 1;
    if (n == 2) return on_segment (x, c[0], c[1]);
    return in_triangle (x, c[0], c[1], c[2]) || (n == 4 && in_triangle (x, c[0], c[2], c[3]));
}

/* Lists the corner nodes of the n surface faces, each once, sorted by the coordinate `along`. */
static pg_status sort_corners (const pg_mesh *m, size_t n, const int *element, const int *side, size_t *nspot,
                               spot **out)
{
    pg_status status = PG_OK;
    unsigned char *on = NULL;
    size_t k = 0;
    PG_ALLOC (on, m->nnode);
    for (size_t f = 0; f < n; f++) {
        int corner[9], nodes, corners = corners_of (m, element[f], side[f], corner, &nodes);
        for (int i = 0; i < corners; i++) k += !on[corner[i]], on[corner[i]] = 1;
    }
    *nspot = k, k = 0;
    PG_ALLOC (*out, *nspot);
    for (size_t i = 0; i < m->nnode; i++) if (on[i]) (*out)[k++] = (spot) { along (m->x + 3*i), (int) i };
    pg_sort (*out, *nspot, sizeof **out, by_place);
done:
    pg_free (on);
    return status;
}

/* Index of the first spot whose coordinate is at least `place` (bisection). */
static size_t first_from (const spot *all, size_t n, double place)
{
    size_t low = 0;
    while (n > 0) {
        size_t half = n / 2;
        if (all[low + half].along < place) low += half + 1, n -= half + 1;
        else n = half;
    }
    return low;
}

/* Marks hanging nodes (nnode): corners of surface faces that lie on another surface face without being its
 * corner, where unconnected elements meet and both faces count as surface. */
static pg_status find_hanging (const pg_mesh *m, unsigned char *hanging)
{
    pg_status status = PG_OK;
    size_t n = 0, nspot = 0;
    int *element = NULL, *side = NULL;
    spot *all = NULL;
    PG_TRY (pg_mesh_surface (m, &n, &element, &side));
    PG_TRY (sort_corners (m, n, element, side, &nspot, &all));
    for (size_t f = 0; f < n; f++) {
        int corner[9], nodes, corners = corners_of (m, element[f], side[f], corner, &nodes);
        double low = INFINITY, high = -INFINITY;
        for (int k = 0; k < nodes; k++) {
            double s = along (m->x + 3 * (size_t) corner[k]);
            low = fmin (low, s), high = fmax (high, s);
        }
        double slack = rounding * (high - low);
        for (size_t k = first_from (all, nspot, low - slack); k < nspot && all[k].along <= high + slack; k++)
            if (!hanging[all[k].node] && hangs (m, corner, corners, nodes, all[k].node))
                hanging[all[k].node] = 1;
    }
done:
    pg_free (element), pg_free (side), pg_free (all);
    return status;
}

pg_status pg_remark_hanging (pg_problem *p)
{
    pg_status status = PG_OK;
    const pg_mesh *m = &p->part.mesh;
    unsigned char *hanging = NULL;
    size_t n = 0, first = 0;
    char place[80];
    if (m->n == 0 || m->dim < 2) return PG_OK;
    PG_ALLOC (hanging, m->nnode);
    PG_TRY (find_hanging (m, hanging));
    for (size_t k = m->nnode; k-- > 0; ) if (hanging[k]) n++, first = k;
    if (n == 0) goto done;
    const double *x = m->x + 3 * first;
    snprintf (place, sizeof place, p->dim == 3 ? "%.4g, %.4g, %.4g" : "%.4g, %.4g", x[0], x[1], x[2]);
    pg_problem_note (p,
                     PG_WARNING "%zu node%s of the mesh, node %ld at (%s) m first, hang%s on faces of larger "
                                "elements or of another part: these faces count as surface inside the body, "
                                "where fields are off, and the patch test does not see it; join the elements "
                                "node to node",
                     n, n > 1 ? "s" : "", m->node_id[first], place, n > 1 ? "" : "s");
done:
    pg_free (hanging);
    return status;
}

/* Warns of a mesh with plane strain elements in a plane stress scene. */
void pg_remark_plane (pg_problem *p)
{
    const pg_mesh *m = &p->part.mesh;
    if (m->n == 0 || m->dim != 2 || !*m->plane_strain || p->mode != PG_PLANE_STRESS) return;
    pg_problem_note (p,
                     PG_WARNING "elements %s of the mesh are meant for plane strain, and the scene has "
                                "plane: stress, which is softer: give plane: strain unless the body is a "
                                "thin plate",
                     m->plane_strain);
}

/* Returns 1: a length is given as a multiple of the spacing. */
static int in_spacings (const pg_scene *scene, const char *path)
{
    return pg_scene_length (scene, 1, "%s", path) < 0.99 * pg_scene_length (scene, 2, "%s", path);
}

static void remark_key (pg_problem *p, const pg_scene *scene, const char *path, double least, double most)
{
    char line[32] = "";
    if (!pg_scene_has (scene, "%s", path) || !in_spacings (scene, path)) return;
    if (pg_scene_line (scene, "%s", path))
        snprintf (line, sizeof line, "line %d: ", pg_scene_line (scene, "%s", path));
    else if (!pg_scene_given (scene, "%s", path)) snprintf (line, sizeof line, "default: ");
    pg_problem_note (p,
                     PG_WARNING "%s%s = %.4g spacing counts the mean, %.4g m, and the points are %.4g to "
                                "%.4g m apart: give a length in m, mm ...",
                     line, path, pg_scene_length (scene, 1, "%s", path), p->cloud.h, least, most);
}

void pg_remark_graded (pg_problem *p, const pg_scene *scene)
{
    double least = INFINITY, most = 0;
    char path[64];
    for (size_t i = 0; p->cloud.size && i < p->cloud.n; i++)
        least = fmin (least, p->cloud.size[i]), most = fmax (most, p->cloud.size[i]);
    /* a ratio of 1.5 exceeds the accidental variation in meshes of triangles */
    if (!(most > 1.5 * least)) return;
    if (pg_problem_by_facets (p, scene)) remark_key (p, scene, "solver.facet", least, most);
    if (p->dim == 2 && pg_scene_given (scene, "method.tip_offset"))
        remark_key (p, scene, "method.tip_offset", least, most);
    for (size_t i = 0; i < pg_scene_count (scene, "boundary"); i++) {
        snprintf (path, sizeof path, "boundary[%zu].depth", i);
        if (pg_scene_given (scene, "%s", path)) remark_key (p, scene, path, least, most);
    }
}

/* Notes interfaces between different materials, at which smooth shape functions and bonds cannot represent
 * the jump of the gradient. */
void pg_remark_interfaces (pg_problem *p)
{
    size_t used = 0, last = 0;
    int differ = 0;
    for (size_t m = 0; m < p->nmaterial; m++) {
        size_t i = 0;
        while (i < p->cloud.n && p->block[PG_NODES][i] != (int) m) i++;
        if (i == p->cloud.n) continue;
        differ |= used && memcmp (p->material[m].D, p->material[last].D, sizeof p->material->D) != 0;
        used++, last = m;
    }
    if (differ)
        pg_problem_note (p, "at interfaces of materials the error falls with the first power of the spacing, "
                         "whatever the basis: refine there");
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * A field at the points of a body that came from a mesh, drawn on its elements.
 *
 * All corners of elements are points of the body. The middle nodes of quadratic elements may
 * not be: their value is interpolated from the corners by the linear shape functions. */
#include "picture_private.h"

int pg_picture_on_elements (const pg_mesh_body *body, const pg_picture_style *style)
{
    int cracked = style->cracks && style->cracks->n,
        part = style->section || style->select || style->by_depth || style->view == PG_VIEW_CRACK;
    return body && body->mesh.n && body->point && body->mesh.dim > 1 && !cracked && !part;
}

/* The kind of linear element that has the same corners as an element of this kind. */
static pg_element straight (pg_element kind)
{
    static const pg_element same[4][9] = { [1] = { [2] = PG_BAR2 },
                                           [2] = { [3] = PG_TRI3, [4] = PG_QUAD4 },
                                           [3] = { [4] = PG_TET4, [5] = PG_PYRAMID5, [6] = PG_WEDGE6,
                                                   [8] = PG_HEX8 } };
    return same[pg_element_types[kind].dim][pg_element_types[kind].corners];
}

/* Copies m values per point to m values per node (nnode x m). A node that is no point gets its
 * value by interpolation between the corners of its element; elements that share it agree,
 * because along the shared side the interpolation involves the corners of that side only. */
static void to_nodes (const pg_mesh_body *body, size_t m, const double *point, double *node)
{
    const pg_mesh *mesh = &body->mesh;
    for (size_t i = 0; i < mesh->nnode; i++)
        for (size_t c = 0; c < m && body->point[i] >= 0; c++)
            node[i * m + c] = point[(size_t) body->point[i] * m + c];
    for (size_t e = 0; e < mesh->n; e++) {
        pg_element kind = (pg_element) mesh->kind[e], corners = straight (kind);
        const int *at = mesh->node + mesh->start[e];
        for (int k = pg_element_types[kind].corners; k < pg_element_types[kind].nodes; k++) {
            double xi[3], N[PG_ELEMENT_NODES];
            if (body->point[at[k]] >= 0) continue;
            pg_element_node (kind, k, xi);
            pg_element_shape (corners, xi, N, NULL);
            for (size_t c = 0; c < m; c++) {
                double *v = node + (size_t) at[k] * m + c;
                *v = 0;
                for (int i = 0; i < pg_element_types[kind].corners; i++)
                    *v += N[i] * node[(size_t) at[i] * m + c];
            }
        }
    }
}

pg_status pg_picture_body (const char *path, const pg_mesh_body *body, const pg_cloud *cloud,
                           const double *value, const pg_picture_style *style)
{
    pg_status status = PG_OK;
    double *v = NULL, *u = NULL;
    pg_picture_style here = *style;
    if (!pg_picture_on_elements (body, style)) return pg_picture_field (path, cloud, value, style);
    PG_ALLOC (v, body->mesh.nnode);
    to_nodes (body, 1, value, v);
    if (style->u && style->magnify != 0) {
        PG_ALLOC (u, body->mesh.nnode * (size_t) body->mesh.dim);
        to_nodes (body, (size_t) body->mesh.dim, style->u, u);
    }
    here.u = u, here.length = 1;
    PG_TRY (pg_picture_mesh (path, &body->mesh, v, &here));
done:
    pg_free (v), pg_free (u);
    return status;
}

/* A picture of one state is drawn as a single panel. */
pg_status pg_picture_field (const char *path, const pg_cloud *cloud, const double *value,
                            const pg_picture_style *style)
{
    pg_panel panel = { NULL, value, style->u, style->select, style->damage, NULL };
    return pg_picture_panels (path, cloud, 1, &panel, 1, style);
}

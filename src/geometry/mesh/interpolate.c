/* SPDX-License-Identifier: GPL-3.0-or-later
 * Interpolates fields given at the nodes of a mesh within its elements: sum N_i value_i, and the gradient.
 * Gradients jump between elements, as those of finite elements do. */
#include "element.h"
#include <math.h>
#include <string.h>

/* Components of one node are adjacent in memory. */
void pg_mesh_value (const pg_mesh *mesh, const pg_mesh_field *field, size_t element, const double *xi,
                    double *out)
{
    double N[PG_ELEMENT_NODES];
    size_t n = (size_t) field->components, first = mesh->start[element];
    pg_element_shape ((pg_element) mesh->kind[element], xi, N, NULL);
    memset (out, 0, n * sizeof *out);
    for (size_t k = first; k < mesh->start[element + 1]; k++)
        for (size_t c = 0; c < n; c++) out[c] += N[k - first] * field->value[(size_t) mesh->node[k] * n + c];
}

/* Inverse of J (dim x dim, enlarged to 3 x 3 by ones) by cofactors; returns its determinant. */
static double invert (int dim, double J[3][3], double inverse[3][3])
{
    for (int a = dim; a < 3; a++) for (int b = 0; b < 3; b++) J[a][b] = J[b][a] = a == b;
    double det = 0;
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) {
            int p = (a + 1) % 3, q = (a + 2) % 3, r = (b + 1) % 3, s = (b + 2) % 3;
            inverse[b][a] = J[p][r] * J[q][s] - J[p][s] * J[q][r];
        }
    for (int b = 0; b < 3; b++) det += J[0][b] * inverse[b][0];
    for (int k = 0; k < 9; k++) inverse[k / 3][k % 3] /= det;
    return det;
}

/* dN/dx = dN/dxi J^-1, summed with the values at the nodes. */
int pg_mesh_gradient (const pg_mesh *mesh, const pg_mesh_field *field, size_t element, const double *xi,
                      double *out)
{
    double N[PG_ELEMENT_NODES], dN[3 * PG_ELEMENT_NODES], J[3][3] = { { 0 } }, inverse[3][3];
    size_t n = (size_t) field->components, first = mesh->start[element], dim = (size_t) mesh->dim;
    pg_element_shape ((pg_element) mesh->kind[element], xi, N, dN);
    for (size_t k = first; k < mesh->start[element + 1]; k++)
        for (size_t a = 0; a < dim; a++)
            for (size_t b = 0; b < dim; b++)
                J[a][b] += dN[(k - first) * dim + b] * mesh->x[3 * (size_t) mesh->node[k] + a];
    memset (out, 0, n * dim * sizeof *out);
    if (!(invert (mesh->dim, J, inverse) > 0)) return 0;
    for (size_t k = first; k < mesh->start[element + 1]; k++)
        for (size_t a = 0; a < dim; a++) {
            double slope = 0;
            for (size_t b = 0; b < dim; b++) slope += dN[(k - first) * dim + b] * inverse[b][a];
            for (size_t c = 0; c < n; c++)
                out[c * dim + a] += slope * field->value[(size_t) mesh->node[k] * n + c];
        }
    return 1;
}

/* Releases n fields and their list. */
void pg_mesh_fields_clear (size_t n, pg_mesh_field **fields)
{
    if (!fields || !*fields) return;
    for (size_t k = 0; k < n; k++) pg_free ((*fields)[k].value);
    pg_free (*fields);
    *fields = NULL;
}

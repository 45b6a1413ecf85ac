/* SPDX-License-Identifier: GPL-3.0-or-later
 * A finite element result measured against the reference of a scene, by the same norms as our
 * own results, but over its own elements: at Gauss points of each element, with stresses from
 * the gradient of its displacement. */
#include "compare.h"
#include <math.h>
#include <string.h>

/* The rule of each element on its reference element times the size of its map at the point;
 * fabs because some programs number the nodes of plane elements clockwise. */
pg_status pg_mesh_quadrature (pg_quadrature *out, const pg_mesh *mesh, double thickness, int order)
{
    pg_status status = PG_OK;
    size_t dim = (size_t) mesh->dim, n = 0;
    double xi[3 * PG_ELEMENT_POINTS], weight[PG_ELEMENT_POINTS], x[3 * PG_ELEMENT_NODES];
    memset (out, 0, sizeof *out);
    for (size_t e = 0; e < mesh->n; e++)
        n += (size_t) pg_element_rule ((pg_element) mesh->kind[e], order, xi, weight);
    PG_ALLOC (out->x, n * dim);
    PG_ALLOC (out->weight, n);
    PG_ALLOC (out->cell, n);
    for (size_t e = 0; e < mesh->n; e++) {
        size_t nodes = mesh->start[e + 1] - mesh->start[e];
        int points = pg_element_rule ((pg_element) mesh->kind[e], order, xi, weight);
        for (size_t a = 0; a < nodes; a++)
            for (size_t k = 0; k < dim; k++)
                x[a * dim + k] = mesh->x[3 * (size_t) mesh->node[mesh->start[e] + a] + k];
        for (int q = 0; q < points; q++, out->n++) {
            double size = pg_element_map ((pg_element) mesh->kind[e], mesh->dim, x, xi + (size_t) q * dim,
                                          out->x + out->n * dim, NULL);
            out->weight[out->n] = weight[q] * fabs (size) * (mesh->dim == 3 ? 1 : thickness);
            out->cell[out->n] = (int) e;
        }
    }
done:
    if (status != PG_OK) pg_quadrature_clear (out);
    return status;
}

/* Measures the finite elements against the closed forms at quadrature points of the elements, so that no
 * error of an interpolation between two discretizations enters. */
pg_status pg_errors_mesh (pg_errors *out, const pg_reference *reference, const pg_problem *problem,
                          const char *path, int step, double unit, double t)
{
    pg_status status = PG_OK;
    pg_sampler value = { 0 }, field = { 0 };
    pg_quadrature q = { 0 };
    int *which = NULL;
    double start = pg_seconds ();
    memset (out, 0, sizeof *out);
    PG_TRY (pg_sampler_mesh (&value, path, step, unit, problem));
    PG_TRY (pg_reference_sampler (&field, reference, t));
    PG_TRY (pg_mesh_quadrature (&q, pg_sampler_mesh_of (&value, NULL, NULL), problem->cloud.thickness, 5));
    PG_TRY (pg_compare_materials (problem, &q, &which));
    pg_norm_options options = { problem->at.law, which, reference->where };
    PG_TRY (pg_norms_measure (&out->norms, &q, &value, &field, &options));
    out->order = 5, out->seconds = pg_seconds () - start;
done:
    pg_quadrature_clear (&q);
    pg_sampler_clear (&field);
    pg_sampler_clear (&value);
    pg_free (which);
    return status;
}

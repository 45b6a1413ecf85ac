/* SPDX-License-Identifier: GPL-3.0-or-later
 * A finite element result as a sampler: displacement by the shape functions of its elements,
 * stress from their gradients and the materials of the scene, so that both sides of a
 * comparison have the same elastic law. Stresses in the file are not used, since they are
 * often averaged at nodes. */
#include "compare.h"
#include "perigal/mesh_files.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* A point outside the mesh takes the value of the nearest element up to this distance: the surfaces of two
 * discretizations of one curved body differ by a little. */
#define FARTHEST 0.25  /* in element sizes */

/* A finite element result and what is needed to sample it. */
typedef struct {
    /* Coordinates in m. */
    pg_mesh mesh;
    /* Displacement at its nodes, m (nnode x dim). */
    pg_mesh_field u;
    pg_mesh_locator *locator;
    const pg_problem *problem;
    /* Search for the nearest evaluation point of the problem, whose material counts; NULL: one material. */
    pg_nearest *material;
    /* Number of sampled points outside the mesh by more than 1e-6 element sizes, and the largest distance
     * among them, in element sizes. */
    size_t  outside;  double away;
} fem;

/* Frees the sampler's context; NULL is allowed. */
static void free_fem (void *context)
{
    fem *f = context;
    if (!f) return;
    pg_nearest_free (&f->material);
    pg_mesh_locator_free (&f->locator);
    pg_mesh_clear (&f->mesh);
    pg_free (f->u.value);
    pg_free (f);
}

/* The elastic law at a place. */
static const pg_material *law_at (const fem *f, const double *x)
{
    const pg_problem *p = f->problem;
    if (!f->material) return &p->at.law[0];
    return pg_problem_law (p, p->form.integration->at_nodes ? PG_NODES : PG_POINTS,
                           (size_t) pg_nearest_find (f->material, x, NULL, NULL));
}

/* Samples one point. Returns 1 if it lies in an element, or near enough to one; points outside are counted,
 * and callers report them: many of them mean that the two bodies differ. */
static int sample_place (fem *f, const double *x, double *u, double *stress)
{
    double xi[3], away = 0, H[9];
    long e = pg_mesh_locator_find (f->locator, x, xi, &away);
    if (e < 0 || away > FARTHEST) return 0;
    if (stress && !pg_mesh_gradient (&f->mesh, &f->u, (size_t) e, xi, H)) return 0;
    pg_mesh_value (&f->mesh, &f->u, (size_t) e, xi, u);
    if (away > 1e-6) f->outside++, f->away = fmax (f->away, away);
    if (stress) pg_stress_of_gradient (law_at (f, x), f->mesh.dim, H, stress);
    return 1;
}

/* Samples n points; values are NAN where no element is near enough. */
static pg_status sample_fem (void *context, size_t n, const double *x, double *u, double *stress)
{
    fem *f = context;
    size_t dim = (size_t) f->mesh.dim;
    for (size_t i = 0; i < n; i++) {
        u[3*i + 1] = u[3*i + 2] = 0;
        if (sample_place (f, x + i * dim, u + 3*i, stress ? stress + 6*i : NULL)) continue;
        for (size_t k = 0; k < 3; k++) u[3*i + k] = k < dim ? NAN : 0;
        for (size_t k = 0; stress && k < 6; k++) stress[6*i + k] = NAN;
    }
    return PG_OK;
}

/* Reads mesh and displacements of a step and scales both to m; results on one layer of 3D elements become 2D.
 * PG_E_FILE if there is no displacement or the dimension is another one. */
static pg_status read_fields (fem *f, const char *path, int step, double unit)
{
    pg_status status = PG_OK;
    pg_mesh_field *fields = NULL, *u = NULL;
    size_t n = 0, dim = (size_t) f->problem->dim;
    double time;
    PG_TRY (pg_mesh_result (&f->mesh, path, step, &n, &fields, &time));
    if (f->mesh.dim == 3 && dim == 2) PG_TRY (pg_mesh_flatten (&f->mesh, n, fields));
    if ((size_t) f->mesh.dim != dim)
        PG_FAIL (PG_E_FILE, "%s is of a %dD body, the result of a %zuD one", path, f->mesh.dim, dim);
    for (size_t k = 0; k < n; k++) if (strcmp (fields[k].name, "displacement") == 0) u = &fields[k];
    if (!u || u->components < (int) dim)
        PG_FAIL (
            PG_E_FILE,
            "%s has no displacement: ask for U in its *NODE FILE, or a nodal variable displacement_x ...",
            path);
    f->u = (pg_mesh_field) { .name = "displacement", .components = (int) dim };
    PG_ALLOC (f->u.value, f->mesh.nnode * dim);
    for (size_t i = 0; i < f->mesh.nnode; i++)
        for (size_t c = 0; c < dim; c++)
            f->u.value[i * dim + c] = unit * u->value[i * (size_t) u->components + c];
    for (size_t i = 0; i < 3 * f->mesh.nnode; i++) f->mesh.x[i] *= unit;
done:
    pg_mesh_fields_clear (n, &fields);
    return status;
}

/* Makes a sampler of a finite element result. All components count as known; values at single points may be
 * NAN. */
pg_status pg_sampler_mesh (pg_sampler *out, const char *path, int step, double unit,
                           const pg_problem *problem)
{
    pg_status status = PG_OK;
    fem *f = NULL;
    int bulk = problem->form.integration->at_nodes ? PG_NODES : PG_POINTS;
    memset (out, 0, sizeof *out);
    PG_ALLOC (f, 1);
    f->problem = problem;
    PG_TRY (read_fields (f, path, step, unit));
    PG_TRY (pg_mesh_locator_create (&f->locator, &f->mesh));
    if (problem->at.nlaw > 1)
        PG_TRY (pg_nearest_create (&f->material, problem->dim, problem->bonds.rows[bulk].n,
                                   problem->bonds.rows[bulk].x));
    *out = (pg_sampler){ f,
                         problem->dim,
                         (1 << problem->dim) - 1,
                         problem->dim == 1 ? 1 : problem->dim == 2 ? 15 : 63,
                         sample_fem,
                         free_fem };
    f = NULL;
done:
    free_fem (f);
    return status;
}

/* Returns the mesh of a sampler, NULL if it has none: samplers of meshes are recognized by their function. */
const pg_mesh *pg_sampler_mesh_of (const pg_sampler *sampler, size_t *outside, double *away)
{
    const fem *f = sampler->sample == sample_fem ? sampler->context : NULL;
    if (outside) *outside = f ? f->outside : 0;
    if (away) *away = f ? f->away : 0;
    return f ? &f->mesh : NULL;
}

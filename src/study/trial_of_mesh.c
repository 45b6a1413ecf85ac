/* SPDX-License-Identifier: GPL-3.0-or-later
 * A finite element result measured against the reference of a scene by the same norms as our
 * own results: over its own elements (5 Gauss points per direction) with stresses from the
 * gradient of its displacement, and on the lines of the reference. */
#include "trial.h"
#include "perigal/mesh_files.h"
#include <math.h>
#include <string.h>

enum { ORDER = 5 };
/* A finite element result as a sampler. */
typedef struct {
    const pg_mesh *mesh;
    pg_mesh_locator *locator;
    /* Displacement, in units of the file. */
    const pg_mesh_field *u;
    int    dim;
    /* Metres in a length unit of the file. */
    double unit;
    const pg_material *material;
} solution;

/* Samples the result; places more than half an element outside are unknown. */
static pg_status sample (void *context, size_t n, const double *x, double *u, double *stress)
{
    const solution *s = context;
    for (size_t i = 0; i < n; i++) {
        double place[3] = { 0 }, xi[3], away, v[9], H[9];
        for (int k = 0; k < s->dim; k++) place[k] = x[i * (size_t) s->dim + (size_t) k] / s->unit;
        long e = pg_mesh_locator_find (s->locator, place, xi, &away);
        int known = e >= 0 && away < 0.5 && pg_mesh_gradient (s->mesh, s->u, (size_t) e, xi, H);
        if (known) pg_mesh_value (s->mesh, s->u, (size_t) e, xi, v);
        if (known && stress) pg_stress_of_gradient (s->material, s->dim, H, stress + 6*i);
        for (int k = 0; k < 3; k++) u[3*i + (size_t) k] = !known ? NAN : k < s->dim ? v[k] * s->unit : 0;
        for (int k = 0; stress && !known && k < 6; k++) stress[6*i + (size_t) k] = NAN;
    }
    return PG_OK;
}

/* Gauss points of all elements with their weights, m and m3 (plane elements times the
 * thickness); fabs because some programs number nodes clockwise. */
static pg_status places_of (pg_quadrature *q, const solution *s, double thickness)
{
    pg_status status = PG_OK;
    size_t dim = (size_t) s->dim;
    const pg_mesh *m = s->mesh;
    PG_ALLOC (q->x, m->n * PG_ELEMENT_POINTS * dim);
    PG_ALLOC (q->weight, m->n * PG_ELEMENT_POINTS);
    for (size_t e = 0; e < m->n; e++) {
        double xi[3 * PG_ELEMENT_POINTS], w[PG_ELEMENT_POINTS], x[3 * PG_ELEMENT_NODES], place[3];
        for (size_t i = 0; i < m->start[e + 1] - m->start[e]; i++)
            for (size_t k = 0; k < dim; k++)
                x[i * dim + k] = m->x[3 * (size_t) m->node[m->start[e] + i] + k] * s->unit;
        int n = pg_element_rule (m->kind[e], ORDER, xi, w);
        for (int g = 0; g < n; g++) {
            q->weight[q->n] = w[g] * thickness
                              * fabs (
                                  pg_element_map (m->kind[e], s->dim, x, xi + (size_t) g * dim, place, NULL));
            memcpy (q->x + dim * q->n++, place, dim * sizeof *place);
        }
    }
done:
    return status;
}

/* First the tables, by the norms over the cells of the scene, which are then replaced by those
 * over the result's own elements. Expressions are taken at t = 1, the full load. */
static pg_status measure (pg_trial *t, solution *s, const pg_scene *scene, const pg_problem *problem)
{
    pg_status status = PG_OK;
    pg_reference *reference = NULL;
    pg_sampler exact = { 0 }, value = {
        .context = s, .dim = s->dim, .displacement = (1 << s->dim) - 1, .stress = 63, .sample = sample
    };
    pg_quadrature q = { 0 };
    pg_errors e = { 0 };
    pg_norm_options options = { .material = problem->material };
    PG_TRY (pg_reference_read (&reference, scene, problem));
    PG_TRY (pg_scene_verdict (scene));
    if (!reference) PG_FAIL (PG_E_SCENE, "%s: the scene has no reference", pg_scene_file (scene));
    /* lines; the norms are those over its own elements */
    PG_TRY (pg_errors_measure (&e, reference, problem, &value, 1));
    PG_TRY (pg_reference_sampler (&exact, reference, 1));
    if (exact.displacement) {
        PG_TRY (places_of (&q, s, problem->dim == 2 ? problem->cloud.thickness : 1));
        PG_TRY (pg_norms_measure (&e.norms, &q, &value, &exact, &options));
    }
    pg_trial_take (t, &e);
done:
    pg_quadrature_clear (&q);
    pg_sampler_clear (&exact);
    pg_errors_clear (&e);
    pg_reference_free (&reference);
    return status;
}

/* Reads the last step, makes 3D elements of a plane result plane, and prepares the search.
 * PG_E_FILE without a displacement or with another dimension. */
static pg_status read_solution (solution *s, pg_mesh *mesh, size_t *nfield, pg_mesh_field **fields,
                                const char *path, const pg_problem *p)
{
    pg_status status = PG_OK;
    double time;
    PG_TRY (pg_mesh_result (mesh, path, -1, nfield, fields, &time));
    for (size_t k = 0; k < *nfield; k++)
        if (strcmp ((*fields)[k].name, "displacement") == 0) s->u = &(*fields)[k];
    if (!s->u || s->u->components < p->dim) PG_FAIL (PG_E_FILE, "%s has no displacement", path);
    if (p->dim == 2 && mesh->dim == 3) PG_TRY (pg_mesh_flatten (mesh, *nfield, *fields));
    if (mesh->dim != p->dim)
        PG_FAIL (PG_E_FILE, "%s: the elements are of dimension %d, the scene of %d", path, mesh->dim, p->dim);
    s->mesh = mesh, s->dim = p->dim, s->material = p->material;
    PG_TRY (pg_mesh_locator_create (&s->locator, mesh));
done:
    return status;
}

/* The problem of the scene is built for its dimension, its material and its reference only. */
pg_status pg_trial_of_mesh (pg_trial *t, const pg_scene *scene, const char *path, double unit)
{
    pg_status status = PG_OK;
    pg_problem *problem = NULL;
    pg_mesh mesh = { 0 };
    pg_mesh_field *fields = NULL;
    size_t nfield = 0;
    solution s = { .unit = unit };
    pg_trial_read (t, "");
    PG_TRY (pg_problem_build (&problem, scene, 1));
    PG_TRY (read_solution (&s, &mesh, &nfield, &fields, path, problem));
    PG_TRY (measure (t, &s, scene, problem));
    t->value[PG_TRIAL_POINTS] = (double) mesh.nnode;
    t->value[PG_TRIAL_DOFS] = (double) mesh.nnode * problem->dim;
done:
    pg_mesh_locator_free (&s.locator);
    pg_mesh_fields_clear (nfield, &fields);
    pg_mesh_clear (&mesh);
    pg_problem_free (&problem);
    return status;
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * A finite element result measured against the reference of a scene by the norms that are used for our own
 * results: the closed forms over its own elements (pg_errors_mesh), so that no interpolation between two
 * discretisations enters, tables at their own positions. Materials, the condition `reference.where` and the
 * sampling of the result are those of every other comparison (compare.h). */
#include "trial.h"

/* Measures the norms against the closed forms; none if the reference has tables only. Expressions are taken
 * at t = 1, the full load. */
static pg_status measure_norms (pg_norms *out, const pg_reference *reference, const pg_problem *problem,
                                const char *path, double unit)
{
    pg_status status = PG_OK;
    pg_sampler exact = { 0 };
    pg_errors e = { 0 };
    PG_TRY (pg_reference_sampler (&exact, reference, 1));
    if (!exact.displacement && !exact.stress) goto done;
    PG_TRY (pg_errors_mesh (&e, reference, problem, path, -1, unit, 1));
    *out = e.norms;
done:
    pg_sampler_clear (&exact);
    pg_errors_clear (&e);
    return status;
}

/* Measures a finite element result. The problem of the scene is built for its dimension, materials and
 * reference only. */
pg_status pg_trial_of_mesh (pg_trial *t, const pg_scene *scene, const char *path, double unit)
{
    pg_status status = PG_OK;
    pg_problem *problem = NULL;
    pg_reference *reference = NULL;
    pg_sampler value = { 0 };
    pg_errors e = { 0 };
    pg_trial_read (t, "");
    PG_TRY (pg_problem_build (&problem, scene, 1));
    PG_TRY (pg_reference_read (&reference, scene, problem));
    PG_TRY (pg_scene_verdict (scene));
    if (!reference) PG_FAIL (PG_E_SCENE, "%s: the scene has no reference", pg_scene_file (scene));
    PG_TRY (pg_sampler_mesh (&value, path, -1, unit, problem));
    /* measures the tables; norms over cells of the scene are replaced by those over the result's own
     * elements */
    PG_TRY (pg_errors_measure (&e, reference, problem, &value, 1));
    PG_TRY (measure_norms (&e.norms, reference, problem, path, unit));
    pg_trial_take (t, &e);
    size_t nodes = pg_sampler_mesh_of (&value, NULL, NULL)->nnode;
    t->value[PG_TRIAL_POINTS] = (double) nodes;
    t->value[PG_TRIAL_DOFS] = (double) nodes * problem->dim;
done:
    pg_errors_clear (&e);
    pg_sampler_clear (&value);
    pg_reference_free (&reference);
    pg_problem_free (&problem);
    return status;
}

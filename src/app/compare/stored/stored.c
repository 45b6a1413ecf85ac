/* SPDX-License-Identifier: GPL-3.0-or-later
 * A result folder opened in order to sample it: the problem is built anew from the copy of the
 * scene, and the unknowns of one step are read from result.e. With the coefficients in the
 * file and no broken bonds the field is that of the run itself, by its own shape functions;
 * otherwise the displacements of the points are fitted, and the difference is said in `how`. */
#include "app/compare/compare.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Context of a sampler: a field that is unknown (NAN) outside the body. */
typedef struct { pg_sampler field; pg_nearest *points; const pg_problem *problem; } bounded;

/* Samples the field, and sets values to NAN more than sqrt (dim) spacings away from every point: no cell of
 * the body reaches that far. Without this, a fit would extrapolate anywhere. */
static pg_status sample_bounded (void *context, size_t n, const double *x, double *u, double *stress)
{
    pg_status status = PG_OK;
    const bounded *b = context;
    size_t dim = (size_t) b->problem->dim;
    double reach = (double) dim * b->problem->cloud.h * b->problem->cloud.h;
    PG_TRY (b->field.sample (b->field.context, n, x, u, stress));
    for (size_t i = 0; i < n; i++) {
        long j = pg_nearest_find (b->points, x + i * dim, NULL, NULL);
        double away = 0;
        for (size_t k = 0; k < dim; k++) {
            double d = x[i * dim + k] - b->problem->cloud.x[(size_t) j * dim + k];
            away += d * d;
        }
        if (away <= reach) continue;
        for (size_t k = 0; k < dim; k++) u[3*i + k] = NAN;
        for (int k = 0; stress && k < 6; k++) stress[6*i + (size_t) k] = NAN;
    }
done:
    return status;
}

static void free_bounded (void *context)
{
    bounded *b = context;
    if (!b) return;
    pg_sampler_clear (&b->field);
    pg_nearest_free (&b->points);
    pg_free (b);
}

/* Makes a sampler that limits `field` to the body, and takes ownership of it. */
static pg_status bound (pg_sampler *out, const pg_problem *problem, pg_sampler *field)
{
    pg_status status = PG_OK;
    bounded *b = NULL;
    PG_ALLOC (b, 1);
    b->problem = problem, b->field = *field;
    memset (field, 0, sizeof *field);
    PG_TRY (pg_nearest_create (&b->points, problem->dim, problem->cloud.n, problem->cloud.x));
    *out = (pg_sampler){
        b, problem->dim, b->field.displacement, b->field.stress, sample_bounded, free_bounded
    };
    b = NULL;
done:
    free_bounded (b);
    return status;
}

/* ---- fields -------------------------------------------------------------------------------------------- */
/* PG_E_FILE unless the points of result.e are those that the scene makes, to 1e-9 of the
 * spacing. Number and times of the steps are read on the way. */
static pg_status check_points (const pg_stored *s, const char *path, size_t *nstep, double **time)
{
    pg_status status = PG_OK;
    pg_cloud cloud = { 0 };
    const pg_cloud *own = &s->problem->cloud;
    PG_TRY (pg_exodus_points (path, &cloud, nstep, time));
    int same = cloud.n == own->n && cloud.dim == own->dim;
    for (size_t i = 0; same && i < own->n * (size_t) own->dim; i++)
        same = fabs (cloud.x[i] - own->x[i]) <= 1e-9 * own->h;
    if (!same)
        PG_FAIL (PG_E_FILE,
                 "%s: its points are not those that its scene makes now: files of the scene, or the program, "
                 "have changed since",
                 path);
done:
    pg_cloud_clear (&cloud);
    return status;
}

/* *found = 1 if result.e has a field of that name. */
static pg_status has_field (const char *path, const char *name, int *found)
{
    pg_status status = PG_OK;
    char (*names)[32] = NULL;
    size_t n = 0;
    *found = 0;
    PG_TRY (pg_exodus_fields (path, &names, &n));
    for (size_t k = 0; k < n; k++) *found |= strcmp (names[k], name) == 0;
done:
    pg_free (names);
    return status;
}

/* Reads a field of the step and checks the number of its components. */
static pg_status read_field (const pg_stored *s, const char *path, const char *name, int components,
                             double **value)
{
    pg_status status = PG_OK;
    size_t n;
    int found;
    PG_TRY (pg_exodus_read (path, name, s->step, &n, &found, value));
    if (n != s->problem->cloud.n || found != components)
        PG_FAIL (PG_E_FILE, "%s: field %s has %d components, expected %d", path, name, found, components);
done:
    return status;
}

/* Marks the points that have more damage now than after the pre-cracks were cut: these have
 * lost bonds during the run (*torn: n, to be freed with pg_free). Damage is the only trace of
 * broken bonds in result.e; PG_E_USAGE if the file does not have it. */
static pg_status find_torn (pg_stored *s, const char *path, unsigned char **torn)
{
    pg_status status = PG_OK;
    double *now = NULL, *first = NULL;
    const char *unit;
    int components, found;
    size_t n = s->problem->cloud.n, count = 0;
    PG_TRY (has_field (path, "damage", &found));
    if (!found)
        PG_FAIL (PG_E_USAGE,
                 "%s: bonds have broken, and it has no field damage that would say where: add damage to "
                 "output.fields and run again",
                 path);
    PG_TRY (read_field (s, path, "damage", 1, &now));
    PG_ALLOC (first, n);
    PG_ALLOC (*torn, n);
    PG_TRY (s->force->field (s->self, s->state, s->state->d, "damage", &components, &unit, first));
    for (size_t i = 0; i < n; i++) count += (*torn)[i] = now[i] > first[i] + 1e-9;
    snprintf (s->how, sizeof s->how,
              "by least squares through its points: bonds had broken; near %zu torn points the displacement "
              "of the nearest point, no stress",
              count);
done:
    pg_free (now), pg_free (first);
    return status;
}

/* Sets the unknowns of the state from fields of result.e: coefficients, and for points with rotational
 * degrees of freedom the spacing times the rotations, which is the unknown (doc/method.md, G2). */
static pg_status read_unknowns (pg_stored *s, const char *path, const char *name)
{
    pg_status status = PG_OK;
    double *part[2] = { NULL, NULL };
    const pg_problem *p = s->problem;
    size_t count[2] = { (size_t) p->dim, (size_t) pg_problem_rotations (p) }, stride = count[0] + count[1];
    PG_TRY (read_field (s, path, name, p->dim, &part[0]));
    if (count[1]) PG_TRY (read_field (s, path, "rotation", (int) count[1], &part[1]));
    for (size_t i = 0; i < p->cloud.n; i++)
        for (size_t k = 0; k < stride; k++) {
            int turn = k >= count[0];
            s->state->d[i * stride + k] = part[turn][i * count[turn] + k - (turn ? count[0] : 0)]
                                          * (turn ? p->cloud.h : 1);
        }
done:
    pg_free (part[0]), pg_free (part[1]);
    return status;
}

/* Chooses how the field of a step is sampled. With coefficients in the file (or displacements, if the
 * approximation interpolates), rotations where points have them, and no broken bonds, the field is that of
 * the run itself. After breaks its shape functions cannot be restored, as result.e does not say which bonds
 * are intact. */
static pg_status read_step (pg_stored *s, const char *path, double broken)
{
    pg_status status = PG_OK;
    double *u = NULL;
    unsigned char *torn = NULL;
    pg_sampler field = { 0 };
    int interpolates = s->problem->form.approx.type->interpolates, coefficients, displacements,
        rotations = 1;
    PG_TRY (has_field (path, "coefficient", &coefficients));
    PG_TRY (has_field (path, "displacement", &displacements));
    if (pg_problem_rotations (s->problem)) PG_TRY (has_field (path, "rotation", &rotations));
    if (broken == 0 && rotations && (coefficients || (interpolates && displacements))) {
        PG_TRY (read_unknowns (s, path, coefficients ? "coefficient" : "displacement"));
        PG_TRY (pg_sampler_solution (&field, s->problem, s->force, s->self, s->state));
        snprintf (s->how, sizeof s->how,
                  s->force->sample ? "by its own shape functions" : "by least squares through its points");
    } else {
        if (!displacements)
            PG_FAIL (PG_E_USAGE, "%s has no field displacement: add it to output.fields and run again", path);
        PG_TRY (read_field (s, path, "displacement", s->problem->dim, &u));
        snprintf (s->how, sizeof s->how, "by least squares through its points: it has no field %s",
                  rotations ? "coefficient" : "rotation");
        if (broken > 0) PG_TRY (find_torn (s, path, &torn));
        PG_TRY (pg_sampler_points (&field, s->problem, u, torn));
    }
    PG_TRY (bound (&s->sampler, s->problem, &field));
done:
    pg_sampler_clear (&field);
    pg_free (u), pg_free (torn);
    return status;
}

/* ---- folder -------------------------------------------------------------------------------------------- */
/* Finds the step and its time. In dynamic runs result.e counts time; static runs with event
 * stepping number their steps, and the load factor comes from history.csv; with fixed steps it
 * is the load factor itself. *broken is the number of broken bonds at that step. */
static pg_status find_step (pg_stored *s, const char *folder, const char *path, int step, double *broken)
{
    pg_status status = PG_OK;
    pg_solver_options o;
    size_t nstep = 0;
    double *time = NULL, factor = 0, second = 0;
    PG_TRY (pg_solver_options_read (&o, s->problem, s->scene));
    PG_TRY (check_points (s, path, &nstep, &time));
    if (nstep == 0) PG_FAIL (PG_E_FILE, "%s holds no step yet", path);
    if (step < -1 || step >= (int) nstep)
        PG_FAIL (PG_E_USAGE, "%s has no step %d; its steps are 0 to %zu", path, step, nstep - 1);
    s->step = step < 0 ? (int) nstep - 1 : step;
    s->stamp = time[s->step];
    int dynamic = !(o.flags & PG_SOLVER_QUASI_STATIC);
    PG_TRY (pg_compare_history (folder,
                             dynamic   ? "time"
                             : o.event ? "step"
                                       : "load_factor",
                             s->stamp, &factor, &second, broken));
    s->t = dynamic ? s->stamp : o.event ? factor : s->stamp;
    s->state->time = s->t, s->state->factor = factor;
done:
    pg_free (time);
    return status;
}

/* Opens a result folder. The path must leave room in the buffer for the names of the other files of the
 * folder. `refresh` gives the force the bonds that the pre-cracks leave. */
pg_status pg_stored_open (pg_stored **out, const char *folder, int step, int threads)
{
    pg_status status = PG_OK;
    pg_stored *s = NULL;
    char path[4096];
    pg_field fields[4];
    double broken = 0;
    *out = NULL;
    PG_ALLOC (s, 1);
    if ((size_t) snprintf (path, sizeof path, "%s/result.e", folder) >= sizeof path - 16)
        PG_FAIL (PG_E_USAGE, "the path is too long");
    PG_TRY (pg_exodus_join (folder, 0));               /* parts of ranks whose run has not ended */
    PG_TRY (pg_stored_scene (&s->scene, folder));
    PG_TRY (pg_problem_build (&s->problem, s->scene, threads));
    s->force = pg_force_of (s->problem);
    if (!s->force) PG_FAIL (PG_E_USAGE, "%s: this program has no force %s", folder, s->problem->method->name);
    PG_TRY (s->force->create (&s->self, s->problem));
    size_t n = s->force->fields (s->self, 4, fields);
    int components = 0;
    for (size_t k = 0; k < n && k < 4; k++) components += fields[k].components;
    PG_TRY (pg_state_create (&s->state, s->problem, components));
    if (s->force->refresh) PG_TRY (s->force->refresh (s->self, s->state, NULL));
    PG_TRY (find_step (s, folder, path, step, &broken));
    PG_TRY (read_step (s, path, broken));
    *out = s;
    s = NULL;
done:
    pg_stored_free (&s);
    return status;
}

/* Frees a stored result; the sampler first, since it borrows everything else. */
void pg_stored_free (pg_stored **stored)
{
    pg_stored *s = *stored;
    if (!s) return;
    pg_sampler_clear (&s->sampler);
    pg_state_free (&s->state);
    if (s->self) s->force->free (&s->self);
    pg_problem_free (&s->problem);
    pg_scene_free (&s->scene);
    pg_free (s);
    *stored = NULL;
}

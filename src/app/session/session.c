/* SPDX-License-Identifier: GPL-3.0-or-later
 * A scene that another program advances step by step: does what `perigal run` does, but writes no files. */
#include "session_private.h"
#include <math.h>
#include <string.h>
#include <unistd.h>

/* ---- open, close --------------------------------------------------------------------------------------- */
/* Fails if the run needs more memory than there is. Faults of the scene are reported later, when the problem
 * is built. */
static pg_status afford (const char *path, size_t nset, const char *const *set)
{
    pg_status status = PG_OK;
    pg_scene *scene = NULL;
    pg_forecast f;
    PG_TRY (pg_scene_load_with (&scene, path, nset, set));
    status = pg_forecast_scene (&f, scene, pg_force_methods ());
    if (status == PG_E_SCENE || status == PG_E_FILE) {
        status = PG_OK;
        goto done;
    }
    PG_TRY (status);
    PG_TRY (pg_forecast_afford (&f, pg_available_memory ("")));
done:
    pg_scene_free (&scene);
    return status;
}

/* Builds the problem, and reports all faults of a scene at once, as `perigal run` does. */
static pg_status build (pg_session *s, int threads)
{
    pg_status status = PG_OK;
    PG_TRY (pg_problem_prepare (&s->problem, s->scene, threads));
    status = pg_solver_options_read (&s->options, s->problem, s->scene);
    pg_scene_pass (s->scene);
    if (status == PG_OK || status == PG_E_SCENE) status = pg_result_check (s->scene, s->problem);
    pg_scene_pass (s->scene);
    if (status == PG_OK || status == PG_E_SCENE) status = pg_problem_complete (s->problem, s->scene);
    PG_TRY (status);
    PG_TRY (pg_patch_probe (s->problem));
done:
    return status;
}

/* Creates a solver and the state that it starts from. */
pg_status session_begin (const pg_session *s, pg_solver **solver, pg_state **state)
{
    pg_status status = PG_OK;
    PG_TRY (pg_solver_create (solver, s->problem, &s->options));
    PG_TRY (pg_state_create (state, s->problem, pg_solver_components (*solver)));
done:
    return status;
}

pg_status pg_session_open (pg_session **out, const char *path, size_t nset, const char *const *set,
                           int threads)
{
    pg_status status = PG_OK;
    pg_session *s = NULL;
    *out = NULL;
    if (threads < 0 || threads > 64) PG_FAIL (PG_E_USAGE, "threads: %d is not from 0 to 64", threads);
    if (threads == 0) threads = (int) sysconf (_SC_NPROCESSORS_ONLN);
    PG_ALLOC (s, 1);
    PG_TRY (pg_scene_load_with (&s->scene, path, nset, set));
    PG_TRY (afford (path, nset, set));
    PG_TRY (build (s, threads < 1 ? 1 : threads));
    PG_TRY (session_begin (s, &s->solver, &s->state));
    PG_TRY (pg_patch_refuse (s->problem, s->scene));
    s->options.scene = NULL;                           /* the scene has no faults left to report */
    *out = s;
    s = NULL;
done:
    pg_session_close (&s);
    return status;
}

/* Frees a session, also one that was made in part only; NULL is allowed. */
void pg_session_close (pg_session **session)
{
    pg_session *s = *session;
    if (!s) return;
    pg_state_free (&s->state);
    pg_solver_free (&s->solver);
    pg_problem_free (&s->problem);
    pg_scene_free (&s->scene);
    pg_free (s->field);
    pg_free (s);
    *session = NULL;
}

const pg_problem *pg_session_problem (const pg_session *s) { return s->problem; }
const pg_state   *pg_session_state   (const pg_session *s) { return s->state; }
pg_solver        *pg_session_solver  (const pg_session *s) { return s->solver; }
const double     *pg_session_places  (const pg_session *s) { return s->problem->cloud.x; }
pg_status pg_session_equations (pg_equations *out, const pg_session *s, double t)
{
    *out = (pg_equations) { 0 };
    if (pg_solver_settled (s->solver)->contact.kind != PG_CONTACT_NONE)
        return pg_error (PG_E_USAGE, PG_HERE,
                         "a scene with contact has no linear system, as contact decides which faces bear; "
                         "leave it out by the override contact={kind: none}");
    return pg_equations_create (out, s->problem, s->state, t);
}

int pg_session_done (const pg_session *s) { return pg_solver_done (s->solver, s->state); }

/* ---- steps and fields ---------------------------------------------------------------------------------- */
pg_status pg_session_step (pg_session *s, const pg_step **step)
{
    pg_status status = PG_OK;
    if (step) *step = &s->step;
    if (pg_session_done (s))
        PG_FAIL (PG_E_USAGE, "the run has come to its end after %ld steps", s->state->step);
    s->begun = 1;
    PG_TRY (pg_solver_step (s->solver, s->state, &s->step));
done:
    return status;
}

/* Returns a field at the points. Before the first step the force does not know yet which bonds are broken. */
pg_status pg_session_field (pg_session *s, const char *name, int *components, const char **unit,
                            const double **value)
{
    pg_status status = PG_OK;
    void *self;
    const pg_force_type *force = pg_solver_force (s->solver, &self);
    if (!s->field) PG_ALLOC (s->field, 6 * s->problem->cloud.n);
    if (!s->begun && force->refresh) PG_TRY (force->refresh (self, s->state, NULL));
    PG_TRY (force->field (self, s->state, s->state->d, name, components, unit, s->field));
    if (*components == 0)
        PG_FAIL (PG_E_USAGE, "the force %s has no field '%s': displacement|velocity|damage|strain|stress%s",
                 force->method.name, name,
                 pg_problem_rotations (s->problem)      ? "|rotation"
                 : force->method.shape_functions ? "|coefficient|error_estimate"
                                                 : "");
    *value = s->field;
done:
    return status;
}

/* ---- changes by the caller ----------------------------------------------------------------------------- */
pg_status pg_session_set (pg_session *s, const char *what, size_t n, const double *value)
{
    pg_status status = PG_OK;
    int moves = (s->options.flags & PG_SOLVER_NEEDS_DENSITY) != 0, velocity = strcmp (what, "velocity") == 0;
    if (!velocity && strcmp (what, "displacement") != 0)
        PG_FAIL (PG_E_USAGE, "'%s' cannot be set: displacement|velocity", what);
    if (s->begun)
        PG_FAIL (PG_E_USAGE, "%s can be set before the first step only: later it belongs to the solver",
                 what);
    if (!moves)
        PG_FAIL (PG_E_USAGE,
                 "solver.kind: %s finds displacements from loads and supports: %s can be set in dynamics "
                 "only", s->options.kind, what);
    if (n != s->state->ndof)
        PG_FAIL (PG_E_USAGE, "%s has %zu values: there are %zu unknowns", what, n, s->state->ndof);
    for (size_t i = 0; i < n; i++)
        if (!isfinite (value[i])) PG_FAIL (PG_E_USAGE, "%s number %zu is %g", what, i + 1, value[i]);
    memcpy (velocity ? s->state->v : s->state->d, value, n * sizeof *value);
done:
    return status;
}

/* Number of the same bond as seen from its other end; SIZE_MAX: it is not in the family of that end. */
static size_t other_end (const pg_problem *p, size_t bond)
{
    int set;
    size_t point;
    pg_problem_locate (p, bond, &set, &point);
    const pg_family *f = &p->bonds.rows[set].family;
    int node = f->node[bond - p->bonds.first[set]];
    if (set != PG_NODES || (size_t) node == point || f->start[node] == f->start[node + 1]) return SIZE_MAX;
    size_t e = session_mirror (f, (int) point, node);
    return f->node[e] == (int) point ? e + p->bonds.first[set] : SIZE_MAX;
}

pg_status pg_session_cut (pg_session *s, size_t n, const size_t *bond)
{
    pg_status status = PG_OK;
    unsigned char *marked = NULL;
    pg_changes cut = { 0 };
    PG_ALLOC (marked, s->state->nbond);
    for (size_t k = 0; k < n; k++) {
        if (bond[k] >= s->state->nbond)
            PG_FAIL (PG_E_USAGE, "there is no bond %zu: there are %zu", bond[k], s->state->nbond);
        size_t other = other_end (s->problem, bond[k]);
        marked[bond[k]] = 1;
        if (other != SIZE_MAX) marked[other] = 1;
    }
    for (size_t b = 0; b < s->state->nbond; b++) {
        if (!marked[b] || !s->state->alive[b]) continue;
        PG_GROW (cut.bond, cut.cap, cut.n + 1);
        cut.bond[cut.n++] = b;
    }
    PG_TRY (pg_solver_cut (s->solver, s->state, &cut));
done:
    pg_free (marked), pg_free (cut.bond);
    return status;
}

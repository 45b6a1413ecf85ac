/* SPDX-License-Identifier: GPL-3.0-or-later
 * The first break of a scene (check --solve): one quasi-static solve at load factor 1 in which nothing may
 * break, then the criterion applied to it: load factor and position of the first break. Also J and K of crack
 * tips, and the largest frequency, which bounds explicit time steps. */
#include "perigal/study.h"
#include <math.h>
#include <string.h>

/* Index of the bond with the smallest load factor; if loads are not proportional, of that with the largest
 * utilisation. */
static size_t worst_bond (const pg_first_break *b, size_t n, const double *factor, const double *utilisation)
{
    size_t worst = 0;
    for (size_t i = 1; i < n; i++)
        if (b->proportional ? factor[i] < factor[worst] : utilisation[i] > utilisation[worst]) worst = i;
    return worst;
}

/* Finds the bond set and the middle of a bond, between its evaluation point and its node. */
static void locate (pg_first_break *b, const pg_problem *p, size_t bond)
{
    size_t point, dim = (size_t) p->dim;
    pg_problem_locate (p, bond, &b->set, &point);
    const pg_rows *r = &p->bonds.rows[b->set];
    const double *end = p->cloud.x + (size_t) r->family.node[bond - p->bonds.first[b->set]] * dim;
    for (size_t k = 0; k < dim; k++) b->place[k] = 0.5 * (r->x[point * dim + k] + end[k]);
}

/* Finds the bond that breaks first, from the utilisation of every bond. If loads are not proportional the
 * factor is an estimate: 1 over the utilisation. INFINITY if nothing can break. */
static pg_status judge (pg_first_break *b, const pg_problem *p, pg_solver *solver, const pg_state *state)
{
    pg_status status = PG_OK;
    void *self;
    const pg_force_type *force = pg_solver_force (solver, &self);
    double *factor = NULL, *utilisation = NULL;
    char *kind = NULL;
    b->factor = INFINITY;
    if (!pg_criterion_of_bonds (p->criterion) || !force->judge || state->nbond == 0) return PG_OK;
    PG_ALLOC (factor, state->nbond);
    PG_ALLOC (utilisation, state->nbond);
    PG_ALLOC (kind, state->nbond);
    PG_TRY (force->judge (self, state, state->d,
                          &(pg_judging){ .utilisation = utilisation, .kind = kind, .factor = factor }));
    size_t worst = worst_bond (b, state->nbond, factor, utilisation);
    b->factor = factor[worst], b->utilisation = utilisation[worst], b->kind = kind[worst];
    if (!b->proportional) b->factor = b->utilisation > 0 ? 1 / b->utilisation : INFINITY;
    locate (b, p, worst);
done:
    pg_free (factor), pg_free (utilisation), pg_free (kind);
    return status;
}

/* Measures J and stress intensity factors at the crack tips (2D), under the full load. */
static pg_status measure_tips (pg_first_break *b, const pg_problem *p, pg_solver *solver,
                               const pg_state *state)
{
    pg_status status = PG_OK;
    void *self;
    const pg_force_type *force = pg_solver_force (solver, &self);
    const double one = 1, *const d = state->d;
    for (size_t t = 0; state->paths && t < state->paths->ntip; t++) {
        if (!state->paths->tip[t].open) continue;
        b->refused = pg_tip_refuses (p, force);
        if (!b->refused && b->ntip < PG_FIRST_TIPS) {
            b->id[b->ntip] = state->paths->tip[t].id;
            pg_tip_faces faces;
            int touch = pg_solver_tip_faces (solver, state, t, &faces);
            PG_TRY (pg_tip_measure (&b->tip[b->ntip], p, force, self, state, t, 1, &d, &one,
                                          touch ? &faces : NULL, 0));
        }
        b->ntip++;
    }
done:
    return status;
}

/* Summarizes J and K over the vertices of a front, from the fields measured there. */
static void summarise (pg_first_front *out, const pg_front *f, const pg_tip_field *field)
{
    const double one = 1;
    double weight = 0;
    *out = (pg_first_front) { .id = f->id, .closed = f->closed, .n = f->n, .J = { NAN, NAN, NAN },
                              .K = { { NAN, NAN }, { NAN, NAN }, { NAN, NAN } } };
    for (size_t i = 0; i < f->n; i++) {
        double J, K[3];
        out->length += field[i].length;
        if (isnan (field[i].near)) continue;
        pg_tip_combine (&field[i], 1, &one, &J, NULL, NULL);
        pg_tip_intensities (&field[i], 1, &one, K);
        if (!(out->J[2] >= J)) out->J[2] = J, memcpy (out->x, f->x + 3*i, sizeof out->x);
        out->J[0] = fmin (out->J[0], J);               /* fmin ignores NAN */
        out->J[1] = (out->measured ? out->J[1] : 0) + J * field[i].length, weight += field[i].length;
        for (int m = 0; m < 3; m++)
            out->K[m][0] = fmin (out->K[m][0], K[m]), out->K[m][1] = fmax (out->K[m][1], K[m]);
        out->measured++;
    }
    out->J[1] /= weight;
}

/* Measures J and stress intensity factors along crack fronts (3D), under the full load. */
static pg_status measure_fronts (pg_first_break *b, const pg_problem *p, pg_solver *solver,
                                 const pg_state *state)
{
    pg_status status = PG_OK;
    void *self;
    const pg_force_type *force = pg_solver_force (solver, &self);
    const double one = 1, *const d = state->d;
    pg_tip_field *field = NULL;
    pg_front_faces *faces = NULL;
    const pg_front *front = pg_fronts_of_state (p, state, &b->nfront);
    if (b->nfront) b->refused = pg_tip_refuses (p, force);
    for (size_t f = 0; !b->refused && f < b->nfront && f < PG_FIRST_TIPS; f++) {
        PG_ALLOC (field, front[f].n);
        PG_ALLOC (faces, front[f].n);
        int touch = pg_solver_front_faces (solver, state, f, faces);
        PG_TRY (pg_front_measure (field, p, force, self, state, f, 1, &d, &one,
                                        touch ? faces : NULL));
        summarise (&b->front[f], &front[f], field);
        pg_free (field), field = NULL, pg_free (faces), faces = NULL;
    }
done:
    pg_free (field), pg_free (faces);
    return status;
}

/* Finds the vertex of the crack fronts (3D) that moved farthest; for a new crack a vertex of its front. */
static void find_advance (pg_first_break *b, const pg_crack_surfaces *w)
{
    double most = -1;
    if (!(w->area > 0)) return;
    b->grows = 1, b->grown = 0;
    for (size_t f = 0; f < w->nfront; f++)
        for (size_t i = 0; i < w->front[f].n; i++) {
            const pg_front *front = &w->front[f];
            if (!(front->grown[i] > most)) continue;
            most = front->grown[i], b->grown = most > 0 ? front->id : 0;
            memcpy (b->from, front->x + 3*i, sizeof b->from), memcpy (b->to, b->from, sizeof b->to);
        }
}

/* Finds the facet by which a crack has grown (2D): that of the tip that moved, or a new crack. */
static void find_facet (pg_first_break *b, const pg_crack_paths *w)
{
    if (!w || w->cracks.n == w->nfirst || !(w->length > 0)) return;
    size_t piece = w->cracks.n - 1;
    int to = 1;
    b->grows = 1, b->grown = 0;
    for (size_t t = 0; t < w->ntip && !b->grown; t++)
        if (w->tip[t].grown > 0) b->grown = w->tip[t].id, piece = w->tip[t].segment, to = w->tip[t].end;
    const double *vertex = w->cracks.crack[piece].vertex;
    for (int k = 0; k < 2; k++) b->from[k] = vertex[2 * (1 - to) + k], b->to[k] = vertex[2 * to + k];
}

/* Largest utilisation of a tip, or of a vertex of a front, that the solver has computed. */
static double largest_utilisation (const pg_solver *solver)
{
    double top = 0;
    size_t n = 0;
    const pg_tip_values *value = pg_solver_tips (solver, &n);
    for (size_t i = 0; i < n; i++) if (value[i].utilisation > top) top = value[i].utilisation;
    return top;
}

/* Finds when the first facet grows, for criteria that are evaluated at crack tips, not for bonds: by the run
 * itself, up to its first event. If the full load is reached before, the load factor follows from the energy
 * release rate, which goes with the square of proportional loads. */
static pg_status find_growth (pg_first_break *b, const pg_problem *p, const pg_solver_options *o)
{
    pg_status status = PG_OK;
    pg_solver_options once = *o;
    pg_solver *solver = NULL;
    pg_state *state = NULL;
    pg_step step = { 0 };
    b->factor = INFINITY, b->utilisation = NAN;
    once.max_events = 1, once.levels = 1, once.stop_set = NULL;
    if (!o->event) goto done;
    PG_TRY (pg_solver_create (&solver, p, &once));
    PG_TRY (pg_state_create (&state, p, pg_solver_components (solver)));
    PG_TRY (pg_solver_step (solver, state, &step));
    double top = largest_utilisation (solver);
    find_facet (b, state->paths);
    if (state->surfaces) find_advance (b, state->surfaces);
    if (b->grows) b->factor = step.factor, b->utilisation = 1;
    else if (b->proportional && top > 0) b->factor = step.factor / sqrt (top), b->utilisation = top;
    memcpy (b->place, b->from, sizeof b->place), b->kind = 'f';
done:
    pg_state_free (&state);
    pg_solver_free (&solver);
    return status;
}

/* 1 if every material has a density. */
static int all_dense (const pg_problem *p)
{
    for (size_t i = 0; i < p->nmaterial; i++) if (!(p->material[i].density > 0)) return 0;
    return 1;
}

/* Finds the first break. The problem is copied without its criterion for the solve, so that nothing breaks;
 * the copy shares all arrays with the original and must not be freed. The solver takes one step to the full
 * load. Dynamic and staged scenes get the largest frequency only. */
pg_status pg_first_break_find (pg_first_break *b, const pg_problem *p, const pg_solver_options *o)
{
    pg_status status = PG_OK;
    pg_problem bare = *p;  /* the problem without a criterion: nothing breaks */
    pg_criterion *none = NULL;
    pg_solver_options once = *o;
    pg_solver *solver = NULL;
    pg_state *state = NULL;
    pg_step step;
    b->asked = 1, b->is_static = (o->flags & PG_SOLVER_QUASI_STATIC) && !(o->flags & PG_SOLVER_STAGED),
    b->proportional = pg_problem_proportional (p);
    once.event = 0, once.steps = once.levels = 1, once.stop_set = NULL;
    PG_ALLOC (none, p->nmaterial);
    bare.criterion = none;
    PG_TRY (pg_solver_create (&solver, &bare, &once));
    PG_TRY (pg_state_create (&state, &bare, pg_solver_components (solver)));
    if (all_dense (p)) PG_TRY (pg_solver_fastest (solver, state, &b->omega));
    if (!b->is_static) goto done;
    PG_TRY (pg_solver_step (solver, state, &step));
    b->residual = step.residual;
    for (size_t i = 0; i < state->ndof; i++) b->displacement = fmax (b->displacement, fabs (state->d[i]));
    bare.criterion = p->criterion;
    if (pg_criterion_of_tips (p->criterion)) PG_TRY (find_growth (b, p, o));
    else PG_TRY (judge (b, &bare, solver, state));
    PG_TRY (measure_tips (b, &bare, solver, state));
    if (p->dim == 3) PG_TRY (measure_fronts (b, &bare, solver, state));
    b->solved = 1;
done:
    pg_state_free (&state);
    pg_solver_free (&solver);
    pg_free (none);
    return status;
}

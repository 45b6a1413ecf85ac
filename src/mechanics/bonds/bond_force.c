/* SPDX-License-Identifier: GPL-3.0-or-later
 * Forces that bonds between points carry, whatever the theory: creation, balance of forces by a loop over
 * bonds, breaking, mass, work. */
#include "dilatation.h"
#include <math.h>
#include <string.h>

static size_t ndof (const bond_force *b) { return b->n * (size_t) b->stride; }

/* ---- one point ----------------------------------------------------------------------------------------- */
/* The bonds of point i with their weights, in the share of the workspace that belongs to a thread: valid
 * until the same thread asks for another point. */
void point_bonds_at (const bond_force *b, size_t i, int thread, point_bonds *s)
{
    double *workspace = b->workspace + (size_t) thread * b->widest * (size_t) (b->dim + 2);
    s->first = b->family->start[i], s->m = b->family->start[i + 1] - s->first;
    s->node = b->family->node + s->first;
    s->xi = workspace, s->weight = workspace + b->widest * (size_t) b->dim, s->beta = s->weight + b->widest;
    pg_sums_bonds (b->problem->sums, b->family, i, s->xi, s->weight, s->beta);
}

/* ---- creation and release ------------------------------------------------------------------------------ */
/* Frees the force, also one that was made in part only (its struct was zero at first). */
void bond_force_free (void **self)
{
    bond_force *b = *self;
    if (!b) return;
    pg_bond_loop_free (&b->loop), pg_bond_loop_free (&b->tangent);
    bond_force_energy_free (b);
    b->theory->free (b);
    boundary_free (&b->boundary);
    pg_sparse_clear (&b->K);
    pg_nearest_free (&b->near);
    pg_free (b->idle), pg_free (b->limit), pg_free (b->workspace), pg_free (b->work),
        pg_free (b->stale.column), pg_free (b->diagonal), pg_free (b->whole);
    pg_free (b);
    *self = NULL;
}

/* Returns the critical stretch of a bond between two points of this horizon ratio: the load factor that the
 * criterion gives for a bond of unit stretch. */
static double limit_at (const pg_criterion *c, double ratio)
{
    double one = 1, factor = 0;
    pg_bond_measures m = { .n = 1, .dim = 1, .xi = &one, .eta = &one, .reach = &ratio };
    c->type->factor (c, &m, &factor);
    return factor;
}

/* Makes the limits of points at which bonds break: energies, or critical stretches unless the theory has made
 * these itself. */
static pg_status make_limits (bond_force *b)
{
    pg_status status = PG_OK;
    const pg_problem *p = b->problem;
    PG_TRY (bond_force_energy_create (b));
    if (!pg_criterion_of_bonds (p->criterion) || b->node.critical || b->limit) goto done;
    PG_ALLOC (b->limit, b->n);
    for (size_t i = 0; i < b->n; i++) {
        const pg_criterion *c = pg_problem_limit (p, PG_NODES, i);
        b->limit[i] = c->never ? INFINITY : limit_at (c, pg_cloud_ratio (&p->cloud, i));
    }
done:
    return status;
}

/* Makes a loop over bonds with the constants of the theory. limit: critical stretches, NULL: nothing breaks
 * in it. A loop that cannot be made is a fault of the scene, not of the caller. */
static pg_status make_loop (bond_force *b, pg_bond_loop **out, const pg_sums *sums, const double *limit)
{
    pg_bond_loop_setting *s = &b->setting;             /* the theory has filled in its constants */
    s->sums = sums, s->family = b->family, s->limit = limit, s->threads = b->threads;
    s->exempt = b->problem->bonds.exempt[PG_NODES], s->plain = b->problem->plain;
    pg_status status = pg_bond_loop_create (out, s);
    if (status != PG_E_USAGE) return status;
    char why[512];
    snprintf (why, sizeof why, "%s", pg_last_error ());
    return pg_error (PG_E_SCENE, PG_HERE, "method.evaluation: %s", why);
}

/* Makes constants before the loop, and the loop before the weighted volumes, which it sums. */
pg_status bond_force_make (void **self, const pg_problem *problem, const bond_theory *theory)
{
    pg_status status = PG_OK;
    bond_force *b = NULL;
    *self = NULL;
    if (!problem->sums) PG_FAIL (PG_E_USAGE, "forces between points need a problem built for them");
    b = pg_calloc (1, theory->size);
    if (!b) PG_FAIL (PG_E_MEMORY, "no memory for a force");
    *self = b;
    b->theory = theory;
    b->problem = problem, b->dim = problem->dim, b->threads = problem->threads, b->n = problem->cloud.n;
    b->stride = pg_problem_unknowns (problem);
    b->family = &problem->bonds.rows[PG_NODES].family;
    b->stale.all = 1, b->revision = 1;
    b->op = (pg_operator) { ndof (b), b, bond_force_apply, bond_force_diagonal };
    for (size_t i = 0; i < b->n; i++) {
        size_t m = b->family->start[i + 1] - b->family->start[i];
        b->widest = m > b->widest ? m : b->widest;
    }
    PG_ALLOC (b->workspace, (size_t) b->threads * b->widest * (size_t) (b->dim + 2));
    PG_ALLOC (b->work, ndof (b));
    PG_ALLOC (b->stale.column, b->n);
    PG_ALLOC (b->diagonal, ndof (b));
    PG_TRY (theory->create (b));
    PG_TRY (make_limits (b));
    PG_TRY (make_loop (b, &b->loop, problem->sums, b->limit));
    PG_TRY (dilatation_weigh (b));
    PG_TRY (boundary_create (&b->boundary, problem, b->stride, b->length, b->idle));
done:
    if (status != PG_OK) bond_force_free (self);
    return status;
}

/* K is the stiffness for small displacements: with finite stretch its products need a loop of their own,
 * which is made when it is first needed. */
pg_status bond_force_tangent_loop (bond_force *b, pg_bond_loop **out)
{
    pg_status status = PG_OK;
    *out = b->loop;
    if (!b->problem->sums->rule.finite) return PG_OK;
    if (!b->tangent) {
        b->small = *b->problem->sums;
        b->small.rule.finite = 0;
        PG_TRY (make_loop (b, &b->tangent, &b->small, NULL));
        if (b->alive) pg_bond_loop_update (b->tangent, b->alive, NULL);
    }
    *out = b->tangent;
done:
    return status;
}

/* Fields of unknowns: displacement, and rotation where points have some, as a length too. */
size_t bond_force_fields (const void *self, size_t max, pg_field *out)
{
    const bond_force *b = self;
    if (max > 0) out[0] = (pg_field) { "displacement", "m", b->dim };
    if (max > 1 && b->stride > b->dim) out[1] = (pg_field) { "rotation", "m", b->stride - b->dim };
    return b->stride > b->dim ? 2 : 1;
}

/* ---- breaking ------------------------------------------------------------------------------------------ */
/* Marks the columns of K of both ends of each broken bond as out of date. */
static void mark_stale (bond_force *b, const pg_changes *changes)
{
    for (size_t c = 0; c < changes->n; c++) {
        int set;
        size_t point;
        pg_problem_locate (b->problem, changes->bond[c], &set, &point);
        b->stale.column[point] = b->stale.column[b->family->node[changes->bond[c]]] = 1;
    }
    b->revision += changes->n > 0;
}

/* Borrows the alive mask of the state and updates the loops and K for the bonds that changed, or for all. */
pg_status bond_force_refresh (void *self, const pg_state *state, const pg_changes *changes)
{
    bond_force *b = self;
    b->alive = state->alive;
    pg_bond_loop_update (b->loop, state->alive, changes);
    if (b->tangent) pg_bond_loop_update (b->tangent, state->alive, changes);
    if (changes) mark_stale (b, changes);
    else b->stale.all = 1, b->revision++, b->theory->forget ? b->theory->forget (b) : (void) 0;
    return PG_OK;
}

/* Adds loads P (t) and forces of springs to the residual, which holds the forces f of the bonds. Ghosts get
 * 0: only their owner knows all that acts on them. */
static void finish (bond_force *b, double t, const double *d, double *residual, double *reference)
{
    double inside = 0;
    boundary_pull (&b->boundary, t, d, residual);
    if (reference) pg_subdomain_clear_ghosts (b->problem->cloud.subdomain, (size_t) b->stride, residual);
    for (size_t i = 0; reference && i < ndof (b); i++) inside += residual[i] * residual[i];
    if (reference) *reference = boundary_reference (&b->boundary, t, inside);
    boundary_add (&b->boundary, t, residual);
    pg_subdomain_clear_ghosts (b->problem->cloud.subdomain, (size_t) b->stride, residual);
}

/* residual = forces of all bonds, loads and springs. */
pg_status bond_force_balance (void *self, double t, const double *d, double *residual, double *reference)
{
    pg_status status = PG_OK;
    bond_force *b = self;
    PG_TRY (pg_bond_loop_force (b->loop, d, residual, NULL));
    finish (b, t, d, residual, reference);
done:
    return status;
}

/* Points at their limit of energy lose their bonds first, so that the loop no longer sums these; stretches
 * are compared with their limits inside the loop. */
pg_status bond_force_balance_and_break (void *self, double t, const double *d, double *residual,
                                        double *reference,
                      pg_changes *broken)
{
    pg_status status = PG_OK;
    bond_force *b = self;
    size_t before = broken->n;
    if (b->node.critical) PG_TRY (bond_force_energy_kill (b, d, broken));
    PG_TRY (pg_bond_loop_force (b->loop, d, residual, b->limit ? broken : NULL));
    if (broken->n > before) {
        pg_changes fresh = { broken->n - before, 0, broken->bond + before };
        if (b->tangent) pg_bond_loop_update (b->tangent, b->alive, &fresh);
        mark_stale (b, &fresh);
    }
    finish (b, t, d, residual, reference);
done:
    return status;
}

/* Writes the loads at t, N, without supports. */
pg_status bond_force_loads (void *self, double t, double *P)
{
    bond_force *b = self;
    memset (P, 0, ndof (b) * sizeof *P);
    boundary_add (&b->boundary, t, P);
    pg_subdomain_clear_ghosts (b->problem->cloud.subdomain, (size_t) b->stride, P);
    return PG_OK;
}

/* Nodal forces P, N, of the tractions of a uniform stress, for a problem (the patch test) whose only load is
 * a traction on the whole surface. */
pg_status bond_force_surface (void *self, const double *stress, double *P)
{
    bond_force *b = self;
    return b->problem->boundary.nload ? boundary_surface (&b->boundary, 0, stress, P) : PG_OK;
}

/* ---- the rest ------------------------------------------------------------------------------------------ */
/* Lumped masses, kg: density times volume; of rotations the moment of inertia of a cube of the local spacing,
 * over length^2, as the unknown is length times the angle. */
void bond_force_masses (const bond_force *b, double *mass)
{
    const pg_problem *p = b->problem;
    for (size_t i = 0; i < b->n; i++) {
        double own = p->material[p->block[PG_NODES][i]].density * p->cloud.volume[i], across = 0;
        if (b->length > 0) across = pg_problem_spacing (p, PG_NODES, i) / b->length;
        for (size_t k = 0; k < (size_t) b->stride; k++)  /* moment of inertia of a cube: theory G4 */
            mass[i * (size_t) b->stride + k] = k < (size_t) b->dim ? own : own * across * across / 6;
    }
}

pg_status bond_force_mass (void *self, double *mass, const pg_sparse **consistent)
{
    if (mass) bond_force_masses (self, mass);
    if (consistent) *consistent = NULL;
    return PG_OK;
}

/* Energy stored by the bonds, J. Where ranks share the body, each sums the energy of its own points, so that
 * together they count all of it once. */
static pg_status stored_energy (bond_force *b, const double *d, double *energy)
{
    pg_status status = PG_OK;
    double *W = NULL;
    *energy = 0;
    if (!b->problem->cloud.subdomain) {
        *energy = pg_bond_loop_energy (b->loop, d);
        return PG_OK;
    }
    PG_ALLOC (W, b->n);
    PG_TRY (pg_bond_loop_energies (b->loop, d, W));
    for (size_t i = 0; i < b->n; i++)
        if (b->problem->cloud.subdomain->owned[i]) *energy += W[i] * b->problem->cloud.volume[i];
done:
    pg_free (W);
    return status;
}

/* Strain energy -1/2 f . d, J, of forces that are linear in d, from the residual f + P. The loads P are those
 * pairs of force and displacement in `out` that follow the pairs of supports; springs come last. */
PG_WIDEST static double strain_of (const bond_force *b, const double *d, const double *residual,
                                   const pg_work_balance *out)
{
    pg_eight lane = { 0 };
    double sum = 0;
    size_t i = 0;
    for (; i + 8 <= ndof (b); i += 8)
        lane += *(const pg_eight *) (residual + i) * *(const pg_eight *) (d + i);
    for (; i < ndof (b); i++) lane[0] += residual[i] * d[i];
    size_t springs = out->npair - b->boundary.nspring;
    for (size_t k = b->boundary.nsupport; k < springs; k++) sum += out->force[k] * out->displacement[k];
    for (size_t k = 0; k < b->boundary.nspring; k++)
        sum += out->force[springs + k] * d[b->boundary.spring[k].dof];
    for (size_t k = 0; k < 8; k++) sum -= lane[k];
    /* The part of one rank may be negative, the sum over all ranks is not. */
    return b->problem->cloud.subdomain ? 0.5 * sum : fmax (0.5 * sum, 0);
}

/* Fills in the work balance. Reactions are the residual at prescribed unknowns, in dynamics with the inertia
 * there; other entries of residual and inertia are not read for them. If forces are linear in d, the strain
 * energy follows from a residual that is known. */
pg_status bond_force_work (void *self, double t, const double *d, const pg_known *known, pg_work_balance *out)
{
    pg_status status = PG_OK;
    bond_force *b = self;
    const pg_known nothing = { 0 }, *k = known ? known : &nothing;
    if (!k->residual) PG_TRY (bond_force_balance (b, t, d, b->work, NULL));
    for (size_t s = 0; s < b->boundary.nsupport; s++) {
        size_t i = b->boundary.support[s].dof;
        if (k->residual) b->work[i] = k->residual[i];
        if (k->inertia && !(k->residual && k->whole)) b->work[i] += k->inertia[i];
    }
    PG_TRY (boundary_work_balance (&b->boundary, t, d, b->work, out));
    if (k->residual && !k->whole && pg_bond_loop_halves (b->loop))
        out->strain = strain_of (b, d, k->residual, out);
    else PG_TRY (stored_energy (b, d, &out->strain));
    out->strain += boundary_spring_energy (&b->boundary, t, d);
done:
    return status;
}

unsigned long bond_force_revision (const void *self) { return ((const bond_force *) self)->revision; }
const pg_operator *bond_force_operator (void *self) { return &((bond_force *) self)->op; }
const pg_sparse *bond_force_basis (void *self) { return boundary_basis (&((bond_force *) self)->boundary); }

/* Sets prescribed unknowns of d to their values at t. */
pg_status bond_force_impose (void *self, double t, double *d)
{
    boundary_impose (&((bond_force *) self)->boundary, t, d);
    return PG_OK;
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * The Galerkin force: R = P - sum_p w_p B_p' sigma_p over intact bonds, K = sum_p w_p B_p' D B_p (Cui 2022
 * section 3; theory F). After a break only the rows of points that lost bonds and of the nodes in their
 * families are recomputed. Here are the entries of pg_force_galerkin except matrix and K x
 * (weak_form/galerkin_operator.c), judge (weak_form/galerkin_bonds.c), field (galerkin_field.c), sample
 * (galerkin_sample.c). */
#include "mechanics/galerkin/weak_form/galerkin.h"
#include "mechanics/boundary/one_sided.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Names the field that is recorded: the displacement. The unknowns themselves are coefficients of shape
 * functions. */
static size_t galerkin_fields (const void *self, size_t max, pg_field *out)
{
    const galerkin *g = self;
    if (max > 0) out[0] = (pg_field) { "displacement", "m", g->dim };
    return 1;
}

/* Frees the force, also one that was made in part only. */
static void galerkin_free (void **self)
{
    galerkin *g = *self;
    if (!g) return;
    galerkin_rows_free (g);
    galerkin_consistent_free (g);
    for (int s = 0; s < PG_BOND_SETS; s++) {
        pg_free (g->measured.strain[s]), pg_free (g->measured.stress[s]), pg_free (g->measured.zz[s]),
            pg_free (g->measured.u[s]);
        pg_free (g->measured.s1[s]), pg_free (g->measured.s2[s]), pg_free (g->measured.s3[s]),
        pg_free (g->measured.seen[s]),
            pg_free (g->list[s]),
            pg_free (g->bounds.judged[s]);
        pg_free (g->bounds.alone[s]), pg_free (g->bounds.exact[s]), pg_free (g->bounds.bounded[s]);
        pg_free (g->measured.disturbed[s]), pg_free (g->bounds.longest[s]);
    }
    pg_free (g->bounds.place_now);
    pg_assembly_free (&g->stiffness.K);
    pg_assembly_free (&g->stiffness.M);
    galerkin_boundary_free (g);
    galerkin_basis_free (g);
    galerkin_slices_free (g);
    galerkin_sight_free (g);
    galerkin_silling_free (g);
    galerkin_eigen_free (g);
    galerkin_dilatation_free (g);
    galerkin_change_free (g);
    pg_nearest_free (&g->places.near_point);
    pg_nearest_free (&g->places.near_node);
    pg_family_search_free (&g->places.search);
    galerkin_again_free (&g->places.again);
    galerkin_alike_free (&g->places.alike);
    pg_free (g->work), pg_free (g->stiffness.stale), pg_free (g->stiffness.diagonal),
        pg_free (g->stiffness.wide),
        pg_free (g->ends);
    pg_free (g);
    *self = NULL;
}

/* Allocates the values of one bond set on the geometry of the problem, which is borrowed: rows of shape
 * functions; strain and stress (nv a point), stress across a plane, displacement, principal stresses; seen:
 * the displacement field that these belong to. */
static pg_status create_set (galerkin *g, int s)
{
    galerkin_measured *m = &g->measured;
    pg_status status = PG_OK;
    const pg_problem *p = g->problem;
    const pg_rows *r = &g->rows[s];
    size_t dim = (size_t) g->dim;
    PG_TRY (galerkin_rows_create (g, s));
    g->material[s] = p->block[s];
    PG_ALLOC (m->strain[s], r->n * (size_t) g->nv);
    PG_ALLOC (m->stress[s], r->n * (size_t) g->nv);
    PG_ALLOC (m->zz[s], r->n);
    PG_ALLOC (m->u[s], r->n * dim);
    PG_ALLOC (m->s1[s], r->n);
    PG_ALLOC (m->s2[s], r->n);
    PG_ALLOC (m->s3[s], r->n);
    PG_ALLOC (m->seen[s], g->n * dim);
    PG_ALLOC (m->disturbed[s], (r->n + GALERKIN_BLOCK - 1) / GALERKIN_BLOCK);
    PG_ALLOC (g->list[s], r->n);
done:
    return status;
}

/* Creates the force. Rows of shape functions are filled by the first refresh, when it is known which bonds
 * are intact. Consistent integration, boundary, elimination, dilatation and sums need the rows of all sets,
 * in this order. */
static pg_status galerkin_create (void **self, const pg_problem *problem)
{
    pg_status status = PG_OK;
    galerkin *g = NULL;
    PG_ALLOC (g, 1);
    *self = g;
    g->problem = problem, g->options = problem->options, g->dim = problem->dim,
        g->nv = pg_voigt_size (problem->dim),
    g->threads = problem->threads, g->n = problem->cloud.n;
    g->bulk = problem->form.integration->at_nodes ? PG_NODES : PG_POINTS;
    for (int s = 0; s < PG_BOND_SETS; s++) PG_TRY (create_set (g, s));
    PG_TRY (galerkin_consistent_create (g));
    PG_ALLOC (g->work, g->n * (size_t) g->dim);
    PG_TRY (galerkin_boundary_create (g));
    PG_TRY (galerkin_basis_create (g));
    PG_TRY (galerkin_dilatation_create (g));
    PG_TRY (galerkin_silling_create (g));
    PG_TRY (galerkin_slices_create (g));
    PG_TRY (galerkin_eigen_create (g));
    PG_TRY (galerkin_operator_create (g));
done:
    if (status != PG_OK) galerkin_free (self);
    return status;
}

/* ---- refresh ------------------------------------------------------------------------------------------- */
/* Lists in g->list the points of each set that own one of the broken bonds, each once; bonds and lists are
 * ascending. */
static void touched_points (const galerkin *g, const pg_changes *changes, size_t *count)
{
    for (int s = 0; s < PG_BOND_SETS; s++) count[s] = 0;
    for (size_t c = 0; c < changes->n; c++) {
        int s;
        size_t point;
        pg_problem_locate (g->problem, changes->bond[c], &s, &point);
        /* bonds are ascending, so that equal points follow each other */
        if (count[s] == 0 || g->list[s][count[s] - 1] != point) g->list[s][count[s]++] = point;
    }
}

/* Reevaluates the shape functions of points that lost a bond (changes NULL: of all), then all that depends on
 * them: consistent derivatives, dilatation patches, stale rows of K, elimination. Strains measured at the
 * last displacement stay valid; only those of points that lost a bond are measured anew. */
pg_status galerkin_refresh (void *self, const pg_state *state, const pg_changes *changes)
{
    pg_status status = PG_OK;
    galerkin *g = self;
    size_t count[PG_BOND_SETS];
    if (galerkin_give_back (g, state)) changes = NULL;
    if (changes) touched_points (g, changes, count);
    galerkin_change_begin (g, !changes);
    for (int s = 0; s < PG_BOND_SETS; s++) {
        size_t n = changes ? count[s] : g->rows[s].n;
        /* pressures of dilatation patches change at further points too */
        int known = changes && g->measured.fresh[s] && !g->dilatation;
        g->measured.fresh[s] = 0;
        if (changes) PG_TRY (galerkin_change_points (g, s, n, g->list[s], -1));
        if (n && !galerkin_borrows (g, s))
            PG_TRY (galerkin_evaluate (g, state, s, n, changes ? g->list[s] : NULL));
        if (changes) PG_TRY (galerkin_change_points (g, s, n, g->list[s], 1));
        if (s == g->bulk && g->whole) PG_TRY (galerkin_consistent_update (g, state, !changes, &n));
        if (s == g->bulk) {
            galerkin_slices_stale (g, n, changes ? g->list[s] : NULL);
            galerkin_silling_update (g, n, changes ? g->list[s] : NULL);
        }
        count[s] = n;
        g->measured.fresh[s] = known;
        if (known) galerkin_measure_list (g, s, n, g->list[s]);
    }
    if (g->dilatation) PG_TRY (galerkin_dilatation_update (g, state, !changes, count));
    /* a resumed run needs stresses at the time of its state */
    if (!changes) galerkin_eigen_at (g, state->time);
    if (!changes) g->stiffness.all_stale = 1, g->stiffness.revision++;
    else galerkin_mark_stale (g, count);
    if (g->supports.has_T && (!changes || galerkin_basis_touched (g, count[PG_NODES], g->list[PG_NODES]))) {
        PG_TRY (galerkin_basis_update (g));
        galerkin_change_basis (g);
        g->stiffness.revision++;
    }
done:
    return status;
}

/* 1: a break changes K x only by the own terms of the evaluation points that lose bonds. Not with consistent
 * cells, patches or stabilisation, nor where supports or loads use their shape functions. */
static int are_alone (const galerkin *g, const size_t *count)
{
    int loaded = 0;
    for (int s = 0; s < PG_BOND_SETS; s++) loaded |= galerkin_boundary_loaded (g, s, count[s], g->list[s]);
    return !loaded && !g->whole && !g->dilatation && !g->kept && !galerkin_eigen_pairs (g)
           && !(g->supports.nnitsche && count[PG_FACETS]) && !(g->supports.npenalty && count[PG_NODES])
           && !(g->supports.has_T && galerkin_basis_touched (g, count[PG_NODES], g->list[PG_NODES]));
}

static pg_status galerkin_share_of (void *self, const double *x, const pg_changes *changes, double *y,
                                    int *can)
{
    galerkin *g = self;
    size_t count[PG_BOND_SETS];
    touched_points (g, changes, count);
    *can = are_alone (g, count);
    memset (y, 0, g->n * (size_t) g->dim * sizeof *y);
    if (*can) galerkin_sum_list (g, count[g->bulk], g->list[g->bulk], x, y);
    return PG_OK;
}

/* ---- balance ------------------------------------------------------------------------------------------- */
/* The largest of the norms of three forces, N, from this rank's share of their squares, N^2; NAN: the sum
 * over ranks failed. */
static double largest_of (const galerkin *g, double inside, double external, double reaction)
{
    double square[3] = { inside, external, reaction };
    if (pg_cloud_sum (&g->problem->cloud, 3, square) != PG_OK) return NAN;
    return sqrt (fmax (square[0], fmax (square[1], square[2])));
}

/* residual = loads - internal force + boundary terms, N, at displacement d and time t. reference: the largest
 * norm of the internal forces, the loads and the reactions, N, with which the residual is compared. */
static pg_status galerkin_balance (void *self, double t, const double *d, double *residual, double *reference)
{
    pg_status status = PG_OK;
    galerkin *g = self;
    size_t ndof = g->n * (size_t) g->dim;
    double inside = 0, external = 0, reaction = 0;
    galerkin_eigen_at (g, t);
    PG_TRY (galerkin_sight_ready (g, 0));
    memset (residual, 0, ndof * sizeof *residual);
    for (int s = 0; s < PG_BOND_SETS; s++)
        if (s == g->bulk || s == PG_FACETS || g->supports.npenalty || g->problem->boundary.nload)
            galerkin_measure (g, s, d);
    galerkin_bulk_force (g, d, residual);
    inside = galerkin_squared (g, residual);
    for (size_t i = 0; i < ndof; i++) residual[i] = -residual[i];
    galerkin_boundary_force (g, t, d, residual, &external, &reaction);
    *reference = fmax (g->eigen.force, largest_of (g, inside, external, reaction));
done:
    return status;
}

/* Residual and reference, N, as galerkin_balance, but by K x: one pass over the shape functions instead of
 * two. Loads do not depend on d; only supports need it. With a projected dilatation K x already contains the
 * flux through supported facets (Nitsche), which the boundary terms would add again. */
static pg_status galerkin_balance_lean (void *self, double t, const double *d, double *residual,
                                        double *reference)
{
    pg_status status = PG_OK;
    galerkin *g = self;
    size_t ndof = g->n * (size_t) g->dim;
    double inside = 0, external = 0, reaction = 0;
    if (galerkin_eigen_pairs (g) || (g->dilatation && g->supports.nnitsche))
        return galerkin_balance (self, t, d, residual, reference);
    PG_TRY (galerkin_sight_ready (g, 1));
    memset (residual, 0, ndof * sizeof *residual);
    if (g->supports.nnitsche || g->dilatation) galerkin_measure (g, PG_FACETS, d);
    if (g->supports.npenalty) galerkin_measure (g, PG_NODES, d);
    galerkin_bulk_apply (g, d, residual);
    inside = galerkin_squared (g, residual);
    for (size_t i = 0; i < ndof; i++) residual[i] = -residual[i];
    galerkin_boundary_force (g, t, d, residual, &external, &reaction);
    *reference = largest_of (g, inside, external, reaction);
done:
    return status;
}

/* Lumped mass: density times the volume of each node, kg. Volumes of nodes sum up to that of the body, so
 * that the total mass is right whatever the shape functions. */
static pg_status galerkin_mass (void *self, double *mass, const pg_sparse **consistent)
{
    galerkin *g = self;
    size_t dim = (size_t) g->dim;
    for (size_t i = 0; mass && i < g->n; i++)
        for (size_t k = 0; k < dim; k++)
            mass[i * dim + k] = galerkin_material (g, PG_NODES, i)->density * g->problem->cloud.volume[i];
    return consistent ? galerkin_consistent_mass (g, consistent) : PG_OK;
}

static pg_status galerkin_loads_of (void *self, double t, double *P)
{
    galerkin *g = self;
    galerkin_loads (g, t, P);
    return PG_OK;
}

static unsigned long galerkin_revision (const void *self)
{
    return ((const galerkin *) self)->stiffness.revision;
}
static const pg_operator *galerkin_operator (void *self) { return &((galerkin *) self)->stiffness.op; }
/* Number of unknowns that elimination removes. */
static size_t slaves_of (const galerkin *g)
{
    return g->supports.side[0].n + g->supports.side[1].n + g->supports.side[2].n;
}

/* 1: the strain energy can be computed from the boundary: in equilibrium it is half the work of all pairs,
 * and only facets need be measured (and nodes, where loads or penalties act on them). Not where reactions of
 * eliminated unknowns need forces of the whole body, or a body force its displacements. */
static int boundary_tells (const galerkin *g, const pg_work_balance *out, int *nodes)
{
    int points = slaves_of (g) > 0;
    *nodes = g->supports.npenalty > 0;
    for (size_t l = 0; l < g->problem->boundary.nload; l++) {
        pg_load_kind kind = g->problem->boundary.load[l].kind;
        points |= kind == PG_BODY_FORCE || g->problem->boundary.load[l].cracks;
        *nodes |= kind == PG_POINT_FORCE;
    }
    return out->force && !points && !g->dilatation && !galerkin_eigen_pairs (g);
}

static void work_of_boundary (galerkin *g, double t, const double *d, int nodes, pg_work_balance *out)
{
    memset (out->reaction, 0, PG_REACTIONS * g->problem->boundary.nload * sizeof *out->reaction);
    galerkin_measure (g, PG_FACETS, d);
    if (nodes) galerkin_measure (g, PG_NODES, d);
    galerkin_boundary_work_balance (g, t, d, out);
    out->strain = 0;
    for (size_t k = 0; k < out->npair; k++) out->strain += 0.5 * out->force[k] * out->displacement[k];
}

/* Computes the pairs of force and displacement of all loads and supports, and the stored energy, by measuring
 * all sets. Boundary terms come first, then eliminated unknowns with their reactions, for which the residual
 * is needed (NULL: no elimination). */
static pg_status work_of_residual (galerkin *g, double t, const double *d, const double *residual,
                                   pg_work_balance *out)
{
    pg_status status = PG_OK;
    if (!out->force) {
        out->npair = galerkin_boundary_pairs (g) + slaves_of (g) + galerkin_eigen_pairs (g);
        PG_ALLOC (out->force, out->npair);
        PG_ALLOC (out->displacement, out->npair);
        PG_ALLOC (out->reaction, PG_REACTIONS * g->problem->boundary.nload);
    }
    memset (out->reaction, 0, PG_REACTIONS * g->problem->boundary.nload * sizeof *out->reaction);
    galerkin_eigen_at (g, t);
    for (int s = 0; s < PG_BOND_SETS; s++) galerkin_measure (g, s, d);
    size_t at = galerkin_boundary_work_balance (g, t, d, out);
    galerkin_eigen_work (g, t, out, galerkin_basis_work_balance (g, t, residual, out, at));
    out->strain = galerkin_bulk_energy (g, d) + galerkin_boundary_energy (g, t);
done:
    return status;
}

static pg_status galerkin_work (void *self, double t, const double *d, const pg_known *known,
                                pg_work_balance *out)
{
    pg_status status = PG_OK;
    galerkin *g = self;
    double *residual = NULL, reference;
    const pg_known nothing = { 0 }, *k = known ? known : &nothing;
    size_t ndof = g->n * (size_t) g->dim;
    int nodes;
    if (k->rest && boundary_tells (g, out, &nodes)) {
        work_of_boundary (g, t, d, nodes, out);
        return PG_OK;
    }
    if (!slaves_of (g) || (k->residual && k->whole)) return work_of_residual (g, t, d, k->residual, out);
    PG_ALLOC (residual, ndof);
    if (k->residual) memcpy (residual, k->residual, ndof * sizeof *residual);
    else PG_TRY (galerkin_balance (g, t, d, residual, &reference));
    for (size_t i = 0; k->inertia && i < ndof; i++) residual[i] += k->inertia[i];
    PG_TRY (work_of_residual (g, t, d, residual, out));
done:
    pg_free (residual);
    return status;
}

/* Reports shortcut number k (pg_force_type.spared): what was saved, why, and the estimated seconds, by
 * measured costs of a bond; returns 0 past the last. The texts hold no counts: these begin anew when a run is
 * resumed, whose report must equal that of an uninterrupted one. */
static int spared (const void *self, size_t k, char *what, char *why, double *seconds)
{
    const galerkin *g = self;
    size_t places = 0, bonds = 0, lent = 0;
    for (int s = 0; s < PG_BOND_SETS; s++) {
        places += g->rows[s].copied, bonds += g->rows[s].copied_bonds;
        if (galerkin_borrows (g, s)) lent += g->rows[s].family.start[g->rows[s].n];
    }
    if (lent && k-- == 0) {
        snprintf (what, 96, "shape functions of the intact body");
        snprintf (why, 160, "the patch test has evaluated them, and no bond is broken");
        *seconds = 1.5e-7 * (double) (lent > bonds ? lent - bonds : 0);
        return 1;
    }
    if (g->stiffness.took && k-- == 0) {
        snprintf (what, 96, "the part of K that evaluation points have");
        snprintf (why, 160, "the patch test has assembled it, and no bond is broken");
        *seconds = NAN;
        return 1;
    }
    size_t shared = galerkin_shared_bonds (g);
    if (shared && k-- == 0) {
        snprintf (what, 96, "memory for the shape functions of every point");
        snprintf (why, 160, "points of a lattice that see their nodes alike share them");
        *seconds = 4e-10 * 8 * (double) (2 + g->dim) * (double) shared;     /* 4e-10 s a byte of new memory */
        return 1;
    }
    if (galerkin_again_served (g) && k-- == 0) {
        snprintf (what, 96, "shape functions of places around tips");
        snprintf (why, 160, "no bond broke and no crack grew near them since they were asked for");
        *seconds = NAN;
        return 1;
    }
    if (k > 0 || places == 0) return galerkin_spared (self, k - (places > 0 && k > 0), what, why, seconds);
    snprintf (what, 96, "shape functions of places like others");
    snprintf (why, 160, "places of a lattice that see their nodes alike have the same ones: evaluated once");
    *seconds = 5e-8 * (double) bonds;
    return 1;
}

/* The jump across a crack by shape functions of the body's own approximation, whose nodal coefficients are
 * those of the displacement. */
static pg_status jump (void *self, const pg_state *state, size_t n, const double *x, const double *normal,
                       double radius, pg_jump_rows *out)
{
    pg_status status = PG_OK;
    const galerkin *g = self;
    PG_TRY (jump_rows (g->problem, &g->problem->form.approx, state, n, x, normal, radius, 0, out));
    PG_TRY (galerkin_ended_jump (g, n, x, normal, out));
done:
    return status;
}

static pg_status trace (void *self, const pg_state *state, size_t n, const double *x, const double *normal,
                        pg_jump_rows *out)
{
    const galerkin *g = self;
    return trace_rows (g->problem, &g->problem->form.approx, state, n, x, normal, out);
}

const pg_force_type pg_force_galerkin = {
    .method = { .name = "galerkin",
                .summary = "weak form with the shape functions of method.approximation (Cui 2022)",
                .keys = { &pg_keys_shape_functions, &galerkin_keys },
                .shape_functions = 1,
                .anisotropic = 1,
                .ghosts = 2,
                .ghost_cells = galerkin_ghost_cells,
                .shows = PG_NEEDS_STRETCH | PG_NEEDS_STRESS | PG_NEEDS_FACETS,
                .read = galerkin_read,
                .support = galerkin_support,
                .limits = galerkin_limits,
                .support_stiffness = galerkin_support_stiffness,
                .words = galerkin_words },
    .create = galerkin_create,
    .free = galerkin_free,
    .fields = galerkin_fields,
    .refresh = galerkin_refresh,
    .balance = galerkin_balance,
    .mass = galerkin_mass,
    .operator_ = galerkin_operator,
    .matrix = galerkin_matrix,
    .basis = galerkin_basis,
    .impose = galerkin_impose,
    .judge = galerkin_judge_bonds,
    .work = galerkin_work,
    .field = galerkin_field,
    .census = galerkin_census, .join = galerkin_join, .loads = galerkin_loads_of,
    .revision = galerkin_revision,
    .sample = galerkin_sample,
    .estimate = galerkin_estimate,
        .surfaces = { .at_nodes = galerkin_at_nodes, .from_nodes = galerkin_from_nodes,
                  .surface = galerkin_surface, .jump = jump, .trace = trace },
    .spares = { .balance_lean = galerkin_balance_lean, .share_of = galerkin_share_of,
                .gather = galerkin_gather, .spared = spared,
                .change = galerkin_change_of, .elements = galerkin_elements }
};

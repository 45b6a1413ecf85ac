/* SPDX-License-Identifier: GPL-3.0-or-later
 * (k K + m M) delta = R, d <- d + delta, until R is small: one linear solve with iterative refinement, the
 * residual always taken from the force, never from K. With elimination d = T q + g the matrix is T' (k K + m
 * M) T and the residual T' R. Unknowns that breaking has touched get 1e-11 of the mean diagonal (isolated
 * nodes and loose fragments stay put); the refinement takes its effect out again wherever the body can carry
 * load. */
#include "body_parts.h"
#include "contact.h"
#include "event_solver.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* The matrix that was made for a factor is not needed any more: K has its own diagonal again, copies and what
 * constraints left of it go. */
static void let_go (pg_system *s)
{
    if (s->own_diagonal) {
        const pg_sparse *K = pg_force_matrix (s->force, s->self);
        for (size_t j = 0; j < s->ndof; j++) K->value[K->start[j + 1] - 1] = s->own_diagonal[j];
    }
    if (s->owned) pg_sparse_clear (&s->A);
    pg_free (s->own_diagonal), pg_free (s->copy);
    s->A = (pg_sparse) { 0 };
    s->own_diagonal = s->copy = NULL, s->owned = 0;
}

/* Frees what a system of equations holds, also where it was made in part only. */
void system_free (pg_system *s)
{
    let_go (s);
    if (s->factor) s->linear->free (&s->factor);
    event_solver_free (&s->following);
    contact_free (s);
    if (s->floating) body_parts_clear (s->floating), pg_free (s->floating);
    system_guess_free (s);
    system_forget_preconditioner (s);
    if (s->force && s->self) s->force->free (&s->self);
    pg_free (s->diagonal0), pg_free (s->mass), pg_free (s->whole),
        pg_free (s->bare);
    pg_free (s->residual), pg_free (s->reduced), pg_free (s->delta), pg_free (s->full), pg_free (s->best),
        pg_free (s->scratch), pg_free (s->touched), pg_free (s->factored), pg_free (s->hanging);
    pg_crack_paths_free (&s->paths), pg_crack_paths_free (&s->factored_paths);
    pg_free (s->rough.earlier), pg_free (s->rough.before), pg_free (s->rough.earlier_u);
    for (int k = 0; k < ROUGH_VIEWS; k++) pg_free (s->rough.view[k].delta), pg_free (s->rough.view[k].u);
    pg_free (s->fixed), pg_free (s->own_row), pg_free (s->cg_room.v);
}

/* A force may have a matrix in general, yet none for the options of this problem: dilatations reach
 * neighbours of neighbours, and only their product with K is known. */
int system_has_matrix (const pg_system *s)
{
    if (system_is_shared (s)) return 0;                /* each rank has its rows, and products with them */
    return pg_force_matrix (s->force, s->self) != NULL;
}
/* K as a product straight from the bonds; NULL: the force has none. */
static const pg_operator *operator_of (const pg_system *s)
{
    return s->force->operator_ ? s->force->operator_ (s->self) : NULL;
}

/* y = K x: by the operator where there is one, which needs no assembly, else by the matrix. */
void system_multiply (const pg_system *s, const double *x, double *y)
{
    const pg_operator *op = operator_of (s);
    if (op && s->whole) system_multiply_shared (s, op, x, y);
    else if (op) op->apply (op->context, x, y);
    else pg_sparse_multiply (pg_force_matrix (s->force, s->self), x, y);
}

/* Asks the force for its unknowns, its masses (kg, lumped) and its constraints, and chooses the linear
 * solver. nred: unknowns that constraints leave. All vectors are of full length, as reactions need every
 * residual. */
pg_status system_create (pg_system *s)
{
    pg_status status = PG_OK;
    pg_field field[8];
    PG_TRY (s->force->create (&s->self, s->problem));
    size_t nfield = s->force->fields (s->self, 8, field);
    for (size_t k = 0; k < nfield && k < 8; k++) s->components += field[k].components;
    s->ndof = s->problem->cloud.n * (size_t) s->components;
    const pg_sparse *T = s->force->basis ? s->force->basis (s->self) : NULL;
    s->nred = T ? T->ncol : s->ndof;
    PG_TRY (contact_create (s));
    s->stale = 1;
    if (!system_has_matrix (s) && !operator_of (s))
        PG_FAIL (PG_E_USAGE, "the force %s offers neither a matrix nor an operator", s->force->method.name);
    PG_ALLOC (s->scratch, s->ndof);
    PG_ALLOC (s->mass, s->ndof);
    PG_ALLOC (s->residual, s->ndof);
    PG_ALLOC (s->full, s->ndof);
    if (!(s->options->flags & PG_SOLVER_EXPLICIT)) {   /* what linear solves alone need */
        PG_ALLOC (s->reduced, s->ndof);
        PG_ALLOC (s->delta, s->ndof);
        PG_ALLOC (s->best, s->ndof);
        PG_ALLOC (s->diagonal0, s->ndof);
        if (system_is_shared (s)) PG_ALLOC (s->whole, s->ndof);
    }
    PG_ALLOC (s->touched, s->problem->cloud.n);
    if (s->force->mass) PG_TRY (s->force->mass (s->self, s->mass, NULL));
    int automatic = strcmp (s->options->linear, "auto") == 0;
    s->linear = automatic ? pg_linear_usual (1, 1) : pg_linear_find (s->options->linear);
    if (!s->linear) PG_FAIL (PG_E_USAGE, "there is no linear solver %s", s->options->linear);
done:
    return status;
}

/* Nodes of points that lack a bond. Of pre-cracks once: breaking changes the diagonal of such nodes, which is
 * how weak unknowns are found later, but the first K is already without the bonds across a pre-crack. */
void system_mark_touched (const pg_system *s, const unsigned char *bonds, unsigned char *touched)
{
    for (int set = 0; set < PG_BOND_SETS; set++) {
        const pg_family *f = &s->problem->rows[set].family;
        const unsigned char *alive = bonds + s->problem->first_bond[set];
        for (size_t p = 0; p < f->n; p++) {
            if (!memchr (alive + f->start[p], 0, f->start[p + 1] - f->start[p])) continue;
            for (size_t e = f->start[p]; e < f->start[p + 1]; e++) touched[f->node[e]] = 1;
        }
    }
}

/* A copy of cracks that grow, in its own memory. */
static pg_status copy_paths (const pg_system *s, pg_crack_paths **to, const pg_crack_paths *from)
{
    pg_status status = PG_OK;
    if (!from || !pg_problem_grows (s->problem)) return PG_OK;
    if (!*to) PG_TRY (pg_crack_paths_create (to, s->problem));
    PG_TRY (pg_crack_paths_copy (*to, from));
done:
    return status;
}

/* The force updates what broken bonds have touched. Where its revision says that this left K as it was
 * (bonds that do not enter K), the factor stays. K of ranks that share the body is another one where that of
 * any of them is: all call after a round of breaking. */
pg_status system_refresh (pg_system *s, const pg_state *state, const pg_changes *changes)
{
    double t0 = pg_seconds ();
    pg_status status = s->force->refresh ? s->force->refresh (s->self, state, changes) : PG_OK;
    if (!changes && !s->marked) system_mark_touched (s, state->alive, s->touched), s->marked = 1;
    s->alive = state->alive;
    if (status == PG_OK) status = copy_paths (s, &s->paths, state->paths);
    unsigned long now = s->force->revision ? s->force->revision (s->self) : s->revision + 1;
    double other = now != s->revision;
    if (changes && (s->options->flags & PG_SOLVER_IMPLICIT)) other = system_most (s, other);
    if (other != 0) s->stale = 1, s->guess.fresh = 0;
    else s->kept++;
    if (changes && now != s->revision) ways_note_broken (s, changes->n);
    s->revision = now;
    s->report->updates += changes != NULL;
    if (status == PG_OK) status = system_note_change (s);
    if (status == PG_OK) status = contact_refresh (s, state, changes);
    s->report->seconds[changes ? PG_SECONDS_UPDATE : PG_SECONDS_SHAPE] += pg_seconds () - t0;
    return status;
}

/* The matrix is another one from here on, with or without inertia, whatever K does. A factor of the old one
 * is no preconditioner of the new one: its next use makes a new one. */
void system_switch (pg_system *s, int mode)
{
    s->mode = mode, s->stale = 1, s->guess.n = 0;
    s->extra_cost = mode == SYSTEM_KEPT_FACTOR ? 1e300 : 0;
    if (s->following) event_solver_drop (s->following);
    system_forget_preconditioner (s);
    s->remake = 0;
}

/* The bonds that live when a factor or preconditioner is made, and the cracks: a resumed run makes the same
 * ones again from them, bit by bit. */
pg_status system_remember_alive (pg_system *s)
{
    pg_status status = PG_OK;
    size_t nbond = s->problem->first_bond[PG_BOND_SETS];
    if (!s->alive) return PG_OK;
    if (!s->factored) PG_ALLOC (s->factored, nbond);
    memcpy (s->factored, s->alive, nbond);
    PG_TRY (copy_paths (s, &s->factored_paths, s->paths));
done:
    return status;
}

/* Mean of the first diagonal without entries above `most`, N/m; of their logarithms where `most` is infinite
 * (without zeros): the geometric mean. */
static double mean_of_diagonal (pg_system *s, double most)
{
    const pg_subdomain *part = s->problem->cloud.subdomain;
    double sum = 0, number = 0;
    int logarithms = isinf (most);
    for (size_t j = 0; j < s->ndof; j++) {
        double k = s->diagonal0[j];
        if (!pg_owns (part, j / (size_t) s->components) || k > most || (logarithms && !(k > 0))) continue;
        sum += logarithms ? log (k) : k, number++;
    }
    sum = system_sum (s, sum), number = system_sum (s, number);
    return number > 0 ? logarithms ? exp (sum / number) : sum / number : 0;
}

/* The first diagonal and its mean, N/m: they tell which unknowns have become weak, and how large forces
 * of rounding are. Penalties on a few points, a million times as stiff, are not in the mean. */
void system_remember_diagonal (pg_system *s, const pg_sparse *K)
{
    const double stiff = 1e3;
    const pg_operator *op = operator_of (s);
    if (s->mean_diagonal > 0) return;
    for (size_t j = 0; K && j < s->ndof; j++) s->diagonal0[j] = K->value[K->start[j + 1] - 1];
    if (!K) op->diagonal (op->context, s->diagonal0);
    s->mean_diagonal = mean_of_diagonal (s, stiff * mean_of_diagonal (s, INFINITY));
}

/* The values that a matrix is made in: of K at rest those of K itself, whose diagonal is kept meanwhile, else
 * a copy. Solvers without a factor keep looking at what they were given. */
static pg_status take_values (pg_system *s, const pg_sparse *K, const dynamics *dyn, double **value)
{
    pg_status status = PG_OK;
    int copies = dyn || s->options->plain || !s->linear->factors;
    *value = K->value;
    if (copies) {
        PG_ALLOC (s->copy, (size_t) K->start[s->ndof]);
        *value = s->copy;
        goto done;
    }
    PG_ALLOC (s->own_diagonal, s->ndof);
    for (size_t j = 0; j < s->ndof; j++) s->own_diagonal[j] = K->value[K->start[j + 1] - 1];
done:
    return status;
}

/* value = k K + m M, and a shift on weak unknowns: those of touched nodes, those without stiffness from
 * the start, and those whose diagonal has changed. Next to no stiffness from the start is shifted by a share
 * of itself, which refinement can take out again. With a mass nothing is singular but what has no mass
 * either. */
static void combine (pg_system *s, const pg_sparse *K, const dynamics *dyn, double *value)
{
    double k = dyn ? dyn->k : 1, m = dyn ? dyn->m : 0;
    for (long q = 0; value != K->value && q < K->start[s->ndof]; q++) value[q] = k * K->value[q];
    for (size_t j = 0; j < s->ndof; j++) {
        long q = K->start[j + 1] - 1;
        double now = K->value[q], first = s->diagonal0[j];
        int weak = s->touched[j / (size_t) s->components] || !(first > 1e-9 * s->mean_diagonal)
                   || fabs (now - first) > 1e-12 * first;
        int gone = !(now > 1e-12 * fmax (first, 1e-9 * s->mean_diagonal));
        if (m == 0 && weak && s->shift == 0 && gone)
            value[q] += first > 1e-9 * s->mean_diagonal ? first : s->mean_diagonal;
        else if (m == 0 && weak)
            value[q] += s->shift * (gone || first > 1e-9 * s->mean_diagonal ? s->mean_diagonal : now);
    }
    if (m == 0) loose_matrix (s, K, value);
    if (m != 0) system_add_mass_matrix (s, m, K, value);
    /* a point that no evaluation point sees has no consistent mass either */
    for (size_t j = 0; j < s->ndof && m != 0; j++) {
        long q = K->start[j + 1] - 1;
        if (!(fabs (value[q]) > 1e-11 * k * s->mean_diagonal)) value[q] += 1e-11 * k * s->mean_diagonal;
    }
}

/* Frees the matrix made for a factor; K too at rest where nothing breaks: one factor serves the whole run. */
static void let_all_go (pg_system *s, const dynamics *dyn)
{
    let_go (s);
    const pg_sparse *K;
    if (dyn || s->problem->criterion->type || s->options->plain || s->contact || !operator_of (s)) return;
    s->forgotten = s->force->matrix (s->self, PG_MATRIX_FREED, &K) == PG_OK && !K->value;
}

/* Assembles K, adds mass and shift, and takes out what constraints eliminate (T' K T). Without constraints
 * the pattern is that of K, which is borrowed. */
static pg_status build_matrix (pg_system *s, const dynamics *dyn)
{
    pg_status status = PG_OK;
    const pg_sparse *K, *T = s->force->basis ? s->force->basis (s->self) : NULL;
    PG_TRY (pg_force_assemble (s->force, s->self, &K));
    pg_sparse full = *K;
    system_remember_diagonal (s, K);
    let_go (s);
    PG_TRY (take_values (s, K, dyn, &full.value));
    combine (s, K, dyn, full.value);
    if (!T) s->A = full;
    else {
        pg_sparse reduced;
        PG_TRY (pg_sparse_congruence (&reduced, &full, T));
        let_all_go (s, dyn);
        s->A = reduced, s->owned = 1;
    }
done:
    return status;
}

/* For solvers that tell when they have read the matrix. */
typedef struct { pg_system *s; const dynamics *dyn; } matrix_owner;
static void taken (void *context)
{
    const matrix_owner *o = context;
    let_all_go (o->s, o->dyn);
}

/* The values of A go as soon as the solver has them, if it has a factor of its own. */
static pg_status make_factor (pg_system *s, const dynamics *dyn)
{
    matrix_owner owner = { s, dyn };
    if (!s->linear->factors) return s->linear->factor (s->factor, &s->A);
    pg_status status = s->linear->factor_taking && !s->options->plain
                           ? s->linear->factor_taking (s->factor, &s->A, taken, &owner)
                           : s->linear->factor (s->factor, &s->A);
    let_go (s);
    return status;
}

/* Ordering and symbolic factor, once: breaking only removes entries. After elimination unknowns no longer
 * come in blocks of a node. */
static pg_status analyse (pg_system *s)
{
    pg_status status = PG_OK;
    double t0 = pg_seconds ();
    int reduced = s->nred != s->ndof;
    pg_linear_options o = { reduced ? 1 : s->components, s->problem->dim, s->problem->threads,
                            0.01 * s->options->tolerance, s->problem->criterion->type != NULL };
    int free = strcmp (s->options->linear, "auto") == 0 && !s->options->plain;
    if (free) PG_TRY (pg_linear_analyse (&s->linear, &s->factor, &s->A, &o));
    else PG_TRY (s->linear->analyse (&s->factor, &s->A, &o));
    pg_linear_info info;
    s->linear->info (s->factor, &info);
    s->report->factor_entries = info.factor_entries, s->report->factor_flops = info.flops;
    strncpy (s->report->ordering, info.ordering, sizeof s->report->ordering - 1);
    strncpy (s->report->solver, s->linear->name, sizeof s->report->solver - 1);
done:
    s->report->seconds[PG_SECONDS_ANALYSE] += pg_seconds () - t0;
    return status;
}

/* The smallest pivot of the last factorization over the largest: parts that nothing holds leave one of the
 * size of rounding. */
static double pivots (const pg_system *s)
{
    pg_linear_info info;
    s->linear->info (s->factor, &info);
    return info.pivots;
}
static const double least_pivot = 1e-13;

/* Nodes of parts that supports do not hold count as touched. 1: there are such parts. */
static int touch_free_parts (pg_system *s)
{
    body_parts parts;
    int any = 0;
    if (body_parts_find (&parts, s) != PG_OK) return 0;
    for (size_t i = 0; i < s->problem->cloud.n && parts.n; i++)
        if (parts.part[parts.of[i]].n) s->touched[i] = 1, any = 1;
    body_parts_clear (&parts);
    return any;
}

/* No bond has negative energy, but those of a chain or a sheet leave motions free. So do supports that hold
 * a part of the body along some axes only, or not at all: rounding decides whether such a matrix passes for
 * positive definite. These unknowns get the shift, once; loads that need no support are in balance all the
 * same, which the residual tells. */
static int weaken_all (pg_system *s, const dynamics *dyn)
{
    if (s->all_weak) return 0;
    if (s->problem->sums) memset (s->touched, 1, s->problem->cloud.n);
    else if (dyn || !touch_free_parts (s)) return 0;
    s->all_weak = 1, s->shift = WEAK_SPRING;
    return 1;
}

/* Factors. Where the factor serves many events the springs of weak unknowns would show in all of them: they
 * are left out as long as no part is loose, and unknowns without stiffness, which nothing is coupled to, get
 * their old one. A matrix that is not positive definite gets a larger shift on its weak unknowns (1e-11,
 * 1e-9, 1e-7 of the mean diagonal), then on all of them where bonds (chains, sheets) or supports leave
 * motions free; other Galerkin forms go to a solver for general matrices under linear: auto, as terms of
 * Nitsche with too small a factor make K indefinite. */
pg_status system_factorize (pg_system *s, const dynamics *dyn)
{
    pg_status status = PG_OK;
    int automatic = strcmp (s->options->linear, "auto") == 0;
    int try = s->serves && !s->loose && !dyn && !s->indefinite;
    s->shift = try ? 0 : WEAK_SPRING;
    for (;;) {
        double t0 = pg_seconds ();
        PG_TRY (build_matrix (s, dyn));
        s->report->seconds[PG_SECONDS_ASSEMBLE] += pg_seconds () - t0;
        if (!s->factor) PG_TRY (analyse (s));
        t0 = pg_seconds ();
        pg_status now = make_factor (s, dyn);
        s->report->factorizations++;
        s->report->seconds[PG_SECONDS_FACTOR] += pg_seconds () - t0;
        if (now == PG_OK && !(s->shift == 0 && pivots (s) < least_pivot)) break;
        if (now != PG_E_NOT_SPD) PG_TRY (now);
        if (s->shift == 0) {
            s->shift = WEAK_SPRING, s->loose = 1;
            continue;
        }
        if (s->shift < 1e-8) {
            s->shift *= 100;
            continue;
        }
        if (weaken_all (s, dyn)) continue;
        if (s->problem->sums)
            PG_FAIL (
                PG_E_NOT_SPD,
                "%s; bonds leave parts of the body free to move: constrain them, or set solver.linear: %s",
                pg_last_error (), pg_linear_first (1, 0)->name);
        if (!automatic || s->indefinite)
            PG_FAIL (PG_E_NOT_SPD,
                     "%s; with essential: nitsche raise method.nitsche_factor, or set solver.linear: %s",
                     pg_last_error (), pg_linear_first (0, 1)->name);
        pg_statistics_warn (s->report,
                            "K is not positive definite: UMFPACK instead of Cholesky from step %ld on (with "
                            "essential: nitsche, a larger "
                            "method.nitsche_factor may help)",
                            s->report->steps);
        s->linear->free (&s->factor);
        s->linear = pg_linear_first (0, 1);
        s->indefinite = 1;
    }
    s->stale = 0;
    s->unshifted = s->shift < 1e-10;
    PG_TRY (system_remember_alive (s));
done:
    if (status != PG_OK) let_go (s);
    return status;
}

/* ---- solving ------------------------------------------------------------------------------------------- */
/* A plain factor serves again and again; one that costs more than this many of its solves is worth keeping
 * when K has changed a little. */
static const double worth_keeping = 15;

/* Seconds by stored rates: supernodal factorization, triangular solve, K x without a matrix. Never measured:
 * a run must not depend on the clock. */
double system_factor_cost (const pg_system *s) { return s->report->factor_flops / 20e9; }
/* Four passes over the factor: two triangular solves, each read twice over a refinement. */
double system_solve_cost (const pg_system *s) { return 4 * s->report->factor_entries / 3e9; }
/* Factors where K has changed, then two triangular solves. A factor that is dear against its solves is
 * kept as a preconditioner from then on, as a few broken bonds change K little. */
pg_status system_solve_by_factor (pg_system *s, const dynamics *dyn)
{
    pg_status status = PG_OK;
    if (s->stale) PG_TRY (system_factorize (s, dyn));
    double t0 = pg_seconds ();
    pg_linear_info info;
    PG_TRY (s->linear->solve (s->factor, 1, s->reduced, s->delta));
    s->linear->info (s->factor, &info);
    s->report->cg_iterations += info.iterations - s->matrix_iterations;
    s->matrix_iterations = info.iterations;
    s->report->seconds[PG_SECONDS_SOLVE] += pg_seconds () - t0;
    int keep = operator_of (s) && strcmp (s->options->linear, "auto") == 0 && !s->indefinite && s->unshifted;
    if (keep && !(s->contact && s->contact->loose.n)
        && system_factor_cost (s) > worth_keeping * system_solve_cost (s)) {
        s->mode = SYSTEM_KEPT_FACTOR;
        PG_TRY (system_follow (s, dyn));
    }
done:
    return status;
}

enum { FEW_ITERATIONS = 40 };

/* Says what was spared, and why. */
static void tell_small_step (pg_system *s, size_t used)
{
    char why[160];
    snprintf (why, sizeof why,
              "the time step is small, so that the mass dominates: %zu iterations of conjugate gradients did "
              "in the first step",
              used);
    pg_statistics_skip (s->report, NAN, "stiffness matrix, analysis and factorization", why);
}

/* Iterations by the diagonal where the better preconditioner failed: probably a loaded part has come loose.
 * Small bodies have as many as they could need, for so many seconds. */
enum { LAST_TRY = 2000 };
static const double LAST_SECONDS = 3;
/* a factor that takes longer is none to fall back to */
static const double MOST_SECONDS = 600;

/* Finite elements fitted badly, and nothing converged: a factor instead from now on, where it can be had at
 * all. */
static int falls_back (pg_system *s)
{
    if (!s->force->spares.elements || !system_has_matrix (s) || strcmp (s->options->linear, "auto") != 0
        || system_direct_cost (s) > MOST_SECONDS)
        return 0;
    pg_statistics_warn (s->report, "the iterations with finite elements as preconditioner do not converge: a "
                                   "factor of K from step %ld on", s->report->steps);
    system_forget_preconditioner (s);
    s->mode = SYSTEM_FACTOR, s->stale = 1, s->report->preconditioner[0] = 0;
    memset (s->delta, 0, s->nred * sizeof *s->delta);
    return 1;
}

/* Where the diagonal does, it stays (until it has cost more, leave_diagonal). Else large solids take finite
 * elements, as at rest, and so does what has no matrix to be factored. */
static pg_status after_trial (pg_system *s, const dynamics *dyn, int did)
{
    pg_status status = PG_OK;
    int can, factors = system_has_matrix (s) && s->linear->factors;
    PG_TRY (system_can_precondition (s, dyn, &can));
    pg_solve_counts c = pg_solve_count (s->problem);
    s->mode = did ? (can ? SYSTEM_DIAGONAL : SYSTEM_NO_FACTOR)
              : can && (!factors || pg_solve_by_elements (&c, 1, 0, 1)) ? SYSTEM_NO_FACTOR
                                                                         : SYSTEM_FACTOR;
done:
    return status;
}

/* Leaves the diagonal where ranks share the body, counted in iterations: for a preconditioner of several
 * levels, when those beyond a few would have paid for it. */
enum { SHARED_SET_UP = 150 };
static pg_status leave_for_shared (pg_system *s, const dynamics *dyn, size_t used)
{
    pg_status status = PG_OK;
    int can;
    PG_TRY (system_can_precondition (s, dyn, &can));
    if (used > FEW_ITERATIONS) s->extra_cost += (double) (used - FEW_ITERATIONS);
    if (!can || s->extra_cost <= SHARED_SET_UP) goto done;
    s->mode = SYSTEM_NO_FACTOR, s->stale = 1, s->extra_cost = 0;
done:
    return status;
}

/* In motion the diagonal did in the first step. Breaking may change that: nodes that few points see are
 * light, rows of few bonds stiff. When the iterations beyond a few have cost as much as a factor (rent or
 * buy, counted), something better is taken for good. */
static pg_status leave_diagonal (pg_system *s, const dynamics *dyn, size_t used)
{
    pg_status status = PG_OK;
    if (dyn && system_is_shared (s)) return leave_for_shared (s, dyn, used);
    if (!dyn || strcmp (s->options->linear, "auto") != 0 || !system_has_matrix (s) || s->problem->sums
        || !s->linear->factors || s->options->plain)
        return PG_OK;
    if (used > FEW_ITERATIONS) s->extra_cost += (double) (used - FEW_ITERATIONS) * system_apply_cost (s);
    if (s->extra_cost <= system_direct_cost (s)) return PG_OK;
    PG_TRY (after_trial (s, dyn, 0));
    s->stale = 1, s->extra_cost = 0;
done:
    return status;
}

/* Conjugate gradients with a preconditioner of several levels where it can be made, else with the diagonal.
 * Where the better one fails, the diagonal has a last, limited try: mostly a loaded part has come loose,
 * and nothing converges. */
static pg_status solve_without_factor (pg_system *s, const dynamics *dyn, double tolerance)
{
    pg_status status = PG_OK;
    size_t used = 0, limit = 20 * s->ndof + 1000;
    int can;
    PG_TRY (system_can_precondition (s, dyn, &can));
    can = can && s->mode != SYSTEM_DIAGONAL;
    if (can) {
        pg_status now = system_iterate_preconditioned (s, dyn, tolerance);
        if (now != PG_E_EQUILIBRIUM && now != PG_E_NOT_SPD) return now;
        if (falls_back (s)) return PG_OK;
        limit = (size_t) fmin ((double) limit, fmax (LAST_TRY, LAST_SECONDS / system_apply_cost (s)));
    }
    PG_TRY (system_iterate (s, dyn, BY_DIAGONAL, tolerance, limit, &used));
    if (!can) PG_TRY (leave_diagonal (s, dyn, used));
done:
    return status;
}

/* One linear solve by the way that was chosen; a trial decides between iterations and a factor. */
pg_status system_solve_once (pg_system *s, const dynamics *dyn, double tolerance)
{
    pg_status status = PG_OK;
    size_t used = 0, before = s->report->cg_iterations;
    if (s->mode == SYSTEM_UNDECIDED) PG_TRY (system_choose (s, dyn));
    PG_TRY (ways_choose (s, dyn));
    if (s->mode == SYSTEM_TRIAL) {
        pg_status now = system_iterate (s, dyn, BY_DIAGONAL, tolerance, FEW_ITERATIONS, &used);
        if (now != PG_OK && now != PG_E_EQUILIBRIUM && now != PG_E_NOT_SPD) PG_TRY (now);
        PG_TRY (after_trial (s, dyn, now == PG_OK));
        if (now == PG_OK) {
            tell_small_step (s, used);
            goto done;
        }
        memset (s->delta, 0, s->nred * sizeof *s->delta);
    }
    if (s->mode == SYSTEM_NO_FACTOR || s->mode == SYSTEM_DIAGONAL)
        PG_TRY (solve_without_factor (s, dyn, tolerance));
    if (s->mode == SYSTEM_KEPT_FACTOR) PG_TRY (system_solve_by_kept_factor (s, dyn, tolerance));
    else if (s->mode == SYSTEM_FACTOR) PG_TRY (system_solve_by_factor (s, dyn));
    if (dyn) ways_count (s, s->report->cg_iterations - before);
done:
    s->report->solves += status == PG_OK;
    return status;
}

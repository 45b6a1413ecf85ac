/* SPDX-License-Identifier: GPL-3.0-or-later
 * What later steps depend on, walked over once for writing and for reading back: the state (also that at the
 * start of a step in its middle), energies, counts, what a method carries from step to step. Caches are not
 * kept: they are functions of the bonds and the cracks, made again in the same order. The factor of an
 * earlier K is one of them: it is made again from the bonds that lived then, and the cracks of then. */
#include "contact.h"
#include "inverse.h"
#include "facet_growth.h"
#include <string.h>

static const long most = 1L << 50;                     /* of any count */
/* Bytes that are 0 or 1: anything else in a file is a fault, as they are used in arithmetic. */
static pg_status keep_flags (const char *name, size_t n, unsigned char *flag, const pg_keeper *k)
{
    pg_status status = PG_OK;
    PG_TRY (k->bytes (k->context, name, n, flag));
    for (size_t i = 0; k->reading && i < n; i++) PG_KEEP_BOUND (k, name, flag[i], 0, 1);
done:
    return status;
}

/* A text of fixed size, ended whatever was read. */
pg_status keep_text (const char *name, size_t size, char *text, const pg_keeper *k)
{
    pg_status status = k->bytes (k->context, name, size, text);
    if (k->reading) text[size - 1] = 0;
    return status;
}

/* All of a state: counts, times, displacement, velocity, acceleration, the alive bit of every bond, cracks.
 * `name` tells the state at hand from that at the start of the step. */
static pg_status keep_state (pg_state *s, const pg_problem *p, const char *name, const pg_keeper *k)
{
    pg_status status = PG_OK;
    char part[64];
    /* Numbers of one kind go in one array, so that the file has few variables. Every name in the file is
     * that of the state and a suffix. */
    long count[5] = { s->step, s->events, s->iterations, s->broken, s->history_rows };
    double number[3] = { s->time, s->factor, s->work };
    double *vector[3] = { s->d, s->v, s->a };
    static const char *const vectors[3] = { "d", "v", "a" };
#define PART(suffix) (strcpy (part, name), strcat (part, suffix))
    PG_TRY (k->counts (k->context, PART (".counts"), 5, count));
    PG_TRY (k->numbers (k->context, PART (".numbers"), 3, number));
    for (int i = 0; i < 5; i++) PG_KEEP_BOUND (k, name, count[i], 0, most);
    s->step = count[0], s->events = count[1], s->iterations = count[2], s->broken = count[3],
    s->history_rows = count[4];
    s->time = number[0], s->factor = number[1], s->work = number[2];
    for (int v = 0; v < 3; v++) {
        PART (".");
        PG_TRY (k->numbers (k->context, strcat (part, vectors[v]), s->ndof, vector[v]));
    }
    PG_TRY (keep_flags (PART (".alive"), s->nbond, s->alive, k));
    if (s->paths) PG_TRY (pg_crack_paths_keep (s->paths, p, PART (".paths"), k));
    if (s->surfaces) PG_TRY (pg_crack_surfaces_keep (s->surfaces, p, PART (".surfaces"), k));
#undef PART
done:
    return status;
}

/* A list of broken bonds, and the problem that they belong to. */
typedef struct { const pg_problem *p; pg_broken *broken; } broken_list;

static void give_bond (void *context, size_t i, long *count, double *number)
{
    const pg_broken *b = &((broken_list *) context)->broken[i];
    count[0] = (long) b->bond, count[1] = b->set, count[2] = b->kind, count[3] = b->round;
    number[0] = b->utilisation, number[1] = b->time;
    memcpy (number + 2, b->place, 3 * sizeof *number);
}

static pg_status take_bond (void *context, size_t i, const long *count, const double *number,
                            const pg_keeper *k)
{
    pg_status status = PG_OK;
    const broken_list *list = context;
    PG_KEEP_BOUND (k, "the set of a broken bond", count[1], 0, PG_BOND_SETS - 1);
    PG_KEEP_BOUND (k, "a broken bond", count[0], 0, (long) list->p->first_bond[PG_BOND_SETS] - 1);
    PG_KEEP_BOUND (k, "the kind of a broken bond", count[2], 0, 127);
    PG_KEEP_BOUND (k, "the round of a broken bond", count[3], 0, most);
    list->broken[i] = (pg_broken){
        (size_t) count[0], (int) count[1], (char) count[2], number[0], { number[2], number[3], number[4] },
        number[1], count[3]
    };
done:
    return status;
}

pg_status pg_broken_keep (const pg_problem *p, const char *name, size_t n, pg_broken *broken,
                          const pg_keeper *k)
{
    broken_list list = { p, broken };
    char bonds[64], values[64];
    snprintf (bonds, sizeof bonds, "%s.bonds", name), snprintf (values, sizeof values, "%s.values", name);
    const pg_records records = { .count_name = bonds, .number_name = values, .n = n, .counts = 4,
                                 .numbers = 5, .give = give_bond, .take = take_bond, .context = &list };
    return pg_keep_records (k, &records);
}

/* Counts, numbers and texts of the report, seconds too: those of the run so far, so that a resumed run
 * reports the whole of it. Numbers of entries are bounded before they are used. */
pg_status keep_report (pg_statistics *r, const pg_keeper *k)
{
    pg_status status = PG_OK;
    long *const word[] = { &r->steps,           &r->events,           &r->iterations,
                           &r->broken,          &r->bonds_over_limit, &r->factorizations,
                           &r->updates,         &r->solves,           &r->preconditioners,
                           &r->contact_columns, &r->contact_solves,   &r->contact_changes,
                           &r->balances };
    size_t *const size[6] = { &r->cg_iterations, &r->degenerate_points, &r->isolated_nodes,
                              &r->fragments,     &r->nskipped,          &r->nwarning };
    double *const value[] = { &r->utilisation_max, &r->residual_max,    &r->overlap_max,
                              &r->energy_strain,   &r->energy_kinetic,  &r->energy_external,
                              &r->energy_damping,  &r->energy_dissipated, &r->factor_entries,
                              &r->factor_flops,    &r->energy_fracture, &r->energy_friction,
                              &r->contact_overlap, &r->energy_contact,  &r->contact_seconds,
                              &r->balance_force,   &r->balance_moment };
    enum {
        VALUES = sizeof value / sizeof *value,
        WORDS = sizeof word / sizeof *word,
        SKIPS = sizeof r->skipped / sizeof *r->skipped,
        WARNINGS = sizeof r->warning / sizeof *r->warning
    };
    long count[WORDS + 6];
    double number[VALUES + PG_SECONDS_COUNT], saved[SKIPS];
    /* Gathered, given to the keeper, and spread again: when writing the keeper leaves them as they are,
     * so that spreading changes nothing. */
    for (int i = 0; i < WORDS; i++) count[i] = *word[i];
    for (int i = 0; i < 6; i++) count[WORDS + i] = (long) *size[i];
    for (int i = 0; i < VALUES; i++) number[i] = *value[i];
    memcpy (number + VALUES, r->seconds, sizeof r->seconds);
    PG_TRY (k->counts (k->context, "report.counts", WORDS + 6, count));
    PG_TRY (k->numbers (k->context, "report.numbers", VALUES + PG_SECONDS_COUNT, number));
    for (int i = 0; i < WORDS + 4; i++) PG_KEEP_BOUND (k, "a count of the report", count[i], 0, most);
    PG_KEEP_BOUND (k, "the number of skipped things", count[WORDS + 4], 0, SKIPS);
    PG_KEEP_BOUND (k, "the number of warnings", count[WORDS + 5], 0, WARNINGS);
    for (int i = 0; i < WORDS; i++) *word[i] = count[i];
    for (int i = 0; i < 6; i++) *size[i] = (size_t) count[WORDS + i];
    for (int i = 0; i < VALUES; i++) *value[i] = number[i];
    memcpy (r->seconds, number + VALUES, sizeof r->seconds);
    PG_TRY (keep_text ("report.ordering", sizeof r->ordering, r->ordering, k));
    PG_TRY (keep_text ("report.solver", sizeof r->solver, r->solver, k));
    PG_TRY (keep_text ("report.preconditioner", sizeof r->preconditioner, r->preconditioner, k));
    for (size_t i = 0; i < SKIPS; i++) saved[i] = r->skipped[i].seconds_saved;
    PG_TRY (k->numbers (k->context, "report.saved", SKIPS, saved));
    for (size_t i = 0; i < SKIPS; i++) {
        char part[64];
        r->skipped[i].seconds_saved = saved[i];
        snprintf (part, sizeof part, "report.skipped.%zu", i);
        PG_TRY (keep_text (part, sizeof r->skipped[i].what, r->skipped[i].what, k));
        snprintf (part, sizeof part, "report.why.%zu", i);
        PG_TRY (keep_text (part, sizeof r->skipped[i].why, r->skipped[i].why, k));
    }
    for (size_t i = 0; i < WARNINGS; i++) {
        char part[64];
        snprintf (part, sizeof part, "report.warning.%zu", i);
        PG_TRY (keep_text (part, sizeof r->warning[i], r->warning[i], k));
    }
done:
    return status;
}

/* Bonds that died in the step at hand, which is in its middle. */
static pg_status keep_broken (break_loop *b, const pg_problem *p, const pg_keeper *k)
{
    pg_status status = PG_OK;
    long n = (long) b->nbroken;
    PG_TRY (k->counts (k->context, "solver.broken_count", 1, &n));
    PG_KEEP_BOUND (k, "the number of broken bonds", n, 0, (long) p->first_bond[PG_BOND_SETS]);
    if (k->reading) {
        PG_GROW (b->broken, b->cap_broken, (size_t) n);
        b->nbroken = (size_t) n;
    }
    if (n > 0) PG_TRY (pg_broken_keep (p, "solver.broken", (size_t) n, b->broken, k));
done:
    return status;
}

/* Bonds near their limit, as the last look in the step at hand has found them: the next round asks these
 * first. */
static pg_status keep_near (break_loop *b, const pg_keeper *k)
{
    pg_status status = PG_OK;
    long n = b->round > 0 ? (long) b->over.n : 0, *bond = NULL,
         nbond = (long) b->system.problem->first_bond[PG_BOND_SETS];
    PG_TRY (k->counts (k->context, "solver.near_count", 1, &n));
    PG_KEEP_BOUND (k, "the number of bonds near their limit", n, 0, b->round > 0 ? nbond : 0);
    if (n == 0) goto done;
    PG_ALLOC (bond, (size_t) n);
    for (long i = 0; i < n && !k->reading; i++) bond[i] = (long) b->over.bond[i];
    PG_TRY (k->counts (k->context, "solver.near", (size_t) n, bond));
    if (!k->reading) goto done;
    PG_GROW (b->over.bond, b->over.cap, (size_t) n);
    for (long i = 0; i < n; i++) {
        PG_KEEP_BOUND (k, "a bond near its limit", bond[i], i ? bond[i - 1] + 1 : 0, nbond - 1);
        b->over.bond[i] = (size_t) bond[i];
    }
    b->over.n = (size_t) n;
done:
    pg_free (bond);
    return status;
}

/* Forces and displacements of the last accounted states, between which work is summed. pairs: how many a
 * balance of this problem has, -1: none; only that number is accepted. */
static pg_status keep_work_balance (pg_work_balance *l, const char *name, size_t nload, long pairs,
                                    int reactions, const pg_keeper *k)
{
    pg_status status = PG_OK;
    char part[64];
    long count[2] = { l->force != NULL ? (long) l->npair : -1, l->reaction != NULL };
    strcat (strcpy (part, name), ".counts");
    PG_TRY (k->counts (k->context, part, 2, count));
    PG_KEEP_BOUND (k, part, count[0], count[0] < 0 ? -1 : pairs, count[0] < 0 ? -1 : pairs);
    if (count[0] < 0) goto done;
    PG_KEEP_BOUND (k, part, count[1], reactions, 1);
    if (k->reading) {
        pg_work_balance_clear (l);
        l->npair = (size_t) count[0];
        PG_ALLOC (l->force, l->npair);
        PG_ALLOC (l->displacement, l->npair);
        if (count[1]) PG_ALLOC (l->reaction, PG_REACTIONS * nload);
    }
    strcat (strcpy (part, name), ".force");
    if (count[0] > 0) PG_TRY (k->numbers (k->context, part, (size_t) count[0], l->force));
    strcat (strcpy (part, name), ".displacement");
    if (count[0] > 0) PG_TRY (k->numbers (k->context, part, (size_t) count[0], l->displacement));
    strcat (strcpy (part, name), ".reaction");
    if (count[1] && nload) PG_TRY (k->numbers (k->context, part, PG_REACTIONS * nload, l->reaction));
    strcat (strcpy (part, name), ".strain");
    PG_TRY (k->numbers (k->context, part, 1, &l->strain));
done:
    return status;
}

/* Does the force offer K x without a matrix? */
static int operates (const pg_system *s) { return s->force->operator_ && s->force->operator_ (s->self); }

/* Cracks in the plane of the moment in which `factored` lived. */
static pg_status keep_earlier_paths (pg_system *s, const pg_keeper *k)
{
    pg_status status = PG_OK;
    if (s->problem->dim != 2 || !pg_problem_grows (s->problem)) return PG_OK;
    if (!s->direct.factored_paths) PG_TRY (pg_crack_paths_create (&s->direct.factored_paths, s->problem));
    PG_TRY (pg_crack_paths_keep (s->direct.factored_paths, s->problem, "system.paths", k));
done:
    return status;
}

/* The multilevel preconditioner and the factor of an earlier K are caches: what is kept is which bonds lived
 * when they were made (`factored`) and the cracks of that moment, from which they are made again. */
static pg_status keep_preconditioner (pg_system *s, int solves, long factored, const pg_keeper *k)
{
    system_iterations *it = &s->iterative;
    pg_status status = PG_OK;
    size_t nbond = s->problem->first_bond[PG_BOND_SETS];
    long made = system_has_preconditioner (s) || it->remake;
    int can = solves && (s->force->spares.couplings || s->force->spares.elements) && operates (s) && factored;
    PG_TRY (k->counts (k->context, "system.multilevel", 1, &made));
    PG_KEEP_BOUND (k, "the multilevel preconditioner", made, 0, can ? 1 : 0);
    PG_KEEP_BOUND (k, "a factor of the bonds", made ? 0 : factored, 0, system_has_matrix (s) ? 1 : 0);
    PG_TRY (k->numbers (k->context, "system.pace", 1, &it->pace));
    PG_TRY (k->numbers (k->context, "system.made", 2, it->made));
    PG_TRY (k->numbers (k->context, "system.borne", 1, &s->balance.borne));
    if (k->reading) {                                  /* the start of the run may have made one */
        system_forget_preconditioner (s);
        it->remake = made != 0;
    }
    if (k->reading && factored && !s->direct.factored) PG_ALLOC (s->direct.factored, nbond);
    if (factored) PG_TRY (keep_flags ("system.factored", nbond, s->direct.factored, k));
    if (factored) PG_TRY (keep_earlier_paths (s, k));
done:
    return status;
}

/* What has broken since the factor of a motion was made. */
static pg_status keep_following (pg_system *s, const pg_keeper *k)
{
    system_updates *u = &s->updates;
    pg_status status = PG_OK;
    long count = u->following && s->choice.mode == SYSTEM_KEPT_FACTOR;
    PG_TRY (k->counts (k->context, "system.following", 1, &count));
    PG_KEEP_BOUND (k, "what follows a factor", count, 0, s->choice.mode == SYSTEM_KEPT_FACTOR ? 1 : 0);
    if (!count && k->reading) inverse_free (&u->following);
    if (count && !u->following) PG_TRY (inverse_create (&u->following, s, INVERSE_HALVES));
    if (count && u->following) PG_TRY (inverse_keep (u->following, k));
done:
    return status;
}

/* What a factor and finite elements have cost in this motion, and how well rough solutions did. */
static pg_status keep_ways (pg_ways *w, pg_rough *rough, const pg_keeper *k)
{
    pg_status status = PG_OK;
    long count[4] = { w->meanwhile, w->solves, rough->rounds, rough->again };
    double number[7] = { w->regret, w->iterations, w->breaking, w->bonds, w->fresh, w->spent, rough->share };
    PG_TRY (k->counts (k->context, "system.ways", 4, count));
    PG_TRY (k->numbers (k->context, "system.ways.seconds", 7, number));
    PG_KEEP_BOUND (k, "whether elements stand in for a factor", count[0], 0, 1);
    PG_KEEP_BOUND (k, "solves in place of a factor", count[1], 0, most);
    *w = (pg_ways){ (int) count[0], number[0], number[1], number[2], number[3], number[4], number[5],
                    count[1] };
    rough->rounds = count[2], rough->again = count[3], rough->share = number[6];
done:
    return status;
}

/* The linear system: how it is solved, which unknowns are weak, what the iterations have cost so far. A
 * way to solve that this force does not have is refused. */
static pg_status keep_system (pg_system *s, int solves, const pg_keeper *k)
{
    system_updates *u = &s->updates;
    system_choice *c = &s->choice;
    system_factor *f = &s->direct;
    pg_status status = PG_OK;
    /* without a factor, and after its preconditioner was dropped, no use is made of `factored` any more */
    int made_of = f->factored
                  && (system_has_matrix (s) || system_has_preconditioner (s) || s->iterative.remake);
    long count[11] = { c->mode,  f->indefinite, c->kept,   f->marked, made_of,
                      f->stale, f->unshifted,  c->spared, u->base,   f->loose,
                       u->by_columns };
    double number[3] = { f->mean_diagonal, f->shift, c->extra_cost };
    PG_TRY (k->counts (k->context, "system.counts", 11, count));
    PG_TRY (k->numbers (k->context, "system.numbers", 3, number));
    if (f->diagonal0) PG_TRY (k->numbers (k->context, "system.diagonal", s->ndof, f->diagonal0));
    PG_TRY (keep_flags ("system.touched", s->problem->cloud.n, f->touched, k));
    PG_KEEP_BOUND (k, "the way to solve", count[0], SYSTEM_UNDECIDED,
           !system_has_matrix (s) && count[0] < SYSTEM_NO_FACTOR ? SYSTEM_UNDECIDED : SYSTEM_DIAGONAL);
    PG_KEEP_BOUND (k, "a kept factor", count[4], count[0] == SYSTEM_KEPT_FACTOR, solves ? 1 : 0);
    PG_KEEP_BOUND (k, "the base of events", count[8], 0, count[4]);
    PG_KEEP_BOUND (k, "whether parts are loose", count[9], 0, 1);
    c->mode = (int) count[0], c->kept = count[2], f->marked = (int) count[3], f->unshifted = (int) count[6],
        c->spared = count[7], u->base = (int) count[8], f->loose = (int) count[9];
    u->by_columns = count[10];
    f->mean_diagonal = number[0], f->shift = number[1], c->extra_cost = number[2];
    /* K had become indefinite: the method of factoring is changed as it was in the first run. */
    if (k->reading && count[1] && !f->indefinite) {
        if (f->factor) f->linear->free (&f->factor);
        f->linear = pg_linear_first (0, 1);
        f->indefinite = 1;
    }
    PG_TRY (keep_preconditioner (s, solves, count[4], k));
    PG_TRY (system_guess_keep (s, k));
    PG_TRY (system_keep_residual (s, k));
    PG_TRY (keep_following (s, k));
    PG_TRY (keep_ways (&c->ways, &s->iterative.rough, k));
    f->stale = (int) count[5];
done:
    return status;
}

/* Pairs of force and displacement in a work balance of this problem, by making one; -1: the force has
 * none. */
static pg_status count_pairs (pg_solver *s, long *pairs)
{
    pg_status status = PG_OK;
    const pg_system *sys = &s->break_loop.system;
    pg_work_balance work_balance = { 0 };
    if (!sys->force->work) goto done;
    PG_TRY (sys->force->work (sys->self, s->backup->time, s->backup->d, NULL, &work_balance));
    *pairs = (long) work_balance.npair;
done:
    pg_work_balance_clear (&work_balance);
    return status;
}

/* What the solver object itself carries: where it is among levels and rounds, energies, what it has warned
 * of, statistics, work balances. */
static pg_status keep_solver (pg_solver *s, const pg_keeper *k)
{
    pg_status status = PG_OK;
    break_loop *b = &s->break_loop;
    size_t nload = s->problem->nload;
    long pairs = -1;
    long count[7] = { s->finished, s->warned_overlap, s->warned_energy, s->next_level,
                      b->round,    s->spared,         s->evaluations };
    double number[5] = { b->work, b->work0, b->stored0, b->strain0, b->kinetic0 };
    PG_TRY (k->counts (k->context, "solver.counts", 7, count));
    PG_TRY (k->numbers (k->context, "solver.numbers", 5, number));
    PG_KEEP_BOUND (k, "the next level", count[3], 0, s->options.levels + 1);
    PG_KEEP_BOUND (k, "the round", count[4], 0, most);
    s->finished = (int) count[0], s->warned_overlap = (int) count[1], s->warned_energy = (int) count[2];
    s->next_level = count[3], b->round = count[4], s->spared = count[5], s->evaluations = count[6];
    b->work = number[0], b->work0 = number[1], b->stored0 = number[2];
    b->strain0 = number[3], b->kinetic0 = number[4], b->saved = b->round > 0;
    PG_TRY (keep_report (&s->report, k));
    if (nload) PG_TRY (k->numbers (k->context, "solver.reaction", PG_REACTIONS * nload, s->reaction));
    PG_TRY (keep_broken (b, s->problem, k));
    PG_TRY (keep_near (b, k));
    PG_TRY (solver_keep_tips (s, k));
    if (k->reading) PG_TRY (count_pairs (s, &pairs));
    PG_TRY (keep_work_balance (&b->work_balance, "work_balance", nload, pairs, 1, k));
    PG_TRY (keep_work_balance (&b->before, "before", nload, pairs, 0, k));
    PG_TRY (keep_work_balance (&b->start, "start", nload, pairs, 0, k));
done:
    return status;
}

/* The factor or preconditioner of an earlier K, of the bonds and cracks of that moment. */
static pg_status rebuild_earlier (pg_solver *s, pg_state *state)
{
    pg_status status = PG_OK;
    pg_system *sys = &s->break_loop.system;
    unsigned char *alive = state->alive;
    pg_crack_paths *paths = state->paths;
    double extra_cost = sys->choice.extra_cost, pace = sys->iterative.pace;
    state->alive = sys->direct.factored;
    if (sys->direct.factored_paths) state->paths = sys->direct.factored_paths,
        sys->direct.factored_paths = NULL;
    PG_TRY (system_refresh (sys, state, NULL));
    if (sys->iterative.remake) {
        PG_TRY (system_make_preconditioner (sys, sys->iterative.made[0], sys->iterative.made[1]));
        sys->choice.extra_cost = extra_cost, sys->iterative.pace = pace, sys->iterative.remake = 0;
    } else PG_TRY (system_factorize (sys, s->type->dynamics ? s->type->dynamics (s) : NULL));
done:
    if (state->paths != paths) pg_crack_paths_free (&state->paths);
    state->alive = alive, state->paths = paths;
    return status;
}

/* Caches again as they were: the kept factor from what it was made of, all else from the bonds that live
 * now. */
static pg_status rebuild (pg_solver *s, pg_state *state)
{
    pg_status status = PG_OK;
    pg_system *sys = &s->break_loop.system;
    /* Making caches counts factorisations and solves; the report must not show those that the first run
     * did not make, only their seconds. */
    pg_statistics counts = s->report;
    int stale = sys->direct.stale, fresh = sys->iterative.guess.fresh;
    if (sys->direct.factored
        && (sys->iterative.remake || sys->choice.mode == SYSTEM_KEPT_FACTOR || sys->updates.base || !stale))
        PG_TRY (rebuild_earlier (s, state));
    else stale = 1;
    PG_TRY (system_refresh (sys, state, NULL));
    sys->direct.stale = stale, sys->iterative.guess.fresh = fresh;
    memcpy (counts.seconds, s->report.seconds, sizeof counts.seconds);
    s->report = counts;
    if (sys->updates.following) PG_TRY (inverse_restore (sys->updates.following));
done:
    return status;
}

const pg_state *pg_solver_accepted (const pg_solver *s, const pg_state *state)
{
    return s->break_loop.round > 0 ? s->backup : state;
}

/* For runs that go on among other processes; all of it is in what else is kept, step by step of the walk. */
static pg_status keep_shares (const pg_solver *s, const pg_state *state, const pg_keeper *k)
{
    const break_loop *b = &s->break_loop;
    const pg_statistics *r = &s->report;
    const pg_state *at = pg_solver_accepted (s, state);
    double share[SHARES] = {
        [SHARE_BROKEN] = (double) at->broken, [SHARE_WORK] = at->work, [SHARE_REPORTED] = (double) r->broken,
        [SHARE_STRAIN] = b->round > 0 ? b->strain0 : r->energy_strain,
        [SHARE_KINETIC] = b->round > 0 ? b->kinetic0 : r->energy_kinetic,
        [SHARE_EXTERNAL] = r->energy_external, [SHARE_DAMPING] = r->energy_damping,
        [SHARE_DISSIPATED] = r->energy_dissipated
    };
    return k->numbers (k->context, "solver.shares", SHARES, share);
}

/* One walk for both directions: what is written in this order is read back in it. A solver that has not
 * begun is started first, so that its arrays exist. */
pg_status pg_solver_keep (pg_solver *s, pg_state *state, const pg_keeper *k)
{
    pg_status status = PG_OK;
    if (k->reading) PG_TRY (solver_start (s, state));
    s->started = 1;
    PG_TRY (keep_state (state, s->problem, "state", k));
    PG_TRY (keep_state (s->backup, s->problem, "backup", k));
    PG_TRY (keep_solver (s, k));
    PG_TRY (keep_shares (s, state, k));
    PG_TRY (stages_keep (s, k));
    PG_TRY (keep_system (&s->break_loop.system, (s->type->flags & PG_SOLVER_IMPLICIT) != 0, k));
    if (s->type->keep) PG_TRY (s->type->keep (s, k));
    PG_TRY (facet_keep_measured (&s->break_loop, state, k));
    if (k->reading) PG_TRY (rebuild (s, state));
    PG_TRY (contact_keep (&s->break_loop.system, k));
done:
    return status;
}

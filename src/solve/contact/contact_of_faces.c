/* SPDX-License-Identifier: GPL-3.0-or-later
 * Equilibria with contact of crack faces and platens. With the cracks open, K u0 = F, gaps are g0 = gi + G
 * u0, gi without displacement; where one is negative, forces f of the pieces follow from the complementarity
 * of g = g0 + C f, C = G K^-1 G', and the displacement is u = u0 + Z f, Z = K^-1 G' (closed form: nothing is
 * factored again). The state is refined as all equilibria are, with G' f among
 * the loads, and by forces for the gaps that are then measured.
 * In dynamics K is the matrix of the time step, k K + m M, u its end, and the force in the equations `weight`
 * times the mean force f of the step (newmark.c). */
#include "contact.h"
#include <float.h>
#include <math.h>
#include <string.h>

enum { MOST_ROUNDS = 4 };
/* No further round if the relative change of gaps is below this. */
static const double GOOD = 1e-13;

/* ---- life ---------------------------------------------------------------------------------------------- */
/* 1: faces left by single broken bonds are looked for: in statics, with forces by bonds. */
static int finds_broken (const pg_system *s)
{
    return s->force->surfaces.faces && pg_criterion_of_bonds (s->problem->criterion)
           && (s->options->flags & PG_SOLVER_QUASI_STATIC);
}

/* An upper bound that holds for later breaking, as relaxation finds its time step before bonds break. */
double contact_stiffer (const pg_system *s)
{
    if (!s->contact) return 1;
    return finds_broken (s) ? fmax (s->contact->stiffer, PG_CONTACT_STIFFEST) : s->contact->stiffer;
}

/* Warns where single bonds may break whose faces are not found. */
static void doubt_broken (const pg_system *s)
{
    const pg_criterion *breaks = s->problem->criterion;
    int steps = (s->options->flags & PG_SOLVER_EXPLICIT) != 0;
    if (!breaks->type || pg_criterion_of_tips (breaks) || finds_broken (s)) return;
    pg_statistics_warn (s->report,
                        "contact.kind keeps the faces of the scene's cracks apart; where bonds break in the "
                        "run nothing does when they close again, and overlap_max is not theirs%s",
                        steps ? ": contact.search: short_range keeps all apart" : "");
}

static void clear_pairs (struct system_contact *c)
{
    contact_route_clear (c);
    pg_free (c->compliance.Z), pg_free (c->compliance.C), pg_free (c->coefficient), pg_free (c->cohesion),
        pg_free (c->before);
    pg_free (c->rebound), c->rebound = NULL;
    pg_free (c->press), c->press = NULL;
    pg_free (c->force), pg_free (c->gap), pg_free (c->open), pg_free (c->status), pg_free (c->initial);
    c->compliance.Z = c->compliance.C = c->coefficient = c->cohesion = c->before = c->force = c->gap =
        c->open = c->initial = NULL;
    c->status = NULL;
    c->compliance.made = 0;
}

static void clear (struct system_contact *c)
{
    pg_contact_pieces_clear (&c->pieces);
    pg_sparse_clear (&c->G);
    pg_free (c->soft), c->soft = NULL;
    clear_pairs (c);
}

static void free_contact (pg_system *s)
{
    struct system_contact *c = s->contact;
    if (!c) return;
    clear (c);
    platens_free (&c->platens), loose_free (&c->loose);
    contact_route_free (c);
    pg_free (c->nodal), pg_free (c->now.value), pg_free (c->start.value), pg_free (c->shown);
    pg_free (c);
    s->contact = NULL, s->client = NULL, s->balance.pressed = NULL, s->direct.props.n = 0;
}

/* Allocates the arrays of the present pairs. */
static pg_status make_pairs (pg_system *s)
{
    pg_status status = PG_OK;
    struct system_contact *c = s->contact;
    size_t n = c->pieces.n, dim = c->pieces.dim;
    clear_pairs (c);
    PG_ALLOC (c->coefficient, n);
    PG_ALLOC (c->cohesion, n);
    PG_ALLOC (c->before, n * (dim - 1));
    PG_ALLOC (c->force, dim * n);
    PG_ALLOC (c->gap, dim * n);
    PG_ALLOC (c->open, dim * n);
    PG_ALLOC (c->initial, dim * n);
    PG_ALLOC (c->status, n);
    PG_ALLOC (c->rebound, n);
    PG_ALLOC (c->press, n);
    for (size_t k = 0; k < n; k++) {
        const pg_contact_piece *piece = &c->pieces.piece[k];
        c->coefficient[k] = piece->platen ? s->problem->boundary.platen[piece->platen - 1].friction
                                          : c->setting.coefficient;
        c->cohesion[k] = piece->platen ? 0 : c->setting.cohesion * piece->area;
    }
    s->choice.columns = contact_columns (s);
    PG_TRY (contact_remember (c));
    for (size_t k = 0; k < c->ncrack; k++)             /* crumbled faces have no slip */
        if (c->G.start[dim * k] == c->G.start[dim * (k + 1)])
            memset (c->before + k * (dim - 1), 0, (dim - 1) * sizeof *c->before);
done:
    return status;
}

pg_status contact_more_pairs (pg_system *s)
{
    pg_status status = PG_OK;
    PG_TRY (platens_join (s));
    PG_TRY (make_pairs (s));
done:
    return status;
}

/* 1: a crack grows in a time step whose equations, forces and pairs are still in use: contact_renew makes the
 * pieces later. */
static int grows_in_step (const pg_system *s, const pg_changes *changes)
{
    return changes && (s->options->flags & PG_SOLVER_NEEDS_DENSITY)
           && pg_criterion_of_tips (s->problem->criterion);
}

/* Warns once of points on faces with too few neighbours for a gap; not of faces left by single bonds, which
 * may crumble: nothing touches there. */
static void tell_blind (pg_system *s, const pg_contact_blind *blind)
{
    char third[32] = "";
    if (s->contact->is.said_blind || !blind->n || pg_criterion_of_bonds (s->problem->criterion)) return;
    s->contact->is.said_blind = 1;
    if (s->problem->dim == 3) snprintf (third, sizeof third, ", %.6g", blind->x[2]);
    pg_statistics_warn (s->report,
                        "%zu point%s of crack faces, such as that at (%.6g, %.6g%s) m, %.2g %% of them, "
                        "see%s too little of the body on one side for a gap even within %g spacings: their "
                        "pieces touch by their other points; cracks lie less than a spacing apart there: "
                        "take a smaller spacing",
                        blind->n, blind->n == 1 ? "" : "s", blind->x[0], blind->x[1], third,
                        100 * blind->share, blind->n == 1 ? "s" : "", PG_WIDEST_SUPPORT * PG_CONTACT_RADIUS);
}

/* Finds the pieces of crack faces, and how nodes enter their gaps. */
static pg_status find_pieces (pg_system *s, const pg_state *state)
{
    pg_status status = PG_OK;
    struct system_contact *c = s->contact;
    PG_TRY (pg_contact_pieces_create (&c->pieces, s->problem, state));
    if (finds_broken (s)) PG_TRY (pg_contact_add_broken (&c->pieces, s->problem, state));
    PG_ALLOC (c->soft, c->pieces.dim * c->pieces.n);
    if (s->force->surfaces.faces)
        PG_TRY (pg_contact_layer (&c->G, c->soft, &c->stiffer, &c->pieces, s->force, s->self, state));
    else {
        pg_contact_blind blind;
        PG_TRY (pg_contact_rows (&c->G, &c->pieces, s->problem, s->force, s->self, state, &blind));
        tell_blind (s, &blind);
    }
done:
    return status;
}

pg_status contact_check (const pg_system *s)
{
    pg_status status = PG_OK;
    const struct system_contact *c = s->contact;
    int rests = (s->options->flags & PG_SOLVER_STATIC) == PG_SOLVER_STATIC;
    if (!c || !rests) return PG_OK;
    if (c->loose.n && !system_is_shared (s) && !system_has_matrix (s))
        PG_TRY (options_fault (s->options, "method.force",
                               "parts of the body that contact alone holds need a factor of K, and force: %s "
                               "makes no matrix: prescribe a displacement of each part or hold it by "
                               "springs, or use another force",
                               s->problem->method->name));
    if (c->loose.n && !system_can_factor (s))
        PG_TRY (options_fault (s->options, "solver.linear",
                               "parts of the body that contact alone holds need a factor of K: use auto"));
    if (!contact_of_faces (c) || !options_begin_cracks (s->problem)) goto done;
    if (!system_can_factor (s))
        PG_TRY (options_fault (s->options, "solver.linear",
                               "with contact.kind new cracks are tried by a factor of K, which %s has not: "
                               "use auto, or leave the strengths out", s->direct.linear->name));
    if (system_basis (s))
        PG_TRY (options_fault (s->options, "method.essential",
                               "with contact.kind new cracks are tried by a factor of K itself, which "
                               "transformation has not: use nitsche or penalty, or leave the strengths out"));
done:
    return status;
}

pg_status contact_refresh (pg_system *s, const pg_state *state, const pg_changes *changes)
{
    pg_status status = PG_OK;
    struct system_contact *c = s->contact;
    if (!c) return PG_OK;
    c->is.waits = grows_in_step (s, changes);
    if (c->is.waits) return PG_OK;
    double t0 = pg_seconds ();
    clear (c);
    c->stiffer = 1;
    if (contact_of_faces (c)) {
        status = find_pieces (s, state);
        PG_TRY (options_blame (status, s->options, "contact"));
    }
    c->pieces.dim = (size_t) s->problem->dim, c->ncrack = c->pieces.n;
    PG_TRY (options_blame (platens_refresh (s, state), s->options, "platens"));
    PG_TRY (make_pairs (s));
    c->is.began = 1;
    /* in dynamics mass holds loose parts */
    if ((s->options->flags & PG_SOLVER_STATIC) == PG_SOLVER_STATIC)
        PG_TRY (options_blame (loose_refresh (&c->loose, s), s->options, "boundary"));
    s->direct.props.n = c->loose.n, s->direct.props.unknown = c->loose.prop;
    s->direct.props.target = c->loose.target;
    s->report->contact.seconds += pg_seconds () - t0;
done:
    return status;
}

/* ---- equilibria ---------------------------------------------------------------------------------------- */
static int any_overlap (const struct system_contact *c)
{
    for (size_t k = 0; k < c->pieces.n; k++) if (c->gap[c->pieces.dim * k] < 0) return 1;
    return 0;
}

void contact_gaps (struct system_contact *c, const double *d)
{
    pg_sparse_multiply_transposed (&c->G, d, c->gap);
    for (size_t i = 0; i < c->pieces.dim * c->pieces.n; i++) c->gap[i] += c->initial[i];
    for (size_t i = 0; i < c->pieces.dim * c->ncrack; i++) c->gap[i] += c->soft[i] * c->force[i];
}

double contact_energy (const pg_system *s)
{
    const struct system_contact *c = s->contact;
    double sum = 0;
    for (size_t i = 0; c && c->is.active && i < c->pieces.dim * c->ncrack; i++)
        sum += 0.5 * c->soft[i] * c->force[i] * c->force[i];
    return sum;
}

/* Finds contact forces for the present gaps, which belong to the present forces, and updates d. *change: of
 * the forces, as gaps, over the largest gap without contact. */
static pg_status press (pg_system *s, double t, double *d, double *change)
{
    pg_status status = PG_OK;
    struct system_contact *c = s->contact;
    size_t n = c->pieces.dim * c->pieces.n;
    double *old = NULL, *cohesion = NULL, size = 0;
    PG_ALLOC (old, n);
    PG_ALLOC (cohesion, c->pieces.n);
    for (size_t k = 0; k < c->pieces.n; k++) cohesion[k] = c->weight * c->cohesion[k];
    memcpy (old, c->force, n * sizeof *old);
    memcpy (c->open, c->gap, n * sizeof *old);
    for (size_t j = 0; j < n; j++)
        for (size_t i = 0; old[j] != 0 && i < n; i++) c->open[i] -= c->compliance.C[j * n + i] * old[j];
    pg_contact_solution solution = { .force = c->force, .gap = c->gap, .status = c->status };
    if (contact_motions (s)) PG_TRY (contact_press_free (s, t, &solution, c->open, d));
    else {
        pg_contact_problem problem = { c->pieces.n, c->pieces.dim, c->compliance.C, c->open, c->coefficient,
                                       cohesion, c->is.history ? c->before : NULL };
        PG_TRY (pg_contact_solve (&solution, &problem));
    }
    pg_statistics *r = s->report;
    r->contact.passes = (long) solution.passes, r->contact.sweeps = (long) solution.sweeps;
    r->contact.solves += r->contact.passes;
    *change = 0;
    for (size_t i = 0; i < n; i++) {
        double step = c->force[i] - old[i];
        *change = fmax (*change, fabs (step) * c->compliance.C[i * n + i]),
        size = fmax (size, fabs (c->open[i]));
        for (size_t k = 0; step != 0 && k < s->ndof; k++) d[k] += step * c->compliance.Z[i * s->ndof + k];
    }
    *change = size > 0 ? *change / size : 0;
    pg_sparse_multiply (&c->G, c->force, c->nodal);
    contact_set_active (s, 1);
done:
    pg_free (old), pg_free (cohesion);
    return status;
}

/* Counts pieces and their status for the report. */
void contact_count (pg_system *s)
{
    const struct system_contact *c = s->contact;
    pg_statistics *r = s->report;
    r->contact.pieces = (long) c->pieces.n;
    r->contact.open = r->contact.stick = r->contact.sliding = 0;
    for (size_t k = 0; k < c->pieces.n; k++) {
        size_t i = c->pieces.dim * k;
        double open = c->gap[i] - (k < c->ncrack ? c->initial[i] : 0);
        r->contact.overlap = fmax (r->contact.overlap, -open);
        if (!c->is.active || c->status[k] == PG_CONTACT_OPEN) r->contact.open++;
        else if (c->status[k] == PG_CONTACT_STICK) r->contact.stick++;
        else r->contact.sliding++;
    }
}

/* Refuses an equilibrium in which springs of loose parts bear a force. */
static pg_status check_loose (const pg_system *s, const double *d)
{
    const contact_loose *l = &s->contact->loose;
    double pull = loose_pull (s, d), size = fmax (s->balance.reference, s->balance.borne);
    if (!l->n || pull <= fmax (s->options->tolerance * size, l->noise)) return PG_OK;
    char place[BODY_PART_WORDS];
    body_part_place (s->problem, &l->part[0], place, sizeof place);
    return pg_error (PG_E_EQUILIBRIUM, PG_HERE,
                     "a part of the body, %s, which contact alone holds, is out of balance by %.3g N "
                     "(reference force %.3g N): hold it by prescribed displacements", place, pull, size);
}

/* Finds the equilibrium with the present pairs. */
static pg_status solve_pairs (pg_system *s, double t, double *d, const dynamics *dyn, double *residual)
{
    pg_status status = PG_OK;
    struct system_contact *c = s->contact;
    size_t n = c->pieces.dim * c->pieces.n;
    contact_set_active (s, 0);
    memset (c->force, 0, n * sizeof *c->force);
    memset (c->status, PG_CONTACT_OPEN, c->pieces.n);
    memset (c->rebound, 0, c->pieces.n * sizeof *c->rebound);
    /* a body that only platens load has no forces while they are apart from it: start from zero, as rounding
     * of an old displacement would show */
    if (c->platens.n) memset (d, 0, s->ndof * sizeof *d);
    platens_place (s, t);
    for (size_t j = 0; j < c->loose.n; j++) c->loose.amount[j] = c->loose.target[j] = 0;
    if (c->loose.n && (s->direct.stale || !s->direct.factor)) {
        PG_TRY (contact_check (s));
        s->choice.mode = SYSTEM_FACTOR;
        PG_TRY (system_factorize (s, NULL));
    }
    if (!dyn) PG_TRY (contact_factor (s));
    PG_TRY (system_solve_linear (s, t, d, dyn, residual));
    if (n) contact_gaps (c, d);
    s->choice.begins = 0;                                     /* first guesses belong to the open faces */
    double change = 1;
    int closes = c->is.touched = any_overlap (c) || contact_motions (s) > 0;
    if (closes) PG_TRY (contact_condense (s, dyn));
    for (int round = 0; closes && round < MOST_ROUNDS && change > GOOD; round++) {
        PG_TRY (press (s, t, d, &change));
        PG_TRY (system_solve_linear (s, t, d, dyn, residual));
        contact_gaps (c, d);
    }
    PG_TRY (check_loose (s, d));
done:
    return status;
}

/* Event stepping, proportional loads: refuses pairs of platens that bear forces although they did not touch
 * at the start, as forces then do not scale with the load. */
static pg_status check_proportion (const pg_system *s)
{
    const struct system_contact *c = s->contact;
    if (!s->options->event) return PG_OK;
    for (size_t k = c->ncrack; c->is.active && k < c->pieces.n; k++) {
        const pg_contact_piece *p = &c->pieces.piece[k];
        if (!(c->platens.distance[c->platens.at[k - c->ncrack]] > 0) || !(c->force[c->pieces.dim * k] > 0))
            continue;
        return pg_error (PG_E_USAGE, PG_HERE,
                         "the platen %s comes to touch the body at (%.6g, %.6g, %.6g) m, where it does not "
                         "at the start, so that equilibria do not grow in proportion to the load: use "
                         "solver.stepping: fixed",
                         s->problem->boundary.platen[p->platen - 1].name, p->x[0], p->x[1], p->x[2]);
    }
    return PG_OK;
}

/* Finds the equilibrium; again where pieces of platens have closed that were not pairs yet. */
static pg_status solve (pg_system *s, double t, double *d, const dynamics *dyn, double *residual)
{
    pg_status status = PG_OK;
    s->contact->is.moves = dyn != NULL, s->contact->weight = dyn ? dyn->contact : 1;
    for (;;) {
        PG_TRY (solve_pairs (s, t, d, dyn, residual));
        if (!platens_look (s, d)) break;
        PG_TRY (contact_more_pairs (s));
    }
    PG_TRY (check_proportion (s));
    platens_react (s);
    platens_doubt (s);
    contact_count (s);
done:
    return status;
}

/* ---- tips ---------------------------------------------------------------------------------------------- */
/* Pieces from NEXT to LAST spacings behind a tip, and up to ASIDE beside its line, count for the mean stress
 * on its faces. The last two spacings carry too little, as the tip of a discretisation is not sharp, and the
 * error alternates from piece to piece behind them: so weights rise and fall smoothly. The direction is that
 * of the chord up to the last kink. */
static const double NEXT = 2, LAST = 14, ASIDE = 1, CHORD = 2.5;

/* Distance of a point from a piece, m; `to`: from the middle of the piece to the point. */
static double away_from (const pg_contact_piece *p, const double *to)
{
    double along = to[0] * p->normal[1] - to[1] * p->normal[0], half = 0.5 * p->length,
           beyond = fmax (0, fabs (along) - half), beside = to[0] * p->normal[0] + to[1] * p->normal[1];
    return hypot (beyond, beside);
}

/* Force of a piece on its left face in field `at`, N. */
static double force_on (const struct system_contact *c, size_t row, int nfield, int at)
{
    if (at) return c->route.track.force_rate[row];
    return nfield == 2 ? c->route.force_from[row] : c->force[row] / c->weight;
}

static pg_face_piece piece_of (const struct system_contact *c, size_t k, int nfield)
{
    const pg_contact_piece *p = &c->pieces.piece[k];
    pg_face_piece out = { .x = { p->x[0], p->x[1] }, .normal = { p->normal[0], p->normal[1] },
                          .length = p->length };
    for (int a = 0; a < nfield; a++)
        for (size_t i = 0; i < 2; i++) out.stress[a][i] = -force_on (c, 2*k + i, nfield, a) / p->area;
    return out;
}

/* 1: the faces of a piece press on each other, at some point of a stretch of loads. */
static int presses (const struct system_contact *c, size_t k, int nfield)
{
    return nfield == 1 ? c->force[2*k] > 0 : c->status[k] != PG_CONTACT_OPEN;
}

void contact_at_tip (const pg_system *s, const pg_state *state, size_t tip, int nfield, pg_tip_faces *out)
{
    const struct system_contact *c = s->contact;
    const double *x = state->paths->tip[tip].x;
    double area = 0, force[2][2] = { { 0 } }, from[2], e[2], h = pg_problem_spacing_at (s->problem, x),
           straight = pg_tip_straight (state->paths, tip, PG_CONTACT_TURN);
    pg_tip_chord (state->paths, tip, fmin (CHORD * h, straight), from, e);
    *out = (pg_tip_faces){ .nearest = INFINITY };
    for (size_t k = 0; c && c->is.active && k < c->ncrack; k++) {
        const pg_contact_piece *p = &c->pieces.piece[k];
        double to[2] = { x[0] - p->x[0], x[1] - p->x[1] };
        double behind = to[0] * e[0] + to[1] * e[1], beside = fabs (to[1] * e[0] - to[0] * e[1]);
        if (presses (c, k, nfield)) {
            out->nearest = fmin (out->nearest, away_from (p, to));
            c->press[out->npiece++] = piece_of (c, k, nfield);
        }
        double place = (behind - NEXT * h) / (fmin (LAST * h, straight) - NEXT * h);
        if (beside > ASIDE * h || !(place > 0) || !(place < 1)) continue;
        double weight = pow (sin (3.14159265358979323846 * place), 2);
        area += weight * p->area, out->closed |= presses (c, k, nfield);
        for (int a = 0; a < nfield; a++)
            for (size_t i = 0; i < 2; i++) force[a][i] += weight * force_on (c, 2*k + i, nfield, a);
    }
    if (c) out->piece = c->press;
    /* A branch of a crack that presses elsewhere: beyond the kink the faces are those of another crack,
     * closed or, in the last piece, just open; a ring around the kink says nothing of the tip. */
    if (isfinite (out->nearest)) out->nearest = fmin (out->nearest, straight);
    /* the force on the left face is the traction of the stress behind it, with opposite sign */
    for (int a = 0; a < nfield && area > 0; a++)
        for (int i = 0; i < 2; i++) out->stress[a][i] = -force[a][i] / area;
}

/* Finds which tips are closed at t; where there is no equilibrium nothing is reported here. */
static pg_status find_closed (pg_system *s, const pg_state *state, double t, double *d, unsigned char *closed)
{
    double residual;
    pg_status now = solve (s, t, d, NULL, &residual);
    for (size_t i = 0; now == PG_OK && i < state->paths->ntip; i++) {
        pg_tip_faces faces;
        contact_at_tip (s, state, i, 1, &faces);
        closed[i] |= (unsigned char) faces.closed;
    }
    return now == PG_E_MEMORY ? now : PG_OK;
}

/* Finds the tips that are closed at full load; with stages: at the end of any of them. */
pg_status contact_settle_tips (pg_system *s, pg_state *state)
{
    pg_status status = PG_OK;
    double *d = NULL;
    unsigned char *closed = NULL;
    int any = 0;
    if (!s->contact || !state->paths || !state->paths->ntip) return PG_OK;
    PG_ALLOC (d, s->ndof);
    PG_ALLOC (closed, state->paths->ntip);
    for (size_t t = 1; t <= (s->problem->boundary.nstage ? s->problem->boundary.nstage : 1); t++)
        PG_TRY (find_closed (s, state, (double) t, d, closed));
    for (size_t i = 0; i < state->paths->ntip; i++) {
        double h = pg_problem_spacing_at (s->problem, state->paths->tip[i].x);
        if (!closed[i]) continue;
        pg_tip_draw_back (state, s->problem, i,
                          s->problem->crack.closed_tip_offset / s->problem->cloud.h * h);
        any = 1;
    }
    if (any) PG_TRY (system_refresh (s, state, NULL));
done:
    pg_free (d), pg_free (closed);
    return status;
}

/* Contact at a tip of the state. In event stepping under proportional loads forces are those of load factor
 * 1, and are scaled. */
int pg_solver_tip_faces (const pg_solver *s, const pg_state *state, size_t tip, pg_tip_faces *out)
{
    const struct system_contact *c = s->break_loop.system.contact;
    double scale = s->options.event && c && !c->route.open[0] ? state->factor : 1;
    memset (out, 0, sizeof *out);
    if (!c) return 0;
    contact_at_tip (&s->break_loop.system, state, tip, 1, out);
    for (int i = 0; i < 2; i++) {
        out->stress[0][i] *= scale;
        for (size_t k = 0; k < out->npiece; k++) c->press[k].stress[0][i] *= scale;
    }
    return 1;
}

/* ---- what the linear system has of it ------------------------------------------------------------------ */
static void account (const pg_system *s, pg_work_balance *balance)
{
    platens_reactions (s, balance->reaction);
    balance->strain += contact_energy (s);
}

static double book (pg_system *s, double scale)
{
    double work = platens_book (s, scale);
    contact_book (s, scale);
    return work;
}

static const system_client client = { free_contact, contact_refresh, solve, account, book, contact_save,
                                      contact_return };

pg_status contact_create (pg_system *s)
{
    pg_status status = PG_OK;
    const pg_solver_options *o = s->options;
    const struct system_contact asked = { .setting = o->contact };
    int faces = contact_of_faces (&asked),
        platens = s->problem->boundary.nplaten && (o->flags & PG_SOLVER_STATIC) == PG_SOLVER_STATIC;
    if (!faces && !platens) return PG_OK;
    PG_ALLOC (s->contact, 1);
    s->client = &client;
    s->contact->setting = o->contact;
    /* proportional loads: every state, with its slips, scales with the load factor from the unloaded one */
    /* loads with a constant part are in contact_route.c */
    s->contact->is.history = !o->event, s->contact->weight = 1;
    PG_ALLOC (s->contact->nodal, s->ndof);
    s->contact->pieces.dim = (size_t) s->problem->dim;
    if (platens) PG_TRY (platens_create (s));
    if (faces) doubt_broken (s);
done:
    return status;
}

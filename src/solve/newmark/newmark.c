/* SPDX-License-Identifier: GPL-3.0-or-later
 * Newmark's method with the break loop inside each step (Cui 2022 eqs (21)-(26), corrected in theory F5):
 * with b0 = 1/(beta dt^2), b1 = 1/(beta dt), b2 = 1/(2 beta), b3 = gamma/(beta dt), b4 = gamma/beta, b5 = dt
 * (gamma/(2 beta) - 1),
 *   A = b0 dU - b1 V - (b2 - 1) A_t,   V = b3 dU + (1 - b4) V_t - b5 A_t,
 *   Khat = (1 + alpha) (1 + b3 c_K) K + (b0 + (1 + alpha) b3 c_M) M,   C = c_M M + c_K K,
 *   R = (1 + alpha) G - alpha G_t - M A,   G = P - F_int - C V.
 * alpha = 0 is Newmark's method; alpha in [-1/3, 0) that of Hilber, Hughes and Taylor (1977), which damps the
 *     motions that the step cannot
 * resolve; beta = (1 - alpha)^2 / 4 and gamma = 1/2 - alpha then keep it of second order.
 * Contact of crack faces (contact_solve.c) acts with a force f that is constant in a step, its impulse dt f,
 * of which the average acceleration knows nothing: A and V = ... are those of the forces besides f, and
 *     U = ... + dt^2/2 M^-1 G' f,   V = ... + dt M^-1 G' f   (Kane, Repetto, Ortiz, Marsden, IJNME 45, 1999).
 * For gamma = 2 beta V is the same function of dU as without, R has f / (2 beta) besides, and A is what is
 * above less M^-1 G' f / (2 beta). With gamma = 1/2 the energy changes by f . (g_t+dt - g_t) through contact:
 * it falls by what friction takes, and by f_n g_n,t where faces that were apart meet, and never grows. An
 * elastic body loses nothing where it is met: impulses restore what faces lost (newmark_rebound; Laursen and
 * Love 2002).
 * Nodes whose motion is prescribed by elimination take V and A from that motion (newmark_start.c). */
#include "solve/contact/contact.h"
#include "solve/growth/facet_growth.h"
#include "newmark_state.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct { double b[8]; } coefficients;

/* b0 to b7 of the head of this file; the last two predict velocities. */
static coefficients coefficients_of (const pg_newmark_options *own, double dt)
{
    double be = own->beta, ga = own->gamma;
    return (coefficients){ { 1 / (be * dt * dt), 1 / (be * dt), 1 / (2 * be), ga / (be * dt), ga / be,
                             dt * (ga / (2 * be) - 1), dt * (1 - ga), ga * dt } };
}

void pg_newmark_coefficients (const pg_solver_options *o, double *b)
{
    coefficients c = coefficients_of (PG_OWN (pg_newmark_options, o), o->dt);
    memcpy (b, c.b, sizeof c.b);
}

typedef struct { newmark *n; const pg_state *from; coefficients c; double t; } course;

/* V and A that belong to displacements d at the new time */
static void rates (const course *m, const double *d, double *v, double *a)
{
    const pg_state *f = m->from;
    const double *b = m->c.b;
    for (size_t i = 0; i < f->ndof; i++) {
        double du = d[i] - f->d[i];
        a[i] = b[0] * du - b[1] * f->v[i] - (b[2] - 1) * f->a[i];
        v[i] = b[3] * du + (1 - b[4]) * f->v[i] - b[5] * f->a[i];
    }
    newmark_follow (m->n, m->t, v, a);
}

/* Finds V and A at the end of a step; ghosts get the values of their owners. */
static pg_status settle_rates (const course *m, pg_state *state)
{
    pg_status status = PG_OK;
    rates (m, state->d, state->v, state->a);
    PG_TRY (system_exchange (m->n->system, state->v));
    PG_TRY (system_exchange (m->n->system, state->a));
done:
    return status;
}

/* Predicts d: the acceleration stays as it was. */
static void predict (const course *m, double *d)
{
    const pg_state *f = m->from;
    double dt = m->n->dt;
    for (size_t i = 0; i < f->ndof; i++) d[i] = f->d[i] + dt * (f->v[i] + 0.5 * dt * f->a[i]);
}

/* x = d + c_K v: K x is internal force and damping by stiffness together, one sweep instead of two. */
static int join_damping (void *context, const double *d, double *x)
{
    const course *m = context;
    newmark *n = m->n;
    double ck = n->setting.rayleigh_stiffness;
    n->joined = ck != 0;
    if (!n->joined) return 0;
    rates (m, d, n->work1, n->work3);
    for (size_t i = 0; i < n->system->ndof; i++) x[i] = d[i] + ck * n->work1[i];
    if (system_exchange (n->system, x) != PG_OK) x[0] = NAN;  /* not finite: the residual reports it */
    return 1;
}

/* residual <- (1 + alpha) residual - alpha (that of the last step's end) - M A, where residual holds P -
 * F_int - C V. M A counts for the reference; so does a millionth of the parts it is the difference of, M (b1
 * V_t + (b2 - 1) A_t): a body in free flight has no other force, and its M A is their rounding. */
static void add_inertia (void *context, const double *d, double *residual, double *reference)
{
    const course *m = context;
    newmark *n = m->n;
    pg_system *sys = n->system;
    const pg_state *f = m->from;
    double *v = n->work1, *a = n->work3, size, parts, alpha = n->setting.alpha;
    rates (m, d, v, a);
    if (n->joined) system_add_mass (sys, -n->setting.rayleigh_mass, v, residual);
    else newmark_damp (n, v, residual);
    n->joined = 0;
    system_add_held (sys, residual);
    for (size_t i = 0; alpha != 0 && i < sys->ndof; i++)
        residual[i] = (1 + alpha) * residual[i] - alpha * n->force0[i];
    double *known = n->work4, *Mknown = known + sys->ndof, *Ma = Mknown + sys->ndof;
    memset (Mknown, 0, 2 * sys->ndof * sizeof *Mknown);
    for (size_t i = 0; i < sys->ndof; i++) known[i] = m->c.b[1] * f->v[i] + (m->c.b[2] - 1) * f->a[i];
    system_add_mass (sys, 1, known, Mknown);
    system_add_mass (sys, 1, a, Ma);
    for (size_t i = 0; i < sys->ndof; i++) residual[i] -= Ma[i];
    size = system_norm_owned (sys, NULL, Ma), parts = system_norm_owned (sys, NULL, Mknown);
    *reference = fmax (*reference, fmax (size, 1e-6 * parts));
}

/* residual += what reactions contain at the end of the step, whatever the equations weigh with alpha: contact
 * and forces of opening facets, less damping and inertia. */
static void add_resistance (void *context, const double *d, double *residual)
{
    const course *m = context;
    newmark *n = m->n;
    double *v = n->work1, *a = n->work3, *Ma = n->work4;
    const double *contact = n->system->balance.pressed;
    rates (m, d, v, a);
    newmark_damp (n, v, residual);
    system_add_held (n->system, residual);
    for (size_t i = 0; contact && i < n->system->ndof; i++) residual[i] += contact[i];
    memset (Ma, 0, n->system->ndof * sizeof *Ma);
    system_add_mass (n->system, 1, a, Ma);
    for (size_t i = 0; i < n->system->ndof; i++) residual[i] -= Ma[i];
}

/* x -= what the equations leave at the end of the step: with r = P - F - C v they are (1 + alpha) r - alpha
 * r_t - M a = 0, so that r - M a = alpha (r_t - M a) / (1 + alpha) is left. */
static void add_weights (void *context, const double *d, double *x)
{
    const course *m = context;
    newmark *n = m->n;
    double *v = n->work1, *a = n->work3, *Ma = n->work4, share = n->setting.alpha / (1 + n->setting.alpha);
    rates (m, d, v, a);
    memset (Ma, 0, n->system->ndof * sizeof *Ma);
    system_add_mass (n->system, 1, a, Ma);
    for (size_t i = 0; i < n->system->ndof; i++) x[i] -= share * (n->force0[i] - Ma[i]);
}

const dynamics *newmark_matrix (newmark *n)
{
    coefficients c = coefficients_of (&n->setting, n->dt);
    double share = 1 + n->setting.alpha;
    n->dyn.k = share * (1 + c.b[3] * n->setting.rayleigh_stiffness);
    n->dyn.contact = c.b[2];
    n->dyn.m = c.b[0] + share * c.b[3] * n->setting.rayleigh_mass;
    return &n->dyn;
}

/* A step that was interrupted between rounds of breaking goes on from its present displacements. */
pg_status newmark_advance (newmark *n, break_loop *b, const pg_state *from, pg_state *state, double t,
                           pg_step *step)
{
    pg_status status = PG_OK;
    course m = { n, from, coefficients_of (&n->setting, n->dt), t };
    dynamics dyn = *newmark_matrix (n);
    dyn.dt = n->creeps ? INFINITY : n->dt;
    dyn.add = add_inertia, dyn.resist = add_resistance, dyn.join = join_damping, dyn.context = &m;
    dyn.whole = n->setting.alpha == 0;
    if (!dyn.whole) dyn.leave = add_weights;
    PG_TRY (newmark_supports (n, t, 0));
    if (b->round == 0) predict (&m, state->d);
    PG_TRY (equilibrate (b, state, t, state->d, &dyn, step));
    PG_TRY (settle_rates (&m, state));
    PG_TRY (newmark_without_contact (n, state->a));
    PG_TRY (newmark_rebound (n, from, state->v));
    if (n->setting.alpha != 0) PG_TRY (newmark_remember (n, t, state));
done:
    return status;
}

/* ---- the solver ---------------------------------------------------------------------------------------- */
static newmark *newmark_of (const pg_solver *s) { return s->own; }

/* Starts from the state as it is: the energy that it has counts as work done before. A run that goes on has
 * its acceleration already. */
static pg_status newmark_begin (pg_solver *s, const pg_state *state)
{
    pg_status status = PG_OK;
    newmark *n = newmark_of (s);
    double none = 0;
    n->system = &s->break_loop.system;
    n->setting = *PG_OWN (pg_newmark_options, &s->options), n->dt = s->options.dt;
    if (s->break_loop.growth) facet_doubt_step (&s->break_loop, n->dt);
    for (size_t i = 0; i < state->ndof; i++) none = fmax (none, !(n->system->mass[i] > 0));
    if (system_most (n->system, none) > 0)
        PG_TRY (options_fault (&s->options, "materials", "%s needs mass at every point: give each material a "
                                                         "density", s->options.kind));
    PG_TRY (newmark_open (n));
done:
    return status;
}

static pg_status newmark_start (pg_solver *s, pg_state *state)
{
    pg_status status = PG_OK;
    newmark *n = newmark_of (s);
    if (state->step > 0) goto done;
    PG_TRY (newmark_launch (n, state, state->time));
    PG_TRY (newmark_account (n, &s->break_loop, state, state->time));
    if (n->system->force->work)
        s->break_loop.work = s->report.energy.strain + s->report.energy.kinetic;
    if (n->force0) PG_TRY (newmark_remember (n, state->time, state));
done:
    return status;
}

static const dynamics *newmark_dynamics (pg_solver *s) { return newmark_matrix (newmark_of (s)); }

/* One time step, its energies, the level it may have come to, and the end of the run. */
static pg_status newmark_step (pg_solver *s, pg_state *state, pg_step *step)
{
    pg_status status = PG_OK;
    newmark *n = newmark_of (s);
    break_loop *b = &s->break_loop;
    int last = state->step + 1 >= s->options.steps;
    double t = last ? s->options.end : (double) (state->step + 1) * s->options.dt;
    PG_TRY (newmark_advance (n, b, s->backup, state, t, step));
    s->report.energy.kinetic = newmark_kinetic (n, state->v);
    s->report.energy.strain = b->work_balance.strain;
    step->dissipated = b->work - b->work0 - (s->report.energy.strain + s->report.energy.kinetic - b->stored0);
    if (b->work_balance.reaction)
        memcpy (s->reaction, b->work_balance.reaction,
                PG_REACTIONS * s->problem->boundary.nload * sizeof *s->reaction);
    step->unjudged = facet_unjudged (b, state, 1);
    if (b->growth) PG_TRY (facet_show (s, state, 1));
    PG_TRY (contact_show (&b->system, 1));
    contact_accept (&b->system);
    PG_TRY (contact_renew (&b->system, state));
    state->time = step->time = t;
    state->factor = step->factor = t / s->options.end;
    while ((double) s->next_level / (double) s->options.levels <= step->factor * (1 + 1e-12))
        s->next_level++, step->level = 1;
    int arrived;
    PG_TRY (break_loop_arrived (b, state, state->d, &arrived));
    if (arrived)
        pg_statistics_warn (&s->report, "the crack has arrived at %s: the run ends at t = %.6g s",
                            s->options.stop_set->name, t);
    if (arrived || last) s->finished = 1;
done:
    return status;
}

static void newmark_free (pg_solver *s) { newmark_close (newmark_of (s)); }

/* With alpha the residual at the end of the last step enters the next. */
static pg_status newmark_keep (pg_solver *s, const pg_keeper *k)
{
    pg_status status = PG_OK;
    newmark *n = newmark_of (s);
    if (n->force0) PG_TRY (k->numbers (k->context, "newmark.force0", s->break_loop.system.ndof, n->force0));
    PG_TRY (facet_keep (&s->break_loop, k));
done:
    return status;
}

/* Reads the residual at the end of the last step; velocities and accelerations, also of ghosts, are in the
 * state. */
static pg_status newmark_moved (pg_solver *s, pg_state *state, const pg_moved *moved, int within)
{
    pg_status status = PG_OK;
    newmark *n = newmark_of (s);
    break_loop *b = &s->break_loop;
    size_t components = (size_t) b->system.components;
    double work = b->work;
    (void) within;
    if (n->force0) PG_TRY (moved->points (moved->context, "newmark.force0", components, n->force0));
    pg_work_balance_clear (&b->before);
    PG_TRY (newmark_account (n, b, state, state->time));
    b->work = work;
done:
    return status;
}

/* ---- the entry ----------------------------------------------------------------------------------------- */
/* Reads damping, mass and alpha, and sets beta and gamma by alpha; newmark_read may replace these. */
void newmark_read_setting (pg_newmark_options *own, const pg_problem *problem, const pg_scene *scene,
                           const char *map)
{
    const pg_force_type *force = pg_force_of (problem);
    char path[96];
    own->rayleigh_mass = pg_scene_number (scene, "%s.rayleigh.mass", map);
    own->rayleigh_stiffness = pg_scene_number (scene, "%s.rayleigh.stiffness", map);
    own->consistent = strcmp (pg_scene_text (scene, "%s.mass", map), "consistent") == 0;
    snprintf (path, sizeof path, "%s.mass", map);
    if (own->consistent && force && !force->method.shape_functions)
        pg_scene_fault (scene, path, "force: %s has no consistent mass: use lumped", problem->method->name);
    own->alpha = pg_scene_number (scene, "%s.alpha", map);
    own->beta = (1 - own->alpha) * (1 - own->alpha) / 4, own->gamma = 0.5 - own->alpha;
}

static void newmark_read (pg_solver_options *o, const pg_problem *problem, const pg_scene *scene)
{
    pg_newmark_options *own = PG_OWN (pg_newmark_options, o);
    options_read_times (o, problem, scene);
    newmark_read_setting (own, problem, scene, "solver");
    if (pg_scene_given (scene, "solver.beta")) own->beta = pg_scene_number (scene, "solver.beta");
    if (pg_scene_given (scene, "solver.gamma")) own->gamma = pg_scene_number (scene, "solver.gamma");
    if (own->gamma > 2 * own->beta)
        pg_scene_fault (scene, "solver.beta", "newmark is unconditionally stable only for 2 beta >= gamma");
    else if (o->contact.kind != PG_CONTACT_NONE
             && (own->alpha != 0 || fabs (own->gamma - 2 * own->beta) > 1e-12))
        pg_scene_fault (scene, own->alpha != 0 ? "solver.alpha" : "solver.beta",
                        "impulses of contact go with alpha: 0 and gamma = 2 beta: leave alpha, beta and "
                        "gamma out, or set contact.kind: none");
    if (o->contact.kind != PG_CONTACT_NONE && own->consistent)
        pg_scene_fault (scene, "solver.mass", "contact.kind goes with lumped masses: use lumped");
}

#define ROW PG_SOLVER_KEY
static const pg_key keys[] = {
    ROW ("solver.alpha", PG_NUMBER, "1", "[-0.3333333333333334, 0]", "0", NULL,
         "Numerical damping of Hilber, Hughes and Taylor; 0 none, -0.05 light, -1/3 most. It damps "
         "what the time step does not resolve."),
    ROW ("solver.beta", PG_NUMBER, "1", "(0, 1]", "", NULL,
         "Parameter; default (1 - alpha)^2 / 4, so 0.25 without alpha."),
    ROW ("solver.gamma", PG_NUMBER, "1", "[0.5, 1.5]", "", NULL, "Parameter; default 0.5 - alpha."),
};
static const pg_key_table table = { "solve", keys, sizeof keys / sizeof *keys };

const pg_solver_type pg_solver_newmark = {
    .name = "newmark",
    .summary = "implicit dynamics, Newmark's method",
    .flags = PG_SOLVER_IMPLICIT | PG_SOLVER_NEEDS_DENSITY | PG_SOLVER_FACETS | PG_SOLVER_CONTACT
             | PG_SOLVER_RANKS,
    .keys = { &table, &solver_keys_breaking, &solver_keys_facets, &solver_keys_linear,
              &solver_keys_step, &solver_keys_time },
    .read = newmark_read,
    .begin = newmark_begin,
    .start = newmark_start,
    .step = newmark_step,
    .free = newmark_free,
    .keep = newmark_keep,
    .move = newmark_moved,
    .own_size = sizeof (newmark),
    .dynamics = newmark_dynamics,
};

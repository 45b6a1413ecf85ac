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
 * Nodes whose motion is prescribed by elimination take V and A from that motion (newmark_start.c). */
#include "newmark_state.h"
#include <math.h>
#include <string.h>

typedef struct { double b[8]; } coefficients;

/* b0 to b7 of the head of this file; the last two predict velocities. */
static coefficients coefficients_of (const pg_solver_options *o)
{
    const pg_newmark_options *own = PG_OWN (pg_newmark_options, o);
    double dt = o->dt, be = own->beta, ga = own->gamma;
    return (coefficients){ { 1 / (be * dt * dt), 1 / (be * dt), 1 / (2 * be), ga / (be * dt), ga / be,
                             dt * (ga / (2 * be) - 1), dt * (1 - ga), ga * dt } };
}

void pg_newmark_coefficients (const pg_solver_options *o, double *b)
{
    coefficients c = coefficients_of (o);
    memcpy (b, c.b, sizeof c.b);
}

typedef struct { pg_solver *s; const pg_state *from; coefficients c; double t; } course;

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
    newmark_follow (m->s, m->t, v, a);
}

/* The first guess: acceleration goes on as it was. */
static void predict (const course *m, double *d)
{
    const pg_state *f = m->from;
    double dt = m->s->options.dt;
    for (size_t i = 0; i < f->ndof; i++) d[i] = f->d[i] + dt * (f->v[i] + 0.5 * dt * f->a[i]);
}

/* residual <- (1 + alpha) residual - alpha (that of the last step's end) - M A, where residual holds P -
 * F_int - C V. M A counts for the reference; so does a millionth of the parts it is the difference of, M (b1
 * V_t + (b2 - 1) A_t): a body in free flight has no other force, and its M A is their rounding. */
static void add_inertia (void *context, const double *d, double *residual, double *reference)
{
    const course *m = context;
    pg_system *sys = &m->s->break_loop.system;
    const pg_state *f = m->from;
    double *v = newmark_of (m->s)->work1, *a = newmark_of (m->s)->work3, size = 0, parts = 0,
           alpha = PG_OWN (pg_newmark_options, &m->s->options)->alpha;
    rates (m, d, v, a);
    newmark_damp (m->s, v, residual);
    for (size_t i = 0; alpha != 0 && i < sys->ndof; i++)
        residual[i] = (1 + alpha) * residual[i] - alpha * newmark_of (m->s)->force0[i];
    double *known = newmark_of (m->s)->work4, *Mknown = known + sys->ndof, *Ma = Mknown + sys->ndof;
    memset (Mknown, 0, 2 * sys->ndof * sizeof *Mknown);
    for (size_t i = 0; i < sys->ndof; i++) known[i] = m->c.b[1] * f->v[i] + (m->c.b[2] - 1) * f->a[i];
    system_add_mass (sys, 1, known, Mknown);
    system_add_mass (sys, 1, a, Ma);
    for (size_t i = 0; i < sys->ndof; i++)
        residual[i] -= Ma[i], parts += Mknown[i] * Mknown[i], size += Ma[i] * Ma[i];
    *reference = fmax (*reference, fmax (sqrt (size), 1e-6 * sqrt (parts)));
}

static const dynamics *newmark_dynamics (pg_solver *s)
{
    const pg_newmark_options *own = PG_OWN (pg_newmark_options, &s->options);
    double b[8], share = 1 + own->alpha;
    pg_newmark_coefficients (&s->options, b);
    newmark_of (s)->dyn.k = share * (1 + b[3] * own->rayleigh_stiffness);
    newmark_of (s)->dyn.m = b[0] + share * b[3] * own->rayleigh_mass;
    return &newmark_of (s)->dyn;
}

/* One time step: a guess for the displacement, equilibrium with inertia and breaking at its end, velocity
 * and acceleration that belong to it, energies. */
static pg_status newmark_step (pg_solver *s, pg_state *state, pg_step *step)
{
    pg_status status = PG_OK;
    break_loop *b = &s->break_loop;
    int last = state->step + 1 >= s->options.steps;
    course m = { s, s->backup, coefficients_of (&s->options),
                 last ? s->options.end : (double) (state->step + 1) * s->options.dt };
    dynamics dyn = *newmark_dynamics (s);
    dyn.add = add_inertia, dyn.context = &m;
    double t = m.t;
    PG_TRY (newmark_supports (s, t, 0));
    if (b->round == 0) predict (&m, state->d);
    PG_TRY (equilibrate (b, state, t, state->d, &dyn, step));
    rates (&m, state->d, state->v, state->a);
    if (PG_OWN (pg_newmark_options, &s->options)->alpha != 0) PG_TRY (newmark_remember (s, t, state));
    s->report.energy_kinetic = newmark_kinetic (s, state->v);
    s->report.energy_strain = b->work_balance.strain;
    step->dissipated = b->work - b->work0 - (s->report.energy_strain + s->report.energy_kinetic - b->stored0);
    if (b->work_balance.reaction)
        memcpy (s->reaction, b->work_balance.reaction, 3 * s->problem->nload * sizeof *s->reaction);
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

static void newmark_free (pg_solver *s)
{
    newmark *n = newmark_of (s);
    pg_free (n->work1), pg_free (n->work2), pg_free (n->work3), pg_free (n->work4);
    pg_free (n->support), pg_free (n->force0);
}

/* With alpha the residual at the end of the last step enters the next. */
static pg_status newmark_keep (pg_solver *s, const pg_keeper *k)
{
    pg_status status = PG_OK;
    newmark *n = newmark_of (s);
    if (n->force0) PG_TRY (k->numbers (k->context, "newmark.force0", s->break_loop.system.ndof, n->force0));
done:
    return status;
}

/* ---- the entry ----------------------------------------------------------------------------------------- */
static void newmark_read (pg_solver_options *o, const pg_problem *problem, const pg_scene *scene)
{
    const pg_force_type *force = pg_force_of (problem);
    pg_newmark_options *own = PG_OWN (pg_newmark_options, o);
    options_read_times (o, problem, scene);
    own->rayleigh_mass = pg_scene_number (scene, "solver.rayleigh.mass");
    own->rayleigh_stiffness = pg_scene_number (scene, "solver.rayleigh.stiffness");
    own->consistent = strcmp (pg_scene_text (scene, "solver.mass"), "consistent") == 0;
    if (own->consistent && force && !force->mass_matrix)
        pg_scene_fault (scene, "solver.mass", "force: %s has no consistent mass: use lumped",
                        problem->method->name);
    own->alpha = pg_scene_number (scene, "solver.alpha");
    own->beta = pg_scene_given (scene, "solver.beta") ? pg_scene_number (scene, "solver.beta")
                                           : (1 - own->alpha) * (1 - own->alpha) / 4;
    own->gamma = pg_scene_given (scene, "solver.gamma") ? pg_scene_number (scene, "solver.gamma")
                                                        : 0.5 - own->alpha;
    if (own->gamma > 2 * own->beta)
        pg_scene_fault (scene, "solver.beta", "newmark is unconditionally stable only for 2 beta >= gamma");
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
    .flags = PG_SOLVER_IMPLICIT | PG_SOLVER_NEEDS_DENSITY,
    .keys = { &table, &solver_keys_breaking, &solver_keys_linear, &solver_keys_step, &solver_keys_time },
    .read = newmark_read,
    .start = newmark_start,
    .step = newmark_step,
    .free = newmark_free,
    .keep = newmark_keep,
    .own_size = sizeof (newmark),
    .dynamics = newmark_dynamics,
};

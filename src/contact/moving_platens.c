/* SPDX-License-Identifier: GPL-3.0-or-later
 * Rigid platens in explicit time integration (perigal/contact.h): leapfrog for the platens, penalty forces on
 * points.
 *
 * Along each axis a platen follows its prescribed displacement, is fixed, or (with a mass) moves by its
 * forces: v(n+1/2) = v(n-1/2) + dt F_n / M, u_n+1 = u_n + dt v(n+1/2). The force on the platen is minus the
 * sum of the forces on points, up to rounding of the sum. */
#include "near_pairs.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { SUM_ENERGY, SUM_HELD, SUM_TAKEN, SUM_OVERLAP, SUM_RATE, SUM_STIFF, SUM_FORCE, SUMS = SUM_FORCE + 3 };
static const double margin = 0.5;  /* spacings by which points may approach before the next search */

/* State of a moving platen: displacement, m, velocity, m/s, force on the body, external force, N. */
typedef struct { double u[3], v[3], force[3], press[3]; } platen_state;
typedef struct {
    platen_state now, start;
    double  place[3];                                  /* u at the last search for points, m */
    size_t *point, n, cap;                             /* points that may touch it before the next search */
    double *reach;                                     /* distance at which contact begins, per point, m */
    /* stretch of friction springs, now and at step start, m (n x 3); NULL: no friction */
    double *slip, *slip0;
    double  stiff;                                     /* total stiffness of the points in contact, N/m */
} one_platen;

struct pg_moving_platens {
    const pg_problem *problem;
    size_t  stride, dim, nplaten, touching;
    double  stiffness, finest;
    double *stiff, *share;                             /* k of each point, N/m; shear over normal stiffness */
    double *start;                                     /* displacements at the last search, m (n x stride) */
    double  way;                                       /* bound of the motion of points since then, m */
    double *force;                                     /* forces on the points, N (n x stride) */
    int     looked;
    one_platen *platen;
    double *sum;  size_t cap;
    double  taken, taken0;  /* work taken by friction springs, now and at step start, J */
    pg_moving_report now;
    double  work0;
};

void pg_moving_platens_free (pg_moving_platens **platens)
{
    pg_moving_platens *w = *platens;
    if (!w) return;
    for (size_t i = 0; w->platen && i < w->nplaten; i++)
        pg_free (w->platen[i].point), pg_free (w->platen[i].reach), pg_free (w->platen[i].slip),
            pg_free (w->platen[i].slip0);
    pg_free (w->now.platen);
    pg_free (w->platen), pg_free (w->force), pg_free (w->stiff), pg_free (w->share), pg_free (w->start),
        pg_free (w->sum);
    pg_free (w);
    *platens = NULL;
}

static double size_of (const pg_problem *p, size_t i) { return p->cloud.size
    ? p->cloud.size[i] : p->cloud.h; }

/* Sets the distance at which contact with each point begins: half the contact distance, at most the initial
 * distance. */
static pg_status start_platen (pg_moving_platens *w, size_t k, double distance)
{
    pg_status status = PG_OK;
    const pg_problem *p = w->problem;
    const pg_platen *own = &p->boundary.platen[k];
    one_platen *one = &w->platen[k];
    PG_ALLOC (one->reach, p->cloud.n);
    if (own->friction > 0) {
        PG_ALLOC (one->slip, 3 * p->cloud.n);
        PG_ALLOC (one->slip0, 3 * p->cloud.n);
    }
    memcpy (one->now.v, own->velocity, sizeof one->now.v);
    for (size_t i = 0; i < p->cloud.n; i++) {
        double normal[3], away = pg_platen_distance (own, p->dim, p->cloud.x + i * w->dim, normal);
        if (away < -PG_NO_LENGTH * size_of (p, i))
            PG_FAIL (PG_E_SCENE,
                     "platen %s: the point (%g, %g) m of the body lies %.3g m inside it at the start: put it "
                     "outside the body", own->name, p->cloud.x[i * w->dim],
                     w->dim > 1 ? p->cloud.x[i * w->dim + 1] : 0, -away);
        one->reach[i] = fmin (0.5 * distance * size_of (p, i), fmax (away, 0));
    }
done:
    return status;
}

pg_status pg_moving_platens_create (pg_moving_platens **out, const pg_problem *problem,
                                    const pg_contact_setting *setting, size_t stride)
{
    pg_status status = PG_OK;
    pg_moving_platens *w = NULL;
    size_t n = problem->cloud.n;
    *out = NULL;
    PG_ALLOC (w, 1);
    w->problem = problem, w->stride = stride, w->dim = (size_t) problem->dim,
    w->nplaten = problem->boundary.nplaten;
    w->stiffness = setting->stiffness, w->finest = pg_cloud_finest (&problem->cloud);
    PG_ALLOC (w->platen, w->nplaten);
    PG_ALLOC (w->stiff, n);
    PG_ALLOC (w->share, n);
    PG_ALLOC (w->force, n * stride);
    PG_ALLOC (w->start, n * stride);
    PG_ALLOC (w->now.platen, w->nplaten);
    for (size_t i = 0; i < n; i++) {
        const pg_material *m = pg_problem_law (problem, PG_NODES, i);
        double c = pg_material_waves (m).pressure, M = c > 0 ? m->density * c * c : m->modulus,
               s = size_of (problem, i);
        w->stiff[i] = w->stiffness * M * problem->cloud.volume[i] / (s * s);
        w->share[i] = fmin (m->mu / M, 1);
    }
    for (size_t k = 0; k < w->nplaten; k++) PG_TRY (start_platen (w, k, setting->distance));
    *out = w;
    w = NULL;
done:
    pg_moving_platens_free (&w);
    return status;
}

double pg_moving_platens_rate (const pg_moving_platens *w)
{
    const pg_problem *p = w->problem;
    double most = 0;
    int free = 0;
    for (size_t k = 0; k < w->nplaten; k++) free |= p->boundary.platen[k].mass > 0;
    for (size_t i = 0; i < p->cloud.n; i++)
        most = fmax (most, w->stiff[i]
                               / (p->material[p->block[PG_NODES][i]].density * p->cloud.volume[i]));
    return (free ? 2 : 1) * most;
}

/* ---- motion -------------------------------------------------------------------------------------------- */
static double load_at (const pg_problem *p, int load, int k, double t)
{
    static const double anywhere[3] = { 0 };
    return load < 0 || !p->boundary.load[load].value[k]
               ? 0
               : pg_load_value (&p->boundary.load[load], k, p->dim, anywhere, t);
}

/* Returns 1: the platen moves by its forces along axis k. */
static int goes_freely (const pg_platen *own, const pg_problem *p, int k)
{
    return own->mass > 0 && (own->motion < 0 || !p->boundary.load[own->motion].value[k]);
}

/* Moves platen i from t - dt to t, and adds the first half of the work of external forces and prescribed
 * motion. */
static void go (pg_moving_platens *w, size_t i, double t, double dt)
{
    const pg_problem *p = w->problem;
    const pg_platen *own = &p->boundary.platen[i];
    platen_state *s = &w->platen[i].now;
    for (int k = 0; k < p->dim; k++) {
        int free = goes_freely (own, p, k);
        double old = s->u[k];
        if (dt > 0 && free) s->u[k] += dt * s->v[k];
        else if (!free) s->u[k] = load_at (p, own->motion, k, t);
        if (dt > 0 && !free) s->v[k] = (s->u[k] - old) / dt;
        /* s->force: force of the platen on the body; s->press: external force on a free platen */
        w->now.work += 0.5 * (free ? s->press[k] : s->force[k]) * (dt > 0 ? s->u[k] - old : 0);
        s->press[k] = free ? load_at (p, own->force, k, t) : 0;
    }
}

/* Adds the second half of the work over the last step dt (s; 0: first step, v is the initial velocity); then
 * advances the velocity by half steps to t + step / 2, and adds the kinetic energy at t. */
static void kick (pg_moving_platens *w, size_t i, double dt, double step)
{
    const pg_problem *p = w->problem;
    const pg_platen *own = &p->boundary.platen[i];
    platen_state *s = &w->platen[i].now;
    for (int k = 0; k < p->dim; k++) {
        int free = goes_freely (own, p, k);
        double change = step * (s->press[k] - s->force[k]) / (free ? own->mass : 1), before = s->v[k];
        w->now.work += 0.5 * (free ? s->press[k] : s->force[k]) * dt * s->v[k];
        if (!free) continue;
        if (!(dt > 0)) before -= 0.5 * change, s->v[k] += 0.5 * change;
        else s->v[k] += change;
        w->now.kinetic += 0.5 * own->mass * before * s->v[k];
    }
}

/* ---- search for points --------------------------------------------------------------------------------- */
typedef struct { const pg_moving_platens *w; const double *d; double limit; double *most; } looking;
enum { BLOCK = 4096 };

static void look_at_blocks (void *context, size_t first, size_t last, int thread)
{
    const looking *l = context;
    size_t ndof = l->w->problem->cloud.n * l->w->stride;
    (void) thread;
    for (size_t b = first; b < last; b++) {
        double lane[8] = { 0 };
        size_t i = b * BLOCK, end = i + BLOCK < ndof ? i + BLOCK : ndof;
        for (; i + 8 <= end; i += 8)
            for (size_t k = 0; k < 8; k++) {
                double change = fabs (l->d[i + k] - l->w->start[i + k]);
                lane[k] = change > lane[k] ? change : lane[k];
            }
        for (; i < end; i++) lane[0] = fmax (lane[0], fabs (l->d[i] - l->w->start[i]));
        for (size_t k = 1; k < 8; k++) lane[0] = fmax (lane[0], lane[k]);
        l->most[b] = lane[0];
    }
}

/* *out 1: points or platens have moved so far that an unlisted point may touch. */
static pg_status must_look (pg_moving_platens *w, const double *d, int *out)
{
    pg_status status = PG_OK;
    size_t nblock = (w->problem->cloud.n * w->stride + BLOCK - 1) / BLOCK;
    double most = 0, rigid = 0, root = sqrt ((double) w->dim);
    *out = 1;
    if (!w->looked || w->problem->plain) return PG_OK;
    for (size_t i = 0; i < w->nplaten; i++)
        for (size_t k = 0; k < w->dim; k++)
            rigid = fmax (rigid, root * fabs (w->platen[i].now.u[k] - w->platen[i].place[k]));
    if (w->way + rigid > margin * w->finest) {  /* the bound is too large: measures the actual motion */
        PG_GROW (w->sum, w->cap, nblock);
        looking l = { w, d, 0, w->sum };
        pg_parallel (w->problem->threads, nblock, look_at_blocks, &l);
        for (size_t b = 0; b < nblock; b++) most = fmax (most, w->sum[b]);
        w->way = most * root;
    }
    *out = w->way + rigid > margin * w->finest;
done:
    return status;
}

/* Current distance of point i from the platen, m. */
static double distance_of (const pg_moving_platens *w, const pg_platen *own, const platen_state *s,
                           const double *d, size_t i, double *normal)
{
    double x[3] = { 0 };
    for (size_t k = 0; k < w->dim; k++)
        x[k] = w->problem->cloud.x[i * w->dim + k] + d[i * w->stride + k] - s->u[k];
    return pg_platen_distance (own, w->problem->dim, x, normal);
}

/* Lists the points of each platen within their contact distance plus margin, also slightly beside a plane of
 * finite width. */
static pg_status look (pg_moving_platens *w, const double *d)
{
    pg_status status = PG_OK;
    const pg_problem *p = w->problem;
    double spare = margin * w->finest, normal[3];
    for (size_t j = 0; j < w->nplaten; j++) {
        one_platen *one = &w->platen[j];
        pg_platen wide = p->boundary.platen[j];
        wide.width += 4 * spare;
        one->n = 0;
        for (size_t i = 0; i < p->cloud.n; i++) {
            if (!(distance_of (w, &wide, &one->now, d, i, normal) <= one->reach[i] + spare)) continue;
            PG_GROW (one->point, one->cap, one->n + 1);
            one->point[one->n++] = i;
        }
        memcpy (one->place, one->now.u, sizeof one->place);
    }
    memcpy (w->start, d, p->cloud.n * w->stride * sizeof *w->start);
    w->looked = 1, w->way = 0, w->now.looks++;
done:
    return status;
}

/* ---- forces -------------------------------------------------------------------------------------------- */
typedef struct { pg_moving_platens *w; size_t platen; const double *d, *v; double dt, *f; } pressing;

/* Adds the contact force of the platen on one point to f, and its contributions to energies etc. to `sum`. */
static void one_point (const pressing *a, size_t i, double *sum)
{
    pg_moving_platens *w = a->w;
    const pg_problem *p = w->problem;
    const pg_platen *own = &p->boundary.platen[a->platen];
    one_platen *one = &w->platen[a->platen];
    double e[3] = { 0 }, f[3] = { 0 }, move[3] = { 0 }, along = 0, length = 0, shorten = 1,
           across = w->stiff[i] * w->share[i], *slip = one->slip ? one->slip + 3 * i : NULL,
           overlap = one->reach[i] - distance_of (w, own, &one->now, a->d, i, e),
           press = w->stiff[i] * overlap, limit = own->friction * press;
    size_t dof = i * w->stride;
    memset (sum, 0, SUMS * sizeof *sum);
    for (size_t k = 0; slip && k < w->dim; k++) {
        move[k] = a->dt * (a->v[dof + k] - one->now.v[k]);
        sum[SUM_TAKEN] += 0.5 * across * slip[k] * move[k];
    }
    if (!(overlap > 0)) {
        if (slip) memset (slip, 0, 3 * sizeof *slip);
        return;
    }
    for (size_t k = 0; k < w->dim; k++) f[k] = press * e[k];
    sum[SUM_ENERGY] = 0.5 * press * overlap, sum[SUM_OVERLAP] = overlap, sum[SUM_STIFF] = w->stiff[i];
    sum[SUM_RATE] = 2 * w->stiff[i] / (p->material[p->block[PG_NODES][i]].density * p->cloud.volume[i]);
    for (size_t k = 0; slip && k < w->dim; k++) slip[k] += move[k], along += slip[k] * e[k];
    for (size_t k = 0; slip && k < w->dim; k++) slip[k] -= along * e[k], length += slip[k] * slip[k];
    if (across * sqrt (length) > limit) shorten = limit / (across * sqrt (length));
    for (size_t k = 0; slip && k < w->dim; k++) {
        slip[k] *= shorten;
        f[k] -= across * slip[k];
        sum[SUM_TAKEN] += 0.5 * across * slip[k] * move[k];
        sum[SUM_HELD] += 0.5 * across * slip[k] * slip[k];
    }
    for (size_t k = 0; k < w->dim; k++)
        a->f[dof + k] += f[k], w->force[dof + k] += f[k], sum[SUM_FORCE + k] = f[k];
}

static void press_points (void *context, size_t first, size_t last, int thread)
{
    const pressing *a = context;
    (void) thread;
    for (size_t q = first; q < last; q++) one_point (a, a->w->platen[a->platen].point[q],
                                                     a->w->sum + q * SUMS);
}

/* Computes the forces of one platen on all its points; sums in the order of the points. */
static pg_status press_all (pg_moving_platens *w, size_t j, const double *d, const double *v, double dt,
                            double *f, double *held)
{
    pg_status status = PG_OK;
    one_platen *one = &w->platen[j];
    pressing a = { w, j, d, v, dt, f };
    pg_moving_report *now = &w->now;
    PG_GROW (w->sum, w->cap, one->n * SUMS);
    pg_parallel (w->problem->threads, one->n, press_points, &a);
    memset (one->now.force, 0, sizeof one->now.force);
    one->stiff = 0;
    for (size_t q = 0; q < one->n; q++) {
        const double *sum = w->sum + q * SUMS;
        now->energy += sum[SUM_ENERGY] + sum[SUM_HELD], *held += sum[SUM_HELD];
        w->taken += sum[SUM_TAKEN], now->touching += sum[SUM_OVERLAP] > 0;
        now->overlap_max = fmax (now->overlap_max, sum[SUM_OVERLAP]);
        now->rate = fmax (now->rate, sum[SUM_RATE]);
        one->stiff += sum[SUM_STIFF];
        for (int k = 0; k < 3; k++) one->now.force[k] += sum[SUM_FORCE + k];
    }
    if (w->problem->boundary.platen[j].mass > 0)
        now->rate = fmax (now->rate, 2 * one->stiff / w->problem->boundary.platen[j].mass);
done:
    return status;
}

pg_status pg_moving_platens_add (pg_moving_platens *w, const double *d, const double *v, double t, double dt,
                                 double step, double way, double *f)
{
    pg_status status = PG_OK;
    double held = 0;
    int needed;
    w->way += way;
    for (size_t j = 0; j < w->nplaten; j++)
        for (size_t q = 0; q < w->platen[j].n; q++)
            memset (w->force + w->platen[j].point[q] * w->stride, 0, w->dim * sizeof *w->force);
    for (size_t j = 0; j < w->nplaten; j++) go (w, j, t, dt);
    PG_TRY (must_look (w, d, &needed));
    if (needed) PG_TRY (look (w, d));
    w->now.energy = w->now.kinetic = 0, w->now.touching = 0;
    for (size_t j = 0; j < w->nplaten; j++) PG_TRY (press_all (w, j, d, v, dt, f, &held));
    w->now.friction = w->taken - held;
    for (size_t j = 0; j < w->nplaten; j++) {
        kick (w, j, dt, step);
        pg_moving_platen *out = &w->now.platen[j];
        memcpy (out->force, w->platen[j].now.force, sizeof out->force);
        memcpy (out->displacement, w->platen[j].now.u, sizeof out->displacement);
        memcpy (out->velocity, w->platen[j].now.v, sizeof out->velocity);
    }
done:
    return status;
}

const double *pg_moving_platens_forces (const pg_moving_platens *w) { return w->force; }
const pg_moving_report *pg_moving_platens_now (const pg_moving_platens *w) { return &w->now; }

/* ---- memory -------------------------------------------------------------------------------------------- */
void pg_moving_platens_save (pg_moving_platens *w)
{
    for (size_t j = 0; j < w->nplaten; j++) {
        one_platen *one = &w->platen[j];
        one->start = one->now;
        if (one->slip) memcpy (one->slip0, one->slip, 3 * w->problem->cloud.n * sizeof *one->slip);
    }
    w->taken0 = w->taken, w->work0 = w->now.work;
}

void pg_moving_platens_return (pg_moving_platens *w)
{
    for (size_t j = 0; j < w->nplaten; j++) {
        one_platen *one = &w->platen[j];
        one->now = one->start;
        if (one->slip) memcpy (one->slip, one->slip0, 3 * w->problem->cloud.n * sizeof *one->slip);
    }
    w->taken = w->taken0, w->now.work = w->work0, w->looked = 0;
}

pg_status pg_moving_platens_keep (pg_moving_platens *w, const pg_keeper *k)
{
    pg_status status = PG_OK;
    one_platen *all = w->platen;
    PG_TRY (pg_keep_fields (k, "platens", NULL, "numbers", 1, PG_ROWS (
        PG_KEPT (w->taken), PG_KEPT (w->taken0), PG_KEPT (w->work0), PG_KEPT (w->now.work),
        PG_KEPT (w->now.energy), PG_KEPT (w->now.friction), PG_KEPT (w->now.overlap_max),
        PG_KEPT (w->now.rate))));
    PG_TRY (k->numbers (k->context, "platens.kinetic", 1, &w->now.kinetic));
    PG_TRY (pg_keep_fields (k, "platens", NULL, "states", w->nplaten, PG_ROWS (
        PG_EACH (all, now.u), PG_EACH (all, now.v), PG_EACH (all, now.force), PG_EACH (all, now.press),
        PG_EACH (all, start.u), PG_EACH (all, start.v), PG_EACH (all, start.force),
        PG_EACH (all, start.press))));
    for (size_t j = 0; j < w->nplaten; j++) {
        const one_platen *one = &all[j];
        char name[64];
        if (!one->slip) continue;
        snprintf (name, sizeof name, "platens.slip.%zu", j);
        PG_TRY (k->numbers (k->context, name, 3 * w->problem->cloud.n, one->slip));
        snprintf (name, sizeof name, "platens.slip0.%zu", j);
        PG_TRY (k->numbers (k->context, name, 3 * w->problem->cloud.n, one->slip0));
    }
    if (k->reading) w->looked = 0;
done:
    return status;
}

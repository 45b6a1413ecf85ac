/* SPDX-License-Identifier: GPL-3.0-or-later
 * The tube around a front: integration points of its cross sections, and its largest radius. It may contain
 * only one material and the two faces of its own crack: 16 rays in the plane across the front find where the
 * body ends; rays not directed backwards find other cracks; behind the front it is tested that the crack
 * continues (not so for a slim or kinked crack). Supports, loads on points except springs, and points of
 * another material limit the radius where they lie in the slice of the cross section.
 *
 * Integration points: Gauss points on radial pieces that end at the radii of front_radius, four on each of
 * eight arcs; none lies on the crack, at theta = +-pi. */
#include "front.h"
#include <math.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

/* ---- integration points -------------------------------------------------------------------------------- */
pg_status front_places_make (front_places *out, double h)
{
    enum { PIECES = 6, ARC = 4, MOST = 4, RINGS = 16, ANGLES = 32 };
    pg_status status = PG_OK;
    static const double end[PIECES + 1] = { 0, 0.5, 1, 1.5, 2.25, 3, 4 };
    static const int order[PIECES] = { 2, 2, 2, 3, 3, 4 };
    double x[MOST], w[MOST], y[ARC], v[ARC], arc = 2 * pi * ARC / ANGLES;
    PG_TRY (places_create (out, RINGS * ANGLES));
    pg_gauss_rule (ARC, y, v);
    for (int piece = 0; piece < PIECES; piece++) {
        double length = (end[piece + 1] - end[piece]) * h;
        pg_gauss_rule (order[piece], x, w);
        for (int i = 0; i < order[piece]; i++)
            for (int j = 0; j < ANGLES; j++) {
                size_t n = out->n++;
                out->r[n] = end[piece] * h + 0.5 * (1 + x[i]) * length;
                out->theta[n] = -pi + arc * (j / ARC + 0.5 * (1 + y[j % ARC]));
                out->area[n] = 0.25 * w[i] * v[j % ARC] * length * arc * out->r[n];
            }
    }
done:
    return status;
}

/* ---- room ---------------------------------------------------------------------------------------------- */
enum { RAYS = 16, STEPS = 4, HALVINGS = 20 };          /* STEPS: steps of a ray per spacing */
/* start of tests for cracks, for faces, in spacings */
static const double open_from = 0.6, behind_from = 1.2;
/* half angles (rad) about the backward direction in which a crack counts as the front's own faces, near the
 * front and farther out; limit of `near`, spacings */
static const double near_wedge = 1.05, far_wedge = 0.35, kink = 3;

typedef struct { const pg_problem *p; const pg_cracks *cracks; const front_place *at; double h; } view;

static void ray_at (const view *v, double r, double theta, double *x)
{
    const double *e = v->at->frame, *n = e + 3;
    for (int k = 0; k < 3; k++) x[k] = v->at->x[k] + r * (cos (theta) * e[k] + sin (theta) * n[k]);
}

static int is_cut (const view *v, const double *x, const double *y)
{
    return pg_cracks_cut (v->cracks, x, y, pg_cloud_same (&v->p->cloud)) != NULL;
}

/* Returns 1: the ray at angle theta is inside the body at distance r (below: meets no other crack up to
 * r). */
static int free_of_surface (const view *v, double r, double theta)
{
    double x[3];
    ray_at (v, r, theta, x);
    return pg_problem_has_body (v->p, x);
}

static int free_of_cracks (const view *v, double r, double theta)
{
    double x[3], y[3];
    ray_at (v, open_from * v->h, theta, x), ray_at (v, r, theta, y);
    return r <= open_from * v->h || !is_cut (v, x, y);
}

/* Returns 1: the crack extends to distance r behind the front: it crosses an arc (as chords) about the
 * backward direction. */
static int has_faces (const view *v, double r, double theta)
{
    enum { CHORDS = 6 };
    double x[3], y[3], wedge = r < kink * v->h * (1 - 1e-9) ? near_wedge : far_wedge;
    (void) theta;
    ray_at (v, r, pi - wedge, x);
    for (int i = 1; i <= CHORDS; i++, memcpy (x, y, sizeof x)) {
        ray_at (v, r, pi + wedge * (2.0 * i / CHORDS - 1), y);
        if (is_cut (v, x, y)) return 1;
    }
    return 0;
}

/* Largest r, m, up to which the test `ask` is true: by steps, then bisection. */
static double reach (const view *v, int (*ask) (const view *, double, double), double theta, double from,
                     double limit)
{
    double near = fmin (from, limit);
    for (int i = 1; near < limit; i++) {
        double far = fmin (from + (double) i / STEPS * v->h, limit);
        if (ask (v, far, theta)) {
            near = far;
            continue;
        }
        for (int k = 0; k < HALVINGS; k++) {
            double middle = 0.5 * (near + far);
            if (ask (v, middle, theta)) near = middle;
            else far = middle;
        }
        return near;
    }
    return limit;
}

/* Distance of x from the front in the plane across it, m; INFINITY: outside the slice. */
static double across (const view *v, const double *x)
{
    double d[3], along = 0, square = 0;
    for (int k = 0; k < 3; k++) {
        d[k] = x[k] - v->at->x[k];
        along += d[k] * v->at->frame[6 + k], square += d[k] * d[k];
    }
    return fabs (along) > 0.75 * v->h ? INFINITY : sqrt (fmax (0, square - along * along));
}

/* Reduces the room to the nearest point with a support or a point force. */
static double room_of_loads (const view *v, double room, int *load)
{
    const pg_problem *p = v->p;
    for (size_t l = 0; l < p->boundary.nload; l++) {
        const pg_set *set = p->boundary.load[l].set;
        if (p->boundary.load[l].kind == PG_BODY_FORCE || p->boundary.load[l].kind == PG_SPRING || !set)
            continue;
        for (size_t i = 0; i < set->npoint; i++) {
            double away = across (v, p->cloud.x + 3 * (size_t) set->point[i]);
            if (away < room) room = away, *load = (int) l;
        }
    }
    return room;
}

/* Returns 1: nodes i and j have equal stiffness, so that their interface does not affect the front. */
static int alike (const pg_problem *p, size_t i, size_t j)
{
    const pg_material *a = pg_problem_law (p, PG_NODES, i), *b = pg_problem_law (p, PG_NODES, j);
    double lambda[2] = { 0, 0 };
    if (p->form.patches)
        lambda[0] = p->form.patches->lambda[p->block[PG_NODES][i]],
        lambda[1] = p->form.patches->lambda[p->block[PG_NODES][j]];
    return a == b || (a->E == b->E && a->nu == b->nu && lambda[0] == lambda[1]);
}

int front_at_interface (const pg_problem *p, const double *x, double distance)
{
    size_t nearest = 0;
    double least = INFINITY;
    if (p->nmaterial == 1) return 0;
    for (int pass = 0; pass < 2; pass++)  /* first the nearest point, then all within the distance */
        for (size_t i = 0; i < p->cloud.n; i++) {
            double d = 0;
            for (size_t k = 0; k < 3; k++) d = hypot (d, p->cloud.x[3*i + k] - x[k]);
            if (pass == 0 && d < least) least = d, nearest = i;
            if (pass && d - 0.5 * pg_problem_spacing (p, PG_NODES, i) < distance && !alike (p, i, nearest))
                return 1;
        }
    return 0;
}

/* Reduces the room to the nearest point of a material of different stiffness. */
static double room_of_interfaces (const view *v, double room)
{
    const pg_problem *p = v->p;
    size_t nearest = 0;
    double least = INFINITY;
    if (p->nmaterial == 1) return room;
    for (size_t i = 0; i < p->cloud.n; i++) {
        double d = across (v, p->cloud.x + 3*i);
        if (d < least) least = d, nearest = i;
    }
    for (size_t i = 0; i < p->cloud.n; i++) {
        double away = across (v, p->cloud.x + 3*i) - 0.5 * pg_problem_spacing (p, PG_NODES, i);
        if (away < room && !alike (p, i, nearest)) room = fmax (0, away);
    }
    return room;
}

double front_room (const pg_problem *p, const pg_state *state, const front_place *at, double h, double offset,
                   double limit, int tail, int *load)
{
    view v = { p, pg_state_cracks (p, state), at, h };
    double room = limit, loads, away = 0, x[3] = { at->x[0], at->x[1], at->x[2] };
    if (!tail && !(p->body.n && (pg_body_nearest (&p->body, x, &away), away >= limit)))
        for (int i = 0; i < RAYS; i++) room = reach (&v, free_of_surface, 2 * pi * i / RAYS, 0, room);
    *load = -1;
    if (!tail) room = room_of_loads (&v, room, load);
    loads = room;
    for (int i = -5; i <= 5; i++) room = reach (&v, free_of_cracks, pi * i / 8, open_from * h, room);
    room = reach (&v, has_faces, 0, fmax (behind_from * h, 1.2 * offset), room);
    room = room_of_interfaces (&v, room);
    if (room < loads) *load = -1;
    return room;
}

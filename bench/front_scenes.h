/* SPDX-License-Identifier: GPL-3.0-or-later
 * front_scenes.h: bodies with cracks in space whose stress intensity factors are known, solved once, and
 * their fronts measured. Included by the bench and by tests. E = 1, the spacing is 1 unit.
 *
 *   penny      a disc in a cube of half width 1.6 radii + half a spacing, the exact field (of an infinite
 *              body) held on all faces; under tension along its normal, or shear
 *   straight   a cut up to a straight front in a cube, the field of K_I held on all faces
 *   surface    a semi-ellipse on the face of a plate in tension: J. C. Newman, I. S. Raju, An empirical
 *              stress-intensity factor equation for the surface crack, Eng. Fract. Mech. 15 (1981) 185-192
 *
 * The field of the penny-shaped crack is that of test/crack/fracture/penny.h, in real numbers. With R1 =
 * A + i B,
 * R1^2 = r^2 + (z + i a)^2, P = A + z, Q = B + a, D = P^2 + Q^2, N = A^2 + B^2, the angle w = atan2 (Q, P):
 *
 *   psi = z w - B,  psi,z = w - a A / N,  psi,x / x = (B - z (A Q + B P) / D) / N,
 *   phi,x / x = g = - w / 2 + (a P + z Q) / (2 D),   phi,xx = g + x^2 g',  phi,xy = x y g',
 *   g' = P Q / D^2 - a (A (P^2 - Q^2) - 2 B P Q) / (N D^2). */
#ifndef PERIGAL_BENCH_FRONT_SCENES_H
#define PERIGAL_BENCH_FRONT_SCENES_H
#include "perigal.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

typedef struct {
    const char *kind;         /* penny, straight, surface */
    double a, c;              /* radius; depth and half length; side - spacings */
    double p, tau;            /* stress along the normal, shear along axis 1 */
    double axes[9], shift[3]; /* rows: x, y, z = normal of the crack; spacings */
    double perturb, nu, unit; /* of the points; Poisson's ratio; spacing, m */
    const char *method, *linear;                       /* linear solver; NULL: the scene's own choice */
} front_case;

typedef struct {
    size_t n, points, iterations;
    pg_tip_field *field;
    double (*K)[3];           /* what is right, Pa m^(1/2) */
    double *angle;            /* around the front, rad */
    double J, solve, measure; /* the largest right J; processor seconds */
} front_result;

enum { FRONT_TEXT = 1 << 18 };

/* Text by a format; returns its length. A text that is cut is no scene, and told as such. */
static inline size_t front_say (char *out, size_t size, const char *format, ...)
    __attribute__ ((format (printf, 3, 4)));
static inline size_t front_say (char *out, size_t size, const char *format, ...)
{
    va_list args;
    va_start (args, format);
    int length = vsnprintf (out, size, format, args);
    va_end (args);
    return length < 0 ? 0 : (size_t)length;
}

/* ---- text ---------------------------------------------------------------------------------------------- */
/* Local coordinate k as text, in units: the spacing. */
static inline void front_coordinate (const front_case *c, int k, char *out, size_t size)
{
    const double *r = c->axes + 3 * k;
    front_say (out, size, "(%.12g*(x/(%.12g m)-%.12g)+%.12g*(y/(%.12g m)-%.12g)+%.12g*(z/(%.12g m)-%.12g))",
               r[0], c->unit, c->shift[0], r[1], c->unit, c->shift[1], r[2], c->unit, c->shift[2]);
}

typedef struct {
    char X[300], Y[300], Z[300], side[800], A[2000], B[2000], P[3000], Q[3000], D[8000], N[5000];
} front_words;

static inline void front_words_of (const front_case *c, front_words *w)
{
    char z[300], q[2000], S[5000];
    front_coordinate (c, 0, w->X, sizeof w->X), front_coordinate (c, 1, w->Y, sizeof w->Y);
    front_coordinate (c, 2, z, sizeof z);
    front_say (w->Z, sizeof w->Z, "abs(%s)", z);
    front_say (w->side, sizeof w->side, "(%s/max(abs(%s),1e-30))", z, z);
    front_say (q, sizeof q, "((x/(%.12g m)-%.12g)^2+(y/(%.12g m)-%.12g)^2+(z/(%.12g m)-%.12g)^2-%.12g)",
               c->unit, c->shift[0], c->unit, c->shift[1], c->unit, c->shift[2], c->a * c->a);
    front_say (S, sizeof S, "hypot(%s,%.12g*%s)", q, 2 * c->a, z);
    front_say (w->A, sizeof w->A, "sqrt(max(0,(%s+%s)/2))", S, q);
    front_say (w->B, sizeof w->B, "sqrt(max(0,(%s-%s)/2))", S, q);
    front_say (w->P, sizeof w->P, "(%s+%s)", w->A, w->Z),
        front_say (w->Q, sizeof w->Q, "(%s+%.12g)", w->B, c->a);
    front_say (w->D, sizeof w->D, "(%s^2+%s^2)", w->P, w->Q), front_say (w->N, sizeof w->N, "%s", S);
}

/* Displacement of the penny-shaped crack with free faces, component k of the scene, m. */
static inline void penny_text (const front_case *c, int k, char *out, char *part)
{
    front_words *w = calloc (1, sizeof *w);
    double pi = acos (-1), mu = 1 / (2 * (1 + c->nu)), p = c->p / (pi * mu), a = c->a, nu = c->nu,
           t = 2 * c->tau / (pi * (2 - nu) * mu), e = c->p / (2 * mu * (1 + nu));
    char *g = part, *psi = g + FRONT_TEXT / 8, *across = psi + FRONT_TEXT / 8,
         *along = across + FRONT_TEXT / 8, *slope = along + FRONT_TEXT / 8;
    size_t room = FRONT_TEXT / 8;
    front_words_of (c, w);
    front_say (g, room, "(-atan2(%s,%s)/2+(%.12g*%s+%s*%s)/(2*%s))", w->Q, w->P, a, w->P, w->Z, w->Q, w->D);
    front_say (psi, room, "(%s*atan2(%s,%s)-%s)", w->Z, w->Q, w->P, w->B);
    front_say (across, room, "((%s-%s*(%s*%s+%s*%s)/%s)/%s)", w->B, w->Z, w->A, w->Q, w->B, w->P, w->D,
               w->N);
    front_say (along, room, "(atan2(%s,%s)-%.12g*%s/%s)", w->Q, w->P, a, w->A, w->N);
    front_say (slope, room, "((%s*%s-%.12g*(%s*(%s^2-%s^2)-2*%s*%s*%s)/%s)/%s^2)", w->P, w->Q, a, w->A,
               w->P, w->Q, w->B, w->P, w->Q, w->N, w->D);
    const double *r0 = c->axes, *r1 = r0 + 3, *r2 = r0 + 6;
    size_t used = 0;
#define ADD(...) used += front_say (out + used, FRONT_TEXT - used, __VA_ARGS__)
    ADD ("%.12g m*(0", c->unit);
    if (c->p != 0) {
        /* in the plane of the crack by (x, y), then along its normal */
        ADD ("+(%.12g*%s+%.12g*%s)*(%.12g+%.12g*(%.12g*%s+%s*%s))", r0[k], w->X, r1[k], w->Y, -nu * e, p,
             1 - 2 * nu, g, w->Z, across);
        ADD ("+%.12g*%s*(%.12g*%s+%.12g*(%.12g*%s+%s*%s))", r2[k], w->side, e, w->Z, p, -2 * (1 - nu), psi,
             w->Z, along);
    }
    if (c->tau != 0) {
        ADD ("+%s*(%.12g*(%.12g*%s+%.12g*(%.12g*%s+%s*(%s+%s^2*%s)))", w->side, r0[k], c->tau / mu, w->Z, t,
             -2 * (1 - nu), psi, w->Z, g, w->X, slope);
        ADD ("+%.12g*%.12g*%s*%s*%s*%s)", r1[k], t, w->Z, w->X, w->Y, slope);
        ADD ("+%.12g*%.12g*%s*(%.12g*%s+%s*%s)", r2[k], t, w->X, -(1 - 2 * nu), g, w->Z, across);
    }
    ADD (")");
    free (w);
}

/* Displacement of K_I = p: axis 1 ahead, axis 3 the normal, axis 2 along the front (e x n = - axis 2). */
static inline void straight_text (const front_case *c, int k, char *out)
{
    char X[300], Z[300], half[800], radius[700];
    double mu = 1 / (2 * (1 + c->nu)), kappa = 3 - 4 * c->nu, root = c->p / (2 * mu * sqrt (2 * acos (-1)));
    front_coordinate (c, 0, X, sizeof X), front_coordinate (c, 2, Z, sizeof Z);
    front_say (half, sizeof half, "atan2(%s,%s)/2", Z, X);
    front_say (radius, sizeof radius, "sqrt(hypot(%s,%s))", X, Z);
    front_say (out, FRONT_TEXT,
               "%.12g m*%s*(%.12g*cos(%s)*(%.12g+2*sin(%s)^2)+%.12g*sin(%s)*(%.12g-2*cos(%s)^2))",
               c->unit * root * sqrt (1 / c->unit), radius, c->axes[k], half, kappa - 1, half,
               c->axes[6 + k], half, kappa + 1, half);
}

/* ---- scenes -------------------------------------------------------------------------------------------- */
static inline size_t front_place_text (const front_case *c, double x, double y, char *out, size_t size)
{
    double v[3];
    for (int k = 0; k < 3; k++) v[k] = c->unit * (c->shift[k] + x * c->axes[k] + y * c->axes[3 + k]);
    return front_say (out, size, "[%.12g, %.12g, %.12g]", v[0], v[1], v[2]);
}

static inline size_t front_head (const front_case *c, char *out, size_t size)
{
    return front_say (out, size,
                      "dimension: 3\nspacing: %.12g\nlattice: cells\nperturb: {amount: %g, seed: 1}\n"
                      "materials: {m: {youngs_modulus: 1, poissons_ratio: %g}}\nmethod: {%s%s}\n"
                      "solver: {kind: static, linear: %s}\noutput: {at: {levels: 1}}\n",
                      c->unit, c->perturb, c->nu, c->method,
                      c->kind[1] == 'u' ? ", penalty_factor: 1e-3" : "", c->linear ? c->linear : "auto");
}

/* A cube about the origin, the displacement held on all of it. */
static inline void cube_scene (const front_case *c, char *out, char *part)
{
    int penny = strcmp (c->kind, "penny") == 0;
    double H = c->unit * (penny ? ceil (1.6 * c->a) + 0.5 : c->a), far = 5 * c->a;
    size_t used = front_head (c, out, 4 * FRONT_TEXT);
    used += front_say (out + used, 4 * FRONT_TEXT,
                       "body: [{add: {box: {low: [%.12g, %.12g, %.12g], high: [%.12g, %.12g, %.12g]}}}]\n",
                       -H, -H, -H, H, H, H);
    if (penny) {
        used += front_say (out + used, 4 * FRONT_TEXT, "cracks: [{disc: {center: ");
        used += front_place_text (c, 0, 0, out + used, 200);
        used +=
            front_say (out + used, 4 * FRONT_TEXT, ", normal: [%.12g, %.12g, %.12g], radius: %.12g}}]\n",
                       c->axes[6], c->axes[7], c->axes[8], c->unit * c->a);
    } else {
        double corner[4][2] = { { 0, -far }, { 0, far }, { -far, far }, { -far, -far } };
        used += front_say (out + used, 4 * FRONT_TEXT, "cracks: [{polygon: [");
        for (int i = 0; i < 4; i++) {
            if (i) used += front_say (out + used, 4 * FRONT_TEXT, ", ");
            used += front_place_text (c, corner[i][0], corner[i][1], out + used, 200);
        }
        used += front_say (out + used, 4 * FRONT_TEXT, "]}]\n");
    }
    used += front_say (out + used, 4 * FRONT_TEXT,
                       "sets: {rim: {boundary: side}}\nboundary: [{set: rim, displacement: {");
    for (int k = 0; k < 3; k++) {
        used += front_say (out + used, 4 * FRONT_TEXT, "%s%c: \"", k ? ", " : "", "xyz"[k]);
        if (penny) penny_text (c, k, out + used, part);
        else straight_text (c, k, out + used);
        used += strlen (out + used);
        used += front_say (out + used, 4 * FRONT_TEXT, "\"");
    }
    front_say (out + used, 4 * FRONT_TEXT, "}}]\n");
}

/* Width, thickness and height of the plate about its crack. */
static inline void plate_of (const front_case *c, double *b, double *t, double *H)
{
    *b = 2.5 * c->c, *t = 2.5 * c->a, *H = 2.5 * c->c;
}

/* A plate in tension along z, turned about z by the axes; the crack lies on its face y = 0, depth along y.
 * Soft springs on one end, of a thousandth of the stiffness of the points, bear nothing but hold it. */
static inline void surface_scene (const front_case *c, char *out)
{
    enum { CORNERS = 48 };
    double b, t, H, pi = acos (-1);
    plate_of (c, &b, &t, &H);
    size_t used = front_head (c, out, 4 * FRONT_TEXT);
    double corner[4][2] = { { -b, 0 }, { b, 0 }, { b, t }, { -b, t } };
    used += front_say (out + used, 4 * FRONT_TEXT, "body: [{add: {prism: {vertices: [");
    for (int i = 0; i < 4; i++) {
        double x = corner[i][0], y = corner[i][1];
        used += front_say (out + used, 4 * FRONT_TEXT, "%s[%.12g, %.12g]", i ? ", " : "",
                           c->unit * (x * c->axes[0] + y * c->axes[3]),
                           c->unit * (x * c->axes[1] + y * c->axes[4]));
    }
    used += front_say (out + used, 4 * FRONT_TEXT, "], low: %.12g, high: %.12g}}}]\ncracks: [{polygon: [",
                       -H * c->unit, H * c->unit);
    for (int i = 0; i <= CORNERS; i++) {
        double f = pi * i / CORNERS, x = c->c * cos (f), y = c->a * sin (f);
        if (i == 0 || i == CORNERS) y = -0.5; /* beyond the face */
        double at[2] = { c->unit * (x * c->axes[0] + y * c->axes[3]),
                         c->unit * (x * c->axes[1] + y * c->axes[4]) };
        used += front_say (out + used, 4 * FRONT_TEXT, "%s[%.12g, %.12g, %.12g]", i ? ", " : "", at[0],
                           at[1], c->unit * c->shift[2]);
    }
    front_say (out + used, 4 * FRONT_TEXT,
               "]}]\nboundary: [{set: front, traction: {z: %g}}, {set: back, traction: {z: %g}}, {set: "
               "back, displacement: {x: 0, y: 0, z: 0}, essential: penalty}]\n",
               c->p, -c->p);
}

/* ---- what is right ------------------------------------------------------------------------------------- */
/* Newman and Raju, at the parametric angle f of the ellipse; a <= c. */
static inline double newman_raju (const front_case *c, double f)
{
    double b, t, H, pi = acos (-1), s = c->a / c->c;
    plate_of (c, &b, &t, &H);
    double u = c->a / t, M1 = 1.13 - 0.09 * s, M2 = -0.54 + 0.89 / (0.2 + s),
           M3 = 0.5 - 1 / (0.65 + s) + 14 * pow (1 - s, 24),
           g = 1 + (0.1 + 0.35 * u * u) * pow (1 - sin (f), 2),
           shape = pow (s * s * cos (f) * cos (f) + sin (f) * sin (f), 0.25),
           width = sqrt (1 / cos (pi * c->c / (2 * b) * sqrt (u))), Q = 1 + 1.464 * pow (s, 1.65);
    return c->p * sqrt (pi * c->a * c->unit / Q) * (M1 + M2 * u * u + M3 * pow (u, 4)) * g * shape * width;
}

static inline void right_at (const front_case *c, const double *x, double *angle, double *K)
{
    double y[3] = { 0 }, root = sqrt (c->a * c->unit / acos (-1)), t = 4 * c->tau / (2 - c->nu) * root;
    for (int k = 0; k < 3; k++)
        for (int m = 0; m < 3; m++)
            y[k] += c->axes[3 * k + m] *
                    (x[m] / c->unit - (c->kind[0] == 's' && c->kind[1] == 'u' ? 0 : c->shift[m]));
    K[1] = K[2] = *angle = 0;
    if (strcmp (c->kind, "surface") == 0)
        *angle = atan2 (y[1] / c->a, y[0] / c->c), K[0] = newman_raju (c, *angle);
    else if (strcmp (c->kind, "penny") == 0) {
        *angle = atan2 (y[1], y[0]);
        K[0] = 2 * c->p * root, K[1] = t * cos (*angle), K[2] = (1 - c->nu) * t * sin (*angle);
    } else K[0] = c->p;
}

/* ---- solving ------------------------------------------------------------------------------------------- */
static inline double front_seconds (void) { return (double)clock () / CLOCKS_PER_SEC; }

static inline pg_status front_solve (const front_case *c, front_result *out)
{
    pg_status status = PG_OK;
    char *text = calloc (5, FRONT_TEXT), *part = calloc (1, FRONT_TEXT);
    pg_scene *scene = NULL;
    pg_problem *problem = NULL;
    pg_solver *solver = NULL;
    pg_state *state = NULL;
    pg_solver_options options;
    pg_step step = { 0 };
    void *self;
    const double one = 1;
    memset (out, 0, sizeof *out);
    if (strcmp (c->kind, "surface") == 0) surface_scene (c, text);
    else cube_scene (c, text, part);
    PG_TRY (pg_scene_parse (&scene, text, "front.yaml"));
    double begun = front_seconds ();
    PG_TRY (pg_problem_build (&problem, scene, 1));
    PG_TRY (pg_solver_options_read (&options, problem, scene));
    PG_TRY (pg_solver_create (&solver, problem, &options));
    PG_TRY (pg_state_create (&state, problem, pg_solver_components (solver)));
    while (!pg_solver_done (solver, state)) PG_TRY (pg_solver_step (solver, state, &step));
    double solved = front_seconds ();
    if (problem->crack.nfront != 1)
        PG_FAIL (PG_E_USAGE, "%zu fronts where one was expected", problem->crack.nfront);
    out->n = problem->crack.front[0].n, out->points = problem->cloud.n;
    PG_ALLOC (out->field, out->n);
    PG_ALLOC (out->K, out->n);
    PG_ALLOC (out->angle, out->n);
    const pg_force_type *force = pg_solver_force (solver, &self);
    const double *d = state->d;
    PG_TRY (pg_front_measure (out->field, problem, force, self, state, 0, 1, &d, &one, NULL));
    out->solve = solved - begun, out->measure = front_seconds () - solved;
    for (size_t i = 0; i < out->n; i++) {
        right_at (c, out->field[i].x, &out->angle[i], out->K[i]);
        double *K = out->K[i],
               J = (1 - c->nu * c->nu) * (K[0] * K[0] + K[1] * K[1]) + (1 + c->nu) * K[2] * K[2];
        out->J = fmax (out->J, J);
    }
done:
    pg_state_free (&state), pg_solver_free (&solver), pg_problem_free (&problem), pg_scene_free (&scene);
    free (text), free (part);
    return status;
}

static inline void front_result_clear (front_result *r)
{
    pg_free (r->field), pg_free (r->K), pg_free (r->angle);
    memset (r, 0, sizeof *r);
}
#endif

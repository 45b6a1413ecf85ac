/* SPDX-License-Identifier: GPL-3.0-or-later
 * New cracks in 3D. As in 2D (initiation.c) one begins where two conditions hold together
 * (Leguillon 2002): the tension across it reaches the strength everywhere on it, and the energy that it sets
 * free reaches what its area takes. It is tried as a disc across the largest tension; at the surface of the
 * body what lies inside is a half disc, in an edge a quarter.
 *
 * Hot spots are the nodes whose stress, averaged over the node and its nearest neighbours, reaches the
 * strength at the least load factor. There the radius is estimated with the energy of a disc under the mean
 * tension s on it, 8 s^2 R^3 / (3 E') (Sneddon 1946; half discs 1.12^2 times that for their area), E' = E /
 * (1 - nu^2); then three radii about it are cut on a copy of the state and solved for, energy over R^3 is
 * fitted by a straight line, and the radius is where both load factors are equal, or the larger one least. */
#include "front_growth.h"
#include "hot_spot.h"
#include "perigal/vector.h"
#include <math.h>
#include <string.h>

enum { RADII = 3, RIM = 24, RINGS = 3, SPOTS = 2, SIDES = 24, ROUNDS = 2, STEPS = 40 };

/* A trial disc: a new crack in 3D. */
typedef struct {
    double centre[3], normal[3], across[2][3];         /* centre, m; others: unit, last two in plane */
    double h, modulus, strength, energy;               /* spacing, m; E', Pa; Pa; J/m^2 */
    double factor, radius;                             /* load factor at which it forms; m */
    trial_sizes sizes;                                 /* energy that discs of several radii release */
} disc;

static const pg_problem *problem_of (const search *g) { return g->w->system->problem; }

/* Sets the second axis in the plane of the disc. */
static void complete (disc *d) { pg_cross3 (d->normal, d->across[0], d->across[1]); }

/* ---- stress -------------------------------------------------------------------------------------------- */
/* out = constant part and slope in lambda, from the values of fields 0 and 1. */
static void affine_parts (const trial_fields *f, double first, double second, double out[2])
{
    out[0] = f->n == 2 ? first : 0, out[1] = f->n == 2 ? second - first : first;
}

static double largest (const double s[6])
{
    double principal[3];
    pg_principal (3, 1, s, NULL, principal);
    return principal[0];
}

/* Smallest load factor below `most` at which the largest principal stress reaches f; INFINITY: none. The
 * stress is convex in the factor: below f at both ends, it is below f between them. */
static double strength_factor (const trial_fields *fields, const double *first, const double *second,
                               double f,
                               double most)
{
    enum { HALVINGS = 40 };
    double low = 0, high = most, s[6], part[2];
    for (int k = 0; k < 6; k++) affine_parts (fields, first[k], second[k], part),
        s[k] = part[0] + most * part[1];
    if (largest (s) < f) return INFINITY;
    for (int step = 0; step < HALVINGS; step++) {
        double middle = 0.5 * (low + high);
        for (int k = 0; k < 6; k++)
            affine_parts (fields, first[k], second[k], part), s[k] = part[0] + middle * part[1];
        if (largest (s) < f) low = middle;
        else high = middle;
    }
    return high;
}

/* out = mean of a stress field over node i and its neighbours within 1.1 spacings by intact bonds; nodes that
 * a lattice has put outside the body only continue the inside, and are left out. */
static void mean_stress (const search *g, size_t i, const double *stress, double out[6])
{
    const pg_problem *p = problem_of (g);
    const pg_rows *r = &p->bonds.rows[PG_NODES];
    double reach = 1.1 * pg_problem_spacing (p, PG_NODES, i), n = 1;
    memcpy (out, stress + 6*i, 6 * sizeof *out);
    for (size_t e = r->family.start[i]; e < r->family.start[i + 1]; e++) {
        size_t j = (size_t) r->family.node[e];
        if (j == i || pg_distance3 (p->cloud.x + 3*i, p->cloud.x + 3*j) > reach) continue;
        if (!g->state->alive[p->bonds.first[PG_NODES] + e]) continue;
        if (!pg_problem_has_body (p, p->cloud.x + 3*j)) continue;
        for (int k = 0; k < 6; k++) out[k] += stress[6*j + (size_t) k];
        n++;
    }
    for (int k = 0; k < 6; k++) out[k] /= n;
}

/* ---- hot spots ----------------------------------------------------------------------------------------- */
/* Finds the limits for a crack at node i, the strength as far as the spacing resolves it; 0: none begins
 * there. */
static int resists (const search *g, size_t i, pg_fracture_limits *out, double *modulus)
{
    const pg_problem *p = problem_of (g);
    const pg_material *m = pg_problem_law (p, PG_NODES, i);
    *modulus = m->E / (1 - m->nu * m->nu);
    return hot_resists (g, p->cloud.x + 3*i, 0, pg_problem_spacing (p, PG_NODES, i), m->E, out)
           && out->strength > 0;
}

/* Sets the plane across the largest tension at the load factor. The two other principal stresses, which may
 * be equal, do not determine the corners of the disc. */
static void set_frame (const search *g, const double *first, const double *second, disc *d)
{
    double S[9], lambda[3], V[9], s[6], part[2];
    for (int k = 0; k < 6; k++)
        affine_parts (g->f, first[k], second[k], part), s[k] = part[0] + d->factor * part[1];
    const double full[9] = { s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2] };
    memcpy (S, full, sizeof S);
    pg_dense_eigen (3, S, lambda, V);
    for (int k = 0; k < 3; k++) d->normal[k] = V[3*k];
    pg_plane_axis (d->normal, d->across[0]);
    complete (d);
}

/* Distance from a point in the unit direction e to the end of the body, by bisection from `most`; INFINITY:
 * the body reaches to `most`. */
static double way_out (const pg_problem *p, const double *from, const double *e, double most)
{
    double low = 0, high = most, x[3];
    pg_shift3 (from, e, high, x);
    if (pg_problem_has_body (p, x)) return INFINITY;
    for (int step = 0; step < STEPS; step++) {
        double middle = 0.5 * (low + high);
        pg_shift3 (from, e, middle, x);
        if (pg_problem_has_body (p, x)) low = middle;
        else high = middle;
    }
    return low;
}

/* Moves a centre within a spacing of the surface to it, along the nearest of 26 directions; where several are
 * equally near, along their sum, as into the edge between two faces. Half way between opposite faces it
 * stays. */
static void go_to_surface (const pg_problem *p, disc *d)
{
    enum { DIRECTIONS = 27 };
    double e[DIRECTIONS][3], way[DIRECTIONS], least = INFINITY, sum[3] = { 0 };
    double same = pg_cloud_same (&p->cloud), most = d->h + 4 * same;
    for (int q = 0; q < DIRECTIONS; q++) {
        e[q][0] = q % 3 - 1, e[q][1] = q / 3 % 3 - 1, e[q][2] = q / 9 - 1;
        way[q] = pg_unit3 (e[q]) ? way_out (p, d->centre, e[q], most) : INFINITY;
        least = fmin (least, way[q]);
    }
    if (!(least <= d->h + same)) return;
    for (int q = 0; q < DIRECTIONS; q++) if (way[q] <= least + same) pg_shift3 (sum, e[q], 1, sum);
    if (!(pg_size3 (sum) > 1e-6)) return;
    pg_unit3 (sum);
    double along = way_out (p, d->centre, sum, 2 * most);
    if (isfinite (along)) pg_shift3 (d->centre, sum, along, d->centre);
}

/* The node with the smallest load factor that is not near one of the n discs; the number of nodes: none. */
static size_t next_node (const pg_problem *p, const double *factor, size_t n, const disc *spot)
{
    size_t best = p->cloud.n;
    for (size_t i = 0; i < p->cloud.n; i++) {
        int near = 0;
        for (size_t k = 0; k < n && !near; k++)
            near = pg_distance3 (p->cloud.x + 3*i, spot[k].centre) < HOT_APART * spot[k].h;
        if (!near && isfinite (factor[i]) && (best == p->cloud.n || factor[i] < factor[best])) best = i;
    }
    return best;
}

/* Finds up to SPOTS nodes with the smallest load factors, HOT_APART spacings apart, and centre and frame of
 * their discs. */
static pg_status find_spots (const search *g, disc *out, size_t *n)
{
    pg_status status = PG_OK;
    const pg_system *s = g->w->system;
    const pg_problem *p = s->problem;
    double *stress[2] = { NULL, NULL }, *factor = NULL, first[6], second[6], modulus;
    int components;
    const char *unit;
    pg_fracture_limits limits;
    *n = 0;
    PG_ALLOC (factor, p->cloud.n);
    for (int a = 0; a < g->f->n; a++) {
        PG_ALLOC (stress[a], 6 * p->cloud.n);
        PG_TRY (s->force->field (s->self, g->state, g->f->d[a], "stress", &components, &unit, stress[a]));
    }
    for (size_t i = 0; i < p->cloud.n; i++) {
        factor[i] = INFINITY;
        if (!pg_problem_has_body (p, p->cloud.x + 3*i) || !resists (g, i, &limits, &modulus)) continue;
        mean_stress (g, i, stress[0], first);
        mean_stress (g, i, stress[g->f->n - 1], second);
        factor[i] = strength_factor (g->f, first, second, limits.strength, g->best);
        if (isfinite (factor[i]) && hot_excluded (g, p->cloud.x + 3*i, pg_problem_spacing (p, PG_NODES, i)))
            factor[i] = INFINITY;
    }
    for (size_t best; *n < SPOTS && (best = next_node (p, factor, *n, out)) < p->cloud.n; ++*n) {
        disc *d = &out[*n];
        *d = (disc) { .factor = factor[best], .h = pg_problem_spacing (p, PG_NODES, best) };
        resists (g, best, &limits, &d->modulus);
        d->strength = limits.strength, d->energy = limits.energy;
        memcpy (d->centre, p->cloud.x + 3 * best, sizeof d->centre);
        mean_stress (g, best, stress[0], first);
        mean_stress (g, best, stress[g->f->n - 1], second);
        set_frame (g, first, second, d);
        go_to_surface (p, d);
    }
done:
    pg_free (stress[0]), pg_free (stress[1]), pg_free (factor);
    return status;
}

/* ---- one disc ------------------------------------------------------------------------------------------ */
static void place_on (const disc *d, double r, double angle, double *x)
{
    for (int k = 0; k < 3; k++)
        x[k] = d->centre[k] + r * (cos (angle) * d->across[0][k] + sin (angle) * d->across[1][k]);
}

/* Share of the disc that lies inside the body. */
static double share_inside (const pg_problem *p, const disc *d, double R)
{
    enum { PLACES = 12 };
    double in = 0, x[3];
    for (int a = 0; a < PLACES; a++)
        for (int q = 0; q < 4 * PLACES; q++) {
            place_on (d, R * sqrt ((a + 0.5) / PLACES), 2 * acos (-1) * (q + 0.5) / (4 * PLACES), x);
            in += pg_problem_has_body (p, x);
        }
    return in / (4 * PLACES * PLACES);
}

static double energy_of (const pg_problem *p, const disc *d, double R)
{
    return d->energy * acos (-1) * R * R * share_inside (p, d, R);
}

/* Ratio of tension on the disc to strength, as a + b lambda (a, b): mean over rings, and least on the rim.
 * *rim 0: no part of the rim lies inside the body. */
static pg_status tension_on (const search *g, const disc *d, double R, double mean[2], double least[2],
                             int *rim)
{
    enum { PLACES = (RINGS + 1) * RIM };
    pg_status status = PG_OK;
    const pg_system *s = g->w->system;
    double x[3 * PLACES], u[3 * PLACES], stress[2][6 * PLACES], n = 0, worst = -INFINITY;
    for (int q = 0; q < PLACES; q++)
        place_on (d, q < RIM ? R : R * sqrt ((q / RIM - 0.5) / RINGS),
                  2 * acos (-1) * (q % RIM + 0.5) / RIM, x + 3*q);
    for (int a = 0; a < g->f->n; a++)
        PG_TRY (s->force->sample (s->self, g->state, g->f->d[a], PLACES, x, u, stress[a], NULL));
    mean[0] = mean[1] = least[0] = least[1] = 0, *rim = 0;
    for (int q = 0; q < PLACES; q++) {
        const double *m = d->normal;
        double across[2] = { 0, 0 }, part[2];
        if (!pg_problem_has_body (s->problem, x + 3*q)) continue;
        for (int a = 0; a < g->f->n; a++) {
            const double *t = stress[a] + 6*q;
            across[a] = (m[0] * m[0] * t[0] + m[1] * m[1] * t[1] + m[2] * m[2] * t[2]
                         + 2 * (m[0] * m[1] * t[3] + m[1] * m[2] * t[4] + m[2] * m[0] * t[5])) / d->strength;
        }
        affine_parts (g->f, across[0], across[g->f->n - 1], part);
        if (q >= RIM) mean[0] += part[0], mean[1] += part[1], n++;
        else {
            double reached = trial_stress_factor (part);
            if (reached > worst) worst = reached, least[0] = part[0], least[1] = part[1];
            *rim = 1;
        }
    }
    for (int k = 0; k < 2 && n > 0; k++) mean[k] /= n;
done:
    return status;
}

/* *factor = load factor at which a disc of radius R forms that releases `release` (NULL: by the mean
 * tension); *rim 0: its rim lies outside the body. */
static pg_status factor_of (const search *g, const disc *d, double R, const double release[3], double *factor,
                            int *rim)
{
    pg_status status = PG_OK;
    double mean[2], least[2], own[3];
    const pg_problem *p = problem_of (g);
    PG_TRY (tension_on (g, d, R, mean, least, rim));
    if (!*rim) goto done;
    if (!release) {                                    /* estimate by the energy of the mean tension */
        double share = share_inside (p, d, R), f = d->strength,
               all = 8 * f * f * R * R * R / (3 * d->modulus) * share * (share < 0.75 ? 1.26 : 1);
        own[0] = all * mean[0] * mean[0], own[1] = 2 * all * mean[0] * mean[1];
        own[2] = all * mean[1] * mean[1];
    }
    *factor = fmax (trial_energy_factor (release ? release : own, energy_of (p, d, R)),
                    trial_stress_factor (least));
done:
    return status;
}

/* Estimates the radius at which the larger of both load factors is smallest, by the energy of the mean
 * tension. */
static pg_status estimate (const search *g, disc *d)
{
    pg_status status = PG_OK;
    d->factor = INFINITY, d->radius = 1.5 * d->h;
    for (int step = 0, rim; step < STEPS; step++) {
        double R = (1.5 + 0.5 * step) * d->h, factor;
        PG_TRY (factor_of (g, d, R, NULL, &factor, &rim));
        if (!rim) break;
        if (factor < d->factor) d->factor = factor, d->radius = R;
    }
done:
    return status;
}

/* x = corners of a polygon of the same area as the disc. */
static void corners (const disc *d, double R, double *x)
{
    double step = 2 * acos (-1) / SIDES, r = R * sqrt (step / sin (step));
    for (int q = 0; q < SIDES; q++) place_on (d, r, (q + 0.5) * step, x + 3*q);
}

/* The trial discs of several radii. */
typedef struct { const pg_problem *p; const disc *d; double R[RADII]; } tried_discs;

static pg_status start_disc (const void *context, pg_state *state, size_t k, pg_changes *cut)
{
    const tried_discs *t = context;
    double x[3 * SIDES];
    corners (t->d, t->R[k], x);
    return pg_surface_start (state, t->p, SIDES, x, t->d->normal, cut);
}

/* Fits the energies; radii, except the first, from which on a loaded part comes loose are left out. */
static void fit (disc *d, const double *R, double energy[][3])
{
    size_t n = RADII;
    while (n > 1 && trial_comes_loose (energy[n - 1])) n--;
    trial_fit (&d->sizes, n, R, energy, 3);
    d->sizes.longest = R[RADII - 1];
}

/* Finds the radius between low and high at which the larger of both load factors is smallest, and
 * d->factor. */
static pg_status settle (const search *g, disc *d, double low, double high)
{
    enum { LOOKS = 25 };
    pg_status status = PG_OK;
    d->factor = INFINITY;
    for (int k = 0, rim; k < LOOKS; k++) {
        double R = low + (high - low) * k / (LOOKS - 1), release[3], factor;
        trial_release_of (&d->sizes, R, release);
        PG_TRY (factor_of (g, d, R, release, &factor, &rim));
        if (!rim) break;
        if (factor < d->factor) d->factor = factor, d->radius = R;
    }
done:
    return status;
}

/* Cuts discs with radii about the estimate, then about the radius found if that lies outside them. */
static pg_status try_disc (const search *g, disc *d)
{
    static const double share[RADII] = { 0.8, 1, 1.25 };
    pg_status status = PG_OK;
    pg_changes cut[RADII] = { { 0 } };
    trial_form form[RADII];
    double energy[RADII][3];
    tried_discs t = { .p = problem_of (g), .d = d };
    for (int round = 0; round < ROUNDS; round++) {
        for (int k = 0; k < RADII; k++) t.R[k] = share[k] * fmax (d->radius, 1.5 * d->h / share[0]);
        PG_TRY (trial_cuts (g->w, g->state, RADII, start_disc, &t, cut));
        PG_TRY (trial_release (g->w, g->state, g->f, RADII, cut, form));
        for (int k = 0; k < RADII; k++) trial_polynomial (g->f, &form[k], energy[k]);
        fit (d, t.R, energy);
        PG_TRY (settle (g, d, 0.9 * d->sizes.shortest, 1.5 * d->sizes.longest));
        if (d->radius <= d->sizes.longest * 1.1 || d->factor > 1.25 * g->best) break;
    }
done:
    for (int k = 0; k < RADII; k++) pg_free (cut[k].bond);
    return status;
}

/* ---- what growth asks for ------------------------------------------------------------------------------ */
static pg_status offer (break_loop *b, const search *g, const disc *d)
{
    pg_status status = PG_OK;
    double polynomial[3], mean[2], least[2];
    int rim;
    facet_candidate c = { .tip = -1, .radius = d->radius,
                          .energy = energy_of (problem_of (g), d, d->radius) };
    memcpy (c.from, d->centre, sizeof c.from), memcpy (c.to, d->normal, sizeof c.to);
    memcpy (c.across, d->across[0], sizeof c.across);
    trial_release_of (&d->sizes, d->radius, polynomial);
    trial_fill_release (g->f->n, polynomial, c.release);
    PG_TRY (tension_on (g, d, d->radius, mean, least, &rim));
    trial_fill_stress (g->f->n, least, c.stress);
    PG_TRY (facet_offer (b->growth, &c));
done:
    return status;
}

pg_status fronts_offer_starts (break_loop *b, const search *all)
{
    pg_status status = PG_OK;
    search g = *all;
    disc spot[SPOTS];
    size_t n;
    g.best = fmin (g.best, 1);                         /* no crack is sought beyond full load */
    PG_TRY (find_spots (&g, spot, &n));
    for (size_t k = 0; k < n; k++) {
        PG_TRY (estimate (&g, &spot[k]));
        if (spot[k].factor > 1.25 * g.best) continue;
        PG_TRY (try_disc (&g, &spot[k]));
        if (spot[k].factor <= g.best) PG_TRY (offer (b, &g, &spot[k]));
        g.best = fmin (g.best, spot[k].factor * (1 + facet_tie));
    }
done:
    return status;
}

pg_status fronts_start (break_loop *b, pg_state *state, const facet_candidate *c)
{
    pg_status status = PG_OK;
    facet_growth *g = b->growth;
    disc d = { .radius = c->radius };
    tried_discs t = { .p = b->system.problem, .d = &d, .R = { c->radius } };
    memcpy (d.centre, c->from, sizeof d.centre), memcpy (d.normal, c->to, sizeof d.normal);
    memcpy (d.across[0], c->across, sizeof c->across);
    complete (&d);
    PG_TRY (start_disc (&t, state, 0, &b->changes));
    for (size_t i = 0; i < b->changes.n; i++) state->alive[b->changes.bond[i]] = 0;
    g->needed += c->energy, g->event.energy += c->energy, g->event.began = g->event.going = 1;
done:
    return status;
}

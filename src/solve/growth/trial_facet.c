/* SPDX-License-Identifier: GPL-3.0-or-later
 * Trial facets: the next facet of tips that have no room for a domain integral, and new cracks. A candidate
 * has the energy that it releases, found on a copy of the state. A facet of length l forms at the load factor
 * at which that reaches G0 l t, t the thickness (Griffith 1921). */
#include "front_growth.h"
#include "hot_spot.h"
#include "interface_facet.h"
#include <math.h>
#include <string.h>

/* ---- where the body ends ------------------------------------------------------------------------------- */
static void place_at (const double *x, const double *direction, double s, double *out)
{
    out[0] = x[0] + s * direction[0], out[1] = x[1] + s * direction[1], out[2] = 0;
}

/* Which obstacle (PG_MEETS_...) lies between x + from direction and x + s direction. */
static int seen (const pg_problem *p, const pg_state *state, const double *x, const double *direction,
                 double from, double s)
{
    double a[3], b[3];
    place_at (x, direction, from, a);
    place_at (x, direction, s, b);
    if (!pg_problem_has_body (p, b)) return PG_MEETS_SURFACE;
    return pg_cracks_cut (pg_state_cracks (p, state), a, b, pg_cloud_same (&p->cloud)) ? PG_MEETS_CRACK
                                                                                        : PG_MEETS_NOTHING;
}

/* Searches in steps of an eighth of the spacing and bisects the last one until the point is exact. */
double trial_reach (const pg_problem *p, const pg_state *state, const double *x, const double *direction,
                    double limit, int *what)
{
    enum { HALVINGS = 45 };
    double step = 0.125 * p->cloud.h, low = 0;
    *what = PG_MEETS_NOTHING;
    while (low < limit) {
        double high = fmin (low + step, limit);
        *what = seen (p, state, x, direction, low, high);
        if (*what == PG_MEETS_NOTHING) {
            low = high;
            continue;
        }
        for (int k = 0; k < HALVINGS; k++) {
            double middle = 0.5 * (low + high);
            int now = seen (p, state, x, direction, low, middle);
            if (now == PG_MEETS_NOTHING) low = middle;
            else high = middle, *what = now;
        }
        return low;
    }
    return limit;
}

/* ---- energies ------------------------------------------------------------------------------------------ */
/* The load factor is the larger root: opening grows with the load factor there. */
double trial_energy_factor (const double *c, double energy)
{
    double least = c[0] - energy, b = c[1], a = c[2];
    if (trial_comes_loose (c)) return 0;
    if (!(a > 0)) return b > 0 ? fmax (0, -least / b) : least >= 0 ? 0 : INFINITY;
    double root = b * b - 4 * a * least;
    if (root < 0) return 0;
    root = sqrt (root);
    /* without cancellation for either sign of b */
    return fmax (0, b > 0 ? -2 * least / (b + root) : (root - b) / (2 * a));
}

pg_status trial_cuts (trials *w, const pg_state *state, size_t n,
                      pg_status (*start) (const void *context, pg_state *state, size_t k, pg_changes *cut),
                      const void *context, pg_changes *cut)
{
    pg_status status = PG_OK;
    unsigned char *before = NULL;
    if (!w->state) PG_TRY (pg_state_create (&w->state, w->system->problem, w->system->components));
    PG_ALLOC (before, state->nbond);
    for (size_t k = 0; k < n; k++) {
        size_t kept = 0;
        PG_TRY (pg_state_copy (w->state, state));
        cut[k].n = 0;
        PG_TRY (start (context, w->state, k, &cut[k]));
        for (size_t i = 0; i < cut[k].n; i++) {
            size_t bond = cut[k].bond[i];
            if (before[bond]) continue;
            before[bond] = 1, cut[k].bond[kept++] = bond;
        }
        cut[k].n = kept;
    }
done:
    pg_free (before);
    return status;
}

/* ---- the fields at hand -------------------------------------------------------------------------------- */
/* Takes over the fields of growth: the displacement at load factor 1, or its constant part and the part that
 * grows with the load factor; of two the second becomes the displacement at load factor 1. */
pg_status trial_take_fields (trials *w, int nfield, const double *const *d, const double *t, trial_fields *f)
{
    pg_status status = PG_OK;
    size_t ndof = w->system->ndof;
    *f = (trial_fields) { .n = nfield, .d = { d[0] }, .t = { t[0] } };
    if (nfield == 1) return PG_OK;
    if (!w->whole) PG_ALLOC (w->whole, ndof);
    for (size_t i = 0; i < ndof; i++) w->whole[i] = d[0][i] + d[1][i];
    f->d[1] = w->whole, f->t[0] = 0, f->t[1] = 1;
done:
    return status;
}

/* Turns a polynomial of the load factor into the form of growth's coefficients: lambda alone, or 1 and
 * lambda. */
void trial_fill_release (int nfield, const double *c, double out[2][2])
{
    memset (out, 0, 4 * sizeof **out);
    if (nfield == 1) out[0][0] = c[2];
    else out[0][0] = c[0], out[1][1] = c[2], out[0][1] = out[1][0] = 0.5 * c[1];
}

void trial_fill_stress (int nfield, const double *c, double out[2])
{
    out[0] = nfield == 1 ? c[1] : c[0], out[1] = nfield == 1 ? 0 : c[1];
}

/* ---- tips without room --------------------------------------------------------------------------------- */
/* Checks that a facet opens, as contact is not modelled and energy is also released where faces would
 * overlap: the tension across it, with a fifth of the shear along it, has to be positive; any such stress is
 * enough, so that it counts a million times. c->energy and tip are set already. */
static pg_status find_tension (const break_loop *b, const pg_state *state, const trial_fields *f,
                               facet_candidate *c)
{
    enum { PLACES = 2 };
    const pg_system *s = &b->system;
    const pg_tip_field *at = &b->growth->field[c->tip];
    double x[2 * PLACES], u[3 * PLACES], stress[6 * PLACES], sum[2] = { 0, 0 };
    double t[2] = { c->to[0] - at->x[0], c->to[1] - at->x[1] }, length = hypot (t[0], t[1]);
    double n[2] = { -t[1] / length, t[0] / length };
    /* 1e6 over the stress about a facet ahead of a crack with this energy release rate */
    double scale = 1e6 / sqrt (at->modulus * c->energy / s->problem->cloud.thickness) * length;
    c->stress[0] = c->stress[1] = NAN;
    if (!s->force->sample || !(at->modulus > 0) || !(length > 0)) return PG_OK;
    for (int q = 0; q < PLACES; q++)
        for (int k = 0; k < 2; k++) x[2*q + k] = at->x[k] + (q ? 0.9 : 0.5) * t[k];
    for (int a = 0; a < f->n; a++) {
        pg_status status = s->force->sample (s->self, state, f->d[a], PLACES, x, u, stress, NULL);
        if (status != PG_OK) return status;
        for (int q = 0; q < PLACES; q++) {
            const double *v = stress + 6*q;
            double across = n[0] * n[0] * v[0] + n[1] * n[1] * v[1] + 2 * n[0] * n[1] * v[3];
            double shear = n[0] * n[1] * (v[1] - v[0]) + (n[0] * n[0] - n[1] * n[1]) * v[3];
            sum[a] += (across + 0.2 * fabs (shear)) * scale / PLACES;
        }
    }
    /* from weights 1 - lambda and lambda to 1 and lambda */
    c->stress[0] = sum[0], c->stress[1] = f->n == 2 ? sum[1] - sum[0] : 0;
    return PG_OK;
}

/* Finds the energy that the facet of a tip would release (c->release), and offers the facet. */
static pg_status offer_of_tip (break_loop *b, trials *w, const pg_state *state, const trial_fields *f,
                               facet_candidate *c)
{
    pg_status status = PG_OK;
    const pg_problem *p = b->system.problem;
    pg_changes cut = { 0 };
    trial_form form;
    double polynomial[3];
    if (!(c->energy > 0)) return PG_OK;                /* no facet can grow there */
    if (!w->state) PG_TRY (pg_state_create (&w->state, p, b->system.components));
    PG_TRY (pg_state_copy (w->state, state));
    PG_TRY (pg_crack_grow (w->state, p, (size_t) c->tip, c->to, c->close, &cut));
    PG_TRY (trial_release (w, state, f, 1, &cut, &form));
    trial_polynomial (f, &form, polynomial);
    trial_fill_release (f->n, polynomial, c->release);
    PG_TRY (find_tension (b, state, f, c));
    PG_TRY (facet_offer (b->growth, c));
done:
    pg_free (cut.bond);
    return status;
}

/* Energy that a crack between two materials takes, J/m^2: the interface's own, or that of the weaker
 * material. */
static double energy_between (break_loop *b, const crossing *c, const double *x, double angle)
{
    const pg_problem *p = b->system.problem;
    const pg_interface *own = pg_problem_interface (p, c->material[0], c->material[1]);
    double least = INFINITY;
    if (own) return own->energy;
    for (int k = 0; k < 2; k++) {
        const pg_criterion *law = &p->criterion[c->material[k]];
        pg_fracture_limits limits = { .energy = INFINITY };
        if (!law->never) law->type->fracture (law, x, angle, &limits);
        least = fmin (least, limits.energy);
    }
    return isfinite (least) ? least : 0;
}

static double angle_to (const double *from, const double *to)
{
    return atan2 (to[1] - from[1], to[0] - from[0]);
}

/* The smaller angle between two directions, rad. */
static double turn_between (double a, double b) { return fabs (remainder (a - b, 2 * acos (-1))); }

/* Offers facets for a tip on an interface: along it to both sides, across it, and out of it by kinks of 45
 * degrees; the angle of the tip is that of the last facets. */
static pg_status offers_on_interface (break_loop *b, trials *w, const pg_state *state, const trial_fields *f,
                                      size_t tip, const crossing *way, size_t nway)
{
    pg_status status = PG_OK;
    const pg_tip_field *at = &b->growth->field[tip];
    static const double right = 1.5707963267948966;
    double e = atan2 (at->e[1], at->e[0]), kinks[3] = { 0, -0.5 * right, 0.5 * right };
    facet_candidate c;
    for (size_t k = 0; k < nway; k++) {
        double angle = angle_to (at->x, way[k].x);
        if (turn_between (angle, e) > 1.3 * right) continue;    /* back along the crack itself */
        facet_place (b, state, tip, angle, 0, &c);
        if (!c.close) memcpy (c.to, way[k].x, sizeof c.to);
        double length = hypot (c.to[0] - at->x[0], c.to[1] - at->x[1]);
        c.energy = energy_between (b, &way[k], way[k].x, angle) * length
                   * b->system.problem->cloud.thickness;
        PG_TRY (offer_of_tip (b, w, state, f, &c));
    }
    for (int q = 0; q < 3; q++) {
        double angle = e + kinks[q], near = INFINITY;
        for (size_t k = 0; k < nway; k++)
            near = fmin (near, turn_between (angle, angle_to (at->x, way[k].x)));
        if (near < 0.35 * right) continue;
        facet_place (b, state, tip, angle, 0, &c);
        PG_TRY (offer_of_tip (b, w, state, f, &c));
    }
done:
    return status;
}

/* Offers facets for a tip near an interface; *here 0: there is none ahead of it or under it. */
static pg_status offers_at_interface (break_loop *b, trials *w, const pg_state *state, const trial_fields *f,
                                      size_t tip, int *here)
{
    enum { WAYS = 8 };
    pg_status status = PG_OK;
    const pg_tip_field *at = &b->growth->field[tip];
    crossing way[WAYS], meets;
    double h = facet_length (b->growth, at), distance;
    size_t n;
    facet_candidate c = { .tip = (long) tip };
    PG_TRY (interface_ready (w, here));
    if (!*here) goto done;
    if (interface_around (w, at->x, 0.2 * h, WAYS, way)) {
        n = interface_around (w, at->x, h, WAYS, way);
        PG_TRY (offers_on_interface (b, w, state, f, tip, way, n));
        goto done;
    }
    *here = interface_ahead (w, at->x, at->e, 1.5 * h, &distance, &meets);
    if (!*here) goto done;
    /* up to the interface, in the tip's material */
    pg_fracture_limits limits;
    memcpy (c.to, meets.x, sizeof c.to);
    double middle[3] = { 0.5 * (at->x[0] + c.to[0]), 0.5 * (at->x[1] + c.to[1]), 0 };
    if (!facet_limits (b, middle, atan2 (at->e[1], at->e[0]), &limits)) goto done;
    c.energy = limits.energy * distance * b->system.problem->cloud.thickness;
    PG_TRY (offer_of_tip (b, w, state, f, &c));
done:
    return status;
}

/* Offers facets of a tip: straight ahead, and the shortest one to the surface if in another direction; at an
 * interface those that are possible there. */
static pg_status offers_of_tip (break_loop *b, trials *w, const pg_state *state, const trial_fields *f,
                                size_t tip)
{
    pg_status status = PG_OK;
    const pg_tip_field *at = &b->growth->field[tip];
    facet_candidate ahead, out;
    int interface = 0;
    size_t places;
    int held = b->system.problem->criterion->type->path (b->system.problem->criterion, &places) != NULL;
    if (!held)
        PG_TRY (offers_at_interface (b, w, state, f, tip, &interface));
    if (interface) goto done;
    facet_place (b, state, tip, atan2 (at->e[1], at->e[0]), 0, &ahead);
    PG_TRY (offer_of_tip (b, w, state, f, &ahead));
    if (held || !facet_way_out (b, state, tip, &out)) goto done;
    double turn = turn_between (angle_to (at->x, ahead.to), angle_to (at->x, out.to));
    if (turn > 0.2) PG_TRY (offer_of_tip (b, w, state, f, &out));
done:
    return status;
}

/* ---- new cracks ---------------------------------------------------------------------------------------- */
static int limits_at (void *context, const double *x, double angle, pg_fracture_limits *out)
{
    return facet_limits (context, x, angle, out);
}

/* Does any material or interface give a strength? */
int trial_has_strength (const pg_problem *p)
{
    double x[3] = { 0 };
    for (size_t m = 0; m < p->nmaterial; m++) {
        pg_fracture_limits limits = { .strength = NAN };
        const pg_criterion *c = &p->criterion[m];
        if (c->never) continue;
        c->type->fracture (c, x, 0, &limits);
        if (limits.strength > 0 || limits.cohesion > 0) return 1;
    }
    for (size_t k = 0; k < p->at.ninterface; k++) if (p->at.interface[k].strength > 0) return 1;
    return 0;
}

static pg_status offer_starts (break_loop *b, const search *g)
{
    pg_status status = PG_OK;
    const trial_fields *f = g->f;
    trial_start start[TRIAL_MOST_STARTS];
    size_t n;
    int arbitrary;
    PG_TRY (trial_initiation (g->w, g->state, f, g->limits, g->context, g->best, start, &n, &arbitrary));
    if (arbitrary && !g->w->said) {
        pg_statistics_warn (b->system.report,
                            "the largest stress is the same at many places: where the first crack begins is "
                            "arbitrary");
        g->w->said = 1;
    }
    for (size_t k = 0; k < n; k++) {
        const trial_start *s = &start[k];
        facet_candidate c = { .tip = -1, .open = s->open, .slides = s->slides, .energy = s->energy };
        memcpy (c.from, s->from, sizeof c.from), memcpy (c.to, s->to, sizeof c.to);
        trial_fill_release (f->n, s->release, c.release);
        trial_fill_stress (f->n, s->stress, c.stress);
        PG_TRY (facet_offer (b->growth, &c));
    }
done:
    return status;
}

/* Warns of interfaces whose strength the spacing cannot resolve, as facet_growth.c does for materials. */
static void doubt_interfaces (const break_loop *b)
{
    const pg_problem *p = b->system.problem;
    double h = b->growth->length > 0 ? b->growth->length : p->cloud.h;
    for (size_t k = 0; k < p->at.ninterface; k++) {
        const pg_interface *one = &p->at.interface[k];
        const pg_material *m[2] = { &p->material[one->material[0]], &p->material[one->material[1]] };
        double cap = hot_strength_cap (fmin (m[0]->modulus, m[1]->modulus), one->energy, h);
        if (one->strength > cap)
            pg_statistics_warn (b->system.report,
                                "the interface of %.40s and %.40s has too large a strength for points %.3g m "
                                "apart: where cracks begin it counts as %.3g Pa",
                                m[0]->name, m[1]->name, h, cap);
    }
}

pg_status trial_hot_place (break_loop *b, const pg_state *state, const double *d, double t, double *x,
                           int *any)
{
    pg_status status = PG_OK;
    facet_growth *g = b->growth;
    trial_fields f;
    hot_spot spot;
    size_t n = 0;
    *any = 0;
    if (!trial_has_strength (b->system.problem)) return PG_OK;
    if (!g->trials) PG_TRY (trials_create (&g->trials, &b->system));
    PG_TRY (trial_take_fields (g->trials, 1, &d, &t, &f));
    const search all = { g->trials, state, &f, limits_at, b, 1 };
    PG_TRY (hot_spots (&all, 1, &spot, &n));
    *any = n > 0 && spot.factor <= 1;
    if (*any) memcpy (x, spot.x, sizeof spot.x);
done:
    return status;
}

pg_status trial_facets (break_loop *b, const pg_state *state, const double *const *d, const double *t)
{
    pg_status status = PG_OK;
    facet_growth *g = b->growth;
    trial_fields f;
    int space = b->system.problem->dim == 3, starts = trial_has_strength (b->system.problem);
    if (!starts && (space || b->system.contact)) return PG_OK;
    if (!g->trials) {
        PG_TRY (trials_create (&g->trials, &b->system));
        if (!space) doubt_interfaces (b);
    }
    PG_TRY (trial_take_fields (g->trials, g->nfield, d, t, &f));
    /* the energy release of tips is not known where cutting changes which faces touch */
    for (size_t i = 0; i < g->ntip && !space && !b->system.contact; i++)
        if (state->paths->tip[i].open && isnan (g->field[i].near))
            PG_TRY (offers_of_tip (b, g->trials, state, &f, i));
    if (!starts) goto done;
    /* proportional loads: new cracks count only below the load at which a tip grows */
    double top = f.n == 1 ? facet_utilisation (b, state, 1) : 0, below = top > 0 ? 1 / top : INFINITY;
    search all = { g->trials, state, &f, limits_at, b, below };
    PG_TRY (space ? fronts_offer_starts (b, &all) : offer_starts (b, &all));
done:
    return status;
}

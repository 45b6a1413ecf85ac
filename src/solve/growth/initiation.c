/* SPDX-License-Identifier: GPL-3.0-or-later
 * A new crack begins when two conditions hold together (Leguillon 2002): the tension across it
 * reaches the strength all along its length l, and what it sets free reaches G0 l t. The first holds from
 * lambda_S (l) on, which grows with l where the stress falls off; the second from lambda_E (l) on, which
 * falls with l. The least load factor at which both hold is that of the first crack, and the length there
 * is its length: nothing is fitted, and neither strength alone (at a notch: 0) nor energy alone (at an
 * even edge: infinity) decides.
 *
 * A crack is tried at hot spots (hot_spot.c) across the largest tension: from the surface if that is near,
 * else to both sides. First its energy is estimated from the stress along it, as of a crack in a half
 * plane or a plane, which orders the hot spots and tells about what length to try; then several lengths
 * about that are cut, together, with the factor at hand (trial_release.c). The position of a tip among the
 * points is worth a tenth of the spacing in length; lengths that are no multiples of each other average
 * that: energy over l^2, which an even field would make constant, is fitted by a straight line. */
#include "facet_growth.h"
#include "hot_spot.h"
#include "interface_facet.h"
#include "shear_initiation.h"
#include <math.h>
#include <string.h>

enum {
    MOST_SPOTS = 12,                                   /* most hot spots in materials that are examined */
    MOST_ON_INTERFACES = 4,                            /* most hot spots on interfaces, in addition */
    MOST_TRIED = 6,                                    /* most hot spots at which cracks are cut */
    LENGTHS = 6,                                       /* lengths of a crack that are tried together */
    ROUNDS = 5,
    PER_SPACING = 2,                                   /* stress points along a crack, per spacing */
    MOST_PLACES = 400,
    LATERAL = 3                                        /* points side by side over which stress is averaged */
};
static const double even = 0.02;  /* relative difference of load factors that counts as none */
/* Least length of a closed crack, spacings: a shorter one has no room for two pieces of its faces. */
static const double CLOSED_LEAST = 4;
/* Error of an estimate: spots above the best by more than this factor are not examined further. */
static const double doubt = 1.25;

/* A trial crack from origin - a direction to origin + b direction; a = 0 if it begins in the surface. */
typedef struct {
    double origin[3], direction[3], angle;             /* origin, m; unit vector; angle, rad */
    double reach[2];  /* length inside the body towards -direction, +direction, m */
    int    edge;
    double h, modulus;                                 /* local spacing, m; Young's modulus, Pa */
    const pg_interface *interface;                     /* interface along which it runs, or NULL */
    shear_start shear;                                 /* sense != 0: it slides under pressure */
    double least;                                      /* shortest length that is tried, m */
    /* points along it, from -reach to +reach, m; stress on it over strength: c + lambda s; energy needed,
     * J/m */
    size_t n;
    double at[MOST_PLACES], c[MOST_PLACES], s[MOST_PLACES], needed[MOST_PLACES];
    /* driving stress there, Pa: constant + lambda slope; stress in the crack's frame, Pa
     * (shear_initiation.h) */
    double drive[MOST_PLACES][2], face[MOST_PLACES][4];
    double factor, about;                              /* estimates: load factor, length, m */
    trial_sizes sizes;                                 /* energy that lengths release */
} trial_crack;

/* ---- where it runs ------------------------------------------------------------------------------------- */
/* Moves the origin into the body if a lattice has put the node a little outside. */
static void put_inside (const search *g, trial_crack *c)
{
    enum { PARTS = 16 };
    const pg_problem *p = g->w->system->problem;
    if (pg_problem_has_body (p, c->origin)) return;
    for (int part = 1; part <= PARTS; part++)
        for (int side = -1; side <= 1; side += 2) {
            double s = side * c->h * part / PARTS;
            double x[3] = { c->origin[0] + s * c->direction[0], c->origin[1] + s * c->direction[1], 0 };
            if (!pg_problem_has_body (p, x)) continue;
            memcpy (c->origin, x, sizeof x);
            return;
        }
}

/* Sets the direction and the reach in the body to both sides. The crack starts from the surface if that is
 * within a spacing; not if surfaces on both sides are equally near, as the sense of the direction would
 * decide between them. */
static void lay (const search *g, const hot_spot *spot, int side, trial_crack *c)
{
    const pg_problem *p = g->w->system->problem;
    int what;
    *c = (trial_crack) { .h = spot->h, .modulus = spot->modulus, .angle = spot->angle,
                         .interface = spot->interface, .least = spot->h };
    if (spot->slides) {
        c->least = CLOSED_LEAST * spot->h;
        shear_lay (g, spot, side, &c->angle, &c->shear);
    }
    memcpy (c->origin, spot->x, sizeof c->origin);
    c->direction[0] = cos (c->angle), c->direction[1] = sin (c->angle);
    put_inside (g, c);
    double limit = 0.5 * MOST_PLACES / PER_SPACING * c->h, same = pg_cloud_same (&p->cloud);
    double back[3] = { -c->direction[0], -c->direction[1], 0 };
    c->reach[0] = trial_reach (p, g->state, c->origin, back, limit, &what);
    c->reach[1] = trial_reach (p, g->state, c->origin, c->direction, limit, &what);
    c->edge = fmin (c->reach[0], c->reach[1]) <= c->h + same && fabs (c->reach[0] - c->reach[1]) > 2 * same;
    if (c->edge && c->reach[1] < c->reach[0]) {        /* turn it to run away from the near surface */
        double swap = c->reach[0];
        c->reach[0] = c->reach[1], c->reach[1] = swap;
        memcpy (c->direction, back, sizeof back);
        c->angle += acos (-1);                         /* the shear stress keeps its sign */
    }
    if (!c->edge) return;
    for (int k = 0; k < 2; k++) c->origin[k] -= c->reach[0] * c->direction[k];
    c->reach[1] = fmin (c->reach[0] + c->reach[1], limit), c->reach[0] = 0;
}

/* Sets the points of a crack and those beside them over which the stress is averaged (x: LATERAL of each). */
static void set_places (trial_crack *c, double *x)
{
    double step = c->h / PER_SPACING, n[2] = { -c->direction[1], c->direction[0] };
    long first = c->edge ? 0 : -(long) floor (c->reach[0] / step);
    for (size_t i = 0; i < c->n; i++) {
        double s = c->at[i] = (double) (first + (long) i) * step;
        if (c->edge && i == 0) s = 0.1 * step;         /* the surface itself is not a point of the body */
        for (int q = 0; q < LATERAL; q++) {
            double side = (q - LATERAL / 2) * c->h / LATERAL, *at = x + 2 * (LATERAL * i + (size_t) q);
            for (int k = 0; k < 2; k++) at[k] = c->origin[k] + s * c->direction[k] + side * n[k];
        }
    }
}

/* Limits of the crack at a point: along an interface those of the interface, as far as it goes straight on;
 * 0: it cannot go on there. */
static int resists (const search *g, const trial_crack *c, const double *x, pg_fracture_limits *out)
{
    crossing unused;
    if (!c->interface || !interface_around (g->w, x, 0.3 * c->h, 1, &unused))
        return hot_resists (g, x, c->angle, c->h, c->modulus, out);
    out->energy = c->interface->energy;
    out->strength = fmin (c->interface->strength, hot_strength_cap (c->modulus, out->energy, c->h));
    return 1;
}

/* Sets point i by its limits and stress: stress on the plane of the crack, the same over the strength, the
 * driving stress, and the energy that it takes. */
static void judge_place (trial_crack *c, size_t i, const pg_fracture_limits *limits,
                         const affine_stress *stress, double thickness)
{
    double a = -c->direction[1], b = c->direction[0], across[3] = { a * a, b * b, 2 * a * b },
           along[3] = { a * b, -a * b, b * b - a * a }, *face = c->face[i];
    int shear = c->shear.sense != 0;
    /* tension alone, or shear reduced by what pressure adds to the strength */
    double strength = shear ? limits->cohesion : limits->strength, weight = shear ? limits->slope : 1;
    if (!(strength > 0)) return;
    c->needed[i] = (shear ? limits->shear : limits->energy) * thickness;
    for (int k = 0; k < 3; k++) {
        face[0] += across[k] * stress->constant[k], face[1] += across[k] * stress->slope[k];
        face[2] += along[k] * stress->constant[k], face[3] += along[k] * stress->slope[k];
    }
    c->c[i] = (weight * face[0] + c->shear.sense * face[2]) / strength;
    c->s[i] = (weight * face[1] + c->shear.sense * face[3]) / strength;
    for (int k = 0; k < 2; k++) c->drive[i][k] = shear_drive (&c->shear, face, k);
}

/* Finds stress and limits along the crack. */
static pg_status look_along (const search *g, trial_crack *c)
{
    pg_status status = PG_OK;
    double step = c->h / PER_SPACING, *x = NULL;
    affine_stress *stress = NULL;
    c->n = (size_t) (floor (c->reach[1] / step) + (c->edge ? 0 : floor (c->reach[0] / step))) + 1;
    if (c->n > MOST_PLACES) c->n = MOST_PLACES;
    PG_ALLOC (x, 2 * LATERAL * c->n);
    PG_ALLOC (stress, c->n);
    set_places (c, x);
    PG_TRY (hot_stress (g, LATERAL * c->n, LATERAL, x, stress));
    for (size_t i = 0; i < c->n; i++) {
        double place[3] = { c->origin[0] + c->at[i] * c->direction[0],
                            c->origin[1] + c->at[i] * c->direction[1] };
        pg_fracture_limits limits;
        /* no crack goes through where none can grow */
        c->needed[i] = INFINITY;
        if (resists (g, c, place, &limits))
            judge_place (c, i, &limits, &stress[i], g->w->system->problem->cloud.thickness);
    }
done:
    pg_free (x), pg_free (stress);
    return status;
}

/* ---- what it needs ------------------------------------------------------------------------------------- */
/* end = parts of a crack of length l behind and ahead of the origin, m: equal, as far as the body goes. */
static void ends_of (const trial_crack *c, double l, double end[2])
{
    end[0] = c->edge ? 0 : 0.5 * l, end[1] = l - end[0];
    for (int k = 0; k < 2 && !c->edge; k++)
        if (end[k] > c->reach[k]) end[k] = c->reach[k], end[1 - k] = l - end[k];
    for (int k = 0; k < 2; k++) end[k] = fmin (end[k], c->reach[k]);
}

/* Index of the point at or before a position along the crack. */
static size_t nearest_place (const trial_crack *c, double at)
{
    double step = c->h / PER_SPACING, i = floor ((at - c->at[0]) / step);
    return i < 0 ? 0 : i > (double) (c->n - 1) ? c->n - 1 : (size_t) i;
}

/* Interpolation of a position along the crack: between points *i and *j, returns the share of the way to
 * *j. */
static double between (const trial_crack *c, double at, size_t *i, size_t *j)
{
    *i = nearest_place (c, at), *j = *i + 1 < c->n ? *i + 1 : *i;
    return *j > *i ? fmin (1, fmax (0, (at - c->at[*i]) / (c->at[*j] - c->at[*i]))) : 0;
}

/* out = stress over strength at a position: linear between points, constant beyond; drive_at: driving stress,
 * Pa. */
static void stress_at (const trial_crack *c, double at, double out[2])
{
    size_t i, j;
    double share = between (c, at, &i, &j);
    out[0] = c->c[i] + share * (c->c[j] - c->c[i]), out[1] = c->s[i] + share * (c->s[j] - c->s[i]);
}

static void drive_at (const trial_crack *c, double at, double out[2])
{
    size_t i, j;
    double share = between (c, at, &i, &j);
    for (int k = 0; k < 2; k++) out[k] = c->drive[i][k] + share * (c->drive[j][k] - c->drive[i][k]);
}

double trial_stress_factor (const double v[2])
{
    if (v[0] >= 1) return 0;
    return v[1] > 0 ? (1 - v[0]) / v[1] : INFINITY;
}

/* lambda_S of a length: load factor from which on the strength is reached all along it; where: the stress
 * that reaches it last. */
static double lambda_S (const trial_crack *c, double l, double where[2])
{
    double end[2], v[2], worst = -1;
    ends_of (c, l, end);
    for (size_t i = 0; i < c->n + 2; i++) {
        double at = i < c->n ? c->at[i] : i == c->n ? -end[0] : end[1];
        if (at < -end[0] || at > end[1]) continue;
        stress_at (c, at, v);
        double factor = trial_stress_factor (v);
        if (factor > worst) worst = factor, where[0] = v[0], where[1] = v[1];
    }
    return worst;
}

/* Energy that a crack of that length takes, J. */
static double energy_of (const trial_crack *c, double l)
{
    double end[2], sum = 0, length = 0;
    ends_of (c, l, end);
    for (size_t i = 0; i < c->n; i++) {
        /* the part of the crack that is nearest to this point */
        double low = i ? 0.5 * (c->at[i - 1] + c->at[i]) : -INFINITY,
               high = i + 1 < c->n ? 0.5 * (c->at[i] + c->at[i + 1]) : INFINITY;
        double part = fmin (high, end[1]) - fmax (low, -end[0]);
        if (part > 0) sum += part * c->needed[i], length += part;
    }
    return length > 0 ? sum * l / length : INFINITY;
}

/* ---- an estimate --------------------------------------------------------------------------------------- */
/* K of a crack of length l, Pa m^(1/2), due to the constant part of the stress and to that with lambda: in a
 * half plane (from the surface; Hartranft, Sih 1973) or in the plane, mean of both tips. */
static void estimate_K (const trial_crack *c, double l, double K[2])
{
    enum { PARTS = 24 };
    double quarter = 0.5 * acos (-1), a = c->edge ? l : 0.5 * l, end[2], v[2];
    ends_of (c, l, end);
    K[0] = K[1] = 0;
    for (int q = 0; q < PARTS; q++) {
        double s = sin (quarter * ((c->edge ? q : 2*q - PARTS) + (c->edge ? 0.5 : 1)) / PARTS);
        double at = c->edge ? s * a : 0.5 * (end[1] - end[0]) + s * a;
        double weight = c->edge ? 1.3 - 0.3 * pow (s, 1.25) : 1;
        drive_at (c, at, v);
        weight *= 2 * sqrt (a / acos (-1)) * quarter / PARTS;
        for (int k = 0; k < 2; k++) K[k] += weight * v[k];
    }
}

/* Estimates the length at which the larger of both load factors is smallest. */
static void estimate (const search *g, trial_crack *c)
{
    enum { STEPS = 200 };
    const double t = g->w->system->problem->cloud.thickness;
    double all = c->reach[0] + c->reach[1], l = 0, release[3] = { 0 };
    c->factor = INFINITY, c->about = c->least;
    for (int k = 0; k < STEPS && l < all; k++) {
        double step = fmax (0.25 * c->h, all / STEPS), K[2], unused[2];
        step = fmin (step, all - l);
        estimate_K (c, l + 0.5 * step, K);
        release[0] += K[0] * K[0] / c->modulus * step * t;
        release[1] += 2 * K[0] * K[1] / c->modulus * step * t;
        release[2] += K[1] * K[1] / c->modulus * step * t;
        l += step;
        double factor = fmax (trial_energy_factor (release, energy_of (c, l)), lambda_S (c, l, unused));
        if (factor < c->factor && l >= c->least * (1 - 1e-9)) c->factor = factor, c->about = l;
    }
}

/* ---- lengths that are cut ------------------------------------------------------------------------------ */
void trial_release_of (const trial_sizes *c, double size, double out[3])
{
    for (int q = 0; q < 3; q++) out[q] = pow (size, c->power) * (c->release[q] + size * c->slope[q]);
}

static double lambda_E (const trial_crack *c, double l)
{
    double polynomial[3];
    trial_release_of (&c->sizes, l, polynomial);
    return trial_energy_factor (polynomial, energy_of (c, l));
}

/* Chooses lengths about a given one, at least a quarter of a spacing apart, from the shortest on. Returns how
 * many. */
static size_t choose_lengths (const trial_crack *c, double about, double *length)
{
    static const double share[LENGTHS] = { 0.6, 0.75, 0.9, 1.05, 1.2, 1.4 };
    double all = c->reach[0] + c->reach[1], last = 0;
    size_t n = 0;
    for (int k = 0; k < LENGTHS; k++) {
        double l = fmax (share[k] * about, n ? last + 0.25 * c->h : c->least);
        /* less than half a spacing left: cut through */
        if (all - l < 0.5 * c->h) l = all;
        length[n++] = last = l;
        if (l >= all) break;
    }
    return n;
}

/* Fits energies by a power of the length, least squares of the logarithms: for a stress that falls off over a
 * short distance (a small hole), where a straight line through energies over length^2 would soon fall to
 * zero. */
static void fit_power (trial_sizes *c, size_t n, const double *length, double energy[][3])
{
    double x = 0, y = 0, xx = 0, xy = 0;
    for (size_t k = 0; k < n; k++) {
        double all = energy[k][0] + energy[k][1] + energy[k][2], u = log (length[k]), v = log (all);
        if (!(all > 0)) return;
        x += u, y += v, xx += u * u, xy += u * v;
    }
    /* between a long crack loaded at a point and one in a uniform field */
    c->power = fmin (2, fmax (1, (xy - x * y / (double) n) / (xx - x * x / (double) n)));
    for (int q = 0; q < 3; q++) {
        c->release[q] = c->slope[q] = 0;
        for (size_t k = 0; k < n; k++) c->release[q] += energy[k][q] / pow (length[k], c->power) / (double) n;
    }
}

void trial_fit (trial_sizes *c, size_t n, const double *size, double energy[][3], int power)
{
    double mean = 0, spread = 0;
    *c = (trial_sizes) { .power = power, .shortest = size[0], .longest = size[n - 1] };
    for (size_t k = 0; k < n; k++) mean += size[k] / (double) n;
    for (size_t k = 0; k < n; k++) spread += (size[k] - mean) * (size[k] - mean);
    for (int q = 0; q < 3; q++) {
        double value = 0, slope = 0;
        for (size_t k = 0; k < n; k++) {
            double unit = 1;
            for (int m = 0; m < power; m++) unit *= size[k];
            double y = energy[k][q] / unit;
            value += y / (double) n, slope += spread > 0 ? (size[k] - mean) * y / spread : 0;
        }
        c->release[q] = value - slope * mean, c->slope[q] = slope;
    }
}

/* Fits a straight line to energies over length^2; where l (value + slope l) falls with l, so that a longer
 * crack would need more load, a power. */
static void fit (trial_sizes *c, size_t n, const double *length, double energy[][3])
{
    trial_fit (c, n, length, energy, 2);
    double value = c->release[0] + c->release[1] + c->release[2],
           slope = c->slope[0] + c->slope[1] + c->slope[2];
    if (n > 1 && value + 2 * slope * length[n - 1] <= 0) fit_power (c, n, length, energy);
}

/* Finds the ends of a crack of length l; returns which of them are tips. */
static int place_ends (const trial_crack *c, double l, double *from, double *to)
{
    double end[2];
    int open = 0;
    ends_of (c, l, end);
    for (int k = 0; k < 2; k++) {
        from[k] = c->origin[k] - end[0] * c->direction[k], to[k] = c->origin[k] + end[1] * c->direction[k];
        if (end[k] > 0 && end[k] < c->reach[k]) open |= 1 << k;
    }
    from[2] = to[2] = 0;
    return open;
}

/* Finds the fields less what the faces of a closed crack of that length bear, by means along it. */
static pg_status free_fields (const search *g, const trial_crack *c, double l, trial_fields *out)
{
    double end[2], mean[4] = { 0 };
    size_t count = 0;
    ends_of (c, l, end);
    for (size_t i = 0; i < c->n; i++) {
        if (c->at[i] < -end[0] || c->at[i] > end[1]) continue;
        count++;
        for (int k = 0; k < 4; k++) mean[k] += c->face[i][k];
    }
    for (int k = 0; k < 4; k++) mean[k] /= (double) (count ? count : 1);
    return shear_free_fields (g, &c->shear, c->angle, mean, out);
}

/* Trial cracks of several lengths, as arguments of pg_crack_start. */
typedef struct {
    const pg_problem *p;
    double from[3 * LENGTHS], to[3 * LENGTHS];
    int open[LENGTHS];
} tried_cracks;

static pg_status start_crack (const void *context, pg_state *state, size_t k, pg_changes *cut)
{
    const tried_cracks *t = context;
    return pg_crack_start (state, t->p, t->from + 3*k, t->to + 3*k, t->open[k], cut);
}

/* Cuts cracks of lengths about a given one and fits the energy that they release. */
static pg_status try_lengths (const search *g, trial_crack *c, double about)
{
    pg_status status = PG_OK;
    pg_changes cut[LENGTHS] = { { 0 } };
    trial_form form[LENGTHS];
    double length[LENGTHS], energy[LENGTHS][3];
    tried_cracks t = { .p = g->w->system->problem };
    size_t n = choose_lengths (c, about, length);
    int slides = c->shear.sense ? PG_START_SLIDES : 0;
    for (size_t k = 0; k < n; k++)
        t.open[k] = slides | place_ends (c, length[k], t.from + 3*k, t.to + 3*k);
    PG_TRY (trial_cuts (g->w, g->state, n, start_crack, &t, cut));
    trial_fields fields = *g->f;
    if (c->shear.sense) PG_TRY (free_fields (g, c, about, &fields));
    PG_TRY (trial_release (g->w, g->state, &fields, n, cut, form));
    for (size_t k = 0; k < n; k++) trial_polynomial (g->f, &form[k], energy[k]);
    /* a cut through the body does not belong to the series */
    while (n > 1
           && (length[n - 1] >= c->reach[0] + c->reach[1] || isinf (energy[n - 1][0] + energy[n - 1][2])))
        n--;
    fit (&c->sizes, n, length, energy);
done:
    for (size_t k = 0; k < LENGTHS; k++) pg_free (cut[k].bond);
    return status;
}

/* The larger of both load factors; *over 1: it is that of energy. */
static double both (const trial_crack *c, double l, int *over)
{
    double unused[2], e = lambda_E (c, l), s = lambda_S (c, l, unused);
    *over = e > s;
    return fmax (e, s);
}

/* Length between low and high at which the larger of both factors is smallest: where they cross, else at an
 * end. */
static double best_length (const trial_crack *c, double low, double high, double *factor)
{
    enum { HALVINGS = 50 };
    int at_low, at_high, over;
    double l = high, first = both (c, low, &at_low);
    *factor = both (c, high, &at_high);
    if (first < *factor) *factor = first, l = low;
    if (!at_low || at_high) return l;
    for (int i = 0; i < HALVINGS; i++) {
        double middle = 0.5 * (low + high);
        both (c, middle, &over);
        if (over) low = middle;
        else high = middle;
    }
    *factor = both (c, high, &over);
    return high;
}

/* Tries a crack: lengths about the estimate, then about the result, until that lies among those tried. */
static pg_status try_crack (const search *g, trial_crack *c, trial_start *out)
{
    pg_status status = PG_OK;
    const trial_sizes *z = &c->sizes;
    double l = c->about, all = c->reach[0] + c->reach[1];
    for (int round = 0; round < ROUNDS; round++) {
        PG_TRY (try_lengths (g, c, l));
        int over;
        double about = l;
        both (c, z->longest, &over);
        l = best_length (c, 0.5 * z->shortest, over ? fmin (2 * z->longest, all) : z->longest, &out->factor);
        int inside = (l >= z->shortest * (1 - 1e-9) || z->shortest <= c->least * (1 + 1e-9))
                     && l <= z->longest * (1 + 1e-9);
        if (inside || fabs (l - about) < 0.1 * about || out->factor > doubt * g->best) break;
    }
    lambda_S (c, l, out->stress);
    trial_release_of (&c->sizes, l, out->release);
    out->energy = energy_of (c, l);
    /* a facet shorter than a spacing cuts hardly any bond */
    out->length = fmin (fmax (l, c->least), all);
    out->open = place_ends (c, out->length, out->from, out->to), out->slides = c->shear.sense != 0;
done:
    return status;
}

/* ---- the search ---------------------------------------------------------------------------------------- */
/* Keeps the best of the tried cracks, and those that tie with it. */
static size_t keep_best (trial_start *out, size_t n, int one)
{
    size_t kept = 0, best = 0;
    for (size_t k = 1; k < n; k++) if (out[k].factor < out[best].factor) best = k;
    if (n == 0 || isinf (out[best].factor)) return 0;
    double limit = out[best].factor * (1 + facet_tie);
    trial_start first = out[best];
    for (size_t k = 0; k < n; k++) if (out[k].factor <= limit && !one) out[kept++] = out[k];
    if (one) out[0] = first, kept = 1;
    return kept;
}

/* The crack with the smallest estimate that was not tried yet; SIZE_MAX: none below the limit. */
static size_t next_crack (const trial_crack *c, size_t n, const unsigned char *done, double limit)
{
    size_t best = SIZE_MAX;
    for (size_t k = 0; k < n; k++)
        if (!done[k] && c[k].factor <= limit && (best == SIZE_MAX || c[k].factor < c[best].factor)) best = k;
    return best;
}

/* Prepares the crack of a hot spot (its plane number `side`), with an estimate. *never 1: no crack is
 * possible. */
static pg_status prepare (const search *g, const hot_spot *spot, int side, trial_crack *c,
                          unsigned char *never)
{
    pg_status status = PG_OK;
    lay (g, spot, side, c);
    *never = !isfinite (spot->factor) || !(c->reach[0] + c->reach[1] >= c->least);
    if (*never) return PG_OK;
    PG_TRY (look_along (g, c));
    estimate (g, c);
done:
    return status;
}

pg_status trial_initiation (trials *w, const pg_state *state, const trial_fields *f, trial_limits limits,
                            void *context, double below, trial_start *out, size_t *n, int *arbitrary)
{
    pg_status status = PG_OK;
    search g = { w, state, f, limits, context, below };
    trial_crack *c = NULL;
    hot_spot spot[MOST_SPOTS + MOST_ON_INTERFACES];
    trial_start tried[MOST_TRIED] = { { .factor = 0 } };
    unsigned char done_[2 * (MOST_SPOTS + MOST_ON_INTERFACES)] = { 0 };
    size_t nspot, more, ntried = 0, about = 0, k, ncrack = 0;
    *n = 0, *arbitrary = 0;
    if (!state->paths || !w->system->force->field) return PG_OK;
    PG_TRY (hot_spots (&g, MOST_SPOTS, spot, &nspot));
    PG_TRY (hot_interfaces (&g, MOST_ON_INTERFACES, spot + nspot, &more));
    nspot += more;
    PG_ALLOC (c, 2 * nspot);
    for (size_t i = 0; i < nspot; i++) {
        about += !spot[i].interface && spot[i].factor <= spot[0].factor * (1 + even);
        /* in shear two planes are equally near to failure */
        for (int side = 0; side <= spot[i].slides; side++, ncrack++)
            PG_TRY (prepare (&g, &spot[i], side, &c[ncrack], &done_[ncrack]));
    }
    while (ntried < MOST_TRIED && (k = next_crack (c, ncrack, done_, doubt * g.best)) != SIZE_MAX) {
        done_[k] = 1;
        PG_TRY (try_crack (&g, &c[k], &tried[ntried]));
        g.best = fmin (g.best, tried[ntried].factor);
        if (tried[ntried].factor < below) ntried++;
    }
    *arbitrary = about > TRIAL_MOST_STARTS;
    *n = keep_best (tried, ntried, *arbitrary);
    if (*n > TRIAL_MOST_STARTS) *n = TRIAL_MOST_STARTS;
    memcpy (out, tried, *n * sizeof *out);
done:
    pg_free (c);
    return status;
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * Random networks. Of each crack its length and its direction are drawn once; then positions are drawn until
 * it fits: inside the body, and far enough from all cracks before it. So lengths and directions have the
 * distributions that were asked for, whatever the body, and only the positions depend on body and neighbours
 * (drawing all anew whenever a crack does not fit would prefer short cracks). A crack that fits nowhere,
 * because it is too long for the body in its direction, is drawn anew; where several in a row fit nowhere,
 * the input file is refused.
 *
 * Random numbers and every decision that depends on them use only the functions of random.c, so that a seed
 * gives one network on every machine. */
#include "crack_random.h"
#include "geometry/cloud/search/crack_distance.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* TRIES: positions tried for one crack. CRACKS: cracks in a row that may fit nowhere. ALL_TRIES: positions
 * tried for a whole network. DRAWS: values drawn before the limits of a distribution are given up. DEEPEST:
 * depth of the subdivision of a crack near the surface. SAMPLE: lengths drawn to find their mean. */
enum { TRIES = 5000, CRACKS = 20, ALL_TRIES = 10000000, DRAWS = 100000, DEEPEST = 10, SAMPLE = 2000 };

/* The network while it grows. */
typedef struct {
    const crack_request *ask;
    crack_list *list;
    random_source source;
    /* The body without slots and layers; its area (m^2) or volume (m^3). */
    pg_body body;
    double  measure;
    /* Balls about all cracks so far, centre and radius, m (n x 4). */
    double *ball;  size_t nball, capacity;
    crack_grid grid;
    /* Number of positions tried so far. */
    long    tries;
} network;

/* ---- random numbers -------------------------------------------------------------------------------------
 */
/* Draws one value, which may lie beyond the limits. */
static double draw_once (const crack_distribution *d, random_source *r)
{
    double u, a, ratio, variance;
    switch (d->kind) {
    case CRACK_UNIFORM:     return d->low + (d->high - d->low) * random_uniform (r);
    case CRACK_NORMAL:      return d->mean + d->deviation * random_normal (r);
    case CRACK_LOGNORMAL:   /* mean and deviation are those of the value, not of its logarithm */
        variance = settled_log (1 + d->deviation / d->mean * (d->deviation / d->mean));
        return d->mean * settled_exp (sqrt (variance) * random_normal (r) - 0.5 * variance);
    case CRACK_EXPONENTIAL: return -d->mean * settled_log (random_uniform (r));
    case CRACK_POWER_LAW:   /* density ~ l^-exponent, by inversion between low and high */
        u = random_uniform (r), a = 1 - d->exponent, ratio = d->high / d->low;
        if (fabs (a) < 1e-9) return d->low * settled_power (ratio, u);
        return d->low * settled_power (1 + u * (settled_power (ratio, a) - 1), 1 / a);
    default:                return d->mean;
    }
}

/* Draws until a value lies between the limits; NAN: they leave next to nothing of the distribution. */
double crack_draw (const crack_distribution *d, random_source *r)
{
    for (int n = 0; n < DRAWS; n++) {
        double x = draw_once (d, r);
        if (x >= d->low && x <= d->high) return x;
    }
    return NAN;
}

/* ---- drawing a crack ------------------------------------------------------------------------------------
 */
/* A crack centred at the origin, m: in 2D half of its vector; in 3D its unit normal and two half vectors at
 * right angles. */
typedef struct { double length, half[3], other[3], normal[3]; } model;

static int draw_direction (network *w, double *direction)
{
    const crack_distribution *d = &w->ask->angle;
    double c, s, turn[2];
    if (d->kind == CRACK_VON_MISES) {
        settled_angle (d->mean, &c, &s);
        random_von_mises (&w->source, d->concentration, turn);
        direction[0] = c * turn[0] - s * turn[1], direction[1] = s * turn[0] + c * turn[1];
        return 1;
    }
    double angle = crack_draw (d, &w->source);
    if (isnan (angle)) return 0;
    settled_angle (angle, &direction[0], &direction[1]);
    return 1;
}

/* Draws a normal near the requested one, and a direction in the crack's plane, turned at random. */
static void draw_frame (network *w, model *m)
{
    double local[3], e[3], f[3], c, s;
    const double *n = w->ask->normal;
    crack_plane (n, e, f);
    random_fisher (&w->source, w->ask->angle.concentration, local);
    for (int k = 0; k < 3; k++) m->normal[k] = local[0] * e[k] + local[1] * f[k] + local[2] * n[k];
    double size =
        sqrt (m->normal[0] * m->normal[0] + m->normal[1] * m->normal[1] + m->normal[2] * m->normal[2]);
    for (int k = 0; k < 3; k++) m->normal[k] /= size;
    crack_plane (m->normal, e, f);
    settled_angle (6.28318530717958647692 * random_uniform (&w->source), &c, &s);
    for (int k = 0; k < 3; k++) {
        m->half[k] = 0.5 * m->length * (c * e[k] + s * f[k]);
        m->other[k] = 0.5 * m->length * w->ask->aspect * (c * f[k] - s * e[k]);
    }
}

/* Makes c the crack m with its middle at the position `at` (m). */
static pg_status place (pg_crack *c, const network *w, const model *m, const double *at)
{
    double v[12];
    const char *why = NULL;
    if (w->list->all->dim == 2) {
        for (int k = 0; k < 2; k++) v[k] = at[k] - m->half[k], v[2 + k] = at[k] + m->half[k];
        return crack_segment (c, v, v + 2, &why);
    }
    if (w->ask->shape == CRACK_DISC) return crack_disc (c, at, m->normal, 0.5 * m->length, &why);
    if (w->ask->shape == CRACK_ELLIPSE)
        return crack_ellipse (c, at, m->normal, m->half, m->length, m->length * w->ask->aspect, &why);
    for (int k = 0; k < 3; k++) {
        v[k] = at[k] - m->half[k] - m->other[k], v[3 + k] = at[k] + m->half[k] - m->other[k];
        v[6 + k] = at[k] + m->half[k] + m->other[k], v[9 + k] = at[k] - m->half[k] + m->other[k];
    }
    return crack_polygon (c, 4, v, &why);
}

/* ---- does a crack fit? ----------------------------------------------------------------------------------
 */
/* Does the piece at + i half + j other, i in [i0, i1], j in [j0, j1], lie in the body, `deep` m below the
 * surface? By balls around it and subdivision; at the greatest depth its middle decides. */
static int piece_inside (const network *w, const model *m, const double *at, const double *range, double deep,
                         int depth)
{
    double x[3] = { 0 }, r = 0;
    const double *half = m->half, *other = m->other;
    double i = 0.5 * (range[0] + range[1]), j = 0.5 * (range[2] + range[3]);
    for (int k = 0; k < w->body.dim; k++) {
        x[k] = at[k] + i * half[k] + j * other[k];
        double a = 0.5 * (range[1] - range[0]) * half[k], b = 0.5 * (range[3] - range[2]) * other[k];
        r += a * a + b * b;
    }
    r = sqrt (r);                                      /* the two are at right angles */
    if (!pg_body_inside (&w->body, x, -deep)) return 0;
    if (depth == DEEPEST || pg_body_inside (&w->body, x, -deep - r * (1 + 1e-9))) return 1;
    for (int q = 0; q < 4; q++) {
        double part[4] = { q & 1 ? i : range[0], q & 1 ? range[1] : i, q & 2 ? j : range[2],
                           q & 2 ? range[3] : j };
        if (w->body.dim == 2 && q & 2) break;
        if (w->body.dim == 2) part[2] = part[3] = 0;
        if (!piece_inside (w, m, at, part, deep, depth + 1)) return 0;
    }
    return 1;
}

/* Does a disc or an ellipse lie in the body, `deep` m below its surface? Tested at a ring of positions on the
 * rim, and at a ring half as large. */
static int round_inside (const network *w, const model *m, const double *at, double deep)
{
    enum { RING = 96 };
    for (int n = 0; n < RING; n++) {
        double c, s, x[3];
        settled_angle (6.28318530717958647692 * n / RING, &c, &s);
        for (int k = 0; k < 3; k++) x[k] = at[k] + c * m->half[k] + s * m->other[k];
        if (!pg_body_inside (&w->body, x, -deep)) return 0;
        for (int k = 0; k < 3; k++) x[k] = 0.5 * (x[k] + at[k]);
        if (!pg_body_inside (&w->body, x, -deep)) return 0;
    }
    return 1;
}

static int fits_body (const network *w, const model *m, const double *at)
{
    const double whole[4] = { -1, 1, w->body.dim == 3 ? -1 : 0, w->body.dim == 3 ? 1 : 0 };
    double deep = w->ask->margin + 0.5 * w->ask->width;
    if (!pg_body_inside (&w->body, at, 0)) return 0;
    if (!w->ask->whole) return 1;
    if (w->body.dim == 3 && w->ask->shape != CRACK_RECTANGLE) return round_inside (w, m, at, deep);
    return piece_inside (w, m, at, whole, deep, 0);
}

/* Radius of the ball about a crack, enlarged by half its slot and by the slack of a disc, m. */
static double grown (const pg_crack *c, double radius) { return 1.01 * (radius + 0.5 * c->slot); }

/* Is the crack far enough from crack i? Their balls decide for most pairs. */
static int far_from (const network *w, const pg_crack *c, const double *middle, double radius, size_t i)
{
    const pg_crack *b = &w->list->all->crack[i];
    const double *ball = w->ball + 4*i;
    double d[3] = { ball[0] - middle[0], ball[1] - middle[1], ball[2] - middle[2] };
    /* a polygon that replaces a disc lies inside of it by this much at most */
    double slack = (c->kind == PG_CRACK_DISC ? 0.0013 * c->radius : 0)
                   + (b->kind == PG_CRACK_DISC ? 0.0013 * b->radius : 0),
           least = w->ask->distance + 0.5 * (c->slot + b->slot) + slack;
    if (sqrt (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) > radius + ball[3] + least) return 1;
    double apart = crack_distance (c, b, w->list->all->dim);
    return !(apart < least || apart == 0);
}

/* Is the crack far enough from all cracks before it? Only balls in the grid cells that its own ball meets are
 * tested, enlarged by the least distance (widths of slots and slack of discs are parts of the radii). */
static int far_from_others (const network *w, const pg_crack *c)
{
    double middle[3], radius;
    int dim = w->list->all->dim, first[3], last[3], at[3];
    if (w->ask->distance < 0) return 1;
    crack_ball (c, dim, middle, &radius);
    crack_grid_range (&w->grid, middle, w->ask->distance + grown (c, radius), first, last);
    for (at[2] = first[2]; at[2] <= last[2]; at[2]++)
        for (at[1] = first[1]; at[1] <= last[1]; at[1]++)
            for (at[0] = first[0]; at[0] <= last[0]; at[0]++) {
                const struct crack_cell *cell = crack_grid_cell (&w->grid, at);
                for (size_t k = 0; k < cell->n; k++)
                    if (!far_from (w, c, middle, radius, cell->ball[k])) return 0;
            }
    return 1;
}

static pg_status add_ball (network *w, const pg_crack *c)
{
    pg_status status = PG_OK;
    PG_GROW (w->ball, w->capacity, 4 * (w->nball + 1));
    double *ball = w->ball + 4 * w->nball;
    crack_ball (c, w->list->all->dim, ball, ball + 3);
    if (w->ask->distance >= 0)
        PG_TRY (crack_grid_add (&w->grid, (unsigned) w->nball, ball, grown (c, ball[3])));
    w->nball++;
done:
    return status;
}

/* ---- the network ----------------------------------------------------------------------------------------
 */
static void draw_place (network *w, double *at)
{
    const crack_request *ask = w->ask;
    for (int k = 0; k < w->body.dim; k++)
        at[k] = ask->gathered ? ask->mean[k] + ask->deviation[k] * random_normal (&w->source)
                              : ask->low[k] + (ask->high[k] - ask->low[k]) * random_uniform (&w->source);
}

/* Draws a crack and finds a position for it; *found: 0: none fits. */
static pg_status add_crack (network *w, int *found)
{
    pg_status status = PG_OK;
    model m = { .length = crack_draw (&w->ask->length, &w->source) };
    double direction[2] = { 1, 0 }, at[3] = { 0, 0, 0 };
    int plane = w->body.dim == 2;
    *found = 0;
    if (isnan (m.length) || (plane && !draw_direction (w, direction))) return PG_OK;
    if (plane) for (int k = 0; k < 2; k++) m.half[k] = 0.5 * m.length * direction[k];
    else draw_frame (w, &m);
    for (int n = 0; n < TRIES && w->tries < ALL_TRIES && !*found; n++) {
        w->tries++;
        draw_place (w, at);
        if (!fits_body (w, &m, at)) continue;
        pg_crack *c = crack_next (w->list);
        if (!c) PG_FAIL (PG_E_MEMORY, "no memory for a crack");
        PG_TRY (place (c, w, &m, at));
        *found = far_from_others (w, c);
        if (*found) PG_TRY (add_ball (w, c));
        else pg_free (c->vertex), w->list->all->n--;
    }
done:
    return status;
}

/* Is the network complete with n cracks of the total length (3D: area) `size`, which remove the area (volume)
 * `removed`? */
static int complete (const network *w, long n, double size, double removed)
{
    const crack_request *ask = w->ask;
    if (ask->count) return n >= ask->count;
    if (ask->fraction > 0) return removed >= ask->fraction * w->measure;
    return size >= ask->intensity * w->measure;
}

/* Number of cracks that may still be drawn after the networks before this one. */
static long most_left (const network *w) { return CRACK_MOST - w->list->drawn; }

/* Reports that the network cannot be completed, and how far it came. */
static void give_up (const network *w, long n, double size, double removed)
{
    char path[96], what[96];
    const crack_request *ask = w->ask;
    snprintf (path, sizeof path, "%s.random", w->list->at);
    if (ask->count) snprintf (what, sizeof what, "of %ld cracks", ask->count);
    else if (ask->fraction > 0)
        snprintf (what, sizeof what, "cracks, %.3g %% of the body instead of %.3g %%",
                  100 * removed / w->measure, 100 * ask->fraction);
    else
        snprintf (what, sizeof what, "cracks, an intensity of %.4g /m instead of %.4g /m", size / w->measure,
                  ask->intensity);
    long left = most_left (w);
    if (w->tries >= ALL_TRIES || n >= left) {
        char most[96];
        snprintf (most, sizeof most, "before their number was %ld, the most that are drawn%s", left,
                  w->list->drawn ? " beside the networks above" : "");
        pg_scene_fault (w->list->scene, path,
                        "only %ld %s found a place %s; ask for fewer, shorter or nearer "
                        "ones (distance, margin), or for inside: middle", n, what,
                        n >= left ? most : "in 10000000 tries");
        return;
    }
    pg_scene_fault (
        w->list->scene, path,
        "only %ld %s found a place: of the next %d none did in %d tries; ask for fewer, shorter or "
        "nearer ones (distance, margin), or for inside: middle",
        n, what, CRACKS, TRIES);
}

/* Mean length (area) of the cracks to be drawn, by a sample of their lengths, m or m^2. */
static double mean_size (const crack_request *ask, int dim)
{
    random_source r;
    double sum = 0;
    random_start (&r, ask->seed);
    for (int n = 0; n < SAMPLE; n++) {
        double length = crack_draw (&ask->length, &r);
        sum += dim == 2 ? length : length * length * (ask->shape == CRACK_DISC ? 1 : ask->aspect);
    }
    return sum / SAMPLE * (dim == 2 || ask->shape == CRACK_RECTANGLE ? 1 : 0.785398163397448);
}

/* Refuses, before the first crack is drawn, a network that would take more cracks than all networks of an
 * input file may have together. */
static int affordable (const network *w)
{
    char path[96], beside[96] = "";
    const crack_request *ask = w->ask;
    long left = most_left (w);
    double size = mean_size (ask, w->body.dim), most = (double) left * size / w->measure;
    const char *key = ask->count          ? "count"
                      : ask->fraction > 0 ? "fraction"
                                          : "intensity",
               *unit = ask->count || ask->fraction > 0 ? "" : " 1/m";
    double asked = ask->fraction > 0 ? ask->fraction : ask->intensity;
    if (ask->fraction > 0) most *= ask->width;
    snprintf (path, sizeof path, "%s.random.%s", w->list->at, key);
    if (w->list->drawn)
        snprintf (beside, sizeof beside, " in all networks together, %ld of them in those above",
                  w->list->drawn);
    if (left == 0 || (ask->count && ask->count > left)) {
        pg_scene_fault (w->list->scene, path, "at most %d cracks are drawn%s: %s [1, %ld]", CRACK_MOST,
                        beside, left ? "must lie in" : "none is left of", left ? left : CRACK_MOST);
        return 0;
    }
    if (ask->count || !(asked > most)) return 1;
    pg_scene_fault (w->list->scene, path,
                    "takes about %.2g cracks of this length, and at most %d are drawn%s: must lie in "
                    "(0, %.3g]%s",
                    asked / most * (double) left, CRACK_MOST, beside, most, unit);
    return 0;
}

/* Sets the body in which cracks are placed: without its layers. */
static pg_status settle_body (network *w)
{
    pg_status status = PG_OK;
    w->body = *w->list->body;
    w->body.n -= w->body.nlayer, w->body.nlayer = 0;
    for (size_t i = 0; i < w->list->body->nlayer; i++) {
        const pg_layer *l = &w->list->body->layer[i];
        *(l->side % 2 ? &w->body.high[l->side / 2] : &w->body.low[l->side / 2]) = l->face;
    }
    PG_TRY (crack_body_measure (&w->measure, &w->body));
done:
    return status;
}

pg_status crack_read_random (crack_list *list)
{
    pg_status status = PG_OK;
    crack_request ask = { 0 };
    network w = { .ask = &ask, .list = list };
    double size = 0, removed = 0;
    long n = 0;
    if (list->body->n == 0) {
        pg_scene_fault (
            list->scene, list->at,
            "random cracks need a body of shapes, to know where they may lie; for points or a mesh "
            "give cracks by file (perigal cracks --csv writes one)");
        return PG_OK;
    }
    PG_TRY (settle_body (&w));
    ask.width = list->width;
    memcpy (ask.low, w.body.low, sizeof ask.low);
    memcpy (ask.high, w.body.high, sizeof ask.high);
    PG_TRY (crack_request_read (&ask, list));
    if (!affordable (&w)) goto done;
    random_start (&w.source, ask.seed);
    PG_TRY (crack_grid_create (&w.grid, w.body.dim, w.body.low, w.body.high));
    for (size_t i = 0; i < list->all->n && ask.distance >= 0; i++)
        PG_TRY (add_ball (&w, &list->all->crack[i]));
    while (!complete (&w, n, size, removed)) {
        int found = 0, vain = 0;
        for (; vain < CRACKS && !found; vain += !found) PG_TRY (add_crack (&w, &found));
        if (!found || n >= most_left (&w)) {
            give_up (&w, n, size, removed);
            break;
        }
        pg_crack *c = &list->all->crack[list->all->n - 1];
        c->vain = vain;
        n++, size += pg_crack_size (c, w.body.dim), removed += crack_removed (c, w.body.dim);
    }
    list->drawn += n;
done:
    crack_grid_clear (&w.grid);
    pg_free (w.ball);
    return status;
}

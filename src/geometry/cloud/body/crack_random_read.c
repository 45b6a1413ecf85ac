/* SPDX-License-Identifier: GPL-3.0-or-later
 * Reads the request for a random network: `cracks: [{random: {...}}]`. Keys that the distribution chosen does
 * not use are errors, as are limits that leave nothing of it. */
#include "crack_random.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Bits for the keys of a distribution, by which each kind lists those that it takes. */
enum { MEAN = 1, DEVIATION = 2, MIN = 4, MAX = 8, EXPONENT = 16, CONCENTRATION = 32, SPREADS = 6 };
static const char *const key[SPREADS] = { "mean", "deviation", "min", "max", "exponent", "concentration" };
/* needs, may have: bits of the keys above */
typedef struct { const char *name; int kind, needs, may; } spread;
static const spread lengths[] = {
    { "uniform", CRACK_UNIFORM, MIN | MAX, 0 },
    { "normal", CRACK_NORMAL, MEAN | DEVIATION, MIN | MAX },
    { "lognormal", CRACK_LOGNORMAL, MEAN | DEVIATION, MIN | MAX },
    { "exponential", CRACK_EXPONENTIAL, MEAN, MIN | MAX },
    { "power_law", CRACK_POWER_LAW, MIN | MAX | EXPONENT, 0 },
    { NULL, 0, 0, 0 } };
static const spread angles[] = {
    { "uniform", CRACK_UNIFORM, MIN | MAX, 0 },
    { "normal", CRACK_NORMAL, MEAN | DEVIATION, MIN | MAX },
    { "von_mises", CRACK_VON_MISES, MEAN | CONCENTRATION, 0 },
    { NULL, 0, 0, 0 } };

/* The state of the reader. */
typedef struct { const pg_scene *scene; const crack_list *list; char at[96]; } asking;

/* Writes the path of a key, such as "cracks[0].random.length.min". */
static const char *path_of (const asking *a, char out[160], const char *map, const char *word)
{
    snprintf (out, 160, "%s.%s%s%s", a->at, map, *word ? "." : "", word);
    return out;
}

/* Reads a distribution from a map; low and high are its limits where none are given. */
static void read_spread (crack_distribution *d, const asking *a, const char *map, const spread *all)
{
    char path[160], *const out = path;
    const spread *s = all;
    double *value[SPREADS] = { &d->mean, &d->deviation, &d->low, &d->high, &d->exponent, &d->concentration };
    const char *name = pg_scene_text (a->scene, "%s", path_of (a, out, map, "distribution"));
    while (s->name && strcmp (s->name, name) != 0) s++;
    if (!s->name) return;                              /* an unknown name has been reported already */
    d->kind = s->kind;
    for (int k = 0; k < SPREADS; k++) {
        int given = pg_scene_given (a->scene, "%s", path_of (a, out, map, key[k])), bit = 1 << k;
        if (given) *value[k] = pg_scene_number (a->scene, "%s", path);
        if (given && !((s->needs | s->may) & bit))
            pg_scene_fault (a->scene, path, "has no effect with distribution: %s", s->name);
        if (!given && (s->needs & bit))
            pg_scene_fault (a->scene, path_of (a, out, map, ""), "distribution: %s needs %s", s->name,
                            key[k]);
    }
    if (!(d->low <= d->high))
        pg_scene_fault (a->scene, path_of (a, out, map, ""), "min, %g, lies above max, %g", d->low, d->high);
}

/* Reports limits that leave next to nothing of a distribution: drawing from it would not end. */
static void try_draw (const crack_distribution *d, const asking *a, const char *map)
{
    char path[160];
    random_source r;
    random_start (&r, 1);
    if (d->kind != CRACK_VON_MISES && isnan (crack_draw (d, &r)))
        pg_scene_fault (a->scene, path_of (a, path, map, ""),
                        "next to nothing of this distribution lies between min and max");
}

/* Reads the length of cracks: a number (m), or a map with its distribution. */
static void read_length (crack_distribution *d, const asking *a)
{
    *d = (crack_distribution) { .kind = CRACK_FIXED, .low = 0, .high = INFINITY };
    if (!pg_scene_given (a->scene, "%s.length.distribution", a->at)) {
        d->mean = pg_scene_number (a->scene, "%s.length", a->at);
        return;
    }
    read_spread (d, a, "length", lengths);
    /* a length is positive, whatever tail a distribution has */
    if (!(d->low > 0)) d->low = 1e-300;
}

/* Reads the 2D direction of cracks: an angle (rad), or a map with its distribution; without it all directions
 * are equally likely. */
static void read_angle (crack_distribution *d, const asking *a)
{
    const double pi = 3.14159265358979323846;
    *d = (crack_distribution) { .kind = CRACK_UNIFORM, .low = 0, .high = pi };
    if (pg_scene_given (a->scene, "%s.angle.distribution", a->at)) {
        d->low = -INFINITY, d->high = INFINITY;
        read_spread (d, a, "angle", angles);
    } else if (pg_scene_given (a->scene, "%s.angle", a->at))
        *d = (crack_distribution) { .kind = CRACK_FIXED, .low = -INFINITY, .high = INFINITY,
                                    .mean = pg_scene_number (a->scene, "%s.angle", a->at) };
}

/* Reads, in 3D, the mean normal and its concentration: how closely the normals lie about it. */
static void read_normal (crack_request *q, const asking *a)
{
    char path[160];
    q->normal[2] = 1;
    q->angle.kind = CRACK_FISHER;
    if (!pg_scene_given (a->scene, "%s.normal", a->at)) return;
    pg_scene_vector (a->scene, 3, q->normal, "%s.normal.mean", a->at);
    q->angle.concentration = pg_scene_number (a->scene, "%s.normal.concentration", a->at);
    double size =
        sqrt (q->normal[0] * q->normal[0] + q->normal[1] * q->normal[1] + q->normal[2] * q->normal[2]);
    if (!(size > 0))
        pg_scene_fault (a->scene, path_of (a, path, "normal", "mean"), "the direction has no length");
    else for (int k = 0; k < 3; k++) q->normal[k] /= size;
}

/* Reads the distribution of the middles: uniform in a box, or normal about a mean. */
static void read_position (crack_request *q, const asking *a)
{
    char path[160];
    const char *kind = pg_scene_text (a->scene, "%s.position.distribution", a->at);
    static const char *const words[] = { "low", "high", "mean", "deviation" };
    double *value[] = { q->low, q->high, q->mean, q->deviation };
    if (!pg_scene_given (a->scene, "%s.position", a->at)) return;
    q->gathered = kind && strcmp (kind, "normal") == 0;
    for (int k = 0; k < 4; k++) {
        int given = pg_scene_given (a->scene, "%s", path_of (a, path, "position", words[k]));
        if (given && (k >= 2) != q->gathered)
            pg_scene_fault (a->scene, path, "has no effect with distribution: %s", kind);
        else if (given) pg_scene_vector (a->scene, 3, value[k], "%s", path);
        else if (k >= 2 && q->gathered)
            pg_scene_fault (a->scene, path_of (a, path, "position", ""), "distribution: normal needs %s",
                            words[k]);
    }
    for (int k = 0; k < a->list->all->dim; k++)
        if (!(q->low[k] <= q->high[k]) || q->deviation[k] < 0) {
            pg_scene_fault (a->scene, path_of (a, path, "position", ""),
                            "low must not lie above high, and no deviation be negative");
            break;
        }
}

/* Reports keys that belong to the other dimension (2D or 3D). */
static void refuse_dimension (const asking *a)
{
    static const struct { const char *key; int dim; } of[] = {
        { "angle", 2 }, { "normal", 3 }, { "shape", 3 }, { "aspect", 3 } };
    char path[160];
    for (size_t k = 0; k < sizeof of / sizeof *of; k++)
        if (a->list->all->dim != of[k].dim
            && pg_scene_given (a->scene, "%s", path_of (a, path, of[k].key, "")))
            pg_scene_fault (a->scene, path, "is for %dD", of[k].dim);
}

static void read_shape (crack_request *q, const asking *a)
{
    char path[160];
    const char *shape = pg_scene_text (a->scene, "%s.shape", a->at);
    q->shape = strcmp (shape, "rectangle") == 0 ? CRACK_RECTANGLE
               : strcmp (shape, "ellipse") == 0 ? CRACK_ELLIPSE
                                                : CRACK_DISC;
    q->aspect = pg_scene_number (a->scene, "%s.aspect", a->at);
    if (q->shape == CRACK_DISC && pg_scene_given (a->scene, "%s", path_of (a, path, "aspect", "")))
        pg_scene_fault (a->scene, path, "a disc is as broad as long: choose shape: rectangle or ellipse");
}

pg_status crack_request_read (crack_request *out, const crack_list *list)
{
    asking a = { .scene = list->scene, .list = list };
    char path[160];
    snprintf (a.at, sizeof a.at, "%s.random", list->at);
    out->seed = (uint32_t) pg_scene_integer (a.scene, "%s.seed", a.at);
    out->count = pg_scene_integer (a.scene, "%s.count", a.at);
    out->fraction = pg_scene_number (a.scene, "%s.fraction", a.at);
    out->intensity = pg_scene_number (a.scene, "%s.intensity", a.at);
    if (out->fraction > 0 && !(out->width > 0))
        pg_scene_fault (a.scene, path_of (&a, path, "fraction", ""),
                        "sharp cracks take no %s: give the entry a width, or ask for a count or an intensity",
                        list->all->dim == 2 ? "area" : "volume");
    refuse_dimension (&a);
    read_length (&out->length, &a);
    if (list->all->dim == 2) read_angle (&out->angle, &a);
    else read_normal (out, &a), read_shape (out, &a);
    read_position (out, &a);
    out->distance =
        pg_scene_given (a.scene, "%s.distance", a.at) ? pg_scene_number (a.scene, "%s.distance", a.at) : -1;
    out->whole = strcmp (pg_scene_text (a.scene, "%s.inside", a.at), "whole") == 0;
    out->margin = pg_scene_number (a.scene, "%s.margin", a.at);
    if (!out->whole && pg_scene_given (a.scene, "%s", path_of (&a, path, "margin", "")))
        pg_scene_fault (a.scene, path, "has no effect with inside: middle");
    pg_status status = pg_scene_verdict (a.scene);
    if (status != PG_OK) return status;
    try_draw (&out->length, &a, "length");
    if (list->all->dim == 2) try_draw (&out->angle, &a, "angle");
    return pg_scene_verdict (a.scene);
}

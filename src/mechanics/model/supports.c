/* SPDX-License-Identifier: GPL-3.0-or-later
 * Checks of supports: whether two of them contradict each other at common points or facets, and whether those
 * by elimination are too many. */
#include "model.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { LOOKS = 5 };                                    /* times of the run at which values are compared */
typedef struct { const int *item; size_t n; } held;

/* Finds the next item in both ascending lists from *i and *k on, in one pass; 0: there are no more. */
static int next_common (const held *a, const held *b, size_t *i, size_t *k)
{
    while (*i < a->n && *k < b->n) {
        if (a->item[*i] == b->item[*k]) return 1;
        if (a->item[*i] < b->item[*k]) ++*i;
        else ++*k;
    }
    return 0;
}

/* Number of common items of two ascending lists. */
static size_t common (const held *a, const held *b)
{
    size_t i = 0, k = 0, n = 0;
    for (; next_common (a, b, &i, &k); i++, k++) n++;
    return n;
}

/* Returns 1: the support acts on facets by Nitsche's method, 0: on points. */
static int by_facets (const pg_load *load) { return load->essential == PG_ESSENTIAL_NITSCHE; }

/* Kind of the common items of two supports: PG_FACETS, PG_NODES, or -1: none. Common points of a support by
 * Nitsche's method and one on points (at corners) count only if one set contains the other. */
static int shared (const pg_load *a, const pg_load *b, held *first, held *second)
{
    *first = (held) { a->set->facet, a->set->nfacet }, *second = (held) { b->set->facet, b->set->nfacet };
    if (by_facets (a) && by_facets (b)) return common (first, second) ? PG_FACETS : -1;
    *first = (held) { a->set->point, a->set->npoint }, *second = (held) { b->set->point, b->set->npoint };
    size_t n = common (first, second), all = first->n < second->n ? first->n : second->n;
    if (by_facets (a) || by_facets (b)) return n && n == all ? PG_NODES : -1;
    return n ? PG_NODES : -1;
}

/* Time number `look` at which two loads are compared: LOOKS fractions of the run, then the rows of both
 * tables. */
static double time_of (const pg_load *a, const pg_load *b, double duration, size_t look)
{
    if (look < LOOKS) return duration * (double) (LOOKS - look) / LOOKS;
    look -= LOOKS;
    return look < a->ntable ? a->table[2 * look] : b->table[2 * (look - a->ntable)];
}

typedef struct { double here, there, t, x[3]; size_t differ; } conflict;

/* Compares component k of two supports at their common items, at several times of the run and at the rows of
 * both tables: number of items with different values, and the first of them. */
static conflict compare (const pg_problem *p, const pg_load *a, const pg_load *b, int k, int kind, held first,
                         held second, double duration)
{
    const double *places = kind == PG_FACETS ? p->cells.facet_centre : p->cloud.x;
    size_t dim = (size_t) p->dim;
    conflict c = { .differ = 0 };
    for (size_t i = 0, q = 0; next_common (&first, &second, &i, &q); i++, q++) {
        const double *x = places + (size_t) first.item[i] * dim;
        for (size_t look = 0; look < LOOKS + a->ntable + b->ntable; look++) {
            double t = time_of (a, b, duration, look), u = pg_load_value (a, k, p->dim, x, t),
                   v = pg_load_value (b, k, p->dim, x, t);
            if (fabs (u - v) <= 1e-9 * fmax (fabs (u), fabs (v))) continue;
            if (!c.differ++) {
                c.here = v, c.there = u, c.t = t;
                memcpy (c.x, x, dim * sizeof *x);
            }
            break;
        }
    }
    return c;
}

/* Key of the support in the scene: displacement, velocity or rotation. */
static const char *key_of (const pg_load *load)
{
    return load->kind == PG_VELOCITY ? "velocity" : load->kind == PG_ROTATION ? "rotation" : "displacement";
}

/* Reports a conflict: a warning for common corners, where the first support prevails; an error if more than
 * half of the smaller support is contradicted. */
static void tell (pg_problem *p, const pg_scene *scene, size_t i, size_t l, int k, int kind, size_t smaller,
                  const conflict *c)
{
    const pg_load *a = &p->boundary.load[i], *b = &p->boundary.load[l];
    char path[96], other[96], line[32] = "", at[80] = "";
    const char *unit = pg_load_rotates (a) ? "rad" : "m", *what = kind == PG_FACETS ? "facet" : "point",
               *many = c->differ > 1 ? "s" : "", *verb = c->differ > 1 ? "belong" : "belongs";
    int number, used = 0;
    snprintf (other, sizeof other, "boundary[%zu].%s.%c", i, key_of (a), pg_load_axis (a, p->dim, k));
    snprintf (path, sizeof path, "boundary[%zu].%s.%c", l, key_of (b), pg_load_axis (b, p->dim, k));
    if ((number = pg_scene_line (scene, "%s", other))) snprintf (line, sizeof line, " (line %d)", number);
    for (int d = 0; d < p->dim; d++)
        used += snprintf (at + used, sizeof at - (size_t) used, "%s%.6g", d ? ", " : "", c->x[d]);
    if (2 * c->differ > smaller)
        pg_scene_fault (
            scene, path,
            "contradicts %s%s: %zu %s%s of %s %s to %s too, and the %s at (%s) m is moved by %.6g %s there, "
            "by %.6g %s here. Equal values are fine; else leave "
            "one of them out, or take what they share out of one of the sets (sets: {NAME: {where: ...}})",
            other, line, c->differ, what, many, b->set->name, verb, a->set->name, what, at, c->there, unit,
            c->here, unit);
    else
        pg_problem_note (p,
                         PG_WARNING "%zu %s%s of %.32s, such as (%s) m, %s to %.32s too, which moves them by "
                                    "%.6g %s, not %.6g: %s comes first and holds them",
                         c->differ, what, many, b->set->name, at, verb, a->set->name, c->there, unit, c->here,
                         other);
}

/* Returns 1: both supports prescribe component k of the same quantity. */
static int comparable (const pg_load *a, const pg_load *b, int k)
{
    return pg_load_prescribes (a) && pg_load_prescribes (b) && pg_load_rotates (a) == pg_load_rotates (b)
           && a->set && b->set && a->value[k] && b->value[k];
}

/* Checks every pair of supports for conflicts; the first prevails at common points. duration: s, quasi-static
 * 1. */
void pg_supports_check (pg_problem *p, const pg_scene *scene, double duration)
{
    for (size_t l = 1; l < p->boundary.nload; l++)
        for (size_t i = 0; i < l; i++) {
            const pg_load *a = &p->boundary.load[i], *b = &p->boundary.load[l];
            int kind = -1;
            held first = { 0 }, second = { 0 };
            for (int k = 0; k < pg_load_components (a, p->dim); k++) {
                if (!comparable (a, b, k)) continue;
                if (kind < 0 && (kind = shared (a, b, &first, &second)) < 0) break;
                conflict c = compare (p, a, b, k, kind, first, second, duration);
                if (c.differ) tell (p, scene, i, l, k, kind, first.n < second.n ? first.n : second.n, &c);
            }
        }
}

/* Returns 1: the support is imposed by elimination, with dense matrices over the points prescribed in one
 * direction (not for interpolating shape functions). */
static int eliminates (const pg_problem *p, const pg_load *load)
{
    return p->method->shape_functions && !p->form.approx.type->interpolates && load->set
        && pg_load_prescribes (load)
           && load->essential == PG_ESSENTIAL_TRANSFORMATION;
}

void pg_supports_check_eliminated (const pg_problem *p, const pg_scene *scene)
{
    for (int k = 0; k < p->dim; k++) {
        size_t n = 0, largest = 0;
        for (size_t l = 0; l < p->boundary.nload; l++) {
            if (!eliminates (p, &p->boundary.load[l]) || !p->boundary.load[l].value[k]) continue;
            if (n == 0 || p->boundary.load[l].set->npoint > p->boundary.load[largest].set->npoint)
                largest = l;
            n += p->boundary.load[l].set->npoint;
        }
        if (n <= PG_MOST_ELIMINATED) continue;
        char path[64];
        snprintf (path, sizeof path, "boundary[%zu].set", largest);
        pg_scene_fault (scene, path,
                        "essential: transformation would eliminate %zu points along %c, at most %d: its "
                        "matrices are full. Take essential: penalty (the same to "
                        "1 / penalty_factor, and cheaper), or nitsche for faces",
                        n, "xyz"[k], PG_MOST_ELIMINATED);
        return;
    }
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * Bodies that collide, contact by search: scenes that tests of springs and of impulses share. */
#ifndef TEST_COLLISIONS_H
#define TEST_COLLISIONS_H
#include "scene_runs/run.h"

/* Momentum along each axis and moment of momentum about the origin; sizes of what is summed. */
static inline void momentum_of (const run *r, double *p, double *turn, double *size, double *size_turn)
{
    size_t dim = (size_t) r->problem->dim;
    *turn = *size = *size_turn = 0;
    for (size_t k = 0; k < dim; k++) p[k] = 0;
    for (size_t i = 0; i < r->problem->cloud.n; i++) {
        const double *x = r->problem->cloud.x + i * dim, *d = r->state->d + i * dim,
                     *v = r->state->v + i * dim;
        double m = r->problem->material[r->problem->block[PG_NODES][i]].density * r->problem->cloud.volume[i];
        for (size_t k = 0; k < dim; k++) p[k] += m * v[k], *size += fabs (m * v[k]);
        if (dim < 2) continue;
        *turn += m * ((x[0] + d[0]) * v[1] - (x[1] + d[1]) * v[0]);
        *size_turn += m * (fabs ((x[0] + d[0]) * v[1]) + fabs ((x[1] + d[1]) * v[0]));
    }
}

/* Two bars of n points in a line, the first at velocity v; three spacings apart; how: more keys of
 * contact. */
static inline run bars (int n, const char *kind, double unit, const char *how)
{
    double L = n * unit;
    return scene_of (1,
                     "dimension: 1\nbody: [{add: {box: {low: [0], high: [%.17g]}}}, {add: {box: {low: "
                     "[%.17g], "
                     "high: [%.17g]}}}]\nspacing: %.17g\nlattice: cells\nmaterials: {m: {youngs_modulus: "
                     "200, "
                     "poissons_ratio: 0, density: 2}}\nsets: {one: {where: \"x < %.17g\"}}\n"
                     "method: {force: bond, horizon: 2 spacing, accept_inexact: yes}\ncontact: {kind: "
                     "normal, "
                     "search: short_range%s}\ninitial: {sets: [{set: one, velocity: {x: 0.01}}]}\n"
                     "solver: {kind: %s, end: %.17g}\noutput: {at: {levels: 1, rows: 20000}}\n",
                     L, L + 3 * unit, 2 * L + 3 * unit, unit, L + unit, how, kind, 320 * unit + 0.26 * L);
}

/* Two disks that meet askew, in the plane (mm or m, turned), with friction or without. */
typedef struct { double unit, turn, friction; int threads, plain; const char *more, *force, *how; } disks;
static inline run disks_run (const disks *l)
{
    double u = l->unit, c = cos (l->turn), s = sin (l->turn), x = 15 * u, y = 5 * u;
    char contact[160];
    const char *how = l->how ? l->how : "";
    if (l->friction > 0)
        snprintf (contact, sizeof contact, "{kind: friction, coefficient: %.17g, search: short_range%s}",
                  l->friction, how);
    else snprintf (contact, sizeof contact, "{kind: normal, search: short_range%s}", how);
    return scene_of (
        l->threads,
        "dimension: 2\nplane: stress\nthickness: %.17g\nbody: [{add: {disk: {center: [0, 0], radius: "
        "%.17g}}}, "
        "{add: {disk: {center: [%.17g, %.17g], radius: %.17g}}}]\nspacing: %.17g\nlattice: cells\n"
        "materials: {m: {youngs_modulus: 1000, poissons_ratio: 0.333333333333333, density: 1}}\n"
        "sets: {one: {where: \"x*%.17g+y*%.17g < %.17g\"}}\nmethod: {force: %s, accept_inexact: yes}\n"
        "contact: %s\n"
        "initial: {sets: [{set: one, velocity: {x: %.17g, y: %.17g}}]}\n"
        "solver: {kind: verlet, end: %.17g%s}\noutput: {at: {levels: 2, rows: 200}}\n%s",
        u, 6.2 * u, x * c - y * s, x * s + y * c, 6.2 * u, u, c, s, 7.5 * u, l->force ? l->force : "bond",
            contact,
        c, s, 8 * u, l->plain ? ", plain: yes" : "", l->more ? l->more : "");
}
#endif

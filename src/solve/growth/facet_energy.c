/* SPDX-License-Identifier: GPL-3.0-or-later
 * Energy that facets in dynamics dissipate, against the fracture energy of their area. The forces that a
 * facet holds decay with the path of its tip, not with its opening, so that the two agree only while the tip
 * moves on: where tips branch, stop or move too fast, or faces touch, they differ. The run reports when and
 * where. */
#include "facet_growth.h"
#include <math.h>

/* Growth, in spacings, from which on the ratio of both is meaningful, and its bounds; at the end of a run
 * less growth is enough, with wider bounds. cut_most: energy that one cut may release, in fracture energies
 * of its facet. */
static const struct { double grown, least, most; } running = { 10, 0.9, 1.1 }, ended = { 4, 0.75, 1.3 };
static const double cut_most = 4;

/* Is the dissipated share of the fracture energy, for cracks that have grown so far, out of bounds? */
static int out_of_bounds (double share, double spacings, int finished)
{
    if (spacings >= running.grown) return !(share > running.least && share < running.most);
    return finished && spacings >= ended.grown && !(share > ended.least && share < ended.most);
}

void facet_doubt_energy (pg_solver *s, const pg_state *state, double t)
{
    facet_growth *g = s->break_loop.growth;
    const pg_statistics *r = &s->report;
    const pg_crack_paths *w = state->paths;
    if (!g || !g->motion.moving || !w || !(s->options.flags & PG_SOLVER_NEEDS_DENSITY)) return;
    if (g->said & FACET_SAID_ENERGY || !w->cracks.n) return;
    double share = r->energy.fracture > 0 ? r->energy.dissipated / r->energy.fracture : 1;
    if (!out_of_bounds (share, w->length / s->problem->cloud.h, s->finished)) return;
    const double *x = w->cracks.crack[w->cracks.n - 1].vertex + 2;
    pg_statistics_warn (&s->report,
                        "at t = %.4g s the cracks have dissipated %.3g times what their opened area takes, "
                        "the last facet being at (%.4g, %.4g) m: facets in motion that branch, stop, touch "
                        "or run ahead of a fast load take more or less than their share",
                        t, share, x[0], x[1]);
    g->said |= FACET_SAID_ENERGY;
}

void facet_doubt_cut (break_loop *b, const facet_candidate *c, double t, double freed)
{
    facet_growth *g = b->growth;
    if (g->said & FACET_SAID_CUT || !(c->energy > 0) || fabs (freed) < cut_most * c->energy) return;
    pg_statistics_warn (b->system.report,
                        "the facet that comes to (%.4g, %.4g) m at t = %.4g s sets %.3g times its fracture "
                        "energy free as it is cut: it lies too near another crack or the surface, and the "
                        "energies of the run are out by that",
                        c->to[0], c->to[1], t, freed / c->energy);
    g->said |= FACET_SAID_CUT;
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * The end of the next facet of a tip. A tip near the surface or another crack has no room for a ring any
 * more, and the piece of body left there would carry hardly any load: so a facet that would end within 1.5
 * spacings of the surface goes straight on into it, and one that would end within 0.6 spacings of another
 * crack goes straight to that crack. The tip is closed then. */
#include "facet_growth.h"
#include <math.h>

static const double to_surface = 1.5, to_crack = 0.6;  /* reach of the surface, of a crack, spacings */

/* 1: another crack is within `reach` of x; place: its nearest point. */
static int meets (const pg_crack_paths *paths, size_t tip, const double *x, double reach, double *place)
{
    double least = reach;
    int found = 0;
    for (size_t c = 0; c < paths->cracks.n; c++) {
        const double *a = paths->cracks.crack[c].vertex;
        if (paths->path[c] == paths->path[paths->tip[tip].segment]) continue;
        double q[2], d;
        pg_segment_nearest (a, a + 2, x, q, &d);
        if (d <= least) least = d, place[0] = q[0], place[1] = q[1], place[2] = 0, found = 1;
    }
    return found;
}

/* Energy that the facet from the tip to out->to takes, J. */
static void price (const break_loop *b, const pg_tip_field *f, facet_candidate *out)
{
    const pg_problem *p = b->system.problem;
    double t[2] = { out->to[0] - f->x[0], out->to[1] - f->x[1] }, length = hypot (t[0], t[1]);
    double middle[3] = { f->x[0] + 0.5 * t[0], f->x[1] + 0.5 * t[1], 0 };
    pg_fracture_limits limits;
    out->energy = facet_limits (b, middle, atan2 (t[1], t[0]), &limits)
                      ? (out->slides ? limits.shear : limits.energy) * length * p->cloud.thickness : 0;
}

void facet_place (const break_loop *b, const pg_state *state, size_t tip, double angle, int slides,
                  facet_candidate *out)
{
    const pg_problem *p = b->system.problem;
    const pg_ground g = pg_problem_ground (p);
    const pg_tip_field *f = &b->growth->field[tip];
    double e[3] = { cos (angle), sin (angle), 0 }, length = facet_length (b->growth, f), place[3] = { 0 };
    size_t n;
    const double *path = p->criterion->type->path (p->criterion, &n);
    int what = PG_MEETS_NOTHING, ends = 0;
    *out = (facet_candidate) { .tip = (long) tip, .slides = slides };
    for (int k = 0; k < 3; k++) out->to[k] = f->x[k] + length * e[k];
    if (path) facet_on_path (path, n, f->x, f->e, length, out->to, &ends);
    double ahead = pg_tip_ahead (&g, state->paths, tip, e, length + to_surface * f->h, &what);
    int straight = (what == PG_MEETS_SURFACE && ahead <= length + to_surface * f->h)
                   || (what == PG_MEETS_CRACK && ahead <= length + to_crack * f->h);
    if (straight) for (int k = 0; k < 3; k++) out->to[k] = f->x[k] + ahead * e[k];
    else if (meets (state->paths, tip, out->to, to_crack * f->h, place))
        for (int k = 0; k < 3; k++) out->to[k] = place[k], straight = 1;
    out->close = straight || ends;
    price (b, f, out);
}

/* Finds the facet from a tip to the nearest point of the surface or of another crack; 0: there is none, or it
 * lies behind the tip. */
int facet_way_out (const break_loop *b, const pg_state *state, size_t tip, facet_candidate *out)
{
    const pg_problem *p = b->system.problem;
    const pg_ground g = pg_problem_ground (p);
    const pg_tip_field *f = &b->growth->field[tip];
    double limit = facet_length (b->growth, f) + to_surface * f->h, place[2];
    int what;
    *out = (facet_candidate) { .tip = (long) tip, .close = 1 };
    double d = pg_tip_nearest (&g, state->paths, tip, limit, place, &what);
    double ahead = (place[0] - f->x[0]) * f->e[0] + (place[1] - f->x[1]) * f->e[1];
    if (what == PG_MEETS_NOTHING || ahead < -0.2 * d) return 0;
    out->to[0] = place[0], out->to[1] = place[1];
    price (b, f, out);
    return 1;
}

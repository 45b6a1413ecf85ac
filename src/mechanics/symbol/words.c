/* SPDX-License-Identifier: GPL-3.0-or-later
 * A survey in words: the kind of motion, where in the Brillouin zone it lies, and a verdict with a remedy
 * that suits the method. The words let a reader without lattice theory picture the motion: "checkerboard",
 * "alternating along x", "waves of 3 spacings". */
#include "symbol.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Describes a motion; beyond a share of 0.9 it is called pure. If all directions have the same value, none is
 * named. */
const char *pg_motion_kind (const pg_motion *m, const pg_symbol *s)
{
    double k = fabs (m->k[0]) + fabs (m->k[1]) + fabs (m->k[2]);
    if (m->turning > 0.9) return "rotation";
    if (m->turning > 0.1) return "rotation and displacement";
    if (s->dim == 1 || k == 0) return "displacement";
    if (m->alike == s->dim) return "displacement, any direction";
    return m->along > 0.9   ? "longitudinal displacement"
           : m->along < 0.1 ? "transverse displacement"
                            : "displacement along and across";
}

/* Describes where a wave vector lies: components of k at the edge of the zone (|k| = pi / step) alternate
 * from point to point. */
void pg_motion_where (const pg_motion *m, const pg_symbol *s, char *text, size_t size)
{
    int ends = 0, inside = 0, axis = 0;
    double length = 0;
    for (int a = 0; a < s->dim; a++) {
        double cells = m->k[a] * s->step[a] / 3.14159265358979323846;
        if (fabs (fabs (cells) - 1) < 1e-9) ends++, axis = a;
        else inside += fabs (cells) > 1e-9;
        length += m->k[a] * m->k[a];
    }
    if (length == 0) snprintf (text, size, "all points alike");
    else if (inside || !ends)
        snprintf (text, size, "waves of %.3g spacings", 2 * 3.14159265358979323846 / sqrt (length) / s->h);
    else if (ends == s->dim) snprintf (text, size, ends == 1 ? "from point to point" : "checkerboard");
    else if (ends == 1) snprintf (text, size, "alternating along %c", "xyz"[axis]);
    else snprintf (text, size, "alternating along two axes");
}

/* The verdict has three grades: unstable if a motion gains energy or has no stiffness, weak if one has less
 * than 0.01 of a continuum's, else stable. The remedy depends on the cause: nodal integration samples the
 * gradient where alternating motions do not show; micropolar constants become negative at a large Poisson's
 * ratio; a small horizon has few bonds. */
void pg_survey_verdict (const pg_survey *v, const pg_symbol *s, const pg_problem *p, char *text, size_t size)
{
    char where[64];
    int nodal = p->method->shape_functions && p->form.integration->at_nodes,
        nosb = nodal && p->form.approx.type->interpolates;
    const char *cure = nosb    ? "method.stabilization: silling, or method.integration: gauss"
                       : nodal ? "method.integration: gauss"
                       : pg_problem_rotations (p) && v->negative        ? "a smaller Poisson's ratio"
                       : p->form.approx.horizon < 1.7 * s->h ? "a larger horizon"
                                                        : "another kernel or a smaller horizon";
    if (v->negative) {
        pg_motion_where (&v->smallest, s, where, sizeof where);
        snprintf (text, size,
                  "unstable: %s (%s) gains energy, as do %zu more motions of %d^%d points; try %s",
                  pg_motion_kind (&v->smallest, s), where, v->negative - 1, v->grid, s->dim, cure);
    } else if (v->zero) {
        pg_motion_where (&v->first, s, where, sizeof where);
        snprintf (text, size,
                  "unstable: nothing resists %zu motion%s of %d^%d points beside rigid translation, such as "
                  "%s (%s); try %s",
                  v->zero, v->zero > 1 ? "s" : "", v->grid, s->dim, pg_motion_kind (&v->first, s), where,
                  cure);
    } else if (v->weak) {
        pg_motion_where (&v->softest, s, where, sizeof where);
        snprintf (text, size,
                  "stable, but weak: %s (%s) meets %.2g of the resistance of a continuum; if results are "
                  "rough from point to point, try %s",
                  pg_motion_kind (&v->softest, s), where, v->softest.value, cure);
    } else
        snprintf (text, size, "stable: every motion is resisted, by at least %.2g of what a continuum would",
                  v->softest.value);
}

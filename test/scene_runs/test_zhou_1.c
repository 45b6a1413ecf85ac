/* SPDX-License-Identifier: GPL-3.0-or-later
 * Zhou's plate with a hole by direct sums. Elastic: all columns of the tables together, and some alone, at
 * 100 points a side. Drawn until it breaks: the crack starts at both sides of the hole at once, close to the
 * load of the closed form, and goes through both ligaments, at 50 and at 100 points a side; by state-based
 * forces too. */
#include "measured.h"

/* Root of the sum of squares over all tables, of that of the reference. */
static double of_all_tables (const pg_errors *e)
{
    double sum = 0, all = 0;
    for (size_t i = 0; i < e->nline; i++)
        sum += pow (e->line[i].l2.difference, 2), all += pow (e->line[i].l2.reference, 2);
    return sqrt (sum / all);
}

/* Errors of all tables, of u_x on y = 0 and of u_y on x = 0 may not exceed these; the force on a grip is that
 * of the reference to `force`. */
static void within (const char *what, size_t nset, const char *const *set, double all, double u_x, double u_y,
                    double force)
{
    pg_errors e;
    run r = measured ("data/zhou_1/scene_elastic.yaml", nset, set, &e);
    assert_int_equal (e.nline, 6);
    for (size_t i = 0; i < e.nline; i++) assert_int_equal (e.line[i].missed, 0);
    print_message (
        "%s: L2 of all %.2f %%, of u_x on y = 0 %.2f %%, of u_y on x = 0 %.2f %%, force %+.2f %%\n", what,
        100 * of_all_tables (&e), 100 * e.line[0].l2.relative, 100 * e.line[1].l2.relative,
        100 * (r.step.reaction[1] / 358072.80 - 1));
    check_below (of_all_tables (&e), all);
    check_below (e.line[0].l2.relative, u_x);
    check_below (e.line[1].l2.relative, u_y);
    check_relative (r.step.reaction[1], 358072.80, force);
    check_relative (r.step.reaction[4], -r.step.reaction[1], 1e-8);
    pg_errors_clear (&e);
    clear (&r);
}

static void elastic (void **state)
{
    static const char *const cut[] = { "cells=cut" };
    static const char *const quadratic[] = { "method.kernel=quadratic", "method.horizon=3 spacing",
                                             "method.partial_volume=none" };
    (void) state;
    within ("constant", 0, NULL, 0.0110, 0.0155, 0.0105, 0.018);
    within ("constant, cut cells", 1, cut, 0.0102, 0.0158, 0.0094, 0.017);
    within ("quadratic", 3, quadratic, 0.0083, 0.0104, 0.0082, 0.022);
}

/* State-based forces by one changed key; at this Poisson's ratio their dilatation counts nowhere but in the
 * skin. */
static void state_based (void **state)
{
    static const char *const lps[] = { "method.force=lps" };
    static const char *const quadratic[] = { "method.force=lps", "method.kernel=quadratic",
                                             "method.horizon=3 spacing", "method.partial_volume=none" };
    (void) state;
    within ("state-based, constant", 1, lps, 0.0183, 0.0325, 0.0150, 0.017);
    within ("state-based, quadratic", 4, quadratic, 0.0145, 0.0165, 0.0140, 0.005);
}

/* Of the points within `near` of y = 0 (m), the least damage; of those farther than `far`, the most. */
static void look_at (const run *r, double near, double far, double *least, double *most)
{
    double *damage = field_of (r, NULL, "damage", NULL);
    *least = 1, *most = 0;
    for (size_t i = 0; i < r->problem->cloud.n; i++) {
        double y = fabs (r->problem->cloud.x[2*i + 1]);
        if (y < near) *least = fmin (*least, damage[i]);
        if (y > far) *most = fmax (*most, damage[i]);
    }
    pg_free (damage);
}

/* Displacement of the grips (mm) at which the first bond breaks; bonds of that step left and right. */
typedef struct { double start; size_t first[2]; } path;
static const char *force = "method.force=bond";
static run drawn (const char *solver, const char *spacing, int to_first, path *p)
{
    const char *const set[] = { solver, spacing, force, "output.at.rows=1000" };
    run r = { 0 };
    *p = (path) { .start = NAN };
    r = loaded ("data/zhou_1/scene.yaml", strstr (solver, "static") ? 3 : 4, set);
    while (!pg_solver_done (r.solver, r.state) && !(to_first && !isnan (p->start))) {
        advance (&r);
        if (!r.step.nbroken || !isnan (p->start)) continue;
        p->start = 0.27541 * r.step.factor;
        for (size_t i = 0; i < r.step.nbroken; i++) p->first[r.step.broken[i].place[0] > 0]++;
    }
    return r;
}

/* late: of the first break behind the static one, at most, in parts of the whole way. */
static void broken_through (const char *solver, const char *spacing, double late)
{
    path p, exact;
    double least, most;
    run r = drawn ("solver={kind: static}", spacing, 1, &exact);
    clear (&r);
    r = drawn (solver, spacing, 0, &p);
    look_at (&r, 0.55 * r.problem->cloud.h, 5 * r.problem->cloud.h, &least, &most);
    print_message ("%s, %s, %s: first bond at %.4f mm (static: %.4f), damage on the ligaments %.2f and more, "
                   "elsewhere up to %.2f, %ld broken\n",
                   force, spacing, solver, p.start, exact.start, least, most, r.state->broken);
    check_below (exact.start, p.start);
    check_below (p.start, exact.start + late * 0.27541);
    assert_int_equal (p.first[0], p.first[1]);
    assert_true (least > 0.25);
    check_below (most, 0.1);
    clear (&r);
}

static void breaks (void **state)
{
    (void) state;
    /* the scene itself */
    broken_through ("solver={kind: adr, stages: 1000, hold: off}", "spacing=0.5 mm", 0.015);
    broken_through ("solver={kind: adr, stages: 1000, hold: off}", "spacing=1 mm", 0.015);
    broken_through ("solver={kind: adr, stages: 50}", "spacing=1 mm", 0.02);  /* one stage */
    force = "method.force=lps";
    broken_through ("solver={kind: adr, stages: 50}", "spacing=1 mm", 0.02);
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (elastic), cmocka_unit_test (state_based),
                                        cmocka_unit_test (breaks) };
    return cmocka_run_group_tests_name ("scene_runs/zhou_1", tests, NULL, NULL);
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * Zhou's plate with a hole by direct sums. Elastic: all columns of the tables together, and each, at 100 points a side. */
#include "measured.h"

/* Root of the sum of squares over all tables, of that of the reference. */
static double of_all_tables (const pg_errors *e)
{
    double sum = 0, all = 0;
    for (size_t i = 0; i < e->nline; i++) sum += pow (e->line[i].l2.difference, 2), all += pow (e->line[i].l2.reference, 2);
    return sqrt (sum / all);
}

/* Errors of all tables, of u_x on y = 0 and of u_y on x = 0 may not exceed these; the force on a grip is that of the reference to `force`. */
static void within (const char *what, size_t nset, const char *const *set, double all, double u_x, double u_y, double force)
{
    pg_errors e;
    run r = measured ("data/zhou_1/scene_elastic.yaml", nset, set, &e);
    assert_int_equal (e.nline, 6);
    for (size_t i = 0; i < e.nline; i++) assert_int_equal (e.line[i].missed, 0);
    print_message ("%s: L2 of all %.2f %%, of u_x on y = 0 %.2f %%, of u_y on x = 0 %.2f %%, force %+.2f %%\n", what, 100 * of_all_tables (&e),
                   100 * e.line[0].l2.relative, 100 * e.line[1].l2.relative, 100 * (r.step.reaction[1] / 358072.80 - 1));
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
    static const char *const quadratic[] = { "method.kernel=quadratic", "method.horizon=3 spacing", "method.partial_volume=none" };
    (void) state;
    within ("constant", 0, NULL, 0.0110, 0.0155, 0.0105, 0.018);
    within ("constant, cut cells", 1, cut, 0.0102, 0.0158, 0.0094, 0.017);
    within ("quadratic", 3, quadratic, 0.0083, 0.0104, 0.0082, 0.022);
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (elastic) };
    return cmocka_run_group_tests_name ("scene_runs/zhou_1", tests, NULL, NULL);
}

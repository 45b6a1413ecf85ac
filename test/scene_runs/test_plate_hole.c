/* SPDX-License-Identifier: GPL-3.0-or-later
 * The shipped plate with a hole, clamped and sliding, against the tables along its axes and first rows of
 * points: every column within a thousandth of its largest value. But u across an axis, on the row beside it,
 * is 15 to 150 times smaller than u along: of that, within 1e-4 of the largest displacement of the row. */
#include "measured.h"

static int across (const pg_line_norms *l)
{
    return strstr (l->file, "row_x") ? l->column == 1 : strstr (l->file, "row_y") ? l->column == 0 : 0;
}

/* Largest displacement of the table that l is a column of, m. */
static double largest_on (const pg_errors *e, const pg_line_norms *l)
{
    double top = 0;
    for (size_t i = 0; i < e->nline; i++)
        if (!strcmp (e->line[i].file, l->file)) top = fmax (top, e->line[i].maximum.reference);
    return top;
}

/* force: on a grip, N, of the reference. */
static void within_a_thousandth (const char *path, double force)
{
    pg_errors e;
    run r = measured (path, 0, NULL, &e);
    /* the pin is one point inside */
    if (r.problem->boundary.nload > 2) assert_int_equal (r.problem->boundary.load[2].set->nfacet, 0);
    assert_int_equal (e.nline, 6);
    for (size_t i = 0; i < e.nline; i++) {
        const pg_line_norms *l = &e.line[i];
        double of_row = l->maximum.difference / largest_on (&e, l);
        print_message (
            "%s %s: %.2e of its largest value, %.2e of the largest displacement in the table, L2 %.2e\n",
            l->file, pg_column_name (l->column), l->maximum.relative, of_row, l->l2.relative);
        assert_int_equal (l->missed, 0);
        assert_true (l->rows >= 40);
        check_below (of_row, across (l) ? 1e-4 : 1e-3);
        if (across (l)) check_below (l->maximum.reference, 0.1 * largest_on (&e, l));
        check_below (l->maximum.relative, across (l)       ? (l->column == 1 ? 1e-3 : 3e-3)
                                          : l->column == 1 ? 1.5e-4
                                                           : 5e-4);
    }
    check_relative (r.step.reaction[1], force, 1e-4);
    check_relative (r.step.reaction[4], -r.step.reaction[1], 1e-8);
    pg_errors_clear (&e);
    clear (&r);
}

/* PERIGAL_TEST_SIZE=long; short: with the other supports only. */
static void clamped (void **state)
{
    (void) state;
    if (!longer ()) return;
    within_a_thousandth ("data/plate_hole/scene.yaml", 358072.80);
}

static void sliding (void **state)
{
    (void) state;
    within_a_thousandth ("data/plate_hole/scene_sliding.yaml", 350159.338);
}

/* The point that holds the sliding plate carries nothing: neither its place nor its motion changes the
 * force. */
static void the_pin_carries_nothing (void **state)
{
    static const char *const coarse[] = {
        "spacing=1 mm", "sets.pin.where=x > 0 mm and x < 0.6 mm and abs (y - 20.5 mm) < 0.1 mm"
    };
    static const char *const other[] = {
        "spacing=1 mm", "sets.pin.where=x > 20 mm and x < 21 mm and abs (y - 0.5 mm) < 0.1 mm",
        "boundary[2].displacement.x=0.1 mm"
    };
    pg_errors e;
    (void) state;
    run a = measured ("data/plate_hole/scene_sliding.yaml", 2, coarse, &e);
    pg_errors_clear (&e);
    run b = measured ("data/plate_hole/scene_sliding.yaml", 3, other, &e);
    pg_errors_clear (&e);
    check_below (fabs (a.step.reaction[6]), 1e-9 * fabs (a.step.reaction[1]));
    check_below (fabs (b.step.reaction[6]), 1e-9 * fabs (b.step.reaction[1]));
    check_relative (a.step.reaction[1], b.step.reaction[1], 1e-10);
    clear (&a);
    clear (&b);
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (clamped), cmocka_unit_test (sliding),
                                        cmocka_unit_test (the_pin_carries_nothing) };
    return cmocka_run_group_tests_name ("scene_runs/plate_hole", tests, NULL, NULL);
}

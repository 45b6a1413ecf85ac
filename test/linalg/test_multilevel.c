/* SPDX-License-Identifier: GPL-3.0-or-later
 * The multilevel preconditioner on points joined by springs: same answers as a factorization, symmetric,
 * iterations that do not grow with the size or along a cut, loose parts, threads, cells that are alike, wrong
 * settings, memory that runs out. */
#include "springs.h"

static int held_below (const double *x) { return x[0] < 1.5; }
static int held_and_rolling (const double *x)
{
    return x[0] < 1.5 ? 1 : x[0] > 30 && (int) (x[0] + x[1] + 0.5) % 3 == 0 ? 2 : 0;
}
static int held_both (const double *x) { return x[0] < 1.5 || x[0] > 57.5; }
static int over_cut (const double *a, const double *b) { return (a[0] < 29.3) != (b[0] < 29.3); }
static int round_notch (const double *a, const double *b)              /* x = 20.5 up to y = 30 */
{
    if ((a[0] < 20.5) == (b[0] < 20.5)) return 0;
    return a[1] + (b[1] - a[1]) * (20.5 - a[0]) / (b[0] - a[0]) < 30.2;
}

static double *draw (const springs *s)
{
    double *b = pg_calloc (s->ndof, sizeof *b);
    for (size_t i = 0; i < s->ndof; i++) b[i] = s->fixed[i] ? 0 : random_number ();
    return b;
}

/* Iterations to 1e-12; x may be NULL. */
static size_t solve_with (springs *s, const pg_multilevel_setting *setting, const double *b, double *x)
{
    pg_multilevel *m = NULL;
    pg_operator op = { s->ndof, s, springs_apply_free, springs_diagonal };
    double *room = x ? NULL : pg_calloc (s->ndof, sizeof *room), *to = x ? x : room;
    size_t used = 0;
    memset (to, 0, s->ndof * sizeof *to);
    check_ok (pg_multilevel_create (&m, setting));
    pg_preconditioner P = pg_multilevel_preconditioner (m);
    check_ok (pg_conjugate_gradients_with (&op, &P, b, to, 1e-12, 200, &used));
    pg_multilevel_free (&m);
    assert_null (m);
    pg_free (room);
    return used;
}

static size_t iterations (const springs_rule *rule)
{
    springs s = springs_of (rule);
    pg_multilevel_setting setting = springs_setting (&s, 1);
    double *b = draw (&s);
    size_t used = solve_with (&s, &setting, b, NULL);
    pg_free (b);
    springs_free (&s);
    return used;
}

static double misfit_to (const double *x, const double *y, size_t n)
{
    double worst = 0, top = 0;
    for (size_t i = 0; i < n; i++) worst = fmax (worst, fabs (x[i] - y[i])), top = fmax (top, fabs (y[i]));
    return worst / top;
}

static void answers_are_those_of_the_factor (void **state)
{
    (void) state;
    static const springs_rule rules[] = {
        { 1, 1, { 3000 }, 0, 2.1, NULL, held_below },
        { 1, 1, { 900 }, 0.3, 2.9, NULL, held_below },
        { 2, 2, { 60, 60 }, 0, 3.015, NULL, held_below },
        { 2, 2, { 60, 60 }, 0.3, 3.2, NULL, held_below },
        { 2, 1, { 90, 70 }, 0, 1.5, NULL, held_below },
        { 2, 3, { 60, 60 }, 0.2, 2.9, round_notch, held_below },
        { 2, 2, { 60, 60 }, 0, 3.015, round_notch, held_below },
        { 2, 2, { 60, 60 }, 0.2, 3.015, over_cut, held_both },
        { 3, 3, { 13, 14, 15 }, 0, 2.1, NULL, held_below },
        { 3, 3, { 13, 14, 15 }, 0.25, 2.3, NULL, held_below },
    };
    for (size_t k = 0; k < sizeof rules / sizeof *rules; k++) {
        springs s = springs_of (&rules[k]);
        pg_multilevel_setting setting = springs_setting (&s, 1);
        pg_sparse A = springs_matrix (&s);
        pg_linear_options o = { s.block, s.dim, 1, 0, 0 };
        const pg_linear_type *cholmod = pg_linear_find ("cholmod");
        double *b = draw (&s), *x = pg_calloc (s.ndof, sizeof *x), *y = pg_calloc (s.ndof, sizeof *y);
        void *factor = NULL;
        check_ok (cholmod->analyse (&factor, &A, &o));
        check_ok (cholmod->factor (factor, &A));
        check_ok (cholmod->solve (factor, 1, b, y));
        size_t used = solve_with (&s, &setting, b, x);
        print_message ("%d-D, %d unknowns a point, %zu points%s%s: %zu iterations, misfit %.1e\n", s.dim,
                       s.block, s.n, rules[k].shake > 0 ? ", shaken" : "", rules[k].cut ? ", cut" : "", used,
                       misfit_to (x, y, s.ndof));
        check_below (misfit_to (x, y, s.ndof), 1e-8);
        assert_true (used <= 25);
        cholmod->free (&factor);
        pg_sparse_clear (&A);
        pg_free (b), pg_free (x), pg_free (y);
        springs_free (&s);
    }
}

static void it_is_symmetric (void **state)
{
    (void) state;
    static const springs_rule rules[] = { { 2, 2, { 60, 60 }, 0.2, 3.015, round_notch, held_below },
                                          { 3, 3, { 12, 13, 14 }, 0, 2.1, NULL, held_below },
                                          { 2, 2, { 120, 120 }, 0, 3.015, NULL, held_below },
                                          { 2, 2, { 60, 60 }, 0, 3.015, NULL, held_and_rolling } };
    for (size_t k = 0; k < sizeof rules / sizeof *rules; k++) {
        springs s = springs_of (&rules[k]);
        pg_multilevel_setting setting = springs_setting (&s, 1);
        pg_multilevel *m = NULL;
        double *x = draw (&s), *y = draw (&s), *Mx = pg_calloc (s.ndof, sizeof *x),
               *My = pg_calloc (s.ndof, sizeof *x), xMy = 0, yMx = 0, xMx = 0, yMy = 0;
        check_ok (pg_multilevel_create (&m, &setting));
        pg_preconditioner P = pg_multilevel_preconditioner (m);
        check_ok (P.solve (P.context, x, Mx));
        check_ok (P.solve (P.context, y, My));
        for (size_t i = 0; i < s.ndof; i++)
            xMy += x[i] * My[i], yMx += y[i] * Mx[i], xMx += x[i] * Mx[i], yMy += y[i] * My[i];
        check_below (fabs (xMy - yMx) / sqrt (xMx * yMy), 1e-12);
        assert_true (xMx > 0 && yMy > 0);
        for (size_t i = 0; i < s.ndof; i++) if (s.fixed[i]) assert_true (Mx[i] == 0);
        pg_multilevel_free (&m);
        pg_free (x), pg_free (y), pg_free (Mx), pg_free (My);
        springs_free (&s);
    }
}

static void iterations_hardly_grow_with_size (void **state)
{
    (void) state;
    size_t used[3];
    for (int k = 0; k < 3; k++)
        used[k] = iterations (
            &(springs_rule){ 2, 2, { (size_t) 50 << k, (size_t) 50 << k }, 0, 3.015, NULL, held_below });
    print_message ("50, 100, 200 points along an edge: %zu, %zu, %zu iterations\n", used[0], used[1],
                   used[2]);
    assert_true (used[2] <= 16 && (double) used[2] <= 1.3 * (double) used[0] + 1);
    size_t small = iterations (&(springs_rule){ 3, 3, { 10, 10, 10 }, 0, 2.1, NULL, held_below }),
           large = iterations (&(springs_rule){ 3, 3, { 24, 24, 24 }, 0, 2.1, NULL, held_below });
    print_message ("10 and 24 in 3D: %zu, %zu iterations\n", small, large);
    assert_true (large <= 20 && (double) large <= 1.3 * (double) small + 1);
}

/* A crack through half of the body, or all of it with both parts held: the coarse functions open with it. */
static void cuts_cost_little (void **state)
{
    (void) state;
    size_t whole = iterations (&(springs_rule) { 2, 2, { 60, 60 }, 0, 3.015, NULL, held_both });
    size_t notched = iterations (&(springs_rule) { 2, 2, { 60, 60 }, 0, 3.015, round_notch, held_both });
    size_t cut = iterations (&(springs_rule) { 2, 2, { 60, 60 }, 0, 3.015, over_cut, held_both });
    print_message ("whole %zu, notched %zu, cut %zu iterations\n", whole, notched, cut);
    assert_true (notched <= whole + 4 && cut <= whole + 4);
    springs s = springs_of (&(springs_rule) { 2, 2, { 60, 60 }, 0, 3.015, over_cut, held_both });
    pg_multilevel_setting setting = springs_setting (&s, 1);
    pg_multilevel *m = NULL;
    pg_multilevel_info info;
    check_ok (pg_multilevel_create (&m, &setting));
    pg_multilevel_describe (m, &info);
    assert_true (info.split >= 15 && info.levels >= 2 && info.unknowns[0] == s.ndof);
    pg_multilevel_free (&m);
    springs_free (&s);
}

/* Springs die after the preconditioner was made: the old one still converges, a new one faster. */
static void an_old_one_serves_after_a_break (void **state)
{
    (void) state;
    springs s = springs_of (&(springs_rule) { 2, 2, { 60, 60 }, 0, 3.015, NULL, held_both });
    springs broken = springs_of (&(springs_rule) { 2, 2, { 60, 60 }, 0, 3.015, round_notch, held_both });
    pg_multilevel_setting setting = springs_setting (&s, 1), fresh = springs_setting (&broken, 1);
    pg_multilevel *m = NULL;
    double *b = draw (&broken), *x = pg_calloc (s.ndof, sizeof *x), *y = pg_calloc (s.ndof, sizeof *y);
    size_t used = 0, best = solve_with (&broken, &fresh, b, y);
    check_ok (pg_multilevel_create (&m, &setting));
    s.op.context = &broken;                            /* A of the old one is that of the broken body now */
    pg_preconditioner P = pg_multilevel_preconditioner (m);
    pg_operator op = { s.ndof, &broken, springs_apply_free, springs_diagonal };
    check_ok (pg_conjugate_gradients_with (&op, &P, b, x, 1e-10, 500, &used));
    print_message ("notched later: %zu iterations by the old preconditioner, %zu by a new one\n", used, best);
    check_below (misfit_to (x, y, s.ndof), 1e-7);
    assert_true (used > best);
    pg_multilevel_free (&m);
    pg_free (b), pg_free (x), pg_free (y);
    springs_free (&s), springs_free (&broken);
}

static int held_left (const double *x) { return x[0] < 1.5; }
/* One part hangs free, pulled by two opposite forces, one point has no spring at all: both stay about where
 * they are. */
static int around_one (const double *a, const double *b)
{
    int alone = (fabs (a[0] - 10) < 0.1 && fabs (a[1] - 10) < 0.1)
                || (fabs (b[0] - 10) < 0.1 && fabs (b[1] - 10) < 0.1);
    return alone || over_cut (a, b);
}

static void loose_parts_stay_put (void **state)
{
    (void) state;
    springs s = springs_of (&(springs_rule) { 2, 2, { 60, 60 }, 0, 3.015, around_one, held_left });
    pg_multilevel_setting setting = springs_setting (&s, 1);
    double *b = draw (&s), *x = pg_calloc (s.ndof, sizeof *x), top = 0, loose = 0;
    for (size_t i = 0; i < s.n; i++)
        if (s.x[2 * i] > 29.3 || (fabs (s.x[2 * i] - 10) < 0.1 && fabs (s.x[2 * i + 1] - 10) < 0.1))
            b[2 * i] = b[2 * i + 1] = 0;
    b[2 * (50 + 60 * 30)] = 1, b[2 * (55 + 60 * 30)] = -1;
    assert_true (solve_with (&s, &setting, b, x) <= 30);
    for (size_t i = 0; i < s.n; i++) {
        double u = hypot (x[2*i], x[2*i + 1]);
        if (s.x[2*i] > 29.3) loose = fmax (loose, u);
        else top = fmax (top, u);
    }
    print_message ("loose part moves %.1e of the held one\n", loose / top);
    check_below (loose / top, 0.1);
    assert_true (x[2 * 610] == 0 && x[2 * 610 + 1] == 0);
    pg_free (b), pg_free (x);
    springs_free (&s);
}

static void threads_do_not_change_a_bit (void **state)
{
    (void) state;
    springs s = springs_of (&(springs_rule) { 2, 2, { 150, 150 }, 0.1, 3.015, round_notch, held_below });
    double *b = draw (&s), *x = pg_calloc (s.ndof, sizeof *x), *y = pg_calloc (s.ndof, sizeof *y);
    for (int threads = 1; threads <= 5; threads += 2) {
        pg_multilevel_setting setting = springs_setting (&s, threads);
        solve_with (&s, &setting, b, threads == 1 ? y : x);
        if (threads > 1) assert_memory_equal (x, y, s.ndof * sizeof *x);
    }
    pg_free (b), pg_free (x), pg_free (y);
    springs_free (&s);
}

static void cells_that_are_alike_are_summed_once (void **state)
{
    (void) state;
    static const springs_rule rules[] = { { 2, 2, { 64, 51 }, 0, 3.015, round_notch, held_below },
                                          { 3, 3, { 20, 17, 19 }, 0, 2.1, NULL, held_below } };
    for (size_t k = 0; k < sizeof rules / sizeof *rules; k++) {
        springs s = springs_of (&rules[k]);
        double *b = draw (&s), *x = pg_calloc (s.ndof, sizeof *x), *y = pg_calloc (s.ndof, sizeof *y);
        for (int alike = 0; alike < 2; alike++) {
            pg_multilevel_setting setting = springs_setting (&s, 2);
            for (int d = 0; d < s.dim; d++) setting.rows.lattice[d] = 1;
            setting.rows.alike = alike ? springs_whole : NULL;
            pg_multilevel *m = NULL;
            check_ok (pg_multilevel_create (&m, &setting));
            pg_preconditioner P = pg_multilevel_preconditioner (m);
            check_ok (P.solve (P.context, b, alike ? y : x));
            pg_multilevel_free (&m);
        }
        check_below (misfit_to (x, y, s.ndof), 1e-13);
        pg_free (b), pg_free (x), pg_free (y);
        springs_free (&s);
    }
}

static void wrong_settings_are_told (void **state)
{
    (void) state;
    springs s = springs_of (&(springs_rule) { 2, 2, { 30, 30 }, 0, 3.015, NULL, held_below });
    pg_multilevel_setting setting = springs_setting (&s, 1), wrong = setting;
    pg_multilevel *m = NULL;
    wrong.block = 7;
    check_fails (pg_multilevel_create (&m, &wrong), PG_E_USAGE);
    check_contains (pg_last_error (), "7 unknowns");
    wrong = setting, wrong.dim = 0;
    check_fails (pg_multilevel_create (&m, &wrong), PG_E_USAGE);
    check_contains (pg_last_error (), "0 dimensions");
    wrong = setting, wrong.rows.reach = 0;
    check_fails (pg_multilevel_create (&m, &wrong), PG_E_USAGE);
    check_contains (pg_last_error (), "reach");
    wrong = setting, wrong.rows.reach = 1, wrong.step = 1.5;            /* springs go further than they say */
    check_fails (pg_multilevel_create (&m, &wrong), PG_E_USAGE);
    check_contains (pg_last_error (), "reach");
    assert_null (m);
    springs_free (&s);
}

static void memory_that_runs_out (void **state)
{
    (void) state;
    springs s = springs_of (&(springs_rule) { 2, 2, { 36, 36 }, 0, 3.015, NULL, held_below });
    pg_multilevel_setting setting = springs_setting (&s, 2);
    for (int d = 0; d < 2; d++) setting.rows.lattice[d] = 1;
    setting.rows.alike = springs_whole;
    size_t before = pg_memory_used (), k = 1;
    for (pg_status now = PG_E_MEMORY; now != PG_OK; k++) {
        pg_multilevel *m = NULL;
        pg_memory_fail_at (k);
        now = pg_multilevel_create (&m, &setting);
        pg_memory_fail_at (0);
        if (now != PG_OK) {
            assert_int_equal (now, PG_E_MEMORY);
            assert_null (m);
        }
        pg_multilevel_free (&m);
        assert_int_equal (pg_memory_used (), before);
        assert_true (k < 1000);
    }
    assert_true (k > 40);
    springs_free (&s);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (answers_are_those_of_the_factor),
        cmocka_unit_test (it_is_symmetric),
        cmocka_unit_test (iterations_hardly_grow_with_size),
        cmocka_unit_test (cuts_cost_little),
        cmocka_unit_test (an_old_one_serves_after_a_break),
        cmocka_unit_test (loose_parts_stay_put),
        cmocka_unit_test (threads_do_not_change_a_bit),
        cmocka_unit_test (cells_that_are_alike_are_summed_once),
        cmocka_unit_test (wrong_settings_are_told),
        cmocka_unit_test (memory_that_runs_out),
    };
    return cmocka_run_group_tests_name ("linalg/multilevel", tests, NULL, NULL);
}

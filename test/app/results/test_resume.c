/* SPDX-License-Identifier: GPL-3.0-or-later
 * Going on from a checkpoint: from every break round and every step of small runs the files come out as if
 * nothing had happened; what was written after the checkpoint is cut off; a disk that is full for a while. */
#include "again.h"
#include "io/picture/fonts.h"
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

static void same_file (const char *a, const char *b, const char *name)
{
    char path[256], command[700];
    snprintf (path, sizeof path, "%s", inside (a, name));
    snprintf (command, sizeof command, "cmp %s %s", path, inside (b, name));
    assert_int_equal (system (command), 0);
}

/* What comes before the times of the run, without the lines that tell times of parts. */
static void cut_times (char *report)
{
    char *all = strstr (report, "\"seconds\": {");
    assert_non_null (all);
    all[0] = 0;
    for (char *at = report; (at = strstr (at, "\"seconds")) != NULL; at++)
        memmove (at, at + strcspn (at, "\n"), strlen (at + strcspn (at, "\n")) + 1);
}

static void same_report (const char *a, const char *b)
{
    char *one = slurp (inside (a, "report.json")), *other = slurp (inside (b, "report.json"));
    cut_times (one), cut_times (other);
    assert_string_equal (one, other);
    pg_free (one), pg_free (other);
}

static void same_files (const char *a, const char *b)
{
    same_file (a, b, "history.csv"), same_file (a, b, "events.csv"), same_file (a, b, "result.e");
    if (size_of (inside (a, "cracks.csv")) > 0) same_file (a, b, "cracks.csv");
    if (size_of (inside (a, "tips.csv")) > 0) same_file (a, b, "tips.csv");
    if (size_of (inside (a, "fronts.csv")) > 0) same_file (a, b, "fronts.csv");
    same_report (a, b);
    assert_int_equal (size_of (inside (b, "checkpoint.nc")), -1);
}

static void from_moment (const char *text, const char *plain, const char *where, long *within)
{
    run r;
    visit v;
    pg_resumed from;
    check_ok (resume (text, where, &r, &v, &from));
    *within += from.rounds > 0;
    assert_int_equal (from.step, r.state->step);
    assert_int_equal (go (&r, &v), 0);
    pg_result_free (&v.result);
    clear (&r);
    same_files (plain, where);
}

/* From the end of the first three steps, and from every moment; short: of the first where moments lie within
 * steps, and from two more moments or three (one), spread over the run. */
static void from_every_moment (int i)
{
    const char *text = scenes[i].text;
    char plain[64], where[64];
    long within = 0, moments = 0, looks;
    make_folder (plain), make_folder (where);
    assert_int_equal (stop_after (text, plain, 0, &looks), 0);
    for (long k = 1; k <= (longer () ? 3 : !scenes[i].whole) && stop_at (text, where, -k); k++)
        from_moment (text, plain, where, &within);
    assert_int_equal (within, 0);
    /* of bodies in space, whose moments cost most, and of the facets of events one */
    const int one = !longer () && (i == 8 || i == 6);
    long stride = longer () || looks < 4 ? 1 : one ? looks : looks / 2;
    for (long k = longer () ? 1 : 1 + stride / 2; stop_at (text, where, k); k += stride, moments++)
        from_moment (text, plain, where, &within);
    assert_true (moments > (longer () ? 3 : !one) && (within == 0) == scenes[i].whole);
    remove_folder (plain), remove_folder (where);
}
static void from_every_event (void **state) { (void) state; from_every_moment (0); }
static void from_every_round_of_load_steps (void **state) { (void) state; from_every_moment (1); }
static void from_every_round_with_elimination (void **state) { (void) state; from_every_moment (2); }
static void from_every_round_of_nodal_integration (void **state) { (void) state; from_every_moment (3); }
static void from_every_round_of_time_steps (void **state) { (void) state; from_every_moment (4); }
static void from_every_event_with_an_old_preconditioner (void **state)
{
    (void) state;
    from_every_moment (5);
}
static void from_every_facet (void **state) { (void) state; from_every_moment (6); }
static void from_every_round_of_facets (void **state) { (void) state; from_every_moment (7); }
static void from_every_step_of_a_front (void **state) { (void) state; from_every_moment (8); }
static void from_every_wing (void **state) { (void) state; from_every_moment (9); }
/* PERIGAL_TEST_SIZE=long. */
static void from_every_round_of_wings (void **state) { (void) state; if (longer ()) from_every_moment (10); }
static void from_every_stretch_of_confined_wings (void **state) { (void) state; from_every_moment (11); }
static void from_every_step_between_platens (void **state) { (void) state; from_every_moment (12); }
static void from_every_round_of_drying (void **state) { (void) state; from_every_moment (13); }

/* ---- stages, full disks -------------------------------------------------------------------------------- */
static void stages_within_a_step_ascend_in_time (void **state)
{
    (void) state;
    char where[64];
    pg_cloud cloud = { 0 };
    size_t n, within = 0;
    double *time;
    make_folder (where);
    assert_int_equal (stop_at (scenes[1].text, where, 0), 0);
    check_ok (pg_exodus_points (inside (where, "result.e"), &cloud, &n, &time));
    for (size_t k = 0; k < n; k++) {
        assert_true (time[k] > 0 && time[k] <= 1 && (k == 0 || time[k] > time[k - 1]));
        within += fabs (3 * time[k] - round (3 * time[k])) > 1e-9;
    }
    assert_true (within >= 3);
    char *text = slurp (inside (where, "history.csv"));
    assert_int_equal (count_lines (text), 4);
    pg_free (text), pg_free (time);
    pg_cloud_clear (&cloud);
    remove_folder (where);
}

/* Files may grow to `limit` bytes; the first failure is kept. */
static pg_status go_on_a_small_disk (run *r, visit *v, long limit)
{
    struct rlimit old, tight;
    pg_status status = PG_OK;
    getrlimit (RLIMIT_FSIZE, &old);
    tight = (struct rlimit) { (rlim_t) limit, old.rlim_max };
    setrlimit (RLIMIT_FSIZE, &tight);
    v->state = r->state;
    pg_solver_watch (r->solver, look, v);
    while (status == PG_OK && !pg_solver_done (r->solver, r->state)) {
        status = pg_solver_step (r->solver, r->state, &r->step);
        if (status == PG_OK) status = pg_result_step (v->result, r->state, &r->step);
    }
    setrlimit (RLIMIT_FSIZE, &old);
    return status;
}

/* Wherever the disk is full first - a table, a stage, fields at the end of a step - a checkpoint then goes on
 * to the same files. */
static void a_disk_that_was_full_costs_nothing (void **state)
{
    (void) state;
    char plain[64], where[64];
    make_folder (plain), make_folder (where);
    signal (SIGXFSZ, SIG_IGN);
    for (int i = 0; i < 2; i++) {
        assert_int_equal (stop_at (scenes[i].text, plain, 0), 0);
        long most = size_of (inside (plain, "result.e")), failed = 0;
        for (long limit = 1500; limit < most; limit += most / (longer () ? 7 : 5)) {
            run r = prepare (1, scenes[i].text);
            visit v = { 0 };
            pg_resumed from;
            check_ok (pg_result_open (&v.result, where, r.scene, r.problem, r.solver));
            check_fails (go_on_a_small_disk (&r, &v, limit), PG_E_FILE);
            check_contains (pg_last_error (), "File too large");
            if (r.state->step > 0 || r.state->broken > 0) {
                failed++;
                check_ok (pg_result_checkpoint (v.result, r.state));
                pg_result_free (&v.result);
                clear (&r);
                check_ok (resume (scenes[i].text, where, &r, &v, &from));
                assert_int_equal (go (&r, &v), 0);
                same_files (plain, where);
            }
            pg_result_free (&v.result);
            clear (&r);
        }
        assert_true (failed > 2);
    }
    remove_folder (plain), remove_folder (where);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (from_every_event),
        cmocka_unit_test (from_every_round_of_load_steps),
        cmocka_unit_test (from_every_round_with_elimination),
        cmocka_unit_test (from_every_round_of_nodal_integration),
        cmocka_unit_test (from_every_round_of_time_steps),
        cmocka_unit_test (from_every_event_with_an_old_preconditioner),
        cmocka_unit_test (from_every_facet),
        cmocka_unit_test (from_every_round_of_facets),
        cmocka_unit_test (from_every_step_of_a_front),
        cmocka_unit_test (from_every_wing),
        cmocka_unit_test (from_every_round_of_wings),
        cmocka_unit_test (from_every_stretch_of_confined_wings),
        cmocka_unit_test (from_every_step_between_platens),
        cmocka_unit_test (from_every_round_of_drying),
        cmocka_unit_test (stages_within_a_step_ascend_in_time),
        cmocka_unit_test (a_disk_that_was_full_costs_nothing),
    };
    return cmocka_run_group_tests_name ("app/results/resume", tests, NULL, NULL);
}

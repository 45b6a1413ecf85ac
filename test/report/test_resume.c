/* SPDX-License-Identifier: GPL-3.0-or-later
 * Going on from a checkpoint: from every break round and every step of small runs the files come out as if nothing had happened; what
 * was written after the checkpoint is cut off; checkpoints of other scenes, points or versions are refused; a disk that is full for a while. */
#include "folder.h"
#include "output/fonts.h"
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#define BODY "dimension: 2\nthickness: 0.1\nbody: [{add: {box: {low: [0, 0], high: [0.6, 0.5]}}}]\nspacing: 0.1\n" \
    "cracks: [{from: [-0.1, 0.25], to: [0.15, 0.25]}]\nmaterials: {rock: {youngs_modulus: 1 GPa, poissons_ratio: 0.2, density: 2000}}\n" \
    "failure: {criterion: stretch, critical_stretch: 1e-3, exclude: [bottom, top]}\n"
#define PULL "boundary: [{name: foot, set: bottom, displacement: {x: 0, y: 0}}, {name: head, set: top, displacement: {y: 2 mm}}]\n"
static const struct { const char *name, *text; } scenes[] = {
    { "event", BODY PULL "solver: {stepping: event}\noutput: {pictures: [], at: {levels: 4, events: 3, broken: 10 %}}\n" },
    { "fixed", BODY PULL "solver: {stepping: fixed, steps: 3}\noutput: {pictures: [], at: {levels: 2, broken: 4 %}}\n" },
    { "transformation", BODY PULL "method: {essential: transformation}\nsolver: {stepping: fixed, steps: 3, stop: {set: right}}\noutput: {pictures: [], at: {broken: 4 %}}\n" },
    { "nodal", BODY PULL "method: {approximation: nosb, integration: nodal, horizon: 2.5 spacing, essential: penalty}\n"
      "solver: {stepping: fixed, steps: 3, break: fraction, break_fraction: 5 %}\noutput: {pictures: [], at: {broken: 4 %}}\n" },
    { "newmark", BODY "boundary: [{set: bottom, velocity: {x: 0, y: -4 m/s}}, {set: top, velocity: {y: 4 m/s}, table: [[0, 0], [1e-3, 1]]}]\n"
      "method: {essential: transformation}\nsolver: {kind: newmark, dt: 0.1 ms, end: 1 ms, rayleigh: {stiffness: 1 us}, break: fraction, break_fraction: 5 %}\n"
      "output: {pictures: [], at: {levels: 5, broken: 4 %}}\n" },
    { "multilevel", "dimension: 2\nthickness: 0.1\nbody: [{add: {box: {low: [0, 0], high: [0.8, 0.9]}}}]\nspacing: 0.1\n"
      "materials: {rock: {youngs_modulus: 1e9, poissons_ratio: 0.3333, density: 2500}}\ncracks: [{from: [-0.1, 0.45], to: [0.22, 0.45]}]\n"
      "failure: {criterion: stretch, critical_stretch: 1e-3, exclude: [bottom, top]}\nmethod: {force: bond}\n" PULL
      "solver: {stepping: event, linear: pcg, max_events: 16}\noutput: {at: {levels: 4, broken: 2 %}, pictures: []}\n" },
};
enum { SCENES = sizeof scenes / sizeof *scenes };

/* left: looks until it stops; negative: it stops after this step */
typedef struct { pg_result *result; pg_state *state; long left; int within; } visit;

static pg_status look (void *context, const pg_state *state, const pg_step *so_far)
{
    visit *v = context;
    pg_status status = pg_result_stage (v->result, state, so_far);
    if (status == PG_OK && v->left > 0 && --v->left == 0) v->within = 1, status = pg_error (PG_E_INTERRUPTED, PG_HERE, "a test");
    return status;
}

/* Steps until it is done or the `left`-th look at it (between rounds, after steps). 1: it was stopped. */
static int go (run *r, visit *v)
{
    v->state = r->state, v->within = 0;
    pg_solver_watch (r->solver, look, v);
    while (!pg_solver_done (r->solver, r->state)) {
        pg_status status = pg_solver_step (r->solver, r->state, &r->step);
        if (v->within) return 1;
        check_ok (status);
        check_ok (pg_result_step (v->result, r->state, &r->step));
        if (v->left == -r->state->step || (v->left > 0 && --v->left == 0)) return 1;
    }
    check_ok (pg_result_finish (v->result, r->state, NULL, 0, 0));
    return 0;
}

static void same_file (const char *a, const char *b, const char *name)
{
    char path[256], command[700];
    snprintf (path, sizeof path, "%s", inside (a, name));
    snprintf (command, sizeof command, "cmp %s %s", path, inside (b, name));
    assert_int_equal (system (command), 0);
}

/* Counts of report.json: what comes before its times. */
static void same_report (const char *a, const char *b)
{
    char *one = slurp (inside (a, "report.json")), *other = slurp (inside (b, "report.json"));
    strstr (one, "\"seconds\"")[0] = 0, strstr (other, "\"seconds\"")[0] = 0;
    assert_string_equal (one, other);
    pg_free (one), pg_free (other);
}

static void same_files (const char *a, const char *b)
{
    same_file (a, b, "history.csv"), same_file (a, b, "events.csv"), same_file (a, b, "result.e");
    same_report (a, b);
    assert_int_equal (size_of (inside (b, "checkpoint.nc")), -1);
}

/* Stops at the k-th look, leaves a checkpoint and a little more than it knows of. 0: the run was over before. */
static int stop_at (const char *text, const char *where, long k)
{
    run r = prepare (1, text);
    visit v = { .left = k };
    check_ok (pg_result_discard (where));
    check_ok (pg_result_open (&v.result, where, r.scene, r.problem, r.solver));
    int stopped = go (&r, &v);
    if (stopped) {
        check_ok (pg_result_checkpoint (v.result, r.state));
        check_ok (pg_result_finish (v.result, r.state, "stopped", 0, 0));
    }
    pg_result_free (&v.result);
    clear (&r);
    return stopped;
}

static pg_status resume (const char *text, const char *where, run *r, visit *v, pg_resumed *from)
{
    *r = prepare (1, text);
    *v = (visit) { 0 };
    return pg_result_resume (&v->result, where, r->scene, r->problem, r->solver, r->state, from);
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

/* From the end of the first three steps, and from every moment (long), else from some. */
static void from_every_moment (int i, long some)
{
    const char *size = getenv ("PERIGAL_TEST_SIZE"), *text = scenes[i].text;
    char plain[64], where[64];
    long stride = size && strcmp (size, "long") == 0 ? 1 : some, within = 0, moments = 0;
    make_folder (plain), make_folder (where);
    assert_int_equal (stop_at (text, plain, 0), 0);
    for (long k = 1; k <= 3 && stop_at (text, where, -k); k++) from_moment (text, plain, where, &within);
    assert_int_equal (within, 0);
    for (long k = 1; stop_at (text, where, k); k += stride, moments++) from_moment (text, plain, where, &within);
    assert_true (moments > 3 && (within == 0) == (i == 0 || i == 5));            /* an event is a step of its own                   */
    remove_folder (plain), remove_folder (where);
}
static void from_every_event (void **state) { (void) state; from_every_moment (0, 5); }
static void from_every_round_of_load_steps (void **state) { (void) state; from_every_moment (1, 7); }
static void from_every_round_with_elimination (void **state) { (void) state; from_every_moment (2, 9); }
static void from_every_round_of_nodal_integration (void **state) { (void) state; from_every_moment (3, 5); }
static void from_every_round_of_time_steps (void **state) { (void) state; from_every_moment (4, 13); }
static void from_every_event_with_an_old_preconditioner (void **state) { (void) state; from_every_moment (5, 5); }

/* ---- what does not fit ------------------------------------------------------------------------------------------------------ */
static void refused (const char *text, const char *where, const char *why)
{
    run r;
    visit v;
    pg_resumed from;
    long before = size_of (inside (where, "history.csv"));
    check_fails (resume (text, where, &r, &v, &from), PG_E_USAGE);
    check_contains (pg_last_error (), why);
    assert_null (v.result);
    assert_int_equal (size_of (inside (where, "history.csv")), before);
    clear (&r);
}

static void what_is_not_of_this_run_is_refused (void **state)
{
    (void) state;
    char where[64], changed[2048];
    make_folder (where);
    refused (scenes[1].text, where, "there is no");
    assert_int_equal (stop_at (scenes[1].text, where, 5), 1);
    snprintf (changed, sizeof changed, "title: another\n%s", scenes[1].text);
    refused (changed, where, "is of another scene");
    remove_folder (where);
}

static void write_file (const char *path, const char *head, double volume, const char *tail)
{
    FILE *f = fopen (path, "w");
    assert_non_null (f);
    fputs (head, f);
    for (int i = 0; volume > 0 && i < 42; i++) fprintf (f, "%g,%g,%.17g,0\n", 0.1 * (i % 7), 0.1 * (i / 7), (i == 17 ? volume : 1) * 1e-3);
    fputs (tail, f);
    assert_int_equal (fclose (f), 0);
}

/* Points and tables in files beside the scene: another volume at one point, another value, refuse the checkpoint and name the file. */
static void files_of_the_scene_are_part_of_it (void **state)
{
    (void) state;
    static const char scene[] = "dimension: 2\nthickness: 0.1\npoints: points.csv\nmaterials: {rock: {youngs_modulus: 1 GPa, poissons_ratio: 0.2}}\n"
        "failure: {criterion: stretch, critical_stretch: 1e-3}\nmethod: {force: bond}\nsets: {low: {where: y < 0.15}, high: {where: y > 0.35}}\n"
        "boundary: [{name: foot, set: low, displacement: {x: 0, y: 0}}, {name: head, set: high, displacement: {y: 2 mm}}]\n"
        "reference: {lines: [{file: line.csv}]}\nsolver: {stepping: fixed, steps: 6}\noutput: {pictures: []}\n";
    static const char *const wrong[] = { "points.csv (points of the scene) has changed", "line.csv (reference.lines[0].file of the scene) has changed" };
    char beside[64], where[64], path[3][128], whole[4200];
    pg_resumed from;
    make_folder (beside), make_folder (where);
    for (int k = 0; k < 3; k++) snprintf (path[k], sizeof path[k], "%s/%s", beside, k == 0 ? "points.csv" : k == 1 ? "line.csv" : "scene.yaml");
    write_file (path[0], "x,y,volume,block\n", 1, ""), write_file (path[1], "x [m],y [m],u_y [m]\n0.3,0.2,1e-3\n", 0, ""), write_file (path[2], scene, 0, "");
    run r = loaded (path[2], 0, NULL);
    visit v = { .left = -2 };
    check_ok (pg_result_open (&v.result, where, r.scene, r.problem, r.solver));
    assert_int_equal (go (&r, &v), 1);
    check_ok (pg_result_checkpoint (v.result, r.state));
    pg_result_free (&v.result);
    clear (&r);
    for (int k = 0; k < 3; k++) {
        if (k == 0) write_file (path[0], "x,y,volume,block\n", 1.5, "");
        if (k == 1) write_file (path[0], "x,y,volume,block\n", 1, ""), write_file (path[1], "x [m],y [m],u_y [m]\n0.3,0.2,2e-3\n", 0, "");
        if (k == 2) write_file (path[1], "x [m],y [m],u_y [m]\n0.3,0.2,1e-3\n", 0, "");
        r = loaded (path[2], 0, NULL);
        pg_status status = pg_result_resume (&v.result, where, r.scene, r.problem, r.solver, r.state, &from);
        assert_int_equal (status, k < 2 ? PG_E_USAGE : PG_OK);
        if (k < 2) check_contains (pg_last_error (), wrong[k]);
        else assert_int_equal (go (&r, &v), 0);
        pg_result_free (&v.result);
        clear (&r);
    }
    /* the report tells where they are, and the copy of the scene finds them from anywhere */
    char *text = slurp (inside (where, "report.json"));
    assert_non_null (realpath (path[0], whole));
    check_contains (json_value (text, NULL, "files"), whole);
    pg_free (text);
    pg_scene *stored;
    pg_problem *again;
    remove (inside (where, "report.json"));
    check_ok (pg_stored_scene (&stored, where));
    check_ok (pg_problem_build (&again, stored, 1));
    assert_int_equal (again->cloud.n, 42);
    pg_problem_free (&again);
    pg_scene_free (&stored);
    remove_folder (beside), remove_folder (where);
}

/* Nodes in a file that the mesh includes: the scene does not name it, but the points tell. */
static void points_of_files_that_files_include_are_part_of_it (void **state)
{
    (void) state;
    static const char scene[] = "dimension: 2\nthickness: 0.1\nmesh: {file: mesh.inp}\nmaterials: {rock: {youngs_modulus: 1 GPa, poissons_ratio: 0.2}}\n"
        "boundary: [{set: bottom, displacement: {x: 0, y: 0}}, {set: top, displacement: {y: 2 mm}}]\nsolver: {stepping: fixed, steps: 3}\noutput: {pictures: []}\n";
    char beside[64], where[64], path[3][128], elements[2048] = "*INCLUDE, INPUT=nodes.inp\n*ELEMENT, TYPE=CPS4\n", nodes[2048];
    pg_resumed from;
    make_folder (beside), make_folder (where);
    for (int k = 0; k < 3; k++) snprintf (path[k], sizeof path[k], "%s/%s", beside, k == 0 ? "nodes.inp" : k == 1 ? "mesh.inp" : "scene.yaml");
    for (int e = 0, n = (int) strlen (elements); e < 20; e++) {
        int first = e / 5 * 6 + e % 5 + 1;
        n += snprintf (elements + n, sizeof elements - (size_t) n, "%d, %d, %d, %d, %d\n", e + 1, first, first + 1, first + 7, first + 6);
    }
    write_file (path[1], elements, 0, ""), write_file (path[2], scene, 0, "");
    for (int k = 0; k < 3; k++) {                      /* as it was, one node moved, as it was                            */
        int n = snprintf (nodes, sizeof nodes, "*NODE\n");
        for (int i = 0; i < 30; i++) n += snprintf (nodes + n, sizeof nodes - (size_t) n, "%d, %.17g, %.17g\n", i + 1, 0.1 * (i % 6) + (k == 1 && i == 14 ? 0.01 : 0), 0.1 * (i / 6));
        write_file (path[0], nodes, 0, "");
        run r = loaded (path[2], 0, NULL);
        visit v = { .left = -2 };
        if (k == 0) {
            check_ok (pg_result_open (&v.result, where, r.scene, r.problem, r.solver));
            assert_int_equal (go (&r, &v), 1);
            check_ok (pg_result_checkpoint (v.result, r.state));
        } else {
            pg_status status = pg_result_resume (&v.result, where, r.scene, r.problem, r.solver, r.state, &from);
            assert_int_equal (status, k == 1 ? PG_E_USAGE : PG_OK);
            if (k == 1) check_contains (pg_last_error (), "checkpoint.nc is of other points or bonds (30 points, ");
            else assert_int_equal (go (&r, &v), 0);
        }
        pg_result_free (&v.result);
        clear (&r);
    }
    remove_folder (beside), remove_folder (where);
}

static void finished_is_told_from_interrupted (void **state)
{
    (void) state;
    char where[64];
    make_folder (where);
    run r = prepare (1, scenes[1].text), other = prepare (1, scenes[2].text);
    assert_int_equal (pg_result_finished (where, r.scene), 0);
    assert_int_equal (stop_at (scenes[1].text, where, 5), 1);
    assert_int_equal (pg_result_finished (where, r.scene), 0);
    assert_int_equal (stop_at (scenes[1].text, where, 0), 0);
    assert_int_equal (pg_result_finished (where, r.scene), 1);
    assert_int_equal (pg_result_finished (where, other.scene), 0);
    clear (&r), clear (&other);
    remove_folder (where);
}

static void a_new_run_leaves_no_old_checkpoint_or_report (void **state)
{
    (void) state;
    char where[64];
    pg_result *result = NULL;
    make_folder (where);
    assert_int_equal (stop_at (scenes[1].text, where, 5), 1);
    run r = prepare (1, scenes[2].text);
    long rows = size_of (inside (where, "history.csv")), kept = size_of (inside (where, "checkpoint.nc"));
    check_fails (pg_result_open (&result, where, r.scene, r.problem, r.solver), PG_E_USAGE);
    check_contains (pg_last_error (), "holds a run that is not finished");
    assert_int_equal (size_of (inside (where, "history.csv")), rows);
    assert_int_equal (size_of (inside (where, "checkpoint.nc")), kept);
    check_ok (pg_result_discard (where));
    check_ok (pg_result_open (&result, where, r.scene, r.problem, r.solver));
    assert_int_equal (size_of (inside (where, "checkpoint.nc")), -1);
    assert_int_equal (size_of (inside (where, "report.json")), -1);
    pg_result_free (&result);
    clear (&r);
    remove_folder (where);
}

static void a_file_that_lost_rows_is_refused (void **state)
{
    (void) state;
    char where[64];
    run r;
    visit v;
    pg_resumed from;
    make_folder (where);
    assert_int_equal (stop_at (scenes[0].text, where, 3), 1);
    assert_int_equal (truncate (inside (where, "history.csv"), 400), 0);
    check_fails (resume (scenes[0].text, where, &r, &v, &from), PG_E_FILE);
    check_contains (pg_last_error (), "history.csv has");
    clear (&r);
    remove_folder (where);
}

/* ---- stages, full disks ------------------------------------------------------------------------------------------------------- */
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

/* Wherever the disk is full first - a table, a stage, fields at the end of a step - a checkpoint then goes on to the same files. */
static void a_disk_that_was_full_costs_nothing (void **state)
{
    (void) state;
    char plain[64], where[64];
    make_folder (plain), make_folder (where);
    signal (SIGXFSZ, SIG_IGN);
    for (int i = 0; i < 2; i++) {
        assert_int_equal (stop_at (scenes[i].text, plain, 0), 0);
        long most = size_of (inside (plain, "result.e")), failed = 0;
        for (long limit = 1500; limit < most; limit += most / 7) {
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
        cmocka_unit_test (from_every_event), cmocka_unit_test (from_every_round_of_load_steps), cmocka_unit_test (from_every_round_with_elimination),
        cmocka_unit_test (from_every_round_of_nodal_integration), cmocka_unit_test (from_every_round_of_time_steps), cmocka_unit_test (from_every_event_with_an_old_preconditioner),
        cmocka_unit_test (what_is_not_of_this_run_is_refused), cmocka_unit_test (files_of_the_scene_are_part_of_it), cmocka_unit_test (points_of_files_that_files_include_are_part_of_it),
        cmocka_unit_test (finished_is_told_from_interrupted),
        cmocka_unit_test (a_new_run_leaves_no_old_checkpoint_or_report), cmocka_unit_test (a_file_that_lost_rows_is_refused),
        cmocka_unit_test (stages_within_a_step_ascend_in_time), cmocka_unit_test (a_disk_that_was_full_costs_nothing),
    };
    return cmocka_run_group_tests_name ("report/resume", tests, NULL, NULL);
}

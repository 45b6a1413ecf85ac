/* SPDX-License-Identifier: GPL-3.0-or-later
 * What a run that was stopped leaves behind is not gone on with by another one: another scene, other points,
 * changed files, lost rows; nor written over. */
#include "again.h"
#include <unistd.h>

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
    /* an empty folder is what a run leaves that is killed before its first file; this one holds another's */
    FILE *file = fopen (inside (where, "notes"), "w");
    assert_non_null (file);
    fclose (file);
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
    for (int i = 0; volume > 0 && i < 42; i++)
        fprintf (f, "%g,%g,%.17g,0\n", 0.1 * (i % 7), 0.1 * (i / 7), (i == 17 ? volume : 1) * 1e-3);
    fputs (tail, f);
    assert_int_equal (fclose (f), 0);
}

/* Points and tables in files beside the scene: another volume at one point, another value, refuse the
 * checkpoint and name the file. */
static void files_of_the_scene_are_part_of_it (void **state)
{
    (void) state;
    static const char scene[] = "dimension: 2\nthickness: 0.1\npoints: points.csv\nmaterials: {rock: "
                                "{youngs_modulus: 1 GPa, poissons_ratio: 0.2}}\n"
                                "failure: {criterion: stretch, critical_stretch: 1e-3}\nmethod: {force: "
                                "bond}\nsets: {low: {where: y < 0.15}, high: {where: y > 0.35}}\n"
                                "boundary: [{name: foot, set: low, displacement: {x: 0, y: 0}}, {name: head, "
                                "set: high, displacement: {y: 2 mm}}]\n"
                                "reference: {lines: [{file: line.csv}]}\nsolver: {stepping: fixed, steps: "
                                "6}\noutput: {pictures: []}\n";
    static const char *const wrong[] = { "points.csv (points of the scene) has changed",
                                         "line.csv (reference.lines[0].file of the scene) has changed" };
    char beside[64], where[64], path[3][128], whole[4200];
    pg_resumed from;
    make_folder (beside), make_folder (where);
    for (int k = 0; k < 3; k++)
        snprintf (path[k], sizeof path[k], "%s/%s", beside,
                  k == 0   ? "points.csv"
                  : k == 1 ? "line.csv"
                           : "scene.yaml");
    write_file (path[0], "x,y,volume,block\n", 1, ""),
        write_file (path[1], "x [m],y [m],u_y [m]\n0.3,0.2,1e-3\n", 0, ""),
        write_file (path[2], scene, 0, "");
    run r = loaded (path[2], 0, NULL);
    visit v = { .left = -2 };
    check_ok (pg_result_open (&v.result, where, r.scene, r.problem, r.solver));
    assert_int_equal (go (&r, &v), 1);
    check_ok (pg_result_checkpoint (v.result, r.state));
    pg_result_free (&v.result);
    char *copy = slurp (inside (where, "scene.yaml"));  /* with what the files were */
    check_contains (copy, "\n# with points = ");
    check_contains (copy, "\n# with reference.lines[0].file = ");
    check_contains (strstr (copy, "# with points"), "points.csv, sha256 ");
    pg_free (copy);
    clear (&r);
    for (int k = 0; k < 3; k++) {
        if (k == 0) write_file (path[0], "x,y,volume,block\n", 1.5, "");
        if (k == 1)
            write_file (path[0], "x,y,volume,block\n", 1, ""),
                write_file (path[1], "x [m],y [m],u_y [m]\n0.3,0.2,2e-3\n", 0, "");
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
    static const char scene[] =
        "dimension: 2\nthickness: 0.1\nmesh: {file: mesh.inp}\nmaterials: {rock: {youngs_modulus: 1 GPa, "
        "poissons_ratio: 0.2}}\n"
        "boundary: [{set: bottom, displacement: {x: 0, y: 0}}, {set: top, displacement: {y: 2 mm}}]\nsolver: "
        "{stepping: fixed, steps: 3}\noutput: {pictures: []}\n";
    char beside[64], where[64], path[3][128],
        elements[2048] = "*INCLUDE, INPUT=nodes.inp\n*ELEMENT, TYPE=CPS4\n", nodes[2048];
    pg_resumed from;
    make_folder (beside), make_folder (where);
    for (int k = 0; k < 3; k++)
        snprintf (path[k], sizeof path[k], "%s/%s", beside,
                  k == 0   ? "nodes.inp"
                  : k == 1 ? "mesh.inp"
                           : "scene.yaml");
    for (int e = 0, n = (int) strlen (elements); e < 20; e++) {
        int first = e / 5 * 6 + e % 5 + 1;
        n += snprintf (elements + n, sizeof elements - (size_t) n, "%d, %d, %d, %d, %d\n", e + 1, first,
                       first + 1, first + 7, first + 6);
    }
    write_file (path[1], elements, 0, ""), write_file (path[2], scene, 0, "");
    for (int k = 0; k < 3; k++) {                      /* as it was, one node moved, as it was */
        int n = snprintf (nodes, sizeof nodes, "*NODE\n");
        for (int i = 0; i < 30; i++)
            n += snprintf (nodes + n, sizeof nodes - (size_t) n, "%d, %.17g, %.17g\n", i + 1,
                           0.1 * (i % 6) + (k == 1 && i == 14 ? 1e-10 : 0), 0.1 * (i / 6));
        write_file (path[0], nodes, 0, "");
        run r = loaded (path[2], 0, NULL);
        visit v = { .left = -2 };
        if (k == 0) {
            check_ok (pg_result_open (&v.result, where, r.scene, r.problem, r.solver));
            assert_int_equal (go (&r, &v), 1);
            check_ok (pg_result_checkpoint (v.result, r.state));
        } else {
            pg_status status = pg_result_resume (&v.result, where, r.scene, r.problem, r.solver, r.state,
                                                 &from);
            assert_int_equal (status, k == 1 ? PG_E_USAGE : PG_OK);
            if (k == 1)
                check_contains (pg_last_error (), "checkpoint.nc is of other points or bonds (30 points, ");
            else assert_int_equal (go (&r, &v), 0);
        }
        pg_result_free (&v.result);
        clear (&r);
    }
    remove_folder (beside), remove_folder (where);
}

/* A checkpoint whose checksum is right, but one count of which is not. */
typedef struct {
    const pg_keeper *inner;
    run *r;
    pg_result *result;
    const char *name;
    size_t at;
    long to;
} forger;

static pg_status pass_numbers (void *c, const char *name, size_t n, double *v)
{
    const pg_keeper *k = ((forger *) c)->inner;
    return k->numbers (k->context, name, n, v);
}
static pg_status pass_bytes (void *c, const char *name, size_t n, void *v)
{
    const pg_keeper *k = ((forger *) c)->inner;
    return k->bytes (k->context, name, n, v);
}
static pg_status forge_counts (void *c, const char *name, size_t n, long *v)
{
    const forger *f = c;
    long kept = 0;
    int wrong = strcmp (name, f->name) == 0;
    if (wrong) assert_true (f->at < n), kept = v[f->at], v[f->at] = f->to;
    pg_status status = f->inner->counts (f->inner->context, name, n, v);
    if (wrong) v[f->at] = kept;
    return status;
}
static pg_status forge (void *context, const pg_keeper *k)
{
    forger *f = context;
    const pg_keeper mine = {
        .context = f, .reading = 0, .numbers = pass_numbers, .counts = forge_counts, .bytes = pass_bytes
    };
    f->inner = k;
    return pg_result_keep (f->result, f->r->state, &mine);
}

static void marks_that_cannot_be_are_refused (void **state)
{
    (void) state;
    static const struct { const char *name; size_t at; long to; const char *words;
    } wrong[] = {
        { "none", 0, 0, "" },
        { "now.counts", 0, -1, "now is -1, not from 0" },
        { "now.counts", 6, 1L << 60, "now is 1152921504606846976, not from 0" },
        { "now.counts", 0, 1L << 40, "it was changed since" },
        { "now.counts", 5, 1L << 20, "1048576 points of the curve of" },
        { "done.counts", 5, 1L << 20, "1048576 points of the curve of" },
        { "result.counts", 0, -1, "rounds of a step is -1" },
    };
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        char where[64], path[128];
        run r = prepare (1, scenes[1].text), again;
        visit v = { .left = -1 }, w;
        pg_resumed from;
        make_folder (where);
        snprintf (path, sizeof path, "%s/checkpoint.nc", where);
        check_ok (pg_result_open (&v.result, where, r.scene, r.problem, r.solver));
        assert_int_equal (go (&r, &v), 1);
        forger f = {
            .r = &r, .result = v.result, .name = wrong[k].name, .at = wrong[k].at, .to = wrong[k].to
        };
        check_ok (pg_checkpoint_write (path, forge, &f));
        pg_result_free (&v.result);
        pg_status status = resume (scenes[1].text, where, &again, &w, &from);
        assert_int_equal (status, *wrong[k].words ? PG_E_FILE : PG_OK);
        if (*wrong[k].words) check_contains (pg_last_error (), wrong[k].words);
        pg_result_free (&w.result);
        clear (&r), clear (&again);
        remove_folder (where);
    }
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
    check_contains (pg_last_error (), "holds an unfinished run");
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

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (what_is_not_of_this_run_is_refused),
        cmocka_unit_test (files_of_the_scene_are_part_of_it),
        cmocka_unit_test (points_of_files_that_files_include_are_part_of_it),
        cmocka_unit_test (marks_that_cannot_be_are_refused),
        cmocka_unit_test (finished_is_told_from_interrupted),
        cmocka_unit_test (a_new_run_leaves_no_old_checkpoint_or_report),
        cmocka_unit_test (a_file_that_lost_rows_is_refused),
    };
    return cmocka_run_group_tests_name ("app/results/stopped", tests, NULL, NULL);
}

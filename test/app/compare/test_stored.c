/* SPDX-License-Identifier: GPL-3.0-or-later
 * Result folders opened again: their fields are those of the run that wrote them, by its own shape functions;
 * least squares where that cannot be; --set options, files beside the scene, damage. */
#include "app/results/folder.h"
#include <unistd.h>

static char folder[64], path[160];

/* Runs a scene into FOLDER/name; the run stays open. */
static run made (const char *name, const char *text, size_t nset, const char *const *set)
{
    run r = { 0 };
    pg_result *result = NULL;
    check_ok (pg_scene_parse_with (&r.scene, text, inside (folder, "scene_of_user.yaml"), nset, set));
    check_ok (pg_problem_build (&r.problem, r.scene, 1));
    check_ok (pg_solver_options_read (&r.options, r.problem, r.scene));
    check_ok (pg_solver_create (&r.solver, r.problem, &r.options));
    check_ok (pg_state_create (&r.state, r.problem, pg_solver_components (r.solver)));
    snprintf (path, sizeof path, "%s/%s", folder, name);
    check_ok (pg_result_open (&result, path, r.scene, r.problem, r.solver));
    while (!pg_solver_done (r.solver, r.state)) {
        advance (&r);
        check_ok (pg_result_step (result, r.state, &r.step));
    }
    check_ok (pg_result_finish (result, r.state, NULL, 0, 0));
    pg_result_free (&result);
    return r;
}

#define PLATE \
    "dimension: 2\nbody: [{add: {box: {low: [0, 0], high: [1, 0.8]}}}]\nspacing: 0.1\nperturb: {amount: " \
    "0.1}\n" \
    "materials: {rock: {youngs_modulus: 10 GPa, poissons_ratio: 0.25}}\nmethod: {approximation: rkpm, " \
    "horizon: 2.2 spacing}\n" \
    "boundary:\n  - {set: bottom, displacement: {x: 0, y: 0}}\n  - {set: top, displacement: {x: 0.2 mm, y: " \
    "1 mm}}\n"

static double difference (const run *r, pg_stored *s, double *stress_off)
{
    enum { N = 300 };
    double x[2*N], u[3*N], v[3*N], a[6*N], b[6*N];
    void *self;
    const pg_force_type *force = pg_solver_force (r->solver, &self);
    for (size_t i = 0; i < N; i++)
        x[2 * i] = (double) (i * 37 % N) / N, x[2 * i + 1] = 0.8 * (double) (i * 113 % N) / N;
    check_ok (force->sample (self, r->state, r->state->d, N, x, u, a, NULL));
    check_ok (s->sampler.sample (s->sampler.context, N, x, v, b));
    *stress_off = largest_difference (a, b, 6*N) / largest_of (a, 6*N);
    return largest_difference (u, v, 3*N) / largest_of (u, 3*N);
}

static void a_folder_gives_its_run_back (void **state)
{
    (void) state;
    static const char *const set[] = { "method.basis=quadratic", "method.horizon=3.01 spacing" };
    static const char *const nosb[] = { "method.approximation=nosb", "method.integration=nodal" };
    for (int k = 0; k < 3; k++) {
        run r = made ("run",
                      PLATE "solver: {stepping: fixed, steps: 4}\noutput: {at: {levels: 4}, pictures: []}\n# "
                            "--set spacing=5\nreference: {displacement: {x: 0.2 mm}}\n",
                      k ? 2 : 0, k == 1 ? set : nosb);
        pg_stored *s = NULL;
        double stress;
        check_ok (pg_stored_open (&s, path, -1, 1));
        assert_int_equal (s->step, 3);
        assert_true (s->t == 1 && s->problem->form.approx.order == r.problem->form.approx.order);
        assert_string_equal (pg_scene_hash (s->scene), pg_scene_hash (r.scene));
        assert_string_equal (s->how, "by its own shape functions");
        check_below (difference (&r, s, &stress), 1e-14);
        check_below (stress, 1e-12);
        double out[3], far[2] = { 1.3, 0.4 };
        check_ok (s->sampler.sample (s->sampler.context, 1, far, out, NULL));
        assert_true (isnan (out[0]));                  /* the body ends at x = 1 */
        pg_stored_free (&s);
        check_ok (pg_stored_open (&s, path, 1, 1));
        check_relative (s->t, 0.5, 1e-14);
        for (size_t i = 0; i < r.state->ndof; i++)
            check_scaled (s->state->d[i], 0.5 * r.state->d[i], 1e-12, 1e-3);
        pg_stored_free (&s);
        check_fails (pg_stored_open (&s, path, 7, 1), PG_E_USAGE);
        check_contains (pg_last_error (), "has no step 7; its steps are 0 to 3");
        clear (&r);
    }
}

/* Without the coefficients: close to the run, and it says so. Without displacements: a clear refusal. */
static void least_squares_where_coefficients_are_missing (void **state)
{
    (void) state;
    double stress;
    pg_stored *s = NULL;
    run r = made ("bare", PLATE "output: {fields: [damage], pictures: []}\n", 0, NULL);
    check_fails (pg_stored_open (&s, path, -1, 1), PG_E_USAGE);
    check_contains (pg_last_error (), "has no field displacement");
    double *u = field_of (&r, NULL, "displacement", NULL);
    pg_sampler fit;
    check_ok (pg_sampler_points (&fit, r.problem, u, NULL));
    s = pg_calloc (1, sizeof *s);
    s->sampler = fit;
    check_below (difference (&r, s, &stress), 0.01);
    check_below (stress, 0.5);
    pg_sampler_clear (&s->sampler);
    pg_free (s), pg_free (u);
    clear (&r);
}

static void broken_bonds_are_told (void **state)
{
    (void) state;
    pg_stored *s = NULL;
    run r = made ("broken",
                  PLATE "cracks: [{from: [-0.1, 0.45], to: [0.35, 0.45]}]\nfailure: {criterion: stretch, "
                        "critical_stretch: 1e-3, exclude: [top, bottom]}\n"
                        "solver: {stepping: event, max_events: 6}\noutput: {pictures: []}\n",
                  0, NULL);
    assert_true (r.state->broken > 0);
    check_ok (pg_stored_open (&s, path, -1, 1));
    check_contains (s->how, "bonds had broken; near ");
    check_relative (s->t, r.state->factor, 1e-9);
    double *u = field_of (&r, NULL, "displacement", NULL), out[3], stress[6];
    check_ok (s->sampler.sample (s->sampler.context, 1, r.problem->cloud.x, out, stress));
    check_scaled (out[0], u[0], 0.02, 1e-3);           /* the corner is whole */
    assert_true (isfinite (stress[0]));
    pg_free (u);
    pg_stored_free (&s);
    clear (&r);
}

static void wrong_folders (void **state)
{
    (void) state;
    pg_stored *s = NULL;
    check_fails (pg_stored_open (&s, "/nowhere", -1, 1), PG_E_FILE);
    run r = made ("run", PLATE, 0, NULL);
    clear (&r);
    snprintf (path, sizeof path, "%s/run/scene.yaml", folder);
    FILE *f = fopen (path, "w");
    fputs (PLATE "lattice: cells\n", f);
    fclose (f);
    snprintf (path, sizeof path, "%s/run", folder);
    check_fails (pg_stored_open (&s, path, -1, 1), PG_E_FILE);
    check_contains (pg_last_error (), "its points are not those that its scene makes now");
    assert_null (s);
}

static void no_memory (void **state)
{
    (void) state;
    pg_stored *s = NULL;
    run r = made ("memory",
                  "dimension: 1\nbody: [{add: {box: {low: [0], high: [1]}}}]\nspacing: 0.25\nmaterials: {a: "
                  "{youngs_modulus: 1, poissons_ratio: 0}}\n"
                  "method: {horizon: 2.2 spacing}\nboundary: [{set: left, displacement: {x: 0}}, {set: "
                  "right, displacement: {x: 0.1}}]\noutput: {pictures: []}\n",
                  0, NULL);
    clear (&r);
    size_t before = pg_memory_used (), k = 1;
    for (; k < 5000; k += k < 100 ? 1 : 7) {
        pg_memory_fail_at (k);
        pg_status got = pg_stored_open (&s, path, -1, 1);
        pg_memory_fail_at (0);
        if (got == PG_OK && s) break;
        assert_null (s);
        assert_true (pg_memory_used () == before);
    }
    assert_true (k > 50 && k < 5000);
    pg_stored_free (&s);
}

/* The scene that report.json names is found again, whatever JSON does to its name. */
static void names_survive_json (void **state)
{
    (void) state;
    static const char *const names[] = { "/a \"quoted\" \\ folder/scene.yaml",
                                         "/tab\tline\n\001\x7f/scene.yaml",
                                         "/\xc3\xa9t\xc3\xa9 \xe6\xbc\xa2 \xf0\x9f\x98\x80/s.yaml",
                                         "/plain.yaml" };
    static const struct { const char *text, *name; } texts[] = {
        { "\\u002fx\\u00E9\\ud83d\\ude00\\u6f22\\/\\b\\f\\r",
          "/x\xc3\xa9\xf0\x9f\x98\x80\xe6\xbc\xa2/\b\f\r" },
        { "\\q", NULL }, { "\\u12g4", NULL }, { "\\ud83d", NULL }, { "\\ud83d\\u0041", NULL },
        { "\\ude00", NULL }, { "\\u0000", NULL }, { "\\", NULL },
    };
    char file[300];
    pg_scene *s = NULL;
    snprintf (file, sizeof file, "%s", inside (folder, "scene.yaml"));
    FILE *f = fopen (file, "w");
    assert_non_null (f);
    fputs (PLATE, f);
    fclose (f);
    snprintf (file, sizeof file, "%s", inside (folder, "report.json"));
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        pg_json *j;
        check_ok (pg_json_create (&j, file));
        pg_json_text (j, "title", "\"scene\": \"wrong");   /* its quotes are escaped: no key */
        pg_json_text (j, "scene", names[k]);
        check_ok (pg_json_close (&j));
        check_ok (pg_stored_scene (&s, folder));
        assert_string_equal (pg_scene_file (s), names[k]);
        pg_scene_free (&s);
    }
    for (size_t k = 0; k < sizeof texts / sizeof *texts; k++) {
        f = fopen (file, "w");
        assert_non_null (f);
        fprintf (f, "{\n  \"scene\": \"%s\"\n}\n", texts[k].text);
        fclose (f);
        pg_status status = pg_stored_scene (&s, folder);
        assert_int_equal (status, texts[k].name ? PG_OK : PG_E_FILE);
        if (texts[k].name) assert_string_equal (pg_scene_file (s), texts[k].name);
        else check_contains (pg_last_error (), "report.json: the text of \"scene\"");
        pg_scene_free (&s);
    }
    unlink (file), unlink (inside (folder, "scene.yaml"));
}

static int make (void **state) { (void) state, make_folder (folder); return 0; }
static int drop (void **state) { (void) state, remove_folder (folder); return 0; }

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (a_folder_gives_its_run_back),
                                        cmocka_unit_test (least_squares_where_coefficients_are_missing),
                                        cmocka_unit_test (broken_bonds_are_told),
                                        cmocka_unit_test (wrong_folders), cmocka_unit_test (no_memory),
                                        cmocka_unit_test (names_survive_json) };
    return cmocka_run_group_tests (tests, make, drop);
}

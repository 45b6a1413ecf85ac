/* SPDX-License-Identifier: GPL-3.0-or-later
 * What a run leaves of cracks that grow by facets: the length and the tips in history.csv, every piece in
 * cracks.csv, every tip in tips.csv, report.json, the summary, faces as lines in result.e; and the columns of
 * tips that do not grow. */
#include "grown.h"
#include "io/picture/fonts.h"

#define PLATE_OF(failure) \
    "dimension: 2\nthickness: 0.1\nbody: [{add: {box: {low: [0, 0], high: [1, 0.9]}}}]\nspacing: 0.05\n" \
    "cracks: [{from: [-0.1, 0.46], to: [0.43, 0.43]}]\nmaterials: {rock: {youngs_modulus: 1 GPa, " \
    "poissons_ratio: 0.2, density: 2000}}\n" failure \
    "boundary: [{name: foot, set: bottom, displacement: {x: 0, y: 0}}, {name: head, set: top, " \
    "displacement: {y: 2 mm}}]\n"
#define GROWING \
    PLATE_OF ("failure: {fracture_energy: 400 J/m2}\n") \
    "solver: {stepping: event, max_events: 7}\noutput: {pictures: [damage], magnify: 20, at: {events: 1}}\n"

/* Length of the pieces that tips have made up to a step. */
static double length_in (const char *cracks, double step)
{
    double sum = 0;
    for (size_t i = 1; i < count_lines (cracks); i++)
        if (number_at (cracks, i, "step [1]") <= step && number_at (cracks, i, "tip [1]") > 0)
            sum += hypot (number_at (cracks, i, "x1 [m]") - number_at (cracks, i, "x0 [m]"),
                          number_at (cracks, i, "y1 [m]") - number_at (cracks, i, "y0 [m]"));
    return sum;
}

/* Every table tells the same cracks. */
static void the_tables_agree (void **state)
{
    (void) state;
    char where[64], line[400] = "";
    make_folder (where);
    leave (GROWING, where, "new crack", line);
    char *history = slurp (inside (where, "history.csv")), *cracks = slurp (inside (where, "cracks.csv")),
         *tips = slurp (inside (where, "tips.csv")), *report = slurp (inside (where, "report.json"));
    size_t rows = count_lines (history) - 1, last = rows, grew = 0;
    assert_int_equal (count_lines (tips) - 1, rows);   /* one tip */
    for (size_t i = 1; i <= rows; i++) {
        double step = number_at (history, i, "step [1]"), length = number_at (history, i, "crack.length [m]");
        check_absolute (length, length_in (cracks, step), 1e-12);
        grew += i > 1 && length > number_at (history, i - 1, "crack.length [m]");
        static const char *const same[][2] = { { "tip.1.J [J/m^2]", "J [J/m^2]" },
                                               { "tip.1.K_I [Pa m^(1/2)]", "K_I [Pa m^(1/2)]" },
                                               { "tip.1.K_II [Pa m^(1/2)]", "K_II [Pa m^(1/2)]" },
                                               { "tip.1.x [m]", "x [m]" }, { "tip.1.y [m]", "y [m]" } };
        for (size_t k = 0; k < sizeof same / sizeof *same; k++)
            assert_true (number_at (history, i, same[k][0]) == number_at (tips, i, same[k][1]));
        double J = number_at (tips, i, "J [J/m^2]"), K = number_at (tips, i, "K_I [Pa m^(1/2)]"),
               K2 = number_at (tips, i, "K_II [Pa m^(1/2)]");
        check_relative ((K * K + K2 * K2) / 1e9, J, 0.25);
        assert_true (number_at (tips, i, "tip [1]") == 1 && number_at (tips, i, "open [1]") == 1);
    }
    assert_true (grew >= 5);
    /* pieces follow each other up to the tip */
    for (size_t i = 2; i < count_lines (cracks); i++) {
        assert_true (number_at (cracks, i, "x0 [m]") == number_at (cracks, i - 1, "x1 [m]"));
        assert_true (number_at (cracks, i, "y0 [m]") == number_at (cracks, i - 1, "y1 [m]"));
        assert_true (number_at (cracks, i, "crack [1]") == 1);
    }
    size_t end = count_lines (cracks) - 1;
    assert_true (number_at (cracks, end, "x1 [m]") == number_at (history, last, "tip.1.x [m]"));
    check_relative (json_number (report, NULL, "crack_length"), number_at (history, last, "crack.length [m]"),
                    1e-12);
    double ratio = json_number (report, "fracture", "dissipated_over_G0_length");
    double area = json_number (report, "fracture", "area");
    check_relative (area, 0.1 * json_number (report, NULL, "crack_length"), 1e-12);
    check_relative (json_number (report, "fracture", "energy"),
                    400 * json_number (report, "fracture", "area"), 1e-9);
    check_relative (json_number (report, "energy", "dissipated") / json_number (report, "fracture", "energy"),
                    ratio, 1e-9);
    check_relative (ratio, 1, 0.2);
    check_contains (line, "of the fracture energy");
    assert_null (strstr (line, "estimate"));
    pg_free (history), pg_free (cracks), pg_free (tips), pg_free (report);
    remove_folder (where);
}

/* Both faces of every piece are lines of result.e, each from its own step on; read back, the cracks of every
 * time are those of the table. */
static void result_e_has_the_faces (void **state)
{
    (void) state;
    char where[64], line[400];
    int ncid;
    size_t steps = 0, lines = 0;
    double *time = NULL, exist = 0;
    pg_cloud cloud = { 0 };
    make_folder (where);
    leave (GROWING, where, NULL, line);
    char *cracks = slurp (inside (where, "cracks.csv"));
    check_ok (pg_exodus_points (inside (where, "result.e"), &cloud, &steps, &time));
    assert_int_equal (nc_open (inside (where, "result.e"), NC_NOWRITE, &ncid), NC_NOERR);
    exist = faces_at (ncid, 0, &lines);
    /* a row for each piece, and the one that the scene's crack has split off has none */
    assert_int_equal (lines, 2 * count_lines (cracks));
    for (size_t k = 0; k < steps; k++) {
        pg_cracks at = { 0 };
        check_ok (pg_result_cracks (&at, where, time[k]));
        exist = faces_at (ncid, k, &lines);
        assert_true (exist == 2.0 * (double) (at.n + 1));
        double sum = 0;
        for (size_t c = 0; c < at.n; c++) {
            const double *x = at.crack[c].vertex;
            if (at.crack[c].sided) sum += hypot (x[2] - x[0], x[3] - x[1]);
        }
        check_absolute (sum, length_in (cracks, time[k]), 1e-12);  /* time: number of the step */
        pg_cracks_clear (&at);
    }
    assert_true (exist == (double) lines && steps > 4);
    /* the scene's crack: the nodes of its two faces take what lies above and below */
    double u[2] = { 0 }, low = 0, high = 0;
    int uy;
    assert_int_equal (nc_inq_varid (ncid, "vals_nod_var2", &uy), NC_NOERR);
    for (size_t side = 0; side < 2; side++)
        nc_get_var1_double (ncid, uy, (size_t[2]) { steps - 1, cloud.n + 2 * side }, &u[side]);
    for (size_t i = 0; i < cloud.n; i++) {
        const double *x = cloud.x + 2*i;
        double v;
        if (x[0] > 1e-9 || fabs (x[1] - 0.45) > 0.06) continue;
        assert_int_equal (nc_get_var1_double (ncid, uy, (size_t[2]) { steps - 1, i }, &v), NC_NOERR);
        if (fabs (x[1] - 0.45) < 1e-9) low = v;
        else if (x[1] > 0.45) high = v;
    }
    assert_true (u[0] == low && u[1] == high && high > low + 1e-4);
    nc_close (ncid);
    pg_free (time), pg_free (cracks);
    pg_free (cloud.x), pg_free (cloud.volume), pg_free (cloud.block);
    remove_folder (where);
}

/* Of a folder without such a table there are none; one that is damaged is told. */
static void cracks_of_a_folder_are_optional (void **state)
{
    (void) state;
    char where[64];
    pg_cracks cracks;
    make_folder (where);
    check_ok (pg_result_cracks (&cracks, where, 1));
    assert_int_equal (cracks.n, 0);
    pg_cracks_clear (&cracks);
    FILE *file = fopen (inside (where, "cracks.csv"), "w");
    fprintf (file, "step [1],stamp [1],crack [1],segment [1],x0 [m],y0 [m],x1 [m],y1 [m],tip [1]\n"
                   "0,0,1,1,0,0\n");
    fclose (file);
    check_fails (pg_result_cracks (&cracks, where, 1), PG_E_FILE);
    file = fopen (inside (where, "cracks.csv"), "w");
    fprintf (file, "step [1],x0 [m]\n0,0\n");
    fclose (file);
    check_fails (pg_result_cracks (&cracks, where, 1), PG_E_FILE);
    remove_folder (where);
}

/* Tips that do not grow: their K grows with the load, J with its square; their places are constant. */
static void stress_intensity_without_growth (void **state)
{
    (void) state;
    char where[64], line[400];
    make_folder (where);
    leave (PLATE_OF ("") "solver: {steps: 2}\noutput: {pictures: [], at: {levels: 2}, stress_intensity: "
                         "on}\n", where, NULL, line);
    char *history = slurp (inside (where, "history.csv")), *tips = slurp (inside (where, "tips.csv"));
    assert_int_equal (size_of (inside (where, "cracks.csv")), -1);
    assert_null (strstr (history, "crack.length"));
    assert_int_equal (count_lines (history), 3);
    double J = number_at (history, 1, "tip.1.J [J/m^2]"),
           K = number_at (history, 1, "tip.1.K_I [Pa m^(1/2)]");
    assert_true (J > 1 && K > 1e4);
    check_relative (number_at (history, 2, "tip.1.J [J/m^2]"), 4 * J, 1e-9);
    check_relative (number_at (history, 2, "tip.1.K_I [Pa m^(1/2)]"), 2 * K, 1e-9);
    check_relative (number_at (history, 2, "tip.1.x [m]"), 0.43, 1e-15);
    assert_true (number_at (tips, 2, "T [Pa]") != 0 && number_at (tips, 2, "J_uncertainty [1]") < 0.2);
    pg_free (history), pg_free (tips);
    leave (PLATE_OF ("") "solver: {steps: 2}\noutput: {pictures: []}\n", where, NULL, line);
    history = slurp (inside (where, "history.csv"));
    assert_null (strstr (history, "tip."));
    assert_int_equal (size_of (inside (where, "tips.csv")), -1);  /* of the earlier run */
    pg_free (history);
    remove_folder (where);
}

static void refuse (const char *text, const char *part)
{
    pg_scene *scene = NULL;
    pg_problem *problem = NULL;
    check_ok (pg_scene_parse (&scene, text, "t.yaml"));
    check_ok (pg_problem_build (&problem, scene, 1));
    check_fails (pg_result_check (scene, problem), PG_E_SCENE);
    check_contains (pg_last_error (), part);
    pg_problem_free (&problem), pg_scene_free (&scene);
}

static void what_has_no_tips_is_refused (void **state)
{
    (void) state;
    refuse ("dimension: 1\nbody: [{add: {box: {low: [0], high: [1]}}}]\nspacing: 0.1\nmaterials: {m: "
            "{youngs_modulus: 1, poissons_ratio: 0}}\noutput: {stress_intensity: on}\n",
            "in 2D and 3D only");
    refuse ("dimension: 2\nbody: [{add: {box: {low: [0, 0], high: [1, 1]}}}]\nspacing: 0.1\nmaterials: {m: "
            "{youngs_modulus: 1, poissons_ratio: 0}}\noutput: {stress_intensity: on}\n",
            "no crack with a tip");
    refuse (PLATE_OF ("") "output: {averages: [{name: tip.1.J, set: top, field: damage}]}\n",
            "has a column of this name anyway");
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (the_tables_agree),
        cmocka_unit_test (result_e_has_the_faces),
        cmocka_unit_test (cracks_of_a_folder_are_optional),
        cmocka_unit_test (stress_intensity_without_growth),
        cmocka_unit_test (what_has_no_tips_is_refused),
    };
    return cmocka_run_group_tests_name ("app/results/grown", tests, NULL, NULL);
}

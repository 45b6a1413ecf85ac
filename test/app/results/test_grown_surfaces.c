/* SPDX-License-Identifier: GPL-3.0-or-later
 * What a run leaves of cracks that grow in space: the area and the largest J of every front in history.csv,
 * every triangle in cracks.csv, every vertex of a front in fronts.csv, report.json, the summary, faces as
 * triangles in result.e, pictures of the surfaces; and fronts of cracks that do not grow. */
#include "grown.h"
#include "perigal/fracture.h"
#include "io/picture/fonts.h"

#define BLOCK_OF(failure) \
    "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [8, 5, 6]}}}]\nspacing: 1\n" \
    "perturb: {amount: 0.2}\n" \
    "cracks: [{polygon: [[-1, -1, 3.1], [3, -1, 3.1], [3, 6, 2.9], [-1, 6, 2.9]]}]\n" \
    "materials: {rock: {youngs_modulus: 1 GPa, poissons_ratio: 0.2}}\n" failure \
    "boundary: [{set: back, displacement: {x: 0, y: 0, z: 0}}, {set: front, displacement: {x: 2 mm, z: 10 " \
    "mm}}]\n"
#define GROWING \
    BLOCK_OF ("failure: {criterion: energy_release, fracture_energy: 400 J/m2}\n") \
    "solver: {stepping: event, max_events: 3}\n" \
    "output: {pictures: [], views: [{view: crack}], at: {events: 1}}\n"

/* Largest J of a front in the rows of a step; NAN: there is none. */
static double most_of (const char *fronts, double step, double front)
{
    double most = NAN;
    for (size_t i = 1; i < count_lines (fronts); i++)
        if (number_at (fronts, i, "step [1]") == step && number_at (fronts, i, "front [1]") == front)
            most = fmax (most, number_at (fronts, i, "J [J/m^2]"));
    return most;
}

/* Area of the triangles of cracks.csv that fronts have made, m^2. */
static double area_of (const char *cracks)
{
    double sum = 0;
    for (size_t i = 1; i < count_lines (cracks); i++) {
        static const char *const name[9] = { "x0 [m]", "y0 [m]", "z0 [m]", "x1 [m]", "y1 [m]",
                                             "z1 [m]", "x2 [m]", "y2 [m]", "z2 [m]" };
        double x[9], n[3];
        if (!(number_at (cracks, i, "front [1]") > 0)) continue;
        for (int k = 0; k < 9; k++) x[k] = number_at (cracks, i, name[k]);
        for (int k = 0; k < 3; k++) {
            int a = (k + 1) % 3, b = (k + 2) % 3;
            n[k] = (x[3 + a] - x[a]) * (x[6 + b] - x[b]) - (x[3 + b] - x[b]) * (x[6 + a] - x[a]);
        }
        sum += 0.5 * hypot (hypot (n[0], n[1]), n[2]);
    }
    return sum;
}

static void the_tables_agree (void **state)
{
    (void) state;
    char where[64], line[400] = "";
    make_folder (where);
    leave (GROWING, where, "new crack", line);
    char *history = slurp (inside (where, "history.csv")), *cracks = slurp (inside (where, "cracks.csv")),
         *fronts = slurp (inside (where, "fronts.csv")), *report = slurp (inside (where, "report.json"));
    size_t rows = count_lines (history) - 1, grew = 0;
    for (size_t i = 1; i <= rows; i++) {
        double step = number_at (history, i, "step [1]"), J = number_at (history, i, "front.1.J_max [J/m^2]");
        if (i > 1)
            grew += number_at (history, i, "crack.area [m^2]")
                    > number_at (history, i - 1, "crack.area [m^2]");
        if (!isnan (J)) assert_true (J == most_of (fronts, step, 1));
    }
    assert_true (grew >= 2);
    double area = number_at (history, rows, "crack.area [m^2]");
    assert_true (area > 6);
    check_relative (json_number (report, NULL, "crack_area"), area, 1e-12);
    check_relative (json_number (report, "fracture", "area"), area, 1e-12);
    check_relative (json_number (report, "fracture", "energy"), 400 * area, 1e-6);
    check_relative (json_number (report, "fracture", "dissipated_over_G0_area"), 1, 0.3);
    /* triangles go on a spacing beyond both faces, and begin behind the front of the scene */
    assert_true (area_of (cracks) > area && area_of (cracks) < 2.2 * area);
    assert_true (number_at (cracks, 1, "front [1]") == 0 && number_at (cracks, 1, "segment [1]") == 1);
    check_contains (line, "new crack: area");
    assert_null (strstr (line, "estimate"));
    pg_free (history), pg_free (cracks), pg_free (fronts), pg_free (report);
    remove_folder (where);
}

/* Both faces of every triangle are elements of result.e, each from its own step on; read back, the cracks of
 * every time are those of the table. */
static void result_e_has_the_faces (void **state)
{
    (void) state;
    char where[64], line[400], type[8] = "";
    int ncid, var;
    size_t steps = 0, faces = 0;
    double *time = NULL, before = 0;
    pg_cloud cloud = { 0 };
    make_folder (where);
    leave (GROWING, where, NULL, line);
    check_ok (pg_exodus_points (inside (where, "result.e"), &cloud, &steps, &time));
    assert_int_equal (nc_open (inside (where, "result.e"), NC_NOWRITE, &ncid), NC_NOERR);
    assert_int_equal (nc_inq_varid (ncid, "connect2", &var), NC_NOERR);
    assert_int_equal (nc_get_att_text (ncid, var, "elem_type", type), NC_NOERR);
    assert_memory_equal (type, "TRI3", 4);
    faces_at (ncid, 0, &faces);
    assert_true (steps > 2 && faces > 40 && faces % 2 == 0);
    for (size_t k = 0; k < steps; k++) {
        pg_cracks at = { 0 };
        double exist = faces_at (ncid, k, &faces);
        check_ok (pg_result_cracks (&at, where, time[k]));
        assert_int_equal (at.dim, 3);
        /* the strip up to the front is there at the last step only */
        assert_true (exist >= 2.0 * (double) at.n && exist >= before);
        if (k + 1 < steps) assert_true (exist == 2.0 * (double) at.n);
        assert_non_null (pg_cracks_cut (&at, (double[]) { 1, 2, 2.5 }, (double[]) { 1, 2, 3.5 }, 1e-9));
        before = exist;
        pg_cracks_clear (&at);
    }
    assert_true (before == (double) faces);
    /* in the mouth the upper face has moved up further than the lower one */
    double low = INFINITY, high = -INFINITY, x, u;
    int ux, uz, nodes;
    size_t n;
    assert_int_equal (nc_inq_varid (ncid, "coordx", &ux), NC_NOERR);
    assert_int_equal (nc_inq_varid (ncid, "vals_nod_var3", &uz), NC_NOERR);
    assert_int_equal (nc_inq_dimid (ncid, "num_nodes", &nodes), NC_NOERR);
    assert_int_equal (nc_inq_dimlen (ncid, nodes, &n), NC_NOERR);
    for (size_t i = cloud.n; i < n; i++) {
        assert_int_equal (nc_get_var1_double (ncid, ux, &i, &x), NC_NOERR);
        assert_int_equal (nc_get_var1_double (ncid, uz, (size_t[2]) { steps - 1, i }, &u), NC_NOERR);
        if (x < 0.5) low = fmin (low, u), high = fmax (high, u);
    }
    assert_true (high > 2 * low && high > 0);
    assert_int_equal (nc_close (ncid), NC_NOERR);
    pg_cloud_clear (&cloud), pg_free (time);
    remove_folder (where);
}

/* Nothing grows, but J and K of every vertex are asked for. */
/* Another crack a spacing ahead of one end of a front: there is no number there, but two vertices further
 * there is one, of a narrower hat; it is near what the whole hats farther on show. */
static void hats_are_narrower_beside_an_obstacle (void **state)
{
    (void) state;
    char where[64], line[400];
    size_t known = 0, narrow = 0;
    double whole = 0, n = 0;
    make_folder (where);
    char text[2000];
    /* short: of smaller supports */
    snprintf (text, sizeof text, "%s"
           "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [8, 12, 6]}}}]\nspacing: 1\n"
           "perturb: {amount: 0.1}\n"
           "cracks: [{polygon: [[-1, -1, 3.1], [3.1, -1, 3.1], [3.1, 13, 3.1], [-1, 13, 3.1]]}, "
           "{polygon: [[4.2, -1, 2.2], [4.2, 1.3, 2.2], [4.2, 1.3, 4.1], [4.2, -1, 4.1]]}]\n"
           "materials: {rock: {youngs_modulus: 1 GPa, poissons_ratio: 0.2}}\n"
           "boundary: [{set: back, displacement: {x: 0, y: 0, z: 0}}, {set: front, displacement: {z: 10 mm}}]"
           "\nsolver: {kind: static}\noutput: {pictures: [], stress_intensity: on}\n",
           longer () ? "" : "method: {horizon: 2.01 spacing}\n");
    leave (text, where, NULL, line);
    char *fronts = slurp (inside (where, "fronts.csv"));
    for (int turn = 0; turn < 2; turn++)
        for (size_t i = 1; i < count_lines (fronts); i++) {
            double y = number_at (fronts, i, "y [m]"), J = number_at (fronts, i, "J [J/m^2]");
            if (number_at (fronts, i, "front [1]") != 1 || number_at (fronts, i, "step [1]") != 1) continue;
            if (turn == 0 && y > 5 && y < 10) whole += J, n++;       /* whole hats, away from the ends */
            if (turn == 0 || !(y > 1.6 && y < 4.2)) continue;
            narrow++;
            if (isfinite (J) && J > 0) check_relative (J, whole / n, 0.05), known++;
        }
    assert_true (n > 3 && narrow > 0 && known == narrow);
    pg_free (fronts);
    remove_folder (where);
}

static void fronts_that_stay_are_measured (void **state)
{
    (void) state;
    char where[64], line[400];
    make_folder (where);
    leave (BLOCK_OF ("") "solver: {kind: static}\noutput: {pictures: [], stress_intensity: on}\n", where,
           NULL, line);
    char *history = slurp (inside (where, "history.csv")), *fronts = slurp (inside (where, "fronts.csv"));
    size_t rows = count_lines (history) - 1;
    assert_true (count_lines (fronts) > 4);
    double J = number_at (history, rows, "front.1.J_max [J/m^2]");
    assert_true (J > 0 && J == most_of (fronts, number_at (history, rows, "step [1]"), 1));
    assert_null (strstr (history, "crack.area"));
    pg_free (history), pg_free (fronts);
    remove_folder (where);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (the_tables_agree), cmocka_unit_test (result_e_has_the_faces),
        cmocka_unit_test (fronts_that_stay_are_measured),
        cmocka_unit_test (hats_are_narrower_beside_an_obstacle),
    };
    return cmocka_run_group_tests_name ("app/results/grown_surfaces", tests, NULL, NULL);
}

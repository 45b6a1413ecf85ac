/* SPDX-License-Identifier: GPL-3.0-or-later
 * Points from a CSV file: what is read, and hostile files. */
#include "parsed.h"
#include <stdlib.h>
#include <unistd.h>

static char folder[64];

static int make_folder (void **state)
{
    (void) state;
    snprintf (folder, sizeof folder, "/tmp/perigal_points_XXXXXX");
    return mkdtemp (folder) ? 0 : -1;
}

static int drop_folder (void **state) { (void) state; return rmdir (folder); }

/* Builds the cloud of a file of that content beside a scene. */
static pg_status cloud_of (pg_cloud *cloud, int dim, const char *csv, size_t size)
{
    char path[128], text[128];
    snprintf (path, sizeof path, "%s/cloud.csv", folder);
    FILE *f = fopen (path, "wb");
    assert_non_null (f);
    assert_int_equal (fwrite (csv, 1, size, f), size);
    fclose (f);
    char scene_path[128];
    snprintf (scene_path, sizeof scene_path, "%s/scene.yaml", folder);
    snprintf (text, sizeof text, "dimension: %d\nthickness: 0.5\npoints: cloud.csv\n", dim);
    pg_scene *scene = NULL;
    pg_body body;
    pg_lattice lattice;
    check_ok (pg_scene_parse (&scene, text, scene_path));
    check_ok (pg_body_read (&body, scene));
    pg_status status = pg_cloud_build (cloud, &lattice, &body, scene);
    assert_int_equal (lattice.dim, 0);
    pg_body_clear (&body);
    pg_scene_free (&scene);
    unlink (path);
    return status;
}

static void must_fault (int dim, const char *csv, const char *part)
{
    pg_cloud cloud;
    check_fails (cloud_of (&cloud, dim, csv, strlen (csv)), PG_E_SCENE);
    check_contains (pg_last_error (), part);
    check_contains (pg_last_error (), "points = cloud.csv: cloud.csv");
}

static void header_comments_blanks_and_blocks_are_read (void **state)
{
    (void) state;
    const char *csv = "\xEF\xBB\xBF# made by hand\r\nX [m], y [m], volume [m3], block\r\n\r\n0,0,0.02,3\r\n "
                      "1 , 0.5 ,4e-2,0 # corner\r\n0,1,0.03,7";
    pg_cloud c;
    check_ok (cloud_of (&c, 2, csv, strlen (csv)));
    assert_int_equal (c.n, 3);
    check_relative (c.x[2], 1, 0);
    check_relative (c.x[3], 0.5, 0);
    check_relative (c.volume[1], 0.04, 0);
    assert_int_equal (c.block[0], 3);
    assert_int_equal (c.block[2], 7);
    check_relative (c.h, sqrt (0.09 / 3 / 0.5), 1e-14);         /* mean volume / thickness */
    check_relative (c.high[1], 1, 0);
    pg_cloud_clear (&c);
}

static void blanks_separate_where_there_are_no_commas (void **state)
{
    (void) state;
    const char *csv = "0 0 0\t1\n1 0 0 2\n0 1 0 3\n";
    pg_cloud c;
    check_ok (cloud_of (&c, 3, csv, strlen (csv)));
    assert_int_equal (c.n, 3);
    check_relative (c.h, cbrt (2), 1e-14);
    assert_int_equal (c.block[2], 0);
    pg_cloud_clear (&c);
}

static void spacings_follow_the_block_or_a_header (void **state)
{
    (void) state;
    const char *const csv[3] = { "0,0,0.02,3,0.1\n1,0,0.02,4,0.3\n",
                                 "x y volume block spacing\n0 0 0.02 3 0.1\n1 0 0.02 4 0.3\n",
                                 "x,y,volume,spacing [m]\n0,0,0.02,0.1\n1,0,0.02,0.3\n" };
    for (int k = 0; k < 3; k++) {
        pg_cloud c;
        check_ok (cloud_of (&c, 2, csv[k], strlen (csv[k])));
        check_relative (c.size[0], 0.1, 0);
        check_relative (pg_cloud_ratio (&c, 1), 0.3 / c.h, 0);
        check_relative (pg_cloud_finest (&c), 0.1, 0);
        assert_int_equal (c.block[1], k < 2 ? 4 : 0);
        pg_cloud_clear (&c);
    }
    must_fault (2, "0 0 1 0 0.1\n1 0 1 0 0\n", "the spacing 0 must be positive");
    must_fault (2, "0 0 1 0 0.1\n1 0 1 0\n", "4 columns, the lines before have 5");
    must_fault (2, "0 0 1 0 0.1 7\n",
                "6 columns; in 2D a line has 3 (coordinates, volume), 4 (and block) or 5 (and spacing)");
}

static void many_points_keep_their_order (void **state)
{
    (void) state;
    static char csv[400000];
    size_t used = 0, n = 5000;
    for (size_t i = 0; i < n; i++)
        used += (size_t) snprintf (csv + used, sizeof csv - used, "%zu,%.17g\n", (i * 7919) % n,
                                   1.0 + (double) i / (double) n);
    pg_cloud c;
    check_ok (cloud_of (&c, 1, csv, used));
    assert_int_equal (c.n, n);
    for (size_t i = 0; i < n; i++)
        assert_true (c.x[i] == (double) ((i * 7919) % n) && c.volume[i] == 1.0 + (double) i / (double) n);
    pg_cloud_clear (&c);
}

static void faults_name_the_line (void **state)
{
    (void) state;
    must_fault (2, "x,y,volume\n0,0,1\n0,nan,1\n", "cloud.csv:3: 'nan' in column 2 (y)");
    must_fault (2, "0,0,1\n0,1,inf\n", "cloud.csv:2: 'inf' in column 3");
    must_fault (2, "0,0,1\n\n0,1,1e999\n", "cloud.csv:3: '1e999' in column 3");
    must_fault (2, "0,0,1\n1,0\n", "cloud.csv:2: 2 columns, the lines before have 3");
    must_fault (2, "0,0\n",
                "cloud.csv:1: 2 columns; in 2D a line has 3 (coordinates, volume), 4 (and block)");
    must_fault (2, "0,0,1\n1,0,1,0\n", "cloud.csv:2: 4 columns, the lines before have 3");
    must_fault (2, "0,0,1\n1,,1\n", "cloud.csv:2: '' in column 2");
    must_fault (2, "0,0,1\n1,2 3,1\n", "cloud.csv:2: '2 3' in column 2");
    must_fault (2, "0,0,1\n1,0,0\n", "cloud.csv:2: the volume 0 must be positive");
    must_fault (2, "0,0,1\n1,0,-2\n", "cloud.csv:2: the volume -2 must be positive");
    must_fault (2, "0,0,1,1.5\n", "cloud.csv:1: the block 1.5 must be a whole number");
    must_fault (2, "0,0,1,1e10\n", "cloud.csv:1: the block 1e+10 must be a whole number");
    must_fault (2, "0,0,1,2,3,4,5,6,7,8,9,10,11\n", "cloud.csv:1: 13 columns");
}

/* The same three points as every table says them. */
static void a_header_gives_units_and_order (void **state)
{
    (void) state;
    static const char *const csv[] = {
        "x,y,volume,block,spacing\n0,0.003,0.02,1,0.1\n1,0,0.03,0,0.2\n-0.007,1,0.04,2,0.3\n",
        "x [mm],y (mm),volume [mm3],block,spacing [cm]\n0,3,2e7,1,10\n1000,0,3e7,0,20\n-7,1000,4e7,2,30\n",
        ("\"volume [mm^3]\",\"y [um]\",\"x[km]\",\"spacing [m]\",\"block "
         "[1]\"\n2e7,3000,0,0.1,1\n3e7,0,1e-3,0.2,0\n4e7,1e6,-7e-6,0.3,2\n"),
        "spacing [mm] x [mm] y [m] VOLUME [mm3] block\n100 0 0.003 2e7 1\n200 1000 0 3e7 0\n300 -7 1 4e7 2\n"
    };
    static const double x[6] = { 0, 0.003, 1, 0, -0.007, 1 }, volume[3] = { 0.02, 0.03, 0.04 },
                        spacing[3] = { 0.1, 0.2, 0.3 };
    static const int block[3] = { 1, 0, 2 };
    for (size_t k = 0; k < sizeof csv / sizeof *csv; k++) {
        pg_cloud c;
        check_ok (cloud_of (&c, 2, csv[k], strlen (csv[k])));
        assert_int_equal (c.n, 3);
        for (int i = 0; i < 6; i++) assert_true (fabs (c.x[i] - x[i]) <= 1e-15);
        for (int i = 0; i < 3; i++) {
            check_relative (c.volume[i], volume[i], 1e-15);
            check_relative (c.size[i], spacing[i], 1e-15);
            assert_int_equal (c.block[i], block[i]);
        }
        pg_cloud_clear (&c);
    }
    must_fault (
        2, "x [s],y,volume\n0,0,1\n",
        "cloud.csv:1: column 1 of the header, 'x [s]': 's' does not fit: expected m, for example 5 mm");
    must_fault (2, "x,y,volume [mm2]\n0,0,1\n",
                "column 3 of the header, 'volume [mm2]': 'mm2' does not fit: expected m3");
    must_fault (2, "x,y [mmm],volume\n0,0,1\n",
                "column 2 of the header, 'y [mmm]': unknown unit 'mmm'; did you mean mm?");
    must_fault (2, "x,y,volume,block [mm]\n0,0,1,0\n",
                "column 4 of the header, 'block [mm]': 'mm' does not fit");
    must_fault (2, "x [mm,y,volume\n0,0,1\n", "'x [mm': the bracket of its unit does not close");
}

static void a_header_must_name_the_columns (void **state)
{
    (void) state;
    must_fault (2, "x,y,volum\n0,0,1\n",
                "cloud.csv:1: column 3 of the header is called 'volum' (did you mean volume?): the columns "
                "of a 2D body are x, y, volume, block, spacing, in any order");
    must_fault (2, "x,y,z,volume\n0,0,0,1\n", "column 3 of the header is ");
    must_fault (2, "x,x,volume\n0,0,1\n", "columns 1 and 2 of the header are both called 'x'");
    must_fault (2, "x,y,block\n0,0,1\n", "the header has no column 'volume'");
    must_fault (2, "x,y,volume\n0,0,1,1\n", "cloud.csv:2: 4 columns, the header has 3");
    must_fault (2, "x,y,volume\nx,y,volume\n0,0,1\n", "cloud.csv:2: 'x' in column 1 (x)");
    must_fault (2, "y,volume,x\n0,0,1\n", "the volume 0 must be positive: it stands in column 2");
    must_fault (2, "1,0,0\n",
                "the volume 0 must be positive: it stands in column 3; without a header the columns are x, "
                "y, volume, block, spacing (a header");
}

static void empty_files_and_binary_files_are_faults (void **state)
{
    (void) state;
    must_fault (2, "", "has no points");
    must_fault (2, "# nothing\nx,y,volume\n", "has no points");
    pg_cloud cloud;
    check_fails (cloud_of (&cloud, 2, "0,0,1\0,1", 8), PG_E_SCENE);
    check_contains (pg_last_error (), "not a text file");
}

static void the_same_point_twice_is_a_fault (void **state)
{
    (void) state;
    must_fault (2, "0,0,1\n1,0,1\n0,1,1\n1,0,2\n", "cloud.csv:4: the same point as in line 2");
    must_fault (2, "0,0,1\n1,0,1\n0,1,1\n1.00000000000001,-0.0,2\n",
                "cloud.csv:4: the same point as in line 2");
    must_fault (2, "3,3,1\n3,3,1\n", "cloud.csv:2: the same point as in line 1");
}

static void a_missing_file_or_a_folder_is_a_fault (void **state)
{
    (void) state;
    const char *name[] = {"no_such_file.csv", "/tmp"}, *why[] = {"No such file", "directory"};
    for (int k = 0; k < 2; k++) {
        char text[200];
        snprintf (text, sizeof text, "dimension: 2\npoints: %s\n", name[k]);
        pg_scene *scene = parsed (text);
        pg_body body;
        pg_lattice lattice;
        pg_cloud cloud;
        check_ok (pg_body_read (&body, scene));
        check_fails (pg_cloud_build (&cloud, &lattice, &body, scene), PG_E_SCENE);
        check_contains (pg_last_error (), why[k]);
        pg_body_clear (&body);
        pg_scene_free (&scene);
    }
}

static void random_bytes_never_crash_the_reader (void **state)
{
    (void) state;
    uint32_t seed = 11;
    const char *good = "x,y,volume,block\n0,0,1e-3,1\n0.5,0.25,1e-3,2\n# c\n1,1,2e-3,0\n";
    for (int k = 0; k < 500; k++) {
        char csv[100];
        size_t n = strlen (good);
        memcpy (csv, good, n);
        for (int m = 0; m < 3; m++) {
            seed = seed * 1664525u + 1013904223u;
            csv[(seed >> 8) % n] = (char) (seed >> 24);
        }
        pg_cloud c;
        pg_status status = cloud_of (&c, 2, csv, n);
        assert_true (status == PG_OK || status == PG_E_SCENE);
        if (status == PG_OK) pg_cloud_clear (&c);
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (header_comments_blanks_and_blocks_are_read),
        cmocka_unit_test (blanks_separate_where_there_are_no_commas),
        cmocka_unit_test (spacings_follow_the_block_or_a_header),
        cmocka_unit_test (many_points_keep_their_order),
        cmocka_unit_test (faults_name_the_line),
        cmocka_unit_test (a_header_must_name_the_columns),
        cmocka_unit_test (a_header_gives_units_and_order),
        cmocka_unit_test (empty_files_and_binary_files_are_faults),
        cmocka_unit_test (the_same_point_twice_is_a_fault),
        cmocka_unit_test (a_missing_file_or_a_folder_is_a_fault),
        cmocka_unit_test (random_bytes_never_crash_the_reader),
    };
    return cmocka_run_group_tests_name ("geometry/cloud/points_file", tests, make_folder, drop_folder);
}

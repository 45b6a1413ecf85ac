/* SPDX-License-Identifier: GPL-3.0-or-later
 * What a valid scene gives back: values, defaults, counts, names, overrides, hash. */
#include "plate.h"
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

static const char text[] =
    "title: \"10 GPa\"\n"
    "dimension: 2\n"
    "spacing: 2 mm\n"
    "cracks:\n"
    "  - {from: [-1 mm, 2e-3]}\n"
    "  - from: [0, 0.5 m]\n"
    "    width: 1 um\n"
    "materials:\n"
    "  rock: &r {youngs_modulus: 10 GPa, density: 2500 kg/m3}\n"
    "  sand: {youngs_modulus: 1 MPa, poissons_ratio: 0.1}\n"
    "  more: *r\n"
    "failure: {fracture_energy: 5 J/m2, exclude: top}\n"
    "method: {horizon: 2.5 spacing, check: yes}\n"
    "sets:\n"
    "  top: {where: y > 3 mm, angle: [[80 deg, 100 deg], [260 deg, 280 deg]]}\n"
    "load: {pressure: 1 MPa * t}\n";

static pg_scene *read_all (void)
{
    pg_scene *s = NULL;
    check_ok (plate_read (&s, text));
    return s;
}

static void written_values_are_si (void **state)
{
    (void) state;
    pg_scene *s = read_all ();
    assert_true (pg_scene_number (s, "spacing") == 0.002);
    assert_true (pg_scene_number (s, "materials.%s.youngs_modulus", "rock") == 1e10);
    assert_true (pg_scene_number (s, "cracks[%d].width", 1) == 1e-6);
    assert_int_equal (pg_scene_integer (s, "dimension"), 2);
    assert_int_equal (pg_scene_bool (s, "method.check"), 1);
    assert_string_equal (pg_scene_text (s, "title"), "10 GPa");
    assert_string_equal (pg_scene_text (s, "load.pressure"), "1 MPa * t");
    assert_string_equal (pg_scene_text (s, "sets.top.where"), "y > 3 mm");
    pg_scene_free (&s);
}

static void absent_values_take_the_default (void **state)
{
    (void) state;
    pg_scene *s = read_all ();
    assert_true (pg_scene_number (s, "cracks[0].width") == 0.0005);
    assert_true (pg_scene_number (s, "materials.rock.poissons_ratio") == 0.25);
    assert_true (pg_scene_number (s, "materials.sand.poissons_ratio") == 0.1);
    assert_string_equal (pg_scene_text (s, "method.kernel"), "quadratic");
    assert_int_equal (pg_scene_integer (s, "method.levels"), 10);
    check_relative (pg_scene_number (s, "load.friction_angle"), 0.69813170079773183, 1e-15);
    assert_int_equal (pg_scene_count (s, "output.fields"), 2);
    assert_string_equal (pg_scene_name (s, 1, "output.fields"), "damage");
    assert_string_equal (pg_scene_text (s, "output.fields[0]"), "displacement");
    pg_scene_free (&s);
}

static void given_and_has_tell_written_from_default (void **state)
{
    (void) state;
    pg_scene *s = read_all ();
    assert_true (pg_scene_given (s, "cracks[1].width") && pg_scene_has (s, "cracks[1].width"));
    assert_true (!pg_scene_given (s, "cracks[0].width") && pg_scene_has (s, "cracks[0].width"));
    assert_true (!pg_scene_given (s, "materials.sand.density")
                 && !pg_scene_has (s, "materials.sand.density"));
    assert_true (pg_scene_given (s, "materials") && pg_scene_given (s, "materials.rock")
                 && !pg_scene_has (s, "materials.clay"));
    assert_true (!pg_scene_has (s, "cracks[2].width") && !pg_scene_has (s, "materials.clay.poissons_ratio"));
    assert_true (!pg_scene_given (s, "output") && pg_scene_has (s, "output.fields"));
    assert_true (!pg_scene_has (s, "nonsense.of.any[3].kind") && !pg_scene_has (s, "spacing.deeper"));
    pg_scene_free (&s);
}

static void absent_without_default_is_zero (void **state)
{
    (void) state;
    pg_scene *s = read_all ();
    double v[3];
    assert_true (pg_scene_number (s, "materials.sand.density") == 0);
    assert_null (pg_scene_text (s, "no.such"));
    assert_null (pg_scene_text (s, "materials"));
    assert_null (pg_scene_name (s, 0, "no.such"));
    assert_int_equal (pg_scene_count (s, "no.such"), 0);
    assert_int_equal (pg_scene_vector (s, 3, v, "no.such"), 0);
    assert_int_equal (pg_scene_integer (s, "no.such"), 0);
    assert_int_equal (pg_scene_bool (s, "no.such"), 0);
    pg_scene_free (&s);
}

static void lists_and_maps_are_counted_and_named (void **state)
{
    (void) state;
    pg_scene *s = read_all ();
    assert_int_equal (pg_scene_count (s, "cracks"), 2);
    assert_int_equal (pg_scene_count (s, "materials"), 3);
    assert_int_equal (pg_scene_count (s, "spacing"), 1);
    assert_string_equal (pg_scene_name (s, 0, "materials"), "rock");
    assert_string_equal (pg_scene_name (s, 2, "materials"), "more");
    assert_null (pg_scene_name (s, 3, "materials"));
    assert_true (pg_scene_number (s, "materials.more.density") == 2500);   /* through a YAML alias */
    assert_string_equal (pg_scene_name (s, 0, "failure.exclude"), "top");  /* one name without list */
    assert_null (pg_scene_name (s, 1, "failure.exclude"));
    pg_scene_free (&s);
}

static void vectors_have_as_many_numbers_as_dimensions (void **state)
{
    (void) state;
    pg_scene *s = read_all ();
    double v[4] = { 0 };
    assert_int_equal (pg_scene_vector (s, 3, v, "cracks[0].from"), 2);
    assert_true (v[0] == -0.001 && v[1] == 0.002);
    assert_int_equal (pg_scene_vector (s, 2, v, "load.direction"), 2);
    assert_true (v[0] == 0 && v[1] == 1);
    assert_int_equal (pg_scene_count (s, "sets.top.angle"), 2);
    assert_int_equal (pg_scene_vector (s, 4, v, "sets.top.angle[%zu]", (size_t) 1), 2);
    check_relative (v[1], 280 * 3.14159265358979323846 / 180, 1e-15);
    check_relative (pg_scene_number (s, "sets.top.angle[0][1]"), 100 * 3.14159265358979323846 / 180, 1e-15);
    pg_scene_free (&s);
}

static void lengths_may_count_spacings (void **state)
{
    (void) state;
    pg_scene *s = read_all ();
    assert_true (pg_scene_length (s, 0.002, "method.horizon") == 0.005);
    assert_true (isnan (pg_scene_number (s, "method.horizon")));           /* nobody may forget the spacing */
    pg_scene_free (&s);
    check_ok (plate_read (&s, PLATE_HEAD "method: {horizon: 4 mm}\n"));
    assert_true (pg_scene_length (s, 99, "method.horizon") == 0.004
                 && pg_scene_number (s, "method.horizon") == 0.004);
    pg_scene_free (&s);
    check_ok (plate_read (&s, PLATE_HEAD));
    assert_true (pg_scene_length (s, 0.1, "method.horizon") == 0.2);
    pg_scene_free (&s);
}

static void empty_maps_and_lists_are_absent_contents (void **state)
{
    (void) state;
    pg_scene *s = NULL;
    check_ok (plate_read (&s, PLATE_HEAD "cracks:\nmethod:   # all defaults\n"));
    assert_int_equal (pg_scene_count (s, "cracks"), 0);
    assert_string_equal (pg_scene_text (s, "method.kernel"), "quadratic");
    pg_scene_free (&s);
}

static void overrides_replace_add_and_grow (void **state)
{
    (void) state;
    static const char *const set[] = {
        "spacing=1 mm",
        "method.kernel=gaussian",
        "cracks[0].from=[1 mm, 2 mm]",
        "cracks[2].from=[3, 4]",
        "cracks[2].width=7 mm",
        "output.fields=[stress]",
        "materials.clay={youngs_modulus: 5 MPa}",
        "method.levels=3",
        "method.levels=4",
    };
    pg_scene *s = NULL;
    double v[3];
    check_ok (plate_read_with (&s, text, sizeof set / sizeof *set, set));
    assert_true (pg_scene_number (s, "spacing") == 0.001);
    assert_string_equal (pg_scene_text (s, "method.kernel"), "gaussian");
    assert_int_equal (pg_scene_bool (s, "method.check"), 1);
    assert_int_equal (pg_scene_vector (s, 3, v, "cracks[0].from"), 2);
    assert_true (v[0] == 0.001);
    assert_int_equal (pg_scene_count (s, "cracks"), 3);
    assert_true (pg_scene_number (s, "cracks[2].width") == 0.007);
    assert_string_equal (pg_scene_name (s, 0, "output.fields"), "stress");
    assert_true (pg_scene_number (s, "materials.clay.youngs_modulus") == 5e6);
    assert_int_equal (pg_scene_integer (s, "method.levels"), 4);
    assert_string_equal (pg_scene_source (s), text);
    pg_scene_free (&s);
}

static void hash_is_that_of_the_file_and_changes_with_overrides (void **state)
{
    (void) state;
    static const char *const set[] = { "spacing=1 mm" };
    pg_scene *s = NULL;
    check_ok (plate_read (&s, "dimension: 2\nspacing: 2 mm\nmaterials: {}\n"));
    /* from sha256sum */
    assert_string_equal (pg_scene_hash (s),
                         "4d915754e3012153e8893271c43c141d13e876e5ed8fdc1e451206f4974e1b1d");
    pg_scene_free (&s);
    check_ok (plate_read_with (&s, "dimension: 2\nspacing: 2 mm\nmaterials: {}\n", 1, set));
    assert_int_equal (strlen (pg_scene_hash (s)), 64);
    assert_string_not_equal (pg_scene_hash (s),
                             "4d915754e3012153e8893271c43c141d13e876e5ed8fdc1e451206f4974e1b1d");
    pg_scene_free (&s);
}

static void files_are_read_as_texts_are (void **state)
{
    (void) state;
    char name[] = "/tmp/perigal_scene_XXXXXX";
    int f = mkstemp (name);
    static const char whole[] = "title: a file\ndimension: 2\nplane: strain\nthickness: 10 mm\n";
    assert_true (f >= 0 && write (f, whole, sizeof whole - 1) == (ssize_t) (sizeof whole - 1));
    close (f);
    pg_scene *s = NULL;
    pg_status status = pg_scene_load (&s, name);
    if (status == PG_OK) {                             /* other folders may require more keys */
        assert_string_equal (pg_scene_file (s), name);
        assert_string_equal (pg_scene_source (s), whole);
        assert_true (pg_scene_number (s, "thickness") == 0.01);
    } else {
        assert_int_equal (status, PG_E_SCENE);
        check_contains (pg_last_error (), name);
        assert_null (strstr (pg_last_error (), "thickness"));
    }
    pg_scene_free (&s);
    unlink (name);
}

static void write_letters (const char *path, size_t n, char last)
{
    FILE *f = fopen (path, "w");
    assert_non_null (f);
    for (size_t k = 0; k + 1 < n; k++) fputc ('a', f);
    fputc (last, f);
    assert_int_equal (fclose (f), 0);
}

/* Whole files count, in the order of the scene, beside it unless their path begins at the root. */
static void files_that_a_scene_names_are_summed (void **state)
{
    (void) state;
    static const char whole[] = "dimension: 2\nthickness: 1\npoints: points.csv\nmaterials: {m: "
                                "{youngs_modulus: 1, poissons_ratio: 0}}\nreference: {lines: [{file: %s}]}\n";
    char folder[] = "/tmp/perigal_files_XXXXXX", path[3][64];
    pg_scene *s;
    pg_named_file *file;
    size_t n;
    assert_non_null (mkdtemp (folder));
    for (int k = 0; k < 3; k++)
        snprintf (path[k], sizeof path[k], "%s/%s", folder,
                  k == 0   ? "points.csv"
                  : k == 1 ? "line.csv"
                           : "scene.yaml");
    FILE *f = fopen (path[2], "w");
    assert_true (f && fprintf (f, whole, path[1]) > 0 && fclose (f) == 0);
    write_letters (path[0], 100000, 'a'), write_letters (path[1], 100000, 'b');
    check_ok (pg_scene_load (&s, path[2]));
    check_ok (pg_scene_files (s, &n, &file));
    assert_int_equal (n, 2);
    for (size_t k = 0; k < 2; k++) assert_string_equal (file[k].path, path[k]);
    assert_string_equal (file[0].key, "points");
    assert_string_equal (file[1].key, "reference.lines[0].file");
    /* from sha256sum */
    assert_string_equal (file[0].hash, "6d1cf22d7cc09b085dfc25ee1a1f3ae0265804c607bc2074ad253bcc82fd81ee");
    assert_string_equal (file[1].hash, "4ae5f95c77a51ea4a0d44a0231c1ccb45fb2940d372fe127d1278898111a118c");
    pg_scene_files_free (n, &file);
    unlink (path[0]);
    check_fails (pg_scene_files (s, &n, &file), PG_E_FILE);
    check_contains (pg_last_error (), "points.csv: No such file");
    assert_true (n == 0 && !file && mkdir (path[0], 0700) == 0);
    check_fails (pg_scene_files (s, &n, &file), PG_E_FILE);
    check_contains (pg_last_error (), "points.csv: is no regular file");
    pg_scene_free (&s);
    rmdir (path[0]), unlink (path[1]), unlink (path[2]), rmdir (folder);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (written_values_are_si),
        cmocka_unit_test (absent_values_take_the_default),
        cmocka_unit_test (given_and_has_tell_written_from_default),
        cmocka_unit_test (absent_without_default_is_zero),
        cmocka_unit_test (lists_and_maps_are_counted_and_named),
        cmocka_unit_test (vectors_have_as_many_numbers_as_dimensions),
        cmocka_unit_test (lengths_may_count_spacings),
        cmocka_unit_test (empty_maps_and_lists_are_absent_contents),
        cmocka_unit_test (overrides_replace_add_and_grow),
        cmocka_unit_test (hash_is_that_of_the_file_and_changes_with_overrides),
        cmocka_unit_test (files_are_read_as_texts_are),
        cmocka_unit_test (files_that_a_scene_names_are_summed),
    };
    return cmocka_run_group_tests_name ("scene/access", tests, NULL, NULL);
}

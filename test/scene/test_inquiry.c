/* SPDX-License-Identifier: GPL-3.0-or-later
 * Help, manual, nearest names, the hash, and the tables of all folders themselves. */
#include "plate.h"
#include "scene/keys/keys.h"
#include "scene/sha256.h"
#include "scene/quantity/unit.h"
#include <stdlib.h>

static pg_schema plate_schema (void)
{
    pg_schema s = { 0 };
    check_ok (pg_schema_create (&s, &plate_words));
    return s;
}

static char *help_of (const char *key)
{
    char *text = NULL;
    size_t n;
    pg_schema s = plate_schema ();
    FILE *to = open_memstream (&text, &n);
    check_ok (pg_help_write (to, key, &s));
    fclose (to);
    pg_schema_clear (&s);
    return text;
}

static void help_tells_all_of_a_key (void **state)
{
    (void) state;
    char *text = help_of ("materials.{}.youngs_modulus");
    assert_string_equal (text, "materials.{}.youngs_modulus\n  Young's modulus.\n  kind     number\n"
                               "  value    a number with a unit of Pa, for example 10 GPa\n  unit     Pa\n"
                               "  range    (0, inf)\n  default  none, required\n");
    free (text);
    text = help_of ("method.kernel");
    assert_string_equal (text, "method.kernel\n  Kernel.\n  kind     name\n  choices  constant, quadratic, "
                               "gaussian\n  default  quadratic\n");
    free (text);
}

static void help_finds_keys_without_brackets_and_by_last_word (void **state)
{
    (void) state;
    static const char *const key[] = { "materials.youngs_modulus", "youngs_modulus",
                                       "materials.{}.youngs_modulus" };
    for (size_t k = 0; k < 3; k++) {
        char *text = help_of (key[k]);
        check_contains (text, "materials.{}.youngs_modulus\n  Young's modulus.");
        free (text);
    }
    char *text = help_of ("cracks[].width");
    check_contains (text, "default  0.5 mm");
    free (text);
}

static void help_of_a_map_lists_what_is_below (void **state)
{
    (void) state;
    char *text = help_of ("method");
    check_contains (text, "method.kernel ");
    check_contains (text, "method.levels ");
    assert_null (strstr (text, "load."));
    free (text);
}

static void help_names_the_partners_of_a_group (void **state)
{
    (void) state;
    char *text = help_of ("fracture_energy");
    check_contains (text, "group    give exactly one of critical_stretch, fracture_energy\n");
    free (text);
}

static void unknown_help_names_the_nearest_key (void **state)
{
    (void) state;
    pg_schema s = plate_schema ();
    check_fails (pg_help_write (stderr, "young_modulus", &s), PG_E_USAGE);
    assert_string_equal (pg_last_error (), "unknown key 'young_modulus'; did you mean youngs_modulus?");
    check_fails (pg_help_write (stderr, "qqqqqq", &s), PG_E_USAGE);
    assert_string_equal (pg_last_error (), "unknown key 'qqqqqq'");
    check_fails (pg_help_write (stderr, "", &s), PG_E_USAGE);
    pg_schema_clear (&s);
}

static void manual_has_every_key_once (void **state)
{
    (void) state;
    char *text = NULL, row[200];
    size_t n;
    pg_schema s = plate_schema ();
    FILE *to = open_memstream (&text, &n);
    check_ok (pg_manual_write (to, &s));
    fclose (to);
    for (size_t k = 0; k < s.n; k++) {
        snprintf (row, sizeof row, "\n| `%s` |", s.row[k]->path);
        char *at = strstr (text, row);
        assert_non_null (at);
        assert_null (strstr (at + 1, row));
    }
    check_contains (text, "\n### method\n");
    check_contains (text, "--set KEY=VALUE");
    check_contains (text, "| `hypot (a, b)` |");
    check_contains (
        text, "| `method.kernel` | name | `constant`, `quadratic`, `gaussian` | `quadratic` | Kernel. |\n");
    free (text);
    pg_schema_clear (&s);
}

static void public_inquiry_knows_the_scene_keys (void **state)
{
    (void) state;
    char *text = NULL;
    size_t n;
    FILE *to = open_memstream (&text, &n);
    check_ok (pg_scene_help (to, "thickness"));
    check_ok (pg_scene_manual (to));
    fclose (to);
    check_contains (text, "thickness\n  Thickness of a two-dimensional body.");
    check_contains (text, "# The scene file");
    free (text);
}

static void nearest_names_forgive_small_slips (void **state)
{
    (void) state;
    static const char names[] = "horizon|youngs_modulus|poissons_ratio|x|kernel";
    assert_string_equal (pg_nearest_name ("horizn", names), "horizon");
    assert_string_equal (pg_nearest_name ("poisson_ratio", names), "poissons_ratio");
    assert_string_equal (pg_nearest_name ("ekrnel", names), "kernel");
    assert_string_equal (pg_nearest_name ("youngs", names), "youngs_modulus");
    assert_string_equal (pg_nearest_name ("Kernel", names), "kernel");
    assert_null (pg_nearest_name ("zebra", names));
    assert_null (pg_nearest_name ("y", names));
    assert_null (pg_nearest_name ("", names));
    assert_null (pg_nearest_name ("a", NULL));
}

static void hash_agrees_with_published_values (void **state)
{
    (void) state;
    static const struct { const char *text, *hex;
    } row[] = {
        { "", "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855" },
        { "abc", "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad" },
        { "abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq",
          "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1" },
    };
    char hex[65];
    pg_sha256 s;
    for (size_t k = 0; k < 3; k++) {
        pg_sha256_start (&s);
        pg_sha256_add (&s, row[k].text, strlen (row[k].text));
        pg_sha256_end (&s, hex);
        assert_string_equal (hex, row[k].hex);
    }
    pg_sha256_start (&s);
    for (int k = 0; k < 1000000; k++) pg_sha256_add (&s, "a", 1);
    pg_sha256_end (&s, hex);
    assert_string_equal (hex, "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

static int same_shape (pg_kind a, pg_kind b)  /* two rows of one path are alternatives of different shape */
{
    int la = a == PG_MAP ? 2 : a == PG_LIST || a == PG_VECTOR || a == PG_NUMBERS || a == PG_NAMES;
    int lb = b == PG_MAP ? 2 : b == PG_LIST || b == PG_VECTOR || b == PG_NUMBERS || b == PG_NAMES;
    return la == lb;
}

static void tables_of_all_folders_are_sound (void **state)
{
    (void) state;
    const pg_vocabulary *words;
    pg_schema s = { 0 };
    check_ok (pg_keys_of_all (&words));
    check_ok (pg_schema_create (&s, words));
    assert_true (s.n > 100);
    assert_ptr_equal (pg_scene_key (s.n - 1), s.row[s.n - 1]);
    assert_null (pg_scene_key (s.n));
    for (size_t k = 0; k < s.n; k++) {
        const pg_key *row = s.row[k];
        pg_measure m;
        int wrong;
        assert_true (row->path && *row->path && row->doc && *row->doc);
        if (row->unit && strcmp (row->unit, "bool") != 0)
            check_ok (pg_measure_read (&m, row->unit, strcspn (row->unit, "|")));
        pg_range_holds (row->range, 0, &wrong);
        if (wrong) print_error ("range of %s: %s\n", row->path, row->range);
        assert_false (wrong);
        if (row->kind == PG_NAME) assert_non_null (pg_key_choices (row));
        if (row->group) assert_true (strstr (row->group, ":one") || strstr (row->group, ":most"));
        for (size_t j = 0; j < k; j++)
            if (strcmp (s.row[j]->path, row->path) == 0 && same_shape (s.row[j]->kind, row->kind)) {
                print_error ("two rows for %s\n", row->path);
                fail ();
            }
    }
    pg_schema_clear (&s);
}

static void defaults_of_all_folders_hold (void **state)
{
    (void) state;
    pg_scene *s = NULL;
    pg_status status = pg_scene_parse (&s, "dimension: 2\n", "x.yaml");
    if (status != PG_OK) assert_null (strstr (pg_last_error (), "default: "));
    pg_scene_free (&s);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (help_tells_all_of_a_key),
        cmocka_unit_test (help_finds_keys_without_brackets_and_by_last_word),
        cmocka_unit_test (help_of_a_map_lists_what_is_below),
        cmocka_unit_test (help_names_the_partners_of_a_group),
        cmocka_unit_test (unknown_help_names_the_nearest_key),
        cmocka_unit_test (manual_has_every_key_once),
        cmocka_unit_test (public_inquiry_knows_the_scene_keys),
        cmocka_unit_test (nearest_names_forgive_small_slips),
        cmocka_unit_test (hash_agrees_with_published_values),
        cmocka_unit_test (tables_of_all_folders_are_sound),
        cmocka_unit_test (defaults_of_all_folders_hold),
    };
    return cmocka_run_group_tests_name ("scene/inquiry", tests, NULL, NULL);
}

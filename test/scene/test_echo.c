/* SPDX-License-Identifier: GPL-3.0-or-later
 * A scene as JSON: what was written, word for word, with overrides; read again it is the same scene; words
 * that JSON must quote; memory that fails. */
#include "plate.h"
#include <string.h>

static const char plate[] =
    "title: a plate\n"
    "dimension: 2\n"
    "spacing: 2 mm\n"
    "cracks: [{from: [-1 mm, 2e-3]}, {from: [0, 0.5 m], width: 1 um}]\n"
    "materials: {rock: {youngs_modulus: 10 GPa, density: 2500 kg/m3}}\n"
    "failure: {fracture_energy: 5 J/m2}\n"
    "method: {horizon: 2.5 spacing, check: yes}\n"
    "sets: {top: {where: y > 3 mm, angle: [[80 deg, 100 deg], [260 deg, 280 deg]]}}\n"
    "load: {pressure: 1 MPa * t}\n";

static pg_scene *read_with (const char *text, size_t nset, const char *const *set)
{
    pg_scene *scene = NULL;
    check_ok (plate_read_with (&scene, text, nset, set));
    return scene;
}

/* The echo of a scene; the caller frees it. */
static char *echo_of (const char *text, size_t nset, const char *const *set)
{
    pg_scene *scene = read_with (text, nset, set);
    char *json = NULL;
    check_ok (pg_scene_echo (&json, scene));
    pg_scene_free (&scene);
    return json;
}

static void values (void **unused)
{
    (void) unused;
    static const char *const set[] = { "spacing=1.5e-3", "title='a \"b\" \\ c'" };
    char *json = echo_of (plate, 2, set);
    assert_non_null (strstr (json, "\"spacing\": 1.5e-3"));
    assert_non_null (strstr (json, "\"title\": \"a \\\"b\\\" \\\\ c\""));
    pg_free (json);
}

/* JSON is YAML: the echo is a scene whose echo is the same. */
static void again (void **unused)
{
    (void) unused;
    char *json = echo_of (plate, 0, NULL), *twice = echo_of (json, 0, NULL);
    assert_string_equal (json, twice);
    pg_free (json);
    pg_free (twice);
}

/* What looks like a number but is none in JSON stays a text, as do texts in quotes. */
static void words (void **unused)
{
    (void) unused;
    static const struct { const char *set, *echo; } word[] = {
        { "title=1", "\"title\": 1" },          { "title='1'", "\"title\": \"1\"" },
        { "title=.5", "\"title\": \".5\"" },    { "title=1.", "\"title\": \"1.\"" },
        { "title=+1", "\"title\": \"+1\"" },    { "title=007", "\"title\": \"007\"" },
        { "title=1e999", "\"title\": \"1e999\"" }, { "title=-0.5E+3", "\"title\": -0.5E+3" },
        { "method.check=true", "\"check\": true" }, { "title='true'", "\"title\": \"true\"" },
        { "title=on", "\"title\": \"on\"" },
        { "title=\"a\\tb\\u0001\"", "\"title\": \"a\\u0009b\\u0001\"" } };
    for (size_t k = 0; k < sizeof word / sizeof *word; k++) {
        char *json = echo_of (plate, 1, &word[k].set);
        if (!strstr (json, word[k].echo)) fail_msg ("%s gives %s", word[k].set, json);
        pg_free (json);
    }
}

static void memory (void **unused)
{
    (void) unused;
    pg_scene *scene = read_with (plate, 0, NULL);
    char *json = NULL;
    pg_memory_fail_at (1);
    assert_int_equal (pg_scene_echo (&json, scene), PG_E_MEMORY);
    pg_memory_fail_at (0);
    assert_null (json);
    pg_scene_free (&scene);
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (values), cmocka_unit_test (again),
                                        cmocka_unit_test (words), cmocka_unit_test (memory) };
    return cmocka_run_group_tests (tests, NULL, NULL);
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * Wrong scenes and the exact words they are answered with. */
#include "plate.h"

static void refused (const char *text, size_t nset, const char *const *set, const char *words)
{
    pg_scene *s = NULL;
    check_fails (plate_read_with (&s, text, nset, set), PG_E_SCENE);
    assert_null (s);
    assert_string_equal (pg_last_error (), words);
}

#define REFUSED(text, words) refused ((text), 0, NULL, (words))
#define REFUSED_SET(set, words) \
    do { \
        const char *const set_[] = { set }; \
        refused (PLATE_HEAD, 1, set_, (words)); \
    } while (0)

static void unknown_keys_name_the_nearest (void **state)
{
    (void) state;
    REFUSED (PLATE_HEAD "method: {horizn: 3 mm}\n",
             "plate.yaml:4:10: method.horizn = 3 mm: unknown key; did you mean horizon?");
    REFUSED (PLATE_HEAD "tile: x\n", "plate.yaml:4:1: tile = x: unknown key; did you mean title?");
    REFUSED (PLATE_HEAD "density: 1 kg/m3\n",
             "plate.yaml:4:1: density = 1 kg/m3: unknown key here; it belongs at materials.{}.density");
    REFUSED (PLATE_HEAD "output: {zzz: 1}\n",
             "plate.yaml:4:10: output.zzz = 1: unknown key; known here: fields");
    REFUSED (PLATE_HEAD "cracks:\n  - from: [0, 0]\n    wdith: 2 mm\n",
        "plate.yaml:6:5: cracks[0].wdith = 2 mm: unknown key; did you mean width?");
    REFUSED (PLATE_HEAD "method: {{}: 1}\n", "plate.yaml:4:10: a key must be a plain word");
}

static void doubled_keys_name_the_first (void **state)
{
    (void) state;
    REFUSED (PLATE_HEAD "spacing: 3 mm\n", "plate.yaml:4:1: spacing = 3 mm: is given twice, first in line 2");
}

static void values_out_of_range_name_the_range (void **state)
{
    (void) state;
    REFUSED ("dimension: 2\nspacing: 1 mm\nmaterials:\n  rock:\n    youngs_modulus: 1 GPa\n    "
             "poissons_ratio: 0.6\n",
             "plate.yaml:6:5: materials.rock.poissons_ratio = 0.6: must lie in [0, 0.5)");
    REFUSED (PLATE_HEAD "cracks: [{from: [0, 0], width: -1 um}]\n",
             "plate.yaml:4:25: cracks[0].width = -1 um: must lie in [0, inf) m");
    REFUSED (PLATE_HEAD "method: {levels: 0}\n", "plate.yaml:4:10: method.levels = 0: must lie in [1, 100]");
    REFUSED (PLATE_HEAD "method: {horizon: -2 spacing}\n",
             "plate.yaml:4:10: method.horizon = -2 spacing: must lie in (0, inf)");
    REFUSED (PLATE_HEAD "load: {friction_angle: 90 deg}\n",
             "plate.yaml:4:8: load.friction_angle = 90 deg: must lie in [0, pi/2) rad");
}

static void wrong_units_name_the_right_one (void **state)
{
    (void) state;
    REFUSED ("dimension: 2\nspacing: 1 mm\nmaterials: {rock: {youngs_modulus: 72 mm}}\n",
             "plate.yaml:3:20: materials.rock.youngs_modulus = 72 mm: 'mm' does not fit: expected Pa, for "
             "example 10 GPa");
    REFUSED (PLATE_HEAD "load: {pressure: 2 mm*t}\n",
        "plate.yaml:4:8: load.pressure = 2 mm*t: column 1: the result is in m s, expected Pa");
    REFUSED (PLATE_HEAD "sets: {top: {where: y > }}\n",
        "plate.yaml:4:14: sets.top.where = y >: column 4: a number or a name is missing at the end");
    REFUSED (PLATE_HEAD "load: {pressure: 1/0}\n",
             "plate.yaml:4:8: load.pressure = 1/0: has no finite value");
    REFUSED (PLATE_HEAD "method: {levels: 2.5}\n",
             "plate.yaml:4:10: method.levels = 2.5: must be a whole number");
    REFUSED (PLATE_HEAD "method: {levels: 5 mm}\n",
             "plate.yaml:4:10: method.levels = 5 mm: must be a whole number");
    REFUSED (PLATE_HEAD "method: {check: maybe}\n",
             "plate.yaml:4:10: method.check = maybe: must be on or off");
}

static void unknown_choices_list_the_choices (void **state)
{
    (void) state;
    REFUSED (PLATE_HEAD "method: {kernel: gausian}\n",
             "plate.yaml:4:10: method.kernel = gausian: must be one of constant, quadratic, gaussian; did "
             "you mean gaussian?");
    REFUSED (PLATE_HEAD "output: {fields: [stress, heat]}\n",
        "plate.yaml:4:27: output.fields[1] = heat: must be one of displacement, damage, stress");
    REFUSED ("dimension: 4\nspacing: 1 mm\nmaterials: {}\n",
             "plate.yaml:1:1: dimension = 4: must be one of 1, 2, 3");
}

static void wrong_shapes_say_what_belongs_there (void **state)
{
    (void) state;
    REFUSED ("dimension: 2\nspacing: [1, 2]\nmaterials: {}\n",
             "plate.yaml:2:1: spacing: must be a number with a unit of m, for example 5 mm, not a list");
    REFUSED (PLATE_HEAD "method: fast\n",
             "plate.yaml:4:1: method = fast: must be a map (key: value), not a single value");
    REFUSED (PLATE_HEAD "cracks: {from: [0, 0]}\n", "plate.yaml:4:1: cracks: must be a list, not a map");
    REFUSED (PLATE_HEAD "method: {kernel: {a: b}}\n",
        "plate.yaml:4:10: method.kernel: must be one of constant|quadratic|gaussian, not a map");
    REFUSED (PLATE_HEAD "cracks: [{from: [0, [1]]}]\n",
             "plate.yaml:4:21: cracks[0].from[1]: must be a number");
    REFUSED ("dimension: 2\nspacing:\nmaterials: {}\n",
             "plate.yaml:2:1: spacing: has no value: must be a number with a unit of m, for example 5 mm");
    REFUSED (PLATE_HEAD "sets: {a.b: {side: left}}\n",
             "plate.yaml:4:8: sets.a.b: a name has 1 to 63 characters without . = [ ] { }");
}

static void vectors_of_wrong_length_name_the_dimension (void **state)
{
    (void) state;
    REFUSED (PLATE_HEAD "cracks: [{from: [0, 0, 0]}]\n",
             "plate.yaml:4:11: cracks[0].from: needs 2 numbers in 2D, has 3");
    REFUSED (PLATE_HEAD "cracks: [{from: 0}]\n",
             "plate.yaml:4:11: cracks[0].from = 0: needs 2 numbers in 2D, has 1");
    REFUSED ("spacing: 1 mm\nmaterials: {}\ncracks: [{from: []}]\n",
             "plate.yaml:1:1: dimension: is missing: Number of space dimensions.\n"
             "plate.yaml:3:11: cracks[0].from: needs 1 to 3 numbers, has 0");
}

static void missing_keys_stand_at_their_parent (void **state)
{
    (void) state;
    REFUSED ("# only a title\ntitle: x\n",
             "plate.yaml:1:1: dimension: is missing: Number of space dimensions.\n"
             "plate.yaml:1:1: spacing: is missing: Distance of points.\nplate.yaml:1:1: materials: is "
             "missing: Materials by name.");
    REFUSED ("dimension: 2\nspacing: 1 mm\nmaterials:\n  rock: {density: 1}\n",
             "plate.yaml:4:3: materials.rock.youngs_modulus: is missing: Young's modulus.");
    REFUSED (PLATE_HEAD "cracks:\n  - {from: [0, 0]}\n  - {width: 1 mm}\n",
             "plate.yaml:6:5: cracks[1].from: is missing: First end.");
}

static void groups_want_one_or_at_most_one (void **state)
{
    (void) state;
    REFUSED (PLATE_HEAD "failure: {exclude: a}\n",
             "plate.yaml:4:1: failure: give exactly one of critical_stretch, fracture_energy");
    REFUSED (PLATE_HEAD "failure: {critical_stretch: 1 %, fracture_energy: 5 J/m2}\n",
             "plate.yaml:4:34: failure.fracture_energy = 5 J/m2: give exactly one of critical_stretch, "
             "fracture_energy");
    REFUSED (PLATE_HEAD "sets: {a: {where: x > 0, side: left}}\n",
             "plate.yaml:4:26: sets.a.side = left: give at most one of where, side");
}

static void broken_yaml_names_the_place (void **state)
{
    (void) state;
    REFUSED ("dimension: 2\n\tspacing: 1 mm\n",
             "plate.yaml:2:1: not valid YAML: found a tab character that violates indentation while "
             "scanning a plain scalar (indent with spaces, not tabs)");
    REFUSED (
        "method:\n\tkernel: gaussian\n",
        "plate.yaml:2:1: not valid YAML: found character that cannot start any token while scanning for the "
        "next token (indent with spaces, not tabs)");
    REFUSED (
        "a: [1, 2\nb: 3\n",
        "plate.yaml:2:2: not valid YAML: did not find expected ',' or ']' while parsing a flow sequence");
    REFUSED (
        "a: *b\n",
        "plate.yaml:1:4: not valid YAML: found undefined alias (a text that begins with * needs quotes)");
    REFUSED ("a: 1\nb: \xFF\n", "plate.yaml:2:4: not a text in UTF-8: invalid leading UTF-8 octet");
    REFUSED ("a: 1\n---\nb: 2\n", "plate.yaml:3:1: a second document: a scene is one document");
    REFUSED ("", "plate.yaml:1:1: the scene is empty");
    REFUSED ("# nothing\n", "plate.yaml:1:1: the scene is empty");
    REFUSED ("- a\n- b\n", "plate.yaml:1:1: a scene is a map (key: value)");
    REFUSED ("just text\n", "plate.yaml:1:1: a scene is a map (key: value)");
    REFUSED ("title: \"a\\0b\"\n", "plate.yaml:1:1: a text with a zero character");
}

/* Brackets by the hundred thousand: refused at the first that is too much, where libyaml alone looks at all
 * of them for every one. */
static void deep_nesting_is_refused_at_its_depth (void **state)
{
    (void) state;
    enum { DEEP = 1000000 };
    static char text[2 * DEEP + 8];
    strcpy (text, "a: ");
    for (int pair = 0; pair < 2; pair++) {
        for (int k = 0; k < DEEP; k++) text[3 + k] = pair ? '{' : '[';
        text[3 + DEEP] = 0;
        REFUSED (text, "plate.yaml:1:34: nested too deeply");
    }
    for (int k = 0; k < 50000; k++) memcpy (text + 2 * k, "- ", 3);
    REFUSED (text, "plate.yaml:1:63: nested too deeply");
}

static void aliases_cannot_grow_without_end (void **state)
{
    (void) state;
    REFUSED ("title: &a [*a]\n", "plate.yaml:1:8: nested too deeply");
    REFUSED ("a: &a [1,1,1,1,1,1,1,1,1,1]\nb: &b [*a,*a,*a,*a,*a,*a,*a,*a,*a,*a]\nc: &c "
             "[*b,*b,*b,*b,*b,*b,*b,*b,*b,*b]\n"
             "d: &d [*c,*c,*c,*c,*c,*c,*c,*c,*c,*c]\n",
             "plate.yaml:1:18: too many repeated parts (aliases)");
}

static void all_faults_come_in_the_order_of_lines (void **state)
{
    (void) state;
    REFUSED ("spacing: 0\nmaterials:\n  rock: {youngs_modulus: 1 s, density: x}\nmethod: {kernel: q, levels: "
             "500}\nnonsense: 1\n",
             "plate.yaml:1:1: spacing = 0: must lie in (0, inf) m\n"
             "plate.yaml:1:1: dimension: is missing: Number of space dimensions.\n"
             "plate.yaml:3:10: materials.rock.youngs_modulus = 1 s: 's' does not fit: expected Pa, for "
             "example 10 GPa\n"
             "plate.yaml:3:31: materials.rock.density = x: must be a number with a unit of kg/m3, for "
             "example 2500 kg/m3\n"
             "plate.yaml:4:10: method.kernel = q: must be one of constant, quadratic, gaussian\n"
             "plate.yaml:4:21: method.levels = 500: must lie in [1, 100]\n"
             "plate.yaml:5:1: nonsense = 1: unknown key; known here: title, dimension, spacing, cracks, "
             "materials, "
             "failure, method, sets, load, output");
}

static void more_than_fifty_faults_are_counted (void **state)
{
    (void) state;
    static char text[40000];
    strcpy (text, PLATE_HEAD "cracks:\n");
    for (int k = 0; k < 1300; k++) strcat (text, " - {from: [0, 0], w: 1}\n");
    pg_scene *s = NULL;
    check_fails (plate_read (&s, text), PG_E_SCENE);
    size_t lines = 1;
    for (const char *c = pg_last_error (); *c; c++) lines += *c == '\n';
    assert_int_equal (lines, 51);
    check_contains (pg_last_error (), "\n... and 1250 more");
}

static void long_and_unprintable_values_are_cut (void **state)
{
    (void) state;
    REFUSED (PLATE_HEAD "method: {check: \"a\\tb\\e[31m\"}\n",
             "plate.yaml:4:10: method.check = a?b?[31m: must be on or off");
    REFUSED (PLATE_HEAD
             "method: {check: 0123456789012345678901234567890123456789012345678901234567890123456789}\n",
             "plate.yaml:4:10: method.check = 012345678901234567890123456789012345678901234567890123456...: "
             "must be on or off");
}

static void override_faults_name_the_override (void **state)
{
    (void) state;
    REFUSED_SET ("method.horizon=2 kg", "--set method.horizon=2 kg: method.horizon = 2 kg: 'kg' does not "
                                        "fit: expected m or spacing, for example 5 mm or 2 spacing");
    REFUSED_SET ("method.horizn=2 mm",
                 "--set method.horizn=2 mm: method.horizn = 2 mm: unknown key; did you mean horizon?");
    REFUSED_SET ("cracks[1].width=2 mm", "--set cracks[1].width=2 mm: leads past the end of a list");
    REFUSED_SET ("spacing.x=2 mm", "--set spacing.x=2 mm: leads through something that is not a map");
    REFUSED_SET ("spacing[0]=2 mm", "--set spacing[0]=2 mm: leads through something that is not a list");
    REFUSED_SET ("spacing", "--set spacing: must have the form key=value");
    REFUSED_SET ("=3", "--set =3: must have the form key=value");
    REFUSED_SET ("a..b=3", "--set a..b=3: is not a path such as cracks[0].from");
    REFUSED_SET ("cracks[x]=3", "--set cracks[x]=3: is not a path such as cracks[0].from");
    REFUSED_SET (
        "cracks=[",
        "--set cracks=[: not valid YAML: did not find expected node content while parsing a flow node");
    REFUSED_SET ("cracks[0].width=1 mm",
                 "--set cracks[0].width=1 mm: cracks[0].from: is missing: First end.");
}

static void faults_of_other_folders_join_in (void **state)
{
    (void) state;
    pg_scene *s = NULL;
    check_ok (plate_read (&s, PLATE_HEAD "method:\n  kernel: gaussian\n"));
    check_ok (pg_scene_verdict (s));
    pg_scene_fault (s, "method.kernel", "is not for %d points", 7);
    pg_scene_fault (s, "method.horizon", "is too small");
    pg_scene_fault (s, "spacing", "makes no point");
    pg_scene_fault (s, "materials.rock.density", "is needed for newmark");
    pg_scene_fault (s, "solver.kind", "is needed");
    check_fails (pg_scene_verdict (s), PG_E_SCENE);
    assert_string_equal (pg_last_error (),
        "plate.yaml:1:1: solver.kind: is needed\n"
        "plate.yaml:2:1: spacing = 2 mm: makes no point\n"
        "plate.yaml:3:13: materials.rock.density: is needed for newmark\n"
        "plate.yaml:4:1: method.horizon: is too small\n"
        "plate.yaml:5:3: method.kernel = gaussian: is not for 7 points");
    pg_scene_free (&s);
}

static void wrong_defaults_of_a_table_are_found (void **state)
{
    (void) state;
    static const pg_key keys[] = { { .path = "a", .kind = PG_NUMBER, .unit = "m", .fallback = "1 s" },
                                   { .path = "b", .kind = PG_NUMBER, .range = "0..1", .fallback = "2" } };
    static const pg_key_table table = { "wrong", keys, 2 };
    static const pg_vocabulary words = { .n = 1, .table = &table };
    pg_scene *s = NULL;
    check_fails (pg_scene_read (&s, "b: 1\n", 5, "x.yaml", 0, NULL, &words, 0), PG_E_SCENE);
    check_contains (pg_last_error (), "default: a = 1 s: 's' does not fit: expected m, for example 5 mm");
    check_contains (pg_last_error (), "x.yaml:1:1: b = 1: the range '0..1' of its key table is wrong");
}

static void files_that_cannot_be_read_are_named (void **state)
{
    (void) state;
    pg_scene *s = NULL;
    check_fails (pg_scene_load (&s, "/no/such/plate.yaml"), PG_E_FILE);
    assert_string_equal (pg_last_error (),
                         "/no/such/plate.yaml: cannot be opened: No such file or directory");
    check_fails (pg_scene_load (&s, "/"), PG_E_FILE);
    check_contains (pg_last_error (), "/: cannot be read: ");
    assert_null (s);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (unknown_keys_name_the_nearest),
        cmocka_unit_test (doubled_keys_name_the_first),
        cmocka_unit_test (values_out_of_range_name_the_range),
        cmocka_unit_test (wrong_units_name_the_right_one),
        cmocka_unit_test (unknown_choices_list_the_choices),
        cmocka_unit_test (wrong_shapes_say_what_belongs_there),
        cmocka_unit_test (vectors_of_wrong_length_name_the_dimension),
        cmocka_unit_test (missing_keys_stand_at_their_parent),
        cmocka_unit_test (groups_want_one_or_at_most_one),
        cmocka_unit_test (broken_yaml_names_the_place),
        cmocka_unit_test (aliases_cannot_grow_without_end),
        cmocka_unit_test (deep_nesting_is_refused_at_its_depth),
        cmocka_unit_test (all_faults_come_in_the_order_of_lines),
        cmocka_unit_test (more_than_fifty_faults_are_counted),
        cmocka_unit_test (long_and_unprintable_values_are_cut),
        cmocka_unit_test (override_faults_name_the_override),
        cmocka_unit_test (faults_of_other_folders_join_in),
        cmocka_unit_test (wrong_defaults_of_a_table_are_found),
        cmocka_unit_test (files_that_cannot_be_read_are_named),
    };
    return cmocka_run_group_tests_name ("scene/faults", tests, NULL, NULL);
}

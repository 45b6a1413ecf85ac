/* SPDX-License-Identifier: GPL-3.0-or-later
 * Scenes under memory failure and with random bytes changed: an answer always, no crash, no leak. */
#include "plate.h"

static const char text[] =
    "dimension: 2\nspacing: 2 mm\ncracks:\n  - {from: [-1 mm, 2e-3], width: 1 um}\n"
    "materials:\n  rock: &r {youngs_modulus: 10 GPa}\n  more: *r\nfailure: {critical_stretch: 1 %, exclude: "
    "[top]}\n"
    "sets: {top: {where: y > 3 mm and not x < 0, angle: [[80 deg, 100 deg]]}}\nload: {pressure: 1 MPa * t}\n";

static void sweep (const char *scene, pg_status expected)
{
    static const char *const set[] = { "method.kernel=gaussian", "cracks[1].from=[3, 4]" };
    pg_scene *s = NULL;
    size_t before = pg_memory_used (), k = 1;
    for (;; k++) {
        pg_memory_fail_at (k);
        pg_status status = plate_read_with (&s, scene, 2, set);
        pg_memory_fail_at (0);
        if (status != PG_E_MEMORY) {
            assert_int_equal (status, expected);
            break;
        }
        assert_null (s);
        assert_int_equal (pg_memory_used (), before);
    }
    assert_true (k > 50);
    pg_scene_free (&s);
    assert_int_equal (pg_memory_used (), before);
}

static void every_failing_allocation_is_survived (void **state)
{
    (void) state;
    sweep (text, PG_OK);
    sweep ("spacing: 0\nmaterials: {rock: {density: x}}\nnonsense: 1\n", PG_E_SCENE);
}

static void the_whole_parser_survives_too (void **state)
{
    (void) state;
    pg_scene *s = NULL;
    size_t before = pg_memory_used (), k = 1;
    pg_status status;
    do {
        pg_memory_fail_at (k++);
        status = pg_scene_parse (&s, "title: x\ndimension: 1\ncross_section: 2 mm2\n", "bar.yaml");
        pg_memory_fail_at (0);
        pg_scene_free (&s);
        assert_int_equal (pg_memory_used (), before);
    } while (status == PG_E_MEMORY);
    assert_true (k > 10);
}

static unsigned next_random (unsigned *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return *seed >> 8;
}

static void changed_bytes_never_crash (void **state)
{
    (void) state;
    static const char bytes[] = "{}[]:,-&*!|>'\"%@`# \n\t0123456789.eE+<=^()abxyt\\~?\x80\xC3\xFF\x01";
    unsigned seed = 20240607;
    size_t before = pg_memory_used (), good = 0, bad = 0;
    for (int round = 0; round < 2000; round++) {
        char wild[sizeof text + 8];
        size_t n = sizeof text - 1;
        memcpy (wild, text, sizeof text);
        for (unsigned k = next_random (&seed) % 4 + 1; k > 0; k--) {
            size_t at = next_random (&seed) % n;
            unsigned how = next_random (&seed) % 3;
            if (how == 0 && n > 20) memmove (wild + at, wild + at + 1, n-- - at);
            else if (how == 1 && n + 2 < sizeof wild) memmove (wild + at + 1, wild + at, ++n - at);
            wild[at < n ? at : n - 1] = bytes[next_random (&seed) % (sizeof bytes - 1)];
        }
        wild[n] = '\0';
        pg_scene *s = NULL;
        pg_status status = plate_read (&s, wild);
        assert_true (status == PG_OK || status == PG_E_SCENE);
        assert_true ((status == PG_OK) == (s != NULL));
        if (status != PG_OK) assert_true (strstr (pg_last_error (), "plate.yaml:") == pg_last_error ());
        if (status == PG_OK) good++;
        else bad++;
        pg_scene_free (&s);
        assert_int_equal (pg_memory_used (), before);
    }
    assert_true (good > 20 && bad > 1000);
}

static void changed_expressions_never_crash (void **state)
{
    (void) state;
    static const char seedling[] = "min(x, 3 mm)*sin(2*pi*t/(1 s)) + (y - 2e-3)^2/r and not z",
        bytes[] = "()*/+-^<>=!, .mnxyzrt0123456789e%sPa\xC2\xB5";
    unsigned seed = 7;
    size_t before = pg_memory_used ();
    for (int round = 0; round < 2000; round++) {
        char wild[sizeof seedling];
        memcpy (wild, seedling, sizeof wild);
        wild[10 + next_random (&seed) % (sizeof wild - 10)] = '\0';
        for (int k = 0; k < 3; k++)
            wild[next_random (&seed) % strlen (wild)] = bytes[next_random (&seed) % (sizeof bytes - 1)];
        pg_expression *e = NULL;
        pg_place at = { .x = 1, .t = 0.5 };
        pg_status status = pg_expression_compile (&e, wild, round % 2 ? "m" : "bool");
        assert_true (status == PG_OK || status == PG_E_SCENE);
        if (e) (void) pg_expression_value (e, &at);
        pg_expression_free (&e);
    }
    assert_int_equal (pg_memory_used (), before);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (every_failing_allocation_is_survived),
        cmocka_unit_test (the_whole_parser_survives_too),
        cmocka_unit_test (changed_bytes_never_crash),
        cmocka_unit_test (changed_expressions_never_crash),
    };
    return cmocka_run_group_tests_name ("scene/robustness", tests, NULL, NULL);
}

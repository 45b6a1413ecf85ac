/* SPDX-License-Identifier: GPL-3.0-or-later
 * JSON: valid (by a checker of its own), stable in order, escaped, and moved into place only when whole. */
#include "check.h"
#include "sample.h"
#include <ctype.h>
#include <signal.h>
#include <sys/resource.h>

static char text[20000];

static const char *slurp (const char *path)
{
    FILE *file = fopen (path, "r");
    assert_non_null (file);
    text[fread (text, 1, sizeof text - 1, file)] = 0;
    fclose (file);
    return text;
}

/* ---- a checker of the grammar: each function steps over one thing and returns NULL when it is not there */
static const char *value (const char *s);
static const char *blank (const char *s) { return s + strspn (s, " \n\t\r"); }

static const char *string (const char *s)
{
    if (*s++ != '"') return NULL;
    for (; *s != '"'; s++) {
        if ((unsigned char) *s < 0x20) return NULL;
        if (*s != '\\') continue;
        s++;
        if (*s == 'u') {
            for (int k = 1; k <= 4; k++) if (!isxdigit ((unsigned char) s[k])) return NULL;
            s += 4;
        } else if (!*s || !strchr ("\"\\/bfnrt", *s)) return NULL;
    }
    return s + 1;
}

static const char *number (const char *s)
{
    s += *s == '-';
    if (!isdigit ((unsigned char) *s) || (*s == '0' && isdigit ((unsigned char) s[1]))) return NULL;
    s += strspn (s, "0123456789");
    if (*s == '.') {
        if (!isdigit ((unsigned char) *++s)) return NULL;
        s += strspn (s, "0123456789");
    }
    if (*s == 'e' || *s == 'E') {
        s += 1 + (s[1] == '-' || s[1] == '+');
        if (!isdigit ((unsigned char) *s)) return NULL;
        s += strspn (s, "0123456789");
    }
    return s;
}

static const char *members (const char *s, char close)
{
    s = blank (s + 1);
    if (*s == close) return s + 1;
    for (;;) {
        if (close == '}') {
            s = string (s);
            if (!s || *(s = blank (s)) != ':') return NULL;
            s = blank (s + 1);
        }
        if (!(s = value (s))) return NULL;
        s = blank (s);
        if (*s == close) return s + 1;
        if (*s != ',') return NULL;
        s = blank (s + 1);
    }
}

static const char *value (const char *s)
{
    if (*s == '{') return members (s, '}');
    if (*s == '[') return members (s, ']');
    if (*s == '"') return string (s);
    if (strncmp (s, "null", 4) == 0) return s + 4;
    return number (s);
}

static int valid (const char *s)
{
    s = value (blank (s));
    return s && !*blank (s);
}

/* ---- tests --------------------------------------------------------------------------------------------- */
static void a_report_is_valid_and_in_order (void **state)
{
    (void) state;
    pg_json *j;
    const char *path = file_at ("report.json");
    check_ok (pg_json_create (&j, path));
    pg_json_open (j, NULL, '{');
    pg_json_text (j, "version", "0.1.0");
    pg_json_count (j, "points", 1961);
    pg_json_open (j, "energy", '{');
    pg_json_number (j, "strain", 0.1);
    pg_json_number (j, "kinetic", -1.5e-300);
    pg_json_shut (j);
    pg_json_open (j, "warnings", '[');
    pg_json_shut (j);
    pg_json_open (j, "skipped", '[');
    pg_json_open (j, NULL, '{');
    pg_json_text (j, "what", "factor");
    pg_json_shut (j);
    pg_json_text (j, NULL, "two");
    pg_json_number (j, NULL, NAN);
    pg_json_shut (j);
    pg_json_shut (j);
    check_ok (pg_json_close (&j));
    assert_null (j);
    assert_string_equal (
        slurp (path),
        "{\n  \"version\": \"0.1.0\",\n  \"points\": 1961,\n  \"energy\": {\n    \"strain\": 0.1,\n"
        "    \"kinetic\": -1.5e-300\n  },\n  \"warnings\": [],\n  \"skipped\": [\n    {\n      \"what\": "
        "\"factor\"\n    },\n"
        "    \"two\",\n    null\n  ]\n}\n");
    assert_true (valid (text));
}

static void the_checker_refuses_what_is_wrong (void **state)
{
    (void) state;
    static const char *const wrong[] = { "{",        "{\"a\":1,}", "[1 2]", "{a:1}",      "[01]",
                                         "[\"\n\"]", "[\"\\x\"]",  "[1.]",  "{\"a\":1}}", "[nan]" };
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) assert_false (valid (wrong[k]));
}

static void braces_may_be_left_to_the_writer (void **state)
{
    (void) state;
    pg_json *j;
    const char *path = file_at ("implicit.json");
    check_ok (pg_json_create (&j, path));
    pg_json_number (j, "a", 1);
    pg_json_open (j, "b", '[');
    pg_json_number (j, NULL, 2);
    check_ok (pg_json_close (&j));
    assert_string_equal (slurp (path), "{\n  \"a\": 1,\n  \"b\": [\n    2\n  ]\n}\n");
}

static void texts_are_escaped (void **state)
{
    (void) state;
    pg_json *j;
    const char *path = file_at ("escape.json");
    check_ok (pg_json_create (&j, path));
    pg_json_text (j, "k\"ey", "q\" b\\ n\n t\t c\x01 \xc2\xb5 bad\xff\xc2 end");
    pg_json_text (j, "none", NULL);
    check_ok (pg_json_close (&j));
    slurp (path);
    check_contains (text, "\"k\\\"ey\": \"q\\\" b\\\\ n\\n t\\t c\\u0001 \xc2\xb5 bad\\ufffd\\ufffd end\"");
    check_contains (text, "\"none\": null");
    assert_true (valid (text));
}

static void numbers_come_back_exactly (void **state)
{
    (void) state;
    const double number_of[] = { 0.1,     1.0 / 3, 2.0 / 3 * 1e-200, 1e300, 123456789012345680.0,
                                 -5e-324, INFINITY };
    pg_json *j;
    const char *path = file_at ("numbers.json");
    check_ok (pg_json_create (&j, path));
    pg_json_open (j, NULL, '[');
    for (int k = 0; k < 7; k++) pg_json_number (j, NULL, number_of[k]);
    check_ok (pg_json_close (&j));
    const char *s = slurp (path) + 1;
    assert_true (valid (text));
    for (int k = 0; k < 6; k++) {
        char *end;
        assert_true (strtod (s, &end) == number_of[k]);
        s = end + 1;
    }
    check_contains (s, "null");
}

static void nothing_shows_before_close (void **state)
{
    (void) state;
    pg_json *j;
    const char *path = file_at ("late.json");
    check_ok (pg_json_create (&j, path));
    pg_json_number (j, "a", 1);
    assert_int_not_equal (access (path, F_OK), 0);
    check_ok (pg_json_close (&j));
    assert_int_equal (access (path, F_OK), 0);
    assert_int_not_equal (access (file_at ("late.json.tmp"), F_OK), 0);
}

static void misuse_is_reported_and_leaves_no_file (void **state)
{
    (void) state;
    for (int kind = 0; kind < 4; kind++) {
        pg_json *j;
        const char *path = file_at ("misuse.json");
        check_ok (pg_json_create (&j, path));
        pg_json_open (j, NULL, '{');
        if (kind == 0) pg_json_number (j, NULL, 1);                 /* no key in a map      */
        if (kind == 1) pg_json_open (j, "a", '['), pg_json_number (j, "b", 1);
        if (kind == 2) pg_json_shut (j), pg_json_shut (j);
        if (kind == 3) pg_json_shut (j), pg_json_open (j, NULL, '{');
        check_fails (pg_json_close (&j), PG_E_USAGE);
        assert_null (j);
        assert_int_not_equal (access (path, F_OK), 0);
        assert_int_not_equal (access (file_at ("misuse.json.tmp"), F_OK), 0);
    }
}

static void a_full_disk_leaves_the_old_file (void **state)
{
    (void) state;
    pg_json *j;
    struct rlimit old, tight;
    char path[160], fresh[170];
    strcpy (path, file_at ("full.json"));
    snprintf (fresh, sizeof fresh, "%s.tmp", path);
    signal (SIGXFSZ, SIG_IGN);
    getrlimit (RLIMIT_FSIZE, &old);
    for (int round = 0; round < 2; round++) {
        check_ok (pg_json_create (&j, path));
        pg_json_open (j, NULL, '{');
        pg_json_number (j, "round", round);
        for (int k = 0; round && k < 3000; k++) {
            char key[20];
            snprintf (key, sizeof key, "k%d", k);
            pg_json_number (j, key, k);
        }
        tight = (struct rlimit) { round ? 4000 : old.rlim_cur, old.rlim_max };
        setrlimit (RLIMIT_FSIZE, &tight);
        pg_status status = pg_json_close (&j);
        setrlimit (RLIMIT_FSIZE, &old);
        assert_int_equal (status, round ? PG_E_FILE : PG_OK);
        if (round) check_contains (pg_last_error (), "full.json.tmp: File too large");
        assert_int_not_equal (access (fresh, F_OK), 0);
        assert_true (valid (slurp (path)));
        check_contains (text, "\"round\": 0");
    }
}

static void a_folder_that_is_missing_is_named (void **state)
{
    (void) state;
    pg_json *j;
    check_fails (pg_json_create (&j, file_at ("missing/a.json")), PG_E_FILE);
    check_contains (pg_last_error (), "No such file");
}

static void any_allocation_may_fail (void **state)
{
    (void) state;
    size_t before = pg_memory_used ();
    pg_status status = PG_E_MEMORY;
    for (size_t k = 1; status != PG_OK && k < 10; k++) {
        pg_json *j;
        pg_memory_fail_at (k);
        status = pg_json_create (&j, file_at ("sweep.json"));
        pg_memory_fail_at (0);
        if (status == PG_OK) check_ok (pg_json_close (&j));
        assert_int_equal (pg_memory_used (), before);
    }
    assert_int_equal (status, PG_OK);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (a_report_is_valid_and_in_order),
        cmocka_unit_test (the_checker_refuses_what_is_wrong),
        cmocka_unit_test (braces_may_be_left_to_the_writer),
        cmocka_unit_test (texts_are_escaped),
        cmocka_unit_test (numbers_come_back_exactly),
        cmocka_unit_test (nothing_shows_before_close),
        cmocka_unit_test (misuse_is_reported_and_leaves_no_file),
        cmocka_unit_test (a_folder_that_is_missing_is_named),
        cmocka_unit_test (a_full_disk_leaves_the_old_file),
        cmocka_unit_test (any_allocation_may_fail),
    };
    return cmocka_run_group_tests_name ("io/output/json", tests, NULL, remove_folder);
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * The program of all tests of a folder. It runs the test whose name it was called by: build/release/test/
 * base/test_dense is a link to build/release/test/base/tests. TESTS: TEST (test_dense) ... (Makefile). */
#include <stdio.h>
#include <string.h>

#define TEST(name) int main_of_##name (void);
TESTS
#undef TEST

int main (int argc, char **argv)
{
#define TEST(name) { #name, main_of_##name },
    static const struct {
        const char *name;
        int (*run) (void);
    } tests[] = { TESTS };
    const char *name = argc > 0 ? argv[0] : "", *slash = strrchr (name, '/');
    if (slash) name = slash + 1;
    for (size_t k = 0; k < sizeof tests / sizeof *tests; k++)
        if (strcmp (tests[k].name, name) == 0) return tests[k].run ();
    fprintf (stderr, "'%s' is no test of this folder; a link with one of these names calls one:\n", name);
    for (size_t k = 0; k < sizeof tests / sizeof *tests; k++) fprintf (stderr, "  %s\n", tests[k].name);
    return 2;
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * The seeds of the fuzzers, the wrong scenes and all that fuzzing ever found, once more and without
 * libFuzzer. Run from the top folder. */
#include "check.h"
#define FUZZ_REPLAY
#define FUZZ_BROKEN(what) \
    do { \
        print_error ("%s: broken: %s; last error: %s\n", replayed, (what), pg_last_error ()); \
        _fail (__FILE__, __LINE__); \
    } while (0)
static char replayed[300];

#define LLVMFuzzerTestOneInput fuzz_scene
#include "fuzz_scene.c"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_points
#include "fuzz_points.c"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_expression
#include "fuzz_expression.c"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_mesh
#include "fuzz_mesh.c"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_table
#include "fuzz_table.c"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_result
#include "fuzz_result.c"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_checkpoint
#include "fuzz_checkpoint.c"
#undef LLVMFuzzerTestOneInput
#include <dirent.h>

typedef int (*fuzzer) (const uint8_t *data, size_t size);

static void replay_file (fuzzer f)
{
    size_t cap = 1 << 17, n;
    uint8_t *data = pg_calloc (cap, 1);
    FILE *file = fopen (replayed, "rb");
    assert_non_null (data);
    assert_non_null (file);
    n = fread (data, 1, cap, file);
    fclose (file);
    f (data, n);
    pg_free (data);
}

/* All files of a folder whose names begin so. */
static size_t replay (fuzzer f, const char *folder, const char *start)
{
    size_t count = 0;
    DIR *d = opendir (folder);
    if (!d) print_error ("no folder %s: run tests from the top of the tree\n", folder);
    assert_non_null (d);
    for (struct dirent *e; (e = readdir (d)); ) {
        if (e->d_name[0] == '.' || strncmp (e->d_name, start, strlen (start)) != 0) continue;
        snprintf (replayed, sizeof replayed, "%s/%s", folder, e->d_name);
        replay_file (f);
        count++;
    }
    closedir (d);
    return count;
}

static void scenes_that_were_found_are_answered (void **state)
{
    (void) state;
    assert_true (replay (fuzz_scene, "test/fuzz/found", "scene-") > 0);
}

static void seeds_are_answered (void **state)
{
    (void) state;
    assert_true (replay (fuzz_scene, "test/fuzz/seed_scene", "") > 3);
    assert_true (replay (fuzz_points, "test/fuzz/seed_points", "") > 2);
    assert_true (replay (fuzz_expression, "test/fuzz/seed_expression", "") > 8);
    assert_true (replay (fuzz_mesh, "test/fuzz/seed_mesh", "") > 8);
    assert_true (replay (fuzz_table, "test/fuzz/seed_table", "") > 2);
    assert_true (replay (fuzz_result, "test/fuzz/seed_result", "") > 1);
    assert_true (replay (fuzz_checkpoint, "test/fuzz/seed_checkpoint", "") > 2);
}

static void other_files_that_were_found_are_answered (void **state)
{
    (void) state;
    replay (fuzz_mesh, "test/fuzz/found", "mesh-");
    replay (fuzz_points, "test/fuzz/found", "points-");
    replay (fuzz_expression, "test/fuzz/found", "expression-");
    replay (fuzz_table, "test/fuzz/found", "table-");
    replay (fuzz_result, "test/fuzz/found", "result-");
    replay (fuzz_checkpoint, "test/fuzz/found", "checkpoint-");
}

static void wrong_scenes_leave_nothing_behind (void **state)
{
    (void) state;
    assert_true (replay (fuzz_scene, "test/app/cli/wrong", "") > 90);
}

/* Also a file that was not written to its end. */
static void any_seed_cut_anywhere_is_answered (void **state)
{
    (void) state;
    uint8_t text[4096];
    FILE *file = fopen ("test/fuzz/seed_scene/block.yaml", "rb");
    assert_non_null (file);
    size_t n = fread (text, 1, sizeof text, file);
    fclose (file);
    snprintf (replayed, sizeof replayed, "block.yaml, cut");
    for (size_t k = 0; k < n; k += 3) fuzz_scene (text, k);
}

static void any_mesh_cut_anywhere_is_answered (void **state)
{
    (void) state;
    static const char *const names[] = { "box_22.msh", "box_41b.msh", "disk_22b.msh", "disk_41.msh" };
    for (int i = 0; i < 4; i++) {
        uint8_t text[1 << 13];
        snprintf (replayed, sizeof replayed, "test/fuzz/seed_mesh/%s", names[i]);
        FILE *file = fopen (replayed, "rb");
        assert_non_null (file);
        size_t n = fread (text, 1, sizeof text, file);
        fclose (file);
        for (size_t k = 0; k < n; k += 5) fuzz_mesh (text, k);
    }
}

/* Each count and each first value of three runs, set to what no run can have: it goes on, or it is refused by
 * name. */
static void any_wrong_word_of_a_checkpoint_is_answered (void **state)
{
    (void) state;
    static const uint8_t to[] = { 0, 4, 9 };           /* -1, 17, the largest */
    for (int which = 0; which < CHECKPOINT_SCENES; which++)
        for (int part = which; part < 60; part += longer () ? 2 + which : 3 + 2 * which)
            for (int at = part % 4; at < 15; at += 7) {
                snprintf (replayed, sizeof replayed, "scene %d, part %d, word %d", which, part, at);
                fuzz_checkpoint ((const uint8_t[]){ (uint8_t) which, (uint8_t) part, (uint8_t) at,
                                                    to[(part + at) % 3] },
                                 4);
            }
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (scenes_that_were_found_are_answered),
        cmocka_unit_test (other_files_that_were_found_are_answered),
        cmocka_unit_test (seeds_are_answered),
        cmocka_unit_test (wrong_scenes_leave_nothing_behind),
        cmocka_unit_test (any_seed_cut_anywhere_is_answered),
        cmocka_unit_test (any_mesh_cut_anywhere_is_answered),
        cmocka_unit_test (any_wrong_word_of_a_checkpoint_is_answered),
    };
    return cmocka_run_group_tests_name ("fuzz/replay", tests, NULL, NULL);
}

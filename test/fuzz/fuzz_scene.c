/* SPDX-License-Identifier: GPL-3.0-or-later
 * Any bytes as a scene: an answer always, each fault with its place, no memory lost. A right scene with a
 * small body is built, too, and passes all that `perigal check` asks of it. */
#include "fuzz.h"
#include "perigal/results.h"
#include "scene/keys/keys.h"
#include <math.h>

enum { MOST_PAIRS = 60000 };                           /* evaluation points times neighbours */

static const char name[] = "test/fuzz/seed_points/scene.yaml";  /* `points: plate.csv` is found beside it */

static int answered (pg_status status)
{
    if (status == PG_OK) return 1;
    return (status == PG_E_SCENE && strncmp (pg_last_error (), name, sizeof name - 1) == 0
            && pg_last_error ()[sizeof name - 1] == ':')
           || status == PG_E_LIMIT;
}

/* Is the body so small that building it takes no time? The bounding box is filled with points. */
static int small (const pg_scene *scene)
{
    pg_body body;
    int dim = (int) pg_scene_integer (scene, "dimension"),
        gauss = pg_scene_has (scene, "method.gauss_points")
                    ? (int) pg_scene_integer (scene, "method.gauss_points")
                    : 3;
    const char *points = pg_scene_text (scene, "points");
    double n = 1, seen = 1, spacing = pg_scene_number (scene, "spacing");
    if (points) return strcmp (points, "plate.csv") == 0 && pg_scene_count (scene, "cracks") < 10;
    if (pg_body_read (&body, scene) != PG_OK) return 1;    /* refused at once when it is built */
    double reach = pg_scene_length (scene, spacing, "method.horizon") / spacing;
    for (int k = 0; k < dim; k++) {
        double along = 2 + (body.high[k] - body.low[k]) / spacing;
        n *= along * gauss;
        seen *= fmin (along, 2 * reach + 1);
    }
    n *= 1 + (double) (body.n + pg_scene_count (scene, "sets") + pg_scene_count (scene, "cracks"));
    pg_body_clear (&body);
    return n * seen <= MOST_PAIRS;
}

static int honest (pg_status status)
{
    return status == PG_OK || status == PG_E_SINGULAR || status == PG_E_NOT_SPD || status == PG_E_EQUILIBRIUM
           || status == PG_E_LIMIT;
}

/* Two steps: they may fail with a reason; an accepted state is finite. */
static void advance (const pg_scene *scene, const pg_problem *problem)
{
    pg_solver_options options = { 0 };
    pg_solver *solver = NULL;
    pg_state *state = NULL;
    pg_step step;
    pg_status status = pg_solver_options_read (&options, problem, scene);
    FUZZ_EXPECT (answered (status));
    /* break rounds take their time */
    options.max_iterations = options.max_iterations < 20 ? options.max_iterations : 20;
    if ((options.flags & PG_SOLVER_EXPLICIT)) options.end = 0, options.time_steps = 50;
    if ((options.flags & PG_SOLVER_STAGED) && !PG_OWN (pg_stages_options, &options)->hold
        && PG_OWN (pg_stages_options, &options)->stages > 50)
        PG_OWN (pg_stages_options, &options)->stages = 50;
    if (status == PG_OK) {
        FUZZ_EXPECT (honest (status = pg_solver_create (&solver, problem, &options)) || answered (status));
        if (status == PG_OK) status = pg_state_create (&state, problem, pg_solver_components (solver));
    }
    for (int k = 0; k < 2 && status == PG_OK && !pg_solver_done (solver, state); k++) {
        status = pg_solver_step (solver, state, &step);
        FUZZ_EXPECT (honest (status));
        for (size_t i = 0; status == PG_OK && i < state->ndof; i++) FUZZ_EXPECT (isfinite (state->d[i]));
    }
    if (status != PG_OK) FUZZ_EXPECT (*pg_last_error ());
    pg_state_free (&state);
    pg_solver_free (&solver);
}

static void build (const pg_scene *scene)
{
    pg_problem *problem = NULL;
    pg_status status = pg_problem_build (&problem, scene, 1);
    FUZZ_EXPECT (answered (status));
    FUZZ_EXPECT ((status == PG_OK) == (problem != NULL));
    if (problem) {
        FUZZ_EXPECT (problem->cloud.n > 0 && isfinite (problem->cloud.h) && problem->cloud.h > 0);
        FUZZ_EXPECT (answered (pg_result_check (scene, problem)));
        if (problem->cloud.n <= 40 && problem->bonds.first[PG_BOND_SETS] <= 2000
            && strlen (pg_scene_source (scene)) % 3 == 0)
            advance (scene, problem);
    }
    pg_problem_free (&problem);
}

int LLVMFuzzerTestOneInput (const uint8_t *data, size_t size)
{
    pg_scene *scene = NULL;
    size_t used = pg_memory_used ();
    const pg_vocabulary *words;
    if (size > LONGEST) return 0;
    FUZZ_EXPECT (pg_keys_of_all (&words) == PG_OK);
    pg_status status = pg_scene_read (&scene, (const char *) data, size, name, 0, NULL, words, 0);
    FUZZ_EXPECT (answered (status) && status != PG_E_LIMIT);
    FUZZ_EXPECT ((status == PG_OK) == (scene != NULL));
    if (scene && small (scene)) build (scene);
    pg_scene_free (&scene);
    FUZZ_EXPECT (pg_memory_used () == used);
    return 0;
}

#ifndef FUZZ_REPLAY
/* ---- mutations that keep a scene a scene --------------------------------------------------------------- */
size_t LLVMFuzzerMutate (uint8_t *data, size_t size, size_t most);
size_t LLVMFuzzerCustomMutator (uint8_t *data, size_t size, size_t most, unsigned seed);

static unsigned next_random (unsigned *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return *seed >> 8;
}

/* Puts `text` in place of the bytes [from, to). */
static size_t splice (uint8_t *data, size_t size, size_t most, size_t from, size_t to, const char *text,
                      size_t n)
{
    if (size - (to - from) + n > most) return size;
    memmove (data + from + n, data + to, size - to);
    memcpy (data + from, text, n);
    return size - (to - from) + n;
}

/* Another number where one stands. */
static size_t change_number (uint8_t *data, size_t size, size_t most, unsigned *seed)
{
    static const char *const value[] = { "0",
                                         "-0.0",
                                         "1",
                                         "-1",
                                         "2",
                                         "3",
                                         "0.5",
                                         "1e-3",
                                         "7",
                                         "1e3",
                                         "1e308",
                                         "-1e308",
                                         "1e-308",
                                         "5e-324",
                                         "1e16",
                                         "1e9",
                                         "1e-9",
                                         "2147483647",
                                         "2147483648",
                                         "4294967297",
                                         "9007199254740993",
                                         "1e19",
                                         "1e400",
                                         "nan",
                                         "inf",
                                         "100 %",
                                         "2 spacing",
                                         "[]",
                                         "{}",
                                         "1.0000000000000002",
                                         "0.49999999999" };
    size_t at = next_random (seed) % size, end;
    while (at < size && !(data[at] >= '0' && data[at] <= '9')) at++;
    for (end = at; end < size && strchr ("0123456789.eE", data[end]); end++) continue;
    const char *text = value[next_random (seed) % (sizeof value / sizeof *value)];
    return at < size ? splice (data, size, most, at, end, text, strlen (text)) : size;
}

/* A line is doubled, or moved from one place to another. */
static size_t change_lines (uint8_t *data, size_t size, size_t most, unsigned *seed)
{
    char line[512];
    size_t from = next_random (seed) % size, to, at = next_random (seed) % size;
    while (from > 0 && data[from - 1] != '\n') from--;
    for (to = from; to < size && data[to] != '\n' && to - from < sizeof line - 1; to++) continue;
    size_t n = to - from;
    memcpy (line, data + from, n);
    line[n++] = '\n';
    if (next_random (seed) % 2) size = splice (data, size, most, from, to < size ? to + 1 : to, "", 0);
    while (at > 0 && at < size && data[at - 1] != '\n') at--;
    return at <= size ? splice (data, size, most, at, at, line, n) : size;
}

size_t LLVMFuzzerCustomMutator (uint8_t *data, size_t size, size_t most, unsigned seed)
{
    unsigned how = next_random (&seed) % 4;
    if (size > 8 && how < 2) return change_number (data, size, most, &seed);
    if (size > 8 && how == 2) return change_lines (data, size, most, &seed);
    return LLVMFuzzerMutate (data, size, most);
}
#endif

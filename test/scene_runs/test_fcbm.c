/* SPDX-License-Identifier: GPL-3.0-or-later
 * Zhou's first two examples by direct sums and by transforms, at a coarser spacing: without failure the same
 * displacements at iterations 750 and 1000; with the stretch criterion the same bonds broken at every row of
 * the history, so the same path and the same curve of the tip; with both the energy of points as criterion,
 * alike. PERIGAL_LONG: at the scenes' own spacing. */
#include "run.h"

typedef struct { const char *scene, *spacing, *more[3]; } example;
static const example coarse[] = { { "data/zhou_1/scene.yaml", "spacing=1 mm", { "output.at.rows=1000" } },
                                  { "data/zhou_2/scene.yaml",
                                    "spacing=0.25 mm",
                                    { "solver.dt=3.341e-8 s", "output.at.rows=1000",
                                      "failure.critical_stretch=0.02828" } } };
static const example own[] = { { "data/zhou_1/scene.yaml", "spacing=0.5 mm", { "output.at.rows=1000" } },
                               { "data/zhou_2/scene.yaml",
                                 "spacing=0.1 mm",
                                 { "solver.dt=1.3367e-8 s", "output.at.rows=1000",
                                   "failure.critical_stretch=0.04472" } } };

/* without failure the sums are the same on twice that spacing too */
static const example coarser[] = { { "data/zhou_1/scene.yaml", "spacing=2 mm", { "output.at.rows=1000" } },
                                   { "data/zhou_2/scene.yaml",
                                     "spacing=0.5 mm",
                                     { "solver.dt=3.341e-8 s", "output.at.rows=1000" } } };

static run load (const example *e, const char *evaluation, const char *failure)
{
    const char *set[6] = { evaluation, e->spacing };
    size_t n = 2;
    for (int k = 0; k < 3 && e->more[k]; k++) set[n++] = e->more[k];
    if (failure) set[n++] = failure;
    return loaded (e->scene, n, set);
}

/* Largest difference of the displacements over the largest one. */
static double apart (const run *a, const run *b)
{
    return largest_difference (a->state->d, b->state->d, a->state->ndof)
           / largest_of (a->state->d, a->state->ndof);
}

/* Root of the mean square of the difference over that of the displacements. */
static double apart_l2 (const run *a, const run *b)
{
    double sum = 0, all = 0;
    for (size_t i = 0; i < a->state->ndof; i++)
        sum += pow (a->state->d[i] - b->state->d[i], 2), all += pow (a->state->d[i], 2);
    return sqrt (sum / all);
}

static const example *which (void) { return getenv ("PERIGAL_LONG") ? own : coarse; }

static void elastic_fields (void **unused)
{
    (void) unused;
    const example *e = which () == own ? own : coarser;
    for (int k = 0; k < 2; k++) {
        run a = load (&e[k], "method.evaluation=stencil", "failure.critical_stretch=1000"),
            b = load (&e[k], "method.evaluation=fft", "failure.critical_stretch=1000");
        for (int n = 1; n <= 1000; n++) {
            advance (&a), advance (&b);
            if (n != 750 && n != 1000) continue;
            print_message (
                "example %d, iteration %d: displacements apart by %.2g of the largest, %.2g in the mean\n",
                k + 1, n, apart (&a, &b), apart_l2 (&a, &b));
            check_below (apart_l2 (&a, &b), 1e-12);
            check_below (apart (&a, &b), 1e-12);
        }
        clear (&a), clear (&b);
    }
}

/* Row by row the same bonds; at least `most` of them broken in the end. */
static void same_cracks (const example *e, const char *failure)
{
    run a = load (e, "method.evaluation=stencil", failure), b = load (e, "method.evaluation=fft", failure);
    size_t dead = 0;
    while (!pg_solver_done (a.solver, a.state)) {
        advance (&a), advance (&b);
        assert_int_equal (a.step.nbroken, b.step.nbroken);
        assert_memory_equal (a.state->alive, b.state->alive, a.state->nbond);
        dead += a.step.nbroken;
    }
    assert_true (pg_solver_done (b.solver, b.state));
    print_message ("%s, %s: %zu bonds broken by either\n", e->scene,
                   failure ? failure : "as the scene has it", dead);
    assert_true (dead > 500);
    clear (&a), clear (&b);
}

/* PERIGAL_TEST_SIZE=long. */
static void cracks_by_stretch (void **unused)
{
    (void) unused;
    for (int k = 0; longer () && k < 2; k++) same_cracks (&which ()[k], NULL);
}

static void cracks_by_energy (void **unused)
{
    (void) unused;
    same_cracks (&(example){ "data/zhou_1/scene_energy.yaml",
                             which ()[0].spacing,
                             { "output.at.rows=1000" } },
                 NULL);
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (elastic_fields),
                                        cmocka_unit_test (cracks_by_stretch),
                                        cmocka_unit_test (cracks_by_energy) };
    return cmocka_run_group_tests (tests, NULL, NULL);
}

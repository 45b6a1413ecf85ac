/* SPDX-License-Identifier: GPL-3.0-or-later
 * Everything between a command line and the first step of a run, in its order. Both run and check pass
 * through here, so that they refuse the same scenes with the same words. */
#include "cli.h"
#include <stdlib.h>

/* 1: this program may change the environment; 0: the user, or the program that started this one, has set the
 * threads of libraries. */
static int environment_ours;

void settle_blas_too (void) { environment_ours = 1; }

/* Sets the threads of BLAS. Two threads gain 7 % of a factorization with 4 000 unknowns on an idle machine,
 * and lose half the speed on a busy one: below 50 000 unknowns in 2D and 10 000 in 3D one thread is used.
 * Where BLAS is not loaded yet the environment is set, so that it starts no idle threads: each would spin for
 * some 20 ms. */
static void settle_blas (const pg_problem *p)
{
    size_t unknowns = p->cloud.n * (size_t) pg_problem_unknowns (p), enough = p->dim == 3 ? 10000 : 50000;
    int threads = unknowns < enough ? 1 : p->threads;
    char count[16];
    snprintf (count, sizeof count, "%d", threads);
    if (environment_ours) setenv ("OPENBLAS_NUM_THREADS", count, 1);
    pg_linear_threads (threads);
}

/* Turns a failure of the method with this body (singular or indefinite matrix, no equilibrium) into a fault
 * of the scene. */
static pg_status refuse (const preparation *r, pg_status status)
{
    char text[1024];
    if (status != PG_E_SINGULAR && status != PG_E_NOT_SPD && status != PG_E_EQUILIBRIUM) return status;
    snprintf (text, sizeof text, "%s", pg_last_error ());
    pg_scene_fault (r->scene, "method", "%s", text);
    return pg_scene_verdict (r->scene);
}

pg_status prepare_problem (preparation *r, const command *c, int thorough)
{
    pg_status status = PG_OK;
    int alone = !pg_ranks_now ();
    if (alone) PG_TRY (afford_scene (c, &r->forecast));
    PG_TRY (command_problem (c, r->scene, &r->problem, &r->options));
    settle_blas (r->problem);
    if (alone) PG_TRY (afford_problem (c, &r->forecast, r->problem, thorough));
    if (alone) PG_TRY (pg_patch_probe (r->problem));
done:
    return refuse (r, status);
}

pg_status prepare_solver (preparation *r)
{
    pg_status status = PG_OK;
    PG_TRY (pg_solver_create (&r->solver, r->problem, &r->options));
    PG_TRY (pg_patch_refuse (r->problem, r->scene));
done:
    return refuse (r, status);
}

pg_status prepare_start (preparation *r)
{
    pg_status status = PG_OK;
    PG_TRY (pg_state_create (&r->state, r->problem, pg_solver_components (r->solver)));
    PG_TRY (pg_solver_begin (r->solver, r->state, r->scene));
    PG_TRY (pg_result_plan (r->scene, r->problem, r->solver));
done:
    return refuse (r, status);
}

void prepare_free (preparation *r)
{
    pg_state_free (&r->state);
    pg_solver_free (&r->solver);
    pg_problem_free (&r->problem);
    pg_scene_free (&r->scene);
}

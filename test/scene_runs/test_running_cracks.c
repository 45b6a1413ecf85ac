/* SPDX-License-Identifier: GPL-3.0-or-later
 * Scenes zhou_2 and glass_branching, coarser: both sides of every axis of symmetry break bond by bond alike,
 * the crack waits for the waves, runs along its axis no faster than Rayleigh waves, and in glass splits into
 * two where the scene at its own spacing does. */
#include "run.h"

/* Of each point the one at the mirrored place: x[axis] -> -x[axis]. */
static int *mirror_of (const pg_cloud *cloud, int axis)
{
    pg_nearest *nearest;
    int *mirror = pg_calloc (cloud->n, sizeof *mirror);
    check_ok (pg_nearest_create (&nearest, 2, cloud->n, cloud->x));
    for (size_t i = 0; i < cloud->n; i++) {
        double x[2] = { cloud->x[2*i], cloud->x[2*i + 1] };
        x[axis] = -x[axis];
        mirror[i] = (int) pg_nearest_find (nearest, x, NULL, NULL);
        assert_true (
            hypot (cloud->x[2 * (size_t) mirror[i]] - x[0], cloud->x[2 * (size_t) mirror[i] + 1] - x[1])
            < 1e-6 * cloud->h);
    }
    pg_nearest_free (&nearest);
    return mirror;
}

static int alive (const run *r, size_t i, int j)
{
    const pg_family *f = &r->problem->bonds.rows[PG_NODES].family;
    for (size_t b = f->start[i]; b < f->start[i + 1]; b++) if (f->node[b] == j) return r->state->alive[b];
    return -1;
}

/* Bonds whose mirror image is not in the same state; dead: bonds that are broken. */
static size_t unlike_their_image (const run *r, int axis, size_t *dead)
{
    const pg_family *f = &r->problem->bonds.rows[PG_NODES].family;
    int *mirror = mirror_of (&r->problem->cloud, axis);
    size_t unlike = 0;
    *dead = 0;
    for (size_t i = 0; i < r->problem->cloud.n; i++)
        for (size_t b = f->start[i]; b < f->start[i + 1]; b++) {
            *dead += !r->state->alive[b];
            unlike += alive (r, (size_t) mirror[i], mirror[f->node[b]]) != r->state->alive[b];
        }
    pg_free (mirror);
    return unlike;
}

/* The damaged points: how far along x, off the axis, and along x among those of the two rows next to the
 * axis. */
typedef struct { double tip, off, fork; } extent;
static extent look (const run *r)
{
    extent e = { -INFINITY, 0, -INFINITY };
    const pg_cloud *c = &r->problem->cloud;
    double *damage = field_of (r, NULL, "damage", NULL);
    for (size_t i = 0; i < c->n; i++) {
        if (damage[i] < 0.35) continue;
        double x = c->x[2*i], y = fabs (c->x[2*i + 1]);
        e.tip = fmax (e.tip, x), e.off = fmax (e.off, y);
        if (y < 0.6 * c->h) e.fork = fmax (e.fork, x);
    }
    pg_free (damage);
    return e;
}

/* Time at which the tip is first at x (m); the state goes on to there. */
static double arrives (run *r, double x)
{
    while (!pg_solver_done (r->solver, r->state)) {
        advance (r);
        if (r->step.nbroken > 0 && look (r).tip >= x) return r->step.time;
    }
    return NAN;
}

/* 0.25 mm in place of 0.1 mm, with the fracture energy of the scene. */
static void a_centre_crack_runs_straight_and_alike_to_both_sides (void **state)
{
    (void) state;
    static const char *const set[] = { "spacing=0.25 mm", "failure.critical_stretch=0.028283",
                                       "solver={kind: verlet, dt: 3.34175e-8 s, time_steps: 400}",
                                       "output.at={levels: 1, rows: 400}" };
    run r = loaded ("data/zhou_2/scene.yaml", 4, set);
    pg_waves w = pg_material_waves (&r.problem->material[0]);
    size_t dead, before;
    double start = NAN;
    unlike_their_image (&r, 0, &before);
    while (isnan (start) && !pg_solver_done (r.solver, r.state)) {
        advance (&r);
        if (r.step.nbroken > 0) start = r.step.time;
    }
    double early = arrives (&r, 7e-3), late = arrives (&r, 13e-3);
    to_the_end (&r);
    extent e = look (&r);
    print_message ("first bond at %.3g us (waves: %.3g us), %.2f of c_R between 7 and 13 mm, tip at %.4g mm, "
                   "damaged up to %.3g mm off the axis\n",
                   1e6 * start, 25e-3 / w.pressure * 1e6, 6e-3 / (late - early) / w.rayleigh, 1e3 * e.tip,
                   1e3 * e.off);
    assert_true (start > 25e-3 / w.pressure);  /* no bond breaks before the waves from the grips are there */
    check_below (start, 1.3 * 25e-3 / w.pressure);
    assert_true (6e-3 / (late - early) > 0.3 * w.rayleigh && 6e-3 / (late - early) < w.rayleigh);
    assert_true (e.tip > 15e-3 && e.tip < 18e-3);
    check_below (e.off, 2 * r.problem->cloud.h);
    for (int axis = 0; axis < 2; axis++) {
        assert_int_equal (unlike_their_image (&r, axis, &dead), 0);
        assert_int_equal (dead - before, r.state->broken);
    }
    assert_true (r.state->broken > 1000);
    clear (&r);
}

/* 1/3 mm in place of 0.25 mm, the same horizon. */
static void a_crack_in_glass_branches_in_two_alike (void **state)
{
    (void) state;
    static const char *const set[] = { "spacing=0.33333333333 mm", "output.at={levels: 1, rows: 400}" };
    run r = loaded ("data/glass_branching/scene.yaml", 2, set);
    double c_R = pg_material_waves (&r.problem->material[0]).rayleigh;
    size_t dead;
    double early = arrives (&r, 52e-3), late = arrives (&r, 62e-3);
    extent straight = look (&r);
    double far = arrives (&r, 85e-3);
    extent e = look (&r);
    print_message ("%.2f of c_R between 52 and 62 mm, fork at %.4g mm, branches %.2f of c_R along the axis, "
                   "%.3g mm off it at 85 mm\n",
                   10e-3 / (late - early) / c_R, 1e3 * e.fork, 23e-3 / (far - late) / c_R, 1e3 * e.off);
    check_below (straight.off, 1.5e-3);
    assert_true (e.fork > 62e-3 && e.fork < 68e-3);
    assert_true (e.off > 5e-3 && e.off < 12e-3);
    assert_true (10e-3 / (late - early) > 0.3 * c_R && 10e-3 / (late - early) < 0.7 * c_R);
    assert_true (23e-3 / (far - late) > 0.3 * c_R && 23e-3 / (far - late) < 0.7 * c_R);
    assert_int_equal (unlike_their_image (&r, 1, &dead), 0);
    assert_true (r.state->broken > 10000);
    clear (&r);
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (
                                            a_centre_crack_runs_straight_and_alike_to_both_sides),
                                        cmocka_unit_test (a_crack_in_glass_branches_in_two_alike) };
    return cmocka_run_group_tests_name ("scene_runs/running_cracks", tests, NULL, NULL);
}

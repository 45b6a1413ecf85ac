/* SPDX-License-Identifier: GPL-3.0-or-later
 * Contact along a path of loads: one pair in closed form, changes of status against small steps, against the
 * direct solution where slips do not turn round, to and fro in total form, cohesion that is lost, scales. */
#include "check.h"
#include "perigal/contact.h"

enum { MOST = 16, ROWS = 2 * MOST };
typedef struct {
    double C[ROWS * ROWS], gap[ROWS], rate[ROWS], mu[MOST], cohesion[MOST];
    double force[ROWS], now[ROWS], force_rate[ROWS], gap_rate[ROWS];
    unsigned char status[MOST], due[MOST];
    pg_contact_path path;
    pg_contact_track track;
} room;

static void set_up (room *r, size_t n)
{
    r->path = (pg_contact_path){ n, 2, r->C, r->gap, r->rate, r->mu, r->cohesion, NULL };
    r->track = (pg_contact_track){ .force = r->force, .gap = r->now, .force_rate = r->force_rate,
                                   .gap_rate = r->gap_rate, .status = r->status, .due = r->due };
}

static double random_number (uint64_t *seed)
{
    *seed = *seed * 6364136223846793005u + 1442695040888963407u;
    return (double) (int64_t) (*seed >> 11) / (double) ((int64_t) 1 << 52) - 1;
}

/* C = B B' + a part of the unit matrix; a path from mostly closed gaps to others, friction that every pair
 * has of its own. */
static void random_room (room *r, size_t n, uint64_t *seed, double friction, double cohesion)
{
    double B[ROWS * ROWS];
    size_t rows = 2 * n;
    memset (r, 0, sizeof *r);
    for (size_t i = 0; i < rows * rows; i++) B[i] = 0.4 * random_number (seed);
    for (size_t i = 0; i < rows; i++)
        for (size_t j = 0; j < rows; j++) {
            double sum = i == j ? 1 : 0;
            for (size_t k = 0; k < rows; k++) sum += B[i * rows + k] * B[j * rows + k] / (double) n;
            r->C[i * rows + j] = sum;
        }
    for (size_t k = 0; k < n; k++) {
        r->gap[2*k] = 0.5 * random_number (seed) - 0.4, r->gap[2*k + 1] = 0.2 * random_number (seed);
        r->rate[2*k] = random_number (seed), r->rate[2*k + 1] = 2 * random_number (seed);
        r->mu[k] = friction * (0.5 + 0.5 * fabs (random_number (seed)));
        r->cohesion[k] = cohesion * fabs (random_number (seed));
    }
    set_up (r, n);
}

/* By steps of the implicit scheme, slips counting from the last one. */
static void by_steps (const room *r, long steps, double to, double *force, double *gap)
{
    size_t n = r->path.n;
    double open[ROWS], slip[MOST] = { 0 };
    unsigned char status[MOST];
    pg_contact_problem p = { n, 2, r->C, open, r->mu, r->cohesion, slip };
    pg_contact_solution s = { .force = force, .gap = gap, .status = status };
    for (long step = 0; step <= steps; step++) {
        double at = to * (double) step / (double) steps;
        for (size_t i = 0; i < 2 * n; i++) open[i] = r->gap[i] + at * r->rate[i];
        check_ok (pg_contact_solve (&s, &p));
        for (size_t k = 0; k < n; k++) slip[k] = gap[2*k + 1];
    }
}

/* From 0 to `to`, stretch after stretch: conditions hold inside each of them, all is continuous but for
 * leaps. *turns: some slip goes back, or begins where it is not zero. */
static int follow (room *r, double to, long *changes, int *turns)
{
    size_t n = r->path.n;
    double slip[MOST], most[MOST] = { 0 }, scale = 0;
    *turns = 0;
    if (pg_contact_begin (&r->track, &r->path, 0, NULL) != PG_OK) return 0;
    for (size_t i = 0; i < 2 * n; i++) scale = fmax (scale, fabs (r->gap[i]) + fabs (to * r->rate[i]));
    for (int guard = 0; r->track.s != to; guard++) {
        assert_true (guard < 1000);
        check_ok (pg_contact_stretch (&r->track, &r->path, to));
        for (size_t k = 0; k < n; k++) slip[k] = r->now[2*k + 1];
        double middle = 0.5 * (r->track.s + r->track.end), end = r->track.end, open[ROWS];
        pg_contact_go (&r->track, &r->path, middle);
        for (size_t i = 0; i < 2 * n; i++) open[i] = r->gap[i] + middle * r->rate[i];
        pg_contact_problem p = { n, 2, r->C, open, r->mu, r->cohesion, slip };
        pg_contact_solution s = { .force = r->force, .gap = r->now, .status = r->status };
        check_below (pg_contact_violation (&p, &s), 1e-10);
        pg_contact_go (&r->track, &r->path, end);
        for (size_t k = 0; k < n; k++) {
            double now = r->now[2*k + 1];
            if (fabs (now) < fabs (most[k]) - 1e-12 || now * most[k] < 0) *turns = 1;
            if (fabs (now) > fabs (most[k])) most[k] = now;
            /* the slip of what was open is one that friction has not resisted */
            if (r->status[k] == PG_CONTACT_OPEN && end < to) *turns = 1;
        }
    }
    *changes = r->track.total;
    return 1;
}

/* ---- closed forms -------------------------------------------------------------------------------------- */
/* C_nn = 2, C_tt = 4, mu = 0.25: pressed with 1 N, sheared as s grows: it slides from 4 s = 0.25 x 4 on, the
 * slip is 4 s - 1; on the way back it sticks until the shear force has turned. */
static void one_block_goes_to_and_fro (void **state)
{
    (void) state;
    room r = { .C = { 2, 0, 0, 4 }, .gap = { -2, 0 }, .rate = { 0, 4 }, .mu = { 0.25 } };
    set_up (&r, 1);
    static const struct { double to, end, slip, shear; pg_contact_status status; } way[] = {
        { 1, 0.25, 0, -0.25, PG_CONTACT_STICK },       { 1, 1, 3, -0.25, PG_CONTACT_FORWARD },
        { 0, 0.5, 3, 0.25, PG_CONTACT_STICK },         { 0, 0, 1, 0.25, PG_CONTACT_BACKWARD },
        { 0.6, 0.5, 1, -0.25, PG_CONTACT_STICK },      { 0.6, 0.6, 1.4, -0.25, PG_CONTACT_FORWARD },
    };
    check_ok (pg_contact_begin (&r.track, &r.path, 0, NULL));
    for (size_t i = 0; i < sizeof way / sizeof *way; i++) {
        check_ok (pg_contact_stretch (&r.track, &r.path, way[i].to));
        assert_int_equal (r.status[0], way[i].status);
        check_absolute (r.track.end, way[i].end, 1e-15);
        pg_contact_go (&r.track, &r.path, r.track.end);
        check_absolute (r.now[1], way[i].slip, 1e-14);
        check_absolute (r.force[1], way[i].shear, 1e-15);
        check_absolute (r.now[0], 0, 1e-15);
    }
    assert_int_equal (r.track.total, 3);
    assert_int_equal (r.track.leaps, 0);
}

/* A pair comes to touch while it is sheared: at the apex of its cone the rates decide, mu f_n' against what
 * would hold it. C_nn = 2, C_tt = 4, gap 1 - s: from s = 1 on f_n = (s - 1) / 2, and mu = 0.25 holds a rate
 * of slip up to 0.5; beyond it the pair slides at once, either way, by rate s less 0.5. */
static void shear_begins_at_the_apex_of_the_cone (void **state)
{
    static const double rates[] = { 0.4, -0.4, 3, -3 };
    (void) state;
    for (size_t i = 0; i < 4; i++) {
        room r = { .C = { 2, 0, 0, 4 }, .gap = { 1, 0 }, .rate = { -1, rates[i] }, .mu = { 0.25 } };
        int slides = fabs (rates[i]) > 0.5;
        double sign = rates[i] < 0 ? -1 : 1;
        set_up (&r, 1);
        check_ok (pg_contact_begin (&r.track, &r.path, 0, NULL));
        for (int guard = 0; r.track.s != 2; guard++) {
            assert_true (guard < 10);
            check_ok (pg_contact_stretch (&r.track, &r.path, 2));
            if (r.track.s >= 1 - 1e-12)
                assert_int_equal (r.status[0], !slides ? PG_CONTACT_STICK : sign > 0 ? PG_CONTACT_FORWARD
                                  : PG_CONTACT_BACKWARD);
            pg_contact_go (&r.track, &r.path, r.track.end);
        }
        check_absolute (r.force[0], 0.5, 1e-14);
        check_absolute (r.force[1], slides ? -0.125 * sign : -rates[i] / 4, 1e-14);
        /* what it has slipped before it touched is where friction begins */
        check_absolute (r.now[1], rates[i] + (slides ? rates[i] - 0.5 * sign : 0), 1e-14);
    }
}

/* The pressure falls while the shear stays: it slides when mu f_n has come down to it, opens at f_n = 0,
 * closes on the way back where it is, and has then forgotten its slip. */
static void a_block_is_lifted_and_put_down (void **state)
{
    (void) state;
    room r = { .C = { 2, 0, 0, 4 }, .gap = { -2, 0.4 }, .rate = { 3, 0 }, .mu = { 0.25 } };
    set_up (&r, 1);
    check_ok (pg_contact_begin (&r.track, &r.path, 0, NULL));
    assert_int_equal (r.status[0], PG_CONTACT_STICK);
    static const struct { double to, end, slip; pg_contact_status status; } way[] = {
        { 1, 0.4, 0, PG_CONTACT_STICK },               /* f_n = 1 - 1.5 s, f_t = - .1 */
        { 1, 2.0 / 3, 0.4, PG_CONTACT_FORWARD },       { 1, 1, 0.4, PG_CONTACT_OPEN },
        { 0, 2.0 / 3, 0.4, PG_CONTACT_OPEN },          { 0, 0, 0.4, PG_CONTACT_STICK },
    };
    for (size_t i = 0; i < sizeof way / sizeof *way; i++) {
        check_ok (pg_contact_stretch (&r.track, &r.path, way[i].to));
        assert_int_equal (r.status[0], way[i].status);
        check_absolute (r.track.end, way[i].end, 1e-14);
        pg_contact_go (&r.track, &r.path, r.track.end);
        check_absolute (r.now[1], way[i].slip, 1e-14);
    }
    check_absolute (r.force[1], 0, 1e-15);             /* put down without shear */
}

/* With cohesion alone: a pair that opens drops its shear force, and the other one takes what it can. */
static void cohesion_is_lost_at_once (void **state)
{
    (void) state;
    room r = { .C = { 2, 0, 0, 0, 0, 4, 0, 1, 0, 0, 2, 0, 0, 1, 0, 4 }, .gap = { -1, 0.8, -9, 0 },
               .rate = { 2, 0, 0, 0 }, .cohesion = { 1, 1 } };
    set_up (&r, 2);
    check_ok (pg_contact_begin (&r.track, &r.path, 0, NULL));
    double before = r.force[3];
    assert_true (r.status[0] == PG_CONTACT_STICK && r.status[1] == PG_CONTACT_STICK);
    check_ok (pg_contact_stretch (&r.track, &r.path, 1));
    check_absolute (r.track.end, 0.5, 1e-15);
    pg_contact_go (&r.track, &r.path, r.track.end);
    assert_true (fabs (r.force[1]) > 0.1 && fabs (before) > 0.01);
    check_ok (pg_contact_stretch (&r.track, &r.path, 1));
    assert_int_equal (r.track.leapt, 1);
    assert_int_equal (r.status[0], PG_CONTACT_OPEN);
    check_absolute (r.force[1], 0, 0);
    check_absolute (r.now[1], 0.8, 1e-15);             /* the slip that nothing resists */
    check_absolute (r.force[3], 0, 1e-15);
    check_absolute (r.track.end, 1, 0);
}

/* ---- many pairs ---------------------------------------------------------------------------------------- */
/* Against small steps, whose error is of their size; where no slip turns, against the direct solution. */
static void changes_are_found_one_after_the_other (void **state)
{
    (void) state;
    uint64_t seed = 7;
    long all = 0, direct = 0, cases = 0;
    for (int i = 0; i < 240; i++) {
        size_t n = 1 + (size_t) i % 8;
        room r;
        long changes, steps = 1000;
        int turns;
        double force[ROWS], gap[ROWS];
        random_room (&r, n, &seed, i % 3 ? 0.5 : 0, 0);
        assert_true (follow (&r, 1, &changes, &turns));
        if (i % 3 == 0) turns = 0;                     /* without friction nothing is remembered */
        all += changes, cases++;
        by_steps (&r, turns ? steps : 1, 1, force, gap);
        if (!turns && i % 3) by_steps (&r, 1, 1, force, gap);
        direct += !turns;
        for (size_t k = 0; k < 2 * n; k++) {
            check_absolute (r.force[k], force[k], turns ? 6e-3 : 1e-11);
            check_absolute (r.now[k], gap[k], turns ? 6e-3 : 1e-11);
        }
    }
    print_message ("%ld changes in %ld paths, %ld of them against the direct solution\n", all, cases, direct);
    assert_true (all > 3 * cases && direct > 60);
}

/* Halfway between two ends the state is no mean of theirs where a pair changes between them. */
static void states_are_no_means_across_a_change (void **state)
{
    (void) state;
    uint64_t seed = 11;
    double worst = 0;
    for (int i = 0; i < 20; i++) {
        room r;
        long changes;
        int turns;
        double force[3][ROWS], gap[ROWS];
        random_room (&r, 4, &seed, 0.4, 0);
        for (int k = 0; k < 3; k++) {
            assert_true (follow (&r, 0.5 * k + 1e-300, &changes, &turns));
            memcpy (force[k], r.force, sizeof force[k]);
        }
        by_steps (&r, 1000, 0.5, force[0], gap);
        double mean = 0, followed = 0;
        assert_true (follow (&r, 1e-300, &changes, &turns));
        for (size_t k = 0; k < 8; k++) {
            mean = fmax (mean, fabs (0.5 * (r.force[k] + force[2][k]) - force[0][k]));
            followed = fmax (followed, fabs (force[1][k] - force[0][k]));
        }
        check_below (followed, 6e-3);
        worst = fmax (worst, mean);
    }
    assert_true (worst > 0.05);
}

/* In total form every s has the direct solution, and a stretch goes both ways. */
static void the_total_form_goes_to_and_fro (void **state)
{
    (void) state;
    uint64_t seed = 3;
    for (int i = 0; i < 60; i++) {
        room r;
        size_t n = 1 + (size_t) i % 8, rows = 2 * n;
        double slip[MOST], force[ROWS], gap[ROWS], open[ROWS];
        unsigned char status[MOST];
        random_room (&r, n, &seed, 0.4, 0);
        for (size_t k = 0; k < n; k++) slip[k] = 0.1 * random_number (&seed);
        r.path.slip = slip;
        for (int sense = 0; sense < 2; sense++) {
            double from = 0.3 + 0.4 * fabs (random_number (&seed)), far = sense ? 1 : 0;
            check_ok (pg_contact_begin (&r.track, &r.path, from, slip));
            check_ok (pg_contact_stretch (&r.track, &r.path, far));
            double to = from + 0.999 * (r.track.end - from);
            int changes = r.track.changes;
            double end = r.track.end;
            pg_contact_go (&r.track, &r.path, to);
            for (size_t k = 0; k < rows; k++) open[k] = r.gap[k] + to * r.rate[k];
            pg_contact_problem p = { n, 2, r.C, open, r.mu, r.cohesion, slip };
            pg_contact_solution s = { .force = force, .gap = gap, .status = status };
            check_ok (pg_contact_solve (&s, &p));
            for (size_t k = 0; k < rows; k++) check_absolute (r.force[k], force[k], 1e-11);
            if (!changes || fabs (end - from) < 1e-3) continue;
            for (size_t k = 0; k < rows; k++)          /* beyond the end it would be wrong */
                open[k] = r.gap[k] + (end + 1e-3 * (end - from)) * r.rate[k];
            check_ok (pg_contact_solve (&s, &p));
            assert_true (memcmp (status, r.status, n) != 0);
        }
    }
}

/* Units of force and length, and of s, do not count; nor does the sense in which slips are counted. */
static void scales_do_not_count (void **state)
{
    (void) state;
    uint64_t seed = 5;
    for (int i = 0; i < 20; i++) {
        room a, b;
        long changes[2];
        int turns;
        random_room (&a, 5, &seed, 0.5, i % 2 ? 0.1 : 0);
        b = a;
        set_up (&b, 5);
        const double newton = 1e7, metre = 1e-4;
        for (size_t k = 0; k < 100; k++) b.C[k] *= metre / newton * (k % 2 == (k / 10) % 2 ? 1 : -1);
        for (size_t k = 0; k < 10; k++) {
            double sign = k % 2 ? -1 : 1;
            b.gap[k] *= metre * sign, b.rate[k] *= metre * sign / 50;
        }
        for (size_t k = 0; k < 5; k++) b.cohesion[k] *= newton;
        assert_true (follow (&a, 1, &changes[0], &turns));
        assert_true (follow (&b, 50, &changes[1], &turns));
        assert_int_equal (changes[0], changes[1]);
        for (size_t k = 0; k < 10; k++)
            check_absolute (b.force[k] / newton * (k % 2 ? -1 : 1), a.force[k], 1e-11);
    }
}

/* Everything is followed to its end, with cohesion too, which leaps. */
static void every_path_has_an_end (void **state)
{
    (void) state;
    uint64_t seed = 23;
    long leaps = 0, found = 0;
    for (int i = 0; i < 100; i++) {
        room r;
        long changes;
        int turns;
        random_room (&r, 1 + (size_t) i % 12, &seed, i % 2 ? 0.5 : 0.3, i % 4 ? 0.2 : 0);
        found += follow (&r, 1, &changes, &turns);
        leaps += r.track.leaps;
    }
    assert_true (found >= 97 && leaps > 10);          /* some begin where there is no equilibrium */
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (one_block_goes_to_and_fro),
        cmocka_unit_test (a_block_is_lifted_and_put_down),
        cmocka_unit_test (shear_begins_at_the_apex_of_the_cone),
        cmocka_unit_test (cohesion_is_lost_at_once),
        cmocka_unit_test (changes_are_found_one_after_the_other),
        cmocka_unit_test (states_are_no_means_across_a_change),
        cmocka_unit_test (the_total_form_goes_to_and_fro),
        cmocka_unit_test (scales_do_not_count),
        cmocka_unit_test (every_path_has_an_end),
    };
    return cmocka_run_group_tests (tests, NULL, NULL);
}

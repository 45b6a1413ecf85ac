/* SPDX-License-Identifier: GPL-3.0-or-later
 * The problem of complementarity in space, where friction has a cone: closed forms of one pair, problems that
 * lie in a plane, frames that are turned, memory of slip, random problems, and violations that are seen. */
#include "check.h"
#include "perigal/contact.h"
#include <stdlib.h>

enum { MOST = 40 };
typedef struct { double force[3 * MOST], gap[3 * MOST]; unsigned char status[MOST]; } room;

static pg_contact_solution solution_in (room *r)
{
    return (pg_contact_solution){ .force = r->force, .gap = r->gap, .status = r->status };
}

/* Numbers from -1 to 1, the same in every run. */
static double random_number (uint64_t *seed)
{
    *seed = *seed * 6364136223846793005u + 1442695040888963407u;
    return (double) (int64_t) (*seed >> 11) / (double) ((int64_t) 1 << 52) - 1;
}

/* C = B B' / rows + a little of the unit matrix, of so many rows. */
static void random_compliance (size_t rows, uint64_t *seed, double *C)
{
    double *B = malloc (rows * rows * sizeof *B);
    assert_non_null (B);
    for (size_t i = 0; i < rows * rows; i++) B[i] = random_number (seed);
    for (size_t i = 0; i < rows; i++)
        for (size_t j = 0; j < rows; j++) {
            double sum = 0;
            for (size_t k = 0; k < rows; k++) sum += B[i * rows + k] * B[j * rows + k];
            C[i * rows + j] = sum / (double) rows + (i == j ? 0.2 : 0);
        }
    free (B);
}

/* C_nn = 2, C_tt = 4, nothing between: f_n = 0.5 N; the slip of 1.3 m along (5, 12) / 13 is stopped by a
 * force of at most mu f_n + c against it, and what this does not stop remains. */
static void one_pair_has_its_closed_form (void **state)
{
    (void) state;
    static const double C[9] = { 2, 0, 0, 0, 4, 0, 0, 0, 4 };
    static const struct { double gn, mu, c, fn, shear, slip; pg_contact_status status; } cases[] = {
        { 0.5, 0.5, 0.3, 0, 0, 1.3, PG_CONTACT_OPEN },  { -1, 0, 0, 0.5, 0, 1.3, PG_CONTACT_SLIDING },
        { -1, 0.2, 0, 0.5, 0.1, 0.9, PG_CONTACT_SLIDING },
        { -1, 0.2, 0.1, 0.5, 0.2, 0.5, PG_CONTACT_SLIDING },
        { -1, 0, 0.25, 0.5, 0.25, 0.3, PG_CONTACT_SLIDING },
        { -1, 0.7, 0, 0.5, 0.325, 0, PG_CONTACT_STICK },
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        for (int turn = 0; turn < 4; turn++) {
            static const double way[4][2] = { { 5, 12 }, { -12, 5 }, { 0, -13 }, { 13, 0 } };
            room r;
            pg_contact_solution s = solution_in (&r);
            double gap[3] = { cases[i].gn, 0.1 * way[turn][0], 0.1 * way[turn][1] };
            pg_contact_problem p = { 1, 3, C, gap, &cases[i].mu, &cases[i].c, NULL };
            check_ok (pg_contact_solve (&s, &p));
            check_absolute (r.force[0], cases[i].fn, 1e-15);
            check_absolute (r.gap[0], fmax (0, cases[i].gn), 1e-15);
            for (int a = 0; a < 2; a++) {
                check_absolute (r.force[1 + a], -cases[i].shear * way[turn][a] / 13, 1e-15);
                check_absolute (r.gap[1 + a], cases[i].slip * way[turn][a] / 13, 2e-15);
            }
            assert_int_equal (r.status[0], cases[i].status);
            assert_int_equal (s.sliding, cases[i].status == PG_CONTACT_SLIDING);
            check_below (s.violation, 1e-15);
        }
}

/* Pairs whose second tangent nothing couples with and nothing drives: the problem in the plane. */
static void a_plane_problem_is_the_same_in_space (void **state)
{
    (void) state;
    enum { N = 10 };
    uint64_t seed = 3;
    double C[4 * N * N], gap[2 * N], mu[N], D[9 * N * N], wide[3 * N], slip[N], slips[2 * N];
    size_t kinds[3] = { 0 };
    for (int trial = 0; trial < 20; trial++) {
        random_compliance (2 * N, &seed, C);
        for (int i = 0; i < 2 * N; i++) gap[i] = random_number (&seed) - (i % 2 ? 0 : 0.3);
        for (int k = 0; k < N; k++) mu[k] = trial % 4 ? 0.2 : 0, slip[k] = 0.1 * random_number (&seed);
        memset (D, 0, sizeof D), memset (wide, 0, sizeof wide), memset (slips, 0, sizeof slips);
        for (int i = 0; i < 2 * N; i++) {
            wide[i / 2 * 3 + i % 2] = gap[i];
            for (int j = 0; j < 2 * N; j++)
                D[(j / 2 * 3 + j % 2) * 3 * N + i / 2 * 3 + i % 2] = C[j * 2 * N + i];
        }
        for (int k = 0; k < N; k++) D[(3*k + 2) * 3 * N + 3*k + 2] = 1, slips[2*k] = slip[k];
        pg_contact_problem p = { N, 2, C, gap, mu, NULL, slip }, q = { N, 3, D, wide, mu, NULL, slips };
        room one, two;
        pg_contact_solution s = solution_in (&one), t = solution_in (&two);
        check_ok (pg_contact_solve (&s, &p));
        check_ok (pg_contact_solve (&t, &q));
        for (int k = 0; k < N; k++) {
            for (int a = 0; a < 2; a++) check_absolute (two.force[3*k + a], one.force[2*k + a], 1e-10);
            check_absolute (two.force[3*k + 2], 0, 1e-11);
            kinds[one.status[k] > PG_CONTACT_STICK ? 2 : one.status[k]]++;
        }
        assert_int_equal (s.open, t.open);
        assert_int_equal (s.stick, t.stick);
        assert_int_equal (s.sliding, t.sliding);
    }
    for (int k = 0; k < 3; k++) assert_true (kinds[k] > 10);
}

/* Tangents turned by an angle of each pair's own: shear forces and slips turn, and nothing else changes. So
 * do lengths and forces of other units. All conditions are met to rounding. */
static void frames_and_units_do_not_count (void **state)
{
    (void) state;
    enum { N = 30, R = 3 * N };
    static double C[R * R], D[R * R], T[R * R], gap[R], turned[R], slip[2 * N], slips[2 * N];
    uint64_t seed = 23;
    size_t kinds[3] = { 0 };
    for (int trial = 0; trial < 8; trial++) {
        double mu[N], c[N], angle[N], unit = trial % 2 ? 1e-6 : 1;
        random_compliance (R, &seed, C);
        memset (T, 0, sizeof T);
        for (int k = 0; k < N; k++) {
            angle[k] = 3 * random_number (&seed), mu[k] = 0.4 * (1 + random_number (&seed));
            c[k] = trial < 4 ? 0 : 0.02, slip[2*k] = slip[2*k + 1] = 0;
            for (int a = 0; trial > 5 && a < 2; a++) slip[2*k + a] = 0.1 * random_number (&seed);
            double cs = cos (angle[k]), sn = sin (angle[k]);
            T[3*k * R + 3*k] = 1, T[(3*k + 1) * R + 3*k + 1] = T[(3*k + 2) * R + 3*k + 2] = cs;
            T[(3*k + 2) * R + 3*k + 1] = sn, T[(3*k + 1) * R + 3*k + 2] = -sn;      /* column-major */
            slips[2*k] = unit * (cs * slip[2*k] + sn * slip[2*k + 1]);
            slips[2*k + 1] = unit * (cs * slip[2*k + 1] - sn * slip[2*k]);
        }
        for (int i = 0; i < R; i++) gap[i] = random_number (&seed) - (i % 3 ? 0 : 0.4);
        for (int i = 0; i < R; i++) {
            turned[i] = 0;
            for (int j = 0; j < R; j++) turned[i] += unit * T[j * R + i] * gap[j];
            for (int j = 0; j < R; j++) {
                double sum = 0;
                for (int a = i / 3 * 3; a < i / 3 * 3 + 3; a++)
                    for (int b = j / 3 * 3; b < j / 3 * 3 + 3; b++)
                        sum += T[a * R + i] * C[b * R + a] * T[b * R + j];
                D[j * R + i] = unit * sum;
            }
        }
        for (int i = 0; i < R; i++) for (int j = 0; j < i; j++) D[j * R + i] = D[i * R + j];
        pg_contact_problem p = { N, 3, C, gap, mu, c, slip }, q = { N, 3, D, turned, mu, c, slips };
        room one, two;
        pg_contact_solution s = solution_in (&one), t = solution_in (&two);
        check_ok (pg_contact_solve (&s, &p));
        check_ok (pg_contact_solve (&t, &q));
        check_below (fmax (s.violation, t.violation), 1e-11);
        assert_memory_equal (one.status, two.status, N);
        assert_true (s.passes < 30);
        for (int k = 0; k < N; k++) {
            double cs = cos (angle[k]), sn = sin (angle[k]), *f = one.force + 3*k, *g = two.force + 3*k;
            check_absolute (g[0], f[0], 1e-9);
            check_absolute (g[1], cs * f[1] + sn * f[2], 1e-9);
            check_absolute (g[2], cs * f[2] - sn * f[1], 1e-9);
            kinds[one.status[k] > PG_CONTACT_STICK ? 2 : one.status[k]]++;
        }
    }
    print_message ("%zu open, %zu stick, %zu slide\n", kinds[0], kinds[1], kinds[2]);
    for (int k = 0; k < 3; k++) assert_true (kinds[k] > 10);
}

/* A block on springs is dragged along lines with corners: it sticks until the force of the spring reaches the
 * circle, follows in the direction of that force, and keeps its slip when the drag comes back a little. */
static void slip_has_a_memory (void **state)
{
    (void) state;
    static const double C[9] = { 2, 0, 0, 0, 4, 0, 0, 0, 4 }, mu = 0.2;
    double slip[2] = { 0, 0 };
    static const struct { double drive[2], slip[2]; } step[] = {
        { { 0.3, 0 }, { 0, 0 } },         { { 1.2, 0 }, { 0.8, 0 } },  { { 1.0, 0.2 }, { 0.8, 0 } },
        { { 1.04, 0.32 }, { 0.8, 0 } },   /* 0.4 away from the slip: on the circle */
        { { 1.4, 0.8 }, { 1.16, 0.48 } }, /* (0.6, 0.8) away: 0.6 of it remains */
    };
    for (size_t i = 0; i < sizeof step / sizeof *step; i++) {
        room r;
        pg_contact_solution s = solution_in (&r);
        double gap[3] = { -1, step[i].drive[0], step[i].drive[1] };
        pg_contact_problem p = { 1, 3, C, gap, &mu, NULL, slip };
        check_ok (pg_contact_solve (&s, &p));
        const double *x = step[i].drive;
        double away = hypot (x[0] - slip[0], x[1] - slip[1]);
        check_below (s.violation, 1e-14);
        for (int a = 0; a < 2; a++) {
            check_absolute (r.gap[1 + a], step[i].slip[a], 1e-14);
            double left = away > 0.4 + 1e-12 ? 1 - 0.4 / away : 0;
            check_absolute (r.gap[1 + a], slip[a] + left * (x[a] - slip[a]), 1e-14);
        }
        memcpy (slip, r.gap + 1, sizeof slip);
    }
}

/* Tangents that hang together, pulled and pressed: the slip is not along the drive, and the force opposes it;
 * found again by a search over all directions of the force. */
static void the_force_opposes_the_slip (void **state)
{
    (void) state;
    static const double C[9] = { 2, 0.3, -0.2, 0.3, 4, 1.5, -0.2, 1.5, 1 }, mu = 0.3;
    double gap[3] = { -1, 1.5, 0.3 }, best = INFINITY, found = 0;
    room r;
    pg_contact_solution s = solution_in (&r);
    pg_contact_problem p = { 1, 3, C, gap, &mu, NULL, NULL };
    check_ok (pg_contact_solve (&s, &p));
    assert_int_equal (r.status[0], PG_CONTACT_SLIDING);
    check_relative (hypot (r.force[1], r.force[2]), mu * r.force[0], 1e-13);
    check_absolute (r.force[1] * r.gap[2] - r.force[2] * r.gap[1], 0, 1e-13);
    assert_true (r.force[1] * r.gap[1] + r.force[2] * r.gap[2] < 0);
    for (int i = 0; i < 100000; i++) {
        double angle = 6.283185307179586 * i / 100000, e[2] = { cos (angle), sin (angle) }, w[2];
        double fn = -gap[0] / (C[0] + mu * (C[1] * e[0] + C[2] * e[1]));
        for (int a = 0; a < 2; a++)
            w[a] = gap[1 + a] + fn * (C[3*a + 3] + mu * (C[3*a + 4] * e[0] + C[3*a + 5] * e[1]));
        double off = hypot (w[0] + hypot (w[0], w[1]) * e[0], w[1] + hypot (w[0], w[1]) * e[1]);
        if (off < best) best = off, found = angle;
    }
    double away = remainder (found - atan2 (r.force[2], r.force[1]), 6.283185307179586);
    check_absolute (away, 0, 1e-4);
}

/* A wrong solution violates its conditions: every one of them is measured. */
static void violations_are_seen (void **state)
{
    (void) state;
    static const double C[9] = { 1, 0, 0, 0, 1, 0, 0, 0, 1 }, mu = 0.5;
    static const struct { double g[3], f[3], worst; } cases[] = {
        { { -0.1, 0, 0 }, { 0.9, 0, 0 }, 0.1 },        { { 0.1, 0, 0 }, { 1.1, 0, 0 }, 0.1 },
        { { 0, 0, 0 }, { -0.1, 0, 0 }, 0.1 },          { { 0, 0, 0 }, { 1, 0.48, 0.36 }, 0.1 },
        { { 0, 0, 0.1 }, { 1, 0, -0.3 }, 0.1 },        { { 0, 0, 0.1 }, { 1, 0, 0.5 }, 0.1 },
        { { 0, 0, 0.1 }, { 1, 0.5, 0 }, 0.1 },         { { 0, 0, 0.9 }, { 1, 0.03, -0.5 + 0.04 }, 0.05 },
        { { 0, 0.3, 0.4 }, { 1, -0.3, -0.4 }, 0 },     { { 0, 0, 0 }, { 1, 0.3, 0.3 }, 0 },
        { { 0.7, 2, 1 }, { 0, 0, 0 }, 0 },
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        room r = { .status = { 0 } };
        memcpy (r.force, cases[i].f, sizeof cases[i].f), memcpy (r.gap, cases[i].g, sizeof cases[i].g);
        pg_contact_solution s = solution_in (&r);
        double free_gap[3] = { 1, 0.5, 0.2 };
        pg_contact_problem p = { 1, 3, C, free_gap, &mu, NULL, NULL };
        check_absolute (pg_contact_violation (&p, &s), cases[i].worst, 1e-15);
    }
}

static void what_is_no_problem_is_refused (void **state)
{
    (void) state;
    double C[16] = { 1, 0, 0, 0, 1, 0, 0, 0, 1 }, gap[4] = { -1, 0, 0, 0 };
    room r;
    pg_contact_solution s = solution_in (&r);
    pg_contact_problem p = { 1, 4, C, gap, NULL, NULL, NULL };
    check_fails (pg_contact_solve (&s, &p), PG_E_USAGE);
    p.dim = 1;
    check_fails (pg_contact_solve (&s, &p), PG_E_USAGE);
    p.dim = 3, C[8] = 0;
    check_fails (pg_contact_solve (&s, &p), PG_E_USAGE);
    C[8] = 1, gap[2] = NAN;
    check_fails (pg_contact_solve (&s, &p), PG_E_USAGE);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (one_pair_has_its_closed_form),
        cmocka_unit_test (a_plane_problem_is_the_same_in_space),
        cmocka_unit_test (frames_and_units_do_not_count),
        cmocka_unit_test (slip_has_a_memory),
        cmocka_unit_test (the_force_opposes_the_slip),
        cmocka_unit_test (violations_are_seen),
        cmocka_unit_test (what_is_no_problem_is_refused),
    };
    return cmocka_run_group_tests (tests, NULL, NULL);
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * The problem of complementarity of contact: closed forms of one pair, the obstacle under a string, every
 * combination of states of a few pairs tried out, histories of slip, scales, and what is refused. */
#include "check.h"
#include "perigal/contact.h"

enum { MOST = 64 };
typedef struct { double force[2 * MOST], gap[2 * MOST]; unsigned char status[MOST]; } room;

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

/* C = B B' + a little of the unit matrix, of n pairs. */
static void random_compliance (size_t n, uint64_t *seed, double *C)
{
    double B[4 * 16 * 16];
    size_t rows = 2 * n;
    for (size_t i = 0; i < rows * rows; i++) B[i] = random_number (seed);
    for (size_t i = 0; i < rows; i++)
        for (size_t j = 0; j < rows; j++) {
            double sum = i == j ? 0.3 : 0;
            for (size_t k = 0; k < rows; k++) sum += B[i * rows + k] * B[j * rows + k];
            C[i * rows + j] = sum;
        }
}

/* C_nn = 2, C_tt = 4, nothing between: f_n = -g_n / 2; the slip of 1.2 m is stopped by a force of at most
 * mu f_n + c, and what this does not stop remains. */
static void one_pair_has_its_closed_form (void **state)
{
    (void) state;
    static const double C[4] = { 2, 0, 0, 4 };
    static const struct { double gn, gt, mu, c, fn, ft, slip; pg_contact_status status; } cases[] = {
        { 0.5, 1.2, 0.5, 0, 0, 0, 1.2, PG_CONTACT_OPEN },
        { -1, 1.2, 0, 0, 0.5, 0, 1.2, PG_CONTACT_FORWARD },
        { -1, 1.2, 0.2, 0, 0.5, -0.1, 0.8, PG_CONTACT_FORWARD },
        { -1, -1.2, 0.2, 0, 0.5, 0.1, -0.8, PG_CONTACT_BACKWARD },
        { -1, 1.2, 0.7, 0, 0.5, -0.3, 0, PG_CONTACT_STICK },
        { -1, 1.2, 0.2, 0.1, 0.5, -0.2, 0.4, PG_CONTACT_FORWARD },
        { -1, -1.2, 0, 0.25, 0.5, 0.25, -0.2, PG_CONTACT_BACKWARD },
        { -1, 1.2, 0, 0.31, 0.5, -0.3, 0, PG_CONTACT_STICK },
        { 0.5, 1.2, 0.5, 0.3, 0, 0, 1.2, PG_CONTACT_OPEN },          /* what is apart has no cohesion */
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        room r;
        pg_contact_solution s = solution_in (&r);
        double gap[2] = { cases[i].gn, cases[i].gt };
        pg_contact_problem p = { 1, 2, C, gap, &cases[i].mu, &cases[i].c, NULL };
        check_ok (pg_contact_solve (&s, &p));
        check_absolute (r.force[0], cases[i].fn, 1e-15);
        check_absolute (r.force[1], cases[i].ft, 1e-15);
        check_absolute (r.gap[0], fmax (0, cases[i].gn), 1e-15);
        check_absolute (r.gap[1], cases[i].slip, 1e-15);
        assert_int_equal (r.status[0], cases[i].status);
        assert_int_equal (s.open, cases[i].status == PG_CONTACT_OPEN);
        assert_int_equal (s.stick, cases[i].status == PG_CONTACT_STICK);
        assert_int_equal (s.open + s.stick + s.sliding, 1);
        check_below (s.violation, 1e-15);
    }
}

/* A block on a spring is pushed to and fro: after the slip to 0.8 m the way back sticks until the shear force
 * has changed by twice its limit, 0.2 N, that is 0.8 m of the free slip; then it slides the other way. */
static void slip_has_a_memory (void **state)
{
    (void) state;
    static const double C[4] = { 2, 0, 0, 4 }, mu = 0.2;
    static const double drive[] = { 0.3, 1.2, 0.9, 0.5, 0.39, 0, -0.5, 0 };
    static const double goal[] = { 0, 0.8, 0.8, 0.8, 0.79, 0.4, -0.1, -0.1 };
    double slip = 0;
    for (size_t i = 0; i < sizeof drive / sizeof *drive; i++) {
        room r;
        pg_contact_solution s = solution_in (&r);
        double gap[2] = { -1, drive[i] };
        pg_contact_problem p = { 1, 2, C, gap, &mu, NULL, &slip };
        check_ok (pg_contact_solve (&s, &p));
        check_absolute (r.gap[1], goal[i], 1e-14);
        check_below (s.violation, 1e-14);
        slip = r.gap[1];
    }
}

/* Solves the equations of one combination of states and says whether all inequalities hold. */
static int stands (const pg_contact_problem *p, const int *kind, double *force)
{
    double A[36] = { 0 };
    size_t rows = 2 * p->n;
    for (size_t k = 0; k < p->n; k++) {
        double s = kind[k] == PG_CONTACT_FORWARD ? 1 : kind[k] == PG_CONTACT_BACKWARD ? -1 : 0;
        size_t i = 2 * k;
        for (size_t j = 0; j < rows; j++)
            A[j * rows + i] = kind[k] == PG_CONTACT_OPEN ? i == j : p->C[i * rows + j],
            A[j * rows + i + 1] = kind[k] == PG_CONTACT_STICK ? p->C[(i + 1) * rows + j] : i + 1 == j;
        force[i] = kind[k] == PG_CONTACT_OPEN ? 0 : -p->gap[i];
        force[i + 1] = kind[k] == PG_CONTACT_STICK ? -p->gap[i + 1] : 0;
        if (s != 0) A[i * rows + i + 1] = s * p->coefficient[k];
    }
    if (pg_dense_lu (rows, A, 1, force) != PG_OK) return 0;
    for (size_t k = 0; k < p->n; k++) {
        double g[2] = { p->gap[2*k], p->gap[2*k + 1] }, fn = force[2*k], ft = force[2*k + 1];
        for (size_t j = 0; j < rows; j++)
            g[0] += p->C[2*k * rows + j] * force[j], g[1] += p->C[(2*k + 1) * rows + j] * force[j];
        if (kind[k] == PG_CONTACT_OPEN ? g[0] < 0 : fn < 0) return 0;
        if (kind[k] == PG_CONTACT_STICK && fabs (ft) > p->coefficient[k] * fn) return 0;
        if (kind[k] == PG_CONTACT_FORWARD && g[1] < 0) return 0;
        if (kind[k] == PG_CONTACT_BACKWARD && g[1] > 0) return 0;
    }
    return 1;
}

/* Three pairs that lean on each other: of their 64 combinations one solves the problem (friction is small
 * enough for it to be unique), and it is the one that is found. */
static void of_all_combinations_the_right_one_is_found (void **state)
{
    (void) state;
    uint64_t seed = 7;
    size_t kinds[4] = { 0 };
    for (int trial = 0; trial < 200; trial++) {
        double C[36], gap[6], mu[3], force[6], found[6];
        random_compliance (3, &seed, C);
        for (int i = 0; i < 6; i++) gap[i] = random_number (&seed) - (i % 2 ? 0 : 0.3);
        for (int k = 0; k < 3; k++) mu[k] = trial % 3 == 0 ? 0 : 0.2 * (1 + random_number (&seed));
        pg_contact_problem p = { 3, 2, C, gap, mu, NULL, NULL };
        int solutions = 0;
        for (int combination = 0; combination < 64; combination++) {
            int kind[3] = { combination % 4, combination / 4 % 4, combination / 16 };
            int smooth = 0;                            /* sticking without friction: the same as sliding */
            for (int k = 0; k < 3; k++) smooth |= mu[k] == 0 && kind[k] == PG_CONTACT_STICK;
            if (smooth || !stands (&p, kind, force)) continue;
            solutions++, memcpy (found, force, sizeof found);
        }
        if (solutions != 1) continue;
        room r;
        pg_contact_solution s = solution_in (&r);
        check_ok (pg_contact_solve (&s, &p));
        for (int i = 0; i < 6; i++) check_absolute (r.force[i], found[i], 1e-11);
        check_below (s.violation, 1e-12);
        for (int k = 0; k < 3; k++) kinds[r.status[k]]++;
    }
    /* the trials have shown every state */
    for (int k = 0; k < 4; k++) assert_true (kinds[k] > 20);
}

/* A string of length 1 and tension 1, pulled down onto a flat floor at depth a by a load p on its whole
 * length: it lies on the floor between x = b and 1 - b, b = sqrt (2 a / p). Its compliance is the Green
 * function x (1 - y), far from diagonal. */
static void a_string_lies_on_its_floor (void **state)
{
    (void) state;
    enum { N = 49 };
    const double a = 0.02, p = 1;
    double C[4 * N * N] = { 0 }, gap[2 * N] = { 0 }, b = sqrt (2 * a / p);
    for (size_t i = 0; i < N; i++) {
        double x = (double) (i + 1) / (N + 1);
        for (size_t j = 0; j < N; j++) {
            double y = (double) (j + 1) / (N + 1);
            C[2*i * 2*N + 2*j] = x < y ? x * (1 - y) : y * (1 - x);
        }
        C[(2*i + 1) * 2*N + 2*i + 1] = 1;
        gap[2*i] = a - 0.5 * p * x * (1 - x);
    }
    pg_contact_problem problem = { N, 2, C, gap, NULL, NULL, NULL };
    room r;
    pg_contact_solution s = solution_in (&r);
    check_ok (pg_contact_solve (&s, &problem));
    check_below (s.violation, 1e-12);
    double sum = 0;
    for (size_t i = 0; i < N; i++) {
        double x = (double) (i + 1) / (N + 1);
        if (x > b + 0.02 && x < 1 - b - 0.02) {
            assert_int_not_equal (r.status[i], PG_CONTACT_OPEN);
            if (x > b + 0.04 && x < 1 - b - 0.04) check_relative (r.force[2*i] * (N + 1), p, 1e-9);
        }
        if (x < b - 0.02 || x > 1 - b + 0.02) assert_int_equal (r.status[i], PG_CONTACT_OPEN);
        sum += r.force[2*i];
    }
    check_relative (sum, p * (1 - 2 * b), 1e-9);       /* no slope where it meets the floor, no peak */
}

/* k times the gaps make k times the forces and the same states; so does another unit of length. */
static void forces_follow_the_gaps (void **state)
{
    (void) state;
    static const double factor[] = { 1e-3, 0.125, 1e3, 1048576 };
    uint64_t seed = 11;
    double C[4 * 64], gap[16], mu[8], scaled[16], other[4 * 64];
    random_compliance (8, &seed, C);
    for (int i = 0; i < 16; i++) gap[i] = random_number (&seed) - (i % 2 ? 0 : 0.4);
    for (int k = 0; k < 8; k++) mu[k] = 0.15;
    pg_contact_problem p = { 8, 2, C, gap, mu, NULL, NULL };
    room one, more;
    pg_contact_solution s = solution_in (&one), t = solution_in (&more);
    check_ok (pg_contact_solve (&s, &p));
    assert_true (s.open > 0 && s.sliding > 0 && s.stick > 0);
    for (size_t f = 0; f < sizeof factor / sizeof *factor; f++)
        for (int unit = 0; unit < 2; unit++) {         /* unit 1: lengths in other units, forces stay */
            for (int i = 0; i < 16; i++) scaled[i] = factor[f] * gap[i];
            for (int i = 0; i < 4 * 64; i++) other[i] = unit ? factor[f] * C[i] : C[i];
            pg_contact_problem q = { 8, 2, other, scaled, mu, NULL, NULL };
            check_ok (pg_contact_solve (&t, &q));
            for (int i = 0; i < 16; i++) {
                check_absolute (more.force[i] / (unit ? 1 : factor[f]), one.force[i], 1e-13);
                check_absolute (more.gap[i] / factor[f], one.gap[i], 1e-13);
            }
            assert_memory_equal (more.status, one.status, 8);
        }
}

/* The other way round along the surface: shear forces and slips change sign, and nothing else does. */
static void a_mirrored_problem_has_the_mirrored_solution (void **state)
{
    (void) state;
    uint64_t seed = 5;
    double C[4 * 25], gap[10], mu[5] = { 0.2, 0.1, 0, 0.2, 0.1 }, other[4 * 25], turned[10];
    random_compliance (5, &seed, C);
    for (int i = 0; i < 10; i++) gap[i] = random_number (&seed) - (i % 2 ? 0 : 0.5);
    for (int i = 0; i < 10; i++) {
        turned[i] = i % 2 ? -gap[i] : gap[i];
        for (int j = 0; j < 10; j++) other[10*i + j] = (i + j) % 2 ? -C[10*i + j] : C[10*i + j];
    }
    pg_contact_problem p = { 5, 2, C, gap, mu, NULL, NULL }, q = { 5, 2, other, turned, mu, NULL, NULL };
    room a, b;
    pg_contact_solution s = solution_in (&a), t = solution_in (&b);
    check_ok (pg_contact_solve (&s, &p));
    check_ok (pg_contact_solve (&t, &q));
    assert_true (s.sliding > 0);
    for (int i = 0; i < 10; i++) {
        check_absolute (b.force[i], (i % 2 ? -1 : 1) * a.force[i], 1e-13);
        check_absolute (b.gap[i], (i % 2 ? -1 : 1) * a.gap[i], 1e-13);
    }
}

/* A wrong solution violates its conditions: every one of them is measured. */
static void violations_are_seen (void **state)
{
    (void) state;
    static const double C[4] = { 1, 0, 0, 1 }, mu = 0.5;
    static const struct { double gn, gt, fn, ft, worst; } cases[] = {
        { -0.1, 0, 0.9, 0, 0.1 },                      /* overlap */
        { 0.1, 0, 1.1, 0, 0.1 },                       /* pressed while open */
        { 0, 0, -0.1, 0, 0.1 },                        /* pulled */
        { 0, 0, 1, 0.6, 0.1 },                         /* more shear than friction gives */
        { 0, 0.1, 1, -0.3, 0.1 },                      /* slip below the limit */
        { 0, 0.1, 1, 0.5, 0.1 },                       /* slip with the shear force instead of against it */
        { 0, 0.1, 1, -0.5, 0 }, { 0, 0, 1, 0.4, 0 }, { 0.7, 2, 0, 0, 0 },
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        room r = { { cases[i].fn, cases[i].ft }, { cases[i].gn, cases[i].gt }, { 0 } };
        pg_contact_solution s = solution_in (&r);
        double free_gap[2] = { 1, 0.5 };
        pg_contact_problem p = { 1, 2, C, free_gap, &mu, NULL, NULL };
        check_absolute (pg_contact_violation (&p, &s), cases[i].worst, 1e-15);
    }
}

static void what_is_no_problem_is_refused (void **state)
{
    (void) state;
    double C[4] = { 1, 0, 0, 1 }, gap[2] = { -1, 0 }, mu = -0.1;
    room r;
    pg_contact_solution s = solution_in (&r);
    pg_contact_problem p = { 1, 2, C, gap, &mu, NULL, NULL };
    check_fails (pg_contact_solve (&s, &p), PG_E_USAGE);
    p.coefficient = NULL, p.cohesion = &mu;
    check_fails (pg_contact_solve (&s, &p), PG_E_USAGE);
    p.cohesion = NULL, C[3] = 0;
    check_fails (pg_contact_solve (&s, &p), PG_E_USAGE);
    C[3] = NAN;
    check_fails (pg_contact_solve (&s, &p), PG_E_USAGE);
    C[3] = 1, gap[1] = NAN;
    check_fails (pg_contact_solve (&s, &p), PG_E_USAGE);
    p.n = 0;
    check_ok (pg_contact_solve (&s, &p));
    /* no gaps at all: no forces */
    gap[0] = gap[1] = 0, p.n = 1;
    check_ok (pg_contact_solve (&s, &p));
    assert_true (r.force[0] == 0 && r.force[1] == 0);
    /* one pair slides against its own normal: C_nt / C_nn too large for friction that high */
    double coupled[4] = { 1, 0.95, 0.95, 1 }, rough = 30, free_gap[2] = { 0.1, -1 };
    pg_contact_problem q = { 1, 2, coupled, free_gap, &rough, NULL, NULL };
    pg_status now = pg_contact_solve (&s, &q);
    assert_true (now == PG_OK ? s.violation < 1e-9 : now == PG_E_EQUILIBRIUM);
    pg_contact_problem again = { 1, 2, coupled, gap, NULL, NULL, NULL };
    gap[0] = -1;
    for (size_t k = 1; k <= 2; k++) {
        pg_memory_fail_at (k);
        check_fails (pg_contact_solve (&s, &again), PG_E_MEMORY);
        pg_memory_fail_at (0);
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (one_pair_has_its_closed_form),
        cmocka_unit_test (slip_has_a_memory),
        cmocka_unit_test (of_all_combinations_the_right_one_is_found),
        cmocka_unit_test (a_string_lies_on_its_floor),
        cmocka_unit_test (forces_follow_the_gaps),
        cmocka_unit_test (a_mirrored_problem_has_the_mirrored_solution),
        cmocka_unit_test (violations_are_seen),
        cmocka_unit_test (what_is_no_problem_is_refused),
    };
    return cmocka_run_group_tests (tests, NULL, NULL);
}

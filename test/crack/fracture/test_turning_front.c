/* SPDX-License-Identifier: GPL-3.0-or-later
 * The terms of the integrals along a front that turns about all three axes, one of them its own (the front of
 * a crack that grows as a helicoid): at single places against the integrals as they stand in the comment of
 * front_integrals.c, with every derivative by differences in space. */
#include "check.h"
#include "crack/fracture/front.h"

static const double h = 1, turn[3] = { 0.08, -0.11, 0.17 };       /* per spacing */
static const tip_material elastic = { .dim = 3, .mu = 1.25, .kappa = 1.8, .modulus = 8 * 1.25 / 2.8 };

/* Product of 3 x 3 matrices, a transposed if asked. */
static void product (int transposed, const double *a, const double *b, double *out)
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            out[3*i + j] = 0;
            for (int k = 0; k < 3; k++) out[3*i + j] += (transposed ? a[3*k + i] : a[3*i + k]) * b[3*k + j];
        }
}

/* Frame (rows e, n, t) and place at the arc length s: db/ds = turn x b in the frame, by the rotation about an
 * axis that stays. */
static void front_along (double s, double *frame, double *place)
{
    double size = sqrt (turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2]), a[3], t = s * size;
    for (int k = 0; k < 3; k++) a[k] = turn[k] / size;
    for (int b = 0; b < 3; b++)
        for (int c = 0; c < 3; c++) {
            int d = 3 - b - c;
            double cross = b == c ? 0 : ((b + 1) % 3 == c ? 1 : -1) * a[d];       /* (a x unit b)_c */
            frame[3*b + c] = (b == c) * cos (t) + sin (t) * cross + (1 - cos (t)) * a[b] * a[c];
        }
    /* integral of the row t */
    for (int c = 0; c < 3; c++) {
        double cross = c == 2 ? 0 : (c == 0 ? 1 : -1) * a[1 - c];
        place[c] = ((c == 2) * sin (t) + (1 - cos (t)) * cross + (t - sin (t)) * a[2] * a[c]) / size;
    }
}

/* q = e Q (r), A and S of an exact field at x, in the axes of the frame at s = 0. */
static void fields_at (int field, double r2, const double *x, double *q, double *A, double *S)
{
    double s = 0, frame[9], place[3], y[3], of[2][9], half[9];
    for (int again = 0; again < 30; again++) {
        front_along (s, frame, place);
        s += (x[0] - place[0]) * frame[6] + (x[1] - place[1]) * frame[7] + (x[2] - place[2]) * frame[8];
    }
    front_along (s, frame, place);
    for (int i = 0; i < 3; i++)
        y[i] = (x[0] - place[0]) * frame[3*i] + (x[1] - place[1]) * frame[3*i + 1] + (x[2] - place[2])
            * frame[3*i + 2];
    assert_true (fabs (y[2]) < 1e-12);
    double r = hypot (y[0], y[1]), Q = front_weight (r, h, r2, NULL);
    front_near_field (field, &elastic, r, atan2 (y[1], y[0]), NULL, of[0], of[1]);
    product (0, of[0], frame, half), product (1, frame, half, A);
    product (0, of[1], frame, half), product (1, frame, half, S);
    for (int k = 0; k < 3; k++) q[k] = Q * frame[k];
}

/* Derivatives along the three axes: dq[3 k + j] = q_k,j, dA[9 j + ..]. */
static void derivatives (int field, double r2, const double *x, double *dq, double *dA, double *dS)
{
    const double step = 1e-5;
    for (int j = 0; j < 3; j++) {
        double p[3], q[2][3], A[2][9], S[2][9];
        for (int side = 0; side < 2; side++) {
            memcpy (p, x, sizeof p);
            p[j] += side ? step : -step;
            fields_at (field, r2, p, q[side], A[side], S[side]);
        }
        for (int k = 0; k < 3; k++) dq[3*k + j] = (q[1][k] - q[0][k]) / (2 * step);
        for (int i = 0; i < 9; i++)
            dA[9*j + i] = (A[1][i] - A[0][i]) / (2 * step), dS[9*j + i] = (S[1][i] - S[0][i]) / (2 * step);
    }
}

/* A uniform field: what it is does not matter, but that the stress is symmetric. */
static double H[9] = { 0.3, -0.7, 0.2, 0.5, -0.4, 0.9, -0.6, 0.1, 0.8 },
              sigma[9] = { 1.1, -0.3, 0.6, -0.3, 0.7, 0.4, 0.6, 0.4, -0.9 };

/* I at a place: [sigma_ij A_ik + S_ij u_i,k - sigma:A delta_kj] q_k,j + [sigma_ij (A_ik,j - eps_ij,k) +
 * S_ij,j u_i,k] q_k. J: P_kj q_k,j. */
static double by_definition (int field, double r2, const double *x, double *J)
{
    double q[3], A[9], S[9], dq[9], dA[27], dS[27], sum = 0, W = 0, own = 0;
    fields_at (field, r2, x, q, A, S);
    derivatives (field, r2, x, dq, dA, dS);
    for (int i = 0; i < 9; i++) W += sigma[i] * A[i], own += 0.5 * sigma[i] * H[i];
    *J = 0;
    for (int k = 0; k < 3; k++)
        for (int j = 0; j < 3; j++) {
            sum -= (k == j) * W * dq[3*k + j], *J -= (k == j) * own * dq[3*k + j];
            for (int i = 0; i < 3; i++) {
                sum += (sigma[3*i + j] * A[3*i + k] + S[3*i + j] * H[3*i + k]) * dq[3*k + j];
                *J += sigma[3*i + j] * H[3*i + k] * dq[3*k + j];
                double strain = 0.5 * (dA[9*k + 3*i + j] + dA[9*k + 3*j + i]);
                sum += q[k] * (sigma[3*i + j] * (dA[9*j + 3*i + k] - strain) + dS[9*j + 3*i + j] * H[3*i
                    + k]);
            }
        }
    return sum;
}

static void a_place_has_the_terms_of_the_definition (void **state)
{
    enum { ANGLES = 32 };                              /* of a ring of places */
    static const int ring[] = { 2, 5, 8, 11, 14 }, angle[] = { 1, 7, 13, 18, 26, 30 };
    front_places q;
    measuring m = { .nfield = 1, .h = h, .r1 = h };
    cross_section s = { .at = { .frame = { 1, 0, 0, 0, 1, 0, 0, 0, 1 }, .speed = 1 }, .radii = FRONT_RADII,
                        .material = elastic };
    double turned = 0;
    (void) state;
    memcpy (s.at.turn, turn, sizeof turn);
    for (int i = 0; i < FRONT_RADII; i++) m.radius[i] = front_radius[i] * h;
    check_ok (front_places_make (&q, h));
    front_sample *f = &q.field[0];
    f->H = pg_calloc (9 * q.n, sizeof *f->H), f->S = pg_calloc (9 * q.n, sizeof *f->S);
    for (size_t k = 0; k < q.n; k++)
        memcpy (f->H + 9*k, H, sizeof H), memcpy (f->S + 9*k, sigma, sizeof sigma);
    for (size_t a = 0; a < sizeof ring / sizeof *ring; a++)
        for (size_t b = 0; b < sizeof angle / sizeof *angle; b++) {
            size_t k = (size_t) (ring[a] * ANGLES + angle[b]);
            double r = q.r[k], theta = q.theta[k], x[3] = { r * cos (theta), r * sin (theta), 0 }, J,
                   L = 1 - turn[1] * x[0] + turn[0] * x[1];
            front_sums sums;
            front_integrals (&sums, &m, &s, &q, k, k + 1);
            for (int i = 0; i < FRONT_RADII; i++)
                for (int field_of = 0; field_of < FRONT_FIELDS; field_of++) {
                    if (r >= m.radius[i]) continue;
                    double right = L * by_definition (field_of, m.radius[i], x, &J);
                    check_scaled (sums.I[i][field_of][0] / q.area[k], right, 1e-6, 1);
                    check_scaled (sums.J[i][0][0] / q.area[k], L * J, 1e-6, 1);
                    turned = fmax (turned, fabs (right));
                }
        }
    places_clear (&q);
    assert_true (turned > 0.1);
}

/* The frame of the test turns as it is said to. */
static void the_frame_turns (void **state)
{
    double low[9], high[9], a[3], b[3], e = 1e-5;
    (void) state;
    front_along (-e, low, a), front_along (e, high, b);
    for (int i = 0; i < 3; i++)
        for (int c = 0; c < 3; c++) {
            int p = (c + 1) % 3, q = (c + 2) % 3;
            check_scaled ((high[3*i + c] - low[3*i + c]) / (2 * e), turn[p] * (i == q) - turn[q] * (i ==
                p), 1e-8, 1);
        }
    for (int c = 0; c < 3; c++) check_scaled ((b[c] - a[c]) / (2 * e), c == 2, 1e-8, 1);
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (the_frame_turns),
                                        cmocka_unit_test (a_place_has_the_terms_of_the_definition) };
    return cmocka_run_group_tests_name ("crack/fracture/turning_front", tests, NULL, NULL);
}

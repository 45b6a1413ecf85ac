/* SPDX-License-Identifier: GPL-3.0-or-later
 * Zhou's examples 3 and 4 at twice their spacing. Example 3: outer tips run level, inner ones turn towards
 * the neighbours at about 20 to 23 degrees, by direct sums and where points fail by their energy; both ends
 * of the plate alike. Example 4: crack 2 has joined cracks 1 and 3, and stopped, before these reach the
 * edges. Example 5, four random cracks: which ends grow, which grow together and which hardly grow, by direct
 * sums with sharp cracks and by energies of points with slots (always at the scene's own spacing: a coarser
 * lattice does not resolve the slots). PERIGAL_LONG: all at the scenes' own spacing.
 */
#include "run.h"

/* Middles of all bonds that broke, mm, and when, us. */
typedef struct { size_t n, cap; double (*at)[3]; double spacing; } cut;

static cut broken_in (const char *scene, size_t nmore, const char *const *more)
{
    const char *set[8] = { getenv ("PERIGAL_LONG") ? "spacing=0.25 mm" : "spacing=0.5 mm" };
    for (size_t k = 0; k < nmore; k++) set[1 + k] = more[k];
    run r = loaded (scene, 1 + nmore, set);
    cut c = { .spacing = 1e3 * r.problem->cloud.h };
    while (!pg_solver_done (r.solver, r.state)) {
        advance (&r);
        if (c.n + r.step.nbroken > c.cap) {
            c.cap = 2 * (c.n + r.step.nbroken);
            c.at = realloc (c.at, c.cap * sizeof *c.at);
            assert_non_null (c.at);
        }
        for (size_t i = 0; i < r.step.nbroken; i++, c.n++) {
            c.at[c.n][0] = 1e3 * r.step.broken[i].place[0], c.at[c.n][1] = 1e3 * r.step.broken[i].place[1];
            c.at[c.n][2] = 1e6 * r.step.broken[i].time;
        }
    }
    clear (&r);
    assert_true (c.n > 1000);
    return c;
}

/* Height of the path that leaves a tip sideways (sign +1, -1), over the height of the tip, in the column of
 * points k spacings on: the mean of what broke there on the tip's side of the axis. NAN: nothing. */
static double height (const cut *c, const double tip[2], int sign, double far, size_t k)
{
    double sum = 0;
    size_t n = 0;
    for (size_t i = 0; i < c->n; i++) {
        double s = (c->at[i][0] - tip[0]) * sign, y = c->at[i][1] / tip[1];
        if (y > 0 && s > 0 && s < far && (size_t) (s / c->spacing) == k) sum += y, n++;
    }
    return n ? sum / (double) n : NAN;
}

/* Angle to the axis at which a path comes down from 0.8 to 0.4 of the height of its tip, degrees; NAN: it
 * does not get there. */
static double descent (const cut *c, const double tip[2], int sign, double far)
{
    static const double level[2] = { .8, .4 };
    double at[2] = { NAN, NAN }, before = height (c, tip, sign, far, 0);
    for (size_t k = 1; (double) k * c->spacing < far; k++) {
        double now = height (c, tip, sign, far, k);
        for (int l = 0; l < 2; l++)
            if (isnan (at[l]) && before >= level[l] && now < level[l])
                at[l] = ((double) k - .5 + (before - level[l]) / (before - now)) * c->spacing;
        if (!isnan (now)) before = now;
    }
    return 180 / M_PI * atan (.4 * fabs (tip[1]) / (at[1] - at[0]));
}

/* Slope of the path between two places, by least squares over what broke there, degrees. */
static double slope (const cut *c, double x0, double x1)
{
    double n = 0, x = 0, y = 0, xx = 0, xy = 0;
    for (size_t i = 0; i < c->n; i++) {
        const double *p = c->at[i];
        if (p[0] < x0 || p[0] > x1) continue;
        n++, x += p[0], y += p[1], xx += p[0] * p[0], xy += p[0] * p[1];
    }
    return 180 / M_PI * atan ((n * xy - x * y) / (n * xx - x * x));
}

/* Tips of neighbours are 12.34 mm apart along x; the paths of crack 2 may end on the neighbour. */
static void turns_inwards (const char *what, size_t nmore, const char *const *more)
{
    static const double tip_1[2] = { -16.67, 2.5 }, tip_2[2] = { 4.33, 2.5 },
                        tip_2_left[2] = { -4.33, -2.5 };
    cut c = broken_in ("data/zhou_3/scene.yaml", nmore, more);
    double one = descent (&c, tip_1, 1, 12.34), two = descent (&c, tip_2, 1, 17),
           left = descent (&c, tip_2_left, -1, 17), out[2] = { slope (&c, -40, -27), slope (&c, 27, 40) };
    double mean = isnan (one) ? two : (one + two) / 2;
    print_message ("%s: crack 1 inwards %.1f, crack 2 %.1f and %.1f, mean %.1f; outwards %.2f, %.2f "
                   "degrees\n",
                   what, one, left, two, mean, out[0], out[1]);
    check_below (18, mean);
    check_below (mean, 25);
    check_relative (left, two, 1e-6);                        /* turned by half a circle the plate is itself */
    check_below (fabs (out[0]), 3.5);
    check_below (fabs (out[1]), 3.5);
    free (c.at);
}

/* PERIGAL_TEST_SIZE=long: by energies of points, too, as the fifth. */
static void example_3 (void **unused)
{
    (void) unused;
    turns_inwards ("bonds", 0, NULL);
    if (!longer ()) return;
    static const char *const points[] = { "method.force=fcbm", "method.evaluation=stencil",
                                          "failure.criterion=node_energy" };
    turns_inwards ("points", 3, points);
}

/* When the first bond broke in a level strip, us; INFINITY: none. */
static double first_in (const cut *c, double x0, double x1, double y)
{
    double first = INFINITY;
    for (size_t i = 0; i < c->n; i++)
        if (c->at[i][0] > x0 && c->at[i][0] < x1 && fabs (c->at[i][1]) < y)
            first = fmin (first, c->at[i][2]);
    return first;
}

/* Cracks 1 and 3 pass x = -18 and 18 mm at y = 0. Behind them, in the middle of the plate, hardly a bond
 * breaks once they have been reached; their other ends then go on to the edges. */
static void example_4 (void **unused)
{
    (void) unused;
    cut c = broken_in ("data/zhou_4/scene.yaml", 0, NULL);
    double joins[2] = { first_in (&c, -18.5, -16.5, 2), first_in (&c, 16.5, 18.5, 2) },
           edges[2] = { first_in (&c, -51, -49, 20), first_in (&c, 49, 51, 20) };
    size_t between = 0, late = 0;
    for (size_t i = 0; i < c.n; i++)
        if (fabs (c.at[i][0]) < 15) between++, late += c.at[i][2] > fmax (joins[0], joins[1]) + 10;
    print_message ("crack 2 joins at %.1f and %.1f us, edges are reached at %.1f and %.1f us; %zu of %zu "
                   "bonds between the cracks break later\n",
                   joins[0], joins[1], edges[0], edges[1], late, between);
    assert_true (isfinite (joins[0]) && isfinite (joins[1]) && isfinite (edges[0]) && isfinite (edges[1]));
    check_below (fmax (joins[0], joins[1]) + 10, fmin (edges[0], edges[1]));
    check_below ((double) late, .05 * (double) between);
    free (c.at);
}

/* When the first bond broke in a box, us; INFINITY: none. */
static double first_in_box (const cut *c, const double low[2], const double high[2])
{
    double first = INFINITY;
    for (size_t i = 0; i < c->n; i++) {
        const double *p = c->at[i];
        if (p[0] > low[0] && p[0] < high[0] && p[1] > low[1] && p[1] < high[1]) first = fmin (first, p[2]);
    }
    return first;
}

/* Crack 1 grows down to the left edge and up into crack 2, crack 4 to the right edge and to the left below
 * all others, and the lower end of crack 2, at (-9.6, 0.89), grows by at most two horizons. Grown together
 * and cut through at both edges is the plate before crack 4 has passed below crack 2. */
static void story_of_example_5 (const char *scene, size_t nmore, const char *const *more)
{
    cut c = broken_in (scene, nmore, more);
    double joined = first_in_box (&c, (double[]) { -9.5, 9 }, (double[]) { -7, 12 }),
           left = first_in_box (&c, (double[]) { -26, -3.5 }, (double[]) { -24, .5 }),
           right = first_in_box (&c, (double[]) { 24, -6.5 }, (double[]) { 26, -2.5 }),
           below = first_in_box (&c, (double[]) { -9.5, -5.5 }, (double[]) { -8.5, -1.5 });
    double idle = 0;
    for (size_t i = 0; i < c.n; i++) {
        double dx = c.at[i][0] + 9.6, dy = c.at[i][1] - .89;
        if (hypot (dx, dy) < 3.5 && fabs (dy) < 1.8) idle = fmax (idle, hypot (dx, dy));
    }
    print_message ("%s: 1 joins 2 at %.1f us, edges at %.1f and %.1f us, 4 passes below 2 at %.1f us; the "
                   "lower end of 2 grows by %.2f mm\n",
                   scene, joined, left, right, below, idle);
    assert_true (isfinite (joined) && isfinite (left) && isfinite (right) && isfinite (below));
    check_below (fmax (joined, fmax (left, right)), below);
    check_below (idle, 2 * 3.015 * c.spacing);
    free (c.at);
}

static void example_5 (void **unused)
{
    (void) unused;
    static const char *const points[] = { "method.evaluation=stencil", "spacing=0.25 mm" };
    story_of_example_5 ("data/zhou_5/scene.yaml", 0, NULL);
    if (!longer ()) return;
    story_of_example_5 ("data/zhou_5/scene_fcbm.yaml", 2, points);
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (example_3), cmocka_unit_test (example_4),
                                        cmocka_unit_test (example_5) };
    return cmocka_run_group_tests (tests, NULL, NULL);
}

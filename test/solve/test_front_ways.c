/* SPDX-License-Identifier: GPL-3.0-or-later
 * How far the vertices of crack fronts go in an event: waves of what they set free against the closed form,
 * who stays, mirror images, units. */
#include "check.h"
#include "perigal.h"
#include "solve/growth/front_growth.h"
#include <stdlib.h>

/* A circle of n vertices and radius r, u from a function of the angle; ways by facets of length l. */
enum { MOST = 400 };
typedef struct { front_growth f; pg_front front; double *x; size_t n; } circle;

static circle circle_of (size_t n, double r, double l, double (*u) (double angle))
{
    circle c = { .n = n };
    double length[MOST];
    c.x = malloc (3 * n * sizeof *c.x);
    c.front = (pg_front) { .n = n, .closed = 1, .open = 1, .x = c.x };
    c.f.n = n, c.f.nfront = 1;
    c.f.first = calloc (2, sizeof *c.f.first), c.f.first[1] = n;
    c.f.vertex = calloc (n, sizeof *c.f.vertex);
    for (size_t i = 0; i < n; i++) {
        double a = 2 * acos (-1) * (double) i / (double) n;
        c.x[3*i] = r * cos (a), c.x[3*i + 1] = r * sin (a), c.x[3*i + 2] = 0, length[i] = l;
        c.f.vertex[i].share = u (a);
    }
    check_ok (fronts_couple (&c.f, &c.front));
    fronts_set_ways (&c.f, length);
    return c;
}

static void clear (circle *c)
{
    free (c->x), free (c->f.first), free (c->f.vertex);
    pg_free (c->f.couple), pg_free (c->f.factor), pg_free (c->f.forward), pg_free (c->f.line);
    pg_free (c->f.going), pg_free (c->f.goes);
}

static double alike (double angle) { (void) angle; return 1.3; }
static double waves (double angle) { return 1 + 0.01 * cos (6 * angle); }
static double bumps (double angle) { return 1 + 0.3 * cos (2 * angle + 0.3); }
static double bumps_mirrored (double angle) { return bumps (-angle); }

/* Where all set the same free all go alike, the length of a facet. */
static void what_is_alike_goes_alike (void **state)
{
    (void) state;
    circle c = circle_of (40, 6, 0.8, alike);
    for (size_t i = 0; i < c.n; i++) check_relative (c.f.vertex[i].way, 0.8, 1e-12);
    clear (&c);
}

/* u = u0 (1 + e cos 6 t) on a circle of radius r, k = 6 / r: the ways differ by e mu / u0 / (k / 2 + 1 / (p
 * l)) to first order, mu / u0 = 1 - 1 / p. The chords of a circle make Rice's sum that of Gao and Rice: a
 * wave of m periods has R d = (m - 1) / (2 r) d more than the first one, whose own is 1 / (2 r). */
static void waves_are_damped_as_they_should (void **state)
{
    (void) state;
    const double r = 12, p = 8;
    circle c = circle_of (96, r, 1, waves);
    double low = INFINITY, high = 0;
    for (size_t i = 0; i < c.n; i++)
        low = fmin (low, c.f.vertex[i].way), high = fmax (high, c.f.vertex[i].way);
    check_relative (high, 1, 1e-12);
    check_relative (high - low, 2 * 0.01 * (1 - 1 / p) / (6 / r / 2 + 1 / p), 0.02);
    clear (&c);
}

/* Who goes has reached the same, who stays has not; the longest way is that of a facet; half of the front
 * stays; its mirror image and millimetres change nothing. */
static void those_below_stay (void **state)
{
    (void) state;
    circle c = circle_of (50, 8, 1, bumps), d = circle_of (50, 8, 1, bumps_mirrored),
           e = circle_of (50, 8e-3, 1e-3, bumps);
    size_t stay = 0;
    double mu[2] = { INFINITY, 0 }, top = 0, behind = 0;
    for (size_t i = 0; i < c.n; i++) {
        const front_vertex *v = &c.f.vertex[i];
        double sum = v->way / 8;
        for (size_t j = 0; j < c.n; j++) sum += c.f.couple[i * c.n + j] * c.f.vertex[j].way / v->width;
        double after = v->share * (1 - sum);
        top = fmax (top, v->way);
        assert_true (v->way >= 0);
        if (v->way > 0) mu[0] = fmin (mu[0], after), mu[1] = fmax (mu[1], after);
        else stay++, behind = fmax (behind, after);
        check_absolute (d.f.vertex[(c.n - i) % c.n].way, v->way, 1e-12);
        check_absolute (e.f.vertex[i].way * 1e3, v->way, 1e-12);
    }
    check_relative (top, 1, 1e-12);
    check_relative (mu[0], mu[1], 1e-9);
    check_below (behind, mu[1] * (1 + 1e-8));
    assert_true (stay > 10 && stay < 40);
    clear (&c), clear (&d), clear (&e);
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (what_is_alike_goes_alike),
                                        cmocka_unit_test (waves_are_damped_as_they_should),
                                        cmocka_unit_test (those_below_stay) };
    return cmocka_run_group_tests_name ("solve/front_ways", tests, NULL, NULL);
}

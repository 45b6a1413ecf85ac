/* SPDX-License-Identifier: GPL-3.0-or-later
 * Random networks of cracks: 1000 cracks of each distribution against its closed form (Kolmogorov and Smirnov
 * at a level of 1 %, seeds fixed), distances, amounts, places, seeds, units; and the generator against GSL.
 */
#include "parsed.h"
#include "../../../src/geometry/cloud/search/random.h"
#include <gsl/gsl_cdf.h>
#include <gsl/gsl_rng.h>
#include <gsl/gsl_sf_bessel.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* One metre wide; cracks of a few mm. */
#define SQUARE "dimension: 2\nbody: [{add: {box: {low: [0, 0], high: [1, 1]}}}]\n"
#define CUBE   "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [1, 1, 1]}}}]\n"

static pg_cracks network_of (const char *body, const char *cracks)
{
    char text[2000];
    pg_cracks all;
    snprintf (text, sizeof text, "%s%s", body, cracks);
    pg_scene *scene = parsed (text);
    check_ok (pg_network_read (&all, scene));
    pg_scene_free (&scene);
    return all;
}

static void must_fault (const char *body, const char *cracks, const char *part)
{
    char text[2000];
    pg_cracks all;
    snprintf (text, sizeof text, "%s%s", body, cracks);
    pg_scene *scene = parsed (text);
    check_fails (pg_network_read (&all, scene), PG_E_SCENE);
    check_contains (pg_last_error (), part);
    pg_scene_free (&scene);
}

static double length_of (const pg_crack *c) 
{
    return hypot (c->vertex[2] - c->vertex[0], c->vertex[3] - c->vertex[1]);
}

/* ---- goodness of fit ----------------------------------------------------------------------------------- */
static int ascending (const void *a, const void *b)
{
    double p = *(const double *) a, q = *(const double *) b;
    return (p > q) - (p < q);
}

/* The n probabilities u must be uniform in [0, 1]: the largest difference from the uniform distribution
 * exceeds 1.628 / sqrt (n) in 1 % of all samples. */
static void check_uniform (size_t n, double *u)
{
    double most = 0;
    qsort (u, n, sizeof *u, ascending);
    for (size_t i = 0; i < n; i++)
        most = fmax (most, fmax ((double) (i + 1) / (double) n - u[i], u[i] - (double) i / (double) n));
    if (!(most < 1.628 / sqrt ((double) n))) print_message ("largest difference %g of %zu\n", most, n);
    assert_true (most < 1.628 / sqrt ((double) n));
}

/* Probability of a length below x. */
typedef double (*distribution) (double x);
static double uniform_cdf (double x)     { return gsl_cdf_flat_P (x, 0.001, 0.004); }
static double normal_cdf (double x)      { return gsl_cdf_gaussian_P (x - 0.003, 0.0005); }
static double exponential_cdf (double x) { return gsl_cdf_exponential_P (x, 0.002); }
static double lognormal_cdf (double x)
{
    double s = log (1 + 0.25);                         /* deviation is half of the mean */
    return gsl_cdf_lognormal_P (x, log (0.002) - s / 2, sqrt (s));
}
static double power_cdf (double x)   { return (1 - pow (x / 0.001, -1.5)) / (1 - pow (10, -1.5)); }
static double inverse_cdf (double x) { return log (x / 0.001) / log (10); }
/* cut off at its mean */
static double half_cdf (double x)    { return 2 * gsl_cdf_gaussian_P (x - 0.003, 0.0005); }

static void lengths_have_their_distributions (void **state)
{
    (void) state;
    static const struct { const char *words; distribution cdf; } all[] = {
        { "distribution: uniform, min: 1 mm, max: 4 mm", uniform_cdf },
        { "distribution: normal, mean: 3 mm, deviation: 0.5 mm", normal_cdf },
        { "distribution: exponential, mean: 2 mm", exponential_cdf },
        { "distribution: lognormal, mean: 2 mm, deviation: 1 mm", lognormal_cdf },
        { "distribution: power_law, min: 1 mm, max: 10 mm, exponent: 2.5", power_cdf },
        { "distribution: power_law, min: 1 mm, max: 10 mm, exponent: 1", inverse_cdf },
        { "distribution: normal, mean: 3 mm, deviation: 0.5 mm, max: 3 mm", half_cdf },
    };
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) {
        char text[400];
        double u[1000];
        snprintf (text, sizeof text, "cracks: [{random: {seed: 11, count: 1000, length: {%s}}}]",
                  all[k].words);
        pg_cracks c = network_of (SQUARE, text);
        assert_int_equal (c.n, 1000);
        for (size_t i = 0; i < c.n; i++) u[i] = all[k].cdf (length_of (&c.crack[i]));
        check_uniform (c.n, u);
        pg_cracks_clear (&c);
    }
}

/* Angle of a crack from the x axis, in (-pi, pi]. */
static double angle_of (const pg_crack *c)
{
    return atan2 (c->vertex[3] - c->vertex[1], c->vertex[2] - c->vertex[0]);
}

/* By Simpson's rule from -pi. */
static double von_mises_cdf (double angle, double mean, double kappa)
{
    const double pi = acos (-1);
    enum { N = 400 };
    double x = remainder (angle - mean, 2 * pi), sum = 0, h = (x + pi) / N;
    for (int i = 0; i <= N; i++)
        sum += (i == 0 || i == N ? 1 : i % 2 ? 4 : 2) * exp (kappa * (cos (-pi + i * h) - 1));
    return sum * h / 3 / (2 * pi * gsl_sf_bessel_I0_scaled (kappa));
}

static void angles_have_their_distributions (void **state)
{
    (void) state;
    const double pi = acos (-1);
    static const char *const words[] = {
        "", ", angle: {distribution: uniform, min: 10 deg, max: 50 deg}",
        ", angle: {distribution: normal, mean: 40 deg, deviation: 10 deg}",
        ", angle: {distribution: von_mises, mean: 40 deg, concentration: 3}",
        ", angle: {distribution: von_mises, mean: 170 deg, concentration: 0.2}"
    };
    for (int k = 0; k < 5; k++) {
        char text[400];
        double u[1000];
        snprintf (text, sizeof text, "cracks: [{random: {seed: 5, count: 1000, length: 1 mm%s}}]", words[k]);
        pg_cracks c = network_of (SQUARE, text);
        for (size_t i = 0; i < c.n; i++) {
            double a = angle_of (&c.crack[i]);
            u[i] = k == 0   ? fmod (a + 2 * pi, pi) / pi
                   : k == 1 ? (a * 180 / pi - 10) / 40
                   : k == 2 ? gsl_cdf_gaussian_P (a * 180 / pi - 40, 10)
                   : k == 3 ? von_mises_cdf (a, 40 * pi / 180, 3)
                            : von_mises_cdf (a, 170 * pi / 180, 0.2);
            check_relative (length_of (&c.crack[i]), 1e-3, 1e-12);
        }
        check_uniform (c.n, u);
        pg_cracks_clear (&c);
    }
}

/* The height along the mean direction, and the turn about it, each uniform where it is asked for. */
static void normals_have_fishers_distribution (void **state)
{
    (void) state;
    static const double kappa[] = { 0, 6, 200 };
    const double pi = acos (-1);
    for (int k = 0; k < 3; k++) {
        char text[400];
        double u[1000], v[1000];
        snprintf (text, sizeof text,
                  "cracks: [{random: {seed: 8, count: 1000, length: 1 mm, normal: {mean: [0, 3, 4], "
                  "concentration: %g}}}]", kappa[k]);
        pg_cracks c = network_of (CUBE, text);
        for (size_t i = 0; i < c.n; i++) {
            const double *n = c.crack[i].normal;
            double h = 0.6 * n[1] + 0.8 * n[2], across = 0.8 * n[1] - 0.6 * n[2];
            u[i] = kappa[k] > 0 ? (exp (kappa[k] * (h - 1)) - exp (-2 * kappa[k])) / (1 - exp (-2 * kappa[k]))
                                : (h + 1) / 2;
            v[i] = (atan2 (across, n[0]) + pi) / (2 * pi);
            check_relative (n[0] * n[0] + n[1] * n[1] + n[2] * n[2], 1, 1e-14);
        }
        check_uniform (c.n, u);
        check_uniform (c.n, v);
        pg_cracks_clear (&c);
    }
}

static void places_have_their_distributions (void **state)
{
    (void) state;
    double u[1000], v[1000];
    pg_cracks c = network_of (SQUARE, "cracks: [{random: {seed: 2, count: 1000, length: 1 um}}]");
    for (size_t i = 0; i < c.n; i++) u[i] = c.crack[i].vertex[0], v[i] = c.crack[i].vertex[1];
    check_uniform (c.n, u), check_uniform (c.n, v);
    pg_cracks_clear (&c);
    c = network_of (SQUARE, "cracks: [{random: {seed: 2, count: 1000, length: 1 um, position: {distribution: "
                            "normal, mean: [0.5, 0.4], deviation: [5 cm, 2 cm]}}}]");
    for (size_t i = 0; i < c.n; i++) {
        u[i] = gsl_cdf_gaussian_P (c.crack[i].vertex[0] - 0.5, 0.05);
        v[i] = gsl_cdf_gaussian_P (c.crack[i].vertex[1] - 0.4, 0.02);
    }
    check_uniform (c.n, u), check_uniform (c.n, v);
    pg_cracks_clear (&c);
    c = network_of (SQUARE,
                    "cracks: [{random: {seed: 2, count: 100, length: 1 um, position: {low: [0.1, 0.2], "
                    "high: [0.3, 0.5]}}}]");
    for (size_t i = 0; i < c.n; i++) {
        assert_true (c.crack[i].vertex[0] > 0.0999 && c.crack[i].vertex[0] < 0.3001);
        assert_true (c.crack[i].vertex[1] > 0.1999 && c.crack[i].vertex[1] < 0.5001);
    }
    pg_cracks_clear (&c);
}

/* Lengths have their distribution also where long cracks find few places. */
static void a_narrow_body_does_not_prefer_short_cracks (void **state)
{
    (void) state;
    double u[1000];
    pg_cracks c =
        network_of ("dimension: 2\nbody: [{add: {box: {low: [0, 0], high: [1, 5 mm]}}}]\n",
                    "cracks: [{random: {seed: 11, count: 1000, length: {distribution: uniform, min: 1 "
                    "mm, max: 4 mm}}}]");
    for (size_t i = 0; i < c.n; i++) {
        u[i] = uniform_cdf (length_of (&c.crack[i]));
        assert_int_equal (c.crack[i].vain, 0);
    }
    check_uniform (c.n, u);
    pg_cracks_clear (&c);
}

/* ---- amounts, distances, the body ---------------------------------------------------------------------- */
/* Distance of a place from a segment. */
static double from_segment (const double *x, const pg_crack *c)
{
    double d;
    pg_segment_nearest (c->vertex, c->vertex + 2, x, NULL, &d);
    return d;
}

/* Least distance of two segments that do not cross: an end of one is nearest. */
static double apart (const pg_crack *a, const pg_crack *b)
{
    return fmin (fmin (from_segment (a->vertex, b), from_segment (a->vertex + 2, b)),
                 fmin (from_segment (b->vertex, a), from_segment (b->vertex + 2, a)));
}

static double side (const double *a, const double *b, const double *c)
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

static int cross (const pg_crack *a, const pg_crack *b)
{
    const double *p = a->vertex, *q = p + 2, *r = b->vertex, *s = r + 2;
    return side (p, q, r) * side (p, q, s) < 0 && side (r, s, p) * side (r, s, q) < 0;
}

static void the_least_distance_holds (void **state)
{
    (void) state;
    pg_cracks c =
        network_of (SQUARE, "cracks: [{from: [0.2, 0.5], to: [0.8, 0.5]}, {random: {seed: 4, count: "
                            "200, length: {distribution: uniform, min: 1 cm, max: 8 cm}, distance: 1 "
                            "cm}, width: 2 mm}]");
    double least = INFINITY;
    assert_int_equal (c.n, 201);
    for (size_t i = 0; i < c.n; i++)
        for (size_t j = 0; j < i; j++) {
            double gap = 0.5 * (c.crack[i].slot + c.crack[j].slot);
            assert_false (cross (&c.crack[i], &c.crack[j]));
            assert_true (apart (&c.crack[i], &c.crack[j]) >= 0.01 + gap - 1e-12);
            least = fmin (least, apart (&c.crack[i], &c.crack[j]) - gap);
        }
    assert_true (least < 0.0105);                      /* and is made use of */
    pg_cracks_clear (&c);
}

static void discs_keep_their_distance (void **state)
{
    (void) state;
    pg_cracks c =
        network_of (CUBE, "cracks: [{random: {seed: 4, count: 35, length: {distribution: uniform, min: "
                          "5 cm, max: 40 cm}, distance: 2 cm}}]");
    double least = INFINITY;
    for (size_t i = 0; i < c.n; i++)
        for (size_t j = 0; j < i; j++)
            for (size_t a = 0; a < 64; a++)            /* places on the rims */
                for (size_t b = 0; b < 64; b++) {
                    const double *x = c.crack[i].vertex + 3*a, *y = c.crack[j].vertex + 3*b;
                    double d = sqrt (pow (x[0] - y[0], 2) + pow (x[1] - y[1], 2) + pow (x[2] - y[2], 2));
                    assert_true (d >= 0.02);
                    least = fmin (least, d);
                }
    assert_true (least < 0.1);
    /* no rim passes through another disc */
    for (size_t i = 0; i < c.n; i++)
        for (size_t j = 0; j < c.n; j++)
            for (size_t a = 0; a < 64 && i != j; a++) {
                const double *x = c.crack[i].vertex + 3*a, *y = c.crack[i].vertex + 3 * ((a + 1) % 64);
                assert_false (pg_crack_cuts (&c.crack[j], 3, x, y, 1e-12));
            }
    pg_cracks_clear (&c);
}

static void amounts_are_met (void **state)
{
    (void) state;
    double removed = 0, last = 0, length = 0;
    pg_cracks c = network_of (SQUARE, "cracks: [{random: {fraction: 3 %, length: 5 cm}, width: 3 mm}]");
    for (size_t i = 0; i < c.n; i++) removed += last = 0.003 * length_of (&c.crack[i]);
    assert_true (removed >= 0.03 && removed - last < 0.03);
    pg_cracks_clear (&c);
    c = network_of (SQUARE,
                    "cracks: [{random: {intensity: 7, length: {distribution: exponential, mean: 3 cm}}}]");
    for (size_t i = 0; i < c.n; i++) length += last = length_of (&c.crack[i]);
    assert_true (length >= 7 && length - last < 7);
    pg_cracks_clear (&c);
    c = network_of (CUBE,
                    "cracks: [{random: {fraction: 2 %, shape: rectangle, aspect: 0.5, length: 10 cm}, width: "
                    "1 cm}]");
    assert_int_equal (c.n, 400);                       /* of 10 x 5 x 1 cm each */
    pg_cracks_clear (&c);
}

static void whole_cracks_lie_in_the_body (void **state)
{
    (void) state;
    static const char body[] =
        "dimension: 2\nbody: [{add: {disk: {center: [0, 0], radius: 1}}}, {subtract: {disk: "
        "{center: [0, 0], radius: 0.5}}}]\n";
    size_t out = 0;
    pg_cracks c = network_of (body, "cracks: [{random: {count: 300, length: 30 cm, margin: 2 cm}}]");
    for (size_t i = 0; i < c.n; i++)
        for (int n = 0; n <= 50; n++) {
            const double *v = c.crack[i].vertex;
            double x = v[0] + n / 50.0 * (v[2] - v[0]), y = v[1] + n / 50.0 * (v[3] - v[1]), r = hypot (x, y);
            assert_true (r < 0.98 + 1e-9 && r > 0.52 - 1e-9);
        }
    pg_cracks_clear (&c);
    c = network_of (body, "cracks: [{random: {count: 300, length: 30 cm, inside: middle}}]");
    for (size_t i = 0; i < c.n; i++) {
        const double *v = c.crack[i].vertex;
        double r = hypot (0.5 * (v[0] + v[2]), 0.5 * (v[1] + v[3]));
        assert_true (r < 1 + 1e-9 && r > 0.5 - 1e-9);
        out += hypot (v[0], v[1]) > 1;
    }
    assert_true (out > 10);
    pg_cracks_clear (&c);
    c = network_of (CUBE, "cracks: [{random: {count: 100, length: 40 cm, shape: ellipse, aspect: 0.5}}]");
    for (size_t i = 0; i < c.n; i++)
        for (size_t k = 0; k < 3 * c.crack[i].nvertex; k++)
            assert_true (c.crack[i].vertex[k] > -1e-3 && c.crack[i].vertex[k] < 1 + 1e-3);
    pg_cracks_clear (&c);
}

/* ---- seeds and units ----------------------------------------------------------------------------------- */
static void a_seed_is_one_network (void **state)
{
    (void) state;
    static const char words[] =
        "cracks: [{random: {seed: 9, count: 50, length: {distribution: lognormal, mean: 4 "
        "cm, deviation: 2 cm}, angle: {distribution: von_mises, mean: 1, concentration: "
        "2}, distance: 1 mm}}]";
    pg_cracks a = network_of (SQUARE, words), b = network_of (SQUARE, words);
    pg_cracks mm =
        network_of ("dimension: 2\nbody: [{add: {box: {low: [0, 0], high: [1000 mm, 1000 mm]}}}]\n", words);
    pg_cracks large =
        network_of ("dimension: 2\nbody: [{add: {box: {low: [3 km, 0], high: [4 km, 1 km]}}}]\n",
                    "cracks: [{random: {seed: 9, count: 50, length: {distribution: lognormal, mean: "
                    "40 m, deviation: 20 m}, angle: {distribution: von_mises, mean: 1, "
                    "concentration: 2}, distance: 1 m}}]");
    assert_int_equal (large.n, 50);
    for (size_t i = 0; i < 50; i++)
        for (size_t k = 0; k < 4; k++) {
            assert_true (a.crack[i].vertex[k] == b.crack[i].vertex[k]);
            assert_true (a.crack[i].vertex[k] == mm.crack[i].vertex[k]);
            check_absolute (large.crack[i].vertex[k] - (k % 2 ? 0 : 3000), 1000 * a.crack[i].vertex[k], 1e-9);
        }
    pg_cracks_clear (&b), b = network_of (SQUARE, "cracks: [{random: {seed: 10, count: 50, length: 4 cm}}]");
    assert_true (a.crack[0].vertex[0] != b.crack[0].vertex[0]);
    pg_cracks_clear (&a), pg_cracks_clear (&b), pg_cracks_clear (&mm), pg_cracks_clear (&large);
}

/* The first numbers of this seed, as they were on the machine where the test was written. */
static void a_seed_is_one_network_everywhere (void **state)
{
    (void) state;
    random_source r;
    random_start (&r, 7);
    double u = random_uniform (&r), n = random_normal (&r), d[3];
    random_von_mises (&r, 2.5, d);
    double v = d[0];
    random_fisher (&r, 2.5, d);
    assert_true (u == 0.07630828361718478 && n == 1.4570832338189901);
    assert_true (v == 0.77589992505847349 && d[0] == -0.87659647405888697);
    assert_true (settled_exp (1.3) == 3.6692966676192444 && settled_log (1.3) == 0.26236426446749112);
}

static void the_generator_is_the_mersenne_twister (void **state)
{
    (void) state;
    random_source r;
    gsl_rng *g = gsl_rng_alloc (gsl_rng_mt19937);
    random_start (&r, 123456), gsl_rng_set (g, 123456);
    for (int i = 0; i < 3000; i++) assert_int_equal (random_word (&r), gsl_rng_get (g));
    gsl_rng_free (g);
}

static void elementary_functions_are_right (void **state)
{
    (void) state;
    random_source r;
    random_start (&r, 1);
    for (int i = 0; i < 100000; i++) {
        double u = random_uniform (&r) - 0.5, x = exp (200 * u), c, s;
        assert_true (u > -0.5 && u < 0.5);
        check_relative (settled_log (x), log (x), 1e-15);
        check_relative (settled_exp (1000 * u), exp (1000 * u), 1e-15);
        settled_angle (100 * u, &c, &s);
        check_absolute (c, cos (100 * u), 4e-16), check_absolute (s, sin (100 * u), 4e-16);
    }
    check_relative (settled_power (7.5, -2.25), pow (7.5, -2.25), 1e-14);
    assert_true (settled_log (1) == 0 && settled_exp (0) == 1 && settled_exp (-1e4) == 0);
}

/* ---- faults -------------------------------------------------------------------------------------------- */
static void what_cannot_be_is_said (void **state)
{
    (void) state;
    must_fault (SQUARE, "cracks: [{random: {count: 5, length: 2}}]", "only 0 of 5 cracks found a place");
    must_fault (SQUARE, "cracks: [{random: {count: 500, length: 10 cm, distance: 20 cm}}]", "found a place");
    must_fault (SQUARE, "cracks: [{random: {fraction: 5 %, length: 10 cm}}]", "give the entry a width");
    must_fault (SQUARE, "cracks: [{random: {count: 5, length: {distribution: normal, mean: 1 cm}}}]",
                "distribution: normal needs deviation");
    must_fault (SQUARE,
                "cracks: [{random: {count: 5, length: {distribution: uniform, min: 1 cm, max: 2 cm, mean: "
                "1 cm}}}]",
                "has no effect with distribution: uniform");
    must_fault (SQUARE,
                "cracks: [{random: {count: 5, length: {distribution: uniform, min: 3 cm, max: 2 cm}}}]",
                "lies above max");
    must_fault (SQUARE,
                "cracks: [{random: {count: 5, length: {distribution: normal, mean: 1 cm, deviation: 1 mm, "
                "min: 9 cm}}}]",
                "next to nothing");
    must_fault (SQUARE,
                "cracks: [{random: {count: 5, length: 1 cm, normal: {mean: [0, 1], concentration: 1}}}]",
                "is for 3D");
    must_fault (CUBE, "cracks: [{random: {count: 5, length: 1 cm, angle: 3 deg}}]", "is for 2D");
    must_fault (CUBE, "cracks: [{random: {count: 5, length: 1 cm, aspect: 0.5}}]", "choose shape");
    must_fault (SQUARE, "cracks: [{random: {count: 5, length: 1 cm, margin: 1 mm, inside: middle}}]",
                "has no effect with inside: middle");
    must_fault (SQUARE, "cracks: [{random: {count: 5, length: 1 cm, position: {mean: [0, 0]}}}]",
                "has no effect with distribution: uniform");
    must_fault ("dimension: 2\npoints: none.csv\n", "cracks: [{random: {count: 5, length: 1 cm}}]",
                "need a body of shapes");
}

static void any_allocation_may_fail (void **state)
{
    (void) state;
    pg_scene *scene =
        parsed (SQUARE "cracks: [{random: {count: 3, length: 1 cm, distance: 0}, width: 1 mm}]");
    size_t before = pg_memory_used (), k = 0;
    pg_status status = PG_E_MEMORY;
    while (status != PG_OK) {
        pg_cracks c;
        pg_network n;
        pg_memory_fail_at (++k);
        status = pg_network_read (&c, scene);
        if (status == PG_OK) status = pg_network_measure (&n, &c, scene), pg_cracks_clear (&c);
        pg_memory_fail_at (0);
        if (status != PG_OK) assert_int_equal (status, PG_E_MEMORY);
        assert_int_equal (pg_memory_used (), before);
    }
    assert_true (k > 8);
    pg_scene_free (&scene);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (lengths_have_their_distributions),
        cmocka_unit_test (angles_have_their_distributions),
        cmocka_unit_test (normals_have_fishers_distribution),
        cmocka_unit_test (places_have_their_distributions),
        cmocka_unit_test (a_narrow_body_does_not_prefer_short_cracks),
        cmocka_unit_test (the_least_distance_holds),
        cmocka_unit_test (discs_keep_their_distance),
        cmocka_unit_test (amounts_are_met),
        cmocka_unit_test (whole_cracks_lie_in_the_body),
        cmocka_unit_test (a_seed_is_one_network),
        cmocka_unit_test (a_seed_is_one_network_everywhere),
        cmocka_unit_test (the_generator_is_the_mersenne_twister),
        cmocka_unit_test (elementary_functions_are_right),
        cmocka_unit_test (what_cannot_be_is_said),
        cmocka_unit_test (any_allocation_may_fail),
    };
    return cmocka_run_group_tests (tests, NULL, NULL);
}

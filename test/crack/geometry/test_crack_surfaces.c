/* SPDX-License-Identifier: GPL-3.0-or-later
 * Surfaces of cracks that grow in space: which bonds they cut, whether anything slips through their seams,
 * fronts that kink, stay behind, reach the surface of the body, meet each other; copies, memory that runs
 * out, checkpoints. */
#include "mechanics/model/growing.h"
#include <stdlib.h>

/* A cube without a crack, its points perturbed; h = 1 but for units. */
#define CUBE(side, more) \
    "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [" side ", " side ", " side "]}}}]\n" \
    "spacing: 1\nperturb: {amount: 0.2}\nmaterials: {m: {youngs_modulus: 1, poissons_ratio: 0.2}}\n" more

/* A polygon of n vertices on a circle; e, f span its plane. */
static void start_disc (growing *g, const double *middle, const double *e, const double *f, double radius,
                        size_t n)
{
    double *x = malloc (3 * n * sizeof *x), normal[3];
    for (size_t i = 0; i < n; i++) {
        double a = 2 * acos (-1) * (double) i / (double) n;
        for (size_t k = 0; k < 3; k++)
            x[3*i + k] = middle[k] + radius * (cos (a) * e[k] + sin (a) * f[k]);
    }
    for (int k = 0; k < 3; k++)
        normal[k] = e[(k + 1) % 3] * f[(k + 2) % 3] - e[(k + 2) % 3] * f[(k + 1) % 3];
    check_ok (pg_surface_start (g->s, g->p, n, x, normal, &g->cut));
    free (x);
}

/* Every vertex of a front by the same way and angle. */
static void advance (growing *g, size_t front, double way, double angle)
{
    enum { MOST = 400 };
    double d[MOST], theta[MOST];
    size_t n = g->s->surfaces->front[front].n;
    assert_true (n <= MOST);
    for (size_t i = 0; i < n; i++) d[i] = way, theta[i] = angle;
    check_ok (pg_front_advance (g->s, g->p, front, d, theta, &g->cut));
}

/* How many triangles have the edge a b. */
static size_t edge_count (const pg_crack_surfaces *w, size_t a, size_t b)
{
    size_t n = 0;
    for (size_t t = 0; t < w->cracks.n - w->nfirst; t++) {
        const size_t *c = w->corner + 3*t;
        int has_a = c[0] == a || c[1] == a || c[2] == a, has_b = c[0] == b || c[1] == b || c[2] == b;
        n += has_a && has_b;
    }
    return n;
}

static double uniform (double low, double high) { return low + (high - low) * (rand () / (double) RAND_MAX); }

/* Segments aimed at inner edges and corners of the triangles, and into them: all are cut. */
static void check_seams (const pg_crack_surfaces *w, int shots)
{
    size_t n = w->cracks.n - w->nfirst, slipped = 0, aimed = 0;
    for (int shot = 0; shot < shots; shot++) {
        size_t t = (size_t) rand () % n, a = (size_t) rand () % 3;
        const size_t *c = w->corner + 3*t;
        const double *normal = w->cracks.crack[w->nfirst + t].normal;
        double share[3] = { uniform (0, 1), uniform (0, 1), uniform (0, 1) }, x[3], y[3], target[3];
        if (shot % 3 == 1) {                           /* at an edge */
            if (edge_count (w, c[a], c[(a + 1) % 3]) < 2) continue;
            share[(a + 2) % 3] = 0;
        }
        double sum = share[0] + share[1] + share[2];
        double e[3], along = 0, up = uniform (0.05, 3), down = uniform (0.05, 3);
        for (size_t k = 0; k < 3; k++) {
            target[k] = 0, e[k] = uniform (-1, 1), along += e[k] * normal[k];
            for (size_t v = 0; v < 3; v++) target[k] += share[v] / sum * w->vertex[3 * c[v] + k];
        }
        if (fabs (along) < 0.5) continue;              /* through both triangles of an edge alike */
        for (size_t k = 0; k < 3; k++) x[k] = target[k] - down * e[k], y[k] = target[k] + up * e[k];
        aimed++, slipped += !pg_cracks_cut (&w->cracks, x, y, 1e-9);
    }
    assert_true (aimed > (size_t) shots / 4);
    assert_int_equal (slipped, 0);
}

/* Behind every vertex of a front the crack cuts up to its offset and no further, and its triangles show to
 * the side of its normal. */
static void check_offset (const growing *g, const pg_front *f)
{
    const pg_crack_surfaces *w = g->s->surfaces;
    for (size_t i = 0; i < f->n; i++)
        for (int far = 0; far < 2; far++) {
            double x[3], y[3], back = (far ? 1.3 : 0.7) * f->offset[i];
            for (size_t k = 0; k < 3; k++) {
                double place = f->x[3*i + k] - back * f->ahead[3*i + k];
                x[k] = place - 0.1 * f->normal[3*i + k], y[k] = place + 0.1 * f->normal[3*i + k];
            }
            const pg_crack *by = pg_cracks_cut (&w->cracks, x, y, 1e-9);
            assert_true (f->offset[i] > 0.05 && !by == !far);
            double along = 0;
            for (size_t k = 0; k < 3 && by; k++) along += by->normal[k] * f->normal[3*i + k];
            assert_true (!by || along > 0.9);
        }
}

/* A tilted disc that grows flat stays flat: its area and its front are those of larger discs. */
static void a_disc_grows (void **state)
{
    (void) state;
    growing g = begin (CUBE ("14", ""));
    const double middle[3] = { 7.1, 6.9, 7.05 }, e[3] = { 0.8, 0, 0.6 }, f[3] = { -0.36, 0.8, 0.48 };
    const double normal[3] = { -0.48, -0.6, 0.64 };
    start_disc (&g, middle, e, f, 2, 12);
    size_t dead = bury (&g);
    assert_true (dead > 50 && dead == check_mask (&g, 13));
    const pg_crack_surfaces *w = g.s->surfaces;
    assert_true (w->nfront == 1 && w->front->closed && w->front->open && w->front->id == 1);
    check_relative (w->area, 12 * sin (acos (-1) / 12) * cos (acos (-1) / 12) * 4, 1e-12);
    for (int k = 1; k <= 3; k++) {
        advance (&g, 0, 1, 0);
        dead += bury (&g);
        assert_int_equal (check_mask (&g, 13), dead);
        w = g.s->surfaces;
        check_relative (w->area, acos (-1) * (2 + k) * (2 + k), 0.05);
        check_offset (&g, w->front);
        assert_true (fabs ((double) w->front->n - 2 * acos (-1) * (2 + k)) < 0.4 * (2 + k) * 6.3);
        for (size_t i = 0; i < w->front->n; i++) {
            double r = 0, off = 0, out = 0;
            for (size_t m = 0; m < 3; m++) {
                double v = w->front->x[3*i + m] - middle[m];
                r = hypot (r, v), off += v * normal[m], out += v * w->front->ahead[3*i + m];
            }
            check_relative (r, 2 + k, 0.02), check_absolute (off, 0, 1e-12), check_relative (out, r, 1e-3);
        }
    }
    check_seams (w, 3000);
    end (&g);
}

/* Vertices that stay behind, kinks that change along the front and from step to step: what dies is what the
 * triangles cut, and nothing slips through. */
static void a_front_kinks_and_lags (void **state)
{
    (void) state;
    growing g = begin (CUBE ("16", "lattice_offset: [0.3, 0.1, 0.2]\n"));
    const double middle[3] = { 8.1, 7.9, 8.05 }, e[3] = { 0.8, 0, 0.6 }, f[3] = { -0.36, 0.8, 0.48 };
    start_disc (&g, middle, e, f, 2.5, 16);
    size_t dead = bury (&g);
    for (int k = 0; k < 4; k++) {
        enum { MOST = 100 };
        double d[MOST], theta[MOST];
        const pg_front *front = g.s->surfaces->front;
        assert_true (front->n < MOST);
        for (size_t i = 0; i < front->n; i++) {
            double along = 2 * acos (-1) * (double) i / (double) front->n;
            d[i] = fmax (0, 0.3 + 0.7 * cos (along + 0.3 * k)), theta[i] = 0.8 * sin (2 * along + k);
        }
        check_ok (pg_front_advance (g.s, g.p, 0, d, theta, &g.cut));
        dead += bury (&g);
        assert_int_equal (check_mask (&g, longer () ? 13 : 53), dead);
    }
    assert_int_equal (g.s->surfaces->nfront, 1);
    check_seams (g.s->surfaces, longer () ? 100000 : 5000);
    end (&g);
}

/* Is a bond between two sides of a plane alive somewhere? Counts those that were cut. */
static size_t check_severed (const growing *g, int axis, double at)
{
    const pg_problem *p = g->p;
    size_t severed = 0;
    for (int set = 0; set < PG_BOND_SETS; set++)
        for (size_t q = 0; q < p->bonds.rows[set].n; q++)
            for (size_t e = p->bonds.rows[set].family.start[q]; e < p->bonds.rows[set].family.start[q + 1];
                 e++) {
                size_t j = 3 * (size_t) p->bonds.rows[set].family.node[e] + (size_t) axis;
                if ((p->bonds.rows[set].x[3*q + (size_t) axis] < at) == (p->cloud.x[j] < at)) continue;
                assert_false (g->s->alive[p->bonds.first[set] + e]);
                severed++;
            }
    return severed;
}

/* Vertices that are distributed anew between a stretch that went ahead and one that stayed may lie a
 * little inside of the crack as the scene drew it: that is no crack that they meet.
 * PERIGAL_TEST_SIZE=long: five times as many trials. */
static void what_stayed_behind_is_no_obstacle (void **state)
{
    (void) state;
    enum { SIDES = 28, MOST = 200 };
    char text[4000];
    int at = snprintf (text, sizeof text, CUBE ("18", "cracks: [{polygon: ["));
    for (int k = 0; k < SIDES; k++) {
        double t = 2 * acos (-1) * k / SIDES;
        at += snprintf (text + at, sizeof text - (size_t) at, "%s[%.9g, %.9g, 9.05]", k ? ", " : "",
                        9.1 + 5.4 * cos (t), 8.9 + 3.2 * sin (t));
    }
    snprintf (text + at, sizeof text - (size_t) at, "]}]\n");
    srand (1);
    growing g = begin (text);
    for (int trial = 0; trial < (longer () ? 40 : 8); trial++) {
        pg_state_free (&g.s);
        check_ok (pg_state_create (&g.s, g.p, 3));
        check_ok (pg_crack_surfaces_create (&g.s->surfaces, g.p));
        for (int step = 0; step < 2; step++) {
            double phase = uniform (0, 6.28), tilt = uniform (0, 6.28);
            int waves = 1 + rand () % 4;
            const pg_front *front = g.s->surfaces->front;
            double d[MOST], theta[MOST];
            assert_true (front->n <= MOST);
            for (size_t i = 0; i < front->n; i++) {
                double along = 2 * acos (-1) * (double) i / (double) front->n;
                d[i] = cos (waves * along + phase) > 0, theta[i] = 0.03 * sin (3 * along + tilt);
            }
            check_ok (pg_front_advance (g.s, g.p, 0, d, theta, &g.cut));
            bury (&g);
            assert_true (g.s->surfaces->nfront == 1 && g.s->surfaces->front->closed);
        }
    }
    end (&g);
}

/* A straight front of a pre-crack runs to the other side of the body: its ends stay on the surface, and at
 * the end nothing holds the two parts together. */
static void a_front_severs_the_body (void **state)
{
    (void) state;
    growing g = begin (CUBE ("8", "cracks: [{polygon: [[-1, -1, 3.3], [3, -1, 3.3], [3, 9, 3.3], "
                                  "[-1, 9, 3.3]]}]\n"));
    size_t dead = check_mask (&g, 13);
    assert_true (g.s->surfaces->nfront == 1 && g.s->surfaces->nfirst == 1 && !g.s->surfaces->front->closed);
    for (int k = 0; k < 4; k++) {
        const pg_front *front = g.s->surfaces->front;
        assert_int_equal (front->open, k < 4);
        check_relative (front->x[0], 3 + k, 1e-12);
        for (size_t i = 0; i < front->n; i++) check_relative (front->ahead[3*i], 1, 1e-12);
        double low = fmin (front->x[1], front->x[3 * front->n - 2]),
               high = fmax (front->x[1], front->x[3 * front->n - 2]);
        check_absolute (low, 0, 1e-9), check_relative (high, 8, 1e-9);
        check_relative (g.s->surfaces->area + 24, 8.0 * (3 + k), 1e-9);
        advance (&g, 0, 1, 0);
        dead += bury (&g);
        assert_int_equal (check_mask (&g, 13), dead);
    }
    assert_false (g.s->surfaces->front->open);
    check_relative (g.s->surfaces->area, 40, 1e-9);
    assert_true (check_severed (&g, 2, 3.3) > 2000);
    check_seams (g.s->surfaces, 3000);
    end (&g);
}

/* A front that is askew to the faces beside it, by 35 degrees, goes along them: none of its vertices is taken
 * for one that runs into a face, and its ends stay on them, at most twice as far as it goes. */
static void a_front_askew_passes_along_the_faces (void **state)
{
    (void) state;
    growing g = begin (CUBE ("14", "cracks: [{polygon: [[-9, -1, 7.3], [-0.7, -1, 7.3], [9.8, 15, 7.3], "
                                  "[-9, 15, 7.3]]}]\n"));
    size_t dead = check_mask (&g, 13);
    assert_true (g.s->surfaces->nfront == 1 && !g.s->surfaces->front->closed);
    for (int k = 0; k < 3; k++) {
        const pg_front *front = g.s->surfaces->front;
        size_t last = front->n - 1, far = front->x[0] < front->x[3 * last] ? last : 0;
        double x[2] = { front->x[3 * (last - far)], front->x[3 * far] };   /* behind, ahead */
        advance (&g, 0, 1, 0);
        dead += bury (&g);
        assert_int_equal (check_mask (&g, 13), dead);
        front = g.s->surfaces->front;
        assert_true (g.s->surfaces->nfront == 1 && front->open && front->n >= 14);
        last = front->n - 1, far = front->x[0] < front->x[3 * last] ? last : 0;
        check_absolute (fabs (front->x[3 * far + 1] - 7), 7, 1e-9);
        check_absolute (fabs (front->x[3 * (last - far) + 1] - 7), 7, 1e-9);
        double behind = front->x[3 * (last - far)] - x[0], ahead = front->x[3 * far] - x[1];
        assert_true (behind > 0.5 && behind < 2 + 1e-9 && ahead > -1e-9 && ahead < 2 + 1e-9);
        check_relative (g.s->surfaces->area / (k + 1), 14 * hypot (16, 10.5) / 16, 0.045);
    }
    end (&g);
}

/* Vertices that kink up and down by turns make no zigzag of the front, step after step: what integrals over
 * hats of three vertices cannot see is taken out. A wave of ten vertices stays. */
static void zigzags_are_taken_out (void **state)
{
    (void) state;
    for (int turns = 2; turns <= 10; turns += 8) {
        growing g = begin (CUBE ("13", "cracks: [{polygon: [[-1, -1, 6.3], [3, -1, 6.3], [3, 14, 6.3], "
                                      "[-1, 14, 6.3]]}]\n"));
        for (int k = 0; k < 3; k++) {
            enum { MOST = 60 };
            double d[MOST], theta[MOST];
            size_t n = g.s->surfaces->front->n;
            assert_true (n < MOST);
            for (size_t i = 0; i < n; i++)
                d[i] = 1, theta[i] = 0.3 * cos (2 * acos (-1) * (double) i / turns);
            check_ok (pg_front_advance (g.s, g.p, 0, d, theta, &g.cut));
            bury (&g);
        }
        const pg_front *front = g.s->surfaces->front;
        double low = INFINITY, high = 0;
        for (size_t i = 2; i + 2 < front->n; i++)
            low = fmin (low, front->x[3*i + 2]), high = fmax (high, front->x[3*i + 2]);
        if (turns == 2) assert_true (high - low < 0.1);       /* 1.8 without */
        else assert_true (high - low > 1.5);
        end (&g);
    }
}

/* A quarter of a disc at an edge of the body, half a disc at its surface: their ends lie on the surface, and
 * after enough steps the body is in two. */
static void a_crack_begins_at_the_surface (void **state)
{
    (void) state;
    growing g = begin (CUBE ("7", ""));
    const double middle[3] = { 3.4, 0, 3.3 }, e[3] = { 1, 0, 0 }, f[3] = { 0, 1, 0 };
    start_disc (&g, middle, e, f, 2, 20);
    size_t dead = bury (&g);
    assert_int_equal (check_mask (&g, 13), dead);
    assert_true (g.s->surfaces->nfront == 1 && !g.s->surfaces->front->closed);
    check_relative (g.s->surfaces->area, 2 * acos (-1), 0.05);
    for (int k = 0; k < 12 && g.s->surfaces->front->open; k++) {
        const pg_front *front = g.s->surfaces->front;
        size_t last = front->n - 1;
        assert_int_equal (front->meets[0], PG_MEETS_SURFACE);
        assert_int_equal (front->meets[last], PG_MEETS_SURFACE);
        for (size_t end = 0; end <= last; end += last) {
            const double x = front->x[3*end], y = front->x[3*end + 1];
            double off = fmin (fmin (x, 7 - x), fmin (y, 7 - y));
            check_absolute (off, 0, 1e-9), check_absolute (front->x[3*end + 2], 3.3, 1e-9);
        }
        for (size_t n = 0; n < g.s->surfaces->nfront; n++)
            if (g.s->surfaces->front[n].open) advance (&g, n, 1, 0);
        dead += bury (&g);
        assert_int_equal (check_mask (&g, 13), dead);
    }
    for (size_t n = 0; n < g.s->surfaces->nfront; n++) assert_false (g.s->surfaces->front[n].open);
    check_relative (g.s->surfaces->area, 49, 0.1);
    assert_true (check_severed (&g, 2, 3.3) > 2000);
    end (&g);
}

/* Steps of any length and turn, different along each front, of cracks of many kinds in bodies of two: all
 * places stay finite, areas grow, what dies is what the triangles cut, and at last no front is open. */
static void whatever_fronts_do_they_end (void **state)
{
    (void) state;
    static const char *const scene[3] = {
        CUBE ("9", "cracks: [{polygon: [[-1, -1, 4.3], [3, -1, 4.3], [3, 10, 4.5], [-1, 10, 4.5]]}]\n"),
        CUBE ("9", "cracks: [{disc: {center: [4.3, 4.6, 4.7], normal: [0.3, 0.2, 1], radius: 2.2}}, "
                   "{polygon: [[-1, -1, 7.3], [2, -1, 7.3], [2, 10, 7.3], [-1, 10, 7.3]]}]\n"),
        "dimension: 3\nbody: [{add: {cylinder: {center: [0, 0, 0], length: 10, radius: 4.5}}}]\nspacing: 1\n"
        "cells: cut\nmaterials: {m: {youngs_modulus: 1, poissons_ratio: 0.2}}\n"
        "cracks: [{disc: {center: [1, 0.5, 5.2], normal: [0.3, 0.2, 1], radius: 1.6}}]\n"
    };
    for (int k = 0; k < 3; k++) {
        growing g = begin (scene[k]);
        double d[200], theta[200], area = 0;
        size_t open = 1, dead = check_mask (&g, 13);
        srand (5 + (unsigned) k);
        for (int step = 0; step < 60 && open; step++) {
            double phase = uniform (0, 6), turn = uniform (0, 6);
            open = 0;
            for (size_t f = 0, n = g.s->surfaces->nfront; f < n; f++) {
                const pg_front *front = &g.s->surfaces->front[f];
                if (!front->open) continue;
                open++;
                assert_true (front->n < 200);
                for (size_t i = 0; i < front->n; i++) {
                    double a = 2 * acos (-1) * (double) i / (double) front->n;
                    d[i] = fmax (0, 0.6 - 0.4 * cos (a + phase)), theta[i] = 0.2 * sin (a + turn);
                    for (size_t m = 0; m < 3; m++)
                        assert_true (fabs (front->x[3*i + m]) < 20 && fabs (front->ahead[3*i + m]) < 1.01);
                }
                check_ok (pg_front_advance (g.s, g.p, f, d, theta, &g.cut));
                dead += bury (&g);
            }
            assert_true (g.s->surfaces->area >= area);
            area = g.s->surfaces->area;
        }
        assert_true (open == 0 && area > 40);
        assert_int_equal (check_mask (&g, 13), dead);
        end (&g);
    }
}

/* Two discs in one plane grow together: both fronts are parted where they meet, or are one around both. */
static void discs_meet (void **state)
{
    (void) state;
    growing g = begin (CUBE ("14", ""));
    const double left[3] = { 4.2, 7.1, 7.3 }, right[3] = { 9.8, 6.9, 7.3 };
    const double e[3] = { 1, 0, 0 }, f[3] = { 0, 1, 0 };
    start_disc (&g, left, e, f, 1.8, 12);
    start_disc (&g, right, e, f, 1.8, 12);
    size_t dead = bury (&g);
    for (int k = 0; k < 3; k++) {
        size_t n = g.s->surfaces->nfront;
        for (size_t i = 0; i < n; i++) if (g.s->surfaces->front[i].open) advance (&g, i, 0.6, 0);
        dead += bury (&g);
        assert_int_equal (check_mask (&g, 13), dead);
    }
    const pg_crack_surfaces *w = g.s->surfaces;
    for (size_t i = 0; i < w->nfront; i++)
        assert_true (!w->front[i].open || !w->front[i].closed);
    /* between the two nothing holds together any more */
    for (int k = 0; k < 2000; k++) {
        double x[3] = { uniform (4, 10), uniform (6.6, 7.4), 7.2 }, y[3] = { x[0], x[1], 7.4 };
        assert_non_null (pg_cracks_cut (&w->cracks, x, y, 1e-9));
    }
    end (&g);
}

/* A front runs into a crack across: it ends there and cuts nothing behind it. */
static void a_crack_across_stops_a_front (void **state)
{
    (void) state;
    growing g = begin (CUBE ("12", "cracks: [{polygon: [[8.2, -1, -1], [8.2, 13, -1], [8.2, 13, 13], "
                                   "[8.2, -1, 13]]}]\n"));
    const double middle[3] = { 6, 6.1, 6.3 }, e[3] = { 1, 0, 0 }, f[3] = { 0, 1, 0 };
    start_disc (&g, middle, e, f, 1.3, 10);
    bury (&g);
    size_t dead = check_mask (&g, 13);
    for (int k = 0; k < 3; k++) {
        size_t n = g.s->surfaces->nfront;
        for (size_t i = 0; i < n; i++) if (g.s->surfaces->front[i].open) advance (&g, i, 0.8, 0);
        dead += bury (&g);
        assert_int_equal (check_mask (&g, 13), dead);
    }
    const pg_crack_surfaces *w = g.s->surfaces;
    const pg_front *front = w->front;
    assert_true (front->open && !front->closed);
    assert_true (front->meets[0] == PG_MEETS_CRACK && front->meets[front->n - 1] == PG_MEETS_CRACK);
    check_relative (front->x[0], 8.2, 1e-6), check_relative (front->x[3 * front->n - 3], 8.2, 1e-6);
    double far = 0;
    for (size_t v = 0; v < w->nvertex; v++) far = fmax (far, w->vertex[3*v]);
    assert_true (far > 8.2 && far < 8.2 + 0.15);
    end (&g);
}

static void copies_are_deep_and_a_failure_changes_nothing (void **state)
{
    (void) state;
    growing g = begin (CUBE ("9", ""));
    pg_crack_surfaces *before = NULL;
    const double middle[3] = { 4.4, 4.6, 4.3 }, e[3] = { 1, 0, 0 }, f[3] = { 0, 1, 0 };
    start_disc (&g, middle, e, f, 1.5, 10);
    bury (&g);
    check_ok (pg_crack_surfaces_create (&before, g.p));
    check_ok (pg_crack_surfaces_copy (before, g.s->surfaces));
    double d[64], theta[64] = { 0 };
    for (int i = 0; i < 64; i++) d[i] = 1;
    pg_status status = PG_E_MEMORY;
    for (size_t k = 1; status != PG_OK; k++) {
        g.cut.n = 0;
        pg_memory_fail_at (k);
        status = pg_front_advance (g.s, g.p, 0, d, theta, &g.cut);
        pg_memory_fail_at (0);
        if (status == PG_OK) break;
        assert_int_equal (status, PG_E_MEMORY);
        assert_true (g.s->surfaces->cracks.n == before->cracks.n && k < 1000);
        assert_memory_equal (g.s->surfaces->front->x, before->front->x, 3 * before->front->n * sizeof *d);
    }
    bury (&g), check_mask (&g, 13);
    assert_true (before->cracks.n < g.s->surfaces->cracks.n && before->area < g.s->surfaces->area);
    pg_memory_fail_at (1);                             /* back again; without memory there is no index */
    status = pg_crack_surfaces_copy (g.s->surfaces, before);
    pg_memory_fail_at (0);
    check_ok (status);
    const double x[3] = { 4.5, 4.5, 4.2 }, y[3] = { 4.5, 4.5, 4.4 };
    assert_non_null (pg_cracks_cut (&g.s->surfaces->cracks, x, y, 1e-9));
    for (int i = 0; i < 64; i++) d[i] = 0;
    check_fails (pg_front_advance (g.s, g.p, 0, d, theta, &g.cut), PG_E_USAGE);
    check_fails (pg_front_advance (g.s, g.p, 1, d, theta, &g.cut), PG_E_USAGE);
    check_fails (pg_surface_start (g.s, g.p, 2, middle, e, &g.cut), PG_E_USAGE);
    check_ok (pg_front_advance (g.s, g.p, 0, NULL, NULL, &g.cut));
    assert_false (g.s->surfaces->front->open);
    check_fails (pg_front_advance (g.s, g.p, 0, NULL, NULL, &g.cut), PG_E_USAGE);
    pg_crack_surfaces_free (&before);
    end (&g);
}

/* ---- checkpoints --------------------------------------------------------------------------------------- */
typedef struct { char name[80]; size_t bytes; void *value; } part;
typedef struct { part part[64]; size_t n, at; } tape;

static pg_status pass (void *context, const char *name, size_t n, size_t size, void *value, int reading)
{
    tape *t = context;
    if (!reading) {
        part *p = &t->part[t->n++];
        snprintf (p->name, sizeof p->name, "%s", name);
        p->bytes = n * size, p->value = pg_calloc (n, size);
        memcpy (p->value, value, n * size);
        return PG_OK;
    }
    part *p = &t->part[t->at++];
    if (strcmp (p->name, name) != 0 || p->bytes != n * size)
        return pg_error (PG_E_FILE, PG_HERE, "another piece");
    memcpy (value, p->value, n * size);
    return PG_OK;
}
static pg_status write_numbers (void *c, const char *name, size_t n, double *v)
{
    return pass (c, name, n, 8, v, 0);
}
static pg_status write_counts (void *c, const char *name, size_t n, long *v)
{
    return pass (c, name, n, 8, v, 0);
}
static pg_status read_numbers (void *c, const char *name, size_t n, double *v)
{
    return pass (c, name, n, 8, v, 1);
}
static pg_status read_counts (void *c, const char *name, size_t n, long *v)
{
    return pass (c, name, n, 8, v, 1);
}


/* What is kept is all there is: the next step of a resumed run is the same to the last bit. Whole numbers out
 * of their bounds are refused. */
static void checkpoints_keep_the_surfaces (void **state)
{
    (void) state;
    const char *scene = CUBE ("9", "cracks: [{disc: {center: [4.3, 4.6, 4.7], normal: [0.3, 0.2, 1], "
                              "radius: 1.4}}]\n");
    growing a = begin (scene), b = begin (scene);
    tape t = { 0 };
    const double middle[3] = { 8.9, 4.6, 2.3 }, e[3] = { 1, 0, 0 }, f[3] = { 0, 1, 0 };
    start_disc (&a, middle, e, f, 1.2, 12);
    bury (&a), advance (&a, 0, 0.9, 0.3), bury (&a), advance (&a, 1, 0.7, -0.2), bury (&a);
    const pg_keeper writer = { &t, 0, write_numbers, write_counts, NULL };
    check_ok (pg_crack_surfaces_keep (a.s->surfaces, a.p, "x", &writer));
    const pg_keeper reader = { &t, 1, read_numbers, read_counts, NULL };
    check_ok (pg_crack_surfaces_keep (b.s->surfaces, b.p, "x", &reader));
    memcpy (b.s->alive, a.s->alive, a.s->nbond);
    check_mask (&b, 13);
    advance (&a, 0, 1, 0.1), advance (&b, 0, 1, 0.1), bury (&a), bury (&b);
    const pg_crack_surfaces *v = a.s->surfaces, *w = b.s->surfaces;
    assert_memory_equal (a.s->alive, b.s->alive, a.s->nbond);
    assert_true (v->cracks.n == w->cracks.n && v->nvertex == w->nvertex && v->area == w->area);
    assert_memory_equal (v->store, w->store, 9 * (v->cracks.n - v->nfirst) * sizeof (double));
    for (size_t i = 0; i < v->nfront; i++)
        assert_memory_equal (v->front[i].ahead, w->front[i].ahead, 3 * v->front[i].n * sizeof (double));
    size_t refused = 0;
    for (size_t i = 0; i < t.n; i++)
        for (size_t k = 0; k < t.part[i].bytes / 8; k += 7) {
            static const long nasty[] = { -2, 1L << 40, 0x7fffffffffffffff, -0x7fffffffffffffff };
            long *n = (long *) t.part[i].value + k, right = *n;
            for (size_t q = 0; q < 4; q++) {
                *n = nasty[q], t.at = 0;
                pg_status status = pg_crack_surfaces_keep (b.s->surfaces, b.p, "x", &reader);
                assert_true (status == PG_OK || status == PG_E_FILE);
                refused += status == PG_E_FILE;
            }
            *n = right;
        }
    assert_true (refused > 100);
    for (size_t i = 0; i < t.n; i++) pg_free (t.part[i].value);
    end (&a), end (&b);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (a_disc_grows), cmocka_unit_test (a_front_kinks_and_lags),
        cmocka_unit_test (what_stayed_behind_is_no_obstacle),
        cmocka_unit_test (a_front_severs_the_body), cmocka_unit_test (a_front_askew_passes_along_the_faces),
        cmocka_unit_test (zigzags_are_taken_out), cmocka_unit_test (a_crack_begins_at_the_surface),
        cmocka_unit_test (whatever_fronts_do_they_end),
        cmocka_unit_test (discs_meet), cmocka_unit_test (a_crack_across_stops_a_front),
        cmocka_unit_test (copies_are_deep_and_a_failure_changes_nothing),
        cmocka_unit_test (checkpoints_keep_the_surfaces),
    };
    return cmocka_run_group_tests_name ("mechanics/model/crack_surfaces", tests, NULL, NULL);
}

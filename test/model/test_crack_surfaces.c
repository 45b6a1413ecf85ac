/* SPDX-License-Identifier: GPL-3.0-or-later
 * Surfaces of cracks that grow in space: which bonds they cut, whether anything slips through their seams,
 * fronts that kink, stay behind, reach the surface of the body, meet each other; copies, memory that runs
 * out, checkpoints. */
#include "scenes.h"
#include <stdlib.h>

/* A cube without a crack, its points perturbed; h = 1 but for units. */
#define CUBE(side, more) \
    "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [" side ", " side ", " side "]}}}]\n" \
    "spacing: 1\nperturb: {amount: 0.2}\nmaterials: {m: {youngs_modulus: 1, poissons_ratio: 0.2}}\n" more

typedef struct { built b; const pg_problem *p; pg_state *s; pg_changes cut; } growing;

/* A state with surfaces, whatever the criterion. */
static growing begin (const char *text)
{
    growing g = { .b = build (text) };
    g.p = g.b.problem;
    check_ok (pg_state_create (&g.s, g.p, pg_problem_unknowns (g.p)));
    if (!g.s->surfaces) check_ok (pg_crack_surfaces_create (&g.s->surfaces, g.p));
    return g;
}

static void end (growing *g)
{
    pg_free (g->cut.bond);
    pg_state_free (&g->s);
    unbuild (&g->b);
}

/* The bonds that were found die. */
static size_t bury (growing *g)
{
    size_t n = g->cut.n;
    for (size_t i = 0; i < n; i++) {
        assert_true (i == 0 || g->cut.bond[i] > g->cut.bond[i - 1]);
        assert_true (g->s->alive[g->cut.bond[i]]);
        g->s->alive[g->cut.bond[i]] = 0;
    }
    g->cut.n = 0;
    return n;
}

/* Every bond of every set is dead exactly if the cracks of the state cut it, asked one by one. */
static size_t check_mask (const growing *g)
{
    const pg_problem *p = g->p;
    const pg_cracks *cracks = pg_state_cracks (p, g->s);
    pg_cracks plain = { .dim = 3, .crack = cracks->crack, .n = cracks->n };    /* no boxes */
    size_t dead = 0;
    for (int set = 0; set < PG_BOND_SETS; set++)
        for (size_t q = 0; q < p->rows[set].n; q++)
            for (size_t e = p->rows[set].family.start[q]; e < p->rows[set].family.start[q + 1]; e++) {
                int j = p->rows[set].family.node[e];
                const double *x = p->rows[set].x + 3*q, *y = p->cloud.x + 3 * (size_t) j;
                if (j == p->rows[set].own[q]) continue;
                int cut = pg_cracks_cut (&plain, 3, x, y, 1e-9 * p->cloud.h) != NULL;
                assert_int_equal (g->s->alive[p->first_bond[set] + e], !cut);
                dead += (size_t) cut;
            }
    return dead;
}

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
        aimed++, slipped += !pg_cracks_cut (&w->cracks, 3, x, y, 1e-9);
    }
    assert_true (aimed > (size_t) shots / 4);
    assert_int_equal (slipped, 0);
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
    assert_true (dead > 50 && dead == check_mask (&g));
    const pg_crack_surfaces *w = g.s->surfaces;
    assert_true (w->nfront == 1 && w->front->closed && w->front->open && w->front->id == 1);
    check_relative (w->area, 12 * sin (acos (-1) / 12) * cos (acos (-1) / 12) * 4, 1e-12);
    for (int k = 1; k <= 3; k++) {
        advance (&g, 0, 1, 0);
        dead += bury (&g);
        assert_int_equal (check_mask (&g), dead);
        w = g.s->surfaces;
        check_relative (w->area, acos (-1) * (2 + k) * (2 + k), 0.05);
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

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (a_disc_grows),
    };
    return cmocka_run_group_tests (tests, NULL, NULL);
}

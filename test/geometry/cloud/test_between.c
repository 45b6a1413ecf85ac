/* SPDX-License-Identifier: GPL-3.0-or-later
 * What lies between two places of a body: slots, gaps and other bodies part them, however narrow; chords
 * of smooth surfaces, corners that are hardly cut and ways along a face do not. */
#include "check.h"
#include "perigal/cloud.h"

#define REST "materials: {m: {youngs_modulus: 1 GPa, poissons_ratio: 0.3}}\nspacing: 1\n"

typedef struct {
    pg_scene *scene;
    pg_body body;
    pg_lattice lattice;
    pg_cloud cloud;
    pg_between *between;
} made;

static void make (made *m, int dim, const char *body, const char *more)
{
    *m = (made) { 0 };
    pg_mesh_body none = { 0 };
    char text[2000];
    snprintf (text, sizeof text, "dimension: %d\nbody:\n%s" REST "%s", dim, body, more);
    check_ok (pg_scene_parse (&m->scene, text, "test.yaml"));
    check_ok (pg_body_read (&m->body, m->scene));
    check_ok (pg_cloud_build (&m->cloud, &m->lattice, &m->body, m->scene));
    check_ok (pg_between_create (&m->between, &m->body, &none, &m->cloud));
}

static void unmake (made *m)
{
    pg_between_free (&m->between);
    pg_cloud_clear (&m->cloud), pg_lattice_clear (&m->lattice), pg_body_clear (&m->body);
    pg_scene_free (&m->scene);
}

/* Both ways round, with and without an outlook. */
static int parted (const made *m, const double *x, const double *y)
{
    double low[3], high[3], a[3], b[3];
    pg_outlook o;
    for (int k = 0; k < m->body.dim; k++) low[k] = fmin (x[k], y[k]), high[k] = fmax (x[k], y[k]);
    pg_between_eye (m->between, x, a), pg_between_eye (m->between, y, b);
    int there = pg_between_parted (m->between, NULL, a, b);
    assert_int_equal (pg_between_parted (m->between, NULL, b, a), there);
    int seen = pg_between_look (m->between, low, high, &o);
    assert_int_equal (seen && pg_between_parted (m->between, &o, a, b), there);
    return there;
}

#define PLANE(m, a, b, c, d) parted (&(m), (const double[]) { a, b }, (const double[]) { c, d })
#define SOLID(m, a, b, c, d, e, f) parted (&(m), (const double[]) { a, b, c }, (const double[]) { d, e, f })

/* Places on the end of a bore that is as long as the block is thick look from its wall, not through the
 * end; and a slot parts places on the faces that it ends on. */
static void ends_on_a_face_of_the_block_are_void (void **state)
{
    (void) state;
    made m;
    make (&m, 3,
          "  - add: {box: {low: [0, 0, 0], high: [9, 9, 4]}}\n"
          "  - subtract: {cylinder: {center: [4.5, 4.5, 0], radius: 2, length: 4}}\n",
          "");
    for (int z = 0; z <= 4; z += 4) {
        assert_false (SOLID (m, 2.75, 4.5, z, 2.25, 4.5, 2));
        assert_false (SOLID (m, 3, 4.5, z, 2, 4, 3));
        assert_false (SOLID (m, 3, 4.5, z, 2, 5, 1));
    }
    unmake (&m);
    make (&m, 3,
          "  - add: {box: {low: [0, 0, 0], high: [9, 9, 4]}}\n"
          "  - subtract: {box: {low: [4, 2, 0], high: [4.4, 9, 4]}}\n",
          "");
    for (int z = 0; z <= 4; z += 2) {
        assert_true (SOLID (m, 3.8, 5, z, 4.5, 5, z));
        assert_true (SOLID (m, 4, 5, z, 4.4, 5.5, z));
        assert_false (SOLID (m, 3.8, 5, z, 4, 7, z));
        assert_false (SOLID (m, 3.8, 1, z, 4.5, 2, z));
    }
    unmake (&m);
}

static void one_convex_shape_parts_nothing (void **state)
{
    (void) state;
    static const char *const plane[] = {
        "  - add: {box: {low: [0, 0], high: [9, 9]}}\n", "  - add: {disk: {center: [0, 0], radius: 5}}\n",
        "  - add: {polygon: {vertices: [[0, 0], [9, 0], [9, 9], [3, 7]]}}\n" };
    for (int k = 0; k < 3; k++) {
        made m;
    make (&m, 2, plane[k], "");
        assert_null (m.between);
        unmake (&m);
    }
}

/* A slot from the left to the middle, of any width. */
static void a_slot_parts_however_narrow (void **state)
{
    (void) state;
    static const double width[] = { 1e-6, 1e-3, 0.05, 0.3, 1, 2 };
    for (size_t k = 0; k < sizeof width / sizeof *width; k++) {
        char body[300];
        double w = width[k] / 2;
        snprintf (body, sizeof body, "  - add: {box: {low: [0, 0], high: [20, 20]}}\n"
                  "  - subtract: {box: {low: [-1, %.17g], high: [10, %.17g]}}\n", 10 - w, 10 + w);
        made m;
    make (&m, 2, body, "");
        assert_true (PLANE (m, 5, 9, 5, 11) && PLANE (m, 4, 9, 6, 11) && PLANE (m, 0, 9, 1, 11));
        assert_true (PLANE (m, 5, 10 - w, 5, 10 + w));                 /* from face to face */
        assert_true (!PLANE (m, 10, 9, 10, 11));                       /* along its end */
        assert_true (!PLANE (m, 11, 9, 11, 11) && !PLANE (m, 5, 8, 6, 9) && !PLANE (m, 3, 10 - w, 5, 10 - w));
        /* a point in the slot is on one side of it */
        if (w > 1e-4) assert_true (PLANE (m, 5, 10, 5, 9) != PLANE (m, 5, 10, 5, 11));
        unmake (&m);
    }
}

static void another_body_is_apart (void **state)
{
    (void) state;
    made m;
    make (&m, 2, "  - add: {box: {low: [0, 0], high: [9, 9]}}\n"
                      "  - add: {box: {low: [0, 9.01], high: [9, 18]}}\n", "");
    assert_true (PLANE (m, 5, 8.5, 5, 9.5) && PLANE (m, 5, 9, 6, 9.01) && !PLANE (m, 5, 9, 6, 9));
    unmake (&m);
    make (&m, 2, "  - add: {box: {low: [0, 0], high: [9, 9]}}\n"
                 "  - add: {box: {low: [0, 9], high: [9, 18]}}\n", "");
    assert_true (!PLANE (m, 5, 8, 6, 10) && !PLANE (m, 0, 8, 0, 10) && !PLANE (m, 5, 9, 6, 9.5));
    unmake (&m);
}

/* Chords of a hole of ten spacings stay, those across one of a spacing do not; at a corner a way outside
 * may be half a spacing long. */
static void smooth_chords_stay (void **state)
{
    (void) state;
    made m;
    make (&m, 2, "  - add: {box: {low: [-20, -20], high: [20, 20]}}\n"
                      "  - subtract: {disk: {center: [0, 0], radius: 10}}\n", "");
    double a = 0.15;                                   /* half the angle of a chord of three spacings */
    assert_true (!PLANE (m, 10 * sin (a), 10 * cos (a), -10 * sin (a), 10 * cos (a)));
    assert_true (PLANE (m, 0, 10.5, 0, -10.5) && PLANE (m, 10.1, 0, 0, 10.1));
    unmake (&m);
    make (&m, 2, "  - add: {box: {low: [-20, -20], high: [20, 20]}}\n"
                 "  - subtract: {disk: {center: [0, 0], radius: 0.5}}\n", "");
    assert_true (PLANE (m, 0, 1, 0, -1) && PLANE (m, 1, 0, -1, 0.1) && !PLANE (m, 1, 0.45, -1, 0.5));
    unmake (&m);
    make (&m, 2, "  - add: {box: {low: [0, 0], high: [20, 20]}}\n"
                 "  - subtract: {box: {low: [10, 10], high: [21, 21]}}\n", "");
    assert_true (!PLANE (m, 10, 10.3, 10.3, 10) && PLANE (m, 10, 10.4, 10.4, 10));
    assert_true (PLANE (m, 9.9, 11, 11, 9.9));
    unmake (&m);
}

/* A slot from outside into a hole: the chord of the hole that passes over its mouth parts, as do ways that
 * end at the edges of the mouth; chords beside it stay. */
static void chords_over_a_mouth_part (void **state)
{
    (void) state;
    for (double width = 0.02; width < 1; width *= 2.3)
        for (double end = 4.99; end < 8; end += 1.7)   /* where the slot ends: at the hole, in it */
            for (int dim = 2; dim <= 3; dim++) {
                made m;
                char body[400];
                snprintf (body, sizeof body,
                          dim == 2 ? "  - add: {box: {low: [0, 0], high: [20, 20]}}\n"
                                     "  - subtract: {disk: {center: [10, 10], radius: 5}}\n"
                                     "  - subtract: {box: {low: [-1, %g], high: [%g, %g]}}\n"
                                   : "  - add: {box: {low: [0, 0, 0], high: [20, 20, 4]}}\n"
                                     "  - subtract: {cylinder: {center: [10, 10, 0], radius: 5, length: 4}}\n"
                                     "  - subtract: {box: {low: [-1, %g, 0], high: [%g, %g, 4]}}\n",
                          10 - width / 2, end + 0.02, 10 + width / 2);
                make (&m, dim, body, "");
                for (double y = 0.6; y < 3; y += 0.7)
                    for (double x = 4.7; x < 5.3; x += 0.1) {
                        const double a[3] = { x, 10 - y, 2 }, b[3] = { 5, 10.55 + y / 3, 2 };
                        assert_true (parted (&m, a, b));
                    }
                const double c[3] = { 10 - 4.4, 7.4, 2 }, d[3] = { 10 - 3.4, 6.2, 2 };
                assert_false (parted (&m, c, d));
                unmake (&m);
            }
}

/* Cylinders, spheres, prisms, plates (cracks with a width) and boxes in space. */
static void the_same_in_space (void **state)
{
    (void) state;
    static const char *const cut[] = {
        "  - subtract: {box: {low: [-1, -1, 4.9], high: [5, 11, 5.1]}}\n",
        "  - subtract: {cylinder: {center: [2, 2, 4.9], axis: [0, 0, 1], radius: 9, length: 0.2}}\n",
        "  - subtract: {prism: {vertices: [[-1, -1], [7, -1], [-1, 7]], low: 4.9, high: 5.1}}\n",
        "  - subtract: {prism: {vertices: [[-1, -1], [7, -1], [3, 3], [-1, 7]], low: 4.9, high: 5.1}}\n",
        "  - subtract: {sphere: {center: [2, 2, 5], radius: 0.4}}\n", "" };
    for (size_t k = 0; k < sizeof cut / sizeof *cut; k++) {
        char body[300];
        snprintf (body, sizeof body, "  - add: {box: {low: [0, 0, 0], high: [10, 10, 10]}}\n%s", cut[k]);
        made m;
        make (&m, 3, body,
              *cut[k] ? "" : "cracks: [{polygon: [[0, 0, 5], [6, 0, 5], [0, 6, 5]], width: 0.2}]\n");
        assert_true (SOLID (m, 2, 2, 4, 2, 2, 6) && SOLID (m, 2, 2, 4, 2.1, 2.1, 6));
        assert_true (!SOLID (m, 2, 2, 3, 2, 2, 4) && !SOLID (m, 2, 2, 3, 1, 2, 4.5));
        if (k != 1) assert_true (!SOLID (m, 9.5, 9.5, 4, 9.5, 9.5, 6));
        unmake (&m);
    }
}

/* Of a lattice of which nothing is cut the families are those of a box; of one with a slot as small as
 * may be they end there. */
static void families_end_at_a_slot (void **state)
{
    (void) state;
    made m;
    make (&m, 2, "  - add: {box: {low: [0, 0], high: [20, 20]}}\n"
                      "  - subtract: {box: {low: [-1, 9.99], high: [10, 10.01]}}\n", "lattice: cells\n");
    pg_family f;
    size_t dropped, crossing = 0;
    check_ok (pg_family_build (&f, &m.cloud, m.cloud.n, m.cloud.x, 2.1, PG_RADIAL, 1));
    size_t before = f.start[f.n];
    check_ok (pg_between_sift (m.between, &f, m.cloud.x, NULL, NULL, 2, &dropped));
    assert_true (dropped > 0 && f.start[f.n] + dropped == before);
    for (size_t i = 0; i < f.n; i++)
        for (size_t e = f.start[i]; e < f.start[i + 1]; e++) {
            const double *x = m.cloud.x + 2*i, *y = m.cloud.x + 2 * (size_t) f.node[e];
            double t = (10 - x[1]) / (y[1] - x[1]), at = t > 0 && t < 1 ? x[0] + t * (y[0] - x[0]) : 20;
            crossing += at < 10;
        }
    assert_int_equal (crossing, 0);
    pg_family_clear (&f);
    unmake (&m);
}

/* Who sees whom is the same from either end, points in gaps included, which look from the nearest body. */
static void points_see_each_other_or_do_not (void **state)
{
    (void) state;
    for (int k = 0; k < 12; k++) {
        made m;
        char body[300], more[100];
        double gap = 0.05 + 0.21 * k;
        snprintf (body, sizeof body, "  - add: {disk: {center: [5, 5], radius: 5}}\n"
                                     "  - subtract: {disk: {center: [5, 5], radius: 2.2}}\n"
                                     "  - add: {box: {low: [%g, 0], high: [%g, 10]}}\n", 10 + gap, 16 + gap);
        snprintf (more, sizeof more, "lattice: nodes\nlattice_offset: [%g, %g]\n", 0.17 * k - 0.9, 0.07 * k);
        make (&m, 2, body, more);
        pg_family f;
        size_t dropped;
        check_ok (pg_family_build (&f, &m.cloud, m.cloud.n, m.cloud.x, 3.015, PG_RADIAL, 1));
        check_ok (pg_between_sift (m.between, &f, m.cloud.x, NULL, NULL, 1, &dropped));
        for (size_t i = 0; i < f.n; i++)
            for (size_t e = f.start[i]; e < f.start[i + 1]; e++) {
                size_t j = (size_t) f.node[e], back = f.start[j];
                while (back < f.start[j + 1] && (size_t) f.node[back] != i) back++;
                assert_true (back < f.start[j + 1]);
            }
        pg_family_clear (&f);
        unmake (&m);
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (ends_on_a_face_of_the_block_are_void),
        cmocka_unit_test (one_convex_shape_parts_nothing), cmocka_unit_test (a_slot_parts_however_narrow),
        cmocka_unit_test (another_body_is_apart),          cmocka_unit_test (smooth_chords_stay),
        cmocka_unit_test (chords_over_a_mouth_part),       cmocka_unit_test (the_same_in_space),
        cmocka_unit_test (families_end_at_a_slot),         cmocka_unit_test (points_see_each_other_or_do_not),
    };
    return cmocka_run_group_tests_name ("what lies between two points", tests, NULL, NULL);
}

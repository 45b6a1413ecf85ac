/* SPDX-License-Identifier: GPL-3.0-or-later
 * Search: every place inside curved meshes of every kind of element is found, ties, places outside, graded
 * meshes; fields between nodes. */
#include "check.h"
#include "measure.h"

static double noise (unsigned k)
{
    k ^= k >> 16, k *= 0x7feb352du, k ^= k >> 15, k *= 0x846ca68bu, k ^= k >> 16;
    return (double) k / 4294967296.0;
}

static const pg_element solid[] = { PG_BAR2, PG_BAR3,  PG_TRI3,   PG_TRI6,    PG_QUAD4, PG_QUAD8, PG_QUAD9,
                                    PG_TET4, PG_TET10, PG_WEDGE6, PG_WEDGE15, PG_HEX8,  PG_HEX20, PG_HEX27,
                                    PG_PYRAMID5 };
enum { SOLIDS = sizeof solid / sizeof *solid };

static void bend (double *x)
{
    double a = x[0], b = x[1], c = x[2];
    x[0] = a + 0.15 * b * b + 0.1 * a * c, x[1] = b - 0.2 * a * a + 0.1 * c * c, x[2] = c + 0.1 * a * c;
}

static void bend_line (double *x) { x[0] += 0.2 * x[0] * x[0]; }

static pg_mesh curved (pg_element kind, int n)
{
    return block_mesh (kind, n, pg_element_types[kind].dim == 1 ? bend_line : bend);
}

static pg_mesh_locator *locator_of (const pg_mesh *m)
{
    pg_mesh_locator *f = NULL;
    check_ok (pg_mesh_locator_create (&f, m));
    return f;
}

/* A place within element e. */
static void place_in (const pg_mesh *m, size_t e, unsigned seed, double *xi, double *place)
{
    double x[81], node[3], sum = 0, share[8];
    pg_element kind = (pg_element) m->kind[e];
    int corners = pg_element_types[kind].corners;
    for (int i = 0; i < corners; i++) sum += share[i] = 0.02 + noise (8 * seed + (unsigned) i);
    for (int a = 0; a < m->dim; a++) xi[a] = 0;
    for (int i = 0; i < corners; i++) {
        pg_element_node (kind, i, node);
        for (int a = 0; a < m->dim; a++) xi[a] += share[i] / sum * node[a];
    }
    element_places (m, e, pg_element_types[kind].nodes, NULL, x);
    pg_element_map (kind, m->dim, x, xi, place, NULL);
}

static void every_place_inside_is_found (void **state)
{
    (void) state;
    for (int k = 0; k < SOLIDS; k++) {
        pg_mesh m = curved (solid[k], 3);
        pg_mesh_locator *f = locator_of (&m);
        for (size_t e = 0; e < m.n; e++)
            for (unsigned s = 0; s < 5; s++) {
                double xi[3], place[3], found[3], away = 1;
                place_in (&m, e, 100 * (unsigned) e + s, xi, place);
                assert_int_equal (pg_mesh_locator_find (f, place, found, &away), e);
                assert_true (away == 0);
                for (int a = 0; a < m.dim; a++) check_absolute (found[a], xi[a], 1e-10);
            }
        pg_mesh_locator_free (&f);
        assert_null (f);
        pg_mesh_clear (&m);
    }
}

/* At a node the lowest of its elements is found. */
static void the_lowest_of_several_elements_is_taken (void **state)
{
    (void) state;
    for (int k = 0; k < SOLIDS; k++) {
        pg_mesh m = curved (solid[k], 3);
        pg_mesh_locator *f = locator_of (&m);
        for (size_t i = 0; i < m.nnode; i++) {
            double xi[3], away;
            size_t lowest = m.n;
            for (size_t e = m.n; e-- > 0; )
                for (size_t j = m.start[e]; j < m.start[e + 1]; j++) if ((size_t) m.node[j] == i) lowest = e;
            assert_int_equal (pg_mesh_locator_find (f, m.x + 3 * i, xi, &away), lowest);
        }
        pg_mesh_locator_free (&f), pg_mesh_clear (&m);
    }
}

/* The square (cube) is not bent: the nearest place is known. */
static void places_outside_give_the_nearest_inside (void **state)
{
    (void) state;
    for (int k = 2; k < SOLIDS; k++) {
        pg_mesh m = block_mesh (solid[k], 4, NULL);
        pg_mesh_locator *f = locator_of (&m);
        int dim = m.dim;
        for (unsigned s = 0; s < 40; s++) {
            double place[3], near[3], xi[3], x[81], at[3], away, d = 0;
            for (int a = 0; a < dim; a++) {
                place[a] = 2.7 * noise (3 * s + (unsigned) a) - 1.35;
                near[a] = fmax (-1, fmin (1, place[a]));
                d += (place[a] - near[a]) * (place[a] - near[a]);
            }
            long e = pg_mesh_locator_find (f, place, xi, &away);
            if (sqrt (d) > 0.5 * (1 + 1e-12)) {
                assert_int_equal (e, -1);
                continue;
            }
            assert_true (e >= 0);
            check_absolute (away, sqrt (d) / 0.5, 1e-9);
            element_places (&m, (size_t) e, pg_element_types[solid[k]].nodes, NULL, x);
            pg_element_map (solid[k], dim, x, xi, at, NULL);
            for (int a = 0; a < dim; a++) check_absolute (at[a], near[a], 1e-9);
            check_below (pg_element_outside (solid[k], xi), 1e-9);
            assert_int_equal (pg_mesh_locator_find (f, place, xi, NULL), d > 0 ? -1 : e);
        }
        pg_mesh_locator_free (&f), pg_mesh_clear (&m);
    }
}

/* Off a curved boundary: no place of the surface is nearer, tried densely. */
static void nearest_on_a_curved_boundary (void **state)
{
    (void) state;
    static const pg_element kinds[] = { PG_TRI6, PG_QUAD8, PG_QUAD9 };
    for (int k = 0; k < 3; k++) {
        pg_mesh m = curved (kinds[k], 3);
        pg_mesh_locator *f = locator_of (&m);
        size_t n;
        int *element, *side;
        check_ok (pg_mesh_surface (&m, &n, &element, &side));
        for (size_t j = 0; j < n; j++) {
            int node[9];
            double x[27], all[81], xi[3], foot[2], normal[2], place[2], at[2], away, least = HUGE_VAL;
            pg_element face = pg_element_face (kinds[k], side[j], node);
            element_places (&m, (size_t) element[j], 3, node, x);
            pg_element_map (face, 2, x, (double[1]) { 0.3 }, foot, normal);
            for (int a = 0; a < 2; a++) place[a] = foot[a] + 0.05 * normal[a];
            long e = pg_mesh_locator_find (f, place, xi, &away);
            assert_true (e >= 0);
            element_places (&m, (size_t) e, pg_element_types[kinds[k]].nodes, NULL, all);
            pg_element_map (kinds[k], 2, all, xi, at, NULL);
            for (size_t i = 0; i < n; i++)
                for (int q = 0; q <= 200; q++) {
                    double on[2];
                    pg_element_face (kinds[k], side[i], node);
                    element_places (&m, (size_t) element[i], 3, node, x);
                    pg_element_map (face, 2, x, (double[1]) { q / 100.0 - 1 }, on, NULL);
                    least = fmin (least, hypot (on[0] - place[0], on[1] - place[1]));
                }
            check_below (hypot (at[0] - place[0], at[1] - place[1]), least * (1 + 1e-9));
        }
        pg_free (element), pg_free (side);
        pg_mesh_locator_free (&f), pg_mesh_clear (&m);
    }
}

static void grade (double *x)
{
    for (int a = 0; a < 2; a++) x[a] = (exp (12 * (x[a] + 1) / 2) - 1) / (exp (12.0) - 1);
}

static void graded_and_far_meshes_are_searched (void **state)
{
    (void) state;
    pg_mesh m = block_mesh (PG_QUAD4, 30, grade);
    for (int far = 0; far < 2; far++) {
        for (size_t i = 0; far && i < m.nnode; i++) m.x[3 * i] += 1e3, m.x[3 * i + 1] -= 2e3;
        pg_mesh_locator *f = locator_of (&m);
        for (size_t e = 0; e < m.n; e++) {
            double xi[3], place[3], found[3], away;
            place_in (&m, e, (unsigned) e, xi, place);
            if (far && e < m.n / 2) continue;  /* the smallest elements are lost in rounding there */
            assert_int_equal (pg_mesh_locator_find (f, place, found, &away), e);
        }
        pg_mesh_locator_free (&f);
    }
    pg_mesh_clear (&m);
}

static void what_is_no_place_is_nowhere (void **state)
{
    (void) state;
    pg_mesh m = block_mesh (PG_TRI3, 1, NULL), none = { .dim = 2 };
    pg_mesh_locator *f = locator_of (&m);
    double xi[3], away;
    assert_int_equal (pg_mesh_locator_find (f, (double[2]) { NAN, 0 }, xi, &away), -1);
    assert_int_equal (pg_mesh_locator_find (f, (double[2]) { HUGE_VAL, 0 }, xi, &away), -1);
    assert_int_equal (pg_mesh_locator_find (f, (double[2]) { 1e300, 0 }, xi, &away), -1);
    pg_mesh_locator_free (&f);
    pg_mesh_locator_free (&f);
    check_fails (pg_mesh_locator_create (&f, &none), PG_E_USAGE);
    size_t used = pg_memory_used ();
    for (size_t k = 1; k < 7; k++) {
        pg_memory_fail_at (k);
        check_fails (pg_mesh_locator_create (&f, &m), PG_E_MEMORY);
        assert_int_equal (pg_memory_used (), used);
    }
    pg_memory_fail_at (0);
    pg_mesh_clear (&m);
}

/* ---- fields -------------------------------------------------------------------------------------------- */
static double quadratic (const double *x)
{
    return 1 + x[0] - 2 * x[1] + 0.5 * x[2] + x[0] * x[0] - x[0] * x[1] + 3 * x[1] * x[1] + x[2] * x[0]
           - x[2] * x[2];
}

static void slope (const double *x, double *g)
{
    g[0] = 1 + 2 * x[0] - x[1] + x[2], g[1] = -2 - x[0] + 6 * x[1], g[2] = 0.5 + x[0] - 2 * x[2];
}

/* Root mean square error of a quadratic field and of its gradient. */
static void errors (pg_element kind, int n, void (*map) (double *), double *value, double *gradient)
{
    pg_mesh m = block_mesh (kind, n, map);
    pg_mesh_field f = { "f", 1, pg_calloc (m.nnode, sizeof (double)) };
    for (size_t i = 0; i < m.nnode; i++) f.value[i] = quadratic (m.x + 3 * i);
    *value = *gradient = 0;
    for (size_t e = 0; e < m.n; e++)
        for (unsigned s = 0; s < 4; s++) {
            double xi[3], x[3] = { 0 }, out, got[3], g[3];
            place_in (&m, e, s, xi, x);
            pg_mesh_value (&m, &f, e, xi, &out);
            *value += (out - quadratic (x)) * (out - quadratic (x));
            assert_int_equal (pg_mesh_gradient (&m, &f, e, xi, got), 1);
            slope (x, g);
            for (int a = 0; a < m.dim; a++) *gradient += (got[a] - g[a]) * (got[a] - g[a]);
        }
    *value = sqrt (*value / (double) (4 * m.n)), *gradient = sqrt (*gradient / (double) (4 * m.n));
    pg_free (f.value);
    pg_mesh_clear (&m);
}

static void skew (double *x)
{
    double a = x[0];
    x[0] = a + 0.3 * x[1], x[1] = x[1] - 0.2 * a + 0.1 * x[2];
}

static void quadratic_fields_are_exact_on_straight_elements (void **state)
{
    (void) state;
    static const pg_element kinds[] = {
        PG_TRI6, PG_QUAD8, PG_QUAD9, PG_TET10, PG_WEDGE15, PG_HEX20, PG_HEX27
    };
    for (int k = 0; k < 7; k++) {
        double value, gradient;
        errors (kinds[k], 2, skew, &value, &gradient);
        check_below (value, 1e-13);
        check_below (gradient, 1e-12);
    }
}

/* Curved elements: order 3 and 2 (linear elements 2 and 1). */
static void fields_converge_on_curved_elements (void **state)
{
    (void) state;
    for (int k = 2; k < SOLIDS; k++) {
        double v[2], g[2];
        int order = pg_element_types[solid[k]].order;
        errors (solid[k], 4, bend, &v[0], &g[0]);
        errors (solid[k], 8, bend, &v[1], &g[1]);
        if (!(log2 (v[0] / v[1]) > order + 0.8) || !(log2 (g[0] / g[1]) > order - 0.2))
            print_error ("%s: %g %g, %g %g\n", pg_element_types[solid[k]].name, v[0], v[1], g[0], g[1]);
        assert_true (log2 (v[0] / v[1]) > order + 0.8);
        assert_true (log2 (g[0] / g[1]) > order - 0.2);
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (every_place_inside_is_found),
        cmocka_unit_test (the_lowest_of_several_elements_is_taken),
        cmocka_unit_test (places_outside_give_the_nearest_inside),
        cmocka_unit_test (nearest_on_a_curved_boundary),
        cmocka_unit_test (graded_and_far_meshes_are_searched),
        cmocka_unit_test (what_is_no_place_is_nowhere),
        cmocka_unit_test (quadratic_fields_are_exact_on_straight_elements),
        cmocka_unit_test (fields_converge_on_curved_elements),
    };
    return cmocka_run_group_tests (tests, NULL, NULL);
}

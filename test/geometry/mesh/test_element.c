/* SPDX-License-Identifier: GPL-3.0-or-later
 * Elements: shape functions, faces, quadrature, the map and its inverse. */
#include "check.h"
#include "geometry/mesh/element.h"

static double noise (unsigned k) { return (double) (k * 2654435761u % 1000003u) / 1000003.0; }
static int nodes_of (pg_element k) { return pg_element_types[k].nodes; }
static int dim_of (pg_element k) { return pg_element_types[k].dim; }
#define EACH(kind) for (pg_element kind = PG_POINT1; kind < PG_ELEMENTS; kind++)

/* A place inside, different for each seed. */
static void inside (pg_element kind, unsigned seed, double *xi)
{
    double node[3], sum = 0, share[8];
    int corners = pg_element_types[kind].corners;
    for (int i = 0; i < corners; i++) sum += share[i] = 0.05 + noise (8 * seed + (unsigned) i + 1);
    for (int a = 0; a < dim_of (kind); a++) xi[a] = 0;
    for (int i = 0; i < corners; i++) {
        pg_element_node (kind, i, node);
        for (int a = 0; a < dim_of (kind); a++) xi[a] += share[i] / sum * node[a];
    }
}

static void shapes_are_one_at_their_node_and_sum_to_one (void **state)
{
    (void) state;
    EACH (kind) {
        double N[27], xi[3], sum = 0;
        for (int i = 0; i < nodes_of (kind); i++) {
            pg_element_node (kind, i, xi);
            pg_element_shape (kind, xi, N, NULL);
            for (int j = 0; j < nodes_of (kind); j++) check_absolute (N[j], i == j, 1e-14);
        }
        inside (kind, 3, xi);
        pg_element_shape (kind, xi, N, NULL);
        for (int i = 0; i < nodes_of (kind); i++) sum += N[i];
        check_relative (sum, 1, 1e-14);
    }
}

static void slopes_are_those_of_the_shapes (void **state)
{
    (void) state;
    EACH (kind) {
        double xi[3], N[27], dN[81], up[27], down[27], h = 1e-5;
        int d = dim_of (kind);
        inside (kind, 5, xi);
        pg_element_shape (kind, xi, N, dN);
        for (int a = 0; a < d; a++) {
            double keep = xi[a], sum = 0;
            xi[a] = keep + h, pg_element_shape (kind, xi, up, NULL);
            xi[a] = keep - h, pg_element_shape (kind, xi, down, NULL);
            xi[a] = keep;
            for (int i = 0; i < nodes_of (kind); i++)
                check_absolute (dN[i * d + a], (up[i] - down[i]) / (2 * h), 1e-9), sum += dN[i * d + a];
            check_absolute (sum, 0, 1e-13);
        }
    }
}

/* Elements of order 2 carry all quadratic polynomials, those of order 1 all linear ones. */
static void polynomials_of_the_order_are_carried (void **state)
{
    (void) state;
    EACH (kind) {
        int d = dim_of (kind), order = pg_element_types[kind].order;
        for (int p = 0; p < 27; p++) {
            int e[3] = { p % 3, p / 3 % 3, p / 9 }, degree = e[0] + e[1] + e[2];
            if (degree > order || (d < 3 && e[2]) || (d < 2 && e[1]) || (d < 1 && e[0])) continue;
            double xi[3] = { 0 }, node[3] = { 0 }, N[27], sum = 0;
            inside (kind, 11, xi);
            pg_element_shape (kind, xi, N, NULL);
            for (int i = 0; i < nodes_of (kind); i++) {
                pg_element_node (kind, i, node);
                sum += N[i] * pow (node[0], e[0]) * pow (node[1], e[1]) * pow (node[2], e[2]);
            }
            check_absolute (sum, pow (xi[0], e[0]) * pow (xi[1], e[1]) * pow (xi[2], e[2]), 1e-14);
        }
    }
}

/* ---- faces and edges ----------------------------------------------------------------------------------- */
/* Coordinates of the nodes; bend: quadratic map, the same for all elements. */
static void nodes_at (pg_element kind, double bend, double *x)
{
    int d = dim_of (kind);
    for (int i = 0; i < nodes_of (kind); i++) {
        double n[3] = { 0, 0, 0 };
        pg_element_node (kind, i, n);
        double y[3] = { 3 + 2 * n[0] + 0.3 * n[1] + bend * n[1] * n[1],
                        1 + n[1] - 0.2 * n[2] + bend * n[0] * n[2],
                        -1 + 0.7 * n[2] + 0.1 * n[0] + bend * n[0] * n[1] };
        for (int a = 0; a < d; a++) x[i * d + a] = y[a];
    }
}

static void faces_look_outward_and_close_the_element (void **state)
{
    (void) state;
    EACH (kind) {
        double x[81], face_x[27], xi[3 * PG_ELEMENT_POINTS], w[PG_ELEMENT_POINTS], place[3], normal[3],
            flux = 0, total[3] = { 0, 0, 0 }, volume = 0;
        int d = dim_of (kind), node[9];
        if (d == 0) continue;
        nodes_at (kind, pg_element_types[kind].order == 2 ? 0.05 : 0, x);
        for (int f = 0; f < pg_element_types[kind].faces; f++) {
            pg_element face = pg_element_face (kind, f, node);
            assert_int_equal (dim_of (face), d - 1);
            for (int k = 0; k < nodes_of (face); k++)
                for (int a = 0; a < d; a++) face_x[k * d + a] = x[node[k] * d + a];
            int n = pg_element_rule (face, 5, xi, w);
            for (int q = 0; q < n; q++) {
                double size = pg_element_map (face, d, face_x, xi + q * (d - 1), place, normal) * w[q],
                       length = 0;
                if (d == 1) normal[0] = f == 0 ? -1 : 1;           /* a point has no side of its own */
                for (int a = 0; a < d; a++)
                    flux += size * place[a] * normal[a], total[a] += size * normal[a],
                        length += normal[a] * normal[a];
                check_relative (length, 1, 1e-13);
            }
        }
        int n = pg_element_rule (kind, 5, xi, w);
        for (int q = 0; q < n; q++) volume += w[q] * pg_element_map (kind, d, x, xi + q * d, place, NULL);
        assert_true (volume > 0);
        check_relative (flux, d * volume, 1e-12);              /* divergence theorem */
        for (int a = 0; a < d; a++) check_absolute (total[a], 0, 1e-12);
    }
}

static void middles_of_edges_and_faces_lie_half_way (void **state)
{
    (void) state;
    EACH (kind) {
        double a[3], b[3], c[3];
        int end[2], node[9], d = dim_of (kind), corners = pg_element_types[kind].corners;
        for (int e = 0; pg_element_types[kind].order == 2 && e < pg_element_types[kind].edges; e++) {
            pg_element_edge (kind, e, end);
            pg_element_node (kind, end[0], a), pg_element_node (kind, end[1], b),
                pg_element_node (kind, corners + e, c);
            for (int k = 0; k < d; k++) check_absolute (c[k], (a[k] + b[k]) / 2, 0);
        }
        for (int f = 0; f < pg_element_types[kind].faces; f++) {
            pg_element face = pg_element_face (kind, f, node);
            /* node k of the face lies where its own reference says */
            for (int k = 0; k < nodes_of (face); k++) {
                double N[27], xi[2], at[3] = { 0, 0, 0 };
                int flat = pg_element_types[face].corners;
                pg_element_node (face, k, xi);
                pg_element_shape (flat == 3   ? PG_TRI3
                                  : flat == 4 ? PG_QUAD4
                                  : flat == 2 ? PG_BAR2
                                              : PG_POINT1,
                                  xi, N, NULL);
                for (int i = 0; i < flat; i++) {
                    pg_element_node (kind, node[i], a);
                    for (int l = 0; l < d; l++) at[l] += N[i] * a[l];
                }
                pg_element_node (kind, node[k], b);
                for (int l = 0; l < d; l++) check_absolute (at[l], b[l], 1e-15);
            }
        }
    }
}

/* An element turned inside out: the other way round in space, each node between the same corners as before,
 * twice turned the same again. */
static void a_mirrored_element_keeps_its_middles (void **state)
{
    (void) state;
    EACH (kind) {
        const signed char *turn = element_mirror (kind);
        int n = nodes_of (kind), corners = pg_element_types[kind].corners, end[2], other[2];
        if (dim_of (kind) == 0) continue;
        for (int k = 0; k < n; k++) {
            assert_in_range (turn[k], k < corners ? 0 : corners, k < corners ? corners - 1 : n - 1);
            assert_int_equal (turn[(int) turn[k]], k);
        }
        for (int e = 0; pg_element_types[kind].order == 2 && e < pg_element_types[kind].edges; e++) {
            pg_element_edge (kind, e, end), pg_element_edge (kind, turn[corners + e] - corners, other);
            int a = turn[end[0]], b = turn[end[1]];
            assert_true ((a == other[0] && b == other[1]) || (a == other[1] && b == other[0]));
        }
    }
}

/* ---- quadrature ---------------------------------------------------------------------------------------- */
static double factorial (int n) { return n < 2 ? 1 : n * factorial (n - 1); }

static double line_moment (int e) { return e % 2 ? 0 : 2.0 / (e + 1); }

static double moment (pg_element kind, const int e[3])
{
    switch (kind) {
    case PG_TRI3: case PG_TRI6: return factorial (e[0]) * factorial (e[1]) / factorial (e[0] + e[1] + 2);
    case PG_TET4:
    case PG_TET10:
        return factorial (e[0]) * factorial (e[1]) * factorial (e[2]) / factorial (e[0] + e[1] + e[2] + 3);
    case PG_WEDGE6:
    case PG_WEDGE15:
        return factorial (e[0]) * factorial (e[1]) / factorial (e[0] + e[1] + 2) * line_moment (e[2]);
    case PG_PYRAMID5:
        return line_moment (e[0]) * line_moment (e[1]) * factorial (e[2]) * factorial (e[0] + e[1] + 2)
               / factorial (e[0] + e[1] + e[2] + 3);
    default:
        return line_moment (e[0]) * (dim_of (kind) > 1 ? line_moment (e[1]) : 1)
               * (dim_of (kind) > 2 ? line_moment (e[2]) : 1);
    }
}

static void rules_are_exact_positive_and_inside (void **state)
{
    (void) state;
    static const int simplex_degree[6] = { 0, 1, 2, 5, 6, 8 };
    for (pg_element kind = PG_BAR2; kind < PG_ELEMENTS; kind++)
        for (int order = 1; order <= 5; order++) {
            double xi[3 * PG_ELEMENT_POINTS], w[PG_ELEMENT_POINTS];
            int d = dim_of (kind), n = pg_element_rule (kind, order, xi, w),
                corners = pg_element_types[kind].corners;
            int simplex = d > 1 && corners == d + 1, wedge = corners == 6,
                degree = simplex || wedge ? simplex_degree[order] : 2 * order - 1;
            if (wedge && degree > 2 * order - 1) degree = 2 * order - 1;
            assert_true (n <= PG_ELEMENT_POINTS);
            for (int q = 0; q < n; q++) {
                assert_true (w[q] > 0);
                assert_true (pg_element_outside (kind, xi + q * d) < 0);
            }
            for (int p = 0; p < 1000; p++) {
                int e[3] = { p % 10, p / 10 % 10, p / 100 }, sum_of = e[0] + e[1] + e[2];
                double sum = 0;
                if (sum_of > degree || (d < 3 && e[2]) || (d < 2 && e[1])) continue;
                for (int q = 0; q < n; q++) {
                    double v = w[q];
                    for (int a = 0; a < d; a++) v *= pow (xi[q * d + a], e[a]);
                    sum += v;
                }
                check_scaled (sum, moment (kind, e), 2e-14, moment (kind, (int[3]) { 0, 0, 0 }));
            }
        }
}

/* Each point of a simplex rule is also there with two of its barycentric coordinates exchanged. */
static void rules_of_simplices_have_their_symmetry (void **state)
{
    (void) state;
    static const pg_element kinds[2] = { PG_TRI3, PG_TET4 };
    for (int t = 0; t < 2; t++)
        for (int order = 1; order <= 5; order++) {
            double xi[3 * PG_ELEMENT_POINTS], w[PG_ELEMENT_POINTS];
            int d = dim_of (kinds[t]), n = pg_element_rule (kinds[t], order, xi, w);
            for (int q = 0; q < n; q++)
                for (int a = 0; a <= d; a++) {
                    double L[4] = { 0 }, best = 1;
                    L[d] = 1;
                    for (int k = 0; k < d; k++) L[k] = xi[q * d + k], L[d] -= L[k];
                    double swap = L[a];
                    L[a] = L[(a + 1) % (d + 1)], L[(a + 1) % (d + 1)] = swap;
                    for (int p = 0; p < n; p++) {
                        double far = fabs (w[p] - w[q]);
                        for (int k = 0; k < d; k++) far = fmax (far, fabs (xi[p * d + k] - L[k]));
                        best = fmin (best, far);
                    }
                    check_below (best, 1e-14);
                }
        }
}

/* ---- map ----------------------------------------------------------------------------------------------- */
static void places_are_found_again (void **state)
{
    (void) state;
    EACH (kind) {
        double x[81], xi[3], place[3], back[3];
        int d = dim_of (kind);
        if (d == 0) continue;
        nodes_at (kind, pg_element_types[kind].order == 2 ? 0.1 : 0.05, x);
        for (unsigned k = 0; k < 50; k++) {
            inside (kind, k, xi);
            if (k % 5 == 0) xi[0] += 0.5;                     /* also outside */
            pg_element_map (kind, d, x, xi, place, NULL);
            assert_int_equal (pg_element_invert (kind, x, place, back), 1);
            for (int a = 0; a < d; a++) check_absolute (back[a], xi[a], 1e-11);
        }
    }
}

static void a_flat_element_is_not_inverted (void **state)
{
    (void) state;
    double x[8] = { 0, 0, 1, 0, 2, 0, 3, 0 }, xi[3], place[2] = { 0.3, 0.2 };
    assert_int_equal (pg_element_invert (PG_QUAD4, x, place, xi), 0);
    assert_int_equal (pg_element_invert (PG_TRI3, x, place, xi), 0);
    place[0] = NAN;
    x[5] = 1;
    assert_int_equal (pg_element_invert (PG_TRI3, x, place, xi), 0);
}

static void outside_is_measured_in_reference_units (void **state)
{
    (void) state;
    check_absolute (pg_element_outside (PG_HEX20, (double[3]) { 0.5, -1.25, 1 }), 0.25, 1e-15);
    check_absolute (pg_element_outside (PG_TRI6, (double[2]) { 0.75, 0.5 }), 0.25, 1e-15);
    check_absolute (pg_element_outside (PG_TET4, (double[3]) { 0.25, -0.5, 0.25 }), 0.5, 1e-15);
    check_absolute (pg_element_outside (PG_WEDGE6, (double[3]) { 0.25, 0.25, -2 }), 1, 1e-15);
    assert_true (pg_element_outside (PG_WEDGE15, (double[3]) { 0.25, 0.25, 0 }) < 0);
    check_absolute (pg_element_outside (PG_PYRAMID5, (double[3]) { 0.25, -0.75, 0.5 }), 0.25, 1e-15);
    assert_true (pg_element_outside (PG_PYRAMID5, (double[3]) { 0.25, -0.25, 0.5 }) < 0);
    assert_true (pg_element_outside (PG_BAR3, (double[1]) { 0.999 }) < 0);
}

/* A line in space, a surface in space. */
static void sizes_and_normals_of_lower_elements (void **state)
{
    (void) state;
    double line[6] = { 0, 0, 0, 2, 2, 1 }, surface[12] = { 0, 0, 0, 0, 2, 0, 0, 2, 2, 0, 0, 2 },
           flat[4] = { 0, 0, 3, 4 }, n[3], place[3];
    check_relative (pg_element_map (PG_BAR2, 3, line, (double[1]) { 0 }, place, n), 1.5, 1e-15);
    check_relative (place[1], 1, 1e-15);
    check_relative (pg_element_map (PG_QUAD4, 3, surface, (double[2]) { 0.1, 0.2 }, place, n), 1, 1e-15);
    check_relative (n[0], 1, 1e-15);
    check_relative (pg_element_map (PG_BAR2, 2, flat, (double[1]) { 0 }, NULL, n), 2.5, 1e-15);
    check_relative (n[0], 0.8, 1e-15);                     /* the element to the left of its side */
    check_relative (n[1], -0.6, 1e-15);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (shapes_are_one_at_their_node_and_sum_to_one),
        cmocka_unit_test (slopes_are_those_of_the_shapes),
        cmocka_unit_test (polynomials_of_the_order_are_carried),
        cmocka_unit_test (faces_look_outward_and_close_the_element),
        cmocka_unit_test (middles_of_edges_and_faces_lie_half_way),
        cmocka_unit_test (a_mirrored_element_keeps_its_middles),
        cmocka_unit_test (rules_are_exact_positive_and_inside),
        cmocka_unit_test (rules_of_simplices_have_their_symmetry),
        cmocka_unit_test (places_are_found_again),
        cmocka_unit_test (a_flat_element_is_not_inverted),
        cmocka_unit_test (outside_is_measured_in_reference_units),
        cmocka_unit_test (sizes_and_normals_of_lower_elements),
    };
    return cmocka_run_group_tests_name ("geometry/mesh/element", tests, NULL, NULL);
}

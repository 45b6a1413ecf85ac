/* SPDX-License-Identifier: GPL-3.0-or-later
 * Cells of a lattice cut by the surface of meshes: volume, area and the divergence identity of every cell of
 * boxes that are turned, shifted, mirrored, in mm, at random. Curved faces, parts of other shapes and side
 * sets: test_mesh_shape.c. */
#include "meshed.h"
#include "turned_box.h"

/* ---- what must hold ------------------------------------------------------------------------------------ */
static double area_of (const meshed *m)
{
    double A = 0;
    for (size_t f = 0; f < m->cells.nfacet; f++) A += m->cells.area[f];
    return A;
}

/* 1, x, y, z, xy, yz, xz, xyz about the middle of the cell, over its size, and their slopes. */
static void polynomials (const double *z, double *p, double slope[8][3])
{
    const int use[8][3] = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 },
                            { 1, 1, 0 }, { 0, 1, 1 }, { 1, 0, 1 }, { 1, 1, 1 } };
    for (int a = 0; a < 8; a++) {
        p[a] = 1;
        for (int k = 0; k < 3; k++) if (use[a][k]) p[a] *= z[k];
        for (int k = 0; k < 3; k++) {
            slope[a][k] = use[a][k];
            for (int l = 0; l < 3; l++) if (l != k && use[a][l]) slope[a][k] *= z[l];
        }
    }
}

/* Adds sum w p z_k n_l of points with these normals. */
static void add_points (double rest[8][9], const pg_cut_points *q, const double *middle, double h,
                        const double *normal)
{
    double z[3], p[8], slope[8][3];
    for (size_t i = 0; i < q->n; i++) {
        const double *n = normal ? normal : q->normal + 3 * i;
        for (int k = 0; k < 3; k++) z[k] = (q->x[3 * i + (size_t) k] - middle[k]) / h;
        polynomials (z, p, slope);
        for (int a = 0; a < 8; a++)
            for (int k = 0; k < 9; k++) rest[a][k] += q->weight[i] / (h * h) * p[a] * z[k / 3] * n[k % 3];
    }
}

/* The largest deviation from oint p z_k n_l dS = int (p,l z_k + p delta_kl) dV over all cut cells, relative
 * to a whole cell, with three Gauss points. */
static double identity (const meshed *m)
{
    const pg_cells *c = &m->cells;
    double worst = 0, h = m->cloud.h;
    pg_cut_points q = { 0 };
    for (size_t cell = 0; cell < c->n; cell++) {
        double rest[8][9] = { { 0 } }, middle[3], z[3], p[8], slope[8][3];
        if (c->kind[cell] != PG_CUT) continue;
        for (size_t k = 0; k < 3; k++)
            middle[k] = 0.5 * (c->x[c->start[cell] * 3 + k] + c->x[(c->start[cell] + 6) * 3 + k]);
        for (int face = 0; face < 6; face++) {
            double n[3] = { 0, 0, 0 };
            n[face / 2] = face % 2 ? 1 : -1;
            q.n = 0;
            check_ok (pg_cut_face (&q, c, cell, face, 3));
            add_points (rest, &q, middle, h, n);
        }
        for (size_t f = 0; f < c->nfacet; f++) {
            if (c->facet_cell[f] != (int) cell) continue;
            q.n = 0;
            if (c->facet_kind[f] == PG_CUT) {
                check_ok (pg_cut_facet (&q, c, f, 3));
                add_points (rest, &q, middle, h, NULL);
                continue;
            }
            /* A whole face: four points, at +-1/sqrt 3. */
            double x[12], w[4], *corner = c->facet_x + 3 * c->facet_start[f];
            for (int g = 0; g < 4; g++) {
                double s = 0.5 + (g % 2 ? 0.5 : -0.5) / sqrt (3), t = 0.5 + (g / 2 ? 0.5 : -0.5) / sqrt (3);
                for (int k = 0; k < 3; k++)
                    x[3 * g + k] = (1 - s - t) * corner[k] + s * corner[3 + k] + t * corner[9 + k];
                w[g] = c->area[f] / 4;
            }
            pg_cut_points four = { .n = 4, .x = x, .weight = w };
            add_points (rest, &four, middle, h, c->normal + 3 * f);
        }
        q.n = 0;
        check_ok (pg_cut_cell (&q, c, cell, 3));
        for (size_t i = 0; i < q.n; i++) {
            assert_true (q.weight[i] > 0);
            for (int k = 0; k < 3; k++) z[k] = (q.x[3 * i + (size_t) k] - middle[k]) / h;
            polynomials (z, p, slope);
            for (int a = 0; a < 8; a++)
                for (int k = 0; k < 9; k++)
                    rest[a][k] -= q.weight[i] / (h * h * h)
                                  * (slope[a][k % 3] * z[k / 3] + (k / 3 == k % 3) * p[a]);
        }
        for (int a = 0; a < 8; a++)
            for (int k = 0; k < 9; k++) worst = fmax (worst, fabs (rest[a][k]));
    }
    pg_cut_points_clear (&q);
    return worst;
}

/* ---- plane faces --------------------------------------------------------------------------------------- */
/* However the box lies, however it is divided: exact volume, surface and moments. */
static void a_turned_box_is_exact (void **state)
{
    (void) state;
    static const pose poses[] = {
        { 23, 31, 0, 1, 0, 1, 0 },       { 23, 31, 0, 1, 0, 2, 1 },   { 23, 31, 0, 1, 1, 2, 1 },
        { 113, 31, 0, 1, 0, 3, 0 },      { 23, 31, 77, 1, 0, 2, 0 },  { 23, 31, 0, 1000, 0, 2, 1 },
        { 45, 0, 0, 1, 0, 1, 1 },        { 1e-4, 0, 0, 1, 0, 1, 0 },  { 90, 90, 0, 1, 0, 2, 1 },
        { 45, 35.264389682754654, 0, 1, 0, 2, 0 },
    };
    for (size_t i = 0; i < sizeof poses / sizeof *poses; i++) {
        double volume, surface;
        meshed m = make (turned_box (&poses[i]), 0.17, 1);
        check_ok (pg_body_measure (&m.body, &volume, &surface) ? PG_OK : PG_E_USAGE);
        double e[3] = { volume_of (&m) / 0.48 - 1, area_of (&m) / 3.76 - 1, identity (&m) };
        print_message ("pose %zu: %zu cells, %zu facets, volume %.1e, area %.1e, identity %.1e\n", i,
                       m.cells.n, m.cells.nfacet, e[0], e[1], e[2]);
        double slack = poses[i].shift > 0 ? 50 : 1;
        check_below (fabs (e[0]), 1e-13 * slack);
        check_below (fabs (e[1]), 1e-12 * slack);
        check_below (e[2], 1e-12 * slack);
        drop (&m);
    }
}

/* Many more, at random angles and spacings: no pose is special. Faces within 1e-4 degrees of a plane of the
 * lattice leave that plane by less than lengths that count as none (1e-7 of a cell): known to that. */
static void no_pose_is_special (void **state)
{
    (void) state;
    double worst[2][3] = { { 0 }, { 0 } };
    unsigned seed = 1;
    int n = longer () ? 200 : 20;
    for (int i = 0; i < n; i++) {
        double random[4];
        for (int k = 0; k < 4; k++) seed = seed * 1664525u + 1013904223u, random[k] = seed / 4294967296.0;
        pose p = { 180 * random[0], 180 * random[1], random[2] - 0.5, 1, i % 3 == 0, 1 + i % 3, i % 2 };
        int nearly = i % 7 == 0;
        if (i % 5 == 0) p.about_z = 45 * (i % 4), p.about_x = 45 * (i / 5 % 4);
        if (nearly) p.about_x = 90 + pow (10, -4 - 8 * random[3]);
        meshed m = make (turned_box (&p), 0.14 + 0.06 * random[3], 1);
        double e[3] = { fabs (volume_of (&m) / 0.48 - 1), fabs (area_of (&m) / 3.76 - 1), identity (&m) };
        for (int k = 0; k < 3; k++) worst[nearly][k] = fmax (worst[nearly][k], e[k]);
        drop (&m);
    }
    for (int k = 0; k < 2; k++)
        print_message ("%d boxes%s: volume %.1e, area %.1e, identity %.1e\n", n, k ? ", nearly level" : "",
                       worst[k][0], worst[k][1], worst[k][2]);
    for (int k = 0; k < 6; k++) check_below (worst[k / 3][k % 3], k < 3 ? 1e-12 : 1e-6);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (a_turned_box_is_exact),
        cmocka_unit_test (no_pose_is_special),
    };
    return cmocka_run_group_tests_name ("geometry/cells/faceted", tests, NULL, NULL);
}

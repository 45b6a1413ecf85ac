/* SPDX-License-Identifier: GPL-3.0-or-later
 * turned_box.h: a box of 1 x 0.8 x 0.6 as a mesh, turned about two axes, written to a file of its own. */
#ifndef PERIGAL_TEST_TURNED_BOX_H
#define PERIGAL_TEST_TURNED_BOX_H
#include "check.h"
#include <stdlib.h>
#include <unistd.h>

/* ---- a box of its own ---------------------------------------------------------------------------------- */
static const double edges[3] = { 1, 0.8, 0.6 };
/* How the box lies: turned about two axes (degrees), shifted, scaled, mirrored in x. */
typedef struct { double about_z, about_x, shift, scale; int mirror, n, tets; } pose;

static inline void place (const pose *p, const double *x, double *y)
{
    double a = p->about_z * 3.14159265358979323846 / 180, b = p->about_x * 3.14159265358979323846 / 180,
           u = cos (a) * x[0] - sin (a) * x[1], v = sin (a) * x[0] + cos (a) * x[1], w = x[2];
    y[0] = p->mirror ? -u : u, y[1] = cos (b) * v - sin (b) * w, y[2] = sin (b) * v + cos (b) * w;
    for (int k = 0; k < 3; k++) y[k] = p->scale * y[k] + p->shift * (k + 1);
}

/* The files, removed when the test ends. */
static struct { char folder[20]; int count; } turned_boxes = { "/tmp/turned-XXXXXX", 0 };

static void drop_turned_boxes (void)
{
    char path[200];
    for (int i = 0; i < turned_boxes.count; i++) {
        snprintf (path, sizeof path, "%s/box%d.msh", turned_boxes.folder, i);
        unlink (path);
    }
    rmdir (turned_boxes.folder);
}

/* Writes it as n x (n + 1) x n hexahedra, or as six tetrahedra of each; returns the scene's body. */
static inline const char *turned_box (const pose *p)
{
    static const int cube[8][3] = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 },
                                    { 0, 0, 1 }, { 1, 0, 1 }, { 1, 1, 1 }, { 0, 1, 1 } };
    static const int tet[6][4] = { { 0, 1, 2, 6 }, { 0, 2, 3, 6 }, { 0, 3, 7, 6 },
                                   { 0, 7, 4, 6 }, { 0, 4, 5, 6 }, { 0, 5, 1, 6 } };
    static char text[600], path[200];
    int n[3] = { p->n, p->n + 1, p->n }, at[8], id = 0;
    if (turned_boxes.count == 0) assert_non_null (mkdtemp (turned_boxes.folder)), atexit (drop_turned_boxes);
    snprintf (path, sizeof path, "%s/box%d.msh", turned_boxes.folder, turned_boxes.count++);
    FILE *f = fopen (path, "w");
    assert_non_null (f);
    fprintf (f, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n%d\n", (n[0] + 1) * (n[1] + 1) * (n[2] + 1));
    for (int k = 0; k <= n[2]; k++)
        for (int j = 0; j <= n[1]; j++)
            for (int i = 0; i <= n[0]; i++) {
                double x[3] = { edges[0] * i / n[0], edges[1] * j / n[1], edges[2] * k / n[2] }, y[3];
                place (p, x, y);
                fprintf (f, "%d %.17g %.17g %.17g\n", ++id, y[0], y[1], y[2]);
            }
    fprintf (f, "$EndNodes\n$Elements\n%d\n", n[0] * n[1] * n[2] * (p->tets ? 6 : 1));
    id = 0;
    for (int k = 0; k < n[2]; k++)
        for (int j = 0; j < n[1]; j++)
            for (int i = 0; i < n[0]; i++) {
                for (int c = 0; c < 8; c++) {
                    int a = p->mirror ? 1 - cube[c][0] : cube[c][0];
                    at[c] = ((k + cube[c][2]) * (n[1] + 1) + j + cube[c][1]) * (n[0] + 1) + i + a + 1;
                }
                if (!p->tets) {
                    fprintf (f, "%d 5 2 1 1", ++id);
                    for (int c = 0; c < 8; c++) fprintf (f, " %d", at[c]);
                    fprintf (f, "\n");
                }
                for (int t = 0; t < 6 && p->tets; t++)
                    fprintf (f, "%d 4 2 1 1 %d %d %d %d\n", ++id, at[tet[t][0]], at[tet[t][1]],
                             at[tet[t][2]], at[tet[t][3]]);
            }
    fprintf (f, "$EndElements\n");
    fclose (f);
    snprintf (text, sizeof text, "dimension: 3\nbody:\n  - add: {mesh: {file: %s, unit: %s}}\n", path,
              p->scale == 1 ? "m" : "mm");
    return text;
}

#endif

/* SPDX-License-Identifier: GPL-3.0-or-later
 * Prints the CPU seconds of a million questions to the search for elements, and of building it, for each kind
 * of element. */
#include "perigal/mesh.h"
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static double seconds (void) { return (double) clock () / CLOCKS_PER_SEC; }

/* n^dim cells of [0, 1]^dim; tri, tet: cells halved, cut in six. */
static int make (pg_mesh *out, pg_element kind, int n)
{
    static const int corner[8][3] = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 },
                                      { 0, 0, 1 }, { 1, 0, 1 }, { 1, 1, 1 }, { 0, 1, 1 } };
    static const int part[7][8] = { { 0, 1, 2, 6 },
                                    { 0, 2, 3, 6 },
                                    { 0, 3, 7, 6 },
                                    { 0, 7, 4, 6 },
                                    { 0, 4, 5, 6 },
                                    { 0, 5, 1, 6 },
                                    { 0, 1, 2, 3, 4, 5, 6, 7 } };
    const pg_element_type *type = &pg_element_types[kind];
    pg_mesh_builder *m = NULL;
    int dim = type->dim, w = 2 * n + 1, tet = dim == 3 && type->corners == 4,
        failed = pg_mesh_builder_create (&m, "bench");
    for (long k = 0; k < (long) w * w * (dim == 3 ? w : 1); k++)
        failed |= pg_mesh_builder_node (m, k,
                                        (double[3]){ (double) (k % w) / (w - 1),
                                                     (double) (k / w % w) / (w - 1),
                                                     (double) (k / w / w) / (w - 1) });
    for (long c = 0; c < (long) n * n * (dim == 3 ? n : 1); c++)
        for (int p = tet ? 0 : 6; p < (tet ? 6 : 7); p++) {
            long node[27], low[3] = { 2 * (c % n), 2 * (c / n % n), dim == 3 ? 2 * (c / n / n) : 0 };
            for (int k = 0; k < type->nodes; k++) {
                int e[2] = { k, k };
                long at[3];
                if (k >= type->corners) pg_element_edge (kind, k - type->corners, e);
                for (int a = 0; a < 3; a++)
                    at[a] = low[a] + corner[part[p][e[0]]][a] + corner[part[p][e[1]]][a];
                node[k] = at[0] + w * (at[1] + w * at[2]);
            }
            failed |= pg_mesh_builder_element (m, c * 8 + p, kind, node, 0, 0);
        }
    failed = failed || pg_mesh_builder_finish (m, out);
    pg_mesh_builder_free (&m);
    return failed;
}

static void measure (const pg_mesh *m, const char *name)
{
    enum { QUESTIONS = 1000000 };
    pg_mesh_locator *f = NULL;
    double begin = seconds (), build, inside, away, xi[3], place[3];
    long found = 0;
    unsigned seed = 1;
    if (pg_mesh_locator_create (&f, m)) { fprintf (stderr, "%s\n", pg_last_error ()); exit (1); }
    build = seconds () - begin;
    begin = seconds ();
    for (long k = 0; k < QUESTIONS; k++) {
        for (int a = 0; a < m->dim; a++) seed = seed * 1664525u + 1013904223u, place[a] = seed / 4294967296.0;
        found += pg_mesh_locator_find (f, place, xi, NULL) >= 0;
    }
    inside = seconds () - begin;
    begin = seconds ();
    for (long k = 0; k < QUESTIONS / 100; k++) {
        for (int a = 0; a < m->dim; a++) seed = seed * 1664525u + 1013904223u, place[a] = seed / 4294967296.0;
        place[0] = 1 + 0.005 * place[0];
        found += pg_mesh_locator_find (f, place, xi, &away) >= 0;
    }
    printf ("%-8s %8zu elements: build %.2f s, 1e6 places inside %.2f s, one outside %.1f us (%ld found)\n",
            name, m->n, build, inside, 1e6 * (seconds () - begin) / (QUESTIONS / 100), found);
    pg_mesh_locator_free (&f);
}

int main (void)
{
    static const pg_element kind[] = { PG_QUAD4, PG_QUAD8, PG_TET4, PG_TET10, PG_HEX8, PG_HEX20 };
    for (int k = 0; k < 6; k++) {
        pg_mesh m;
        const pg_element_type *type = &pg_element_types[kind[k]];
        if (make (&m, kind[k], type->dim == 2 ? 300 : type->corners == 4 ? 20 : 40)) {
            fprintf (stderr, "%s\n", pg_last_error ());
            return 1;
        }
        measure (&m, type->name);
        pg_mesh_clear (&m);
    }
    return 0;
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * Times the search for the element that holds a place, for each kind of element: a CSV row with the
 * processor seconds of building the search and of a million places inside the body, and the microseconds
 * of one place outside, each as least, median, largest. */
#include "perigal/mesh.h"
#include "spread.h"
#include <stdio.h>
#include <stdlib.h>

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

enum { QUESTIONS = 1000000, REPEATS = 3 };

/* A place in the box [0, 1]^dim by a generator that is the same everywhere. */
static void place_of (const pg_mesh *m, unsigned *seed, double *place)
{
    for (int a = 0; a < m->dim; a++) {
        *seed = *seed * 1664525u + 1013904223u;
        place[a] = *seed / 4294967296.0;
    }
}

/* One repeat: seconds of building the search, of a million places inside, microseconds of one place
 * outside. Returns the places found. */
static long repeat (const pg_mesh *m, spread *build, spread *inside, spread *outside)
{
    pg_mesh_locator *f = NULL;
    double away, xi[3], place[3], begin = spread_processor ();
    long found = 0;
    unsigned seed = 1;
    if (pg_mesh_locator_create (&f, m)) { fprintf (stderr, "%s\n", pg_last_error ()); exit (1); }
    spread_add (build, spread_processor () - begin);
    begin = spread_processor ();
    for (long k = 0; k < QUESTIONS; k++) {
        place_of (m, &seed, place);
        found += pg_mesh_locator_find (f, place, xi, NULL) >= 0;
    }
    spread_add (inside, spread_processor () - begin);
    begin = spread_processor ();
    for (long k = 0; k < QUESTIONS / 100; k++) {
        place_of (m, &seed, place);
        place[0] = 1 + 0.005 * place[0];
        found += pg_mesh_locator_find (f, place, xi, &away) >= 0;
    }
    spread_add (outside, 1e6 * (spread_processor () - begin) / (QUESTIONS / 100));
    pg_mesh_locator_free (&f);
    return found;
}

static void measure (const pg_mesh *m, const char *name)
{
    spread build = { 0 }, inside = { 0 }, outside = { 0 };
    long found = 0;
    for (int k = 0; k < REPEATS; k++) found = repeat (m, &build, &inside, &outside);
    printf ("%s,%zu,", name, m->n);
    spread_print (&build, 1);
    spread_print (&inside, 1);
    spread_print (&outside, 1);
    printf ("%ld\n", found);
    fflush (stdout);
}

int main (void)
{
    static const pg_element kind[] = { PG_QUAD4, PG_QUAD8, PG_TET4, PG_TET10, PG_HEX8, PG_HEX20 };
    puts ("element,elements,build_s_min,build_s_median,build_s_max,inside_s_min,inside_s_median,inside_s_max,"
          "outside_us_min,outside_us_median,outside_us_max,found");
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

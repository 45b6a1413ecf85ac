/* SPDX-License-Identifier: GPL-3.0-or-later
 * Points that no lattice gives, divided among ranks by bisection of their coordinates
 * (geometry/cloud/subdomain_points.c) and by METIS (G. Karypis and V. Kumar, SIAM J. Sci. Comput. 20
 * (1998) 359), for
 * doc/scale.md:
 *
 *     division RANKS SCENE...
 *
 * The graph: points within one horizon of each other. Printed are bonds that are cut, as a share of all;
 * points that some other rank holds as a ghost, two horizons wide, counted by the bonds (those that a rank
 * reaches from its own points in two steps), over the points owned; the same in the boxes that perigal takes;
 * the largest part over the mean; seconds of the division. */
#include "perigal/cloud.h"
#include <dlfcn.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* METIS 5 with 32 bits, as Debian builds it, PETSc's own. */
typedef int (*metis_part) (int *nodes, int *constraints, int *start, int *node, int *weight, int *size,
                           int *bond_weight, int *parts, float *shares, float *imbalance, int *options,
                           int *cut, int *part);

typedef struct { int ranks; const pg_cloud *c; const pg_family *f; } cloud;

/* Bonds between parts over all bonds. */
static double cut_of (const cloud *g, const int *part)
{
    double cut = 0, all = 0;
    for (size_t i = 0; i < g->f->n; i++)
        for (size_t e = g->f->start[i]; e < g->f->start[i + 1]; e++)
            all++, cut += part[i] != part[g->f->node[e]];
    return cut / (all - (double) g->f->n);
}

/* Points that each rank reaches in two steps and does not own, all together over all points. */
static double ghosts_of (const cloud *g, const int *part)
{
    double ghosts = 0;
    unsigned char *near = calloc (g->f->n, 1);
    for (int r = 0; r < g->ranks && near; r++) {
        for (size_t i = 0; i < g->f->n; i++) near[i] = part[i] == r;
        for (unsigned char step = 1; step <= 2; step++)
            for (size_t i = 0; i < g->f->n; i++)
                for (size_t e = g->f->start[i]; near[i] > 0 && near[i] <= step && e < g->f->start[i + 1]; e++)
                    if (!near[g->f->node[e]]) near[g->f->node[e]] = (unsigned char) (step + 1);
        for (size_t i = 0; i < g->f->n; i++) ghosts += near[i] > 1;
    }
    free (near);
    return ghosts / (double) g->f->n;
}

static double largest (const cloud *g, const int *part)
{
    double most = 0;
    for (int r = 0; r < g->ranks; r++) {
        double n = 0;
        for (size_t i = 0; i < g->f->n; i++) n += part[i] == r;
        most = fmax (most, n);
    }
    return most * g->ranks / (double) g->f->n;
}

static void print (const cloud *g, const char *name, const char *how, const int *part, double seconds,
                   double boxes)
{
    printf ("%s,%zu,%d,%s,%.4f,%.3f,", name, g->f->n, g->ranks, how, cut_of (g, part), ghosts_of (g, part));
    if (boxes > 0) printf ("%.3f", boxes);
    printf (",%.3f,%.3f\n", largest (g, part), seconds);
}

/* The graph without loops. */
static int by_metis (const cloud *g, const char *name)
{
    void *library = dlopen ("libmetis.so.5", RTLD_NOW);
    metis_part kway = NULL, recursive = NULL;
    if (!library) return 0;
    *(void **) &kway = dlsym (library, "METIS_PartGraphKway");
    *(void **) &recursive = dlsym (library, "METIS_PartGraphRecursive");
    int n = (int) g->f->n, one = 1, ranks = g->ranks, cut, *start = calloc (g->f->n + 1, sizeof *start),
        *node = calloc (g->f->start[g->f->n], sizeof *node), *part = calloc (g->f->n, sizeof *part);
    for (size_t i = 0; start && node && i < g->f->n; i++) {
        start[i + 1] = start[i];
        for (size_t e = g->f->start[i]; e < g->f->start[i + 1]; e++)
            if ((size_t) g->f->node[e] != i) node[start[i + 1]++] = g->f->node[e];
    }
    double t0 = pg_seconds ();
    if (kway && part
        && kway (&n, &one, start, node, NULL, NULL, NULL, &ranks, NULL, NULL, NULL, &cut, part) == 1)
        print (g, name, "METIS, k-way", part, pg_seconds () - t0, 0);
    t0 = pg_seconds ();
    if (recursive && part
        && recursive (&n, &one, start, node, NULL, NULL, NULL, &ranks, NULL, NULL, NULL, &cut, part) == 1)
        print (g, name, "METIS, recursive", part, pg_seconds () - t0, 0);
    free (start), free (node), free (part);
    return 1;
}

static pg_status compare (const char *path, int count)
{
    pg_status status = PG_OK;
    pg_scene *scene = NULL;
    pg_mesh_body mesh = { 0 };
    pg_body body = { 0 };
    pg_cloud c = { 0 };
    pg_lattice lattice = { 0 };
    pg_family f = { 0 };
    pg_ranks ranks;
    int *owner = NULL;
    pg_part_size *part = NULL;
    PG_ALLOC (part, (size_t) count);
    PG_TRY (pg_scene_load (&scene, path));
    PG_TRY (pg_body_read (&body, scene));
    if (pg_scene_given (scene, "mesh")) {
        PG_TRY (pg_mesh_body_read (&mesh, scene));
        PG_TRY (pg_mesh_body_cloud (&c, &mesh, scene));
    } else PG_TRY (pg_cloud_build (&c, &lattice, &body, scene));
    double horizon = pg_scene_length (scene, c.h, "method.horizon");
    /* bonds in both directions, also where spacings differ: METIS asks for a symmetric graph */
    pg_cloud even = c;
    even.size = NULL, even.metric = NULL;
    PG_TRY (pg_family_build (&f, &even, c.n, c.x, horizon, PG_RADIAL, 1));
    cloud g = { count, &c, &f };
    double boxes = 0, t0 = pg_seconds ();
    pg_ranks_stand_in (&ranks, count);
    pg_ranks_join (&ranks);
    PG_TRY (pg_cloud_divide (&c, 2 * horizon, &owner));
    t0 = pg_seconds () - t0;
    if (pg_scene_given (scene, "mesh") || pg_scene_given (scene, "points")) {
        PG_TRY (pg_cloud_parts (part, &body, scene, 2 * horizon, count));
        for (int r = 0; r < count; r++) boxes += part[r].ghosts / (double) c.n;
    }
    print (&g, path, "bisection", owner, t0, boxes);
    if (!by_metis (&g, path)) fprintf (stderr, "there is no METIS\n");
done:
    pg_ranks_join (NULL);
    pg_free (owner), pg_free (part);
    pg_family_clear (&f), pg_cloud_clear (&c), pg_lattice_clear (&lattice);
    pg_mesh_body_clear (&mesh), pg_body_clear (&body), pg_scene_free (&scene);
    return status;
}

int main (int argc, char **argv)
{
    if (argc < 3) return fprintf (stderr, "usage: division RANKS SCENE...\n"), 64;
    printf ("scene,points,ranks,division,bonds cut,ghosts,ghosts of boxes,largest part,seconds\n");
    for (int k = 2; k < argc; k++)
        if (compare (argv[k], atoi (argv[1])) != PG_OK)
            return fprintf (stderr, "%s: %s\n", argv[k], pg_last_error ()), 1;
    return 0;
}

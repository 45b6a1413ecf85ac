/* SPDX-License-Identifier: GPL-3.0-or-later
 * The points of a cloud as cells of the lattice they came from, found from their positions, steps and volumes
 * alone, because a result file does not say how its points were made. */
#include "picture_private.h"
#include <math.h>
#include <stdlib.h>

/* Finds the edge lengths of a cell (the cloud's steps, its spacing, or the cube root of the mean
 * volume, whichever is known) and the number of cells along each axis. Returns 0 if there would
 * be many more cells than points: the points then lie on no lattice. */
static int measure (pg_grid *g, const pg_cloud *cloud)
{
    double cells = 1, mean = 0;
    for (size_t i = 0; i < cloud->n; i++) mean += cloud->volume ? cloud->volume[i] / (double) cloud->n : 0;
    for (int a = 0; a < 3; a++) {
        double low = cloud->x[a], high = low;
        for (size_t i = 1; i < cloud->n; i++)
            low = fmin (low, cloud->x[3 * i + (size_t) a]), high = fmax (high, cloud->x[3 * i + (size_t) a]);
        double step = cloud->step[a] > 0 ? cloud->step[a] : cloud->h > 0 ? cloud->h : cbrt (mean);
        if (!(step > 0)) step = high > low ? (high - low) / cbrt ((double) cloud->n) : 1;
        g->origin[a] = low, g->step[a] = step;
        g->low[a] = low - 0.5 * step, g->high[a] = high + 0.5 * step;
        double count = floor ((high - low) / step + 0.5) + 1;
        cells *= count;
        g->count[a] = count < 1e9 ? (int) count : 1000000000;
    }
    return cells < 64 * (double) cloud->n + 1e6;
}

/* Lattices whose nodes lie on the faces of the body have half cells there: their volumes show
 * it (below 0.75 of the largest one), and the box of the cells then ends at the points. */
static void cut_faces (pg_grid *g, const pg_cloud *cloud)
{
    double whole = 0, most[3][2] = { { 0 } };
    if (!cloud->volume) return;
    for (size_t i = 0; i < cloud->n; i++) {
        whole = fmax (whole, cloud->volume[i]);
        for (int a = 0; a < 3; a++) {
            int k = pg_grid_place (g, a, cloud->x[3 * i + (size_t) a]);
            for (int side = 0; side < 2; side++)
                if (k == (side ? g->count[a] - 1 : 0)) most[a][side] = fmax (most[a][side], cloud->volume[i]);
        }
    }
    for (int a = 0; a < 3; a++) {
        if (g->count[a] < 3) continue;
        if (most[a][0] < 0.75 * whole) g->low[a] += 0.5 * g->step[a];
        if (most[a][1] < 0.75 * whole) g->high[a] -= 0.5 * g->step[a];
    }
}

/* Index of the cell that holds coordinate x; -1 or count just outside of the lattice. */
int pg_grid_place (const pg_grid *g, int axis, double x)
{
    double k = floor ((x - g->origin[axis]) / g->step[axis] + 0.5);
    return k < -1 ? -1 : k > g->count[axis] ? g->count[axis] : (int) k;
}

/* Position of a cell in g->at, x running fastest. */
static size_t cell_index (const pg_grid *g, const int *cell)
{
    return ((size_t) cell[2] * (size_t) g->count[1] + (size_t) cell[1]) * (size_t) g->count[0]
           + (size_t) cell[0];
}

int pg_grid_point (const pg_grid *g, const int *cell)
{
    for (int a = 0; a < 3; a++) if (cell[a] < 0 || cell[a] >= g->count[a]) return -1;
    return g->at[cell_index (g, cell)];
}

/* Two points in one cell mean that there is no lattice (loose): then neighbours are not known and every
 * point is drawn as a cube of its own. */
pg_status pg_grid_build (pg_grid *g, const pg_cloud *cloud)
{
    pg_status status = PG_OK;
    *g = (pg_grid) { 0 };
    g->loose = !measure (g, cloud);
    cut_faces (g, cloud);
    if (g->loose) goto done;
    size_t cells = (size_t) g->count[0] * (size_t) g->count[1] * (size_t) g->count[2];
    PG_ALLOC (g->at, cells);
    for (size_t k = 0; k < cells; k++) g->at[k] = -1;
    for (size_t i = 0; i < cloud->n && !g->loose; i++) {
        int cell[3];
        for (int a = 0; a < 3; a++) cell[a] = pg_grid_place (g, a, cloud->x[3 * i + (size_t) a]);
        int *at = &g->at[cell_index (g, cell)];
        g->loose = *at >= 0;
        *at = (int) i;
    }
    if (g->loose) pg_free (g->at), g->at = NULL;
done:
    return status;
}

void pg_grid_clear (pg_grid *g)
{
    pg_free (g->at);
    *g = (pg_grid) { 0 };
}

/* ---- 2D ------------------------------------------------------------------------------------------------ */
/* 1 if the coordinates along an axis are those of no lattice: more than a third of them differ from each
 * other. work: n values of scratch space. */
static int spreads (const pg_cloud *cloud, int axis, double *work)
{
    double step = cloud->step[axis] > 0 ? cloud->step[axis] : cloud->h;
    size_t own = 1, n = cloud->n;
    if (!(step > 0) || cloud->regular) return 0;
    for (size_t i = 0; i < n; i++) work[i] = cloud->x[2 * i + (size_t) axis];
    pg_sort (work, n, sizeof *work, pg_ascending_numbers);
    for (size_t i = 1; i < n; i++) own += work[i] - work[i - 1] > 1e-6 * step;
    return 3 * own > n;
}

/* The spacing about a point follows from its volume; where the thickness is not known, compared with the
 * median volume. */
pg_status pg_loose_spacing (const pg_cloud *cloud, double **spacing)
{
    pg_status status = PG_OK;
    double *sorted = NULL;
    *spacing = NULL;
    if (cloud->dim != 2 || cloud->n < 16) return PG_OK;
    PG_ALLOC (sorted, cloud->n);
    if (!spreads (cloud, 0, sorted) || !spreads (cloud, 1, sorted)) goto done;
    PG_ALLOC (*spacing, cloud->n);
    for (size_t i = 0; i < cloud->n; i++) sorted[i] = cloud->volume ? cloud->volume[i] : 1;
    pg_sort (sorted, cloud->n, sizeof *sorted, pg_ascending_numbers);
    double middle = sorted[cloud->n / 2];
    for (size_t i = 0; i < cloud->n; i++)
        (*spacing)[i] = cloud->volume && cloud->thickness > 0 ? sqrt (cloud->volume[i] / cloud->thickness)
                        : cloud->h * sqrt (cloud->volume && middle > 0 ? cloud->volume[i] / middle : 1);
done:
    pg_free (sorted);
    return status;
}

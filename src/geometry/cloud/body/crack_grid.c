/* SPDX-License-Identifier: GPL-3.0-or-later
 * Balls about cracks, sorted into the cells of a grid: a network of n cracks is placed in time proportional
 * to n. */
#include "crack_random.h"
#include <math.h>

/* Cells along an axis in 2D and in 3D. */
enum { PLANE = 128, SPACE = 24 };

pg_status crack_grid_create (crack_grid *g, int dim, const double *low, const double *high)
{
    pg_status status = PG_OK;
    size_t n = 1;
    *g = (crack_grid) { .dim = dim, .cells = { 1, 1, 1 } };
    for (int k = 0; k < dim; k++) {
        g->cells[k] = dim == 2 ? PLANE : SPACE;
        g->low[k] = low[k], g->size[k] = (high[k] - low[k]) / g->cells[k];
        n *= (size_t) g->cells[k];
    }
    PG_ALLOC (g->cell, n);
done:
    return status;
}

void crack_grid_clear (crack_grid *g)
{
    size_t n = (size_t) g->cells[0] * (size_t) g->cells[1] * (size_t) g->cells[2];
    for (size_t k = 0; g->cell && k < n; k++) pg_free (g->cell[k].ball);
    pg_free (g->cell);
    g->cell = NULL;
}

void crack_grid_range (const crack_grid *g, const double *x, double r, int first[3], int last[3])
{
    for (int k = 0; k < 3; k++) {
        first[k] = last[k] = 0;
        if (k >= g->dim || !(g->size[k] > 0)) continue;
        double most = g->cells[k] - 1;
        first[k] = (int) fmin (fmax (floor ((x[k] - r - g->low[k]) / g->size[k]), 0), most);
        last[k] = (int) fmin (fmax (floor ((x[k] + r - g->low[k]) / g->size[k]), 0), most);
    }
}

static struct crack_cell *cell_at (const crack_grid *g, const int *at)
{
    return &g->cell[((size_t) at[2] * (size_t) g->cells[1] + (size_t) at[1]) * (size_t) g->cells[0]
                    + (size_t) at[0]];
}

const struct crack_cell *crack_grid_cell (const crack_grid *g, const int *at) { return cell_at (g, at); }

pg_status crack_grid_add (crack_grid *g, unsigned ball, const double *x, double r)
{
    pg_status status = PG_OK;
    int first[3], last[3], at[3];
    crack_grid_range (g, x, r, first, last);
    for (at[2] = first[2]; at[2] <= last[2]; at[2]++)
        for (at[1] = first[1]; at[1] <= last[1]; at[1]++)
            for (at[0] = first[0]; at[0] <= last[0]; at[0]++) {
                struct crack_cell *c = cell_at (g, at);
                PG_GROW (c->ball, c->cap, c->n + 1);
                c->ball[c->n++] = ball;
            }
done:
    return status;
}

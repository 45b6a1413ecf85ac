/* SPDX-License-Identifier: GPL-3.0-or-later
 * Which sites of a lattice are points: a vertex that some kept cell touches, or the centre of a kept cell,
 * in the order of the lattice, x fastest. This repeats the numbering of the points themselves, so that the
 * numbers need not be stored with the cloud. */
#include "sites.h"
#include <math.h>
#include <string.h>

/* Number of site i (three indices), x fastest. */
static size_t site_at (const cells_sites *s, const int *i)
{
    return ((size_t) i[2] * (size_t) s->size[1] + (size_t) i[1]) * (size_t) s->size[0] + (size_t) i[0];
}

/* Counts the kept cells around each site: a cell counts at its 2^dim vertices, or once at its centre. */
static void count (cells_sites *s)
{
    const pg_lattice *l = s->l;
    const unsigned char *in = l->in;
    int i[3], far[3];
    for (int k = 0; k < 3; k++) far[k] = s->size[k] > l->count[k];
    for (i[2] = 0; i[2] < l->count[2]; i[2]++)
        for (i[1] = 0; i[1] < l->count[1]; i[1]++)
            for (i[0] = 0; i[0] < l->count[0]; i[0]++) {
                if (!*in++) continue;
                for (int z = 0; z <= far[2]; z++)
                    for (int y = 0; y <= far[1]; y++)
                        for (int x = 0; x <= far[0]; x++)
                            s->around[site_at (s, (int[]){ i[0] + x, i[1] + y, i[2] + z })]++;
            }
}

/* Points are centres if there are as many as kept cells; vertices are always more. */
pg_status cells_sites_create (cells_sites *s, const pg_lattice *l, const pg_cloud *cloud)
{
    pg_status status = PG_OK;
    size_t n = 1, kept = 0, cells = (size_t) l->count[0] * (size_t) l->count[1] * (size_t) l->count[2];
    int next = 0;
    memset (s, 0, sizeof *s);
    for (size_t c = 0; c < cells; c++) kept += l->in[c] != 0;
    /* There are more vertices than cells, so that the number of points tells what they are. */
    s->l = l, s->centred = kept == cloud->n;
    for (int k = 0; k < 3; k++)
        s->size[k] = l->count[k] + (k < l->dim && !s->centred), n *= (size_t) s->size[k];
    PG_ALLOC (s->number, n);
    PG_ALLOC (s->around, n);
    count (s);
    for (size_t v = 0; v < n; v++) s->number[v] = s->around[v] ? next++ : -1;
done:
    if (status != PG_OK) cells_sites_clear (s);
    return status;
}

void cells_sites_clear (cells_sites *s)
{
    pg_free (s->number), pg_free (s->around);
    memset (s, 0, sizeof *s);
}

void cells_sites_cell (const cells_sites *s, const double *low, int *i)
{
    for (int k = 0; k < 3; k++)
        i[k] = k < s->l->dim ? (int) lround ((low[k] - s->l->origin[k]) / s->l->step[k]) : 0;
}

int cells_sites_at (const cells_sites *s, const double *x)
{
    int i[3];
    cells_sites_cell (s, x, i);
    return s->centred ? -1 : s->number[site_at (s, i)];
}

/* The points at the centres of the cells across the faces of cell i; returns how many. */
static int beside (const cells_sites *s, const int *i, int *point)
{
    int n = 0;
    for (int f = 0; f < 2 * s->l->dim; f++) {
        int at[3] = {i[0], i[1], i[2]};
        at[f / 2] += f % 2 ? 1 : -1;
        if (at[f / 2] < 0 || at[f / 2] >= s->size[f / 2]) continue;
        int p = s->number[site_at (s, at)];
        if (p >= 0) point[n++] = p;
    }
    return n;
}

int cells_sites_points (const cells_sites *s, const int *i, int outer, int *point)
{
    int dim = s->l->dim, n = 0;
    if (s->centred) {
        point[0] = s->number[site_at (s, i)];
        return point[0] >= 0 ? 1 : outer ? beside (s, i, point) : 0;
    }
    for (int c = 0; c < 1 << dim; c++) {
        size_t v = site_at (s, (int[]) {i[0] + (c & 1), i[1] + (c >> 1 & 1), i[2] + (c >> 2 & 1)});
        if (s->number[v] >= 0 && (!outer || s->around[v] < 1 << dim)) point[n++] = s->number[v];
    }
    return n;
}

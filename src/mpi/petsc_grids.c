/* SPDX-License-Identifier: GPL-3.0-or-later
 * Coarse grids of ranks that divide a lattice, which is itself the first coarse grid of the nodes
 * (src/linalg/multilevel_ranks.c): multilinear functions on the vertices of grids of twice, four times ...
 * the step, as one process has them, which PETSc multiplies out to coarse matrices (P' A P). A vertex belongs
 * to the lowest rank that has a node under its function; ranks tell each other which vertices they have at
 * the borders of what they own. */
#include "petsc_factor.h"
#include <math.h>
#include <mpi.h>
#include <petscksp.h>
#include <stdlib.h>
#include <string.h>

/* Nodes of a level that this rank owns, at whole steps of its grid; number: of the first of them, over all
 * ranks; end: the largest index along each axis, of all ranks. */
typedef struct { size_t n; int *at, end[3], dim; long long number; } grid;
/* Functions that nodes here lean on: the vertex, its number over all ranks, who owns it. */
typedef struct { long long key, number; int owner; } vertex;

static int by_key (const void *a, const void *b)
{
    const vertex *x = a, *y = b;
    if (x->key != y->key) return x->key < y->key ? -1 : 1;
    return (x->owner > y->owner) - (x->owner < y->owner);
}

static int same_key (const void *a, const void *b)
{
    const vertex *x = a, *y = b;
    return (x->key > y->key) - (x->key < y->key);
}

/* One of several owners' entries may be found: in a list that has each vertex once, the vertex. */
static const vertex *find (const vertex *list, size_t n, long long key)
{
    vertex one = { .key = key };
    return n ? bsearch (&one, list, n, sizeof *list, same_key) : NULL;
}

static pg_status lost (int code)
{
    return code == MPI_SUCCESS
               ? PG_OK : pg_error (PG_E_FILE, PG_HERE, "ranks lost each other while they made coarse grids");
}

/* The vertices of the next grid at the corners of the cell around a node, and their weights: on a vertex, or
 * in the middle of two, along each axis. Returns how many there are. */
static int corners_of (const grid *g, const int *at, long long *key, double *weight)
{
    int n = 1;
    long long stride = 1;
    key[0] = 0, weight[0] = 1;
    for (int k = 0; k < g->dim; k++) {
        int low = at[k] / 2, both = at[k] % 2, count = n;
        for (int c = 0; c < count; c++) {
            if (both) key[n] = key[c] + stride * (low + 1), weight[n++] = 0.5 * weight[c];
            key[c] += stride * low, weight[c] *= both ? 0.5 : 1;
        }
        stride *= (g->end[k] + 1) / 2 + 1;
    }
    return n;
}

/* The vertices that nodes of this rank lean on, ascending, each once. */
static pg_status list_vertices (const grid *g, int rank, vertex **out, size_t *count)
{
    pg_status status = PG_OK;
    size_t n = 0, last = 0, cap = 0;
    long long key[8];
    double weight[8];
    for (size_t i = 0; i < g->n; i++) {
        int m = corners_of (g, g->at + 3 * i, key, weight);
        PG_GROW (*out, cap, n + (size_t) m);
        for (int c = 0; c < m; c++) (*out)[n++] = (vertex) { key[c], -1, rank };
    }
    if (n) qsort (*out, n, sizeof **out, by_key);
    for (size_t k = 0; k < n; k++)
        if (k == 0 || (*out)[k].key != (*out)[last - 1].key) (*out)[last++] = (*out)[k];
    *count = last;
done:
    return status;
}

/* Is the whole function of a vertex over nodes between low and high, the box of what this rank owns? Then no
 * other rank knows of it. On grids above the first what ranks own are no boxes. */
static int is_inside (const grid *g, long long key, const int *low, const int *high)
{
    for (int k = 0; k < g->dim; k++) {
        long long count = (g->end[k] + 1) / 2 + 1;
        int v = (int) (key % count);
        key /= count;
        if (2 * v - 1 < low[k] || 2 * v + 1 > high[k]) return 0;
    }
    return 1;
}

/* The lists of all ranks one after the other (*all: pg_free). */
static pg_status gather (const vertex *mine, size_t n, vertex **all, size_t *n_all)
{
    pg_status status = PG_OK;
    int size, bytes = (int) (n * sizeof *mine), *count = NULL, *begin = NULL;
    MPI_Comm_size (MPI_COMM_WORLD, &size);
    PG_ALLOC (count, (size_t) size);
    PG_ALLOC (begin, (size_t) size + 1);
    PG_TRY (lost (MPI_Allgather (&bytes, 1, MPI_INT, count, 1, MPI_INT, MPI_COMM_WORLD)));
    for (int r = 0; r < size; r++) begin[r + 1] = begin[r] + count[r];
    *n_all = (size_t) begin[size] / sizeof *mine;
    PG_ALLOC (*all, *n_all);
    PG_TRY (lost (MPI_Allgatherv (mine, bytes, MPI_BYTE, *all, count, begin, MPI_BYTE, MPI_COMM_WORLD)));
done:
    pg_free (count), pg_free (begin);
    return status;
}

/* Owners of the vertices that ranks have in common, then numbers of all: owned ones count on from those of
 * the ranks before. *own: how many are owned here, *first: number of the first of them. */
static pg_status number_vertices (const grid *g, int first_grid, vertex *v, size_t n, size_t *own,
                                  long long *first)
{
    pg_status status = PG_OK;
    vertex *border = NULL, *all = NULL;
    size_t nborder = 0, nall = 0;
    int rank, low[3], high[3];
    long long mine = 0;
    MPI_Comm_rank (MPI_COMM_WORLD, &rank);
    for (int k = 0; k < 3; k++) low[k] = 1 << 30, high[k] = -1;
    for (size_t i = 0; i < g->n; i++)
        for (int k = 0; k < g->dim; k++) {
            int at = g->at[3 * i + (size_t) k];
            low[k] = at < low[k] ? at : low[k], high[k] = at > high[k] ? at : high[k];
        }
    PG_ALLOC (border, n);
    for (size_t k = 0; k < n; k++)
        if (!first_grid || !is_inside (g, v[k].key, low, high)) border[nborder++] = v[k];
    PG_TRY (gather (border, nborder, &all, &nall));
    if (nall) qsort (all, nall, sizeof *all, by_key);
    for (size_t k = 0; k < n; k++) {
        const vertex *a = find (all, nall, v[k].key);
        while (a && a > all && a[-1].key == a->key) a--;
        if (a) v[k].owner = a->owner;                  /* the lowest of its owners comes first */
        mine += v[k].owner == rank;
    }
    *own = (size_t) mine, *first = 0;
    PG_TRY (lost (MPI_Exscan (&mine, first, 1, MPI_LONG_LONG, MPI_SUM, MPI_COMM_WORLD)));
    if (rank == 0) *first = 0;
    mine = *first, nborder = 0;
    for (size_t k = 0; k < n; k++) {
        if (v[k].owner != rank) continue;
        v[k].number = mine++;
        if (find (all, nall, v[k].key)) border[nborder++] = v[k];
    }
    pg_free (all), all = NULL;
    PG_TRY (gather (border, nborder, &all, &nall));
    if (nall) qsort (all, nall, sizeof *all, by_key);
    for (size_t k = 0; k < n; k++)
        if (v[k].owner != rank) {
            const vertex *a = find (all, nall, v[k].key);
            if (!a) PG_FAIL (PG_E_FILE, "ranks disagree about their coarse grids");
            v[k].number = a->number;
        }
done:
    pg_free (border), pg_free (all);
    return status;
}

/* P: from values at the vertices to those at the nodes. */
static pg_status make_interpolation (const grid *g, size_t block, const vertex *v, size_t n, size_t own,
                                     Mat *P)
{
    pg_status status = PG_OK;
    long long key[8];
    double weight[8];
    PetscInt rows = (PetscInt) (g->n * block), columns = (PetscInt) (own * block);
    PG_TRY (petsc_said (MatCreateAIJ (PETSC_COMM_WORLD, rows, columns, PETSC_DETERMINE, PETSC_DETERMINE,
                                      1 << g->dim, NULL, 1 << g->dim, NULL, P), "coarse grids"));
    PG_TRY (petsc_said (MatSetBlockSizes (*P, (PetscInt) block, (PetscInt) block), "coarse grids"));
    for (size_t i = 0; i < g->n; i++) {
        int m = corners_of (g, g->at + 3 * i, key, weight);
        for (int c = 0; c < m; c++) {
            const vertex *a = find (v, n, key[c]);
            for (size_t k = 0; k < block; k++) {
                PetscInt row = (PetscInt) ((g->number + (long long) i) * (long long) block + (long long) k),
                         column = (PetscInt) (a->number * (long long) block + (long long) k);
                PG_TRY (petsc_said (MatSetValue (*P, row, column, weight[c], INSERT_VALUES), "coarse grids"));
            }
        }
    }
    PG_TRY (petsc_said (MatAssemblyBegin (*P, MAT_FINAL_ASSEMBLY), "coarse grids"));
    PG_TRY (petsc_said (MatAssemblyEnd (*P, MAT_FINAL_ASSEMBLY), "coarse grids"));
done:
    return status;
}

/* The next grid, with the vertices that are owned here as its nodes. */
static pg_status next_grid (grid *g, size_t block, int first_grid, Mat *P)
{
    pg_status status = PG_OK;
    vertex *v = NULL;
    size_t n = 0, own = 0, at = 0;
    long long first;
    int rank;
    MPI_Comm_rank (MPI_COMM_WORLD, &rank);
    PG_TRY (list_vertices (g, rank, &v, &n));
    PG_TRY (number_vertices (g, first_grid, v, n, &own, &first));
    PG_TRY (make_interpolation (g, block, v, n, own, P));
    pg_free (g->at), g->at = NULL;
    PG_ALLOC (g->at, 3 * own);
    for (int k = 0; k < g->dim; k++) g->end[k] = (g->end[k] + 1) / 2;
    for (size_t k = 0; k < n; k++) {
        if (v[k].owner != rank) continue;
        long long key = v[k].key;
        for (int a = 0; a < g->dim; a++) g->at[3 * at + (size_t) a] = (int) (key % (g->end[a] + 1)),
                                         key /= g->end[a] + 1;
        at++;
    }
    g->n = own, g->number = first;
done:
    pg_free (v);
    return status;
}

/* Owned nodes at whole steps of the lattice, from the lowest of all ranks on. */
static pg_status first_grid_of (grid *g, const pg_shared_rows *s, size_t n, const int *node, long long number)
{
    pg_status status = PG_OK;
    double low[3] = { INFINITY, INFINITY, INFINITY };
    size_t dim = (size_t) s->dim;
    g->n = n, g->dim = s->dim, g->number = number;
    for (size_t i = 0; i < n; i++)
        for (size_t k = 0; k < dim; k++) low[k] = fmin (low[k], s->x[(size_t) node[i] * dim + k]);
    PG_TRY (lost (MPI_Allreduce (MPI_IN_PLACE, low, 3, MPI_DOUBLE, MPI_MIN, MPI_COMM_WORLD)));
    PG_ALLOC (g->at, 3 * n);
    for (size_t i = 0; i < n; i++)
        for (size_t k = 0; k < dim; k++) {
            int at = (int) round ((s->x[(size_t) node[i] * dim + k] - low[k]) / s->rows.lattice[k]);
            g->at[3 * i + k] = at, g->end[k] = at > g->end[k] ? at : g->end[k];
        }
    PG_TRY (lost (MPI_Allreduce (MPI_IN_PLACE, g->end, 3, MPI_INT, MPI_MAX, MPI_COMM_WORLD)));
done:
    return status;
}

pg_status petsc_grids (const pg_shared_rows *s, size_t n, const int *node, long long number, size_t enough,
                       int most, Mat *P, int *count)
{
    pg_status status = PG_OK;
    grid g = { 0 };
    size_t block = (size_t) s->block;
    *count = 0;
    PG_TRY (first_grid_of (&g, s, n, node, number));
    for (int first = 1; *count < most; first = 0) {
        long long all = (long long) (g.n * block);
        PG_TRY (lost (MPI_Allreduce (MPI_IN_PLACE, &all, 1, MPI_LONG_LONG, MPI_SUM, MPI_COMM_WORLD)));
        if (all <= (long long) enough) break;
        PG_TRY (next_grid (&g, block, first, &P[*count]));
        ++*count;
    }
done:
    pg_free (g.at);
    return status;
}

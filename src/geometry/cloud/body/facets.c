/* SPDX-License-Identifier: GPL-3.0-or-later
 * The surface of a mesh or an alpha shape as flat pieces, and plane regions of these.
 *
 * Faces whose edges and sides are straight are one segment, one triangle or two; a face with four corners
 * that do not lie in a plane, four triangles about its middle. Curved faces are divided along a grid, whose
 * steps are no longer than 3/4 of a cell; faces that share a curved edge divide it alike, so that the pieces
 * close. Corners that lie within 1e-9 of a step of a plane of the lattice are moved onto it: a cell behind
 * that plane would hold rounding only. */
#include "shape.h"
#include "solid.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Largest number of pieces along an edge of a curved face. */
enum { MOST = 16 };
/* The pieces under construction. */
typedef struct {
    pg_facets *f;
    const pg_mesh *mesh;
    /* Faces of the surface. */
    size_t nface;  int *element, *side;
    /* For each piece: id: numbers of its corners (n x dim); face: its face; beside: its neighbour at the edge
     * from corner k to the next (2D: at corner k), -1: none (n x dim). */
    long  *id;  int *face, *beside;
    size_t room_x, room_id, room_face;
    /* The next number for a corner that is no node. */
    long   next;
    /* Corners at most this far off a plane count as lying in it, m. */
    double tolerance;
    /* For each face: its side sets, as one number (find_sets). */
    unsigned long long *sets;
} builder;

void facets_clear (pg_facets *f)
{
    pg_free (f->x), pg_free (f->region), pg_free (f->plane), pg_free (f->axis), pg_free (f->element),
        pg_free (f->side), pg_free (f->first), pg_free (f->piece), pg_free (f->edge_first),
        pg_free (f->edge);
    for (int k = 0; k < 3; k++) pg_free (f->column_first[k]), pg_free (f->column[k]);
    memset (f, 0, sizeof *f);
}

/* ---- adding pieces ------------------------------------------------------------------------------------- */
/* Normal of a piece times its size (2D: length, 3D: twice the area). */
static double normal_of (int dim, const double *x, double *n)
{
    double size = 0;
    if (dim == 2) n[0] = x[3] - x[1], n[1] = x[0] - x[2];
    else
        for (int k = 0; k < 3; k++) {
            int p = (k + 1) % 3, q = (k + 2) % 3;
            n[k] = (x[3 + p] - x[p]) * (x[6 + q] - x[q]) - (x[3 + q] - x[q]) * (x[6 + p] - x[p]);
        }
    for (int k = 0; k < dim; k++) size += n[k] * n[k];
    return sqrt (size);
}

/* Moves a coordinate onto a plane of the lattice if it lies within the tolerance of it. */
static double snapped (const pg_lattice *l, int k, double x)
{
    double i = floor ((x - l->origin[k]) / l->step[k] + 0.5), plane = pg_lattice_at (l, k, i);
    return i >= 0 && i <= l->count[k] && fabs (x - plane) <= pg_lattice_tolerance (l) ? plane : x;
}

/* Appends a piece with these corners (dim each; id: their numbers), unless it has no size. */
static pg_status add_piece (builder *b, size_t face, const long *id, const double *const *corner)
{
    pg_status status = PG_OK;
    pg_facets *f = b->f;
    size_t dim = (size_t) f->dim, at = f->n * dim;
    double x[9] = { 0 }, n[3] = { 0 }, longest = 0;
    for (size_t c = 0; c < dim; c++)
        for (size_t k = 0; k < dim; k++) x[c * dim + k] = snapped (&f->lattice, (int) k, corner[c][k]);
    for (size_t i = 0; i < dim * dim; i++) longest = fmax (longest, fabs (x[i] - x[i % dim]));
    if (!(normal_of (f->dim, x, n) > 1e-12 * longest * (dim > 2 ? longest : 0))) return PG_OK;
    PG_GROW (f->x, b->room_x, (at + dim) * dim);
    PG_GROW (b->id, b->room_id, at + dim);
    PG_GROW (b->face, b->room_face, f->n + 1);
    memcpy (f->x + at * dim, x, dim * dim * sizeof *x);
    memcpy (b->id + at, id, dim * sizeof *id);
    b->face[f->n++] = (int) face;
done:
    return status;
}

/* ---- pieces of faces ----------------------------------------------------------------------------------- */
/* Are the edges and the inside of a face of second order straight, middle nodes in the middle to 1e-9? */
static int is_straight (pg_element kind, int dim, const double *x)
{
    const pg_element_type *t = &pg_element_types[kind];
    double size = 0, off = 0;
    for (int c = 1; c < t->corners; c++)
        for (int k = 0; k < dim; k++) size = fmax (size, fabs (x[c * dim + k] - x[k]));
    for (int m = t->corners; m < t->nodes; m++) {
        int end[2] = { m - t->corners, (m - t->corners + 1) % t->corners }, edge = m - t->corners < t->edges;
        if (t->dim == 1) end[0] = 0, end[1] = 1, edge = 1;
        for (int k = 0; k < dim; k++) {
            double middle = 0;
            for (int c = 0; c < t->corners && !edge; c++) middle += x[c * dim + k] / t->corners;
            if (edge) middle = 0.5 * (x[end[0] * dim + k] + x[end[1] * dim + k]);
            off = fmax (off, fabs (x[m * dim + k] - middle));
        }
    }
    return off <= 1e-9 * size;
}

/* Do the four corners of a straight face lie in a plane? */
static int is_flat (const double *x)
{
    double n[3], m[3], size = normal_of (3, x, n), off = 0, wide = 0;
    for (int k = 0; k < 3; k++) off += n[k] / size * (x[9 + k] - x[k]);
    for (int c = 1; c < 4; c++)
        for (int k = 0; k < 3; k++) wide = fmax (wide, fabs (x[3 * c + k] - x[k]));
    /* A corner that points inwards beyond the diagonal turns the second triangle (0, 2, 3) over. */
    const double other[9] = { x[0], x[1], x[2], x[6], x[7], x[8], x[9], x[10], x[11] };
    normal_of (3, other, m);
    return fabs (off) <= 1e-12 * wide && n[0] * m[0] + n[1] * m[1] + n[2] * m[2] > 0;
}

/* Adds a straight face: as it is, divided along a diagonal, or in four about its middle. */
static pg_status add_straight (builder *b, size_t face, pg_element kind, const long *node, const double *x)
{
    pg_status status = PG_OK;
    int corners = pg_element_types[kind].corners, dim = b->f->dim;
    double middle[3] = { 0, 0, 0 };
    if (corners < 4) {
        const double *corner[3] = { x, x + dim, x + (dim > 2 ? 6 : 0) };
        return add_piece (b, face, node, corner);
    }
    for (int k = 0; k < 3; k++) middle[k] = 0.25 * (x[k] + x[3 + k] + x[6 + k] + x[9 + k]);
    if (is_flat (x)) {
        PG_TRY (add_piece (b, face, node, (const double *[]){ x, x + 3, x + 6 }));
        PG_TRY (add_piece (b, face, (long[]){ node[0], node[2], node[3] },
                           (const double *[]){ x, x + 6, x + 9 }));
        return PG_OK;
    }
    for (int c = 0; c < 4; c++) {
        int d = (c + 1) % 4;
        PG_TRY (add_piece (b, face, (long[]){ node[c], node[d], b->next },
                           (const double *[]){ x + 3 * c, x + 3 * d, middle }));
    }
    b->next++;
done:
    return status;
}

/* A curved face with its grid. */
typedef struct {
    builder *b;  size_t face;
    pg_element kind;
    const double *x;  const long *node;
    /* Steps of the grid. */
    int steps;
} curved;

/* Number and position (m) of grid point i, j; half 1: of the middle of the square that begins there. */
static void grid_point (const curved *g, int i, int j, int half, long *id, double *place)
{
    int m = g->steps, triangle = pg_element_types[g->kind].corners == 3;
    double xi[2] = { (i + 0.5 * half) / m, (j + 0.5 * half) / m };
    *id = g->b->next + ((long) j * (m + 1) + i) * 2 + half;
    if (!half && (i == 0 || i == m) && (j == 0 || j == m || pg_element_types[g->kind].dim == 1)) {
        int corner = pg_element_types[g->kind].dim == 1 ? i == m
                     : triangle                         ? (i == m ? 1 : j == m ? 2 : 0)
                                                        : (j == 0 ? i == m : i == m ? 2 : 3);
        if (!(triangle && i == m && j == m)) *id = g->node[corner];
    }
    if (!triangle) xi[0] = 2 * xi[0] - 1, xi[1] = 2 * xi[1] - 1;
    pg_element_map (g->kind, g->b->f->dim, g->x, xi, place, NULL);
}

/* Adds the piece whose corners are three grid points (2D: two). at: i, j, half of each. */
static pg_status add_grid_piece (const curved *g, int at[3][3])
{
    long id[3];
    double place[3][3];
    for (int c = 0; c < g->b->f->dim; c++) grid_point (g, at[c][0], at[c][1], at[c][2], &id[c], place[c]);
    return add_piece (g->b, g->face, id, (const double *[]){ place[0], place[1], place[2] });
}

/* Adds the pieces of one step of the grid: a segment; one or two triangles of a triangle; four about the
 * middle of a square. */
static pg_status add_step (const curved *g, int i, int j)
{
    pg_status status = PG_OK;
    int m = g->steps, corners = pg_element_types[g->kind].corners;
    if (corners == 2) return add_grid_piece (g, (int[3][3]){ { i, 0, 0 }, { i + 1, 0, 0 }, { 0, 0, 0 } });
    if (corners == 3) {
        PG_TRY (add_grid_piece (g, (int[3][3]){ { i, j, 0 }, { i + 1, j, 0 }, { i, j + 1, 0 } }));
        if (i + j + 2 <= m)
            PG_TRY (add_grid_piece (g, (int[3][3]){ { i + 1, j, 0 }, { i + 1, j + 1, 0 }, { i, j + 1, 0 } }));
        return PG_OK;
    }
    const int around[5][2] = { { i, j }, { i + 1, j }, { i + 1, j + 1 }, { i, j + 1 }, { i, j } };
    for (int c = 0; c < 4; c++)
        PG_TRY (add_grid_piece (g, (int[3][3]){ { around[c][0], around[c][1], 0 },
                                                { around[c + 1][0], around[c + 1][1], 0 }, { i, j, 1 } }));
done:
    return status;
}

/* Adds a curved face, divided into `steps` steps along each edge. */
static pg_status add_curved (builder *b, size_t face, pg_element kind, const long *node, const double *x,
                             int steps)
{
    pg_status status = PG_OK;
    curved g = { b, face, kind, x, node, steps };
    int corners = pg_element_types[kind].corners;
    for (int j = 0; j < (corners > 2 ? steps : 1); j++)
        for (int i = 0; i < (corners == 3 ? steps - j : steps); i++) PG_TRY (add_step (&g, i, j));
    b->next += 2L * (steps + 1) * (steps + 1);
done:
    return status;
}

/* Number of steps along the edges of all curved faces: the longest edge of the mesh over 3/4 of the lattice
 * step. */
static int steps_of (const builder *b)
{
    double longest = 0, step = HUGE_VAL;
    const pg_mesh *m = b->mesh;
    int end[2];
    for (int k = 0; k < m->dim; k++) step = fmin (step, b->f->lattice.step[k]);
    for (size_t e = 0; e < m->n; e++)
        for (int k = 0; k < pg_element_types[m->kind[e]].edges; k++) {
            double size = 0;
            pg_element_edge ((pg_element) m->kind[e], k, end);
            const int *node = m->node + m->start[e];
            for (int a = 0; a < m->dim; a++)
                size = hypot (size, m->x[3 * node[end[0]] + a] - m->x[3 * node[end[1]] + a]);
            longest = fmax (longest, size);
        }
    return (int) fmin (MOST, fmax (1, ceil (longest / (0.75 * step))));
}

/* Adds the pieces of all faces. */
static pg_status add_faces (builder *b)
{
    pg_status status = PG_OK;
    const pg_mesh *m = b->mesh;
    size_t dim = (size_t) m->dim;
    int steps = steps_of (b);
    for (size_t i = 0; i < b->nface; i++) {
        int local[9];
        long node[9];
        double x[27];
        size_t e = (size_t) b->element[i];
        pg_element kind = pg_element_face ((pg_element) m->kind[e], b->side[i], local);
        for (int k = 0; k < pg_element_types[kind].nodes; k++) {
            node[k] = m->node[m->start[e] + (size_t) local[k]];
            memcpy (x + (size_t) k * dim, m->x + 3 * node[k], dim * sizeof *x);
        }
        if (is_straight (kind, m->dim, x)) PG_TRY (add_straight (b, i, kind, node, x));
        else PG_TRY (add_curved (b, i, kind, node, x, steps));
    }
done:
    return status;
}

/* ---- plane regions ------------------------------------------------------------------------------------- */
/* An edge of a piece: the numbers of its two ends (2D: one end), smaller first; piece and corner. */
typedef struct { long a, b;  int piece, at; } edge;

static int compare_edges (const void *x, const void *y)
{
    const edge *e = x, *f = y;
    if (e->a != f->a) return e->a < f->a ? -1 : 1;
    if (e->b != f->b) return e->b < f->b ? -1 : 1;
    return (e->piece > f->piece) - (e->piece < f->piece);
}

/* Finds the neighbours: edges that exactly two pieces have. */
static pg_status find_neighbours (builder *b)
{
    pg_status status = PG_OK;
    size_t dim = (size_t) b->f->dim, n = b->f->n * dim;
    edge *all = NULL;
    PG_ALLOC (all, n);
    PG_ALLOC (b->beside, n);
    for (size_t i = 0; i < n; i++) {
        size_t piece = i / dim, at = i % dim;
        long p = b->id[i], q = dim > 2 ? b->id[piece * dim + (at + 1) % dim] : p;
        all[i] = (edge){ p < q ? p : q, p < q ? q : p, (int) piece, (int) at };
        b->beside[i] = -1;
    }
    pg_sort (all, n, sizeof *all, compare_edges);
    for (size_t i = 0, end = 0; i < n; i = end) {
        for (end = i; end < n && all[end].a == all[i].a && all[end].b == all[i].b; end++) continue;
        if (end - i != 2) continue;
        b->beside[(size_t) all[i].piece * dim + (size_t) all[i].at] = all[i + 1].piece;
        b->beside[(size_t) all[i + 1].piece * dim + (size_t) all[i + 1].at] = all[i].piece;
    }
done:
    pg_free (all);
    return status;
}

/* Gives each face a number that differs between different combinations of side sets: the sum of one hashed
 * number for each set. */
static pg_status find_sets (builder *b)
{
    pg_status status = PG_OK;
    PG_ALLOC (b->sets, b->nface);
    for (size_t s = 0; s < b->mesh->nsides; s++) {
        const pg_mesh_sides *set = &b->mesh->sides[s];
        unsigned long long mixed = (s + 1) * 0x9e3779b97f4a7c15ULL;
        mixed = (mixed ^ mixed >> 31) * 0xbf58476d1ce4e5b9ULL;
        for (size_t i = 0; i < set->n; i++) {
            /* Faces are ordered by element and side. */
            size_t low = 0, high = b->nface;
            while (low < high) {
                size_t k = (low + high) / 2;
                int before = b->element[k] < set->element[i]
                             || (b->element[k] == set->element[i] && b->side[k] < set->side[i]);
                if (before) low = k + 1;
                else high = k;
            }
            if (low < b->nface && b->element[low] == set->element[i] && b->side[low] == set->side[i])
                b->sets[low] += mixed;
        }
    }
done:
    return status;
}

/* Does piece j lie in the plane (point, unit normal: 2 dim numbers), with its normal on the same side? */
static int in_plane (const builder *b, size_t j, const double *plane)
{
    int dim = b->f->dim;
    const double *x = b->f->x + j * (size_t) (dim * dim);
    double n[3], along = 0, size = normal_of (dim, x, n);
    for (int k = 0; k < dim; k++) along += n[k] / size * plane[dim + k];
    if (!(along > 0.9)) return 0;
    for (int c = 0; c < dim; c++) {
        double off = 0;
        for (int k = 0; k < dim; k++) off += (x[c * dim + k] - plane[k]) * plane[dim + k];
        if (!(fabs (off) <= b->tolerance)) return 0;
    }
    return 1;
}

/* A piece from which a region grows; larger pieces come first, since their planes are the most accurate. */
typedef struct { double size;  int piece; } seed;

static int compare_seeds (const void *x, const void *y)
{
    const seed *s = x, *t = y;
    if (s->size != t->size) return s->size > t->size ? -1 : 1;
    return (s->piece > t->piece) - (s->piece < t->piece);
}

/* Gives a new region's number to the pieces that are connected to piece `from` within its plane. */
static void grow (builder *b, int from, int *stack)
{
    pg_facets *f = b->f;
    size_t dim = (size_t) f->dim, r = f->nregion++, height = 0;
    double *plane = f->plane + 2 * dim * r, size;
    memcpy (plane, f->x + (size_t) from * dim * dim, dim * sizeof *plane);
    size = normal_of (f->dim, f->x + (size_t) from * dim * dim, plane + dim);
    for (size_t k = 0; k < dim; k++) plane[dim + k] /= size;
    f->element[r] = b->element[b->face[from]], f->side[r] = b->side[b->face[from]];
    stack[height++] = from, f->region[from] = (int) r;
    while (height > 0) {
        size_t i = (size_t) stack[--height];
        for (size_t e = 0; e < dim; e++) {
            int j = b->beside[i * dim + e];
            if (j < 0 || f->region[j] >= 0 || b->sets[b->face[j]] != b->sets[b->face[from]]) continue;
            if (in_plane (b, (size_t) j, plane)) stack[height++] = j, f->region[j] = (int) r;
        }
    }
}

/* Finds the axis that the plane of each region is normal to, to rounding; the normal is then made exact. */
static void find_axes (builder *b)
{
    pg_facets *f = b->f;
    size_t dim = (size_t) f->dim;
    for (size_t r = 0; r < f->nregion; r++) {
        double *plane = f->plane + 2 * dim * r;
        f->axis[r] = -1;
        for (size_t k = 0; k < dim; k++) {
            int flat = 1;
            for (size_t i = f->first[r]; i < f->first[r + 1] && flat; i++)
                for (size_t c = 0; c < dim; c++)
                    flat &= fabs (f->x[((size_t) f->piece[i] * dim + c) * dim + k] - plane[k])
                            <= 0.1 * b->tolerance;
            if (!flat) continue;
            f->axis[r] = (int) k;
            for (size_t a = 0; a < dim; a++) plane[dim + a] = a == k ? copysign (1, plane[dim + k]) : 0;
        }
    }
}

/* Finds the edges of each region: those of its pieces with no neighbour in it. */
static pg_status find_edges (builder *b)
{
    pg_status status = PG_OK;
    pg_facets *f = b->f;
    size_t dim = (size_t) f->dim, size = (dim - 1) * dim, room = 0;
    for (size_t r = 0; r < f->nregion; r++) {
        size_t n = f->edge_first[r];
        for (size_t i = f->first[r]; i < f->first[r + 1]; i++)
            for (size_t e = 0; e < dim; e++) {
                size_t at = (size_t) f->piece[i] * dim;
                int j = b->beside[at + e];
                if (j >= 0 && f->region[j] == (int) r) continue;
                PG_GROW (f->edge, room, (n + 1) * size);
                for (size_t c = 0; c < dim - 1; c++)
                    memcpy (f->edge + n * size + c * dim, f->x + (at + (e + c) % dim) * dim,
                            dim * sizeof *f->x);
                n++;
            }
        f->edge_first[r + 1] = n;
    }
done:
    return status;
}

/* Grows regions from all pieces, then lists pieces, axes and edges of each. */
static pg_status find_regions (builder *b)
{
    pg_status status = PG_OK;
    pg_facets *f = b->f;
    size_t dim = (size_t) f->dim;
    seed *order = NULL;
    int *stack = NULL;
    double n[3];
    PG_ALLOC (order, f->n);
    PG_ALLOC (stack, f->n);
    PG_ALLOC (f->region, f->n);
    PG_ALLOC (f->plane, 2 * dim * f->n);
    PG_ALLOC (f->axis, f->n);
    PG_ALLOC (f->element, f->n);
    PG_ALLOC (f->side, f->n);
    PG_ALLOC (f->piece, f->n);
    for (size_t i = 0; i < f->n; i++)
        order[i] = (seed){ normal_of (f->dim, f->x + i * dim * dim, n), (int) i }, f->region[i] = -1;
    pg_sort (order, f->n, sizeof *order, compare_seeds);
    for (size_t i = 0; i < f->n; i++) if (f->region[order[i].piece] < 0) grow (b, order[i].piece, stack);
    PG_ALLOC (f->first, f->nregion + 1);
    PG_ALLOC (f->edge_first, f->nregion + 1);
    for (size_t i = 0; i < f->n; i++) f->first[f->region[i] + 1]++;
    for (size_t r = 0; r < f->nregion; r++) f->first[r + 1] += f->first[r];
    for (size_t i = f->n; i-- > 0;) f->piece[--f->first[f->region[i] + 1]] = (int) i;
    for (size_t r = 0; r < f->nregion; r++) f->first[r] = f->first[r + 1];
    f->first[f->nregion] = f->n;
    find_axes (b);
    PG_TRY (find_edges (b));
done:
    pg_free (order), pg_free (stack);
    return status;
}

/* ---- creation ------------------------------------------------------------------------------------------ */
/* The tolerance of planes: 1e-11 of the size of the mesh, and the rounding of its coordinates. */
static double tolerance_of (const pg_lattice *l)
{
    double size = 0;
    for (int k = 0; k < l->dim; k++) size = fmax (size, l->high[k] - l->origin[k]);
    return 1e-11 * size + 4 * pg_rounding (l->dim, l->origin, l->high);
}

pg_status pg_faceted_create (pg_shape *out, const pg_shape *mesh, const pg_lattice *lattice)
{
    pg_status status = PG_OK;
    builder b = { .mesh = mesh->kind == PG_MESH ? &mesh->solid->part.mesh : &mesh->solid->cloud.mesh };
    *out = *mesh;
    out->kind = PG_FACETED, out->solid = NULL;
    PG_ALLOC (out->solid, 1);
    b.f = &out->solid->facets;
    b.f->dim = b.mesh->dim, b.f->lattice = *lattice, b.f->lattice.in = NULL;
    b.next = (long) b.mesh->nnode, b.tolerance = tolerance_of (lattice);
    PG_TRY (pg_mesh_surface (b.mesh, &b.nface, &b.element, &b.side));
    PG_TRY (add_faces (&b));
    PG_TRY (find_neighbours (&b));
    PG_TRY (find_sets (&b));
    PG_TRY (find_regions (&b));
    PG_TRY (facets_columns (b.f));
done:
    pg_free (b.element), pg_free (b.side), pg_free (b.id), pg_free (b.face), pg_free (b.beside),
        pg_free (b.sets);
    if (status != PG_OK) pg_stairs_clear (out);
    return status;
}

int pg_shape_stepped (const pg_shape *s) { return s->kind == PG_ALPHA_SHAPE && s->solid->cloud.rim > 0; }

const pg_facets *pg_shape_facets (const pg_shape *s)
{
    return s->kind == PG_FACETED ? &s->solid->facets : NULL;
}

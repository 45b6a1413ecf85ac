/* SPDX-License-Identifier: GPL-3.0-or-later
 * Where a line segment leaves a mesh and comes back: its intersections with the faces of the surface, flat
 * pieces in a tree of boxes, with the sense of their normals. Two faces at one position, as between
 * coincident nodes, make a gap of zero width.
 *
 * Pieces are put in an order in which neighbours lie near each other, GROUP at a time in a block, as
 * many blocks in a larger one, and so on up to one block that holds all (as in crack_index.c). */
#include "between.h"
#include "geometry/cloud/search/tree.h"
#include <math.h>
#include <string.h>

enum { GROUP = 8, LEVELS = 22, EVENTS = 64, DIRECTIONS = 64 };

struct between_faces {
    int    dim, levels;
    size_t n, room[2];
    /* Corners (n x dim x dim, m); unit normal out of the mesh, and n.x of the plane (n x 4). */
    double *x, *plane;
    /* Boxes of the blocks (2 dim each), from start[l] on those of level l, of which level 0 holds the pieces
     * one by one. */
    double *box;
    size_t start[LEVELS + 1];
};

/* ---- adding pieces ------------------------------------------------------------------------------------- */
static pg_status add_piece (between_faces *f, const double *const *corner)
{
    pg_status status = PG_OK;
    size_t dim = (size_t) f->dim, at = f->n * dim * dim;
    double n[3] = { 0 }, size = 0;
    if (dim == 1) n[0] = corner[0][0] - corner[1][0];  /* away from the other end of the bar */
    else if (dim == 2) n[0] = corner[1][1] - corner[0][1], n[1] = corner[0][0] - corner[1][0];
    else
        for (int k = 0; k < 3; k++) {
            int p = (k + 1) % 3, q = (k + 2) % 3;
            n[k] = (corner[1][p] - corner[0][p]) * (corner[2][q] - corner[0][q])
                   - (corner[1][q] - corner[0][q]) * (corner[2][p] - corner[0][p]);
        }
    for (int k = 0; k < 3; k++) size += n[k] * n[k];
    if (!(size > 0)) return PG_OK;
    PG_GROW (f->x, f->room[0], at + dim * dim);
    PG_GROW (f->plane, f->room[1], 4 * (f->n + 1));
    double *plane = f->plane + 4 * f->n;
    for (size_t c = 0; c < dim; c++) memcpy (f->x + at + c * dim, corner[c], dim * sizeof *f->x);
    plane[3] = 0;
    for (int k = 0; k < 3; k++) plane[k] = n[k] / sqrt (size);
    for (size_t k = 0; k < dim; k++) plane[3] += plane[k] * corner[0][k];
    f->n++;
done:
    return status;
}

/* Adds a face as flat pieces between its corners and, for second order, the middles of its edges and its own
 * middle. */
static pg_status add_face (between_faces *f, pg_element kind, const double *x)
{
    pg_status status = PG_OK;
    const pg_element_type *t = &pg_element_types[kind];
    size_t dim = (size_t) f->dim;
    double middle[3] = { 0 };
    const double *ring[8];
    int n = 0, corners = t->corners, halved = t->order == 2;
    if (t->dim == 1) {
        const double *half = x + 2 * dim;
        if (!halved) return add_piece (f, (const double *[]) { x, x + dim });
        PG_TRY (add_piece (f, (const double *[]) { x, half }));
        return add_piece (f, (const double *[]) { half, x + dim });
    }
    for (int c = 0; c < corners; c++) {
        ring[n++] = x + (size_t) c * dim;
        if (halved) ring[n++] = x + (size_t) (corners + c) * dim;
    }
    if (n == 3) return add_piece (f, ring);
    if (corners == 3) {
        for (int c = 0; c < 3; c++)
            PG_TRY (add_piece (f, (const double *[]) { ring[2*c], ring[2*c + 1], ring[(2*c + 5) % 6] }));
        return add_piece (f, (const double *[]) { ring[1], ring[3], ring[5] });
    }
    for (int k = 0; k < 3; k++) {
        if (t->nodes == 9) middle[k] = x[8 * dim + (size_t) k];
        else if (halved)                               /* values of the eight shape functions at the middle */
            for (int c = 0; c < 8; c++) middle[k] += (c % 2 ? 0.5 : -0.25) * ring[c][k];
        else for (int c = 0; c < 4; c++) middle[k] += 0.25 * ring[c][k];
    }
    for (int c = 0; c < n; c++)
        PG_TRY (add_piece (f, (const double *[]) { ring[c], ring[(c + 1) % n], middle }));
done:
    return status;
}

/* ---- dropping faces that have the surface behind them -------------------------------------------------- */
/* For each face normal met so far: the largest n.x over the nodes of the surface, m. */
typedef struct { int n; double normal[DIRECTIONS][3], reach[DIRECTIONS]; } directions;

/* The largest n.x over the nodes of the surface along a normal, m; INFINITY: there are too many
 * directions. */
static double reach_along (directions *d, int dim, const double *normal, const pg_mesh *mesh,
                           const unsigned char *on)
{
    for (int i = 0; i < d->n; i++) {
        double off = 0;
        for (int k = 0; k < dim; k++) off = fmax (off, fabs (normal[k] - d->normal[i][k]));
        if (off <= 1e-12) return d->reach[i];
    }
    if (d->n == DIRECTIONS) return INFINITY;
    double most = -INFINITY;
    for (size_t i = 0; i < mesh->nnode; i++) {
        double at = 0;
        for (int k = 0; k < dim; k++) at += normal[k] * mesh->x[3*i + (size_t) k];
        if (on[i]) most = fmax (most, at);
    }
    memcpy (d->normal[d->n], normal, sizeof *d->normal);
    return d->reach[d->n++] = most;
}

/* Drops the pieces whose plane has the whole surface behind it. */
static void drop_outer (between_faces *f, const pg_mesh *mesh, const unsigned char *on)
{
    directions d = { 0 };
    size_t dim = (size_t) f->dim, kept = 0;
    double size = 0;
    for (size_t i = 0; i < f->n * dim * dim; i++) size = fmax (size, fabs (f->x[i]));
    for (size_t i = 0; i < f->n; i++) {
        const double *plane = f->plane + 4*i;
        if (reach_along (&d, f->dim, plane, mesh, on) <= plane[3] + 1e-9 * size) continue;
        memmove (f->x + kept * dim * dim, f->x + i * dim * dim, dim * dim * sizeof *f->x);
        memmove (f->plane + 4 * kept++, plane, 4 * sizeof *plane);
    }
    f->n = kept;
}

/* ---- the tree of boxes --------------------------------------------------------------------------------- */
static pg_status sort_pieces (between_faces *f)
{
    pg_status status = PG_OK;
    size_t dim = (size_t) f->dim, n = f->n, blocks = 0;
    pg_tree tree = { 0 };
    double *centre = NULL, *x = NULL, *plane = NULL;
    PG_ALLOC (centre, n * dim);
    PG_ALLOC (x, n * dim * dim);
    PG_ALLOC (plane, 4 * n);
    for (size_t i = 0; i < n * dim * dim; i++)
        centre[i / (dim * dim) * dim + i % dim] += f->x[i] / (double) dim;
    PG_TRY (pg_tree_build (&tree, f->dim, n, centre));
    for (size_t i = 0; i < n; i++) {
        memcpy (x + i * dim * dim, f->x + tree.item[i] * dim * dim, dim * dim * sizeof *x);
        memcpy (plane + 4*i, f->plane + 4 * tree.item[i], 4 * sizeof *plane);
    }
    pg_free (f->x), pg_free (f->plane);
    f->x = x, f->plane = plane, x = plane = NULL;
    for (size_t m = n; ; m = (m + GROUP - 1) / GROUP) {
        f->start[f->levels++] = blocks, blocks += m;
        if (m == 1) break;
    }
    f->start[f->levels] = blocks;
    PG_ALLOC (f->box, 2 * dim * blocks);
    for (int l = 0; l < f->levels; l++)
        for (size_t b = 0; b < f->start[l + 1] - f->start[l]; b++) {
            double *box = f->box + 2 * dim * (f->start[l] + b);
            size_t below = l ? f->start[l] - f->start[l - 1] : 0, first = l ? b * GROUP : b * dim,
                   end = l ? first + GROUP : first + dim;
            for (size_t k = 0; k < dim; k++) box[k] = INFINITY, box[dim + k] = -INFINITY;
            for (size_t i = first; i < end && (!l || i < below); i++) {
                const double *low = l ? f->box + 2 * dim * (f->start[l - 1] + i) : f->x + i * dim,
                             *high = l ? low + dim : low;
                for (size_t k = 0; k < dim; k++)
                    box[k] = fmin (box[k], low[k]), box[dim + k] = fmax (box[dim + k], high[k]);
            }
        }
done:
    pg_tree_clear (&tree);
    pg_free (centre), pg_free (x), pg_free (plane);
    return status;
}

pg_status between_faces_create (between_faces **out, const pg_mesh *mesh, int alone)
{
    pg_status status = PG_OK;
    between_faces *f = NULL;
    size_t n = 0, dim = (size_t) mesh->dim;
    int *element = NULL, *side = NULL, local[9];
    unsigned char *on = NULL;
    *out = NULL;
    PG_ALLOC (f, 1);
    PG_ALLOC (on, mesh->nnode);
    f->dim = mesh->dim;
    PG_TRY (pg_mesh_surface (mesh, &n, &element, &side));
    for (size_t i = 0; i < n; i++) {
        double x[27];
        size_t e = (size_t) element[i];
        pg_element kind = pg_element_face ((pg_element) mesh->kind[e], side[i], local);
        for (int k = 0; k < pg_element_types[kind].nodes; k++) {
            int node = mesh->node[mesh->start[e] + (size_t) local[k]];
            memcpy (x + (size_t) k * dim, mesh->x + 3 * (size_t) node, dim * sizeof *x);
            on[node] = 1;
        }
        if (dim == 1) {
            const double *other = mesh->x + 3 * (size_t) mesh->node[mesh->start[e] + (size_t) (1 - local[0])];
            PG_TRY (add_piece (f, (const double *[]) { x, other }));
        } else PG_TRY (add_face (f, kind, x));
    }
    if (alone) drop_outer (f, mesh, on);
    if (f->n) {
        PG_TRY (sort_pieces (f));
        *out = f, f = NULL;
    }
done:
    between_faces_free (&f);
    pg_free (on), pg_free (element), pg_free (side);
    return status;
}

void between_faces_free (between_faces **faces)
{
    between_faces *f = *faces;
    if (!f) return;
    pg_free (f->x), pg_free (f->plane), pg_free (f->box);
    pg_free (f);
    *faces = NULL;
}

/* ---- queries ------------------------------------------------------------------------------------------- */
typedef int (*visit) (void *context, const between_faces *f, size_t piece);

/* Calls `one` with all pieces whose boxes meet the box, until it returns 1. */
static int search (const between_faces *f, int level, size_t block, const double *low, const double *high,
                   visit one, void *context)
{
    size_t dim = (size_t) f->dim;
    const double *box = f->box + 2 * dim * (f->start[level] + block);
    for (size_t k = 0; k < dim; k++) if (!(box[k] <= high[k] && low[k] <= box[dim + k])) return 0;
    if (level == 0) return one (context, f, block);
    size_t below = f->start[level] - f->start[level - 1], end = block * GROUP + GROUP;
    for (size_t b = block * GROUP; b < end && b < below; b++)
        if (search (f, level - 1, b, low, high, one, context)) return 1;
    return 0;
}

static int stop (void *context, const between_faces *f, size_t piece)
{
    (void) context, (void) f, (void) piece;
    return 1;
}

int between_faces_near (const between_faces *f, const double *low, const double *high)
{
    return search (f, f->levels - 1, 0, low, high, stop, NULL);
}

/* Does q, a point in the plane of a piece, lie in the piece, or within `near` of it (m)? In 1D pieces are
 * points. */
static int covers (const between_faces *f, size_t piece, const double *q, double near)
{
    size_t dim = (size_t) f->dim;
    const double *x = f->x + piece * dim * dim, *n = f->plane + 4 * piece;
    for (size_t c = 0; dim > 1 && c < dim; c++) {
        const double *a = x + c * dim, *b = x + (c + 1) % dim * dim;
        double in[3] = { 0 }, off = 0, size = 0;       /* direction in the plane, from the edge inwards */
        if (dim == 2) in[0] = b[0] - a[0], in[1] = b[1] - a[1];
        else
            for (int k = 0; k < 3; k++) {
                int p = (k + 1) % 3, r = (k + 2) % 3;
                in[k] = n[p] * (b[r] - a[r]) - n[r] * (b[p] - a[p]);
            }
        for (size_t k = 0; k < dim; k++) off += in[k] * (q[k] - a[k]), size += in[k] * in[k];
        if (off < -near * sqrt (size)) return 0;
    }
    return 1;
}

typedef struct { const double *x; double near; } touching;
static int touches (void *context, const between_faces *f, size_t piece)
{
    const touching *t = context;
    double off = -f->plane[4 * piece + 3];
    for (int k = 0; k < f->dim; k++) off += f->plane[4 * piece + (size_t) k] * t->x[k];
    return fabs (off) <= t->near && covers (f, piece, t->x, t->near);
}

int between_faces_touch (const between_faces *f, const double *x, double near)
{
    touching t = { x, near };
    double low[3], high[3];
    for (int k = 0; k < f->dim; k++) low[k] = x[k] - near, high[k] = x[k] + near;
    return search (f, f->levels - 1, 0, low, high, touches, &t);
}

/* An intersection of the segment with a piece, at t; rate: n.d, positive where the segment leaves the
 * body. */
typedef struct { double t, rate; const double *normal; } event;
typedef struct { const between_way *w; int n, full; event at[EVENTS]; } events;

static int meet (void *context, const between_faces *f, size_t piece)
{
    events *e = context;
    const between_way *w = e->w;
    const double *n = f->plane + 4 * piece;
    double off = -n[3], rate = 0, q[3] = { 0 };
    for (int k = 0; k < f->dim; k++) off += n[k] * w->x[k], rate += n[k] * w->d[k];
    if ((off > w->near && off + rate > w->near) || (off < -w->near && off + rate < -w->near)) return 0;
    if (fabs (rate) <= w->near) return 0;
    double t = -off / rate;
    for (int k = 0; k < f->dim; k++) q[k] = w->x[k] + t * w->d[k];
    if (!covers (f, piece, q, w->near)) return 0;
    if (e->n == EVENTS) {
        e->full = 1;
        return 1;
    }
    int at = e->n++;
    for (; at > 0 && e->at[at - 1].t > t; at--) e->at[at] = e->at[at - 1];
    e->at[at] = (event) { t, rate, n };
    return 0;
}

/* Returns which of the events first .. end - 1 leaves (sense 1) or enters (-1) at the steepest angle; -1:
 * none does. */
static int squarest (const events *e, int first, int end, int sense)
{
    int best = -1;
    for (int i = first; i < end; i++)
        if (sense * e->at[i].rate > (best < 0 ? 0 : sense * e->at[best].rate)) best = i;
    return best;
}

static void set_end (between_gap *g, int side, const event *e)
{
    g->t[side] = e->t;
    memcpy (g->normal[side], e->normal, sizeof g->normal[side]);
}

/* Events at one position count together: an edge belongs to two pieces. Where a segment in the body both
 * leaves and enters there, two faces touch. */
void between_faces_gaps (between_gaps *out, const between_faces *f, const between_way *w)
{
    events e = { .w = w };
    between_gap g = { .t = { -INFINITY, INFINITY } };
    double low[3], high[3], slack = 2 * w->near / w->length;
    int in = -1;
    out->n = 0;
    for (int k = 0; k < f->dim; k++) {
        low[k] = fmin (w->x[k], w->x[k] + w->d[k]) - w->near;
        high[k] = fmax (w->x[k], w->x[k] + w->d[k]) + w->near;
    }
    search (f, f->levels - 1, 0, low, high, meet, &e);
    out->full = e.full;
    for (int i = 0, end; i < e.n; i = end) {
        for (end = i + 1; end < e.n && e.at[end].t <= e.at[i].t + slack; end++) continue;
        int leaves = squarest (&e, i, end, 1), enters = squarest (&e, i, end, -1);
        if (in < 0) in = leaves >= 0;
        if (leaves >= 0 && enters >= 0) {
            if (!in) continue;
            between_gap none;
            set_end (&none, 0, &e.at[leaves]), set_end (&none, 1, &e.at[enters]);
            none.t[0] = none.t[1] = e.at[i].t;
            between_gaps_add (out, &none);
        } else if (leaves >= 0 && in) set_end (&g, 0, &e.at[leaves]), in = 0;
        else if (enters >= 0 && !in) {
            set_end (&g, 1, &e.at[enters]), in = 1;
            between_gaps_add (out, &g);
        }
    }
    if (in != 0) return;
    g.t[1] = INFINITY;
    memset (g.normal[1], 0, sizeof g.normal[1]);
    between_gaps_add (out, &g);
}

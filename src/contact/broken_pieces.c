/* SPDX-License-Identifier: GPL-3.0-or-later
 * Crack faces formed by bonds that broke one by one, in pieces (forces without shape functions). There is no
 * geometric crack: position, direction and area of the faces follow from the broken bonds alone.
 *
 * Area and normal. Of the bonds of a whole body with points of volume V as many with the vector xi cross an
 * area A of a plane with normal n as xi.n A / V, so that over all that cross it
 *
 *     sum phi xi = 1/(2 V^2) M A n,    M = sum over a family of V phi xi xi',
 *
 * whatever the lattice, the horizon and the direction: each broken bond adds 2 V_i V_j M^-1 phi xi to the
 * area vector A n of the faces it crossed (phi = 1 / |xi|), and 2 V_i V_j phi xi.n / n.M n to their area.
 * Where some of the bonds are intact the area is the fraction that is lost.
 *
 * Position and side. About each point the tensor of the directions of nearby broken bonds, sum xi xi' /
 * xi.xi, has the normal as its first principal axis (of bonds that cross a plane the part along its normal is
 * twice that across), and the mean of their middles lies on the faces. The sense of normals is propagated
 * from point to point along broken bonds; connected bonds form a path. The middle of a bond, projected on the
 * faces, is a point of them with the area of the bond, and points are gathered to pieces of about two
 * spacings (gather_dots.c). The normal of a piece is that of the area vector in a smooth window about it, so
 * that pieces along a straight staircase of broken bonds have equal normals.
 *
 * Bonds of points that have lost most of their bonds (rubble) are ignored. */
#include "pieces.h"
#include "perigal/vector.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Least fraction of intact bonds of points that are no rubble; cosine of the angle between normals of one
 * face; half width of the window for the normal of a piece, local spacings. */
static const double KEEPS = 0.2, ALIKE = 0.7, WINDOW = 6;

/* A broken bond: index in the list of all bonds; indices of its points in `place`; bond vector, m; its part
 * of the area vector, in the sense of xi, m^2. */
typedef struct { size_t bond, end[2]; double xi[3], part[3]; } broken;
/* A point with broken bonds. tensor: direction tensor of its bonds (in `about`: of nearby bonds, too); mean:
 * sum of weighted bond middles (3) and of weights; normal: unit, oriented by walk; moment: M of its
 * family. */
typedef struct { size_t node; double tensor[9], mean[4], normal[3], moment[9]; int seen; } place;
typedef struct {
    const pg_problem *p;
    const unsigned char *alive;
    const pg_family *family;
    size_t dim;
    unsigned char *bears;                              /* 1: the point keeps enough bonds */
    size_t *at;                                        /* 1 + index of each node in `place`; 0: not in it */
    broken *broken;  size_t n, cap;
    place *place, *about;  size_t nplace, cap_place;   /* about: smoothed over neighbours */
    size_t *start, *of;                                /* broken bonds of each place: of[start[i]] ... */
    size_t *order;                                     /* broken bond of each dot */
    dot *dot;  size_t ndot;
} faces;

/* ---- broken bonds -------------------------------------------------------------------------------------- */
static void find_rubble (faces *w)
{
    for (size_t i = 0; i < w->p->cloud.n; i++) {
        size_t from = w->family->start[i], all = w->family->start[i + 1] - from, live = all;
        const unsigned char *alive = w->alive + from;
        if (memchr (alive, 0, all))
            for (size_t e = 0; e < all; e++) live -= !alive[e];
        w->bears[i] = (double) live >= KEEPS * (double) all;
    }
}

static pg_status place_of (faces *w, size_t node, size_t *out)
{
    pg_status status = PG_OK;
    if (!w->at[node]) {
        PG_GROW (w->place, w->cap_place, w->nplace + 1);
        memset (&w->place[w->nplace], 0, sizeof *w->place);
        w->place[w->nplace].node = node, w->at[node] = ++w->nplace;
    }
    *out = w->at[node] - 1;
done:
    return status;
}

/* Lists broken bonds that no crack of the state cuts, between points that are no rubble; each pair once. */
static pg_status list_broken (faces *w, const pg_cracks *cracks)
{
    pg_status status = PG_OK;
    const double *x = w->p->cloud.x;
    for (size_t i = 0; i < w->p->cloud.n; i++) {
        size_t from = w->family->start[i], to = w->family->start[i + 1];
        if (!w->bears[i] || !memchr (w->alive + from, 0, to - from)) continue;
        for (size_t e = from; e < to; e++) {
            size_t j = (size_t) w->family->node[e];
            if (w->alive[e] || j <= i || !w->bears[j]
                || pg_cracks_cut (cracks, x + w->dim * i, x + w->dim * j, pg_cloud_same (&w->p->cloud)))
                continue;
            PG_GROW (w->broken, w->cap, w->n + 1);
            broken *b = &w->broken[w->n];
            memset (b, 0, sizeof *b);
            b->bond = e;
            for (size_t k = 0; k < w->dim; k++) b->xi[k] = x[w->dim * j + k] - x[w->dim * i + k];
            PG_TRY (place_of (w, i, &b->end[0]));
            PG_TRY (place_of (w, j, &b->end[1]));
            w->n++;
        }
    }
done:
    return status;
}

/* Lists the broken bonds of each place. */
static pg_status list_by_place (faces *w)
{
    pg_status status = PG_OK;
    PG_ALLOC (w->start, w->nplace + 2);
    PG_ALLOC (w->of, 2 * w->n);
    for (size_t b = 0; b < w->n; b++) for (int e = 0; e < 2; e++) w->start[w->broken[b].end[e] + 2]++;
    for (size_t i = 0; i < w->nplace; i++) w->start[i + 2] += w->start[i + 1];
    for (size_t b = 0; b < w->n; b++)
        for (int e = 0; e < 2; e++) w->of[w->start[w->broken[b].end[e] + 1]++] = b;
done:
    return status;
}

/* ---- positions of faces -------------------------------------------------------------------------------- */
static void add_square (size_t dim, double weight, const double *xi, double *out)
{
    for (size_t a = 0; a < dim; a++)
        for (size_t c = 0; c < dim; c++) out[a * dim + c] += weight * xi[a] * xi[c];
}

/* Computes the direction tensor and mean of the broken bonds of a point, and M of its whole family. */
static void measure_place (const faces *w, size_t i)
{
    place *l = &w->place[i];
    const double *x = w->p->cloud.x, *at = x + w->dim * l->node;
    for (size_t k = w->start[i]; k < w->start[i + 1]; k++) {
        const broken *b = &w->broken[w->of[k]];
        double r = pg_size (3, b->xi), sense = b->end[0] == i ? 0.5 : -0.5;
        add_square (w->dim, 1 / (r * r), b->xi, l->tensor);
        for (size_t c = 0; c < w->dim; c++) l->mean[c] += (at[c] + sense * b->xi[c]) / r;
        l->mean[3] += 1 / r;
    }
    for (size_t e = w->family->start[l->node]; e < w->family->start[l->node + 1]; e++) {
        size_t j = (size_t) w->family->node[e];
        double xi[3] = { 0 };
        if (j == l->node) continue;
        for (size_t c = 0; c < w->dim; c++) xi[c] = x[w->dim * j + c] - at[c];
        add_square (w->dim, w->p->cloud.volume[j] / pg_size (3, xi), xi, l->moment);
    }
}

/* Smooths tensor and mean of a point over its neighbours, with weights that decrease with distance; finds its
 * normal. */
static void smooth_place (const faces *w, size_t i)
{
    place *out = &w->about[i];
    const place *own = &w->place[i];
    const double *x = w->p->cloud.x, *at = x + w->dim * own->node;
    double reach = w->p->form.approx.horizon, lambda[3], V[9];
    *out = *own;
    for (size_t e = w->family->start[own->node]; e < w->family->start[own->node + 1]; e++) {
        size_t j = (size_t) w->family->node[e];
        double xi[3] = { 0 };
        if (j == own->node || !w->at[j]) continue;
        const place *l = &w->place[w->at[j] - 1];
        for (size_t c = 0; c < w->dim; c++) xi[c] = x[w->dim * j + c] - at[c];
        double weight = fmax (0, 1 - pg_size (3, xi) / reach);
        for (size_t k = 0; k < w->dim * w->dim; k++) out->tensor[k] += weight * l->tensor[k];
        for (int k = 0; k < 4; k++) out->mean[k] += weight * l->mean[k];
    }
    pg_dense_eigen ((int) w->dim, out->tensor, lambda, V);
    for (size_t k = 0; k < w->dim; k++) out->normal[k] = V[k * w->dim];
}

/* Mean of the moments M of both ends of a bond. */
static void mean_moment (const faces *w, const broken *b, double *M)
{
    const place *i = &w->place[b->end[0]], *j = &w->place[b->end[1]];
    for (size_t k = 0; k < w->dim * w->dim; k++) M[k] = 0.5 * (i->moment[k] + j->moment[k]);
}

/* Weight 2 V_i V_j phi of a broken bond. */
static double weight_of (const faces *w, const broken *b)
{
    const double *volume = w->p->cloud.volume;
    return 2 * volume[w->place[b->end[0]].node] * volume[w->place[b->end[1]].node] / pg_size (3, b->xi);
}

/* Area of faces with normal n that a broken bond crosses, m^2. */
static double area_of (const faces *w, const broken *b, const double *n)
{
    double M[9], stiff = 0;
    mean_moment (w, b, M);
    for (size_t k = 0; k < w->dim * w->dim; k++) stiff += M[k] * n[k / w->dim] * n[k % w->dim];
    return stiff > 0 ? weight_of (w, b) * fabs (pg_dot3 (b->xi, n)) / stiff : 0;
}

/* Computes the dot of a broken bond: area, position on the faces, and normal in the sense of that of its
 * first end. */
static void measure_bond (const faces *w, broken *b, dot *d)
{
    const place *i = &w->about[b->end[0]], *j = &w->about[b->end[1]];
    const double *x = w->p->cloud.x + w->dim * i->node;
    double A[9], M[9], lambda[3], V[9], off = 0, weight = i->mean[3] + j->mean[3];
    memset (d, 0, sizeof *d);
    for (size_t k = 0; k < w->dim * w->dim; k++) A[k] = i->tensor[k] + j->tensor[k];
    pg_dense_eigen ((int) w->dim, A, lambda, V);
    for (size_t k = 0; k < w->dim; k++) d->normal[k] = V[k * w->dim];
    double sense = pg_dot3 (d->normal, i->normal) < 0 ? -1 : 1;
    for (size_t k = 0; k < w->dim; k++) {
        d->normal[k] *= sense, d->x[k] = x[k] + 0.5 * b->xi[k];
        off += d->normal[k] * (d->x[k] - (i->mean[k] + j->mean[k]) / weight);
    }
    for (size_t k = 0; k < w->dim; k++) d->x[k] -= off * d->normal[k];
    d->h = pg_problem_spacing (w->p, PG_NODES, i->node);
    mean_moment (w, b, M);
    if (pg_dense_cholesky ((int) w->dim, M, 0)) return;        /* neighbours on a line determine no area */
    for (size_t k = 0; k < w->dim; k++) b->part[k] = weight_of (w, b) * b->xi[k];
    pg_dense_solve ((int) w->dim, M, b->part);
    d->area = area_of (w, b, d->normal);
    d->size = d->area / (w->dim == 2 ? d->h * w->p->cloud.thickness : d->h * d->h);
}

/* ---- pieces -------------------------------------------------------------------------------------------- */
/* Makes dots of all broken bonds connected with those of place `from`, and orients their normals
 * consistently. */
static pg_status walk (faces *w, size_t from)
{
    pg_status status = PG_OK;
    size_t *list = NULL, n = 0;
    PG_ALLOC (list, w->nplace);
    w->about[from].seen = 1, list[n++] = from;
    for (size_t k = 0; k < n; k++) {
        const size_t i = list[k];
        for (size_t q = w->start[i]; q < w->start[i + 1]; q++) {
            const broken *b = &w->broken[w->of[q]];
            place *next = &w->about[b->end[b->end[0] == i]];
            if (next->seen) continue;
            double sense = pg_dot3 (next->normal, w->about[i].normal) < 0 ? -1 : 1;
            for (size_t c = 0; c < w->dim; c++) next->normal[c] *= sense;
            next->seen = 1, list[n++] = b->end[b->end[0] == i];
        }
    }
    for (size_t k = 0; k < n; k++)
        for (size_t q = w->start[list[k]]; q < w->start[list[k] + 1]; q++) {
            broken *b = &w->broken[w->of[q]];
            if (b->end[0] != list[k]) continue;
            measure_bond (w, b, &w->dot[w->ndot]);
            if (w->dot[w->ndot].area > 0) w->order[w->ndot++] = w->of[q];
        }
done:
    pg_free (list);
    return status;
}

/* Computes the normal of a piece from the area vector in a window about it. */
static void find_normal (const faces *w, size_t first, pg_contact_piece *piece)
{
    double sum[3] = { 0 }, h = pg_problem_spacing_at (w->p, piece->x), size;
    for (size_t i = first; i < w->ndot; i++) {
        const dot *d = &w->dot[i];
        double to[3];
        for (int k = 0; k < 3; k++) to[k] = d->x[k] - piece->x[k];
        double weight = 1 - pg_size (3, to) / (WINDOW * h);
        if (!(weight > 0) || pg_dot3 (d->normal, piece->normal) < ALIKE) continue;
        const broken *b = &w->broken[w->order[i]];
        if (pg_dot3 (b->xi, piece->normal) < 0) weight = -weight;
        for (int k = 0; k < 3; k++) sum[k] += weight * b->part[k];
    }
    size = pg_size (3, sum);
    for (int k = 0; k < 3 && size > 0; k++) piece->normal[k] = sum[k] / size;
}

/* Appends the dots from `first` on, which belong to pieces 0 to count - 1, as pieces of one path. */
static pg_status put_pieces (const faces *w, size_t first, size_t count, size_t path, pg_contact_pieces *out)
{
    pg_status status = PG_OK;
    size_t dim = w->dim, room[6] = { 0 };
    PG_GROW (out->piece, room[0], out->n + count);
    PG_GROW (out->first, room[1], out->n + count + 1);
    PG_GROW (out->x, room[2], dim * (out->n + count + out->npoint));
    PG_GROW (out->normal, room[3], dim * (out->n + count + out->npoint));
    PG_GROW (out->tangent, room[4], dim * (dim - 1) * (out->n + count + out->npoint));
    PG_GROW (out->weight, room[5], out->n + count + out->npoint);
    for (size_t k = 0; k < count; k++) {
        pg_contact_piece *piece = &out->piece[out->n];
        size_t q = out->npoint;
        double usual = 0, all = 0;
        memset (piece, 0, sizeof *piece);
        for (size_t i = first; i < w->ndot; i++) {
            const dot *d = &w->dot[i];
            if (d->piece != k) continue;
            out->broken[out->nbroken] = w->broken[w->order[i]].bond, out->place[out->nbroken++] = q;
            all += d->area, usual += d->area * d->h;
            for (int c = 0; c < 3; c++)
                piece->x[c] += d->area * d->x[c], piece->normal[c] += d->area * d->normal[c];
        }
        double size = pg_size (3, piece->normal);
        if (!(size > 0)) continue;
        for (int c = 0; c < 3; c++) piece->x[c] /= all, piece->normal[c] /= size;
        usual /= all;
        for (int round = 0; round < 2; round++) find_normal (w, first, piece);
        for (size_t i = first; i < w->ndot; i++)
            if (w->dot[i].piece == k) piece->area += area_of (w, &w->broken[w->order[i]], piece->normal);
        if (dim == 3) piece_tangents (piece->normal, NULL, piece->tangent[0]);
        else piece->tangent[0][0] = piece->normal[1], piece->tangent[0][1] = -piece->normal[0];
        /* at least the length of a whole piece, even if few of its bonds are broken */
        piece->length = fmax (PG_CONTACT_PIECE * usual,
                              dim == 3 ? sqrt (piece->area) : piece->area / w->p->cloud.thickness);
        piece->path = path;
        memcpy (out->x + dim * q, piece->x, dim * sizeof *out->x);
        memcpy (out->normal + dim * q, piece->normal, dim * sizeof *out->x);
        for (size_t a = 0; a + 1 < dim; a++)
            memcpy (out->tangent + ((dim - 1) * q + a) * dim, piece->tangent[a], dim * sizeof *out->x);
        out->weight[q] = piece->area;
        out->first[++out->n] = ++out->npoint;
    }
done:
    return status;
}

/* Divides the faces into pieces, path by path. */
static pg_status divide (faces *w, pg_contact_pieces *out)
{
    pg_status status = PG_OK;
    size_t path = out->n ? out->piece[out->n - 1].path + 1 : 0;
    for (size_t from = 0; from < w->nplace; from++) {
        size_t first = w->ndot;
        double whole = 0, full = w->dim == 3 ? PG_CONTACT_PIECE * PG_CONTACT_PIECE : PG_CONTACT_PIECE;
        if (w->about[from].seen) continue;
        PG_TRY (walk (w, from));
        for (size_t i = first; i < w->ndot; i++) whole += w->dot[i].size;
        if (w->ndot == first) continue;
        size_t count = pieces_of (&w->p->cloud, whole, full);
        PG_TRY (gather_dots (w->dot + first, w->ndot - first, full, &count));
        PG_TRY (put_pieces (w, first, count, path++, out));
    }
done:
    return status;
}

pg_status pg_contact_add_broken (pg_contact_pieces *out, const pg_problem *p, const pg_state *state)
{
    pg_status status = PG_OK;
    faces w = { .p = p,
                .alive = state->alive + p->bonds.first[PG_NODES],
                .family = &p->bonds.rows[PG_NODES].family,
                .dim = (size_t) p->dim };
    PG_ALLOC (w.bears, p->cloud.n);
    PG_ALLOC (w.at, p->cloud.n);
    find_rubble (&w);
    PG_TRY (list_broken (&w, pg_state_cracks (p, state)));
    if (!w.n) goto done;
    PG_TRY (list_by_place (&w));
    PG_ALLOC (w.about, w.nplace);
    PG_ALLOC (w.dot, w.n);
    PG_ALLOC (w.order, w.n);
    PG_ALLOC (out->broken, w.n);
    PG_ALLOC (out->place, w.n);
    for (size_t i = 0; i < w.nplace; i++) measure_place (&w, i);
    for (size_t i = 0; i < w.nplace; i++) smooth_place (&w, i);
    PG_TRY (divide (&w, out));
done:
    pg_free (w.bears), pg_free (w.at), pg_free (w.broken), pg_free (w.place), pg_free (w.about);
    pg_free (w.start), pg_free (w.of), pg_free (w.order), pg_free (w.dot);
    return status;
}

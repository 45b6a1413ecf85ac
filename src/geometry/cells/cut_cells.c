/* SPDX-License-Identifier: GPL-3.0-or-later
 * The cells of a lattice over the exact body: which boxes are whole, cut or empty, and the facets, one for
 * each pair of cell and surface (and part between dividing half-planes).
 *
 * Steps: for every box a list of the surfaces that come near it (find_near); the volume of the body in each
 * box that a surface crosses, by quadrature (classify); the area, centroid and mean normal of each surface
 * in each cell (find_facets); the arrays of pg_cells (fill). A box whose near surfaces all lie on its faces
 * is whole or empty by its centre, without quadrature, so that a body that follows the lattice gets the
 * cells and facets of the uncut lattice. Results do not depend on threads: everything here runs in the
 * order of the lattice. */
#include "cut.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { NONE, WHOLE, CUT };
/* A facet before it enters pg_cells: cell number in pg_cells, surface number in pg_cut, face of the box if it
 * covers one entirely (else -1), part between dividing half-planes, and its measures. */
typedef struct { int cell, surface, face, part; cut_piece piece; } one_facet;

/* A smaller share of the volume of a box is rounding, wherever the box lies. */
static const double no_share = 1e-13;

/* What is collected before the arrays of pg_cells can be allocated. */
typedef struct {
    const pg_lattice *l;
    struct pg_cut *cut;
    /* Number of boxes of the lattice. */
    size_t  n;
    /* Surfaces near each box, in compressed rows (start: n + 1). */
    size_t *start;  int *near;
    /* state: NONE, WHOLE or CUT. aligned: all surfaces near the box lie on its faces (n each). */
    unsigned char *state, *aligned;
    /* Volume of the body in each box, thickness included, m^3 (n). */
    double *volume;
    /* Volume of a whole box, thickness included, m^3. */
    double  whole;
    /* The least share of a box's largest face that counts as a facet. Less is rounding, which grows with the
     * distance from the origin; a whole face gains or loses no larger share of its box's volume by it. */
    double  least;
    /* The last surface entered in the list of each box, while regions of facets are entered (n). */
    int    *last;
    one_facet *facet;  size_t nfacet, capacity;
    /* Totals over the cells: how many, the entries of their lists of near surfaces, how many differ from
     * what the uncut lattice would have. */
    size_t  ncell, nnear, ncut;
} builder;

/* Number of box i (three indices), x fastest, and back. */
static size_t number_of (const pg_lattice *l, const int *i)
{
    return ((size_t) i[2] * (size_t) l->count[1] + (size_t) i[1]) * (size_t) l->count[0] + (size_t) i[0];
}

static void index_of (const pg_lattice *l, size_t c, int *i)
{
    i[0] = (int) (c % (size_t) l->count[0]), c /= (size_t) l->count[0];
    i[1] = (int) (c % (size_t) l->count[1]), i[2] = (int) (c / (size_t) l->count[1]);
}

/* Corners of box i, m. */
static void box_of (const pg_lattice *l, const int *i, double *low, double *high)
{
    for (int k = 0; k < l->dim; k++)
        low[k] = pg_lattice_at (l, k, i[k]), high[k] = pg_lattice_at (l, k, i[k] + 1);
}

/* Is entry k of the lists a dividing half-plane? They come last in each list. */
static int is_half_plane (const builder *m, size_t k) { return m->cut->surface[m->near[k]].shape < 0; }

/* The face of box i (-x +x -y +y -z +z) on which a plane surface lies, to cut_snap and rounding; -1: none. */
static int face_of (const builder *m, const int *i, int surface)
{
    const cut_surface *s = &m->cut->surface[surface];
    if (s->axis < 0) return -1;
    double at = s->origin[s->axis], tolerance = 0.5 * cut_snap * m->l->step[s->axis] + m->cut->rounding;
    for (int side = 0; side < 2; side++)
        if (fabs (at - pg_lattice_at (m->l, s->axis, i[s->axis] + side)) <= tolerance)
            return 2 * s->axis + side;
    return -1;
}

/* ---- surfaces near each box ---------------------------------------------------------------------------- */
/* Can the surface come within 2 cut_snap, and rounding, of box i? First by its bounding box, then by a bound
 * of psi in local coordinates (cut_meets). */
static int is_near (const builder *m, const cut_surface *s, const int *i)
{
    double low[3], high[3], centre[3], half[3], all[3] = {1, 1, 1}, origin[3] = {0, 0, 0}, least = INFINITY;
    box_of (m->l, i, low, high);
    for (int k = 0; k < m->l->dim; k++) {
        centre[k] = 0.5 * (low[k] + high[k]), half[k] = 0.5 * (high[k] - low[k]);
        least = fmin (least, half[k]);
        if (s->low[k] > high[k] + 1e-7 * half[k] || s->high[k] < low[k] - 1e-7 * half[k]) return 0;
    }
    cut_quadric q = cut_local (s, m->l->dim, centre, half);
    return cut_meets (&q, origin, all, 2 * (cut_snap + m->cut->rounding / least));
}

/* For a plane of a mesh that is represented by a staircase: has the staircase a step at the face of box i
 * that lies on it? */
static int is_step (const builder *m, size_t number, const int *i)
{
    int face = face_of (m, i, (int) number);
    return face >= 0 && pg_stairs_step (&m->cut->body.shape[m->cut->surface[number].shape], i, face);
}

/* Visits the boxes within the bounding box of a surface. near NULL: counts, into start[c + 1]; else writes
 * from start[c] on, which advances to the end of each list. */
static void visit_near (builder *m, size_t number, int *near)
{
    const cut_surface *s = &m->cut->surface[number];
    const pg_lattice *l = m->l;
    int first[3] = { 0, 0, 0 }, last[3] = { 0, 0, 0 }, i[3],
        stairs = s->shape >= 0 && m->cut->body.shape[s->shape].kind == PG_STAIRS;
    for (int k = 0; k < l->dim; k++) {
        double a = floor ((s->low[k] - l->origin[k]) / l->step[k]) - 1,
               b = floor ((s->high[k] - l->origin[k]) / l->step[k]) + 1;
        first[k] = a > 0 ? (int) fmin (a, l->count[k]) : 0,
        last[k] = b < l->count[k] - 1 ? (int) fmax (b, -1) : l->count[k] - 1;
    }
    for (i[2] = first[2]; i[2] <= last[2]; i[2]++)
        for (i[1] = first[1]; i[1] <= last[1]; i[1]++)
            for (i[0] = first[0]; i[0] <= last[0]; i[0]++) {
                if (!is_near (m, s, i) || (stairs && !is_step (m, number, i))) continue;
                size_t c = number_of (l, i);
                if (near) near[m->start[c]++] = (int) number;
                else m->start[c + 1]++;
            }
}

/* Visits the boxes near a region of pg_facets, triangle by triangle (2D: segments), as a box may be near the
 * plane of a large region but outside of it, or in a hole of it. near: as in visit_near. */
static void visit_region (builder *m, size_t number, int *near)
{
    const cut_surface *whole = &m->cut->surface[number];
    const pg_facets *f = whole->facets;
    const pg_lattice *l = m->l;
    size_t dim = (size_t) f->dim;
    for (size_t e = f->first[whole->region]; e < f->first[whole->region + 1]; e++) {
        cut_surface s = *whole;
        int first[3] = { 0, 0, 0 }, last[3] = { 0, 0, 0 }, i[3];
        for (size_t k = 0; k < dim; k++) {
            s.low[k] = INFINITY, s.high[k] = -INFINITY;
            for (size_t c = 0; c < dim; c++) {
                double v = f->x[((size_t) f->piece[e] * dim + c) * dim + k];
                s.low[k] = fmin (s.low[k], v), s.high[k] = fmax (s.high[k], v);
            }
            first[k] = (int) fmax (0, floor ((s.low[k] - l->origin[k]) / l->step[k] - 1e-3)),
            last[k] = (int) fmin (l->count[k] - 1, floor ((s.high[k] - l->origin[k]) / l->step[k] + 1e-3));
        }
        for (i[2] = first[2]; i[2] <= last[2]; i[2]++)
            for (i[1] = first[1]; i[1] <= last[1]; i[1]++)
                for (i[0] = first[0]; i[0] <= last[0]; i[0]++) {
                    size_t c = number_of (l, i);
                    if (m->last[c] == (int) number || !is_near (m, &s, i)) continue;
                    m->last[c] = (int) number;
                    if (near) near[m->start[c]++] = (int) number;
                    else m->start[c + 1]++;
                }
    }
}

/* Visits the boxes near each surface, in the order of the surfaces; near: as in visit_near. */
static void visit_all (builder *m, int *near)
{
    for (size_t c = 0; c < m->n; c++) m->last[c] = -1;
    for (size_t s = 0; s < m->cut->n; s++)
        if (m->cut->surface[s].facets) visit_region (m, s, near);
        else visit_near (m, s, near);
}

/* Builds the lists of surfaces near each box: counts, sums, writes, and moves the starts back by one
 * entry. */
static pg_status find_near (builder *m)
{
    pg_status status = PG_OK;
    PG_ALLOC (m->start, m->n + 1);
    PG_ALLOC (m->last, m->n);
    visit_all (m, NULL);
    for (size_t c = 0; c < m->n; c++) m->start[c + 1] += m->start[c];
    PG_ALLOC (m->near, m->start[m->n]);
    visit_all (m, m->near);
    for (size_t c = m->n; c > 0; c--) m->start[c] = m->start[c - 1];
    m->start[0] = 0;
done:
    return status;
}

/* ---- cells --------------------------------------------------------------------------------------------- */
/* Prepares the workspace of the quadrature for box c. */
static pg_status into_cell (const builder *m, size_t c)
{
    double low[3], high[3];
    int i[3];
    index_of (m->l, c, i);
    box_of (m->l, i, low, high);
    return cut_work_cell (m->cut->work, low, high, m->start[c + 1] - m->start[c], m->near + m->start[c]);
}

/* Is this share of box c, for which the workspace is prepared, no more than rounding can make? Rounding
 * shifts the surfaces, and shift times area is volume: even a million metres from the origin a corner of a
 * thousandth of the edge is no rounding, though it is less than what a whole face may lose there. */
static pg_status only_rounding (const builder *m, size_t c, double share, int *only)
{
    pg_status status = PG_OK;
    cut_piece piece;
    double area = 0;
    *only = share <= no_share;
    if (*only || share > m->least) return PG_OK;
    for (size_t k = m->start[c]; k < m->start[c + 1] && !is_half_plane (m, k); k++)
        for (int part = 0; part < 1 << cut_work_half_planes (m->cut->work); part++) {
            PG_TRY (cut_work_piece (m->cut->work, m->near[k], part, &piece));
            area += piece.size;
        }
    *only = share <= no_share + 4 * m->cut->rounding * area / cut_work_size (m->cut->work);
done:
    return status;
}

/* Is box c whole, cut or empty? By its centre where all surfaces lie on its faces, else by the share of its
 * volume that the quadrature finds. */
static pg_status classify (builder *m, size_t c)
{
    pg_status status = PG_OK;
    cut_piece piece;
    int i[3], aligned = 1, whole, none;
    index_of (m->l, c, i);
    for (size_t k = m->start[c]; k < m->start[c + 1]; k++)
        aligned &= is_half_plane (m, k) || face_of (m, i, m->near[k]) >= 0;
    m->aligned[c] = (unsigned char) aligned;
    if (aligned) m->state[c] = m->l->in[c] ? WHOLE : NONE;
    else {
        PG_TRY (into_cell (m, c));
        PG_TRY (cut_work_piece (m->cut->work, -1, 0, &piece));
        double share = piece.size / cut_work_size (m->cut->work);
        PG_TRY (only_rounding (m, c, 1 - share, &whole));
        PG_TRY (only_rounding (m, c, share, &none));
        m->state[c] = whole ? WHOLE : none ? NONE : CUT;
        m->volume[c] = piece.size;
    }
    if (m->state[c] == WHOLE) m->volume[c] = m->whole;
    if (m->state[c] == NONE) return PG_OK;
    m->ncell++, m->nnear += m->start[c + 1] - m->start[c], m->ncut += m->state[c] == CUT || !m->l->in[c];
done:
    return status;
}

/* ---- facets -------------------------------------------------------------------------------------------- */
/* The state beyond a face of box i: NONE or WHOLE where it is the same all over the face, else CUT. */
static int beyond (const builder *m, const int *i, int face)
{
    int at[3] = {i[0], i[1], i[2]};
    at[face / 2] += face % 2 ? 1 : -1;
    /* the end of a subdomain is no surface of the body */
    if (at[face / 2] < 0 || at[face / 2] >= m->l->count[face / 2])
        return m->l->whole[0] && pg_lattice_goes_on (m->l, at) ? WHOLE : NONE;
    size_t c = number_of (m->l, at);
    return m->aligned[c] ? m->state[c] : CUT;
}

/* Appends a facet. Two shapes that share a side would give the same whole face twice; the second is
 * dropped. */
static pg_status put (builder *m, const one_facet *f)
{
    pg_status status = PG_OK;
    for (size_t k = m->nfacet; f->face >= 0 && k-- > 0 && m->facet[k].cell == f->cell; )
        /* Two shapes may have the same side. */
        if (m->facet[k].face == f->face) return PG_OK;
    PG_GROW (m->facet, m->capacity, m->nfacet + 1);
    m->facet[m->nfacet++] = *f;
done:
    return status;
}

/* Adds a facet for each part of surface f.surface in the prepared cell that has an area. A part that covers a
 * whole face of the box, except for slivers within the tolerances, becomes that face, with nodes of its
 * own. */
static pg_status find_parts (builder *m, one_facet f)
{
    pg_status status = PG_OK;
    int face = f.face, parts = 1 << cut_work_half_planes (m->cut->work);
    double full = m->whole / m->l->step[face >= 0 ? face / 2 : 0];
    for (f.part = 0; f.part < parts; f.part++) {
        PG_TRY (cut_work_piece (m->cut->work, f.surface, f.part, &f.piece));
        if (!(f.piece.size > m->least * full)) continue;
        f.face = face >= 0 && f.piece.size >= (1 - m->least - cut_snap) * full ? face : -1;
        PG_TRY (put (m, &f));
    }
done:
    return status;
}

/* Returns how many regions of pg_facets lie on that face of box c: only a single one surely covers all of
 * it. */
static int regions_on (const builder *m, size_t c, const int *i, int face)
{
    int n = 0;
    for (size_t k = m->start[c]; k < m->start[c + 1]; k++)
        n += m->cut->surface[m->near[k]].facets && face_of (m, i, m->near[k]) == face;
    return n;
}

/* The facets of box c, cell number `cell`. Where box and neighbour are whole or empty, the answer is known:
 * a face between whole and empty is a facet as a whole, a face between two whole boxes is none. The
 * quadrature decides all other cases. */
static pg_status find_facets (builder *m, size_t c, int cell)
{
    pg_status status = PG_OK;
    int i[3], entered = 0, parted = m->start[c + 1] > m->start[c] && is_half_plane (m, m->start[c + 1] - 1);
    index_of (m->l, c, i);
    for (size_t k = m->start[c]; k < m->start[c + 1] && !is_half_plane (m, k); k++) {
        one_facet f = {.cell = cell, .surface = m->near[k], .face = face_of (m, i, m->near[k])};
        if (f.face >= 0 && m->state[c] == WHOLE && m->aligned[c] && regions_on (m, c, i, f.face) < 2) {
            int behind = beyond (m, i, f.face);
            if (behind == NONE && !parted) PG_TRY (put (m, &f));
            if (behind == WHOLE || (behind == NONE && !parted)) continue;
        }
        if (!entered++) PG_TRY (into_cell (m, c));
        PG_TRY (find_parts (m, f));
    }
done:
    return status;
}

/* Half-planes come last in the list of each cell. */
size_t cut_half_planes_near (const pg_cells *cells, size_t facet)
{
    const struct pg_cut *cut = cells->cut;
    if (!cut) return 0;
    size_t c = (size_t) cells->facet_cell[facet], first = cut->start[c], end = cut->start[c + 1], k = end;
    while (k > first && cut->surface[cut->near[k - 1]].shape < 0) k--;
    return end - k;
}

/* ---- from the builder to the cells --------------------------------------------------------------------- */
/* Corners in the order of Exodus, as steps along x, y, z. */
static const unsigned char corner[8][3] = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 },
                                            { 0, 0, 1 }, { 1, 0, 1 }, { 1, 1, 1 }, { 0, 1, 1 } };

/* Writes box c as cell `at`, with its list of near surfaces. */
static void fill_cell (pg_cells *out, const builder *m, size_t c, size_t at)
{
    static const pg_element kind[3] = {PG_BAR2, PG_QUAD4, PG_HEX8};
    size_t dim = (size_t) m->l->dim, corners = (size_t) 1 << dim, near = m->start[c + 1] - m->start[c];
    struct pg_cut *cut = m->cut;
    int i[3];
    index_of (m->l, c, i);
    for (size_t e = 0; e < corners; e++)
        for (size_t k = 0; k < dim; k++)
            out->x[(at * corners + e) * dim + k] = pg_lattice_at (m->l, (int) k, i[k] + corner[e][k]);
    out->kind[at] = m->state[c] == CUT ? PG_CUT : (unsigned char) kind[dim - 1];
    out->start[at + 1] = (at + 1) * corners;
    out->volume[at] = m->volume[c];
    cut->start[at + 1] = cut->start[at] + near;
    memcpy (cut->near + cut->start[at], m->near + m->start[c], near * sizeof *cut->near);
}

/* Writes facet `at`: a whole face of a box, or a piece of a surface with its mean normal scaled to unit
 * length. */
static void fill_facet (pg_cells *out, const builder *m, const one_facet *f, size_t at)
{
    size_t dim = (size_t) out->dim;
    double *normal = out->normal + at * dim, size = 0;
    out->facet_cell[at] = f->cell, out->facet_surface[at] = f->surface;
    out->facet_start[at + 1] = out->facet_start[at];
    if (f->face >= 0) {
        cells_put_face (out, at, f->face, m->l->step);
        return;
    }
    out->facet_kind[at] = PG_CUT;
    out->area[at] = f->piece.size;
    for (size_t k = 0; k < dim; k++) size += f->piece.normal[k] * f->piece.normal[k];
    for (size_t k = 0; k < dim; k++) {
        out->facet_centre[at * dim + k] = f->piece.centre[k];
        normal[k] = size > 0 ? f->piece.normal[k] / sqrt (size) : k == 0;
    }
}

/* Allocates and writes all of pg_cells; the geometry (pg_cut) passes into its ownership. */
static pg_status fill (pg_cells *out, builder *m, double thickness)
{
    pg_status status = PG_OK;
    size_t corners = (size_t) 1 << m->l->dim, at = 0, whole = 0;
    for (size_t f = 0; f < m->nfacet; f++) whole += m->facet[f].face >= 0;
    PG_ALLOC (m->cut->start, m->ncell + 1);
    PG_ALLOC (m->cut->near, m->nnear);
    PG_ALLOC (m->cut->part, m->nfacet);
    PG_TRY (pg_cells_reserve (out, m->l->dim, thickness, m->ncell, m->ncell * corners, m->nfacet,
                              whole * corners / 2));
    for (size_t c = 0; c < m->n; c++) if (m->state[c] != NONE) fill_cell (out, m, c, at++);
    for (size_t f = 0; f < m->nfacet; f++)
        fill_facet (out, m, &m->facet[f], f), m->cut->part[f] = m->facet[f].part;
    out->cut = m->cut;
    m->cut = NULL;
done:
    return status;
}

/* Prepares surfaces, workspace, lists of near surfaces and memory for the states. */
static pg_status prepare (builder *m, const pg_body *body, double thickness, size_t nray, const pg_ray *ray)
{
    pg_status status = PG_OK;
    m->n = (size_t) m->l->count[0] * (size_t) m->l->count[1] * (size_t) m->l->count[2];
    m->whole = m->l->dim == 3 ? 1 : thickness, m->least = no_share;
    PG_ALLOC (m->cut, 1);
    m->cut->rounding = fmax (pg_rounding (m->l->dim, m->l->origin, m->l->high),
                             pg_rounding (m->l->dim, body->low, body->high));
    for (int k = 0; k < m->l->dim; k++) {
        m->whole *= m->l->step[k];
        m->least = fmax (m->least, no_share + 4 * m->cut->rounding / m->l->step[k]);
    }
    PG_TRY (cut_surfaces (m->cut, body, m->l, nray, ray));
    PG_TRY (cut_work_create (&m->cut->work, m->cut, m->l->dim == 3 ? 1 : thickness));
    PG_TRY (find_near (m));
    PG_ALLOC (m->state, m->n);
    PG_ALLOC (m->aligned, m->n);
    PG_ALLOC (m->volume, m->n);
done:
    return status;
}

/* Warns where a size is known to less than six digits of a cell; other errors of a discretisation are far
 * larger than that. Gauss points may not resolve surfaces that nearly touch, or a cusp between them. */
int pg_cells_doubt (const pg_cells *cells, char *text, size_t size)
{
    const double worth_a_warning = 1e-6;
    char given_up[64] = "";
    if (!(cells->unsettled > worth_a_warning)) return 0;
    if (cells->given_up)
        snprintf (given_up, sizeof given_up, " (%zu searches for corners given up)", cells->given_up);
    snprintf (text, size,
              "cells: cut: a volume or area at the surface is known to %.2g of a whole cell only%s: surfaces "
              "nearly touch there; take another spacing, or shapes that overlap",
              cells->unsettled, given_up);
    return 1;
}

/* Where all cells and facets are those of the uncut lattice, they are built by pg_cells_from_lattice and no
 * geometry is kept, so that aligned bodies have the same bits with and without `cells: cut`. */
pg_status pg_cells_cut (pg_cells *out, const pg_body *body, const pg_lattice *lattice, double thickness,
                        size_t nray, const pg_ray *ray)
{
    pg_status status = PG_OK;
    builder m = {.l = lattice};
    int cell = 0, other = 0;
    memset (out, 0, sizeof *out);
    if (lattice->dim == 0) return PG_OK;
    PG_TRY (prepare (&m, body, thickness, nray, ray));
    for (size_t c = 0; c < m.n; c++) PG_TRY (classify (&m, c));
    for (size_t c = 0; c < m.n; c++) other |= (m.state[c] != NONE) != (m.l->in[c] != 0);
    for (size_t c = 0; c < m.n; c++) if (m.state[c] != NONE) PG_TRY (find_facets (&m, c, cell++));
    for (size_t f = 0; f < m.nfacet; f++) other |= m.facet[f].face < 0;
    double cuts = m.ncut > 0 || other;
    /* all ranks choose alike, so that they list cells and facets in the same order */
    if (lattice->whole[0]) PG_TRY (pg_ranks_most (1, &cuts));
    if (!(cuts > 0)) status = pg_cells_from_lattice (out, lattice, thickness);
    else {
        double unsettled = cut_work_unsettled (m.cut->work);
        size_t given_up = cut_work_given_up (m.cut->work);
        PG_TRY (fill (out, &m, thickness));
        out->unsettled = unsettled, out->given_up = given_up;
    }
done:
    cut_free (m.cut);
    pg_free (m.start), pg_free (m.near), pg_free (m.state), pg_free (m.aligned), pg_free (m.volume),
        pg_free (m.facet), pg_free (m.last);
    return status;
}

void cut_free (struct pg_cut *cut)
{
    if (!cut) return;
    cut_work_free (&cut->work);
    for (size_t i = 0; cut->own && i < cut->body.n; i++)
        if (cut->own[i].kind == PG_STAIRS || cut->own[i].kind == PG_FACETED) pg_stairs_clear (&cut->own[i]);
    pg_free (cut->own);
    pg_free (cut->surface), pg_free (cut->start), pg_free (cut->near), pg_free (cut->part);
    pg_free (cut);
}

/* ---- quadrature of cells and facets -------------------------------------------------------------------- */
/* Prepares the workspace for a cell of pg_cells: its first and its diagonally opposite corner span the
 * box. */
static pg_status enter (const pg_cells *cells, size_t cell)
{
    const struct pg_cut *cut = cells->cut;
    /* Number of the corner diagonally opposite the first one, in the order of Exodus. */
    size_t dim = (size_t) cells->dim, far = dim == 3 ? 6 : dim == 2 ? 2 : 1;
    const double *x = cells->x + cells->start[cell] * dim;
    return cut_work_cell (cut->work, x, x + far * dim, cut->start[cell + 1] - cut->start[cell],
                          cut->near + cut->start[cell]);
}

/* Returns the larger of the requested order and the least order of these cells. */
static int finer (const pg_cells *cells, int order)
{
    return order > cells->cut_order ? order : cells->cut_order;
}

pg_status pg_cut_cell (pg_cut_points *out, const pg_cells *cells, size_t cell, int order)
{
    pg_status status = PG_OK;
    size_t first = out->n;
    cut_work *work = cells->cut->work;
    PG_TRY (enter (cells, cell));
    cut_work_leave_slivers (work, !cut_work_faceted (work));
    PG_TRY (cut_work_points (work, -1, 0, finer (cells, order), out));
    if (cut_work_faceted (work)) PG_TRY (cut_compress (out, first, cells->dim));
done:
    cut_work_leave_slivers (work, 0);
    return status;
}

pg_status pg_cut_facet (pg_cut_points *out, const pg_cells *cells, size_t facet, int order)
{
    pg_status status = PG_OK;
    cut_work *work = cells->cut->work;
    PG_TRY (enter (cells, (size_t) cells->facet_cell[facet]));
    cut_work_leave_slivers (work, !cut_work_faceted (work));
    PG_TRY (cut_work_points (work, cells->facet_surface[facet], cells->cut->part[facet],
                             finer (cells, order), out));
done:
    cut_work_leave_slivers (work, 0);
    return status;
}

pg_status pg_cut_face (pg_cut_points *out, const pg_cells *cells, size_t cell, int face, int order)
{
    pg_status status = enter (cells, cell);
    return status == PG_OK ? cut_work_face (cells->cut->work, face, finer (cells, order), out) : status;
}

int pg_cut_shape  (const struct pg_cut *cut, int surface) { return cut->surface[surface].shape; }
int pg_cut_is_end (const struct pg_cut *cut, int surface) { return cut->surface[surface].end; }

/* SPDX-License-Identifier: GPL-3.0-or-later
 * Decides which cells end at cracks. Of the cells whose supports reach a crack those are treated that reach
 * no crack tip, have lost exactly the bonds that the cracks cut, and whose parts, if a crack runs through
 * them, have an evaluation point each, or lie beside a part of another cell that has one. The others are
 * left as they are: with uncorrected derivatives where bonds are broken. */
#include "galerkin_ended.h"
#include <math.h>
#include <string.h>

static double spacing (const galerkin *g, const double *x) { return pg_problem_spacing_at (g->problem, x); }

/* The largest support radius of points that have no widened support, m. */
static double reach_of (const galerkin *g)
{
    const pg_cloud *c = &g->problem->cloud;
    double most = 1;
    for (size_t i = 0; c->size && i < c->n; i++) most = fmax (most, pg_cloud_ratio (c, i));
    return most * g->problem->form.approx.horizon;
}

/* The widest support of the points of a cell and of its faces, over the usual one. */
static double widest_of (const galerkin *g, size_t cell)
{
    const pg_consistency *c = g->problem->form.consistency;
    const double *points = g->rows[g->bulk].wide, *faces = c->face.wide;
    double most = 1;
    for (size_t q = c->first[cell]; points && q < c->first[cell + 1]; q++) most = fmax (most, points[q]);
    for (size_t k = c->faces.of[cell]; faces && k < c->faces.of[cell + 1]; k++) {
        size_t face = (size_t) c->faces.face[k];
        for (size_t q = c->faces.start[face]; q < c->faces.start[face + 1]; q++) most = fmax (most, faces[q]);
    }
    return most;
}

/* ---- cells near cracks --------------------------------------------------------------------------------- */
static void box_of (const pg_cells *cells, size_t cell, double *low, double *high)
{
    for (int k = 0; k < 2; k++) low[k] = INFINITY, high[k] = -INFINITY;
    for (size_t i = cells->start[cell]; i < cells->start[cell + 1]; i++)
        for (int k = 0; k < 2; k++)
            low[k] = fmin (low[k], cells->x[2 * i + (size_t)k]),
            high[k] = fmax (high[k], cells->x[2 * i + (size_t)k]);
}

int ended_moved (const galerkin *g, const pg_state *state)
{
    const pg_cracks *cracks = pg_state_cracks (g->problem, state);
    const struct galerkin_ended *e = g->ended;
    if (e->nseen != 6 * cracks->n) return 1;
    for (size_t k = 0; k < cracks->n; k++) {
        const pg_crack *c = &cracks->crack[k];
        double now[6] = { c->vertex[0], c->vertex[1], c->vertex[2], c->vertex[3],
                          c->retreat ? c->retreat[0] : 0, c->retreat ? c->retreat[1] : 0 };
        if (memcmp (now, e->seen + 6*k, sizeof now) != 0) return 1;
    }
    return 0;
}

/* Lists the cells whose supports reach a crack, and their neighbours, which would lose their correction with
 * them. */
static pg_status find_near (galerkin *g, const pg_cracks *cracks)
{
    pg_status status = PG_OK;
    struct galerkin_ended *e = g->ended;
    const pg_cells *cells = &g->problem->cells;
    const pg_faces *f = &g->problem->form.consistency->faces;
    unsigned char *listed = NULL;
    double reach = reach_of (g), low[3], high[3];
    for (size_t k = 0; k < e->n; k++) e->at[e->near[k].cell] = 0;
    e->n = 0;
    PG_GROW (e->seen, e->cap.seen, 6 * cracks->n);
    for (size_t k = 0; k < cracks->n; k++) {
        const pg_crack *c = &cracks->crack[k];
        memcpy (e->seen + 6*k, c->vertex, 4 * sizeof (double));
        for (size_t m = 0; m < 2; m++) e->seen[6*k + 4 + m] = c->retreat ? c->retreat[m] : 0;
    }
    e->nseen = 6 * cracks->n;
    PG_ALLOC (listed, cells->n);
    for (size_t c = 0; c < cells->n; c++) {
        double far = reach * widest_of (g, c);
        box_of (cells, c, low, high);
        for (int k = 0; k < 2; k++) low[k] -= far, high[k] += far;
        if (!pg_cracks_near (cracks, low, high)) continue;
        for (size_t k = f->of[c]; k < f->of[c + 1]; k++)
            for (int side = 0; side < 2; side++)
                if (f->cell[2 * f->face[k] + side] >= 0) listed[f->cell[2 * f->face[k] + side]] = 1;
    }
    for (size_t c = 0; c < cells->n; c++) {
        if (!listed[c]) continue;
        PG_GROW (e->near, e->cap.near, e->n + 1);
        memset (&e->near[e->n], 0, sizeof *e->near);
        e->near[e->n].cell = c, e->at[c] = (int) ++e->n;
    }
done:
    pg_free (listed);
    return status;
}

/* ---- conditions ---------------------------------------------------------------------------------------- */
/* Is an end of crack segment k a tip: in the body, and not on another segment? */
static int is_tip (const galerkin *g, const pg_cracks *cracks, size_t k, int end)
{
    const double *x = cracks->crack[k].vertex + 2 * end, *y = cracks->crack[k].vertex + 2 * (1 - end);
    double length = hypot (x[0] - y[0], x[1] - y[1]), ahead[3] = { 0 }, h = spacing (g, x);
    for (int m = 0; m < 2; m++) ahead[m] = x[m] + 2 * PG_NO_LENGTH * h * (x[m] - y[m]) / length;
    for (size_t j = 0; j < cracks->n; j++)
        if (j != k && cracks->crack[j].kind == PG_CRACK_SEGMENT
            && pg_crack_touches (&cracks->crack[j], 2, x, PG_NO_LENGTH * h)) return 0;
    return pg_problem_has_body (g->problem, ahead);
}

/* Lets the cells fail whose supports reach a crack tip. Whether one just a horizon away does must not depend
 * on rounding: it counts if the kernel is not zero at its edge (closed). */
static void look_for_tips (galerkin *g, const pg_cracks *cracks)
{
    struct galerkin_ended *e = g->ended;
    double low[2], high[2], reach = reach_of (g), same = pg_cloud_same (&g->problem->cloud),
                            beyond = g->problem->form.approx.kernel->closed ? same : -same;
    for (size_t k = 0; k < cracks->n; k++)
        for (int end = 0; end < 2; end++) {
            const double *x = cracks->crack[k].vertex + 2 * end;
            if (cracks->crack[k].kind != PG_CRACK_SEGMENT || !is_tip (g, cracks, k, end)) continue;
            for (size_t c = 0; c < e->n; c++) {
                box_of (&g->problem->cells, e->near[c].cell, low, high);
                double a = fmax (fmax (low[0] - x[0], x[0] - high[0]), 0),
                       b = fmax (fmax (low[1] - x[1], x[1] - high[1]), 0);
                if (hypot (a, b) <= reach * widest_of (g, e->near[c].cell) + beyond) e->near[c].failed = 1;
            }
        }
}

/* Are exactly those bonds of the cell's points broken that the cracks cut? */
static int explained (const galerkin *g, const pg_state *state, const pg_cracks *cracks, size_t cell)
{
    const pg_consistency *c = g->problem->form.consistency;
    const pg_rows *r = &g->rows[g->bulk];
    const pg_cloud *cloud = &g->problem->cloud;
    const unsigned char *alive = state->alive + g->problem->bonds.first[g->bulk];
    for (size_t p = c->first[cell]; p < c->first[cell + 1]; p++) {
        if (pg_cracks_touch (cracks, r->x + 2*p, PG_NO_LENGTH * cloud->h)) return 0;
        for (size_t b = r->family.start[p]; b < r->family.start[p + 1]; b++) {
            int cut = pg_cracks_cut (cracks, r->x + 2*p, cloud->x + 2 * (size_t) r->family.node[b],
                                     pg_cloud_same (cloud)) != NULL;
            if (cut == alive[b]) return 0;
        }
    }
    return c->first[cell + 1] > c->first[cell];
}

/* Number of evaluation points of a cell that lie in a part of it. */
static size_t points_in (const galerkin *g, size_t cell, const pg_cell_part *part)
{
    const pg_consistency *c = g->problem->form.consistency;
    size_t n = 0;
    for (size_t p = c->first[cell]; p < c->first[cell + 1]; p++)
        n += (size_t) pg_cell_part_holds (part, g->sums.x + 2*p);
    return n;
}

/* The face on the side from a to b of a cell, SIZE_MAX: none; *other: the cell beyond, -1: none. */
static size_t face_on (const galerkin *g, size_t cell, const double *a, const double *b, int *other)
{
    const pg_faces *f = &g->problem->form.consistency->faces;
    double length = hypot (b[0] - a[0], b[1] - a[1]);
    for (size_t k = f->of[cell]; k < f->of[cell + 1]; k++) {
        size_t face = (size_t) f->face[k], on = 0;
        for (size_t q = f->start[face]; q < f->start[face + 1]; q++) {
            const double *x = f->x + 2*q;
            double away = ((b[0] - a[0]) * (x[1] - a[1]) - (b[1] - a[1]) * (x[0] - a[0])) / length;
            on += fabs (away) < 1e-6 * length;
        }
        if (on == 0 || on < f->start[face + 1] - f->start[face]) continue;
        *other = f->cell[2*face] == (int) cell ? f->cell[2*face + 1] : f->cell[2*face];
        return face;
    }
    return SIZE_MAX;
}

/* The face of the side of the cell that edge i of a part lies on, and the cell beyond (*other). *whole: 1:
 * the edge is all of that side. */
static size_t face_of_edge (const galerkin *g, size_t cell, const pg_cell_part *part, int i, int *other,
                            int *whole)
{
    const pg_cells *cells = &g->problem->cells;
    const double *x = cells->x + 2 * cells->start[cell];
    int n = (int) (cells->start[cell + 1] - cells->start[cell]), s = part->side[i];
    const double *a = x + 2*s, *b = x + 2 * ((s + 1) % n), *u = part->x[i], *v = part->x[(i + 1) % part->n];
    *whole = hypot (v[0] - u[0], v[1] - u[1]) > (1 - 1e-7) * hypot (b[0] - a[0], b[1] - a[1]);
    return face_on (g, cell, a, b, other);
}

/* Has a side of the cell no face? On several ranks this happens at the end of the cells that this rank holds;
 * nothing that it owns depends on such a cell. */
static int is_open (const galerkin *g, const ended_cell *c)
{
    int other, whole;
    for (int p = 0; p < c->parts.n; p++)
        for (int i = 0; i < c->parts.part[p].n; i++)
            if (!c->parts.part[p].crack[i] && c->parts.part[p].side[i] >= 0
                && face_of_edge (g, c->cell, &c->parts.part[p], i, &other, &whole) == SIZE_MAX)
                return 1;
    return 0;
}

/* The part of the cell `beyond` that contains a position just beyond the middle of the edge from u to v, -1:
 * none. nothing: length that counts as rounding, m. */
static int part_beyond (const ended_cell *beyond, const double *u, const double *v, double nothing)
{
    double length = hypot (v[0] - u[0], v[1] - u[1]), away = fmax (1e-7, nothing / length),
           x[2] = { 0.5 * (u[0] + v[0]) + away * (v[1] - u[1]), 0.5 * (u[1] + v[1]) - away * (v[0] - u[0]) };
    if (!(length > 0)) return -1;
    for (int k = 0; k < beyond->parts.n; k++) if (pg_cell_part_holds (&beyond->parts.part[k], x)) return k;
    return -1;
}

/* A piece of a side of a part: its ends u and v (m), the face it lies on (SIZE_MAX: none), the cell beyond
 * (-1: none) and, if that is divided too, its part there (to; -1: none); whole: 1: it is all of the side of
 * the cell. */
typedef struct { double u[2], v[2]; size_t face; int other, to, whole; } piece;
/* Most pieces of a side, as the chords that divide a cell end at most so often on it. */
enum { PIECES = 2 * (PG_PARTS - 1) + 1 };

/* For qsort: ascending. */
static int compare_shares (const void *a, const void *b)
{
    double x = *(const double *) a, y = *(const double *) b;
    return (x > y) - (x < y);
}

/* Positions of corners of the parts of a cell between the ends of an edge, as shares of the way from u to v,
 * ascending; the last share is 1. Returns their number. */
static int corners_on (const pg_cell_parts *parts, const double *u, const double *v, double nothing,
                       double *share)
{
    double d[2] = { v[0] - u[0], v[1] - u[1] }, length = hypot (d[0], d[1]);
    int n = 0;
    for (int k = 0; k < parts->n; k++)
        for (int i = 0; i < parts->part[k].n; i++) {
            double x[2] = { parts->part[k].x[i][0] - u[0], parts->part[k].x[i][1] - u[1] };
            double along = (x[0] * d[0] + x[1] * d[1]) / length, off = (x[0] * d[1] - x[1] * d[0]) / length;
            if (fabs (off) <= nothing && along > nothing && along < length - nothing)
                share[n++] = along / length;
        }
    pg_sort (share, (size_t) n, sizeof *share, compare_shares);
    share[n++] = 1;
    return n;
}

/* Divides edge i of a part into pieces with one part beyond each: a crack that has a kink on a side of a
 * cell, or ends on it from the other side, divides the cell beyond but not this one. Returns their number. */
static int pieces_of (const galerkin *g, size_t cell, const pg_cell_part *part, int i, piece *out)
{
    const struct galerkin_ended *e = g->ended;
    const double *u = part->x[i], *v = part->x[(i + 1) % part->n];
    double share[PG_PARTS * PG_PART_EDGES + 1], last = 0, nothing = 10 * pg_cloud_same (&g->problem->cloud);
    piece p = { .u = { u[0], u[1] }, .v = { v[0], v[1] }, .other = -1, .to = -1 };
    int n = 0;
    p.face = face_of_edge (g, cell, part, i, &p.other, &p.whole);
    out[0] = p;
    if (p.face == SIZE_MAX || p.other < 0 || !e->at[p.other]) return 1;
    const ended_cell *beyond = &e->near[e->at[p.other] - 1];
    if (beyond->failed) return 1;
    int corners = corners_on (&beyond->parts, u, v, nothing, share);
    for (int k = 0; k < corners; k++) {
        double x[2] = { u[0] + share[k] * (v[0] - u[0]), u[1] + share[k] * (v[1] - u[1]) };
        if (share[k] == 1) memcpy (x, v, sizeof x);
        else if ((share[k] - last) * hypot (v[0] - u[0], v[1] - u[1]) <= nothing) continue;
        last = share[k];
        p.to = part_beyond (beyond, p.u, x, 0.2 * nothing);
        if ((n > 0 && out[n - 1].to == p.to) || n == PIECES) memcpy (out[n - 1].v, x, sizeof x);
        else memcpy (p.v, x, sizeof x), out[n++] = p;
        memcpy (p.u, x, sizeof x);
    }
    for (int k = 0; k < n && n > 1; k++) out[k].whole = 0;
    return n;
}

/* Finds the hosts of a part: itself, if it has evaluation points; else the part beyond the longest of its
 * edges, or those beyond all equally long ones (a crack at 45 degrees cuts corners off cells that have two).
 * 0: there is none with points. */
static int find_host (galerkin *g, size_t at, int part)
{
    struct galerkin_ended *e = g->ended;
    ended_cell *own = &e->near[at];
    const pg_cell_part *p = &own->parts.part[part];
    ended_hosts *h = &own->host[part];
    double longest = 0, same = 10 * pg_cloud_same (&g->problem->cloud);
    *h = (ended_hosts) { 1, { (int) at }, { part } };
    if (points_in (g, own->cell, p)) return 1;
    h->n = 0;
    for (int i = 0; i < p->n; i++) {
        piece all[PIECES];
        int n = p->side[i] < 0 || p->crack[i] ? 0 : pieces_of (g, own->cell, p, i, all);
        for (int k = 0; k < n; k++) {
            double length = hypot (all[k].v[0] - all[k].u[0], all[k].v[1] - all[k].u[1]);
            if (length < longest - same || all[k].to < 0) continue;
            int to = all[k].to, host = e->at[all[k].other] - 1;
            if (!points_in (g, e->near[host].cell, &e->near[host].parts.part[to])) continue;
            if (length > longest + same) h->n = 0;
            longest = fmax (longest, length);
            if (h->n < ENDED_HOSTS && ended_share (h, (size_t) host, to) == 0)
                h->at[h->n] = host, h->part[h->n++] = to;
        }
    }
    return h->n > 0;
}

double ended_share (const ended_hosts *of, size_t k, int p)
{
    for (int i = 0; i < of->n; i++) if (of->at[i] == (int) k && of->part[i] == p) return 1.0 / of->n;
    return 0;
}

/* Finds the hosts of all parts, repeatedly until no further cell fails; marks cells that host parts of
 * others. */
static void find_hosts (galerkin *g)
{
    struct galerkin_ended *e = g->ended;
    for (int again = 1; again;) {
        again = 0;
        for (size_t k = 0; k < e->n; k++) e->near[k].guest = 0;
        for (size_t k = 0; k < e->n; k++)
            for (int p = 0; p < e->near[k].parts.n && !e->near[k].failed; p++)
                if (!find_host (g, k, p)) e->near[k].failed = again = 1;
    }
    for (size_t k = 0; k < e->n; k++)
        for (int p = 0; p < e->near[k].parts.n && !e->near[k].failed; p++)
            for (int i = 0; i < e->near[k].host[p].n; i++)
                if (e->near[k].host[p].at[i] != (int) k) e->near[e->near[k].host[p].at[i]].guest = 1;
}

/* Must the cell be treated in parts? So if one of its edges is on a crack, a piece of a side, or beside a
 * part hosted by another cell, or if its points, or those of its faces, have too poor a basis for a linear
 * field. */
static int in_parts (const galerkin *g, const ended_cell *c)
{
    const struct galerkin_ended *e = g->ended;
    const pg_consistency *all = g->problem->form.consistency;
    const pg_cell_part *p = &c->parts.part[0];
    if (c->parts.n > 1 || c->guest) return 1;
    for (size_t q = all->first[c->cell]; q < all->first[c->cell + 1]; q++)
        if (g->rows[g->bulk].grade[q] > PG_GRADE_LOWERED) return 1;
    for (size_t k = all->faces.of[c->cell]; k < all->faces.of[c->cell + 1]; k++)
        if (e->weak[all->faces.face[k]]) return 1;
    for (int i = 0; i < p->n; i++) {
        piece side[PIECES];
        if (p->crack[i]) return 1;
        int n = pieces_of (g, c->cell, p, i, side);
        if (n > 1) return 1;
        int beyond = side[0].to >= 0 ? e->at[side[0].other] - 1 : -1;
        if (beyond >= 0 && !ended_stands (e, (size_t) beyond, side[0].to)) return 1;
    }
    return 0;
}

/* ---- borders ------------------------------------------------------------------------------------------- */
/* The hosts whose points determine the values on an edge of the border: those of its own part and of the part
 * beyond (NULL: none). */
typedef struct { const ended_hosts *own, *beyond; } leaning;

/* Appends the family of point e->nextra: the nodes common to the lists, which are ascending, of all host
 * cells. */
static pg_status add_family (struct galerkin_ended *e, const pg_family *f, leaning on)
{
    pg_status status = PG_OK;
    size_t n = e->extra.family.start ? e->extra.family.start[e->nextra] : 0, at[2 * ENDED_HOSTS],
           end[2 * ENDED_HOSTS], lists = 0;
    for (int side = 0; side < 2; side++) {
        const ended_hosts *h = side ? on.beyond : on.own;
        for (int i = 0; h && i < h->n; i++, lists++) {
            size_t cell = e->near[h->at[i]].cell;
            at[lists] = f->start[cell], end[lists] = f->start[cell + 1];
        }
    }
    PG_GROW (e->extra.family.start, e->cap.start, e->nextra + 2);
    if (e->nextra == 0) e->extra.family.start[0] = 0;
    for (; at[0] < end[0]; at[0]++) {
        int node = f->node[at[0]], all = 1;
        for (size_t l = 1; l < lists; l++) {
            while (at[l] < end[l] && f->node[at[l]] < node) at[l]++;
            all &= at[l] < end[l] && f->node[at[l]] == node;
        }
        if (!all) continue;
        PG_GROW (e->extra.family.node, e->cap.node, n + 1);
        e->extra.family.node[n++] = node;
    }
    e->extra.family.start[e->nextra + 1] = n;
done:
    return status;
}

/* Adds a point of the border, once for each host of the part behind it: position x, outward normal, weight
 * (m). */
static pg_status add_point (galerkin *g, leaning on, const double *x, const double *normal, double weight,
                            int crack)
{
    pg_status status = PG_OK;
    struct galerkin_ended *e = g->ended;
    double away = crack ? ENDED_BESIDE * spacing (g, x) : 0;
    for (int i = 0; i < on.own->n; i++) {
        size_t q = e->nextra;
        PG_GROW (e->extra.x, e->cap.x, 2 * (q + 1));
        PG_GROW (e->eye, e->cap.eye, 2 * (q + 1));
        PG_GROW (e->flux, e->cap.flux, 2 * (q + 1));
        PG_GROW (e->part, e->cap.part, q + 1);
        PG_GROW (e->crack, e->cap.crack, q + 1);
        PG_TRY (add_family (e, &g->problem->form.consistency->cell_family, on));
        for (size_t k = 0; k < 2; k++) {
            e->extra.x[2*q + k] = x[k], e->eye[2*q + k] = x[k] - away * normal[k];
            e->flux[2*q + k] = weight / on.own->n * g->problem->cells.thickness * normal[k];
        }
        e->part[q][0] = on.own->at[i], e->part[q][1] = on.own->part[i], e->crack[q] = (unsigned char) crack;
        e->nextra++;
    }
done:
    return status;
}

/* Adds points on an edge of the border from u to v: on cracks those at which contact measures the gap,
 * elsewhere Gauss points. */
static pg_status add_edge (galerkin *g, leaning on, const double *u, const double *v, int crack)
{
    pg_status status = PG_OK;
    double length = hypot (v[0] - u[0], v[1] - u[1]),
           normal[2] = { (v[1] - u[1]) / length, (u[0] - v[0]) / length };
    double middle[3] = { 0.5 * (u[0] + v[0]), 0.5 * (u[1] + v[1]), 0 },
           place[3 * PG_ELEMENT_POINTS], share[PG_ELEMENT_POINTS];
    size_t n = crack ? pg_crack_intervals (length, spacing (g, middle))
                     : (size_t) pg_element_rule (PG_BAR2, 2, place, share);
    for (size_t i = 0; i < n; i++) {
        double s = crack ? ((double) i + 0.5) / (double) n : 0.5 + 0.5 * place[i],
               w = crack ? 1 / (double) n : 0.5 * share[i], x[3] = { 0 };
        for (int k = 0; k < 2; k++) x[k] = u[k] + s * (v[k] - u[k]);
        PG_TRY (add_point (g, on, x, normal, w * length, crack));
    }
done:
    return status;
}

/* Adds a whole side of a part, with the points of its face. */
static pg_status add_side (struct galerkin_ended *e, size_t at, int part, size_t face)
{
    pg_status status = PG_OK;
    PG_GROW (e->side, e->cap.side, e->nside + 1);
    e->side[e->nside].face = face;
    e->side[e->nside].part[0] = (int) at, e->side[e->nside++].part[1] = part;
done:
    return status;
}

/* Have two parts the same hosts? */
static int alike (const ended_hosts *a, const ended_hosts *b)
{
    int same = a->n == b->n;
    for (int i = 0; i < a->n; i++) same &= ended_share (b, (size_t) a->at[i], a->part[i]) > 0;
    return same;
}

/* Adds one piece of the border of part p of cell `at` of `near`, unless both its sides have the same
 * hosts. */
static pg_status add_piece (galerkin *g, size_t at, int p, const piece *one)
{
    struct galerkin_ended *e = g->ended;
    const ended_hosts *host = &e->near[at].host[p];
    size_t beyond = one->to >= 0 ? (size_t) e->at[one->other] - 1 : 0;
    const ended_hosts *theirs = one->to >= 0 ? &e->near[beyond].host[one->to] : NULL;
    if (theirs && alike (host, theirs)) return PG_OK;
    int plain = one->whole && !e->weak[one->face] && ended_stands (e, at, p);
    if (plain && (!theirs || ended_stands (e, beyond, one->to))) return add_side (e, at, p, one->face);
    return add_edge (g, (leaning) { host, theirs }, one->u, one->v, 0);
}

/* Adds the border of part p of cell `at` of `near`. */
static pg_status add_border (galerkin *g, size_t at, int p)
{
    pg_status status = PG_OK;
    const ended_cell *own = &g->ended->near[at];
    const pg_cell_part *part = &own->parts.part[p];
    for (int i = 0; i < part->n; i++) {
        piece all[PIECES];
        if (part->crack[i]) {
            leaning on = { &own->host[p], NULL };
            PG_TRY (add_edge (g, on, part->x[i], part->x[(i + 1) % part->n], 1));
            continue;
        }
        int n = pieces_of (g, own->cell, part, i, all);
        if (all[0].face == SIZE_MAX) PG_FAIL (PG_E_USAGE, "a side of a background cell has no face");
        for (int k = 0; k < n; k++) PG_TRY (add_piece (g, at, p, &all[k]));
    }
done:
    return status;
}

/* Links the points and sides of each part into a list (galerkin_ended.first). */
static pg_status chain (struct galerkin_ended *e)
{
    pg_status status = PG_OK;
    PG_GROW (e->first, e->cap.first, PG_PARTS * e->n);
    PG_GROW (e->next_point, e->cap.next_point, e->nextra);
    PG_GROW (e->next_side, e->cap.next_side, e->nside);
    for (size_t k = 0; k < PG_PARTS * e->n; k++) e->first[k] = 0;
    for (size_t q = e->nextra; q-- > 0;) {
        long *first = &e->first[PG_PARTS * e->part[q][0] + e->part[q][1]];
        e->next_point[q] = *first, *first = (long) q + 1;
    }
    for (size_t k = e->nside; k-- > 0;) {
        long *first = &e->first[PG_PARTS * e->side[k].part[0] + e->side[k].part[1]];
        e->next_side[k] = *first, *first = -(long) k - 1;
    }
done:
    return status;
}

pg_status ended_plan (galerkin *g, const pg_state *state)
{
    pg_status status = PG_OK;
    struct galerkin_ended *e = g->ended;
    const pg_cracks *cracks = pg_state_cracks (g->problem, state);
    if (ended_moved (g, state)) PG_TRY (find_near (g, cracks));
    if (!e->weak) PG_ALLOC (e->weak, g->problem->form.consistency->faces.n);
    memset (e->weak, 0, g->problem->form.consistency->faces.n);
    for (size_t k = 0; k < e->n; k++) e->near[k].failed = e->near[k].blocked = 0;
    look_for_tips (g, cracks);
    for (size_t k = 0; k < e->n; k++) {
        ended_cell *c = &e->near[k];
        if (c->failed) continue;
        c->blocked = !explained (g, state, cracks, c->cell)
                     || !pg_cell_divide (&c->parts, &g->problem->cells, c->cell, cracks,
                                         pg_cloud_same (&g->problem->cloud));
        c->failed = c->blocked || (g->problem->cloud.subdomain && is_open (g, c));
    }
    for (int again = 1; again;) {
        e->nextra = e->nside = 0;
        find_hosts (g);
        for (size_t k = 0; k < e->n; k++)
            e->near[k].kind = e->near[k].failed           ? ENDED_NOT
                              : in_parts (g, &e->near[k]) ? ENDED_PARTS
                                                          : ENDED_PLAIN;
        for (size_t k = 0; k < e->n; k++)
            for (int p = 0; p < e->near[k].parts.n && e->near[k].kind == ENDED_PARTS; p++)
                PG_TRY (add_border (g, k, p));
        PG_TRY (ended_values (g, cracks, &again));
    }
    PG_TRY (chain (e));
    e->blocked = 0;
    for (size_t k = 0; k < e->n; k++) e->blocked += (size_t) (e->near[k].failed && e->near[k].blocked);
done:
    return status;
}

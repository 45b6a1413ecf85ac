/* SPDX-License-Identifier: GPL-3.0-or-later
 * Growth of the cracks of a state: the geometry is changed on a copy (crack_paths.c, crack_surfaces.c), which
 * replaces the original on success, and the bonds cut by new pieces (2D facets, 3D triangles) are found. The
 * search tests new pieces only, by their own index (geometry/cloud/body/crack_index.c): first their common
 * bounding box, then for each point the boxes near it, then its bonds. */
#include "model.h"
#include <math.h>
#include <stdlib.h>

/* Largest length of a bond along an axis, m, for supports that are not widened. Partial volumes reach half a
 * cell beyond the horizon. */
static double reach_of (const pg_problem *p)
{
    double largest = 1, reach = 0;
    for (size_t i = 0; p->cloud.size && i < p->cloud.n; i++)
        largest = fmax (largest, pg_cloud_ratio (&p->cloud, i));
    for (int k = 0; k < p->dim; k++)
        reach = fmax (reach, p->form.approx.horizon * largest + p->cloud.step[k]);
    return reach;
}

/* Sorts the list and removes duplicates: several tips or fronts may cut the same bond before it is broken. */
static void sort_changes (pg_changes *cut)
{
    size_t n = 0;
    pg_sort (cut->bond, cut->n, sizeof *cut->bond, pg_ascending_sizes);
    for (size_t i = 0; i < cut->n; i++)
        if (n == 0 || cut->bond[i] != cut->bond[n - 1]) cut->bond[n++] = cut->bond[i];
    cut->n = n;
}

/* Adds to `cut` the intact bonds of point q of a set that the cracks cut. */
static pg_status cut_at (const pg_state *s, const pg_problem *p, const pg_cracks *cracks, int set, size_t q,
                         pg_changes *cut)
{
    pg_status status = PG_OK;
    const pg_rows *r = &p->bonds.rows[set];
    size_t dim = (size_t) p->dim;
    const double *x = r->x + dim * q;
    for (size_t e = r->family.start[q]; e < r->family.start[q + 1]; e++) {
        size_t bond = p->bonds.first[set] + e;
        int j = r->family.node[e];
        if (!s->alive[bond] || j == r->own[q]
            || !pg_cracks_cut (cracks, x, p->cloud.x + dim * (size_t) j, pg_cloud_same (&p->cloud)))
            continue;
        PG_GROW (cut->bond, cut->cap, cut->n + 1);
        cut->bond[cut->n++] = bond;
    }
done:
    return status;
}

/* Adds to `cut` the intact bonds that these n pieces of cracks cut; `cut` stays ascending. */
static pg_status cut_by (const pg_state *s, const pg_problem *p, pg_crack *piece, size_t n, pg_changes *cut)
{
    pg_status status = PG_OK;
    pg_cracks fresh = { .dim = p->dim, .crack = piece, .n = n };
    size_t dim = (size_t) p->dim, before = cut->n;
    double low[3], high[3], reach = reach_of (p), all[6] = { INFINITY, INFINITY, INFINITY, -INFINITY,
                                                             -INFINITY, -INFINITY };
    if (n == 0) return PG_OK;
    PG_TRY (pg_cracks_index (&fresh));
    for (size_t c = 0; c < n; c++)
        for (size_t k = 0; k < dim; k++)
            all[k] = fmin (all[k], fresh.box[2 * dim * c + k]),
            all[3 + k] = fmax (all[3 + k], fresh.box[2 * dim * c + dim + k]);
    for (int set = 0; set < PG_BOND_SETS; set++)
        for (size_t q = 0; q < p->bonds.rows[set].n; q++) {
            const double *x = p->bonds.rows[set].x + dim * q;
            double far = p->bonds.rows[set].wide ? reach * p->bonds.rows[set].wide[q] : reach;
            int away = 0;
            for (size_t k = 0; k < dim; k++) low[k] = x[k] - far, high[k] = x[k] + far;
            for (size_t k = 0; k < dim && !away; k++) away = high[k] < all[k] || low[k] > all[3 + k];
            if (away) continue;
            if (pg_cracks_near (&fresh, low, high)) PG_TRY (cut_at (s, p, &fresh, set, q, cut));
        }
    if (before) sort_changes (cut);
done:
    pg_cracks_clear_index (&fresh);
    return status;
}

/* ---- paths --------------------------------------------------------------------------------------------- */
/* A change of crack paths: a copy with room for more pieces; changed: 1: the piece changes; piece: the
 * changed ones. */
typedef struct { pg_crack_paths *fresh; unsigned char *changed; pg_crack *piece; } change;

static pg_status begin (change *c, const pg_state *s, size_t pieces)
{
    pg_status status = PG_OK;
    if (!s->paths) PG_FAIL (PG_E_USAGE, "tips grow and cracks begin so in the plane only");
    PG_ALLOC (c->fresh, 1);
    c->fresh->cracks.dim = 2;
    PG_TRY (pg_crack_paths_reserve (c->fresh, s->paths->cracks.n + pieces));
    PG_GROW (c->fresh->tip, c->fresh->tip_capacity, s->paths->ntip + 2);
    PG_TRY (pg_crack_paths_copy (c->fresh, s->paths));
    PG_ALLOC (c->changed, s->paths->cracks.n + pieces);
    PG_ALLOC (c->piece, s->paths->cracks.n + pieces);
done:
    return status;
}

/* Updates the index, finds the bonds cut, and replaces the paths of the state by the copy. */
static pg_status finish (change *c, pg_state *s, const pg_problem *p, pg_changes *cut)
{
    pg_status status = PG_OK;
    size_t n = 0;
    for (size_t k = 0; k < c->fresh->cracks.n; k++)
        if (c->changed[k]) c->piece[n++] = c->fresh->cracks.crack[k];
    PG_TRY (pg_cracks_index (&c->fresh->cracks));
    PG_TRY (cut_by (s, p, c->piece, n, cut));
    pg_crack_paths *old = s->paths;
    s->paths = c->fresh, c->fresh = old;
done:
    return status;
}

static void end (change *c)
{
    pg_crack_paths_free (&c->fresh);
    pg_free (c->changed), pg_free (c->piece);
}

pg_status pg_crack_grow (pg_state *s, const pg_problem *p, size_t tip, const double *to, int close,
                         pg_changes *cut)
{
    pg_status status = PG_OK;
    const pg_ground g = pg_problem_ground (p);
    change c = { 0 };
    /* room for tips that end here, which are split */
    PG_TRY (begin (&c, s, 2 + (s->paths ? s->paths->ntip : 0)));
    PG_TRY (pg_paths_grow (c.fresh, &g, tip, to, close, c.changed));
    PG_TRY (finish (&c, s, p, cut));
done:
    end (&c);
    return status;
}

pg_status pg_crack_start (pg_state *s, const pg_problem *p, const double *from, const double *to, int open,
                          pg_changes *cut)
{
    pg_status status = PG_OK;
    const pg_ground g = pg_problem_ground (p);
    change c = { 0 };
    PG_TRY (begin (&c, s, 1));
    PG_TRY (pg_paths_start (c.fresh, &g, from, to, open, c.changed));
    PG_TRY (finish (&c, s, p, cut));
done:
    end (&c);
    return status;
}

void pg_tip_draw_back (pg_state *s, const pg_problem *p, size_t tip, double offset)
{
    size_t dim = (size_t) p->dim;
    if (!pg_paths_draw_back (s->paths, tip, offset)) return;
    for (int set = 0; set < PG_BOND_SETS; set++) {
        const pg_rows *rows = &p->bonds.rows[set];
        unsigned char *alive = s->alive + p->bonds.first[set];
        for (size_t q = 0; q < rows->n; q++)
            for (size_t e = rows->family.start[q]; e < rows->family.start[q + 1]; e++)
                if (!alive[e])
                    alive[e] = !pg_cracks_cut (&s->paths->cracks, rows->x + q * dim,
                                               p->cloud.x + (size_t) rows->family.node[e] * dim,
                                               pg_cloud_same (&p->cloud));
    }
}

/* ---- surfaces ------------------------------------------------------------------------------------------ */
static pg_status copy_surfaces (pg_crack_surfaces **fresh, const pg_state *state)
{
    pg_status status = PG_OK;
    if (!state->surfaces)
        PG_FAIL (PG_E_USAGE, "fronts advance and surfaces begin in space only, where cracks grow");
    PG_ALLOC (*fresh, 1);
    PG_TRY (pg_crack_surfaces_copy (*fresh, state->surfaces));
done:
    return status;
}

/* Replaces the surfaces of the state by the changed copy and finds the bonds cut by its new triangles; frees
 * the rest. */
static pg_status take_surfaces (pg_crack_surfaces **fresh, pg_state *state, const pg_problem *p,
                                pg_status changed, pg_changes *cut)
{
    pg_status status = changed;
    if (status != PG_OK) goto done;
    PG_TRY (pg_cracks_index (&(*fresh)->cracks));
    size_t first = state->surfaces->cracks.n;
    PG_TRY (cut_by (state, p, (*fresh)->cracks.crack + first, (*fresh)->cracks.n - first, cut));
    pg_crack_surfaces *old = state->surfaces;
    state->surfaces = *fresh, *fresh = old;
done:
    pg_crack_surfaces_free (fresh);
    return status;
}

pg_status pg_front_advance (pg_state *state, const pg_problem *p, size_t front, const double *d,
                            const double *theta, pg_changes *cut)
{
    const pg_ground g = pg_problem_ground (p);
    pg_crack_surfaces *fresh = NULL;
    pg_status status = copy_surfaces (&fresh, state);
    if (status == PG_OK) status = pg_surfaces_advance (fresh, &g, front, d, theta);
    return take_surfaces (&fresh, state, p, status, cut);
}

pg_status pg_surface_start (pg_state *state, const pg_problem *p, size_t n, const double *x,
                            const double *normal, pg_changes *cut)
{
    const pg_ground g = pg_problem_ground (p);
    pg_crack_surfaces *fresh = NULL;
    pg_status status = copy_surfaces (&fresh, state);
    if (status == PG_OK) status = pg_surfaces_start (fresh, &g, n, x, normal);
    return take_surfaces (&fresh, state, p, status, cut);
}

/* ---- the body around cracks ---------------------------------------------------------------------------- */
pg_ground pg_problem_ground (const pg_problem *p)
{
    return (pg_ground) { .dim = p->dim, .cloud = &p->cloud, .body = &p->body, .between = p->between,
                         .search = p->crack.search, .tip_offset = p->crack.tip_offset,
                         .closed_tip_offset = p->crack.closed_tip_offset };
}

int pg_problem_has_body (const pg_problem *p, const double *x)
{
    const pg_ground g = pg_problem_ground (p);
    return pg_ground_has_body (&g, x);
}

double pg_problem_spacing_at (const pg_problem *p, const double *x)
{
    const pg_ground g = pg_problem_ground (p);
    return pg_ground_spacing_at (&g, x);
}

/* ---- the cracks of a state ----------------------------------------------------------------------------- */
/* A 2D state, or one with growing cracks, has its own cracks; else they are those of the scene. */
const pg_cracks *pg_state_cracks (const pg_problem *problem, const pg_state *state)
{
    if (state && state->paths) return &state->paths->cracks;
    return state && state->surfaces ? &state->surfaces->cracks : &problem->crack.given;
}

const pg_front *pg_fronts_of_state (const pg_problem *problem, const pg_state *state, size_t *n)
{
    const pg_crack_surfaces *w = state ? state->surfaces : NULL;
    *n = w ? w->nfront : problem->crack.nfront;
    return w ? w->front : problem->crack.front;
}

/* ---- borders of background cells ----------------------------------------------------------------------- */
/* Integrals over faces of cracks are sums over the pieces between borders of cells, in contact
 * (contact/pieces.c) as in cells cut off at cracks (galerkin_ended_plan.c), so that both use the same
 * displacement. */
pg_status pg_crack_breaks (const pg_problem *p, const double *a, const double *b, size_t *n, double **share)
{
    pg_status status = PG_OK;
    double *all = NULL, nothing = pg_cloud_same (&p->cloud), length = hypot (b[0] - a[0], b[1] - a[1]), in[2];
    size_t cap = 0, count = 2, kept = 0;
    PG_GROW (all, cap, 2);
    all[0] = 0, all[1] = 1;
    for (size_t c = 0; p->form.consistency && p->dim == 2 && c < p->cells.n; c++) {
        if (!pg_cell_clip (&p->cells, c, a, b, nothing, in)) continue;
        PG_GROW (all, cap, count + 2);
        all[count++] = in[0], all[count++] = in[1];
    }
    pg_sort (all, count, sizeof *all, pg_ascending_numbers);
    for (size_t i = 0; i < count; i++)
        if (i == 0 || (all[i] - all[kept - 1]) * length > 8 * nothing) all[kept++] = all[i];
    all[kept - 1] = 1;
    *n = kept, *share = all, all = NULL;
done:
    pg_free (all);
    return status;
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * The bond sets: node-node, evaluation point-node, facet point-node (Cui 2022 section 3.1; theory F1), and
 * their exemptions. Which bonds are alive: alive_mask.c. */
#include "model.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Finds owner and global number of evaluation points and facet points: owned by the rank of their cell (of a
 * facet the cell behind it); number = (number of the cell in the whole body) * PLACES + index among the
 * points of the cell. */
enum { PLACES = 4096 };
static pg_status number_points (const pg_problem *p, int set, unsigned char *owned, int64_t *out)
{
    pg_status status = PG_OK;
    const pg_rows *r = &p->bonds.rows[set];
    const pg_cells *c = &p->cells;
    size_t dim = (size_t) p->dim, last = SIZE_MAX;
    int64_t place = 0, number = 0;
    int own = 0;
    for (size_t q = 0; q < r->n; q++, place++) {
        size_t cell = set == PG_POINTS ? (size_t) r->cell[q] : (size_t) c->facet_cell[r->cell[q]];
        if (cell != last) {
            double middle[3] = { 0 };
            for (size_t k = c->start[cell]; k < c->start[cell + 1]; k++)
                for (size_t a = 0; a < dim; a++)
                    middle[a] += c->x[k * dim + a] / (double) (c->start[cell + 1] - c->start[cell]);
            number = c->number        ? c->number[cell]
                     : p->lattice.dim ? pg_lattice_cell (&p->lattice, middle)
                                      : (int64_t) cell;
            own = c->owned ? c->owned[cell] : pg_lattice_owns (&p->lattice, p->cloud.subdomain, middle);
            last = cell, place = 0;
        }
        if (place == PLACES) PG_FAIL (PG_E_LIMIT, "more than %d points of a cell are too many", PLACES);
        if (owned) owned[q] = (unsigned char) own;
        out[q] = number * PLACES + place;
    }
done:
    return status;
}

/* Parallel runs: finds which points of a set this rank owns, and their global numbers. */
static pg_status number_held (pg_problem *p, int set)
{
    pg_status status = PG_OK;
    const pg_subdomain *s = p->cloud.subdomain;
    size_t n = p->bonds.rows[set].n;
    if (!s) return PG_OK;
    PG_ALLOC (p->bonds.held[set].owned, n);
    PG_ALLOC (p->bonds.held[set].number, n);
    if (set != PG_NODES) PG_TRY (number_points (p, set, p->bonds.held[set].owned, p->bonds.held[set].number));
    else {
        memcpy (p->bonds.held[set].owned, s->owned, n);
        memcpy (p->bonds.held[set].number, s->number, n * sizeof *s->number);
    }
done:
    return status;
}

/* Number of a point for messages: for a node its global number. */
static size_t number_of (const pg_problem *p, int set, size_t point)
{
    return set == PG_NODES && p->bonds.held[set].number ? (size_t) p->bonds.held[set].number[point] : point;
}

/* Warns of points with too few neighbours even with the widest supports: number of those owned by this rank,
 * coordinates of the first. owned NULL: all are. */
static void tell_blind (pg_problem *p, const char *what, const pg_rows *r, const pg_widened *w,
                        const unsigned char *owned)
{
    size_t own = 0, first = 0, dim = (size_t) p->dim;
    char at[100] = "";
    int used = 0;
    for (size_t k = w->nblind; k-- > 0;) if (!owned || owned[w->blind[k]]) own++, first = w->blind[k];
    for (size_t k = 0; own && k < dim; k++)
        used += snprintf (at + used, sizeof at - (size_t) used, k ? ", %.6g" : "%.6g", r->x[first * dim + k]);
    if (own)
        pg_problem_note (p,
                         PG_WARNING "%zu %s%s, such as that at (%s) m, see%s too little for a strain even "
                                    "within %g horizons: the body, or what cracks leave of it, is thinner "
                                    "there than the spacing; use a smaller "
                                    "spacing",
                         own, what, own == 1 ? "" : "s", at, own == 1 ? "s" : "", PG_WIDEST_SUPPORT);
}

/* Points of a set; near: 1: a crack is so near that it may lie between the point and a node (n). */
typedef struct { const pg_problem *p; const pg_rows *rows; unsigned char *near; } looking;

/* Returns 1: no crack or slot cuts the bond from point `place` to a node at the start of the run. */
static int sees (void *context, size_t place, int node)
{
    const looking *l = context;
    size_t dim = (size_t) l->p->dim;
    return !l->near[place] || node == l->rows->own[place]
           || !pg_bond_cut_first (l->p, l->rows->x + place * dim, l->p->cloud.x + (size_t) node * dim);
}

/* Finds the points whose widest supports reach a crack. */
static pg_status find_near (looking *l)
{
    pg_status status = PG_OK;
    const pg_problem *p = l->p;
    size_t dim = (size_t) p->dim;
    double low[3], high[3], ratio = 1;
    for (size_t i = 0; p->cloud.size && i < p->cloud.n; i++)
        ratio = fmax (ratio, pg_cloud_ratio (&p->cloud, i));
    PG_ALLOC (l->near, l->rows->n);
    for (size_t q = 0; q < l->rows->n; q++) {
        for (size_t k = 0; k < dim; k++) {
            double reach = PG_WIDEST_SUPPORT * ratio * p->form.approx.horizon;
            low[k] = l->rows->x[q * dim + k] - reach, high[k] = l->rows->x[q * dim + k] + reach;
        }
        l->near[q] = pg_cracks_near (pg_state_cracks (p, NULL), low, high)
                     || pg_cracks_near (&p->crack.slots, low, high);
    }
done:
    return status;
}

/* Returns 1: a crack or slot cuts a bond of point q. */
static int is_beside (looking *l, size_t q)
{
    const pg_family *f = &l->rows->family;
    for (size_t e = f->start[q]; l->near[q] && e < f->start[q + 1]; e++)
        if (!sees (l, q, f->node[e])) return 1;
    return 0;
}

/* Sets wide_at_cracks if, on any rank, the support of a point with bonds cut by a crack has been widened. */
static pg_status note_wide (pg_problem *p, looking *l)
{
    pg_status status = PG_OK;
    const pg_rows *r = l->rows;
    double wide = 0;
    for (size_t q = 0; r->wide && q < r->n && wide == 0; q++) wide = r->wide[q] > 1 && is_beside (l, q);
    PG_TRY (pg_cloud_sum (&p->cloud, 1, &wide));
    if (wide > 0) p->bonds.wide_at_cracks = 1;
done:
    return status;
}

/* Widens the supports of points of a set with too few neighbours, at the surface or beside a crack. Warns of
 * points that still have too few, except for nodes and evaluation points beside cracks, which are reported
 * during the run. */
static pg_status widen (pg_problem *p, int set)
{
    static const char *const what[PG_BOND_SETS] = { "point", "evaluation point", "boundary point" };
    pg_status status = PG_OK;
    pg_widened w = { 0 };
    looking l = { .p = p, .rows = &p->bonds.rows[set] };
    int cracked = p->crack.given.n + p->crack.slots.n > 0;
    if (cracked) PG_TRY (find_near (&l));
    PG_TRY (pg_rows_widen (&p->bonds.rows[set], &p->form.approx, &p->cloud, cracked ? sees : NULL, &l,
                           p->threads, &w));
    if (cracked && set != PG_FACETS) PG_TRY (note_wide (p, &l));
    size_t blind = w.nblind;
    w.nblind = 0;
    for (size_t k = 0; k < blind; k++)
        if (!cracked || set == PG_FACETS || !is_beside (&l, w.blind[k])) w.blind[w.nblind++] = w.blind[k];
    tell_blind (p, what[set], &p->bonds.rows[set], &w, p->bonds.held[set].owned);
done:
    pg_free (w.blind), pg_free (l.near);
    return status;
}

/* Points without a lattice: checks that every point has enough neighbours, which span the space, for a
 * strain, by the grades of linear shape functions; reports the first point without as an error. */
static pg_status check_support (pg_problem *p, const pg_scene *scene, int set)
{
    static const char *const what[PG_BOND_SETS] = { "point", "evaluation point", "boundary point" };
    pg_status status = PG_OK;
    pg_rows *r = &p->bonds.rows[set];
    pg_approx linear = p->form.approx;
    char at[100];
    linear.order = 1;
    if (p->lattice.dim) return PG_OK;
    PG_ALLOC (r->grade, r->n);                         /* freed after this check */
    if (r->n)
        PG_TRY (linear.type->evaluate (&linear, &p->cloud, r, NULL, r->n, NULL, p->threads));
    for (size_t q = 0; q < r->n && status == PG_OK; q++) {
        int used = 0;
        if (r->grade[q] < PG_GRADE_PROJECTED || (p->bonds.held[set].owned && !p->bonds.held[set].owned[q]))
            continue;
        for (int k = 0; k < p->dim; k++)
            used += snprintf (at + used, sizeof at - (size_t) used, k ? ", %.6g" : "%.6g",
                              r->x[q * (size_t) p->dim + (size_t) k]);
        pg_scene_fault (
            scene, "method.horizon",
            "%s %zu at (%s) m sees %zu points, too few or too flat a set for a strain: use a larger horizon "
            "or %s",
            what[set], number_of (p, set, q) + 1, at, r->family.start[q + 1] - r->family.start[q],
            p->cloud.size ? "larger spacings of the points there"
                          : "a column spacing in the file of points, which the horizon of each then follows");
        status = pg_scene_verdict (scene);
    }
    status = pg_ranks_agree (status);
done:
    pg_free (r->grade), r->grade = NULL;
    return status;
}

/* Makes the bond set PG_NODES: shape functions at the nodes themselves. */
static pg_status make_nodes (pg_problem *p, const pg_family_search *search, const pg_scene *scene)
{
    pg_status status = PG_OK;
    int *own = NULL;
    PG_ALLOC (own, p->cloud.n);
    for (size_t i = 0; i < p->cloud.n; i++) own[i] = (int) i;
    PG_TRY (pg_rows_place (&p->bonds.rows[PG_NODES], search, &p->cloud, p->cloud.n, p->cloud.x,
                           p->cloud.volume, own, NULL, NULL, p->threads));
    PG_TRY (number_held (p, PG_NODES));
    PG_TRY (widen (p, PG_NODES));
    PG_TRY (check_support (p, scene, PG_NODES));
done:
    pg_free (own);
    return status;
}

/* Gauss points per direction of a cell: as many as the basis needs between two nodes; an element with
 * mid-edge nodes spans two such steps. */
static int quadrature_order (const pg_problem *p)
{
    /* at most 5, the highest rule there is */
    return p->form.approx.order + 1 + pg_mesh_body_halved (&p->part) * 2;
}

/* Gauss points per direction of a cell: as given in the scene, else as the basis needs. */
static int gauss_order (const pg_problem *p, const pg_scene *scene)
{
    return pg_scene_given (scene, "method.gauss_points")
               ? (int) pg_scene_integer (scene, "method.gauss_points")
               : quadrature_order (p);
}

/* Gauss points per direction of a facet: with cut cells at least as many as in the cells, as linear fields
 * are in equilibrium only then. */
static int facet_order (const pg_problem *p, const pg_scene *scene)
{
    int order = quadrature_order (p), fine = gauss_order (p, scene);
    return p->cells.cut && fine > order ? fine : order;
}

/* Makes the bond set PG_POINTS with weights (m^3), and the tables of consistent integration. */
static pg_status make_points (pg_problem *p, const pg_family_search *search, const pg_scene *scene)
{
    pg_status status = PG_OK;
    pg_quadrature q = { 0 };
    /* at least 3 per direction: with 2 the divergence identity amplifies the error of thin pieces */
    p->cells.cut_order = p->form.integration->consistent ? 3 : 0;
    if (!p->form.integration->at_nodes)
        PG_TRY (p->form.integration->points (&q, &p->cells, p->cloud.thickness, gauss_order (p, scene)));
    PG_TRY (pg_rows_place (&p->bonds.rows[PG_POINTS], search, &p->cloud, q.n, q.x, q.weight, NULL, q.cell,
                           NULL, p->threads));
    PG_TRY (number_held (p, PG_POINTS));
    PG_TRY (widen (p, PG_POINTS));
    PG_TRY (check_support (p, scene, PG_POINTS));
    if (!p->form.integration->consistent) goto done;
    PG_TRY (pg_consistency_create (&p->form.consistency, &p->cells, &p->form.approx, &p->cloud,
                                   &p->bonds.rows[PG_POINTS], facet_order (p, scene), p->threads));
    tell_blind (p, "face point", &p->form.consistency->face, &p->form.consistency->widened, NULL);
done:
    pg_quadrature_clear (&q);
    return status;
}

/* Makes the bond set PG_FACETS with weights (m^2) and outward normals, on facets with a load or support
 * only. */
static pg_status make_facets (pg_problem *p, const pg_family_search *search, const pg_scene *scene)
{
    pg_status status = PG_OK;
    pg_quadrature q = { 0 };
    unsigned char *used = NULL;
    double *eye = NULL;
    size_t keep = 0, dim = (size_t) p->dim;
    PG_ALLOC (used, p->cells.nfacet);
    for (size_t l = 0; l < p->boundary.nload; l++) {
        const pg_load *load = &p->boundary.load[l];
        int needs = load->kind == PG_TRACTION || load->kind == PG_PRESSURE
                    || (pg_load_prescribes (load) && load->essential == PG_ESSENTIAL_NITSCHE);
        for (size_t k = 0; needs && k < load->set->nfacet; k++) used[load->set->facet[k]] = 1;
        for (size_t k = 0; load->cracks && k < p->cells.nfacet; k++) used[k] = 1;
    }
    p->bonds.facet_order = facet_order (p, scene);
    PG_TRY (pg_facet_points (&q, &p->cells, p->bonds.facet_order));
    for (size_t k = 0; k < q.n; k++) {
        if (!used[q.cell[k]]) continue;
        memmove (q.x + keep * dim, q.x + k * dim, dim * sizeof *q.x);
        memmove (q.normal + keep * dim, q.normal + k * dim, dim * sizeof *q.normal);
        q.weight[keep] = q.weight[k], q.cell[keep++] = q.cell[k];
    }
    PG_TRY (pg_rows_eyes (&eye, &p->cloud, keep, q.x, q.normal));
    PG_TRY (pg_rows_place (&p->bonds.rows[PG_FACETS], search, &p->cloud, keep, q.x, q.weight, NULL, q.cell,
                           eye, p->threads));
    PG_TRY (number_held (p, PG_FACETS));
    PG_TRY (widen (p, PG_FACETS));
    PG_TRY (check_support (p, scene, PG_FACETS));
    pg_consistency_normals (p->form.consistency, &p->bonds.rows[PG_FACETS], q.normal);
    p->bonds.facet_normal = q.normal, q.normal = NULL;
done:
    pg_quadrature_clear (&q);
    pg_free (used), pg_free (eye);
    return status;
}

/* Squared distance between x and a node, m^2. */
static double distance2 (const pg_problem *p, const double *x, int node)
{
    double s = 0;
    for (int k = 0; k < p->dim; k++) {
        double d = p->cloud.x[(size_t) node * (size_t) p->dim + (size_t) k] - x[k];
        s += d * d;
    }
    return s;
}

/* The node of its family that is nearest to a point, -1: it has none. Ties go to the first, so that the
 * answer is always the same. */
int pg_bonds_nearest (const pg_problem *p, int set, size_t point)
{
    const pg_family *f = &p->bonds.rows[set].family;
    const double *x = p->bonds.rows[set].x + point * (size_t) p->dim;
    int nearest = -1;
    for (size_t e = f->start[point]; e < f->start[point + 1]; e++)
        if (nearest < 0 || distance2 (p, x, f->node[e]) < distance2 (p, x, nearest)) nearest = f->node[e];
    return nearest;
}

/* Sets the local spacing of every point of every set, m: that of its nearest node; only if spacings
 * differ. */
static pg_status measure_spacing (pg_problem *p)
{
    pg_status status = PG_OK;
    for (int s = 0; s < PG_BOND_SETS && p->cloud.size; s++) {
        PG_ALLOC (p->bonds.spacing[s], p->bonds.rows[s].n);
        for (size_t q = 0; q < p->bonds.rows[s].n; q++) {
            int nearest = s == PG_NODES ? (int) q : pg_bonds_nearest (p, s, q);
            p->bonds.spacing[s][q] = nearest < 0 ? p->cloud.h : p->cloud.size[nearest];
        }
    }
done:
    return status;
}

/* Local spacing at a point of a set, m: that of its nearest node where spacings differ. */
double pg_problem_spacing (const pg_problem *p, int set, size_t point)
{
    return p->bonds.spacing[set] ? p->bonds.spacing[set][point] : p->cloud.h;
}

/* 1: bond e of the point has zero length (an evaluation point on a node), so that its stretch is
 * undefined. */
int pg_problem_no_bond (const pg_problem *p, int set, size_t point, size_t e)
{
    const pg_rows *r = &p->bonds.rows[set];
    int j = r->family.node[e];
    double least = PG_NO_LENGTH * pg_problem_spacing (p, set, point);
    return j == r->own[point] || distance2 (p, r->x + point * (size_t) p->dim, j) <= least * least;
}

/* Marks points whose bonds never break: nodes of excluded sets, other points like their nearest node. A
 * material that never breaks exempts its points. */
static pg_status make_exempt (pg_problem *p, const pg_scene *scene)
{
    pg_status status = PG_OK;
    const char *name;
    int excluded = 0;
    for (int s = 0; s < PG_BOND_SETS; s++) PG_ALLOC (p->bonds.exempt[s], p->bonds.rows[s].n);
    for (size_t k = 0; (name = pg_scene_name (scene, k, "failure.exclude")); k++) {
        char path[64];
        snprintf (path, sizeof path, "failure.exclude[%zu]", k);
        const pg_set *set = pg_sets_named (&p->sets, scene, path, name);
        if (set && pg_set_points (set) == 0 && !pg_sets_empty_side (&p->sets, set))
            pg_scene_fault (scene, path, "%s is a set without points", name);
        if (!set) continue;
        for (size_t i = 0; i < set->npoint; i++) p->bonds.exempt[PG_NODES][set->point[i]] = 1;
        excluded |= set->npoint > 0;
    }
    for (int s = PG_POINTS; s < PG_BOND_SETS && excluded; s++)
        for (size_t q = 0; q < p->bonds.rows[s].n; q++) {
            int nearest = pg_bonds_nearest (p, s, q);
            p->bonds.exempt[s][q] = nearest >= 0 && p->bonds.exempt[PG_NODES][nearest];
        }
    for (int s = 0; s < PG_BOND_SETS; s++)
        for (size_t q = 0; q < p->bonds.rows[s].n; q++)
            p->bonds.exempt[s][q] |= (unsigned char) (p->criterion[p->block[s][q]].never != 0);
done:
    return status;
}

/* Makes the bonds of forces without shape functions: point to point, from pg_sums; sets of evaluation points
 * and facets are empty. */
static pg_status make_point_bonds (pg_problem *p)
{
    pg_status status = PG_OK;
    pg_rows *r = &p->bonds.rows[PG_NODES];
    size_t n = p->cloud.n, dim = (size_t) p->dim;
    *r = (pg_rows) { .dim = p->dim, .n = n };
    PG_ALLOC (r->x, n * dim);
    PG_ALLOC (r->weight, n);
    PG_ALLOC (r->own, n);
    PG_ALLOC (r->cell, n);
    memcpy (r->x, p->cloud.x, n * dim * sizeof *r->x);
    memcpy (r->weight, p->cloud.volume, n * sizeof *r->weight);
    for (size_t i = 0; i < n; i++) r->own[i] = (int) i, r->cell[i] = -1;
    PG_TRY (pg_sums_family (&r->family, p->sums, &r->parted));
    PG_TRY (number_held (p, PG_NODES));
    for (int s = PG_POINTS; s < PG_BOND_SETS; s++)
        PG_TRY (pg_rows_create (&p->bonds.rows[s], &p->form.approx, &p->cloud, 0, NULL, NULL, NULL, NULL));
    PG_ALLOC (p->bonds.facet_normal, 0);
done:
    return status;
}

/* Forces without shape functions: reports the first point without bonds as an error, as K would be
 * singular. */
static pg_status check_company (const pg_problem *p, const pg_scene *scene)
{
    pg_status status = PG_OK;
    const pg_family *f = &p->bonds.rows[PG_NODES].family;
    for (size_t i = 0; i < f->n && status == PG_OK; i++) {
        if (f->start[i + 1] > f->start[i] || !pg_cloud_owns (&p->cloud, i)) continue;
        const double *x = p->cloud.x + i * (size_t) p->dim;
        pg_scene_fault (scene, "method.horizon",
                        "point %zu at (%.6g, %.6g, %.6g) m sees no other point within its horizon, %.6g m: "
                        "use a larger horizon",
                        pg_cloud_number (&p->cloud, i) + 1, x[0], p->dim > 1 ? x[1] : 0,
                        p->dim > 2 ? x[2] : 0,
                        p->form.approx.horizon * pg_cloud_ratio (&p->cloud, i));
        status = pg_scene_verdict (scene);
    }
    return pg_ranks_agree (status);
}

/* Counts the points on pre-cracks, which lose their bonds to both sides. The warning suggests a shift of the
 * lattice by half a step across the first such crack. */
static pg_status count_eroded (pg_problem *p, const pg_scene *scene)
{
    pg_status status = PG_OK;
    const pg_crack *first = NULL;
    double eroded = 0;
    char way[96] = "move them off it";
    for (size_t i = 0; i < p->cloud.n; i++) {
        const pg_crack *on = pg_cracks_touch (pg_state_cracks (p, NULL),
                                              p->cloud.x + i * (size_t) p->dim, pg_cloud_same (&p->cloud));
        eroded += on && pg_cloud_owns (&p->cloud, i);
        if (!first) first = on;
    }
    const pg_crack *list = pg_state_cracks (p, NULL)->crack;
    double which = first ? -(double) (first - list) : -INFINITY;
    PG_TRY (pg_ranks_sum (1, &eroded));
    PG_TRY (pg_ranks_most (1, &which));
    p->crack.eroded = (size_t) eroded;
    if (!p->crack.eroded) return PG_OK;
    first = list - (long) which;
    if (p->lattice.dim) {
        int across = 0, n = 0;
        for (int k = 1; k < p->dim; k++)
            if (fabs (first->normal[k]) > fabs (first->normal[across]) * (1 + 1e-9)) across = k;
        n = snprintf (way, sizeof way, "%s [",
                      pg_scene_given (scene, "lattice_offset") ? "lattice_offset more by"
                                                               : "lattice_offset:");
        for (int k = 0; k < p->dim; k++)
            n += snprintf (way + n, sizeof way - (size_t) n, "%s%s", k ? ", " : "",
                           k == across ? "0.5" : "0");
        snprintf (way + n, sizeof way - (size_t) n, "] puts it between them");
    }
    pg_problem_note (p,
                     PG_WARNING "%zu point%s on a pre-crack and lose%s all bonds to both sides, as if the "
                                "crack were a spacing wide; %s",
                     p->crack.eroded, p->crack.eroded == 1 ? " lies" : "s lie",
                     p->crack.eroded == 1 ? "s" : "", way);
done:
    return status;
}

/* Notes how many pairs of points within a horizon have no bond, as a slot, gap or corner lies between them;
 * pairs of nodes count once. */
static pg_status note_parted (pg_problem *p)
{
    pg_status status = PG_OK;
    double n[PG_BOND_SETS] = { 0 };
    int alone = !p->method->shape_functions;
    for (int s = 0; s < PG_BOND_SETS; s++) n[s] = (double) p->bonds.rows[s].parted;
    PG_TRY (pg_cloud_sum (&p->cloud, PG_BOND_SETS, n));
    double all = alone ? n[PG_NODES] / 2 : n[PG_NODES] / 2 + n[PG_POINTS] + n[PG_FACETS];
    if (all > 0)
        pg_problem_note (p,
                         "what lies between two points is asked: %.0f bonds across slots, gaps and corners "
                         "of the body are none%s",
                         all, p->cloud.subdomain ? " (those of ghosts counted again)" : "");
done:
    return status;
}

/* Notes, for points of a file, their total volume and its ratio to that of their bounding box. */
static pg_status note_volume (pg_problem *p, const pg_scene *scene)
{
    pg_status status = PG_OK;
    const pg_cloud *c = &p->cloud;
    double total = 0, box = c->thickness;
    if (!pg_scene_given (scene, "points")) return PG_OK;
    for (size_t i = 0; i < c->n; i++) total += pg_cloud_owns (c, i) ? c->volume[i] : 0;
    PG_TRY (pg_ranks_sum (1, &total));
    for (int k = 0; k < c->dim; k++) box *= c->high[k] - c->low[k] + c->h;
    pg_problem_note (p, "%svolume of all points %.6g m^3, %.3g of the box around them%s",
                     total > 1.5 * box ? PG_WARNING : "", total, total / box,
                     total > 1.5 * box ? ": look at the columns of the file and their units" : "");
done:
    return status;
}

/* Numbers nodes by their line in the file of points, or by their lattice site (empty sites counted). */
static void number_nodes (const pg_problem *p, int64_t *out)
{
    const pg_cloud *c = &p->cloud;
    const pg_lattice *l = &p->lattice;
    for (size_t i = 0; i < c->n; i++) {
        int64_t number = 0;
        for (int k = l->dim - 1; k >= 0; k--) {
            /* a point may have been moved from its site, by less than half a step */
            double at = (c->x[i * (size_t) c->dim + (size_t) k] - l->origin[k]) / l->step[k];
            number = number * (l->count[k] + !c->centred) + llround (c->centred ? at - 0.5 : at);
        }
        out[i] = l->dim ? number : (int64_t) i;
    }
}

pg_status pg_problem_numbers (const pg_problem *p, int set, int64_t **out)
{
    pg_status status = PG_OK;
    size_t n = set == PG_NODES ? p->cloud.n : p->bonds.rows[set].n;
    int64_t *number = NULL;
    if (set != PG_NODES && n && !p->bonds.held[set].number && (!p->bonds.rows[set].cell || !p->cells.n))
        PG_FAIL (PG_E_LIMIT, "points that belong to no cell have no numbers");
    PG_ALLOC (number, n);
    if (p->bonds.held[set].number) memcpy (number, p->bonds.held[set].number, n * sizeof *number);
    else if (set == PG_NODES) number_nodes (p, number);
    else PG_TRY (number_points (p, set, NULL, number));
    *out = number;
    number = NULL;
done:
    pg_free (number);
    return status;
}

/* Builds the rows of all bond sets, and what depends on them: spacings, blocks, laws, dilatation, exempt
 * points. */
pg_status pg_bonds_build (pg_problem *p, const pg_scene *scene)
{
    pg_status status = PG_OK;
    pg_family_search *search = NULL;
    if (!p->method->shape_functions) {
        PG_TRY (make_point_bonds (p));
        PG_TRY (check_company (p, scene));
    } else {
        PG_TRY (pg_rows_search (&search, &p->form.approx, &p->cloud));
        PG_TRY (make_nodes (p, search, scene));
        PG_TRY (make_points (p, search, scene));
        PG_TRY (make_facets (p, search, scene));
    }
    for (int s = 0; s < PG_BOND_SETS; s++)
        p->bonds.first[s + 1] = p->bonds.first[s] + p->bonds.rows[s].family.start[p->bonds.rows[s].n];
    PG_TRY (measure_spacing (p));
    PG_TRY (pg_blocks_build (p, scene));
    PG_TRY (pg_laws_build (p, scene));
    PG_TRY (pg_dilatation_build (p, scene));
    PG_TRY (make_exempt (p, scene));
    PG_TRY (count_eroded (p, scene));
    PG_TRY (note_parted (p));
    PG_TRY (note_volume (p, scene));
done:
    pg_family_search_free (&search);
    return status;
}

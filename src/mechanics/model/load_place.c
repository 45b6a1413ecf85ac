/* SPDX-License-Identifier: GPL-3.0-or-later
 * Where loads act: reference points of moments, forces at positions between points, planes of symmetry, rigid
 * rotations of sets, gravity. */
#include "model.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- moments ------------------------------------------------------------------------------------------- */
void pg_load_add_moment (const pg_load *load, int dim, const double *x, int k, double force, double *moment)
{
    double arm[3] = { 0 };
    for (int c = 0; c < dim; c++) arm[c] = x[c] - load->about[c];
    /* moment += arm x (force e_k) */
    int next = (k + 1) % 3, last = (k + 2) % 3;
    moment[next] += arm[last] * force;
    moment[last] -= arm[next] * force;
}

/* Ownership of a facet follows from the cell half a step behind its centre. */
int pg_problem_owns_facet (const pg_problem *p, size_t facet)
{
    size_t dim = (size_t) p->dim;
    double behind[3] = { 0 };
    if (p->cells.owned) return p->cells.owned[p->cells.facet_cell[facet]];
    for (size_t k = 0; k < dim; k++)
        behind[k] = p->cells.facet_centre[facet * dim + k]
                    - 0.5 * p->cloud.step[k] * p->cells.normal[facet * dim + k];
    return pg_lattice_owns (&p->lattice, p->cloud.subdomain, behind);
}

/* Centroid of a set, m, over all ranks: of its facets weighted by area, or of its points weighted by
 * volume. */
static pg_status centre_of (const pg_problem *p, const pg_set *set, int on_facets, double *centre)
{
    pg_status status = PG_OK;
    size_t dim = (size_t) p->dim, n = on_facets ? set->nfacet : set->npoint;
    double whole = 0, all[4];
    memset (centre, 0, 3 * sizeof *centre);
    for (size_t i = 0; i < n; i++) {
        size_t item = (size_t) (on_facets ? set->facet[i] : set->point[i]);
        if (!(on_facets ? pg_problem_owns_facet (p, item) : pg_cloud_owns (&p->cloud, item))) continue;
        double weight = on_facets ? p->cells.area[item] : p->cloud.volume[item];
        const double *x = (on_facets ? p->cells.facet_centre : p->cloud.x) + item * dim;
        for (size_t k = 0; k < dim; k++) centre[k] += weight * x[k];
        whole += weight;
    }
    memcpy (all, centre, 3 * sizeof *all), all[3] = whole;
    PG_TRY (pg_ranks_sum (4, all));
    for (size_t k = 0; k < dim; k++) centre[k] = all[3] > 0 ? all[k] / all[3] : 0;
done:
    return status;
}

/* Converts a total force on a set of faces to a uniform traction; equal shares of its points would act up to
 * half a spacing inside the body, and as strongly at a corner as elsewhere. */
pg_status pg_load_spread_force (const pg_problem *p, pg_load *load)
{
    pg_status status = PG_OK;
    double area = 0;
    if (load->kind != PG_POINT_FORCE || !load->set->by_faces || pg_set_facets (load->set) == 0) return PG_OK;
    for (size_t i = 0; i < load->set->nfacet; i++)
        if (pg_problem_owns_facet (p, (size_t) load->set->facet[i]))
            area += p->cells.area[load->set->facet[i]];
    PG_TRY (pg_ranks_sum (1, &area));
    if (area > 0) load->kind = PG_TRACTION, load->over_area = area;
done:
    return status;
}

/* Sets load->about to boundary[].about, or to the centroid of the set. */
pg_status pg_load_centre (const pg_problem *p, pg_load *load, const pg_scene *scene, size_t i)
{
    pg_status status = PG_OK;
    char path[64];
    snprintf (path, sizeof path, "boundary[%zu].about", i);
    if (load->own) memcpy (load->about, load->at, sizeof load->about);
    else PG_TRY (centre_of (p, load->set, pg_set_facets (load->set) > 0, load->about));
    if (!pg_scene_given (scene, "%s", path)) goto done;
    if (p->dim < 2 || pg_load_rotates (load) || load->cracks || load->kind == PG_EIGENSTRAIN) {
        pg_scene_fault (scene, path, "is the place that moments of forces are about, which %s has none of",
                        p->dim < 2              ? "a bar"
                        : pg_load_rotates (load) ? "a rotation or moment of points"
                        : load->cracks           ? "a pressure in cracks"
                                                 : "a free strain");
        goto done;
    }
    memset (load->about, 0, sizeof load->about);
    pg_scene_vector (scene, 3, load->about, "%s", path);
done:
    return status;
}

/* Reads one angle of a rigid rotation (a function of t only) and marks the components of displacement that it
 * prescribes. */
static pg_status read_angle (const pg_problem *p, pg_load *load, const pg_scene *scene, const char *path,
                             int axis)
{
    pg_status status = PG_OK;
    int places = 0;
    if (p->dim < 2 || (p->dim == 2 && axis < 2)) {
        pg_scene_fault (scene, path, p->dim < 2 ? "a bar does not turn" : "a plane turns about z alone");
        return PG_OK;
    }
    PG_TRY (pg_expression_compile (&load->angle[axis], pg_scene_text (scene, "%s", path), "rad"));
    for (const char *c = "xyzra"; *c; c++) places |= pg_expression_uses (load->angle[axis], *c);
    if (places) pg_scene_fault (scene, path, "a set turns as a rigid body: an expression of t alone");
    if (pg_expression_uses (load->angle[axis], 't')) load->proportional = 0;
    for (int k = 0; k < p->dim; k++)
        if (k != axis && !load->value[k]) PG_TRY (pg_expression_compile (&load->value[k], "0", "m"));
done:
    return status;
}

/* Reads boundary[].turn. Displacements of finite rotations are not proportional to the load factor. */
pg_status pg_load_read_turn (const pg_problem *p, pg_load *load, const pg_scene *scene, size_t i)
{
    pg_status status = PG_OK;
    char path[64];
    int found = 0;
    load->turns = 1;
    for (int axis = 0; axis < 3; axis++) {
        snprintf (path, sizeof path, "boundary[%zu].turn.%c", i, "xyz"[axis]);
        if (!pg_scene_given (scene, "%s", path)) continue;
        found = 1;
        PG_TRY (read_angle (p, load, scene, path, axis));
    }
    snprintf (path, sizeof path, "boundary[%zu].turn", i);
    if (!found) pg_scene_fault (scene, path, "at least one component x, y, z is needed");
    load->finite = p->sums && p->sums->rule.finite;
    if (load->finite) load->proportional = 0;
done:
    return status;
}

/* ---- planes of symmetry -------------------------------------------------------------------------------- */
/* Finds the axis normal to the plane of a set (of all its facets, or of points with equal coordinates), over
 * all ranks; *place: its coordinate, m. *found -1: none, -2: several. */
static pg_status axis_of (const pg_problem *p, const pg_set *set, double *place, int *found)
{
    pg_status status = PG_OK;
    int on_facets = pg_set_facets (set) > 0;
    size_t dim = (size_t) p->dim, n = on_facets ? set->nfacet : set->npoint;
    double most[9];  /* per axis: -lowest, highest coordinate, -least |normal| */
    for (size_t k = 0; k < 3; k++) most[k] = most[3 + k] = -INFINITY, most[6 + k] = -1;
    for (size_t k = 0; k < dim; k++)
        for (size_t i = 0; i < n; i++) {
            size_t item = (size_t) (on_facets ? set->facet[i] : set->point[i]);
            double x = (on_facets ? p->cells.facet_centre : p->cloud.x)[item * dim + k];
            most[k] = fmax (most[k], -x), most[3 + k] = fmax (most[3 + k], x);
            if (on_facets) most[6 + k] = fmax (most[6 + k], -fabs (p->cells.normal[item * dim + k]));
        }
    PG_TRY (pg_ranks_most (9, most));
    *found = -1;
    for (size_t k = 0; k < dim; k++) {
        if (most[3 + k] + most[k] > 1e-6 * p->cloud.h || most[6 + k] > -(1 - 1e-6)) continue;
        *place = -most[k], *found = *found >= 0 ? -2 : (int) k;
        if (*found == -2) break;
    }
done:
    return status;
}

/* Reads boundary[].symmetry: zero displacement normal to the plane. Forces without shape functions constrain
 * points where they are, so that these should lie on the plane. */
pg_status pg_load_read_symmetry (pg_problem *p, pg_load *load, const pg_scene *scene, size_t i)
{
    pg_status status = PG_OK;
    char path[64];
    double place = 0, away = 0;
    snprintf (path, sizeof path, "boundary[%zu].symmetry", i);
    if (!pg_scene_bool (scene, "%s", path)) {
        pg_scene_fault (scene, path, "off says nothing: leave the entry out");
        return PG_OK;
    }
    int k = 0;
    if (pg_set_points (load->set) + pg_set_facets (load->set)) PG_TRY (axis_of (p, load->set, &place, &k));
    if (k < 0) {
        pg_scene_fault (scene, path,
                        k == -1 ? "%s does not lie in one plane across x, y or z: turn the body so that the "
                                  "plane of symmetry is across an axis, and give each plane an entry of "
                                  "its own"
                                : "%s lies in several planes: a line or a single point has no normal; take a "
                                  "set of more points",
                        load->set->name);
        k = 0;
    }
    PG_TRY (pg_expression_compile (&load->value[k], "0", "m"));
    load->symmetry = k + 1;
    for (size_t q = 0; q < load->set->npoint; q++) {
        size_t at = (size_t) load->set->point[q] * (size_t) p->dim + (size_t) k;
        away = fmax (away, fabs (p->cloud.x[at] - place));
    }
    PG_TRY (pg_ranks_most (1, &away));
    if (!p->method->shape_functions)
        pg_problem_note (p, PG_WARNING "%.32s: force: %s has no bonds across a plane of symmetry, so that "
                                       "the body is "
                                       "softer within a horizon of it: a finer spacing, "
                                       "surface_correction, or all of it",
                         load->name, p->method->name);
    if (!p->method->shape_functions && away > 1e-3 * p->cloud.h)
        pg_problem_note (p, PG_WARNING "%.32s: symmetry holds points that lie up to %.3g m beside the "
                                       "plane, so that "
                                       "the body is narrower by this: lattice: nodes puts points on the "
                                       "plane",
                         load->name, away);
done:
    return status;
}

/* ---- weight -------------------------------------------------------------------------------------------- */
double pg_load_density (const pg_problem *p, const pg_load *load, int set, size_t point)
{
    return load->weighs ? p->material[p->block[set][point]].density : 1;
}

/* Reads boundary[].gravity: an acceleration, the same everywhere; times the density where it acts. */
pg_status pg_load_read_gravity (const pg_problem *p, pg_load *load, const pg_scene *scene, size_t i)
{
    pg_status status = PG_OK;
    char path[64], text[40];
    double g[3] = { 0 };
    snprintf (path, sizeof path, "boundary[%zu].gravity", i);
    pg_scene_vector (scene, 3, g, "%s", path);
    for (size_t m = 0; m < p->nmaterial; m++)
        if (!(p->material[m].density > 0))
            pg_scene_fault (scene, path, "needs the density of every material (materials.%s.density)",
                            p->material[m].name);
    for (int k = 0; k < p->dim; k++) {
        snprintf (text, sizeof text, "%.17g", g[k]);
        PG_TRY (pg_expression_compile (&load->value[k], text, "N/m3"));
    }
    load->weighs = 1;
done:
    return status;
}

/* ---- a position between points ------------------------------------------------------------------------- */
/* A point near the position of a load: coordinates, m, local spacing, m, global number; all doubles, for
 * exchange between ranks. */
typedef struct { double x[3], size, number; } near_point;
enum { NEAR = sizeof (near_point) / sizeof (double) };
typedef struct {
    const pg_problem *p;
    const double *x;
    double  reach, nearest;  /* radius of the support, m; distance of the nearest point, m */
    size_t  nnear;  near_point *near;                  /* the points around x on all ranks, by number */
    /* indices in `near` of points within reach; weight of each (n) */
    size_t  n, cap;  size_t *found;  double *share;
} place;
/* Largest distance, in spacings, of points that may carry the load. */
static const double farthest = 4;

static double square_to (const place *a, const double *x)
{
    double square = 0;
    for (int k = 0; k < a->p->dim; k++) square += pow (x[k] - a->x[k], 2);
    return square;
}

static int ascending (const void *a, const void *b)
{
    const near_point *x = a, *y = b;
    return (x->number > y->number) - (x->number < y->number);
}

/* Lists the points of all ranks that may carry the load, equal on all ranks. */
static pg_status list_near (place *a)
{
    pg_status status = PG_OK;
    const pg_cloud *c = &a->p->cloud;
    size_t dim = (size_t) c->dim, n = 0, cap = 0, numbers = 0;
    near_point *mine = NULL;
    double most[2] = { c->h, -INFINITY }, *all = NULL;
    for (size_t i = 0; c->size && i < c->n; i++) most[0] = fmax (most[0], c->size[i]);
    for (size_t i = 0; i < c->n; i++)
        if (pg_cloud_owns (c, i)) most[1] = fmax (most[1], -square_to (a, c->x + i * dim));
    PG_TRY (pg_ranks_most (2, most));
    a->nearest = sqrt (-most[1]);
    for (size_t i = 0; i < c->n; i++) {
        double reach = farthest * most[0];
        if (!pg_cloud_owns (c, i) || square_to (a, c->x + i * dim) > reach * reach) continue;
        PG_GROW (mine, cap, n + 1);
        mine[n] = (near_point) { .size = c->size ? c->size[i] : c->h,
                                 .number = (double) pg_cloud_number (c, i) };
        memcpy (mine[n++].x, c->x + i * dim, dim * sizeof *c->x);
    }
    PG_TRY (pg_ranks_share (NEAR * n, (const double *) mine, &numbers, &all));
    a->nnear = numbers / NEAR;
    PG_ALLOC (a->near, a->nnear);
    if (numbers) memcpy (a->near, all, numbers * sizeof *all);
    pg_sort (a->near, a->nnear, sizeof *a->near, ascending);
done:
    pg_free (mine), pg_free (all);
    return status;
}

/* Finds the points within reach of x that no crack separates from it, ascending. */
static pg_status look_around (place *a)
{
    pg_status status = PG_OK;
    a->n = 0;
    for (size_t i = 0; i < a->nnear; i++) {
        double square = square_to (a, a->near[i].x);
        if (square >= a->reach * a->reach) continue;
        if (square > 0 && pg_bond_cut_first (a->p, a->x, a->near[i].x)) continue;
        PG_GROW (a->found, a->cap, a->n + 1);
        a->found[a->n++] = i;
    }
    pg_free (a->share);
    a->share = NULL;
    PG_ALLOC (a->share, a->n);
done:
    return status;
}

/* Computes weights with sum 1 and centroid x: linear moving least squares with weight function (1 - (r /
 * reach)^2)^2. Returns 0: too few points. */
static int share_out (const place *a)
{
    int dim = a->p->dim, m = dim + 1;
    double A[16] = { 0 }, value[4], b[4] = { 1 };
    for (int pass = 0; pass < 2; pass++) {
        for (size_t i = 0; i < a->n; i++) {
            double q[4] = { 1 }, square = 0, sum = 0;
            for (int k = 0; k < dim; k++) {
                q[k + 1] = (a->near[a->found[i]].x[k] - a->x[k]) / a->reach;
                square += q[k + 1] * q[k + 1];
            }
            double weight = (1 - square) * (1 - square);
            for (int r = 0; r < m && !pass; r++)
                for (int c = 0; c < m; c++) A[r * m + c] += weight * q[r] * q[c];
            for (int r = 0; r < m; r++) sum += b[r] * q[r];
            a->share[i] = weight * sum;
        }
        if (pass) break;
        pg_dense_eigen (m, A, value, NULL);
        if (!(value[m - 1] > 1e-4 * value[0]) || pg_dense_cholesky (m, A, 0)) return 0;
        pg_dense_solve (m, A, b);
    }
    return 1;
}

/* Local spacing at x, m: that of the nearest point. */
static double spacing_near (const place *a)
{
    double least = INFINITY, size = a->p->cloud.h;
    for (size_t i = 0; i < a->nnear; i++) {
        double square = square_to (a, a->near[i].x);
        if (square < least) least = square, size = a->near[i].size;
    }
    return size;
}

/* Increases the reach until the weights are well-conditioned. A point at x itself gets weight 1. */
static pg_status find_shares (place *a, const pg_scene *scene, const char *path)
{
    pg_status status = PG_OK;
    size_t dim = (size_t) a->p->dim;
    PG_TRY (list_near (a));
    double h = spacing_near (a);
    if (a->nearest > sqrt ((double) dim) * h) {
        pg_scene_fault (scene, path, "lies %.4g m from the nearest point of the body, which are %.4g m "
                                     "apart: it is "
                        "outside", a->nearest, h);
        return PG_OK;
    }
    a->reach = 1e-6 * h;
    if (a->nearest < a->reach) {
        PG_TRY (look_around (a));
        a->n = 1, a->share[0] = 1;
        return PG_OK;
    }
    for (a->reach = 1.2 * h; a->reach < farthest * h; a->reach *= 1.2) {
        PG_TRY (look_around (a));
        if (a->n > dim && share_out (a)) return PG_OK;
    }
    a->n = 0;
    pg_scene_fault (scene, path, "cracks leave it too few points around to bear a force: it lies on a "
                                 "crack, or beside "
                    "one within a spacing");
done:
    return status;
}

/* Keeps the points found, and their weights, that this process stores, as the set. */
static pg_status take_held (place *a, pg_set *set)
{
    pg_status status = PG_OK;
    const pg_subdomain *s = a->p->cloud.subdomain;
    PG_ALLOC (set->point, a->n);
    set->all_points = a->n;
    for (size_t i = 0, at = 0; i < a->n; i++) {
        int64_t number = (int64_t) a->near[a->found[i]].number;
        while (s && at < s->n && s->number[at] < number) at++;         /* both lists ascend */
        if (s && (at == s->n || s->number[at] != number)) continue;
        a->share[set->npoint] = a->share[i];
        set->point[set->npoint++] = s ? (int) at : (int) number;
    }
done:
    return status;
}

/* Reads boundary[].at: finds the points around the position and their weights, as a set of the load's own. */
pg_status pg_load_read_place (const pg_problem *p, pg_load *load, const pg_scene *scene, size_t i)
{
    pg_status status = PG_OK;
    char path[64];
    pg_set *set = NULL;
    place a = { .p = p, .x = load->at };
    snprintf (path, sizeof path, "boundary[%zu].at", i);
    PG_ALLOC (set, 1);
    load->set = load->own = set;
    snprintf (set->name, sizeof set->name, "%s", "at");
    pg_scene_vector (scene, 3, load->at, "%s", path);
    if (pg_scene_given (scene, "boundary[%zu].set", i))
        pg_scene_fault (scene, path, "is a place instead of a set: give one of them");
    else if (load->kind != PG_POINT_FORCE && load->kind != PG_SPRING)
        pg_scene_fault (scene, path, "at a place there can be a force or a spring: others need a set");
    else PG_TRY (find_shares (&a, scene, path));
    PG_TRY (take_held (&a, set));
done:
    load->share = a.share;
    pg_free (a.near), pg_free (a.found);
    return status;
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * Where loads act: the place that moments are about, a force at a place between points, planes of symmetry,
 * sets that turn as rigid bodies, bodies that weigh. */
#include "model.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- moments ------------------------------------------------------------------------------------------- */
void pg_load_add_moment (const pg_load *load, int dim, const double *x, int k, double force, double *moment)
{
    double arm[3] = { 0 };
    for (int c = 0; c < dim; c++) arm[c] = x[c] - load->about[c];
    /* arm x e_k */
    int next = (k + 1) % 3, last = (k + 2) % 3;
    moment[next] += arm[last] * force;
    moment[last] -= arm[next] * force;
}

/* Does this rank count a facet that several may hold? The cell half a step behind its centre tells. */
static int owns_facet (const pg_problem *p, size_t facet)
{
    size_t dim = (size_t) p->dim;
    double behind[3] = { 0 };
    if (p->cells.owned) return p->cells.owned[p->cells.facet_cell[facet]];
    for (size_t k = 0; k < dim; k++)
        behind[k] = p->cells.facet_centre[facet * dim + k]
                    - 0.5 * p->cloud.step[k] * p->cells.normal[facet * dim + k];
    return pg_lattice_owns (&p->lattice, p->cloud.subdomain, behind);
}

/* The centre of a set: of its facets by their areas, or of its points by their volumes; on all ranks. */
static pg_status centre_of (const pg_problem *p, const pg_set *set, int on_facets, double *centre)
{
    pg_status status = PG_OK;
    size_t dim = (size_t) p->dim, n = on_facets ? set->nfacet : set->npoint;
    double whole = 0, all[4];
    memset (centre, 0, 3 * sizeof *centre);
    for (size_t i = 0; i < n; i++) {
        size_t item = (size_t) (on_facets ? set->facet[i] : set->point[i]);
        if (!(on_facets ? owns_facet (p, item) : pg_owns (p->cloud.subdomain, item))) continue;
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

/* boundary[].about, or the centre of the set. */
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

/* ---- a rigid turn -------------------------------------------------------------------------------------- */
/* The displacement of a set that turns by the angles w (rad, about x, y, z) about a place: w x r of small
 * displacements; with finite ones (R - 1) r, R the rotation about the axis w by its length (Rodrigues). */
static double turned (const pg_load *load, int k, int dim, const double *x, const double *w)
{
    double r[3] = { 0 }, across[3], size = sqrt (w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
    for (int c = 0; c < dim; c++) r[c] = x[c] - load->about[c];
    for (int c = 0; c < 3; c++)
        across[c] = w[(c + 1) % 3] * r[(c + 2) % 3] - w[(c + 2) % 3] * r[(c + 1) % 3];
    if (!load->finite || size == 0) return across[k];
    double along = w[0] * r[0] + w[1] * r[1] + w[2] * r[2], half = sin (0.5 * size),
           less = 2 * half * half / (size * size);     /* (1 - cos) / size^2 */
    return sin (size) / size * across[k] + less * (w[k] * along - size * size * r[k]);
}

double pg_load_turned (const pg_load *load, int k, int dim, const double *x, const pg_place *at,
                       double factor)
{
    double w[3];
    for (int c = 0; c < 3; c++) w[c] = load->angle[c] ? factor * pg_expression_value (load->angle[c], at) : 0;
    return turned (load, k, dim, x, w);
}

/* One angle, the same for all places, and the components of the displacement that it prescribes. */
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

/* boundary[].turn. A rotation by finite angles is no multiple of one by others. */
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
/* The axis that all facets of a set show along, or all of its points have the same coordinate of; -1: none,
 * -2: several. */
static int axis_of (const pg_problem *p, const pg_set *set, double *place)
{
    size_t dim = (size_t) p->dim, n = set->nfacet ? set->nfacet : set->npoint;
    int found = -1;
    for (size_t k = 0; k < dim; k++) {
        double low = INFINITY, high = -INFINITY, along = 1;
        for (size_t i = 0; i < n; i++) {
            size_t item = (size_t) (set->nfacet ? set->facet[i] : set->point[i]);
            double x = (set->nfacet ? p->cells.facet_centre : p->cloud.x)[item * dim + k];
            low = fmin (low, x), high = fmax (high, x);
            if (set->nfacet) along = fmin (along, fabs (p->cells.normal[item * dim + k]));
        }
        if (high - low > 1e-6 * p->cloud.h || along < 1 - 1e-6) continue;
        if (found >= 0) return -2;
        found = (int) k, *place = low;
    }
    return found;
}

/* boundary[].symmetry: the displacement across the plane is zero. Points of other forces than those of a weak
 * form are held where they are, so that the plane should go through them. */
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
    int k = load->set->npoint + load->set->nfacet ? axis_of (p, load->set, &place) : 0;
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

/* boundary[].gravity: an acceleration, the same everywhere; times the density where it acts. */
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

/* ---- a place between points ---------------------------------------------------------------------------- */
typedef struct {
    const pg_problem *p;
    const double *x;
    double  reach;
    size_t  n;  int *point;  double *share;            /* points found, ascending, and their shares */
} place;

/* Points within the reach of a place that no crack hides from it, ascending. */
static pg_status look_around (place *a)
{
    pg_status status = PG_OK;
    const pg_cloud *c = &a->p->cloud;
    size_t dim = (size_t) a->p->dim, cap = 0;
    a->n = 0;
    for (size_t i = 0; i < c->n; i++) {
        double square = 0;
        for (size_t k = 0; k < dim; k++) square += pow (c->x[i * dim + k] - a->x[k], 2);
        if (square >= a->reach * a->reach) continue;
        if (square > 0 && pg_bond_cut_first (a->p, a->x, c->x + i * dim)) continue;
        PG_GROW (a->point, cap, a->n + 1);
        a->point[a->n++] = (int) i;
    }
    pg_free (a->share);
    a->share = NULL;
    PG_ALLOC (a->share, a->n);
done:
    return status;
}

/* Shares that sum up to 1 and put their centre to the place: linear moving least squares with the weight
 * (1 - (r / reach)^2)^2. 0: too few points. */
static int share_out (const place *a)
{
    const pg_cloud *cloud = &a->p->cloud;
    int dim = a->p->dim, m = dim + 1;
    double A[16] = { 0 }, value[4], b[4] = { 1 };
    for (int pass = 0; pass < 2; pass++) {
        for (size_t i = 0; i < a->n; i++) {
            double q[4] = { 1 }, square = 0, sum = 0;
            for (int k = 0; k < dim; k++) {
                q[k + 1] = (cloud->x[(size_t) a->point[i] * (size_t) dim + (size_t) k] - a->x[k]) / a->reach;
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

/* The reach grows until the shares are sound. A point at the place itself takes all. */
static pg_status find_shares (place *a, const pg_scene *scene, const char *path)
{
    pg_status status = PG_OK;
    const pg_cloud *c = &a->p->cloud;
    size_t dim = (size_t) a->p->dim;
    double h = pg_problem_spacing_at (a->p, a->x), nearest = INFINITY;
    for (size_t i = 0; i < c->n; i++) {
        double square = 0;
        for (size_t k = 0; k < dim; k++) square += pow (c->x[i * dim + k] - a->x[k], 2);
        nearest = fmin (nearest, square);
    }
    nearest = sqrt (nearest);
    if (nearest > sqrt ((double) dim) * h) {
        pg_scene_fault (scene, path, "lies %.4g m from the nearest point of the body, which are %.4g m "
                                     "apart: it is "
                        "outside", nearest, h);
        return PG_OK;
    }
    a->reach = 1e-6 * h;
    if (nearest < a->reach) {
        PG_TRY (look_around (a));
        a->n = 1, a->share[0] = 1;
        return PG_OK;
    }
    for (a->reach = 1.2 * h; a->reach < 4 * h; a->reach *= 1.2) {
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

/* boundary[].at: the points around a place and their shares, as a set of its own. */
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
done:
    load->share = a.share;
    if (set) set->point = a.point, set->npoint = a.n;
    else pg_free (a.point);
    return status;
}

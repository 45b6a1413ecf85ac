/* SPDX-License-Identifier: GPL-3.0-or-later
 * The surface of the body as quadrics: planes, circles, cylinders and spheres, scaled so that |grad psi| =
 * 1 where psi = 0. Each comes with the box of the part that may bound the body. Whether a piece of a
 * surface really bounds the body is not decided here but at each quadrature point, by asking the body on
 * both sides. */
#include "cut.h"
#include <math.h>
#include <string.h>

/* ---- quadrics ------------------------------------------------------------------------------------------ */
/* Loops run to 3 in 1D and 2D too: coefficients beyond dim are zero. */
double cut_value (const cut_quadric *q, const double *x)
{
    double v = q->c;
    for (int i = 0; i < 3; i++) {
        v += q->b[i] * x[i];
        for (int k = 0; k < 3; k++) v += x[i] * q->A[i][k] * x[k];
    }
    return v;
}

/* grad = b + 2 A x. */
void cut_gradient (const cut_quadric *q, const double *x, double *g)
{
    for (int i = 0; i < 3; i++) {
        g[i] = q->b[i];
        for (int k = 0; k < 3; k++) g[i] += 2 * q->A[i][k] * x[k];
    }
}

/* Moves the terms with x[axis] into the remaining coefficients, then zeroes those of the axis. */
void cut_restrict (cut_quadric *q, int axis, double at)
{
    q->c += q->b[axis] * at + q->A[axis][axis] * at * at;
    for (int i = 0; i < 3; i++) {
        if (i != axis) q->b[i] += 2 * q->A[i][axis] * at;
        q->A[i][axis] = q->A[axis][i] = 0;
    }
    q->b[axis] = 0;
}

/* |psi (x) - psi (centre)| <= sum_i |g_i| half_i + sum_ik |A_ik| half_i half_k in the box: exact for a
 * quadric. */
int cut_meets (const cut_quadric *q, const double *centre, const double *half, double slack)
{
    double g[3], reach = slack;
    cut_gradient (q, centre, g);
    for (int i = 0; i < 3; i++) {
        reach += fabs (g[i]) * half[i];
        for (int k = 0; k < 3; k++) reach += fabs (q->A[i][k]) * half[i] * half[k];
    }
    return fabs (cut_value (q, centre)) <= reach;
}

/* Substitution x = centre + half X, about the surface's own origin; then all is divided by the largest
 * |b_i| + |A_ii|. */
cut_quadric cut_local (const cut_surface *s, int dim, const double *centre, const double *half)
{
    cut_quadric q = {{{0}}, {0}, 0};
    double m[3] = {0, 0, 0}, g[3], size = 0;
    /* m: centre of the cell relative to the surface's origin. */
    for (int i = 0; i < dim; i++) m[i] = centre[i] - s->origin[i];
    cut_gradient (&s->psi, m, g);
    q.c = cut_value (&s->psi, m);
    for (int i = 0; i < dim; i++) {
        q.b[i] = g[i] * half[i];
        for (int k = 0; k < dim; k++) q.A[i][k] = s->psi.A[i][k] * half[i] * half[k];
    }
    for (int i = 0; i < dim; i++) size = fmax (size, fabs (q.b[i]) + fabs (q.A[i][i]));
    for (int i = 0; i < dim; i++) {
        q.b[i] /= size;
        for (int k = 0; k < dim; k++) q.A[i][k] /= size;
    }
    q.c /= size;
    return q;
}

/* ---- surfaces of shapes -------------------------------------------------------------------------------- */
/* The list of surfaces under construction. */
typedef struct { struct pg_cut *cut; size_t capacity; } builder;

/* Are these the same surface with the same box, up to the sign of psi? Compared in the local coordinates of
 * the box, to 1e-13. */
static int same (const cut_surface *a, const cut_surface *b, int dim)
{
    double centre[3], half[3] = {1, 1, 1}, size = 0, plus = 0, minus = 0;
    for (int k = 0; k < dim; k++) {
        if (!(a->low[k] == b->low[k] && a->high[k] == b->high[k])) return 0;
        centre[k] = 0.5 * (a->low[k] + a->high[k]), size = fmax (size, a->high[k] - a->low[k]);
    }
    for (int k = 0; k < dim; k++) half[k] = size;
    cut_quadric p = cut_local (a, dim, centre, half), q = cut_local (b, dim, centre, half);
    plus = fabs (p.c + q.c), minus = fabs (p.c - q.c);
    for (int i = 0; i < dim; i++) {
        plus += fabs (p.b[i] + q.b[i]), minus += fabs (p.b[i] - q.b[i]);
        for (int k = 0; k < dim; k++)
            plus += fabs (p.A[i][k] + q.A[i][k]), minus += fabs (p.A[i][k] - q.A[i][k]);
    }
    return fmin (plus, minus) < 1e-13;
}

/* Appends a surface unless it is there already (a shape that shares a side with another). */
static pg_status add (builder *m, const cut_surface *s)
{
    pg_status status = PG_OK;
    for (size_t i = 0; i < m->cut->n; i++) if (same (&m->cut->surface[i], s, m->cut->dim)) return PG_OK;
    PG_GROW (m->cut->surface, m->capacity, m->cut->n + 1);
    m->cut->surface[m->cut->n++] = *s;
done:
    return status;
}

/* A plane through a point with a unit normal; where it is normal to an axis its box is flat. */
static pg_status add_plane (builder *m, cut_surface s, const double *point, const double *normal)
{
    s.flat = 1, s.axis = -1;
    memcpy (s.origin, point, (size_t) m->cut->dim * sizeof *point);
    for (int k = 0; k < m->cut->dim; k++) {
        s.psi.b[k] = normal[k];
        if (fabs (normal[k]) == 1) s.axis = k, s.low[k] = s.high[k] = point[k];
    }
    return add (m, &s);
}

/* The 2 dim sides of a box; part: side number. */
static pg_status add_box (builder *m, cut_surface s, const pg_shape *shape)
{
    pg_status status = PG_OK;
    memcpy (s.low, shape->low, sizeof s.low);
    memcpy (s.high, shape->high, sizeof s.high);
    for (int f = 0; f < 2 * m->cut->dim; f++) {
        double n[3] = {0, 0, 0};
        n[f / 2] = f % 2 ? 1 : -1;
        s.part = f;
        PG_TRY (add_plane (m, s, f % 2 ? shape->high : shape->low, n));
    }
done:
    return status;
}

/* Adds a circle or sphere, psi = (|x - c|^2 - R^2) / 2R, or a cylinder, with the distance from its axis
 * instead. */
static pg_status add_round (builder *m, cut_surface s, const pg_shape *shape)
{
    double R = shape->radius;
    int cylinder = shape->kind == PG_CYLINDER;
    s.axis = -1;
    memcpy (s.origin, shape->centre, sizeof s.origin);
    for (int i = 0; i < m->cut->dim; i++)
        for (int k = 0; k < m->cut->dim; k++)
            s.psi.A[i][k] = ((i == k) - (cylinder ? shape->axis[i] * shape->axis[k] : 0)) / (2 * R);
    s.psi.c = -R / 2;
    return add (m, &s);
}

/* Adds the round surface and the two flat ends (part 1 at the centre, 2 at the far end); a disc with axis a
 * extends R sqrt (1 - a_k^2) along axis k. */
static pg_status add_cylinder (builder *m, cut_surface s, const pg_shape *shape)
{
    pg_status status = PG_OK;
    double far[3], back[3];
    for (int k = 0; k < 3; k++)
        far[k] = shape->centre[k] + shape->length * shape->axis[k], back[k] = -shape->axis[k];
    PG_TRY (add_round (m, s, shape));
    s.end = s.part = 1;
    for (int k = 0; k < 3; k++) {
        double wide = shape->radius * sqrt (fmax (0, 1 - shape->axis[k] * shape->axis[k]));
        s.low[k] = shape->centre[k] - wide, s.high[k] = shape->centre[k] + wide;
    }
    PG_TRY (add_plane (m, s, shape->centre, back));
    for (int k = 0; k < 3; k++) s.low[k] += far[k] - shape->centre[k], s.high[k] += far[k] - shape->centre[k];
    s.part = 2;
    PG_TRY (add_plane (m, s, far, shape->axis));
done:
    return status;
}

/* Adds one plane for each edge (part: number of its first vertex); of a prism also the two ends along z. */
static pg_status add_polygon (builder *m, cut_surface s, const pg_shape *shape)
{
    pg_status status = PG_OK;
    cut_surface end = s;
    for (size_t i = 0, j = shape->nvertex - 1; i < shape->nvertex; j = i++) {
        const double *a = shape->vertex + 2 * j, *b = shape->vertex + 2 * i;
        double length = hypot (b[0] - a[0], b[1] - a[1]),
               n[3] = { (b[1] - a[1]) / length, (a[0] - b[0]) / length, 0 };
        double point[3] = {a[0], a[1], 0};
        for (int k = 0; k < 2; k++) s.low[k] = fmin (a[k], b[k]), s.high[k] = fmax (a[k], b[k]);
        s.part = (int) j;
        PG_TRY (add_plane (m, s, point, n));
    }
    for (int f = 0; f < 2 && shape->kind == PG_PRISM; f++) {
        double point[3] = {0, 0, f ? shape->high[2] : shape->low[2]}, n[3] = {0, 0, f ? 1 : -1};
        end.part = (int) shape->nvertex + f;
        PG_TRY (add_plane (m, end, point, n));
    }
done:
    return status;
}

/* Adds one plane for each edge of a plate, normal to the plate: from vertex j to i, normal outwards, half a
 * thickness wide on each side; and the two faces of the plate (parts n and n + 1). */
static pg_status add_plate (builder *m, cut_surface s, const pg_shape *shape)
{
    pg_status status = PG_OK;
    const double *n = shape->axis, *e = shape->along, *v = shape->vertex;
    double f[3], area = 0;
    size_t last = shape->nvertex - 1;
    cut_surface face = s;
    memcpy (face.low, shape->box, sizeof face.low);
    memcpy (face.high, shape->box + 3, sizeof face.high);
    for (int k = 0; k < 3; k++) f[k] = n[(k + 1) % 3] * e[(k + 2) % 3] - n[(k + 2) % 3] * e[(k + 1) % 3];
    for (size_t i = 0, j = last; i <= last; j = i++) area += v[2*j] * v[2*i + 1] - v[2*i] * v[2*j + 1];
    for (size_t i = 0, j = last; i <= last; j = i++) {
        double u = v[2*i] - v[2*j], w = v[2*i + 1] - v[2*j + 1], size = hypot (u, w), point[3], out[3];
        if (area < 0) size = -size;
        for (int k = 0; k < 3; k++) {
            double a = shape->centre[k] + v[2*j] * e[k] + v[2*j + 1] * f[k], b = a + u * e[k] + w * f[k],
                   wide = 0.5 * shape->length * fabs (n[k]);
            point[k] = a, out[k] = (w * e[k] - u * f[k]) / size;
            s.low[k] = fmin (a, b) - wide, s.high[k] = fmax (a, b) + wide;
        }
        s.part = (int) j;
        PG_TRY (add_plane (m, s, point, out));
    }
    for (int side = 0; side < 2; side++) {
        double point[3], out[3];
        for (int k = 0; k < 3; k++)
            out[k] = side ? n[k] : -n[k], point[k] = shape->centre[k] + 0.5 * shape->length * out[k];
        face.part = (int) shape->nvertex + side;
        PG_TRY (add_plane (m, face, point, out));
    }
done:
    return status;
}

/* Bounding box of a shape of any kind, into s->low and s->high. */
static void bound (cut_surface *s, const pg_shape *shape, int dim)
{
    for (int k = 0; k < dim; k++) {
        double a = shape->centre[k], b = a, wide = shape->radius;
        if (shape->kind == PG_CYLINDER)
            b += shape->length * shape->axis[k], wide *= sqrt (fmax (0, 1 - shape->axis[k] * shape->axis[k]));
        s->low[k] = fmin (a, b) - wide, s->high[k] = fmax (a, b) + wide;
        if (shape->kind == PG_BOX || shape->kind == PG_PRISM)
            s->low[k] = shape->low[k], s->high[k] = shape->high[k];
        for (size_t i = 0; k < 2 && shape->kind != PG_PLATE && i < shape->nvertex; i++) {
            double v = shape->vertex[2 * i + (size_t) k];
            s->low[k] = i ? fmin (s->low[k], v) : v, s->high[k] = i ? fmax (s->high[k], v) : v;
        }
    }
}

/* A dividing half-plane along a ray: the plane holds the ray and z, its box is open in the ray's direction
 * only. */
static pg_status add_half_plane (builder *m, const pg_ray *ray)
{
    const pg_body *body = &m->cut->body;
    cut_surface s = {.shape = -1, .axis = -1};
    double point[3] = {ray->centre[0], ray->centre[1], 0}, n[3] = {-ray->direction[1], ray->direction[0], 0};
    for (int k = 0; k < body->dim; k++) {
        double far = 2 * (body->high[k] - body->low[k]);
        s.low[k] = body->low[k] - far, s.high[k] = body->high[k] + far;
        if (k < 2 && ray->direction[k] > -1e-9) s.low[k] = ray->centre[k];
        if (k < 2 && ray->direction[k] < 1e-9) s.high[k] = ray->centre[k];
    }
    return add_plane (m, s, point, n);
}

/* Adds all planes of the lattice for a mesh represented as a staircase. cut_cells.c gives a cell only those
 * at which the staircase has a step. */
static pg_status add_stairs (builder *m, cut_surface s, const pg_lattice *l)
{
    pg_status status = PG_OK;
    for (int k = 0; k < l->dim; k++)
        for (int i = 0; i <= l->count[k]; i++) {
            cut_surface plane = s;
            memset (&plane.psi, 0, sizeof plane.psi);
            memcpy (plane.low, l->origin, sizeof plane.low), memcpy (plane.high, l->high, sizeof plane.high);
            memcpy (plane.origin, l->origin, sizeof plane.origin);
            plane.flat = 1, plane.axis = k, plane.psi.b[k] = 1;
            plane.low[k] = plane.high[k] = plane.origin[k] = pg_lattice_at (l, k, i);
            PG_GROW (m->cut->surface, m->capacity, m->cut->n + 1);
            m->cut->surface[m->cut->n++] = plane;
        }
done:
    return status;
}

/* Adds the plane regions of the surface of a mesh or an alpha shape. */
static pg_status add_facets (builder *m, cut_surface s, const pg_facets *f)
{
    pg_status status = PG_OK;
    size_t dim = (size_t) f->dim;
    s.flat = 1, s.facets = f;
    for (size_t r = 0; r < f->nregion; r++) {
        const double *plane = f->plane + 2 * dim * r;
        memset (&s.psi, 0, sizeof s.psi);
        memcpy (s.origin, plane, dim * sizeof *plane);
        memcpy (s.psi.b, plane + dim, dim * sizeof *plane);
        s.axis = f->axis[r], s.region = (int) r;
        for (size_t k = 0; k < dim; k++) s.low[k] = INFINITY, s.high[k] = -INFINITY;
        for (size_t i = f->first[r]; i < f->first[r + 1]; i++)
            for (size_t c = 0; c < dim * dim; c++) {
                double v = f->x[(size_t) f->piece[i] * dim * dim + c];
                s.low[c % dim] = fmin (s.low[c % dim], v), s.high[c % dim] = fmax (s.high[c % dim], v);
            }
        PG_GROW (m->cut->surface, m->capacity, m->cut->n + 1);
        m->cut->surface[m->cut->n++] = s;
    }
done:
    return status;
}

/* Replaces meshes and alpha shapes by flat pieces of their surface, alpha shapes with a rim by their
 * staircases on the lattice; such a body gets its own copy of the list of shapes. */
static pg_status own_shapes (struct pg_cut *cut, const pg_lattice *lattice)
{
    pg_status status = PG_OK;
    if (pg_body_meshes (&cut->body) == 0) return PG_OK;
    PG_ALLOC (cut->own, cut->body.n);
    for (size_t i = 0; i < cut->body.n; i++) {
        const pg_shape *shape = &cut->body.shape[i];
        if (!pg_shape_meshed (shape)) cut->own[i] = *shape;
        else if (pg_shape_stepped (shape)) PG_TRY (pg_stairs_create (&cut->own[i], shape, lattice));
        else PG_TRY (pg_faceted_create (&cut->own[i], shape, lattice));
    }
    cut->body.shape = cut->own;
done:
    return status;
}

pg_status cut_surfaces (struct pg_cut *cut, const pg_body *body, const pg_lattice *lattice, size_t nray,
                        const pg_ray *ray)
{
    pg_status status = PG_OK;
    builder m = {cut, 0};
    cut->dim = body->dim, cut->body = *body;
    PG_TRY (own_shapes (cut, lattice));
    for (size_t i = 0; i < body->n; i++) {
        const pg_shape *shape = &cut->body.shape[i];
        cut_surface s = {.shape = (int) i, .axis = -1};
        bound (&s, shape, body->dim);
        if (shape->kind == PG_STAIRS) PG_TRY (add_stairs (&m, s, lattice));
        else if (shape->kind == PG_FACETED) PG_TRY (add_facets (&m, s, pg_shape_facets (shape)));
        else if (shape->kind == PG_BOX) PG_TRY (add_box (&m, s, shape));
        else if (shape->kind == PG_PLATE) PG_TRY (add_plate (&m, s, shape));
        else if (shape->kind == PG_CYLINDER) PG_TRY (add_cylinder (&m, s, shape));
        else if (shape->kind == PG_DISK || shape->kind == PG_SPHERE) PG_TRY (add_round (&m, s, shape));
        else PG_TRY (add_polygon (&m, s, shape));
    }
    for (size_t i = 0; i < nray; i++) PG_TRY (add_half_plane (&m, &ray[i]));
done:
    return status;
}

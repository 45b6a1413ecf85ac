/* SPDX-License-Identifier: GPL-3.0-or-later
 * Whether a position lies in the body, local spacing, and distances to the surface, for tips of cracks: by
 * the shapes of the body, the elements of a mesh, or the nearest points of a file. */
#include "perigal/crack.h"
#include <math.h>

struct pg_body_search {
    pg_mesh_locator *locator;                          /* of a mesh, or NULL */
    pg_nearest *near;  /* of points, if spacings differ or there are only points */
};

pg_status pg_body_search_create (struct pg_body_search **out, const pg_cloud *cloud, const pg_body *body,
                                 const pg_mesh_body *part)
{
    pg_status status = PG_OK;
    struct pg_body_search *s = NULL;
    PG_ALLOC (s, 1);
    if (part->mesh.n) PG_TRY (pg_mesh_locator_create (&s->locator, &part->mesh));
    if (cloud->size || (!body->n && !part->mesh.n))
        PG_TRY (pg_nearest_create (&s->near, cloud->dim, cloud->n, cloud->x));
    *out = s, s = NULL;
done:
    pg_body_search_free (&s);
    return status;
}

void pg_body_search_free (struct pg_body_search **search)
{
    if (!*search) return;
    pg_mesh_locator_free (&(*search)->locator);
    pg_nearest_free (&(*search)->near);
    pg_free (*search);
    *search = NULL;
}

/* Index of the nearest point; -1: the search has no points. */
static long nearest_to (const pg_ground *p, const double *x)
{
    return p->search && p->search->near ? pg_nearest_find (p->search->near, x, NULL, NULL) : -1;
}

double pg_ground_spacing_at (const pg_ground *p, const double *x)
{
    long i = p->cloud->size ? nearest_to (p, x) : -1;
    return i >= 0 ? p->cloud->size[i] : p->cloud->h;
}

/* Points of a file have no surface: x is in the body if a point is as near as in a lattice, at most half its
 * cell's diagonal. */
int pg_ground_has_body (const pg_ground *p, const double *x)
{
    double xi[3], d = 0;
    if (p->body->n) return pg_body_inside (p->body, x, 0);
    if (p->search && p->search->locator)
        return pg_mesh_locator_find (p->search->locator, x, xi, NULL) >= 0;
    long i = nearest_to (p, x);
    for (int k = 0; i >= 0 && k < p->dim; k++)
        d = hypot (d, p->cloud->x[(size_t) i * (size_t) p->dim + (size_t) k] - x[k]);
    return i >= 0 && d <= (p->dim == 3 ? 0.87 : 0.71) * pg_ground_spacing_at (p, x);
}

/* Steps of a ray per spacing; bisections of the last step, down to rounding. */
enum { STEPS = 8, HALVINGS = 44 };

static int body_at (const pg_ground *p, const double *x, const double *e, double r)
{
    double place[3] = { 0 };
    for (int k = 0; k < p->dim; k++) place[k] = x[k] + r * e[k];
    return pg_ground_has_body (p, place);
}

/* Finds the surface by bisection between distance `near` (inside the body) and `far` (outside), m. */
static double halve (const pg_ground *p, const double *x, const double *e, double near, double far)
{
    for (int k = 0; k < HALVINGS; k++) {
        double middle = 0.5 * (near + far);
        if (body_at (p, x, e, middle)) near = middle;
        else far = middle;
    }
    return near;
}

/* Distance *way (m) to the surface of shapes, exact also for slots narrower than a step; returns 0: not
 * known. */
static int way_in_shapes (const pg_ground *p, const double *x, const double *e, double limit, double first,
                          double *way)
{
    double end[3] = { 0 }, gap[2], after = 0;            /* fractions of `limit` */
    int found;
    if (!p->body->n || !p->between) return 0;
    for (int k = 0; k < p->dim; k++) end[k] = x[k] + limit * e[k];
    *way = limit;
    for (; (found = pg_between_outside (p->between, x, end, after, gap)) > 0; after = gap[1]) {
        double far = 0.5 * (gap[0] + gap[1]) * limit;
        if (gap[1] * limit <= first || body_at (p, x, e, far)) continue;
        *way = halve (p, x, e, after * limit, far);
        return 1;
    }
    return !found;
}

/* Steps along the ray, then bisection. x may lie on the surface to rounding, so the first step is tested at
 * its end only. */
double pg_ground_way_out (const pg_ground *p, const double *x, const double *e, double limit)
{
    double step = pg_ground_spacing_at (p, x) / STEPS, near = 0, far, way;
    if (way_in_shapes (p, x, e, limit, fmin (step, limit), &way)) return way;
    for (long i = 1; near < limit; i++, near = far) {
        far = fmin ((double) i * step, limit);
        if (!body_at (p, x, e, far)) return halve (p, x, e, near, far);
    }
    return limit;
}

/* Largest distance of lattice points outside the surface, spacings. In 3D positions on the surface, to
 * rounding, count as body. */
#define BEYOND_SURFACE 1.0
double pg_ground_beyond (const pg_ground *p, const double *x, const double *e)
{
    double h = pg_ground_spacing_at (p, x), slack = p->dim == 3 ? pg_cloud_same (p->cloud) : 0;
    int free = 0;
    for (int part = 1; part <= STEPS; part++) {
        double place[3] = { 0 };
        for (int k = 0; k < p->dim; k++) place[k] = x[k] + BEYOND_SURFACE * h * part / STEPS * e[k];
        int body = p->body->n ? pg_body_inside (p->body, place, slack) : pg_ground_has_body (p, place);
        if (body && free) return BEYOND_SURFACE * h * (part - 1) / STEPS;
        free |= !body;
    }
    return free ? BEYOND_SURFACE * h : 0;
}

/* Samples the triangle at PLACES x PLACES points, weighted by the length of the strip. */
double pg_ground_area_inside (const pg_ground *p, const double *o, const double *u, const double *v,
                               double area)
{
    enum { PLACES = 12 };
    double in = 0, all = 0;
    for (int a = 0; a < PLACES * PLACES; a++) {
        double r = (0.5 + a / PLACES) / PLACES, t = (0.5 + a % PLACES) / PLACES, x[3];
        for (int k = 0; k < 3; k++) x[k] = o[k] + r * ((1 - t) * (u[k] - o[k]) + t * (v[k] - o[k]));
        all += r;
        if (pg_ground_has_body (p, x)) in += r;
    }
    return area * in / all;
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * Where the body is, and how fine its points are there: for tips of cracks, which must know what lies ahead
 * of them. A body of shapes answers itself, a mesh by its elements, points of a file by the nearest of
 * them. */
#include "model.h"
#include <math.h>

struct pg_body_search {
    pg_mesh_locator *locator;                          /* of a body that is a mesh */
    pg_nearest *near;  /* among the points, where spacings differ or nothing else is known */
};

/* Bodies in the plane always, as a crack may begin anywhere in them; others if they have cracks, or may get
 * some. */
pg_status pg_body_search_create (pg_problem *p)
{
    pg_status status = PG_OK;
    if (p->dim == 1 || (p->dim == 3 && p->cracks.n == 0 && !pg_problem_grows (p))) return PG_OK;
    PG_ALLOC (p->search, 1);
    if (p->part.mesh.n) PG_TRY (pg_mesh_locator_create (&p->search->locator, &p->part.mesh));
    if (p->cloud.size || (!p->body.n && !p->part.mesh.n))
        PG_TRY (pg_nearest_create (&p->search->near, p->dim, p->cloud.n, p->cloud.x));
done:
    return status;
}

void pg_body_search_free (pg_problem *p)
{
    if (!p->search) return;
    pg_mesh_locator_free (&p->search->locator);
    pg_nearest_free (&p->search->near);
    pg_free (p->search);
    p->search = NULL;
}

/* The nearest point, -1: none was asked for when the search was made. */
static long nearest_to (const pg_problem *p, const double *x)
{
    return p->search && p->search->near ? pg_nearest_find (p->search->near, x, NULL, NULL) : -1;
}

double pg_problem_spacing_at (const pg_problem *p, const double *x)
{
    long i = p->cloud.size ? nearest_to (p, x) : -1;
    return i >= 0 ? p->cloud.size[i] : p->cloud.h;
}

/* Points of a file have no surface: a place beyond it has none nearer than those of a lattice lie at
 * most. */
int pg_problem_has_body (const pg_problem *p, const double *x)
{
    double xi[3], d = 0;
    if (p->body.n) return pg_body_inside (&p->body, x, 0);
    if (p->search && p->search->locator)
        return pg_mesh_locator_find (p->search->locator, x, xi, NULL) >= 0;
    long i = nearest_to (p, x);
    for (int k = 0; i >= 0 && k < p->dim; k++)
        d = hypot (d, p->cloud.x[(size_t) i * (size_t) p->dim + (size_t) k] - x[k]);
    return i >= 0 && d <= (p->dim == 3 ? 0.87 : 0.71) * pg_problem_spacing_at (p, x);
}

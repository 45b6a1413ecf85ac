/* SPDX-License-Identifier: GPL-3.0-or-later
 * Does a crack meet the body? By subdivision of its segment or triangles, with balls around the pieces. */
#include "crack.h"
#include "perigal/vector.h"
#include <math.h>

/* Depth of the subdivision. */
enum { DEEPEST = 8 };

/* Can the triangle a b c meet the body? 0 only if it certainly does not: a ball around a piece misses the
 * body, or around all parts of the piece, by subdivision into four. */
static int may_meet (const pg_body *body, const double *a, const double *b, const double *c, int depth)
{
    double m[3] = {0, 0, 0}, ab[3] = {0, 0, 0}, bc[3] = {0, 0, 0}, ca[3] = {0, 0, 0}, radius = 0;
    const double *corner[3] = {a, b, c};
    for (int k = 0; k < body->dim; k++) {
        m[k] = (a[k] + b[k] + c[k]) / 3;
        ab[k] = 0.5 * (a[k] + b[k]), bc[k] = 0.5 * (b[k] + c[k]), ca[k] = 0.5 * (c[k] + a[k]);
    }
    for (int i = 0; i < 3; i++) {
        double r[3];
        for (int k = 0; k < body->dim; k++) r[k] = corner[i][k] - m[k];
        radius = fmax (radius, pg_size (body->dim, r));
    }
    /* The ball about the middle m holds the piece. */
    if (!pg_body_inside (body, m, radius * (1 + 1e-9))) return 0;
    if (depth == DEEPEST || pg_body_inside (body, m, 0)) return 1;
    return may_meet (body, a, ab, ca, depth + 1) || may_meet (body, b, bc, ab, depth + 1)
        || may_meet (body, c, ca, bc, depth + 1) || may_meet (body, ab, bc, ca, depth + 1);
}

/* Tests a polygon as a fan of triangles. */
int crack_may_meet (const pg_body *body, const pg_crack *c)
{
    const double *v = c->vertex;
    size_t dim = (size_t) body->dim;
    if (c->kind == PG_CRACK_SEGMENT) return may_meet (body, v, v + 2, v + 2, 0);
    for (size_t i = 1; i + 1 < c->nvertex; i++)
        if (may_meet (body, v, v + dim*i, v + dim*(i + 1), 0)) return 1;
    return 0;
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * Integration points of the integrals around a tip. The shape functions are smooth but not polynomial, with a
 * length scale of about h: four Gauss points each on pieces of less than h along the radius, and on equal
 * arcs around. None lies on the crack, at the angle +-pi. The near ring and the rest of the wide one have
 * separate points, so that both integrals use fields evaluated once.
 *
 * Faces of a crack that turns inside the rings. Where the faces run along e the line integral of Rice is the
 * same around every path; on faces that do not, J of the tip has an additional part. With P_j = sigma_ij
 * u_i,1 - W delta_1j and div P = 0 the integral over the ring is J of the tip less the flux of P through the
 * faces, and since free faces have sigma n = 0,
 *
 *   J += int W n_1 q ds over both faces of all pieces, n outwards: q ((W n_1) right + (W n_1) left).
 *
 * W is the energy density on each face. It matters under compression along the crack: behind the kink of a
 * wing crack this part is as large as J itself. Within a quarter of a spacing of the tip the discrete faces
 * are not separated, and nothing is added. */
#include "front.h"
#include <math.h>
#include <string.h>

enum { GAUSS = 4, ARCS_NEAR = 12, ARCS_WIDE = 16 };
static const double ring_piece = 0.75;                 /* largest radial piece, in spacings */
/* spacings: largest piece of a face; offset of points from it; excluded distance from the tip */
static const double piece = 0.5, aside = 0.02, closed = 0.25;
static const double straight = 0.05;                   /* |n_1| below which faces count as parallel to e */
static const double pi = 3.14159265358979323846;

/* ---- rings --------------------------------------------------------------------------------------------- */
/* Number of radial pieces of a ring. */
static size_t pieces (const pg_problem *p, double from, double to, double h)
{
    return to > from + pg_cloud_same (&p->cloud) ? pg_cloud_pieces (&p->cloud, to - from, ring_piece * h) : 0;
}

static size_t places (const pg_problem *p, double from, double to, double h, int arcs)
{
    return pieces (p, from, to, h) * GAUSS * (size_t) arcs * GAUSS;
}

/* Appends the integration points of the ring from `from` to `to` (m). */
static void add_ring (front_places *q, const pg_problem *p, const pg_tip_field *tip, double from, double to,
                      int arcs)
{
    double x[GAUSS], w[GAUSS];
    size_t n = pieces (p, from, to, tip->h);
    double radius = n ? (to - from) / (double) n : 0, arc = 2 * pi / arcs;
    pg_gauss_rule (GAUSS, x, w);
    for (size_t i = 0; i < n * GAUSS; i++)
        for (int j = 0; j < arcs * GAUSS; j++) {
            double r = from + radius * ((double) (i / GAUSS) + 0.5 * (1 + x[i % GAUSS])),
                   theta = -pi + arc * (j / GAUSS + 0.5 * (1 + x[j % GAUSS]));
            double c = r * cos (theta), s = r * sin (theta);
            size_t k = q->n++;
            q->r[k] = r, q->theta[k] = theta;
            q->area[k] = 0.25 * w[i % GAUSS] * w[j % GAUSS] * radius * arc * r;
            q->x[2*k] = tip->x[0] + c * tip->e[0] - s * tip->e[1];
            q->x[2*k + 1] = tip->x[1] + c * tip->e[1] + s * tip->e[0];
        }
}

pg_status tip_rings_create (front_places *out, const pg_problem *p, const pg_tip_field *t, int core)
{
    pg_status status = PG_OK;
    PG_TRY (places_create (out, places (p, 0, t->r1, t->h, ARCS_NEAR)
                                    + places (p, t->r1, t->near, t->h, ARCS_NEAR)
                                    + places (p, t->near, t->wide, t->h, ARCS_WIDE)));
    if (core) add_ring (out, p, t, 0, t->r1, ARCS_NEAR);
    add_ring (out, p, t, t->r1, t->near, ARCS_NEAR);
    add_ring (out, p, t, t->near, t->wide, ARCS_WIDE);
done:
    return status;
}

/* ---- faces --------------------------------------------------------------------------------------------- */
/* Appends points on the left and right face at `at`; outward normals are minus and plus the left normal,
 * whose component along e is n_1. length: length represented, m. */
static void add_place (front_places *q, const pg_tip_field *tip, const double *at, const double *normal,
                       double n_1, double length)
{
    for (int side = 1; side >= -1; side -= 2) {
        size_t k = q->n++;
        for (size_t c = 0; c < 2; c++) q->x[2*k + c] = at[c] + side * aside * tip->h * normal[c];
        q->r[k] = hypot (at[0] - tip->x[0], at[1] - tip->x[1]);
        q->area[k] = -side * n_1 * length;
    }
}

/* Number of parts of a segment of this length (m), each with GAUSS points on both faces. */
static size_t parts_of (const pg_problem *p, const pg_tip_field *tip, double length)
{
    return pg_cloud_pieces (&p->cloud, length, piece * tip->h);
}

/* Returns 1: the piece lies within the wide ring and is not parallel to e; *length, m; *n_1: its left normal
 * . e. */
static int turns (const pg_tip_field *tip, const pg_crack *c, double *length, double *n_1)
{
    const double *a = c->vertex, *b = a + 2;
    double t[2] = { b[0] - a[0], b[1] - a[1] };
    *length = hypot (t[0], t[1]);
    if (!(*length > 0)) return 0;
    *n_1 = c->normal[0] * tip->e[0] + c->normal[1] * tip->e[1];
    double s = ((tip->x[0] - a[0]) * t[0] + (tip->x[1] - a[1]) * t[1]) / (*length * *length);
    s = fmin (1, fmax (0, s));
    return fabs (*n_1) > straight
           && hypot (a[0] + s * t[0] - tip->x[0], a[1] + s * t[1] - tip->x[1]) < tip->wide;
}

/* Appends Gauss points on the parts of a piece, where the faces are separated and within the ring. */
static void add_piece (front_places *q, const pg_problem *p, const pg_tip_field *tip, const pg_crack *c,
                       double length, double n_1)
{
    double x[GAUSS], w[GAUSS];
    size_t n = parts_of (p, tip, length);
    pg_gauss_rule (GAUSS, x, w);
    for (size_t i = 0; i < n * GAUSS; i++) {
        double s = ((double) (i / GAUSS) + 0.5 * (1 + x[i % GAUSS])) / (double) n, at[2];
        for (int k = 0; k < 2; k++) at[k] = c->vertex[k] + s * (c->vertex[2 + k] - c->vertex[k]);
        double r = hypot (at[0] - tip->x[0], at[1] - tip->x[1]);
        if (r > closed * tip->h && r < tip->wide)
            add_place (q, tip, at, c->normal, n_1, 0.5 * w[i % GAUSS] * length / (double) n);
    }
}

pg_status tip_faces_create (front_places *out, const pg_problem *p, const pg_tip_field *tip,
                            const pg_cracks *cracks)
{
    pg_status status = PG_OK;
    size_t most = 0;
    double length, n_1;
    for (size_t k = 0; k < cracks->n; k++)
        if (turns (tip, &cracks->crack[k], &length, &n_1)) most += 2 * GAUSS * parts_of (p, tip, length);
    PG_TRY (places_create (out, most));
    for (size_t k = 0; k < cracks->n; k++)
        if (turns (tip, &cracks->crack[k], &length, &n_1))
            add_piece (out, p, tip, &cracks->crack[k], length, n_1);
done:
    return status;
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * J, K_I, K_II, K_III and T along a 3D front. There are two cross sections between neighbouring vertices; a
 * vertex uses those within three vertices, with the weight (hat) 1 - |u - i| / 3: discrete fields follow the
 * front in steps of the lattice, which narrower hats would show.
 *
 * All cross sections in the hat of a vertex use the largest radius that is possible at all of them: 4
 * spacings for J, 3 for K, which determines the direction; else 2.25 or 1.5. Where a cross section has no
 * room for that, the hats that contain it are narrowed to 2 vertices or 1; else there is no result. */
#include "front.h"
#include <math.h>
#include <string.h>

enum { CHUNK = 16 };                                   /* cross sections that are sampled at a time */

typedef struct {
    measuring m;                                       /* m.h: largest spacing along the front */
    const pg_front *front;
    const pg_front_faces *faces;                       /* contact at each vertex; NULL: none */
    pg_nearest *near;  /* search for nodes; NULL: all have the same material and loads */
    double *width;                                     /* half width of the hat of each vertex, in vertices */
} front_line;

/* ---- faces that touch ---------------------------------------------------------------------------------- */
/* The vertices i, j on both sides of u. */
static void beside (const pg_front *f, double u, size_t *i, size_t *j)
{
    *i = (size_t) floor (u) % f->n;
    *j = f->closed ? (*i + 1) % f->n : *i + 1 < f->n ? *i + 1 : *i;
}

/* Uniform contact stress (sigma_22, sigma_12, sigma_23, Pa) of a field at u, in the frame, interpolated
 * between vertices. Returns 0: a neighbouring vertex is open, or faces is NULL. */
static int faces_at (const pg_front *f, const pg_front_faces *faces, int field, double u, const double *frame,
                     double stress[3])
{
    size_t i, j;
    if (!faces) return 0;
    beside (f, u, &i, &j);
    const pg_front_faces *a = &faces[i], *b = &faces[j];
    double share = u - floor (u), along = 0, across = 0;
    if (!a->closed || !b->closed) return 0;
    for (int k = 0; k < 3; k++) {
        double shear = (1 - share) * a->shear[field][k] + share * b->shear[field][k];
        along += frame[k] * shear, across += frame[6 + k] * shear;
    }
    /* tractions on the face on the side of the normal are minus the stress components */
    stress[0] = -((1 - share) * a->pressure[field] + share * b->pressure[field]);
    stress[1] = -along, stress[2] = -across;
    return 1;
}

/* Distance from the front at u to the nearest closed faces, m: bound of the radius at open vertices. */
static double faces_clear (const pg_front *f, const pg_front_faces *faces, double u)
{
    size_t i, j;
    double nearest = INFINITY;
    beside (f, u, &i, &j);
    if (!faces[i].closed) nearest = fmin (nearest, faces[i].nearest);
    if (!faces[j].closed) nearest = fmin (nearest, faces[j].nearest);
    return nearest;
}

/* ---- cross sections ------------------------------------------------------------------------------------ */
static size_t node_at (const front_line *l, const double *x)
{
    return l->near ? (size_t) pg_nearest_find (l->near, x, NULL, NULL) : 0;
}

/* Returns 1: the front ends on the surface (or another crack) within `limit` (m) of x, so that the surface is
 * ignored there. */
static int is_tail (const pg_front *f, const double *x, double limit)
{
    for (size_t end = 0; !f->closed && end < f->n; end += f->n - 1) {
        double d = 0;
        for (size_t k = 0; k < 3; k++) d = hypot (d, x[k] - f->x[3 * end + k]);
        if (f->meets[end] != PG_MEETS_NOTHING && d < limit) return 1;
    }
    return 0;
}

/* Sets position, material and largest radius of all cross sections. */
static void place_sections (front_line *l)
{
    measuring *m = &l->m;
    const pg_front *f = l->front;
    double limit = m->radius[FRONT_RADII - 1], same = pg_cloud_same (&m->p->cloud);
    for (size_t j = 0; j < m->n; j++) {
        cross_section *s = &m->section[j];
        s->u = ((double) j + 0.5) / FRONT_SECTIONS;
        front_at (f, s->u, &s->at);
        s->length = s->at.speed / FRONT_SECTIONS;
        s->node = node_at (l, s->at.x), s->material = material_at (m->p, s->node);
        s->room = front_room (m->p, m->state, &s->at, m->h, f->offset[(size_t) (s->u + 0.5) % f->n], limit,
                              is_tail (f, s->at.x, limit), &s->load);
        if (l->faces) s->room = fmin (s->room, faces_clear (f, l->faces, s->u));
        while (s->radii < FRONT_RADII && m->radius[s->radii] <= s->room + same) s->radii++;
        for (int a = 0; a < m->nfield; a++)
            s->closed = faces_at (f, l->faces, a, s->u, s->at.frame, s->stress[a]);
    }
}

/* Adds the integration points of cross section j that lie within its radius and in the body. */
static void add_places (const measuring *m, const front_places *ring, size_t j, front_places *q)
{
    const cross_section *s = &m->section[j];
    double end = s->radii ? m->radius[s->radii - 1] : 0;
    for (size_t k = 0; k < ring->n && ring->r[k] < end; k++) {
        double x[3], y = ring->r[k] * cos (ring->theta[k]), z = ring->r[k] * sin (ring->theta[k]);
        for (int i = 0; i < 3; i++) x[i] = s->at.x[i] + y * s->at.frame[i] + z * s->at.frame[3 + i];
        if (!pg_problem_has_body (m->p, x)) continue;
        size_t to = q->n++;
        q->r[to] = ring->r[k], q->theta[to] = ring->theta[k], q->area[to] = ring->area[k], q->of[to] = j;
        memcpy (q->x + 3 * to, x, sizeof x);
    }
}

/* Evaluates the fields at the cross sections, CHUNK at a time, and integrates. */
static pg_status measure_sections (const measuring *m)
{
    pg_status status = PG_OK;
    front_places ring = { 0 }, q = { 0 };
    int forced = 0;
    for (size_t l = 0; l < m->p->boundary.nload; l++) forced |= m->p->boundary.load[l].kind == PG_BODY_FORCE;
    PG_TRY (front_places_make (&ring, m->h));
    PG_TRY (places_create (&q, CHUNK * ring.n));
    for (size_t first = 0; first < m->n; first += CHUNK) {
        size_t start[CHUNK + 1] = { 0 }, many = m->n - first < CHUNK ? m->n - first : CHUNK;
        q.n = 0;
        for (size_t j = 0; j < many; j++) add_places (m, &ring, first + j, &q), start[j + 1] = q.n;
        PG_TRY (places_fields (&q, m, forced, m->moving));
        for (size_t j = 0; j < many; j++) {
            cross_section *s = &m->section[first + j];
            front_integrals (&s->sums, m, s, &q, start[j], start[j + 1]);
        }
    }
    PG_TRY (springs_add (m));
done:
    places_clear (&ring), places_clear (&q);
    return status;
}

/* ---- vertices ------------------------------------------------------------------------------------------ */
/* Half width of the hat of vertex i, in vertices: on short loops half of them; narrower if it would contain a
 * cross section without room. */
static double hat_width (const front_line *l, size_t i)
{
    const pg_front *f = l->front;
    const measuring *m = &l->m;
    double width = f->closed ? fmin (FRONT_HAT, 0.5 * (double) f->n) : FRONT_HAT, clear = width;
    for (size_t j = 0; j < m->n; j++)
        if (m->section[j].radii == 0) clear = fmin (clear, front_gap (f, m->section[j].u, i));
    return clear >= 1 ? fmin (width, floor (clear)) : width;
}

/* Hat of vertex i at cross section j times the length of the section (m), and its derivative along the front
 * times that length. Returns 0: outside the hat. */
static int hat_at (const front_line *l, size_t i, size_t j, double *hat, double *slope)
{
    const pg_front *f = l->front;
    const cross_section *s = &l->m.section[j];
    double width = l->width[i], gap = front_gap (f, s->u, i), n = (double) f->n;
    double ahead = s->u - (double) i;
    if (gap >= width) return 0;
    if (f->closed && ahead > 0.5 * n) ahead -= n;
    if (f->closed && ahead < -0.5 * n) ahead += n;
    *hat = (1 - gap / width) * s->length;
    *slope = (ahead > 0 ? -1 : 1) / (width * FRONT_SECTIONS);
    return 1;
}

/* Sets frame and room of vertex i; returns the number of possible radii. */
static int begin_vertex (const front_line *l, size_t i, pg_tip_field *out)
{
    const measuring *m = &l->m;
    front_place at;
    int radii = FRONT_RADII;
    double hat, slope;
    memset (out, 0, sizeof *out);
    front_at (l->front, (double) i, &at);
    memcpy (out->x, l->front->x + 3*i, sizeof out->x);
    memcpy (out->e, at.frame, sizeof out->e);
    memcpy (out->normal, at.frame + 3, sizeof out->normal);
    memcpy (out->tangent, at.frame + 6, sizeof out->tangent);
    tip_material material = material_at (m->p, node_at (l, out->x));
    out->load = -1;
    out->h = out->r1 = m->h, out->room = m->radius[FRONT_RADII - 1];
    out->modulus = material.modulus, out->antiplane = material.modulus / (2 * material.mu);
    for (size_t j = 0; j < m->n; j++) {
        const cross_section *s = &m->section[j];
        if (!hat_at (l, i, j, &hat, &slope)) continue;
        if (s->radii < radii) radii = s->radii;
        if (s->room < out->room) {
            out->room = s->room, out->load = s->load;
            out->limit = out->load < 0 ? PG_ROOM_FREE : PG_ROOM_LOAD;
        }
        if (front_gap (l->front, s->u, i) < 0.5) out->length += s->length;
    }
    measured_nothing (out);
    out->near = out->wide = NAN;
    if (radii == 0) return 0;
    out->wide = m->radius[radii - 1];
    out->near = m->radius[radii < 3 ? radii - 1 : 2];
    return radii;
}

/* Averages the integrals for radius number r over the hat of vertex i, without the core terms along the
 * front. */
static void sum_vertex (const front_line *l, size_t i, int r, double J[2][2], double I[FRONT_FIELDS][2],
                        double strain[2], double by_K[2])
{
    const measuring *m = &l->m;
    double total = 0, hat, slope;
    memset (J, 0, 4 * sizeof (double)), memset (I, 0, 2 * FRONT_FIELDS * sizeof (double));
    for (int a = 0; a < 2; a++) strain[a] = by_K[a] = 0;
    for (size_t j = 0; j < m->n; j++) {
        const front_sums *s = &m->section[j].sums;
        if (!hat_at (l, i, j, &hat, &slope)) continue;
        total += hat;
        for (int a = 0; a < m->nfield; a++) {
            for (int b = 0; b < m->nfield; b++)
                J[a][b] += hat * s->J[r][a][b] + slope * s->J_along[r][a][b];
            for (int x = 0; x < FRONT_FIELDS; x++)
                I[x][a] += hat * s->I[r][x][a] + slope * s->I_along[r][x][a];
            strain[a] += hat * s->strain[a];
        }
        for (int a = 0; a < 2; a++) by_K[a] += hat * s->by_K[a];
    }
    for (int a = 0; a < 2; a++) {
        for (int b = 0; b < 2; b++) J[a][b] /= total;
        for (int x = 0; x < FRONT_FIELDS; x++) I[x][a] /= total;
        strain[a] /= total, by_K[a] /= total;
    }
}

/* K = E'/2 I for modes I and II, mu I for mode III; T = E' (I + nu strain along the front), without the
 * strain due to K itself. */
static void fill_vertex (const front_line *l, size_t i, int radii, pg_tip_field *out)
{
    const measuring *m = &l->m;
    double I[FRONT_FIELDS][2], spare[FRONT_FIELDS][2], strain[2], by_K[2];
    tip_material material = material_at (m->p, node_at (l, out->x));
    double factor[3] = { 0.5 * material.modulus, 0.5 * material.modulus, material.mu },
           nu = 0.25 * (3 - material.kappa);
    int near = radii < 3 ? radii - 1 : 2;
    sum_vertex (l, i, near, out->J_near, spare, strain, by_K);
    sum_vertex (l, i, radii - 1, out->J, I, strain, by_K);
    for (int a = 0; a < m->nfield; a++) {
        for (int k = 0; k < 3; k++)
            out->K[k][a] = factor[k] * spare[k][a], out->K_wide[k][a] = factor[k] * I[k][a];
        double own = by_K[0] * out->K_wide[0][a] + by_K[1] * out->K_wide[1][a];
        out->T[a] = material.modulus * (I[FRONT_FORCE][a] + nu * (strain[a] - own));
        out->T[a] -= m->pressure[a];
    }
}

/* K of mode k, field a, interpolated at u; 0 where it is not known. */
static double between (const pg_front *f, const pg_tip_field *v, double u, int k, int a)
{
    size_t n = f->n, i = (size_t) u % n, next = (i + 1) % n;
    double s = u - floor (u), K = (1 - s) * v[i].K[k][a] + s * v[next].K[k][a];
    return isnan (K) ? 0 : K;
}

/* Adds the core terms along the front: int hat' c K_II K_III to J, int hat' c K_III, K_II to the interaction
 * integrals of modes II and III. */
static pg_status add_core (const front_line *l, pg_tip_field *v)
{
    pg_status status = PG_OK;
    const measuring *m = &l->m;
    const pg_front *f = l->front;
    pg_tip_field *old = NULL;
    double hat, slope;
    PG_ALLOC (old, f->n);
    memcpy (old, v, f->n * sizeof *old);
    for (size_t i = 0; i < f->n; i++) {
        if (isnan (v[i].near)) continue;
        tip_material material = material_at (m->p, node_at (l, v[i].x));
        double c = front_core_along (&material, m->h), sum[2][2] = { { 0 } }, J[2][2] = { { 0 } }, total = 0;
        for (size_t j = 0; j < m->n; j++) {
            double K[2][2], u = m->section[j].u;       /* modes II, III of both fields */
            if (!hat_at (l, i, j, &hat, &slope)) continue;
            total += hat;
            for (int a = 0; a < m->nfield; a++)
                for (int k = 0; k < 2; k++) K[k][a] = between (f, old, u, 1 + k, a);
            for (int a = 0; a < m->nfield; a++) {
                sum[0][a] += slope * c * K[1][a], sum[1][a] += slope * c * K[0][a];
                for (int b = 0; b < m->nfield; b++)
                    J[a][b] += 0.5 * slope * c * (K[0][a] * K[1][b] + K[1][a] * K[0][b]);
            }
        }
        for (int a = 0; a < m->nfield; a++) {
            double II = 0.5 * material.modulus * sum[0][a] / total, III = material.mu * sum[1][a] / total;
            v[i].K[1][a] += II, v[i].K_wide[1][a] += II, v[i].K[2][a] += III, v[i].K_wide[2][a] += III;
            for (int b = 0; b < m->nfield; b++)
                v[i].J[a][b] += J[a][b] / total, v[i].J_near[a][b] += J[a][b] / total;
        }
    }
done:
    pg_free (old);
    return status;
}

/* ---- along the front ----------------------------------------------------------------------------------- */
/* Smooths the results along the front with weights 1/4, 1/2, 1/4; a missing neighbour is replaced by the
 * vertex itself. */
static pg_status smooth (const pg_front *f, pg_tip_field *v)
{
    pg_status status = PG_OK;
    enum { N = PG_TIP_NUMBERS };
    double *list = NULL;
    PG_ALLOC (list, N * f->n);
    for (size_t i = 0; i < f->n; i++) memcpy (list + N * i, &v[i], N * sizeof *list);
    for (size_t i = 0; i < f->n; i++) {
        size_t beside[2] = { i ? i - 1 : f->closed ? f->n - 1 : i, i + 1 < f->n ? i + 1 : f->closed ? 0 : i };
        double sum[N];
        for (int k = 0; k < N; k++) sum[k] = 0.5 * list[N * i + (size_t) k];
        for (int side = 0; side < 2; side++) {
            size_t j = isnan (v[beside[side]].near) ? i : beside[side];
            for (int k = 0; k < N; k++) sum[k] += 0.25 * list[N * j + (size_t) k];
        }
        memcpy (&v[i], sum, sizeof sum);
    }
done:
    pg_free (list);
    return status;
}

/* Extrapolates results at ends on the surface linearly from the third and fourth vertex, for the surface has
 * a singularity of its own (Bazant and Estenssoro 1979), and half of the hat is missing. */
static void extrapolate (const pg_front *f, pg_tip_field *v)
{
    if (f->closed || f->n < 5) return;
    for (int end = 0; end < 2; end++) {
        size_t i = end ? f->n - 1 : 0, j = end ? i - 2 : 2, k = end ? i - 3 : 3;
        double a[PG_TIP_NUMBERS], b[PG_TIP_NUMBERS];
        if (f->meets[i] == PG_MEETS_NOTHING || isnan (v[j].near) || isnan (v[k].near)) continue;
        memcpy (a, &v[j], sizeof a), memcpy (b, &v[k], sizeof b);
        for (int q = 0; q < PG_TIP_NUMBERS; q++) b[q] = a[q] + 2 * (a[q] - b[q]);
        if (isnan (v[i].near)) v[i].near = v[j].near, v[i].wide = v[j].wide;
        memcpy (&v[i], b, sizeof b);
        v[i].extrapolated = 1;
    }
}

/* ---- measurement --------------------------------------------------------------------------------------- */
static pg_status prepare (front_line *l)
{
    pg_status status = PG_OK;
    const pg_front *f = l->front;
    measuring *m = &l->m;
    int uneven = m->p->nmaterial > 1;
    m->n = FRONT_SECTIONS * (f->closed ? f->n : f->n - 1);
    for (size_t i = 0; i < f->n; i++) m->h = fmax (m->h, pg_problem_spacing_at (m->p, f->x + 3*i));
    m->r1 = m->h;
    for (int r = 0; r < FRONT_RADII; r++) m->radius[r] = front_radius[r] * m->h;
    for (size_t k = 0; k < m->p->boundary.nload; k++) uneven |= m->p->boundary.load[k].kind == PG_BODY_FORCE;
    if (uneven) PG_TRY (pg_nearest_create (&l->near, 3, m->p->cloud.n, m->p->cloud.x));
    PG_ALLOC (m->section, m->n);
    PG_ALLOC (l->width, f->n);
    PG_TRY (measuring_begin (m, f->n, f->x, m->radius[FRONT_RADII - 1]));
    place_sections (l);
    for (size_t i = 0; i < f->n; i++) l->width[i] = hat_width (l, i);
done:
    return status;
}

pg_status pg_front_measure (pg_tip_field *out, const pg_problem *p, const pg_force_type *force, void *self,
                            const pg_state *state, size_t front, int nfield, const double *const *d,
                            const double *t, const pg_front_faces *faces)
{
    pg_status status = PG_OK;
    size_t nfront;
    const pg_front *fronts = pg_fronts_of_state (p, state, &nfront);
    front_line l = { .m = { .p = p, .force = force, .self = self, .state = state, .nfield = nfield, .d = d,
                            .t = t }, .faces = faces };
    PG_TRY (measuring_check (&l.m));
    if (front >= nfront) PG_FAIL (PG_E_USAGE, "front %zu of %zu is asked for", front, nfront);
    const pg_front *f = l.front = &fronts[front];
    if (f->n < 2) PG_FAIL (PG_E_USAGE, "a front of %zu vertices is asked for", f->n);
    PG_TRY (prepare (&l));
    PG_TRY (measure_sections (&l.m));
    for (size_t i = 0; i < f->n; i++) {
        int radii = begin_vertex (&l, i, &out[i]);
        if (radii) fill_vertex (&l, i, radii, &out[i]);
        out[i].interface = !radii && front_at_interface (p, out[i].x, l.m.radius[0]);
    }
    PG_TRY (add_core (&l, out));
    PG_TRY (smooth (f, out));
    extrapolate (f, out);
    for (size_t i = 0; faces && i < f->n; i++)
        if (faces[i].closed && !isnan (out[i].near)) measured_closed (&out[i], nfield);
done:
    measuring_end (&l.m);
    pg_nearest_free (&l.near);
    pg_free (l.m.section), pg_free (l.width);
    return status;
}

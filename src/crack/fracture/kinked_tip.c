/* SPDX-License-Identifier: GPL-3.0-or-later
 * Stress intensity factors of a tip behind a kink. A ring around the tip itself is unsuitable: exact fields
 * of a straight crack do not apply if the crack turns inside the ring, and the discrete field within two
 * spacings of a kink is inaccurate. So the ring lies around the kink, outside the kinked part. With free
 * faces and without body force Betti's integral of two fields is the same around every path, whatever the
 * crack does inside: with the field h, s of a weight function of the polyline (kinked_weights.c)
 *
 *   K = - int (sigma_ij h_i - s_ij u_i) q,j dA.
 *
 * Outside of the kink a field is a sum of terms that grow with distance (loading) and terms that decay
 * (response of the kink). The weight functions decay, and the integral of two decaying terms vanishes: errors
 * of the discrete response drop out, the loading is well resolved. Therefore the ring also gives K at the end
 * of a facet that does not exist yet.
 *
 * Body force and tractions of the faces. A stress in equilibrium with the body force b at the kink and leaves
 * the straight faces free, sigma_11 = - b_1 x_1, sigma_22 = - b_2 x_2, is subtracted, and the uniform stress
 * of a pressure on all faces. The rest has tractions on the pieces after the kink only, whose K follows from
 * the same system of dislocations (kinked_faces); body force beyond that of the kink adds int (b - b (kink))
 * . h q dA over the ring. Springs are treated as their mean body force.
 *
 * Closed faces of the straight crack: their mean contact stress in the ring is subtracted and becomes a load
 * on the pieces after the kink; deviations from the mean add int t . h q ds over both faces. So wing cracks
 * of a closed crack are treated like those of an open crack under the remaining field. */
#include "kinked_crack.h"
#include "front.h"
#include <math.h>
#include <string.h>

#define BESIDE  0.75                                   /* spacings between the kinked part and the ring */
#define FAR     12.0                                   /* largest outer radius, spacings */
#define STRAIGHT 0.03                                  /* rad: smaller turns are ignored */

/* The path of a tip, tip first, and the kink around which the ring lies. */
typedef struct {
    size_t n, kink;                                    /* number of vertices; index of the kink */
    double *x;                                         /* vertices, n x 2, m */
    double e[2], ahead[2];  /* unit vectors: along the straight crack to the kink, along the last piece */
    double extent, r1, r2;                             /* size of the kinked part; radii of the ring, m */
} turned;

/* ---- the kink ------------------------------------------------------------------------------------------ */
static void heading (const double *from, const double *to, double *e)
{
    double t[2] = { to[0] - from[0], to[1] - from[1] }, length = hypot (t[0], t[1]);
    e[0] = t[0] / length, e[1] = t[1] / length;
}

static double turn_between (const double *e, const double *f)
{
    return atan2 (e[0] * f[1] - e[1] * f[0], e[0] * f[0] + e[1] * f[1]);
}

/* Length over which the crack is straight behind vertex j, m. */
static double straight_behind (const turned *t, size_t j)
{
    double e[2], f[2];
    heading (t->x + 2*j + 2, t->x + 2*j, e);
    size_t end = j + 1;
    for (; end + 1 < t->n; end++) {
        heading (t->x + 2*end + 2, t->x + 2*end, f);
        if (fabs (turn_between (e, f)) > STRAIGHT) break;
    }
    return hypot (t->x[2*end] - t->x[2*j], t->x[2*end + 1] - t->x[2*j + 1]);
}

/* Distance from x of the middle of a closed piece that lies on the straight crack ending at x in direction e,
 * m; NAN: it does not lie on it. */
static double on_straight (const pg_face_piece *p, const double *x, const double *e, double h)
{
    double v[2] = { p->x[0] - x[0], p->x[1] - x[1] }, behind = -(v[0] * e[0] + v[1] * e[1]);
    int along = fabs (p->normal[0] * e[0] + p->normal[1] * e[1]) < 0.1;
    return along && behind > 0 && fabs (v[1] * e[0] - v[0] * e[1]) < 0.5 * h ? behind : NAN;
}

/* Outer radius of a ring around x, m, at most r2: limited by closed pieces not on the straight crack that
 * ends at x in direction e. */
static double room_of_faces (const double *x, const double *e, double h, const pg_tip_faces *touch, double r2)
{
    for (size_t k = 0; touch && k < touch->npiece; k++) {
        const pg_face_piece *p = &touch->piece[k];
        if (isnan (on_straight (p, x, e, h)))
            r2 = fmin (r2, hypot (p->x[0] - x[0], p->x[1] - x[1]) - 0.5 * p->length);
    }
    return r2;
}

/* Finds the vertex with the widest possible ring among those behind which the crack is straight and after
 * which it has turned. *any 0: none. */
static pg_status find_kink (turned *out, const pg_problem *p, const pg_state *state, size_t tip, double h,
                            size_t node, const pg_tip_faces *touch, int *any)
{
    pg_status status = PG_OK;
    double e[2], f[2], extent = 0, best = TIP_LEAST * h;
    int turns = 0;
    *any = 0;
    PG_TRY (pg_tip_vertices (state->paths, tip, &out->n, &out->x));
    for (size_t j = 1; j + 1 < out->n; j++) {
        const double *x = out->x + 2*j;
        extent = 0;
        for (size_t i = 0; i < j; i++)
            extent = fmax (extent, hypot (out->x[2*i] - x[0], out->x[2*i + 1] - x[1]));
        double r1 = extent + BESIDE * h, r2 = fmin (FAR * h, straight_behind (out, j));
        heading (x, x - 2, e), heading (x + 2, x, f);
        turns |= fabs (turn_between (f, e)) > STRAIGHT;
        if (FAR * h - r1 < best) break;
        r2 = room_of_faces (x, f, h, touch, r2);
        if (!turns || r2 - r1 <= best) continue;
        size_t here = tip_node_at (p, x);
        if (!tip_same_material (p, here, node)) continue;
        r2 = tip_room_about (p, state, tip, x, here, r2);
        if (r2 - r1 <= best) continue;
        best = r2 - r1, *any = 1, out->kink = j, out->extent = extent, out->r1 = r1, out->r2 = r2;
        memcpy (out->e, f, sizeof f);
    }
    heading (out->x + 2, out->x, out->ahead);
done:
    return status;
}

/* A position x (m) as a complex number in the frame of the kink, in units of r1. */
static double complex frame_of (const turned *t, const double *x)
{
    double v[2] = { x[0] - t->x[2 * t->kink], x[1] - t->x[2 * t->kink + 1] };
    return (t->e[0] * v[0] + t->e[1] * v[1] + _Complex_I * (t->e[0] * v[1] - t->e[1] * v[0])) / t->r1;
}

/* ---- the field in the ring ----------------------------------------------------------------------------- */
/* Subtracts the uniform stress S (11, 22, 12) and the stress in equilibrium with the body force b, with their
 * displacements. */
static void subtract (front_places *q, int at, const tip_material *m, const kinked_faces *f)
{
    double modulus = m->modulus, nu = (3 - m->kappa) / (1 + m->kappa), *u = q->field[at].u,
           *s = q->field[at].S, *load = q->field[at].load;
    double e11 = (f->S[0] - nu * f->S[1]) / modulus, e22 = (f->S[1] - nu * f->S[0]) / modulus,
           e12 = f->S[2] / (2 * m->mu), b1 = f->b[0] / modulus, b2 = f->b[1] / modulus;
    for (size_t k = 0; k < q->n; k++) {
        double x = q->r[k] * cos (q->theta[k]), y = q->r[k] * sin (q->theta[k]);
        u[3*k] -= e11 * x + e12 * y - 0.5 * b1 * (x * x + nu * y * y) + nu * b2 * x * y;
        u[3*k + 1] -= e12 * x + e22 * y - 0.5 * b2 * (y * y + nu * x * x) + nu * b1 * x * y;
        s[9*k] -= f->S[0] - f->b[0] * x, s[9*k + 4] -= f->S[1] - f->b[1] * y, s[9*k + 1] -= f->S[2];
        if (load) load[3*k] -= f->b[0], load[3*k + 1] -= f->b[1];
    }
}

/* Subtracts the mean displacement and rotation of the ring, which contribute only rounding and quadrature
 * errors. spin: rotation already removed from the gradient, rad. */
static void take_rigid_motion_off (front_places *q, int at, double spin)
{
    double sum[3] = { 0 }, area = 0, *u = q->field[at].u;
    for (size_t k = 0; k < q->n; k++) {
        const double *H = q->field[at].H + 9*k;
        double w = q->area[k];
        area += w, sum[0] += w * u[3*k], sum[1] += w * u[3*k + 1], sum[2] += 0.5 * w * (H[3] - H[1]);
    }
    for (int i = 0; i < 3; i++) sum[i] /= area;
    sum[2] += spin;
    for (size_t k = 0; k < q->n; k++) {
        double x = q->r[k] * cos (q->theta[k]), y = q->r[k] * sin (q->theta[k]);
        u[3*k] -= sum[0] - sum[2] * y, u[3*k + 1] -= sum[1] + sum[2] * x;
    }
}

/* Mean body force over the ring, N/m^3, taken as that at the kink. */
static void mean_load (const front_places *q, int at, double *b)
{
    double area = 0;
    b[0] = b[1] = 0;
    for (size_t k = 0; q->field[at].load && k < q->n; k++) {
        area += q->area[k];
        for (size_t i = 0; i < 2; i++) b[i] += q->area[k] * q->field[at].load[3*k + i];
    }
    for (int i = 0; i < 2; i++) b[i] = area > 0 ? b[i] / area : 0;
}

/* Adds the moments of field `at` over the ring r1 .. r2, from which K_I and K_II of the tip follow. */
static void add_ring (kinked_moments *out, const front_places *ring, int at, const tip_material *m,
                      const turned *t, double r1, double r2, double extent)
{
    double unit = t->r1;
    const front_sample *f = &ring->field[at];
    for (size_t k = 0; k < ring->n; k++) {
        double slope, q = front_weight (ring->r[k], r1, r2, &slope), c = cos (ring->theta[k]),
                      s = sin (ring->theta[k]), g[2] = { slope * c * unit, slope * s * unit },
                      w = ring->area[k] / (unit * unit);
        const double *S = f->S + 9*k, u[2] = { w * f->u[3*k] / unit, w * f->u[3*k + 1] / unit };
        if (q <= 0) continue;
        kinked_place at_k = { .z = ring->r[k] / unit * (c + _Complex_I * s),
                              .t = w * (S[0] * g[0] + S[1] * g[1] + _Complex_I * (S[1] * g[0] + S[4] * g[1])),
                              .M = { u[0] * g[0], u[1] * g[1], 0.5 * (u[0] * g[1] + u[1] * g[0]) } };
        if (f->load) at_k.t -= w * q * unit * (f->load[3*k] + _Complex_I * f->load[3*k + 1]);
        if (slope != 0 || f->load) kinked_moments_add (out, &at_k, m->mu, m->kappa, extent / unit);
    }
}

/* Contact stresses sigma_12 and sigma_22 (Pa) of the straight faces: of each field the mean over the ring,
 * and the deviation from it at each place behind the kink. any 0: no contact. */
typedef struct { int any; double mean[TIP_FIELDS][2], more[TIP_FIELDS][KINKED_PLACES][2]; } straight_faces;

static void look_at_faces (straight_faces *out, const turned *t, const pg_tip_faces *touch, double h,
                           int nfield)
{
    const double *x = t->x + 2 * t->kink;
    int within = 0;
    memset (out, 0, sizeof *out);
    for (int i = 0; touch && i < KINKED_PLACES; i++) {
        double r = kinked_place_at (t->r2, i);
        within += r > t->r1;
        for (size_t k = 0; k < touch->npiece; k++) {
            const pg_face_piece *p = &touch->piece[k];
            double at = on_straight (p, x, t->e, h);
            if (!(fabs (at - r) <= 0.5 * p->length)) continue;
            out->any = 1;
            for (int a = 0; a < nfield; a++)
                for (int m = 0; m < 2; m++) {
                    out->more[a][i][m] = p->stress[a][1 - m];
                    if (r > t->r1) out->mean[a][m] += p->stress[a][1 - m];
                }
            break;
        }
    }
    for (int a = 0; a < nfield; a++)
        for (int m = 0; m < 2; m++) {
            if (within) out->mean[a][m] /= within;
            for (int i = 0; i < KINKED_PLACES; i++) out->more[a][i][m] -= out->mean[a][m];
        }
}

/* Adds the deviations of contact stresses to the moments of a field over the ring from r1 to t->r2. */
static void add_faces (kinked_moments *out, const straight_faces *faces, int at, const tip_material *m,
                       const turned *t, double r1)
{
    for (int i = 0; faces->any && i < KINKED_PLACES; i++) {
        double q = front_weight (kinked_place_at (t->r2, i), r1, t->r2, NULL);
        kinked_moments_face (out, i, faces->more[at][i], q, m->mu, m->kappa, t->r2 / t->r1);
    }
}

/* Evaluates the fields in the ring, with free straight faces, without body force at the kink, and u in the
 * frame of the kink. */
static pg_status sample_ring (front_places *q, kinked_faces *faces, const measuring *m,
                              const pg_tip_field *ring, const straight_faces *press)
{
    pg_status status = PG_OK;
    const cross_section *s = m->section;
    int forced = has_body_force (m->p, s->node);
    PG_TRY (tip_rings_create (q, m->p, ring, 0));
    for (int a = 0; a < m->nfield; a++) {
        const double *stress = press->mean[a];
        double *u, pressure = m->pressure[a];
        PG_TRY (places_sample (q, m, a));
        if (forced) PG_TRY (places_force (q, m, a));
        PG_TRY (springs_spread (q, m, a));
        u = q->field[a].u;
        for (size_t k = 0; k < q->n; k++) {
            const double scene[3] = { u[3*k], u[3*k + 1] };
            front_turn_vector (s->at.frame, scene, u + 3*k);
        }
        take_rigid_motion_off (q, a, m->field[a].spin[2]);
        kinked_faces all = { .S = { -pressure, stress[1] - pressure, stress[0] } };
        mean_load (q, a, all.b);
        subtract (q, a, &s->material, &all);
        faces[a] = (kinked_faces) { .S = { 0, stress[1], stress[0] },
                                    .b = { all.b[0] * ring->r1, all.b[1] * ring->r1 } };
    }
done:
    return status;
}

/* ---- intensities --------------------------------------------------------------------------------------- */
/* Computes the weight functions of the polyline, with a trial facet at angle theta added if facet > 0. */
static pg_status weights_of (kinked_weights *out, const turned *t, double facet, double theta, int nfield,
                             const kinked_faces *faces, const straight_faces *press)
{
    pg_status status = PG_OK;
    size_t n = t->kink;
    double complex *vertex = NULL;
    PG_ALLOC (vertex, n + 1);
    for (size_t i = 0; i < n; i++) vertex[i] = frame_of (t, t->x + 2 * (n - 1 - i));
    if (facet > 0) {
        double c = facet * cos (theta), s = facet * sin (theta), to[2];
        to[0] = t->x[0] + c * t->ahead[0] - s * t->ahead[1];
        to[1] = t->x[1] + c * t->ahead[1] + s * t->ahead[0];
        vertex[n++] = frame_of (t, to);
    }
    PG_TRY (kinked_weights_of (out, n, vertex, (size_t) nfield, faces, press->any ? t->r2 / t->r1 : 0));
done:
    pg_free (vertex);
    return status;
}

static const double trial_angles[PG_TIP_TRIALS] = { -0.8, -0.4, 0, 0.4, 0.8 };

/* Computes K at the end of each trial facet. */
static pg_status measure_trials (pg_tip_field *out, const turned *t, const front_places *grid, int nfield,
                                 const tip_material *m, const kinked_faces *faces,
                                 const straight_faces *press, double facet)
{
    pg_status status = PG_OK;
    kinked_moments moments[TIP_FIELDS];
    kinked_weights w;
    double r1 = t->r1 + facet, K[2];
    memset (moments, 0, sizeof moments);
    out->trial = 0;
    if (!(facet > 0) || t->r2 - r1 < TIP_LEAST * out->h) return PG_OK;
    for (int a = 0; a < nfield; a++) {
        add_ring (&moments[a], grid, a, m, t, r1, t->r2, t->extent + facet);
        add_faces (&moments[a], press, a, m, t, r1);
    }
    for (int i = 0; i < PG_TIP_TRIALS; i++) {
        out->trial_angle[i] = trial_angles[i];
        PG_TRY (weights_of (&w, t, facet, trial_angles[i], nfield, faces, press));
        for (int a = 0; a < nfield; a++) {
            if (!kinked_intensities (&w, &moments[a], m->modulus, (size_t) a, K)) goto done;
            for (int k = 0; k < 2; k++) out->trial_K[i][k][a] = K[k] * sqrt (t->r1);
        }
    }
    out->trial = facet;
done:
    return status;
}

/* Computes K and J at the tip from the ring, and J_near from its outer half. */
static pg_status measure_tip (pg_tip_field *out, const turned *t, const front_places *grid, int nfield,
                              const tip_material *m, const kinked_faces *faces, const straight_faces *press,
                              int *done)
{
    pg_status status = PG_OK;
    kinked_weights w;
    double half = 0.5 * (t->r1 + t->r2), near[2][TIP_FIELDS], K[2];
    *done = 0;
    PG_TRY (weights_of (&w, t, 0, 0, nfield, faces, press));
    for (int a = 0; a < nfield; a++)
        for (int outer = 0; outer < 2; outer++) {
            kinked_moments moments;
            memset (&moments, 0, sizeof moments);
            add_ring (&moments, grid, a, m, t, outer ? half : t->r1, t->r2, t->extent);
            add_faces (&moments, press, a, m, t, outer ? half : t->r1);
            if (!kinked_intensities (&w, &moments, m->modulus, (size_t) a, K)) goto done;
            for (int k = 0; k < 2; k++)
                if (outer) near[k][a] = K[k] * sqrt (t->r1);
                else out->K[k][a] = out->K_wide[k][a] = K[k] * sqrt (t->r1);
        }
    for (int a = 0; a < nfield; a++) {
        for (int b = 0; b < nfield; b++) {
            out->J[a][b] = out->J_near[a][b] = 0;
            for (int k = 0; k < 2; k++)
                out->J[a][b] += out->K[k][a] * out->K[k][b] / m->modulus,
                    out->J_near[a][b] += near[k][a] * near[k][b] / m->modulus;
        }
        out->K[2][a] = out->K_wide[2][a] = 0, out->T[a] = NAN;
    }
    *done = 1;
done:
    return status;
}

pg_status kinked_tip_measure (pg_tip_field *out, const measuring *at_tip, size_t tip, double facet,
                              const pg_tip_faces *touch, int *done)
{
    pg_status status = PG_OK;
    const pg_problem *p = at_tip->p;
    const tip_material *material = &at_tip->section->material;
    measuring m = *at_tip;
    cross_section at_kink;
    turned t = { 0 };
    front_places grid = { 0 };
    kinked_faces faces[TIP_FIELDS];
    straight_faces press;
    *done = 0;
    PG_TRY (find_kink (&t, p, m.state, tip, out->h, at_tip->section->node, touch, done));
    if (!*done) goto done;
    const double *kink = t.x + 2 * t.kink;
    look_at_faces (&press, &t, touch, out->h, m.nfield);
    pg_tip_field ring = { .x = { kink[0], kink[1] }, .e = { t.e[0], t.e[1] }, .h = out->h, .r1 = t.r1,
                          .near = 0.5 * (t.r1 + t.r2), .wide = t.r2 };
    at_kink = tip_section (p, kink, t.e, tip_node_at (p, kink)), at_kink.material = *material;
    m.section = &at_kink;
    PG_TRY (sample_ring (&grid, faces, &m, &ring, &press));
    PG_TRY (measure_tip (out, &t, &grid, m.nfield, material, faces, &press, done));
    if (!*done) goto done;
    out->r1 = ring.r1, out->near = ring.near, out->wide = ring.wide, out->kinked = 1;
    for (int k = 0; k < 2; k++) out->kink[k] = kink[k], out->e[k] = t.ahead[k];
    PG_TRY (measure_trials (out, &t, &grid, m.nfield, material, faces, &press, facet));
done:
    places_clear (&grid);
    pg_free (t.x);
    return status;
}

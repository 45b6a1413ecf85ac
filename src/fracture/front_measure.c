/* SPDX-License-Identifier: GPL-3.0-or-later
 * J, K_I, K_II, K_III and T along a front in space. Cross sections lie twice between two vertices and serve
 * all of them; a vertex takes those within three vertices of it, weighed by the hat 1 - |u - i| / 3: fields
 * of points follow the front in steps of the lattice, and a narrower hat shows the steps.
 *
 * All cross sections in the hat of a vertex have one radius, the largest that there is room for at all of
 * them: 4 spacings for J, 3 for K, which tells the direction; then 2.25 and 1.5. Where one has no room for
 * that either, the hats that reach it are narrower, 2 vertices or 1, then there is no number. */
#include "front.h"
#include "gradient_fit.h"
#include <math.h>
#include <string.h>

enum { CHUNK = 16 };                                   /* cross sections that are sampled at a time */

typedef struct {
    const pg_problem *p;
    const pg_force_type *force;
    void *self;
    const pg_state *state;
    const pg_front *front;
    int nfield;
    const double *const *d, *t;
    mean_motion field[TIP_FIELDS];
    const pg_front_faces *faces;                       /* of each vertex; NULL: they do not touch */
    double h;                                          /* the largest local spacing along the front, m */
    pg_nearest *near;                                  /* among the points; NULL: all are alike */
    size_t n;                                          /* cross sections */
    double *u, *room;                                  /* of each: where on the front; m */
    double *width;                                     /* of the hat of each vertex, in vertices */
    int *radii, *load;  /* for how many radii there is room; number of the load that ends it, -1: none does */
    front_place *place;
    front_sums *sums;
} measuring;

/* ---- material, forces ---------------------------------------------------------------------------------- */
static size_t node_at (const measuring *m, const double *x)
{
    return m->near ? (size_t) pg_nearest_find (m->near, x, NULL, NULL) : 0;
}

/* Plane strain across the front. */
static tip_material material_at (const measuring *m, const double *x)
{
    size_t node = (size_t) node_at (m, x);
    int block = m->p->block[PG_NODES][node];
    const pg_material *law = pg_problem_law (m->p, PG_NODES, node);
    double kappa = 3 - 4 * law->nu;
    return (tip_material){ .mu = law->mu,
                           .kappa = kappa,
                           .modulus = 8 * law->mu / (kappa + 1),
                           .density = law->density,
                           .law = law,
                           .lambda = m->p->patches ? m->p->patches->lambda[block] : 0 };
}

static int any_body_force (const pg_problem *p)
{
    for (size_t l = 0; l < p->nload; l++) if (p->load[l].kind == PG_BODY_FORCE) return 1;
    return 0;
}

static int acts (const pg_load *load, size_t node)
{
    for (size_t i = 0; load->kind == PG_BODY_FORCE && i < load->set->npoint; i++)
        if ((size_t) load->set->point[i] == node) return 1;
    return 0;
}

/* Pressure in the cracks in field `at`: of t[at], less that of t[0] for the second. */
static double pressure_in (const measuring *m, int at)
{
    static const double anywhere[3] = { 0 };
    double sum = 0;
    for (size_t l = 0; l < m->p->nload; l++) {
        const pg_load *load = &m->p->load[l];
        if (!load->cracks) continue;
        sum += pg_load_value (load, 0, 3, anywhere, m->t[at]);
        if (at > 0) sum -= pg_load_value (load, 0, 3, anywhere, m->t[0]);
    }
    return sum;
}

static int moves (const measuring *m)
{
    if (m->nfield != 1 || m->d[0] != m->state->d) return 0;
    for (size_t i = 0; i < m->state->ndof; i++)
        if (m->state->v[i] != 0 || m->state->a[i] != 0) return 1;
    return 0;
}

/* ---- cross sections ------------------------------------------------------------------------------------ */
/* Fields at the places of a chunk of cross sections. */
typedef struct {
    size_t n;                                          /* places */
    double *x, *u, *stress, *gradient, *v, *vgradient, *a;
    unsigned char *in;
    front_sample field[TIP_FIELDS];
} chunk;

static void chunk_clear (chunk *c)
{
    for (int a = 0; a < TIP_FIELDS; a++)
        pg_free (c->field[a].H), pg_free (c->field[a].S), pg_free (c->field[a].excess),
            pg_free (c->field[a].load), pg_free (c->field[a].kinetic), pg_free (c->field[a].moving);
    pg_free (c->x), pg_free (c->u), pg_free (c->stress), pg_free (c->gradient), pg_free (c->v);
    pg_free (c->vgradient), pg_free (c->a), pg_free (c->in);
    memset (c, 0, sizeof *c);
}

static pg_status chunk_create (chunk *c, const measuring *m, int moving)
{
    pg_status status = PG_OK;
    size_t n = CHUNK * FRONT_PLACES;
    int forced = any_body_force (m->p) || moving;
    memset (c, 0, sizeof *c);
    PG_ALLOC (c->x, 3 * n);
    PG_ALLOC (c->u, 3 * n);
    PG_ALLOC (c->stress, 6 * n);
    PG_ALLOC (c->gradient, 9 * n);
    PG_ALLOC (c->in, n);
    for (int a = 0; a < m->nfield; a++) {
        PG_ALLOC (c->field[a].H, 9 * n);
        PG_ALLOC (c->field[a].S, 9 * n);
        if (m->p->patches) PG_ALLOC (c->field[a].excess, n);
        if (forced) PG_ALLOC (c->field[a].load, 3 * n);
    }
    if (!moving) goto done;
    PG_ALLOC (c->v, 3 * n);
    PG_ALLOC (c->a, 3 * n);
    PG_ALLOC (c->vgradient, 9 * n);
    PG_ALLOC (c->field[0].kinetic, n);
    PG_ALLOC (c->field[0].moving, n);
done:
    return status;
}

/* Places of cross section j, those that are needed: within its room, and in the body. */
static void place_section (const measuring *m, const front_section *s, size_t j, size_t slot, chunk *c)
{
    const front_place *at = &m->place[j];
    double end = m->radii[j] ? front_radius[m->radii[j] - 1] * m->h : 0;
    for (size_t k = 0; k < FRONT_PLACES; k++) {
        double x[3], y = s->r[k] * cos (s->theta[k]), z = s->r[k] * sin (s->theta[k]);
        if (s->r[k] >= end) continue;
        for (int i = 0; i < 3; i++) x[i] = at->x[i] + y * at->frame[i] + z * at->frame[3 + i];
        if (!pg_problem_has_body (m->p, x)) continue;
        c->in[slot * FRONT_PLACES + k] = 1;
        memcpy (c->x + 3 * c->n++, x, sizeof x);
    }
}

/* The pressure p of the cracks, subtracted from the whole body, leaves faces that are free; its strain is p /
 * (3 lambda + 2 mu) in all directions. */
static void free_faces (front_sample *f, size_t k, const tip_material *m, double pressure)
{
    double nu = 0.25 * (3 - m->kappa), strain = pressure * (1 - 2 * nu) / (2 * m->mu * (1 + nu));
    for (size_t i = 0; i < 9; i += 4) f->H[9*k + i] += strain, f->S[9*k + i] += pressure;
}

/* Body force of field a at x into its load, in the frame. */
static void add_body_force (const measuring *m, int a, const double *x, const front_place *at, double *load)
{
    double b[3] = { 0 };
    size_t node = node_at (m, at->x);
    for (size_t l = 0; l < m->p->nload; l++) {
        if (!acts (&m->p->load[l], node)) continue;
        for (int c = 0; c < 3; c++) {
            double density = pg_load_density (m->p, &m->p->load[l], PG_NODES, node);
            b[c] += density * pg_load_value (&m->p->load[l], c, 3, x, m->t[a]);
            if (a > 0) b[c] -= density * pg_load_value (&m->p->load[l], c, 3, x, m->t[0]);
        }
    }
    front_turn_vector (at->frame, b, load);
}

/* Place number `from` of the sampled ones, as place k of the arrays of field a. */
static void take_place (const measuring *m, chunk *c, int a, size_t from, size_t k, const front_place *at,
                        const tip_material *material, double pressure)
{
    front_sample *f = &c->field[a];
    const double *s = c->stress + 6 * from, *G = c->gradient + 9 * from;
    double full[9] = { s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2] };
    front_turn_tensor (at->frame, G, f->H + 9*k), front_turn_tensor (at->frame, full, f->S + 9*k);
    if (f->excess) {
        double strained[6];
        pg_stress_of_gradient (material->law, 3, G, strained);
        f->excess[k] = material->lambda > 0
                           ? (s[0] + s[1] + s[2] - strained[0] - strained[1] - strained[2]) / 3 : 0;
    }
    if (pressure != 0) free_faces (f, k, material, pressure);
    if (f->load) add_body_force (m, a, c->x + 3 * from, at, f->load + 3*k);
    if (!f->kinetic) return;
    double v[3], acceleration[3], H[9];
    front_turn_vector (at->frame, c->v + 3 * from, v), front_turn_vector (at->frame, c->a + 3 * from,
                                                                          acceleration);
    front_turn_tensor (at->frame, c->vgradient + 9 * from, H);
    f->kinetic[k] = material->density * (v[0] * H[0] + v[1] * H[3] + v[2] * H[6]);
    f->moving[k] = 0.5 * material->density * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (size_t i = 0; i < 3; i++) f->load[3*k + i] -= material->density * acceleration[i];
}

/* Samples cross sections first .. last - 1 and sums them. */
static pg_status measure_sections (measuring *m, const front_section *s, size_t first, size_t last, chunk *c,
                                   int moving)
{
    pg_status status = PG_OK;
    c->n = 0;
    memset (c->in, 0, CHUNK * FRONT_PLACES);
    for (size_t j = first; j < last; j++) place_section (m, s, j, j - first, c);
    for (int a = 0; a < m->nfield && c->n; a++) {
        double pressure = pressure_in (m, a);
        size_t from = 0;
        PG_TRY (gradient_sample (m->p, m->force, m->self, m->state, m->field[a].d, c->n, c->x, c->u,
                                 c->stress, c->gradient));
        if (moving) {
            PG_TRY (gradient_sample (m->p, m->force, m->self, m->state, m->state->v, c->n, c->x, c->v, NULL,
                                     c->vgradient));
            PG_TRY (gradient_sample (m->p, m->force, m->self, m->state, m->state->a, c->n, c->x, c->a, NULL,
                                     NULL));
        }
        for (size_t j = first; j < last; j++) {
            tip_material material = material_at (m, m->place[j].x);
            double stress[3];
            int closed = front_faces_at (m->front, m->faces, a, m->u[j], m->place[j].frame, stress);
            for (size_t k = (j - first) * FRONT_PLACES; k < (j - first + 1) * FRONT_PLACES; k++) {
                if (!c->in[k]) continue;
                take_place (m, c, a, from++, k, &m->place[j], &material, pressure);
                if (closed) front_faces_part (&c->field[a], k, &material, stress);
            }
        }
    }
    for (size_t j = first; j < last; j++) {
        tip_material material = material_at (m, m->place[j].x);
        front_sample field[TIP_FIELDS];
        size_t k = (j - first) * FRONT_PLACES;
        for (int a = 0; a < m->nfield; a++) {
            const front_sample *f = &c->field[a];
            field[a] = (front_sample){ .H = f->H + 9*k, .S = f->S + 9*k };
            if (f->excess && material.lambda > 0) field[a].excess = f->excess + k;
            if (f->load) field[a].load = f->load + 3*k;
            if (f->kinetic) field[a].kinetic = f->kinetic + k, field[a].moving = f->moving + k;
        }
        front_integrals (&m->sums[j], s, &m->place[j], &material, m->h, m->radii[j], c->in + k, m->nfield,
                         field);
    }
done:
    return status;
}

static tip_material material_of (const void *context, const double *x) { return material_at (context, x); }

/* The strain of uniform stresses that are subtracted, from the gradient of field a in a section. */
static void part (const void *context, int a, size_t section, const tip_material *material, double *H)
{
    const measuring *m = context;
    double S[9] = { 0 }, stress[3], pressure = pressure_in (m, a);
    front_sample one = { .H = H, .S = S };
    if (pressure != 0) free_faces (&one, 0, material, pressure);
    if (front_faces_at (m->front, m->faces, a, m->u[section], m->place[section].frame, stress))
        front_faces_part (&one, 0, material, stress);
}

static pg_status add_springs (measuring *m)
{
    const front_springs s = { .p = m->p, .force = m->force, .self = m->self, .state = m->state,
                              .nfield = m->nfield, .d = m->field, .t = m->t, .h = m->h, .n = m->n,
                              .place = m->place, .radii = m->radii, .sums = m->sums, .context = m,
                              .material = material_of, .part = part };
    return front_springs_add (&s);
}

/* Where the cross sections are, and how much room each has. */
static void place_sections (measuring *m)
{
    const pg_front *f = m->front;
    double limit = front_radius[FRONT_RADII - 1] * m->h, same = pg_cloud_same (&m->p->cloud);
    for (size_t j = 0; j < m->n; j++) {
        front_place *at = &m->place[j];
        int tail = 0;
        m->u[j] = ((double) j + 0.5) / FRONT_SECTIONS;
        front_at (f, m->u[j], at);
        for (size_t end = 0; !f->closed && end < f->n; end += f->n - 1) {
            double d = 0;
            for (size_t k = 0; k < 3; k++) d = hypot (d, at->x[k] - f->x[3 * end + k]);
            tail |= f->meets[end] != PG_MEETS_NOTHING && d < limit;
        }
        double offset = f->offset[(size_t) (m->u[j] + 0.5) % f->n];
        m->room[j] = front_room (m->p, m->state, at, m->h, offset, limit, tail, &m->load[j]);
        if (m->faces) m->room[j] = fmin (m->room[j], front_faces_clear (f, m->faces, m->u[j]));
        while (m->radii[j] < FRONT_RADII && front_radius[m->radii[j]] * m->h <= m->room[j] + same)
            m->radii[j]++;
    }
}

/* ---- vertices ------------------------------------------------------------------------------------------ */
/* How wide the hat of vertex i is, in vertices: on short loops half of them; narrower where a cross section
 * in it has no room, for a number that follows the lattice more tells more than none. */
static double hat_width (const measuring *m, size_t i)
{
    const pg_front *f = m->front;
    double width = f->closed ? fmin (FRONT_HAT, 0.5 * (double) f->n) : FRONT_HAT, clear = width;
    for (size_t j = 0; j < m->n; j++) if (m->radii[j] == 0) clear = fmin (clear, front_gap (f, m->u[j], i));
    return clear >= 1 ? fmin (width, floor (clear)) : width;
}

/* The hat of vertex i at cross section j times the length of front that this stands for (m), and its
 * derivative along the front times that length. 0: it does not reach so far. */
static int hat_at (const measuring *m, size_t i, size_t j, double *hat, double *slope)
{
    double width = m->width[i], gap = front_gap (m->front, m->u[j], i), n = (double) m->front->n;
    double ahead = m->u[j] - (double) i;
    if (gap >= width) return 0;
    if (m->front->closed && ahead > 0.5 * n) ahead -= n;
    if (m->front->closed && ahead < -0.5 * n) ahead += n;
    *hat = (1 - gap / width) * m->place[j].speed / FRONT_SECTIONS;
    *slope = (ahead > 0 ? -1 : 1) / (width * FRONT_SECTIONS);
    return 1;
}

static void unknown (pg_tip_field *out)
{
    for (int a = 0; a < 2; a++) {
        for (int b = 0; b < 2; b++) out->J[a][b] = out->J_near[a][b] = NAN;
        for (int k = 0; k < 3; k++) out->K[k][a] = out->K_wide[k][a] = NAN;
        out->T[a] = NAN;
    }
    out->near = out->wide = NAN;
}

/* Frame and room of vertex i; returns how many radii there is room for. */
static int begin_vertex (const measuring *m, size_t i, pg_tip_field *out)
{
    front_place at;
    int radii = FRONT_RADII;
    tip_material material;
    double hat, slope;
    memset (out, 0, sizeof *out);
    front_at (m->front, (double) i, &at);
    memcpy (out->x, m->front->x + 3*i, sizeof out->x);
    memcpy (out->e, at.frame, sizeof out->e);
    memcpy (out->normal, at.frame + 3, sizeof out->normal);
    memcpy (out->tangent, at.frame + 6, sizeof out->tangent);
    material = material_at (m, out->x);
    out->load = -1;
    out->h = out->r1 = m->h, out->room = front_radius[FRONT_RADII - 1] * m->h;
    out->modulus = material.modulus, out->antiplane = material.modulus / (2 * material.mu);
    for (size_t j = 0; j < m->n; j++) {
        if (!hat_at (m, i, j, &hat, &slope)) continue;
        if (m->radii[j] < radii) radii = m->radii[j];
        if (m->room[j] < out->room) {
            out->room = m->room[j], out->load = m->load[j];
            out->limit = out->load < 0 ? PG_ROOM_FREE : PG_ROOM_LOAD;
        }
        if (front_gap (m->front, m->u[j], i) < 0.5) out->length += m->place[j].speed / FRONT_SECTIONS;
    }
    unknown (out);
    if (radii == 0) return 0;
    out->wide = front_radius[radii - 1] * m->h;
    out->near = front_radius[radii < 3 ? radii - 1 : 2] * m->h;
    return radii;
}

/* Sums of the hat of vertex i over radius number r, without the core along the front. */
static void sum_vertex (const measuring *m, size_t i, int r, double J[2][2], double I[FRONT_FIELDS][2],
                        double strain[2], double by_K[2])
{
    double total = 0, hat, slope;
    memset (J, 0, 4 * sizeof (double)), memset (I, 0, 2 * FRONT_FIELDS * sizeof (double));
    for (int a = 0; a < 2; a++) strain[a] = by_K[a] = 0;
    for (size_t j = 0; j < m->n; j++) {
        const front_sums *s = &m->sums[j];
        if (!hat_at (m, i, j, &hat, &slope)) continue;
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
 * strain that K itself makes at the places where it was taken. */
static void fill_vertex (const measuring *m, size_t i, int radii, pg_tip_field *out)
{
    double I[FRONT_FIELDS][2], spare[FRONT_FIELDS][2], strain[2], by_K[2];
    tip_material material = material_at (m, out->x);
    double factor[3] = { 0.5 * material.modulus, 0.5 * material.modulus, material.mu },
           nu = 0.25 * (3 - material.kappa);
    int near = radii < 3 ? radii - 1 : 2;
    sum_vertex (m, i, near, out->J_near, spare, strain, by_K);
    sum_vertex (m, i, radii - 1, out->J, I, strain, by_K);
    for (int a = 0; a < m->nfield; a++) {
        for (int k = 0; k < 3; k++)
            out->K[k][a] = factor[k] * spare[k][a], out->K_wide[k][a] = factor[k] * I[k][a];
        double own = by_K[0] * out->K_wide[0][a] + by_K[1] * out->K_wide[1][a];
        out->T[a] = material.modulus * (I[FRONT_FORCE][a] + nu * (strain[a] - own));
        out->T[a] -= pressure_in (m, a);
    }
}

/* K of mode k, field a, between the vertices at u; 0 where it is not known. */
static double between (const measuring *m, const pg_tip_field *v, double u, int k, int a)
{
    size_t n = m->front->n, i = (size_t) u % n, next = (i + 1) % n;
    double s = u - floor (u), K = (1 - s) * v[i].K[k][a] + s * v[next].K[k][a];
    return isnan (K) ? 0 : K;
}

/* What the core adds along the front: int hat' c K_II K_III to J, int hat' c K_III, K_II to the interaction
 * integrals of modes II and III. */
static pg_status add_core (const measuring *m, pg_tip_field *v)
{
    pg_status status = PG_OK;
    pg_tip_field *old = NULL;
    double hat, slope;
    PG_ALLOC (old, m->front->n);
    memcpy (old, v, m->front->n * sizeof *old);
    for (size_t i = 0; i < m->front->n; i++) {
        if (isnan (v[i].near)) continue;
        tip_material material = material_at (m, v[i].x);
        double c = front_core_along (&material, m->h), sum[2][2] = { { 0 } }, J[2][2] = { { 0 } }, total = 0;
        for (size_t j = 0; j < m->n; j++) {
            if (!hat_at (m, i, j, &hat, &slope)) continue;
            total += hat;
            for (int a = 0; a < m->nfield; a++) {
                double II = between (m, old, m->u[j], 1, a), III = between (m, old, m->u[j], 2, a);
                sum[0][a] += slope * c * III, sum[1][a] += slope * c * II;
                for (int b = 0; b < m->nfield; b++)
                    J[a][b] += 0.5 * slope * c * (II * between (m, old, m->u[j], 2, b)
                                                  + III * between (m, old, m->u[j], 1, b));
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
/* The numbers of a vertex as one list, for sums of them. */
enum { NUMBERS = 22 };
static void list_of (const pg_tip_field *v, double *out)
{
    memcpy (out, v->J, sizeof v->J), memcpy (out + 4, v->J_near, sizeof v->J_near);
    memcpy (out + 8, v->K, sizeof v->K), memcpy (out + 14, v->K_wide, sizeof v->K_wide);
    memcpy (out + 20, v->T, sizeof v->T);
}

static void set_list (pg_tip_field *v, const double *list)
{
    memcpy (v->J, list, sizeof v->J), memcpy (v->J_near, list + 4, sizeof v->J_near);
    memcpy (v->K, list + 8, sizeof v->K), memcpy (v->K_wide, list + 14, sizeof v->K_wide);
    memcpy (v->T, list + 20, sizeof v->T);
}

/* 1/4, 1/2, 1/4; beyond an end, or a vertex that is not known, there is the vertex itself. */
static pg_status smooth (const pg_front *f, pg_tip_field *v)
{
    pg_status status = PG_OK;
    double *list = NULL;
    PG_ALLOC (list, NUMBERS * f->n);
    for (size_t i = 0; i < f->n; i++) list_of (&v[i], list + NUMBERS * i);
    for (size_t i = 0; i < f->n; i++) {
        size_t beside[2] = { i ? i - 1 : f->closed ? f->n - 1 : i, i + 1 < f->n ? i + 1 : f->closed ? 0 : i };
        double sum[NUMBERS];
        for (int k = 0; k < NUMBERS; k++) sum[k] = 0.5 * list[NUMBERS * i + (size_t) k];
        for (int side = 0; side < 2; side++) {
            size_t j = isnan (v[beside[side]].near) ? i : beside[side];
            for (int k = 0; k < NUMBERS; k++) sum[k] += 0.25 * list[NUMBERS * j + (size_t) k];
        }
        set_list (&v[i], sum);
    }
done:
    pg_free (list);
    return status;
}

/* Ends on the surface of the body: on the line through the second and third vertex from there, for the
 * surface has a singularity of its own (Bazant and Estenssoro 1979), and half of the hat is missing. */
static void extrapolate (const pg_front *f, pg_tip_field *v)
{
    if (f->closed || f->n < 5) return;
    for (int end = 0; end < 2; end++) {
        size_t i = end ? f->n - 1 : 0, j = end ? i - 2 : 2, k = end ? i - 3 : 3;
        double a[NUMBERS], b[NUMBERS];
        if (f->meets[i] == PG_MEETS_NOTHING || isnan (v[j].near) || isnan (v[k].near)) continue;
        list_of (&v[j], a), list_of (&v[k], b);
        for (int q = 0; q < NUMBERS; q++) b[q] = a[q] + 2 * (a[q] - b[q]);
        if (isnan (v[i].near)) v[i].near = v[j].near, v[i].wide = v[j].wide;
        set_list (&v[i], b);
        v[i].extrapolated = 1;
    }
}

/* ---- all of it ----------------------------------------------------------------------------------------- */
static pg_status prepare (measuring *m)
{
    pg_status status = PG_OK;
    const pg_front *f = m->front;
    m->n = FRONT_SECTIONS * (f->closed ? f->n : f->n - 1);
    for (size_t i = 0; i < f->n; i++) m->h = fmax (m->h, pg_problem_spacing_at (m->p, f->x + 3*i));
    if (m->p->nmaterial > 1 || any_body_force (m->p))
        PG_TRY (pg_nearest_create (&m->near, 3, m->p->cloud.n, m->p->cloud.x));
    PG_ALLOC (m->u, m->n);
    PG_ALLOC (m->room, m->n);
    PG_ALLOC (m->radii, m->n);
    PG_ALLOC (m->load, m->n);
    PG_ALLOC (m->width, f->n);
    PG_ALLOC (m->place, m->n);
    PG_ALLOC (m->sums, m->n);
    for (int a = 0; a < m->nfield; a++)
        PG_TRY (mean_motion_take (&m->field[a], m->p, m->state, m->d[a], f->n, f->x,
                                  front_radius[FRONT_RADII - 1] * m->h));
    place_sections (m);
    for (size_t i = 0; i < f->n; i++) m->width[i] = hat_width (m, i);
done:
    return status;
}

pg_status pg_front_measure (pg_tip_field *out, const pg_problem *p, const pg_force_type *force, void *self,
                            const pg_state *state, size_t front, int nfield, const double *const *d,
                            const double *t)
{
    return pg_front_measure_faces (out, p, force, self, state, front, nfield, d, t, NULL);
}

pg_status pg_front_measure_faces (pg_tip_field *out, const pg_problem *p, const pg_force_type *force,
                                  void *self, const pg_state *state, size_t front, int nfield,
                                  const double *const *d, const double *t, const pg_front_faces *faces)
{
    pg_status status = PG_OK;
    size_t nfront;
    const pg_front *fronts = pg_fronts_of_state (p, state, &nfront);
    const char *refused = pg_tip_refuses (p, force);
    measuring m = { .p = p, .force = force, .self = self, .state = state, .nfield = nfield, .d = d, .t = t,
                    .faces = faces };
    chunk c = { 0 };
    front_section section;
    if (refused) PG_FAIL (PG_E_USAGE, "no stress intensity factors: %s", refused);
    if (nfield < 1 || nfield > TIP_FIELDS)
        PG_FAIL (PG_E_USAGE, "%d displacement fields at a front: 1 or 2 can be measured", nfield);
    if (front >= nfront) PG_FAIL (PG_E_USAGE, "front %zu of %zu is asked for", front, nfront);
    m.front = &fronts[front];
    if (m.front->n < 2) PG_FAIL (PG_E_USAGE, "a front of %zu vertices is asked for", m.front->n);
    PG_TRY (prepare (&m));
    int moving = moves (&m);
    PG_TRY (chunk_create (&c, &m, moving));
    front_section_make (&section, m.h);
    for (size_t j = 0; j < m.n; j += CHUNK)
        PG_TRY (measure_sections (&m, &section, j, j + CHUNK < m.n ? j + CHUNK : m.n, &c, moving));
    PG_TRY (add_springs (&m));
    for (size_t i = 0; i < m.front->n; i++) {
        int radii = begin_vertex (&m, i, &out[i]);
        if (radii) fill_vertex (&m, i, radii, &out[i]);
    }
    for (size_t i = 0; i < m.front->n; i++)
        out[i].interface = isnan (out[i].near) && front_at_interface (p, out[i].x, front_radius[0] * m.h);
    PG_TRY (add_core (&m, out));
    PG_TRY (smooth (m.front, out));
    extrapolate (m.front, out);
    if (faces) front_faces_close (m.front, faces, nfield, out);
done:
    chunk_clear (&c);
    for (int a = 0; a < TIP_FIELDS; a++) mean_motion_clear (&m.field[a]);
    pg_nearest_free (&m.near);
    pg_free (m.u), pg_free (m.room), pg_free (m.radii), pg_free (m.load);
    pg_free (m.width);
    pg_free (m.place), pg_free (m.sums);
    return status;
}

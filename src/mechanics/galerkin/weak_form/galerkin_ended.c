/* SPDX-License-Identifier: GPL-3.0-or-later
 * Consistent integration in cells that end at cracks (2D). A crack that runs through a cell divides it into
 * parts P, whose evaluation points g share the volume of P,
 *
 *     sum_g w_g = V (P),    dN_I,k (g) += (oint_dP N_I n_k dS - sum_g w_g dN_I,k (g)) / V (P),
 *
 * where N_I on the border are values of bonds that no crack cuts: on the faces of the crack those of its
 * side (with a linear basis and the support radius that contact uses, among the nodes of the cell), on sides
 * of cells those common to the part beyond. A linear displacement on each side of a crack under uniform
 * pressure is then in equilibrium, as it is without the crack. Parts without evaluation points are added to
 * the part beyond their longest side, in equal shares where several sides are equally long. Chen, Hillman
 * and Rueter 2013, doi 10.1002/nme.4512 (identity); doc/method.md, Cells that end at cracks. */
#include "galerkin_ended.h"
#include <math.h>
#include <string.h>

pg_status galerkin_ended_create (galerkin *g)
{
    pg_status status = PG_OK;
    const pg_consistency *c = g->problem->form.consistency;
    if (!c || g->dim != 2) return PG_OK;
    PG_ALLOC (g->ended, 1);
    PG_ALLOC (g->ended->at, c->cells->n);
done:
    return status;
}

void galerkin_ended_free (galerkin *g)
{
    struct galerkin_ended *e = g->ended;
    if (!e) return;
    pg_free (e->near), pg_free (e->at), pg_free (e->seen), pg_free (e->alive), pg_free (e->weak);
    pg_free (e->face.N), pg_free (e->face.grade);
    pg_free (e->extra.x), pg_free (e->extra.family.start), pg_free (e->extra.family.node),
        pg_free (e->extra.N);
    pg_free (e->extra.grade), pg_free (e->extra.own), pg_free (e->extra.wide);
    pg_free (e->eye), pg_free (e->flux), pg_free (e->part), pg_free (e->crack), pg_free (e->sight);
    pg_free (e->side), pg_free (e->first), pg_free (e->next_point), pg_free (e->next_side);
    pg_free (e);
    g->ended = NULL;
}

/* ---- values on borders --------------------------------------------------------------------------------- */
/* Arguments shared by threads that find the intact bonds of points, seen from their eyes. */
typedef struct { const galerkin *g; const pg_cracks *cracks; const pg_rows *rows; const double *eye;
                 const size_t *list; unsigned char *alive; } looking;

static void look (void *context, size_t first, size_t last, int thread)
{
    const looking *l = context;
    const pg_cloud *cloud = &l->g->problem->cloud;
    (void) thread;
    for (size_t i = first; i < last; i++) {
        size_t q = l->list ? l->list[i] : i;
        for (size_t b = l->rows->family.start[q]; b < l->rows->family.start[q + 1]; b++)
            l->alive[b] = !pg_cracks_cut (l->cracks, l->eye + 2 * q,
                                          cloud->x + 2 * (size_t)l->rows->family.node[b],
                                          pg_cloud_same (cloud));
    }
}

/* Lists all points on faces of the cells near cracks, each once. */
static pg_status list_faces (const galerkin *g, size_t **list, size_t *n)
{
    pg_status status = PG_OK;
    const struct galerkin_ended *e = g->ended;
    const pg_faces *f = &g->problem->form.consistency->faces;
    unsigned char *taken = NULL;
    size_t *out = NULL;
    PG_ALLOC (taken, f->n);
    PG_ALLOC (out, f->npoint);
    *n = 0;
    for (size_t k = 0; k < e->n; k++)
        for (size_t i = f->of[e->near[k].cell]; i < f->of[e->near[k].cell + 1]; i++) taken[f->face[i]] = 1;
    for (size_t i = 0; i < f->n; i++)
        for (size_t q = f->start[i]; taken[i] && q < f->start[i + 1]; q++) out[(*n)++] = q;
    *list = out, out = NULL;
done:
    pg_free (taken), pg_free (out);
    return status;
}

/* Evaluates the values at the faces of all cells: those of intact bonds near cracks, else those of the intact
 * body. */
static pg_status evaluate_faces (galerkin *g, const pg_cracks *cracks)
{
    pg_status status = PG_OK;
    struct galerkin_ended *e = g->ended;
    const pg_rows *r = &g->problem->form.consistency->face;
    size_t *list = NULL, n = 0, bonds = r->family.start[r->n];
    if (!e->face.N) {
        PG_ALLOC (e->alive, bonds);
        PG_ALLOC (e->face.grade, r->n);
        double *N = NULL;
        unsigned char *grade = e->face.grade;
        PG_ALLOC (N, bonds);
        e->face = *r;
        e->face.N = N, e->face.grade = grade, e->face.dN = e->face.w = NULL, e->face.at = NULL;
    }
    memcpy (e->face.N, r->N, bonds * sizeof *r->N);
    memcpy (e->face.grade, r->grade, r->n);
    memset (e->alive, 1, bonds);
    PG_TRY (list_faces (g, &list, &n));
    looking l = { g, cracks, &e->face, e->face.x, list, e->alive };
    pg_parallel (g->threads, n, look, &l);
    PG_TRY (g->problem->form.approx.type->evaluate (&g->problem->form.approx, &g->problem->cloud, &e->face,
                                                    e->alive, n, list, g->threads));
done:
    pg_free (list);
    return status;
}

/* Points without a full linear basis get the narrowest wider support that gives one, over the same nodes. */
static pg_status widen_extra (galerkin *g, const pg_approx *a)
{
    static const double wider[] = { 1.15, 1.3, 1.6, 2, PG_WIDEST_SUPPORT };
    pg_status status = PG_OK;
    struct galerkin_ended *e = g->ended;
    size_t *list = NULL;
    PG_ALLOC (list, e->nextra);
    for (size_t k = 0; k < sizeof wider / sizeof *wider; k++) {
        size_t n = 0;
        for (size_t q = 0; q < e->nextra; q++)
            if (e->extra.grade[q] > PG_GRADE_FULL) e->extra.wide[q] = wider[k], list[n++] = q;
        if (n == 0) break;
        PG_TRY (a->type->evaluate (a, &g->problem->cloud, &e->extra, e->sight, n, list, g->threads));
    }
done:
    pg_free (list);
    return status;
}

/* Evaluates the values at points on cracks and pieces of sides. */
static pg_status evaluate_extra (galerkin *g, const pg_cracks *cracks)
{
    pg_status status = PG_OK;
    struct galerkin_ended *e = g->ended;
    const pg_problem *p = g->problem;
    pg_approx a = p->form.approx;
    size_t bonds = e->nextra ? e->extra.family.start[e->nextra] : 0;
    a.horizon = fmax (a.horizon, ENDED_RADIUS * p->cloud.h);
    a.order = 1, a.congruent = a.extrapolates = a.projected = 0;
    e->extra.dim = 2, e->extra.n = e->extra.family.n = e->nextra;
    if (e->nextra == 0) return PG_OK;
    PG_GROW (e->extra.N, e->cap.N, bonds);
    PG_GROW (e->extra.grade, e->cap.grade, e->nextra);
    PG_GROW (e->extra.own, e->cap.own, e->nextra);
    PG_GROW (e->sight, e->cap.sight, bonds);
    PG_GROW (e->extra.wide, e->cap.wide, e->nextra);
    for (size_t q = 0; q < e->nextra; q++) e->extra.own[q] = -1, e->extra.wide[q] = 1;
    looking l = { g, cracks, &e->extra, e->eye, NULL, e->sight };
    pg_parallel (g->threads, e->nextra, look, &l);
    PG_TRY (a.type->evaluate (&a, &p->cloud, &e->extra, e->sight, e->nextra, NULL, g->threads));
    PG_TRY (widen_extra (g, &a));
done:
    return status;
}

/* Marks a face as weak if a point on it has too poor a basis; returns 1 if it was not marked before. */
static int weaken (struct galerkin_ended *e, const pg_faces *f, size_t face)
{
    int weak = 0;
    for (size_t q = f->start[face]; q < f->start[face + 1]; q++) weak |= e->face.grade[q] > PG_GRADE_LOWERED;
    if (!weak || e->weak[face]) return 0;
    return e->weak[face] = 1;
}

/* Weak faces are to be replaced by pieces of their own points; cells whose points on pieces still have too
 * poor a basis fail. Returns 1 if anything changed. */
static int fail_poor (galerkin *g)
{
    struct galerkin_ended *e = g->ended;
    const pg_faces *f = &g->problem->form.consistency->faces;
    int failed = 0;
    for (size_t q = 0; q < e->nextra; q++) {
        ended_cell *c = &e->near[e->part[q][0]];
        if (e->extra.grade[q] > PG_GRADE_FULL) c->failed = c->blocked = failed = 1;
    }
    for (size_t k = 0; k < e->nside; k++) failed |= weaken (e, f, e->side[k].face);
    for (size_t k = 0; k < e->n; k++)
        for (size_t i = f->of[e->near[k].cell];
             i < f->of[e->near[k].cell + 1] && e->near[k].kind == ENDED_PLAIN; i++)
            failed |= weaken (e, f, (size_t) f->face[i]);
    return failed;
}

pg_status ended_values (galerkin *g, const pg_cracks *cracks, int *again)
{
    pg_status status = PG_OK;
    PG_TRY (evaluate_faces (g, cracks));
    PG_TRY (evaluate_extra (g, cracks));
    *again = fail_poor (g);
done:
    return status;
}

/* ---- derivatives --------------------------------------------------------------------------------------- */
/* sum (m x 2) += sign flux N at point q of the border, for those of its nodes that are among the m of the
 * cell. */
static void add_values (const pg_rows *rows, size_t q, const double *flux, double sign, size_t m,
                        const int *node, double *sum)
{
    size_t at = 0;
    for (size_t b = rows->family.start[q]; b < rows->family.start[q + 1]; b++) {
        while (at < m && node[at] < rows->family.node[b]) at++;
        if (at == m) return;
        if (node[at] != rows->family.node[b]) continue;
        for (size_t k = 0; k < 2; k++) sum[2*at + k] += sign * flux[k] * rows->N[b];
    }
}

/* sum (m x 2) += oint N n dS over the border of part p of cell k of `near`, m^2. */
static void integrate (const galerkin *g, size_t k, int p, size_t m, const int *node, double *sum)
{
    const struct galerkin_ended *e = g->ended;
    const pg_faces *f = &g->problem->form.consistency->faces;
    for (long at = e->first[PG_PARTS * k + (size_t) p]; at;) {
        size_t i = (size_t) (at > 0 ? at : -at) - 1;
        if (at > 0) {
            add_values (&e->extra, i, e->flux + 2*i, 1, m, node, sum);
            at = e->next_point[i];
            continue;
        }
        size_t face = e->side[i].face;
        double sign = f->cell[2*face] == (int) e->near[k].cell ? 1 : -1;
        for (size_t q = f->start[face]; q < f->start[face + 1]; q++)
            add_values (&e->face, q, f->flux + 2*q, sign, m, node, sum);
        at = e->next_side[i];
    }
}

/* Volume of part p of cell k of `near` and of its shares in parts without points, m^3. */
static double volume_of (const galerkin *g, size_t k, int p)
{
    const struct galerkin_ended *e = g->ended;
    const pg_faces *f = &g->problem->form.consistency->faces;
    size_t cell = e->near[k].cell;
    double sum = pg_cell_part_area (&e->near[k].parts.part[p]);
    for (size_t i = f->of[cell]; i < f->of[cell + 1]; i++)
        for (int side = 0; side < 2; side++) {
            int other = f->cell[2 * f->face[i] + side];
            if (other < 0 || (size_t) other == cell || !e->at[other]) continue;
            const ended_cell *c = &e->near[e->at[other] - 1];
            for (int q = 0; q < c->parts.n && !c->failed; q++)
                sum += ended_share (&c->host[q], k, p) * pg_cell_part_area (&c->parts.part[q]);
        }
    return sum * g->problem->cells.thickness;
}

/* Corrects part p of cell k of `near`: weights, then derivatives. Points without a gradient of their own get
 * the mean one. sum: scratch, 4 numbers a node. */
static void treat (galerkin *g, size_t k, int p, double *sum)
{
    const pg_consistency *c = g->problem->form.consistency;
    const ended_cell *e = &g->ended->near[k];
    size_t from = c->cell_family.start[e->cell], m = c->cell_family.start[e->cell + 1] - from;
    double volume = volume_of (g, k, p), weight = 0, good = 0, *mean = sum + 2*m;
    const pg_rows *r = &g->rows[g->bulk];
    memset (sum, 0, 4 * m * sizeof *sum);
    for (size_t q = c->first[e->cell]; q < c->first[e->cell + 1]; q++)
        if (pg_cell_part_holds (&e->parts.part[p], r->x + 2*q)) weight += r->weight[q];
    integrate (g, k, p, m, c->cell_family.node + from, sum);
    for (size_t i = 0; i < 2*m; i++) sum[i] /= volume;
    for (size_t q = c->first[e->cell]; q < c->first[e->cell + 1]; q++) {
        if (!pg_cell_part_holds (&e->parts.part[p], r->x + 2*q)) continue;
        double w = g->sums.weight[q] = r->weight[q] * (volume / weight),
               *dN = g->sums.dN + 2 * c->family.start[q];
        if (r->grade[q] > PG_GRADE_LOWERED) memcpy (dN, sum, 2 * m * sizeof *dN);
        else {
            good += w;
            for (size_t i = 0; i < 2*m; i++) mean[i] += w * dN[i];
        }
    }
    for (size_t q = c->first[e->cell]; q < c->first[e->cell + 1]; q++) {
        double *dN = g->sums.dN + 2 * c->family.start[q];
        if (r->grade[q] > PG_GRADE_LOWERED || !pg_cell_part_holds (&e->parts.part[p], r->x + 2*q)) continue;
        for (size_t i = 0; i < 2*m; i++) dN[i] += sum[i] - mean[i] / good;
    }
}

/* Values and grades at the faces of all cells: those of the intact body until others have been evaluated. */
const pg_rows *galerkin_ended_faces (const galerkin *g)
{
    return g->ended && g->ended->face.N ? &g->ended->face : &g->problem->form.consistency->face;
}

pg_status galerkin_ended_plan (galerkin *g, const pg_state *state, int *moved)
{
    pg_status status = PG_OK;
    struct galerkin_ended *e = g->ended;
    *moved = e && ended_moved (g, state);
    if (!e || (!*moved && e->n == 0)) return PG_OK;
    PG_TRY (ended_plan (g, state));
done:
    return status;
}

void galerkin_ended_mark (galerkin *g)
{
    const struct galerkin_ended *e = g->ended;
    for (size_t k = 0; e && k < e->n; k++)
        if (!e->near[k].failed) g->whole[e->near[k].cell] = e->near[k].kind == ENDED_PLAIN;
}

size_t galerkin_unended (const galerkin *g)
{
    return g->ended ? g->ended->blocked : 0;
}

size_t galerkin_ended_near (const galerkin *g, size_t *cell)
{
    size_t n = g->ended ? g->ended->n : 0;
    for (size_t k = 0; cell && k < n; k++) cell[k] = g->ended->near[k].cell;
    return n;
}

pg_status galerkin_ended_apply (galerkin *g, size_t count, const size_t *list)
{
    pg_status status = PG_OK;
    const struct galerkin_ended *e = g->ended;
    const pg_consistency *c = g->problem->form.consistency;
    double *sum = NULL;
    size_t most = 0;
    for (size_t k = 0; k < count; k++) {
        size_t cell = list[k];
        for (size_t q = c->first[cell]; q < c->first[cell + 1]; q++)
            g->sums.weight[q] = g->rows[g->bulk].weight[q];
        if (c->cell_family.start[cell + 1] - c->cell_family.start[cell] > most)
            most = c->cell_family.start[cell + 1] - c->cell_family.start[cell];
    }
    if (!e) return PG_OK;
    PG_ALLOC (sum, 4 * most);
    for (size_t k = 0; k < count; k++) {
        if (!e->at[list[k]]) continue;
        size_t at = (size_t) e->at[list[k]] - 1;
        const ended_cell *cell = &e->near[at];
        for (int p = 0; p < cell->parts.n && cell->kind == ENDED_PARTS; p++)
            if (ended_stands (e, at, p)) treat (g, at, p, sum);
    }
done:
    pg_free (sum);
    return status;
}

/* ---- jumps --------------------------------------------------------------------------------------------- */
/* The point on a crack at position x whose part lies on the side that the normal points to (sign 1) or on the
 * other side (-1); SIZE_MAX: there is none. */
static size_t point_at (const galerkin *g, const double *x, const double *normal, double sign)
{
    const struct galerkin_ended *e = g->ended;
    double near = 1e-6 * g->problem->cloud.h;
    for (size_t q = 0; q < e->nextra; q++) {
        const double *y = e->extra.x + 2*q, *n = e->flux + 2*q;
        if (!e->crack[q] || fabs (x[0] - y[0]) > near || fabs (x[1] - y[1]) > near) continue;
        double out = n[0] * normal[0] + n[1] * normal[1];
        if (fabs (out) > 0.5 * hypot (n[0], n[1]) && out * sign < 0) return q;
    }
    return SIZE_MAX;
}

pg_status galerkin_ended_jump (const galerkin *g, size_t n, const double *x, const double *normal,
                               pg_jump_rows *rows)
{
    pg_status status = PG_OK;
    const struct galerkin_ended *e = g->ended;
    pg_jump_rows out = { .n = n, .poor = rows->poor };
    size_t cap_node = 0, cap_value = 0, total = 0;
    if (!e || e->nextra == 0) return PG_OK;
    PG_ALLOC (out.start, n + 1);
    for (size_t i = 0; i < n; i++, out.start[i] = total) {
        int any = 0;
        size_t q[2] = { point_at (g, x + 2*i, normal + 2*i, 1), point_at (g, x + 2*i, normal + 2*i, -1) };
        if (q[0] == SIZE_MAX || q[1] == SIZE_MAX) {
            size_t from = rows->start[i], m = rows->start[i + 1] - from;
            PG_GROW (out.node, cap_node, total + m);
            PG_GROW (out.value, cap_value, total + m);
            memcpy (out.node + total, rows->node + from, m * sizeof *out.node);
            memcpy (out.value + total, rows->value + from, m * sizeof *out.value);
            total += m;
            continue;
        }
        for (size_t b = rows->start[i]; b < rows->start[i + 1]; b++) any |= rows->value[b] != 0;
        out.poor -= !any;
        for (int side = 0; side < 2; side++)
            for (size_t b = e->extra.family.start[q[side]]; b < e->extra.family.start[q[side] + 1]; b++) {
                PG_GROW (out.node, cap_node, total + 1);
                PG_GROW (out.value, cap_value, total + 1);
                out.node[total] = e->extra.family.node[b];
                out.value[total++] = side ? -e->extra.N[b] : e->extra.N[b];
            }
    }
    pg_jump_rows_clear (rows);
    *rows = out;
    memset (&out, 0, sizeof out);
done:
    pg_jump_rows_clear (&out);
    return status;
}

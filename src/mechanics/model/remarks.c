/* SPDX-License-Identifier: GPL-3.0-or-later
 * Remarks on probably unintended input: a spacing larger than the body, unresolved walls and shapes, alpha
 * shapes that omit points, cracks that cut the body into parts, too large contrast of materials. */
#include "model.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Bounding box, m: with a lattice that of the body, whose surface lies beyond the outermost points; else that
 * of the points. */
void pg_problem_box (const pg_problem *p, double *low, double *high)
{
    for (int k = 0; k < p->dim; k++)
        low[k] = p->lattice.dim ? p->body.low[k] : p->cloud.low[k],
        high[k] = p->lattice.dim ? p->body.high[k] : p->cloud.high[k];
}

/* Warns of a spacing larger than the body, which is often due to a wrong unit. */
void pg_remark_spacing (pg_problem *p, const pg_scene *scene)
{
    double asked, low[3], high[3];
    if (!p->lattice.dim || !pg_scene_given (scene, "spacing")) return;
    asked = pg_scene_number (scene, "spacing");
    pg_problem_box (p, low, high);
    for (int k = 0; k < p->dim; k++)
        if (asked > (high[k] - low[k]) * (1 + 1e-9)) {
            pg_problem_note (p,
                             PG_WARNING "the spacing, %.4g m, is larger than the body, which measures %.4g m "
                                        "along %c: one cell there",
                             asked, high[k] - low[k], "xyz"[k]);
            return;
        }
}

/* Returns 1: the text is a number without a unit. */
static int bare (const char *text)
{
    return text && *text && text[strspn (text, "+-.0123456789eE ")] == '\0';
}

/* Warns of a small Young's modulus without a unit beside lengths with units: it was perhaps meant in MPa or
 * GPa, but is read in Pa. */
void pg_remark_units (pg_problem *p, const pg_scene *scene)
{
    const char *name, *unit = pg_scene_text (scene, "mesh.unit"), *spacing = pg_scene_text (scene, "spacing");
    int lengths = (pg_scene_given (scene, "spacing") && !bare (spacing))
                  || (pg_scene_given (scene, "mesh.unit") && unit && strcmp (unit, "m") != 0);
    for (size_t m = 0; lengths && (name = pg_scene_name (scene, m, "materials")); m++) {
        if (!pg_scene_given (scene, "materials.%s.youngs_modulus", name)) continue;
        const char *E = pg_scene_text (scene, "materials.%s.youngs_modulus", name);
        double value = pg_scene_number (scene, "materials.%s.youngs_modulus", name);
        if (bare (E) && value > 0 && value < 1e7)
            pg_problem_note (p,
                             PG_WARNING "line %d: materials.%.32s.youngs_modulus = %.24s has no unit: it is "
                                        "read in Pa; MPa and GPa are written behind the number",
                             pg_scene_line (scene, "materials.%s.youngs_modulus", name), name, E);
    }
}

/* Least extent of a shape along its axes, m, and its middle (3, m); INFINITY: not known. */
static double least_extent (const pg_shape *s, int dim, double *middle)
{
    double least = 2 * s->radius;
    for (int k = 0; k < 3; k++) middle[k] = s->centre[k];
    if (s->kind == PG_CYLINDER) return fmin (least, s->length);
    if (s->kind == PG_DISK || s->kind == PG_SPHERE) return least;
    if (s->kind != PG_BOX && s->kind != PG_POLYGON && s->kind != PG_PRISM) return INFINITY;
    least = INFINITY;
    for (int k = 0; k < dim; k++) {
        double low = s->low[k], high = s->high[k];
        for (size_t v = 0; k < 2 && v < s->nvertex; v++) {
            double x = s->vertex[2 * v + (size_t) k];
            low = v ? fmin (low, x) : x, high = v ? fmax (high, x) : x;
        }
        least = fmin (least, high - low), middle[k] = 0.5 * (low + high);
    }
    return least;
}

/* ---- walls beside holes -------------------------------------------------------------------------------- */
/* Numbers of rays around a round hole, and of positions along its axis or along the sides of other holes. */
enum { RAYS = 96, PLACES = 5 };

typedef struct { const pg_problem *p; size_t hole; double least, spacing, at[3]; } thinnest;

/* Thickness of the body, m, from x on the surface of a hole in direction e, at most the local spacing *h; 0:
 * no body there. */
static double thickness (const pg_problem *p, const double *x, const double *e, double *h)
{
    const double inside = 1e-6;                        /* spacings */
    const pg_ground ground = pg_problem_ground (p);
    double start[3];
    *h = pg_problem_spacing_at (p, x);
    for (int k = 0; k < 3; k++) start[k] = x[k] + inside * *h * e[k];
    return pg_problem_has_body (p, start) ? pg_ground_way_out (&ground, start, e, *h) + inside * *h : 0;
}

static void take_thinnest (thinnest *t, double wall, double h, const double *x)
{
    if (!(wall > 0 && wall < h * (1 - 1e-9) && wall / h < t->least / t->spacing)) return;
    t->least = wall, t->spacing = h;
    memcpy (t->at, x, sizeof t->at);
}

/* Finds the thinnest wall around a circle in the plane of u and v. Edges where the hole opens into the
 * surface are excluded: a wall must be a local minimum. */
static void look_around (thinnest *t, const double *centre, double radius, const double *u, const double *v)
{
    double wall[RAYS], h[RAYS], x[3 * RAYS];
    for (int q = 0; q < RAYS; q++) {
        double angle = 2 * acos (-1) * q / RAYS, e[3];
        for (int k = 0; k < 3; k++) {
            e[k] = cos (angle) * u[k] + sin (angle) * v[k];
            x[3*q + k] = centre[k] + radius * e[k];
        }
        wall[q] = thickness (t->p, x + 3*q, e, &h[q]);
    }
    for (int q = 0; q < RAYS; q++) {
        double beside = fmin (wall[(q + 1) % RAYS], wall[(q + RAYS - 1) % RAYS]);
        if (beside >= wall[q] * (1 - 1e-9)) take_thinnest (t, wall[q], h[q], x + 3*q);
    }
}

/* Finds the thinnest wall along a straight side from a to b, in both normal directions (one of which is the
 * hole). */
static void look_beside (thinnest *t, const double *a, const double *b, const double *normal)
{
    for (int q = 0; q < PLACES; q++)
        for (int side = 0; side < 2; side++) {
            double x[3], e[3], h, share = (q + 0.5) / PLACES;
            for (int k = 0; k < 3; k++) {
                x[k] = a[k] + share * (b[k] - a[k]);
                e[k] = side ? -normal[k] : normal[k];
            }
            double wall = thickness (t->p, x, e, &h);
            take_thinnest (t, wall, h, x);
        }
}

static void look_at_round (thinnest *t, const pg_shape *s)
{
    static const double axes[3][3] = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };
    double centre[3], u[3], v[3], n[3] = { 0, 0, 1 };
    if (s->kind == PG_DISK) look_around (t, s->centre, s->radius, axes[0], axes[1]);
    for (int k = 0; k < 3 && s->kind == PG_SPHERE; k++)
        look_around (t, s->centre, s->radius, axes[k], axes[(k + 1) % 3]);
    if (s->kind != PG_CYLINDER) return;
    memcpy (n, s->axis, sizeof n);
    const double *other = axes[fabs (n[0]) < 0.6 ? 0 : 1];
    for (int k = 0; k < 3; k++)
        u[k] = n[(k + 1) % 3] * other[(k + 2) % 3] - n[(k + 2) % 3] * other[(k + 1) % 3];
    double size = sqrt (u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
    for (int k = 0; k < 3; k++) u[k] /= size;
    for (int k = 0; k < 3; k++) v[k] = n[(k + 1) % 3] * u[(k + 2) % 3] - n[(k + 2) % 3] * u[(k + 1) % 3];
    for (int q = 0; q < PLACES; q++) {
        for (int k = 0; k < 3; k++) centre[k] = s->centre[k] + (q + 0.5) / PLACES * s->length * n[k];
        look_around (t, centre, s->radius, u, v);
    }
}

/* Examines the sides of boxes, polygons and prisms in the xy plane, in 3D at several z. */
static void look_at_straight (thinnest *t, const pg_shape *s)
{
    const double *a = s->low, *c = s->high;
    double box[8] = { a[0], a[1], c[0], a[1], c[0], c[1], a[0], c[1] };
    const double *vertex = s->kind == PG_BOX ? box : s->vertex;
    size_t n = s->kind == PG_BOX ? 4 : s->nvertex;
    if (s->kind != PG_BOX && s->kind != PG_POLYGON && s->kind != PG_PRISM) return;
    for (size_t i = 0; i < n; i++)
        for (int q = 0; q < (t->p->dim == 3 ? PLACES : 1); q++) {
            double z = t->p->dim == 3 ? s->low[2] + (q + 0.5) / PLACES * (s->high[2] - s->low[2]) : 0;
            double from[3] = { vertex[2*i], vertex[2*i + 1], z },
                   to[3] = { vertex[2 * ((i + 1) % n)], vertex[2 * ((i + 1) % n) + 1], z };
            double dx = to[0] - from[0], dy = to[1] - from[1], size = hypot (dx, dy);
            if (size > 0) look_beside (t, from, to, (double[3]){ dy / size, -dx / size, 0 });
        }
}

/* Warns of walls beside holes that are thinner than the spacing (at most one layer of points): position of
 * the thinnest, number of other holes. */
void pg_remark_thin_walls (pg_problem *p)
{
    thinnest worst = { .least = INFINITY, .spacing = 1 };
    size_t holes = 0;
    char more[64] = "";
    for (size_t i = 0; p->lattice.dim && i < p->body.n; i++) {
        const pg_shape *s = &p->body.shape[i];
        thinnest t = { .p = p, .hole = i, .least = INFINITY, .spacing = 1 };
        if (s->add || s->slot) continue;
        look_at_round (&t, s);
        look_at_straight (&t, s);
        holes += isfinite (t.least);
        if (t.least / t.spacing < worst.least / worst.spacing) worst = t;
    }
    if (holes == 0) return;
    if (holes == 2) snprintf (more, sizeof more, " (one more hole has such a wall)");
    if (holes > 2) snprintf (more, sizeof more, " (%zu more holes have such walls)", holes - 1);
    pg_problem_note (p,
                     PG_WARNING "body[%zu]: the wall beside this hole at (%.6g, %.6g, %.6g) m is %.3g m "
                                "thick, %.2g of the spacing there%s: the points do not resolve it, and what "
                                "it bears may be off by half",
                     worst.hole, worst.at[0], worst.at[1], worst.at[2], worst.least,
                     worst.least / worst.spacing, more);
}

/* ---- small shapes -------------------------------------------------------------------------------------- */
/* Warns of shapes narrower than the spacing, which points do not resolve: a hole only cuts bonds, an added
 * part may contain no points. */
void pg_remark_small_shapes (pg_problem *p)
{
    if (!p->lattice.dim) return;
    for (size_t i = 0; i < p->body.n; i++) {
        const pg_shape *s = &p->body.shape[i];
        double middle[3] = { 0 }, least = least_extent (s, p->dim, middle), h;
        if (s->slot) continue;
        h = pg_problem_spacing_at (p, middle);
        if (least < h * (1 - 1e-9))
            pg_problem_note (p,
                             PG_WARNING "body[%zu]: %s of %.3g m is smaller than the spacing there, %.3g m: "
                                        "the points do not resolve it, %s",
                             i, s->add ? "a part" : "a hole", least, h,
                             s->add ? "and it may be without effect"
                                    : "though it parts the bonds that cross it: do not trust stresses "
                                      "beside it");
    }
}

/* ---- alpha shapes -------------------------------------------------------------------------------------- */
/* Ratio of the largest to the median radius of an automatic alpha shape from which on a warning is given. */
static const double uneven = 5;

/* Notes the properties of an alpha shape, and warns of points that it omits. */
static void remark_cloud (pg_problem *p, const pg_shape *s, size_t i)
{
    const pg_alpha_shape *a = pg_shape_alpha (s);
    static const char *const empty[2][2] = { { "hole", "holes" }, { "cavity", "cavities" } };
    pg_problem_note (p,
                     "body[%zu]: alpha shape of %zu points with spacing %.4g m, alpha %.4g m%s, rim %.4g m; "
                     "inside the rim %.6g m^%d, %zu part%s, %zu %s",
                     i, a->mesh.nnode, a->spacing, a->alpha, a->uneven > 0 ? " (automatic)" : "", a->rim,
                     a->volume, p->dim, a->parts, a->parts == 1 ? "" : "s", a->holes,
                     empty[p->dim == 3][a->holes != 1]);
    if (a->twins)
        pg_problem_note (p, "body[%zu]: %zu point%s of the cloud repeat%s another", i, a->twins,
                         a->twins == 1 ? "" : "s", a->twins == 1 ? "s" : "");
    if (a->loose)
        pg_problem_note (p,
                         PG_WARNING "body[%zu]: %zu of %zu points of the cloud are no part of its alpha "
                                    "shape, the first being number %ld; a larger alpha than %.4g m takes "
                                    "them in",
                         i, a->loose, a->mesh.nnode, a->first_loose + 1, a->alpha);
    if (a->uneven > uneven)
        pg_problem_note (p,
                         PG_WARNING "body[%zu]: the cloud is %.2g times as coarse at places as elsewhere, "
                                    "and the automatic alpha fills gaps below %.4g m; give alpha if there "
                                    "are any",
                         i, a->uneven, 2 * a->alpha);
}

void pg_remark_clouds (pg_problem *p)
{
    for (size_t i = 0; i < p->body.n; i++)
        if (pg_shape_alpha (&p->body.shape[i])) remark_cloud (p, &p->body.shape[i], i);
}

/* ---- parts --------------------------------------------------------------------------------------------- */
/* Returns 1: a pre-crack or slot cuts the bond between points i and j. */
static int is_cut (const pg_problem *p, size_t i, size_t j)
{
    size_t dim = (size_t) p->dim;
    return pg_bond_cut_first (p, p->cloud.x + i * dim, p->cloud.x + j * dim);
}

/* Returns 1: a pre-crack passes through point i. */
static int on_a_crack (const pg_problem *p, size_t i)
{
    return pg_cracks_touch (pg_state_cracks (p, NULL), p->cloud.x + i * (size_t) p->dim,
                            pg_cloud_same (&p->cloud)) != NULL;
}

/* Unites points connected by bonds that no crack cuts into disjoint sets (parent); on each rank by bonds of
 * its own points. */
static void join_points (const pg_problem *p, int *parent)
{
    const pg_family *f = &p->bonds.rows[PG_NODES].family;
    size_t n = p->cloud.n;
    pg_disjoint_start (parent, n);
    for (size_t i = 0; i < n; i++) {
        int root = (int) i;                            /* of point i; kept for speed */
        for (size_t e = f->start[i]; e < f->start[i + 1]; e++) {
            size_t j = (size_t) f->node[e];
            if (j >= i || parent[j] == root || pg_disjoint_root (parent, (int) j) == root) continue;
            if (!pg_cloud_owns (&p->cloud, i) && !pg_cloud_owns (&p->cloud, j)) continue;
            if (!is_cut (p, i, j)) root = pg_disjoint_join (parent, root, (int) j);
        }
    }
}

/* A connected part of the body: label, number of points, number and position (m) of its first point; on: 1:
 * that lies on a crack. */
typedef struct { double label, count, number, x[3]; int on; } part;

static int by_label (const void *a, const void *b)
{
    const part *x = a, *y = b;
    if (x->label != y->label) return x->label < y->label ? -1 : 1;
    return (x->number > y->number) - (x->number < y->number);
}

/* Lists the parts with points of this rank (out: n entries). */
static size_t list_parts (const pg_problem *p, int *parent, const double *label, part *out)
{
    size_t dim = (size_t) p->dim, n = 0;
    for (size_t i = 0; i < p->cloud.n; i++) {
        part *mine = &out[pg_disjoint_root (parent, (int) i)];
        if (!pg_cloud_owns (&p->cloud, i)) continue;
        if (mine->count++ > 0) continue;
        mine->label = label[i], mine->number = (double) pg_cloud_number (&p->cloud, i);
        memcpy (mine->x, p->cloud.x + i * dim, dim * sizeof *mine->x);
        mine->on = on_a_crack (p, i);
    }
    for (size_t i = 0; i < p->cloud.n; i++) if (out[i].count > 0) out[n++] = out[i];
    return n;
}

/* Merges entries of different ranks for the same part; returns the number of parts. */
static size_t merge_parts (part *all, size_t n)
{
    size_t last = 0;
    pg_sort (all, n, sizeof *all, by_label);
    for (size_t k = 1; k < n; k++)
        if (all[k].label == all[last].label) all[last].count += all[k].count;
        else all[++last] = all[k];
    return n ? last + 1 : 0;
}

/* Numbers of parts besides the largest, of their points, of points without bonds, of all points; an example
 * of each. */
typedef struct { size_t parts, beside, alone, points; const part *at, *lonely; } loose;

static loose find_loose (const part *all, size_t n)
{
    loose l = { 0 };
    size_t largest = 0;
    for (size_t k = 0; k < n; k++) {
        l.points += (size_t) all[k].count;
        if (all[k].count > all[largest].count) largest = k;
    }
    for (size_t k = 0; k < n; k++) {
        if (all[k].count < 2 && l.points > 1 && !all[k].on && !l.alone++) l.lonely = &all[k];
        if (k == largest || all[k].count < 2) continue;
        l.beside += (size_t) all[k].count;
        if (!l.parts++) l.at = &all[k];
    }
    return l;
}

/* "x, y, z" for messages. */
static void write_place (const pg_problem *p, const double *x, char *out, size_t size)
{
    for (size_t k = 0, used = 0; k < (size_t) p->dim; k++)
        used += (size_t) snprintf (out + used, size - used, "%s%.4g", k ? ", " : "", x[k]);
}

/* Makes the remarks on loose parts (in parallel runs on rank 0). */
static void remark_loose (pg_problem *p, const loose *l)
{
    char place[80];
    if (l->parts) {
        write_place (p, l->at->x, place, sizeof place);
        pg_problem_note (p,
                         PG_WARNING "the cracks cut the body into %zu parts: %zu of its %zu points hang on "
                                    "the largest part by no bond, such as that at (%s) m",
                         l->parts + 1, l->beside, l->points, place);
    }
    if (l->alone) {
        write_place (p, l->lonely->x, place, sizeof place);
        pg_problem_note (p, PG_WARNING "the cracks leave %zu point%s without a bond, such as that at (%s) m",
                         l->alone, l->alone == 1 ? "" : "s", place);
    }
}

/* Warns of parts of several points that pre-cracks separate from the rest, and of points without a bond
 * (points on a crack have their own remark). Point-to-point bonds are used for any force. */
pg_status pg_remark_parts (pg_problem *p)
{
    pg_status status = PG_OK;
    int *parent = NULL;
    double *label = NULL;
    part *mine = NULL;
    void *all = NULL;
    size_t bytes = 0;
    if (p->crack.given.n + p->crack.slots.n == 0) return PG_OK;
    PG_ALLOC (parent, p->cloud.n);
    PG_ALLOC (label, p->cloud.n);
    PG_ALLOC (mine, p->cloud.n);
    join_points (p, parent);
    PG_TRY (pg_subdomain_label (p->cloud.subdomain, p->cloud.n, 1, parent, label));
    PG_TRY (pg_ranks_collect (list_parts (p, parent, label, mine) * sizeof *mine, mine, &bytes, &all));
    loose l = find_loose (all, merge_parts (all, bytes / sizeof *mine));
    remark_loose (p, &l);
done:
    pg_free (parent), pg_free (label), pg_free (mine), pg_free (all);
    return status;
}

/* ---- contrast ------------------------------------------------------------------------------------------ */
/* Ratio of moduli from which evaluation points of the stiffer material make neighbouring points of the softer
 * one practically rigid. Below, the effect is less than that of one spacing more or less. */
static const double stark = 1e3;

pg_status pg_remark_contrast (pg_problem *p)
{
    pg_status status = PG_OK;
    unsigned char *seen = NULL;
    if (!p->method->shape_functions || p->nmaterial < 2) return PG_OK;
    int set = p->form.integration->at_nodes ? PG_NODES : PG_POINTS;
    const pg_rows *r = &p->bonds.rows[set];
    PG_ALLOC (seen, p->cloud.n);
    for (size_t soft = 0; soft < p->nmaterial; soft++) {
        double all = 0, held = 0, most = 0;
        size_t by = soft;
        memset (seen, 0, p->cloud.n);
        for (size_t q = 0; q < r->n; q++) {
            const pg_material *own = pg_problem_law (p, set, q);
            if (own->modulus < stark * p->material[soft].modulus) continue;
            for (size_t e = r->family.start[q]; e < r->family.start[q + 1]; e++)
                if (p->block[PG_NODES][r->family.node[e]] == (int) soft) {
                    seen[r->family.node[e]] = 1;
                    if (own->modulus > most) most = own->modulus, by = (size_t) p->block[set][q];
                }
        }
        for (size_t i = 0; i < p->cloud.n; i++) {
            if (p->block[PG_NODES][i] != (int) soft) continue;
            all += p->cloud.volume[i], held += seen[i] ? p->cloud.volume[i] : 0;
        }
        if (held > 0.05 * all)
            pg_problem_note (p,
                             PG_WARNING "material %.40s is %.2g times as stiff as %.40s, and sees %.2g %% of "
                                        "it within the horizon, which can hardly strain: "
                                        "too stiff by up to as much; use a smaller spacing",
                             p->material[by].name, most / p->material[soft].modulus, p->material[soft].name,
                             100 * held / all);
    }
done:
    pg_free (seen);
    return status;
}

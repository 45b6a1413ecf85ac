/* SPDX-License-Identifier: GPL-3.0-or-later
 * Stiffness and limits as expressions of position: every point of every bond set has the elastic law and the
 * criterion of its position. Points with equal values share one, so that two stiffnesses given by a condition
 * are equivalent to two blocks. Constants that follow from a horizon or a lattice are derived once, for the
 * mean over the nodes, and scaled to each position (pg_criterion_type.scale), as they are powers of the
 * ratios at constant Poisson's ratio. */
#include "model.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = PG_OF_COUNT };

static const struct {
    const char *key, *unit;
} what[MOST] = {
    [PG_OF_STIFFNESS] = { "youngs_modulus", "Pa" },
    [PG_OF_ENERGY] = { "fracture_energy", "J/m2" },
    [PG_OF_STRETCH] = { "critical_stretch", "1" },
    [PG_OF_TENSION] = { "tensile_strength", "Pa" },
    [PG_OF_COHESION] = { "cohesion", "Pa" },
};

const char *pg_variation_name (int of, const char **unit)
{
    if (unit) *unit = what[of].unit;
    return what[of].key;
}

int pg_problem_graded (const pg_problem *p)
{
    int graded = 0;
    for (size_t m = 0; p->at.vary && m < p->nmaterial; m++)
        graded |= p->at.vary[m].of[PG_OF_STIFFNESS] != NULL;
    return graded;
}

/* ---- expressions --------------------------------------------------------------------------------------- */
/* Finds the key of limit k of a material: its own, else that of `failure`; returns 0: neither is given. */
static int key_of (char path[128], const pg_scene *scene, const char *material, int k)
{
    const char *key = what[k].key;
    snprintf (path, 128, k == PG_OF_STIFFNESS ? "materials.%.63s.%s" : "materials.%.63s.failure.%s", material,
              key);
    if (pg_scene_given (scene, "%s", path) || k == PG_OF_STIFFNESS)
        return pg_scene_given (scene, "%s", path);
    snprintf (path, 128, "failure.%s", key);
    return pg_scene_given (scene, "%s", path);
}

typedef struct { const pg_problem *p; int set; const pg_expression *e; double *value; } evaluation;

/* Evaluates an expression at points first .. last - 1 of a set (random fields are expensive: done in
 * parallel). */
static void evaluate (void *context, size_t first, size_t last, int thread)
{
    const evaluation *v = context;
    double x[3];
    (void) thread;
    for (size_t q = first; q < last; q++) {
        if (v->set < 0) memcpy (x, v->p->cloud.x + q * (size_t) v->p->dim, (size_t) v->p->dim * sizeof *x);
        else pg_blocks_place (v->p, v->set, q, x);
        pg_place at = pg_place_of (v->p->dim, x, 0);
        v->value[q] = pg_expression_value (v->e, &at);
    }
}

/* Computes the reference value: the mean of positive values over all nodes, as it is not yet known which
 * nodes are of this material, and the expression need not be positive elsewhere. */
static pg_status find_reference (const pg_problem *p, pg_variation *v, int k)
{
    pg_status status = PG_OK;
    double *value = NULL, sum[2] = { 0, 0 };
    PG_ALLOC (value, p->cloud.n);
    evaluation all = { p, -1, v->of[k], value };
    pg_parallel (p->threads, p->cloud.n, evaluate, &all);
    for (size_t i = 0; i < p->cloud.n; i++)
        if (value[i] > 0 && isfinite (value[i]) && pg_cloud_owns (&p->cloud, i))
            sum[0] += value[i], sum[1]++;
    PG_TRY (pg_cloud_sum (&p->cloud, 2, sum));
    v->reference[k] = sum[1] > 0 ? sum[0] / sum[1] : 1;
done:
    pg_free (value);
    return status;
}

/* Compiles one limit of one material, if it is an expression, and finds its reference. Criteria of tips read
 * their own limits. */
static pg_status read_one (const pg_problem *p, const pg_scene *scene, size_t m, const char *material, int k)
{
    pg_status status = PG_OK;
    char path[128];
    pg_variation *v = &p->at.vary[m];
    if (!key_of (path, scene, material, k) || !isnan (pg_scene_number (scene, "%s", path))) return PG_OK;
    PG_TRY (pg_expression_compile (&v->of[k], pg_scene_text (scene, "%s", path), what[k].unit));
    if (pg_expression_uses (v->of[k], 't')) pg_scene_fault (scene, path, "may depend on place, not on t");
    PG_TRY (find_reference (p, v, k));
done:
    return status;
}

/* Reads all expressions, before materials and criteria, whose constants derive from the references. */
pg_status pg_laws_read (pg_problem *p, const pg_scene *scene)
{
    pg_status status = PG_OK;
    const char *name;
    PG_ALLOC (p->at.vary, p->nmaterial);
    for (size_t m = 0; (name = pg_scene_name (scene, m, "materials")); m++)
        for (int k = 0; k < MOST; k++) {
            p->at.vary[m].reference[k] = NAN;
            PG_TRY (read_one (p, scene, m, name, k));
        }
done:
    return status;
}

/* Checks that varying quantities are supported: laws can be scaled only if they are linear. Warns that
 * integrals around tips lack the term of the stiffness gradient. */
void pg_laws_check (pg_problem *p, const pg_scene *scene)
{
    char path[128];
    const pg_criterion *c = p->criterion;
    if (pg_problem_graded (p) && pg_criterion_of_tips (c))
        pg_problem_note (p, PG_WARNING "J and K of crack tips are those of a body that is uniform about the "
                         "tip: Young's modulus is an expression of place, and they are off by about its "
                         "relative change over 8 spacings");
    for (size_t m = 0; m < p->nmaterial; m++)
        for (int k = 0; k < MOST; k++) {
            if (!p->at.vary[m].of[k]) continue;
            key_of (path, scene, p->material[m].name, k);
            if (k == PG_OF_STIFFNESS && p->material[m].type->stress != pg_tangent_stress)
                pg_scene_fault (scene, path, "must be one number with model: %s",
                                p->material[m].type->name);
            if (k == PG_OF_STIFFNESS || !pg_criterion_of_bonds (c)) continue;
            if (!c->type->scale) pg_scene_fault (scene, path, "must be one number with criterion: %s",
                                                 c->type->name);
            if (k == PG_OF_ENERGY && pg_expression_uses (p->at.vary[m].of[k], 'a'))
                pg_scene_fault (scene, path, "may depend on place; angle, the direction of growth, goes with "
                                             "criterion: %s", pg_criterion_by_need (PG_NEEDS_FACETS));
        }
}

/* Returns 1: limit k of material m is an expression of position in use (not of the direction of growth, which
 * criteria of tips evaluate themselves). */
static int counts (const pg_problem *p, size_t m, int k)
{
    const pg_expression *e = p->at.vary[m].of[k];
    return e && (k == PG_OF_STIFFNESS || pg_criterion_of_bonds (p->criterion)
                 || (pg_criterion_of_tips (p->criterion) && !pg_expression_uses (e, 'a')));
}

/* ---- values -------------------------------------------------------------------------------------------- */
/* A point: the values of varying quantities, its block, its index over all sets. */
typedef struct { double value[MOST]; int block; size_t at; } entry;

static int by_value (const void *a, const void *b)
{
    const entry *x = a, *y = b;
    if (x->block != y->block) return x->block < y->block ? -1 : 1;
    for (int k = 0; k < MOST; k++) if (x->value[k] != y->value[k]) return x->value[k] < y->value[k] ? -1 : 1;
    return x->at < y->at ? -1 : x->at > y->at;
}

/* Order by point index: laws are numbered by the first point of each group, so that neighbours are near in
 * memory. */
static int by_point (const void *a, const void *b)
{
    const entry *x = a, *y = b;
    return x->at < y->at ? -1 : x->at > y->at;
}

/* Evaluates varying quantities at all points of all sets. */
static pg_status find_values (const pg_problem *p, const pg_scene *scene, entry *out)
{
    pg_status status = PG_OK;
    double *value = NULL;
    size_t most = 0, at = 0;
    for (int s = 0; s < PG_BOND_SETS; s++) most = p->bonds.rows[s].n > most ? p->bonds.rows[s].n : most;
    PG_ALLOC (value, most + 1);
    for (int s = 0; s < PG_BOND_SETS; at += p->bonds.rows[s].n, s++) {
        for (size_t q = 0; q < p->bonds.rows[s].n; q++)
            out[at + q] = (entry){ { 0 }, p->block[s][q], at + q };
        for (size_t m = 0; m < p->nmaterial; m++)
            for (int k = 0; k < MOST; k++) {
                evaluation all = { p, s, p->at.vary[m].of[k], value };
                char path[128];
                if (!counts (p, m, k)) continue;
                pg_parallel (p->threads, p->bonds.rows[s].n, evaluate, &all);
                for (size_t q = 0; q < p->bonds.rows[s].n; q++) {
                    if (p->block[s][q] != (int) m) continue;
                    out[at + q].value[k] = value[q];
                    if (value[q] > 0 && isfinite (value[q])) continue;
                    const double *x = p->bonds.rows[s].x + q * (size_t) p->dim;
                    key_of (path, scene, p->material[m].name, k);
                    pg_scene_fault (scene, path,
                                    "is %.6g %s at x %.6g m, y %.6g m, z %.6g m: it must be positive all "
                                    "over its material, such as by exp (...) or max (...)",
                                    value[q], what[k].unit, x[0], p->dim > 1 ? x[1] : 0,
                                    p->dim > 2 ? x[2] : 0);
                    goto done;
                }
            }
    }
done:
    pg_free (value);
    return status;
}

/* Groups n entries with equal block and equal values marked in `uses`: of (n): group of each; first: the
 * first entry of every group. */
static pg_status group (const entry *all, size_t n, const int uses[MOST], int *of, entry **first,
                        size_t *count)
{
    pg_status status = PG_OK;
    entry *sorted = NULL;
    size_t *leader = NULL;
    PG_ALLOC (sorted, n);
    PG_ALLOC (leader, n);
    for (size_t i = 0; i < n; i++) {
        sorted[i] = all[i];
        for (int k = 0; k < MOST; k++) if (!uses[k]) sorted[i].value[k] = 0;
    }
    pg_sort (sorted, n, sizeof *sorted, by_value);
    *count = 0;
    for (size_t i = 0; i < n; i++) {
        const entry *a = &sorted[i], *b = *count ? &sorted[*count - 1] : NULL;
        int same = b && a->block == b->block && memcmp (a->value, b->value, sizeof a->value) == 0;
        leader[a->at] = same ? b->at : a->at;
        if (!same) sorted[(*count)++] = *a;
    }
    PG_ALLOC (*first, *count + 1);
    memcpy (*first, sorted, *count * sizeof **first);
    pg_sort (*first, *count, sizeof **first, by_point);
    for (size_t g = 0; g < *count; g++) of[(*first)[g].at] = (int) g;
    for (size_t i = 0; i < n; i++) of[i] = of[leader[i]];
done:
    pg_free (sorted), pg_free (leader);
    return status;
}

/* Scales a linear law to another Young's modulus at the same Poisson's ratio. */
static void scale_law (pg_material *m, double ratio)
{
    m->E *= ratio, m->modulus *= ratio, m->mu *= ratio, m->lambda *= ratio;
    for (size_t k = 0; k < sizeof m->D / sizeof *m->D; k++) m->D[k] *= ratio;
    for (size_t k = 0; k < sizeof m->out_of_plane / sizeof *m->out_of_plane; k++)
        m->out_of_plane[k] *= ratio;
}

/* Copies the groups of all points to arrays of each set. */
static pg_status deal_out (const pg_problem *p, const int *group_of, int *to[PG_BOND_SETS])
{
    pg_status status = PG_OK;
    for (int s = 0; s < PG_BOND_SETS; s++) to[s] = NULL;
    for (int s = 0; s < PG_BOND_SETS; group_of += p->bonds.rows[s].n, s++) {
        PG_ALLOC (to[s], p->bonds.rows[s].n);
        memcpy (to[s], group_of, p->bonds.rows[s].n * sizeof *group_of);
    }
done:
    return status;
}

/* Makes the elastic laws of all points. */
static pg_status make_laws (pg_problem *p, const entry *all, size_t n, int *of)
{
    static const int stiffness[MOST] = { [PG_OF_STIFFNESS] = 1 };
    pg_status status = PG_OK;
    entry *first = NULL;
    size_t count;
    PG_TRY (group (all, n, stiffness, of, &first, &count));
    p->at.law = NULL, p->at.nlaw = count;
    PG_TRY (deal_out (p, of, p->at.law_of));
    PG_ALLOC (p->at.law, count);
    for (size_t g = 0; g < count; g++) {
        const pg_variation *v = &p->at.vary[first[g].block];
        p->at.law[g] = p->material[first[g].block];
        if (v->of[PG_OF_STIFFNESS])
            scale_law (&p->at.law[g], first[g].value[PG_OF_STIFFNESS] / v->reference[PG_OF_STIFFNESS]);
    }
done:
    pg_free (first);
    return status;
}

/* Makes the criteria of all points. */
static pg_status make_limits (pg_problem *p, const entry *all, size_t n, int *of)
{
    static const int every[MOST] = { 1, 1, 1, 1, 1 };
    pg_status status = PG_OK;
    entry *first = NULL;
    size_t count;
    PG_TRY (group (all, n, every, of, &first, &count));
    p->at.limit = NULL, p->at.nlimit = count;
    PG_TRY (deal_out (p, of, p->at.limit_of));
    PG_ALLOC (p->at.limit, count);
    for (size_t g = 0; g < count; g++) {
        pg_criterion *c = &p->at.limit[g];
        const pg_variation *v = &p->at.vary[first[g].block];
        pg_limit_ratio ratio;
        for (int k = 0; k < MOST; k++) ratio.of[k] = v->of[k] ? first[g].value[k] / v->reference[k] : 1;
        *c = p->criterion[first[g].block];
        if (!c->never) c->type->scale (c, &ratio);
    }
done:
    pg_free (first);
    return status;
}

/* Computes least, mean and largest value of each expression over the nodes of its material. */
static pg_status summarise (pg_problem *p, const entry *all)
{
    pg_status status = PG_OK;
    for (size_t m = 0; m < p->nmaterial; m++)
        for (int k = 0; k < MOST; k++) {
            pg_variation *v = &p->at.vary[m];
            double sum[2] = { 0, 0 }, ends[2] = { -INFINITY, -INFINITY };
            for (size_t i = 0; counts (p, m, k) && i < p->cloud.n; i++) {
                if (all[i].block != (int) m || !pg_cloud_owns (&p->cloud, i)) continue;
                ends[0] = fmax (ends[0], -all[i].value[k]);
                ends[1] = fmax (ends[1], all[i].value[k]);
                sum[0] += all[i].value[k], sum[1]++;
            }
            PG_TRY (pg_cloud_sum (&p->cloud, 2, sum));
            PG_TRY (pg_cloud_most (&p->cloud, 2, ends));
            v->least[k] = -ends[0], v->most[k] = ends[1];
            v->mean[k] = sum[1] > 0 ? sum[0] / sum[1] : NAN;
        }
done:
    return status;
}

/* Without variation: uses materials and blocks directly. */
static void take_blocks (pg_problem *p)
{
    p->at.law = p->material, p->at.nlaw = p->nmaterial, p->at.limit = p->criterion,
    p->at.nlimit = p->nmaterial;
    for (int s = 0; s < PG_BOND_SETS; s++) p->at.law_of[s] = p->at.limit_of[s] = p->block[s];
}

static int any_varies (const pg_problem *p)
{
    int any = 0;
    for (size_t m = 0; m < p->nmaterial; m++) for (int k = 0; k < MOST; k++) any |= counts (p, m, k);
    return any;
}

/* Makes laws and criteria of all points, after blocks are assigned. */
pg_status pg_laws_build (pg_problem *p, const pg_scene *scene)
{
    pg_status status = PG_OK;
    entry *all = NULL;
    int *of = NULL;
    size_t n = 0;
    take_blocks (p);
    if (!any_varies (p)) return PG_OK;
    for (int s = 0; s < PG_BOND_SETS; s++) n += p->bonds.rows[s].n;
    PG_ALLOC (all, n);
    PG_TRY (find_values (p, scene, all));
    PG_TRY (pg_scene_verdict (scene));
    PG_TRY (summarise (p, all));
    PG_ALLOC (of, n);
    if (pg_problem_graded (p)) PG_TRY (make_laws (p, all, n, of));
    if (pg_criterion_of_bonds (p->criterion) && p->criterion->type->scale)
        PG_TRY (make_limits (p, all, n, of));
done:
    pg_free (all), pg_free (of);
    return status;
}

/* Frees the tables that are not those of the materials. */
void pg_laws_clear (pg_problem *p)
{
    for (int s = 0; s < PG_BOND_SETS; s++) {
        if (p->at.law_of[s] != p->block[s]) pg_free (p->at.law_of[s]);
        if (p->at.limit_of[s] != p->block[s]) pg_free (p->at.limit_of[s]);
    }
    if (p->at.law != p->material) pg_free (p->at.law);
    if (p->at.limit != p->criterion) pg_free (p->at.limit);
    for (size_t m = 0; p->at.vary && m < p->nmaterial; m++)
        for (int k = 0; k < MOST; k++) pg_expression_free (&p->at.vary[m].of[k]);
    pg_free (p->at.vary);
}

size_t pg_variation_words (const pg_problem *p, size_t k, char *text, size_t size)
{
    size_t at = 0;
    for (size_t m = 0; p->at.vary && m < p->nmaterial; m++)
        for (int of = 0; of < MOST; of++) {
            const pg_variation *v = &p->at.vary[m];
            if (!v->of[of] || !counts (p, m, of) || at++ != k) continue;
            snprintf (text, size, "%s of %.40s: mean %.6g %s, least %.6g, largest %.6g (expression of place, "
                      "at its points)", what[of].key, p->material[m].name, v->mean[of],
                      strcmp (what[of].unit, "1") == 0 ? "" : what[of].unit, v->least[of], v->most[of]);
            return 1;
        }
    return 0;
}

int pg_problem_breaks_by_elongation (const pg_problem *p)
{
    return p->at.nlimit == 1 && p->at.limit->type && p->at.limit->type->elongation && !p->cloud.size
           && !pg_problem_strained (p);
}

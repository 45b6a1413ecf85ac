/* SPDX-License-Identifier: GPL-3.0-or-later
 * Search for pairs of points that may touch: by the tree for families over the displaced points, within the
 * contact distance plus a skin; pairs joined by an intact bond are excluded. While no point has moved by more
 * than half the skin, no pair is missing. Pairs of newly broken bonds are added without a new search. */
#include "near_pairs.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { BLOCK = 4096 };
static const double skin = 0.5;                        /* spacings */

static double size_of (const near_pairs *s, size_t i)
{
    const pg_cloud *c = &s->problem->cloud;
    return c->size ? c->size[i] : c->h;
}

/* ---- creation ------------------------------------------------------------------------------------------ */
pg_status near_create (near_pairs *s, const pg_problem *problem, const pg_contact_setting *setting,
                       size_t stride)
{
    pg_status status = PG_OK;
    size_t n = problem->cloud.n;
    *s = (near_pairs) { .problem = problem, .stride = stride, .dim = (size_t) problem->dim,
                        .distance = setting->distance, .stiffness = setting->stiffness,
                        .slips = setting->kind == PG_CONTACT_FRICTION && problem->dim > 1 };
    s->impulses = setting->impulses, s->skin = problem->plain && !s->impulses ? 0 : skin;
    s->finest = pg_cloud_finest (&problem->cloud);
    s->nblock = (n * stride + BLOCK - 1) / BLOCK;
    PG_ALLOC (s->modulus, problem->at.nlaw);
    PG_ALLOC (s->shear, problem->at.nlaw);
    PG_ALLOC (s->local, n);
    PG_ALLOC (s->start, n * stride);
    PG_ALLOC (s->most, s->nblock);
    for (size_t m = 0; m < problem->at.nlaw; m++) {
        const pg_material *material = &problem->at.law[m];
        double c = pg_material_waves (material).pressure;
        s->modulus[m] = c > 0 ? material->density * c * c : material->modulus;
        s->shear[m] = material->mu;
    }
    for (size_t i = 0; i < n; i++) s->local[i] = problem->cloud.volume[i] / (size_of (s, i) * size_of (s, i));
done:
    return status;
}

/* Frees a search for near pairs and zeroes it, also one that was made in part only. */
void near_free (near_pairs *s)
{
    pg_free (s->modulus), pg_free (s->shear), pg_free (s->local), pg_free (s->start), pg_free (s->most);
    pg_free (s->pair), pg_free (s->slip), pg_free (s->row), pg_free (s->memory);
    memset (s, 0, sizeof *s);
}

/* ---- a pair -------------------------------------------------------------------------------------------- */
static near_pair pair_of (const near_pairs *s, size_t i, size_t j)
{
    const pg_problem *p = s->problem;
    const double *x = p->cloud.x;
    int a = p->at.law_of[PG_NODES][i], b = p->at.law_of[PG_NODES][j];
    double rr = 0, M = 2 * s->modulus[a] * s->modulus[b] / (s->modulus[a] + s->modulus[b]),
           G = 2 * s->shear[a] * s->shear[b] / (s->shear[a] + s->shear[b]);
    for (size_t k = 0; k < s->dim; k++) rr += pow (x[j * s->dim + k] - x[i * s->dim + k], 2);
    double full = fmin (0.5 * s->distance * (size_of (s, i) + size_of (s, j)), sqrt (rr));
    return (near_pair) { .i = (int) i, .j = (int) j, .reach = full, .full = full,
                         .k = s->stiffness * M * fmin (s->local[i], s->local[j]),
                         .share = G > 0 ? fmin (G / M, 1) : 0 };
}

/* Entry of node j in the family of i (bisection); SIZE_MAX: j is not in it. */
static size_t entry_of (const pg_family *family, size_t i, int j)
{
    size_t low = family->start[i], high = family->start[i + 1];
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (family->node[middle] < j) low = middle + 1;
        else high = middle;
    }
    return low < family->start[i + 1] && family->node[low] == j ? low : SIZE_MAX;
}

static int bonded (const near_pairs *s, const unsigned char *alive, size_t i, size_t j)
{
    const pg_family *family = &s->problem->bonds.rows[PG_NODES].family;
    const unsigned char *own = alive + s->problem->bonds.first[PG_NODES];
    size_t one = entry_of (family, i, (int) j), other = entry_of (family, j, (int) i);
    return (one != SIZE_MAX && own[one]) || (other != SIZE_MAX && own[other]);
}

/* ---- has anything moved too far? ----------------------------------------------------------------------- */
typedef struct { const near_pairs *s; const double *d; size_t ndof; } motion_look;

/* Finds the largest change of a displacement component in each block (eight lanes for vector instructions);
 * INFINITY if values are not finite. */
static void look_at_blocks (void *context, size_t first, size_t last, int thread)
{
    const motion_look *w = context;
    (void) thread;
    for (size_t b = first; b < last; b++) {
        size_t i = b * BLOCK, end = i + BLOCK < w->ndof ? i + BLOCK : w->ndof;
        const double *restrict d = w->d, *restrict start = w->s->start;
        double lane[8] = { 0 }, wrong = 0;
        for (; i + 8 <= end; i += 8)
            for (size_t k = 0; k < 8; k++) {
                double change = fabs (d[i + k] - start[i + k]);
                lane[k] = change > lane[k] ? change : lane[k];
                wrong += 0 * d[i + k];
            }
        for (; i < end; i++) lane[0] = fmax (lane[0], fabs (d[i] - start[i])), wrong += 0 * d[i];
        for (size_t k = 1; k < 8; k++) lane[0] = fmax (lane[0], lane[k]);
        w->s->most[b] = wrong == 0 ? lane[0] : INFINITY;
    }
}

/* Upper bound of the motion of any point since the last search, m. */
static double moved (near_pairs *s, const double *d)
{
    motion_look w = { s, d, s->problem->cloud.n * s->stride };
    double most = 0;
    pg_parallel (s->problem->threads, s->nblock, look_at_blocks, &w);
    for (size_t b = 0; b < s->nblock; b++) most = fmax (most, s->most[b]);
    return most * sqrt ((double) s->dim);
}

/* ---- slips from list to list --------------------------------------------------------------------------- */
pg_status near_collect (near_pairs *s)
{
    pg_status status = PG_OK;
    if (!s->valid) return PG_OK;                       /* `memory` is up to date already */
    s->nmemory = 0;
    for (size_t q = 0; q < s->n; q++) {
        static const double none[3] = { 0 };
        const near_pair *p = &s->pair[q];
        const double *v = s->slips ? s->slip + 3 * q : none;
        int shorter = p->reach < p->full;
        if (v[0] == 0 && v[1] == 0 && v[2] == 0 && !shorter) continue;
        PG_GROW (s->memory, s->cap_memory, s->nmemory + 1);
        s->memory[s->nmemory++] = (near_memory) { p->i, p->j, { v[0], v[1], v[2] }, shorter ? p->reach : 0 };
    }
done:
    return status;
}

static int before (int i, int j, int other_i, int other_j)
{
    return i < other_i || (i == other_i && j < other_j);
}

/* Sets the rows of the sorted list, and restores slips and reduced contact distances of its pairs from
 * `memory`. */
static pg_status finish (near_pairs *s)
{
    pg_status status = PG_OK;
    PG_GROW (s->row, s->cap_row, s->n + 1);
    s->nrow = 0;
    for (size_t q = 0; q < s->n; q++) if (q == 0 || s->pair[q].i != s->pair[q - 1].i) s->row[s->nrow++] = q;
    s->row[s->nrow] = s->n;
    if (s->slips) PG_GROW (s->slip, s->cap_slip, 3 * s->n);
    if (s->slips && s->n) memset (s->slip, 0, 3 * s->n * sizeof *s->slip);
    for (size_t q = 0, m = 0; q < s->n; q++) {
        near_pair *p = &s->pair[q];
        while (m < s->nmemory && before (s->memory[m].i, s->memory[m].j, p->i, p->j)) m++;
        int known = m < s->nmemory && s->memory[m].i == p->i && s->memory[m].j == p->j;
        if (known && s->slips) memcpy (s->slip + 3 * q, s->memory[m].slip, sizeof s->memory[m].slip);
        if (known && s->memory[m].reach > 0) p->reach = s->memory[m].reach;
    }
    s->valid = 1;
done:
    return status;
}

/* ---- search -------------------------------------------------------------------------------------------- */
/* Returns 1: pair i, j is taken from the family of i: at the point of smaller spacing (equal: of lower
 * index), whose family surely contains the other. */
static int takes (const near_pairs *s, size_t i, size_t j)
{
    double a = size_of (s, i), b = size_of (s, j);
    return a < b || (a == b && i < j);
}

typedef struct { size_t i, j; } found_pair;

static int by_place (const void *a, const void *b)
{
    const near_pair *p = a, *q = b;
    return before (p->i, p->j, q->i, q->j) ? -1 : before (q->i, q->j, p->i, p->j);
}

/* Makes the list with both directions of the pairs, sorted by first point (counting sort), then by second. */
static pg_status sort_pairs (near_pairs *s, size_t npair, const found_pair *found)
{
    pg_status status = PG_OK;
    size_t n = s->problem->cloud.n, *at = NULL;
    PG_ALLOC (at, n + 2);
    PG_GROW (s->pair, s->cap, 2 * npair);
    for (size_t q = 0; q < npair; q++) at[found[q].i + 2]++, at[found[q].j + 2]++;
    for (size_t i = 2; i < n + 2; i++) at[i] += at[i - 1];
    for (size_t q = 0; q < npair; q++) {
        near_pair one = pair_of (s, found[q].i, found[q].j), other = one;
        other.i = one.j, other.j = one.i;
        s->pair[at[found[q].i + 1]++] = one, s->pair[at[found[q].j + 1]++] = other;
    }
    s->n = 2 * npair;
    for (size_t q = 0; q < s->n;) {
        size_t end = at[s->pair[q].i + 1];
        pg_sort (s->pair + q, end - q, sizeof *s->pair, by_place);
        q = end;
    }
done:
    pg_free (at);
    return status;
}

/* Searches all pairs anew, by the tree over the displaced points. */
static pg_status search (near_pairs *s, const pg_state *state)
{
    pg_status status = PG_OK;
    const pg_problem *p = s->problem;
    size_t n = p->cloud.n, npair = 0, cap = 0;
    pg_cloud moved_cloud = p->cloud;
    pg_family_search *tree = NULL;
    pg_family near = { 0 };
    found_pair *found = NULL;
    double *x = NULL;
    PG_TRY (near_collect (s));
    s->valid = 0;
    PG_ALLOC (x, n * s->dim);
    for (size_t i = 0; i < n; i++)
        for (size_t k = 0; k < s->dim; k++)
            x[i * s->dim + k] = p->cloud.x[i * s->dim + k] + state->d[i * s->stride + k];
    moved_cloud.x = x, moved_cloud.metric = NULL;
    PG_TRY (pg_family_search_create (&tree, &moved_cloud, (s->distance + s->skin) * p->cloud.h, PG_RADIAL,
                                     1));
    PG_TRY (pg_family_find (&near, tree, n, x, p->threads));
    for (size_t i = 0; i < n; i++)
        for (size_t e = near.start[i]; e < near.start[i + 1]; e++) {
            size_t j = (size_t) near.node[e];
            if (j == i || !takes (s, i, j) || bonded (s, state->alive, i, j)) continue;
            PG_GROW (found, cap, npair + 1);
            found[npair++] = (found_pair) { i, j };
        }
    PG_TRY (sort_pairs (s, npair, found));
    memcpy (s->start, state->d, n * s->stride * sizeof *s->start);
    PG_TRY (finish (s));
    s->way = 0, s->searches++;
done:
    pg_family_search_free (&tree);
    pg_family_clear (&near);
    pg_free (found), pg_free (x);
    return status;
}

/* ---- bonds that broke ---------------------------------------------------------------------------------- */
/* Returns 1: at the last search points i and j were so near that they may touch before the next one. */
static int within (const near_pairs *s, size_t i, size_t j, double reach)
{
    double rr = 0, limit = reach + s->skin * fmax (size_of (s, i), size_of (s, j));
    const double *x = s->problem->cloud.x;
    for (size_t k = 0; k < s->dim; k++)
        rr += pow (x[j * s->dim + k] + s->start[j * s->stride + k]
                   - (x[i * s->dim + k] + s->start[i * s->stride + k]), 2);
    return rr <= limit * limit * (1 + 1e-9);
}

/* Merges the pairs of newly broken bonds (broken in both directions) into the list. */
static pg_status add_broken (near_pairs *s, const pg_state *state, const pg_changes *broken)
{
    pg_status status = PG_OK;
    const pg_problem *p = s->problem;
    near_pair *fresh = NULL, *all = NULL;
    size_t nfresh = 0, cap = 0, kept = 0, n = 0;
    for (size_t c = 0; c < broken->n; c++) {
        int set;
        size_t i, j;
        pg_problem_locate (p, broken->bond[c], &set, &i);
        if (set != PG_NODES) continue;
        j = (size_t) p->bonds.rows[PG_NODES].family.node[broken->bond[c] - p->bonds.first[PG_NODES]];
        near_pair one = pair_of (s, i, j), other = one;
        if (i == j || !within (s, i, j, one.reach) || bonded (s, state->alive, i, j)) continue;
        other.i = one.j, other.j = one.i;
        PG_GROW (fresh, cap, nfresh + 2);
        fresh[nfresh++] = one, fresh[nfresh++] = other;
    }
    if (!nfresh) goto done;
    PG_TRY (near_collect (s));
    s->valid = 0;
    pg_sort (fresh, nfresh, sizeof *fresh, by_place);
    PG_ALLOC (all, s->n + nfresh);
    for (size_t a = 0; a < s->n || kept < nfresh;) {
        int old = a < s->n && (kept == nfresh || by_place (&s->pair[a], &fresh[kept]) <= 0);
        near_pair next = old ? s->pair[a++] : fresh[kept++];
        if (n == 0 || by_place (&all[n - 1], &next) != 0) all[n++] = next;
    }
    pg_free (s->pair);
    s->pair = all, s->cap = s->n + nfresh, s->n = n, all = NULL;
    PG_TRY (finish (s));
done:
    pg_free (fresh), pg_free (all);
    return status;
}

/* Current distance of points i and j, m, computed exactly as for their force. */
static double apart (const near_pairs *s, const pg_state *state, size_t i, size_t j)
{
    const double *x = s->problem->cloud.x, *d = state->d;
    double rr = 0;
    for (size_t k = 0; k < s->dim; k++) {
        double e = (x[j * s->dim + k] - x[i * s->dim + k]) + (d[j * s->stride + k] - d[i * s->stride + k]);
        rr += e * e;
    }
    return sqrt (rr);
}

static near_pair *listed (near_pairs *s, int i, int j)
{
    const near_pair one = { .i = i, .j = j };
    return pg_search (&one, s->pair, s->n, sizeof one, by_place);
}

/* Pairs whose bond breaks at less than their contact distance get their present distance as contact distance,
 * until they have been farther apart: otherwise the contact spring would start loaded and add energy. Not
 * needed for impulses. */
static void touch_from_here (near_pairs *s, const pg_state *state, const pg_changes *broken)
{
    const pg_family *family = &s->problem->bonds.rows[PG_NODES].family;
    for (size_t c = 0; c < broken->n && !s->impulses; c++) {
        int set;
        size_t i, j;
        pg_problem_locate (s->problem, broken->bond[c], &set, &i);
        if (set != PG_NODES) continue;
        j = (size_t) family->node[broken->bond[c] - s->problem->bonds.first[PG_NODES]];
        near_pair *one = listed (s, (int) i, (int) j), *other = listed (s, (int) j, (int) i);
        double r = one && other ? apart (s, state, i, j) : INFINITY;
        if (isfinite (r) && r < one->full) one->reach = other->reach = r;
    }
}

/* Updates the list: the summed bounds of motion per step suffice while small; else the actual motion is
 * measured. */
pg_status near_update (near_pairs *s, const pg_state *state, const pg_changes *broken, int changed,
                       double way)
{
    pg_status status = PG_OK;
    /* impulses need the pairs one step ahead: half of the skin is kept for the next step */
    double limit = (s->impulses ? 0.25 : 0.5) * s->skin * s->finest;
    int keeps = s->valid && !changed && limit > 0 && !s->problem->plain;
    s->way += way;
    if (keeps && !(s->way <= limit)) s->way = moved (s, state->d);
    if (keeps && s->way <= limit) {
        if (broken && broken->n) PG_TRY (add_broken (s, state, broken));
        if (broken) touch_from_here (s, state, broken);
        goto done;
    }
    /* displacements that are not finite: no search (the run ends elsewhere) */
    for (size_t i = 0; i < s->problem->cloud.n * s->stride; i++) if (!isfinite (state->d[i])) goto done;
    PG_TRY (search (s, state));
    if (broken) touch_from_here (s, state, broken);
done:
    return status;
}

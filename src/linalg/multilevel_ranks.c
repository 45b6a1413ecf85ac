/* SPDX-License-Identifier: GPL-3.0-or-later
 * Levels of ranks that share the nodes of a lattice (perigal/ranks.h). Every rank has the finest level of the
 * nodes that it holds, smooths it by its own loops, and makes the rows of the first coarse matrix of the
 * functions that it owns; the levels below are what all ranks make of these rows together
 * (pg_shared_preconditioner, of PETSc). Where one process has products with A, ranks bring the ghosts of the
 * vector up to date before.
 *
 * Grids are laid from site 0 of the whole lattice, so that all ranks have the same vertices. A function
 * belongs to the rank that owns the site where its vertex stands (of a vertex beyond the end of the lattice
 * the last site): the layer of ghosts is wide enough for all nodes under such a function and for their rows,
 * so that the owner needs no sums of others. Which parts a crack makes of a hat function its nodes are told
 * by their owners, as ghosts near the rim do not see all of it. */
#include "multilevel.h"
#include <math.h>
#include <string.h>

pg_status level_exchange (const level *l, double *x)
{
    return pg_subdomain_exchange (l->part, (size_t) l->block, x);
}

double level_sum (const level *l, double mine)
{
    if (l->part && pg_ranks_sum (1, &mine) != PG_OK) return NAN;
    return mine;
}

/* ---- the whole lattice --------------------------------------------------------------------------------- */
/* Sites that each rank owns (boxes: pg_free), and how many there are along each axis. */
static pg_status share_boxes (const pg_subdomain *part, pg_box **boxes, size_t *size, long long sites[3])
{
    pg_status status = PG_OK;
    double mine[6], *all = NULL;
    size_t n = 0;
    for (int k = 0; k < 3; k++) mine[k] = part->own.low[k], mine[3 + k] = part->own.high[k], sites[k] = 1;
    PG_TRY (pg_ranks_share (6, mine, &n, &all));
    *size = n / 6;
    PG_ALLOC (*boxes, *size);
    for (size_t r = 0; r < *size; r++)
        for (int k = 0; k < 3; k++) {
            (*boxes)[r].low[k] = (int) all[6 * r + (size_t) k];
            (*boxes)[r].high[k] = (int) all[6 * r + 3 + (size_t) k];
            if ((*boxes)[r].high[k] > sites[k]) sites[k] = (*boxes)[r].high[k];
        }
done:
    pg_free (all);
    return status;
}

/* Ghosts take no part where they do not for their owners. */
static pg_status agree_masks (level *l)
{
    pg_status status = PG_OK;
    double *mask = NULL;
    PG_ALLOC (mask, l->n);
    for (size_t i = 0; i < l->n; i++) mask[i] = l->mask[i];
    PG_TRY (pg_subdomain_exchange (l->part, 1, mask));
    for (size_t i = 0; i < l->n; i++) l->mask[i] = (unsigned char) mask[i];
done:
    pg_free (mask);
    return status;
}

pg_status level_join (level *l, double *step)
{
    pg_status status = PG_OK;
    pg_box *boxes = NULL;
    size_t size;
    long long sites[3], at;
    if (!l->part) return PG_OK;
    for (int k = 0; k < l->dim; k++)
        if (!l->aligned || !(l->rows.lattice[k] > 0))
            PG_FAIL (PG_E_USAGE, "ranks share the nodes of a lattice, with vertices of coarse grids on them");
    PG_TRY (share_boxes (l->part, &boxes, &size, sites));
    at = l->n ? l->part->number[0] : 0;
    for (int k = 0; k < l->dim && l->n; at /= sites[k++])
        l->origin[k] = l->x[k] - (double) (at % sites[k]) * l->rows.lattice[k];
    PG_TRY (pg_ranks_most (1, step));
    PG_TRY (agree_masks (l));
done:
    pg_free (boxes);
    return status;
}

void level_align (level *l, int axis)
{
    if (!l->part) return;
    double h = l->step[axis], first = floor ((l->low[axis] - l->origin[axis]) / h + 1e-6);
    l->low[axis] = l->origin[axis] + first * h;
}

/* ---- parts of hat functions ---------------------------------------------------------------------------- */
pg_status level_agree_parts (level *l, size_t *parts)
{
    pg_status status = PG_OK;
    size_t corners = (size_t) l->corners;
    double *part = NULL;
    if (!l->part) return PG_OK;
    PG_ALLOC (part, l->n * corners);
    for (size_t i = 0; i < l->n * corners; i++) part[i] = l->function[i];
    PG_TRY (pg_subdomain_exchange (l->part, corners, part));
    for (size_t i = 0; i < l->n; i++)
        for (size_t c = 0; c < corners; c++) {
            if (!(l->weight[i * corners + c] > 0)) continue;
            size_t vertex = level_vertex (l, (size_t) l->cell[i], (int) c);
            l->function[i * corners + c] = (int) part[i * corners + c];
            if ((size_t) l->function[i * corners + c] >= parts[vertex])
                parts[vertex] = (size_t) l->function[i * corners + c] + 1;
        }
done:
    pg_free (part);
    return status;
}

/* ---- who owns which function --------------------------------------------------------------------------- */
/* Parts of one hat function at most, in the number of a function. */
enum { MOST_PARTS = 4096 };

/* Functions as all ranks know them: a number, ascending with that here, and the owner. need: 1 for those of
 * others whose values or rows are asked for here. */
typedef struct { int64_t *key; int *owner; unsigned char *need; } functions;

static int owner_of (const pg_box *boxes, size_t size, int dim, const long long *site)
{
    for (size_t r = 0; r < size; r++) {
        int in = 1;
        for (int k = 0; k < dim; k++) in = in && site[k] >= boxes[r].low[k] && site[k] < boxes[r].high[k];
        if (in) return (int) r;
    }
    return 0;
}

static pg_status number_functions (functions *out, const level *f)
{
    pg_status status = PG_OK;
    pg_box *boxes = NULL;
    size_t size;
    long long sites[3], site[3] = { 0 };
    int at[3];
    PG_TRY (share_boxes (f->part, &boxes, &size, sites));
    for (size_t h = 0; h < f->nvertex; h++) {
        int64_t vertex = 0, stride = 1;
        level_vertex_place (f, h, at);
        for (int k = 0; k < f->dim; k++) {
            long long v = (long long) round ((f->low[k] - f->origin[k]) / f->step[k]) + at[k],
                      last = sites[k] - 1;
            site[k] = v * f->share_of[k] < last ? v * f->share_of[k] : last;
            vertex += v * stride, stride *= last / f->share_of[k] + 2;
        }
        if (f->first[h + 1] - f->first[h] > MOST_PARTS)
            PG_FAIL (PG_E_LIMIT, "cracks leave more than %d parts of a coarse function", (int) MOST_PARTS);
        for (size_t p = f->first[h]; p < f->first[h + 1]; p++) {
            out->key[p] = vertex * MOST_PARTS + (int64_t) (p - f->first[h]);
            out->owner[p] = owner_of (boxes, size, f->dim, site);
        }
    }
done:
    pg_free (boxes);
    return status;
}

/* Those at nodes that are owned here, and those that the rows of owned functions lead to. */
static pg_status find_needed (functions *out, const level *c, const level *f)
{
    pg_status status = PG_OK;
    size_t corners = (size_t) f->corners;
    int *node = NULL, me = pg_rank ();
    PG_ALLOC (node, c->rows.widest);
    for (size_t i = 0; i < f->n; i++)
        for (size_t k = 0; k < corners && f->part->owned[i]; k++)
            if (f->function[i * corners + k] >= 0) out->need[f->function[i * corners + k]] = 1;
    for (size_t p = 0; p < c->n; p++) {
        if (out->owner[p] != me) continue;
        size_t m = level_row (c, p, 0, node, NULL);
        for (size_t e = 0; e < m; e++) out->need[node[e]] = 1;
    }
    for (size_t p = 0; p < c->n; p++) if (out->owner[p] == me) out->need[p] = 0;
done:
    pg_free (node);
    return status;
}

/* The function of that number here; -1: there is none. */
static long find (const functions *f, size_t n, int64_t key)
{
    size_t low = 0, high = n;
    while (low < high) {
        size_t middle = (low + high) / 2;
        if (f->key[middle] < key) low = middle + 1;
        else high = middle;
    }
    return low < n && f->key[low] == key ? (long) low : -1;
}

/* What all ranks ask of others: three numbers each, who asks, whom, for which function. */
static pg_status ask (const functions *f, size_t n, size_t *n_all, double **all)
{
    pg_status status = PG_OK;
    double *mine = NULL;
    size_t count = 0;
    PG_ALLOC (mine, 3 * n);
    for (size_t p = 0; p < n; p++) {
        if (!f->need[p]) continue;
        mine[3 * count] = pg_rank (), mine[3 * count + 1] = f->owner[p];
        mine[3 * count++ + 2] = (double) f->key[p];
    }
    PG_TRY (pg_ranks_share (3 * count, mine, n_all, all));
    *n_all /= 3;
done:
    pg_free (mine);
    return status;
}

/* Ranks that ask here or are asked, ascending, and where the list of each begins. at (2 size): place of each
 * rank in `send`, then in `receive`. */
static void list_ranks (pg_halo *h, size_t size, size_t n_all, const double *all, size_t *at)
{
    size_t *send = at, *receive = at + size;
    int me = pg_rank ();
    for (size_t e = 0; e < n_all; e++) {
        int asks = (int) all[3 * e], asked = (int) all[3 * e + 1];
        if (asked == me) send[asks]++;
        if (asks == me) receive[asked]++;
    }
    for (size_t r = 0, s = 0, t = 0; r < size; r++) {
        size_t nsend = send[r], nreceive = receive[r];
        send[r] = s, receive[r] = t, s += nsend, t += nreceive;
        if (nsend + nreceive == 0) continue;
        h->rank[h->n++] = (int) r;
        h->send_first[h->n] = s, h->receive_first[h->n] = t;
    }
}

/* With each rank what it asks for here, and what is asked of it, in the order of the numbers. */
static pg_status make_halo (pg_halo *h, const functions *f, size_t n, size_t n_all, const double *all)
{
    pg_status status = PG_OK;
    size_t size = (size_t) pg_rank_count (), *at = NULL;
    double lost = 0;
    int me = pg_rank ();
    PG_ALLOC (at, 2 * size);
    PG_ALLOC (h->rank, size);
    PG_ALLOC (h->send_first, size + 1);
    PG_ALLOC (h->receive_first, size + 1);
    list_ranks (h, size, n_all, all, at);
    PG_ALLOC (h->send, h->send_first[h->n]);
    PG_ALLOC (h->receive, h->receive_first[h->n]);
    for (size_t e = 0; e < n_all; e++) {
        int asks = (int) all[3 * e], asked = (int) all[3 * e + 1];
        long p = asks == me || asked == me ? find (f, n, (int64_t) all[3 * e + 2]) : 0;
        if (p < 0) lost = 1, p = 0;
        if (asked == me) h->send[at[asks]++] = (int) p;
        if (asks == me) h->receive[at[(int) size + asked]++] = (int) p;
    }
    PG_TRY (pg_ranks_most (1, &lost));
    if (lost > 0) PG_FAIL (PG_E_FILE, "ranks disagree about their coarse functions");
done:
    pg_free (at);
    return status;
}

pg_status level_divide (level *c, const level *f)
{
    pg_status status = PG_OK;
    functions all = { 0 };
    double *asked = NULL;
    size_t n = 0;
    if (!f->part) return PG_OK;
    PG_ALLOC (all.key, c->n);
    PG_ALLOC (all.owner, c->n);
    PG_ALLOC (all.need, c->n);
    PG_ALLOC (c->made, 1);
    PG_ALLOC (c->made->owned, c->n);
    PG_TRY (number_functions (&all, f));
    PG_TRY (find_needed (&all, c, f));
    c->made->n = c->n;
    for (size_t p = 0; p < c->n; p++) {
        c->made->owned[p] = all.owner[p] == pg_rank ();
        c->made->nowned += c->made->owned[p];
    }
    PG_TRY (ask (&all, c->n, &n, &asked));
    PG_TRY (make_halo (&c->made->halo, &all, c->n, n, asked));
    c->part = c->made;
done:
    pg_free (all.key), pg_free (all.owner), pg_free (all.need), pg_free (asked);
    return status;
}

/* ---- the levels below ---------------------------------------------------------------------------------- */
/* Functions may be sums of others, where a crack leaves few nodes under them: the matrix is then singular,
 * and a share of its diagonal makes up for it, as in coarsest_matrix. */
static const double lift = 1e-10;

static size_t row_of (void *context, size_t i, int thread, int *node, double *value)
{
    const level *l = context;
    size_t block = (size_t) l->block, m = level_row (l, i, thread, node, value);
    for (size_t e = 0; value && e < m; e++)
        for (size_t k = 0; k < block && (size_t) node[e] == i; k++)
            value[(e * block + k) * block + k] *= 1 + lift;
    return m;
}

/* The matrix is not needed any more when they are made. */
pg_status multilevel_pass_on (pg_multilevel *m, level *l)
{
    pg_status status = PG_OK;
    pg_shared_rows s = { .dim = l->dim, .block = l->block, .x = l->x, .subdomain = l->part, .k = 1,
                         .rows = { .context = l, .widest = l->rows.widest, .row = row_of } };
    for (int k = 0; k < l->dim; k++) {
        s.rows.lattice[k] = l->rows.lattice[k];
        s.rows.reach = fmax (s.rows.reach, l->reach[k]);
    }
    m->below = pg_shared_preconditioner_now ();
    if (!m->below) PG_FAIL (PG_E_USAGE, "ranks share no preconditioner");
    PG_TRY (m->below->create (&m->shared, &s));
    m->unknowns = 0;
    for (size_t i = 0; i < m->at[0].n; i++)
        m->unknowns += m->at[0].part->owned[i] ? m->at[0].block : 0;
    PG_TRY (pg_ranks_sum (1, &m->unknowns));
    pg_free (l->start), pg_free (l->node), pg_free (l->value);
    l->start = NULL, l->node = NULL, l->value = NULL;
done:
    return status;
}

pg_status multilevel_solve_below (pg_multilevel *m, const level *l, const double *b, double *z)
{
    pg_status status = PG_OK;
    PG_TRY (m->below->solve (m->shared, b, z));
    PG_TRY (level_exchange (l, z));
done:
    return status;
}

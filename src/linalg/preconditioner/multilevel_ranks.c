/* SPDX-License-Identifier: GPL-3.0-or-later
 * The finest level where ranks share the nodes of a lattice (perigal/ranks.h). Every rank smooths the nodes
 * that it holds; before each product with A the ghosts of the vector are updated. Each rank computes the
 * contributions of the nodes that it owns to the coarse matrix P' A P and to right-hand sides P' r, also for
 * functions that other ranks own, so that the layer of ghosts need not be wider than products require. The
 * sums over all ranks are a level as in one process, which every rank has in full as long as that is little
 * work beside the finest level (multilevel_whole.c); else each rank has the rows of the functions that it
 * owns, and all ranks make the levels below together (pg_shared_preconditioner, by PETSc).
 *
 * Grids start at site 0 of the whole lattice, so that all ranks have the same vertices. Into which parts a
 * crack splits a hat function one rank alone may not know: each rank joins the nodes that its own nodes are
 * coupled with, and the results are exchanged. A part is named by its node of least number, and belongs to
 * the rank that owns this node. */
#include "multilevel.h"
#include <limits.h>
#include <math.h>
#include <stdlib.h>
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
/* Collects the boxes of sites that the ranks own, and the number of sites along each axis. */
static pg_status share_boxes (const pg_subdomain *part, level_ranks *out)
{
    pg_status status = PG_OK;
    double mine[6], *all = NULL;
    size_t n = 0;
    for (int k = 0; k < 3; k++)
        mine[k] = part->own.low[k], mine[3 + k] = part->own.high[k], out->sites[k] = 1;
    PG_TRY (pg_ranks_share (6, mine, &n, &all));
    out->size = n / 6;
    PG_ALLOC (out->box, out->size);
    for (size_t r = 0; r < out->size; r++)
        for (int k = 0; k < 3; k++) {
            out->box[r].low[k] = (int) all[6 * r + (size_t) k];
            out->box[r].high[k] = (int) all[6 * r + 3 + (size_t) k];
            if (out->box[r].high[k] > out->sites[k]) out->sites[k] = out->box[r].high[k];
        }
done:
    pg_free (all);
    return status;
}

/* Indices of a site of the whole lattice from its number. */
static void place_of (const level_ranks *l, int64_t number, long long *at)
{
    for (int k = 0; k < 3; k++) at[k] = number % l->sites[k], number /= l->sites[k];
}

/* Sets `from`, the neighbour that owns each node. Ghosts get the masks of their owners; ghosts that no
 * neighbour sends are masked. */
static pg_status agree_masks (level *l)
{
    pg_status status = PG_OK;
    double *mask = NULL;
    const pg_halo *h = &l->part->halo;
    PG_ALLOC (mask, l->n);
    PG_ALLOC (l->ranks->from, l->n);
    for (size_t i = 0; i < l->n; i++) {
        l->ranks->from[i] = l->part->owned[i] ? MINE : NOBODYS;
        mask[i] = l->part->owned[i] ? l->mask[i] : (1 << l->block) - 1;
    }
    for (size_t k = 0; k < h->n; k++)
        for (size_t q = h->receive_first[k]; q < h->receive_first[k + 1]; q++)
            l->ranks->from[h->receive[q]] = (int) k;
    PG_TRY (pg_subdomain_exchange (l->part, 1, mask));
    for (size_t i = 0; i < l->n; i++) {
        l->mask[i] = (unsigned char) mask[i];
        for (size_t k = 0; l->ranks->from[i] == NOBODYS && k < (size_t) l->block; k++)
            l->inverse[i * (size_t) l->block + k] = 0;
    }
done:
    pg_free (mask);
    return status;
}

pg_status level_join (level *l, double *step)
{
    pg_status status = PG_OK;
    long long at[3];
    if (!l->part) return PG_OK;
    for (int k = 0; k < l->dim; k++)
        if (!l->grid.aligned || !(l->rows.lattice[k] > 0))
            PG_FAIL (PG_E_USAGE, "ranks share the nodes of a lattice, with vertices of coarse grids on them");
    if (l->n > (size_t) (INT_MAX >> l->dim))
        PG_FAIL (PG_E_LIMIT, "%zu points on one rank are too many", l->n);
    PG_ALLOC (l->ranks, 1);
    PG_TRY (share_boxes (l->part, l->ranks));
    if (l->n) place_of (l->ranks, l->part->number[0], at);
    for (int k = 0; k < l->dim && l->n; k++) l->origin[k] = l->x[k] - (double) at[k] * l->rows.lattice[k];
    PG_TRY (pg_ranks_most (1, step));
    PG_TRY (agree_masks (l));
done:
    return status;
}

void level_ranks_free (level_ranks **ranks)
{
    level_ranks *l = *ranks;
    if (!l) return;
    pg_free (l->box), pg_free (l->from), pg_free (l->joined), pg_free (l->label);
    pg_free (l);
    *ranks = NULL;
}

void level_align (level *l, int axis)
{
    if (!l->part) return;
    double h = l->grid.step[axis], first = floor ((l->grid.low[axis] - l->origin[axis]) / h + 1e-6);
    l->grid.low[axis] = l->origin[axis] + first * h;
}

/* ---- parts of hat functions ---------------------------------------------------------------------------- */
/* A part of the hat function at a vertex, other than the first one found: its label and its number. */
typedef struct { size_t vertex; double label; int part; } further;

static int by_vertex (const void *a, const void *b)
{
    const further *x = a, *y = b;
    if (x->vertex != y->vertex) return x->vertex < y->vertex ? -1 : 1;
    return (x->label > y->label) - (x->label < y->label);
}

/* Sorts the list, drops repeated entries, and numbers the parts of each hat function. Returns how many are
 * left. */
static size_t number_further (further *list, size_t n, size_t *parts)
{
    size_t last = 0;
    if (n) pg_sort (list, n, sizeof *list, by_vertex);
    for (size_t k = 0; k < n; k++) {
        if (k > 0 && by_vertex (&list[k], &list[last - 1]) == 0) continue;
        list[last] = list[k];
        list[last].part = (int) parts[list[last].vertex]++;
        last++;
    }
    return last;
}

static size_t vertex_of (const level *l, size_t entry)
{
    size_t corners = (size_t) l->corners;
    return level_vertex (l, (size_t) l->coarse.cell[entry / corners], (int) (entry % corners));
}

/* Sets `function` to the part, of each of a node's hat functions, to which the node belongs, by the labels;
 * parts: number of parts of each hat function. */
static pg_status count_parts (level *l, size_t *parts)
{
    pg_status status = PG_OK;
    const double *label = l->ranks->label;
    double *first = NULL;
    further *list = NULL;
    size_t n = 0, cap = 0, entries = l->n * (size_t) l->corners;
    PG_ALLOC (first, l->grid.nvertex);
    for (size_t e = 0; e < entries; e++) {
        if (!(l->coarse.weight[e] > 0)) continue;
        size_t v = vertex_of (l, e);
        l->coarse.function[e] = 0;
        if (!parts[v]) parts[v] = 1, first[v] = label[e];
        if (label[e] == first[v]) continue;
        PG_GROW (list, cap, n + 1);
        list[n++] = (further) { v, label[e], 0 };
        l->coarse.function[e] = 1;
    }
    n = number_further (list, n, parts);
    for (size_t e = 0; e < entries; e++) {
        if (!(l->coarse.weight[e] > 0) || !l->coarse.function[e]) continue;
        further one = { vertex_of (l, e), label[e], 0 };
        l->coarse.function[e] = ((further *) pg_search (&one, list, n, sizeof *list, by_vertex))->part;
    }
done:
    pg_free (first), pg_free (list);
    return status;
}

pg_status level_agree_parts (level *l, size_t *parts)
{
    pg_status status = PG_OK;
    size_t corners = (size_t) l->corners;
    if (!l->part) return PG_OK;
    PG_ALLOC (l->ranks->label, l->n * corners);
    PG_TRY (pg_subdomain_label (l->part, l->n, corners, l->ranks->joined, l->ranks->label));
    PG_TRY (count_parts (l, parts));
done:
    pg_free (l->ranks->joined);
    l->ranks->joined = NULL;
    return status;
}

/* ---- who owns which function --------------------------------------------------------------------------- */
static int owner_of (const level_ranks *l, int dim, const long long *site)
{
    for (size_t r = 0; r < l->size; r++) {
        int in = 1;
        for (int k = 0; k < dim; k++) in = in && site[k] >= l->box[r].low[k] && site[k] < l->box[r].high[k];
        if (in) return (int) r;
    }
    return 0;
}

/* Fills in number, vertex, owner and position of each function. Its number, the label of its part, is that of
 * its least node times the corners of a cell, plus a corner. */
static void number_functions (const level *f, function_of_all *out)
{
    size_t corners = (size_t) f->corners;
    long long site[3];
    int at[3] = { 0 };
    for (size_t e = 0; e < f->n * corners; e++) {
        if (f->coarse.function[e] < 0) continue;
        function_of_all *o = &out[f->coarse.function[e]];
        o->key = (int64_t) f->ranks->label[e];
        o->touched |= f->part->owned[e / corners];
    }
    for (size_t h = 0; h < f->grid.nvertex; h++) {
        int64_t stride = 1, vertex = 0;
        level_vertex_place (f, h, at);
        for (int k = 0; k < f->dim; k++) {
            long long v = (long long) round ((f->grid.low[k] - f->origin[k]) / f->grid.step[k]) + at[k];
            vertex += v * stride, stride *= f->ranks->sites[k] / f->grid.share_of[k] + 2;
        }
        for (size_t p = f->coarse.first[h]; p < f->coarse.first[h + 1]; p++) {
            place_of (f->ranks, out[p].key / f->corners, site);
            out[p].owner = owner_of (f->ranks, f->dim, site), out[p].vertex = vertex;
            for (int k = 0; k < f->dim; k++) out[p].place[k] = f->grid.low[k] + at[k] * f->grid.step[k];
        }
    }
}

/* ---- functions that other ranks own -------------------------------------------------------------------- */
/* A function held here: its number over all ranks (key) and its index here. */
typedef struct { int64_t key; int function; } named;

static int by_key (const void *a, const void *b)
{
    const named *x = a, *y = b;
    return (x->key > y->key) - (x->key < y->key);
}

/* Shares the requests of all ranks for functions that other ranks own: three numbers each, the rank that
 * asks, the owner, the number of the function. */
static pg_status ask (const function_of_all *f, size_t n, size_t *n_all, double **all)
{
    pg_status status = PG_OK;
    double *mine = NULL;
    size_t count = 0;
    PG_ALLOC (mine, 3 * n);
    for (size_t p = 0; p < n; p++) {
        if (f[p].owner == pg_rank ()) continue;
        mine[3 * count] = pg_rank (), mine[3 * count + 1] = f[p].owner;
        mine[3 * count++ + 2] = (double) f[p].key;
    }
    PG_TRY (pg_ranks_share (3 * count, mine, n_all, all));
    *n_all /= 3;
done:
    pg_free (mine);
    return status;
}

/* Fills in the neighbours of the halo, ascending: ranks that ask this one or that it asks, and where their
 * lists begin. at (2 size): where the list of each rank begins in `send`, then in `receive`. */
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

/* Makes the halo: functions that each neighbour asks for are sent to it, those asked from it received. */
static pg_status make_halo (pg_halo *h, const named *list, size_t n, size_t n_all, const double *all)
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
        if (asked != me && asks != me) continue;
        named one = { (int64_t) all[3 * e + 2], 0 };
        const named *p = pg_search (&one, list, n, sizeof *list, by_key);
        if (!p) lost = 1;
        if (asked == me) h->send[at[asks]++] = p ? p->function : 0;
        if (asks == me) h->receive[at[(int) size + asked]++] = p ? p->function : 0;
    }
    PG_TRY (pg_ranks_most (1, &lost));
    if (lost > 0) PG_FAIL (PG_E_FILE, "ranks disagree about their coarse functions");
done:
    pg_free (at);
    return status;
}

/* Makes the subdomain of the coarse level: which functions this rank owns, and the halo. */
static pg_status divide (level *c, const function_of_all *f)
{
    pg_status status = PG_OK;
    named *list = NULL;
    double *asked = NULL;
    size_t n = 0;
    PG_ALLOC (c->made, 1);
    PG_ALLOC (c->made->owned, c->n);
    PG_ALLOC (list, c->n);
    c->made->n = c->n;
    for (size_t p = 0; p < c->n; p++) {
        c->made->owned[p] = f[p].owner == pg_rank ();
        c->made->nowned += c->made->owned[p];
        list[p] = (named) { f[p].key, (int) p };
    }
    if (c->n) pg_sort (list, c->n, sizeof *list, by_key);
    PG_TRY (ask (f, c->n, &n, &asked));
    PG_TRY (make_halo (&c->made->halo, list, c->n, n, asked));
    c->part = c->made;
done:
    pg_free (list), pg_free (asked);
    return status;
}

/* ---- the levels below ---------------------------------------------------------------------------------- */
/* Functions may be sums of others, where a crack leaves few nodes under them: the matrix is then singular,
 * so that this share of its diagonal is added, as in coarsest_matrix. */
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

/* Makes the levels below by the preconditioner that all ranks build together. */
static pg_status pass_on (pg_multilevel *m, const function_of_all *f)
{
    pg_status status = PG_OK;
    level *l = &m->meet;
    PG_TRY (divide (l, f));
    pg_shared_rows s = { .dim = l->dim, .block = l->block, .x = l->x, .subdomain = l->part, .k = 1, .sums = 1,
                         .rows = { .context = l, .widest = l->rows.widest, .row = row_of } };
    for (int k = 0; k < l->dim; k++) {
        s.rows.lattice[k] = l->rows.lattice[k];
        s.rows.reach = fmax (s.rows.reach, l->reach[k]);
    }
    size_t send = l->part->halo.send_first[l->part->halo.n];
    PG_ALLOC (m->slot, send);
    for (size_t k = 0; k < send; k++) m->slot[k] = (int) (l->n + k);
    PG_ALLOC (m->total, (l->n + send) * (size_t) l->block);
    m->below = pg_shared_preconditioner_now ();
    if (!m->below) PG_FAIL (PG_E_USAGE, "ranks share no preconditioner");
    PG_TRY (m->below->create (&m->shared, &s));
done:
    return status;
}

/* Every rank has the coarse levels in full if they cost it at most this share of the work on the nodes that
 * it owns, or if they have at most FEW unknowns. */
static const double share_of_work = 0.3;
enum { FEW = 1000 };

pg_status multilevel_meet (pg_multilevel *m, const level *l)
{
    pg_status status = PG_OK;
    level *c = &m->meet;
    function_of_all *held = NULL;
    double count[2] = { 0, (double) (l->part->nowned * (size_t) l->block) };
    PG_ALLOC (held, c->n);
    number_functions (l, held);
    pg_free (l->ranks->label), pg_free (l->ranks->from);
    l->ranks->label = NULL, l->ranks->from = NULL;
    for (size_t p = 0; p < c->n; p++) count[0] += held[p].owner == pg_rank () ? c->block : 0;
    PG_TRY (pg_ranks_sum (2, count));
    m->unknowns = count[1];
    if (count[0] <= FEW || count[0] * pg_rank_count () <= share_of_work * count[1])
        PG_TRY (multilevel_gather (m, held));
    else PG_TRY (pass_on (m, held));
    pg_free (c->start), pg_free (c->node), pg_free (c->value);
    c->start = NULL, c->node = NULL, c->value = NULL;
done:
    pg_free (held);
    return status;
}

/* Sums the right-hand side: owners of functions add the contributions of the other ranks. */
static pg_status add_up (pg_multilevel *m)
{
    pg_status status = PG_OK;
    level *c = &m->meet;
    const pg_halo *h = &c->part->halo;
    size_t block = (size_t) c->block;
    pg_subdomain back = { .halo = { .n = h->n, .rank = h->rank,
                                    .send_first = h->receive_first, .receive_first = h->send_first,
                                    .send = h->receive, .receive = m->slot } };
    memcpy (m->total, c->b, c->ndof * sizeof *c->b);
    PG_TRY (pg_subdomain_exchange (&back, block, m->total));
    for (size_t k = 0; k < h->send_first[h->n]; k++)
        for (size_t a = 0; a < block; a++)
            c->b[(size_t) h->send[k] * block + a] += m->total[(size_t) m->slot[k] * block + a];
done:
    return status;
}

pg_status multilevel_solve_together (pg_multilevel *m)
{
    pg_status status = PG_OK;
    level *c = &m->meet, *l = &m->at[1];
    size_t block = (size_t) c->block;
    if (m->shared) {
        PG_TRY (add_up (m));
        PG_TRY (m->below->solve (m->shared, c->b, c->z));
        PG_TRY (level_exchange (c, c->z));
        goto done;
    }
    memset (l->b, 0, l->ndof * sizeof *l->b);
    for (size_t p = 0; p < c->n; p++)
        memcpy (l->b + (size_t) m->whole[p] * block, c->b + p * block, block * sizeof *l->b);
    PG_TRY (pg_ranks_sum (l->ndof, l->b));
    PG_TRY (multilevel_cycle (m, 1, l->b, l->z));
    for (size_t p = 0; p < c->n; p++)
        memcpy (c->z + p * block, l->z + (size_t) m->whole[p] * block, block * sizeof *l->z);
done:
    return status;
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * Positions that are sampled repeatedly: those around the tip of a crack, for displacement, velocity and
 * acceleration, again and again while the tip runs along a facet. Their shape functions are kept, batch by
 * batch, and used again where a new evaluation would give the same bits. They follow from the positions, the
 * cracks and the intact bonds around them (galerkin_sample.c), so these are kept beside them and compared:
 *
 * a position x depends on the bonds of the nearest evaluation point and of the nearest node that no crack
 * hides from it, and on whether any bond of the nodes in its own support is broken,
 *
 * all within two horizons of x (a batch whose nearest points lie farther away is not kept), and the cracks
 * that decide on it lie within three. A batch is valid as long as nothing in its box, enlarged by that, has
 * changed; what happens elsewhere in the body costs a comparison of some ten thousand bytes. */
#include "mechanics/galerkin/weak_form/galerkin.h"
#include <math.h>
#include <string.h>

/* FEW: batches with fewer positions are not kept. BATCHES: most batches that are kept; a new one replaces the
 * one unused for longest. */
enum { FEW = 64, BATCHES = 64 };
/* Distances in horizons within which bonds (near_bonds) and cracks (near_cracks) influence a position. */
static const double near_bonds = 2, near_cracks = 3;
/* Doubles that all batches together may hold: 64 MB. */
static const size_t room = 8u << 20;

/* State that the shape functions of a batch follow from: intact flags of bonds, then the geometry of cracks,
 * as bytes. */
typedef struct { unsigned char *byte; size_t n, cap; } surroundings;

typedef struct {
    size_t n, nnear[2];
    double *x, low[2], high[2];                        /* positions, m (n x 2); their bounding box, m */
    size_t *near[2];                                  /* nodes (0) and evaluation points (1) around the box */
    surroundings around;
    pg_rows rows;
    size_t *at;                                        /* nearest evaluation point of each position (n) */
    long    used;                                      /* clock of its last use */
} batch;

struct galerkin_again { batch kept[BATCHES]; size_t n; long clock; surroundings now; };

static void clear_batch (batch *b)
{
    pg_free (b->x), pg_free (b->near[0]), pg_free (b->near[1]), pg_free (b->at), pg_free (b->around.byte);
    pg_rows_clear (&b->rows);
    *b = (batch) { 0 };
}

void galerkin_again_free (galerkin_again **again)
{
    galerkin_again *a = *again;
    if (!a) return;
    for (size_t k = 0; k < a->n; k++) clear_batch (&a->kept[k]);
    pg_free (a->now.byte), pg_free (a);
    *again = NULL;
}

/* Serves 2D bodies of uniform spacing only: in 3D the whole crack front changes in every event. */
int galerkin_again_serves (const galerkin *g, size_t n)
{
    const pg_problem *p = g->problem;
    return !p->plain && g->dim == 2 && !p->cloud.size && n >= FEW;
}

/* ---- surroundings of a batch --------------------------------------------------------------------------- */
/* Does the box of the batch, enlarged by `more` (m) on every side, hold x? */
static int within (const batch *b, const double *x, double more)
{
    return x[0] >= b->low[0] - more && x[0] <= b->high[0] + more && x[1] >= b->low[1] - more
           && x[1] <= b->high[1] + more;
}

/* Lists the nodes and evaluation points whose bonds influence the batch. */
static pg_status find_near (batch *b, const galerkin *g)
{
    pg_status status = PG_OK;
    const pg_rows *rows[2] = { &g->rows[PG_NODES], &g->rows[g->bulk] };
    double more = near_bonds * g->problem->form.approx.horizon;
    for (int s = 0; s < (g->bulk == PG_NODES ? 1 : 2); s++) {
        for (size_t i = 0; i < rows[s]->n; i++) b->nnear[s] += (size_t) within (b, rows[s]->x + 2*i, more);
        PG_ALLOC (b->near[s], b->nnear[s] + 1);
        b->nnear[s] = 0;
        for (size_t i = 0; i < rows[s]->n; i++)
            if (within (b, rows[s]->x + 2*i, more)) b->near[s][b->nnear[s]++] = i;
    }
done:
    return status;
}

static pg_status add (surroundings *s, size_t bytes, const void *data)
{
    pg_status status = PG_OK;
    PG_GROW (s->byte, s->cap, s->n + bytes);
    memcpy (s->byte + s->n, data, bytes), s->n += bytes;
done:
    return status;
}

/* Appends what decides which bonds a crack segment cuts: its vertices, by how much it is shortened at its
 * ends, its sides. */
static pg_status add_crack (surroundings *s, const pg_crack *c)
{
    pg_status status = PG_OK;
    double rest[] = { c->normal[0], c->normal[1], c->sided, c->width, (double) c->nvertex };
    PG_TRY (add (s, 2 * c->nvertex * sizeof *c->vertex, c->vertex));
    if (c->retreat) PG_TRY (add (s, c->nvertex * sizeof *c->retreat, c->retreat));
    PG_TRY (add (s, sizeof rest, rest));
done:
    return status;
}

/* Collects the present surroundings of a batch: bonds of the listed points, and cracks whose bounding box
 * meets the enlarged box of the batch. */
static pg_status look_around (surroundings *out, const batch *b, const galerkin *g, const pg_state *state)
{
    pg_status status = PG_OK;
    const pg_problem *p = g->problem;
    const pg_cracks *cracks = pg_state_cracks (p, state);
    double more = near_cracks * p->form.approx.horizon, box[4];
    int sets[2] = { PG_NODES, g->bulk };
    out->n = 0;
    for (int s = 0; s < 2; s++)
        for (size_t k = 0; k < b->nnear[s]; k++) {
            const size_t *start = g->rows[sets[s]].family.start + b->near[s][k];
            PG_TRY (add (out, start[1] - start[0], state->alive + p->bonds.first[sets[s]] + start[0]));
        }
    for (size_t k = 0; k < cracks->n; k++) {
        pg_crack_box (&cracks->crack[k], 2, box);
        if (box[0] <= b->high[0] + more && box[2] >= b->low[0] - more && box[1] <= b->high[1] + more
            && box[3] >= b->low[1] - more)
            PG_TRY (add_crack (out, &cracks->crack[k]));
    }
done:
    return status;
}

static int same (const surroundings *a, const surroundings *b)
{
    return a->n == b->n && (!a->n || memcmp (a->byte, b->byte, a->n) == 0);
}

/* ---- batches ------------------------------------------------------------------------------------------- */
static size_t numbers_of (const batch *b)
{
    return b->rows.family.start[b->n] * 4 + b->n * 8 + b->around.n / 8 + b->nnear[0] + b->nnear[1];
}

/* Removes batch k; the last of the list takes its place. */
static void drop (galerkin_again *a, size_t k)
{
    clear_batch (&a->kept[k]);
    a->kept[k] = a->kept[--a->n];
    a->kept[a->n] = (batch) { 0 };
}

/* Kept shape functions and nearest evaluation points of exactly these positions, owned by the force; *rows
 * NULL: none are kept, or they are out of date. */
pg_status galerkin_again_find (galerkin *g, const pg_state *state, size_t n, const double *x,
                               const pg_rows **rows, size_t **at)
{
    pg_status status = PG_OK;
    galerkin_again *a = g->places.again;
    *rows = NULL;
    for (size_t k = 0; a && k < a->n; k++) {
        batch *b = &a->kept[k];
        if (b->n != n || memcmp (b->x, x, 2 * n * sizeof *x) != 0) continue;
        PG_TRY (look_around (&a->now, b, g, state));
        if (!same (&a->now, &b->around)) {
            drop (a, k);
            break;
        }
        b->used = ++a->clock;
        *rows = &b->rows, *at = b->at;
        break;
    }
done:
    return status;
}

static void make_room (galerkin_again *a)
{
    for (;;) {
        size_t sum = 0, oldest = 0;
        for (size_t k = 0; k < a->n; k++) {
            sum += numbers_of (&a->kept[k]);
            if (a->kept[k].used < a->kept[oldest].used) oldest = k;
        }
        if (a->n == 0 || (a->n < BATCHES && sum <= room)) return;
        drop (a, oldest);
    }
}

/* Are the nearest evaluation points of all positions within `near_bonds` horizons, so that the batch may be
 * kept? */
static int asks_near (const galerkin *g, size_t n, const double *x, const size_t *at)
{
    double reach = near_bonds * g->problem->form.approx.horizon;
    for (size_t i = 0; i < n; i++) {
        const double *q = g->rows[g->bulk].x + 2 * at[i];
        if (!(hypot (q[0] - x[2*i], q[1] - x[2*i + 1]) < reach)) return 0;
    }
    return 1;
}

/* Keeps shape functions and nearest points of n positions: takes over *rows and *at, which are empty
 * afterwards. */
pg_status galerkin_again_keep (galerkin *g, const pg_state *state, size_t n, const double *x, pg_rows *rows,
                               size_t **at)
{
    pg_status status = PG_OK;
    batch b = { .n = n, .low = { INFINITY, INFINITY }, .high = { -INFINITY, -INFINITY } };
    if (!asks_near (g, n, x, *at)) return PG_OK;
    if (!g->places.again) PG_ALLOC (g->places.again, 1);
    make_room (g->places.again);
    PG_ALLOC (b.x, 2 * n);
    memcpy (b.x, x, 2 * n * sizeof *x);
    for (size_t i = 0; i < 2 * n; i++)
        b.low[i % 2] = fmin (b.low[i % 2], x[i]), b.high[i % 2] = fmax (b.high[i % 2], x[i]);
    PG_TRY (find_near (&b, g));
    PG_TRY (look_around (&b.around, &b, g, state));
    b.rows = *rows, b.at = *at, b.used = ++g->places.again->clock;
    *rows = (pg_rows) { 0 }, *at = NULL;
    g->places.again->kept[g->places.again->n++] = b;
    b = (batch) { 0 };
done:
    clear_batch (&b);
    return status;
}

int galerkin_again_served (const galerkin *g)
{
    return g->places.again
           && g->places.again->clock > (long) g->places.again->n;
}

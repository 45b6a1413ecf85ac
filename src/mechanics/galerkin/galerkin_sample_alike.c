/* SPDX-License-Identifier: GPL-3.0-or-later
 * Sampling at positions of a lattice whose surroundings are equal, without families of their own.
 *
 * The norms of an error need a field at all Gauss points of all cells. On a lattice the same few positions
 * recur in cell after cell: the support of a position follows from where it lies in its cell, and from which
 * vertices around the cell are points, of which volumes. Both are keys:
 *
 *   1. The pattern of a cell: volumes of the vertices within reach of any position in it, a block of about
 *      2 horizon / step vertices along each axis; 0: there is no point.
 *   2. The position in the cell in fractions of its steps, to 2^-40: what the shape functions of lattices
 *      are rounded to (discretization/approx/congruent.h).
 *
 * The first position of a pair of keys is evaluated like any other one; its N and dN are kept, spread over
 * the block with zeros where there is no neighbour. All others are products of these rows with the nodal
 * values of the block, which are gathered once a cell: no search, no moment matrix, no list of nodes. Sums
 * run over the block eight lanes at a time in the same order in every instruction set and on any number of
 * threads.
 *
 * Which positions come first, and for how many rows there is room, changes the last bits of a value. Rows
 * are therefore kept only as long as the same field is sampled: the output of a step must not depend on what
 * was sampled before, which differs in a resumed run. */
#include "mechanics/galerkin/weak_form/galerkin.h"
#include <math.h>
#include <stdint.h>
#include <string.h>

/* PATTERNS, KEPT: most patterns and rows that are kept. FEW: number of rows from which on no more are kept if
 * most positions are unlike any other. LANES: of a vector. MOST_BLOCK: most vertices of a block. */
enum { PATTERNS = 1024, KEPT = 16384, FEW = 2048, LANES = 8, MOST_BLOCK = 1024 };
/* Doubles that kept rows and patterns may hold at most: 64 MB. */
static const size_t room = 8u << 20;
/* Fractions of a step are rounded to 1 / finest before they are compared. */
static const double finest = 0x1p40;

/* Key of a position: fractions of a cell (units of 2^-40), and the pattern of that cell. used: 1: its rows
 * are known, -1: they cannot serve other positions, 0: not evaluated yet. */
typedef struct { double part[3]; size_t pattern; int used; } key;

struct galerkin_alike {
    int      dim;
    double   low[3], inverse[3];                       /* of the lattice: lower corner, m; 1 / step, 1/m */
    const pg_between *between;                   /* bodies or gaps that separate points; NULL: nothing does */
    /* Along each axis: vertices of the padded lattice; first vertex of a block relative to its cell, and
     * number of vertices of a block. */
    long     count[3], first[3], width[3];
    int     *node;                                   /* node at each vertex of the padded lattice; -1: none */
    /* vertices of a block; the same rounded up to lanes; offsets of the vertices */
    size_t   block, lanes, *offset;
    size_t   npattern, nkey, cap;
    double  *pattern;                                  /* block numbers each */
    int     *at_pattern, *at_key;                      /* tables by hash; 0: empty, else number + 1 */
    key     *key;
    double  *rows;                                    /* for each key (1 + dim) x lanes: N, then dN by axes */
    size_t   asked;                                    /* positions sorted so far */
    uint64_t field;                                    /* fingerprint of the field that is sampled */
};

/* ---- the lattice -------------------------------------------------------------------------------------- */
/* Vertex of the lattice along an axis, and how far away from it a coordinate is, in steps. */
static long vertex_of (const galerkin_alike *a, int axis, double x, double *away)
{
    double at = (x - a->low[axis]) * a->inverse[axis], whole = floor (at + 0.5);
    *away = at - whole;
    return (long) whole;
}

/* Lays the padded lattice over the points. Returns 0 if they form no lattice, or one that is mostly empty. */
static int lay (galerkin_alike *a, const pg_problem *p)
{
    double boxes = 1, most = 64 * (double) p->cloud.n + 4096;
    a->dim = p->dim, a->block = 1, a->between = p->cloud.between;
    for (int k = 0; k < 3; k++) a->count[k] = a->width[k] = 1, a->first[k] = 0;
    for (int k = 0; k < a->dim; k++) {
        double step = p->cloud.step[k], reach = p->form.approx.horizon / step * (1 + 1e-7), away;
        if (!(step > 0) || !(reach < 64)) return 0;
        a->low[k] = p->cloud.low[k], a->inverse[k] = 1 / step;
        /* A position at fraction 0 <= f < 1 has the support f - reach to f + reach, including its ends for
         * closed kernels. */
        long ends = p->form.approx.kernel->closed ? (long) ceil (reach) + 1 : (long) ceil (reach - 1e-6);
        a->first[k] = 1 - ends, a->width[k] = 2 * ends;
        a->count[k] = vertex_of (a, k, p->cloud.high[k], &away) + 1 + 2 * (a->width[k] + 1);
        boxes *= (double) a->count[k];
        a->block *= (size_t) a->width[k];
    }
    a->lanes = (a->block + LANES - 1) / LANES * LANES;
    return boxes <= most && a->block <= MOST_BLOCK;
}

/* Number of the vertex (i, j, k) of the lattice in the padded one. */
static size_t number_of (const galerkin_alike *a, const long *at)
{
    size_t number = 0;
    for (int k = a->dim - 1; k >= 0; k--)
        number = number * (size_t) a->count[k] + (size_t) (at[k] + a->width[k] + 1);
    return number;
}

/* Enters the number of each point at its vertex. Returns 0 if a point lies away from all vertices. */
static int place_nodes (galerkin_alike *a, const pg_problem *p)
{
    size_t dim = (size_t) a->dim;
    for (size_t i = 0; i < p->cloud.n; i++) {
        long at[3];
        double away = 0, worst = 0;
        for (size_t k = 0; k < dim; k++) {
            at[k] = vertex_of (a, (int) k, p->cloud.x[i * dim + k], &away);
            worst = fmax (worst, fabs (away));
        }
        if (worst > 1e-6) return 0;
        a->node[number_of (a, at)] = (int) i;
    }
    return 1;
}

/* Offsets from the first vertex of a block to all its vertices, x fastest: ascending as nodes are. */
static void lay_block (galerkin_alike *a)
{
    size_t e = 0, along_y = (size_t) a->count[0], along_z = along_y * (size_t) a->count[1];
    for (long z = 0; z < a->width[2]; z++)
        for (long y = 0; y < a->width[1]; y++)
            for (long x = 0; x < a->width[0]; x++)
                a->offset[e++] = (size_t) x + (size_t) y * along_y + (size_t) z * along_z;
}

void galerkin_alike_free (galerkin_alike **alike)
{
    galerkin_alike *a = *alike;
    if (!a) return;
    pg_free (a->node), pg_free (a->offset), pg_free (a->pattern), pg_free (a->at_pattern),
        pg_free (a->at_key), pg_free (a->key), pg_free (a->rows);
    pg_free (a);
    *alike = NULL;
}

/* *out stays NULL where positions cannot share rows: pg_approx.congruent is 0, points are graded or no
 * complete lattice, or the approximation expands about nodes. */
pg_status galerkin_alike_create (galerkin_alike **out, const pg_problem *p)
{
    pg_status status = PG_OK;
    galerkin_alike *a = NULL;
    size_t vertices = 1;
    if (!p->form.approx.congruent || p->cloud.size || p->form.approx.type->interpolates) return PG_OK;
    PG_ALLOC (a, 1);
    if (!lay (a, p)) goto done;
    for (int k = 0; k < a->dim; k++) vertices *= (size_t) a->count[k];
    PG_ALLOC (a->node, vertices);
    for (size_t i = 0; i < vertices; i++) a->node[i] = -1;
    if (!place_nodes (a, p)) goto done;
    PG_ALLOC (a->offset, a->block);
    lay_block (a);
    PG_ALLOC (a->pattern, PATTERNS * a->block);
    PG_ALLOC (a->at_pattern, 2 * PATTERNS);
    PG_ALLOC (a->at_key, 2 * KEPT);
    PG_ALLOC (a->key, KEPT);
    *out = a, a = NULL;
done:
    galerkin_alike_free (&a);
    return status;
}

/* ---- keys ---------------------------------------------------------------------------------------------- */
/* Announces that the field d (ndof) is sampled next. If it differs from the last one, all kept rows are
 * dropped. */
void galerkin_alike_begin (galerkin_alike *a, size_t ndof, const double *d)
{
    uint64_t field = pg_fingerprint_numbers (ndof, ndof, 1, d);
    if (field == a->field) return;
    a->field = field;
    if (a->asked == 0) return;
    a->npattern = a->nkey = a->asked = 0;
    memset (a->at_pattern, 0, 2 * PATTERNS * sizeof *a->at_pattern);
    memset (a->at_key, 0, 2 * KEPT * sizeof *a->at_key);
    if (a->rows) memset (a->rows, 0, a->cap * (size_t) (1 + a->dim) * a->lanes * sizeof *a->rows);
}

/* Finds the cell that position x lies in: number of the first vertex of its block, and position in the cell
 * (part). Returns 0 if x is so far outside that the padded lattice does not hold the block. */
static int cell_of (const galerkin_alike *a, const double *x, size_t *first, double *part)
{
    long at[3];
    for (int k = 0; k < a->dim; k++) {
        double t = (x[k] - a->low[k]) * a->inverse[k], cell = floor (t + 1e-9);
        if (!(cell >= -1) || !(cell < (double) (a->count[k] - 2 * a->width[k] - 1))) return 0;
        at[k] = (long) cell + a->first[k], part[k] = round ((t - cell) * finest) + 0.0;   /* no -0 */
    }
    for (int k = a->dim; k < 3; k++) part[k] = 0;
    *first = number_of (a, at);
    return 1;
}

/* Number of the pattern of the block that begins at vertex `first`, entered if it is new; PATTERNS: there are
 * too many. */
static size_t pattern_of (galerkin_alike *a, const double *volume, size_t first)
{
    double seen[MOST_BLOCK], *own = a->pattern + a->npattern * a->block;
    for (size_t e = 0; e < a->block; e++) {
        int j = a->node[first + a->offset[e]];
        seen[e] = j < 0 ? 0 : volume[j];
    }
    size_t slot = pg_fingerprint_numbers (0, a->block, 1, seen) % (2 * PATTERNS);
    for (; a->at_pattern[slot]; slot = (slot + 1) % (2 * PATTERNS)) {
        size_t known = (size_t) a->at_pattern[slot] - 1;
        if (memcmp (a->pattern + known * a->block, seen, a->block * sizeof *seen) == 0) return known;
    }
    if (a->npattern == PATTERNS) return PATTERNS;
    memcpy (own, seen, a->block * sizeof *seen);
    a->at_pattern[slot] = (int) ++a->npattern;
    return a->npattern - 1;
}

/* May a slot or gap separate points of the block about the cell of x? Then the support of a position does not
 * follow from the positions of points alone. */
static int may_be_parted (const galerkin_alike *a, const double *x)
{
    double low[3], high[3];
    pg_outlook seen;
    if (!a->between) return 0;
    for (int k = 0; k < a->dim; k++) {
        double wide = (double) a->width[k] / a->inverse[k];
        low[k] = x[k] - wide, high[k] = x[k] + wide;
    }
    return pg_between_look (a->between, low, high, &seen);
}

/* Number of a key, entered if it is new; KEPT: no more keys are entered. */
static size_t key_of (galerkin_alike *a, const key *wanted)
{
    size_t slot = pg_fingerprint_numbers (wanted->pattern, 3, 1, wanted->part) % (2 * KEPT);
    for (; a->at_key[slot]; slot = (slot + 1) % (2 * KEPT)) {
        const key *known = &a->key[a->at_key[slot] - 1];
        if (known->pattern == wanted->pattern
            && memcmp (known->part, wanted->part, sizeof known->part) == 0)
            return (size_t) a->at_key[slot] - 1;
    }
    size_t numbers = (a->nkey + 1) * (size_t) (1 + a->dim) * a->lanes;
    if (a->nkey == KEPT || numbers > room || (a->nkey > FEW && 2 * a->nkey > a->asked)) return KEPT;
    a->key[a->nkey] = *wanted;
    a->at_key[slot] = (int) ++a->nkey;
    return a->nkey - 1;
}

/* Makes room for the rows of all keys entered so far. */
static pg_status grow (galerkin_alike *a)
{
    pg_status status = PG_OK;
    size_t each = (size_t) (1 + a->dim) * a->lanes;
    if (a->nkey <= a->cap) return PG_OK;
    size_t cap = a->nkey < 64 ? 64 : 2 * a->nkey;
    double *rows = pg_resize (a->rows, cap * each, sizeof *rows);
    if (!rows) PG_FAIL (PG_E_MEMORY, "no memory for the shape functions of places that are alike");
    a->rows = rows, a->cap = cap;
done:
    return status;
}

/* which (n): the kept row that each position can use; -1: none, as no other position is like it, or as it is
 * the first of its kind. The latter positions are listed in `rest`, and `leaves` has the key for which their
 * rows are to be kept (-1: none). */
pg_status galerkin_alike_sort (galerkin_alike *a, const double *volume, size_t n, const double *x,
                               int *which, size_t *rest, int *leaves, size_t *nrest)
{
    size_t last = SIZE_MAX, of_last = PATTERNS, known = a->nkey;
    *nrest = 0;
    for (size_t p = 0; p < n; p++) {
        key k = { .used = 0 };
        size_t first, at = KEPT;
        a->asked++;
        if (cell_of (a, x + p * (size_t) a->dim, &first, k.part)) {
            const double *place = x + p * (size_t) a->dim;
            if (first != last) of_last = may_be_parted (a, place) ? PATTERNS : pattern_of (a, volume, first);
            last = first;
            k.pattern = of_last;
            if (of_last < PATTERNS) at = key_of (a, &k);
        }
        which[p] = at < KEPT ? (int) at : -1;
        if (at < known) continue;
        rest[*nrest] = p, leaves[(*nrest)++] = which[p], which[p] = -1;
        if (at < KEPT) known = at + 1;
    }
    return grow (a);
}

/* ---- rows ---------------------------------------------------------------------------------------------- */
/* Stores row `at` of r, of a position x, spread over the block of key k. If a node lies outside the block, or
 * the basis is not full, the row is marked as unusable for others. */
void galerkin_alike_keep (galerkin_alike *a, int k, const pg_rows *r, size_t at, const double *x)
{
    size_t first, dim = (size_t) a->dim, e = r->family.start[at], last = r->family.start[at + 1];
    double part[3];
    double *rows = a->rows + (size_t) k * (1 + dim) * a->lanes;
    a->key[k].used = -1;
    if (r->grade[at] != PG_GRADE_FULL || !cell_of (a, x, &first, part)) return;
    for (size_t b = 0; b < a->block && e < last; b++) {
        if (a->node[first + a->offset[b]] != r->family.node[e]) continue;
        rows[b] = r->N[e];
        for (size_t c = 0; c < dim; c++) rows[(1 + c) * a->lanes + b] = r->dN[e * dim + c];
        e++;
    }
    if (e == last) a->key[k].used = 1;
}

int galerkin_alike_good (const galerkin_alike *a, int k) { return a->key[k].used > 0; }

/* Sum of a vector's lanes, in pairs. */
static inline double total (const eight *s)
{
    return (((*s)[0] + (*s)[1]) + ((*s)[2] + (*s)[3])) + (((*s)[4] + (*s)[5]) + ((*s)[6] + (*s)[7]));
}

/* out[r * dim + c] = row r of the shape functions times component c of the block's values: r = 0 gives the
 * displacement, r > 0 its derivatives along the axes. */
static inline __attribute__ ((always_inline)) void multiply_rows (size_t dim, size_t lanes,
                                                                  const double *rows, const double *value,
                                                                  double *out)
{
    for (size_t c = 0; c < dim; c++) {
        eight s[4] = { { 0 } };
        for (size_t b = 0; b < lanes; b += LANES) {
            eight v = *(const eight *) (value + c * lanes + b);
            for (size_t r = 0; r <= dim; r++) s[r] += *(const eight *) (rows + r * lanes + b) * v;
        }
        for (size_t r = 0; r <= dim; r++) out[r * dim + c] = total (&s[r]);
    }
}

PG_WIDEST static void multiply_solid (size_t lanes, const double *rows, const double *value, double *out)
{
    multiply_rows (3, lanes, rows, value, out);
}

PG_WIDEST static void multiply_plane (size_t lanes, const double *rows, const double *value, double *out)
{
    multiply_rows (2, lanes, rows, value, out);
}

/* Values of the nodes of a block, component by component; 0 where there is no node. */
static void gather (const galerkin_alike *a, size_t first, const double *d, double *value)
{
    size_t dim = (size_t) a->dim;
    memset (value, 0, dim * a->lanes * sizeof *value);
    for (size_t b = 0; b < a->block; b++) {
        int j = a->node[first + a->offset[b]];
        for (size_t c = 0; c < dim && j >= 0; c++) value[c * a->lanes + b] = d[(size_t) j * dim + c];
    }
}

/* Displacement u and its gradient H[c * dim + k] = du_c/dx_k at a position x of key k. value: scratch of the
 * thread with the nodal values of the block that begins at vertex *held. */
void galerkin_alike_values (const galerkin_alike *a, int k, const double *x, const double *d, double *value,
                            size_t *held, double *u, double *H)
{
    size_t first, dim = (size_t) a->dim;
    const double *rows = a->rows + (size_t) k * (1 + dim) * a->lanes;
    double out[12], part[3];
    if (!cell_of (a, x, &first, part)) return;
    if (first != *held) gather (a, first, d, value), *held = first;
    if (dim == 3) multiply_solid (a->lanes, rows, value, out);
    else if (dim == 2) multiply_plane (a->lanes, rows, value, out);
    else multiply_rows (1, a->lanes, rows, value, out);
    for (size_t c = 0; c < 3; c++) u[c] = c < dim ? out[c] : 0;
    memset (H, 0, 9 * sizeof *H);
    for (size_t c = 0; c < dim; c++) for (size_t l = 0; l < dim; l++) H[c * dim + l] = out[(1 + l) * dim + c];
}

size_t galerkin_alike_scratch (const galerkin_alike *a) { return (size_t) a->dim * a->lanes; }

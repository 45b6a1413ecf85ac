/* SPDX-License-Identifier: GPL-3.0-or-later
 * Rows of shape functions: N, dN and w of every node and evaluation point, evaluated anew where bonds break.
 *
 * On a lattice almost all points have the same row as some other one, bit by bit, as bonds are rounded
 * before anything is computed of them (discretization/approx/congruent.h). A block of 993 000 unknowns has
 * 93 million bonds, 40 bytes each, but some thousand different rows. Different rows are therefore stored
 * once, with the number of points that use each, and for each point only where its row begins (pg_rows.at):
 * loops over all points find them in the caches. New rows are evaluated in a buffer first; an equal stored
 * one is searched by a fingerprint and compared bit by bit. A row that no point uses any more is reused for
 * the next one with as many bonds. No result changes: what is shared is what would have been stored. Where
 * rows are corrected after they have been evaluated (consistent integration, stabilisation), of irregular
 * points, of facets, and in runs without shortcuts (pg_problem.plain) each point has a row of its own.
 *
 * The patch test evaluates the rows of the intact body before a run begins, on the bare problem, which
 * shares nodes and evaluation points with the run's own (pg_problem_bare). If no bond is going to break it
 * asks for them to be kept (pg_problem.intact), and its force leaves them to the problem when it is freed;
 * where it has assembled K, and the material is that of the run, the part of the evaluation points as well.
 * Forces of the run use these rows, which are bit by bit what they would compute. Should a bond break after
 * all, they return them, and evaluate their own. */
#include "galerkin.h"
#include <string.h>

/* PART: points that are evaluated at a time. PRINTS: numbers of a row that enter its fingerprint. */
enum { PART = 16384, PRINTS = 12 };

/* A stored row: its first bond in the list, their number, how many points use it, its fingerprint; number of
 * the next row of its chain + 1. */
typedef struct { size_t at, bonds, readers; uint64_t print; int next; } kept_row;

/* Storage of different rows; rows are referred to by their number + 1; 0: none. */
struct galerkin_store {
    kept_row *row;  size_t n, cap;
    size_t   bonds, cap_N, cap_dN, cap_w;          /* bonds of all stored rows; capacities for their values */
    int     *of;                                       /* number of the row of each point */
    /* first row of each chain, by fingerprint; number of chains, a power of 2 */
    int     *chain;  size_t chains;
    int     *vacant;                                   /* unused rows, chained, by number of bonds */
    size_t   most;                                     /* most bonds of a point */
};

/* Are all bonds of a set intact? */
static int all_alive (const galerkin *g, int set, const pg_state *state)
{
    const pg_family *f = &g->rows[set].family;
    size_t bonds = f->start[f->n];
    return !bonds || !memchr (state->alive + g->problem->bonds.first[set], 0, bonds);
}

/* Updates g->sums where it refers to the rows of the bulk set. */
static void follow (galerkin *g)
{
    if (g->problem->form.consistency) g->sums.grade = g->rows[g->bulk].grade;
    else g->sums = g->rows[g->bulk];
}

/* ---- rows that are kept once --------------------------------------------------------------------------- */
static void store_free (galerkin_store **store)
{
    galerkin_store *s = *store;
    if (s) pg_free (s->row), pg_free (s->of), pg_free (s->chain), pg_free (s->vacant);
    pg_free (s);
    *store = NULL;
}

static pg_status store_create (galerkin_store **out, const pg_family *f)
{
    pg_status status = PG_OK;
    galerkin_store *s = NULL;
    PG_ALLOC (s, 1);
    for (size_t i = 0; i < f->n; i++)
        if (f->start[i + 1] - f->start[i] > s->most) s->most = f->start[i + 1] - f->start[i];
    for (s->chains = 256; s->chains < f->n; ) s->chains *= 2;
    PG_ALLOC (s->of, f->n);
    PG_ALLOC (s->chain, s->chains);
    PG_ALLOC (s->vacant, s->most + 1);
    *out = s, s = NULL;
done:
    store_free (&s);
    return status;
}

/* The stored row that equals row p of `from`; 0: there is none. */
static int find_row (const galerkin_store *s, const pg_rows *r, const pg_rows *from, size_t p, uint64_t print)
{
    size_t dim = (size_t) r->dim, m = r->family.start[p + 1] - r->family.start[p], at = from->at[p];
    int k = s->chain[print & (s->chains - 1)];
    for (; k; k = s->row[k - 1].next) {
        const kept_row *q = &s->row[k - 1];
        if (q->print == print && q->bonds == m
            && memcmp (r->dN + q->at * dim, from->dN + at * dim, m * dim * sizeof *r->dN) == 0
            && memcmp (r->N + q->at, from->N + at, m * sizeof *r->N) == 0
            && memcmp (r->w + q->at, from->w + at, m * sizeof *r->w) == 0)
            break;
    }
    return k;
}

/* Point p no longer uses its row; if no other point does, the row becomes free for reuse. */
static void leave_row (galerkin_store *s, size_t p)
{
    int k = s->of[p], *link;
    s->of[p] = 0;
    if (!k || --s->row[k - 1].readers) return;
    kept_row *q = &s->row[k - 1];
    link = &s->chain[q->print & (s->chains - 1)];
    while (*link != k) link = &s->row[*link - 1].next;
    *link = q->next;
    q->next = s->vacant[q->bonds], s->vacant[q->bonds] = k;
}

/* Finds a row for m bonds that no point uses: a free one, or a new one. */
static pg_status new_row (galerkin_store *s, pg_rows *r, size_t m, int *k)
{
    pg_status status = PG_OK;
    *k = s->vacant[m];
    if (*k) {
        s->vacant[m] = s->row[*k - 1].next;
        return PG_OK;
    }
    PG_GROW (r->N, s->cap_N, s->bonds + m);
    PG_GROW (r->dN, s->cap_dN, (s->bonds + m) * (size_t) r->dim);
    PG_GROW (r->w, s->cap_w, s->bonds + m);
    PG_GROW (s->row, s->cap, s->n + 1);
    s->row[s->n++] = (kept_row) { .at = s->bonds, .bonds = m };
    *k = (int) s->n, s->bonds += m;
done:
    return status;
}

/* Makes point p use the row that equals its values in `from`: a stored one, or a new one. */
static pg_status keep_row (galerkin_store *s, pg_rows *r, const pg_rows *from, size_t p)
{
    pg_status status = PG_OK;
    size_t dim = (size_t) r->dim, m = r->family.start[p + 1] - r->family.start[p], at = from->at[p];
    uint64_t print = pg_fingerprint_numbers (m, m * dim, m * dim / PRINTS + 1, from->dN + at * dim);
    int k = find_row (s, r, from, p, print);
    if (k) s->row[k - 1].readers++;
    leave_row (s, p);
    if (!k) {
        PG_TRY (new_row (s, r, m, &k));
        kept_row *q = &s->row[k - 1];
        int *chain = &s->chain[print & (s->chains - 1)];
        q->readers = 1, q->print = print, q->next = *chain, *chain = k;
        memcpy (r->N + q->at, from->N + at, m * sizeof *r->N);
        memcpy (r->dN + q->at * dim, from->dN + at * dim, m * dim * sizeof *r->dN);
        memcpy (r->w + q->at, from->w + at, m * sizeof *r->w);
    }
    s->of[p] = k, r->at[p] = s->row[k - 1].at;
done:
    return status;
}

/* ---- evaluation ---------------------------------------------------------------------------------------- */
static void forget_values (galerkin *g, int set)
{
    pg_rows *r = &g->rows[set];
    pg_free (r->N), pg_free (r->dN), pg_free (r->w), pg_free (r->at);
    r->N = r->dN = r->w = NULL, r->at = NULL;
    store_free (&g->store[set]);
}

/* Evaluates rows of a set, part by part, and stores equal ones once. */
static pg_status evaluate_shared (galerkin *g, const unsigned char *alive, int set, size_t count,
                                  const size_t *list)
{
    pg_status status = PG_OK;
    const pg_problem *p = g->problem;
    pg_rows *r = &g->rows[set], part;
    size_t some = count < PART ? count : PART, bonds, *number = NULL;
    double *value = NULL;
    if (!g->store[set]) {
        PG_TRY (store_create (&g->store[set], &r->family));
        PG_ALLOC (r->at, r->n);
    }
    bonds = some * g->store[set]->most;
    PG_ALLOC (value, bonds * (2 + (size_t) g->dim));
    PG_ALLOC (number, some);
    for (size_t first = 0; first < count; first += PART) {
        size_t n = count - first < PART ? count - first : PART, at = 0;
        part = *r, part.N = value, part.w = value + bonds, part.dN = part.w + bonds;
        for (size_t k = 0; k < n; k++) {
            size_t i = number[k] = list ? list[first + k] : first + k;
            r->at[i] = at, at += r->family.start[i + 1] - r->family.start[i];
        }
        PG_TRY (
            p->form.approx.type->evaluate (&p->form.approx, &p->cloud, &part, alive, n, number, g->threads));
        for (size_t k = 0; k < n; k++) PG_TRY (keep_row (g->store[set], r, &part, number[k]));
        r->copied = part.copied, r->copied_bonds = part.copied_bonds;
    }
done:
    pg_free (value), pg_free (number);
    return status;
}

/* Evaluates rows of a set, each stored at its own position. */
static pg_status evaluate_own (galerkin *g, const unsigned char *alive, int set, size_t count,
                               const size_t *list)
{
    pg_status status = PG_OK;
    const pg_problem *p = g->problem;
    pg_rows *r = &g->rows[set];
    size_t bonds = r->family.start[r->n];
    if (!r->N) PG_ALLOC (r->N, bonds);
    if (!r->dN) PG_ALLOC (r->dN, bonds * (size_t) g->dim);
    if (!r->w) PG_ALLOC (r->w, bonds);
    PG_TRY (p->form.approx.type->evaluate (&p->form.approx, &p->cloud, r, alive, count, list, g->threads));
done:
    return status;
}

pg_status galerkin_evaluate (galerkin *g, const pg_state *state, int set, size_t count, const size_t *list)
{
    pg_status status = PG_OK;
    const pg_problem *p = g->problem;
    const unsigned char *alive = state->alive + p->bonds.first[set];
    pg_rows *r = &g->rows[set];
    int shared = p->form.approx.congruent && !p->plain && !p->form.consistency && !(g->options->silling > 0)
                 && set != PG_FACETS;
    if (!r->N || !r->dN || !r->w) list = NULL;         /* no values are known yet: evaluate all */
    if (!list) count = r->n;
    if (!list && shared) forget_values (g, set);
    if (!r->grade) PG_ALLOC (r->grade, r->n);
    PG_TRY ((shared ? evaluate_shared : evaluate_own) (g, alive, set, count, list));
done:
    if (shared && status != PG_OK) forget_values (g, set);
    follow (g);
    return status;
}

/* ---- rows of the intact body --------------------------------------------------------------------------- */
/* Moves N, dN, w and grades from one struct to another; geometry and counts stay. */
static void move_values (pg_rows *to, pg_rows *from)
{
    to->N = from->N, to->dN = from->dN, to->w = from->w, to->at = from->at, to->grade = from->grade;
    to->copied = from->copied, to->copied_bonds = from->copied_bonds;
    from->N = from->dN = from->w = NULL, from->at = NULL, from->grade = NULL;
}

/* Leaves the rows of nodes and evaluation points to the problem, and K if wanted; not those of facets, as the
 * bare problem has other facets than the run. */
static void lend (galerkin *g)
{
    pg_intact *kept = g->problem->quality.intact;
    galerkin_stiffness *k = &g->stiffness;
    for (int set = PG_NODES; set <= PG_POINTS; set++) move_values (&kept->rows[set], &g->rows[set]);
    if (g->problem->form.consistency) move_values (&kept->sums, &g->sums), kept->sums.grade = NULL;
    if (kept->wanted < 2 || !k->K || k->all_stale || g->dilatation) return;
    kept->K = k->K, k->K = NULL;
    pg_assembly_settle (kept->K);
}

pg_status galerkin_rows_create (galerkin *g, int set)
{
    pg_status status = PG_OK;
    pg_rows *r = &g->rows[set];
    *r = g->problem->bonds.rows[set];
    r->N = r->dN = r->w = NULL, r->at = NULL, r->grade = NULL;
    g->borrows = g->problem->quality.intact && g->problem->quality.intact->rows[PG_NODES].N;
    if (g->borrows && set != PG_FACETS) {
        pg_rows values = g->problem->quality.intact->rows[set];
        move_values (r, &values);
    } else PG_ALLOC (r->grade, r->n);
done:
    return status;
}

void galerkin_rows_free (galerkin *g)
{
    const pg_intact *kept = g->problem->quality.intact;
    if (kept && kept->wanted && g->rows[PG_NODES].N) lend (g);
    for (int s = 0; s < PG_BOND_SETS; s++) {
        if (galerkin_borrows (g, s)) continue;
        forget_values (g, s);
        pg_free (g->rows[s].grade);
    }
}

int galerkin_borrows (const galerkin *g, int set) { return g->borrows && set != PG_FACETS; }

/* Takes the bulk's part of K from the problem. Of several forces on one problem one gets it, the others
 * assemble it themselves, with the same bits. */
pg_assembly *galerkin_take_stiffness (const galerkin *g)
{
    return g->borrows ? __atomic_exchange_n (&g->problem->quality.intact->K, NULL, __ATOMIC_ACQ_REL) : NULL;
}

int galerkin_give_back (galerkin *g, const pg_state *state)
{
    pg_rows none = { 0 };
    if (!g->borrows || (all_alive (g, PG_NODES, state) && all_alive (g, PG_POINTS, state))) return 0;
    for (int set = PG_NODES; set <= PG_POINTS; set++) move_values (&g->rows[set], &none);
    if (g->problem->form.consistency) g->sums.N = g->sums.dN = NULL;
    g->borrows = 0;
    return 1;
}

size_t galerkin_shared_bonds (const galerkin *g)
{
    size_t sum = 0;
    for (int s = 0; s < PG_BOND_SETS; s++)
        if (g->rows[s].at) sum += g->rows[s].family.start[g->rows[s].n];
    return sum;
}

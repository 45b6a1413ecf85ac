/* SPDX-License-Identifier: GPL-3.0-or-later
 * K of a linear system: the matrix or the product K x of the force, the first diagonal of K, the bonds at the
 * time of a factor, and what work with K costs. All costs are seconds by stored rates, from numbers of bonds,
 * points and unknowns (mechanics/model/solve_costs.c) and of operations; never measured, as a run must not
 * depend on the clock. */
#include "solve/run/solve.h"
#include <math.h>
#include <string.h>

/* 1: the force has a matrix. It may have one in general, yet none for the options of this problem:
 * dilatations reach neighbours of neighbours, and only their product with K is known. */
int system_has_matrix (const pg_system *s)
{
    if (system_is_shared (s)) return 0;  /* each rank has rows of its points, and products with them */
    return pg_force_matrix (s->force, s->self) != NULL;
}
const pg_sparse *system_basis (const pg_system *s)
{
    return s->force->basis ? s->force->basis (s->self) : NULL;
}

void system_reduce (const pg_system *s, const double *full, double *reduced)
{
    const pg_sparse *T = system_basis (s);
    if (T) pg_sparse_multiply_transposed (T, full, reduced);
    else memcpy (reduced, full, s->ndof * sizeof *full);
}

void system_expand (const pg_system *s, const double *x, double *full)
{
    const pg_sparse *T = system_basis (s);
    if (T) pg_sparse_multiply (T, x, full);
    else memcpy (full, x, s->ndof * sizeof *full);
}

const double *system_step (const pg_system *s, const double *x)
{
    if (!system_basis (s)) return x;
    system_expand (s, x, s->balance.full);
    return s->balance.full;
}

/* K as a product straight from the bonds; NULL: the force has none. */
const pg_operator *system_operator (const pg_system *s)
{
    return s->force->operator_ ? s->force->operator_ (s->self) : NULL;
}

/* y = K x: by the operator where there is one, which needs no assembly, else by the matrix. */
void system_multiply (const pg_system *s, const double *x, double *y)
{
    const pg_operator *op = system_operator (s);
    if (op && s->iterative.whole) system_multiply_shared (s, op, x, y);
    else if (op) op->apply (op->context, x, y);
    else pg_sparse_multiply (pg_force_matrix (s->force, s->self), x, y);
}

/* Mean of those entries of the first diagonal that are at most `most`, N/m; `most` infinite: the geometric
 * mean of all entries above zero. */
static double mean_of_diagonal (pg_system *s, double most)
{
    double sum = 0, number = 0;
    int logarithms = isinf (most);
    for (size_t j = 0; j < s->ndof; j++) {
        double k = s->direct.diagonal0[j];
        if (!pg_cloud_owns (&s->problem->cloud, j / (size_t) s->components) || k > most) continue;
        if (logarithms && !(k > 0)) continue;
        sum += logarithms ? log (k) : k, number++;
    }
    sum = system_sum (s, sum), number = system_sum (s, number);
    return number > 0 ? logarithms ? exp (sum / number) : sum / number : 0;
}

/* Stores the first diagonal and its mean, N/m: they tell which unknowns have become weak, and how large
 * forces of rounding are. Penalties on a few points, a million times as stiff, are not in the mean. */
void system_remember_diagonal (pg_system *s, const pg_sparse *K)
{
    system_factor *f = &s->direct;
    const double stiff = 1e3;
    const pg_operator *op = system_operator (s);
    if (f->mean_diagonal > 0) return;
    for (size_t j = 0; K && j < s->ndof; j++) f->diagonal0[j] = K->value[K->start[j + 1] - 1];
    if (!K) op->diagonal (op->context, f->diagonal0);
    f->mean_diagonal = mean_of_diagonal (s, stiff * mean_of_diagonal (s, INFINITY));
}

/* ---- what it is made of -------------------------------------------------------------------------------- */
/* Marks the nodes of points that lack a bond. Pre-cracks need this once: nodes weakened by later breaking are
 * found by the change of their diagonal, but the first K is already without the bonds across a pre-crack. */
void system_mark_touched (const pg_system *s, const unsigned char *bonds, unsigned char *touched)
{
    for (int set = 0; set < PG_BOND_SETS; set++) {
        const pg_family *f = &s->problem->bonds.rows[set].family;
        const unsigned char *alive = bonds + s->problem->bonds.first[set];
        for (size_t p = 0; p < f->n; p++) {
            if (!memchr (alive + f->start[p], 0, f->start[p + 1] - f->start[p])) continue;
            for (size_t e = f->start[p]; e < f->start[p + 1]; e++) touched[f->node[e]] = 1;
        }
    }
}

/* Copies cracks that grow; the copy has its own memory. */
pg_status system_copy_paths (const pg_system *s, pg_crack_paths **to, const pg_crack_paths *from)
{
    pg_status status = PG_OK;
    if (!from || !pg_problem_grows (s->problem)) return PG_OK;
    if (!*to) PG_TRY (pg_crack_paths_create (to, s->problem));
    PG_TRY (pg_crack_paths_copy (*to, from));
done:
    return status;
}

/* Copies the alive bits and the cracks when a factor or preconditioner is made: a resumed run makes the same
 * again from them, bit by bit. */
pg_status system_remember_alive (pg_system *s)
{
    system_factor *f = &s->direct;
    pg_status status = PG_OK;
    size_t nbond = s->problem->bonds.first[PG_BOND_SETS];
    if (!f->alive) return PG_OK;
    if (!f->factored) PG_ALLOC (f->factored, nbond);
    memcpy (f->factored, f->alive, nbond);
    PG_TRY (system_copy_paths (s, &f->factored_paths, f->paths));
done:
    return status;
}

/* ---- costs --------------------------------------------------------------------------------------------- */
/* Seconds of one product K x: visits of bonds times a stored rate, by stencil, list or shape functions. */
double system_apply_cost (const pg_system *s)
{
    const pg_problem *p = s->problem;
    if (p->sums) return (p->sums->stencil.n ? 0.6e-9 : 3e-9) * (double) p->bonds.first[PG_BOND_SETS];
    return pg_solve_apply_rate
           * (double) (p->bonds.first[PG_BOND_SETS]
                       - (p->form.integration->at_nodes ? 0 : p->bonds.first[PG_POINTS]));
}

double system_assembly_cost (const pg_system *s)
{
    pg_solve_counts c = pg_solve_count (s->problem);
    return pg_solve_assembly_cost (&c);
}

/* Seconds of assembly, analysis and factorization. */
double system_direct_cost (const pg_system *s)
{
    pg_solve_counts c = pg_solve_count (s->problem);
    return pg_solve_direct_cost (&c);
}

/* Seconds of a supernodal factorization. */
double system_factor_cost (const pg_system *s) { return s->report->linear.factor_flops / 20e9; }
/* Seconds of two triangular solves, each of which reads the factor twice over a refinement: four passes. */
double system_solve_cost (const pg_system *s) { return 4 * s->report->linear.factor_entries / 3e9; }

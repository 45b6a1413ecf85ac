/* SPDX-License-Identifier: GPL-3.0-or-later
 * Shape functions of the intact body, evaluated once. The patch test evaluates those of all nodes and
 * points of evaluation before a run begins, on the bare problem, which shares these sets with the run's
 * own (pg_problem_bare). As long as all bonds of a set are alive, a force on the problem itself would
 * evaluate the same rows from the same numbers to the same bits. It therefore reads those that the problem
 * keeps (pg_problem.intact), and makes rows of its own, copies at first, as soon as a bond of theirs is
 * broken. */
#include "galerkin.h"
#include <string.h>

/* Are all bonds of a set alive? */
static int all_alive (const galerkin *g, int set, const pg_state *state)
{
    const pg_family *f = &g->rows[set].family;
    size_t bonds = f->start[f->n];
    return !bonds || !memchr (state->alive + g->problem->first_bond[set], 0, bonds);
}

/* Moves N, dN, w and grades from one struct to another; geometry and counts stay. */
static void move_values (pg_rows *to, pg_rows *from)
{
    to->N = from->N, to->dN = from->dN, to->w = from->w, to->grade = from->grade;
    to->copied = from->copied, to->copied_bonds = from->copied_bonds;
    from->N = from->dN = from->w = NULL, from->grade = NULL;
}

/* Where sums are over the rows of the set itself they follow these. */
static void follow (galerkin *g)
{
    if (g->problem->consistency) g->sums.grade = g->rows[g->bulk].grade;
    else g->sums = g->rows[g->bulk];
}

/* Boundary facets of the bare problem are others than those of the run: only nodes and points are kept. */
pg_status galerkin_lend (void *self, const pg_state *state, pg_problem *problem)
{
    pg_status status = PG_OK;
    galerkin *g = self;
    pg_intact *kept = NULL;
    if (problem->intact || g->borrows[PG_NODES] || g->borrows[PG_POINTS]) return PG_OK;
    if (!all_alive (g, PG_NODES, state) || !all_alive (g, PG_POINTS, state)) return PG_OK;
    PG_ALLOC (kept, 1);
    for (int set = PG_NODES; set <= PG_POINTS; set++) move_values (&kept->rows[set], &g->rows[set]);
    if (g->problem->consistency) move_values (&kept->sums, &g->sums), kept->sums.grade = NULL;
    follow (g);
    problem->intact = kept;
done:
    return status;
}

int galerkin_borrow (galerkin *g, int set)
{
    const pg_intact *kept = g->problem->intact;
    if (!kept || set == PG_FACETS) return 0;
    pg_rows values = kept->rows[set];
    move_values (&g->rows[set], &values);
    return g->borrows[set] = 1;
}

int galerkin_borrow_sums (galerkin *g)
{
    if (!g->borrows[g->bulk]) return 0;
    g->sums.N = g->problem->intact->sums.N, g->sums.dN = g->problem->intact->sums.dN;
    return 1;
}

/* A copy of n numbers in place of the array that was borrowed. */
static pg_status copy_numbers (double **array, size_t n)
{
    pg_status status = PG_OK;
    double *own = NULL;
    PG_ALLOC (own, n);
    memcpy (own, *array, n * sizeof *own);
    *array = own;
done:
    return status;
}

/* On failure what is still borrowed is set to NULL, so that nobody frees what belongs to the problem. */
pg_status galerkin_own (galerkin *g, const pg_state *state, int set)
{
    pg_status status = PG_OK;
    pg_rows *r = &g->rows[set], lent = *r, wide = g->sums;
    size_t bonds, dim = (size_t) g->dim;
    unsigned char *grade;
    int sums = set == g->bulk && g->problem->consistency;
    if (!g->borrows[set] || all_alive (g, set, state)) return PG_OK;
    g->borrows[set] = 0, bonds = r->family.start[r->n];
    r->N = r->dN = r->w = NULL, r->grade = NULL;
    if (sums) g->sums.N = g->sums.dN = NULL;
    PG_TRY (copy_numbers (&lent.N, bonds));
    r->N = lent.N;
    PG_TRY (copy_numbers (&lent.dN, bonds * dim));
    r->dN = lent.dN;
    PG_TRY (copy_numbers (&lent.w, bonds));
    r->w = lent.w;
    PG_ALLOC (grade, r->n);
    memcpy (grade, lent.grade, r->n);
    r->grade = grade;
    bonds = g->sums.family.start[g->sums.n];
    if (sums) PG_TRY (copy_numbers (&wide.N, bonds));
    if (sums) g->sums.N = wide.N;
    if (sums) PG_TRY (copy_numbers (&wide.dN, bonds * dim));
    if (sums) g->sums.dN = wide.dN;
done:
    if (set == g->bulk) follow (g);
    return status;
}

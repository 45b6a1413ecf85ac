/* SPDX-License-Identifier: GPL-3.0-or-later
 * Shape functions of the intact body, evaluated once. The patch test evaluates those of all nodes and
 * points of evaluation before a run begins, on the bare problem, which shares these sets with the run's
 * own (pg_problem_bare). As long as all bonds of a set are alive, a force on the problem itself would
 * evaluate the same rows from the same numbers to the same bits. It therefore reads those that the problem
 * keeps (pg_problem.intact), and makes rows of its own, copies at first, as soon as a bond of theirs is
 * broken. Where the patch test has assembled K, and the material is that of the run, the part of the
 * evaluation points is kept as well. */
#include "galerkin.h"
#include <string.h>

/* Are all bonds of a set alive? */
int galerkin_all_alive (const galerkin *g, int set, const pg_state *state)
{
    const pg_family *f = &g->rows[set].family;
    size_t bonds = f->start[f->n];
    return !bonds || !memchr (state->alive + g->problem->first_bond[set], 0, bonds);
}

/* Moves N, dN, w and grades from one struct to another; geometry and counts stay. */
static void move_values (pg_rows *to, pg_rows *from)
{
    to->N = from->N, to->dN = from->dN, to->w = from->w, to->at = from->at, to->grade = from->grade;
    to->copied = from->copied, to->copied_bonds = from->copied_bonds;
    from->N = from->dN = from->w = NULL, from->at = NULL, from->grade = NULL;
}

/* Where sums are over the rows of the set itself they follow these. */
void galerkin_follow (galerkin *g)
{
    if (g->problem->consistency) g->sums.grade = g->rows[g->bulk].grade;
    else g->sums = g->rows[g->bulk];
}

/* Has the run the material of the bare body everywhere, and no other part of K in the bulk? */
static int same_stiffness (const galerkin *g, const pg_problem *run)
{
    return g->stiffness.K && !g->stiffness.all_stale && run->nmaterial == 1 && run->nlaw == 1
           && !g->dilatation;
}

/* Boundary facets of the bare problem are others than those of the run: only nodes and points are kept,
 * unless their supports are others too. */
pg_status galerkin_lend (void *self, const pg_state *state, pg_problem *problem)
{
    pg_status status = PG_OK;
    galerkin *g = self;
    pg_intact *kept = NULL;
    if (problem->intact || g->borrows[PG_NODES] || g->borrows[PG_POINTS] || g->problem->wide_at_cracks)
        return PG_OK;
    if (!galerkin_all_alive (g, PG_NODES, state)
        || !galerkin_all_alive (g, PG_POINTS, state)) return PG_OK;
    PG_ALLOC (kept, 1);
    for (int set = PG_NODES; set <= PG_POINTS; set++) move_values (&kept->rows[set], &g->rows[set]);
    if (g->problem->consistency) move_values (&kept->sums, &g->sums), kept->sums.grade = NULL;
    galerkin_follow (g);
    if (same_stiffness (g, problem)) kept->K = g->stiffness.K, g->stiffness.K = NULL,
        pg_assembly_settle (kept->K);
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

/* Forces on one problem may ask at the same time: one gets it, the others assemble themselves, to the same
 * bits. */
pg_assembly *galerkin_take_stiffness (const galerkin *g)
{
    pg_intact *kept = g->problem->intact;
    return kept && g->borrows[g->bulk] ? __atomic_exchange_n (&kept->K, NULL, __ATOMIC_ACQ_REL) : NULL;
}

/* A copy of the values of all rows, `width` numbers a bond, in which every point has a row of its own. */
static pg_status copy_values (const pg_rows *r, size_t width, const double *value, double **out)
{
    pg_status status = PG_OK;
    const size_t *start = r->family.start;
    double *own = NULL;
    PG_ALLOC (own, start[r->n] * width);
    if (!r->at) memcpy (own, value, start[r->n] * width * sizeof *own);
    for (size_t i = 0; r->at && i < r->n; i++)
        memcpy (own + start[i] * width, value + r->at[i] * width,
                (start[i + 1] - start[i]) * width * sizeof *own);
    *out = own;
done:
    return status;
}

/* Has every point a row of its own, even if some read that of another one? */
static int has_own (const galerkin *g, int set)
{
    return !g->borrows[set] && (!g->rows[set].at || g->leaders[set]);
}

/* On failure what is still borrowed is set to NULL, so that nobody frees what belongs to the problem. */
pg_status galerkin_own (galerkin *g, const pg_state *state, int set)
{
    pg_status status = PG_OK;
    pg_rows *r = &g->rows[set], old = *r, wide = g->sums;
    size_t dim = (size_t) g->dim;
    int borrowed = g->borrows[set], sums = borrowed && set == g->bulk && g->problem->consistency;
    if (has_own (g, set) || galerkin_all_alive (g, set, state)) return PG_OK;
    g->borrows[set] = 0;
    r->N = r->dN = r->w = NULL, r->at = NULL;
    if (borrowed) r->grade = NULL;
    if (sums) g->sums.N = g->sums.dN = NULL;
    PG_TRY (copy_values (&old, 1, old.N, &r->N));
    PG_TRY (copy_values (&old, dim, old.dN, &r->dN));
    PG_TRY (copy_values (&old, 1, old.w, &r->w));
    if (borrowed) {
        PG_ALLOC (r->grade, r->n);
        memcpy (r->grade, old.grade, r->n);
    }
    if (sums) PG_TRY (copy_values (&wide, 1, wide.N, &g->sums.N));
    if (sums) PG_TRY (copy_values (&wide, dim, wide.dN, &g->sums.dN));
    PG_TRY (galerkin_leaders_find (g, state, set));
done:
    if (!borrowed) pg_free (old.N), pg_free (old.dN), pg_free (old.w), pg_free (old.at);
    if (set == g->bulk) galerkin_follow (g);
    return status;
}

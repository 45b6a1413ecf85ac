/* SPDX-License-Identifier: GPL-3.0-or-later
 * The linear system where ranks share the body (perigal/ranks.h). Each rank has the equations of the points
 * that it owns; its vectors contain ghosts too, which products with K need: ghost displacements are those of
 * their owners, ghost forces are 0, so that sums over all ranks count every equation once. With one process
 * all functions here reduce to plain loops. */
#include "solve/run/solve.h"
#include "perigal/ranks.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static const pg_subdomain *part_of (const pg_system *s) { return s->problem->cloud.subdomain; }

int system_is_shared (const pg_system *s) { return part_of (s) != NULL; }

/* Ghosts take the displacements of their owners. */
pg_status system_exchange (const pg_system *s, double *d)
{
    return pg_subdomain_exchange (part_of (s), (size_t) s->components, d);
}

void system_clear_ghosts (const pg_system *s, double *force)
{
    pg_subdomain_clear_ghosts (part_of (s), (size_t) s->components, force);
}

/* The sum of `mine` over all ranks; NaN where communication fails, which the next residual reports. */
double system_sum (const pg_system *s, double mine)
{
    if (part_of (s) && pg_ranks_sum (1, &mine) != PG_OK) return NAN;
    return mine;
}

double system_most (const pg_system *s, double mine)
{
    if (part_of (s) && pg_ranks_most (1, &mine) != PG_OK) return NAN;
    return mine;
}

/* Euclidean norm of forces: n entries, ghosts being 0. */
double system_norm (const pg_system *s, const double *force, size_t n)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++) sum += force[i] * force[i];
    return sqrt (system_sum (s, sum));
}

/* Euclidean norm of displacements (ndof), each times `weight` (NULL: 1), ghosts left out. */
double system_norm_owned (const pg_system *s, const double *weight, const double *d)
{
    const pg_subdomain *part = part_of (s);
    double sum = 0;
    for (size_t i = 0; i < s->ndof; i++) {
        double one = weight ? weight[i] * d[i] : d[i];
        if (!part || part->owned[i / (size_t) s->components]) sum += one * one;
    }
    return sqrt (system_sum (s, sum));
}

/* y = K x with ghosts of x as their owners have them. */
void system_multiply_shared (const pg_system *s, const pg_operator *op, const double *x, double *y)
{
    const system_iterations *it = &s->iterative;
    memcpy (it->whole, x, s->ndof * sizeof *x);
    if (system_exchange (s, it->whole) != PG_OK) it->whole[0] = NAN;
    op->apply (op->context, it->whole, y);
    system_clear_ghosts (s, y);
}

/* ---- the preconditioner -------------------------------------------------------------------------------- */
/* The matrix k K + m M that the preconditioner is made for (iterative.made): as an operator, and its rows. */
static void apply_made (void *context, const double *x, double *y)
{
    const pg_system *s = context;
    const pg_operator *K = s->force->operator_ (s->self);
    K->apply (K->context, x, y);
    for (size_t i = 0; i < s->ndof; i++) y[i] = s->iterative.made[0] * y[i]
        + s->iterative.made[1] * s->mass[i] * x[i];
}

static void diagonal_made (void *context, double *d)
{
    const pg_system *s = context;
    const pg_operator *K = s->force->operator_ (s->self);
    K->diagonal (K->context, d);
    for (size_t i = 0; i < s->ndof; i++) d[i] = s->iterative.made[0] * d[i]
        + s->iterative.made[1] * s->mass[i];
}

static size_t row_made (void *context, size_t i, int thread, int *node, double *value)
{
    const pg_system *s = context;
    size_t b = (size_t) s->components,
        m = s->iterative.stiffness.row (s->iterative.stiffness.context, i, thread, node, value);
    for (size_t e = 0; value && e < m; e++) {
        for (size_t q = 0; q < b * b; q++) value[e * b * b + q] *= s->iterative.made[0];
        for (size_t k = 0; k < b && (size_t) node[e] == i; k++)
            value[(e * b + k) * b + k] += s->iterative.made[1] * s->mass[i * b + k];
    }
    return m;
}

/* 1: all ranks have a lattice (else only some ranks may know rows that many points have in common). */
static int has_lattice (const pg_system *s)
{
    const pg_sums *sums = s->problem->sums;
    const pg_box *own = &part_of (s)->own;
    return system_most (s, !(sums && sums->stencil.n && own->high[0] > own->low[0])) == 0;
}

/* Multilevel preconditioner on a lattice; each rank smooths its own points. */
static pg_status make_levels (pg_system *s, const pg_couplings *rows)
{
    system_iterations *it = &s->iterative;
    pg_status status = PG_OK;
    it->inertia = (pg_operator) { s->ndof, s, apply_made, diagonal_made };
    it->stiffness = *rows;
    int moves = it->made[1] != 0 || it->made[0] != 1;
    pg_multilevel_setting setting = { .dim = s->problem->dim, .block = s->components, .aligned = 1,
                                      .threads = s->problem->threads, .n = s->problem->cloud.n,
        .x = s->problem->cloud.x, .fixed = it->fixed, .rows = *rows,
        .A = moves ? &it->inertia : s->force->operator_ (s->self),
                                      .subdomain = part_of (s) };
    if (moves) setting.rows.context = s, setting.rows.row = row_made, setting.rows.alike = NULL;
    for (int k = 0; k < s->problem->dim; k++) setting.rows.lattice[k] = s->problem->sums->sites.step[k];
    PG_TRY (pg_multilevel_create (&it->multilevel, &setting));
    size_t size = sizeof s->report->linear.preconditioner,
           at = (size_t) snprintf (s->report->linear.preconditioner, size, "multilevel, ");
    pg_multilevel_describe_shared (it->multilevel, s->report->linear.preconditioner + at, size - at);
done:
    return status;
}

/* Makes the preconditioner from the rows of the points owned here; without a lattice by the one that
 * perigal-mpi brings along. */
pg_status system_make_shared (pg_system *s, double k, double m)
{
    system_iterations *it = &s->iterative;
    pg_status status = PG_OK;
    const pg_shared_preconditioner *type = pg_shared_preconditioner_now ();
    pg_shared_rows setting = { .dim = s->problem->dim, .block = s->components, .x = s->problem->cloud.x,
        .fixed = it->fixed, .subdomain = part_of (s),
                               .k = k, .m = m, .mass = s->mass };
    it->made[0] = k, it->made[1] = m;
    PG_TRY (s->force->spares.couplings (s->self, &setting.rows));
    if (has_lattice (s)) {
        PG_TRY (make_levels (s, &setting.rows));
        goto done;
    }
    PG_TRY (type->create (&it->amg, &setting));
    type->describe (it->amg, s->report->linear.preconditioner, sizeof s->report->linear.preconditioner);
done:
    return status;
}

/* 1: the preconditioner at hand is one that ranks have made together. */
int system_by_ranks (const pg_system *s)
{
    return s->iterative.amg || s->iterative.whole_factor || (s->iterative.multilevel && system_is_shared (s));
}

static pg_status solve_together (pg_system *s, const double *r, double *z)
{
    system_iterations *it = &s->iterative;
    if (it->whole_factor) return system_apply_shared_factor (s, r, z);
    if (it->amg) return pg_shared_preconditioner_now ()->solve (it->amg, r, z);
    pg_preconditioner P = pg_multilevel_preconditioner (it->multilevel);
    return P.solve (P.context, r, z);
}

/* Marks the unknowns of points without an intact bond (statics): nothing holds them, and they keep their
 * value, which coarse grids would change. */
pg_status system_find_bare (pg_system *s, const dynamics *dyn)
{
    pg_status status = PG_OK;
    const pg_operator *op = s->force->operator_ (s->self);
    if (!s->iterative.bare) PG_ALLOC (s->iterative.bare, s->ndof);
    op->diagonal (op->context, s->balance.scratch);
    for (size_t i = 0; i < s->ndof; i++)
        s->iterative.bare[i] = !dyn
                               && !(s->balance.scratch[i]
                                    > 1e-12 * fmax (s->direct.diagonal0[i], 1e-9 * s->direct.mean_diagonal));
done:
    return status;
}

/* Clears ghosts and bare unknowns in a preconditioned residual. */
void system_clear_rest (const pg_system *s, double *z)
{
    system_clear_ghosts (s, z);
    for (size_t i = 0; s->iterative.bare && i < s->ndof; i++) if (s->iterative.bare[i]) z[i] = 0;
}

/* Preconditioner of ranks; with elimination the residual of q is put at the unknowns that q selects. */
pg_status system_apply_shared (pg_system *s, const double *r, double *z)
{
    system_balance *b = &s->balance;
    pg_status status = PG_OK;
    if (!s->iterative.own_row) {
        PG_TRY (solve_together (s, r, z));
        system_clear_rest (s, z);
        goto done;
    }
    memset (b->full, 0, s->ndof * sizeof *b->full);
    for (size_t j = 0; j < s->nred; j++) b->full[s->iterative.own_row[j]] = r[j];
    PG_TRY (solve_together (s, b->full, b->scratch));
    system_clear_rest (s, b->scratch);
    for (size_t j = 0; j < s->nred; j++) z[j] = b->scratch[s->iterative.own_row[j]];
done:
    return status;
}

void system_free_shared (pg_system *s)
{
    system_free_shared_factor (s);
    if (s->iterative.amg) pg_shared_preconditioner_now ()->free (&s->iterative.amg);
}

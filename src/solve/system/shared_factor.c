/* SPDX-License-Identifier: GPL-3.0-or-later
 * A factor of k K + m M as preconditioner of ranks that share a small body: each rank makes all of it, from
 * the rows of all ranks.
 *
 * Preconditioning by finite elements with wide shape functions (element_preconditioner.c) takes polynomials
 * of up to 32 terms, and ghosts are exchanged before each: more than 60 messages an iteration, a hundred
 * iterations a solve, and a solve for every bond that breaks. Ranks with few points spend their time waiting
 * for messages. Here an iteration has one sum of the residual, and few iterations suffice: one for about
 * every eigenvalue that breaking has changed since the factor was made. */
#include "solve/run/solve.h"
#include "perigal/ranks.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Number of unknowns up to which each rank has the whole factor: some ten milliseconds, the time of a few
 * hundred messages between processes that share cores. */
enum { MOST_UNKNOWNS = 4000 };
/* Share of itself that is added to the diagonal, as fragments that nothing holds leave K singular. */
static const double lift = 1e-10;

struct shared_factor {
    const pg_linear_type *type;
    void   *factor;
    size_t  n;                                         /* number of unknowns of all ranks */
    size_t *place;                                     /* index of each point held, among all (points held) */
    double *r, *z;                                     /* workspaces (n) */
};

/* Numbers of an entry of the matrix in a message: row and column among all unknowns, value. */
enum { ENTRY = 3 };

/* ---- points -------------------------------------------------------------------------------------------- */
/* Finds the index of each point held among all, in ascending order of their numbers (which have gaps in
 * lattices with holes). */
static pg_status find_places (struct shared_factor *f, const pg_subdomain *part)
{
    pg_status status = PG_OK;
    double *mine = NULL, *all = NULL;
    size_t own = 0, total = 0;
    PG_ALLOC (mine, part->n);
    PG_ALLOC (f->place, part->n);
    for (size_t i = 0; i < part->n; i++) if (part->owned[i]) mine[own++] = (double) part->number[i];
    PG_TRY (pg_ranks_share (own, mine, &total, &all));
    if (total) pg_sort (all, total, sizeof *all, pg_ascending_numbers);
    for (size_t i = 0; i < part->n; i++) {
        double number = (double) part->number[i];
        const double *at = pg_search (&number, all, total, sizeof *all, pg_ascending_numbers);
        if (!at) PG_FAIL (PG_E_FILE, "ranks disagree about their points");
        f->place[i] = (size_t) (at - all);
    }
done:
    pg_free (mine), pg_free (all);
    return status;
}

/* ---- the matrix ---------------------------------------------------------------------------------------- */
/* Does this rank send the entry of K between two points held here? The owner of the point that comes first
 * does, as it has the whole row. */
static int tells (const pg_system *s, const struct shared_factor *f, size_t a, size_t b)
{
    const pg_subdomain *part = s->problem->cloud.subdomain;
    return part->owned[f->place[a] < f->place[b] ? a : b];
}

/* Lists the entries of k K + m M that this rank sends; eliminated unknowns couple with none. */
static pg_status list_entries (pg_system *s, const struct shared_factor *f, size_t *n, double **out)
{
    system_iterations *it = &s->iterative;
    pg_status status = PG_OK;
    size_t b = (size_t) s->components;
    const pg_sparse *K;
    PG_TRY (pg_force_assemble (s->force, s->self, &K));
    PG_ALLOC (*out, ENTRY * (size_t) K->start[K->ncol]);
    *n = 0;
    for (size_t j = 0; j < K->ncol; j++)
        for (long e = K->start[j]; e < K->start[j + 1]; e++) {
            size_t i = (size_t) K->row[e];
            int same = i == j, out_of_it = it->fixed[i] || it->fixed[j];
            if (!tells (s, f, i / b, j / b) || (out_of_it && !same)) continue;
            size_t row = f->place[i / b] * b + i % b, column = f->place[j / b] * b + j % b;
            double value = it->made[0] * K->value[e]
                           + (same && it->made[1] != 0 ? it->made[1] * s->mass[i] : 0),
                   *to = *out + *n;
            to[0] = (double) (row < column ? row : column), to[1] = (double) (row < column ? column : row);
            to[2] = out_of_it ? 1 : value;
            *n += ENTRY;
        }
done:
    return status;
}

static int by_column (const void *a, const void *b)
{
    const double *x = a, *y = b;
    if (x[1] != y[1]) return x[1] < y[1] ? -1 : 1;
    return (x[0] > y[0]) - (x[0] < y[0]);
}

/* Builds the upper triangle of the matrix from all entries, with every diagonal entry. */
static pg_status build (pg_sparse *A, size_t n, size_t count, double *entry)
{
    pg_status status = PG_OK;
    double mean = 0;
    PG_TRY (pg_sparse_create (A, n, n, count + n, 1));
    if (count) pg_sort (entry, count, ENTRY * sizeof *entry, by_column);
    size_t k = 0;
    long at = 0;
    for (size_t j = 0; j < n; j++) {
        for (; k < count && entry[ENTRY * k + 1] == (double) j; k++) {
            A->row[at] = (long) entry[ENTRY * k], A->value[at++] = entry[ENTRY * k + 2];
        }
        if (at == A->start[j] || A->row[at - 1] != (long) j) A->row[at] = (long) j, A->value[at++] = 0;
        A->start[j + 1] = at;
        mean += A->value[at - 1] / (double) n;
    }
    for (size_t j = 0; j < n; j++) {
        double *diagonal = A->value + A->start[j + 1] - 1;
        *diagonal = *diagonal > 1e-12 * mean ? *diagonal * (1 + lift) : mean;
    }
done:
    return status;
}

/* ---- the preconditioner -------------------------------------------------------------------------------- */
/* *yes 1: the factor is made; equal on all ranks. */
static pg_status may (pg_system *s, int *yes)
{
    pg_status status = PG_OK;
    const pg_subdomain *part = s->problem->cloud.subdomain;
    double not = !part || !s->force->spares.elements || !pg_force_matrix (s->force, s->self)
                 || strcmp (s->options->preconditioner, "auto") != 0
                 || part->total * s->components > MOST_UNKNOWNS;
    *yes = 0;
    if (!part) return PG_OK;
    PG_TRY (pg_ranks_most (1, &not));
    *yes = not == 0;
done:
    return status;
}

void system_free_shared_factor (pg_system *s)
{
    struct shared_factor *f = s->iterative.whole_factor;
    if (!f) return;
    if (f->factor) f->type->free (&f->factor);
    pg_free (f->place), pg_free (f->r), pg_free (f->z);
    pg_free (f);
    s->iterative.whole_factor = NULL;
}

pg_status system_make_shared_factor (pg_system *s, int *made)
{
    pg_status status = PG_OK;
    struct shared_factor *f = NULL;
    pg_sparse A = { 0 };
    double *mine = NULL, *all = NULL;
    size_t own = 0, n = 0;
    *made = 0;
    PG_TRY (may (s, made));
    if (!*made) return PG_OK;
    PG_ALLOC (s->iterative.whole_factor, 1);
    f = s->iterative.whole_factor;
    f->type = pg_linear_first (1, 1);
    f->n = (size_t) s->problem->cloud.subdomain->total * (size_t) s->components;
    PG_ALLOC (f->r, f->n);
    PG_ALLOC (f->z, f->n);
    PG_TRY (find_places (f, s->problem->cloud.subdomain));
    PG_TRY (list_entries (s, f, &own, &mine));
    PG_TRY (pg_ranks_share (own, mine, &n, &all));
    PG_TRY (build (&A, f->n, n / ENTRY, all));
    pg_linear_options o = { s->components, s->problem->dim, 1, 0, 1 };
    PG_TRY (f->type->analyse (&f->factor, &A, &o));
    pg_status now = f->type->factor (f->factor, &A);
    if (now == PG_E_NOT_SPD) {  /* on all ranks: finite elements instead, which are positive definite */
        *made = 0;
        system_free_shared_factor (s);
        goto done;
    }
    PG_TRY (now);
    snprintf (s->report->linear.preconditioner, sizeof s->report->linear.preconditioner,
              "%s, %zu unknowns on every rank", f->type->name, f->n);
done:
    pg_sparse_clear (&A);
    pg_free (mine), pg_free (all);
    if (status != PG_OK) system_free_shared_factor (s);
    return status;
}

pg_status system_apply_shared_factor (const pg_system *s, const double *r, double *z)
{
    pg_status status = PG_OK;
    const struct shared_factor *f = s->iterative.whole_factor;
    const pg_subdomain *part = s->problem->cloud.subdomain;
    size_t b = (size_t) s->components;
    memset (f->r, 0, f->n * sizeof *f->r);
    for (size_t i = 0; i < part->n; i++)
        if (part->owned[i]) memcpy (f->r + f->place[i] * b, r + i * b, b * sizeof *r);
    PG_TRY (pg_ranks_sum (f->n, f->r));
    PG_TRY (f->type->solve (f->factor, 1, f->r, f->z));
    for (size_t i = 0; i < part->n; i++) memcpy (z + i * b, f->z + f->place[i] * b, b * sizeof *z);
    for (size_t i = 0; i < s->ndof; i++) if (s->iterative.fixed[i]) z[i] = 0;
done:
    return status;
}

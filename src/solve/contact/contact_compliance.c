/* SPDX-License-Identifier: GPL-3.0-or-later
 * The compliance of pieces in contact: displacements Z = K^-1 G' under unit forces between their faces, and
 * the gaps C = G Z that these open. */
#include "contact.h"
#include <math.h>
#include <string.h>

/* Most rounds of refinement; number of columns from which on a factor is made. */
enum { MOST_ROUNDS = 4, MANY = 4 };
/* Relative accuracy of columns: by iterations (2D; 3D), where there is no factor; by a factor. */
static const double COLUMN = 1e-10, COLUMN_SPACE = 1e-7, REFINED = 1e-12;

/* full, reduced = column j of G' in all unknowns and in those that are solved for. */
static void load_column (const pg_system *s, size_t j, double *full, double *reduced)
{
    const pg_sparse *G = &s->contact->G;
    memset (full, 0, s->ndof * sizeof *full);
    for (long q = G->start[j]; q < G->start[j + 1]; q++) full[G->row[q]] = G->value[q];
    system_reduce (s, full, reduced);
}

/* rest = columns of G' - K z (nred x n); returns its largest norm over that of the column or K z: springs on
 * weak unknowns of the factor show in it. NAN: a column is not finite. */
static double rest_of_columns (pg_system *s, const double *rhs, const double *solved, size_t n, double *rest)
{
    double worst = 0;
    int finite = 1;
    for (size_t j = 0; j < n; j++) {
        const double *z = solved + j * s->nred, *b = rhs + j * s->nred;
        double *r = rest + j * s->nred, left = 0, size = 0;
        system_multiply (s, system_step (s, z), s->balance.scratch);
        system_reduce (s, s->balance.scratch, r);
        for (size_t k = 0; k < s->nred; k++) {
            r[k] = b[k] - r[k];
            left = fmax (left, fabs (r[k])), size = fmax (size, fabs (b[k]));
            finite &= isfinite (r[k]) != 0;
        }
        worst = fmax (worst, left / size);
    }
    return finite ? worst : NAN;
}

/* Refines all columns by the factor at hand, as long as it gains, for linear stretches of a load path, which
 * are sums of columns; single states are refined as a whole. */
static pg_status refine_columns (pg_system *s, const double *rhs, double *solved, size_t n)
{
    pg_status status = PG_OK;
    double *rest = NULL, *step = NULL, before = INFINITY;
    if (!system_has_factor (s) || !s->contact->route.open[0]) return PG_OK;
    PG_ALLOC (rest, s->nred * n);
    PG_ALLOC (step, s->nred * n);
    for (int round = 0; round < MOST_ROUNDS; round++) {
        double left = rest_of_columns (s, rhs, solved, n, rest);
        if (isnan (left))
            PG_FAIL (PG_E_NOT_SPD, "the factor gives no finite displacements under forces between faces in "
                                   "contact: is a part of the body held by next to nothing? Prescribe "
                                   "displacements of it, or try solver.linear: umfpack");
        if (!(left < 0.1 * before)) {
            for (size_t k = 0; round && left > before && k < s->nred * n; k++) solved[k] -= step[k];
            break;
        }
        if (left <= REFINED) break;
        before = left;
        PG_TRY (s->direct.linear->solve (s->direct.factor, n, rest, step));
        for (size_t k = 0; k < s->nred * n; k++) solved[k] += step[k];
        s->report->contact.columns += (long) n;
    }
done:
    pg_free (rest), pg_free (step);
    return status;
}

/* 3D: slips of pieces without friction and cohesion bear no force, and their columns are not needed. */
static int needs_column (const struct system_contact *c, size_t j)
{
    size_t dim = c->pieces.dim, k = j / dim;
    return dim != 3 || j % dim == 0 || c->coefficient[k] > 0 || c->cohesion[k] > 0;
}

double contact_columns (const pg_system *s)
{
    const struct system_contact *c = s->contact;
    size_t count = 0;
    for (size_t j = 0; c && j < c->pieces.dim * c->pieces.n; j++) count += needs_column (c, j) != 0;
    return (double) count;
}

/* Finds Z = K^-1 G', all columns at once by the factor at hand, else one after the other. In 3D iterations
 * are less accurate: the rounds that follow correct the rest, and are fewer than columns. */
static pg_status solve_columns (pg_system *s, const dynamics *dyn)
{
    system_balance *b = &s->balance;
    system_factor *f = &s->direct;
    pg_status status = PG_OK;
    struct system_contact *c = s->contact;
    size_t n = c->pieces.dim * c->pieces.n;
    double *rhs = NULL, *solved = NULL, *kept = NULL, t0 = pg_seconds ();
    if (!c->compliance.Z) PG_ALLOC (c->compliance.Z, s->ndof * n);
    PG_ALLOC (rhs, s->nred * n);
    PG_ALLOC (solved, s->nred * n);
    if (dyn) {                                         /* iterations would change the residual */
        PG_ALLOC (kept, s->ndof);
        memcpy (kept, b->residual, s->ndof * sizeof *kept);
    }
    for (size_t j = 0; j < n; j++) load_column (s, j, b->full, rhs + j * s->nred);
    /* many columns are worth a factor of the present K where an older one would only precondition; else the
     * first solve makes the factor if there is to be one */
    if (s->choice.mode == SYSTEM_KEPT_FACTOR && f->stale && n > MANY) PG_TRY (system_factorize (s, dyn));
    /* a resumed run remakes columns as they were made, one by one or together: they would differ in their
     * last digits otherwise */
    int again = c->compliance.again == f->revision + 1;
    if (again && c->compliance.alone == 0 && !system_has_factor (s) && system_factors (s))
        PG_TRY (system_factorize (s, dyn));
    /* these solves are not counted, as some solves are measured by their number and a resumed run makes the
     * columns again */
    long solves = s->report->linear.solves;
    size_t first = 0;
    for (; first < n && (!system_has_factor (s) || (again && first < c->compliance.alone)); first++) {
        if (!needs_column (c, first)) continue;
        /* iterations over all unknowns start from the full residual */
        load_column (s, first, b->residual, b->reduced);
        b->known = b->carried = 0;
        memcpy (b->reduced, rhs + first * s->nred, s->nred * sizeof *rhs);
        memset (b->delta, 0, s->nred * sizeof *b->delta);
        PG_TRY (system_solve_once (s, dyn, c->pieces.dim == 3 ? COLUMN_SPACE : COLUMN));
        memcpy (solved + first * s->nred, b->delta, s->nred * sizeof *rhs);
    }
    c->compliance.alone = first;
    if (first < n)
        PG_TRY (f->linear->solve (f->factor, n - first, rhs + first * s->nred, solved + first * s->nred));
    s->report->linear.solves = solves;
    long columns = s->report->contact.columns;
    s->report->contact.columns += (long) n;
    PG_TRY (refine_columns (s, rhs, solved, n));
    /* nor are columns counted that a resumed run makes again */
    if (again) s->report->contact.columns = columns;
    c->compliance.again = 0;
    for (size_t j = 0; j < n; j++)
        system_expand (s, solved + j * s->nred, c->compliance.Z + j * s->ndof);
done:
    if (kept) memcpy (b->residual, kept, s->ndof * sizeof *kept);
    pg_free (rhs), pg_free (solved), pg_free (kept);
    s->report->seconds[PG_SECONDS_SOLVE] += pg_seconds () - t0;
    return status;
}

pg_status contact_factor (pg_system *s)
{
    const struct system_contact *c = s->contact;
    int worth = c->is.touched && c->pieces.dim * c->pieces.n > MANY;
    return worth && s->choice.mode == SYSTEM_KEPT_FACTOR && s->direct.stale ? system_factorize (s, NULL)
           : PG_OK;
}

/* C = G Z, made symmetric, which it is but for rounding. */
pg_status contact_condense (pg_system *s, const dynamics *dyn)
{
    pg_status status = PG_OK;
    struct system_contact *c = s->contact;
    size_t n = c->pieces.dim * c->pieces.n;
    if (c->compliance.made == s->direct.revision + 1) return PG_OK;
    double t0 = pg_seconds ();
    PG_TRY (solve_columns (s, dyn));
    if (!c->compliance.C) PG_ALLOC (c->compliance.C, n * n);
    for (size_t j = 0; j < n; j++)
        pg_sparse_multiply_transposed (&c->G, c->compliance.Z + j * s->ndof, c->compliance.C + j * n);
    for (size_t j = 0; j < n; j++)
        for (size_t i = 0; i < j; i++) {
            int one = needs_column (c, i), other = needs_column (c, j);
            double sum = (other ? c->compliance.C[j * n + i] : 0) + (one ? c->compliance.C[i * n + j] : 0);
            c->compliance.C[j * n + i] = c->compliance.C[i * n + j] = one && other ? 0.5 * sum : sum;
        }
    for (size_t j = 0; j < n; j++)                     /* columns not needed get a positive diagonal */
        if (!needs_column (c, j)) c->compliance.C[j * n + j] = c->compliance.C[(j / 3 * 3) * (n + 1)];
    for (size_t i = 0; i < c->pieces.dim * c->ncrack; i++) c->compliance.C[i * n + i] += c->soft[i];
    /* empty columns bear no force, whatever their compliance */
    double most = 0;
    for (size_t j = 0; j < n; j++) most = fmax (most, c->compliance.C[j * n + j]);
    for (size_t j = 0; j < n; j++) if (!(c->compliance.C[j * n + j] > 0)) c->compliance.C[j * n + j] = most;
    c->compliance.made = s->direct.revision + 1;
    s->report->contact.seconds += pg_seconds () - t0;
done:
    return status;
}

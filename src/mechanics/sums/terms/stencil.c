/* SPDX-License-Identifier: GPL-3.0-or-later
 * The bonds of a point inside a lattice. All is computed for offsets with sizes of components sorted (along
 * axes of equal steps) and looked up for the rest, so that mirrored and permuted offsets have the same
 * bits. */
#include "sums_private.h"
#include "partial_volume.h"
#include <math.h>
#include <string.h>

/* A horizon of so many points is a mistake of units, not a scene. */
static const double most_offsets = 2e8;

/* All offsets of equal sizes of components: length (m), partial volume, weight k beta. */
typedef struct { double r, beta, weight; } shell;

typedef struct {
    const pg_sum_rule *rule;
    int    dim, reach[3];
    double step[3];                                    /* lattice steps, m; those equal to 1e-9 made equal */
    shell *of;  /* by sizes of components, x fastest; beta 0: no bond */
} shells;

/* A kernel at one place, q = r / horizon. */
static double value (const pg_kernel *kernel, double q)
{
    double w;
    kernel->value (1, &q, &w, NULL);
    return w;
}

/* The kernel at a bond's length. Open kernels end before the horizon itself; bonds that only their cell's
 * part brings in (partial volumes) have q > 1 and the value that the kernel has there. */
double pg_sums_kernel (const pg_sum_rule *rule, double r, double horizon)
{
    double q = r / horizon;
    if (!rule->kernel->closed && q > 1 - 1e-9) return 0;
    return value (rule->kernel, rule->partial == PG_PARTIAL_NONE ? fmin (q, 1) : q);
}

/* Length, partial volume and weight of the offset n (sizes of its components, in canonical order).
 * Partial volumes by `overlap` are exact intersections of the cell with the ball about the point; the
 * others go by distance, with the width of a cell along the bond. Where the kernel ends at the horizon,
 * overlap takes its mean over the part of the cell instead of its value at the centre. */
static shell shell_at (const shells *s, const int *n)
{
    const pg_sum_rule *rule = s->rule;
    shell out = {0};
    double r2 = 0, spread = 0;
    int even = 1;
    for (int k = 0; k < s->dim; k++) {
        double x = n[k] * s->step[k];
        r2 += x * x;
        spread += x * x * s->step[k] * s->step[k];
        even &= s->step[k] == s->step[0];
    }
    if (!(r2 > 0)) return out;
    out.r = sqrt (r2);
    if (rule->partial == PG_PARTIAL_OVERLAP) {
        out.beta = pg_sums_overlap (s->dim, n, s->step, rule->horizon);
        if (out.beta < 1e-12) out.beta = 0;
    } else
        out.beta = pg_sums_partial (rule->partial, out.r, rule->horizon,
                                 even ? s->step[0] : sqrt (spread) / out.r);
    if (out.beta <= 0) return out;
    if (rule->partial == PG_PARTIAL_OVERLAP && !rule->kernel->closed)
        out.weight = pg_sums_overlap_mean (s->dim, n, s->step, rule->horizon, rule->kernel);
    else out.weight = out.beta * pg_sums_kernel (rule, out.r, rule->horizon);
    if (out.weight <= 0) out.beta = 0;
    return out;
}

/* Index in the table of shells of an offset with components of sizes n, x fastest. */
static size_t place (const shells *s, const int *n)
{
    return (size_t) n[0]
           + (size_t) (s->reach[0] + 1) * ((size_t) n[1] + (size_t) (s->reach[1] + 1) * (size_t) n[2]);
}

/* Sizes of components, descending along axes of equal steps: all offsets of one shell have the same
 * canonical form, and so the same bits. */
static void canonical (const shells *s, const int *n, int *c)
{
    for (int k = 0; k < 3; k++) c[k] = n[k] < 0 ? -n[k] : n[k];
    for (int a = 0; a < s->dim; a++)
        for (int b = a + 1; b < s->dim; b++)
            if (s->step[a] == s->step[b] && c[a] < c[b]) { int keep = c[a]; c[a] = c[b]; c[b] = keep; }
}

/* How far a bond may reach along each axis, in steps; steps that are equal to rounding are made so in all
 * bits. Partial volumes reach half a cell farther. */
static pg_status fit (shells *s, const pg_sum_rule *rule, int dim, const double *step)
{
    pg_status status = PG_OK;
    double all = 1;
    s->rule = rule, s->dim = dim;
    for (int k = 0; k < dim; k++) {
        s->step[k] = step[k];
        for (int a = k; a-- > 0;)
            if (fabs (step[k] - s->step[a]) <= 1e-9 * s->step[a]) s->step[k] = s->step[a];
    }
    for (int k = 0; k < dim; k++) {
        double far = rule->horizon * (1 + 1e-9) / s->step[k] + (rule->partial == PG_PARTIAL_NONE ? 0 : 0.5);
        all *= 2 * far + 1;
        if (!(all < most_offsets))
            PG_FAIL (
                PG_E_LIMIT,
                "a horizon of %g m holds too many points of spacing %g m: a shorter one, or wider spacing",
                rule->horizon, step[k]);
        s->reach[k] = (int) far;
    }
done:
    return status;
}

/* Computes each canonical offset once; the rest of the table is never read. What is no number is no reason
 * to leave a bond out: it is a fault. */
static pg_status fill (shells *s)
{
    pg_status status = PG_OK;
    int n[3], c[3];
    PG_ALLOC (s->of, (size_t) (s->reach[0] + 1) * (size_t) (s->reach[1] + 1) * (size_t) (s->reach[2] + 1));
    for (n[2] = 0; n[2] <= s->reach[2]; n[2]++)
        for (n[1] = 0; n[1] <= s->reach[1]; n[1]++)
            for (n[0] = 0; n[0] <= s->reach[0]; n[0]++) {
                canonical (s, n, c);
                if (memcmp (n, c, sizeof n)) continue;
                shell *of = &s->of[place (s, n)];
                *of = shell_at (s, n);
                if (!isfinite (of->beta) || !isfinite (of->weight))
                    PG_FAIL (PG_E_USAGE,
                             "the bond to the neighbour (%d, %d, %d) steps away has partial volume %g and "
                             "weight %g by kernel %s, at a horizon of %.17g m and steps of %.17g m: choose "
                             "another method.kernel or method.partial_volume",
                             n[0], n[1], n[2], of->beta, of->weight, s->rule->kernel->name, s->rule->horizon,
                             s->step[0]);
            }
done:
    return status;
}

/* All offsets with a bond, in the order z, y, x; out NULL: only counted. */
static size_t list (const shells *s, pg_stencil *out)
{
    size_t b = 0;
    int n[3], c[3];
    for (n[2] = -s->reach[2]; n[2] <= s->reach[2]; n[2]++)
        for (n[1] = -s->reach[1]; n[1] <= s->reach[1]; n[1]++)
            for (n[0] = -s->reach[0]; n[0] <= s->reach[0]; n[0]++) {
                canonical (s, n, c);
                const shell *of = &s->of[place (s, c)];
                if (!(of->beta > 0)) continue;
                if (out) {
                    for (int k = 0; k < 3; k++) out->offset[3*b + (size_t) k] = n[k];
                    for (int k = 0; k < s->dim; k++)
                        out->xi[b * (size_t) s->dim + (size_t) k] = n[k] * s->step[k];
                    out->r[b] = of->r, out->beta[b] = of->beta, out->weight[b] = of->weight;
                }
                b++;
            }
    return b;
}

/* All bonds of a point inside a lattice, in the order z, y, x of their offsets: offset (whole steps), xi
 * (m), length r, partial volume, weight. The order is that of site numbers, by which families of ordered
 * points need no sort. */
pg_status pg_stencil_build (pg_stencil *out, const pg_sum_rule *rule, int dim, const double *step)
{
    pg_status status = PG_OK;
    shells s = {0};
    memset (out, 0, sizeof *out);
    PG_TRY (pg_sums_check_rule (rule, dim));
    for (int k = 0; k < dim; k++)
        if (!(step[k] > 0) || !isfinite (step[k]))
            PG_FAIL (PG_E_USAGE, "step %g m of a lattice must be positive", step[k]);
    PG_TRY (fit (&s, rule, dim, step));
    PG_TRY (fill (&s));
    out->dim = dim;
    out->cell = 1;
    for (int k = 0; k < dim; k++) out->cell *= s.step[k];
    out->n = list (&s, NULL);
    if (out->n == 0)
        PG_FAIL (PG_E_USAGE, "a horizon of %g m reaches no neighbour at a spacing of %g m", rule->horizon,
                 step[0]);
    PG_ALLOC (out->offset, 3 * out->n);
    PG_ALLOC (out->xi, out->n * (size_t) dim);
    PG_ALLOC (out->r, out->n);
    PG_ALLOC (out->beta, out->n);
    PG_ALLOC (out->weight, out->n);
    list (&s, out);
done:
    pg_free (s.of);
    if (status != PG_OK) pg_stencil_clear (out);
    return status;
}

/* May be called for a stencil of zeros. */
void pg_stencil_clear (pg_stencil *stencil)
{
    pg_free (stencil->offset);
    pg_free (stencil->xi);
    pg_free (stencil->r);
    pg_free (stencil->beta);
    pg_free (stencil->weight);
    memset (stencil, 0, sizeof *stencil);
}

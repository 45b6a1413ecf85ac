/* SPDX-License-Identifier: GPL-3.0-or-later
 * The bonds of a point inside a lattice. Values are computed for canonical offsets, whose components are not
 * negative and sorted (along axes of equal steps), and looked up for the others, so that mirrored and
 * permuted offsets have the same bits. */
#include "sums_private.h"
#include "partial_volume.h"
#include <math.h>
#include <string.h>

/* Most points within a horizon: more are taken for a mistake of units. */
static const double most_offsets = 2e8;

/* Values of all offsets with the same canonical form: length (m), partial volume, weight k beta. */
typedef struct { double r, beta, weight; } shell;

typedef struct {
    const pg_sum_rule *rule;
    int    dim, reach[3];
    double step[3];                                    /* lattice steps, m; those equal to 1e-9 made equal */
    shell *of;  /* by absolute values of components, x fastest; beta 0: no bond */
} shells;

/* Returns the kernel at q = r / horizon. */
static double value (const pg_kernel *kernel, double q)
{
    double w;
    kernel->value (1, &q, &w, NULL);
    return w;
}

/* Kernel at the length r of a bond. Kernels that vanish at the horizon have no bond there; bonds to cells
 * that lie only partly in the horizon (partial volumes) may have q > 1, where the kernel's formula is
 * continued. */
double pg_sums_kernel (const pg_sum_rule *rule, double r, double horizon)
{
    double q = r / horizon;
    if (!rule->kernel->closed && q > 1 - 1e-9) return 0;
    return value (rule->kernel, rule->partial == PG_PARTIAL_NONE ? fmin (q, 1) : q);
}

/* Length, partial volume and weight of the canonical offset n. Partial volumes by `overlap` are exact
 * intersections of the cell with the ball around the point; the others depend on the distance and on the
 * width of a cell along the bond. If the kernel vanishes at the horizon, overlap takes its mean over the part
 * of the cell instead of its value at the centre. */
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

/* Returns the index in the table of shells of an offset with absolute components n, x fastest. */
static size_t place (const shells *s, const int *n)
{
    return (size_t) n[0]
           + (size_t) (s->reach[0] + 1) * ((size_t) n[1] + (size_t) (s->reach[1] + 1) * (size_t) n[2]);
}

/* Makes the canonical form c of an offset n: absolute components, descending along axes of equal steps. All
 * offsets of one shell have the same form, and so the same bits. */
static void canonical (const shells *s, const int *n, int *c)
{
    for (int k = 0; k < 3; k++) c[k] = n[k] < 0 ? -n[k] : n[k];
    for (int a = 0; a < s->dim; a++)
        for (int b = a + 1; b < s->dim; b++)
            if (s->step[a] == s->step[b] && c[a] < c[b]) { int keep = c[a]; c[a] = c[b]; c[b] = keep; }
}

/* Sets how far a bond may reach along each axis, in steps (with partial volumes half a cell farther); steps
 * that are equal but for rounding are made equal. */
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

/* Computes the shell of each canonical offset; the rest of the table is never read. Values that are not
 * finite are an error. */
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

/* Lists all offsets with a bond, sorted by z, y, x; out NULL: only counts. Returns their number. */
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

/* Makes all bonds of a point inside a lattice, sorted by z, y, x of their offsets: offset (steps), xi (m),
 * length r, partial volume, weight. The order is that of site numbers, so that families of ordered points
 * need no sort. */
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

/* Frees the arrays; *stencil may be all zeros. */
void pg_stencil_clear (pg_stencil *stencil)
{
    pg_free (stencil->offset);
    pg_free (stencil->xi);
    pg_free (stencil->r);
    pg_free (stencil->beta);
    pg_free (stencil->weight);
    memset (stencil, 0, sizeof *stencil);
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * How systems are solved: by a factor of K or by conjugate gradients, chosen once by counted cost. All costs
 * are seconds by stored rates, from numbers of bonds, points and unknowns; never measured, as a run must not
 * depend on the clock. */
#include "solve.h"
#include <math.h>
#include <string.h>

/* Seconds of one product K x: visits of bonds times a stored rate, by stencil, list or shape functions. */
double system_apply_cost (const pg_system *s)
{
    const pg_problem *p = s->problem;
    if (p->sums) return (p->sums->stencil.n ? 0.6e-9 : 3e-9) * (double) p->first_bond[PG_BOND_SETS];
    return 4e-9
           * (double) (p->first_bond[PG_BOND_SETS]
                       - (p->integration->at_nodes ? 0 : p->first_bond[PG_POINTS]));
}

/* ---- forces on shape functions ------------------------------------------------------------------------- */
/* The set of the evaluation points. */
static const pg_family *family_of (const pg_problem *p)
{
    return &p->rows[p->integration->at_nodes ? PG_NODES : PG_POINTS].family;
}

/* Assembly visits every pair of nodes of every evaluation point. */
static double assembly_cost (const pg_problem *p)
{
    const pg_family *f = family_of (p);
    double pairs = 0;
    for (size_t i = 0; i < f->n; i++) {
        double m = (double) (f->start[i + 1] - f->start[i]);
        pairs += 0.5 * m * m;
    }
    return 8e-9 * pairs;
}

/* Nested dissection parts a body across its longest axis by separators as thick as two nodes can be apart
 * that one point sees, 2 horizons. With s unknowns of the largest separator the factor costs about 3 s^3
 * operations (solids of n1 >= n2 >= n3 nodes along the axes: s^3 n1 / n2), in the plane 10 s^3; measured on
 * blocks, cubes and plates: right within a factor of 2. */
static double factor_flops (const pg_system *s)
{
    const pg_problem *p = s->problem;
    double n[3] = { 1, 1, 1 }, low[3] = { 0 }, high[3] = { 0 }, box = 1;
    pg_problem_box (p, low, high);
    for (int k = 0; k < p->dim; k++) box *= n[k] = fmax (high[k] - low[k], p->cloud.h);
    for (int k = 0; k < p->dim; k++) n[k] *= pow ((double) p->cloud.n / box, 1.0 / p->dim);
    for (int k = 0; k < 2; k++)
        for (int l = k + 1; l < 3; l++)
            if (n[l] > n[k]) {
                double swap = n[k];
                n[k] = n[l], n[l] = swap;
            }
    double thick = 2 * p->approx.horizon / p->cloud.h,
           separator = thick * s->components * n[1] * (p->dim > 2 ? n[2] : 1);
    return (p->dim > 2 ? 3 : 10) * separator * separator * separator * fmax (1, n[0] / n[1]);
}

/* Assembly, analysis, factor. */
double system_direct_cost (const pg_system *s)
{
    return assembly_cost (s->problem) + 5e-6 * (double) s->ndof + factor_flops (s) / 20e9;
}

/* Iterations to a tolerance of 1e-9, as measured: the shape functions of a wide support are far from those of
 * elements, and so is a dilatation that is projected. */
static double iterations (const pg_problem *p)
{
    double wide = p->approx.horizon / p->cloud.h, count = 45;
    if (p->approx.type->interpolates) count = 30;
    else if (p->approx.order == 2) count = wide > 2.7 ? 200 : 100;
    else if (wide > 2.2) count = wide > 2.7 ? 1000 : 100;
    /* points at the centres of cells stand behind the surface, where the supports are */
    int behind = p->lattice.dim && p->cells.n == p->cloud.n;
    return count * (p->patches ? 3 : 1) * (behind ? 6 : 1);
}

/* Set-up counts as 20 iterations; beside K x an iteration takes 0.9 us for each node: products with the
 * element matrix and its coarse levels, and with the polynomial. */
static double elements_cost (const pg_system *s)
{
    return (iterations (s->problem) + 20)
           * (system_apply_cost (s) + 0.9e-6 * (double) s->problem->cloud.n);
}

/* ---- the choice ---------------------------------------------------------------------------------------- */
/* Would conjugate gradients with sums over bonds be cheaper than a factor? By measured rates
 * (pg_method_iterates); can: the multilevel preconditioner is at hand. */
static int by_bond_loops (const pg_system *s, int can)
{
    const pg_problem *p = s->problem;
    return p->sums && (can || p->sums->stencil.n)
           && pg_method_iterates (p->method, can, p->dim, (double) s->ndof);
}

/* A factor that serves many events pays for itself up to here in 3D (unknowns), and its memory can be
 * afforded: some 2 GB in a cube. Measured with 35 000 unknowns in a flat block with a crack: 0.4 s an event
 * and 1.9 GB by the factor, 3.9 s and 0.4 GB by iterations, some 250 a solve. */
enum { EVENTS_FACTOR = 40000 };

/* The same of finite elements; without them a factor that no memory holds is none either. In the plane
 * factors are cheap. */
static int by_elements (const pg_system *s, int can)
{
    if (s->problem->sums || s->problem->dim < 3) return 0;
    if (s->serves && s->ndof <= EVENTS_FACTOR) return 0;
    if (can && s->force->elements && elements_cost (s) < system_direct_cost (s)) return 1;
    return s->ndof > 200000;
}

/* solver.linear says it, a force without a matrix leaves no choice, and in a small time step the mass
 * dominates: then a few iterations without any factor do, which is simply tried. */
pg_status system_choose (pg_system *s, const dynamics *dyn)
{
    pg_status status = PG_OK;
    int can, operates = s->force->operator_ && s->force->operator_ (s->self);
    int automatic = strcmp (s->options->linear, "auto") == 0 && operates;
    PG_TRY (system_can_precondition (s, dyn, &can));
    if (!can && strcmp (s->options->preconditioner, "multilevel") == 0)
        pg_statistics_warn (s->report, "preconditioner: multilevel needs a body at rest and a force that "
                                       "tells the rows of K, with supports on points: the diagonal instead "
                                       "where there is no factor");
    s->mode = SYSTEM_FACTOR;
    if (!system_has_matrix (s) || (!s->linear->factors && operates))
        s->mode = dyn && can ? SYSTEM_TRIAL : SYSTEM_NO_FACTOR;
    else if (automatic && dyn) s->mode = SYSTEM_TRIAL;
    else if (automatic && (by_bond_loops (s, can) || by_elements (s, can))) {
        s->mode = SYSTEM_NO_FACTOR;
        pg_statistics_skip (s->report, NAN, "stiffness matrix, analysis and factorization",
                            s->problem->sums ? "so many points: conjugate gradients with sums over the bonds "
                                               "are cheaper by stored rates"
                                             : "so many points: conjugate gradients are cheaper by stored "
                                               "rates");
    }
done:
    return status;
}

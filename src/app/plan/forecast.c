/* SPDX-License-Identifier: GPL-3.0-or-later
 * What a run will need, before it allocates: counts from the lattice, bytes from counts, the factor by nested
 * dissection of the body's box: separators of `width` nodes halve the longest edge again and again, and a
 * separator of s nodes with b boundary nodes around its part fills s^2/2 + s b entries and costs s^3/3 + s^2
 * b + s b^2 operations (per node; dofs: times dim^2, dim^3). With width = 0.93 times the radius of the ball
 * of as many nodes as one is coupled to, this is within 20 % of METIS for disks, cubes and plates of 10^3 to
 * 10^5 nodes (test/app/plan/test_forecast.c). */
#include "forecast.h"
#include "perigal/linalg.h"
#include <math.h>
#include <string.h>

/* ---- the factor ---------------------------------------------------------------------------------------- */
/* Parts of the body at one level of the dissection, counted by how many of their two faces across each axis
 * are separators: 0, 1 or 2. All parts of a level have the same size, so that 27 numbers stand for up to
 * 2^level parts. */
typedef struct { double count[3][3][3]; } parts;

/* Cuts every part across axis k: the cut is a separator face of both halves, and each half keeps one of the
 * two outer faces of the part. */
static void halve (parts *p, int k)
{
    parts q = { 0 };
    for (int a = 0; a < 27; a++) {
        int f[3] = { a % 3, a / 3 % 3, a / 9 };
        double n = p->count[f[0]][f[1]][f[2]];
        int left = f[k] == 0 ? 1 : 2, right = f[k] == 2 ? 2 : 1;
        f[k] = left, q.count[f[0]][f[1]][f[2]] += n;
        f[k] = right, q.count[f[0]][f[1]][f[2]] += n;
    }
    *p = q;
}

/* Entries of the factor and operations, summed level by level down to parts as thin as two separators,
 * which are eliminated as they are. */
static void dissect (const pg_forecast *f, double *entries, double *flops)
{
    parts p = { 0 };
    double L[3] = { f->edge[0], f->edge[1], f->edge[2] }, m = f->dim + f->rotations;
    p.count[0][0][0] = 1;
    *entries = *flops = 0;
    for (int level = 0, k = 0, last = 0; level < 200 && !last; level++) {
        double n = L[0] * L[1] * L[2];
        k = 0;
        for (int i = 1; i < f->dim; i++) if (L[i] > L[k]) k = i;
        last = L[k] <= 2 * f->width;
        double s = m * (last ? n : f->width * n / L[k]);
        for (int a = 0; a < 27; a++) {
            double c = p.count[a % 3][a / 3 % 3][a / 9],
                   faces = a % 3 / L[0] + a / 3 % 3 / L[1] + a / 9 / L[2], b = m * f->width * n * faces;
            *entries += c * (s * s / 2 + s * b);
            *flops += c * (s * s * s / 3 + s * s * b + s * b * b);
        }
        halve (&p, k);
        L[k] = (L[k] - f->width) / 2;
    }
}

/* ---- the linear solver --------------------------------------------------------------------------------- */
/* The linear solver, chosen as a run does under `solver.linear: auto`: no factor where the mass dominates
 * (conjugate gradients then need some 40 iterations at most, which takes beta dt^2 omega^2 <= 9 with omega =
 * 2 c_p / h), nor where iterations preconditioned by finite elements cost less (solve_costs.c). */
static pg_solve_counts counts_of (const pg_forecast *f)
{
    int set = f->is.nodal ? PG_NODES : PG_POINTS;
    pg_solve_counts c = { .dim = f->dim,
                          .components = f->dim,
                          .order = f->order,
                          .interpolates = f->is.interpolates,
                          .projected = f->count.patched > 0,
                          .behind = f->is.behind,
                          .scattered = f->is.scattered,
                          .points = f->count.points,
                          .evaluation = f->is.nodal ? f->count.points : f->count.evaluation,
                          .bonds = f->count.bonds[set],
                          .reach = f->horizon / f->spacing,
                          .columns = f->count.columns };
    for (int k = 0; k < 3; k++) c.edge[k] = f->edge[k];
    return c;
}

static int by_elements (const pg_forecast *f)
{
    pg_solve_counts c = counts_of (f);
    return pg_solve_by_elements (&c, f->is.elements, f->is.events, f->is.dynamic);
}

/* 1: implicit dynamics with time steps so small that the mass dominates and the diagonal does as
 * preconditioner. */
static int mass_dominates (const pg_forecast *f)
{
    return f->is.dynamic && f->weight <= 9 * f->spacing * f->spacing;
}

static void choose_linear (pg_forecast *f)
{
    if (!f->is.automatic) return;
    int none = f->is.explicit_ || f->is.matrixless ? 1
               : mass_dominates (f)                ? 1
               : !f->method->shape_functions
                   ? !f->is.dynamic
                         && pg_method_iterates (f->method, 1, f->dim,
                                                f->count.points * (f->dim + f->rotations))
                   : by_elements (f);
    f->linear = none ? NULL : f->linear ? f->linear : pg_linear_usual (1, 1);
}

const char *pg_forecast_linear (const pg_forecast *f) { return f->linear ? f->linear->name : "cg"; }

/* ---- bytes --------------------------------------------------------------------------------------------- */
/* Names of what memory is needed for, in the order of PG_BYTES_... */
const char *pg_forecast_item (int item)
{
    static const char *const names[PG_BYTES_COUNT] = {
        "program",          "points and cells", "bond lists", "shape functions", "breaking",
        "stiffness matrix", "factor",           "vectors",    "results"
    };
    return item >= 0 && item < PG_BYTES_COUNT ? names[item] : "";
}

/* Bytes follow from counts: 8 for each number, 4 for each neighbour, as the structures named beside them
 * hold. They are upper bounds within some 20 %, checked against the peak of whole runs
 * (test/app/results/test_memory.c). */

/* Lattice points with alike neighbourhoods share rows of shape functions
 * (mechanics/galerkin/weak_form/galerkin_rows.c): largest number of different rows, as counted on blocks and
 * bodies with holes, and number of bonds of the part that is evaluated at a time. */
static const double most_different = 4000, part = 5e5;

/* Bytes of shape functions and their derivatives, strains and stresses at all points (galerkin), or of the
 * bonds of peridynamic forces: bits on a lattice, both ends and a coefficient each in a list. rows: points of
 * all bond sets; all: bonds of all sets. */
static double shape_bytes (const pg_forecast *f, double all, double rows)
{
    double d = f->dim, nv = f->dim * (f->dim + 1) / 2, n = f->count.points, bytes;
    int listed = f->is.listed || f->is.by_list, factors = f->linear != NULL;
    double different = all;
    if (f->is.shared && !f->is.interpolates) different = fmin (all, most_different * all / rows + part);
    /* values and strains of rows in galerkin */
    bytes = (16 + 8 * d) * different + rows * (16 * nv + 8 * d + 45) + 24 * f->count.dofs;
    bytes += (12 + 8 * d) * f->count.summed;  /* entries of pg_consistency */
    bytes += (4 + 8 * d * (d + 1)) * f->count.patched;  /* entries of the projected dilatation */
    if (!f->method->shape_functions)  /* peridynamic forces: pg_bond_loop */
        bytes = (listed ? (f->rotations ? 25 + 8 * d : 7) : 0.25) * all + (100 + 16 * f->rotations) * n
                + (factors ? 0 : 8 * f->count.dofs);
    if (f->is.matrixless && f->rotations) /* dilatations of state-based forces */
        bytes += (listed ? 9 : 0.25) * all + (120 + 40 * d) * n;
    return bytes;
}

/* Bytes of vectors of the unknowns (two states of three, thirteen of solvers, two of five numbers a point for
 * results), and of quasi-static solvers without a factor: rows of state-based forces, and the multilevel
 * preconditioner with its finest level and its first coarse matrix. Products with K by shape functions: runs
 * of alike points and sums of overlapping slices, 0.1 kB a point as measured on cubes of 3 000 to 55 000
 * nodes; their quasi-static preconditioner: values of shape functions at the nodes and their transpose, 12
 * bytes an entry each, and the matrix of finite elements, in which a node is coupled to 3^dim nodes; on a
 * coarse grid the functions at each node, twice. Contact: three arrays of columns of the compliance,
 * including columns that stay zero. */
static double vector_bytes (const pg_forecast *f)
{
    double d = f->dim, n = f->count.points, m = d + f->rotations, corners = pow (2, d), bytes;
    int at_rest = !f->is.explicit_ && !f->is.dynamic, small = f->is.explicit_ || mass_dominates (f);
    bytes = (2 * 3 + 13 + 2 * 5) * 8 * f->count.dofs;
    /* state-based rows */
    if (f->is.matrixless && at_rest) bytes += n * (8 * d * d + 19 + (d == 3 ? 72 : 32));
    if (!f->method->shape_functions && !f->linear && at_rest)
        bytes += n * (32 * m + 16 * corners + 16) + n * m * m * 12 * pow (1.25, d);
    if (f->method->shape_functions && !f->linear) bytes += 100 * (f->is.nodal ? n : f->count.evaluation);
    pg_solve_counts c = counts_of (f);
    if (f->method->shape_functions && !f->linear && f->is.elements && !small)
        bytes += pg_solve_on_grid (&c) ? n * (16 * corners + 16 * d)
                                       : 24 * f->count.bonds[PG_NODES] + 8 * m * m * pow (3, d) * n;
    return bytes + 24 * f->count.dofs * f->count.columns * (f->dim == 3 && f->is.pressed == 1 ? 3 : 1);
}

/* Bytes of K with its lists of blocks, and of its factor, if there is one. slaves: eliminated unknowns, which
 * cost a second matrix. 1.45: supernodes store zeros beside entries. Unsymmetric matrices have two
 * factors. */
static void add_matrix_bytes (pg_forecast *f)
{
    double bulk = f->is.nodal        ? f->count.bonds[PG_NODES]
                  : f->count.summed > 0 ? f->count.summed
                                  : f->count.bonds[PG_POINTS];
    double *b = f->bytes;
    b[PG_BYTES_MATRIX] = b[PG_BYTES_FACTOR] = 0;
    if (!f->linear) return;
    int lu = !f->linear->symmetric;
    b[PG_BYTES_MATRIX] = !f->method->shape_functions
                             ? 24 * f->matrix_entries + (f->count.slaves > 0 ? 56 * f->matrix_entries : 0)
                             : 16 * bulk + 4 * f->count.pairs + 24 * f->matrix_entries
                                   + 8 * f->count.eliminated
                                   + (f->count.slaves > 0 ? 56 * f->matrix_entries : 0);
    double entries = lu ? 2 * f->factor_entries : f->factor_entries;
    b[PG_BYTES_FACTOR] = 8 * 1.45 * entries + 16 * f->matrix_entries + (lu ? 48 * f->matrix_entries : 0);
}

/* Bytes of the program and of libraries, which are loaded when they are first needed: a run that draws
 * nothing and solves by products alone takes about 9 MB besides its arrays. Factors, and the coarsest level
 * of preconditioners, load SuiteSparse and BLAS with 6 MB. */
static double program_bytes (const pg_forecast *f)
{
    int factors = f->linear || !(f->is.explicit_ || mass_dominates (f));
    return 9e6 + (factors ? 6e6 : 0);
}

/* Computes the bytes of every item from counts, and their sum. 1.5e6: results of any run, however small;
 * 37e6: pictures, with the libraries that draw them. */
void pg_forecast_sum (pg_forecast *f)
{
    double d = f->dim, n = f->count.points, m = d + f->rotations, *b = f->bytes;
    double all = f->count.bonds[0] + f->count.bonds[1] + f->count.bonds[2],
           rows = n + f->count.evaluation + f->count.facets;
    choose_linear (f);
    f->count.dofs = n * m;
    f->matrix_entries = (f->count.pairs - n) * m * m + n * m * (m + 1) / 2;
    b[PG_BYTES_PROGRAM] = program_bytes (f);
    /* arrays of pg_cloud, pg_cells */
    b[PG_BYTES_POINTS] = n * (8 * d + 12) + f->count.cells * 8 * d * pow (2, d);
    /* arrays of pg_rows */
    b[PG_BYTES_BONDS] = 4 * all + rows * (8 * d + 25);
    b[PG_BYTES_SHAPES] = shape_bytes (f, all, rows);
    /* bytes a bond: two states; arrays of break_loop; the bonds that K was factored with */
    b[PG_BYTES_BREAKING] = (2 + (f->is.explicit_ || !f->is.breaks ? 0 : 17) + (f->linear != NULL)) * all;
    b[PG_BYTES_VECTORS] = vector_bytes (f);
    b[PG_BYTES_RESULTS] = (f->count.fields + 2) * 6 * 8 * n + 1.5e6 + (f->is.pictures ? 37e6 : 0);
    add_matrix_bytes (f);
    f->peak = 0;
    for (int i = 0; i < PG_BYTES_COUNT; i++) f->peak += b[i];
}

/* Estimates the factor by nested dissection, unless an analysis of K has counted it. */
void forecast_factor (pg_forecast *f)
{
    if (f->is.analysed) return;
    dissect (f, &f->factor_entries, &f->factor_flops);
}

/* ---- counts of the built problem ----------------------------------------------------------------------- */
/* Counts nodes whose displacement along axis k the transformation method eliminates (role 1), and their
 * neighbours (role 2): a dense inverse and a dense product for them. */
static void count_slaves (pg_forecast *f, const pg_problem *p, int k, unsigned char *role)
{
    const pg_family *fam = &p->bonds.rows[PG_NODES].family;
    double slaves = 0, masters = 0;
    memset (role, 0, p->cloud.n);
    for (size_t l = 0; l < p->boundary.nload; l++) {
        const pg_load *load = &p->boundary.load[l];
        if (!pg_load_prescribes (load) || !load->value[k] || load->essential != PG_ESSENTIAL_TRANSFORMATION)
            continue;
        for (size_t i = 0; i < load->set->npoint; i++) role[load->set->point[i]] = 1;
    }
    for (size_t i = 0; i < p->cloud.n; i++) {
        slaves += role[i] == 1;
        for (size_t e = fam->start[i]; role[i] == 1 && e < fam->start[i + 1]; e++)
            if (!role[fam->node[e]]) role[fam->node[e]] = 2;
    }
    for (size_t i = 0; i < p->cloud.n; i++) masters += role[i] == 2;
    if (p->form.approx.type->interpolates) masters = 0;
    f->count.slaves += slaves;
    f->count.eliminated += (masters > 0 ? slaves * slaves : 0) + 3 * slaves * masters;
}

/* 1: the bond loop goes through a list, as under `method.evaluation: auto` where bonds do not share one
 * law. */
static int summed_by_list (const pg_problem *p)
{
    const pg_sum_rule *rule = &p->sums->rule;
    return p->sums->stencil.n == 0 || ((p->at.nlaw > 1 || p->at.nlimit > 1) && (!rule->state || rule->beams))
           || rule->surface == PG_SURFACE_VOLUME || rule->evaluation == PG_EVALUATE_LIST;
}

/* Number of forces between crack faces in contact: cracks have pieces two spacings long (2D) or wide and long
 * (3D), each with a force across the faces and, except without friction in 3D, forces along them. Growth adds
 * to them. */
static double contact_columns (const pg_forecast *f, const pg_problem *p)
{
    double pieces = 0;
    for (size_t i = 0; f->is.pressed && i < p->crack.given.n; i++)
        pieces += pg_crack_size (&p->crack.given.crack[i], p->dim) / pow (2 * p->cloud.h, p->dim - 1);
    return pieces * (p->dim == 3 && f->is.pressed == 1 ? 1 : p->dim);
}

/* Takes the counts of the problem itself; the number of coupled node pairs per point stays as it was, since
 * only an analysis of K knows it exactly. */
pg_status pg_forecast_problem (pg_forecast *f, const pg_problem *p)
{
    pg_status status = PG_OK;
    unsigned char *role = NULL;
    double shared = f->count.points > 0 ? f->count.pairs / f->count.points : 0;
    PG_ALLOC (role, p->cloud.n);
    f->count.slaves = f->count.eliminated = 0;
    for (int k = 0; k < p->dim; k++) count_slaves (f, p, k, role);
    f->count.points = (double) p->cloud.n, f->count.cells = (double) p->cells.n;
    f->count.evaluation = (double) p->bonds.rows[PG_POINTS].n,
    f->count.facets = (double) p->bonds.rows[PG_FACETS].n;
    for (int s = 0; s < PG_BOND_SETS; s++)
        f->count.bonds[s] = (double) (p->bonds.first[s + 1] - p->bonds.first[s]);
    f->count.pairs = !p->method->shape_functions ? 0.5 * f->count.bonds[PG_NODES] + f->count.points
                                                 : shared * f->count.points;
    f->is.matrixless = p->sums && p->sums->rule.state;
    f->method = p->method, f->is.listed = p->sums && p->sums->stencil.n == 0,
    f->is.by_list = p->sums && summed_by_list (p), f->rotations = pg_problem_rotations (p);
    f->count.summed = p->form.consistency
                    ? (double) (p->form.consistency->family.start[p->form.consistency->family.n]
                                + p->form.consistency->face.family.start[p->form.consistency->face.n])
                    : 0;
    f->count.patched = p->form.patches ? (double) p->form.patches->family.start[p->form.patches->n] : 0;
    f->horizon = p->form.approx.horizon, f->spacing = p->cloud.h;
    f->count.columns = contact_columns (f, p);
    f->is.behind = pg_solve_count (p).behind, f->is.scattered = pg_solve_count (p).scattered;
    /* event stepping keeps its factor if there is neither contact nor crack growth (event_stepping.c) */
    f->is.events = f->is.events && !f->is.pressed && !pg_problem_grows (p);
    f->is.counted = 1;
    forecast_factor (f);
    pg_forecast_sum (f);
done:
    pg_free (role);
    return status;
}

/* Takes the counts of an ordering of K that was computed, in place of all estimates of the factor. */
void pg_forecast_analysed (pg_forecast *f, double pairs, const char *ordering, double entries, double flops)
{
    f->count.pairs = pairs, f->factor_entries = entries, f->factor_flops = flops;
    f->is.analysed = 1;
    snprintf (f->ordering, sizeof f->ordering, "%s", ordering);
    pg_forecast_sum (f);
}

/* ---- runs that fit into the memory --------------------------------------------------------------------- */
/* Returns the forecast for another spacing h': counts of the body times (h / h')^dim, of faces with one power
 * less, the factor as dissection scales it. Points at the vertices of n cells along an edge are n + 1. */
pg_forecast pg_forecast_at (const pg_forecast *f, double spacing)
{
    pg_forecast g = *f;
    double finer = f->spacing / spacing, more = pow (finer, f->dim), entries, flops,
           known = f->factor_entries, known_flops = f->factor_flops;
    double nodes = 1;
    g.spacing = spacing;
    for (int k = 0; k < f->dim; k++) {
        double edge = f->is.behind || !(f->edge[k] > 1) ? f->edge[k] * finer : 1 + (f->edge[k] - 1) * finer;
        g.edge[k] = edge, nodes *= edge / f->edge[k];
    }
    g.count.points *= nodes, g.count.cells *= more, g.count.evaluation *= more, g.count.pairs *= nodes,
        g.count.summed *= more;
    g.count.facets *= more / finer, g.count.slaves *= more / finer,
        g.count.eliminated *= more * more / (finer * finer);
    g.count.bonds[PG_NODES] *= nodes, g.count.bonds[PG_POINTS] *= more,
        g.count.bonds[PG_FACETS] *= more / finer;
    for (int k = 0; k < f->dim; k++) g.step[k] /= finer;
    dissect (f, &entries, &flops);
    dissect (&g, &g.factor_entries, &g.factor_flops);
    if (entries > 0) g.factor_entries *= known / entries, g.factor_flops *= known_flops / flops;
    g.is.counted = g.is.analysed = 0;
    pg_forecast_sum (&g);
    return g;
}

/* Finest spacing whose run fits into memory, m, by bisection over its logarithm, rounded up to two digits;
 * INFINITY: none fits. */
double pg_forecast_fitting (const pg_forecast *f, double available)
{
    double fine = log (f->spacing), coarse = fine + log (1e6);
    if (pg_forecast_at (f, exp (coarse)).peak > available) return INFINITY;
    for (int k = 0; k < 60; k++) {
        double middle = 0.5 * (fine + coarse);
        if (pg_forecast_at (f, exp (middle)).peak > available) fine = middle;
        else coarse = middle;
    }
    double unit = pow (10, floor (coarse / log (10)) - 1);
    return ceil (exp (coarse) / unit) * unit;
}

/* Writes bytes with a unit, such as "3.1 GB". */
static const char *in_words (char *text, size_t size, double bytes)
{
    static const char *const unit[] = { "B", "kB", "MB", "GB", "TB", "PB", "EB" };
    int k = 0;
    for (; k < 6 && bytes >= 999.5; k++) bytes /= 1000;
    snprintf (text, size, "%.3g %s", bytes, unit[k]);
    return text;
}

/* Appends what an alternative needs, such as "; method.integration: nodal needs about 3.1 GB (fits)". */
static void alternative (const pg_forecast *g, const char *what, double available, char *text, size_t size)
{
    char words[32];
    size_t used = strlen (text);
    snprintf (text + used, size - used, "; %s %s%s", what, in_words (words, sizeof words, g->peak),
              g->peak <= available ? " (fits)" : "");
}

/* Fails if the run needs more memory than is available; the message names what takes it, and what would fit:
 * a spacing, nodal integration, conjugate gradients, a 2D model. */
pg_status pg_forecast_afford (const pg_forecast *f, double available)
{
    char text[1200] = "", need[32], have[32], items[400] = "", word[32];
    size_t used = 0;
    if (f->peak <= available) return PG_OK;
    for (int i = PG_BYTES_POINTS; i < PG_BYTES_COUNT; i++)
        if (f->bytes[i] > 0.05 * f->peak)
            used += (size_t) snprintf (items + used, sizeof items - used, "%s%s %s", used ? ", " : "",
                                       pg_forecast_item (i), in_words (word, sizeof word, f->bytes[i]));
    double fit = pg_forecast_fitting (f, available);
    if (isfinite (fit)) snprintf (text, sizeof text, "; a spacing of %.3g m or more fits", fit);
    if (!f->is.nodal && f->method->shape_functions) {
        pg_forecast g = *f;
        double share = f->count.bonds[PG_POINTS] > 0 ? f->count.bonds[PG_NODES] / f->count.points
                                                           * f->count.evaluation / f->count.bonds[PG_POINTS]
                                                     : 1;
        g.is.nodal = 1, g.count.evaluation = 0, g.count.bonds[PG_POINTS] = 0,
        g.count.pairs *= fmin (1, 0.55 * share), g.factor_entries *= 0.55, g.is.analysed = 1;
        pg_forecast_sum (&g);
        alternative (&g, "method.integration: nodal needs about", available, text, sizeof text);
    }
    if (f->linear) {
        pg_forecast g = *f;
        g.is.automatic = 0;
        g.linear = NULL;
        pg_forecast_sum (&g);
        char words[80];
        snprintf (words, sizeof words, "solver.linear: %s needs about", pg_linear_first (1, 0)->name);
        alternative (&g, words, available, text, sizeof text);
    }
    size_t at = strlen (text);
    if (f->dim == 3)
        snprintf (text + at, sizeof text - at, "; a plane model (dimension: 2) has about %.2g points",
                  pow (f->count.points, 2.0 / 3));
    return pg_error (PG_E_LIMIT, PG_HERE,
                     "the run would need about %s of memory, and %s are available: %.4g points at spacing "
                     "%.4g m, %.4g bonds, "
                     "%.3g entries in the stiffness matrix (%s)%s",
                     in_words (need, sizeof need, f->peak), in_words (have, sizeof have, available),
                     f->count.points, f->spacing, f->count.bonds[0] + f->count.bonds[1] + f->count.bonds[2],
                     f->matrix_entries, items, text);
}

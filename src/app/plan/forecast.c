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
/* How many parts of one level have so many separators among their faces: 0, 1 or 2 along each axis. All
 * parts of a level have the same size, so that 27 numbers stand for up to 2^level parts. */
typedef struct { double count[3][3][3]; } parts;

/* Every part is cut across axis k: both halves have one face more that is a separator, unless there were
 * two. */
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
/* As the solver decides under `auto`: no factor where the mass dominates (conjugate gradients then need some
 * 40 iterations at most, which takes beta dt^2 omega^2 <= 9 with omega = 2 c_p / h), nor where iterations
 * with finite elements cost less (solve_costs.c). */
static pg_solve_counts counts_of (const pg_forecast *f)
{
    int set = f->nodal ? PG_NODES : PG_POINTS;
    pg_solve_counts c = { .dim = f->dim,
                          .components = f->dim,
                          .order = f->order,
                          .interpolates = f->interpolates,
                          .projected = f->patched > 0,
                          .behind = f->behind,
                          .scattered = f->scattered,
                          .points = f->points,
                          .evaluation = f->nodal ? f->points : f->evaluation,
                          .bonds = f->bonds[set],
                          .reach = f->horizon / f->spacing,
                          .columns = f->columns };
    for (int k = 0; k < 3; k++) c.edge[k] = f->edge[k];
    return c;
}

static int by_elements (const pg_forecast *f)
{
    pg_solve_counts c = counts_of (f);
    return pg_solve_by_elements (&c, f->elements, f->events, f->dynamic);
}

/* In small time steps of implicit dynamics, where the diagonal does as preconditioner. */
static int mass_dominates (const pg_forecast *f)
{
    return f->dynamic && f->weight <= 9 * f->spacing * f->spacing;
}

static void choose_linear (pg_forecast *f)
{
    if (!f->automatic) return;
    int none = f->explicit_ || f->matrixless ? 1
               : mass_dominates (f) ? 1
               : !f->method->shape_functions
                   ? !f->dynamic
                         && pg_method_iterates (f->method, 1, f->dim, f->points * (f->dim + f->rotations))
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

/* Where points of a lattice share their rows (mechanics/galerkin/weak_form/galerkin_rows.c): different
 * rows at most, as counted on
 * blocks and bodies with holes, and bonds of a part that is evaluated at a time. */
static const double most_different = 4000, part = 5e5;

/* Shape functions and their derivatives, strains and stresses at all points (galerkin), or the bonds of
 * forces that carry them alone: bits on a lattice, ends and a coefficient each in a list. rows: points of
 * all sets; all: bonds of all sets. */
static double shape_bytes (const pg_forecast *f, double all, double rows)
{
    double d = f->dim, nv = f->dim * (f->dim + 1) / 2, n = f->points, bytes;
    int listed = f->listed || f->by_list, factors = f->linear != NULL;
    double different = all;
    if (f->shared && !f->interpolates) different = fmin (all, most_different * all / rows + part);
    bytes = (16 + 8 * d) * different + rows * (16 * nv + 8 * d + 45) + 24 * f->dofs;       /* galerkin */
    bytes += (12 + 8 * d) * f->summed;  /* pg_consistency */
    bytes += (4 + 8 * d * (d + 1)) * f->patched;  /* galerkin_dilatation */
    if (!f->method->shape_functions)  /* pg_bond_loop, bond */
        bytes = (listed ? (f->rotations ? 25 + 8 * d : 7) : 0.25) * all + (100 + 16 * f->rotations) * n
                + (factors ? 0 : 8 * f->dofs);
    if (f->matrixless && f->rotations)                                                     /* dilatations */
        bytes += (listed ? 9 : 0.25) * all + (120 + 40 * d) * n;
    return bytes;
}

/* Vectors of the unknowns (two states of three, thirteen of solvers, two of five numbers a point for
 * results), and what solves at rest without a factor add: rows of state-based forces, and the multilevel
 * preconditioner with its finest level and its first coarse matrix. Products with K by shape functions: runs
 * of points that are alike and sums of slices that overlap, 0.1 kB a point as measured on cubes of 3 000 to
 * 55 000 nodes; their preconditioner at rest: values of shape functions at the nodes and their transpose, 12
 * bytes an entry each, and the matrix of finite elements, whose nodes see 3^dim others; on a coarse grid the
 * functions at each node, twice. Contact: three arrays
 * of columns of the compliance, also of those that stay zero. */
static double vector_bytes (const pg_forecast *f)
{
    double d = f->dim, n = f->points, m = d + f->rotations, corners = pow (2, d), bytes;
    int at_rest = !f->explicit_ && !f->dynamic, small = f->explicit_ || mass_dominates (f);
    bytes = (2 * 3 + 13 + 2 * 5) * 8 * f->dofs;
    if (f->matrixless && at_rest) bytes += n * (8 * d * d + 19 + (d == 3 ? 72 : 32));      /* lps_rows.c */
    if (!f->method->shape_functions && !f->linear && at_rest)
        bytes += n * (32 * m + 16 * corners + 16) + n * m * m * 12 * pow (1.25, d);
    if (f->method->shape_functions && !f->linear) bytes += 100 * (f->nodal ? n : f->evaluation);
    pg_solve_counts c = counts_of (f);
    if (f->method->shape_functions && !f->linear && f->elements && !small)
        bytes += pg_solve_on_grid (&c) ? n * (16 * corners + 16 * d)
                                       : 24 * f->bonds[PG_NODES] + 8 * m * m * pow (3, d) * n;
    return bytes + 24 * f->dofs * f->columns * (f->dim == 3 && f->pressed == 1 ? 3 : 1);
}

/* K with its lists of blocks, and its factor, where there is one; slaves: unknowns that elimination takes
 * out, which costs a second matrix. 1.45: supernodes store zeros beside entries. General matrices have
 * two factors. */
static void add_matrix_bytes (pg_forecast *f)
{
    double bulk = f->nodal        ? f->bonds[PG_NODES]
                  : f->summed > 0 ? f->summed
                                  : f->bonds[PG_POINTS];
    double *b = f->bytes;
    b[PG_BYTES_MATRIX] = b[PG_BYTES_FACTOR] = 0;
    if (!f->linear) return;
    int lu = !f->linear->symmetric;
    b[PG_BYTES_MATRIX] = !f->method->shape_functions
                             ? 24 * f->matrix_entries + (f->slaves > 0 ? 56 * f->matrix_entries : 0)
                             : 16 * bulk + 4 * f->pairs + 24 * f->matrix_entries + 8 * f->eliminated
                                   + (f->slaves > 0 ? 56 * f->matrix_entries : 0);
    double entries = lu ? 2 * f->factor_entries : f->factor_entries;
    b[PG_BYTES_FACTOR] = 8 * 1.45 * entries + 16 * f->matrix_entries + (lu ? 48 * f->matrix_entries : 0);
}

/* Program and libraries, which are loaded when they are first needed: a run that draws nothing and solves by
 * products alone takes about 9 MB besides its arrays. Factors, and the coarsest level of preconditioners,
 * take SuiteSparse and BLAS with 6 MB. */
static double program_bytes (const pg_forecast *f)
{
    int factors = f->linear || !(f->explicit_ || mass_dominates (f));
    return 9e6 + (factors ? 6e6 : 0);
}

/* Bytes from counts, and their sum. Of each pair of phases that do not meet, the larger counts. 1.5e6: of any
 * run, however small; 37e6: pictures, with the libraries that draw them. */
void pg_forecast_sum (pg_forecast *f)
{
    double d = f->dim, n = f->points, m = d + f->rotations, *b = f->bytes;
    double all = f->bonds[0] + f->bonds[1] + f->bonds[2], rows = n + f->evaluation + f->facets;
    choose_linear (f);
    f->dofs = n * m;
    f->matrix_entries = (f->pairs - n) * m * m + n * m * (m + 1) / 2;
    b[PG_BYTES_PROGRAM] = program_bytes (f);
    b[PG_BYTES_POINTS] = n * (8 * d + 12) + f->cells * 8 * d * pow (2, d);  /* pg_cloud, pg_cells */
    b[PG_BYTES_BONDS] = 4 * all + rows * (8 * d + 25);                                     /* pg_rows */
    b[PG_BYTES_SHAPES] = shape_bytes (f, all, rows);
    /* states; break_loop; factored */
    b[PG_BYTES_BREAKING] = (2 + (f->explicit_ || !f->breaks ? 0 : 17) + (f->linear != NULL)) * all;
    b[PG_BYTES_VECTORS] = vector_bytes (f);
    b[PG_BYTES_RESULTS] = (f->fields + 2) * 6 * 8 * n + 1.5e6 + (f->pictures ? 37e6 : 0);
    add_matrix_bytes (f);
    f->peak = 0;
    for (int i = 0; i < PG_BYTES_COUNT; i++) f->peak += b[i];
}

/* By the law of dissection, unless an analysis has counted. */
void forecast_factor (pg_forecast *f)
{
    if (f->analysed) return;
    dissect (f, &f->factor_entries, &f->factor_flops);
}

/* ---- from the problem ---------------------------------------------------------------------------------- */
/* Nodes that transformation eliminates along axis k (role 1), and those that they see (role 2): a dense
 * inverse and a dense product each. */
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
    f->slaves += slaves;
    f->eliminated += (masters > 0 ? slaves * slaves : 0) + 3 * slaves * masters;
}

/* As the loop over bonds decides under `auto`, which takes a stencil where one law serves all points. */
static int summed_by_list (const pg_problem *p)
{
    const pg_sum_rule *rule = &p->sums->rule;
    return p->sums->stencil.n == 0 || ((p->at.nlaw > 1 || p->at.nlimit > 1) && (!rule->state || rule->beams))
           || rule->surface == PG_SURFACE_VOLUME || rule->evaluation == PG_EVALUATE_LIST;
}

/* Forces between faces in contact: of pieces of cracks, two spacings long (2D) or wide and long (3D), across
 * the faces and, but without friction in space, along them. Growth adds to them. */
static double contact_columns (const pg_forecast *f, const pg_problem *p)
{
    double pieces = 0;
    for (size_t i = 0; f->pressed && i < p->crack.given.n; i++)
        pieces += pg_crack_size (&p->crack.given.crack[i], p->dim) / pow (2 * p->cloud.h, p->dim - 1);
    return pieces * (p->dim == 3 && f->pressed == 1 ? 1 : p->dim);
}

/* Counts of the problem itself; pairs of nodes keep their number per point, which only an analysis knows
 * exactly. */
pg_status pg_forecast_problem (pg_forecast *f, const pg_problem *p)
{
    pg_status status = PG_OK;
    unsigned char *role = NULL;
    double shared = f->points > 0 ? f->pairs / f->points : 0;
    PG_ALLOC (role, p->cloud.n);
    f->slaves = f->eliminated = 0;
    for (int k = 0; k < p->dim; k++) count_slaves (f, p, k, role);
    f->points = (double) p->cloud.n, f->cells = (double) p->cells.n;
    f->evaluation = (double) p->bonds.rows[PG_POINTS].n, f->facets = (double) p->bonds.rows[PG_FACETS].n;
    for (int s = 0; s < PG_BOND_SETS; s++) f->bonds[s] = (double) (p->bonds.first[s + 1] - p->bonds.first[s]);
    f->pairs = !p->method->shape_functions ? 0.5 * f->bonds[PG_NODES] + f->points : shared * f->points;
    f->matrixless = p->sums && p->sums->rule.state;
    f->method = p->method, f->listed = p->sums && p->sums->stencil.n == 0,
    f->by_list = p->sums && summed_by_list (p), f->rotations = pg_problem_rotations (p);
    f->summed = p->form.consistency
                    ? (double) (p->form.consistency->family.start[p->form.consistency->family.n]
                                + p->form.consistency->face.family.start[p->form.consistency->face.n])
                    : 0;
    f->patched = p->form.patches ? (double) p->form.patches->family.start[p->form.patches->n] : 0;
    f->horizon = p->form.approx.horizon, f->spacing = p->cloud.h;
    f->columns = contact_columns (f, p);
    f->behind = pg_solve_count (p).behind, f->scattered = pg_solve_count (p).scattered;
    /* from event to event by a factor that is kept: bonds one by one without contact (event_stepping.c) */
    f->events = f->events && !f->pressed && !pg_problem_grows (p);
    f->counted = 1;
    forecast_factor (f);
    pg_forecast_sum (f);
done:
    pg_free (role);
    return status;
}

/* An ordering was made: its counts take the place of all estimates of the factor. */
void pg_forecast_analysed (pg_forecast *f, double pairs, const char *ordering, double entries, double flops)
{
    f->pairs = pairs, f->factor_entries = entries, f->factor_flops = flops;
    f->analysed = 1;
    snprintf (f->ordering, sizeof f->ordering, "%s", ordering);
    pg_forecast_sum (f);
}

/* ---- what would fit ------------------------------------------------------------------------------------ */
/* Counts scaled from one spacing to another: bodies with (h / h')^dim, faces with one power less, the
 * factor as dissection scales it. Points at the vertices of n cells along an edge are n + 1. */
pg_forecast pg_forecast_at (const pg_forecast *f, double spacing)
{
    pg_forecast g = *f;
    double finer = f->spacing / spacing, more = pow (finer, f->dim), entries, flops,
           known = f->factor_entries, known_flops = f->factor_flops;
    double nodes = 1;
    g.spacing = spacing;
    for (int k = 0; k < f->dim; k++) {
        double edge = f->behind || !(f->edge[k] > 1) ? f->edge[k] * finer : 1 + (f->edge[k] - 1) * finer;
        g.edge[k] = edge, nodes *= edge / f->edge[k];
    }
    g.points *= nodes, g.cells *= more, g.evaluation *= more, g.pairs *= nodes, g.summed *= more;
    g.facets *= more / finer, g.slaves *= more / finer, g.eliminated *= more * more / (finer * finer);
    g.bonds[PG_NODES] *= nodes, g.bonds[PG_POINTS] *= more, g.bonds[PG_FACETS] *= more / finer;
    for (int k = 0; k < f->dim; k++) g.step[k] /= finer;
    dissect (f, &entries, &flops);
    dissect (&g, &g.factor_entries, &g.factor_flops);
    if (entries > 0) g.factor_entries *= known / entries, g.factor_flops *= known_flops / flops;
    g.counted = g.analysed = 0;
    pg_forecast_sum (&g);
    return g;
}

/* By bisection over the logarithm of the spacing, rounded up to two digits; INFINITY: nothing would fit. */
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

/* "3.1 GB". */
static const char *in_words (char *text, size_t size, double bytes)
{
    static const char *const unit[] = { "B", "kB", "MB", "GB", "TB", "PB", "EB" };
    int k = 0;
    for (; k < 6 && bytes >= 999.5; k++) bytes /= 1000;
    snprintf (text, size, "%.3g %s", bytes, unit[k]);
    return text;
}

/* "; with method.integration: nodal 3.1 GB" */
static void alternative (const pg_forecast *g, const char *what, double available, char *text, size_t size)
{
    char words[32];
    size_t used = strlen (text);
    snprintf (text + used, size - used, "; %s %s%s", what, in_words (words, sizeof words, g->peak),
              g->peak <= available ? " (fits)" : "");
}

/* The refusal names what takes the memory, and what would fit: a spacing, nodal integration, conjugate
 * gradients, a plane model. */
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
    if (!f->nodal && f->method->shape_functions) {
        pg_forecast g = *f;
        double share = f->bonds[PG_POINTS] > 0
                           ? f->bonds[PG_NODES] / f->points * f->evaluation / f->bonds[PG_POINTS]
                           : 1;
        g.nodal = 1, g.evaluation = 0, g.bonds[PG_POINTS] = 0, g.pairs *= fmin (1, 0.55 * share),
        g.factor_entries *= 0.55, g.analysed = 1;
        pg_forecast_sum (&g);
        alternative (&g, "method.integration: nodal needs about", available, text, sizeof text);
    }
    if (f->linear) {
        pg_forecast g = *f;
        g.automatic = 0;
        g.linear = NULL;
        pg_forecast_sum (&g);
        char words[80];
        snprintf (words, sizeof words, "solver.linear: %s needs about", pg_linear_first (1, 0)->name);
        alternative (&g, words, available, text, sizeof text);
    }
    size_t at = strlen (text);
    if (f->dim == 3)
        snprintf (text + at, sizeof text - at, "; a plane model (dimension: 2) has about %.2g points",
                  pow (f->points, 2.0 / 3));
    return pg_error (PG_E_LIMIT, PG_HERE,
                     "the run would need about %s of memory, and %s are available: %.4g points at spacing "
                     "%.4g m, %.4g bonds, "
                     "%.3g entries in the stiffness matrix (%s)%s",
                     in_words (need, sizeof need, f->peak), in_words (have, sizeof have, available),
                     f->points, f->spacing, f->bonds[0] + f->bonds[1] + f->bonds[2], f->matrix_entries, items,
                     text);
}

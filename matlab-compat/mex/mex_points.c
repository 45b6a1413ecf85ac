/* SPDX-License-Identifier: GPL-3.0-or-later
 * Commands on points: families, shape functions, constants, and forces of bonds. */
#include "perigal_mex.h"
#include <string.h>

static void clear_cloud (void *p) { pg_cloud_clear (p); }
static void clear_family (void *p) { pg_family_clear (p); }
static void clear_rows (void *p) { pg_rows_clear (p); }

/* 'length' (text): metres of "5 mm". */
int command_length (const call *c)
{
    const char *text;
    double value;
    if (take_count (c, 1, 1) || take_text (c, 0, "a length", &text)) return 1;
    if (!text) return fault ("perigal:argument", "a length is empty");
    if (pg_unit_parse (&value, text, "m") != PG_OK) return fault ("perigal:argument", "%s", pg_last_error ());
    give (c, 0, number_of (value));
    return 0;
}

/* Points from arguments k (x), k + 1 (volumes or []), k + 2 (spacing, 0: by volumes), k + 3 (thickness). */
static int take_points (const call *c, int k, pg_cloud **out)
{
    size_t n, dim, nvolume;
    double *x, *volume, spacing, thickness;
    if (take_matrix (c, k, "points", 0, 0, &n, &dim, &x)) return 1;
    if (take_matrix (c, k + 1, "volumes", 1, 1, &nvolume, NULL, &volume)) return 1;
    if (take_number (c, k + 2, "spacing", &spacing) || take_number (c, k + 3, "thickness", &thickness)) return 1;
    if (dim > 3) return fault ("perigal:argument", "points have %zu columns, not 1, 2 or 3", dim);
    if (volume && nvolume != n)
        return fault ("perigal:argument", "there are %zu volumes of %zu points", nvolume, n);
    pg_cloud *cloud = hold (sizeof *cloud, clear_cloud);
    if (!cloud) return 1;
    *out = cloud;
    return failed (c, pg_cloud_of_arrays (cloud, (int) dim, n, x, volume, spacing, thickness));
}

/* Compressed lists with numbers from 1. */
static void give_lists (const call *c, const pg_family *f)
{
    size_t n = f->start[f->n];
    mxArray *start = mxCreateDoubleMatrix ((mwSize) f->n + 1, 1, mxREAL),
            *node = mxCreateDoubleMatrix ((mwSize) n, 1, mxREAL);
    for (size_t i = 0; i <= f->n; i++) mxGetPr (start)[i] = (double) f->start[i] + 1;
    for (size_t e = 0; e < n; e++) mxGetPr (node)[e] = (double) f->node[e] + 1;
    give (c, 0, start);
    give (c, 1, node);
}

/* 'family' (x, volumes, spacing, thickness, centres or [], horizon, support, closed): start, node */
int command_family (const call *c)
{
    pg_cloud *cloud;
    size_t n;
    double *centre, horizon;
    int tensor, closed;
    if (take_count (c, 8, 8) || take_points (c, 0, &cloud)) return 1;
    if (take_matrix (c, 4, "centres", (size_t) cloud->dim, 1, &n, NULL, &centre)) return 1;
    if (take_number (c, 5, "horizon", &horizon) || take_word (c, 6, "support", "radial|tensor", &tensor)
        || take_integer (c, 7, "closed", 0, 1, &closed))
        return 1;
    if (!(horizon > 0) || horizon > 1e300) return fault ("perigal:argument", "the horizon must be above 0");
    pg_family *f = hold (sizeof *f, clear_family);
    if (!f) return 1;
    if (failed (c, pg_family_build (f, cloud, centre ? n : cloud->n, centre ? centre : cloud->x, horizon,
                                    tensor ? PG_TENSOR : PG_RADIAL, closed)))
        return 1;
    give_lists (c, f);
    return 0;
}

/* The entry e of place i: of N (component < 0), or of a derivative. */
static double entry_of (const pg_rows *r, size_t i, size_t e, int component)
{
    size_t at = e + pg_rows_offset (r, i);
    return component < 0 ? r->N[at] : r->dN[at * (size_t) r->dim + (size_t) component];
}

/* N or a derivative as a sparse matrix places x points. Rows of the library are columns here, each filled in the
 * order of the places; zeros, those of cut bonds, are left out. */
static mxArray *rows_of (const pg_rows *r, size_t npoint, int component)
{
    const pg_family *f = &r->family;
    mwIndex *next = mxCalloc (npoint + 1, sizeof *next), nnz = 0;
    for (size_t i = 0; i < r->n; i++)
        for (size_t e = f->start[i]; e < f->start[i + 1]; e++)
            if (entry_of (r, i, e, component) != 0) next[f->node[e]]++, nnz++;
    mxArray *a = mxCreateSparse ((mwSize) r->n, (mwSize) npoint, (mwSize) (nnz ? nnz : 1), mxREAL);
    mwIndex *row = mxGetIr (a), *start = mxGetJc (a);
    double *value = mxGetPr (a);
    start[0] = 0;
    for (size_t j = 0; j < npoint; j++) start[j + 1] = start[j] + next[j];
    memcpy (next, start, npoint * sizeof *next);
    for (size_t i = 0; i < r->n; i++)
        for (size_t e = f->start[i]; e < f->start[i + 1]; e++) {
            double v = entry_of (r, i, e, component);
            if (v == 0) continue;
            mwIndex to = next[f->node[e]]++;
            row[to] = (mwIndex) i, value[to] = v;
        }
    mxFree (next);
    return a;
}

static int take_choice (const call *c, int k, pg_shape_choice *o)
{
    return take_text (c, k, "approximation", &o->approximation) || take_text (c, k + 1, "kernel", &o->kernel)
           || take_text (c, k + 2, "support", &o->support) || take_text (c, k + 3, "weights", &o->weights)
           || take_text (c, k + 4, "degenerate", &o->degenerate)
           || take_integer (c, k + 5, "order", 1, 2, &o->order) || take_number (c, k + 6, "horizon", &o->horizon);
}

/* 'shape' (x, volumes, spacing, thickness, places or [], alive or [], approximation, kernel, support, weights,
 * degenerate, order, horizon): N, {dN}, grade */
int command_shape (const call *c)
{
    pg_cloud *cloud;
    pg_shape_choice choice;
    size_t n;
    double *place;
    unsigned char *alive = NULL;
    if (take_count (c, 13, 13) || take_points (c, 0, &cloud) || take_choice (c, 6, &choice)) return 1;
    if (take_matrix (c, 4, "places", (size_t) cloud->dim, 1, &n, NULL, &place)) return 1;
    pg_rows *r = hold (sizeof *r, clear_rows);
    if (!r) return 1;
    if (failed (c, pg_shape_functions (r, &choice, cloud, n, place, NULL, 1))) return 1;
    if (!mxIsEmpty (c->in[5])) {
        if (take_flags (c, 5, "alive", r->family.start[r->n], &alive)) return 1;
        pg_rows_clear (r);
        if (failed (c, pg_shape_functions (r, &choice, cloud, n, place, alive, 1))) return 1;
    }
    give (c, 0, rows_of (r, cloud->n, -1));
    mxArray *cell = mxCreateCellMatrix (1, (mwSize) r->dim), *grade;
    for (int k = 0; k < r->dim; k++) mxSetCell (cell, (mwIndex) k, rows_of (r, cloud->n, k));
    give (c, 1, cell);
    grade = mxCreateDoubleMatrix ((mwSize) r->n, 1, mxREAL);
    for (size_t i = 0; i < r->n; i++) mxGetPr (grade)[i] = r->grade[i];
    give (c, 2, grade);
    return 0;
}

static const pg_mode modes[] = { PG_PLANE_STRESS, PG_PLANE_STRAIN, PG_SOLID, PG_LINE };
#define MODES "stress|strain|solid|bar"

/* 'constants' (mode, kernel, horizon, E, nu, thickness, G0 or 0, spacing or 0): structure */
int command_constants (const call *c)
{
    pg_bond_choice o = { .mode = PG_SOLID };
    pg_bond_constants k;
    int mode;
    if (take_count (c, 8, 8) || take_word (c, 0, "mode", MODES, &mode) || take_text (c, 1, "kernel", &o.kernel)
        || take_number (c, 2, "horizon", &o.horizon) || take_number (c, 3, "Young's modulus", &o.modulus)
        || take_number (c, 4, "Poisson's ratio", &o.poisson) || take_number (c, 5, "thickness", &o.thickness)
        || take_number (c, 6, "fracture energy", &o.fracture_energy)
        || take_number (c, 7, "spacing", &o.spacing))
        return 1;
    o.mode = modes[mode];
    if (failed (c, pg_bond_constants_find (&k, &o))) return 1;
    mxArray *s = mxCreateStructMatrix (1, 1, 0, NULL);
    const struct { const char *name; double value; } item[] = {
        { "bond_poisson", k.bond_poisson }, { "micromodulus", k.micromodulus }, { "calibration", k.calibration },
        { "critical_stretch", k.stretch },  { "toughness", k.toughness },       { "growth", k.growth },
        { "dilation", k.dilation },         { "deviation", k.deviation },
        { "state_stretch", k.state_stretch }, { "beam_poisson", k.beam_poisson }, { "beam_axial", k.axial },
        { "beam_shear", k.shear },          { "beam_bending", k.bending },
        { "energy_density", k.energy },
    };
    for (size_t i = 0; i < sizeof item / sizeof *item; i++) put (s, item[i].name, number_of (item[i].value));
    put (s, "beam_limits", full_of (1, 3, k.beam_limit));
    give (c, 0, s);
    return 0;
}

/* ---- forces of bonds ----------------------------------------------------------------------------------- */
/* 'bonds_open' (x, volumes, spacing, thickness, mode, kernel, horizon, partial, surface, calibrate, stretch,
 * evaluation, c, threads): handle */
int command_bonds_open (const call *c)
{
    pg_cloud *cloud;
    pg_sum_rule rule = { .threads = 1 };
    const char *kernel;
    int mode, partial, surface, evaluation;
    double modulus;
    pg_bond_sum *sum;
    if (take_count (c, 14, 14) || take_points (c, 0, &cloud) || take_word (c, 4, "mode", MODES, &mode)
        || take_text (c, 5, "kernel", &kernel) || take_number (c, 6, "horizon", &rule.horizon)
        || take_word (c, 7, "partial_volume", "none|linear|overlap", &partial)
        || take_word (c, 8, "surface_correction", "none|product|volume", &surface)
        || take_integer (c, 9, "calibrate", 0, 1, &rule.calibrate)
        || take_word (c, 10, "stretch", "linear|finite", &rule.finite)
        || take_word (c, 11, "evaluation", "auto|stencil|list|fft", &evaluation)
        || take_number (c, 12, "micromodulus", &modulus)
        || take_integer (c, 13, "threads", 1, 64, &rule.threads))
        return 1;
    rule.mode = modes[mode], rule.kernel = pg_kernel_find (kernel ? kernel : "");
    rule.partial = (pg_partial) partial, rule.surface = (pg_surface) surface;
    rule.evaluation = (pg_evaluation) evaluation;
    if (!rule.kernel)
        return fault ("perigal:argument", "there is no kernel '%s': %s", kernel ? kernel : "", pg_kernel_names ());
    if (failed (c, pg_bond_sum_create (&sum, cloud, &rule, modulus))) return 1;
    mxArray *handle = give_handle (KIND_BONDS, sum);
    if (!handle) return 1;
    give (c, 0, handle);
    return 0;
}

/* 'bonds_force' (handle, u): f, W */
int command_bonds_force (const call *c)
{
    size_t n, dim;
    double *u, *f, *W = NULL;
    if (take_count (c, 2, 2)) return 1;
    pg_bond_sum *s = take_handle (c, 0, KIND_BONDS);
    if (!s || take_matrix (c, 1, "displacements", 0, 0, &n, &dim, &u)) return 1;
    if (n != pg_bond_sum_family (s, NULL)->n || (int) dim != pg_bond_sum_dim (s))
        return fault ("perigal:argument", "displacements are %zu x %zu, not %zu x %d", n, dim,
                      pg_bond_sum_family (s, NULL)->n, pg_bond_sum_dim (s));
    f = hold (n * dim * sizeof *f, NULL);
    if (!f || (c->nout > 1 && !(W = hold (n * sizeof *W, NULL)))) return 1;
    if (failed (c, pg_bond_sum_force (s, u, f, W))) return 1;
    give (c, 0, full_of (n, dim, f));
    if (W) give (c, 1, full_of (n, 1, W));
    return 0;
}

static mxArray *flags_of (size_t n, const unsigned char *flag)
{
    mxArray *a = mxCreateLogicalMatrix ((mwSize) n, 1);
    for (size_t i = 0; i < n; i++) mxGetLogicals (a)[i] = flag[i] != 0;
    return a;
}

/* 'bonds_list' (handle): structure of columns, an entry a bond and direction */
int command_bonds_list (const call *c)
{
    const unsigned char *alive;
    double modulus;
    if (take_count (c, 1, 1)) return 1;
    pg_bond_sum *s = take_handle (c, 0, KIND_BONDS);
    if (!s) return 1;
    const pg_family *f = pg_bond_sum_family (s, &alive);
    size_t n = f->start[f->n], dim = (size_t) pg_bond_sum_dim (s);
    double *xi = hold ((n * dim + 1) * sizeof *xi, NULL), *weight = hold ((n + 1) * sizeof *weight, NULL),
           *beta = hold ((n + 1) * sizeof *beta, NULL);
    if (!xi || !weight || !beta) return 1;
    pg_bond_sum_bonds (s, xi, weight, beta, &modulus);
    mxArray *list = mxCreateStructMatrix (1, 1, 0, NULL), *i = mxCreateDoubleMatrix ((mwSize) n, 1, mxREAL),
            *j = mxCreateDoubleMatrix ((mwSize) n, 1, mxREAL);
    for (size_t p = 0; p < f->n; p++)
        for (size_t e = f->start[p]; e < f->start[p + 1]; e++)
            mxGetPr (i)[e] = (double) p + 1, mxGetPr (j)[e] = (double) f->node[e] + 1;
    put (list, "i", i);
    put (list, "j", j);
    put (list, "alive", flags_of (n, alive));
    put (list, "xi", full_of (n, dim, xi));
    put (list, "weight", full_of (n, 1, weight));
    put (list, "partial_volume", full_of (n, 1, beta));
    put (list, "micromodulus", number_of (modulus));
    put (list, "evaluation", mxCreateString (pg_bond_sum_name (s)));
    give (c, 0, list);
    return 0;
}

/* 'bonds_mask' (handle, alive) */
int command_bonds_mask (const call *c)
{
    unsigned char *alive;
    if (take_count (c, 2, 2)) return 1;
    pg_bond_sum *s = take_handle (c, 0, KIND_BONDS);
    if (!s) return 1;
    const pg_family *f = pg_bond_sum_family (s, NULL);
    if (take_flags (c, 1, "alive", f->start[f->n], &alive)) return 1;
    return failed (c, pg_bond_sum_mask (s, alive));
}

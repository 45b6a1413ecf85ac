/* SPDX-License-Identifier: GPL-3.0-or-later
 * Compares a field with all that a reference has: norms over the body, tables, and the difference at the
 * points; writes the result as JSON and as lines of text.
 *
 * Norms are integrals over the background cells with more Gauss points than the run has: at
 * its own integration points a solution may be more accurate than elsewhere
 * (superconvergence), and the norm would be too good. */
#include "compare.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Measures the norms of a body without cells: at its points, weighted by their volumes. */
static pg_status over_points (pg_norms *out, const pg_problem *p, const pg_expression *where,
                              const pg_sampler *value, const pg_sampler *reference)
{
    pg_status status = PG_OK;
    pg_quadrature q = { .n = p->cloud.n, .x = p->cloud.x, .weight = p->cloud.volume };
    int *which = NULL;
    PG_TRY (pg_compare_materials (p, &q, &which));
    pg_norm_options options = { p->at.law, which, where };
    PG_TRY (pg_norms_measure (out, &q, value, reference, &options));
done:
    pg_free (which);
    return status;
}

/* Computes |u - u_ref| at the points of the body (out->difference), which also take part in the maximum norm:
 * between quadrature points the largest error often lies at the boundary, where points are. Points outside
 * the condition, and those without a value, are NAN. */
static pg_status at_points (pg_errors *out, const pg_problem *p, const pg_sampler *value,
                            const pg_sampler *reference, const pg_expression *where)
{
    pg_status status = PG_OK;
    pg_norm *most = &out->norms.maximum;
    size_t n = p->cloud.n, dim = (size_t) p->dim;
    int bits = value->displacement & reference->displacement;
    double *u = NULL, *v = NULL;
    if (!bits) return PG_OK;
    PG_ALLOC (out->difference, n);
    PG_ALLOC (u, 3 * n);
    PG_ALLOC (v, 3 * n);
    PG_TRY (value->sample (value->context, n, p->cloud.x, u, NULL));
    PG_TRY (reference->sample (reference->context, n, p->cloud.x, v, NULL));
    for (size_t i = 0; i < n; i++) {
        double d2 = 0, r2 = 0;
        pg_place at = pg_place_of (p->dim, p->cloud.x + i * dim, 0);
        for (size_t k = 0; k < dim; k++)
            if (bits >> k & 1)
                d2 += (u[3 * i + k] - v[3 * i + k]) * (u[3 * i + k] - v[3 * i + k]),
                    r2 += v[3 * i + k] * v[3 * i + k];
        out->difference[i] = where && pg_expression_value (where, &at) == 0 ? NAN : sqrt (d2);
        if (!isfinite (out->difference[i])) continue;
        most->reference = fmax (most->reference, sqrt (r2));
        if (!(out->difference[i] > most->difference)) continue;
        most->difference = out->difference[i];
        for (size_t k = 0; k < dim; k++) most->place[k] = p->cloud.x[i * dim + k];
    }
    most->relative = most->difference == 0 ? 0
                     : most->reference > 0 ? most->difference / most->reference
                                           : INFINITY;
done:
    pg_free (u), pg_free (v);
    return status;
}

/* Measures the norms of all columns of all tables. */
static pg_status lines (pg_errors *out, const pg_reference *r, const pg_sampler *value)
{
    pg_status status = PG_OK;
    size_t n = 0;
    for (size_t i = 0; i < r->nline; i++) n += r->line[i].ncolumn;
    PG_ALLOC (out->line, n);
    for (size_t i = 0; i < r->nline; i++) {
        PG_TRY (pg_line_measure (out->line + out->nline, &r->line[i], value));
        out->nline += r->line[i].ncolumn;
    }
done:
    return status;
}

/* Measures the norms of value - reference; if the reference has no field (tables only), none. */
pg_status pg_errors_against (pg_errors *out, const pg_problem *problem, int order, const pg_expression *where,
                             const pg_sampler *value, const pg_sampler *reference)
{
    pg_status status = PG_OK;
    double start = pg_seconds ();
    memset (out, 0, sizeof *out);
    out->order = problem->cells.n ? order : 0;
    if (reference->displacement || reference->stress) {
        if (problem->cells.n)
            PG_TRY (pg_norms_of_cells (&out->norms, problem, order, where, value, reference));
        else PG_TRY (over_points (&out->norms, problem, where, value, reference));
        PG_TRY (at_points (out, problem, value, reference, where));
    }
    out->seconds = pg_seconds () - start;
done:
    if (status != PG_OK) pg_errors_clear (out);
    return status;
}

/* Measures norms and tables; `seconds` includes evaluation of tables and closed forms, not the reading of
 * files. */
pg_status pg_errors_measure (pg_errors *out, const pg_reference *reference, const pg_problem *problem,
                             const pg_sampler *value, double t)
{
    pg_status status = PG_OK;
    pg_sampler field = { 0 };
    double start = pg_seconds ();
    memset (out, 0, sizeof *out);
    PG_TRY (pg_reference_sampler (&field, reference, t));
    PG_TRY (pg_errors_against (out, problem, reference->order, reference->where, value, &field));
    PG_TRY (lines (out, reference, value));
    out->seconds = pg_seconds () - start;
done:
    pg_sampler_clear (&field);
    if (status != PG_OK) pg_errors_clear (out);
    return status;
}

/* Frees errors, even if they were never measured. What is left is zero, thus "not measured". */
void pg_errors_clear (pg_errors *errors)
{
    pg_free (errors->line), pg_free (errors->difference);
    memset (errors, 0, sizeof *errors);
}

/* ---- reports ------------------------------------------------------------------------------------------- */
/* One norm as a JSON object; place = 1 with the place of the largest difference, m. `relative` is
 * `difference` over `reference`, which have the unit of the norm: of displacement L2 m^(5/2), of energy
 * sqrt (J). */
static void json_norm (pg_json *j, const char *key, const pg_norm *n, int place)
{
    pg_json_open (j, key, '{');
    pg_json_number (j, "relative", n->relative);
    pg_json_number (j, "difference", n->difference);
    pg_json_number (j, "reference", n->reference);
    if (place) {
        pg_json_open (j, "place", '[');
        for (int k = 0; k < 3; k++) pg_json_number (j, NULL, n->place[k]);
        pg_json_shut (j);
    }
    pg_json_shut (j);
}

/* The norms of one column of a table as a JSON object, with the places of the largest absolute
 * and relative difference. */
static void json_line (pg_json *j, const pg_line_norms *l)
{
    pg_json_open (j, NULL, '{');
    pg_json_text (j, "file", l->file);
    pg_json_text (j, "column", pg_column_name (l->column));
    pg_json_count (j, "rows", l->rows);
    pg_json_count (j, "missed", l->missed);
    json_norm (j, "l2", &l->l2, 0);
    json_norm (j, "maximum", &l->maximum, 1);
    pg_json_number (j, "pointwise", l->pointwise);
    pg_json_open (j, "pointwise_place", '[');
    for (int k = 0; k < 3; k++) pg_json_number (j, NULL, l->place[k]);
    pg_json_shut (j);
    pg_json_shut (j);
}

/* Writes the errors as JSON; norms that were not measured have no entry. */
void pg_errors_json (pg_json *j, const pg_errors *e)
{
    const pg_norms *n = &e->norms;
    pg_json_count (j, "gauss_points", (size_t) e->order);
    pg_json_count (j, "places", n->places);
    pg_json_count (j, "skipped", n->skipped);
    pg_json_number (j, "volume", n->volume);
    if (n->displacement)
        json_norm (j, "displacement_l2", &n->l2, 0), json_norm (j, "displacement_maximum", &n->maximum, 1);
    if (n->stress)
        json_norm (j, "energy", &n->energy, 0), json_norm (j, "stress_maximum", &n->stress_maximum, 1);
    pg_json_open (j, "lines", '[');
    for (size_t i = 0; i < e->nline; i++) json_line (j, &e->line[i]);
    pg_json_shut (j);
}

/* Writes row i of the report; i counts down through the rows that exist, since displacement, stress and the
 * note may each be missing. */
int pg_errors_row (const pg_errors *e, size_t i, char *text, size_t size)
{
    const pg_norms *n = &e->norms;
    const double *u = n->maximum.place, *s = n->stress_maximum.place;
    if (n->displacement && i-- == 0)
        return snprintf (text, size, "displacement: L2 %.3e, largest %.3e at [%.4g, %.4g, %.4g] m",
                         n->l2.relative, n->maximum.relative, u[0], u[1], u[2])
               > 0;
    if (n->stress && i-- == 0)
        return snprintf (text, size, "stress: energy norm %.3e, largest %.3e at [%.4g, %.4g, %.4g] m",
                         n->energy.relative, n->stress_maximum.relative, s[0], s[1], s[2])
               > 0;
    if (n->skipped && i-- == 0)
        return snprintf (text, size, "left out: %zu of %zu places (where, or no finite value)", n->skipped,
                         n->skipped + n->places)
               > 0;
    if (i >= e->nline) return 0;
    const pg_line_norms *l = &e->line[i];
    return snprintf (text, size,
                     "%s %s: L2 %.3e, largest %.3e at [%.4g, %.4g, %.4g] m, pointwise %.3e, %zu rows%s",
                     l->file, pg_column_name (l->column), l->l2.relative, l->maximum.relative,
                     l->maximum.place[0], l->maximum.place[1], l->maximum.place[2], l->pointwise, l->rows,
                     l->missed ? ", some without a value" : "")
           > 0;
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * perigal compare: compare.csv with both sides at the points, compare.json with the norms, and
 * a picture of the difference, all in the result folder. Tables of the reference follow as
 * compare_2.csv and so on, each with a chart of both sides. */
#include "perigal/picture.h"
#include "perigal/study.h"
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* The problem with the smaller spacing, at whose points both sides are written. */
static const pg_problem *finer (const pg_comparison *c)
{
    return c->other && c->other->problem->cloud.h < c->own->problem->cloud.h ? c->other->problem
                                                                             : c->own->problem;
}

/* ---- pictures ------------------------------------------------------------------------------------------ */
/* Writes the label of the colour bar. */
static void name_difference (int column, char *label, size_t size)
{
    if (column >= PG_COMPARE_U)
        snprintf (label, size, column == PG_COMPARE_U ? "|u - u_{ref}| (m)" : "|stress - reference| (Pa)");
    else snprintf (label, size, "%s - reference (%s)", pg_column_name (column), pg_column_unit (column));
}

/* Draws the difference at the points; components have colours from blue to red, symmetric about zero. */
static pg_status field_picture (const pg_comparison *c, const pg_comparison_request *q, const char *path)
{
    pg_status status = PG_OK;
    const pg_problem *p = finer (c);
    double *value = NULL, low, high;
    char title[400], label[64];
    int column = q->column, found = 0;
    if (column < 0) column = c->errors.norms.displacement ? PG_COMPARE_U : PG_COMPARE_S;
    PG_ALLOC (value, p->cloud.n);
    PG_TRY (pg_compare_field (value, &p->cloud, column, &c->own->sampler, &c->reference));
    PG_TRY (pg_picture_range (p->cloud.n, value, 0, &low, &high, &found));
    if (!found)
        PG_FAIL (PG_E_USAGE, "there is no difference of this field to draw: one side does not know it");
    name_difference (column, label, sizeof label);
    snprintf (title, sizeof title, "%s: difference from the reference", c->own->problem->title);
    double most = fmax (fabs (low), fabs (high));
    pg_picture_style style = { .title = title, .label = label, .diverging = column < PG_COMPARE_U };
    style.cracks = pg_state_cracks (p, NULL);
    if (style.diverging && most > 0) style.low = -most, style.high = most;
    PG_TRY (pg_picture_field (path, &p->cloud, value, &style));
done:
    pg_free (value);
    return status;
}

/* Draws the difference on the elements of a finite element reference, at its nodes, which are moved by the
 * shift to where our result is. The picture shows the mesh at its own position, without displacement. */
static pg_status mesh_picture (const pg_comparison *c, const pg_comparison_request *q, const pg_mesh *mesh,
                               const char *path)
{
    pg_status status = PG_OK;
    size_t n = mesh->nnode, dim = (size_t) mesh->dim;
    double *value = NULL;
    char label[64], title[400];
    int column = q->column < 0 ? PG_COMPARE_U : q->column;
    pg_cloud nodes = { .dim = mesh->dim, .n = n };
    PG_ALLOC (nodes.x, n * dim);
    PG_ALLOC (value, n);
    for (size_t i = 0; i < n; i++)
        for (size_t k = 0; k < dim; k++) nodes.x[i * dim + k] = mesh->x[3*i + k] + q->shift[k];
    PG_TRY (pg_compare_field (value, &nodes, column, &c->own->sampler, &c->reference));
    name_difference (column, label, sizeof label);
    snprintf (title, sizeof title, "%s: difference from the reference, on its elements",
              c->own->problem->title);
    pg_picture_style style = {
        .title = title, .label = label, .diverging = column < PG_COMPARE_U, .length = 1
    };
    PG_TRY (pg_picture_mesh (path, mesh, value, &style));
done:
    pg_free (nodes.x), pg_free (value);
    return status;
}

/* Index of the coordinate along which the table extends most: the x axis of its chart. */
static int main_axis (const pg_line *l)
{
    int best = 0;
    double most = -1;
    for (int k = 0; k < l->dim; k++) {
        double low = INFINITY, high = -INFINITY;
        for (size_t i = 0; i < l->n; i++)
            low = fmin (low, l->x[i * (size_t) l->dim + (size_t) k]),
            high = fmax (high, l->x[i * (size_t) l->dim + (size_t) k]);
        if (high - low > most) most = high - low, best = k;
    }
    return best;
}

/* Plots columns of one kind (--field; else displacements if there are any): results as lines, reference
 * values as markers. */
static pg_status line_picture (const pg_comparison *c, const pg_comparison_request *q, const pg_line *l,
                               const char *path)
{
    pg_status status = PG_OK;
    double *x = NULL, *u = NULL, *y = NULL;
    char name[18][48], xlabel[32];
    pg_curve curve[18];
    size_t n = 0;
    int axis = main_axis (l), stresses = q->column == PG_COMPARE_S || l->column[0] >= 3;
    PG_ALLOC (x, l->n);
    PG_ALLOC (u, 9 * l->n);
    PG_ALLOC (y, 18 * l->n);
    PG_TRY (pg_line_sample (l, &c->own->sampler, u, u + 3 * l->n));
    for (size_t i = 0; i < l->n; i++) x[i] = l->x[i * (size_t) l->dim + (size_t) axis];
    for (size_t k = 0; k < l->ncolumn; k++) {
        int column = l->column[k],
            wanted = q->column >= 0 && q->column < 9 ? column == q->column : (column >= 3) == stresses;
        if (!wanted) continue;
        for (size_t i = 0; i < l->n; i++) {
            y[n * l->n + i] = column < 3 ? u[3*i + (size_t) column] : u[3 * l->n + 6*i + (size_t) column - 3];
            y[(n + 1) * l->n + i] = l->value[i * l->ncolumn + k];
        }
        snprintf (name[n], sizeof *name, "%s", pg_column_name (column));
        snprintf (name[n + 1], sizeof *name, "%s, reference", pg_column_name (column));
        curve[n] = (pg_curve) { name[n], l->n, x, y + n * l->n, 0 };
        curve[n + 1] = (pg_curve) { name[n + 1], l->n, x, y + (n + 1) * l->n, 1 };
        n += 2;
    }
    if (!n) PG_FAIL (PG_E_USAGE, "%s has no column of the field asked for", l->name);
    snprintf (xlabel, sizeof xlabel, "%c (m)", "xyz"[axis]);
    int shown = q->column >= 0 && q->column < 9 ? q->column >= 3 : stresses;
    pg_chart_style style = { .title = c->own->problem->title,
                             .xlabel = xlabel,
                             .ylabel = shown ? "stress (Pa)" : "displacement (m)" };
    PG_TRY (pg_picture_chart (path, n, curve, &style));
done:
    pg_free (x), pg_free (u), pg_free (y);
    return status;
}

/* ---- files --------------------------------------------------------------------------------------------- */
/* Writes compare.json: the norms, how both sides were sampled, and which step was compared. */
static pg_status json_file (const pg_comparison *c, const pg_comparison_request *q, const char *path)
{
    pg_status status = PG_OK;
    pg_json *j = NULL;
    PG_TRY (pg_json_create (&j, path));
    pg_json_open (j, NULL, '{');
    pg_json_text (j, "result", q->folder);
    pg_json_text (j, "reference", q->reference ? q->reference : "scene");
    pg_json_count (j, "step", (size_t) c->own->step);
    pg_json_number (j, "time", c->own->t);
    pg_json_text (j, "sampled", c->own->how);
    if (c->note[0]) pg_json_text (j, "note", c->note);
    pg_errors_json (j, &c->errors);
    pg_json_shut (j);
    PG_TRY (pg_json_close (&j));
done:
    if (j) pg_json_close (&j);
    return status;
}

/* Prints the name of a file that was written. */
static void tell (const pg_comparison_request *q, const char *what, const char *path)
{
    if (q->out) fprintf (q->out, "  %s %s\n", what, path);
}

/* Writes a CSV file and a chart for each of n tables; `before` is the number of files that have been written
 * already: the tables of the scene follow its field. */
static pg_status table_files (const pg_comparison *c, const pg_comparison_request *q, const pg_line *line,
                              size_t n, size_t before)
{
    pg_status status = PG_OK;
    char path[4096];
    for (size_t k = 0; k < n; k++) {
        if (k + before == 0) snprintf (path, sizeof path, "%s/compare.csv", q->folder);
        else snprintf (path, sizeof path, "%s/compare_%zu.csv", q->folder, k + before + 1);
        PG_TRY (pg_compare_line (path, &line[k], &c->own->sampler));
        tell (q, "table", path);
        if (k + before > 0) snprintf (path, sizeof path, "%s/compare_%zu.png", q->folder, k + before + 1);
        else snprintf (path, sizeof path, "%s", q->picture ? q->picture : "");
        if (!path[0]) snprintf (path, sizeof path, "%s/compare.png", q->folder);
        PG_TRY (line_picture (c, q, &line[k], path));
        tell (q, "picture", path);
    }
done:
    return status;
}

/* Writes all files: the field first, then a table given on the command line, then the tables of the scene,
 * the norms last. */
pg_status pg_comparison_write (const pg_comparison *c, const pg_comparison_request *q)
{
    pg_status status = PG_OK;
    char path[4096];
    size_t fields = c->reference.displacement || c->reference.stress, n = 0;
    if (fields) {
        snprintf (path, sizeof path, "%s/compare.csv", q->folder);
        PG_TRY (pg_compare_points (path, &finer (c)->cloud, &c->own->sampler, &c->reference));
        tell (q, "table", path);
        if (q->picture) snprintf (path, sizeof path, "%s", q->picture);
        else snprintf (path, sizeof path, "%s/compare.png", q->folder);
        const pg_mesh *mesh = pg_sampler_mesh_of (&c->fem, NULL, NULL);
        if (mesh && mesh->dim > 1) PG_TRY (mesh_picture (c, q, mesh, path));
        else PG_TRY (field_picture (c, q, path));
        tell (q, "picture", path);
    }
    if (c->line.n) PG_TRY (table_files (c, q, &c->line, 1, fields));
    const pg_line *own = c->scene ? pg_reference_lines (c->scene, &n) : NULL;
    PG_TRY (table_files (c, q, own, n, fields));
    snprintf (path, sizeof path, "%s/compare.json", q->folder);
    PG_TRY (json_file (c, q, path));
done:
    return status;
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * Figures 1 to 3 of Cui 2022 section 2.4 in the folder given (default out/cui_1d), each as CSV and PNG:
 *   fig1: u and u' of the field y = x between 11 nodes, errors and the derivatives of one shape function;
 *   fig2: force imbalance under constant stress against the number of Gauss points per cell (0: at the
 *     nodes);
 *   fig3: relative L2 error of -u'' = 1 against the number of cells, one picture per support. */
#include "cui_1d.h"
#include "perigal/output.h"
#include "perigal/picture.h"
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

enum { PLACES = 1001, SIZES = 4, SCHEMES = 12, RULES = 6 };
static const char *const approximation[2] = { "rkpm", "pddo" }, *const label[2] = { "RKPM", "PDDO" };
static const double support[4] = { 1.5, 2, 2.5, 3 };

static pg_status make_folders (const char *folder)
{
    char path[400];
    for (size_t i = 1; i < sizeof path && folder[i - 1]; i++) {
        if (folder[i] != '/' && folder[i] != '\0') continue;
        snprintf (path, sizeof path, "%.*s", (int) i, folder);
        if (mkdir (path, 0777) != 0 && errno != EEXIST)
            return pg_error (PG_E_FILE, PG_HERE, "%s: %s", path, strerror (errno));
    }
    return PG_OK;
}

/* CSV of columns: value is ncolumn x nrow */
static pg_status write_table (const char *folder, const char *name, size_t ncolumn,
                              const char *const *columns, size_t nrow, const double *value)
{
    pg_status status = PG_OK;
    pg_table *table = NULL;
    char path[512];
    double row[32];
    snprintf (path, sizeof path, "%s/%s.csv", folder, name);
    PG_TRY (pg_table_create (&table, path, ncolumn, columns));
    for (size_t i = 0; i < nrow; i++) {
        for (size_t c = 0; c < ncolumn; c++) row[c] = value[c * nrow + i];
        PG_TRY (pg_table_row (table, row));
    }
done:
    pg_table_close (&table);
    return status;
}

static pg_status draw (const char *folder, const char *name, size_t ncurve, const pg_curve *curves,
                       const pg_chart_style *style)
{
    char path[512];
    snprintf (path, sizeof path, "%s/%s.png", folder, name);
    pg_status status = pg_picture_chart (path, ncurve, curves, style);
    if (status == PG_OK) printf ("%s\n", path);
    return status;
}

/* ---- figure 1 ------------------------------------------------------------------------------------------ */
/* Errors of u and u' of y = x, and N,x of the middle node, at PLACES places of 11 nodes, D = 1 */
static pg_status sample (const char *type, double a, const double *x, double *error, double *slope_error,
                         double *slope)
{
    pg_status status = PG_OK;
    bar b = { 0 };
    pg_rows r = { 0 };
    PG_TRY (bar_create (&b, type, 10, 10, a));
    PG_TRY (bar_rows_at (&r, &b, PLACES, x, NULL));
    for (size_t q = 0; q < PLACES; q++) {
        double u = 0, du = 0;
        slope[q] = 0;
        for (size_t e = r.family.start[q]; e < r.family.start[q + 1]; e++) {
            u += r.N[e] * b.cloud.x[r.family.node[e]], du += r.dN[e] * b.cloud.x[r.family.node[e]];
            if (r.family.node[e] == 5) slope[q] = r.dN[e];
        }
        error[q] = fabs (u - x[q]), slope_error[q] = fabs (du - 1);
    }
done:
    pg_rows_clear (&r);
    bar_clear (&b);
    return status;
}

static pg_status figure_1 (const char *folder)
{
    pg_status status = PG_OK;
    double *v = NULL;
    const char *columns[25] = { "x [m]" };
    char names[24][48];
    pg_curve curves[4];
    PG_ALLOC (v, 25 * PLACES);
    for (size_t q = 0; q < PLACES; q++) v[q] = 10.0 * (double) q / (PLACES - 1);
    for (size_t k = 0; k < 8; k++) {
        double *at = v + (1 + 3*k) * PLACES;
        PG_TRY (sample (approximation[k % 2], support[k / 2], v, at, at + PLACES, at + 2 * PLACES));
        for (size_t c = 0; c < 3; c++) {
            snprintf (names[3 * k + c], sizeof *names, "%s %s a=%.1fD [%s]",
                      c == 0   ? "error u"
                      : c == 1 ? "error u'"
                               : "N5_x",
                      label[k % 2], support[k / 2],
                      c == 0   ? "m"
                      : c == 1 ? "1"
                               : "1/m");
            columns[1 + 3*k + c] = names[3*k + c];
        }
        if (k < 2 || k > 5) continue;
        static char legend[4][32];
        snprintf (legend[k - 2], sizeof *legend, "%s, a = %.1f D", label[k % 2], support[k / 2]);
        curves[k - 2] = (pg_curve) { legend[k - 2], PLACES, v, at + 2 * PLACES, 0 };
    }
    PG_TRY (write_table (folder, "fig1", 25, columns, PLACES, v));
    PG_TRY (draw (folder, "fig1", 4, curves,
                  &(pg_chart_style){ .title = "Derivative of one shape function (node at x = 5, D = 1)",
                                     .xlabel = "x / D",
                                     .ylabel = "D N_{,x}" }));
done:
    pg_free (v);
    return status;
}

/* ---- figure 2 ------------------------------------------------------------------------------------------ */
static pg_status figure_2 (const char *folder)
{
    pg_status status = PG_OK;
    double v[7][RULES];
    const char *columns[7] = { "Gauss points per cell, 0 nodal [1]" };
    char names[6][48];
    pg_curve curves[6];
    for (int p = 0; p < RULES; p++) v[0][p] = p;
    for (size_t k = 0; k < 6; k++) {
        for (int p = 0; p < RULES; p++) {
            bar b = { 0 };
            pg_status now = bar_create (&b, approximation[k % 2], 10, 1, support[1 + k / 2]);
            if (now == PG_OK) now = bar_imbalance (&b, p, &v[1 + k][p]);
            bar_clear (&b);
            PG_TRY (now);
        }
        snprintf (names[k], sizeof *names, "%s, a = %.1f D", label[k % 2], support[1 + k / 2]);
        columns[1 + k] = names[k];
        curves[k] = (pg_curve) { names[k], RULES, v[0], v[1 + k], 1 };
    }
    PG_TRY (write_table (folder, "fig2", 7, columns, RULES, &v[0][0]));
    PG_TRY (draw (folder, "fig2", 6, curves,
                  &(pg_chart_style){ .title = "Force imbalance of a bar under stress 1 (10 cells)",
                                     .xlabel = "Gauss points per cell (0: nodal integration)",
                                     .ylabel = "max |f_{int} - f_{ext}|",
                                     .logy = 1 }));
done:
    return status;
}

/* ---- figure 3 ------------------------------------------------------------------------------------------ */
/* One chart per support; columns of the table: RKPM nodal, PDDO nodal, RKPM 2-point, PDDO 2-point for each
 * support. */
static pg_status figure_3 (const char *folder)
{
    pg_status status = PG_OK;
    double v[SCHEMES + 1][SIZES];
    const char *columns[SCHEMES + 1] = { "cells [1]" };
    char names[SCHEMES][48], title[64], name[32];
    pg_curve curves[4];
    for (size_t s = 0; s < SIZES; s++) v[0][s] = (double) (10u << s);
    for (size_t k = 0; k < SCHEMES; k++) {
        double a = support[1 + k / 4];
        int points = k % 4 < 2 ? 0 : 2;
        for (size_t s = 0; s < SIZES; s++) {
            bar b = { 0 };
            pg_status now = bar_create (&b, approximation[k % 2], 10u << s, 1, a);
            if (now == PG_OK) now = bar_error (&b, points, &v[1 + k][s]);
            bar_clear (&b);
            PG_TRY (now);
        }
        snprintf (names[k], sizeof *names, "%s, %s, a = %.1f D", label[k % 2], points ? "2-point" : "nodal",
                  a);
        columns[1 + k] = names[k];
        static char legend[4][24];
        snprintf (legend[k % 4], sizeof *legend, "%s, %s", label[k % 2], points ? "2-point" : "nodal");
        curves[k % 4] = (pg_curve) { legend[k % 4], SIZES, v[0], v[1 + k], k % 2 == 1 };
        if (k % 4 != 3) continue;
        snprintf (title, sizeof title, "-u'' = 1, a = %.1f D", a);
        snprintf (name, sizeof name, "fig3_a%.1f", a);
        PG_TRY (draw (folder, name, 4, curves,
                      &(pg_chart_style){ .title = title,
                                         .xlabel = "cells",
                                         .ylabel = "relative L_{2} error",
                                         .logx = 1,
                                         .logy = 1 }));
    }
    PG_TRY (write_table (folder, "fig3", SCHEMES + 1, columns, SIZES, &v[0][0]));
done:
    return status;
}

int main (int argc, char **argv)
{
    pg_status status = PG_OK;
    const char *folder = argc > 1 ? argv[1] : "out/cui_1d";
    PG_TRY (make_folders (folder));
    PG_TRY (figure_1 (folder));
    PG_TRY (figure_2 (folder));
    PG_TRY (figure_3 (folder));
done:
    if (status != PG_OK) fprintf (stderr, "cui_1d: %s\n", pg_last_error ());
    return status != PG_OK;
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * Orders of convergence as a printed table, as convergence.csv and as a picture. Numbers that are zero but
 * for rounding, such as a reaction across the load, are left out. */
#include "perigal/picture.h"
#include "converge.h"
#include <math.h>
#include <string.h>

enum { CURVES = 12 };
/* A value this small, relative to the largest number with its unit, is rounding. */
static const double noise = 1e-9;

/* Finds the order of a quantity. Errors have the limit 0; for other values the limit is found as well
 * (compare.h). */
pg_observed pg_study_order (const pg_study *s, const pg_quantity *q, size_t n)
{
    return q->error ? pg_observed_of_errors (n, s->h, q->value) : pg_observed_of_values (n, s->h, q->value);
}

/* Largest magnitude of a quantity over the sizes. */
static double size_of (const pg_study *s, const pg_quantity *q)
{
    double most = 0;
    for (size_t k = 0; k < s->n; k++) most = fmax (most, isnan (q->value[k]) ? 0 : fabs (q->value[k]));
    return most;
}

/* Largest magnitude of all quantities with that unit, errors excepted. */
static double largest (const pg_study *s, const char *unit)
{
    double most = 0;
    for (size_t k = 0; k < s->nquantity; k++)
        if (!s->list[k].error && strcmp (s->list[k].unit, unit) == 0)
            most = fmax (most, size_of (s, &s->list[k]));
    return most;
}

/* 1 if a quantity is rounding, compared with others of its unit; forces also with energy over displacement,
 * for a run may have no other force. Errors are never rounding. */
static int is_noise (const pg_study *s, const pg_quantity *q)
{
    double most = largest (s, q->unit), way = largest (s, "m");
    if (q->error) return 0;
    if (strcmp (q->unit, "N") == 0 && way > 0) most = fmax (most, largest (s, "J") / way);
    return size_of (s, q) <= noise * most;
}

/* Prints a heading with the spacings, then one row per quantity: its value at each size, then order, limit
 * and estimated error, or the reason why there is no order. */
void pg_converge_print (const pg_study *s, int fixed, FILE *out)
{
    fprintf (out, "horizon %g %s\n  %-30s", s->horizon,
            fixed ? "first spacings, kept (m-convergence)" : "spacings (delta-convergence)", "spacing, m");
    for (size_t k = 0; k < s->n; k++) fprintf (out, " %12.6g", s->h[k]);
    fprintf (out, "    order        limit   error est.\n");
    for (size_t i = 0; i < s->nquantity; i++) {
        const pg_quantity *q = &s->list[i];
        char label[192];
        if (is_noise (s, q)) continue;
        snprintf (label, sizeof label, "%s%s%s", q->name, strcmp (q->unit, "1") == 0 ? "" : ", ",
                  strcmp (q->unit, "1") == 0 ? "" : q->unit);
        fprintf (out, "  %-30s", label);
        for (size_t k = 0; k < s->n; k++) fprintf (out, " %12.6g", q->value[k]);
        pg_observed o = pg_study_order (s, q, s->n);
        if (o.why) fprintf (out, "        - %s", o.why);
        else if (q->error) fprintf (out, " %8.2f", o.order);
        else fprintf (out, " %8.2f %12.6g %12.2e", o.order, o.limit, o.error);
        fputc ('\n', out);
    }
}

/* Writes a number into a cell; empty for NAN. */
static void number (char *cell, size_t size, double value)
{
    if (isnan (value)) cell[0] = 0;
    else snprintf (cell, size, "%.12g", value);
}

/* Writes convergence.csv, one row per quantity and size; the order in row k is that of the sizes up to k, so
 * that it can be seen to settle. */
pg_status pg_converge_table (const pg_study *list, size_t n, const char *folder)
{
    pg_status status = PG_OK;
    static const char *const columns[] = { "horizon [1]",  "quantity [name]", "unit [name]",
                                           "spacing [m]",  "value [unit]",    "order [1]",
                                           "limit [unit]", "error [unit]",    "remark [name]" };
    enum { MOST = sizeof columns / sizeof *columns };
    char path[4096], cell[MOST][PG_CONVERGE_NAME];
    const char *row[MOST];
    pg_table *table = NULL;
    for (int k = 0; k < MOST; k++) row[k] = cell[k];
    snprintf (path, sizeof path, "%s/convergence.csv", folder);
    PG_TRY (pg_table_create (&table, path, MOST, columns));
    for (size_t s = 0; s < n; s++)
        for (size_t i = 0; i < list[s].nquantity; i++) {
            const pg_quantity *q = &list[s].list[i];
            if (is_noise (&list[s], q)) continue;
            for (size_t k = 0; k < list[s].n; k++) {
                pg_observed o = pg_study_order (&list[s], q, k + 1);
                number (cell[0], sizeof *cell, list[s].horizon), number (cell[3], sizeof *cell, list[s].h[k]),
                    number (cell[4], sizeof *cell, q->value[k]);
                number (cell[5], sizeof *cell, o.order),
                    number (cell[6], sizeof *cell, q->error ? NAN : o.limit),
                    number (cell[7], sizeof *cell, o.error);
                snprintf (cell[1], sizeof *cell, "%s", q->name),
                    snprintf (cell[2], sizeof *cell, "%s", q->unit);
                snprintf (cell[8], sizeof *cell, "%s", o.why ? o.why : "");
                PG_TRY (pg_table_line (table, row));
            }
        }
done:
    pg_table_close (&table);
    return status;
}

/* ---- picture ------------------------------------------------------------------------------------------- */
/* The curves of the picture; order: of the first curve, which gets a slope triangle. */
typedef struct {
    char name[CURVES][PG_CONVERGE_NAME + 32];
    double y[CURVES][PG_CONVERGE_SIZES];
    pg_curve curve[CURVES];
    size_t n;
    double order;
} chart;

/* Adds a curve: an error, or the distance of a value from Richardson's extrapolated value, relative to that;
 * values without an order are left out. */
static void add_curve (chart *c, const pg_study *s, const pg_quantity *q, int several)
{
    pg_observed o = pg_study_order (s, q, s->n);
    double scale = q->error ? 1 : fabs (o.limit);
    if (c->n >= CURVES || is_noise (s, q) || (!q->error && (o.why || !(scale > 0)))) return;
    for (size_t k = 0; k < s->n; k++) c->y[c->n][k] = fabs (q->value[k] - (q->error ? 0 : o.limit)) / scale;
    if (several) snprintf (c->name[c->n], sizeof *c->name, "%s, horizon %g", q->name, s->horizon);
    else snprintf (c->name[c->n], sizeof *c->name, "%s", q->name);
    c->curve[c->n] = (pg_curve){
        .name = c->name[c->n], .n = s->n, .x = s->h, .y = c->y[c->n], .points = PG_CURVE_BOTH
    };
    if (c->n == 0) c->order = o.order;
    c->n++;
}

/* Draws the errors if any were measured, else the distances. The triangle shows the order rounded to
 * halves. */
pg_status pg_converge_picture (const pg_study *list, size_t n, const char *folder, const char *title,
                               int *drawn)
{
    pg_status status = PG_OK;
    char path[4096];
    chart *c = NULL;
    int measured = 0;
    PG_ALLOC (c, 1);
    for (size_t s = 0; s < n; s++)
        for (size_t i = 0; i < list[s].nquantity; i++) measured |= list[s].list[i].error;
    for (size_t s = 0; s < n; s++)
        for (size_t i = 0; i < list[s].nquantity; i++)
            if (list[s].list[i].error == measured) add_curve (c, &list[s], &list[s].list[i], n > 1);
    *drawn = c->n > 0;
    if (!c->n) goto done;
    pg_chart_slope slope = { .order = round (2 * c->order) / 2, .curve = 0 };
    pg_chart_style style = { .title = title,
                             .xlabel = "spacing (m)",
                             .ylabel = measured ? "relative error"
                                                : "relative distance from Richardson's value",
                             .logx = 1,
                             .logy = 1,
                             .nslope = c->order > 0.2 ? 1 : 0,
                             .slopes = &slope };
    snprintf (path, sizeof path, "%s/convergence.png", folder);
    PG_TRY (pg_picture_chart (path, c->n, c->curve, &style));
done:
    pg_free (c);
    return status;
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * sweep.png: a quantity over the numeric key with most values, a curve for each combination of the other
 * keys; with seeds the single runs as markers and their mean as a line. A histogram is drawn if there is no
 * such key, or if there would be more curves than an eye can tell apart. */
#include "perigal/picture.h"
#include "sweep.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Largest number of curves; half as many if seeds make each of them two: markers and their mean. */
enum { CURVES = 10 };

/* x: index of the key on the x axis; seeds: 1 if a key of the sweep is a seed. */
typedef struct { size_t x; int seeds; } axes;

/* Chooses the key of numbers with most values, the first of equal ones. Returns 0 if there is none. */
static int choose (axes *a, const sweep *s)
{
    size_t most = 0;
    a->seeds = 0;
    for (size_t k = 0; k < s->nkey; k++) {
        a->seeds |= s->key[k].seeds;
        if (s->key[k].numeric && !s->key[k].seeds && s->key[k].n > most) most = s->key[k].n, a->x = k;
    }
    return most > 0;
}

/* 1: the runs i and j belong to one curve. With --zip all values change together, and there is one curve. */
static int same_curve (const sweep *s, const axes *a, size_t i, size_t j)
{
    for (size_t k = 0; k < s->nkey && !s->q->zip; k++)
        if (k != a->x && !s->key[k].seeds && s->index[i * s->nkey + k] != s->index[j * s->nkey + k]) return 0;
    return 1;
}

/* Names the curve of run i by the values that distinguish it: "fracture_energy = 20 J/m2, force = bond". */
static void name_curve (const sweep *s, const axes *a, size_t i, char *out, size_t size)
{
    size_t n = 0;
    out[0] = 0;
    for (size_t k = 0; k < s->nkey && !s->q->zip && n < size; k++) {
        if (k == a->x || s->key[k].seeds) continue;
        n += (size_t) snprintf (out + n, size - n, "%s%.60s = %.40s", n ? ", " : "", s->key[k].label,
                                s->key[k].word[s->index[i * s->nkey + k]]);
    }
}

typedef struct { double x, y; } place;
static int by_x (const void *a, const void *b)
{
    const place *p = a, *q = b;
    return (p->x > q->x) - (p->x < q->x);
}

/* Lists the points of the curve that begins with run `first`, by rising x; returns their number. */
static size_t places_of (place *out, const sweep *s, const axes *a, size_t first, size_t c, double factor)
{
    size_t n = 0;
    for (size_t i = first; i < s->n; i++) {
        double y = s->value[i * s->ncolumn + c];
        if (same_curve (s, a, first, i) && s->result[i].code == PG_EXIT_DONE && isfinite (y))
            out[n++] = (place) { s->key[a->x].number[s->index[i * s->nkey + a->x]], factor * y };
    }
    pg_sort (out, n, sizeof *out, by_x);
    return n;
}

/* Computes the mean of the points at each x; returns the number of means. */
static size_t means_of (double *x, double *y, size_t n, const place *p)
{
    size_t m = 0;
    for (size_t i = 0, j; i < n; i = j, m++) {
        double sum = 0;
        for (j = i; j < n && p[j].x == p[i].x; j++) sum += p[j].y;
        x[m] = p[i].x, y[m] = sum / (double) (j - i);
    }
    return m;
}

/* Adds a curve, or with seeds markers and the line of their means; returns the number of curves added. x, y
 * have room for 2 n values. */
static size_t add_curve (pg_curve *curve, double *x, double *y, const char *name, size_t n, const place *p,
                         int seeds)
{
    for (size_t i = 0; i < n; i++) x[i] = p[i].x, y[i] = p[i].y;
    curve[0] = (pg_curve) { .name = *name ? name : seeds ? "runs" : NULL, .n = n, .x = x, .y = y,
                            .points = seeds ? PG_CURVE_MARKERS : PG_CURVE_BOTH };
    if (!seeds) return 1;
    size_t m = means_of (x + n, y + n, n, p);
    curve[1] = (pg_curve) { .name = "mean", .n = m, .x = x + n, .y = y + n, .points = PG_CURVE_LINE };
    return 2;
}

static pg_status draw_chart (int *drawn, const sweep *s, const axes *a, size_t c, double factor,
                             const char *ylabel, const char *path)
{
    pg_status status = PG_OK;
    const sweep_key *key = &s->key[a->x];
    char (*name)[256] = NULL, xlabel[SWEEP_HEAD + 300];
    double *x = NULL, *y = NULL;
    place *p = NULL;
    pg_curve curve[2 * CURVES];
    size_t n = 0, at = 0, named = 0;
    PG_ALLOC (name, s->n);
    PG_ALLOC (x, 2 * s->n);
    PG_ALLOC (y, 2 * s->n);
    PG_ALLOC (p, s->n);
    for (size_t i = 0; i < s->n && n + 2 <= 2 * CURVES; i++) {
        size_t before = 0;
        while (before < i && !same_curve (s, a, before, i)) before++;
        if (before < i) continue;
        size_t m = places_of (p, s, a, i, c, factor);
        if (m == 0) continue;
        name_curve (s, a, i, name[named], sizeof *name);
        n += add_curve (&curve[n], x + at, y + at, name[named++], m, p, a->seeds), at += 2 * m;
    }
    *drawn = n > 0;
    if (!n) goto done;
    snprintf (xlabel, sizeof xlabel, "%s%s%s%s", key->label, *key->unit ? " (" : "", key->unit,
              *key->unit ? ")" : "");
    pg_chart_style style = { .title = s->q->scene, .xlabel = xlabel, .ylabel = ylabel, .beside = n > 4 };
    PG_TRY (pg_picture_chart (path, n, curve, &style));
done:
    pg_free (name), pg_free (x), pg_free (y), pg_free (p);
    return status;
}

/* Number of curves that there would be. */
static size_t count_curves (const sweep *s, const axes *a)
{
    size_t n = 0;
    for (size_t i = 0; i < s->n; i++) {
        size_t before = 0;
        while (before < i && !same_curve (s, a, before, i)) before++;
        n += before == i;
    }
    return n;
}

pg_status pg_sweep_draw (int *drawn, const sweep *s, size_t c, const char *path)
{
    pg_status status = PG_OK;
    const sweep_column *column = &s->column[c];
    double *value = NULL, largest = 0;
    char unit[64], label[256];
    pg_spread spread;
    axes a = { 0, 0 };
    *drawn = 0;
    PG_ALLOC (value, s->n);
    for (size_t i = 0; i < s->n; i++) {
        value[i] = s->result[i].code == PG_EXIT_DONE ? s->value[i * s->ncolumn + c] : NAN;
        if (isfinite (value[i])) largest = fmax (largest, fabs (value[i]));
    }
    if (choose (&a, s) && count_curves (s, &a) <= CURVES / (a.seeds ? 2u : 1u)) {
        double factor = pg_chart_unit (largest, column->unit, unit, sizeof unit);
        int plain = strcmp (unit, "1") == 0 || !*unit;
        snprintf (label, sizeof label, "%s%s%s%s", column->name, plain ? "" : " (", plain ? "" : unit,
                  plain ? "" : ")");
        PG_TRY (draw_chart (drawn, s, &a, c, factor, label, path));
    } else {
        pg_spread_of (&spread, s->n, value);
        PG_TRY (pg_histogram_draw (drawn, path, &spread, value, column->name,
                                   strcmp (column->unit, "1") == 0 ? "" : column->unit, s->q->scene));
    }
done:
    pg_free (value);
    return status;
}

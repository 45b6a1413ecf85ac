/* SPDX-License-Identifier: GPL-3.0-or-later
 * The spread of a number over many runs, and its histogram with the mean. */
#include "perigal/picture.h"
#include "series.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Largest number of bins of the histogram. */
enum { BINS = 30 };

void pg_spread_of (pg_spread *out, size_t n, double *value)
{
    double sum = 0, squares = 0;
    size_t m = 0;
    for (size_t k = 0; k < n; k++) if (isfinite (value[k])) value[m++] = value[k], sum += value[m - 1];
    pg_sort (value, m, sizeof *value, pg_ascending_numbers);
    *out = (pg_spread) { .n = m, .mean = NAN, .deviation = NAN, .least = NAN, .median = NAN, .most = NAN };
    if (m == 0) return;
    out->mean = sum / (double) m;
    for (size_t k = 0; k < m; k++) squares += (value[k] - out->mean) * (value[k] - out->mean);
    if (m > 1) out->deviation = sqrt (squares / (double) (m - 1));
    out->least = value[0], out->most = value[m - 1];
    out->median = 0.5 * (value[(m - 1) / 2] + value[m / 2]);
}

double pg_chart_unit (double size, const char *unit, char *out, size_t bytes)
{
    static const char *const prefix[] = { "n", "\xc2\xb5", "m", "", "k", "M", "G" };
    static const char *const scaled[] = { "N", "m", "J", "Pa" };
    int k = 3;
    for (size_t i = 0; i < sizeof scaled / sizeof *scaled; i++)
        if (strcmp (unit, scaled[i]) == 0 && isfinite (size) && size > 0)
            k = (int) fmin (6, fmax (0, 3 + floor (log10 (size * (1 + 1e-12)) / 3)));
    snprintf (out, bytes, "%s%s", prefix[k], unit);
    return pow (10, -3.0 * (k - 3));
}

/* Draws a histogram: the outline of the bars and a line at the mean; equal bins between least and largest
 * value, as many as the root of the number of values. *drawn 0: nothing, as values are too few or all
 * equal. */
pg_status pg_histogram_draw (int *drawn, const char *path, const pg_spread *s, const double *value,
                             const char *quantity, const char *unit, const char *title)
{
    pg_status status = PG_OK;
    double count[BINS] = { 0 }, x[4 * BINS + 2], y[4 * BINS + 2], mean[2], height[2] = { 0, 0 };
    char label[192], scaled[64];
    size_t bins = (size_t) fmin (BINS, fmax (4, ceil (sqrt ((double) s->n)))), m = 0;
    double width = (s->most - s->least) / (double) bins;
    *drawn = s->n >= 2 && width > 0;
    if (!*drawn) return PG_OK;
    double factor = pg_chart_unit (fmax (fabs (s->most), fabs (s->least)), unit, scaled, sizeof scaled);
    for (size_t k = 0; k < s->n; k++)
        count[(size_t) fmin ((double) bins - 1, floor ((value[k] - s->least) / width))]++;
    for (size_t b = 0; b < bins; b++) {
        double from = (s->least + width * (double) b) * factor, to = from + width * factor;
        const double px[4] = { from, from, to, to }, py[4] = { 0, count[b], count[b], 0 };
        for (int k = 0; k < 4; k++) x[m] = px[k], y[m++] = py[k];
        height[1] = fmax (height[1], count[b]);
    }
    mean[0] = mean[1] = s->mean * factor, height[1] *= 1.15;
    snprintf (label, sizeof label, "%.100s%s%s%s", quantity, *scaled ? " (" : "", scaled, *scaled ? ")" : "");
    pg_curve curves[2] = { { .name = "runs", .n = m, .x = x, .y = y, .points = PG_CURVE_LINE },
                           { .name = "mean", .n = 2, .x = mean, .y = height, .points = PG_CURVE_LINE } };
    pg_chart_style style = { .title = title, .xlabel = label, .ylabel = "number of runs", .beside = 1 };
    PG_TRY (pg_picture_chart (path, 2, curves, &style));
done:
    return status;
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * Axes of charts, fields and colour bars. Ticks are round numbers (1, 2 or 5 times a power of ten, or
 * powers of ten alone on a logarithmic axis), as many as their texts leave room for; texts carry no digits
 * that are only rounding noise; a common power of ten is moved into the label, as an SI prefix where the
 * unit takes one ("stress (MPa)") and as a factor elsewhere. */
#include "picture_private.h"
#include <math.h>
#include <string.h>

#define MINUS "\xe2\x88\x92"
#define TIMES "\xc3\x97"

/* Widens a range that is empty but for rounding noise: by a tenth of the value to both sides; a range at zero
 * becomes 0 to 1. */
void pg_range_widen (double *low, double *high)
{
    double size = fmax (fabs (*low), fabs (*high));
    if (*high - *low > 1e-10 * size && size > 0) return;            /* a smaller range is rounding noise */
    double middle = 0.5 * (*low + *high);
    if (size == 0) *low = 0, *high = 1;
    else *low = middle - 0.1 * size, *high = middle + 0.1 * size;
}

/* Cuts a range of positive values to its upper six decades, and widens one that is almost a single value
 * to a decade. */
void pg_range_decades (double *low, double *high)
{
    if (!(*high > 0)) *high = 1;
    if (!(*low >= 1e-6 * *high)) *low = 1e-6 * *high;
    if (!(*low < 0.999 * *high)) *low = 0.1 * *high;
}

/* One pass over the values; the order of comparison does not matter, since NAN is skipped. */
int pg_range_of (size_t n, const double *value, int log, double *low, double *high)
{
    int found = 0;
    for (size_t i = 0; i < n; i++) {
        if (!isfinite (value[i]) || (log && !(value[i] > 0))) continue;
        if (!found || value[i] < *low) *low = value[i];
        if (!found || value[i] > *high) *high = value[i];
        found = 1;
    }
    if (!found) *low = log ? 1 : 0, *high = log ? 10 : 1;
    return found;
}

/* Writes a number with a typographic minus, and none in front of a zero that only rounding made negative. */
static void number (char *text, size_t size, double value, int decimals)
{
    char plain[64];
    snprintf (plain, sizeof plain, "%.*f", decimals, fabs (value));
    int zero = strspn (plain, "0.") == strlen (plain);
    snprintf (text, size, "%s%.32s", value < 0 && !zero ? MINUS : "", plain);
}

/* The SI prefix for 10^power before the unit in brackets at the end of a label, "stress (Pa)";
 * *unit is then the index of the unit in the label. NULL if the unit takes none: unknown
 * units, and multiples of m and s, since neither Mm nor ks is usual. */
static const char *prefix_of (const char *label, int power, size_t *unit)
{
    static const char *const si[] = { "Pa", "m", "N", "J", "W", "s" };
    static const char *const prefix[] = { "n", "\xc2\xb5", "m", "", "k", "M", "G", "T" };
    size_t n = strlen (label);
    const char *open = strrchr (label, '(');
    if (!open || n == 0 || label[n - 1] != ')' || power < -9 || power > 12) return NULL;
    for (size_t k = 0; k < sizeof si / sizeof *si; k++) {
        size_t m = strlen (si[k]);
        if (strncmp (open + 1, si[k], m) != 0 || !strchr (")/ ", open[1 + m])) continue;
        if (power > 0 && (strcmp (si[k], "m") == 0 || strcmp (si[k], "s") == 0)) return NULL;
        *unit = (size_t) (open + 1 - label);
        return prefix[power / 3 + 3];
    }
    return NULL;
}

/* The unit is the largest of s, ms, µs and ns in which four digits show at least 1. */
void pg_picture_time (double t, char *out, size_t size)
{
    static const char *const unit[] = { "s", "ms", "\xc2\xb5s", "ns" };
    int k = 0;
    while (k < 3 && fabs (t) > 0 && fabs (t) * pow (1000, k) < 0.9995) k++;
    snprintf (out, size, "%.4g %s", t * pow (1000, k), unit[k]);
}

/* A prefix in front of m2 or m3 would be squared or cubed with the unit, so that these keep none, and
 * lengths end at km. */
void pg_picture_quantity (double value, const char *unit, char *out, size_t size)
{
    static const char *const prefix[] = { "n", "\xc2\xb5", "m", "", "k", "M", "G", "T" };
    int power = *unit == 'm' && unit[1] >= '2' && unit[1] <= '9', k = 0;  /* a prefix would be squared */
    int lowest = power ? 0 : -3, highest = power ? 0 : *unit == 'm' ? 1 : 4;
    if (value != 0 && isfinite (value))
        k = (int) fmin (fmax (floor (log10 (fabs (value) * 1.00005) / 3), lowest), highest);
    snprintf (out, size, "%.4g %s%s", value / pow (1000, k), prefix[k + 3], unit);
}

/* Chooses the power of ten by which the texts are divided and writes it into the label: as an SI prefix of
 * the unit, or as a factor in front of it; values from 0.001 to 100 000 stay as they are. Returns the
 * power. */
static int scale_label (pg_axis *a, double low, double high, const char *label, int plain)
{
    double top = fmax (fabs (low), fabs (high));
    size_t unit = 0, n = strlen (label), room = sizeof a->label;
    snprintf (a->label, room, "%s", label);
    if (plain || !(top > 0)) return 0;
    int power = 3 * (int) floor (log10 (top) / 3 + 1e-9);
    const char *prefix = prefix_of (label, power, &unit);
    if (prefix && (top < 0.1 || top >= 1e4)) {
        snprintf (a->label, room, "%.*s%s%s", (int) unit, label, prefix, label + unit);
        return power;
    }
    if (top >= 1e-3 && top < 1e5) return 0;
    const char *open = strrchr (label, '('), *sign = power < 0 ? MINUS : "";
    int size = power < 0 ? -power : power;
    if (open && label[n - 1] == ')')
        snprintf (a->label, room, "%.*s(%s10^{%s%d} %s", (int) (open - label), label, TIMES, sign, size,
                  open + 1);
    else snprintf (a->label, room, "%s%s(%s10^{%s%d})", label, n ? " " : "", TIMES, sign, size);
    return power;
}

/* The smallest of 1, 2, 5 x 10^k that is not below raw, and the decimals that its multiples
 * need. */
static double round_step (double raw, int *decimals)
{
    double k = floor (log10 (raw) + 1e-9), base = pow (10, k), f = raw / base;
    double step = f <= 1 + 1e-9 ? 1 : f <= 2 + 1e-9 ? 2 : f <= 5 + 1e-9 ? 5 : 10;
    if (step == 10) k++;
    *decimals = k < 0 ? (int) -k : 0;
    return step * base;
}

/* Pixels that the text of tick k takes along the axis, with the gap that keeps it apart from its
 * neighbours. */
static double extent (const pg_axis *a, cairo_t *cr, int k)
{
    return a->side == PG_BOTTOM ? pg_text (cr, a->text[k], PG_FONT, 0, 0, 0, 0, 0) + 1.2 * PG_FONT
                                : 1.6 * PG_FONT;
}

/* Do neighbouring texts keep clear of each other on an axis of `length` pixels? */
static int texts_fit (const pg_axis *a, cairo_t *cr, double length)
{
    for (int k = 0; k + 1 < a->n; k++) {
        double gap = fabs (pg_axis_at (a, a->tick[k + 1]) - pg_axis_at (a, a->tick[k])) * length;
        if (gap < 0.5 * (extent (a, cr, k) + extent (a, cr, k + 1))) return 0;
    }
    return 1;
}

/* Ticks for about `target` intervals; scale is the power of ten that the label carries. grow
 * moves the ends outwards to ticks. Ticks are integer multiples of the step, so that rounding
 * does not add up along the axis. */
static void linear_ticks (pg_axis *a, double low, double high, int target, double scale, int grow)
{
    int decimals;
    double step = round_step ((high - low) / scale / target, &decimals);
    double first = low / scale / step, last = high / scale / step;
    first = grow ? floor (first + 1e-6) : ceil (first - 1e-6);
    last = grow ? ceil (last - 1e-6) : floor (last + 1e-6);
    a->low = grow ? first * step * scale : low;
    a->high = grow ? last * step * scale : high;
    a->n = 0;
    for (double k = first; k <= last && a->n < PG_TICKS; k++, a->n++) {
        a->tick[a->n] = k * step * scale;
        number (a->text[a->n], sizeof a->text[0], k * step, decimals);
    }
}

/* Takes fewer and fewer ticks until their texts fit: at most 10, and one every 105 pixels across or 72
 * pixels upwards. */
static void fit_linear (pg_axis *a, cairo_t *cr, double low, double high, double length,
                        const pg_axis_request *request)
{
    pg_range_widen (&low, &high);
    double scale = pow (10, scale_label (a, low, high, request->label, request->plain));
    int target = (int) (length / (request->side == PG_BOTTOM ? 105 : 72));
    if (target > 10) target = 10;
    if (target < 2) target = 2;
    do linear_ticks (a, low, high, target, scale, request->grow);
    while (!texts_fit (a, cr, length) && --target > 0);
}

/* Value number `place` of the sequence ... 0.5, 1, 2, 5, 10, 20, 50 ...: number 0 is 1, number 3
 * is 10, number -1 is 0.5. */
static double row_value (int place)
{
    static const double m[] = { 1, 2, 5 };
    int k = (int) floor (place / 3.0);
    return m[place - 3 * k] * pow (10, k);
}

/* A logarithmic axis over less than two decades: ticks at 1, 2 and 5 times powers of ten; the
 * axis ends on the nearest of these outside the data. Beyond 10^3 and 10^-3 the texts have a
 * power of ten. */
static void short_log_ticks (pg_axis *a, double low, double high)
{
    int first = 3 * (int) floor (log10 (low)) - 3, k;
    while (row_value (first + 1) <= low * (1 + 1e-9)) first++;
    int last = first + 1;
    while (row_value (last) < high * (1 - 1e-9)) last++;
    a->low = row_value (first), a->high = row_value (last);
    for (k = first; k <= last && a->n < PG_TICKS; k++, a->n++) {
        int power = (int) floor (k / 3.0);
        a->tick[a->n] = row_value (k);
        if (power >= -3 && power <= 3)
            number (a->text[a->n], sizeof a->text[0], a->tick[a->n], power < 0 ? -power : 0);
        else
            snprintf (a->text[a->n], sizeof a->text[0], "%.0f" TIMES "10^{%s%d}",
                      a->tick[a->n] / pow (10, power), power < 0 ? MINUS : "", power < 0 ? -power : power);
    }
}

/* A logarithmic axis over more than two decades: ticks at powers of ten, at every second,
 * third ... one if the texts need it. The axis is 3 % longer than the data at each end. */
static void long_log_ticks (pg_axis *a, cairo_t *cr, double low, double high, double length)
{
    double l = log10 (low), h = log10 (high), pad = 0.03 * (h - l);
    a->low = pow (10, l -= pad), a->high = pow (10, h += pad);
    int first = (int) ceil (l - 1e-9), last = (int) floor (h + 1e-9),
        stride = 1 + (last - first) / (PG_TICKS - 1);
    do {
        a->n = 0;
        for (int k = first; k <= last && a->n < PG_TICKS; k += stride, a->n++) {
            a->tick[a->n] = pow (10, k);
            snprintf (a->text[a->n], sizeof a->text[0], "10^{%s%d}", k < 0 ? MINUS : "", k < 0 ? -k : k);
        }
    } while (a->n > 2 && !texts_fit (a, cr, length) && ++stride);
}

/* Below two decades the axis gets ticks at 1, 2 and 5; above, at powers of ten, with unlabelled ticks at 2
 * to 9 times each. */
static void fit_log (pg_axis *a, cairo_t *cr, double low, double high, double length,
                     const pg_axis_request *request)
{
    snprintf (a->label, sizeof a->label, "%s", request->label);
    if (!(low > 0) || !(high >= low) || !isfinite (high)) low = 1, high = 10;
    if (high < 100 * low) short_log_ticks (a, low, high);
    else long_log_ticks (a, cr, low, high, length);
    int first = (int) floor (log10 (a->low) + 1e-9), last = (int) floor (log10 (a->high) + 1e-9);
    for (int k = first; k <= last && last - first < 13; k++)
        for (int m = 2; m < 10 && a->nminor < PG_MINOR; m++) {
            double v = m * pow (10, k);
            if (v >= a->low && v <= a->high) a->minor[a->nminor++] = v;
        }
}

void pg_axis_fit (pg_axis *a, cairo_t *cr, double low, double high, double length,
                  const pg_axis_request *request)
{
    *a = (pg_axis) { .log = request->log, .side = request->side };
    (request->log ? fit_log : fit_linear) (a, cr, low, high, length, request);
}

/* Position of a value along the axis, as a fraction of its length from its left or lower end. */
double pg_axis_at (const pg_axis *a, double value)
{
    double t = a->log ? log10 (value / a->low) / log10 (a->high / a->low)
                      : (value - a->low) / (a->high - a->low);
    return a->reverse ? 1 - t : t;
}

/* Width of the widest text of a tick, pixels. */
static double widest (const pg_axis *a, cairo_t *cr)
{
    double w = 0;
    for (int k = 0; k < a->n; k++) w = fmax (w, pg_text (cr, a->text[k], PG_FONT, 0, 0, 0, 0, 0));
    return w;
}

/* Distance of the middle of the label from the frame, pixels. */
static double label_place (const pg_axis *a, cairo_t *cr)
{
    double raised = a->log ? 0.15 * PG_FONT : 0;
    return a->side == PG_BOTTOM ? PG_TICK + 2.75 * PG_FONT + raised
                                : PG_TICK + 8 + widest (a, cr) + 1.05 * PG_FONT;
}

/* Pixels that ticks, texts and label take beside the frame. */
double pg_axis_margin (const pg_axis *a, cairo_t *cr)
{
    return a->label[0] ? label_place (a, cr) + 0.9 * PG_FONT : label_place (a, cr) - 0.4 * PG_FONT;
}

/* The pixel on the frame (x, y, w, h) where the tick of a value begins, moved to the middle of
 * a pixel so that lines of two pixels' width are sharp. */
static void foot (const pg_axis *a, double value, double x, double y, double w, double h, double *px,
                  double *py)
{
    double t = pg_axis_at (a, value);
    *px = a->side == PG_BOTTOM ? x + t * w : a->side == PG_LEFT ? x : x + w;
    *py = a->side == PG_BOTTOM ? y + h : y + (1 - t) * h;
    *px = floor (*px) + 0.5, *py = floor (*py) + 0.5;
}

/* Small ticks first, then ticks, texts and the label. */
void pg_axis_draw (const pg_axis *a, cairo_t *cr, double x, double y, double w, double h)
{
    double px, py, dx = a->side == PG_LEFT ? -1 : a->side == PG_RIGHT, dy = a->side == PG_BOTTOM,
                   size = PG_FONT;
    double from = label_place (a, cr);
    cairo_set_source_rgb (cr, 0, 0, 0);
    cairo_set_line_width (cr, 2);
    for (int k = 0; k < a->nminor; k++) {
        foot (a, a->minor[k], x, y, w, h, &px, &py);
        cairo_move_to (cr, px, py);
        cairo_rel_line_to (cr, 0.55 * PG_TICK * dx, 0.55 * PG_TICK * dy);
    }
    for (int k = 0; k < a->n; k++) {
        foot (a, a->tick[k], x, y, w, h, &px, &py);
        cairo_move_to (cr, px, py);
        cairo_rel_line_to (cr, PG_TICK * dx, PG_TICK * dy);
    }
    cairo_stroke (cr);
    for (int k = 0; k < a->n; k++) {
        foot (a, a->tick[k], x, y, w, h, &px, &py);
        double align = a->side == PG_BOTTOM ? 0.5 : a->side == PG_LEFT ? 1 : 0, gap = PG_TICK + 8;
        pg_text (cr, a->text[k], size, px + gap * dx, py + (PG_TICK + 0.9 * size) * dy, align, 0, 1);
    }
    if (a->side == PG_BOTTOM) pg_text (cr, a->label, size, x + 0.5 * w, y + h + from, 0.5, 0, 1);
    else pg_text (cr, a->label, size, a->side == PG_LEFT ? x - from : x + w + from, y + 0.5 * h, 0.5, 1, 1);
}

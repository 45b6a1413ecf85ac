/* SPDX-License-Identifier: GPL-3.0-or-later
 * What the cracks of a scene amount to, for check and cracks: how many, how long, in which directions, how
 * near to each other, and what touching, crossing and leaving the body mean. */
#include "cli.h"
#include <math.h>
#include <stdio.h>

/* A length with a suitable unit. */
static const char *length_of (double x, char out[32])
{
    static const struct { double unit; const char *name; } units[] = {
        { 1e3, "km" }, { 1, "m" }, { 1e-3, "mm" }, { 1e-6, "um" }, { 1e-9, "nm" } };
    size_t k = 0;
    while (k + 1 < sizeof units / sizeof *units && x < 0.9999999 * units[k].unit) k++;
    if (x == 0) snprintf (out, 32, "0");
    else snprintf (out, 32, "%.4g %s", x / units[k].unit, units[k].name);
    return out;
}

static void print_row (const char *name, const char *text) { printf ("  %-18s  %s\n", name, text); }

/* Number, sizes, and what slots take. */
static void print_sizes (const pg_network *n, int dim)
{
    char a[32], b[32], text[200];
    size_t used = (size_t) snprintf (text, sizeof text, "%zu", n->n);
    if (n->slots == n->n)
        used += (size_t) snprintf (text + used, sizeof text - used, n->n == 1 ? ", a slot" : ", all slots");
    else if (n->slots)
        used += (size_t) snprintf (text + used, sizeof text - used, ", %zu of them slots", n->slots);
    if (n->n == 1) snprintf (text + used, sizeof text - used, ", length %s", length_of (n->mean, a));
    else {
        used +=
            (size_t) snprintf (text + used, sizeof text - used, ", lengths %s to ", length_of (n->least, a));
        used += (size_t) snprintf (text + used, sizeof text - used, "%s, mean %s", length_of (n->most, a),
                                   length_of (n->mean, b));
        snprintf (text + used, sizeof text - used, " +- %s", length_of (n->deviation, a));
    }
    print_row ("cracks", text);
    if (!(n->body > 0)) return;
    snprintf (text, sizeof text, "%.4g /m: %s of %s in %.4g %s of body", n->inside / n->body,
              dim == 2 ? "length" : "area", dim == 2 ? length_of (n->inside, a) : "cracks", n->body,
              dim == 2 ? "m2" : "m3");
    if (dim == 3)
        snprintf (text, sizeof text, "%.4g /m: %.4g m2 of cracks in %.4g m3 of body", n->inside / n->body,
                  n->inside, n->body);
    print_row ("crack intensity", text);
    if (!n->slots) return;
    snprintf (text, sizeof text, "%.4g %% of the body (overlaps counted twice)", 100 * n->removed / n->body);
    print_row ("slots take", text);
}

/* Directions and neighbours. */
static void print_order (const pg_network *n, int dim)
{
    char a[32], text[200];
    if (n->n > 1) {
        if (dim == 2)
            snprintf (text, sizeof text,
                      "on the mean at %.3g deg, order %.2g (0 all directions, 1 all alike)",
                      fmod (atan2 (n->axis[1], n->axis[0]) * 180 / acos (-1) + 180, 180), n->order);
        else
            snprintf (text, sizeof text, "normals on the mean along (%.3g, %.3g, %.3g), order %.2g (0 all "
                      "directions, 1 all alike)", n->axis[0], n->axis[1], n->axis[2], n->order);
        print_row ("crack directions", text);
        if (!n->crossing && isfinite (n->nearest)) {
            snprintf (text, sizeof text, "the nearest two are %s apart", length_of (n->nearest, a));
            print_row ("crack distances", text);
        }
    }
    if (n->crossing) {
        snprintf (text, sizeof text, "%zu touch or cross another: together they cut as one crack",
                  n->crossing);
        print_row ("cracks", text);
    }
    if (n->leaving) {
        snprintf (text, sizeof text, "%zu reach%s out of the body: cut off at its surface", n->leaving,
                  n->leaving == 1 ? "es" : "");
        print_row ("cracks", text);
    }
    if (n->vain) {
        snprintf (
            text, sizeof text,
            "%zu drawn in vain, too long to fit anywhere: lengths and directions are not quite as asked",
            n->vain);
        print_row ("random cracks", text);
    }
    if (n->outside) {
        snprintf (text, sizeof text, "%zu lie%s outside the body, without effect", n->outside,
                  n->outside == 1 ? "s" : "");
        print_row ("cracks", text);
    }
}

void plan_network (const pg_network *n, int dim)
{
    if (n->n == 0) return;
    print_sizes (n, dim);
    print_order (n, dim);
}

void plan_network_json (pg_json *j, const pg_network *n, int dim)
{
    if (n->n == 0) return;
    pg_json_open (j, "cracks", '{');
    pg_json_count (j, "count", n->n);
    pg_json_count (j, "slots", n->slots);
    pg_json_count (j, "crossing", n->crossing);
    pg_json_count (j, "leaving", n->leaving);
    pg_json_count (j, "outside", n->outside);
    pg_json_count (j, "drawn_in_vain", n->vain);
    pg_json_number (j, dim == 2 ? "length" : "area", n->size);
    pg_json_number (j, dim == 2 ? "length_inside" : "area_inside", n->inside);
    pg_json_number (j, "removed", n->removed);
    pg_json_number (j, "body", n->body);
    pg_json_number (j, "mean_length", n->mean);
    pg_json_number (j, "deviation", n->deviation);
    pg_json_number (j, "least_length", n->least);
    pg_json_number (j, "largest_length", n->most);
    pg_json_number (j, "order", n->order);
    pg_json_number (j, "least_distance", n->nearest);
    pg_json_shut (j);
}

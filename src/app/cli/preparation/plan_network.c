/* SPDX-License-Identifier: GPL-3.0-or-later
 * Description of the cracks of a scene, for the commands check and cracks: how many, how long, in which
 * directions, how near to each other, and how many touch, cross or leave the body. */
#include "cli.h"
#include <math.h>
#include <stdio.h>

/* Writes a length x (m) with a suitable unit. */
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

/* Prints number and sizes of the cracks, and the share of the body that slots remove. */
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
    snprintf (text, sizeof text, "%.4g /m (P21): %s of %s in %.4g %s of body",
              n->inside / n->body,
              dim == 2 ? "length" : "area", dim == 2 ? length_of (n->inside, a) : "cracks", n->body,
              dim == 2 ? "m2" : "m3");
    if (dim == 3)
        snprintf (text, sizeof text, "%.4g /m (P32): %.4g m2 of cracks in %.4g m3 of body",
                  n->inside / n->body, n->inside, n->body);
    print_row ("crack intensity", text);
    if (!n->slots) return;
    snprintf (text, sizeof text, "%.4g %% of the body (overlaps counted twice)", 100 * n->removed / n->body);
    print_row ("slots take", text);
}

/* Prints directions, distances, and cracks that touch, leave or miss the body. */
static void print_order (const pg_network *n, int dim)
{
    char a[32], text[200];
    if (n->n > 1) {
        if (dim == 2)
            snprintf (text, sizeof text,
                      "on the mean at %.3g deg, order %.2g (0 all directions, 1 all alike)",
                      pg_network_direction (n), n->order);
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

/* Prints one line for every entry of the scene that holds cracks. */
static void print_sets (const pg_crack_statistics *s)
{
    char a[32], b[32], text[200];
    for (size_t k = 0; k < s->nset; k++) {
        const pg_network *n = &s->set[k].of;
        size_t used = (size_t) snprintf (text, sizeof text, "%zu, mean %s +- %s", n->n,
                                         length_of (n->mean, a), length_of (n->deviation, b));
        if (s->dim == 2)
            used += (size_t) snprintf (text + used, sizeof text - used, ", at %.3g deg, order %.2g",
                                       pg_network_direction (n), n->order);
        else
            used += (size_t) snprintf (text + used, sizeof text - used,
                                       ", normals along (%.3g, %.3g, %.3g), order %.2g", n->axis[0],
                                       n->axis[1], n->axis[2], n->order);
        if (n->body > 0)
            snprintf (text + used, sizeof text - used, ", %s %.4g /m", s->dim == 2 ? "P21" : "P32",
                      n->inside / n->body);
        snprintf (a, sizeof a, "  of cracks[%zu]", s->set[k].entry);
        print_row (a, text);
    }
}

void plan_network (const pg_crack_statistics *s)
{
    if (s->all.n == 0) return;
    print_sizes (&s->all, s->dim);
    print_order (&s->all, s->dim);
    print_sets (s);
}

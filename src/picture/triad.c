/* SPDX-License-Identifier: GPL-3.0-or-later
 * The triad: the coordinate axes as the eye sees them, the one that is farthest away drawn first. An axis
 * that points straight at the eye, or away from it, is a dot. */
#include "picture_private.h"
#include <math.h>

/* Arrows along x, y, z with their names; those towards the eye last. */
void pg_wire_triad (const pg_sheet *p, cairo_t *cr, double x, double y, double length)
{
    static const double colour[3][3] = { { 0.75, 0.15, 0.12 }, { 0.10, 0.50, 0.20 }, { 0.10, 0.30, 0.70 } };
    int order[3] = { 0, 1, 2 };
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 2; j++)
            if (p->eye.toward[order[j]] > p->eye.toward[order[j + 1]]) {
                int swap = order[j];
                order[j] = order[j + 1], order[j + 1] = swap;
            }
    cairo_set_line_width (cr, 3);
    for (int k = 0; k < 3; k++) {
        int a = order[k];
        double dx = length * p->eye.right[a], dy = -length * p->eye.up[a], size = hypot (dx, dy), arm = 11;
        cairo_set_source_rgb (cr, colour[a][0], colour[a][1], colour[a][2]);
        if (size < 0.15 * length) {                    /* straight at the eye, or away from it */
            cairo_arc (cr, x, y, 5, 0, 6.283185307179586);
            cairo_fill (cr);
            pg_text (cr, (const char[2]) { "xyz"[a], 0 }, 0.85 * PG_FONT, x - 16, y + 14, 0.5, 0, 1);
            continue;
        }
        cairo_move_to (cr, x, y);
        cairo_line_to (cr, x + dx, y + dy);
        cairo_stroke (cr);
        double ux = dx / size, uy = dy / size;
        cairo_move_to (cr, x + dx + 3 * ux, y + dy + 3 * uy);
        cairo_line_to (cr, x + dx - arm * ux - 0.4 * arm * uy, y + dy - arm * uy + 0.4 * arm * ux);
        cairo_line_to (cr, x + dx - arm * ux + 0.4 * arm * uy, y + dy - arm * uy - 0.4 * arm * ux);
        cairo_fill (cr);
        pg_text (cr, (const char[2]){ "xyz"[a], 0 }, 0.85 * PG_FONT, x + dx + 17 * ux, y + dy + 17 * uy, 0.5,
                 0, 1);
    }
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * The surface under a picture, written as PNG or SVG by the ending of the file's name, and text on it.
 * Cairo draws into memory and the bytes pass through a function of ours, so that a full disk is reported with
 * the system's reason and leaves no half file. */
#include "picture_private.h"
#include "perigal/output.h"
#include <errno.h>
#include <string.h>
#include <strings.h>

/* Takes the bytes that cairo has encoded; remembers errno of the first write that failed, because cairo
 * itself only says that one did. */
static cairo_status_t write_bytes (void *closure, const unsigned char *data, unsigned int n)
{
    pg_canvas *c = closure;
    errno = 0;
    if (fwrite (data, 1, n, c->file) == n) return CAIRO_STATUS_SUCCESS;
    if (!c->reason) c->reason = errno ? errno : EIO;
    return CAIRO_STATUS_WRITE_ERROR;
}

int pg_ends_with (const char *path, const char *ending)
{
    size_t n = strlen (path), m = strlen (ending);
    return n >= m && strcasecmp (path + n - m, ending) == 0;
}

/* Makes a white sheet of width x height pixels (points in SVG); the file is created at once, so that a folder
 * that cannot be written to is noticed before anything is drawn. */
pg_status pg_canvas_open (pg_canvas *c, const char *path, double width, double height)
{
    pg_status status = PG_OK;
    *c = (pg_canvas) { .path = path, .svg = pg_ends_with (path, ".svg") };
    if (!c->svg && !pg_ends_with (path, ".png"))
        PG_FAIL (PG_E_USAGE, "%s: a picture's file ends in .png or .svg", path);
    PG_TRY (pg_cairo_load ());
    PG_TRY (pg_file_create (&c->file, path));
    c->surface = c->svg ? cairo_svg_surface_create_for_stream (write_bytes, c, width, height)
                        : cairo_image_surface_create (CAIRO_FORMAT_RGB24, (int) width, (int) height);
    c->cr = cairo_create (c->surface);
    if (cairo_status (c->cr) != CAIRO_STATUS_SUCCESS)
        PG_FAIL (PG_E_MEMORY, "%s: %.0f x %.0f pixels: %s", path, width, height,
                 cairo_status_to_string (cairo_status (c->cr)));
    cairo_set_source_rgb (c->cr, 1, 1, 1);
    cairo_paint (c->cr);
    cairo_set_source_rgb (c->cr, 0, 0, 0);
done:
    return status;
}

/* Ends the surface, whose bytes go to the file if the picture is whole. Returns cairo's first fault. */
static cairo_status_t end_surface (pg_canvas *c, int whole)
{
    cairo_status_t fault = c->cr ? cairo_status (c->cr) : CAIRO_STATUS_SUCCESS;
    if (c->cr) cairo_destroy (c->cr);
    if (!c->surface) return fault;
    if (whole && fault == CAIRO_STATUS_SUCCESS && !c->svg)
        fault = cairo_surface_write_to_png_stream (c->surface, write_bytes, c);
    cairo_surface_finish (c->surface);
    if (fault == CAIRO_STATUS_SUCCESS) fault = cairo_surface_status (c->surface);
    cairo_surface_destroy (c->surface);
    return fault;
}

/* Writes the picture if all went well so far, and otherwise removes the file. Returns the first fault: of
 * the caller, of the disk, of cairo. */
pg_status pg_canvas_close (pg_canvas *c, pg_status given)
{
    pg_status status = given;
    cairo_status_t fault = end_surface (c, given == PG_OK);
    errno = 0;
    if (c->file && fclose (c->file) != 0 && !c->reason) c->reason = errno ? errno : EIO;
    if (given != PG_OK) goto done;
    if (c->reason) PG_FAIL (PG_E_FILE, "%s: %s", c->path, strerror (c->reason));
    if (fault == CAIRO_STATUS_NO_MEMORY) PG_FAIL (PG_E_MEMORY, "%s: no memory to draw", c->path);
    if (fault != CAIRO_STATUS_SUCCESS) PG_FAIL (PG_E_FILE, "%s: %s", c->path, cairo_status_to_string (fault));
done:
    if (status != PG_OK && c->file) remove (c->path);
    *c = (pg_canvas) { 0 };
    return status;
}

void pg_stroke (cairo_t *cr, double width, double red, double green, double blue)
{
    cairo_set_source_rgb (cr, red, green, blue);
    cairo_set_line_width (cr, width);
    cairo_stroke (cr);
}

/* 1 where raised text begins, -1 where lowered text does, else 0. */
static int level_at (const char *text)
{
    if ((text[0] != '^' && text[0] != '_') || text[1] != '{') return 0;
    return text[0] == '^' ? 1 : -1;
}

/* Lays the runs of a text one behind the other from the current point: plain runs, and those in ^{...} and
 * _{...}, which are smaller and raised or lowered. Returns the width of all; draw = 0 only measures. */
static double runs (cairo_t *cr, const char *text, double size, int draw)
{
    double x = 0, rise[] = { 0.16 * size, 0, -0.36 * size };
    char run[256];
    cairo_text_extents_t e;
    while (*text) {
        int level = strchr (text, '}') ? level_at (text) : 0;
        size_t n = 1;
        if (level) text += 2, n = strcspn (text, "}");
        else while (text[n] && !level_at (text + n)) n++;
        size_t keep = n < sizeof run ? n : sizeof run - 1;
        memcpy (run, text, keep);
        run[keep] = 0;
        cairo_set_font_size (cr, level ? 0.72 * size : size);
        cairo_text_extents (cr, run, &e);
        if (draw) cairo_move_to (cr, x, rise[level + 1]), cairo_show_text (cr, run);
        x += e.x_advance;
        text += n + (level != 0);
    }
    return x;
}

/* 0.364 of the font size is half of a capital letter, which centres the text on y. */
double pg_text (cairo_t *cr, const char *text, double size, double x, double y, double align, int turned,
                int draw)
{
    cairo_select_font_face (cr, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
    double width = runs (cr, text, size, 0);
    if (!draw) return width;
    cairo_save (cr);
    cairo_translate (cr, x, y);
    if (turned) cairo_rotate (cr, -1.5707963267948966);
    cairo_translate (cr, -align * width, 0.364 * size);  /* capitals are about 0.73 of the size high */
    runs (cr, text, size, 1);
    cairo_restore (cr);
    cairo_new_path (cr);
    return width;
}

/* Shrinks a title that is wider than the picture, and moves one that would stick out at a side. */
void pg_title (cairo_t *cr, const char *title, double x, double y, double width)
{
    double size = PG_FONT_TITLE, room = width - 20, w = pg_text (cr, title, size, 0, 0, 0, 0, 0);
    if (w > room) size *= room / w, w = room;
    if (x < 10 + 0.5 * w) x = 10 + 0.5 * w;
    if (x > width - 10 - 0.5 * w) x = width - 10 - 0.5 * w;
    pg_text (cr, title, size, x, y, 0.5, 0, 1);
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * The functions of cairo that pictures are drawn with. Cairo is loaded when the first picture is drawn (see
 * base/library.c): a name below is the entry of a table, which pg_cairo_load fills. Another function needs
 * its name in both lists. */
#ifndef PERIGAL_PICTURE_CAIRO_CALLS_H
#define PERIGAL_PICTURE_CAIRO_CALLS_H
#include "perigal/base.h"
#include <cairo.h>
#include <cairo-svg.h>

/* Every function, as X (name), and the table: pointers of the types that cairo's headers declare. */
#define PG_CAIRO_CALLS(X) \
    X (cairo_arc) X (cairo_clip) X (cairo_close_path) X (cairo_create) X (cairo_destroy) X (cairo_fill) \
    X (cairo_fill_preserve) X (cairo_get_source) X (cairo_image_surface_create) \
    X (cairo_image_surface_get_data) X (cairo_image_surface_get_stride) X (cairo_line_to) \
    X (cairo_move_to) X (cairo_new_path) X (cairo_new_sub_path) X (cairo_paint) \
    X (cairo_pattern_add_color_stop_rgb) X (cairo_pattern_create_linear) X (cairo_pattern_destroy) \
    X (cairo_pattern_set_filter) X (cairo_rectangle) X (cairo_rel_line_to) X (cairo_restore) \
    X (cairo_rotate) X (cairo_save) X (cairo_scale) X (cairo_select_font_face) X (cairo_set_dash) \
    X (cairo_set_font_size) X (cairo_set_line_cap) X (cairo_set_line_join) X (cairo_set_line_width) \
    X (cairo_set_source) X (cairo_set_source_rgb) X (cairo_set_source_rgba) X (cairo_set_source_surface) \
    X (cairo_show_text) X (cairo_status) X (cairo_status_to_string) X (cairo_stroke) \
    X (cairo_stroke_preserve) X (cairo_surface_destroy) X (cairo_surface_finish) \
    X (cairo_surface_mark_dirty) X (cairo_surface_status) X (cairo_surface_write_to_png_stream) \
    X (cairo_svg_surface_create_for_stream) X (cairo_text_extents) X (cairo_translate)
struct pg_cairo_calls {
#define X(name) __typeof__ (name) *name;
    PG_CAIRO_CALLS (X)
#undef X
};
extern struct pg_cairo_calls pg_cairo;
/* Must have succeeded before any of the functions is called. PG_E_FILE: cairo is not installed. */
pg_status pg_cairo_load (void);

#define cairo_arc(...)                           pg_cairo.cairo_arc (__VA_ARGS__)
#define cairo_clip(...)                          pg_cairo.cairo_clip (__VA_ARGS__)
#define cairo_close_path(...)                    pg_cairo.cairo_close_path (__VA_ARGS__)
#define cairo_create(...)                        pg_cairo.cairo_create (__VA_ARGS__)
#define cairo_destroy(...)                       pg_cairo.cairo_destroy (__VA_ARGS__)
#define cairo_fill(...)                          pg_cairo.cairo_fill (__VA_ARGS__)
#define cairo_fill_preserve(...)                 pg_cairo.cairo_fill_preserve (__VA_ARGS__)
#define cairo_get_source(...)                    pg_cairo.cairo_get_source (__VA_ARGS__)
#define cairo_image_surface_create(...)          pg_cairo.cairo_image_surface_create (__VA_ARGS__)
#define cairo_image_surface_get_data(...)        pg_cairo.cairo_image_surface_get_data (__VA_ARGS__)
#define cairo_image_surface_get_stride(...)      pg_cairo.cairo_image_surface_get_stride (__VA_ARGS__)
#define cairo_line_to(...)                       pg_cairo.cairo_line_to (__VA_ARGS__)
#define cairo_move_to(...)                       pg_cairo.cairo_move_to (__VA_ARGS__)
#define cairo_new_path(...)                      pg_cairo.cairo_new_path (__VA_ARGS__)
#define cairo_new_sub_path(...)                  pg_cairo.cairo_new_sub_path (__VA_ARGS__)
#define cairo_paint(...)                         pg_cairo.cairo_paint (__VA_ARGS__)
#define cairo_pattern_add_color_stop_rgb(...)    pg_cairo.cairo_pattern_add_color_stop_rgb (__VA_ARGS__)
#define cairo_pattern_create_linear(...)         pg_cairo.cairo_pattern_create_linear (__VA_ARGS__)
#define cairo_pattern_destroy(...)               pg_cairo.cairo_pattern_destroy (__VA_ARGS__)
#define cairo_pattern_set_filter(...)            pg_cairo.cairo_pattern_set_filter (__VA_ARGS__)
#define cairo_rectangle(...)                     pg_cairo.cairo_rectangle (__VA_ARGS__)
#define cairo_rel_line_to(...)                   pg_cairo.cairo_rel_line_to (__VA_ARGS__)
#define cairo_restore(...)                       pg_cairo.cairo_restore (__VA_ARGS__)
#define cairo_rotate(...)                        pg_cairo.cairo_rotate (__VA_ARGS__)
#define cairo_save(...)                          pg_cairo.cairo_save (__VA_ARGS__)
#define cairo_scale(...)                         pg_cairo.cairo_scale (__VA_ARGS__)
#define cairo_select_font_face(...)              pg_cairo.cairo_select_font_face (__VA_ARGS__)
#define cairo_set_dash(...)                      pg_cairo.cairo_set_dash (__VA_ARGS__)
#define cairo_set_font_size(...)                 pg_cairo.cairo_set_font_size (__VA_ARGS__)
#define cairo_set_line_cap(...)                  pg_cairo.cairo_set_line_cap (__VA_ARGS__)
#define cairo_set_line_join(...)                 pg_cairo.cairo_set_line_join (__VA_ARGS__)
#define cairo_set_line_width(...)                pg_cairo.cairo_set_line_width (__VA_ARGS__)
#define cairo_set_source(...)                    pg_cairo.cairo_set_source (__VA_ARGS__)
#define cairo_set_source_rgb(...)                pg_cairo.cairo_set_source_rgb (__VA_ARGS__)
#define cairo_set_source_rgba(...)               pg_cairo.cairo_set_source_rgba (__VA_ARGS__)
#define cairo_set_source_surface(...)            pg_cairo.cairo_set_source_surface (__VA_ARGS__)
#define cairo_show_text(...)                     pg_cairo.cairo_show_text (__VA_ARGS__)
#define cairo_status(...)                        pg_cairo.cairo_status (__VA_ARGS__)
#define cairo_status_to_string(...)              pg_cairo.cairo_status_to_string (__VA_ARGS__)
#define cairo_stroke(...)                        pg_cairo.cairo_stroke (__VA_ARGS__)
#define cairo_stroke_preserve(...)               pg_cairo.cairo_stroke_preserve (__VA_ARGS__)
#define cairo_surface_destroy(...)               pg_cairo.cairo_surface_destroy (__VA_ARGS__)
#define cairo_surface_finish(...)                pg_cairo.cairo_surface_finish (__VA_ARGS__)
#define cairo_surface_mark_dirty(...)            pg_cairo.cairo_surface_mark_dirty (__VA_ARGS__)
#define cairo_surface_status(...)                pg_cairo.cairo_surface_status (__VA_ARGS__)
#define cairo_surface_write_to_png_stream(...)   pg_cairo.cairo_surface_write_to_png_stream (__VA_ARGS__)
#define cairo_svg_surface_create_for_stream(...) pg_cairo.cairo_svg_surface_create_for_stream (__VA_ARGS__)
#define cairo_text_extents(...)                  pg_cairo.cairo_text_extents (__VA_ARGS__)
#define cairo_translate(...)                     pg_cairo.cairo_translate (__VA_ARGS__)
#endif

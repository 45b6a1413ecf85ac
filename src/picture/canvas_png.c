/* SPDX-License-Identifier: GPL-3.0-or-later
 * A surface as PNG by libpng, as it is fast: rows as they are and little search for repetitions (its flag
 * FAST). Cairo's own writer tries five filters on every row and searches thoroughly: its files are a third
 * smaller, and a picture takes half as long again. */
#include "picture_private.h"
#include <png.h>
#include <stddef.h>
#include <string.h>

/* Cairo brings libpng along; it is loaded by itself, as this is the only user of its functions. */
static struct { __typeof__ (png_image_write_to_memory) *write; } png;

static pg_status load (void)
{
    static const pg_library_function function[] = { { "png_image_write_to_memory", 0 } };
    static pg_library library = { PG_PNG_FILE, "libpng16-16", "pictures", 1, function, &png, 0, 0 };
    return pg_library_load (&library);
}

/* Red, green and blue of a row of pixels, which cairo keeps as one number each. */
static void take_row (const unsigned char *row, size_t n, unsigned char *to)
{
    for (size_t i = 0; i < n; i++) {
        uint32_t pixel;
        memcpy (&pixel, row + 4 * i, sizeof pixel);
        for (size_t k = 0; k < 3; k++) to[3 * i + k] = (unsigned char) (pixel >> (16 - 8 * k));
    }
}

pg_status pg_canvas_encode (cairo_surface_t *surface, const char *path, int width, int height,
                            unsigned char **out, size_t *size)
{
    pg_status status = PG_OK;
    unsigned char *rows = NULL, *data = NULL;
    png_image image = { .version = PNG_IMAGE_VERSION, .width = (png_uint_32) width,
                        .height = (png_uint_32) height, .format = PNG_FORMAT_RGB,
                        .flags = PNG_IMAGE_FLAG_FAST };
    PG_TRY (load ());
    png_alloc_size_t bytes = PNG_IMAGE_PNG_SIZE_MAX (image);
    size_t wide = 3 * (size_t) width;
    PG_ALLOC (rows, wide * (size_t) height);
    PG_ALLOC (data, bytes);
    const unsigned char *pixels = cairo_image_surface_get_data (surface);
    size_t stride = (size_t) cairo_image_surface_get_stride (surface);
    for (size_t j = 0; j < (size_t) height; j++)
        take_row (pixels + j * stride, (size_t) width, rows + j * wide);
    if (!png.write (&image, data, &bytes, 0, rows, 0, NULL))
        PG_FAIL (PG_E_FILE, "%s: %s", path, image.message);
    *out = data, *size = bytes, data = NULL;
done:
    pg_free (rows), pg_free (data);
    return status;
}

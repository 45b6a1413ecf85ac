/* SPDX-License-Identifier: GPL-3.0-or-later
 * Loads cairo and fills the table of its functions. */
#include "cairo_calls.h"
#include <stddef.h>

struct pg_cairo_calls pg_cairo;

/* PG_CAIRO_CALLS is expanded here to the text of each function's name and its offset in the table. */
pg_status pg_cairo_load (void)
{
    static const pg_library_function function[] = {
#define X(name) { #name, offsetof (struct pg_cairo_calls, name) },
        PG_CAIRO_CALLS (X)
#undef X
    };
    static pg_library cairo = { PG_CAIRO_FILE, "libcairo2", "pictures", sizeof function / sizeof *function,
                                function, &pg_cairo, 0, 0 };
    return pg_library_load (&cairo);
}

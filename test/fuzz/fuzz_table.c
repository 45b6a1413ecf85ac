/* SPDX-License-Identifier: GPL-3.0-or-later
 * Any bytes as a table of a reference (first byte: the dimension): rows at finite places, or a fault that
 * names file and line. */
#include "fuzz.h"
#include "perigal/compare.h"
#include <math.h>
#include <stdlib.h>
#include <unistd.h>

/* The table lies in a file of this process, since the library reads it by its name. */
static char table_path[] = "/tmp/perigal_table_XXXXXX";

static void remove_table (void) { unlink (table_path); }

static const char *table_file (const uint8_t *data, size_t size)
{
    static int descriptor = -1;
    if (descriptor < 0 && ((descriptor = mkstemp (table_path)) < 0 || atexit (remove_table)))
        FUZZ_BROKEN ("no temporary file");
    FUZZ_EXPECT (ftruncate (descriptor, 0) == 0);
    FUZZ_EXPECT (pwrite (descriptor, data, size, 0) == (ssize_t) size);
    return table_path;
}

int LLVMFuzzerTestOneInput (const uint8_t *data, size_t size)
{
    static const double along[3] = { 0.5, 0.25, 0 };
    size_t used = pg_memory_used ();
    if (size < 1 || size > LONGEST) return 0;
    pg_line line = { 0 };
    int dim = 1 + data[0] % 3;
    const char *path = table_file (data + 1, size - 1);
    pg_status status = pg_line_read (&line, path, dim, 1e-3, 2, along);
    FUZZ_EXPECT (status == PG_OK || status == PG_E_FILE);
    if (status == PG_OK) {
        FUZZ_EXPECT (line.n > 0 && line.ncolumn > 0 && line.ncolumn <= 9 && line.dim == dim);
        for (size_t k = 0; k < line.n * (size_t) dim; k++) FUZZ_EXPECT (isfinite (line.x[k]));
        for (size_t k = 0; k < line.n * line.ncolumn; k++) FUZZ_EXPECT (!isinf (line.value[k]));
    } else FUZZ_EXPECT (strstr (pg_last_error (), path));
    pg_line_clear (&line);
    FUZZ_EXPECT (pg_memory_used () == used);
    return 0;
}

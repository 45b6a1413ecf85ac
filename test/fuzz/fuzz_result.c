/* SPDX-License-Identifier: GPL-3.0-or-later
 * Any bytes as a result file (result.e): points and fields whose numbers of values fit, or a fault that names
 * the file. */
#include "fuzz.h"
#include "perigal/output.h"
#include <stdlib.h>
#include <unistd.h>

static char result_path[] = "/tmp/perigal_result_XXXXXX";

static void remove_result (void) { unlink (result_path); }

static const char *result_file (const uint8_t *data, size_t size)
{
    static int descriptor = -1;
    if (descriptor < 0 && ((descriptor = mkstemp (result_path)) < 0 || atexit (remove_result)))
        FUZZ_BROKEN ("no temporary file");
    FUZZ_EXPECT (ftruncate (descriptor, 0) == 0);
    FUZZ_EXPECT (pwrite (descriptor, data, size, 0) == (ssize_t) size);
    return result_path;
}

static volatile double touched;  /* every value is read, so that a sanitizer sees each */

static void touch (size_t n, const double *value) { for (size_t k = 0; k < n; k++) touched = value[k]; }

static void read_fields (const char *path, char (*names)[32], size_t n)
{
    for (size_t k = 0; k < n && k < 8; k++) {
        size_t values = 0;
        int components = 0;
        double *value = NULL;
        char unit[16];
        FUZZ_EXPECT (memchr (names[k], 0, sizeof names[k]));
        if (pg_exodus_read (path, names[k], -1, &values, &components, &value) == PG_OK)
            touch (values * (size_t) components, value);
        pg_free (value);
        if (pg_exodus_unit (path, names[k], unit) == PG_OK) FUZZ_EXPECT (memchr (unit, 0, sizeof unit));
    }
}

int LLVMFuzzerTestOneInput (const uint8_t *data, size_t size)
{
    size_t used = pg_memory_used (), steps = 0, n = 0;
    if (size > LONGEST) return 0;
    const char *path = result_file (data, size);
    pg_cloud cloud = { 0 };
    double *time = NULL;
    char (*names)[32] = NULL;
    pg_status status = pg_exodus_points (path, &cloud, &steps, &time);
    FUZZ_EXPECT (status == PG_OK || status == PG_E_FILE || status == PG_E_MEMORY);
    if (status == PG_OK) {
        FUZZ_EXPECT (cloud.n > 0 && cloud.dim >= 1 && cloud.dim <= 3);
        touch (cloud.n * (size_t) cloud.dim, cloud.x);
        touch (cloud.n, cloud.volume);
        touch (steps, time);
    }
    if (pg_exodus_fields (path, &names, &n) == PG_OK) read_fields (path, names, n);
    pg_free (names), pg_free (time);
    pg_cloud_clear (&cloud);
    FUZZ_EXPECT (pg_memory_used () == used);
    return 0;
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * Points with three fields for the tests of result.e: written, and compared with what was read. */
#ifndef PERIGAL_TEST_OUTPUT_EXODUS_SAMPLE_H
#define PERIGAL_TEST_OUTPUT_EXODUS_SAMPLE_H
#include "sample.h"

enum { FIELDS = 3 };

typedef struct { pg_cloud cloud; pg_field_view view[FIELDS]; double *value[FIELDS]; } sample;

static inline void fill (sample *s, double step)
{
    for (int v = 0; v < FIELDS; v++)
        for (size_t k = 0; k < s->cloud.n * (size_t) s->view[v].components; k++)
            s->value[v][k] = sin ((double) k + step) / 3 * pow (10, v);
}

static inline void begin (sample *s, int dim)
{
    make_cloud (&s->cloud, dim, dim == 3 ? 4 : 7, 1e-3 / 7);
    s->view[0] = (pg_field_view) { "displacement", "m", dim, NULL };
    s->view[1] = (pg_field_view) { "stress", "Pa", dim * (dim + 1) / 2, NULL };
    s->view[2] = (pg_field_view) { "damage", "", 1, NULL };
    for (int v = 0; v < FIELDS; v++)
        s->view[v].value = s->value[v] = pg_calloc (s->cloud.n * (size_t) s->view[v].components,
                                                    sizeof (double));
}

static inline void end (sample *s)
{
    for (int v = 0; v < FIELDS; v++) pg_free (s->value[v]);
    drop_cloud (&s->cloud);
}

static inline void write_steps (sample *s, const char *path, int steps)
{
    pg_exodus *file;
    check_ok (pg_exodus_create (&file, path, &s->cloud, "a test", FIELDS, s->view, NULL));
    for (int k = 0; k < steps; k++) {
        fill (s, k);
        check_ok (pg_exodus_write (file, 0.1 * k, s->view));
    }
    pg_exodus_close (&file);
    assert_null (file);
}

static inline void check_field (sample *s, const char *path, int v, int step)
{
    size_t n;
    int m;
    double *value;
    check_ok (pg_exodus_read (path, s->view[v].name, step, &n, &m, &value));
    assert_int_equal (n, s->cloud.n);
    assert_int_equal (m, s->view[v].components);
    assert_memory_equal (value, s->value[v], n * (size_t) m * sizeof (double));
    pg_free (value);
}
#endif

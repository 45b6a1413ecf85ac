/* SPDX-License-Identifier: GPL-3.0-or-later
 * tape.h: a checkpoint in memory; after run.h. As in a file, each array has a name of its own. */
#ifndef PERIGAL_TEST_TAPE_H
#define PERIGAL_TEST_TAPE_H
typedef struct { unsigned char *byte; size_t n, cap, at; } tape;

/* Names of the walk at hand, each behind a line end. */
static char  *tape_names;
static size_t tape_names_n, tape_names_cap;

static inline pg_status name_once (const char *name, size_t n)
{
    pg_status status = PG_OK;
    size_t length = strlen (name);
    if (!n) return PG_OK;                              /* empty arrays are not in a file */
    PG_GROW (tape_names, tape_names_cap, tape_names_n + length + 3);
    char *line = tape_names + tape_names_n;
    sprintf (line, "\n%s\n", name);
    if (strstr (tape_names, line) != line) fail_msg ("'%s' is kept twice under one name", name);
    tape_names_n += length + 1;
done:
    return status;
}

static inline pg_status run_tape (void *context, size_t bytes, void *value, int reading)
{
    pg_status status = PG_OK;
    tape *t = context;
    if (reading) {
        assert_true (t->at + bytes <= t->n);
        if (bytes) memcpy (value, t->byte + t->at, bytes);
        t->at += bytes;
    } else {
        PG_GROW (t->byte, t->cap, t->n + bytes);
        if (bytes) memcpy (t->byte + t->n, value, bytes);
        t->n += bytes;
    }
done:
    return status;
}
static int reading;
static inline pg_status keep_numbers (void *c, const char *name, size_t n, double *v)
{
    check_ok (name_once (name, n));
    return run_tape (c, n * sizeof *v, v, reading);
}
static inline pg_status keep_counts (void *c, const char *name, size_t n, long *v)
{
    check_ok (name_once (name, n));
    return run_tape (c, n * sizeof *v, v, reading);
}
static inline pg_status keep_bytes (void *c, const char *name, size_t n, void *v)
{
    check_ok (name_once (name, n));
    return run_tape (c, n, v, reading);
}

static inline void keep (run *r, tape *t, int read)
{
    pg_keeper k = {
        .context = t, .reading = read, .numbers = keep_numbers, .counts = keep_counts, .bytes = keep_bytes
    };
    reading = read, t->at = tape_names_n = 0;
    check_ok (pg_solver_keep (r->solver, r->state, &k));
    pg_free (tape_names), tape_names = NULL, tape_names_cap = 0;
}

/* One step of both runs, a and its copy b that was read back: the same to the last bit. */
static inline void advance_alike (run *a, run *b)
{
    advance (a), advance (b);
    assert_true (a->state->factor == b->state->factor && a->step.nbroken == b->step.nbroken
                 && a->step.dissipated == b->step.dissipated);
    assert_memory_equal (a->state->d, b->state->d, a->state->ndof * sizeof *a->state->d);
    assert_memory_equal (a->state->alive, b->state->alive, a->state->nbond);
}
#endif

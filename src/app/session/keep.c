/* SPDX-License-Identifier: GPL-3.0-or-later
 * The state of a session as a block of bytes: a head that names scene and points, then every piece that the
 * solver keeps, each with its name and length, then a checksum over all of it, which is compared before
 * anything is used. */
#include "session_private.h"
#include <string.h>

enum { HEAD = 32, HASH = 64 };
static const char magic[HEAD] = "perigal state " PG_VERSION;

/* A block of n bytes that grows when written; `at` is the position of reading. */
typedef struct { unsigned char *byte; size_t n, cap, at; } block;

static pg_status put (block *b, size_t bytes, const void *data)
{
    pg_status status = PG_OK;
    PG_GROW (b->byte, b->cap, b->n + bytes);
    if (bytes) memcpy (b->byte + b->n, data, bytes);
    b->n += bytes;
done:
    return status;
}

static pg_status get (block *b, size_t bytes, void *data)
{
    if (bytes > b->n - b->at) return pg_error (PG_E_FILE, PG_HERE, "the state ends too early");
    if (bytes) memcpy (data, b->byte + b->at, bytes);
    b->at += bytes;
    return PG_OK;
}

/* ---- pieces -------------------------------------------------------------------------------------------- */
typedef struct { block *to; int reading; } memory;

/* One piece: name, length in bytes, data; what is read must have the same name and length. */
static pg_status piece (void *context, const char *name, size_t bytes, void *value)
{
    pg_status status = PG_OK;
    memory *m = context;
    char found[128] = "";
    uint64_t length[2] = { strlen (name), bytes }, got[2];
    if (!m->reading) {
        PG_TRY (put (m->to, sizeof length, length));
        PG_TRY (put (m->to, length[0], name));
        PG_TRY (put (m->to, bytes, value));
        goto done;
    }
    PG_TRY (get (m->to, sizeof got, got));
    if (got[0] != length[0] || got[0] >= sizeof found || got[1] != length[1])
        PG_FAIL (PG_E_FILE, "the state has no '%s' of %zu bytes", name, bytes);
    PG_TRY (get (m->to, got[0], found));
    if (strcmp (found, name) != 0) PG_FAIL (PG_E_FILE, "the state has '%s' for '%s'", found, name);
    PG_TRY (get (m->to, bytes, value));
done:
    return status;
}

static pg_status keep_numbers (void *m, const char *name, size_t n, double *value)
{
    return piece (m, name, n * sizeof *value, value);
}
static pg_status keep_counts (void *m, const char *name, size_t n, long *value)
{
    return piece (m, name, n * sizeof *value, value);
}
static pg_status keep_bytes (void *m, const char *name, size_t n, void *value)
{
    return piece (m, name, n, value);
}

/* ---- head ---------------------------------------------------------------------------------------------- */
typedef struct { char magic[HEAD], scene[HASH]; uint64_t points, begun; } head;

/* Makes the head by which a state is recognized: version, scene with overrides, positions and volumes of the
 * points. */
static head head_of (const pg_session *s)
{
    head h = { .begun = (uint64_t) s->begun };
    const pg_cloud *c = &s->problem->cloud;
    memcpy (h.magic, magic, HEAD);
    memcpy (h.scene, pg_scene_hash (s->scene), HASH);
    h.points = pg_fingerprint (PG_FINGERPRINT, c->x, c->n * (size_t) c->dim * sizeof *c->x);
    h.points = pg_fingerprint (h.points, c->volume, c->n * sizeof *c->volume);
    return h;
}

static pg_status check_head (const pg_session *s, const head *h)
{
    pg_status status = PG_OK;
    const head mine = head_of (s);
    if (memcmp (h->magic, mine.magic, HEAD) != 0)
        PG_FAIL (PG_E_USAGE, "this is no state of perigal " PG_VERSION);
    if (memcmp (h->scene, mine.scene, HASH) != 0)
        PG_FAIL (PG_E_USAGE, "the state is of another scene, or of other values set in it");
    if (h->points != mine.points) PG_FAIL (PG_E_USAGE, "the state is of other points");
done:
    return status;
}

/* ---- save, restore ------------------------------------------------------------------------------------- */
/* Keeps the state of a session before its first step: the solver has nothing to keep yet, only what was
 * set. */
static pg_status keep_start (pg_state *state, const pg_keeper *k)
{
    pg_status status = PG_OK;
    PG_TRY (k->numbers (k->context, "d", state->ndof, state->d));
    PG_TRY (k->numbers (k->context, "v", state->ndof, state->v));
    PG_TRY (k->bytes (k->context, "alive", state->nbond, state->alive));
done:
    return status;
}

static pg_status keep_all (int begun, pg_solver *solver, pg_state *state, memory *m)
{
    const pg_keeper keeper = { .context = m, .reading = m->reading, .numbers = keep_numbers,
                               .counts = keep_counts, .bytes = keep_bytes };
    return begun ? pg_solver_keep (solver, state, &keeper) : keep_start (state, &keeper);
}

pg_status pg_session_save (pg_session *s, size_t *bytes, void **out)
{
    pg_status status = PG_OK;
    block b = { 0 };
    memory m = { &b, 0 };
    const head h = head_of (s);
    *bytes = 0, *out = NULL;
    PG_TRY (put (&b, sizeof h, &h));
    PG_TRY (keep_all (s->begun, s->solver, s->state, &m));
    const uint64_t sum = pg_fingerprint (PG_FINGERPRINT, b.byte, b.n);
    PG_TRY (put (&b, sizeof sum, &sum));
    *bytes = b.n, *out = b.byte;
    b.byte = NULL;
done:
    pg_free (b.byte);
    return status;
}

/* Reads into a new solver and state, which replace those of the session when all has been read. */
pg_status pg_session_restore (pg_session *s, size_t bytes, const void *in)
{
    pg_status status = PG_OK;
    pg_solver *solver = NULL;
    pg_state *state = NULL;
    head h;
    uint64_t sum;
    block b = { .at = sizeof h };
    memory m = { &b, 1 };
    if (bytes < sizeof h + sizeof sum) PG_FAIL (PG_E_FILE, "the state ends too early");
    memcpy (&h, in, sizeof h);
    PG_TRY (check_head (s, &h));
    memcpy (&sum, (const unsigned char *) in + bytes - sizeof sum, sizeof sum);
    if (sum != pg_fingerprint (PG_FINGERPRINT, in, bytes - sizeof sum))
        PG_FAIL (PG_E_FILE, "the state is damaged: its sum is another");
    PG_TRY (put (&b, bytes - sizeof sum, in));
    PG_TRY (session_begin (s, &solver, &state));
    PG_TRY (keep_all (h.begun != 0, solver, state, &m));
    pg_solver_free (&s->solver), pg_state_free (&s->state);
    s->solver = solver, s->state = state, s->begun = h.begun != 0;
    solver = NULL, state = NULL;
    memset (&s->step, 0, sizeof s->step);
done:
    pg_free (b.byte);
    pg_state_free (&state);
    pg_solver_free (&solver);
    return status;
}

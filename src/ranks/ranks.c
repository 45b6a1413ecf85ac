/* SPDX-License-Identifier: GPL-3.0-or-later
 * The ranks that share a run: who they are, and calls that do nothing where a process is alone. */
#include "perigal/ranks.h"
#include <string.h>

/* The ranks to which this process belongs, and the same while they divide a body among them; NULL: none. They
 * are global, as they are a property of the process. */
static const pg_ranks *joined, *sharing;
/* Wall time spent in messages, waiting included, s. */
static double spent;

/* Counts the time since t0 as spent in messages; returns the status unchanged. */
static pg_status took (double t0, pg_status status)
{
    spent += pg_seconds () - t0;
    return status;
}

void pg_ranks_join (const pg_ranks *ranks) { joined = sharing = ranks; }
void pg_ranks_divide (int divided) { sharing = divided ? joined : NULL; }
const pg_ranks *pg_ranks_now (void) { return sharing; }
int pg_rank (void) { return joined ? joined->rank : 0; }
int pg_rank_count (void) { return joined ? joined->size : 1; }
double pg_ranks_seconds (void) { return spent; }

pg_status pg_ranks_sum (size_t n, double *value)
{
    double t0 = pg_seconds ();
    return sharing && n ? took (t0, sharing->sum (sharing->context, n, value)) : PG_OK;
}

pg_status pg_ranks_most (size_t n, double *value)
{
    double t0 = pg_seconds ();
    return sharing && n ? took (t0, sharing->most (sharing->context, n, value)) : PG_OK;
}

pg_status pg_ranks_ask (size_t n, double *value)
{
    double t0 = pg_seconds ();
    return joined && n ? took (t0, joined->most (joined->context, n, value)) : PG_OK;
}

/* ---- a single process ---------------------------------------------------------------------------------- */
static pg_status leave (void *context, size_t n, double *value)
{
    (void) context, (void) n, (void) value;
    return PG_OK;
}

static pg_status leave_ghosts (void *context, const pg_halo *halo, size_t components, double *value)
{
    (void) context, (void) halo, (void) components, (void) value;
    return PG_OK;
}

static pg_status copy_own (void *context, size_t bytes, const void *mine, size_t *bytes_all, void **all)
{
    pg_status status = PG_OK;
    char *copy = NULL;
    (void) context;
    PG_ALLOC (copy, bytes);
    if (bytes) memcpy (copy, mine, bytes);
    *all = copy, *bytes_all = bytes;
done:
    return status;
}

static pg_status copy_numbers (void *context, size_t n, const double *mine, size_t *n_all, double **all)
{
    void *copy = NULL;
    size_t bytes = 0;
    pg_status status = copy_own (context, n * sizeof *mine, mine, &bytes, &copy);
    *all = copy, *n_all = n;
    return status;
}

void pg_ranks_stand_in (pg_ranks *out, int size)
{
    *out = (pg_ranks) { .size = size, .sum = leave, .most = leave, .exchange = leave_ghosts,
                        .collect = copy_own, .share = copy_numbers, .whole = 1 };
}

pg_status pg_ranks_collect (size_t bytes, const void *mine, size_t *bytes_all, void **all)
{
    *bytes_all = 0, *all = NULL;
    if (!sharing) return copy_own (NULL, bytes, mine, bytes_all, all);
    double t0 = pg_seconds ();
    return took (t0, sharing->collect (sharing->context, bytes, mine, bytes_all, all));
}

pg_status pg_ranks_share (size_t n, const double *mine, size_t *n_all, double **all)
{
    *n_all = 0, *all = NULL;
    if (!sharing) return copy_numbers (NULL, n, mine, n_all, all);
    double t0 = pg_seconds ();
    return took (t0, sharing->share (sharing->context, n, mine, n_all, all));
}

/* All ranks get the error message of the lowest rank that failed: its bytes are sent by a sum over the ranks
 * to which the other ranks add zeros. */
enum { WORDS = 512 };
pg_status pg_ranks_agree (pg_status mine)
{
    pg_status status = PG_OK;
    double first = mine == PG_OK ? -1e9 : -(double) pg_rank (), text[WORDS + 1] = { 0 };
    if (!joined) return mine;
    PG_TRY (pg_ranks_ask (1, &first));                /* minus the lowest rank that failed */
    if (first < -1e8) return PG_OK;
    if ((int) -first == pg_rank ()) {
        const char *said = pg_last_error ();
        text[WORDS] = mine;
        for (size_t k = 0; k + 1 < WORDS && said[k]; k++) text[k] = (unsigned char) said[k];
    }
    PG_TRY (joined->sum (joined->context, WORDS + 1, text));
    if ((int) -first == pg_rank ()) return mine;
    char words[WORDS + 1] = "";
    for (size_t k = 0; k < WORDS; k++) words[k] = (char) (unsigned char) text[k];
    return pg_error ((pg_status) text[WORDS], PG_HERE, "%s", words);
done:
    return status;
}

/* ---- subdomains ---------------------------------------------------------------------------------------- */
void pg_halo_clear (pg_halo *h)
{
    pg_free (h->rank), pg_free (h->send_first), pg_free (h->receive_first), pg_free (h->send),
        pg_free (h->receive);
    memset (h, 0, sizeof *h);
}

void pg_subdomain_free (pg_subdomain **subdomain)
{
    pg_subdomain *s = *subdomain;
    if (!s) return;
    pg_free (s->owned), pg_free (s->number);
    pg_halo_clear (&s->halo);
    pg_free (s);
    *subdomain = NULL;
}

pg_status pg_subdomain_exchange (const pg_subdomain *s, size_t components, double *value)
{
    double t0 = pg_seconds ();
    if (!s || !sharing) return PG_OK;
    return took (t0, sharing->exchange (sharing->context, &s->halo, components, value));
}

void pg_subdomain_clear_ghosts (const pg_subdomain *s, size_t components, double *value)
{
    for (size_t i = 0; s && i < s->n; i++)
        for (size_t k = 0; !s->owned[i] && k < components; k++) value[i * components + k] = 0;
}

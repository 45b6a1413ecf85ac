/* SPDX-License-Identifier: GPL-3.0-or-later
 * The messages of ranks by MPI. Sums are formed on rank 0 in the order of the ranks and sent to all, so that
 * they have the same bits everywhere and in every run; MPI_Allreduce leaves the order to the library. */
#include "messages.h"
#include <limits.h>
#include <mpi.h>
#include <string.h>

/* The functions and buffers of the messages. `here` is the only reference to them. */
typedef struct {
    pg_ranks ranks;
    double  *send, *receive;  size_t cap_send, cap_receive;
    MPI_Request *request;     size_t cap_request;
} messages;
static messages *here;

/* Turns an error code of MPI into a status with its message. */
static pg_status said (int code)
{
    char text[MPI_MAX_ERROR_STRING] = "";
    int length = 0;
    if (code == MPI_SUCCESS) return PG_OK;
    MPI_Error_string (code, text, &length);
    return pg_error (PG_E_FILE, PG_HERE, "ranks lost each other: %s", text);
}

static pg_status check_count (size_t n)
{
    return n <= INT_MAX ? PG_OK : pg_error (PG_E_LIMIT, PG_HERE, "a message of %zu numbers is too long", n);
}

/* Numbers that one gather brings to rank 0 from all ranks together: at most about 8 MiB. */
enum { AT_ONCE = 1 << 20 };

static pg_status sum (void *context, size_t n, double *value)
{
    pg_status status = PG_OK;
    messages *m = context;
    size_t size = (size_t) m->ranks.size, most = AT_ONCE / size + 1, room = n < most ? n : most;
    if (m->ranks.rank == 0) PG_GROW (m->receive, m->cap_receive, room * size);
    for (size_t at = 0, part; at < n; at += part, value += part) {
        part = n - at < most ? n - at : most;
        PG_TRY (said (MPI_Gather (value, (int) part, MPI_DOUBLE, m->receive, (int) part, MPI_DOUBLE, 0,
                                  MPI_COMM_WORLD)));
        for (size_t r = 1; m->ranks.rank == 0 && r < size; r++)
            for (size_t i = 0; i < part; i++) value[i] += m->receive[r * part + i];
        PG_TRY (said (MPI_Bcast (value, (int) part, MPI_DOUBLE, 0, MPI_COMM_WORLD)));
    }
done:
    return status;
}

/* Largest value over the ranks, which does not depend on their order; NAN is left to MPI_MAX. */
static pg_status most (void *context, size_t n, double *value)
{
    pg_status status = PG_OK;
    (void) context;
    PG_TRY (check_count (n));
    PG_TRY (said (MPI_Allreduce (MPI_IN_PLACE, value, (int) n, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD)));
done:
    return status;
}

/* Copies the values of the points in a list, one after the other, into `out`. */
static void pack (double *out, const int *point, size_t n, size_t components, const double *value)
{
    for (size_t i = 0; i < n; i++)
        memcpy (out + i * components, value + (size_t) point[i] * components, components * sizeof *out);
}

static void unpack (double *value, const int *point, size_t n, size_t components, const double *in)
{
    for (size_t i = 0; i < n; i++)
        memcpy (value + (size_t) point[i] * components, in + i * components, components * sizeof *in);
}

static pg_status exchange (void *context, const pg_halo *h, size_t components, double *value)
{
    pg_status status = PG_OK;
    messages *m = context;
    int pending = 0;
    size_t nsend = h->send_first[h->n], nreceive = h->receive_first[h->n];
    PG_TRY (check_count ((nsend + nreceive) * components));
    PG_GROW (m->send, m->cap_send, nsend * components);
    PG_GROW (m->receive, m->cap_receive, nreceive * components);
    PG_GROW (m->request, m->cap_request, 2 * h->n);
    for (size_t k = 0; k < h->n; k++) {
        size_t first = h->receive_first[k], n = h->receive_first[k + 1] - first;
        if (n)
            PG_TRY (said (MPI_Irecv (m->receive + first * components, (int) (n * components), MPI_DOUBLE,
                                     h->rank[k], 1, MPI_COMM_WORLD, &m->request[pending++])));
    }
    pack (m->send, h->send, nsend, components, value);
    for (size_t k = 0; k < h->n; k++) {
        size_t first = h->send_first[k], n = h->send_first[k + 1] - first;
        if (n)
            PG_TRY (said (MPI_Isend (m->send + first * components, (int) (n * components), MPI_DOUBLE,
                                     h->rank[k], 1, MPI_COMM_WORLD, &m->request[pending++])));
    }
    PG_TRY (said (MPI_Waitall (pending, m->request, MPI_STATUSES_IGNORE)));
    unpack (value, h->receive, nreceive, components, m->receive);
done:
    return status;
}

static pg_status collect (void *context, size_t bytes, const void *mine, size_t *bytes_all, void **all)
{
    pg_status status = PG_OK;
    messages *m = context;
    int *count = NULL, *first = NULL, own = (int) bytes;
    char *out = NULL;
    size_t total = 0, size = (size_t) m->ranks.size;
    PG_TRY (check_count (bytes));
    PG_ALLOC (count, size);
    PG_ALLOC (first, size);
    PG_TRY (said (MPI_Gather (&own, 1, MPI_INT, count, 1, MPI_INT, 0, MPI_COMM_WORLD)));
    for (size_t r = 0; m->ranks.rank == 0 && r < size; r++)
        first[r] = (int) total, total += (size_t) count[r];
    PG_TRY (check_count (total));
    PG_ALLOC (out, total);
    PG_TRY (said (MPI_Gatherv (mine, own, MPI_BYTE, out, count, first, MPI_BYTE, 0, MPI_COMM_WORLD)));
    *bytes_all = total;
    if (m->ranks.rank == 0) *all = out, out = NULL;
done:
    pg_free (count), pg_free (first), pg_free (out);
    return status;
}

static pg_status share (void *context, size_t n, const double *mine, size_t *n_all, double **all)
{
    pg_status status = PG_OK;
    messages *m = context;
    int *count = NULL, *first = NULL, own = (int) n;
    size_t total = 0, size = (size_t) m->ranks.size;
    *all = NULL;
    PG_TRY (check_count (n));
    PG_ALLOC (count, size);
    PG_ALLOC (first, size);
    PG_TRY (said (MPI_Allgather (&own, 1, MPI_INT, count, 1, MPI_INT, MPI_COMM_WORLD)));
    for (size_t r = 0; r < size; r++) first[r] = (int) total, total += (size_t) count[r];
    PG_TRY (check_count (total));
    PG_ALLOC (*all, total);
    PG_TRY (said (MPI_Allgatherv (mine, own, MPI_DOUBLE, *all, count, first, MPI_DOUBLE, MPI_COMM_WORLD)));
    *n_all = total;
done:
    pg_free (count), pg_free (first);
    return status;
}

void mpi_join (void)
{
    messages *m = pg_calloc (1, sizeof *m);
    if (!m) MPI_Abort (MPI_COMM_WORLD, 70);
    here = m;
    MPI_Comm_set_errhandler (MPI_COMM_WORLD, MPI_ERRORS_RETURN);
    MPI_Comm_rank (MPI_COMM_WORLD, &m->ranks.rank);
    MPI_Comm_size (MPI_COMM_WORLD, &m->ranks.size);
    m->ranks.context = m, m->ranks.sum = sum, m->ranks.most = most, m->ranks.exchange = exchange,
    m->ranks.collect = collect, m->ranks.share = share;
    pg_ranks_join (&m->ranks);
}

void mpi_leave (void)
{
    pg_ranks_join (NULL);
    pg_free (here->send), pg_free (here->receive), pg_free (here->request);
    pg_free (here), here = NULL;
}

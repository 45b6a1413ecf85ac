/* SPDX-License-Identifier: GPL-3.0-or-later
 * What travels between the processes of mpirun by src/app/mpi/messages.c: sums, also of more numbers
 * than travel
 * at a time, maxima, ghosts, lists of ranks of which one has nothing. Run by test_messages.sh; ends with the
 * line of the first check that fails on any rank. */
#include "app/mpi/messages.h"
#include <mpi.h>
#include <stdio.h>
#include <string.h>

#define SEE(what) do { \
        if (what) break; \
        fprintf (stderr, "rank %d: line %d: not so: %s\n", pg_rank (), __LINE__, #what); \
        return __LINE__; \
    } while (0)

static int sums (void)
{
    size_t size = (size_t) pg_rank_count (), n = (1u << 20) + 7;
    double few[3] = { 1 + pg_rank (), -pg_rank (), pg_rank () == 1 ? 0.1 : 1e17 }, *many = pg_calloc (n,
        sizeof *many);
    SEE (many != NULL);
    SEE (pg_ranks_sum (3, few) == PG_OK);
    SEE (few[0] == (double) (size * (size + 1) / 2) && few[1] == -(double) (size * (size - 1) / 2));
    double in_order = 1e17;                            /* rank by rank, to the last bit */
    for (size_t r = 1; r < size; r++) in_order += r == 1 ? 0.1 : 1e17;
    SEE (few[2] == in_order);
    for (size_t i = 0; i < n; i++) many[i] = (double) i + pg_rank ();
    SEE (pg_ranks_sum (n, many) == PG_OK);
    for (size_t i = 0; i < n; i++) SEE (many[i] == (double) (size * i + size * (size - 1) / 2));
    pg_free (many);
    few[0] = -5 - pg_rank (), few[1] = pg_rank ();
    SEE (pg_ranks_most (2, few) == PG_OK && few[0] == -5 && few[1] == (double) size - 1);
    return 0;
}

/* Each rank owns the points 1 .. 3 of six and sends the first of them down, the last two up, round a ring of
 * three or more; its ghosts are 0 from above, 4 and 5 from below. */
static int ghosts (void)
{
    int rank = pg_rank (), size = pg_rank_count (), up = (rank + 1) % size, down = (rank + size - 1) % size;
    /* neighbours ascending */
    int both[2] = { up < down ? up : down, up < down ? down : up }, upward = up < down ? 0 : 1;
    int send[3], receive[3];
    size_t send_first[3] = { 0, upward == 0 ? 2 : 1, 3 }, receive_first[3] = { 0, upward == 0 ? 1 : 2, 3 };
    double v[6][2];
    pg_halo halo = { .n = 2, .rank = both, .send_first = send_first, .receive_first = receive_first,
                     .send = send,
                     .receive = receive };
    int *to_up = send + send_first[upward], *to_down = send + send_first[!upward];
    to_up[0] = 3, to_up[1] = 2, to_down[0] = 1;
    receive[receive_first[upward]] = 0;
    receive[receive_first[!upward]] = 5, receive[receive_first[!upward] + 1] = 4;
    for (int i = 0; i < 6; i++) v[i][0] = 10 * rank + i, v[i][1] = -v[i][0];
    const pg_ranks *r = pg_ranks_now ();
    SEE (r->exchange (r->context, &halo, 2, v[0]) == PG_OK);
    for (int i = 1; i < 4; i++) SEE (v[i][0] == 10 * rank + i && v[i][1] == -v[i][0]);
    SEE (v[0][0] == 10 * up + 1 && v[5][0] == 10 * down + 3 && v[4][0] == 10 * down + 2);
    for (int i = 0; i < 6; i++) SEE (v[i][1] == -v[i][0]);
    /* one component, and one way only */
    double w[6] = { 0 };
    for (int i = 1; i < 4; i++) w[i] = 100 * rank + i;
    halo.send_first[1] = upward == 0 ? 2 : 0, halo.send_first[2] = 2;
    halo.receive_first[1] = upward == 0 ? 0 : 2, halo.receive_first[2] = 2;
    send[0] = 3, send[1] = 2, receive[0] = 5, receive[1] = 4;
    SEE (r->exchange (r->context, &halo, 1, w) == PG_OK);
    SEE (w[0] == 0 && w[5] == 100 * down + 3 && w[4] == 100 * down + 2);
    return 0;
}

/* rank r has r numbers, the first of them none */
static int lists (void)
{
    int rank = pg_rank (), size = pg_rank_count ();
    double mine[16], *all = NULL;
    char text[16];
    void *joined = NULL;
    size_t n = 0, bytes = 0, want = (size_t) (size * (size - 1) / 2);
    for (int k = 0; k < rank; k++) mine[k] = 10 * rank + k, text[k] = (char) ('a' + rank);
    SEE (pg_ranks_share ((size_t) rank, mine, &n, &all) == PG_OK && n == want);
    for (int r = 0, at = 0; r < size; r++)
        for (int k = 0; k < r; k++) SEE (all[at++] == 10 * r + k);
    SEE (pg_ranks_collect ((size_t) rank, text, &bytes, &joined) == PG_OK);
    if (rank) SEE (joined == NULL && bytes == 0);
    else SEE (bytes == want);
    for (int r = 0, at = 0; rank == 0 && r < size; r++)
        for (int k = 0; k < r; k++) SEE (((char *) joined)[at++] == 'a' + r);
    pg_free (all), pg_free (joined);
    return 0;
}

/* ranks fail one after the other: the words of the lowest travel */
static int failures (void)
{
    pg_status own = pg_rank () ? pg_error (PG_E_LIMIT, PG_HERE, "rank %d", pg_rank ()) : PG_OK;
    SEE (pg_ranks_agree (own) == PG_E_LIMIT && strcmp (pg_last_error (), "rank 1") == 0);
    return 0;
}

int main (int argc, char **argv)
{
    if (MPI_Init (&argc, &argv) != MPI_SUCCESS) return 1;
    mpi_join ();
    int line = sums (), worst = 0;
    if (!line) line = ghosts ();
    if (!line) line = lists ();
    if (!line) line = failures ();
    if (line) MPI_Abort (MPI_COMM_WORLD, 1);           /* the others may wait */
    MPI_Reduce (&line, &worst, 1, MPI_INT, MPI_MAX, 0, MPI_COMM_WORLD);
    mpi_leave ();
    MPI_Finalize ();
    return worst != 0;
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * Sparse matrices and vectors as Matrix Market files (Boisvert, Pozo, Remington: The Matrix Market exchange
 * formats, NISTIR 5935, 1996), which MATLAB (mmread), SciPy and most solvers read. 17 digits give the same
 * double back. */
#include "perigal/output.h"
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

/* Writes the comment, with a % before each of its lines. */
static void put_comment (FILE *to, const char *comment)
{
    while (comment && *comment) {
        int length = (int) strcspn (comment, "\n");
        fprintf (to, "%% %.*s\n", length, comment);
        comment += length + (comment[length] == '\n');
    }
}

/* Closes the file; one that could not be written whole is removed. A device (/dev/full, /dev/null) is not
 * ours to remove. */
static pg_status finish (FILE *to, const char *path)
{
    struct stat s;
    int wrong = ferror (to), why = errno, ours = fstat (fileno (to), &s) == 0 && S_ISREG (s.st_mode);
    if (fclose (to) != 0 && !wrong) wrong = 1, why = errno;
    if (!wrong) return PG_OK;
    if (ours) remove (path);
    return pg_error (PG_E_FILE, PG_HERE, "%s: %s", path, strerror (why));
}

/* A symmetric matrix is stored by its upper triangle; the format asks for the lower one. */
pg_status pg_matrix_market_write (const pg_sparse *A, const char *path, const char *comment)
{
    FILE *to;
    pg_status status = pg_file_create (&to, path);
    if (status != PG_OK) return status;
    fprintf (to, "%%%%MatrixMarket matrix coordinate real %s\n", A->symmetric ? "symmetric" : "general");
    put_comment (to, comment);
    fprintf (to, "%zu %zu %ld\n", A->nrow, A->ncol, A->start[A->ncol]);
    for (size_t j = 0; j < A->ncol && !ferror (to); j++)
        for (long p = A->start[j]; p < A->start[j + 1]; p++) {
            long i = A->row[p] + 1, k = (long) j + 1;
            fprintf (to, "%ld %ld %.17g\n", A->symmetric ? k : i, A->symmetric ? i : k, A->value[p]);
        }
    return finish (to, path);
}

pg_status pg_matrix_market_vector (size_t n, const double *value, const char *path, const char *comment)
{
    FILE *to;
    pg_status status = pg_file_create (&to, path);
    if (status != PG_OK) return status;
    fprintf (to, "%%%%MatrixMarket matrix array real general\n");
    put_comment (to, comment);
    fprintf (to, "%zu 1\n", n);
    for (size_t i = 0; i < n && !ferror (to); i++) fprintf (to, "%.17g\n", value[i]);
    return finish (to, path);
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * What the sums of FCBM would cost if their transforms went over all ranks (FFTW-MPI, slabs), for
 * doc/scale.md: perigal transforms the points of each rank with their ghosts instead, and sends nothing else.
 *
 *     mpirun -n RANKS slabs PLACES STEPS
 *
 * Three components on a box of PLACES^3, padding included: forward, times a number, back. Printed are ms a
 * sum, of the slowest rank, least and median of STEPS. */
#include <fftw3-mpi.h>
#include <stdio.h>
#include <stdlib.h>

static int ascending (const void *a, const void *b)
{
    double x = *(const double *) a, y = *(const double *) b;
    return (x > y) - (x < y);
}

/* ms of one sum, of the slowest rank */
static double once (fftw_plan *forward, fftw_plan *back, fftw_complex **spectrum, ptrdiff_t n)
{
    MPI_Barrier (MPI_COMM_WORLD);
    double took = MPI_Wtime ();
    for (int k = 0; k < 3; k++) fftw_execute (forward[k]);
    for (ptrdiff_t i = 0; i < n; i++)
        for (int k = 0; k < 3; k++) spectrum[k][i][0] *= 1e-9, spectrum[k][i][1] *= 1e-9;
    for (int k = 0; k < 3; k++) fftw_execute (back[k]);
    took = 1e3 * (MPI_Wtime () - took);
    MPI_Allreduce (MPI_IN_PLACE, &took, 1, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
    return took;
}

int main (int argc, char **argv)
{
    MPI_Init (&argc, &argv);
    fftw_mpi_init ();
    int rank, steps = argc > 2 ? atoi (argv[2]) : 0;
    ptrdiff_t places = argc > 2 ? atol (argv[1]) : 0, rows, first, turned_rows, turned_first;
    MPI_Comm_rank (MPI_COMM_WORLD, &rank);
    if (places < 2 || steps < 1) {
        fprintf (stderr, "usage: mpirun -n RANKS slabs PLACES STEPS\n");
        MPI_Abort (MPI_COMM_WORLD, 64);
    }
    ptrdiff_t n = fftw_mpi_local_size_3d_transposed (places, places, places / 2 + 1, MPI_COMM_WORLD, &rows,
                                                     &first, &turned_rows, &turned_first);
    fftw_plan forward[3], back[3];
    fftw_complex *spectrum[3];
    double *took = calloc ((size_t) steps, sizeof *took);
    for (int k = 0; k < 3; k++) {
        spectrum[k] = fftw_alloc_complex ((size_t) n);
        double *x = (double *) spectrum[k];
        forward[k] = fftw_mpi_plan_dft_r2c_3d (places, places, places, x, spectrum[k], MPI_COMM_WORLD,
                                               FFTW_MEASURE | FFTW_MPI_TRANSPOSED_OUT);
        back[k] = fftw_mpi_plan_dft_c2r_3d (places, places, places, spectrum[k], x, MPI_COMM_WORLD,
                                            FFTW_MEASURE | FFTW_MPI_TRANSPOSED_IN);
        for (ptrdiff_t i = 0; i < 2 * n; i++) x[i] = (double) (i % 17);
    }
    for (int s = 0; took && s < steps; s++) took[s] = once (forward, back, spectrum, n);
    if (took) qsort (took, (size_t) steps, sizeof *took, ascending);
    if (took && rank == 0)
        printf ("places,least_ms,median_ms\n%td,%.6g,%.6g\n", places, took[0], took[steps / 2]);
    for (int k = 0; k < 3; k++) {
        fftw_destroy_plan (forward[k]), fftw_destroy_plan (back[k]);
        fftw_free (spectrum[k]);
    }
    free (took);
    fftw_mpi_cleanup ();
    MPI_Finalize ();
    return 0;
}

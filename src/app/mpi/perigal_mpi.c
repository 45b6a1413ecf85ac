/* SPDX-License-Identifier: GPL-3.0-or-later
 * perigal-mpi: `mpirun -n N perigal-mpi run SCENE.yaml` runs a scene on several processes, with the same
 * options, messages, exit codes and files as `perigal run`; `check` says what it would do. */
#include "../cli/preparation/cli.h"
#include "messages.h"
#include "petsc_factor.h"
#include "petsc_library.h"
#include <mpi.h>
#include <stdlib.h>
#include <string.h>

static void usage (FILE *to)
{
    fprintf (to, "Perigal " PG_VERSION ": a scene on several processes by MPI\n\nusage:\n"
                 "  mpirun -n N perigal-mpi run SCENE.yaml [-o DIR] [--set KEY=VALUE] [--resume]\n"
                 "  perigal-mpi check SCENE.yaml --ranks N  what N processes would do; starts none of them\n"
                 "  perigal help run, perigal help check  explain the options\n\n"
                 "exit codes: 0 done, 64 wrong usage, 65 invalid scene, 70 failed (numerics, memory,\n"
                 "            files, messages), 130 interrupted\n");
}

/* Ends this rank. A rank that failed alone cannot inform the others, which wait for it, so that all are
 * aborted; if all ranks have ended they finish in order. */
static int end (int code, int together)
{
    if (code != PG_EXIT_DONE && !together) MPI_Abort (MPI_COMM_WORLD, code);
    petsc_take_back ();
    petsc_end ();
    mpi_leave ();
    MPI_Finalize ();
    return code;
}

int main (int argc, char **argv)
{
    if (argc > 1 && strcmp (argv[1], "--version") == 0) {
        printf ("perigal-mpi " PG_VERSION "\n");
        return command_written ("perigal-mpi", PG_EXIT_DONE);
    }
    if (argc < 2 || strcmp (argv[1], "--help") == 0 || strcmp (argv[1], "-h") == 0) {
        usage (argc < 2 ? stderr : stdout);
        return command_written ("perigal-mpi", argc < 2 ? PG_EXIT_USAGE : PG_EXIT_DONE);
    }
    if (strcmp (argv[1], "check") == 0) {
        petsc_give ();
        return command_written ("perigal-mpi", pg_cli_check (argc - 1, argv + 1));
    }
    if (strcmp (argv[1], "run") != 0) {
        fprintf (stderr, "perigal-mpi: there is no command %s for several processes: run, check\n", argv[1]);
        return PG_EXIT_USAGE;
    }
    setenv ("OMP_THREAD_LIMIT", "1", 0);
    setenv ("OPENBLAS_NUM_THREADS", "1", 0);
    pg_signals before;
    pg_signals_hold (&before);                         /* blocked in the threads of MPI */
    int joined = MPI_Init (&argc, &argv) == MPI_SUCCESS;
    pg_signals_release (&before);
    if (!joined) {
        fprintf (stderr, "perigal-mpi: MPI does not start\n");
        return PG_EXIT_FAILED;
    }
    mpi_join ();
    pg_memory_keep ();
    petsc_give ();
    int together = 0, code = pg_cli_run_ranks (argc - 1, argv + 1, &together);
    return end (code, together);
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * Loads BLAS, CHOLMOD and UMFPACK when they are needed and fills the tables of their functions. Runs that
 * factor no matrix never load them. How many threads these libraries may start is set before, as they read it
 * from their environment when they are loaded. */
#include "suitesparse.h"
#include <stddef.h>
#include <stdlib.h>

struct pg_blas_calls pg_blas;
struct pg_cholmod_calls pg_cholmod;
struct pg_umfpack_calls pg_umfpack;

/* Loads BLAS so that CHOLMOD and UMFPACK use this one too (RTLD_GLOBAL), not another one of the system. */
pg_status pg_blas_load (void)
{
    static const pg_library_function function[] = {
#define X(name) { #name, offsetof (struct pg_blas_calls, name) },
        PG_BLAS_CALLS (X)
#undef X
    };
    static pg_library blas = { PG_BLAS_FILE, "libopenblas0-pthread", "dense systems",
                               sizeof function / sizeof *function, function, &pg_blas, 1, 0 };
    return pg_library_load (&blas);
}

pg_status pg_cholmod_load (void)
{
    static const pg_library_function function[] = {
#define X(name) { #name, offsetof (struct pg_cholmod_calls, name) },
        PG_CHOLMOD_CALLS (X)
#undef X
    };
    static pg_library cholmod = { PG_CHOLMOD_FILE, "libcholmod3", "factorizations",
                                  sizeof function / sizeof *function, function, &pg_cholmod, 0, 0 };
    pg_status status = PG_OK;
    PG_TRY (pg_blas_load ());
    PG_TRY (pg_library_load (&cholmod));
#if SUITESPARSE_MAIN_VERSION < 7
    /* Factors, the largest arrays of a run, get large pages, unless other functions have been set. */
    struct SuiteSparse_config_struct *memory = pg_cholmod.SuiteSparse_config;
    if (memory->malloc_func == malloc) memory->malloc_func = pg_memory_malloc;
    if (memory->calloc_func == calloc) memory->calloc_func = pg_memory_calloc;
    if (memory->realloc_func == realloc) memory->realloc_func = pg_memory_realloc;
#endif
done:
    return status;
}

pg_status pg_umfpack_load (void)
{
    static const pg_library_function function[] = {
#define X(name) { #name, offsetof (struct pg_umfpack_calls, name) },
        PG_UMFPACK_CALLS (X)
#undef X
    };
    static pg_library umfpack = { PG_UMFPACK_FILE, "libumfpack5", "factorizations of general matrices",
                                  sizeof function / sizeof *function, function, &pg_umfpack, 0, 0 };
    pg_status status = pg_blas_load ();
    return status == PG_OK ? pg_library_load (&umfpack) : status;
}

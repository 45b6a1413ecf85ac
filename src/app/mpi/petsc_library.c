/* SPDX-License-Identifier: GPL-3.0-or-later
 * Loads PETSc when it is needed and fills the table of its functions. Ranks that divide the body mostly do
 * not need it, and the libraries that it loads thus read their environment after main has set it. */
#include "petsc_library.h"
#include <stddef.h>

struct petsc_calls petsc;
static int started;

pg_status petsc_said (PetscErrorCode code, const char *what)
{
    const char *text = NULL;
    if (code == 0) return PG_OK;
    PetscErrorMessage (code, &text, NULL);
    return pg_error (code == PETSC_ERR_MEM ? PG_E_MEMORY : PG_E_SINGULAR, PG_HERE,
                     "PETSC: %s failed: %s", what, text ? text : "no reason is given");
}

pg_status petsc_load (void)
{
    static const pg_library_function function[] = {
#define X(name) { #name, offsetof (struct petsc_calls, name) },
        PG_PETSC_CALLS (X)
#undef X
    };
    static pg_library library = { PG_PETSC_FILE, "petsc-dev", "factors and coarse grids of several ranks",
                                  sizeof function / sizeof *function, function, &petsc, 0, 0 };
    pg_status status = PG_OK;
    if (started) return PG_OK;
    PG_TRY (pg_library_load (&library));
    PG_TRY (petsc_said (PetscInitialize (NULL, NULL, NULL, NULL), "its start"));
    started = 1;
    /* failures are returned as codes and not printed */
    PG_TRY (petsc_said (PetscPushErrorHandler (petsc.PetscReturnErrorHandler, NULL), "its start"));
done:
    return status;
}

void petsc_end (void)
{
    if (started) PetscFinalize ();
    started = 0;
}

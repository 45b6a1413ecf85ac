/* SPDX-License-Identifier: GPL-3.0-or-later
 * Libraries that are loaded when they are first needed, not when the program starts. A linked library is
 * loaded and relocated in every run, with all that it needs itself: for pictures and netCDF that is about
 * sixty libraries, more than a small run takes for everything else. It also reads its environment at that
 * moment, before main could have set anything.
 *
 * The functions of such a library are pointers in a table. Its users reach them under their own names: a
 * private header (io/picture/cairo_calls.h, linalg/suitesparse.h, io/mesh_files/netcdf_calls.h) defines
 * each name
 * as the entry of the table. The name of the file is the SONAME that the Makefile reads from the library
 * whose header the program was compiled with, so that another version of it is never taken. */
#include "perigal/base.h"
#include <dlfcn.h>
#include <pthread.h>
#include <string.h>

/* Held by the thread that loads a library. */
static pthread_mutex_t loading = PTHREAD_MUTEX_INITIALIZER;

/* Looks up all functions and writes them into the table. A pointer to a function is copied by its bytes:
 * POSIX says that it fits into what dlsym returns, but C has no conversion between the two. */
static pg_status fill_table (const pg_library *library, void *handle)
{
    pg_status status = PG_OK;
    for (size_t k = 0; k < library->n; k++) {
        void *address = dlsym (handle, library->function[k].name);
        if (!address)
            PG_FAIL (PG_E_FILE, "%s need the library %s with the function %s, which it lacks; the Debian "
                                "package is %s", library->purpose, library->file, library->function[k].name,
                     library->package);
        memcpy ((char *) library->table + library->function[k].at, &address, sizeof address);
    }
done:
    return status;
}

/* `ready` is read without the lock by those who find the library loaded; the release after the table is
 * filled, and the acquire here, make its entries visible to them. A library stays until the process ends:
 * some leave threads and handlers behind that must not lose their code. Lazy: what a library calls in others
 * is looked up when it is called first; OpenBLAS has ten thousand such places, of which a run meets a few
 * dozen. */
pg_status pg_library_load (pg_library *library)
{
    pg_status status = PG_OK;
    if (__atomic_load_n (&library->ready, __ATOMIC_ACQUIRE)) return PG_OK;
    pthread_mutex_lock (&loading);
    if (library->ready) goto done;
    pg_signals before;
    pg_signals_hold (&before);                         /* threads that the library starts block signals */
    void *handle = dlopen (library->file, RTLD_LAZY | (library->shared ? RTLD_GLOBAL : RTLD_LOCAL));
    pg_signals_release (&before);
    if (!handle) {
        const char *reason = dlerror ();
        PG_FAIL (PG_E_FILE, "%s need the library %s, which cannot be loaded (%s): install the Debian package "
                            "%s", library->purpose, library->file, reason ? reason : "no reason given",
                 library->package);
    }
    PG_TRY (fill_table (library, handle));
    __atomic_store_n (&library->ready, 1, __ATOMIC_RELEASE);
done:
    pthread_mutex_unlock (&loading);
    return status;
}

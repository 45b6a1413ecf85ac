/* SPDX-License-Identifier: GPL-3.0-or-later
 * perigal check --matrix DIR: the linear system of a scene at load factor 1 as Matrix Market files, which
 * MATLAB, Octave, Python, Julia and others read, for criteria and solvers of one's own. */
#include "app/cli/preparation/cli.h"
#include <errno.h>
#include <string.h>

/* Joins folder and name to a path; PG_E_LIMIT: it is too long. */
static pg_status join (char path[4096], const char *folder, const char *name)
{
    pg_status status = PG_OK;
    if (snprintf (path, 4096, "%s/%s", folder, name) >= 4096)
        PG_FAIL (PG_E_LIMIT, "%.60s...: the name of the folder is too long", folder);
done:
    return status;
}

/* Writes a table of the points, to which the rows of N belong: coordinates and volume. */
static pg_status write_points (const pg_cloud *cloud, const char *path)
{
    pg_status status = PG_OK;
    FILE *f = NULL;
    PG_TRY (pg_file_create (&f, path));
    for (int c = 0; c < cloud->dim; c++) fprintf (f, "%c [m],", "xyz"[c]);
    fprintf (f, "volume [m3]\n");
    for (size_t i = 0; i < cloud->n; i++) {
        const double *x = cloud->x + i * (size_t) cloud->dim;
        for (int c = 0; c < cloud->dim; c++) fprintf (f, "%.17g,", x[c]);
        fprintf (f, "%.17g\n", cloud->volume[i]);
    }
    int bad = ferror (f);
    bad |= fclose (f) != 0;
    if (bad) PG_FAIL (PG_E_FILE, "%s cannot be written: %s", path, strerror (errno ? errno : EIO));
done:
    return status;
}

pg_status matrix_write (const pg_problem *p, const pg_solver_options *o, const char *folder)
{
    pg_status status = PG_OK;
    pg_equations e = { 0 };
    char path[4096];
    if (!folder) return PG_OK;
    if (o->contact.kind != PG_CONTACT_NONE)
        PG_FAIL (PG_E_USAGE, "--matrix: a scene with contact has no linear system, as contact decides which "
                             "faces bear; leave it out: --set 'contact={kind: none}'");
    PG_TRY (pg_equations_create (&e, p, NULL, 1));
    PG_TRY (pg_folder_make (folder));
    PG_TRY (join (path, folder, "K.mtx"));
    PG_TRY (pg_matrix_market_write (&e.K, path, "stiffness, N/m: K d = f at load factor 1, pre-cracks cut"));
    PG_TRY (join (path, folder, "T.mtx"));
    PG_TRY (pg_matrix_market_write (&e.T, path, "supports: d = T q + g, (T' K T) q = T' (f - K g)"));
    PG_TRY (join (path, folder, "N.mtx"));
    PG_TRY (pg_matrix_market_write (&e.N, path, "displacement of the points, m, point by point: N d"));
    PG_TRY (join (path, folder, "f.mtx"));
    PG_TRY (pg_matrix_market_vector (e.n, e.f, path, "loads, N"));
    PG_TRY (join (path, folder, "g.mtx"));
    PG_TRY (pg_matrix_market_vector (e.n, e.g, path, "what supports prescribe, m: d = T q + g"));
    PG_TRY (join (path, folder, "points.csv"));
    PG_TRY (write_points (&p->cloud, path));
done:
    pg_equations_clear (&e);
    return status;
}

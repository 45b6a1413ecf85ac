/* SPDX-License-Identifier: GPL-3.0-or-later
 * grown.h: a run of a scene with all that it leaves, and which faces of cracks its result.e says exist. */
#ifndef PERIGAL_TEST_GROWN_H
#define PERIGAL_TEST_GROWN_H
#include "folder.h"
#include <netcdf.h>

/* Runs the scene into the folder; returns the last line of the summary that begins with `begins`. */
static inline void leave (const char *text, const char *folder, const char *begins, char line[400])
{
    run r = prepare (1, text);
    pg_result *result = NULL;
    char row[400];
    check_ok (pg_result_open (&result, folder, r.scene, r.problem, r.solver));
    while (!pg_solver_done (r.solver, r.state)) {
        check_ok (pg_solver_step (r.solver, r.state, &r.step));
        check_ok (pg_result_step (result, r.state, &r.step));
    }
    check_ok (pg_result_finish (result, r.state, NULL, 0, 0));
    for (size_t k = 0; begins && pg_result_words (result, k, row, sizeof row); k++)
        if (strncmp (row, begins, strlen (begins)) == 0) strcpy (line, row);
    pg_result_free (&result);
    clear (&r);
}

/* Faces of cracks in an open result.e (*faces), and how many of them exist at stored step k. */
static inline double faces_at (int ncid, size_t k, size_t *faces)
{
    int dim, var;
    double sum = 0, exists;
    assert_int_equal (nc_inq_dimid (ncid, "num_el_in_blk2", &dim), NC_NOERR);
    assert_int_equal (nc_inq_dimlen (ncid, dim, faces), NC_NOERR);
    assert_int_equal (nc_inq_varid (ncid, "vals_elem_var1eb2", &var), NC_NOERR);
    for (size_t n = 0; n < *faces; n++) {
        assert_int_equal (nc_get_var1_double (ncid, var, (size_t[2]) { k, n }, &exists), NC_NOERR);
        sum += exists;
    }
    return sum;
}
#endif

/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: the open result folder. */
#ifndef PG_RESULT_PRIVATE_H
#define PG_RESULT_PRIVATE_H
#include "perigal/report.h"

enum { MOST_FIELDS = 16, MOST_PICTURES = 32 };
struct pg_result {
    char     folder[3072];
    const pg_problem *problem;
    pg_solver *solver;
    char     hash[80], scene[3072];
    pg_exodus *file;
    pg_table  *history, *events;
    size_t    nfield, npicture, nwritten, ncolumn;
    pg_field_view field[MOST_FIELDS];
    double   *value[MOST_FIELDS];
    char      picture[MOST_PICTURES][64], written[MOST_PICTURES][4096];
    double    magnify, broken_share;
    long      every, next_broken;
    double   *row, *u;
    long      exodus_steps;
    int       last_written;                            /* the state of the last step is in result.e                      */
    /* load-displacement curve */
    size_t    npoint, cap_x, cap_y;
    double   *curve_x, *curve_y;
    int       curve_load, curve_component;
    double    seconds;
    double    stamp;                                   /* of the last step                                               */
};
pg_status result_history_create (pg_result *r);
pg_status result_history_row    (pg_result *r, const pg_state *state, const pg_step *step);
const char *result_voigt        (int dim, int k);       /* "xx", "yy", ... of component k                                 */
pg_status result_pictures       (pg_result *r, const pg_state *state);
pg_status result_json           (pg_result *r, const pg_state *state, const char *failure, double search, double total);
#endif

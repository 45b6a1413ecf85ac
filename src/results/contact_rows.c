/* SPDX-License-Identifier: GPL-3.0-or-later
 * contact.csv: what the faces of cracks, and surfaces opposite platens, bear, piece by piece, one row for
 * each at every row of history.csv. Runs without contact.kind and platens have none, nor have those in
 * explicit steps by short range, whose contacts are of points. */
#include "results_private.h"

static const char *const columns[] = { "step [1]",     "time [s]",      "load_factor [1]", "path [1]",
                                       "arc [m]",      "x [m]",         "y [m]",           "length [m]",
                                       "pressure [Pa]", "shear [Pa]",   "gap [m]",         "slip [m]",
                                       "status_code [1]", "platen_code [1]" };
enum { COLUMNS = sizeof columns / sizeof *columns };

pg_status pg_result_contact_create (pg_result *r, const result_marks *from)
{
    pg_status status = PG_OK;
    char path[4096];
    if (!from) PG_TRY (pg_result_remove (r, "contact.csv"));       /* of an earlier run */
    const pg_contact_setting *setting = &pg_solver_settled (r->solver)->contact;
    int explicit_ = (pg_solver_settled (r->solver)->flags & PG_SOLVER_EXPLICIT) != 0,
        faces = setting->kind != PG_CONTACT_NONE && setting->search == PG_CONTACT_FACES;
    if (!faces && (explicit_ || !r->problem->nplaten)) return PG_OK;
    snprintf (path, sizeof path, "%s/contact.csv", r->folder);
    PG_TRY (from ? pg_table_open (&r->contact, path, COLUMNS, columns, from->contact)
                 : pg_table_create (&r->contact, path, COLUMNS, columns));
done:
    return status;
}

pg_status pg_result_contact_write (pg_result *r, const pg_step *step)
{
    pg_status status = PG_OK;
    size_t n;
    const pg_contact_values *v = pg_solver_contact (r->solver, &n);
    for (size_t k = 0; r->contact && k < n; k++) {
        const double row[COLUMNS] = { (double) step->number, step->time,  step->factor,
                                      (double) v[k].path + 1,
                                      v[k].arc,              v[k].x[0],   v[k].x[1],    v[k].length,
                                      v[k].pressure,         v[k].shear[0],  v[k].gap,     v[k].slip[0],
                                      (double) v[k].status, (double) v[k].platen };
        PG_TRY (pg_table_row (r->contact, row));
    }
done:
    return status;
}

void pg_result_contact_close (pg_result *r) { pg_table_close (&r->contact); }

/* SPDX-License-Identifier: GPL-3.0-or-later
 * contact.csv: pressure, shear, gap and slip of crack faces in contact and of surfaces opposite platens,
 * piece by piece, one row for each at every row of history.csv. Runs without contact.kind and platens have no
 * such table, nor have explicit runs with short-range contact, which acts between points. */
#include "results_private.h"

static const char *const columns[] = { "step [1]",     "time [s]",      "load_factor [1]", "path [1]",
                                       "arc [m]",      "x [m]",         "y [m]",           "length [m]",
                                       "pressure [Pa]", "shear [Pa]",   "gap [m]",         "slip [m]",
                                       "status_code [1]", "platen_code [1]" };
/* Columns in 3D, where shear and slip are vectors, and pieces have an area and a normal. */
static const char *const columns_space[] = {
    "step [1]",     "time [s]",     "load_factor [1]", "surface [1]",  "x [m]",         "y [m]",
    "z [m]",        "normal.x [1]", "normal.y [1]",    "normal.z [1]", "area [m2]",     "pressure [Pa]",
    "shear.x [Pa]", "shear.y [Pa]", "shear.z [Pa]",    "gap [m]",      "slip.x [m]",    "slip.y [m]",
    "slip.z [m]",   "status_code [1]", "platen_code [1]" };
enum { COLUMNS = sizeof columns / sizeof *columns,
       COLUMNS_SPACE = sizeof columns_space / sizeof *columns_space };

pg_status pg_result_contact_create (pg_result *r, const result_marks *from)
{
    pg_status status = PG_OK;
    char path[4096];
    if (!from) PG_TRY (pg_result_remove (r, "contact.csv"));       /* one of an earlier run */
    const pg_contact_setting *setting = &pg_solver_settled (r->solver)->contact;
    int explicit_ = (pg_solver_settled (r->solver)->flags & PG_SOLVER_EXPLICIT) != 0,
        faces = setting->kind != PG_CONTACT_NONE && setting->search == PG_CONTACT_FACES;
    if (!faces && (explicit_ || !r->problem->boundary.nplaten)) return PG_OK;
    snprintf (path, sizeof path, "%s/contact.csv", r->folder);
    int space = r->problem->dim == 3;
    size_t count = space ? COLUMNS_SPACE : COLUMNS;
    const char *const *names = space ? columns_space : columns;
    PG_TRY (from ? pg_table_open (&r->table.contact, path, count, names, from->contact)
                 : pg_table_create (&r->table.contact, path, count, names));
done:
    return status;
}

static pg_status write_space (pg_result *r, const pg_step *step, const pg_contact_values *v)
{
    const double row[COLUMNS_SPACE] = {
        (double) step->number, step->time,   step->factor, (double) v->path + 1, v->x[0],     v->x[1],
        v->x[2],               v->normal[0], v->normal[1], v->normal[2],         v->area,     v->pressure,
        v->shear[0],           v->shear[1],  v->shear[2],  v->gap,               v->slip[0],  v->slip[1],
        v->slip[2],            (double) v->status, (double) v->platen };
    return pg_table_row (r->table.contact, row);
}

pg_status pg_result_contact_write (pg_result *r, const pg_step *step)
{
    pg_status status = PG_OK;
    size_t n;
    const pg_contact_values *v = pg_solver_contact (r->solver, &n);
    int space = r->problem->dim == 3;
    for (size_t k = 0; r->table.contact && k < n; k++) {
        if (space) {
            PG_TRY (write_space (r, step, &v[k]));
            continue;
        }
        const double row[COLUMNS] = { (double) step->number, step->time,  step->factor,
                                      (double) v[k].path + 1,
                                      v[k].arc,              v[k].x[0],   v[k].x[1],    v[k].length,
                                      v[k].pressure,         v[k].shear[0],  v[k].gap,     v[k].slip[0],
                                      (double) v[k].status, (double) v[k].platen };
        PG_TRY (pg_table_row (r->table.contact, row));
    }
done:
    return status;
}

void pg_result_contact_close (pg_result *r) { pg_table_close (&r->table.contact); }

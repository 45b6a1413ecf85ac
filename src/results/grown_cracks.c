/* SPDX-License-Identifier: GPL-3.0-or-later
 * Cracks in the plane that grow by facets, and what their tips bear:
 *
 *   history.csv   crack.length, and of every tip of the scene tip.N.J, .K_I, .K_II, .x, .y
 *   cracks.csv    every straight piece: step 0 the cracks of the scene, then what each step has added
 *   tips.csv      every tip at every step, also those that came into being later
 *   report.json   crack_length; fracture: what the growth took, and what it should have taken
 *
 * Runs whose cracks do not grow have the columns of tips and tips.csv if output.stress_intensity asks for
 * them; then the values are measured here, else the solver has them from its search for the next facet.
 * Cracks in space: grown_surfaces.c. */
#include "results_private.h"
#include "perigal/fracture.h"
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

/* Columns of history.csv for a tip. */
enum { PER_TIP = 5 };
static const char *const tip_columns[PER_TIP] = { "J [J/m^2]", "K_I [Pa m^(1/2)]", "K_II [Pa m^(1/2)]",
                                                  "x [m]", "y [m]" };
static const char *const piece_columns[] = { "step [1]", "stamp [1]", "crack [1]", "segment [1]", "x0 [m]",
                                             "y0 [m]",   "x1 [m]",    "y1 [m]",    "tip [1]" };
static const char *const all_tip_columns[] = {
    "step [1]",  "time [s]",          "load_factor [1]",   "tip [1]", "open [1]",        "x [m]",
    "y [m]",     "grown [m]",         "J [J/m^2]",         "K_I [Pa m^(1/2)]", "K_II [Pa m^(1/2)]",
    "T [Pa]",    "J_uncertainty [1]", "utilisation [1]"
};
enum { PIECE_COLUMNS = sizeof piece_columns / sizeof *piece_columns,
       ALL_TIP_COLUMNS = sizeof all_tip_columns / sizeof *all_tip_columns };

/* Refuses what cannot be measured: no cracks in the plane, a force without integrals. */
void pg_result_paths_check (const pg_scene *scene, const pg_problem *p)
{
    static const char *const key = "output.stress_intensity";
    if (!pg_scene_bool (scene, key)) return;
    const pg_force_type *force = pg_force_of (p);
    const char *why = force ? pg_tip_refuses (p, force) : NULL;
    if (p->dim == 1) pg_scene_fault (scene, key, "the tips of cracks are measured in 2D and 3D only");
    else if (p->ntip == 0 && p->nfront == 0 && !pg_problem_grows (p))
        pg_scene_fault (scene, key, "there is no crack with a %s", p->dim == 2 ? "tip" : "front");
    else if (why) pg_scene_fault (scene, key, "%s", why);
}

void pg_result_paths_read (pg_result *r, const pg_scene *scene)
{
    r->tips.grows = pg_problem_grows (r->problem);
    r->tips.measuring = pg_scene_bool (scene, "output.stress_intensity");
}

/* Are there columns of tips? */
static int has_tips (const pg_result *r) { return r->tips.grows || r->tips.measuring; }

/* ---- history.csv --------------------------------------------------------------------------------------- */
size_t pg_result_paths_columns (const pg_result *r)
{
    if (r->problem->dim == 3) return pg_result_surfaces_columns (r);
    return (size_t) r->tips.grows + (has_tips (r) ? PER_TIP * r->problem->ntip : 0);
}

void pg_result_paths_column (const pg_result *r, size_t i, char *out, size_t size)
{
    if (r->problem->dim == 3) pg_result_surfaces_column (r, i, out, size);
    else if (r->tips.grows && i == 0) snprintf (out, size, "crack.length [m]");
    else {
        i -= (size_t) r->tips.grows;
        snprintf (out, size, "tip.%ld.%s", r->problem->tip[i / PER_TIP].id, tip_columns[i % PER_TIP]);
    }
}

/* What is known of a tip in this state: nothing where there is no room for a ring, or of one that has
 * ended. */
static pg_status values_of (pg_result *r, const pg_state *state, size_t tip, pg_tip_values *out)
{
    pg_status status = PG_OK;
    const pg_tip *t = &state->paths->tip[tip];
    const double *d = state->d, time = r->dynamic ? state->time : state->factor, one = 1;
    pg_tip_field field;
    void *self;
    const pg_force_type *force = pg_solver_force (r->solver, &self);
    const pg_tip_values *known = pg_solver_tip (r->solver, t->id);
    *out = (pg_tip_values) { .J = NAN, .K = { NAN, NAN, NAN }, .T = NAN, .uncertainty = NAN,
                             .utilisation = NAN };
    if (known && t->open) *out = *known;
    out->id = t->id, out->x[0] = t->x[0], out->x[1] = t->x[1];
    if (known || !r->tips.measuring || !t->open) goto done;
    pg_tip_faces faces;
    int touch = pg_solver_tip_faces (r->solver, state, tip, &faces);
    PG_TRY (pg_tip_measure_faces (&field, r->problem, force, self, state, tip, 1, &d, &time,
                                  touch ? &faces : NULL, 0));
    if (isnan (field.near)) goto done;
    pg_tip_combine (&field, 1, &one, &out->J, NULL, &out->T);
    pg_tip_intensities (&field, 1, &one, out->K);
    out->uncertainty = pg_tip_uncertainty (&field, 1, &one);
done:
    return status;
}

/* Measures the tips once for both tables. */
static pg_status measure_tips (pg_result *r, const pg_state *state)
{
    pg_status status = PG_OK;
    PG_GROW (r->tips.value, r->tips.cap_value, state->paths->ntip);
    for (size_t t = 0; t < state->paths->ntip; t++) PG_TRY (values_of (r, state, t, &r->tips.value[t]));
done:
    return status;
}

/* The tips of the scene are the first of the state. */
pg_status pg_result_paths_row (pg_result *r, const pg_state *state, double *row)
{
    pg_status status = PG_OK;
    size_t n = 0;
    if (r->problem->dim == 3) return pg_result_surfaces_row (r, state, row);
    if (!has_tips (r) || !state->paths) return PG_OK;
    PG_TRY (measure_tips (r, state));
    if (r->tips.grows) row[n++] = state->paths->length;
    for (size_t t = 0; t < r->problem->ntip; t++) {
        const pg_tip_values *v = &r->tips.value[t];
        row[n++] = v->J, row[n++] = v->K[0], row[n++] = v->K[1], row[n++] = v->x[0], row[n++] = v->x[1];
    }
done:
    return status;
}

/* ---- cracks.csv, tips.csv ------------------------------------------------------------------------------ */
/* Creates the tables, or opens them and cuts them to the rows of `from`; the cracks of the scene are the
 * first rows. */
pg_status pg_result_paths_create (pg_result *r, const result_marks *from)
{
    result_tips *t = &r->tips;
    pg_status status = PG_OK;
    char path[4096];
    const pg_cracks *cracks = pg_state_cracks (r->problem, NULL);
    if (!from) {                                       /* of an earlier run */
        PG_TRY (pg_result_remove (r, "tips.csv"));
        PG_TRY (pg_result_remove (r, "fronts.csv"));
        PG_TRY (pg_result_remove (r, "cracks.csv"));
    }
    if (r->problem->dim == 3) return pg_result_surfaces_create (r, from);
    snprintf (path, sizeof path, "%s/tips.csv", r->folder);
    if (has_tips (r))
        PG_TRY (from ? pg_table_open (&t->rows, path, ALL_TIP_COLUMNS, all_tip_columns, from->tips)
                     : pg_table_create (&t->rows, path, ALL_TIP_COLUMNS, all_tip_columns));
    snprintf (path, sizeof path, "%s/cracks.csv", r->folder);
    if (!t->grows) goto done;
    PG_TRY (from ? pg_table_open (&t->pieces, path, PIECE_COLUMNS, piece_columns, from->pieces)
                 : pg_table_create (&t->pieces, path, PIECE_COLUMNS, piece_columns));
    t->npiece = from ? from->npiece : (long) cracks->n;
    for (size_t k = 0; !from && k < cracks->n; k++) {
        const double *x = cracks->crack[k].vertex;
        PG_TRY (pg_table_row (t->pieces, (double[PIECE_COLUMNS]) { 0, 0, (double) k + 1, (double) k + 1, x[0],
                                                                   x[1], x[2], x[3], 0 }));
    }
done:
    return status;
}

/* Pieces that are new since the last row. That which a crack of the scene has split off when it began to grow
 * is known already. */
static pg_status write_pieces (pg_result *r, const pg_state *state, const pg_step *step)
{
    result_tips *t = &r->tips;
    pg_status status = PG_OK;
    const pg_crack_paths *w = state->paths;
    for (; t->npiece < (long) w->cracks.n; t->npiece++) {
        size_t k = (size_t) t->npiece;
        const double *x = w->cracks.crack[k].vertex;
        if (w->owner[k] == 0 && w->parent[k] != SIZE_MAX) continue;
        const double row[PIECE_COLUMNS] = { (double) step->number, step->stamp, (double) w->path[k] + 1,
                                            (double) k + 1, x[0], x[1], x[2], x[3], (double) w->owner[k] };
        PG_TRY (pg_table_row (t->pieces, row));
    }
done:
    return status;
}

/* After pg_result_paths_row, whose values it writes. */
pg_status pg_result_paths_write (pg_result *r, const pg_state *state, const pg_step *step)
{
    pg_status status = PG_OK;
    if (r->problem->dim == 3) return pg_result_surfaces_write (r, state, step);
    if (!has_tips (r) || !state->paths) return PG_OK;
    if (r->tips.grows) PG_TRY (write_pieces (r, state, step));
    for (size_t i = 0; i < state->paths->ntip; i++) {
        const pg_tip *t = &state->paths->tip[i];
        const pg_tip_values *v = &r->tips.value[i];
        const double row[ALL_TIP_COLUMNS] = { (double) step->number, step->time, step->factor, (double) t->id,
                                              t->open, t->x[0], t->x[1], t->grown, v->J, v->K[0], v->K[1],
                                              v->T, v->uncertainty, v->utilisation };
        PG_TRY (pg_table_row (r->tips.rows, row));
    }
done:
    return status;
}

/* ---- the report ---------------------------------------------------------------------------------------- */
/* What cracks that grew have taken over what the fracture energy along them asks for; NAN: not known. */
double pg_result_paths_ratio (const pg_result *r)
{
    const pg_statistics *s = pg_solver_report_now (r->solver);
    return s->energy_fracture > 0 ? s->energy_dissipated / s->energy_fracture : NAN;
}

void pg_result_paths_json (pg_json *j, const pg_result *r, const pg_state *state)
{
    const pg_crack_paths *w = state->paths;
    if (r->problem->dim == 3) pg_result_surfaces_json (j, r, state);
    if (!r->tips.grows || !w) return;
    pg_json_number (j, "crack_length", w->length);
    pg_json_open (j, "fracture", '{');
    pg_json_number (j, "area", w->length * r->problem->cloud.thickness);
    pg_json_number (j, "energy", pg_solver_report_now (r->solver)->energy_fracture);
    pg_json_number (j, "dissipated_over_G0_length", pg_result_paths_ratio (r));
    pg_json_count (j, "segments", w->cracks.n);
    pg_json_open (j, "tips", '[');
    for (size_t i = 0; i < w->ntip; i++) {
        pg_json_open (j, NULL, '{');
        pg_json_count (j, "tip", (size_t) w->tip[i].id);
        pg_json_number (j, "x", w->tip[i].x[0]);
        pg_json_number (j, "y", w->tip[i].x[1]);
        pg_json_number (j, "grown", w->tip[i].grown);
        pg_json_text (j, "state", w->tip[i].open ? "open" : "closed");
        pg_json_shut (j);
    }
    pg_json_shut (j);
    pg_json_shut (j);
}

void pg_result_paths_close (pg_result *r)
{
    result_tips *t = &r->tips;
    pg_table_close (&t->pieces);
    pg_table_close (&t->rows);
    pg_free (t->value), pg_free (t->front_value), pg_quadrature_clear (&t->facet_points);
}

/* ---- reading back -------------------------------------------------------------------------------------- */
/* One row as a crack; it is sided unless it is of the scene. */
static pg_status read_piece (pg_cracks *out, const double *row)
{
    pg_status status = PG_OK;
    pg_crack *c = &out->crack[out->n];
    *c = (pg_crack) { .kind = PG_CRACK_SEGMENT, .nvertex = 2, .sided = row[0] > 0 };
    PG_ALLOC (c->vertex, 4);
    out->n++;
    memcpy (c->vertex, row + 4, 4 * sizeof *c->vertex);
    pg_crack_orient (c);
done:
    return status;
}

/* Times in result.e may be a rounding later than the step (write_fields in result.c). */
pg_status pg_result_cracks (pg_cracks *out, const char *folder, double time)
{
    pg_status status = PG_OK;
    pg_csv csv = { 0 };
    char path[4096];
    *out = (pg_cracks) { .dim = 2 };
    int space;
    snprintf (path, sizeof path, "%s/cracks.csv", folder);
    if (access (path, R_OK) != 0) return PG_OK;
    PG_TRY (pg_csv_read (&csv, path));
    space = csv.ncolumn == (size_t) pg_result_triangle_columns ();
    if (csv.ncolumn != PIECE_COLUMNS && !space)
        PG_FAIL (PG_E_FILE, "%s has %zu columns, not %d", path, csv.ncolumn, PIECE_COLUMNS);
    out->dim = space ? 3 : 2;
    PG_ALLOC (out->crack, csv.nrow);
    for (size_t i = 0; i < csv.nrow; i++) {
        const double *row = csv.value + i * csv.ncolumn;
        for (size_t k = 0; k < csv.ncolumn; k++)
            if (!isfinite (row[k])) PG_FAIL (PG_E_FILE, "%s: row %zu is damaged", path, i + 1);
        if (row[1] > time * (1 + 1e-12)) continue;
        if (space) PG_TRY (pg_result_read_triangle (out, row));
        else if (hypot (row[6] - row[4], row[7] - row[5]) > 0) PG_TRY (read_piece (out, row));
    }
    PG_TRY (pg_cracks_index (out));
done:
    pg_csv_clear (&csv);
    if (status != PG_OK) pg_cracks_clear (out);
    return status;
}

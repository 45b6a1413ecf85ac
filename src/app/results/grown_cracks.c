/* SPDX-License-Identifier: GPL-3.0-or-later
 * Cracks that grow by facets, and what their tips, in space their fronts, bear:
 *
 *   history.csv   crack.length, and of every tip of the scene tip.N.J, .K_I, .K_II, .x, .y; in space
 *                 crack.area, and of every front of the scene front.N.J_max
 *   cracks.csv    every straight piece, or triangle: step 0 the cracks of the scene (in space as fans), then
 *                 what each step has added
 *   tips.csv      every tip at every step, also those that came into being later
 *   fronts.csv    every vertex of every open front at every step
 *   report.json   crack_length, crack_area; fracture: what the growth took, and what it should have taken
 *
 * Runs whose cracks do not grow have the columns of tips or fronts and their table if output.stress_intensity
 * asks for them; then the values are measured here, else the solver has them from its search for the next
 * facet. */
#include "results_private.h"
#include "perigal/fracture.h"
#include "perigal/vector.h"
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
static const char *const triangle_columns[] = {
    "step [1]", "stamp [1]", "front [1]", "segment [1]", "x0 [m]", "y0 [m]", "z0 [m]",
    "x1 [m]",   "y1 [m]",    "z1 [m]",    "x2 [m]",      "y2 [m]", "z2 [m]"
};
static const char *const front_columns[] = { "step [1]", "front [1]", "vertex [1]", "x [m]", "y [m]", "z [m]",
                                             "J [J/m^2]", "K_I [Pa m^(1/2)]", "K_II [Pa m^(1/2)]",
                                             "K_III [Pa m^(1/2)]" };
enum { PIECE_COLUMNS = sizeof piece_columns / sizeof *piece_columns,
       ALL_TIP_COLUMNS = sizeof all_tip_columns / sizeof *all_tip_columns,
       TRIANGLE_COLUMNS = sizeof triangle_columns / sizeof *triangle_columns,
       FRONT_COLUMNS = sizeof front_columns / sizeof *front_columns };

/* Checks output.stress_intensity: J and K cannot be measured in 1D, without cracks, or for forces without
 * integrals. */
void pg_result_paths_check (const pg_scene *scene, const pg_problem *p)
{
    static const char *const key = "output.stress_intensity";
    if (!pg_scene_bool (scene, key)) return;
    const pg_force_type *force = pg_force_of (p);
    const char *why = force ? pg_tip_refuses (p, force) : NULL;
    if (p->dim == 1) pg_scene_fault (scene, key, "the tips of cracks are measured in 2D and 3D only");
    else if (p->crack.ntip == 0 && p->crack.nfront == 0 && !pg_problem_grows (p))
        pg_scene_fault (scene, key, "there is no crack with a %s", p->dim == 2 ? "tip" : "front");
    else if (why) pg_scene_fault (scene, key, "%s", why);
}

void pg_result_paths_read (pg_result *r, const pg_scene *scene)
{
    r->tips.grows = pg_problem_grows (r->problem);
    r->tips.measuring = pg_scene_bool (scene, "output.stress_intensity");
}

/* 1: there are columns for tips or fronts. */
static int has_tips (const pg_result *r) { return r->tips.grows || r->tips.measuring; }

static int in_space (const pg_result *r) { return r->problem->dim == 3; }

/* ---- history.csv --------------------------------------------------------------------------------------- */
size_t pg_result_paths_columns (const pg_result *r)
{
    const pg_problem *p = r->problem;
    return (size_t) r->tips.grows
           + (has_tips (r) ? in_space (r) ? p->crack.nfront : PER_TIP * p->crack.ntip : 0);
}

void pg_result_paths_column (const pg_result *r, size_t i, char *out, size_t size)
{
    size_t grows = (size_t) r->tips.grows;
    if (i < grows) snprintf (out, size, "%s", in_space (r) ? "crack.area [m^2]" : "crack.length [m]");
    else if (in_space (r))
        snprintf (out, size, "front.%ld.J_max [J/m^2]", r->problem->crack.front[i - grows].id);
    else {
        i -= grows;
        snprintf (out, size, "tip.%ld.%s", r->problem->crack.tip[i / PER_TIP].id, tip_columns[i % PER_TIP]);
    }
}

/* Finds J, K and more of a tip in this state; NAN if there is no room for a ring, or if the tip has ended. */
static pg_status values_of (pg_result *r, const pg_state *state, size_t tip, pg_tip_values *out)
{
    pg_status status = PG_OK;
    const pg_tip *t = &state->paths->tip[tip];
    const double *d = state->d, time = r->dynamic ? state->time : state->factor, one = 1;
    pg_tip_field field;
    void *self;
    const pg_force_type *force = pg_solver_force (r->solver, &self);
    const pg_tip_values *known = pg_solver_tip (r->solver, t->id);
    *out = known && t->open ? *known : pg_tip_values_of (t->id, 0, t->x, NULL, 0, NULL);
    memcpy (out->x, t->x, sizeof out->x);
    if (known || !r->tips.measuring || !t->open) goto done;
    pg_tip_faces faces;
    int touch = pg_solver_tip_faces (r->solver, state, tip, &faces);
    PG_TRY (pg_tip_measure (&field, r->problem, force, self, state, tip, 1, &d, &time,
                                  touch ? &faces : NULL, 0));
    *out = pg_tip_values_of (t->id, 0, t->x, &field, 1, &one);
done:
    return status;
}

/* Measures J and K at the vertices of an open front. */
static pg_status measure_front (pg_result *r, const pg_state *state, size_t front, const pg_front *f)
{
    result_tips *t = &r->tips;
    pg_status status = PG_OK;
    const double *d = state->d, time = r->dynamic ? state->time : state->factor, one = 1;
    pg_tip_field *field = NULL;
    pg_front_faces *faces = NULL;
    void *self;
    const pg_force_type *force = pg_solver_force (r->solver, &self);
    PG_ALLOC (field, f->n);
    PG_ALLOC (faces, f->n);
    int touch = pg_solver_front_faces (r->solver, state, front, faces);
    PG_TRY (pg_front_measure (field, r->problem, force, self, state, front, 1, &d, &time,
                                    touch ? faces : NULL));
    PG_GROW (t->value, t->cap_value, t->nvalue + f->n);
    for (size_t i = 0; i < f->n; i++)
        t->value[t->nvalue++] = pg_tip_values_of (f->id, i, f->x + 3*i, &field[i], 1, &one);
done:
    pg_free (field), pg_free (faces);
    return status;
}

/* Finds the values of all tips or vertices, once for both tables: those that the solver has measured in its
 * search for growth, else measured here. */
static pg_status measure (pg_result *r, const pg_state *state)
{
    result_tips *t = &r->tips;
    pg_status status = PG_OK;
    size_t n = 0, nfront;
    const pg_tip_values *known = pg_solver_tips (r->solver, &n);
    const pg_front *front = pg_fronts_of_state (r->problem, state, &nfront);
    t->nvalue = 0;
    if (!in_space (r)) {
        PG_GROW (t->value, t->cap_value, state->paths->ntip);
        for (; t->nvalue < state->paths->ntip; t->nvalue++)
            PG_TRY (values_of (r, state, t->nvalue, &t->value[t->nvalue]));
    } else if (n) {
        PG_GROW (t->value, t->cap_value, n);
        memcpy (t->value, known, n * sizeof *known);
        t->nvalue = n;
    } else
        for (size_t f = 0; t->measuring && f < nfront; f++)
            if (front[f].open) PG_TRY (measure_front (r, state, f, &front[f]));
done:
    return status;
}

/* Largest J of all fronts that have come from front `of` of the scene; NAN: they have ended. */
static double largest_J (const pg_result *r, const pg_state *state, long of)
{
    size_t nfront;
    const pg_front *front = pg_fronts_of_state (r->problem, state, &nfront);
    double J = NAN;
    for (size_t f = 0; f < nfront; f++)
        for (size_t i = 0; front[f].of == of && i < r->tips.nvalue; i++)
            if (r->tips.value[i].id == front[f].id)
                J = fmax (J, r->tips.value[i].J);      /* fmax ignores NAN */
    return J;
}

/* Length (m, 2D) or area (m2, 3D) grown since the start. */
static double grown (const pg_state *state)
{
    return state->paths ? state->paths->length : state->surfaces ? state->surfaces->area : 0;
}

/* Writes the columns of history.csv. The tips and fronts of the scene are the first of the state. */
pg_status pg_result_paths_row (pg_result *r, const pg_state *state, double *row)
{
    pg_status status = PG_OK;
    size_t n = 0;
    if (!has_tips (r) || (!in_space (r) && !state->paths)) return PG_OK;
    PG_TRY (measure (r, state));
    if (r->tips.grows) row[n++] = grown (state);
    for (size_t f = 0; in_space (r) && f < r->problem->crack.nfront; f++)
        row[n++] = largest_J (r, state, r->problem->crack.front[f].id);
    for (size_t t = 0; !in_space (r) && t < r->problem->crack.ntip; t++) {
        const pg_tip_values *v = &r->tips.value[t];
        row[n++] = v->J, row[n++] = v->K[0], row[n++] = v->K[1], row[n++] = v->x[0], row[n++] = v->x[1];
    }
done:
    return status;
}

/* ---- cracks.csv, tips.csv, fronts.csv ------------------------------------------------------------------ */
static pg_status open_table (const pg_result *r, const char *name, pg_table **out, size_t n,
                             const char *const *columns, const result_marks *from, long rows)
{
    char path[4096];
    snprintf (path, sizeof path, "%s/%s", r->folder, name);
    return from ? pg_table_open (out, path, n, columns, rows) : pg_table_create (out, path, n, columns);
}

/* Writes a row for a triangle of crack number k. */
static pg_status put_triangle (pg_result *r, const double when[2], long front, size_t k, const double *a,
                               const double *b, const double *c)
{
    double row[TRIANGLE_COLUMNS] = { when[0], when[1], (double) front, (double) k + 1 };
    memcpy (row + 4, a, 3 * sizeof *a), memcpy (row + 7, b, 3 * sizeof *b);
    memcpy (row + 10, c, 3 * sizeof *c);
    return pg_table_row (r->tips.pieces, row);
}

/* Writes rows for the cracks of the scene: pieces, in 3D fans of triangles about their centre. */
static pg_status put_first (pg_result *r, const pg_cracks *cracks)
{
    pg_status status = PG_OK;
    const double start[2] = { 0, 0 };
    for (size_t k = 0; k < cracks->n; k++) {
        const pg_crack *c = &cracks->crack[k];
        const double *x = c->vertex;
        if (!in_space (r)) {
            PG_TRY (pg_table_row (r->tips.pieces, (double[PIECE_COLUMNS]) { 0, 0, (double) k + 1,
                                                                            (double) k + 1, x[0], x[1], x[2],
                                                                            x[3], 0 }));
            continue;
        }
        double middle[3] = { 0 };
        for (size_t i = 0; i < 3 * c->nvertex; i++) middle[i % 3] += c->vertex[i] / (double) c->nvertex;
        for (size_t i = 0; i < c->nvertex; i++)
            PG_TRY (put_triangle (r, start, 0, k, middle, c->vertex + 3*i,
                                  c->vertex + 3 * ((i + 1) % c->nvertex)));
    }
done:
    return status;
}

/* Creates the tables, or opens them and cuts them to the rows of `from`; the cracks of the scene are the
 * first rows. */
pg_status pg_result_paths_create (pg_result *r, const result_marks *from)
{
    result_tips *t = &r->tips;
    pg_status status = PG_OK;
    int space = in_space (r);
    const pg_cracks *cracks = pg_state_cracks (r->problem, NULL);
    if (!from) {                                       /* remove tables of an earlier run */
        PG_TRY (pg_result_remove (r, "tips.csv"));
        PG_TRY (pg_result_remove (r, "fronts.csv"));
        PG_TRY (pg_result_remove (r, "cracks.csv"));
    }
    if (has_tips (r))
        PG_TRY (open_table (r, space ? "fronts.csv" : "tips.csv", &t->rows,
                            space ? FRONT_COLUMNS : ALL_TIP_COLUMNS, space ? front_columns : all_tip_columns,
                            from, from ? from->tips : 0));
    if (!t->grows) goto done;
    PG_TRY (open_table (r, "cracks.csv", &t->pieces, space ? TRIANGLE_COLUMNS : PIECE_COLUMNS,
                        space ? triangle_columns : piece_columns, from, from ? from->pieces : 0));
    t->npiece = from ? from->npiece : (long) cracks->n;
    if (!from) PG_TRY (put_first (r, cracks));
done:
    return status;
}

/* Writes the pieces that are new since the last row. A piece that a crack of the scene has split off when it
 * began to grow is in the table already. */
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

static pg_status write_triangles (pg_result *r, const pg_crack_surfaces *w, const pg_step *step)
{
    result_tips *t = &r->tips;
    pg_status status = PG_OK;
    const double when[2] = { (double) step->number, step->stamp };
    for (; w && t->npiece < (long) w->cracks.n; t->npiece++) {
        size_t k = (size_t) t->npiece;
        const double *x = w->cracks.crack[k].vertex;
        PG_TRY (put_triangle (r, when, w->owner[k - w->nfirst], k, x, x + 3, x + 6));
    }
done:
    return status;
}

/* Writes the rows of all tables; called after pg_result_paths_row, whose values it uses. */
pg_status pg_result_paths_write (pg_result *r, const pg_state *state, const pg_step *step)
{
    pg_status status = PG_OK;
    double number = (double) step->number;
    if (!has_tips (r) || (!in_space (r) && !state->paths)) return PG_OK;
    if (r->tips.grows)
        PG_TRY (in_space (r) ? write_triangles (r, state->surfaces, step) : write_pieces (r, state, step));
    for (size_t i = 0; i < r->tips.nvalue; i++) {
        const pg_tip_values *v = &r->tips.value[i];
        const double id = (double) v->id, *x = v->x, *K = v->K;
        if (in_space (r)) {
            PG_TRY (pg_table_row (r->tips.rows,
                                  (double[FRONT_COLUMNS]) { number, id, (double) v->vertex + 1, x[0], x[1],
                                                            x[2], v->J, K[0], K[1], K[2] }));
            continue;
        }
        const pg_tip *t = &state->paths->tip[i];
        PG_TRY (pg_table_row (r->tips.rows,
                              (double[ALL_TIP_COLUMNS]) { number, step->time, step->factor, id, t->open, x[0],
                                                          x[1], t->grown, v->J, K[0], K[1], v->T,
                                                          v->uncertainty, v->utilisation }));
    }
done:
    return status;
}

/* ---- the report ---------------------------------------------------------------------------------------- */
/* Energy that the growth of cracks has dissipated, over the fracture energy of the new faces; NAN: not
 * known. */
double pg_result_paths_ratio (const pg_result *r)
{
    const pg_statistics *s = pg_solver_report_now (r->solver);
    return s->energy.fracture > 0 ? s->energy.dissipated / s->energy.fracture : NAN;
}

static double front_length (const pg_front *f)
{
    double length = 0;
    for (size_t i = 0; i + !f->closed < f->n; i++) {
        const double *a = f->x + 3*i, *b = f->x + 3 * ((i + 1) % f->n);
        length += hypot (hypot (b[0] - a[0], b[1] - a[1]), b[2] - a[2]);
    }
    return length;
}

static void tips_json (pg_json *j, const pg_crack_paths *w)
{
    for (size_t i = 0; i < w->ntip; i++) {
        pg_json_open (j, NULL, '{');
        pg_json_count (j, "tip", (size_t) w->tip[i].id);
        pg_json_number (j, "x", w->tip[i].x[0]);
        pg_json_number (j, "y", w->tip[i].x[1]);
        pg_json_number (j, "grown", w->tip[i].grown);
        pg_json_text (j, "state", w->tip[i].open ? "open" : "closed");
        pg_json_shut (j);
    }
}

static void fronts_json (pg_json *j, const pg_crack_surfaces *w)
{
    for (size_t f = 0; f < w->nfront; f++) {
        const pg_front *front = &w->front[f];
        double most = 0;
        for (size_t i = 0; i < front->n; i++) most = fmax (most, front->grown[i]);
        pg_json_open (j, NULL, '{');
        pg_json_count (j, "front", (size_t) front->id);
        pg_json_count (j, "vertices", front->n);
        pg_json_number (j, "length", front_length (front));
        pg_json_number (j, "grown", most);
        pg_json_text (j, "state", front->open ? "open" : "closed");
        pg_json_shut (j);
    }
}

void pg_result_paths_json (pg_json *j, const pg_result *r, const pg_state *state)
{
    const pg_crack_paths *w = state->paths;
    const pg_crack_surfaces *s = state->surfaces;
    if (!r->tips.grows || !(w || s)) return;
    pg_json_number (j, w ? "crack_length" : "crack_area", grown (state));
    pg_json_open (j, "fracture", '{');
    pg_json_number (j, "area", w ? w->length * r->problem->cloud.thickness : s->area);
    pg_json_number (j, "energy", pg_solver_report_now (r->solver)->energy.fracture);
    pg_json_number (j, w ? "dissipated_over_G0_length" : "dissipated_over_G0_area",
                    pg_result_paths_ratio (r));
    if (w) pg_json_count (j, "segments", w->cracks.n);
    else pg_json_count (j, "triangles", s->cracks.n - s->nfirst);
    pg_json_open (j, w ? "tips" : "fronts", '[');
    if (w) tips_json (j, w);
    else fronts_json (j, s);
    pg_json_shut (j);
    pg_json_shut (j);
}

void pg_result_paths_close (pg_result *r)
{
    result_tips *t = &r->tips;
    pg_table_close (&t->pieces);
    pg_table_close (&t->rows);
    pg_free (t->value), pg_quadrature_clear (&t->facet_points);
}

/* ---- reading back -------------------------------------------------------------------------------------- */
/* Reads a row of cracks.csv as a crack in 2D; it is sided unless it is of the scene (step 0). */
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

/* Reads a row as a triangle in 3D, if it has an area. */
static pg_status read_triangle (pg_cracks *out, const double *row)
{
    pg_status status = PG_OK;
    const double *x = row + 4;
    double u[3], v[3];
    pg_crack *c = &out->crack[out->n];
    *c = (pg_crack) { .kind = PG_CRACK_POLYGON, .nvertex = 3, .sided = row[0] > 0 };
    for (int k = 0; k < 3; k++) u[k] = x[3 + k] - x[k], v[k] = x[6 + k] - x[k];
    pg_cross3 (u, v, c->normal);
    if (!pg_unit3 (c->normal)) return PG_OK;
    PG_ALLOC (c->vertex, 9);
    out->n++;
    memcpy (c->vertex, x, 9 * sizeof *x);
done:
    return status;
}

/* Reads the cracks that exist at a time of result.e, which may be a rounding later than the step
 * (write_fields in result.c). */
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
    space = csv.ncolumn == TRIANGLE_COLUMNS;
    if (csv.ncolumn != PIECE_COLUMNS && !space)
        PG_FAIL (PG_E_FILE, "%s has %zu columns, not %d", path, csv.ncolumn, PIECE_COLUMNS);
    out->dim = space ? 3 : 2;
    PG_ALLOC (out->crack, csv.nrow);
    for (size_t i = 0; i < csv.nrow; i++) {
        const double *row = csv.value + i * csv.ncolumn;
        for (size_t k = 0; k < csv.ncolumn; k++)
            if (!isfinite (row[k])) PG_FAIL (PG_E_FILE, "%s: row %zu is damaged", path, i + 1);
        if (row[1] > time * (1 + 1e-12)) continue;
        if (space) PG_TRY (read_triangle (out, row));
        else if (hypot (row[6] - row[4], row[7] - row[5]) > 0) PG_TRY (read_piece (out, row));
    }
    PG_TRY (pg_cracks_index (out));
done:
    pg_csv_clear (&csv);
    if (status != PG_OK) pg_cracks_clear (out);
    return status;
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * Cracks in space that grow by facets, and what their fronts bear; the counterpart of grown_cracks.c, which
 * calls this file where the body has three dimensions:
 *
 *   history.csv   crack.area, and of every front of the scene front.N.J_max
 *   cracks.csv    every triangle: step 0 the cracks of the scene as fans, then what each step has added
 *   fronts.csv    every vertex of every open front at every step
 *   report.json   crack_area; fracture: what the growth took, and what it should have taken
 *
 * Runs whose cracks do not grow have front.N.J_max and fronts.csv if output.stress_intensity asks for them.
 * */
#include "results_private.h"
#include "perigal/fracture.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static const char *const triangle_columns[] = {
    "step [1]", "stamp [1]", "front [1]", "segment [1]", "x0 [m]", "y0 [m]", "z0 [m]",
    "x1 [m]",   "y1 [m]",    "z1 [m]",    "x2 [m]",      "y2 [m]", "z2 [m]"
};
static const char *const front_columns[] = { "step [1]", "front [1]", "vertex [1]", "x [m]", "y [m]", "z [m]",
                                             "J [J/m^2]", "K_I [Pa m^(1/2)]", "K_II [Pa m^(1/2)]",
                                             "K_III [Pa m^(1/2)]" };
enum { TRIANGLE_COLUMNS = sizeof triangle_columns / sizeof *triangle_columns,
       FRONT_COLUMNS = sizeof front_columns / sizeof *front_columns };

static int has_fronts (const pg_result *r) { return r->tips.grows || r->tips.measuring; }

/* ---- history.csv --------------------------------------------------------------------------------------- */
size_t pg_result_surfaces_columns (const pg_result *r)
{
    return (size_t) r->tips.grows + (has_fronts (r) ? r->problem->nfront : 0);
}

void pg_result_surfaces_column (const pg_result *r, size_t i, char *out, size_t size)
{
    if (r->tips.grows && i == 0) snprintf (out, size, "crack.area [m^2]");
    else
        snprintf (out, size, "front.%ld.J_max [J/m^2]", r->problem->front[i - (size_t) r->tips.grows].id);
}

/* What the vertices of an open front bear, measured here. */
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
    PG_TRY (pg_front_measure_faces (field, r->problem, force, self, state, front, 1, &d, &time,
                                    touch ? faces : NULL));
    PG_GROW (t->front_value, t->cap_front_value, t->nfront_value + f->n);
    for (size_t i = 0; i < f->n; i++) {
        pg_front_values *v = &t->front_value[t->nfront_value++];
        *v = (pg_front_values) { .front = f->id, .vertex = i, .J = NAN, .K = { NAN, NAN, NAN }, .T = NAN,
                                 .utilisation = NAN };
        memcpy (v->x, f->x + 3*i, sizeof v->x);
        if (isnan (field[i].near)) continue;
        pg_tip_combine (&field[i], 1, &one, &v->J, NULL, &v->T);
        pg_tip_intensities (&field[i], 1, &one, v->K);
    }
done:
    pg_free (field), pg_free (faces);
    return status;
}

/* What the solver has measured in its search for growth, or else here, once for both tables. */
static pg_status read_fronts (pg_result *r, const pg_state *state)
{
    result_tips *t = &r->tips;
    pg_status status = PG_OK;
    size_t n = 0, nfront;
    const pg_front_values *known = pg_solver_fronts (r->solver, &n);
    const pg_front *front = pg_fronts_of_state (r->problem, state, &nfront);
    t->nfront_value = 0;
    if (n) {
        PG_GROW (t->front_value, t->cap_front_value, n);
        memcpy (t->front_value, known, n * sizeof *known);
        t->nfront_value = n;
        goto done;
    }
    for (size_t f = 0; t->measuring && f < nfront; f++)
        if (front[f].open) PG_TRY (measure_front (r, state, f, &front[f]));
done:
    return status;
}

/* The largest J of what has become of front `of` of the scene; NAN: it has ended. */
static double largest_J (const pg_result *r, const pg_state *state, long of)
{
    size_t nfront;
    const pg_front *front = pg_fronts_of_state (r->problem, state, &nfront);
    double J = NAN;
    for (size_t f = 0; f < nfront; f++)
        for (size_t i = 0; front[f].of == of && i < r->tips.nfront_value; i++)
            if (r->tips.front_value[i].front == front[f].id)
                J = fmax (J, r->tips.front_value[i].J);     /* of NAN and a number: the number */
    return J;
}

pg_status pg_result_surfaces_row (pg_result *r, const pg_state *state, double *row)
{
    pg_status status = PG_OK;
    size_t n = 0;
    if (!has_fronts (r)) return PG_OK;
    PG_TRY (read_fronts (r, state));
    if (r->tips.grows) row[n++] = state->surfaces ? state->surfaces->area : 0;
    for (size_t f = 0; f < r->problem->nfront; f++) row[n++] = largest_J (r, state, r->problem->front[f].id);
done:
    return status;
}

/* ---- cracks.csv, fronts.csv ---------------------------------------------------------------------------- */
/* A triangle of crack number k. */
static pg_status put_triangle (pg_result *r, const double when[2], long front, size_t k, const double *a,
                               const double *b, const double *c)
{
    double row[TRIANGLE_COLUMNS] = { when[0], when[1], (double) front, (double) k + 1 };
    memcpy (row + 4, a, 3 * sizeof *a), memcpy (row + 7, b, 3 * sizeof *b);
    memcpy (row + 10, c, 3 * sizeof *c);
    return pg_table_row (r->tips.pieces, row);
}

/* The cracks of the scene, as fans about their middle. */
static pg_status put_first (pg_result *r, const pg_cracks *cracks)
{
    pg_status status = PG_OK;
    const double start[2] = { 0, 0 };
    for (size_t k = 0; k < cracks->n; k++) {
        const pg_crack *c = &cracks->crack[k];
        double middle[3] = { 0 };
        for (size_t i = 0; i < 3 * c->nvertex; i++) middle[i % 3] += c->vertex[i] / (double) c->nvertex;
        for (size_t i = 0; i < c->nvertex; i++)
            PG_TRY (put_triangle (r, start, 0, k, middle, c->vertex + 3*i,
                                  c->vertex + 3 * ((i + 1) % c->nvertex)));
    }
done:
    return status;
}

pg_status pg_result_surfaces_create (pg_result *r, const result_marks *from)
{
    result_tips *t = &r->tips;
    pg_status status = PG_OK;
    char path[4096];
    const pg_cracks *cracks = pg_state_cracks (r->problem, NULL);
    snprintf (path, sizeof path, "%s/fronts.csv", r->folder);
    if (has_fronts (r))
        PG_TRY (from ? pg_table_open (&t->rows, path, FRONT_COLUMNS, front_columns, from->tips)
                     : pg_table_create (&t->rows, path, FRONT_COLUMNS, front_columns));
    snprintf (path, sizeof path, "%s/cracks.csv", r->folder);
    if (!t->grows) goto done;
    PG_TRY (from ? pg_table_open (&t->pieces, path, TRIANGLE_COLUMNS, triangle_columns, from->pieces)
                 : pg_table_create (&t->pieces, path, TRIANGLE_COLUMNS, triangle_columns));
    t->npiece = from ? from->npiece : (long) cracks->n;
    if (!from) PG_TRY (put_first (r, cracks));
done:
    return status;
}

/* After pg_result_surfaces_row, whose values it writes. */
pg_status pg_result_surfaces_write (pg_result *r, const pg_state *state, const pg_step *step)
{
    result_tips *t = &r->tips;
    pg_status status = PG_OK;
    const pg_crack_surfaces *w = state->surfaces;
    const double when[2] = { (double) step->number, step->stamp };
    for (; t->grows && w && t->npiece < (long) w->cracks.n; t->npiece++) {
        size_t k = (size_t) t->npiece;
        const double *x = w->cracks.crack[k].vertex;
        PG_TRY (put_triangle (r, when, w->owner[k - w->nfirst], k, x, x + 3, x + 6));
    }
    for (size_t i = 0; has_fronts (r) && i < t->nfront_value; i++) {
        const pg_front_values *v = &t->front_value[i];
        PG_TRY (pg_table_row (t->rows, (double[FRONT_COLUMNS]) { (double) step->number, (double) v->front,
                                                                     (double) v->vertex + 1, v->x[0], v->x[1],
                                                                     v->x[2], v->J, v->K[0], v->K[1],
                                                                     v->K[2] }));
    }
done:
    return status;
}

/* ---- the report ---------------------------------------------------------------------------------------- */
static double front_length (const pg_front *f)
{
    double length = 0;
    for (size_t i = 0; i + !f->closed < f->n; i++) {
        const double *a = f->x + 3*i, *b = f->x + 3 * ((i + 1) % f->n);
        length += hypot (hypot (b[0] - a[0], b[1] - a[1]), b[2] - a[2]);
    }
    return length;
}

void pg_result_surfaces_json (pg_json *j, const pg_result *r, const pg_state *state)
{
    const pg_crack_surfaces *w = state->surfaces;
    if (!r->tips.grows || !w) return;
    pg_json_number (j, "crack_area", w->area);
    pg_json_open (j, "fracture", '{');
    pg_json_number (j, "area", w->area);
    pg_json_number (j, "energy", pg_solver_report_now (r->solver)->energy_fracture);
    pg_json_number (j, "dissipated_over_G0_area", pg_result_paths_ratio (r));
    pg_json_count (j, "triangles", w->cracks.n - w->nfirst);
    pg_json_open (j, "fronts", '[');
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
    pg_json_shut (j);
    pg_json_shut (j);
}

/* ---- reading back -------------------------------------------------------------------------------------- */
/* The triangle of a row of cracks.csv; sided unless it is of the scene. */
pg_status pg_result_read_triangle (pg_cracks *out, const double *row)
{
    pg_status status = PG_OK;
    const double *x = row + 4;
    double u[3], v[3], size;
    pg_crack *c = &out->crack[out->n];
    *c = (pg_crack) { .kind = PG_CRACK_POLYGON, .nvertex = 3, .sided = row[0] > 0 };
    for (int k = 0; k < 3; k++) u[k] = x[3 + k] - x[k], v[k] = x[6 + k] - x[k];
    for (int k = 0; k < 3; k++) {
        int m = (k + 1) % 3, n = (k + 2) % 3;
        c->normal[k] = u[m] * v[n] - u[n] * v[m];
    }
    size = hypot (hypot (c->normal[0], c->normal[1]), c->normal[2]);
    if (!(size > 0)) return PG_OK;
    for (int k = 0; k < 3; k++) c->normal[k] /= size;
    PG_ALLOC (c->vertex, 9);
    out->n++;
    memcpy (c->vertex, x, 9 * sizeof *x);
done:
    return status;
}

int pg_result_triangle_columns (void) { return TRIANGLE_COLUMNS; }

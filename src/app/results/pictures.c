/* SPDX-License-Identifier: GPL-3.0-or-later
 * Draws the pictures of the last state or of a stage: finds the field that a picture names,
 * its component, its title and its view, and hands everything to picture.h. */
#include "results_private.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Index of the component that "stress.xx" names (dot: ".xx"); -1 for the size of a vector, -2 if there is
 * none. */
static int part_of (const char *dot, int dim, int components)
{
    if (!dot) return components == 1 ? 0 : components == dim ? -1 : 0;
    if (components == dim && dot[1] && !dot[2])
        return dot[1] >= 'x' && dot[1] < 'x' + dim ? dot[1] - 'x' : -2;
    for (int k = 0; k < components; k++) if (strcmp (dot + 1, pg_result_voigt (dim, k)) == 0) return k;
    return -2;
}

/* Computes the values that a picture shows: n, to be freed with pg_free; work holds 6 values per point. *unit
 * is a static text of the force. */
static pg_status read_part (pg_result *r, const pg_state *state, const char *name, double *work, double **out,
                            const char **unit)
{
    pg_status status = PG_OK;
    const pg_problem *p = r->problem;
    void *self;
    const pg_force_type *force = pg_solver_force (r->solver, &self);
    const char *dot = strchr (name, '.');
    char field[32];
    int components;
    snprintf (field, sizeof field, "%.*s", (int) (dot ? (size_t) (dot - name) : strlen (name)), name);
    PG_TRY (force->field (self, state, state->d, field, &components, unit, work));
    int part = components ? part_of (dot, p->dim, components) : -2;
    if (part == -2) PG_FAIL (PG_E_USAGE, "output.pictures: there is no field %s", name);
    PG_ALLOC (*out, p->cloud.n);
    for (size_t i = 0; i < p->cloud.n; i++) {
        double s = 0;
        const double *v = work + i * (size_t) components;
        for (int k = 0; k < components; k++) s += v[k] * v[k];
        (*out)[i] = part < 0 ? sqrt (s) : v[part];
    }
done:
    return status;
}

/* Writes a title such as "Disk: damage, back, load factor 0.5": title of the problem, view, limit of the
 * selection, time or load factor. */
static void write_title (const pg_result *r, const pg_state *state, const result_view *v, const char *unit,
                         char *title, size_t size)
{
    char limit[48] = "", time[32];
    pg_picture_time (state->time, time, sizeof time);
    /* grown crack surfaces are drawn themselves, whatever the damage is */
    if (v->limited || (v->by_damage && !state->surfaces))
        snprintf (limit, sizeof limit, " (%s\xe2\x89\xa5 %.4g%s%s)", v->by_damage ? "damage " : "",
                  v->style.above, v->limited && *unit ? " " : "", v->limited ? unit : "");
    int used = snprintf (title, size, "%.200s%s%s%s, ", r->problem->title, v->look[0] ? ", " : "", v->look,
                         limit);
    if (r->dynamic) used += snprintf (title + used, size - (size_t) used, "time %s", time);
    else used += snprintf (title + used, size - (size_t) used, "load factor %.4g", state->factor);
    if (v->style.magnify != 0)
        snprintf (title + used, size - (size_t) used, ", displacements \xc3\x97 %g", v->style.magnify);
}

/* Returns the outline of the body: 2D elements, its shapes, or whole cells; nothing for points from a
 * file. */
static pg_outline result_outline (const pg_result *r)
{
    const pg_problem *p = r->problem;
    if (p->part.mesh.n) return (pg_outline) { .mesh = p->dim == 2 ? &p->part.mesh : NULL };
    if (!p->lattice.dim || !p->body.n) return (pg_outline) { 0 };
    return (pg_outline) { .body = &p->body, .lattice = r->pictures.stairs ? &p->lattice : NULL };
}

/* Draws one picture. Stress, and ranges that are symmetric about zero, have a diverging scale.
 * As long as no point is damaged the body of a mesh is drawn on its elements; later these
 * would hide the crack. u: scratch space, 6 values per point. */
static pg_status one_picture (pg_result *r, const pg_state *state, const result_view *v, const char *path,
                              double *work, double *u)
{
    pg_status status = PG_OK;
    const pg_problem *p = r->problem;
    void *self;
    const pg_force_type *force = pg_solver_force (r->solver, &self);
    const char *unit, *none;
    char label[96], title[400];
    int components;
    double *one = NULL, *damage = NULL;
    PG_TRY (read_part (r, state, v->field, work, &one, &unit));
    if (v->by_damage || p->part.mesh.n || v->style.magnify != 0)
        PG_TRY (read_part (r, state, "damage", work, &damage, &none));
    PG_TRY (force->field (self, state, state->d, "displacement", &components, &none, u));
    snprintf (label, sizeof label, "%s%s%s%s", v->field, *unit ? " (" : "", unit, *unit ? ")" : "");
    write_title (r, state, v, unit, title, sizeof title);
    pg_picture_style style = v->style;
    style.title = title, style.label = label, style.u = u, style.cracks = pg_state_cracks (p, state);
    style.diverging = style.low < style.high ? style.low == -style.high
                                             : strncmp (v->field, "stress", 6) == 0;
    style.clip = strncmp (v->field, "damage", 6) != 0;
    style.select = v->by_damage ? damage : v->limited ? one : NULL;
    pg_outline outline = result_outline (r);
    style.outline = outline.body || outline.mesh ? &outline : NULL, style.damage = damage;
    int whole = p->part.mesh.n > 0;                        /* no damage: elements hide no crack */
    for (size_t i = 0; whole && i < p->cloud.n; i++) whole = !(damage[i] > 0);
    PG_TRY (pg_picture_body (path, whole ? &p->part : NULL, &p->cloud, one, &style));
done:
    pg_free (one), pg_free (damage);
    return status;
}

/* Warns of a picture that could not be drawn. That is no reason for a run to fail: its results do not depend
 * on it. Each reason is reported once, with the first picture. */
static void miss_picture (pg_result *r, const char *path, pg_status status)
{
    const char *reason = pg_last_error (), *slash = strrchr (path, '/');
    if (status == PG_OK || strncmp (r->pictures.undrawn, reason, sizeof r->pictures.undrawn - 1) == 0) return;
    snprintf (r->pictures.undrawn, sizeof r->pictures.undrawn, "%s", reason);
    pg_solver_warn (r->solver, "pictures could not be drawn, %s among them: %s", slash ? slash + 1 : path,
                    reason);
}

/* Lists a picture that was drawn, or warns of one that was not. */
static void list_picture (pg_result *r, const char *path, pg_status status, int listed)
{
    if (status != PG_OK) miss_picture (r, path, status);
    else if (listed) snprintf (r->written[r->nwritten++], sizeof *r->written, "%s", path);
}

/* Draws all pictures into FOLDER/within; `suffix` follows their names. listed: they belong to those that the
 * run names at its end. Forces without fields have no pictures. Fields have at most three values a point in
 * 2D and six in 3D: r->u has room for two of them, or for one. */
static void draw_all (pg_result *r, const pg_state *state, const char *within, const char *suffix, int listed)
{
    size_t n = r->problem->cloud.n;
    double *more = r->problem->dim == 3 ? pg_calloc (6 * n, sizeof *more) : NULL;
    double *work = more ? more : r->u, *u = more ? r->u : r->u + 3 * n;
    char path[4096];
    for (size_t k = 0; pg_solver_force (r->solver, NULL)->field && k < r->pictures.npicture; k++) {
        snprintf (path, sizeof path, "%s/%s%s%s.png", r->folder, within, r->pictures.picture[k].name, suffix);
        pg_status status = r->problem->dim < 3 || more
                               ? one_picture (r, state, &r->pictures.picture[k], path, work, u)
                               : pg_error (PG_E_MEMORY, PG_HERE, "no memory for %zu values", 6 * n);
        list_picture (r, path, status, listed);
    }
    pg_free (more);
}

/* Draws all pictures for the moment whose fields have just been written; its number is in their names. */
void pg_result_draw_stage (pg_result *r, const pg_state *state)
{
    char path[4096], suffix[32];
    snprintf (path, sizeof path, "%s/stages", r->folder);
    pg_status status = pg_folder_make (path);
    miss_picture (r, path, status);
    if (status != PG_OK) return;
    snprintf (suffix, sizeof suffix, "_%04ld", r->fields.moments - 1);
    draw_all (r, state, "stages/", suffix, 0);
}

/* Draws |u - u_ref| at the points, with both norms in the title. */
static void error_picture (pg_result *r, const pg_state *state)
{
    const pg_norms *n = &r->errors.norms;
    char path[4096], title[400];
    pg_outline outline = result_outline (r);
    pg_picture_style style = { .label = "|u - u_{ref}| (m)",
                               .cracks = pg_state_cracks (r->problem, state),
                               .title = title,
                               .outline = outline.body || outline.mesh ? &outline : NULL };
    snprintf (title, sizeof title, "%s: difference from the reference, L2 %.2e, largest %.2e",
              r->problem->title, n->l2.relative, n->maximum.relative);
    snprintf (path, sizeof path, "%s/error.png", r->folder);
    pg_status status = pg_picture_body (path, state->broken ? NULL : &r->problem->part, &r->problem->cloud,
                                        r->errors.difference, &style);
    list_picture (r, path, status, 1);
}

/* Measures the state against the reference, whose expressions take the time, in quasi-static runs the load
 * factor. */
pg_status pg_result_measure (pg_result *r, const pg_state *state)
{
    pg_status status = PG_OK;
    pg_sampler solution = { 0 };
    void *self;
    const pg_force_type *force = pg_solver_force (r->solver, &self);
    if (!r->reference) return PG_OK;
    PG_TRY (pg_sampler_solution (&solution, r->problem, force, self, state));
    PG_TRY (pg_errors_measure (&r->errors, r->reference, r->problem, &solution,
                               r->dynamic ? state->time : state->factor));
    r->measured = 1;
    if (r->pictures.npicture && r->errors.difference && r->errors.norms.displacement)
        error_picture (r, state);
done:
    pg_sampler_clear (&solution);
    return status;
}

/* Draws all pictures. A run that asks for none gets no charts either, so that cairo is not loaded, which
 * takes longer than many a small run. A curve needs two points at least. */
void pg_result_draw (pg_result *r, const pg_state *state)
{
    if (r->pictures.npicture == 0) return;
    draw_all (r, state, "", "", 1);
    if (r->curve.load >= 0 && r->curve.npoint > 1)
        miss_picture (r, "load_displacement.png", pg_result_curve_picture (r));
    miss_picture (r, "tip.png", pg_result_tips_pictures (r));
}

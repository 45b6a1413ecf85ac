/* SPDX-License-Identifier: GPL-3.0-or-later
 * Fields of a result as pictures: reads steps of DIR/result.e, chooses the component and the
 * points, finds out from the copied scene where body and pre-cracks are, from cracks.csv where cracks
 * have grown, names files and panels, and hands everything to picture.h.
 *
 * Only the folder is needed: without scene.yaml a picture has no pre-cracks and an outline
 * from the points alone; without the mesh file of the run it is drawn by points. */
#include "plot.h"
#include "perigal/results.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* A result that is being drawn. */
typedef struct {
    pg_cloud cloud;
    /* The copy of the scene that the run left; NULL if there is none. */
    pg_scene *scene;
    pg_cracks cracks;
    /* The shapes of the body, and its lattice if cells are whole (`cells: staircase`). */
    pg_body  body;
    pg_lattice lattice;
    pg_outline outline;
    /* 1: the file has the field damage. */
    int      damaged;
    /* The mesh whose nodes the points are, if it is still there. */
    pg_mesh_body part;
    /* 1: nothing has broken, so that fields may be drawn on elements. */
    int      whole;
    size_t   nstep;
    double  *time;
    /* Component of the field that is drawn, number of its components; norm = 1: its magnitude. */
    int      component, components, norm;
    /* Name and unit on the colour bar. */
    char     name[128], unit[16];
} source;

/* A step: values (n), displacements, m (n x dim), values that select points (n), damage (n); the grown cracks
 * (none: those of the scene are drawn); title. */
typedef struct { double *value, *u, *select, *damage; pg_cracks cracks; char title[64]; } stage;

/* ---- components ------------------------------------------------------------------------------------- */
int pg_plot_index (const char *word, const char *list)
{
    int k = 0;
    for (const char *s = list; *s; s += strcspn (s, "|"), s += *s == '|', k++)
        if (strlen (word) == strcspn (s, "|") && strncmp (s, word, strlen (word)) == 0) return k;
    return -1;
}

/* Names of the components of a field with m values per point as "x|y|z" or "xx|yy|xy"; "" if
 * they have none. A field with dim values is a vector, with 3 (2D) or 6 (3D) a tensor. */
static const char *component_names (int dim, int m)
{
    static const char *const axes[] = { "", "x", "x|y", "x|y|z" };
    if (m > 1 && m == dim) return axes[dim];
    if (dim == 2 && m == 3) return "xx|yy|xy";
    return dim == 3 && m == 6 ? "xx|yy|zz|xy|yz|zx" : "";
}

/* Reads an index from 0 to most - 1; -1 for anything else. */
static int number_of (const char *text, int most)
{
    char *end;
    long k = strtol (text, &end, 10);
    return end == text || *end || k < 0 || k >= most ? -1 : (int) k;
}

/* Index of a component by its name ("yy") or number; -1 if there is none. */
static int component_of (const char *wanted, const char *names, int m)
{
    int k = pg_plot_index (wanted, names);
    return k >= 0 ? k : number_of (wanted, m);
}

/* Names the component on the colour bar: "|displacement|", "stress_{yy}", "field 2". */
static void name_component (source *s, const char *field, const char *names)
{
    int m = s->components;
    if (s->norm) snprintf (s->name, sizeof s->name, "|%.31s|", field);
    else if (m == 1) snprintf (s->name, sizeof s->name, "%.31s", field);
    else if (!names[0]) snprintf (s->name, sizeof s->name, "%.31s %d", field, s->component);
    else {
        for (int k = s->component; k > 0; k--) names += strcspn (names, "|") + 1;
        snprintf (s->name, sizeof s->name, "%.31s_{%.*s}", field, (int) strcspn (names, "|"), names);
    }
}

/* Chooses the component that is asked for by name or number, by default the magnitude of a vector and xx of a
 * tensor, and its name on the colour bar. */
static pg_status choose_component (const plot_request *q, source *s)
{
    pg_status status = PG_OK;
    int dim = s->cloud.dim, m = s->components, k = 0;
    const char *names = component_names (dim, m), *wanted = q->component;
    if (!wanted && m > 1) wanted = m == dim || !names[0] ? "magnitude" : "xx";
    s->norm = wanted && strcmp (wanted, "magnitude") == 0 && m > 1;
    if (wanted && !s->norm) k = component_of (wanted, names, m);
    if (k < 0 && m == 1) PG_FAIL (PG_E_USAGE, "field %s has one component", q->field);
    if (k < 0)
        PG_FAIL (PG_E_USAGE, "field %s has no component %s: 0 to %d%s%s or magnitude", q->field, wanted,
                 m - 1, names[0] ? ", " : "", names);
    s->component = k;
    name_component (s, q->field, names);
done:
    return status;
}

/* Length of a vector, or Frobenius norm of a symmetric tensor in Voigt order: shears count
 * twice, engineering strains with half their value (shear = 0.5; stresses 1). */
static double magnitude (const double *v, int dim, int m, double shear)
{
    double sum = 0;
    int tensor = m != dim && m == dim * (dim + 1) / 2;
    for (int c = 0; c < m; c++) sum += v[c] * v[c] * (tensor && c >= dim ? 2 * shear * shear : 1);
    return sqrt (sum);
}

/* ---- reading ------------------------------------------------------------------------------------------- */
/* Reads the outline of the body from the scene; a body of points from a file has one only if it has shapes.
 * If cells are whole (staircase) the lattice is built again. */
static void read_outline (source *s)
{
    pg_cloud cloud = { 0 };
    int points = pg_scene_given (s->scene, "points");
    if (pg_scene_given (s->scene, "mesh") || s->cloud.dim < 2) return;
    if (pg_body_read (&s->body, s->scene) != PG_OK) s->body = (pg_body) { 0 };
    int stairs = strcmp (pg_scene_text (s->scene, "cells"), "staircase") == 0;
    if (stairs && s->body.n && !points && pg_cloud_build (&cloud, &s->lattice, &s->body, s->scene) != PG_OK)
        s->lattice = (pg_lattice){ 0 };
    pg_cloud_clear (&cloud);
    if (s->body.n) s->outline = (pg_outline) { .body = &s->body, .lattice = &s->lattice };
}

/* 1 if the file has that field. */
static int is_stored (const plot_request *q, const char *name)
{
    char (*names)[32] = NULL;
    size_t n = 0;
    int found = 0;
    if (pg_exodus_fields (q->result, &names, &n) != PG_OK) return 0;
    for (size_t k = 0; k < n; k++) found |= strcmp (names[k], name) == 0;
    pg_free (names);
    return found;
}

/* Reads the copy of the scene, with its pre-cracks; without one the picture has none. Values that --set
 * replaced are applied if they can be read back. */
static void read_scene (const plot_request *q, source *s)
{
    char path[PLOT_PATH];
    snprintf (path, sizeof path, "%.2100s/scene.yaml", q->directory);
    if (access (path, R_OK) != 0
        || (pg_stored_scene (&s->scene, q->directory) != PG_OK && pg_scene_load (&s->scene, path) != PG_OK))
        return;
    if (pg_cracks_read (&s->cracks, s->scene) != PG_OK) s->cracks = (pg_cracks) { 0 };
    read_outline (s);
}

/* 1: the nodes of the mesh of the run, as its files are today, are the points of the result. */
static int is_same_mesh (const plot_request *q, source *s)
{
    pg_scene *scene = NULL;
    pg_cloud cloud = { 0 };
    size_t known = s->cloud.n * (size_t) s->cloud.dim;
    int same = pg_stored_scene (&scene, q->directory) == PG_OK && pg_mesh_body_read (&s->part, scene) == PG_OK
               && pg_mesh_body_cloud (&cloud, &s->part, scene) == PG_OK;
    same = same && cloud.n == s->cloud.n && cloud.dim == s->cloud.dim;
    for (size_t i = 0; same && i < known; i++) same = fabs (cloud.x[i] - s->cloud.x[i]) <= 1e-6 * cloud.h;
    pg_cloud_clear (&cloud);
    pg_scene_free (&scene);
    return same;
}

/* Sets *whole to 0 if a point is damaged in the steps that are drawn. */
static pg_status nothing_broke (const plot_request *q, const source *s, int *whole)
{
    pg_status status = PG_OK;
    double *damage = NULL;
    int last = (int) s->nstep - 1, each = q->all || q->movie, components;
    int first = each ? 0 : q->step[0] < 0 ? last : q->step[0];
    size_t n;
    for (int k = first; *whole && k <= (each ? last : first); k++) {
        PG_TRY (pg_exodus_read (q->result, "damage", k, &n, &components, &damage));
        for (size_t i = 0; i < n; i++) *whole &= !(damage[i] > 0);
        pg_free (damage), damage = NULL;
    }
done:
    pg_free (damage);
    return status;
}

/* Reads the mesh of the run, unless it is gone or its nodes are no longer the points (to 1e-6 of the
 * spacing). Fields are drawn on its elements unless bonds broke in the steps that are shown, since elements
 * would hide the crack; damage is always drawn by points. */
static pg_status read_part (const plot_request *q, source *s)
{
    pg_status status = PG_OK;
    int by_points = q->movie ? q->style.magnify != 0 : q->panels;
    int same = 0, whole = !by_points && strcmp (q->field, "damage") != 0;
    if (!s->scene || !pg_scene_given (s->scene, "mesh")) return PG_OK;
    same = is_same_mesh (q, s);
    if (same) PG_TRY (nothing_broke (q, s, &whole));
done:
    if (status != PG_OK || !same) pg_mesh_body_clear (&s->part);
    s->whole = whole;
    if (s->part.mesh.n && s->cloud.dim == 2) s->outline = (pg_outline) { .mesh = &s->part.mesh };
    return status;
}

/* Opens the result: points, steps, components and unit of the field; options for 3D views are refused in 1D
 * and 2D. The copied scene is optional. */
static pg_status open_source (const plot_request *q, source *s)
{
    pg_status status = PG_OK;
    double *field = NULL;
    size_t n;
    PG_TRY (pg_exodus_points (q->result, &s->cloud, &s->nstep, &s->time));
    PG_TRY (pg_exodus_read (q->result, q->field, 0, &n, &s->components, &field));
    PG_TRY (pg_exodus_unit (q->result, q->field, s->unit));
    if (s->cloud.dim != 3
        && (q->style.section || q->style.view || q->limited || q->style.direction[0] != 0
            || q->style.direction[1] != 0 || q->style.direction[2] != 0))
        PG_FAIL (PG_E_USAGE, "--section, --view, --direction and --above are for 3D results; %s is %dD",
                 q->result, s->cloud.dim);
    PG_TRY (choose_component (q, s));
    read_scene (q, s);
    s->damaged = is_stored (q, "damage");
done:
    pg_free (field);
    return status;
}

/* Frees everything; may be called for a result that was only half opened. */
static void close_source (source *s)
{
    pg_cracks_clear (&s->cracks);
    pg_body_clear (&s->body), pg_lattice_clear (&s->lattice);
    pg_mesh_body_clear (&s->part);
    pg_scene_free (&s->scene);
    pg_free (s->time);
    pg_cloud_clear (&s->cloud);
}

/* Writes the title of a step: "time 2 ms", "load factor 0.5", or with event stepping "event 12, load factor
 * 0.5"; without the scene, which says what the time means, "step 3, time 0.5". */
static void name_stage (const plot_request *q, const source *s, int step, char *text, size_t size)
{
    const char *kind = s->scene ? pg_scene_text (s->scene, "solver.kind") : "",
               *stepping = s->scene ? pg_scene_text (s->scene, "solver.stepping") : "";
    double time = s->time[step], last = s->time[s->nstep - 1], factor;
    long events;
    /* load factors end at 1: larger times are numbers of steps */
    int event = strcmp (stepping, "event") == 0 || (strcmp (stepping, "auto") == 0 && last > 1);
    if (*kind && !pg_solver_is (kind, PG_SOLVER_QUASI_STATIC))
        pg_picture_time (time, text + snprintf (text, size, "time "), size - 5);
    else if (!*kind) snprintf (text, size, "step %d, time %.6g", step, time);
    else if (!event || !pg_solver_is (kind, PG_SOLVER_EVENTS))
        snprintf (text, size, "load factor %.4g", time);
    else if (!pg_plot_event (q->directory, time, &events, &factor)) snprintf (text, size, "step %.0f", time);
    else if (events) snprintf (text, size, "event %ld, load factor %.4g", events, factor);
    else snprintf (text, size, "load factor %.4g", factor);
}

/* Reads what a picture of one step needs: the field and its component; displacements and
 * damage if the body is drawn deformed; damage for the view crack. */
static pg_status read_stage (const plot_request *q, const source *s, int step, stage *g)
{
    pg_status status = PG_OK;
    double *field = NULL, shear = strstr (q->field, "strain") ? 0.5 : 1;
    size_t n;
    int m;
    PG_TRY (pg_exodus_read (q->result, q->field, step, &n, &m, &field));
    PG_ALLOC (g->value, n);
    for (size_t i = 0; i < n; i++) {
        const double *v = field + i * (size_t) m;
        g->value[i] = s->norm ? magnitude (v, s->cloud.dim, m, shear) : v[s->component];
    }
    if (q->style.magnify != 0) {
        PG_TRY (pg_exodus_read (q->result, "displacement", step, &n, &m, &g->u));
        if (m != s->cloud.dim) PG_FAIL (PG_E_FILE, "%s: displacement has %d components", q->result, m);
        if (s->damaged) PG_TRY (pg_exodus_read (q->result, "damage", step, &n, &m, &g->damage));
    }
    if (q->style.view == PG_VIEW_CRACK && !q->limited)
        PG_TRY (pg_exodus_read (q->result, "damage", step, &n, &m, &g->select));
    int last = step < 0 ? (int) s->nstep - 1 : step;
    PG_TRY (pg_result_cracks (&g->cracks, q->directory, s->time[last]));
    name_stage (q, s, last, g->title, sizeof g->title);
done:
    pg_free (field);
    return status;
}

/* Frees a step. */
static void drop_stage (stage *g)
{
    pg_free (g->value), pg_free (g->u), pg_free (g->select), pg_free (g->damage);
    pg_cracks_clear (&g->cracks);
    *g = (stage) { 0 };
}

/* ---- drawing ---------------------------------------------------------------------------------------- */
/* Names the picture: DIR/FIELD.COMPONENT_VIEW_0007.png as in output.pictures, or --out with the number before
 * its ending; number -1: without one. */
static void name_picture (const plot_request *q, int number, char *path, size_t size)
{
    char name[160] = "", count[16] = "";
    if (number >= 0) snprintf (count, sizeof count, "_%04d", number);
    if (q->out) {
        const char *dot = strrchr (q->out, '.');
        size_t n = dot && !strchr (dot, '/') ? (size_t) (dot - q->out) : strlen (q->out);
        snprintf (path, size, "%.*s%s%s", (int) n, q->out, count, q->out + n);
        return;
    }
    pg_picture_name (name, 60, q->field);
    if (q->component) strcat (name, "."), pg_picture_name (name, 90, q->component);
    if (q->look) strcat (name, "_"), pg_picture_name (name, 130, q->look);
    if (q->movie) strcat (name, "_movie");
    else if (q->panels) strcat (name, "_steps");
    snprintf (path, size, "%.2100s/%s%s.png", q->directory, name, count);
}

/* Extends the range of the colours by one step: all pictures of a series share it, so that
 * they can be compared. *any: a finite value has been seen. */
static pg_status widen_range (const plot_request *q, const source *s, const stage *g, pg_picture_style *style,
                              int *any)
{
    pg_status status = PG_OK;
    double low, high;
    int found;
    PG_TRY (pg_picture_range (s->cloud.n, g->value, style->clip ? 2 : 0, &low, &high, &found));
    if (q->limited) low = fmax (low, fmin (q->style.above, high));
    if (found)
        style->low = *any ? fmin (style->low, low) : low,
        style->high = *any ? fmax (style->high, high) : high;
    *any |= found;
done:
    return status;
}

/* Sets the final range of the colours: blue to red where both signs occur to more than a trace (2 % of the
 * larger), damage 0 to 1, or the range given; logarithmic colours find their own. */
static void settle_range (const plot_request *q, pg_picture_style *style)
{
    /* no diverging colours for a trace of the other sign */
    style->diverging = fmin (-style->low, style->high) > 0.02 * fmax (-style->low, style->high);
    if (style->diverging) style->high = fmax (-style->low, style->high), style->low = -style->high;
    if (strcmp (q->field, "damage") == 0 && !style->log) style->low = 0, style->high = 1;
    if (style->log) style->low = style->high = 0;
    if (q->ranged)
        style->low = q->style.low, style->high = q->style.high,
        style->diverging &= style->low == -style->high;
}

/* Writes the title, such as "damage, iso (damage >= 0.35), time 2 ms, displacements x 10": what is shown, as
 * far as it is not the default. surfaces: grown cracks are drawn as surfaces, whatever the damage is. */
static void write_title (const plot_request *q, const source *s, const pg_picture_style *style, int surfaces,
                         const char *stage_title, char *title, size_t size)
{
    const char *unit = q->limited ? s->unit : "", *name = surfaces && style->by_depth ? "" : s->name;
    int used = snprintf (title, size, "%s%s%.60s", name, q->look && *name ? ", " : "",
                         q->look ? q->look : "");
    if ((style->view == PG_VIEW_CRACK && !surfaces) || q->limited)
        used += snprintf (title + used, size - (size_t) used, " (%s\xe2\x89\xa5 %.4g%s%s)",
                          q->limited ? "" : "damage ", style->above, unit[0] ? " " : "", unit);
    if (stage_title) used += snprintf (title + used, size - (size_t) used, ", %s", stage_title);
    if (style->magnify != 0)
        snprintf (title + used, size - (size_t) used, ", displacements \xc3\x97 %g", style->magnify);
}

/* Writes the label of the colour bar: "|stress_{xx}| (Pa)" where decades of the magnitude are shown. */
static void write_label (const source *s, const pg_picture_style *style, char *label, size_t size)
{
    const char *bar = style->log && !s->norm ? "|" : "", *unit = s->unit;
    snprintf (label, size, "%s%s%s%s%s%s", bar, s->name, bar, unit[0] ? " (" : "", unit, unit[0] ? ")" : "");
}

/* Fills the panels of n steps; if there are several (and in 1D) each has a title of its own. */
static void fill_panels (pg_panel *panel, const plot_request *q, const source *s, size_t n, const stage *g)
{
    int titled = n > 1 || s->cloud.dim == 1;
    for (size_t k = 0; k < n; k++) {
        const double *select = q->limited ? g[k].value : g[k].select;
        const pg_cracks *grown = g[k].cracks.n ? &g[k].cracks : NULL;
        panel[k] = (pg_panel) { titled ? g[k].title : NULL, g[k].value, g[k].u, select, g[k].damage, grown };
    }
}

/* Draws n steps as one picture, with title and label; with `measured` it only measures the frame of one step.
 * Only single steps are drawn on elements. */
static pg_status draw_at (const char *path, pg_reach *measured, const plot_request *q, const source *s,
                          size_t n, const stage *g, const pg_picture_style *given)
{
    pg_status status = PG_OK;
    char title[256], label[160];
    pg_panel *panel = NULL;
    pg_picture_style style = *given;
    int crack = style.view == PG_VIEW_CRACK;
    PG_ALLOC (panel, n);
    fill_panels (panel, q, s, n, g);
    if (crack) style.by_depth = strcmp (q->field, "damage") == 0;
    if (crack && !q->limited) style.above = PG_CRACK_DAMAGE;
    int surfaces = crack && n && g[n - 1].cracks.n;
    write_title (q, s, &style, surfaces, n == 1 ? g->title : NULL, title, sizeof title);
    write_label (s, &style, label, sizeof label);
    style.title = title, style.label = label, style.cracks = s->cracks.n ? &s->cracks : NULL;
    style.outline = s->outline.body || s->outline.mesh ? &s->outline : NULL;
    style.u = panel->u, style.select = panel->select;
    int on_mesh = n == 1 && s->whole && s->part.mesh.n;
    if (measured) PG_TRY (pg_picture_reach (measured, &s->cloud, panel, &style));
    else if (on_mesh && pg_picture_on_elements (&s->part, &style))
        PG_TRY (pg_picture_body (path, &s->part, &s->cloud, panel->value, &style));
    else PG_TRY (pg_picture_panels (path, &s->cloud, n, panel, q->columns, &style));
done:
    pg_free (panel);
    return status;
}

/* Draws n steps as one picture and prints its name. */
static pg_status draw (const plot_request *q, const source *s, size_t n, const stage *g,
                       const pg_picture_style *given, int number)
{
    pg_status status = PG_OK;
    char path[PLOT_PATH];
    name_picture (q, number, path, sizeof path);
    PG_TRY (draw_at (path, NULL, q, s, n, g, given));
    puts (path);
done:
    return status;
}

/* The steps of a movie: those that were named, or all. */
static int movie_steps (const plot_request *q, const source *s)
{
    return q->panels ? q->steps : (int) s->nstep;
}
static int movie_step (const plot_request *q, int k) { return q->panels ? q->step[k] : k; }

/* Draws a movie with one range of colours and, for deformed bodies, one frame for all pictures, so that
 * nothing jumps. Steps are read twice, so that one of them is in memory at a time; each picture passes
 * through a file beside the movie. */
static pg_status draw_movie (const plot_request *q, const source *s)
{
    pg_status status = PG_OK;
    pg_picture_style style = q->style;
    stage g = { 0 };
    pg_movie *movie = NULL;
    pg_reach reach = { 0 };
    char path[PLOT_PATH], frame[PLOT_PATH + 16] = "";
    int found = 0, n = movie_steps (q, s);
    style.clip = strcmp (q->field, "damage") != 0;
    if (s->cloud.dim == 1) PG_FAIL (PG_E_USAGE, "--movie is for results in 2D and 3D; %s is 1D", q->result);
    name_picture (q, -1, path, sizeof path);
    PG_TRY (pg_movie_create (&movie, path, (size_t) n, q->rate > 0 ? q->rate : 10));
    snprintf (frame, sizeof frame, "%s.frame.png", path);
    for (int k = 0; k < n; k++) {
        PG_TRY (read_stage (q, s, movie_step (q, k), &g));
        PG_TRY (widen_range (q, s, &g, &style, &found));
        if (style.magnify != 0) PG_TRY (draw_at (NULL, &reach, q, s, 1, &g, &style));
        drop_stage (&g);
    }
    settle_range (q, &style);
    style.reach = &reach;
    for (int k = 0; k < n; k++) {
        PG_TRY (read_stage (q, s, movie_step (q, k), &g));
        PG_TRY (draw_at (frame, NULL, q, s, 1, &g, &style));
        PG_TRY (pg_movie_add (movie, frame));
        drop_stage (&g);
    }
done:
    if (frame[0]) remove (frame);
    drop_stage (&g);
    status = pg_movie_close (&movie, status);
    if (status == PG_OK) puts (path);
    return status;
}

/* Draws every step as a picture of its own. Steps are read twice, once for the common range of the colours
 * and once to be drawn, so that one of them is in memory at a time. */
static pg_status draw_each (const plot_request *q, const source *s)
{
    pg_status status = PG_OK;
    pg_picture_style style = q->style;
    style.clip = strcmp (q->field, "damage") != 0;
    stage g = { 0 };
    int found = 0;
    for (int k = 0; k < (int) s->nstep; k++) {
        PG_TRY (read_stage (q, s, k, &g));
        PG_TRY (widen_range (q, s, &g, &style, &found));
        drop_stage (&g);
    }
    settle_range (q, &style);
    for (int k = 0; k < (int) s->nstep; k++) {
        PG_TRY (read_stage (q, s, k, &g));
        PG_TRY (draw (q, s, 1, &g, &style, k));
        drop_stage (&g);
    }
done:
    drop_stage (&g);
    return status;
}

/* Draws several steps as panels of one picture. The range of the colours is that of what the panels show. */
static pg_status draw_together (const plot_request *q, const source *s)
{
    pg_status status = PG_OK;
    pg_picture_style style = q->style;
    style.clip = strcmp (q->field, "damage") != 0;
    stage *g = NULL;
    int found = 0;
    PG_ALLOC (g, (size_t) q->steps);
    for (int k = 0; k < q->steps; k++) {
        PG_TRY (read_stage (q, s, q->step[k], &g[k]));
        PG_TRY (widen_range (q, s, &g[k], &style, &found));
    }
    settle_range (q, &style);
    if (!q->ranged && strcmp (q->field, "damage") != 0) style.low = style.high = 0;  /* found when drawn */
    PG_TRY (draw (q, s, (size_t) q->steps, g, &style, -1));
done:
    for (int k = 0; g && k < q->steps; k++) drop_stage (&g[k]);
    pg_free (g);
    return status;
}

/* Turns steps that count from the end into steps from the start; PG_E_USAGE for those that do
 * not exist. */
static pg_status count_steps (plot_request *q, const source *s)
{
    pg_status status = PG_OK;
    int n = (int) s->nstep;
    if (n == 0) PG_FAIL (PG_E_USAGE, "%s holds no step yet", q->result);
    for (int k = 0; k < q->steps && !q->all; k++) {
        if (q->step[k] >= n || q->step[k] < -n)
            PG_FAIL (PG_E_USAGE,
                     "%s has no step %d; its steps are 0 to %d (-1 is the last; perigal plot %s --list tells "
                     "what they are)",
                     q->result, q->step[k], n - 1, q->directory);
        if (q->step[k] < 0) q->step[k] += n;
    }
done:
    return status;
}

/* Draws a field. The mesh of the body is read after the steps are known, since their damage decides how it is
 * drawn. */
pg_status pg_plot_field (plot_request *q)
{
    pg_status status = PG_OK;
    source s = { 0 };
    PG_TRY (open_source (q, &s));
    PG_TRY (count_steps (q, &s));
    PG_TRY (read_part (q, &s));
    PG_TRY (q->movie ? draw_movie (q, &s) : q->all ? draw_each (q, &s) : draw_together (q, &s));
done:
    close_source (&s);
    return status;
}

/* Lists the steps, counted from 0, as --step takes them. */
pg_status pg_plot_list (const plot_request *q)
{
    pg_status status = PG_OK;
    source s = { 0 };
    char title[96];
    PG_TRY (pg_exodus_points (q->result, &s.cloud, &s.nstep, &s.time));
    read_scene (q, &s);
    for (int k = 0; k < (int) s.nstep; k++) {
        name_stage (q, &s, k, title, sizeof title);
        printf ("%5d  %s\n", k, title);
    }
done:
    close_source (&s);
    return status;
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * A scene before it has run: its body as given by shapes (alpha shapes, meshes, holes), its points, cracks
 * and slots, coloured by depth below the surface, material, local spacing, or by a property that is an
 * expression of position, such as random fields of stiffness and strength. */
#include "plot.h"
#include "perigal/force.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Returns the index of the stiffness or limit of that name (NULL: of the first one) if it varies with
 * position in some material; -1: none does. */
static int variation_of (const pg_problem *p, const char *name)
{
    for (int k = 0; k < PG_OF_COUNT; k++)
        for (size_t m = 0; p->at.vary && m < p->nmaterial; m++)
            if (p->at.vary[m].of[k] && (!name || strcmp (name, pg_variation_name (k, NULL)) == 0)) return k;
    return -1;
}

/* What the points are coloured by: the field that is asked for, else the first property that varies, else
 * materials if there are several, else depth; without shapes the body is grey. */
enum { GREY = -1, MATERIAL = PG_OF_COUNT, SPACING, DEPTH };

static pg_status choose (int *out, const plot_request *q, const pg_problem *p)
{
    pg_status status = PG_OK;
    int k = variation_of (p, q->field);
    *out = k >= 0 ? k : p->nmaterial > 1 ? MATERIAL : p->body.n ? DEPTH : GREY;
    if (!q->field || k >= 0) return PG_OK;
    if (strcmp (q->field, "material") == 0) *out = MATERIAL;
    else if (strcmp (q->field, "spacing") == 0) *out = SPACING;
    else if (strcmp (q->field, "depth") == 0 && p->body.n) *out = DEPTH;
    else
        PG_FAIL (PG_E_USAGE,
                 "--field %s: of a scene that has not run: material, spacing, depth (below the surface of "
                 "a body of shapes), or a stiffness or strength that is an expression of place in "
                 "it%s", q->field,
                 variation_of (p, NULL) < 0 ? " (there is none)" : "");
done:
    return status;
}

static void find_values (const pg_problem *p, int what, double *value)
{
    double depth = 0;
    for (size_t i = 0; i < p->cloud.n; i++) {
        size_t m = (size_t) p->block[PG_NODES][i];
        pg_place at = pg_place_of (p->dim, p->cloud.x + i * (size_t) p->dim, 0);
        const pg_expression *e = what >= 0 && what < PG_OF_COUNT ? p->at.vary[m].of[what] : NULL;
        if (what == DEPTH) pg_body_nearest (&p->body, p->cloud.x + i * (size_t) p->dim, &depth);
        value[i] = e                  ? pg_expression_value (e, &at)
                   : what == DEPTH    ? depth
                   : what == SPACING  ? pg_problem_spacing (p, PG_NODES, i)
                   : what == MATERIAL ? (double) m + 1
                                      : NAN;
    }
}

static void write_label (int what, char label[80])
{
    static const char *const names[] = { [MATERIAL - MATERIAL] = "material", [SPACING - MATERIAL] = "spacing",
                                         [DEPTH - MATERIAL] = "depth below the surface" };
    const char *unit = what == MATERIAL ? "number" : "m", *name = what < MATERIAL ? "the body"
                                                                                  : names[what - MATERIAL];
    if (what >= 0 && what < PG_OF_COUNT) name = pg_variation_name (what, &unit);
    snprintf (label, 80, what == GREY ? "%s" : "%s (%s)", name, unit);
}

/* Names the picture: "dir/scene.yaml" becomes "scene.png" in the current folder, unless --out is given. */
static void name_picture (const plot_request *q, char *path, size_t size)
{
    const char *slash = strrchr (q->directory, '/'), *base = slash ? slash + 1 : q->directory;
    if (q->out) snprintf (path, size, "%s", q->out);
    else snprintf (path, size, "%.*s.png", (int) strcspn (base, "."), base);
}

int pg_plot_is_scene (const char *path)
{
    const char *end = strrchr (path, '.');
    return pg_plot_is_file (path) && end && (strcmp (end, ".yaml") == 0 || strcmp (end, ".yml") == 0);
}

/* Returns the outline of a 2D body: the elements of its mesh, the whole cells of its lattice, or its
 * shapes. */
static const pg_outline *outline_of (const pg_problem *p, const pg_scene *scene, pg_outline *out)
{
    int stairs = p->lattice.dim && strcmp (pg_scene_text (scene, "cells"), "staircase") == 0;
    *out = (pg_outline) { .body = &p->body, .lattice = stairs ? &p->lattice : NULL };
    if (p->part.mesh.n) *out = (pg_outline) { .mesh = &p->part.mesh };
    return p->dim == 2 && (p->body.n || p->part.mesh.n) ? out : NULL;
}

pg_status pg_plot_scene (const plot_request *q)
{
    pg_status status = PG_OK;
    pg_scene *scene = NULL;
    pg_problem *p = NULL;
    double *value = NULL;
    char label[80], path[PLOT_PATH];
    int what;
    pg_picture_style style = q->style;
    pg_outline outline;
    if (q->list || q->sets || q->all || q->panels)
        PG_FAIL (PG_E_USAGE, "%s is a scene: it has no steps and no sets to draw", q->directory);
    PG_TRY (pg_scene_load (&scene, q->directory));
    PG_TRY (pg_problem_build (&p, scene, 1));
    PG_ALLOC (value, p->cloud.n);
    PG_TRY (choose (&what, q, p));
    find_values (p, what, value);
    write_label (what, label);
    style.outline = outline_of (p, scene, &outline);
    style.title = p->title, style.label = label, style.cracks = p->crack.given.n ? &p->crack.given : NULL;
    if (p->dim == 3 && !style.section && !style.view) style.view = PG_VIEW_ISO;
    name_picture (q, path, sizeof path);
    PG_TRY (pg_picture_body (path, p->part.mesh.n ? &p->part : NULL, &p->cloud, value, &style));
    puts (path);
done:
    pg_free (value);
    pg_problem_free (&p);
    pg_scene_free (&scene);
    return status;
}

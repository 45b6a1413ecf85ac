/* SPDX-License-Identifier: GPL-3.0-or-later
 * A mesh file as a picture: its blocks, its sets, or a field at its nodes. */
#include "plot.h"
#include "perigal/mesh_files.h"
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

/* A mesh file that is being drawn. */
typedef struct {
    pg_mesh mesh;
    size_t  nfield;
    pg_mesh_field *field;
    double  time;
    /* Values at the nodes (nnode), displacements in units of the mesh (nnode x dim). */
    double *value, *u;
    char    label[96];
} fem;

/* 1 for a regular file: a file is a mesh, a folder is a result of this program. */
int pg_plot_is_file (const char *path)
{
    struct stat about;
    return stat (path, &about) == 0 && S_ISREG (about.st_mode);
}

/* The field of that name, or NULL if the file has none. */
static const pg_mesh_field *find_field (const fem *f, const char *name)
{
    for (size_t k = 0; k < f->nfield; k++) if (strcmp (f->field[k].name, name) == 0) return &f->field[k];
    return NULL;
}

/* Finds the field of that name; PG_E_USAGE with all names, and the nearest one, if there is none. */
static pg_status need_field (const plot_request *q, const fem *f, const char *name, const pg_mesh_field **out)
{
    pg_status status = PG_OK;
    char names[600] = "";
    *out = find_field (f, name);
    if (*out) return PG_OK;
    for (size_t k = 0, at = 0; k < f->nfield && at < sizeof names; k++)
        at += (size_t) snprintf (names + at, sizeof names - at, "%s%s", k ? "|" : "", f->field[k].name);
    const char *near = pg_nearest_name (name, names);
    PG_FAIL (PG_E_USAGE, "%s has no field %s%s%s%s; it has %s", q->directory, name,
             near ? " (did you mean " : "", near ? near : "", near ? "?)" : "", names);
done:
    return status;
}

/* ---- values -------------------------------------------------------------------------------------------- */
/* Von Mises stress of a stress with components xx yy zz xy yz zx. */
static double mises (const double *s)
{
    double d = (s[0] - s[1]) * (s[0] - s[1]) + (s[1] - s[2]) * (s[1] - s[2]) + (s[2] - s[0]) * (s[2] - s[0]);
    return sqrt (0.5 * d + 3 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]));
}

/* Length of a vector or Frobenius norm of a tensor, whose shears (components 3 to 5) count
 * twice. */
static double size_of (const double *v, int m)
{
    double sum = 0;
    for (int c = 0; c < m; c++) sum += v[c] * v[c] * (m == 6 && c > 2 ? 2 : 1);
    return sqrt (sum);
}

/* The part of a field that is drawn: one component, the magnitude, or the von Mises stress. */
typedef struct { const char *names, *wanted; int norm, equivalent, component; } choice;

/* Chooses the part of a field with m values per node: a component by name, the magnitude, or the von Mises
 * stress of a tensor. */
static pg_status choose_part (choice *c, const plot_request *q, int m)
{
    pg_status status = PG_OK;
    int tensor = m == 6;
    c->names = tensor ? "xx|yy|zz|xy|yz|zx" : m == 3 ? "x|y|z" : m == 2 ? "x|y" : "";
    c->wanted = q->component ? q->component : tensor ? "xx" : "magnitude";
    c->norm = m > 1 && strcmp (c->wanted, "magnitude") == 0;
    c->equivalent = tensor && strcmp (c->wanted, "mises") == 0;
    c->component = m > 1 && !c->norm && !c->equivalent ? pg_plot_index (c->wanted, c->names) : 0;
    if (c->component < 0)
        PG_FAIL (PG_E_USAGE, "field %s has no component %s: one of %s%s, magnitude", q->field, c->wanted,
                 c->names, tensor ? "|mises" : "");
done:
    return status;
}

/* Computes the values to draw and their label, which stands between bars if the colours are logarithmic. */
static pg_status choose_value (const plot_request *q, fem *f)
{
    pg_status status = PG_OK;
    const pg_mesh_field *field;
    choice c = { 0 };
    PG_TRY (need_field (q, f, q->field, &field));
    int m = field->components;
    PG_TRY (choose_part (&c, q, m));
    PG_ALLOC (f->value, f->mesh.nnode);
    for (size_t i = 0; i < f->mesh.nnode; i++) {
        const double *v = field->value + i * (size_t) m;
        f->value[i] = c.norm ? size_of (v, m) : c.equivalent ? mises (v) : v[c.component];
    }
    const char *bar = q->style.log ? "|" : "";
    if (c.norm) snprintf (f->label, sizeof f->label, "|%.31s|", q->field);
    else if (m > 1) snprintf (f->label, sizeof f->label, "%s%.31s_{%.10s}%s", bar, q->field, c.wanted, bar);
    else snprintf (f->label, sizeof f->label, "%s%.31s%s", bar, q->field, bar);
done:
    return status;
}

/* Takes the displacements of the nodes in the dimension of the mesh; files of 2D results may have three
 * components. */
static pg_status choose_displacement (const plot_request *q, fem *f)
{
    pg_status status = PG_OK;
    const pg_mesh_field *field;
    size_t dim = (size_t) f->mesh.dim;
    PG_TRY (need_field (q, f, "displacement", &field));
    if ((size_t) field->components < dim)
        PG_FAIL (PG_E_FILE, "%s: displacement has %d components", q->directory, field->components);
    PG_ALLOC (f->u, f->mesh.nnode * dim);
    for (size_t i = 0; i < f->mesh.nnode; i++)
        for (size_t k = 0; k < dim; k++) f->u[i * dim + k] = field->value[i * (size_t) field->components + k];
done:
    return status;
}

/* ---- the picture --------------------------------------------------------------------------------------- */
/* Names the picture, beside the file: its name without the ending, and what is drawn: _sets,
 * _FIELD.COMPONENT, _VIEW. */
static void name_picture (const plot_request *q, char *path, size_t size)
{
    const char *dot = strrchr (q->directory, '.'), *slash = strrchr (q->directory, '/');
    size_t n = dot && (!slash || dot > slash + 1) ? (size_t) (dot - q->directory) : strlen (q->directory);
    if (q->out) snprintf (path, size, "%s", q->out);
    else
        snprintf (path, size, "%.*s%s%.40s%s%.40s%s%s.png", (int) n, q->directory,
                  q->sets    ? "_sets"
                  : q->field ? "_"
                             : "",
                  q->field && !q->sets ? q->field : "", q->component ? "." : "",
                  q->component ? q->component : "", q->style.view ? "_" : "", q->style.view ? q->look : "");
}

/* Draws the picture. Values with both signs get diverging colours, unless a range was given that is not
 * symmetric. */
static pg_status draw (const plot_request *q, const fem *f)
{
    pg_status status = PG_OK;
    pg_picture_style style = q->style;
    char path[PLOT_PATH], title[200];
    double low = 0, high = 0;
    const char *slash = strrchr (q->directory, '/');
    int used = snprintf (title, sizeof title, "%.100s", slash ? slash + 1 : q->directory);
    if (f->nfield) used += snprintf (title + used, sizeof title - (size_t) used, ", time %.4g", f->time);
    if (f->u)
        snprintf (title + used, sizeof title - (size_t) used, ", displacements \xc3\x97 %g", style.magnify);
    for (size_t i = 0; f->value && i < f->mesh.nnode; i++)
        low = fmin (low, f->value[i]), high = fmax (high, f->value[i]);
    style.diverging = q->ranged ? style.low == -style.high && style.high > 0 : low < 0 && high > 0;
    style.title = title, style.label = f->label, style.u = f->u, style.length = q->length,
    style.sets = q->sets;
    name_picture (q, path, sizeof path);
    PG_TRY (pg_picture_mesh (path, &f->mesh, f->value, &style));
    puts (path);
done:
    return status;
}

/* Draws a mesh file. Without --field it is read without results, which is faster and works for formats that
 * have none. */
pg_status pg_plot_mesh (const plot_request *q)
{
    pg_status status = PG_OK;
    fem f = { 0 };
    if (q->all || q->steps > 1 || q->limited)
        PG_FAIL (PG_E_USAGE, "--step all, --steps and --above are for result folders; %s is a file",
                 q->directory);
    if (q->field && q->sets) PG_FAIL (PG_E_USAGE, "--field and --sets exclude each other");
    if (q->component && !q->field) PG_FAIL (PG_E_USAGE, "--component needs --field");
    if (q->field || q->style.magnify != 0)
        PG_TRY (pg_mesh_result (&f.mesh, q->directory, q->step[0], &f.nfield, &f.field, &f.time));
    else PG_TRY (pg_mesh_read (&f.mesh, q->directory));
    if (q->field) PG_TRY (choose_value (q, &f));
    if (q->style.magnify != 0) PG_TRY (choose_displacement (q, &f));
    PG_TRY (draw (q, &f));
done:
    pg_free (f.value), pg_free (f.u);
    pg_mesh_fields_clear (f.nfield, &f.field);
    pg_mesh_clear (&f.mesh);
    return status;
}

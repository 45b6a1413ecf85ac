/* SPDX-License-Identifier: GPL-3.0-or-later
 * perigal plot DIR: one field of DIR/result.e, or with --curve two columns of DIR/history.csv, as PNG or SVG. */
#include "plot.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { EXIT_USAGE = 64, EXIT_FAILED = 70, PATH = 4096 };

typedef struct {
    const char *directory, *field, *component, *out, *x, *y;
    char  result[PATH], picture[PATH];
    int   step, section;
    double at, magnify;
} request;

typedef struct {
    pg_cloud cloud;
    pg_scene *scene;
    pg_cracks cracks;
    size_t   nstep;
    double  *time, *field, *value, *u;                 /* field n x m, value n, u n x dim                                */
    int      m;
} source;

static const char usage[] =
    "usage: perigal plot DIR [--field NAME] [--component NUMBER|x|xx|magnitude] [--step N] [--section AXIS=VALUE]\n"
    "                        [--magnify FACTOR] [--out FILE.png|FILE.svg]\n"
    "       perigal plot DIR --curve X Y [--out FILE]\n"
    "Draws a field of DIR/result.e (damage, last step) or two columns of DIR/history.csv.\n";

static int number_of (const char *text, double *value)
{
    char *end;
    *value = strtod (text, &end);
    return end != text && *end == 0 && isfinite (*value);
}

/* Place of a word in "a|b|c", -1 when it is not there. */
static int index_of (const char *word, const char *list)
{
    int k = 0;
    for (const char *s = list; *s; s += strcspn (s, "|"), s += *s == '|', k++)
        if (strlen (word) == strcspn (s, "|") && strncmp (s, word, strlen (word)) == 0) return k;
    return -1;
}

/* "z=0.005", "z=5 mm" */
static pg_status read_section (request *q, const char *text)
{
    pg_status status = PG_OK;
    const char *axis = text[0] ? strchr ("xyz", text[0]) : NULL;
    if (!axis || text[1] != '=') PG_FAIL (PG_E_USAGE, "--section %s: expected AXIS=VALUE, such as z=0.005", text);
    q->section = text[0] - 'x' + 1;
    if (!number_of (text + 2, &q->at)) PG_TRY (pg_unit_parse (&q->at, text + 2, "m"));
done:
    return status;
}

static pg_status read_option (request *q, const char *name, char **value, int left, int *used)
{
    static const char names[] = "--field|--component|--step|--section|--magnify|--out|--curve";
    pg_status status = PG_OK;
    double number;
    *used = 2;
    int curve = strcmp (name, "--curve") == 0;
    if (index_of (name, names) < 0) {
        const char *near = pg_nearest_name (name, names);
        PG_FAIL (PG_E_USAGE, "unknown option %s%s%s", name, near ? "; did you mean " : "", near ? near : "");
    }
    if (left < 1 + curve) PG_FAIL (PG_E_USAGE, "%s needs %s", name, curve ? "two column names" : "a value");
    if (curve) q->x = value[0], q->y = value[1], *used = 3;
    else if (strcmp (name, "--field") == 0) q->field = value[0];
    else if (strcmp (name, "--component") == 0) q->component = value[0];
    else if (strcmp (name, "--out") == 0) q->out = value[0];
    else if (strcmp (name, "--section") == 0) PG_TRY (read_section (q, value[0]));
    else if (!number_of (value[0], &number)) PG_FAIL (PG_E_USAGE, "%s %s: not a number", name, value[0]);
    else if (strcmp (name, "--magnify") == 0) q->magnify = number;
    else if (strcmp (name, "--step") == 0) {
        if (number != floor (number) || number < -1 || number > 1e9) PG_FAIL (PG_E_USAGE, "--step %s: expected 0, 1, 2 ...", value[0]);
        q->step = (int) number;
    }
done:
    return status;
}

static pg_status read_arguments (request *q, int argc, char **argv)
{
    pg_status status = PG_OK;
    *q = (request) { .field = "damage", .step = -1 };
    for (int k = 1, used; k < argc; k += used) {
        used = 1;
        if (argv[k][0] == '-' && argv[k][1]) PG_TRY (read_option (q, argv[k], argv + k + 1, argc - k - 1, &used));
        else if (q->directory) PG_FAIL (PG_E_USAGE, "one directory at a time: %s, %s", q->directory, argv[k]);
        else q->directory = argv[k];
    }
    if (!q->directory) PG_FAIL (PG_E_USAGE, "no directory given");
    if (strlen (q->directory) > PATH / 2) PG_FAIL (PG_E_USAGE, "the path is too long");
    snprintf (q->result, sizeof q->result, "%s/result.e", q->directory);
done:
    return status;
}

/* DIR/NAME.png with what is no letter, digit, - or _ turned into _ */
static void name_picture (request *q, const char *first, const char *second)
{
    char name[128];
    if (q->out) {
        snprintf (q->picture, sizeof q->picture, "%s", q->out);
        return;
    }
    snprintf (name, sizeof name, "%.60s%s%.60s", first, second ? "-" : "", second ? second : "");
    for (char *s = name; *s; s++)
        if (!strchr ("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_", *s)) *s = '_';
    snprintf (q->picture, sizeof q->picture, "%.2100s/%s.png", q->directory, name);
}

/* "x|y|z", "xx|yy|xy" ...: names of the components of m values a point. */
static const char *component_names (int dim, int m)
{
    static const char *const axes[] = { "", "x", "x|y", "x|y|z" };
    if (m > 1 && m == dim) return axes[dim];
    if (dim == 2 && m == 3) return "xx|yy|xy";
    return dim == 3 && m == 6 ? "xx|yy|zz|xy|yz|zx" : "";
}

/* Length of a vector or norm of a symmetric tensor (engineering strains count half). */
static double magnitude (const double *v, int dim, int m, double shear)
{
    double sum = 0;
    int tensor = m != dim && m == dim * (dim + 1) / 2;
    for (int c = 0; c < m; c++) sum += v[c] * v[c] * (tensor && c >= dim ? 2 * shear * shear : 1);
    return sqrt (sum);
}

/* Fills value from field; label gets the component. */
static pg_status choose_component (const request *q, source *s, char *label, size_t size)
{
    pg_status status = PG_OK;
    int dim = s->cloud.dim, k = 0;
    const char *names = component_names (dim, s->m), *wanted = q->component;
    double number;
    if (!wanted && s->m > 1) wanted = s->m == dim || !names[0] ? "magnitude" : "xx";
    int norm = wanted && strcmp (wanted, "magnitude") == 0 && s->m > 1;
    if (wanted && !norm) {
        k = index_of (wanted, names);
        if (k < 0 && number_of (wanted, &number) && number == floor (number) && number >= 0 && number < s->m) k = (int) number;
        if (k < 0 && s->m == 1) PG_FAIL (PG_E_USAGE, "field %s has one component", q->field);
        if (k < 0) PG_FAIL (PG_E_USAGE, "field %s has no component %s: 0 to %d%s%s or magnitude", q->field, wanted, s->m - 1,
                            names[0] ? ", " : "", names);
    }
    PG_ALLOC (s->value, s->cloud.n);
    double shear = strstr (q->field, "strain") ? 0.5 : 1;
    for (size_t i = 0; i < s->cloud.n; i++) {
        const double *v = s->field + i * (size_t) s->m;
        s->value[i] = norm ? magnitude (v, dim, s->m, shear) : v[k];
    }
    if (norm) snprintf (label, size, "|%.31s|", q->field);
    else if (s->m > 1 && names[0]) {
        for (; k > 0; k--) names += strcspn (names, "|") + 1;
        snprintf (label, size, "%.31s_{%.*s}", q->field, (int) strcspn (names, "|"), names);
    } else snprintf (label, size, s->m > 1 ? "%.31s %d" : "%.31s", q->field, k);
done:
    return status;
}

/* The cracks of the scene the run kept a copy of; a picture without them when there is none. */
static void read_cracks (const request *q, source *s)
{
    char path[PATH];
    snprintf (path, sizeof path, "%.2100s/scene.yaml", q->directory);
    if (access (path, R_OK) != 0 || pg_scene_load (&s->scene, path) != PG_OK) return;
    if (pg_cracks_read (&s->cracks, s->scene) != PG_OK) s->cracks = (pg_cracks) { 0 };
}

static pg_status read_displacement (const request *q, source *s)
{
    pg_status status = PG_OK;
    size_t n;
    int m;
    if (q->magnify == 0) goto done;
    PG_TRY (pg_exodus_read (q->result, "displacement", q->step, &n, &m, &s->u));
    if (m != s->cloud.dim) PG_FAIL (PG_E_FILE, "%s: displacement has %d components", q->result, m);
done:
    return status;
}

static pg_status draw (const request *q, source *s, const char *name, const char *unit)
{
    char title[192], label[128];
    int step = q->step < 0 ? (int) s->nstep - 1 : q->step, negative = 0, positive = 0;
    for (size_t i = 0; i < s->cloud.n; i++) negative |= s->value[i] < 0, positive |= s->value[i] > 0;
    snprintf (label, sizeof label, "%s%s%s%s", name, unit[0] ? " (" : "", unit, unit[0] ? ")" : "");
    int used = snprintf (title, sizeof title, "%s, step %d, time %.6g", name, step, s->time[step]);
    if (q->magnify != 0 && used > 0) snprintf (title + used, sizeof title - (size_t) used, ", displacements x %g", q->magnify);
    pg_picture_style style = { .title = title, .label = label, .diverging = negative && positive, .magnify = q->magnify, .u = s->u,
        .cracks = s->cracks.n ? &s->cracks : NULL, .section = q->section, .at = q->at };
    if (strcmp (q->field, "damage") == 0) style.low = 0, style.high = 1;
    return pg_picture_field (q->picture, &s->cloud, s->value, &style);
}

static pg_status plot_field (request *q)
{
    pg_status status = PG_OK;
    source s = { 0 };
    char name[64], unit[16];
    size_t n;
    PG_TRY (pg_exodus_points (q->result, &s.cloud, &s.nstep, &s.time));
    PG_TRY (pg_exodus_read (q->result, q->field, q->step, &n, &s.m, &s.field));
    PG_TRY (pg_exodus_unit (q->result, q->field, unit));
    if (q->section && s.cloud.dim != 3) PG_FAIL (PG_E_USAGE, "--section is for 3D results; %s is %dD", q->result, s.cloud.dim);
    PG_TRY (choose_component (q, &s, name, sizeof name));
    PG_TRY (read_displacement (q, &s));
    read_cracks (q, &s);
    name_picture (q, q->field, q->component);
    PG_TRY (draw (q, &s, name, unit));
done:
    pg_cracks_clear (&s.cracks);
    pg_scene_free (&s.scene);
    pg_free (s.u);
    pg_free (s.value);
    pg_free (s.field);
    pg_free (s.time);
    pg_cloud_clear (&s.cloud);
    return status;
}

int pg_cli_plot (int argc, char **argv)
{
    pg_status status = PG_OK;
    request q;
    for (int k = 1; k < argc; k++)
        if (strcmp (argv[k], "--help") == 0 || strcmp (argv[k], "-h") == 0) {
            fputs (usage, stdout);
            return 0;
        }
    PG_TRY (read_arguments (&q, argc, argv));
    if (q.x) {
        name_picture (&q, q.y, q.x);
        PG_TRY (pg_plot_curve (q.picture, q.directory, q.x, q.y));
    } else PG_TRY (plot_field (&q));
    puts (q.picture);
done:
    if (status == PG_OK) return 0;
    fprintf (stderr, "perigal plot: %s\n", pg_last_error ());
    return status == PG_E_USAGE ? EXIT_USAGE : EXIT_FAILED;
}

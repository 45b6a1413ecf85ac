/* SPDX-License-Identifier: GPL-3.0-or-later
 * perigal plot DIR|FILE: a field of DIR/result.e, a scene, a mesh or a finite element result, or with
 * --curve columns of DIR/history.csv, as PNG or SVG. Here is the command line; drawing is in
 * the files plot_*.c. Every option is one function and one row of the table `options`.
 *
 * Drawing prints the names of the files that were written, one per line, and nothing else. */
#include "plot.h"
#include "perigal/study.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* The whole help of the command; the summary in usage.c is shorter. */
static const char usage[] =
    "usage: perigal plot DIR [--field NAME[.x|.xx|.magnitude]] [--component NUMBER|x|xx|magnitude] [--step "
    "N|all | --steps N,N,...]\n"
    "                        [--view front|back|left|right|top|bottom|iso|crack | --section 'z = 5 mm']\n"
    "                        [--direction X,Y,Z] [--above VALUE] [--range LOW,HIGH] [--magnify FACTOR]\n"
    "                        [--columns N] [--out FILE.png|FILE.svg]\n"
    "       perigal plot DIR --movie [--rate N] [--steps N,N,...] [options as above]\n"
    "       perigal plot DIR --list\n"
    "       perigal plot FILE [--sets | --field NAME ...] [--unit mm] [options as above]\n"
    "       perigal plot SCENE.yaml [--field material|spacing|youngs_modulus|...] [--out FILE]\n"
    "       perigal plot DIR [DIR...] --curve X Y [--labels A,B,...] [--negate [x|y|xy]] [--out FILE]\n"
    "Draws a field of DIR/result.e (damage, last step) or two columns of DIR/history.csv,\n"
    "or a mesh (.msh, .inp) or result of finite elements (.frd, .e): blocks, --sets or a field at its "
    "nodes.\n"
    "Of a scene that has not run: its body (alpha shapes, holes), cracks, materials, and what is an "
    "expression of place.\n"
    "  --field       such as damage, stress.yy (or stress --component yy): DIR/stress.yy.png\n"
    "  --list        the steps that DIR/result.e holds: their numbers, loads or times\n"
    "  --step all    one picture a step;  --steps 2,5,8: one picture with a panel a step, --columns of them "
    "in a row;\n"
    "                -1 is the last step, -2 the one before\n"
    "  --view        3D: the side of that name (front is the face of largest z), or obliquely: iso; crack: "
    "points of\n"
    "                damage 0.35 and more\n"
    "  --section     3D: AXIS = PLACE, or NORMAL = DISTANCE along it: '1, 0, 1 = 5 mm'\n"
    "  --direction   of view iso and crack: from the body to the eye\n"
    "  --movie       DIR/FIELD_movie.png: all steps, or those of --steps, as an animated PNG: one range of "
    "colours,\n"
    "                one frame; browsers show it, ffmpeg makes other movies of it\n"
    "  --rate        pictures of a movie in a second, default 10\n"
    "  --log         colours by the decades of |value|\n"
    "  --unit        meshes: of the lengths in the file;  --sets: sets of sides and nodes in colours\n"
    "  --above       3D views: only points whose value is at least this, the body grey behind them\n";

/* Reads a finite number; returns 0 for anything else. */
static int number_of (const char *text, double *value)
{
    char *end;
    *value = strtod (text, &end);
    return end != text && *end == 0 && isfinite (*value);
}

/* Index of a word in "a|b|c"; -1 if it is not there. */
static int place_of (const char *word, const char *names)
{
    int k = 0;
    for (const char *s = names; *s; s += strcspn (s, "|"), s += *s == '|', k++)
        if (strlen (word) == strcspn (s, "|") && strncmp (s, word, strlen (word)) == 0) return k;
    return -1;
}

/* ---- options ---------------------------------------------------------------------------------------- */
/* Reads a number of at least `low`. */
static pg_status read_number (const char *name, const char *text, double low, double *out)
{
    pg_status status = PG_OK;
    if (!number_of (text, out)) PG_FAIL (PG_E_USAGE, "%s %s: not a number", name, text);
    if (*out < low) PG_FAIL (PG_E_USAGE, "%s %s: must be %g or more", name, text, low);
done:
    return status;
}

/* Reads up to `most` steps "3,5,8"; negative ones count from the end. Whether they exist is known only when
 * the result is open (count_steps). */
static pg_status read_steps (plot_request *q, const char *name, const char *text, int most)
{
    pg_status status = PG_OK;
    const char *s = text;
    q->steps = 0;
    for (;; s++) {
        char *end;
        long k = strtol (s, &end, 10);
        if (end == s || k < -1000000000 || k > 1000000000 || (*end && *end != ','))
            PG_FAIL (PG_E_USAGE, "%s %s: expected 0, 1, 2 ..., or from the end -1, -2 ...", name, text);
        if (q->steps == most) PG_FAIL (PG_E_USAGE, "%s %s: at most %d", name, text, most);
        q->step[q->steps++] = (int) k;
        s = end;
        if (!*s) break;
    }
done:
    return status;
}

/* Reads --step: N or "all". */
static pg_status read_step (plot_request *q, const char *text)
{
    q->all = strcmp (text, "all") == 0;
    return q->all ? PG_OK : read_steps (q, "--step", text, 1);
}

/* --steps N,N,...: several steps in one picture. */
static pg_status read_panels (plot_request *q, const char *text)
{
    q->panels = 1;
    return read_steps (q, "--steps", text, PLOT_STEPS);
}

/* --view SIDE, iso or crack; a view and a section exclude each other. The list of names begins
 * with "section", which is no view. */
static pg_status read_view (plot_request *q, const char *text)
{
    pg_status status = PG_OK;
    const char *views = strchr (pg_view_names, '|') + 1, *near = pg_nearest_name (text, views);
    if (q->style.section) PG_FAIL (PG_E_USAGE, "--view and --section exclude each other");
    int view = place_of (text, views);
    if (view < 0)
        PG_FAIL (PG_E_USAGE, "--view %s: %s%s%sone of %s", text, near ? "did you mean " : "",
                 near ? near : "", near ? "? " : "", views);
    q->style.view = view + 1, q->look = text;
done:
    return status;
}

/* --section 'z = 5 mm' or a normal and its distance, as in output.views. */
static pg_status read_section (plot_request *q, const char *text)
{
    pg_status status = PG_OK;
    if (q->style.view) PG_FAIL (PG_E_USAGE, "--view and --section exclude each other");
    if (pg_picture_section (&q->style, text) != PG_OK)
        PG_FAIL (
            PG_E_USAGE,
            "--section %s: expected AXIS=VALUE, such as z=0.005 or 'z = 5 mm', or a normal: '1, 0, 1 = 5 mm'",
            text);
    q->look = text;
done:
    return status;
}

/* --direction X,Y,Z, from the body to the eye. */
static pg_status read_direction (plot_request *q, const char *text)
{
    pg_status status = PG_OK;
    if (pg_picture_direction (q->style.direction, text) != PG_OK)
        PG_FAIL (PG_E_USAGE, "--direction %s: expected X,Y,Z, such as 1,0.5,2", text);
done:
    return status;
}

/* --above VALUE, in the unit of the field. */
static pg_status read_above (plot_request *q, const char *text)
{
    q->limited = 1;
    return read_number ("--above", text, -INFINITY, &q->style.above);
}

/* --range LOW,HIGH: the ends of the colour bar, in the unit of the field; values beyond it get
 * the colours of the ends, and the bar ends in arrows. */
static pg_status read_range (plot_request *q, const char *text)
{
    pg_status status = PG_OK;
    char *end, *last;
    double low = strtod (text, &end), high = *end == ',' ? strtod (end + 1, &last) : 0;
    if (end == text || *end != ',' || last == end + 1 || *last || !(low < high) || !isfinite (high - low))
        PG_FAIL (PG_E_USAGE, "--range %s: expected LOW,HIGH", text);
    q->style.low = low, q->style.high = high, q->ranged = 1;
done:
    return status;
}

/* --magnify FACTOR of the displacements; 0, the default, draws the undeformed body, and
 * negative factors are allowed. */
static pg_status read_magnify (plot_request *q, const char *text)
{
    return read_number ("--magnify", text, -INFINITY, &q->style.magnify);
}

/* --rate N: pictures of a movie in a second. */
static pg_status read_rate (plot_request *q, const char *text)
{
    pg_status status = PG_OK;
    PG_TRY (read_number ("--rate", text, 0.02, &q->rate));
    if (q->rate > 1000) PG_FAIL (PG_E_USAGE, "--rate %s: must be 1000 or less", text);
done:
    return status;
}

/* --columns N: panels in a row, 1 to the largest number of steps. */
static pg_status read_columns (plot_request *q, const char *text)
{
    pg_status status = PG_OK;
    double n;
    PG_TRY (read_number ("--columns", text, 1, &n));
    if (n != floor (n) || n > PLOT_STEPS)
        PG_FAIL (PG_E_USAGE, "--columns %s: expected 1 to %d", text, PLOT_STEPS);
    q->columns = (int) n;
done:
    return status;
}

/* --unit mm: of the lengths in a mesh file, which itself rarely says; axes have no unit
 * without it. */
static pg_status read_unit (plot_request *q, const char *text)
{
    pg_status status = PG_OK;
    char one[64];
    snprintf (one, sizeof one, "1 %.40s", text);
    if (pg_unit_parse (&q->length, one, "m") != PG_OK || !(q->length > 0))
        PG_FAIL (PG_E_USAGE, "--unit %s: expected a unit of length, such as mm", text);
done:
    return status;
}

static pg_status read_sets (plot_request *q, const char *text) { (void) text, q->sets = 1; return PG_OK; }
static pg_status read_list (plot_request *q, const char *text) { (void) text, q->list = 1; return PG_OK; }
static pg_status read_movie (plot_request *q, const char *text)
{
    (void) text, q->movie = 1;
    return PG_OK;
}

static pg_status read_log (plot_request *q, const char *text) { (void) text, q->style.log = 1; return PG_OK; }
/* "stress", or as in output.pictures "stress.yy": the part behind the last dot counts only if
 * it is the name of a component. */
static pg_status read_field (plot_request *q, const char *text)
{
    const char *dot = strrchr (text, '.');
    q->field = text;
    if (!dot || dot == text || place_of (dot + 1, "x|y|z|xx|yy|zz|xy|yz|zx|magnitude|mises") < 0)
        return PG_OK;
    snprintf (q->name, sizeof q->name, "%.*s", (int) (dot - text), text);
    q->field = q->name, q->part = dot + 1;
    return PG_OK;
}

static pg_status read_component (plot_request *q, const char *text) { q->component = text; return PG_OK; }
static pg_status read_out (plot_request *q, const char *text) { q->out = text; return PG_OK; }

/* Reads an option with its text. */
typedef pg_status (*reader) (plot_request *q, const char *text);
/* These options take no value; their readers ignore it. */
static const reader switches[] = { read_sets, read_log, read_list, read_movie };
/* The options and their readers. */
static const struct { const char *name; reader read; } options[] = {
    { "--field", read_field },     { "--component", read_component }, { "--step", read_step },
    { "--steps", read_panels },    { "--columns", read_columns },     { "--view", read_view },
    { "--section", read_section }, { "--direction", read_direction }, { "--above", read_above },
    { "--range", read_range },     { "--magnify", read_magnify },     { "--out", read_out },
    { "--unit", read_unit },       { "--sets", read_sets },           { "--log", read_log },
    { "--list", read_list },       { "--movie", read_movie },         { "--rate", read_rate },
};

/* Reads one option; *used = 1 if it took the value. The nearest name is looked for among all
 * options, those of --curve included. */
static pg_status read_option (plot_request *q, const char *name, const char *value, int *used)
{
    pg_status status = PG_OK;
    char names[256] = "--curve";
    for (size_t k = 0; k < sizeof options / sizeof *options; k++) {
        size_t n = strlen (names);
        snprintf (names + n, sizeof names - n, "|%s", options[k].name);
        if (strcmp (name, options[k].name) != 0) continue;
        *used = 1;
        for (size_t i = 0; i < sizeof switches / sizeof *switches; i++)
            *used &= options[k].read != switches[i];
        if (!value && *used) PG_FAIL (PG_E_USAGE, "%s needs a value", name);
        return options[k].read (q, value);
    }
    const char *near = pg_nearest_name (name, names);
    PG_FAIL (PG_E_USAGE, "unknown option %s%s%s", name, near ? "; did you mean " : "", near ? near : "");
done:
    return status;
}

/* DIR/result.e means DIR. The path is shortened in place. */
static void cut_result (char *path)
{
    size_t n = strlen (path);
    if (n > 9 && strcmp (path + n - 9, "/result.e") == 0 && pg_plot_is_file (path)) path[n - 9] = 0;
}

/* Checks that the other options go with --movie. */
static pg_status check_movie (const plot_request *q)
{
    pg_status status = PG_OK;
    if (q->movie && q->columns) PG_FAIL (PG_E_USAGE, "--movie and --columns exclude each other");
    if (q->rate > 0 && !q->movie) PG_FAIL (PG_E_USAGE, "--rate is for movies: --movie --rate %g", q->rate);
    if (q->movie && !q->all && !q->panels && q->step[0] != -1)
        PG_FAIL (PG_E_USAGE, "--movie takes all steps, or those of --steps N,N,...");
    if (q->movie && pg_plot_is_file (q->directory))
        PG_FAIL (PG_E_USAGE, "--movie is for result folders; %s is a file", q->directory);
done:
    return status;
}

/* Reads the command line: one folder or file, options in any order. Checks what excludes each
 * other and that the folder exists. */
static pg_status read_arguments (plot_request *q, int argc, char **argv)
{
    pg_status status = PG_OK;
    *q = (plot_request) { .step = { -1 }, .steps = 1 };
    for (int k = 1, used = 0; k < argc; k++) {
        if (argv[k][0] == '-' && argv[k][1]) {
            PG_TRY (read_option (q, argv[k], k + 1 < argc ? argv[k + 1] : NULL, &used));
            k += used;
        } else if (q->directory)
            PG_FAIL (PG_E_USAGE, "one result folder at a time: %s, %s", q->directory, argv[k]);
        else q->directory = argv[k];
    }
    if (!q->directory) PG_FAIL (PG_E_USAGE, "no result folder given");
    if (strlen (q->directory) > PLOT_PATH / 2) PG_FAIL (PG_E_USAGE, "the path is too long");
    if (q->part && q->component && strcmp (q->part, q->component) != 0)
        PG_FAIL (PG_E_USAGE, "--field %s.%s and --component %s: which part?", q->field, q->part,
                 q->component);
    if (q->part) q->component = q->part;
    if (q->all && q->panels) PG_FAIL (PG_E_USAGE, "--step all and --steps exclude each other");
    cut_result (q->directory);
    PG_TRY (check_movie (q));
    if (access (q->directory, F_OK) != 0) PG_FAIL (PG_E_FILE, "%s: No such file or folder", q->directory);
    snprintf (q->result, sizeof q->result, "%s/result.e", q->directory);
done:
    return status;
}

/* --curve is a command of its own with other options. A file is drawn as a mesh, a folder as a
 * result; damage is the usual field. */
int pg_cli_plot (int argc, char **argv)
{
    pg_status status = PG_OK;
    plot_request q;
    for (int k = 1; k < argc; k++)
        if (strcmp (argv[k], "--curve") == 0) return pg_cli_plot_curve (argc, argv);
    for (int k = 1; k < argc; k++)
        if (strcmp (argv[k], "--help") == 0 || strcmp (argv[k], "-h") == 0) {
            fputs (usage, stdout);
            return 0;
        }
    PG_TRY (read_arguments (&q, argc, argv));
    if (pg_plot_is_scene (q.directory)) PG_TRY (pg_plot_scene (&q));
    else if (pg_plot_is_file (q.directory)) PG_TRY (pg_plot_mesh (&q));
    else {
        if (q.sets || q.length > 0)
            PG_FAIL (PG_E_USAGE, "--sets and --unit are for mesh files; %s is none", q.directory);
        if (!q.field) q.field = "damage";
        PG_TRY (pg_writer_readable (q.directory));
        PG_TRY (pg_exodus_join (q.directory, 0));          /* parts of ranks whose run has not ended */
        PG_TRY (q.list ? pg_plot_list (&q) : pg_plot_field (&q));
    }
done:
    if (status == PG_OK) return 0;
    fprintf (stderr, "perigal plot: %s\n", pg_last_error ());
    return status == PG_E_USAGE ? PG_EXIT_USAGE : PG_EXIT_FAILED;
}

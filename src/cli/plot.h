/* SPDX-License-Identifier: GPL-3.0-or-later
 * perigal plot: pictures from the files of a run. */
#ifndef PERIGAL_CLI_PLOT_H
#define PERIGAL_CLI_PLOT_H
#include "perigal/output.h"
#include "perigal/picture.h"

int pg_cli_plot (int argc, char **argv);               /* argv[0] = "plot"; returns the exit code */

/* What the command line of a picture of a field asks for. */
enum { PLOT_PATH = 4096, PLOT_STEPS = 64 };
typedef struct {
    char *directory;                                   /* or a mesh file */
    /* part: yy of "stress.yy"; look: of the view or the section, for names */
    const char *field, *part, *component, *out, *look;
    char   name[128];                                  /* "stress" of "stress.yy" */
    double length;                                     /* meshes: m in a unit of the file, 0: not given */
    char   result[PLOT_PATH];
    int    step[PLOT_STEPS], steps;                    /* -1: the last one */
    int    all, panels, columns;                       /* all: every step; panels: in one picture */
    int    limited, ranged;                            /* --above, --range given */
    int    sets, list;
    pg_picture_style style;
} plot_request;
/* plot_field.c: draws and prints the names of the files. */
pg_status pg_plot_field (plot_request *q);
/* The steps of the result, a line each: number and load or time. */
pg_status pg_plot_list (const plot_request *q);

/* plot_stage.c: event stepping: events so far and load factor of that step of the run, from
 * FOLDER/history.csv; 0: not known. */
int pg_plot_event (const char *folder, double step, long *events, double *factor);

/* plot_mesh.c: the same for a mesh file. */
pg_status pg_plot_mesh (const plot_request *q);
int pg_plot_is_file (const char *path);
/* "z" in "x|y|z" -> 2, -1: not there (plot_field.c). */
int pg_plot_index (const char *word, const char *list);

/* plot_curve.c: the same with --curve: columns of the history.csv of one or several runs as a chart. */
int pg_cli_plot_curve (int argc, char **argv);
#endif

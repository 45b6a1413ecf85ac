/* SPDX-License-Identifier: GPL-3.0-or-later
 * perigal plot: pictures from the files of a run, without running anything. */
#ifndef PERIGAL_CLI_PLOT_H
#define PERIGAL_CLI_PLOT_H
#include "perigal/output.h"
#include "perigal/picture.h"

/* Runs the command; argv[0] is "plot"; returns the exit code. */
int pg_cli_plot (int argc, char **argv);

/* Longest path; most steps of one picture. */
enum { PLOT_PATH = 4096, PLOT_STEPS = 64 };
/* What the command line of a picture of a field asks for. */
typedef struct {
    /* Result folder, or a mesh file. */
    char *directory;
    /* field: its name without the component; part: yy of "stress.yy"; component: of --component or of the
     * field; out: file to write; look: the view or the section in words, for names of files. */
    const char *field, *part, *component, *out, *look;
    /* "stress" of "stress.yy". */
    char   name[128];
    /* Length unit of a mesh file, m; 0: not given. */
    double length;
    char   result[PLOT_PATH];
    /* Steps to draw; -1 is the last one, until count_steps has resolved it. */
    int    step[PLOT_STEPS], steps;
    /* 1: every step; 1: several steps in one picture; its columns; 1: a movie of the steps. */
    int    all, panels, columns, movie;
    /* Pictures of the movie in a second. */
    double rate;
    /* 1: --above, --range were given. */
    int    limited, ranged;
    /* 1: draw sets of a mesh; 1: list the steps. */
    int    sets, list;
    /* View, section, range, magnification and the like. */
    pg_picture_style style;
} plot_request;
/* Draws fields of a result and prints the names of the files (plot_field.c). */
pg_status pg_plot_field (plot_request *q);
/* Prints a line for each step of the result: its number and its load or time. */
pg_status pg_plot_list (const plot_request *q);

/* Finds for a step of event stepping the number of events so far and the load factor, from
 * FOLDER/history.csv; returns 0 if that is not known (plot_stage.c). */
int pg_plot_event (const char *folder, double step, long *events, double *factor);

/* Draws a mesh file (plot_mesh.c). */
pg_status pg_plot_mesh (const plot_request *q);
/* Draws a scene that has not run (plot_scene.c); the second function is 1 if a file is a scene, by its
 * name. */
pg_status pg_plot_scene (const plot_request *q);
int pg_plot_is_scene (const char *path);
/* 1 for a regular file. */
int pg_plot_is_file (const char *path);
/* Index of a word in "a|b|c", -1 if it is not there (plot_field.c). */
int pg_plot_index (const char *word, const char *list);

/* plot --curve: columns of the history.csv of one or several runs as a chart (plot_curve.c). */
int pg_cli_plot_curve (int argc, char **argv);
#endif

/* SPDX-License-Identifier: GPL-3.0-or-later
 * perigal plot: pictures from the files of a run. */
#ifndef PERIGAL_CLI_PLOT_H
#define PERIGAL_CLI_PLOT_H
#include "perigal/output.h"

int pg_cli_plot (int argc, char **argv);               /* argv[0] = "plot"; returns the exit code                        */

/* plot_curve.c: columns x and y (names of the header, with or without " [unit]") of DIR/history.csv as a chart in `path`. */
pg_status pg_plot_curve (const char *path, const char *directory, const char *x, const char *y);
#endif

/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: random networks of cracks: the request in the input file (crack_random_read.c) and the placing of
 * cracks (crack_random.c). */
#ifndef PERIGAL_CLOUD_CRACK_RANDOM_H
#define PERIGAL_CLOUD_CRACK_RANDOM_H
#include "crack.h"
#include "geometry/cloud/search/random.h"

/* Distributions of a number. */
enum { CRACK_FIXED, CRACK_UNIFORM, CRACK_NORMAL, CRACK_LOGNORMAL, CRACK_EXPONENTIAL, CRACK_POWER_LAW,
       CRACK_VON_MISES, CRACK_FISHER };
/* A distribution: mean and standard deviation, or exponent, or concentration, by kind; values beyond low and
 * high are drawn again. */
typedef struct { int kind; double mean, deviation, low, high, exponent, concentration; } crack_distribution;

/* Shapes of cracks in 3D. */
enum { CRACK_DISC, CRACK_RECTANGLE, CRACK_ELLIPSE };

/* The request of the input file for one random network. */
typedef struct {
    uint32_t seed;
    /* Number of cracks; or fraction of the body that their slots take; or intensity: their length (3D: area)
     * per area (volume) of the body, 1/m: cracks are placed until this is reached; 0: not given. */
    long   count;
    double fraction, intensity;
    crack_distribution length, angle;
    /* In 3D: mean direction of the normals, a unit vector. */
    double normal[3];
    /* Positions of the middles: uniform in the body, or in the box low .. high; or (gathered 1) normally
     * distributed about `mean` with a standard deviation for each axis, m. */
    int    gathered;
    double mean[3], deviation[3], low[3], high[3];
    /* In 3D: the shape, and its breadth over its length. */
    int    shape;
    double aspect;
    /* Least distance from other cracks (negative: they may cross), and of whole cracks from the surface,
     * m. */
    double distance, margin;
    /* 1: cracks lie in the body entirely; 0: their middles do. */
    int    whole;
    /* Width of the slots, m; 0: sharp. */
    double width;
} crack_request;
/* Largest number of cracks of all networks of an input file together. */
enum { CRACK_MOST = 20000 };
pg_status crack_request_read (crack_request *out, const crack_list *list);
/* Draws a number from the distribution; for an angle of von Mises' distribution its direction is drawn
 * instead. */
double    crack_draw (const crack_distribution *d, random_source *r);

/* Balls sorted into the cells of a grid, so that those near a position are found without testing all. A ball
 * is listed in every cell that its box meets; what lies outside of the grid belongs to the outermost
 * cells. */
typedef struct {
    int     dim, cells[3];
    double  low[3], size[3];
    /* Numbers of the balls of each cell. */
    struct crack_cell { size_t n, cap; unsigned *ball; } *cell;
} crack_grid;
pg_status crack_grid_create (crack_grid *g, int dim, const double *low, const double *high);
void      crack_grid_clear  (crack_grid *g);
/* First and last cell by axis that the ball of radius r about x meets. */
void      crack_grid_range  (const crack_grid *g, const double *x, double r, int first[3], int last[3]);
const struct crack_cell *crack_grid_cell (const crack_grid *g, const int *at);
pg_status crack_grid_add    (crack_grid *g, unsigned ball, const double *x, double r);
#endif

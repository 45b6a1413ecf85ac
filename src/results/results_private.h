/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: the open result folder. */
#ifndef PG_RESULT_PRIVATE_H
#define PG_RESULT_PRIVATE_H
#include "perigal/picture.h"
#include "perigal/results.h"

enum { MOST_FIELDS = 16, MOST_PICTURES = 32 };
/* How far the files are, and what they depend on, at the end of a step or in its middle. */
typedef struct {
    long     history, events;                          /* rows */
    long     steps, bytes;                             /* of result.e */
    long     next_broken, points, last_written;
    double   stamp, time;                              /* of the last step; of the last fields in result.e */
} result_marks;
typedef struct {
    char name[32], field[32];
    const char *unit;
    const pg_set *set;
    int component;
} result_average;
/* along: of every point from `from`, m; 0: does not count (n). length: of the crack at each row, m; 0: no
 * point is damaged so far. */
typedef struct {
    char name[32];
    double from[3], direction[3], damage, *along, *length;
    size_t capacity;
} result_tip;
/* Rows: first with a length, first and last that grew, fastest; mean speed between start and stop, largest,
 * m/s (0 unless dynamic). */
typedef struct { double mean; size_t first, start, stop, fastest; double largest; int moved; } result_tip_run;
/* A picture: NAME.png of field. limited: only points of the field above style.above; by_damage: of damage. */
typedef struct {
    char name[64], field[64], look[64];
    pg_picture_style style;
    int limited, by_damage;
} result_view;
/* What the curve comes to (pg_result_curve_read). found: 0: there is no curve. row: of the largest
 * |force|. */
typedef struct {
    int found;
    size_t row;
    double force, displacement, step, time, factor, initial, secant;
} result_peak;
/* What broken bonds say of new crack faces (pg_result_crack_measure). m2; m (2D), else NAN; J/m2 or NAN. */
typedef struct { int found; double area, length, dissipated; } result_crack;
struct pg_result {
    char     folder[3072];
    pg_named_file *named;  size_t nnamed;              /* files of the scene */
    int      lock;                                     /* 0: none */
    const pg_problem *problem;
    pg_solver *solver;
    char     hash[80], scene[3072];
    pg_exodus *file;
    pg_table  *history, *events;
    size_t    nfield, npicture, nwritten, ncolumn;
    pg_field_view field[MOST_FIELDS];
    double   *value[MOST_FIELDS];
    result_view picture[MOST_PICTURES];
    char      written[MOST_PICTURES + 3][4096];
    /* pictures at every written stage; time instead of load factor; cells: staircase */
    int       stages, dynamic, stairs;
    double    magnify, broken_share;
    long      every, next_broken;
    double   *row, *u;
    result_average *average;  size_t naverage;
    result_tip *tip;  size_t ntip, tips, tip_capacity;         /* tips: rows */
    double   *tip_time;                                /* s, or load factor (tips) */
    long      tip_broken;  /* bonds at the last row; -1: lengths are not those of it */
    long      exodus_steps;
    int       last_written;                            /* the state of the last step is in result.e */
    /* load-displacement curve: a point a row of history.csv, with sign; more: of each row step, time, load
     * factor, gauges */
    size_t    npoint, cap_x, cap_y, cap_more;
    double   *curve_x, *curve_y, *curve_more;          /* m; N */
    result_peak peak;
    result_crack crack;
    int       curve_load, curve_component;
    int       estimating, estimated;                   /* wanted; made */
    pg_estimate estimate;
    double    seconds;
    double    stamp;                                   /* of the last step */
    double    time;                                    /* of the last fields in result.e */
    double    length;  /* of a step whose middle can be seen: s, or load factor */
    /* going on later */
    result_marks done;  /* when the last step was made, and again when it was written */
    result_marks now;  /* in the middle of a step: after its last round looked at */
    long      rounds;  /* break rounds of the step at hand: its middle has been seen */
    pg_step   pending;  int is_pending;                /* a step whose rows and fields are not all written */
    pg_reference *reference;                           /* NULL: none */
    pg_errors errors;  int measured;
    double    opened, earlier;  /* pg_seconds at the opening; s in processes before this one */
    double    interval, checkpoint_at, checkpoint_cost;        /* s */
};
pg_status pg_result_prepare (pg_result *r, const char *folder, const pg_scene *scene,
                             const pg_problem *problem, pg_solver *solver);
result_marks pg_result_marks_now   (const pg_result *r);
pg_status pg_result_remove         (const pg_result *r, const char *name);
/* New tables, or those of `from`, cut to its rows. */
pg_status pg_result_history_create (pg_result *r, const result_marks *from);
pg_status pg_result_history_row    (pg_result *r, const pg_state *state, const pg_step *step);
/* PG_E_USAGE: another run has the folder. *lock: what pg_result_unlock takes. */
pg_status pg_result_lock           (const char *folder, int *lock);
void      pg_result_unlock         (const char *folder, int *lock);
pg_status pg_result_copy_scene     (const char *folder, const pg_scene *scene);
void      pg_result_averages_check (const pg_scene *scene, const pg_problem *problem);
pg_status pg_result_averages_read  (pg_result *r, const pg_scene *scene);
void      pg_result_average_column (const pg_result *r, size_t i, char *out, size_t size);
pg_status pg_result_averages_row (pg_result *r, const pg_state *state, double *row,
                               double *work /* 6 a point */);
pg_status pg_result_tips_check     (const pg_scene *scene, const pg_problem *problem);
pg_status pg_result_tips_read      (pg_result *r, const pg_scene *scene);
void      pg_result_tips_free      (pg_result *r);
pg_status pg_result_tips_row (pg_result *r, const pg_state *state, const pg_step *step, double *row,
                           double *work /* 6 a point */);
pg_status pg_result_tips_keep      (pg_result *r, size_t rows, const pg_keeper *keeper);
double    pg_result_tips_rayleigh  (const pg_result *r);  /* of the fastest material, m/s; 0: none */
/* speed: m/s at every row (tips), or NULL. */
void      pg_result_tips_run       (const pg_result *r, size_t i, result_tip_run *out, double *speed);
pg_status pg_result_tips_pictures  (pg_result *r);        /* tip.png, tip_speed.png */
void      pg_result_tips_json      (pg_json *j, const pg_result *r);
void      pg_result_curve_choose   (pg_result *r);        /* which load and component; curve_load -1: none */
pg_status pg_result_curve_row (pg_result *r, double x, double y, const double *gauges, const pg_step *step);
pg_status pg_result_curve_keep     (pg_result *r, size_t n, const pg_keeper *keeper);
pg_status pg_result_curve_picture  (pg_result *r);        /* load_displacement.png */
pg_status pg_result_curve_read     (pg_result *r);        /* fills peak */
void      pg_result_curve_json     (pg_json *j, const pg_result *r);
pg_status pg_result_crack_measure  (pg_result *r, const pg_state *state);        /* fills crack */
const char *pg_result_voigt        (int dim, int k);       /* "xx", "yy", ... of component k */
pg_status pg_result_draw       (pg_result *r, const pg_state *state);
/* stages/NAME_0007.png of step 7 of result.e */
pg_status pg_result_draw_stage          (pg_result *r, const pg_state *state);
pg_status pg_result_view_read      (result_view *v, const pg_scene *scene, size_t i, int dim);
pg_status pg_result_views_read     (pg_result *r, const pg_scene *scene);
/* measured against the reference, error.png */
pg_status pg_result_measure         (pg_result *r, const pg_state *state);
pg_status pg_result_json (pg_result *r, const pg_state *state, const char *failure, double search,
                          double total);
#endif

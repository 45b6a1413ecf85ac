/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private to app/results: the open result folder and functions that several files use. Two sets of marks make
 * a run resumable. `done` says how long the files were when the last step was complete, `now` how long they
 * were after the last call in the middle of a step. A checkpoint stores the marks, and resuming cuts the
 * files back to them. */
#ifndef PG_RESULT_PRIVATE_H
#define PG_RESULT_PRIVATE_H
#include "perigal/picture.h"
#include "perigal/results.h"

/* Largest numbers of fields and of pictures. */
enum { MOST_FIELDS = 16, MOST_PICTURES = 32 };
/* Lengths of the files, at the end of a step or in its middle. */
typedef struct {
    /* Rows of history.csv and of events.csv. */
    long     history, events;
    /* Moments whose fields are written, and a number that the writer needs to continue after them. */
    long     moments, keep;
    /* Number of the next multiple of the share of broken bonds at which fields are due; points of the
     * load-displacement curve; 1 if the fields of the last step are written. */
    long     next_broken, points, last_written;
    /* Rows of cracks.csv and of tips.csv; pieces of cracks that are in cracks.csv or need no row. */
    long     pieces, tips, npiece;
    long     contact;                                  /* rows of contact.csv */
    /* Time of the last step, and of the last fields (s, or load factor). */
    double   stamp, time;
} result_marks;
/* A mean over a set of points: column name, field, its unit, the set, and the component of the field. */
typedef struct {
    char name[32], field[32];
    const char *unit;
    const pg_set *set;
    int component;
} result_average;
/* A crack whose length is measured (output.tips). The length of a point is its distance from `from` along the
 * unit vector `direction`, m. */
typedef struct {
    char name[32];
    /* along: this length of every point, 0 for points that do not count (n, m). damage: points with at least
     * this damage belong to the crack. length: of the crack at each row (m), 0 as long as no point is
     * damaged. */
    double from[3], direction[3], damage, *along, *length;
    size_t capacity;
} result_tip;
/* Summary of one crack. Rows: the first one with a length, the first and the last one at which it grew, the
 * one at the largest speed. Speeds in m/s: mean between start and stop, and largest; 0 unless the run is
 * dynamic. moved: 1 if it grew. */
typedef struct { double mean; size_t first, start, stop, fastest; double largest; int moved; } result_tip_run;
/* A picture of the last state: NAME.png shows a field or a component of one. look: its view in
 * words. */
typedef struct {
    char name[64], field[64], look[64];
    pg_picture_style style;
    /* 1: only points are drawn whose field, or whose damage, is at least style.above. */
    int limited, by_damage;
} result_view;
/* The peak of the load-displacement curve. found = 0: there is no curve. */
typedef struct {
    int found;
    /* Row of history.csv with the largest |force| among the rows that count. */
    size_t row;
    /* Force (N) and displacement (m) there, number of the step, time (s), load factor; initial and secant
     * stiffness in N/m, NAN if unknown. */
    double force, displacement, step, time, factor, initial, secant;
    /* 1: in some rows every crack tip was checked; number of other rows, which were left out */
    int    judged;  size_t left_out;
} result_peak;
/* New crack by the broken bonds: its area in m2, in 2D its length in m (else NAN), and the dissipated energy
 * per area in J/m2 (NAN if unknown). */
typedef struct { int found; double area, length, dissipated; } result_crack;
/* Fields and their writer. */
typedef struct {
    /* The writer (output.format), its request, and its state; output NULL: not begun, or another process that
     * holds the whole body writes. */
    const pg_writer *writer;
    pg_field_request request;
    void     *output;
    pg_cloud  own;                                     /* ranks: the points of this one */
    pg_field_share share;                              /* ranks: position of these points in the whole */
    int64_t  *in_block;                                /* ranks: points of each block on all ranks */
    size_t    nfield;
    pg_field_view field[MOST_FIELDS];
    double   *value[MOST_FIELDS];
    /* Share of broken bonds after which fields are due again, number of the next such share; number of events
     * after which they are due again. 0: never. */
    double    broken_share;
    long      next_broken, every;
    /* Moments whose fields are written; 1: those of the last step are written; time of the last ones, s. */
    long      moments;
    int       last_written;
    double    time;
} result_fields;

/* Pictures. */
typedef struct {
    size_t      npicture;
    result_view picture[MOST_PICTURES];
    char        undrawn[200];                          /* why a picture could not be drawn, the last one */
    /* stages: 1: all pictures are drawn for every moment whose fields are written. stairs: 1: whole lattice
     * cells show the body (cells: staircase). */
    int         stages, stairs;
    double      magnify;                               /* magnification of displacements */
} result_pictures;

/* Cracks whose length is measured, crack tips and fronts. */
typedef struct {
    /* The cracks; `tips` is the number of rows with their lengths. */
    result_tip *tip;  size_t ntip, tips, capacity;
    /* Rayleigh wave speed, m/s, largest of the materials; 0: no density */
    double    rayleigh;
    /* 1: cracks grow by facets; 1: J and K of crack tips are measured (output.stress_intensity). */
    int       grows, measuring;
    /* The tables cracks.csv and tips.csv (3D: fronts.csv), or NULL; number of the next piece to write. */
    pg_table *pieces, *rows;
    long      npiece;
    /* J, K and more of the crack tips at the last row; in 3D of the vertices of the fronts. */
    pg_tip_values *value;  size_t nvalue, cap_value;
    pg_quadrature facet_points;                        /* of all facets, once needed */
    /* Time (s) or load factor of each row. */
    double   *time;
    /* Workspace of the search for tips, zero between rows: marks of points reached, and of those that other
     * ranks reached; queue: points in the order in which they are reached. Kept allocated: to clear it for
     * each of many rows takes longer than the search. */
    double   *seen, *known;
    int      *queue;
    /* Points with damage enough for any of the tips at this row, ascending. */
    int      *damaged;  size_t ndamaged, cap_damaged;
    /* Broken bonds when the lengths were last measured; -1: they must be measured. */
    long      broken;
} result_tips;

/* The load-displacement curve, one point per row of history.csv. */
typedef struct {
    size_t    npoint, cap_x, cap_y, cap_more;
    /* Displacement (m) and force (N), both with sign; further values of each point: step, time, load factor,
     * gauges. */
    double   *x, *y, *more;
    result_peak peak;
    int       load, component;                         /* load and axis of the curve; load -1: none */
} result_curve;

/* Progress of the run, and its checkpoints. */
typedef struct {
    /* Lengths of the files: done: when the last step was complete; now: at present, or in the middle of a
     * step after its last break round. */
    result_marks done, now;
    /* Break rounds in the current step; above 0: files contain its middle. */
    long      rounds;
    /* A step whose rows and fields are not all written. */
    pg_step   pending;  int is_pending;
    /* Time of the last step, s; length of a step (s or load factor), by which its stages are placed in
     * time. */
    double    stamp, length;
    /* pg_seconds when the folder was opened; seconds that earlier processes of this run took; seconds spent
     * on writing. */
    double    opened, earlier, seconds;
    /* Seconds between checkpoints; when the last one was written; how long that took. */
    double    interval, checkpoint_at, checkpoint_cost;
    /* Number of checkpoints written so far: ranks continue from checkpoints of equal number. */
    long      generation;
} result_progress;

/* The tables of a run. */
typedef struct {
    pg_table  *history, *events;
    pg_table  *contact;                                /* contact.csv, or NULL */
    size_t    ncolumn;                                 /* columns of history.csv */
    double   *row;                                     /* scratch space: one row of it (ncolumn) */
} result_tables;
/* The error estimate: 1: it is asked for; 1: it was made; its values. */
typedef struct {
    int       estimating, estimated;
    pg_estimate estimate;
} result_estimate;
/* An open result folder. */
struct pg_result {
    char     folder[3072];
    char     whole[3200];                              /* the result folder, that of rank 0 */
    /* Files that the scene names, with their hashes. */
    pg_named_file *named;  size_t nnamed;
    /* File descriptor of the lock plus one; 0: not locked. */
    int      lock;
    /* 1: dynamic, so that time stands for the load factor */
    int      dynamic;
    const pg_problem *problem;
    pg_solver *solver;
    char     hash[80], scene[3072];
    result_fields   fields;
    result_pictures pictures;
    result_tips     tips;
    result_curve    curve;
    result_progress progress;
    result_tables table;
    size_t    nwritten;
    char      written[MOST_PICTURES + 3][4096];
    double   *u;                                       /* scratch space: two fields at the points (n x 6) */
    /* per end of a gauge: 1: this rank measures it; -1: unknown */
    signed char *here;
    result_average *average;  size_t naverage;
    result_crack crack;
    /* 1: the size of the crack is a column of history.csv (output.crack_size). */
    int       counting;
    pg_crack_statistics network;  /* statistics of the cracks at the start */
    result_estimate error;
    /* The reference of the scene; NULL: none. */
    pg_reference *reference;
    pg_errors errors;  int measured;
};
/* ---- shared.c: ranks that share a run ------------------------------------------------------------------ */
void      pg_result_keep_own     (const pg_result *r, size_t components, double *value);
double    pg_result_once         (double value);
pg_status pg_result_collect_broken (const pg_result *r, const pg_step *step, size_t *n, pg_broken **broken);
/* Writes the part of the body that each rank holds, and its peak memory, as a list "parts" of report.json. */
void      pg_result_parts_json   (pg_json *j, const pg_result *r);
/* Removes what earlier runs have left in the folder: fields, and folders of more ranks (folder.c). */
void      pg_result_drop_earlier (const pg_result *r);
/* Removes rows that ranks left behind which were killed after the end of their run. */
void      pg_result_drop_finished_ranks (const char *folder);
/* ---- fields.c: the writer of the fields ---------------------------------------------------------------- */
/* Chooses the writer, before files are opened. */
pg_status pg_result_fields_prepare (pg_result *r, const pg_scene *scene);
/* Adds a fault to the scene if ranks divide the body and the writer cannot work with that. */
void      pg_result_fields_check   (const pg_scene *scene);
/* Begins to write fields, or continues after the moments of `from`. */
pg_status pg_result_fields_open    (pg_result *r, const result_marks *from);
/* Appends a moment with the values of r->field. All ranks call. */
pg_status pg_result_fields_write   (pg_result *r, double time);
pg_status pg_result_fields_sync    (const pg_result *r);
/* Writes the parts that only a finished result has, after the last moment. All ranks call. */
pg_status pg_result_fields_complete (pg_result *r, const pg_state *state);
/* done 1: puts these parts in their place; 0: removes them. */
pg_status pg_result_fields_finish  (const pg_result *r, int done);
/* Fills a new result from the scene without touching the folder. */
pg_status pg_result_prepare (pg_result *r, const char *folder, const pg_scene *scene,
                             const pg_problem *problem, pg_solver *solver);
/* The marks of the files as they are now. */
result_marks pg_result_marks_now   (const pg_result *r);
/* FOLDER/name into out, which is returned. */
const char *pg_result_path         (const pg_result *r, const char *name, char *out, size_t size);
/* Waits until the rows of all tables are on the disk. */
pg_status pg_result_sync_rows      (const pg_result *r);
/* Removes a file of the folder; it may be missing. */
pg_status pg_result_remove         (const pg_result *r, const char *name);
/* Creates history.csv and events.csv, or opens them and cuts them to the rows of `from`. */
pg_status pg_result_history_create (pg_result *r, const result_marks *from);
/* Writes the rows of a step to history.csv and events.csv. */
pg_status pg_result_history_row    (pg_result *r, const pg_state *state, const pg_step *step);
/* 1: a run of this scene ended in the folder before it wrote a checkpoint, which is not looked for. */
int       pg_result_left_early     (const char *folder, const pg_scene *scene);
/* Locks a folder; PG_E_USAGE if another run uses it. *lock is what pg_result_unlock takes. */
pg_status pg_result_lock           (const char *folder, int *lock);
void      pg_result_unlock         (const char *folder, int *lock);
/* Writes scene.yaml: the scene as it was read, with its origin and the --set options as
 * comments. */
pg_status pg_result_copy_scene     (const char *folder, const pg_scene *scene);
/* output.averages (average.c): checks the scene; reads; writes the header of column i, and the values of a
 * row. work: 6 values per point. */
void      pg_result_averages_check (const pg_scene *scene, const pg_problem *problem);
pg_status pg_result_averages_read  (pg_result *r, const pg_scene *scene);
void      pg_result_average_column (const pg_result *r, size_t i, char *out, size_t size);
pg_status pg_result_averages_row (pg_result *r, const pg_state *state, double *row,
                               double *work /* 6 values a point */);
/* Growing cracks, and output.stress_intensity (grown_cracks.c). In this order: check of the scene, reading;
 * columns of history.csv and their values; the tables cracks.csv and tips.csv or fronts.csv, created or cut
 * to the rows of `from`, and their rows, written after that of history.csv; report.json; dissipated energy
 * over the fracture energy of the new faces. */
void      pg_result_paths_check    (const pg_scene *scene, const pg_problem *problem);
void      pg_result_paths_read     (pg_result *r, const pg_scene *scene);
size_t    pg_result_paths_columns  (const pg_result *r);
void      pg_result_paths_column   (const pg_result *r, size_t i, char *out, size_t size);
pg_status pg_result_paths_row      (pg_result *r, const pg_state *state, double *row);
pg_status pg_result_paths_create   (pg_result *r, const result_marks *from);
pg_status pg_result_paths_write    (pg_result *r, const pg_state *state, const pg_step *step);
void      pg_result_paths_json     (pg_json *j, const pg_result *r, const pg_state *state);
double    pg_result_paths_ratio    (const pg_result *r);
void      pg_result_paths_close    (pg_result *r);
/* The faces of all cracks that have grown, to be freed with pg_free (crack_lines.c). */
pg_status pg_result_paths_faces    (const pg_result *r, const pg_state *state, size_t *n,
                                    pg_crack_face **face);
/* contact.csv (contact_rows.c): creates it or cuts it to the rows of `from`; writes its rows. */
pg_status pg_result_contact_create (pg_result *r, const result_marks *from);
pg_status pg_result_contact_write  (pg_result *r, const pg_step *step);
void      pg_result_contact_close  (pg_result *r);
/* output.tips (tip_columns.c): checks the scene, reads, frees, writes a row; keeps the first `rows` rows in a
 * checkpoint. */
pg_status pg_result_tips_check     (const pg_scene *scene, const pg_problem *problem);
pg_status pg_result_tips_read      (pg_result *r, const pg_scene *scene);
void      pg_result_tips_free      (pg_result *r);
pg_status pg_result_tips_row (pg_result *r, const pg_state *state, const pg_step *step, double *row,
                           double *work /* 6 values a point */);
pg_status pg_result_tips_keep      (pg_result *r, size_t rows, const pg_keeper *keeper);
/* Speed of Rayleigh waves in the fastest material, m/s; 0 if no material has a density. */
double    pg_result_tips_rayleigh  (const pg_result *r);
/* Computes the summary of crack i; speed: m/s at every row (tips values), or NULL. */
void      pg_result_tips_run       (const pg_result *r, size_t i, result_tip_run *out, double *speed);
/* Writes tip.png and, in dynamic runs, tip_speed.png. */
pg_status pg_result_tips_pictures  (pg_result *r);
void      pg_result_tips_json      (pg_json *j, const pg_result *r);
/* Chooses load and axis of the curve; load becomes -1 if there is none (curve.c). */
void      pg_result_curve_choose   (pg_result *r);
pg_status pg_result_curve_row (pg_result *r, double x, double y, const double *gauges, const pg_step *step);
pg_status pg_result_curve_keep     (pg_result *r, size_t n, const pg_keeper *keeper);
/* Writes load_displacement.png. */
pg_status pg_result_curve_picture  (pg_result *r);
/* Finds the peak of the load-displacement curve. */
void      pg_result_curve_read     (pg_result *r);
void      pg_result_curve_json     (pg_json *j, const pg_result *r);
/* Measures the new crack from the broken bonds. */
pg_status pg_result_crack_measure  (pg_result *r, const pg_state *state);
/* output.crack_size: number of columns (0 or 1), name and value of the column: m in 2D, m2 in 3D; NAN: not
 * known. */
size_t    pg_result_crack_columns  (const pg_result *r);
void      pg_result_crack_column   (const pg_result *r, char *out, size_t size);
pg_status pg_result_crack_row      (pg_result *r, const pg_state *state, double *row);
/* Name of Voigt component k in a dimension: "xx", "yy" ... */
const char *pg_result_voigt        (int dim, int k);
/* Draws all pictures of the last state; what cannot be drawn becomes a warning. */
void      pg_result_draw       (pg_result *r, const pg_state *state);
/* Draws them as stages/NAME_0007.png for moment 7 of the fields. */
void      pg_result_draw_stage          (pg_result *r, const pg_state *state);
/* Reads entry i of output.views; reads all of output.pictures and output.views. */
pg_status pg_result_view_read      (result_view *v, const pg_scene *scene, size_t i, int dim);
pg_status pg_result_views_read     (pg_result *r, const pg_scene *scene);
/* Measures the last state against the reference and draws error.png. */
pg_status pg_result_measure         (pg_result *r, const pg_state *state);
/* Writes report.json. */
pg_status pg_result_json (pg_result *r, const pg_state *state, const char *failure, double search,
                          double total);
/* Measures the cracks that the run starts with (crack_statistics.c). */
pg_status pg_result_network_read (pg_result *r, const pg_scene *scene);
#endif

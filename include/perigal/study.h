/* SPDX-License-Identifier: GPL-3.0-or-later
 * study.h: many runs, compared with each other and with references: one trial in a process of
 * its own, benchmarks over methods and sizes, orders of convergence, one result beside
 * another, the first bond to break.
 *
 * Each run of a study is a process of its own, because only then its CPU seconds and its
 * largest memory are its own, and because a run that fails must not end the study. Nothing
 * here prints unasked: what a person should read goes to the stream `out` of a request, and a
 * request without one is quiet. */
#ifndef PERIGAL_STUDY_H
#define PERIGAL_STUDY_H
#include "perigal/compare.h"
#include "perigal/fracture.h"
#include "perigal/results.h"
#include <signal.h>
#include <stdio.h>

/* ---- exit codes of programs ------------------------------------------------------------------------- */
/* Exit codes of processes: numbers of sysexits.h, and 128 + SIGINT. */
enum { PG_EXIT_DONE = 0, PG_EXIT_USAGE = 64, PG_EXIT_SCENE = 65, PG_EXIT_FAILED = 70,
       PG_EXIT_INTERRUPTED = 130 };
/* The exit code that belongs to a status. */
int pg_exit_code (pg_status status);

/* ---- lists of words on a command line --------------------------------------------------------------- */
enum { PG_LIST_WORDS = 32, PG_LIST_TEXT = 128 };
/* A list such as "1 mm,0.5 mm", split at its commas. given = 0: the user gave no list, defaults may be filled
 * in. */
typedef struct { int given; size_t n; char word[PG_LIST_WORDS][PG_LIST_TEXT]; } pg_word_list;
/* Splits a text at its commas; returns 0 for too many words, or for one that is empty or too long. */
int pg_word_list_split (pg_word_list *out, const char *text);

/* ---- a trial: one run, measured --------------------------------------------------------------------- */
/* The numbers of a trial: identifier, name and unit, in the order of the columns of bench.csv. */
#define PG_TRIAL_LIST(X) \
    X (SPACING, "spacing", "m") X (HORIZON, "horizon", "m")   X (POINTS, "points", "1") \
    X (DOFS, "dofs", "1")       X (L2, "l2", "1")             X (ENERGY, "energy", "1") \
    X (MAXIMUM, "maximum", "1") X (LINES, "lines", "1")       X (BUILD, "build", "s") \
    X (SHAPE, "shape", "s")     X (ANALYSE, "analyse", "s")   X (FACTOR, "factor", "s") \
    X (SOLVE, "solve", "s")     X (FORCE, "force", "s")       X (BREAK, "break", "s") \
    X (ASSEMBLE, "assemble", "s") X (UPDATE, "update", "s")   X (CPU, "cpu", "s") \
    X (WALL, "wall", "s")       X (PEAK, "peak", "B")
enum {
#define X(id, name, unit) PG_TRIAL_##id,
    PG_TRIAL_LIST (X)
#undef X
    PG_TRIAL_COUNT };
extern const char *const pg_trial_name[PG_TRIAL_COUNT], *const pg_trial_unit[PG_TRIAL_COUNT];
/* Measurements of one run; NAN where a number is not known or the scene has no such reference.
 *
 *   l2, energy, maximum   relative errors against the reference of the scene over the body (pg_norms)
 *   lines                 root of the summed squares of the differences over that of its tables
 *   cpu, wall, peak       from the start of the process until the last fields are written; measuring the
 *                         error does not count */
typedef struct { double value[PG_TRIAL_COUNT]; } pg_trial;

enum { PG_TRIAL_SETS = 64 };
/* A trial to run. */
typedef struct {
    /* The scene file, and the folder that takes the results. */
    const char *scene, *folder;
    /* Replaced values of the scene, "key=value"; of two with the same key the later one
     * counts. */
    size_t      nset;  const char *set[PG_TRIAL_SETS];
    int         threads;
} pg_trial_request;
/* Runs the scene in a new process of this same program, which must answer `bench --row` by
 * pg_trial_measure and pg_trial_write, as the program perigal does. PG_E_SCENE: a combination
 * of keys that is not possible; the message says what went wrong. */
pg_status pg_trial_run  (pg_trial *out, const pg_trial_request *q);
/* Runs a trial in the new process: builds, solves, leaves the results in `folder` and measures. start:
 * pg_seconds when the process began. */
pg_status pg_trial_measure (pg_trial *out, const pg_scene *scene, const char *folder, int threads,
                            double start);
/* Measures a finite element result, in a file that pg_mesh_result reads, against the reference of the scene
 * (PG_E_SCENE: it has none): errors, nodes, unknowns. unit: metres in a length unit of the file. */
pg_status pg_trial_of_mesh (pg_trial *out, const pg_scene *scene, const char *path, double unit);
/* The numbers as lines "name value", which pass from process to process. What a text lacks
 * becomes NAN, and what is NAN is not written. */
void      pg_trial_read  (pg_trial *out, const char *text);
void      pg_trial_write (const pg_trial *t, FILE *to);

/* ---- benchmarks: scenes x methods x sizes ----------------------------------------------------------- */
/* A benchmark: every combination of scenes, methods and sizes. */
typedef struct {
    const char  *scene[PG_LIST_WORDS];  size_t nscene;
    /* Entries of the catalogues and values of keys to combine; a list that is not given holds
     * all entries. */
    pg_word_list force, approximation, integration, basis, spacing, perturb, cells, horizon;
    /* Elements and sizes for CalculiX; sizes of scenes that take a mesh. */
    pg_word_list element, size, mesh;
    /* Replaced values for every run. */
    const char  *set[PG_TRIAL_SETS];  size_t nset;
    /* Takes bench.csv and the pictures. */
    const char  *folder;
    /* Repeats of each run; 1: the same bodies are computed by CalculiX too; threads of each
     * run. */
    int          repeat, fem, threads;
    FILE        *out;
} pg_bench_request;
/* Runs every combination `repeat` times and leaves bench.csv, time_error.png and
 * dofs_error.png. Repeats come one after the other over all combinations, so that a busy
 * minute of the machine does not fall on one of them. */
pg_status pg_bench_run (const pg_bench_request *q);

/* ---- orders of convergence -------------------------------------------------------------------------- */
enum { PG_CONVERGE_SIZES = 12, PG_CONVERGE_STUDIES = 12 };
/* A study of convergence: one scene at falling spacings. */
typedef struct {
    const char *scene, *folder, *set[PG_TRIAL_SETS / 2];
    /* Number of replaced values, and of spacings, the scene's own being the first. */
    size_t      nset, sizes;
    /* Ratio of a spacing to the next smaller one. */
    double      ratio;
    /* Horizons in spacings, a study for each; nhorizon = 0: that of the scene. */
    double      horizon[PG_CONVERGE_STUDIES];
    size_t      nhorizon;
    /* fixed = 1: the horizon keeps its length while the spacing falls (m-convergence); 0: both
     * fall (delta-convergence). */
    int         fixed, threads;
    FILE       *out;
} pg_converge_request;
/* Leaves convergence.csv and convergence.png in the folder, and the table on `out`. */
pg_status pg_converge_run (pg_converge_request *q);

/* ---- many runs of one scene ------------------------------------------------------------------------- */
enum { PG_SERIES_SETS = 8, PG_SERIES_RUNS = 1000 };
/* One run of a series: the name of its folder, its own values of the scene, "key=value" (borrowed), and a
 * number that identifies it in tables. */
typedef struct { char name[96]; size_t nset; const char *set[PG_SERIES_SETS]; double value; } pg_series_run;
/* Runs that share a scene and some of its values. */
typedef struct {
    const char *scene, *folder;
    size_t      nset;  const char *set[PG_TRIAL_SETS];
    size_t      n;     const pg_series_run *run;
    int         threads;
    /* jobs: how many run at a time; 0: one. memory: limit of each, such as "2GB"; NULL: none. */
    int         jobs;
    const char *memory;
    /* How many signals have asked to stop, as the caller's handler counts them; NULL: none can. The runs
     * are asked to stop as often, so that the first one lets them write checkpoints. */
    const volatile sig_atomic_t *stop;
    /* Called when run k has ended; a status that is not PG_OK ends the series. NULL: nothing is called. */
    pg_status (*ended) (void *context, size_t k);
    void       *context;
    /* A line for each run as it ends; NULL: quiet. */
    FILE       *out;
} pg_series_request;
/* Result of a run, NAN where not known: peak of the curve of report.json (N) and the displacement there (m),
 * energy dissipated (J), bonds broken, seconds. code: how it ended, -1: it has not begun; trouble: why, if it
 * failed. again: 1: it was there already, or went on. */
typedef struct {
    double peak, displacement, dissipated, broken, seconds;
    int    code, again;
    char   trouble[400];
} pg_series_result;
/* Runs all in folder/name each, in processes of this same program. Finished runs are not repeated,
 * interrupted ones continue from their checkpoints, failed ones begin anew. A run that fails ends only
 * itself, with its exit code; PG_EXIT_USAGE: its folder holds a finished run of another scene.
 * PG_E_INTERRUPTED. */
pg_status pg_series_run_all (pg_series_result *out /* n */, const pg_series_request *q);
/* Finds what is in folder/name: 1: a finished run of the scene with these values; 0: none; -1: a finished run
 * of another scene or of other values. PG_E_SCENE: the scene is wrong. */
pg_status pg_series_look (int *out, const pg_series_request *q, const pg_series_run *run);
/* Runs `perigal check` on every run of the series that is neither finished nor has a checkpoint, in parallel
 * (q->jobs). PG_E_SCENE, PG_E_LIMIT ...: the message names the run and the fault. */
pg_status pg_series_check (const pg_series_request *q);

/* Statistics: mean, standard deviation (n - 1), least, median and largest of those of n values that are
 * finite, which are left in rising order; NAN where there are too few. */
typedef struct { size_t n; double mean, deviation, least, median, most; } pg_spread;
void pg_spread_of (pg_spread *out, size_t n, double *value);

/* One scene with the seeds first, first + 1 ... for everything random in it: networks of cracks, perturb. */
typedef struct {
    const char *scene, *folder;
    size_t      nset;  const char *set[PG_TRIAL_SETS];
    size_t      count;
    long        first;
    int         threads;
    /* Runs at a time, limit of memory of each, signals to stop, lines told: as in pg_series_request. */
    int         jobs;
    const char *memory;
    const volatile sig_atomic_t *stop;
    FILE       *out;
} pg_seeds_request;
/* Leaves folder/seed_1 ..., seeds.csv, and seeds.png, the histogram of the peak loads. PG_E_SCENE: nothing
 * in the scene has a seed; PG_E_EQUILIBRIUM: some runs failed. */
pg_status pg_seeds_run (const pg_seeds_request *q, pg_spread *peaks);

/* ---- sweeps ----------------------------------------------------------------------------------------- */
enum { PG_SWEEP_QUANTITIES = 32 };
/* One scene with all combinations of some of its values. */
typedef struct {
    const char *scene, *folder;
    /* "key=a,b,c", or "key=1:20", "key='1:0.5:3 mm'" (from, step, to): commas inside brackets and quotes do
     * not divide. Keys with one value are the same for every run. */
    size_t      nset;       const char *set[PG_TRIAL_SETS];
    /* Columns of the table: numbers of the report (pg_sweep_report_names) or columns of history.csv,
     * "top.force_y", its last value, or "top.force_y:max", :min, :first, :peak (where the force of the
     * curve is largest). None: the usual ones. */
    size_t      nquantity;  const char *quantity[PG_SWEEP_QUANTITIES];
    /* zip = 1: the first values together, the second ones ... instead of all combinations. resume = 1: the
     * folder may hold a sweep, which goes on. */
    int         zip, resume, jobs, threads;
    const char *memory;
    const volatile sig_atomic_t *stop;
    FILE       *out;
} pg_sweep_request;
/* "peak|displacement|...". */
extern const char pg_sweep_report_names[];
/* Leaves a folder for each run, sweep.csv, and sweep.png: the first quantity over the key with most
 * values, or a histogram. The table is renewed after every run. PG_E_USAGE: lists that do not fit, an
 * unknown quantity, a folder with a sweep; PG_E_SCENE and others: a combination does not pass the check;
 * PG_E_EQUILIBRIUM: some runs failed; PG_E_INTERRUPTED. */
pg_status pg_sweep_run (const pg_sweep_request *q);

/* ---- a result beside a reference -------------------------------------------------------------------- */
/* A result to compare with a reference. */
typedef struct {
    /* The result folder; the reference, NULL for the one that its scene names. */
    const char *folder, *reference;
    /* File of the picture; NULL: compare.png in the folder. */
    const char *picture;
    /* Steps of both sides; -1: the last one. */
    int    step, other_step, threads;
    /* Of the reference: metres in its length unit, a shift (m), a factor of its values. */
    double unit, shift[3], scale;
    /* What the picture shows: a column 0 to 8, PG_COMPARE_U or PG_COMPARE_S; -1: the usual
     * one. */
    int    column;
    /* Stream for the names of the files written; NULL: quiet. */
    FILE  *out;
} pg_comparison_request;
/* Both sides of a comparison and what it found. */
typedef struct {
    /* The result, and another result if the reference is one. */
    pg_stored *own, *other;
    /* A finite element reference, lent out by `reference`; sample is NULL if there is none. */
    pg_sampler fem;
    /* The field to compare with; without known components there are tables only. */
    pg_sampler reference;
    /* A table that was named as the reference. */
    pg_line    line;
    /* The reference of the scene. */
    pg_reference *scene;
    pg_errors  errors;
    /* How the reference was sampled, in words; "": nothing to say. */
    char       note[600];
} pg_comparison;
/* Opens both sides, finds out from name and content what kind of reference it is, and
 * measures. */
pg_status pg_comparison_open  (pg_comparison *c, const pg_comparison_request *q);
/* Writes compare.csv, compare.json and the picture into the folder of the result. */
pg_status pg_comparison_write (const pg_comparison *c, const pg_comparison_request *q);
void      pg_comparison_clear (pg_comparison *c);

/* ---- the first bond to break ------------------------------------------------------------------------ */
enum { PG_FIRST_TIPS = 16 };
/* Measurements at a front of a 3D crack under the full load. */
typedef struct {
    long   id;
    int    closed;                                     /* a loop */
    size_t n, measured;                                /* vertices; those with room for a tube */
    double length;                                     /* m */
    /* Least, mean and largest J, J/m^2; where it is largest, m; least and largest K of modes I, II, III,
     * Pa m^(1/2). NAN: nothing was measured. */
    double J[3], x[3], K[3][2];
} pg_first_front;
/* Prediction of the first break by one solve at load factor 1 without breaking, followed by the criterion. */
typedef struct {
    /* solved = 1: the fields below hold, which needs a static scene. proportional: all loads
     * grow with the load factor. */
    int    asked, is_static, solved, proportional;
    /* Largest frequency, rad/s; 0: a material has no density. */
    double omega;
    /* Load factor of the first break (INFINITY: no bond can break), and largest utilisation at
     * load factor 1. */
    double factor, utilisation;
    /* Middle of that bond, m. */
    double place[3];
    /* How it breaks: 't' in tension, 's' in shear, 'e' by energy; and its bond set. */
    char   kind;  int set;
    /* Relative residual of the solve, and largest displacement, m. */
    double residual, displacement;
    /* Criteria of tips: 1: `factor` is that of the first facet, from where to where (m), and the number of
     * the tip that it moves (0: a new crack); 0: none in the steps of the scene. 3D: the number of the front,
     * and the new position of the vertex that advanced most. */
    int    grows;
    double from[3], to[3];
    long   grown;
    /* The fronts of 3D cracks, the first PG_FIRST_TIPS of nfront. */
    size_t         nfront;
    pg_first_front front[PG_FIRST_TIPS];
    /* The open tips of 2D cracks: their number, ids, and measurements at the first PG_FIRST_TIPS. refused:
     * why these are missing, else NULL. */
    size_t       ntip;
    long         id[PG_FIRST_TIPS];
    pg_tip_field tip[PG_FIRST_TIPS];
    const char  *refused;
} pg_first_break;
pg_status pg_first_break_find (pg_first_break *out, const pg_problem *p, const pg_solver_options *o);
/* The text of folder/report.json, to be freed by pg_free; NULL: it cannot be read. */
char  *pg_report_load   (const char *folder);
/* The number behind a key of that text, in the first block of that name (NULL: anywhere); NAN: it is not
 * there. text may be NULL. */
double pg_report_number (const char *text, const char *block, const char *key);

#endif

/* SPDX-License-Identifier: GPL-3.0-or-later
 * study.h: many runs, compared with each other and with references: one trial in a process of its own,
 * benchmarks over methods and sizes, orders of convergence, one result beside another, the first bond to
 * break.
 *
 * Nothing here prints unasked: what a person should read goes to the stream `out` of a request, and a
 * request without one is quiet. */
#ifndef PERIGAL_STUDY_H
#define PERIGAL_STUDY_H
#include "perigal/compare.h"
#include "perigal/results.h"
#include <stdio.h>

/* ---- exit codes of programs --------------------------------------------------------------------------- */
/* What a process ends with, so that the one that started it knows why: numbers of sysexits.h, and 128 +
 * SIGINT. */
enum { PG_EXIT_DONE = 0, PG_EXIT_USAGE = 64, PG_EXIT_SCENE = 65, PG_EXIT_FAILED = 70,
       PG_EXIT_INTERRUPTED = 130 };
int pg_exit_code (pg_status status);

/* ---- lists of words on a command line ----------------------------------------------------------------- */
enum { PG_LIST_WORDS = 32, PG_LIST_TEXT = 128 };
/* "1 mm,0.5 mm" cut at its commas. given: 0: the user named no list, and what it stands for may be filled
 * in. */
typedef struct { int given; size_t n; char word[PG_LIST_WORDS][PG_LIST_TEXT]; } pg_word_list;
/* 1: done; 0: too many words, or one that is empty or too long. */
int pg_word_list_split (pg_word_list *out, const char *text);

/* ---- a trial: one run, measured ----------------------------------------------------------------------- */
/* The numbers of a trial: name and unit, in the order of the columns of bench.csv. */
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
/* l2, energy, maximum: relative errors against the scene's reference over the body (pg_norms). lines: root
 * of the summed squares of the differences over that of its tables. NAN: the scene has no such reference,
 * or the number is not known. cpu, wall, peak: from the start of the process until the last fields are
 * written; measuring the error does not count. */
typedef struct { double value[PG_TRIAL_COUNT]; } pg_trial;

enum { PG_TRIAL_SETS = 64 };
typedef struct {
    const char *scene, *folder;                        /* folder: takes the results of the run */
    /* "key=value"; of two with the same key the later one counts */
    size_t      nset;  const char *set[PG_TRIAL_SETS];
    int         threads;
} pg_trial_request;
/* Runs the scene in a new process of this same program, which must answer `bench --row` with
 * pg_trial_measure and pg_trial_write, as the program perigal does. PG_E_SCENE: a combination of keys that
 * cannot be; pg_last_error says what went wrong. */
pg_status pg_trial_run  (pg_trial *out, const pg_trial_request *q);
/* In that new process: builds, solves, leaves the results in `folder` and measures. start: pg_seconds when
 * the process began. */
pg_status pg_trial_measure (pg_trial *out, const pg_scene *scene, const char *folder, int threads,
                            double start);
/* The same numbers for a finite element result (a file that pg_mesh_result reads; unit: m in a length unit
 * of the file). */
pg_status pg_trial_of_mesh (pg_trial *out, const pg_scene *scene, const char *path, double unit);
/* Between the two processes: lines "name value"; what a text lacks becomes NAN, what is NAN is not
 * written. */
void      pg_trial_read  (pg_trial *out, const char *text);
void      pg_trial_write (const pg_trial *t, FILE *to);

/* ---- benchmarks: scenes x methods x sizes ------------------------------------------------------------- */
typedef struct {
    const char  *scene[PG_LIST_WORDS];  size_t nscene;
    pg_word_list force, approximation, integration, basis, spacing, perturb, cells, horizon;
    pg_word_list element, size, mesh;          /* elements and sizes of CalculiX; sizes of scenes on meshes */
    const char  *set[PG_TRIAL_SETS];  size_t nset;     /* for every run */
    const char  *folder;                               /* takes bench.csv and the pictures */
    int          repeat, fem, threads;                 /* fem: the same bodies by CalculiX too */
    FILE        *out;
} pg_bench_request;
/* Runs every combination, `repeat` times one after the other, and leaves bench.csv, time_error.png,
 * dofs_error.png. */
pg_status pg_bench_run (const pg_bench_request *q);

/* ---- orders of convergence ---------------------------------------------------------------------------- */
enum { PG_CONVERGE_SIZES = 12, PG_CONVERGE_STUDIES = 12 };
typedef struct {
    const char *scene, *folder, *set[PG_TRIAL_SETS / 2];
    size_t      nset, sizes;                         /* sizes: how many spacings, the scene's own the first */
    double      ratio;                                 /* of a spacing to the next */
    double      horizon[PG_CONVERGE_STUDIES];          /* in spacings, a study for each; none: the scene's */
    size_t      nhorizon;
    int         fixed, threads;            /* fixed: the horizon stays (m-convergence), else it shrinks too */
    FILE       *out;
} pg_converge_request;
/* Leaves convergence.csv and convergence.png in the folder, and the table on `out`. */
pg_status pg_converge_run (pg_converge_request *q);

/* ---- a result beside a reference ---------------------------------------------------------------------- */
typedef struct {
    const char *folder, *reference;                    /* reference NULL: the scene's own */
    const char *picture;                               /* NULL: compare.png in the folder */
    int    step, other_step, threads;                  /* -1: the last one */
    double unit, shift[3], scale;          /* of a reference: m in its length unit; m; factor of its values */
    int    column;                         /* of the picture: 0 to 8, PG_COMPARE_U, PG_COMPARE_S; -1: usual */
    FILE  *out;                                        /* names of the files written */
} pg_comparison_request;
typedef struct {
    pg_stored *own, *other;                            /* other: a result to compare with */
    pg_sampler fem;                       /* borrowed view of a finite element reference; sample NULL: none */
    pg_sampler reference;                              /* displacement and stress 0: tables only */
    pg_line    line;                                   /* a table that was named */
    pg_reference *scene;                               /* the scene's own reference */
    pg_errors  errors;
    char       note[600];                              /* how the reference was sampled; "": nothing to say */
} pg_comparison;
/* Opens both sides, tells by the name and content of the reference what it is, and measures. */
pg_status pg_comparison_open  (pg_comparison *c, const pg_comparison_request *q);
/* Writes compare.csv, compare.json and the picture into the folder of the result. */
pg_status pg_comparison_write (const pg_comparison *c, const pg_comparison_request *q);
void      pg_comparison_clear (pg_comparison *c);

/* ---- the first bond to break -------------------------------------------------------------------------- */
/* One solve at load factor 1 in which nothing may break, then the criterion on what it shows. */
typedef struct {
    int    asked, is_static, solved, proportional;     /* solved: the fields below hold */
    double omega;                                 /* largest frequency, rad/s; 0: a material has no density */
    double factor, utilisation;             /* load factor of the break (INFINITY: no bond can break); at 1 */
    double place[3];                                   /* middle of the bond, m */
    char   kind;  int set;                      /* of the bond: how it breaks ('t', 's', 'e'); its bond set */
    double residual, displacement;                     /* relative residual; largest displacement, m */
} pg_first_break;
pg_status pg_first_break_find (pg_first_break *out, const pg_problem *p, const pg_solver_options *o);
#endif

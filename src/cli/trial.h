/* SPDX-License-Identifier: GPL-3.0-or-later
 * trial.h: one run in a process of its own, told back as numbers by name; what bench and converge are made
 * of. */
#ifndef PERIGAL_CLI_TRIAL_H
#define PERIGAL_CLI_TRIAL_H
#include "perigal.h"

/* name, unit; the order is that of the columns of bench.csv */
#define TRIAL_LIST(X) \
    X (SPACING, "spacing", "m") \
    X (HORIZON, "horizon", "m") X (POINTS, "points", "1") X (DOFS, "dofs", "1") X (L2, "l2", "1") \
        X (ENERGY, "energy", "1") X (MAXIMUM, "maximum", "1") X (LINES, "lines", "1") \
            X (BUILD, "build", "s") X (SHAPE, "shape", "s") X (ANALYSE, "analyse", "s") \
                X (FACTOR, "factor", "s") X (SOLVE, "solve", "s") X (FORCE, "force", "s") \
                    X (BREAK, "break", "s") X (ASSEMBLE, "assemble", "s") X (UPDATE, "update", "s") \
                        X (CPU, "cpu", "s") X (WALL, "wall", "s") X (PEAK, "peak", "B")
enum {
#define X(id, name, unit) TRIAL_##id,
    TRIAL_LIST (X)
#undef X
    TRIAL_COUNT };
extern const char *const trial_name[TRIAL_COUNT], *const trial_unit[TRIAL_COUNT];
/* l2, energy, maximum: relative errors against the scene's reference over the body (pg_norms); lines: root of
 * the summed squares of the differences over that of its tables; NAN: no such reference. cpu, wall, peak:
 * from the start of the process until the last fields are written, measuring the error not counted. */
typedef struct { double value[TRIAL_COUNT]; } trial;

enum { TRIAL_SETS = 64 };
typedef struct {
    const char *scene, *folder;  /* folder: results of the run: history.csv, events.csv, result.e */
    size_t      nset;  const char *set[TRIAL_SETS];    /* "key=value" */
    int         threads;
} trial_request;
/* Runs it; pg_last_error names what went wrong: PG_E_SCENE a combination that cannot be, else what ended the
 * run. */
pg_status trial_run  (trial *out, const trial_request *q);
void      trial_read (trial *out, const char *text);   /* lines "name value"; the others stay NAN */
void      trial_tell (const trial *t);                 /* prints them */
/* In the process of its own: argv as of `run`, argv[0] any; prints the numbers. */
int       trial_main (int argc, char **argv);
/* trial_errors.c: fills l2, energy, maximum, lines. */
void      trial_take   (trial *t, const pg_errors *errors);
pg_status trial_errors (trial *t, const pg_scene *scene, const pg_problem *problem, pg_solver *solver,
                        const pg_state *state, int dynamic);
#endif

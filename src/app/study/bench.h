/* SPDX-License-Identifier: GPL-3.0-or-later
 * The cases of a benchmark: how they follow from a request (bench_cases.c), how they run (bench.c,
 * bench_fem.c, bench_mesh.c), which files they leave (bench_report.c). */
#ifndef PG_STUDY_BENCH_H
#define PG_STUDY_BENCH_H
#include "perigal/study.h"

/* Largest number of repeats. */
enum { PG_BENCH_REPEATS = 100 };
/* A case, that is a point of a curve: one scene, one method, one size. */
typedef struct {
    /* Indices of the scene and of the curve; cases of one curve differ in size only. */
    size_t scene, curve;
    /* 1: solved by CalculiX; number of repeats that came to an end. */
    int    fem, runs;
    /* name of the scene; group: scenes of one body and one reference; method in words; perturbation and kind
     * of cells; the overrides; trouble: why it did not run, or "". */
    char name[64], group[64], method[PG_LIST_TEXT], perturb[16], cells[16], set[8][PG_LIST_TEXT + 32],
        trouble[512];
    /* Element and number of elements of a mesh, for CalculiX and for scenes that take one; else "". */
    char   element[16];  long size;
    /* The override "mesh.file=..." for scenes that take a mesh, once it is made. */
    char   mesh[4300];
    size_t nset;
    /* The numbers of the repeat with the least CPU seconds. */
    pg_trial best;
    /* CPU seconds of every run, in the order of running (runs), s. */
    double cpu[PG_BENCH_REPEATS];
} pg_bench_case;
typedef struct { size_t n, cap, ncurve; pg_bench_case *at; } pg_bench_cases;

/* Properties of a scene: spacing (m; 0 if its points do not come from one), horizon in spacings and whether
 * it is given, whether its basis is quadratic, whether its body is a mesh, and its name: that of its folder,
 * or of the file if that is not called scene.yaml. */
typedef struct { double spacing, horizon; int has_horizon, quadratic, mesh; char name[64]; } pg_bench_base;
/* Reads these properties from a scene file. PG_E_SCENE: it is wrong, or cannot be read. */
pg_status pg_bench_look (pg_bench_base *out, const char *scene, size_t nset, const char *const *set);

/* Makes the cases of all combinations, those of one curve one after the other, sizes in the order given (by
 * default from large to small). */
pg_status pg_bench_cases_make (pg_bench_cases *out, const pg_bench_request *q);
/* A body that data/calculix/make_mesh.py can mesh: name of the scene; group under which it is
 * compared; its name in the script; its length unit; its dimension; own = 1: the scene itself
 * takes the mesh. */
typedef struct { const char *scene, *group, *mesh, *unit; int dim, own; } pg_bench_body;
const pg_bench_body *pg_bench_body_find (const char *scene);
/* Returns why no mesh of the scene can be made, in words; NULL if it can. */
const char *pg_bench_mesh_missing (const char *path, const char *scene);
/* Writes the name of the mesh file in DIR/fem, without .inp. */
void        pg_bench_mesh_name (const pg_bench_case *c, char *name, size_t size);
/* Makes the mesh of a case unless it has been made. */
pg_status   pg_bench_mesh_make (const pg_bench_case *c, const pg_bench_request *q);
/* Makes the mesh of a case unless it has been made, and fills c->mesh. */
pg_status   pg_bench_mesh_set  (pg_bench_case *c, const pg_bench_request *q);
/* Adds cases in which CalculiX solves the body of a scene, with meshes in DIR/fem; this needs ccx, python3
 * and make_mesh.py. */
pg_status pg_bench_fem_add (pg_bench_cases *out, const pg_bench_request *q, size_t scene,
                            const char *name);
/* Runs a case of CalculiX once. */
pg_status pg_bench_fem_run (pg_bench_case *c, const pg_bench_request *q);
/* Finds least, median and largest CPU seconds of the runs of a case. */
void      pg_bench_spread (const pg_bench_case *c, double *least, double *median, double *largest);
/* Writes bench.csv, pictures, and the ratios of CPU seconds at equal error. */
pg_status pg_bench_report (const pg_bench_cases *cases, const pg_bench_request *q);
#endif

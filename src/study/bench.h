/* SPDX-License-Identifier: GPL-3.0-or-later
 * bench.h: the cases of a benchmark: how they follow from a request, how they run, what they leave. */
#ifndef PG_STUDY_BENCH_H
#define PG_STUDY_BENCH_H
#include "perigal/study.h"

enum { PG_BENCH_REPEATS = 100 };
/* A point of a curve: one scene, one method, one size. best: the repeat with the least CPU seconds. */
typedef struct {
    size_t scene, curve;
    int    fem, runs;                                  /* fem: CalculiX; runs: that came to an end */
    char name[64], group[64], method[PG_LIST_TEXT], perturb[16], cells[16], set[8][PG_LIST_TEXT + 32],
        trouble[512];
    char   element[16];  long size;  /* fem, and scenes on meshes of make_mesh.py; else "" */
    char   mesh[4300];                                 /* of the latter: "mesh.file=..." once it is made */
    size_t nset;
    pg_trial best;                                     /* the run with the least CPU seconds */
    double cpu[PG_BENCH_REPEATS];                      /* s of every run, in the order of running (runs) */
} pg_bench_case;
typedef struct { size_t n, cap, ncurve; pg_bench_case *at; } pg_bench_cases;

/* Of a scene: its spacing (m; 0: its points have none of their own choice), horizon in spacings, and name:
 * that of its folder, or of the file when that is not called scene.yaml. mesh: its body is a mesh. */
typedef struct { double spacing, horizon; int has_horizon, quadratic, mesh; char name[64]; } pg_bench_base;
pg_status pg_bench_look (pg_bench_base *out, const char *scene, size_t nset, const char *const *set);

/* bench_cases.c: all combinations, those of one curve one after the other; sizes as given (large to small by
 * default). */
pg_status pg_bench_cases_make (pg_bench_cases *out, const pg_bench_request *q);
/* bench_mesh.c: what make_mesh.py knows. scene: name; group: what it is compared under, scenes of one body
 * and reference share one; mesh: CASE of make_mesh.py; unit: of its lengths; own: the scene itself takes the
 * mesh. */
typedef struct { const char *scene, *group, *mesh, *unit; int dim, own; } pg_bench_body;
const pg_bench_body *pg_bench_body_find (const char *scene);
/* why no mesh can be made; NULL: it can */
const char *pg_bench_mesh_missing (const char *path, const char *scene);
/* of the file in DIR/fem, without .inp */
void        pg_bench_mesh_name (const pg_bench_case *c, char *name, size_t size);
pg_status   pg_bench_mesh_make (const pg_bench_case *c, const pg_bench_request *q);     /* at the first run */
pg_status   pg_bench_mesh_set  (pg_bench_case *c, const pg_bench_request *q); /* makes it and fills c->mesh */
/* bench_fem.c: the same bodies for CalculiX, meshes in DIR/fem (needs ccx, python3 and
 * data/calculix/make_mesh.py). */
pg_status pg_bench_fem_add (pg_bench_cases *out, const pg_bench_request *q, size_t scene,
                            const char *name);
pg_status pg_bench_fem_run (pg_bench_case *c, const pg_bench_request *q);
/* Least, median and largest CPU seconds of the runs of a case. */
void      pg_bench_spread (const pg_bench_case *c, double *least, double *median, double *largest);
/* bench_report.c: bench.csv, pictures, ratios of CPU seconds at equal error. */
pg_status pg_bench_report (const pg_bench_cases *cases, const pg_bench_request *q);
#endif

/* SPDX-License-Identifier: GPL-3.0-or-later
 * bench.h: what `perigal bench` is asked for, and the cases that follow from it. */
#ifndef PERIGAL_CLI_BENCH_H
#define PERIGAL_CLI_BENCH_H
#include "trial.h"

enum { BENCH_WORDS = 32, BENCH_TEXT = 128 };
/* of a list a,b,c */
typedef struct { int given; size_t n; char word[BENCH_WORDS][BENCH_TEXT]; } bench_words;
typedef struct {
    const char *scene[BENCH_WORDS];  size_t nscene;
    bench_words force, approximation, integration, basis, spacing, perturb, cells, horizon, element, size,
        mesh;
    const char *set[TRIAL_SETS];  size_t nset;
    const char *folder;
    int         repeat, fem, quiet, threads;
} bench_request;
/* 1: done; 0: too many, too long or empty */
int bench_split (bench_words *out, const char *text);

/* A point of a curve: one scene, one method, one size. best: the repeat with the least CPU seconds. */
typedef struct {
    size_t scene, curve;
    int    fem, runs;                                  /* fem: CalculiX; runs: that came to an end */
    char name[64], group[64], method[BENCH_TEXT], perturb[16], cells[16], set[8][BENCH_TEXT + 32],
        trouble[512];
    char   element[16];  long size;  /* fem, and scenes on meshes of make_mesh.py; else "" */
    char   mesh[4300];                                 /* of the latter: "mesh.file=..." once it is made */
    size_t nset;
    trial  best;
} bench_case;
typedef struct { size_t n, cap, ncurve; bench_case *at; } bench_cases;

/* Of a scene: its spacing (m; 0: its points have none of their own choice), horizon in spacings, and name:
 * that of its folder, or of the file when that is not called scene.yaml. mesh: its body is a mesh. */
typedef struct { double spacing, horizon; int has_horizon, quadratic, mesh; char name[64]; } bench_base;
pg_status bench_look (bench_base *out, const char *scene, size_t nset, const char *const *set);

/* bench_cases.c: all combinations, those of one curve one after the other; sizes as given (large to small by
 * default). */
pg_status bench_cases_make (bench_cases *out, const bench_request *q);
/* bench_mesh.c: what make_mesh.py knows. scene: name; group: what it is compared under, scenes of one body
 * and reference share one; mesh: CASE of make_mesh.py; unit: of its lengths; own: the scene itself takes the
 * mesh. */
typedef struct { const char *scene, *group, *mesh, *unit; int dim, own; } bench_body;
const bench_body *bench_body_find (const char *scene);
/* why no mesh can be made; NULL: it can */
const char *bench_mesh_missing (const char *path, const char *scene);
/* of the file in DIR/fem, without .inp */
void        bench_mesh_name (const bench_case *c, char *name, size_t size);
pg_status   bench_mesh_make (const bench_case *c, const bench_request *q);     /* at the first run */
pg_status   bench_mesh_set  (bench_case *c, const bench_request *q);  /* makes it and fills c->mesh */
/* bench_fem.c: the same bodies for CalculiX, meshes in DIR/fem (needs ccx, python3 and
 * data/calculix/make_mesh.py). */
pg_status bench_fem_add    (bench_cases *out, const bench_request *q, size_t scene, const char *name);
pg_status bench_fem_run    (bench_case *c, const bench_request *q);
/* SCENE FILE.frd UNIT: measures in a process of its own */
int       bench_fem_main   (int argc, char **argv);
/* bench_report.c: bench.csv, pictures, ratios of CPU seconds at equal error (to stdout). */
pg_status bench_report     (const bench_cases *cases, const bench_request *q);
#endif

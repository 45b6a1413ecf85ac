/* SPDX-License-Identifier: GPL-3.0-or-later
 * Meshes of data/calculix/make_mesh.py, for CalculiX and for scenes that use the same mesh. They are made
 * before anything is timed. */
#include "process.h"
#include "bench.h"
#include <errno.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* The scenes that the script knows. */
static const pg_bench_body known[] = {
    { "textbook_cantilever", "textbook_cantilever", "cantilever", "m", 2, 0 },
    { "kirsch", "kirsch", "kirsch", "m", 2, 0 },
    { "kirsch_mesh", "kirsch", "kirsch", "m", 2, 1 },
    { "lame_cylinder", "lame_cylinder", "lame", "m", 2, 0 },
    { "lame_mesh", "lame_cylinder", "lame", "m", 2, 1 },
    { "lame_cylinder_strain", "lame_cylinder_strain", "lame_strain", "m", 2, 0 },
    { "plate_hole", "plate_hole", "plate_clamped", "mm", 2, 0 },
    { "plate_hole_sliding", "plate_hole_sliding", "plate_sliding", "mm", 2, 0 },
    { "plate_hole_mesh", "plate_hole", "plate_clamped", "mm", 2, 1 },
    { "plate_hole_mesh_sliding", "plate_hole_sliding", "plate_sliding", "mm", 2, 1 },
    { "bending_3d", "bending_3d", "bending_3d", "m", 3, 0 },
    { "cantilever_3d", "cantilever_3d", "cantilever_3d", "m", 3, 0 },
    { "cantilever_3d_mesh", "cantilever_3d", "cantilever_3d_long", "m", 3, 1 },
};

/* Finds the body of a scene; NULL if make_mesh.py has no mesh of it. */
const pg_bench_body *pg_bench_body_find (const char *scene)
{
    for (size_t k = 0; k < sizeof known / sizeof *known; k++)
        if (strcmp (known[k].scene, scene) == 0) return &known[k];
    return NULL;
}

/* Finds the path of make_mesh.py: in ../calculix beside the folder of the scene, or below the current folder;
 * NULL if it is not there. */
static const char *script_of (const char *path, char *script, size_t size)
{
    const char *slash = strrchr (path, '/');
    snprintf (script, size, "%.*s../calculix/make_mesh.py", slash ? (int) (slash - path + 1) : 0, path);
    if (access (script, R_OK) != 0) snprintf (script, size, "data/calculix/make_mesh.py");
    return access (script, R_OK) == 0 ? script : NULL;
}

/* Returns the first thing that is missing for a mesh. */
const char *pg_bench_mesh_missing (const char *path, const char *scene)
{
    char script[4096];
    if (!pg_bench_body_find (scene)) return "no mesh of this scene is known to data/calculix/make_mesh.py";
    if (!pg_process_finds ("python3")) return "python3 is not installed";
    return script_of (path, script, sizeof script) ? NULL : "data/calculix/make_mesh.py is not there";
}

/* Names the mesh; scenes with the same body, element and size share one. */
void pg_bench_mesh_name (const pg_bench_case *c, char *name, size_t size)
{
    snprintf (name, size, "%.24s_%.15s_%ld", pg_bench_body_find (c->name)->mesh, c->element, c->size);
}

/* Runs the script with the name of the body, the element and the size. A mesh that an earlier
 * run of the same case made is kept. PG_E_SCENE with the first line that the script wrote if
 * it refuses. */
pg_status pg_bench_mesh_make (const pg_bench_case *c, const pg_bench_request *q)
{
    pg_status status = PG_OK;
    pg_process *child = NULL;
    char script[4096], number[24], name[64], folder[4096], input[4200], log[4200], text[512];
    const char *argv[] = { "python3",  script, pg_bench_body_find (c->name)->mesh,
                           c->element, number, input,
                           NULL };
    PG_ALLOC (child, 1);
    pg_bench_mesh_name (c, name, sizeof name);
    snprintf (folder, sizeof folder, "%s/fem", q->folder);
    if (mkdir (folder, 0777) != 0 && errno != EEXIST)
        PG_FAIL (PG_E_FILE, "cannot make the folder %s: %s", folder, strerror (errno));
    snprintf (number, sizeof number, "%ld", c->size);
    snprintf (input, sizeof input, "%s/%s.inp", folder, name);
    snprintf (log, sizeof log, "%s/%s.log", folder, name);
    if (access (input, R_OK) == 0 && c->runs) goto done;
    if (!script_of (q->scene[c->scene], script, sizeof script))
        PG_FAIL (PG_E_SCENE, "data/calculix/make_mesh.py is not there");
    PG_TRY (pg_process_run (child, "python3", argv, NULL, log, 1));
    if (child->code == 0) goto done;
    pg_process_complaint (log, text, sizeof text);
    PG_FAIL (PG_E_SCENE, "make_mesh.py %s %s %ld: %s", argv[2], c->element, c->size, text);
done:
    pg_free (child);
    return status;
}

/* Makes the mesh and sets mesh.file to it; the path must be absolute, since a relative one counts from the
 * folder of the scene. */
pg_status pg_bench_mesh_set (pg_bench_case *c, const pg_bench_request *q)
{
    pg_status status = PG_OK;
    char name[64], path[4096], folder[PATH_MAX];
    PG_TRY (pg_bench_mesh_make (c, q));
    pg_bench_mesh_name (c, name, sizeof name);
    snprintf (path, sizeof path, "%s/fem", q->folder);
    if (!realpath (path, folder)) PG_FAIL (PG_E_FILE, "%s: %s", path, strerror (errno));
    int n = snprintf (c->mesh, sizeof c->mesh, "mesh.file=%s/%s.inp", folder, name);
    if (n < 0 || (size_t) n >= sizeof c->mesh)
        PG_FAIL (PG_E_FILE, "%s: the path of the folder is too long", path);
done:
    return status;
}

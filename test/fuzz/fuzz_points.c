/* SPDX-License-Identifier: GPL-3.0-or-later
 * Any bytes as a file of points (first byte: the dimension): points with positive volumes and places of their
 * own, or a fault. */
#include "fuzz.h"
#include "geometry/cloud/body/points_file.h"
#include <math.h>


static void check (const pg_cloud *c)
{
    size_t dim = (size_t) c->dim;
    FUZZ_EXPECT (c->n > 0);
    for (size_t i = 0; i < c->n * dim; i++) FUZZ_EXPECT (isfinite (c->x[i]));
    for (size_t i = 0; i < c->n; i++)
        FUZZ_EXPECT (c->volume[i] > 0 && isfinite (c->volume[i]) && c->block[i] >= 0);
    for (size_t i = 1; i < c->n; i++)
        FUZZ_EXPECT (memcmp (c->x + i * dim, c->x + (i - 1) * dim, dim * sizeof *c->x) != 0);
}

int LLVMFuzzerTestOneInput (const uint8_t *data, size_t size)
{
    static const char *const text[] = { "dimension: 1\npoints: p.csv\n", "dimension: 2\npoints: p.csv\n",
                                        "dimension: 3\npoints: p.csv\n" };
    pg_scene *scene = NULL;
    size_t used = pg_memory_used ();
    if (size < 1 || size > LONGEST) return 0;
    pg_cloud cloud = { .dim = 1 + data[0] % 3 };
    if (pg_scene_parse (&scene, text[cloud.dim - 1], "scene.yaml") != PG_OK) FUZZ_BROKEN ("the scene");
    pg_status status = pg_points_parse (&cloud, scene, (const char *) data + 1, size - 1);
    FUZZ_EXPECT (status == PG_OK || status == PG_E_SCENE);
    if (status == PG_OK) check (&cloud);
    else FUZZ_EXPECT (strstr (pg_last_error (), "points = p.csv: p.csv"));
    pg_cloud_clear (&cloud);
    pg_scene_free (&scene);
    FUZZ_EXPECT (pg_memory_used () == used);
    return 0;
}

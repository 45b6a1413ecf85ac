/* SPDX-License-Identifier: GPL-3.0-or-later
 * Scenes from text, for tests of the folders that read them. */
#ifndef PERIGAL_TEST_PARSED_H
#define PERIGAL_TEST_PARSED_H
#include "check.h"
#include "perigal/cloud.h"

static inline pg_scene *parsed (const char *text)
{
    pg_scene *scene = NULL;
    check_ok (pg_scene_parse (&scene, text, "test.yaml"));
    return scene;
}

/* Scene, body, lattice and cloud of a text. */
typedef struct { pg_scene *scene; pg_body body; pg_lattice lattice; pg_cloud cloud; } built;

static inline built build (const char *text)
{
    built b = {.scene = parsed (text)};
    check_ok (pg_body_read (&b.body, b.scene));
    check_ok (pg_cloud_build (&b.cloud, &b.lattice, &b.body, b.scene));
    return b;
}

static inline void unbuild (built *b)
{
    pg_cloud_clear (&b->cloud);
    pg_lattice_clear (&b->lattice);
    pg_body_clear (&b->body);
    pg_scene_free (&b->scene);
}
#endif

/* SPDX-License-Identifier: GPL-3.0-or-later
 * model.h: the body, points, cells and sets of a scene given as text. */
#ifndef PERIGAL_TEST_CELLS_MODEL_H
#define PERIGAL_TEST_CELLS_MODEL_H
#include "check.h"
#include "perigal/cells.h"

typedef struct {
    pg_scene *scene;
    pg_body body;
    pg_lattice lattice;
    pg_cloud cloud;
    pg_cells cells;
    pg_sets sets;
} model;

/* cut: cells cut by the surface, not whole ones. */
static inline pg_status make (model *m, const char *text, int cut)
{
    pg_status status = PG_OK;
    memset (m, 0, sizeof *m);
    check_ok (pg_scene_parse (&m->scene, text, "test.yaml"));
    PG_TRY (pg_body_read (&m->body, m->scene));
    PG_TRY (pg_cloud_build (&m->cloud, &m->lattice, &m->body, m->scene));
    if (cut) {
        PG_TRY (pg_cells_cut (&m->cells, &m->body, &m->lattice, m->cloud.thickness, 0, NULL));
        PG_TRY (pg_cells_share (&m->cloud, &m->cells, &m->lattice));
    } else PG_TRY (pg_cells_from_lattice (&m->cells, &m->lattice, m->cloud.thickness));
    PG_TRY (pg_sets_build (&m->sets, m->scene, &m->body, &m->lattice, &m->cloud, &m->cells));
done:
    return status;
}

static inline void drop (model *m)
{
    pg_sets_clear (&m->sets);
    pg_cells_clear (&m->cells);
    pg_cloud_clear (&m->cloud);
    pg_lattice_clear (&m->lattice);
    pg_body_clear (&m->body);
    pg_scene_free (&m->scene);
}

static inline const pg_set *find (const model *m, const char *name)
{
    const pg_set *s = pg_sets_find (&m->sets, name);
    if (!s) print_error ("no set %s\n", name);
    assert_non_null (s);
    return s;
}

static inline void must_fault (const char *text, const char *part)
{
    model m;
    check_fails (make (&m, text, 0), PG_E_SCENE);
    check_contains (pg_last_error (), part);
    /* faults of sets: they are there all the same, for more to be found */
    if (m.cells.n) assert_non_null (pg_sets_find (&m.sets, "all"));
    drop (&m);
}
#endif

/* SPDX-License-Identifier: GPL-3.0-or-later
 * meshed.h: the cells of a lattice over a body that a scene describes. */
#ifndef PERIGAL_TEST_MESHED_H
#define PERIGAL_TEST_MESHED_H
#include "check.h"
#include "perigal/cells.h"

typedef struct { pg_scene *scene; pg_body body; pg_lattice lattice; pg_cloud cloud; pg_cells cells; } meshed;

/* body: the scene but for its spacing. cut: 1: cells end at the surface, 0: steps of whole cells. */
static inline meshed make (const char *body, double spacing, int cut)
{
    meshed m = { 0 };
    char all[2000];
    snprintf (all, sizeof all, "%sspacing: %.17g\n", body, spacing);
    check_ok (pg_scene_parse (&m.scene, all, "test.yaml"));
    check_ok (pg_body_read (&m.body, m.scene));
    check_ok (pg_cloud_build (&m.cloud, &m.lattice, &m.body, m.scene));
    if (cut) check_ok (pg_cells_cut (&m.cells, &m.body, &m.lattice, 1, 0, NULL));
    else check_ok (pg_cells_from_lattice (&m.cells, &m.lattice, 1));
    return m;
}

static inline void drop (meshed *m)
{
    pg_cells_clear (&m->cells), pg_cloud_clear (&m->cloud), pg_lattice_clear (&m->lattice),
        pg_body_clear (&m->body), pg_scene_free (&m->scene);
}

static inline double volume_of (const meshed *m)
{
    double V = 0;
    for (size_t c = 0; c < m->cells.n; c++) V += m->cells.volume[c];
    return V;
}
#endif

/* SPDX-License-Identifier: GPL-3.0-or-later
 * Any bytes as a mesh file of any format: a mesh whose parts fit together, or a fault that names the file. */
#include "fuzz.h"
#include "io/mesh_files/format.h"
#include <math.h>

static void check_sets (const pg_mesh *m)
{
    for (size_t s = 0; s < m->nnodes; s++)
        for (size_t k = 0; k < m->nodes[s].n; k++) {
            FUZZ_EXPECT ((size_t) m->nodes[s].node[k] < m->nnode);
            FUZZ_EXPECT (k == 0 || m->nodes[s].node[k] > m->nodes[s].node[k - 1]);
        }
    for (size_t s = 0; s < m->nsides; s++)
        for (size_t k = 0; k < m->sides[s].n; k++) {
            FUZZ_EXPECT ((size_t) m->sides[s].element[k] < m->n);
            FUZZ_EXPECT (m->sides[s].side[k] >= 0
                         && m->sides[s].side[k] < pg_element_types[m->kind[m->sides[s].element[k]]].faces);
        }
}

static void check_mesh (const pg_mesh *m)
{
    size_t n, in_blocks = 0;
    int *element, *side;
    FUZZ_EXPECT (m->dim >= 1 && m->dim <= 3 && m->n > 0 && m->nnode > 0);
    for (size_t k = 0; k < 3 * m->nnode; k++) FUZZ_EXPECT (isfinite (m->x[k]));
    for (size_t e = 0; e < m->n; e++) {
        FUZZ_EXPECT (m->kind[e] < PG_ELEMENTS && pg_element_types[m->kind[e]].dim == m->dim);
        FUZZ_EXPECT (m->start[e + 1] - m->start[e] == (size_t) pg_element_types[m->kind[e]].nodes);
        for (size_t k = m->start[e]; k < m->start[e + 1]; k++) FUZZ_EXPECT ((size_t) m->node[k] < m->nnode);
        FUZZ_EXPECT ((size_t) m->block[e] < m->nblock);
    }
    for (size_t b = 0; b < m->nblock; b++) in_blocks += m->blocks[b].n;
    FUZZ_EXPECT (in_blocks == m->n);
    check_sets (m);
    FUZZ_EXPECT (pg_mesh_surface (m, &n, &element, &side) == PG_OK);
    pg_free (element), pg_free (side);
}

static void check_search (const pg_mesh *m)
{
    pg_mesh_locator *f = NULL;
    double xi[3], away;
    FUZZ_EXPECT (pg_mesh_locator_create (&f, m) == PG_OK);
    for (size_t i = 0; i < m->nnode && i < 20; i++) {
        long e = pg_mesh_locator_find (f, m->x + 3 * i, xi, &away);
        FUZZ_EXPECT (e >= -1 && e < (long) m->n);
    }
    pg_mesh_locator_free (&f);
}

static void check_result (const mesh_file *file)
{
    pg_mesh m;
    pg_mesh_field *fields = NULL;
    size_t n = 0;
    double time;
    pg_status status = mesh_parse_result (&m, file, -1, &n, &fields, &time);
    FUZZ_EXPECT (status == PG_OK || status == PG_E_FILE);
    if (status != PG_OK) return;
    for (size_t k = 0; k < n; k++)
        for (size_t i = 0; i < m.nnode * (size_t) fields[k].components; i++)
            FUZZ_EXPECT (isfinite (fields[k].value[i]));
    status = pg_mesh_flatten (&m, n, fields);
    FUZZ_EXPECT (status == PG_OK || status == PG_E_USAGE || status == PG_E_FILE);
    pg_mesh_fields_clear (n, &fields);
    pg_mesh_clear (&m);
}

int LLVMFuzzerTestOneInput (const uint8_t *data, size_t size)
{
    size_t used = pg_memory_used ();
    pg_mesh mesh;
    if (size > LONGEST) return 0;
    char *text = pg_calloc (size + 1, 1);
    if (!text) FUZZ_BROKEN ("no memory");
    memcpy (text, data, size);
    pg_status status = mesh_parse (&mesh, &(mesh_file) { "part.msh", text, size });
    FUZZ_EXPECT (status == PG_OK || status == PG_E_FILE);
    if (status == PG_OK) check_mesh (&mesh), check_search (&mesh);
    else FUZZ_EXPECT (strstr (pg_last_error (), "part.msh"));
    pg_mesh_clear (&mesh);
    if (status == PG_OK) check_result (&(mesh_file) { "part.msh", text, size });
    pg_free (text);
    FUZZ_EXPECT (pg_memory_used () == used);
#ifndef FUZZ_REPLAY
    FUZZ_EXPECT (pg_memory_peak () < (size_t) 1 << 26);    /* no more than such a file justifies */
#endif
    return 0;
}

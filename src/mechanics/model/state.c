/* SPDX-License-Identifier: GPL-3.0-or-later
 * The state: displacement coefficients, velocity, acceleration, alive bits, in one block of memory; and its
 * growing cracks in separate memory: 2D paths (crack_paths.c), 3D surfaces (crack_surfaces.c). */
#include "model.h"
#include <string.h>

/* Sets the pointers to the arrays, which follow the struct in one block, so that one copy includes all: d, v,
 * a (ndof each), then the alive bits (nbond bytes). */
static void place (pg_state *s)
{
    char *base = (char *) s + (sizeof *s + 63) / 64 * 64;
    s->d = (double *) (void *) base;
    s->v = s->d + s->ndof;
    s->a = s->v + s->ndof;
    s->alive = (unsigned char *) (s->a + s->ndof);
}

/* Distance below which positions of crack vertices count as equal, m. */
static double nothing_of (const pg_problem *p) { return PG_NO_LENGTH * p->cloud.h; }

pg_status pg_crack_paths_create (pg_crack_paths **out, const pg_problem *p)
{
    return pg_paths_of (out, &p->crack.given, p->crack.tip, p->crack.ntip, nothing_of (p));
}

pg_status pg_crack_surfaces_create (pg_crack_surfaces **out, const pg_problem *p)
{
    return pg_surfaces_of (out, &p->crack.given, p->crack.front, p->crack.nfront, nothing_of (p));
}

/* Checkpoints of cracks; upper bounds of their sizes: every 2D facet has cut at least one bond; 3D surfaces
 * have at most a hundred vertices per bond. */
pg_status pg_crack_paths_keep (pg_crack_paths *w, const pg_problem *p, const char *name, const pg_keeper *k)
{
    return pg_paths_keep (w, (long) (p->crack.given.n + p->crack.ntip + p->bonds.first[PG_BOND_SETS]), name,
                          k);
}

pg_status pg_crack_surfaces_keep (pg_crack_surfaces *w, const pg_problem *p, const char *name,
                                  const pg_keeper *k)
{
    return pg_surfaces_keep (w, 1000 + 100 * (long) (p->crack.given.n + p->bonds.first[PG_BOND_SETS]), name,
                             k);
}

/* Creates the initial state: bonds across pre-cracks broken, initial velocities of the scene (zero if
 * `components` differs from the unknowns of the problem). */
pg_status pg_state_create (pg_state **out, const pg_problem *problem, int components)
{
    pg_status status = PG_OK;
    size_t ndof = problem->cloud.n * (size_t) components, nbond = problem->bonds.first[PG_BOND_SETS];
    size_t bytes = (sizeof (pg_state) + 63) / 64 * 64 + 3 * ndof * sizeof (double) + nbond;
    pg_state *s = pg_calloc (bytes, 1);
    if (!s) PG_FAIL (PG_E_MEMORY, "no memory for a state of %zu bytes", bytes);
    s->ndof = ndof, s->nbond = nbond, s->bytes = bytes;
    place (s);
    if (problem->dim == 2) PG_TRY (pg_crack_paths_create (&s->paths, problem));
    if (problem->dim == 3 && pg_problem_grows (problem))
        PG_TRY (pg_crack_surfaces_create (&s->surfaces, problem));
    pg_bonds_cut (problem, s->alive);
    if (components == pg_problem_unknowns (problem)) pg_initial_set (problem, s->v);
    *out = s;
    s = NULL;
done:
    pg_state_free (&s);
    return status;
}

/* Copies paths and surfaces, which may fail, and then the first `bytes` of the block (all, or all before the
 * alive bits). Both states must belong to the same problem. */
static pg_status copy_bytes (pg_state *to, const pg_state *from, size_t bytes)
{
    pg_status status = PG_OK;
    pg_crack_paths *paths = to->paths;
    pg_crack_surfaces *surfaces = to->surfaces;
    if (to->ndof != from->ndof || to->nbond != from->nbond || !paths != !from->paths
        || !surfaces != !from->surfaces)
        PG_FAIL (PG_E_USAGE, "the states belong to different problems");
    if (paths) PG_TRY (pg_crack_paths_copy (paths, from->paths));
    if (surfaces) PG_TRY (pg_crack_surfaces_copy (surfaces, from->surfaces));
    memcpy (to, from, bytes);
    place (to);
    to->paths = paths, to->surfaces = surfaces;
done:
    return status;
}

pg_status pg_state_copy (pg_state *to, const pg_state *from) { return copy_bytes (to, from, from->bytes); }

pg_status pg_state_copy_fields (pg_state *to, const pg_state *from)
{
    return copy_bytes (to, from, (size_t) (from->alive - (const unsigned char *) from));
}

void pg_state_free (pg_state **state)
{
    if (*state) pg_crack_paths_free (&(*state)->paths), pg_crack_surfaces_free (&(*state)->surfaces);
    pg_free (*state), *state = NULL;
}

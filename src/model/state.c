/* SPDX-License-Identifier: GPL-3.0-or-later
 * The state: displacement coefficients, velocity, acceleration, alive bits, in one block. */
#include "model.h"
#include <string.h>

/* The arrays lie behind the struct, each after the other, so that one copy takes all. */
static void place (pg_state *s)
{
    char *base = (char *) s + (sizeof *s + 63) / 64 * 64;
    s->d = (double *) (void *) base;
    s->v = s->d + s->ndof;
    s->a = s->v + s->ndof;
    s->alive = (unsigned char *) (s->a + s->ndof);
}

/* One block of memory. */
pg_status pg_state_create (pg_state **out, const pg_problem *problem, int components)
{
    pg_status status = PG_OK;
    size_t ndof = problem->cloud.n * (size_t) components, nbond = problem->first_bond[PG_BOND_SETS];
    size_t bytes = (sizeof (pg_state) + 63) / 64 * 64 + 3 * ndof * sizeof (double) + nbond;
    pg_state *s = pg_calloc (bytes, 1);
    if (!s) PG_FAIL (PG_E_MEMORY, "no memory for a state of %zu bytes", bytes);
    s->ndof = ndof, s->nbond = nbond, s->bytes = bytes;
    place (s);
    pg_bonds_cut (problem, s->alive);
    if (components == pg_problem_unknowns (problem)) pg_initial_set (problem, s->v);
    *out = s;
done:
    return status;
}

/* Both states must be of one problem. */
pg_status pg_state_copy (pg_state *to, const pg_state *from)
{
    if (to->ndof != from->ndof || to->nbond != from->nbond)
        return pg_error (PG_E_USAGE, PG_HERE, "the states belong to different problems");
    memcpy (to, from, from->bytes);
    place (to);
    return PG_OK;
}

const pg_cracks *pg_state_cracks (const pg_problem *problem, const pg_state *state)
{
    (void) state;                                      /* pre-cracks do not change */
    return &problem->cracks;
}

void pg_state_free (pg_state **state) { pg_free (*state), *state = NULL; }

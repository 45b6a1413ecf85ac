/* SPDX-License-Identifier: GPL-3.0-or-later
 * The list of forces (list.h), and problems that may have any of them: pg_problem_prepare hands the list to
 * the model, which knows no force by itself. */
#include "perigal/force.h"
#include <string.h>

#define PG_FORCE(name) extern const pg_force_type pg_force_##name;
#include "list.h"
#undef PG_FORCE

static const pg_force_type *const entries[] = {
#define PG_FORCE(name) &pg_force_##name,
#include "list.h"
#undef PG_FORCE
};

static const pg_method *const methods[] = {
#define PG_FORCE(name) &pg_force_##name.method,
#include "list.h"
#undef PG_FORCE
    NULL
};

enum { COUNT = sizeof entries / sizeof *entries };

const pg_method *const *pg_force_methods (void) { return methods; }

/* Finds a force by its name in the scene; NULL: there is none. */
const pg_force_type *pg_force_find (const char *name)
{
    for (size_t i = 0; name && i < COUNT; i++)
        if (strcmp (entries[i]->method.name, name) == 0) return entries[i];
    return NULL;
}

/* The problem keeps the descriptor of the entry, which identifies it. */
const pg_force_type *pg_force_of (const pg_problem *problem)
{
    for (size_t i = 0; i < COUNT; i++) if (&entries[i]->method == problem->method) return entries[i];
    return NULL;
}

pg_status pg_force_assemble (const pg_force_type *force, void *self, const pg_sparse **K)
{
    const pg_sparse *own = NULL;
    pg_status status = force->matrix ? force->matrix (self, PG_MATRIX_ASSEMBLED, &own) : PG_OK;
    if (K) *K = own;
    return status;
}

const pg_sparse *pg_force_matrix (const pg_force_type *force, void *self)
{
    const pg_sparse *K = NULL;
    return force->matrix && force->matrix (self, PG_MATRIX_AT_HAND, &K) == PG_OK ? K : NULL;
}

/* Names of all forces, for choices of keys and messages: "galerkin|bond|...". */
const char *pg_force_names (void)
{
    static const char names[] = ""
#define PG_FORCE(name) "|" #name
#include "list.h"
#undef PG_FORCE
    ;
    return names + 1;
}

/* ---- keys of the scene --------------------------------------------------------------------------------- */
static const char *name_of (size_t i) { return i < COUNT ? entries[i]->method.name : NULL; }
static pg_key_tables keys_of (size_t i) { return entries[i]->method.keys; }
const pg_key_catalogue pg_entry_keys_force = { .selector = "method.force", .name = name_of, .keys = keys_of };

static const pg_key keys[] = {
    { .path = "method.force",
      .kind = PG_NAME,
      .fallback = PG_FIRST_CHOICE,
      .choices_of = pg_force_names,
      .doc = "How bonds make forces; `perigal list` says what each of these is." },
    { .path = "method.accept_inexact",
      .kind = PG_BOOL,
      .fallback = "off",
      .doc = "Run although the patch test of the discretisation, which every run makes, is off by more "
             "than 50 % (report.json: patch_error)." },
};
const pg_key_table pg_keys_force = { "force", keys, sizeof keys / sizeof *keys };

/* ---- problems ------------------------------------------------------------------------------------------ */
/* Hands the descriptors of all forces down to the model. */
pg_status pg_problem_prepare (pg_problem **out, const pg_scene *scene, int threads)
{
    return pg_problem_prepare_with (out, scene, methods, threads);
}

/* Prepares and completes a problem in one call, for programs that check nothing in between. */
pg_status pg_problem_build (pg_problem **out, const pg_scene *scene, int threads)
{
    pg_status status = PG_OK;
    pg_problem *p = NULL;
    PG_TRY (pg_problem_prepare (&p, scene, threads));
    PG_TRY (pg_problem_complete (p, scene));
    *out = p;
    p = NULL;
done:
    pg_problem_free (&p);
    return status;
}

void pg_bond_group_clear (pg_bond_group *group)
{
    pg_free (group->bond), pg_free (group->owner), pg_free (group->node);
    for (int set = 0; set < PG_BOND_SETS; set++) pg_free (group->point[set]);
    memset (group, 0, sizeof *group);
}

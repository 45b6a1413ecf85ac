/* SPDX-License-Identifier: GPL-3.0-or-later
 * The key tables of all folders, from list.h. */
#include "perigal/scene.h"
#include <pthread.h>

#define PG_KEYS(folder) extern const pg_key_table pg_keys_##folder;
#include "list.h"
#undef PG_KEYS

static const pg_key_table *const known[] = {
#define PG_KEYS(folder) &pg_keys_##folder,
#include "list.h"
#undef PG_KEYS
};

static pg_key_table tables[sizeof known / sizeof *known];
static pthread_once_t once = PTHREAD_ONCE_INIT;

static void gather (void)
{
    for (size_t k = 0; k < sizeof known / sizeof *known; k++) tables[k] = *known[k];
}

const pg_key_table *pg_scene_tables (size_t *n)
{
    pthread_once (&once, gather);
    *n = sizeof known / sizeof *known;
    return tables;
}

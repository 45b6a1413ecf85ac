/* SPDX-License-Identifier: GPL-3.0-or-later
 * The list of forces. */
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

const pg_force_type *pg_force_find (const char *name)
{
    for (size_t i = 0; i < sizeof entries / sizeof *entries; i++)
        if (strcmp (entries[i]->name, name) == 0) return entries[i];
    return NULL;
}

const char *pg_force_names (void)
{
    static const char names[] = ""
#define PG_FORCE(name) "|" #name
#include "list.h"
#undef PG_FORCE
    ;
    return names + 1;
}

void pg_work_balance_clear (pg_work_balance *work_balance)
{
    pg_free (work_balance->force), pg_free (work_balance->displacement), pg_free (work_balance->reaction);
    memset (work_balance, 0, sizeof *work_balance);
}

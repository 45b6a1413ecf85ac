/* SPDX-License-Identifier: GPL-3.0-or-later
 * The list of integrations. */
#include "perigal/integration.h"
#include <string.h>

#define PG_INTEGRATION(name) extern const pg_integration_type pg_integration_##name;
#include "list.h"
#undef PG_INTEGRATION

static const pg_integration_type *const entries[] = {
#define PG_INTEGRATION(name) &pg_integration_##name,
#include "list.h"
#undef PG_INTEGRATION
};
enum { COUNT = sizeof entries / sizeof *entries };

const pg_integration_type *pg_integration_find (const char *name)
{
    for (size_t i = 0; i < COUNT; i++) if (strcmp (entries[i]->name, name) == 0) return entries[i];
    return NULL;
}

const char *pg_integration_names (void)
{
    static const char names[] = ""
#define PG_INTEGRATION(name) "|" #name
#include "list.h"
#undef PG_INTEGRATION
    ;
    return names + 1;
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * Declarations of all criteria, expanded from list.h, and the check of their keys. */
#ifndef PERIGAL_CRITERION_ENTRIES_H
#define PERIGAL_CRITERION_ENTRIES_H
#include "perigal/criterion.h"
#define PG_CRITERION(name) extern const pg_criterion_type pg_criterion_##name;
#include "list.h"
#undef PG_CRITERION

/* Faults for keys of `failure` that the criterion `name` needs and lacks, and for given ones that it would ignore.
 * needs, takes: "|key|key|" (needed ones; allowed ones). */
void pg_criterion_demand (const pg_scene *scene, const char *name, const char *needs, const char *takes);
#endif

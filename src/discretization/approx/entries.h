/* SPDX-License-Identifier: GPL-3.0-or-later
 * Declarations of all approximations, expanded from list.h. */
#ifndef PERIGAL_APPROX_ENTRIES_H
#define PERIGAL_APPROX_ENTRIES_H
#include "perigal/approx.h"
#define PG_APPROX(name) extern const pg_approx_type pg_approx_##name;
#include "list.h"
#undef PG_APPROX
#endif

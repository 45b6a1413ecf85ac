/* SPDX-License-Identifier: GPL-3.0-or-later
 * Declarations of all materials, expanded from list.h. */
#ifndef PERIGAL_MATERIAL_ENTRIES_H
#define PERIGAL_MATERIAL_ENTRIES_H
#include "perigal/material.h"
#define PG_MATERIAL(name) extern const pg_material_type pg_material_##name;
#include "list.h"
#undef PG_MATERIAL
#endif

/* SPDX-License-Identifier: GPL-3.0-or-later
 * Declarations of all writers of fields, expanded from list.h. */
#ifndef PERIGAL_OUTPUT_ENTRIES_H
#define PERIGAL_OUTPUT_ENTRIES_H
#include "perigal/output.h"
#define PG_WRITER(name) extern const pg_writer pg_writer_##name;
#include "list.h"
#undef PG_WRITER
#endif

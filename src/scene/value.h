/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: checks of single values, lists of numbers and lists of names. */
#ifndef PG_SCENE_VALUE_H
#define PG_SCENE_VALUE_H
#include "document.h"

/* Room for a path in messages, in bytes. */
enum { PG_PATH_TEXT = 512 };

/* Origin (pg_node.origin) of the nodes made from defaults. */
extern const char pg_default_origin[];
/* Checks a node against its row: fills node->key, value and spacing; errors become faults. */
pg_status pg_value_check (pg_scene *s, pg_node *node, const pg_key *row, const char *path);
#endif

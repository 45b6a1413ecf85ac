/* SPDX-License-Identifier: GPL-3.0-or-later
 * value.h: checks of single values, lists of numbers and lists of names. */
#ifndef PG_SCENE_VALUE_H
#define PG_SCENE_VALUE_H
#include "document.h"

enum { PG_PATH_TEXT = 512 };

extern const char pg_default_origin[];                 /* origin of the nodes made from defaults */
/* Fills node->key, value and spacing; what is wrong becomes a fault. */
pg_status pg_value_check (pg_scene *s, pg_node *node, const pg_key *row, const char *path);
#endif

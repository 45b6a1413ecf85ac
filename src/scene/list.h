/* SPDX-License-Identifier: GPL-3.0-or-later
 * One line per folder that brings keys of the scene file (const pg_key_table pg_keys_<folder>, in src/<folder>/keys.c). */
PG_KEYS (scene)

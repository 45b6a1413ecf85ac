/* SPDX-License-Identifier: GPL-3.0-or-later
 * One line per folder that adds keys of the input file (const pg_key_table pg_keys_<folder>, in
 * src/<folder>/keys.c; those of the section `reference` in reference.c), and one per folder whose catalogue
 * entries add keys of their own (const pg_key_catalogue pg_entry_keys_<folder>). */
PG_KEYS (scene)
PG_KEYS (material)
PG_ENTRY_KEYS (material)
PG_KEYS (criterion)
PG_ENTRY_KEYS (criterion)
PG_KEYS (approx)
PG_KEYS (cloud)
PG_KEYS (cells)
PG_KEYS (force)
PG_ENTRY_KEYS (force)
PG_KEYS (model)
PG_KEYS (contact)
PG_KEYS (solve)
PG_ENTRY_KEYS (solve)
PG_KEYS (reference)
PG_KEYS (results)

/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: pieces of cracks. Files: pieces.c (paths in the plane, rows of all pieces), surface_pieces.c
 * (surfaces in space). */
#ifndef PG_CONTACT_PIECES_H
#define PG_CONTACT_PIECES_H
#include "perigal/contact.h"

/* The pieces of surfaces; `out` is empty, first[0] has its room. */
pg_status surface_pieces_create (pg_contact_pieces *out, const pg_problem *problem, const pg_state *state);
#endif

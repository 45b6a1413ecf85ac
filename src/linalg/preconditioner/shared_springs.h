/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: stiff springs of an element preconditioner (pg_elements.W) that ranks share. */
#ifndef PG_SHARED_SPRINGS_H
#define PG_SHARED_SPRINGS_H
#include "perigal/linalg.h"

/* Gives every rank the springs of all ranks (each belongs to the rank that owns its node), one rank after the
 * other. e->W then has a column for each of them, with rows of owned nodes only, so that sums over ranks of
 * W' x are those of the whole body; e->held has all stiffnesses; e->holds is freed. whole: the columns in
 * full, with rows numbered among those that any spring has. All ranks must call. */
pg_status springs_share (pg_elements *e, const pg_subdomain *part, pg_sparse *whole);
#endif

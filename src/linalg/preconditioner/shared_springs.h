/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: stiff springs of an element preconditioner (pg_elements.W) that ranks share. */
#ifndef PG_SHARED_SPRINGS_H
#define PG_SHARED_SPRINGS_H
#include "perigal/linalg.h"

/* Every rank gets the springs of all, those of a rank being the ones whose node it owns, one rank after the
 * other. e->W then has a column for each of them, with rows of owned nodes only, so that sums over ranks of
 * W' x are those of the whole body; e->held all stiffnesses; e->holds is gone. whole: the columns in full,
 * rows being numbered among those that any spring has. All ranks call. */
pg_status springs_share (pg_elements *e, const pg_subdomain *part, pg_sparse *whole);
#endif

/* SPDX-License-Identifier: GPL-3.0-or-later
 * A preconditioner that all ranks of a run build and apply together is set by the program (src/app/mpi). */
#include "perigal/linalg.h"

static const pg_shared_preconditioner *given;

void pg_shared_preconditioner_give (const pg_shared_preconditioner *type) { given = type; }
const pg_shared_preconditioner *pg_shared_preconditioner_now (void) { return given; }

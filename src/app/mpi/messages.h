/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private to perigal-mpi: the messages of ranks (perigal/ranks.h) by MPI. */
#ifndef PG_MPI_MESSAGES_H
#define PG_MPI_MESSAGES_H
#include "perigal/ranks.h"

/* Makes this process a rank of MPI_COMM_WORLD, and ends that. Errors of MPI become a status and do not end
 * the process. */
void mpi_join  (void);
void mpi_leave (void);
#endif

/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private to perigal-mpi: the messages of ranks (perigal/ranks.h) by MPI. */
#ifndef PG_MPI_MESSAGES_H
#define PG_MPI_MESSAGES_H
#include "perigal/ranks.h"

/* From now on this process is a rank of MPI_COMM_WORLD. An error of MPI is a status, not the end. */
void mpi_join  (void);
void mpi_leave (void);
#endif

/* SPDX-License-Identifier: GPL-3.0-or-later
 * Declarations of all influence functions, expanded from list.h. */
#ifndef PERIGAL_KERNEL_ENTRIES_H
#define PERIGAL_KERNEL_ENTRIES_H
#include "perigal/kernel.h"
#define PG_KERNEL(name) extern const pg_kernel pg_kernel_##name;
#include "list.h"
#undef PG_KERNEL
#endif

/* SPDX-License-Identifier: GPL-3.0-or-later
 * The fast convolution-based method (Jafarzadeh et al. 2022; theory B): the forces of bonds, whose sums are
 * by FFT and whose points die by energy unless the scene says otherwise (src/model/direct.c: customs). */
#include "bond.h"

const pg_force_type pg_force_fcbm = {
    .name = "fcbm", .summary = "bond, summed by FFT; points die by energy (Jafarzadeh 2022)", BOND_ENTRIES
};

/* SPDX-License-Identifier: GPL-3.0-or-later
 * One line per influence function: src/discretization/kernel/<name>.c ends in `const pg_kernel
 * pg_kernel_<name>`. */
PG_KERNEL (cubic_spline)
PG_KERNEL (constant)
PG_KERNEL (quadratic)
PG_KERNEL (conical)
PG_KERNEL (linear_r)
PG_KERNEL (inverse_r)
PG_KERNEL (quartic_spline)
PG_KERNEL (gaussian)

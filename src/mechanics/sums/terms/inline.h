/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: directives to the compiler in loops of all instruction sets. UNROLL: unrolls short loops of
 * constant length. INLINE: functions become part of the loop that calls them, compiled for the instruction
 * set TARGET of the including file. */
#ifndef PG_SUMS_INLINE_H
#define PG_SUMS_INLINE_H
#ifdef __clang__
#define UNROLL _Pragma ("unroll")
#else
#define UNROLL _Pragma ("GCC unroll 32")
#endif
#define INLINE static inline __attribute__ ((always_inline)) TARGET
#endif

/* SPDX-License-Identifier: GPL-3.0-or-later
 * list_laws.h: the loops over lists of bonds (private). Each line is a loop: a law's header says what it
 * sums over the bonds of a point, list_kernel.h makes a function of it for every dimension and instruction
 * set. A new law is its header, included by list_instances.h, and a line here. */
#ifndef PERIGAL_SUMS_LIST_LAWS_H
#define PERIGAL_SUMS_LIST_LAWS_H
#define LIST_LAWS(LOOP) \
    LOOP (pair_linear)                    /* law_pair.h: forces along bonds of small displacements */ \
    LOOP (pair_finite)                    /* law_pair.h: forces along bonds of finite displacements */ \
    LOOP (state_dilate)                   /* law_state.h: dilatations */ \
    LOOP (state_pull)                     /* law_state.h: forces from dilatations */ \
    LOOP (state_store)                    /* law_state.h: energies */ \
    LOOP (beam_force)                     /* law_beam.h: forces and moments of beams */ \
    LOOP (beam_store)                     /* law_beam.h: energies of beams */
#define LIST_LOOP_NAME(law) LIST_##law,
enum { LIST_LAWS (LIST_LOOP_NAME) LIST_LOOPS };

/* Indices of the constants of beams (bond_list.constant): lever (1/m), 1 / length (1/m), step of positions
 * along each axis (m, or 1), 1: any single limit breaks a bond. */
enum { BEAM_LEVER, BEAM_PER_LENGTH, BEAM_STEP, BEAM_SINGLE = BEAM_STEP + 3 };
#endif

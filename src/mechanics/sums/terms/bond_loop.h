/* SPDX-License-Identifier: GPL-3.0-or-later
 * bond_loop.h: kinds of loops over bonds (private): each kind defines one pg_bond_loop_kind, bond_loop.c
 * chooses among them. */
#ifndef PERIGAL_SUMS_SWEEP_H
#define PERIGAL_SUMS_SWEEP_H
#include "perigal/sums.h"

/* Instruction sets, slowest first. PG_AVX2 means avx2 and fma, PG_AVX512 means avx512 f, bw, dq, vl in
 * addition. */
typedef enum { PG_SCALAR, PG_AVX2, PG_AVX512, PG_INSTRUCTION_SETS } pg_instructions;
const char *pg_instructions_name (pg_instructions set);
/* 1: this machine and the compiler have this instruction set. */
int         pg_instructions_here (pg_instructions set);

typedef struct {
    const char *name;                                  /* "stencil", "list", "fft" */
    /* Theory: 0: bond-based; 1: state-based; 2: micropolar bonds (beams); 3: beams and dilatation. */
    int state;
    /* NULL: this kind can sum what the setting asks for; else why not ("surface factor of volumes"). */
    const char *(*refusal) (const pg_bond_loop_setting *setting);
    /* Makes a loop with all bonds of the family intact. `set` is available on this machine. The struct
     * `setting` has to be copied: what it points to exists as long as self, the struct itself may not. */
    pg_status (*create) (void **self, const pg_bond_loop_setting *setting, pg_instructions set);
    void      (*free)   (void *self);                  /* takes NULL and loops that are made in part */
    void      (*bytes)  (const void *self, double *per_bond, double *per_point);
    void      (*update) (void *self, const unsigned char *alive, const pg_changes *changes);
    pg_status (*force)  (void *self, const double *u, double *f, pg_changes *broken);
    double    (*energy) (void *self, const double *u);
    pg_status (*energies) (void *self, const double *u, double *W);
    /* Returns the estimated time of a sum on one thread, ns, for settings that are not refused; NULL:
     * unknown. */
    double    (*time) (const pg_bond_loop_setting *setting, pg_instructions set);
    const char *(*remark) (const void *self);          /* a remark for reports; NULL: none */
    void      (*counts) (const void *self, pg_bond_loop_counts *out);        /* NULL: none */
    int apart;                                         /* 1: sums differences of u bond by bond */
    int plain;                                         /* 1: its name has no instruction set */
    /* pg_bond_loop_dilatation; NULL: the theory has no dilatation */
    pg_status (*dilatation) (void *self, const double *u, double *theta, double *q);
} pg_bond_loop_kind;
extern const pg_bond_loop_kind pg_bond_loop_stencil, pg_bond_loop_list, pg_bond_loop_fft,
    pg_bond_loop_state_stencil, pg_bond_loop_state_list, pg_bond_loop_state_fft, pg_bond_loop_beam_stencil,
    pg_bond_loop_beam_list, pg_bond_loop_beam_volume;

/* Appends n bonds (in any order, none twice) to `to`, in ascending order; sorts `bond`. */
pg_status pg_changes_append (pg_changes *to, size_t n, size_t *bond);
/* Appends the bonds that all threads have found to `to`, in ascending order; returns the error of a thread
 * that could not list its own. Clears `found` and `failed` in any case. */
pg_status pg_changes_collect (pg_changes *to, int threads, pg_changes *found, pg_status *failed);
#endif

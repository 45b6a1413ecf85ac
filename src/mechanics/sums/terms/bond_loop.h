/* SPDX-License-Identifier: GPL-3.0-or-later
 * bond_loop.h: how the loops over bonds hang together (private): a kind of loop fills one pg_bond_loop_kind,
 * bond_loop.c chooses among them. */
#ifndef PERIGAL_SUMS_SWEEP_H
#define PERIGAL_SUMS_SWEEP_H
#include "perigal/sums.h"

/* Instruction sets, worst first. PG_AVX2 means avx2 and fma, PG_AVX512 means avx512 f, bw, dq, vl on top of
 * these. */
typedef enum { PG_SCALAR, PG_AVX2, PG_AVX512, PG_INSTRUCTION_SETS } pg_instructions;
const char *pg_instructions_name (pg_instructions set);
/* 1: this machine has them and this compiler knew them */
int         pg_instructions_here (pg_instructions set);

typedef struct {
    const char *name;                                  /* "stencil", "list", "fft" */
    /* 1: of state-based theory, for rules that say so; 2: of beams; 3: of both; 0: of bonds alone */
    int state;
    /* NULL: this kind can sum what the setting asks for; else why not ("surface factor of volumes"). */
    const char *(*refusal) (const pg_bond_loop_setting *setting);
    /* `set` is there on this machine. The setting has been copied: what it points to lives as long as self,
     * the struct itself may not. Starts with all bonds of the family alive. */
    pg_status (*create) (void **self, const pg_bond_loop_setting *setting, pg_instructions set);
    void      (*free)   (void *self);                  /* NULL-safe, frees half-built ones */
    void      (*bytes)  (const void *self, double *per_bond, double *per_point);
    void      (*update) (void *self, const unsigned char *alive, const pg_changes *changes);
    pg_status (*force)  (void *self, const double *u, double *f, pg_changes *broken);
    double    (*energy) (void *self, const double *u);
    pg_status (*energies) (void *self, const double *u, double *W);
    /* about, ns a sum on one thread, of what is not refused; NULL: unknown */
    double    (*time) (const pg_bond_loop_setting *setting, pg_instructions set);
    const char *(*remark) (const void *self);          /* what else to say about it; NULL: nothing */
    void      (*counts) (const void *self, pg_bond_loop_counts *out);        /* NULL: none */
    int apart;                                         /* 1: sums differences of u bond by bond */
    int plain;                                         /* 1: the same loop whatever the instructions */
    pg_status (*dilatation) (void *self, const double *u, double *theta, double *q);  /* state-based only */
} pg_bond_loop_kind;
extern const pg_bond_loop_kind pg_bond_loop_stencil, pg_bond_loop_list, pg_bond_loop_fft,
    pg_bond_loop_state_stencil, pg_bond_loop_state_list, pg_bond_loop_state_fft, pg_bond_loop_beam_stencil,
    pg_bond_loop_beam_list, pg_bond_loop_beam_volume;

/* Adds n bonds (any order, none twice) to the end of `to`, ascending among themselves; sorts `bond`. */
pg_status pg_changes_append (pg_changes *to, size_t n, size_t *bond);
/* Adds the bonds that each thread has found to the end of `to`, ascending; returns the failure of a thread
 * that could not note its own. Leaves nothing found and nothing failed, whatever it returns. */
pg_status pg_changes_collect (pg_changes *to, int threads, pg_changes *found, pg_status *failed);
#endif

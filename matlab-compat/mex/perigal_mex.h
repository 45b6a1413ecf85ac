/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: what the files of the gateway share. Commands check their arguments, call the library, and return 0,
 * or 1 after `fault`: the gateway raises the error when everything has been released, since raising it leaves
 * C by a jump. What a command allocates in the library is held by `hold`, which outlives such a jump. */
#ifndef PERIGAL_MEX_H
#define PERIGAL_MEX_H
#include "mex.h"
#include "perigal.h"

/* Arguments and results of a command, without its name. */
typedef struct { int nout; mxArray **out; int nin; const mxArray **in; const char *command; } call;

/* Records the error that the call ends with; returns 1. */
int fault (const char *id, const char *format, ...);
/* The same with the library's message and the identifier that belongs to the status; PG_OK: returns 0. */
int failed (const call *c, pg_status status);
/* Zeroed memory that is released when the call ends: by `clear`, then freed. NULL after a fault. */
void *hold (size_t bytes, void (*clear) (void *));

/* ---- arguments: number k from 0; `what` names it in messages ------------------------------------------- */
int take_count   (const call *c, int least, int most);
int take_number  (const call *c, int k, const char *what, double *out);
int take_integer (const call *c, int k, const char *what, double low, double high, int *out);
/* A text, to be found in *out until the call ends; an empty one gives NULL. */
int take_text    (const call *c, int k, const char *what, const char **out);
/* Number of a word in "a|b|c". */
int take_word    (const call *c, int k, const char *what, const char *words, int *out);
/* A full real array of doubles with that number of columns (0: any), row-major in *out until the call ends.
 * Empty: *out NULL and no rows, where that may be. */
int take_matrix  (const call *c, int k, const char *what, size_t columns, int empty, size_t *rows, size_t *found,
                  double **out);
/* A logical or real vector of n entries as bytes 0, 1. */
int take_flags   (const call *c, int k, const char *what, size_t n, unsigned char **out);

/* ---- results: number k from 0 -------------------------------------------------------------------------- */
/* rows x columns from a row-major array. */
mxArray *full_of   (size_t rows, size_t columns, const double *value);
/* The whole of a sparse matrix, both triangles where it is symmetric. */
mxArray *sparse_of (const pg_sparse *A);
mxArray *number_of (double value);
void     give      (const call *c, int k, mxArray *value);
/* Adds a field to a structure. */
void     put       (mxArray *s, const char *name, mxArray *value);

/* ---- handles ------------------------------------------------------------------------------------------- */
enum { KIND_SESSION, KIND_BONDS };
/* The object of a handle of that kind; NULL after a fault. */
void *take_handle (const call *c, int k, int kind);
/* A new handle for an object, which the table frees. NULL after a fault, the object is freed then. */
mxArray *give_handle (int kind, void *object);

/* ---- commands ------------------------------------------------------------------------------------------ */
int command_length (const call *c);
int command_family (const call *c);
int command_shape (const call *c);
int command_constants (const call *c);
int command_bonds_open (const call *c);
int command_bonds_force (const call *c);
int command_bonds_list (const call *c);
int command_bonds_mask (const call *c);
int command_open (const call *c);
int command_about (const call *c);
int command_step (const call *c);
int command_field (const call *c);
int command_state (const call *c);
int command_bonds (const call *c);
int command_set (const call *c);
int command_cut (const call *c);
int command_save (const call *c);
int command_restore (const call *c);
int command_equations (const call *c);
int command_close (const call *c);
int command_handles (const call *c);
#endif

/* SPDX-License-Identifier: GPL-3.0-or-later
 * The gateway of MATLAB and Octave to libperigal: [...] = perigal_mex (COMMAND, ...). The functions of
 * matlab-compat call it and explain themselves; it is not meant to be called by hand.
 *
 * Plain C MEX API, in what Octave and MATLAB have in common: real arrays only, so that neither separate nor
 * interleaved complex numbers matter; mwSize and mwIndex throughout. `make mex` builds it. */
#include "perigal_mex.h"
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* ---- errors -------------------------------------------------------------------------------------------- */
static struct { char id[32], text[16384]; } wrong;

int fault (const char *id, const char *format, ...)
{
    va_list args;
    va_start (args, format);
    vsnprintf (wrong.text, sizeof wrong.text, format, args);
    va_end (args);
    snprintf (wrong.id, sizeof wrong.id, "%s", id);
    return 1;
}

/* Three families: the scene, wrong arguments, everything else. */
int failed (const call *c, pg_status status)
{
    const char *id = status == PG_E_SCENE   ? "perigal:scene"
                     : status == PG_E_USAGE ? "perigal:argument"
                                            : "perigal:failed";
    (void) c;
    return status == PG_OK ? 0 : fault (id, "%s", pg_last_error ());
}

/* ---- what a call holds --------------------------------------------------------------------------------- */
enum { MOST_HELD = 4096 };
static struct { void *object; void (*clear) (void *); } held[MOST_HELD];
static int nheld;

static void release (void)
{
    while (nheld > 0) {
        nheld--;
        if (held[nheld].clear) held[nheld].clear (held[nheld].object);
        pg_free (held[nheld].object);
    }
}

void *hold (size_t bytes, void (*clear) (void *))
{
    void *object = nheld < MOST_HELD ? pg_calloc (1, bytes) : NULL;
    if (!object) {
        fault ("perigal:failed", "no memory for %zu bytes", bytes);
        return NULL;
    }
    held[nheld].object = object, held[nheld].clear = clear;
    nheld++;
    return object;
}

/* ---- handles ------------------------------------------------------------------------------------------- */
/* The table: numbers are never used twice, so that an old handle is known as such. */
typedef struct { uint64_t number; int kind; void *object; } entry;
static entry *table;
static size_t nentry, room;
static uint64_t last;

static void destroy (entry *e)
{
    if (e->kind == KIND_SESSION) {
        pg_session *s = e->object;
        pg_session_close (&s);
    } else {
        pg_bond_sum *s = e->object;
        pg_bond_sum_free (&s);
    }
}

/* On `clear mex`, `clear functions` and at the end of the program. */
static void clear_all (void)
{
    release ();
    for (size_t k = 0; k < nentry; k++) destroy (&table[k]);
    pg_free (table);
    table = NULL, nentry = room = 0;
}

/* 1: the argument is a whole number that a handle may be. */
static int read_handle (const mxArray *a, uint64_t *number)
{
    *number = 0;
    if (mxGetNumberOfElements (a) != 1 || mxIsComplex (a) || mxIsSparse (a)) return 0;
    if (mxIsUint64 (a)) memcpy (number, mxGetData (a), sizeof *number);
    else if (mxIsDouble (a)) {
        double value = mxGetScalar (a);
        if (!(value >= 1) || !(value < 9e15) || value != (double) (uint64_t) value) return 0;
        *number = (uint64_t) value;
    } else return 0;
    return 1;
}

static entry *find (const mxArray *a)
{
    uint64_t number;
    if (!read_handle (a, &number)) return NULL;
    for (size_t k = 0; k < nentry; k++) if (table[k].number == number) return &table[k];
    return NULL;
}

void *take_handle (const call *c, int k, int kind)
{
    static const char *const from[] = { "perigal_session", "perigal_bonds or perigal_fcbm" };
    entry *e = k < c->nin ? find (c->in[k]) : NULL;
    if (e && e->kind == kind) return e->object;
    fault ("perigal:argument", "an open handle of %s is needed: this is %s", from[kind],
           e ? "one of another kind" : "none, or one that was closed");
    return NULL;
}

mxArray *give_handle (int kind, void *object)
{
    const mwSize one[2] = { 1, 1 };
    entry now = { last + 1, kind, object };
    if (nentry == room) {
        entry *more = pg_resize (table, 2 * room + 8, sizeof *table);
        if (!more) {
            destroy (&now);
            fault ("perigal:failed", "no memory for another handle");
            return NULL;
        }
        table = more, room = 2 * room + 8;
    }
    table[nentry++] = now, last++;
    mxArray *a = mxCreateNumericArray (2, one, mxUINT64_CLASS, mxREAL);
    memcpy (mxGetData (a), &now.number, sizeof now.number);
    return a;
}

/* Any kind. */
int command_close (const call *c)
{
    if (take_count (c, 1, 1)) return 1;
    entry *e = find (c->in[0]);
    if (!e) return fault ("perigal:argument", "this is no open handle");
    destroy (e);
    *e = table[--nentry];
    return 0;
}

/* How many are open, and the bytes that the library holds. */
int command_handles (const call *c)
{
    if (take_count (c, 0, 0)) return 1;
    give (c, 0, number_of ((double) nentry));
    give (c, 1, number_of ((double) pg_memory_used ()));
    return 0;
}

/* ---- the gateway --------------------------------------------------------------------------------------- */
static const struct { const char *name; int (*run) (const call *c); } commands[] = {
    { "length", command_length },           { "family", command_family },
    { "shape", command_shape },             { "constants", command_constants },
    { "bonds_open", command_bonds_open },   { "bonds_force", command_bonds_force },
    { "bonds_list", command_bonds_list },   { "bonds_mask", command_bonds_mask },
    { "open", command_open },               { "about", command_about },
    { "step", command_step },               { "field", command_field },
    { "state", command_state },             { "bonds", command_bonds },
    { "set", command_set },                 { "cut", command_cut },
    { "save", command_save },               { "restore", command_restore },
    { "equations", command_equations },     { "close", command_close },
    { "handles", command_handles },
};

/* Runs the command of that name; 0: it went well. */
static int dispatch (const char *name, call *c)
{
    for (size_t k = 0; k < sizeof commands / sizeof *commands; k++)
        if (strcmp (commands[k].name, name) == 0) {
            c->command = commands[k].name;
            return commands[k].run (c);
        }
    return fault ("perigal:argument", "there is no command '%s'", name);
}

void mexFunction (int nlhs, mxArray *plhs[], int nrhs, const mxArray *prhs[])
{
    char name[32] = "";
    mexAtExit (clear_all);
    release ();                                        /* of a call that was left by a jump */
    call c = { nlhs, plhs, nrhs - 1, prhs + 1, "" };
    int bad = nrhs < 1 || !mxIsChar (prhs[0]) || mxGetString (prhs[0], name, sizeof name) != 0;
    if (bad) fault ("perigal:argument", "the first argument is the name of a command");
    else bad = dispatch (name, &c);
    release ();
    if (bad) mexErrMsgIdAndTxt (wrong.id, "%s", wrong.text);
}

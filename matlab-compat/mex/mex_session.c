/* SPDX-License-Identifier: GPL-3.0-or-later
 * Commands on a scene that is advanced step by step, and its linear system. */
#include "perigal_mex.h"
#include <string.h>

static void clear_equations (void *p) { pg_equations_clear (p); }

/* 'open' (file, {overrides}, threads): handle */
int command_open (const call *c)
{
    const char *path, **set;
    int threads;
    pg_session *s;
    if (take_count (c, 3, 3) || take_text (c, 0, "the scene", &path)) return 1;
    if (!path) return fault ("perigal:argument", "the scene must be the path of a file");
    if (!mxIsCell (c->in[1])) return fault ("perigal:argument", "values that replace others must be a cell");
    if (take_integer (c, 2, "threads", 0, 64, &threads)) return 1;
    size_t n = mxGetNumberOfElements (c->in[1]);
    if (!(set = hold ((n + 1) * sizeof *set, NULL))) return 1;
    for (size_t k = 0; k < n; k++) {
        const mxArray *one = mxGetCell (c->in[1], (mwIndex) k);
        const call inner = { 0, NULL, 1, &one, c->command };
        if (!one || take_text (&inner, 0, "a value that replaces another", &set[k])) return 1;
        if (!set[k]) return fault ("perigal:argument", "a value that replaces another is empty");
    }
    pg_status status = pg_session_open (&s, path, n, set, threads);
    if (status == PG_E_FILE) return fault ("perigal:scene", "%s", pg_last_error ());
    if (failed (c, status)) return 1;
    mxArray *handle = give_handle (KIND_SESSION, s);
    if (!handle) return 1;
    give (c, 0, handle);
    return 0;
}

/* Names of loads, as a column of cells. */
static mxArray *names_of (const pg_problem *p)
{
    mxArray *a = mxCreateCellMatrix ((mwSize) p->boundary.nload, 1);
    for (size_t k = 0; k < p->boundary.nload; k++) mxSetCell (a, (mwIndex) k, mxCreateString (p->boundary.load[k].name));
    return a;
}

static mxArray *warnings_of (const pg_statistics *r)
{
    mxArray *a = mxCreateCellMatrix ((mwSize) r->nwarning, 1);
    for (size_t k = 0; k < r->nwarning; k++) mxSetCell (a, (mwIndex) k, mxCreateString (r->warning[k]));
    return a;
}

/* 'about' (handle): structure */
int command_about (const call *c)
{
    if (take_count (c, 1, 1)) return 1;
    const pg_session *s = take_handle (c, 0, KIND_SESSION);
    if (!s) return 1;
    const pg_problem *p = pg_session_problem (s);
    const pg_state *at = pg_session_state (s);
    const pg_solver_options *o = pg_solver_settled (pg_session_solver (s));
    const pg_statistics *r = pg_solver_report_now (pg_session_solver (s));
    mxArray *a = mxCreateStructMatrix (1, 1, 0, NULL);
    put (a, "title", mxCreateString (p->title));
    put (a, "dimension", number_of (p->dim));
    put (a, "points", number_of ((double) p->cloud.n));
    put (a, "unknowns", number_of ((double) at->ndof));
    put (a, "bonds", number_of ((double) at->nbond));
    put (a, "spacing", number_of (p->cloud.h));
    put (a, "horizon", number_of (p->form.approx.horizon));
    put (a, "thickness", number_of (p->cloud.thickness));
    put (a, "force", mxCreateString (p->method->name));
    put (a, "solver", mxCreateString (o->kind));
    put (a, "time_step", number_of (o->dt));
    put (a, "loads", names_of (p));
    put (a, "place", full_of (p->cloud.n, (size_t) p->dim, p->cloud.x));
    put (a, "point_volume", full_of (p->cloud.n, 1, p->cloud.volume));
    put (a, "step", number_of ((double) at->step));
    put (a, "time", number_of (at->time));
    put (a, "load_factor", number_of (at->factor));
    put (a, "broken", number_of ((double) at->broken));
    put (a, "done", mxCreateLogicalScalar (pg_session_done (s) != 0));
    put (a, "energy_strain", number_of (r->energy.strain));
    put (a, "energy_kinetic", number_of (r->energy.kinetic));
    put (a, "energy_external", number_of (r->energy.external));
    put (a, "energy_dissipated", number_of (r->energy.dissipated));
    put (a, "warnings", warnings_of (r));
    give (c, 0, a);
    return 0;
}

/* Broken bonds of a step, a row each: number of the bond, middle, utilisation. */
static mxArray *broken_of (const pg_step *step)
{
    mxArray *a = mxCreateDoubleMatrix ((mwSize) step->nbroken, 5, mxREAL);
    double *to = mxGetPr (a);
    for (size_t k = 0; k < step->nbroken; k++) {
        const pg_broken *b = &step->broken[k];
        to[k] = (double) b->bond + 1;
        for (size_t i = 0; i < 3; i++) to[(i + 1) * step->nbroken + k] = b->place[i];
        to[4 * step->nbroken + k] = b->utilisation;
    }
    return a;
}

/* 'step' (handle): structure */
int command_step (const call *c)
{
    const pg_step *step;
    if (take_count (c, 1, 1)) return 1;
    pg_session *s = take_handle (c, 0, KIND_SESSION);
    if (!s || failed (c, pg_session_step (s, &step))) return 1;
    const pg_problem *p = pg_session_problem (s);
    const pg_statistics *r = pg_solver_report_now (pg_session_solver (s));
    mxArray *a = mxCreateStructMatrix (1, 1, 0, NULL);
    put (a, "number", number_of ((double) step->number));
    put (a, "time", number_of (step->time));
    put (a, "load_factor", number_of (step->factor));
    put (a, "reaction", full_of (p->boundary.nload, 3, step->reaction));
    put (a, "broken", broken_of (step));
    put (a, "utilisation", number_of (step->utilisation));
    put (a, "dissipated", number_of (step->dissipated));
    put (a, "energy_strain", number_of (r->energy.strain));
    put (a, "energy_kinetic", number_of (r->energy.kinetic));
    put (a, "energy_external", number_of (r->energy.external));
    put (a, "done", mxCreateLogicalScalar (pg_session_done (s) != 0));
    give (c, 0, a);
    return 0;
}

/* 'field' (handle, name): values, unit */
int command_field (const call *c)
{
    const char *name, *unit;
    const double *value;
    int components;
    if (take_count (c, 2, 2)) return 1;
    pg_session *s = take_handle (c, 0, KIND_SESSION);
    if (!s || take_text (c, 1, "the field", &name)) return 1;
    if (failed (c, pg_session_field (s, name ? name : "", &components, &unit, &value))) return 1;
    give (c, 0, full_of (pg_session_problem (s)->cloud.n, (size_t) components, value));
    give (c, 1, mxCreateString (unit));
    return 0;
}

/* 'state' (handle, d|v|a|alive): the vector of all unknowns, or alive bits of all bonds */
int command_state (const call *c)
{
    int which;
    if (take_count (c, 2, 2)) return 1;
    pg_session *s = take_handle (c, 0, KIND_SESSION);
    if (!s || take_word (c, 1, "what", "d|v|a|alive", &which)) return 1;
    const pg_state *at = pg_session_state (s);
    const double *of[] = { at->d, at->v, at->a };
    if (which < 3) give (c, 0, full_of (at->ndof, 1, of[which]));
    else {
        mxArray *a = mxCreateLogicalMatrix ((mwSize) at->nbond, 1);
        for (size_t b = 0; b < at->nbond; b++) mxGetLogicals (a)[b] = at->alive[b] != 0;
        give (c, 0, a);
    }
    return 0;
}

/* 'bonds' (handle): structure with the set (1 point-point, 2 evaluation, 3 facet), the place that sees and the
 * point that is seen of every bond */
int command_bonds (const call *c)
{
    if (take_count (c, 1, 1)) return 1;
    const pg_session *s = take_handle (c, 0, KIND_SESSION);
    if (!s) return 1;
    const pg_problem *p = pg_session_problem (s);
    size_t n = p->bonds.first[PG_BOND_SETS], dim = (size_t) p->dim;
    mxArray *a = mxCreateStructMatrix (1, 1, 0, NULL), *set = mxCreateDoubleMatrix ((mwSize) n, 1, mxREAL),
            *from = mxCreateDoubleMatrix ((mwSize) n, (mwSize) dim, mxREAL),
            *owner = mxCreateDoubleMatrix ((mwSize) n, 1, mxREAL),
            *point = mxCreateDoubleMatrix ((mwSize) n, 1, mxREAL);
    for (int k = 0; k < PG_BOND_SETS; k++) {
        const pg_rows *r = &p->bonds.rows[k];
        for (size_t i = 0; i < r->family.n; i++)
            for (size_t e = r->family.start[i]; e < r->family.start[i + 1]; e++) {
                size_t b = p->bonds.first[k] + e;
                mxGetPr (set)[b] = k + 1, mxGetPr (owner)[b] = (double) i + 1;
                mxGetPr (point)[b] = (double) r->family.node[e] + 1;
                for (size_t m = 0; m < dim; m++) mxGetPr (from)[m * n + b] = r->x[i * dim + m];
            }
    }
    put (a, "set", set);
    put (a, "owner", owner);
    put (a, "place", from);
    put (a, "point", point);
    give (c, 0, a);
    return 0;
}

/* 'set' (handle, displacement|velocity, vector) */
int command_set (const call *c)
{
    const char *what;
    size_t n;
    double *value;
    if (take_count (c, 3, 3)) return 1;
    pg_session *s = take_handle (c, 0, KIND_SESSION);
    if (!s || take_text (c, 1, "what", &what) || take_matrix (c, 2, "the values", 1, 0, &n, NULL, &value))
        return 1;
    return failed (c, pg_session_set (s, what ? what : "", n, value));
}

/* 'cut' (handle, numbers from 1) */
int command_cut (const call *c)
{
    size_t n, *bond;
    double *number;
    if (take_count (c, 2, 2)) return 1;
    pg_session *s = take_handle (c, 0, KIND_SESSION);
    if (!s || take_matrix (c, 1, "numbers of bonds", 1, 1, &n, NULL, &number)) return 1;
    double most = (double) pg_session_state (s)->nbond;
    if (!(bond = hold ((n + 1) * sizeof *bond, NULL))) return 1;
    for (size_t k = 0; k < n; k++) {
        if (!(number[k] >= 1) || !(number[k] <= most) || number[k] != (double) (size_t) number[k])
            return fault ("perigal:argument", "there is no bond %g: they have whole numbers from 1 to %g",
                          number[k], most);
        bond[k] = (size_t) number[k] - 1;
    }
    return failed (c, pg_session_cut (s, n, bond));
}

/* A block of the library that a call holds. */
typedef struct { void *block; } boxed;
static void clear_box (void *p) { pg_free (((boxed *) p)->block); }

/* 'save' (handle): bytes */
int command_save (const call *c)
{
    size_t n;
    if (take_count (c, 1, 1)) return 1;
    pg_session *s = take_handle (c, 0, KIND_SESSION);
    boxed *b = s ? hold (sizeof *b, clear_box) : NULL;
    if (!b || failed (c, pg_session_save (s, &n, &b->block))) return 1;
    const mwSize size[2] = { (mwSize) n, 1 };
    mxArray *a = mxCreateNumericArray (2, size, mxUINT8_CLASS, mxREAL);
    memcpy (mxGetData (a), b->block, n);
    give (c, 0, a);
    return 0;
}

/* 'restore' (handle, bytes) */
int command_restore (const call *c)
{
    if (take_count (c, 2, 2)) return 1;
    pg_session *s = take_handle (c, 0, KIND_SESSION);
    if (!s) return 1;
    if (!mxIsUint8 (c->in[1]) || mxIsSparse (c->in[1]))
        return fault ("perigal:argument", "a state is what perigal_save returned: uint8");
    return failed (c, pg_session_restore (s, mxGetNumberOfElements (c->in[1]), mxGetData (c->in[1])));
}

/* 'equations' (handle, t): structure */
int command_equations (const call *c)
{
    double t;
    if (take_count (c, 2, 2)) return 1;
    const pg_session *s = take_handle (c, 0, KIND_SESSION);
    if (!s || take_number (c, 1, "the load factor or time", &t)) return 1;
    pg_equations *e = hold (sizeof *e, clear_equations);
    if (!e || failed (c, pg_session_equations (e, s, t))) return 1;
    mxArray *a = mxCreateStructMatrix (1, 1, 0, NULL);
    put (a, "K", sparse_of (&e->K));
    put (a, "f", full_of (e->n, 1, e->f));
    put (a, "T", sparse_of (&e->T));
    put (a, "g", full_of (e->n, 1, e->g));
    put (a, "N", sparse_of (&e->N));
    mxArray *list = mxCreateDoubleMatrix ((mwSize) (e->selects ? e->T.ncol : 0), 1, mxREAL);
    for (size_t k = 0; e->selects && k < e->T.ncol; k++) mxGetPr (list)[k] = (double) e->free[k] + 1;
    put (a, "free", list);
    put (a, "selects", mxCreateLogicalScalar (e->selects != 0));
    put (a, "idle", number_of ((double) e->idle));
    put (a, "per_point", number_of (e->unknowns));
    give (c, 0, a);
    return 0;
}

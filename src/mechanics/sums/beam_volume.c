/* SPDX-License-Identifier: GPL-3.0-or-later
 * Micropolar bonds and the energy of the dilatation beside them, (kappa - kappa_b) theta^2 / 2 per volume
 * (theory G3): a loop over beams, which breaks bonds, and a state-based loop of displacements only with
 * deviation 0, which gets the broken bonds from it. */
#include "mechanics/sums/terms/bond_loop.h"
#include <stdio.h>
#include <string.h>

typedef struct {
    pg_sums   plain, bulk;  /* sums with the rules of beams and of dilatation; their arrays are borrowed */
    pg_bond_loop *beams, *volume;
    size_t    n, dim, m;                               /* m: unknowns of a point */
    int       threads;
    double   *u, *f;  /* displacements alone, m; forces of the dilatation, N (n x dim) */
    double   *W;                                       /* J/m^3 (n) */
    char      remark[96];
} both;

static const char *refusal (const pg_bond_loop_setting *setting)
{
    (void) setting;                                    /* each of the two loops refuses by itself */
    return NULL;
}

/* Frees both loops and the vectors. */
static void release (void *self)
{
    both *s = self;
    if (!s) return;
    pg_bond_loop_free (&s->beams), pg_bond_loop_free (&s->volume);
    pg_free (s->u), pg_free (s->f), pg_free (s->W);
    pg_free (s);
}

/* Makes two loops of one setting: for the beams without dilatation, and for the dilatation without deviation.
 * Surface corrections are for the beams only: at the surface the weighted volume q makes the dilatation
 * right. */
static pg_status create (void **self, const pg_bond_loop_setting *setting, pg_instructions set)
{
    pg_status status = PG_OK;
    both *s = NULL;
    pg_bond_loop_setting bonds = *setting, state = *setting;
    PG_ALLOC (s, 1);
    *self = s;
    s->n = setting->sums->cloud->n, s->dim = (size_t) setting->sums->cloud->dim, s->m = s->dim == 2 ? 3 : 6,
    s->threads = setting->threads;
    s->plain = s->bulk = *setting->sums;
    s->plain.rule.state = s->plain.rule.follow = 0;
    s->bulk.rule.beams = 0, s->bulk.rule.surface = PG_SURFACE_NONE, s->bulk.family_volume = NULL;
    bonds.sums = &s->plain, bonds.dilation = bonds.deviation = NULL, bonds.counted = NULL;
    state.sums = &s->bulk, state.beams = NULL, state.modulus = state.limit = NULL, state.exempt = NULL;
    bonds.instructions = state.instructions = pg_instructions_name (set);
    PG_TRY (pg_bond_loop_create (&s->beams, &bonds));
    PG_TRY (pg_bond_loop_create (&s->volume, &state));
    PG_ALLOC (s->u, s->n * s->dim);
    PG_ALLOC (s->f, s->n * s->dim);
    PG_ALLOC (s->W, s->n);
    snprintf (s->remark, sizeof s->remark, "bonds by %s, dilatations by %s", pg_bond_loop_name (s->beams),
              pg_bond_loop_name (s->volume));
done:
    return status;
}

/* Returns the names of the two loops. */
static const char *remark (const void *self) { return ((const both *) self)->remark; }

/* Memory traffic of both loops, and of the displacements and forces between them, read and written once
 * each. */
static void bytes (const void *self, double *per_bond, double *per_point)
{
    const both *s = self;
    double bond, point;
    pg_bond_loop_bytes (s->beams, per_bond, per_point);
    pg_bond_loop_bytes (s->volume, &bond, &point);
    *per_bond += bond, *per_point += point + 4 * (double) s->dim * sizeof (double);
}

/* Updates the intact bonds of both loops. */
static void update (void *self, const unsigned char *alive, const pg_changes *changes)
{
    both *s = self;
    pg_bond_loop_update (s->beams, alive, changes);
    pg_bond_loop_update (s->volume, alive, changes);
}

/* ---- sums ---------------------------------------------------------------------------------------------- */
typedef struct { both *s; const double *d; double *f; } pass;

/* Copies the displacements of points first .. last - 1, without rotations, for the dilatation. */
static void take_points (void *context, size_t first, size_t last, int thread)
{
    const pass *p = context;
    const both *s = p->s;
    (void) thread;
    for (size_t i = first; i < last; i++) memcpy (s->u + i * s->dim, p->d + i * s->m, s->dim * sizeof *s->u);
}

/* Adds the forces of the dilatation on points first .. last - 1 to those of the beams. */
static void add_points (void *context, size_t first, size_t last, int thread)
{
    const pass *p = context;
    const both *s = p->s;
    (void) thread;
    for (size_t i = first; i < last; i++)
        for (size_t k = 0; k < s->dim; k++) p->f[i * s->m + k] += s->f[i * s->dim + k];
}

/* Copies the displacements of all points. */
static void take (both *s, const double *d)
{
    pg_parallel (s->threads, s->n, take_points, &(pass){ s, d, NULL });
}

/* The loop over beams breaks bonds; the dilatation is updated by these before it is summed, so that both
 * parts of the force have the same bonds. */
static pg_status force (void *self, const double *d, double *f, pg_changes *broken)
{
    pg_status status = PG_OK;
    both *s = self;
    size_t before = broken ? broken->n : 0;
    PG_TRY (pg_bond_loop_force (s->beams, d, f, broken));
    if (broken && broken->n > before)
        pg_bond_loop_update (s->volume, NULL, &(pg_changes){ broken->n - before, 0, broken->bond + before });
    take (s, d);
    PG_TRY (pg_bond_loop_force (s->volume, s->u, s->f, NULL));
    pg_parallel (s->threads, s->n, add_points, &(pass) { s, NULL, f });
done:
    return status;
}

static double energy (void *self, const double *d)
{
    both *s = self;
    take (s, d);
    return pg_bond_loop_energy (s->beams, d) + pg_bond_loop_energy (s->volume, s->u);
}

static pg_status energies (void *self, const double *d, double *W)
{
    pg_status status = PG_OK;
    both *s = self;
    take (s, d);
    PG_TRY (pg_bond_loop_energies (s->beams, d, W));
    PG_TRY (pg_bond_loop_energies (s->volume, s->u, s->W));
    for (size_t i = 0; i < s->n; i++) W[i] += s->W[i];
done:
    return status;
}

/* Dilatation (no unit) and weighted volume of the points; the beams have neither. */
static pg_status dilatation (void *self, const double *d, double *theta, double *q)
{
    both *s = self;
    if (theta) take (s, d);
    return pg_bond_loop_dilatation (s->volume, s->u, theta, q);
}

const pg_bond_loop_kind pg_bond_loop_beam_volume = {
    .name = "beams and dilatation",
    .state = 3,
    .plain = 1,
    .refusal = refusal,
    .create = create,
    .free = release,
    .bytes = bytes,
    .update = update,
    .force = force,
    .energy = energy,
    .energies = energies,
    .remark = remark,
    .dilatation = dilatation,
    .apart = 1,
};

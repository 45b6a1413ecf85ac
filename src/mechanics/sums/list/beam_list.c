/* SPDX-License-Identifier: GPL-3.0-or-later
 * Micropolar bonds from a list: any points, any number of materials. Each point sums its own bonds in the
 * order of the family. The law is in law_beam.h; theory G2. */
#include "mechanics/sums/terms/beam.h"
#include "list.h"
#include <math.h>
#include <string.h>

typedef struct {
    bond_list list;                                    /* first, as the traversal takes a bond_list */
    pg_beam_law law;
    double *energy;                                    /* half of the energy of each point's bonds, J (n) */
} beam_list;

/* Returns why these bonds cannot be summed by a list, nor by anything else; NULL: they can. */
static const char *refusal (const pg_bond_loop_setting *setting)
{
    if (setting->sums->rule.finite) return "stretch: finite is not for bonds that bear shear";
    return setting->sums->cloud->dim < 2 ? "bonds of a line bear no shear" : NULL;
}

/* Frees a list of beams, also one that was never completed. */
static void release (void *self)
{
    beam_list *s = self;
    if (s) pg_free (s->energy);
    pg_list_free (s);
}

/* ---- building ------------------------------------------------------------------------------------------ */
/* Sets the constants of the law (list_laws.h), and writes 1 / s0^2, 1 / gamma0^2, 1 / kappa0^2 of each point
 * to its record, behind position and unknowns: a bond is compared with the limits of both its ends. */
static void prepare (bond_list *list)
{
    beam_list *s = (beam_list *) list;
    s->law = *list->setting.beams, list->setting.beams = &s->law;
    const double *of[3] = { list->setting.limit, s->law.shear_limit, s->law.bending_limit };
    const size_t known = (size_t) (list->dim + beam_unknowns (list->dim));
    list->constant[BEAM_LEVER] = 0.5 / s->law.length, list->constant[BEAM_PER_LENGTH] = 1 / s->law.length;
    list->constant[BEAM_SINGLE] = s->law.single != 0;
    for (int c = 0; c < 3; c++) list->constant[BEAM_STEP + c] = list->whole ? list->sums->sites.step[c] : 1;
    for (size_t p = 0; list->setting.limit && p < list->n; p++)
        for (size_t k = 0; k < 3; k++) {
            double limit = of[k][list->point[p]];
            list->record[p * (size_t) list->pitch + known + k] = 1 / (limit * limit);
        }
}

/* list_law.term: stiffnesses of a bond in the order of law_beam.h: shear, along, bending, N/m. */
static void term (const bond_list *list, size_t i, size_t j, const double *xi, double weight, double *out)
{
    const pg_beam beam = pg_beam_between (&list->setting, i, j, xi, weight);
    out[0] = beam.shear, out[1] = beam.along, out[2] = beam.bending;
}

/* list_law.limit: 1, of the sum or the largest of the squared utilisations of a bond. */
static double limit (const bond_list *list, size_t i, size_t j) { (void) list, (void) i, (void) j; return 1; }

/* Makes the list, with records of 8 numbers in 2D (2 + 3 + 3), 16 in 3D (3 + 6 + 3 and a gap): whole cache
 * lines. */
static pg_status create (void **self, const pg_bond_loop_setting *setting, pg_instructions set)
{
    pg_status status = PG_OK;
    int m = beam_unknowns (setting->sums->cloud->dim);
    const list_law law = { .pitch = m == 3 ? 8 : 16, .unknowns = m, .sums = m, .terms = 3,
                           .places = LIST_STEPS, .term = term, .limit = limit };
    PG_TRY (pg_list_create (self, sizeof (beam_list), setting, set, &law, prepare));
    beam_list *s = *self;
    PG_ALLOC (s->energy, s->list.n);
done:
    return status;
}

/* ---- sums ---------------------------------------------------------------------------------------------- */
/* list_take: copies forces and moments (over the length) of a chunk, N, to f in the order of old numbers. */
static void take_forces (void *f, const bond_list *list, size_t first, size_t last, const double *sum)
{
    int m = list->law.unknowns;
    for (size_t p = first; p < last; p++) {
        double *to = (double *) f + (size_t) list->point[p] * (size_t) m;
        for (int c = 0; c < m; c++) to[c] = pg_list_sum (sum, m, p - first, c);
    }
}

/* Forces and moments f of all points, N; unless broken is NULL, bonds at their limit are broken before they
 * are summed. */
static pg_status force (void *self, const double *u, double *f, pg_changes *broken)
{
    beam_list *s = self;
    int check = broken && s->list.limits > 0;
    pg_list_read (&s->list, u);
    pg_list_run (&s->list, LIST_beam_force, check, take_forces, f);
    return check ? pg_list_lost (&s->list, broken) : PG_OK;
}

/* list_take: energy of each point, J: the loop sums twice the energy of bonds, of which each end gets half.
 * */
static void take_energies (void *W, const bond_list *list, size_t first, size_t last, const double *sum)
{
    for (size_t p = first; p < last; p++)
        ((double *) W)[list->point[p]] = pg_list_sum (sum, 1, p - first, 0) / 4;
}

/* Energy of the body, J, summed in the order of points, so that it does not depend on threads. */
static double energy (void *self, const double *u)
{
    beam_list *s = self;
    double sum = 0;
    pg_list_read (&s->list, u);
    pg_list_run (&s->list, LIST_beam_store, 0, take_energies, s->energy);
    for (size_t i = 0; i < s->list.n; i++) sum += s->energy[i];
    return sum;
}

/* Energy density of the points, J/m^3. */
static pg_status energies (void *self, const double *u, double *W)
{
    beam_list *s = self;
    pg_list_read (&s->list, u);
    pg_list_run (&s->list, LIST_beam_store, 0, take_energies, W);
    for (size_t i = 0; i < s->list.n; i++) W[i] /= s->list.sums->cloud->volume[i];
    return PG_OK;
}

const pg_bond_loop_kind pg_bond_loop_beam_list = {
    .name = "list", .state = 2, .refusal = refusal, .create = create, .free = release, .bytes = pg_list_bytes,
    .update = pg_list_update, .force = force, .energy = energy, .energies = energies,
    .apart = 1,
};

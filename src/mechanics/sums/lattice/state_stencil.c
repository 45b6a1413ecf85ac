/* SPDX-License-Identifier: GPL-3.0-or-later
 * State-based sums (linear peridynamic solid) over the bonds of points on a lattice: a loop for the
 * dilatation of every point, one for the forces, on the blocks and alive bits of stencil_loop.c. Bonds over
 * their limit are broken in the first loop. theory B6. */
#include "state_stencil.h"
#include <math.h>
#include <string.h>

/* Returns why state-based sums are impossible, whether by list, stencil or transforms; NULL: they are not. */
const char *pg_state_loop_refusal (const pg_bond_loop_setting *setting)
{
    if (setting->sums->rule.finite)
        return "state-based sums are linear in the displacement, and the stretch is to be finite";
    if (setting->sums->rule.surface != PG_SURFACE_NONE)
        return "state-based sums weigh families that are not whole by themselves: no surface correction";
    if (setting->sums->cloud->dim == 1)
        return "in one dimension state-based and bond-based sums are the same";
    return NULL;
}

static const char *refusal (const pg_bond_loop_setting *setting)
{
    const char *why = pg_state_loop_refusal (setting);
    return why ? why : pg_stencil_loop_refusal (setting);
}

/* Frees the loops of state-based sums, also an object that was never completed; NULL is allowed. */
void pg_state_loop_free (void *self)
{
    state *s = self;
    if (!s) return;
    pg_free (s->q), pg_free (s->factor), pg_free (s->beta), pg_free (s->alpha);
    pg_stencil_loop_free (s);
}

/* ---- q ------------------------------------------------------------------------------------------------- */
/* Computes the weighted volume q = sum w r^2 V_j of point i over the bonds whose bits are set, and from it,
 * at the padded place of the point, factor A d / q^2 and beta B / q. */
static void weigh (state *s, size_t i)
{
    const stencil *b = &s->base;
    const pg_stencil *st = &b->setting.sums->stencil;
    unsigned bit;
    size_t place = b->place[i], k = pg_stencil_loop_block (b, place, &bit);
    double q = 0;
    for (size_t j = 0; j < st->n; j++)
        if (b->alive[k * b->job.n + j] >> bit & 1)
            q += st->weight[j] * st->r[j] * (b->p ? b->p[(ptrdiff_t) place + b->jump[j]] : 1);
    q *= b->job.volume;
    s->q[i] = q;
    s->factor[place] = state_factor (&b->setting, i, q), s->beta[place] = state_beta (&b->setting, i, q);
}

/* `weigh` for points first .. last - 1. */
static void weigh_points (void *context, size_t first, size_t last, int thread)
{
    (void) thread;
    for (size_t i = first; i < last; i++) weigh (context, i);
}

/* `weigh` for all points, by threads. */
static void weigh_all (state *s)
{
    pg_parallel_heavy (pg_stencil_loop_threads (&s->base), s->base.setting.sums->cloud->n, weigh_points, s);
}

/* `weigh` for the points of block k, which has lost bonds. */
static void weigh_block (stencil *b, size_t k)
{
    for (uint32_t left = b->block[k].present; left; left &= left - 1)
        weigh ((state *) b, (size_t) b->job.point[b->block[k].site + (size_t) __builtin_ctz (left)]);
}

/* Returns the function to be called for blocks that lost bonds; NULL: none, as weighted volumes stay those of
 * the start. */
stencil_lost pg_state_loop_lost (const stencil *s)
{
    return s->setting.sums->rule.follow ? weigh_block : NULL;
}

/* Updates the alive bits, then the weighted volumes if these follow the intact bonds. */
void pg_state_loop_update (void *self, const unsigned char *alive, const pg_changes *changes)
{
    state *s = self;
    pg_stencil_loop_update (self, alive, changes);
    if (!s->base.setting.sums->rule.follow) return;
    if (!changes) weigh_all (s);
    for (size_t c = 0; changes && c < changes->n; c++)
        weigh (s, pg_stencil_loop_owner (&s->base, changes->bond[c]));
}

/* ---- creation ------------------------------------------------------------------------------------------ */
/* Sets w V, w V^2 and 1 / r^2 of each bond of the stencil, w = k beta / r. */
static void set_terms (state *s)
{
    stencil *b = &s->base;
    const pg_stencil *st = &b->setting.sums->stencil;
    double V = b->job.volume;
    for (size_t j = 0; j < st->n; j++) {
        double *t = b->term + j * PG_TERMS, w = st->weight[j] / st->r[j];
        t[PG_AT_WV] = w * V, t[PG_AT_WVV] = w * V * V, t[PG_AT_INVERSE] = 1 / (st->r[j] * st->r[j]);
    }
}

/* Makes the loop. setting->counted: the bonds that weighted volumes count, for example without those that
 * pre-cracks cut: the alive bits are set to these while volumes are summed, then back to all bonds. */
pg_status pg_state_loop_create (void **self, const pg_bond_loop_setting *setting, pg_instructions set,
                                size_t bytes)
{
    pg_status status = PG_OK;
    PG_TRY (pg_stencil_loop_create (self, setting, set, bytes));
    state *s = *self;
    pg_block_job *job = &s->base.job;
    size_t places = pg_stencil_loop_places (&s->base);
    job->volume = setting->sums->stencil.cell * setting->sums->cloud->thickness;
    PG_ALLOC (s->q, setting->sums->cloud->n);
    PG_ALLOC (s->factor, places);
    PG_ALLOC (s->beta, places);
    PG_ALLOC (s->alpha, places);
    job->factor = s->factor, job->beta = s->beta, job->alpha = s->alpha;
    set_terms (s);
    if (setting->counted && !setting->sums->rule.follow) pg_stencil_loop_update (s, setting->counted, NULL);
    weigh_all (s);
    if (setting->counted && !setting->sums->rule.follow) pg_stencil_loop_update (s, NULL, NULL);
done:
    return status;
}

/* Makes the loop by stencil, which needs no more than a `state`. */
static pg_status create (void **self, const pg_bond_loop_setting *setting, pg_instructions set)
{
    return pg_state_loop_create (self, setting, set, sizeof (state));
}

static void bytes (const void *self, double *per_bond, double *per_point)
{
    const stencil *s = self;
    pg_stencil_loop_bytes (s, per_bond, per_point);
    *per_bond *= 2;  /* two loops; the second reads alpha and beta as well */
    *per_point = 2 * *per_point + sizeof (double) * 4;
}

/* ---- sums ---------------------------------------------------------------------------------------------- */
/* Forces f, N, in two passes: dilatations, in which bonds over their limit are broken, and forces from the
 * dilatations of both ends. */
static pg_status force (void *self, const double *u, double *f, pg_changes *broken)
{
    pg_status status = PG_OK;
    state *s = self;
    stencil *b = &s->base;
    int at = b->job.dim - 2, weighted = b->p != NULL,
        check = !broken || !b->setting.limit ? PG_CHECK_NONE
                : b->may                     ? PG_CHECK_SOME
                                             : PG_CHECK_ALL;
    b->job.f = f;
    pg_stencil_loop_spread (b, u);
    PG_TRY (pg_stencil_loop_run (b, b->kernels->dilate[at][check][weighted],
                         check ? b->kernels->dilate[at][PG_CHECK_NONE][weighted] : NULL,
                             pg_state_loop_lost (b),
                         broken));
    PG_TRY (pg_stencil_loop_run (b, b->kernels->pull[at][weighted], NULL, NULL, NULL));
done:
    return status;
}

/* Returns the stored energy, J; W: energy densities of the points, J/m^3, or NULL. */
static double sum_energies (state *s, const double *u, double *W)
{
    stencil *b = &s->base;
    pg_stencil_loop_spread (b, u);
    return pg_stencil_loop_stored (b, b->kernels->store[b->job.dim - 2][b->p != NULL], W);
}

double pg_state_loop_energy (void *self, const double *u) { return sum_energies (self, u, NULL); }

pg_status pg_state_loop_energies (void *self, const double *u, double *W)
{
    sum_energies (self, u, W);
    return PG_OK;
}

/* theta is summed as alpha is, with the factor d / q in place of A d / q^2. */
pg_status pg_state_loop_dilatation (void *self, const double *u, double *theta, double *q)
{
    pg_status status = PG_OK;
    state *s = self;
    stencil *b = &s->base;
    size_t n = b->setting.sums->cloud->n;
    double *factor = s->factor, *own = NULL;
    if (q) memcpy (q, s->q, n * sizeof *q);
    if (!theta) return PG_OK;
    PG_ALLOC (own, pg_stencil_loop_places (b));
    for (size_t i = 0; i < n; i++) own[b->place[i]] = s->q[i] > 0 ? b->job.dim / s->q[i] : 0;
    b->job.factor = own;
    pg_stencil_loop_spread (b, u);
    pg_stencil_loop_run (b, b->kernels->dilate[b->job.dim - 2][PG_CHECK_NONE][b->p != NULL], NULL, NULL,
                         NULL);
    b->job.factor = factor;
    for (size_t i = 0; i < n; i++) theta[i] = s->alpha[b->place[i]];
done:
    pg_free (own);
    return status;
}

const pg_bond_loop_kind pg_bond_loop_state_stencil = {
    .name = "stencil",
    .state = 1,
    .refusal = refusal,
    .create = create,
    .free = pg_state_loop_free,
    .bytes = bytes,
    .update = pg_state_loop_update,
    .force = force,
    .energy = pg_state_loop_energy,
    .energies = pg_state_loop_energies,
    .dilatation = pg_state_loop_dilatation,
    .apart = 1,
};

/* SPDX-License-Identifier: GPL-3.0-or-later
 * Micropolar bonds of points on a lattice: the blocks and alive bits of stencil_loop.c with rotations beside
 * displacements. Bonds at their limit are found and broken before the forces are summed. theory G2. */
#include "mechanics/sums/terms/beam.h"
#include "stencil_loop.h"
#include <math.h>
#include <string.h>

typedef struct {
    stencil  base;                                     /* first, as loops over blocks take a stencil */
    pg_beam_law law;
    int      m;                                        /* unknowns of a point */
    double  *turn;                                     /* padded rotations times length, m */
    uint32_t *over;                                    /* bits of bonds at their limit (pg_block_job.over) */
} beams;

/* Are the values of the n points not all the same? */
static int differs (const double *a, size_t n)
{
    for (size_t i = 1; a && i < n; i++) if (a[i] != a[0]) return 1;
    return 0;
}

/* Returns why these bonds cannot be summed by a stencil, NULL if they can: a stencil has the same moduli and
 * limits everywhere. */
static const char *refusal (const pg_bond_loop_setting *setting)
{
    const pg_beam_law *law = setting->beams;
    size_t n = setting->sums->cloud->n;
    if (setting->sums->rule.finite) return "stretch: finite is not for bonds that bear shear";
    if (setting->sums->cloud->dim < 2) return "bonds of a line bear no shear";
    if (differs (law->shear, n) || differs (law->bending, n)) return "there are several moduli";
    if (setting->limit && (differs (law->shear_limit, n) || differs (law->bending_limit, n)))
        return "there are several limits";
    return pg_stencil_loop_refusal (setting);
}

/* Frees the loop, also one that was never completed. */
static void release (void *self)
{
    beams *s = self;
    if (!s) return;
    pg_free (s->turn), pg_free (s->over);
    pg_stencil_loop_free (s);
}

/* Returns 1 / (unit limit^2), the factor from a squared measure of the loops to its squared utilisation; 0 if
 * there is no limit. unit: the measure squared over the strain squared, m^2 or 1. */
static double share (double limit, double unit)
{
    return limit > 0 && isfinite (limit) ? 1 / (unit * limit * limit) : 0;
}

/* Sets the numbers of each bond of the stencil, the same for all points: stiffnesses kt, g = (kn - kt) / r^2
 * and kb, and the factors of `share`. Shear is measured by w_perp in m, hence r^2 in its factor, bending by q
 * in m, hence length^2. */
static void set_terms (beams *s)
{
    stencil *b = &s->base;
    const pg_stencil *st = &b->setting.sums->stencil;
    const pg_bond_loop_setting *set = &b->setting;
    double length = s->law.length, V = st->cell * set->sums->cloud->thickness;
    for (size_t j = 0; j < st->n; j++) {
        double *t = b->term + j * PG_TERMS, r = st->r[j], all = st->weight[j] * (V * V) / r,
               kt = 12 * s->law.shear[0] * all / (r * r);
        t[PG_AT_KT] = kt, t[PG_AT_KG] = (set->modulus[0] * all - kt) / (r * r),
        t[PG_AT_KB] = s->law.bending[0] * all / (length * length);
        t[PG_AT_BEAM_INVERSE] = 1 / (r * r);
        t[PG_AT_STRETCH_SHARE] = t[PG_AT_SHEAR_SHARE] = t[PG_AT_BEND_SHARE] = 0;
        if (!set->limit) continue;
        t[PG_AT_STRETCH_SHARE] = share (set->limit[0], 1),
        t[PG_AT_SHEAR_SHARE] = share (s->law.shear_limit[0], r * r);
        t[PG_AT_BEND_SHARE] = share (s->law.bending_limit[0], length * length);
    }
}

/* Makes a stencil with padded rotations; in 2D all three pointers job.q are the one rotation about z, so that
 * loops need no branches. */
static pg_status create (void **self, const pg_bond_loop_setting *setting, pg_instructions set)
{
    pg_status status = PG_OK;
    PG_TRY (pg_stencil_loop_create (self, setting, set, sizeof (beams)));
    beams *s = *self;
    stencil *b = &s->base;
    size_t places = pg_stencil_loop_places (b);
    int turns = b->job.dim == 2 ? 1 : 3;
    s->law = *setting->beams, b->setting.beams = &s->law;
    s->m = b->job.dim + turns;
    PG_ALLOC (s->turn, places * (size_t) turns);
    for (int k = 0; k < 3; k++) b->job.q[k] = s->turn + places * (size_t) (k < turns ? k : 0);
    b->job.lever = 0.5 / s->law.length, b->job.single = s->law.single;
    if (setting->limit) PG_ALLOC (s->over, b->nblock * b->job.n);
    b->job.over = s->over;
    set_terms (s);
done:
    return status;
}

/* Memory traffic of a sum: m numbers per point instead of dim. */
static void bytes (const void *self, double *per_bond, double *per_point)
{
    const beams *s = self;
    pg_stencil_loop_bytes (s, per_bond, per_point);
    *per_point *= (double) s->m / s->base.job.dim;
}

/* ---- sums ---------------------------------------------------------------------------------------------- */
typedef struct { beams *s; const double *u; } pass;

/* Copies displacements and rotations of blocks first .. last - 1 to their padded places. */
static void spread_blocks (void *context, size_t first, size_t last, int thread)
{
    const pass *p = context;
    const pg_block_job *job = &p->s->base.job;
    int dim = job->dim, turns = p->s->m - dim;
    (void) thread;
    for (size_t k = first; k < last; k++)
        for (uint32_t left = job->block[k].present; left; left &= left - 1) {
            size_t l = (size_t) __builtin_ctz (left), at = job->block[k].base + l;
            const double *u = p->u + (size_t) job->point[job->block[k].site + l] * (size_t) p->s->m;
            for (int d = 0; d < dim; d++) job->u[d][at] = u[d];
            for (int t = 0; t < turns; t++) job->q[t][at] = u[dim + t];
        }
}

/* Copies displacements and rotations of all blocks to their padded places. */
static void spread (beams *s, const double *u)
{
    pg_parallel_heavy (pg_stencil_loop_threads (&s->base), s->base.nblock, spread_blocks, &(pass) { s, u });
}

/* Breaks the bonds of block k that are marked in job.over, and appends them to found. */
static pg_status kill (stencil *b, size_t k, pg_changes *found)
{
    pg_status status = PG_OK;
    const pg_block *block = b->block + k;
    for (size_t j = 0; j < b->job.n; j++)
        for (uint32_t left = b->job.over[k * b->job.n + j]; left; left &= left - 1) {
            unsigned bit = (unsigned) __builtin_ctz (left);
            b->alive[k * b->job.n + j] &= ~(1u << bit);
            PG_GROW (found->bond, found->cap, found->n + 1);
            found->bond[found->n++] = pg_stencil_loop_entry (b, b->job.point[block->site + bit],
                                                             block->base + bit,
                                                     j);
        }
done:
    return status;
}

/* Breaks the bonds at their limit of blocks first .. last - 1; single bonds are checked only in blocks with a
 * hit. */
static void break_blocks (void *context, size_t first, size_t last, int thread)
{
    beams *s = context;
    stencil *b = &s->base;
    b->kernels->beam_look[b->job.dim - 2] (&b->job, first, last);
    for (size_t k = first; k < last; k++) {
        if (!b->hit[k]) continue;
        b->hit[k] = 0;
        b->kernels->beam_over[b->job.dim - 2] (&b->job, k, k + 1);
        pg_status now = kill (b, k, &b->found[thread]);
        if (now != PG_OK) b->failed[thread] = now;
    }
}

/* Breaks the bonds at their limit before forces are summed, so that they have no force any more. */
static pg_status break_bonds (beams *s, pg_changes *broken)
{
    stencil *b = &s->base;
    int threads = pg_stencil_loop_threads (b);
    pg_parallel_heavy (threads, b->nblock, break_blocks, s);
    return pg_changes_collect (broken, threads, b->found, b->failed);
}

/* Forces and moments f, N (n x m), at the unknowns u (n x m, m); unless broken is NULL, bonds over their
 * limit are broken first and appended to it. */
static pg_status force (void *self, const double *u, double *f, pg_changes *broken)
{
    pg_status status = PG_OK;
    beams *s = self;
    stencil *b = &s->base;
    b->job.f = f;
    spread (s, u);
    if (broken && s->over) PG_TRY (break_bonds (s, broken));
    PG_TRY (pg_stencil_loop_run (b, b->kernels->beam[b->job.dim - 2][b->p != NULL], NULL, NULL, NULL));
done:
    return status;
}

/* Returns the energy of the body, J; W: four times the energy of each point, or NULL. */
static double sum_energies (beams *s, const double *u, double *W)
{
    stencil *b = &s->base;
    spread (s, u);
    /* The loops sum twice the energy of each bond, from both ends. */
    return pg_stencil_loop_stored (b, b->kernels->beam_energy[b->job.dim - 2][b->p != NULL], W) / 4;
}

static double energy (void *self, const double *u) { return sum_energies (self, u, NULL); }

/* Energy density of the points, J/m^3: a quarter of the loops' sum, over the volume of the point. */
static pg_status energies (void *self, const double *u, double *W)
{
    const beams *s = self;
    const pg_cloud *cloud = s->base.setting.sums->cloud;
    sum_energies (self, u, W);
    for (size_t i = 0; i < cloud->n; i++) W[i] /= 4 * cloud->volume[i];
    return PG_OK;
}

const pg_bond_loop_kind pg_bond_loop_beam_stencil = {
    .name = "stencil",
    .state = 2,
    .refusal = refusal,
    .create = create,
    .free = release,
    .bytes = bytes,
    .update = pg_stencil_loop_update,
    .force = force,
    .energy = energy,
    .energies = energies,
    .apart = 1,
};

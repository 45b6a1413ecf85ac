/* SPDX-License-Identifier: GPL-3.0-or-later
 * Micropolar bonds one by one, from a list: any points, any number of materials. Each point sums its own
 * bonds. */
#include "beam.h"
#include "bond_loop.h"
#include <math.h>
#include <string.h>

enum { MAX_THREADS = 64 };
typedef struct {
    pg_bond_loop_setting setting;
    pg_beam_law law;
    int      dim, m;
    double  *xi;                                       /* m (bonds x dim) */
    pg_beam *beam;                                     /* N/m (bonds) */
    unsigned char *alive;                              /* (bonds) */
    double  *energy;                                   /* J, of each point's halves (n) */
    double  *share;  /* 1 / s0^2, 1 / gamma0^2, 1 / kappa0^2 of each point (n x 3); NULL: nothing breaks */
    int      alike;                                    /* those of all points are */
    pg_changes found[MAX_THREADS];
    pg_status  failed[MAX_THREADS];
} list;

static const char *refusal (const pg_bond_loop_setting *setting)
{
    if (setting->sums->rule.finite) return "stretch: finite is not for bonds that bear shear";
    return setting->sums->cloud->dim < 2 ? "bonds of a line bear no shear" : NULL;
}

static void release (void *self)
{
    list *s = self;
    if (!s) return;
    for (int t = 0; t < MAX_THREADS; t++) pg_free (s->found[t].bond);
    pg_free (s->xi), pg_free (s->beam), pg_free (s->alive), pg_free (s->energy), pg_free (s->share);
    pg_free (s);
}

static int threads_for (const list *s)
{
    return s->setting.threads < 1 ? 1 : s->setting.threads < MAX_THREADS ? s->setting.threads : MAX_THREADS;
}

static void fill (void *context, size_t first, size_t last, int thread)
{
    list *s = context;
    const pg_family *family = s->setting.family;
    (void) thread;
    for (size_t i = first; i < last; i++) {
        size_t at = family->start[i];
        /* three numbers a bond, filled from behind */
        double *xi = s->xi + at * (size_t) s->dim, *weight = &s->beam[at].shear;
        pg_sums_bonds (s->setting.sums, family, i, xi, weight, NULL);
        for (size_t e = family->start[i + 1] - at; e-- > 0; ) {
            double own = weight[e];
            s->beam[at + e] = pg_beam_between (&s->setting, i, (size_t) family->node[at + e],
                                               xi + e * (size_t) s->dim, own);
        }
    }
}

static pg_status set_shares (list *s)
{
    pg_status status = PG_OK;
    size_t n = s->setting.family->n;
    const double *of[3] = { s->setting.limit, s->law.shear_limit, s->law.bending_limit };
    if (!s->setting.limit) goto done;
    PG_ALLOC (s->share, 3 * n);
    s->alike = 1;
    for (size_t k = 0; k < 3 * n; k++) {
        double limit = of[k % 3][k / 3];
        s->share[k] = 1 / (limit * limit);
        s->alike = s->alike && s->share[k] == s->share[k % 3];
    }
done:
    return status;
}

static pg_status create (void **self, const pg_bond_loop_setting *setting, pg_instructions set)
{
    pg_status status = PG_OK;
    list *s = NULL;
    size_t n = setting->family->n, nbond = setting->family->start[n];
    (void) set;
    PG_ALLOC (s, 1);
    *self = s;
    s->setting = *setting, s->law = *setting->beams, s->setting.beams = &s->law;
    s->dim = setting->sums->cloud->dim, s->m = beam_unknowns (s->dim);
    PG_ALLOC (s->xi, nbond * (size_t) s->dim);
    PG_ALLOC (s->beam, nbond);
    PG_ALLOC (s->alive, nbond);
    PG_ALLOC (s->energy, n);
    memset (s->alive, 1, nbond);
    PG_TRY (set_shares (s));
    pg_parallel (threads_for (s), n, fill, s);
done:
    return status;
}

static void bytes (const void *self, double *per_bond, double *per_point)
{
    const list *s = self;
    *per_bond = (double) ((size_t) s->dim * sizeof (double) + sizeof (pg_beam) + sizeof (int) + 1);
    *per_point = (double) (2 * (size_t) s->m * sizeof (double) + sizeof (size_t));
}

static void update (void *self, const unsigned char *alive, const pg_changes *changes)
{
    list *s = self;
    if (!changes) memcpy (s->alive, alive, s->setting.family->start[s->setting.family->n]);
    for (size_t c = 0; changes && c < changes->n; c++) s->alive[changes->bond[c]] = 0;
}

/* ---- sums ---------------------------------------------------------------------------------------------- */
/* Is the bond at a limit of point i's? */
static inline int over_by (const list *s, size_t i, double stretch, double shear2, double bending2)
{
    const double *share = s->share + 3 * i;
    double a = stretch > 0 ? stretch * stretch * share[0] : 0, b = shear2 * share[1], c = bending2 * share[2];
    return s->law.single ? a >= 1 || b >= 1 || c >= 1 : a + b + c >= 1;
}

typedef struct { list *s; const double *u; double *f, *W; int breaking; } pass;

static inline __attribute__ ((always_inline)) void sum_point (const pass *p, size_t i, int dim, double *f,
                                                              pg_changes *found, pg_status *failed)
{
    pg_status status = PG_OK;
    list *s = p->s;
    const pg_family *family = s->setting.family;
    const unsigned char *exempt = s->setting.exempt;
    const int m = beam_unknowns (dim);
    double lever = 0.5 / s->law.length, per_length = 1 / s->law.length, w[3], diff[3];
    const double *di = p->u + i * (size_t) m;
    for (int k = 0; k < m; k++) f[k] = 0;
    for (size_t e = family->start[i]; e < family->start[i + 1]; e++) {
        if (!s->alive[e]) continue;
        size_t j = (size_t) family->node[e];
        const double *xi = s->xi + e * (size_t) dim;
        double inverse = 1 / beam_dot (dim, xi, xi);
        beam_motion (dim, lever, xi, di, p->u + j * (size_t) m, w, diff);
        if (p->breaking && !(exempt && (exempt[i] || exempt[j]))) {
            double stretch, shear2, bending2;
            beam_measures (dim, per_length, xi, inverse, w, diff, &stretch, &shear2, &bending2);
            if (over_by (s, i, stretch, shear2, bending2)
                || (!s->alike && over_by (s, j, stretch, shear2, bending2))) {
                s->alive[e] = 0;
                PG_GROW (found->bond, found->cap, found->n + 1);
                found->bond[found->n++] = e;
                continue;
            }
        }
        beam_pull (dim, lever, xi, inverse, &s->beam[e], w, diff, f);
    }
done:
    if (status != PG_OK) *failed = status;
}

static void sum_points (void *context, size_t first, size_t last, int thread)
{
    const pass *p = context;
    list *s = p->s;
    for (size_t i = first; i < last; i++) {
        double *f = p->f + i * (size_t) s->m;
        if (s->dim == 2) sum_point (p, i, 2, f, &s->found[thread], &s->failed[thread]);
        else sum_point (p, i, 3, f, &s->found[thread], &s->failed[thread]);
    }
}

static pg_status force (void *self, const double *u, double *f, pg_changes *broken)
{
    list *s = self;
    int threads = threads_for (s);
    pass p = { s, u, f, NULL, broken && s->setting.limit };
    pg_parallel (threads, s->setting.family->n, sum_points, &p);
    return p.breaking ? sweep_collect (broken, threads, s->found, s->failed) : PG_OK;
}

static void store_points (void *context, size_t first, size_t last, int thread)
{
    const pass *p = context;
    const list *s = p->s;
    const pg_family *family = s->setting.family;
    double w[3], diff[3];
    (void) thread;
    for (size_t i = first; i < last; i++) {
        p->W[i] = 0;
        for (size_t e = family->start[i]; e < family->start[i + 1]; e++) {
            const double *xi = s->xi + e * (size_t) s->dim;
            if (!s->alive[e]) continue;
            beam_motion (s->dim, 0.5 / s->law.length, xi, p->u + i * (size_t) s->m,
                         p->u + (size_t) family->node[e] * (size_t) s->m, w, diff);
            p->W[i] += beam_energy (s->dim, xi, beam_dot (s->dim, xi, xi), &s->beam[e], w, diff);
        }
        p->W[i] /= 4;                                  /* half of w, and half of it to each end */
    }
}

static double energy (void *self, const double *u)
{
    list *s = self;
    pass p = { s, u, NULL, s->energy, 0 };
    double sum = 0;
    pg_parallel (threads_for (s), s->setting.family->n, store_points, &p);
    for (size_t i = 0; i < s->setting.family->n; i++) sum += s->energy[i];
    return sum;
}

static pg_status energies (void *self, const double *u, double *W)
{
    list *s = self;
    pass p = { s, u, NULL, W, 0 };
    pg_parallel (threads_for (s), s->setting.family->n, store_points, &p);
    for (size_t i = 0; i < s->setting.family->n; i++) W[i] /= s->setting.sums->cloud->volume[i];
    return PG_OK;
}

const pg_bond_loop_kind pg_bond_loop_beam_list = {
    .name = "list",
    .state = 2,
    .plain = 1,
    .refusal = refusal,
    .create = create,
    .free = release,
    .bytes = bytes,
    .update = update,
    .force = force,
    .energy = energy,
    .energies = energies,
};

/* SPDX-License-Identifier: GPL-3.0-or-later
 * The problem of complementarity of contact with friction (perigal/contact.h), in forces and gaps of a few
 * to a few hundred pairs, with a dense symmetric compliance C.
 *
 * Relaxation (projected Gauss-Seidel; Jourdan, Alart and Jean 1998): one pair after the other takes the
 * forces that its own conditions ask for while all others stay,
 *     f_n = max (0, f_n - g_n / C_nn),    f_t = f_t - (g_t - slip) / C_tt, cut at +-(mu f_n + c).
 * Without friction it converges for every positive definite C; with it wherever mu is not too large. It is
 * slow to the last digit, but soon knows which pairs are open, stick or slide. Given that, all conditions are
 * equations (active set): open f = 0; stick g_n = 0, g_t = slip; sliding g_n = 0, f_t = -s (mu f_n + c), s
 * the direction of slip. Their solution is exact; pairs whose inequalities it violates change their status,
 * and the equations are solved again. A status that does not settle goes back to relaxation with more
 * sweeps. */
#include "perigal/contact.h"
#include <float.h>
#include <math.h>
#include <string.h>

/* Rounds of relaxation and active set, passes of the latter in each, sweeps of the first round (each later
 * one takes ROUND_GROWTH times as many). */
enum { ROUNDS = 5, PASSES = 30, SWEEPS = 60, ROUND_GROWTH = 8 };
/* A violation that counts; one that is accepted where the active set does not settle (a pair on the border of
 * two states, which rounding throws to and fro); the change of a sweep that ends relaxation. */
static const double COUNTS = 1e-11, ACCEPTED = 1e-9, STILL = 1e-6;

/* Scratch of one solve. */
typedef struct {
    const pg_contact_problem *p;
    pg_contact_solution *out;
    double  scale;                                     /* the largest gap or slip without contact, m */
    double *A, *b;                                     /* the equations of a status, 2 n x 2 n and 2 n */
} contact_work;

static double diagonal (const pg_contact_problem *p, size_t row) { return p->C[row * 2 * p->n + row]; }
static double friction (const pg_contact_problem *p, size_t k)
{
    return p->coefficient ? p->coefficient[k] : 0;
}
static double cohesion (const pg_contact_problem *p, size_t k) { return p->cohesion ? p->cohesion[k] : 0; }
static double slip_before (const pg_contact_problem *p, size_t k) { return p->slip ? p->slip[k] : 0; }
/* What pair k bears along the surface, N. */
static double limit (const pg_contact_problem *p, size_t k, double normal)
{
    return normal > 0 ? friction (p, k) * normal + cohesion (p, k) : 0;
}
/* Direction of slip: 1, -1; 0: none. */
static double direction (unsigned char status)
{
    return status == PG_CONTACT_FORWARD ? 1 : status == PG_CONTACT_BACKWARD ? -1 : 0;
}

/* g = g0 + C f, afresh. */
static void find_gaps (contact_work *w)
{
    const pg_contact_problem *p = w->p;
    size_t rows = 2 * p->n;
    for (size_t i = 0; i < rows; i++) {
        double sum = p->gap[i];
        for (size_t j = 0; j < rows; j++) sum += p->C[i * rows + j] * w->out->force[j];
        w->out->gap[i] = sum;
    }
}

/* One force changes by df: all gaps follow. Returns the change of its own gap. */
static double push (contact_work *w, size_t row, double df)
{
    size_t rows = 2 * w->p->n;
    const double *column = w->p->C + row * rows;
    w->out->force[row] += df;
    for (size_t i = 0; df != 0 && i < rows; i++) w->out->gap[i] += column[i] * df;
    return fabs (df) * column[row];
}

/* One sweep over all pairs; the largest change of a gap. */
static double sweep (contact_work *w)
{
    const pg_contact_problem *p = w->p;
    double *f = w->out->force, *g = w->out->gap, most = 0;
    for (size_t k = 0; k < p->n; k++) {
        double normal = fmax (0, f[2*k] - g[2*k] / diagonal (p, 2*k));
        most = fmax (most, push (w, 2*k, normal - f[2*k]));
        double most_shear = limit (p, k, f[2*k]);
        double shear = f[2*k + 1] - (g[2*k + 1] - slip_before (p, k)) / diagonal (p, 2*k + 1);
        shear = fmax (-most_shear, fmin (most_shear, shear));
        most = fmax (most, push (w, 2*k + 1, shear - f[2*k + 1]));
    }
    return most;
}

static void relax (contact_work *w, size_t sweeps)
{
    find_gaps (w);
    for (size_t k = 0; k < sweeps; k++) {
        w->out->sweeps++;
        if (!(sweep (w) > STILL * w->scale)) break;
    }
}

/* How the pairs stand by the forces that relaxation left. */
static void read_status (contact_work *w)
{
    const pg_contact_problem *p = w->p;
    const double *f = w->out->force;
    for (size_t k = 0; k < p->n; k++) {
        double most = limit (p, k, f[2*k]);
        w->out->status[k] = !(f[2*k] > 0)                     ? PG_CONTACT_OPEN
                            : most > 0 && fabs (f[2*k + 1]) < most ? PG_CONTACT_STICK
                            : most > 0 ? (f[2*k + 1] < 0 ? PG_CONTACT_FORWARD : PG_CONTACT_BACKWARD)
                            : w->out->gap[2*k + 1] < slip_before (p, k) ? PG_CONTACT_BACKWARD
                                                                        : PG_CONTACT_FORWARD;
    }
}

/* Row i of the equations: g_i = goal. */
static void set_gap (contact_work *w, size_t i, double goal)
{
    size_t rows = 2 * w->p->n;
    for (size_t j = 0; j < rows; j++) w->A[j * rows + i] = w->p->C[j * rows + i];
    w->b[i] = goal - w->p->gap[i];
}

/* Row i: f_i + share f_(i - 1) = goal, times C_ii, so that all rows are lengths. */
static void set_force (contact_work *w, size_t i, double share, double goal)
{
    size_t rows = 2 * w->p->n;
    for (size_t j = 0; j < rows; j++) w->A[j * rows + i] = 0;
    w->A[i * rows + i] = diagonal (w->p, i);
    if (share != 0) w->A[(i - 1) * rows + i] = share * diagonal (w->p, i);
    w->b[i] = goal * diagonal (w->p, i);
}

/* Forces and gaps of the pairs as they stand. */
static pg_status solve_status (contact_work *w)
{
    pg_status status = PG_OK;
    const pg_contact_problem *p = w->p;
    for (size_t k = 0; k < p->n; k++) {
        double s = direction (w->out->status[k]);
        if (w->out->status[k] == PG_CONTACT_OPEN) {
            set_force (w, 2*k, 0, 0), set_force (w, 2*k + 1, 0, 0);
            continue;
        }
        set_gap (w, 2*k, 0);
        if (s == 0) set_gap (w, 2*k + 1, slip_before (p, k));
        else set_force (w, 2*k + 1, s * friction (p, k), -s * cohesion (p, k));
    }
    PG_TRY (pg_dense_lu (2 * p->n, w->A, 1, w->b));
    memcpy (w->out->force, w->b, 2 * p->n * sizeof *w->b);
    find_gaps (w);
done:
    return status;
}

/* The status that pair k should have by the solution at hand; tiny: violations up to here do not count,
 * m. */
static unsigned char better (const contact_work *w, size_t k, double tiny)
{
    const pg_contact_problem *p = w->p;
    unsigned char now = w->out->status[k];
    double normal = w->out->force[2*k], shear = w->out->force[2*k + 1], gap = w->out->gap[2*k],
           slip = w->out->gap[2*k + 1] - slip_before (p, k), most = limit (p, k, normal),
           s = direction (now);
    int rough = friction (p, k) > 0 || cohesion (p, k) > 0;
    if (now == PG_CONTACT_OPEN) {
        if (!(gap < -tiny)) return now;
        return rough ? PG_CONTACT_STICK : slip < 0 ? PG_CONTACT_BACKWARD : PG_CONTACT_FORWARD;
    }
    if (normal * diagonal (p, 2*k) < -tiny) return PG_CONTACT_OPEN;
    if (now == PG_CONTACT_STICK) {
        if (!((fabs (shear) - most) * diagonal (p, 2*k + 1) > tiny)) return now;
        return shear < 0 ? PG_CONTACT_FORWARD : PG_CONTACT_BACKWARD;
    }
    if (rough) return s * slip < -tiny ? PG_CONTACT_STICK : now;
    /* without friction the direction is told, and nothing else depends on it */
    return slip < -tiny ? PG_CONTACT_BACKWARD : slip > tiny ? PG_CONTACT_FORWARD : now;
}

/* Passes of the active set until no pair changes. 1: it has settled; 0: not, or the equations of a status
 * were singular. */
static pg_status polish (contact_work *w, int *settled)
{
    pg_status status = PG_OK;
    *settled = 0;
    for (int pass = 0; pass < PASSES && !*settled; pass++) {
        pg_status now = solve_status (w);
        w->out->passes++;
        if (now == PG_E_SINGULAR) return PG_OK;
        PG_TRY (now);
        *settled = 1;
        for (size_t k = 0; k < w->p->n; k++) {
            unsigned char next = better (w, k, COUNTS * w->scale);
            if (next != w->out->status[k]) *settled = 0;
            w->out->status[k] = next;
        }
    }
done:
    return status;
}

/* Of one pair, m. Conditions that its status fulfils by construction are measured like the others. */
static double violation_of (const pg_contact_problem *p, const pg_contact_solution *s, size_t k)
{
    double normal = s->force[2*k], shear = s->force[2*k + 1], gap = s->gap[2*k],
           slip = s->gap[2*k + 1] - slip_before (p, k), most = limit (p, k, normal),
           ct = diagonal (p, 2*k + 1), worst = fmax (-gap, -normal * diagonal (p, 2*k));
    worst = fmax (worst, fmin (gap, normal * diagonal (p, 2*k)));      /* together, or no force */
    worst = fmax (worst, (fabs (shear) - most) * ct);
    /* a slip against the shear force that is at its limit, none inside it; one of the two is zero */
    if (most > 0) {
        double room = fmax (0, most - (slip > 0 ? -shear : shear)) * ct;
        worst = fmax (worst, fmin (room, fabs (slip)));
    }
    return worst;
}

/* The largest gap or slip without contact, m. */
static double scale_of (const pg_contact_problem *p)
{
    double scale = 0;
    for (size_t i = 0; i < 2 * p->n; i++) scale = fmax (scale, fabs (p->gap[i]));
    for (size_t k = 0; k < p->n; k++) scale = fmax (scale, fabs (slip_before (p, k)));
    return scale;
}

double pg_contact_violation (const pg_contact_problem *p, const pg_contact_solution *s)
{
    double scale = scale_of (p), worst = 0;
    for (size_t k = 0; k < p->n; k++) {
        double now = violation_of (p, s, k);
        if (!(now <= worst)) worst = now;
    }
    return worst > 0 ? worst / scale : isnan (worst) ? NAN : 0;
}

/* Is it a problem at all? The gaps without contact may all be zero. */
static pg_status look_at (contact_work *w)
{
    pg_status status = PG_OK;
    const pg_contact_problem *p = w->p;
    for (size_t i = 0; i < 2 * p->n; i++) {
        if (!(diagonal (p, i) > 0) || !isfinite (diagonal (p, i)) || !isfinite (p->gap[i]))
            PG_FAIL (PG_E_USAGE, "row %zu of a contact problem has the compliance %g m/N and the gap %g m", i,
                     diagonal (p, i), p->gap[i]);
    }
    for (size_t k = 0; k < p->n; k++)
        if (!(friction (p, k) >= 0) || !(cohesion (p, k) >= 0))
            PG_FAIL (PG_E_USAGE, "pair %zu has the friction %g and the cohesion %g N: neither may be "
                     "negative", k, friction (p, k), cohesion (p, k));
    w->scale = scale_of (p);
done:
    return status;
}

/* Pairs of each kind; forces of what is open are zero, not rounding. */
static void count (contact_work *w)
{
    pg_contact_solution *o = w->out;
    o->open = o->stick = o->sliding = 0;
    for (size_t k = 0; k < w->p->n; k++) {
        if (o->status[k] == PG_CONTACT_OPEN) o->open++, o->force[2*k] = o->force[2*k + 1] = 0;
        else if (o->status[k] == PG_CONTACT_STICK) o->stick++;
        else o->sliding++;
    }
}

pg_status pg_contact_solve (pg_contact_solution *out, const pg_contact_problem *p)
{
    pg_status status = PG_OK;
    contact_work w = { .p = p, .out = out };
    size_t rows = 2 * p->n, sweeps = SWEEPS;
    int settled = p->n == 0;
    out->open = out->stick = out->sliding = out->sweeps = out->passes = 0, out->violation = 0;
    PG_TRY (look_at (&w));
    PG_ALLOC (w.A, rows * rows);
    PG_ALLOC (w.b, rows);
    memset (out->force, 0, rows * sizeof *out->force);
    for (int round = 0; round < ROUNDS && !settled; round++, sweeps *= ROUND_GROWTH) {
        /* what an active set that went in circles left is no better than nothing */
        if (round > 0) memset (out->force, 0, rows * sizeof *out->force);
        relax (&w, sweeps);
        read_status (&w);
        PG_TRY (polish (&w, &settled));
        out->violation = pg_contact_violation (p, out);
        if (out->violation <= ACCEPTED) settled = 1;
    }
    if (!settled)
        PG_FAIL (PG_E_EQUILIBRIUM,
                 "contact with friction does not settle: after %zu sweeps and %zu passes over %zu pairs a "
                 "condition is violated by %.2g of the gaps without contact; a smaller contact.coefficient "
                 "settles sooner",
                 out->sweeps, out->passes, p->n, out->violation);
    count (&w);
done:
    pg_free (w.A), pg_free (w.b);
    return status;
}

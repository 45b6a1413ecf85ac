/* SPDX-License-Identifier: GPL-3.0-or-later
 * Solver of the complementarity problem of contact with friction (perigal/contact.h), in forces and gaps of a
 * few to a few hundred pairs, with a dense symmetric compliance C.
 *
 * Relaxation (projected Gauss-Seidel; Jourdan, Alart and Jean 1998): one pair after the other takes the
 * forces that its own conditions ask for while all others stay,
 *     f_n = max (0, f_n - g_n / C_nn),    f_t = f_t - (g_t - slip) / C_tt, cut at +-(mu f_n + c).
 * Without friction it converges for every positive definite C; with it wherever mu is not too large. It
 * converges slowly, but soon finds which pairs are open, stick or slide. With these statuses all conditions
 * are equations (active set): open f = 0; stick g_n = 0, g_t = slip; sliding g_n = 0, f_t = -s (mu f_n + c),
 * s the direction of slip. Their solution is exact; pairs whose inequalities it violates change their status,
 * and the equations are solved again. A status that does not settle goes back to relaxation with more sweeps.
 *
 * In 3D a pair has two tangents, f_t is cut to the circle of radius mu f_n + c with a step of one over the
 * larger C_tt, and the direction of slip is an unknown: sliding pairs fulfil
 *     f_t = (mu f_n + c) r / |r|,    r = f_t - (g_t - slip) / C_tt
 * (Alart and Curnier 1991), whose tangent is solved again with the other equations until nothing changes:
 * Newton's method, semi-smooth as r also says whether a pair slides (|r| > mu f_n + c). */
#include "perigal/contact.h"
#include <float.h>
#include <math.h>
#include <string.h>

/* Maximum rounds of relaxation and active set; passes of the active set per round; relaxation sweeps of the
 * first round (ROUND_GROWTH times more in each later one). */
enum { ROUNDS = 5, PASSES = 30, SWEEPS = 60, ROUND_GROWTH = 8 };
/* Relative tolerances: violation that changes a status; violation accepted if the active set does not settle
 * (a pair alternating by rounding); change of a sweep at which relaxation ends. */
static const double COUNTS = 1e-11, ACCEPTED = 1e-9, STILL = 1e-6;
/* Tolerance of Newton's method for the slip law, over the largest gap: rounding. */
static const double TURNED = 1e-13;

/* Workspace of one solve. */
typedef struct {
    const pg_contact_problem *p;
    pg_contact_solution *out;
    double  scale;                                     /* the largest gap or slip without contact, m */
    double *A, *b;                                     /* equations of the active set, a row per force */
} contact_work;

static size_t rows_of (const pg_contact_problem *p) { return p->dim * p->n; }
static double diagonal (const pg_contact_problem *p, size_t row) { return p->C[row * rows_of (p) + row]; }
static double friction (const pg_contact_problem *p, size_t k)
{
    return p->coefficient ? p->coefficient[k] : 0;
}
static double cohesion (const pg_contact_problem *p, size_t k) { return p->cohesion ? p->cohesion[k] : 0; }
/* Previous slip of pair k along tangent a (0, 1), m. */
static double slip_before (const pg_contact_problem *p, size_t k, size_t a)
{
    return p->slip ? p->slip[k * (p->dim - 1) + a] : 0;
}
/* Limit of |f_t| of pair k at a normal force (N), N. */
static double limit (const pg_contact_problem *p, size_t k, double normal)
{
    return normal > 0 ? friction (p, k) * normal + cohesion (p, k) : 0;
}
/* Sign of the slip of a status: 1, -1; 0: none. */
static double direction (unsigned char status)
{
    return status == PG_CONTACT_FORWARD ? 1 : status == PG_CONTACT_BACKWARD ? -1 : 0;
}

/* Computes the gaps g = g0 + C f. */
static void find_gaps (contact_work *w)
{
    const pg_contact_problem *p = w->p;
    size_t rows = rows_of (p);
    for (size_t i = 0; i < rows; i++) {
        double sum = p->gap[i];
        for (size_t j = 0; j < rows; j++) sum += p->C[i * rows + j] * w->out->force[j];
        w->out->gap[i] = sum;
    }
}

/* Pair with two tangents (3D): computes r = f_t - (g_t - slip) / C_tt, N; returns |r|. */
static double sliding_trial (const contact_work *w, size_t k, double r[2])
{
    const pg_contact_problem *p = w->p;
    size_t i = 3*k + 1;
    double most = fmax (diagonal (p, i), diagonal (p, i + 1));
    for (size_t a = 0; a < 2; a++)
        r[a] = w->out->force[i + a] - (w->out->gap[i + a] - slip_before (p, k, a)) / most;
    return hypot (r[0], r[1]);
}

/* Changes one force by df (N) and updates all gaps; returns the change of its own gap, m. */
static double push (contact_work *w, size_t row, double df)
{
    size_t rows = rows_of (w->p);
    const double *column = w->p->C + row * rows;
    w->out->force[row] += df;
    for (size_t i = 0; df != 0 && i < rows; i++) w->out->gap[i] += column[i] * df;
    return fabs (df) * column[row];
}

/* Relaxes the shear forces of a pair with two tangents, cut to the friction circle; returns the change, m. */
static double push_round (contact_work *w, size_t k)
{
    double r[2], size, most = limit (w->p, k, w->out->force[3*k]);
    size_t i = 3*k + 1;
    size = sliding_trial (w, k, r);
    double cut = size > most ? most / size : 1, moved = 0;
    for (size_t a = 0; a < 2; a++)
        moved = fmax (moved, push (w, i + a, cut * r[a] - w->out->force[i + a]));
    return moved;
}

/* One relaxation sweep over all pairs; returns the largest change of a gap, m. */
static double sweep (contact_work *w)
{
    const pg_contact_problem *p = w->p;
    double *f = w->out->force, *g = w->out->gap, most = 0;
    for (size_t k = 0; k < p->n; k++) {
        size_t i = p->dim * k;
        double normal = fmax (0, f[i] - g[i] / diagonal (p, i));
        most = fmax (most, push (w, i, normal - f[i]));
        if (p->dim == 3) {
            most = fmax (most, push_round (w, k));
            continue;
        }
        double most_shear = limit (p, k, f[i]);
        double shear = f[i + 1] - (g[i + 1] - slip_before (p, k, 0)) / diagonal (p, i + 1);
        shear = fmax (-most_shear, fmin (most_shear, shear));
        most = fmax (most, push (w, i + 1, shear - f[i + 1]));
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

/* Sets the status of all pairs by the forces from relaxation. */
static void read_status (contact_work *w)
{
    const pg_contact_problem *p = w->p;
    const double *f = w->out->force;
    for (size_t k = 0; k < p->n; k++) {
        size_t i = p->dim * k;
        double most = limit (p, k, f[i]), r[2];
        w->out->status[k] = !(f[i] > 0)       ? PG_CONTACT_OPEN
                            : p->dim == 3     ? (most > 0 && sliding_trial (w, k, r) <= most
                                                     ? PG_CONTACT_STICK : PG_CONTACT_SLIDING)
                            : most > 0 && fabs (f[i + 1]) < most ? PG_CONTACT_STICK
                            : most > 0 ? (f[i + 1] < 0 ? PG_CONTACT_FORWARD : PG_CONTACT_BACKWARD)
                            : w->out->gap[i + 1] < slip_before (p, k, 0) ? PG_CONTACT_BACKWARD
                                                                         : PG_CONTACT_FORWARD;
    }
}

/* Sets row i of the equations: g_i = goal (m). */
static void set_gap (contact_work *w, size_t i, double goal)
{
    size_t rows = rows_of (w->p);
    for (size_t j = 0; j < rows; j++) w->A[j * rows + i] = w->p->C[j * rows + i];
    w->b[i] = goal - w->p->gap[i];
}

/* Sets row i: f_i + share f_(i - 1) = goal (N), times C_ii, so that all rows are lengths. */
static void set_force (contact_work *w, size_t i, double share, double goal)
{
    size_t rows = rows_of (w->p);
    for (size_t j = 0; j < rows; j++) w->A[j * rows + i] = 0;
    w->A[i * rows + i] = diagonal (w->p, i);
    if (share != 0) w->A[(i - 1) * rows + i] = share * diagonal (w->p, i);
    w->b[i] = goal * diagonal (w->p, i);
}

/* Sets the two tangential rows of a sliding pair in 3D: with e = r / |r| and P = 1 - e e' at the current
 * forces, f_t - e mu f_n - q P r (f) = e c, q = (mu f_n + c) / |r|, r linear in f. */
static void set_slip (contact_work *w, size_t k)
{
    const pg_contact_problem *p = w->p;
    size_t rows = rows_of (p), n = 3*k, i = n + 1;
    double r[2], size = sliding_trial (w, k, r), most = fmax (diagonal (p, i), diagonal (p, i + 1)),
           q = size > 0 ? fmin (1, limit (p, k, w->out->force[n]) / size) : 0;
    for (size_t a = 0; a < 2; a++) r[a] = size > 0 ? r[a] / size : 0;
    for (size_t a = 0; a < 2; a++) {
        double across[2], scale = diagonal (p, i + a);
        for (size_t b = 0; b < 2; b++) across[b] = q * ((a == b) - r[a] * r[b]);
        for (size_t j = 0; j < rows; j++)
            w->A[j * rows + i + a] = scale * (across[0] * p->C[j * rows + i]
                                              + across[1] * p->C[j * rows + i + 1]) / most;
        w->A[(i + a) * rows + i + a] += scale;
        for (size_t b = 0; b < 2; b++) w->A[(i + b) * rows + i + a] -= scale * across[b];
        w->A[n * rows + i + a] -= scale * r[a] * friction (p, k);
        w->b[i + a] = scale * r[a] * cohesion (p, k);
        for (size_t b = 0; b < 2; b++)
            w->b[i + a] -= scale * across[b] * (p->gap[i + b] - slip_before (p, k, b)) / most;
    }
}

/* Solves for forces and gaps of the current statuses. */
static pg_status solve_status (contact_work *w)
{
    pg_status status = PG_OK;
    const pg_contact_problem *p = w->p;
    size_t d = p->dim, rows = rows_of (p);
    for (size_t k = 0; k < p->n; k++) {
        double s = direction (w->out->status[k]);
        if (w->out->status[k] == PG_CONTACT_OPEN) {
            for (size_t a = 0; a < d; a++) set_force (w, d*k + a, 0, 0);
            continue;
        }
        set_gap (w, d*k, 0);
        if (w->out->status[k] == PG_CONTACT_SLIDING) set_slip (w, k);
        else if (s != 0) set_force (w, 2*k + 1, s * friction (p, k), -s * cohesion (p, k));
        else for (size_t a = 0; a + 1 < d; a++) set_gap (w, d*k + 1 + a, slip_before (p, k, a));
    }
    PG_TRY (pg_dense_lu (rows, w->A, 1, w->b));
    memcpy (w->out->force, w->b, rows * sizeof *w->b);
    find_gaps (w);
done:
    return status;
}

/* Status that a closed pair with one tangent (2D) should have by the current solution; tiny: tolerance, m. */
static unsigned char better_line (const contact_work *w, size_t k, double tiny)
{
    const pg_contact_problem *p = w->p;
    unsigned char now = w->out->status[k];
    double shear = w->out->force[2*k + 1], slip = w->out->gap[2*k + 1] - slip_before (p, k, 0),
           most = limit (p, k, w->out->force[2*k]), s = direction (now);
    if (now == PG_CONTACT_STICK) {
        if (!((fabs (shear) - most) * diagonal (p, 2*k + 1) > tiny)) return now;
        return shear < 0 ? PG_CONTACT_FORWARD : PG_CONTACT_BACKWARD;
    }
    if (friction (p, k) > 0 || cohesion (p, k) > 0) return s * slip < -tiny ? PG_CONTACT_STICK : now;
    /* without friction the direction is only reported */
    return slip < -tiny ? PG_CONTACT_BACKWARD : slip > tiny ? PG_CONTACT_FORWARD : now;
}

/* Status that a closed pair with two tangents (3D) should have; *left: maximum residual of the slip law, m,
 * updated. */
static unsigned char better_plane (const contact_work *w, size_t k, double tiny, double *left)
{
    const pg_contact_problem *p = w->p;
    double r[2], size = sliding_trial (w, k, r), most = limit (p, k, w->out->force[3*k]),
           scale = fmax (diagonal (p, 3*k + 1), diagonal (p, 3*k + 2));
    if (w->out->status[k] == PG_CONTACT_STICK)
        return (size - most) * scale > tiny ? PG_CONTACT_SLIDING : PG_CONTACT_STICK;
    if (!(friction (p, k) > 0) && !(cohesion (p, k) > 0)) return PG_CONTACT_SLIDING;
    if ((size - most) * scale < -tiny) return PG_CONTACT_STICK;
    for (size_t a = 0; a < 2 && size > 0; a++)
        *left = fmax (*left, fabs (w->out->force[3*k + 1 + a] - most * r[a] / size) * scale);
    return PG_CONTACT_SLIDING;
}

/* Status that pair k should have by the current solution. */
static unsigned char better (const contact_work *w, size_t k, double tiny, double *left)
{
    const pg_contact_problem *p = w->p;
    size_t i = p->dim * k;
    if (w->out->status[k] == PG_CONTACT_OPEN) {
        if (!(w->out->gap[i] < -tiny)) return PG_CONTACT_OPEN;
        if (friction (p, k) > 0 || cohesion (p, k) > 0) return PG_CONTACT_STICK;
        if (p->dim == 3) return PG_CONTACT_SLIDING;
        return w->out->gap[i + 1] - slip_before (p, k, 0) < 0 ? PG_CONTACT_BACKWARD : PG_CONTACT_FORWARD;
    }
    if (w->out->force[i] * diagonal (p, i) < -tiny) return PG_CONTACT_OPEN;
    return p->dim == 3 ? better_plane (w, k, tiny, left) : better_line (w, k, tiny);
}

/* Passes of the active set until no pair changes its status and no slip its direction. *settled 1: converged;
 * 0: not, or singular equations. */
static pg_status polish (contact_work *w, int *settled)
{
    pg_status status = PG_OK;
    double before = INFINITY;
    *settled = 0;
    for (int pass = 0; pass < PASSES && !*settled; pass++) {
        pg_status now = solve_status (w);
        w->out->passes++;
        if (now == PG_E_SINGULAR) return PG_OK;
        PG_TRY (now);
        double left = 0;
        *settled = 1;
        for (size_t k = 0; k < w->p->n; k++) {
            unsigned char next = better (w, k, COUNTS * w->scale, &left);
            if (next != w->out->status[k]) *settled = 0;
            w->out->status[k] = next;
        }
        /* a small residual that no longer decreases is rounding */
        if (left > TURNED * w->scale && (left > COUNTS * w->scale || left < 0.5 * before)) *settled = 0;
        before = left;
    }
done:
    return status;
}

/* Violation of the slip law of a pair with two tangents, m: shear force above its limit; or the lesser of the
 * slip and the deviation of the shear force from the one that opposes it. */
static double slip_violation (const pg_contact_problem *p, const pg_contact_solution *s, size_t k)
{
    size_t i = 3*k + 1;
    double w[2], off[2], scale = fmax (diagonal (p, i), diagonal (p, i + 1)),
           most = limit (p, k, s->force[3*k]),
           worst = (hypot (s->force[i], s->force[i + 1]) - most) * scale;
    for (size_t a = 0; a < 2; a++) w[a] = s->gap[i + a] - slip_before (p, k, a);
    double slip = hypot (w[0], w[1]);
    for (size_t a = 0; a < 2; a++) off[a] = s->force[i + a] + (slip > 0 ? most * w[a] / slip : 0);
    return most > 0 ? fmax (worst, fmin (slip, hypot (off[0], off[1]) * scale)) : worst;
}

/* Largest violation of the conditions of one pair, m, whatever its status. */
static double violation_of (const pg_contact_problem *p, const pg_contact_solution *s, size_t k)
{
    size_t i = p->dim * k;
    double normal = s->force[i], shear = s->force[i + 1], gap = s->gap[i],
           slip = s->gap[i + 1] - slip_before (p, k, 0), most = limit (p, k, normal),
           ct = diagonal (p, i + 1), worst = fmax (-gap, -normal * diagonal (p, i));
    worst = fmax (worst, fmin (gap, normal * diagonal (p, i)));        /* a force only if closed */
    if (p->dim == 3) return fmax (worst, slip_violation (p, s, k));
    worst = fmax (worst, (fabs (shear) - most) * ct);
    /* slip only with the opposing shear force at its limit: one of both is zero */
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
    for (size_t i = 0; i < rows_of (p); i++) scale = fmax (scale, fabs (p->gap[i]));
    for (size_t k = 0; k < p->n; k++)
        for (size_t a = 0; a + 1 < p->dim; a++) scale = fmax (scale, fabs (slip_before (p, k, a)));
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

/* Checks the data of the problem; sets the scale. */
static pg_status look_at (contact_work *w)
{
    pg_status status = PG_OK;
    const pg_contact_problem *p = w->p;
    if (p->n && p->dim != 2 && p->dim != 3)
        PG_FAIL (PG_E_USAGE, "pairs of contact have 2 rows in the plane and 3 in space, not %zu", p->dim);
    for (size_t i = 0; i < rows_of (p); i++) {
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

/* Counts the pairs of each status; sets forces of open pairs to exactly zero. */
static void count (contact_work *w)
{
    pg_contact_solution *o = w->out;
    o->open = o->stick = o->sliding = 0;
    for (size_t k = 0; k < w->p->n; k++) {
        if (o->status[k] == PG_CONTACT_OPEN) {
            o->open++;
            for (size_t a = 0; a < w->p->dim; a++) o->force[w->p->dim * k + a] = 0;
        } else if (o->status[k] == PG_CONTACT_STICK) o->stick++;
        else o->sliding++;
    }
}

pg_status pg_contact_solve (pg_contact_solution *out, const pg_contact_problem *p)
{
    pg_status status = PG_OK;
    contact_work w = { .p = p, .out = out };
    size_t rows = rows_of (p), sweeps = SWEEPS;
    int settled = p->n == 0;
    out->open = out->stick = out->sliding = out->sweeps = out->passes = 0, out->violation = 0;
    PG_TRY (look_at (&w));
    PG_ALLOC (w.A, rows * rows);
    PG_ALLOC (w.b, rows);
    memset (out->force, 0, rows * sizeof *out->force);
    for (int round = 0; round < ROUNDS && !settled; round++, sweeps *= ROUND_GROWTH) {
        /* restarts from zero after an active set that did not converge */
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

/* SPDX-License-Identifier: GPL-3.0-or-later
 * Contact along a path of loads (perigal/contact.h): if the gaps without contact are linear in s, so are
 * forces and gaps as long as no pair changes its status, and the next change is found by a ratio test.
 *
 * In the rate form the possible rates of every pair at s are known: open pairs are free, pairs inside the
 * friction cone are fixed, those on its edge stick or slide, those that just touch open, stick or slide. The
 * rates f', g' solve a complementarity problem themselves, g' = rate + C f',
 *     held: g' = 0;   touch: g_n' >= 0, f_n' >= 0, f_n' g_n' = 0;
 *     edge (slip towards s): g_n' = 0; g_t' = 0, - s f_t' <= mu f_n', or f_t' = - s mu f_n', s g_t' >= 0,
 * which is solved by an active set, and by projected Gauss-Seidel if that cycles. A slip whose direction
 * would reverse sticks at once, as its pair is on the edge.
 *
 * In 3D the cone is round, and forces on its edge are not linear in s: there all this holds only without
 * friction and cohesion, for the normals. */
#include "perigal/contact.h"
#include <float.h>
#include <math.h>
#include <string.h>

/* Active set passes in which all wrong pairs change, and passes with one change each; maximum sweeps of
 * Gauss-Seidel; bound of status changes per pair. */
enum { PASSES = 12, SINGLES = 60, SWEEPS = 20000, MOST_CHANGES = 1000 };
/* Relative tolerances: gaps and their rates; change of a sweep at convergence; shear force that an opening
 * pair may lose without a jump of the state (avoids sequences of tiny jumps). */
static const double COUNTS = 1e-12, STILL = 1e-11, LOST = 1e-10;

/* State of the shear force of a closed pair: no friction; inside the friction cone (slip fixed); on its edge;
 * at its apex, where the direction of slip is not yet known. */
typedef enum { SMOOTH, INSIDE, EDGE, APEX } shear_freedom;
/* Normal state of a contact pair: open; pressing; just touching. */
typedef enum { APART, PRESSED, TOUCHING } normal_freedom;

typedef struct {
    const pg_contact_path *p;
    pg_contact_track *m;
    /* direction along the path, 1 or -1; tolerance of lengths, m; tolerance of rates, m per unit of s */
    double sense, tiny, slow;
    double *A, *b, *df, *dg;                           /* equations; rates of f and g along `sense` (dim n) */
    unsigned char *normal, *shear;                     /* normal_freedom, shear_freedom of each pair (n) */
} track_work;

static size_t rows_of (const pg_contact_path *p) { return p->dim * p->n; }
static double diagonal (const pg_contact_path *p, size_t row) { return p->C[row * rows_of (p) + row]; }
static double friction (const pg_contact_path *p, size_t k)
{
    return p->coefficient ? p->coefficient[k] : 0;
}
static double cohesion (const pg_contact_path *p, size_t k) { return p->cohesion ? p->cohesion[k] : 0; }
static int is_rough (const pg_contact_path *p, size_t k)
{
    return friction (p, k) > 0 || cohesion (p, k) > 0;
}
static double direction (unsigned char status)
{
    return status == PG_CONTACT_FORWARD || status == PG_CONTACT_SLIDING ? 1
           : status == PG_CONTACT_BACKWARD                              ? -1
                                                                        : 0;
}
static unsigned char sliding (const pg_contact_path *p, double direction)
{
    return p->dim == 3 ? PG_CONTACT_SLIDING : direction > 0 ? PG_CONTACT_FORWARD : PG_CONTACT_BACKWARD;
}

/* Reserve of shear force of pair k, limit - |f_t|, times C_tt, m. */
static double room (const track_work *w, size_t k)
{
    const size_t d = w->p->dim;
    const double *f = w->m->force + d*k;
    return (friction (w->p, k) * f[0] + cohesion (w->p, k) - fabs (f[1])) * diagonal (w->p, d*k + 1);
}

/* Computes the gaps g = gap + s rate + C f. */
static void find_gaps (const pg_contact_path *p, pg_contact_track *m)
{
    size_t rows = rows_of (p);
    for (size_t i = 0; i < rows; i++) {
        double sum = p->gap[i] + m->s * p->rate[i];
        for (size_t j = 0; j < rows; j++) sum += p->C[i * rows + j] * m->force[j];
        m->gap[i] = sum;
    }
}

/* ---- rates --------------------------------------------------------------------------------------------- */
static void look_at_freedom (track_work *w)
{
    const size_t d = w->p->dim;
    pg_contact_track *m = w->m;
    for (size_t k = 0; k < w->p->n; k++) {
        int due = m->due[k];
        double press = m->force[d*k] * diagonal (w->p, d*k);
        if (m->status[k] == PG_CONTACT_OPEN)
            w->normal[k] = due || m->gap[d*k] <= w->tiny ? TOUCHING : APART;
        else w->normal[k] = press <= w->tiny ? TOUCHING : PRESSED;
        int inside = m->status[k] != PG_CONTACT_STICK && m->status[k] != PG_CONTACT_OPEN ? 0
                     : room (w, k) > w->tiny && !(due && w->normal[k] == PRESSED);
        w->shear[k] = !is_rough (w->p, k)                                      ? SMOOTH
                      : w->normal[k] != PRESSED && !(cohesion (w->p, k) > 0)   ? APEX
                      : inside                                                 ? INSIDE
                                                                               : EDGE;
    }
}

/* Direction in which a pair on the edge of the cone would slide: against its shear force. */
static double edge_direction (const track_work *w, size_t k)
{
    const size_t d = w->p->dim;
    double now = direction (w->m->status[k]);
    return now != 0 ? now : w->m->force[d*k + 1] < 0 ? 1 : -1;
}

/* Initial statuses of the search: those of due pairs change. */
static void change_due (track_work *w)
{
    const size_t d = w->p->dim;
    pg_contact_track *m = w->m;
    for (size_t k = 0; k < w->p->n; k++) {
        if (!m->due[k]) continue;
        if (m->status[k] == PG_CONTACT_OPEN)
            m->status[k] = w->shear[k] == SMOOTH ? sliding (w->p, m->gap[d*k + 1]) : PG_CONTACT_STICK;
        else if (w->normal[k] == TOUCHING) m->status[k] = PG_CONTACT_OPEN;
        else if (m->status[k] == PG_CONTACT_STICK) m->status[k] = sliding (w->p, edge_direction (w, k));
        else m->status[k] = PG_CONTACT_STICK;
    }
}

/* Solves for the rates of forces and gaps with the current statuses. */
static pg_status solve_rates (track_work *w)
{
    const size_t d = w->p->dim;
    pg_status status = PG_OK;
    const pg_contact_path *p = w->p;
    size_t rows = rows_of (p);
    memset (w->A, 0, rows * rows * sizeof *w->A);
    for (size_t i = 0; i < rows; i++) {
        size_t k = i / d;
        double s = direction (w->m->status[k]);
        int open = w->m->status[k] == PG_CONTACT_OPEN, slides = i % d && s != 0;
        for (size_t j = 0; !open && !slides && j < rows; j++) w->A[j * rows + i] = p->C[j * rows + i];
        w->b[i] = open || slides ? 0 : -w->sense * p->rate[i];
        if (!open && !slides) continue;
        w->A[i * rows + i] = diagonal (p, i);
        if (slides) w->A[(i - 1) * rows + i] = s * friction (p, k) * diagonal (p, i);
    }
    w->m->solves++;
    PG_TRY (pg_dense_lu (rows, w->A, 1, w->b));
    memcpy (w->df, w->b, rows * sizeof *w->b);
    for (size_t i = 0; i < rows; i++) {
        double sum = w->sense * p->rate[i];
        for (size_t j = 0; j < rows; j++) sum += p->C[i * rows + j] * w->df[j];
        w->dg[i] = sum;
    }
done:
    return status;
}

/* Status that pair k should have by the current rates; *wrong: violation by its present status, m per unit of
 * s. */
static unsigned char better (const track_work *w, size_t k, double *wrong)
{
    const size_t d = w->p->dim;
    unsigned char now = w->m->status[k];
    double fn = w->df[d*k], ft = w->df[d*k + 1], gn = w->dg[d*k], gt = w->dg[d*k + 1],
           mu = friction (w->p, k), ct = diagonal (w->p, d*k + 1), s = direction (now);
    *wrong = 0;
    if (w->normal[k] == TOUCHING && now == PG_CONTACT_OPEN) {
        if (!((*wrong = -gn) > w->slow)) return now;
        return w->shear[k] == SMOOTH ? sliding (w->p, w->m->gap[d*k + 1]) : PG_CONTACT_STICK;
    }
    if (now == PG_CONTACT_OPEN) return now;
    if (w->normal[k] == TOUCHING && (*wrong = -fn * diagonal (w->p, d*k)) > w->slow) return PG_CONTACT_OPEN;
    if (w->shear[k] == SMOOTH || w->shear[k] == INSIDE) return now;
    if (now != PG_CONTACT_STICK) return (*wrong = -s * gt) > w->slow ? PG_CONTACT_STICK : now;
    double to = w->shear[k] == APEX ? (ft < 0 ? 1 : -1) : edge_direction (w, k);
    return (*wrong = (-to * ft - mu * fn) * ct) > w->slow ? sliding (w->p, to) : now;
}

/* Corrects statuses: all = 1: of every wrong pair, 0: of the worst only. Returns 1: none was wrong. */
static int improve (track_work *w, int all)
{
    size_t worst = 0, count = 0;
    double most = 0, wrong;
    for (size_t k = 0; k < w->p->n; k++) {
        unsigned char next = better (w, k, &wrong);
        if (next == w->m->status[k]) continue;
        count++;
        if (wrong > most) most = wrong, worst = k;
        if (all) w->m->status[k] = next;
    }
    if (count && !all) w->m->status[worst] = better (w, worst, &wrong);
    return count == 0;
}

/* Sets one rate of force and updates all rates of gaps; returns the change of its own rate. */
static double push (track_work *w, size_t row, double to)
{
    size_t rows = rows_of (w->p);
    double change = to - w->df[row];
    w->df[row] = to;
    for (size_t i = 0; change != 0 && i < rows; i++) w->dg[i] += w->p->C[row * rows + i] * change;
    return fabs (change) * diagonal (w->p, row);
}

static double sweep_pair (track_work *w, size_t k)
{
    const size_t d = w->p->dim;
    size_t n = d*k, t = n + 1;
    double most = 0, s = edge_direction (w, k), mu = friction (w->p, k);
    if (w->normal[k] == APART) return 0;
    double normal = w->df[n] - w->dg[n] / diagonal (w->p, n);
    most = push (w, n, w->normal[k] == TOUCHING ? fmax (0, normal) : normal);
    double shear = w->df[t] - w->dg[t] / diagonal (w->p, t), cone = mu * w->df[n];
    if (w->shear[k] == SMOOTH || (w->normal[k] == TOUCHING && !(w->df[n] > 0))) shear = 0;
    else if (w->shear[k] == EDGE) shear = s * fmax (-cone, s * shear);
    else if (w->shear[k] == APEX) shear = fmax (-cone, fmin (cone, shear));
    return fmax (most, push (w, t, shear));
}

/* Finds rates by projected Gauss-Seidel, and the statuses that follow from them. */
static void relax (track_work *w)
{
    const size_t d = w->p->dim;
    for (size_t i = 0; i < rows_of (w->p); i++) w->df[i] = 0, w->dg[i] = w->sense * w->p->rate[i];
    for (int sweep = 0; sweep < SWEEPS; sweep++) {
        double most = 0;
        for (size_t k = 0; k < w->p->n; k++) most = fmax (most, sweep_pair (w, k));
        w->m->sweeps++;
        if (!(most > STILL * w->slow / COUNTS)) break;
    }
    for (size_t k = 0; k < w->p->n; k++) {
        unsigned char *now = &w->m->status[k];
        double fn = w->df[d*k], ft = w->df[d*k + 1], s = edge_direction (w, k),
               cone = friction (w->p, k) * fn;
        if (w->normal[k] == APART || (w->normal[k] == TOUCHING && !(fn > 0))) *now = PG_CONTACT_OPEN;
        else if (w->shear[k] == SMOOTH) *now = sliding (w->p, w->m->gap[d*k + 1]);
        else if (w->shear[k] == INSIDE) *now = PG_CONTACT_STICK;
        else if (w->shear[k] == EDGE) *now = -s * ft < cone ? PG_CONTACT_STICK : sliding (w->p, s);
        else *now = fabs (ft) < cone ? PG_CONTACT_STICK : sliding (w->p, -ft);
    }
}

/* Finds statuses and rates for the continuation from the current s. *found 0: none exists, or none was
 * found. */
static pg_status settle (track_work *w, int *found)
{
    pg_status status = PG_OK;
    *found = 0;
    look_at_freedom (w), change_due (w);
    for (int pass = 0; pass < PASSES + SINGLES && !*found; pass++) {
        if (pass == PASSES + SINGLES / 2) relax (w);
        pg_status now = solve_rates (w);
        if (now == PG_E_SINGULAR) {
            relax (w);
            continue;
        }
        PG_TRY (now);
        *found = improve (w, pass < PASSES);
    }
done:
    return status;
}

/* ---- stretches ----------------------------------------------------------------------------------------- */
/* Distance along s after which a nonnegative quantity reaches zero; INFINITY: not within `range`. */
static double way_to_zero (double value, double rate, double range, double tiny)
{
    if (!(value + rate * range < -tiny)) return INFINITY;
    return fmax (0, value) / -rate;
}

static double way_of_pair (const track_work *w, size_t k, double range)
{
    const size_t d = w->p->dim;
    const pg_contact_track *m = w->m;
    const pg_contact_path *p = w->p;
    double cn = diagonal (p, d*k), ct = diagonal (p, d*k + 1), s = direction (m->status[k]), least;
    if (m->status[k] == PG_CONTACT_OPEN) return way_to_zero (m->gap[d*k], w->dg[d*k], range, w->tiny);
    least = way_to_zero (m->force[d*k] * cn, w->df[d*k] * cn, range, w->tiny);
    if (s != 0) {
        if (!p->slip || !is_rough (p, k)) return least;
        return fmin (least, way_to_zero (s * (m->gap[d*k + 1] - p->slip[k]), s * w->dg[d*k + 1], range,
                                         w->tiny));
    }
    for (int sign = -1; sign <= 1; sign += 2) {
        double most = friction (p, k) * m->force[d*k] + cohesion (p, k);
        least = fmin (least, way_to_zero ((most - sign * m->force[d*k + 1]) * ct,
                                          (friction (p, k) * w->df[d*k] - sign * w->df[d*k + 1]) * ct, range,
                                          w->tiny));
    }
    return least;
}

/* Finds the end of the stretch, where the first pair changes its status, and the pairs due there. */
static void find_end (track_work *w, double until)
{
    pg_contact_track *m = w->m;
    double range = fabs (until - m->s), least = INFINITY;
    for (size_t k = 0; k < w->p->n; k++) least = fmin (least, way_of_pair (w, k, range));
    m->changes = least < range;
    m->end = m->changes ? m->s + w->sense * least : until;
    for (size_t k = 0; k < w->p->n; k++)
        m->due[k] = m->changes && way_of_pair (w, k, range) <= least * (1 + COUNTS);
}

/* Returns 1: pair k has opened with a shear force left, which only cohesion can cause and which is lost at
 * once. */
static int drops (const track_work *w, size_t k)
{
    const size_t d = w->p->dim;
    const pg_contact_track *m = w->m;
    return m->status[k] == PG_CONTACT_OPEN
           && fabs (m->force[d*k + 1]) * diagonal (w->p, d*k + 1) > LOST / COUNTS * w->tiny;
}
static int any_drops (const track_work *w)
{
    for (size_t k = 0; k < w->p->n; k++) if (drops (w, k)) return 1;
    return 0;
}

/* Solves the contact problem at s, slips counting from `slip`; lost: 1: the pair has no cohesion (n); NULL:
 * none. */
static pg_status solve_at (pg_contact_track *m, const pg_contact_path *p, double s, const double *slip,
                           const unsigned char *lost)
{
    pg_status status = PG_OK;
    double *gap = NULL, *c = NULL;
    PG_ALLOC (gap, rows_of (p) + 1);
    PG_ALLOC (c, p->n + 1);
    for (size_t i = 0; i < rows_of (p); i++) gap[i] = p->gap[i] + s * p->rate[i];
    for (size_t k = 0; k < p->n; k++) c[k] = lost && lost[k] ? 0 : cohesion (p, k);
    pg_contact_problem problem = { p->n, p->dim, p->C, gap, p->coefficient, c, slip };
    pg_contact_solution solution = { .force = m->force, .gap = m->gap, .status = m->status };
    PG_TRY (pg_contact_solve (&solution, &problem));
    m->s = m->end = s, m->changes = 0;
    m->solves += (long) solution.passes, m->sweeps += (long) solution.sweeps;
    memset (m->due, 0, p->n);
done:
    pg_free (gap), pg_free (c);
    return status;
}

pg_status pg_contact_begin (pg_contact_track *m, const pg_contact_path *p, double s, const double *slip)
{
    return solve_at (m, p, s, slip, NULL);
}

/* Jumps to a new equilibrium at the same s, without the cohesion of opened pairs and with present slips kept.
 * Pairs that close again regain cohesion. */
static pg_status leap (track_work *w)
{
    pg_status status = PG_OK;
    const size_t d = w->p->dim;
    double *slip = NULL;
    unsigned char *lost = NULL;
    PG_ALLOC (slip, rows_of (w->p) + 1);
    PG_ALLOC (lost, w->p->n + 1);
    for (size_t k = 0; k < w->p->n; k++) {
        memcpy (slip + (d - 1) * k, w->m->gap + d*k + 1, (d - 1) * sizeof *slip);
        lost[k] = (unsigned char) drops (w, k);
    }
    PG_TRY (solve_at (w->m, w->p, w->m->s, slip, lost));
    for (size_t k = 0; k < w->p->n; k++)
        if (lost[k] && w->m->status[k] != PG_CONTACT_OPEN) w->m->status[k] = PG_CONTACT_STICK;
    w->m->leaps++;
done:
    pg_free (slip), pg_free (lost);
    return status;
}

static void set_sizes (track_work *w, double until)
{
    double far = fmax (fabs (w->m->s), fabs (until)), length = 0, rate = 0;
    for (size_t i = 0; i < rows_of (w->p); i++) {
        length = fmax (length, fabs (w->p->gap[i]) + far * fabs (w->p->rate[i]));
        length = fmax (length, fabs (w->m->gap[i]));
        rate = fmax (rate, fabs (w->p->rate[i]));
    }
    w->tiny = COUNTS * length, w->slow = COUNTS * rate;
}

static pg_status no_way (const track_work *w)
{
    return pg_error (PG_E_EQUILIBRIUM, PG_HERE,
                     "contact with friction: the rates of %zu pairs do not settle at %.6g of the path of "
                     "loads (%ld solves, %ld sweeps); a smaller contact.coefficient settles sooner",
                     w->p->n, w->m->s, w->m->solves, w->m->sweeps);
}

pg_status pg_contact_stretch (pg_contact_track *m, const pg_contact_path *p, double until)
{
    pg_status status = PG_OK;
    track_work w = { .p = p, .m = m, .sense = until < m->s ? -1 : 1 };
    size_t rows = rows_of (p);
    int found = 1;
    m->leapt = 0;
    if (m->s != m->end) memset (m->due, 0, p->n);
    PG_ALLOC (w.A, rows * rows + 1);
    PG_ALLOC (w.b, rows + 1);
    PG_ALLOC (w.df, rows + 1);
    PG_ALLOC (w.dg, rows + 1);
    PG_ALLOC (w.normal, p->n + 1);
    PG_ALLOC (w.shear, p->n + 1);
    set_sizes (&w, until);
    if (p->slip) PG_TRY (solve_rates (&w));
    else PG_TRY (settle (&w, &found));
    for (size_t k = 0; !p->slip && (!found || any_drops (&w)); k++) {
        m->leapt = 1;
        if (k > p->n) PG_TRY (no_way (&w));
        PG_TRY (leap (&w));
        set_sizes (&w, until);
        PG_TRY (settle (&w, &found));
    }
    for (size_t i = 0; i < rows; i++)
        m->force_rate[i] = w.sense * w.df[i], m->gap_rate[i] = w.sense * w.dg[i];
    find_end (&w, until);
    if (m->total > MOST_CHANGES * (long) (p->n + 1)) PG_TRY (no_way (&w));
done:
    pg_free (w.A), pg_free (w.b), pg_free (w.df), pg_free (w.dg), pg_free (w.normal), pg_free (w.shear);
    return status;
}

void pg_contact_go (pg_contact_track *m, const pg_contact_path *p, double s)
{
    const size_t d = p->dim;
    double way = s - m->s;
    for (size_t k = 0; k < p->n; k++) {
        double *f = m->force + d*k, to = direction (m->status[k]);
        for (size_t i = 0; i < d; i++) f[i] += way * m->force_rate[d*k + i];
        if (m->status[k] == PG_CONTACT_OPEN) memset (f, 0, d * sizeof *f);
        else if (m->due[k] && s == m->end && f[0] * diagonal (p, d*k) <= 0) f[0] = 0;
        if (to != 0) f[1] = -to * (friction (p, k) * f[0] + cohesion (p, k));
    }
    m->s = s;
    find_gaps (p, m);
    for (size_t k = 0; m->changes && s == m->end && k < p->n; k++) m->total += m->due[k];
    for (size_t k = 0; d == 2 && k < p->n; k++)
        if (!is_rough (p, k) && m->status[k] != PG_CONTACT_OPEN)
            m->status[k] = m->gap[d*k + 1] < (p->slip ? p->slip[k] : 0) ? PG_CONTACT_BACKWARD
                                                                        : PG_CONTACT_FORWARD;
}

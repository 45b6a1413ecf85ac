/* SPDX-License-Identifier: GPL-3.0-or-later
 * Work of the loads along the rigid motions of parts that nothing resists: forces inside the part do no work
 * along them, so that there is an equilibrium only where the loads themselves balance. This needs no solver
 * and no solution, whose forces may be anything where K is singular. */
#include "solve/run/body_parts.h"
#include "perigal/ranks.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* Loads of a part below this share of all loads count as rounding. */
static const double NOTHING = 1e-13;
/* A static state is refused if a point has moved by more than this many lengths of the body. */
static const double NOWHERE = 1e6;
/* A motion counts as free if this share of it (squares) lies in the space of the free motions. */
static const double AMONG = 1 - 1e-6;
/* An axis counts as across a line where less than this of it is along the line. */
static const double ALMOST = 1e-5;

/* Work of the loads along the free motions of each part, and the sum of the sizes of its loads, N (moments on
 * points by their work on rotational unknowns). spin: sum of the moments, over the spacing, that turn points
 * on a line about it where no rotation is prescribed, as bonds resist no twist. */
typedef struct {
    const pg_system *s;
    body_parts parts;
    double *work;  /* work of the loads along each unit free motion, N (MOST a part) */
    double *size, *spin, all;                          /* N, of each part; all: of the body */
} along_motions;
enum { MOST = 6 };

static void clear (along_motions *w)
{
    body_parts_clear (&w->parts);
    pg_free (w->work), pg_free (w->size), pg_free (w->spin);
}

/* Loads at t at zero displacement, with present contact forces and those of removed parts, N (ndof). */
static pg_status find_loads (pg_system *s, double t, double *force)
{
    pg_status status = PG_OK;
    const double *contact = s->balance.pressed;
    double *zero = NULL, reference;
    PG_ALLOC (zero, s->ndof);
    if (s->force->loads) PG_TRY (s->force->loads (s->self, t, force));
    else PG_TRY (s->force->balance (s->self, t, zero, force, &reference));
    for (size_t i = 0; i < s->ndof; i++)
        force[i] += (contact ? contact[i] : 0) + (s->balance.excavated ? s->balance.excavated[i] : 0);
    system_clear_ghosts (s, force);
done:
    pg_free (zero);
    return status;
}

/* turned[i] = 1: a prescribed rotation keeps point i from turning about the line that its part is. */
static void hold_spins (const along_motions *w, char *turned)
{
    const pg_problem *p = w->s->problem;
    for (size_t l = 0; l < p->boundary.nload; l++) {
        const pg_load *load = &p->boundary.load[l];
        if (!pg_load_prescribes (load) || !pg_load_rotates (load)) continue;
        for (size_t i = 0; i < load->set->npoint; i++) {
            const body_part *part = &w->parts.part[w->parts.of[load->set->point[i]]];
            for (int k = 0; k < 3 && part->line; k++)
                if (load->value[k] && fabs (part->axis[k]) > ALMOST) turned[load->set->point[i]] = 1;
        }
    }
}

static pg_status add_up (along_motions *w, const double *force)
{
    pg_status status = PG_OK;
    const pg_problem *p = w->s->problem;
    size_t dim = (size_t) p->dim, components = (size_t) w->s->components;
    char *turned = NULL;
    if (!w->parts.n) return PG_OK;
    PG_ALLOC (w->work, MOST * w->parts.n);
    PG_ALLOC (w->size, w->parts.n);
    PG_ALLOC (w->spin, w->parts.n);
    PG_ALLOC (turned, p->cloud.n);
    hold_spins (w, turned);
    for (size_t i = 0; i < p->cloud.n; i++) {
        size_t r = (size_t) w->parts.of[i];
        const body_part *part = &w->parts.part[r];
        const double *f = force + i * components;
        double square = 0, spin = 0;
        for (size_t k = 0; k < components; k++) square += f[k] * f[k];
        if (square == 0 || !pg_cloud_owns (&p->cloud, i)) continue;
        w->size[r] += sqrt (square);
        for (size_t j = 0; j < part->n; j++) {
            double u[MOST];
            body_part_shift (w->s, part, p->cloud.x + i * dim, part->motion[j], u);
            for (size_t k = 0; k < components; k++) w->work[MOST * r + j] += f[k] * u[k];
        }
        for (size_t k = dim; k < components && part->line && !turned[i]; k++)
            spin += f[k] * part->axis[k - dim];
        w->spin[r] += fabs (spin);
    }
    PG_TRY (pg_cloud_sum (&p->cloud, MOST * w->parts.n, w->work));
    PG_TRY (pg_cloud_sum (&p->cloud, w->parts.n, w->size));
    PG_TRY (pg_cloud_sum (&p->cloud, w->parts.n, w->spin));
    for (size_t r = 0; r < w->parts.n; r++) w->all += w->size[r];
done:
    pg_free (turned);
    return status;
}

/* Work of the loads along a unit motion of part r over the size of these loads; *work: the work, N. 0 where
 * the motion is not a free one. */
static double unbalanced (const along_motions *w, size_t r, const double *motion, double *work)
{
    const body_part *part = &w->parts.part[r];
    double among = 0;
    *work = 0;
    for (size_t j = 0; j < part->n; j++) {
        double share = 0;
        for (int a = 0; a < MOST; a++) share += part->motion[j][a] * motion[a];
        among += share * share, *work += share * w->work[MOST * r + j];
    }
    if (among < AMONG || w->size[r] <= NOTHING * w->all) return 0;
    return fabs (*work) / w->size[r];
}

/* Finds the unit motion along which the loads of a part do most work; returns the share that is
 * unbalanced. */
static double worst_motion (const along_motions *w, size_t r, double *motion)
{
    const body_part *part = &w->parts.part[r];
    double size = 0, work;
    memset (motion, 0, sizeof (rigid_motion));
    for (size_t j = 0; j < part->n; j++)
        for (int a = 0; a < MOST; a++) motion[a] += w->work[MOST * r + j] * part->motion[j][a];
    for (int a = 0; a < MOST; a++) size += motion[a] * motion[a];
    for (int a = 0; a < MOST && size > 0; a++) motion[a] /= sqrt (size);
    return size > 0 ? unbalanced (w, r, motion, &work) : 0;
}

/* ---- words --------------------------------------------------------------------------------------------- */
typedef struct { char text[400]; size_t used; } words;

static void say (words *w, const char *format, ...) __attribute__ ((format (printf, 2, 3)));
static void say (words *w, const char *format, ...)
{
    va_list args;
    va_start (args, format);
    if (w->used < sizeof w->text)
        w->used += (size_t) vsnprintf (w->text + w->used, sizeof w->text - w->used, format, args);
    va_end (args);
}

/* "along x (3 N) and about z (0.2 N m)": the axes along and about which a part is free and not in balance
 * (loaded 0: free); else the worst motion. */
static void say_motions (words *out, const along_motions *w, size_t r, int loaded)
{
    const body_part *part = &w->parts.part[r];
    int count = 0, found[MOST];
    double tolerance = w->s->options->tolerance, work[MOST];
    rigid_motion m;
    for (int a = 0; a < MOST; a++) {
        int flat = w->s->problem->dim == 2 ? a == 2 || a == 3 || a == 4 : w->s->problem->dim == 1 && a > 0;
        memset (m, 0, sizeof m);
        m[a] = 1;
        double share = unbalanced (w, r, m, &work[a]), among = 0;
        for (size_t j = 0; j < part->n; j++) among += part->motion[j][a] * part->motion[j][a];
        if (!flat && (loaded ? share > tolerance : among >= AMONG)) found[count++] = a;
    }
    for (int k = 0; k < count; k++) {
        int a = found[k];
        say (out, "%s%s %c", k == 0 ? "" : k + 1 < count ? ", " : " and ", a < 3 ? "along" : "about",
             "xyz"[a % 3]);
        if (loaded) say (out, " (%.3g N%s)", fabs (work[a]) * (a < 3 ? 1 : part->size), a < 3 ? "" : " m");
    }
    if (count) return;
    if (loaded) worst_motion (w, r, m);
    char way[BODY_PART_WORDS];
    body_part_way (w->s->problem, part, loaded ? m : part->motion[0], way, sizeof way);
    say (out, "%s", way);
    if (loaded) unbalanced (w, r, m, &work[0]), say (out, " (%.3g N)", fabs (work[0]));
}

/* Names the entries of `boundary` that load a part. */
static pg_status say_loads (words *out, const along_motions *w, size_t r)
{
    pg_status status = PG_OK;
    const pg_problem *p = w->s->problem;
    double *acts = NULL;
    int count = 0;
    PG_ALLOC (acts, p->boundary.nload);
    for (size_t l = 0; l < p->boundary.nload; l++) {
        const pg_load *load = &p->boundary.load[l];
        if (pg_load_prescribes (load) || load->kind == PG_SPRING || load->kind == PG_EIGENSTRAIN
            || !load->set)
            continue;
        for (size_t i = 0; i < load->set->npoint && acts[l] == 0; i++)
            acts[l] = (size_t) w->parts.of[load->set->point[i]] == r;
    }
    PG_TRY (pg_cloud_most (&p->cloud, p->boundary.nload, acts));
    for (size_t l = 0; l < p->boundary.nload; l++)
        if (acts[l] > 0 && count++ < 4)
            say (out, "%s%s", count == 1 ? "; it is loaded by " : ", ", p->boundary.load[l].name);
    if (count > 4) say (out, " and %d more", count - 4);
done:
    pg_free (acts);
    return status;
}

/* Message: moments turn points on a line about it, which nothing resists. */
static pg_status refuse_spin (const along_motions *w, size_t r)
{
    pg_status status = PG_OK;
    const pg_problem *p = w->s->problem;
    const body_part *part = &w->parts.part[r];
    words by = { .used = 0 };
    char place[BODY_PART_WORDS];
    body_part_place (p, part, place, sizeof place);
    PG_TRY (say_loads (&by, w, r));
    status = pg_error (PG_E_EQUILIBRIUM, PG_HERE,
                       "a part of the body, %s, is a line of points, each of which is free to turn about it, "
                       "along (%.3g, %.3g, %.3g), for bonds bear no twist: moments of %.3g N m about it find "
                       "no resistance%s; prescribe a rotation there, or give the line points beside it",
                       place, part->axis[0], part->axis[1], part->axis[2], w->spin[r] * p->cloud.h, by.text);
done:
    return status;
}

/* Message that names the part whose loads are out of balance most. */
static pg_status refuse (const along_motions *w, size_t r)
{
    pg_status status = PG_OK;
    const pg_problem *p = w->s->problem;
    const body_part *part = &w->parts.part[r];
    words where = { .used = 0 }, how = { .used = 0 }, by = { .used = 0 };
    double all = (double) pg_cloud_total (&p->cloud);
    char place[BODY_PART_WORDS];
    rigid_motion m;
    if (!(worst_motion (w, r, m) > w->s->options->tolerance)) return refuse_spin (w, r);
    body_part_place (p, part, place, sizeof place);
    if ((double) part->points == all) say (&where, "nothing holds the body");
    else say (&where, "a loose part of the body, %s, is held by nothing", place);
    say_motions (&how, w, r, 1);
    PG_TRY (say_loads (&by, w, r));
    status = pg_error (PG_E_EQUILIBRIUM, PG_HERE,
                       "%s: it is free to move %s, where its loads do not balance%s; prescribe displacements "
                       "(or springs) that keep it from that, let contact hold it (contact.kind, platens), or "
                       "use a solver of motion (newmark)", where.text, how.text, by.text);
done:
    return status;
}

/* ---- judging ------------------------------------------------------------------------------------------- */
static pg_status look (along_motions *w, pg_system *s, double t)
{
    pg_status status = PG_OK;
    double *force = NULL;
    w->s = s;
    PG_ALLOC (force, s->ndof);
    PG_TRY (body_parts_find (&w->parts, s));
    PG_TRY (find_loads (s, t, force));
    PG_TRY (add_up (w, force));
done:
    pg_free (force);
    return status;
}

/* The part that is out of balance by the largest share; SIZE_MAX: none. */
static size_t worst_part (const along_motions *w)
{
    size_t worst = SIZE_MAX;
    double most = w->s->options->tolerance;
    for (size_t r = 0; r < w->parts.n; r++) {
        rigid_motion m;
        double share = worst_motion (w, r, m);
        if (w->size[r] > NOTHING * w->all) share = fmax (share, w->spin[r] / w->size[r]);
        if (share > most) worst = r, most = share;
    }
    return worst;
}

/* Finds the parts and the work of loads along their free motions; PG_E_EQUILIBRIUM: some are out of
 * balance. */
static pg_status judge (along_motions *w, pg_system *s, double t)
{
    pg_status status = PG_OK;
    PG_TRY (look (w, s, t));
    size_t worst = worst_part (w);
    if (worst != SIZE_MAX) PG_TRY (refuse (w, worst));
done:
    return status;
}

pg_status body_parts_begin (pg_system *s, double t)
{
    system_balance *b = &s->balance;
    pg_status status = PG_OK;
    along_motions w = { 0 };
    PG_TRY (judge (&w, s, t));
    for (size_t r = 0; r < w.parts.n; r++) {
        const body_part *part = &w.parts.part[r];
        words how = { .used = 0 };
        char place[BODY_PART_WORDS];
        if (!part->n || w.size[r] <= NOTHING * w.all) continue;
        body_part_place (s->problem, part, place, sizeof place);
        say_motions (&how, &w, r, 0);
        pg_statistics_warn (s->report,
                            "a part of the body, %s, is free to move %s: its loads balance, and it keeps its "
                            "mean place and direction", place, how.text);
    }
    for (size_t r = 0; r < w.parts.n && !b->floating; r++) if (w.parts.part[r].n) PG_ALLOC (b->floating, 1);
    if (b->floating) *b->floating = w.parts, w.parts = (body_parts){ 0 };
done:
    clear (&w);
    return status;
}

/* Adds a point to the least squares fit of the free motions of its part to the displacement d (normal
 * equations). */
enum { NORMAL = MOST * MOST + MOST };
static void add_normal (const pg_system *s, const body_part *part, const double *x, const double *d,
                        double *sum)
{
    double u[MOST][MOST];
    size_t n = part->n;
    for (size_t a = 0; a < n; a++) body_part_shift (s, part, x, part->motion[a], u[a]);
    for (size_t a = 0; a < n; a++)
        for (int k = 0; k < s->components; k++) {
            for (size_t b = 0; b < n; b++) sum[a * n + b] += u[a][k] * u[b][k];
            sum[MOST * MOST + a] += u[a][k] * d[k];
        }
}

pg_status body_parts_centre (pg_system *s, double *d)
{
    pg_status status = PG_OK;
    const pg_problem *p = s->problem;
    const body_parts *parts = s->balance.floating;
    size_t dim = (size_t) p->dim, components = (size_t) s->components;
    double *sum = NULL;
    if (!parts) return PG_OK;
    PG_ALLOC (sum, NORMAL * parts->n);
    for (size_t i = 0; i < p->cloud.n; i++) {
        size_t r = (size_t) parts->of[i];
        if (!parts->part[r].n || !pg_cloud_owns (&p->cloud, i)) continue;
        add_normal (s, &parts->part[r], p->cloud.x + i * dim, d + i * components, sum + NORMAL * r);
    }
    PG_TRY (pg_cloud_sum (&p->cloud, NORMAL * parts->n, sum));
    for (size_t r = 0; r < parts->n; r++) {
        double *A = sum + NORMAL * r, *amount = A + MOST * MOST;
        size_t n = parts->part[r].n;
        if (n == 0) continue;
        if (pg_dense_cholesky ((int) n, A, 1e-12)) memset (amount, 0, n * sizeof *amount);
        else pg_dense_solve ((int) n, A, amount);
    }
    for (size_t i = 0; i < p->cloud.n; i++) {
        size_t r = (size_t) parts->of[i];
        for (size_t a = 0; a < parts->part[r].n; a++) {
            double u[MOST], by = sum[NORMAL * r + MOST * MOST + a];
            body_part_shift (s, &parts->part[r], p->cloud.x + i * dim, parts->part[r].motion[a], u);
            for (size_t k = 0; k < components; k++) d[i * components + k] -= by * u[k];
        }
    }
done:
    pg_free (sum);
    return status;
}

pg_status body_parts_check (pg_system *s, double t, const double *d, int loads)
{
    pg_status status = PG_OK;
    along_motions w = { 0 };
    const pg_problem *p = s->problem;
    size_t components = (size_t) s->components, at = 0;
    double low[3], high[3], reach[4] = { 0 }, far = 0, length = 0;
    pg_problem_box (p, low, high);
    for (int k = 0; k < p->dim; k++) reach[k] = high[k] - low[k];
    for (size_t i = 0; i < p->cloud.n; i++) {
        double square = 0;
        if (!pg_cloud_owns (&p->cloud, i)) continue;
        for (size_t k = 0; k < (size_t) p->dim; k++) square += d[i * components + k] * d[i * components + k];
        if (!(square <= reach[3])) reach[3] = square, at = i;
    }
    far = sqrt (reach[3]);
    if (!isfinite (far)) far = INFINITY;
    reach[3] = far;
    PG_TRY (pg_cloud_most (&p->cloud, 4, reach));
    for (int k = 0; k < p->dim; k++) length = fmax (length, reach[k]);
    if (!(length > 0) || reach[3] <= length) goto done;
    if (loads) PG_TRY (judge (&w, s, t));
    if (reach[3] <= NOWHERE * length) goto done;
    const double *x = p->cloud.x + at * (size_t) p->dim;
    if (far < reach[3])
        PG_FAIL (PG_E_EQUILIBRIUM, "a point of another rank has moved by %.3g m, %.2g lengths of the body",
                 reach[3], reach[3] / length);
    PG_FAIL (PG_E_EQUILIBRIUM,
             "the point at (%g, %g, %g) m has moved by %.3g m, %.2g lengths of the body, which is no "
             "equilibrium: next to nothing resists the loads of its part; prescribe displacements (or "
             "springs) "
             "that hold it, take another integration or a smaller spacing, or use a solver of motion "
             "(newmark)",
             x[0], p->dim > 1 ? x[1] : 0, p->dim > 2 ? x[2] : 0, far, far / length);
done:
    clear (&w);
    return status;
}

/* ---- reasons ------------------------------------------------------------------------------------------- */
/* The support by penalty with the largest factor, which makes K ill-conditioned; NULL: none. */
static const pg_load *stiffest_penalty (const pg_system *s)
{
    const pg_problem *p = s->problem;
    const pg_load *found = NULL;
    for (size_t l = 0; l < p->boundary.nload; l++) {
        const pg_load *load = &p->boundary.load[l];
        if (!s->force->method.shape_functions || !pg_load_prescribes (load)
            || load->essential != PG_ESSENTIAL_PENALTY)
            continue;
        if (!found || load->penalty > found->penalty) found = load;
    }
    return found;
}

/* Names a part whose points lie on one line: bonds leave it free to twist and, unless points have rotational
 * unknowns, to move across the line. */
static int say_row (words *out, const along_motions *w)
{
    const pg_system *s = w->s;
    for (size_t r = 0; r < w->parts.n; r++) {
        const body_part *part = &w->parts.part[r];
        char place[BODY_PART_WORDS];
        if (!part->line || s->force->method.shape_functions) continue;
        body_part_place (s->problem, part, place, sizeof place);
        say (out, "; points of a part of the body, %s, stand in one row: bonds along one line resist no %s; "
                  "use a smaller spacing, so that it is several points wide", place,
             s->components == s->problem->dim ? "motion across it" : "twist about it");
        return 1;
    }
    return 0;
}

static void say_reason (words *out, const pg_system *s)
{
    const pg_load *penalty = stiffest_penalty (s);
    int direct = s->direct.linear->factors;
    say (out, "; supports hold every part of the body");
    if (penalty)
        say (out, "; the penalty of %s, %.3g E / spacing, makes K ill-conditioned: use essential: "
                  "nitsche%s, or "
                  "a smaller method.penalty_factor", penalty->name, penalty->penalty,
             direct ? "" : " or a direct solver (solver.linear: auto)");
    else
        say (out, "; K is ill-conditioned where points see too few others or materials differ much: use %s",
             direct ? "another integration, method.horizon or spacing" : "a direct solver (solver.linear: "
                                                                         "auto)");
}

/* Names a part that is free to move although its loads balance, or that contact alone holds. */
static void say_free (words *out, const along_motions *w)
{
    char place[BODY_PART_WORDS];
    const char *holds = w->s->contact ? "contact alone" : "nothing";
    for (size_t r = 0; r < w->parts.n; r++) {
        if (!w->parts.part[r].n) continue;
        body_part_place (w->s->problem, &w->parts.part[r], place, sizeof place);
        say (out, "; %s holds a part of the body, %s: it is free to move ", holds, place);
        say_motions (out, w, r, 0);
        return;
    }
}

pg_status body_parts_explain (pg_system *s, double t, pg_status failed)
{
    pg_status status = PG_OK;
    char text[1200];
    words why = { .used = 0 };
    along_motions w = { 0 };
    if (failed != PG_E_EQUILIBRIUM && failed != PG_E_NOT_SPD && failed != PG_E_SINGULAR) return failed;
    snprintf (text, sizeof text, "%s", pg_last_error ());
    if (s->contact) PG_TRY (look (&w, s, t));
    else PG_TRY (judge (&w, s, t));
    say_free (&why, &w);
    if (!why.used && !(w.s && say_row (&why, &w))) say_reason (&why, s);
    status = pg_error (failed, PG_HERE, "%s%s", text, why.text);
done:
    clear (&w);
    return status;
}

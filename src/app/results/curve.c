/* SPDX-License-Identifier: GPL-3.0-or-later
 * The load-displacement curve of a run: force over mean displacement of the loaded set, both with sign; its
 * picture, its peak and its stiffness. With event stepping the line is the envelope (pg_envelope), and the
 * path of events is drawn pale behind it. */
#include "results_private.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Columns of result_curve.more. */
enum { STEP, TIME, FACTOR, UNJUDGED, FIRST_GAUGE };

/* Largest value over all ranks; NAN if that fails, since the next message then reports the failure. */
static double most_of_all (const pg_problem *p, double value)
{
    return pg_cloud_most (&p->cloud, 1, &value) == PG_OK ? value : NAN;
}

/* Strength of a load along the axis k: the largest size of its pattern over its points; 1 where position and
 * time do not separate, or for the axis nearest to the first normal of a pressure; 0: none. */
static double push_along (const pg_problem *p, const pg_load *load, int k)
{
    double size = 0;
    if (load->kind == PG_TRACTION || load->kind == PG_POINT_FORCE || load->kind == PG_PLATEN_FORCE) {
        if (!load->value[k]) return 0;
        if (pg_set_points (load->set) == 0 || !pg_load_separates (load)) return 1;
        for (size_t i = 0; i < load->set->npoint; i++) {
            const double *x = p->cloud.x + (size_t) load->set->point[i] * (size_t) p->dim;
            size = fmax (size, fabs (pg_load_pattern (load, k, p->dim, x)));
        }
        return most_of_all (p, size);
    }
    if (load->kind != PG_PRESSURE || load->cracks) return 0;
    size = load->set->nfacet > 0;
    const double *normal = p->cells.normal + (size > 0 ? (size_t) load->set->facet[0] : 0) * (size_t) p->dim;
    for (int c = 0; size > 0 && c < p->dim; c++) if (fabs (normal[c]) > fabs (normal[k])) size = 0;
    return most_of_all (p, size);
}

/* Largest displacement of a support along the axis k, m: at t = 1, with stages of loading at the end of each.
 * A velocity counts with its displacement in 1e-9 s, so that any displacement is preferred to it. */
static double farthest (const pg_problem *p, const pg_load *load, int k)
{
    double size = 0;
    for (size_t i = 0; i < load->set->npoint; i++)
        for (size_t stage = 0; stage == 0 || stage < p->boundary.nstage; stage++) {
            double end = load->kind == PG_VELOCITY ? 1e-9 : (double) (stage + 1);
            const double *x = p->cloud.x + (size_t) load->set->point[i] * (size_t) p->dim;
            size = fmax (size, fabs (pg_load_value (load, k, p->dim, x, end)));
        }
    return most_of_all (p, size);
}

/* Largest displacement of a platen along the axis k, m: at t = 1, with stages of loading at the end of
 * each. */
static double farthest_platen (const pg_problem *p, const pg_load *load, int k)
{
    static const double anywhere[3] = { 0 };
    double size = 0;
    for (size_t stage = 0; stage == 0 || stage < p->boundary.nstage; stage++)
        size = fmax (size, fabs (pg_load_value (load, k, p->dim, anywhere, (double) (stage + 1))));
    return size;
}

/* Number of the stage at whose end a load first acts; 0: it acts from the start. */
static size_t begins (const pg_problem *p, const pg_load *load)
{
    size_t stage = 1;
    if (!pg_load_separates (load)) return stage;
    if (pg_load_factor (load, 0) != 0) return 0;
    while (stage < p->boundary.nstage && pg_load_factor (load, (double) stage) == 0) stage++;
    return stage;
}

/* 1: the load is a support that moves points along axes; the curve prefers these. */
static int moves (const pg_load *load)
{
    return pg_load_prescribes (load) && pg_set_points (load->set) && !pg_load_rotates (load) && !load->turns;
}

/* Chooses the load and axis of the curve: the prescribed displacement that is largest; without any, of the
 * loads with a force the one that starts last, as one presses a body that is confined already; of several the
 * first, along the axis in which it is largest. */
void pg_result_curve_choose (pg_result *r)
{
    result_curve *c = &r->curve;
    const pg_problem *p = r->problem;
    double most = 0;
    c->load = -1;
    for (size_t l = 0; l < p->boundary.nload; l++)
        for (int k = 0; k < p->dim; k++) {
            const pg_load *load = &p->boundary.load[l];
            int platen = load->kind == PG_PLATEN_MOTION;
            if (!platen && !moves (load)) continue;
            double size = platen ? farthest_platen (p, load, k) : farthest (p, load, k);
            if (size > most) most = size, c->load = (int) l, c->component = k;
        }
    size_t last = 0;
    for (size_t l = 0, none = c->load < 0; none && l < p->boundary.nload; l++) {
        double strongest = 0;
        size_t first = begins (p, &p->boundary.load[l]);
        if (c->load >= 0 && first <= last) continue;
        for (int k = 0; k < p->dim; k++) {
            double push = push_along (p, &p->boundary.load[l], k);
            if (!(push > strongest)) continue;
            strongest = push, last = first, c->load = (int) l, c->component = k;
        }
    }
}

/* ---- rows ---------------------------------------------------------------------------------------------- */
/* Appends a point with displacement x (m) and force y (N), and what the report will say about
 * it: step, time, load factor, gauges (m). */
pg_status pg_result_curve_row (pg_result *r, double x, double y, const double *gauges, const pg_step *step)
{
    result_curve *c = &r->curve;
    pg_status status = PG_OK;
    size_t width = FIRST_GAUGE + r->problem->boundary.ngauge, i = c->npoint;
    PG_GROW (c->x, c->cap_x, i + 1);
    PG_GROW (c->y, c->cap_y, i + 1);
    PG_GROW (c->more, c->cap_more, (i + 1) * width);
    double *more = c->more + i * width;
    c->x[i] = x, c->y[i] = y;
    more[STEP] = (double) step->number, more[TIME] = step->time, more[FACTOR] = step->factor;
    more[UNJUDGED] = (double) step->unjudged;
    for (size_t g = 0; g < r->problem->boundary.ngauge; g++) more[FIRST_GAUGE + g] = gauges[g];
    c->npoint++;
done:
    return status;
}

/* Writes or reads the first n points of the curve in a checkpoint. */
pg_status pg_result_curve_keep (pg_result *r, size_t n, const pg_keeper *k)
{
    result_curve *c = &r->curve;
    pg_status status = PG_OK;
    size_t width = FIRST_GAUGE + r->problem->boundary.ngauge;
    PG_GROW (c->x, c->cap_x, n);
    PG_GROW (c->y, c->cap_y, n);
    PG_GROW (c->more, c->cap_more, n * width);
    if (k->reading) c->npoint = n;
    PG_TRY (k->numbers (k->context, "curve.x", n, c->x));
    PG_TRY (k->numbers (k->context, "curve.y", n, c->y));
    PG_TRY (k->numbers (k->context, "curve.more", n * width, c->more));
done:
    return status;
}

/* ---- peak and stiffness -------------------------------------------------------------------------------- */
/* 1 if nothing loads the body at the start, so that the curve begins at the origin. A velocity has not moved
 * anything then. */
static int from_rest (const pg_problem *p)
{
    double moves = 0;
    for (size_t l = 0; l < p->boundary.nload; l++)
        for (int k = 0;
             p->boundary.load[l].kind != PG_VELOCITY && k < pg_load_components (&p->boundary.load[l], p->dim);
             k++)
            for (size_t i = 0; i < p->boundary.load[l].set->npoint; i++)
                if (pg_load_value (&p->boundary.load[l], k, p->dim,
                                   p->cloud.x + (size_t) p->boundary.load[l].set->point[i] * (size_t) p->dim,
                                   0)
                    != 0)
                    moves = 1;
    return !(most_of_all (p, moves) > 0);
}

/* 1: the run uses event stepping. */
static int by_events (const pg_result *r) { return pg_solver_settled (r->solver)->event; }

/* Initial stiffness, N/m: slope through the origin, by least squares, over the rows before the peak with at
 * most 40 % of its force, the straight part of usual curves. If there are none, and with event stepping, that
 * of the first row: there the body is unbroken, whereas all later rows have lost bonds at every load. */
static double initial_stiffness (const pg_result *r, size_t peak)
{
    const result_curve *c = &r->curve;
    double xy = 0, xx = 0;
    for (size_t i = 0; i <= peak && !by_events (r); i++)
        if (fabs (c->y[i]) <= 0.4 * fabs (c->y[peak]))
            xy += c->x[i] * c->y[i], xx += c->x[i] * c->x[i];
    /* Least squares through the origin: k = sum x y / sum x^2. */
    if (xx > 0 && xy != 0) return xy / xx;
    return c->x[0] != 0 ? c->y[0] / c->x[0] : NAN;
}

/* Finds least and largest value of component k of a load over its set, and the largest size of its other
 * components. A load on facets is evaluated at their centres. */
static void range_of (const pg_problem *p, const pg_load *load, int k, double *least, double *most,
                      double *others)
{
    size_t dim = (size_t) p->dim, n = load->set->npoint ? load->set->npoint : load->set->nfacet;
    for (size_t i = 0; i < n; i++) {
        const double *x = load->set->npoint ? p->cloud.x + (size_t) load->set->point[i] * dim
                                            : p->cells.facet_centre + (size_t) load->set->facet[i] * dim;
        for (int c = 0; c < p->dim; c++) {
            double value = load->value[c] ? pg_load_value (load, c, p->dim, x, 1e-9) : 0,
                   later = load->value[c] ? pg_load_value (load, c, p->dim, x, 1) : 0;
            if (fabs (later) > fabs (value)) value = later;
            if (c != k) *others = fmax (*others, fabs (value));
            else *least = fmin (*least, value), *most = fmax (*most, value);
        }
    }
}

/* 1: force times displacement of the curve is the work of the load: it acts along one axis, equally at all
 * points. The mean displacement does not give the work of tractions that change over the set or balance each
 * other, and then the ratio of both is no stiffness. */
static int is_conjugate (const pg_problem *p, const pg_load *load, int k)
{
    double least = INFINITY, most = -INFINITY, others = 0;
    if (load->platen || !load->set || load->share) return 1;
    if (load->turns || pg_load_rotates (load)) return 0;
    if (load->kind == PG_PRESSURE) {
        for (size_t f = 0; f < load->set->nfacet; f++) {
            const double *n = p->cells.normal + (size_t) load->set->facet[f] * (size_t) p->dim;
            least = fmin (least, n[k]), most = fmax (most, n[k]);
            for (int c = 0; c < p->dim; c++) if (c != k) others = fmax (others, fabs (n[c]));
        }
    } else range_of (p, load, k, &least, &most, &others);
    least = -most_of_all (p, -least), most = most_of_all (p, most);
    others = most_of_all (p, others);
    double size = fmax (fabs (least), fabs (most));
    return most - least <= 1e-6 * size && others <= 1e-6 * size;
}

static const double *more_of (const pg_result *r, size_t row)
{
    return r->curve.more + row * (FIRST_GAUGE + r->problem->boundary.ngauge);
}

/* Finds the peak: the row of largest |force| among the rows in which every crack tip was checked; among all
 * rows if there is no such row (`judged` 0). */
void pg_result_curve_read (pg_result *r)
{
    result_curve *c = &r->curve;
    size_t n = c->npoint, row = 0, judged = 0;
    c->peak = (result_peak) { 0 };
    if (c->load < 0 || n == 0) return;
    for (size_t i = 0; i < n; i++) judged += !(more_of (r, i)[UNJUDGED] > 0);
    for (size_t i = 0, any = 0; i < n; i++) {
        if (judged && more_of (r, i)[UNJUDGED] > 0) continue;
        if (!any || fabs (c->y[i]) > fabs (c->y[row])) row = i, any = 1;
    }
    const double *more = more_of (r, row);
    c->peak = (result_peak){ .found = 1, .row = row, .force = c->y[row],
        .displacement = c->x[row],
                             .step = more[STEP], .time = more[TIME], .factor = more[FACTOR], .initial = NAN,
                             .secant = NAN, .judged = judged > 0, .left_out = judged ? n - judged : 0 };
    if (!from_rest (r->problem)) return;
    if (!is_conjugate (r->problem, &r->problem->boundary.load[c->load], c->component)) return;
    c->peak.initial = initial_stiffness (r, row);
    if (c->peak.displacement != 0) c->peak.secant = c->peak.force / c->peak.displacement;
}

/* Writes the load and component that the curve follows, the peak, the gauges at the peak and
 * both stiffnesses; nothing without a curve. */
void pg_result_curve_json (pg_json *j, const pg_result *r)
{
    const result_curve *c = &r->curve;
    const result_peak *k = &c->peak;
    const pg_problem *p = r->problem;
    if (!k->found) return;
    const double *gauge = c->more + k->row * (FIRST_GAUGE + p->boundary.ngauge) + FIRST_GAUGE;
    pg_json_open (j, "curve", '{');
    pg_json_text (j, "load", p->boundary.load[c->load].name);
    pg_json_text (j, "component", (const char[2]) { "xyz"[c->component], 0 });
    pg_json_open (j, "peak", '{');
    pg_json_number (j, "force", k->force);
    pg_json_number (j, "displacement", k->displacement);
    pg_json_count (j, "step", (size_t) k->step);
    pg_json_number (j, r->dynamic ? "time" : "load_factor", r->dynamic ? k->time : k->factor);
    pg_json_open (j, "gauges", '{');
    for (size_t g = 0; g < p->boundary.ngauge; g++) pg_json_number (j, p->boundary.gauge[g].name, gauge[g]);
    pg_json_shut (j);
    pg_json_shut (j);
    if (r->tips.grows) pg_json_count (j, "rows_not_judged", k->judged ? k->left_out : c->npoint);
    pg_json_number (j, "stiffness_initial", k->initial);
    pg_json_number (j, "stiffness_at_peak", k->secant);
    pg_json_shut (j);
}

/* Writes the peak in words: force, displacement, step, time or load factor, and the gauges there. */
static void tell_peak (const pg_result *r, char *out, size_t size)
{
    const result_peak *k = &r->curve.peak;
    const pg_problem *p = r->problem;
    const double *gauge = r->curve.more + k->row * (FIRST_GAUGE + p->boundary.ngauge) + FIRST_GAUGE;
    char force[48], place[48], time[48];
    pg_picture_quantity (k->force, "N", force, sizeof force);
    pg_picture_quantity (k->displacement, "m", place, sizeof place);
    pg_picture_time (k->time, time, sizeof time);
    int n = snprintf (out, size, "peak load: %s (force of %s along %c) at displacement %s (step %.0f, ",
                      force, p->boundary.load[r->curve.load].name, "xyz"[r->curve.component], place,
                      k -> step);
    n += r->dynamic ? snprintf (out + n, size - (size_t) n, "time %s)", time)
                    : snprintf (out + n, size - (size_t) n, "load factor %.4g)", k->factor);
    for (size_t g = 0; g < p->boundary.ngauge && (size_t) n < size; g++) {
        pg_picture_quantity (gauge[g], "m", place, sizeof place);
        n += snprintf (out + n, size - (size_t) n, ", %s %s", p->boundary.gauge[g].name, place);
    }
    if ((size_t) n >= size) return;
    if (!k->judged) snprintf (out + n, size - (size_t) n, "; in no row was every crack tip judged");
    else if (k->left_out)
        snprintf (out + n, size - (size_t) n, "; %zu rows in which a crack tip was not judged left out",
                  k->left_out);
}

/* Writes the new crack in words: its length in 2D, else its area, and the dissipated energy per area. */
static void tell_crack (const pg_result *r, char *out, size_t size)
{
    const result_crack *c = &r->crack;
    char length[48], spent[48];
    pg_picture_quantity (r->problem->dim == 2 ? c->length : c->area, r->problem->dim == 2 ? "m" : "m2",
                         length, sizeof length);
    pg_picture_quantity (c->dissipated, "J/m2", spent, sizeof spent);
    if (r->tips.grows) {
        double ratio = pg_result_paths_ratio (r);
        int n = snprintf (out, size, "new crack: %s %s; dissipated energy per area of it %s",
                          r->problem->dim == 2 ? "length" : "area", length, spent);
        if (isfinite (ratio) && (size_t) n < size)
            snprintf (out + n, size - (size_t) n, ", %.4g of the fracture energy", ratio);
        return;
    }
    int damped = (pg_solver_settled (r->solver)->flags & PG_SOLVER_STAGED) != 0;
    if (damped) snprintf (spent, sizeof spent, "not known");
    snprintf (
        out, size,
        "new crack by the %s (an estimate): %s %s; dissipated energy per area of it %s%s",
        r->problem->criterion->type->needs & PG_NEEDS_ENERGY ? "volume of failed points over the horizon"
                                                             : "count of broken bonds",
        r->problem->dim == 2 ? "length" : "area", length, spent,
        damped ? " (what the run has dissipated holds the damping of the relaxation)" : "");
}

/* Writes line k of the results; lines that do not apply are skipped, so that k counts those that exist. 0: no
 * more. */
int pg_result_words (const pg_result *r, size_t k, char *out, size_t size)
{
    const result_peak *p = &r->curve.peak;
    char first[48], second[48];
    int stiff = p->found && isfinite (p->initial) && isfinite (p->secant);
    out[0] = 0;
    if (k == 0 && p->found) tell_peak (r, out, size);
    else if (k == (size_t) p->found && stiff) {
        pg_picture_quantity (p->initial, "N/m", first, sizeof first);
        pg_picture_quantity (p->secant, "N/m", second, sizeof second);
        snprintf (out, size, "secant stiffness: %s initially, %s at the peak load", first, second);
    } else if (k == (size_t) (p->found + stiff) && r->crack.found) tell_crack (r, out, size);
    return out[0] != 0;
}

/* ---- picture of the curve ------------------------------------------------------------------------------ */
/* Draws the curve, from the origin if the body starts unloaded, and marks the peak. With event
 * stepping the line is the envelope; it may be drawn along lines through the origin only if
 * all loads are proportional. */
pg_status pg_result_curve_picture (pg_result *r)
{
    pg_status status = PG_OK;
    double *x = NULL, *y = NULL;
    const pg_load *load = &r->problem->boundary.load[r->curve.load];
    char ylabel[128], xlabel[128], path[4096], force[48], place[48], note[128];
    int events = by_events (r), rest = from_rest (r->problem);
    size_t n = 0, peak = 0;
    snprintf (ylabel, sizeof ylabel, "force of %s along %c (N)", load->name, "xyz"[r->curve.component]);
    snprintf (xlabel, sizeof xlabel, "mean displacement of %s along %c (m)", load->name,
              "xyz"[r->curve.component]);
    PG_ALLOC (x, 2 * r->curve.npoint + 2);
    PG_ALLOC (y, 2 * r->curve.npoint + 2);
    if (events)
        n = pg_envelope (r->curve.npoint, r->curve.x, r->curve.y,
                         rest && pg_problem_proportional (r->problem), x,
                         y, &peak);
    else {
        n = (size_t) rest;                             /* 1: the line begins at the origin */
        for (size_t i = 0; i < r->curve.npoint; i++) x[n] = r->curve.x[i], y[n++] = r->curve.y[i];
    }
    pg_picture_quantity (r->curve.peak.force, "N", force, sizeof force);
    pg_picture_quantity (r->curve.peak.displacement, "m", place, sizeof place);
    snprintf (note, sizeof note, "peak %s at %s", force, place);
    pg_curve curve = { "at rising displacement", n, x, y, PG_CURVE_LINE },
        path_of_events = { "path of events", r->curve.npoint, r->curve.x, r->curve.y, PG_CURVE_LINE };
    pg_chart_mark mark = { 0, r->curve.peak.displacement, r->curve.peak.force, note };
    pg_chart_style style = { .title = r->problem->title,
                             .xlabel = xlabel,
                             .ylabel = ylabel,
        .npale = events && r->curve.npoint > 1,
                             .pale = &path_of_events,
        .nmark = (size_t) r->curve.peak.found,
                             .marks = &mark,
                             .zero = 1 };
    snprintf (path, sizeof path, "%s/load_displacement.png", r->folder);
    PG_TRY (pg_picture_chart (path, 1, &curve, &style));
    memcpy (r->written[r->nwritten++], path, sizeof path);
done:
    pg_free (x), pg_free (y);
    return status;
}

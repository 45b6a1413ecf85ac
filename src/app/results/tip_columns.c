/* SPDX-License-Identifier: GPL-3.0-or-later
 * output.tips: how far a crack has come along a direction, one column of history.csv each;
 * pictures of length and speed, and their summary.
 *
 * The tip is the farthest point, along the direction, of the damaged points that are connected
 * with those nearest to the start of the crack. Connection matters: damage elsewhere in the
 * body, such as at a support, must not count as a crack that has jumped there. */
#include "results_private.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- from the scene ------------------------------------------------------------------------------------ */
/* Finds the points that count and their distance along the direction (tip->along, m); points behind `from`,
 * or where the condition fails, have 0 and never become the tip. */
static pg_status find_points (result_tip *tip, const pg_problem *p, const pg_expression *where)
{
    pg_status status = PG_OK;
    size_t dim = (size_t) p->dim;
    PG_ALLOC (tip->along, p->cloud.n);
    for (size_t i = 0; i < p->cloud.n; i++) {
        const double *x = p->cloud.x + i * dim;
        pg_place at = pg_place_of (p->dim, x, 0);
        double s = 0;
        for (size_t k = 0; k < dim; k++) s += (x[k] - tip->from[k]) * tip->direction[k];
        tip->along[i] = s > 0 && (!where || pg_expression_value (where, &at) != 0) ? s : 0;
    }
done:
    return status;
}

/* Reads entry i of output.tips; the direction becomes a unit vector in the dimension of the
 * body, and the distance of every point along it is computed once. */
static pg_status read_tip (result_tip *tip, const pg_scene *scene, size_t i, const pg_problem *p)
{
    pg_status status = PG_OK;
    pg_expression *e = NULL;
    const char *where = pg_scene_text (scene, "output.tips[%zu].where", i);
    double size = 0;
    snprintf (tip->name, sizeof tip->name, "%s", pg_scene_text (scene, "output.tips[%zu].name", i));
    tip->damage = pg_scene_number (scene, "output.tips[%zu].damage", i);
    pg_scene_vector (scene, 3, tip->from, "output.tips[%zu].from", i);
    pg_scene_vector (scene, 3, tip->direction, "output.tips[%zu].along", i);
    for (int k = 0; k < p->dim; k++) size = hypot (size, tip->direction[k]);
    for (int k = 0; k < p->dim; k++) tip->direction[k] /= size;
    if (where && *where) PG_TRY (pg_expression_compile (&e, where, "bool"));
    PG_TRY (find_points (tip, p, e));
done:
    pg_expression_free (&e);
    return status;
}

/* Checks entry i of output.tips: it needs a direction that is not zero, a condition that does not change with
 * time, and points in that direction where the condition holds. */
static pg_status check_tip (const pg_scene *scene, size_t i, const pg_problem *p)
{
    pg_status status = PG_OK;
    result_tip tip = { .along = NULL };
    char path[64];
    int turns, timeless = 1;
    double any = 0;
    pg_expression *e = NULL;
    const char *where = pg_scene_text (scene, "output.tips[%zu].where", i);
    snprintf (path, sizeof path, "output.tips[%zu].where", i);
    if (where && *where) {
        PG_TRY (pg_expression_compile (&e, where, "bool"));
        timeless = !pg_expression_uses (e, 't');
        if (!timeless) pg_scene_fault (scene, path, "the places do not change with t");
    }
    snprintf (path, sizeof path, "output.tips[%zu].along", i);
    pg_scene_vector (scene, 3, tip.direction, "%s", path);
    turns = hypot (hypot (tip.direction[0], tip.direction[1]), tip.direction[2]) > 0;
    if (!turns) pg_scene_fault (scene, path, "must not be zero");
    if (turns && timeless) {
        PG_TRY (read_tip (&tip, scene, i, p));
        for (size_t k = 0; k < p->cloud.n; k++) if (tip.along[k] > 0) any = 1;
        PG_TRY (pg_ranks_most (1, &any));
        if (!(any > 0))
            pg_scene_fault (scene, path, "no point of the body lies that way%s",
                            where && *where ? " where the condition holds" : "");
    }
done:
    pg_expression_free (&e);
    pg_free (tip.along);
    return status;
}

/* Checks output.tips; without a criterion no crack can grow. */
pg_status pg_result_tips_check (const pg_scene *scene, const pg_problem *problem)
{
    pg_status status = PG_OK;
    size_t n = pg_scene_count (scene, "output.tips");
    for (size_t i = 0; i < n; i++) PG_TRY (check_tip (scene, i, problem));
    if (n > 0 && problem->criterion->type == NULL)
        pg_scene_fault (scene, "output.tips", "nothing can break: there is no failure criterion");
done:
    return status;
}

/* Reads output.tips. The lengths are measured at the first row in any case, since pre-cracks have a
 * length. */
pg_status pg_result_tips_read (pg_result *r, const pg_scene *scene)
{
    result_tips *t = &r->tips;
    pg_status status = PG_OK;
    t->ntip = pg_scene_count (scene, "output.tips");
    t->broken = -1;
    PG_ALLOC (t->tip, t->ntip);
    for (size_t i = 0; i < t->ntip; i++) PG_TRY (read_tip (&t->tip[i], scene, i, r->problem));
    for (size_t m = 0; t->ntip && m < r->problem->at.nlaw; m++)
        t->rayleigh = fmax (t->rayleigh, pg_material_waves (&r->problem->at.law[m]).rayleigh);
    PG_TRY (pg_ranks_most (1, &t->rayleigh));
done:
    return status;
}

/* Frees the tips, even if the result was prepared in part only. */
void pg_result_tips_free (pg_result *r)
{
    result_tips *t = &r->tips;
    for (size_t i = 0; t->tip && i < t->ntip; i++) pg_free (t->tip[i].along), pg_free (t->tip[i].length);
    pg_free (t->tip), pg_free (t->time);
    pg_free (t->seen), pg_free (t->known), pg_free (t->queue), pg_free (t->damaged);
}

/* ---- rows ---------------------------------------------------------------------------------------------- */
/* Distance of point i from x, m. */
static double distance (const pg_problem *p, size_t i, const double *x)
{
    double s = 0;
    for (size_t k = 0; k < (size_t) p->dim; k++) s = hypot (s, p->cloud.x[i * (size_t) p->dim + k] - x[k]);
    return s;
}

/* Gets the damage of ghosts from their owners; points beyond the ghosts are set to NAN, so that they do not
 * count as damaged. */
static pg_status share_damage (const pg_subdomain *s, double *damage)
{
    for (size_t i = 0; s && i < s->n; i++) if (!s->owned[i]) damage[i] = NAN;
    return pg_subdomain_exchange (s, 1, damage);
}

/* Lists the points that are damaged enough for any of the tips, which are few of a body: the search for each
 * tip begins with them. */
static pg_status list_damaged (pg_result *r, const double *damage)
{
    result_tips *t = &r->tips;
    pg_status status = PG_OK;
    double least = INFINITY;
    for (size_t i = 0; i < t->ntip; i++) least = fmin (least, t->tip[i].damage);
    t->ndamaged = 0;
    for (size_t i = 0; i < r->problem->cloud.n; i++) {
        if (!(damage[i] >= least)) continue;
        PG_GROW (t->damaged, t->cap_damaged, t->ndamaged + 1);
        t->damaged[t->ndamaged++] = (int) i;
    }
done:
    return status;
}

/* Breadth-first search from the points of the queue, *at being the next, to all damaged points that are
 * connected with them by steps of at most REACH spacings, which leaves no undamaged point between. */
static void spread (const result_tip *tip, const pg_problem *p, const double *damage, int *queue, size_t *n,
                    size_t *at, double *seen)
{
    const double REACH = 1.9;
    const pg_family *f = &p->bonds.rows[PG_NODES].family;
    for (; *at < *n; (*at)++) {
        size_t i = (size_t) queue[*at];
        double reach = REACH * pg_problem_spacing (p, PG_NODES, i);
        for (size_t e = f->start[i]; e < f->start[i + 1]; e++) {
            size_t j = (size_t) f->node[e];
            if (seen[j] > 0 || !(damage[j] >= tip->damage)
                || distance (p, j, p->cloud.x + i * (size_t) p->dim) > reach)
                continue;
            seen[j] = 1, queue[(*n)++] = (int) j;
        }
    }
}

/* Collects the damaged points of the crack in t->queue, marked in t->seen: those nearest to `from` (all
 * within one spacing of the nearest), and all that are connected with them. *found: their number, also on
 * failure. Ranks exchange which of their points have been reached, until none of them finds another one: the
 * neighbours of a point are among the ghosts of its owner. */
static pg_status follow (pg_result *r, const result_tip *tip, const double *damage, size_t *found)
{
    result_tips *t = &r->tips;
    pg_status status = PG_OK;
    const pg_problem *p = r->problem;
    const pg_subdomain *s = p->cloud.subdomain;
    double nearest = -INFINITY, more = 1, *seen = t->seen, *known = t->known;
    int *queue = t->queue;
    size_t n = 0, at = 0, before;
    for (size_t k = 0; k < t->ndamaged; k++) {
        size_t i = (size_t) t->damaged[k];
        if (damage[i] >= tip->damage) nearest = fmax (nearest, -distance (p, i, tip->from));
    }
    PG_TRY (pg_ranks_most (1, &nearest));
    for (size_t k = 0; k < t->ndamaged; k++) {
        size_t i = (size_t) t->damaged[k];
        if (damage[i] >= tip->damage
            && distance (p, i, tip->from) <= pg_problem_spacing (p, PG_NODES, i) - nearest)
            seen[i] = 1, queue[n++] = (int) i;
    }
    spread (tip, p, damage, queue, &n, &at, seen);
    while (s && more > 0) {
        before = n;
        memcpy (known, seen, p->cloud.n * sizeof *known);
        PG_TRY (pg_subdomain_exchange (s, 1, known));
        for (size_t i = 0; i < p->cloud.n; i++)
            if (known[i] > 0 && !(seen[i] > 0)) seen[i] = 1, queue[n++] = (int) i;
        spread (tip, p, damage, queue, &n, &at, seen);
        more = n > before;
        PG_TRY (pg_ranks_most (1, &more));
    }
done:
    *found = n;
    return status;
}

static pg_status make_workspace (pg_result *r)
{
    result_tips *t = &r->tips;
    pg_status status = PG_OK;
    size_t n = r->problem->cloud.n;
    if (!t->seen) PG_ALLOC (t->seen, n);
    if (!t->queue) PG_ALLOC (t->queue, n);
    if (!t->known && r->problem->cloud.subdomain) PG_ALLOC (t->known, n);
done:
    return status;
}

/* Measures the length of the crack, m: that of its farthest point; 0 without damaged points. */
static pg_status farthest (pg_result *r, const result_tip *tip, const double *damage, double *length)
{
    pg_status status = PG_OK;
    size_t n = 0;
    PG_TRY (make_workspace (r));
    *length = 0;
    status = follow (r, tip, damage, &n);
    for (size_t k = 0; k < n; k++) {
        *length = fmax (*length, tip->along[r->tips.queue[k]]);
        r->tips.seen[r->tips.queue[k]] = 0;
    }
    PG_TRY (status);
    PG_TRY (pg_ranks_most (1, length));
done:
    return status;
}

/* Writes the lengths of a row, m. They are measured only when the number of broken bonds has changed. */
pg_status pg_result_tips_row (pg_result *r, const pg_state *state, const pg_step *step, double *row,
                           double *work)
{
    result_tips *t = &r->tips;
    pg_status status = PG_OK;
    void *self;
    const pg_force_type *force = pg_solver_force (r->solver, &self);
    const char *unit;
    int components = 0;
    double fresh = t->ntip > 0 && force->field && state->broken != t->broken;
    size_t n = t->tips;
    if (t->ntip == 0) return PG_OK;
    PG_TRY (pg_ranks_most (1, &fresh));
    if (fresh > 0) PG_TRY (force->field (self, state, state->d, "damage", &components, &unit, work));
    if (components == 1) PG_TRY (share_damage (r->problem->cloud.subdomain, work));
    if (components == 1) PG_TRY (list_damaged (r, work));
    for (size_t i = 0; i < t->ntip; i++) {
        result_tip *tip = &t->tip[i];
        PG_GROW (tip->length, tip->capacity, n + 1);
        tip->length[n] = n > 0 ? tip->length[n - 1] : 0;
        if (components == 1) PG_TRY (farthest (r, tip, work, &tip->length[n]));
        row[i] = pg_result_once (tip->length[n]);
    }
    PG_GROW (t->time, t->capacity, n + 1);
    t->time[n] = r->dynamic ? step->time : step->factor;
    t->tips = n + 1;
    t->broken = state->broken;
done:
    return status;
}

/* Writes or reads the lengths of the first n rows in a checkpoint. */
pg_status pg_result_tips_keep (pg_result *r, size_t n, const pg_keeper *k)
{
    result_tips *t = &r->tips;
    pg_status status = PG_OK;
    if (t->ntip == 0) goto done;
    if (k->reading) t->tips = n, t->broken = -1;
    PG_GROW (t->time, t->capacity, n);
    PG_TRY (k->numbers (k->context, "tips.time", n, t->time));
    for (size_t i = 0; i < t->ntip; i++) {
        char name[64];
        snprintf (name, sizeof name, "tips.%zu", i);
        PG_GROW (t->tip[i].length, t->tip[i].capacity, n);
        PG_TRY (k->numbers (k->context, name, n, t->tip[i].length));
    }
done:
    return status;
}

/* ---- speeds -------------------------------------------------------------------------------------------- */
double pg_result_tips_rayleigh (const pg_result *r) { return r->tips.rayleigh; }

/* Speed of the tip at row i, m/s. The length grows by whole spacings, so differences of
 * neighbouring rows mean nothing: the slope of the straight line of best fit within `half` s
 * to both sides, and at least two rows, is taken. */
static double slope (const result_tip *tip, const double *time, size_t first, size_t n, size_t i, double half)
{
    size_t a = i, b = i;
    double t = 0, s = 0, tt = 0, ts = 0;
    while (a > first && (time[i] - time[a - 1] <= half || i - a < 2)) a--;
    while (b + 1 < n && (time[b + 1] - time[i] <= half || b - i < 2)) b++;
    for (size_t k = a; k <= b; k++) t += time[k], s += tip->length[k];
    t /= (double) (b - a + 1), s /= (double) (b - a + 1);
    for (size_t k = a; k <= b; k++)
        tt += (time[k] - t) * (time[k] - t), ts += (time[k] - t) * (tip->length[k] - s);
    return tt > 0 ? ts / tt : 0;
}

/* Summarizes a crack. Speeds are fitted over the time in which a Rayleigh wave travels four horizons. */
void pg_result_tips_run (const pg_result *r, size_t i, result_tip_run *out, double *speed)
{
    const result_tip *tip = &r->tips.tip[i];
    const double *time = r->tips.time, rayleigh = pg_result_tips_rayleigh (r);
    size_t n = r->tips.tips, start, stop;
    *out = (result_tip_run) { .first = 0 };
    while (out->first < n && !(tip->length[out->first] > 0)) out->first++;
    if (out->first == n) return;
    for (start = out->first + 1; start < n && !(tip->length[start] > tip->length[out->first]); ) start++;
    for (stop = n - 1; stop > start && !(tip->length[stop] > tip->length[stop - 1]); ) stop--;
    out->start = start, out->stop = stop, out->moved = start < n;
    if (!r->dynamic || !out->moved) return;
    double half = rayleigh > 0 ? 2 * r->problem->form.approx.horizon / rayleigh : 0;
    for (size_t k = out->first; k < n; k++) {
        double v = slope (tip, time, out->first, n, k, half);
        if (v > out->largest) out->largest = v, out->fastest = k;
        if (speed) speed[k] = v;
    }
    if (stop > start) out->mean = (tip->length[stop] - tip->length[start]) / (time[stop] - time[start]);
}

/* ---- pictures, report ---------------------------------------------------------------------------------- */
/* Draws one chart and adds it to the list of pictures. */
static pg_status chart (pg_result *r, const char *name, size_t ncurve, const pg_curve *curve,
                        const char *ylabel)
{
    pg_status status = PG_OK;
    char path[4096];
    pg_chart_style style = { .title = r->problem->title,
                             .xlabel = r->dynamic ? "time (s)" : "load factor",
                             .ylabel = ylabel };
    snprintf (path, sizeof path, "%s/%s.png", r->folder, name);
    PG_TRY (pg_picture_chart (path, ncurve, curve, &style));
    memcpy (r->written[r->nwritten++], path, sizeof path);
done:
    return status;
}

/* 1 if an earlier crack has exactly the same lengths: its curve would hide this one, so the
 * first of them is drawn under all their names. */
static int like_an_earlier (const pg_result *r, size_t i)
{
    const result_tips *t = &r->tips;
    for (size_t k = 0; k < i; k++)
        if (memcmp (t->tip[k].length, t->tip[i].length, t->tips * sizeof *t->tip->length) == 0) return 1;
    return 0;
}

/* Writes the names of all cracks with the lengths of crack i, as "a = b". */
static void write_names (const pg_result *r, size_t i, char *out, size_t size)
{
    const result_tips *t = &r->tips;
    int used = snprintf (out, size, "%s", t->tip[i].name);
    for (size_t k = i + 1; k < t->ntip && used < (int) size; k++)
        if (memcmp (t->tip[k].length, t->tip[i].length, t->tips * sizeof *t->tip->length) == 0)
            used += snprintf (out + used, size - (size_t) used, " = %s", t->tip[k].name);
}

/* Draws tip.png with all lengths over time or load factor, and in dynamic runs tip_speed.png with the speeds
 * of those that grew, and the Rayleigh wave speed as a line: theory allows no mode I crack to be faster. */
pg_status pg_result_tips_pictures (pg_result *r)
{
    result_tips *t = &r->tips;
    enum { ROOM = 256 };
    pg_status status = PG_OK;
    size_t n = t->tips, alone = 0, moving = 0;
    pg_curve *curve = NULL, *fast = NULL;
    char *names = NULL;
    double *speed = NULL, limit[2] = { pg_result_tips_rayleigh (r), pg_result_tips_rayleigh (r) },
           ends[2] = { 0, 0 };
    result_tip_run run;
    if (t->ntip == 0 || n < 2) return PG_OK;
    PG_ALLOC (curve, t->ntip);
    PG_ALLOC (fast, t->ntip + 1);
    PG_ALLOC (names, t->ntip * ROOM);
    PG_ALLOC (speed, t->ntip * n);
    for (size_t i = 0; i < t->ntip; i++) {
        double *v = speed + i * n;
        if (like_an_earlier (r, i)) continue;
        write_names (r, i, names + i * ROOM, ROOM);
        curve[alone++] = (pg_curve) { names + i * ROOM, n, t->time, t->tip[i].length, 0 };
        pg_result_tips_run (r, i, &run, v);
        if (run.moved && r->dynamic)
            fast[moving++] = (pg_curve){ names + i * ROOM, n - run.first, t->time + run.first,
                                         v + run.first, 0 };
    }
    PG_TRY (chart (r, "tip", alone, curve, "length of the crack (m)"));
    ends[0] = t->time[0], ends[1] = t->time[n - 1];
    if (moving == 0) goto done;
    if (limit[0] > 0) fast[moving++] = (pg_curve) { "c_{R}", 2, ends, limit, 0 };
    PG_TRY (chart (r, "tip_speed", moving, fast, "speed of the tip (m/s)"));
done:
    pg_free (curve), pg_free (fast), pg_free (names), pg_free (speed);
    return status;
}

/* A sentence such as "right: 4.95 to 15.95 mm, from 6.20 us to the end, 1520 m/s on average,
 * 1870 m/s at most (at 9.35 mm, 9.52 us): 0.55 and 0.68 of c_R". */
int pg_result_tip (const pg_result *r, size_t i, char *out, size_t size)
{
    const result_tips *t = &r->tips;
    double rayleigh = pg_result_tips_rayleigh (r);
    result_tip_run run;
    char until[32] = "the end";
    if (i >= t->ntip || t->tips == 0) return 0;
    const result_tip *tip = &t->tip[i];
    pg_result_tips_run (r, i, &run, NULL);
    int used = snprintf (out, size, "%s: ", tip->name);
    out += used, size -= (size_t) used;
    if (!run.moved)
        return snprintf (out, size, "%s", tip->length[t->tips - 1] > 0 ? "does not grow" : "no crack"), 1;
    used = snprintf (out, size, "%.4g to %.4g mm", 1e3 * tip->length[run.first],
                     1e3 * tip->length[t->tips - 1]);
    out += used, size -= (size_t) used;
    if (!r->dynamic)
        return snprintf (out, size, ", from load factor %.4g to %.4g", t->time[run.start],
                         t->time[run.stop]),
               1;
    if (run.stop + 2 < t->tips) snprintf (until, sizeof until, "%.4g us", 1e6 * t->time[run.stop]);
    used = snprintf (out, size,
                     ", from %.4g us to %s, %.4g m/s on average, %.4g m/s at most (at %.4g mm, %.4g us)",
                     1e6 * t->time[run.start], until, run.mean, run.largest,
                     1e3 * tip->length[run.fastest], 1e6 * t->time[run.fastest]);
    if (rayleigh > 0)
        snprintf (out + used, size - (size_t) used, ": %.2f and %.2f of c_R", run.mean / rayleigh,
                  run.largest / rayleigh);
    return 1;
}

/* Writes the summary of each crack; quasi-static runs have load factors instead of times, and no speeds. */
void pg_result_tips_json (pg_json *j, const pg_result *r)
{
    const result_tips *t = &r->tips;
    double rayleigh = pg_result_tips_rayleigh (r);
    const char *when[2] = { r->dynamic ? "started" : "started_at_factor",
                            r->dynamic ? "stopped" : "stopped_at_factor" };
    if (t->ntip == 0) return;
    pg_json_open (j, "tips", '[');
    for (size_t i = 0; i < t->ntip; i++) {
        const result_tip *tip = &t->tip[i];
        result_tip_run run;
        pg_result_tips_run (r, i, &run, NULL);
        pg_json_open (j, NULL, '{');
        pg_json_text (j, "name", tip->name);
        pg_json_number (j, "damage", tip->damage);
        pg_json_number (j, "first", run.first < t->tips ? tip->length[run.first] : 0);
        pg_json_number (j, "last", t->tips ? tip->length[t->tips - 1] : 0);
        pg_json_number (j, when[0], run.moved ? t->time[run.start] : NAN);
        pg_json_number (j, when[1], run.moved ? t->time[run.stop] : NAN);
        if (r->dynamic) {
            pg_json_number (j, "mean_speed", run.mean);
            pg_json_number (j, "largest_speed", run.largest);
            pg_json_number (j, "largest_at", run.moved ? t->time[run.fastest] : NAN);
            pg_json_number (j, "rayleigh_speed", rayleigh);
            pg_json_number (j, "mean_over_rayleigh", rayleigh > 0 ? run.mean / rayleigh : NAN);
            pg_json_number (j, "largest_over_rayleigh", rayleigh > 0 ? run.largest / rayleigh : NAN);
        }
        pg_json_shut (j);
    }
    pg_json_shut (j);
}

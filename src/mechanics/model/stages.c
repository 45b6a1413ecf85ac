/* SPDX-License-Identifier: GPL-3.0-or-later
 * Stages of loading (`stages`): confine, load axially, unload, reload ... Each stage changes the factors of
 * the loads that it names linearly to new targets, and leaves the others unchanged:
 *
 *     f_i (t) = f_i (k - 1) + (t - k + 1) (target_ik - f_i (k - 1)),    k - 1 <= t <= k in stage k,
 *
 * f_i (0) = 0. A run of n stages goes from t = 0 to n, and its loads follow tables (as boundary[].table) with
 * a row at every whole t. A stage may end early, at the fraction s: the row at t = k then takes the value of
 * t = k - 1 + s. As this is known in the run only, pg_problem_staged gives the solver tables of its own. */
#include "model.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- tables -------------------------------------------------------------------------------------------- */
/* Returns 1: the load follows the stages; 0: it has ramp: constant and acts fully throughout. */
static int follows (const pg_load *load) { return load->ntable > 0; }

void pg_stages_follow (pg_problem *p, const double *share)
{
    for (size_t i = 0; i < p->boundary.nload; i++) {
        double *row = p->boundary.load[i].table;
        if (!follows (&p->boundary.load[i])) continue;
        row[0] = row[1] = 0;
        for (size_t k = 0; k < p->boundary.nstage; k++) {
            double target = p->boundary.stage[k].target[i], from = row[2*k + 1], s = share ? share[k] : 1;
            row[2*k + 2] = (double) (k + 1);
            row[2*k + 3] = isnan (target) ? from : s == 1 ? target : from + (target - from) * s;
        }
    }
}

int pg_stage_loads (const pg_problem *p, size_t stage)
{
    for (size_t i = 0; i < p->boundary.nload; i++)
        if (follows (&p->boundary.load[i])
            && p->boundary.load[i].table[2 * stage + 1] != p->boundary.load[i].table[2 * stage + 3])
            return 1;
    return 0;
}

pg_status pg_problem_staged (pg_problem **out, const pg_problem *problem)
{
    pg_status status = PG_OK;
    pg_problem *p = NULL;
    PG_ALLOC (p, 1);
    *p = *problem;
    p->boundary.load = NULL;
    PG_ALLOC (p->boundary.load, p->boundary.nload);
    memcpy (p->boundary.load, problem->boundary.load, p->boundary.nload * sizeof *p->boundary.load);
    for (size_t i = 0; i < p->boundary.nload; i++) p->boundary.load[i].table = NULL;
    for (size_t i = 0; i < p->boundary.nload; i++) {
        if (!follows (&p->boundary.load[i])) continue;
        PG_ALLOC (p->boundary.load[i].table, 2 * p->boundary.load[i].ntable);
    }
    pg_stages_follow (p, NULL);
    *out = p, p = NULL;
done:
    pg_problem_staged_free (&p);
    return status;
}

void pg_problem_staged_free (pg_problem **problem)
{
    pg_problem *p = *problem;
    if (!p) return;
    for (size_t i = 0; p->boundary.load && i < p->boundary.nload; i++) pg_free (p->boundary.load[i].table);
    pg_free (p->boundary.load);
    pg_free (p);
    *problem = NULL;
}

/* ---- removal ------------------------------------------------------------------------------------------- */
int pg_problem_removes (const pg_problem *p)
{
    for (size_t k = 0; k < p->boundary.nstage; k++) if (p->boundary.stage[k].remove) return 1;
    return 0;
}

pg_status pg_stage_removes (const pg_problem *p, size_t stage, const unsigned char *alive, pg_changes *out)
{
    pg_status status = PG_OK;
    const pg_set *set = p->boundary.stage[stage].remove;
    unsigned char *gone = NULL;
    PG_ALLOC (gone, p->cloud.n);
    for (size_t i = 0; i < set->npoint; i++) gone[set->point[i]] = 1;
    out->n = 0;
    for (int s = 0; s < PG_BOND_SETS; s++) {
        const pg_family *f = &p->bonds.rows[s].family;
        for (size_t q = 0; q < p->bonds.rows[s].n; q++) {
            int nearest = s == PG_NODES ? (int) q : pg_bonds_nearest (p, s, q);
            int all = nearest >= 0 && gone[nearest];
            for (size_t b = f->start[q]; b < f->start[q + 1]; b++) {
                if (!(all || gone[f->node[b]]) || !alive[p->bonds.first[s] + b]) continue;
                PG_GROW (out->bond, out->cap, out->n + 1);
                out->bond[out->n++] = p->bonds.first[s] + b;
            }
        }
    }
done:
    pg_free (gone);
    return status;
}

/* ---- reading ------------------------------------------------------------------------------------------- */
static long load_named (const pg_problem *p, const char *name)
{
    for (size_t i = 0; i < p->boundary.nload; i++)
        if (strcmp (p->boundary.load[i].name, name) == 0) return (long) i;
    return -1;
}

/* "jacket, platen": the names that a stage may use. */
static void list_names (const pg_problem *p, char *text, size_t size)
{
    size_t used = 0;
    text[0] = 0;
    for (size_t i = 0; i < p->boundary.nload && used < size; i++)
        used += (size_t) snprintf (text + used, size - used, "%s%s", used ? ", " : "",
                                   p->boundary.load[i].name);
}

/* Reads the loads that stage k changes, and their targets. */
static pg_status read_targets (pg_problem *p, pg_stage *stage, const pg_scene *scene, size_t k)
{
    pg_status status = PG_OK;
    const char *name;
    char path[160], names[400];
    PG_ALLOC (stage->target, p->boundary.nload);
    for (size_t i = 0; i < p->boundary.nload; i++) stage->target[i] = NAN;
    list_names (p, names, sizeof names);
    for (size_t i = 0; (name = pg_scene_name (scene, i, "stages[%zu].boundary", k)); i++) {
        long load = load_named (p, name);
        snprintf (path, sizeof path, "stages[%zu].boundary.%.80s", k, name);
        if (load < 0)
            pg_scene_fault (scene, path, "no entry of boundary has this name; there are %s", names);
        else if (!follows (&p->boundary.load[load]))
            pg_scene_fault (scene, path,
                            "boundary[%ld] has ramp: constant, so that it acts in full in all stages: leave "
                            "one of the two out",
                            load);
        else stage->target[load] = pg_scene_number (scene, "%s", path);
    }
done:
    return status;
}

/* Index of the list entry (of n) named by stages[k].until.key; -1: not given, or an error was reported. */
static int refer (const pg_scene *scene, size_t k, const char *key, size_t n,
                  const char *(*name_of) (const void *from, size_t i), const void *from, const char *what)
{
    char path[64];
    snprintf (path, sizeof path, "stages[%zu].until.%s", k, key);
    if (!pg_scene_given (scene, "%s", path)) return -1;
    for (size_t i = 0; i < n; i++)
        if (strcmp (name_of (from, i), pg_scene_text (scene, "%s", path)) == 0) return (int) i;
    pg_scene_fault (scene, path, "there is no %s of this name", what);
    return -1;
}

static const char *gauge_name (const void *scene, size_t i)
{
    return pg_scene_text (scene, "output.gauges[%zu].name", i);
}
static const char *load_name (const void *problem, size_t i)
{
    return ((const pg_problem *) problem)->boundary.load[i].name;
}

/* Reports an error if only one of two keys of `until` that belong together is given. */
static void need_both (const pg_scene *scene, size_t k, const char *a, const char *b)
{
    int first = pg_scene_given (scene, "stages[%zu].until.%s", k, a),
        second = pg_scene_given (scene, "stages[%zu].until.%s", k, b);
    char path[64];
    snprintf (path, sizeof path, "stages[%zu].until.%s", k, first ? a : b);
    if (first != second) pg_scene_fault (scene, path, "goes with until.%s", first ? b : a);
}

/* Reads the conditions that end stage k before its targets are reached. */
static void read_until (const pg_problem *p, pg_stage *stage, const pg_scene *scene, size_t k)
{
    char path[64];
    static const char *const growth[] = { "crack_length", "crack_area" };
    stage->gauge = refer (scene, k, "gauge", pg_scene_count (scene, "output.gauges"), gauge_name, scene,
                          "entry of output.gauges");
    stage->load = refer (scene, k, "load", p->boundary.nload, load_name, p, "entry of boundary");
    need_both (scene, k, "gauge", "opening"), need_both (scene, k, "load", "drop");
    if (stage->gauge >= 0) stage->opening = pg_scene_number (scene, "stages[%zu].until.opening", k);
    if (stage->load >= 0) stage->drop = pg_scene_number (scene, "stages[%zu].until.drop", k);
    if (pg_scene_given (scene, "stages[%zu].until.events", k))
        stage->events = pg_scene_integer (scene, "stages[%zu].until.events", k);
    for (int space = 0; space < 2; space++) {
        snprintf (path, sizeof path, "stages[%zu].until.%s", k, growth[space]);
        if (!pg_scene_given (scene, "%s", path)) continue;
        if (!pg_problem_grows (p))
            pg_scene_fault (scene, path, "is for cracks that grow by facets: criterion: %s",
                            pg_criterion_by_need (PG_NEEDS_FACETS));
        else if ((p->dim == 3) != space)
            pg_scene_fault (scene, path, "cracks of a %dD body have %s: until.%s", p->dim,
                            space ? "a length" : "an area", growth[!space]);
        stage->growth = pg_scene_number (scene, "%s", path);
    }
}

/* Returns 1: two sets have a point in common, on any rank. All ranks must call. */
static int share_points (const pg_problem *p, const pg_set *a, const pg_set *b)
{
    double any = 0;
    for (size_t i = 0, k = 0; i < a->npoint && k < b->npoint && any == 0;)
        if (a->point[i] == b->point[k]) any = 1;
        else if (a->point[i] < b->point[k]) i++;
        else k++;
    return pg_cloud_most (&p->cloud, 1, &any) == PG_OK && any > 0;
}

/* Reports loads on points and supports that share points with a removed set; loads on facets and body forces
 * with shape functions are removed with the body. */
static void check_loads (const pg_problem *p, const pg_set *remove, const pg_scene *scene, const char *path)
{
    for (size_t i = 0; i < p->boundary.nload; i++) {
        const pg_load *load = &p->boundary.load[i];
        int on_points = load->kind != PG_TRACTION && load->kind != PG_PRESSURE && load->kind != PG_BODY_FORCE;
        if (load->cracks || (!on_points && p->method->shape_functions)) continue;
        if (share_points (p, load->set, remove))
            pg_scene_fault (scene, path,
                            "shares points with the load or support %s, which has to be elsewhere",
                            load->name);
    }
}

/* Reads the set removed in stage k and checks it: no supports or point loads on it, no early end of the
 * stage, removed once only. */
static void read_removal (const pg_problem *p, pg_stage *stage, const pg_scene *scene, size_t k)
{
    char path[64];
    snprintf (path, sizeof path, "stages[%zu].remove", k);
    if (!pg_scene_given (scene, "%s", path)) return;
    stage->remove = pg_sets_named (&p->sets, scene, path, pg_scene_text (scene, "%s", path));
    if (!stage->remove) return;
    size_t all = pg_cloud_total (&p->cloud);
    if (pg_set_points (stage->remove) == 0) pg_scene_fault (scene, path, "this set holds no point");
    else if (pg_set_points (stage->remove) == all) pg_scene_fault (scene, path, "nothing would be left");
    if (pg_scene_given (scene, "stages[%zu].until", k))
        pg_scene_fault (scene, path,
                        "what is removed goes wholly: until is for other stages, before or after this one");
    if (pg_problem_grows (p))
        pg_scene_fault (scene, path,
                        "cracks that grow by facets do not know the new surface so far: use a criterion of "
                        "bonds, or none");
    if (p->crack.given.n)
        pg_scene_fault (scene, path, "does not go with cracks of the scene so far");
    check_loads (p, stage->remove, scene, path);
    for (size_t i = 0; i < k; i++)
        if (p->boundary.stage[i].remove && share_points (p, p->boundary.stage[i].remove, stage->remove))
            pg_scene_fault (scene, path, "shares points with what stage %s removes",
                            p->boundary.stage[i].name);
}

/* Returns 1: all components of the load are zero (at three arbitrary positions). */
static int is_zero (const pg_load *load, int dim)
{
    static const double places[3][3] = { { 0.37, -0.21, 0.83 }, { -1.3, 2.7, 0.11 }, { 5.1, 0.77, -3.9 } };
    for (int k = 0; k < 3; k++)
        for (int q = 0; load->value[k] && q < 3; q++)
            if (pg_load_pattern (load, k < dim ? k : 0, dim, places[q]) != 0) return 0;
    return 1;
}

/* Reports loads that no stage names, as they would never act. */
static void find_idle (const pg_problem *p, const pg_scene *scene)
{
    char path[64];
    for (size_t i = 0; i < p->boundary.nload; i++) {
        int named = !follows (&p->boundary.load[i]) || is_zero (&p->boundary.load[i], p->dim);
        for (size_t k = 0; k < p->boundary.nstage; k++) named |= !isnan (p->boundary.stage[k].target[i]);
        snprintf (path, sizeof path, "boundary[%zu].set", i);
        if (!named)
            pg_scene_fault (scene, path,
                            "no stage names this load (%s), so that it would never act: name it under "
                            "stages[].boundary, or give it ramp: constant to act from the start",
                            p->boundary.load[i].name);
    }
}

/* Reports stages of equal names. */
static void check_names (const pg_problem *p, const pg_scene *scene)
{
    char path[64];
    for (size_t k = 1; k < p->boundary.nstage; k++)
        for (size_t i = 0; i < k; i++) {
            if (strcmp (p->boundary.stage[k].name, p->boundary.stage[i].name) != 0) continue;
            snprintf (path, sizeof path, "stages[%zu].name", k);
            pg_scene_fault (scene, path, "stages[%zu] has this name too", i);
        }
}

pg_status pg_load_follows_stages (pg_load *load, const pg_scene *scene, size_t i, size_t nstage)
{
    pg_status status = PG_OK;
    char path[64];
    snprintf (path, sizeof path, "boundary[%zu].%s", i,
              pg_scene_given (scene, "boundary[%zu].table", i) ? "table" : "ramp");
    if (pg_scene_given (scene, "%s", path))
        pg_scene_fault (scene, path,
                        "the stages say how loads grow: leave it out, or give ramp: constant for a load that "
                        "acts in full in all of them");
    load->ntable = nstage + 1;
    PG_ALLOC (load->table, 2 * load->ntable);
done:
    return status;
}

pg_status pg_stages_read (pg_problem *p, const pg_scene *scene)
{
    pg_status status = PG_OK;
    char path[64];
    p->boundary.nstage = pg_scene_count (scene, "stages");
    if (!p->boundary.nstage) return PG_OK;
    PG_ALLOC (p->boundary.stage, p->boundary.nstage);
    for (size_t k = 0; k < p->boundary.nstage; k++) {
        pg_stage *stage = &p->boundary.stage[k];
        snprintf (stage->name, sizeof stage->name, "%s", pg_scene_text (scene, "stages[%zu].name", k));
        if (pg_scene_given (scene, "stages[%zu].steps", k))
            stage->steps = pg_scene_integer (scene, "stages[%zu].steps", k);
        PG_TRY (read_targets (p, stage, scene, k));
        read_until (p, stage, scene, k);
        read_removal (p, stage, scene, k);
    }
    for (size_t i = 0; i < p->boundary.nload; i++)
        for (int c = 0; c < 3; c++) {
            if (!p->boundary.load[i].value[c] || !pg_expression_uses (p->boundary.load[i].value[c], 't'))
                continue;
            snprintf (path, sizeof path, "boundary[%zu]", i);
            pg_scene_fault (scene, path, "with stages a value may not depend on t: they say how it grows");
            break;
        }
    find_idle (p, scene);
    check_names (p, scene);
    pg_stages_follow (p, NULL);
done:
    return status;
}

void pg_stages_clear (pg_problem *p)
{
    for (size_t k = 0; p->boundary.stage && k < p->boundary.nstage; k++)
        pg_free (p->boundary.stage[k].target);
    pg_free (p->boundary.stage);
}

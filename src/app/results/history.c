/* SPDX-License-Identifier: GPL-3.0-or-later
 * history.csv has one row per step:
 *
 *   step, time, load_factor
 *   per load     reaction (N; N m for rotations) and mean displacement of its points (m; rad), per component,
 *                then the moment of its reaction (N m), about z in the plane
 *   per platen   force and moment on the body, displacement and rotation, per component
 *   per gauge    opening, m                     per entry of output.averages   its mean
 *   per entry of output.tips   length of the crack, m
 *   cracks that grow and their tips (grown_cracks.c); with output.crack_size other cracks (crack.c)
 *   energies (J), broken bonds, iterations, residual, utilisation, event, level
 *   with solver.on_instability: instability, time in motion (s), damped energy (J)
 *   with stages of loading: the number of the stage
 *
 * events.csv has one row per broken bond: when, where, how, and which kind of bond. Both
 * tables are read by other programs and by our own (`perigal plot --curve`, converge), by the
 * names of the columns. doc/output.md explains all of them. */
#include "results_private.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* The columns that every history.csv has, with their units. */
static const char *const first_columns[] = { "step [1]", "time [s]", "load_factor [1]" };
static const char *const last_columns[] = { "energy_strain [J]",   "energy_kinetic [J]",
                                            "energy_external [J]", "energy_dissipated [J]",
                                            "broken [1]",          "iterations [1]",
                                            "residual [1]",        "utilisation [1]",
                                            "event [1]",           "level [1]" };

/* Columns of event stepping with solver.on_instability: hold or dynamic, for unstable growth. */
static const char *const unstable_columns[] = { "instability [1]", "motion_time [s]", "energy_damping [J]" };
enum { UNSTABLE_COLUMNS = sizeof unstable_columns / sizeof *unstable_columns };
static int goes_unstable (const pg_result *r)
{
    return pg_solver_settled (r->solver)->on_instability != PG_UNSTABLE_FOLLOW;
}

/* Columns of events.csv: numbers, then the names of bond set and kind. */
enum { EVENT_NUMBERS = 10, EVENT_COLUMNS = EVENT_NUMBERS + 2 };

/* 1: a platen has component k (0 to 2: force and displacement, 3 to 5: moment and rotation about x, y, z) in
 * this dimension. */
static int platen_has (const pg_problem *p, int k) { return p->dim == 3 || k < 2 || k == 5; }

/* Number of components for which a load has columns of force and displacement; free strains have none. */
static int columns_of (const pg_problem *p, size_t l)
{
    const pg_load *load = &p->boundary.load[l];
    return load->platen || load->kind == PG_EIGENSTRAIN ? 0 : pg_load_components (load, p->dim);
}

/* First axis about which a load has a moment beside its force (2D: 2, only z; 3D: 0); 3: it has none. */
static int first_moment (const pg_problem *p, size_t l)
{
    int has = p->dim > 1 && columns_of (p, l) && !p->boundary.load[l].cracks
              && !pg_load_rotates (&p->boundary.load[l]);
    return !has ? 3 : p->dim == 2 ? 2 : 0;
}

/* Creates or opens the tables. The order of the columns is that of the values in pg_result_history_row. Names
 * have at most 127 bytes. */
pg_status pg_result_history_create (pg_result *r, const result_marks *from)
{
    pg_status status = PG_OK;
    const pg_problem *p = r->problem;
    char path[4096], (*name)[128] = NULL;
    const char **column = NULL;
    size_t n = 0, tips = pg_result_paths_columns (r),
           most = 14 + UNSTABLE_COLUMNS + 9 * p->boundary.nload + 12 * p->boundary.nplaten
                  + p->boundary.ngauge + r->naverage + r->tips.ntip + tips + pg_result_crack_columns (r) + 1;
    PG_ALLOC (name, most);
    PG_ALLOC (column, most);
    for (size_t k = 0; k < 3; k++) snprintf (name[n++], sizeof *name, "%s", first_columns[k]);
    for (size_t l = 0; l < p->boundary.nload; l++) {
        for (int k = 0; k < columns_of (p, l); k++) {
            char axis = pg_load_axis (&p->boundary.load[l], p->dim, k);
            int turns = pg_load_rotates (&p->boundary.load[l]);
            snprintf (name[n++], sizeof *name, turns ? "%s.moment_%c [N m]" : "%s.force_%c [N]",
                      p->boundary.load[l].name, axis);
            snprintf (name[n++], sizeof *name, turns ? "%s.rotation_%c [rad]" : "%s.displacement_%c [m]",
                      p->boundary.load[l].name, axis);
        }
        for (int k = first_moment (p, l); k < 3; k++)
            snprintf (name[n++], sizeof *name, "%s.moment_%c [N m]", p->boundary.load[l].name, "xyz"[k]);
    }
    for (size_t i = 0; i < p->boundary.nplaten; i++)
        for (int k = 0; k < 6; k++) {
            static const char *const what[4] = { "%s.force_%c [N]", "%s.displacement_%c [m]",
                                                 "%s.moment_%c [N m]", "%s.rotation_%c [rad]" };
            if (!platen_has (p, k)) continue;
            for (int m = 0; m < 2; m++)
                snprintf (name[n++], sizeof *name, what[2 * (k / 3) + m], p->boundary.platen[i].name,
                          "xyz"[k % 3]);
        }
    for (size_t g = 0; g < p->boundary.ngauge; g++)
        snprintf (name[n++], sizeof *name, "%s [m]", p->boundary.gauge[g].name);
    for (size_t a = 0; a < r->naverage; a++) pg_result_average_column (r, a, name[n++], sizeof *name);
    for (size_t t = 0; t < r->tips.ntip; t++) snprintf (name[n++], sizeof *name, "%s [m]",
                                                        r->tips.tip[t].name);
    for (size_t k = 0; k < tips; k++) pg_result_paths_column (r, k, name[n++], sizeof *name);
    if (pg_result_crack_columns (r)) pg_result_crack_column (r, name[n++], sizeof *name);
    for (size_t k = 0; k < sizeof last_columns / sizeof *last_columns; k++)
        snprintf (name[n++], sizeof *name, "%s", last_columns[k]);
    for (size_t k = 0; goes_unstable (r) && k < UNSTABLE_COLUMNS; k++)
        snprintf (name[n++], sizeof *name, "%s", unstable_columns[k]);
    if (p->boundary.nstage) snprintf (name[n++], sizeof *name, "stage [1]");
    for (size_t k = 0; k < n; k++) column[k] = name[k];
    r->table.ncolumn = n;
    PG_ALLOC (r->table.row, n);
    PG_ALLOC (r->u, p->cloud.n * 6);
    PG_ALLOC (r->here, 2 * p->boundary.ngauge);
    memset (r->here, -1, 2 * p->boundary.ngauge);
    snprintf (path, sizeof path, "%s/history.csv", r->folder);
    PG_TRY (from ? pg_table_open (&r->table.history, path, n, column, from->history)
                 : pg_table_create (&r->table.history, path, n, column));
    static const char *const event_columns[] = {
        "step [1]",      "load_factor [1]", "time [s]",        "x [m]",
        "y [m]",         "z [m]",           "utilisation [1]", "energy_of_step [J]",
        "bond_code [1]", "kind_code [1]",   "bond [name]",     "kind [name]"
    };
    snprintf (path, sizeof path, "%s/events.csv", r->folder);
    PG_TRY (from ? pg_table_open (&r->table.events, path, EVENT_COLUMNS, event_columns, from->events)
                 : pg_table_create (&r->table.events, path, EVENT_COLUMNS, event_columns));
    PG_TRY (pg_result_paths_create (r, from));
    PG_TRY (pg_result_contact_create (r, from));
done:
    pg_free (name), pg_free (column);
    return status;
}

/* 1: a load acts on facets, over which its displacement is then averaged: the points of its set may lie half
 * a spacing behind them. */
static int acts_on_facets (const pg_problem *p, const pg_load *load)
{
    int held = pg_load_prescribes (load) && load->essential == PG_ESSENTIAL_NITSCHE,
        pushed = load->kind == PG_TRACTION || load->kind == PG_PRESSURE;
    return p->method->shape_functions && !load->own && !pg_load_rotates (load) && (held || pushed)
           && pg_set_facets (load->set) > 0;
}

/* Lists the Gauss points on those facets of a set that this rank owns: positions, m, and areas, m2 (NULL: not
 * wanted); returns their number. */
static size_t points_of (const pg_problem *p, const pg_set *set, const pg_quadrature *q, double *x,
                         double *area)
{
    size_t dim = (size_t) p->dim, n = 0;
    for (size_t i = 0, k = 0; i < q->n && k < set->nfacet; i++) {
        while (k < set->nfacet && set->facet[k] < q->cell[i]) k++;
        if (k == set->nfacet || set->facet[k] != q->cell[i]) continue;
        if (!pg_problem_owns_facet (p, (size_t) q->cell[i])) continue;
        if (x) memcpy (x + dim * n, q->x + dim * i, dim * sizeof *x);
        if (area) area[n] = q->weight[i];
        n++;
    }
    return n;
}

/* Mean displacement of the facets of a load along every axis, m (dim), on all ranks. Each rank measures the
 * facets that it owns: others may lie at the end of its part of the body. With cracks two Gauss points per
 * direction are used: a crack that runs along points may end in the middle of a facet. */
static pg_status mean_on_facets (pg_result *r, const pg_state *state, const pg_load *load, double *mean)
{
    pg_status status = PG_OK;
    const pg_problem *p = r->problem;
    pg_quadrature *q = &r->tips.facet_points;
    size_t dim = (size_t) p->dim, n;
    double *x = NULL, *u = NULL, *area = NULL, sum[4] = { 0 };
    void *self;
    const pg_force_type *force = pg_solver_force (r->solver, &self);
    if (!q->n) PG_TRY (pg_facet_points (q, &p->cells, p->crack.given.n > 0 || r->tips.grows ? 2 : 1));
    n = points_of (p, load->set, q, NULL, NULL);
    PG_ALLOC (x, dim * n);
    PG_ALLOC (u, 3 * n);
    PG_ALLOC (area, n);
    points_of (p, load->set, q, x, area);
    if (n) PG_TRY (force->sample (self, state, state->d, n, x, u, NULL, NULL));
    for (size_t i = 0; i < n; i++) {
        sum[3] += area[i];
        for (size_t k = 0; k < dim; k++) sum[k] += area[i] * u[3*i + k];
    }
    PG_TRY (pg_ranks_sum (4, sum));
    for (size_t k = 0; k < dim; k++) mean[k] = sum[k] / sum[3];
done:
    pg_free (x), pg_free (u), pg_free (area);
    return status;
}

/* *out: the value that a support prescribes for component k at t, averaged over its facets, or its points, on
 * all ranks. */
static pg_status prescribed (const pg_problem *p, const pg_load *load, int k, double t, double *out)
{
    pg_status status = PG_OK;
    const pg_set *set = load->set;
    int facets = acts_on_facets (p, load);
    double sum[2] = { 0 };                             /* sums of weighted values and of weights */
    size_t dim = (size_t) p->dim, n = facets ? set->nfacet : set->npoint;
    for (size_t i = 0; i < n; i++) {
        size_t at = (size_t) (facets ? set->facet[i] : set->point[i]);
        if (!(facets ? pg_problem_owns_facet (p, at) : pg_cloud_owns (&p->cloud, at))) continue;
        const double *x = (facets ? p->cells.facet_centre : p->cloud.x) + dim * at;
        double w = facets ? p->cells.area[at] : 1;
        sum[0] += w * pg_load_value (load, k, p->dim, x, t), sum[1] += w;
    }
    PG_TRY (pg_ranks_sum (2, sum));
    *out = sum[1] > 0 ? sum[0] / sum[1] : 0;
done:
    return status;
}

/* Mean of component k over the points of a load, weighted by load->share if it acts at a position; 0 for a
 * set without points. With several ranks: the share of this one. */
static double mean_of (const pg_problem *p, const pg_load *load, const double *u, int dim, int k)
{
    const pg_set *set = load->set;
    double sum = 0, n = (double) pg_set_points (set);
    for (size_t i = 0; i < set->npoint; i++) {
        double share = load->share ? load->share[i] * n : 1;
        if (!pg_cloud_owns (&p->cloud, (size_t) set->point[i])) continue;
        sum += share * u[(size_t) set->point[i] * (size_t) dim + (size_t) k];
    }
    return n > 0 ? sum / n : 0;
}

/* 1: a support prescribes this component as a displacement, and the points have no unknowns from which it
 * could be read. */
static int holds (const pg_problem *p, const pg_load *load, int k)
{
    return p->method->shape_functions && pg_load_prescribes (load) && !pg_load_rotates (load)
           && load->value[k] && !load->own;
}

/* *out: displacement of a load along its component k. turned: rotations of points; facets: means over facets,
 * or NULL. With several ranks: the share of this one. */
static pg_status moved_by (const pg_problem *p, const pg_load *load, int k, double t, const double *moved,
                           const double *turned, const double *facets, double *out)
{
    pg_status status = PG_OK;
    if (pg_load_rotates (load)) *out = mean_of (p, load, turned, pg_problem_rotations (p), k);
    else if (holds (p, load, k)) {
        PG_TRY (prescribed (p, load, k, t, out));
        *out = pg_result_once (*out);
    } else *out = facets ? pg_result_once (facets[k]) : mean_of (p, load, moved, p->dim, k);
done:
    return status;
}

/* Writes one row per bond that broke in the step. Numbers come first, so that readers of numbers can read all
 * of a row but its last two names. In quasi-static runs with fixed steps the load factor at the break follows
 * from its time within the step. Most numbers of a row equal those of the row before, whose text is then used
 * again. */
static pg_status event_rows (pg_result *r, const pg_step *step, size_t n, const pg_broken *list,
                             double dissipated)
{
    pg_status status = PG_OK;
    static const char *const set_name[] = { "node-node", "point-node", "facet-node" }, *const kind_name[] = {
        "tension", "shear", "bending", "energy", "facet"
    };
    char text[EVENT_NUMBERS][40];
    double before[EVENT_NUMBERS];
    for (size_t i = 0; i < n; i++) {
        const pg_broken *b = &list[i];
        int kind = b->kind == 's' ? 1 : b->kind == 'b' ? 2 : b->kind == 'e' ? 3 : b->kind == 'f' ? 4 : 0;
        const char *cell[EVENT_COLUMNS];
        double factor = b->time == step->time || !(step->time > 0) ? step->factor
                                                                   : step->factor * b->time / step->time;
        double number[EVENT_NUMBERS] = { (double) step->number,
                                         factor,
                                         b->time,
                                         b->place[0],
                                         b->place[1],
                                         b->place[2],
                                         b->utilisation,
                                         i == 0 ? dissipated : 0,
                                         b->set,
                                         kind };
        cell[EVENT_NUMBERS] = set_name[b->set], cell[EVENT_NUMBERS + 1] = kind_name[kind];
        for (int k = 0; k < EVENT_NUMBERS; k++) {
            cell[k] = text[k];
            if (i > 0 && memcmp (&number[k], &before[k], sizeof *number) == 0) continue;
            text[k][0] = '\0';                         /* empty cell: not known */
            if (!isnan (number[k])) snprintf (text[k], sizeof text[k], "%.10g", number[k]);
        }
        memcpy (before, number, sizeof before);
        PG_TRY (pg_table_line_later (r->table.events, cell));
    }
    PG_TRY (pg_table_write (r->table.events));
done:
    return status;
}

/* Measures a gauge, each end by the rank that is nearest to it; *out: how far the ends have moved apart, m,
 * the share of this rank. */
static pg_status measure_gauge (pg_result *r, const pg_state *state, size_t g, double *out)
{
    pg_status status = PG_OK;
    const pg_problem *p = r->problem;
    void *self;
    const pg_force_type *force = pg_solver_force (r->solver, &self);
    double end[2][3] = { { NAN, NAN, NAN }, { NAN, NAN, NAN } };
    for (int e = 0; e < 2 && force->sample; e++) {
        const double *place = e ? p->boundary.gauge[g].to : p->boundary.gauge[g].from;
        PG_TRY (pg_cloud_has_nearest (&p->cloud, place, &r->here[2 * g + (size_t) e]));
        PG_TRY (force->sample (self, state, state->d, 1, place, end[e], NULL, NULL));
        for (int k = 0; k < 3 && !r->here[2 * g + (size_t) e]; k++) end[e][k] = 0;
    }
    *out = pg_gauge_opening (&p->boundary.gauge[g], p->dim, end[0], end[1]);
done:
    return status;
}

/* Finds the displacements of the points, *u (m), and rotations, *turn (rad), which stand in r->u from entry 3
 * n on. Without shape functions the unknowns are the values of the points, and if these are displacements
 * alone nothing is copied. */
static pg_status move_points (pg_result *r, const pg_state *state, const double **u, const double **turn)
{
    pg_status status = PG_OK;
    const pg_problem *p = r->problem;
    void *self;
    const pg_force_type *force = pg_solver_force (r->solver, &self);
    const char *unit;
    int components, rotations = pg_problem_rotations (p);
    *u = r->u, *turn = r->u + 3 * p->cloud.n;
    if (!force->field) return PG_OK;
    if (!p->method->shape_functions && !rotations) *u = state->d;
    else PG_TRY (force->field (self, state, state->d, "displacement", &components, &unit, r->u));
    if (rotations)
        PG_TRY (force->field (self, state, state->d, "rotation", &components, &unit, r->u + 3 * p->cloud.n));
done:
    return status;
}

/* Writes the row of a step and the rows of its bonds. Displacements are those of the body, u (x) = sum N_j
 * d_j, not coefficients. Gauges are empty if the force has no field between the points. Each rank fills in
 * what its own points contribute; the sum over the ranks is the row. Messages between ranks come before
 * anything is written, which may fail on one of them. */
pg_status pg_result_history_row (pg_result *r, const pg_state *state, const pg_step *step)
{
    result_curve *c = &r->curve;
    pg_status status = PG_OK;
    const pg_problem *p = r->problem;
    const pg_statistics *report = pg_solver_report_now (r->solver);
    size_t n = 0, platens;
    size_t x = 0, y = 0;                               /* columns of displacement and force of the curve */
    double shared = step->dissipated;
    pg_broken *collected = NULL;
    size_t nbroken = step->nbroken;
    const double *moved, *turned;
    void *self;
    const pg_force_type *force = pg_solver_force (r->solver, &self);
    r->table.row[n++] = pg_result_once ((double) step->number),
    r->table.row[n++] = pg_result_once (step->time), r->table.row[n++] = pg_result_once (step->factor);
    PG_TRY (move_points (r, state, &moved, &turned));
    for (size_t l = 0; l < p->boundary.nload; l++) {
        const pg_load *load = &pg_solver_loads (r->solver)[l];
        double facets[3];
        int on_facets = columns_of (p, l) && force->sample && acts_on_facets (p, load);
        if (on_facets) PG_TRY (mean_on_facets (r, state, load, facets));
        for (int k = 0; k < columns_of (p, l); k++) {
            double f = step->reaction ? step->reaction[3 * l + (size_t) k] : 0;
            double u;
            PG_TRY (moved_by (p, load, k, r->dynamic ? step->time : step->factor, moved, turned,
                              on_facets ? facets : NULL, &u));
            if ((int) l == c->load && k == c->component) x = n + 1, y = n;
            r->table.row[n++] = f, r->table.row[n++] = u;
        }
        for (int k = first_moment (p, l); k < 3; k++)
            r->table.row[n++] = step->reaction ? step->reaction[3 * (p->boundary.nload + l) + (size_t) k] : 0;
    }
    const pg_platen_values *platen = pg_solver_platens (r->solver, &platens);
    for (size_t i = 0; i < p->boundary.nplaten; i++)
        for (int k = 0; k < 6; k++) {
            int load = p->boundary.platen[i].motion >= 0 ? p->boundary.platen[i].motion
                                                         : p->boundary.platen[i].force;
            if (!platen_has (p, k)) continue;
            double f = i < platens ? platen[i].force[k] : 0, u = i < platens ? platen[i].motion[k] : 0;
            if (load >= 0 && load == c->load && k == c->component) x = n + 1, y = n;
            r->table.row[n++] = f, r->table.row[n++] = u;
        }
    const double *gauges = r->table.row + n;
    for (size_t g = 0; g < p->boundary.ngauge; g++) PG_TRY (measure_gauge (r, state, g, &r->table.row[n++]));
    PG_TRY (pg_result_averages_row (r, state, r->table.row + n, r->u));
    n += r->naverage;
    PG_TRY (pg_result_tips_row (r, state, step, r->table.row + n, r->u));
    n += r->tips.ntip;
    PG_TRY (pg_result_paths_row (r, state, r->table.row + n));
    PG_TRY (pg_result_crack_row (r, state, r->table.row + n + pg_result_paths_columns (r)));
    /* values of cracks are known on every rank as a whole */
    for (size_t end = n + pg_result_paths_columns (r) + pg_result_crack_columns (r); n < end; n++)
        r->table.row[n] = pg_result_once (r->table.row[n]);
    r->table.row[n++] = report->energy.strain, r->table.row[n++] = report->energy.kinetic,
    r->table.row[n++] = report->energy.external;
    r->table.row[n++] = report->energy.dissipated, r->table.row[n++] = (double) report->broken,
    r->table.row[n++] = pg_result_once ((double) step->iterations);
    r->table.row[n++] = pg_result_once (step->residual),
    r->table.row[n++] = pg_result_once (step->utilisation), r->table.row[n++] = pg_result_once (step->event),
    r->table.row[n++] = pg_result_once (step->level);
    if (goes_unstable (r)) {
        r->table.row[n++] = pg_result_once ((double) step->instability);
        r->table.row[n++] = pg_result_once (step->motion);
        r->table.row[n++] = report->energy.damping;
    }
    if (p->boundary.nstage) r->table.row[n++] = pg_result_once ((double) step->stage);
    PG_TRY (pg_ranks_sum (n, r->table.row));
    PG_TRY (pg_ranks_sum (1, &shared));
    if (pg_ranks_now ()) PG_TRY (pg_result_collect_broken (r, step, &nbroken, &collected));
    if (c->load >= 0) PG_TRY (pg_result_curve_row (r, r->table.row[x], r->table.row[y], gauges, step));
    PG_TRY (pg_table_row (r->table.history, r->table.row));
    PG_TRY (event_rows (r, step, nbroken, collected ? collected : step->broken, shared));
    PG_TRY (pg_result_paths_write (r, state, step));
    PG_TRY (pg_result_contact_write (r, step));
done:
    pg_free (collected);
    return status;
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * The plan of perigal check as JSON (doc/output.md explains the keys): the same numbers as in
 * plan.c, for programs. Keys have no units, since all numbers are SI; NAN becomes null. */
#include "cli.h"
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Writes sizes of the problem: points, spacing, cells, bonds of each set, unknowns, horizon, and the mesh if
 * there is one. */
static void counts (pg_json *j, const plan *p)
{
    static const char *const sets[PG_BOND_SETS] = { "node_node", "point_node", "facet_node" };
    const pg_problem *q = p->problem;
    pg_json_text (j, "title", q->title);
    pg_json_count (j, "dimension", (size_t) q->dim);
    pg_json_count (j, "points", q->cloud.n);
    if (*q->cloud.passed) pg_json_text (j, "columns_passed_over", q->cloud.passed);
    pg_json_open (j, "spacing", '[');
    for (int k = 0; k < q->dim; k++) pg_json_number (j, NULL, q->cloud.step[k]);
    pg_json_shut (j);
    pg_json_number (j, "finest_spacing", pg_cloud_finest (&q->cloud));
    size_t cut = 0;
    for (size_t c = 0; c < q->cells.n; c++) cut += q->cells.kind[c] == PG_CUT;
    pg_json_count (j, "cells", q->cells.n);
    pg_json_count (j, "cut_cells", cut);
    pg_json_count (j, "facets", q->cells.nfacet);
    pg_json_count (j, "evaluation_points",
                   q->bonds.rows[PG_POINTS].n ? q->bonds.rows[PG_POINTS].n : q->cloud.n);
    pg_json_count (j, "boundary_points", q->bonds.rows[PG_FACETS].n);
    pg_json_open (j, "bonds", '{');
    for (int s = 0; s < PG_BOND_SETS; s++)
        pg_json_count (j, sets[s], q->bonds.first[s + 1] - q->bonds.first[s]);
    pg_json_shut (j);
    pg_json_count (j, "dofs", q->cloud.n * (size_t) pg_problem_unknowns (q));
    pg_json_count (j, "eroded_points", q->crack.eroded);
    pg_json_number (j, "horizon", q->form.approx.horizon);
    pg_json_number (j, "horizon_spacings", q->form.approx.horizon / q->cloud.h);
    pg_json_number (j, "mean_family", (double) q->bonds.first[1] / (double) q->cloud.n);
    plan_mesh_json (j, q);
    pg_crack_statistics_json (j, "cracks", p->network);
}

/* Writes each material with its wave speeds and its criterion; laws other than the isotropic one are
 * described in words, as E and nu do not determine them. */
static void constants (pg_json *j, const pg_problem *p)
{
    char text[512];
    pg_json_open (j, "materials", '[');
    for (size_t k = 0; k < p->nmaterial; k++) {
        const pg_material *m = &p->material[k];
        pg_waves w = pg_material_waves (m);
        pg_json_open (j, NULL, '{');
        pg_json_text (j, "name", m->name);
        pg_json_number (j, "youngs_modulus", m->E);
        pg_json_number (j, "poissons_ratio", m->nu);
        if (!(m->type->can & PG_MATERIAL_ISOTROPIC)) {
            m->type->describe (m, text, sizeof text);
            pg_json_text (j, "constants", text);
        }
        pg_json_number (j, "density", m->density);
        pg_json_number (j, "lambda", w.lambda);
        pg_json_number (j, "mu", w.mu);
        pg_json_number (j, "pressure_wave", w.pressure);
        pg_json_number (j, "shear_wave", w.shear);
        pg_json_number (j, "rayleigh_wave", w.rayleigh);
        pg_criterion_describe (&p->criterion[k], text, sizeof text);
        pg_json_text (j, "criterion", text);
        pg_json_shut (j);
    }
    pg_json_shut (j);
}

/* Writes solver and time steps (s), and where the stable time step comes from: measured, an estimate by the
 * largest frequency, the solver itself, or unknown without a density. */
static void steps (pg_json *j, const plan *p)
{
    plan_times t = plan_times_of (p);
    pg_json_text (j, "solver", p->options->kind);
    if ((p->options->flags & PG_SOLVER_STAGED))
        pg_json_count (j, "stages", (size_t) PG_OWN (pg_stages_options, p->options)->stages);
    else if ((p->options->flags & PG_SOLVER_QUASI_STATIC))
        pg_json_text (j, "stepping", p->options->event ? "event" : "fixed");
    else {
        pg_json_number (j, "dt", p->options->dt);
        pg_json_count (j, "steps",
                       (size_t) ((p->options->flags & PG_SOLVER_EXPLICIT) ? p->options->time_steps
                                                                          : p->options->steps));
        pg_json_number (j, "courant", t.courant);
    }
    pg_json_number (j, "explicit_dt", t.omega > 0 ? t.dt : NAN);
    pg_json_text (j, "explicit_dt_from",
                  t.omega > 0 ? t.measured == 2 ? p->from
                                : t.measured    ? "measured"
                                                : "estimate"
                              : "no density");
}

/* Writes the linear solver, sizes of matrix and factor, and the forecast of memory by part, bytes. */
static void memory (pg_json *j, const plan *p)
{
    const pg_forecast *f = p->forecast;
    int factors = f->linear != NULL;
    pg_json_text (j, "linear_solver", pg_forecast_linear (f));
    if (factors) {
        pg_json_text (j, "ordering", f->is.analysed ? f->ordering : "estimate");
        pg_json_number (j, "matrix_entries", f->matrix_entries);
        pg_json_number (j, "factor_entries", f->factor_entries);
        pg_json_number (j, "factor_flops", f->factor_flops);
        /* at 2e10 operations a second, the speed of one core; a guess, as processors differ */
        pg_json_number (j, "factor_seconds", f->factor_flops / 20e9);
    }
    pg_json_open (j, "bytes", '{');
    for (int k = 0; k < PG_BYTES_COUNT; k++) {
        char name[32];
        snprintf (name, sizeof name, "%s", pg_forecast_item (k));
        for (char *c = name; *c; c++) if (*c == ' ') *c = '_';
        pg_json_number (j, name, f->bytes[k]);
    }
    pg_json_number (j, "peak", f->peak);
    pg_json_number (j, "available", p->available);
    pg_json_shut (j);
}

/* Writes the first break, if it was asked for and the scene is quasi-static: the load factor at which it
 * occurs and where; for a crack that grows, the tip and the two ends of its first facet. */
static void first (pg_json *j, const plan *p)
{
    const pg_first_break *b = p->first;
    if (!b->solved) return;
    pg_json_open (j, "first_break", '{');
    pg_json_number (j, "load_factor", b->factor);
    pg_json_number (j, "utilisation", b->utilisation);
    pg_json_open (j, "place", '[');
    for (int k = 0; k < p->problem->dim && isfinite (b->factor); k++) pg_json_number (j, NULL, b->place[k]);
    pg_json_shut (j);
    if (b->grows) {
        int dim = p->problem->dim;
        pg_json_number (j, dim == 3 ? "front" : "tip", (double) b->grown);
        pg_json_open (j, "facet", '[');
        for (int k = 0; k < 2 && dim == 2; k++) pg_json_number (j, NULL, b->from[k]);
        for (int k = 0; k < dim; k++) pg_json_number (j, NULL, b->to[k]);
        pg_json_shut (j);
    }
    pg_json_number (j, "displacement", b->displacement);
    pg_json_number (j, "residual", b->residual);
    pg_json_shut (j);
}

/* Writes the state of crack tips under the full load: position in m, K in Pa sqrt (m), J in J/m^2, T in Pa,
 * radii of the rings in m; null where there is no room for a ring. */
static void tips (pg_json *j, const plan *p)
{
    const pg_first_break *b = p->first;
    const double one = 1;
    if (!b->solved || b->ntip == 0 || b->refused) return;
    pg_json_open (j, "crack_tips", '[');
    for (size_t t = 0; t < b->ntip && t < PG_FIRST_TIPS; t++) {
        const pg_tip_field *f = &b->tip[t];
        double K[3];
        pg_tip_intensities (f, 1, &one, K);
        pg_json_open (j, NULL, '{');
        pg_json_number (j, "tip", (double) b->id[t]);
        pg_json_number (j, "x", f->x[0]);
        pg_json_number (j, "y", f->x[1]);
        pg_json_number (j, "K_I", K[0]);
        pg_json_number (j, "K_II", K[1]);
        pg_json_number (j, "J", f->J[0][0]);
        pg_json_number (j, "J_uncertainty", pg_tip_uncertainty (f, 1, &one));
        pg_json_number (j, "T", f->T[0]);
        pg_json_number (j, "near", f->near);
        pg_json_number (j, "wide", f->wide);
        pg_json_shut (j);
    }
    pg_json_shut (j);
}

/* Writes crack fronts (3D) under the full load: least, mean and largest J, and where J is largest; least and
 * largest K; null where there was no room for a tube. */
static void fronts (pg_json *j, const plan *p)
{
    const pg_first_break *b = p->first;
    if (!b->solved || b->nfront == 0 || b->refused) return;
    pg_json_open (j, "crack_fronts", '[');
    for (size_t t = 0; t < b->nfront && t < PG_FIRST_TIPS; t++) {
        const pg_first_front *f = &b->front[t];
        static const char *const name[5] = { "J", "K_I", "K_II", "K_III", "place" };
        const double *const value[5] = { f->J, f->K[0], f->K[1], f->K[2], f->x };
        const int length[5] = { 3, 2, 2, 2, 3 };
        pg_json_open (j, NULL, '{');
        pg_json_number (j, "front", (double) f->id);
        pg_json_count (j, "vertices", f->n);
        pg_json_count (j, "measured", f->measured);
        pg_json_number (j, "length", f->length);
        for (int v = 0; v < 5; v++) {
            pg_json_open (j, name[v], '[');
            for (int k = 0; k < length[v]; k++)
                pg_json_number (j, NULL, f->measured ? value[v][k] : NAN);
            pg_json_shut (j);
        }
        pg_json_shut (j);
    }
    pg_json_shut (j);
}

/* Writes warnings and notes that are known before the run, by the functions that the run itself uses, so that
 * plan and report cannot differ. */
static void doubts (pg_json *j, const plan *p)
{
    char note[400];
    const pg_statistics *report = p->warned;
    if (!p->begun) pg_json_text (j, "not_tried", plan_untried);
    pg_json_open (j, "warnings", '[');
    for (size_t k = 0; k < report->nwarning; k++) pg_json_text (j, NULL, report->warning[k]);
    pg_json_shut (j);
    pg_json_open (j, "notes", '[');
    for (size_t k = 0; pg_solver_note (p->problem, p->options, k, note, sizeof note); k++)
        pg_json_text (j, NULL, note);
    pg_json_shut (j);
}

/* Writes the whole plan to a file; a failure of the writer is reported when it is closed. */
static pg_status write_plan (const void *what, const char *path)
{
    const plan *p = what;
    pg_status status = PG_OK;
    pg_json *j = NULL;
    pg_skip skip[8];
    size_t n = plan_skips (p, skip, 8);
    PG_TRY (pg_json_create (&j, path));
    pg_json_open (j, NULL, '{');
    counts (j, p);
    constants (j, p->problem);
    steps (j, p);
    if (p->problem->quality.patch.measured)
        pg_json_number (j, "patch_error", p->problem->quality.patch.error);
    memory (j, p);
    first (j, p);
    tips (j, p);
    fronts (j, p);
    if (p->waves) spectrum_json (j, p->waves);
    pg_json_open (j, "skipped", '[');
    for (size_t k = 0; k < n; k++) {
        pg_json_open (j, NULL, '{');
        pg_json_text (j, "what", skip[k].what);
        pg_json_text (j, "why", skip[k].why);
        pg_json_shut (j);
    }
    pg_json_shut (j);
    doubts (j, p);
    pg_json_shut (j);
    status = pg_json_close (&j);
done:
    return status;
}

/* Prints JSON. The writer replaces whole files, so the text passes through a temporary one (in TMPDIR, or
 * /tmp), which is removed. */
pg_status json_to_stdout (pg_status (*write) (const void *what, const char *path), const void *what)
{
    pg_status status = PG_OK;
    const char *folder = getenv ("TMPDIR");
    char path[1024], text[4096];
    FILE *file = NULL;
    snprintf (path, sizeof path, "%.900s/perigal-plan-XXXXXX", folder && *folder ? folder : "/tmp");
    int made = mkstemp (path);
    if (made < 0) PG_FAIL (PG_E_FILE, "cannot write %s: %s", path, strerror (errno));
    close (made);
    PG_TRY (write (what, path));
    file = fopen (path, "r");
    if (!file) PG_FAIL (PG_E_FILE, "cannot read %s: %s", path, strerror (errno));
    while (fgets (text, sizeof text, file)) fputs (text, stdout);
done:
    if (file) fclose (file);
    if (made >= 0) remove (path);
    return status;
}

pg_status plan_print_json (const plan *p) { return json_to_stdout (write_plan, p); }

/* SPDX-License-Identifier: GPL-3.0-or-later
 * The result folder from its opening to its end. All rows of a step are in the files when the step is over;
 * fields are written when they are due: at levels of the load (output.at), after a number of events, when
 * another share of the bonds has broken, and at the end. */
#include "results_private.h"
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <math.h>

/* Unit and number of components of every field that a run can write. */
static const struct {
    const char *name, *unit;
    enum { ONE, VECTOR, TENSOR, TURNS } kind;
} known_fields[] = {
    { "displacement", "m", VECTOR }, { "coefficient", "m", VECTOR }, { "velocity", "m/s", VECTOR },
    { "damage", "", ONE },           { "error_estimate", "Pa", ONE }, { "stress", "Pa", TENSOR },
    { "strain", "", TENSOR },        { "rotation", "rad", TURNS },   { "nodal_force", "N", VECTOR },
};

/* Allocates the values of a field, one of known_fields (the keys of the scene allow no other). */
static pg_status prepare_field (pg_field_view *f, double **value, const pg_problem *p)
{
    pg_status status = PG_OK;
    const int components[] = { 1, p->dim, pg_voigt_size (p->dim), pg_problem_rotations (p) };
    for (size_t k = 0; k < sizeof known_fields / sizeof *known_fields; k++) {
        if (strcmp (known_fields[k].name, f->name) != 0) continue;
        f->components = components[known_fields[k].kind];
        snprintf (f->unit, sizeof f->unit, "%s", known_fields[k].unit);
    }
    PG_ALLOC (*value, (size_t) (f->components > 0 ? f->components : 6) * p->cloud.n);
    f->value = *value;
done:
    return status;
}

/* Reads the section `output`. If displacements are wanted and the shape functions do not
 * interpolate, the coefficients are written as well: only with them can a comparison evaluate
 * the field between the points exactly. */
static pg_status read_requests (pg_result *r, const pg_scene *scene)
{
    result_fields *f = &r->fields;
    pg_status status = PG_OK;
    const char *name;
    int with_u = 0;
    r->pictures.magnify = pg_scene_number (scene, "output.magnify");
    r->error.estimating = pg_scene_bool (scene, "output.estimate")
                    && pg_solver_is (pg_scene_text (scene, "solver.kind"), PG_SOLVER_STATIC);
    r->progress.interval = pg_scene_number (scene, "output.checkpoint");
    if (pg_scene_has (scene, "output.at.events")) f->every = pg_scene_integer (scene, "output.at.events");
    if (pg_scene_has (scene, "output.at.broken"))
        f->broken_share = pg_scene_number (scene, "output.at.broken");
    for (size_t k = 0; (name = pg_scene_name (scene, k, "output.fields")) && f->nfield < MOST_FIELDS; k++) {
        snprintf (f->field[f->nfield++].name, sizeof f->field->name, "%s", name);
        with_u |= strcmp (name, "displacement") == 0;
    }
    if (with_u && f->nfield < MOST_FIELDS && !r->problem->form.approx.type->interpolates)
        snprintf (f->field[f->nfield++].name, sizeof f->field->name, "coefficient");
    PG_TRY (pg_result_views_read (r, scene));
    for (size_t k = 0; k < f->nfield; k++) PG_TRY (prepare_field (&f->field[k], &f->value[k], r->problem));
done:
    return status;
}

/* Fills a result, new or resumed. length is that of a step in the time of fields: quasi-static loads run from
 * 0 to 1, others to solver.end in s. */
pg_status pg_result_prepare (pg_result *r, const char *folder, const pg_scene *scene,
                             const pg_problem *problem, pg_solver *solver)
{
    pg_status status = PG_OK;
    r->problem = problem, r->solver = solver;
    r->progress.opened = r->progress.checkpoint_at = pg_seconds ();
    snprintf (r->folder, sizeof r->folder, "%s", folder);
    snprintf (r->hash, sizeof r->hash, "%s", pg_scene_hash (scene));
    snprintf (r->scene, sizeof r->scene, "%.3000s", pg_scene_file (scene));
    PG_TRY (pg_scene_files (scene, &r->nnamed, &r->named));
    const pg_solver_options *settled = pg_solver_settled (solver);
    r->progress.length =
        ((settled->flags & PG_SOLVER_QUASI_STATIC) ? 1 : settled->end) / (double) settled->steps;
    PG_TRY (read_requests (r, scene));
    PG_TRY (pg_result_averages_read (r, scene));
    PG_TRY (pg_result_tips_read (r, scene));
    pg_result_paths_read (r, scene);
    r->counting = pg_scene_bool (scene, "output.crack_size");
    PG_TRY (pg_result_network_read (r, scene));
    PG_TRY (pg_reference_read (&r->reference, scene, problem));
    pg_result_curve_choose (r);
    r->fields.next_broken = r->fields.broken_share > 0 ? 1 : 0;
    PG_TRY (pg_result_fields_prepare (r, scene));
done:
    return status;
}

/* Makes a result with no file open yet; on failure *r has the parts that were built. */
static pg_status ready (pg_result **r, const char *folder, const pg_scene *scene, const pg_problem *problem,
                        pg_solver *solver)
{
    pg_status status = PG_OK;
    PG_TRY (pg_result_check (scene, problem));
    PG_ALLOC (*r, 1);
    PG_TRY (pg_scene_blame (scene, "output", pg_result_prepare (*r, folder, scene, problem, solver)));
done:
    return status;
}

pg_status pg_result_plan (const pg_scene *scene, const pg_problem *problem, pg_solver *solver)
{
    pg_result *r = NULL;
    pg_status status = ready (&r, "", scene, problem, solver);
    pg_result_free (&r);
    return status;
}

/* Opens a new result. The order matters: checks first, then the lock, and the report of an earlier run is
 * removed before anything is written, so that nothing of it is mistaken for the new run. */
pg_status pg_result_open (pg_result **out, const char *folder, const pg_scene *scene,
                          const pg_problem *problem, pg_solver *solver)
{
    pg_status status = PG_OK;
    pg_result *r = NULL;
    double t0 = pg_seconds ();
    PG_TRY (ready (&r, folder, scene, problem, solver));
    PG_TRY (pg_folder_make (folder));
    PG_TRY (pg_result_lock (folder, &r->lock));
    PG_TRY (pg_result_may_open (folder, scene));
    if (pg_rank () == 0) pg_result_drop_earlier (r);
    PG_TRY (pg_result_remove (r, "report.json"));
    PG_TRY (pg_result_copy_scene (folder, scene));
    PG_TRY (pg_result_history_create (r, NULL));
    PG_TRY (pg_result_fields_open (r, NULL));
    r->progress.done = pg_result_marks_now (r);
    r->progress.seconds += pg_seconds () - t0;
    *out = r;
    r = NULL;
done:
    pg_result_free (&r);
    return status;
}

/* Takes the marks from the open files, so that marks and files cannot differ. */
result_marks pg_result_marks_now (const pg_result *r)
{
    const result_tips *t = &r->tips;
    const result_fields *f = &r->fields;
    result_marks m = { .history = pg_table_rows (r->table.history),
                       .events = pg_table_rows (r->table.events),
        .moments = f->moments,
        .keep = f->output ? f->writer->keep (f->output) : 0,
        .next_broken = f->next_broken,
        .points = (long) r->curve.npoint,
        .last_written = f->last_written,
        .pieces = t->pieces ? pg_table_rows (t->pieces) : 0,
        .tips = t->rows ? pg_table_rows (t->rows) : 0,
        .npiece = t->npiece,
                       .contact = r->table.contact ? pg_table_rows (r->table.contact) : 0,
        .stamp = r->progress.stamp,
        .time = f->time };
    return m;
}

/* Computes all fields of the state, at the points that this process owns. */
static pg_status compute_fields (pg_result *r, const pg_state *state)
{
    result_fields *f = &r->fields;
    pg_status status = PG_OK;
    void *self;
    const pg_force_type *force = pg_solver_force (r->solver, &self);
    for (size_t k = 0; force->field && k < f->nfield; k++) {
        const char *unit;
        int components;
        PG_TRY (force->field (self, state, state->d, f->field[k].name, &components, &unit, f->value[k]));
        pg_result_keep_own (r, (size_t) f->field[k].components, f->value[k]);
    }
done:
    return status;
}

/* Writes all fields. Their times must ascend, so a second writing at one time takes the next double. All
 * ranks call. */
static pg_status write_fields (pg_result *r, const pg_state *state, double time)
{
    pg_status status = PG_OK;
    PG_TRY (pg_ranks_agree (compute_fields (r, state)));
    if (r->fields.moments > 0 && !(time > r->fields.time)) time = nextafter (r->fields.time, INFINITY);
    PG_TRY (pg_result_fields_write (r, time));
    if (r->pictures.stages && !pg_ranks_now ()) pg_result_draw_stage (r, state);
done:
    return status;
}

/* *has 1: another share of the bonds has broken; sets the next share. output.at.broken = 0.1 gives stages at
 * 10 %, 20 % and so on of all bonds; two shares that break at once give one stage. */
static pg_status share_has_broken (pg_result *r, const pg_state *state, int *has)
{
    pg_status status = PG_OK;
    const pg_subdomain *s = r->problem->cloud.subdomain;
    const pg_family *f = &r->problem->bonds.rows[PG_NODES].family;
    double sum[2] = { (double) state->broken, s ? 0 : (double) state->nbond };
    *has = 0;
    if (!(r->fields.broken_share > 0)) return PG_OK;
    for (size_t i = 0; s && i < s->n; i++)
        if (s->owned[i]) sum[1] += (double) (f->start[i + 1] - f->start[i]);
    PG_TRY (pg_ranks_sum (2, sum));
    if (sum[0] < r->fields.broken_share * (double) r->fields.next_broken * sum[1]) return PG_OK;
    r->fields.next_broken = (long) (sum[0] / (r->fields.broken_share * sum[1])) + 1;
    *has = 1;
done:
    return status;
}

/* Time given to a stage in the middle of a step: n break rounds move it from the last step towards the end of
 * this one, by n / (n + 100) of its length, without reaching it. */
static double time_within (const pg_result *r)
{
    const result_progress *p = &r->progress;
    return p->stamp + p->length * (double) p->rounds / ((double) p->rounds + 100);
}

/* Writes a stage in the middle of a step if it is due. The marks are taken before and after writing, so that
 * a checkpoint knows how long the files are. If writing fails, the stage is due again after the next
 * round. */
pg_status pg_result_stage (pg_result *r, const pg_state *state, const pg_step *so_far)
{
    result_progress *p = &r->progress;
    result_fields *f = &r->fields;
    pg_status status = PG_OK;
    double t0 = pg_seconds ();
    long next = f->next_broken;
    p->rounds = so_far->iterations;
    p->now = pg_result_marks_now (r);
    PG_TRY (share_has_broken (r, state, &f->last_written));
    if (f->last_written) status = write_fields (r, state, time_within (r));
    if (status == PG_OK) p->now = pg_result_marks_now (r);
    else f->last_written = 0, f->next_broken = next;
done:
    p->seconds += pg_seconds () - t0;
    return status;
}

/* Notes that a step was refused. Its stages stay in the files, so that the last fields may not be those of
 * the last step. */
void pg_result_refused (pg_result *r)
{
    r->progress.rounds = 0;
    /* a stage of the refused step may be the last one written */
    r->fields.last_written = r->progress.done.last_written || r->fields.time > r->progress.stamp;
}

/* Writes the rows of a step, and fields if due. `pending` keeps the step until all of it is written, on all
 * ranks, so that a checkpoint after a full disk can write it later. */
pg_status pg_result_step (pg_result *r, const pg_state *state, const pg_step *step)
{
    result_progress *p = &r->progress;
    result_fields *f = &r->fields;
    pg_status status = PG_OK;
    double t0 = pg_seconds ();
    p->done = pg_result_marks_now (r);
    p->pending = *step, p->is_pending = 1;
    p->rounds = 0;
    f->last_written = 0;
    p->stamp = step->stamp;
    PG_TRY (pg_ranks_agree (pg_result_history_row (r, state, step)));
    int due = f->every > 0 && step->event && state->events % f->every == 0;
    int share;
    PG_TRY (share_has_broken (r, state, &share));
    due |= share || step->level;
    if (due) PG_TRY (write_fields (r, state, step->stamp));
    f->last_written = due;
    p->done = pg_result_marks_now (r);
    p->is_pending = 0;
done:
    p->seconds += pg_seconds () - t0;
    return status;
}

/* Makes the error estimate, if the force has one and output.estimate asks for it. A lack of memory for it
 * gives a warning, and the run does not fail. */
static pg_status estimate (pg_result *r, const pg_state *state)
{
    void *self;
    const pg_force_type *force = pg_solver_force (r->solver, &self);
    if (!r->error.estimating || !force->estimate) return PG_OK;
    pg_status status = force->estimate (self, state->d, &r->error.estimate, NULL);
    r->error.estimated = status == PG_OK;
    if (status != PG_E_MEMORY) return status;
    pg_solver_warn (r->solver, "the error of the stress could not be estimated: %.160s", pg_last_error ());
    return PG_OK;
}

/* Waits until all files of the run are on the disk, before the checkpoint is removed, from which they could
 * be made again. A short run without a checkpoint does not wait. */
static pg_status sync_all (const pg_result *r)
{
    pg_status status = PG_OK;
    char path[4096];
    if (!pg_result_kept (r)) return PG_OK;
    PG_TRY (pg_result_sync_rows (r));
    PG_TRY (pg_result_fields_sync (r));
    if (pg_rank () == 0) PG_TRY (pg_file_sync (pg_result_path (r, "report.json", path, sizeof path)));
    PG_TRY (pg_file_sync (r->folder));
done:
    return status;
}

/* Ends a run. It is finished when the checkpoint of rank 0 is gone; parts of fields, needed only to continue,
 * go with the checkpoints of the other ranks, and the additions of finished fields take their place, since no
 * moment can be appended any more. If the process is killed in between, pg_result_complete does the rest. */
static pg_status close_run (const pg_result *r)
{
    pg_status status = PG_OK;
    char path[4096];
    PG_TRY (pg_ranks_agree (sync_all (r)));
    pg_checkpoint_drop (pg_result_path (r, "checkpoint.nc", path, sizeof path));
    if (pg_rank () == 0) status = pg_result_remove (r, "checkpoint.nc");
    PG_TRY (pg_ranks_agree (status));
    if (pg_rank () > 0) status = pg_result_remove (r, "checkpoint.nc");
    if (status == PG_OK) status = pg_result_fields_finish (r, 1);
    PG_TRY (pg_ranks_agree (status));
done:
    return status;
}

pg_status pg_result_complete (const char *folder)
{
    pg_status status = PG_OK;
    int lock = 0;
    PG_TRY (pg_result_lock (folder, &lock));
    PG_TRY (pg_writer_complete (folder));
    pg_result_drop_finished_ranks (folder);
done:
    pg_result_unlock (folder, &lock);
    return status;
}

/* Finishes the result; report.json is written even if something else fails. The checkpoint is removed last,
 * and nothing that it relies on is changed before: a run killed earlier can be resumed, and one killed later
 * is complete. */
pg_status pg_result_finish (pg_result *r, const pg_state *state, const char *failure, double search,
                            double total)
{
    result_progress *p = &r->progress;
    pg_status status = PG_OK;
    double t0 = pg_seconds ();
    /* ended before anything was done: pictures would only show the body as the scene describes it */
    int nothing = failure && state->step == 0 && p->rounds == 0;
    PG_TRY (pg_solver_share_report (r->solver));
    if (!r->fields.last_written) PG_TRY (write_fields (r, state, p->rounds > 0 ? time_within (r) : p->stamp));
    r->fields.last_written = 1;
    pg_result_curve_read (r);
    PG_TRY (pg_result_crack_measure (r, state));
    if (!nothing && !pg_ranks_now ()) pg_result_draw (r, state);
    PG_TRY (pg_result_measure (r, state));
    if (!failure) PG_TRY (estimate (r, state));
    if (!failure) PG_TRY (pg_result_fields_complete (r, state));
done:
    p->seconds += pg_seconds () - t0;
    /* The total time includes the finishing: fields, pictures, errors against the reference, the estimate. */
    pg_status written = pg_result_json (r, state, failure, search, p->earlier + total + pg_seconds () - t0);
    status = pg_ranks_agree (status == PG_OK ? written : status);
    if (status == PG_OK && !failure) return close_run (r);
    pg_result_fields_finish (r, 0);
    return status;
}

/* Frees a result; the lock is released after the files are closed. */
void pg_result_free (pg_result **result)
{
    pg_result *r = *result;
    if (!r) return;
    if (r->fields.output) r->fields.writer->close (&r->fields.output);
    pg_table_close (&r->table.history);
    pg_table_close (&r->table.events);
    pg_result_paths_close (r);
    pg_result_contact_close (r);
    pg_result_unlock (r->folder, &r->lock);
    pg_scene_files_free (r->nnamed, &r->named);
    for (size_t k = 0; k < MOST_FIELDS; k++) pg_free (r->fields.value[k]);
    pg_cloud_clear (&r->fields.own), pg_free (r->here), pg_free (r->fields.in_block);
    pg_reference_free (&r->reference);
    pg_errors_clear (&r->errors);
    pg_result_tips_free (r);
    pg_free (r->table.row), pg_free (r->u), pg_free (r->average), pg_free (r->curve.x), pg_free (r->curve.y),
        pg_free (r->curve.more);
    pg_free (r);
    *result = NULL;
}

/* Values for the summary that `perigal run` prints. Errors and estimate: NULL if they were not measured. */
const pg_errors *pg_result_errors (const pg_result *r) { return r->measured ? &r->errors : NULL; }
const char *pg_result_fields (const pg_result *r) { return r->fields.writer->file; }
const char *pg_result_folder (const pg_result *r) { return r->folder; }
size_t pg_result_pictures (const pg_result *r) { return r->nwritten; }
/* Path of picture i; NULL past the last one. */
const char *pg_result_picture (const pg_result *r, size_t i)
{
    return i < r->nwritten ? r->written[i] : NULL;
}

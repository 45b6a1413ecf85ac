/* SPDX-License-Identifier: GPL-3.0-or-later
 * checkpoint.nc of a result folder: the marks of its files, counters of the result, a step that could not be
 * written, and everything that the solver keeps. Reading cuts the files to their marks, so that rows that a
 * killed run has added since do not count. A resumed run then gives the same bits as one that was never
 * interrupted. Everything passes through resumed_all, for writing and for reading. Values that are read are
 * checked against the problem before they are used as sizes. */
#include "resume.h"
#include <errno.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { WORD = 64 };                                    /* bytes of a hash and of the version */
static const long largest = 1L << 50;                  /* largest value of any count */

/* Hash of positions, volumes and blocks: it also notices changes in files that the scene names only
 * indirectly. */
static long fingerprint (const pg_cloud *cloud)
{
    uint64_t hash = pg_fingerprint (PG_FINGERPRINT, cloud->x,
                              cloud->n * (size_t) cloud->dim * sizeof *cloud->x);
    hash = pg_fingerprint (hash, cloud->volume, cloud->n * sizeof *cloud->volume);
    return (long) (pg_fingerprint (hash, cloud->block, cloud->n * sizeof *cloud->block) >> 1);
}

/* Writes or checks the hashes of the scene's files; PG_E_USAGE if a file has changed since the checkpoint. */
static pg_status keep_files (resumed *m, const pg_keeper *k)
{
    pg_status status = PG_OK;
    const pg_result *r = m->r;
    char (*hash)[WORD] = NULL;
    PG_ALLOC (hash, r->nnamed + 1);
    for (size_t i = 0; i < r->nnamed; i++) memcpy (hash[i], r->named[i].hash, WORD);
    PG_TRY (k->bytes (k->context, "files.sha256", r->nnamed * WORD, hash));
    for (size_t i = 0; i < r->nnamed; i++)
        if (memcmp (hash[i], r->named[i].hash, WORD) != 0)
            PG_FAIL (PG_E_USAGE,
                     "%s (%s of the scene) has changed since %s was written: bring back what it was, or "
                     "start anew with --force",
                     r->named[i].path, r->named[i].key, m->path);
done:
    pg_free (hash);
    return status;
}

/* Writes or checks which process wrote the checkpoint: number of ranks, rank, 1: they share the body. Other
 * processes read it by moved_run.c. */
static pg_status keep_ranks (const resumed *m, const pg_keeper *k)
{
    pg_status status = PG_OK;
    const long now[3] = { pg_rank_count (), pg_rank (), pg_ranks_now () != NULL };
    long was[3];
    memcpy (was, now, sizeof was);
    PG_TRY (k->counts (k->context, "ranks", 3, was));
    if (!m->anywhere && memcmp (was, now, sizeof was) != 0)
        PG_FAIL (PG_E_USAGE, "%s is that of rank %ld of %ld: start anew with --force", m->path, was[1],
                 was[0]);
done:
    return status;
}

/* Writes or checks version, scene and files: they must be those of this run. */
pg_status resumed_identity (resumed *m, const pg_keeper *k)
{
    pg_status status = PG_OK;
    char version[WORD] = PG_VERSION, hash[WORD + 1] = "";
    memcpy (hash, m->r->hash, WORD);
    PG_TRY (k->bytes (k->context, "version", WORD, version));
    version[WORD - 1] = 0;
    if (strcmp (version, PG_VERSION) != 0)
        PG_FAIL (PG_E_USAGE, "%s was written by perigal %s, this is %s: run without --resume", m->path,
                 version, PG_VERSION);
    PG_TRY (k->bytes (k->context, "scene_sha256", WORD, hash));
    if (strncmp (hash, m->r->hash, WORD) != 0)
        PG_FAIL (PG_E_USAGE,
                 "%s is of another scene (sha256 %.12s..., now %.12s...): the scene or its --set options "
                 "have changed since; "
                 "%s/scene.yaml has those it was made with",
                 m->path, hash, m->r->hash, m->r->folder);
    PG_TRY (keep_files (m, k));
    PG_TRY (k->counts (k->context, "threads", 1, &m->threads));
done:
    return status;
}

/* Writes or checks points, bonds and ranks as well; the number of threads may differ. */
static pg_status keep_identity (resumed *m, const pg_keeper *k)
{
    pg_status status = PG_OK;
    const pg_problem *p = m->r->problem;
    /* Whatever changes one of these numbers makes the checkpoint useless for this problem. */
    long size[] = { (long) p->cloud.n,       (long) p->bonds.first[PG_BOND_SETS],
                    (long) m->state->ndof,   (long) p->boundary.nload,
                    fingerprint (&p->cloud), (long) m->r->tips.ntip };
    enum { SIZES = sizeof size / sizeof *size };
    long found[SIZES];
    memcpy (found, size, sizeof size);
    PG_TRY (resumed_identity (m, k));
    PG_TRY (keep_ranks (m, k));
    PG_TRY (k->counts (k->context, "sizes", SIZES, found));
    if (memcmp (found, size, sizeof size) != 0)
        PG_FAIL (PG_E_USAGE,
                 "%s is of other points or bonds (%ld points, %ld bonds, %ld unknowns; now %ld, %ld, %ld): "
                 "run without --resume",
                 m->path, found[0], found[1], found[2], size[0], size[1], size[2]);
done:
    return status;
}

/* Fails if marks that were read are impossible: more rows than history.csv has bytes, or more points of the
 * curve than rows. */
static pg_status check_marks (const resumed *m, const result_marks *at)
{
    pg_status status = PG_OK;
    struct stat s;
    char path[4096];
    snprintf (path, sizeof path, "%s/history.csv", m->r->folder);
    if (stat (path, &s) != 0) PG_FAIL (PG_E_FILE, "%s: %s", path, strerror (errno));
    if (at->history > s.st_size)
        PG_FAIL (PG_E_FILE, "%s has %ld bytes, not %ld rows: it was changed since", path, (long) s.st_size,
                 at->history);
    if (at->points > at->history)
        PG_FAIL (PG_E_FILE, "%s is not of this run: %ld points of the curve of %ld rows", m->path, at->points,
                 at->history);
done:
    return status;
}

/* Writes or reads one set of marks under a name. */
static pg_status keep_marks (const resumed *of, result_marks *m, const char *name, const pg_keeper *k)
{
    pg_status status = PG_OK;
#define MARK(field) PG_KEPT_IN (m->field, 0, largest, name)
    PG_TRY (pg_keep_fields (k, name, "counts", "numbers", 1, PG_ROWS (
        MARK (history), MARK (events), MARK (moments), MARK (keep), MARK (next_broken), MARK (points),
        MARK (last_written), MARK (pieces), MARK (tips), MARK (npiece), MARK (contact), PG_KEPT (m->stamp),
        PG_KEPT (m->time))));
#undef MARK
    if (k->reading) PG_TRY (check_marks (of, m));
done:
    return status;
}

/* Writes or reads a step that was made and could not be written, for example because the disk was full: its
 * numbers, broken bonds and reactions, so that its rows are written after resuming. */
static pg_status keep_pending (resumed *m, const pg_keeper *k)
{
    pg_status status = PG_OK;
    pg_step *s = &m->pending;
    size_t nreaction = s->reaction || k->reading ? PG_REACTIONS * m->r->problem->boundary.nload : 0;
    if (!m->is_pending) goto done;
    PG_TRY (pg_keep_fields (k, "pending", "counts", "numbers", 1, PG_ROWS (
        PG_KEPT (s->number), PG_KEPT (s->iterations), PG_KEPT (s->level), PG_KEPT (s->event),
        PG_KEPT_IN (s->nbroken, 0, m->r->problem->bonds.first[PG_BOND_SETS], "the bonds broken in a step"),
        PG_KEPT (s->instability), PG_KEPT (s->stage), PG_KEPT (s->unjudged), PG_KEPT (s->stamp),
        PG_KEPT (s->time), PG_KEPT (s->factor), PG_KEPT (s->residual), PG_KEPT (s->utilisation),
        PG_KEPT (s->dissipated), PG_KEPT (s->motion))));
    /* This function runs twice when a checkpoint is written. */
    if (!m->broken) PG_ALLOC (m->broken, s->nbroken);
    if (!m->reaction) PG_ALLOC (m->reaction, nreaction);
    if (k->reading) s->broken = m->broken, s->reaction = m->reaction;
    else {
        if (s->nbroken) memcpy (m->broken, s->broken, s->nbroken * sizeof *s->broken);
        if (nreaction) memcpy (m->reaction, s->reaction, nreaction * sizeof *s->reaction);
    }
    PG_TRY (pg_broken_keep (m->r->problem, "pending.broken", s->nbroken, m->broken, k));
    PG_TRY (k->numbers (k->context, "pending.reaction", nreaction, m->reaction));
done:
    return status;
}

pg_status resumed_files (resumed *m, const pg_keeper *k)
{
    pg_status status = PG_OK;
    pg_result *r = m->r;
    double seconds = r->progress.seconds;
    long generation = r->progress.generation;
    PG_TRY (pg_keep_fields (k, "result", "counts", "seconds", 1, PG_ROWS (
        PG_KEPT_IN (m->rounds, 0, largest, "rounds of a step"), PG_KEPT (m->is_pending), PG_KEPT (generation),
        PG_KEPT (m->seconds), PG_KEPT (seconds))));
    if (k->reading) r->progress.seconds = seconds, r->progress.generation = generation;
    PG_TRY (keep_marks (m, &m->now, "now", k));
    PG_TRY (keep_marks (m, &r->progress.done, "done", k));
    PG_TRY (pg_result_curve_keep (r, (size_t) m->now.points, k));
    PG_TRY (pg_result_tips_keep (r, (size_t) m->now.history, k));
done:
    return status;
}

/* Writes or reads a whole checkpoint, in a fixed order: identity, counters, marks, curve, cracks, a pending
 * step, the state and the solver, and at last what other processes would need. Sizes come before the arrays
 * that they count. */
pg_status resumed_all (void *context, const pg_keeper *k)
{
    pg_status status = PG_OK;
    resumed *m = context;
    const pg_result *r = m->r;
    PG_TRY (keep_identity (m, k));
    PG_TRY (resumed_files (m, k));
    PG_TRY (keep_pending (m, k));
    PG_TRY (pg_solver_keep (r->solver, m->state, k));
    PG_TRY (parts_keep (r->problem, pg_solver_accepted (r->solver, m->state), k));
done:
    return status;
}

/* ---- writing ------------------------------------------------------------------------------------------- */
/* Prepares the writing of a checkpoint. In the middle of a step the files are later cut to the marks of the
 * last round, otherwise to those of the last step. */
static resumed memory_of (pg_result *r, pg_state *state, const char *path)
{
    result_progress *p = &r->progress;
    return (resumed){ .r = r,
                     .state = state,
                     .path = path,
        .now = p->rounds > 0 ? p->now : p->done,
        .rounds = p->rounds,
        .is_pending = p->is_pending,
                     .threads = r->problem->threads,
        .seconds = p->earlier + pg_seconds () - p->opened,
        .pending = p->pending };
}

/* Passes the content of a checkpoint to a keeper that does not read, for comparisons of states. */
pg_status pg_result_keep (pg_result *r, pg_state *state, const pg_keeper *keeper)
{
    resumed m = memory_of (r, state, "the checkpoint");
    if (keeper->reading) return pg_error (PG_E_USAGE, PG_HERE, "pg_result_resume reads");
    pg_status status = resumed_all (&m, keeper);
    pg_free (m.broken), pg_free (m.reaction);
    return status;
}

pg_status pg_result_sync_rows (const pg_result *r)
{
    pg_status status = PG_OK;
    const pg_table *const all[] = { r->table.history, r->table.events, r->tips.pieces, r->tips.rows,
                                    r->table.contact };
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) if (all[k]) PG_TRY (pg_table_sync (all[k]));
done:
    return status;
}

/* Writes a checkpoint. The files are synced first: marks on the disk must not be ahead of the rows that they
 * count. */
pg_status pg_result_checkpoint (pg_result *r, pg_state *state)
{
    result_progress *p = &r->progress;
    pg_status status = PG_OK;
    char path[4096];
    double t0 = pg_seconds ();
    snprintf (path, sizeof path, "%s/checkpoint.nc", r->folder);
    resumed m = memory_of (r, state, path);
    /* Rows first, then the marks that count them. */
    PG_TRY (pg_result_sync_rows (r));
    PG_TRY (pg_result_fields_sync (r));
    p->generation++;
    PG_TRY (pg_checkpoint_prepare (path, resumed_all, &m));
done:
    /* The previous checkpoint stays until all ranks have written a new one. */
    status = pg_ranks_agree (status);
    if (status == PG_OK) status = pg_ranks_agree (pg_checkpoint_commit (path));
    else pg_checkpoint_drop (path);
    pg_free (m.broken), pg_free (m.reaction);
    p->checkpoint_at = pg_seconds ();
    p->checkpoint_cost = p->checkpoint_at - t0;
    p->seconds += p->checkpoint_cost;
    return status;
}

int pg_result_kept (const pg_result *r)
{
    char path[4096];
    snprintf (path, sizeof path, "%s/checkpoint.nc", r->folder);
    return access (path, F_OK) == 0;
}

/* 1: a checkpoint is due. At most a tenth of the time goes into checkpoints, however short the interval. An
 * interval of 0 means none during the run. */
int pg_result_due (const pg_result *r)
{
    const result_progress *p = &r->progress;
    double passed = pg_seconds () - p->checkpoint_at;
    return p->interval > 0 && passed >= p->interval && passed >= 10 * p->checkpoint_cost;
}

/* ---- resuming ------------------------------------------------------------------------------------------ */
void resumed_marks (pg_result *r, const result_marks *at)
{
    result_fields *f = &r->fields;
    f->moments = at->moments, f->next_broken = at->next_broken, f->last_written = (int) at->last_written,
        r->progress.stamp = at->stamp, f->time = at->time;
}

/* Opens tables and fields, and cuts them to the marks. */
static pg_status resumed_open (pg_result *r, const result_marks *at)
{
    pg_status status = PG_OK;
    PG_TRY (pg_result_history_create (r, at));
    PG_TRY (pg_result_fields_open (r, at));
    resumed_marks (r, at);
done:
    return status;
}

/* Writes what was due at the checkpoint and could not be written: the rows of a pending step, and the stage
 * in the middle of a step. */
static pg_status catch_up (resumed *m)
{
    pg_status status = PG_OK;
    pg_step so_far = { .number = m->state->step + 1, .iterations = m->rounds };
    int written = m->r->fields.last_written;
    if (m->is_pending) PG_TRY (pg_result_step (m->r, m->state, &m->pending));
    if (m->rounds > 0) {
        PG_TRY (pg_result_stage (m->r, m->state, &so_far));
        m->r->fields.last_written |= written;
    }
done:
    return status;
}

/* Reads the number of a checkpoint and which process wrote it (a pg_keep function). */
static pg_status read_who (void *context, const pg_keeper *k)
{
    pg_status status = PG_OK;
    resumed_by *who = context;
    long count[3], ranks[3];
    PG_TRY (k->counts (k->context, "result.counts", 3, count));
    PG_TRY (k->counts (k->context, "ranks", 3, ranks));
    PG_KEEP_BOUND (k, "the number of ranks", ranks[0], 1, 1L << 24);
    PG_KEEP_BOUND (k, "a rank", ranks[1], 0, ranks[0] - 1);
    PG_KEEP_BOUND (k, "whether ranks share the body", ranks[2], 0, 1);
    *who = (resumed_by) { (double) count[2], (int) ranks[0], (int) ranks[1], (int) ranks[2] };
done:
    return status;
}

resumed_by resumed_who (const char *path)
{
    resumed_by who = { .number = -1 };
    if (access (path, F_OK) == 0 && pg_checkpoint_read (path, read_who, &who) != PG_OK) who.number = -1;
    return who;
}

/* Number of a checkpoint that this rank wrote, among as many ranks as now; -1: it is none. */
static double number_of (const char *path)
{
    const resumed_by who = resumed_who (path);
    int own = who.count == pg_rank_count () && who.rank == pg_rank ()
              && who.divided == (pg_ranks_now () != NULL);
    return own ? who.number : -1;
}

static pg_status of_other_moments (const char *path)
{
    return pg_error (PG_E_FILE, PG_HERE, "%s: the ranks have no checkpoint of one moment: start anew with "
                     "--force", path);
}

/* Chooses the checkpoint to read. A run that was killed while it wrote checkpoints may have left those of one
 * moment under two names: some ranks have renamed theirs already (then all have written them), or some have
 * no new one yet (then none is renamed). The newest that all ranks have is renamed to the name that is read.
 * *anew 1: there is none, as the run was killed before it wrote its first one. All ranks call. */
static pg_status choose_checkpoint (const char *path, const char *folder, const pg_scene *scene, int *anew)
{
    pg_status status = PG_OK;
    char fresh[4100];
    double present, next, common;
    if (pg_rank_count () > 1) {
        snprintf (fresh, sizeof fresh, "%s.new", path);
        present = number_of (path), next = number_of (fresh);
        common = -fmax (present, next);
        PG_TRY (pg_ranks_ask (1, &common));            /* minus the smallest over the ranks of their newest */
        if (common <= 0 && next == -common) status = pg_checkpoint_commit (path);
        else if (common <= 0 && present != -common)
            status = of_other_moments (path);
        PG_TRY (pg_ranks_agree (status));
        pg_checkpoint_drop (path);                     /* one of another moment, or incomplete */
    }
    int there = access (path, F_OK) == 0;
    double any[2] = { there, pg_rank () == 0 && pg_result_left_early (folder, scene) };
    PG_TRY (pg_ranks_ask (2, any));
    *anew = any[0] <= 0 && any[1] > 0;
    if (!there && !*anew)
        status = pg_error (PG_E_USAGE, PG_HERE, "there is no %s to continue from: run without --resume",
                           path);
    PG_TRY (pg_ranks_agree (status));
done:
    return status;
}

pg_status resumed_go_on (pg_result *r, resumed *m)
{
    pg_status status = resumed_open (r, &m->now);
    if (status == PG_OK) status = pg_result_remove (r, "report.json");
    PG_TRY (pg_ranks_agree (status));
    r->progress.earlier = m->seconds;
    PG_TRY (catch_up (m));
done:
    return status;
}

/* Fails unless the checkpoints of all ranks are of one moment. They are numbered within a run: in a folder
 * that was put together from two runs, two moments may have one number, and ranks would wait for each other
 * for ever. All ranks call. */
static pg_status one_moment (const resumed *m)
{
    pg_status status = PG_OK;
    double step = (double) m->state->step, rounds = (double) m->rounds, time = m->state->time,
           all[6] = { step, -step, rounds, -rounds, time, -time };
    PG_TRY (pg_ranks_ask (6, all));                    /* largest over the ranks, and minus the smallest */
    if (all[0] != -all[1] || all[2] != -all[3] || all[4] != -all[5])
        status = of_other_moments (m->path);
done:
    return status;
}

/* Resumes from the checkpoint that this process wrote. */
static pg_status resume_own (pg_result *r, resumed *m)
{
    pg_status status = pg_result_lock (r->folder, &r->lock);
    if (status == PG_OK) status = pg_checkpoint_read (m->path, resumed_all, m);
    PG_TRY (pg_ranks_agree (status));
    PG_TRY (one_moment (m));
    PG_TRY (resumed_go_on (r, m));
done:
    return status;
}

/* Resumes a run. The folder is locked before the checkpoint is read, and its files are cut only after
 * everything in the checkpoint has been accepted by all ranks; a refused resume leaves the folder as it
 * was. */
pg_status pg_result_resume (pg_result **out, const char *folder, const pg_scene *scene,
                            const pg_problem *problem, pg_solver *solver, pg_state *state, pg_resumed *from)
{
    pg_status status = PG_OK;
    pg_result *r = NULL;
    resumed m = { .state = state };
    parts_kept others = { .count = 0 };
    char path[4096];
    snprintf (path, sizeof path, "%s/checkpoint.nc", folder);
    m.path = path;
    PG_TRY (pg_result_check (scene, problem));
    PG_TRY (moved_find (&others, folder));
    int moves = moved_from_others (&others);
    int anew = 0;
    if (!moves) PG_TRY (choose_checkpoint (path, folder, scene, &anew));
    if (anew) {
        *out = NULL, *from = (pg_resumed) { 0 };
        goto done;
    }
    PG_ALLOC (r, 1);
    m.r = r;
    PG_TRY (pg_result_prepare (r, folder, scene, problem, solver));
    PG_TRY (moves ? moved_resume (r, &m, &others) : resume_own (r, &m));
    *from = (pg_resumed) { state->step, m.rounds, m.seconds, (int) m.threads,
                           moves ? others.ranks : pg_rank_count () };
    *out = r;
    r = NULL;
done:
    pg_free (m.broken), pg_free (m.reaction);
    parts_close (&others);
    pg_result_free (&r);
    return status;
}

/* 1: the folder has a finished run of the scene: looks for the hash of the scene and the outcome in
 * report.json, whose length depends on its lists of files. */
int pg_result_finished (const char *folder, const pg_scene *scene)
{
    char path[4096], hash[128], *text;
    snprintf (path, sizeof path, "%s/checkpoint.nc", folder);
    if (access (path, F_OK) == 0) return 0;
    snprintf (path, sizeof path, "%s/report.json", folder);
    if (pg_file_text (&text, NULL, path) != PG_OK) return 0;
    snprintf (hash, sizeof hash, "\"scene_sha256\": \"%s\"", pg_scene_hash (scene));
    int finished = strstr (text, hash) && strstr (text, "\"outcome\": \"done\"");
    pg_free (text);
    return finished;
}

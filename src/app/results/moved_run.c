/* SPDX-License-Identifier: GPL-3.0-or-later
 * A run that continues on other processes than those that wrote its checkpoint: more or fewer ranks, one
 * process alone, ranks that divide the body or that hold all of it. Its files are divided anew: earlier
 * fields go into files of the points that are owned now, tables are copied to the ranks. The earlier
 * checkpoints and fields are removed only when the new processes have all written checkpoints of their own,
 * so that a run that is killed in between can continue from either. */
#include "resume.h"
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

void parts_path (char *out, size_t size, const char *folder, int part, int fresh)
{
    const char *end = fresh ? ".new" : "";
    if (part == 0) snprintf (out, size, "%s/checkpoint.nc%s", folder, end);
    else snprintf (out, size, "%s/ranks/%d/checkpoint.nc%s", folder, part, end);
}

/* ---- which processes wrote the checkpoint -------------------------------------------------------------- */
/* 1: a checkpoint of `count` processes that divide the body or not is one of the present processes. */
static int is_own (int count, int divided)
{
    return count == pg_rank_count () && divided == (pg_ranks_now () != NULL);
}

/* 1: the checkpoints in the folder are of the present processes and no others: the usual case, in which no
 * file is read whole. */
static int clearly_own (const char *folder)
{
    char path[4096];
    for (int fresh = 0; fresh < 2; fresh++) {
        pg_checkpoint *file = NULL;
        long was[3] = { 0 };
        parts_path (path, sizeof path, folder, 0, fresh);
        if (access (path, F_OK) != 0) continue;
        pg_status status = pg_checkpoint_open (&file, path);
        const pg_keeper *k = file ? pg_checkpoint_keeper (file) : NULL;
        if (status == PG_OK) status = k->counts (k->context, "ranks", 3, was);
        pg_checkpoint_close (&file);
        if (status == PG_OK && !is_own ((int) was[0], (int) was[2])) return 0;
    }
    return 1;
}

/* *found 1: all parts have a checkpoint of that number; w->fresh: under which name. Each rank looks at some
 * of them. */
static pg_status find_parts (parts_kept *w, const resumed_by *who, int *found)
{
    pg_status status = PG_OK;
    double *fresh = NULL, *missing;
    char path[4096];
    int count = who->divided ? who->count : 1;
    PG_ALLOC (fresh, (size_t) count + 1);
    missing = fresh + count;
    for (int k = pg_rank (); k < count; k += pg_rank_count ()) {
        int name, there = 0;
        for (name = 0; name < 2 && !there; name++) {
            parts_path (path, sizeof path, w->folder, k, name);
            resumed_by one = resumed_who (path);
            there = one.number == who->number && one.count == who->count && one.divided == who->divided
                    && one.rank == k;
            fresh[k] = there && name;
        }
        if (!there) *missing = 1;
    }
    PG_TRY (pg_ranks_ask ((size_t) count + 1, fresh));
    *found = *missing == 0;
    if (!*found) goto done;
    PG_ALLOC (w->fresh, (size_t) count);
    for (int k = 0; k < count; k++) w->fresh[k] = fresh[k] > 0;
    w->count = count, w->divided = who->divided, w->ranks = who->count;
done:
    pg_free (fresh);
    return status;
}

pg_status moved_find (parts_kept *w, const char *folder)
{
    pg_status status = PG_OK;
    enum { NAMES = 2, EACH = 3 };
    double seen[NAMES * EACH] = { -1, 0, 0, -1, 0, 0 };
    char path[4096];
    int found = 0;
    snprintf (w->folder, sizeof w->folder, "%.3100s%s", folder, pg_rank () ? "/../.." : "");
    for (int fresh = 0; fresh < NAMES && pg_rank () == 0 && !clearly_own (w->folder); fresh++) {
        parts_path (path, sizeof path, w->folder, 0, fresh);
        resumed_by who = resumed_who (path);
        seen[EACH * fresh] = who.number, seen[EACH * fresh + 1] = who.count;
        seen[EACH * fresh + 2] = who.divided;
    }
    PG_TRY (pg_ranks_ask (NAMES * EACH, seen));
    int newest = seen[EACH] > seen[0];
    for (int i = 0; i < NAMES && !found; i++) {
        const double *one = seen + EACH * (i == 0 ? newest : !newest);
        const resumed_by who = { one[0], (int) one[1], 0, (int) one[2] };
        if (who.number >= 0) PG_TRY (find_parts (w, &who, &found));
    }
done:
    return status;
}

int moved_from_others (const parts_kept *w) { return w->count > 0 && !is_own (w->ranks, w->divided); }

/* ---- files --------------------------------------------------------------------------------------------- */
static pg_status copy_file (const char *to, const char *from)
{
    pg_status status = PG_OK;
    FILE *in = fopen (from, "rb"), *out = NULL;
    char piece[1 << 16];
    size_t n;
    if (!in && errno == ENOENT) return PG_OK;
    if (!in) PG_FAIL (PG_E_FILE, "%s: %s", from, strerror (errno));
    PG_TRY (pg_file_create (&out, to));
    while ((n = fread (piece, 1, sizeof piece, in)) > 0)
        if (fwrite (piece, 1, n, out) != n) PG_FAIL (PG_E_FILE, "%s: %s", to, strerror (errno));
    if (ferror (in)) PG_FAIL (PG_E_FILE, "%s cannot be read", from);
    int bad = fclose (out) != 0;
    out = NULL;
    if (bad) PG_FAIL (PG_E_FILE, "%s: %s", to, strerror (errno));
done:
    if (in) fclose (in);
    if (out) fclose (out);
    return status;
}

/* Copies the tables of rank 0 to this rank. */
static pg_status copy_tables (const pg_result *r, const parts_kept *w)
{
    pg_status status = PG_OK;
    static const char *const name[] = { "history.csv", "events.csv", "cracks.csv", "tips.csv", "fronts.csv",
                                        "contact.csv" };
    char from[4096], to[4096];
    for (size_t k = 0; k < sizeof name / sizeof *name && pg_rank () > 0; k++) {
        snprintf (from, sizeof from, "%s/%s", w->folder, name[k]);
        snprintf (to, sizeof to, "%s/%s", r->folder, name[k]);
        PG_TRY (copy_file (to, from));
    }
done:
    return status;
}

/* Writes the earlier fields anew, at the points that are owned now, if their format needs that. */
static pg_status divide_fields (pg_result *r, const parts_kept *w)
{
    result_fields *f = &r->fields;
    pg_status status = PG_OK;
    const pg_writer *writer = f->writer;
    const result_marks at = r->progress.done;
    size_t n;
    double *time = NULL;
    PG_TRY (pg_result_fields_open (r, writer->read ? NULL : &at));
    if (!writer->read || !f->output) goto done;
    PG_TRY (writer->times (w->folder, w->divided ? w->count : 0, &n, &time));
    if ((long) n < at.moments)
        PG_FAIL (PG_E_FILE, "%s: %s has %zu moments, %ld are missing: it was changed since", w->folder,
                 writer->file, n, at.moments - (long) n);
    for (long m = 0; m < at.moments; m++) {
        for (size_t k = 0; k < f->nfield; k++)
            PG_TRY (parts_field (w, writer, m, f->field[k].name, (size_t) f->field[k].components,
                                 f->value[k]));
        PG_TRY (writer->step (f->output, m, time[m], f->field));
    }
done:
    resumed_marks (r, &at);
    pg_free (time);
    return status;
}

/* Removes what the earlier processes have left, when all ranks have checkpoints of their own. */
static pg_status drop_others (const pg_result *r)
{
    pg_status status = PG_OK;
    PG_TRY (pg_ranks_agree (PG_OK));
    if (pg_rank () == 0) pg_result_drop_earlier (r);
    PG_TRY (pg_ranks_agree (PG_OK));
done:
    return status;
}

/* ---- the run ------------------------------------------------------------------------------------------- */
/* Reads state, solver, and the counters of the result. */
static pg_status take (pg_result *r, resumed *m, parts_kept *w)
{
    pg_status status = PG_OK;
    PG_TRY (parts_open (w, r->problem));
    const pg_moved moved = parts_moved (w);
    status = resumed_files (m, moved.alike);
    if (status == PG_OK && m->is_pending)
        status = pg_error (PG_E_USAGE, PG_HERE, "the last step of %s is not in the tables yet, as they could "
                           "not be written: go on among as many processes as before first", w->folder);
    PG_TRY (pg_ranks_agree (status));
    PG_TRY (pg_solver_move (r->solver, m->state, &moved));
    m->rounds = r->progress.rounds = 0;
done:
    return status;
}

/* Checks that the checkpoint is of this scene, can be divided anew, and is not in use. */
static pg_status accept (pg_result *r, resumed *m, const parts_kept *w)
{
    pg_status status = PG_OK;
    pg_checkpoint *first = NULL;
    PG_TRY (pg_folder_make (r->folder));
    PG_TRY (pg_result_lock (r->folder, &r->lock));
    PG_TRY (pg_checkpoint_open (&first, m->path));
    PG_TRY (resumed_identity (m, pg_checkpoint_keeper (first)));
    if (pg_checkpoint_length (first, "part.sum") == 0)
        PG_FAIL (PG_E_USAGE, "%s was written by %d process%s, and its points cannot be divided otherwise: go "
                 "on among as many", m->path, w->ranks, w->ranks > 1 ? "es" : "");
done:
    pg_checkpoint_close (&first);
    return status;
}

pg_status moved_resume (pg_result *r, resumed *m, parts_kept *w)
{
    pg_status status = PG_OK;
    int whole = !w->divided && !pg_ranks_now ();
    char path[4096];
    result_marks at;
    parts_path (path, sizeof path, w->folder, 0, w->fresh[0]);
    m->path = path, m->anywhere = 1;
    PG_TRY (pg_ranks_agree (accept (r, m, w)));
    PG_TRY (pg_ranks_agree (copy_tables (r, w)));
    PG_TRY (pg_ranks_agree (whole ? pg_checkpoint_read (path, resumed_all, m) : take (r, m, w)));
    if (whole) {
        PG_TRY (resumed_go_on (r, m));
    } else {
        at = r->progress.done;
        /* rank 0 writes the events of all ranks */
        if (pg_rank () > 0 && pg_ranks_now ()) at.events = 0;
        status = pg_result_history_create (r, &at);
        if (status == PG_OK) status = divide_fields (r, w);
        if (status == PG_OK) status = pg_result_remove (r, "report.json");
        PG_TRY (pg_ranks_agree (status));
        r->progress.done = pg_result_marks_now (r);
        r->progress.earlier = m->seconds;
    }
    PG_TRY (pg_result_checkpoint (r, m->state));
    PG_TRY (drop_others (r));
done:
    return status;
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * Which run may write into a result folder: one at a time, none over the results of an unfinished run, and
 * none over a scene that no run put there. Also the copy of the scene, which makes a folder complete: a
 * result can be opened again with nothing but its folder and the files that the scene names. */
#include "results_private.h"
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

/* The line that marks a scene.yaml as the copy of a run. */
static const char copied[] = "\n# copied by perigal run from ";

/* ---- one run at a time --------------------------------------------------------------------------------- */
/* The process that the lock names, and its host; 0 if it names none. */
static long owner_of (int file, char host[128])
{
    char text[200] = "";
    long process = 0;
    host[0] = 0;
    if (pread (file, text, sizeof text - 1, 0) <= 0 || sscanf (text, "%ld %127s", &process, host) != 2)
        return 0;
    return process;
}

/* 1: the process named in the lock still runs. Only processes of this host can be tested. */
static int is_alive (long process) { return process && (kill ((pid_t) process, 0) == 0 || errno == EPERM); }

/* 1: the open file is still the one at `path`; 0: its owner has removed it in between. */
static int is_still (int file, const char *path)
{
    struct stat own, present;
    return fstat (file, &own) == 0 && stat (path, &present) == 0 && own.st_ino == present.st_ino
           && own.st_dev == present.st_dev;
}

/* Takes the lock on an open run.lock and writes this process into it. The system's lock (flock) ends with its
 * process, even a killed one. Where a file system has no such locks, or another host may hold it, what the
 * file says counts: for a process of this host it is tested whether it runs. *retry = 1: the owner has
 * removed the file in between, so that the lock is on a file that has no name any more. */
static pg_status claim (int file, const char *path, const char *folder, int *retry)
{
    pg_status status = PG_OK;
    char host[128], here[128] = "", text[200];
    gethostname (here, sizeof here - 1);
    /* A blank would end the name when the lock is read back. */
    for (char *c = here; *c; c++) if (*c == ' ') *c = '_';
    int taken = flock (file, LOCK_EX | LOCK_NB) != 0, without_locks = taken && errno != EWOULDBLOCK;
    long process = owner_of (file, host);
    if (without_locks) taken = strcmp (host, here) == 0 && is_alive (process);
    if (taken)
        PG_FAIL (PG_E_USAGE, "%s is in use by another run (process %ld on %s): name another folder with -o",
                 folder, process, *host ? host : "this host");
    *retry = !is_still (file, path);
    if (*retry) goto done;
    if (process && strcmp (host, here) != 0)
        PG_FAIL (
            PG_E_USAGE,
            "%s may be in use by a run on another host (process %ld on %s): if that run is over, remove %s",
            folder, process, host, path);
    /* The text is for users, and for hosts on which the lock of this one is not visible. */
    int n = snprintf (text, sizeof text, "%ld %s\n", (long) getpid (), *here ? here : "unknown");
    if (ftruncate (file, 0) != 0 || pwrite (file, text, (size_t) n, 0) != n)
        PG_FAIL (PG_E_FILE, "%s: %s", path, strerror (errno));
done:
    return status;
}

/* Locks the folder; repeats until the locked file is the one that the name refers to. */
pg_status pg_result_lock (const char *folder, int *lock)
{
    pg_status status = PG_OK;
    char path[4096];
    int file = -1, retry = 1;
    snprintf (path, sizeof path, "%s/run.lock", folder);
    while (retry) {
        if (file >= 0) close (file);
        file = open (path, O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0666);
        if (file < 0) PG_FAIL (PG_E_FILE, "%s: %s", path, strerror (errno));
        PG_TRY (claim (file, path, folder, &retry));
    }
    *lock = file + 1;
    file = -1;
done:
    if (file >= 0) close (file);
    return status;
}

/* Unlocks the folder. The file is removed before the lock ends: `claim` relies on that order. */
void pg_result_unlock (const char *folder, int *lock)
{
    char path[4096];
    if (!*lock) return;
    snprintf (path, sizeof path, "%s/run.lock", folder);
    unlink (path);
    close (*lock - 1);
    *lock = 0;
}

/* ---- the copy of the scene ----------------------------------------------------------------------------- */
/* Appends text of that length, with a zero byte behind it. */
static pg_status append (char **text, size_t *n, size_t *cap, const char *more, size_t length)
{
    pg_status status = PG_OK;
    PG_GROW (*text, *cap, *n + length + 1);
    memcpy (*text + *n, more, length);
    *n += length;
    (*text)[*n] = 0;
done:
    return status;
}

/* Appends a comment as one line: line ends in it become blanks. */
static pg_status append_line (char **text, size_t *n, size_t *cap, const char *mark, const char *words)
{
    pg_status status = PG_OK;
    PG_TRY (append (text, n, cap, mark, strlen (mark)));
    size_t from = *n;
    PG_TRY (append (text, n, cap, words, strlen (words)));
    for (; from < *n; from++) if ((*text)[from] == '\n' || (*text)[from] == '\r') (*text)[from] = ' ';
    PG_TRY (append (text, n, cap, "\n", 1));
done:
    return status;
}

/* Makes the text of scene.yaml: that of the scene, followed by comment lines with its origin, the files that
 * it names with their hashes, and the --set options. pg_stored_scene takes these lines off again. Paths are
 * absolute, so that the folder may be moved. */
static pg_status copy_text (char **text, const pg_scene *scene)
{
    pg_status status = PG_OK;
    size_t n = 0, cap = 0;
    const char *source = pg_scene_source (scene), *file = pg_scene_file (scene), *set;
    char whole[PATH_MAX], words[PATH_MAX + 300];
    pg_named_file *named = NULL;
    size_t nnamed = 0;
    PG_TRY (pg_scene_files (scene, &nnamed, &named));
    PG_TRY (append (text, &n, &cap, source, strlen (source)));
    PG_TRY (append (text, &n, &cap, "\n", 1));
    PG_TRY (append_line (text, &n, &cap, copied + 1, realpath (file, whole) ? whole : file));
    for (size_t k = 0; k < nnamed; k++) {
        snprintf (words, sizeof words, "%s = %s, sha256 %s", named[k].key,
                  realpath (named[k].path, whole) ? whole : named[k].path, named[k].hash);
        PG_TRY (append_line (text, &n, &cap, "# with ", words));
    }
    for (size_t k = 0; (set = pg_scene_setting (scene, k)); k++)
        PG_TRY (append_line (text, &n, &cap, "# --set ", set));
done:
    pg_scene_files_free (nnamed, &named);
    return status;
}

/* Reads a whole file; *text stays NULL if there is none that can be opened. */
static pg_status read_text (const char *path, char **text)
{
    return access (path, R_OK) == 0 ? pg_file_text (text, NULL, path) : PG_OK;
}

/* 1 if both paths lead to the same file, by its number on its device. */
static int same_file (const char *a, const char *b)
{
    struct stat one, other;
    return stat (a, &one) == 0 && stat (b, &other) == 0 && one.st_ino == other.st_ino
           && one.st_dev == other.st_dev;
}

/* Writes scene.yaml, unless the folder is that of the scene itself. It is written under another name and
 * renamed, so that a killed run leaves no part of it, which would pass for a scene of the user. */
pg_status pg_result_copy_scene (const char *folder, const pg_scene *scene)
{
    pg_status status = PG_OK;
    char path[4096], fresh[4096 + 8], *text = NULL;
    FILE *f = NULL;
    snprintf (path, sizeof path, "%s/scene.yaml", folder);
    snprintf (fresh, sizeof fresh, "%s.new", path);
    if (same_file (path, pg_scene_file (scene))) goto done;
    PG_TRY (copy_text (&text, scene));
    PG_TRY (pg_file_create (&f, fresh));
    size_t n = strlen (text), wrote = fwrite (text, 1, n, f);
    int bad = fclose (f);
    f = NULL;
    if (bad != 0 || wrote != n || rename (fresh, path) != 0) {
        int why = errno;
        remove (fresh);
        PG_FAIL (PG_E_FILE, "cannot write %s: %s", path, strerror (why));
    }
done:
    if (f) fclose (f);
    pg_free (text);
    return status;
}

/* ---- files of earlier runs ----------------------------------------------------------------------------- */
/* 1 if the folder has an entry of that name. */
static int there_is (const char *folder, const char *name)
{
    char path[4096];
    struct stat s;
    snprintf (path, sizeof path, "%s/%s", folder, name);
    return lstat (path, &s) == 0;
}

/* Counts the rows of history.csv after the header; 0 without the file. */
static pg_status count_rows (const char *folder, long *rows)
{
    char path[4096], *text = NULL;
    snprintf (path, sizeof path, "%s/history.csv", folder);
    pg_status status = read_text (path, &text);
    *rows = -1;
    for (const char *c = text; c && (c = strchr (c, '\n')); c++) *rows += 1;
    if (*rows < 0) *rows = 0;
    pg_free (text);
    return status;
}

/* Fails if scene.yaml of the folder is neither the scene of this run nor the copy of a run: then it is the
 * user's and must not be overwritten. */
static pg_status must_not_be_the_users (const char *folder, const pg_scene *scene, const char *present)
{
    pg_status status = PG_OK;
    char path[4096], *report = NULL;
    snprintf (path, sizeof path, "%s/scene.yaml", folder);
    if (same_file (path, pg_scene_file (scene))) {
        if (pg_scene_setting (scene, 0) || strstr (present, "\n# --set "))
            PG_FAIL (
                PG_E_USAGE,
                "%s is the scene itself, in which a run would note its --set options: name another folder "
                "with -o",
                path);
        goto done;
    }
    if (strstr (present, copied)) goto done;
    snprintf (path, sizeof path, "%s/report.json", folder);
    PG_TRY (read_text (path, &report));  /* earlier versions left no mark in it, but a report.json */
    if (!report)
        PG_FAIL (
            PG_E_USAGE,
            "%s/scene.yaml was not written by a run and would be overwritten: name another folder with -o",
            folder);
done:
    pg_free (report);
    return status;
}

/* Fails if a run of this scene may not write into the folder. Reasons, in this order: not a folder; a scene
 * of the user; a checkpoint; rows of another scene without a report. Rows without a report are those of a run
 * that was killed before its first checkpoint: the same scene may begin anew there, another one may not. */
pg_status pg_result_may_open (const char *folder, const pg_scene *scene)
{
    pg_status status = PG_OK;
    char path[4096], *present = NULL, *copy = NULL;
    long rows;
    struct stat s;
    if (stat (folder, &s) != 0) return PG_OK;
    if (!S_ISDIR (s.st_mode))
        PG_FAIL (PG_E_USAGE, "%s is a file: results need a folder, name another with -o", folder);
    snprintf (path, sizeof path, "%s/scene.yaml", folder);
    PG_TRY (read_text (path, &present));
    if (present) PG_TRY (must_not_be_the_users (folder, scene, present));
    PG_TRY (count_rows (folder, &rows));
    if (there_is (folder, "checkpoint.nc"))
        PG_FAIL (PG_E_USAGE,
                 "%s holds an unfinished run, %ld rows of history.csv and a checkpoint: continue with "
                 "--resume, start anew with --force, or name "
                 "another folder with -o",
                 folder, rows);
    if (rows < 1 || there_is (folder, "report.json")) goto done;
    PG_TRY (copy_text (&copy, scene));
    if (!present || strcmp (present, copy) != 0)
        PG_FAIL (PG_E_USAGE,
                 "%s holds %ld rows of history.csv of another run that did not finish: replace them "
                 "with --force, or name another folder with -o",
                 folder, rows);
done:
    pg_free (present), pg_free (copy);
    return status;
}

/* 1: the folder has no entry but `ranks`, as after a run that was killed before it locked the folder; its
 * other ranks may have been further. */
static int is_empty (const char *folder)
{
    int n = 0;
    const struct dirent *entry;
    DIR *open = opendir (folder);
    if (!open) return 0;
    while (!n && (entry = readdir (open)))
        n = strcmp (entry->d_name, ".") != 0 && strcmp (entry->d_name, "..") != 0
            && strcmp (entry->d_name, "ranks") != 0;
    closedir (open);
    return n == 0;
}

/* 1: a run of this scene ended before its first checkpoint. The copy of the scene is written before all files
 * but the lock. */
int pg_result_left_early (const char *folder, const pg_scene *scene)
{
    char path[4096], *present = NULL, *copy = NULL;
    snprintf (path, sizeof path, "%s/scene.yaml", folder);
    int ran = there_is (folder, "run.lock") || there_is (folder, "history.csv") || is_empty (folder);
    int same = same_file (path, pg_scene_file (scene));
    if (ran && !same && read_text (path, &present) == PG_OK)
        same = present ? copy_text (&copy, scene) == PG_OK && strcmp (present, copy) == 0
                       : !there_is (folder, "scene.yaml") && !there_is (folder, "history.csv");
    pg_free (present), pg_free (copy);
    return ran && same;
}

/* Removes what keeps another run from opening the folder; the report of a finished run does not and stays. */
pg_status pg_result_discard (const char *folder)
{
    pg_status status = PG_OK;
    static const char *const name[] = { "checkpoint.nc", "checkpoint.nc.new", "history.csv" };
    char path[4096];
    int lock = 0;
    struct stat s;
    if (stat (folder, &s) != 0 || !S_ISDIR (s.st_mode)) return PG_OK;
    PG_TRY (pg_result_lock (folder, &lock));
    for (size_t k = 0; k < sizeof name / sizeof *name; k++) {
        snprintf (path, sizeof path, "%s/%s", folder, name[k]);
        if (unlink (path) != 0 && errno != ENOENT)
            PG_FAIL (PG_E_FILE, "cannot remove %s: %s", path, strerror (errno));
    }
done:
    pg_result_unlock (folder, &lock);
    return status;
}

/* Removes folders of ranks beyond the present ones, which are numbered without gaps, and earlier fields. */
void pg_result_drop_earlier (const pg_result *r)
{
    char path[4096];
    struct stat s;
    for (int rank = pg_rank_count ();; rank++) {
        snprintf (path, sizeof path, "%s/ranks/%d", r->folder, rank);
        if (stat (path, &s) != 0) break;
        pg_folder_remove (path);
    }
    snprintf (path, sizeof path, "%s/ranks", r->folder);
    if (pg_rank_count () == 1) rmdir (path);
    pg_writer_clear (r->fields.writer, r->folder, r->fields.request.share ? r->fields.share.size : 0);
}

/* Removes all folders of ranks; ranks that were killed one by one may have left gaps between the numbers. */
void pg_result_drop_finished_ranks (const char *folder)
{
    char path[4096];
    const struct dirent *entry;
    snprintf (path, sizeof path, "%s/ranks", folder);
    DIR *ranks = opendir (path);
    if (!ranks) return;
    while ((entry = readdir (ranks)))
        if (entry->d_name[strspn (entry->d_name, "0123456789")] == '\0') {
            snprintf (path, sizeof path, "%.3800s/ranks/%.200s", folder, entry->d_name);
            pg_folder_remove (path);
        }
    closedir (ranks);
    snprintf (path, sizeof path, "%s/ranks", folder);
    rmdir (path);
}

/* ---- files and names ----------------------------------------------------------------------------------- */
const char *pg_result_path (const pg_result *r, const char *name, char *out, size_t size)
{
    snprintf (out, size, "%s/%s", r->folder, name);
    return out;
}

/* Removes a file of the folder; one that is missing is no failure. */
pg_status pg_result_remove (const pg_result *r, const char *name)
{
    pg_status status = PG_OK;
    char path[4096];
    snprintf (path, sizeof path, "%s/%s", r->folder, name);
    if (remove (path) != 0 && errno != ENOENT)
        PG_FAIL (PG_E_FILE, "cannot remove %s: %s", path, strerror (errno));
done:
    return status;
}

/* Name of a Voigt component, in the order of doc/notation.md. */
const char *pg_result_voigt (int dim, int k)
{
    static const char *const part[4][6] = {
        { "" }, { "xx" }, { "xx", "yy", "xy" }, { "xx", "yy", "zz", "xy", "yz", "zx" }
    };
    return part[dim][k];
}

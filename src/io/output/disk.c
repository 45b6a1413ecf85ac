/* SPDX-License-Identifier: GPL-3.0-or-later
 * Writes files by system calls: everything is written, or the call fails with the reason that
 * the system gives. The buffered functions of C would report a full disk only later, at fclose. */
#include "disk.h"
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* pwrite may write less than asked for, for example on a disk that fills up; the loop asks
 * again for the rest and then gets the reason. EINTR is no failure. */
pg_status pg_disk_write (const char *path, int file, const void *data, size_t bytes, long offset)
{
    pg_status status = PG_OK;
    const char *from = data;
    while (bytes > 0) {
        ssize_t n = pwrite (file, from, bytes, offset);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0)
            PG_FAIL (PG_E_FILE, "%s: %s", path, n < 0 ? strerror (errno) : "nothing could be written");
        from += n, bytes -= (size_t) n, offset += n;
    }
done:
    return status;
}

pg_status pg_disk_fresh (char **out, const char *path)
{
    pg_status status = PG_OK;
    size_t size = strlen (path) + 5;
    PG_ALLOC (*out, size);
    snprintf (*out, size, "%s.new", path);
done:
    return status;
}

/* Called when a file is opened for appending, to drop what was written behind a remembered length. */
pg_status pg_disk_cut (const char *path, int file, long bytes)
{
    return ftruncate (file, bytes) == 0 ? PG_OK
                                        : pg_error (PG_E_FILE, PG_HERE, "%s: %s", path, strerror (errno));
}

/* A character device (/dev/full in tests, /dev/null) is written to as it is, since it holds
 * nothing that could be lost. Other special files and folders are refused. The old file is
 * removed rather than truncated, so that a hard link to it keeps its content. O_EXCL makes
 * sure that nobody has put something into the place in between. */
pg_status pg_disk_create (const char *path, int *file)
{
    pg_status status = PG_OK;
    struct stat s;
    *file = -1;
    if (stat (path, &s) == 0 && S_ISCHR (s.st_mode)) {  /* a device holds nothing that could be lost */
        *file = open (path, O_WRONLY | O_CLOEXEC);
        if (*file < 0) PG_FAIL (PG_E_FILE, "%s: %s", path, strerror (errno));
        goto done;
    }
    int there = lstat (path, &s) == 0;
    if (there && !S_ISREG (s.st_mode) && !S_ISLNK (s.st_mode))
        PG_FAIL (PG_E_FILE, "%s: %s", path, S_ISDIR (s.st_mode) ? strerror (EISDIR) : "is no regular file");
    if (there && unlink (path) != 0) PG_FAIL (PG_E_FILE, "%s: %s", path, strerror (errno));
    *file = open (path, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (*file < 0) PG_FAIL (PG_E_FILE, "%s: %s", path, strerror (errno));
done:
    return status;
}

/* pg_disk_create for callers that use the buffered functions of C (cairo, JSON). */
pg_status pg_file_create (FILE **out, const char *path)
{
    int file;
    *out = NULL;
    pg_status status = pg_disk_create (path, &file);
    if (status != PG_OK) return status;
    *out = fdopen (file, "wb");
    if (*out) return PG_OK;
    close (file);
    return pg_error (PG_E_FILE, PG_HERE, "%s: %s", path, strerror (errno));
}

/* The file is read in pieces of 64 KiB, because the length of a pipe is not known before. */
pg_status pg_file_text (char **text, size_t *size, const char *path)
{
    pg_status status = PG_OK;
    size_t n = 0, cap = 0, got;
    FILE *f = fopen (path, "rb");
    *text = NULL;
    if (!f) PG_FAIL (PG_E_FILE, "%s: %s", path, strerror (errno));
    do {
        PG_GROW (*text, cap, n + 65537);
        got = fread (*text + n, 1, 65536, f);
        n += got;
    } while (got > 0);
    if (ferror (f)) PG_FAIL (PG_E_FILE, "%s: %s", path, strerror (errno));
    (*text)[n] = 0;
    if (size) *size = n;
done:
    if (f) fclose (f);
    if (status != PG_OK) pg_free (*text), *text = NULL;
    return status;
}

/* Syncing a folder is not supported everywhere; EINVAL and ENOTSUP therefore count as success. */
pg_status pg_file_sync (const char *path)
{
    int file = open (path, O_RDONLY);
    if (file < 0) return pg_error (PG_E_FILE, PG_HERE, "%s: %s", path, strerror (errno));
    /* not every system syncs folders */
    int bad = fsync (file) != 0 && errno != EINVAL && errno != ENOTSUP, reason = errno;
    close (file);
    return bad ? pg_error (PG_E_FILE, PG_HERE, "%s: %s", path, strerror (reason)) : PG_OK;
}

/* Subfolders stay (the folder then stays too), and symbolic links are removed, not their targets. */
void pg_folder_remove (const char *path)
{
    char name[4300];
    const struct dirent *entry;
    DIR *folder = opendir (path);
    if (!folder) return;
    while ((entry = readdir (folder)))
        if (strcmp (entry->d_name, ".") != 0 && strcmp (entry->d_name, "..") != 0) {
            snprintf (name, sizeof name, "%.4000s/%s", path, entry->d_name);
            unlink (name);
        }
    closedir (folder);
    rmdir (path);
}

/* Longest allowed path of a folder in bytes: leaves room for the names of files in it and in its subfolders
 * below PATH_MAX, the limit of the system, and for a few words in error messages. */
enum { LONGEST = 3000 };

/* Goes through the path and makes every folder on the way. A path longer than LONGEST is refused before any
 * folder is made, because paths of files in it would be cut off and name other files. */
pg_status pg_folder_make (const char *path)
{
    pg_status status = PG_OK;
    char *part = NULL;
    if (strlen (path) > LONGEST)
        PG_FAIL (PG_E_FILE, "the folder %.40s... has a path of %zu bytes, more than the %d that leave room "
                            "for the names of files in it", path, strlen (path), LONGEST);
    part = pg_strdup (path);
    if (!part) PG_FAIL (PG_E_MEMORY, "no memory for a path");
    for (char *p = part + !!*part;; p++) {
        if (*p && *p != '/') continue;
        char keep = *p;
        *p = 0;
        if (mkdir (part, 0777) != 0 && errno != EEXIST)
            PG_FAIL (PG_E_FILE, "cannot make the folder %s: %s", part, strerror (errno));
        *p = keep;
        if (!keep) break;
    }
done:
    pg_free (part);
    return status;
}

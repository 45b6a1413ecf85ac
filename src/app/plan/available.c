/* SPDX-License-Identifier: GPL-3.0-or-later
 * How much memory is left: the least of what the machine has free (MemAvailable), what each control group
 * above the process still grants (limit minus use, file cache counted as free), and RLIMIT_AS minus the
 * address space in use. */
#include "perigal/plan.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

enum { PATH = 1200 };

/* The number after `key` at the start of a line of a file (key "": the first number of the file); NAN: no
 * such file, line or number ("max"). */
static double number_in (const char *path, const char *key)
{
    char line[512];
    double value = NAN;
    FILE *f = fopen (path, "r");
    while (f && isnan (value) && fgets (line, sizeof line, f)) {
        char *end, *start = line + strlen (key);
        if (strncmp (line, key, strlen (key)) != 0) continue;
        double v = strtod (start, &end);
        if (end != start) value = v;
        if (!*key) break;
    }
    if (f) fclose (f);
    return value;
}

/* The number after `key` in file `name` of a folder (number_in); NAN: no such file, line or number. */
static double number_at (const char *folder, const char *name, const char *key)
{
    char path[PATH + 64];
    snprintf (path, sizeof path, "%s/%s", folder, name);
    return number_in (path, key);
}

/* Where control groups of either version keep limit, use, and the part of the use that is file cache,
 * which the system gives back when it is needed. */
typedef struct { const char *mount, *limit, *use, *cache; } hierarchy;
static const hierarchy v2 = { "/sys/fs/cgroup", "memory.max", "memory.current", "inactive_file " };
static const hierarchy v1 = { "/sys/fs/cgroup/memory", "memory.limit_in_bytes", "memory.usage_in_bytes",
                              "total_inactive_file " };

/* Memory that control group `name` and all groups above it leave, bytes: the least of them. A group that is
 * not visible here sets no limit. */
static double group_left (const char *root, const hierarchy *h, const char *name)
{
    char folder[PATH];
    double least = INFINITY;
    int n = snprintf (folder, sizeof folder, "%s%s%s", root, h->mount, name);
    size_t top = strlen (root) + strlen (h->mount);
    if (n < 0 || n >= (int) sizeof folder) return least;
    for (;;) {
        double limit = number_at (folder, h->limit, ""), use = number_at (folder, h->use, ""),
               cache = number_at (folder, "memory.stat", h->cache);
        if (limit >= 0 && use >= 0)
            least = fmin (least, fmax (0, limit - use + (cache > 0 ? fmin (cache, use) : 0)));
        if (strlen (folder) <= top) return least;
        *strrchr (folder, '/') = 0;
    }
}

/* Memory left by all control groups that /proc/self/cgroup names, bytes: the least of them. */
static double groups_left (const char *root)
{
    char path[PATH], line[1024];
    double least = INFINITY;
    snprintf (path, sizeof path, "%s/proc/self/cgroup", root);
    FILE *f = fopen (path, "r");
    while (f && fgets (line, sizeof line, f)) {        /* "0::/a/b" is v2, "4:memory:/a/b" v1 */
        char *kind = strchr (line, ':'), *name = kind ? strchr (kind + 1, ':') : NULL;
        if (!name) continue;
        *name++ = 0, kind++;
        name[strcspn (name, "\n")] = 0;
        if (*name != '/') continue;
        char framed[160];
        snprintf (framed, sizeof framed, ",%.140s,", kind);
        if (!*kind) least = fmin (least, group_left (root, &v2, name));
        else if (strstr (framed, ",memory,")) least = fmin (least, group_left (root, &v1, name));
    }
    if (f) fclose (f);
    return least;
}

/* What RLIMIT_AS leaves of the address space, bytes; INFINITY without a limit. */
static double address_space_left (const char *root)
{
    struct rlimit r;
    char path[PATH];
    if (getrlimit (RLIMIT_AS, &r) != 0 || r.rlim_cur == RLIM_INFINITY) return INFINITY;
    snprintf (path, sizeof path, "%s/proc/self/statm", root);
    double pages = number_in (path, "");
    return fmax (0, (double) r.rlim_cur - (pages > 0 ? pages * (double) sysconf (_SC_PAGESIZE) : 0));
}

/* Memory left to this process, bytes; INFINITY where nothing is known, as on systems without /proc: a
 * forecast then refuses nothing. */
double pg_available_memory (const char *root)
{
    char path[PATH];
    snprintf (path, sizeof path, "%.1000s/proc/meminfo", root);
    double left = number_in (path, "MemAvailable:") * 1024;
    if (isnan (left)) left = INFINITY;
    return fmin (left, fmin (groups_left (root), address_space_left (root)));
}

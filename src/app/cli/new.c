/* SPDX-License-Identifier: GPL-3.0-or-later
 * perigal new KIND [-o DIR]: writes a commented scene that runs, with the files that it names. The scenes are
 * those of data/new, which the Makefile turns into build/.../new_scenes.h. */
#include "app/cli/preparation/cli.h"
#include "new_scenes.h"
#include <errno.h>
#include <getopt.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* Prints the kinds in the order of the files: "beam, cloud, ...". */
static void kinds (FILE *to)
{
    const char *last = "";
    for (size_t k = 0; k < sizeof new_files / sizeof *new_files; k++) {
        if (strcmp (new_files[k].kind, last) == 0) continue;
        fprintf (to, "%s%s", *last ? ", " : "", new_files[k].kind);
        last = new_files[k].kind;
    }
}

/* Returns the kind most similar to a misspelt one; NULL: none is similar. */
static const char *nearest (const char *kind)
{
    char names[400] = "";
    for (size_t k = 0, n = 0; k < sizeof new_files / sizeof *new_files && n < sizeof names; k++)
        n += (size_t) snprintf (names + n, sizeof names - n, "%s%s", k ? "|" : "", new_files[k].kind);
    return pg_nearest_name (kind, names);
}

/* Creates the folder and those above it. */
static pg_status make_folder (const char *folder)
{
    pg_status status = PG_OK;
    char path[4096];
    size_t n = strlen (folder);
    if (n >= sizeof path) PG_FAIL (PG_E_FILE, "%.60s...: too long a path", folder);
    for (size_t k = 1; k <= n; k++) {
        if (folder[k] != '/' && folder[k] != '\0') continue;
        memcpy (path, folder, k);
        path[k] = '\0';
        if (mkdir (path, 0777) && errno != EEXIST)
            PG_FAIL (PG_E_FILE, "%s: cannot be made: %s", path, strerror (errno));
    }
done:
    return status;
}

/* Writes one file; fails if it exists. */
static pg_status write_file (const char *folder, const char *name, const char *const *line)
{
    pg_status status = PG_OK;
    char path[4096];
    FILE *f = NULL;
    if ((size_t) snprintf (path, sizeof path, "%s/%s", folder, name) >= sizeof path)
        PG_FAIL (PG_E_FILE, "%.60s...: too long a path", folder);
    f = fopen (path, "wx");
    if (!f && errno == EEXIST) PG_FAIL (PG_E_FILE, "%s exists already: choose another folder (-o DIR)", path);
    if (!f) PG_FAIL (PG_E_FILE, "%s: cannot be written: %s", path, strerror (errno));
    int good = 1;
    for (; *line; line++) good &= fprintf (f, "%s\n", *line) >= 0;
    good &= fclose (f) == 0;
    f = NULL;
    if (!good) PG_FAIL (PG_E_FILE, "%s: cannot be written: %s", path, strerror (errno));
done:
    if (f) fclose (f);
    return status;
}

/* Writes all files of a kind; PG_E_USAGE: there is no such kind. */
static pg_status write_kind (const char *kind, const char *folder)
{
    pg_status status = PG_OK;
    int any = 0;
    for (size_t k = 0; k < sizeof new_files / sizeof *new_files; k++) {
        if (strcmp (new_files[k].kind, kind) != 0) continue;
        if (!any++) PG_TRY (make_folder (folder));
        PG_TRY (write_file (folder, new_files[k].name, new_files[k].line));
        if (strcmp (new_files[k].name, "scene.yaml") != 0) printf ("%s/%s\n", folder, new_files[k].name);
    }
done:
    return status == PG_OK && !any ? PG_E_USAGE : status;
}

int pg_cli_new (int argc, char **argv)
{
    static const struct option options[] = { { "out", required_argument, NULL, 'o' },
                                             { "help", no_argument, NULL, 'h' }, { NULL, 0, NULL, 0 } };
    const char *folder = NULL;
    optind = 1, opterr = 0;
    for (int k; (k = getopt_long (argc, argv, ":o:h", options, NULL)) != -1;) {
        if (k == 'h') return command_usage (stdout, "new") ? PG_EXIT_DONE : PG_EXIT_USAGE;
        if (k == 'o') folder = optarg;
        else {
            fprintf (stderr, "perigal new: %s %s\n", argv[optind - 1],
                     k == ':' ? "needs a value" : "is no option of it");
            command_usage (stderr, "new");
            return PG_EXIT_USAGE;
        }
    }
    if (optind + 1 != argc) {
        fprintf (stderr, "perigal new needs one kind: ");
        kinds (stderr);
        fprintf (stderr, "\n");
        return PG_EXIT_USAGE;
    }
    const char *kind = argv[optind];
    pg_status status = write_kind (kind, folder ? folder : kind);
    if (status == PG_E_USAGE) {
        const char *near = nearest (kind);
        fprintf (stderr, "perigal new: there is no kind %s%s%s%s; there are: ", kind,
                 near ? " (did you mean " : "", near ? near : "", near ? "?)" : "");
        kinds (stderr);
        fprintf (stderr, "\n");
        return PG_EXIT_USAGE;
    }
    if (status != PG_OK) {
        command_complain (status, pg_last_error ());
        return pg_exit_code (status);
    }
    if (!folder) folder = kind;
    printf ("%s/scene.yaml\n"
            "  perigal check %s/scene.yaml     what it amounts to, and what is wrong with it\n"
            "  perigal run %s/scene.yaml       runs it; results in out/%s\n",
            folder, folder, folder, strrchr (folder, '/') ? strrchr (folder, '/') + 1 : folder);
    return PG_EXIT_DONE;
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * A lattice of points with two blocks for the tests of this folder, and the folder their files go to. */
#ifndef PERIGAL_TEST_OUTPUT_SAMPLE_H
#define PERIGAL_TEST_OUTPUT_SAMPLE_H
#include "perigal/output.h"
#include <signal.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

static char folder[64];

/* Path of a file in a fresh folder; a buffer of four in turn. */
static const char *file_at (const char *name)
{
    static char path[4][160];
    static int k;
    if (!folder[0]) {
        strcpy (folder, "/tmp/perigal-test-XXXXXX");
        assert_non_null (mkdtemp (folder));
    }
    k = (k + 1) % 4;
    snprintf (path[k], sizeof path[k], "%s/%s", folder, name);
    return path[k];
}

static int remove_folder (void **unused)
{
    char command[96];
    (void) unused;
    if (!folder[0]) return 0;
    snprintf (command, sizeof command, "rm -rf %s", folder);
    return system (command);
}

/* Kills a child a moment after it has told of `least` things done, by a byte each: however busy the machine
 * is, those are done. */
static inline void kill_after (pid_t child, int told[2], long least, long nanoseconds)
{
    char byte;
    int how;
    close (told[1]);
    for (; least > 0; least--) assert_int_equal (read (told[0], &byte, 1), 1);
    nanosleep (&(struct timespec) { .tv_nsec = nanoseconds }, NULL);
    kill (child, SIGKILL);
    waitpid (child, &how, 0);
    assert_true (WIFSIGNALED (how));
    close (told[0]);
}

/* m points per axis, spacing h, first at (-1, 2, 5) h; uneven places and volumes, so that digits are lost if
 * any can be. */
static inline void make_cloud (pg_cloud *c, int dim, int m, double h)
{
    static const double first[] = { -1, 2, 5 };
    *c = (pg_cloud) { .dim = dim, .h = h, .thickness = dim == 3 ? 1 : 0.01 / 3 };
    c->n = 1;
    for (int a = 0; a < dim; a++) c->n *= (size_t) m;
    c->x = pg_calloc (c->n * (size_t) dim, sizeof (double));
    c->volume = pg_calloc (c->n, sizeof (double));
    c->block = pg_calloc (c->n, sizeof (int));
    for (int a = 0; a < dim; a++) {
        c->step[a] = h;
        c->low[a] = first[a] * h;
        c->high[a] = (first[a] + m - 1) * h;
    }
    for (size_t i = 0; i < c->n; i++) {
        size_t k = i;
        for (int a = 0; a < dim; a++, k /= (size_t) m)
            c->x[i * (size_t) dim + (size_t) a] = (first[a] + (double) (k % (size_t) m)) * h;
        c->volume[i] = h * h / (3 + (double) i);
        c->block[i] = i % 3 == 1 ? 4 : 0;
    }
}

static inline void drop_cloud (pg_cloud *c)
{
    pg_free (c->x);
    pg_free (c->volume);
    pg_free (c->block);
    *c = (pg_cloud) { 0 };
}
#endif

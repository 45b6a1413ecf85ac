/* SPDX-License-Identifier: GPL-3.0-or-later
 * Sizes of fast transforms, and plans of FFTW: guessed (the same everywhere), or measured and kept in a file
 * of the user's cache ("wisdom" of FFTW). */
#include "fft.h"
#include <errno.h>
#include <math.h>
#include <pthread.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* Held while FFTW's planner is used, which is not thread-safe and has one memory (wisdom) for the whole
 * process. */
static pthread_mutex_t planner = PTHREAD_MUTEX_INITIALIZER;

/* ---- sizes --------------------------------------------------------------------------------------------- */
/* Relative time of a transform per place, from bench/sums_rate fcbm on an AMD EPYC (FFTW 3.3.10): a constant
 * and a share of each prime factor; INFINITY for other factors than 2, 3, 5, 7. */
static double time_of (size_t n)
{
    static const struct {
        size_t prime;
        double time;
    } factor[] = { { 2, 0.08 }, { 3, 0.17 }, { 5, 0.22 }, { 7, 0.24 } };
    double sum = n % 2 ? 0.45 : 0.2;
    for (size_t k = 0; k < sizeof factor / sizeof *factor; k++)
        while (n % factor[k].prime == 0) n /= factor[k].prime, sum += factor[k].time;
    return n == 1 ? sum : INFINITY;
}

/* The size from `least` on, up to twice that, whose transform is estimated to be fastest; even sizes for
 * rows, whose real values are transformed as half as many complex ones. */
size_t pg_fft_size (size_t least, int even)
{
    size_t best = 0;
    double least_time = INFINITY;
    for (size_t n = least; n <= 2 * least + 2; n++) {
        double t = (double) n * time_of (n);
        if ((even && n % 2) || !(t < least_time)) continue;
        best = n, least_time = t;
    }
    return best;
}

/* ---- wisdom -------------------------------------------------------------------------------------------- */
/* Writes the path of the file of wisdom, $XDG_CACHE_HOME/perigal/fftw_wisdom or below ~/.cache; make: 1:
 * makes its folders. Returns 0 if there is no place for it, so that plans have to be timed again. */
static int wisdom_path (char *path, size_t size, int make)
{
    const char *cache = getenv ("XDG_CACHE_HOME"), *home = getenv ("HOME");
    int used = cache && cache[0] == '/' ? snprintf (path, size, "%s/perigal", cache)
             : home && home[0] == '/' ? snprintf (path, size, "%s/.cache/perigal", home) : -1;
    if (used < 0 || (size_t) used + 32 > size) return 0;
    if (make && mkdir (path, 0777) != 0 && errno != EEXIST) {
        char *slash = strrchr (path, '/');
        *slash = 0;
        mkdir (path, 0777);
        *slash = '/';
        if (mkdir (path, 0777) != 0 && errno != EEXIST) return 0;
    }
    strcat (path, "/fftw_wisdom");
    return 1;
}

typedef struct { char *text; size_t n, cap; } copy;

/* Appends a letter to a copy of FFTW's wisdom, which it exports letter by letter. */
static void add_letter (char letter, void *context)
{
    copy *c = context;
    if (c->n + 2 > c->cap) {
        char *more = pg_resize (c->text, 2 * c->cap + 256, 1);
        if (!more) return;                             /* a text cut short is refused when it is read */
        c->text = more, c->cap = 2 * c->cap + 256;
    }
    c->text[c->n++] = letter, c->text[c->n] = 0;
}

/* Writes the wisdom to a new file and renames it, so that two programs at the same time leave a complete
 * file. */
static void keep_wisdom (void)
{
    char path[4096], fresh[4096 + 32];
    if (!wisdom_path (path, sizeof path, 1)) return;
    snprintf (fresh, sizeof fresh, "%s.%ld", path, (long) getpid ());
    if (!fftw_export_wisdom_to_filename (fresh) || rename (fresh, path) != 0) remove (fresh);
}

/* ---- plans --------------------------------------------------------------------------------------------- */
/* Plans the transform of FFT_WIDE complex columns of T places side by side, in place. */
static fftw_plan columns (size_t T, double *x, int sign, unsigned how)
{
    fftw_iodim along = { (int) T, FFT_WIDE, FFT_WIDE }, side = { FFT_WIDE, 1, 1 };
    return fftw_plan_guru_dft (1, &along, 1, &side, (fftw_complex *) x, (fftw_complex *) x, sign, how);
}

/* Makes all plans of a box on the workspaces x and y. Returns 0 if one could not be made. */
static int make_plans (fft_box *b, double *x, double *y, unsigned how)
{
    int all = 1;
    b->row[0] = fftw_plan_dft_r2c_1d ((int) b->T[0], x, (fftw_complex *) y, how);
    b->row[1] = fftw_plan_dft_c2r_1d ((int) b->T[0], (fftw_complex *) y, x, how);
    for (int k = 0; k < 2; k++) {
        if (b->T[1] > 1)
            b->middle[k] = columns (b->T[1], x, k ? FFTW_BACKWARD : FFTW_FORWARD, how),
            all &= b->middle[k] != NULL;
        if (b->T[2] > 1)
            b->last[k] = columns (b->T[2], x, k ? FFTW_BACKWARD : FFTW_FORWARD, how),
            all &= b->last[k] != NULL;
        all &= b->row[k] != NULL;
    }
    return all;
}

/* Destroys the FFTW plans; those that were not made are NULL. */
static void clear_plans (fft_box *b)
{
    fftw_plan *all[] = { &b->row[0], &b->row[1], &b->middle[0], &b->middle[1], &b->last[0], &b->last[1] };
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) {
        if (*all[k]) fftw_destroy_plan (*all[k]);
        *all[k] = NULL;
    }
}

/* Sets sites and places along axis k of the box (0: rows; the other axis of a 2D lattice is the last): so
 * many places that no bond wraps around. */
static void set_axis (fft_box *b, int k, const size_t *n, const size_t *reach)
{
    const int dim = b->dim, from = k == 0 ? 0 : dim == 3 ? k : dim == 2 && k == 2 ? 1 : -1;
    b->n[k] = from < 0 ? 1 : n[from];
    b->T[k] = from < 0 ? 1 : pg_fft_size (b->n[k] + reach[from], k == 0);
}

/* Makes the plans, timed ones from the file of wisdom if it has all of them. The planner's wisdom belongs to
 * the process: that of other users is put back afterwards. Returns whether there are plans. */
static int find_plans (fft_box *b, double *x, double *y, int measure)
{
    char path[4096];
    copy theirs = { NULL, 0, 0 };
    pthread_mutex_lock (&planner);
    fftw_export_wisdom (add_letter, &theirs);
    fftw_forget_wisdom ();
    if (measure && wisdom_path (path, sizeof path, 0)) fftw_import_wisdom_from_filename (path);
    int made = measure && make_plans (b, x, y, FFTW_MEASURE | FFTW_WISDOM_ONLY);
    if (!made) {
        clear_plans (b);
        made = make_plans (b, x, y, measure ? FFTW_MEASURE : FFTW_ESTIMATE);
        if (made && measure) keep_wisdom ();
    }
    if (!made) clear_plans (b);
    fftw_forget_wisdom ();
    if (theirs.text) fftw_import_wisdom_from_string (theirs.text);
    pg_free (theirs.text);
    pthread_mutex_unlock (&planner);
    return made;
}

/* Makes sizes and plans. Results of measured plans may differ from machine to machine and run to run in last
 * bits; those of guessed ones do not, so that short runs and tests repeat exactly. */
pg_status pg_fft_box_create (fft_box *out, int dim, const size_t *n, const size_t *reach, int measure)
{
    pg_status status = PG_OK;
    fft_box *b = out;
    double *workspace = NULL;
    size_t most = 0;
    *b = (fft_box) { .dim = dim, .measured = measure };
    for (int k = 0; k < 3; k++) {
        set_axis (b, k, n, reach);
        if (b->T[k] > 1u << 26)
            PG_FAIL (PG_E_LIMIT, "transforms of %zu places are too long; try evaluation: stencil", b->T[k]);
        most = b->T[k] > most ? b->T[k] : most;
    }
    b->C = (b->T[0] / 2 + 1 + FFT_WIDE - 1) / FFT_WIDE * FFT_WIDE;
    PG_ALLOC (workspace, 4 * FFT_WIDE * (most + 8));
    double *x = (double *) (((uintptr_t) workspace + 63) / 64 * 64), *y = x + 2 * FFT_WIDE * (most + 2);
    if (!find_plans (b, x, y, measure)) PG_FAIL (PG_E_MEMORY, "no memory for the plan of a transform");
done:
    pg_free (workspace);
    return status;
}

void pg_fft_box_clear (fft_box *box)
{
    pthread_mutex_lock (&planner);
    clear_plans (box);
    pthread_mutex_unlock (&planner);
}

/* Guessed plans of a whole box, for state_fft.c and for kernels. */
fftw_plan pg_fft_plan_box (const int *T, double *x)
{
    pthread_mutex_lock (&planner);
    fftw_plan plan = fftw_plan_dft_r2c (3, T, x, (fftw_complex *) x, FFTW_ESTIMATE);
    pthread_mutex_unlock (&planner);
    return plan;
}

fftw_plan pg_fft_plan_box_back (const int *T, double *x)
{
    pthread_mutex_lock (&planner);
    fftw_plan plan = fftw_plan_dft_c2r (3, T, (fftw_complex *) x, x, FFTW_ESTIMATE);
    pthread_mutex_unlock (&planner);
    return plan;
}

void pg_fft_plan_free (fftw_plan plan)
{
    pthread_mutex_lock (&planner);
    fftw_destroy_plan (plan);
    pthread_mutex_unlock (&planner);
}

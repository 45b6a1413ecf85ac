/* SPDX-License-Identifier: GPL-3.0-or-later
 * fronts: stress intensity factors along fronts in space against closed forms.
 *
 *     build/release/bench/fronts [show] [CASE...]
 *
 * prints one line of comma-separated values for each case. show: all vertices as well. */
#include "front_scenes.h"

#define BASE .nu = 0.3, .unit = 1, .method = "horizon: 2.01 spacing"
#define ALONG                                                                                              \
    {                                                                                                      \
        1, 0, 0, 0, 1, 0, 0, 0, 1                                                                          \
    }
/* turned by 20 degrees about x and 15 about y; by 30 about z */
#define TURNED                                                                                             \
    {                                                                                                      \
        0.9659, 0, -0.2588, 0.0885, 0.9397, 0.3304, 0.2432, -0.3420, 0.9077                                \
    }
#define ABOUT_Z                                                                                            \
    {                                                                                                      \
        0.8660254038, 0.5, 0, -0.5, 0.8660254038, 0, 0, 0, 1                                               \
    }
#define SHIFT                                                                                              \
    {                                                                                                      \
        0.37, 0.21, 0.3                                                                                    \
    }
typedef struct {
    const char *name;
    front_case c;
} row;
static row rows[] = {
    { "penny5", { .kind = "penny", .a = 5, .p = 1, .axes = ALONG, .shift = SHIFT, BASE } },
    { "penny5-turned", { .kind = "penny", .a = 5, .p = 1, .axes = TURNED, .shift = SHIFT, BASE } },
    { "penny5-perturbed",
      { .kind = "penny", .a = 5, .p = 1, .axes = ALONG, .shift = SHIFT, .perturb = 0.2, BASE } },
    { "penny8", { .kind = "penny", .a = 8, .p = 1, .axes = ALONG, .shift = SHIFT, BASE } },
    { "penny8-turned", { .kind = "penny", .a = 8, .p = 1, .axes = TURNED, .shift = SHIFT, BASE } },
    { "penny8-perturbed",
      { .kind = "penny", .a = 8, .p = 1, .axes = ALONG, .shift = SHIFT, .perturb = 0.2, BASE } },
    { "inclined5-turned",
      { .kind = "penny", .a = 5, .p = 0.5, .tau = 0.5, .axes = TURNED, .shift = SHIFT, BASE } },
    { "inclined8", { .kind = "penny", .a = 8, .p = 0.5, .tau = 0.5, .axes = ALONG, .shift = SHIFT, BASE } },
    { "inclined8-turned",
      { .kind = "penny", .a = 8, .p = 0.5, .tau = 0.5, .axes = TURNED, .shift = SHIFT, BASE } },
    { "inclined8-perturbed",
      { .kind = "penny",
        .a = 8,
        .p = 0.5,
        .tau = 0.5,
        .axes = ALONG,
        .shift = SHIFT,
        .perturb = 0.2,
        BASE } },
    { "straight", { .kind = "straight", .a = 10.5, .p = 1, .axes = ALONG, .shift = SHIFT, BASE } },
    { "straight-turned", { .kind = "straight", .a = 10.5, .p = 1, .axes = TURNED, .shift = SHIFT, BASE } },
    { "straight-perturbed",
      { .kind = "straight", .a = 10.5, .p = 1, .axes = ALONG, .shift = SHIFT, .perturb = 0.2, BASE } },
    { "surface4", { .kind = "surface", .a = 4, .c = 5, .p = 1, .axes = ALONG, .shift = SHIFT, BASE } },
    { "surface6", { .kind = "surface", .a = 6, .c = 8, .p = 1, .axes = ALONG, .shift = SHIFT, BASE } },
    { "surface6-turned",
      { .kind = "surface", .a = 6, .c = 8, .p = 1, .axes = ABOUT_Z, .shift = SHIFT, BASE } },
    { "surface6-perturbed",
      { .kind = "surface", .a = 6, .c = 8, .p = 1, .axes = ALONG, .shift = SHIFT, .perturb = 0.2, BASE } },
};

static void show (const front_result *r, double nu)
{
    double size = sqrt (r->J / (1 - nu * nu));
    for (size_t i = 0; i < r->n; i++) {
        const pg_tip_field *f = &r->field[i];
        const double *K = r->K[i];
        double J = (1 - nu * nu) * (K[0] * K[0] + K[1] * K[1]) + (1 + nu) * K[2] * K[2];
        printf ("# %3zu %7.2f  J %.4f (near %.4f)  K %+.4f %+.4f %+.4f wide %+.4f %+.4f %+.4f right %+.4f "
                "%+.4f %+.4f "
                "near %.2f wide %.2f%s\n",
                i, r->angle[i] * 180 / acos (-1), f->J[0][0] / J, f->J_near[0][0] / J, f->K[0][0] / size,
                f->K[1][0] / size, f->K[2][0] / size, f->K_wide[0][0] / size, f->K_wide[1][0] / size,
                f->K_wide[2][0] / size, K[0] / size, K[1] / size, K[2] / size, f->near / f->h,
                f->wide / f->h, f->extrapolated ? " *" : "");
    }
}

/* Of all vertices but `margin` at either end: mean and standard deviation of J over what is right; root of
 * the mean square error of K, of the largest. */
static void print (const char *name, const front_result *r, double nu, size_t margin)
{
    double mean = 0, square = 0, error[2][3] = { { 0 } }, size = sqrt (r->J / (1 - nu * nu));
    size_t n = 0;
    for (size_t i = margin; i + margin < r->n; i++) {
        const double *K = r->K[i];
        double J = (1 - nu * nu) * (K[0] * K[0] + K[1] * K[1]) + (1 + nu) * K[2] * K[2],
               share = r->field[i].J[0][0] / J;
        if (isnan (share) || r->field[i].extrapolated) continue;
        mean += share, square += share * share, n++;
        for (int k = 0; k < 3; k++)
            error[0][k] += pow ((r->field[i].K[k][0] - K[k]) / size, 2),
                error[1][k] += pow ((r->field[i].K_wide[k][0] - K[k]) / size, 2);
    }
    mean /= (double)n, square = sqrt (fmax (0, square / (double)n - mean * mean));
    printf ("%s,%zu,%zu,%.4f,%.4f", name, r->points, r->n, mean, square);
    for (int w = 0; w < 2; w++)
        for (int k = 0; k < 3; k++) printf (",%.4f", sqrt (error[w][k] / (double)n));
    printf (",%.2f,%.2f\n", r->solve, r->measure);
    fflush (stdout);
}

int main (int argc, char **argv)
{
    int all = argc > 1 && strcmp (argv[1], "show") == 0, first = all ? 2 : 1;
    printf ("case,points,vertices,J,scatter,K_I,K_II,K_III,wide K_I,wide K_II,wide K_III,solve_s,"
            "measure_s\n");
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        int wanted = argc <= first;
        for (int i = first; i < argc; i++) wanted |= strcmp (argv[i], rows[k].name) == 0;
        if (!wanted) continue;
        front_result r;
        if (front_solve (&rows[k].c, &r) != PG_OK) {
            fprintf (stderr, "%s: %s\n", rows[k].name, pg_last_error ());
            return 1;
        }
        if (all) show (&r, rows[k].c.nu);
        /* the ends of straight fronts lie on faces that are held: half of their hats is missing */
        print (rows[k].name, &r, rows[k].c.nu, strcmp (rows[k].c.kind, "straight") == 0 ? 5 : 0);
        front_result_clear (&r);
    }
    return 0;
}

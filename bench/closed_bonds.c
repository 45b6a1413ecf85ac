/* SPDX-License-Identifier: GPL-3.0-or-later
 * closed_bonds: inclined cracks whose faces touch in plates of bonds (force: bond), beside the same plate by
 * shape functions.
 *
 *     build/release/bench/closed_bonds [SPACINGS]
 *
 * prints the rows of the table of doc/method.md, over four lattices: pressure over the uniform one; slip of
 * the middle piece over that of the Galerkin form in the same plate, as it is and divided by 1 + m h / 2 a,
 * as bonds cut along a line act as a crack that is longer by half a horizon at either end; the same of a
 * crack that is no crack of the scene: its bonds are broken, and where its faces are is told by them.
 * SPACINGS: to the half length, 15 without it. The plate is three times as wide as the crack is long, under
 * uniform compression. */
#include "perigal.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LATTICES = 4 };
static const struct { double shift[2], perturb; } lattice[LATTICES] = { { { 0.13, 0.21 }, 0 },
                                                                        { { 0.37, 0.45 }, 0 },
                                                                        { { 0.5, 0.5 }, 0 },
                                                                        { { 0.13, 0.21 }, 0.2 } };
static const struct { double degrees, friction; } row[] = { { 30, 0 }, { 30, 0.3 }, { 45, 0 },
                                                            { 45, 0.3 }, { 60, 0.3 }, { 60, 0.6 } };
/* The same plate by shape functions, by bonds that a crack of the scene cuts, by bonds that broke. */
enum { GALERKIN, CUT, BROKEN, WAYS };

typedef struct {
    pg_scene *scene;
    pg_problem *problem;
    pg_solver *solver;
    pg_state *state;
} plate;

static void clear (plate *p)
{
    pg_state_free (&p->state), pg_solver_free (&p->solver), pg_problem_free (&p->problem);
    pg_scene_free (&p->scene);
}

static pg_status make (plate *p, int way, double degrees, double friction, size_t l, int n)
{
    pg_status status = PG_OK;
    pg_solver_options options;
    char text[4000], contact[80] = "{kind: normal}", crack[300];
    double b = degrees * acos (-1) / 180, h = 1.0 / n, x = sin (b), y = cos (b), edge = 3 - 1.01 * h;
    const char *penalty = way == GALERKIN ? "essential: penalty, " : "";
    if (friction > 0) snprintf (contact, sizeof contact, "{kind: friction, coefficient: %g}", friction);
    snprintf (crack, sizeof crack, "cracks: [{from: [%.17g, %.17g], to: [%.17g, %.17g]}]\n",
              -x + lattice[l].shift[0] * h, -y + lattice[l].shift[1] * h, x + lattice[l].shift[0] * h,
              y + lattice[l].shift[1] * h);
    snprintf (text, sizeof text,
              "dimension: 2\nplane: stress\nthickness: 1\n"
              "body: [{add: {box: {low: [-3, -3], high: [3, 3]}}}]\n"
              "spacing: %.17g\nlattice: cells\nperturb: {amount: %g}\n%s"
              "materials: {m: {youngs_modulus: 1000, poissons_ratio: 0.3333333333333333}}\n"
              "method: {force: %s}\n%scontact: %s\n"
              "sets: {a: {where: \"x < %.17g and y < %.17g\"}, b: {where: \"x > %.17g and y < %.17g\"}}\n"
              "boundary:\n  - {name: t, set: top, traction: {y: -1}}\n"
              "  - {name: d, set: bottom, traction: {y: 1}}\n"
              "  - {name: a, set: a, %sdisplacement: {x: 0, y: 0}}\n"
              "  - {name: b, set: b, %sdisplacement: {y: 0}}\n"
              "solver: {kind: static, stepping: fixed, steps: 2}\noutput: {at: {levels: 1}}\n",
              h, lattice[l].perturb, way == BROKEN ? "" : crack, way == GALERKIN ? "galerkin" : "bond",
              way == BROKEN ? "failure: {criterion: stretch, critical_stretch: 1}\n" : "", contact, -edge,
              -edge, edge, -edge, penalty, penalty);
    PG_TRY (pg_scene_parse (&p->scene, text, "closed_bonds.yaml"));
    PG_TRY (pg_problem_build (&p->problem, p->scene, 1));
    PG_TRY (pg_solver_options_read (&options, p->problem, p->scene));
    PG_TRY (pg_solver_create (&p->solver, p->problem, &options));
    PG_TRY (pg_state_create (&p->state, p->problem, pg_solver_components (p->solver)));
done:
    return status;
}

/* Mean pressure of pieces within .7 of the half length, and the slip of the piece nearest to the middle. */
static void measure (const plate *p, const double *middle, double *pressure, double *slip)
{
    size_t n, count = 0;
    const pg_contact_values *v = pg_solver_contact (p->solver, &n);
    double least = INFINITY;
    *pressure = *slip = 0;
    for (size_t k = 0; k < n; k++) {
        double away = hypot (v[k].x[0] - middle[0], v[k].x[1] - middle[1]);
        if (away < 0.7) *pressure += v[k].pressure, count++;
        if (away < least) least = away, *slip = fabs (v[k].slip[0]);
    }
    if (count) *pressure /= (double) count;
}

static pg_status run (size_t r, size_t l, int n, double pressure[WAYS], double slip[WAYS])
{
    pg_status status = PG_OK;
    plate p[WAYS];
    const double middle[2] = { lattice[l].shift[0] / n, lattice[l].shift[1] / n };
    memset (p, 0, sizeof p);
    for (int way = 0; way < WAYS; way++) {
        pg_step step = { 0 };
        PG_TRY (make (&p[way], way, row[r].degrees, row[r].friction, l, n));
        if (way == BROKEN) memcpy (p[way].state->alive, p[CUT].state->alive, p[way].state->nbond);
        while (!pg_solver_done (p[way].solver, p[way].state))
            PG_TRY (pg_solver_step (p[way].solver, p[way].state, &step));
        measure (&p[way], middle, &pressure[way], &slip[way]);
        pressure[way] /= pow (sin (row[r].degrees * acos (-1) / 180), 2);
    }
done:
    for (int way = 0; way < WAYS; way++) clear (&p[way]);
    return status;
}

typedef struct { double least, most, sum; int n; } range;
static void widen (range *r, double value)
{
    r->least = r->n ? fmin (r->least, value) : value, r->most = r->n ? fmax (r->most, value) : value;
    r->sum += value, r->n++;
}

static void show (const range *r, double by)
{
    printf (" %.3f - %.3f, mean %.3f |", r->least / by, r->most / by, r->sum / r->n / by);
}

int main (int argc, char **argv)
{
    pg_status status = PG_OK;
    int n = argc > 1 ? atoi (argv[1]) : 15;
    double longer = 1 + 1.5 / n, free_slip = 1;
    printf ("| inclination to the load | friction | pressure | slip, as it is | at the same length | "
            "bonds broken one by one: pressure | slip over that of the crack |\n"
            "|---|---|---|---|---|---|---|\n");
    for (size_t r = 0; r < sizeof row / sizeof *row; r++) {
        range pressure = { 0 }, slip = { 0 }, broken = { 0 }, other = { 0 };
        int sticks = row[r].friction > 1 / tan (row[r].degrees * acos (-1) / 180);
        for (size_t l = 0; l < LATTICES; l++) {
            double p[WAYS], s[WAYS];
            PG_TRY (run (r, l, n, p, s));
            if (r == 2) free_slip = fmin (free_slip, s[GALERKIN]);
            widen (&pressure, p[CUT]), widen (&broken, p[BROKEN]);
            widen (&slip, sticks ? s[CUT] / free_slip : s[CUT] / s[GALERKIN]);
            widen (&other, sticks ? s[BROKEN] / free_slip : s[BROKEN] / s[CUT]);
        }
        printf ("| %g | %g |", row[r].degrees, row[r].friction);
        show (&pressure, 1);
        if (sticks) printf (" %.3f of the free slip at most | |", slip.most);
        else show (&slip, 1), show (&slip, longer);
        show (&broken, 1);
        if (sticks) printf (" %.3f of the free slip at most |\n", other.most);
        else show (&other, 1), printf ("\n");
        fflush (stdout);
    }
done:
    if (status != PG_OK) fprintf (stderr, "closed_bonds: %s\n", pg_last_error ());
    return status != PG_OK;
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * wing_cracks: wings that grow from a closed crack in compression against displacement discontinuities on
 * the same path in the same plate (displacement_discontinuity.h).
 *
 *     build/release/bench/wing_cracks [show] [ANGLE FRICTION CONFINEMENT LATTICE [SPACINGS [EVENTS]]]
 *
 * A square of six half lengths c bears uniform tractions on its outline: 1 along the load, the confinement
 * across it, both growing together; the crack is inclined by ANGLE degrees to the load (without arguments:
 * 30, 45, 60; friction 0, 0.3; confinement 0, 0.05; three lattices: shifted, moved by up to .2, turned by 20
 * degrees; 15 spacings to the half length, 12 events). One line of comma-separated values for each case:
 * first load over sqrt (3) / 2 K_c / K_II of the reference; kinks of both wings, degrees; K_I of tips over
 * the reference at the same load, mean, least, largest of those whose K_I is no less than a tenth of
 * (compression) sqrt (pi c), and how many they are; largest turn between facets after the second, degrees;
 * steps at which the load fell by more than 1 %; dissipated energy, friction deducted, over G0 x area;
 * length of wings over c; processor seconds of an event. show: every event as well. */
#include "perigal.h"
#include "displacement_discontinuity.h"
#include <stdio.h>
#include <time.h>

/* Elements: of a facet of one spacing, the crack, a side of the plate, at the coarser of two subdivisions.
 * Towards the kinks at the ends of the crack elements become smaller by and by (the crack by a cosine, the
 * first facets by a square): with equal ones, 2.25 times as long on the crack as on the facets, K at 30
 * degrees still rose by 1.5 % from subdivision to subdivision, and was 4 % too small where it was taken. */
enum { MOST = 64, PER_FACET = 3, MAIN = 60, SIDE = 12, LATTICES = 3 };
/* What is left of the error falls by so much at every doubling (0.61 by subdivisions 1, 2 and 4). */
static const double FALLS = 0.61;
/* Toughness over the full load, which no event should reach; E is 1000. */
static const double K_c = 0.05;
static const char *const lattice_names[LATTICES] = { "shifted", "moved", "turned" };
typedef struct { double degrees, friction, confinement; int lattice, n, events; } wing_case;
/* Places of one end: its tip, and where it has come at each event. */
typedef struct { double x[MOST][2]; int n; } wing;

/* Stress xx, yy, xy of the plate: compression 1 along a direction, the confinement across it. */
static void stress_of (const wing_case *c, double out[3])
{
    double turn = c->lattice == 2 ? 0.34906585 : 0, along = acos (-1) / 2 + turn, C = cos (along),
           S = sin (along), q = c->confinement;
    out[0] = -C * C - q * S * S, out[1] = -S * S - q * C * C, out[2] = -(1 - q) * C * S;
}

static void ends_of (const wing_case *c, double x[2][2])
{
    double turn = c->lattice == 2 ? 0.34906585 : 0, angle = acos (-1) * (0.5 - c->degrees / 180) + turn,
           h = 1.0 / c->n, shift[2] = { c->lattice ? 0 : 0.37 * h, c->lattice ? 0 : 0.21 * h };
    for (int k = 0; k < 2; k++)
        x[k][0] = shift[0] + (2 * k - 1) * cos (angle), x[k][1] = shift[1] + (2 * k - 1) * sin (angle);
}

static void text_of (const wing_case *c, char *text, size_t size)
{
    double s[3], x[2][2], h = 1.0 / c->n;
    stress_of (c, s), ends_of (c, x);
    snprintf (text, size,
              "dimension: 2\nplane: stress\nthickness: 1\n"
              "body: [{add: {box: {low: [-3, -3], high: [3, 3]}}}]\n"
              "spacing: %.17g\nlattice: cells\nperturb: {amount: %g}\n"
              "cracks: [{from: [%.17g, %.17g], to: [%.17g, %.17g]}]\n"
              "materials: {m: {youngs_modulus: 1000, poissons_ratio: 0.25}}\n"
              "contact: {kind: %s%.17g}\n"
              "sets: {a: {where: \"x < %.17g and y < %.17g\"}, b: {where: \"x > %.17g and y < %.17g\"}}\n"
              "boundary:\n  - {set: right, traction: {x: %.17g, y: %.17g}}\n"
              "  - {set: left, traction: {x: %.17g, y: %.17g}}\n"
              "  - {set: top, traction: {x: %.17g, y: %.17g}}\n"
              "  - {set: bottom, traction: {x: %.17g, y: %.17g}}\n"
              "  - {set: a, essential: penalty, displacement: {x: 0, y: 0}}\n"
              "  - {set: b, essential: penalty, displacement: {y: 0}}\n"
              "failure: {criterion: energy_release, fracture_energy: %.17g}\n"
              "solver: {kind: static, stepping: event, max_events: %d}\noutput: {at: {levels: 1}}\n",
              h, c->lattice == 1 ? 0.2 : 0.0, x[0][0], x[0][1], x[1][0], x[1][1],
              c->friction > 0 ? "friction, coefficient: " : "normal} #", c->friction, -3 + h, -3 + h, 3 - h,
              -3 + h, s[0], s[2], -s[0], -s[2], s[2], s[1], -s[2], -s[1], K_c * K_c / 1000, c->events);
}

/* How many elements the crack (leg 0) or a facet has, about alike in length where they do not get smaller. */
static int parts_of (const wing_case *c, int fine, int leg, double length)
{
    double spacings = fmin (2, fmax (1, round (length * c->n)));
    return fine * (leg == 0 ? MAIN : (leg == 1 || leg == -1 ? 2 : 1) * PER_FACET * (int) spacings);
}

/* Where the share u of the elements of a leg ends; those of the crack are alike at an end without a wing,
 * whose K is that of equal elements. */
static double place_of (const wing w[2], int leg, double u)
{
    double pi = acos (-1);
    if (leg == 0 && w[0].n > 1) return w[1].n > 1 ? 0.5 * (1 - cos (pi * u)) : 1 - cos (0.5 * pi * u);
    if (leg == 0) return w[1].n > 1 ? sin (0.5 * pi * u) : u;
    return leg == 1 ? u * u : leg == -1 ? 1 - (1 - u) * (1 - u) : u;
}

/* Elements of the path and the outline, `fine` times as many; K of unit load at the tips, mean slip of the
 * crack. */
static int reference_of (const wing_case *c, const wing w[2], int fine, double K[2][2], double *slip)
{
    size_t n = 0, side = (size_t) fine * SIDE,
           most = 4 * side + (size_t) fine * (MAIN + 4 * PER_FACET * (w[0].n + w[1].n)), first = 0;
    dd_element *e = calloc (most, sizeof *e);
    static const double corner[5][2] = { { -3, -3 }, { 3, -3 }, { 3, 3 }, { -3, 3 }, { -3, -3 } };
    double s[3];
    int sound = e != NULL;
    stress_of (c, s);
    for (size_t i = 0; sound && i < 4 * side; i++, n++)
        for (int m = 0; m < 2; m++) {
            const double *from = corner[i / side], *to = corner[i / side + 1];
            double step = (to[m] - from[m]) / (double) side;
            e[n].a[m] = from[m] + (double) (i % side) * step;
            e[n].b[m] = from[m] + (double) (i % side + 1) * step;
            e[n].outline = 1;
        }
    /* from the tip of end 0 to that of end 1 */
    for (int leg = 1 - w[0].n; sound && leg <= w[1].n - 1; leg++) {
        const double *a = leg <= 0 ? w[0].x[-leg] : w[1].x[leg - 1],
                     *b = leg < 0 ? w[0].x[-leg - 1] : w[1].x[leg];
        int parts = parts_of (c, fine, leg, hypot (b[0] - a[0], b[1] - a[1]));
        if (leg == 0) first = n;
        for (int i = 0; i < parts; i++, n++) {
            double t[2], p[2], at[2], from = place_of (w, leg, (double) i / parts),
                   to = place_of (w, leg, (double) (i + 1) / parts);
            for (int m = 0; m < 2; m++)
                e[n].a[m] = a[m] + from * (b[m] - a[m]), e[n].b[m] = a[m] + to * (b[m] - a[m]);
            dd_frame (&e[n], t, at), dd_traction (t, s, p);
            e[n].open = leg != 0, e[n].sign = p[1] < 0 ? -1 : 1;
        }
    }
    sound = sound && dd_solve (e, n, s, c->friction);
    if (sound) {
        dd_intensity (&e[4 * side], -1, K[0]), dd_intensity (&e[n - 1], 1, K[1]);
        /* end 0 looks the other way: what slips forward there slips forward here */
        K[0][1] = -K[0][1], *slip = 0;
        for (size_t i = first; i < first + (size_t) (fine * MAIN); i++)
            *slip += e[i].slip * hypot (e[i].b[0] - e[i].a[0], e[i].b[1] - e[i].a[1]) / 2 / 1000;
    }
    free (e);
    return sound;
}

/* Extrapolated from two subdivisions. */
static int reference (const wing_case *c, const wing w[2], double K[2][2], double *slip)
{
    double coarse[2][2], rough;
    if (!reference_of (c, w, 1, coarse, &rough) || !reference_of (c, w, 2, K, slip)) return 0;
    double more = FALLS / (1 - FALLS);
    for (int k = 0; k < 4; k++) K[k / 2][k % 2] += more * (K[k / 2][k % 2] - coarse[k / 2][k % 2]);
    *slip += more * (*slip - rough);
    return 1;
}

/* ---- a run --------------------------------------------------------------------------------------------- */
typedef struct {
    double first, kink[2], sum, least, most, turn, before;
    int    n, falls;
} tally;

static double angle_of (const double *a, const double *b) { return atan2 (b[1] - a[1], b[0] - a[0]); }

static double turn_between (double from, double to)
{
    const double pi = acos (-1);
    double turn = fmod (to - from + 5 * pi, 2 * pi) - pi;
    return turn * 180 / pi;
}

/* What one event shows: the path is that before it. */
static int look (const wing_case *c, const wing w[2], const pg_solver *solver, const pg_state *state,
                 double factor, int event, tally *t, int show)
{
    double K[2][2], unit = sqrt (acos (-1)), slip, mean = 0, length = 0;
    size_t n;
    const pg_contact_values *p = pg_solver_contact (solver, &n);
    if (!reference (c, w, K, &slip)) {
        fprintf (stderr, "wing_cracks: the reference does not settle at event %d\n", event);
        return 0;
    }
    for (int k = 0; k < 2; k++) {
        const pg_tip_values *v = pg_solver_tip (solver, state->paths->tip[k].id);
        double share = v->K[0] / (factor * K[k][0]);
        if (event == 1)
            t->first = fmax (t->first, factor / (sqrt (3) / 2 * K_c / fmax (fabs (K[0][1]), fabs (K[1][1]))));
        else if (K[k][0] >= 0.1 * unit) {
            t->least = t->n ? fmin (t->least, share) : share, t->most = t->n ? fmax (t->most, share) : share;
            t->sum += share, t->n++;
        }
        if (show)
            printf ("# event %2d, end %d at (%.3f, %.3f): load %.4f; at unit load K_I %.4f of %.4f (%.3f), "
                    "K_II %.4f of %.4f\n",
                    event, k, v->x[0], v->x[1], factor * unit / K_c, v->K[0] / factor / unit, K[k][0] / unit,
                    share, v->K[1] / factor / unit, K[k][1] / unit);
    }
    for (size_t i = 0; i < n; i++) {
        double e[2] = { w[1].x[0][0] - w[0].x[0][0], w[1].x[0][1] - w[0].x[0][1] },
               d[2] = { p[i].x[0] - w[0].x[0][0], p[i].x[1] - w[0].x[0][1] };
        double along = (e[0] * d[0] + e[1] * d[1]) / (e[0] * e[0] + e[1] * e[1]);
        if (fabs (e[0] * d[1] - e[1] * d[0]) < 1e-3 / c->n && along > 0 && along < 1)
            mean += p[i].slip[0] * p[i].length, length += p[i].length;
    }
    if (show)
        printf ("# mean slip of the crack %.5g of %.5g (%.3f)\n", mean / length / factor, slip,
                mean / length / factor / slip);
    return 1;
}

static void follow (wing *w, const double *x, int end, double crack, tally *t)
{
    const double *before = w->x[w->n - 1];
    if (hypot (x[0] - before[0], x[1] - before[1]) < 1e-9 || w->n == MOST) return;
    double to = angle_of (before, x);
    if (w->n == 1) t->kink[end] = turn_between (crack, to);
    if (w->n > 3) t->turn = fmax (t->turn, fabs (turn_between (angle_of (w->x[w->n - 2], before), to)));
    w->x[w->n][0] = x[0], w->x[w->n][1] = x[1], w->n++;
}

static pg_status run_case (const wing_case *c, int show)
{
    pg_status status = PG_OK;
    char text[4000];
    pg_scene *scene = NULL;
    pg_problem *problem = NULL;
    pg_solver *solver = NULL;
    pg_state *state = NULL;
    pg_solver_options options;
    pg_step step = { 0 };
    wing w[2] = { { .n = 1 }, { .n = 1 } };
    tally t = { 0 };
    double seconds = 0, crack[2], ends[2][2];
    int event = 0;
    text_of (c, text, sizeof text);
    PG_TRY (pg_scene_parse (&scene, text, "wings.yaml"));
    PG_TRY (pg_problem_build (&problem, scene, 1));
    PG_TRY (pg_solver_options_read (&options, problem, scene));
    PG_TRY (pg_solver_create (&solver, problem, &options));
    PG_TRY (pg_state_create (&state, problem, pg_solver_components (solver)));
    ends_of (c, ends);
    /* tip 0 is one of the ends */
    for (int k = 0; k < 2; k++) memcpy (w[k].x[0], state->paths->tip[k].x, sizeof w[k].x[0]);
    crack[1] = angle_of (w[0].x[0], w[1].x[0]), crack[0] = angle_of (w[1].x[0], w[0].x[0]);
    while (!pg_solver_done (solver, state)) {
        clock_t begun = clock ();
        PG_TRY (pg_solver_step (solver, state, &step));
        seconds += (double) (clock () - begun) / CLOCKS_PER_SEC;
        if (!step.event) continue;
        event++;
        if (!look (c, w, solver, state, step.factor, event, &t, show))
            PG_FAIL (PG_E_EQUILIBRIUM, "no reference");
        for (int k = 0; k < 2; k++) follow (&w[k], state->paths->tip[k].x, k, crack[k], &t);
        t.falls += step.factor < 0.99 * t.before, t.before = step.factor;
    }
    const pg_statistics *r = pg_solver_report_now (solver);
    printf ("%g,%g,%g,%s,%d,%.4f,%.2f,%.2f,%.4f,%.4f,%.4f,%d,%.1f,%d,%.4f,%.2f,%.2f\n", c->degrees,
            c->friction, c->confinement, lattice_names[c->lattice], event, t.first, t.kink[0], t.kink[1],
            t.n ? t.sum / t.n : NAN, t.least, t.most, t.n, t.turn, t.falls,
            r->energy.dissipated / r->energy.fracture,
            fmax (state->paths->tip[0].grown, state->paths->tip[1].grown), seconds / event);
    fflush (stdout);
done:
    pg_state_free (&state), pg_solver_free (&solver), pg_problem_free (&problem), pg_scene_free (&scene);
    return status;
}

int main (int argc, char **argv)
{
    static const double degrees[] = { 30, 45, 60 }, friction[] = { 0, 0.3 }, confinement[] = { 0, 0.05 };
    pg_status status = PG_OK;
    int show = argc > 1 && strcmp (argv[1], "show") == 0, at = show ? 2 : 1;
    printf ("degrees,friction,confinement,lattice,events,first,kink,other,K,least,most,compared,turn,falls,"
            "energy,grown,event_s\n");
    if (argc >= at + 4) {
        wing_case c = { atof (argv[at]), atof (argv[at + 1]), atof (argv[at + 2]), atoi (argv[at + 3]),
                        argc > at + 4 ? atoi (argv[at + 4]) : 15, argc > at + 5 ? atoi (argv[at + 5]) : 12 };
        PG_TRY (run_case (&c, show));
        goto done;
    }
    for (int i = 0; i < 12 * LATTICES; i++) {
        wing_case c = { degrees[i / 12], friction[i / 6 % 2], confinement[i / 3 % 2], i % 3, 15, 12 };
        PG_TRY (run_case (&c, show));
    }
done:
    if (status != PG_OK) fprintf (stderr, "wing_cracks: %s\n", pg_last_error ());
    return status != PG_OK;
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * A closed penny that slides under compression grows wings in space: the load and the direction of the first,
 * mirrors, rotations, checkpoints, energies; and loads with a constant part, without friction. */
#include "contact/pieces.h"
#include "scene_runs/run.h"
#include "solve/tape.h"

static const double PI = 3.14159265358979323846, E = 1000, NU = 0.25, G0 = 1e-4;

/* A disc of `radius` in a box of half width w, spacing 1, its normal at 45 degrees to the load along z: in
 * the plane of x and z, mirrored in x, or turned about z. */
typedef struct {
    double radius, friction, energy, constant;         /* constant: pressure all around from the start, Pa */
    double pull;                                       /* tension along z from the start, Pa */
    double load;                                       /* compression along z at load factor 1; 0: 1 Pa */
    int    proportional;                               /* 1: nothing is constant, all grows together */
    double w;
    int    mirrored, turned, events, levels;
    const char *solver;
} penny;

static const double shift[3] = { 0.2, 0.1, 0.3 };

/* A place or direction of the plain scene in that of l. */
static void turn (const penny *l, double x, double y, double z, double *out)
{
    double sx = l->mirrored ? -x : x;
    out[0] = l->turned ? -y : sx, out[1] = l->turned ? sx : y, out[2] = z;
}

static void steady (const penny *l, char *text, size_t size)
{
    static const char *const set[6] = { "left", "right", "bottom", "top", "back", "front" };
    int at = 0;
    text[0] = 0;
    for (int k = 0; (l->constant != 0 || l->pull != 0) && k < 6; k++) {
        double s = l->constant - (k > 3 ? l->pull : 0);
        at += snprintf (text + at, size - (size_t) at,
                        "  - {name: c%d, set: %s, traction: {%c: %.17g}, ramp: %s}\n", k, set[k],
                        "xyz"[k / 2], k % 2 ? -s : s, l->proportional ? "linear" : "constant");
    }
}

static run penny_run (const penny *l)
{
    char text[6000], around[1000];
    double c[3], n[3], p[3][3];
    const char *const names = "abc";
    turn (l, shift[0], shift[1], shift[2], c), turn (l, sqrt (0.5), 0, sqrt (0.5), n);
    for (int k = 0; k < 3; k++)
        turn (l, k == 1 ? l->w - 0.5 : 0.5 - l->w, k == 2 ? l->w - 0.5 : 0.5 - l->w, 0.5 - l->w, p[k]);
    steady (l, around, sizeof around);
    int length = snprintf (text, sizeof text,
        "dimension: 3\nbody: [{add: {box: {low: [%g, %g, %g], high: [%g, %g, %g]}}}]\nspacing: 1\n"
        "lattice: cells\ncracks: [{disc: {center: [%.17g, %.17g, %.17g], normal: [%.17g, %.17g, %.17g], "
        "radius: %.17g}}]\nmaterials: {m: {youngs_modulus: %g, poissons_ratio: %g}}\n"
        "contact: {kind: %s}\nfailure: {criterion: energy_release, fracture_energy: %g}\n"
        "method: {approximation: rkpm, integration: gauss, kernel: cubic_spline, horizon: 2.01 spacing}\n"
        "sets:\n", -l->w, -l->w, -l->w, l->w, l->w, l->w, c[0], c[1], c[2], n[0], n[1], n[2], l->radius, E,
        NU, l->friction > 0 ? "friction, coefficient: 0.3" : "normal", l->energy > 0 ? l->energy : G0);
    for (int k = 0; k < 3; k++)
        length += snprintf (text + length, sizeof text - (size_t) length,
                            "  %c: {where: \"abs(x - %g) < 0.1 and abs(y - %g) < 0.1 and "
                            "abs(z - %g) < 0.1\"}\n", names[k], p[k][0], p[k][1], p[k][2]);
    length += snprintf (text + length, sizeof text - (size_t) length,
        "boundary:\n%s  - {name: head, set: front, traction: {z: %.17g}}\n"
        "  - {name: foot, set: back, traction: {z: %.17g}}\n"
        "  - {name: pa, set: a, essential: penalty, displacement: {x: 0, y: 0, z: 0}}\n"
        "  - {name: pb, set: b, essential: penalty, displacement: {%c: 0, z: 0}}\n"
        "  - {name: pc, set: c, essential: penalty, displacement: {z: 0}}\n"
        "solver: {kind: static, %s, max_events: %d}\noutput: {at: {levels: %d}}\n",
        around, l->load > 0 ? -l->load : -1, l->load > 0 ? l->load : 1, l->turned ? 'x' : 'y',
        l->solver ? l->solver : "stepping: event", l->events,
        l->levels ? l->levels : 1);
    assert_true (length > 0 && length < (int) sizeof text);
    return prepare (1, text);
}

static void to_event (run *r, int events)
{
    while (r->state->events < events && !pg_solver_done (r->solver, r->state)) advance (r);
    assert_int_equal (r->state->events, events);
}

/* Kinks of the front at both ends of the steepest line: the angle between the way from the rim of the disc
 * and its plane, rad, positive towards the load. */
static void end_kinks (const penny *l, const run *r, double kink[2])
{
    size_t nfront;
    const pg_front *front = pg_fronts_of_state (r->problem, r->state, &nfront);
    for (int end = 0; end < 2; end++) {
        double side = end ? -1 : 1, e[3], load[3], c[3], rim[3], least = INFINITY, to[3] = { 0 };
        turn (l, side * sqrt (0.5), 0, -side * sqrt (0.5), e), turn (l, 0, 0, -side, load);
        turn (l, shift[0], shift[1], shift[2], c);
        for (int k = 0; k < 3; k++) rim[k] = c[k] + l->radius * e[k];
        for (size_t f = 0; f < nfront; f++)
            for (size_t i = 0; i < front[f].n; i++) {
                const double *x = front[f].x + 3*i;
                double across[3], far = 0, ahead = 0;
                turn (l, 0, 1, 0, across);
                for (int k = 0; k < 3; k++)
                    far += (x[k] - c[k]) * across[k], ahead += (x[k] - c[k]) * load[k];
                if (!(ahead > 0) || fabs (far) >= least) continue;
                least = fabs (far);
                for (int k = 0; k < 3; k++) to[k] = x[k] - rim[k];
            }
        double along = 0, size = 0;
        for (int k = 0; k < 3; k++) along += to[k] * e[k], size = hypot (size, to[k]);
        kink[end] = acos (along / size);
    }
}

/* Largest K_II of a state whose loads are `factor`, per load factor 1. */
static double largest_II (const run *r)
{
    size_t n;
    const pg_tip_values *f = pg_solver_tips (r->solver, &n);
    double most = 0;
    for (size_t i = 0; i < n; i++) {
        most = fmax (most, fabs (f[i].K[1]));
        assert_true (f[i].K[0] == 0);
    }
    return most / r->state->factor;
}

/* Of a triangle, by small squares of its two edges. */
static double area_in_body (const pg_problem *p, const double *v)
{
    enum { PARTS = 20 };
    double u[3], k[3], size = 0, in = 0;
    for (int m = 0; m < 3; m++) u[m] = v[3 + m] - v[m], k[m] = v[6 + m] - v[m];
    for (int m = 0; m < 3; m++) {
        int i = (m + 1) % 3, j = (m + 2) % 3;
        size = hypot (size, u[i] * k[j] - u[j] * k[i]);
    }
    for (int i = 0; i < PARTS; i++)
        for (int j = 0; i + j < PARTS; j++) {
            double x[3], s = (i + 1.0 / 3) / PARTS, q = (j + 1.0 / 3) / PARTS;
            for (int m = 0; m < 3; m++) x[m] = v[m] + s * u[m] + q * k[m];
            in += pg_problem_has_body (p, x) * (i + j + 1 < PARTS ? 1 : 0.5);
        }
    return size * in / (PARTS * PARTS);
}

/* Pieces of the disc and its wings: each place counts once, and what lies in the disc, or where it stopped
 * behind its front, is not in a piece of a wing. */
static void check_pieces (const penny *l, const run *r)
{
    pg_contact_pieces pieces;
    size_t mixed = 0;
    double area = 0, grown = 0, n[3], c[3];
    turn (l, sqrt (0.5), 0, sqrt (0.5), n), turn (l, shift[0], shift[1], shift[2], c);
    check_ok (pg_contact_pieces_create (&pieces, r->problem, r->state));
    for (size_t k = 0; k < pieces.n; k++) {
        int in = 0, out = 0;
        area += pieces.piece[k].area;
        for (size_t q = pieces.first[k]; q < pieces.first[k + 1]; q++) {
            double same = 0, off = 0, far = 0;
            for (size_t m = 0; m < 3; m++) {
                double to = pieces.x[3*q + m] - c[m];
                same += pieces.normal[3*q + m] * n[m], off += to * n[m], far = hypot (far, to);
            }
            in |= fabs (off) < 1e-6 && far < l->radius, out |= fabs (same) < cos (PG_CONTACT_TURN);
        }
        mixed += in && out;
    }
    const pg_crack_surfaces *w = r->state->surfaces;
    for (size_t t = w->nfirst; t < w->cracks.n; t++)
        grown += area_in_body (r->problem, w->cracks.crack[t].vertex);
    /* the triangles begin so far behind the front that they overlap with what the disc cuts */
    double inner = l->radius - 2 * r->problem->crack.tip_offset - 0.1, whole = PI * inner * inner + grown;
    print_message ("%zu pieces, area %.3f of %.3f, %zu go around the kink\n", pieces.n, area, whole, mixed);
    check_relative (area, whole, 0.03);
    assert_int_equal (mixed, 0);
    pg_contact_pieces_clear (&pieces);
}

/* The disc slides by what friction leaves of the shear: K_II = 4 (tau - mu sigma) sqrt (a / pi) / (2 - nu) at
 * the ends of the steepest line in an infinite body, tau = sigma = 1/2. Wings begin there where sqrt (4/3)
 * K_II reaches the toughness, at 70.53 degrees from the plane of the disc. */
static void wings_begin_by_sliding (void **state)
{
    (void) state;
    penny l = { .radius = longer () ? 4 : 3, .w = longer () ? 8 : 5.5, .friction = 0.3,
                .events = longer () ? 3 : 1 };
    run a = penny_run (&l);
    double K_c = sqrt (E / (1 - NU * NU) * G0), kink[2],
           exact = 4 * (0.5 - 0.3 * 0.5) * sqrt (l.radius / PI) / (2 - NU);
    advance (&a);
    double II = largest_II (&a), first = sqrt (0.75) * K_c / II;
    while (a.state->events == 0) advance (&a);
    end_kinks (&l, &a, kink);
    print_message ("K_II %.4f of the infinite body, load %.4f of that of the first vertex, kinks %.2f %.2f\n",
                   II / exact, a.state->factor / first, kink[0] * 180 / PI, kink[1] * 180 / PI);
    /* the box is 1.8 (2) times as wide as the disc */
    check_relative (II, exact, longer () ? 0.06 : 0.1);
    /* the load of an event is that of all who lead */
    assert_true (a.state->factor > first && a.state->factor < 1.1 * first);
    for (int k = 0; k < 2; k++) check_absolute (kink[k] * 180 / PI, 70.53, 5);
    check_pieces (&l, &a);
    const pg_statistics *s = pg_solver_report_now (a.solver);
    for (;; advance (&a)) {
        double taken = G0 * a.state->surfaces->area;
        if (a.step.event)
            print_message ("event %ld, load %.4f, area %.3f, dissipated less friction %.3f of its\n",
                           a.state->events, a.state->factor, a.state->surfaces->area,
                           s->energy.dissipated / taken);
        /* the first strip is as wide as two thirds (half) of the disc */
        if (a.state->events == 1) check_relative (s->energy.dissipated, taken, longer () ? 0.2 : 0.35);
        if (pg_solver_done (a.solver, a.state)) break;
    }
    assert_true (s->energy.friction > 0);
    check_below (s->contact.overlap, 1e-12);
    clear (&a);
}

/* Turned about the load, mirrored, resumed. PERIGAL_TEST_SIZE=long. */
static void wings_are_those_of_the_image (void **state)
{
    (void) state;
    penny l = { .radius = 3, .w = 6, .friction = 0.3, .events = 1 };
    double kink[2][2];
    if (!longer ()) return;
    run r = penny_run (&l), again = penny_run (&l);
    tape t = { 0 };
    advance (&r);
    keep (&r, &t, 0), keep (&again, &t, 1);
    while (!pg_solver_done (r.solver, r.state)) advance_alike (&r, &again);
    end_kinks (&l, &r, kink[0]);
    for (int k = 0; k < 2; k++) {
        penny m = l;
        m.mirrored = k, m.turned = !k;
        run other = penny_run (&m);
        to_event (&other, 1);
        end_kinks (&m, &other, kink[1]);
        print_message ("%s: load %.6f of %.6f, area %.4f of %.4f, kinks %.3f %.3f of %.3f %.3f\n",
                       k ? "mirrored" : "turned", other.state->factor, r.state->factor,
                       other.state->surfaces->area, r.state->surfaces->area, kink[1][0], kink[1][1],
                       kink[0][0], kink[0][1]);
        check_relative (other.state->factor, r.state->factor, k ? 0.01 : 1e-6);
        check_relative (other.state->surfaces->area, r.state->surfaces->area, k ? 0.05 : 1e-4);
        for (int q = 0; q < 2; q++) check_absolute (kink[1][q], kink[0][q], k ? 0.05 : 1e-3);
        clear (&other);
    }
    clear (&r), clear (&again);
    pg_free (t.byte);
}

/* ---- loads with a constant part ------------------------------------------------------------------------ */
/* Without friction the equilibria of constant loads and a share of others are those of the same loads in
 * proportion: growth begins at the sums of loads at which it begins there. A run that is resumed before it
 * has the same bits. */
static void growth_begins_at_the_sum_of_loads (void **state)
{
    (void) state;
    penny l = { .radius = 2, .w = 4, .events = 1, .constant = 0.1, .load = 1,
                .levels = longer () ? 10 : 5 };
    run affine = penny_run (&l), again = penny_run (&l);
    tape t = { 0 };
    advance (&affine);
    assert_int_equal (affine.state->events, 0);
    keep (&affine, &t, 0), keep (&again, &t, 1);
    while (!pg_solver_done (affine.solver, affine.state)) advance_alike (&affine, &again);
    assert_int_equal (affine.state->events, 1);
    l.load = 1.25 * affine.state->factor, l.constant *= 1.25, l.proportional = 1;
    run plain = penny_run (&l);
    to_event (&plain, 1);
    print_message ("load %.12f beside a pressure, %.12f of both, areas %.9f %.9f\n", affine.state->factor,
                   plain.state->factor, affine.state->surfaces->area, plain.state->surfaces->area);
    check_relative (plain.state->factor, 0.8, 1e-7);
    check_relative (plain.state->surfaces->area, affine.state->surfaces->area, 1e-5);
    clear (&affine), clear (&again), clear (&plain);
    pg_free (t.byte);
}

/* Pulled open first, the disc closes piece by piece; the end is that of one step, and the work balances. A
 * run that is resumed on the way goes on alike. */
static void an_open_disc_closes_by_and_by (void **state)
{
    (void) state;
    penny l = { .radius = 2, .w = 4, .energy = 1e6, .pull = 0.3, .events = 1, .levels = 5 };
    run a = penny_run (&l), b = penny_run (&l);
    l.solver = "stepping: fixed, steps: 1";
    run fixed = penny_run (&l);
    tape t = { 0 };
    to_the_end (&fixed);
    const pg_statistics *s = pg_solver_report_now (a.solver);
    while (s->contact.changes == 0) advance (&a);
    assert_true (a.state->factor > 0.2 && a.state->factor < 1);
    keep (&a, &t, 0), keep (&b, &t, 1);
    while (!pg_solver_done (a.solver, a.state)) advance_alike (&a, &b);
    print_message ("%ld changes of status, %ld pieces\n", s->contact.changes, s->contact.pieces);
    check_relative (a.state->factor, 1, 1e-15);
    assert_true (s->contact.changes >= s->contact.pieces);
    double off = 0, size = 0, rest = s->energy.external - s->energy.strain;
    for (size_t i = 0; i < a.state->ndof; i++) {
        off = fmax (off, fabs (a.state->d[i] - fixed.state->d[i]));
        size = fmax (size, fabs (fixed.state->d[i]));
    }
    check_scaled (off, 0, 1e-9, size);
    check_scaled (rest, 0, 1e-9, s->energy.external);
    assert_true (s->energy.friction == 0);
    clear (&a), clear (&b), clear (&fixed);
    pg_free (t.byte);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (wings_begin_by_sliding),
        cmocka_unit_test (wings_are_those_of_the_image),
        cmocka_unit_test (growth_begins_at_the_sum_of_loads),
        cmocka_unit_test (an_open_disc_closes_by_and_by),
    };
    return cmocka_run_group_tests (tests, NULL, NULL);
}

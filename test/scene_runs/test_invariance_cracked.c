/* SPDX-License-Identifier: GPL-3.0-or-later
 * A plate with an oblique edge crack, about 350 points, 100 break events: the same bonds break in the same
 * order for every observer. Bonds are compared as sets of places (middle of the bond) per event, mapped
 * back. */
#include <unistd.h>
#include "view.h"

enum { EVENTS = 100 };
typedef struct { size_t n; pg_broken *bond; double factor; } event;
typedef struct { run r; event event[EVENTS + 1]; size_t n; } history;

static void run_events (history *h)
{
    while (!pg_solver_done (h->r.solver, h->r.state) && h->n < EVENTS) {
        advance (&h->r);
        check_below (h->r.step.residual, 1e-8);
        if (!h->r.step.event) continue;
        event *e = &h->event[h->n++];
        e->n = h->r.step.nbroken, e->factor = h->r.step.factor;
        e->bond = pg_calloc (e->n, sizeof *e->bond);
        memcpy (e->bond, h->r.step.broken, e->n * sizeof *e->bond);
    }
    assert_true (h->n > 0);
}

static void clear_history (history *h)
{
    for (size_t k = 0; k < h->n; k++) pg_free (h->event[k].bond);
    clear (&h->r);
}

static int has_image (const view *v, const pg_broken *bond, const event *e, double h)
{
    double x[2];
    seen (v, bond->place, x);
    for (size_t i = 0; i < e->n; i++)
        if (e->bond[i].set == bond->set && e->bond[i].kind == bond->kind &&
            hypot (e->bond[i].place[0] - x[0], e->bond[i].place[1] - x[1]) < 1e-6 * h) return 1;
    return 0;
}

static void check_same (const view *v, history *a, history *b)
{
    size_t bonds = 0;
    double factor = 0;
    assert_int_equal (a->n, b->n);
    for (size_t k = 0; k < a->n; k++) {
        if (a->event[k].n != b->event[k].n)
            print_error ("event %zu: %zu and %zu bonds\n", k + 1, a->event[k].n, b->event[k].n);
        assert_int_equal (a->event[k].n, b->event[k].n);
        factor = fmax (factor, fabs (b->event[k].factor / a->event[k].factor - 1));
        for (size_t i = 0; i < a->event[k].n; i++) {
            int found = has_image (v, &a->event[k].bond[i], &b->event[k], b->r.problem->cloud.h);
            if (!found)
                print_error ("event %zu, bond %zu at (%g, %g): no image\n", k + 1, i,
                             a->event[k].bond[i].place[0], a->event[k].bond[i].place[1]);
            assert_true (found);
        }
        bonds += a->event[k].n;
    }
    double u = displacement_difference (v, &a->r, &b->r, NULL);
    print_message ("%s: %zu events, %zu bonds, factor %.1e, displacement %.1e\n", v->name, a->n, bonds,
                   factor, u);
    check_below (u, 1e-8);
    check_below (factor, 1e-8);
}

typedef struct { const char *name, *method, *failure; enum { STRETCH, STRESS, ENERGY } limit; } kind;
static const kind kinds[] = {
    { "rkpm gauss, nitsche, stress", "approximation: rkpm, integration: gauss, essential: nitsche",
      "criterion: principal_stress, tensile_strength", STRESS },
    { "rkpm gauss, transformation, stretch",
      "approximation: rkpm, integration: gauss, essential: transformation",
      "criterion: stretch, critical_stretch", STRETCH },
    { "rkpm consistent, stress", "approximation: rkpm, integration: consistent",
      "criterion: principal_stress, tensile_strength", STRESS },
    { "nosb nodal, stretch", "approximation: nosb, integration: nodal, essential: transformation",
      "criterion: stretch, critical_stretch", STRETCH },
    { "bond", "force: bond", "criterion: stretch, critical_stretch", STRETCH },
    { "gmpd", "force: gmpd", "criterion: beam_limits, fracture_energy", ENERGY },
};
static const double limit_of[] = { [STRETCH] = 1e-4, [STRESS] = 1e6, [ENERGY] = 10 };
enum { KINDS = sizeof kinds / sizeof *kinds };

/* 1 m x 1.25 m, spacing 1/16 m, crack from the left edge, pulled apart at bottom and top */
static void plate (history *h, const view *v, const kind *k)
{
    char box[200];
    double from[2], to[2];
    check_box (v, 1, 1.25, box, sizeof box);
    seen (v, (double[2]) { -0.1, 0.553 }, from);
    seen (v, (double[2]) { 0.31, 0.672 }, to);
    *h = (history) { 0 };
    h->r = scene_of (
        v->threads,
        "dimension: 2\nthickness: %.17g\nbody: [{add: {box: %s}}]\nspacing: %.17g\n"
        "cracks: [{from: [%.17g, %.17g], to: [%.17g, %.17g]}]\n"
        "materials: {rock: {youngs_modulus: %.17g, poissons_ratio: 0.25}}\nfailure: {%s: %.17g, exclude: "
        "[bottom, top]}\n"
        "method: {%s, horizon: 2.01 spacing}\nboundary:\n  - {set: %s, displacement: {x: 0, y: %.17g}}\n"
        "  - {set: %s, displacement: {x: %.17g, y: %.17g}}\n"
        "solver: {stepping: event, break: worst, max_events: %d, stop: {stiffness: 0.01}}\noutput: {at: "
        "{levels: 1}}\n",
        0.02 * v->length, box, v->length / 16, from[0], from[1], to[0], to[1], 10e9 * v->stress, k->failure,
        limit_of[k->limit] * (k->limit == STRETCH ? 1 : v->stress) * (k->limit == ENERGY ? v->length : 1),
        k->method, v->sy > 0 ? "bottom" : "top", -1e-3 * v->length * v->sy, v->sy > 0 ? "top" : "bottom",
        2e-4 * v->length * v->sx, 1e-3 * v->length * v->sy, EVENTS);
    run_events (h);
}

static history reference[KINDS];                        /* of the plain view */

static int run_reference (void **state)
{
    (void) state;
    for (int k = 0; k < KINDS; k++) plate (&reference[k], &plain, &kinds[k]);
    return 0;
}

static int free_reference (void **state)
{
    (void) state;
    for (int k = 0; k < KINDS; k++) clear_history (&reference[k]);
    return 0;
}

static void check_view (const view *v)
{
    for (int k = 0; k < KINDS; k++) {
        view named = *v;
        history h;
        named.name = kinds[k].name;
        plate (&h, v, &kinds[k]);
        check_same (&named, &reference[k], &h);
        clear_history (&h);
    }
}

static void millimetres_and_megapascals (void **state)
{
    (void) state, check_view (&(view){ "", 1000, 1e-6, 1, 1, 0, 0, 1 });
}
static void mirrored_left_to_right (void **state)
{
    (void) state, check_view (&(view){ "", 1, 1, -1, 1, 0, 0, 1 });
}
static void rotated_by_180_degrees (void **state)
{
    (void) state, check_view (&(view){ "", 1, 1, -1, -1, 0, 0, 1 });
}
static void two_threads (void **state) { (void) state, check_view (&(view) { "", 1, 1, 1, 1, 0, 0, 2 }); }

static void cloud_plate (history *h, const char *path, const char *approximation, const char *failure)
{
    *h = (history) { 0 };
    h->r = scene_of (
        1,
        "dimension: 2\nthickness: 0.02\npoints: %s\ncracks: [{from: [-0.1, 0.553], to: [0.31, 0.672]}]\n"
        "materials: {rock: {youngs_modulus: 10 GPa, poissons_ratio: 0.25}}\n"
        "failure: {criterion: %s, exclude: [low, high]}\n"
        "sets: {low: {where: 'y < 0.07 m'}, high: {where: 'y > 1.18 m'}}\n"
        "method: {approximation: %s, integration: nodal, horizon: 0.14}\n"
        "boundary:\n  - {set: low, displacement: {x: 0, y: -1e-3}}\n  - {set: high, displacement: {x: 2e-4, "
        "y: 1e-3}}\n"
        "solver: {stepping: event, break: worst, max_events: %d, stop: {stiffness: 0.01}}\noutput: {at: "
        "{levels: 1}}\n",
        path, failure, approximation, EVENTS);
    run_events (h);
}

static void points_in_another_order (void **state)
{
    (void) state;
    char one[] = "/tmp/perigal_points_XXXXXX", two[] = "/tmp/perigal_points_XXXXXX";
    assert_true (close (mkstemp (one)) == 0 && close (mkstemp (two)) == 0);
    write_points (one, 17, 21, 0.0625, 0.1, 0);
    write_points (two, 17, 21, 0.0625, 0.1, 7);
    static const char *const names[] = { "nosb", "rkpm", "rkpm, force: gmpd" };
    for (int k = 0; k < 3; k++) {
        history a, b;
        view v = plain;
        const char *failure = k < 2 ? "stretch, critical_stretch: 1e-4" : "beam_limits, fracture_energy: 10";
        cloud_plate (&a, one, names[k], failure);
        cloud_plate (&b, two, names[k], failure);
        v.name = names[k];
        check_same (&v, &a, &b);
        clear_history (&a), clear_history (&b);
    }
    unlink (one), unlink (two);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (millimetres_and_megapascals), cmocka_unit_test (mirrored_left_to_right),
            cmocka_unit_test (rotated_by_180_degrees),
        cmocka_unit_test (two_threads), cmocka_unit_test (points_in_another_order),
    };
    return cmocka_run_group_tests_name ("scene_runs/invariance_cracked", tests, run_reference,
                                        free_reference);
}

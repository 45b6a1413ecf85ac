/* SPDX-License-Identifier: GPL-3.0-or-later
 * Patch test of a body that is cut in two and pressed together: with consistent integration, whose cells end
 * at the cut, displacement and stress are those of the uncut body. Cuts are frictionless, stuck or open,
 * level, tilted, kinked, at 45 degrees, along sides of cells and close to them, on lattices and on points
 * moved at random. While cracks grow, what is renewed of the stiffness equals a fresh one. */
#include "scene_runs/run.h"

static const double nu = 0.25;
/* A cut through a square of 1 x 1, 10 spacings wide, with its uniform stress, MPa. */
typedef struct {
    const char *what, *plane, *lattice, *crack, *contact, *method;
    double perturb, sx, sy;
} cut;

/* Strains of the stress. */
static void strains_of (const cut *c, double e[2])
{
    const double E = 10e3;
    int strain = strstr (c->plane, "strain") != NULL;
    double direct = strain ? (1 - nu * nu) / E : 1 / E, across = strain ? -nu * (1 + nu) / E : -nu / E;
    e[0] = direct * c->sx + across * c->sy, e[1] = direct * c->sy + across * c->sx;
}

/* On rollers below, and on the left unless the cut is open; tractions above and on the right. Largest errors
 * at the points, relative. */
static void measure (const cut *c, double *displacement, double *stress)
{
    int components, open = *c->contact == 0;
    double e[2], top = 0;
    char left[120];
    strains_of (c, e);
    snprintf (left, sizeof left,
              open ? "{set: bottom, displacement: {x: '%.17g*x', y: 0}}"
                   : "{set: bottom, displacement: {y: 0}}, {set: left, displacement: {x: 0}}",
              e[0]);
    run r =
        scene_of (1,
                  "dimension: 2\n%s\nbody: [{add: {box: {low: [0, 0], high: [1, 1]}}}]\nspacing: 0.1\n"
                  "perturb: {amount: %g}\nlattice: %s\ncracks: %s\n%s\n"
                  "materials: {rock: {youngs_modulus: 10 GPa, poissons_ratio: 0.25}}\n"
                  "method: {approximation: rkpm, essential: nitsche, %s}\n"
                  "boundary: [%s, {set: top, traction: {y: %g MPa}}, {set: right, traction: {x: %g MPa}}]\n"
                  "solver: {kind: static, steps: 1, stepping: fixed}\noutput: {at: {levels: 1}}\n",
                  c->plane, c->perturb, c->lattice, c->crack, c->contact, c->method, left, c->sy, c->sx);
    to_the_end (&r);
    assert_int_equal (pg_solver_report (r.solver, r.state)->unended_cells, 0);
    double *u = field_of (&r, NULL, "displacement", &components);
    *displacement = *stress = 0;
    for (size_t i = 0; i < r.problem->cloud.n; i++)
        for (size_t k = 0; k < 2; k++) {
            double exact = e[k] * r.problem->cloud.x[2*i + k];
            *displacement = fmax (*displacement, fabs (u[2*i + k] - exact)), top = fmax (top, fabs (exact));
        }
    *displacement /= top;
    pg_free (u);
    double *s = field_of (&r, NULL, "stress", &components);
    for (size_t i = 0; i < r.problem->cloud.n; i++) {
        const double *t = s + (size_t) components * i;
        *stress = fmax (*stress, fmax (fabs (t[0] / 1e6 - c->sx), fabs (t[1] / 1e6 - c->sy)) / fabs (c->sy));
    }
    pg_free (s);
    clear (&r);
}

#define NORMAL "contact: {kind: normal}"
#define ROUGH  "contact: {kind: friction, coefficient: 0.9}"
#define LEVEL  "[{from: [-0.1, 0.534], to: [1.1, 0.534]}]"
#define TILTED "[{from: [-0.1, 0.337], to: [1.1, 0.681]}]"
#define BLOCK  "[{from: [0.513, 0.207], to: [0.81, 0.52]}, {from: [0.81, 0.52], to: [0.48, 0.83]}, " \
               "{from: [0.48, 0.83], to: [0.17, 0.46]}, {from: [0.17, 0.46], to: [0.513, 0.207]}]"
#define SLOPES "[{from: [0.53, 0.2], to: [0.83, 0.5]}, {from: [0.83, 0.5], to: [0.53, 0.8]}, " \
               "{from: [0.53, 0.8], to: [0.23, 0.5]}, {from: [0.23, 0.5], to: [0.53, 0.2]}]"
static const char *const exact = "integration: consistent";

static void cut_bodies_are_whole (void **unused)
{
    const cut cuts[] = {
        { "level", "plane: stress", "cells", LEVEL, NORMAL, exact, 0, 0, -3 },
        { "level", "plane: strain", "cells", LEVEL, NORMAL, exact, 0.3, 0, -3 },
        { "along sides of cells", "plane: stress", "cells", "[{from: [-0.1, 0.5], to: [1.1, 0.5]}]", NORMAL,
          exact, 0, 0, -3 },
        { "close to sides", "plane: stress", "cells", "[{from: [-0.1, 0.507], to: [1.1, 0.507]}]", NORMAL,
          exact, 0.2, 0, -3 },
        { "through corners", "plane: stress", "cells", "[{from: [-0.1, 0.2], to: [1.1, 0.8]}]", ROUGH, exact,
          0, 0, -3 },
        { "tilted, stuck", "plane: stress", "cells", TILTED, ROUGH, exact, 0.2, 0, -3 },
        { "tilted, stuck", "plane: strain", "nodes", TILTED, ROUGH,
          "integration: consistent, horizon: 2.5 spacing", 0.4, 0, -3 },
        { "a block cut out, pressed from all sides", "plane: strain", "nodes", BLOCK, NORMAL, exact, 0.3, -3,
          -3 },
        { "a block with sides at 45 degrees", "plane: strain", "cells", SLOPES, NORMAL, exact, 0, -3, -3 },
        { "quadratic basis", "plane: stress", "cells", TILTED, ROUGH,
          "integration: consistent, basis: quadratic, horizon: 3 spacing", 0.2, 0, -3 },
        { "open, along the load", "plane: stress", "cells", "[{from: [0.5, -0.1], to: [0.5, 1.1]}]", "",
          exact, 0.3, 0, -3 },
    };
    (void) unused;
    for (size_t k = 0; k < sizeof cuts / sizeof *cuts; k++) {
        double displacement, stress;
        measure (&cuts[k], &displacement, &stress);
        print_message ("%s, %s, moved by %g: displacement %.1e, stress %.1e\n", cuts[k].what, cuts[k].plane,
                       cuts[k].perturb, displacement, stress);
        check_below (displacement, 1e-10);
        check_below (stress, 1e-10);
    }
}

/* Gauss integration is not exact, by so much that these tests could not pass by chance. */
static void gauss_is_not (void **unused)
{
    const cut cuts[] = { { "", "plane: stress", "cells", LEVEL, NORMAL, "integration: gauss", 0, 0, -3 },
                         { "", "plane: stress", "cells", TILTED, ROUGH, "integration: gauss", 0.2, 0, -3 } };
    (void) unused;
    for (size_t k = 0; k < 2; k++) {
        double displacement, stress;
        measure (&cuts[k], &displacement, &stress);
        print_message ("Gauss: displacement %.1e, stress %.1e\n", displacement, stress);
        assert_true (displacement > 1e-5 && stress > 1e-4);
    }
}

/* The stiffness of the force at hand. */
static const pg_sparse *stiffness (run *r, int anew)
{
    void *self;
    const pg_force_type *force = pg_solver_force (r->solver, &self);
    if (anew) check_ok (force->refresh (self, r->state, NULL));
    check_ok (pg_force_assemble (force, self, NULL));
    return pg_force_matrix (force, self);
}

/* A crack from the left side that grows by facets, along cells and through them: K that is renewed around the
 * new facets is the fresh one bit by bit. */
static void growth_renews_cells (void **unused)
{
    (void) unused;
    run r = scene_of (1, "dimension: 2\nplane: stress\nthickness: 1 m\nbody: [{add: {box: {low: [0, -0.5], "
                         "high: [3, 0.5]}}}]\nspacing: 0.0625\nlattice: cells\ncracks: [{from: [-0.2, 0.02], "
                         "to: [1.5, 0.02]}]\nmaterials: {m: {youngs_modulus: 10 GPa, poissons_ratio: 0.25}}\n"
                         "failure: {fracture_energy: 100 J/m2}\nboundary:\n"
                         "  - {set: top, displacement: {x: 0, y: 1 mm}}\n"
                         "  - {set: bottom, displacement: {x: 0.2 mm, y: -1 mm}}\n"
                         "solver: {kind: static, max_events: 8}\noutput: {at: {levels: 1}}\n"
                         "method: {integration: consistent}\n");
    for (int step = 0; step < 6 && !pg_solver_done (r.solver, r.state); step++) {
        advance (&r);
        const pg_sparse *K = stiffness (&r, 0);
        size_t n = (size_t) K->start[K->ncol];
        double *kept = pg_calloc (n, sizeof *kept);
        memcpy (kept, K->value, n * sizeof *kept);
        K = stiffness (&r, 1);
        assert_int_equal (n, K->start[K->ncol]);
        assert_memory_equal (kept, K->value, n * sizeof *kept);
        pg_free (kept);
    }
    assert_true (r.state->paths->tip[0].grown > 0.1);
    clear (&r);
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (cut_bodies_are_whole),
                                        cmocka_unit_test (gauss_is_not),
                                        cmocka_unit_test (growth_renews_cells) };
    return cmocka_run_group_tests (tests, NULL, NULL);
}

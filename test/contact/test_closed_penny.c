/* SPDX-License-Identifier: GPL-3.0-or-later
 * Closed cracks in space: a penny-shaped crack in a box whose surface bears the tractions of uniform stress.
 * Closed without friction its faces carry a uniform pressure, and what is left is the same crack under the
 * shear stress alone; friction takes mu sigma_n of that. Pieces of discs, polygons and grown surfaces; units,
 * mirrors, threads, checkpoints. */
#include "contact/pieces.h"
#include "scene_runs/run.h"
#include "solve/tape.h"

/* A disc of `radius` spacings, its normal turned by `tilt` from the z axis towards x, under 1 Pa of
 * compression along z; shear: the shear part of that stress on the disc alone. */
typedef struct {
    double radius, tilt, shift[3], unit, friction, perturb;
    int w, shear, mirrored, threads;                   /* w: half width of the box, spacings */
    const char *contact, *more;
} penny;

static run penny_run (const penny *l)
{
    double u = l->unit, w = l->w * u, sx = (l->mirrored ? -1 : 1), s[3][3] = { { 0 } };
    double n[3] = { sx * sin (l->tilt), 0, cos (l->tilt) }, e[3] = { sx * cos (l->tilt), 0, -sin (l->tilt) };
    char text[6000], traction[6][200];
    static const char *const set[6] = { "left", "right", "bottom", "top", "back", "front" };
    s[2][2] = -1;
    for (int i = 0; l->shear && i < 3; i++)
        for (int j = 0; j < 3; j++) s[i][j] = sin (l->tilt) * cos (l->tilt) * (n[i] * e[j] + e[i] * n[j]);
    for (int k = 0; k < 6; k++)
        snprintf (traction[k], sizeof traction[k],
                  "  - {name: t%d, set: %s, traction: {x: %.17g, y: %.17g, z: %.17g}}\n", k, set[k],
                  (k % 2 ? 1 : -1) * s[0][k / 2], (k % 2 ? 1 : -1) * s[1][k / 2],
                  (k % 2 ? 1 : -1) * s[2][k / 2]);
    int length = snprintf (text, sizeof text,
        "dimension: 3\nbody: [{add: {box: {low: [%.17g, %.17g, %.17g], high: [%.17g, %.17g, %.17g]}}}]\n"
        "spacing: %.17g\nlattice: cells\nperturb: {amount: %g}\n"
        "cracks: [{disc: {center: [%.17g, %.17g, %.17g], normal: [%.17g, 0, %.17g], radius: %.17g}}]\n"
        "materials: {m: {youngs_modulus: 1000, poissons_ratio: 0.25}}\n%s\n"
        "method: {approximation: rkpm, integration: gauss, kernel: cubic_spline, horizon: 2.01 spacing}\n"
        "sets:\n  a: {where: \"%s < %.17g and y < %.17g and z < %.17g\"}\n"
        "  b: {where: \"%s > %.17g and y < %.17g and z < %.17g\"}\n"
        "  c: {where: \"%s < %.17g and y > %.17g and z < %.17g\"}\nboundary:\n%s%s%s%s%s%s"
        "  - {name: pa, set: a, essential: penalty, displacement: {x: 0, y: 0, z: 0}}\n"
        "  - {name: pb, set: b, essential: penalty, displacement: {y: 0, z: 0}}\n"
        "  - {name: pc, set: c, essential: penalty, displacement: {z: 0}}\n"
        "solver: {kind: static, stepping: fixed, steps: 1}\noutput: {at: {levels: 1}}\n%s",
        -w, -w, -w, w, w, w, u, l->perturb, sx * l->shift[0] * u, l->shift[1] * u, l->shift[2] * u, n[0],
        n[2], l->radius * u, l->contact, l->mirrored ? "-x" : "x", -w + u, -w + u, -w + u,
        l->mirrored ? "-x" : "x", w - u, -w + u, -w + u, l->mirrored ? "-x" : "x", -w + u, w - u, -w + u,
        traction[0], traction[1], traction[2], traction[3], traction[4], traction[5], l->more);
    assert_true (length > 0 && length < (int) sizeof text);
    run r = prepare (l->threads ? l->threads : 1, text);
    to_the_end (&r);
    return r;
}

/* PERIGAL_TEST_SIZE=long: all cases, else the first of each kind. */
static const char *const judged = "failure: {criterion: energy_release, fracture_energy: 1e30}\n";

/* Flat under its load: it carries what the uncracked body does, its front bears nothing. */
static void a_flat_penny_carries_the_pressure (void **state)
{
    (void) state;
    penny l = { .radius = 4, .shift = { 0.2, 0.1, 0.3 }, .unit = 1, .w = 6,
                .contact = "contact: {kind: normal}", .more = judged };
    for (int k = 0; k < (longer () ? 3 : 1); k++) {
        if (k == 1) l.shift[2] = 0;                    /* on a layer of cells' sides */
        if (k == 2) l.shift[2] = 0.5, l.perturb = 0.15;              /* points that lay on it are moved */
        run r = penny_run (&l);
        size_t n, nfront;
        const pg_contact_values *v = pg_solver_contact (r.solver, &n);
        double area = 0, force = 0, least = INFINITY, most = 0;
        for (size_t i = 0; i < n; i++) {
            area += v[i].area, force += v[i].area * v[i].pressure;
            least = fmin (least, v[i].pressure), most = fmax (most, v[i].pressure);
            assert_int_equal (v[i].status, PG_CONTACT_SLIDING);
            check_relative (fabs (v[i].normal[2]), 1, 1e-14);
        }
        print_message ("flat penny %d: %zu pieces, mean pressure %.4f, %.3f to %.3f\n", k, n, force / area,
                       least, most);
        /* on points that are moved the fields of the body itself are rough */
        check_relative (force / area, 1, k == 2 ? 0.04 : 0.03);
        assert_true (least > (k == 2 ? 0.6 : 0.8) && most < (k == 2 ? 1.5 : 1.2));
        /* of 1e-3 m: forces are refined to 1e-12 of the residual */
        check_below (pg_solver_report_now (r.solver)->contact.overlap, 1e-13);
        const pg_tip_values *f = pg_solver_tips (r.solver, &nfront);
        assert_true (nfront > 10);
        double opening = 2 * sqrt (4 / 3.14159265358979);
        for (size_t i = 0; i < nfront; i++) {
            assert_true (f[i].K[0] == 0);
            check_below (hypot (f[i].K[1], f[i].K[2]), (k == 2 ? 0.1 : 0.05) * opening);
        }
        clear (&r);
    }
}

/* Largest K_II and K_III along the front, and the largest difference from `other`, scaled, over them. */
static double differs (const run *a, const run *b, double scale)
{
    size_t n, m;
    const pg_tip_values *f = pg_solver_tips (a->solver, &n), *g = pg_solver_tips (b->solver, &m);
    double most = 0, off = 0;
    assert_int_equal (n, m);
    for (size_t i = 0; i < n; i++)
        for (int k = 1; k < 3; k++)
            most = fmax (most, fabs (g[i].K[k])), off = fmax (off, fabs (f[i].K[k] - scale * g[i].K[k]));
    return off / most;
}

/* Inclined by 45 degrees: shear and normal stress on it are 1/2 Pa each. */
static void an_inclined_penny_slides (void **state)
{
    (void) state;
    static const struct { const char *contact; double left, within; } cases[] = {
        { "contact: {kind: friction, coefficient: 0.3}", 0.7, 0.025 },
        { "contact: {kind: normal}", 1, 0.025 },
        { "contact: {kind: friction, coefficient: 1.3}", 0, 0.05 }
    };
    penny l = { .radius = 4, .tilt = 0.7853981633974483, .shift = { 0.2, 0.1, 0.3 }, .unit = 1, .w = 6,
                .shear = 1, .contact = "", .more = judged };
    if (!longer ()) l.radius = 3.5, l.w = 5;
    run open = penny_run (&l);
    l.shear = 0;
    for (size_t c = 0; c < (longer () ? 3 : 1); c++) {
        l.contact = cases[c].contact;
        run r = penny_run (&l);
        const pg_statistics *s = pg_solver_report_now (r.solver);
        size_t n;
        const pg_contact_values *v = pg_solver_contact (r.solver, &n);
        double off = differs (&r, &open, cases[c].left), slip = 0;
        for (size_t i = 0; i < n; i++)
            slip = fmax (slip, hypot (hypot (v[i].slip[0], v[i].slip[1]), v[i].slip[2]));
        print_message ("%s: K off by %.4f of the largest, slip %.3g, %ld open %ld stick %ld slide\n",
                       l.contact, off, slip, s->contact.open, s->contact.stick, s->contact.sliding);
        check_below (off, longer () ? cases[c].within : 0.035);       /* at 4 and 3.5 spacings */
        check_below (s->contact.overlap, 1e-15);
        assert_int_equal (s->contact.open, 0);
        if (cases[c].left == 0) assert_true (s->contact.stick > s->contact.sliding);
        else assert_int_equal (s->contact.stick, 0);
        /* work = strain energy + friction, and what friction takes is not nothing */
        double rest = s->energy.external - s->energy.strain - s->energy.friction;
        check_scaled (rest, 0, 1e-9, s->energy.external);
        if (c == 0) assert_true (s->energy.friction > 1e-3 * s->energy.strain);
        for (size_t i = 0; c == 0 && i < n; i++) {
            double shear = 0, work = 0, size = 0;
            for (int k = 0; k < 3; k++)
                shear = hypot (shear, v[i].shear[k]), size = hypot (size, v[i].slip[k]),
                work += v[i].shear[k] * v[i].slip[k];
            check_relative (shear, 0.3 * v[i].pressure, 1e-9);
            check_relative (work, -shear * size, 1e-9);            /* against the slip */
        }
        clear (&r);
    }
    clear (&open);
}

/* In mm, mirrored, on two threads: the same. */
static void units_and_mirrors_do_not_count (void **state)
{
    (void) state;
    penny l = { .radius = 2.5, .tilt = 0.6, .shift = { 0.2, 0.1, 0.3 }, .unit = 1, .w = 4,
                .contact = "contact: {kind: friction, coefficient: 0.2}", .more = "" };
    run r = penny_run (&l);
    const pg_statistics *s = pg_solver_report_now (r.solver);
    for (int k = longer () ? 0 : 1; k < 3; k++) {
        penny m = l;
        if (k == 0) m.unit = 1e-3;
        if (k == 1) m.mirrored = 1;
        if (k == 2) m.threads = 2;
        run other = penny_run (&m);
        const pg_statistics *t = pg_solver_report_now (other.solver);
        double scale = k == 0 ? 1e-9 : 1;
        assert_int_equal (t->contact.pieces, s->contact.pieces);
        check_relative (t->energy.strain, scale * s->energy.strain, k == 2 ? 1e-12 : 1e-9);
        check_relative (t->energy.friction, scale * s->energy.friction, k == 1 ? 0.05 : 1e-7);
        clear (&other);
    }
    clear (&r);
}

/* Areas, sizes and normals of pieces of polygons and discs. */
static void surfaces_are_divided (void **state)
{
    (void) state;
    static const struct { const char *crack; double area; size_t least, most; double size[2]; } cases[] = {
        { "disc: {center: [0, 0, 0.3], normal: [0, 0, 1], radius: 6}", 113.1, 24, 34, { 0.35, 1.8 } },
        { "polygon: [[-4, -6, 0.3], [4, -6, 0.3], [4, 6, 0.3], [-4, 6, 0.3]]", 96, 20, 26, { 0.6, 1.4 } },
        { "polygon: [[-6, -6, 0.3], [6, -6, 0.3], [6, -2, 0.3], [-2, -2, 0.3], [-2, 6, 0.3], [-6, 6, 0.3]]",
          80, 15, 23, { 0.35, 1.8 } },
    };
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
        run r = scene_of (1,
            "dimension: 3\nbody: [{add: {box: {low: [-10, -10, -6], high: [10, 10, 6]}}}]\nspacing: 1\n"
            "lattice: cells\ncracks: [{%s}]\nmethod: {tip_offset: 0 m}\ncontact: {kind: normal}\n"
            "materials: {m: {youngs_modulus: 1000, poissons_ratio: 0.25}}\nboundary:\n"
            "  - {set: back, displacement: {x: 0, y: 0, z: 0}}\n"
            "solver: {kind: static, stepping: fixed, steps: 1}\n", cases[c].crack);
        pg_contact_pieces pieces;
        check_ok (pg_contact_pieces_create (&pieces, r.problem, r.state));
        double area = 0;
        for (size_t k = 0; k < pieces.n; k++) {
            const pg_contact_piece *p = &pieces.piece[k];
            double sum = 0, far = 0;
            area += p->area;
            for (size_t q = pieces.first[k]; q < pieces.first[k + 1]; q++) {
                const double *x = pieces.x + 3*q;
                sum += pieces.weight[q];
                far = fmax (far, hypot (x[0] - p->x[0], x[1] - p->x[1]));
                check_absolute (x[2], 0.3, 1e-12);
                for (int a = 0; a < 2; a++) {
                    const double *t = pieces.tangent + 6*q + 3*a, *n = pieces.normal + 3*q;
                    check_absolute (t[0] * n[0] + t[1] * n[1] + t[2] * n[2], 0, 1e-14);
                    check_absolute (hypot (hypot (t[0], t[1]), t[2]), 1, 1e-14);
                }
            }
            check_relative (sum, p->area, 1e-12);
            assert_true (p->area > cases[c].size[0] * 4 && p->area < cases[c].size[1] * 4);
            check_below (far, 2.6);                    /* compact: no further than this from its middle */
        }
        print_message ("%zu pieces, area %.4f\n", pieces.n, area);
        check_relative (area, cases[c].area, 0.01);
        assert_true (pieces.n >= cases[c].least && pieces.n <= cases[c].most);
        assert_int_equal (pieces.first[pieces.n], pieces.npoint);
        pg_contact_pieces_clear (&pieces);
        clear (&r);
    }
}

/* Loaded and half unloaded, with friction: slips of the step before decide what sticks. */
static void a_resumed_run_goes_on_bit_by_bit (void **state)
{
    (void) state;
    const char *text =
        "dimension: 3\nbody: [{add: {box: {low: [-4, -4, -4], high: [4, 4, 4]}}}]\nspacing: 1\n"
        "lattice: cells\ncracks: [{disc: {center: [0.1, 0.2, 0.1], normal: [1, 0.2, 1.3], radius: 3}}]\n"
        "materials: {m: {youngs_modulus: 1000, poissons_ratio: 0.25}}\n"
        "contact: {kind: friction, coefficient: 0.3}\nboundary:\n"
        "  - {name: foot, set: back, displacement: {x: 0, y: 0, z: 0}}\n"
        "  - {name: head, set: front, traction: {z: -10}, table: [[0, 0], [0.5, 1], [1, 0.4]]}\n"
        "solver: {kind: static, stepping: fixed, steps: 4}\noutput: {at: {levels: 1}}\n";
    run a = prepare (1, text), b = prepare (1, text);
    tape t = { 0 };
    for (int i = 0; i < 3; i++) advance (&a);
    keep (&a, &t, 0);
    keep (&b, &t, 1);
    advance_alike (&a, &b);
    assert_true (pg_solver_report_now (a.solver)->energy.friction > 0);
    assert_true (pg_solver_report_now (a.solver)->energy.friction
                 == pg_solver_report_now (b.solver)->energy.friction);
    clear (&a), clear (&b);
    pg_free (t.byte);
}

/* A body that nothing holds along one direction, and no load pulls that way, runs as without contact: the
 * answer is that of a body held at one point. */
static void a_body_may_be_free_along_an_axis (void **state)
{
    (void) state;
    double force[2], most[2];
    for (int held = 0; held < 2; held++) {
        run r = scene_of (1, "dimension: 3\nbody: [{add: {box: {low: [-10, -10, -10], high: [10, 10, "
                             "10]}}}]\nspacing: 2.5\n"
                          "lattice: cells\ncracks: [{disc: {center: [0.3, 0.2, 0.4], radius: 6, normal: [0, "
                          "1, 1]}}]\n"
                          "contact: {kind: friction, coefficient: 0.3}\nmaterials: {m: {youngs_modulus: 100, "
                          "poissons_ratio: 0.25}}\nsets: {pin: {where: \"x < -8 and y < -8 and z < "
                          "-8\"}}\nboundary:\n"
                          "  - {set: bottom, displacement: {y: 0}}\n  - {set: top, displacement: {y: -0.1}}\n"
                          "  - {set: left, displacement: {x: 0}}\n%s"
                          "solver: {kind: static, stepping: fixed, steps: 1}\n",
                          held ? "  - {set: pin, essential: penalty, displacement: {z: 0}}\n" : "");
        size_t n;
        advance (&r);
        const pg_contact_values *v = pg_solver_contact (r.solver, &n);
        force[held] = most[held] = 0;
        for (size_t k = 0; k < n; k++)
            force[held] += v[k].area * v[k].pressure, most[held] = fmax (most[held], v[k].pressure);
        clear (&r);
    }
    assert_true (force[1] > 0);
    check_relative (force[0], force[1], 1e-6);
    check_relative (most[0], most[1], 1e-6);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (surfaces_are_divided),
        cmocka_unit_test (a_flat_penny_carries_the_pressure),
        cmocka_unit_test (a_body_may_be_free_along_an_axis),
        cmocka_unit_test (an_inclined_penny_slides),
        cmocka_unit_test (units_and_mirrors_do_not_count),
        cmocka_unit_test (a_resumed_run_goes_on_bit_by_bit),
    };
    return cmocka_run_group_tests (tests, NULL, NULL);
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * Faces that bonds leave which broke one by one: a body cut in two is pressed like a whole one and slides;
 * inclined cracks slip as cracks of the scene do, with friction and without; what broke in tension closes
 * when the load turns round, in equilibria and in relaxation. */
#include "scene_runs/run.h"
#include "perigal/contact.h"
#include "solve/tape.h"

/* A square of half width 3 m with a crack of half length `half` m, n spacings to the metre, inclined by
 * `beta` to the load. */
typedef struct {
    double beta, perturb, nu, half;
    const char *plane, *method, *contact, *solver;
    int n, threads;
} plate;

static const char *const fixed = "{kind: static, stepping: fixed, steps: 2}";

/* known: 1: the crack is one of the scene; stretch: of bonds that break, 0: none do. */
static run plate_with (const plate *l, int known, double stretch)
{
    char text[4000], crack[300], support[400], failure[100];
    double b = l->beta * 3.14159265358979323846 / 180, h = 1.0 / l->n, x = l->half * sin (b),
           y = l->half * cos (b);
    snprintf (crack, sizeof crack, "cracks: [{from: [%.17g, %.17g], to: [%.17g, %.17g]}]\n", -x + 0.13 * h,
              -y + 0.21 * h, x + 0.13 * h, y + 0.21 * h);
    snprintf (support, sizeof support,
              "sets: {a: {where: \"x < %.17g and y < %.17g\"}, b: {where: \"x > %.17g and y < %.17g\"}}\n",
              -3 + 1.01 * h, -3 + 1.01 * h, 3 - 1.01 * h, -3 + 1.01 * h);
    snprintf (failure, sizeof failure, "failure: {criterion: stretch, critical_stretch: %g}\n", stretch);
    snprintf (text, sizeof text,
              "dimension: 2\nplane: %s\nthickness: 1\nbody: [{add: {box: {low: [-3, -3], high: [3, 3]}}}]\n"
              "spacing: %.17g\nlattice: cells\nperturb: {amount: %g}\n%s"
              "materials: {m: {youngs_modulus: 1000, poissons_ratio: %.17g, density: 1}}\nmethod: %s\n"
              "%scontact: %s\n%sboundary:\n  - {name: t, set: top, traction: {y: -1}}\n"
              "  - {name: d, set: bottom, traction: {y: 1}}\n"
              "  - {name: a, set: a, displacement: {x: 0, y: 0}}\n"
              "  - {name: b, set: b, displacement: {y: 0}}\nsolver: %s\noutput: {at: {levels: 1}}\n",
              l->plane, h, l->perturb, known ? crack : "", l->nu, l->method,
              stretch > 0 ? failure : "", l->contact, support,
              l->solver);
    return prepare (l->threads ? l->threads : 1, text);
}

/* Without the crack bonds may break, but none does. */
static run plate_of (const plate *l, int known) { return plate_with (l, known, known ? 0 : 1); }
static run wings_of (const plate *l, int known) { return plate_with (l, known, 1e-3); }

/* The bonds that the cracks of one scene cut are broken in the other. */
static void break_as (const run *from, run *to)
{
    assert_int_equal (from->state->nbond, to->state->nbond);
    memcpy (to->state->alive, from->state->alive, to->state->nbond);
}

/* Mean pressure and shear of the inner pieces, the largest slip, the worst angle of a normal, rad. */
typedef struct { double pressure, shear, slip, angle, gap; size_t n; } faces;
static faces faces_of (const run *r, double beta)
{
    size_t n, inner = 0;
    const pg_contact_values *v = pg_solver_contact (r->solver, &n);
    double b = beta * 3.14159265358979323846 / 180, normal[2] = { -cos (b), sin (b) };
    faces out = { .n = n };
    for (size_t k = 0; k < n; k++) {
        double along = fabs (v[k].x[0] * sin (b) + v[k].x[1] * cos (b));
        out.slip = fmax (out.slip, fabs (v[k].slip[0])), out.gap = fmax (out.gap, fabs (v[k].gap));
        double off = fabs (v[k].normal[0] * normal[0] + v[k].normal[1] * normal[1]);
        out.angle = fmax (out.angle, acos (fmin (1, off)));
        if (along > 0.7) continue;
        out.pressure += v[k].pressure, out.shear += fabs (v[k].shear[0]), inner++;
    }
    if (inner) out.pressure /= (double) inner, out.shear /= (double) inner;
    return out;
}

/* An inclined crack of broken bonds slips as the same crack of the scene, and bears the same. */
static void slips_as_a_crack_of_the_scene (void **state)
{
    (void) state;
    static const char *const bond = "{force: bond}", *const lps = "{force: lps, weighted_volume: live}",
                      *const beams = "{force: gmpd}", *const fast = "{force: fcbm}";
    const struct { double beta, mu, perturb; const char *plane, *method; double nu; } row[] = {
        { 45, 0, 0, "stress", bond, 1.0 / 3 },   { 60, 0.3, 0, "stress", bond, 1.0 / 3 },
        { 30, 0, 0.2, "stress", bond, 1.0 / 3 }, { 60, 0.6, 0, "stress", bond, 1.0 / 3 },
        { 30, 0, 0, "stress", bond, 1.0 / 3 },   { 30, 0.3, 0, "stress", bond, 1.0 / 3 },
        { 45, 0.3, 0, "strain", bond, 0.25 },    { 60, 0, 0, "stress", bond, 1.0 / 3 },
        { 20, 0, 0, "stress", bond, 1.0 / 3 },   { 70, 0, 0.2, "stress", bond, 1.0 / 3 },
        { 45, 0.3, 0, "stress", lps, 0.25 },     { 45, 0.3, 0, "stress", beams, 0.2 },
        { 50, 0.3, 0.1, "strain", lps, 0.3 },    { 50, 0.3, 0, "stress", fast, 1.0 / 3 },
    };
    for (size_t i = 0; i < (longer () ? sizeof row / sizeof *row : 3); i++) {
        char contact[64] = "{kind: normal}";
        if (row[i].mu > 0) snprintf (contact, sizeof contact, "{kind: friction, coefficient: %g}", row[i].mu);
        plate l = { row[i].beta, row[i].perturb, row[i].nu, 1, row[i].plane, row[i].method, contact, fixed,
                    10, 1 };
        run known = plate_of (&l, 1), found = plate_of (&l, 0);
        to_the_end (&known);
        break_as (&known, &found);
        to_the_end (&found);
        faces a = faces_of (&known, l.beta), b = faces_of (&found, l.beta);
        const double free_slip = 2.5e-3;               /* about that of 45 degrees without friction */
        print_message ("%s, %g degrees, friction %g, moved %g: pressure %.4f and %.4f, slip %.5g, over that "
                       "of the crack %.4f, normals within %.2f degrees\n", l.method, l.beta, row[i].mu,
                       l.perturb, a.pressure, b.pressure, a.slip, b.slip / a.slip,
                       b.angle * 180 / 3.14159265358979323846);
        check_relative (b.pressure, a.pressure, 0.03);
        assert_true (b.angle < 0.1 && b.n + 1 >= a.n && b.n <= a.n + 1);
        if (row[i].mu < 0.6) {
            check_relative (b.slip, a.slip, row[i].perturb > 0 ? 0.04 : 0.02);
            check_scaled (b.shear, row[i].mu * b.pressure, 1e-9, 1);
        } else assert_true (b.slip < 0.02 * free_slip);
        assert_true (pg_solver_report_now (found.solver)->contact.overlap < 1e-9 * free_slip);
        clear (&known), clear (&found);
    }
}

/* ---- a body in two parts ------------------------------------------------------------------------------- */
/* A block of 2 m, spacing .1, that a plane at `tilt` degrees to the horizontal cuts in two, pressed by
 * `press` and dragged by `drag`, m, at its top. */
typedef struct { int dim; double tilt, perturb, press, drag; const char *method, *contact, *solver; } block;
enum { WHOLE, KNOWN, FOUND };

static run block_of (const block *l, int way)
{
    double b = l->tilt * 3.14159265358979323846 / 180, x = 2 * cos (b), y = 2 * sin (b);
    char crack[400];
    if (l->dim == 2)
        snprintf (crack, sizeof crack, "cracks: [{from: [%.17g, %.17g], to: [%.17g, %.17g]}]\n", -x, -y, x,
                  y);
    else
        snprintf (crack, sizeof crack,
                  "cracks: [{polygon: [[%.17g, %.17g, -3], [%.17g, %.17g, -3], [%.17g, %.17g, 3], "
                  "[%.17g, %.17g, 3]]}]\n", -x, -y, x, y, x, y, -x, -y);
    return scene_of (1, "dimension: %d\n%sbody: [{add: {box: {low: [-1, -1%s], high: [1, 1%s]}}}]\n"
                     "spacing: %g\nlattice: cells\nperturb: {amount: %g}\n%s"
                     "materials: {m: {youngs_modulus: 1000, poissons_ratio: %s, density: 1}}\nmethod: %s\n"
                     "%scontact: %s\nboundary:\n  - {set: top, displacement: {x: %g, y: %g%s}}\n"
                     "  - {set: bottom, displacement: {x: 0, y: 0%s}}\nsolver: %s\n"
                     "output: {at: {levels: 1}}\n", l->dim,
                     l->dim == 2 ? "plane: stress\nthickness: 1\n" : "", l->dim == 2 ? "" : ", -1",
                     l->dim == 2 ? "" : ", 1", l->dim == 2 ? 0.1 : 0.2, l->perturb, way == KNOWN ? crack : "",
                     l->dim == 2 ? "0.3333333333333333" : "0.25", l->method,
                     way == FOUND ? "failure: {criterion: stretch, critical_stretch: 1}\n" : "",
                     way == WHOLE ? "{kind: none}" : l->contact, l->drag, l->press,
                     l->dim == 2 ? "" : ", z: 0", l->dim == 2 ? "" : ", z: 0", l->solver);
}

/* Bonds across the plane through the middle at `tilt` degrees are broken. */
static void cut (run *r, double tilt)
{
    const pg_family *f = &r->problem->bonds.rows[PG_NODES].family;
    size_t dim = (size_t) r->problem->dim;
    const double *all = r->problem->cloud.x;
    double b = tilt * 3.14159265358979323846 / 180, n[2] = { -sin (b), cos (b) };
    for (size_t i = 0; i < r->problem->cloud.n; i++)
        for (size_t e = f->start[i]; e < f->start[i + 1]; e++) {
            const double *x = all + dim * i, *y = all + dim * (size_t) f->node[e];
            int above = n[0] * x[0] + n[1] * x[1] > 0, other = n[0] * y[0] + n[1] * y[1] > 0;
            if (above != other) r->state->alive[e] = 0;
        }
}

/* Energy, work of friction, mean pressure and slip of all pieces. */
typedef struct { double energy, friction, pressure, slip; } borne;
static borne borne_by (run *r, size_t dim)
{
    size_t n;
    double area = 0;
    to_the_end (r);
    const pg_statistics *s = pg_solver_report_now (r->solver);
    const pg_contact_values *v = pg_solver_contact (r->solver, &n);
    borne out = { .energy = s->energy.strain, .friction = s->energy.friction };
    for (size_t k = 0; k < n; k++) {
        double slip = 0;
        for (size_t c = 0; c < (dim == 3 ? 3 : 1); c++) slip += v[k].slip[c] * v[k].slip[c];
        area += v[k].area, out.pressure += v[k].area * v[k].pressure, out.slip += v[k].area * sqrt (slip);
    }
    if (n) out.pressure /= area, out.slip /= area;
    return out;
}

/* Pressed, and held by friction, it is the whole body; dragged, or pressed on a slope, it slides as along a
 * crack of the scene. lps with weighted volumes of live bonds is stiffer in its skin, as at that crack.
 * PERIGAL_TEST_SIZE=long: held by friction in space, too. */
static void a_body_cut_in_two (void **state)
{
    (void) state;
    static const struct { block l; double whole, slip; } row[] = {
        { { 2, 0, 0, -0.01, 0, "{force: bond}", "{kind: normal}", NULL }, 0.01, 0 },
        { { 2, 0, 0.2, -0.01, 0, "{force: bond}", "{kind: friction, coefficient: 5}", NULL }, 0.01, 0 },
        { { 2, 25, 0, -0.01, 0, "{force: bond}", "{kind: friction, coefficient: 5}", NULL }, 0.01, 0 },
        { { 3, 20, 0, -0.01, 0, "{force: bond}", "{kind: friction, coefficient: 5}", NULL }, 0.02, 0 },
        { { 2, 25, 0.2, -0.01, 0, "{force: lps, weighted_volume: live}", "{kind: friction, coefficient: 5}",
            NULL }, 0.06, 0 },
        { { 2, 0, 0, -0.01, 0.02, "{force: bond}", "{kind: normal}", NULL }, 0, 1e-3 },
        { { 2, 0, 0, -0.01, 0.02, "{force: bond}", "{kind: friction, coefficient: 0.2}", NULL }, 0, 0.01 },
        { { 2, 25, 0, -0.01, 0, "{force: bond}", "{kind: normal}", NULL }, 0, 0.03 },
        { { 2, 25, 0, -0.01, 0, "{force: gmpd}", "{kind: friction, coefficient: 0.2}", NULL }, 0, 0.06 },
        { { 3, 20, 0, -0.01, 0, "{force: bond}", "{kind: friction, coefficient: 0.1}", NULL }, 0, 0.03 },
    };
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        borne of[3];
        block l = row[i].l;
        if (!longer () && l.dim == 3 && row[i].whole > 0) continue;
        l.solver = fixed;
        for (int way = WHOLE; way <= FOUND; way++) {
            run r = block_of (&l, way);
            if (way == FOUND) cut (&r, l.tilt);
            of[way] = borne_by (&r, (size_t) l.dim);
            clear (&r);
        }
        print_message ("%dD %s, slope %g, moved %g, drag %g, %s: energy over that of the whole body %.4f "
                       "(crack) and %.4f (bonds), pressure %.4f and %.4f, slip %.5f and %.5f, friction %.3g "
                       "and %.3g\n", l.dim, l.method, l.tilt, l.perturb, l.drag, l.contact,
                       of[KNOWN].energy / of[WHOLE].energy, of[FOUND].energy / of[WHOLE].energy,
                       of[KNOWN].pressure, of[FOUND].pressure,
                       of[KNOWN].slip, of[FOUND].slip, of[KNOWN].friction, of[FOUND].friction);
        if (row[i].whole > 0) check_relative (of[FOUND].energy, of[WHOLE].energy, row[i].whole);
        if (row[i].whole > 0) assert_true (of[FOUND].slip < 1e-12);
        if (row[i].slip > 0) check_relative (of[FOUND].slip, of[KNOWN].slip, row[i].slip);
        check_relative (of[FOUND].energy, of[KNOWN].energy, 0.06);
        check_scaled (of[FOUND].friction, of[KNOWN].friction, 0.06, of[KNOWN].energy);
    }
}

/* Points that have lost all their bonds lie between the faces: nothing holds them, and they bear nothing. */
static void rubble_bears_nothing (void **state)
{
    (void) state;
    block l = { 2, 0, 0, -0.01, 0, "{force: bond}", "{kind: normal}", fixed };
    run r = block_of (&l, WHOLE), f = block_of (&l, FOUND);
    const pg_family *family = &f.problem->bonds.rows[PG_NODES].family;
    double whole = borne_by (&r, 2).energy;
    size_t loose = 0;
    cut (&f, 0);
    for (size_t i = 0; i < f.problem->cloud.n; i++) {
        const double *x = f.problem->cloud.x + 2*i;
        if (x[1] < 0 || x[1] > 0.1 || fabs (x[0]) > 0.11) continue;
        loose++;
        for (size_t k = 0; k < f.problem->cloud.n; k++)
            for (size_t e = family->start[k]; e < family->start[k + 1]; e++)
                if (k == i || (size_t) family->node[e] == i) f.state->alive[e] = 0;
    }
    assert_true (loose >= 2);
    double energy = borne_by (&f, 2).energy;
    print_message ("%zu loose points between the faces: energy over that of the whole body %.4f\n", loose,
                   energy / whole);
    assert_true (energy < whole && energy > 0.9 * whole);
    clear (&r), clear (&f);
}

/* A block with two notches, drawn apart until it has broken, then pressed. */
static run notched (const char *failure, const char *table, const char *solver, int threads)
{
    return scene_of (threads,
        "dimension: 2\nplane: stress\nthickness: 1\nbody: [{add: {box: {low: [-1, -1], high: [1, 1]}}}]\n"
        "spacing: 0.1\nlattice: cells\n"
        "cracks: [{from: [-2, 0.02], to: [-0.5, 0.02]}, {from: [0.5, 0.02], to: [2, 0.02]}]\n"
        "materials: {m: {youngs_modulus: 1000, poissons_ratio: 0.3333333333333333, density: 1}}\n"
        "method: {force: bond}\n%scontact: {kind: friction, coefficient: 0.3}\nboundary:\n"
        "  - {set: top, displacement: {x: 0, y: 0.02}, table: %s}\n"
        "  - {set: bottom, displacement: {x: 0, y: 0}}\nsolver: %s\noutput: {at: {levels: 1}}\n", failure,
        table, solver);
}

/* What breaks in tension closes when the load turns round, and bears as the notched body does whose notches
 * alone are cracks; what breaking took stays what it was. By relaxation other bonds break, more of them. */
static void what_broke_closes (void **state)
{
    (void) state;
    static const char *const ways[] = { "{kind: static, stepping: fixed, steps: 12}",
                                        "{kind: adr, stages: 12, imbalance: 1e-9}",
                                        "{kind: relax, stages: 12, imbalance: 1e-9}" };
    run whole = notched ("", "[[0, 0], [1, -0.1]]", fixed, 1);
    to_the_end (&whole);
    double stored = pg_solver_report_now (whole.solver)->energy.strain;
    clear (&whole);
    for (int w = 0; w < 3; w++) {
        run r = notched ("failure: {criterion: stretch, critical_stretch: 4e-3}\n",
                         "[[0, 0], [0.5, 1], [0.9166666666666667, 0], [1, -0.1]]", ways[w], 1 + w % 2);
        for (int step = 0; step < 8; step++) advance (&r);
        const pg_statistics *s = pg_solver_report_now (r.solver);
        double taken = s->energy.dissipated;
        long broken = r.state->broken;
        assert_true (broken > 300 && s->energy.strain < 0.02 * taken && s->contact.overlap_max == 0);
        to_the_end (&r);
        s = pg_solver_report_now (r.solver);
        print_message ("%s: %ld bonds broken, stored %.4f of the body without a crack between the notches, "
                       "overlap %.1e spacings, taken by breaking %.12g then %.12g, friction %.1e\n", ways[w],
                       r.state->broken / 2, s->energy.strain / stored, s->contact.overlap_max / 0.1, taken,
                       s->energy.dissipated, s->energy.friction);
        assert_int_equal (r.state->broken, broken);
        check_relative (s->energy.strain, stored, w ? 0.04 : 0.03);
        check_relative (s->energy.dissipated, taken, 1e-9);
        assert_true (s->contact.overlap_max < (w ? 3e-3 : 1e-3) * 0.1);
        clear (&r);
    }
}

/* Linear systems, by factor and by iterations, event stepping and two ways of relaxation come to one
 * equilibrium, friction and its work included. */
static void all_ways_lead_to_one_equilibrium (void **state)
{
    (void) state;
    static const char *const ways[] = {
        "{kind: static, stepping: fixed, steps: 2, linear: cholmod}",
        "{kind: static, stepping: fixed, steps: 2}", "{kind: static, stepping: event}",
        "{kind: adr, stages: 2, imbalance: 1e-10}", "{kind: relax, stages: 2, imbalance: 1e-10}"
    };
    static const char *const forces[] = { "{force: bond}", "{force: lps, weighted_volume: live}" };
    for (size_t f = 0; f < 2; f++) {
        faces first = { 0 };
        double friction = 0;
        for (size_t w = f; w < 5; w++) {               /* lps has no matrix */
            plate l = { 45, f ? 0 : 0.1, 1.0 / 3, 1, "stress", forces[f],
                        "{kind: friction, coefficient: 0.3}", ways[w], 5, 1 + w % 2 };
            run known = plate_of (&l, 1), r = plate_of (&l, 0);
            break_as (&known, &r);
            to_the_end (&r);
            const pg_statistics *s = pg_solver_report_now (r.solver);
            faces now = faces_of (&r, l.beta);
            if (first.pressure == 0) first = now, friction = s->energy.friction;
            check_relative (now.pressure, first.pressure, 1e-6);
            check_relative (now.slip, first.slip, 1e-6);
            /* relaxation has begun without the faces: they count as new, with friction from the beginning */
            if (w < 3) {
                check_scaled (s->energy.external - s->energy.strain - s->energy.friction, 0, 1e-7,
                              s->energy.external);
                check_relative (s->energy.friction, friction, 1e-6);
            }
            assert_true (friction > 0 && s->contact.sliding > 0);
            clear (&known), clear (&r);
        }
    }
}

/* Read back among closing faces, a run goes on to the last bit. */
static void runs_go_on_bit_by_bit (void **state)
{
    (void) state;
    static const char *const ways[] = { "{kind: static, stepping: fixed, steps: 12}",
                                        "{kind: adr, stages: 12}" };
    for (size_t w = 0; w < 2; w++) {
        run r[2];
        tape t = { 0 };
        for (int k = 0; k < 2; k++)
            r[k] = notched ("failure: {criterion: stretch, critical_stretch: 4e-3}\n",
                            "[[0, 0], [0.5, 1], [0.75, 0], [1, -0.15]]", ways[w], 1 + k);
        for (int k = 0; k < 10; k++) advance (&r[0]);
        keep (&r[0], &t, 0);
        keep (&r[1], &t, 1);
        while (!pg_solver_done (r[0].solver, r[0].state)) advance_alike (&r[0], &r[1]);
        const pg_statistics *a = pg_solver_report_now (r[0].solver), *b = pg_solver_report_now (r[1].solver);
        assert_true (a->energy.friction == b->energy.friction && a->energy.strain == b->energy.strain);
        assert_true (a->contact.open < a->contact.pieces && a->energy.strain > 0);
        pg_free (t.byte);
        clear (&r[0]), clear (&r[1]);
    }
}

/* Wings of a closed crack of broken bonds, event by event: the load of the first is that of the same crack of
 * the scene, and later ones break one by one with faces that are found anew at each. */
static void wings_leave_broken_bonds (void **state)
{
    (void) state;
    double load[2];
    for (int k = 0; k < 2; k++) {
        plate l = { 45, 0, 1.0 / 3, 1, "stress", "{force: bond}", "{kind: friction, coefficient: 0.2}",
                    "{kind: static, stepping: event, max_events: 12}", 6, 1 };
        run known = plate_of (&l, 1), r = wings_of (&l, k);
        if (!k) break_as (&known, &r);
        long before = 0;
        for (size_t i = 0; i < r.state->nbond; i++) before += !r.state->alive[i];
        /* bonds that the crack of the scene cuts are its own */
        pg_contact_pieces pieces;
        check_ok (pg_contact_pieces_create (&pieces, r.problem, r.state));
        check_ok (pg_contact_add_broken (&pieces, r.problem, r.state));
        assert_int_equal (pieces.nknown, k ? pieces.n : 0);
        assert_true (pieces.n > 4 && (k ? pieces.nbroken == 0 : pieces.nbroken > 50));
        pg_contact_pieces_clear (&pieces);
        advance (&r);
        load[k] = r.step.factor;
        to_the_end (&r);
        assert_true (r.state->events >= 10 && r.state->broken >= 10 && before > 100);
        const pg_statistics *s = pg_solver_report_now (r.solver);
        assert_true (s->contact.overlap < 1e-12 && s->contact.sliding > 4);
        assert_int_equal (s->bonds_over_limit, 0);
        clear (&known), clear (&r);
    }
    print_message ("first event at %.5f (crack) and %.5f (broken bonds)\n", load[1], load[0]);
    check_relative (load[0], load[1], 0.03);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (a_body_cut_in_two),
        cmocka_unit_test (slips_as_a_crack_of_the_scene),
        cmocka_unit_test (rubble_bears_nothing),
        cmocka_unit_test (what_broke_closes),
        cmocka_unit_test (all_ways_lead_to_one_equilibrium),
        cmocka_unit_test (wings_leave_broken_bonds),
        cmocka_unit_test (runs_go_on_bit_by_bit),
    };
    return cmocka_run_group_tests_name ("contact/broken_faces", tests, NULL, NULL);
}

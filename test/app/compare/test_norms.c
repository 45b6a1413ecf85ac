/* SPDX-License-Identifier: GPL-3.0-or-later
 * Sampling at any place, and norms of a difference that is known. */
#include "../../scene_runs/run.h"

typedef struct { const char *approximation, *integration, *essential, *basis; } method;
static const method methods[] = {
    { "rkpm", "gauss", "nitsche", "linear" },        { "rkpm", "gauss", "nitsche", "quadratic" },
    { "pddo", "gauss", "transformation", "linear" }, { "nosb", "nodal", "transformation", "linear" },
    { "nosb", "gauss", "nitsche", "linear" },        { "rkpm", "nodal", "penalty", "linear" },
};
enum { METHODS = sizeof methods / sizeof *methods };

static run plate (const method *m, const char *more)
{
    return scene_of (
        1,
        "dimension: 2\nthickness: 20 mm\nbody: [{add: {box: {low: [0, 0], high: [1, 0.8]}}}]\nspacing: "
        "0.1\nperturb: {amount: 0.1}\n"
        "materials: {rock: {youngs_modulus: 10 GPa, poissons_ratio: 0.25}}\n"
        "method: {approximation: %s, integration: %s, essential: %s, basis: %s, horizon: %s spacing}\n"
        "boundary:\n  - {set: bottom, displacement: {x: 0, y: 0}}\n  - {set: top, displacement: {x: 0.2 mm, "
        "y: 1 mm}}\n"
        "solver: {stepping: fixed, steps: 1}\noutput: {at: {levels: 1}}\n%s",
        m->approximation, m->integration, m->essential, m->basis, *m->basis == 'q' ? "3.01" : "2.2", more);
}

static void sample (const run *r, const double *d, size_t n, const double *x, double *u, double *s)
{
    void *self;
    const pg_force_type *force = pg_solver_force (r->solver, &self);
    check_ok (force->sample (self, r->state, d ? d : r->state->d, n, x, u, s, NULL));
}

/* At nodes and evaluation points sampling is what the method itself finds there. */
static void nodes_and_points_agree (void **unused)
{
    (void) unused;
    for (int m = 0; m < METHODS; m++) {
        run r = plate (&methods[m], "");
        to_the_end (&r);
        size_t n = r.problem->cloud.n;
        double *u = pg_calloc (3 * n, 8), *s = pg_calloc (6 * n, 8),
               *u_nodes = field_of (&r, NULL, "displacement", NULL),
               *s_nodes = field_of (&r, NULL, "stress", NULL);
        sample (&r, NULL, n, r.problem->cloud.x, u, s);
        double top = largest_of (u_nodes, 2 * n), most = largest_of (s_nodes, 3 * n);
        for (size_t i = 0; i < n; i++) {
            for (size_t k = 0; k < 2; k++) check_scaled (u[3*i + k], u_nodes[2*i + k], 1e-12, top);
            check_scaled (s[6*i], s_nodes[3*i], 1e-11, most);
            check_scaled (s[6*i + 1], s_nodes[3*i + 1], 1e-11, most);
            check_scaled (s[6*i + 3], s_nodes[3*i + 2], 1e-11, most);
            assert_true (u[3*i + 2] == 0 && s[6*i + 2] == 0);
        }
        pg_free (u), pg_free (s), pg_free (u_nodes), pg_free (s_nodes);
        clear (&r);
    }
}

/* Linear coefficients give the linear field and its stress at any place, outside as well; many places at once
 * as one by one. */
static void linear_fields_are_sampled_exactly (void **unused)
{
    (void) unused;
    for (int m = 0; m < METHODS; m++) {
        run r = plate (&methods[m], "");
        refresh (&r, NULL);
        size_t n = r.problem->cloud.n, count = 5000;
        double *d = pg_calloc (2 * n, 8), *x = pg_calloc (2 * count, 8), *u = pg_calloc (3 * count, 8),
               *s = pg_calloc (6 * count, 8);
        for (size_t i = 0; i < n; i++) {
            const double *at = r.problem->cloud.x + 2*i;
            d[2*i] = 1e-3 + 8e-4 * at[0] + 1e-4 * at[1], d[2*i + 1] = -2e-4 * at[0] + 5e-4 * at[1];
        }
        for (size_t i = 0; i < count; i++)
            x[2 * i] = -0.02 + 1.04 * (double) (i % 71) / 70,
                  x[2 * i + 1] = -0.02 + 0.84 * (double) (i % 61) / 60;
        sample (&r, d, count, x, u, s);
        double E = 10e9, nu = 0.25, D = E / (1 - nu * nu);
        for (size_t i = 0; i < count; i++) {
            check_scaled (u[3*i], 1e-3 + 8e-4 * x[2*i] + 1e-4 * x[2*i + 1], 1e-11, 1e-3);
            check_scaled (u[3*i + 1], -2e-4 * x[2*i] + 5e-4 * x[2*i + 1], 1e-11, 1e-3);
            check_relative (s[6*i], D * (8e-4 + nu * 5e-4), 1e-9);
            check_relative (s[6*i + 3], E / (2 * (1 + nu)) * -1e-4, 1e-8);
        }
        double one[3], one_s[6];
        sample (&r, d, 1, x + 2 * 4321, one, one_s);
        assert_memory_equal (one, u + 3 * 4321, sizeof one);
        assert_memory_equal (one_s, s + 6 * 4321, sizeof one_s);
        pg_free (d), pg_free (x), pg_free (u), pg_free (s);
        clear (&r);
    }
}

/* In an intact body no place asks for its nearest points; one bond broken far away makes all of them ask, and
 * changes no bit of what they find. */
static void intact_bodies_are_sampled_like_others (void **unused)
{
    (void) unused;
    for (int m = 0; m < METHODS; m++) {
        run r = plate (&methods[m], "");
        refresh (&r, NULL);
        enum { COUNT = 400 };
        size_t n = r.problem->cloud.n, last = r.problem->bonds.first[PG_NODES + 1] - 1;
        double *d = pg_calloc (2 * n, 8), x[2 * COUNT], u[3 * COUNT], s[6 * COUNT], v[3 * COUNT],
               t[6 * COUNT];
        for (size_t i = 0; i < 2 * n; i++) d[i] = sin ((double) (i * i % 97));
        for (size_t i = 0; i < COUNT; i++)
            x[2 * i] = 0.02 + 0.4 * (double) (i % 20) / 19,
                  x[2 * i + 1] = 0.03 + 0.3 * (double) (i / 20) / 19;
        sample (&r, d, COUNT, x, u, s);
        while (r.problem->bonds.rows[PG_NODES].family.node[last] == (int) n - 1) last--;
        r.state->alive[last] = 0;
        sample (&r, d, COUNT, x, v, t);
        assert_memory_equal (u, v, sizeof u);
        assert_memory_equal (s, t, sizeof s);
        pg_free (d);
        clear (&r);
    }
}

/* Coefficients 0 below y = 0.4 and 1 above: with all bonds across y = 0.4 dead, by a pre-crack or broken
 * later, the field jumps there, and nothing in between appears. */
static void check_jump (run *r)
{
    size_t n = r->problem->cloud.n, count = 400;
    double *d = pg_calloc (2 * n, 8), *x = pg_calloc (2 * count, 8), *u = pg_calloc (3 * count, 8),
           *s = pg_calloc (6 * count, 8);
    for (size_t i = 0; i < n; i++) d[2*i] = r->problem->cloud.x[2*i + 1] > 0.4;
    for (size_t i = 0; i < count; i++)
        x[2 * i] = ((double) (i % 20) + 0.37) / 20,
              x[2 * i + 1] = 0.4 + (i / 20 % 2 ? 1 : -1) * 0.2 * ((double) (i / 40) + 0.6) / 10;
    sample (r, d, count, x, u, s);
    for (size_t i = 0; i < count; i++) {
        check_absolute (u[3*i], x[2*i + 1] > 0.4 ? 1 : 0, 1e-9);
        check_scaled (s[6*i + 3], 0, 1e-8, 10e9);
    }
    pg_free (d), pg_free (x), pg_free (u), pg_free (s);
}

static run cells_plate (const char *integration, const char *crack)
{
    return scene_of (
        2,
        "dimension: 2\nbody: [{add: {box: {low: [0, 0], high: [1, 0.8]}}}]\nspacing: 0.1\nlattice: cells\n%s"
        "materials: {rock: {youngs_modulus: 10 GPa, poissons_ratio: 0.25}}\n"
        "method: {integration: %s, horizon: 2.2 spacing}\nboundary: [{set: left, displacement: {x: 0, y: "
        "0}}]\nsolver: {stepping: fixed, steps: 1}\n",
        crack, integration);
}

static void faces_of_a_crack_stay_apart (void **unused)
{
    (void) unused;
    for (int k = 0; k < 2; k++) {
        run r = cells_plate (k ? "nodal" : "gauss", "cracks: [{from: [-0.1, 0.4], to: [1.1, 0.4]}]\n");
        refresh (&r, NULL);
        check_jump (&r);
        clear (&r);
        r = cells_plate (k ? "nodal" : "gauss", "");
        for (int s = 0; s < PG_BOND_SETS; s++) {
            const pg_rows *rows = &r.problem->bonds.rows[s];
            for (size_t p = 0; p < rows->n; p++)
                for (size_t e = rows->family.start[p]; e < rows->family.start[p + 1]; e++)
                    if ((rows->x[2 * p + 1] > 0.4)
                        != (r.problem->cloud.x[2 * (size_t) rows->family.node[e] + 1] > 0.4))
                        r.state->alive[r.problem->bonds.first[s] + e] = 0;
        }
        refresh (&r, NULL);
        check_jump (&r);
        clear (&r);
    }
}

/* ---- norms --------------------------------------------------------------------------------------------- */
typedef struct { int which; } form;                    /* u = (x, y) + which (x^2, 0), s = D eps */
static pg_status sample_form (void *context, size_t n, const double *x, double *u, double *stress)
{
    const form *f = context;
    memset (u, 0, 3 * n * sizeof *u);
    if (stress) memset (stress, 0, 6 * n * sizeof *stress);
    for (size_t i = 0; i < n; i++) {
        u[3*i] = x[2*i] + f->which * x[2*i] * x[2*i], u[3*i + 1] = x[2*i + 1];
        if (stress) stress[6*i] = 2 + f->which * x[2*i], stress[6*i + 1] = f->which == 2 ? NAN : 1;
    }
    return PG_OK;
}

/* Difference (x^2, 0) over [0, 2] x [0, 1]: int x^4 = 32/5, |u_ref|^2: int x^2 + y^2 = 8/3 + 2/3; s: x xx
 * against (2, 1, 0). E = 4, nu = 1/4. */
static void known_difference (void **unused)
{
    (void) unused;
    form reference = { 0 }, value = { 1 };
    pg_sampler a = { &value, 2, 3, 15, sample_form, NULL }, b = { &reference, 2, 3, 15, sample_form, NULL };
    double gx[5], gw[5];
    pg_material m = { .mode = PG_PLANE_STRESS };
    pg_elastic_tangent (m.mode, 4, 0.25, m.D);
    pg_gauss_rule (3, gx, gw);
    pg_quadrature q = { .n = 9, .x = pg_calloc (18, 8), .weight = pg_calloc (9, 8) };
    for (size_t i = 0; i < 9; i++) {
        q.x[2*i] = 1 + gx[i % 3], q.x[2*i + 1] = 0.5 + 0.5 * gx[i / 3];
        q.weight[i] = 0.5 * gw[i % 3] * gw[i / 3];
    }
    pg_norms n;
    pg_norm_options o = { &m, NULL, NULL };
    check_ok (pg_norms_measure (&n, &q, &a, &b, &o));
    assert_true (n.displacement && n.stress);
    assert_int_equal (n.places, 9);
    check_relative (n.volume, 2, 1e-14);
    check_relative (n.l2.difference, sqrt (32.0 / 5), 1e-14);
    check_relative (n.l2.relative, sqrt (32.0 / 5 / (10.0 / 3)), 1e-14);
    check_relative (n.energy.difference, sqrt (8.0 / 3 / 4), 1e-13);
    check_relative (n.energy.reference, sqrt (2 * (4 + 1 - 2 * 0.25 * 2) / 4), 1e-13);
    check_relative (n.maximum.difference, pow (1 + gx[2], 2), 1e-14);
    check_relative (n.maximum.place[0], 1 + gx[2], 1e-14);
    check_relative (n.stress_maximum.relative, (1 + gx[2]) / sqrt (5), 1e-14);

    pg_expression *where = NULL;
    check_ok (pg_expression_compile (&where, "x < 1.5", "bool"));
    o.where = where;
    check_ok (pg_norms_measure (&n, &q, &a, &b, &o));
    assert_int_equal (n.skipped, 3);
    o.where = NULL;
    value.which = 2;                                   /* a stress is not known */
    check_ok (pg_norms_measure (&n, &q, &a, &b, &o));
    assert_int_equal (n.places, 0);
    assert_false (n.displacement || n.stress);
    value.which = 0;
    check_ok (pg_norms_measure (&n, &q, &a, &b, &o));
    assert_true (n.l2.relative == 0 && n.energy.relative == 0);
    b.dim = 3;
    check_fails (pg_norms_measure (&n, &q, &a, &b, &o), PG_E_USAGE);
    pg_expression_free (&where);
    pg_free (q.x), pg_free (q.weight);
}

static pg_errors measured (run *r)
{
    pg_reference *reference;
    pg_sampler solution;
    pg_errors e;
    void *self;
    const pg_force_type *force = pg_solver_force (r->solver, &self);
    check_ok (pg_reference_read (&reference, r->scene, r->problem));
    assert_non_null (reference);
    check_ok (pg_sampler_solution (&solution, r->problem, force, self, r->state));
    check_ok (pg_errors_measure (&e, reference, r->problem, &solution, 1));
    pg_sampler_clear (&solution);
    pg_reference_free (&reference);
    return e;
}

/* Coefficients linear: u_h is the linear field itself; the reference adds (c x^2, 0), so the difference is
 * exactly that. */
static void perturbed_patch (void **unused)
{
    (void) unused;
    static const char *const reference =
        "reference:\n  displacement: {x: \"1e-3*x + 1e-4 m^-1 * x^2\", y: \"2e-3*y\"}\n"
        "  stress: {xx: \"10e9 Pa/0.9375*(1.5e-3 + 1e-3 m^-1 * x)\", yy: \"10e9 Pa/0.9375*2.25e-3\", xy: 0 "
        "Pa}\n";
    pg_errors first = { 0 };
    for (int points = 1; points <= 3; points++) {
        char text[600];
        snprintf (text, sizeof text, "%s", reference);
        run r = plate (&methods[0], text);
        refresh (&r, NULL);
        for (size_t i = 0; i < r.problem->cloud.n; i++)
            r.state->d[2 * i] = 1e-3 * r.problem->cloud.x[2 * i],
                           r.state->d[2 * i + 1] = 2e-3 * r.problem->cloud.x[2 * i + 1];
        pg_errors e = measured (&r);
        assert_int_equal (e.order, 4);
        double V = 0.8 * 0.02, ref2 = 0.02 * (0.8 * (1e-6 / 3 + 2 * 1e-7 / 4 + 1e-8 / 5) + 4e-6 * 0.512 / 3);
        check_relative (e.norms.volume, V, 1e-12);
        check_relative (e.norms.l2.difference, sqrt (1e-8 / 5 * V), 1e-9);
        check_relative (e.norms.l2.reference, sqrt (ref2), 1e-12);
        check_relative (e.norms.energy.difference, 1e7 / 0.9375 * sqrt (V / 3 / 10e9), 1e-9);
        check_relative (e.norms.maximum.difference, 1e-4, 1e-9);       /* at the nodes of x = 1 */
        check_relative (e.norms.maximum.place[0], 1, 1e-9);
        assert_non_null (e.difference);
        if (points == 1) first = e;
        else {
            assert_memory_equal (&first.norms, &e.norms, sizeof first.norms);      /* the same again */
            pg_errors_clear (&e);
        }
        clear (&r);
    }
    pg_errors_clear (&first);
}

static pg_status sample_at (void *context, size_t n, const double *x, double *u, double *stress)
{
    const double *size = context;  /* of the components (6); they grow along x */
    (void) u;
    for (size_t i = 0; stress && i < n; i++)
        for (size_t k = 0; k < 6; k++) stress[6 * i + k] = size[k] * (1 + x[2 * i]);
    return PG_OK;
}

/* Cells taken in parts, of two materials: the norms are those over all places at once. */
static void cells_in_parts (void **unused)
{
    (void) unused;
    run r = scene_of (
        1, "dimension: 2\nbody: [{add: {box: {low: [0, 0], high: [1, 0.7]}}}]\nspacing: 0.021\n"
           "materials:\n  soft: {youngs_modulus: 10 GPa, poissons_ratio: 0.25}\n"
           "  stiff: {youngs_modulus: 30 GPa, poissons_ratio: 0.2}\n"
           "blocks:\n  - {material: soft, where: 'x >= 0.31'}\n  - {material: stiff, where: 'x < 0.31'}\n"
           "solver: {stepping: fixed, steps: 1}\n");
    double size[2][6] = { { 5, -2, 7, 3, 4, -6 }, { 1, 1, 2, -1, 1, 1 } };
    pg_sampler a = { size[0], 2, 0, 63, sample_at, NULL }, b = { size[1], 2, 0, 63, sample_at, NULL };
    pg_quadrature q;
    pg_norms parts, whole;
    int *which = NULL;
    check_ok (pg_cell_points (&q, &r.problem->cells, r.problem->cloud.thickness, 5));
    assert_true (q.n > 2 * 16384);
    which = pg_calloc (q.n, sizeof *which);
    for (size_t i = 0; i < q.n; i++) which[i] = q.x[2*i] < 0.31;
    check_ok (pg_norms_measure (&whole, &q, &a, &b,
                                &(pg_norm_options){ r.problem->material, which, NULL }));
    check_ok (pg_norms_of_cells (&parts, r.problem, 5, NULL, &a, &b));
    assert_int_equal (parts.places, q.n);
    check_relative (parts.volume, 0.7 * r.problem->cloud.thickness, 1e-12);
    check_relative (parts.energy.difference, whole.energy.difference, 2e-3);   /* cells astride 0.31 */
    check_relative (parts.stress_maximum.difference, whole.stress_maximum.difference, 0);
    check_relative (parts.stress_maximum.place[0], 1, 1e-2);
    pg_quadrature_clear (&q), pg_free (which);
    clear (&r);
}

/* The size of a stress difference is that of the tensor: each shear stands for two components. */
static pg_status sample_shears (void *context, size_t n, const double *x, double *u, double *stress)
{
    const double *size = context;  /* of the components (6); they grow from place to place */
    (void) x, (void) u;
    for (size_t i = 0; stress && i < n; i++)
        for (size_t k = 0; k < 6; k++) stress[6 * i + k] = size[k] * (1 + (double) i);
    return PG_OK;
}

static void shears_count_twice_in_the_largest_stress (void **unused)
{
    (void) unused;
    static const pg_mode modes[4] = { PG_LINE, PG_LINE, PG_PLANE_STRESS, PG_SOLID };
    for (int dim = 1; dim <= 3; dim++) {
        double value[6] = { 5, -2, 7, 3, 4, -6 }, reference[6] = { 1, 1, 2, -1, 1, 1 }, want[2] = { 0 };
        for (int a = 0; a < dim; a++)
            for (int b = 0; b < dim; b++) {
                static const int voigt[3][3] = { { 0, 3, 5 }, { 3, 1, 4 }, { 5, 4, 2 } };
                int k = voigt[a][b];
                want[0] += (value[k] - reference[k]) * (value[k] - reference[k]),
                    want[1] += reference[k] * reference[k];
            }
        pg_sampler a = { value, dim, 0, 63, sample_shears, NULL },
                   b = { reference, dim, 0, 63, sample_shears, NULL };
        double x[9] = { 0, 1, 2, 3, 4, 5, 6, 7, 8 }, weight[3] = { 1, 1, 1 };
        pg_material m = { .mode = modes[dim] };
        pg_elastic_tangent (m.mode, 4, 0, m.D);
        pg_quadrature q = { .n = 3, .x = x, .weight = weight };
        pg_norms n;
        pg_norm_options o = { &m, NULL, NULL };
        check_ok (pg_norms_measure (&n, &q, &a, &b, &o));
        assert_true (n.stress && !n.displacement);
        check_relative (n.stress_maximum.difference, 3 * sqrt (want[0]), 1e-14);
        check_relative (n.stress_maximum.reference, 3 * sqrt (want[1]), 1e-14);
        for (int k = 0; k < dim; k++) check_relative (n.stress_maximum.place[k], x[2 * dim + k], 0);
    }
}

/* Two materials in a row: each place has the law of its own side. */
static void energy_of_two_materials (void **unused)
{
    (void) unused;
    run r = scene_of (
        1,
        "dimension: 1\nbody: [{add: {box: {low: [0], high: [1]}}}]\nspacing: 0.1\nblocks: [{material: soft, "
        "where: x < 0.5}, {material: hard, where: x >= 0.5}]\n"
        "materials: {soft: {youngs_modulus: 1 GPa, poissons_ratio: 0}, hard: {youngs_modulus: 4 GPa, "
        "poissons_ratio: 0}}\n"
        "method: {integration: gauss, horizon: 2.2 spacing}\nboundary: [{set: left, displacement: {x: 0}}]\n"
        "reference: {stress: {xx: 4 MPa}}\n");
    refresh (&r, NULL);
    memset (r.state->d, 0, r.state->ndof * sizeof *r.state->d);
    pg_errors e = measured (&r);
    assert_false (e.norms.displacement);
    assert_true (e.norms.stress);
    check_relative (e.norms.energy.difference, sqrt (0.5 * 16e12 / 1e9 + 0.5 * 16e12 / 4e9), 1e-12);
    check_relative (e.norms.energy.relative, 1, 1e-12);
    pg_errors_clear (&e);
    clear (&r);
}

/* Nothing against nothing is no difference; a component that one side does not know does not count. */
static pg_status sample_pair (void *context, size_t n, const double *x, double *u, double *stress)
{
    const double *value = context;                     /* u_x, u_y */
    (void) x, (void) stress;
    for (size_t i = 0; i < n; i++) u[3*i] = value[0], u[3*i + 1] = value[1], u[3*i + 2] = 0;
    return PG_OK;
}

static void what_is_not_there_does_not_count (void **unused)
{
    (void) unused;
    double none[2] = { 0, 0 }, one[2] = { 3, 7 }, other[2] = { 2, 5 }, x[4] = { 0, 0, 1, 1 },
           weight[2] = { 1, 1 };
    pg_quadrature q = { .n = 2, .x = x, .weight = weight };
    pg_norm_options o = { NULL, NULL, NULL };
    pg_norms n;
    pg_sampler a = { none, 2, 3, 0, sample_pair, NULL }, b = a;
    check_ok (pg_norms_measure (&n, &q, &a, &b, &o));
    assert_true (n.displacement && n.l2.relative == 0 && n.maximum.relative == 0);
    a.context = one;
    check_ok (pg_norms_measure (&n, &q, &a, &b, &o));
    assert_true (isinf (n.l2.relative));
    a.displacement = 1, b.context = other;             /* u_x alone: 3 against 2 */
    check_ok (pg_norms_measure (&n, &q, &a, &b, &o));
    check_relative (n.l2.difference, sqrt (2), 1e-14);
    check_relative (n.l2.relative, 0.5, 1e-14);
    check_relative (n.maximum.difference, 1, 1e-14);
}

/* A result moved by (2, -1) and doubled: places, displacements and stresses. */
static void a_moved_result (void **unused)
{
    (void) unused;
    form f = { 1 };
    pg_sampler plain = { &f, 2, 3, 15, sample_form, NULL }, s;
    double x[2] = { 2.5, 0.25 }, u[3], stress[6];
    check_ok (pg_sampler_moved (&s, &plain, (double[]) { 2, -1, 0 }, 2));
    check_ok (s.sample (s.context, 1, x, u, stress));
    check_relative (u[0], 2 * (0.5 + 0.25), 1e-14);
    check_relative (u[1], 2 * 1.25, 1e-14);
    check_relative (stress[0], 2 * 2.5, 1e-14);
    check_relative (stress[1], 2, 1e-14);
    pg_sampler_clear (&s);
}

/* Displacements at points: least squares between them, each side of a pre-crack for itself, the nearest
 * point's own where bonds are torn. */
static void points_beside_cracks_and_tears (void **unused)
{
    (void) unused;
    run r = cells_plate ("nodal", "cracks: [{from: [-0.1, 0.4], to: [1.1, 0.4]}]\n");
    size_t n = r.problem->cloud.n, nearest = 0;
    double *d = pg_calloc (2 * n, 8), x[4] = { 0.52, 0.41, 0.5, 0.39 }, u[6], stress[12], best = INFINITY;
    unsigned char *torn = pg_calloc (n, 1);
    pg_sampler s;
    for (size_t i = 0; i < n; i++) {
        const double *at = r.problem->cloud.x + 2*i;
        double far = hypot (at[0] - 0.52, at[1] - 0.41);
        d[2*i] = at[1] > 0.4, d[2*i + 1] = at[0];
        if (far < best) best = far, nearest = i;
    }
    check_ok (pg_sampler_points (&s, r.problem, d, NULL));
    check_ok (s.sample (s.context, 2, x, u, stress));
    check_relative (u[0], 1, 1e-9);
    check_absolute (u[3], 0, 1e-9);
    check_relative (u[1], 0.52, 1e-9);
    assert_true (isfinite (stress[0]));
    pg_sampler_clear (&s);
    torn[nearest] = 1;
    check_ok (pg_sampler_points (&s, r.problem, d, torn));
    check_ok (s.sample (s.context, 2, x, u, stress));
    assert_true (u[0] == d[2 * nearest] && u[1] == d[2 * nearest + 1]);
    assert_true (isnan (stress[0]) && isnan (stress[3]));
    pg_sampler_clear (&s);
    pg_free (d), pg_free (torn);
    clear (&r);
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (nodes_and_points_agree),
                                        cmocka_unit_test (intact_bodies_are_sampled_like_others),
        cmocka_unit_test (linear_fields_are_sampled_exactly),
                                        cmocka_unit_test (faces_of_a_crack_stay_apart),
                                        cmocka_unit_test (known_difference),
                                        cmocka_unit_test (perturbed_patch),
                                        cmocka_unit_test (shears_count_twice_in_the_largest_stress),
        cmocka_unit_test (cells_in_parts),
                                        cmocka_unit_test (energy_of_two_materials),
                                        cmocka_unit_test (what_is_not_there_does_not_count),
                                        cmocka_unit_test (a_moved_result),
                                        cmocka_unit_test (points_beside_cracks_and_tears) };
    return cmocka_run_group_tests (tests, NULL, NULL);
}

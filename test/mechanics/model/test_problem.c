/* SPDX-License-Identifier: GPL-3.0-or-later
 * The problem: bond sets, what pre-cracks cut, exempt points, the state, names, gauges, and what is
 * refused. */
#include "scenes.h"
#include "mechanics/galerkin/weak_form/galerkin.h"

static void bond_sets_are_numbered_through (void **state)
{
    (void) state;
    built b = build (PLATE "boundary: [{set: right, displacement: {x: 1}}]\n");
    const pg_problem *p = b.problem;
    assert_int_equal (p->cloud.n, 11 * 6);
    assert_int_equal (p->bonds.rows[PG_NODES].n, p->cloud.n);
    assert_int_equal (p->bonds.rows[PG_POINTS].n, 10 * 5 * 4);
    assert_int_equal (p->bonds.rows[PG_FACETS].n, 5 * 2);    /* only the facets of the support */
    assert_int_equal (p->bonds.first[0], 0);
    for (int s = 0; s < PG_BOND_SETS; s++)
        assert_int_equal (p->bonds.first[s + 1] - p->bonds.first[s],
                          p->bonds.rows[s].family.start[p->bonds.rows[s].n]);
    for (int s = 0; s < PG_BOND_SETS; s++)
        assert_true (!p->bonds.rows[s].N && !p->bonds.rows[s].dN && !p->bonds.rows[s].w
                     && !p->bonds.rows[s].grade);
    for (size_t i = 0; i < p->bonds.rows[PG_FACETS].n; i++)
        check_relative (p->bonds.rows[PG_FACETS].x[2 * i], 1, 1e-14);
    unbuild (&b);
}

static void weights_are_the_volume_of_the_body (void **state)
{
    (void) state;
    built b = build (PLATE "boundary: [{set: right, displacement: {x: 1}}]\n");
    double sum[PG_BOND_SETS] = { 0 };
    for (int s = 0; s < PG_BOND_SETS; s++)
        for (size_t i = 0; i < b.problem->bonds.rows[s].n; i++) sum[s] += b.problem->bonds.rows[s].weight[i];
    check_relative (sum[PG_NODES], 0.1, 1e-14);
    check_relative (sum[PG_POINTS], 0.1, 1e-14);
    check_relative (sum[PG_FACETS], 0.1, 1e-14);       /* 0.5 m edge, 0.2 m thick */
    unbuild (&b);
}

static void nodal_integration_has_no_points (void **state)
{
    (void) state;
    built b = build (PLATE "method: {integration: nodal, approximation: nosb}\n");
    assert_int_equal (b.problem->bonds.rows[PG_POINTS].n, 0);
    assert_int_equal (b.problem->bonds.rows[PG_FACETS].n, 0);
    /* auto: nosb with nodal integration */
    assert_true (((const galerkin_options *) b.problem->options)->silling > 0);
    unbuild (&b);
    b = build (PLATE "method: {integration: nodal, approximation: pddo}\n");
    assert_true (((const galerkin_options *) b.problem->options)->silling == 0);
    unbuild (&b);
}

/* Cuts of PLATE with this crack and method against those of a crack along x = 0.55 from `low` to `high`; of
 * the bonds that pass 1e-6 from its ends nothing is said. */
static void check_cuts (const char *crack, const char *method, double low, double high)
{
    char text[600];
    snprintf (text, sizeof text,
              PLATE "cracks: [%s]\nmethod: {%s}\nboundary: [{set: top, displacement: {x: 1}}]\n", crack,
              method);
    built b = build (text);
    const pg_problem *p = b.problem;
    pg_state *s = NULL;
    size_t dead = 0, alive = 0;
    check_ok (pg_state_create (&s, p, 2));
    for (int set = 0; set < PG_BOND_SETS; set++)
        for (size_t q = 0; q < p->bonds.rows[set].n; q++)
            for (size_t e = p->bonds.rows[set].family.start[q]; e < p->bonds.rows[set].family.start[q + 1];
                 e++) {
                const double *x = p->bonds.rows[set].x + 2 * q,
                             *y = p->cloud.x + 2 * (size_t) p->bonds.rows[set].family.node[e];
                double at = (0.55 - x[0]) / (y[0] - x[0]), height = x[1] + at * (y[1] - x[1]);
                int crosses = (x[0] - 0.55) * (y[0] - 0.55) < 0;
                if (crosses && (fabs (height - low) < 1e-6 || fabs (height - high) < 1e-6)) continue;
                int expected = !(crosses && height > low && height < high);
                assert_int_equal (s->alive[p->bonds.first[set] + e], expected);
                dead += !expected, alive += expected;
            }
    assert_true (dead > 50 && alive > 1000);
    assert_int_equal (p->crack.eroded, 0);
    pg_state_free (&s);
    assert_null (s);
    unbuild (&b);
}

/* The plate is 0.5 m high, its points 0.1 m apart: the crack ends beyond its upper edge. */
static void a_crack_cuts_what_crosses_it (void **state)
{
    static const char edge[] = "{from: [0.55, 0.2], to: [0.55, 0.6]}",
                      back[] = "{from: [0.55, 0.6], to: [0.55, 0.2]}";
    (void) state;
    check_cuts (edge, "tip_offset: 0", 0.2, 2);
    check_cuts (edge, "tip_offset: 0 mm, force: galerkin", 0.2, 2);
    check_cuts (edge, "tip_offset: 0.5 spacing", 0.25, 2);
    check_cuts (edge, "tip_offset: 31 mm", 0.231, 2);
    check_cuts (edge, "basis: linear", 0.226, 2);          /* measured at a horizon of 2 */
    check_cuts (back, "basis: linear", 0.226, 2);
    check_cuts (edge, "horizon: 2.25 spacing", 0.2355, 2); /* between two that were */
    check_cuts (edge, "force: bond", 0.2, 2);
    check_cuts ("{from: [0.55, 0.2], to: [0.55, 0.44]}", "basis: linear", 0.226, 0.414);
    /* within half a spacing of the edge */
    check_cuts ("{from: [0.55, 0.2], to: [0.55, 0.47]}", "basis: linear", 0.226, 0.47);
    /* short: a quarter of it */
    check_cuts ("{from: [0.55, 0.1], to: [0.55, 0.15]}, {from: [0.55, 0.15], to: [0.55, 0.4]}",
                "basis: linear", 0.1125, 0.374);
    /* meet as good as */
    check_cuts ("{from: [0.55, 0.1], to: [0.55, 0.3]}, {from: [0.55, 0.3001], to: [0.55, 0.4]}",
                "tip_offset: 20 mm", 0.12, 0.38);
}

#define CUBE \
    "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [1, 1, 1]}}}]\nspacing: 0.2\nmaterials: " \
    "{rock: {youngs_modulus: 10, poissons_ratio: 0.2}}\n"

/* How far behind each edge or rim the bonds are cut. */
static void check_fronts (const char *crack, const char *method, size_t n, const double *expected)
{
    char text[600];
    snprintf (text, sizeof text, CUBE "cracks: [%s]\nmethod: {%s}\n", crack, method);
    built b = build (text);
    const pg_crack *c = &b.problem->crack.given.crack[0];
    assert_non_null (c->retreat);
    for (size_t k = 0; k < n; k++) check_scaled (c->retreat[k], expected[k], 1e-12, 0.2);
    unbuild (&b);
}

/* Fronts are the edges ahead of which the body goes on, whichever way round they are given. */
static void fronts_in_space_retreat (void **state)
{
    (void) state;
    static const char
        through[] = "{polygon: [[-0.1, -0.1, 0.47], [0.6, -0.1, 0.47], [0.6, 1.1, 0.47], [-0.1, 1.1, 0.47]]}",
        back[] = "{polygon: [[-0.1, 1.1, 0.47], [0.6, 1.1, 0.47], [0.6, -0.1, 0.47], [-0.1, -0.1, 0.47]]}",
        inside[] = "{polygon: [[0.2, 0.2, 0.47], [0.8, 0.2, 0.47], [0.8, 0.7, 0.47]]}",
        disc[] = "{disc: {center: [0.5, 0.5, 0.47], normal: [0, 0, 1], radius: 0.3}}",
        small[] = "{disc: {center: [0.5, 0.5, 0.47], normal: [0, 0, 1], radius: 0.11}}";
    check_fronts (through, "tip_offset: 0.5 spacing", 4, (double[]) { 0, 0.1, 0, 0 });
    check_fronts (back, "tip_offset: 0.5 spacing", 4, (double[]) { 0, 0.1, 0, 0 });
    check_fronts (inside, "tip_offset: 0.05", 3, (double[]) { 0.05, 0.05, 0.05 });
    /* small: a share of its size */
    check_fronts (inside, "tip_offset: 1 spacing", 3,
                  (double[]){ 0.25 * sqrt (0.15), 0.25 * sqrt (0.15), 0.25 * sqrt (0.15) });
    check_fronts (disc, "tip_offset: 0.5 spacing", 1, (double[]) { 0.1 });
    check_fronts (small, "tip_offset: 0.5 spacing", 1, (double[]) { 0.055 });
    check_fronts (disc, "basis: linear, horizon: 2 spacing", 1, (double[]) { 0.052 });
    check_fronts (disc, "approximation: pddo, basis: linear, horizon: 2 spacing", 1, (double[]) { 0.064 });
    check_fronts (disc, "approximation: nosb, basis: linear, horizon: 2.25 spacing", 1, (double[]) { 0.085 });
    check_fronts (disc, "integration: nodal, approximation: pddo, basis: linear, horizon: 2 spacing", 1,
                  (double[]){ 0.05 });
}

static void a_bond_is_found_again_by_its_number (void **state)
{
    (void) state;
    built b = build (PLATE "boundary: [{set: right, displacement: {x: 1}}]\n");
    const pg_problem *p = b.problem;
    for (int set = 0; set < PG_BOND_SETS; set++)
        for (size_t q = 0; q < p->bonds.rows[set].n; q++)
            for (size_t e = p->bonds.rows[set].family.start[q]; e < p->bonds.rows[set].family.start[q + 1];
                 e++) {
                int found;
                size_t point;
                pg_problem_locate (p, p->bonds.first[set] + e, &found, &point);
                assert_true (found == set && point == q);
            }
    unbuild (&b);
}

/* Young's modulus of the scene, Poisson's ratio of the bonds. */
static void bonds_have_the_tangent_of_their_own_ratio (void **state)
{
    (void) state;
    static const struct {
        const char *text;
        int strain;
    } plates[] = { { PLATE "plane: stress\nmethod: {force: bond}\n", 0 },
                   { PLATE "plane: strain\nmethod: {force: bond}\n", 1 } };
    for (int k = 0; k < 2; k++) {
        built b = build (plates[k].text);
        const double *D = b.problem->material[0].D, E = 10, nu = k ? 0.25 : 1. / 3,
                     low = plates[k].strain ? (1 + nu) * (1 - 2 * nu) : 1 - nu * nu;
        check_relative (D[0], E * (plates[k].strain ? 1 - nu : 1) / low, 1e-12);
        check_relative (D[1], E * nu / low, 1e-12);
        check_relative (D[4], D[0], 1e-12);
        check_relative (D[8], E / (2 * (1 + nu)), 1e-12);
        unbuild (&b);
    }
}

static void excluded_sets_exempt_what_is_near (void **state)
{
    (void) state;
    built b = build (PLATE "failure: {criterion: stretch, critical_stretch: 0.1, exclude: [grip, "
                           "left]}\nsets: {grip: {where: \"x > 0.75\"}}\n");
    const pg_problem *p = b.problem;
    for (size_t i = 0; i < p->cloud.n; i++)
        assert_int_equal (p->bonds.exempt[PG_NODES][i], p->cloud.x[2 * i] > 0.75 || p->cloud.x[2 * i] < 0.01);
    for (size_t i = 0; i < p->bonds.rows[PG_POINTS].n; i++) {
        double x = p->bonds.rows[PG_POINTS].x[2*i];
        assert_int_equal (p->bonds.exempt[PG_POINTS][i], x > 0.75 || x < 0.05);
    }
    unbuild (&b);
}

static void a_state_can_be_copied_and_compared (void **state)
{
    (void) state;
    built b = build (PLATE),
          other = build ("dimension: 1\nbody: [{add: {box: {low: [0], high: [1]}}}]\nspacing: 0.1\n"
                         "materials: {m: {youngs_modulus: 1, poissons_ratio: 0}}\n");
    pg_state *s = NULL, *t = NULL, *alien = NULL;
    check_ok (pg_state_create (&s, b.problem, 2));
    check_ok (pg_state_create (&t, b.problem, 2));
    check_ok (pg_state_create (&alien, other.problem, 1));
    assert_int_equal (s->ndof, 132);
    assert_int_equal (s->nbond, b.problem->bonds.first[PG_BOND_SETS]);
    for (size_t i = 0; i < s->ndof; i++)
        s->d[i] = (double) i, s->v[i] = 2.0 * (double) i, s->a[i] = 3.0 * (double) i;
    s->alive[17] = 0, s->time = 4, s->broken = 1;
    check_ok (pg_state_copy (t, s));
    assert_true (t->d != s->d && t->alive != s->alive);
    assert_memory_equal (t->d, s->d, s->ndof * sizeof *s->d);
    assert_memory_equal (t->v, s->v, s->ndof * sizeof *s->d);
    assert_memory_equal (t->a, s->a, s->ndof * sizeof *s->d);
    assert_memory_equal (t->alive, s->alive, s->nbond);
    assert_true (t->time == 4 && t->broken == 1);
    s->d[3] = -1;
    assert_true (t->d[3] == 3);
    check_fails (pg_state_copy (alien, s), PG_E_USAGE);
    pg_state_free (&s), pg_state_free (&t), pg_state_free (&alien);
    unbuild (&b), unbuild (&other);
}

static void name_of (const char *file, const char *expected)
{
    pg_scene *scene = NULL;
    pg_problem *problem = NULL;
    check_ok (pg_scene_parse (&scene, PLATE, file));
    check_ok (pg_problem_build (&problem, scene, 1));
    assert_string_equal (problem->name, expected);
    assert_string_equal (problem->title, expected);
    pg_problem_free (&problem);
    pg_scene_free (&scene);
}

static void a_problem_is_named_after_its_folder_or_file (void **state)
{
    (void) state;
    name_of ("data/plate_1/scene.yaml", "plate_1");
    name_of ("/home/me/plate_2/scene.yaml", "plate_2");
    name_of ("some/where/plate_3.yaml", "plate_3");
    name_of ("plate_4.yaml", "plate_4");
    name_of ("scene.yaml", "scene");
}

static void gauges_are_read (void **state)
{
    (void) state;
    built b = build (PLATE "output: {gauges: [{name: cmod, from: [0.1, 0.2], to: [30 cm, 0.4]}]}\n");
    assert_int_equal (b.problem->boundary.ngauge, 1);
    assert_string_equal (b.problem->boundary.gauge[0].name, "cmod");
    check_relative (b.problem->boundary.gauge[0].to[0], 0.3, 1e-15);
    check_relative (b.problem->boundary.gauge[0].from[1], 0.2, 1e-15);
    unbuild (&b);
}

static void a_body_needs_a_material (void **state)
{
    (void) state;
    check_refused ("dimension: 2\nbody: [{add: {box: {low: [0, 0], high: [1, 0.5]}}}]\nspacing: 0.1\n",
                   "at least one material is needed");
}

static void faults_name_key_and_reason (void **state)
{
    (void) state;
    check_refused (PLATE "failure: {criterion: stretch, critical_stretch: 1, exclude: [nowhere]}\n",
                   "failure.exclude[0] = nowhere: there is no set of this name");
    check_refused (PLATE "method: {stabilization: silling}\n",
                   "silling stabilises nosb with nodal integration");
    check_refused (PLATE "method: {integration: gaus}\n", "did you mean gauss");
    check_refused (PLATE "method: {horizon: -1}\n", "method.horizon");
}

static void each_failed_allocation_is_reported (void **state)
{
    (void) state;
    each_allocation_may_fail (
        PLATE
        "cracks: [{from: [0.55, 0.2], to: [0.55, 0.6]}]\nboundary: [{set: right, displacement: {x: 1}}, "
        "{set: left, traction: {x: 1 Pa/m * y, y: 1}, table: [[0, 0], [1, 1]]}]\n"
        "failure: {criterion: stretch, critical_stretch: 0.1, exclude: [left]}\n"
        "output: {gauges: [{name: cmod, from: [0.1, 0.2], to: [30 cm, 0.4]}]}\n");
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (bond_sets_are_numbered_through),
        cmocka_unit_test (weights_are_the_volume_of_the_body),
        cmocka_unit_test (nodal_integration_has_no_points),
        cmocka_unit_test (a_crack_cuts_what_crosses_it),
        cmocka_unit_test (fronts_in_space_retreat),
        cmocka_unit_test (a_bond_is_found_again_by_its_number),
        cmocka_unit_test (bonds_have_the_tangent_of_their_own_ratio),
        cmocka_unit_test (excluded_sets_exempt_what_is_near),
        cmocka_unit_test (a_state_can_be_copied_and_compared),
        cmocka_unit_test (a_problem_is_named_after_its_folder_or_file),
        cmocka_unit_test (gauges_are_read),
        cmocka_unit_test (a_body_needs_a_material),
        cmocka_unit_test (faults_name_key_and_reason),
        cmocka_unit_test (each_failed_allocation_is_reported),
    };
    return cmocka_run_group_tests_name ("mechanics/model/problem", tests, NULL, NULL);
}

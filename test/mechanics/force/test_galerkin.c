/* SPDX-License-Identifier: GPL-3.0-or-later
 * What weak forms keep beside their sums: bonds that may not break, faces that overlap, cells that stay
 * whole, the modulus that stabilises. */
#include "bond.h"
#include "mechanics/galerkin/weak_form/galerkin.h"

#define PLATE \
    "dimension: 2\nplane: stress\nthickness: 0.2\nbody: [{add: {box: {low: [0, 0], high: [1, " \
    "0.7]}}}]\nspacing: 0.1\nlattice: cells\n" \
    "materials: {rock: {youngs_modulus: 10, poissons_ratio: %g, density: 3}}\n"

static bonded plate (double nu, const char *method, const char *more)
{
    char text[1500];
    snprintf (text, sizeof text, PLATE "method: {%s}\n%s", nu, method, more);
    return bonded_of (text);
}

/* A bond with either end in an excluded set has no utilisation, whichever end; the others have. */
static void what_is_exempt_never_breaks (void **unused)
{
    (void) unused;
    static const char *const integrations[] = { "nodal", "gauss", "consistent" };
    for (int k = 0; k < 3; k++) {
        char method[64];
        snprintf (method, sizeof method, "integration: %s", integrations[k]);
        bonded b = plate (0.2, method,
                          "sets: {grip: {where: x < 0.3}}\nfailure: {criterion: stretch, critical_stretch: "
                          "1e-3, exclude: [grip]}\n");
        double *d = random_vector (b.ndof, 3), *u = pg_calloc (b.state->nbond, sizeof *u);
        char *kind = pg_calloc (b.state->nbond, 1);
        size_t near = 0, far = 0, crossing = 0;
        check_ok (b.force->judge (b.self, b.state, d, &(pg_judging){ .utilisation = u, .kind = kind }));
        for (int set = 0; set < PG_BOND_SETS; set++) {
            const pg_rows *r = &b.problem->bonds.rows[set];
            size_t base = b.problem->bonds.first[set];
            for (size_t p = 0; p < r->n; p++)
                for (size_t e = r->family.start[p]; e < r->family.start[p + 1]; e++) {
                    int own = r->x[2 * p] < 0.3,
                        other = b.problem->cloud.x[2 * (size_t) r->family.node[e]] < 0.3;
                    crossing += own != other;
                    if (own || other) assert_true (u[base + e] == 0), near++;
                    else far += u[base + e] > 0;
                }
        }
        assert_true (near > 100 && far > 100 && crossing > 20);
        pg_free (d), pg_free (u), pg_free (kind);
        unbonded (&b);
    }
}

/* Dead bonds of a body that is pressed together as a whole do not overlap: their ends approach as those of
 * live ones do. Halves apart from each other that are pushed into each other by some length do, by that
 * length. */
static void only_what_is_more_than_elastic_overlaps (void **unused)
{
    (void) unused;
    bonded b = plate (0.2, "integration: gauss", "failure: {criterion: stretch, critical_stretch: 1e-3}\n");
    const pg_rows *r = &b.problem->bonds.rows[PG_NODES];
    double *d = pg_calloc (b.ndof, sizeof *d);
    size_t p = 0, first = 0;
    for (size_t i = 0; i < b.n; i++) if (hypot (r->x[2*i] - 0.45, r->x[2*i + 1] - 0.35) < 0.01) p = i;
    for (size_t e = r->family.start[p]; e < r->family.start[p + 1]; e++)
        if (fabs (r->x[2 * (size_t) r->family.node[e]] - r->x[2 * p] - 0.1) < 1e-6
            && fabs (r->x[2 * (size_t) r->family.node[e] + 1] - r->x[2 * p + 1]) < 1e-6)
            first = e;
    b.state->alive[b.problem->bonds.first[PG_NODES] + first] = 0;
    size_t back = (size_t) r->family.node[first];
    for (size_t e = r->family.start[back]; e < r->family.start[back + 1]; e++)
        if ((size_t) r->family.node[e] == p) b.state->alive[b.problem->bonds.first[PG_NODES] + e] = 0;
    for (size_t i = 0; i < b.n; i++) d[2*i] = -1e-3 * r->x[2*i];
    check_ok (b.force->refresh (b.self, b.state, NULL));
    check_absolute (overlap_of (&b, d) / 1e-4, 0, 1e-9);
    for (size_t i = 0; i < b.n; i++) d[2*i] = 1e-3 * r->x[2*i];
    check_absolute (overlap_of (&b, d) / 1e-4, 0, 1e-9);
    pg_free (d);
    unbonded (&b);

    b = plate (0.2, "integration: gauss",
               "cracks: [{from: [0.5, -0.1], to: [0.5, 0.8]}]\nfailure: {criterion: stretch, "
               "critical_stretch: 1e-3}\n");
    r = &b.problem->bonds.rows[PG_NODES];
    d = pg_calloc (b.ndof, sizeof *d);
    for (size_t i = 0; i < b.n; i++) d[2*i] = r->x[2*i] > 0.5 ? -2e-3 : 0;
    check_relative (overlap_of (&b, d), 2e-3, 1e-9);
    pg_free (d);
    unbonded (&b);
}

/* Halves that a tilted crack has parted: sliding brings the ends of oblique bonds nearer and overlaps
 * nothing, also where the crack opens; what counts is how far the faces have come together along the
 * normal. */
static void sliding_faces_do_not_overlap (void **unused)
{
    (void) unused;
    static const char *const body[] = {
        "dimension: 2\nbody: [{add: {box: {low: [0, 0], high: [1, 1]}}}]\n"
        "cracks: [{from: [-1, 0.13], to: [2, 1.03]}]\n",
        "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [1, 1, 1]}}}]\n"
        "cracks: [{polygon: [[-1, 0.13, -1], [2, 1.03, -1], [2, 1.03, 2], [-1, 0.13, 2]]}]\n"
    };
    /* the crack rises by 0.3 a unit of x */
    const double n[2] = { -0.3 / hypot (1, 0.3), 1 / hypot (1, 0.3) }, t[2] = { n[1], -n[0] };
    /* along the crack, across it, and by how much the faces overlap */
    static const double move[4][3] = {
        { 2e-3, 0, 0 }, { -2e-3, 1e-4, 0 }, { 2e-3, -1e-3, 1e-3 }, { 0, 3e-3, 0 }
    };
    for (int k = 0; k < 2; k++) {
        char text[1024];
        snprintf (text, sizeof text,
                  "%sspacing: 0.1\nmaterials: {rock: {youngs_modulus: 10 GPa, poissons_ratio: 0.2}}\nmethod: "
                  "{integration: gauss}\nboundary: [{set: bottom, displacement: {y: 0}}]\n", body[k]);
        bonded b = bonded_of (text);
        const double *x = b.problem->cloud.x;
        double *d = pg_calloc (b.ndof, sizeof *d);
        size_t dim = (size_t) k + 2;
        for (int m = 0; m < 4; m++) {
            for (size_t i = 0; i < b.n; i++)
                for (size_t a = 0; a < 2; a++)
                    d[i * dim + a] = x[i * dim + 1] > 0.43 + 0.3 * x[i * dim]
                                         ? move[m][0] * t[a] + move[m][1] * n[a] : 0;
            check_absolute (overlap_of (&b, d) / 1e-3, move[m][2] / 1e-3, 1e-9);
        }
        pg_free (d);
        unbonded (&b);
    }
}

/* consistent: where a bond of a cell dies, that cell and those that share a face with it take the direct
 * derivatives, no others. */
static void a_broken_bond_opens_its_cell_and_those_beside (void **unused)
{
    (void) unused;
    bonded b = plate (0.2, "integration: consistent",
                      "failure: {criterion: stretch, critical_stretch: 1e-3}\n");
    const galerkin *g = b.self;
    const pg_consistency *c = b.problem->form.consistency;
    const pg_faces *f = &c->faces;
    const pg_rows *r = &b.problem->bonds.rows[PG_POINTS];
    size_t ncell = 0, cell = 0, open = 0, bond[1];
    assert_non_null (g->whole);
    while (c->first[ncell] < r->n) ncell++;
    cell = ncell / 2;
    for (size_t k = 0; k < ncell; k++) assert_int_equal (g->whole[k], 1);
    bond[0] = b.problem->bonds.first[PG_POINTS] + r->family.start[c->first[cell]];
    b.state->alive[bond[0]] = 0;
    check_ok (b.force->refresh (b.self, b.state, &(pg_changes) { .n = 1, .cap = 1, .bond = bond }));
    for (size_t k = 0; k < ncell; k++) {
        int beside = k == cell;
        for (size_t q = f->of[cell]; q < f->of[cell + 1]; q++)
            for (int side = 0; side < 2; side++) beside |= f->cell[2 * f->face[q] + side] == (int) k;
        assert_int_equal (g->whole[k], !beside);
        open += (size_t) beside;
    }
    assert_int_equal (open, 5);
    unbonded (&b);
}

/* Silling's stabilisation resists with the shear modulus: what it adds to the energy of any displacement
 * falls as 1 / (1 + nu). */
static double energy_of (double nu, const char *stabilization)
{
    char method[128];
    pg_work_balance work_balance = { 0 };
    snprintf (method, sizeof method, "approximation: nosb, integration: nodal, stabilization: %s",
              stabilization);
    bonded b = plate (nu, method, "");
    double *d = random_vector (b.ndof, 11);
    check_ok (b.force->work (b.self, 1, d, NULL, &work_balance));
    double energy = work_balance.strain;
    pg_work_balance_clear (&work_balance);
    pg_free (d);
    unbonded (&b);
    return energy;
}

static void stabilisation_goes_with_the_shear_modulus (void **unused)
{
    (void) unused;
    double soft = energy_of (0.4, "silling") - energy_of (0.4, "none"),
           stiff = energy_of (0, "silling") - energy_of (0, "none");
    assert_true (soft > 0);
    check_relative (stiff / soft, 1.4, 1e-9);
}

/* Forces of inertia at a support are borne by it: its reaction takes them, with their sign. */
static void supports_bear_inertia (void **unused)
{
    (void) unused;
    static const char *const forces[] = { "force: bond", "integration: gauss, essential: transformation",
                                          "force: galerkin, integration: nodal, essential: transformation" };
    for (int k = 0; k < 3; k++) {
        bonded b = plate (
            k ? 0.2 : 1.0 / 3, forces[k],
            "sets: {left_row: {where: x < 0.1}}\nboundary: [{set: left_row, displacement: {x: 0, y: 0}}]\n");
        double *d = random_vector (b.ndof, 5), *inertia = random_vector (b.ndof, 6), sum[2] = { 0 };
        pg_work_balance still = { 0 }, moving = { 0 };
        if (b.force->impose) check_ok (b.force->impose (b.self, 1, d));
        for (size_t i = 0; i < b.n; i++)
            for (size_t c = 0; c < 2; c++) {
                if (b.problem->cloud.x[2*i] < 0.1) sum[c] += inertia[i * b.stride + c];
                else inertia[i * b.stride + c] = 0;
            }
        check_ok (b.force->work (b.self, 1, d, NULL, &still));
        check_ok (b.force->work (b.self, 1, d, &(pg_known){ .inertia = inertia }, &moving));
        for (int c = 0; c < 2; c++)
            check_scaled (moving.reaction[c] - still.reaction[c], -sum[c], 1e-9, fabs (still.reaction[c]));
        pg_work_balance_clear (&still), pg_work_balance_clear (&moving);
        pg_free (d), pg_free (inertia);
        unbonded (&b);
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (what_is_exempt_never_breaks),
                                        cmocka_unit_test (only_what_is_more_than_elastic_overlaps),
                                        cmocka_unit_test (sliding_faces_do_not_overlap),
                                        cmocka_unit_test (a_broken_bond_opens_its_cell_and_those_beside),
                                        cmocka_unit_test (stabilisation_goes_with_the_shear_modulus),
                                        cmocka_unit_test (supports_bear_inertia) };
    return cmocka_run_group_tests_name ("mechanics/force/galerkin", tests, NULL, NULL);
}

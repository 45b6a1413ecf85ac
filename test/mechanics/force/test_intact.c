/* SPDX-License-Identifier: GPL-3.0-or-later
 * Shape functions of the intact body are evaluated once, by the patch test: a force that reads them gives the
 * same bits as one that evaluates its own, before and after bonds break, and leaves them as they were. */
#include "bond.h"
#include "perigal/solve.h"

static const char *const scenes[] = {
    BODY2 "method: {integration: gauss}\n",
    BODY2 "method: {integration: nodal}\n",
    BODY2 "method: {integration: consistent, basis: quadratic, horizon: 2.6 spacing}\n"
          "perturb: {amount: 0.2}\n",
    BODY2_OF ("0.4999") "plane: strain\nmethod: {integration: gauss}\n",
    BODY3 "method: {integration: consistent}\n",
};
enum { SCENES = sizeof scenes / sizeof *scenes };

/* A run that finds equilibria, with supports whose points see more nodes than are coupled without them. */
#define HELD \
    "boundary: [{set: left, displacement: {x: 0, y: 0}}, {set: right, traction: {x: 1}}]\n" \
    "solver: {kind: static}\n"

/* The scene of plane strain says `plane` twice. */
static bonded built (int k)
{
    char text[1200];
    snprintf (text, sizeof text, "%s", scenes[k]);
    char *first = strstr (text, "plane: stress\n"), *second = strstr (text, "plane: strain\n");
    if (first && second) memmove (first, first + 14, strlen (first + 14) + 1);
    return bonded_of (text);
}

static double *forces (const pg_force_type *force, void *self, const bonded *b, const double *d)
{
    double *f = pg_calloc (b->ndof, sizeof *f), reference;
    check_ok (force->balance (self, 1, d, f, &reference));
    return f;
}

/* own, kept: two forces of the same problem with the same displacement. */
static void same (const bonded *b, void *kept, const double *d)
{
    double *f = forces (b->force, b->self, b, d), *g = forces (b->force, kept, b, d), most = 0;
    for (size_t i = 0; i < b->ndof; i++) most = fmax (most, fabs (f[i]));
    assert_true (most > 0);
    assert_memory_equal (f, g, b->ndof * sizeof *f);
    pg_free (f), pg_free (g);
}

/* Bonds whose values are kept: those of different rows. */
static size_t kept_bonds (const pg_rows *r, const pg_family *f)
{
    size_t most = 0;
    for (size_t i = 0; i < f->n; i++) {
        size_t end = (r->at ? r->at[i] : f->start[i]) + f->start[i + 1] - f->start[i];
        most = end > most ? end : most;
    }
    return most;
}

static void kept_rows_give_the_same_bits (void **unused)
{
    (void) unused;
    for (int k = 0; k < SCENES; k++) {
        bonded b = built (k);                          /* its force was made before the patch test */
        void *kept = NULL;
        double *d = random_vector (b.ndof, 3);
        assert_null (b.problem->quality.intact);
        check_ok (pg_patch_probe (b.problem));
        assert_non_null (b.problem->quality.intact);
        const pg_rows *r = &b.problem->quality.intact->rows[PG_NODES];
        size_t bonds = kept_bonds (r, &b.problem->bonds.rows[PG_NODES].family);
        double *before = pg_calloc (bonds, sizeof *before), *wide = b.problem->quality.intact->sums.dN;
        memcpy (before, r->N, bonds * sizeof *before);
        check_ok (b.force->create (&kept, b.problem));
        check_ok (b.force->refresh (kept, b.state, NULL));
        same (&b, kept, d);
        /* every seventh bond of the first points, of all sets that have any */
        size_t dead[3 * 60], n = 0;
        for (int s = 0; s < PG_BOND_SETS; s++)
            for (size_t e = b.problem->bonds.first[s];
                 e < b.problem->bonds.first[s + 1] && e < b.problem->bonds.first[s] + 350; e += 7)
                dead[n++] = e, b.state->alive[e] = 0;
        pg_changes changes = { .n = n, .bond = dead };
        double first = wide ? wide[0] : 0;
        check_ok (b.force->refresh (b.self, b.state, &changes));
        check_ok (b.force->refresh (kept, b.state, &changes));
        same (&b, kept, d);
        assert_memory_equal (before, r->N, bonds * sizeof *before);
        if (wide) assert_true (wide[0] == first);
        /* one that begins with broken bonds */
        void *late = NULL;
        check_ok (b.force->create (&late, b.problem));
        check_ok (b.force->refresh (late, b.state, NULL));
        same (&b, late, d);
        assert_memory_equal (before, r->N, bonds * sizeof *before);
        b.force->free (&late), b.force->free (&kept);
        pg_free (before), pg_free (d);
        unbonded (&b);
    }
}

/* Matrices of two forces, after `assemble` of both. */
static void same_matrix (const bonded *b, void *one, void *other)
{
    check_ok (pg_force_assemble (b->force, one, NULL));
    check_ok (pg_force_assemble (b->force, other, NULL));
    const pg_sparse *A = pg_force_matrix (b->force, one), *B = pg_force_matrix (b->force, other);
    size_t entries = (size_t) A->start[A->ncol];
    assert_int_equal (B->start[B->ncol], A->start[A->ncol]);
    assert_memory_equal (A->row, B->row, entries * sizeof *A->row);
    assert_memory_equal (A->value, B->value, entries * sizeof *A->value);
}

/* So is the bulk's part of K, where the patch test takes a factor: the first force that assembles gets it. */
static void kept_stiffness_gives_the_same_bits (void **unused)
{
    (void) unused;
    static const char *const of[] = {
        BODY2 "method: {integration: gauss}\nperturb: {amount: 0.2}\n" HELD,
        BODY2 "method: {integration: consistent, basis: quadratic, horizon: 2.6 spacing}\n" HELD,
        BODY3 "method: {integration: gauss}\n" HELD,
        BODY3 "method: {integration: consistent, basis: quadratic, horizon: 2.6 spacing}\n" HELD,
    };
    for (size_t k = 0; k < sizeof of / sizeof *of; k++) {
        bonded b = bonded_of (of[k]);
        void *first = NULL, *later = NULL;
        check_ok (pg_patch_probe (b.problem));
        assert_non_null (b.problem->quality.intact);
        assert_non_null (b.problem->quality.intact->K);
        check_ok (b.force->create (&first, b.problem));
        check_ok (b.force->refresh (first, b.state, NULL));
        check_ok (b.force->create (&later, b.problem));
        check_ok (b.force->refresh (later, b.state, NULL));
        same_matrix (&b, first, b.self);
        assert_null (b.problem->quality.intact->K);
        same_matrix (&b, later, b.self);
        size_t dead[60], n = 0;
        for (size_t e = 0; e < 350; e += 7) dead[n++] = e, b.state->alive[e] = 0;
        pg_changes changes = { .n = n, .bond = dead };
        check_ok (b.force->refresh (b.self, b.state, &changes));
        check_ok (b.force->refresh (first, b.state, &changes));
        same_matrix (&b, first, b.self);
        b.force->free (&first), b.force->free (&later);
        unbonded (&b);
    }
}

/* Two materials are not those of the bare body, and bonds that break change what was kept. */
static void stiffness_of_another_body_is_not_kept (void **unused)
{
    (void) unused;
    bonded b = bonded_of (
        "dimension: 2\nplane: stress\nbody: [{add: {box: {low: [0, 0], high: [1, 0.7]}}}]\nspacing: 0.1\n"
        "thickness: 0.2\nmaterials: {rock: {youngs_modulus: 10, poissons_ratio: 0.3}, "
        "clay: {youngs_modulus: 1, poissons_ratio: 0.2}}\n"
        "blocks: [{material: rock, where: 'x <= 0.5'}, {material: clay, where: 'x > 0.5'}]\n"
        "method: {integration: consistent}\n" HELD);
    check_ok (pg_patch_probe (b.problem));
    assert_non_null (b.problem->quality.intact);
    assert_null (b.problem->quality.intact->K);
    unbonded (&b);
    b = bonded_of (BODY2 "method: {integration: consistent}\n" HELD);
    void *late = NULL;
    check_ok (pg_patch_probe (b.problem));
    assert_non_null (b.problem->quality.intact->K);
    for (int s = 0; s < PG_BOND_SETS; s++) b.state->alive[b.problem->bonds.first[s]] = 0;
    check_ok (b.force->refresh (b.self, b.state, NULL));
    check_ok (b.force->create (&late, b.problem));
    check_ok (b.force->refresh (late, b.state, NULL));
    same_matrix (&b, b.self, late);
    b.force->free (&late);
    unbonded (&b);
}

/* Where bonds may break, or `plain` asks for no shortcuts, nothing is kept. */
static void kept_only_where_nothing_breaks (void **unused)
{
    (void) unused;
    static const char *const not[] = {
        BODY2 "failure: {critical_stretch: 0.01}\n",
        BODY2 "solver: {plain: true}\n",
        BODY2 "cracks: [{from: [0.3, 0.35], to: [0.6, 0.35]}]\n",
    };
    for (size_t k = 0; k < sizeof not / sizeof *not; k++) {
        bonded b = bonded_of (not[k]);
        check_ok (pg_patch_probe (b.problem));
        assert_null (b.problem->quality.intact);
        unbonded (&b);
    }
}

/* An allocation that fails on the way to rows of one's own leaves those of the problem alone. */
static void memory_that_ends_harms_nothing (void **unused)
{
    (void) unused;
    bonded b = built (2);
    check_ok (pg_patch_probe (b.problem));
    b.state->alive[0] = b.state->alive[b.problem->bonds.first[PG_POINTS]] = 0;
    for (size_t k = 1, failed = 1; failed; k++) {
        void *kept = NULL;
        check_ok (b.force->create (&kept, b.problem));
        pg_memory_fail_at (k);
        failed = b.force->refresh (kept, b.state, NULL) == PG_E_MEMORY;
        pg_memory_fail_at (0);
        assert_true (k > 7 || failed);
        b.force->free (&kept);
    }
    unbonded (&b);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (kept_rows_give_the_same_bits),
        cmocka_unit_test (kept_stiffness_gives_the_same_bits),
        cmocka_unit_test (stiffness_of_another_body_is_not_kept),
        cmocka_unit_test (kept_only_where_nothing_breaks),
        cmocka_unit_test (memory_that_ends_harms_nothing),
    };
    return cmocka_run_group_tests_name ("mechanics/force/intact", tests, NULL, NULL);
}

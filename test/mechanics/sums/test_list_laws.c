/* SPDX-License-Identifier: GPL-3.0-or-later
 * Every law of the loops over lists of bonds (pairs with linear and finite stretch, state-based bonds that
 * count broken bonds or not, beams that break at one limit or at all together): vectors of any width and any
 * number of threads give the bits of the scalar loop on one thread. Lists do without fused products, so that
 * there is no rounding to allow for. Forces, dead bonds, energies, dilatations; bodies one to three points
 * thick, of odd widths, fewer points than a vector, with holes, dead bonds, several materials, exempt
 * points. */
#include "sweeps.h"

typedef struct { const char *name; int finite, state, follow, beams, single; } law;
static const law laws[] = {
    { "pair, linear", 0, 0, 0, 0, 0 }, { "pair, finite", 1, 0, 0, 0, 0 },   { "state", 0, 1, 0, 0, 0 },
    { "state that follows", 0, 1, 1, 0, 0 }, { "beam", 0, 0, 0, 1, 0 },     { "beam, single", 0, 0, 0, 1, 1 },
};
static const struct { body_wish body; double scatter; int mixed; } bodies[] = {
    { { { 31, 1, 1 }, 0, 0, 0, 2, 3.015, PG_SURFACE_NONE, PG_PARTIAL_LINEAR, 0, PG_EVALUATE_LIST }, 0.3, 0 },
    { { { 2, 45, 1 }, 0, 0, 0, 2, 3.1, PG_SURFACE_NONE, PG_PARTIAL_NONE, 0, PG_EVALUATE_LIST }, 0.3, 1 },
    { { { 37, 3, 1 }, 0.1, 0, 0, 2, 3.015, PG_SURFACE_NONE, PG_PARTIAL_LINEAR, 0, PG_EVALUATE_LIST },
      0.2,
      1 },
    { { { 41, 29, 1 }, 0.1, 0, 0, 2, 3.015, PG_SURFACE_NONE, PG_PARTIAL_LINEAR, 0, PG_EVALUATE_LIST },
      0.3,
      1 },
    { { { 33, 17, 1 }, 0.1, 1, 0, 2, 3.015, PG_SURFACE_NONE, PG_PARTIAL_OVERLAP, 0, PG_EVALUATE_LIST },
      0,
      1 },
    { { { 3, 1, 1 }, 0, 0, 0, 2, 1.5, PG_SURFACE_NONE, PG_PARTIAL_NONE, 0, PG_EVALUATE_LIST }, 0.1, 0 },
    { { { 13, 11, 1 }, 0, 0, 0, 3, 2.5, PG_SURFACE_NONE, PG_PARTIAL_LINEAR, 0, PG_EVALUATE_LIST },
      0.3,
      1 },
    { { { 9, 2, 7 }, 0, 0, 0, 3, 2.5, PG_SURFACE_NONE, PG_PARTIAL_NONE, 0, PG_EVALUATE_LIST },
      0.3,
      0 },
    { { { 11, 3, 13 }, 0.1, 0, 0, 3, 2.5, PG_SURFACE_NONE, PG_PARTIAL_LINEAR, 0, PG_EVALUATE_LIST },
      0.3,
      1 },
    { { { 9, 8, 7 }, 0.1, 0, 0, 3, 2.5, PG_SURFACE_NONE, PG_PARTIAL_OVERLAP, 0, PG_EVALUATE_LIST },
      0,
      1 },
};
enum { LAWS = sizeof laws / sizeof *laws, BODIES = sizeof bodies / sizeof *bodies, ROUNDS = 3 };
enum { DILATION, DEVIATION, SHEAR, BENDING, SHEAR_LIMIT, BENDING_LIMIT, VALUES };

/* A body with what all laws ask of its points */
typedef struct {
    body   b;
    int    m;                                          /* unknowns of a point */
    double *value[VALUES], *d;                         /* of each point (n); unknowns (n x m) */
    pg_beam_law beams;
} field;

static void create (field *f, size_t w, const law *l, uint64_t seed)
{
    body *b = &f->b;
    body_wish wish = bodies[w].body;
    *f = (field) { .m = wish.dim };
    wish.finite = l->finite;
    body_create_as (b, &wish, bodies[w].scatter, bodies[w].mixed, seed);
    b->sums->rule.state = l->state, b->sums->rule.follow = l->follow, b->sums->rule.beams = l->beams;
    if (l->beams) f->m = wish.dim == 2 ? 3 : 6;
    size_t n = b->cloud.n;
    f->d = pg_calloc (n * (size_t) f->m, sizeof *f->d);
    for (size_t k = 0; k < n * (size_t) f->m; k++) f->d[k] = 1e-6 * (body_random (b) - 0.5);
    for (int k = 0; k < VALUES; k++) {
        f->value[k] = pg_calloc (n, sizeof *f->value[k]);
        for (size_t i = 0; i < n; i++) f->value[k][i] = b->modulus[i];
    }
    for (size_t i = 0; i < n; i++) {
        f->value[SHEAR][i] *= 1e-7, f->value[BENDING][i] *= 3e-8;
        f->value[SHEAR_LIMIT][i] = 2 * b->limit[i], f->value[BENDING_LIMIT][i] = 3 * b->limit[i];
    }
    f->beams = (pg_beam_law) { .shear = f->value[SHEAR], .bending = f->value[BENDING], .length = cell_side,
                               .shear_limit = f->value[SHEAR_LIMIT],
                               .bending_limit = f->value[BENDING_LIMIT], .single = l->single };
}

static void release (field *f)
{
    for (int k = 0; k < VALUES; k++) pg_free (f->value[k]);
    pg_free (f->d);
    body_free (&f->b);
}

/* 1: made; 0: this machine lacks the instructions */
static int make_loop (pg_bond_loop **out, const field *f, const law *l, const char *set, int threads)
{
    const body *b = &f->b;
    pg_bond_loop_setting setting = { .sums = b->sums, .family = &b->family, .modulus = b->modulus,
                                     .limit = b->limit, .exempt = b->exempt, .dilation = f->value[DILATION],
                                     .deviation = f->value[DEVIATION], .beams = l->beams ? &f->beams : NULL,
                                     .threads = threads, .instructions = set };
    pg_status status = pg_bond_loop_create (out, &setting);
    if (status == PG_E_USAGE && strstr (pg_last_error (), "this machine has none")) return 0;
    check_ok (status);
    check_contains (pg_bond_loop_name (*out), "list");
    check_contains (pg_bond_loop_name (*out), set);
    return 1;
}

/* All that a loop says of a few rounds of ever larger displacements, in which bonds break from the second on
 * */
typedef struct { double *number; size_t n; pg_changes broken; } answers;

static void ask (answers *a, const field *f, const law *l, pg_bond_loop *loop)
{
    const body *b = &f->b;
    size_t n = b->cloud.n, all = n * (size_t) f->m, each = all + 3 * n + 1;
    double *d = pg_calloc (all, sizeof *d);
    *a = (answers) { .number = pg_calloc (ROUNDS * each, sizeof *a->number), .n = ROUNDS * each };
    pg_bond_loop_update (loop, b->alive, NULL);
    for (int round = 0; round < ROUNDS; round++) {
        double *to = a->number + (size_t) round * each;
        for (size_t k = 0; k < all; k++) d[k] = f->d[k] * (1 + 0.8 * round);
        check_ok (pg_bond_loop_force (loop, d, to, round ? &a->broken : NULL));
        check_ok (pg_bond_loop_energies (loop, d, to + all));
        if (l->state) check_ok (pg_bond_loop_dilatation (loop, d, to + all + n, to + all + 2 * n));
        to[each - 1] = pg_bond_loop_energy (loop, d);
    }
    pg_free (d);
}

static void forget (answers *a) { pg_free (a->number), pg_free (a->broken.bond); }

/* Of one law on one body, `exempt` of whose points never lose a bond; returns how many bonds broke. */
static size_t compare (const law *l, size_t w, double exempt)
{
    field f;
    answers right = { 0 };
    create (&f, w, l, 5 + w);
    body_wound (&f.b, 0.1);
    for (size_t i = 0; i < f.b.cloud.n; i++) f.b.exempt[i] = body_random (&f.b) < exempt;
    for (int k = 0; k < SETS; k++)
        for (int threads = 1; threads <= 3; threads++) {
            pg_bond_loop *loop = NULL;
            answers a;
            if (!make_loop (&loop, &f, l, sets[k], threads)) continue;
            ask (&a, &f, l, loop);
            if (k == 0 && threads == 1) right = a;
            assert_memory_equal (a.number, right.number, a.n * sizeof *a.number);
            assert_int_equal (a.broken.n, right.broken.n);
            for (size_t c = 0; c < a.broken.n; c++) assert_int_equal (a.broken.bond[c], right.broken.bond[c]);
            if (a.number != right.number) forget (&a);
            pg_bond_loop_free (&loop);
        }
    for (size_t c = 0; c < right.broken.n; c++) {
        size_t i = 0, j = (size_t) f.b.family.node[right.broken.bond[c]];
        while (f.b.family.start[i + 1] <= right.broken.bond[c]) i++;
        assert_true (!f.b.exempt[i] && !f.b.exempt[j]);
        assert_true (f.b.alive[right.broken.bond[c]]);
    }
    size_t broken = right.broken.n, bonds = f.b.nbond;
    assert_true (largest (right.number, right.n) > 0 || bonds < 8);
    forget (&right);
    release (&f);
    assert_true (broken < bonds || bonds < 8);
    return broken;
}

static void vectors_give_the_bits_of_the_scalar_loop (void **state)
{
    (void) state;
    for (size_t l = 0; l < LAWS; l++) {
        size_t broken = 0;
        for (size_t w = 0; w < BODIES; w++) broken += compare (&laws[l], w, 0);
        assert_true (broken > 100);
    }
}

static void exempt_points_keep_their_bonds (void **state)
{
    (void) state;
    for (size_t l = 0; l < LAWS; l++) {
        size_t broken = 0;
        for (size_t w = 0; w < BODIES; w++) broken += compare (&laws[l], w, 0.3);
        assert_true (broken > 50);
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (vectors_give_the_bits_of_the_scalar_loop),
        cmocka_unit_test (exempt_points_keep_their_bonds),
    };
    return cmocka_run_group_tests_name ("mechanics/sums/list_laws", tests, NULL, NULL);
}

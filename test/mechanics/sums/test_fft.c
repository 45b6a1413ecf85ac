/* SPDX-License-Identifier: GPL-3.0-or-later
 * Bonds of a lattice summed by transforms against the plain double loop and the stencil (theory B-1, B-4,
 * B-5): forces, energies of points, bonds that break, on bodies with holes, cut volumes, cracks, dead points;
 * any number of threads gives the same bits. */
#include "sweeps.h"

static int make_as (pg_bond_loop **out, const body *b, pg_evaluation evaluation, const char *set, int threads,
                    int breaks, int exempt)
{
    b->sums->rule.evaluation = evaluation;
    return make_sweep (out, b, set, threads, breaks, exempt);
}

static double difference (const double *f, const double *g, size_t n)
{
    double most = largest (g, n), off = 0;
    for (size_t i = 0; i < n; i++) off = fmax (off, fabs (f[i] - g[i]));
    return most > 0 ? off / most : off;
}

static const body_wish wishes[] = {
    { { 130, 37, 1 }, 0.1, 0, 0, 2, 3.015, PG_SURFACE_NONE, PG_PARTIAL_OVERLAP, 0, PG_EVALUATE_FFT },
    { { 101, 53, 1 }, 0, 0, 0, 2, 3, PG_SURFACE_NONE, PG_PARTIAL_NONE, 0, PG_EVALUATE_FFT },
    { { 133, 40, 1 }, 0.05, 1, 0, 2, 3, PG_SURFACE_PRODUCT, PG_PARTIAL_LINEAR, 0, PG_EVALUATE_FFT },
    { { 97, 41, 1 }, 0.2, 1, 1, 2, 6.2, PG_SURFACE_PRODUCT, PG_PARTIAL_OVERLAP, 0, PG_EVALUATE_FFT },
    { { 1001, 1, 1 }, 0.05, 1, 0, 1, 3.015, PG_SURFACE_PRODUCT, PG_PARTIAL_NONE, 0, PG_EVALUATE_FFT },
    { { 333, 1, 1 }, 0.05, 0, 1, 1, 12.2, PG_SURFACE_NONE, PG_PARTIAL_LINEAR, 0, PG_EVALUATE_FFT },
    { { 17, 19, 23 }, 0.1, 0, 0, 3, 3.015, PG_SURFACE_NONE, PG_PARTIAL_OVERLAP, 0, PG_EVALUATE_FFT },
    { { 35, 15, 6 }, 0.1, 1, 1, 3, 2.5, PG_SURFACE_PRODUCT, PG_PARTIAL_NONE, 0, PG_EVALUATE_FFT },
    /* thin ones */
    { { 40, 1, 1 }, 0, 0, 0, 2, 3.015, PG_SURFACE_NONE, PG_PARTIAL_NONE, 0, PG_EVALUATE_FFT },
    { { 2, 70, 1 }, 0, 0, 0, 2, 3.015, PG_SURFACE_NONE, PG_PARTIAL_OVERLAP, 0, PG_EVALUATE_FFT },
    { { 3, 3, 70 }, 0, 0, 0, 3, 3.015, PG_SURFACE_NONE, PG_PARTIAL_OVERLAP, 0, PG_EVALUATE_FFT },
    { { 70, 1, 2 }, 0, 0, 0, 3, 3.015, PG_SURFACE_PRODUCT, PG_PARTIAL_LINEAR, 0, PG_EVALUATE_FFT },
    { { 2, 1, 1 }, 0, 0, 0, 1, 1.5, PG_SURFACE_NONE, PG_PARTIAL_NONE, 0, PG_EVALUATE_FFT },
};
enum { WISHES = sizeof wishes / sizeof *wishes };

static void kill_bond (body *b, size_t i, size_t e) { b->alive[e] = b->alive[body_reverse (b, i, e)] = 0; }

/* Kills a share of the bonds in the first `part` of the body along its longest axis, and whole points of all
 * of it */
static void wound (body *b, double part, double chance, double points)
{
    size_t dim = (size_t) b->cloud.dim, axis = 0;
    for (size_t d = 1; d < dim; d++)
        if (b->cloud.high[d] - b->cloud.low[d] > b->cloud.high[axis] - b->cloud.low[axis]) axis = d;
    double until = b->cloud.low[axis] + part * (b->cloud.high[axis] - b->cloud.low[axis]);
    for (size_t i = 0; i < b->cloud.n; i++) {
        int whole = body_random (b) < points;
        for (size_t e = b->family.start[i]; e < b->family.start[i + 1]; e++)
            if (whole
                || ((size_t) b->family.node[e] > i && b->cloud.x[i * dim + axis] < until
                    && body_random (b) < chance))
                kill_bond (b, i, e);
    }
}

static void forces_and_energies_equal_the_plain_loop (void **state)
{
    (void) state;
    static const struct {
        double part, chance, points;
    } wounds[] = { { 0, 0, 0 }, { 0.4, 0.05, 0 }, { 0.3, 0.1, 0.05 }, { 0, 0, 0.1 } };
    for (size_t w = 0; w < WISHES; w++)
        for (size_t v = 0; v < 4; v++) {
            body b;
            body_create (&b, &wishes[w], 11 + w);
            wound (&b, wounds[v].part, wounds[v].chance, wounds[v].points);
            size_t values = b.cloud.n * (size_t) b.cloud.dim;
            double *f = pg_calloc (values, sizeof *f), *g = pg_calloc (values, sizeof *g),
                   *first = pg_calloc (values, sizeof *first), *W = pg_calloc (values, sizeof *W);
            double energy = body_plain (&b, 0, g, NULL);
            for (int threads = 1; threads <= 3; threads++) {
                pg_bond_loop *s = NULL;
                make_as (&s, &b, PG_EVALUATE_FFT, NULL, threads, 0, 0);
                check_contains (pg_bond_loop_name (s), "fft");
                pg_bond_loop_update (s, b.alive, NULL);
                memset (f, 0x7f, values * sizeof *f);
                check_ok (pg_bond_loop_force (s, b.u, f, NULL));
                check_below (difference (f, g, values), 1e-13);
                if (threads == 1) memcpy (first, f, values * sizeof *f);
                assert_memory_equal (f, first, values * sizeof *f);
                check_scaled (pg_bond_loop_energy (s, b.u), energy, 1e-12, 1e-300);
                memset (f, 0x7f, values * sizeof *f);
                check_ok (pg_bond_loop_energies (s, b.u, f));
                check_below (difference (f, b.W, b.cloud.n), 1e-13);
                if (threads == 1) memcpy (W, f, b.cloud.n * sizeof *W);
                assert_memory_equal (f, W, b.cloud.n * sizeof *W);
                pg_bond_loop_counts count;
                pg_bond_loop_counted (s, &count);
                /* both ways were gone */
                if (w < 2 && v < 3) assert_true (count.cut < count.blocks && (count.cut > 0) == (v > 0));
                if (v == 3) assert_true (count.cut == 0 && (w > 7 || count.gone > 0));
                pg_bond_loop_free (&s);
                assert_null (s);
            }
            pg_free (f), pg_free (g), pg_free (first), pg_free (W);
            body_free (&b);
        }
}

/* A body torn slowly: the bonds that break, and the forces, are those of the stencil at every step; blocks
 * far from the tear are not looked at. */
static void bonds_break_as_by_the_stencil (void **state)
{
    (void) state;
    for (size_t w = 0; w < WISHES; w++)
        for (int exempt = 0; exempt < 2; exempt++) {
            body b;
            body_create (&b, &wishes[w], 50 + w);
            size_t dim = (size_t) b.cloud.dim, values = b.cloud.n * dim, total = 0;
            double *f = pg_calloc (values, sizeof *f), *g = pg_calloc (values, sizeof *g),
                   *noise = pg_calloc (values, sizeof *noise);
            for (size_t i = 0; exempt && i < b.cloud.n; i++) b.exempt[i] = body_random (&b) < 0.2;
            for (size_t k = 0; k < values; k++) noise[k] = 1e-7 * cell_side * (body_random (&b) - 0.5);
            pg_bond_loop *s = NULL, *t = NULL;
            pg_changes broken = { 0 }, torn = { 0 };
            make_as (&s, &b, PG_EVALUATE_FFT, NULL, 2, 1, exempt),
                make_as (&t, &b, PG_EVALUATE_STENCIL, NULL, 1, 1, exempt);
            for (int step = 0; step < 12; step++) {
                /* rotated by half, strained by 0.9 of the limit across; a bump of growing height at a third
                 * of the length */
                for (size_t i = 0; i < b.cloud.n; i++) {
                    const double *x = b.cloud.x + i*dim;
                    double far = 0, bump;
                    for (size_t d = 0; d < dim; d++)
                        far += pow ((x[d] - b.cloud.low[d] - (b.cloud.high[d] - b.cloud.low[d]) / 3)
                                        / cell_side,
                                    2);
                    bump = 1e-4 * cell_side * step * exp (-far / 9);
                    for (size_t d = 0; d < dim; d++)
                        b.u[i * dim + d] = 0.9e-3 * x[d] + 0.3 * bump + noise[i * dim + d];
                    b.u[i*dim] += bump;
                    if (dim > 1) b.u[i*dim] -= 0.5 * x[1], b.u[i*dim + 1] += 0.5 * x[0];
                }
                size_t had = broken.n;
                check_ok (pg_bond_loop_force (s, b.u, f, &broken));
                check_ok (pg_bond_loop_force (t, b.u, g, &torn));
                assert_int_equal (broken.n, torn.n);
                if (torn.n) assert_memory_equal (broken.bond, torn.bond, torn.n * sizeof *torn.bond);
                check_below (difference (f, g, values), 1e-11);
                total += broken.n - had;
            }
            pg_bond_loop_counts count;
            pg_bond_loop_counted (s, &count);
            if (w < 12) assert_true (total > 10 && total < b.nbond / 4);
            if (w == 1) assert_true (count.cut > 0 && count.bonds < count.blocks / 2);
            pg_bond_loop_free (&s), pg_bond_loop_free (&t);
            pg_free (f), pg_free (g), pg_free (noise), pg_free (broken.bond), pg_free (torn.bond);
            body_free (&b);
        }
}

/* u = strain x, shifted and turned: W and forces as without (B-4). */
static void rigid_motions_cost_no_digits (void **state)
{
    (void) state;
    for (size_t w = 0; w < 8; w += 6) {
        body b;
        body_create (&b, &wishes[w], 9);
        size_t dim = (size_t) b.cloud.dim, values = b.cloud.n * dim;
        double *f = pg_calloc (values, sizeof *f), *g = pg_calloc (values, sizeof *g),
               *W = pg_calloc (b.cloud.n, sizeof *W);
        pg_bond_loop *s = NULL;
        make_as (&s, &b, PG_EVALUATE_FFT, NULL, 1, 0, 0);
        for (size_t i = 0; i < b.cloud.n; i++)
            for (size_t d = 0; d < dim; d++)
                b.u[i * dim + d] = 1e-6 * b.cloud.x[i * dim + d]
                                   * (1 + 0.1 * sin (b.cloud.x[i * dim] / cell_side));
        body_plain (&b, 0, g, NULL);
        double energy = pg_bond_loop_energy (s, b.u);
        for (size_t i = 0; i < b.cloud.n; i++) {
            double x = b.cloud.x[i*dim], y = b.cloud.x[i*dim + 1];
            b.u[i*dim] += 1 - 0.25 * y, b.u[i*dim + 1] += -0.5 + 0.25 * x;
        }
        check_relative (pg_bond_loop_energy (s, b.u), energy, 1e-8);
        /* of what is left of u: 1e-16 of 1 m in the 1e-9 m that a bond gets longer */
        energy = body_plain (&b, 0, g, NULL);
        check_ok (pg_bond_loop_force (s, b.u, f, NULL));
        check_ok (pg_bond_loop_energies (s, b.u, W));
        check_relative (pg_bond_loop_energy (s, b.u), energy, 1e-9);
        check_below (difference (f, g, values), 1e-9);
        check_below (difference (W, b.W, b.cloud.n), 1e-9);
        pg_bond_loop_free (&s);
        pg_free (f), pg_free (g), pg_free (W);
        body_free (&b);
    }
}

/* A uniform strain in the box makes no force on points inside, and costs what is on top of it no digits: it
 * never goes through transforms. Points that lack neighbours get what the plain loop gives them, some of them
 * dead. */
static void uniform_strain_costs_no_digits (void **state)
{
    (void) state;
    static const size_t which[] = { 0, 1, 3, 4, 6, 7 };
    for (size_t w = 0; w < 6; w++)
        for (int rough = 0; rough < 2; rough++) {
            body b;
            body_create (&b, &wishes[which[w]], 5);
            size_t dim = (size_t) b.cloud.dim, values = b.cloud.n * dim, inside = 0;
            double *f = pg_calloc (values, sizeof *f), *g = pg_calloc (values, sizeof *g),
                   *own = pg_calloc (values, sizeof *own);
            double most = 0, off = 0, within = 0;
            wound (&b, 0, 0, 0.01);
            /* 1e-10 m */
            for (size_t k = 0; k < values; k++)
                b.u[k] = rough ? ldexp (nearbyint (ldexp (b.u[k], 48)), -60) : 0;
            body_plain (&b, 0, own, NULL);
            for (size_t i = 0; i < b.cloud.n; i++)
                for (size_t d = 0; d < dim; d++)       /* 1e-6 m a step, nothing rounded                    */
                    for (size_t k = 0; k < dim; k++)
                        b.u[i * dim + d] += ldexp ((d == k ? 3 : 1 + (double) k)
                                                       * nearbyint (b.cloud.x[i * dim + k] / cell_side - 0.5),
                                                   -20);
            pg_bond_loop *s = NULL;
            make_as (&s, &b, PG_EVALUATE_FFT, NULL, 1, 0, 0);
            pg_bond_loop_update (s, b.alive, NULL);
            check_ok (pg_bond_loop_force (s, b.u, f, NULL));
            body_plain (&b, 0, g, NULL);
            for (size_t i = 0; i < b.cloud.n; i++) {
                int whole = b.family.start[i + 1] - b.family.start[i] == b.sums->stencil.n
                            && b.sums->rule.surface == PG_SURFACE_NONE;
                for (size_t e = b.family.start[i]; whole && e < b.family.start[i + 1]; e++) {
                    whole = b.alive[e];
                    for (size_t d = 0; d < dim; d++) {  /* nor is a neighbour's volume another one */
                        double x = b.cloud.x[(size_t) b.family.node[e] * dim + d];
                        if (wishes[which[w]].shares && (x == b.cloud.low[d] || x == b.cloud.high[d]))
                            whole = 0;
                    }
                }
                for (size_t d = 0; d < dim; d++) {
                    most = fmax (most, fabs (g[i*dim + d]));
                    if (whole)
                        inside++, within = fmax (within, fabs (own[i * dim + d])),
                                  off = fmax (off, fabs (f[i * dim + d] - own[i * dim + d]));
                }
            }
            check_below (difference (f, g, values), 1e-14);
            check_below (off, rough ? 1e-13 * within : 1e-24 * most);
            if (which[w] < 2) assert_true (inside > 10);
            pg_bond_loop_free (&s);
            pg_free (f), pg_free (g), pg_free (own);
            body_free (&b);
        }
}

/* Transforms of a step: two forward and two back in the plane, three and three in space (B-5); none where
 * every block has a cut bond. */
static void transforms_are_as_few_as_theory_has_them (void **state)
{
    (void) state;
    static const struct { size_t wish; long forward, back; } of[] = { { 4, 1, 1 }, { 1, 2, 2 }, { 6, 3, 3 } };
    for (size_t k = 0; k < 3; k++) {
        body b;
        body_create (&b, &wishes[of[k].wish], 9);
        size_t values = b.cloud.n * (size_t) b.cloud.dim;
        double *f = pg_calloc (values, sizeof *f);
        pg_bond_loop *s = NULL;
        pg_bond_loop_counts count;
        long all = of[k].forward;
        make_as (&s, &b, PG_EVALUATE_FFT, NULL, 1, 0, 0);
        pg_bond_loop_counted (s, &count);
        assert_int_equal (count.forward + count.back + count.sums, 0);
        for (int step = 1; step <= 3; step++) {
            check_ok (pg_bond_loop_force (s, b.u, f, NULL));
            pg_bond_loop_counted (s, &count);
            assert_int_equal (count.sums, step);
            assert_int_equal (count.forward, step * of[k].forward);
            assert_int_equal (count.back, step * of[k].back);
        }
        /* q, and the squares: as many as pairs of axes, one back */
        check_ok (pg_bond_loop_energies (s, b.u, f));
        pg_bond_loop_counted (s, &count);
        assert_int_equal (count.forward, 4 * all + all * (all + 1) / 2);
        assert_int_equal (count.back, 4 * all + 1);
        for (size_t e = 0; e < b.nbond; e++) b.alive[e] = 1;
        wound (&b, 2, 0.5, 0);
        pg_bond_loop_update (s, b.alive, NULL);
        check_ok (pg_bond_loop_force (s, b.u, f, NULL));
        pg_bond_loop_counted (s, &count);
        assert_int_equal (count.back, 4 * all + 1);
        pg_bond_loop_free (&s);
        pg_free (f);
        body_free (&b);
    }
}

/* What was cut when makes no difference, in any bit: by changes, all at once, by breaking; nor does
 * resurrection leave a trace. */
static void only_what_is_cut_counts (void **state)
{
    (void) state;
    for (size_t w = 0; w < WISHES; w++) {
        body b;
        body_create (&b, &wishes[w], 31 + w);
        size_t values = b.cloud.n * (size_t) b.cloud.dim;
        double *f = pg_calloc (values, sizeof *f), *g = pg_calloc (values, sizeof *g),
               *whole = pg_calloc (values, sizeof *whole);
        unsigned char *before = pg_calloc (b.nbond, 1);
        pg_changes changes = { .bond = pg_calloc (b.nbond, sizeof *changes.bond) };
        pg_bond_loop *s = NULL, *t = NULL;
        make_as (&s, &b, PG_EVALUATE_FFT, NULL, 1, 0, 0);
        check_ok (pg_bond_loop_force (s, b.u, whole, NULL));
        for (int round = 0; round < 3; round++) {
            memcpy (before, b.alive, b.nbond);
            wound (&b, 0.2, 0.02, 0.03);
            changes.n = 0;
            for (size_t e = 0; e < b.nbond; e++) if (before[e] && !b.alive[e]) changes.bond[changes.n++] = e;
            pg_bond_loop_update (s, b.alive, &changes);
            check_ok (pg_bond_loop_force (s, b.u, f, NULL));
            make_as (&t, &b, PG_EVALUATE_FFT, NULL, 2, 0, 0);
            pg_bond_loop_update (t, b.alive, NULL);
            check_ok (pg_bond_loop_force (t, b.u, g, NULL));
            assert_memory_equal (f, g, values * sizeof *f);
            pg_bond_loop_counts one, other;
            pg_bond_loop_counted (s, &one), pg_bond_loop_counted (t, &other);
            assert_int_equal (one.gone, other.gone);
            pg_bond_loop_free (&t);
        }
        memset (b.alive, 1, b.nbond);
        pg_bond_loop_update (s, b.alive, NULL);
        check_ok (pg_bond_loop_force (s, b.u, f, NULL));
        assert_memory_equal (f, whole, values * sizeof *f);
        pg_bond_loop_free (&s);
        pg_free (f), pg_free (g), pg_free (whole), pg_free (before), pg_free (changes.bond);
        body_free (&b);
    }
}

/* A loop that breaks bonds leaves what a fresh sweep makes of the bits that are left, in all bits. */
static void breaking_equals_starting_anew (void **state)
{
    (void) state;
    body b;
    body_create (&b, &wishes[1], 3);
    size_t values = b.cloud.n * 2;
    double *f = pg_calloc (values, sizeof *f), *g = pg_calloc (values, sizeof *g);
    pg_changes broken = { 0 };
    pg_bond_loop *s = NULL, *t = NULL;
    make_as (&s, &b, PG_EVALUATE_FFT, NULL, 1, 1, 0);
    for (size_t i = 0; i < b.cloud.n; i++) {
        const double *x = b.cloud.x + 2*i;
        double y[2] = { x[0] - 40 * cell_side, x[1] - 20 * cell_side },
               far = (y[0] * y[0] + y[1] * y[1]) / pow (6 * cell_side, 2);
        for (int d = 0; d < 2; d++) b.u[2*i + (size_t) d] = 5e-3 * y[d] * exp (-far * far);
    }
    check_ok (pg_bond_loop_force (s, b.u, f, &broken));
    for (size_t c = 0; c < broken.n; c++) b.alive[broken.bond[c]] = 0;
    make_as (&t, &b, PG_EVALUATE_FFT, NULL, 2, 0, 0);
    pg_bond_loop_update (t, b.alive, NULL);
    check_ok (pg_bond_loop_force (t, b.u, g, NULL));
    pg_bond_loop_counts count;
    pg_bond_loop_counted (t, &count);
    assert_true (broken.n > 40 && count.gone > 0 && count.cut > 0 && count.cut < count.blocks / 4);
    assert_memory_equal (f, g, values * sizeof *f);
    pg_bond_loop_free (&s), pg_bond_loop_free (&t);
    pg_free (f), pg_free (g), pg_free (broken.bond);
    body_free (&b);
}

/* Automatic: transforms where a horizon is long and the body large, said with the reason; never for a small
 * body or finite stretch. */
static void work_decides_between_stencil_and_transforms (void **state)
{
    (void) state;
    static const struct { body_wish wish; int fast;
    } cases[] = {
        { { { 250, 250, 1 }, 0, 0, 0, 2, 3.015, PG_SURFACE_NONE, PG_PARTIAL_OVERLAP, 0, PG_EVALUATE_AUTO },
          0 },
        { { { 250, 250, 1 }, 0, 0, 0, 2, 9.015, PG_SURFACE_NONE, PG_PARTIAL_OVERLAP, 0, PG_EVALUATE_AUTO },
          1 },
        { { { 250, 250, 1 }, 0, 0, 0, 2, 9.015, PG_SURFACE_NONE, PG_PARTIAL_OVERLAP, 1, PG_EVALUATE_AUTO },
          0 },
        { { { 12, 9, 1 }, 0, 0, 0, 2, 9.015, PG_SURFACE_NONE, PG_PARTIAL_OVERLAP, 0, PG_EVALUATE_AUTO }, 0 },
    };
    for (size_t k = 0; k < 4; k++) {
        body b;
        pg_bond_loop *s = NULL;
        body_create (&b, &cases[k].wish, 3);
        make_as (&s, &b, PG_EVALUATE_AUTO, NULL, 1, 0, 0);
        check_contains (pg_bond_loop_name (s), cases[k].fast ? "fft" : "stencil");
        if (!cases[k].wish.finite) check_contains (pg_bond_loop_reason (s), "auto: about");
        if (cases[k].fast) check_contains (pg_bond_loop_reason (s), "guessed");
        pg_bond_loop_free (&s);
        make_as (&s, &b, PG_EVALUATE_STENCIL, NULL, 1, 0, 0);
        assert_string_equal (pg_bond_loop_reason (s), "asked for");
        pg_bond_loop_free (&s);
        body_free (&b);
    }
}

/* Timed plans are kept in a file of the user's cache and make the same bits again; where nothing can be kept,
 * nothing is said. */
static void timed_plans_are_kept (void **state)
{
    (void) state;
    char folder[] = "/tmp/perigal_test_XXXXXX", path[64];
    assert_non_null (mkdtemp (folder));
    body b;
    body_create (&b, &wishes[1], 3);
    size_t values = b.cloud.n * 2;
    double *f = pg_calloc (values, sizeof *f), *g = pg_calloc (values, sizeof *g),
           *plain = pg_calloc (values, sizeof *plain);
    body_plain (&b, 0, plain, NULL);
    b.sums->rule.evaluations = 1e9;
    for (int round = 0; round < 3; round++) {
        pg_bond_loop *s = NULL;
        setenv ("XDG_CACHE_HOME", round < 2 ? folder : "/dev/null/nowhere", 1);
        make_as (&s, &b, PG_EVALUATE_FFT, NULL, 1, 0, 0);
        check_contains (pg_bond_loop_reason (s), "timed");
        check_ok (pg_bond_loop_force (s, b.u, round ? f : g, NULL));
        check_below (difference (round ? f : g, plain, values), 1e-13);
        if (round == 1) assert_memory_equal (f, g, values * sizeof *f);
        pg_bond_loop_free (&s);
    }
    snprintf (path, sizeof path, "%s/perigal/fftw_wisdom", folder);
    assert_int_equal (remove (path), 0);               /* it was there */
    snprintf (path, sizeof path, "%s/perigal", folder);
    assert_int_equal (remove (path), 0);               /* and nothing beside it */
    assert_int_equal (remove (folder), 0);
    unsetenv ("XDG_CACHE_HOME");
    pg_free (f), pg_free (g), pg_free (plain);
    body_free (&b);
}

static void what_transforms_cannot_is_refused (void **state)
{
    (void) state;
    static const struct { int finite; pg_surface surface; double scatter; const char *why;
    } cases[] = {
        { 1, PG_SURFACE_NONE, 0, "finite" },
        { 0, PG_SURFACE_VOLUME, 0, "volume" },
        { 0, PG_SURFACE_NONE, 0.2, "no lattice" },
        { 0, PG_SURFACE_NONE, 0, "several moduli" },
    };
    for (size_t k = 0; k < 4; k++) {
        body_wish wish = {
            { 40, 20, 1 },  0, 0, 0, 2, 3.015, cases[k].surface, PG_PARTIAL_LINEAR, cases[k].finite,
            PG_EVALUATE_FFT
        };
        body b;
        body_create_as (&b, &wish, cases[k].scatter, 0, 3);
        if (k == 3) b.modulus[7] *= 2;
        pg_bond_loop *s = NULL;
        pg_bond_loop_setting setting = {
            .sums = b.sums, .family = &b.family, .modulus = b.modulus, .threads = 1
        };
        check_fails (pg_bond_loop_create (&s, &setting), PG_E_USAGE);
        check_contains (pg_last_error (), "evaluation fft");
        check_contains (pg_last_error (), cases[k].why);
        assert_null (s);
        body_free (&b);
    }
}

static void lack_of_memory_is_reported (void **state)
{
    (void) state;
    body b;
    body_create (&b, &wishes[3], 3);
    size_t before = pg_memory_used (), k = 1;
    pg_bond_loop *s = NULL;
    pg_bond_loop_setting setting = { .sums = b.sums,
                                     .family = &b.family,
                                     .modulus = b.modulus,
                                     .limit = b.limit,
                                     .exempt = b.exempt,
                                     .threads = 1 };
    b.sums->rule.evaluation = PG_EVALUATE_FFT;
    for (pg_status status = PG_E_MEMORY; status != PG_OK; k++) {
        pg_memory_fail_at (k);
        status = pg_bond_loop_create (&s, &setting);
        pg_memory_fail_at (0);
        if (status == PG_OK) break;
        assert_int_equal (status, PG_E_MEMORY);
        assert_null (s);
        assert_int_equal (pg_memory_used (), before);
        assert_true (k < 100);
    }
    assert_true (k > 20);
    double *f = pg_calloc (b.cloud.n * 2, sizeof *f), *W = pg_calloc (b.cloud.n, sizeof *W);
    for (k = 1; k < 3; k++) {                          /* energies make room when first asked for */
        pg_memory_fail_at (k);
        check_fails (pg_bond_loop_energies (s, b.u, W), PG_E_MEMORY);
        pg_memory_fail_at (0);
    }
    body_plain (&b, 0, f, NULL);
    check_ok (pg_bond_loop_energies (s, b.u, W));
    check_below (difference (W, b.W, b.cloud.n), 1e-13);
    size_t calls = pg_memory_calls ();
    pg_changes broken = { 0 };
    check_ok (pg_bond_loop_force (s, b.u, f, &broken));
    check_ok (pg_bond_loop_energies (s, b.u, W));
    assert_int_equal (pg_memory_calls () - calls, broken.n > 0);
    pg_bond_loop_free (&s);
    pg_free (f), pg_free (W), pg_free (broken.bond);
    body_free (&b);
    assert_true (pg_memory_used () < before);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (forces_and_energies_equal_the_plain_loop),
        cmocka_unit_test (bonds_break_as_by_the_stencil),
        cmocka_unit_test (rigid_motions_cost_no_digits), cmocka_unit_test (uniform_strain_costs_no_digits),
        cmocka_unit_test (transforms_are_as_few_as_theory_has_them),
        cmocka_unit_test (only_what_is_cut_counts),
        cmocka_unit_test (breaking_equals_starting_anew),
        cmocka_unit_test (work_decides_between_stencil_and_transforms),
        cmocka_unit_test (timed_plans_are_kept),
        cmocka_unit_test (what_transforms_cannot_is_refused),
        cmocka_unit_test (lack_of_memory_is_reported),
    };
    return cmocka_run_group_tests_name ("mechanics/sums/fft", tests, NULL, NULL);
}

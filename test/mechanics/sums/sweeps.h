/* SPDX-License-Identifier: GPL-3.0-or-later
 * sweeps.h: what every way of summing bonds is held to, over bodies, sets of instructions and threads: the
 * plain loop's forces, energies and broken bonds, the same bits; an update by changes is one of all. */
#ifndef PERIGAL_TEST_SWEEPS_H
#define PERIGAL_TEST_SWEEPS_H
#include "lattice_body.h"

static const char *const sets[] = { "scalar", "avx2", "avx512" };
enum { SETS = sizeof sets / sizeof *sets };
typedef struct {
    const char *name;                                  /* in that of the sweep */
    void (*create) (body *b, size_t w, uint64_t seed);  size_t n;     /* makes the one of number w < n */
    int apart;  /* 1: sets that fuse products and sums have bits of their own */
} swept;

/* 1: made; 0: this machine lacks the instructions */
static inline int make_sweep (pg_bond_loop **out, const body *b, const char *set, int threads, int breaks,
                              int exempt)
{
    pg_bond_loop_setting setting = { .sums = b->sums,
                                     .family = &b->family,
                                     .modulus = b->modulus,
                                     .limit = breaks ? b->limit : NULL,
                                     .exempt = exempt ? b->exempt : NULL,
                                     .threads = threads,
                                     .instructions = set };
    pg_status status = pg_bond_loop_create (out, &setting);
    if (status == PG_E_USAGE && set && strstr (pg_last_error (), "this machine has none")) return 0;
    check_ok (status);
    return 1;
}

static inline double largest (const double *f, size_t n)
{
    double most = 0;
    for (size_t i = 0; i < n; i++) most = fmax (most, fabs (f[i]));
    return most;
}

static inline void close_to (const double *f, const double *g, size_t n, double tolerance)
{
    double most = largest (g, n);
    for (size_t i = 0; i < n; i++) check_scaled (f[i], g[i], tolerance, most);
}

static inline void sums_equal_the_plain_loop (const swept *c)
{
    for (size_t w = 0; w < c->n; w++) {
        body b;
        c->create (&b, w, 11 + w);
        body_wound (&b, 0.2);
        size_t values = b.cloud.n * (size_t) b.cloud.dim;
        double *f = pg_calloc (values, sizeof *f), *g = pg_calloc (values, sizeof *g),
               *first = pg_calloc (values, sizeof *first), energy = body_plain (&b, 0, g, NULL), stored = 0;
        for (int k = 0; k < SETS; k++)
            for (int threads = 1; threads <= 3; threads++) {
                pg_bond_loop *s = NULL;
                if (!make_sweep (&s, &b, sets[k], threads, 0, 0)) continue;
                check_contains (pg_bond_loop_name (s), c->name);
                check_contains (pg_bond_loop_name (s), sets[k]);
                pg_bond_loop_update (s, b.alive, NULL);
                memset (f, 0x7f, values * sizeof *f);
                check_ok (pg_bond_loop_force (s, b.u, f, NULL));
                close_to (f, g, values, 1e-13);
                double now = pg_bond_loop_energy (s, b.u);
                check_scaled (now, energy, 1e-12, 1e-300);
                if (threads == 1 && (k == 0 || (k == 1 && c->apart))) {
                    memcpy (first, f, values * sizeof *f);
                    stored = now;
                }
                assert_memory_equal (f, first, values * sizeof *f);
                check_ok (pg_bond_loop_energies (s, b.u, f));
                close_to (f, b.W, b.cloud.n, 1e-12);
                assert_true (now == stored);
                pg_bond_loop_free (&s);
                assert_null (s);
            }
        pg_free (f), pg_free (g), pg_free (first);
        body_free (&b);
    }
}

/* Rounds that move the points a little more each: the bonds that break, in the order of the list, and the
 * forces after that. */
static inline void rounds_break_as_the_plain_loop (body *b, pg_bond_loop *s)
{
    size_t values = b->cloud.n * (size_t) b->cloud.dim, total = 0;
    double *f = pg_calloc (values, sizeof *f), *g = pg_calloc (values, sizeof *g);
    unsigned char *dead = pg_calloc (b->nbond, 1);
    pg_changes broken = { 0 };
    pg_bond_loop_update (s, b->alive, NULL);
    for (int round = 0; round < 4; round++) {
        for (size_t i = 0; i < values; i++) b->u[i] *= 1.4;
        memset (dead, 0, b->nbond);
        body_plain (b, 1, g, dead);
        size_t had = broken.n, at = had;               /* told behind those before */
        check_ok (pg_bond_loop_force (s, b->u, f, &broken));
        for (size_t e = 0; e < b->nbond; e++) {
            if (!dead[e]) continue;
            assert_true (at < broken.n);
            assert_int_equal (broken.bond[at++], e);
        }
        assert_int_equal (at, broken.n);
        close_to (f, g, values, 1e-13);
        total += broken.n - had;
    }
    if (b->nbond > 100) assert_true (total > 0 && total < b->nbond);
    pg_free (broken.bond), pg_free (f), pg_free (g), pg_free (dead);
}

static inline void breaking_equals_the_plain_loop (const swept *c)
{
    for (size_t w = 0; w < c->n; w++)
        for (int k = 0; k < 2 * SETS; k++) {
            body b;
            int exempt = k >= SETS;
            pg_bond_loop *s = NULL;
            c->create (&b, w, 100 + w);
            body_wound (&b, 0.1);
            for (size_t i = 0; exempt && i < b.cloud.n; i++) b.exempt[i] = body_random (&b) < 0.2;
            if (make_sweep (&s, &b, sets[k % SETS], 1 + k % 2, 1, exempt))
                rounds_break_as_the_plain_loop (&b, s);
            pg_bond_loop_free (&s);
            body_free (&b);
        }
}

static inline void updates_by_changes_equal_whole_ones (const swept *c)
{
    for (size_t w = 0; w < c->n; w++) {
        body b;
        c->create (&b, w, 31 + w);
        size_t values = b.cloud.n * (size_t) b.cloud.dim;
        double *f = pg_calloc (values, sizeof *f), *g = pg_calloc (values, sizeof *g);
        pg_bond_loop *s = NULL, *t = NULL;
        make_sweep (&s, &b, NULL, 1, 0, 0), make_sweep (&t, &b, NULL, 2, 0, 0);
        for (int round = 0; round < 3; round++) {
            pg_changes changes = { .bond = pg_calloc (b.nbond, sizeof *changes.bond) };
            unsigned char *before = pg_calloc (b.nbond, 1);
            memcpy (before, b.alive, b.nbond);
            body_wound (&b, 0.1);
            for (size_t e = 0; e < b.nbond; e++) if (before[e] && !b.alive[e]) changes.bond[changes.n++] = e;
            pg_bond_loop_update (s, b.alive, &changes);
            pg_bond_loop_update (t, b.alive, NULL);
            check_ok (pg_bond_loop_force (s, b.u, f, NULL));
            check_ok (pg_bond_loop_force (t, b.u, g, NULL));
            assert_memory_equal (f, g, values * sizeof *f);
            pg_free (changes.bond), pg_free (before);
        }
        memset (b.alive, 1, b.nbond);                  /* resurrection: a state may be read back */
        pg_bond_loop_update (s, b.alive, NULL);
        body_plain (&b, 0, g, NULL);
        check_ok (pg_bond_loop_force (s, b.u, f, NULL));
        close_to (f, g, values, 1e-13);
        pg_bond_loop_free (&s), pg_bond_loop_free (&t);
        pg_free (f), pg_free (g);
        body_free (&b);
    }
}

/* Each allocation of pg_bond_loop_create fails once: nothing is left. Then the sweep; `most`: allocations at
 * the most. */
static inline void creation_survives_lack_of_memory (pg_bond_loop **s, const body *b, size_t most)
{
    size_t before = pg_memory_used (), k = 1;
    pg_bond_loop_setting setting = { .sums = b->sums,
                                     .family = &b->family,
                                     .modulus = b->modulus,
                                     .limit = b->limit,
                                     .exempt = b->exempt,
                                     .threads = 1 };
    for (;; k++) {
        pg_memory_fail_at (k);
        pg_status status = pg_bond_loop_create (s, &setting);
        pg_memory_fail_at (0);
        if (status == PG_OK) break;
        assert_int_equal (status, PG_E_MEMORY);
        assert_null (*s);
        assert_int_equal (pg_memory_used (), before);
        assert_true (k < most);
    }
    assert_true (k > 8);
}

/* Sums in which nothing breaks allocate nothing. bytes: per bond more than the first, less than the second;
 * points cost 60 to 140. */
static inline void steady_sums_cost_what_is_said (const swept *c, int threads, double least, double most)
{
    body b;
    c->create (&b, 0, 3);
    double *f = pg_calloc (b.cloud.n * (size_t) b.cloud.dim, sizeof *f), per_bond, per_point;
    pg_changes broken = { 0 };
    pg_bond_loop *s = NULL;
    make_sweep (&s, &b, NULL, threads, 1, 0);
    pg_bond_loop_bytes (s, &per_bond, &per_point);
    assert_true (per_bond > least && per_bond < most && per_point > 60 && per_point < 140);
    size_t calls = pg_memory_calls ();
    for (int k = 0; k < 5; k++) check_ok (pg_bond_loop_force (s, b.u, f, &broken));
    assert_int_equal (broken.n, 0);
    assert_int_equal (pg_memory_calls (), calls);
    pg_bond_loop_free (&s);
    pg_free (f);
    body_free (&b);
}
#endif

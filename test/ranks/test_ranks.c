/* SPDX-License-Identifier: GPL-3.0-or-later
 * What ranks do together: sums and maxima, statuses that all learn of, ghosts, parts of a body across the
 * boundaries of subdomains. In processes of their own, without MPI. */
#include "forked.h"
#include <time.h>

/* ---- sums and statuses --------------------------------------------------------------------------------- */
static int sums_and_maxima (void)
{
    double v[2] = { pg_rank () + 1, -pg_rank () }, size = pg_rank_count ();
    SEE (pg_ranks_sum (2, v) == PG_OK && v[0] == size * (size + 1) / 2 && v[1] == -size * (size - 1) / 2);
    v[0] = -1 - pg_rank (), v[1] = pg_rank ();
    SEE (pg_ranks_most (2, v) == PG_OK && v[0] == -1 && v[1] == size - 1);
    SEE (pg_ranks_sum (0, NULL) == PG_OK && pg_ranks_most (0, NULL) == PG_OK);
    return 0;
}

/* In lock-step each has the whole body, and is still one of several. */
static int lock_step (void)
{
    double v = pg_rank () + 1, n, *all = NULL;
    size_t bytes = 0;
    void *words = NULL;
    int rank = pg_rank (), count = pg_rank_count ();
    pg_ranks_divide (0);
    SEE (pg_ranks_now () == NULL && pg_rank () == rank && pg_rank_count () == count);
    n = v;
    SEE (pg_ranks_sum (1, &n) == PG_OK && n == v);
    SEE (pg_ranks_most (1, &n) == PG_OK && n == v);
    SEE (pg_ranks_ask (1, &n) == PG_OK && n == count);
    SEE (pg_ranks_share (1, &v, &bytes, &all) == PG_OK && bytes == 1 && all[0] == v);
    SEE (pg_ranks_collect (3, "ab", &bytes, &words) == PG_OK && bytes == 3 && strcmp (words, "ab") == 0);
    pg_free (all), pg_free (words);
    pg_ranks_divide (1);
    SEE (pg_ranks_now () != NULL);
    n = v;
    SEE (pg_ranks_most (1, &n) == PG_OK && n == count);
    return 0;
}

/* Rank 1 and those after it fail, each with words of its own: all learn of that of rank 1. */
static int agree_on (int divided)
{
    pg_status own = PG_OK;
    pg_ranks_divide (divided);
    SEE (pg_ranks_agree (PG_OK) == PG_OK);
    if (pg_rank () > 0) own = pg_error (pg_rank () == 1 ? PG_E_LIMIT : PG_E_FILE, PG_HERE, "rank %d at "
                                        "100 %%s", pg_rank ());
    SEE (pg_ranks_agree (own) == PG_E_LIMIT);
    SEE (strcmp (pg_last_error (), "rank 1 at 100 %s") == 0);
    /* more words than travel are cut, not lost */
    char text[800] = "";
    memset (text, 'x', sizeof text - 1);
    own = pg_rank () == 2 ? pg_error (PG_E_FILE, PG_HERE, "%s", text) : PG_OK;
    SEE (pg_ranks_agree (own) == PG_E_FILE && strlen (pg_last_error ()) > 200 && pg_last_error ()[200] ==
         'x');
    SEE (pg_ranks_agree (PG_OK) == PG_OK);
    return 0;
}
static int agree_divided (void) { return agree_on (1); }
static int agree_in_lock_step (void) { return agree_on (0); }

/* Time in messages adds up: the others wait for the last one. */
static int time_adds_up (void)
{
    double v = 0, first;
    if (pg_rank () == 1) nanosleep (&(struct timespec) { 0, 30000000 }, NULL);
    SEE (pg_ranks_sum (1, &v) == PG_OK);
    first = pg_ranks_seconds ();
    if (pg_rank () == 0) SEE (first > 0.01);
    SEE (pg_ranks_sum (1, &v) == PG_OK && pg_ranks_seconds () > first);
    return 0;
}

static void ranks_add_up (void **state) { (void) state; assert_int_equal (forked (3, sums_and_maxima), 3); }
static void ranks_in_lock_step_are_alone_but_for_what_they_ask (void **state)
{
    (void) state;
    assert_int_equal (forked (3, lock_step), 3);
}
static void the_first_failure_is_that_of_all (void **state)
{
    (void) state;
    assert_int_equal (forked (4, agree_divided), 4);
    assert_int_equal (forked (4, agree_in_lock_step), 4);
    assert_int_equal (pg_ranks_agree (PG_E_SINGULAR), PG_E_SINGULAR);      /* alone */
}
static void waiting_is_time_in_messages (void **state)
{
    (void) state;
    assert_int_equal (forked (2, time_adds_up), 2);
}

static void ranks_that_one_process_plays_change_nothing (void **state)
{
    pg_ranks played;
    double v = 3;
    size_t n = 0;
    double *all = NULL;
    (void) state;
    pg_ranks_stand_in (&played, 5);
    pg_ranks_join (&played);
    assert_int_equal (pg_rank_count (), 5);
    assert_int_equal (pg_rank (), 0);
    assert_non_null (pg_ranks_now ());
    assert_true (pg_ranks_now ()->whole);
    check_ok (pg_ranks_sum (1, &v));
    check_ok (pg_ranks_share (1, &v, &n, &all));
    assert_true (v == 3 && n == 1 && all[0] == 3);
    pg_free (all);
    pg_ranks_join (NULL);
    assert_int_equal (pg_rank_count (), 1);
    assert_null (pg_ranks_now ());
}

/* ---- a row of points ----------------------------------------------------------------------------------- */
enum { EACH = 5 };
static size_t place_of (const pg_subdomain *s, long number)
{
    size_t i = 0;
    while (s->number[i] != number) i++;
    return i;
}

/* Rank r owns the points EACH r .. EACH (r + 1) - 1 of a row and holds one ghost at each side that has a
 * neighbour. Those inside come first, then both ends, then ghosts, so that numbers and places differ. */
static int row_of_points (pg_subdomain *s)
{
    int rank = pg_rank (), size = pg_rank_count ();
    long low = EACH * rank, high = low + EACH - 1;
    pg_halo *h = &s->halo;
    memset (s, 0, sizeof *s);
    s->nowned = EACH, s->total = EACH * size;
    s->owned = pg_calloc (EACH + 2, 1), s->number = pg_calloc (EACH + 2, sizeof *s->number);
    h->rank = pg_calloc (2, sizeof (int)), h->send_first = pg_calloc (3, sizeof (size_t));
    h->send = pg_calloc (2, sizeof (int)), h->receive_first = pg_calloc (3, sizeof (size_t));
    h->receive = pg_calloc (2, sizeof (int));
    SEE (s->owned && s->number && h->rank && h->send && h->receive && h->send_first && h->receive_first);
    for (long i = low + 1; i < high; i++) s->number[s->n++] = i;
    s->number[s->n++] = low, s->number[s->n++] = high;
    memset (s->owned, 1, s->n);
    if (rank > 0) s->number[s->n++] = low - 1;
    if (rank + 1 < size) s->number[s->n++] = high + 1;
    for (int side = -1; side <= 1; side += 2) {
        if (rank + side < 0 || rank + side >= size) continue;
        h->rank[h->n] = rank + side;
        h->send[h->n] = (int) place_of (s, side < 0 ? low : high);
        h->receive[h->n] = (int) place_of (s, side < 0 ? low - 1 : high + 1);
        h->n++;
        h->send_first[h->n] = h->receive_first[h->n] = h->n;
    }
    return 0;
}
static void clear (pg_subdomain *s) { pg_free (s->owned), pg_free (s->number), pg_halo_clear (&s->halo); }

static int ghosts (void)
{
    pg_subdomain s;
    double v[2 * (EACH + 2)];
    if (row_of_points (&s)) return 1;
    for (size_t i = 0; i < s.n; i++) v[2*i] = s.owned[i] ? (double) s.number[i] : -9, v[2*i + 1] = -v[2*i]
        / 2;
    SEE (pg_subdomain_exchange (&s, 2, v) == PG_OK);
    for (size_t i = 0; i < s.n; i++) SEE (v[2*i] == (double) s.number[i] && v[2*i + 1] ==
                                          -(double) s.number[i] / 2);
    for (size_t i = 0; i < s.n; i++) v[2*i] = v[2*i + 1] = 1;
    pg_subdomain_clear_ghosts (&s, 2, v);
    for (size_t i = 0; i < s.n; i++) SEE (v[2*i] == s.owned[i] && v[2*i + 1] == s.owned[i]);
    for (size_t i = 0; i < s.n; i++) SEE (pg_owns (&s, i) == s.owned[i] && pg_owns (NULL, i));
    clear (&s);
    return 0;
}

/* The row is broken behind the points 1, 2, EACH + 1 and 2 EACH - 1: {0 1} {2} {3 .. EACH + 1} {.. 2 EACH -
 * 1}
 * {the rest}, of which the last one begins at a ghost of rank 1. */
static int broken_behind (int64_t i) { return i == 1 || i == 2 || i == EACH + 1 || i == 2 * EACH - 1; }
static int64_t first_of (int64_t i)
{
    return i < 2 ? 0 : i == 2 ? 2 : i < EACH + 2 ? 3 : i < 2 * EACH ? EACH + 2 : 2 * EACH;
}

static int parts (void)
{
    pg_subdomain s;
    int parent[EACH + 2];
    double label[EACH + 2], out[2];
    if (row_of_points (&s)) return 1;
    pg_disjoint_start (parent, s.n);
    for (size_t i = 0; i < s.n; i++)
        for (size_t j = 0; j < s.n; j++)
            if (s.number[j] == s.number[i] + 1 && !broken_behind (s.number[i]))
                pg_disjoint_join (parent, (int) i, (int) j);
    SEE (pg_subdomain_label (&s, s.n, 1, parent, label) == PG_OK);
    for (size_t i = 0; i < s.n; i++) SEE (label[i] == (double) first_of (s.number[i]));
    SEE (pg_subdomain_count (&s, s.n, parent, out) == PG_OK);
    SEE (out[0] == 1 && out[1] == (pg_rank_count () > 2 ? 4 : 3));
    clear (&s);
    return 0;
}

/* Two unknowns a point: the first hangs together with none, the second along the ends of the subdomains. */
static int parts_of_unknowns (void)
{
    pg_subdomain s;
    int parent[2 * (EACH + 2)];
    double label[2 * (EACH + 2)];
    if (row_of_points (&s)) return 1;
    pg_disjoint_start (parent, 2 * s.n);
    for (size_t i = EACH - 2; i + 1 < s.n; i++) pg_disjoint_join (parent, (int) (2*i + 1), (int) (2*i + 3));
    SEE (pg_subdomain_label (&s, s.n, 2, parent, label) == PG_OK);
    for (size_t i = 0; i < s.n; i++) {
        SEE (label[2*i] == 2 * (double) s.number[i]);
        SEE (label[2*i + 1] == (i < EACH - 2 ? 2 * (double) s.number[i] + 1 : 1));
    }
    clear (&s);
    return 0;
}

static void ghosts_take_the_values_of_their_owners (void **state)
{
    (void) state;
    for (int size = 1; size <= 4; size++) assert_int_equal (forked (size, ghosts), size);
}

static void parts_are_found_across_subdomains (void **state)
{
    (void) state;
    for (int size = 2; size <= 5; size++) {
        assert_int_equal (forked (size, parts), size);
        assert_int_equal (forked (size, parts_of_unknowns), size);
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (ranks_add_up),
        cmocka_unit_test (ranks_in_lock_step_are_alone_but_for_what_they_ask),
        cmocka_unit_test (the_first_failure_is_that_of_all),
        cmocka_unit_test (waiting_is_time_in_messages),
        cmocka_unit_test (ranks_that_one_process_plays_change_nothing),
        cmocka_unit_test (ghosts_take_the_values_of_their_owners),
        cmocka_unit_test (parts_are_found_across_subdomains),
    };
    return cmocka_run_group_tests (tests, NULL, NULL);
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * A lattice divided among ranks: boxes that cover it once, with equal shares of what counts, the same on all
 * ranks although each counts a part of the planes. */
#include "forked.h"

static const pg_box wide = { { -3, 2, 0 }, { 33, 26, 0 } };
/* of unequal steps: across the longest side in metres, not in cells */
static const double even[3] = { 1, 1, 1 }, flat[3] = { 1, 4, 1 };

static double everywhere (const void *context, const pg_box *b, int axis, int plane)
{
    double n = 1;
    (void) context, (void) plane;
    for (int k = 0; k < 3; k++) if (k != axis && b->high[k] > b->low[k]) n *= b->high[k] - b->low[k];
    return n;
}

/* cells of a wedge: those below a diagonal */
static int in_wedge (int i, int j) { return 2 * (i + 3) < 3 * (j - 2); }
static double wedge (const void *context, const pg_box *b, int axis, int plane)
{
    double n = 0;
    (void) context;
    for (int i = b->low[1 - axis]; i < b->high[1 - axis]; i++)
        n += axis == 0 ? in_wedge (plane, i) : in_wedge (i, plane);
    return n;
}

/* Every cell lies in one box; in each box as many that count as in the others, but for a plane. */
static int divides (pg_plane_count count, const double *steps, double spread)
{
    int size = pg_rank_count ();
    pg_box box[MOST_RANKS];
    double all = 0, share[MOST_RANKS] = { 0 }, mine[6 * MOST_RANKS], *others = NULL;
    size_t n;
    SEE (pg_boxes_divide (box, &wide, steps, size, count, NULL) == PG_OK);
    for (int i = wide.low[0]; i < wide.high[0]; i++)
        for (int j = wide.low[1]; j < wide.high[1]; j++) {
            int in = 0, counts = count == everywhere || in_wedge (i, j);
            for (int r = 0; r < size; r++) {
                if (i < box[r].low[0] || i >= box[r].high[0] || j < box[r].low[1] || j >=
                    box[r].high[1]) continue;
                in++, share[r] += counts;
            }
            SEE (in == 1);
            all += counts;
        }
    for (int r = 0; r < size; r++) SEE (fabs (share[r] - all / size) <= spread * all / size);
    for (int r = 0; r < size; r++)
        for (int k = 0; k < 3; k++) mine[6*r + k] = box[r].low[k], mine[6*r + 3 + k] = box[r].high[k];
    SEE (pg_ranks_share (6 * (size_t) size, mine, &n, &others) == PG_OK);
    SEE (n == 6 * (size_t) size * (size_t) size);
    for (size_t k = 0; k < n; k++) SEE (others[k] == mine[k % (6 * (size_t) size)]);
    pg_free (others);
    return 0;
}
static int body (void) { return divides (everywhere, even, 0.06); }
static int part_of_it (void) { return divides (wedge, even, 0.25); }

static int ranks_have_equal_boxes (void)
{
    pg_box box[2];
    SEE (pg_boxes_divide (box, &wide, even, 2, everywhere, NULL) == PG_OK);
    SEE (box[0].low[0] == -3 && box[0].high[0] == 15 && box[1].low[0] == 15 && box[1].high[0] == 33);
    SEE (box[0].low[1] == 2 && box[0].high[1] == 26);
    SEE (pg_boxes_divide (box, &wide, flat, 2, everywhere, NULL) == PG_OK);
    SEE (box[0].high[1] == 14 && box[1].low[1] == 14 && box[0].high[0] == 33);
    return 0;
}

/* a side of one plane is never cut, however long it is */
static int one_plane_stays_whole (void)
{
    static const pg_box strip = { { 0, 0, 0 }, { 1, 8, 0 } };
    static const double steps[3] = { 100, 1, 1 };
    pg_box box[2];
    SEE (pg_boxes_divide (box, &strip, steps, 2, everywhere, NULL) == PG_OK);
    SEE (box[0].high[0] == 1 && box[0].high[1] == 4 && box[1].low[1] == 4);
    return 0;
}

/* sides that differ by rounding are equal: the first is cut */
static int rounding_does_not_choose (void)
{
    static const pg_box square = { { 0, 0, 0 }, { 8, 8, 0 } };
    static const double steps[3] = { 0.1, 0.1 * (1 + 1e-14), 1 };
    pg_box box[2];
    SEE (pg_boxes_divide (box, &square, steps, 2, everywhere, NULL) == PG_OK);
    SEE (box[0].high[0] == 4 && box[0].high[1] == 8);
    return 0;
}

static int too_many (void)
{
    static const pg_box few = { { 0, 0, 0 }, { 3, 1, 0 } };
    pg_box box[MOST_RANKS];
    SEE (pg_boxes_divide (box, &few, even, pg_rank_count (), everywhere, NULL) == PG_E_LIMIT);
    SEE (strstr (pg_last_error (), "take fewer") != NULL);
    return 0;
}

static void boxes_cover_the_body_once (void **state)
{
    (void) state;
    for (int size = 1; size <= MOST_RANKS; size++) {
        assert_int_equal (forked (size, body), size);
        assert_int_equal (forked (size, part_of_it), size);
    }
}

static void the_longest_side_is_cut (void **state)
{
    (void) state;
    assert_int_equal (forked (2, ranks_have_equal_boxes), 2);
    assert_int_equal (forked (2, one_plane_stays_whole), 2);
    assert_int_equal (forked (2, rounding_does_not_choose), 2);
}

static void more_ranks_than_planes_are_refused (void **state)
{
    (void) state;
    assert_int_equal (forked (4, too_many), 4);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (boxes_cover_the_body_once),
        cmocka_unit_test (the_longest_side_is_cut),
        cmocka_unit_test (more_ranks_than_planes_are_refused),
    };
    return cmocka_run_group_tests (tests, NULL, NULL);
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * Solids on a screen: every side shows its own face and hides what is behind it, mirrored bodies give
 * mirrored views, openings stay open, outer half cells end at the body. */
#include "check.h"
#include "io/picture/picture_private.h"
#include "fonts.h"
#include "io/output/sample.h"

enum { M = 9, SIZE = 180 };

typedef struct { pg_cloud cloud; pg_grid grid; double *value, *u, *damage; } body;

/* Cells of 1 mm, M to each axis, x fastest. */
static void make_body (body *b)
{
    *b = (body) { 0 };
    make_cloud (&b->cloud, 3, M, 1e-3);
    for (size_t i = 0; i < b->cloud.n; i++) b->cloud.volume[i] = 1e-9;
    b->value = pg_calloc (b->cloud.n, sizeof (double));
    b->u = pg_calloc (3 * b->cloud.n, sizeof (double));
    check_ok (pg_grid_build (&b->grid, &b->cloud));
}

static void drop_body (body *b)
{
    pg_grid_clear (&b->grid);
    pg_free (b->value), pg_free (b->u);
    drop_cloud (&b->cloud);
}

static int index_along (size_t i, int axis)
{
    return (int) (axis == 0 ? i % M : axis == 1 ? i / M % M : i / (M * M));
}

/* The frame is the box with a margin of one cell; 20 pixels a cell across for the sides. */
static void draw (const body *b, int view, double magnify, const unsigned char *keep, pg_eye *eye,
                  pg_screen *screen)
{
    double low[2] = { INFINITY, INFINITY }, high[2] = { -INFINITY, -INFINITY };
    check_ok (pg_eye_open (eye, &b->cloud, &(pg_picture_style) { .view = view }));
    for (int corner = 0; corner < 8; corner++) {
        double x[3];
        for (int a = 0; a < 3; a++) x[a] = corner >> a & 1 ? b->grid.high[a] : b->grid.low[a];
        for (int a = 0; a < 2; a++) {
            double s = pg_along (a ? eye->up : eye->right, x, 3);
            low[a] = fmin (low[a], s), high[a] = fmax (high[a], s);
        }
    }
    double room = fmax (high[0] - low[0], high[1] - low[1]) + 2e-3;
    *screen = (pg_screen){ .left = 0.5 * (low[0] + high[0] - room),
                           .top = 0.5 * (low[1] + high[1] + room),
                           .scale = SIZE / room };
    check_ok (pg_screen_open (screen, SIZE, SIZE));
    pg_solid_draw (&(pg_solid){ &b->cloud, &b->grid, eye, magnify != 0 ? b->u : NULL, magnify, keep,
                                b->damage },
                   screen);
}

static size_t count_of (const pg_screen *s, int owner)
{
    size_t n = 0;
    for (size_t p = 0; p < SIZE * SIZE; p++) n += s->owner[p] == owner;
    return n;
}

static void every_side_shows_its_own_face (void **state)
{
    (void) state;
    static const struct {
        int view, axis, at;
    } side[] = { { PG_VIEW_FRONT, 2, M - 1 }, { PG_VIEW_BACK, 2, 0 },    { PG_VIEW_LEFT, 0, 0 },
                 { PG_VIEW_RIGHT, 0, M - 1 }, { PG_VIEW_TOP, 1, M - 1 }, { PG_VIEW_BOTTOM, 1, 0 } };
    body b;
    make_body (&b);
    for (size_t k = 0; k < 6; k++) {
        pg_eye eye;
        pg_screen s;
        size_t seen = 0;
        draw (&b, side[k].view, 0, NULL, &eye, &s);
        for (size_t p = 0; p < SIZE * SIZE; p++) {
            if (s.owner[p] < 0) continue;
            assert_int_equal (index_along ((size_t) s.owner[p], side[k].axis), side[k].at);
            seen++;
        }
        check_relative ((double) seen, pow (SIZE * 9.0 / 11, 2), 0.02);
        pg_screen_close (&s);
    }
    drop_body (&b);
}

/* What is right and up of each side, by the points at the middle of the right and the upper rim. */
static void sides_are_not_mirrored (void **state)
{
    (void) state;
    static const struct {
        int view, across, right, upward, top;
    } side[] = { { PG_VIEW_FRONT, 0, M - 1, 1, M - 1 }, { PG_VIEW_BACK, 0, 0, 1, M - 1 },
                 { PG_VIEW_LEFT, 2, M - 1, 1, M - 1 },  { PG_VIEW_RIGHT, 2, 0, 1, M - 1 },
                 { PG_VIEW_TOP, 0, M - 1, 2, 0 },       { PG_VIEW_BOTTOM, 0, M - 1, 2, M - 1 } };
    body b;
    make_body (&b);
    for (size_t k = 0; k < 6; k++) {
        pg_eye eye;
        pg_screen s;
        draw (&b, side[k].view, 0, NULL, &eye, &s);
        int right = s.owner[SIZE / 2 * SIZE + SIZE * 10 / 11 - 4],
            top = s.owner[(SIZE / 11 + 4) * SIZE + SIZE / 2];
        assert_true (right >= 0 && top >= 0);
        assert_int_equal (index_along ((size_t) right, side[k].across), side[k].right);
        assert_int_equal (index_along ((size_t) top, side[k].upward), side[k].top);
        pg_screen_close (&s);
    }
    drop_body (&b);
}

static void iso_shows_three_faces_and_nothing_inside (void **state)
{
    (void) state;
    body b;
    pg_eye eye;
    pg_screen s;
    int seen[3] = { 0 };
    make_body (&b);
    draw (&b, PG_VIEW_ISO, 0, NULL, &eye, &s);
    for (size_t p = 0; p < SIZE * SIZE; p++) {
        if (s.owner[p] < 0) continue;
        int outside = 0;
        for (int a = 0; a < 3; a++) outside |= (index_along ((size_t) s.owner[p], a) == M - 1) << a;
        assert_true (outside);
        for (int a = 0; a < 3; a++) seen[a] += outside == 1 << a;
    }
    assert_true (seen[0] > 1000 && seen[1] > 1000 && seen[2] > 1000);
    assert_true (s.shade[SIZE / 2 * SIZE + SIZE / 2] > 0.6f);
    pg_screen_close (&s);
    drop_body (&b);
}

/* The owner of each pixel, mirrored with the body; pixels on edges may fall to either side. */
static void a_mirrored_body_gives_the_mirrored_view (void **state)
{
    (void) state;
    body b;
    pg_eye eye;
    pg_screen one, two;
    unsigned char keep[M * M * M], mirrored[M * M * M];
    size_t differ = 0, seen = 0;
    make_body (&b);
    for (size_t i = 0; i < b.cloud.n; i++) keep[i] = (i * 2654435761u >> 7 & 3) != 0;
    for (size_t i = 0; i < b.cloud.n; i++) mirrored[i] = keep[i - i % M + (M - 1 - i % M)];
    for (int view = PG_VIEW_FRONT; view <= PG_VIEW_BACK; view++) {
        draw (&b, view, 0, keep, &eye, &one);
        draw (&b, view, 0, mirrored, &eye, &two);
        for (int j = 0; j < SIZE; j++)
            for (int i = 0; i < SIZE; i++) {
                int p = one.owner[j * SIZE + i], q = two.owner[j * SIZE + SIZE - 1 - i];
                differ += p < 0 || q < 0 ? p != q : q != p - p % M + (M - 1 - p % M);
                seen += p >= 0;
            }
        pg_screen_close (&one), pg_screen_close (&two);
    }
    assert_true (seen > 30000 && differ < seen / 50);
    drop_body (&b);
}

static void half_a_turn_swaps_front_and_back (void **state)
{
    (void) state;
    body b;
    pg_eye eye;
    pg_screen one, two;
    unsigned char keep[M * M * M], turned[M * M * M];
    size_t differ = 0;
    make_body (&b);
    for (size_t i = 0; i < b.cloud.n; i++) keep[i] = (i * 2246822519u >> 9 & 3) != 0;
    for (size_t i = 0; i < b.cloud.n; i++)
        turned[i] = keep[(M - 1 - i / (M * M)) * M * M + i / M % M * M + (M - 1 - i % M)];
    draw (&b, PG_VIEW_FRONT, 0, keep, &eye, &one);
    draw (&b, PG_VIEW_BACK, 0, turned, &eye, &two);
    for (size_t p = 0; p < SIZE * SIZE; p++) {
        size_t i = (size_t) two.owner[p];
        int back = two.owner[p] < 0 ? -1
                                    : (int) ((M - 1 - i / (M * M)) * M * M + i / M % M * M + (M - 1 - i % M));
        differ += one.owner[p] != back;
    }
    assert_true (differ < SIZE * SIZE / 50);
    pg_screen_close (&one), pg_screen_close (&two);
    drop_body (&b);
}

/* Halves drawn apart by `gap` cells in x. */
static size_t empty_between (double gap)
{
    body b;
    pg_eye eye;
    pg_screen s;
    size_t empty = 0;
    make_body (&b);
    for (size_t i = 0; i < b.cloud.n; i++) b.u[3 * i] = (i % M < M / 2 ? -0.5 : 0.5) * gap * 1e-6;
    draw (&b, PG_VIEW_FRONT, 1000, NULL, &eye, &s);
    for (int i = 40; i < SIZE - 40; i++) empty += s.owner[SIZE / 2 * SIZE + i] < 0;
    pg_screen_close (&s);
    drop_body (&b);
    return empty;
}

static void an_opening_stays_open_and_a_stretch_leaves_no_gap (void **state)
{
    (void) state;
    assert_int_equal (empty_between (0.4), 0);
    check_relative ((double) empty_between (0.8), 0.8 * SIZE / 11.0, 0.1);
}

/* Stretched to two and a half times its length, a whole body has no hole in it; one whose damage is not known
 * is taken for torn. */
static void whole_points_hold_together (void **state)
{
    (void) state;
    for (int known = 0; known < 2; known++) {
        body b;
        pg_eye eye;
        pg_screen s;
        size_t empty = 0;
        double none[M * M * M] = { 0 };
        make_body (&b);
        if (known) b.damage = none;
        for (size_t i = 0; i < b.cloud.n; i++) b.u[3 * i] = 1.5e-6 * ((double) (i % M) - M / 2);
        draw (&b, PG_VIEW_FRONT, 1000, NULL, &eye, &s);
        for (int i = 10; i < SIZE - 10; i++) empty += s.owner[SIZE / 2 * SIZE + i] < 0;
        assert_true (known ? empty == 0 : empty > 30);
        pg_screen_close (&s);
        drop_body (&b);
    }
}

static void displaced_points_move_by_the_multiple (void **state)
{
    (void) state;
    body b;
    pg_eye eye;
    pg_screen still, moved;
    make_body (&b);
    for (size_t i = 0; i < b.cloud.n; i++) b.u[3 * i] = 1e-6;
    draw (&b, PG_VIEW_FRONT, 0, NULL, &eye, &still);
    draw (&b, PG_VIEW_FRONT, 1e3, NULL, &eye, &moved);
    int first[2] = { 0, 0 };
    while (still.owner[SIZE / 2 * SIZE + first[0]] < 0) first[0]++;
    while (moved.owner[SIZE / 2 * SIZE + first[1]] < 0) first[1]++;
    assert_in_range (first[1] - first[0], SIZE / 11 - 1, SIZE / 11 + 1);
    pg_screen_close (&still), pg_screen_close (&moved);
    drop_body (&b);
}

static void half_cells_end_at_the_body (void **state)
{
    (void) state;
    body b;
    make_body (&b);
    for (size_t i = 0; i < b.cloud.n; i++) {
        int face = 0;
        for (int a = 0; a < 3; a++) face += index_along (i, a) == 0 || index_along (i, a) == M - 1;
        b.cloud.volume[i] = 1e-9 / (1 << face);
    }
    pg_grid_clear (&b.grid);
    check_ok (pg_grid_build (&b.grid, &b.cloud));
    for (int a = 0; a < 3; a++) {
        check_relative (b.grid.high[a] - b.grid.low[a], (M - 1) * 1e-3, 1e-9);
        check_scaled (b.grid.low[a], b.cloud.low[a], 1e-9, 1e-3);
    }
    drop_body (&b);
}

static void a_cloud_without_lattice_is_drawn_as_loose_cubes (void **state)
{
    (void) state;
    body b;
    pg_eye eye;
    pg_screen s;
    make_body (&b);
    b.cloud.x[3] = b.cloud.x[0] + 1e-5;
    pg_grid_clear (&b.grid);
    check_ok (pg_grid_build (&b.grid, &b.cloud));
    assert_true (b.grid.loose && !b.grid.at);
    draw (&b, PG_VIEW_FRONT, 0, NULL, &eye, &s);
    assert_true (count_of (&s, -1) > 0 && count_of (&s, (int) b.cloud.n - 1) > 100);
    pg_screen_close (&s);
    drop_body (&b);
}

static void the_body_behind_a_choice_is_a_ghost (void **state)
{
    (void) state;
    body b;
    pg_eye eye;
    pg_screen s;
    unsigned char keep[M * M * M] = { 0 };
    make_body (&b);
    keep[M * M * M / 2] = 1;                           /* the one in the middle */
    draw (&b, PG_VIEW_FRONT, 0, keep, &eye, &s);
    check_relative ((double) count_of (&s, M * M * M / 2), SIZE * SIZE / 121.0, 0.15);
    check_ok (pg_ghost_draw (&(pg_solid) { &b.cloud, &b.grid, &eye, NULL, 0, keep, NULL }, &s));
    check_relative ((double) count_of (&s, M * M * M / 2), SIZE * SIZE / 121.0, 0.15);
    assert_true (count_of (&s, PG_GHOST) > 15000 && count_of (&s, PG_EDGE) > 400);
    pg_screen_close (&s);
    drop_body (&b);
}

static void an_oblique_slice_shows_the_cells_it_cuts (void **state)
{
    (void) state;
    body b;
    pg_eye eye;
    pg_picture_style style = { 0 };
    make_body (&b);
    double middle = (-1 + 4 + 5 + 4) * 1e-3 / sqrt (2);  /* x + z of the middle */
    check_ok (pg_picture_section (&style, "1, 0, 1 = 1"));
    style.at = middle;
    check_ok (pg_eye_open (&eye, &b.cloud, &style));
    pg_screen s = { .left = -0.02, .top = 0.02, .scale = SIZE / 0.04 };
    check_ok (pg_screen_open (&s, SIZE, SIZE));
    pg_slice_draw (&b.grid, &eye, &s);
    size_t seen = 0;
    for (size_t p = 0; p < SIZE * SIZE; p++) {
        if (s.owner[p] < 0) continue;
        size_t i = (size_t) s.owner[p];
        assert_in_range (index_along (i, 0) + index_along (i, 2), M - 2, M);
        seen++;
    }
    check_relative ((double) seen, 9 * 9 * sqrt (2) * SIZE * SIZE / 1600, 0.05);
    pg_screen_close (&s);
    drop_body (&b);
}

/* A square of two triangles, in parts of the box; turned: their corners the other way around. */
static void put_square (const body *b, double corner[6][3], pg_crack crack[2], const double x[2],
                        const double y[2], const double z[2], int turned)
{
    static const int to[6] = { 0, 1, 2, 0, 2, 3 };
    for (int i = 0; i < 6; i++) {
        int k = to[turned ? 5 - i : i];
        const double at[3] = { x[k == 1 || k == 2], y[k > 1], z[k > 1] };
        for (int a = 0; a < 3; a++)
            corner[i][a] = b->grid.low[a] + at[a] * (b->grid.high[a] - b->grid.low[a]);
    }
    for (int k = 0; k < 2; k++)
        crack[k] = (pg_crack) { .kind = PG_CRACK_POLYGON, .vertex = corner[3*k], .nvertex = 3, .sided = 1 };
}

/* Surfaces of cracks from every side: what lies in the box and nothing else, at its place and with its depth,
 * whichever way the triangles turn; what is nearer hides what is behind. */
static void surfaces_of_cracks_are_seen_from_every_side (void **state)
{
    (void) state;
    static const struct { int view, turned; double width, height; } look[] = {
        { PG_VIEW_FRONT, 0, 0.5, 0.7 }, { PG_VIEW_FRONT, 1, 0.5, 0.7 }, { PG_VIEW_BACK, 0, 0.5, 0.7 },
        { PG_VIEW_TOP, 1, 0.5, 0.5 * 0.7 / 1.1 }, { PG_VIEW_RIGHT, 0, 0, 0 } };
    unsigned char keep[M * M * M] = { 0 };
    body b;
    make_body (&b);
    for (size_t k = 0; k < sizeof look / sizeof *look; k++) {
        double corner[12][3], box = b.grid.high[2] - b.grid.low[2];
        pg_crack crack[4];
        /* a slope that begins outside of the box, and a small level square in front of it */
        put_square (&b, corner, crack, (const double[]) { 0.25, 0.75 }, (const double[]) { -0.4, 0.7 },
                    (const double[]) { 0.3, 0.8 }, look[k].turned);
        put_square (&b, corner + 6, crack + 2, (const double[]) { 0.4, 0.6 }, (const double[]) { 0.2, 0.4 },
                    (const double[]) { 0.95, 0.95 }, look[k].turned);
        pg_cracks cracks = { .dim = 3, .crack = crack, .n = look[k].width > 0 ? 4 : 2 };
        pg_eye eye;
        pg_screen s;
        size_t seen = 0, level = 0, wrong = 0;
        draw (&b, look[k].view, 0, keep, &eye, &s);
        assert_int_equal (count_of (&s, 0), 0);
        assert_true (pg_cracks_grown (&cracks));
        check_ok (pg_cracks_draw (&(pg_solid) { &b.cloud, &b.grid, &eye, NULL, 0, keep, NULL }, &s, &cracks,
                                  NULL, 2, 1e-3));
        for (size_t p = 0; p < SIZE * SIZE; p++) {
            if (s.owner[p] != 0) continue;
            double up = s.top - ((double) (p / SIZE) + 0.5) / s.scale;
            double z = (s.value[p] * 1e-3 - b.grid.low[2]) / box;
            double y = (up - b.grid.low[1]) / box, slope = 0.3 + (y + 0.4) / 1.1 * 0.5;
            seen++, level += fabs (z - 0.95) < 1e-9;
            if (look[k].view <= PG_VIEW_BACK)
                wrong += fabs (z - 0.95) > 1e-9 && fabs (z - slope) > 0.01;
            assert_true (s.shade[p] > 0 && s.shade[p] <= 1);
        }
        double pixels = box * s.scale;
        assert_int_equal (wrong, 0);
        double expected = look[k].width * look[k].height * pixels * pixels;    /* but for the edges */
        assert_true (fabs ((double) seen - expected) < 3 * pixels);
        if (look[k].view == PG_VIEW_FRONT) check_relative ((double) level, 0.04 * pixels * pixels, 0.15);
        if (look[k].view == PG_VIEW_BACK) assert_int_equal (level, 0);
        pg_screen_close (&s);
    }
    drop_body (&b);
}

static void any_allocation_may_fail (void **state)
{
    (void) state;
    body b;
    make_body (&b);
    size_t before = pg_memory_used ();
    const char *path = file_at ("sweep.png");
    for (int view = 0; view < PG_VIEWS; view += 2) {
        pg_panel panel[2] = { { "one", b.value, b.u, NULL, NULL, NULL },
                              { "two", b.value, b.u, view == PG_VIEW_CRACK ? b.value : NULL, NULL, NULL } };
        pg_picture_style style = { .label = "v",
                                   .view = view,
                                   .magnify = view == PG_VIEW_LEFT,
                                   .by_depth = view == PG_VIEW_CRACK,
                                   .clip = 1 };
        pg_status status = PG_E_MEMORY;
        size_t k = 1;
        for (; status != PG_OK && k < 100; k++) {
            pg_memory_fail_at (k);
            status = pg_picture_panels (path, &b.cloud, 2, panel, 0, &style);
            pg_memory_fail_at (0);
            assert_true (status == PG_OK || status == PG_E_MEMORY);
            assert_int_equal (access (path, F_OK) == 0, status == PG_OK);
            assert_int_equal (pg_memory_used (), before);
        }
        assert_true (status == PG_OK && k > 5);
        remove (path);
    }
    drop_body (&b);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (every_side_shows_its_own_face),
        cmocka_unit_test (sides_are_not_mirrored),
        cmocka_unit_test (iso_shows_three_faces_and_nothing_inside),
        cmocka_unit_test (a_mirrored_body_gives_the_mirrored_view),
        cmocka_unit_test (half_a_turn_swaps_front_and_back),
        cmocka_unit_test (an_opening_stays_open_and_a_stretch_leaves_no_gap),
        cmocka_unit_test (whole_points_hold_together),
        cmocka_unit_test (displaced_points_move_by_the_multiple),
        cmocka_unit_test (half_cells_end_at_the_body),
        cmocka_unit_test (a_cloud_without_lattice_is_drawn_as_loose_cubes),
        cmocka_unit_test (the_body_behind_a_choice_is_a_ghost),
        cmocka_unit_test (an_oblique_slice_shows_the_cells_it_cuts),
        cmocka_unit_test (surfaces_of_cracks_are_seen_from_every_side),
        cmocka_unit_test (any_allocation_may_fail),
    };
    return cmocka_run_group_tests_name ("io/output/picture_solid", tests, NULL, remove_folder);
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * Cracks that grow: which bonds they cut, on which side points on their line stay, what is known of their
 * tips, what lies around these; copies, memory that runs out, checkpoints. */
#include "mechanics/model/growing.h"
#include <stdlib.h>

#define CRACKED(cracks, more) \
    PLATE "cracks: [" cracks "]\n" more "boundary: [{set: top, displacement: {y: 1}}, {set: bottom, " \
          "displacement: {x: 0, y: 0}}]\n"
#define EDGE "{from: [-0.1, 0.26], to: [0.42, 0.26]}"
#define LOW "{from: [-0.1, 0.06], to: [0.42, 0.06]}"
#define INSIDE "{from: [0.33, 0.22], to: [0.57, 0.28]}"

static size_t grow (growing *g, size_t tip, double x, double y, int close)
{
    check_ok (pg_crack_grow (g->s, g->p, tip, (double[]) { x, y }, close, &g->cut));
    return bury (g);
}

static void what_dies_is_what_the_path_cuts (void **state)
{
    (void) state;
    static const char *const method[] = { "", "method: {horizon: 3 spacing, basis: quadratic}\n",
                                          "method: {integration: nodal, approximation: nosb}\n",
                                          "method: {force: bond}\n", "method: {tip_offset: 0}\n" };
    for (size_t m = 0; m < sizeof method / sizeof *method; m++) {
        char text[900];
        snprintf (text, sizeof text, CRACKED (EDGE ", {from: [0.7, 0.1], to: [0.8, 0.2]}", "%s"), method[m]);
        growing g = begin (text);
        size_t dead = check_mask (&g, 1);
        assert_int_equal (g.s->paths->ntip, 3);
        assert_int_equal (g.s->paths->nfirst, 2);
        srand (3);
        double x = 0.42, y = 0.26, angle = 0;
        for (int k = 0; k < 6; k++) {
            angle += 1.2 * (rand () / (double) RAND_MAX - 0.5);
            x += 0.07 * cos (angle), y += 0.07 * sin (angle);
            dead += grow (&g, 0, x, y, 0);
            assert_int_equal (check_mask (&g, 1), dead);
        }
        dead += grow (&g, 1, 0.66, 0.03, 0);           /* the `from` of the other crack */
        assert_int_equal (check_mask (&g, 1), dead);
        check_relative (g.s->paths->length, 6 * 0.07 + hypot (0.04, 0.07), 1e-12);
        check_relative (g.s->paths->tip[0].grown, 6 * 0.07, 1e-12);
        check_absolute (g.s->paths->tip[0].x[0], x, 0), check_absolute (g.s->paths->tip[0].x[1], y, 0);
        assert_true (g.s->paths->tip[0].id == 1 && g.s->paths->tip[1].id == 2 && g.s->paths->tip[2].id == 3);
        dead += grow (&g, 1, 0.64, 0, 1);
        assert_int_equal (check_mask (&g, 1), dead);
        assert_false (g.s->paths->tip[1].open);
        check_fails (pg_crack_grow (g.s, g.p, 1, (double[]) { 0.6, 0 }, 0, &g.cut), PG_E_USAGE);
        check_fails (pg_crack_grow (g.s, g.p, 0, (double[]) { x, y }, 0, &g.cut), PG_E_USAGE);
        check_fails (pg_crack_grow (g.s, g.p, 3, (double[]) { x, y }, 0, &g.cut), PG_E_USAGE);
        end (&g);
    }
}

/* Whether it is cut in one stroke or in many, in one order or another: the same bonds at the end. */
static void strokes_do_not_matter (void **state)
{
    (void) state;
    growing a = begin (CRACKED (INSIDE, "")), b = begin (CRACKED (INSIDE, ""));
    const double dx = 0.03, dy = 0.03 * 0.06 / 0.24;
    for (int k = 1; k <= 6; k++) grow (&a, 1, 0.57 + k * dx, 0.28 + k * dy, 0);
    for (int k = 1; k <= 6; k++) grow (&a, 0, 0.33 - k * dx, 0.22 - k * dy, 0);
    grow (&b, 0, 0.33 - 6 * dx, 0.22 - 6 * dy, 0), grow (&b, 1, 0.57 + 6 * dx, 0.28 + 6 * dy, 0);
    assert_memory_equal (a.s->alive, b.s->alive, a.s->nbond);
    assert_true (pg_tip_behind (a.s->paths, 0, 10) > 0.6 && pg_tip_behind (a.s->paths, 0, 0.1) == 0.1);
    check_relative (pg_tip_behind (a.s->paths, 1, 10), hypot (0.24, 0.06) + 12 * hypot (dx, dy), 1e-12);
    end (&a), end (&b);
}

/* Several facets before any bond dies: each bond once. */
static void changes_gather (void **state)
{
    (void) state;
    growing a = begin (CRACKED (EDGE, "")), b = begin (CRACKED (EDGE, ""));
    for (int k = 1; k <= 5; k++) grow (&a, 0, 0.42 + 0.02 * k, 0.26, 0);
    for (int k = 1; k <= 5; k++)
        check_ok (pg_crack_grow (b.s, b.p, 0, (double[]) { 0.42 + 0.02 * k, 0.26 }, 0, &b.cut));
    bury (&b);
    assert_memory_equal (a.s->alive, b.s->alive, a.s->nbond);
    end (&a), end (&b);
}

/* A crack through a row of points, and through Gauss points: those on the line keep what is on their left. */
static void points_on_the_line_stay_on_its_left (void **state)
{
    (void) state;
    for (int turn = 0; turn < 2; turn++) {
#define NEAR_TIP "method: {tip_offset: 0.1 spacing}\n"
        growing g = begin (turn ? CRACKED ("{from: [0.3, 0.2], to: [-0.1, 0.2]}", NEAR_TIP)
                                : CRACKED ("{from: [-0.1, 0.2], to: [0.3, 0.2]}", NEAR_TIP));
        assert_int_equal (g.p->crack.eroded, 3); /* of the scene's crack, the tip's own point lives */
        for (int k = 0; k < 4; k++) grow (&g, 0, 0.4 + 0.1 * k, 0.2, 0);
        check_mask (&g, 1);
        const pg_family *f = &g.p->bonds.rows[PG_NODES].family;
        for (size_t i = 0; i < g.p->cloud.n; i++) {
            const double *x = g.p->cloud.x + 2*i;
            if (fabs (x[1] - 0.2) > 1e-9 || x[0] < 0.25 || x[0] > 0.65) continue;
            for (size_t e = f->start[i]; e < f->start[i + 1]; e++) {
                const double *to = g.p->cloud.x + 2 * (size_t) f->node[e];
                double y = to[1] - 0.2;
                if (fabs (y) > 1e-9) assert_int_equal (g.s->alive[e], turn ? y < 0 : y > 0);
                else if (to[0] > 0.25) assert_int_equal (g.s->alive[e], 1);    /* behind: eroded */
            }
        }
        end (&g);
    }
}

/* Through the whole plate: nothing holds the two parts together, also where the lattice sticks out of the
 * body; on the way the path meets the surface at the end. */
static void a_closed_path_severs_the_body (void **state)
{
    (void) state;
    growing g = begin (CRACKED (EDGE, ""));
    double y = 0.26;
    int what;
    check_relative (pg_tip_ahead (&g.ground, g.s->paths, 0, (double[]) { 1, 0 }, 10, &what), 0.58, 1e-12);
    assert_int_equal (what, PG_MEETS_SURFACE);
    for (int k = 1; k <= 5; k++) y += 0.01, grow (&g, 0, 0.42 + 0.1 * k, y, 0);
    grow (&g, 0, 1, y, 1);
    check_mask (&g, 1);
    size_t severed = 0;
    for (int set = 0; set < PG_BOND_SETS; set++)
        for (size_t q = 0; q < g.p->bonds.rows[set].n; q++)
            for (size_t e = g.p->bonds.rows[set].family.start[q];
                 e < g.p->bonds.rows[set].family.start[q + 1]; e++) {
                const double *a = g.p->bonds.rows[set].x + 2*q,
                             *b = g.p->cloud.x + 2 * (size_t) g.p->bonds.rows[set].family.node[e];
                int apart = (a[1] < 0.26 + 0.1 * fmax (0, a[0] - 0.42))
                            != (b[1] < 0.26 + 0.1 * fmax (0, b[0] - 0.42));
                if (apart) assert_false (g.s->alive[g.p->bonds.first[set] + e]);
                severed += (size_t) apart;
            }
    assert_true (severed > 200);
    assert_false (g.s->paths->tip[0].open);
    end (&g);
}

/* Points of whole cells lie outside the disk: what is beyond its surface is cut, too. */
static void points_beyond_the_surface_are_severed (void **state)
{
    (void) state;
    growing g = begin ("dimension: 2\nbody: [{add: {disk: {center: [0, 0], radius: 0.5}}}]\nspacing: 0.1\n"
                       "cells: staircase\nmaterials: {m: {youngs_modulus: 1, poissons_ratio: 0.2}}\n"
                       "cracks: [{from: [-0.6, 0.03], to: [0.1, 0.03]}]\n");
    size_t outside = 0;
    grow (&g, 0, 0.1 + pg_tip_ahead (&g.ground, g.s->paths, 0, (double[]) { 1, 0 }, 1, NULL), 0.03, 1);
    check_relative (g.s->paths->tip[0].x[0], sqrt (0.25 - 0.0009), 1e-12);
    check_mask (&g, 1);
    const pg_family *f = &g.p->bonds.rows[PG_NODES].family;
    for (size_t i = 0; i < g.p->cloud.n; i++)
        for (size_t e = f->start[i]; e < f->start[i + 1]; e++) {
            const double *a = g.p->cloud.x + 2*i, *b = g.p->cloud.x + 2 * (size_t) f->node[e];
            if ((a[1] < 0.03) == (b[1] < 0.03)) continue;
            assert_false (g.s->alive[e]);
            outside += fmin (a[0], b[0]) > 0.4995;
        }
    assert_true (outside > 1);
    end (&g);
}

static void tips_know_their_path (void **state)
{
    (void) state;
    growing g = begin (CRACKED (EDGE, ""));
    double from[2], e[2];
    pg_tip_chord (g.s->paths, 0, 0.1, from, e);
    check_absolute (from[0], 0.32, 1e-13), check_absolute (e[0], 1, 1e-13), check_absolute (e[1], 0, 1e-13);
    assert_true (isinf (pg_tip_straight (g.s->paths, 0, 0.2)));
    grow (&g, 0, 0.47, 0.26, 0), grow (&g, 0, 0.50, 0.30, 0);
    grow (&g, 0, 0.53, 0.34, 0), grow (&g, 0, 0.56, 0.38, 0);
    check_relative (pg_tip_straight (g.s->paths, 0, 0.2), 0.15, 1e-12);
    assert_true (isinf (pg_tip_straight (g.s->paths, 0, 1)));
    pg_tip_chord (g.s->paths, 0, 0.075, from, e);
    check_relative (from[0], 0.515, 1e-12), check_relative (from[1], 0.32, 1e-12);
    check_relative (e[0], 0.6, 1e-12), check_relative (e[1], 0.8, 1e-12);
    pg_tip_chord (g.s->paths, 0, 0.25, from, e);              /* round the corner */
    check_relative (from[0], 0.37, 1e-12), check_relative (from[1], 0.26, 1e-12);
    check_relative (e[1] / e[0], 0.12 / 0.19, 1e-12);
    pg_tip_chord (g.s->paths, 0, 99, from, e);                /* the path's other end */
    check_relative (from[0], -0.1, 1e-12);
    end (&g);
}

static void what_lies_around_a_tip (void **state)
{
    (void) state;
    growing g = begin (CRACKED (INSIDE ", {from: [0.63, 0.1], to: [0.63, 0.4]}", ""));
    double place[2];
    int what;
    assert_int_equal (g.s->paths->ntip, 4);
    check_relative (pg_tip_ahead (&g.ground, g.s->paths, 1, (double[]) { 1, 0 }, 1, &what), 0.06, 1e-12);
    assert_int_equal (what, PG_MEETS_CRACK);
    check_relative (pg_tip_ahead (&g.ground, g.s->paths, 1, (double[]) { 0, 1 }, 1, &what), 0.22, 1e-12);
    assert_int_equal (what, PG_MEETS_SURFACE);
    check_relative (pg_tip_ahead (&g.ground, g.s->paths, 1, (double[]) { 0, 1 }, 0.2, &what), 0.2, 0);
    assert_int_equal (what, PG_MEETS_NOTHING);
    check_relative (pg_tip_nearest (&g.ground, g.s->paths, 1, 1, place, &what), 0.06, 1e-12);
    assert_int_equal (what, PG_MEETS_CRACK);
    check_relative (place[0], 0.63, 1e-12), check_relative (place[1], 0.28, 1e-12);
    check_relative (pg_tip_nearest (&g.ground, g.s->paths, 2, 1, place, &what), 0.1, 1e-9);
    assert_int_equal (what, PG_MEETS_SURFACE);
    check_absolute (place[0], 0.63, 1e-5), check_absolute (place[1], 0, 1e-9);
    check_relative (pg_tip_nearest (&g.ground, g.s->paths, 0, 1, NULL, NULL), 0.22, 1e-9);
    check_relative (pg_tip_nearest (&g.ground, g.s->paths, 0, 0.05, NULL, NULL), 0.05, 0);
    end (&g);
    g = begin (CRACKED (INSIDE, ""));                  /* the path's own other tip */
    check_relative (pg_tip_nearest (&g.ground, g.s->paths, 1, 1, NULL, NULL), 0.22, 1e-9);
    grow (&g, 1, 0.36, 0.26, 0);                       /* folded back: not what a run does */
    check_relative (pg_tip_nearest (&g.ground, g.s->paths, 1, 1, NULL, NULL), 0.05, 1e-9);
    end (&g);
}

/* Body of a hole, and of points from nowhere but a mesh or a file: asked of pg_problem_has_body alone. */
static void surfaces_of_any_shape (void **state)
{
    (void) state;
    growing g = begin ("dimension: 2\nbody: [{add: {box: {low: [0, 0], high: [1, 1]}}}, {subtract: {disk: "
                       "{center: [0.7, 0.5], radius: 0.1}}}]\nspacing: 0.05\ncells: cut\nmaterials: {m: "
                       "{youngs_modulus: 1, poissons_ratio: 0.2}}\ncracks: [{from: [0.2, 0.45], "
                       "to: [0.5, 0.45]}]\n");
    double place[2];
    int what;
    check_relative (pg_tip_ahead (&g.ground, g.s->paths, 1, (double[]) { 1, 0 }, 1, &what),
                    0.2 - sqrt (0.0075), 1e-11);
    check_relative (pg_tip_nearest (&g.ground, g.s->paths, 1, 1, place, &what), hypot (0.2, 0.05) - 0.1,
                    1e-9);
    assert_int_equal (what, PG_MEETS_SURFACE);
    assert_true (pg_problem_has_body (g.p, (double[]) { 0.59, 0.5 }));
    assert_false (pg_problem_has_body (g.p, (double[]) { 0.61, 0.5 }));
    end (&g);
}

/* Two tips run into each other: both end. */
static void cracks_that_meet_end (void **state)
{
    (void) state;
    growing g = begin (CRACKED (EDGE ", {from: [0.6, 0.26], to: [0.8, 0.26]}", ""));
    assert_int_equal (g.s->paths->ntip, 3);
    grow (&g, 0, 0.5, 0.26, 0);
    grow (&g, 0, 0.6, 0.26, 1);
    assert_true (!g.s->paths->tip[0].open && !g.s->paths->tip[1].open && g.s->paths->tip[2].open);
    check_mask (&g, 1);
    const pg_crack whole = { .kind = PG_CRACK_SEGMENT, .vertex = (double[]) { -0.1, 0.26, 0.8, 0.26 },
                             .nvertex = 2, .normal = { 0, 1 },
                             .retreat = (double[]) { 0, g.s->paths->tip[2].offset } };
    const pg_family *f = &g.p->bonds.rows[PG_NODES].family;
    const double *x = g.p->cloud.x;
    for (size_t q = 0; q < g.p->cloud.n; q++)
        for (size_t e = f->start[q]; e < f->start[q + 1]; e++)
            assert_int_equal (g.s->alive[e],
                              !pg_crack_cuts (&whole, 2, x + 2*q, x + 2 * (size_t) f->node[e], 1e-10));
    end (&g);
}

static void cracks_begin_inside_and_at_the_surface (void **state)
{
    (void) state;
    growing g = begin (CRACKED (EDGE, ""));
    check_ok (pg_crack_start (g.s, g.p, (double[]) { 0.6, 0.5 }, (double[]) { 0.63, 0.4 }, 2, &g.cut));
    assert_true (bury (&g) > 10);
    check_mask (&g, 1);
    check_ok (pg_crack_start (g.s, g.p, (double[]) { 0.7, 0.1 }, (double[]) { 0.9, 0.15 }, 3, &g.cut));
    assert_true (bury (&g) > 10);
    check_mask (&g, 1);
    assert_int_equal (g.s->paths->ntip, 4);
    for (size_t t = 0; t < 4; t++) assert_int_equal (g.s->paths->tip[t].id, t + 1);
    assert_true (g.s->paths->tip[1].offset > 0 && g.s->paths->tip[1].offset < 0.3 * 0.1);
    check_relative (g.s->paths->length, hypot (0.03, 0.1) + hypot (0.2, 0.05), 1e-12);
    grow (&g, 1, 0.66, 0.3, 0), grow (&g, 2, 0.65, 0.08, 0), grow (&g, 3, 0.95, 0.2, 0);
    check_mask (&g, 1);
    assert_true (g.s->paths->tip[1].offset > 0.02);
    const double here[2] = { 0.7, 0.1 };
    check_fails (pg_crack_start (g.s, g.p, here, here, 3, &g.cut), PG_E_USAGE);
    end (&g);
}

static void copies_are_deep (void **state)
{
    (void) state;
    growing a = begin (CRACKED (EDGE, "")), b = begin (CRACKED (EDGE, ""));
    pg_state *s = NULL;
    check_ok (pg_state_create (&s, a.p, 2));
    for (int k = 1; k <= 40; k++) grow (&a, 0, 0.42 + 0.01 * k, 0.26, 0);
    check_ok (pg_state_copy (s, a.s));
    assert_memory_equal (s->alive, a.s->alive, s->nbond);
    assert_int_equal (s->paths->cracks.n, a.s->paths->cracks.n);
    assert_true (s->paths->cracks.crack[3].vertex != a.s->paths->cracks.crack[3].vertex);
    grow (&a, 0, 0.9, 0.3, 0);
    assert_true (s->paths->cracks.n + 1 == a.s->paths->cracks.n && s->paths->tip[0].x[0] < 0.83);
    pg_memory_fail_at (1);                             /* back again: needs no memory */
    pg_status status = pg_state_copy (a.s, s);
    pg_memory_fail_at (0);
    check_ok (status);
    check_mask (&a, 1);
    grow (&a, 0, 0.9, 0.2, 0);
    check_mask (&a, 1);
    pg_state_free (&s);
    end (&a), end (&b);
}

static void no_memory_changes_nothing (void **state)
{
    (void) state;
    growing g = begin (CRACKED (EDGE, ""));
    pg_status status = PG_E_MEMORY;
    for (size_t k = 1; status != PG_OK; k++) {
        g.cut.n = 0;
        pg_memory_fail_at (k);
        status = pg_crack_grow (g.s, g.p, 0, (double[]) { 0.5, 0.3 }, 0, &g.cut);
        pg_memory_fail_at (0);
        if (status == PG_OK) break;
        assert_int_equal (status, PG_E_MEMORY);
        assert_int_equal (g.s->paths->cracks.n, 1);
        check_absolute (g.s->paths->tip[0].x[0], 0.42, 0);
        assert_true (k < 100);
    }
    assert_int_equal (g.s->paths->cracks.n, 3);
    bury (&g);
    check_mask (&g, 1);
    end (&g);
}

/* No cracks grow in a bar or in space, and their states say so. */
static void other_dimensions_have_no_paths (void **state)
{
    (void) state;
    built b = build ("dimension: 1\nbody: [{add: {box: {low: [0], high: [1]}}}]\nspacing: 0.1\n"
                     "materials: {m: {youngs_modulus: 1, poissons_ratio: 0}}\n");
    pg_state *s = NULL;
    pg_changes cut = { 0 };
    check_ok (pg_state_create (&s, b.problem, 1));
    assert_null (s->paths);
    assert_ptr_equal (pg_state_cracks (b.problem, s), &b.problem->crack.given);
    const double from[2] = { 0, 0 }, to[2] = { 1, 0 };
    check_fails (pg_crack_start (s, b.problem, from, to, 0, &cut), PG_E_USAGE);
    check_fails (pg_crack_grow (s, b.problem, 0, (double[]) { 0, 0 }, 1, &cut), PG_E_USAGE);
    pg_state_free (&s), unbuild (&b);
}

/* ---- checkpoints --------------------------------------------------------------------------------------- */
typedef struct { char name[40]; size_t bytes; void *value; } part;
typedef struct { part part[16]; size_t n, at; } tape;

static pg_status pass (void *context, const char *name, size_t n, size_t size, void *value, int reading)
{
    tape *t = context;
    if (!reading) {
        part *p = &t->part[t->n++];
        snprintf (p->name, sizeof p->name, "%s", name);
        p->bytes = n * size, p->value = pg_calloc (n, size);
        memcpy (p->value, value, n * size);
        return PG_OK;
    }
    part *p = &t->part[t->at++];
    if (strcmp (p->name, name) != 0 || p->bytes != n * size)
        return pg_error (PG_E_FILE, PG_HERE, "another piece");
    memcpy (value, p->value, n * size);
    return PG_OK;
}
static pg_status write_numbers (void *c, const char *name, size_t n, double *v)
{
    return pass (c, name, n, 8, v, 0);
}
static pg_status write_counts (void *c, const char *name, size_t n, long *v)
{
    return pass (c, name, n, 8, v, 0);
}
static pg_status read_numbers (void *c, const char *name, size_t n, double *v)
{
    return pass (c, name, n, 8, v, 1);
}
static pg_status read_counts (void *c, const char *name, size_t n, long *v)
{
    return pass (c, name, n, 8, v, 1);
}

/* Bit by bit, also what the places of its ends do not give again. */
static void same_piece (const pg_crack *a, const pg_crack *b)
{
    assert_memory_equal (a->normal, b->normal, sizeof a->normal);
    assert_true (a->sided == b->sided && a->width == b->width && a->slot == b->slot);
    assert_true (a->kind == b->kind && a->entry == b->entry && a->bend == b->bend);
}

static void checkpoints_keep_the_paths (void **state)
{
    (void) state;
    const char *scene = CRACKED (LOW ", " INSIDE ", {from: [0.72, 0.2], to: [0.81, 0.31]}", "");
    growing a = begin (scene), b = begin (scene);
    tape t = { 0 };
    for (int k = 1; k <= 20; k++) grow (&a, 0, 0.42 + 0.005 * k, 0.06 + 0.003 * k, 0);
    grow (&a, 2, 0.7, 0.4, 0), grow (&a, 4, 0.82, 0.34, 0);
    const pg_keeper writer = { &t, 0, write_numbers, write_counts, NULL };
    check_ok (pg_crack_paths_keep (a.s->paths, a.p, "x", &writer));
    const pg_keeper reader = { &t, 1, read_numbers, read_counts, NULL };
    check_ok (pg_crack_paths_keep (b.s->paths, b.p, "x", &reader));
    for (size_t i = 0; i < a.s->paths->cracks.n; i++)
        same_piece (&a.s->paths->cracks.crack[i], &b.s->paths->cracks.crack[i]);
    memcpy (b.s->alive, a.s->alive, a.s->nbond);
    check_mask (&b, 1);
    grow (&a, 0, 0.6, 0, 1), grow (&b, 0, 0.6, 0, 1);
    assert_memory_equal (a.s->alive, b.s->alive, a.s->nbond);
    assert_memory_equal (a.s->paths->tip, b.s->paths->tip, a.s->paths->ntip * sizeof (pg_tip));
    assert_memory_equal (a.s->paths->store, b.s->paths->store, 6 * a.s->paths->cracks.n * sizeof (double));
    /* every whole number out of its bounds is refused, whatever it is */
    size_t refused = 0;
    for (size_t i = 0; i < t.n; i++)
        for (size_t k = 0; k < t.part[i].bytes / 8; k++) {
            static const long nasty[] = { -2, 99, 1L << 40, 0x7fffffffffffffff, -0x7fffffffffffffff };
            long *v = (long *) t.part[i].value + k, right = *v;
            for (size_t q = 0; q < 5; q++) {
                *v = nasty[q], t.at = 0;
                pg_status status = pg_crack_paths_keep (b.s->paths, b.p, "x", &reader);
                assert_true (status == PG_OK || status == PG_E_FILE);
                refused += status == PG_E_FILE;
                if (status == PG_OK) pg_state_cracks (b.p, b.s), pg_tip_behind (b.s->paths, 0, 1);
            }
            *v = right;
        }
    assert_true (refused > 200);
    for (size_t i = 0; i < t.n; i++) pg_free (t.part[i].value);
    end (&a), end (&b);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (what_dies_is_what_the_path_cuts), cmocka_unit_test (strokes_do_not_matter),
        cmocka_unit_test (changes_gather), cmocka_unit_test (points_on_the_line_stay_on_its_left),
        cmocka_unit_test (a_closed_path_severs_the_body),
        cmocka_unit_test (points_beyond_the_surface_are_severed), cmocka_unit_test (tips_know_their_path),
        cmocka_unit_test (what_lies_around_a_tip), cmocka_unit_test (surfaces_of_any_shape),
        cmocka_unit_test (cracks_that_meet_end), cmocka_unit_test (cracks_begin_inside_and_at_the_surface),
        cmocka_unit_test (copies_are_deep), cmocka_unit_test (no_memory_changes_nothing),
        cmocka_unit_test (other_dimensions_have_no_paths), cmocka_unit_test (checkpoints_keep_the_paths),
    };
    return cmocka_run_group_tests_name ("mechanics/model/crack_paths", tests, NULL, NULL);
}

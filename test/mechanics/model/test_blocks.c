/* SPDX-License-Identifier: GPL-3.0-or-later
 * Which material every point is made of: conditions at the point itself, numbers of a file, and the faults of
 * a list of blocks. */
#include "scenes.h"
#include <unistd.h>
#include <stdlib.h>

/* 10 x 5 cells; x = 0.5 is an edge of cells with a column of nodes */
#define BODY "dimension: 2\nbody: [{add: {box: {low: [0, 0], high: [1, 0.5]}}}]\nspacing: 0.1\n"
#define ROCK "rock: {youngs_modulus: 10, poissons_ratio: 0.2}"
#define CLAY "clay: {youngs_modulus: 1, poissons_ratio: 0.3}"
#define IRON "iron: {youngs_modulus: 200, poissons_ratio: 0.3}"
#define TWO BODY "materials: {" ROCK ", " CLAY "}\n"
#define PULL "boundary: [{set: left, displacement: {x: 0}}, {set: top, traction: {y: 1}}]\n"
enum { ROCK_, CLAY_ };

static int made_of (const pg_problem *p, int set, size_t point) { return p->block[set][point]; }

static void one_material_needs_no_blocks (void **state)
{
    (void) state;
    built b = build (PLATE PULL);
    for (int s = 0; s < PG_BOND_SETS; s++) {
        assert_true (b.problem->bonds.rows[s].n > 0);
        for (size_t q = 0; q < b.problem->bonds.rows[s].n; q++)
            assert_int_equal (made_of (b.problem, s, q), 0);
    }
    unbuild (&b);
}

static void a_condition_holds_at_the_point_itself (void **state)
{
    (void) state;
    built b = build (TWO PULL
                     "blocks: [{material: clay, where: x < 0.5}, {material: rock, where: x >= 0.5}]\n");
    const pg_problem *p = b.problem;
    for (int s = 0; s < PG_BOND_SETS; s++)
        for (size_t q = 0; q < p->bonds.rows[s].n; q++)
            assert_int_equal (made_of (p, s, q), p->bonds.rows[s].x[2 * q] < 0.5 ? CLAY_ : ROCK_);
    unbuild (&b);
}

/* Gauss points at 0.5 - 0.021 see the nodes at x = 0.5 as the nearest: their material is that of their cell
 * all the same. */
static void points_next_to_an_interface_do_not_follow_its_nodes (void **state)
{
    (void) state;
    built b = build (TWO "blocks: [{material: clay, where: x < 0.5}, {material: rock, where: x >= 0.5}]\n");
    const pg_problem *p = b.problem;
    size_t beside = 0;
    for (size_t q = 0; q < p->bonds.rows[PG_POINTS].n; q++) {
        double x = p->bonds.rows[PG_POINTS].x[2*q];
        if (x < 0.45 || x > 0.5) continue;
        assert_int_equal (made_of (p, PG_POINTS, q), CLAY_);
        beside += 0.5 - x < 0.03;
    }
    assert_int_equal (beside, 10);
    unbuild (&b);
}

static void a_later_entry_wins (void **state)
{
    (void) state;
    built b = build (TWO "blocks: [{material: rock, where: x > -1}, {material: clay, where: y > 0.25}, "
                         "{material: rock, where: y > 0.35}]\n");
    const pg_problem *p = b.problem;
    for (size_t i = 0; i < p->cloud.n; i++) {
        double y = p->cloud.x[2*i + 1];
        assert_int_equal (made_of (p, PG_NODES, i), y > 0.25 && y < 0.35 ? CLAY_ : ROCK_);
    }
    unbuild (&b);
}

/* The facet's own coordinate may lie a rounding outside the condition that its cell meets. */
static void a_boundary_point_is_made_of_what_lies_behind_it (void **state)
{
    (void) state;
    built b = build (
        BODY "lattice: cells\nmaterials: {" ROCK ", " CLAY "}\n" PULL
             "blocks: [{material: rock, where: y < 0.2}, {material: clay, where: y > 0.2 and y < 0.5}]\n");
    const pg_problem *p = b.problem;
    size_t top = 0;
    for (size_t q = 0; q < p->bonds.rows[PG_FACETS].n; q++) {
        double y = p->bonds.rows[PG_FACETS].x[2*q + 1];
        assert_int_equal (made_of (p, PG_FACETS, q), y > 0.2 ? CLAY_ : ROCK_);
        top += y > 0.499;
    }
    assert_true (top > 0);
    unbuild (&b);
}

static void pieces_of_solids_and_bars (void **state)
{
    (void) state;
    built b = build ("dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [1, 1, 1]}}}]\nspacing: "
                     "0.5\nlattice: cells\n"
                     "materials: {" ROCK ", " CLAY
                     "}\nblocks: [{material: rock, where: z < 0.5}, {material: clay, where: z > 0.5}]\n");
    for (size_t i = 0; i < b.problem->cloud.n; i++)
        assert_int_equal (made_of (b.problem, PG_NODES, i),
                          b.problem->cloud.x[3 * i + 2] > 0.5 ? CLAY_ : ROCK_);
    unbuild (&b);
    b = build ("dimension: 1\nbody: [{add: {box: {low: [0], high: [1]}}}]\nspacing: 0.25\n"
               "materials: {" ROCK ", " CLAY
               "}\nblocks: [{material: rock, where: x < 0.4}, {material: clay, where: x > 0.4}]\n");
    for (size_t i = 0; i < b.problem->cloud.n; i++)
        assert_int_equal (made_of (b.problem, PG_NODES, i), b.problem->cloud.x[i] > 0.4 ? CLAY_ : ROCK_);
    unbuild (&b);
}

/* 4 x 4 points; the upper half has the number `high`, the others `low` */
static void write_file (char *path, int low, int high)
{
    int file = mkstemp (path);
    assert_true (file >= 0);
    FILE *f = fdopen (file, "w");
    for (int i = 0; i < 16; i++)
        fprintf (f, "%g %g 0.01 %d\n", 0.1 * (i % 4), 0.1 * (i / 4), i / 4 > 1 ? high : low);
    fclose (f);
}

#define FILE_SCENE \
    "dimension: 2\npoints: %s\nmaterials: {" ROCK ", " CLAY \
    "}\nmethod: {integration: nodal, horizon: 0.25}\n%s"

static void numbers_of_a_file_are_given_materials (void **state)
{
    (void) state;
    char path[] = "/tmp/perigal_blocks_XXXXXX", text[600];
    write_file (path, 7, 3);
    snprintf (text, sizeof text, FILE_SCENE, path,
              "blocks: [{material: clay, block: 3}, {material: rock, block: 7}]\n");
    built b = build (text);
    for (size_t i = 0; i < 16; i++)
        assert_int_equal (made_of (b.problem, PG_NODES, i), i / 4 > 1 ? CLAY_ : ROCK_);
    unbuild (&b);
    snprintf (text, sizeof text, FILE_SCENE, path,
              "blocks: [{material: clay, block: 3}, {material: rock, block: 8}]\n");
    check_refused (text, "blocks[1].block = 8: claims no point");
    check_refused (text, "blocks: no entry claims 8 of 16 nodes, the first at [0, 0] m");
    unlink (path);
}

static void without_blocks_a_file_counts_the_materials (void **state)
{
    (void) state;
    char path[] = "/tmp/perigal_blocks_XXXXXX", text[600];
    write_file (path, 0, 1);
    snprintf (text, sizeof text, FILE_SCENE, path, "");
    built b = build (text);
    for (size_t i = 0; i < 16; i++)
        assert_int_equal (made_of (b.problem, PG_NODES, i), i / 4 > 1 ? CLAY_ : ROCK_);
    unbuild (&b);
    unlink (path);
    strcpy (path, "/tmp/perigal_blocks_XXXXXX");
    write_file (path, 0, 2);
    snprintf (text, sizeof text, FILE_SCENE, path, "");
    check_refused (text, "point 8 is of block 2, and there are 2 materials");
    unlink (path);
    strcpy (path, "/tmp/perigal_blocks_XXXXXX");
    write_file (path, 0, 0);
    snprintf (text, sizeof text, FILE_SCENE, path, "");
    check_refused (text, "materials.clay: is used by no block");
    unlink (path);
}

static void several_materials_want_blocks (void **state)
{
    (void) state;
    check_refused (TWO, "materials: there are 2: say with blocks which part of the body is made of which");
}

static void gaps_are_refused (void **state)
{
    (void) state;
    check_refused (TWO "blocks: [{material: clay, where: x < 0.45}, {material: rock, where: x > 0.55}]\n",
                   "blocks: no entry claims 6 of 66 nodes, the first at [0.5, 0] m");
    check_refused (
        TWO "blocks: [{material: clay, where: x < 0.41}, {material: rock, where: x > 0.49}]\n",
        "blocks: no entry claims 20 of 200 evaluation points, the first at [0.421132, 0.0211325] m");
}

static void entries_that_claim_nothing_are_refused (void **state)
{
    (void) state;
    check_refused (TWO "blocks: [{material: clay, where: x < 0.5}, {material: rock, where: x >= 0.5}, "
                       "{material: rock, where: y > 0.51}]\n",
                   "blocks[2].where = y > 0.51: claims no point");
    check_refused (BODY "materials: {" ROCK
                        "}\nblocks: [{material: rock, where: x >= 0}, {material: rock, where: x > 2}]\n",
                   "blocks[1].where");
}

static void materials_that_nothing_is_made_of_are_refused (void **state)
{
    (void) state;
    check_refused (BODY "materials: {" ROCK ", " CLAY ", " IRON
                        "}\nblocks: [{material: clay, where: x < 0.5}, {material: rock, where: x >= 0.5}]\n",
                   "materials.iron: is used by no block");
    check_refused (TWO "blocks: [{material: clay, where: x < 0.5}, {material: rock, where: x >= 0}]\n",
                   "materials.clay: is used by no block");
}

static void wrong_entries_are_named (void **state)
{
    (void) state;
    check_refused (TWO "blocks: [{material: rok, where: x < 0.5}]\n",
                   "blocks[0].material = rok: there is no material of this name (did you mean rock?)");
    check_refused (TWO "blocks: [{material: rock}]\n", "give exactly one of where, block");
    check_refused (TWO "blocks: [{material: rock, where: x < 1, block: 1}]\n",
                   "give exactly one of where, block");
    check_refused (TWO "blocks: [{where: x < 1}]\n", "blocks[0].material: is missing");
    check_refused (TWO "blocks: [{material: rock, where: x}]\n", "blocks[0].where");
    check_refused (TWO "blocks: [{material: rock, where: x < t * 1 m}]\n", "a block does not change with t");
    check_refused (TWO "blocks: [{material: rock, block: 0}]\n",
                   "only points and meshes from a file have blocks: use where");
}

static void what_never_breaks_is_exempt (void **state)
{
    (void) state;
    built b = build (BODY "materials: {" ROCK
                          ", clay: {youngs_modulus: 1, poissons_ratio: 0.3, failure: {never: on}}}\n" PULL
                          "failure: {criterion: stretch, critical_stretch: 0.1, exclude: [right]}\n"
                          "blocks: [{material: clay, where: x < 0.5}, {material: rock, where: x >= 0.5}]\n");
    const pg_problem *p = b.problem;
    assert_true (!p->criterion[ROCK_].never && p->criterion[CLAY_].never);
    for (int s = 0; s < PG_BOND_SETS; s++)
        for (size_t q = 0; q < p->bonds.rows[s].n; q++) {
            double x = p->bonds.rows[s].x[2*q];
            assert_int_equal (p->bonds.exempt[s][q], x < 0.5 || x > (s == PG_NODES ? 0.99 : 0.95));
        }
    unbuild (&b);
}

static void each_failed_allocation_is_reported (void **state)
{
    (void) state;
    each_allocation_may_fail (
        TWO PULL "blocks: [{material: clay, where: x < 0.5}, {material: rock, where: x >= 0.5}]\n"
                 "failure: {criterion: stretch, critical_stretch: 0.1}\n");
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (one_material_needs_no_blocks),
        cmocka_unit_test (a_condition_holds_at_the_point_itself),
        cmocka_unit_test (points_next_to_an_interface_do_not_follow_its_nodes),
        cmocka_unit_test (a_later_entry_wins),
        cmocka_unit_test (a_boundary_point_is_made_of_what_lies_behind_it),
        cmocka_unit_test (pieces_of_solids_and_bars),
        cmocka_unit_test (numbers_of_a_file_are_given_materials),
        cmocka_unit_test (without_blocks_a_file_counts_the_materials),
        cmocka_unit_test (several_materials_want_blocks),
        cmocka_unit_test (gaps_are_refused),
        cmocka_unit_test (entries_that_claim_nothing_are_refused),
        cmocka_unit_test (materials_that_nothing_is_made_of_are_refused),
        cmocka_unit_test (wrong_entries_are_named),
        cmocka_unit_test (what_never_breaks_is_exempt),
        cmocka_unit_test (each_failed_allocation_is_reported),
    };
    return cmocka_run_group_tests_name ("mechanics/model/blocks", tests, NULL, NULL);
}

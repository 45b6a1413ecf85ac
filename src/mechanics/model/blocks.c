/* SPDX-License-Identifier: GPL-3.0-or-later
 * Material of every point: that of the last entry of `blocks` that applies to it. A condition is evaluated at
 * the point itself, so that an interface along edges of cells is exact; a block number of the points' file
 * goes with the nearest node, a block of a mesh with the element itself (a node between blocks belongs to the
 * first of them). */
#include "model.h"
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
    pg_expression *where;                              /* condition; NULL: selects by block number */
    int    number, material;
    size_t claimed;  /* points to which it applies, overridden ones included */
} entry;
typedef struct { size_t n; entry *entry; } entries;

static const char *const kind_of_points[PG_BOND_SETS] = { "nodes", "evaluation points", "boundary points" };

/* Frees the entries. */
static void clear (entries *e)
{
    for (size_t k = 0; e->entry && k < e->n; k++) pg_expression_free (&e->entry[k].where);
    pg_free (e->entry);
    *e = (entries) { 0 };
}

/* ---- the list ------------------------------------------------------------------------------------------ */
/* Block number given by the key `block`: a name or number in a mesh, a number in a file of points; -1: error
 * reported. */
static int block_named (const pg_problem *p, const pg_scene *scene, const char *path)
{
    const char *text = pg_scene_text (scene, "%s", path);
    char *end, names[2000];
    if (p->part.mesh.n) {
        int k = pg_mesh_body_block (&p->part.mesh, text);
        pg_mesh_body_blocks (&p->part.mesh, names, sizeof names);
        if (k < 0)
            pg_scene_fault (scene, path, "the mesh has no block of this name or number; there are %s", names);
        return k;
    }
    long number = strtol (text, &end, 10);
    if (p->lattice.dim)
        pg_scene_fault (scene, path, "only points and meshes from a file have blocks: use where");
    else if (end == text || *end || number < 0 || number > INT_MAX)
        pg_scene_fault (scene, path, "must be a whole number from 0: points have no names of blocks");
    else return (int) number;
    return -1;
}

/* Reads entry k of `blocks`: a condition, or a block number of the points' file or mesh, and its material. */
static pg_status read_entry (entry *e, const pg_problem *p, const pg_scene *scene, size_t k)
{
    pg_status status = PG_OK;
    char path[64];
    const char *material = pg_scene_text (scene, "blocks[%zu].material", k);
    for (size_t m = 0; m < p->nmaterial; m++)
        if (strcmp (p->material[m].name, material) == 0) e->material = (int) m;
    if (!pg_scene_given (scene, "blocks[%zu].where", k)) {
        snprintf (path, sizeof path, "blocks[%zu].block", k);
        e->number = block_named (p, scene, path);
        return PG_OK;
    }
    snprintf (path, sizeof path, "blocks[%zu].where", k);
    PG_TRY (pg_expression_compile (&e->where, pg_scene_text (scene, "%s", path), "bool"));
    if (pg_expression_uses (e->where, 't')) pg_scene_fault (scene, path, "a block does not change with t");
done:
    return status;
}

/* Reads all entries in the order of the scene; later ones override earlier ones. */
static pg_status read_entries (entries *out, const pg_problem *p, const pg_scene *scene)
{
    pg_status status = PG_OK;
    out->n = pg_scene_count (scene, "blocks");
    PG_ALLOC (out->entry, out->n);
    for (size_t k = 0; k < out->n; k++) PG_TRY (read_entry (&out->entry[k], p, scene, k));
    PG_TRY (pg_scene_verdict (scene));
done:
    return status;
}

/* Checks `blocks` before bonds are built, so that its errors are reported together with those of other
 * sections. */
pg_status pg_blocks_check (const pg_problem *p, const pg_scene *scene)
{
    entries e = { 0 };
    pg_status status = pg_scene_given (scene, "blocks") ? read_entries (&e, p, scene) : PG_OK;
    clear (&e);
    return status == PG_E_SCENE ? PG_OK : status;
}

/* ---- claims -------------------------------------------------------------------------------------------- */
/* Position at which conditions and expressions are evaluated for a point: boundary points are moved slightly
 * inside their cell (or, on a cut facet, inside the surface), so that rounding cannot place them outside the
 * body. */
void pg_blocks_place (const pg_problem *p, int set, size_t point, double *x)
{
    const pg_cells *c = &p->cells;
    size_t dim = (size_t) p->dim;
    memcpy (x, p->bonds.rows[set].x + point * dim, dim * sizeof *x);
    if (set != PG_FACETS) return;
    size_t cell = (size_t) c->facet_cell[p->bonds.rows[set].cell[point]], first = c->start[cell],
           corners = c->start[cell + 1] - first;
    if (c->facet_kind[p->bonds.rows[set].cell[point]] == PG_CUT) {
        for (size_t k = 0; k < dim; k++)
            x[k] -= pg_cloud_same (&p->cloud) * p->bonds.facet_normal[point * dim + k];
        return;
    }
    const double *corner = c->x + first * dim;
    for (size_t k = 0; k < dim; k++) {
        double middle = 0;
        for (size_t i = 0; i < corners; i++) middle += corner[i * dim + k] / (double) corners;
        x[k] += 1e-9 * (middle - x[k]);
    }
}

/* Block number of a point: its own, that of its element, or that of the nearest node; -1: it has no
 * neighbours. */
static int number_of (const pg_problem *p, int set, size_t point)
{
    int cell = p->part.mesh.n && set != PG_NODES ? p->bonds.rows[set].cell[point] : -1;
    if (cell >= 0) return p->cells.block[set == PG_FACETS ? p->cells.facet_cell[cell] : cell];
    int node = set == PG_NODES ? (int) point : pg_bonds_nearest (p, set, point);
    return node < 0 ? -1 : p->cloud.block[node];
}

/* Material of one point, -1: no entry applies to it. */
static int claim (entries *e, const pg_problem *p, int set, size_t point)
{
    double x[3] = { 0 };
    int found = -1;
    pg_blocks_place (p, set, point, x);
    pg_place at = pg_place_of (p->dim, x, 0);
    for (size_t k = 0; k < e->n; k++) {
        entry *one = &e->entry[k];
        int holds = one->where ? pg_expression_value (one->where, &at) != 0
                               : number_of (p, set, point) == one->number;
        if (holds) found = one->material, one->claimed++;
    }
    return found;
}

/* Reports the error that no entry of blocks applies to `count` points of a set, the first of which is
 * `point`. */
static void fault_of_place (const pg_problem *p, const pg_scene *scene, int set, size_t point, size_t count)
{
    char place[96];
    size_t dim = (size_t) p->dim, at = 0;
    for (size_t k = 0; k < dim; k++)
        at += (size_t) snprintf (place + at, sizeof place - at, "%s%.6g", k ? ", " : "",
                                 p->bonds.rows[set].x[point * dim + k]);
    pg_scene_fault (scene, "blocks", "no entry claims %zu of %zu %s, the first at [%s] m", count,
                    p->bonds.rows[set].n, kind_of_points[set], place);
}

/* Sets the materials of all points: the last applicable entry decides. Entries that apply to no point, on any
 * rank, are errors. */
static pg_status claim_all (entries *e, pg_problem *p, const pg_scene *scene)
{
    pg_status status = PG_OK;
    size_t first = 0;
    for (int s = 0; s < PG_BOND_SETS; s++) {
        size_t nobody = 0;
        for (size_t q = 0; q < p->bonds.rows[s].n; q++) {
            int material = claim (e, p, s, q);
            if (material < 0 && nobody++ == 0) first = q;
            p->block[s][q] = material < 0 ? 0 : material;
        }
        if (nobody) fault_of_place (p, scene, s, first, nobody);
    }
    for (size_t k = 0; k < e->n; k++) {
        char path[64];
        double claimed = (double) e->entry[k].claimed;
        PG_TRY (pg_ranks_most (1, &claimed));
        snprintf (path, sizeof path, "blocks[%zu].%s", k, e->entry[k].where ? "where" : "block");
        if (!(claimed > 0)) pg_scene_fault (scene, path, "claims no point");
    }
done:
    return status;
}

/* Without `blocks`: the blocks of a mesh bear the names of their materials. */
static void by_name (pg_problem *p, const pg_scene *scene)
{
    const pg_mesh *m = &p->part.mesh;
    int missing = 0;
    for (int s = 0; s < PG_BOND_SETS && !missing; s++)
        for (size_t q = 0; q < p->bonds.rows[s].n && !missing; q++) {
            int block = number_of (p, s, q), material = -1;
            for (size_t k = 0; block >= 0 && k < p->nmaterial; k++)
                if (!strcmp (p->material[k].name, m->blocks[block].name)) material = (int) k;
            p->block[s][q] = material < 0 ? 0 : material;
            missing = material < 0;
            if (missing)
                pg_scene_fault (
                    scene, "materials",
                    "there are %zu, and none has the name of the block '%s' of the mesh: say with blocks "
                    "which block is made of which",
                    p->nmaterial, block < 0 ? "" : m->blocks[block].name);
        }
}

/* Without `blocks`: the block column of the points' file is the index of the material; other points take that
 * of their nearest node. */
static void by_number (pg_problem *p, const pg_scene *scene)
{
    if (p->part.mesh.n) {
        by_name (p, scene);
        return;
    }
    for (size_t i = 0; i < p->cloud.n; i++)
        if (p->cloud.block[i] < 0 || (size_t) p->cloud.block[i] >= p->nmaterial) {
            pg_scene_fault (scene, "materials", "point %zu is of block %d, and there are %zu materials", i,
                            p->cloud.block[i], p->nmaterial);
            return;
        }
    for (int s = 0; s < PG_BOND_SETS; s++)
        for (size_t q = 0; q < p->bonds.rows[s].n; q++) {
            int number = number_of (p, s, q);
            p->block[s][q] = number < 0 ? 0 : number;
        }
}

/* Reports materials that no point has as errors. */
static pg_status check_used (const pg_problem *p, const pg_scene *scene)
{
    pg_status status = PG_OK;
    for (size_t m = 0; m < p->nmaterial; m++) {
        char path[96];
        double used = 0;
        for (int s = 0; s < PG_BOND_SETS; s++)
            for (size_t q = 0; q < p->bonds.rows[s].n && !(used > 0); q++) used += p->block[s][q] == (int) m;
        PG_TRY (pg_ranks_most (1, &used));
        snprintf (path, sizeof path, "materials.%.63s", p->material[m].name);
        if (!(used > 0)) pg_scene_fault (scene, path, "is used by no block");
    }
done:
    return status;
}

/* Sets the materials of nodes, evaluation points and boundary points. With several materials `blocks` is
 * needed, or blocks of the mesh or file of points. */
pg_status pg_blocks_build (pg_problem *p, const pg_scene *scene)
{
    pg_status status = PG_OK;
    entries e = { 0 };
    for (int s = 0; s < PG_BOND_SETS; s++) PG_ALLOC (p->block[s], p->bonds.rows[s].n);
    if (pg_scene_given (scene, "blocks")) {
        PG_TRY (read_entries (&e, p, scene));
        PG_TRY (claim_all (&e, p, scene));
    } else if (p->nmaterial == 1) goto done;
    else if (p->lattice.dim)
        pg_scene_fault (scene, "materials",
                        "there are %zu: say with blocks which part of the body is made of which",
                        p->nmaterial);
    else by_number (p, scene);
    PG_TRY (pg_ranks_agree (pg_scene_verdict (scene)));
    PG_TRY (check_used (p, scene));
    PG_TRY (pg_scene_verdict (scene));
done:
    clear (&e);
    return status;
}

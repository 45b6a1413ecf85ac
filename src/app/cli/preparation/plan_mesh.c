/* SPDX-License-Identifier: GPL-3.0-or-later
 * Description of a body from a mesh: file, elements, blocks, sets, sizes and quality of elements. */
#include "cli.h"
#include <string.h>
#include <strings.h>

/* Number of blocks, and of sets, that are listed by name. */
enum { MOST = 12 };

/* Number of elements of a kind. */
static size_t of_kind (const pg_mesh *m, int kind)
{
    size_t n = 0;
    for (size_t e = 0; e < m->n; e++) n += m->kind[e] == kind;
    return n;
}

/* Number of elements in a block. */
static size_t of_block (const pg_mesh *m, size_t block)
{
    size_t n = 0;
    for (size_t e = 0; e < m->n; e++) n += (size_t) m->block[e] == block;
    return n;
}

/* Prints file, length unit, number of nodes and of elements of each kind, and the blocks, the first twelve by
 * name. */
static void print_elements (const pg_mesh_body *b)
{
    const pg_mesh *m = &b->mesh;
    const char *joint = ", ";
    printf ("  %-18s  %s, %.6g m a unit, %zu nodes", "mesh", b->file, b->unit, m->nnode);
    for (int k = 0; k < PG_ELEMENTS; k++) {
        size_t n = of_kind (m, k);
        if (n) printf ("%s%zu %s", joint, n, pg_element_types[k].name);
    }
    printf ("\n");
    for (size_t k = 0; k < m->nblock && k < MOST; k++)
        printf ("  block %-12s  %zu elements\n", m->blocks[k].name, of_block (m, k));
    if (m->nblock > MOST) printf ("  %-18s  and %zu more\n", "blocks", m->nblock - MOST);
}

/* Prints names of sets that had to change, since keys of a scene allow fewer characters; users must write the
 * changed name. A set of nodes that a set of sides has named already is left out. */
static void print_renamed (const pg_mesh *m)
{
    char clean[57];
    for (size_t i = 0; i < m->nsides + m->nnodes; i++) {
        const char *name = i < m->nsides ? m->sides[i].name : m->nodes[i - m->nsides].name;
        int twice = 0;
        pg_set_name (clean, name);
        for (size_t k = 0; i >= m->nsides && k < m->nsides; k++) twice |= !strcmp (m->sides[k].name, name);
        if (strcmp (clean, name) && !twice)
            printf ("  %-18s  '%s' of the mesh is called %s here\n", "set", name, clean);
    }
}

/* Prints which parts of the files of a mesh and of points are not used, and sets whose name differs from that
 * of a side of the body (left ...) by upper case letters only. */
void plan_passed (const pg_problem *p)
{
    const pg_mesh *m = &p->part.mesh;
    static const char *const sides[] = { "left", "right", "bottom", "top", "back", "front", "all" };
    if (*p->cloud.passed)
        printf ("  passed over         column%s %s\n", strchr (p->cloud.passed, ',') ? "s" : "",
                p->cloud.passed);
    for (size_t k = 0; k < m->npassed; k++) {
        printf ("  passed over         %s", m->passed[k].what);
        if (m->passed[k].n > 1) printf (", %zu times", m->passed[k].n);
        printf ("\n");
    }
    for (size_t k = 0; k < p->cells.ngiven; k++)
        for (size_t s = 0; s < sizeof sides / sizeof *sides; s++)
            if (strcasecmp (p->cells.given[k].name, sides[s]) == 0
                && strcmp (p->cells.given[k].name, sides[s]) != 0)
                printf ("  set %-14s  of the mesh is not `%s`, which is a side of the body: the case of "
                        "letters counts\n", p->cells.given[k].name, sides[s]);
}

/* Prints the mesh; for a body without one only the unused columns of a points file. Volume and surface show a
 * wrong length unit; the worst quality (scaled Jacobian, 1 is perfect) shows a bad element with its
 * number. */
void plan_mesh (const pg_problem *p)
{
    const pg_mesh_body *b = &p->part;
    const pg_cells *c = &p->cells;
    double volume = 0, area = 0;
    if (b->mesh.n == 0) {
        plan_passed (p);
        return;
    }
    print_elements (b);
    for (size_t k = 0; k < c->ngiven && k < MOST; k++)
        printf ("  set %-14s  %zu points, %zu facets\n", c->given[k].name, c->given[k].npoint,
                c->given[k].nfacet);
    if (c->ngiven > MOST) printf ("  %-18s  and %zu more\n", "sets", c->ngiven - MOST);
    print_renamed (&b->mesh);
    plan_passed (p);
    for (size_t e = 0; e < c->n; e++) volume += c->volume[e];
    for (size_t f = 0; f < c->nfacet; f++) area += c->area[f];
    printf ("  %-18s  %.8g m3, surface %.8g m2\n", "volume", volume, area);
    printf ("  %-18s  %.4g to %.4g m, worst quality %.3g (scaled Jacobian, element %ld)\n", "elements",
            b->smallest, b->largest, b->quality, b->mesh.element_id[b->worst]);
}

/* Counts, sets, volume, surface, sizes and quality of the mesh of a plan as JSON, under fixed keys. */
void plan_mesh_json (pg_json *j, const pg_problem *p)
{
    const pg_mesh_body *b = &p->part;
    const pg_mesh *m = &b->mesh;
    double volume = 0, area = 0;
    if (m->n == 0) return;
    for (size_t e = 0; e < p->cells.n; e++) volume += p->cells.volume[e];
    for (size_t f = 0; f < p->cells.nfacet; f++) area += p->cells.area[f];
    pg_json_open (j, "mesh", '{');
    pg_json_text (j, "file", b->file);
    pg_json_number (j, "unit", b->unit);
    pg_json_count (j, "nodes", m->nnode);
    pg_json_open (j, "elements", '{');
    for (int k = 0; k < PG_ELEMENTS; k++)
        if (of_kind (m, k)) pg_json_count (j, pg_element_types[k].name, of_kind (m, k));
    pg_json_shut (j);
    pg_json_open (j, "blocks", '{');
    for (size_t k = 0; k < m->nblock; k++) pg_json_count (j, m->blocks[k].name, of_block (m, k));
    pg_json_shut (j);
    pg_json_open (j, "sets", '{');
    for (size_t k = 0; k < p->cells.ngiven; k++)
        pg_json_count (j, p->cells.given[k].name, p->cells.given[k].npoint);
    pg_json_shut (j);
    pg_json_open (j, "passed_over", '{');
    for (size_t k = 0; k < m->npassed; k++) pg_json_count (j, m->passed[k].what, m->passed[k].n);
    pg_json_shut (j);
    pg_json_number (j, "volume", volume);
    pg_json_number (j, "surface", area);
    pg_json_number (j, "smallest", b->smallest);
    pg_json_number (j, "largest", b->largest);
    pg_json_number (j, "worst_quality", b->quality);
    pg_json_count (j, "worst_element", (size_t) m->element_id[b->worst]);
    pg_json_shut (j);
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * The bare problem of the patch test: the discretisation without loads, supports and cracks, of one material,
 * with a load on its whole surface. */
#include "model.h"
#include <math.h>
#include <stdio.h>

/* Returns the material with the largest Poisson's ratio (the most prone to locking). One without a ratio
 * (NAN: anisotropic) is taken as the hardest. */
static const pg_material *stiffest (const pg_problem *p)
{
    size_t most = 0;
    for (size_t m = 1; m < p->nmaterial; m++)
        if (p->material[m].nu > p->material[most].nu || isnan (p->material[most].nu)) most = m;
    return &p->material[most];
}

/* Points on all facets, for forces that integrate over them. */
static pg_status make_surface (pg_problem *out, const pg_problem *p)
{
    pg_status status = PG_OK;
    pg_quadrature q = { 0 };
    pg_family_search *search = NULL;
    pg_widened w = { 0 };
    double *eye = NULL;
    out->bonds.rows[PG_FACETS] = (pg_rows) { 0 }, out->bonds.facet_normal = NULL;
    PG_TRY (pg_facet_points (&q, &p->cells, p->bonds.facet_order));
    PG_TRY (pg_rows_search (&search, &p->form.approx, &p->cloud));
    PG_TRY (pg_rows_eyes (&eye, &p->cloud, q.n, q.x, q.normal));
    PG_TRY (pg_rows_place (&out->bonds.rows[PG_FACETS], search, &p->cloud, q.n, q.x, q.weight, NULL, q.cell,
                           eye, p->threads));
    PG_TRY (
        pg_rows_widen (&out->bonds.rows[PG_FACETS], &p->form.approx, &p->cloud, NULL, NULL, p->threads, &w));
    pg_consistency_normals (p->form.consistency, &out->bonds.rows[PG_FACETS], q.normal);
    out->bonds.facet_normal = q.normal, q.normal = NULL;
done:
    pg_free (w.blind);
    pg_family_search_free (&search);
    pg_free (eye);
    pg_quadrature_clear (&q);
    return status;
}

/* Remakes nodes and evaluation points with the supports of the uncracked body: the supports widened at cracks
 * would make the intact body soft in modes that the cracked body does not have. */
static pg_status make_uncracked (pg_problem *out, const pg_problem *p)
{
    pg_status status = PG_OK;
    pg_family_search *search = NULL;
    pg_widened w = { 0 };
    out->bonds.rows[PG_NODES] = out->bonds.rows[PG_POINTS] = (pg_rows) { 0 }, out->form.consistency = NULL;
    out->bonds.wide_at_cracks = 1;
    PG_TRY (pg_rows_search (&search, &p->form.approx, &p->cloud));
    for (int s = PG_NODES; s <= PG_POINTS; s++) {
        const pg_rows *r = &p->bonds.rows[s];
        pg_free (w.blind), w.blind = NULL;
        PG_TRY (pg_rows_place (&out->bonds.rows[s], search, &p->cloud, r->n, r->x, r->weight, r->own, r->cell,
                               r->eye, p->threads));
        PG_TRY (pg_rows_widen (&out->bonds.rows[s], &p->form.approx, &p->cloud, NULL, NULL, p->threads, &w));
    }
    if (p->form.consistency)
        PG_TRY (pg_consistency_create (&out->form.consistency, &p->cells, &p->form.approx, &p->cloud,
                                       &out->bonds.rows[PG_POINTS], p->bonds.facet_order, p->threads));
done:
    pg_free (w.blind);
    pg_family_search_free (&search);
    return status;
}

/* Adds a traction of value zero that defines the loaded facets and the depth of the points that carry it. */
static pg_status make_load (pg_problem *out, const pg_problem *p)
{
    pg_status status = PG_OK;
    pg_set *all = NULL;
    out->boundary.load = NULL, out->boundary.nload = 0;
    if (!p->cells.nfacet) return PG_OK;
    PG_ALLOC (out->boundary.load, 1);
    out->boundary.nload = 1;
    PG_ALLOC (all, 1);
    out->sets.set = all, out->sets.n = 1;
    out->boundary.load->set = all;
    PG_ALLOC (all->facet, p->cells.nfacet);
    all->nfacet = p->cells.nfacet;
    for (size_t f = 0; f < all->nfacet; f++) all->facet[f] = (int) f;
    snprintf (out->boundary.load->name, sizeof out->boundary.load->name, "surface");
    out->boundary.load->kind = PG_TRACTION;
    for (size_t l = 0; l < p->boundary.nload; l++)
        if ((p->boundary.load[l].kind == PG_TRACTION || p->boundary.load[l].kind == PG_PRESSURE)
            && p->boundary.load[l].depth > 0)
            out->boundary.load->depth = p->boundary.load[l].depth;
    PG_TRY (pg_expression_compile (&out->boundary.load->ramp, "1", "1"));
done:
    return status;
}

/* Copies the struct and replaces what is not shared. Shared are cloud, cells, body and, unless supports are
 * widened at cracks, the bonds of points; its own are facet points, block and exempt marks, one load, one
 * material and one criterion. It must be freed by pg_problem_bare_free: pg_problem_free would also free the
 * shared parts. */
pg_status pg_problem_bare (pg_problem **out, const pg_problem *p)
{
    pg_status status = PG_OK;
    pg_problem *b = NULL;
    PG_ALLOC (b, 1);
    *out = b;
    *b = *p;
    b->crack.given = b->crack.slots = (pg_cracks){ 0 }, b->crack.tip = NULL, b->crack.ntip = 0,
    b->crack.front = NULL, b->crack.nfront = 0;
    b->criterion = NULL, b->boundary.load = NULL, b->boundary.nload = 0, b->bonds.facet_normal = NULL;
    b->bonds.rows[PG_FACETS] = (pg_rows) { 0 }, b->bonds.wide_at_cracks = 0;
    for (int s = 0; s < PG_BOND_SETS; s++)
        b->block[s] = b->at.law_of[s] = b->at.limit_of[s] = NULL, b->bonds.exempt[s] = NULL;
    b->at.vary = NULL, b->at.law = NULL, b->at.limit = NULL, b->at.nlaw = b->at.nlimit = 1;
    b->bonds.spacing[PG_FACETS] = NULL, b->quality.borne = NULL;
    for (int k = 0; k < 3; k++) b->boundary.initial[k] = NULL;
    b->boundary.motion = NULL, b->boundary.nmotion = 0;
    b->material = NULL, b->nmaterial = 1, b->sets.set = NULL, b->sets.n = 0;
    PG_ALLOC (b->material, 1);
    *b->material = *stiffest (p);
    PG_ALLOC (b->criterion, 1);
    b->at.law = b->material, b->at.limit = b->criterion;
    /* not with patches of the dilatation, which refer to the old neighbours */
    if (p->bonds.wide_at_cracks && !p->form.patches) PG_TRY (make_uncracked (b, p));
    if (p->method->shape_functions) PG_TRY (make_surface (b, p));
    else b->bonds.rows[PG_FACETS] = p->bonds.rows[PG_FACETS];
    PG_TRY (make_load (b, p));
    for (int s = 0; s < PG_BOND_SETS; s++) {
        PG_ALLOC (b->block[s], b->bonds.rows[s].n);
        b->at.law_of[s] = b->at.limit_of[s] = b->block[s];
        PG_ALLOC (b->bonds.exempt[s], b->bonds.rows[s].n);
        b->bonds.first[s + 1] =
            b->bonds.first[s] + (b->bonds.rows[s].n ? b->bonds.rows[s].family.start[b->bonds.rows[s].n] : 0);
    }
    PG_ALLOC (b->quality.borne, p->cells.nfacet);
    if (p->bonds.spacing[PG_FACETS]) PG_ALLOC (b->bonds.spacing[PG_FACETS], b->bonds.rows[PG_FACETS].n);
    /* The local spacing of a facet point is that of its nearest neighbour. */
    for (size_t q = 0; b->bonds.spacing[PG_FACETS] && q < b->bonds.rows[PG_FACETS].n; q++) {
        int nearest = pg_bonds_nearest (b, PG_FACETS, q);
        b->bonds.spacing[PG_FACETS][q] = nearest < 0 ? p->cloud.h : p->cloud.size[nearest];
    }
done:
    if (status != PG_OK) pg_problem_bare_free (out);
    return status;
}

/* Frees only what is not shared: facet points, marks of points, the load with its set, the material. */
void pg_problem_bare_free (pg_problem **bare)
{
    pg_problem *b = *bare;
    if (!b) return;
    if (b->method->shape_functions) {
        pg_rows_clear (&b->bonds.rows[PG_FACETS]);
        pg_free (b->bonds.facet_normal);
    }
    if (b->bonds.wide_at_cracks) {
        pg_rows_clear (&b->bonds.rows[PG_NODES]), pg_rows_clear (&b->bonds.rows[PG_POINTS]);
        pg_consistency_free (&b->form.consistency);
    }
    for (int s = 0; s < PG_BOND_SETS; s++) pg_free (b->block[s]), pg_free (b->bonds.exempt[s]);
    pg_free (b->bonds.spacing[PG_FACETS]), pg_free (b->material), pg_free (b->criterion),
        pg_free (b->quality.borne);
    if (b->sets.set) pg_free (b->sets.set->facet);
    pg_free (b->sets.set);
    if (b->boundary.load) pg_expression_free (&b->boundary.load->ramp);
    pg_free (b->boundary.load), pg_free (b);
    *bare = NULL;
}

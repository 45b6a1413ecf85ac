/* SPDX-License-Identifier: GPL-3.0-or-later
 * Builds a problem from a scene: body, points, cells, sets, cracks, laws, loads, bonds. Errors of all steps
 * are collected. */
#include "model.h"
#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* Finds the mode (1D, plane stress, plane strain, 3D); keys of another dimension are reported as errors. */
static pg_mode mode_of (const pg_scene *scene, int dim)
{
    static const struct {
        const char *key;
        int dim;
    } bound[] = { { "cross_section", 1 }, { "plane", 2 }, { "thickness", 2 } };
    for (size_t k = 0; k < sizeof bound / sizeof *bound; k++)
        if (bound[k].dim != dim && pg_scene_given (scene, "%s", bound[k].key))
            pg_scene_fault (scene, bound[k].key, "has a meaning only in %dD, and dimension is %d",
                            bound[k].dim, dim);
    if (dim == 1) return PG_LINE;
    if (dim == 3) return PG_SOLID;
    return strcmp (pg_scene_text (scene, "plane"), "strain") == 0 ? PG_PLANE_STRAIN : PG_PLANE_STRESS;
}

/* Name of a problem: the folder of `.../name/scene.yaml`, else the file name without ending. */
static void name_of (char *out, size_t size, const char *file)
{
    const char *slash = strrchr (file, '/'), *base = slash ? slash + 1 : file;
    size_t n = strcspn (base, ".");
    if (strncmp (base, "scene.", 6) == 0 && slash) {
        const char *start = slash;
        while (start > file && start[-1] != '/') start--;
        base = start, n = (size_t) (slash - start);
    }
    snprintf (out, size, "%.*s", (int) n, n ? base : "scene");
}

/* Makes the cells of a lattice; in parallel runs those around owned points in which the force is
 * evaluated. */
static pg_status cells_of_lattice (pg_problem *p, const pg_scene *scene)
{
    pg_status status = PG_OK;
    const pg_subdomain *s = p->cloud.subdomain;
    pg_approx approx = { 0 };
    double beyond;
    if (!s || !p->method->ghost_cells)
        return pg_cells_from_lattice (&p->cells, &p->lattice, p->cloud.thickness);
    PG_TRY (pg_method_approx (&approx, p->method, scene, p->cloud.h));
    p->method->ghost_cells (scene, &beyond);
    beyond += pg_scene_number (scene, "perturb.amount");   /* as perturbed points are off their sites */
    pg_box within = pg_subdomain_cells (s, &p->lattice, approx.horizon + beyond * p->cloud.h);
    PG_TRY (pg_cells_from_part (&p->cells, &p->lattice, p->cloud.thickness, &within));
done:
    return status;
}

/* Makes cells cut by the surface of the body; facets are divided at the boundaries of sets (rays). */
static pg_status cut_cells (pg_problem *p, const pg_scene *scene, const pg_lattice *lattice)
{
    pg_status status = PG_OK;
    pg_ray *ray = NULL;
    size_t n = 0;
    char doubt[200];
    PG_TRY (pg_sets_rays (&ray, &n, scene, &p->body));
    PG_TRY (pg_cells_cut (&p->cells, &p->body, lattice, p->cloud.thickness, n, ray));
    if (!p->cells.cut && p->cloud.subdomain) {  /* nothing is cut: uses the smaller range of cells */
        pg_cells_clear (&p->cells);
        PG_TRY (cells_of_lattice (p, scene));
    }
    if (p->lattice.dim) PG_TRY (pg_cells_share (&p->cloud, &p->cells, &p->lattice));
    if (pg_cells_doubt (&p->cells, doubt, sizeof doubt)) pg_problem_note (p, PG_WARNING "%s", doubt);
done:
    pg_free (ray);
    return status;
}

/* Makes the cells for points from a file in a body of shapes: those of a regular grid, independent of the
 * points. */
static pg_status cells_of_points (pg_problem *p, const pg_scene *scene, int cut)
{
    pg_status status = PG_OK;
    pg_lattice grid = { 0 };
    double spacing = pg_scene_number (scene, "spacing");
    PG_TRY (pg_lattice_fit (&grid, &p->body, spacing > 0 ? spacing : p->cloud.h, NULL));
    PG_TRY (cut ? cut_cells (p, scene, &grid) : pg_cells_from_lattice (&p->cells, &grid, p->cloud.thickness));
done:
    pg_lattice_clear (&grid);
    return status;
}

/* Turns PG_E_SCENE into PG_OK and lets later independent steps continue, so that all errors are reported
 * together. */
static pg_status pass (const pg_scene *scene, pg_status status)
{
    if (status == PG_E_SCENE) pg_scene_pass (scene);
    return status == PG_E_SCENE ? PG_OK : status;
}

/* With contact, cracks of the scene become sided, like growing cracks: points on a crack count as on its left
 * and keep their bonds to it; otherwise they lose the bonds to both sides. */
static pg_status side_cracks (pg_problem *p, const pg_scene *scene)
{
    if (p->dim == 1 || strcmp (pg_scene_text (scene, "contact.kind"), "none") == 0) return PG_OK;
    for (size_t k = 0; k < p->crack.given.n; k++) {
        pg_crack *c = &p->crack.given.crack[k];
        size_t dim = (size_t) p->dim;
        double middle[3] = { 0 };
        for (size_t i = 0; i < c->nvertex * dim; i++) middle[i % dim] += c->vertex[i] / (double) c->nvertex;
        c->sided = 1, c->width = PG_NO_LENGTH * pg_problem_spacing_at (p, middle);
        if (p->dim == 2) pg_crack_orient (c);
    }
    return pg_cracks_index (&p->crack.given);
}

/* Makes the lattice points of this rank with the ghosts that the force needs; all points in a process that
 * simulates all ranks (perigal check), and for points without lattice (see divide_points). */
static pg_status build_subdomain (pg_problem *p, const pg_scene *scene)
{
    pg_status status = PG_OK;
    double width, h;
    PG_TRY (pg_subdomain_check (p->method, scene));
    if (pg_ranks_now ()->whole || pg_scene_given (scene, "points")) {
        PG_TRY (pg_cloud_build (&p->cloud, &p->lattice, &p->body, scene));
        goto done;
    }
    PG_TRY (pg_cloud_spacing (&h, &p->body, scene));
    PG_TRY (pg_subdomain_width (&width, p->method, scene, p->dim, h));
    PG_TRY (pg_cloud_build_part (&p->cloud, &p->lattice, &p->body, scene, width));
done:
    return status;
}

/* Divides points of a file or a mesh, and the cells around them, of which every rank has made all: keeps
 * those that this rank stores. */
static pg_status divide_points (pg_problem *p, const pg_scene *scene)
{
    pg_status status = PG_OK;
    pg_approx approx = { 0 };
    double width, beyond, share = 1;
    int *owner = NULL;
    PG_TRY (pg_subdomain_width (&width, p->method, scene, p->dim, p->cloud.h));
    if (p->method->ghost_cells) {                      /* cells fill only a part of the layer of ghosts */
        PG_TRY (pg_method_approx (&approx, p->method, scene, p->cloud.h));
        p->method->ghost_cells (scene, &beyond);
        share = (approx.horizon + beyond * p->cloud.h) / width;
    }
    PG_TRY (pg_cloud_divide (&p->cloud, width, &owner));
    if (p->cells.n) PG_TRY (pg_cells_keep (&p->cells, &p->cloud, owner, share * p->cloud.subdomain->width));
    pg_cloud_keep (&p->cloud);
done:
    pg_free (owner);
    return status;
}

/* Refuses a body so far from the origin that the rounding of its coordinates is not small against the
 * tolerance of cells in finding surfaces, 1e-7 of half a spacing. */
static void refuse_far (const pg_problem *p, const pg_scene *scene)
{
    double rounding = pg_rounding (p->dim, p->cloud.low, p->cloud.high), least = pg_cloud_finest (&p->cloud);
    if (rounding <= 5e-8 * least) return;
    pg_scene_fault (scene,
                    p->part.mesh.n                     ? "mesh"
                    : pg_scene_given (scene, "points") ? "points"
                                                       : "body",
                    "lies %.3g m away from the origin, where coordinates are rounded to %.2g m, and its "
                    "points are %.3g m apart: what lies on a surface, or at the end of a horizon, cannot be "
                    "told from what lies beside it; move it nearer, within %.2g m",
                    rounding / (4 * DBL_EPSILON), rounding / 8, least,
                    5e-8 * least / (4 * DBL_EPSILON));
}

/* Builds body, cracks, points, cells and sets; stops at errors (pg_scene_verdict) that the next step cannot
 * tolerate. */
static pg_status build_geometry (pg_problem *p, const pg_scene *scene)
{
    pg_status status = PG_OK;
    PG_TRY (pg_body_read (&p->body, scene));
    PG_TRY (pass (scene, pg_cracks_read (&p->crack.given, scene)));
    PG_TRY (drop_doubled_cracks (p, scene));
    PG_TRY (pass (scene, pg_slots_read (&p->crack.slots, scene)));
    PG_TRY (pg_scene_verdict (scene));
    if (pg_scene_given (scene, "mesh")) {
        PG_TRY (pg_mesh_body_read (&p->part, scene));
        PG_TRY (pg_mesh_body_cloud (&p->cloud, &p->part, scene));
        if (pg_ranks_now ()) PG_TRY (pg_subdomain_check (p->method, scene));
    } else if (pg_ranks_now ()) PG_TRY (build_subdomain (p, scene));
    else PG_TRY (pg_cloud_build (&p->cloud, &p->lattice, &p->body, scene));
    refuse_far (p, scene);
    PG_TRY (pg_scene_verdict (scene));
    PG_TRY (side_cracks (p, scene));
    p->cells.dim = p->dim;
    int cut = strcmp (pg_scene_text (scene, "cells"), "cut") == 0,
        surface = strcmp (pg_scene_text (scene, "surface"), "none") != 0;
    if (p->part.mesh.n) PG_TRY (pg_cells_from_mesh (&p->cells, &p->part, p->cloud.thickness));
    else if (p->lattice.dim && cut) PG_TRY (cut_cells (p, scene, &p->lattice));
    else if (!p->lattice.dim && (pg_scene_count (scene, "body") || surface))
        PG_TRY (cells_of_points (p, scene, cut));
    else if (p->lattice.dim) PG_TRY (cells_of_lattice (p, scene));
    if (pg_ranks_now () && !pg_ranks_now ()->whole && !p->lattice.dim) PG_TRY (divide_points (p, scene));
    if (p->cloud.subdomain)
        pg_problem_note (p,
                         "%d ranks share the %.0f points; the patch test is left out: perigal check makes it",
                         pg_rank_count (), (double) p->cloud.subdomain->total);
    PG_TRY (pg_between_create (&p->between, &p->body, &p->part, &p->cloud));
    p->cloud.between = p->between;
    PG_TRY (pass (scene, pg_sets_build (&p->sets, scene, &p->body, &p->lattice, &p->cloud, &p->cells)));
done:
    return status;
}

/* Notes limits that differ by default from the formula of the literature (failure.calibration). */
static void note_calibration (pg_problem *p, const pg_scene *scene)
{
    const pg_growth *g = &p->criterion->growth;
    if (g->mean > 0 && !pg_scene_given (scene, "failure.calibration"))
        pg_problem_note (p,
                         "limits are %.2g %% below the formula of the literature, with which growing cracks "
                         "consume %.3g times the fracture energy; failure.calibration: theory takes it",
                         100 * (1 - 1 / sqrt (g->mean)), g->mean);
}

/* Reads the criteria of all materials. Their constants derive from a setting with data of the material and
 * the force. */
static pg_status read_criteria (pg_problem *p, const pg_scene *scene)
{
    pg_status status = PG_OK;
    pg_criterion_setting *setting = NULL;
    PG_ALLOC (setting, p->nmaterial);
    PG_ALLOC (p->criterion, p->nmaterial);
    for (size_t i = 0; i < p->nmaterial; i++) {
        const pg_material *m = &p->material[i];
        setting[i] = (pg_criterion_setting) { .mode = p->mode,
                                              .horizon = p->form.approx.horizon,
                                              .modulus = m->E,
                                              .poisson = m->nu,
                                              .thickness = p->cloud.thickness,
                                              .kernel = p->form.approx.kernel->name,
                                              .material = m->name,
                                              .reference = p->at.vary[i].reference,
                                              .usual = pg_problem_usual_criterion (p, scene) };
        if (p->method->limits) PG_TRY (p->method->limits (p, i, &setting[i]));
    }
    PG_TRY (pg_criterion_read (p->criterion, p->nmaterial, scene, setting));
    note_calibration (p, scene);
    pg_method_check_criterion (p, scene);
    pg_laws_check (p, scene);
    if (p->method->check_laws) p->method->check_laws (p, scene);
done:
    pg_free (setting);
    return status;
}

/* Reads materials, then the approximation (horizon, possibly in spacings), then the keys of the force, then
 * the criteria, whose constants follow from all of these. */
static pg_status build_laws (pg_problem *p, const pg_scene *scene)
{
    pg_status status = PG_OK;
    const char *name;
    p->nmaterial = pg_scene_count (scene, "materials");
    PG_ALLOC (p->material, p->nmaterial);
    PG_TRY (pg_laws_read (p, scene));
    for (size_t i = 0; (name = pg_scene_name (scene, i, "materials")); i++)
        PG_TRY (pg_material_read_graded (&p->material[i], scene, name, p->mode,
                                         p->at.vary[i].reference[PG_OF_STIFFNESS]));
    if (p->nmaterial == 0) {
        pg_scene_fault (scene, "materials", "at least one material is needed");
        PG_TRY (pg_scene_verdict (scene));
    }
    PG_TRY (pg_method_approx (&p->form.approx, p->method, scene, p->cloud.h));
    if (p->cloud.metric && (!p->method->shape_functions || p->form.approx.shape != PG_RADIAL))
        pg_scene_fault (scene, "mesh.support",
                        "anisotropic needs shape functions and method.support: radial");
    p->form.approx.congruent = p->cloud.regular && !p->plain;
    pg_method_note_ignored (p, scene);
    PG_TRY (pg_method_check_materials (p, scene));
    PG_TRY (p->method->read (p, scene));
    PG_TRY (read_criteria (p, scene));
done:
    return status;
}

/* Returns 1: x (m) lies within the horizon of some point, so that fields can be evaluated there. r: squared
 * distance, m^2; a: horizon of the point, m, scaled by its local spacing. */
static int sees_points (const pg_problem *p, const double *x)
{
    size_t dim = (size_t) p->dim;
    for (size_t i = 0; i < p->cloud.n; i++) {
        double bond[3] = { 0 };
        for (size_t k = 0; k < dim; k++) bond[k] = p->cloud.x[i * dim + k] - x[k];
        double r = pg_cloud_length2 (&p->cloud, i, bond);
        double a = p->form.approx.horizon * pg_cloud_ratio (&p->cloud, i);
        if (r < a * a) return 1;
    }
    return 0;
}

/* Reads the gauges; warns of those with an end on a crack, which could follow either face. */
static pg_status read_gauges (pg_problem *p, const pg_scene *scene)
{
    pg_status status = PG_OK;
    p->boundary.ngauge = pg_scene_count (scene, "output.gauges");
    PG_ALLOC (p->boundary.gauge, p->boundary.ngauge);
    for (size_t i = 0; i < p->boundary.ngauge; i++) {
        pg_gauge *g = &p->boundary.gauge[i];
        snprintf (g->name, sizeof g->name, "%s", pg_scene_text (scene, "output.gauges[%zu].name", i));
        pg_scene_vector (scene, 3, g->from, "output.gauges[%zu].from", i);
        pg_scene_vector (scene, 3, g->to, "output.gauges[%zu].to", i);
        for (int end = 0; end < 2; end++) {
            char path[64];
            snprintf (path, sizeof path, "output.gauges[%zu].%s", i, end ? "to" : "from");
            const double *place = end ? g->to : g->from;
            double seen = sees_points (p, place);
            PG_TRY (pg_ranks_most (1, &seen));
            if (!(seen > 0))
                pg_scene_fault (scene, path, "lies outside the body: no point within the horizon");
            if (pg_cracks_touch (pg_state_cracks (p, NULL), place, pg_cloud_same (&p->cloud)))
                pg_problem_note (p,
                                 PG_WARNING "gauge %s: %s lies on a crack, whose two faces move apart: "
                                            "which of them it follows is chance; "
                                            "put it beside the crack, however near",
                                 g->name, end ? "to" : "from");
        }
    }
done:
    return status;
}

/* Opening of a gauge: the relative displacement b - a of its ends along the line between them,
 * m; positive when they move apart. */
double pg_gauge_opening (const pg_gauge *g, int dim, const double *a, const double *b)
{
    double length = 0, sum = 0;
    for (int k = 0; k < dim; k++) {
        length += (g->to[k] - g->from[k]) * (g->to[k] - g->from[k]);
        sum += (g->to[k] - g->from[k]) * (b[k] - a[k]);
    }
    return length > 0 ? sum / sqrt (length) : 0;
}

/* First half of building a problem: all but the bonds. Errors that do not hinder later steps are reported
 * together. */
pg_status pg_problem_prepare_with (pg_problem **out, const pg_scene *scene, const pg_method *const *methods,
                                   int threads)
{
    pg_status status = PG_OK;
    pg_problem *p = NULL;
    PG_ALLOC (p, 1);
    p->methods = methods, p->method = pg_method_of (methods, scene);
    if (!p->method) PG_FAIL (PG_E_USAGE, "method.force: unknown");
    p->dim = (int) pg_scene_integer (scene, "dimension");
    p->threads = threads < 1 ? 1 : threads;
    p->mode = mode_of (scene, p->dim);
    /* A thickness of 1 m, or a cross-section of 1 m^2, is assumed where none is given; the plan says so. */
    p->quality.thickness_assumed = p->dim < 3
                           && !pg_scene_given (scene, "%s", p->dim == 2 ? "thickness" : "cross_section");
    p->plain = pg_scene_bool (scene, "solver.plain");
    p->equilibria = pg_scene_entry_is (scene, "solver.kind", PG_SOLVER_STATIC);
    p->quality.accept_inexact = pg_scene_bool (scene, "method.accept_inexact");
    /* NAN until the patch test has run. */
    p->quality.patch = (pg_patch) { .error = NAN, .compliance = NAN };
    const char *title = pg_scene_text (scene, "title");
    name_of (p->name, sizeof p->name, pg_scene_file (scene));
    snprintf (p->title, sizeof p->title, "%s", title && *title ? title : p->name);
    pg_scene_pass (scene);
    PG_TRY (build_geometry (p, scene));
    if (pg_scene_partial (scene)) PG_TRY (pg_scene_conclude (scene));
    PG_TRY (build_laws (p, scene));
    /* 2D: always, as a crack may begin anywhere; 3D: with cracks or crack growth */
    if (p->dim == 2 || (p->dim == 3 && (p->crack.given.n || pg_problem_grows (p))))
        PG_TRY (pg_body_search_create (&p->crack.search, &p->cloud, &p->body, &p->part));
    PG_TRY (pg_tips_retreat (p, scene));
    PG_TRY (pg_loads_read (p, scene));
    for (size_t l = 0; l < p->boundary.nload; l++)
        if (!p->boundary.load[l].set) PG_TRY (pg_scene_conclude (scene));
    PG_TRY (pg_initial_read (p, scene));
    PG_TRY (pg_blocks_check (p, scene));
    PG_TRY (pg_interfaces_read (p, scene));
    PG_TRY (read_gauges (p, scene));
    pg_scene_pass (scene);
    *out = p;
    p = NULL;
done:
    pg_problem_free (&p);
    return status;
}

/* Second half of building a problem, for scenes without errors: bonds, and checks that need them. */
pg_status pg_problem_complete (pg_problem *p, const pg_scene *scene)
{
    pg_status status = PG_OK;
    PG_TRY (pg_scene_conclude (scene));
    pg_remark_spacing (p, scene);
    pg_remark_small_shapes (p);
    pg_remark_thin_walls (p);
    pg_remark_units (p, scene);
    pg_remark_clouds (p);
    PG_TRY (pg_remark_hanging (p));
    pg_remark_plane (p);
    PG_TRY (pg_bonds_build (p, scene));
    pg_remark_graded (p, scene);
    pg_remark_interfaces (p);
    PG_TRY (pg_remark_parts (p));
    PG_TRY (pg_remark_contrast (p));
    if (p->method->check_points) p->method->check_points (p, scene);
    PG_TRY (pg_scene_verdict (scene));
done:
    return status;
}

/* Frees the shape functions of the intact body. */
static void intact_free (pg_intact **intact)
{
    for (int s = 0; *intact && s < PG_BOND_SETS; s++) pg_rows_clear (&(*intact)->rows[s]);
    if (*intact) pg_rows_clear (&(*intact)->sums), pg_assembly_free (&(*intact)->K);
    pg_free (*intact);
    *intact = NULL;
}

/* Frees the problem, also one that was built in part only: all pointers start as NULL, and freeing those does
 * nothing. The criteria hold memory of their own and go before the array that they lie in. */
void pg_problem_free (pg_problem **problem)
{
    pg_problem *p = *problem;
    if (!p) return;
    pg_laws_clear (p);
    for (int s = 0; s < PG_BOND_SETS; s++)
        pg_rows_clear (&p->bonds.rows[s]), pg_free (p->bonds.exempt[s]), pg_free (p->block[s]),
            pg_free (p->bonds.spacing[s]), pg_free (p->bonds.held[s].owned),
            pg_free (p->bonds.held[s].number);
    intact_free (&p->quality.intact);
    pg_consistency_free (&p->form.consistency);
    pg_patches_free (&p->form.patches);
    pg_sums_free (&p->sums);
    pg_free (p->options);
    pg_stages_clear (p), pg_loads_clear (p), pg_initial_clear (p);
    pg_criterion_clear (p->criterion, p->nmaterial);
    pg_free (p->bonds.facet_normal), pg_free (p->boundary.gauge), pg_free (p->at.interface);
    pg_free (p->material), pg_free (p->criterion);
    pg_sets_clear (&p->sets);
    pg_cells_clear (&p->cells);
    pg_cloud_clear (&p->cloud);
    pg_lattice_clear (&p->lattice);
    pg_between_free (&p->between);
    pg_cracks_clear (&p->crack.given), pg_cracks_clear (&p->crack.slots);
    for (size_t f = 0; p->crack.front && f < p->crack.nfront; f++) pg_front_clear (&p->crack.front[f]);
    pg_free (p->crack.tip), pg_free (p->crack.front), pg_body_search_free (&p->crack.search);
    pg_mesh_body_clear (&p->part);
    pg_body_clear (&p->body);
    pg_free (p);
    *problem = NULL;
}

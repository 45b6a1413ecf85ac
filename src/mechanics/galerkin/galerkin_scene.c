/* SPDX-License-Identifier: GPL-3.0-or-later
 * The options of the Galerkin form in a scene: keys, stabilisation, and how displacements are prescribed
 * (Nitsche, elimination or penalty). */
#include "mechanics/galerkin/weak_form/galerkin.h"
#include <math.h>
#include <string.h>

static const pg_key keys[] = {
    { "method.integration", PG_NAME, NULL, NULL, "", NULL, pg_integration_names, NULL,
      "Where the weak form is evaluated; unless given consistent where cells are cut by the surface of the "
      "body or cracks grow by facets (linear basis, not nosb), else gauss; nodal for points without cells." },
    { "method.gauss_points", PG_INTEGER, NULL, "[1, 5]", "", NULL, NULL, NULL,
      "Gauss points per direction of a background cell; default 2 for the linear basis, 3 for the quadratic "
      "one (with 2 it converges slowly); "
      "2 more in a mesh with points in the middle of edges. Triangles and tetrahedra take the rule of the "
      "same degree." },
    { "method.dilatation", PG_NAME, NULL, NULL, "auto", "auto|pointwise|projected", NULL, NULL,
      "The dilatation that carries the pressure, against locking near Poisson's ratio 1/2 (plane strain, "
      "3D): pointwise: at every evaluation point; projected: "
      "of patches of about 2 x 2 (x 2) cells, linear in each; auto: projected for materials with a Poisson's "
      "ratio of 0.45 or more." },
    { "method.stabilization", PG_NAME, NULL, NULL, "auto", "auto|none|silling", NULL, NULL,
      "Against zero-energy modes of nodal integration; auto: silling for nosb with nodal integration, else "
      "none." },
    { "method.stabilization_factor", PG_NUMBER, "1", "(0, inf)", "0.1", NULL, NULL, NULL,
      "Strength Gs of the stabilisation, 0.05 to 1." },
    { "method.essential", PG_NAME, NULL, NULL, "auto", "auto|nitsche|transformation|penalty", NULL, NULL,
      "How displacements are prescribed; auto: nitsche on boundary facets; penalty on all points of a set "
      "that has points behind its facets (wide grips), or more than 6000 points and no facet; "
      "else transformation on points (always for nosb)." },
    { "method.nitsche_factor", PG_NUMBER, "1", "(0, inf)", "100", NULL, NULL, NULL,
      "Nitsche's beta in units of E / spacing (of (lambda + 2 mu) / 4 where that is more and dilatation is "
      "pointwise)." },
    { "method.penalty_factor", PG_NUMBER, "1", "(0, inf)", "1e6", NULL, NULL, NULL,
      "Penalty in units of E / spacing." },
};
const pg_key_table galerkin_keys = { "force", keys, sizeof keys / sizeof *keys };

/* Reads the options. Stabilisation applies to nodal integration of an approximation that expands about the
 * node. */
pg_status galerkin_read (pg_problem *p, const pg_scene *scene)
{
    pg_status status = PG_OK;
    galerkin_options *o = NULL;
    const char *stabilization = pg_scene_text (scene, "method.stabilization");
    PG_ALLOC (o, 1);
    p->options = o;
    double cut = p->cells.cut != NULL;                 /* on any rank */
    PG_TRY (pg_ranks_most (1, &cut));
    int needed = p->cells.n > 0 && (cut > 0 || pg_problem_by_facets (p, scene));
    p->form.integration = pg_integration_of (scene, needed);
    if (needed && p->form.approx.order > 1 && !pg_scene_given (scene, "method.integration"))
        pg_problem_note (p,
                         "method.integration: %s, as the basis is quadratic; consistent is exact in cut "
                         "cells and along cracks and takes 3 to 7 times as long",
                         p->form.integration->name);
    p->form.approx.extrapolates = p->form.approx.refined = p->form.integration->consistent;
    if (!p->form.integration->at_nodes && p->cells.n == 0)
        pg_scene_fault (scene, "method.integration",
                        "a body of explicit points has no background cells: use nodal, or give shapes as its "
                        "surface (body)");
    /* expanding about the node itself leaves displacements that alternate from node to node free (theory
     * D4) */
    int wanted = p->form.approx.type->interpolates && p->form.integration->at_nodes;
    int asked = strcmp (stabilization, "silling") == 0;
    if (asked && !wanted)
        pg_scene_fault (scene, "method.stabilization", "silling stabilises nosb with nodal integration");
    if (asked || (wanted && strcmp (stabilization, "auto") == 0))
        o->silling = pg_scene_number (scene, "method.stabilization_factor");
    o->nitsche = pg_scene_number (scene, "method.nitsche_factor");
    o->penalty = pg_scene_number (scene, "method.penalty_factor");
done:
    return status;
}

/* The method that the scene names; auto: by whether there are facets. */
static pg_essential essential_of (const char *how, int facets)
{
    if (strcmp (how, "transformation") == 0) return PG_ESSENTIAL_TRANSFORMATION;
    if (strcmp (how, "penalty") == 0) return PG_ESSENTIAL_PENALTY;
    return strcmp (how, "nitsche") == 0 || facets ? PG_ESSENTIAL_NITSCHE : PG_ESSENTIAL_TRANSFORMATION;
}

/* Fails on several ranks: shape functions that do not interpolate couple all points of a set that are
 * eliminated, across ranks. */
static void check_elimination (const pg_problem *p, const pg_load *load, const pg_scene *scene, size_t i)
{
    char path[64];
    if (!pg_load_prescribes (load) || load->essential != PG_ESSENTIAL_TRANSFORMATION) return;
    if (p->form.approx.type->interpolates || !pg_ranks_now ()) return;
    snprintf (path, sizeof path, "boundary[%zu]", i);
    pg_scene_fault (scene, path, "%d ranks: essential: transformation couples all points of the set, which "
                    "one process alone can hold: use essential: nitsche or penalty, or division: matrices",
                    pg_rank_count ());
}

/* Chooses how a load prescribes displacements, unless the scene says so: Nitsche's terms on facets; a penalty
 * on sets with interior points, which facets would leave free, and on sets too large to eliminate; else
 * elimination, always where the shape functions are 1 at their own nodes. */
void galerkin_support (const pg_problem *p, pg_load *load, const pg_scene *scene, size_t i)
{
    const galerkin_options *o = p->options;
    const pg_set *set = load->set;
    const char *how = pg_scene_given (scene, "boundary[%zu].essential", i)
                          ? pg_scene_text (scene, "boundary[%zu].essential", i)
                          : pg_scene_text (scene, "method.essential");
    int eliminate = p->form.approx.type->interpolates;
    int large = pg_set_inner (set)
                || (pg_set_facets (set) == 0 && pg_set_points (set) > PG_MOST_ELIMINATED);
    load->essential = essential_of (how, pg_set_facets (set) > 0 && !eliminate);
    load->penalty = o->penalty;
    if (strcmp (how, "auto") != 0 || eliminate || !large) {
        check_elimination (p, load, scene, i);
        return;
    }
    load->essential = PG_ESSENTIAL_PENALTY;
    /* no shorter time step than with Nitsche's terms */
    if (!pg_scene_entry_is (scene, "solver.kind", PG_SOLVER_IMPLICIT))
        load->penalty = fmin (o->penalty, o->nitsche);
}

/* Stiffness of supports for the estimate of the time step, in units of E / spacing: Nitsche's factor;
 * supports by a penalty are not included. */
double galerkin_support_stiffness (const pg_problem *p)
{
    int any = 0;
    for (size_t l = 0; l < p->boundary.nload; l++)
        any |= pg_load_prescribes (&p->boundary.load[l])
               && p->boundary.load[l].essential == PG_ESSENTIAL_NITSCHE;
    return any ? ((const galerkin_options *) p->options)->nitsche : 0;
}

/* Sets `graded`: in graded clouds limits of a bond between ends of unlike supports are scaled by the mean of
 * both. */
pg_status galerkin_limits (const pg_problem *p, size_t material, pg_criterion_setting *setting)
{
    (void) material;
    setting->graded = p->cloud.size != NULL;
    return PG_OK;
}

/* Could the dilatation be projected? Decided by the keys of the scene, before materials are read. */
static int projects (const pg_scene *scene)
{
    const char *mode = pg_scene_text (scene, "method.dilatation"), *name;
    int yes = strcmp (mode, "projected") == 0;
    if (strcmp (mode, "auto") != 0) return yes;
    for (size_t i = 0; (name = pg_scene_name (scene, i, "materials")); i++)
        yes |= pg_scene_given (scene, "materials.%s.poissons_ratio", name)
               && pg_scene_number (scene, "materials.%s.poissons_ratio", name) > 0.449;
    return yes;
}

/* Widths of ghost layers in spacings: WIDER, WIDER_AT_CRACKS: how far wider supports (pg_rows_widen) reach
 * beyond a horizon (at most 1.6 in 130 random bodies at horizons of 1.5 to 3.5, at most 3 beside cracks of 80
 * more). HOSTS, in cells: from a host to its small cut cells (pg_consistency) and to their neighbours. */
enum { WIDER = 2, WIDER_AT_CRACKS = 4, HOSTS = 2 };

/* Width of the ghost layers of ranks that share the body, in cells. The row of an owned node is made of the
 * points within one horizon of it, whose shape functions involve nodes within one horizon of theirs. With
 * consistent integration all points of a cell belong together, with the neighbouring cells. Cells around
 * owned nodes are elements of the preconditioner. Patches of the dilatation are two cells wide, or three
 * points, or twice as much where two have joined; those at the end of the ghost layer are incomplete, as are
 * those that they have joined. */
double galerkin_ghost_cells (const pg_scene *scene, double *beyond)
{
    int patches = projects (scene),
        consistent = pg_integration_of (scene, 1)->consistent,
        wider = pg_scene_given (scene, "cracks") ? WIDER_AT_CRACKS : WIDER;
    double cells = (patches ? 8 : 2) + wider + (consistent ? HOSTS : 0);
    *beyond = cells;
    return cells + 1 + wider;
}

/* One line for the summary of the run. */
void galerkin_words (const pg_problem *p, char *text, size_t size)
{
    snprintf (text, size, "%s, %s basis, %s kernel, %s integration", p->form.approx.type->name,
              p->form.approx.order == 2 ? "quadratic" : "linear", p->form.approx.kernel->name,
              p->form.integration->name);
}

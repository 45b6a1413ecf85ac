/* SPDX-License-Identifier: GPL-3.0-or-later
 * Sizes of a run from the scene alone: method and solver as written, points and bonds counted on the lattice
 * or sampled from a file. */
#include "forecast.h"
#include "perigal/linalg.h"
#include <math.h>
#include <string.h>
#include <sys/stat.h>

static const double pi = 3.14159265358979323846;
static const double most_cells = 4e6;                  /* of a lattice that is counted, else a coarser one */

/* 1: the text, which may be NULL, equals this word. */
static int is (const char *text, const char *word) { return text && strcmp (text, word) == 0; }

/* Radius, in spacings, of the ball that holds `coupled` nodes: as many as one node is coupled to. */
static double radius_of (int dim, double coupled)
{
    return dim == 3 ? cbrt (coupled * 3 / (4 * pi)) : dim == 2 ? sqrt (coupled / pi) : coupled / 2;
}

/* Number of facets that loads and supports use, guessed from the names of their sets: a side has its open
 * faces, a set of the scene counts as an average side. Supports need facets for Nitsche's method only. */
static double used_facets (const pg_scene *scene, const pg_tally *t, int dim)
{
    static const char *const sides[6] = { "left", "right", "bottom", "top", "back", "front" };
    double used = 0, all = 0;
    const char *how = pg_scene_text (scene, "method.essential");
    const pg_approx_type *type = pg_approx_find (pg_scene_text (scene, "method.approximation"));
    int nitsche = is (how, "nitsche")
                  || (is (how, "auto") && !(type && type->interpolates));
    for (int k = 0; k < 2 * dim; k++) all += t->open[k];
    for (size_t i = 0; i < pg_scene_count (scene, "boundary"); i++) {
        const char *set = pg_scene_text (scene, "boundary[%zu].set", i);
        int prescribes = pg_scene_given (scene, "boundary[%zu].displacement", i)
                         || pg_scene_given (scene, "boundary[%zu].velocity", i);
        int pushes = pg_scene_given (scene, "boundary[%zu].traction", i)
                     || pg_scene_given (scene, "boundary[%zu].pressure", i);
        double open = all / (2 * dim);
        if (!(pushes || (prescribes && nitsche))) continue;
        for (int k = 0; k < 2 * dim; k++) if (is (set, sides[k])) open = t->open[k];
        used += is (set, "all") ? all : open;
    }
    return fmin (used, all);
}

/* Largest pressure wave speed of the materials, m/s; 0 without densities. Moduli that depend on position do
 * not count. */
static double fastest_wave (const pg_scene *scene, int dim)
{
    const char *name;
    pg_mode mode = dim == 3                                          ? PG_SOLID
                   : dim == 1                                        ? PG_LINE
                   : is (pg_scene_text (scene, "plane"), "strain") ? PG_PLANE_STRAIN
                                                                     : PG_PLANE_STRESS;
    double top = 0;
    for (size_t i = 0; (name = pg_scene_name (scene, i, "materials")); i++) {
        pg_material m = { 0 };
        if (pg_material_read_graded (&m, scene, name, mode, 1) == PG_OK)
            top = fmax (top, pg_material_waves (&m).pressure);
    }
    return top;
}

/* Reads which linear solver is asked for; weight = beta (2 c dt)^2 of implicit dynamics, m^2: how much K
 * weighs compared with the mass. */
static void read_solver (pg_forecast *f, const pg_scene *scene)
{
    const char *linear = pg_scene_text (scene, "solver.linear");
    double alpha = pg_scene_number (scene, "solver.alpha"), beta = pg_scene_number (scene, "solver.beta"),
           dt = pg_scene_number (scene, "solver.dt");
    f->is.automatic = !linear || is (linear, "auto");
    f->is.dynamic = !pg_scene_entry_is (scene, "solver.kind", PG_SOLVER_STATIC);
    f->is.explicit_ = !pg_scene_entry_is (scene, "solver.kind", PG_SOLVER_IMPLICIT);
    f->linear = f->is.automatic ? pg_linear_usual (1, 1) : pg_linear_find (linear);
    if (f->linear && !f->linear->factors) f->linear = NULL;
    if (!(beta > 0)) beta = (1 - alpha) * (1 - alpha) / 4;
    const char *stepping = pg_scene_text (scene, "solver.stepping");
    f->is.elements = f->method->shape_functions && !pg_scene_bool (scene, "solver.plain")
                  && !is (pg_scene_text (scene, "solver.preconditioner"), "jacobi");
    f->is.events = f->is.breaks && !f->is.dynamic && !pg_scene_bool (scene, "solver.plain")
                   && !is (stepping, "fixed");
    const char *contact = pg_scene_text (scene, "contact.kind");
    if (f->method->shape_functions && !f->is.explicit_ && contact && !is (contact, "none"))
        f->is.pressed = is (contact, "friction") ? 2 : 1;
    f->weight = beta * (1 + alpha) * pow (2 * fastest_wave (scene, f->dim) * dt, 2);
}

/* 1: lattice points may share rows of shape functions (mechanics/galerkin/weak_form/galerkin_rows.c): there
 * is no file of points, no mesh, no perturbation and no crack. */
static int shares_rows (const pg_forecast *f, const pg_scene *scene)
{
    if (!f->method->shape_functions || pg_scene_bool (scene, "solver.plain")) return 0;
    return !pg_scene_given (scene, "points") && !pg_scene_given (scene, "mesh")
           && !(pg_scene_number (scene, "perturb.amount") > 0) && pg_scene_count (scene, "cracks") == 0;
}

/* Reads the entries of `method`, `failure` and `output` that change counts or bytes. */
static void read_method (pg_forecast *f, const pg_scene *scene)
{
    const char *criterion = pg_scene_text (scene, "failure.criterion");
    const pg_criterion_type *type = criterion ? pg_criterion_find (criterion) : NULL;
    const pg_integration_type *integration = pg_integration_of (scene, type && type->needs & PG_NEEDS_FACETS);
    f->is.matrixless = f->method->long_range && f->method->long_range (scene);
    f->rotations = f->method->rotations[f->dim];
    f->is.by_list = !f->method->shape_functions
                 && (is (pg_scene_text (scene, "method.evaluation"), "list")
                     || is (pg_scene_text (scene, "method.surface_correction"), "volume")
                     || pg_scene_number (scene, "perturb.amount") > 0
                     || pg_scene_count (scene, "blocks") > 1);
    f->is.nodal = !f->method->shape_functions || (integration && integration->at_nodes);
    /* consistent integration: 1 until its bonds are counted */
    f->count.summed = f->method->shape_functions && integration && integration->consistent;
    f->is.breaks = pg_scene_given (scene, "failure")
                   && !is (pg_scene_text (scene, "failure.criterion"), "none");
    f->count.fields = (double) pg_scene_count (scene, "output.fields") + 1;  /* 1 for the coefficients d */
    f->is.pictures = pg_scene_name (scene, 0, "output.pictures") != NULL;
    f->is.irregular = pg_scene_given (scene, "points") || pg_scene_given (scene, "mesh")
                   || pg_scene_number (scene, "perturb.amount") > 0;
    f->is.shared = !(f->count.summed > 0) && !f->is.breaks && shares_rows (f, scene);
    read_solver (f, scene);
}

/* Side of a cube of a cell's volume, m. */
static double lattice_step (const pg_lattice *l)
{
    double cell = 1;
    for (int k = 0; k < l->dim; k++) cell *= l->step[k];
    return l->dim == 1 ? cell : l->dim == 2 ? sqrt (cell) : cbrt (cell);
}

/* Adds bonds of consistent integration: each point of a cell or its faces has the neighbours of all of them,
 * about half a spacing further out. Faces have as many points as the inside of the cell. reach: horizon in
 * spacings. */
static void widen (pg_forecast *f, double reach)
{
    double wider = pow ((reach + 0.5) / reach, f->dim);
    if (!(f->count.summed > 0)) return;
    f->count.summed = f->count.bonds[PG_POINTS] * (wider + 1);
    f->count.pairs *= pow ((reach + 0.25) / reach, f->dim);
}

/* Adds the evaluation points and bonds of cut cells, half of which have their centre outside. They have more
 * points than whole ones: 1.23 and 1.6 times as many (2D, 3D), with consistent integration 2.6 and 5.1 times
 * (2.4 to 3.5 and 3.3 to 5.6, measured on disks, balls and cylinders: rather too many than too few); points
 * near the surface have three quarters of the neighbours of others. */
static void add_cut (pg_forecast *f, const pg_tally *t, double finer, int consistent)
{
    static const double points[2][3] = { { 1, 1.23, 1.6 }, { 1, 2.6, 5.1 } };
    double crossed = t->crossed * pow (finer, f->dim - 1), per = points[consistent != 0][f->dim - 1];
    double more = t->cells > 0 ? crossed * (per - 0.5) * t->evaluation / t->cells : 0,
           seen = consistent && f->dim == 3 ? 0.85 : 0.75;
    if (t->evaluation > 0) f->count.bonds[PG_POINTS] += seen * more * t->point_bonds / t->evaluation;
    f->count.cells += 0.5 * crossed, f->count.evaluation += more;
}

/* Takes the counts of a lattice whose steps are `finer` times as wide as the scene's, scaled: those of the
 * body by finer^dim, of facets by finer^(dim - 1). edge: nodes along the edges of a full box with as many
 * nodes as the body, for nested dissection. */
static void take_tally (pg_forecast *f, const pg_scene *scene, const pg_tally *t, const pg_counting *how,
                        const pg_lattice *l, double finer)
{
    double more = pow (finer, f->dim), facets = used_facets (scene, t, f->dim) * pow (finer, f->dim - 1),
           per = 1, sites = 1;
    for (int k = 0; k + 1 < f->dim; k++)
        per *= t->crossed > 0 ? fmax (how->order, how->approx->order + 1) : how->approx->order + 1;
    f->count.points = t->points * more, f->count.cells = t->cells * more,
    f->count.evaluation = t->evaluation * more, f->count.pairs = t->pairs * more;
    f->count.bonds[PG_NODES] = t->node_bonds * more, f->count.bonds[PG_POINTS] = t->point_bonds * more;
    int consistent = f->method->shape_functions && t->crossed > 0
                     && pg_integration_of (scene, 1)->consistent;
    add_cut (f, t, finer, consistent);
    if (consistent) f->count.summed = 1, f->is.shared = 0;
    f->count.facets = !f->method->shape_functions ? 0 : facets * per;
    widen (f, how->approx->horizon / lattice_step (l));
    f->count.bonds[PG_FACETS] = f->count.facets * 0.6 * t->node_bonds / t->points;
    f->order = how->approx->order, f->is.interpolates = how->approx->type && how->approx->type->interpolates;
    f->is.behind = how->centred;
    f->is.scattered = f->is.nodal && pg_scene_number (scene, "perturb.amount") > 0;
    f->width = 0.93 * radius_of (f->dim, t->coupled);
    f->is.counted = !t->sampled && finer == 1 && t->crossed == 0;
    for (int k = 0; k < 3; k++)
        f->edge[k] = k < f->dim ? l->count[k] + !how->centred : 1, sites *= f->edge[k];
    /* shrink the bounding box until its nodes are as many as the body's */
    double fill = pow (t->points / sites, 1.0 / f->dim);
    for (int k = 0; k < f->dim; k++) f->edge[k] *= fill * finer;
}

/* Builds the stencil of the bonds of one point, for peridynamic forces, by the rule of the scene. Perturbed
 * points have no cells, so that their partial volumes follow from distances. */
static pg_status make_bonds (pg_stencil *out, const pg_method *method, const pg_scene *scene,
                             const pg_lattice *l, const pg_approx *a)
{
    pg_mode mode = l->dim == 1                                     ? PG_LINE
                   : l->dim == 3                                   ? PG_SOLID
                   : is (pg_scene_text (scene, "plane"), "strain") ? PG_PLANE_STRAIN
                                                                   : PG_PLANE_STRESS;
    pg_sum_rule rule;
    method->rule (&rule, scene, mode, a, lattice_step (l),
                    !(pg_scene_number (scene, "perturb.amount") > 0));
    return pg_stencil_build (out, &rule, l->dim, l->step);
}

/* Counts on the scene's lattice, or on one with 2, 4 ... times its steps where that has more than most_cells
 * cells; the horizon grows alike, so that points keep their number of neighbours. */
static pg_status count_lattice (pg_forecast *f, const pg_scene *scene, const pg_body *body)
{
    pg_status status = PG_OK;
    pg_lattice l = { 0 };
    pg_approx a;
    pg_tally t;
    pg_stencil bonds = { 0 };
    double spacing = pg_scene_number (scene, "spacing"), cells = 1, offset[3] = { 0 }, finer = 1;
    int shifted = pg_scene_vector (scene, 3, offset, "lattice_offset") > 0;
    if (!(spacing > 0)) PG_FAIL (PG_E_SCENE, "there is no spacing");
    for (int k = 0; k < body->dim; k++) cells *= (body->high[k] - body->low[k]) / spacing;
    if (!(cells < 1e15)) PG_FAIL (PG_E_SCENE, "spacing %g m gives %.3g lattice cells", spacing, cells);
    while (cells / pow (finer, body->dim) > most_cells) finer *= 2;
    PG_TRY (pg_lattice_fit (&l, body, spacing * finer, shifted ? offset : NULL));
    f->spacing = lattice_step (&l) / finer;
    PG_TRY (pg_method_approx (&a, f->method, scene, f->spacing));
    f->horizon = a.horizon, a.horizon *= finer;            /* m: as many steps of the coarser lattice */
    for (int k = 0; k < 3; k++) f->step[k] = l.step[k] / finer;
    int order = pg_scene_given (scene, "method.gauss_points")
                    ? (int) pg_scene_integer (scene, "method.gauss_points")
                    : a.order + 1;
    if (!f->method->shape_functions) PG_TRY (make_bonds (&bonds, f->method, scene, &l, &a));
    pg_counting how = { &l,
                        &a,
                        is (pg_scene_text (scene, "lattice"), "cells"),
                        f->is.nodal,
                        order,
                        is (pg_scene_text (scene, "cells"), "cut") ? body : NULL,
                        !f->method->shape_functions ? &bonds : NULL };
    PG_TRY (pg_tally_count (&t, &how));
    if (!(t.points > 0)) PG_FAIL (PG_E_SCENE, "no point lies in the body");
    take_tally (f, scene, &t, &how, &l, finer);
done:
    pg_stencil_clear (&bonds);
    pg_lattice_clear (&l);
    return status;
}

/* Counts elements, their evaluation points, and the outer faces with theirs, which have as many bonds each as
 * a node has on average. Each entry of `boundary` counts as one of 2 dim sides. */
static pg_status count_elements (pg_forecast *f, const pg_scene *scene, const pg_mesh_body *part,
                                 const pg_approx *a)
{
    pg_status status = PG_OK;
    const pg_mesh *m = &part->mesh;
    double xi[3 * PG_ELEMENT_POINTS], w[PG_ELEMENT_POINTS], count[PG_ELEMENTS],
        facets = 0, all = 0, each = f->count.bonds[PG_NODES] / f->count.points;
    int usual = a->order + 1 + 2 * pg_mesh_body_halved (part), order = usual;
    if (pg_scene_given (scene, "method.gauss_points"))
        order = (int) pg_scene_integer (scene, "method.gauss_points");
    size_t n = 0;
    int *element = NULL, *side = NULL, node[9];
    for (int k = 0; k < PG_ELEMENTS; k++) count[k] = pg_element_rule ((pg_element) k, order, xi, w);
    f->count.cells = (double) m->n, f->count.evaluation = 0;
    /* bytes of pg_mesh and pg_mesh_body: nodes, elements and their nodes */
    f->count.mesh = 32 * (double) m->nnode + 25 * (double) m->n + 4 * (double) m->start[m->n];
    for (size_t e = 0; e < m->n && !f->is.nodal; e++) f->count.evaluation += count[m->kind[e]];
    f->count.bonds[PG_POINTS] = f->count.evaluation * each;
    PG_TRY (pg_mesh_surface (m, &n, &element, &side));
    for (int k = 0; k < PG_ELEMENTS; k++) count[k] = pg_element_rule ((pg_element) k, usual, xi, w);
    for (size_t k = 0; k < n; k++)
        all += count[pg_element_face ((pg_element) m->kind[element[k]], side[k], node)];
    /* every entry of `boundary` loads one side */
    for (size_t i = 0; i < pg_scene_count (scene, "boundary"); i++) facets += all / (2 * f->dim);
    f->count.facets = !f->method->shape_functions ? 0 : fmin (facets, all),
    f->count.bonds[PG_FACETS] = f->count.facets * 0.6 * each;
done:
    pg_free (element), pg_free (side);
    return status;
}

/* Bytes of a file that the scene names; 0: there is none. */
static double bytes_of_file (const pg_scene *scene, const char *key)
{
    char *path = NULL;
    struct stat about;
    int there = pg_scene_beside (&path, scene, pg_scene_text (scene, "%s", key)) == PG_OK
                && stat (path, &about) == 0;
    pg_free (path);
    return there ? (double) about.st_size : 0;
}

/* Counts the bonds of points from a file or a mesh: families are searched for about 20 000 of them; nodes
 * that share an evaluation point with one node are about those within 1.6 horizons. */
static pg_status count_file (pg_forecast *f, const pg_scene *scene, const pg_body *body)
{
    pg_status status = PG_OK;
    pg_lattice l = { 0 };
    pg_cloud c = { 0 };
    pg_family near = { 0 }, far = { 0 };
    pg_mesh_body part = { 0 };
    pg_approx a;
    double *centre = NULL;
    if (pg_scene_given (scene, "mesh")) {
        PG_TRY (pg_mesh_body_read (&part, scene));
        PG_TRY (pg_mesh_body_cloud (&c, &part, scene));
    } else {
        PG_TRY (pg_cloud_build (&c, &l, body, scene));
        /* bytes to read it: its text; points in arrays that grow up to twice their length; the list by which
         * duplicate points are found, with a copy to sort it (geometry/cloud/body/points_file.c): measured on
         * 8 ranks */
        f->count.reading = 2 * bytes_of_file (scene, "points") + (132 + 16 * (double) c.dim) * (double) c.n;
    }
    PG_TRY (pg_method_approx (&a, f->method, scene, c.h));
    size_t stride = c.n / 20000 + 1, n = 0, dim = (size_t) c.dim;
    PG_ALLOC (centre, (c.n / stride + 1) * dim);
    for (size_t i = 0; i < c.n; i += stride) memcpy (centre + n++ * dim, c.x + i * dim, dim * sizeof *centre);
    /* partial volumes fall to 0 over one spacing about the horizon */
    if (!f->method->shape_functions && !is (pg_scene_text (scene, "method.partial_volume"), "none"))
        a.horizon += 0.5 * c.h;
    PG_TRY (pg_family_build (&near, &c, n, centre, a.horizon, a.shape, a.kernel->closed));
    PG_TRY (pg_family_build (&far, &c, n / 8 + 1, centre, 1.6 * a.horizon, a.shape, a.kernel->closed));
    f->spacing = c.h, f->horizon = a.horizon, f->count.points = (double) c.n;
    if (!part.mesh.n) f->is.nodal = 1;
    f->count.bonds[PG_NODES] = (double) near.start[n] / (double) n * f->count.points;
    double coupled = (double) far.start[far.n] / (double) far.n, side = 1;
    if (!f->method->shape_functions)
        coupled = f->count.bonds[PG_NODES] / f->count.points, f->count.bonds[PG_NODES] -= f->count.points;
    f->count.pairs = 0.5 * f->count.points * (coupled + 1);
    f->order = a.order, f->is.interpolates = a.type && a.type->interpolates;
    f->width = 0.93 * radius_of (f->dim, coupled);
    for (int k = 0; k < 3; k++)
        f->step[k] = c.h, f->edge[k] = k < f->dim ? (c.high[k] - c.low[k]) / c.h + 1 : 1, side *= f->edge[k];
    for (int k = 0; k < f->dim; k++) f->edge[k] *= pow (f->count.points / side, 1.0 / f->dim);
    f->is.counted = stride == 1;
    if (part.mesh.n) PG_TRY (count_elements (f, scene, &part, &a));
done:
    pg_mesh_body_clear (&part);
    pg_free (centre);
    pg_family_clear (&near), pg_family_clear (&far);
    pg_cloud_clear (&c), pg_lattice_clear (&l);
    return status;
}

/* Forecasts a run from its scene; faults that come to light on the way are added to the scene. */
pg_status pg_forecast_scene (pg_forecast *out, const pg_scene *scene, const pg_method *const *methods)
{
    pg_status status = PG_OK;
    pg_body body = { 0 };
    memset (out, 0, sizeof *out);
    out->dim = (int) pg_scene_integer (scene, "dimension");
    out->method = pg_method_of (methods, scene);
    if (!out->method) PG_FAIL (PG_E_USAGE, "method.force: unknown");
    PG_TRY (pg_scene_verdict (scene));
    PG_TRY (pg_body_read (&body, scene));
    PG_TRY (pg_scene_verdict (scene));
    read_method (out, scene);
    if (pg_scene_given (scene, "points") || pg_scene_given (scene, "mesh"))
        PG_TRY (count_file (out, scene, &body));
    else PG_TRY (count_lattice (out, scene, &body));
    PG_TRY (pg_scene_verdict (scene));
    /* bonds that a gap or a notch of the body cuts are counted as well: the counts are not exact */
    if (body.n && pg_body_parts (&body, &(pg_mesh_body) { 0 }) > 0) out->is.counted = 0;
    forecast_factor (out);
    pg_forecast_sum (out);
done:
    pg_body_clear (&body);
    return status;
}

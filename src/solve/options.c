/* SPDX-License-Identifier: GPL-3.0-or-later
 * Options of the solver from the keys of a scene, and checks of what does not go together. */
#include "solve/contact/contact.h"
#include "solve/growth/facet_growth.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static int is (const char *text, const char *word) { return text && strcmp (text, word) == 0; }
static int given (const pg_scene *scene, const char *key) { return pg_scene_given (scene, "%s", key); }

/* Filters of the catalogue of solvers, for messages that name suitable solvers. */
static int breaks_in_passing (const pg_solver_type *type, const void *unused)
{
    (void) unused;
    return (type->flags & PG_SOLVER_STAGED) != 0;
}

static int grows_facets (const pg_solver_type *type, const void *unused)
{
    (void) unused;
    return (type->flags & PG_SOLVER_FACETS) != 0;
}

/* Reports tips of cracks that do not lie on the path (failure.path) to which cracks are held. */
static void check_path (const pg_problem *problem, const pg_scene *scene)
{
    size_t n;
    const double *path = problem->criterion->type->path (problem->criterion, &n);
    for (size_t i = 0; path && n > 1 && i < problem->crack.ntip; i++) {
        const double *x = problem->crack.tip[i].x, nowhere[2] = { 0, 0 };
        double to[3], off;
        int ends;
        off = facet_on_path (path, n, x, nowhere, 0, to, &ends);
        if (off > 0.5 * pg_problem_spacing_at (problem, x))
            pg_scene_fault (
                scene, "failure.path",
                "the tip of a crack at (%.6g, %.6g) m lies %.3g m beside it: the path must run through "
                "every tip",
                x[0], x[1], off);
    }
}

/* Refuses options that growth of crack fronts (3D) cannot handle. */
static void read_fronts (const pg_solver_options *o, const pg_problem *problem, const pg_scene *scene)
{
    size_t n;
    pg_fracture_limits limits = { .shear = NAN };
    const double origin[3] = { 0, 0, 0 };
    if (!(o->flags & PG_SOLVER_QUASI_STATIC))
        pg_scene_fault (scene, "solver.kind", "fronts in space grow in equilibrium only: use kind: static");
    if (problem->criterion->type->path (problem->criterion, &n))
        pg_scene_fault (scene, "failure.path", "is for cracks in the plane: leave it out");
    for (size_t m = 0; m < problem->nmaterial; m++)
        if (problem->criterion[m].type && !problem->criterion[m].never)
            problem->criterion[m].type->fracture (&problem->criterion[m], origin, 0, &limits);
    if (limits.shear > 0)
        pg_scene_fault (scene, "failure.shear_fracture_energy",
                        "is for cracks in the plane: fronts in space go where they open");
}

/* Reads the options of facets: criteria of tips need facets, and solvers that can grow them. */
static void read_facets (pg_solver_options *o, const pg_problem *problem, const pg_scene *scene)
{
    int tips = pg_criterion_of_tips (problem->criterion), asked = o->break_mode == PG_BREAK_FACET;
    double h = problem->cloud.h;
    if (tips) check_path (problem, scene);
    if (tips && !given (scene, "solver.break")) o->break_mode = PG_BREAK_FACET;
    o->branching = pg_scene_bool (scene, "solver.branching");
    o->facet = given (scene, "solver.facet") ? pg_scene_length (scene, h, "solver.facet") : 0;
    if (tips && !(o->flags & PG_SOLVER_FACETS)) {
        char names[200];
        solver_names_that (grows_facets, NULL, names, sizeof names);
        pg_scene_fault (
            scene, "failure.criterion",
            "%s judges tips in equilibrium, which %s does not look for: use solver.kind: %s, or a "
            "criterion of bonds",
            problem->criterion->type->name, o->kind, names);
    } else if (tips && o->break_mode != PG_BREAK_FACET)
        pg_scene_fault (scene, "solver.break",
                        "criterion: %s judges tips, not bonds: use facet, or leave it out",
                        problem->criterion->type->name);
    else if (asked && !tips)
        pg_scene_fault (scene, "solver.break", "facet needs a criterion that judges tips: criterion: %s",
                        pg_criterion_by_need (PG_NEEDS_FACETS));
    double most = problem->dim == 3 ? 1 : 4;
    if (given (scene, "solver.facet") && o->break_mode == PG_BREAK_FACET
        && !(o->facet >= 0.25 * h * (1 - 1e-12) && o->facet <= most * h * (1 + 1e-12)))
        pg_scene_fault (scene, "solver.facet", "must lie in [0.25, %g] spacings of %.6g m%s", most, h,
                        problem->dim == 3 ? ": longer advances make fronts in space wavy" : "");
    if (tips && problem->dim == 3) read_fronts (o, problem, scene);
}

/* Reads how bonds break between solves, and what ends a run early. */
static void read_breaking (pg_solver_options *o, const pg_problem *problem, const pg_scene *scene)
{
    const char *mode = pg_scene_text (scene, "solver.break"),
               *stop = pg_scene_text (scene, "solver.stop.set");
    o->break_mode = is (mode, "all")        ? PG_BREAK_ALL
                    : is (mode, "fraction") ? PG_BREAK_FRACTION
                    : is (mode, "passing")  ? PG_BREAK_PASSING
                    : is (mode, "facet")    ? PG_BREAK_FACET
                                            : PG_BREAK_WORST;
    o->break_fraction = pg_scene_number (scene, "solver.break_fraction");
    o->tie = pg_scene_number (scene, "solver.tie");
    o->max_events = pg_scene_integer (scene, "solver.max_events");
    o->stop_damage = pg_scene_number (scene, "solver.stop.damage");
    if (stop && *stop) o->stop_set = pg_sets_named (&problem->sets, scene, "solver.stop.set", stop);
    if (o->break_mode == PG_BREAK_PASSING && !(o->flags & (PG_SOLVER_STAGED | PG_SOLVER_EXPLICIT))) {
        char names[200];
        solver_names_that (breaks_in_passing, NULL, names, sizeof names);
        pg_scene_fault (scene, "solver.break", "passing goes with solver.kind: %s", names);
    }
    read_facets (o, problem, scene);
}

/* Inertia needs a density of every material. */
static void need_density (const pg_solver_options *o, const pg_problem *problem, const pg_scene *scene)
{
    for (size_t i = 0; i < problem->nmaterial; i++)
        if (!(problem->material[i].density > 0))
            pg_scene_fault (scene, "solver.kind", "%s needs the density of material %s", o->kind,
                            problem->material[i].name);
}

static int finds_equilibria (const pg_solver_type *type, const void *unused)
{
    (void) unused;
    return (type->flags & PG_SOLVER_STATIC) == PG_SOLVER_STATIC;
}

/* Refuses stages for other solvers than those with a load factor, as dynamics and relaxation do not have them
 * yet. */
static void check_stages (const pg_solver_options *o, const pg_problem *problem, const pg_scene *scene)
{
    char names[200];
    if (!problem->boundary.nstage || (o->flags & PG_SOLVER_STATIC) == PG_SOLVER_STATIC) return;
    solver_names_that (finds_equilibria, NULL, names, sizeof names);
    pg_scene_fault (scene, "stages",
                    "%s does not know stages of loading so far: use solver.kind: %s, or boundary[].table",
                    o->kind, names);
}

/* Lists the keys of the solver that belong to other kinds: left over from one of these, they are no fault. */
static void find_unused (pg_solver_options *o, const pg_scene *scene)
{
    char path[PG_STRAY_PATH];
    const char *key;
    size_t used = 0;
    for (size_t k = 0; (key = pg_scene_stray (scene, k, "solver", path)) && used < sizeof o->unused; k++)
        used += (size_t) snprintf (o->unused + used, sizeof o->unused - used, "%s%s", used ? ", " : "", key);
}

/* Context of goes_with: does this force accept a kind of solver? */
typedef struct { const pg_problem *problem; const pg_force_type *force; } pairing;

static int goes_with (const pg_solver_type *type, const void *context)
{
    const pairing *with = context;
    return !with->force->method.refuses (with->problem, type->flags);
}

/* Reports where the force refuses the kind of solver, and names those that it accepts. */
static void check_force (const pg_solver_options *o, const pg_problem *problem, const pg_scene *scene)
{
    pairing with = { problem, pg_force_of (problem) };
    const char *why = with.force && with.force->method.refuses
                          ? with.force->method.refuses (problem, o->flags) : NULL;
    char others[200];
    if (!why) return;
    solver_names_that (goes_with, &with, others, sizeof others);
    pg_scene_fault (scene, "solver.kind", "%s%s%s", why, *others ? ", or solver.kind: " : "", others);
}

static int knows_contact (const pg_solver_type *type, const void *unused)
{
    (void) unused;
    return (type->flags & PG_SOLVER_CONTACT) != 0;
}

static int steps_explicitly (const pg_solver_type *type, const void *unused)
{
    (void) unused;
    return (type->flags & PG_SOLVER_EXPLICIT) != 0;
}

/* Writes the names of the forces whose unknowns are displacements of points: "bond, fcbm". */
static const char *forces_of_points (char *text, size_t size)
{
    size_t used = 0;
    *text = 0;
    for (const pg_method *const *m = pg_force_methods (); *m && used < size; m++)
        if (!(*m)->shape_functions)
            used += (size_t) snprintf (text + used, size - used, "%s%s", used ? ", " : "", (*m)->name);
    return text;
}

/* Checks short-range contact, which acts on displacements of points in explicit time steps. */
static void check_short_range (const pg_solver_options *o, const pg_problem *problem, const pg_scene *scene)
{
    char names[200];
    solver_names_that (steps_explicitly, NULL, names, sizeof names);
    if (!(o->flags & PG_SOLVER_EXPLICIT))
        pg_scene_fault (scene, "contact.search",
                        "short_range acts in time steps by the force alone: use solver.kind: %s, or search: "
                        "faces", names);
    const pg_force_type *force = pg_force_of (problem);
    int points = !problem->method->shape_functions || problem->form.approx.type->interpolates;
    if (o->contact.impulses && !points)
        pg_scene_fault (scene, "contact.enforcement",
                        "impulses act on points with a mass of their own, which the unknowns of "
                        "method.approximation: %s are not: use springs, or method.force: %s",
                        problem->form.approx.type->name, forces_of_points (names, sizeof names));
    if (!points && (problem->boundary.nplaten || !force || !force->surfaces.at_nodes))
        pg_scene_fault (scene, "contact.search",
                        "short_range acts on displacements of points, which the unknowns of "
                        "method.approximation: %s are not: use method.force: %s",
                        problem->form.approx.type->name, forces_of_points (names, sizeof names));
}

/* 1: single bonds break in this problem. */
static int breaks_bonds (const pg_problem *problem)
{
    return problem->criterion->type && !pg_criterion_of_tips (problem->criterion);
}

/* Checks that body and force have crack faces that can be distinguished. */
static void check_faces (const pg_problem *problem, const pg_scene *scene)
{
    const pg_force_type *force = pg_force_of (problem);
    if (problem->dim == 1)
        pg_scene_fault (scene, "contact.kind", "a body of one dimension has no faces of cracks: set none");
    else if (force && !force->surfaces.jump && !force->surfaces.faces)
        pg_scene_fault (scene, "contact.kind",
                        "force: %s does not show how far crack faces are apart: set none, or take a force "
                        "with shape functions", problem->method->name);
    else if (force && force->surfaces.faces && problem->sums && problem->sums->rule.finite)
        pg_scene_fault (scene, "contact.kind",
                        "faces that touch stay where they were opposite each other, which is right for small "
                        "displacements: use method.stretch: linear, or set none");
}

/* Reports missing contact where cracks can begin in shear under pressure, as these do not open. */
static void need_contact (const pg_problem *problem, const pg_scene *scene)
{
    const double origin[3] = { 0, 0, 0 };
    for (size_t m = 0; m < problem->nmaterial; m++) {
        const pg_criterion *c = &problem->criterion[m];
        pg_fracture_limits limits = { .cohesion = NAN };
        if (!c->type || c->never || !pg_criterion_of_tips (c)) continue;
        c->type->fracture (c, origin, 0, &limits);
        if (!(limits.cohesion > 0)) continue;
        pg_scene_fault (scene, "contact.kind",
                        "cracks that begin in shear (failure.cohesion) have faces that press on each other: "
                        "set friction or normal, or leave the cohesion out");
        return;
    }
}

/* Checks contact of crack faces, and refuses it where it is not implemented. */
static void check_contact (const pg_solver_options *o, const pg_problem *problem, const pg_scene *scene)
{
    const pg_force_type *force = pg_force_of (problem);
    char names[200];
    int by_bonds = force && force->surfaces.faces, rests = (o->flags & PG_SOLVER_STATIC) == PG_SOLVER_STATIC,
        moves = (o->flags & PG_SOLVER_IMPLICIT) && (o->flags & PG_SOLVER_NEEDS_DENSITY);
    if (o->contact.kind == PG_CONTACT_NONE) {
        need_contact (problem, scene);
        return;
    }
    if (o->contact.search == PG_CONTACT_SHORT_RANGE) {
        check_short_range (o, problem, scene);
        return;
    }
    solver_names_that (knows_contact, NULL, names, sizeof names);
    check_faces (problem, scene);
    if (!(o->flags & PG_SOLVER_CONTACT))
        pg_scene_fault (scene, "contact.kind", "solver.kind: %s does not know contact yet: use %s, or set "
                        "none", o->kind, names);
    else if (moves && by_bonds)
        pg_scene_fault (scene, "contact.kind",
                        "solver.kind: %s keeps faces apart in forces with shape functions only: use force: "
                        "galerkin, or set none", o->kind);
    else if (!by_bonds && !rests && !moves)
        pg_scene_fault (scene, "contact.kind",
                        "solver.kind: %s knows it of forces by bonds, whose layer between the faces is a "
                        "spring: use solver.kind: static, another method.force, or set none", o->kind);
    else if (breaks_bonds (problem) && rests && !by_bonds)
        pg_scene_fault (scene, "contact.kind",
                        "keeps the faces of cracks apart, not those of single broken bonds of force: %s: "
                        "judge tips (break: facet), take a force by bonds, leave failure out, or set none",
                        problem->method->name);
    else if (options_begin_cracks (problem) && (problem->dim == 3 || by_bonds || !rests))
        pg_scene_fault (scene, "contact.kind",
                        "goes with a strength, at which new cracks begin, in the plane, at rest and with "
                        "shape functions: leave tensile_strength and cohesion out of failure, or set none");
    for (size_t k = 0; k < problem->boundary.nstage; k++)
        if (problem->boundary.stage[k].remove)
            pg_scene_fault (scene, "contact.kind",
                            "does not know parts that stages take out of the body: leave their remove out, "
                            "or set none");
    if (o->on_instability != PG_UNSTABLE_FOLLOW)
        pg_scene_fault (scene, "solver.on_instability",
                        "with contact.kind the load follows equilibrium only: use follow");
}

/* Reads the options: the common part, then that of the method; then checks what does not go together. */
pg_status pg_solver_options_read (pg_solver_options *o, const pg_problem *problem, const pg_scene *scene)
{
    memset (o, 0, sizeof *o);
    o->scene = scene;
    snprintf (o->kind, sizeof o->kind, "%s", pg_scene_text (scene, "solver.kind"));
    snprintf (o->linear, sizeof o->linear, "%s", pg_scene_text (scene, "solver.linear"));
    const pg_solver_type *type = pg_solver_find (o->kind);
    snprintf (o->preconditioner, sizeof o->preconditioner, "%s",
              pg_scene_text (scene, "solver.preconditioner"));
    o->flags = pg_solver_flags (o->kind);
    o->plain = problem->plain;
    o->tolerance = pg_scene_number (scene, "solver.tolerance");
    o->max_iterations = pg_scene_integer (scene, "solver.max_iterations");
    o->levels = pg_scene_integer (scene, "output.at.levels");
    o->rows = o->flags & PG_SOLVER_IMPLICIT ? 0 : options_integer (scene, "output.at.rows");
    o->contact = pg_contact_read (scene);
    read_breaking (o, problem, scene);
    if (type && type->read) type->read (o, problem, scene);
    check_contact (o, problem, scene);
    platens_check (o, problem, scene);
    find_unused (o, scene);
    if (o->flags & PG_SOLVER_NEEDS_DENSITY) need_density (o, problem, scene);
    check_force (o, problem, scene);
    check_stages (o, problem, scene);
    return pg_scene_verdict (scene);
}

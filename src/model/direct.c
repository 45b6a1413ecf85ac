/* SPDX-License-Identifier: GPL-3.0-or-later
 * Forces straight between points (method.force: bond): the rule of their sums, their bonds, and which keys of
 * the scene mean nothing to them. Theory A1 to A3. */
#include "model.h"
#include <math.h>
#include <string.h>

int pg_direct_force (const pg_scene *scene)
{
    const char *force = pg_scene_text (scene, "method.force");
    return force && strcmp (force, "galerkin") != 0;
}

static int is (const pg_scene *scene, const char *key, const char *word)
{
    const char *text = pg_scene_text (scene, "%s", key);
    return text && strcmp (text, word) == 0;
}

/* Of micropolar bonds beside an energy of the dilatation, at most: there the two shears of a lattice with a
 * horizon of 3 spacings come nearest to each other (0.3 %; 2 % at the largest ratio, where bonds bear no
 * shear, 6 % at 0) */
static double usual_poisson (pg_mode mode) { return mode == PG_PLANE_STRESS ? 0.25 : 0.2; }

/* What a force means where the scene says nothing: how it is summed, what breaks; state: state-based; turns:
 * its points turn as well. */
typedef struct {
    const char *force;
    pg_evaluation evaluation;
    const char *criterion;
    int state, turns;
} custom;
static const custom customs[] = {
    { "fcbm", PG_EVALUATE_FFT, "node_energy", 0, 0 },  /* Jafarzadeh et al. 2022 */
    { "lps", PG_EVALUATE_AUTO, NULL, 1, 0 },           /* Silling et al. 2007 */
    { "gmpd", PG_EVALUATE_AUTO, "beam_limits", 0, 1 }, /* Chen et al. 2022 */
};

static const custom *custom_of (const pg_scene *scene)
{
    for (size_t k = 0; k < sizeof customs / sizeof *customs; k++)
        if (is (scene, "method.force", customs[k].force)) return &customs[k];
    return NULL;
}

const char *pg_direct_criterion (const pg_scene *scene)
{
    const custom *c = custom_of (scene);
    if (c && c->criterion) return c->criterion;
    return pg_scene_given (scene, "failure.fracture_energy")
                   || pg_scene_given (scene, "failure.critical_stretch")
               ? "stretch"
               : NULL;
}

int pg_direct_turns (const pg_scene *scene, int dim)
{
    const custom *c = custom_of (scene);
    return c && c->turns ? dim == 3 ? 3 : dim == 2 : 0;
}

int pg_direct_state (const pg_scene *scene)
{
    const custom *c = custom_of (scene);
    return c && (c->state || (c->turns && pg_scene_bool (scene, "method.volumetric")));
}

/* With the multilevel preconditioner a solve is some 10 iterations of 15 sweeps of the bonds each, at any
 * size, and making it costs two solves; the analysis and factorization of K alone are dearer from about 1000
 * unknowns on, and below 4000 (2D) and 1500 (3D) both take a few hundredths of a second: there the factor
 * stays, whose residual is rounding. With the diagonal alone iterations grow as the points along the body. */
int pg_direct_large (int told, int dim, double dofs)
{
    if (dim == 1) return 0;
    if (told) return dofs > (dim == 3 ? 1500 : 4000);
    return dofs > (dim == 3 ? 3e4 : 4e5);
}

/* Sums of forces that such a run asks for, about */
static double sweeps_of (const pg_scene *scene)
{
    if (pg_scene_has (scene, "solver.time_steps"))
        return (double) pg_scene_integer (scene, "solver.time_steps");
    if (pg_solver_is (pg_scene_text (scene, "solver.kind"), PG_SOLVER_STATIC)) return 200;
    return 1000;
}

void pg_direct_rule (pg_sum_rule *rule, const pg_scene *scene, pg_mode mode, const pg_approx *approx,
                     double spacing, int lattice)
{
    static const char partial[] = "method.partial_volume", surface[] = "method.surface_correction",
                      evaluation[] = "method.evaluation";
    const custom *own = custom_of (scene);
    *rule = (pg_sum_rule) { .mode = mode, .kernel = approx->kernel, .horizon = approx->horizon };
    /* whole cells are the more isotropic then (theory A2: quadratic, m = 3) */
    int fading = !approx->kernel->closed && mode != PG_SOLID;
    rule->partial = is (scene, partial, "none")      ? PG_PARTIAL_NONE
                    : is (scene, partial, "linear")  ? PG_PARTIAL_LINEAR
                    : is (scene, partial, "overlap") ? PG_PARTIAL_OVERLAP
                    : !lattice                       ? PG_PARTIAL_LINEAR
                    : fading                         ? PG_PARTIAL_NONE
                                                     : PG_PARTIAL_OVERLAP;
    rule->surface = is (scene, surface, "product")  ? PG_SURFACE_PRODUCT
                    : is (scene, surface, "volume") ? PG_SURFACE_VOLUME
                    : is (scene, surface, "none") || approx->horizon < 4 * spacing * (1 - 1e-9)
                        ? PG_SURFACE_NONE
                        : PG_SURFACE_PRODUCT;
    rule->beams = own && own->turns;
    rule->calibrate = pg_scene_bool (scene, "method.calibrate");
    rule->finite = is (scene, "method.stretch", "finite");
    rule->evaluation = is (scene, evaluation, "stencil") ? PG_EVALUATE_STENCIL
                       : is (scene, evaluation, "list")  ? PG_EVALUATE_LIST
                       : is (scene, evaluation, "fft")   ? PG_EVALUATE_FFT
                                                         : PG_EVALUATE_AUTO;
    rule->sweeps = sweeps_of (scene);
    rule->state = pg_direct_state (scene);
    rule->follow = rule->state && is (scene, "method.weighted_volume", "live");
    if (rule->state && !rule->beams && !is (scene, surface, "product") && !is (scene, surface, "volume"))
        rule->surface = PG_SURFACE_NONE;
    if (own && !pg_scene_given (scene, "method.evaluation")) rule->evaluation = own->evaluation;
}

/* ---- what the scene says in vain ----------------------------------------------------------------------- */
/* Which force, forces that are not galerkin, or forces with dilatations a key of method is for */
static const struct { const char *key, *force;
} uses[] = {
    { "approximation", "galerkin" },    { "basis", "galerkin" },
    { "support", "galerkin" },          { "weights", "galerkin" },
    { "degenerate", "galerkin" },       { "integration", "galerkin" },
    { "gauss_points", "galerkin" },     { "dilatation", "galerkin" },
    { "stabilization", "galerkin" },    { "stabilization_factor", "galerkin" },
    { "essential", "galerkin" },        { "nitsche_factor", "galerkin" },
    { "penalty_factor", "galerkin" },   { "evaluation", "direct" },
    { "partial_volume", "direct" },     { "calibrate", "direct" },
    { "surface_correction", "direct" }, { "stretch", "direct" },
    { "weighted_volume", "state" },     { "beam", "gmpd" },
    { "shear_parameter", "gmpd" },      { "cm_ratio", "gmpd" },
    { "volumetric", "gmpd" },           { "bond_poisson", "gmpd" },
};

void pg_direct_note_unused (pg_problem *p, const pg_scene *scene)
{
    const char *force = p->direct ? p->force : "galerkin";
    char text[200] = "";
    size_t used = 0;
    for (size_t k = 0; k < sizeof uses / sizeof *uses; k++) {
        int meant = strcmp (uses[k].force, force) == 0 || (p->direct && strcmp (uses[k].force, "direct") == 0)
                    || (pg_direct_state (scene) && strcmp (uses[k].force, "state") == 0);
        if (!meant && pg_scene_given (scene, "method.%s", uses[k].key) && used + 40 < sizeof text)
            used += (size_t) snprintf (text + used, sizeof text - used, "%s%s", used ? ", " : "",
                                       uses[k].key);
    }
    if (used) pg_problem_note (p, "without meaning for force: %s, in method: %s", force, text);
    if (!p->direct) return;
    for (size_t i = 0; i < pg_scene_count (scene, "boundary"); i++) {
        char path[64];
        snprintf (path, sizeof path, "boundary[%zu].essential", i);
        if (pg_scene_given (scene, "%s", path) && !is (scene, path, "auto")
            && !is (scene, path, "transformation"))
            pg_problem_note (
                p,
                "without meaning for force: %s: %s (the displacements of points are prescribed as they are)",
                p->force, path);
    }
}

/* E is kept; the tangent, wave speeds and the stress of a gradient are those of the material that the bonds
 * make. */
static void take_poisson (pg_problem *p)
{
    double nu = pg_bond_poisson (p->mode);
    for (size_t m = 0; m < p->nmaterial && p->mode != PG_LINE; m++) {
        pg_material *a = &p->material[m];
        double E = a->modulus, asked = a->nu;
        if (fabs (asked - nu) > 0.005)
            pg_problem_note (p,
                             "warning: material %.40s: Poisson's ratio is %.4g, not %.4g: bonds alone leave "
                             "no choice (Young's modulus is kept)",
                             a->name, nu, asked);
        pg_elastic_set (a, E, nu);
    }
}

/* Bonds take their constants from Young's modulus and Poisson's ratio: a tangent alone they would have to
 * replace by an isotropic one. */
static void refuse_tangents (const pg_problem *p, const pg_scene *scene)
{
    for (size_t m = 0; m < p->nmaterial; m++) {
        char path[120];
        if (p->material[m].type->can & PG_MATERIAL_ISOTROPIC) continue;
        snprintf (path, sizeof path, "materials.%.63s.model", p->material[m].name);
        pg_scene_fault (scene, path,
                        "force: %s makes its bonds from Young's modulus and Poisson's ratio and cannot carry "
                        "a material that depends on the direction: "
                        "use force: galerkin, or model: elastic",
                        p->force);
    }
}

/* State-based: any Poisson's ratio; families that are not whole count by their own q. */
static void refuse_matrix (const pg_problem *p, const pg_scene *scene)
{
    if (is (scene, "solver.linear", "cholmod") || is (scene, "solver.linear", "umfpack"))
        pg_scene_fault (scene, "solver.linear",
                        "force: %s%s reaches its neighbours' neighbours and has no matrix, only its product: "
                        "use pcg or auto",
                        p->force, p->turns ? " with volumetric: on" : "");
}

static void check_state (pg_problem *p, const pg_scene *scene, const pg_sum_rule *rule)
{
    refuse_matrix (p, scene);
    if (p->mode == PG_LINE)
        pg_scene_fault (scene, "method.force",
                        "%s has no meaning in one dimension, where it is the same as bond: use force: bond",
                        p->force);
    if (rule->finite)
        pg_scene_fault (scene, "method.stretch",
                        "force: %s is linear in the displacement: use stretch: linear, or force: bond",
                        p->force);
    if (rule->surface != PG_SURFACE_NONE)
        pg_scene_fault (
            scene, "method.surface_correction",
            "force: %s weighs families that are not whole by their own weighted volume: use none or auto",
            p->force);
}

void pg_problem_beams (const pg_problem *p, size_t material, double *E, double *nu, double *dilation)
{
    const pg_material *m = &p->material[material];
    *E = m->modulus, *nu = m->nu, *dilation = 0;
    if (!p->sums->rule.state) return;
    *nu = isnan (p->bond_poisson) ? fmin (*nu, usual_poisson (p->mode)) : p->bond_poisson;
    pg_beam_split (E, dilation, p->mode, m->modulus, m->nu, *nu);
}

/* The bonds' own Poisson's ratio may be neither more than they bear nor more than the material's: dilatation
 * would have negative energy. */
static void check_volumetric (pg_problem *p, const pg_scene *scene)
{
    static const char key[] = "method.bond_poisson";
    double most = pg_beam_poisson (p->mode);
    refuse_matrix (p, scene);
    p->bond_poisson = pg_scene_given (scene, key) ? pg_scene_number (scene, key) : NAN;
    if (p->bond_poisson > most + 1e-9)
        pg_scene_fault (scene, key, "%.6g is more than %.6g, the largest of micropolar bonds%s",
                        p->bond_poisson, most, p->mode == PG_PLANE_STRESS ? " in plane stress" : "");
    for (size_t m = 0; m < p->nmaterial; m++)
        if (p->bond_poisson > p->material[m].nu)
            pg_scene_fault (scene, key,
                            "%.6g is more than that of material %.63s, %.6g: less energy of dilatation than "
                            "none; choose at most that",
                            p->bond_poisson, p->material[m].name, p->material[m].nu);
}

/* B / C_t of a beam: Euler and Bernoulli 1; with shear, phi = 12 EI / (k G A r^2), 1 + phi; Chen's 4 C_M - 3
 * C_t (theory G1) */
static void read_beams (pg_problem *p, const pg_scene *scene, const pg_sum_rule *rule)
{
    static const char *const only[] = { "method.shear_parameter", "method.cm_ratio" }, *const of[] = {
        "timoshenko", "chen"
    };
    if (p->mode == PG_LINE)
        pg_scene_fault (scene, "method.force",
                        "gmpd has no meaning in one dimension, where bonds bear no shear: use force: bond");
    if (rule->finite)
        pg_scene_fault (
            scene, "method.stretch",
            "force: gmpd is linear in displacement and rotation: use stretch: linear, or force: bond");
    if (rule->evaluation == PG_EVALUATE_FFT)
        pg_scene_fault (scene, "method.evaluation",
                        "bonds that bear shear have no sums by FFT: use auto, stencil or list");
    for (int k = 0; k < 2; k++)
        if (pg_scene_given (scene, "%s", only[k]) && !is (scene, "method.beam", of[k]))
            pg_scene_fault (scene, only[k], "is for method.beam: %s", of[k]);
    p->turns = pg_direct_turns (scene, p->dim);
    p->bending = is (scene, "method.beam", "timoshenko") ? 1 + pg_scene_number (scene, "%s", only[0])
               : is (scene, "method.beam", "chen") ? 4 * pg_scene_number (scene, "%s", only[1]) - 3 : 1;
    if (rule->state) check_volumetric (p, scene);
    else if (pg_scene_given (scene, "method.bond_poisson"))
        pg_scene_fault (scene, "method.bond_poisson", "is for method.volumetric: on");
    for (size_t m = 0; m < p->nmaterial && p->mode != PG_LINE; m++) {
        double nu = rule->state ? 0 : p->material[m].nu, most = pg_beam_poisson (p->mode);
        char path[120];
        snprintf (path, sizeof path, "materials.%.63s.poissons_ratio", p->material[m].name);
        double axial, shear;
        if (nu <= most + 1e-9
            && pg_beam_moduli (&axial, &shear, p->mode, rule->kernel, rule->horizon, p->material[m].modulus,
                               nu, p->cloud.thickness)
                   != PG_OK)
            pg_scene_fault (scene, "method.kernel", "%s", pg_last_error ());
        if (nu > most + 1e-9)
            pg_scene_fault (scene, path,
                            "%.6g is more than %.6g, the largest of micropolar bonds%s: their shear "
                            "stiffness would be negative and the body unstable; "
                            "use volumetric: on, which lets the dilatation bear the difference",
                            nu, most, p->mode == PG_PLANE_STRESS ? " in plane stress" : "");
    }
}

/* ---- sums ---------------------------------------------------------------------------------------------- */
static pg_status on_lattice (const pg_problem *p, int *yes)
{
    pg_sites sites = { 0 };
    pg_status status = pg_sites_build (&sites, &p->cloud, p->lattice.dim ? &p->lattice : NULL);
    *yes = status == PG_OK && sites.count[0] > 0;
    pg_sites_clear (&sites);
    return status;
}

pg_status pg_direct_build (pg_problem *p, const pg_scene *scene)
{
    pg_status status = PG_OK;
    pg_sum_rule rule;
    int lattice;
    char why[256];
    p->integration = pg_integration_find ("nodal");
    refuse_tangents (p, scene);
    PG_TRY (pg_scene_verdict (scene));
    PG_TRY (on_lattice (p, &lattice));
    pg_direct_rule (&rule, scene, p->mode, &p->approx, p->cloud.h, lattice);
    if (rule.beams) read_beams (p, scene, &rule);
    else if (rule.state) check_state (p, scene, &rule);
    else take_poisson (p);
    if (!lattice && rule.partial == PG_PARTIAL_OVERLAP)
        pg_scene_fault (
            scene, "method.partial_volume",
            "overlap needs the cells of a lattice, and these points lie on none: use linear or none");
    /* one weight for all bonds of an offset */
    int alike = rule.evaluation == PG_EVALUATE_STENCIL || rule.evaluation == PG_EVALUATE_FFT;
    if (!lattice && alike)
        pg_scene_fault (scene, "method.evaluation",
                        "%s a lattice, and these points lie on none: use list or auto",
                        rule.evaluation == PG_EVALUATE_FFT ? "transforms need" : "a stencil needs");
    if (rule.finite && rule.evaluation == PG_EVALUATE_FFT)
        pg_scene_fault (scene, "method.evaluation",
                        "with stretch: finite forces are not linear in the displacement, and fft sums linear "
                        "ones: use stencil, list or auto");
    if (rule.surface == PG_SURFACE_VOLUME && alike)
        pg_scene_fault (
            scene, "method.evaluation",
            "with surface_correction: volume every bond has a weight of its own: use list or auto");
    PG_TRY (pg_scene_verdict (scene));
    rule.threads = p->threads;
    status = pg_sums_create (&p->sums, &rule, &p->cloud, p->lattice.dim ? &p->lattice : NULL);
    if (status == PG_E_USAGE) {  /* these points, this horizon: the scene's, not the caller's */
        snprintf (why, sizeof why, "%s", pg_last_error ());
        pg_scene_fault (scene, "method.force", "%s: %s", p->force, why);
        PG_TRY (pg_scene_verdict (scene));
    }
done:
    return status;
}

void pg_direct_check_laws (const pg_problem *p, const pg_scene *scene)
{
    pg_evaluation asked = p->sums->rule.evaluation;
    for (size_t m = 1; m < p->nmaterial && asked != PG_EVALUATE_AUTO && asked != PG_EVALUATE_LIST; m++) {
        const pg_criterion *a = &p->criterion[0], *b = &p->criterion[m];
        int at_points = a->type && (a->type->needs & PG_NEEDS_ENERGY);  /* the loops know of no limit */
        int alike = (p->sums->rule.state && !p->turns) /* whose loops know each point's constants */
                    || (p->material[m].modulus == p->material[0].modulus
                        && (!p->turns || p->material[m].nu == p->material[0].nu));
        int same = alike
                   && (at_points
                       || (a->never == b->never
                           && memcmp (a->parameter, b->parameter, sizeof a->parameter) == 0));
        if (same) continue;
        pg_scene_fault (scene, "method.evaluation",
                        "materials %.40s and %.40s differ in stiffness or limit, and bonds must all be alike "
                        "for this: use list or auto",
                        p->material[0].name, p->material[m].name);
        return;
    }
}

pg_status pg_direct_bonds (pg_problem *p)
{
    pg_status status = PG_OK;
    pg_rows *r = &p->rows[PG_NODES];
    size_t n = p->cloud.n, dim = (size_t) p->dim;
    *r = (pg_rows) { .dim = p->dim, .n = n };
    PG_ALLOC (r->x, n * dim);
    PG_ALLOC (r->weight, n);
    PG_ALLOC (r->own, n);
    PG_ALLOC (r->cell, n);
    memcpy (r->x, p->cloud.x, n * dim * sizeof *r->x);
    memcpy (r->weight, p->cloud.volume, n * sizeof *r->weight);
    for (size_t i = 0; i < n; i++) r->own[i] = (int) i, r->cell[i] = -1;
    PG_TRY (pg_sums_family (&r->family, p->sums));
    for (int s = PG_POINTS; s < PG_BOND_SETS; s++)
        PG_TRY (pg_rows_create (&p->rows[s], &p->approx, &p->cloud, 0, NULL, NULL, NULL, NULL));
    PG_ALLOC (p->facet_normal, 0);
done:
    return status;
}

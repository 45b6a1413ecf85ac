/* SPDX-License-Identifier: GPL-3.0-or-later
 * Generalised micropolar peridynamics as an entry of the catalogue: its keys, what it needs and refuses, the
 * energies from which failure criteria derive their constants. */
#include "micropolar.h"
#include <math.h>
#include <string.h>

static const char *const no_choice = NULL;
static const pg_key keys[] = {
    { "method.beam", PG_NAME, NULL, NULL, "euler", "euler|timoshenko|chen", NULL, NULL,
      "Bending stiffness of bonds, which sets a length of the order of the horizon and no modulus: "
      "euler: as Euler and Bernoulli's beam; timoshenko: "
      "(1 + shear_parameter) of that; chen: 4 cm_ratio - 3 of that, none as published." },
    { "method.shear_parameter", PG_NUMBER, "1", "[0, inf)", "1", NULL, NULL, NULL,
      "With beam: timoshenko, 12 EI / (k G A r^2), the same for every bond." },
    { "method.cm_ratio", PG_NUMBER, "1", "[0.75, inf)", "0.75", NULL, NULL, NULL,
      "With beam: chen, C_M / C_t; below 0.75 a bond would not be stable." },
    { "method.volumetric", PG_BOOL, NULL, NULL, "off", no_choice, NULL, NULL,
      "An energy of the dilatation beside that of the bonds (state-based, with weighted_volume), so "
      "that Poisson's ratio is free: off: bonds alone, up to "
      "1/4 (plane stress 1/3)." },
    { "method.bond_poisson", PG_NUMBER, "1", "(-1, 0.5)", "", no_choice, NULL, NULL,
      "With volumetric: on, Poisson's ratio of what the bonds alone make, at most the material's and 1/4 "
      "(plane stress 1/3, where bonds bear no shear and points have no rotations); default 0.2 (plane stress "
      "0.25), where a lattice is nearest to isotropic, or the material's if that is less." },
};
static const pg_key_table own_keys = { "force", keys, sizeof keys / sizeof *keys };

/* Is the text of a key, which may be missing, this word? */
static int is (const pg_scene *scene, const char *key, const char *word)
{
    const char *text = pg_scene_text (scene, "%s", key);
    return text && strcmp (text, word) == 0;
}

/* 1: forces couple neighbours of neighbours, by dilatations, so that there is no matrix. */
static int long_range (const pg_scene *scene) { return pg_scene_bool (scene, "method.volumetric"); }

/* The rule of bonds as beams; with volumetric: on also that of a dilatation. */
static void rule (pg_sum_rule *out, const pg_scene *scene, pg_mode mode, const pg_approx *approx,
                  double spacing,
                  int lattice)
{
    bond_force_rule (out, scene, mode, approx, spacing, lattice);
    out->beams = 1;
    if (long_range (scene)) bond_force_rule_with_dilatation (out, scene);
}

/* Reads and checks method.bond_poisson: it may not exceed the largest Poisson's ratio of micropolar bonds,
 * nor that of the material, as the dilatation would have negative energy. */
static void check_volumetric (const pg_problem *p, micropolar_options *o, const pg_scene *scene)
{
    static const char key[] = "method.bond_poisson";
    double most = pg_beam_poisson (p->mode);
    bond_force_refuse_matrix (p, scene, " with volumetric: on");
    o->bond_poisson = pg_scene_given (scene, key) ? pg_scene_number (scene, key) : NAN;
    if (o->bond_poisson > most + 1e-9)
        pg_scene_fault (scene, key, "%.6g is more than %.6g, the largest of micropolar bonds%s",
                        o->bond_poisson, most, p->mode == PG_PLANE_STRESS ? " in plane stress" : "");
    for (size_t m = 0; m < p->nmaterial; m++)
        if (o->bond_poisson > p->material[m].nu)
            pg_scene_fault (scene, key,
                            "%.6g is more than that of material %.63s, %.6g: less energy of dilatation than "
                            "none; choose at most that",
                            o->bond_poisson, p->material[m].name, p->material[m].nu);
}

/* Beams of negative shear stiffness would make the body unstable: Poisson's ratio has a largest value
 * (pg_beam_poisson), beyond which a dilatation beside them must bear the rest. Kernels that make the
 * shear of short bonds unbounded are refused too. */
static void check_materials (const pg_problem *p, const pg_scene *scene, const pg_sum_rule *rule)
{
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

/* Reads bending over shear stiffness, B / C_t: 1 for Euler and Bernoulli's beam, 1 + phi with shear, phi = 12
 * EI / (k G A r^2), and 4 C_M / C_t - 3 for Chen's (theory G1). Keys of another beam, and what beams cannot
 * do, are faults. */
static void read_beams (pg_problem *p, const pg_scene *scene, const pg_sum_rule *rule)
{
    micropolar_options *o = p->options;
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
    o->bending = is (scene, "method.beam", "timoshenko") ? 1 + pg_scene_number (scene, "%s", only[0])
               : is (scene, "method.beam", "chen") ? 4 * pg_scene_number (scene, "%s", only[1]) - 3 : 1;
    if (rule->state) check_volumetric (p, o, scene);
    else if (pg_scene_given (scene, "method.bond_poisson"))
        pg_scene_fault (scene, "method.bond_poisson", "is for method.volumetric: on");
    check_materials (p, scene, rule);
}

/* Makes the options first, as the checks of the rule (read_beams) fill them in. */
static pg_status read (pg_problem *p, const pg_scene *scene)
{
    pg_status status = PG_OK;
    micropolar_options *o = NULL;
    PG_ALLOC (o, 1);
    *o = (micropolar_options) { .bond_poisson = NAN };
    p->options = o;
    if (!long_range (scene) && pg_scene_given (scene, "method.weighted_volume"))
        pg_problem_note (p, "ignored with volumetric: off: weighted_volume of method");
    PG_TRY (bond_force_read (p, scene, read_beams));
done:
    return status;
}

/* ---- criteria and loads -------------------------------------------------------------------------------- */
/* Energies of a straight cut, J/m^2, with all bonds across it at s = 1, at gamma = 1, and at kappa = 1:
 * limits follow from fracture energies by these three. */
static pg_status measure_beams (double *out, const pg_problem *p, double axial, double shear)
{
    pg_status status = PG_OK;
    pg_beam_sums sums;
    PG_TRY (pg_beam_measure (&sums, p->sums));
    out[0] = 0.5 * p->sums->calibration * axial * sums.along;
    out[1] = 6 * sums.calibration * shear * sums.across;
    const micropolar_options *o = p->options;
    out[2] = 0.5 * o->bending * sums.calibration * shear * sums.across;
done:
    return status;
}

/* Fills in energies of a straight cut by stretch (with the share of the dilatation), by shear and by
 * bending. */
static pg_status limits (const pg_problem *p, size_t material, pg_criterion_setting *s)
{
    pg_status status = PG_OK;
    const pg_material *m = &p->material[material];
    const pg_kernel *kernel = p->form.approx.kernel;
    double axial, shear, E, nu, dilation, beside, h = p->form.approx.horizon, t = p->cloud.thickness;
    PG_TRY (bond_force_limits (p, material, s));
    micropolar_split (p, &p->material[material], &E, &nu, &dilation);
    PG_TRY (pg_beam_moduli (&axial, &shear, p->mode, kernel, h, E, nu, t));
    PG_TRY (measure_beams (s->beam, p, axial, shear));
    beside = pg_beam_cut_dilatation (p->sums, dilation) / s->beam[0];
    s->beam[0] *= 1 + beside;
    s->toughness = (s->toughness > 0 ? s->toughness : 1) * (1 + beside);
    s->modulus = m->modulus * axial / pg_bond_modulus (p->mode, kernel, h, m->modulus, t);
done:
    return status;
}

/* Do the bonds of a material bear shear? Their shear stiffness vanishes at the largest Poisson's ratio. */
static int bears_shear (const pg_problem *p, int material)
{
    double E, nu, dilation;
    micropolar_split (p, &p->material[material], &E, &nu, &dilation);
    return fabs (nu - pg_beam_poisson (p->mode)) > 1e-9;
}

/* Reports moments on points whose bonds bear no shear, as nothing resists their rotations. Called once every
 * point has its material. */
static void check_moments (const pg_problem *p, const pg_scene *scene)
{
    const int *material = p->block[PG_NODES];
    char path[64];
    for (size_t i = 0; i < p->boundary.nload; i++) {
        const pg_set *set = p->boundary.load[i].set;
        size_t k = 0;
        if (p->boundary.load[i].kind != PG_MOMENT) continue;
        while (k < set->npoint && bears_shear (p, material[set->point[k]])) k++;
        if (k == set->npoint) continue;
        snprintf (path, sizeof path, "boundary[%zu].moment", i);
        pg_scene_fault (scene, path,
                        "material %.40s: at a Poisson's ratio of %.6g its bonds bear no shear, and nothing "
                        "resists rotations: use a smaller one, or forces",
                        p->material[material[set->point[k]]].name, pg_beam_poisson (p->mode));
    }
}

/* Measured as in bond_force_tip_offset: 0.36 spacings at Poisson's ratios of 0.1 and 0.25 and horizons of 3
 * and 5 spacings. */
static double tip_offset (const pg_problem *p)
{
    (void) p;
    return 0.36;
}

const pg_force_type pg_force_gmpd = {
    .method = { .name = "gmpd",
                .summary = "micropolar peridynamics: bonds as beams, points with rotations "
                           "(Chen et al. 2022)",
                .keys = { &bond_force_keys, &state_based_keys, &own_keys },
                .rotations = { 0, 0, 1, 3 },
                .shows = PG_NEEDS_STRETCH | PG_NEEDS_BEAMS | PG_NEEDS_FACETS,
                .tip_offset = tip_offset,
                .judged_by = PG_NEEDS_BEAMS,
                .long_range = long_range,
                .rule = rule,
                .read = read,
                .limits = limits,
                .check_points = check_moments,
                .ghosts = 2,
                BOND_FORCE_METHOD },
    .create = micropolar_create,
    BOND_FORCE_ENTRIES
};

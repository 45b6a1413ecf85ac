/* SPDX-License-Identifier: GPL-3.0-or-later
 * Constants and limits of bonds from E, nu, G0 and horizon: those of theory, or those that a scene uses on a
 * square or cubic lattice, which follow from sums over a block of points that is wide enough for one whole
 * family. */
#include "perigal/session.h"
#include <math.h>
#include <string.h>

static int dimension_of (pg_mode mode) { return mode == PG_LINE ? 1 : mode == PG_SOLID ? 3 : 2; }

/* The default kernel of bond forces: the first in the catalogue that is not zero at the horizon. */
static const pg_kernel *usual_kernel (void)
{
    size_t i = 0;
    while (pg_kernel_entry (i) && !pg_kernel_entry (i)->closed) i++;
    return pg_kernel_entry (i);
}

static pg_status check (const pg_bond_choice *c, const pg_kernel *kernel)
{
    pg_status status = PG_OK;
    const struct { const char *what; double value; } above[] = {
        { "the horizon", c->horizon }, { "Young's modulus", c->modulus }, { "the thickness", c->thickness }
    };
    if (!kernel) PG_FAIL (PG_E_USAGE, "there is no kernel '%s': %s", c->kernel, pg_kernel_names ());
    for (size_t k = 0; k < sizeof above / sizeof *above; k++)
        if (!(above[k].value > 0) || !isfinite (above[k].value))
            PG_FAIL (PG_E_USAGE, "%s is %g: it must be above 0", above[k].what, above[k].value);
    if (!(c->poisson > -1) || !(c->poisson < 0.5))
        PG_FAIL (PG_E_USAGE, "Poisson's ratio is %g: it must lie between -1 and 0.5", c->poisson);
    if (!(c->fracture_energy >= 0) || !isfinite (c->fracture_energy))
        PG_FAIL (PG_E_USAGE, "the fracture energy is %g J/m2: it must be above 0", c->fracture_energy);
    if (!(c->spacing >= 0) || !(c->spacing <= c->horizon * (1 + 1e-9)))
        PG_FAIL (PG_E_USAGE, "the spacing is %g m: it must be above 0 and at most the horizon, %g m",
                 c->spacing, c->horizon);
    if (c->spacing > 0 && c->horizon > 20 * c->spacing)
        PG_FAIL (PG_E_USAGE,
                 "a horizon of %g spacings is too large for constants of a lattice: leave out the spacing",
                 c->horizon / c->spacing);
done:
    return status;
}

/* A block of lattice points, so wide that the one in its middle has its whole family. */
static pg_status make_block (pg_cloud *out, int dim, double horizon, double h, double thickness)
{
    pg_status status = PG_OK;
    size_t reach = (size_t) ceil (horizon / h) + 1, edge = 2 * reach + 1, n = 1;
    double *x = NULL;
    for (int k = 0; k < dim; k++) n *= edge;
    PG_ALLOC (x, n * (size_t) dim);
    for (size_t i = 0, rest = 0; i < n; i++) {
        rest = i;
        for (int k = 0; k < dim; k++, rest /= edge)
            x[i * (size_t) dim + (size_t) k] = h * (double) (rest % edge);
    }
    PG_TRY (pg_cloud_of_arrays (out, dim, n, x, NULL, h, thickness));
done:
    pg_free (x);
    return status;
}

/* 1: Poisson's ratio and kernel allow for micropolar bonds; axial and shear are their moduli then. */
static int has_beams (const pg_bond_choice *c, const pg_kernel *kernel, double *axial, double *shear)
{
    return c->mode != PG_LINE && c->poisson <= pg_beam_poisson (c->mode) + 1e-9
           && pg_beam_moduli (axial, shear, c->mode, kernel, c->horizon, c->modulus, c->poisson, c->thickness)
                  == PG_OK;
}

/* Corrections of the constants of theory by sums over bonds: factor of the micromodulus; energies of a
 * straight crack over those of theory (bond-based, state-based); energy of a crack that grows bond by bond
 * over that of a straight cut, NAN if unknown; sums of micropolar bonds. */
typedef struct {
    double calibration, toughness, state_toughness, growth;
    pg_beam_sums beams;
} factors;

/* Measures the factors on a lattice, with partial volumes as bond_force_rule chooses them there. */
static pg_status measure (factors *f, const pg_bond_choice *c, const pg_kernel *kernel)
{
    pg_status status = PG_OK;
    pg_cloud block = { 0 };
    pg_sums *sums[3] = { NULL };
    double axial, shear;
    pg_sum_rule rule = { .mode = c->mode, .kernel = kernel, .horizon = c->horizon, .calibrate = 1 };
    rule.partial = !kernel->closed && c->mode != PG_SOLID ? PG_PARTIAL_NONE : PG_PARTIAL_OVERLAP;
    PG_TRY (make_block (&block, dimension_of (c->mode), c->horizon, c->spacing, c->thickness));
    PG_TRY (pg_sums_create (&sums[0], &rule, &block, NULL));
    f->calibration = sums[0]->calibration, f->toughness = pg_sums_toughness (sums[0], c->modulus, c->poisson);
    f->growth = pg_sums_growth (sums[0]).mean > 0 ? pg_sums_growth (sums[0]).mean : NAN;
    rule.state = 1;
    if (c->mode != PG_LINE) {
        PG_TRY (pg_sums_create (&sums[1], &rule, &block, NULL));
        f->state_toughness = pg_sums_toughness (sums[1], c->modulus, c->poisson);
    }
    if (has_beams (c, kernel, &axial, &shear)) {
        rule.state = 0, rule.beams = 1;
        PG_TRY (pg_sums_create (&sums[2], &rule, &block, NULL));
        PG_TRY (pg_beam_measure (&f->beams, sums[2]));
    }
done:
    for (int k = 0; k < 3; k++) pg_sums_free (&sums[k]);
    pg_cloud_clear (&block);
    return status;
}

/* Finds the factors of theory: the sums of an uncalibrated rule give the straight crack of theory, whatever
 * the points. */
static pg_status of_theory (factors *f, const pg_bond_choice *c, const pg_kernel *kernel)
{
    pg_status status = PG_OK;
    pg_cloud block = { 0 };
    pg_sums *sums = NULL;
    pg_sum_rule rule = { .mode = c->mode, .kernel = kernel, .horizon = c->horizon, .beams = 1 };
    double axial, shear;
    if (!has_beams (c, kernel, &axial, &shear)) return PG_OK;
    PG_TRY (make_block (&block, dimension_of (c->mode), c->horizon, c->horizon, c->thickness));
    PG_TRY (pg_sums_create (&sums, &rule, &block, NULL));
    PG_TRY (pg_beam_measure (&f->beams, sums));
done:
    pg_sums_free (&sums);
    pg_cloud_clear (&block);
    return status;
}

/* Micromodulus, critical stretches and energy of the bond-based and the state-based model. */
static void find_stretches (pg_bond_constants *out, const pg_bond_choice *c, const pg_kernel *kernel,
                            const factors *f)
{
    double G0 = c->fracture_energy;
    pg_criterion_setting s = { .mode = c->mode, .horizon = c->horizon, .modulus = c->modulus,
                               .poisson = c->poisson, .thickness = c->thickness, .kernel = kernel->name,
                               .toughness = f->toughness };
    out->bond_poisson = pg_bond_poisson (c->mode);
    out->micromodulus = f->calibration
                        * pg_bond_modulus (c->mode, kernel, c->horizon, c->modulus, c->thickness);
    out->calibration = f->calibration, out->toughness = f->toughness, out->growth = f->growth;
    out->stretch = G0 > 0 ? pg_stretch_from_energy (&s, G0) : NAN;
    pg_state_moduli (c->mode, c->modulus, c->poisson, &out->dilation, &out->deviation);
    s.state = 1, s.toughness = f->state_toughness;
    out->state_stretch = G0 > 0 ? pg_stretch_from_energy (&s, G0) : NAN;
    out->energy = G0 > 0 ? 0.5 * G0 / c->horizon : NAN;
}

/* Finds the constants of micropolar bonds; NAN where Poisson's ratio or kernel does not allow for them. */
static void find_beams (pg_bond_constants *out, const pg_bond_choice *c, const pg_kernel *kernel,
                        const factors *f)
{
    double G0 = c->fracture_energy, axial, shear;
    out->beam_poisson = out->axial = out->shear = out->bending = NAN;
    for (int k = 0; k < 3; k++) out->beam_limit[k] = NAN;
    if (c->mode == PG_LINE) return;
    out->beam_poisson = pg_beam_poisson (c->mode);
    if (!has_beams (c, kernel, &axial, &shear)) return;
    out->axial = f->calibration * axial;
    out->shear = out->bending = f->beams.calibration * shear;
    const double cut[3] = { 0.5 * out->axial * f->beams.along, 6 * out->shear * f->beams.across,
                            0.5 * out->bending * f->beams.across };
    for (int k = 0; k < 3 && G0 > 0; k++) out->beam_limit[k] = cut[k] > 0 ? sqrt (G0 / cut[k]) : INFINITY;
}

pg_status pg_bond_constants_find (pg_bond_constants *out, const pg_bond_choice *choice)
{
    pg_status status = PG_OK;
    const pg_kernel *kernel = choice->kernel ? pg_kernel_find (choice->kernel) : usual_kernel ();
    factors f = { .calibration = 1, .toughness = 1, .state_toughness = 1, .growth = NAN };
    memset (out, 0, sizeof *out);
    PG_TRY (check (choice, kernel));
    if (choice->spacing > 0) PG_TRY (measure (&f, choice, kernel));
    else PG_TRY (of_theory (&f, choice, kernel));
    find_stretches (out, choice, kernel, &f);
    find_beams (out, choice, kernel, &f);
done:
    return status;
}

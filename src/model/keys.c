/* SPDX-License-Identifier: GPL-3.0-or-later
 * Keys of the model: method (what the approximation folder does not bring), boundary, gauges. */
#include "perigal/scene.h"
#include "perigal/integration.h"

static const char *const no_choice = NULL;
#define LOAD_COMPONENT(name, unit, axis, what) \
    { "boundary[]." name "." axis, PG_EXPRESSION, unit, NULL, "", no_choice, NULL, NULL, what }
#define LOAD(name, unit, what) \
    { "boundary[]." name, PG_MAP, NULL, NULL, "", no_choice, NULL, "load:one", what }, \
    LOAD_COMPONENT (name, unit, "x", "Component along x; absent: free (supports) or zero (loads)."), \
    LOAD_COMPONENT (name, unit, "y", "Component along y."), \
    LOAD_COMPONENT (name, unit, "z", "Component along z.")

static const pg_key keys[] = {
    { "method.force", PG_NAME, NULL, NULL, "galerkin", "galerkin|bond|fcbm|lps|gmpd", NULL, NULL,
      "How bonds make forces: galerkin: weak form with the shape functions of method.approximation; bond: "
      "pair forces between points (bond-based "
      "peridynamics; Poisson's ratio is 1/3 in plane stress, 1/4 in plane strain and 3D); fcbm: bond summed "
      "by fft unless method.evaluation, whose points die by energy unless failure.criterion says "
      "otherwise; lps: forces that depend on the dilatation of both points as well (ordinary state-based: "
      "linear peridynamic solid, any Poisson's ratio); "
      "gmpd: bonds as beams between points that turn (micropolar; Poisson's ratio up to that of bond, or any "
      "with volumetric: on)." },
    { "method.weighted_volume", PG_NAME, NULL, NULL, "intact", "intact|live", NULL, NULL,
      "lps, gmpd with volumetric: on: the weighted volume q of a point, which its dilatation and forces are "
      "divided by: intact: of the bonds that no pre-crack cuts, for good; live: of the "
      "bonds that live, so that what is left of a family carries on as if it had never had more (stiffer "
      "near new cracks; small time steps)." },
    { "method.beam", PG_NAME, NULL, NULL, "euler", "euler|timoshenko|chen", NULL, NULL,
      "gmpd: bending stiffness of bonds, which sets a length of the order of the horizon and no modulus: "
      "euler: as Euler and Bernoulli's beam; timoshenko: "
      "(1 + shear_parameter) of that; chen: 4 cm_ratio - 3 of that, none as published." },
    { "method.shear_parameter", PG_NUMBER, "1", "[0, inf)", "1", NULL, NULL, NULL,
      "gmpd, beam timoshenko: 12 EI / (k G A r^2), the same for every bond." },
    { "method.cm_ratio", PG_NUMBER, "1", "[0.75, inf)", "0.75", NULL, NULL, NULL,
      "gmpd, beam chen: C_M / C_t; below 0.75 a bond would not be stable." },
    { "method.volumetric", PG_BOOL, NULL, NULL, "off", no_choice, NULL, NULL,
      "gmpd: an energy of the dilatation beside that of the bonds (state-based, with weighted_volume), so "
      "that Poisson's ratio is free: off: bonds alone, up to "
      "1/4 (plane stress 1/3)." },
    { "method.bond_poisson", PG_NUMBER, "1", "(-1, 0.5)", "", no_choice, NULL, NULL,
      "gmpd, volumetric: on: Poisson's ratio of what the bonds alone make, at most the material's and 1/4 "
      "(plane stress 1/3, where bonds bear no shear "
      "and points do not turn); default 0.2 (plane stress 0.25), where a lattice is nearest to isotropic, or "
      "the material's if that is less." },
    { "method.evaluation", PG_NAME, NULL, NULL, "auto", "auto|stencil|list|fft", NULL, NULL,
      "bond: by the stencil of a lattice, by lists of neighbours, or by fast Fourier transforms (a lattice, "
      "linear stretch); the answer is the same, auto "
      "takes what is faster for so many points and bonds." },
    { "method.partial_volume", PG_NAME, NULL, NULL, "auto", "auto|none|linear|overlap", NULL, NULL,
      "bond: share of a neighbour's volume that counts: none: all or nothing; linear: falls over one spacing "
      "at the horizon; overlap: of its cell and the "
      "ball; auto: overlap on a lattice (none for a kernel that is zero at the horizon, except in 3D), else "
      "linear." },
    { "method.calibrate", PG_BOOL, NULL, NULL, "on", no_choice, NULL, NULL,
      "bond: the force constant is scaled so that the energy of hydrostatic strain is exact on this lattice, "
      "and a critical stretch that comes from "
      "fracture_energy so that a straight crack along the lattice consumes it." },
    { "method.surface_correction", PG_NAME, NULL, NULL, "auto", "auto|none|product|volume", NULL, NULL,
      "bond: stiffens bonds of points near the surface, whose families are not whole; auto: none below a "
      "horizon of 4 spacings (there it does harm), else product." },
    { "method.stretch", PG_NAME, NULL, NULL, "linear", "linear|finite", NULL, NULL,
      "bond: force from the stretch along the undeformed bond (small displacements), or from the deformed "
      "length along the deformed bond (verlet, central, "
      "adr, relax only)." },
    { "method.integration", PG_NAME, NULL, NULL, "gauss", NULL, pg_integration_names, NULL,
      "Where the weak form is evaluated." },
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
    { "method.accept_inexact", PG_BOOL, NULL, NULL, "off", no_choice, NULL, NULL,
      "Run although the patch test of the discretisation, which every run makes, is off by more than 50 % "
      "(report.json: patch_error)." },
    { "blocks", PG_LIST, NULL, NULL, "", NULL, NULL, NULL,
      "Which part is made of which material; needed with several materials. A later entry wins; every point "
      "needs one." },
    { "blocks[].material", PG_NAME, NULL, NULL, NULL, "materials.{}", NULL, NULL, "One of materials." },
    { "blocks[].where", PG_EXPRESSION, "bool", NULL, "", no_choice, NULL, "claim:one",
      "Where this condition in x, y, z, r, angle holds: at nodes and at integration points, each for "
      "itself." },
    { "blocks[].block", PG_TEXT, NULL, NULL, "", no_choice, NULL, "claim:one",
      "Points of this block number of the points' file; of a mesh: of this block, by name or number." },
    { "boundary", PG_LIST, NULL, NULL, "", NULL, NULL, NULL, "Loads and supports." },
    { "boundary[].name", PG_TEXT, NULL, NULL, "", NULL, NULL, NULL,
      "Name in history.csv; default: the set's name." },
    { "boundary[].set", PG_NAME, NULL, NULL, NULL, "sets.{}|left|right|bottom|top|back|front|all", NULL, NULL,
      "Where it acts: a set, a part of one (platens.top) or of a shape (disk.rim, polygon.edge 3), or left, "
      "right, bottom, top, back, front, all." },
    LOAD ("displacement", "m", "Prescribed displacement."),
    LOAD ("velocity", "m/s", "Prescribed velocity (newmark, verlet, central)."),
    LOAD ("rotation", "rad", "gmpd: prescribed rotation (2D: z)."),
    LOAD ("moment", "N m", "gmpd: total moment, shared equally by the points of the set (2D: z)."),
    LOAD ("traction", "Pa", "Force per area on boundary facets."),
    LOAD ("force", "N", "Total force, shared equally by the points of the set."),
    LOAD ("body_force", "N/m3", "Force per volume; set all: everywhere, else on the points of the set."),
    { "boundary[].pressure", PG_EXPRESSION, "Pa", NULL, "", NULL, NULL, "load:one",
      "Pressure against the boundary facets (positive pushes inwards)." },
    { "boundary[].depth", PG_NUMBER, "m|spacing", "(0, inf)", "", no_choice, NULL, NULL,
      "Traction, pressure with force: bond: shared, by volume, by the points down to this depth below each "
      "facet, at most all of the body; unless given by the outermost points." },
    { "boundary[].essential", PG_NAME, NULL, NULL, "", "auto|nitsche|transformation|penalty", NULL, NULL,
      "How this displacement or velocity is prescribed; method.essential unless given. penalty: cheapest for "
      "a point that only keeps the body from moving." },
    { "boundary[].ramp", PG_TEXT, NULL, NULL, "", NULL, NULL, "ramp:most",
      "Factor over time: linear (0 to 1 over the run), constant, or an expression in t; default linear, for "
      "velocity constant." },
    { "boundary[].table", PG_LIST, NULL, NULL, "", NULL, NULL, "ramp:most",
      "Factor over time as pairs [t, factor], linear between, constant beyond." },
    { "boundary[].table[]", PG_NUMBERS, NULL, NULL, "", NULL, NULL, NULL,
      "One pair: t in s (static: load factor 0 to 1), factor." },
    { "initial.velocity", PG_MAP, NULL, NULL, "", no_choice, NULL, NULL,
      "Velocity of every point at the start of a dynamic run, at rest unless given; supports have their own; "
      "points that turn (gmpd) turn with half its curl. Not with force: galerkin so far." },
    { "initial.velocity.x", PG_EXPRESSION, "m/s", NULL, "", no_choice, NULL, NULL,
      "Component along x; absent: zero." },
    { "initial.velocity.y", PG_EXPRESSION, "m/s", NULL, "", no_choice, NULL, NULL, "Component along y." },
    { "initial.velocity.z", PG_EXPRESSION, "m/s", NULL, "", no_choice, NULL, NULL, "Component along z." },
    { "output.gauges", PG_LIST, NULL, NULL, "", NULL, NULL, NULL,
      "Pairs of places whose opening is recorded." },
    { "output.gauges[].name", PG_TEXT, NULL, NULL, NULL, NULL, NULL, NULL, "Column name in history.csv." },
    { "output.gauges[].from", PG_VECTOR, "m", NULL, NULL, NULL, NULL, NULL, "First place." },
    { "output.gauges[].to", PG_VECTOR, "m", NULL, NULL, NULL, NULL, NULL,
      "Second place; the record is the change of their distance along the line." },
};
const pg_key_table pg_keys_model = { "model", keys, sizeof keys / sizeof *keys };

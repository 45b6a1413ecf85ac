/* SPDX-License-Identifier: GPL-3.0-or-later
 * Keys of the model: blocks, boundary, platens, stages, initial, gauges. Those of `method` stand with the
 * forces that read them. */
#include "perigal/scene.h"

static const char *const no_choice = NULL;
#define LOAD_COMPONENT(name, unit, axis, what) \
    { "boundary[]." name "." axis, PG_EXPRESSION, unit, NULL, "", no_choice, NULL, NULL, what }
#define LOAD(name, unit, what) \
    { "boundary[]." name, PG_MAP, NULL, NULL, "", no_choice, NULL, "load:one", what }, \
    LOAD_COMPONENT (name, unit, "x", "Component along x; absent: free (supports) or zero (loads)."), \
    LOAD_COMPONENT (name, unit, "y", "Component along y."), \
    LOAD_COMPONENT (name, unit, "z", "Component along z.")

static const pg_key keys[] = {
    { "blocks", PG_LIST, NULL, "[0, 1000]", "", NULL, NULL, NULL,
      "Which part is made of which material; needed with several materials. A later entry wins; every point "
      "needs one." },
    { "blocks[].material", PG_NAME, NULL, NULL, NULL, "materials.{}", NULL, NULL, "One of materials." },
    { "blocks[].where", PG_EXPRESSION, "bool", NULL, "", no_choice, NULL, "claim:one",
      "Where this condition in x, y, z, r, angle holds: at nodes and at integration points, each for "
      "itself." },
    { "blocks[].block", PG_TEXT, NULL, NULL, "", no_choice, NULL, "claim:one",
      "Points of this block number of the points' file; of a mesh: of this block, by name or number." },
    { "boundary", PG_LIST, NULL, "[0, 1000]", "", NULL, NULL, NULL, "Loads and supports." },
    { "boundary[].name", PG_TEXT, NULL, NULL, "", NULL, NULL, NULL,
      "Name in history.csv; default: the set's name." },
    { "boundary[].set", PG_NAME, NULL, NULL, "", "sets.{}|left|right|bottom|top|back|front|all|cracks",
      NULL, NULL,
      "Where it acts: a set, a part of one (platens.top) or of a shape (disk.rim, polygon.edge 3), or left, "
      "right, bottom, top, back, front, all; cracks: a pressure on the faces of all cracks, also of those "
      "that "
      "come into being. Body forces and gravity without it act everywhere." },
    { "boundary[].at", PG_VECTOR, "m", NULL, "", no_choice, NULL, NULL,
      "Instead of a set: the place of a force or a spring. The points around it bear it in shares that "
      "have their "
      "sum and their centre there, so that resultant and moment are exact." },
    { "boundary[].about", PG_VECTOR, "m", NULL, "", no_choice, NULL, NULL,
      "Place that the moments of history.csv are about, and the axes of turn go through; the centre of the "
      "set if "
      "not given." },
    LOAD ("displacement", "m", "Prescribed displacement."),
    LOAD ("velocity", "m/s", "Prescribed velocity (newmark, verlet, central)."),
    LOAD ("rotation", "rad", "gmpd: prescribed rotation (2D: z)."),
    LOAD ("moment", "N m", "gmpd: total moment, shared equally by the points of the set (2D: z)."),
    LOAD ("traction", "Pa", "Force per area on boundary facets."),
    LOAD ("force", "N", "Total force: on a side, a part of a shape or a set with `boundary` evenly over its "
          "area, as a traction; on other sets in equal shares on their points."),
    LOAD ("body_force", "N/m3", "Force per volume; set all: everywhere, else on the points of the set."),
    { "boundary[].pressure", PG_EXPRESSION, "Pa", NULL, "", NULL, NULL, "load:one",
      "Pressure against the boundary facets (positive pushes inwards)." },
    { "boundary[].symmetry", PG_BOOL, NULL, NULL, "", no_choice, NULL, "load:one",
      "on: the set lies in a plane of symmetry across x, y or z, which its points do not leave (points with "
      "rotations turn about the normal alone)." },
    { "boundary[].gravity", PG_VECTOR, "m/s2", NULL, "", no_choice, NULL, "load:one",
      "Acceleration that gives the body its weight, by the density of its materials: [0, -9.81 m/s2]; "
      "without a "
      "set: of all of it." },
    LOAD ("turn", "rad",
          "The set turns as a rigid body about axes through `about` (by finite rotations with "
          "method.stretch: "
          "finite, else by small ones); displacements along an axis of its own stay free."),
    { "boundary[].temperature", PG_EXPRESSION, "K", NULL, "", no_choice, NULL, "load:one",
      "Change of temperature, everywhere: a free strain by materials.{}.expansion (force: galerkin; static "
      "with "
      "stepping: fixed, newmark)." },
    { "boundary[].shrinkage", PG_EXPRESSION, "1", NULL, "", no_choice, NULL, "load:one",
      "Free contraction, the same along all axes, everywhere (where and how as temperature)." },
    { "boundary[].pore_pressure", PG_EXPRESSION, "Pa", NULL, "", no_choice, NULL, "load:one",
      "Change of pore pressure, everywhere: takes materials.{}.biot times it off the mean stress (where "
      "and how as "
      "temperature; stresses of results are total ones)." },
    { "boundary[].spring", PG_MAP, NULL, NULL, "", no_choice, NULL, "load:one",
      "Springs that hold the set, or the place `at`: total stiffness, shared by its points (by their "
      "volumes)." },
    { "boundary[].spring.x", PG_NUMBER, "N/m", "(0, inf)", "", no_choice, NULL, NULL,
      "Stiffness along x; absent: no spring." },
    { "boundary[].spring.y", PG_NUMBER, "N/m", "(0, inf)", "", no_choice, NULL, NULL, "Stiffness along y." },
    { "boundary[].spring.z", PG_NUMBER, "N/m", "(0, inf)", "", no_choice, NULL, NULL, "Stiffness along z." },
    { "boundary[].spring.all", PG_NUMBER, "N/m", "(0, inf)", "", no_choice, NULL, NULL,
      "Stiffness along all axes that have none of their own." },
    { "boundary[].spring_end", PG_MAP, NULL, NULL, "", no_choice, NULL, NULL,
      "How far the other ends of the springs move (a testing machine that yields); they stand still if not "
      "given." },
    LOAD_COMPONENT ("spring_end", "m", "x", "Along x."), LOAD_COMPONENT ("spring_end", "m", "y", "Along y."),
    LOAD_COMPONENT ("spring_end", "m", "z", "Along z."),
    { "boundary[].depth", PG_NUMBER, "m|spacing", "(0, inf)", "", no_choice, NULL, NULL,
      "Traction, pressure with force: bond: shared, by volume, by the points down to this depth below each "
      "facet, at most all of the body; unless given by the outermost points." },
    { "boundary[].essential", PG_NAME, NULL, NULL, "", "auto|nitsche|transformation|penalty", NULL, NULL,
      "How this displacement or velocity is prescribed; method.essential unless given. penalty: cheapest "
      "for "
      "a point that only keeps the body from moving." },
    { "boundary[].ramp", PG_TEXT, NULL, NULL, "", NULL, NULL, "ramp:most",
      "Factor over time: linear (0 to 1 over the run), constant, or an expression in t; default linear, for "
      "velocity constant." },
    { "boundary[].table", PG_LIST, NULL, NULL, "", NULL, NULL, "ramp:most",
      "Factor over time as pairs [t, factor], linear between, constant beyond." },
    { "boundary[].table[]", PG_NUMBERS, NULL, NULL, "", NULL, NULL, NULL,
      "One pair: t in s (static: load factor 0 to 1), factor." },
    { "platens", PG_LIST, NULL, "[0, 100]", "", no_choice, NULL, NULL,
      "Rigid platens and indenters: what of the surface of the body comes to theirs is pressed, and rubbed, "
      "by them (force: galerkin, solver: static; forces of points, solver: verlet, central; elsewhere they "
      "are refused)." },
    { "platens[].name", PG_TEXT, NULL, NULL, NULL, NULL, NULL, NULL,
      "Name in history.csv and in stages[].boundary." },
    { "platens[].shape", PG_NAME, NULL, NULL, "plane", "plane|cylinder|sphere", NULL, NULL,
      "Its surface. A cylinder is a circle in the plane." },
    { "platens[].point", PG_VECTOR, "m", NULL, NULL, NULL, NULL, NULL,
      "plane: a place of it; else the centre, or a place of the axis. Moments are about this place." },
    { "platens[].normal", PG_VECTOR, "1", NULL, "", no_choice, NULL, NULL,
      "plane: direction from the platen towards the body, of any length." },
    { "platens[].axis", PG_VECTOR, "1", NULL, "", no_choice, NULL, NULL,
      "cylinder in space: direction of its axis." },
    { "platens[].radius", PG_NUMBER, "m", "(0, inf)", "", no_choice, NULL, NULL,
      "cylinder, sphere: radius." },
    { "platens[].width", PG_NUMBER, "m", "(0, inf)", "", no_choice, NULL, NULL,
      "plane: it is only so wide, half of it on either side of `point` (in space: a disk of this diameter); "
      "without end if not given." },
    { "platens[].concave", PG_BOOL, NULL, NULL, "false", no_choice, NULL, NULL,
      "cylinder, sphere: the body lies inside (curved jaws)." },
    { "platens[].friction", PG_NUMBER, "1", "[0, 10]", "0", no_choice, NULL, NULL,
      "Coulomb's coefficient: shear that the surface bears over the pressure on it." },
    { "platens[].displacement", PG_MAP, NULL, NULL, "", no_choice, NULL, NULL,
      "How far it moves; axes that have neither a displacement nor a force are held." },
    { "platens[].displacement.x", PG_EXPRESSION, "m", NULL, "", no_choice, NULL, NULL,
      "Component along x." },
    { "platens[].displacement.y", PG_EXPRESSION, "m", NULL, "", no_choice, NULL, NULL,
      "Component along y." },
    { "platens[].displacement.z", PG_EXPRESSION, "m", NULL, "", no_choice, NULL, NULL,
      "Component along z." },
    { "platens[].force", PG_MAP, NULL, NULL, "", no_choice, NULL, NULL,
      "Force that presses it; it moves freely along these axes." },
    { "platens[].force.x", PG_EXPRESSION, "N", NULL, "", no_choice, NULL, NULL, "Component along x." },
    { "platens[].force.y", PG_EXPRESSION, "N", NULL, "", no_choice, NULL, NULL, "Component along y." },
    { "platens[].force.z", PG_EXPRESSION, "N", NULL, "", no_choice, NULL, NULL, "Component along z." },
    { "platens[].tilt", PG_NAME, NULL, NULL, "held", "held|free", NULL, NULL,
      "free: it turns about `point` until the moment of what it bears is zero there (a spherical seat)." },
    { "platens[].mass", PG_NUMBER, "kg", "[0, inf)", "0", no_choice, NULL, NULL,
      "solver: verlet, central: with a mass it moves by its forces along all axes on which it has no "
      "displacement (an impactor)." },
    { "platens[].velocity", PG_VECTOR, "m/s", NULL, "", no_choice, NULL, NULL,
      "Velocity at the start of a platen with a mass." },
    { "platens[].ramp", PG_TEXT, NULL, NULL, "linear", NULL, NULL, NULL,
      "Factor of its displacement over time: linear (from 0 to 1 over the run), constant, or an expression "
      "in t." },
    { "platens[].force_ramp", PG_TEXT, NULL, NULL, "linear", NULL, NULL, NULL,
      "The same of its force." },
    { "stages", PG_LIST, NULL, "[0, 1000]", "", NULL, NULL, NULL,
      "Stages of loading, one after the other: confine, load axially, unload ... Stage k runs from t = k - 1 "
      "to t = k (load_factor of history.csv). Without them all loads grow from 0 to 1 together." },
    { "stages[].name", PG_TEXT, NULL, NULL, NULL, NULL, NULL, NULL, "Name in report.json and in messages." },
    { "stages[].boundary", PG_MAP, NULL, NULL, "", NULL, NULL, NULL,
      "The loads and supports that move in this stage, by their names (boundary[].name). All start at 0; one "
      "that is not named stays as it is, and none named: a hold. Entries with ramp: constant act in full in "
      "all stages." },
    { "stages[].boundary.{}", PG_NUMBER, "1", NULL, "", NULL, NULL, NULL,
      "What the load is at the end of the stage, as a multiple of its value in boundary; it goes there in a "
      "straight line from what it was. 0: unloaded." },
    { "stages[].steps", PG_INTEGER, NULL, "[1, 100000000]", "", NULL, NULL, NULL,
      "Equal load steps of this stage, with stepping: fixed; solver.steps if not given." },
    { "stages[].remove", PG_NAME, NULL, NULL, "",
      "sets.{}|left|right|bottom|top|back|front", NULL, NULL,
      "A set whose points are taken out of the body (excavated): at the start of the stage what is left "
      "still bears the forces that they exerted on it, and these go to zero in a straight line along the "
      "stage." },
    { "stages[].until", PG_MAP, NULL, NULL, "", NULL, NULL, NULL,
      "What ends the stage early, whichever comes first; the loads then stay what they are. Looked at in "
      "states that bear their load: the first one that meets it ends the stage." },
    { "stages[].until.gauge", PG_TEXT, NULL, NULL, "", NULL, NULL, NULL,
      "A gauge (output.gauges) whose opening ends the stage; exactly there with stepping: event." },
    { "stages[].until.opening", PG_NUMBER, "m", NULL, "", NULL, NULL, NULL,
      "That opening, from either side; of a gauge that closes it is negative." },
    { "stages[].until.load", PG_TEXT, NULL, NULL, "", NULL, NULL, NULL,
      "A load or support (boundary[].name) whose force ends the stage." },
    { "stages[].until.drop", PG_NUMBER, "1", "(0, 1]", "", NULL, NULL, NULL,
      "That force has fallen by this share of its largest value in the stage: 20 %." },
    { "stages[].until.events", PG_INTEGER, NULL, "[1, 1000000000]", "", NULL, NULL, NULL,
      "So many events (stepping: fixed: load steps in which something broke) of this stage." },
    { "stages[].until.crack_length", PG_NUMBER, "m", "(0, inf)", "", NULL, NULL, NULL,
      "Cracks have grown by this length in the stage (facets in the plane)." },
    { "stages[].until.crack_area", PG_NUMBER, "m2", "(0, inf)", "", NULL, NULL, NULL,
      "Cracks have grown by this area in the stage (facets in space)." },
    { "initial.velocity", PG_MAP, NULL, NULL, "", no_choice, NULL, NULL,
      "Velocity of every point at the start of a dynamic run, at rest unless given; supports have their "
      "own; points with rotations (gmpd) rotate with half its curl. Not with force: galerkin so far." },
    { "initial.velocity.x", PG_EXPRESSION, "m/s", NULL, "", no_choice, NULL, NULL,
      "Component along x; absent: zero." },
    { "initial.velocity.y", PG_EXPRESSION, "m/s", NULL, "", no_choice, NULL, NULL, "Component along y." },
    { "initial.velocity.z", PG_EXPRESSION, "m/s", NULL, "", no_choice, NULL, NULL, "Component along z." },
    { "initial.sets", PG_LIST, NULL, "[0, 1000]", "", no_choice, NULL, NULL,
      "Velocities of sets of points at the start, instead of initial.velocity there: of bodies that "
      "collide." },
    { "initial.sets[].set", PG_NAME, NULL, NULL, NULL, "sets.{}|left|right|bottom|top|back|front|all", NULL,
      NULL, "The points; of several sets that hold a point the last one counts." },
    { "initial.sets[].velocity", PG_MAP, NULL, NULL, NULL, no_choice, NULL, NULL, "Their velocity." },
    { "initial.sets[].velocity.x", PG_EXPRESSION, "m/s", NULL, "", no_choice, NULL, NULL,
      "Component along x; absent: zero." },
    { "initial.sets[].velocity.y", PG_EXPRESSION, "m/s", NULL, "", no_choice, NULL, NULL,
      "Component along y." },
    { "initial.sets[].velocity.z", PG_EXPRESSION, "m/s", NULL, "", no_choice, NULL, NULL,
      "Component along z." },
    { "output.gauges", PG_LIST, NULL, "[0, 1000]", "", NULL, NULL, NULL,
      "Pairs of places whose opening is recorded." },
    { "output.gauges[].name", PG_TEXT, NULL, NULL, NULL, NULL, NULL, NULL, "Column name in history.csv." },
    { "output.gauges[].from", PG_VECTOR, "m", NULL, NULL, NULL, NULL, NULL, "First place." },
    { "output.gauges[].to", PG_VECTOR, "m", NULL, NULL, NULL, NULL, NULL,
      "Second place; the record is the change of their distance along the line." },
};
const pg_key_table pg_keys_model = { "model", keys, sizeof keys / sizeof *keys };

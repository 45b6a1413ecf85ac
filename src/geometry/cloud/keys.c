/* SPDX-License-Identifier: GPL-3.0-or-later
 * Keys of the body, its layers, its points and its pre-cracks. The macros serve keys that occur several
 * times: the same shapes may be added and subtracted. */
#include "perigal/cloud.h"

#define LENGTH "(0, inf)"
/* Diameter or radius of a round shape: exactly one of them. */
#define ROUND(at) \
    { .path = at ".diameter", \
      .kind = PG_NUMBER, \
      .unit = "m", \
      .range = LENGTH, \
      .fallback = "", \
      .group = "size:one", \
      .doc = "Diameter." }, \
    { \
        .path = at ".radius", .kind = PG_NUMBER, .unit = "m", .range = LENGTH, .fallback = "", \
        .group = "size:one", .doc = "Radius." \
    }
/* A map that describes one shape; of all shapes of an entry exactly one is given. */
#define SHAPE(at, word) { .path = at, .kind = PG_MAP, .fallback = "", .group = "shape:one", .doc = word }
/* The shapes are the same under add: and subtract: */
#define SHAPES(op) \
    SHAPE (op ".box", "Box along the axes: an interval, a rectangle or a cuboid."), \
        { .path = op ".box.low", \
          .kind = PG_VECTOR, \
          .unit = "m", \
          .doc = "Corner with the smallest coordinates." }, \
        { .path = op ".box.high", \
          .kind = PG_VECTOR, \
          .unit = "m", \
          .doc = "Corner with the largest coordinates." }, \
        SHAPE (op ".disk", "Disk, in two dimensions."), \
        { .path = op ".disk.center", .kind = PG_VECTOR, .unit = "m", .doc = "Centre." }, ROUND (op ".disk"), \
        SHAPE (op ".cylinder", "Cylinder, in three dimensions."), \
        { .path = op ".cylinder.center", \
          .kind = PG_VECTOR, \
          .unit = "m", \
          .doc = "Middle of the end face where the axis starts." }, \
        { .path = op ".cylinder.axis", \
          .kind = PG_VECTOR, \
          .unit = "1", \
          .fallback = "[0, 0, 1]", \
          .doc = "Direction of the axis; its length does not matter." }, \
        { .path = op ".cylinder.length", \
          .kind = PG_NUMBER, \
          .unit = "m", \
          .range = LENGTH, \
          .doc = "Length along the axis." }, \
        ROUND (op ".cylinder"), SHAPE (op ".sphere", "Ball, in three dimensions."), \
        { .path = op ".sphere.center", .kind = PG_VECTOR, .unit = "m", .doc = "Centre." }, \
        ROUND (op ".sphere"), SHAPE (op ".polygon", "Polygon, in two dimensions."), \
        { .path = op ".polygon.vertices", \
          .kind = PG_LIST, \
          .doc = "Vertices in order; the last is joined to the first." }, \
        { .path = op ".polygon.vertices[]", \
          .kind = PG_NUMBERS, \
          .unit = "m", \
          .fallback = "", \
          .doc = "One vertex [x, y]." }, \
        SHAPE (op ".prism", "Prism along z over a polygon, in three dimensions."), \
        { .path = op ".prism.vertices", \
          .kind = PG_LIST, \
          .doc = "Vertices of the base in order; the last is joined to the first." }, \
        { .path = op ".prism.vertices[]", \
          .kind = PG_NUMBERS, \
          .unit = "m", \
          .fallback = "", \
          .doc = "One vertex [x, y] of the base." }, \
        { .path = op ".prism.low", .kind = PG_NUMBER, .unit = "m", .doc = "Smallest z." }, \
        { .path = op ".prism.high", .kind = PG_NUMBER, .unit = "m", .doc = "Largest z." }, \
        SHAPE (op ".mesh", "What the elements of a mesh fill, in two and three dimensions. Cells are cut " \
                           "along its straight faces exactly, along curved ones by flat pieces of " \
                           "3/4 of a spacing."), \
        { .path = op ".mesh.file", \
          .kind = PG_FILE, \
          .doc = "Mesh file, next to the scene file: formats as under mesh.file. Its side sets are names " \
                 "for sets: {NAME: {boundary: ...}}." }, \
        { .path = op ".mesh.unit", \
          .kind = PG_TEXT, \
          .fallback = "m", \
          .doc = "Unit of length in the file: m, mm, inch, or a length such as 25.4 mm." }, \
        { .path = op ".mesh.blocks", \
          .kind = PG_NAMES, \
          .fallback = "", \
          .doc = "Only these blocks of the mesh, by name or number; default all." }, \
        SHAPE (op ".alpha_shape", \
               "The shape of a set of points, in two and three dimensions: all triangles (tetrahedra) of " \
               "their Delaunay triangulation whose circumscribed circle (sphere) is no larger than alpha, " \
               "and a rim about them; it may have holes and several parts. Without a rim cells are cut " \
               "along it exactly; with one its surface is that of the cells it leaves (a staircase, also " \
               "with cells: cut)."), \
        { .path = op ".alpha_shape.points", \
          .kind = PG_FILE, \
          .fallback = "", \
          .group = "source:one", \
          .doc = "CSV file of points, next to the scene file: columns x y [z] in m, or as a header names " \
                 "them, with units: x [mm], y [mm]; other columns are passed over." }, \
        { .path = op ".alpha_shape.mesh", \
          .kind = PG_MAP, \
          .fallback = "", \
          .group = "source:one", \
          .doc = "The nodes of a mesh as the points." }, \
        { .path = op ".alpha_shape.mesh.file", \
          .kind = PG_FILE, \
          .doc = "Mesh file, next to the scene file: formats as under mesh.file." }, \
        { .path = op ".alpha_shape.mesh.unit", \
          .kind = PG_TEXT, \
          .fallback = "m", \
          .doc = "Unit of length in the file: m, mm, inch, or a length such as 25.4 mm." }, \
        { .path = op ".alpha_shape.mesh.blocks", \
          .kind = PG_NAMES, \
          .fallback = "", \
          .doc = "Only these blocks of the mesh, by name or number; default all." }, \
        { .path = op ".alpha_shape.alpha", \
          .kind = PG_NUMBER, \
          .unit = "m", \
          .range = LENGTH, \
          .fallback = "", \
          .doc = "Largest radius of a circumscribed circle or sphere: gaps and holes narrower than twice " \
                 "this are filled. Unless given: 1.5 times the least for which every point is a corner of " \
                 "the shape (perigal check says it)." }, \
    { \
        .path = op ".alpha_shape.rim", .kind = PG_NUMBER, .unit = "m", .range = "[0, inf)", .fallback = "", \
        .doc = "The shape is all places within this distance of the triangles (tetrahedra), which end at " \
               "the points. Unless given: half the spacing of the points for a file of points, which stand " \
               "in the middle of their cells; 0 for the nodes of a mesh, which lie on its surface." \
    }

/* Each row is one key of the input file: path, kind, unit, range, default, group and the text of `perigal
 * help`. */
static const pg_key keys[] = {
    /* Where points come from: a body of shapes, a file of points, or a mesh (group "origin"). */
    { .path = "body",
      .kind = PG_LIST,
      .range = "[0, 2000]",
      .fallback = "",
      .doc = "The body as shapes, added and subtracted one after the other; needed unless points or a mesh "
             "are read from a file. With points it is their surface." },
    { .path = "body[].name",
      .kind = PG_TEXT,
      .fallback = "",
      .doc = "Name of the surface of this shape for sets; unless given: rim (round), side (straight, also "
             "the flat ends of a cylinder), hole (subtracted)." },
    { .path = "body[].add",
      .kind = PG_MAP,
      .fallback = "",
      .group = "op:one",
      .doc = "The shape becomes part of the body." },
    SHAPES ("body[].add"),
    { .path = "body[].subtract",
      .kind = PG_MAP,
      .fallback = "",
      .group = "op:one",
      .doc = "The shape is cut out of the body." },
    SHAPES ("body[].subtract"),
    /* Boundary layers around a body of shapes. */
    { .path = "layers",
      .kind = PG_LIST,
      .range = "[0, 100]",
      .fallback = "",
      .doc = "Fictitious boundary layers outside of a body of shapes: the body grows by a box over one face "
             "of its bounding box."
             " The spacing is that of the body without them." },
    { .path = "layers[].name",
      .kind = PG_TEXT,
      .doc = "Name of the set that holds the points of the layer (without those on the body's own face) and "
             "the facets of its cells; boundary, failure.exclude ... take it." },
    { .path = "layers[].side",
      .kind = PG_NAME,
      .choices = "left|right|bottom|top|back|front",
      .doc = "On which side of the body; one layer each." },
    { .path = "layers[].thickness",
      .kind = PG_NUMBER,
      .unit = "m|spacing",
      .range = LENGTH,
      .doc = "Thickness, rounded to whole cells of the lattice." },
    { .path = "layers[].over",
      .kind = PG_NAME,
      .choices = "box|body",
      .fallback = "box",
      .doc = "Over the whole face of the bounding box, or only over the part that the body reaches: from "
             "the first to the last place along the face with the body half a cell below it (the foot of "
             "an L; one box, also across a notch)." },
    /* Points of a file or the nodes of a mesh, in place of a lattice in a body (group "origin"). */
    { .path = "points",
      .kind = PG_FILE,
      .fallback = "",
      .group = "origin:most",
      .doc = "CSV file of points, next to the scene file; columns x [y [z]] volume "
             "[block] [spacing] in m and m3. A header may name them in"
             " another order and in other units: x [mm], y [mm], volume [mm3]."
             " With a spacing (distance to the neighbours) the support of each point follows it."
             " With a body, whose shapes are then the surface, or with surface: alpha_shape, the cells of a "
             "regular grid (spacing; unless given, that of the points) cut by it serve integration and "
             "boundaries; else there are no cells, and method.integration is nodal." },
    { .path = "surface",
      .kind = PG_NAME,
      .choices = "none|alpha_shape",
      .fallback = "none",
      .doc = "Surface of the points of a file without a body. none: a place belongs to the body if a point "
             "is near. alpha_shape: that of their alpha shape, with a rim of half a spacing: as if body had "
             "add: {alpha_shape: {points: the same file}}, by which alpha and rim can be given." },
    { .path = "mesh",
      .kind = PG_MAP,
      .fallback = "",
      .group = "origin:most",
      .doc = "Mesh in place of a body: its elements are the background cells, its nodes the points, its sets "
             "are sets." },
    { .path = "mesh.file",
      .kind = PG_FILE,
      .doc = "Mesh file, next to the scene file: Gmsh .msh, Abaqus or CalculiX .inp, Exodus .e, CalculiX "
             ".frd, told by content." },
    { .path = "mesh.unit",
      .kind = PG_TEXT,
      .fallback = "m",
      .doc = "Unit of length in the file: m, mm, inch, or a length such as 25.4 mm." },
    { .path = "mesh.blocks",
      .kind = PG_NAMES,
      .fallback = "",
      .doc = "Only these blocks of the mesh, by name or number; default all." },
    { .path = "mesh.points",
      .kind = PG_NAME,
      .fallback = "nodes",
      .choices = "nodes|corners",
      .doc = "Points at all nodes, or at the corners of the elements only." },
    { .path = "mesh.support",
      .kind = PG_NAME,
      .fallback = "local",
      .choices = "local|equal|anisotropic",
      .doc = "Support of a point: horizon in units of the local spacing, or of the mean spacing everywhere; "
             "anisotropic: an ellipse (ellipsoid) as long and as wide in spacings as the elements there are, "
             "for the same horizon in spacings along all of their edges (galerkin, support: radial)." },
    /* The lattice over a body of shapes. */
    { .path = "spacing",
      .kind = PG_NUMBER,
      .unit = "m",
      .range = LENGTH,
      .fallback = "",
      .doc = "Desired distance of the points; adapted per axis so that a whole number of cells fills the "
             "bounding box. Needed with body." },
    { .path = "lattice",
      .kind = PG_NAME,
      .fallback = "nodes",
      .choices = "nodes|cells",
      .doc = "Points at the vertices of the cells, so that some lie on the boundary, or at their centres." },
    { .path = "lattice_offset",
      .kind = PG_VECTOR,
      .unit = "1",
      .range = "[-1, 1]",
      .fallback = "",
      .doc = "Shift of the lattice against the bounding box, in steps of the lattice." },
    /* Random shifts of points. */
    { .path = "perturb",
      .kind = PG_MAP,
      .fallback = "",
      .doc = "Moves points away from the lattice (of a mesh: from its nodes) at random, reproducibly; "
             "boundary points and cells stay." },
    { .path = "perturb.amount",
      .kind = PG_NUMBER,
      .unit = "1",
      .range = "[0, 0.45]",
      .fallback = "0",
      .doc = "Largest shift along each axis, in steps of the lattice or local spacings of the mesh." },
    { .path = "perturb.seed",
      .kind = PG_INTEGER,
      .range = "[0, inf)",
      .fallback = "1",
      .doc = "Seed of the random numbers: another seed gives another arrangement." },
    /* Pre-cracks: segments, polylines, outlines in 2D; polygons, discs, ellipses in 3D. */
    { .path = "cracks",
      .kind = PG_LIST,
      .fallback = "",
      .doc =
          "Cracks present before loading: bonds that meet one are broken from the start. They may touch and "
          "cross each other and leave the body." },
    { .path = "cracks[].from",
      .kind = PG_VECTOR,
      .unit = "m",
      .fallback = "",
      .group = "kind:one",
      .doc = "One end of a straight crack in two dimensions." },
    { .path = "cracks[].to", .kind = PG_VECTOR, .unit = "m", .fallback = "", .doc = "The other end." },
    { .path = "cracks[].width",
      .kind = PG_NUMBER,
      .unit = "m|spacing",
      .range = LENGTH,
      .fallback = "",
      .doc = "Makes the crack a slot: material within half of this on each side is missing, its ends are "
             "square; "
             "bonds that cross its middle are cut, also where it is narrower than the horizon. A slot has no "
             "tips; its surface is called slot. Bodies of shapes only." },
    { .path = "cracks[].polyline",
      .kind = PG_LIST,
      .fallback = "",
      .group = "kind:one",
      .doc =
          "Crack of several straight pieces in two dimensions: vertices in order; closed if the last is the "
          "first." },
    { .path = "cracks[].polyline[]",
      .kind = PG_VECTOR,
      .unit = "m",
      .fallback = "",
      .doc = "One vertex [x, y]." },
    { .path = "cracks[].polygon",
      .kind = PG_LIST,
      .fallback = "",
      .group = "kind:one",
      .doc = "Plane polygon in three dimensions: vertices in order. In two dimensions the outline of a slot: "
             "the material inside is missing." },
    { .path = "cracks[].polygon[]",
      .kind = PG_VECTOR,
      .unit = "m",
      .fallback = "",
      .doc = "One vertex [x, y, z], or [x, y]." },
    { .path = "cracks[].disc",
      .kind = PG_MAP,
      .fallback = "",
      .group = "kind:one",
      .doc = "Penny-shaped crack in three dimensions." },
    { .path = "cracks[].disc.center", .kind = PG_VECTOR, .unit = "m", .doc = "Centre." },
    { .path = "cracks[].disc.normal",
      .kind = PG_VECTOR,
      .unit = "1",
      .doc = "Direction across the crack; its length does not matter." },
    { .path = "cracks[].disc.radius", .kind = PG_NUMBER, .unit = "m", .range = LENGTH, .doc = "Radius." },
    { .path = "cracks[].ellipse",
      .kind = PG_MAP,
      .fallback = "",
      .group = "kind:one",
      .doc =
          "Elliptic crack in three dimensions; in two dimensions the outline of a slot. As a polygon of 64 "
          "corners and the same area." },
    { .path = "cracks[].ellipse.center", .kind = PG_VECTOR, .unit = "m", .doc = "Centre." },
    { .path = "cracks[].ellipse.length",
      .kind = PG_NUMBER,
      .unit = "m",
      .range = LENGTH,
      .doc = "Long axis, from end to end." },
    { .path = "cracks[].ellipse.breadth",
      .kind = PG_NUMBER,
      .unit = "m",
      .range = LENGTH,
      .doc = "Short axis, from end to end." },
    { .path = "cracks[].ellipse.angle",
      .kind = PG_NUMBER,
      .unit = "rad",
      .fallback = "0",
      .doc = "In two dimensions: of the long axis, from the x axis to the y axis." },
    { .path = "cracks[].ellipse.normal",
      .kind = PG_VECTOR,
      .unit = "1",
      .fallback = "",
      .doc = "In three dimensions: direction across the crack." },
    { .path = "cracks[].ellipse.along",
      .kind = PG_VECTOR,
      .unit = "1",
      .fallback = "",
      .doc = "In three dimensions: direction of the long axis; its part across the crack is left out." },
    { .path = "cracks[].file",
      .kind = PG_FILE,
      .fallback = "",
      .group = "kind:one",
      .doc = "CSV file of cracks, next to the scene file. Columns x1, y1, x2, y2 in two dimensions; x, y, z, "
             "nx, "
             "ny, nz, radius (discs: centre, normal) in three; or a number of the crack in a column called "
             "polyline or polygon and x, y [, z], a vertex a line; and in any of them width (0: sharp). A "
             "header "
             "may name them in another order, and in other units: x1 [mm]. perigal cracks --csv writes such "
             "files." },
    /* Random networks. */
    { .path = "cracks[].random",
      .kind = PG_MAP,
      .fallback = "",
      .group = "kind:one",
      .doc =
          "A random network: of each crack a length and a direction are drawn once, then places until it "
          "fits "
          "(one that fits nowhere is drawn anew). "
          "A seed gives the same cracks on every machine, whatever the spacing. perigal cracks SCENE draws "
          "it." },
    { .path = "cracks[].random.seed",
      .kind = PG_INTEGER,
      .range = "[0, 4294967295]",
      .fallback = "1",
      .doc = "Another seed, another network; perigal seeds runs many." },
    { .path = "cracks[].random.count",
      .kind = PG_INTEGER,
      .range = "[1, 20000]",
      .fallback = "",
      .group = "amount:one",
      .doc = "Number of cracks." },
    { .path = "cracks[].random.fraction",
      .kind = PG_NUMBER,
      .unit = "1",
      .range = "(0, 1)",
      .fallback = "",
      .group = "amount:one",
      .doc = "Cracks until their slots take this part of the area (3D: volume) of the body, overlaps counted "
             "twice; needs a width." },
    { .path = "cracks[].random.intensity",
      .kind = PG_NUMBER,
      .unit = "1/m",
      .range = LENGTH,
      .fallback = "",
      .group = "amount:one",
      .doc = "Cracks until their length per area of the body (P21; 3D: area per volume, P32) is this." },
    { .path = "cracks[].random.length",
      .kind = PG_NUMBER,
      .unit = "m",
      .range = LENGTH,
      .doc = "Length of every crack (a disc: its diameter; a rectangle, an ellipse: its longer side or "
             "axis); or "
             "a map with its distribution." },
    { .path = "cracks[].random.length",
      .kind = PG_MAP,
      .doc = "Distribution of the lengths; what lies beyond min and max is drawn again." },
    { .path = "cracks[].random.length.distribution",
      .kind = PG_NAME,
      .choices = "uniform|normal|lognormal|exponential|power_law",
      .doc =
          "uniform: min, max; normal and lognormal: mean, deviation; exponential: mean; power_law: density "
          "proportional to length^-exponent between min and max." },
    { .path = "cracks[].random.length.mean",
      .kind = PG_NUMBER,
      .unit = "m",
      .range = LENGTH,
      .fallback = "",
      .doc = "Mean, before min and max cut it off." },
    { .path = "cracks[].random.length.deviation",
      .kind = PG_NUMBER,
      .unit = "m",
      .range = LENGTH,
      .fallback = "",
      .doc = "Standard deviation of the length itself." },
    { .path = "cracks[].random.length.min",
      .kind = PG_NUMBER,
      .unit = "m",
      .range = LENGTH,
      .fallback = "",
      .doc = "Least length." },
    { .path = "cracks[].random.length.max",
      .kind = PG_NUMBER,
      .unit = "m",
      .range = LENGTH,
      .fallback = "",
      .doc = "Largest length." },
    { .path = "cracks[].random.length.exponent",
      .kind = PG_NUMBER,
      .unit = "1",
      .range = "[0, 10]",
      .fallback = "",
      .doc = "Exponent of the density; fracture networks: 1.5 to 3.5." },
    { .path = "cracks[].random.angle",
      .kind = PG_NUMBER,
      .unit = "rad",
      .fallback = "",
      .doc = "In two dimensions the angle of every crack from the x axis, or a map with its distribution; "
             "without "
             "it all directions alike." },
    { .path = "cracks[].random.angle", .kind = PG_MAP, .fallback = "", .doc = "Distribution of the angles." },
    { .path = "cracks[].random.angle.distribution",
      .kind = PG_NAME,
      .choices = "uniform|normal|von_mises",
      .doc = "uniform: min, max; normal: mean, deviation; von_mises: mean, concentration." },
    { .path = "cracks[].random.angle.mean",
      .kind = PG_NUMBER,
      .unit = "rad",
      .fallback = "",
      .doc = "Mean." },
    { .path = "cracks[].random.angle.deviation",
      .kind = PG_NUMBER,
      .unit = "rad",
      .range = LENGTH,
      .fallback = "",
      .doc = "Standard deviation." },
    { .path = "cracks[].random.angle.concentration",
      .kind = PG_NUMBER,
      .unit = "1",
      .range = "[0, 1e6]",
      .fallback = "",
      .doc = "Concentration kappa: 0 all angles alike, about 1 / deviation^2 (in rad) where it is large." },
    { .path = "cracks[].random.angle.min",
      .kind = PG_NUMBER,
      .unit = "rad",
      .fallback = "",
      .doc = "Least." },
    { .path = "cracks[].random.angle.max",
      .kind = PG_NUMBER,
      .unit = "rad",
      .fallback = "",
      .doc = "Largest." },
    { .path = "cracks[].random.normal",
      .kind = PG_MAP,
      .fallback = "",
      .doc =
          "In three dimensions: normals of the cracks by Fisher's distribution about a mean; without it all "
          "directions alike." },
    { .path = "cracks[].random.normal.mean", .kind = PG_VECTOR, .unit = "1", .doc = "Mean direction." },
    { .path = "cracks[].random.normal.concentration",
      .kind = PG_NUMBER,
      .unit = "1",
      .range = "[0, 1e6]",
      .doc = "Concentration kappa: 0 all directions alike; 100: most within 10 degrees." },
    { .path = "cracks[].random.position",
      .kind = PG_MAP,
      .fallback = "",
      .doc = "Where the middles lie; without it anywhere in the body alike." },
    { .path = "cracks[].random.position.distribution",
      .kind = PG_NAME,
      .fallback = "uniform",
      .choices = "uniform|normal",
      .doc =
          "uniform: in the body, or in the part between low and high; normal: about mean with deviation." },
    { .path = "cracks[].random.position.low",
      .kind = PG_VECTOR,
      .unit = "m",
      .fallback = "",
      .doc = "Corner of a box with the smallest coordinates." },
    { .path = "cracks[].random.position.high",
      .kind = PG_VECTOR,
      .unit = "m",
      .fallback = "",
      .doc = "Corner with the largest coordinates." },
    { .path = "cracks[].random.position.mean",
      .kind = PG_VECTOR,
      .unit = "m",
      .fallback = "",
      .doc = "Mean." },
    { .path = "cracks[].random.position.deviation",
      .kind = PG_VECTOR,
      .unit = "m",
      .fallback = "",
      .doc = "Standard deviation along each axis." },
    { .path = "cracks[].random.shape",
      .kind = PG_NAME,
      .fallback = "disc",
      .choices = "disc|rectangle|ellipse",
      .doc = "In three dimensions." },
    { .path = "cracks[].random.aspect",
      .kind = PG_NUMBER,
      .unit = "1",
      .range = "(0, 1]",
      .fallback = "1",
      .doc = "In three dimensions: breadth of a rectangle or an ellipse over its length." },
    { .path = "cracks[].random.distance",
      .kind = PG_NUMBER,
      .unit = "m",
      .range = "[0, inf)",
      .fallback = "",
      .doc =
          "Least distance from every crack before it in the list (of slots: of their faces); 0: they do not "
          "touch; without it they may cross." },
    { .path = "cracks[].random.inside",
      .kind = PG_NAME,
      .fallback = "whole",
      .choices = "whole|middle",
      .doc = "whole: cracks lie in the body, half a width below its surface; middle: what sticks out of the "
             "body "
             "is cut off." },
    { .path = "cracks[].random.margin",
      .kind = PG_NUMBER,
      .unit = "m",
      .range = "[0, inf)",
      .fallback = "0",
      .doc = "Whole cracks lie so far below the surface." },
};
const pg_key_table pg_keys_cloud = { "cloud", keys, sizeof keys / sizeof *keys };

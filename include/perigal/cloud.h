/* SPDX-License-Identifier: GPL-3.0-or-later
 * cloud.h: the body as shapes, the background lattice, points with volumes, families of neighbours, nearest
 * points, pre-cracks. Lengths are in m; volumes include thickness (2D) or cross section (1D), hence m^3. */
#ifndef PERIGAL_CLOUD_H
#define PERIGAL_CLOUD_H
#include "perigal/scene.h"
#include "perigal/linalg.h"
#include "perigal/mesh.h"
#include "perigal/ranks.h"

PG_API_BEGIN

/* ---- shapes -------------------------------------------------------------------------------------------- */
/* Kinds of shapes. Three are no shapes of a scene: PG_STAIRS and PG_FACETED are a mesh or an alpha shape as
 * cells see it, as whole boxes of a lattice or by flat pieces of its surface; PG_PLATE is a plane polygon in
 * space with a thickness, the material that a crack with a width removes from the body. */
enum { PG_BOX, PG_DISK, PG_CYLINDER, PG_SPHERE, PG_POLYGON, PG_PRISM, PG_MESH, PG_ALPHA_SHAPE, PG_STAIRS,
       PG_PLATE, PG_FACETED };

/* A shape that is added to or subtracted from the body. */
typedef struct {
    /* add: 1: added, 0: subtracted. */
    int    kind, add;
    /* Name of its surface for `sets: {boundary: NAME}`: the one given by `name:`, else "rim" (round,
     * added), "hole" (subtracted) or "side". */
    char   boundary[32];
    /* Opposite corners of a box, m; of a prism, which extends along z, only low[2] and high[2]. */
    double low[3], high[3];
    /* Disk and sphere: centre and radius. Cylinder: centre of one end, unit axis from there, length,
     * radius. m. */
    double centre[3], axis[3], radius, length;
    /* Polygon, prism: vertices x, y (nvertex x 2), m. */
    double *vertex; size_t nvertex;
    /* Of a mesh or an alpha shape the elements and their surface; of PG_STAIRS the cells of a lattice. */
    struct pg_solid *solid;
    /* Second direction in the plane of a PG_PLATE: its `vertex` are coordinates from `centre` along `along`
     * and `axis` x `along` (unit vectors), `length` is its thickness. */
    double along[3];
    /* slot: 1: a crack with a width (pg_slots_read), whose surface is called "slot"; box: its bounding box
     * then (low, high; 2 x 3), m. */
    int    slot;  double box[6];
} pg_shape;

/* A fictitious boundary layer: a box of whole lattice cells over one face of the bounding box of the shapes,
 * outside of it (doc/method.md B3). It covers the whole face, or the part of it, along each axis, between the
 * first and the last position at which the body lies half a cell below it. */
typedef struct {
    /* Name of the layer, of its set and of its surface. */
    char   name[32];
    /* Side of the bounding box: left right bottom top back front, 2 axis + (1 on the high side). */
    int    side;
    /* Number of lattice cells across it. */
    int    rows;
    /* Coordinate of the face that it lies on, m. */
    double face;
} pg_layer;

/* The body: shapes in the order of the scene. */
typedef struct {
    int dim;
    /* The shapes of `body`, then a box for each layer (n). */
    pg_shape *shape; size_t n;
    /* Bounding box of the added shapes and the layers, m. */
    double low[3], high[3];
    /* The layers (nlayer). */
    pg_layer *layer; size_t nlayer;
} pg_body;
/* Reads `body` (a list of {add|subtract: {...}}), the slots of `cracks`, which are taken from these shapes,
 * and `layers` (a list of {name, side, thickness, over}). Layers become whole cells of the lattice that
 * pg_lattice_fit lays over the body without them at the scene's spacing, round (thickness / step) of them.
 * PG_E_SCENE: an error in the scene. */
pg_status pg_body_read  (pg_body *out, const pg_scene *scene);
/* Index of the boundary layer in which x (m) lies, more than `margin` (m) beyond its face; -1: none. */
long      pg_body_layer (const pg_body *body, const double *x, double margin);
void      pg_body_clear (pg_body *body);
/* Returns 1: x (m) lies in the body. Shapes act in their order; a position within `tolerance` (m) of a
 * surface is inside. */
int       pg_body_inside (const pg_body *body, const double *x, double tolerance);
/* Rounding error of positions within a box, m: four units in the last place of its largest coordinate. Far
 * from the origin it is more than any share of the spacing that tolerances take. */
double    pg_rounding (int dim, const double *low, const double *high);
/* Index of the shape whose surface is nearest to x (m), and the distance of that surface (m; may be NULL). */
size_t    pg_body_nearest (const pg_body *body, const double *x, double *distance);
/* Name of the kind of a shape in a scene: "box", "disk" ... */
const char *pg_shape_kind (const pg_shape *shape);
/* Volume, m^3 (2D: area, m^2) and surface, m^2 (2D: length, m) of the body in closed form, without thickness;
 * returns 0 where they are not known (bodies of more than one shape). */
int       pg_body_measure (const pg_body *body, double *volume, double *surface);
/* Number of shapes that consist of elements (PG_MESH, PG_ALPHA_SHAPE); 1: this shape does; 1: the face of the
 * shape's mesh nearest to x (m) belongs to its side set `side`; name of side set k, NULL past the last. */
size_t      pg_body_meshes   (const pg_body *body);
int         pg_shape_meshed  (const pg_shape *shape);
int         pg_shape_on_side (const pg_shape *shape, const double *x, const char *side);
const char *pg_shape_side    (const pg_shape *shape, size_t k);
/* Returns 1: side `at` (numbered from 0) of an element of the shape's mesh belongs to the side set `side`. */
int         pg_shape_face_on_side (const pg_shape *shape, int element, int at, const char *side);

/* ---- alpha shapes -------------------------------------------------------------------------------------- */
/* The shape of a set of points: all triangles (2D) or tetrahedra (3D) of their Delaunay triangulation whose
 * circumscribed circle or sphere has a radius of at most alpha (Edelsbrunner and Muecke 1994, doi
 * 10.1145/174462.156635). Its surface passes through points. A ball of radius alpha fits into every hole and
 * beside every concave corner of the shape. */
typedef struct {
    int     dim;
    /* The radius alpha in use, m. */
    double  alpha;
    /* Volume (2D: area) of the simplices, m^dim, and the size of the space per point, m: the volume over the
     * number of points, each counted by the part of the full angle about it that lies in the shape. On a
     * lattice this is its step. */
    double  volume, spacing;
    /* Number of parts that share no face with each other; number of enclosed regions outside the shape (2D:
     * holes, 3D: cavities; a hole through a solid is none). */
    size_t  parts, holes;
    /* twins: number of points that repeat an earlier one. loose: number of points that belong to no simplex
     * of the shape; first_loose: index of the first of these as given, -1: none. */
    size_t  twins, loose;
    long    first_loose;
    /* Automatic alpha: largest over median of the radii at which points begin to belong to the shape; 0:
     * alpha was given. */
    double  uneven;
    /* Distance by which the shape in a scene is grown (key rim), m: it contains all positions within it. */
    double  rim;
    /* The simplices as a conforming mesh of TRI3 or TET4. Nodes are the points without repetitions; node_id:
     * their number as given, from 1. */
    pg_mesh mesh;
} pg_alpha_shape;
/* The alpha shape of n points x (n x dim, m) in two or three dimensions. alpha, m; 0: 1.5 times the least
 * radius for which every point is a corner of the shape. PG_E_USAGE, in words: fewer than dim + 1
 * different points, all on one line or plane, coordinates that are not finite; alpha given, but smaller
 * than every radius; alpha automatic, but one point needs more than 30 times the median radius. PG_E_FILE:
 * Qhull is not installed; PG_E_LIMIT: it could not triangulate the points; PG_E_MEMORY. */
pg_status pg_alpha_shape_create (pg_alpha_shape *out, int dim, size_t n, const double *x, double alpha);
void      pg_alpha_shape_clear  (pg_alpha_shape *shape);
/* Alpha shape of a pg_shape of kind PG_ALPHA_SHAPE, borrowed; NULL: the shape is of another kind. */
const pg_alpha_shape *pg_shape_alpha (const pg_shape *shape);

/* ---- background lattice -------------------------------------------------------------------------------- */
/* Equal boxes over the bounding box of the body. */
typedef struct {
    /* count: cells along each axis, 1 beyond dim. */
    int    dim, count[3];
    /* Corners of the lattice, and its steps: L / round (L / spacing), L being the extent without
     * layers. m. */
    double origin[3], high[3], step[3];
    /* 1 for each cell whose centre lies in the body (count[0] x count[1] x count[2], x fastest). */
    unsigned char *in;
    /* Parallel runs, where this is the part of a larger lattice that a rank stores (perigal/ranks.h): index
     * of its first cell there, and the counts and corners (m) of that lattice. whole[0] = 0: this is the
     * whole lattice. */
    int    first[3], whole[3];
    double whole_origin[3], whole_high[3];
} pg_lattice;
/* Lays a lattice over the body. offset: shift in fractions of a step, or NULL. PG_E_LIMIT: more cells than
 * an int can number. */
pg_status pg_lattice_fit (pg_lattice *out, const pg_body *body, double spacing,
                          const double *offset /* fraction of a step or NULL */);
/* Makes only the cells `part` of the lattice of pg_lattice_fit, numbered from 0, with coordinates equal to
 * the last bit. part NULL: counts, corners and steps of the whole lattice, without `in`. */
pg_status pg_lattice_fit_part (pg_lattice *out, const pg_body *body, double spacing, const double *offset,
                               const pg_box *part);
void      pg_lattice_clear (pg_lattice *lattice);
/* Returns 1: cell i (3 indices, one of them outside 0 .. count - 1) belongs to the larger lattice of which
 * this is a part; 0: it lies outside that, too. */
int       pg_lattice_goes_on (const pg_lattice *lattice, const int *i);
/* Coordinate (m) of lattice vertex i along an axis; i + 0.5: of a cell's centre. Corners are exact, and the
 * coordinates are symmetric about the middle to the last bit. */
double    pg_lattice_at    (const pg_lattice *lattice, int axis, double i);
/* Returns 1 on the one rank whose subdomain contains the cell around x (m), 0 on others; serial runs
 * (subdomain NULL): 1. */
int       pg_lattice_owns (const pg_lattice *lattice, const pg_subdomain *subdomain, const double *x);
/* Number of the cell around x (m) in the whole lattice (x index fastest), also where `lattice` is a part of
 * it. */
int64_t   pg_lattice_cell (const pg_lattice *lattice, const double *x);
/* Cells of the whole lattice around the points that a rank owns, extended by a layer of `width` (m). */
pg_box    pg_subdomain_cells (const pg_subdomain *subdomain, const pg_lattice *lattice, double width);
/* Tolerance (m) within which the centre of a cell counts as lying on the surface. */
double    pg_lattice_tolerance (const pg_lattice *lattice);
/* Makes a shape PG_STAIRS of a mesh or an alpha shape: all of a lattice cell is inside where its centre is
 * inside. */
pg_status pg_stairs_create (pg_shape *out, const pg_shape *mesh, const pg_lattice *lattice);
void      pg_stairs_clear  (pg_shape *stairs);
/* Returns 1: of cell i (3 indices) and the cell beyond its face (0 .. 5: -x +x -y +y -z +z) one is inside and
 * the other is not. */
int       pg_stairs_step   (const pg_shape *stairs, const int *i, int face);

/* ---- surfaces of flat pieces --------------------------------------------------------------------------- */
/* The surface of a mesh or an alpha shape as flat pieces: segments in 2D, triangles in 3D. Plane faces are
 * kept, curved ones are divided into pieces no longer than 3/4 of a step of the lattice, whose corners lie on
 * the face. Pieces that touch along an edge, lie in one plane and belong to the same side sets form a region,
 * so that a plane side of a body is one region however its mesh is divided. */
typedef struct {
    int     dim;
    /* Number of flat pieces, their corners (n x dim corners x dim, m) in an order that makes their normals
     * point out of the shape, and the region of each (n). */
    size_t  n;
    double *x;
    int    *region;
    /* Number of plane regions; a point on each (m) and its unit normal (nregion x 2 dim); the coordinate axis
     * to which it is exactly normal, else -1; element and side of one of its faces (nregion each). */
    size_t  nregion;
    double *plane;
    int    *axis, *element, *side;
    /* Pieces of region r: piece[first[r]] .. piece[first[r + 1] - 1]. */
    size_t *first;  int *piece;
    /* Boundary of region r: edges edge_first[r] .. edge_first[r + 1] - 1, two end points each (2D: single
     * points), m. */
    size_t *edge_first;  double *edge;
    /* Search structure for rays along each axis: the pieces that they may meet, in columns as wide as the
     * cells of this lattice. */
    pg_lattice lattice;
    size_t *column_first[3];  int *column[3];
} pg_facets;
/* Makes a shape PG_FACETED of a mesh, or of an alpha shape without a rim. PG_E_MEMORY, PG_E_LIMIT. */
pg_status pg_faceted_create (pg_shape *out, const pg_shape *mesh, const pg_lattice *lattice);
/* Returns 1: background cells represent this shape by whole boxes (an alpha shape with a rim, whose surface
 * has no flat pieces). */
int       pg_shape_stepped (const pg_shape *shape);
/* Flat pieces of a shape of kind PG_FACETED; NULL: it is of another kind. */
const pg_facets *pg_shape_facets (const pg_shape *shape);
/* Returns 1: x (m) is enclosed by the flat pieces, by counting signed crossings along a ray. */
int       pg_facets_inside (const pg_facets *facets, const double *x);
/* Returns 1: the line through x (m) along the axis, which is not parallel to the region, meets a piece of the
 * region. */
int       pg_facets_meets  (const pg_facets *facets, int region, const double *x, int axis);
/* Finds where the line through x (m) along the axis meets flat pieces: coordinates `at` (m, ascending) and
 * `sense` of their normals there (+1 along the axis), `most` at most. Returns their number; -1: too many, or
 * too near to an edge. */
int       pg_facets_line   (const pg_facets *facets, const double *x, int axis, int most, double *at,
                            int *sense);

/* ---- points -------------------------------------------------------------------------------------------- */
/* Material points (nodes) of the body. */
typedef struct {
    int     dim;
    size_t  n;
    /* Positions, m (n x dim). */
    double *x;
    /* Volumes, m^3 (n). */
    double *volume;
    /* Number of the block (mesh or file of points) of each point, 0 unless given (n). */
    int    *block;
    /* Local spacing, m (n); NULL: h everywhere. With ellipsoidal supports (metric): along their longest
     * axis. */
    double *size;
    /* Matrix A of the ellipsoidal support of each point, which measures the length of a bond z as sqrt (z' A
     * z); A symmetric, its least eigenvalue 1, so that the support lies in the ball of its spacing (n x dim x
     * dim); NULL: supports are balls, A = 1. Only beside `size`, and only for families of shape PG_RADIAL. */
    double *metric;
    /* Nominal spacing, m: (volume of a lattice cell)^(1/dim), or the mean. */
    double  h;
    /* Step of the lattice along each axis; h where there is none. m. */
    double  step[3];
    /* 1: all points lie on the vertices or in the middle of the cells of the lattice, none was moved. */
    int     regular;
    /* 1: points of a lattice are (or were, before they were moved) in the middle of its cells, else on
     * vertices. */
    int     centred;
    /* Thickness in 2D (m), cross section in 1D (m^2), 1 in 3D. */
    double  thickness;
    /* Bounding box of the points (in parallel runs of those of all ranks), m. */
    double  low[3], high[3];
    /* Parallel runs: which of the points this rank owns (perigal/ranks.h); NULL: serial run. */
    pg_subdomain *subdomain;
    /* Names of the columns of the file of points that are ignored: "id, label"; "": none. */
    char    passed[64];
    /* Visibility test between points across slots and gaps; NULL: all see each other. Borrowed. */
    const struct pg_between *between;
} pg_cloud;
/* Returns 1: this rank owns the point; 0: it is a ghost, owned by another rank. In parallel runs a cloud is a
 * part of the points of the body with ghosts around it, and all ranks make the same calls. */
static inline int pg_cloud_owns (const pg_cloud *c, size_t point) { return pg_owns (c->subdomain, point); }
/* Number of a point among all points of the body (of all ranks). */
static inline size_t pg_cloud_number (const pg_cloud *c, size_t point)
{
    return c->subdomain ? (size_t) c->subdomain->number[point] : point;
}
static inline size_t pg_cloud_total (const pg_cloud *c)
{
    return c->subdomain ? (size_t) c->subdomain->total : c->n;
}
/* Sums (pg_cloud_most: maxima) over all ranks of each of n numbers, in place. */
static inline pg_status pg_cloud_sum (const pg_cloud *c, size_t n, double *value)
{
    return c->subdomain ? pg_ranks_sum (n, value) : PG_OK;
}
static inline pg_status pg_cloud_most (const pg_cloud *c, size_t n, double *value)
{
    return c->subdomain ? pg_ranks_most (n, value) : PG_OK;
}
/* Makes the points of the scene. On a lattice (`lattice: nodes` or `cells`): the vertices of the cells whose
 * centre lies in the body, each with an equal share of the volume of its cells, or the centres of these
 * cells; then perturbed reproducibly, but only points with kept cells all around. Or read from `points:
 * FILE`; the lattice is empty then (dim = 0). PG_E_SCENE, PG_E_MEMORY. */
pg_status pg_cloud_build (pg_cloud *out, pg_lattice *lattice, const pg_body *body, const pg_scene *scene);
/* Makes the points of the scene for the subdomain of this rank, with a layer of ghosts of `width` (m) around
 * it: only these and their part of the lattice are made (out->subdomain). In serial runs, and for points from
 * a file (divided by pg_cloud_divide), it makes all points, as pg_cloud_build. */
pg_status pg_cloud_build_part (pg_cloud *out, pg_lattice *lattice, const pg_body *body, const pg_scene *scene,
                               double width);
/* Divides points that form no lattice, all of which every rank has read: *owner is the rank of each
 * (pg_free), by recursive bisection of coordinates; cloud->subdomain is filled for this rank, with a layer of
 * ghosts of `width` (m) at nominal spacing, wider where the spacing is larger. The cloud still has all
 * points; pg_cloud_keep drops those that are neither owned nor ghosts. PG_E_LIMIT: more ranks than points. */
pg_status pg_cloud_divide (pg_cloud *cloud, double width, int **owner);
void      pg_cloud_keep   (pg_cloud *cloud);
/* *here: 1 on the one rank that owns the point nearest to `place` (m), of several the lowest rank; else 0.
 * *here >= 0 on entry: the result of an earlier call, which is kept. All ranks must call. */
pg_status pg_cloud_has_nearest (const pg_cloud *cloud, const double *place, signed char *here);
/* Size of the part of the body that one rank stores in a parallel run. */
typedef struct {
    double owned, ghosts;                              /* numbers of points owned, of ghosts */
    int    neighbours;                                 /* ranks that it exchanges values of ghosts with */
    double sent;                                       /* points sent, each counted once per receiving rank */
} pg_part_size;
/* Predicts in one process the parts that pg_cloud_build_part or pg_cloud_divide would give to each of `size`
 * ranks: out (size). PG_E_LIMIT: the body cannot be divided among so many. */
pg_status pg_cloud_parts (pg_part_size *out, const pg_body *body, const pg_scene *scene, double width,
                          int size);
/* Nominal spacing (pg_cloud.h) of the points of a scene, m, before they are built. */
pg_status pg_cloud_spacing (double *h, const pg_body *body, const pg_scene *scene);
void      pg_cloud_clear (pg_cloud *cloud);
/* Local spacing of point i over the nominal one: the support of node i is `horizon` times this. Exactly 1
 * where size is NULL or equals h. */
double    pg_cloud_ratio (const pg_cloud *cloud, size_t i);
/* Squared length z' A z (m^2) of a bond z (dim, m) in the metric A of the support of point i. */
double    pg_cloud_length2 (const pg_cloud *cloud, size_t i, const double *z);
/* Lower bound of the aspect ratio of the support of point i: sqrt (trace A / dim), 1 for a ball. */
double    pg_cloud_slender (const pg_cloud *cloud, size_t i);
/* Smallest local spacing, m. */
double    pg_cloud_finest (const pg_cloud *cloud);
/* Distance (m) below which two positions count as equal: 1e-9 spacings plus the rounding error of the
 * points. */
double    pg_cloud_same (const pg_cloud *cloud);
/* Number of equal parts of at most `most` (m) into which a length (m) is divided, at least 1; excess by
 * rounding alone adds no part. */
size_t    pg_cloud_pieces (const pg_cloud *cloud, double length, double most);

/* ---- points of a mesh ---------------------------------------------------------------------------------- */
/* The mesh of a body given by `mesh`; mesh.n = 0: the scene has no mesh. */
typedef struct {
    /* The blocks in use, in m. */
    pg_mesh mesh;
    /* File as the scene names it. */
    char    file[256];
    /* Length of a unit of the file, m. */
    double  unit;
    /* Volume of every element, m^dim (mesh.n). */
    double *volume;
    /* Smallest and largest size of an element, volume^(1/dim), m. */
    double  smallest, largest;
    /* Smallest scaled Jacobian at a corner of any element, edges taken as straight: 1 best, 0 flat. */
    double  quality;
    /* The element with the smallest scaled Jacobian. */
    size_t  worst;
    /* Point of the cloud at each node, -1: none (mesh.nnode). Filled by pg_mesh_body_cloud. */
    int    *point;
} pg_mesh_body;
/* Reads `mesh` of the scene: file, unit, blocks. Faults of the scene: a file that cannot be read, another
 * dimension, unknown blocks, and elements whose map turns inside out somewhere. */
pg_status pg_mesh_body_read  (pg_mesh_body *out, const pg_scene *scene);
/* Points at the nodes (`mesh.points`: all or corners). Volumes are integrals of the shape functions; where
 * one of an element is not positive (tri6, tet10, quad8 ...) they are in the ratio of the integrals of the
 * squares. Their sum is the volume of the elements. size: mean length of the edges at a node (half of it
 * where nodes in the middle of edges are points), at least so large that both ends of an edge lie in the
 * support of each other from a horizon of 1.7 spacings on; h: its mean. */
pg_status pg_mesh_body_cloud (pg_cloud *out, pg_mesh_body *body, const pg_scene *scene);
void      pg_mesh_body_clear (pg_mesh_body *body);
/* 1: some points lie in the middle of edges, half an edge from the next, so that finer quadrature is
 * needed. */
int       pg_mesh_body_halved (const pg_mesh_body *body);
/* Index of the block of that name, or else of that number; -1: there is none. pg_mesh_body_blocks writes the
 * names of all blocks, separated by |. */
int       pg_mesh_body_block  (const pg_mesh *mesh, const char *name);
void      pg_mesh_body_blocks (const pg_mesh *mesh, char *out, size_t size);

/* ---- families ------------------------------------------------------------------------------------------ */
/* Neighbours (nodes within the support) of each of n centres. */
typedef pg_adjacency pg_family;
/* Shapes of a family: the ball |x_j - c|, the cube max_k |x_jk - c_k|. */
enum { PG_RADIAL, PG_TENSOR };
/* Points of the cloud within `reach` (m) of each of n centres. Where the cloud has local spacings, point j
 * must be within reach * size[j] / h, measured by its metric where it has one: neighbourhood is then not
 * symmetric. closed: a distance of exactly `reach` counts (to 1e-9), else it does not. A point at a centre
 * belongs to its family. PG_E_MEMORY; PG_E_USAGE for positions that are not finite. */
pg_status pg_family_build (pg_family *out, const pg_cloud *cloud, size_t n, const double *centre,
                           double reach, int shape, int closed);
void      pg_family_clear (pg_family *family);
/* Families in two steps, for many centres or several sets of centres: pg_family_search_create sorts the
 * points once (borrows the cloud), pg_family_find lists the families of n centres on any number of threads,
 * with results that do not depend on it. */
typedef struct pg_family_search pg_family_search;
pg_status pg_family_search_create (pg_family_search **out, const pg_cloud *cloud, double reach, int shape,
                                   int closed);
void      pg_family_search_free   (pg_family_search **search);
pg_status pg_family_find (pg_family *out, const pg_family_search *search, size_t n, const double *centre,
                          int threads);

/* ---- what lies between two points ---------------------------------------------------------------------- */
/* Tests whether something that is not body lies between two points: a slot, a gap or the space between two
 * bodies, however narrow ("parted"). Thread-safe. */
typedef struct pg_between pg_between;
/* Prepares the test; *out NULL: no two points of this body can be parted, as in a single box. part: mesh of
 * the body, or one without elements. Borrows body and cloud, not the mesh. */
pg_status pg_between_create (pg_between **out, const pg_body *body, const pg_mesh_body *part,
                             const pg_cloud *cloud);
void      pg_between_free   (pg_between **between);
/* Returns 1: some points of this body may be parted by a slot or gap; 0: none can, whatever the points; -1:
 * the extent of the body is not known. */
int       pg_body_parts (const pg_body *body, const pg_mesh_body *part);
/* Collects the surfaces that a segment within a box (low, high: dim each, m) can meet; 0: no two points in it
 * are parted. */
enum { PG_OUTLOOK = 32 };
typedef struct { int n, all, member[PG_OUTLOOK]; } pg_outlook;
int       pg_between_look   (const pg_between *between, const double *low, const double *high,
                             pg_outlook *out);
/* Returns 1: the segment from x to y leaves the body through one face and re-enters through one of opposite
 * normal, or runs outside for more than half a spacing and is not the chord of a smooth surface. Symmetric in
 * x and y. outlook: of a box that holds both; NULL: of the whole body. */
int       pg_between_parted (const pg_between *between, const pg_outlook *outlook, const double *x,
                             const double *y);
/* Finds the first part of the segment from x to y, beyond the fraction `after` of it, that lies outside the
 * body: from out[0] to out[1], fractions of its length. 0: there is none; -1: there are too many to tell. */
int       pg_between_outside (const pg_between *between, const double *x, const double *y, double after,
                              double out[2]);
/* Start of the segments by which the visibility of points from x is tested (dim, m): x or, if x is outside
 * the body, the nearest position in it; pg_between_eye_of: that of point i of the cloud, which may be
 * slightly inside of a face. */
void      pg_between_eye    (const pg_between *between, const double *x, double *eye);
const double *pg_between_eye_of (const pg_between *between, size_t i);
/* Drops from families the nodes that something parts from their centres. eye: starts of the segments tested
 * (n x dim, m), NULL: the centres; own: the node that each centre is, -1: none; NULL: none is. *parted: how
 * many were dropped. between NULL: none are. */
pg_status pg_between_sift   (const pg_between *between, pg_family *family, const double *centre,
                             const double *eye, const int *own, int threads, size_t *parted);

/* ---- nearest point ------------------------------------------------------------------------------------- */
/* A k-d tree over copies of the points, for nearest-point searches. */
typedef struct pg_nearest pg_nearest;
/* Returns 1: the search for the nearest point skips this point. */
typedef int (*pg_refuse) (void *context, const double *place, size_t point);
/* Sorts copies of n points into the tree, O(n log n). PG_E_USAGE: there are none; PG_E_MEMORY. */
pg_status pg_nearest_create (pg_nearest **out, int dim, size_t n, const double *x /* n x dim, m */);
void      pg_nearest_free   (pg_nearest **nearest);
/* The nearest point that is not refused (refuse NULL: none is); of equally near ones the lowest number; -1:
 * all are refused. Thread-safe. */
long      pg_nearest_find   (const pg_nearest *nearest, const double *place, pg_refuse refuse, void *context);
/* All points that are as near as the nearest one up to `same` (m), at most PG_NEAREST_MOST of them: returns
 * how many; 0: all are refused. What is taken from the nearest point is the mean over these, so that neither
 * numbers nor rounding choose. Thread-safe. */
#define PG_NEAREST_MOST 16
size_t    pg_nearest_all    (const pg_nearest *nearest, const double *place, double same, pg_refuse refuse,
                             void *context, size_t *point /* PG_NEAREST_MOST */);
/* Number of points as near as the nearest up to `same` (m); refused ones count only where all are refused. */
size_t    pg_nearest_seen   (const pg_nearest *nearest, const double *place, double same, pg_refuse refuse,
                             void *context, size_t *point /* PG_NEAREST_MOST */);

/* Positions no further apart than this fraction of the local spacing count as equal. */
#define PG_NO_LENGTH 1e-6

/* ---- cracks -------------------------------------------------------------------------------------------- */
/* Kinds of cracks. */
enum { PG_CRACK_SEGMENT, PG_CRACK_POLYGON, PG_CRACK_DISC, PG_CRACK_OUTLINE };

/* A crack: a segment in 2D, a plane polygon or a disc in 3D; an outline in 2D, of a slot. */
typedef struct {
    int    kind;
    /* Segment: 2 x 2; outline: n x 2; polygon: n x 3; disc: a regular polygon of 64 vertices, for pictures.
     * m. */
    double *vertex; size_t nvertex;
    /* Centre and radius of a disc, m; unit normal of a crack of any kind. */
    double centre[3], normal[3], radius;
    /* How far from its tip or front the crack cuts no bonds, m: for the two ends of a segment, the edges of a
     * polygon (edge i from vertex i to the next), the rim of a disc; NULL: 0. Negative for a segment that
     * ends on the surface of the body: it cuts that far beyond its end. */
    double *retreat;
    /* 1: points within `width` (m) of the crack's line or plane count as on the side to which the normal
     * points (left of a segment) and keep their bonds to that side. 0: such points lose the bonds to both
     * sides. Cracks that grow are sided, and cracks of the scene if contact is modelled. */
    int    sided;
    double width;
    /* Width of a slot, m: so much material is missing, half on each side; 0: the crack is sharp. */
    double slot;
    /* entry: index of the entry in `cracks` of the scene; bend: 1: the segment continues a polyline at its
     * first vertex. */
    size_t entry;
    int    bend;
    /* Random networks: number of cracks drawn before this one that were rejected as they fitted nowhere. */
    int    vain;
} pg_crack;
/* Several cracks. box: bounding box of the part of each crack that cuts, low then high coordinates (n x 2
 * dim, m); order: the cracks in a spatial order (n); block: bounding boxes of groups of PG_CRACK_GROUP
 * consecutive cracks in that order, of groups of groups, and so on (2 dim values each, n at most). This index
 * (pg_cracks_index) speeds up searches and changes no result. NULL: no index. */
enum { PG_CRACK_GROUP = 8 };
typedef struct {
    int dim;  pg_crack *crack;  size_t n;
    double *box, *block;  size_t *order, room;         /* room: capacity of box, block, order */
} pg_cracks;
/* Reads the sharp cracks of `cracks`. Each entry must meet the body; what is wrong is a fault of the
 * scene. */
pg_status pg_cracks_read  (pg_cracks *out, const pg_scene *scene);
/* Reads the slots: cracks with a width, and outlines. The body lacks their material (pg_body_read); bonds
 * that cross the middle of a slot, or pass through an outline, are cut, so that a slot narrower than the
 * horizon parts its sides too. Slots have no tips. */
pg_status pg_slots_read   (pg_cracks *out, const pg_scene *scene);
int       pg_crack_is_slot (const pg_crack *crack);
/* Length (2D, m) of a crack's centre line or area (3D, m^2) of its middle plane; of an outline the length of
 * its longest axis. */
double    pg_crack_size    (const pg_crack *crack, int dim);
/* Reads all sharp cracks and slots of `cracks`, in the order of the scene; no index. */
pg_status pg_network_read (pg_cracks *out, const pg_scene *scene);
/* Statistics of a network of cracks. */
typedef struct {
    /* Number of cracks (a polyline counts once); of these: slots, cracks that touch or cross another (slots
     * by their centre lines), that reach out of the body, that lie outside; and of random cracks that were
     * rejected because they fitted nowhere. */
    size_t n, slots, crossing, leaving, outside, vain;
    /* Length of all cracks (2D), m, or their area (3D), m^2; the part of it in the body; area (2D), m^2,
     * or volume (3D), m^3, of the slots, overlaps counted twice, and of the body without slots (0: not
     * known). */
    double size, inside, removed, body;
    /* Length of a crack (2D; 3D: the largest distance of two corners), m: mean, standard deviation, least,
     * largest. */
    double mean, deviation, least, most;
    /* Mean axis of the cracks (3D: of their normals), and degree of alignment with it: 0 none, 1 full. */
    double axis[3], order;
    /* Least distance of two cracks (slots: of their middles), m; INFINITY: there is one only. */
    double nearest;
} pg_network;
/* Measures the cracks that a scene gives (pg_network_read). The body is sampled on a lattice of at least 2e5
 * places where its size is not known in closed form, and cracks at 200 places each. */
pg_status pg_network_measure (pg_network *out, const pg_cracks *all, const pg_scene *scene);
/* Writes cracks as a table that `cracks: [{file: ...}]` reads back as the same bits, in m; mixed kinds
 * (segments, polylines, outlines; discs, polygons) go to one file each: NAME.csv, NAME_polygon.csv. said:
 * called with the name of each file (NULL: not called). PG_E_FILE. */
pg_status pg_cracks_write (const pg_cracks *all, const char *path,
                           void (*said) (void *context, const char *name), void *context);
void      pg_cracks_clear (pg_cracks *cracks);
/* Bounding box of the part of one crack that cuts (low, high: 2 dim, m), as in pg_cracks.box. */
void      pg_crack_box (const pg_crack *crack, int dim, double *box);
/* Makes the index (box, block, order); to be called again when a crack was added or changed.
 * pg_cracks_copy_index copies that of equal cracks, without allocation where `room` suffices. */
pg_status pg_cracks_index       (pg_cracks *cracks);
pg_status pg_cracks_copy_index  (pg_cracks *to, const pg_cracks *from);
void      pg_cracks_clear_index (pg_cracks *cracks);
/* Sets the unit normal of a segment, to the left of the direction from its first vertex to the second. */
void      pg_crack_orient (pg_crack *segment);
/* Returns 1: the bond x - y (m) meets the crack, less the strips along its tips and fronts given by
 * `retreat`. A touch within `tolerance` (m) counts. Symmetric in x and y. */
int pg_crack_cuts (const pg_crack *crack, int dim, const double *x, const double *y, double tolerance);
/* Finds the point of the 2D segment a - b nearest to x: returns its position as a fraction of a - b, 0 to 1;
 * place: the point (2, m); distance: from x, m. NULL: not wanted. */
double pg_segment_nearest (const double *a, const double *b, const double *x, double *place,
                           double *distance);
/* Returns 1: x (m) lies on the crack within the tolerance (m), also where it counts as on one side
 * (sided). */
int pg_crack_touches (const pg_crack *crack, int dim, const double *x, double tolerance);
/* Returns 0: by the bounding boxes of the cracks none can cut a bond inside this box (low, high: dim, m);
 * else 1. */
int pg_cracks_near (const pg_cracks *cracks, const double *low, const double *high);
/* First crack that the bond x - y meets, or (pg_cracks_touch) on which x lies, within `tolerance` (m); NULL:
 * none. */
const pg_crack *pg_cracks_cut (const pg_cracks *cracks, const double *x, const double *y,
                               double tolerance);
const pg_crack *pg_cracks_touch (const pg_cracks *cracks, const double *x, double tolerance);
PG_API_END
#endif

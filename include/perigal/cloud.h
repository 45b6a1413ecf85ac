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
 * space with a thickness, which a crack with a width takes from the body. */
enum { PG_BOX, PG_DISK, PG_CYLINDER, PG_SPHERE, PG_POLYGON, PG_PRISM, PG_MESH, PG_ALPHA_SHAPE, PG_STAIRS,
       PG_PLATE, PG_FACETED };

/* A shape that is added to or subtracted from the body. */
typedef struct {
    /* add: 1: added, 0: subtracted. */
    int    kind, add;
    /* Name of its surface for `sets: {boundary: NAME}`: the one given by `name:`, else "rim" (round,
     * added), "hole" (subtracted) or "side". */
    char   boundary[32];
    /* Corners of a box; of a prism, which extends along z, only z. m. */
    double low[3], high[3];
    /* Disk and sphere: centre and radius. Cylinder: centre of one end, unit axis from there, length,
     * radius. m. */
    double centre[3], axis[3], radius, length;
    /* Polygon, prism: vertices x, y (nvertex x 2), m. */
    double *vertex; size_t nvertex;
    /* Mesh, alpha shape: elements and their surface. Stairs: the cells of a lattice. */
    struct pg_solid *solid;
    /* Plate: `vertex` in its plane, from `centre` along `along` and axis x along (unit vectors); half of
     * `length` on each side. */
    double along[3];
    /* 1: a crack with a width (pg_slots_read), whose surface is called "slot"; then its box (2 x 3), m. */
    int    slot;  double box[6];
} pg_shape;

/* A fictitious boundary layer: a box of whole lattice cells over one face of the bounding box of the
 * shapes, outside of it (doc/method.md B3). It covers the whole face, or its part from the first to the
 * last place along each axis below which, half a cell deep, the body lies. */
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
 * and `layers` (a list of {name, side, thickness, over}).
 * Layers become whole cells of the lattice that pg_lattice_fit lays over the body without them at the
 * scene's spacing, round (thickness / step) of them. What is wrong is a fault of the scene: PG_E_SCENE. */
pg_status pg_body_read  (pg_body *out, const pg_scene *scene);
/* The layer that x lies in, beyond its face by more than `margin` (m); -1: none. */
long      pg_body_layer (const pg_body *body, const double *x, double margin);
void      pg_body_clear (pg_body *body);
/* Does x lie in the body? Shapes act in their order; a position within `tolerance` (m) of a surface is
 * inside. */
int       pg_body_inside (const pg_body *body, const double *x, double tolerance);
/* What rounding leaves unknown of places within a box, m: four units in the last place of its largest
 * coordinate. Far from the origin it is more than any share of the spacing that tolerances take. */
double    pg_rounding (int dim, const double *low, const double *high);
/* Index of the shape whose surface is nearest to x, and its distance (m; may be NULL). */
size_t    pg_body_nearest (const pg_body *body, const double *x, double *distance);
/* What the scene calls this kind: "box", "disk" ... */
const char *pg_shape_kind (const pg_shape *shape);
/* Volume (2D: area) and surface (2D: length) in closed form, without thickness; 0: known for one shape
 * only. */
int       pg_body_measure (const pg_body *body, double *volume, double *surface);
/* Number of shapes that consist of elements: PG_MESH and PG_ALPHA_SHAPE; is this one? The side sets of meshes
 * name parts of their surface: does the face nearest to x belong to the side set `side`? Name k of these,
 * NULL: there are no more. */
size_t      pg_body_meshes   (const pg_body *body);
int         pg_shape_meshed  (const pg_shape *shape);
int         pg_shape_on_side (const pg_shape *shape, const double *x, const char *side);
const char *pg_shape_side    (const pg_shape *shape, size_t k);
/* Does this face of an element, sides numbered from 0, belong to the side set? */
int         pg_shape_face_on_side (const pg_shape *shape, int element, int at, const char *side);

/* ---- alpha shapes -------------------------------------------------------------------------------------- */
/* The shape of a set of points: all triangles (2D) or tetrahedra (3D) of their Delaunay triangulation whose
 * circumscribed circle or sphere has a radius of at most alpha (Edelsbrunner and Muecke 1994, doi
 * 10.1145/174462.156635). Its surface passes through points. A ball of radius alpha finds room in every hole
 * and beside every concave corner that the shape has. */
typedef struct {
    int     dim;
    /* The radius in use, m. */
    double  alpha;
    /* Volume (2D: area) of the simplices, m^dim, and the size of the space per point, m: the volume over the
     * number of points, each counted by the part of the full angle about it that lies in the shape. On a
     * lattice this is its step. */
    double  volume, spacing;
    /* Parts that share no face with each other; regions outside that the shape encloses (2D: holes, 3D:
     * cavities; a hole through a solid encloses none). */
    size_t  parts, holes;
    /* Points that repeat an earlier one, and points that belong to no simplex of the shape (they lie
     * outside, or a line or a lone point of them); the first of these as given, -1: none. */
    size_t  twins, loose;
    long    first_loose;
    /* Automatic alpha: largest over median radius that points need to belong to the shape; 0: alpha was
     * given. */
    double  uneven;
    /* By how much the shape in a scene is grown (key rim): it is all places within this distance, m. */
    double  rim;
    /* The simplices, TRI3 or TET4, neighbours sharing faces. Nodes are the points without repetitions;
     * node_id: their number as given, from 1. */
    pg_mesh mesh;
} pg_alpha_shape;
/* The alpha shape of n points x (n x dim, m) in two or three dimensions. alpha, m; 0: 1.5 times the least
 * radius for which every point is a corner of the shape. PG_E_USAGE, in words: fewer than dim + 1
 * different points, all on one line or plane, coordinates that are not finite; alpha given, but smaller
 * than every radius; alpha automatic, but one point needs more than 30 times the median radius. PG_E_FILE:
 * Qhull is not installed; PG_E_LIMIT: it could not triangulate the points; PG_E_MEMORY. */
pg_status pg_alpha_shape_create (pg_alpha_shape *out, int dim, size_t n, const double *x, double alpha);
void      pg_alpha_shape_clear  (pg_alpha_shape *shape);
/* The alpha shape that a shape of kind PG_ALPHA_SHAPE holds, borrowed; NULL: the shape is of another kind. */
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
    /* Where it is the part of a larger lattice that a rank holds (perigal/ranks.h): its first cell there, and
     * the counts and corners of that lattice. whole[0] = 0: it is none. */
    int    first[3], whole[3];
    double whole_origin[3], whole_high[3];
} pg_lattice;
/* Lays a lattice over the body. offset: shift in fractions of a step, or NULL. PG_E_LIMIT: more cells than
 * an int can number. */
pg_status pg_lattice_fit (pg_lattice *out, const pg_body *body, double spacing,
                          const double *offset /* fraction of a step or NULL */);
/* Of a lattice that pg_lattice_fit would make, the cells `part` alone, which then are its cells from 0 on, at
 * the same places to the last bit. part NULL: the counts, corners and steps of all of it, `in` left out. */
pg_status pg_lattice_fit_part (pg_lattice *out, const pg_body *body, double spacing, const double *offset,
                               const pg_box *part);
void      pg_lattice_clear (pg_lattice *lattice);
/* The cell beyond this side of the lattice at index i (one of them outside 0 .. count - 1) belongs to the
 * lattice that it is a part of: 1; 0: nothing is there. */
int       pg_lattice_goes_on (const pg_lattice *lattice, const int *i);
/* Coordinate (m) of vertex i along an axis; i + 0.5: of a cell's centre. Corners are exact, and the
 * coordinates are symmetric about the middle to the last bit. */
double    pg_lattice_at    (const pg_lattice *lattice, int axis, double i);
/* 1 on one rank only, whose subdomain has the cell around x, m, or on all if there are no ranks (NULL). */
int       pg_lattice_owns (const pg_lattice *lattice, const pg_subdomain *subdomain, const double *x);
/* The number of the cell around x, m, in the whole lattice (x fastest), also where this is a part of it. */
int64_t   pg_lattice_cell (const pg_lattice *lattice, const double *x);
/* The cells of the whole lattice around the points that a rank owns, with so wide a layer beyond them, m. */
pg_box    pg_subdomain_cells (const pg_subdomain *subdomain, const pg_lattice *lattice, double width);
/* A centre as near to the surface as this lies on it, m. */
double    pg_lattice_tolerance (const pg_lattice *lattice);
/* A mesh or an alpha shape as a lattice sees it: every position in a cell is inside or outside as its
 * centre is. */
pg_status pg_stairs_create (pg_shape *out, const pg_shape *mesh, const pg_lattice *lattice);
void      pg_stairs_clear  (pg_shape *stairs);
/* 1: of cell i and the one beyond its face (-x +x -y +y -z +z) one is inside and the other is not. */
int       pg_stairs_step   (const pg_shape *stairs, const int *i, int face);

/* ---- surfaces of flat pieces --------------------------------------------------------------------------- */
/* The surface of a mesh or an alpha shape as flat pieces: segments in 2D, triangles in 3D. Straight faces are
 * taken as they are, curved ones are divided into pieces no longer than 3/4 of a step of the lattice, whose
 * corners lie on the face. Pieces that touch along an edge, lie in one plane and belong to the same side
 * sets form a region, so that a plane side of a body is one region however its mesh is divided. */
typedef struct {
    int     dim;
    /* Number of pieces, their corners (n x dim x dim, m), in an order that makes their normals point out of
     * the shape, and the region of each (n). */
    size_t  n;
    double *x;
    int    *region;
    /* Number of regions; a place on each and its unit normal (nregion x 2 dim); the coordinate axis that it
     * is normal to, exactly, else -1; element and side of one of its faces (nregion each). */
    size_t  nregion;
    double *plane;
    int    *axis, *element, *side;
    /* Pieces of region r: piece[first[r]] .. piece[first[r + 1] - 1]. */
    size_t *first;  int *piece;
    /* Where region r ends: edges edge_first[r] .. edge_first[r + 1] - 1, two places each (2D: places). m. */
    size_t *edge_first;  double *edge;
    /* For rays along each axis: the pieces that they may meet, in columns as wide as the cells of this
     * lattice. */
    pg_lattice lattice;
    size_t *column_first[3];  int *column[3];
} pg_facets;
/* A mesh, or an alpha shape without a rim, by flat pieces of its surface. PG_E_MEMORY, PG_E_LIMIT. */
pg_status pg_faceted_create (pg_shape *out, const pg_shape *mesh, const pg_lattice *lattice);
/* 1: cells see this shape as whole boxes, as an alpha shape with a rim has no such pieces. */
int       pg_shape_stepped (const pg_shape *shape);
/* The pieces of such a shape; NULL: it is none. */
const pg_facets *pg_shape_facets (const pg_shape *shape);
/* Is x enclosed by the pieces? Counted along a ray, with the sense in which it meets them. */
int       pg_facets_inside (const pg_facets *facets, const double *x);
/* Does a line through x along this axis, which the plane of the region does not contain, meet a piece of the
 * region? */
int       pg_facets_meets  (const pg_facets *facets, int region, const double *x, int axis);
/* Where the line through x along the axis meets the pieces, ascending, with the sense of their normals there
 * (+1 along the axis); room for `most` of them. Returns how many; -1: too many, or too near to an edge. */
int       pg_facets_line   (const pg_facets *facets, const double *x, int axis, int most, double *at,
                            int *sense);

/* ---- points -------------------------------------------------------------------------------------------- */
/* The points. */
typedef struct {
    int     dim;
    size_t  n;
    /* Positions, m (n x dim). */
    double *x;
    /* Volumes, m^3 (n). */
    double *volume;
    /* Number of the block, 0 unless given (n). */
    int    *block;
    /* Local spacing, m (n); NULL: h everywhere. Of supports that are stretched as the elements are: along the
     * longest axis. */
    double *size;
    /* How stretched supports measure a bond z from their point: by sqrt (z' A z), A symmetric, its least
     * eigenvalue 1, so that each support lies in the ball of its spacing (n x dim x dim); NULL: they are
     * balls, A = 1. Only beside `size`, and only for families of shape PG_RADIAL. */
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
    /* Bounding box of the points, m; of the points of all ranks. */
    double  low[3], high[3];
    /* Which of the points this rank owns, where ranks share the run (perigal/ranks.h); NULL: alone. */
    pg_subdomain *subdomain;
    /* Columns of the file of points that are not used: "id", "id, label"; "": there are none. */
    char    passed[64];
    /* What parts the points; NULL: nothing. Borrowed. */
    const struct pg_between *between;
} pg_cloud;
/* A cloud may be a part of the points of a body, with ghosts of those around it; the other parts are with
 * other ranks, who all make the same calls. 1: the point counts here; ghosts count where they are owned. */
static inline int pg_cloud_owns (const pg_cloud *c, size_t point) { return pg_owns (c->subdomain, point); }
/* The number of a point among all points of the body; how many these are. */
static inline size_t pg_cloud_number (const pg_cloud *c, size_t point)
{
    return c->subdomain ? (size_t) c->subdomain->number[point] : point;
}
static inline size_t pg_cloud_total (const pg_cloud *c)
{
    return c->subdomain ? (size_t) c->subdomain->total : c->n;
}
/* Sum, or largest, over all parts of each of n numbers, in place. */
static inline pg_status pg_cloud_sum (const pg_cloud *c, size_t n, double *value)
{
    return c->subdomain ? pg_ranks_sum (n, value) : PG_OK;
}
static inline pg_status pg_cloud_most (const pg_cloud *c, size_t n, double *value)
{
    return c->subdomain ? pg_ranks_most (n, value) : PG_OK;
}
/* Points of the scene. On a lattice (`lattice: nodes` or `cells`): the vertices of the cells whose centre
 * lies in the body, each with an equal share of the volume of its cells, or the centres of these cells;
 * then perturbed reproducibly, but only points with kept cells all around. Or read from `points: FILE`; the
 * lattice is empty then (dim = 0). PG_E_SCENE, PG_E_MEMORY. */
pg_status pg_cloud_build (pg_cloud *out, pg_lattice *lattice, const pg_body *body, const pg_scene *scene);
/* Points of the scene for the subdomain of this rank, with a layer of ghosts of `width` (m) around it: only
 * these and their part of the lattice are made (out->subdomain). Without ranks, and of points of a file,
 * which pg_cloud_divide divides, it makes all points, as pg_cloud_build. */
pg_status pg_cloud_build_part (pg_cloud *out, pg_lattice *lattice, const pg_body *body, const pg_scene *scene,
                               double width);
/* Of points that no lattice gives, all of which every rank has read: who owns each (pg_free), by recursive
 * bisection of their coordinates, and cloud->subdomain of this rank, with a layer of ghosts of `width` (m)
 * where the spacing is the nominal one, wider where it is larger. The cloud still has all points: then
 * pg_cloud_keep drops those that are not held. PG_E_LIMIT: more ranks than points. */
pg_status pg_cloud_divide (pg_cloud *cloud, double width, int **owner);
void      pg_cloud_keep   (pg_cloud *cloud);
/* 1 on one rank only: that which owns the point nearest to the place (m), of several the lowest. *here: 1, 0;
 * not below 0: it was found before, and stays. All ranks call. */
pg_status pg_cloud_has_nearest (const pg_cloud *cloud, const double *place, signed char *here);
/* What a rank holds of a body that is divided. */
typedef struct {
    double owned, ghosts;                              /* points */
    int    neighbours;                                 /* ranks that it exchanges values of ghosts with */
    double sent;                                       /* points, as often as each is sent to one of them */
} pg_part_size;
/* What pg_cloud_build_part or pg_cloud_divide would give each of `size` ranks, found by one process: out
 * (size). PG_E_LIMIT: the body cannot be divided among so many. */
pg_status pg_cloud_parts (pg_part_size *out, const pg_body *body, const pg_scene *scene, double width,
                          int size);
/* Nominal spacing of the points of a scene, m, before they are built (pg_cloud.h). */
pg_status pg_cloud_spacing (double *h, const pg_body *body, const pg_scene *scene);
void      pg_cloud_clear (pg_cloud *cloud);
/* Local spacing of point i over the nominal one: the support of node i is `horizon` times this. Exactly 1
 * where size is NULL or equals h. */
double    pg_cloud_ratio (const pg_cloud *cloud, size_t i);
/* The squared length of a bond z (dim, m) as the support of point i measures it, m^2. */
double    pg_cloud_length2 (const pg_cloud *cloud, size_t i, const double *z);
/* How much longer than wide the support of point i is, at least: sqrt (trace A / dim), 1 for a ball. */
double    pg_cloud_slender (const pg_cloud *cloud, size_t i);
/* Smallest local spacing, m. */
double    pg_cloud_finest (const pg_cloud *cloud);
/* Places nearer than this are the same, m: 1e-9 spacings, and the rounding of the points. */
double    pg_cloud_same (const pg_cloud *cloud);
/* Into how many equal parts of at most `most` (m) a length is divided, one at least; what exceeds a whole
 * number of them by rounding alone is no part more. */
size_t    pg_cloud_pieces (const pg_cloud *cloud, double length, double most);

/* ---- points of a mesh ---------------------------------------------------------------------------------- */
/* The body as a mesh; mesh.n = 0: the scene has none. */
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
    /* Worst scaled Jacobian at a corner of any element, seen with straight edges: 1 best, 0 flat. */
    double  quality;
    /* The element that has it. */
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
/* Index of the block of that name, or else of that number; -1: there is none. The second function writes
 * all names, separated by |. */
int       pg_mesh_body_block  (const pg_mesh *mesh, const char *name);
void      pg_mesh_body_blocks (const pg_mesh *mesh, char *out, size_t size);

/* ---- families ------------------------------------------------------------------------------------------ */
/* The nodes that each of n centres sees. */
typedef pg_adjacency pg_family;
/* Shapes of a family: the ball |x_j - c|, the cube max_k |x_jk - c_k|. */
enum { PG_RADIAL, PG_TENSOR };
/* Points of the cloud within `reach` (m) of each of n centres. Where the cloud has local spacings, point j
 * must be within reach * size[j] / h, in its own measure where it has one: a node may then see another that
 * does not see it. closed: a distance
 * of exactly `reach` counts (to 1e-9), else it does not. A point at a centre belongs to its family.
 * PG_E_MEMORY; PG_E_USAGE for positions that are not finite. */
pg_status pg_family_build (pg_family *out, const pg_cloud *cloud, size_t n, const double *centre,
                           double reach, int shape, int closed);
void      pg_family_clear (pg_family *family);
/* Families in two steps, for many centres or several lots of them: create sorts the points once, find lists
 * the families of n centres by any number of threads, always the same ones. The search borrows the cloud. */
typedef struct pg_family_search pg_family_search;
pg_status pg_family_search_create (pg_family_search **out, const pg_cloud *cloud, double reach, int shape,
                                   int closed);
void      pg_family_search_free   (pg_family_search **search);
pg_status pg_family_find (pg_family *out, const pg_family_search *search, size_t n, const double *centre,
                          int threads);

/* ---- what lies between two points ---------------------------------------------------------------------- */
/* Answers whether two places of a body are parted by what is not body: by a slot, a gap or the room to
 * another body, however narrow. Thread-safe. */
typedef struct pg_between pg_between;
/* NULL: nothing can part any two places of this body, as of one box. part: the body as a mesh, or one without
 * elements. Borrows body and cloud, not the mesh. */
pg_status pg_between_create (pg_between **out, const pg_body *body, const pg_mesh_body *part,
                             const pg_cloud *cloud);
void      pg_between_free   (pg_between **between);
/* 0: nothing can, whatever the points; -1: where the body lies is not known. */
int       pg_body_parts (const pg_body *body, const pg_mesh_body *part);
/* What can be met within a box (dim each, m); 0: nothing parts any two places in it. */
enum { PG_OUTLOOK = 32 };
typedef struct { int n, all, member[PG_OUTLOOK]; } pg_outlook;
int       pg_between_look   (const pg_between *between, const double *low, const double *high,
                             pg_outlook *out);
/* 1: the segment from x to y leaves the body through one face and comes back through one that looks the other
 * way, or runs outside for more than half a spacing and is not the chord of a smooth surface. The same for y
 * and x. outlook: of a box that holds both; NULL: of the whole body. */
int       pg_between_parted (const pg_between *between, const pg_outlook *outlook, const double *x,
                             const double *y);
/* The first stretch of the segment from x to y, behind the share `after` of it, that lies outside the body:
 * out[0] to out[1], shares of the segment. 0: there is none; -1: there are too many to tell. */
int       pg_between_outside (const pg_between *between, const double *x, const double *y, double after,
                              double out[2]);
/* Where a place looks from: itself or, outside the body, the nearest place in it; where point i of the cloud
 * does, which may be a little way inside of a face. */
void      pg_between_eye    (const pg_between *between, const double *x, double *eye);
const double *pg_between_eye_of (const pg_between *between, size_t i);
/* Drops from families those nodes that their centres do not see. eye: where these look from (n x dim), NULL:
 * from where they are; own: the node that each is, -1: none; NULL: none is. *parted: how many were dropped.
 * between NULL: none. */
pg_status pg_between_sift   (const pg_between *between, pg_family *family, const double *centre,
                             const double *eye, const int *own, int threads, size_t *parted);

/* ---- nearest point ------------------------------------------------------------------------------------- */
/* A k-d tree over copies of the points, for nearest-point searches. */
typedef struct pg_nearest pg_nearest;
/* Says whether a point does not count: 1: it is passed over. */
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

/* Positions no further apart than this part of the local spacing are at one place. */
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
    /* Centre and radius of a disc, m; unit normal of any kind. */
    double centre[3], normal[3], radius;
    /* How far from its tip or front the crack cuts no bonds, m: for the two ends of a segment, the edges of
     * a polygon (edge i from vertex i to the next), the rim of a disc; NULL: 0. Of a segment also negative:
     * so far beyond its end it cuts, where that lies on the surface of the body. */
    double *retreat;
    /* 1: a place within `width` (m) of its line or plane counts as on the side that the normal points to (of
     * a segment its left), so that points there keep their bonds to that side. 0: such points lose the bonds
     * to both sides. Cracks that grow are sided, cracks of the scene where contact is asked for. */
    int    sided;
    double width;
    /* Width of a slot, m: so much material is missing, half on each side; 0: the crack is sharp. */
    double slot;
    /* Index of the scene's entry in `cracks`; 1: it goes on a polyline at its first vertex. */
    size_t entry;
    int    bend;
    /* Of a random network: how many cracks were drawn before this one that fitted nowhere. */
    int    vain;
} pg_crack;
/* Several cracks. box: of each crack, as far as it cuts, the low and then the high coordinates (n x 2 dim,
 * m); order: the cracks so that neighbours lie near each other (n); block: the boxes of PG_CRACK_GROUP cracks
 * that follow each other in that order, of as many such blocks, and so on (2 dim values each, n at most).
 * With these (pg_cracks_index) questions to many cracks look only at those near by; the answers are the same.
 * NULL: without. */
enum { PG_CRACK_GROUP = 8 };
typedef struct {
    int dim;  pg_crack *crack;  size_t n;
    double *box, *block;  size_t *order, room;         /* room: how many cracks the three can hold */
} pg_cracks;
/* Reads the sharp cracks of `cracks`. Each entry must meet the body; what is wrong is a fault of the
 * scene. */
pg_status pg_cracks_read  (pg_cracks *out, const pg_scene *scene);
/* Reads the slots: cracks with a width, and outlines. The body lacks their material (pg_body_read); bonds
 * that cross the middle of a slot, or pass through an outline, are cut, so that a slot narrower than the
 * horizon parts its sides too. Slots have no tips. */
pg_status pg_slots_read   (pg_cracks *out, const pg_scene *scene);
int       pg_crack_is_slot (const pg_crack *crack);
/* Length (2D) or area (3D) of its middle, m or m^2; an outline has the length of its longest axis. */
double    pg_crack_size    (const pg_crack *crack, int dim);
/* Everything of `cracks`, in the order of the scene; no index. */
pg_status pg_network_read (pg_cracks *out, const pg_scene *scene);
/* What a network amounts to. */
typedef struct {
    /* Cracks, a polyline being one; how many are slots, how many touch or cross another (slots by their
     * middles), how many reach out of the body, how many lie outside; and how many of random networks were
     * drawn in vain, because they fitted nowhere. */
    size_t n, slots, crossing, leaving, outside, vain;
    /* Length of all cracks (2D), m, or their area (3D), m^2; the part of it in the body; area (2D), m^2,
     * or volume (3D), m^3, of the slots, overlaps counted twice, and of the body without slots (0: not
     * known). */
    double size, inside, removed, body;
    /* Length of a crack (2D; 3D: the largest distance of two corners), m: mean, standard deviation, least,
     * largest. */
    double mean, deviation, least, most;
    /* Axis along which the cracks (3D: their normals) lie on the mean, and how far: 0 in all directions, 1
     * all along it. */
    double axis[3], order;
    /* Least distance of two cracks (slots: of their middles), m; INFINITY: there is one only. */
    double nearest;
} pg_network;
/* Measures the cracks that a scene gives (pg_network_read). The body is sampled on a lattice of at least 2e5
 * places where its size is not known in closed form, and cracks at 200 places each. */
pg_status pg_network_measure (pg_network *out, const pg_cracks *all, const pg_scene *scene);
/* Writes cracks as a table that `cracks: [{file: ...}]` reads back as the same bits, in m; where kinds are
 * mixed (segments, polylines, outlines; discs, polygons), each in a file of its own: NAME.csv,
 * NAME_polygon.csv. said: is given each name (NULL: nobody is). PG_E_FILE. */
pg_status pg_cracks_write (const pg_cracks *all, const char *path,
                           void (*said) (void *context, const char *name), void *context);
void      pg_cracks_clear (pg_cracks *cracks);
/* The box of one crack, as above. */
void      pg_crack_box (const pg_crack *crack, int dim, double *box);
/* Makes box, block and order: to be called again when a crack was added or changed. copy: those of the same
 * cracks elsewhere; it needs no memory where there is room for them. */
pg_status pg_cracks_index       (pg_cracks *cracks);
pg_status pg_cracks_copy_index  (pg_cracks *to, const pg_cracks *from);
void      pg_cracks_clear_index (pg_cracks *cracks);
/* Unit normal of a segment, on the left of the direction from its first vertex to the second. */
void      pg_crack_orient (pg_crack *segment);
/* Does the bond x - y meet the crack, less the strips along its tips and fronts that `retreat` gives? A
 * touch within `tolerance` (m) counts. The answer for y - x is the same. */
int pg_crack_cuts (const pg_crack *crack, int dim, const double *x, const double *y, double tolerance);
/* The place of the segment a - b in the plane that is nearest to x: its share of the way from a to b, 0 to 1;
 * where it is (2 numbers) and how far from x, m. NULL: not wanted. */
double pg_segment_nearest (const double *a, const double *b, const double *x, double *place,
                           double *distance);
/* Does x lie on the crack, within the tolerance, whichever side it counts to? */
int pg_crack_touches (const pg_crack *crack, int dim, const double *x, double tolerance);
/* 0: no crack can cut a bond inside this box (low, high: dim), as its boxes tell; else 1. */
int pg_cracks_near (const pg_cracks *cracks, const double *low, const double *high);
/* First of the cracks that the bond x - y meets, or on which x lies, within `tolerance` (m); NULL: none. */
const pg_crack *pg_cracks_cut (const pg_cracks *cracks, const double *x, const double *y,
                               double tolerance);
const pg_crack *pg_cracks_touch (const pg_cracks *cracks, const double *x, double tolerance);
PG_API_END
#endif

/* SPDX-License-Identifier: GPL-3.0-or-later
 * compare.h: compares a result with references: closed forms, tables of values at points, finite element
 * results, other results. Whatever is to be compared is a sampler, which returns displacement and stress at
 * any position; norms, tables and pictures of differences are written for samplers only, so every kind can be
 * compared with every other.
 *
 * Arrays of displacements have three components per place and arrays of stresses six (xx yy zz xy yz zx),
 * whatever the dimension; what is unknown is NAN. Lengths are m, stresses Pa. */
#ifndef PERIGAL_COMPARE_H
#define PERIGAL_COMPARE_H
#include "perigal/mesh.h"
#include "perigal/output.h"
#include "perigal/solve.h"

PG_API_BEGIN

/* ---- samplers ------------------------------------------------------------------------------------------ */
/* A field of displacement and stress. `sample` takes n places x (n x dim, m) and fills u (n x
 * 3, m; 0 beyond dim) and stress (n x 6, Pa; or NULL: not wanted); unknown values become NAN.
 * A sampler borrows what it was made of (problem, state, force); pg_sampler_clear frees what
 * it allocated itself. */
typedef struct {
    void *context;
    int   dim;
    /* Bit masks: bit k is set if component k of displacement, of stress is known at all. */
    int   displacement, stress;
    pg_status (*sample) (void *context, size_t n, const double *x, double *u, double *stress);
    /* Frees the context; NULL: nothing to free. */
    void (*free) (void *context);
} pg_sampler;
/* Frees what the sampler owns and sets it to zero; a zero sampler is allowed. */
void      pg_sampler_clear    (pg_sampler *sampler);
/* Makes a sampler of a state of a force model. Forces that have shape functions sample with these
 * (pg_force_type.sample); for others a least squares fit through the displacements of the points is used. */
pg_status pg_sampler_solution (pg_sampler *out, const pg_problem *problem, const pg_force_type *force,
                               void *self, const pg_state *state);
/* Makes a sampler of displacements at the points (u: n x dim, m; copied): between them a moving least squares
 * fit with a linear basis; stress from the gradient of the fit and the material of the nearest evaluation
 * point. Neighbours behind a pre-crack of the problem do not take part. torn (n, or NULL) marks points that
 * have lost bonds during the run: a position with one within its support gets the displacement of the nearest
 * point and no stress. */
pg_status pg_sampler_points (pg_sampler *out, const pg_problem *problem, const double *u,
                             const unsigned char *torn);
/* Makes a sampler of a finite element result of the same body (see pg_mesh_result): displacement by its shape
 * functions, stress from their gradients and the problem's materials. `unit` turns lengths and displacements
 * of the file into m. A plane result that was computed with one layer of 3D elements becomes plane. A place
 * outside all elements takes the value of the nearest element up to 0.25 element sizes away; beyond that it
 * is unknown. PG_E_FILE: other dimension, or no displacement in the file. */
pg_status pg_sampler_mesh (pg_sampler *out, const char *path, int step, double unit,
                           const pg_problem *problem);
/* The mesh of a sampler by pg_sampler_mesh, in m; NULL for others. outside and away (each may be NULL): how
 * many of the positions sampled so far lay outside the elements, and the farthest distance in element
 * sizes. */
const pg_mesh *pg_sampler_mesh_of (const pg_sampler *sampler, size_t *outside, double *away);
/* Gauss points and weights of all elements of a mesh: x (n x dim, m), weights (m3; plane
 * elements times `thickness`, m), and the element of each point in `cell`. */
pg_status pg_mesh_quadrature  (pg_quadrature *out, const pg_mesh *mesh, double thickness, int order);
/* Makes a sampler of the field of `sampler` moved by shift (3, m) and multiplied by factor; takes ownership
 * of `sampler` and sets it to zero. */
pg_status pg_sampler_moved    (pg_sampler *out, pg_sampler *sampler, const double *shift, double factor);

/* ---- results of runs ----------------------------------------------------------------------------------- */
/* A result folder opened in order to sample it: the problem, built anew from the copy of the
 * scene in it, with the unknowns of one step of its result.e. */
typedef struct {
    pg_scene   *scene;
    pg_problem *problem;
    const pg_force_type *force;  void *self;
    pg_state   *state;
    /* Sampler of the field of the step; NAN farther than sqrt (dim) spacings from the nearest point. */
    pg_sampler  sampler;
    /* t: the variable t of expressions (s, or a load factor); stamp: time of the step as stored in
     * result.e. */
    double      t, stamp;
    int         step;
    /* Interpolation of the field between the points, in words: "by its own shape functions", or what replaces
     * them and why. */
    char        how[200];
} pg_stored;
/* Opens step `step` of a folder, -1 for the last one. PG_E_FILE: the points in the folder are
 * not those that its scene makes; PG_E_USAGE: no such step, or a missing field, with the
 * remedy in the message. */
pg_status pg_stored_open (pg_stored **out, const char *folder, int step, int threads);
void      pg_stored_free (pg_stored **stored);
/* The scene of a result folder: its copy with the --set options that were noted in it. Files named in the
 * scene are searched for in the folder of the original scene. */
pg_status pg_stored_scene (pg_scene **out, const char *folder);

/* ---- reference ----------------------------------------------------------------------------------------- */
/* A table of values at points, read from a CSV file. Columns 0 to 2 are displacement components, 3 to 8
 * stress components in the order of Voigt. */
typedef struct {
    /* Name of the file without folders. */
    char    name[128];
    int     dim;
    size_t  n, ncolumn;
    /* Component (0 to 8) in each of the ncolumn columns. */
    int     column[9];
    /* Positions of the rows, m (n x dim). */
    double *x;
    /* Values in m and Pa (n x ncolumn); NAN where the table has none. */
    double *value;
    /* 1: displacements are relative to that at the position `datum`. */
    int     relative;
    /* Position of zero displacement if `relative` is 1, m. */
    double  datum[3];
} pg_line;
/* Reads a table. unit: metres in one unit of columns that name none; factor multiplies all
 * values; along (3, m): coordinates that the table lacks. PG_E_FILE with the line of the
 * fault. */
pg_status pg_line_read (pg_line *out, const char *path, int dim, double unit, double factor,
                        const double *along /* 3 */);
void      pg_line_clear (pg_line *line);
/* The values of a sampler in the rows of a table: u (n x 3, m), stress (n x 6, Pa); for a
 * relative table the displacement of the datum is subtracted. */
pg_status pg_line_sample (const pg_line *line, const pg_sampler *value, double *u, double *stress);
/* Name of a column, "u_x" to "s_zx"; "" for a number out of range. */
const char *pg_column_name (int column);
/* SI unit of a column, "m" or "Pa". */
const char *pg_column_unit (int column);

/* What the section `reference` of a scene describes. */
typedef struct pg_reference pg_reference;
/* Reads the section `reference` of a scene; files are searched beside the scene. *out is NULL if there is no
 * such section. Faults of the user are reported through the scene, with line and key. */
pg_status pg_reference_read  (pg_reference **out, const pg_scene *scene, const pg_problem *problem);
void      pg_reference_free  (pg_reference **reference);
/* Makes a sampler of the field that a reference describes at time t (s; in static runs the load factor). No
 * component is known if it consists of tables only. Valid as long as the reference. */
pg_status pg_reference_sampler (pg_sampler *out, const pg_reference *reference, double t);
/* Tables of a reference (n), owned by it. */
const pg_line *pg_reference_lines (const pg_reference *reference, size_t *n);

/* ---- norms --------------------------------------------------------------------------------------------- */
/* A norm of a difference, with the same norm of the reference to divide by. */
typedef struct {
    /* Norm of the difference and of the reference, in the units given below. */
    double difference, reference;
    /* difference / reference; 0 / 0 counts as 0, and INFINITY says that only the reference vanishes. */
    double relative;
    /* Maximum norms only: position of the largest difference, m. */
    double place[3];
} pg_norm;
/* Norms over the body. C is the inverse of the elastic law D, so that the energy norm of the
 * stress error equals that of the strain error. */
typedef struct {
    /* 1 if displacement, stress were compared. */
    int     displacement, stress;
    /* sqrt (int |u - u_ref|^2 dV), m^(5/2). */
    pg_norm l2;
    /* Largest |u - u_ref|, m, over quadrature points and points of the body. */
    pg_norm maximum;
    /* sqrt (int (s - s_ref) : C : (s - s_ref) dV), J^(1/2). */
    pg_norm energy;
    /* Largest |s - s_ref| (Frobenius norm, both shears of a pair counted), Pa, over quadrature
     * points. */
    pg_norm stress_maximum;
    /* Volume of the compared part of the body, m3. */
    double  volume;
    /* Numbers of quadrature points that were compared, and that were left out: excluded by the condition, or
     * without a finite value of result or reference. */
    size_t  places, skipped;
} pg_norms;
/* material: the elastic laws (NULL: stress is not compared); which: index of the law at each quadrature point
 * (n), NULL if all have the first one; where: a condition on the position, or NULL. */
typedef struct { const pg_material *material; const int *which; const pg_expression *where; } pg_norm_options;
/* Measures the norms over quadrature points (x: n x dim, m) and weights (m3). Displacement
 * components that one side does not know are left out; stress is compared only if both sides
 * know all components of the dimension. PG_E_SINGULAR: a law without an inverse. */
pg_status pg_norms_measure (pg_norms *out, const pg_quadrature *q, const pg_sampler *value,
                            const pg_sampler *reference, const pg_norm_options *options);
/* Norms of value against reference over the background cells of a problem, with `order` Gauss points per
 * direction and the laws of its materials, in parts of the cells to save memory. where: condition or NULL. */
pg_status pg_norms_of_cells (pg_norms *out, const pg_problem *problem, int order, const pg_expression *where,
                             const pg_sampler *value, const pg_sampler *reference);

/* Norms of one column of a table. */
typedef struct {
    char    file[128];  int column;
    /* Rows that were compared, and rows without a value of the table or the result. */
    size_t  rows, missed;
    /* Root of the sum of squares over the rows; largest difference, over the largest
     * reference. */
    pg_norm l2, maximum;
    /* The largest |v - ref| / |ref| among rows with |ref| above 1e-3 of the largest, and its position (m). */
    double  pointwise, place[3];
} pg_line_norms;
/* Measures all columns of a table; out holds ncolumn entries. */
pg_status pg_line_measure (pg_line_norms *out /* ncolumn */, const pg_line *line, const pg_sampler *value);

/* Errors of a state against the reference of a scene. */
typedef struct {
    pg_norms norms;
    /* Gauss points per direction of the norms; 0: the volumes of the points were the weights. */
    int      order;
    size_t   nline;  pg_line_norms *line;
    /* |u - u_ref| at the points (n), m, NAN where unknown; NULL if no displacement is
     * compared. */
    double  *difference;
    /* Time that the comparison took, s. */
    double   seconds;
} pg_errors;
/* Compares a field with a reference at time t: norms over the body and all tables. To be freed
 * with pg_errors_clear, also after zero initialisation. */
pg_status pg_errors_measure (pg_errors *out, const pg_reference *reference, const pg_problem *problem,
                             const pg_sampler *value, double t);
/* Norms and differences at the points between any two samplers, over the background cells of
 * the problem with `order` Gauss points per direction (see pg_norm_order). */
pg_status pg_errors_against (pg_errors *out, const pg_problem *problem, int order, const pg_expression *where,
                             const pg_sampler *value, const pg_sampler *reference);
/* Compares a finite element result with the closed forms of a reference, by a rule of order 5 on its own
 * elements; tables and points are not compared. */
pg_status pg_errors_mesh (pg_errors *out, const pg_reference *reference, const pg_problem *problem,
                          const char *path, int step, double unit, double t);
/* Gauss points per direction for norms: two more than the run integrates with, at most 5, so
 * that the norm does not inherit the quadrature points of the solution, where its error may be
 * small. */
int       pg_norm_order     (const pg_scene *scene, const pg_problem *problem);
void      pg_errors_clear   (pg_errors *errors);
/* Writes the errors as entries of the JSON object that is open. */
void      pg_errors_json    (pg_json *j, const pg_errors *errors);
/* Writes row i of a short table for people; returns 0 past its end. */
int       pg_errors_row     (const pg_errors *errors, size_t i, char *text, size_t size);

/* ---- files --------------------------------------------------------------------------------------------- */
/* Writes a CSV file with place, value, reference and difference of every column that both samplers know, at
 * the points of a body or (pg_compare_line) in the rows of a table. NAN where unknown. */
pg_status pg_compare_points (const char *path, const pg_cloud *cloud, const pg_sampler *value,
                             const pg_sampler *reference);
pg_status pg_compare_line   (const char *path, const pg_line *line, const pg_sampler *value);
/* The difference value - reference at the points (out: n): of column 0 to 8; PG_COMPARE_U, PG_COMPARE_S: the
 * Euclidean norm over all displacement, over all stress components. */
enum { PG_COMPARE_U = 16, PG_COMPARE_S };
pg_status pg_compare_field (double *out, const pg_cloud *cloud, int column, const pg_sampler *value,
                            const pg_sampler *reference);

/* ---- order of convergence: pure functions of numbers --------------------------------------------------- */
/* Observed order of convergence of a sequence of values. */
typedef struct {
    /* The p of value = limit + c h^p; NAN if there is none. */
    double      order;
    /* Richardson's extrapolated value for h -> 0; NAN where there is no order. */
    double      limit;
    /* Estimate of |finest value - limit|, in the unit of the values. */
    double      error;
    /* NULL, or why there is no order, in words ("oscillates", ...); a static text. */
    const char *why;
} pg_observed;
/* Computes the order from the last three of n values at decreasing sizes h, whose ratios may differ (Roache
 * 1998): p solves
 *
 *   (v1 - v2) / (v2 - v3) = (h1^p - h2^p) / (h2^p - h3^p).
 *
 * Values that oscillate or diverge have no order. Neither have values that agree to 1e-10 of the largest one,
 * since the residuals of solvers end there; then the last value is the limit and the error is 0. An order
 * above 20 means that the last difference is too small to tell. */
pg_observed pg_observed_of_values (size_t n, const double *h, const double *value);
/* Computes the order from the last two of n errors, whose limit is 0: log (e1 / e2) / log (h1 / h2). The
 * error returned is the last one. */
pg_observed pg_observed_of_errors (size_t n, const double *h, const double *error);
/* Interpolates the y at which x reaches `at`, along straight lines between the points (x, y) in the
 * logarithms of both, in the given order; the first crossing counts. NAN if no two neighbours enclose it,
 * since nothing is extrapolated, or if values are not positive. */
double      pg_loglog_at (size_t n, const double *x, const double *y, double at);
PG_API_END
#endif

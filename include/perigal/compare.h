/* SPDX-License-Identifier: GPL-3.0-or-later
 * compare.h: a result against what is known of it: closed forms, tables of places, finite element results,
 * other results. Everything to be compared is a sampler: it can be asked for displacement and stress at any
 * place. */
#ifndef PERIGAL_COMPARE_H
#define PERIGAL_COMPARE_H
#include "perigal/mesh.h"
#include "perigal/output.h"
#include "perigal/solve.h"

PG_API_BEGIN

/* ---- samplers ------------------------------------------------------------------------------------------ */
/* x: n x dim, m; u: n x 3, m, 0 beyond dim; stress: n x 6, Pa, xx yy zz xy yz zx, or NULL: not wanted. What
 * is not known is NAN. Borrows what it was made of; pg_sampler_clear frees what it made itself. */
typedef struct {
    void *context;
    int   dim;
    int   displacement, stress;                        /* bit k: component k is known */
    pg_status (*sample) (void *context, size_t n, const double *x, double *u, double *stress);
    void (*free) (void *context);                      /* NULL: nothing to free */
} pg_sampler;
void      pg_sampler_clear    (pg_sampler *sampler);
/* A state of a force: by its own shape functions (pg_force_type.sample), else by least squares through its
 * nodal displacements. */
pg_status pg_sampler_solution (pg_sampler *out, const pg_problem *problem, const pg_force_type *force,
                               void *self, const pg_state *state);
/* Displacements at points (n x dim, m), between them by least squares with a linear basis; stress from its
 * gradient and the materials of the nearest evaluation point. cracks and materials are the problem's. torn
 * (n, or NULL): points that have lost bonds since; a place that reaches one has the displacement of the
 * nearest point and no stress. */
pg_status pg_sampler_points (pg_sampler *out, const pg_problem *problem, const double *u,
                             const unsigned char *torn);
/* A finite element result (see pg_mesh_result) of the same body: displacements (both they and places times
 * unit, m), stress from their gradients and the problem's materials. Plane results of elements one layer
 * thick become plane. Places outside the elements take the nearest one up to 0.25 element sizes, beyond they
 * are unknown. */
pg_status pg_sampler_mesh (pg_sampler *out, const char *path, int step, double unit,
                           const pg_problem *problem);
/* Its mesh, in m; NULL: another kind of sampler. outside, away (or NULL): places asked for so far that lay
 * outside, the farthest in element sizes. */
const pg_mesh *pg_sampler_mesh_of (const pg_sampler *sampler, size_t *outside, double *away);
/* Points and weights (thickness: of plane elements) of all elements; cell: element. */
pg_status pg_mesh_quadrature  (pg_quadrature *out, const pg_mesh *mesh, double thickness, int order);
/* The reference moved by shift (3, m), its values times factor; takes `sampler` over. */
pg_status pg_sampler_moved    (pg_sampler *out, pg_sampler *sampler, const double *shift, double factor);

/* ---- results of runs ----------------------------------------------------------------------------------- */
/* A result folder opened for questions: the problem built anew from its copy of the scene, the fields of one
 * step of its result.e. */
typedef struct {
    pg_scene   *scene;
    pg_problem *problem;
    const pg_force_type *force;  void *self;
    pg_state   *state;
    pg_sampler  sampler;  /* NAN beyond sqrt (dim) spacings of the nearest point */
    double      t, stamp;                              /* time of expressions; the step's own in result.e */
    int         step;
    char        how[200];  /* "by its own shape functions", or what replaces them and why */
} pg_stored;
/* step -1: the last. */
pg_status pg_stored_open (pg_stored **out, const char *folder, int step, int threads);
void      pg_stored_free (pg_stored **stored);
/* The scene of a result folder: its copy with the --set options noted in it; files beside the scene are
 * looked for where it was. */
pg_status pg_stored_scene (pg_scene **out, const char *folder);

/* ---- reference ----------------------------------------------------------------------------------------- */
/* A table of places with values. Columns: 0..2 displacement, 3..8 stress. */
typedef struct {
    char    name[128];                                 /* of the file, without folders */
    int     dim;
    size_t  n, ncolumn;
    int     column[9];
    double *x;                                         /* m (n x dim) */
    double *value;                                     /* m, Pa; NAN: missing (n x ncolumn) */
    int     relative;                                  /* 1: displacements are relative to that of `datum` */
    double  datum[3];                                  /* m */
} pg_line;
/* unit: length of columns that name none, m; factor: of the values; along: coordinates that are no column, m.
 * Faults: PG_E_FILE with line. */
pg_status pg_line_read (pg_line *out, const char *path, int dim, double unit, double factor,
                        const double *along /* 3 */);
void      pg_line_clear (pg_line *line);
/* What a result has in its rows: u (n x 3, m), stress (n x 6, Pa); the displacement of a table's datum is
 * taken off. */
pg_status pg_line_sample (const pg_line *line, const pg_sampler *value, double *u, double *stress);
const char *pg_column_name (int column);               /* "u_x" ... "s_zx" */
const char *pg_column_unit (int column);               /* "m", "Pa" */

/* `reference` of a scene. Files are looked for beside the scene. *out is NULL when there is none; faults go
 * to the scene. */
typedef struct pg_reference pg_reference;
pg_status pg_reference_read  (pg_reference **out, const pg_scene *scene, const pg_problem *problem);
void      pg_reference_free  (pg_reference **reference);
/* The field it describes at time t (s; static: load factor); no bits set when it has lines only. */
pg_status pg_reference_sampler (pg_sampler *out, const pg_reference *reference, double t);
/* Its tables, borrowed. */
const pg_line *pg_reference_lines (const pg_reference *reference, size_t *n);

/* ---- norms --------------------------------------------------------------------------------------------- */
typedef struct {
    double difference, reference;                      /* norms of the difference and of the reference */
    double relative;  /* their quotient; 0 / 0 = 0, INFINITY where only the reference vanishes */
    double place[3];                                   /* of the largest difference (maxima only), m */
} pg_norm;
typedef struct {
    int     displacement, stress;                      /* 1: measured */
    pg_norm l2;                                        /* sqrt (int |u - u_ref|^2 dV), m^(5/2) */
    pg_norm maximum;  /* largest |u - u_ref|, m, at the quadrature points and at the nodes */
    pg_norm energy;  /* sqrt (int (s - s_ref) : C : (s - s_ref) dV), J^(1/2) */
    pg_norm stress_maximum;                            /* largest |s - s_ref| (of all components), Pa */
    double  volume;                                    /* m^3, measured */
    size_t  places, skipped;  /* skipped: excluded by where, or the reference is not finite there */
} pg_norms;
/* Over quadrature points and weights (x n x dim). material: elastic law of each place (which: n, indices;
 * NULL: all the first). where: NULL, or a condition. Components that either side does not know are left out;
 * stress needs all of the dimension. */
typedef struct { const pg_material *material; const int *which; const pg_expression *where; } pg_norm_options;
pg_status pg_norms_measure (pg_norms *out, const pg_quadrature *q, const pg_sampler *value,
                            const pg_sampler *reference, const pg_norm_options *options);

/* Of one column of a table. */
typedef struct {
    char    file[128];  int column;
    size_t  rows, missed;                              /* missed: no value there, or not finite */
    pg_norm l2, maximum;                               /* root of the sum over the rows; largest */
    double  pointwise, place[3];  /* largest |v - ref| / |ref| where |ref| > 1e-3 of the largest; where */
} pg_line_norms;
pg_status pg_line_measure (pg_line_norms *out /* ncolumn */, const pg_line *line, const pg_sampler *value);

/* All that a scene's reference says about a state. */
typedef struct {
    pg_norms norms;
    int      order;  /* Gauss points per direction of the norms; 0: the points' volumes */
    size_t   nline;  pg_line_norms *line;
    double  *difference;  /* |u - u_ref| at the points, m, NAN where unknown; NULL: none */
    double   seconds;
} pg_errors;
pg_status pg_errors_measure (pg_errors *out, const pg_reference *reference, const pg_problem *problem,
                             const pg_sampler *value, double t);
/* Norms and difference against any sampler, over the cells of `problem`; order: Gauss points per direction,
 * see pg_norm_order. */
pg_status pg_errors_against (pg_errors *out, const pg_problem *problem, int order, const pg_expression *where,
                             const pg_sampler *value, const pg_sampler *reference);
/* A finite element result measured against a scene's closed forms, by 5th order on its own elements (lines
 * and points are not looked at). */
pg_status pg_errors_mesh (pg_errors *out, const pg_reference *reference, const pg_problem *problem,
                          const char *path, int step, double unit, double t);
/* two more than the run's, at most 5 */
int       pg_norm_order     (const pg_scene *scene, const pg_problem *problem);
void      pg_errors_clear   (pg_errors *errors);
void      pg_errors_json    (pg_json *j, const pg_errors *errors);       /* entries of the map that is open */
/* Row i of a short table for people; 0 past its end. */
int       pg_errors_row     (const pg_errors *errors, size_t i, char *text, size_t size);

/* ---- files --------------------------------------------------------------------------------------------- */
/* CSV of place, value, reference, difference of every column both know: at the points of a body, in the rows
 * of a table. NAN: unknown. */
pg_status pg_compare_points (const char *path, const pg_cloud *cloud, const pg_sampler *value,
                             const pg_sampler *reference);
pg_status pg_compare_line   (const char *path, const pg_line *line, const pg_sampler *value);
/* value - reference at the points: column 0..8; PG_COMPARE_U, PG_COMPARE_S: size of the difference of all
 * components. out: n. */
enum { PG_COMPARE_U = 16, PG_COMPARE_S };
pg_status pg_compare_field (double *out, const pg_cloud *cloud, int column, const pg_sampler *value,
                            const pg_sampler *reference);

/* ---- order of convergence: pure functions of numbers --------------------------------------------------- */
typedef struct {
    double      order;                                 /* p of value = limit + c h^p; NAN: none is seen */
    double      limit;  /* Richardson's value for h -> 0; NAN where there is no order */
    double      error;  /* estimated |finest value - limit|, in the unit of the values */
    const char *why;  /* NULL, or why there is no order ("oscillates", ...; static) */
} pg_observed;
/* From the last three of n values at falling sizes h (any ratios; Roache 1998): p solves (v1 - v2) / (v2 -
 * v3) = (h1^p - h2^p) / (h2^p - h3^p). Values that swing or part from each other have no order, nor have
 * those that agree within 1e-10 of the largest (residuals end there) value (then limit is the last value and
 * error 0). Order above 20: differences too unlike to tell. */
pg_observed pg_observed_of_values (size_t n, const double *h, const double *value);
/* Of errors, whose limit is 0: log (e1 / e2) / log (h1 / h2) of the last two; error: the last one. */
pg_observed pg_observed_of_errors (size_t n, const double *h, const double *error);
/* y where x reaches `at`, along straight lines between the points (x, y) in logarithms of both, in the order
 * given; the first crossing counts. NAN: no two neighbours enclose it (nothing is extrapolated), or they are
 * not positive. */
double      pg_loglog_at (size_t n, const double *x, const double *y, double at);
PG_API_END
#endif

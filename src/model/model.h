/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private to the model folder: the stages of building a problem. */
#ifndef PG_MODEL_PRIVATE_H
#define PG_MODEL_PRIVATE_H
#include "perigal/model.h"
pg_status pg_loads_read  (pg_problem *problem, const pg_scene *scene);
/* supports.c: supports that contradict each other (at corners: warnings), or are too many for elimination, as
 * faults. duration: end of the run, s (static: 1). */
void      pg_supports_check (pg_problem *problem, const pg_scene *scene, double duration);
/* Faults where a load or support is not finite at a place and time where it acts (load_finite.c). */
void      pg_loads_check_finite (const pg_problem *problem, const pg_scene *scene, double duration);
void      pg_supports_check_eliminated (const pg_problem *problem, const pg_scene *scene);
void      pg_loads_clear (pg_problem *problem);
/* load_place.c, load_spring.c: parts of entry i of `boundary`. The centre of its moments; a place instead of
 * a
 * set; keys that are no maps of components. */
pg_status pg_load_centre (const pg_problem *problem, pg_load *load, const pg_scene *scene, size_t i);
pg_status pg_load_spread_force (const pg_problem *problem, pg_load *load);
pg_status pg_load_read_place    (const pg_problem *problem, pg_load *load, const pg_scene *scene, size_t i);
pg_status pg_load_read_turn     (const pg_problem *problem, pg_load *load, const pg_scene *scene, size_t i);
pg_status pg_load_read_symmetry (pg_problem *problem, pg_load *load, const pg_scene *scene, size_t i);
pg_status pg_load_read_gravity  (const pg_problem *problem, pg_load *load, const pg_scene *scene, size_t i);
pg_status pg_load_read_spring   (const pg_problem *problem, pg_load *load, const pg_scene *scene, size_t i);
pg_status pg_load_read_eigenstrain (const pg_problem *problem, pg_load *load, const pg_scene *scene,
                                    size_t i);
/* Component k of the displacement of a set that turns by `factor` times its angles. */
double    pg_load_turned (const pg_load *load, int k, int dim, const double *x, const pg_place *at,
                          double factor);
/* platens.c: rigid platens; their loads take the places of problem->load from `first` on. */
size_t    pg_platens_loads (const pg_scene *scene);    /* how many these are */
pg_status pg_platens_read  (pg_problem *problem, const pg_scene *scene, size_t first, int is_static,
                            double duration);
/* stages.c: once the loads have their names. A load that follows the stages gets its table, still empty. */
pg_status pg_stages_read  (pg_problem *problem, const pg_scene *scene);
void      pg_stages_clear (pg_problem *problem);
pg_status pg_load_follows_stages (pg_load *load, const pg_scene *scene, size_t i, size_t nstage);
/* initial.velocity: checked and compiled; put into v (n x dim, m/s), which is left alone where nothing is
 * given. */
pg_status pg_initial_read  (pg_problem *problem, const pg_scene *scene);
void      pg_initial_set   (const pg_problem *problem, double *v);
void      pg_initial_clear (pg_problem *problem);
/* method.tip_offset: how far behind its tips and fronts each pre-crack cuts; the tips in the plane. */
pg_status pg_tips_retreat (pg_problem *problem, const pg_scene *scene);
/* fronts.c: the fronts of the pre-cracks in space (*out, *n), before these retreat. retreat: of each crack,
 * of each of its edges (of a disc: one), m; NULL: none retreats. */
pg_status pg_fronts_find (const pg_ground *ground, const pg_cracks *cracks, double *const *retreat,
                          pg_front **out, size_t *n);
/* Where the body is (body_search.c): for a body in the plane, or one with cracks. */
pg_status pg_body_search_create (pg_problem *problem);
void      pg_body_search_free   (pg_problem *problem);
/* Arrays that share a capacity: PG_GROW of one with `each` values for an element, which leaves the capacity
 * to the PG_GROW of the last. */
#define GROW_ALSO(p, each, cap, need) do { if ((size_t) (need) > (cap)) { \
    void *q_ = pg_resize ((p), (each) * (2 * (size_t) (need) + 16), sizeof *(p)); \
    if (!q_) PG_FAIL (PG_E_MEMORY, "no memory for %zu x %zu bytes", (size_t) (need), (each) * sizeof *(p)); \
    (p) = q_; } } while (0)
/* crack_paths_memory.c: do two places lie at one? Room for n pieces of cracks in all. */
int       pg_crack_paths_same (const pg_crack_paths *paths, const double *a, const double *b);
pg_status pg_crack_paths_reserve (pg_crack_paths *paths, size_t n);
pg_status pg_bonds_build (pg_problem *problem, const pg_scene *scene);
/* What is asked of the descriptor of the force (method.c): keys of other forces are noted; what it cannot
 * carry or show becomes a fault. */
void      pg_method_note_ignored    (pg_problem *problem, const pg_scene *scene);
pg_status pg_method_check_materials (const pg_problem *problem, const pg_scene *scene);
void      pg_method_check_criterion (const pg_problem *problem, const pg_scene *scene);
/* Names of the forces without shape functions, with rotations: "a, b or c" */
const char *pg_methods_of_points (const pg_problem *problem, char *out, size_t size);
const char *pg_methods_with_rotations (const pg_problem *problem, char *out, size_t size);
/* Distance from x in direction e (unit) to the first place without body, at most `limit`, m. */
double    pg_ground_way_out (const pg_ground *ground, const double *x, const double *e, double limit);
/* Is there body at x; local spacing there, m: pg_problem_has_body, pg_problem_spacing_at. */
int       pg_ground_has_body   (const pg_ground *ground, const double *x);
double    pg_ground_spacing_at (const pg_ground *ground, const double *x);
/* How far a crack that ends at x, going in direction e, cuts beyond: on the surface as far as points may lie
 * outside of it, but not into body that follows; elsewhere and along the surface not at all. */
double    pg_ground_beyond (const pg_ground *ground, const double *x, const double *e);
/* What of the area (m^2) of the triangle o u v in space lies inside the body. */
double    pg_ground_area_inside (const pg_ground *ground, const double *o, const double *u, const double *v,
                                 double area);
/* The node nearest to a point of a bond set among those it sees; -1: it sees none. */
int       pg_bonds_nearest (const pg_problem *problem, int set, size_t point);
/* block of every point, once the rows are there. */
/* What is wrong with the entries of `blocks` by themselves, as faults. */
pg_status pg_blocks_check (const pg_problem *problem, const pg_scene *scene);
pg_status pg_blocks_build (pg_problem *problem, const pg_scene *scene);
/* Where block, number and condition of a point are judged: its place, a hair inside the body (dim). */
void      pg_blocks_place (const pg_problem *problem, int set, size_t point, double *x);
/* laws.c: stiffness and limits that are expressions: compiled before materials and criteria are read, checked
 * after that, and made the laws of all points once these have their blocks. */
pg_status pg_laws_read  (pg_problem *problem, const pg_scene *scene);
void      pg_laws_check (pg_problem *problem, const pg_scene *scene);
pg_status pg_laws_build (pg_problem *problem, const pg_scene *scene);
void      pg_laws_clear (pg_problem *problem);
/* method.dilatation: patches for the materials that need them; notes and warnings for those that have
 * none. */
pg_status pg_dilatation_build (pg_problem *problem, const pg_scene *scene);
/* failure.interfaces, once materials and criteria are there. */
pg_status pg_interfaces_read (pg_problem *problem, const pg_scene *scene);
/* Remarks on what was perhaps not meant (remarks.c); parts, contrast: once the bonds are there. */
void      pg_remark_spacing  (pg_problem *problem, const pg_scene *scene);
void      pg_remark_small_shapes (pg_problem *problem);
void      pg_remark_thin_walls   (pg_problem *problem);
void      pg_remark_units    (pg_problem *problem, const pg_scene *scene);
void      pg_remark_clouds   (pg_problem *problem);
/* Remarks on graded points, meshes and (once bonds are there) interfaces: remark_mesh.c; parts, contrast. */
pg_status pg_remark_hanging  (pg_problem *problem);
void      pg_remark_plane    (pg_problem *problem);
void      pg_remark_graded   (pg_problem *problem, const pg_scene *scene);
void      pg_remark_interfaces (pg_problem *problem);
pg_status pg_remark_parts    (pg_problem *problem);
pg_status pg_remark_contrast (pg_problem *problem);
/* alive = 0 where a bond meets a pre-crack. */
void      pg_bonds_cut   (const pg_problem *problem, unsigned char *alive);
/* Does the bond x - y meet a crack or a slot of the scene? */
int       pg_bond_cut_first (const pg_problem *problem, const double *x, const double *y);

/* ---- crack_paths.c ------------------------------------------------------------------------------------- */
/* What pg_crack_grow and pg_crack_start do to the paths, which have room for it; changed: marks pieces that
 * cut other bonds than before. PG_E_USAGE: nothing is changed. */
pg_status paths_grow  (pg_crack_paths *paths, const pg_ground *ground, size_t tip, const double *to,
                       int close, unsigned char *changed);
pg_status paths_start (pg_crack_paths *paths, const pg_ground *ground, const double *from, const double *to,
                       int open, unsigned char *changed);
int       paths_draw_back (pg_crack_paths *paths, size_t tip, double offset);  /* 0: nothing is changed */
/* crack_paths_memory.c: paths of cracks and their tips; places no further apart than `nothing` (m) are one.
 * pg_crack_paths_keep, at most so many pieces. */
pg_status paths_of   (pg_crack_paths **out, const pg_cracks *cracks, const pg_tip *tip, size_t ntip,
                      double nothing);
pg_status paths_keep (pg_crack_paths *paths, long most, const char *name, const pg_keeper *keeper);

/* ---- crack_doubles.c ----------------------------------------------------------------------------------- */
/* Leaves out cracks that are given twice, and notes it; what overlaps otherwise is a fault of the scene. */
pg_status drop_doubled_cracks (pg_problem *p, const pg_scene *scene);
#endif

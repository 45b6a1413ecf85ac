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
/* Does the expression change from place to place? */
int pg_depends_on_place (const pg_expression *e);
/* problem_traits.c: the criterion where `failure` names none; NULL: nothing breaks. */
const char *pg_problem_usual_criterion (const pg_problem *problem, const pg_scene *scene);
pg_status pg_bonds_build (pg_problem *problem, const pg_scene *scene);
/* What is asked of the descriptor of the force (method.c): keys of other forces are noted; what it cannot
 * carry or show becomes a fault. */
void      pg_method_note_ignored    (pg_problem *problem, const pg_scene *scene);
pg_status pg_method_check_materials (const pg_problem *problem, const pg_scene *scene);
void      pg_method_check_criterion (const pg_problem *problem, const pg_scene *scene);
/* Names of the forces without shape functions, with rotations: "a, b or c" */
const char *pg_methods_of_points (const pg_problem *problem, char *out, size_t size);
const char *pg_methods_with_rotations (const pg_problem *problem, char *out, size_t size);
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

/* ---- crack_doubles.c ----------------------------------------------------------------------------------- */
/* Leaves out cracks that are given twice, and notes it; what overlaps otherwise is a fault of the scene. */
pg_status drop_doubled_cracks (pg_problem *p, const pg_scene *scene);
#endif

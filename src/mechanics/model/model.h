/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private to the model folder: the stages of building a problem. */
#ifndef PG_MODEL_PRIVATE_H
#define PG_MODEL_PRIVATE_H
#include "perigal/model.h"
pg_status pg_loads_read  (pg_problem *problem, const pg_scene *scene);
/* supports.c: reports supports that contradict each other (at corners: warnings) as errors. duration: end of
 * the run, s (static: 1). */
void      pg_supports_check (pg_problem *problem, const pg_scene *scene, double duration);
/* Reports loads and supports that are not finite at some position and time as errors (load_finite.c). */
void      pg_loads_check_finite (const pg_problem *problem, const pg_scene *scene, double duration);
void      pg_supports_check_eliminated (const pg_problem *problem, const pg_scene *scene);
void      pg_loads_clear (pg_problem *problem);
/* load_place.c, load_spring.c: read parts of entry i of `boundary`: reference point of moments; position
 * instead of a set; special kinds of loads. */
pg_status pg_load_centre (const pg_problem *problem, pg_load *load, const pg_scene *scene, size_t i);
pg_status pg_load_spread_force (const pg_problem *problem, pg_load *load);
pg_status pg_load_read_place    (const pg_problem *problem, pg_load *load, const pg_scene *scene, size_t i);
pg_status pg_load_read_turn     (const pg_problem *problem, pg_load *load, const pg_scene *scene, size_t i);
pg_status pg_load_read_symmetry (pg_problem *problem, pg_load *load, const pg_scene *scene, size_t i);
pg_status pg_load_read_gravity  (const pg_problem *problem, pg_load *load, const pg_scene *scene, size_t i);
pg_status pg_load_read_spring   (const pg_problem *problem, pg_load *load, const pg_scene *scene, size_t i);
pg_status pg_load_read_eigenstrain (const pg_problem *problem, pg_load *load, const pg_scene *scene,
                                    size_t i);
/* platens.c: rigid platens; their loads are problem->boundary.load from index `first` on. */
size_t    pg_platens_loads (const pg_scene *scene);    /* number of loads of platens */
pg_status pg_platens_read  (pg_problem *problem, const pg_scene *scene, size_t first, int is_static,
                            double duration);
/* stages.c: reads the stages, after the loads. pg_load_follows_stages: allocates the table of a load, still
 * empty. */
pg_status pg_stages_read  (pg_problem *problem, const pg_scene *scene);
void      pg_stages_clear (pg_problem *problem);
pg_status pg_load_follows_stages (pg_load *load, const pg_scene *scene, size_t i, size_t nstage);
/* Section initial: reads the velocities; sets v (n x unknowns per point, m/s), unchanged where nothing is
 * given. */
pg_status pg_initial_read  (pg_problem *problem, const pg_scene *scene);
void      pg_initial_set   (const pg_problem *problem, double *v);
void      pg_initial_clear (pg_problem *problem);
/* Finds the tips and fronts of pre-cracks, and the distance behind them without cut bonds
 * (method.tip_offset). */
pg_status pg_tips_retreat (pg_problem *problem, const pg_scene *scene);
/* Returns 1: the expression depends on position. */
int pg_depends_on_place (const pg_expression *e);
/* problem_traits.c: default criterion where `failure` names none; NULL: nothing breaks. */
const char *pg_problem_usual_criterion (const pg_problem *problem, const pg_scene *scene);
pg_status pg_bonds_build (pg_problem *problem, const pg_scene *scene);
/* Checks by the descriptor of the force (method.c): notes keys of other forces; reports unsupported materials
 * and criteria as errors. */
void      pg_method_note_ignored    (pg_problem *problem, const pg_scene *scene);
pg_status pg_method_check_materials (const pg_problem *problem, const pg_scene *scene);
void      pg_method_check_criterion (const pg_problem *problem, const pg_scene *scene);
/* Names of the forces without shape functions, with rotations: "a, b or c" */
const char *pg_methods_of_points (const pg_problem *problem, char *out, size_t size);
const char *pg_methods_with_rotations (const pg_problem *problem, char *out, size_t size);
/* The nearest of the neighbours of a point of a bond set; -1: it has none. */
int       pg_bonds_nearest (const pg_problem *problem, int set, size_t point);
/* blocks.c: checks the entries of `blocks`; pg_blocks_build: sets the material of every point, after the bond
 * sets are built. */
pg_status pg_blocks_check (const pg_problem *problem, const pg_scene *scene);
pg_status pg_blocks_build (pg_problem *problem, const pg_scene *scene);
/* Position x (dim, m), slightly inside the body, at which conditions and expressions of a point are
 * evaluated. */
void      pg_blocks_place (const pg_problem *problem, int set, size_t point, double *x);
/* laws.c: stiffness and limits that are expressions: read before materials and criteria, checked after that,
 * and evaluated at all points after blocks are assigned. */
pg_status pg_laws_read  (pg_problem *problem, const pg_scene *scene);
void      pg_laws_check (pg_problem *problem, const pg_scene *scene);
pg_status pg_laws_build (pg_problem *problem, const pg_scene *scene);
void      pg_laws_clear (pg_problem *problem);
/* method.dilatation: patches for the materials that need them; notes and warnings for those that have
 * none. */
pg_status pg_dilatation_build (pg_problem *problem, const pg_scene *scene);
/* Reads failure.interfaces, after materials and criteria. */
pg_status pg_interfaces_read (pg_problem *problem, const pg_scene *scene);
/* Remarks on probably unintended input (remarks.c), before bonds are built. */
void      pg_remark_spacing  (pg_problem *problem, const pg_scene *scene);
void      pg_remark_small_shapes (pg_problem *problem);
void      pg_remark_thin_walls   (pg_problem *problem);
void      pg_remark_units    (pg_problem *problem, const pg_scene *scene);
void      pg_remark_clouds   (pg_problem *problem);
/* Remarks on meshes, graded points and interfaces (remark_mesh.c); parts, contrast (remarks.c): after bonds
 * are built. */
pg_status pg_remark_hanging  (pg_problem *problem);
void      pg_remark_plane    (pg_problem *problem);
void      pg_remark_graded   (pg_problem *problem, const pg_scene *scene);
void      pg_remark_interfaces (pg_problem *problem);
pg_status pg_remark_parts    (pg_problem *problem);
pg_status pg_remark_contrast (pg_problem *problem);
/* Sets the initial alive mask: 0 where a bond meets a pre-crack, else 1. */
void      pg_bonds_cut   (const pg_problem *problem, unsigned char *alive);
/* Returns 1: the bond x - y (m) meets a pre-crack or a slot. */
int       pg_bond_cut_first (const pg_problem *problem, const double *x, const double *y);

/* ---- crack_doubles.c ----------------------------------------------------------------------------------- */
/* Removes cracks that are given twice, with a warning; other overlaps are errors of the scene. */
pg_status drop_doubled_cracks (pg_problem *p, const pg_scene *scene);
#endif

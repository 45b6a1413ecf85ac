/* SPDX-License-Identifier: GPL-3.0-or-later
 * Declarations of all criteria, expanded from list.h, and the limits that the scene gives them (limits.c). */
#ifndef PERIGAL_CRITERION_ENTRIES_H
#define PERIGAL_CRITERION_ENTRIES_H
#include "perigal/criterion.h"
#define PG_CRITERION(name) extern const pg_criterion_type pg_criterion_##name;
#include "list.h"
#undef PG_CRITERION

const pg_criterion_type *pg_criterion_entry (size_t i);                /* NULL past the end */

/* Limits that several criteria share (keys.c): fracture_energy; tensile_strength; cohesion
 * and friction_angle. */
extern const pg_key_table criterion_keys_energy, criterion_keys_tension, criterion_keys_shear;
/* An option that criteria of bonds with a fracture energy share (keys.c): calibration. */
extern const pg_key_table criterion_keys_calibration;
/* What failure.calibration makes of the setting: c->growth is filled, and the factor of the energy of a
 * straight cut is returned, 1 where limits are those of theory. A calibration that is asked for and was not
 * measured is a fault of the scene. */
double pg_criterion_calibration (pg_criterion *c, const pg_scene *scene, const pg_criterion_setting *setting);
/* Of criteria that have the key only so that a scene can change from one criterion to another: theory is all
 * there is. */
void   pg_criterion_by_theory (const pg_scene *scene);
/* ", ..." for describe: how limits allow for growth, or that they do not; "" for forces that know nothing
 * of it. */
void   pg_criterion_say_growth (const pg_criterion *c, char *text, size_t size);

enum { PG_LIMITS = 96 };                               /* bytes of a path such as materials.NAME.failure */
/* The map that gives a need ("limit", or "limit or other") to the setting's material: its own, else
 * `failure`; returns 0: neither. */
int pg_criterion_holder (char map[PG_LIMITS], const pg_scene *scene, const pg_criterion_setting *setting,
                         const char *need);
/* A limit of the setting's material, SI; 0 when it is missing. */
double pg_criterion_limit  (const pg_scene *scene, const pg_criterion_setting *setting, const char *limit);
int    pg_criterion_never  (const pg_scene *scene, const pg_criterion_setting *setting);
/* Faults for limits that the materials lack and for those that would be ignored. type NULL: nothing
 * breaks. */
void pg_criterion_check (const pg_scene *scene, const pg_criterion_type *type, size_t n,
                         const pg_criterion_setting *setting);
#endif

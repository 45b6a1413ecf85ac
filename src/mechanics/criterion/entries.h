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
/* Applies the key failure.calibration: fills c->growth and returns the energy that a growing crack consumes
 * over that of a straight cut; 1: limits follow theory. It is a fault of the scene to ask for a calibration
 * that was not measured. */
double pg_criterion_calibration (pg_criterion *c, const pg_scene *scene, const pg_criterion_setting *setting);
/* Called by criteria that accept failure.calibration only so that a scene can change its criterion: any value
 * but "theory" that is given is a fault of the scene. */
void   pg_criterion_by_theory (const pg_scene *scene);
/* Writes "; ..." for `describe`: how limits allow for the energy of growing cracks; "" if they do not. */
void   pg_criterion_say_growth (const pg_criterion *c, char *text, size_t size);

enum { PG_LIMITS = 96 };                               /* bytes of a path such as materials.NAME.failure */
/* Finds the map of the scene in which a limit (need: "limit", or "limit or other") is given for the setting's
 * material: that of the material, else `failure`. Returns 0 if neither has it. */
int pg_criterion_holder (char map[PG_LIMITS], const pg_scene *scene, const pg_criterion_setting *setting,
                         const char *need);
/* Returns a limit of the setting's material, SI, or its default; 0: it is missing. pg_criterion_never: 1:
 * bonds that end in this material never break. */
double pg_criterion_limit  (const pg_scene *scene, const pg_criterion_setting *setting, const char *limit);
int    pg_criterion_never  (const pg_scene *scene, const pg_criterion_setting *setting);
/* Reports limits that the n materials lack, and limits that would be ignored, as faults of the scene. type
 * NULL: nothing breaks. */
void pg_criterion_check (const pg_scene *scene, const pg_criterion_type *type, size_t n,
                         const pg_criterion_setting *setting);
#endif

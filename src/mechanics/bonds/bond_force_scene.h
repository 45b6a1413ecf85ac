/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: what forces between points (bond, fcbm, lps, gmpd) have in common when the scene is read: their
 * keys, the rule by which bonds are summed, the checks of both. */
#ifndef PG_BOND_FORCE_SCENE_H
#define PG_BOND_FORCE_SCENE_H
#include "perigal/force.h"

extern const pg_key_table bond_force_keys;            /* keys of all bond- and state-based forces */
extern const pg_key_table state_based_keys;            /* keys of forces with dilatations alone */

/* Reads the rule by which pair forces are summed from the scene; state-based and micropolar forces add to
 * it. */
void bond_force_rule (pg_sum_rule *out, const pg_scene *scene, pg_mode mode, const pg_approx *approx,
                       double spacing, int lattice);
/* Makes the rule state-based and reads method.weighted_volume. */
void bond_force_rule_with_dilatation (pg_sum_rule *rule, const pg_scene *scene);
/* Makes pg_problem.sums from method->rule. check: reports what in rule or materials the theory does not
 * allow. */
typedef void (*bond_force_check) (pg_problem *problem, const pg_scene *scene, const pg_sum_rule *rule);
pg_status bond_force_read (pg_problem *problem, const pg_scene *scene, bond_force_check check);
/* Reports a fault if the solver of the scene needs K, which forces with dilatations do not have. of: "", or
 * the setting because of which the force has a dilatation. */
void bond_force_refuse_matrix (const pg_problem *problem, const pg_scene *scene, const char *of);
/* Entries of pg_method. */
pg_status bond_force_limits (const pg_problem *problem, size_t material, pg_criterion_setting *setting);
void bond_force_check_laws (const pg_problem *problem, const pg_scene *scene);
/* pg_method.tip_offset of bond- and state-based forces, in spacings. */
double bond_force_tip_offset (const pg_problem *problem);
void bond_force_words (const pg_problem *problem, char *text, size_t size);

/* Unknowns above which static systems are solved by conjugate gradients. With the multilevel preconditioner a
 * solve is some 10 iterations of 15 sums over the bonds each, at any size, and making the preconditioner
 * costs two solves; analysis and factorization of K cost more from about 1000 unknowns on, but below 4000
 * (2D) and 1500 (3D) both take a few hundredths of a second: there the factor is used, whose residual is
 * rounding. With the diagonal as preconditioner the number of iterations grows as that of points along the
 * body. */
#define BOND_FORCE_ITERATES { { 0, 0, 4000, 1500 }, { 0, 0, 4e5, 3e4 } }
/* The entries of pg_method that all these forces share. */
#define BOND_FORCE_METHOD \
    .kernel = "constant", .horizon = 3.015, .iterate_above = BOND_FORCE_ITERATES, \
    .check_laws = bond_force_check_laws, .words = bond_force_words, .refuses = bond_force_refuses
const char *bond_force_refuses (const pg_problem *problem, unsigned solver);
#endif

/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tables of keys that several solvers share. Keys of one solver alone stand in its file, those that every one
 * reads in catalogue.c. */
#include "solve.h"

#define ROW PG_SOLVER_KEY
static const pg_key breaking[] = {
    ROW ("solver.break", PG_NAME, NULL, NULL, "worst", "worst|fraction|all|passing|facet",
         "Which bonds over the limit break before the next solve: the worst (with ties), those within "
         "break_fraction of it, or all (the peak load then depends on the increment). passing (with load "
         "stages, and the default there): at any iteration, once the load of the stage has taken effect. "
         "facet "
         "(criteria that judge the tips of cracks, and the default there; at rest and, in the plane, in "
         "motion): the crack grows by a facet, in space by a strip along its front, and all bonds "
         "that it crosses break."),
    ROW ("solver.break_fraction", PG_NUMBER, "1", "(0, 1)", "2 %", NULL, "For break: fraction."),
    ROW ("solver.tie", PG_NUMBER, "1", "[0, 0.1]", "1e-4", NULL,
         "Bonds within this share of the worst break with it: keeps symmetric scenes symmetric."),
    ROW ("solver.max_iterations", PG_INTEGER, NULL, "[1, 1000000000]", "100000", NULL,
         "Largest number of break-and-solve rounds of one step, or iterations of one stage; more: the step "
         "is refused."),
};
const pg_key_table solver_keys_breaking = { "solve", breaking, sizeof breaking / sizeof *breaking };

static const pg_key facets[] = {
    ROW ("solver.facet", PG_NUMBER, "m|spacing", "(0, inf)", "", NULL,
         "With break: facet: length of a facet, 0.25 to 4 spacings, in space the largest advance of a front, "
         "0.25 to 1 spacing; the local spacing if not given."),
    ROW ("solver.branching", PG_BOOL, NULL, NULL, "on", NULL,
         "With break: facet, in motion: a tip whose energy release rate at rest would be twice the fracture "
         "energy (from half the speed of Rayleigh waves on) branches in two."),
};
const pg_key_table solver_keys_facets = { "solve", facets, sizeof facets / sizeof *facets };

static const pg_key linear[] = {
    ROW ("solver.tolerance", PG_NUMBER, "1", "[1e-13, 1e-4]", "1e-8", NULL,
         "Largest accepted residual, relative to the reference force."),
    { "solver.linear", PG_NAME, NULL, NULL, "auto", NULL, pg_linear_names, NULL,
      "Linear solver; auto: the first, or one for indefinite matrices where K is not positive definite." },
    ROW ("solver.preconditioner", PG_NAME, NULL, NULL, "auto", "auto|jacobi|multilevel",
         "Of conjugate gradients without a matrix: the diagonal (jacobi), or grids of partition-of-unity "
         "functions over the points, split by cracks (multilevel: forces that provide the rows of K, static; "
         "galerkin: by finite elements on the points); auto: multilevel where possible."),
    ROW ("solver.division", PG_NAME, NULL, NULL, "auto", "auto|subdomains|matrices",
         "What the ranks of perigal-mpi share: points (subdomains: each rank holds its part of the body; "
         "conjugate gradients), or the factor of the matrix (matrices: each rank holds all "
         "points). auto: subdomains where the body is so large that one process would do without a factor as "
         "well, and nothing in the scene needs the whole body (facets, contact, platens, stages); else "
         "matrices. One process ignores it."),
};
const pg_key_table solver_keys_linear = { "solve", linear, sizeof linear / sizeof *linear };

static const pg_key step[] = {
    ROW ("solver.dt", PG_NUMBER, "s", "(0, inf)", "", NULL,
         "Time step, made a little smaller where a whole number does not fill the run. Solvers without "
         "linear systems: 0.9 of the stable one if not given."),
};
const pg_key_table solver_keys_step = { "solve", step, sizeof step / sizeof *step };

static const pg_key times[] = {
    ROW ("solver.end", PG_NUMBER, "s", "(0, inf)", "", NULL, "End time."),
    ROW ("solver.time_steps", PG_INTEGER, NULL, "[1, 1000000000]", "", NULL,
         "Number of time steps, instead of solver.end or of solver.dt."),
    ROW ("solver.mass", PG_NAME, NULL, NULL, "lumped", "lumped|consistent",
         "The mass of a node's cell at the node, or (implicit dynamics) int rho N_I N_J dV."),
    ROW ("solver.rayleigh.mass", PG_NUMBER, "1/s", "[0, inf)", "0", NULL,
         "Damping C = mass M + stiffness K."),
    ROW ("solver.rayleigh.stiffness", PG_NUMBER, "s", "[0, inf)", "0", NULL,
         "Damping C = mass M + stiffness K, of implicit dynamics alone."),
};
const pg_key_table solver_keys_time = { "solve", times, sizeof times / sizeof *times };

static const pg_key stages[] = {
    ROW ("solver.stages", PG_INTEGER, NULL, "[1, 1000000000]", "10", NULL,
         "Number of equal stages in which the load is applied."),
    ROW ("solver.hold", PG_BOOL, NULL, NULL, "on", NULL,
         "Each stage is iterated until it is in equilibrium and no bond breaks any more; off: one "
         "iteration per stage, never in equilibrium."),
    ROW ("solver.imbalance", PG_NUMBER, "1", "[1e-12, 0.1]", "1e-5", NULL,
         "A stage is in equilibrium when the out-of-balance force, and what it adds up to in the reactions, "
         "are at most this share of the loads (or reactions)."),
};
const pg_key_table solver_keys_stages = { "solve", stages, sizeof stages / sizeof *stages };

/* SPDX-License-Identifier: GPL-3.0-or-later
 * Keys of the solver and of the levels it reports at. */
#include "perigal/scene.h"
#include "perigal/solve.h"

#define ROW(path, kind, unit, range, fallback, choices, doc) \
    { path, kind, unit, range, fallback, choices, NULL, NULL, doc }
static const pg_key keys[] = {
    { "solver.kind", PG_NAME, NULL, NULL, "static", NULL, pg_solver_names, NULL,
      "The method that advances the state." },
    ROW ("solver.stepping", PG_NAME, NULL, NULL, "auto", "auto|event|fixed",
         "static: event goes from break to break, fixed takes equal load steps. event takes loads that grow "
         "with the load factor (in closed form), stay constant (ramp: constant; the first "
         "step is then at load factor 0), or both; auto: event when all loads are proportional."),
    ROW ("solver.break", PG_NAME, NULL, NULL, "worst", "worst|fraction|all|passing",
         "Which bonds over the limit break before the next solve: the worst (with ties), those within "
         "break_fraction of it, or all (as in the paper; "
         "the peak load then depends on the increment). adr and relax, their default: passing, at any "
         "iteration once the load of the stage has come to act."),
    ROW ("solver.break_fraction", PG_NUMBER, "1", "(0, 1)", "2 %", NULL, "For break: fraction."),
    ROW ("solver.tie", PG_NUMBER, "1", "[0, 0.1]", "1e-4", NULL,
         "Bonds within this share of the worst break with it: keeps symmetric scenes symmetric."),
    ROW ("solver.steps", PG_INTEGER, NULL, "[1, 100000000]", "20", NULL,
         "static, fixed: number of equal load steps."),
    ROW ("solver.tolerance", PG_NUMBER, "1", "[1e-13, 1e-4]", "1e-8", NULL,
         "Largest accepted residual, relative to the reference force."),
    ROW ("solver.max_iterations", PG_INTEGER, NULL, "[1, 1000000000]", "100000", NULL,
         "Most break-and-solve rounds of one step, or iterations of one stage; more: the step is refused."),
    ROW ("solver.max_events", PG_INTEGER, NULL, "[1, 1000000000]", "1000000", NULL,
         "Event stepping ends after so many events; verlet and central after so many time steps in which "
         "bonds broke."),
    ROW ("solver.stop.stiffness", PG_NUMBER, "1", "[0, 1)", "1e-3", NULL,
         "Event stepping ends when breaking has brought the work per squared load factor below this share of "
         "its first value (the body is apart)."),
    ROW ("solver.stop.set", PG_NAME, NULL, NULL, "", "sets.{}|left|right|bottom|top|back|front|all",
         "The run ends when the crack arrives at a point of this set."),
    ROW ("solver.stop.damage", PG_NUMBER, "1", "(0, 1]", "50 %", NULL,
         "Damage of a point of stop.set that counts as arrival."),
    ROW ("solver.linear", PG_NAME, NULL, NULL, "auto", "auto|cholmod|umfpack|pcg",
         "Linear solver; auto: cholmod, umfpack where K is not positive definite."),
    ROW ("solver.preconditioner", PG_NAME, NULL, NULL, "auto", "auto|jacobi|multilevel",
         "Of conjugate gradients without a matrix: the diagonal (jacobi), or grids of hats over the points, "
         "split by cracks (multilevel: forces that tell the "
         "rows of K, at rest); auto: multilevel where it can be."),
    ROW ("solver.dt", PG_NUMBER, "s", "(0, inf)", "", NULL,
         "Time step, made a little smaller where a whole number does not fill the run. verlet, central, "
         "relax: 0.9 of the stable one if not given."),
    ROW ("solver.end", PG_NUMBER, "s", "(0, inf)", "", NULL, "newmark, verlet, central: end time."),
    ROW ("solver.time_steps", PG_INTEGER, NULL, "[1, 1000000000]", "", NULL,
         "newmark, verlet, central: number of time steps, instead of solver.end or of solver.dt."),
    ROW ("solver.stages", PG_INTEGER, NULL, "[1, 1000000000]", "10", NULL,
         "adr, relax: the load comes in so many equal stages."),
    ROW ("solver.hold", PG_BOOL, NULL, NULL, "on", NULL,
         "adr, relax: each stage is held until it is balanced and no bond breaks any more; off: one "
         "iteration a stage, never in equilibrium."),
    ROW ("solver.imbalance", PG_NUMBER, "1", "[1e-12, 0.1]", "1e-5", NULL,
         "adr, relax: a stage is balanced when the out-of-balance force is at most this share of the loads "
         "(or reactions)."),
    ROW ("solver.damping", PG_NUMBER, "kg/m^3/s", "(0, inf)", "", NULL,
         "relax: artificial damping C; found anew at every iteration from the lowest frequency (Rayleigh's "
         "quotient) if not given."),
    ROW ("solver.mass", PG_NAME, NULL, NULL, "lumped", "lumped|consistent",
         "newmark: the mass of a node's cell at the node, or int rho N_I N_J dV."),
    ROW ("solver.alpha", PG_NUMBER, "1", "[-0.3333333333333334, 0]", "0", NULL,
         "newmark: numerical damping of Hilber, Hughes and Taylor; 0 none, -0.05 light, -1/3 most. It damps "
         "what the time step does not resolve."),
    ROW ("solver.beta", PG_NUMBER, "1", "(0, 1]", "", NULL,
         "newmark parameter; default (1 - alpha)^2 / 4, so 0.25 without alpha."),
    ROW ("solver.gamma", PG_NUMBER, "1", "[0.5, 1.5]", "", NULL, "newmark parameter; default 0.5 - alpha."),
    ROW ("solver.rayleigh.mass", PG_NUMBER, "1/s", "[0, inf)", "0", NULL,
         "newmark, verlet, central: damping C = mass M + stiffness K."),
    ROW ("solver.rayleigh.stiffness", PG_NUMBER, "s", "[0, inf)", "0", NULL,
         "newmark: damping C = mass M + stiffness K."),
    ROW ("output.at.levels", PG_INTEGER, NULL, "[1, 1000000]", "20", NULL,
         "Fields are written at this many equal levels of load (static, adr, relax) or time."),
    ROW ("output.at.rows", PG_INTEGER, NULL, "[1, 1000000]", "", NULL,
         "verlet, central, and hold: off: most rows of history.csv (but one for each level); if not given "
         "one for every ten time steps, 100 to 1000."),
};
const pg_key_table pg_keys_solve = { "solve", keys, sizeof keys / sizeof *keys };

/* SPDX-License-Identifier: GPL-3.0-or-later
 * Value of a compiled expression at a position: a stack machine. The compiler is in compile.c. */
#include "expression.h"
#include <math.h>
#include <string.h>

/* The variables, in the order of their operations. */
static const pg_variable variables[] = {
    { "x",     PG_OP_X,     "coordinate, m" },
    { "y",     PG_OP_Y,     "coordinate, m (0 in 1D)" },
    { "z",     PG_OP_Z,     "coordinate, m (0 in 1D and 2D)" },
    { "r",     PG_OP_R,     "distance from the origin, m" },
    { "angle", PG_OP_ANGLE, "atan2 (y, x), rad, from 0 up to 2 pi" },
    { "t",     PG_OP_T,     "time, s; the load factor 0 to 1 in a static scene" },
};

/* The functions: name, operation, number of arguments (-2: two or more), dimensions it takes and gives,
 * explanation. */
static const pg_function functions[] = {
    { "sin", PG_OP_SIN, 1, PG_TAKES_PLAIN, PG_GIVES_PLAIN, "sine of an angle" },
    { "cos", PG_OP_COS, 1, PG_TAKES_PLAIN, PG_GIVES_PLAIN, "cosine of an angle" },
    { "tan", PG_OP_TAN, 1, PG_TAKES_PLAIN, PG_GIVES_PLAIN, "tangent of an angle" },
    { "exp", PG_OP_EXP, 1, PG_TAKES_PLAIN, PG_GIVES_PLAIN, "exponential" },
    { "log", PG_OP_LOG, 1, PG_TAKES_PLAIN, PG_GIVES_PLAIN, "natural logarithm" },
    { "sqrt", PG_OP_SQRT, 1, PG_TAKES_ANY, PG_GIVES_ROOT, "square root" },
    { "abs", PG_OP_ABS, 1, PG_TAKES_ANY, PG_GIVES_SAME, "absolute value" },
    { "step", PG_OP_STEP, 1, PG_TAKES_ANY, PG_GIVES_PLAIN, "0 below 0, else 1" },
    { "min", PG_OP_MIN, -2, PG_TAKES_ALIKE, PG_GIVES_SAME, "smallest of two or more" },
    { "max", PG_OP_MAX, -2, PG_TAKES_ALIKE, PG_GIVES_SAME, "largest of two or more" },
    { "hypot", PG_OP_HYPOT, 2, PG_TAKES_ALIKE, PG_GIVES_SAME, "sqrt (a^2 + b^2)" },
    { "atan2", PG_OP_ATAN2, 2, PG_TAKES_ALIKE, PG_GIVES_PLAIN,
      "angle of the vector (b, a), rad, from -pi to pi" },
    { "phi", PG_OP_PHI, 1, PG_TAKES_PLAIN, PG_GIVES_PLAIN,
      "distribution function of the normal distribution: phi (random_field (2 mm, 7)) is uniform in 0 to 1, "
      "(-log (1 - phi (random_field (2 mm, 7))))^(1/8) has Weibull's distribution of modulus 8" },
    { "random_field", PG_OP_GAUSSIAN, 2, PG_TAKES_FIELD, PG_GIVES_PLAIN,
      "Gaussian random field of mean 0, variance 1 with the correlation length a (in m; exp (-r^2 / (2 a^2)) "
      "at a "
      "distance r) and the seed b, a function of place alone" },
};

/* Returns NULL past the end, which ends loops over all functions. */
const pg_function *pg_expression_function (size_t i)
{
    return i < sizeof functions / sizeof *functions ? &functions[i] : NULL;
}
const pg_variable *pg_expression_variable (size_t i)
{
    return i < sizeof variables / sizeof *variables ? &variables[i] : NULL;
}

/* ---- operations ---------------------------------------------------------------------------------------- */
/* Truth is 1 and 0; any number other than 0 is true. */
static double negate (double a)                 { return -a; }
static double not (double a)                    { return a == 0; }
static double step (double a)                   { return a >= 0; }
static double phi (double a)                    { return 0.5 * erfc (-a * 0.70710678118654752440); }
static double add (double a, double b)          { return a + b; }
static double subtract (double a, double b)     { return a - b; }
static double multiply (double a, double b)     { return a * b; }
static double divide (double a, double b)       { return a / b; }
static double smaller (double a, double b)      { return a < b ? a : b; }
static double larger (double a, double b)       { return a > b ? a : b; }
static double less (double a, double b)         { return a < b; }
static double at_most (double a, double b)      { return a <= b; }
static double more (double a, double b)         { return a > b; }
static double at_least (double a, double b)     { return a >= b; }
static double equal (double a, double b)        { return a == b; }
static double different (double a, double b)    { return a != b; }
static double and (double a, double b)          { return a != 0 && b != 0; }
static double or (double a, double b)           { return a != 0 || b != 0; }

/* Operations of one and of two numbers by their code. */
typedef double (*unary) (double a);
typedef double (*binary) (double a, double b);
static const unary of_one[] = {
    [PG_OP_NEGATE] = negate, [PG_OP_NOT] = not, [PG_OP_SIN] = sin, [PG_OP_COS] = cos, [PG_OP_TAN] = tan,
    [PG_OP_SQRT] = sqrt, [PG_OP_ABS] = fabs, [PG_OP_EXP] = exp, [PG_OP_LOG] = log, [PG_OP_STEP] = step,
    [PG_OP_PHI] = phi,
};
static const binary of_two[] = {
    [PG_OP_ADD] = add, [PG_OP_SUBTRACT] = subtract, [PG_OP_MULTIPLY] = multiply, [PG_OP_DIVIDE] = divide,
    [PG_OP_POWER] = pow, [PG_OP_MIN] = smaller, [PG_OP_MAX] = larger, [PG_OP_HYPOT] = hypot,
    [PG_OP_ATAN2] = atan2, [PG_OP_LESS] = less, [PG_OP_AT_MOST] = at_most, [PG_OP_MORE] = more,
    [PG_OP_AT_LEAST] = at_least, [PG_OP_EQUAL] = equal, [PG_OP_DIFFERENT] = different, [PG_OP_AND] = and,
    [PG_OP_OR] = or,
};

/* Value of an operation; the compiler uses it for constants too, so that they have the same bits. */
double pg_op_apply (pg_op op, double a, double b)
{
    size_t k = (size_t) op;
    if (k < sizeof of_one / sizeof *of_one && of_one[k]) return of_one[k] (a);
    if (k < sizeof of_two / sizeof *of_two && of_two[k]) return of_two[k] (a, b);
    return 0;
}

/* ---- evaluation ---------------------------------------------------------------------------------------- */
/* Runs the code; the order of pg_op tells how many operands an operation takes. */
double pg_expression_value (const pg_expression *e, const pg_place *at)
{
    double stack[PG_STACK];
    const double variable[] = { at->x, at->y, at->z, at->r, at->angle, at->t };
    size_t n = 0;
    for (size_t k = 0; k < e->n; k++) {
        pg_op op = e->code[k].op;
        /* Constants and variables push, operations of one number replace, those of two replace and drop
         * one. */
        if (op == PG_OP_CONSTANT) stack[n++] = e->code[k].value;
        else if (op == PG_OP_GAUSSIAN) stack[n++] = pg_field_value (e->field[(size_t) e->code[k].value], at);
        else if (op <= PG_OP_T) stack[n++] = variable[op - PG_OP_X];
        else if (op < PG_OP_ADD) stack[n - 1] = pg_op_apply (op, stack[n - 1], 0);
        else {
            n--;
            stack[n - 1] = pg_op_apply (op, stack[n - 1], stack[n]);
        }
    }
    return n ? stack[0] : 0;
}

/* Does the variable occur? The compiler has set bit `op` of `uses`. */
int pg_expression_uses (const pg_expression *e, char variable)
{
    for (size_t k = 0; k < sizeof variables / sizeof *variables; k++)
        /* Variables differ in their first letter. */
        if (variables[k].name[0] == variable) return (e->uses >> variables[k].op & 1) != 0;
    return 0;
}

/* Evaluated at the origin, as no variable occurs. */
int pg_expression_constant (const pg_expression *e, double *value)
{
    static const pg_place origin;
    if (e->uses) return 0;
    *value = pg_expression_value (e, &origin);
    return 1;
}

void pg_expression_free (pg_expression **e)
{
    if (!e || !*e) return;
    for (size_t k = 0; k < (*e)->nfield; k++) pg_free ((*e)->field[k]);
    pg_free ((*e)->field);
    pg_free ((*e)->code);
    pg_free (*e);
    *e = NULL;
}

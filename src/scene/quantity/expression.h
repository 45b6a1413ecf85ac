/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: the small stack machine that an expression is compiled to, and the words of the language. */
#ifndef PG_SCENE_EXPRESSION_H
#define PG_SCENE_EXPRESSION_H
#include "perigal/scene.h"

/* Height of the stack; the compiler refuses more. */
enum { PG_STACK = 64 };

/* Operations: a constant, a random field, variables, operations of one number, operations of two. */
typedef enum {
    PG_OP_CONSTANT,
    PG_OP_GAUSSIAN,
    PG_OP_X,
    PG_OP_Y,
    PG_OP_Z,
    PG_OP_R,
    PG_OP_ANGLE,
    PG_OP_T,
    PG_OP_NEGATE,
    PG_OP_NOT,
    PG_OP_SIN,
    PG_OP_COS,
    PG_OP_TAN,
    PG_OP_SQRT,
    PG_OP_ABS,
    PG_OP_EXP,
    PG_OP_LOG,
    PG_OP_STEP,
    PG_OP_PHI,
    PG_OP_ADD,
    PG_OP_SUBTRACT,
    PG_OP_MULTIPLY,
    PG_OP_DIVIDE,
    PG_OP_POWER,
    PG_OP_MIN,
    PG_OP_MAX,
    PG_OP_HYPOT,
    PG_OP_ATAN2,
    PG_OP_LESS,
    PG_OP_AT_MOST,
    PG_OP_MORE,
    PG_OP_AT_LEAST,
    PG_OP_EQUAL,
    PG_OP_DIFFERENT,
    PG_OP_AND,
    PG_OP_OR
} pg_op;

/* An instruction; value: of a constant, or the index of a random field. */
typedef struct { pg_op op; double value; } pg_code;

/* A compiled expression. */
struct pg_expression {
    pg_code *code;
    size_t   n, cap;
    /* Bit op is set for each variable that occurs. */
    unsigned uses;
    /* The plane waves of the random fields that occur (random_field.c). */
    double **field;
    size_t   nfield, fieldcap;
};

/* Dimensions of the arguments of a function (takes): none, any, the same for all; of its result (gives):
 * none, that of the argument, its square root. */
/* PG_TAKES_FIELD: the arguments are a length and a seed, both constant. */
typedef enum { PG_TAKES_PLAIN, PG_TAKES_ANY, PG_TAKES_ALIKE, PG_TAKES_FIELD } pg_takes;
typedef enum { PG_GIVES_PLAIN, PG_GIVES_SAME, PG_GIVES_ROOT } pg_gives;

/* A function of the language. */
typedef struct {
    const char *name;
    pg_op op;
    int arguments;
    pg_takes takes;
    pg_gives gives;
    const char *doc;
} pg_function;
/* A variable of the language. */
typedef struct { const char *name; pg_op op; const char *doc; } pg_variable;

/* Function or variable i; NULL past the end. */
const pg_function *pg_expression_function (size_t i);
const pg_variable *pg_expression_variable (size_t i);
/* Computes an operation on one (a) or two numbers. */
double pg_op_apply (pg_op op, double a, double b);
/* Creates the plane waves of a random field with a correlation length (m), freed by pg_free; returns the
 * value of the field at a position. */
pg_status pg_field_create (double **out, double length, double seed);
double    pg_field_value  (const double *wave, const pg_place *at);
/* 1: no variable occurs, and *value is the value of the expression. */
int    pg_expression_constant (const pg_expression *e, double *value);
#endif

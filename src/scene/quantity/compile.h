/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: what the files of the compiler of expressions share: the reader of the text, operands with their
 * dimension, code. */
#ifndef PG_SCENE_COMPILE_H
#define PG_SCENE_COMPILE_H
#include "expression.h"
#include "unit.h"

/* Largest number of nested levels; room for a word, in bytes. */
enum { PG_DEEPEST_NESTING = 60, PG_WORD = 40 };

/* A part of an expression. */
typedef struct {
    /* condition: 1: the part is a truth value; bare: 1: a number without unit; fixed: 1: its value is known
     * while compiling. */
    int        condition, bare, fixed;
    /* The value in SI, if fixed. */
    double     value;
    /* Dimension of the part. */
    pg_measure m;
    /* Number of the part's first instruction. */
    size_t     first;
} pg_operand;

/* State of the compiler. */
typedef struct {
    const char    *text;
    /* Next character. */
    size_t         at;
    /* Receives the code. */
    pg_expression *e;
    /* Depth of nesting; 1: t is a time in s, 0: a load factor; 1: t has occurred. */
    int            deep, t_is_time, met_t;
    /* Number of values on the stack; position of the last fault. */
    size_t         height, fault_at;
} pg_reader;

/* Records a fault at a position of the text. */
pg_status pg_read_fault (pg_reader *p, size_t at, const char *format, ...)
    __attribute__ ((format (printf, 3, 4)));
/* Records a fault at a position of the text and leaves; in functions with `status` and `done:`. */
#define PG_BAD(position, ...) do { status = pg_read_fault (p, (position), __VA_ARGS__); goto done; } while (0)
/* Skips blanks. */
void   pg_read_skip (pg_reader *p);
/* Skips the symbol if it is next in the text; returns 1 then. */
int    pg_read_take (pg_reader *p, const char *symbol);
int    pg_read_is_letter (char c);
/* Length of the word that begins at s; is the word of n bytes at s equal to `word`? */
size_t pg_word_length (const char *s);
int    pg_is_word (const char *s, size_t n, const char *word);
/* Is the word of n bytes at s a variable, a function or a word of the grammar, so that it cannot be a
 * unit? */
int    pg_is_own_word (const char *s, size_t n);
const pg_variable *pg_variable_of (const char *s, size_t n);
const pg_function *pg_function_of (const char *s, size_t n);

/* Appends an instruction; reports an expression that needs too many values on the stack. */
pg_status pg_operand_emit    (pg_reader *p, pg_op op, double value);
/* Appends a constant, in SI. */
pg_status pg_operand_push    (pg_reader *p, pg_operand *o, double value);
/* a <- op (a, b), computed now when both are known; b NULL: one argument. Code and value only, no
 * dimension. */
pg_status pg_operand_combine (pg_reader *p, pg_op op, pg_operand *a, const pg_operand *b);
/* Is the operand dimensionless? */
int       pg_operand_plain  (const pg_operand *o);
/* Reports an operand that is a condition where a number is needed. */
pg_status pg_operand_number (pg_reader *p, const pg_operand *o, size_t at);
/* Reports operands of different dimensions; one without unit takes the dimension of the other. verb: for the
 * message. */
pg_status pg_operand_agree    (pg_reader *p, pg_operand *a, const pg_operand *b, size_t at, const char *verb);
/* Give a the dimension of a product (sign 1) or quotient (-1) of a and b; of a power of a. */
void      pg_operand_multiply (pg_operand *a, const pg_operand *b, double sign);
void      pg_operand_raise    (pg_operand *a, double power);

/* Read a number with unit, a name (term.c), a whole expression (compile.c). */
pg_status pg_read_number (pg_reader *p, pg_operand *o);
pg_status pg_read_name   (pg_reader *p, pg_operand *o);
pg_status pg_read_or     (pg_reader *p, pg_operand *o);
#endif

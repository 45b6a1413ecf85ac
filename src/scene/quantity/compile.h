/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: what the files of the compiler share: the reader of the text, operands with their dimension,
 * code. */
#ifndef PG_SCENE_COMPILE_H
#define PG_SCENE_COMPILE_H
#include "expression.h"
#include "unit.h"

/* Nesting at most; length of a word. */
enum { PG_DEEPEST_NESTING = 60, PG_WORD = 40 };

/* A part of an expression. */
typedef struct {
    /* condition: it is a truth value; bare: a number without unit; fixed: its value is known while
     * compiling. */
    int        condition, bare, fixed;
    /* The value, when fixed. */
    double     value;
    /* Its dimension. */
    pg_measure m;
    /* Number of its first instruction. */
    size_t     first;
} pg_operand;

/* State of the compiler. */
typedef struct {
    const char    *text;
    /* Next character. */
    size_t         at;
    /* Receives the code. */
    pg_expression *e;
    /* Depth of nesting; whether t is in s or a load factor; whether t occurs. */
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
/* 1: the symbol was next and has been passed. */
int    pg_read_take (pg_reader *p, const char *symbol);
int    pg_read_is_letter (char c);
/* Length of the word that begins at s; is it this one? */
size_t pg_word_length (const char *s);
int    pg_is_word (const char *s, size_t n, const char *word);
/* Is it a word of the language, which cannot be a unit here? */
int    pg_is_own_word (const char *s, size_t n);
const pg_variable *pg_variable_of (const char *s, size_t n);
const pg_function *pg_function_of (const char *s, size_t n);

/* Appends an instruction; refuses a stack that would become too high. */
pg_status pg_operand_emit    (pg_reader *p, pg_op op, double value);
/* A constant. */
pg_status pg_operand_push    (pg_reader *p, pg_operand *o, double value);
/* a <- op (a, b), computed now when both are known; b NULL: one argument. Code and value only, no
 * dimension. */
pg_status pg_operand_combine (pg_reader *p, pg_op op, pg_operand *a, const pg_operand *b);
/* Is it dimensionless? */
int       pg_operand_plain  (const pg_operand *o);
/* A fault if it is a condition. */
pg_status pg_operand_number (pg_reader *p, const pg_operand *o, size_t at);
/* Makes a and b one dimension; a bare one takes that of the other. verb: for the message. */
pg_status pg_operand_agree    (pg_reader *p, pg_operand *a, const pg_operand *b, size_t at, const char *verb);
/* Dimension of a product (sign 1) or quotient (-1); of a power. */
void      pg_operand_multiply (pg_operand *a, const pg_operand *b, double sign);
void      pg_operand_raise    (pg_operand *a, double power);

/* Numbers and names (term.c); the whole grammar (compile.c). */
pg_status pg_read_number (pg_reader *p, pg_operand *o);
pg_status pg_read_name   (pg_reader *p, pg_operand *o);
pg_status pg_read_or     (pg_reader *p, pg_operand *o);
#endif

/* SPDX-License-Identifier: GPL-3.0-or-later
 * compile.h: what the files of the compiler share: the reader of the text, operands with their dimension,
 * code. */
#ifndef PG_SCENE_COMPILE_H
#define PG_SCENE_COMPILE_H
#include "expression.h"
#include "unit.h"

enum { PG_DEEPEST_NESTING = 60, PG_WORD = 40 };

typedef struct {
    int        condition, bare, fixed;  /* a truth value; a number without unit; known while compiling */
    double     value;                                  /* when fixed */
    pg_measure m;
    size_t     first;                                  /* its first instruction */
} pg_operand;

typedef struct {
    const char    *text;
    size_t         at;                                 /* next character */
    pg_expression *e;
    int            deep, t_is_time, met_t;             /* nesting; t in s or a plain load factor; t occurs */
    size_t         height, fault_at;                   /* values on the stack; column - 1 of the fault */
} pg_reader;

/* text (lex.c) */
pg_status pg_read_fault (pg_reader *p, size_t at, const char *format, ...)
    __attribute__ ((format (printf, 3, 4)));
#define PG_BAD(position, ...) do { status = pg_read_fault (p, (position), __VA_ARGS__); goto done; } while (0)
void   pg_read_skip (pg_reader *p);                    /* spaces */
int    pg_read_take (pg_reader *p, const char *symbol);    /* 1: it was next and is passed */
int    pg_read_is_letter (char c);
size_t pg_word_length (const char *s);
int    pg_is_word (const char *s, size_t n, const char *word);
int    pg_is_own_word (const char *s, size_t n);       /* a word that cannot be a unit here */
const pg_variable *pg_variable_of (const char *s, size_t n);
const pg_function *pg_function_of (const char *s, size_t n);

/* code and dimensions (operand.c) */
pg_status pg_operand_emit    (pg_reader *p, pg_op op, double value);
pg_status pg_operand_push    (pg_reader *p, pg_operand *o, double value);
/* a <- op (a, b), folded when both are known; b NULL: one argument. Sets code and value only. */
pg_status pg_operand_combine (pg_reader *p, pg_op op, pg_operand *a, const pg_operand *b);
int       pg_operand_plain  (const pg_operand *o);
pg_status pg_operand_number (pg_reader *p, const pg_operand *o, size_t at);
/* Makes a and b one dimension; a bare one takes that of the other. */
pg_status pg_operand_agree    (pg_reader *p, pg_operand *a, const pg_operand *b, size_t at, const char *verb);
/* dimensions; sign -1 divides */
void      pg_operand_multiply (pg_operand *a, const pg_operand *b, double sign);
void      pg_operand_raise    (pg_operand *a, double power);

/* numbers and names (term.c), the whole grammar (compile.c) */
pg_status pg_read_number (pg_reader *p, pg_operand *o);
pg_status pg_read_name   (pg_reader *p, pg_operand *o);
pg_status pg_read_or     (pg_reader *p, pg_operand *o);
#endif

/* SPDX-License-Identifier: GPL-3.0-or-later
 * Operands of an expression: code for the stack machine with constants computed at once, and the dimension
 * of each part. Values are always in SI; dimensions exist only while compiling and cost nothing when an
 * expression is evaluated. */
#include "compile.h"

/* ---- appending code ------------------------------------------------------------------------------------ */
/* Constants and variables push a value, operations of two numbers remove one. */
pg_status pg_operand_emit (pg_reader *p, pg_op op, double value)
{
    pg_status status = PG_OK;
    PG_GROW (p->e->code, p->e->cap, p->e->n + 1);
    p->e->code[p->e->n++] = (pg_code) { op, value };
    if (op <= PG_OP_T && ++p->height > PG_STACK) PG_BAD (p->at, "the expression is too long");
    if (op >= PG_OP_ADD) p->height--;
done:
    return status;
}

pg_status pg_operand_push (pg_reader *p, pg_operand *o, double value)
{
    o->first = p->e->n;
    o->fixed = 1;
    o->value = value;
    return pg_operand_emit (p, PG_OP_CONSTANT, value);
}

/* Applies an operation to operands; if their values are known, only one constant remains in the code. */
pg_status pg_operand_combine (pg_reader *p, pg_op op, pg_operand *a, const pg_operand *b)
{
    if (!a->fixed || (b && !b->fixed)) {
        a->fixed = 0;
        return pg_operand_emit (p, op, 0);
    }
    a->value = pg_op_apply (op, a->value, b ? b->value : 0);
    p->e->n = a->first + 1;
    p->e->code[a->first].value = a->value;
    if (b) p->height--;
    return PG_OK;
}

/* ---- dimensions of operands ---------------------------------------------------------------------------- */
int pg_operand_plain (const pg_operand *o) { return o->bare || pg_measure_plain (&o->m); }

pg_status pg_operand_number (pg_reader *p, const pg_operand *o, size_t at)
{
    return o->condition ? pg_read_fault (p, at, "a condition cannot be used as a number") : PG_OK;
}

/* If only the left operand has no unit it takes the dimension of the right one. */
pg_status pg_operand_agree (pg_reader *p, pg_operand *a, const pg_operand *b, size_t at, const char *verb)
{
    char left[80], right[80];
    if (a->condition || b->condition) return pg_read_fault (p, at, "cannot %s a condition", verb);
    if (b->bare) return PG_OK;
    if (a->bare) {
        a->m = b->m;
        a->bare = 0;
        return PG_OK;
    }
    if (pg_measure_same (&a->m, &b->m)) return PG_OK;
    pg_measure_text (&a->m, left, sizeof left);
    pg_measure_text (&b->m, right, sizeof right);
    return pg_read_fault (p, at, "cannot %s %s and %s", verb, left, right);
}

void pg_operand_multiply (pg_operand *a, const pg_operand *b, double sign)
{
    a->bare = (a->bare && pg_operand_plain (b)) || (b->bare && pg_operand_plain (a));
    for (int k = 0; k < PG_BASE_UNITS; k++) a->m.power[k] += sign * b->m.power[k];
}

void pg_operand_raise (pg_operand *a, double power)
{
    for (int k = 0; k < PG_BASE_UNITS; k++) a->m.power[k] *= power;
}

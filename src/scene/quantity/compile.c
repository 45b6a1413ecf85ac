/* SPDX-License-Identifier: GPL-3.0-or-later
 * Compiles the text of an expression into code for a stack machine, by recursive descent, with the
 * dimension of every part. Precedence, loose to tight: or, and, not, comparison, + -, * /, sign, ^. A
 * number without unit fits any unit (it is in SI); the product of such a number with something
 * dimensionless remains one. */
#include "compile.h"
#include <ctype.h>
#include <math.h>
#include <string.h>

/* Largest number of characters of an expression. */
enum { LONGEST = 100000 };

/* A rule of the grammar: reads its part of the text and describes it as an operand. */
typedef pg_status (*rule) (pg_reader *, pg_operand *);
static pg_status read_unary (pg_reader *, pg_operand *);

/* Reads a number with unit, a name, or an expression in parentheses. */
static pg_status read_primary (pg_reader *p, pg_operand *o)
{
    pg_status status = PG_OK;
    pg_read_skip (p);
    size_t at = p->at;
    const char *s = p->text + at;
    /* Bounds the recursion: a long row of parentheses must not exhaust the stack. */
    if (++p->deep > PG_DEEPEST_NESTING) PG_BAD (at, "nested too deeply");
    o->m = (pg_measure) { .factor = 1 };
    if (pg_read_take (p, "(")) {
        PG_TRY (pg_read_or (p, o));
        if (!pg_read_take (p, ")")) PG_BAD (p->at, "')' is missing");
    } else if (pg_number_end (s) && *s != '-' && *s != '+') PG_TRY (pg_read_number (p, o));
    else if (pg_read_is_letter (*s) && *s != '%') PG_TRY (pg_read_name (p, o));
    else if (*s == '\0') PG_BAD (at, "a number or a name is missing at the end");
    else PG_BAD (at, "a number or a name is expected, not '%c'", isprint ((unsigned char) *s) ? *s : '?');
    p->deep--;
done:
    return status;
}

/* ---- operators, from the tightest to the loosest ------------------------------------------------------- */
/* Reads a ^ b; ^ binds to the right, as b may begin with a sign and hold a power of its own. */
static pg_status read_power (pg_reader *p, pg_operand *o)
{
    pg_status status = PG_OK;
    pg_operand b = { 0 };
    pg_read_skip (p);
    size_t start = p->at;
    PG_TRY (read_primary (p, o));
    size_t at = p->at;
    if (!pg_read_take (p, "^")) goto done;
    PG_TRY (pg_operand_number (p, o, start));
    at = p->at;
    PG_TRY (read_unary (p, &b));
    PG_TRY (pg_operand_number (p, &b, at));
    if (!pg_operand_plain (&b)) PG_BAD (at, "an exponent has no unit");
    if (!pg_operand_plain (o) && !b.fixed) PG_BAD (at, "a quantity with a unit needs a constant exponent");
    /* The dimension is raised with the value. */
    if (!pg_operand_plain (o)) pg_operand_raise (o, b.value);
    PG_TRY (pg_operand_combine (p, PG_OP_POWER, o, &b));
done:
    return status;
}

/* Reads signs before an operand. */
static pg_status read_unary (pg_reader *p, pg_operand *o)
{
    pg_status status = PG_OK;
    int minus = pg_read_take (p, "-");
    if (!minus && !pg_read_take (p, "+")) return read_power (p, o);
    size_t at = p->at;
    if (++p->deep > PG_DEEPEST_NESTING) PG_BAD (at, "nested too deeply");
    PG_TRY (read_unary (p, o));
    PG_TRY (pg_operand_number (p, o, at));
    if (minus) PG_TRY (pg_operand_combine (p, PG_OP_NEGATE, o, NULL));
    p->deep--;
done:
    return status;
}

/* Reads * and /, from left to right. */
static pg_status read_product (pg_reader *p, pg_operand *o)
{
    pg_status status = PG_OK;
    pg_read_skip (p);
    size_t start = p->at;
    PG_TRY (read_unary (p, o));
    for (;;) {
        pg_operand b = { 0 };
        int times = pg_read_take (p, "*");
        if (!times && !pg_read_take (p, "/")) break;
        size_t at = p->at;
        /* ** is the power of other languages. */
        if (times && p->text[at] == '*') PG_BAD (at - 1, "a power is written with ^");
        PG_TRY (pg_operand_number (p, o, start));
        PG_TRY (read_unary (p, &b));
        PG_TRY (pg_operand_number (p, &b, at));
        pg_operand_multiply (o, &b, times ? 1 : -1);
        PG_TRY (pg_operand_combine (p, times ? PG_OP_MULTIPLY : PG_OP_DIVIDE, o, &b));
    }
done:
    return status;
}

/* Reads + and -, from left to right; both sides need the same dimension. */
static pg_status read_sum (pg_reader *p, pg_operand *o)
{
    pg_status status = PG_OK;
    PG_TRY (read_product (p, o));
    for (;;) {
        pg_operand b = { 0 };
        pg_read_skip (p);
        size_t at = p->at;
        int plus = pg_read_take (p, "+");
        if (!plus && !pg_read_take (p, "-")) break;
        PG_TRY (read_product (p, &b));
        PG_TRY (pg_operand_agree (p, o, &b, at, plus ? "add" : "subtract"));
        PG_TRY (pg_operand_combine (p, plus ? PG_OP_ADD : PG_OP_SUBTRACT, o, &b));
    }
done:
    return status;
}

/* Skips a comparison sign and returns its operation; longer signs are tried first. */
static int take_comparison (pg_reader *p, pg_op *op)
{
    static const struct { const char *sign; pg_op op; } signs[] = {
        { "<=", PG_OP_AT_MOST }, { ">=", PG_OP_AT_LEAST }, { "==", PG_OP_EQUAL }, { "!=", PG_OP_DIFFERENT },
        { "<", PG_OP_LESS }, { ">", PG_OP_MORE },
    };
    for (size_t k = 0; k < sizeof signs / sizeof *signs; k++) {
        if (!pg_read_take (p, signs[k].sign)) continue;
        *op = signs[k].op;
        return 1;
    }
    return 0;
}

/* Reads at most one comparison: a < b < c would mean something else than in mathematics. */
static pg_status read_comparison (pg_reader *p, pg_operand *o)
{
    pg_status status = PG_OK;
    pg_operand b = { 0 };
    pg_op op;
    PG_TRY (read_sum (p, o));
    pg_read_skip (p);
    size_t at = p->at;
    if (!take_comparison (p, &op)) goto done;
    PG_TRY (read_sum (p, &b));
    PG_TRY (pg_operand_agree (p, o, &b, at, "compare"));
    PG_TRY (pg_operand_combine (p, op, o, &b));
    o->condition = 1;
    o->bare = 0;
    at = p->at;
    if (take_comparison (p, &op)) PG_BAD (at, "join two comparisons with 'and'");
done:
    return status;
}

/* Reads `not`, which needs a condition. */
static pg_status read_not (pg_reader *p, pg_operand *o)
{
    pg_status status = PG_OK;
    pg_read_skip (p);
    size_t at = p->at;
    if (!pg_read_take (p, "not")) return read_comparison (p, o);
    if (++p->deep > PG_DEEPEST_NESTING) PG_BAD (at, "nested too deeply");
    PG_TRY (read_not (p, o));
    if (!o->condition) PG_BAD (at, "'not' needs a condition");
    PG_TRY (pg_operand_combine (p, PG_OP_NOT, o, NULL));
    p->deep--;
done:
    return status;
}

/* Reads operands by the rule `next`, joined by `word`. */
static pg_status read_joined (pg_reader *p, pg_operand *o, const char *word, pg_op op, rule next)
{
    pg_status status = PG_OK;
    PG_TRY (next (p, o));
    for (;;) {
        pg_operand b = { 0 };
        pg_read_skip (p);
        size_t at = p->at;
        if (!pg_read_take (p, word)) break;
        PG_TRY (next (p, &b));
        if (!o->condition || !b.condition) PG_BAD (at, "'%s' needs a condition on both sides", word);
        PG_TRY (pg_operand_combine (p, op, o, &b));
    }
done:
    return status;
}

static pg_status read_and (pg_reader *p, pg_operand *o)
{
    return read_joined (p, o, "and", PG_OP_AND, read_not);
}
pg_status pg_read_or (pg_reader *p, pg_operand *o) { return read_joined (p, o, "or", PG_OP_OR, read_and); }

/* ---- the whole expression ------------------------------------------------------------------------------ */
/* Has the result the unit that is wanted? A number without unit fits any. */
static pg_status check_result (pg_reader *p, const pg_operand *o, const char *unit)
{
    pg_measure wanted;
    char given[80];
    if (strcmp (unit, "bool") == 0)
        return o->condition ? PG_OK : pg_read_fault (p, 0, "a condition is expected, for example x > 5 mm");
    size_t n = strcspn (unit, "|");
    if (o->condition)
        return pg_read_fault (p, 0, "this is a condition, expected a value in %.*s", (int) n, unit);
    pg_status status = pg_measure_read (&wanted, unit, n);
    if (status != PG_OK || o->bare || pg_measure_same (&o->m, &wanted)) return status;
    pg_measure_text (&o->m, given, sizeof given);
    return pg_read_fault (p, 0, "the result is in %s, expected %.*s", given, (int) n, unit);
}

/* Reads the whole text, which must be one expression. */
static pg_status read_all (pg_reader *p, const char *unit)
{
    pg_status status = PG_OK;
    pg_operand o = { 0 };
    const char *rest;
    PG_TRY (pg_read_or (p, &o));
    pg_read_skip (p);
    rest = p->text + p->at;
    if (rest[0] == '=') PG_BAD (p->at, "equality is written ==");
    if (rest[0] == '&' || rest[0] == '|' || rest[0] == '!') PG_BAD (p->at, "use the words and, or, not");
    if (rest[0]) PG_BAD (p->at, "'%.20s' is not expected here", rest);
    PG_TRY (check_result (p, &o, unit));
done:
    return status;
}

/* Compiles a plain quantity in the full grammar of units ("5 1/s", "2 m s-1"), or an expression. t is taken
 * as a time in seconds first and, if that does not fit, as the load factor; of two faults the one farther on
 * in the text is reported. */
static pg_status compile (pg_reader *p, const char *unit)
{
    pg_status status = PG_OK;
    pg_operand o = { 0 };
    double value;
    char message[500] = "";
    size_t first = 0;
    /* Most values are plain quantities. */
    if (strcmp (unit, "bool") != 0) {
        status = pg_unit_parse (&value, p->text, unit);
        if (status == PG_OK) return pg_operand_push (p, &o, value);
        if (status != PG_E_SCENE) return status;
    }
    pg_expression *e = p->e;
    /* The second pass is needed only if t occurs and does not fit as a time. */
    for (int time = 1; time >= 0; time--) {
        e->n = e->uses = 0;
        *p = (pg_reader) { .text = p->text, .e = e, .t_is_time = time };
        status = read_all (p, unit);
        if (status != PG_E_SCENE || !p->met_t) break;
        if (time) {
            snprintf (message, sizeof message, "%s", pg_last_error ());
            first = p->fault_at;
        }
    }
    if (status == PG_E_SCENE && *message && first >= p->fault_at)
        return pg_error (PG_E_SCENE, PG_HERE, "%s", message);
    return status;
}

/* Compiles an expression; its values are in SI, whatever units the text uses. */
pg_status pg_expression_compile (pg_expression **out, const char *text, const char *unit)
{
    pg_status status = PG_OK;
    pg_reader p = { .text = text };
    if (!unit) unit = "1";
    *out = NULL;
    if (strlen (text) > LONGEST) PG_FAIL (PG_E_SCENE, "column %d: the expression is too long", LONGEST);
    PG_ALLOC (p.e, 1);
    PG_TRY (compile (&p, unit));
    *out = p.e;
    p.e = NULL;
done:
    pg_expression_free (&p.e);
    return status;
}

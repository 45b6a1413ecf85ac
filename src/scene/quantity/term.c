/* SPDX-License-Identifier: GPL-3.0-or-later
 * Reads numbers with units, names and calls of functions in an expression. A unit is what follows a number
 * and is no word of the language: in "2 mm * x" mm is a unit, in "2 * x" x is the variable, and "2 x" is
 * refused as ambiguous. */
#include "compile.h"
#include <math.h>
#include <string.h>

/* Length of an exponent, "^2" or "^-1"; 0: there is no whole exponent. */
static size_t exponent_length (const char *s)
{
    size_t n = *s == '^';
    if (!n) return 0;
    n += s[n] == '-';
    size_t digits = strspn (s + n, "0123456789");
    return digits && s[n + digits] != '.' ? n + digits : 0;
}

/* Reads the unit after a number: "mm", "kN/m2", "kN m": words that are no words of the language. It is copied
 * without blanks. */
static pg_status read_unit (pg_reader *p, char *unit, size_t size)
{
    pg_status status = PG_OK;
    size_t used = 0;
    for (;;) {
        /* A quotient or, by a blank, a product of units; where no unit follows, the reader returns to
         * `start`. */
        size_t start = p->at;
        pg_read_skip (p);
        const char *joint = "";
        if (used && p->text[p->at] == '/') {
            p->at++;
            pg_read_skip (p);
            joint = "/";
        } else if (used) joint = ".";
        const char *s = p->text + p->at;
        size_t n = pg_word_length (s);
        /* "2 x" would read as two units of x: the user must write 2*x. */
        const pg_variable *v = pg_variable_of (s, n);
        if (n && v && *joint != '/')
            PG_BAD (p->at, "'%s' is a variable: write a sign before it, as in 2*%s", v->name, v->name);
        if (n == 0 || pg_is_own_word (s, n)) {
            p->at = start;
            break;
        }
        n += exponent_length (s + n);
        if (used + n + 2 > size) PG_BAD (p->at, "the unit is too long");
        used += (size_t) snprintf (unit + used, size - used, "%s%.*s", joint, (int) n, s);
        p->at += n;
    }
    unit[used] = '\0';
done:
    return status;
}

/* Reads a unit; an error becomes a fault at position `at`. */
static pg_status measure_of (pg_reader *p, pg_measure *m, const char *word, size_t n, size_t at)
{
    pg_status status = pg_measure_read (m, word, n);
    if (status != PG_E_SCENE) return status;
    char why[300];
    snprintf (why, sizeof why, "%s", pg_last_error ());
    return pg_read_fault (p, at, "%s", why);
}

/* Reads a number with its unit. Sizes beyond 1e60 or below 1e-60 are refused: their products would leave the
 * range of a double. */
pg_status pg_read_number (pg_reader *p, pg_operand *o)
{
    pg_status status = PG_OK;
    char unit[PG_WORD];
    double value = 0;
    size_t start = p->at;
    p->at = (size_t) (pg_number_read (p->text + start, &value) - p->text);
    size_t at = p->at;
    PG_TRY (read_unit (p, unit, sizeof unit));
    o->bare = *unit == '\0';
    if (*unit) {
        PG_TRY (measure_of (p, &o->m, unit, strlen (unit), at));
        value = pg_measure_scale (value, &o->m);
    }
    if (!(fabs (value) <= 1e60)) PG_BAD (start, "the number is too large: in SI units at most 1e60");
    if (value != 0 && fabs (value) < 1e-60)
        PG_BAD (start, "the number is too small: in SI units 0, or at least 1e-60");
    PG_TRY (pg_operand_push (p, o, value));
done:
    return status;
}

/* Reads argument n of a function: the first becomes o, each other one is combined with it. */
static pg_status read_argument (pg_reader *p, pg_operand *o, const pg_function *f, int n)
{
    pg_status status = PG_OK;
    pg_operand b = { 0 };
    pg_read_skip (p);
    size_t at = p->at;
    PG_TRY (pg_read_or (p, n ? &b : o));
    PG_TRY (pg_operand_number (p, n ? &b : o, at));
    if (f->takes == PG_TAKES_PLAIN && !pg_operand_plain (o)) {
        char text[80];
        pg_measure_text (&o->m, text, sizeof text);
        PG_BAD (at, "%s needs a plain number or an angle, not %s", f->name, text);
    }
    if (n == 0) goto done;
    if (n >= f->arguments && f->arguments > 0)
        PG_BAD (at, "%s takes %d argument%s", f->name, f->arguments, f->arguments > 1 ? "s" : "");
    PG_TRY (pg_operand_agree (p, o, &b, at, "compare"));
    PG_TRY (pg_operand_combine (p, f->op, o, &b));
done:
    return status;
}

/* Reads random_field (length, seed) after its name: both are computed now, and their code is replaced by one
 * instruction. */
static pg_status read_field (pg_reader *p, pg_operand *o)
{
    pg_status status = PG_OK;
    pg_operand seed = { 0 };
    pg_expression *e = p->e;
    size_t start = p->at;
    if (!pg_read_take (p, "(")) PG_BAD (p->at, "random_field needs a length and a seed in ( )");
    PG_TRY (pg_read_or (p, o));
    if (!pg_read_take (p, ",")) PG_BAD (p->at, "random_field takes 2 arguments: a length and a seed");
    PG_TRY (pg_read_or (p, &seed));
    if (!pg_read_take (p, ")")) PG_BAD (p->at, "')' is missing");
    pg_measure metre = { .factor = 1, .power = { 1 } };
    if (!o->fixed || o->condition || !(o->bare || pg_measure_same (&o->m, &metre)) || !(o->value > 0))
        PG_BAD (start, "the first argument of random_field is its correlation length, such as 2 mm");
    if (!seed.fixed || seed.condition || !pg_operand_plain (&seed) || seed.value != floor (seed.value)
        || !(fabs (seed.value) <= 1e15))
        PG_BAD (start, "the second argument of random_field is its seed, a whole number");
    e->n = o->first, p->height -= 2;
    PG_GROW (e->field, e->fieldcap, e->nfield + 1);
    PG_TRY (pg_field_create (&e->field[e->nfield], o->value, seed.value));
    e->nfield++;
    e->uses |= 1u << PG_OP_X | 1u << PG_OP_Y | 1u << PG_OP_Z;
    PG_TRY (pg_operand_emit (p, PG_OP_GAUSSIAN, (double) (e->nfield - 1)));
    *o = (pg_operand) { .first = o->first, .m = { .factor = 1 } };
done:
    return status;
}

/* Reads the arguments of a function after its name: "( argument, ... )". */
static pg_status read_call (pg_reader *p, pg_operand *o, const pg_function *f)
{
    pg_status status = PG_OK;
    size_t start = p->at - strlen (f->name);
    int n = 0;
    if (f->takes == PG_TAKES_FIELD) return read_field (p, o);
    if (!pg_read_take (p, "(")) PG_BAD (p->at, "%s needs an argument in ( )", f->name);
    /* Arguments from the second on are combined with the first by the operation of the function. */
    do PG_TRY (read_argument (p, o, f, n++)); while (pg_read_take (p, ","));
    if (!pg_read_take (p, ")")) PG_BAD (p->at, "')' is missing");
    if (n < f->arguments) PG_BAD (start, "%s takes %d arguments", f->name, f->arguments);
    if (n < -f->arguments) PG_BAD (start, "%s takes at least %d arguments", f->name, -f->arguments);
    if (n == 1) PG_TRY (pg_operand_combine (p, f->op, o, NULL));
    if (f->gives == PG_GIVES_ROOT) pg_operand_raise (o, 0.5);
    if (f->gives == PG_GIVES_PLAIN) {
        o->m = (pg_measure) { .factor = 1 };
        o->bare = 0;
    }
done:
    return status;
}

/* Writes the message for an unknown name. */
static void unknown_name (const char *s, size_t n, char *out, size_t size)
{
    char known[400] = "pi", word[PG_WORD];
    size_t used = strlen (known);
    for (size_t k = 0; pg_expression_variable (k); k++)
        used += (size_t) snprintf (known + used, sizeof known - used, "|%s",
                                   pg_expression_variable (k)->name);
    for (size_t k = 0; pg_expression_function (k); k++)
        used += (size_t) snprintf (known + used, sizeof known - used, "|%s",
                                   pg_expression_function (k)->name);
    snprintf (word, sizeof word, "%.*s", (int) (n < PG_WORD ? n : PG_WORD - 1), s);
    const char *near = pg_nearest_name (word, known);
    if (near) snprintf (out, size, "unknown name '%s'; did you mean %s?", word, near);
    else snprintf (out, size, "unknown name '%s'; variables are x, y, z, r, angle, t", word);
}

/* Reads a variable. Coordinates are in m; t is in s or a plain number. */
static pg_status read_variable (pg_reader *p, pg_operand *o, const pg_variable *v)
{
    o->first = p->e->n;
    o->m = (pg_measure) { .factor = 1 };
    if (v->op <= PG_OP_R) o->m.power[0] = 1;
    if (v->op == PG_OP_T) {
        p->met_t = 1;
        o->m.power[2] = p->t_is_time;
    }
    p->e->uses |= 1u << v->op;
    return pg_operand_emit (p, v->op, 0);
}

/* Reads a variable, a function, pi, a truth value, or a unit by itself as in x/mm. */
pg_status pg_read_name (pg_reader *p, pg_operand *o)
{
    pg_status status = PG_OK;
    const char *s = p->text + p->at;
    size_t n = pg_word_length (s), at = p->at;
    char why[200];
    const pg_variable *v = pg_variable_of (s, n);
    const pg_function *f = pg_function_of (s, n);
    p->at += n;
    o->m = (pg_measure) { .factor = 1 };
    /* Words of the language hide units of the same name, such as t. */
    if (v) PG_TRY (read_variable (p, o, v));
    else if (f) PG_TRY (read_call (p, o, f));
    else if (pg_is_word (s, n, "pi")) {
        o->bare = 1;
        PG_TRY (pg_operand_push (p, o, 3.14159265358979323846));
    } else if (pg_is_word (s, n, "true") || pg_is_word (s, n, "false")) {
        o->condition = 1;
        PG_TRY (pg_operand_push (p, o, *s == 't'));
    /* a unit by itself, as in x/mm */
    } else if (!pg_is_own_word (s, n) && pg_measure_read (&o->m, s, n) == PG_OK) {
        PG_TRY (pg_operand_push (p, o, o->m.factor));
    } else {
        unknown_name (s, n, why, sizeof why);
        PG_BAD (at, "%s", why);
    }
done:
    return status;
}

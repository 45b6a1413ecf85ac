/* SPDX-License-Identifier: GPL-3.0-or-later
 * Reads words and signs in the text of an expression. */
#include "compile.h"
#include <ctype.h>
#include <stdarg.h>
#include <string.h>

/* Reports a fault with its column, counted from 1. */
pg_status pg_read_fault (pg_reader *p, size_t at, const char *format, ...)
{
    char text[400];
    va_list args;
    va_start (args, format);
    vsnprintf (text, sizeof text, format, args);
    va_end (args);
    p->fault_at = at;
    return pg_error (PG_E_SCENE, PG_HERE, "column %zu: %s", at + 1, text);
}

/* Skips blanks and line ends: expressions may be folded in YAML. */
void pg_read_skip (pg_reader *p)
{
    while (p->text[p->at] && strchr (" \t\r\n", p->text[p->at])) p->at++;
}

/* Bytes from 0x80 on are parts of letters in UTF-8, such as the micro sign. */
int pg_read_is_letter (char c)
{
    return isalpha ((unsigned char) c) || c == '_' || c == '%' || (unsigned char) c >= 0x80;
}

/* Length of a word; the sign % is a word of its own. */
size_t pg_word_length (const char *s)
{
    size_t n = 0;
    if (*s == '%') return 1;
    while (pg_read_is_letter (s[n]) || (n > 0 && isdigit ((unsigned char) s[n]))) n++;
    return n;
}

/* Is the word of n bytes at s equal to `word`? */
int pg_is_word (const char *s, size_t n, const char *word)
{
    return strlen (word) == n && memcmp (s, word, n) == 0;
}

/* Skips a symbol; one of letters must be a whole word. */
int pg_read_take (pg_reader *p, const char *symbol)
{
    pg_read_skip (p);
    size_t n = strlen (symbol);
    if (strncmp (p->text + p->at, symbol, n) != 0) return 0;
    if (isalpha ((unsigned char) *symbol) && pg_word_length (p->text + p->at) != n) return 0;
    p->at += n;
    return 1;
}

const pg_variable *pg_variable_of (const char *s, size_t n)
{
    for (size_t k = 0; pg_expression_variable (k); k++)
        if (pg_is_word (s, n, pg_expression_variable (k)->name)) return pg_expression_variable (k);
    return NULL;
}

const pg_function *pg_function_of (const char *s, size_t n)
{
    for (size_t k = 0; pg_expression_function (k); k++)
        if (pg_is_word (s, n, pg_expression_function (k)->name)) return pg_expression_function (k);
    return NULL;
}

/* Variables, functions and the words of the grammar cannot be units. */
int pg_is_own_word (const char *s, size_t n)
{
    static const char *const words[] = { "and", "or", "not", "pi", "true", "false" };
    for (size_t k = 0; k < sizeof words / sizeof *words; k++)
        if (pg_is_word (s, n, words[k])) return 1;
    return pg_variable_of (s, n) || pg_function_of (s, n);
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * Functions that every study uses: lists of words from a command line, and exit codes of processes. */
#include "perigal/study.h"
#include <string.h>

/* Splits a list at its commas. An empty word, such as in "a,,b", is refused rather than skipped: it usually
 * is a slip. */
int pg_word_list_split (pg_word_list *out, const char *text)
{
    memset (out, 0, sizeof *out);
    out->given = 1;
    for (const char *s = text;; s++) {
        size_t n = strcspn (s, ",");
        if (n == 0 || n >= PG_LIST_TEXT || out->n >= PG_LIST_WORDS) return 0;
        snprintf (out->word[out->n++], PG_LIST_TEXT, "%.*s", (int) n, s);
        s += n;
        if (!*s) return 1;
    }
}

/* Turns a status into an exit code. Every failure but those of the command line, the scene or an interruption
 * counts as "failed". */
int pg_exit_code (pg_status status)
{
    switch (status) {
    case PG_OK: return PG_EXIT_DONE;
    case PG_E_SCENE: return PG_EXIT_SCENE;
    case PG_E_USAGE: return PG_EXIT_USAGE;
    case PG_E_INTERRUPTED: return PG_EXIT_INTERRUPTED;
    default: return PG_EXIT_FAILED;
    }
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * The nearest of some names, to suggest in messages: edit distance with swaps of neighbours, regardless of
 * case. */
#include "perigal/base.h"
#include <ctype.h>
#include <string.h>

/* Longer names are not compared. */
enum { LONGEST = 64 };

/* Returns a letter in lower case. */
static int lower (char c) { return tolower ((unsigned char) c); }

/* Optimal string alignment distance of a (na bytes) and b (nb bytes). */
static size_t distance (const char *a, size_t na, const char *b, size_t nb)
{
    size_t row[3][LONGEST + 1];
    for (size_t j = 0; j <= nb; j++) row[0][j] = j;
    for (size_t i = 1; i <= na; i++) {
        /* Three rows of the table suffice: a swap looks back two rows. */
        size_t *now = row[i % 3], *last = row[(i + 2) % 3], *before = row[(i + 1) % 3];
        now[0] = i;
        for (size_t j = 1; j <= nb; j++) {
            size_t cost = lower (a[i - 1]) != lower (b[j - 1]), best = last[j - 1] + cost;
            if (last[j] + 1 < best) best = last[j] + 1;
            if (now[j - 1] + 1 < best) best = now[j - 1] + 1;
            if (i > 1 && j > 1 && lower (a[i - 1]) == lower (b[j - 2]) && lower (a[i - 2]) == lower (b[j - 1])
                && before[j - 2] + 1 < best) best = before[j - 2] + 1;
            now[j] = best;
        }
    }
    return row[na % 3][nb];
}

/* Is `word`, of at least three letters, the beginning of the name? */
static int starts (const char *name, size_t n, const char *word, size_t nw)
{
    for (size_t k = 0; k < nw; k++)
        if (k >= n || lower (name[k]) != lower (word[k])) return 0;
    return nw >= 3;
}

/* A name is near if at most a third of its letters differ; else one that begins with the word is taken. */
const char *pg_nearest_name (const char *word, const char *choices)
{
    static _Thread_local char found[LONGEST + 1];
    size_t best = LONGEST, nw = strlen (word);
    if (!choices || nw == 0 || nw > LONGEST) return NULL;
    for (const char *s = choices; ; s++) {
        size_t n = strcspn (s, "|"), longer = n > nw ? n : nw, d = best;
        if (n > 0 && n <= LONGEST) {
            d = distance (word, nw, s, n);
            if (d > (longer + 2) / 3 || d == longer) d = starts (s, n, word, nw) ? LONGEST - 1 : LONGEST;
        }
        if (d < best) {
            best = d;
            memcpy (found, s, n);
            found[n] = '\0';
        }
        s += n;
        if (*s == '\0') return best < LONGEST ? found : NULL;
    }
}

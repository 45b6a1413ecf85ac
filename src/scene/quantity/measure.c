/* SPDX-License-Identifier: GPL-3.0-or-later
 * Units by udunits2: a text becomes a factor and powers of the base units. The database is read once, on
 * first use, and only if a unit occurs that is not among the common ones. */
#include "unit.h"
#include <locale.h>
#include <math.h>
#include <pthread.h>
#include <string.h>
#include <udunits2.h>

/* WORD: room for the text of a unit, in bytes. REMEMBERED: number of units cached. */
enum { WORD = 40, REMEMBERED = 128 };

/* The database of udunits2, read once on first use, and the units met since, by hash: reading the
 * database takes longer than a small run, and the library is not made for several threads. */
static struct {
    pthread_once_t  once;
    pthread_mutex_t lock;
    /* NULL: the database could not be read. */
    ut_system      *units;
    struct { char text[WORD]; pg_measure measure; } met[REMEMBERED];
} database = { .once = PTHREAD_ONCE_INIT, .lock = PTHREAD_MUTEX_INITIALIZER };

/* Reads the database, in the C locale as it has decimal points, and adds deg. */
static void load (void)
{
    locale_t c = newlocale (LC_ALL_MASK, "C", (locale_t) 0), before = (locale_t) 0;
    /* The database writes decimal points, whatever the locale of the program is. */
    if (c) before = uselocale (c);
    ut_set_error_message_handler (ut_ignore);
    database.units = ut_read_xml (NULL);
    if (database.units) {
        /* udunits2 calls it arc_degree. */
        ut_unit *degree = ut_get_unit_by_name (database.units, "arc_degree");
        if (degree) ut_map_name_to_unit ("deg", UT_ASCII, degree);
        ut_free (degree);
    }
    if (c) {
        uselocale (before);
        freelocale (c);
    }
}

/* ---- powers of the base units, by visiting the tree of a unit ------------------------------------------ */
/* Base units in the order of pg_measure.power. */
static const char *const base_symbol[PG_BASE_UNITS] = { "m", "kg", "s", "A", "K", "mol", "cd" };

/* Adds a power of a base unit to *m. */
static ut_status add_basic (const ut_unit *unit, double power, pg_measure *m)
{
    const char *symbol = ut_get_symbol (unit, UT_ASCII);
    if (!symbol) return UT_MEANINGLESS;
    for (int k = 0; k < PG_BASE_UNITS; k++)
        if (strcmp (symbol, base_symbol[k]) == 0) m->power[k] += power;
    if (strcmp (symbol, "rad") == 0) m->angle += power;
    return UT_SUCCESS;
}

/* Visitors, which udunits2 calls for each kind of unit in the tree of a unit. */
static ut_status visit_basic (const ut_unit *unit, void *p) { return add_basic (unit, 1, p); }

/* Visits a product: adds the powers of its base units. */
static ut_status visit_product (const ut_unit *unit, int n, const ut_unit *const *basic, const int *power,
                                void *p)
{
    (void) unit;
    for (int k = 0; k < n; k++) {
        ut_status status = add_basic (basic[k], power[k], p);
        if (status != UT_SUCCESS) return status;
    }
    return UT_SUCCESS;
}

static ut_visitor visitor;

/* Multiplies the factor; units with an origin (degC) are refused. */
static ut_status visit_galilean (const ut_unit *unit, double scale, const ut_unit *under, double origin,
                                 void *p)
{
    (void) unit;
    /* Units with an origin, such as degC or "m from 5", have no factor. */
    if (origin != 0) return UT_MEANINGLESS;
    ((pg_measure *) p)->factor *= scale;
    return ut_accept_visitor (under, &visitor, p);
}

/* Refuses times since an origin, and logarithmic units: they cannot be used in formulas. */
static ut_status visit_time (const ut_unit *unit, const ut_unit *second, double origin, void *p)
{
    (void) unit, (void) second, (void) origin, (void) p;
    return UT_MEANINGLESS;
}

static ut_status visit_log (const ut_unit *unit, double base, const ut_unit *reference, void *p)
{
    (void) unit, (void) base, (void) reference, (void) p;
    return UT_MEANINGLESS;
}

static ut_visitor visitor = { visit_basic, visit_product, visit_galilean, visit_time, visit_log };

/* ---- text of a unit ------------------------------------------------------------------------------------ */
/* Is c part of the name of a unit, in UTF-8? */
static int is_letter (char c)
{
    unsigned char u = (unsigned char) c;
    return (u >= 'a' && u <= 'z') || (u >= 'A' && u <= 'Z') || u >= 0x80 || u == '%' || u == '_';
}

static int is_digit (char c) { return c >= '0' && c <= '9'; }

/* skip_word, skip_power and skip_joint each skip one part of the text of a unit; NULL: it is not there. */
static const char *skip_word (const char *s)
{
    if (!is_letter (*s)) return NULL;
    while (is_letter (*s)) s++;
    return s;
}

static int is_sign (char c) { return c == '-' || c == '+'; }

/* Skips a whole power, with or without ^: "2", "-1", "^+3"; after ^ there must be one. */
static const char *skip_power (const char *s)
{
    int raised = *s == '^';
    s += raised;
    if (is_sign (*s) && is_digit (s[1])) s++;
    if (raised && !is_digit (*s)) return NULL;
    while (is_digit (*s)) s++;
    return s;
}

/* Skips what joins two words: space . * or /, with blanks around it. */
static const char *skip_joint (const char *s)
{
    while (*s == ' ' && s[1] && strchr (" /*.", s[1])) s++;
    if (!*s || !strchr (" .*/", *s)) return NULL;
    s++;
    while (*s == ' ') s++;
    return s;
}

/* Is the text words with whole powers, joined by space . * or /, perhaps after "1/"? udunits2 alone would
 * also accept "m)" or "5 m @ 3". */
static int well_formed (const char *s)
{
    if (s[0] == '1' && s[1] == '/') s += 2;
    for (;;) {
        s = skip_word (s);
        if (s) s = skip_power (s);
        if (!s) return 0;
        if (*s == '\0') return 1;
        s = skip_joint (s);
        if (!s) return 0;
    }
}

/* Reads a unit by udunits2; 0: it is no unit with a positive factor. */
static int parse (const char *text, pg_measure *m)
{
    ut_unit *unit = ut_parse (database.units, text, UT_UTF8);
    if (!unit) return 0;
    *m = (pg_measure) { .factor = 1 };
    int good = ut_accept_visitor (unit, &visitor, m) == UT_SUCCESS && isfinite (m->factor) && m->factor > 0;
    ut_free (unit);
    return good;
}

/* Slot of a text in the cache of units, by a hash. */
static size_t place_of (const char *text)
{
    size_t h = 5381;
    for (; *text; text++) h = h * 33 + (unsigned char) *text;
    return h % REMEMBERED;
}

/* Units that suffice for most input files: reading the database takes longer than a small run. Factors have
 * the same bits as those of udunits2. */
static const struct { const char *text; double factor, m, kg, s, angle;
} common[] = {
    { "m", 1, 1, 0, 0, 0 },         { "mm", 1e-3, 1, 0, 0, 0 },     { "m2", 1, 2, 0, 0, 0 },
    { "m3", 1, 3, 0, 0, 0 },        { "kg", 1, 0, 1, 0, 0 },        { "s", 1, 0, 0, 1, 0 },
    { "1/s", 1, 0, 0, -1, 0 },      { "m/s", 1, 1, 0, -1, 0 },      { "m/s2", 1, 1, 0, -2, 0 },
    { "N", 1, 1, 1, -2, 0 },        { "kN", 1e3, 1, 1, -2, 0 },     { "J", 1, 2, 1, -2, 0 },
    { "Pa", 1, -1, 1, -2, 0 },      { "MPa", 1e6, -1, 1, -2, 0 },   { "GPa", 1e9, -1, 1, -2, 0 },
    { "N/m", 1, 0, 1, -2, 0 },      { "J/m2", 1, 0, 1, -2, 0 },     { "N/m3", 1, -2, 1, -2, 0 },
    { "kg/m3", 1, -3, 1, 0, 0 },    { "%", 0.01, 0, 0, 0, 0 },      { "min", 60, 0, 0, 1, 0 },
    { "cm", 1e-2, 1, 0, 0, 0 },     { "um", 1e-6, 1, 0, 0, 0 },     { "ms", 1e-3, 0, 0, 1, 0 },
    { "us", 1e-6, 0, 0, 1, 0 },     { "m^2", 1, 2, 0, 0, 0 },       { "m^3", 1, 3, 0, 0, 0 },
    { "m^4", 1, 4, 0, 0, 0 },       { "m4", 1, 4, 0, 0, 0 },        { "mm/s", 1e-3, 1, 0, -1, 0 },
    { "kPa", 1e3, -1, 1, -2, 0 },   { "N/m2", 1, -1, 1, -2, 0 },    { "rad", 1, 0, 0, 0, 1 },
    { "deg", 0.017453292519943295, 0, 0, 0, 1 },
};

/* Is the text one of the common units of the table? Then *m gets its factor and powers. */
static int is_common (pg_measure *m, const char *text, size_t n)
{
    for (size_t k = 0; k < sizeof common / sizeof *common; k++) {
        if (strncmp (common[k].text, text, n) != 0 || common[k].text[n] != '\0') continue;
        *m = (pg_measure) { .factor = common[k].factor, .power = { common[k].m, common[k].kg, common[k].s },
                             .angle = common[k].angle };
        return 1;
    }
    return 0;
}

/* Is the word of n bytes a name of the degree Celsius? No key takes a charge: C is no coulomb here. */
static int is_celsius (const char *s, size_t n)
{
    static const char *const name[] = { "C",       "degC",           "\302\260C",
                                        "celsius", "degree_Celsius", "degrees_Celsius" };
    for (size_t k = 0; k < sizeof name / sizeof *name; k++)
        if (strlen (name[k]) == n && memcmp (name[k], s, n) == 0) return 1;
    return 0;
}

/* Writes a unit in the form that udunits2 reads: temperatures are always differences, so that degrees Celsius
 * are kelvins, in products and quotients as well; "/K" becomes "1/K". 0: the result does not fit. */
static int spell_out (const char *text, size_t n, char word[WORD])
{
    size_t used = 0;
    if (n > 1 && *text == '/') word[used++] = '1';
    for (size_t k = 0, m; k < n; k += m) {
        for (m = 0; k + m < n && is_letter (text[k + m]); ) m++;
        int celsius = m > 0 && is_celsius (text + k, m);
        const char *part = celsius ? "K" : text + k;
        if (m == 0) m = 1;
        size_t length = celsius ? 1 : m;
        if (used + length >= WORD) return 0;
        memcpy (word + used, part, length);
        used += length;
    }
    word[used] = '\0';
    return 1;
}

/* Reads a unit; an unknown one is a fault with a suggestion. */
pg_status pg_measure_read (pg_measure *m, const char *text, size_t n)
{
    static const char usual[] =
        "m|mm|um|km|cm|Pa|kPa|MPa|GPa|N|kN|MN|J|kJ|s|ms|us|h|kg|g|t|deg|rad|Hz|kg/m3|N/m|m/s|J/m2|N/m2|1/s|K|"
        "1/K|degC";
    char word[WORD];
    if (n == 1 && text[0] == '1') {
        *m = (pg_measure) { .factor = 1 };
        return PG_OK;
    }
    /* Common units do not need the database. */
    if (is_common (m, text, n)) return PG_OK;
    if (!spell_out (text, n, word)) {
        snprintf (word, sizeof word, "%.*s", WORD - 1, text);
        return pg_error (PG_E_SCENE, PG_HERE, "unknown unit '%s...'", word);
    }
    if (is_common (m, word, strlen (word))) return PG_OK;
    /* expressions come here too, to test whether they are a number with a unit: these do not need the
     * database */
    int good = well_formed (word);
    if (good) {
        pthread_once (&database.once, load);
        if (!database.units)
            return pg_error (PG_E_FILE, PG_HERE,
                             "the unit database of udunits2 cannot be read (see UDUNITS2_XML_PATH)");
        /* Taken from the cache, or read by udunits2. */
        pthread_mutex_lock (&database.lock);
        size_t k = place_of (word);
        if (strcmp (database.met[k].text, word) == 0) *m = database.met[k].measure;
        else if ((good = parse (word, m)) != 0) {
            memcpy (database.met[k].text, word, sizeof word);
            database.met[k].measure = *m;
        }
        pthread_mutex_unlock (&database.lock);
    }
    if (good) return PG_OK;
    if (strcmp (word, "spacing") == 0) return pg_error (PG_E_SCENE, PG_HERE, "spacing is not a unit here");
    const char *near = pg_nearest_name (word, usual);
    if (near) return pg_error (PG_E_SCENE, PG_HERE, "unknown unit '%s'; did you mean %s?", word, near);
    return pg_error (PG_E_SCENE, PG_HERE, "unknown unit '%s'", word);
}

/* Powers may be fractions, from roots; they are compared to 1e-9. */
int pg_measure_same (const pg_measure *a, const pg_measure *b)
{
    for (int k = 0; k < PG_BASE_UNITS; k++)
        if (fabs (a->power[k] - b->power[k]) > 1e-9) return 0;
    return 1;
}

/* Is the unit dimensionless? rad counts as 1. */
int pg_measure_plain (const pg_measure *m)
{
    static const pg_measure one = { .factor = 1 };
    return pg_measure_same (m, &one);
}

/* Converts to SI. Where the factor is the inverse of a whole number, division by that is exact where the
 * product would be rounded: 3 mm is exactly 0.003 m. */
double pg_measure_scale (double value, const pg_measure *m)
{
    double inverse = round (1 / m->factor);
    if (m->factor < 1 && fabs (inverse * m->factor - 1) < 1e-14) return value / inverse;
    return value * m->factor;
}

/* ---- names for messages -------------------------------------------------------------------------------- */
/* Names of dimensions, and an example for each. */
static const struct { const char *unit; double m, kg, s; const char *example;
} known[] = {
    { "1", 0, 0, 0, "0.25" },       { "rad", 0, 0, 0, "40 deg" },        { "m", 1, 0, 0, "5 mm" },
    { "m2", 2, 0, 0, "20 mm2" },    { "m3", 3, 0, 0, "8 mm3" },          { "s", 0, 0, 1, "0.1 ms" },
    { "1/s", 0, 0, -1, "100 1/s" }, { "m/s", 1, 0, -1, "2 m/s" },        { "m/s2", 1, 0, -2, "9.81 m/s2" },
    { "kg", 0, 1, 0, "2 kg" },      { "kg/m3", -3, 1, 0, "2500 kg/m3" }, { "N", 1, 1, -2, "10 kN" },
    { "Pa", -1, 1, -2, "10 GPa" },  { "N/m", 0, 1, -2, "10 kN/m" },      { "J/m2", 0, 1, -2, "100 J/m2" },
    { "J", 2, 1, -2, "5 J" },       { "N/m3", -2, 1, -2, "25 kN/m3" },   { "N s/m", 0, 1, -1, "5 N s/m" },
};

/* Has row k of `known` this dimension? */
static int is_known (size_t k, const pg_measure *m)
{
    const pg_measure other = { .factor = 1, .power = { known[k].m, known[k].kg, known[k].s } };
    return pg_measure_same (m, &other);
}

void pg_measure_text (const pg_measure *m, char *out, size_t n)
{
    for (size_t k = 0; k < sizeof known / sizeof *known; k++) {
        if (!is_known (k, m)) continue;
        snprintf (out, n, "%s", known[k].unit);
        return;
    }
    size_t used = 0;
    /* The dimension has no name: written as powers of base units. */
    for (int k = 0; k < PG_BASE_UNITS && used < n; k++) {
        if (fabs (m->power[k]) < 1e-9) continue;
        int more = snprintf (out + used, n - used, "%s%s", used ? " " : "", base_symbol[k]);
        used += (size_t) more;
        if (used < n && m->power[k] != 1)
            used += (size_t) snprintf (out + used, n - used, "^%g", m->power[k]);
    }
}

/* Returns an example of a value in this unit, else one of its dimension. */
const char *pg_measure_example (const pg_measure *m, const char *unit)
{
    const char *example = NULL;
    for (size_t k = 0; k < sizeof known / sizeof *known; k++) {
        if (strcmp (known[k].unit, unit) == 0) return known[k].example;
        if (!example && is_known (k, m)) example = known[k].example;
    }
    return example;
}

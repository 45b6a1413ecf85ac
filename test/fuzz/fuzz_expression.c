/* SPDX-License-Identifier: GPL-3.0-or-later
 * Any text as an expression and as a quantity of some unit (first byte): an answer always; what compiles has
 * a value everywhere. */
#include "fuzz.h"
#include "perigal/scene.h"
#include <math.h>


static void evaluate (const char *text, const char *unit)
{
    static const pg_place place[] = { { 0 },
                                      { 1, 2, 3, 3.7416573867739413, 1.1071487177940904, 0.5 },
                                      { -1e-3, 1e9, -0.0, 1e9, 1.57, 1 } };
    pg_expression *e = NULL;
    pg_status status = pg_expression_compile (&e, text, unit);
    FUZZ_EXPECT (status == PG_OK || status == PG_E_SCENE);
    FUZZ_EXPECT ((status == PG_OK) == (e != NULL));
    if (status != PG_OK) FUZZ_EXPECT (strncmp (pg_last_error (), "column ", 7) == 0);
    for (size_t k = 0; e && k < sizeof place / sizeof *place; k++) {
        double first = pg_expression_value (e, &place[k]), second = pg_expression_value (e, &place[k]);
        FUZZ_EXPECT (first == second || (isnan (first) && isnan (second)));
        if (strcmp (unit, "bool") == 0) FUZZ_EXPECT (first == 0 || first == 1);
        pg_place later = place[k];
        later.t += 0.25;
        double then = pg_expression_value (e, &later);
        if (!pg_expression_uses (e, 't')) FUZZ_EXPECT (then == first || (isnan (then) && isnan (first)));
    }
    pg_expression_free (&e);
}

static void measure (const char *text, const char *unit)
{
    double value = 0;
    pg_status status = pg_unit_parse (&value, text, unit);
    FUZZ_EXPECT (status == PG_OK || status == PG_E_SCENE);
    if (status == PG_OK) FUZZ_EXPECT (isfinite (value));
}

int LLVMFuzzerTestOneInput (const uint8_t *data, size_t size)
{
    static const char *const unit[] = { "bool", "1",   "m", "Pa",    "N",    "m/s",
                                        "N/m3", "rad", "s", "kg/m3", "J/m2", "m|spacing" };
    char text[LONGEST + 1];
    size_t used = pg_memory_used ();
    if (size < 1 || size > LONGEST) return 0;
    memcpy (text, data + 1, size - 1);
    text[size - 1] = '\0';
    const char *wanted = unit[data[0] % (sizeof unit / sizeof *unit)];
    evaluate (text, wanted);
    if (strcmp (wanted, "bool") != 0) measure (text, wanted);
    FUZZ_EXPECT (pg_memory_used () == used);
    return 0;
}

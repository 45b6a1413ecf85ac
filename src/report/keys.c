/* SPDX-License-Identifier: GPL-3.0-or-later
 * Keys of what a run leaves behind. */
#include "perigal/scene.h"

static const pg_key keys[] = {
    { "output.fields", PG_NAMES, NULL, NULL, "[displacement, damage, stress]", "displacement|velocity|damage|stress|strain", NULL, NULL, "Fields of result.e." },
    { "output.pictures", PG_NAMES, NULL, NULL, "[damage]", NULL, NULL, NULL, "Pictures of the last state: a field, or a part of one (displacement.y, stress.xx)." },
    { "output.magnify", PG_NUMBER, "1", "[0, inf)", "0", NULL, NULL, NULL, "Pictures show the body deformed by this multiple of the displacement." },
    { "output.at.events", PG_INTEGER, NULL, "[1, 1000000000]", "", NULL, NULL, NULL, "Fields are also written every so many events (static: event stepping)." },
    { "output.at.broken", PG_NUMBER, "1", "(0, 1]", "", NULL, NULL, NULL, "Fields are also written each time this share of all bonds has broken anew." },
};
const pg_key_table pg_keys_report = { "report", keys, sizeof keys / sizeof *keys };

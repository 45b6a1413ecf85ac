/* SPDX-License-Identifier: GPL-3.0-or-later
 * Keys of contact. */
#include "perigal/contact.h"
#include <string.h>

static const pg_key keys[] = {
    { "contact", PG_MAP, NULL, NULL, "", NULL, NULL, NULL,
      "What the faces of cracks do to each other where cracks close (2D, force: galerkin, solver: static; "
      "elsewhere it is refused)." },
    { "contact.kind", PG_NAME, NULL, NULL, "none", "none|normal|friction", NULL, NULL,
      "none: faces pass through each other; normal: they press without friction; friction: they stick or "
      "slide by Coulomb's law." },
    { "contact.coefficient", PG_NUMBER, "1", "[0, 10]", "", NULL, NULL, NULL,
      "kind: friction: shear that faces bear over the pressure on them." },
    { "contact.cohesion", PG_NUMBER, "Pa", "[0, inf)", "0", NULL, NULL, NULL,
      "kind: friction: shear stress that closed faces bear besides. It does not grow with the load: needs "
      "stepping: fixed." },
};
const pg_key_table pg_keys_contact = { "contact", keys, sizeof keys / sizeof *keys };

pg_contact_setting pg_contact_read (const pg_scene *scene)
{
    pg_contact_setting out = { 0 };
    const char *kind = pg_scene_text (scene, "contact.kind");
    int given = pg_scene_given (scene, "contact.coefficient"),
        stuck = pg_scene_given (scene, "contact.cohesion");
    if (kind && strcmp (kind, "normal") == 0) out.kind = PG_CONTACT_NORMAL;
    if (kind && strcmp (kind, "friction") == 0) out.kind = PG_CONTACT_FRICTION;
    if (out.kind == PG_CONTACT_FRICTION && !given)
        pg_scene_fault (scene, "contact.coefficient", "kind: friction needs it");
    if (out.kind != PG_CONTACT_FRICTION && (given || stuck))
        pg_scene_fault (scene, given ? "contact.coefficient" : "contact.cohesion",
                        "has a meaning with contact.kind: friction alone: leave it out, or set the kind");
    if (out.kind == PG_CONTACT_FRICTION && given)
        out.coefficient = pg_scene_number (scene, "contact.coefficient");
    if (out.kind == PG_CONTACT_FRICTION) out.cohesion = pg_scene_number (scene, "contact.cohesion");
    return out;
}

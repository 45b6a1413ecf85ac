/* SPDX-License-Identifier: GPL-3.0-or-later
 * Keys of contact. */
#include "perigal/contact.h"
#include <string.h>

static const pg_key keys[] = {
    { "contact", PG_MAP, NULL, NULL, "", NULL, NULL, NULL,
      "What the faces of cracks do to each other where cracks close: with force: galerkin at rest (static) "
      "and in motion (newmark); with forces by bonds by the layer that the cut "
      "bonds were (static, explicit, adr, relax), at rest also where bonds break one by one. Elsewhere it is "
      "refused." },
    { "contact.kind", PG_NAME, NULL, NULL, "none", "none|normal|friction", NULL, NULL,
      "none: faces pass through each other; normal: they press without friction; friction: they stick or "
      "slide by Coulomb's law." },
    { "contact.coefficient", PG_NUMBER, "1", "[0, 10]", "", NULL, NULL, NULL,
      "kind: friction: shear that faces bear over the pressure on them." },
    { "contact.cohesion", PG_NUMBER, "Pa", "[0, inf)", "0", NULL, NULL, NULL,
      "kind: friction: shear stress that closed faces bear besides; faces that part have it no more until "
      "they close again." },
    { "contact.search", PG_NAME, NULL, NULL, "faces", "faces|short_range", NULL, NULL,
      "faces: what touches are the faces of cracks, where their normals are known. short_range: any two "
      "points that no live bond joins, fragments and separate bodies too, found by search while they move "
      "(solver: verlet, central)." },
    { "contact.distance", PG_NUMBER, "1", "(0, 2]", "1", NULL, NULL, NULL,
      "search: short_range: points repel each other when they are nearer than this, in local spacings, and "
      "nearer than at the start." },
    { "contact.enforcement", PG_NAME, NULL, NULL, "springs", "springs|impulses", NULL, NULL,
      "search: short_range: springs push points apart that have come too near; impulses: in each time step "
      "the forces are computed with which none comes too near, and part as fast as they met, without loss "
      "(forces by bonds)." },
    { "contact.stiffness", PG_NUMBER, "1", "(0, 1000]", "1", NULL, NULL, NULL,
      "enforcement: springs: stiffness of a pair in contact over that of a column of the material as wide "
      "and as long as a spacing; larger: less overlap and smaller time steps." },
};
const pg_key_table pg_keys_contact = { "contact", keys, sizeof keys / sizeof *keys };

/* Reads the keys of short-range forces, and reports them as errors with other kinds of contact. */
static void read_search (pg_contact_setting *out, const pg_scene *scene)
{
    static const char *const own[3] = { "contact.distance", "contact.stiffness", "contact.enforcement" };
    const char *search = pg_scene_text (scene, "contact.search"),
               *enforcement = pg_scene_text (scene, "%s", own[2]);
    if (search && strcmp (search, "short_range") == 0) out->search = PG_CONTACT_SHORT_RANGE;
    out->distance = pg_scene_number (scene, "%s", own[0]);
    out->stiffness = pg_scene_number (scene, "%s", own[1]);
    out->impulses = enforcement && strcmp (enforcement, "impulses") == 0;
    for (int k = 0; k < 3 && out->search != PG_CONTACT_SHORT_RANGE; k++)
        if (pg_scene_given (scene, "%s", own[k]))
            pg_scene_fault (scene, own[k],
                            "has a meaning with contact.search: short_range alone: leave it out, or set the "
                            "search");
    if (out->impulses && pg_scene_given (scene, "%s", own[1]))
        pg_scene_fault (scene, own[1], "is that of springs: leave it out, or set contact.enforcement: "
                                       "springs");
    if (out->search == PG_CONTACT_SHORT_RANGE && pg_scene_given (scene, "contact.cohesion"))
        pg_scene_fault (scene, "contact.cohesion",
                        "is a stress on faces, which short-range forces between points do not know: leave it "
                        "out");
}

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
    read_search (&out, scene);
    return out;
}

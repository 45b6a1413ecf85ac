/* SPDX-License-Identifier: GPL-3.0-or-later
 * An anisotropic material: cubic crystals, with the axes of the scene. Three stiffnesses: c11, c12, c44. In
 * plane stress what the free direction gives way is taken off c11 and c12. */
#include "entries.h"
#include <stdio.h>

enum { C11, C12, C44 };

static pg_status read (pg_material *m, const pg_scene *scene)
{
    double *c = m->parameter;
    char path[160];
    for (int k = 0; k < 3; k++)
        c[k] = pg_scene_number (scene,
                                k == 2 ? "materials.%s.stiffness_44"
                                : k    ? "materials.%s.stiffness_12"
                                       : "materials.%s.stiffness_11",
                                m->name);
    if (!(c[C11] > c[C12] && c[C11] + 2 * c[C12] > 0)) {
        snprintf (path, sizeof path, "materials.%s", m->name);
        pg_scene_fault (scene, path,
                        "some strain would release energy: stiffness_11 must be more than stiffness_12 and "
                        "than -2 of it");
        return PG_OK;
    }
    double less = m->mode == PG_PLANE_STRESS ? c[C12] * c[C12] / c[C11] : 0;
    int n = m->mode == PG_SOLID ? 3 : 2, nv = pg_voigt_size (n);
    for (int i = 0; i < nv; i++)
        for (int j = 0; j < nv; j++)
            m->D[nv * i + j] = i < n && j < n ? (i == j ? c[C11] : c[C12]) - less : i == j ? c[C44] : 0;
    if (m->mode == PG_PLANE_STRAIN) m->out_of_plane[0] = m->out_of_plane[1] = c[C12];
    m->modulus = c[C11], m->mu = c[C44];
    return PG_OK;
}

static void describe (const pg_material *m, char *text, size_t size)
{
    snprintf (text, size, "c11 %.6g, c12 %.6g, c44 %.6g Pa", m->parameter[C11], m->parameter[C12],
              m->parameter[C44]);
}

#define STIFFNESS(name, text) { .path = "materials.{}." name, .kind = PG_NUMBER, .unit = "Pa", .doc = text }
static const pg_key keys[] = {
    STIFFNESS ("stiffness_11", "Stress along an axis over strain along it."),
    STIFFNESS ("stiffness_12", "Stress along an axis over strain along another."),
    STIFFNESS ("stiffness_44", "Shear modulus between two axes."),
};
static const pg_key_table table = { "material", keys, sizeof keys / sizeof *keys };

const pg_material_type pg_material_cubic = {
    .name = "cubic",
    .summary = "linear, cubic symmetry along the axes of the scene",
    .keys = { &table },
    .read = read,
    .stress = pg_tangent_stress,
    .describe = describe,
};

/* SPDX-License-Identifier: GPL-3.0-or-later
 * Orthotropic linear elasticity: three planes of symmetry at right angles, such as wood, a rolled sheet or a
 * layer of fibres. In its own axes 1, 2, 3
 *   eps_11 = s_11 / E1 - nu12 s_22 / E1 - nu13 s_33 / E1, and so on, gamma_12 = s_12 / G12, where nu_ij is
 *     the contraction along j over the elongation along i under a stress along i, so that nu_ij / E_i = nu_ji
 *     / E_j. The stiffness is the inverse of this compliance, rotated to the axes of the scene (Lekhnitskii,
 *     Theory of elasticity of an anisotropic body; Ting 1996, chapter 2). Plane stress needs E1, E2, nu12,
 *     G12; plane strain E3, nu13, nu23 as well; a solid all nine. Axis 3 of a plane body is its z. */
#include "entries.h"
#include "perigal/vector.h"
#include <math.h>
#include <string.h>

/* Constants in the order of pg_material.parameter, Pa and 1, and their keys. */
enum { E1, E2, E3, NU12, NU13, NU23, G12, G13, G23, CONSTANTS };
static const char *const names[CONSTANTS] = {
    "youngs_modulus_1",  "youngs_modulus_2", "youngs_modulus_3", "poissons_ratio_12", "poissons_ratio_13",
    "poissons_ratio_23", "shear_modulus_12", "shear_modulus_13", "shear_modulus_23",
};

#define MODULUS(name, optional, text) \
    { \
        .path = "materials.{}." name, .kind = PG_NUMBER, .unit = "Pa", .range = "(0, inf)", \
        .fallback = optional, .doc = text \
    }
#define RATIO(name, optional, text) \
    { \
        .path = "materials.{}." name, .kind = PG_NUMBER, .unit = "1", .fallback = optional, .doc = text \
    }
static const pg_key keys[] = {
    MODULUS ("youngs_modulus_1", NULL, "Young's modulus along axis 1."),
    MODULUS ("youngs_modulus_2", NULL, "Young's modulus along axis 2."),
    MODULUS ("youngs_modulus_3", "", "Young's modulus along axis 3; not needed in plane stress."),
    RATIO ("poissons_ratio_12", NULL,
           "Contraction along axis 2 over elongation along axis 1, under a stress along axis 1."),
    RATIO ("poissons_ratio_13", "",
           "Contraction along axis 3 over elongation along axis 1; not needed in plane stress."),
    RATIO ("poissons_ratio_23", "",
           "Contraction along axis 3 over elongation along axis 2; not needed in plane stress."),
    MODULUS ("shear_modulus_12", NULL, "Shear modulus between axes 1 and 2."),
    MODULUS ("shear_modulus_13", "", "Shear modulus between axes 1 and 3, of a solid."),
    MODULUS ("shear_modulus_23", "", "Shear modulus between axes 2 and 3, of a solid."),
    { .path = "materials.{}.angle",
      .kind = PG_NUMBER,
      .unit = "rad",
      .fallback = "",
      .doc = "In two dimensions: from x to axis 1, counterclockwise; 0 if not given." },
    { .path = "materials.{}.axis_1",
      .kind = PG_VECTOR,
      .unit = "1",
      .fallback = "",
      .doc = "In three dimensions: direction of axis 1; x if not given." },
    { .path = "materials.{}.axis_2",
      .kind = PG_VECTOR,
      .unit = "1",
      .fallback = "",
      .doc = "In three dimensions: a vector in the plane of axes 1 and 2, on the side of axis 2; y if not "
             "given." },
};
static const pg_key_table table = { "material", keys, sizeof keys / sizeof *keys };

/* Reports a fault at a key of the material, or at the material itself (key ""). */
static void fault (const pg_scene *scene, const pg_material *m, const char *key, const char *why)
{
    char path[160];
    snprintf (path, sizeof path, "materials.%s%s%s", m->name, *key ? "." : "", key);
    pg_scene_fault (scene, path, "%s", why);
}

/* Does the scene give all constants that this mode needs? Those of axes 1 and 2 have required keys. */
static int complete (const pg_material *m, const pg_scene *scene)
{
    int all = 1;
    for (int k = 0; k < CONSTANTS; k++) {
        int plane_strain = k == E3 || k == NU13 || k == NU23, solid = plane_strain || k == G13 || k == G23;
        if (!(m->mode == PG_SOLID ? solid : m->mode == PG_PLANE_STRAIN && plane_strain)
            || pg_scene_given (scene, "materials.%s.%s", m->name, names[k]))
            continue;
        char why[160];
        snprintf (why, sizeof why, "%s is missing, which model: orthotropic needs in %s", names[k],
                  m->mode == PG_SOLID ? "three dimensions" : "plane strain");
        fault (scene, m, "", why);
        all = 0;
    }
    return all;
}

/* Compliance S of the normal stresses, 1/Pa (n x n), for n = 2 or 3 axes: 1 / E_i on the diagonal, -nu_ij /
 * E_i off it. Shears are not coupled with them. */
static void normal_compliance (int n, const double c[CONSTANTS], double *S)
{
    static const int ratio[3][3] = { { 0, NU12, NU13 }, { NU12, 0, NU23 }, { NU13, NU23, 0 } };
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++)
            S[n * i + j] = i == j ? 1 / c[E1 + i] : -c[ratio[i][j]] / c[E1 + (i < j ? i : j)];
}

/* Does every strain store energy: is each nu_ij^2 < E_i / E_j, and the determinant of the compliance
 * positive? */
static int is_positive (const pg_material *m, const pg_scene *scene, int n, const double c[CONSTANTS])
{
    static const struct {
        int ratio, of, other;
    } pair[3] = { { NU12, E1, E2 }, { NU13, E1, E3 }, { NU23, E2, E3 } };
    char why[200];
    double S[9];
    for (int k = 0; k < (n == 3 ? 3 : 1); k++) {
        /* nu_12^2 < E_1 / E_2 is the 2 x 2 determinant of the compliance; a part in 1e9 is kept from it,
         * as nearly singular stiffnesses are of no use either. */
        double most = sqrt (c[pair[k].of] / c[pair[k].other]);
        if (fabs (c[pair[k].ratio]) < most * (1 - 1e-9)) continue;
        snprintf (why, sizeof why,
                  "must lie between %.6g and %.6g, the root of %s / %s: some strain would release energy",
                  -most, most, names[pair[k].of], names[pair[k].other]);
        fault (scene, m, names[pair[k].ratio], why);
        return 0;
    }
    normal_compliance (n, c, S);
    if (pg_dense_cholesky (n, S, 1e-9) == 0) return 1;
    fault (scene, m, "",
           "the three Poisson's ratios do not go together: some strain would release energy (the compliance "
           "is not positive definite)");
    return 0;
}

/* Makes the 6 x 6 stiffness C, Pa, of the material's axes: upper left the inverse of the n x n compliance,
 * then the shear moduli on the diagonal, in Voigt order (12, 23, 13). */
static void stiffness (int n, const double c[CONSTANTS], double C[36])
{
    double S[9];
    memset (C, 0, 36 * sizeof *C);
    normal_compliance (n, c, S);
    /* Column by column: S C = 1. */
    pg_dense_cholesky (n, S, 0);
    for (int j = 0; j < n; j++) {
        double unit[3] = { 0 };
        unit[j] = 1;
        pg_dense_solve (n, S, unit);
        for (int i = 0; i < n; i++) C[6 * i + j] = unit[i];
    }
    C[6 * 3 + 3] = c[G12], C[6 * 4 + 4] = c[G23], C[6 * 5 + 5] = c[G13];
}

/* Axes are given by an angle in 2D and by two vectors in 3D; keys for the other dimension are faults. Returns
 * 0 if there are any. */
static int axes_fit (const pg_material *m, const pg_scene *scene)
{
    static const char *const key[3] = { "angle", "axis_1", "axis_2" };
    int solid = m->mode == PG_SOLID;
    for (int k = 0; k < 3; k++) {
        if ((k == 0) != solid || !pg_scene_given (scene, "materials.%s.%s", m->name, key[k])) continue;
        fault (scene, m, key[k],
               solid ? "is for two dimensions: give axis_1 and axis_2"
                     : "is for three dimensions: give angle");
        return 0;
    }
    return 1;
}

/* Makes three orthogonal unit vectors, the rows of R, from axis 1 and a vector in the plane of axes 1 and 2
 * (Gram-Schmidt). Returns 0 if these span no plane. */
static int read_vectors (const pg_material *m, const pg_scene *scene, double R[9])
{
    static const char *const key[2] = { "axis_1", "axis_2" };
    double size[2], along = 0;
    for (int k = 0; k < 2; k++) {
        if (pg_scene_given (scene, "materials.%s.%s", m->name, key[k]))
            pg_scene_vector (scene, 3, R + 3 * k, "materials.%s.%s", m->name, key[k]);
        size[k] = pg_size (3, R + 3 * k);
        if (size[k] > 0) continue;
        fault (scene, m, key[k], "has no direction");
        return 0;
    }
    for (int k = 0; k < 3; k++) R[k] /= size[0], R[3 + k] /= size[1], along += R[k] * R[3 + k];
    for (int k = 0; k < 3; k++) R[3 + k] -= along * R[k];
    double left = pg_size (3, R + 3);
    /* The length of what is left of axis 2 is the sine of the angle between the two vectors: below 1e-6 its
     * direction would be rounding errors. */
    if (!(left > 1e-6)) {
        fault (scene, m, key[pg_scene_given (scene, "materials.%s.axis_2", m->name)],
               "axis_1 and axis_2 point the same way: give two vectors that span a plane");
        return 0;
    }
    for (int k = 0; k < 3; k++) R[3 + k] /= left;
    for (int k = 0; k < 3; k++)                        /* axis 3 = axis 1 x axis 2 */
        R[6 + k] = R[(k + 1) % 3] * R[3 + (k + 2) % 3] - R[(k + 2) % 3] * R[3 + (k + 1) % 3];
    return 1;
}

/* Reads the axes 1, 2, 3 of the material: the rows of R, in axes of the scene. Returns 0 if they are wrong.
 * */
static int read_axes (const pg_material *m, const pg_scene *scene, double R[9])
{
    if (!axes_fit (m, scene)) return 0;
    memset (R, 0, 9 * sizeof *R);
    R[0] = R[4] = R[8] = 1;
    if (m->mode == PG_SOLID) return read_vectors (m, scene, R);
    double angle = pg_scene_number (scene, "materials.%s.angle", m->name);
    R[0] = R[4] = cos (angle), R[1] = sin (angle), R[3] = -R[1];
    return 1;
}

/* Copies the rows and columns of the mode from the 6 x 6 stiffness. For plane stress it was inverted from
 * the compliance of two axes, so that it is the reduced stiffness already; in plane strain row zz gives
 * sigma_zz. */
static void reduce (pg_material *m, const double D[36])
{
    static const int plane[3] = { 0, 1, 3 };
    /* Voigt order in 3D is 11, 22, 33, 12, 23, 13, in 2D 11, 22, 12: rows 0, 1, 3 of 3D. */
    if (m->mode == PG_SOLID) memcpy (m->D, D, 36 * sizeof *D);
    else for (int a = 0; a < 3; a++) {
        for (int b = 0; b < 3; b++) m->D[3 * a + b] = D[6 * plane[a] + plane[b]];
        m->out_of_plane[a] = m->mode == PG_PLANE_STRAIN ? D[6 * 2 + plane[a]] : 0;
    }
}

/* Reads the constants, checks them, and computes the stiffness. modulus is the largest Young's modulus of the
 * axes, for estimates of stable steps and penalties; mu is a mean shear modulus for the same purpose. */
static pg_status read (pg_material *m, const pg_scene *scene)
{
    double c[CONSTANTS], C[36], D[36], R[9];
    int axes = m->mode == PG_PLANE_STRESS ? 2 : 3;
    if (m->mode == PG_LINE) {
        fault (scene, m, "model", "a bar has one modulus: use model: elastic");
        return PG_OK;
    }
    if (!complete (m, scene)) return PG_OK;
    for (int k = 0; k < CONSTANTS; k++) c[k] = pg_scene_number (scene, "materials.%s.%s", m->name, names[k]);
    if (!is_positive (m, scene, axes, c) || !read_axes (m, scene, R)) return PG_OK;
    memcpy (m->parameter, c, sizeof c);
    stiffness (axes, c, C);
    pg_rotate_stiffness (R, C, D);
    reduce (m, D);
    m->modulus = fmax (fmax (c[E1], c[E2]), axes == 3 ? c[E3] : 0);
    m->mu = m->mode == PG_SOLID ? (c[G12] + c[G13] + c[G23]) / 3 : c[G12];
    return PG_OK;
}

/* Writes the constants that the mode uses, for reports. */
static void describe (const pg_material *m, char *text, size_t size)
{
    const double *c = m->parameter;
    int used = snprintf (text, size, "E1 %.6g, E2 %.6g, ", c[E1], c[E2]);
    if (m->mode != PG_PLANE_STRESS && used > 0 && (size_t) used < size)
        used += snprintf (text + used, size - (size_t) used, "E3 %.6g Pa, nu13 %.6g, nu23 %.6g, ", c[E3],
                          c[NU13], c[NU23]);
    if (used > 0 && (size_t) used < size)
        used += snprintf (text + used, size - (size_t) used, "nu12 %.6g, G12 %.6g", c[NU12], c[G12]);
    if (m->mode == PG_SOLID && used > 0 && (size_t) used < size)
        used += snprintf (text + used, size - (size_t) used, ", G13 %.6g, G23 %.6g", c[G13], c[G23]);
    if (used > 0 && (size_t) used < size) snprintf (text + used, size - (size_t) used, " Pa");
}

const pg_material_type pg_material_orthotropic = {
    .name = "orthotropic",
    .summary =
        "linear, three planes of symmetry: moduli along axes of its own, turned by an angle or two vectors",
    .keys = { &table },
    .read = read,
    .stress = pg_tangent_stress,
    .describe = describe
};

/* SPDX-License-Identifier: GPL-3.0-or-later
 * material.h: stress from strain. Voigt order xx yy zz xy yz zx, engineering shears; 2D (xx yy xy), 1D (xx).
 * Catalogue: src/mechanics/material/<name>.c + one line in list.h. */
#ifndef PERIGAL_MATERIAL_H
#define PERIGAL_MATERIAL_H
#include "perigal/base.h"
#include "perigal/scene.h"

PG_API_BEGIN

typedef enum { PG_LINE, PG_PLANE_STRESS, PG_PLANE_STRAIN, PG_SOLID } pg_mode;   /* 1D, 2D, 2D, 3D */
int pg_voigt_size (int dim);                           /* 1, 3, 6 */
int pg_voigt_at   (int dim, int i, int j);             /* index of component ij in Voigt order */

typedef struct pg_material_type pg_material_type;
typedef struct {
    const pg_material_type *type;
    char    name[64];                                  /* name in the scene */
    pg_mode mode;
    double  density;                                   /* kg/m^3 */
    /* Constants of an isotropic material: Young's modulus (Pa), Poisson's ratio; NAN where the stiffness
     * depends on the direction: ask type->can before they are used. */
    double  E, nu;
    double  mu;                                        /* shear modulus, or the mean of several, Pa */
    double  parameter[16];                             /* parameters private to the type */
    double  D[36];                                     /* stiffness, nv x nv row-major, Pa */
    double  out_of_plane[6];  /* sigma_zz = out_of_plane . strain (plane strain), Pa */
    /* Volumetric part of D (and out_of_plane), Pa: stress = lambda (trace of strain) 1 + (a positive definite
     * rest) strain; 0: there is no such part (plane stress, bar). */
    double  lambda;
    double  modulus;  /* the largest Young's modulus: the scale of stiffness, Pa */
} pg_material;

/* PG_MATERIAL_ISOTROPIC: the material is determined by E and nu. Without it the stiffness D is needed, which
 * not every force model supports. */
enum { PG_MATERIAL_ISOTROPIC = 1 };

struct pg_material_type {
    const char *name, *summary;
    unsigned can;                                      /* PG_MATERIAL_... flags */
    /* Keys of materials.<name> that this type reads besides model and density: at most three tables of
     * `materials.{}.KEY`. Keys of other types are errors of the scene. */
    const pg_key_table *keys[4];
    /* Fills `m` (mode set by the caller) from materials.<name>; faults go to the scene. */
    pg_status (*read) (pg_material *m, const pg_scene *scene);
    /* Computes n strains (n x nv) -> stresses (n x nv, Pa) and, unless NULL, sigma_zz (n; 0 in plane
     * stress). */
    void (*stress) (const pg_material *m, size_t n, const double *strain, double *stress, double *zz);
    /* Writes one line with the constants for plans and reports. */
    void (*describe) (const pg_material *m, char *text, size_t size);
};
const pg_material_type *pg_material_find (const char *name);
const char *pg_material_names (void);                  /* "elastic|..." */
/* Adds a material type of the calling program to the catalogue, under a name of its own, before any scene is
 * read; `type` is borrowed permanently. PG_E_USAGE: the name exists, or 8 were added. Not thread-safe. */
pg_status pg_material_add (const pg_material_type *type);
/* The material materials.<name> of the scene, for a mode. A key that its model does not read is a fault of
 * the scene. */
pg_status pg_material_read (pg_material *out, const pg_scene *scene, const char *name, pg_mode mode);
/* pg_material_read where Young's modulus may be an expression of position: constants are then computed with
 * `reference` as modulus, Pa (NAN: it must be a number). */
pg_status pg_material_read_graded (pg_material *out, const pg_scene *scene, const char *name, pg_mode mode,
                                   double reference);
/* pg_keys_elastic: keys youngs_modulus and poissons_ratio. pg_elastic_set: sets all constants of an isotropic
 * material from E (Pa) and nu; the mode is set by the caller. */
extern const pg_key_table pg_keys_elastic;
void pg_elastic_set (pg_material *m, double E, double nu);
/* stress = D strain, sigma_zz = out_of_plane . strain: `stress` of every linear material. */
void pg_tangent_stress (const pg_material *m, size_t n, const double *strain, double *stress, double *zz);
/* Rotates a stiffness (6 x 6, Pa) from the axes of a material to those of the scene. R (3 x 3): its rows are
 * the axes of the material. */
void pg_rotate_stiffness (const double R[9], const double C[36], double D[36]);
/* Isotropic tangent for a mode (theory section 0). D is nv x nv. */
void pg_elastic_tangent (pg_mode mode, double E, double nu, double *D);
/* Moduli of state-based peridynamics (Silling et al. 2007; doc/method.md B6), Pa: *dilation: A = d kappa - (d
 * + 2) mu, *deviation: B = d (d + 2) mu, kappa the bulk modulus in d dimensions: plane stress E / (2 (1 -
 * nu)), plane strain lambda + mu, solid lambda + 2/3 mu. Energy of a point, J/m^3, with w = k / r and q = sum
 * w r^2 V: 1/2 [A theta^2 / d + B / q sum w (e.eta)^2 V]. 1D: A = 0, B = E. */
void pg_state_moduli (pg_mode mode, double E, double nu, double *dilation, double *deviation);
/* Speeds of elastic waves in a mode (plane stress: in a thin plate). Anisotropic: pressure and shear are the
 * fastest and the slowest of all directions, within about 0.1 %; lambda and mu are NAN, rayleigh is 0. */
typedef struct {
    double lambda, mu;                                 /* Pa */
    double pressure, shear, rayleigh;                  /* wave speeds, m/s; 0: no density, or no such wave */
} pg_waves;
pg_waves pg_material_waves (const pg_material *material);
/* Speed of the Rayleigh wave, the root of (2 - x^2)^2 = 4 sqrt ((1 - x^2) (1 - x^2 shear^2 / pressure^2)), x
 * = c / shear (Rayleigh 1885), to rounding; 0 unless 0 < shear < pressure. */
double pg_rayleigh_speed (double pressure, double shear);
/* Principal stresses sigma_1 >= sigma_2 >= sigma_3 of n stresses (n x nv) with out-of-plane zz (n or NULL =
 * 0). principal is n x 3. */
void pg_principal (int dim, size_t n, const double *stress, const double *zz, double *principal);
/* Bounds of principal stresses, most >= sigma_1 and least <= sigma_3 (n each): in 3D a fast approximation
 * within 5e-5 of the largest shear stress, else the principal stresses themselves. */
void pg_principal_bounds (int dim, size_t n, const double *stress, const double *zz, double *most,
                          double *least);
PG_API_END
#endif

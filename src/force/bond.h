/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: bond-based peridynamics. Files: bond.c (life cycle, forces, breaking), bond_matrix.c (K, its
 * diagonal and row sums, the bound of the largest frequency), bond_field.c (utilisation, fields, places,
 * census), bond_energy.c, bond_tiles.c (points that die by their energy), lps.c, lps_rows.c (what state-based
 * theory adds, alone or beside beams), bond_words.c (what the plan says). Pair force on i from j: V_i V_j c k
 * beta g s e, s = e . eta / r; linear in the displacement: kappa (xi . eta) xi, kappa = V_i V_j c k beta g /
 * r^3 (N/m^3), the same bits from either end. */
#ifndef PG_BOND_H
#define PG_BOND_H
#include "nodal.h"
#include "point_force_scene.h"
#include "micropolar.h"

typedef struct bond_tiles bond_tiles;                  /* bond_tiles.c */
typedef struct lps_rows lps_rows;                      /* lps_rows.c */
typedef struct {
    const pg_problem *problem;
    int       dim, threads, stride;  /* stride: unknowns of a point, dim and its rotations */
    size_t    n, widest;                               /* points; most bonds of one */
    const pg_family *family;
    nodal     nodal;
    double   *modulus;                                 /* c_h of each point, N/m^6 (n) */
    double   *limit;  /* critical stretch of each point; NULL: bonds do not break by theirs (n) */
    /* energy density at which a point dies, J/m^3, INFINITY: never; NULL: none does (n) */
    double   *critical;
    double   *density;                                 /* W of each point, J/m^3; with critical (n) */
    unsigned char *dying;  /* 0 but while they are looked for; with critical (n) */
    bond_tiles *tiles;                                 /* NULL until points are looked at in motion */
    /* state-based: A and B of each point, Pa; with beams A of the dilatation beside them, B 0; NULL: bonds
     * alone (n) */
    double   *dilation, *deviation;
    /* state-based: weighted volumes and C / q at that revision (n) */
    double   *q, *stiff;  unsigned long weighed;
    lps_rows *rows;  /* state-based: of the last preconditioner, NULL until then */
    unsigned char *counted;  /* state-based: bonds that no pre-crack cuts; NULL: all */
    /* beams (gmpd.c): bonds that bear shear; C_t,h and B of each point, N/m^4, limits gamma0, kappa0 (n);
     * shear NULL: bonds pull along themselves */
    double   *shear, *bending, *shear_limit, *bending_limit;
    unsigned char *idle;  /* points whose rotations nothing resists, C_t = 0; with shear (n) */
    pg_beam_law beams;  /* length: unknowns of rotations are this times the angle, m */
    pg_bond_loop_setting setting;                          /* what `sweep` was made from */
    pg_bond_loop *sweep;                                   /* forces, by the stretch of the rule */
    /* finite stretch: sums and sweep of the linear one, for K x; made when asked for */
    pg_sums   small;  pg_bond_loop *tangent;
    const unsigned char *alive;  /* of the state of the last refresh, borrowed; NULL: all live */
    double   *workspace;  /* bonds of one point: threads x widest x (dim + 2) */
    double   *work;                                    /* ndof */
    pg_operator op;
    pg_sparse K;                                       /* row NULL until asked for */
    int       all_stale;  /* columns of K to be made again: all, or those marked */
    unsigned char *stale;
    double   *diagonal;  unsigned long diagonal_of;    /* of K at that revision */
    unsigned long revision;
    /* row of blocks of a point with all its bonds, the own one last; NULL: not the same for all */
    double   *whole; int searched;
    pg_nearest *near;                                  /* points; NULL until a place is asked for */
} bond;

typedef struct {                                       /* the bonds of one point */
    size_t  first, m;                                  /* their entries of the family */
    const int *node;
    double *xi, *weight, *beta;                        /* m; k beta g; beta */
} point_bonds;
void   point_bonds_at (const bond *b, size_t i, int thread, point_bonds *out);
/* Force on i = - own d_i - other d_j (stride x stride each; other NULL: not wanted), small displacements.
 * pull: added to them, of a pull along the bond with the constant `both`, N/m^6 */
void bond_pull (const bond *b, size_t i, const point_bonds *s, size_t e, double both, double *own,
                double *other);
/* with shear: the beam alone */
void   bond_beam    (const bond *b, size_t i, const point_bonds *s, size_t e, double *own, double *other);
/* As that; of a dilatation beside the beams what bonds alone that are at least as stiff would do. */
void   bond_blocks  (const bond *b, size_t i, const point_bonds *s, size_t e, double *own, double *other);
/* N/m^3; r (m) or NULL */
double bond_kappa   (const bond *b, size_t i, const point_bonds *s, size_t e, double *r);
static inline int bond_lives (const bond *b, size_t entry) { return !b->alive || b->alive[entry]; }

/* forces, breaking */
pg_status bond_create (void **self, const pg_problem *problem);
void bond_free (void **self);
size_t bond_fields (const void *self, size_t max, pg_field *out);
pg_status bond_refresh (void *self, const pg_state *state, const pg_changes *changes);
pg_status bond_balance (void *self, double t, const double *d, double *residual, double *reference);
pg_status bond_mass (void *self, double *mass);
const pg_operator *bond_operator (void *self);
const pg_sparse *bond_basis (void *self);
pg_status bond_impose (void *self, double t, double *d);
pg_status bond_work_balance (void *self, double t, const double *d, const double *inertia,
                             pg_work_balance *out);
unsigned long bond_revision (const void *self);
pg_status bond_march (void *self, double t, const double *d, double *residual, double *reference,
                      pg_changes *broken);
pg_status bond_external (void *self, double t, double *P);
pg_status bond_surface (void *self, const double *stress, double *P);
/* matrix */
void bond_apply    (void *context, const double *x, double *y);
void bond_diagonal (void *context, double *d);
pg_status bond_tangent_sweep (bond *b, pg_bond_loop **out);                /* forces by the linear stretch */
pg_status bond_assemble (void *self);
const pg_sparse *bond_matrix (void *self);
int       bond_matrix_free (const void *self);  /* 1: dilatations reach further than bonds do */
pg_status bond_row_sums (void *self, double *sum);
pg_status bond_couplings (void *self, pg_couplings *out);
pg_status bond_bound (void *self, double *omega);
/* fields */
pg_status bond_utilisation (void *self, const pg_state *state, const double *d, double *utilisation,
                            char *kind, double *factor);
pg_status bond_field (void *self, const pg_state *state, const double *d, const char *name, int *components,
                      const char **unit, double *value);
pg_status bond_sample (void *self, const pg_state *state, const double *d, size_t n, const double *x,
                       double *u, double *stress);
double    bond_overlap (void *self, const pg_state *state, const double *d);
void      bond_census (void *self, size_t *degenerate, size_t *isolated, size_t *fragments);
/* points that die by their energy */
pg_status bond_energy_create (bond *b);  /* NULL unless the criterion needs energies */
void      bond_energy_free   (bond *b);
/* J/m^3, of its live bonds */
double    bond_energy_at     (const bond *b, size_t i, int thread, const double *d);
/* Appends the bonds of points at or over their limit at d, both directions, ascending; the sweeps know of
 * them from now on. */
pg_status bond_energy_kill   (bond *b, const double *d, pg_changes *broken);
/* Of each bond that of its worse end. */
pg_status bond_energy_utilisation (bond *b, const pg_state *state, const double *d, double *utilisation,
                                   char *kind, double *factor);
/* Marks in b->dying the points at or over their limit at d and counts them; forget: bonds may live again. */
pg_status bond_tiles_look    (bond *b, const double *d, size_t *dying);
void      bond_tiles_forget  (bond *b);
void      bond_tiles_free    (bond_tiles **tiles);
/* state-based (dilation not NULL) */
pg_status lps_create (bond *b);  /* moduli and bonds that count; nothing unless the rule is state-based */
pg_status lps_weigh  (bond *b);                                        /* q and stiff as they are now */
void      lps_free   (bond *b);
/* as bond_tiles_look, by the energies of all points */
pg_status lps_look   (bond *b, const double *d, size_t *dying);
/* k beta: dilatations know no factors of surfaces */
double    lps_weight (const bond *b, size_t i, const point_bonds *s, size_t e);
/* C / q, C = B + d max (A, 0): bonds alone with constant C_i / q_i + C_j / q_j are at least as stiff as the
 * state-based ones. */
void      lps_own    (const bond *b, size_t i, const point_bonds *s, double *D);  /* diagonal block of K */
/* of omega^2 times density, whatever bonds die */
double    lps_bound  (const bond *b, size_t i, const point_bonds *s);
/* sum t x xi V, Pa */
void lps_virial (const bond *b, size_t i, const point_bonds *s, const unsigned char *alive, const double *d,
                 double *T);
pg_status lps_couplings (bond *b, pg_couplings *out);                  /* row, alike and lattice of these */
void      lps_rows_free (bond *b);
/* bonds that bear shear */
pg_status gmpd_create (bond *b);  /* moduli and limits; nothing unless the rule is of beams */
char      gmpd_kind_of (void *self, const double *d, size_t entry);
void      gmpd_free   (bond *b);
/* Of pairwise forces (pg_method.read): sums, and the only Poisson's ratio that they know. */
void      bond_take_poisson (pg_problem *problem, const pg_scene *scene, const pg_sum_rule *rule);
pg_status bond_read   (pg_problem *problem, const pg_scene *scene);
/* words */
int         bond_describe (const void *self, size_t line, char *text, size_t size);
const char *bond_refuses  (const pg_problem *problem, unsigned solver);

/* All of it, for every force whose bonds are these; BOND_COMMON: without a matrix. */
#define BOND_ENTRIES \
    BOND_COMMON, .matrix = bond_matrix, .assemble = bond_assemble, .matrix_free = bond_matrix_free
#define BOND_COMMON \
    .create = bond_create, .free = bond_free, .fields = bond_fields, .refresh = bond_refresh, \
    .balance = bond_balance, .mass = bond_mass, .operator_ = bond_operator, .basis = bond_basis, \
    .impose = bond_impose, .utilisation = bond_utilisation, .work_balance = bond_work_balance, \
    .field = bond_field, .overlap = bond_overlap, .census = bond_census, .revision = bond_revision, \
    .sample = bond_sample, .march = bond_march, .external = bond_external, .bound = bond_bound, \
    .row_sums = bond_row_sums, .describe = bond_describe, .refuses = bond_refuses, \
    .couplings = bond_couplings, .surface = bond_surface
#endif

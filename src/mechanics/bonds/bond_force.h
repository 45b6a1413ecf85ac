/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: forces that bonds between points carry, whatever the theory: loop over bonds, loads and supports,
 * mass, breaking, K, fields. Files: bond_force.c (creation, forces, breaking), bond_force_matrix.c (K, its
 * diagonal and row sums, the bound of the largest frequency), bond_force_field.c (utilisation, fields, values
 * at any position, fragments), bond_force_energy.c (points whose bonds all break at a limit of their energy),
 * bond_faces.c (contact of crack faces), bond_force_words.c (texts of the plan of a run), bond_force_scene.c
 * (reading of the scene). The theories: pairwise.h, state_based.h, micropolar.h; the dilatation that the last
 * two have: dilatation.h. An intact bond is called live or alive, a broken one dead. */
#ifndef PG_BOND_FORCE_H
#define PG_BOND_FORCE_H
#include "mechanics/boundary/point_boundary.h"
#include "bond_force_scene.h"

typedef struct bond_force bond_force;
typedef struct {                                       /* the bonds of one point */
    size_t  first, m;                                  /* first entry of the family; number of bonds */
    const int *node;                                   /* neighbour of each bond (m) */
    double *xi, *weight, *beta;                        /* bond vector, m; k beta g; partial volume, 1 */
} point_bonds;

/* What distinguishes the theories: constants of points, the force of one bond, stress, texts. Blocks (stride
 * x stride, N/m) linearise the force of a bond between i and j: force on i = - own d_i - other d_j. */
typedef struct {
    /* Bytes of the theory's own struct, which begins with a bond_force. */
    size_t    size;
    /* Computes constants and limits of points, and fills in b->setting for the loop over bonds. */
    pg_status (*create) (bond_force *b);
    void      (*free)   (bond_force *b);
    /* Blocks of bond e of point i. The share of a dilatation, which couples more than two points, is replaced
     * by a bond that is at least as stiff. other NULL: not wanted. */
    void      (*blocks) (const bond_force *b, size_t i, const point_bonds *s, size_t e, double *own,
                         double *other);
    /* Blocks of a bond without the share of a dilatation. NULL: the dilatation gives all of the force. */
    void      (*alone)  (const bond_force *b, size_t i, const point_bonds *s, size_t e, double *own,
                         double *other);
    /* 1: point k has the constants of point 0, so that one row of K can serve both. NULL: never. */
    int       (*alike)  (const bond_force *b, size_t k);
    /* Virial stress: T (dim x dim, Pa) += 1/2 sum f x xi / V_i over the intact bonds of point i. */
    void      (*virial) (const bond_force *b, size_t i, const point_bonds *s, const unsigned char *alive,
                         const double *d, double *T);
    /* Marks in node.dying the points at or over their limit of energy at displacement d, and counts them. */
    pg_status (*find_dying) (bond_force *b, const double *d, size_t *count);
    /* Drops what find_dying remembers, as bonds may be intact again. NULL: it remembers nothing. */
    void      (*forget) (bond_force *b);
    /* Shear and bending of a bond between unknowns di, dj. NULL: it has neither. */
    void      (*strain) (const bond_force *b, const double *xi, const double *di, const double *dj,
                         double *shear, double *bending);
    /* The mode by which a bond breaks at d (pg_criterion_type.utilisation). NULL: tension, or energy with
     * criteria of energies. */
    char      (*kind_of) (const bond_force *b, const double *d, size_t entry);
    /* Writes the constants of a material in one line. */
    void      (*words)  (const bond_force *b, size_t material, char *text, size_t size);
} bond_theory;

/* Points that die, that is lose all their bonds, at a limit of their energy (criterion node_energy). */
typedef struct {
    double *critical; /* energy density at which a point dies, J/m^3, INFINITY: never; NULL: none does (n) */
    double   *density;                                 /* W of each point, J/m^3; NULL without critical (n) */
    unsigned char *dying; /* 1: the point dies in this step; 0 otherwise; NULL without critical (n) */
} bond_deaths;
/* Columns of K that are out of date: all, or those of the points marked (n). */
typedef struct { int all; unsigned char *column; } stale_columns;
/* What all theories share. A theory's own struct begins with it. */
struct bond_force {
    const bond_theory *theory;
    const pg_problem *problem;
    /* stride: unknowns of a point, dim and its rotations */
    int       dim, threads, stride;
    size_t    n, widest;                               /* number of points; most bonds of one */
    const pg_family *family;
    point_boundary boundary;
    /* unknowns of rotations are this length times the angle, m; 0: no rotations */
    double    length;
    /* 1: nothing resists the rotations of this point; NULL: there is none such (n) */
    unsigned char *idle;
    /* critical stretch of each point; NULL: bonds do not break by their stretch (n) */
    double   *limit;
    bond_deaths node;
    /* forces by the dilatations of both ends; NULL: none */
    struct dilatation *dilatation;
    pg_bond_loop_setting setting;                      /* what `loop` was made from */
    pg_bond_loop *loop;                                /* forces, by the stretch of the rule */
    /* With finite stretch: sums and loop with the linear stretch, for K x; made when first needed. */
    pg_sums   small;  pg_bond_loop *tangent;
    /* alive mask of the last refresh, borrowed: 1: the bond is intact; NULL: all are */
    const unsigned char *alive;
    double   *workspace;                               /* bonds of one point: threads x widest x (dim + 2) */
    double   *work;                                    /* a vector of forces, N (ndof) */
    pg_operator op;
    pg_sparse K;                                       /* stiffness, N/m; row NULL until asked for */
    stale_columns stale;
    double   *diagonal;  unsigned long diagonal_of;    /* diagonal of K, N/m (ndof); at which revision */
    unsigned long revision;                            /* changes whenever bonds break */
    /* Blocks of a point with all its bonds, its own block last; NULL: they are not the same for all points.
     * searched: 1: this has been found out. */
    double   *whole; int searched;
    pg_nearest *near;                                  /* search among the points; NULL until it is needed */
};
/* Makes a force of a theory: pg_force_type.create of the entries of the catalogue. */
pg_status bond_force_make (void **self, const pg_problem *problem, const bond_theory *theory);
void   point_bonds_at (const bond_force *b, size_t i, int thread, point_bonds *out);
static inline int bond_force_lives (const bond_force *b, size_t entry) { return !b->alive
        || b->alive[entry]; }

/* forces, breaking */
void bond_force_free (void **self);
size_t bond_force_fields (const void *self, size_t max, pg_field *out);
pg_status bond_force_refresh (void *self, const pg_state *state, const pg_changes *changes);
pg_status bond_force_balance (void *self, double t, const double *d, double *residual, double *reference);
void      bond_force_masses (const bond_force *b, double *mass);
pg_status bond_force_mass (void *self, double *mass, const pg_sparse **consistent);
const pg_operator *bond_force_operator (void *self);
const pg_sparse *bond_force_basis (void *self);
pg_status bond_force_impose (void *self, double t, double *d);
pg_status bond_force_work (void *self, double t, const double *d, const pg_known *known,
                           pg_work_balance *out);
unsigned long bond_force_revision (const void *self);
pg_status bond_force_balance_and_break (void *self, double t, const double *d, double *residual,
                                        double *reference,
                      pg_changes *broken);
pg_status bond_force_loads (void *self, double t, double *P);
pg_status bond_force_surface (void *self, const double *stress, double *P);
/* matrix */
void bond_force_apply    (void *context, const double *x, double *y);
void bond_force_diagonal (void *context, double *d);
/* Returns the loop over bonds with the linear stretch, for K x. */
pg_status bond_force_tangent_loop (bond_force *b, pg_bond_loop **out);
pg_status bond_force_matrix (void *self, pg_matrix_want want, const pg_sparse **K);
pg_status bond_force_row_sums (void *self, double *sum);
pg_status bond_force_couplings (void *self, pg_couplings *out);
pg_status bond_force_omega (const bond_force *b, double *omega);
pg_status bond_force_bound (void *self, double *omega);
/* fields */
pg_status bond_force_judge (void *self, const pg_state *state, const double *d, const pg_judging *what);
pg_status bond_force_field (void *self, const pg_state *state, const double *d, const char *name,
                            int *components,
                      const char **unit, double *value);
pg_status bond_force_sample (void *self, const pg_state *state, const double *d, size_t n, const double *x,
                             double *u, double *stress, double *gradient);
void      bond_force_join   (void *self, int *parent);
pg_status bond_force_census (void *self, pg_census *out);
/* contact of crack faces by the bonds that crossed them (bond_faces.c) */
pg_status bond_force_jump (void *self, const pg_state *state, size_t n, const double *x, const double *normal,
                           double radius, pg_jump_rows *out);
pg_status bond_force_faces (void *self, const pg_state *state, const pg_face_pieces *pieces, pg_sparse *rows,
                            double *soft, double *stiffer);
/* points that lose all bonds at a limit of their energy (bond_force_energy.c) */
pg_status bond_force_energy_create (bond_force *b);  /* makes b->node if the criterion needs energies */
void      bond_force_energy_free   (bond_force *b);
/* Appends the bonds of points at or over their limit at d to `broken`, both directions, ascending, and tells
 * the loop over bonds. */
pg_status bond_force_energy_kill   (bond_force *b, const double *d, pg_changes *broken);
/* Utilisation of each bond: the larger one of its two ends. */
pg_status bond_force_energy_utilisation (bond_force *b, const pg_state *state, const double *d,
                                         double *utilisation,
                                   char *kind, double *factor);
/* texts */
int         bond_force_describe (const void *self, size_t line, char *text, size_t size);
int         bond_force_spared   (const void *self, size_t k, char *what, char *why, double *seconds);

/* The entries of pg_force_type that all theories share (all but `create`); BOND_FORCE_COMMON: without a
 * matrix. */
#define BOND_FORCE_ENTRIES \
    BOND_FORCE_COMMON, .matrix = bond_force_matrix
#define BOND_FORCE_COMMON \
    .free = bond_force_free, .fields = bond_force_fields, .refresh = bond_force_refresh, \
    .balance = bond_force_balance, .mass = bond_force_mass, .operator_ = bond_force_operator, \
    .basis = bond_force_basis, .impose = bond_force_impose, .judge = bond_force_judge, \
    .work = bond_force_work, \
    .field = bond_force_field, \
    .census = bond_force_census, .join = bond_force_join, .loads = bond_force_loads, \
    .revision = bond_force_revision, .sample = bond_force_sample, \
    .motion.balance_and_break = bond_force_balance_and_break, \
    .motion.bound = bond_force_bound, \
    .motion.row_sums = bond_force_row_sums, .describe = bond_force_describe, \
    .spares.couplings = bond_force_couplings, .surfaces.surface = bond_force_surface, \
    .spares.spared = bond_force_spared, .surfaces.faces = bond_force_faces, .surfaces.jump = bond_force_jump
#endif

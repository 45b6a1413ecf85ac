/* SPDX-License-Identifier: GPL-3.0-or-later
 * force.h: out-of-balance force of a displacement, and what solvers need of it. Catalogue:
 * src/mechanics/force/<name>.c
 * + list.h. A force owns its fields (displacement; with micropolar models also rotation) and its caches; dofs
 * are numbered node by node. */
#ifndef PERIGAL_FORCE_H
#define PERIGAL_FORCE_H
#include "perigal/linalg.h"
#include "perigal/model.h"

PG_API_BEGIN

typedef struct { const char *name, *unit; int components; } pg_field;

/* What the boundary does: pairs of generalised force and displacement whose product is work, and sums per
 * load. */
typedef struct {
    size_t  npair;
    double *force, *displacement;                      /* N, m (npair) */
    double *reaction;  /* on the body per load and component, N, N m (PG_REACTIONS a load) */
    double  strain;  /* stored energy: strain, stabilisation, boundary terms, J */
} pg_work_balance;

/* What the caller knows of the state whose work is asked for, so that the force need not evaluate it. */
typedef struct {
    /* What motion and contact add to the residual, N (ndof); NULL: nothing. */
    const double *inertia;
    /* The residual of the state with the bonds that are intact now, N (ndof), less `inertia` or (whole: 1)
     * with it. NULL: the force evaluates it. */
    const double *residual;
    int whole;
    /* 1: a static state in equilibrium. Stored energy may be half the work of the forces at hand on the
     * displacements at hand (Clapeyron's theorem). */
    int rest;
} pg_known;

/* Estimated error of the stress s against the recovered stress s*; norms: sqrt (int s C s dV), C =
 * compliance, so their squares are twice an energy. */
typedef struct {
    double error, norm;                                /* of s* - s, of s; sqrt (J) */
    double relative;                                   /* error / sqrt (norm^2 + error^2) */
    double seconds;
    size_t points, left_out;  /* of evaluation: taken part; degenerate, or without a patch */
} pg_estimate;

/* What refreshes have changed of K since it was last asked for. */
typedef struct {
    /* 0: everything may have changed, or more than is worth telling. */
    int known;
    /* 1: the basis of elimination has changed too; forces that do not depend on d have. */
    int basis, loads;
    /* The nodes that are touched, and the change of K between their unknowns, N/m: symmetric, row-major, a
     * row every `width` numbers, unknowns numbered node by node in this order. Borrowed until the next
     * refresh. */
    size_t n, width;
    const int *node;
    const double *K;
} pg_stiffness_change;
/* Some bonds that are looked at again and again, while most of the body is not. */
typedef struct {
    size_t  n, *bond;                                  /* ascending: indices of pg_state.alive */
    size_t  first[PG_BOND_SETS + 1];                   /* bonds of set s: first[s] .. first[s + 1] - 1 */
    size_t *owner;                                     /* the point of its set that owns each bond (n) */
    size_t  npoint[PG_BOND_SETS], *point[PG_BOND_SETS];        /* ends of the bonds, ascending */
    size_t  nnode;  int *node;  /* nodes whose unknowns make displacement and stress there, ascending */
} pg_bond_group;
void pg_bond_group_clear (pg_bond_group *group);
/* What is asked of bonds. Arrays that are NULL are not wanted. */
typedef struct {
    /* Of all bonds (nbond numbers each), or of those of `group` in its order (n each; the displacement is
     * read at the nodes of the group alone): utilisation; what a bond would break of, 't' tension, 's'
     * shear, 'b' bending ...; the load factor of its limit, the displacement being that of factor 1.
     * Broken bonds, and those that never break: 0, INFINITY. */
    const pg_bond_group *group;
    double *utilisation, *factor;
    char   *kind;
    /* over: the worst bonds alone. *top is the largest utilisation of an intact bond, of all ranks; where
     * it is above 1, `over` gets the bonds of this rank from utilisation `from` on, ascending (freed by
     * the caller): utilisation and kind have a meaning at their places alone. */
    pg_changes *over;
    double from, *top;
    /* count > 0: so many displacements, d[unknown * count + k]. top[k] is the largest utilisation of an
     * intact bond that is not marked in left_out (nbond bytes); of_unit: one over the least load factor
     * instead. Sums may run in another order than for one displacement. */
    size_t count;
    const unsigned char *left_out;
    int of_unit;
    /* The largest overlap of the faces of broken bonds, m; nothing else is asked with it, and without a
     * failure criterion too. */
    double *overlap;
} pg_judging;
/* The worst bonds (pg_judging.over) where the utilisation of all of them is known. */
pg_status pg_worst_bonds (const pg_problem *problem, const pg_state *state, const double *utilisation,
                          double from, double *top, pg_changes *over);
/* The jump of the displacement at places on cracks, or the displacement at places on the surface: that of
 * place q is the sum of value[e] times the unknowns of node[e], component by component, over e from start[q]
 * to before start[q + 1]. */
typedef struct {
    size_t  n, *start;  int *node;  double *value;
    size_t  poor;  /* places whose values are zero: see pg_force_surfaces */
} pg_jump_rows;
void pg_jump_rows_clear (pg_jump_rows *rows);
#define PG_CONTACT_STIFFEST 2.0                        /* see pg_force_surfaces.faces */
/* Faces of cracks that may touch, in pieces that are sampled at places. Borrowed. */
typedef struct {
    size_t n, dim, npoint;                             /* pieces; places of all of them */
    const size_t *first;                               /* places of piece k: first[k] .. first[k + 1] - 1 */
    /* of places: m (x dim); unit normals (x dim); tangents at right angles (x dim - 1 x dim); m^2 */
    const double *x, *normal, *tangent, *weight;
    /* Pieces of cracks of the state, which come first, get the dead bonds that cross them; the others those
     * listed: places in the family of all points, and the place on the faces that each belongs to. */
    size_t nknown, nbroken;
    const size_t *broken, *place;
} pg_face_pieces;

/* What is left of a body whose bonds break. */
typedef struct {
    /* Points of evaluation without a gradient, which carry no stress; nodes alone; parts beside the largest
     * one. */
    size_t degenerate, isolated, fragments;
    double at[3];  /* the first of those points, m; left as it was where there is none */
    size_t unended;  /* background cells near cracks, but not near tips, that cannot end at the cracks */
} pg_census;

/* What is asked of the matrix: where it is as it was assembled last, in line with the last refresh, or that
 * its memory is freed until it is assembled again (a force may keep it). */
typedef enum { PG_MATRIX_AT_HAND, PG_MATRIX_ASSEMBLED, PG_MATRIX_FREED } pg_matrix_want;

/* Entries for motion. */
typedef struct {
    /* Explicit methods: as balance at (t, d), but bonds at or over their limit at d are dead in it and in the
     * caches from now on; they are appended to `broken`, ascending; the caller clears their alive bits and
     * does not refresh. reference may be NULL. NULL entry: utilisation, refresh, balance do. */
    pg_status (*balance_and_break) (void *self, double t, const double *d, double *residual,
                                    double *reference, pg_changes *broken);
    /* An upper bound, in closed form, of the largest eigenfrequency of K x = omega^2 M x, rad/s, intact
     * bonds. NULL: from row_sums. */
    pg_status (*bound)   (void *self, double *omega);
    /* sum_j |K_ij| of every dof, N/m (Gershgorin; adaptive dynamic relaxation). NULL: from the matrix. */
    pg_status (*row_sums) (void *self, double *sum);
} pg_force_motion;
/* Entries for surfaces that touch or are loaded: of the body, and faces of cracks. */
typedef struct {
    /* P += nodal forces, N (ndof), of the tractions of a uniform stress (xx yy zz xy yz zx of a solid, xx yy
     * xy of a plane, Pa) on all facets that this force bears loads on: of pg_problem_bare the whole surface.
     * NULL: not known. */
    pg_status (*surface) (void *self, const double *stress, double *P);
    /* Displacement on the side that the normal shows to, less that on the other, at n places on cracks of the
     * state (x, normal: n x dim), by shape functions that see so many spacings far. Places one side of which
     * sees too little for a linear field have none: their values are zero. NULL: contact of crack faces
     * cannot be asked of this force. */
    pg_status (*jump) (void *self, const pg_state *state, size_t n, const double *x, const double *normal,
                       double radius, pg_jump_rows *out);
    /* Displacement at n places on the surface of the body (x, outward unit normal: n x dim), by the shape
     * functions that carry a traction there, the body being seen from inside. NULL: platens cannot be asked
     * of this force. */
    pg_status (*trace) (void *self, const pg_state *state, size_t n, const double *x, const double *normal,
                        pg_jump_rows *out);
    /* Instead of jump, of forces whose bonds are what joins the two sides: columns of G' for each piece (ndof
     * x dim n: its mean opening, then its slips), compliance of the layer between the faces, m/N (dim n), and
     * how much stiffer than the bonds that crossed them its springs may be (*stiffer >= 1), at the last
     * refresh. Layers of bonds that broke one by one are made no stiffer than PG_CONTACT_STIFFEST times.
     * NULL: jump, if there is one. */
    pg_status (*faces) (void *self, const pg_state *state, const pg_face_pieces *pieces, pg_sparse *rows,
                        double *soft, double *stiffer);
    /* Of forces whose unknowns are no displacements of points (both entries; NULL: they are): u = N x, what
     * unknowns make of the displacement, or velocity, at the nodes by the shape functions of the last
     * refresh, and f += N' F, unknowns taking forces F on the nodes, N. All n x dim. */
    void      (*at_nodes)   (void *self, const double *x, double *u);
    void      (*from_nodes) (void *self, const double *F, double *f);
} pg_force_surfaces;
/* Entries that spare work and change no answer. */
typedef struct {
    /* What shortcuts of the force have spared so far, one at a time: what (96), why (160), seconds; returns 0
     * past the last. NULL: none. */
    int       (*spared)  (const void *self, size_t k, char *what, char *why, double *seconds);
    /* What the evaluation points of these bonds have of K x, N (ndof), before a refresh by these changes or
     * after it. *can 0: forces depend on the changes by more than these points. NULL: never. */
    pg_status (*share_of) (void *self, const double *x, const pg_changes *changes, double *y, int *can);
    /* What refreshes have changed of K since the last call; the first call begins the record and knows
     * nothing. NULL: never known. */
    pg_status (*change) (void *self, pg_stiffness_change *out);
    /* Rows of K at the last refresh, by points, for preconditioners of the operator. NULL: none can be
     * had. */
    pg_status (*couplings) (void *self, pg_couplings *out);
    /* Finite elements on the points, whose energies are about those of K at the last refresh, for
     * preconditioners of the operator. NULL: none can be had. */
    pg_status (*elements) (void *self, pg_elements *out);
    /* Fills in what belongs to group->bond, whatever the group held before, so that it can be judged by
     * itself; *can 0: not with this problem, as stresses reach further than the bonds. NULL: of a
     * group `judge` tells the kinds alone, for which n and bond of it suffice. */
    pg_status (*gather) (void *self, pg_bond_group *group, int *can);
    /* As balance, by one sweep that keeps no strains: for displacements of which nothing else will be asked.
     * NULL: balance does. */
    pg_status (*balance_lean) (void *self, double t, const double *d, double *residual, double *reference);
} pg_force_spares;
/* Needed: create, free, fields, balance and one of operator_ and matrix; newmark also needs mass. The rest
 * may be NULL. */
typedef struct {
    pg_method method;  /* name, summary, and what the model needs to know before there is a force */
    pg_status (*create)  (void **self, const pg_problem *problem);
    void      (*free)    (void **self);
    size_t    (*fields)  (const void *self, size_t max, pg_field *out);
    /* Brings the caches in line with state->alive: all of them (changes NULL), or what the changes touch. */
    pg_status (*refresh) (void *self, const pg_state *state, const pg_changes *changes);
    /* residual = loads (t) - internal force (d), boundary terms included; reference: the size it is measured
     * against, N. */
    pg_status (*balance) (void *self, double t, const double *d, double *residual, double *reference);
    /* kg. lumped: of each unknown. consistent: one number for each pair of nodes (upper triangle, n x n), the
     * same for every component; that of the bonds alive when it is first asked for, and stays: breaking moves
     * no mass. *consistent NULL: lumped mass only, as of forces without shape functions. NULL: not wanted. */
    pg_status (*mass)    (void *self, double *lumped, const pg_sparse **consistent);
    const pg_operator *(*operator_) (void *self);                          /* K x, or NULL */
    /* K at the last refresh (pg_matrix_want). *K NULL: it has none for what it was created with; K->value
     * NULL: none is assembled. NULL entry: matrix-free. Use pg_force_assemble, pg_force_matrix. */
    pg_status (*matrix)  (void *self, pg_matrix_want want, const pg_sparse **K);
    /* Essential conditions by elimination: d = T q + g. NULL entries or T NULL: none. */
    const pg_sparse   *(*basis)     (void *self);
    pg_status (*impose)  (void *self, double t, double *d);                /* makes d satisfy them */
    /* What bonds use of their limits at d (pg_judging). NULL: there are no bonds. */
    pg_status (*judge) (void *self, const pg_state *state, const double *d, const pg_judging *what);
    /* The work balance of (t, d); known NULL: nothing is. `out` is sized on the first call. NULL: none. */
    pg_status (*work) (void *self, double t, const double *d, const pg_known *known, pg_work_balance *out);
    /* A field at the nodes: "displacement" (m), "coefficient" (of the shape functions, m), "strain", "stress"
     * (Pa), "damage", "error_estimate" (Pa); *components 0: unknown name. value: n x 6. */
    pg_status (*field) (void *self, const pg_state *state, const double *d, const char *name, int *components,
                        const char **unit, double *value);
    /* What the bonds of the last refresh leave of the body. */
    pg_status (*census)  (void *self, pg_census *out);
    /* Joins the points that carry forces to each other at the last refresh: sets of points (pg_disjoint, n;
     * of a rank by what its own points take part in). NULL: not known. */
    void      (*join)    (void *self, int *parent);
    /* Loads at t as nodal forces, N (ndof); supports are not among them. NULL: balance at d = 0 tells, and
     * supports with it. */
    pg_status (*loads)   (void *self, double t, double *P);
    /* Changes whenever refresh changed K or the basis: an old factor may serve until then (NULL: every
     * refresh changes them). */
    unsigned long (*revision) (const void *self);
    /* Displacement (m), stress (Pa) and displacement gradient (the last two NULL: not wanted) at any n places
     * by the force's own shape functions, the bonds being those of the last refresh: places on the two sides
     * of a crack keep their own values. x: n x dim; u: n x 3, 0 beyond dim; stress: n x 6, always xx yy zz xy
     * yz zx (2D: zz as the mode has it); gradient: n x 9, of which H[c * dim + k] = du_c/dx_k at the front,
     * by the derivatives of the shape functions. Outside the body: continued from the nearest point. NULL:
     * least squares (perigal/compare.h). */
    pg_status (*sample) (void *self, const pg_state *state, const double *d, size_t n, const double *x,
                         double *u, double *stress, double *gradient);
    /* NULL: none. value: NULL, or the root of E times the mean of (s* - s) C (s* - s) around each node, Pa
     * (n). */
    pg_status (*estimate) (void *self, const double *d, pg_estimate *out, double *value);
    /* Constants and choices in words, one line each, for plans and reports; returns 0 past the last line.
     * NULL: nothing to say. */
    int       (*describe) (const void *self, size_t line, char *text, size_t size);
    pg_force_motion   motion;
    pg_force_surfaces surfaces;
    pg_force_spares   spares;
} pg_force_type;
/* Brings K in line with the last refresh. K may be NULL; *K NULL: there is none. */
pg_status pg_force_assemble (const pg_force_type *force, void *self, const pg_sparse **K);
/* K as last assembled (value NULL: not assembled yet, or freed); returns NULL where the force has none. */
const pg_sparse *pg_force_matrix (const pg_force_type *force, void *self);
/* Stress (xx yy zz xy yz zx, Pa) of the displacement gradient H[c * dim + k] = du_c/dx_k. */
void pg_stress_of_gradient (const pg_material *material, int dim, const double *H, double *stress);
/* The upper bound of the largest eigenfrequency that explicit methods take, rad/s: the force's own, or from
 * row sums at its last refresh (workspace: one number for each dof, as mass is). NAN: the force has neither.
 * Of a rank that of its own points. *from: which, in words. */
pg_status pg_force_bound (const pg_force_type *force, void *self, const pg_cloud *cloud, size_t ndof,
                          const double *mass, double *workspace, double *omega, const char **from);
const pg_force_type *pg_force_find  (const char *name);
/* the one that the problem was built for */
const pg_force_type *pg_force_of    (const pg_problem *problem);
const pg_method *const *pg_force_methods (void);                       /* of all forces; ends with NULL */
/* The problem of a scene: pg_problem_prepare_with and pg_problem_complete of perigal/model.h, for all
 * forces. */
pg_status pg_problem_prepare (pg_problem **out, const pg_scene *scene, int threads);
pg_status pg_problem_build   (pg_problem **out, const pg_scene *scene, int threads);
const char          *pg_force_names (void);
void pg_work_balance_clear (pg_work_balance *work_balance);
PG_API_END
#endif

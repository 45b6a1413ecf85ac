/* SPDX-License-Identifier: GPL-3.0-or-later
 * law_state.h: bonds of the linear peridynamic solid (Silling et al. 2007; theory B6). Included once per
 * instruction set behind the vectors of list_instances.h. With w = k beta / r, p = xi . eta of an intact
 * bond, V the volumes of its ends i (own) and j, d the dimension, and for each point the numbers A, B (Pa)
 * and q = sum w r^2 V:
 *   dilate  sum_j w V_j p                              (theta_i = d / q_i times this)
 *   pull    sum_j w V_i V_j [alpha_i + alpha_j + (beta_i + beta_j) p / r^2] xi,  alpha = A theta / q, beta =
 *   B / q
 *   store   sum_j w V_j p  and  sum_j w V_j p^2 / r^2, from which the energy of a point follows.
 * A record is {x, u, alpha, beta}; the numbers of a bond are w V_j and w V_i V_j. A bond breaks where
 * p >= s0 r^2. */
INLINE int state_dilate_columns (int dim, int check) { (void) check; return 2 * dim; }
INLINE int state_dilate_sums (int dim) { (void) dim; return 1; }
enum { state_dilate_first = 0, state_dilate_terms = 1, state_dilate_shared = 0 };

INLINE V state_product (int dim, const V *own, const V *other, V *xi)
{
    V eta[3];
    vec_differ (dim, own, other, xi);
    vec_differ (dim, own + dim, other + dim, eta);
    return vec_dot (dim, xi, eta);
}

INLINE unsigned state_dilate_over (int dim, const V *own, const V *other, V limit, const double *constant)
{
    V xi[3], p = state_product (dim, own, other, xi);
    (void) constant;
    return V_LEAST (p, limit * vec_dot (dim, xi, xi));
}

INLINE void state_dilate_add (int dim, const V *own, const V *other, const V *term, unsigned live,
                              const double *constant, V *out)
{
    V xi[3];
    (void) constant;
    out[0] = V_KEEP (term[0] * state_product (dim, own, other, xi), live);
}

INLINE int state_pull_columns (int dim, int check) { (void) check; return 2 * dim + 2; }
INLINE int state_pull_sums (int dim) { return dim; }
enum { state_pull_first = 1, state_pull_terms = 1, state_pull_shared = 0 };

INLINE void state_pull_add (int dim, const V *own, const V *other, const V *term, unsigned live,
                            const double *constant, V *out)
{
    V xi[3], p = state_product (dim, own, other, xi);
    (void) constant;
    V alpha = own[2 * dim] + other[2 * dim], beta = own[2 * dim + 1] + other[2 * dim + 1];
    V pull = V_KEEP (term[0] * (alpha + beta * p / vec_dot (dim, xi, xi)), live);
    UNROLL for (int c = 0; c < dim; c++) out[c] = pull * xi[c];
}

INLINE int state_store_columns (int dim, int check) { (void) check; return 2 * dim; }
INLINE int state_store_sums (int dim) { (void) dim; return 2; }
enum { state_store_first = 0, state_store_terms = 1, state_store_shared = 0 };

INLINE void state_store_add (int dim, const V *own, const V *other, const V *term, unsigned live,
                             const double *constant, V *out)
{
    V xi[3], p = state_product (dim, own, other, xi), part = term[0] * p;
    (void) constant;
    out[0] = V_KEEP (part, live);
    out[1] = V_KEEP (part * p / vec_dot (dim, xi, xi), live);
}

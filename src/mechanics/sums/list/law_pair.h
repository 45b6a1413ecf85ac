/* SPDX-License-Identifier: GPL-3.0-or-later
 * law_pair.h: pair forces along bonds (bond-based theory; theory A, B1). Included once per instruction set
 * behind the vectors of list_instances.h. For a bond with xi (position of the other end less that of the own
 * end) and eta (displacement of the other end less that of the own end), with the bond's number a:
 *   linear  a = c k beta g V V / r^3:  force on the own end a (xi . eta) xi
 *   finite  a = c k beta g V V / r:    force a s y / |y|, y = xi + eta, s = (|y| - r) / r; with
 *           value = |y|^2 - r^2 = 2 xi . eta + eta . eta it is a value y / (|y|^2 + |y| r), free of
 *           cancellation.
 * A bond breaks where xi . eta >= s0 r^2 (linear), value >= s0 (2 + s0) r^2 (finite).
 * A record is {x, u}; the force on the other end is the opposite one. */
INLINE int pair_linear_columns (int dim, int check) { (void) check; return 2 * dim; }
INLINE int pair_linear_sums (int dim) { return dim; }
enum { pair_linear_first = 0, pair_linear_terms = 1, pair_linear_shared = 1 };

INLINE unsigned pair_linear_over (int dim, const V *own, const V *other, V limit, const double *constant)
{
    V xi[3], eta[3];
    (void) constant;
    vec_differ (dim, own, other, xi);
    vec_differ (dim, own + dim, other + dim, eta);
    return V_LEAST (vec_dot (dim, xi, eta), limit * vec_dot (dim, xi, xi));
}

INLINE void pair_linear_add (int dim, const V *own, const V *other, const V *term, unsigned live,
                             const double *constant, V *out)
{
    V xi[3], eta[3];
    (void) constant;
    vec_differ (dim, own, other, xi);
    vec_differ (dim, own + dim, other + dim, eta);
    V pull = V_KEEP (term[0] * vec_dot (dim, xi, eta), live);
    UNROLL for (int c = 0; c < dim; c++) out[c] = pull * xi[c];
}

INLINE int pair_finite_columns (int dim, int check) { (void) check; return 2 * dim; }
INLINE int pair_finite_sums (int dim) { return dim; }
enum { pair_finite_first = 0, pair_finite_terms = 1, pair_finite_shared = 1 };

INLINE V pair_finite_value (int dim, const V *xi, const V *eta)
{
    V dot = vec_dot (dim, xi, eta);
    return dot + dot + vec_dot (dim, eta, eta);
}

INLINE unsigned pair_finite_over (int dim, const V *own, const V *other, V limit, const double *constant)
{
    V xi[3], eta[3];
    (void) constant;
    vec_differ (dim, own, other, xi);
    vec_differ (dim, own + dim, other + dim, eta);
    return V_LEAST (pair_finite_value (dim, xi, eta), limit * vec_dot (dim, xi, xi));
}

INLINE void pair_finite_add (int dim, const V *own, const V *other, const V *term, unsigned live,
                             const double *constant, V *out)
{
    V xi[3], eta[3], y[3];
    (void) constant;
    vec_differ (dim, own, other, xi);
    vec_differ (dim, own + dim, other + dim, eta);
    UNROLL for (int c = 0; c < dim; c++) y[c] = xi[c] + eta[c];
    V yy = vec_dot (dim, y, y), rr = vec_dot (dim, xi, xi);
    V pull = V_KEEP (term[0] * pair_finite_value (dim, xi, eta) / (yy + V_ROOT (yy * rr)), live);
    UNROLL for (int c = 0; c < dim; c++) out[c] = pull * y[c];
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * law_beam.h: micropolar bonds, beams that bear shear and bending (Chen 2022; theory G2). Included once per
 * instruction set behind the vectors of list_instances.h; the same operations in the same order as those of
 * beam.h for one bond. For a bond xi with unknowns u and q = length theta of its ends i (own) and j:
 *   w = eta - lever (q_i + q_j) x xi,  lever = 1 / (2 length),  diff = q_j - q_i,
 *   force  g = kt w + (kn - kt) e (e . w),   moment lever xi x g + kb diff_perp   (2D: diff itself),
 *   twice the energy (kn s^2 + kt gamma^2) r^2 + kb diff_perp^2,  s = e . w / r, gamma = |w_perp| / r.
 * A record is {x, u, q, 1 / s0^2, 1 / gamma0^2, 1 / kappa0^2}, the last three being read if bonds can break;
 * the numbers of a bond are kt, kn, kb (N/m). A bond breaks at a limit of either end. */
typedef struct { V xi[3], w[3], diff[3], inverse; } beam_motion;       /* inverse: 1 / r^2 */

/* Computes xi, w and diff (m) of a bond in each lane. constant: the lever, and on a lattice the steps by
 * which positions counted in steps become m. */
INLINE beam_motion beam_move (int dim, const V *own, const V *other, const double *constant)
{
    beam_motion b;
    V sum[3];
    const int turns = dim == 2 ? 1 : 3;
    const V lever = V_SET (constant[BEAM_LEVER]);
    UNROLL for (int k = 0; k < turns; k++) {
        sum[k] = lever * (own[2 * dim + k] + other[2 * dim + k]);
        b.diff[k] = other[2 * dim + k] - own[2 * dim + k];
    }
    UNROLL for (int c = 0; c < dim; c++) {
        b.xi[c] = V_SET (constant[BEAM_STEP + c]) * (other[c] - own[c]);
        b.w[c] = other[dim + c] - own[dim + c];
    }
    if (dim == 2) {
        b.w[0] = b.w[0] + sum[0] * b.xi[1];
        b.w[1] = b.w[1] - sum[0] * b.xi[0];
    } else {
        b.w[0] = b.w[0] - (sum[1] * b.xi[2] - sum[2] * b.xi[1]);
        b.w[1] = b.w[1] - (sum[2] * b.xi[0] - sum[0] * b.xi[2]);
        b.w[2] = b.w[2] - (sum[0] * b.xi[1] - sum[1] * b.xi[0]);
    }
    b.inverse = V_SET (1.0) / vec_dot (dim, b.xi, b.xi);
    return b;
}

/* Returns how many numbers of a record are position and unknowns. */
INLINE int beam_known (int dim) { return dim == 2 ? 5 : 9; }

/* Computes s, gamma^2 (shear) and the square of the part of diff across the bond (turn, m^2). */
INLINE void beam_measure (int dim, const beam_motion *b, V *s, V *shear, V *turn)
{
    V along = vec_dot (dim, b->xi, b->w) * b->inverse, across = V_SET (0);
    UNROLL for (int c = 0; c < dim; c++) {
        V off = b->w[c] - along * b->xi[c];
        across = across + off * off;
    }
    *s = along, *shear = across * b->inverse, *turn = V_SET (0);
    if (dim == 2) {
        *turn = b->diff[0] * b->diff[0];
        return;
    }
    V twist = vec_dot (3, b->xi, b->diff) * b->inverse;
    UNROLL for (int c = 0; c < 3; c++) {
        V off = b->diff[c] - twist * b->xi[c];
        *turn = *turn + off * off;
    }
}

/* Returns the lanes in which the bond is at the limits of a point. share: 1 / s0^2, 1 / gamma0^2, 1 /
 * kappa0^2. */
INLINE unsigned beam_at_limit (const V *share, V s, V shear, V bend, V limit, int single)
{
    V a = V_KEEP (s * s * share[0], V_LEAST (s, V_SET (0))), b = shear * share[1], c = bend * share[2];
    if (single) return V_LEAST (a, limit) | V_LEAST (b, limit) | V_LEAST (c, limit);
    return V_LEAST (a + b + c, limit);
}

/* Numbers that force loops read of both ends: position and unknowns, and limits if bonds can break; numbers
 * that they sum. */
INLINE int beam_force_columns (int dim, int check) { return beam_known (dim) + (check ? 3 : 0); }
INLINE int beam_force_sums (int dim) { return dim == 2 ? 3 : 6; }
enum { beam_force_first = 0, beam_force_terms = 3, beam_force_shared = 0 };

/* Returns the lanes in which the bond is at the limits of its own end or of the other one. */
INLINE unsigned beam_force_over (int dim, const V *own, const V *other, V limit, const double *constant)
{
    const beam_motion b = beam_move (dim, own, other, constant);
    const double per_length = constant[BEAM_PER_LENGTH];
    const int single = constant[BEAM_SINGLE] != 0;
    V s, shear, bend;
    beam_measure (dim, &b, &s, &shear, &bend);
    bend = bend * V_SET (per_length * per_length);
    return beam_at_limit (own + beam_known (dim), s, shear, bend, limit, single)
         | beam_at_limit (other + beam_known (dim), s, shear, bend, limit, single);
}

/* Force and moment (over the length) on the own end, N; 0 in lanes of broken bonds. */
INLINE void beam_force_add (int dim, const V *own, const V *other, const V *term, unsigned live,
                            const double *constant, V *out)
{
    const beam_motion b = beam_move (dim, own, other, constant);
    const V lever = V_SET (constant[BEAM_LEVER]), kt = term[0], kn = term[1], kb = term[2];
    V along = (kn - kt) * (vec_dot (dim, b.xi, b.w) * b.inverse), g[3];
    UNROLL for (int c = 0; c < dim; c++) g[c] = kt * b.w[c] + along * b.xi[c], out[c] = g[c];
    if (dim == 2) out[2] = lever * (b.xi[0] * g[1] - b.xi[1] * g[0]) + kb * b.diff[0];
    else {
        V twist = vec_dot (3, b.xi, b.diff) * b.inverse;
        out[3] = lever * (b.xi[1] * g[2] - b.xi[2] * g[1]) + kb * (b.diff[0] - twist * b.xi[0]);
        out[4] = lever * (b.xi[2] * g[0] - b.xi[0] * g[2]) + kb * (b.diff[1] - twist * b.xi[1]);
        out[5] = lever * (b.xi[0] * g[1] - b.xi[1] * g[0]) + kb * (b.diff[2] - twist * b.xi[2]);
    }
    const int sums = dim == 2 ? 3 : 6;
    UNROLL for (int c = 0; c < sums; c++) out[c] = V_KEEP (out[c], live);
}

/* Numbers that energy loops read of both ends: position and unknowns; they sum one number. */
INLINE int beam_store_columns (int dim, int check) { (void) check; return beam_known (dim); }
INLINE int beam_store_sums (int dim) { (void) dim; return 1; }
enum { beam_store_first = 0, beam_store_terms = 3, beam_store_shared = 0 };

/* Twice the energy of the bond, J; 0 in lanes of broken bonds. */
INLINE void beam_store_add (int dim, const V *own, const V *other, const V *term, unsigned live,
                            const double *constant, V *out)
{
    const beam_motion b = beam_move (dim, own, other, constant);
    V s, shear, turn;
    beam_measure (dim, &b, &s, &shear, &turn);
    V stretched = (term[1] * (s * s) + term[0] * shear) * vec_dot (dim, b.xi, b.xi);
    out[0] = V_KEEP (stretched + term[2] * turn, live);
}

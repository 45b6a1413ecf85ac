/* SPDX-License-Identifier: GPL-3.0-or-later
 * Splits: values of the outer coordinate between which the surfaces keep their number and order along the
 * height, so that the integrand of the outer quadrature is smooth there (Saye 2015).
 *
 * Hard splits end intervals of the quadrature: a surface crosses the low or high face of the height, two
 * surfaces meet, or a surface or curve turns back inside the cell. Soft splits mark where heights begin
 * like a square root (a tangent along the height), also somewhat outside the cell, where they still spoil
 * convergence.
 *
 * In a plane slice with coordinates y and z (the height) a surface is a conic a z^2 + B (y) z + C (y) = 0, so
 * that all splits are roots of polynomials in y of degree 4 at most. In 3D the splits along x are points
 * where three quadrics vanish (cut_solve.c), and the splits of the four side faces of the cell. */
#include "cut.h"
#include <math.h>

/* A coefficient below this is zero (coefficients have size 1). */
static const double flat = 1e-13;

/* Local coordinates up to this size count as inside the cell. */
static double near_box (const cut_slices *s) { return 1 + s->equal; }

/* Appends a value. A failed allocation is noted in s->status. */
static void push (cut_slices *s, cut_list *list, double value)
{
    pg_status status = PG_OK;
    PG_GROW (list->at, list->capacity, list->n + 1);
    list->at[list->n++] = value;
done:
    if (status != PG_OK) s->status = status;
}

/* The box of a surface is widened by 1e-7 of the cell, more than the error of any intersection found here. */
int cut_within (const cut_slices *s, size_t i)
{
    for (int k = 0; k < s->dim; k++)
        if (s->at[k] < s->low[3 * i + (size_t) k] - 1e-7 || s->at[k] > s->high[3 * i + (size_t) k] + 1e-7)
            return 0;
    return 1;
}

/* Do the boxes of surfaces i and j have a point in common? */
static int overlap (const cut_slices *s, size_t i, size_t j)
{
    for (size_t k = 0; k < (size_t) s->dim; k++)
        if (s->low[3*i + k] > s->high[3*j + k] + 1e-7 || s->low[3*j + k] > s->high[3*i + k] + 1e-7) return 0;
    return 1;
}

int cut_same_facets (const cut_slices *s, size_t i, size_t j)
{
    return s->facets[i] && s->facets[i] == s->facets[j];
}

/* ---- splits of slices: psi = a z^2 + B (y) z + C (y) --------------------------------------------------- */
/* A surface within a plane slice: a z^2 + (B[0] + B[1] y) z + C[0] + C[1] y + C[2] y^2. */
typedef struct { double a, B[2], C[3]; } conic;

static conic conic_of (const cut_quadric *q, int y, int z)
{
    return (conic) {q->A[z][z], {q->b[z], 2 * q->A[y][z]}, {q->c, q->b[y], q->A[y][y]}};
}

/* B and C at y. */
static double at_B (const conic *p, double y) { return p->B[0] + p->B[1] * y; }
static double at_C (const conic *p, double y) { return p->C[0] + y * (p->C[1] + y * p->C[2]); }

/* Splits where the conic crosses the low and the high face of the height, z = -1 and z = 1. */
static void split_faces (cut_slices *s, cut_level *out, size_t i, const conic *p, int y, int z)
{
    for (int side = -1; side <= 1; side += 2) {
        double c[3] = {p->C[0] + side * p->B[0] + p->a, p->C[1] + side * p->B[1], p->C[2]}, root[2];
        int n = cut_roots (2, c, s->snap, -1, 1, root);
        for (int r = 0; r < n; r++) {
            s->at[y] = root[r], s->at[z] = side;
            if (cut_within (s, i)) push (s, &out->hard, root[r]);
        }
    }
}

/* Splits where the conic is tangent to the height: its discriminant B^2 - 4 a C is zero. They are soft, up
 * to |y| = 3 and |z| = 2, and hard as well inside the cell. */
static void split_turns (cut_slices *s, cut_level *out, const conic *p)
{
    double root[2];
    if (fabs (p->a) < flat) return;
    double D[3] = { p->B[0] * p->B[0] - 4 * p->a * p->C[0], 2 * p->B[0] * p->B[1] - 4 * p->a * p->C[1],
                    p->B[1] * p->B[1] - 4 * p->a * p->C[2] };
    int n = cut_roots (2, D, s->snap, -3 * near_box (s), 3 * near_box (s), root);
    for (int r = 0; r < n; r++) {
        double z = -at_B (p, root[r]) / (2 * p->a);
        if (fabs (z) > 2 * near_box (s)) continue;
        push (s, &out->soft, root[r]);
        if (fabs (root[r]) < 1 && fabs (z) <= near_box (s)) push (s, &out->hard, root[r]);
    }
}

/* u - v, or 0 where that is rounding only. */
static double difference (double u, double v)
{
    return fabs (u - v) <= 1e-14 * (fabs (u) + fabs (v)) ? 0 : u - v;
}

/* The result of `resultant` where both conics are linear in z. */
static int linear_resultant (const conic *p, const conic *q, double *R)
{
    for (int k = 0; k < 4; k++) R[k] = 0;
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < 3; k++) R[i + k] += p->B[i] * q->C[k] - q->B[i] * p->C[k];
    return 3;
}

/* Polynomial R (y) whose roots include all y at which both conics have a z in common; returns its degree.
 * With both linear in z: B_p C_q - B_q C_p. Otherwise z^2 is eliminated first, which leaves B z + C = 0
 * with B = a_p B_q - a_q B_p and C alike, and R = a_p C^2 - B_p B C + C_p B^2. Where B vanishes the conics
 * differ by C alone and every z at its roots is common. */
static int resultant (const conic *p, const conic *q, double *R)
{
    double B[2], C[3], scale = 0;
    if (fabs (p->a) < fabs (q->a)) { const conic *t = p; p = q, q = t; }
    if (fabs (p->a) < flat) return linear_resultant (p, q, R);
    for (int k = 0; k < 2; k++) B[k] = difference (p->a * q->B[k], q->a * p->B[k]);
    for (int k = 0; k < 3; k++) {
        C[k] = difference (p->a * q->C[k], q->a * p->C[k]);
        scale = fmax (scale, fabs (C[k]));
    }
    /* The conics are mirror images about a plane normal to the height: every z is common. */
    if (fabs (B[0]) + fabs (B[1]) <= flat * scale) {
        for (int k = 0; k < 3; k++) R[k] = C[k];
        return 2;
    }
    for (int k = 0; k < 5; k++) R[k] = 0;
    for (int i = 0; i < 3; i++) for (int k = 0; k < 3; k++) R[i + k] += p->a * C[i] * C[k];
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < 2; k++)
            for (int m = 0; m < 3; m++) R[i + k + m] += B[i] * (B[k] * p->C[m] - p->B[k] * C[m]);
    return 4;
}

/* The heights z of conic p at y, within the cell and 1e-6 beyond it. Near a tangent the discriminant may
 * come out slightly negative; the double root counts then. */
static int heights (const cut_slices *s, const conic *p, double y, double *z)
{
    double c[3] = {at_C (p, y), at_B (p, y), p->a};
    int n = cut_roots (2, c, s->rounding, -1 - 1e-6, 1 + 1e-6, z);
    if (n == 0 && fabs (p->a) > flat && fabs (at_B (p, y) / (2 * p->a)) < 1
        && fabs (c[1] * c[1] - 4 * p->a * c[0]) < s->equal)
        /* The discriminant of a tangent may come out slightly negative. */
        z[0] = -c[1] / (2 * p->a), n = 1;
    return n;
}

/* Splits where conics i and j meet: roots of the resultant at which both really vanish at the same height,
 * within the boxes of both surfaces. */
static void split_pair (cut_slices *s, cut_level *out, size_t i, size_t j, const conic *p, const conic *q,
                        int y, int z)
{
    double R[5], root[CUT_DEGREE + 2], at[2];
    int n = cut_roots (resultant (p, q, R), R, s->snap, -1, 1, root);
    for (int r = 0; r < n; r++) {
        int m = heights (s, p, root[r], at), meet = 0;
        for (int k = 0; k < m; k++) {
            s->at[y] = root[r], s->at[z] = at[k];
            meet |= fabs (at_C (q, root[r]) + at[k] * (at_B (q, root[r]) + at[k] * q->a)) < 1e-6
                    && cut_within (s, i) && cut_within (s, j);
        }
        if (meet) push (s, &out->hard, root[r]);
    }
}

/* Do two planes coincide (in local coordinates, to 1e-6)? Collinear edges of a polygon do; only the ends of
 * their boxes tell where one ends and the next begins. */
static int coincide (const cut_quadric *p, const cut_quadric *q)
{
    double plus = fabs (p->c + q->c), minus = fabs (p->c - q->c), size = fabs (p->c);
    for (int i = 0; i < 3; i++) {
        plus += fabs (p->b[i] + q->b[i]), minus += fabs (p->b[i] - q->b[i]), size += fabs (p->b[i]);
        for (int k = 0; k < 3; k++) if (p->A[i][k] != 0 || q->A[i][k] != 0) return 0;
    }
    return fmin (plus, minus) <= 1e-6 * size;
}

/* Splits along x at the ends of the box of a surface that lie inside the cell. */
static void split_box (cut_slices *s, cut_level *out, size_t surface, int x)
{
    double end[2] = { s->low[3 * surface + (size_t) x], s->high[3 * surface + (size_t) x] };
    for (int k = 0; k < 2; k++) if (fabs (end[k]) < 1) push (s, &out->hard, end[k]);
}

/* All splits of a plane slice with outer coordinate y and height z; q: the surfaces restricted to the
 * slice. */
static void split_slice (cut_slices *s, const cut_quadric *surface, cut_level *out, int y, int z)
{
    for (size_t i = 0; i < s->n; i++) {
        if (s->mute[i]) continue;
        conic p = conic_of (&surface[i], y, z);
        split_faces (s, out, i, &p, y, z);
        split_turns (s, out, &p);
        for (size_t j = 0; j < i; j++) {
            if (s->mute[j] || cut_same_facets (s, i, j)) continue;
            conic q = conic_of (&surface[j], y, z);
            if (overlap (s, i, j)) split_pair (s, out, i, j, &p, &q, y, z);
            if (coincide (&surface[i], &surface[j])) split_box (s, out, i, y), split_box (s, out, j, y);
        }
    }
}

/* ---- splits of 3D cells -------------------------------------------------------------------------------- */
/* Where surface q has an extreme value along x inside the cell: d psi / dy = d psi / dz = 0 and psi = 0.
 * The first two are linear and give y and z as linear functions of x, evaluated at x = -1, 0, 1; psi along
 * them is a quadratic polynomial through three values. */
static void split_ends (cut_slices *s, cut_level *out, const cut_quadric *q, int x, int y, int z)
{
    double a = 2 * q->A[y][y], b = 2 * q->A[y][z], c = 2 * q->A[z][z], det = a * c - b * b, v[3], root[2];
    if (fabs (det) < 1e-9 * (a * a + 2 * b * b + c * c) || det == 0) return;
    double at[3][3] = {{0}};
    for (int i = 0; i < 3; i++) {
        double f = -q->b[y] - 2 * q->A[x][y] * (i - 1), g = -q->b[z] - 2 * q->A[x][z] * (i - 1);
        at[i][x] = i - 1, at[i][y] = (c * f - b * g) / det, at[i][z] = (a * g - b * f) / det;
        v[i] = cut_value (q, at[i]);
    }
    double poly[3] = {v[1], 0.5 * (v[2] - v[0]), 0.5 * (v[2] + v[0]) - v[1]};
    int n = cut_roots (2, poly, s->snap, -3 * near_box (s), 3 * near_box (s), root);
    for (int r = 0; r < n; r++) {
        double Y = at[1][y] + root[r] * (at[2][y] - at[1][y]), Z = at[1][z] + root[r] * (at[2][z] - at[1][z]);
        if (fabs (Y) > 2 * near_box (s) || fabs (Z) > 2 * near_box (s)) continue;
        push (s, &out->soft, root[r]);
        if (fabs (root[r]) < 1 && fabs (Y) <= near_box (s) && fabs (Z) <= near_box (s))
            push (s, &out->hard, root[r]);
    }
}

/* Splits along x at the points where the three quadrics vanish: number 3: three surfaces meet; number 2:
 * the third quadric is the Jacobian of the first two, and the curve of their intersection has an extreme
 * value along x (soft as well). which: the `number` surfaces whose boxes must hold the point. */
static void split_points (cut_slices *s, cut_level *out, const cut_quadric *three, const size_t *which,
                          int number, int x)
{
    double at[3 * CUT_MEETINGS];
    int given_up, n = cut_solve (three, number == 2 ? 1.6 : 1, at, &given_up);
    s->given_up += (size_t) given_up;
    for (int r = 0; r < n; r++) {
        int in = 1;
        for (int k = 0; k < 3; k++) s->at[k] = at[3*r + k], in &= fabs (at[3*r + k]) <= near_box (s);
        if (number == 2) push (s, &out->soft, at[3*r + x]);
        for (int k = 0; k < number; k++) in &= cut_within (s, which[k]);
        if (in) push (s, &out->hard, at[3*r + x]);
    }
}

/* p_y q_z - p_z q_y, a quadric again as the gradients are linear: where it vanishes on the curve p = q = 0,
 * the tangent of the curve has no component along x. */
static cut_quadric jacobian (const cut_quadric *p, const cut_quadric *q, int y, int z)
{
    cut_quadric J = {{{0}}, {0}, 0};
    const cut_quadric *f[2] = {p, q};
    for (int t = 0; t < 2; t++) {
        const cut_quadric *u = f[t], *v = f[1 - t];
        double sign = t ? -1 : 1;
        J.c += sign * u->b[y] * v->b[z];
        for (int i = 0; i < 3; i++) {
            J.b[i] += sign * 2 * (u->A[y][i] * v->b[z] + u->b[y] * v->A[z][i]);
            for (int k = 0; k < 3; k++)
                J.A[i][k] += sign * 2 * (u->A[y][i] * v->A[z][k] + u->A[y][k] * v->A[z][i]);
        }
    }
    return J;
}

/* Is the surface a plane? */
static int straight (const cut_quadric *q)
{
    double size = 0;
    for (int i = 0; i < 9; i++) size = fmax (size, fabs (q->A[i / 3][i % 3]));
    return size == 0;
}

/* Splits of the four side faces of the box, those that lie along x: on each the surfaces are curves in a
 * plane. */
static void split_box_faces (cut_slices *s, const cut_quadric *q, cut_level *out)
{
    int x = s->axis[0], y = s->axis[1], z = s->axis[2];
    /* The next level's array is unused until the recursion descends into it. */
    cut_quadric *face = s->level[1].q;
    for (int f = 0; f < 4; f++) {
        int across = f < 2 ? z : y, along = f < 2 ? y : z;
        s->at[across] = f % 2 ? 1 : -1;
        for (size_t i = 0; i < s->n; i++) face[i] = q[i], cut_restrict (&face[i], across, f % 2 ? 1 : -1);
        split_slice (s, face, out, x, along);
        s->at[across] = f % 2 ? 1 : -1;
    }
}

/* All splits of a cell along x: extreme values of surfaces and of curves of two (two planes meet in a line,
 * which has none), corners of three, and the splits of the four side faces, each a plane slice. */
static void split_solid (cut_slices *s, const cut_quadric *q, cut_level *out)
{
    int x = s->axis[0], y = s->axis[1], z = s->axis[2];
    for (size_t i = 0; i < s->n; i++) {
        if (s->mute[i]) continue;
        split_ends (s, out, &q[i], x, y, z);
        for (size_t j = 0; j < i; j++) {
            if (s->mute[j] || !overlap (s, i, j)) continue;
            if (!straight (&q[i]) || !straight (&q[j]))
                split_points (s, out, (cut_quadric[]){ q[i], q[j], jacobian (&q[i], &q[j], y, z) },
                              (size_t[]){ i, j }, 2, x);
            for (size_t k = 0; k < j; k++)
                if (!s->mute[k] && overlap (s, i, k) && overlap (s, j, k) && !cut_same_facets (s, i, j)
                    && !cut_same_facets (s, i, k) && !cut_same_facets (s, j, k))
                    split_points (s, out, (cut_quadric[]){ q[i], q[j], q[k] }, (size_t[]){ i, j, k }, 3, x);
        }
    }
    split_box_faces (s, q, out);
}

/* ---- splits at edges of regions ------------------------------------------------------------------------ */
/* Sets x to the point of the edge at which coordinate k is `at`; 0: the edge has none. */
static int edge_at (const double *edge, int k, double at, double *x)
{
    double way = edge[3 + k] - edge[k], t = (at - edge[k]) / way;
    if (!(fabs (way) > 1e-12) || !(t >= -1e-12 && t <= 1 + 1e-12)) return 0;
    for (int a = 0; a < 3; a++) x[a] = edge[a] + t * (edge[3 + a] - edge[a]);
    return 1;
}

/* Adds a split along axis `along` at x if x lies in the cell. Coordinate `free` of x is not checked (-1: all
 * are). */
static void push_place (cut_slices *s, cut_list *hard, const double *x, int along, int free)
{
    for (int k = 0; k < s->dim; k++)
        if (k != along && k != free && fabs (x[k]) > near_box (s)) return;
    if (fabs (x[along]) < 1) push (s, hard, x[along]);
}

/* Splits along `along` at the ends of an edge and where it leaves the cell through a face normal to one of
 * the other axes; `fixed` is the axis of the present slice, in which the edge lies, or -1. */
static void split_edge (cut_slices *s, cut_list *hard, const double *edge, int along, int fixed)
{
    double x[3];
    for (int end = 0; end < 2; end++) push_place (s, hard, edge + 3 * end, along, fixed);
    for (int k = 0; k < 3; k++)
        for (int side = -1; k != along && k != fixed && side <= 1; side += 2)
            if (edge_at (edge, k, side, x)) push_place (s, hard, x, along, fixed);
}

/* Splits where other surfaces cross an edge of a region: along it their quadric is a quadratic polynomial. */
static void split_edge_crossings (cut_slices *s, cut_list *hard, const double *edge, size_t of, int along)
{
    for (size_t i = 0; i < s->n; i++) {
        double v[3], root[2], x[3];
        if (s->mute[i] || i == of || cut_same_facets (s, i, of)) continue;
        for (int e = 0; e < 3; e++) {
            for (int k = 0; k < 3; k++) x[k] = edge[k] + 0.5 * e * (edge[3 + k] - edge[k]);
            v[e] = cut_value (&s->level[0].q[i], x);
        }
        double poly[3] = { v[0], 4 * v[1] - 3 * v[0] - v[2], 2 * (v[0] + v[2]) - 4 * v[1] };
        int n = cut_roots (2, poly, s->snap, -s->equal, 1 + s->equal, root);
        for (int r = 0; r < n; r++) {
            for (int k = 0; k < 3; k++) s->at[k] = x[k] = edge[k] + root[r] * (edge[3 + k] - edge[k]);
            if (cut_within (s, i)) push_place (s, hard, x, along, -1);
        }
    }
}

/* Splits at the edges of regions of pg_facets, which end there and nowhere else: along the outermost axis for
 * the whole cell (level 0), then within the slice. */
static void split_edges (cut_slices *s, int level, cut_list *hard)
{
    int along = s->axis[level];
    for (size_t e = 0; e < s->nedge; e++) {
        const double *edge = s->edge + 6 * e;
        double x[3];
        int fixed = s->axis[0];
        if (s->mute[s->edge_of[e]]) continue;
        if (s->dim == 2) push_place (s, hard, edge, along, -1);
        else if (level == 0) {
            split_edge (s, hard, edge, along, -1);
            split_edge_crossings (s, hard, edge, (size_t) s->edge_of[e], along);
        }
        else if (fabs (edge[fixed] - s->at[fixed]) < s->equal
                 && fabs (edge[3 + fixed] - s->at[fixed]) < s->equal)
            split_edge (s, hard, edge, along, fixed);
        else if (edge_at (edge, fixed, s->at[fixed], x)) push_place (s, hard, x, along, fixed);
    }
}

/* Splits at planes normal to the axis of this level, also where they do not bound the body. */
static void split_square (cut_slices *s, int level, cut_list *hard)
{
    int along = s->axis[level];
    for (size_t i = 0; i < s->n; i++) {
        double c = s->level[0].q[i].c, b = s->level[0].q[i].b[along];
        if (!s->mute[i] && b != 0 && fabs (c) < fabs (b)) push (s, hard, -c / b);
    }
}

void cut_split (cut_slices *s, int k)
{
    cut_level *out = &s->level[k];
    out->hard.n = out->soft.n = 0;
    if (k == s->dim - 2) split_slice (s, out->q, out, s->axis[k], s->axis[k + 1]);
    else split_solid (s, out->q, out);
    split_edges (s, k, &out->hard);
    if (s->square) split_square (s, k, &out->hard);
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * Finite elements on the nodes of the Galerkin form, whose energies are about those of K (linalg.h,
 * pg_elements): the preconditioner of iterative solvers.
 *
 * A cell whose evaluation points have intact bonds to all its corners is an element: isoparametric, of the
 * mesh's own kind, or the bilinear or trilinear one of a lattice, with its nodes at the nodes' actual
 * positions. Where a crack separates corners, where the surface cuts the cell, or where there is no cell at
 * all, each evaluation point p becomes an element of its own over the m nearest nodes to which its bonds are
 * intact. With c their mean position and h the local spacing, the gradient is that of the best linear field
 * (least squares),
 *
 *    q_a = A^-1 (x_a - c),   A = sum_a (x_a - c)(x_a - c)' + 0.02 h^2 I,   du/dx = sum_a u_a q_a',
 *
 * and the deviation from that field, R u with R_ab = delta_ab - 1/m - (x_a - c) . q_b, has the stiffness
 *
 *    K_p = w (B' D B + 8 mu / (h^2 m) R' R (x) I),
 *
 * so that every node with an intact bond has a stiffness: if cut elements were merely left out, nodes beside
 * a crack would have none. Supports: Nitsche's factor k holds the displacement at a facet point, sum_a phi_a
 * u_a of nearby nodes, with the springs k phi_a phi_b; penalties are springs at their node. */
#include "galerkin_elements.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* deviation: stiffness of deviations from a linear field, in units of mu / (h^2 m); free_deviation: the same
 * where nodes are evaluation points without stabilisation, whose K hardly resists displacements that
 * alternate from node to node. least_spread: least spread of the nodes of a point, in units of h^2. */
static const double deviation = 8, free_deviation = 2, least_spread = 0.02;
/* Least spread of the nodes of a tetrahedron, in units of the h^2 of its own nodes. */
static const double soft_tetrahedron = 0.4;
/* The weights of a facet point's nodes vanish at this many times the squared distance of the farthest
 * node. */
static const double beyond = 1.2;

/* ---- matrices of elements ------------------------------------------------------------------------------ */
/* K += w B' D B for gradients q (m x dim) of the m nodes, blocks on and above the diagonal. */
static void add_strain (const galerkin *g, size_t m, const double *q, const double *D, double w, double *K)
{
    size_t dim = (size_t) g->dim, nv = (size_t) g->nv, width = m * dim;
    for (size_t a = 0; a < m; a++) {
        double DB[18], unit[3], B[6], f[3];
        /* column r of D B_a */
        for (size_t r = 0; r < dim; r++) {
            memset (B, 0, sizeof B);
            for (size_t v = 0; v < nv; v++) {
                double one[6] = { 0 };
                one[v] = 1;
                galerkin_B_transpose (g->dim, q + a * dim, one, unit);
                B[v] = unit[r];
            }
            for (size_t v = 0; v < nv; v++) {
                double s = 0;
                for (size_t u = 0; u < nv; u++) s += D[u * nv + v] * B[u];
                DB[r * nv + v] = w * s;
            }
        }
        for (size_t b = a; b < m; b++)
            for (size_t r = 0; r < dim; r++) {
                galerkin_B_transpose (g->dim, q + b * dim, DB + r * nv, f);
                for (size_t c = 0; c < dim; c++) K[(a * dim + r) * width + b * dim + c] += f[c];
            }
    }
}

/* Copies the upper triangle to the lower one, bit by bit. */
static void mirror (size_t width, double *K)
{
    for (size_t i = 0; i < width; i++)
        for (size_t j = 0; j < i; j++) K[i * width + j] = K[j * width + i];
}

/* Gradients q of the shape functions of an element at xi, 1/m (nodes x dim); returns the determinant of the
 * Jacobian. */
static double gradients (const galerkin *g, pg_element kind, const int *node, const double *xi, double *q)
{
    size_t dim = (size_t) g->dim, m = (size_t) pg_element_types[kind].nodes;
    double N[PG_ELEMENT_NODES], dN[PG_ELEMENT_NODES * 3], J[9] = { 0 }, I[9], size;
    pg_element_shape (kind, xi, N, dN);
    for (size_t a = 0; a < m; a++)
        for (size_t r = 0; r < dim; r++)
            for (size_t c = 0; c < dim; c++) J[r * dim + c] += dN[a * dim + r] * place (g, node[a])[c];
    if (dim == 1) size = J[0], I[0] = 1 / size;
    else if (dim == 2) {
        size = J[0] * J[3] - J[1] * J[2];
        I[0] = J[3] / size, I[1] = -J[1] / size, I[2] = -J[2] / size, I[3] = J[0] / size;
    } else {
        for (size_t r = 0; r < 3; r++)
            for (size_t c = 0; c < 3; c++) {
                size_t r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
                I[c * 3 + r] = J[r1 * 3 + c1] * J[r2 * 3 + c2] - J[r1 * 3 + c2] * J[r2 * 3 + c1];
            }
        size = J[0] * I[0] + J[1] * I[3] + J[2] * I[6];
        for (size_t k = 0; k < 9; k++) I[k] /= size;
    }
    for (size_t a = 0; a < m; a++)
        for (size_t c = 0; c < dim; c++) {
            q[a * dim + c] = 0;
            for (size_t r = 0; r < dim; r++) q[a * dim + c] += I[c * dim + r] * dN[a * dim + r];
        }
    return size;
}

/* Is this cell of the same shape, kind and material as the last one? Then its matrix is the same. */
static int same_as_last (element_list *b, int kind, const pg_material *material, size_t m, const int *node)
{
    size_t dim = (size_t) b->g->dim;
    double shape[MOST_NODES * 3], least = 1e-10 * b->g->problem->cloud.h;
    int same = b->shape_kind == kind && b->shape_material == material;
    for (size_t k = 0; k < m; k++)
        for (size_t c = 0; c < dim; c++) {
            shape[k * dim + c] = place (b->g, node[k])[c] - place (b->g, node[0])[c];
            same = same && fabs (shape[k * dim + c] - b->shape[k * dim + c]) <= least;
        }
    if (!same) memcpy (b->shape, shape, m * dim * sizeof *shape), b->shape_kind = kind, b->shape_material =
            material;
    return same;
}

/* Returns the matrix of the last cell times a share. */
static const double *scaled (element_list *b, size_t width, double share)
{
    if (share == 1) return b->last;
    for (size_t k = 0; k < width * width; k++) b->K[k] = share * b->last[k];
    return b->K;
}

/* lambda of point p, Pa, where the dilatation is projected; else 0, since D of the material contains it. */
static double projected_lambda (const element_list *b, size_t p)
{
    return b->g->dilatation ? b->g->problem->form.patches->lambda[b->g->material[b->set][p]] : 0;
}

/* Adds the volumetric stiffness where the dilatation is projected. K has it as means over patches, which the
 * elements cannot follow: with all of lambda on the mean of each element they lock (1854 iterations at a
 * Poisson's ratio of 0.49). With at most mu of it, mu V b b', b the mean of the gradients, iterations are
 * fewest (140; without 153). */
static void add_dilatation (element_list *b, size_t p, size_t width, int n, const double *xi,
                            const double *weight, int kind, const int *node)
{
    const galerkin *g = b->g;
    double q[PG_ELEMENT_NODES * 3], mean[PG_ELEMENT_NODES * 3] = { 0 }, volume = 0,
           lambda = fmin (projected_lambda (b, p), galerkin_plain (g, b->set, p)->mu);
    for (int k = 0; k < n && lambda > 0; k++) {
        double w = fabs (gradients (g, (pg_element) kind, node, xi + k * g->dim, q)) * weight[k]
                   * g->problem->cells.thickness;
        volume += w;
        for (size_t i = 0; i < width; i++) mean[i] += w * q[i];
    }
    for (size_t i = 0; i < width && lambda > 0; i++)
        for (size_t j = i; j < width; j++) b->last[i * width + j] += lambda / volume * mean[i] * mean[j];
}

/* Stiffness of a whole cell, of the material of point p. Where nodes were moved so far that the Jacobian
 * determinant is negative, its absolute value counts. */
static const double *cell_matrix (element_list *b, double share, int kind, size_t m, const int *node,
                                  size_t p)
{
    const galerkin *g = b->g;
    const pg_material *material = galerkin_plain (g, b->set, p);
    size_t dim = (size_t) g->dim, width = m * dim;
    double xi[3 * PG_ELEMENT_POINTS], weight[PG_ELEMENT_POINTS], q[PG_ELEMENT_NODES * 3];
    if (same_as_last (b, kind, material, m, node)) return scaled (b, width, share);
    memset (b->last, 0, width * width * sizeof *b->last);
    int n = pg_element_rule ((pg_element) kind, pg_element_types[kind].order == 1 ? 2 : 3, xi, weight);
    for (int k = 0; k < n; k++) {
        double size = gradients (g, (pg_element) kind, node, xi + (size_t) k * dim, q);
        add_strain (g, m, q, material->D, fabs (size) * weight[k] * g->problem->cells.thickness, b->last);
    }
    add_dilatation (b, p, width, n, xi, weight, kind, node);
    mirror (width, b->last);
    return scaled (b, width, share);
}

/* Stiffness of deviations: lower for nodes without stabilisation, whose K hardly resists alternating
 * displacements. */
static double resistance (const element_list *b)
{
    return b->set == PG_NODES && !(b->g->options->silling > 0) ? free_deviation : deviation;
}

static double product (size_t n, const double *a, const double *b)
{
    double s = 0;
    for (size_t k = 0; k < n; k++) s += a[k] * b[k];
    return s;
}

/* z (m x dim): displacements of m nodes in a unit rotation about axis r through c. */
static void turn (const galerkin *g, size_t m, const int *node, const double *c, size_t r, double *z)
{
    size_t dim = (size_t) g->dim, i = dim == 3 ? (r + 1) % 3 : 0, j = dim == 3 ? (r + 2) % 3 : 1;
    memset (z, 0, m * dim * sizeof *z);
    for (size_t a = 0; a < m; a++) {
        z[a * dim + i] = c[j] - place (g, node[a])[j];
        z[a * dim + j] = place (g, node[a])[i] - c[i];
    }
}

/* Removes the rotations about c from K: P K P, where P projects them off, one after the other. */
static void take_off_rotations (const galerkin *g, size_t m, const int *node, const double *c, double *K)
{
    size_t width = m * (size_t) g->dim, axes = g->dim == 3 ? 3 : g->dim == 2;
    double z[3][3 * MOST_NODES], Kz[3 * MOST_NODES];
    for (size_t r = 0; r < axes; r++) {
        turn (g, m, node, c, r, z[r]);
        double whole = product (width, z[r], z[r]);
        for (size_t o = 0; o < r; o++) {
            double s = product (width, z[r], z[o]);
            for (size_t k = 0; k < width; k++) z[r][k] -= s * z[o][k];
        }
        double rest = product (width, z[r], z[r]);
        /* nodes on a line do not move when they turn about it */
        double unit = rest > 1e-9 * whole ? 1 / sqrt (rest) : 0;
        for (size_t k = 0; k < width; k++) z[r][k] *= unit;
        for (size_t k = 0; k < width; k++) Kz[k] = product (width, K + k * width, z[r]);
        double energy = product (width, Kz, z[r]);
        for (size_t k = 0; k < width; k++)
            for (size_t l = k; l < width; l++)
                K[k * width + l] += energy * z[r][k] * z[r][l] - Kz[k] * z[r][l] - z[r][k] * Kz[l];
        mirror (width, K);
    }
}

/* The best linear field of m nodes: mean position c and gradients q (m x dim). The least spread added to A is
 * soft * h2; h2: squared spacing, m^2; 0: is set to that of the nodes themselves. */
static void fit_gradient (const galerkin *g, size_t m, const int *node, double soft, double *h2, double *c,
                          double *q)
{
    size_t dim = (size_t) g->dim;
    double A[9] = { 0 }, spread = 0;
    memset (c, 0, 3 * sizeof *c);
    for (size_t a = 0; a < m; a++)
        for (size_t k = 0; k < dim; k++) c[k] += place (g, node[a])[k] / (double) m;
    for (size_t a = 0; a < m; a++)
        for (size_t k = 0; k < dim; k++)
            for (size_t l = 0; l < dim; l++)
                A[k * dim + l] += (place (g, node[a])[k] - c[k]) * (place (g, node[a])[l] - c[l]);
    for (size_t k = 0; k < dim; k++) spread += A[k * dim + k];
    /* in a regular simplex the spread along each axis is half the squared edge */
    if (!(*h2 > 0)) *h2 = 2 * spread / (double) dim;
    for (size_t k = 0; k < dim; k++) A[k * dim + k] += soft * *h2;
    pg_dense_cholesky ((int) dim, A, 0);
    for (size_t a = 0; a < m; a++) {
        for (size_t k = 0; k < dim; k++) q[a * dim + k] = place (g, node[a])[k] - c[k];
        pg_dense_solve ((int) dim, A, q + a * dim);
    }
}

/* K += stiffness R'R (x) I of the deviation from the linear field, blocks on and above the diagonal. */
static void add_rest (const galerkin *g, size_t m, const int *node, const double *c, const double *q,
                      double stiffness, double *K)
{
    size_t dim = (size_t) g->dim, width = m * dim;
    double R[MOST_NODES * MOST_NODES];
    for (size_t a = 0; a < m; a++)
        for (size_t e = 0; e < m; e++) {
            R[a * m + e] = (a == e) - 1 / (double) m;
            for (size_t k = 0; k < dim; k++) R[a * m + e] -= (place (g, node[a])[k] - c[k]) * q[e * dim + k];
        }
    for (size_t a = 0; a < m; a++)
        for (size_t e = a; e < m; e++) {
            double s = 0;
            for (size_t k = 0; k < m; k++) s += R[k * m + a] * R[k * m + e];
            s *= stiffness;
            for (size_t k = 0; k < dim; k++) K[(a * dim + k) * width + e * dim + k] += s;
        }
}

/* Stiffness, N/m, of the element of evaluation point p with weight w and m nodes. */
static const double *point_matrix (element_list *b, size_t p, double w, size_t m, const int *node)
{
    const galerkin *g = b->g;
    const pg_material *material = galerkin_plain (g, b->set, p);
    size_t width = m * (size_t) g->dim;
    double c[3], q[MOST_NODES * 3], h = pg_problem_spacing (g->problem, b->set, p), h2 = h * h;
    fit_gradient (g, m, node, least_spread, &h2, c, q);
    memset (b->K, 0, width * width * sizeof *b->K);
    add_strain (g, m, q, material->D, w, b->K);
    add_rest (g, m, node, c, q, w * resistance (b) * material->mu / (h2 * (double) m), b->K);
    mirror (width, b->K);
    return b->K;
}

/* Stiffness of a tetrahedron of the material of point p. The exact gradient of flat tetrahedra is far stiffer
 * than shape functions of a wide support are for the same displacements. So the gradient is that of a field
 * fitted with a large least spread, and deviations from it resist, but for rotations, which have no energy.
 * Anisotropic supports, stretched as the elements are, resolve steep gradients across them: there the exact
 * gradient is used. */
static const double *tetrahedron_matrix (element_list *b, size_t p, const int *node)
{
    const galerkin *g = b->g;
    const pg_material *material = galerkin_plain (g, b->set, p);
    const double *x = place (g, node[0]);
    double a[9], c[3], q[12], h2 = 0, soft = g->problem->cloud.metric ? 0 : soft_tetrahedron,
           lambda = fmin (projected_lambda (b, p), 3 * material->mu);
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 3; i++) a[3 * k + i] = place (g, node[k + 1])[i] - x[i];
    double w = fabs (a[0] * (a[4] * a[8] - a[5] * a[7]) - a[1] * (a[3] * a[8] - a[5] * a[6])
                     + a[2] * (a[3] * a[7] - a[4] * a[6])) / 6;
    memset (b->K, 0, 144 * sizeof *b->K);
    fit_gradient (g, 4, node, soft, &h2, c, q);
    add_strain (g, 4, q, material->D, w, b->K);
    for (size_t i = 0; i < 12; i++)
        for (size_t j = i; j < 12; j++) b->K[i * 12 + j] += w * lambda * q[i] * q[j];
    add_rest (g, 4, node, c, q, w * deviation * material->mu / (h2 * 4), b->K);
    mirror (12, b->K);
    if (soft > 0) take_off_rotations (g, 4, node, c, b->K);
    return b->K;
}

/* phi (m): weights of m nodes for the displacement at facet point p, by a moving least squares fit of a
 * linear field. With w_a = (1 - d_a^2 / R^2)^2, W their sum, c the weighted mean of the positions and A the
 * weighted spread about it, phi_a = w_a (1 / W + (x - c) . A^-1 (x_a - c)). */
static void facet_shape (const galerkin *g, size_t p, size_t m, const int *node, double *phi)
{
    size_t dim = (size_t) g->dim;
    const double *x = g->rows[PG_FACETS].x + p * dim;
    double c[3] = { 0 }, A[9] = { 0 }, w[MOST_NODES], sum = 0, far = 0,
           h = pg_problem_spacing (g->problem, PG_FACETS, p);
    for (size_t a = 0; a < m; a++) far = fmax (far, pg_distance2 (g->dim, x, place (g, node[a])));
    for (size_t a = 0; a < m; a++) {
        double left = far > 0 ? 1 - pg_distance2 (g->dim, x, place (g, node[a])) / (beyond * far) : 1;
        sum += w[a] = left * left;
    }
    for (size_t a = 0; a < m; a++)
        for (size_t k = 0; k < dim; k++) c[k] += w[a] / sum * place (g, node[a])[k];
    for (size_t a = 0; a < m; a++)
        for (size_t k = 0; k < dim; k++)
            for (size_t l = 0; l < dim; l++)
                A[k * dim + l] += w[a] * (place (g, node[a])[k] - c[k]) * (place (g, node[a])[l] - c[l]);
    for (size_t k = 0; k < dim; k++) A[k * dim + k] += least_spread * sum * h * h;
    pg_dense_cholesky ((int) dim, A, 0);
    for (size_t a = 0; a < m; a++) {
        double q[3];
        for (size_t k = 0; k < dim; k++) q[k] = place (g, node[a])[k] - c[k];
        pg_dense_solve ((int) dim, A, q);
        phi[a] = 1 / sum;
        for (size_t k = 0; k < dim; k++) phi[a] += (x[k] - c[k]) * q[k];
        phi[a] *= w[a];
    }
}

/* Matrix of the springs that constrain facet point p. Where all nodes lie behind the facet, the material
 * between it and the nearest of them (in depth) yields as well: springs in series. */
static const double *spring_matrix (element_list *b, size_t p, size_t m, const int *node)
{
    const galerkin *g = b->g;
    const pg_rows *r = &g->rows[PG_FACETS];
    size_t dim = (size_t) g->dim, width = m * dim;
    const double *normal = g->problem->bonds.facet_normal + p * dim;
    double phi[MOST_NODES], depth = INFINITY, between = galerkin_plain (g, PG_FACETS, p)->D[0] * r->weight[p];
    facet_shape (g, p, m, node, phi);
    for (size_t a = 0; a < m; a++) {
        double behind = 0;
        for (size_t k = 0; k < dim; k++) behind += (r->x[p * dim + k] - place (g, node[a])[k]) * normal[k];
        depth = fmin (depth, fmax (0, behind));
    }
    memset (b->K, 0, width * width * sizeof *b->K);
    for (size_t i = g->supports.nitsche_start[p]; i < g->supports.nitsche_start[p + 1]; i++) {
        size_t k = (size_t) g->supports.nitsche[i].component;
        double s = galerkin_nitsche_stiffness (g, &g->supports.nitsche[i]);
        s /= 1 + s * depth / between;
        for (size_t a = 0; a < m; a++)
            for (size_t e = 0; e < m; e++) b->K[(a * dim + k) * width + e * dim + k] = s * phi[a] * phi[e];
    }
    return b->K;
}

/* An evaluation point of each cell, for its material; of a box its first node. *at: the point found last. */
static size_t point_of (const element_list *b, size_t cell, size_t *at)
{
    const pg_rows *r = &b->g->rows[b->g->bulk];
    if (b->set == PG_NODES) return cell;
    while (*at + 1 < r->n && (size_t) r->cell[*at] < cell) ++*at;
    return *at;
}

/* Matrix of element k; *at advances with the cells, which are in ascending order. */
static const double *matrix_of (element_list *b, size_t k, size_t *at)
{
    size_t m = b->list.start[k + 1] - b->list.start[k];
    const int *node = b->list.node + b->list.start[k];
    if (b->cell[k] == SPRINGS) return spring_matrix (b, b->of[k], m, node);
    if (b->cell[k] == NO_CELL) return point_matrix (b, b->of[k], b->weight[k], m, node);
    if (b->cell[k] == PG_TET4) return tetrahedron_matrix (b, point_of (b, b->of[k], at), node);
    return cell_matrix (b, b->weight[k], b->cell[k], m, node, point_of (b, b->of[k], at));
}

/* Sums up the matrices of all elements in Q. */
static pg_status add_elements (element_list *b, pg_block_matrix *Q)
{
    pg_status status = PG_OK;
    size_t most = 0, at = 0;
    for (size_t k = 0; k < b->list.n; k++)
        if (b->list.start[k + 1] - b->list.start[k] > most) most = b->list.start[k + 1] - b->list.start[k];
    most *= (size_t) b->g->dim;
    PG_ALLOC (b->K, most * most);
    PG_ALLOC (b->last, most * most);
    b->shape_kind = NO_CELL;
    for (size_t k = 0; k < b->list.n; k++)
        pg_block_add (Q, b->list.start[k + 1] - b->list.start[k], b->list.node + b->list.start[k],
                      matrix_of (b, k, &at));
done:
    return status;
}

/* ---- supports ------------------------------------------------------------------------------------------ */
/* Is the penalty so much above E / h that springs of the elements would not do? The polynomial in N is not
 * exact, and its error in the displacement of the node would be multiplied by the penalty. */
int elements_stiff (const galerkin *g, const constraint *q)
{
    return g->problem->boundary.load[q->load].penalty > 30;
}

/* W: for each stiff penalty a column with the shape functions at its node. */
static pg_status list_stiff (const galerkin *g, pg_elements *out)
{
    pg_status status = PG_OK;
    const pg_rows *r = &g->rows[PG_NODES];
    size_t dim = (size_t) g->dim, n = 0, nnz = 0;
    for (size_t i = 0; i < g->supports.npenalty; i++) {
        size_t node = (size_t) g->supports.penalty_node[g->supports.penalty[i].point];
        if (!elements_stiff (g, &g->supports.penalty[i]) || r->grade[node] >= PG_GRADE_DEAD) continue;
        n++, nnz += r->family.start[node + 1] - r->family.start[node];
    }
    if (n == 0) return PG_OK;
    PG_TRY (pg_sparse_create (&out->W, g->n * dim, n, nnz, 0));
    PG_ALLOC (out->held, n);
    PG_ALLOC (out->holds, n);
    size_t at = 0, c = 0;
    for (size_t i = 0; i < g->supports.npenalty; i++) {
        const constraint *q = &g->supports.penalty[i];
        size_t node = (size_t) g->supports.penalty_node[q->point], k = (size_t) q->component;
        if (!elements_stiff (g, q) || r->grade[node] >= PG_GRADE_DEAD) continue;
        for (size_t e = r->family.start[node]; e < r->family.start[node + 1]; e++, at++)
            out->W.row[at] = (long) ((size_t) r->family.node[e] * dim + k),
            out->W.value[at] = r->N[e + pg_rows_offset (r, node)];
        out->held[c] = galerkin_penalty_stiffness (g, q), out->holds[c] = node * dim + k;
        out->W.start[++c] = (long) at;
    }
done:
    return status;
}

/* Adds the springs of nodes under a penalty that is not stiff. */
static void add_penalties (const galerkin *g, pg_block_matrix *Q)
{
    size_t dim = (size_t) g->dim;
    for (size_t i = 0; i < g->supports.npenalty; i++) {
        const constraint *q = &g->supports.penalty[i];
        if (elements_stiff (g, q)) continue;
        pg_block_add_diagonal (Q, (size_t) g->supports.penalty_node[q->point] * dim + (size_t) q->component,
                               galerkin_penalty_stiffness (g, q));
    }
}

/* Horizon in units of the spacing that a lattice with the same density of points would have: on meshes, whose
 * spacing is the mean length of edges, more than in units of that. The lower quartile over all points, as
 * points on the surface have only part of a volume. */
static pg_status width_of_supports (const pg_problem *p, double *width)
{
    pg_status status = PG_OK;
    const pg_cloud *c = &p->cloud;
    double *all = NULL;
    PG_ALLOC (all, c->n);
    for (size_t i = 0; i < c->n; i++)
        all[i] = p->form.approx.horizon * pg_cloud_ratio (c, i)
                 / pow (c->volume[i] / c->thickness, 1.0 / c->dim);
    pg_sort (all, c->n, sizeof *all, pg_ascending_numbers);
    *width = all[c->n / 4];
    PG_TRY (pg_cloud_most (c, 1, width));   /* largest over all ranks, which use one polynomial */
done:
    pg_free (all);
    return status;
}

/* Chooses the polynomial in N. The wider the support, the nearer to 0 N is for displacements that alternate
 * from node to node, and the more terms the polynomial needs; a term costs a twentieth of K x or less. The
 * choices gave the fewest iterations on cubes of 5 000 points. The last one: for tetrahedra, which at a
 * horizon of 2 edges have as many neighbours as points of a lattice at 2.4 spacings. */
static pg_status choose_polynomial (const pg_problem *p, pg_elements *out)
{
    static const struct { int order; double wide; int terms; double low, floor; } choice[] = {
        { 1, 1.6, 4, 0.1, 0 }, { 1, 2.2, 8, 0.03, 0.06 }, { 1, 1e9, 32, 0.01, 0 },
        { 2, 2.7, 12, 0.02, 0.03 }, { 2, 1e9, 16, 0.01, 0 }, { 1, 2.6, 16, 0.01, 0.02 }
    };
    enum { IRREGULAR = sizeof choice / sizeof *choice - 1 };
    pg_status status = PG_OK;
    double width = p->form.approx.horizon / p->cloud.h;
    size_t k = 0;
    while (choice[k].order != p->form.approx.order || width > choice[k].wide) k++;
    if (p->form.approx.order == 1 && !p->lattice.dim && !p->cloud.metric) {
        PG_TRY (width_of_supports (p, &width));
        if (width > choice[1].wide && width <= choice[IRREGULAR].wide) k = IRREGULAR;
    }
    out->terms = choice[k].terms, out->low = choice[k].low, out->floor = choice[k].floor;
    out->high = 1.1;
done:
    return status;
}

static void element_list_clear (element_list *b)
{
    pg_free (b->list.start), pg_free (b->list.node), pg_free (b->of), pg_free (b->cell), pg_free (b->weight);
    pg_free (b->K), pg_free (b->last);
}

/* Makes the elements for the bonds that were intact at the last refresh. */
pg_status galerkin_elements (void *self, pg_elements *out)
{
    pg_status status = PG_OK;
    galerkin *g = self;
    element_list b = { .g = g, .set = g->bulk };
    memset (out, 0, sizeof *out);
    PG_TRY (list_stiff (g, out));
    if (galerkin_takes_hats (g)) {
        PG_TRY (galerkin_hats (g, out));
        goto done;
    }
    PG_TRY (elements_find (&b));
    PG_TRY (pg_block_create (&out->Q, g->n, g->dim, &b.list, g->threads));
    PG_TRY (add_elements (&b, &out->Q));
    add_penalties (g, &out->Q);
    if (!g->problem->form.approx.type->interpolates) PG_TRY (elements_values (g, &out->Q, &out->N));
    PG_TRY (choose_polynomial (g->problem, out));
    out->spacing = (b.classes ? 2 : 1) * g->problem->cloud.h, out->reach = sqrt (b.reach) * (1 + 1e-9);
    for (int k = 0; k < g->dim && g->problem->cloud.regular; k++) out->lattice[k] = g->problem->cloud.step[k];
done:
    element_list_clear (&b);
    if (status != PG_OK) pg_elements_clear (out);
    return status;
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * Quadrature on the reference elements. Rules of triangles and tetrahedra consist of orbits of points under
 * the symmetries of the simplex; weights and positions were found by solving the moment equations of the
 * invariant polynomials (Newton's method from random starts, polished with 70 digits).
 * test/geometry/mesh checks
 * their degree.
 *
 * Symmetric rules with positive weights inside the element keep results independent of the order in which a
 * mesh generator lists the nodes of an element, and keep mass and stiffness positive. */
#include "element.h"
#include <string.h>

/* Gauss-Legendre rule of `order` points on [-1, 1], exact to degree 2 order - 1. */
void pg_gauss_rule (int order, double *x, double *w)
{
    static const double X[5][5] = { { 0 },
                                    { -0.57735026918962576451, 0.57735026918962576451 },
                                    { -0.77459666924148337704, 0, 0.77459666924148337704 },
                                    { -0.86113631159405257522, -0.33998104358485626480,
                                      0.33998104358485626480, 0.86113631159405257522 },
                                    { -0.90617984593866399280, -0.53846931010568309104, 0,
                                      0.53846931010568309104, 0.90617984593866399280 } };
    static const double W[5][5] = { { 2 },
                                    { 1, 1 },
                                    { 5.0 / 9, 8.0 / 9, 5.0 / 9 },
                                    { 0.34785484513745385737, 0.65214515486254614263, 0.65214515486254614263,
                                      0.34785484513745385737 },
                                    { 0.23692688505618908751, 0.47862867049936646804, 128.0 / 225,
                                      0.47862867049936646804, 0.23692688505618908751 } };
    order = order < 1 ? 1 : order > 5 ? 5 : order;
    memcpy (x, X[order - 1], (size_t) order * sizeof *x);
    memcpy (w, W[order - 1], (size_t) order * sizeof *w);
}

/* An orbit: all permutations of barycentric coordinates; coordinates with equal numbers in `same` are
 * equal. weight: of each point, as a share of the simplex. */
typedef struct { signed char same[4]; double weight, value[3]; } orbit;
/* A rule of n orbits. */
typedef struct { int n; orbit orbit[7]; } rule;

/* Kinds of orbits, named by the multiplicities of their coordinates; the last coordinate follows from the
 * sum. */
#define CENTRE(w)            { { 0, 0, 0, 0 }, (w), { 1.0 / 3 } }
#define TRI_21(w, a)         { { 0, 0, 1 }, (w), { (a), 1 - 2 * (a) } }
#define TRI_111(w, a, b)     { { 0, 1, 2 }, (w), { (a), (b), 1 - (a) - (b) } }
#define TET_4(w)             { { 0, 0, 0, 0 }, (w), { 0.25 } }
#define TET_31(w, a)         { { 0, 0, 0, 1 }, (w), { (a), 1 - 3 * (a) } }
#define TET_22(w, a)         { { 0, 0, 1, 1 }, (w), { (a), 0.5 - (a) } }
#define TET_211(w, a, b)     { { 0, 0, 1, 2 }, (w), { (a), (b), 1 - 2 * (a) - (b) } }

static const rule triangle[5] = { /* degrees 1, 2, 5, 6, 8; points 1, 3, 7, 12, 16 */
                                  { 1, { CENTRE (1) } },
                                  { 1, { TRI_21 (1.0 / 3, 1.0 / 6) } },
                                  { 3,
                                    { CENTRE (0.225),
                                      TRI_21 (0.1323941527885061807376, 0.4701420641051150897704),
                                      TRI_21 (0.1259391805448271525957, 0.1012865073234563388010) } },
                                  { 3,
                                    { TRI_21 (0.0508449063702068169209, 0.0630890144915022283403),
                                      TRI_21 (0.1167862757263793660253, 0.2492867451709104212916),
                                      TRI_111 (0.0828510756183735751936, 0.0531450498448169473532,
                                               0.6365024991213986472301) } },
                                  { 5,
                                    { CENTRE (0.1443156076777871682511),
                                      TRI_21 (0.0950916342672846247939, 0.4592925882927231560288),
                                      TRI_21 (0.1032173705347182502818, 0.1705693077517602066223),
                                      TRI_21 (0.0324584976231980803109, 0.0505472283170309754584),
                                      TRI_111 (0.0272303141744349942648, 0.0083947774099576053372,
                                               0.2631128296346381134218) } }
};

static const rule tetrahedron[5] = { /* degrees 1, 2, 5, 6, 8; points 1, 4, 14, 24, 46 */
                                     { 1, { TET_4 (1) } },
                                     { 1, { TET_31 (0.25, 0.13819660112501051518) } },
                                     { 3,
                                       { TET_31 (0.1126879257180158507992, 0.3108859192633006097973),
                                         TET_31 (0.0734930431163619495437, 0.0927352503108912264023),
                                         TET_22 (0.0425460207770814664381, 0.0455037041256496494919) } },
                                     { 4,
                                       { TET_31 (0.0553571815436547220952, 0.3223378901422755103440),
                                         TET_31 (0.0399227502581674920997, 0.2146028712591520292888),
                                         TET_31 (0.0100772110553206429480, 0.0406739585346113531156),
                                         TET_211 (0.0482142857142857142857, 0.0636610018750175252992,
                                                  0.6030056647916491413674) } },
                                     { 7,
                                       { TET_31 (0.04527834931884663744, 0.18800335388179033126),
                                         TET_31 (0.03175856826035778731, 0.11755576816615315147),
                                         TET_31 (0.00912054867683052722, 0.04549223601549773662),
                                         TET_31 (0.04441615528466380998, 0.31360706673154426544),
                                         TET_22 (0.03718748395532468271, 0.43398565592165289801),
                                         TET_211 (0.00716792714301344501, 0.02119001906997522090,
                                                  0.24433536631551417825),
                                         TET_211 (0.01404712369909129298, 0.20381703034648367001,
                                                  0.58871478189603453445) } }
};

/* Next permutation in lexicographic order; 0: that was the last. */
static int next (int n, signed char *a)
{
    int i = n - 2, j = n - 1;
    while (i >= 0 && a[i] >= a[i + 1]) i--;
    if (i < 0) return 0;
    while (a[j] <= a[i]) j--;
    signed char t = a[i];
    a[i] = a[j], a[j] = t;
    for (int l = i + 1, r = n - 1; l < r; l++, r--) t = a[l], a[l] = a[r], a[r] = t;
    return 1;
}

/* Rule of a triangle or tetrahedron: all permutations of each orbit; weights are shares of the reference
 * simplex, whose size is 1/2 or 1/6. */
static int simplex_rule (int dim, int order, double *xi, double *weight)
{
    const rule *r = dim == 2 ? &triangle[order - 1] : &tetrahedron[order - 1];
    int n = 0;
    for (int o = 0; o < r->n; o++) {
        signed char a[4] = { r->orbit[o].same[0], r->orbit[o].same[1], r->orbit[o].same[2],
                             r->orbit[o].same[3] };
        do {
            for (int k = 0; k < dim; k++) xi[n * dim + k] = r->orbit[o].value[a[k]];
            weight[n++] = r->orbit[o].weight / (dim == 2 ? 2 : 6);
        } while (next (dim + 1, a));
    }
    return n;
}

/* Rule of bars, quadrilaterals and hexahedra: product of Gauss rules, the first axis fastest. */
static int brick_rule (int dim, int order, double *xi, double *weight)
{
    int n = 1;
    double x[5], w[5];
    pg_gauss_rule (order, x, w);
    for (int a = 0; a < dim; a++) n *= order;
    for (int k = 0; k < n; k++) {
        weight[k] = 1;
        for (int a = 0, rest = k; a < dim; a++, rest /= order)
            xi[k * dim + a] = x[rest % order], weight[k] *= w[rest % order];
    }
    return n;
}

/* Rule of a wedge: product of the rule of a triangle with a Gauss rule along the axis. */
static int wedge_rule (int order, double *xi, double *weight)
{
    double place[2 * PG_ELEMENT_POINTS], share[PG_ELEMENT_POINTS];
    int m = simplex_rule (2, order, place, share);
    double x[5], w[5];
    pg_gauss_rule (order, x, w);
    for (int k = 0; k < m * order; k++) {
        xi[3 * k] = place[2 * (k % m)], xi[3 * k + 1] = place[2 * (k % m) + 1], xi[3 * k + 2] = x[k / m];
        weight[k] = share[k % m] * w[k / m];
    }
    return m * order;
}

/* Rule of a pyramid: Gauss rules in x and y, scaled by 1 - z, times a Gauss-Jacobi rule in z for the weight
 * (1 - z)^2, which is the area of the cross section. */
static int pyramid_rule (int order, double *xi, double *weight)
{
    static const double Z[5][5] = {
        { 0.25 },
        { 0.12251482265544137786, 0.54415184401122528879 },
        { 0.07299402407314973215, 0.34700376603835188472, 0.70500220988849838312 },
        { 0.04850054944699732929, 0.23860073755186230505, 0.51704729510436750234, 0.79585141789677286330 },
        { 0.03457893991821509152, 0.17348032077169572310, 0.38988638706551932824, 0.63433347263088677234,
          0.85105421294701641811 } };
    static const double W[5][5] = {
        { 1.0 / 3 },
        { 0.23254745125350790274, 0.10078588207982543058 },
        { 0.15713636106488661331, 0.14624626925986602200, 0.02995070300858069801 },
        { 0.11088841561127798368, 0.14345878979921420904, 0.06863388717292307531, 0.01035224074991806528 },
        { 0.08176478428577091790, 0.12619896189991148802, 0.08920016122159000018, 0.03205560072296191925,
          0.00411382520309900795 } };
    double x[5], w[5];
    int n = 0;
    pg_gauss_rule (order, x, w);
    for (int c = 0; c < order; c++)
        for (int b = 0; b < order; b++)
            for (int a = 0; a < order; a++, n++) {
                double z = Z[order - 1][c];
                xi[3 * n] = x[a] * (1 - z), xi[3 * n + 1] = x[b] * (1 - z), xi[3 * n + 2] = z;
                weight[n] = w[a] * w[b] * W[order - 1][c];
            }
    return n;
}

/* Orders outside 1 to 5 are moved into that range. */
int pg_element_rule (pg_element kind, int order, double *xi, double *weight)
{
    int dim = pg_element_types[kind].dim;
    order = order < 1 ? 1 : order > 5 ? 5 : order;
    switch (kind) {
    case PG_TRI3: case PG_TRI6: case PG_TET4: case PG_TET10: return simplex_rule (dim, order, xi, weight);
    case PG_WEDGE6: case PG_WEDGE15: return wedge_rule (order, xi, weight);
    case PG_PYRAMID5: return pyramid_rule (order, xi, weight);
    default: return brick_rule (dim, order, xi, weight);
    }
}

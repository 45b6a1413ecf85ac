/* SPDX-License-Identifier: GPL-3.0-or-later
 * Eigenstrains (temperature, shrinkage, pore pressure): the stress is that of the strain minus the free
 * strain eps*, which is equal along all axes. Its work is a pair of its own at every evaluation point, so
 * that energies balance: dU = sigma : d eps - sigma : d eps*. */
#include "galerkin.h"
#include <math.h>
#include <string.h>

/* Factor from the free strain to that in the components of the body: in plane strain the expansion restrained
 * across the plane adds Poisson's ratio times it. */
static double held (const pg_material *m) { return m->mode == PG_PLANE_STRAIN ? 1 + m->nu : 1; }

/* Stress across the plane by the restrained expansion, over the free strain, Pa; 0 unless in plane strain. */
static double across (const pg_material *m) { return m->mode == PG_PLANE_STRAIN ? m->E : 0; }

pg_status galerkin_eigen_create (galerkin *g)
{
    galerkin_eigenstrain *e = &g->eigen;
    pg_status status = PG_OK;
    if (!pg_problem_strained (g->problem)) return PG_OK;
    const pg_problem *p = g->problem;
    for (int s = 0; s < PG_BOND_SETS; s++) PG_ALLOC (e->strain[s], g->rows[s].n);
    PG_ALLOC (e->pattern, p->boundary.nload * PG_BOND_SETS);
    for (size_t l = 0; l < p->boundary.nload; l++)
        for (int s = 0; s < PG_BOND_SETS && p->boundary.load[l].kind == PG_EIGENSTRAIN; s++) {
            if (!pg_load_separates (&p->boundary.load[l])) continue;
            double *pattern = NULL;
            PG_ALLOC (pattern, g->rows[s].n);
            e->pattern[l * PG_BOND_SETS + (size_t) s] = pattern;
            for (size_t q = 0; q < g->rows[s].n; q++)
                pattern[q] = p->boundary.load[l].per_material[g->material[s][q]]
                             * pg_load_pattern (&p->boundary.load[l], 0, p->dim,
                                                g->rows[s].x + q * (size_t) p->dim);
        }
    e->time = NAN;
done:
    return status;
}

void galerkin_eigen_free (galerkin *g)
{
    galerkin_eigenstrain *e = &g->eigen;
    for (int s = 0; s < PG_BOND_SETS; s++) pg_free (e->strain[s]);
    for (size_t k = 0; e->pattern && k < g->problem->boundary.nload * PG_BOND_SETS; k++)
        pg_free (e->pattern[k]);
    pg_free (e->pattern);
}

/* The free strain of a point; 0 where it has too few neighbours for a strain and carries no stress. */
static double free_strain (const galerkin *g, int set, size_t p)
{
    return g->rows[set].grade[p] < PG_GRADE_SHEPARD ? g->eigen.strain[set][p] : 0;
}

/* Computes the stress at point p of a set from its strain e minus the free strain. */
void galerkin_eigen_stress (const galerkin *g, int set, size_t p, const double *e)
{
    const pg_material *m = galerkin_material (g, set, p);
    double elastic[6], free = free_strain (g, set, p), part = held (m) * free;
    memcpy (elastic, e, (size_t) g->nv * sizeof *e);
    for (int k = 0; k < g->dim; k++) elastic[k] -= part;
    m->type->stress (m, 1, elastic, g->measured.stress[set] + p * (size_t) g->nv, g->measured.zz[set] + p);
    g->measured.zz[set][p] -= across (m) * free;
}

/* Norm of the forces that would hold the body unstrained, N: the reference for residuals where nothing else
 * loads it. Of every point the stress of its free strain times volume over spacing, regardless of broken
 * bonds, so that a resumed run gets the same. */
static double size_of_forces (const galerkin *g)
{
    double sum = 0, none[6] = { 0 }, s[6], zz;
    for (size_t p = 0; p < g->sums.n; p++) {
        const pg_material *m = galerkin_material (g, g->bulk, p);
        if (!pg_problem_owns (g->problem, g->bulk, p)) continue;
        none[0] = held (m) * g->eigen.strain[g->bulk][p];
        m->type->stress (m, 1, none, s, &zz);
        double f = g->problem->bonds.rows[g->bulk].weight[p] * s[0]
                   / pg_problem_spacing (g->problem, g->bulk, p);
        sum += f * f;
    }
    if (pg_cloud_sum (&g->problem->cloud, 1, &sum) != PG_OK) return NAN;
    return sqrt (sum);
}

/* Adds the free strains of load l at time t to those of set s: its pattern times a factor, if it
 * separates. */
static void add_load (galerkin *g, size_t l, int s, double t)
{
    const pg_load *load = &g->problem->boundary.load[l];
    const double *pattern = g->eigen.pattern[l * PG_BOND_SETS + (size_t) s];
    size_t dim = (size_t) g->dim;
    double factor = pattern ? pg_load_factor (load, t) : 0;
    for (size_t p = 0; p < g->rows[s].n; p++)
        g->eigen.strain[s][p] += pattern ? factor * pattern[p]
                                  : load->per_material[g->material[s][p]]
                                        * pg_load_value (load, 0, g->dim, g->rows[s].x + p * dim, t);
}

void galerkin_eigen_at (galerkin *g, double t)
{
    galerkin_eigenstrain *e = &g->eigen;
    if (!e->strain[PG_NODES] || t == e->time) return;
    for (int s = 0; s < PG_BOND_SETS; s++) {
        memset (e->strain[s], 0, g->rows[s].n * sizeof *e->strain[s]);
        for (size_t l = 0; l < g->problem->boundary.nload; l++)
            if (g->problem->boundary.load[l].kind == PG_EIGENSTRAIN) add_load (g, l, s, t);
        g->measured.fresh[s] = 0;
    }
    e->time = t;
    e->force = size_of_forces (g);
}

/* Subtracts from a stress at position x (xx yy zz xy yz zx, Pa) that of the free strain there at time t; q:
 * an evaluation point of the same material. */
void galerkin_eigen_relieve (const galerkin *g, double t, const double *x, size_t q, double *stress)
{
    if (!g->eigen.strain[PG_NODES]) return;
    const pg_problem *p = g->problem;
    const pg_material *m = galerkin_material (g, g->bulk, q);
    double free = 0, e[6] = { 0 }, s[6] = { 0 }, zz = 0;
    for (size_t l = 0; l < p->boundary.nload; l++)
        if (p->boundary.load[l].kind == PG_EIGENSTRAIN)
            free += p->boundary.load[l].per_material[g->material[g->bulk][q]]
                    * pg_load_value (&p->boundary.load[l], 0, p->dim, x, t);
    for (int k = 0; k < g->dim; k++) e[k] = held (m) * free;
    m->type->stress (m, 1, e, s, &zz);
    for (int k = 0; k < (g->dim == 3 ? 6 : g->dim); k++) stress[k] -= s[k];
    if (g->dim == 2) stress[2] -= zz + across (m) * free, stress[3] -= s[2];
}

void galerkin_eigen_bonds (const galerkin *g, int set, size_t count, const size_t *bond, const size_t *point,
                           const double *xi, double *eta)
{
    size_t dim = (size_t) g->dim;
    for (size_t k = 0; k < count; k++) {
        double here = g->eigen.strain[set][point[k]],
            there = g->eigen.strain[PG_NODES][g->rows[set].family.node[bond[k]]];
        for (size_t a = 0; a < dim; a++) eta[k * dim + a] -= 0.5 * (here + there) * xi[k * dim + a];
    }
}

/* sigma : eps* over eps* at a point of the bulk, Pa. */
static double pressure (const galerkin *g, size_t p)
{
    double sum = g->dim == 2 ? g->measured.zz[g->bulk][p] : 0;
    for (int k = 0; k < g->dim; k++) sum += g->measured.stress[g->bulk][p * (size_t) g->nv + (size_t) k];
    return sum;
}

/* Excess of half sigma : eps, with the total strain, over the elastic energy density at point p, J/m^3. */
double galerkin_eigen_energy (const galerkin *g, size_t p)
{
    return g->eigen.strain[PG_NODES] ? 0.5 * pressure (g, p) * free_strain (g, g->bulk, p) : 0;
}

size_t galerkin_eigen_pairs (const galerkin *g)
{
    return g->eigen.strain[PG_NODES]
           ? g->sums.n + g->supports.nnitsche : 0;
}

/* Work of a unit free strain on the gap of a constraint by Nitsche's terms, J: their energy contains the
 * traction times the gap, and the free strain reduces the traction by n D m, m = 1 along all axes. */
static double on_gap (const galerkin *g, const constraint *q, double t)
{
    size_t dim = (size_t) g->dim;
    const pg_material *m = galerkin_material (g, PG_FACETS, q->point);
    const double *normal = g->problem->bonds.facet_normal + q->point * dim;
    double e[6] = { 0 }, s[6], zz, traction = 0,
        gap = g->measured.u[PG_FACETS][q->point * dim + (size_t) q->component]
                 - galerkin_prescribed (g, q, PG_FACETS, t);
    for (size_t k = 0; k < dim; k++) e[k] = held (m);
    m->type->stress (m, 1, e, s, &zz);
    for (int c = 0; c < g->dim; c++) traction += s[pg_voigt_at (g->dim, q->component, c)] * normal[c];
    return g->rows[PG_FACETS].weight[q->point] * gap * traction;
}

/* Fills the pairs of the free strains from number `at` on; they are no forces on the body. */
void galerkin_eigen_work (const galerkin *g, double t, pg_work_balance *out, size_t at)
{
    const galerkin_supports *c = &g->supports;
    if (!g->eigen.strain[PG_NODES]) return;
    for (size_t p = 0; p < g->sums.n; p++, at++) {
        out->force[at] = pg_problem_owns (g->problem, g->bulk, p) ? -g->sums.weight[p] * pressure (g, p) : 0;
        out->displacement[at] = free_strain (g, g->bulk, p);
    }
    for (size_t i = 0; i < c->nnitsche; i++, at++) {
        out->force[at] = pg_problem_owns (g->problem, PG_FACETS, c->nitsche[i].point)
                             ? on_gap (g, &c->nitsche[i], t) : 0;
        out->displacement[at] = free_strain (g, PG_FACETS, c->nitsche[i].point);
    }
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * Warnings before the first step of a run: what is legal in a scene, but probably not intended. */
#include "perigal/fracture.h"
#include "solve/run/solve.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Does component k of this load differ from zero at this time (or load factor)? */
static int acts_at (const pg_problem *p, const pg_load *load, int k, double t)
{
    for (size_t i = 0; i < load->set->npoint; i++)
        if (pg_load_value (load, k, p->dim, p->cloud.x + (size_t) load->set->point[i] * (size_t) p->dim, t)
            != 0)
            return 1;
    return 0;
}

/* Does component k of a load ever differ from zero? It may end at zero (a table that comes back), so that it
 * is also checked at the rows of its table and at times all along the run. */
static int acts (const pg_problem *p, const pg_load *load, int k, double end)
{
    enum { LOOKS = 7 };
    if (!load->value[k]) return 0;
    int moves = pg_load_prescribes (load) || load->kind == PG_SPRING;
    if (!moves || load->set->npoint == 0 || acts_at (p, load, k, end)) return 1;
    for (size_t row = 0; row < load->ntable; row++) if (acts_at (p, load, k, load->table[2 * row])) return 1;
    for (int look = 1; look < LOOKS; look++) if (acts_at (p, load, k, end * look / LOOKS)) return 1;
    return 0;
}

/* 1: prescribed displacements leave a rigid motion free: the least eigenvalue of sum (e_k . motion)^2 over
 * all of them is zero, motions being in units of the body's size. */
static int may_turn (const pg_problem *p)
{
    size_t dim = (size_t) p->dim, n = dim == 2 ? 3 : 6, count = 0;
    double A[36] = { 0 }, value[6], size = 0, middle[3] = { 0 };
    if (dim < 2) return 0;
    for (size_t k = 0; k < dim; k++)
        middle[k] = 0.5 * (p->cloud.low[k] + p->cloud.high[k]),
        size = fmax (size, p->cloud.high[k] - p->cloud.low[k]);
    for (size_t l = 0; l < p->boundary.nload; l++) {
        const pg_load *load = &p->boundary.load[l];
        if (pg_load_prescribes (load) && pg_load_rotates (load)) return 0;
        for (size_t k = 0; (pg_load_prescribes (load) || load->kind == PG_SPRING) && k < dim; k++)
            for (size_t i = 0; load->value[k] && i < load->set->npoint; i++) {
                double row[6] = { 0 }, x[3] = { 0 };
                for (size_t a = 0; a < dim; a++)
                    x[a] = (p->cloud.x[(size_t) load->set->point[i] * dim + a] - middle[a]) / size;
                row[k] = 1, count++;
                if (dim == 2) row[2] = k == 0 ? -x[1] : x[0];
                else row[3 + (k + 1) % 3] = x[(k + 2) % 3], row[3 + (k + 2) % 3] = -x[(k + 1) % 3];
                for (size_t a = 0; a < n; a++) for (size_t b = 0; b < n; b++) A[a * n + b] += row[a] * row[b];
            }
    }
    if (count == 0) return 0;
    pg_dense_eigen ((int) n, A, value, NULL);
    return value[n - 1] < 1e-12 * value[0];
}

/* Does a load prescribe displacements along axis k? */
static int held_along (const pg_problem *p, int k)
{
    for (size_t l = 0; l < p->boundary.nload; l++)
        if ((pg_load_prescribes (&p->boundary.load[l]) || p->boundary.load[l].kind == PG_SPRING)
            && !pg_load_rotates (&p->boundary.load[l]) && p->boundary.load[l].value[k])
            return 1;
    return 0;
}

/* Warns of rigid motions that nothing prevents, and of bodies without a load. In dynamics inertia holds a
 * body, and only loads are checked. */
static void doubt_supports (pg_statistics *report, const pg_problem *p, const pg_solver_options *o)
{
    int moving = 0, everywhere = 1;
    for (int k = 0; k < p->dim; k++) {
        /* with platens only contact tells what they hold */
        int held = !(o->flags & PG_SOLVER_QUASI_STATIC) || p->boundary.nplaten || held_along (p, k);
        for (size_t l = 0; l < p->boundary.nload; l++)
            moving |= acts (p, &p->boundary.load[l], k, (o->flags & PG_SOLVER_QUASI_STATIC) ? 1 : o->end)
                      || p->boundary.load[l].kind == PG_PRESSURE;
        everywhere &= held;
        if (!held)
            pg_statistics_warn (
                report, "nothing holds the body along %c: no displacement along %c is prescribed anywhere",
                "xyz"[k], "xyz"[k]);
    }
    if (everywhere && (o->flags & PG_SOLVER_QUASI_STATIC) && p->boundary.nload && !p->boundary.nplaten
        && may_turn (p))
        pg_statistics_warn (
            report,
            "nothing keeps the body from turning: the prescribed displacements leave a rotation free");
    for (int k = 0; k < 3; k++) moving |= p->boundary.initial[k] != NULL;
    if (!moving && !p->boundary.nmotion)
        pg_statistics_warn (
            report, "nothing loads the body: every prescribed displacement is zero, and there is no force");
}

/* Warns of a displacement on `all`, which is prescribed at every point, not on the surface alone. */
static void doubt_all (pg_statistics *report, const pg_problem *p)
{
    unsigned held = 0;
    size_t all = pg_cloud_total (&p->cloud);
    for (size_t l = 0; l < p->boundary.nload; l++) {
        const pg_load *load = &p->boundary.load[l];
        if (!pg_load_prescribes (load) || pg_load_rotates (load) || load->essential == PG_ESSENTIAL_NITSCHE
            || pg_set_points (load->set) < all)
            continue;
        for (int k = 0; k < p->dim; k++) held |= (unsigned) (load->value[k] != NULL) << k;
    }
    if (held == (1u << p->dim) - 1)
        pg_statistics_warn (
            report, "displacements are prescribed at every point of the body: nothing is left to solve. Of "
                    "its surface alone: sets: {NAME: {boundary: all}}, or essential: nitsche");
}

/* Mean depth of the points of a set below its facets, m; along: mean sizes of the components of the normals
 * there. 0: the set has no facets, or its points lie on them. All ranks call. */
static double depth_of (const pg_problem *p, const pg_set *set, double *along)
{
    enum { SAMPLE = 64 };
    size_t dim = (size_t) p->dim, step = set->nfacet / SAMPLE + 1;
    double sum[5] = { 0 };                             /* numbers of facets, sums of depths, of components */
    for (size_t f = 0; f < set->nfacet; f += step) {
        if (!set->npoint || !pg_problem_owns_facet (p, (size_t) set->facet[f])) continue;
        const double *c = p->cells.facet_centre + (size_t) set->facet[f] * dim,
                     *n = p->cells.normal + (size_t) set->facet[f] * dim;
        double best = INFINITY, depth = 0;
        for (size_t i = 0; i < set->npoint; i++) {
            double far = 0, inside = 0;
            for (size_t k = 0; k < dim; k++) {
                double d = c[k] - p->cloud.x[(size_t) set->point[i] * dim + k];
                far += d * d, inside += d * n[k];
            }
            if (far < best) best = far, depth = inside;
        }
        sum[0] += 1, sum[1] += depth;
        for (size_t k = 0; k < dim; k++) sum[2 + k] += fabs (n[k]);
    }
    if (pg_cloud_sum (&p->cloud, 5, sum) != PG_OK) sum[0] = 0;
    for (size_t k = 0; k < 3; k++) along[k] = sum[0] > 0 ? sum[2 + k] / sum[0] : 0;
    return sum[0] > 0 ? sum[1] / sum[0] : 0;
}

/* Warns where displacements act below the surface: those prescribed at points act there, on a lattice of cell
 * centres half a spacing inside, so that the body is shorter for its loads by both ends together. */
static void doubt_depth (pg_statistics *report, const pg_problem *p)
{
    double deepest = 0, along[3], shorter[3] = { 0 }, most = 0;
    const char *name = "";
    size_t loads = 0;
    if (!p->method || !p->method->shape_functions) return;
    for (size_t l = 0; l < p->boundary.nload; l++) {
        const pg_load *load = &p->boundary.load[l];
        if (!pg_load_prescribes (load) || load->essential == PG_ESSENTIAL_NITSCHE || load->share
            || pg_set_points (load->set) <= (size_t) p->dim)
            continue;                                  /* so few points are meant as a pin */
        double deep = depth_of (p, load->set, along);
        if (!(deep > 0.1 * p->cloud.h)) continue;
        loads++;
        if (deep > deepest) deepest = deep, name = load->name;
        for (int k = 0; k < p->dim; k++) shorter[k] += deep * along[k] / (p->cloud.high[k] - p->cloud.low[k]);
    }
    for (int k = 0; k < p->dim; k++) if (shorter[k] > most) most = shorter[k];
    if (!loads) return;
    pg_statistics_warn (report,
                        "%.40s acts at points %.3g m inside the surface, %.2g spacings: the body is about "
                        "%.2g %% shorter for it%s, and as much too stiff; essential: nitsche acts on the "
                        "surface, as does lattice: nodes",
                        name, deepest, deepest / p->cloud.h, 100 * most,
                        loads > 1 ? " and the other supports" : "");
}

/* Finds the extent, along axis q, of the points on which a load acts along axis k: low to high, m. Returns 0:
 * none. */
static int spans (const pg_problem *p, const pg_load *load, int k, int q, double *low, double *high)
{
    *low = INFINITY, *high = -INFINITY;
    if (!load->value[k] || load->turns || pg_load_rotates (load) || load->kind == PG_EIGENSTRAIN) return 0;
    for (size_t i = 0; i < load->set->npoint; i++) {
        double x = p->cloud.x[(size_t) load->set->point[i] * (size_t) p->dim + (size_t) q];
        *low = fmin (*low, x), *high = fmax (*high, x);
    }
    return *low <= *high;
}

/* 1: another load acts along axis k outside low to high on axis q, so that the body bends over this
 * stretch. */
static int bends (const pg_problem *p, size_t load, int k, int q, double low, double high)
{
    double from, to;
    for (size_t l = 0; l < p->boundary.nload; l++)
        if (l != load && spans (p, &p->boundary.load[l], k, q, &from, &to)
            && (0.5 * (from + to) < low || 0.5 * (from + to) > high))
            return 1;
    return 0;
}

/* 1: this load may be a clamp by mistake; not where it is all that holds the body and has to prevent
 * rotation. */
static int may_clamp (const pg_problem *p, size_t load)
{
    const pg_load *this = &p->boundary.load[load];
    if (!pg_load_prescribes (this) || this->share || this->symmetry || p->cloud.subdomain) return 0;
    for (size_t l = 0; l < p->boundary.nload; l++)
        if (l != load && (pg_load_prescribes (&p->boundary.load[l]) || p->boundary.load[l].kind == PG_SPRING))
            return 1;
    return p->boundary.nplaten > 0;
}

/* Warns of clamps: displacements along k of a short part of the surface, with points more than a spacing
 * apart along q, prevent its rotation and bear a moment, where a roller or the edge of a load is mostly
 * meant. */
static void doubt_clamps (pg_statistics *report, const pg_problem *p)
{
    static const double narrow = 1.5, most = 0.2;      /* spacings; share of the body along q */
    double low, high;
    for (size_t l = 0; l < p->boundary.nload; l++) {
        const pg_load *load = &p->boundary.load[l];
        int done = !may_clamp (p, l);
        for (int k = 0; k < p->dim && !done; k++)
            for (int q = 0; q < p->dim && !done; q++) {
                if (q == k || !spans (p, load, k, k, &low, &high)
                    || high - low > most * (p->cloud.high[k] - p->cloud.low[k])) continue;
                spans (p, load, k, q, &low, &high);
                double h = pg_problem_spacing (p, PG_NODES, (size_t) load->set->point[0]);
                if (high - low < narrow * h || high - low > most * (p->cloud.high[q] - p->cloud.low[q])
                    || !bends (p, l, k, q, low, high))
                    continue;
                done = 1;
                pg_statistics_warn (report,
                                    "%.40s: displacements along %c of points up to %.3g m apart along %c "
                                    "keep the surface there from turning, as a clamp does; roller or hinge: "
                                    "points within a spacing, %.3g m, a force or a spring `at` a place",
                                    load->name, "xyz"[k], high - low, "xyz"[q], h);
            }
    }
}

/* Warns of Nitsche's method on inner points, as it integrates over facets; on the whole body its surface is
 * meant. */
static void doubt_inner (pg_statistics *report, const pg_problem *p)
{
    size_t all = pg_cloud_total (&p->cloud);
    for (size_t l = 0; l < p->boundary.nload; l++) {
        const pg_load *load = &p->boundary.load[l];
        if (!pg_load_prescribes (load) || load->essential != PG_ESSENTIAL_NITSCHE || !pg_set_inner (load->set)
            || pg_set_points (load->set) == all)
            continue;
        pg_statistics_warn (report,
                            "%.40s: essential: nitsche holds the %zu facets of %.40s and leaves free %zu of "
                            "its points, which lie behind them; use essential: penalty",
                            load->name, pg_set_facets (load->set), load->set->name, pg_set_inner (load->set));
    }
}

static int warns (const char *note) { return strncmp (note, PG_WARNING, strlen (PG_WARNING)) == 0; }

/* Warns of what the patch test found: a large error, points without strain, separate parts of the body. */
static void doubt_patch (pg_statistics *report, const pg_problem *p)
{
    char words[240], remedy[240], at[100];
    const pg_patch *t = &p->quality.patch;
    if (!t->measured) return;
    pg_patch_place (p, t->blind, at, sizeof at);
    if (t->degenerate)
        pg_statistics_warn (report,
                            "%zu of %zu evaluation points, such as that at %s, see too few points for a "
                            "strain and carry no stress",
                            t->degenerate, t->points, at);
    if (t->isolated)
        pg_statistics_warn (report, "%zu point%s by no bond on any other", t->isolated,
                            t->isolated == 1 ? " hangs" : "s hang");
    if (t->fragments)
        pg_statistics_warn (report, "the body is in %zu parts that no bond joins", t->fragments + 1);
    if (t->softness > 1e9)
        pg_statistics_warn (report,
                            "next to nothing resists some motion of the points (%.1g times less than usual): "
                            "displacements may be wrong there; points that nearly "
                            "coincide, or modes without energy of nodal integration, do this",
                            t->softness);
    if (t->rigid > PG_RIGID_WARNED)
        pg_statistics_warn (report,
                            "a rigid motion of the body strains it: a turn by an angle gives strains of %.2g "
                            "times the angle, and forces and moments miss balance by as much; a body that "
                            "turns more than it strains is not to be trusted: use integration: consistent, a "
                            "larger horizon (now %.3g spacings) or a smaller spacing",
                            t->rigid, p->form.approx.horizon / p->cloud.h);
    if (t->error <= PG_PATCH_WARNED) return;
    pg_patch_words (p, words, sizeof words);
    pg_patch_remedy (p, remedy, sizeof remedy);
    pg_statistics_warn (report, "%s; %s", words, remedy);
}

/* Warns of cracks that grow bond by bond in shape functions: a bond of an evaluation point is one entry of
 * its shape functions, not a spring, and its loss changes the others. Measured on strips of known energy
 * release rate (bench/single_bonds galerkin_stretch; doc/method.md A1): 2.7 to 5.2 times the fracture energy
 * is consumed, and 4.1 to 7.9 times must be supplied, whose roots are the factors of the load. With a tensile
 * strength f 3.4 to 3.8 f^2 h / E must be supplied, and -0.6 to 0.04 of it is consumed
 * (galerkin_principal_stress). */
static void doubt_single_bonds (pg_statistics *report, const pg_problem *p, const pg_solver_options *o)
{
    const pg_criterion *c = p->criterion;
    const char *instead = o->flags & PG_SOLVER_FACETS && p->dim == 2 ? pg_criterion_by_need (PG_NEEDS_FACETS)
                                                                     : NULL;
    if (p->dim < 2 || !p->method->shape_functions || !pg_criterion_of_bonds (c)) return;
    if (c->type->needs & PG_NEEDS_STRETCH)
        pg_statistics_warn (report,
                            "cracks of shape functions that grow bond by bond consume 3 to 5 times the "
                            "fracture energy and need 2 to 3 times the load, by how the lattice lies%s%s%s",
                            instead ? "; criterion: " : "", instead ? instead : "",
                            instead ? " grows them at that energy" : "");
    else
        pg_statistics_warn (report,
                            "a strength is no fracture energy: cracks that grow bond by bond need about 3.6 "
                            "strength^2 spacing / E, and take next to no energy out of the body%s%s%s",
                            instead ? "; criterion: " : "", instead ? instead : "",
                            instead ? " grows them at a fracture_energy" : "");
}

/* Warns of cracks that begin in shear where the scene has cracks: a trial uses the field of the body as it
 * is, in which contact forces on other faces do not change as they would (shear_initiation.c). */
static void doubt_shear (pg_statistics *report, const pg_problem *p)
{
    static const double origin[3] = { 0 };
    if (!p->crack.given.n || !pg_criterion_of_tips (p->criterion)) return;
    for (size_t m = 0; m < p->nmaterial; m++) {
        pg_fracture_limits limits = { .cohesion = NAN };
        if (!p->criterion[m].never) p->criterion[m].type->fracture (&p->criterion[m], origin, 0, &limits);
        if (isnan (limits.cohesion)) continue;
        pg_statistics_warn (report,
                            "where a crack begins in shear, cracks of the scene that are closed count as "
                            "free of contact: the load of its beginning is only right far from them");
        return;
    }
}

/* Warns of facets in dynamics: branching and contact are known to change the energy that they take
 * (facet_energy.c). */
static void doubt_motion (pg_statistics *report, const pg_problem *p, const pg_solver_options *o)
{
    int touch = o->contact.kind != PG_CONTACT_NONE;
    if (p->dim != 2 || !pg_problem_grows (p) || !(o->flags & PG_SOLVER_NEEDS_DENSITY)) return;
    if (!touch && !o->branching) return;
    pg_statistics_warn (report,
                        "facets in motion: where tips branch or faces touch, facets are known to take .5 "
                        "to 2 "
                        "times their fracture energy; the run says when and where it leaves .9 to 1.1");
}

/* Warns of tips without room for a ring, each with what stands in the way, before the first step. If there is
 * no memory for the initial state, the run itself fails with that. */
static pg_status doubt_tips (pg_statistics *report, const pg_problem *p)
{
    enum { MOST = 5 };
    pg_status status = PG_OK;
    pg_state *state = NULL;
    size_t blind = 0;
    if (p->dim != 2 || !p->crack.ntip || !pg_criterion_of_tips (p->criterion)) return PG_OK;
    PG_TRY (pg_state_create (&state, p, pg_problem_unknowns (p)));
    for (size_t i = 0; i < state->paths->ntip; i++) {
        pg_tip_field f;
        char what[80];
        if (!state->paths->tip[i].open) continue;
        PG_TRY (pg_tip_find (&f, p, state, i));
        if (!isnan (f.near) || blind++ >= MOST) continue;
        pg_tip_limit_words (p, &f, what, sizeof what);
        pg_statistics_warn (report,
                            "no room for a ring around crack tip %ld at (%.6g, %.6g) m: %s is %.3g spacings "
                            "away, 1.5 are needed: J and K are not known; it grows by trial facets, if at "
                            "all",
                            state->paths->tip[i].id, f.x[0], f.x[1], what, f.room / f.h);
    }
    if (blind > MOST)
        pg_statistics_warn (report, "no room for a ring around %zu more crack tips", blind - MOST);
done:
    pg_state_free (&state);
    return status;
}

/* 1: from point i in direction e one leaves the body and comes back into it within two spacings. */
static int crosses_void (const pg_problem *p, size_t i, const double *e)
{
    enum { STEPS = 16 };
    int left = 0;
    double h = pg_problem_spacing (p, PG_NODES, i), place[3] = { 0 };
    for (int k = 1; k <= STEPS; k++) {
        for (size_t c = 0; c < (size_t) p->dim; c++)
            place[c] = p->cloud.x[i * (size_t) p->dim + c] + 2 * h * k / STEPS * e[c];
        int in = pg_problem_has_body (p, place);
        if (left && in) return 1;
        left |= !in;
    }
    return 0;
}

/* Warns of voids between irregular points: points of a file have no surface, and what is too far from all of
 * them counts as outside (crack/geometry/body_search.c), so that a crack ends in such a void. Checks at most
 * some thousand points, along the axes and the diagonals. */
static void doubt_voids (pg_statistics *report, const pg_problem *p)
{
    enum { SAMPLE = 2000 };
    static const double direction[][3] = {
        { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 }, { .71, .71, 0 }, { .71, -.71, 0 }, { .58, .58, .58 } };
    size_t stride = p->cloud.n / SAMPLE + 1, found = 0, looked = 0;
    if (!p->crack.search || p->body.n || p->part.mesh.n || !pg_criterion_of_tips (p->criterion)) return;
    for (size_t i = 0; i < p->cloud.n; i += stride, looked++) {
        int any = 0;
        for (size_t k = 0; k < sizeof direction / sizeof *direction && !any; k++)
            if (p->dim == 3 || direction[k][2] == 0) any = crosses_void (p, i, direction[k]);
        found += (size_t) any;
    }
    if (found)
        pg_statistics_warn (report,
                            "%zu of %zu points looked at have voids beside them, %.2g spacings away from "
                            "every point, which count as the surface of the body: cracks that come there "
                            "end; give the shapes that are its surface (body: beside points:)",
                            found, looked, p->dim == 3 ? 0.87 : 0.71);
}

/* Gives all warnings before the first step, including notes of the model that are warnings. */
void pg_solver_doubts (pg_statistics *report, const pg_problem *p, const pg_solver_options *o)
{
    doubt_supports (report, p, o);
    doubt_all (report, p);
    doubt_inner (report, p);
    doubt_clamps (report, p);
    doubt_depth (report, p);
    doubt_patch (report, p);
    doubt_single_bonds (report, p, o);
    doubt_shear (report, p);
    doubt_voids (report, p);
    doubt_tips (report, p);
    doubt_motion (report, p, o);
    for (size_t k = 0; k < p->notes.n; k++)
        if (warns (p->notes.text[k]))
            pg_statistics_warn (report, "%s", p->notes.text[k] + strlen (PG_WARNING));
    if (p->part.mesh.n && p->part.quality < 0.1)
        pg_statistics_warn (report,
                            "element %ld of the mesh is nearly flat: quality %.2g (scaled Jacobian; better "
                            "than 0.1 is wanted)",
                            p->part.mesh.element_id[p->part.worst], p->part.quality);
}

/* Notes: those of the model first, then what ranks do differently, then keys of other solvers. */
int pg_solver_note (const pg_problem *p, const pg_solver_options *o, size_t k, char *out, size_t size)
{
    for (size_t i = 0; i < p->notes.n; i++) {
        if (warns (p->notes.text[i]) || k-- > 0) continue;
        snprintf (out, size, "%s", p->notes.text[i]);
        return 1;
    }
    if (o->event && p->cloud.subdomain && k-- == 0) {
        snprintf (out, size,
                  "ranks that divide the body have no factor that serves many events, and look for no events "
                  "ahead: each is solved for by conjugate gradients from the one before");
        return 1;
    }
    if (!*o->unused || k > 0) return 0;
    snprintf (out, size, "ignored with solver.kind: %s, in solver: %s", o->kind, o->unused);
    return 1;
}

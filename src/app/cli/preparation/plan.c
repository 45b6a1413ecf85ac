/* SPDX-License-Identifier: GPL-3.0-or-later
 * What a scene amounts to, in words: in short before a run, and at length for check. Numbers
 * come from the built problem, not from the scene, so that they say what the program has
 * understood: a millimetre that was read as a metre shows in the box of the body.
 *
 * Each line has a name of at most 18 characters and what belongs to it, so that a number is
 * found by its name. plan_json.c has the same numbers for programs; a number that is added
 * here belongs there too. */
#include "cli.h"
#include <math.h>
#include <string.h>

/* Returns how the solver steps, in its own words (quasi-static solvers: event stepping or fixed steps); "" if
 * it says nothing. */
static const char *stepping (const pg_solver_options *o)
{
    const pg_solver_type *type = pg_solver_find (o->kind);
    return type && type->manner ? type->manner (o) : "";
}

/* Prints the criterion; with several materials one line for each, with its points and its evaluation points,
 * because a block that was meant to have another material shows there. width: of the first column. */
static void describe (const pg_problem *p, int width)
{
    char text[512];
    pg_criterion_describe (p->criterion, text, sizeof text);
    if (p->nmaterial == 1) printf ("  %-*s %s\n", width, "criterion", text);
    for (size_t m = 0; p->nmaterial > 1 && m < p->nmaterial; m++) {
        size_t points = 0, inside = 0;
        for (size_t i = 0; i < p->cloud.n; i++) points += p->block[PG_NODES][i] == (int) m;
        for (size_t i = 0; i < p->bonds.rows[PG_POINTS].n; i++) inside += p->block[PG_POINTS][i] == (int) m;
        pg_criterion_describe (&p->criterion[m], text, sizeof text);
        printf ("  %-*s %s: %zu points, %zu evaluation points; criterion %s\n", width, "material",
                p->material[m].name, points, p->bonds.rows[PG_POINTS].n ? inside : points, text);
    }
}

/* Prints the choices of the method, and what the force says of its constants: the force of the solver; if
 * there is no solver a force is created and freed again. */
static void print_method (const plan *all)
{
    const pg_problem *p = all->problem;
    const pg_force_type *force = pg_force_of (p);
    void *self = NULL;
    char text[400];
    p->method->words (p, text, sizeof text);
    printf ("  %-18s  %s\n", "method", text);
    if (!force || !force->describe) return;
    if (all->solver) pg_solver_force (all->solver, &self);
    else if (force->create (&self, p) != PG_OK) return;
    for (size_t line = 0; force->describe (self, line, text, sizeof text); line++)
        printf ("  %-18s  %s\n", line ? "" : "bonds", text);
    if (!all->solver) force->free (&self);
}

/* Prints the bounding box of the body, and thickness or cross section, with a remark if the scene gives none.
 * width: of the first column; 0: none. */
static void print_box (const pg_problem *q, int width)
{
    double low[3], high[3];
    pg_problem_box (q, low, high);
    printf ("  %-*s", width, q->lattice.dim ? "body" : "points within");
    for (int k = 0; k < q->dim; k++)
        printf ("%s%c %.6g to %.6g m", k ? ", " : " ", "xyz"[k], low[k], high[k]);
    if (q->dim < 3)
        printf ("; %s %.6g m%s%s", q->dim == 2 ? "thickness" : "cross section", q->cloud.thickness,
                q->dim == 2 ? "" : "^2", q->quality.thickness_assumed ? " (the scene gives none)" : "");
    printf ("\n");
}

static void print_notes (const pg_problem *p, const pg_solver_options *o)
{
    char note[400];
    for (size_t k = 0; pg_solver_note (p, o, k, note, sizeof note); k++) printf ("  %s\n", note);
}

/* Prints the short form, before the progress of a run; flushed, because progress goes to the other stream.
 * Warnings that need no solver are printed now, since they help if the solver then refuses the problem. */
void plan_print (const pg_problem *p, const pg_solver_options *o, pg_statistics *doubts)
{
    char text[400];
    printf ("%s\n", p->title);
    print_box (p, 0);
    plan_passed (p);
    printf ("  %zu point%s, spacing %.6g m, %zu evaluation points, %zu bonds, %zu unknowns\n", p->cloud.n,
            p->cloud.n == 1 ? "" : "s", p->cloud.h,
            p->bonds.rows[PG_POINTS].n ? p->bonds.rows[PG_POINTS].n : p->cloud.n,
            p->bonds.first[PG_BOND_SETS], p->cloud.n * (size_t) pg_problem_unknowns (p));
    p->method->words (p, text, sizeof text);
    printf ("  %s; horizon %.6g m\n", text, p->form.approx.horizon);
    describe (p, 9);
    printf ("  solver %s%s\n", o->kind, stepping (o));
    pg_solver_doubts (doubts, p, o);
    plan_warnings (doubts, NULL);
    print_notes (p, o);
    fflush (stdout);                                   /* progress goes to the other stream */
}

/* Prints what is known only after the solver was created. Implicit solvers have no limit of the time step,
 * and nothing is printed. */
void plan_settled (const pg_solver *solver)
{
    const pg_solver_options *o = pg_solver_settled (solver);
    const char *from;
    double stable = pg_solver_stable (solver, &from);
    if ((o->flags & PG_SOLVER_EXPLICIT)) printf ("  %ld time steps of %.6g s", o->time_steps, o->dt);
    else if ((o->flags & PG_SOLVER_STAGED)) printf ("  %ld stages", PG_OWN (pg_stages_options, o)->stages);
    else return;
    if (isfinite (stable)) printf (", stable up to %.4g s (%s)", stable, from);
    printf ("\n");
    fflush (stdout);
}

/* ---- the long form ------------------------------------------------------------------------------------- */
/* Largest frequency, rad/s: measured by the solver or by --solve; else an estimate, 2 c_p / h inside the
 * body, and where supports of the stiffness beta E / h stiffen boundary points omega^2 = 2 beta E / (rho
 * h^2). Zero without densities. */
plan_times plan_times_of (const plan *p)
{
    const pg_problem *q = p->problem;
    plan_times t = { 0, 0, 0, 0 };
    double speed = 0, stiff = 0;
    double support = q->method->support_stiffness ? q->method->support_stiffness (q) : 0;
    for (size_t m = 0; m < q->at.nlaw; m++) {
        if (!(q->at.law[m].density > 0)) return t;
        speed = fmax (speed, pg_material_waves (&q->at.law[m]).pressure);
        stiff = fmax (stiff, q->at.law[m].modulus / q->at.law[m].density);
    }
    t.omega = fmax (2 * speed, sqrt (2 * support * stiff)) / pg_cloud_finest (&q->cloud);
    if (isfinite (p->stable)) {
        t.omega = 2 / p->stable, t.dt = p->stable, t.measured = 2;
        t.courant = !(p->options->flags & PG_SOLVER_QUASI_STATIC)
                        ? speed * p->options->dt / pg_cloud_finest (&q->cloud)
                        : 0;
        return t;
    }
    if (p->first->omega > 0) t.omega = p->first->omega, t.measured = 1;
    t.dt = 2 / t.omega;
    t.courant = !(p->options->flags & PG_SOLVER_QUASI_STATIC) && p->options->dt > 0
                    ? speed * p->options->dt / pg_cloud_finest (&q->cloud)
                    : 0;
    return t;
}

/* Appends an entry unless the list is full; how many seconds it saves is not known beforehand. */
static void add_skip (pg_skip *skip, size_t *n, size_t most, const char *what, const char *why)
{
    if (*n == most) return;
    snprintf (skip[*n].what, sizeof skip[*n].what, "%s", what);
    snprintf (skip[*n].why, sizeof skip[*n].why, "%s", why);
    skip[(*n)++].seconds_saved = 0;
}

/* A reason for which a run leaves something out. */
typedef struct { int applies; const char *what, *why; } reason;

/* Lists the work that the run will skip, as far as that is known before it starts: the counterpart of what
 * the solver reports afterwards (`skipped`). Entries that follow from numbers of the run itself are missing
 * here. */
size_t plan_skips (const plan *p, pg_skip *skip, size_t most)
{
    const pg_solver_options *o = p->options;
    int fails = p->problem->criterion->type != NULL, steps = (o->flags & PG_SOLVER_EXPLICIT) != 0;
    int relaxed = !steps && (o->flags & PG_SOLVER_STAGED), solves = !steps && !relaxed;
    int by_events = solves && o->event, factors = p->forecast->linear != NULL;
    int matrix = solves && factors, iterates = solves && !factors;
    int quasi_static = (o->flags & PG_SOLVER_QUASI_STATIC) != 0;
    const reason reasons[] = {
        { !fails, "bond failure", "there is no failure criterion" },
        { p->problem->form.approx.congruent && !p->problem->form.approx.refined
              && p->problem->method->shape_functions,
          "shape functions of most places",
          "places of a lattice that see their nodes alike have the same ones: evaluated once" },
        { p->problem->form.approx.congruent && p->forecast->is.shared && !p->forecast->is.interpolates
              && p->forecast->count.points + p->forecast->count.evaluation > 1000,
          "memory for the shape functions of every point",
          "points of a lattice that see their nodes alike share them" },
        { fails && !steps && !o->plain && p->problem->method->shape_functions
              && pg_problem_breaks_by_elongation (p->problem),
          "utilisation of most bonds",
          "a bond breaks by its elongation: only where the longest of a block reaches the limit they are "
          "judged" },
        { steps, "stiffness matrix and factorization", "explicit time steps need neither" },
        { steps && !o->plain, "forces and energies for rows of history.csv",
          "the step before a row leaves the forces, from which work and energy follow" },
        { relaxed, "stiffness matrix and factorization", "relaxation needs neither" },
        { by_events && !fails, "all solves but one",
          "nothing can break: the answer is linear in the load factor" },
        { by_events && fails, "load increments in which nothing breaks",
          "event stepping goes from break to break in closed form" },
        { by_events && fails && matrix && !o->plain && o->break_mode != PG_BREAK_FACET,
          "factorization after most events",
          "the factor of an earlier K and a dense system of the touched unknowns give the same answer" },
        { iterates && !quasi_static, "stiffness matrix and factorization",
          "small time step: the mass dominates, conjugate gradients need few iterations" },
        { iterates && quasi_static, "stiffness matrix and factorization",
          "conjugate gradients need neither" },
        { matrix && !quasi_static && !fails, "all factorizations but one",
          "the time step is constant and nothing breaks" },
        { matrix && quasi_static && !fails && !o->plain && !p->forecast->is.pressed
              && p->forecast->linear->factor_taking,
          "memory for K beside its factor", "nothing breaks: one factor serves the whole run" },
        { matrix && fails && !p->forecast->is.nodal, "factorization where only node-node bonds broke",
          "they do not enter K under Gauss integration" },
    };
    size_t n = 0;
    for (size_t k = 0; k < sizeof reasons / sizeof *reasons; k++)
        if (reasons[k].applies) add_skip (skip, &n, most, reasons[k].what, reasons[k].why);
    return n;
}

/* Prints volume and surface of cut cells beside the exact ones, where these are known: they show how well the
 * cells represent curved surfaces. */
static void print_cut (const pg_problem *q)
{
    double volume = 0, area = 0, exact_volume, exact_area;
    for (size_t c = 0; c < q->cells.n; c++) volume += q->cells.volume[c];
    for (size_t f = 0; f < q->cells.nfacet; f++) area += q->cells.area[f];
    printf ("  %-18s  volume %.10g m^3, surface %.10g m^2", "", volume, area);
    if (pg_body_measure (&q->body, &exact_volume, &exact_area))
        printf ("; exact %.10g m^3, %.10g m^2", exact_volume * q->cells.thickness,
                exact_area * q->cells.thickness);
    printf ("\n");
}

/* Prints the layers of cells beyond the sides of the body: rows of cells, thickness, and where they begin. */
static void print_layers (const pg_problem *q)
{
    static const char *const sides[] = {"left", "right", "bottom", "top", "back", "front"};
    for (size_t i = 0; i < q->body.nlayer; i++) {
        const pg_layer *l = &q->body.layer[i];
        const pg_set *set = pg_sets_find (&q->sets, l->name);
        printf ("  layer %-12s  %s, %d row%s of cells, %.6g m beyond %c = %.6g m, %zu points\n", l->name,
                sides[l->side], l->rows, l->rows > 1 ? "s" : "", l->rows * q->cloud.step[l->side / 2],
                "xyz"[l->side / 2], l -> face, set ? set -> npoint : 0);
    }
}

/* Names the alpha shapes whose surface is a staircase of whole cells, whatever `cells` says. */
static void print_stairs (const pg_problem *q)
{
    size_t shapes = 0;
    for (size_t i = 0; i < q->body.n; i++)
        shapes += pg_shape_meshed (&q->body.shape[i]) && pg_shape_stepped (&q->body.shape[i]);
    if (shapes)
        printf ("  %-18s  the surface of %s with a rim is a staircase of cells\n", "",
                shapes > 1 ? "the alpha shapes" : "the alpha shape");
}

/* Prints numbers of points, cells, bonds and unknowns. The mean family is that of the node-node bonds. */
static void print_counts (const plan *p)
{
    const pg_problem *q = p->problem;
    const size_t *first = q->bonds.first;
    printf ("  %-18s  %s\n", "title", q->title);
    print_box (q, 19);
    printf ("  %-18s  %zu, spacing", "points", q->cloud.n);
    for (int k = 0; k < q->dim && q->lattice.dim; k++) printf (" %.6g", q->cloud.step[k]);
    if (!q->lattice.dim) printf (" about %.6g", q->cloud.h);
    if (q->cloud.size) printf (" (locally from %.6g)", pg_cloud_finest (&q->cloud));
    size_t cut = 0;
    for (size_t c = 0; c < q->cells.n; c++) cut += q->cells.kind[c] == PG_CUT;
    printf (" m\n");
    print_layers (q);
    printf ("  %-18s  %zu", "background cells", q->cells.n);
    if (cut) printf (", of which %zu are cut by the surface", cut);
    printf (", boundary facets %zu\n", q->cells.nfacet);
    if (q->cells.cut) print_cut (q);
    print_stairs (q);
    printf ("  %-18s  %zu, on the boundary %zu\n", "evaluation points",
            q->bonds.rows[PG_POINTS].n ? q->bonds.rows[PG_POINTS].n : q->cloud.n, q->bonds.rows[PG_FACETS].n);
    printf ("  %-18s  node-node %zu, point-node %zu, facet-node %zu\n", "bonds", first[1],
            first[2] - first[1], first[3] - first[2]);
    printf ("  %-18s  %zu\n  %-18s  %.6g m = %.4g spacings, mean family %.3g points\n", "unknowns",
            q->cloud.n * (size_t) pg_problem_unknowns (q), "horizon", q->form.approx.horizon,
            q->form.approx.horizon / q->cloud.h, (double) first[1] / (double) q->cloud.n);
}

/* Prints the constants of each material and its wave speeds; Lame's constants are those of the mode (plane
 * stress has its own lambda), Rayleigh waves exist in isotropic materials with a density only. */
static void print_materials (const pg_problem *p)
{
    for (size_t k = 0; k < p->nmaterial; k++) {
        const pg_material *m = &p->material[k];
        pg_waves w = pg_material_waves (m);
        int isotropic = (m->type->can & PG_MATERIAL_ISOTROPIC) != 0;
        char text[200];
        m->type->describe (m, text, sizeof text);
        printf ("  constants %-9s %s", m->name, text);
        if (p->dim > 1 && isotropic)
            printf (", lambda %.6g Pa, mu %.6g Pa%s", w.lambda, w.mu,
                    p->mode == PG_PLANE_STRESS ? " (plane stress)" : "");
        if (m->density > 0) printf (", density %.6g kg/m3, c_p %.5g m/s", m->density, w.pressure);
        if (m->density > 0 && p->dim > 1) printf (", c_s %.5g m/s", w.shear);
        if (m->density > 0 && p->dim > 1 && isotropic) printf (", c_R %.5g m/s", w.rayleigh);
        printf ("\n");
    }
    char line[300];
    for (size_t k = 0; pg_variation_words (p, k, line, sizeof line); k++)
        printf ("  %-18s  %s\n", k ? "" : "varies", line);
}

/* Prints time steps or stages, and the stable step of explicit methods. Without shape functions the stable
 * step is known only once it has been measured. */
static void print_times (const plan *p)
{
    plan_times t = plan_times_of (p);
    const pg_solver_options *o = p->options;
    if ((o->flags & PG_SOLVER_STAGED))
        printf ("  %-18s  %ld\n", "stages", PG_OWN (pg_stages_options, o)->stages);
    else if (!(o->flags & PG_SOLVER_QUASI_STATIC) && !(o->time_steps && o->dt > 0))
        printf ("  %-18s  0.9 of the stable one\n", "time steps");
    else if (!(o->flags & PG_SOLVER_QUASI_STATIC)) {
        printf ("  %-18s  %ld of %.6g s", "time steps", o->time_steps ? o->time_steps : o->steps, o->dt);
        if (t.courant > 0) printf (", c_p dt / h = %.4g", t.courant);
        printf ("\n");
    }
    if (t.omega > 0 && (p->problem->method->shape_functions || t.measured))
        printf ("  %-18s  stable up to %.3g s (%s)\n", "explicit steps", t.dt,
                t.measured == 2 ? p->from
                : t.measured    ? "2 / largest frequency"
                                : "estimate; measured by --solve");
}

/* Prints the linear solver and the size of its factor; "analysed" numbers are exact, others are estimates.
 * Seconds at 20 GFLOP/s are a rough measure only. */
static void print_factor (const pg_forecast *f)
{
    printf ("  %-18s  %s", "linear solver",
            f->linear      ? f->linear->name
            : f->is.dynamic   ? "conjugate gradients, no matrix\n"
            : f->is.elements  ? "conjugate gradients, no matrix, preconditioned by finite elements\n"
            : f->method->shape_functions ? "conjugate gradients, no matrix\n"
                           : "conjugate gradients, no matrix, preconditioned on several grids\n");
    if (!f->linear) return;
    printf (", %.4g entries in the upper triangle of K\n", f->matrix_entries);
    printf ("  %-18s  %.4g entries, %.3g operations, about %.2g s each at 20 GFLOP/s (%s%s)\n", "factor",
            f->factor_entries, f->factor_flops, f->factor_flops / 20e9,
            f->is.analysed ? "analysed: " : "estimate", f->is.analysed ? f->ordering : "");
}

/* Prints bytes with three digits in MB, GB or TB (powers of 1000); the limits avoid "1e+03 MB". */
static void print_bytes (double bytes)
{
    if (bytes < 999.5e6) printf ("%.3g MB", bytes * 1e-6);
    else if (bytes < 999.5e9) printf ("%.3g GB", bytes * 1e-9);
    else printf ("%.3g TB", bytes * 1e-12);
}

/* Prints the forecast of memory and what is available, then the parts above 50 kB. */
static void print_memory (const plan *p)
{
    const pg_forecast *f = p->forecast;
    printf ("  %-18s  about ", "memory");
    print_bytes (f->peak);
    if (isfinite (p->available)) printf (" of "), print_bytes (p->available), printf (" available");
    printf ("\n");
    for (int k = 0; k < PG_BYTES_COUNT; k++) {
        if (f->bytes[k] < 5e4) continue;
        printf ("    %-16s  ", pg_forecast_item (k)), print_bytes (f->bytes[k]), printf ("\n");
    }
}

/* Returns a coordinate, or 0 if it differs from 0 by rounding only. */
static double tidy (const plan *p, double x) { return fabs (x) < 1e-9 * p->problem->cloud.h ? 0 : x; }

/* Prints for every open crack tip (2D): stress intensity factors and energy release rate under the full load,
 * and how well the latter is known from two rings of integration. */
static void print_tips (const plan *p)
{
    const pg_first_break *b = p->first;
    const double one = 1;
    if (!b->solved || b->ntip == 0) return;
    if (b->refused) printf ("  %-18s  no stress intensity factors: %s\n", "crack tips", b->refused);
    for (size_t t = 0; !b->refused && t < b->ntip && t < PG_FIRST_TIPS; t++) {
        const pg_tip_field *f = &b->tip[t];
        char name[32];
        snprintf (name, sizeof name, "crack tip %ld", b->id[t]);
        printf ("  %-18s  at (%.4g, %.4g) m: ", name, tidy (p, f->x[0]), tidy (p, f->x[1]));
        if (isnan (f->near)) {
            printf ("no stress intensity factors: a ring needs %.3g m, there is room for %.3g m\n",
                    1.5 * f->h, f->room);
            continue;
        }
        double K[3];
        pg_tip_intensities (f, 1, &one, K);
        printf ("K_I %.5g, K_II %.4g Pa m^(1/2), J %.5g J/m^2", K[0], K[1], f->J[0][0]);
        double off = pg_tip_uncertainty (f, 1, &one);
        if (isnan (off)) printf (" (one ring of %.2g spacings)", f->near / f->h);
        else
            printf (" (+-%.2g %%, rings of %.2g and %.2g spacings)", 100 * off, f->near / f->h,
                    f->wide / f->h);
        if (f->closed) printf (", closed\n");
        else printf (", T %.4g Pa\n", f->T[0]);
    }
    if (b->ntip > PG_FIRST_TIPS && !b->refused)
        printf ("  %-18s  %zu more tips\n", "crack tips", b->ntip - PG_FIRST_TIPS);
}

/* Prints for every crack front (3D): the ranges of J and of the stress intensity factors under the full
 * load. */
static void print_fronts (const plan *p)
{
    const pg_first_break *b = p->first;
    if (!b->solved || b->nfront == 0) return;
    if (b->refused) printf ("  %-18s  no stress intensity factors: %s\n", "crack fronts", b->refused);
    for (size_t t = 0; !b->refused && t < b->nfront && t < PG_FIRST_TIPS; t++) {
        const pg_first_front *f = &b->front[t];
        char name[32];
        snprintf (name, sizeof name, "crack front %ld", f->id);
        printf ("  %-18s  %s of %.4g m, %zu vertices: ", name, f->closed ? "loop" : "line", f->length, f->n);
        if (f->measured == 0) {
            printf ("no stress intensity factors: there is no room for a tube around it\n");
            continue;
        }
        if (f->measured < f->n) printf ("%zu of them with room; ", f->measured);
        printf ("J %.4g to %.4g J/m^2, mean %.4g, largest at (%.4g, %.4g, %.4g) m", f->J[0], f->J[2], f->J[1],
                tidy (p, f->x[0]), tidy (p, f->x[1]), tidy (p, f->x[2]));
        static const char *const mode[3] = { "I", "II", "III" };
        for (int m = 0; m < 3; m++)
            printf ("%s K_%s %.4g to %.4g", m ? "," : ";", mode[m], f->K[m][0], f->K[m][1]);
        printf (" Pa m^(1/2)\n");
    }
    if (b->nfront > PG_FIRST_TIPS && !b->refused)
        printf ("  %-18s  %zu more fronts\n", "crack fronts", b->nfront - PG_FIRST_TIPS);
}

/* Prints fracture energy and strength of the materials, and the spacing at which strength can be told from
 * fracture energy: the zone E G0 / f_t^2 in which a material fails should be 8 spacings long. */
static void print_toughness (const pg_problem *p)
{
    double x[3] = { 0 };
    for (int k = 0; k < p->dim; k++) x[k] = 0.5 * (p->cloud.low[k] + p->cloud.high[k]);
    for (size_t m = 0; m < p->nmaterial; m++) {
        const pg_criterion *c = &p->criterion[m];
        pg_fracture_limits limits = { .strength = NAN, .cohesion = NAN };
        pg_strength s;
        if (!c->type || c->never) continue;
        c->type->fracture (c, x, 0, &limits);
        printf ("  fracture %-10s %.4g J/m^2", p->material[m].name, limits.energy);
        double zone = p->material[m].modulus * limits.energy / (limits.strength * limits.strength);
        if (zone > 0)
            printf (", strength %.4g Pa (in use %.4g Pa): a zone of %.3g m, new cracks need a spacing of "
                    "at most "
                    "%.3g m", limits.strength, pg_strength_of (p, m, &s) ? s.in_use : limits.strength, zone,
                    zone / 8);
        zone = p->material[m].modulus * limits.shear / (limits.cohesion * limits.cohesion);
        if (zone > 0)
            printf (", cohesion %.4g Pa, sliding %.4g J/m^2: a zone of %.3g m, new cracks in shear need a "
                    "spacing of at most %.3g m", limits.cohesion, limits.shear, zone, zone / 8);
        printf ("\n");
    }
}

/* 1: J is known at all crack tips, in 3D around all fronts. */
static int knows_tips (const pg_first_break *b)
{
    if (b->refused) return 0;
    for (size_t t = 0; t < b->ntip && t < PG_FIRST_TIPS; t++) if (isnan (b->tip[t].near)) return 0;
    for (size_t t = 0; t < b->nfront && t < PG_FIRST_TIPS; t++) if (b->front[t].measured == 0) return 0;
    return 1;
}

/* Prints when and where the first facet grows, for a criterion that is evaluated at crack tips. */
static void print_first_growth (const plan *p)
{
    const pg_first_break *b = p->first;
    print_toughness (p->problem);
    if (!p->options->event) {
        printf ("  %-18s  not known before a run with fixed load steps\n", "first growth");
        return;
    }
    if (!isfinite (b->factor)) {
        printf ("  warning: no crack grows under these loads up to load factor 1%s\n",
                !knows_tips (b) ? "; J is not known at every tip, and nothing is said of larger ones"
                : b->proportional ? ", and none would under larger ones" : "");
        return;
    }
    printf ("  %-18s  at load factor %.5g", "first growth", b->factor);
    int space = p->problem->dim == 3;
    if (b->grows && b->grown) printf (", crack %s %ld", space ? "front" : "tip", b->grown);
    else if (b->grows) printf (", a new crack");
    if (b->grows && space)
        printf (" comes to (%.4g, %.4g, %.4g) m", tidy (p, b->to[0]), tidy (p, b->to[1]), tidy (p, b->to[2]));
    else if (b->grows)
        printf (" from (%.4g, %.4g) to (%.4g, %.4g) m", tidy (p, b->from[0]), tidy (p, b->from[1]),
                tidy (p, b->to[0]), tidy (p, b->to[1]));
    printf ("\n");
    if (b->factor > 1)
        printf ("  warning: nothing grows up to load factor 1: the first facet needs %.4g times this load\n",
                b->factor);
}

/* Prints the first break that --solve found. A load factor above 1 means that nothing breaks under the full
 * load, which gives a warning, as does a criterion that no load can reach. */
static void print_first_break (const plan *p)
{
    static const char *const sets[PG_BOND_SETS] = { "node-node", "point-node", "facet-node" };
    const pg_first_break *b = p->first;
    if (!b->asked) return;
    if (!b->is_static) printf ("  %-18s  only for static scenes\n", "first break");
    if (!b->solved) return;
    printf ("  %-18s  largest displacement %.4g m, residual %.1e\n", "load factor 1", b->displacement,
            b->residual);
    if (!p->problem->criterion->type) {
        printf ("  %-18s  none: there is no failure criterion\n", "first break");
        return;
    }
    if (pg_criterion_of_tips (p->problem->criterion)) {
        print_first_growth (p);
        return;
    }
    if (!isfinite (b->factor)) {
        printf ("  warning: no bond can break under these loads, however large: nothing that may break is "
                "stretched or sheared (see failure.exclude)\n");
        return;
    }
    if (b->proportional) printf ("  %-18s  at load factor %.5g", "first break", b->factor);
    else printf ("  %-18s  largest utilisation %.5g at load factor 1", "first break", b->utilisation);
    printf (", a %s bond %s at (%.4g", sets[b->set],
            b->kind == 's'   ? "in shear"
            : b->kind == 'e' ? "by the energy of an end"
                             : "in tension",
            b->place[0]);
    for (int k = 1; k < p->problem->dim; k++) printf (", %.4g", b->place[k]);
    printf (") m\n");
    if (b->factor > 1)
        printf ("  warning: nothing breaks up to load factor 1: the first bond needs %.4g times this load\n",
                b->factor);
}

/* Prints the error of the patch test: how far the discretization is from reproducing a uniform strain. */
static void print_patch (const pg_problem *p)
{
    char words[240];
    if (!p->quality.patch.measured) return;
    pg_patch_words (p, words, sizeof words);
    printf ("  %-18s  %s (%s)\n", "patch test", words,
            p->quality.patch.held ? "outermost points constrained" : "tractions on the whole surface");
}

/* Says what check has not tried: for a large body the start of a run costs as much as its first minutes. */
static void print_untried (const plan *p)
{
    if (!p->begun)
        printf ("  %-18s  %s of more than %g points: what a run may refuse there\n", "not tried",
                plan_untried, PLAN_MOST_TRIED);
}

/* Prints all that check has found, in the order geometry, method, materials, solver, memory, warnings, first
 * break. */
void plan_print_long (const plan *p)
{
    const pg_problem *q = p->problem;
    pg_skip skip[8];
    size_t nskip = plan_skips (p, skip, 8);
    print_counts (p);
    plan_mesh (q);
    plan_network (p->network);
    print_method (p);
    print_patch (q);
    describe (q, 19);
    print_materials (q);
    printf ("  %-18s  %s%s\n", "solver", p->options->kind, stepping (p->options));
    print_times (p);
    if (!(p->options->flags & PG_SOLVER_EXPLICIT) && !(p->options->flags & PG_SOLVER_STAGED))
        print_factor (p->forecast);
    for (size_t i = 0; i < q->boundary.nplaten; i++)
        printf ("  platen %-11s  %s%s\n", q->boundary.platen[i].name,
                q->boundary.platen[i].shape == PG_PLATEN_PLANE      ? "plane"
                : q->boundary.platen[i].shape == PG_PLATEN_CYLINDER ? "cylinder"
                                                           : "sphere",
                q->boundary.platen[i].concave ? ", concave" : "");
    for (size_t s = 0; s < q->boundary.nload; s++)
        if (!q->boundary.load[s].platen)
            printf ("  boundary %-9s  %zu points, %zu facets\n", q->boundary.load[s].name,
                    q->boundary.load[s].set->npoint, q->boundary.load[s].set->nfacet);
    if (q->crack.eroded)
        printf ("  %-18s  %zu points lie on a pre-crack and lose their bonds to both sides\n", "eroded",
                q->crack.eroded);
    for (size_t k = 0; k < nskip; k++) printf ("  %-18s  %s (%s)\n", "skipped", skip[k].what, skip[k].why);
    print_memory (p);
    print_untried (p);
    plan_warnings (p->warned, NULL);
    print_notes (q, p->options);
    print_first_break (p);
    print_tips (p);
    print_fronts (p);
}

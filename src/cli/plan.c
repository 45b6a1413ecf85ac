/* SPDX-License-Identifier: GPL-3.0-or-later
 * What a scene amounts to, in words: before a run, and at length for check. */
#include "cli.h"
#include <string.h>

static const char *stepping (const pg_solver_options *o)
{
    return strcmp (o->kind, "static") ? "" : o->event ? ", event stepping" : ", fixed load steps";
}

static void describe (const pg_problem *p, char *text, size_t size)
{
    snprintf (text, size, "none: nothing breaks");
    if (p->criterion.type) p->criterion.type->describe (&p->criterion, text, size);
}

static int acts (const pg_problem *p, const pg_load *load, int k, double end)
{
    if (!load->value[k]) return 0;
    if (!pg_load_prescribes (load) || load->set->npoint == 0) return 1;
    for (size_t i = 0; i < load->set->npoint; i++)
        if (pg_load_value (load, k, p->dim, p->cloud.x + (size_t) load->set->point[i] * (size_t) p->dim, end) != 0) return 1;
    return 0;
}

/* What is legal, yet hardly meant. */
void plan_doubts (const pg_problem *p, const pg_solver_options *o, FILE *to)
{
    int is_static = strcmp (o->kind, "static") == 0, moving = 0;
    for (int k = 0; k < p->dim; k++) {
        int held = !is_static;
        for (size_t l = 0; l < p->nload; l++) {
            held |= pg_load_prescribes (&p->load[l]) && p->load[l].value[k];
            moving |= acts (p, &p->load[l], k, is_static ? 1 : o->end) || p->load[l].kind == PG_PRESSURE;
        }
        if (!held) fprintf (to, "  warning: nothing holds the body along %c: no displacement along %c is prescribed anywhere\n", "xyz"[k], "xyz"[k]);
    }
    if (!moving) fprintf (to, "  warning: nothing loads the body: every prescribed displacement is zero, and there is no force\n");
}

void plan_print (const pg_problem *p, const pg_solver_options *o)
{
    char text[512];
    describe (p, text, sizeof text);
    printf ("%s\n", p->title);
    printf ("  %zu points, spacing %.6g m, %zu evaluation points, %zu bonds, %zu unknowns\n", p->cloud.n, p->cloud.h,
            p->rows[PG_POINTS].n ? p->rows[PG_POINTS].n : p->cloud.n, p->first_bond[PG_BOND_SETS], p->cloud.n * (size_t) p->dim);
    printf ("  %s (%s basis, %s kernel, horizon %.6g m), %s integration\n", p->approx.type->name, p->approx.order == 2 ? "quadratic" : "linear",
            p->approx.kernel->name, p->approx.horizon, p->integration->name);
    printf ("  criterion %s\n", text);
    if (p->eroded) printf ("  %zu points lie on a pre-crack and lose their bonds to both sides\n", p->eroded);
    printf ("  solver %s%s\n", o->kind, stepping (o));
    plan_doubts (p, o, stdout);
    fflush (stdout);                                   /* progress goes to the other stream */
}

void plan_print_long (const pg_problem *p, const pg_solver_options *o)
{
    char text[512];
    const size_t *first = p->first_bond;
    describe (p, text, sizeof text);
    printf ("  %-18s  %s\n  %-18s  %zu, spacing", "title", p->title, "points", p->cloud.n);
    for (int k = 0; k < p->dim && p->lattice.dim; k++) printf (" %.6g", p->cloud.step[k]);
    if (!p->lattice.dim) printf (" about %.6g", p->cloud.h);
    printf (" m\n  %-18s  %zu, boundary facets %zu\n", "background cells", p->cells.n, p->cells.nfacet);
    printf ("  %-18s  node-node %zu, point-node %zu, facet-node %zu\n", "bonds", first[1], first[2] - first[1], first[3] - first[2]);
    printf ("  %-18s  %zu\n  %-18s  %.6g m = %.4g spacings\n", "unknowns", p->cloud.n * (size_t) p->dim, "horizon", p->approx.horizon,
            p->approx.horizon / p->cloud.h);
    printf ("  %-18s  %s, %s basis, %s kernel, %s integration\n", "method", p->approx.type->name, p->approx.order == 2 ? "quadratic" : "linear",
            p->approx.kernel->name, p->integration->name);
    printf ("  %-18s  %s\n  %-18s  %s%s\n", "criterion", text, "solver", o->kind, stepping (o));
    for (size_t s = 0; s < p->nload; s++)
        printf ("  boundary %-9s  %zu points, %zu facets\n", p->load[s].name, p->load[s].set->npoint, p->load[s].set->nfacet);
    if (p->eroded) printf ("  %-18s  %zu points lie on a pre-crack and lose their bonds to both sides\n", "eroded", p->eroded);
    plan_doubts (p, o, stdout);
}

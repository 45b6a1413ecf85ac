/* SPDX-License-Identifier: GPL-3.0-or-later
 * method.dilatation: selects the materials whose dilatation is projected onto patches (doc/method.md,
 * "Poisson's ratio near 1/2"), and warns of those that should be. */
#include "model.h"
#include <string.h>

/* lambda / mu from which the dilatation is projected, that of Poisson's ratio 0.45: there the stresses of a
 * thick cylinder (ten cells through its wall, linear basis) are 5 % off with the dilatation at the points,
 * three times as much as at 0.3; at 0.49 they are 20 % off, at 0.4999 ten times too large. */
static const double stiff = 9;

static double shear_of (const pg_material *m) { return m->D[m->mode == PG_SOLID ? 21 : 8]; }
/* Poisson's ratio of 0.45 and more: lambda is nine times mu. */
static int nearly_incompressible (const pg_material *m)
{
    return m->lambda > 0 && m->lambda >= stiff * (1 - 1e-9) * shear_of (m);
}

/* Warns of materials near Poisson's ratio 1/2 whose dilatation is not projected, with state-based forces or
 * `pointwise`. */
static void warn (pg_problem *p, const char *mode)
{
    for (size_t m = 0; m < p->nmaterial; m++) {
        const pg_material *a = &p->material[m];
        int state = p->sums && p->sums->rule.state;
        if (!nearly_incompressible (a)) continue;
        if (state)
            pg_problem_note (p,
                             "warning: material %.40s: Poisson's ratio is near 1/2, and force: %s takes the "
                             "dilatation at every point: it locks, pressures "
                             "oscillate, and large systems may not converge: use force: galerkin",
                             a->name, p->method->name);
        else if (p->method->shape_functions && strcmp (mode, "pointwise") == 0)
            pg_problem_note (p,
                             "warning: material %.40s: Poisson's ratio is near 1/2, and with "
                             "method.dilatation: pointwise the body locks: too stiff, with wrong "
                             "pressures: use projected or auto",
                             a->name);
    }
}

/* The points where the weak form is evaluated, and their bond set. */
static const pg_rows *points_of (const pg_problem *p, int *set)
{
    *set = p->form.integration->at_nodes ? PG_NODES : PG_POINTS;
    return &p->bonds.rows[*set];
}

/* Reports that a modulus varying with position cannot be combined with a projected dilatation. */
static void refuse_graded (const pg_material *m, const pg_scene *scene)
{
    char path[128];
    snprintf (path, sizeof path, "materials.%.63s.youngs_modulus", m->name);
    pg_scene_fault (scene, path, "must be one number where the dilatation is projected, as at this Poisson's "
                    "ratio: every patch has one bulk modulus; use method.dilatation: pointwise, or blocks");
}

/* Makes the patches for the lambda of materials that need them; the rest of D is evaluated at the points. */
pg_status pg_dilatation_build (pg_problem *p, const pg_scene *scene)
{
    pg_status status = PG_OK;
    const char *mode = pg_scene_text (scene, "method.dilatation");
    double *lambda = NULL;
    size_t some = 0;
    int set;
    warn (p, mode);
    if (!p->method->shape_functions || p->dim == 1 || strcmp (mode, "pointwise") == 0) return PG_OK;
    PG_ALLOC (lambda, p->nmaterial);
    for (size_t m = 0; m < p->nmaterial; m++) {
        int wanted = p->material[m].lambda > 0
                     && (strcmp (mode, "projected") == 0 || nearly_incompressible (&p->material[m]));
        if (wanted) lambda[m] = p->material[m].lambda, some++;
        if (wanted && p->at.vary[m].of[PG_OF_STIFFNESS]) refuse_graded (&p->material[m], scene);
    }
    if (some && pg_ranks_now () && !p->lattice.dim)
        pg_scene_fault (scene, "method.dilatation",
                        "%d ranks: patches of points that no lattice gives are chosen one after the other, "
                        "by one process only so far: use pointwise, or division: matrices",
                        pg_rank_count ());
    PG_TRY (pg_scene_verdict (scene));
    if (!some) goto done;
    const pg_rows *points = points_of (p, &set);
    pg_patch_source source = { .points = points,
                               .family = p->form.consistency ? &p->form.consistency->family : &points->family,
                               .cloud = &p->cloud,
                               .cells = p->form.integration->at_nodes ? NULL : &p->cells,
                               .lattice = p->lattice.dim ? &p->lattice : NULL,
                               .centred = p->lattice.dim
                                          && strcmp (pg_scene_text (scene, "lattice"), "cells") == 0,
                               .block = p->block[set],
                               .spacing = p->bonds.spacing[set],
                               .across = p->form.integration->at_nodes ? 3 : 2,
                               .materials = p->nmaterial,
                               .lambda = lambda };
    PG_TRY (pg_patches_create (&p->form.patches, &source));
    pg_problem_note (p,
                     "dilatation projected: linear in each of %zu patches of about %d %s per axis, against "
                     "locking (Poisson's ratio near 1/2%s)",
                     p->form.patches->n, source.across, source.cells ? "cells" : "points",
                     some < p->nmaterial ? "; not in all materials" : "");
done:
    pg_free (lambda);
    return status;
}

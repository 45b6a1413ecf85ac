/* SPDX-License-Identifier: GPL-3.0-or-later
 * Strains without stress: temperature by the coefficient of expansion, shrinkage, pore pressure by Biot's
 * coefficient, the same along all axes. Pore pressure p reduces the mean stress by b p, which is equivalent
 * to a free strain b p / (3 K), K the bulk modulus. */
#include "model.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static const char *const keys[] = { "temperature", "shrinkage", "pore_pressure" };
static const char *const units[] = { "K", "1", "Pa" };

/* Factor from the value of the load to the free strain in material m; reports an error if a constant is
 * missing. */
static double factor_of (const pg_problem *p, const pg_scene *scene, const pg_material *m, int what,
                         const char *path)
{
    char key[96];
    if (what == 1) return -1;
    if (what == 0) {
        snprintf (key, sizeof key, "materials.%s.expansion", m->name);
        if (pg_scene_given (scene, "%s", key)) return pg_scene_number (scene, "%s", key);
        pg_scene_fault (scene, path, "needs the coefficient of expansion of every material (%s: 1e-5 1/K)",
                        key);
        return 0;
    }
    if (pg_problem_graded (p)) {
        pg_scene_fault (scene, path, "does not go with a stiffness by place so far: give several materials");
        return 0;
    }
    if (!(m->E > 0)) {
        pg_scene_fault (scene, path, "needs isotropic materials: Biot's coefficient of %s would be a "
                                     "tensor", m->name);
        return 0;
    }
    return pg_scene_number (scene, "materials.%s.biot", m->name) * (1 - 2 * m->nu) / m->E;
}

/* Reports methods and options that do not support free strains as errors. */
static void check_method (const pg_problem *p, const pg_scene *scene, const char *path)
{
    if (!p->method->shape_functions)
        pg_scene_fault (scene, path,
                        "force: %s has no free strains so far: use force: galerkin", p->method->name);
    else if (pg_problem_grows (p))
        pg_scene_fault (scene, path,
                        "the energy release rate of tips does not know free strains so far: take criterion: "
                        "principal_stress, mohr_coulomb or stretch");
    if (strcmp (pg_scene_text (scene, "method.dilatation"), "projected") == 0)
        pg_scene_fault (scene, path, "does not go with method.dilatation: projected so far: use pointwise");
    for (size_t m = 0; m < p->nmaterial; m++) {
        if (!(p->material[m].E > 0) && p->mode == PG_PLANE_STRAIN)
            pg_scene_fault (scene, path,
                            "in plane strain needs isotropic materials, which %s is not: use plane: stress "
                            "or a solid",
                            p->material[m].name);
        if (p->material[m].nu >= 0.45 && p->mode != PG_PLANE_STRESS && p->dim > 1
            && strcmp (pg_scene_text (scene, "method.dilatation"), "auto") == 0)
            pg_scene_fault (scene, path,
                            "%s has a Poisson's ratio of 0.45 or more, whose dilatation is projected, "
                            "which does "
                            "not know free strains so far: method.dilatation: pointwise",
                            p->material[m].name);
    }
}

pg_status pg_load_read_eigenstrain (const pg_problem *p, pg_load *load, const pg_scene *scene, size_t i)
{
    pg_status status = PG_OK;
    char path[64];
    int what = 0;
    while (!pg_scene_given (scene, "boundary[%zu].%s", i, keys[what])) what++;
    if (load->set->npoint < p->cloud.n) {
        snprintf (path, sizeof path, "boundary[%zu].set", i);
        pg_scene_fault (scene, path, "%s acts everywhere: leave the set out, and say where by the "
                                     "expression, such as "
                        "step (x - 1 mm) * 20", keys[what]);
    }
    snprintf (path, sizeof path, "boundary[%zu].%s", i, keys[what]);
    check_method (p, scene, path);
    PG_ALLOC (load->per_material, p->nmaterial);
    for (size_t m = 0; m < p->nmaterial; m++)
        load->per_material[m] = factor_of (p, scene, &p->material[m], what, path);
    PG_TRY (pg_expression_compile (&load->value[0], pg_scene_text (scene, "%s", path), units[what]));
    if (load->value[0] && pg_expression_uses (load->value[0], 't')) load->proportional = 0;
done:
    return status;
}

int pg_problem_strained (const pg_problem *p)
{
    for (size_t l = 0; l < p->boundary.nload; l++) if (p->boundary.load[l].kind == PG_EIGENSTRAIN) return 1;
    return 0;
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * Before anything large is allocated: how much memory will the run need, and is there that
 * much? A run that the machine cannot hold would otherwise be killed by the system after an
 * hour, without a word.
 *
 * The answer comes in two stages: from the scene alone (counts of points and neighbours), then
 * from the built problem, with the exact size of the matrix factor by a symbolic analysis if
 * memory may be short. */
#include "cli.h"
#include "perigal/linalg.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* Memory in bytes: --memory, or what pg_available_memory finds from the machine and the limits of the
 * process. */
double afford_available (const command *c) { return c->memory > 0 ? c->memory : pg_available_memory (""); }

/* 1: the mesh file has less than 300 kB, some thousand elements. */
int afford_tiny (const pg_scene *scene)
{
    char *path = NULL;
    struct stat s;
    if (!pg_scene_given (scene, "mesh.file")) return 0;
    int tiny = pg_scene_beside (&path, scene, pg_scene_text (scene, "mesh.file")) == PG_OK
               && stat (path, &s) == 0 && s.st_size < 300000;
    pg_free (path);
    return tiny;
}

/* Forecasts from the scene alone, before the problem is built. It loads a scene of its own, so that faults
 * are reported once, when the problem is built. A partial scene, which has faults already, is ended here if
 * its geometry is too large to be built only to find more faults. */
pg_status afford_scene (const command *c, pg_forecast *f)
{
    pg_status status = PG_OK;
    pg_scene *scene = NULL;
    memset (f, 0, sizeof *f);
    PG_TRY (command_scene (c, &scene));
    status = pg_forecast_scene (f, scene, pg_force_methods ());
    if (pg_scene_partial (scene)) {  /* its geometry is built to look for more faults, if it is small */
        if (f->count.points > 3e5) status = pg_scene_conclude (scene);
        else status = PG_OK;
        memset (f, 0, sizeof *f);
        goto done;
    }
    if (status == PG_E_SCENE || status == PG_E_FILE) {
        memset (f, 0, sizeof *f);
        status = PG_OK;
        goto done;
    }
    PG_TRY (status);
    PG_TRY (pg_forecast_afford (f, afford_available (c)));
done:
    pg_scene_free (&scene);
    return status;
}

/* Computes ordering and symbolic factor of the graph of nodes as the linear solver will, with everything that
 * couples nodes: families, facets of Nitsche supports, patches of the dilatation. Eliminated supports couple
 * a few more nodes than the graph has, so the result is then not called exact. */
static pg_status analyse (pg_forecast *f, const pg_problem *p)
{
    pg_status status = PG_OK;
    pg_sparse G = { 0 };
    pg_linear_info info;
    const pg_family *seen[3] = { p->form.consistency ? &p->form.consistency->cell_family
                                                : &p->bonds.rows[f->is.nodal ? PG_NODES : PG_POINTS].family,
                                 &p->bonds.rows[PG_FACETS].family };
    size_t pinned = 0, n = 1;
    for (size_t l = 0; l < p->boundary.nload; l++)
        pinned += pg_load_prescribes (&p->boundary.load[l])
                  && p->boundary.load[l].essential == PG_ESSENTIAL_NITSCHE;
    n += pinned > 0;
    if (p->form.patches) seen[n++] = &p->form.patches->family;
    if (p->sums) PG_TRY (pg_assembly_graph_pairwise (&G, &p->bonds.rows[PG_NODES].family));
    else PG_TRY (pg_assembly_graph (&G, p->cloud.n, n, seen));
    int unknowns = pg_problem_unknowns (p), many = p->criterion && p->criterion->type;
    PG_TRY (pg_linear_forecast (&G, unknowns, many, &info));
    pg_forecast_analysed (f, (double) G.start[G.ncol], info.ordering, info.factor_entries, info.flops);
    if (f->count.slaves > 0) f->is.analysed = 0; /* elimination couples neighbours: a little more */
done:
    pg_sparse_clear (&G);
    return status;
}

/* Forecasts from the built problem; a symbolic analysis replaces the estimate of the factor if it is asked
 * for, or if the estimate exceeds half of the memory. Beyond 3e5 points the analysis itself takes tens of
 * seconds and is left out. */
pg_status afford_problem (const command *c, pg_forecast *f, const pg_problem *p, int thorough)
{
    static const double most = 3e5;                    /* most points that are analysed: ten seconds */
    pg_status status = PG_OK;
    double available = afford_available (c);
    PG_TRY (pg_forecast_problem (f, p));
    int close = f->peak > 0.5 * available;
    if ((thorough || close) && f->count.points <= most && f->linear && f->linear->symmetric)
        PG_TRY (analyse (f, p));
    PG_TRY (pg_forecast_afford (f, available));
done:
    return status;
}

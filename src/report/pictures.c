/* SPDX-License-Identifier: GPL-3.0-or-later
 * Pictures of the last state and the load-displacement curve. */
#include "result.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

const char *result_voigt (int dim, int k)
{
    static const char *const part[4][6] = { { "" }, { "xx" }, { "xx", "yy", "xy" }, { "xx", "yy", "zz", "xy", "yz", "zx" } };
    return part[dim][k];
}

/* "stress.xx" -> component; -1: magnitude of a vector, or the only one */
static int part_of (const char *dot, int dim, int components)
{
    if (!dot) return components == 1 ? 0 : components == dim ? -1 : 0;
    if (components == dim && dot[1] && !dot[2]) return dot[1] >= 'x' && dot[1] < 'x' + dim ? dot[1] - 'x' : -2;
    for (int k = 0; k < components; k++) if (strcmp (dot + 1, result_voigt (dim, k)) == 0) return k;
    return -2;
}

static pg_status one_picture (pg_result *r, const pg_state *state, const char *name, double *value, double *u)
{
    pg_status status = PG_OK;
    const pg_problem *p = r->problem;
    void *self;
    const pg_force_type *force = pg_solver_force (r->solver, &self);
    const char *dot = strchr (name, '.'), *unit;
    char field[32], label[96], title[320];
    int components, uc;
    double *one = NULL;
    snprintf (field, sizeof field, "%.*s", (int) (dot ? (size_t) (dot - name) : strlen (name)), name);
    PG_TRY (force->field (self, state, state->d, field, &components, &unit, value));
    int part = components ? part_of (dot, p->dim, components) : -2;
    if (part == -2) PG_FAIL (PG_E_USAGE, "output.pictures: there is no field %s", name);
    PG_ALLOC (one, p->cloud.n);
    for (size_t i = 0; i < p->cloud.n; i++) {
        double s = 0;
        for (int k = 0; k < components; k++) s += value[i * (size_t) components + (size_t) k] * value[i * (size_t) components + (size_t) k];
        one[i] = part < 0 ? sqrt (s) : value[i * (size_t) components + (size_t) part];
    }
    PG_TRY (force->field (self, state, state->d, "displacement", &uc, &(const char *) { NULL }, u));
    int damage = strcmp (field, "damage") == 0;
    snprintf (label, sizeof label, "%s%s%s%s", name, *unit ? " (" : "", unit, *unit ? ")" : "");
    snprintf (title, sizeof title, "%s, load factor %.4g", p->title, state->factor);
    pg_picture_style style = { .title = title, .label = label, .high = damage ? 1 : 0, .diverging = strcmp (field, "stress") == 0,
                               .magnify = r->magnify, .u = u, .cracks = &p->cracks };
    char path[4096];
    snprintf (path, sizeof path, "%s/%s.png", r->folder, name);
    PG_TRY (pg_picture_field (path, &p->cloud, one, &style));
    memcpy (r->written[r->nwritten++], path, sizeof path);
done:
    pg_free (one);
    return status;
}

/* What a test with rising displacement sees: the steps that pass every displacement before them. Starts at rest. */
static size_t envelope (const pg_result *r, double *x, double *y)
{
    size_t n = 1;
    for (size_t k = 0; k < r->npoint; k++) if (r->curve_x[k] > x[n - 1]) x[n] = r->curve_x[k], y[n++] = r->curve_y[k];
    return n;
}

static pg_status load_displacement (pg_result *r)
{
    pg_status status = PG_OK;
    double *x = NULL, *y = NULL;
    const pg_load *load = &r->problem->load[r->curve_load];
    char ylabel[128], xlabel[128];
    snprintf (ylabel, sizeof ylabel, "force of %s along %c (N)", load->name, "xyz"[r->curve_component]);
    snprintf (xlabel, sizeof xlabel, "mean displacement of %s (m)", load->name);
    PG_ALLOC (x, r->npoint + 1);
    PG_ALLOC (y, r->npoint + 1);
    size_t n = envelope (r, x, y);
    pg_curve curve[2] = { { "every step", r->npoint, r->curve_x, r->curve_y, 1 }, { "at rising displacement", n, x, y, 0 } };
    pg_chart_style style = { r->problem->title, xlabel, ylabel, 0, 0 };
    char path[4096];
    snprintf (path, sizeof path, "%s/load_displacement.png", r->folder);
    PG_TRY (pg_picture_chart (path, n < r->npoint + 1 ? 2 : 1, n < r->npoint + 1 ? curve : curve + 1, &style));
    memcpy (r->written[r->nwritten++], path, sizeof path);
done:
    pg_free (x), pg_free (y);
    return status;
}

pg_status result_pictures (pg_result *r, const pg_state *state)
{
    pg_status status = PG_OK;
    double *value = NULL, *u = NULL;
    PG_ALLOC (value, 6 * r->problem->cloud.n);
    PG_ALLOC (u, 6 * r->problem->cloud.n);
    for (size_t k = 0; pg_solver_force (r->solver, NULL)->field && k < r->npicture; k++) PG_TRY (one_picture (r, state, r->picture[k], value, u));
    if (r->curve_load >= 0 && r->npoint > 1) PG_TRY (load_displacement (r));
done:
    pg_free (value), pg_free (u);
    return status;
}

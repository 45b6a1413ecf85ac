/* SPDX-License-Identifier: GPL-3.0-or-later
 * Value of a load at a position and time: value (x, y, z, t) times a factor of t. */
#include "model.h"
#include <math.h>

/* 1: the load is a support (prescribes displacement, velocity or rotation). */
int pg_load_prescribes (const pg_load *load)
{
    return load->kind == PG_DISPLACEMENT || load->kind == PG_VELOCITY || load->kind == PG_ROTATION;
}
int pg_load_rotates (const pg_load *load) { return load->kind == PG_ROTATION || load->kind == PG_MOMENT; }
/* Number of components: dim; rotations and moments in 2D have one, about z. */
int pg_load_components (const pg_load *load, int dim)
{
    return !pg_load_rotates (load) || dim == 3 ? dim : dim == 2;
}
/* Axis of component k ('x', 'y', 'z'), for messages and column names. */
char pg_load_axis (const pg_load *load, int dim, int k)
{
    return "xyz"[pg_load_rotates (load) && dim < 3 ? 2 : k];
}

/* The factor of a table at t: linear between rows {t, factor}, constant before the first and beyond the
 * last. */
static double table_value (const pg_load *load, double t)
{
    const double *row = load->table;
    size_t n = load->ntable;
    if (t <= row[0]) return row[1];
    for (size_t k = 1; k < n; k++)
        if (t <= row[2 * k])
            return row[2 * k - 1]
                   + (row[2 * k + 1] - row[2 * k - 1]) * (t - row[2 * k - 2]) / (row[2 * k] - row[2 * k - 2]);
    return row[2*n - 1];
}

/* Integral of the table from its first t to t, s, which gives the displacement for a table of velocities. */
static double table_integral (const pg_load *load, double t)
{
    const double *row = load->table;
    double sum = 0;
    if (t <= row[0]) return row[1] * (t - row[0]);
    for (size_t k = 1; k < load->ntable && row[2*k - 2] < t; k++) {
        double end = t < row[2*k] ? t : row[2*k];
        sum += 0.5 * (row[2*k - 1] + table_value (load, end)) * (end - row[2*k - 2]);
    }
    const double *last = row + 2 * load->ntable - 2;
    return t > last[0] ? sum + last[1] * (t - last[0]) : sum;
}

/* Time factor of a load, from its table or ramp. A velocity is integrated to a displacement from t = 0, so
 * that all supports prescribe displacements. */
static double factor_at (const pg_load *load, const pg_place *at)
{
    if (!load->table) return pg_expression_value (load->ramp, at);
    return load->kind == PG_VELOCITY ? table_integral (load, at->t) - table_integral (load, 0)
                                     : table_value (load, at->t);
}

/* Variables of expressions at x (m) and t, with radius (m) and angle (rad, from 0 to 2 pi) about the
 * origin. */
pg_place pg_place_of (int dim, const double *x, double t)
{
    pg_place at = { x[0], dim > 1 ? x[1] : 0, dim > 2 ? x[2] : 0, 0, 0, t };
    at.r = sqrt (at.x * at.x + at.y * at.y + at.z * at.z);
    at.angle = atan2 (at.y, at.x);
    if (at.angle < 0) at.angle += 2 * 3.14159265358979323846;
    return at;
}

/* Converts a total force to a traction by the area of its faces; other values are unchanged. */
static double spread (const pg_load *load, double value)
{
    return load->over_area > 0 ? value / load->over_area : value;
}

/* ---- rigid rotation of a set --------------------------------------------------------------------------- */
/* Component k of the displacement at x by the rotation vector w (rad) about load->about: w x r if linearised;
 * (R - 1) r for finite rotations, R by Rodrigues' formula. */
static double turned (const pg_load *load, int k, int dim, const double *x, const double *w)
{
    double r[3] = { 0 }, across[3], size = sqrt (w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
    for (int c = 0; c < dim; c++) r[c] = x[c] - load->about[c];
    for (int c = 0; c < 3; c++)
        across[c] = w[(c + 1) % 3] * r[(c + 2) % 3] - w[(c + 2) % 3] * r[(c + 1) % 3];
    if (!load->finite || size == 0) return across[k];
    double along = w[0] * r[0] + w[1] * r[1] + w[2] * r[2], half = sin (0.5 * size),
           less = 2 * half * half / (size * size);     /* (1 - cos) / size^2 */
    return sin (size) / size * across[k] + less * (w[k] * along - size * size * r[k]);
}

static double turned_by (const pg_load *load, int k, int dim, const double *x, const pg_place *at,
                         double factor)
{
    double w[3];
    for (int c = 0; c < 3; c++) w[c] = load->angle[c] ? factor * pg_expression_value (load->angle[c], at) : 0;
    return turned (load, k, dim, x, w);
}

/* Component k of a load: expression at (x, t) times the factor of t. Radius and angle cost a root and an arc
 * tangent, and are only computed for expressions that use them. */
double pg_load_value (const pg_load *load, int k, int dim, const double *x, double t)
{
    if (!load->value[k]) return 0;
    if (load->turns) {
        pg_place now = { .t = t };
        return turned_by (load, k, dim, x, &now, factor_at (load, &now));
    }
    const pg_expression *e = load->value[k], *ramp = load->table ? e : load->ramp;
    int polar = pg_expression_uses (e, 'r') || pg_expression_uses (e, 'a') || pg_expression_uses (ramp, 'r')
                || pg_expression_uses (ramp, 'a');
    pg_place at = polar ? pg_place_of (dim, x, t)
                        : (pg_place){ x[0], dim > 1 ? x[1] : 0, dim > 2 ? x[2] : 0, 0, 0, t };
    return spread (load, pg_expression_value (load->value[k], &at)) * factor_at (load, &at);
}

/* Returns 1: the expression depends on position. */
int pg_depends_on_place (const pg_expression *e)
{
    return e
           && (pg_expression_uses (e, 'x') || pg_expression_uses (e, 'y') || pg_expression_uses (e, 'z')
               || pg_expression_uses (e, 'r') || pg_expression_uses (e, 'a'));
}

/* 1: a pattern in space times a factor of t alone, which forces compute once. A component whose
 * expression mixes x and t does not separate, nor does a ramp that depends on the place. */
int pg_load_separates (const pg_load *load)
{
    if (load->turns && load->finite) return 0;
    for (int k = 0; k < 3; k++) if (load->value[k] && pg_expression_uses (load->value[k], 't')) return 0;
    for (int k = 0; k < 3; k++) if (load->angle[k] && pg_expression_uses (load->angle[k], 't')) return 0;
    return load->table != NULL || !pg_depends_on_place (load->ramp);
}

/* The two parts of a separable load, whose product is pg_load_value bit by bit. */
double pg_load_factor (const pg_load *load, double t)
{
    pg_place at = { .t = t };
    return factor_at (load, &at);
}

double pg_load_pattern (const pg_load *load, int k, int dim, const double *x)
{
    if (!load->value[k]) return 0;
    pg_place at = pg_place_of (dim, x, 0);
    if (load->turns) return turned_by (load, k, dim, x, &at, 1);
    return spread (load, pg_expression_value (load->value[k], &at));
}

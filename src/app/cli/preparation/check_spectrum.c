/* SPDX-License-Identifier: GPL-3.0-or-later
 * perigal check --spectrum: the plane waves of the scene's lattice (symbol.h) in words, as
 * JSON, as a table and as a picture of the dispersion curves along the edges of the Brillouin
 * zone. Frequencies are given in c_p / h, the speed of longitudinal waves over the spacing,
 * and time steps in h / c_p, so that they do not depend on the material. */
#include "cli.h"
#include <math.h>
#include <string.h>

/* Wave vectors on each edge of the zone. */
enum { LEG = 40 };
static const double pi = 3.14159265358979323846;

/* Measures the lattice, samples its plane waves, and words the verdict. */
pg_status spectrum_find (spectrum *out, const pg_scene *scene, const pg_problem *p)
{
    pg_status status = PG_OK;
    PG_TRY (pg_symbol_create (&out->symbol, scene, p));
    PG_TRY (pg_symbol_survey (&out->survey, out->symbol));
    pg_survey_verdict (&out->survey, out->symbol, p, out->verdict, sizeof out->verdict);
done:
    return status;
}

void spectrum_free (spectrum *s) { pg_symbol_free (&s->symbol); }

/* ---- printing ------------------------------------------------------------------------------------------ */
/* Prints a motion (mode of a plane wave) in words with its wave vector in units of pi / step, so that 1 is
 * the edge of the zone. */
static void print_motion (const pg_motion *m, const pg_symbol *s)
{
    char where[64];
    pg_motion_where (m, s, where, sizeof where);
    printf ("%s, %s, k = (", pg_motion_kind (m, s), where);
    for (int a = 0; a < s->dim; a++) printf ("%s%.4g", a ? ", " : "", m->k[a] * s->step[a] / pi);
    printf (") pi / step\n");
}

/* Prints tangent stiffness and speeds of long waves over those of the material. Directions with equal steps
 * are alike, so one of them is shown. Two shear speeds appear if they differ visibly. */
static void print_tangent (const spectrum *x)
{
    const double *T = x->survey.tangent;
    int dim = x->symbol->dim, nv = pg_voigt_size (dim), alike = 1;
    for (int a = 1; a < dim; a++) alike &= fabs (x->symbol->step[a] / x->symbol->step[0] - 1) < 1e-9;
    printf ("  %-18s  over those of the material:", "long waves");
    for (int a = 0; a < (alike ? 1 : dim); a++)
        printf ("%s D_%c%c %.5g", a ? "," : "", "xyz"[a], "xyz"[a], T[a * nv + a]);
    if (dim > 1) printf (", D_xy %.5g, shear %.5g", T[1], T[(dim == 2 ? 2 : 3) * nv + (dim == 2 ? 2 : 3)]);
    printf ("\n");
    for (int d = 0; d < dim; d++) {
        printf ("  %-18s  20 spacings along %s: longitudinal %.5g", d ? "" : "wave speeds",
                x->survey.wave[d].along, x->survey.wave[d].longitudinal);
        if (dim > 1) printf (", shear %.5g", x->survey.wave[d].shear[0]);
        if (x->survey.wave[d].shear[1] - x->survey.wave[d].shear[0] > 1e-5)
            printf (" and %.5g", x->survey.wave[d].shear[1]);
        printf ("%s\n", d ? "" : " of the continuum's");
    }
}

/* Stable time step 2 / omega of central differences, s; NAN if the scene gives no density. */
static double seconds (const spectrum *x, double omega) { return x->symbol->dense ? 2 / omega : NAN; }

/* Prints a line for each question: what was measured, the range of eigenvalues, remarkable motions, unstable
 * motions, long waves, time steps, and the verdict. */
void spectrum_print (const spectrum *x, const pg_problem *p)
{
    const pg_symbol *s = x->symbol;
    const pg_survey *v = &x->survey;
    double speed = pg_material_waves (&s->material).pressure / s->h;
    printf ("  %-18s  %s%s: %zu wave vectors, grid of %d along each axis; a point interacts with %zu others "
            "(measured in a box of %zu points)\n",
            "spectrum", s->material.name, p->nmaterial > 1 ? " (the first material)" : "", v->vectors,
            v->grid, s->n - 1, s->points);
    printf ("  %-18s  %.4g to %.4g E V / h^2, in the shortest waves %.4g to %.4g\n", "eigenvalues",
            v->smallest.value, v->largest, v->shortest[0], v->shortest[1]);
    printf ("  %-18s  %.4g, ", "smallest", v->smallest.value), print_motion (&v->smallest, s);
    printf ("  %-18s  %.4g of a continuum's, ", "softest", v->softest.value), print_motion (&v->softest, s);
    if (!isnan (v->turning[0]))
        printf ("  %-18s  %.5g E V where all points rotate alike, at least %.5g\n", "rotations",
                v->turning[0], v->turning[1]);
    if (s->unknowns > s->dim && s->held[s->dim])
        printf ("  %-18s  without stiffness: constrained\n", "rotations");
    printf ("  %-18s  %zu, without energy %zu (beside rigid translation), below 0.01 of a continuum's %zu\n",
            "gaining energy", v->negative, v->zero, v->weak);
    if (v->zero) printf ("  %-18s  ", "without energy"), print_motion (&v->first, s);
    print_tangent (x);
    printf ("  %-18s  %.5g c_p / h", "largest frequency", v->fastest.value / speed);
    if (s->dense) printf (" = %.5g rad/s", v->fastest.value);
    printf (", "), print_motion (&v->fastest, s);
    printf ("  %-18s  far from surfaces stable up to %.4g h / c_p", "explicit steps",
            2 / v->fastest.value * speed);
    if (s->dense) printf (" = %.4g s", seconds (x, v->fastest.value));
    if (isnan (s->bound)) printf ("; explicit solvers measure it\n");
    else {
        printf ("; explicit solvers take %.4g h / c_p", 2 / s->bound * speed);
        if (s->dense) printf (" = %.4g s", seconds (x, s->bound));
        printf (" (%s)\n", s->from);
    }
    printf ("  %-18s  %s\n", "verdict", x->verdict);
}

/* ---- JSON ---------------------------------------------------------------------------------------------- */
/* Writes a motion as a JSON object: value, wave vector in units of pi / step, kind and position in words. */
static void put_motion (pg_json *j, const char *key, const pg_motion *m, const pg_symbol *s)
{
    char where[64];
    pg_motion_where (m, s, where, sizeof where);
    pg_json_open (j, key, '{');
    pg_json_number (j, "value", m->value);
    pg_json_open (j, "k_step_over_pi", '[');
    for (int a = 0; a < s->dim; a++) pg_json_number (j, NULL, m->k[a] * s->step[a] / pi);
    pg_json_shut (j);
    pg_json_text (j, "kind", pg_motion_kind (m, s));
    pg_json_text (j, "where", where);
    pg_json_shut (j);
}

/* Writes what was found of plane waves as a JSON object "spectrum" with fixed keys; nothing without any. */
void spectrum_json (pg_json *j, const spectrum *x)
{
    const pg_symbol *s = x->symbol;
    const pg_survey *v = &x->survey;
    if (!s) return;
    int nv = pg_voigt_size (s->dim);
    pg_json_open (j, "spectrum", '{');
    pg_json_count (j, "vectors", v->vectors);
    pg_json_count (j, "grid", (size_t) v->grid);
    pg_json_count (j, "coupled_points", s->n - 1);
    put_motion (j, "smallest", &v->smallest, s);
    put_motion (j, "softest", &v->softest, s);
    pg_json_number (j, "largest", v->largest);
    pg_json_number (j, "rotations", v->turning[0]);
    pg_json_number (j, "rotations_least", v->turning[1]);
    pg_json_count (j, "gaining_energy", v->negative);
    pg_json_count (j, "without_energy", v->zero);
    pg_json_count (j, "weak", v->weak);
    pg_json_open (j, "tangent_ratio", '[');
    for (int e = 0; e < nv * nv; e++) pg_json_number (j, NULL, v->tangent[e]);
    pg_json_shut (j);
    pg_json_open (j, "wave_speed_ratio", '[');
    for (int d = 0; d < s->dim; d++) {
        pg_json_open (j, NULL, '{');
        pg_json_text (j, "along", v->wave[d].along);
        pg_json_number (j, "longitudinal", v->wave[d].longitudinal);
        pg_json_number (j, "shear_slow", v->wave[d].shear[0]);
        pg_json_number (j, "shear_fast", v->wave[d].shear[1]);
        pg_json_shut (j);
    }
    pg_json_shut (j);
    pg_json_number (j, "courant", 2 / v->fastest.value * pg_material_waves (&s->material).pressure / s->h);
    put_motion (j, "fastest", &v->fastest, s);
    pg_json_number (j, "stable_dt", seconds (x, v->fastest.value));
    pg_json_number (j, "solvers_dt", seconds (x, s->bound));
    pg_json_text (j, "verdict", x->verdict);
    pg_json_shut (j);
}

/* ---- table and picture --------------------------------------------------------------------------------- */
/* Frequencies along the path through the zone: n positions x (in pi / h) with wave vectors k (n x 3, rad/m),
 * the two waves of the continuum (2 x n) and m branches (m x n), both in c_p / h. */
typedef struct { size_t n, m; double *x, *k, *continuum, *branch; } course;

/* Solves for all wave vectors of the path. Modes are sorted by frequency at each, so branches may swap where
 * they cross. */
static pg_status follow (course *c, const pg_symbol *s)
{
    pg_status status = PG_OK;
    pg_waves w = pg_material_waves (&s->material);
    double first[3], length;
    const char *name;
    c->n = pg_symbol_path (s, LEG, 0, first, &length, &name);
    for (int a = 0; a < s->unknowns; a++) c->m += !s->held[a];
    PG_ALLOC (c->x, c->n);
    PG_ALLOC (c->k, 3 * c->n);
    PG_ALLOC (c->continuum, 2 * c->n);
    PG_ALLOC (c->branch, c->m * c->n);
    for (size_t i = 0; i < c->n; i++) {
        pg_symbol_modes modes;
        double *k = c->k + 3 * i, size = 0;
        pg_symbol_path (s, LEG, i, k, &length, &name);
        for (int a = 0; a < s->dim; a++) size += k[a] * k[a];
        c->x[i] = length * s->h / pi;
        pg_symbol_solve (s, k, 1, &modes);
        for (size_t b = 0; b < c->m; b++) c->branch[b * c->n + i] = modes.value[b] * s->h / w.pressure;
        c->continuum[i] = sqrt (size) * s->h,
        c->continuum[c->n + i] = sqrt (size) * s->h * w.shear / w.pressure;
    }
done:
    return status;
}

/* Writes spectrum.csv, one row per wave vector: position on the path, wave vector, continuum, branches. */
static pg_status write_table (const course *c, const pg_symbol *s, const char *folder)
{
    pg_status status = PG_OK;
    static const char *const columns[] = { "path [pi/h]",     "k_x [pi/step]",       "k_y [pi/step]",
                                           "k_z [pi/step]",   "continuum_p [c_p/h]", "continuum_s [c_p/h]",
                                           "omega_1 [c_p/h]", "omega_2 [c_p/h]",     "omega_3 [c_p/h]",
                                           "omega_4 [c_p/h]", "omega_5 [c_p/h]",     "omega_6 [c_p/h]" };
    char path[4096];
    pg_table *table = NULL;
    snprintf (path, sizeof path, "%s/spectrum.csv", folder);
    PG_TRY (pg_table_create (&table, path, 6 + c->m, columns));
    for (size_t i = 0; i < c->n; i++) {
        double row[12] = { c->x[i], 0, 0, 0, c->continuum[i], s->dim > 1 ? c->continuum[c->n + i] : NAN };
        for (int a = 0; a < 3; a++)
            row[1 + a] = a < s->dim ? c->k[3 * i + (size_t) a] * s->step[a] / pi : NAN;
        for (size_t b = 0; b < c->m; b++) row[6 + b] = c->branch[b * c->n + i];
        PG_TRY (pg_table_row (table, row));
    }
done:
    pg_table_close (&table);
    return status;
}

/* Draws spectrum.png: the branches, and the waves of the continuum on the first edge of the zone. The lines
 * of the continuum are cut off above the highest branch, which keeps the part of long waves. */
static pg_status draw (const course *c, const spectrum *x, const pg_problem *p, const char *folder)
{
    pg_status status = PG_OK;
    pg_curve curve[PG_UNKNOWNS + 2];
    char path[4096], name[PG_UNKNOWNS][32], title[400];
    double top = 0;
    size_t n = 0, half = x->symbol->dim > 1 ? 2 : 1;
    for (size_t b = 0; b < c->m; b++) {
        snprintf (name[b], sizeof name[b], "branch %zu", b + 1);
        curve[n++] = (pg_curve) { .name = name[b], .n = c->n, .x = c->x, .y = c->branch + b * c->n };
    }
    for (size_t b = 0; b < c->m * c->n; b++) top = fmax (top, c->branch[b]);
    for (size_t q = 0; q < half; q++) {                /* cut off above the highest branch */
        const double *y = c->continuum + q * c->n;
        size_t end = 2;
        /* The straight lines of the continuum would otherwise set the scale and shrink the branches. */
        while (end <= LEG && y[end] <= top) end++;
        curve[n++] = (pg_curve){
            .name = q ? "continuum, shear" : "continuum, longitudinal", .n = end, .x = c->x, .y = y
        };
    }
    snprintf (title, sizeof title, "%s: %s", p->title,
              x->symbol->dim == 1   ? "Gamma - X"
              : x->symbol->dim == 2 ? "Gamma - X - M - Gamma"
                                    : "Gamma - X - M - R - Gamma");
    snprintf (path, sizeof path, "%s/spectrum.png", folder);
    pg_chart_style style = { .title = title,
                             .xlabel = "path through the zone (pi / h)",
                             .ylabel = "frequency (c_{p} / h)",
                             .beside = 1 };
    PG_TRY (pg_picture_chart (path, n, curve, &style));
done:
    return status;
}

/* Writes spectrum.csv and spectrum.png from one computation of the path. */
pg_status spectrum_write (const spectrum *x, const pg_problem *p, const char *folder)
{
    pg_status status = PG_OK;
    course c = { 0 };
    PG_TRY (pg_folder_make (folder));
    PG_TRY (follow (&c, x->symbol));
    PG_TRY (write_table (&c, x->symbol, folder));
    PG_TRY (draw (&c, x, p, folder));
done:
    pg_free (c.x), pg_free (c.k), pg_free (c.continuum), pg_free (c.branch);
    return status;
}

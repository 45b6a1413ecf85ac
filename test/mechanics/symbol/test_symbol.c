/* SPDX-License-Identifier: GPL-3.0-or-later
 * Symbols of lattices as scenes make them, against closed sums, closed forms and the numbers of theory D2, D3
 * and G. */
#include "check.h"
#include "perigal/symbol.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

typedef struct { pg_scene *scene; pg_problem *problem; pg_symbol *symbol; pg_survey survey; } lattice;

static char *scene_text (int dim, double spacing, const char *more, const char *method)
{
    static const char *const high[] = { "1", "1, 1", "1, 1, 1" }, *const low[] = { "0", "0, 0", "0, 0, 0" };
    static char text[1024];
    snprintf (text, sizeof text,
              "dimension: %d\nbody: [{add: {box: {low: [%s], high: [%s]}}}]\nspacing: %g\n%s\nmethod: {%s}\n",
              dim, low[dim - 1], high[dim - 1], spacing, more, method);
    return text;
}

static pg_status make (lattice *l, const char *text, int threads)
{
    pg_status status = PG_OK;
    memset (l, 0, sizeof *l);
    PG_TRY (pg_scene_parse (&l->scene, text, "lattice.yaml"));
    PG_TRY (pg_problem_build (&l->problem, l->scene, threads));
    PG_TRY (pg_symbol_create (&l->symbol, l->scene, l->problem));
done:
    return status;
}

static void drop (lattice *l)
{
    pg_symbol_free (&l->symbol);
    pg_problem_free (&l->problem);
    pg_scene_free (&l->scene);
}

#define ROCK "materials: {rock: {youngs_modulus: 10 GPa, poissons_ratio: 0.2, density: 2500 kg/m3}}\n"
#define GLASS "materials: {glass: {youngs_modulus: 10 GPa, poissons_ratio: 0.3}}\n"
#define CELLS "lattice: cells\n"
#define NOSB(m) \
    "approximation: nosb, integration: nodal, kernel: constant, horizon: " m " spacing, stabilization: "

static lattice lattice_of (int dim, const char *more, const char *method)
{
    lattice l;
    check_ok (make (&l, scene_text (dim, 0.1, more, method), 1));
    return l;
}

static lattice survey_of (int dim, const char *more, const char *method)
{
    lattice l = lattice_of (dim, more, method);
    check_ok (pg_symbol_survey (&l.survey, l.symbol));
    return l;
}

/* ---- against the closed sum of bonds ------------------------------------------------------------------- */
/* S = sum_j kappa_j xi xi' (1 - cos k.xi), kappa = V^2 c_h w / r^3 */
static void bond_sum (const lattice *l, const double *k, double *S)
{
    const pg_symbol *s = l->symbol;
    const pg_sum_rule *rule = &l->problem->sums->rule;
    pg_stencil stencil;
    size_t dim = (size_t) s->dim;
    check_ok (pg_stencil_build (&stencil, rule, s->dim, s->step));
    double c = pg_bond_modulus (rule->mode, rule->kernel, rule->horizon, s->material.modulus,
                                l->problem->cloud.thickness);
    if (rule->calibrate) c *= pg_stencil_calibration (&stencil, rule);
    memset (S, 0, dim * dim * sizeof *S);
    for (size_t e = 0; e < stencil.n; e++) {
        const double *xi = stencil.xi + e * dim;
        double phase = 0, kappa = s->volume * s->volume * c * stencil.weight[e] / pow (stencil.r[e], 3);
        for (size_t a = 0; a < dim; a++) phase += k[a] * xi[a];
        for (size_t a = 0; a < dim; a++)
            for (size_t b = 0; b < dim; b++) S[a * dim + b] += kappa * xi[a] * xi[b] * (1 - cos (phase));
    }
    pg_stencil_clear (&stencil);
}

static void equals_the_sum (int dim, const char *more, const char *method, double spacing)
{
    lattice l;
    check_ok (make (&l, scene_text (dim, spacing, more, method), 1));
    double A[36], B[36], S[9], k[3], size = 0;
    size_t dd = (size_t) (dim * dim);
    for (int t = 0; t < 12; t++) {
        for (int a = 0; a < dim; a++)
            k[a] = pi / l.symbol->step[a] * (t == 0 ? 1 : sin (1 + 7.3 * t + 2.1 * a));
        pg_symbol_at (l.symbol, k, A, B);
        bond_sum (&l, k, S);
        for (size_t e = 0; e < dd; e++) size = fmax (size, fabs (S[e]));
        for (size_t e = 0; e < dd; e++)
            check_scaled (A[e], S[e], 1e-12, size), check_scaled (B[e], 0, 1e-12, size);
    }
    drop (&l);
}

static void bonds_equal_their_closed_sum (void **state)
{
    (void) state;
    equals_the_sum (1, GLASS CELLS, "force: bond, horizon: 2.5 spacing", 0.1);
    equals_the_sum (2, GLASS CELLS, "force: bond", 0.1);
    equals_the_sum (2, GLASS, "force: bond", 0.1);                             /* points at the vertices */
    equals_the_sum (2, GLASS CELLS, "force: bond, kernel: quadratic, evaluation: list", 0.1);
    equals_the_sum (2, GLASS CELLS, "force: bond, horizon: 4.2 spacing, surface_correction: volume", 0.1);
    equals_the_sum (2, GLASS CELLS "plane: strain\nthickness: 3 mm\n", "force: fcbm, calibrate: off", 0.1);
    equals_the_sum (3, GLASS CELLS, "force: bond, partial_volume: linear", 0.2);
    equals_the_sum (2, GLASS CELLS, "force: bond, stretch: finite", 0.1);
}

/* Steps that the body makes unequal are those of the lattice. */
static void steps_may_differ (void **state)
{
    (void) state;
    static const char *const body[] = {
        "body: [{add: {box: {low: [0, 0], high: [1, 0.66]}}}]\nspacing: 0.22\ndimension: 2\n",
        "body: [{add: {box: {low: [0, 0, 0], high: [1, 0.5, 0.66]}}}]\nspacing: 0.25\ndimension: 3\n",
        "body: [{add: {box: {low: [0, 0, 0], high: [0.7, 1, 1.01]}}}]\nspacing: 0.25\ndimension: 3\n"
    };
    char text[512];
    for (int b = 0; b < 3; b++)
        for (int vertices = 0; vertices < 2; vertices++) {
            lattice l;
            double A[9], B[9], S[9], k[3] = { 3, -2, 1 };
            snprintf (text, sizeof text,
                      "%s%s%smethod: {force: bond, evaluation: list, horizon: 2.3 spacing}\n", body[b], GLASS,
                      vertices ? "" : CELLS);
            check_ok (make (&l, text, 1));
            size_t dd = (size_t) (l.symbol->dim * l.symbol->dim);
            assert_true (fabs (l.symbol->step[b == 1 ? 2 : 0] / l.symbol->step[1] - 1) > 0.03);
            pg_symbol_at (l.symbol, k, A, B);
            bond_sum (&l, k, S);
            for (size_t e = 0; e < dd; e++) check_scaled (A[e], S[e], 1e-12, fabs (S[0]));
            drop (&l);
        }
}

/* A chain of springs: omega = 2 c / h sin (k h / 2), stable up to h / c. */
static void a_chain_is_a_chain (void **state)
{
    (void) state;
    lattice l = survey_of (1, ROCK CELLS "cross_section: 2 cm2\n",
                           "force: bond, horizon: 1.2 spacing, partial_volume: none");
    double c = sqrt (10e9 / 2500), h = 0.1;
    for (double q = 0.1; q <= 1; q += 0.3) {
        pg_symbol_modes m;
        pg_symbol_solve (l.symbol, (double[]) { q * pi / h }, 1, &m);
        check_relative (m.value[0], 2 * c / h * sin (q * pi / 2), 1e-12);
    }
    check_relative (l.survey.fastest.value, 2 * c / h, 1e-12);
    check_relative (l.survey.wave[0].longitudinal, sin (pi / 20) / (pi / 20), 1e-12);
    check_relative (l.survey.tangent[0], 1, 1e-12);
    check_relative (l.survey.softest.value, 4 / (pi * pi), 1e-12);
    assert_true (l.symbol->bound >= l.survey.fastest.value * (1 - 1e-12));
    assert_int_equal (l.survey.negative + l.survey.zero + l.survey.weak, 0);
    drop (&l);
}

/* ---- what every method must do ------------------------------------------------------------------------- */
/* Hermitian; a rigid translation meets nothing; long waves have the tangent's speed; half the zone is the
 * other half. */
static void sound (int dim, const char *more, const char *method)
{
    lattice l = lattice_of (dim, more, method);
    const pg_symbol *s = l.symbol;
    int m = s->unknowns;
    double A[36], B[36], C[36], D[36], k[3] = { 0.7 * pi / s->h, -0.31 * pi / s->h, 0.12 * pi / s->h },
                                       back[3] = { -k[0], -k[1], -k[2] };
    pg_symbol_at (s, k, A, B);
    pg_symbol_at (s, back, C, D);
    for (int i = 0; i < m; i++)
        for (int j = 0; j < m; j++) {
            check_scaled (A[i * m + j], A[j * m + i], 1e-11, s->size);
            check_scaled (B[i * m + j], -B[j * m + i], 1e-11, s->size);
            check_scaled (A[i * m + j], C[i * m + j], 1e-11, s->size);
        }
    /* squares of all eigenvalues add up to the square of the matrix, real and imaginary parts */
    pg_symbol_modes o;
    double squares = 0, sum = 0;
    pg_symbol_solve (s, k, 1, &o);
    for (int i = 0; i < o.n; i++) sum += pow (o.value[i], 4);
    for (int i = 0; i < m; i++)
        for (int j = 0; j < m; j++)
            if (!s->held[i] && !s->held[j])
                squares += (A[i * m + j] * A[i * m + j] + B[i * m + j] * B[i * m + j])
                           / (s->mass[i] * s->mass[j]);
    check_relative (sum, squares, 1e-9);
    pg_symbol_at (s, (double[3]) { 0 }, A, B);
    for (int i = 0; i < m; i++) for (int j = 0; j < dim; j++) check_scaled (A[i * m + j], 0, 1e-11, s->size);
    pg_symbol_tangent (s, D);
    int nv = pg_voigt_size (dim);                      /* linear fields are exact in weak forms */
    for (int e = 0; s->spread && e < nv * nv; e++)
        check_scaled (D[e], s->material.D[e], 1e-9, s->material.modulus);
    pg_symbol_solve (s, (double[3]) { 1e-3 / s->h }, 1, &o);
    int best = 0;
    for (int i = 1; i < o.n; i++)
        if (o.along[i] * (1 - o.turning[i]) > o.along[best] * (1 - o.turning[best])) best = i;
    check_relative (o.value[best] * s->h / 1e-3, sqrt (D[0] / s->material.density), 1e-5);
    if (s->spread) check_relative (pg_symbol_amplitude (s, (double[3]) { 0 }), 1, 1e-11);
    drop (&l);
}

static void every_method_has_a_sound_symbol (void **state)
{
    (void) state;
    char names[256], method[256];
    static const char *const integrations[] = { "nodal", "gauss", "consistent" }, *const approximations[] = {
        "rkpm", "pddo", "nosb"
    };
    snprintf (names, sizeof names, "%s", pg_force_names ());
    for (char *name = strtok (names, "|"); name; name = strtok (NULL, "|"))
        for (int dim = 1; dim <= 3; dim++) {
            if (strcmp (name, "galerkin") == 0
                || (dim == 1 && (strcmp (name, "lps") == 0 || strcmp (name, "gmpd") == 0)))
                continue;
            snprintf (method, sizeof method, "force: %s, horizon: %s spacing", name,
                      dim == 3 ? "2.2" : "3.015");
            sound (dim, ROCK CELLS, method);
        }
    for (int a = 0; a < 3; a++)
        for (int i = 0; i < 3; i++)
            for (int quadratic = 0; quadratic < 2; quadratic++) {
                if (i == 2 && (quadratic || a > 0)) continue;  /* consistent: rkpm, linear */
                if (a == 2 && quadratic) continue;             /* nosb is linear */
                snprintf (method, sizeof method,
                          "approximation: %s, integration: %s, basis: %s, horizon: %s spacing",
                          approximations[a], integrations[i], quadratic ? "quadratic" : "linear",
                          quadratic ? "3" : "2");
                sound (2, ROCK, method);
            }
    sound (1, ROCK, "approximation: rkpm");
    sound (3, ROCK, "horizon: 1.6 spacing, gauss_points: 1");
}

/* ---- theory -------------------------------------------------------------------------------------------- */
/* D-2, D-3: 8 modes without energy with the two translations, 24 with three in space, and those of roots of
 * the family that lie in the grid; Gs = 0.1 leaves 0.10860 E / h^2 at nu = 0.3. */
static void nosb_has_motions_without_energy_and_silling_resists_them (void **state)
{
    (void) state;
    char text[400], where[64];
    lattice l = survey_of (2, GLASS, NOSB ("3.015") "none");
    assert_int_equal (l.survey.negative, 0);
    assert_int_equal (l.survey.zero, 6);
    pg_motion_where (&l.survey.first, l.symbol, where, sizeof where);
    assert_string_equal (where, "checkerboard");
    pg_survey_verdict (&l.survey, l.symbol, l.problem, text, sizeof text);
    check_contains (text, "unstable: nothing resists 6 motions");
    check_contains (text, "silling");
    drop (&l);
    l = survey_of (2, GLASS, NOSB ("1.5") "none");     /* 1 + 2 cos k = 0 is in this grid as well */
    assert_int_equal (l.survey.zero, 14);
    drop (&l);
    /* 272 k with two roots or three, 7 beside 0 with none, three modes each */
    l = survey_of (3, GLASS, NOSB ("1.8") "none");
    assert_int_equal (l.survey.zero, 3 * (272 + 7));
    drop (&l);
    /* 12 k like (pi/3, pi/3, pi), where 4 cos k_x = 1 + 2 cos k_y */
    l = survey_of (3, GLASS, NOSB ("2.2") "none");
    assert_int_equal (l.survey.zero, 3 * (12 + 7));
    drop (&l);
    l = survey_of (2, GLASS, NOSB ("3.015") "silling");
    assert_int_equal (l.survey.zero, 0);
    check_relative (l.survey.shortest[0], 0.10860, 1e-4);
    pg_survey_verdict (&l.survey, l.symbol, l.problem, text, sizeof text);
    check_contains (text, "stable: every motion is resisted");
    drop (&l);
}

/* G-4, G-5 and the row of the calibrated lattice below them; every eigenvalue positive. */
static void micropolar_bonds (void **state)
{
    (void) state;
    static const char bare[] = "force: gmpd, horizon: 3.015 spacing, partial_volume: none, calibrate: ";
    char method[128];
    for (int calibrated = 0; calibrated < 2; calibrated++) {
        snprintf (method, sizeof method, "%s%s", bare, calibrated ? "on" : "off");
        lattice l = survey_of (3, ROCK CELLS, method);
        const double *T = l.survey.tangent, *D = l.symbol->material.D;
        assert_int_equal (l.symbol->unknowns, 6);
        assert_int_equal (l.survey.negative + l.survey.zero + l.survey.weak, 0);
        assert_true (l.survey.smallest.value > 0 && l.survey.turning[1] > 0);
        check_relative (T[0], calibrated ? 0.94723 : 1.03055, 2e-5);
        check_relative (T[21], calibrated ? 1.07036 : 1.15530, 2e-5);
        check_relative ((T[0] * D[0] + 2 * T[1] * D[1]) / (D[0] + 2 * D[1]), calibrated ? 1 : 1.09871, 1e-5);
        if (calibrated) check_relative ((T[0] * D[0] - T[1] * D[1]) / (D[0] - D[1]), 0.89446, 2e-5);
        if (!calibrated) check_relative (l.survey.turning[0], 0.5532, 1e-4);
        assert_true (l.symbol->bound >= l.survey.fastest.value * (1 - 1e-12));
        drop (&l);
    }
    lattice l = survey_of (3, "materials: {rock: {youngs_modulus: 10 GPa, poissons_ratio: 0.25}}\n" CELLS,
                           "force: gmpd");
    assert_true (l.symbol->held[3] && l.symbol->held[4] && l.symbol->held[5] && !l.symbol->held[0]);
    assert_int_equal (l.survey.negative + l.survey.zero, 0);
    assert_true (isnan (l.survey.turning[0]));
    drop (&l);
}

/* Poisson's ratios that bonds alone do not have: refused without the energy of dilatation (G-4: every wave
 * gains energy), stable with it. */
static void the_volumetric_term_makes_any_poissons_ratio_stable (void **state)
{
    (void) state;
    char more[256];
    static const double nu[] = { 0.3, 0.4, 0.49 };
    for (int t = 0; t < 6; t++) {
        lattice l;
        int dim = t < 3 ? 2 : 3;
        if ((dim == 3 && t % 3 != 1) || (!longer () && t == 1)) continue;
        snprintf (more, sizeof more,
                  "%smaterials: {rock: {youngs_modulus: 10 GPa, poissons_ratio: %g}}\n" CELLS,
                  dim == 2 ? "plane: strain\n" : "", nu[t % 3]);
        check_fails (make (&l, scene_text (dim, 0.1, more, "force: gmpd"), 1), PG_E_SCENE);
        drop (&l);
        l = survey_of (dim, more, "force: gmpd, volumetric: on");
        print_message ("# %dD, nu = %g: smallest %.4g, rotations %.4g, softest %.3g of a continuum's\n", dim,
                       nu[t % 3], l.survey.smallest.value, l.survey.turning[1], l.survey.softest.value);
        assert_true (l.survey.smallest.value > 0 && l.survey.turning[1] > 0.1
                     && l.survey.softest.value > 0.05);
        assert_int_equal (l.survey.negative + l.survey.zero + l.survey.weak, 0);
        check_relative (l.survey.tangent[0], 1, 0.005);
        assert_true (l.symbol->bound >= l.survey.fastest.value);
        drop (&l);
    }
}

/* Fields of rotation that gain energy: blocks of them turned over. */
static void what_gains_energy_is_told (void **state)
{
    (void) state;
    char text[400];
    lattice l = lattice_of (2, ROCK CELLS, "force: gmpd");
    size_t m = (size_t) l.symbol->unknowns;
    assert_int_equal (m, 3);
    for (size_t j = 0; j < l.symbol->n; j++) l.symbol->block[j * m * m + 8] *= -1;
    check_ok (pg_symbol_survey (&l.survey, l.symbol));
    assert_int_equal (l.survey.negative, l.survey.grid * l.survey.grid);
    assert_true (l.survey.turning[0] < 0 && l.survey.smallest.turning > 0.9);
    assert_string_equal (pg_motion_kind (&l.survey.smallest, l.symbol), "rotation");
    pg_survey_verdict (&l.survey, l.symbol, l.problem, text, sizeof text);
    check_contains (text, "unstable: rotation");
    check_contains (text, "Poisson's ratio");
    pg_symbol_modes o;
    pg_symbol_solve (l.symbol, (double[3]) { 0 }, 1, &o);
    assert_true (o.value[0] < 0);
    drop (&l);
}

/* Theory's constants of state-based lattices with m = 3.015: method.md B6. */
static void state_based_constants (void **state)
{
    (void) state;
    lattice l = survey_of (3, ROCK CELLS, "force: lps");
    const double *T = l.survey.tangent, *D = l.symbol->material.D;
    check_relative (T[21], 0.9929, 1e-4);
    check_relative ((T[0] * D[0] - T[1] * D[1]) / (D[0] - D[1]), 1.0107, 1e-4);
    check_relative ((T[0] * D[0] + 2 * T[1] * D[1]) / (D[0] + 2 * D[1]), 1, 1e-9);
    assert_int_equal (l.survey.negative + l.survey.zero, 0);
    drop (&l);
}

/* ---- invariance ---------------------------------------------------------------------------------------- */
static void units_and_threads_change_nothing (void **state)
{
    (void) state;
    static const char *const methods[] = { "force: gmpd, horizon: 2.5 spacing", "horizon: 2.1 spacing",
                                           "force: lps, horizon: 2.5 spacing" };
    for (int t = 0; t < 3; t++) {
        lattice a, b, c;
        pg_survey s[3];
        check_ok (make (&a, scene_text (2, 0.1, ROCK CELLS, methods[t]), 1));
        check_ok (make (&b, scene_text (2, 0.1, ROCK CELLS, methods[t]), 2));
        check_ok (pg_symbol_survey (&s[0], a.symbol));
        check_ok (pg_symbol_survey (&s[1], b.symbol));
        assert_int_equal (a.symbol->n, b.symbol->n);
        assert_memory_equal (a.symbol->block, b.symbol->block,
                             a.symbol->n * (size_t) (a.symbol->unknowns * a.symbol->unknowns)
                                 * sizeof (double));
        assert_memory_equal (&s[0], &s[1], sizeof s[0]);
        char text[512];
        snprintf (
            text, sizeof text,
            "dimension: 2\nbody: [{add: {box: {low: [0, 0], high: [1 mm, 1 mm]}}}]\nspacing: 0.1 mm\n" ROCK
                CELLS "method: {%s}\n",
            methods[t]);
        check_ok (make (&c, text, 1));
        check_ok (pg_symbol_survey (&s[2], c.symbol));
        check_relative (s[2].smallest.value, s[0].smallest.value, 1e-9);
        check_relative (s[2].softest.value, s[0].softest.value, 1e-9);
        check_relative (s[2].largest, s[0].largest, 1e-9);
        check_relative (s[2].fastest.value, 1000 * s[0].fastest.value, 1e-9);
        for (int e = 0; e < 9; e++) check_absolute (s[2].tangent[e], s[0].tangent[e], 1e-9);
        drop (&a), drop (&b), drop (&c);
    }
}

static void the_path_closes (void **state)
{
    (void) state;
    lattice l = lattice_of (3, ROCK CELLS, "force: bond, horizon: 1.5 spacing");
    double k[3], length, h = l.symbol->h;
    const char *name;
    static const char *const names[] = { "Gamma", "X", "M", "R", "Gamma" };
    size_t n = pg_symbol_path (l.symbol, 5, 0, k, &length, &name);
    assert_int_equal (n, 21);
    for (size_t i = 0; i < n; i++) {
        pg_symbol_path (l.symbol, 5, i, k, &length, &name);
        assert_string_equal (name, i % 5 ? "" : names[i / 5]);
    }
    check_relative (length, pi / h * (3 + sqrt (3)), 1e-12);
    check_absolute (k[0] * h + k[1] * h + k[2] * h, 0, 1e-12);
    drop (&l);
}

/* ---- refusals ------------------------------------------------------------------------------------------ */
static void refuse (const char *text, pg_status code, const char *word)
{
    lattice l;
    check_fails (make (&l, text, 1), code);
    check_contains (pg_last_error (), word);
    assert_null (l.symbol);
    drop (&l);
}

static void no_lattice_no_symbol (void **state)
{
    (void) state;
    char path[] = "/tmp/perigal_symbol_XXXXXX", text[512];
    refuse (scene_text (2, 0.1, ROCK "perturb: {amount: 0.1}\n", ""), PG_E_USAGE, "perturb");
    refuse (scene_text (3, 0.1, ROCK CELLS, "force: bond, horizon: 16 spacing"), PG_E_LIMIT, "box of");
    refuse ("dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [1, 0.6, 0.75]}}}]\nspacing: 0.5\n" ROCK
                CELLS "method: {force: bond, evaluation: list}\n",
            PG_E_USAGE, "differ too much");
    int file = mkstemp (path);
    assert_true (file >= 0);
    FILE *out = fdopen (file, "w");
    fputs ("x,y,volume\n0,0,1\n1,0,1\n0,1,1\n1,1,1\n2,0,1\n2,1,1\n", out);
    fclose (out);
    snprintf (text, sizeof text, "dimension: 2\npoints: %s\n" ROCK "method: {force: bond, horizon: 1.5 m}\n",
              path);
    refuse (text, PG_E_USAGE, "points of a file");
    remove (path);
}

static void each_allocation_may_fail (void **state)
{
    (void) state;
    static const char *const methods[] = { "force: bond, horizon: 1.5 spacing",
                                           "horizon: 1.5 spacing, gauss_points: 1",
                                           "force: gmpd, horizon: 1.5 spacing, volumetric: on",
                                           "force: fcbm, horizon: 1.5 spacing" };
    for (int t = 0; t < 4; t++) {
        lattice l;
        pg_survey s, again;
        check_ok (make (&l, scene_text (t < 2 ? 1 : 2, 0.25, ROCK, methods[t]), 1));
        pg_symbol_free (&l.symbol);
        size_t used = pg_memory_used (), before = pg_memory_calls (), calls;
        check_ok (pg_symbol_create (&l.symbol, l.scene, l.problem));
        check_ok (pg_symbol_survey (&s, l.symbol));
        double bound = isnan (l.symbol->bound) ? 0 : l.symbol->bound;
        size_t unharmed = 0;  /* what is only kept to save time may go without room */
        pg_symbol_free (&l.symbol);
        calls = pg_memory_calls () - before;
        assert_true (calls > 20);
        for (size_t k = 1; k <= calls; k += longer () || k < 20 ? 1 : 3) {
            pg_memory_fail_at (k);
            pg_status status = pg_symbol_create (&l.symbol, l.scene, l.problem);
            if (status == PG_OK) status = pg_symbol_survey (&again, l.symbol);
            pg_memory_fail_at (0);
            if (status == PG_OK) {
                check_relative (again.fastest.value, s.fastest.value, 1e-12);
                check_relative (isnan (l.symbol->bound) ? 0 : l.symbol->bound, bound, 1e-12);
                unharmed++;
            } else assert_int_equal (status, PG_E_MEMORY);
            pg_symbol_free (&l.symbol);
            assert_int_equal (pg_memory_used (), used);
        }
        assert_true (unharmed <= 8);
        drop (&l);
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (bonds_equal_their_closed_sum),
        cmocka_unit_test (steps_may_differ),
        cmocka_unit_test (a_chain_is_a_chain),
        cmocka_unit_test (every_method_has_a_sound_symbol),
        cmocka_unit_test (nosb_has_motions_without_energy_and_silling_resists_them),
        cmocka_unit_test (micropolar_bonds),
        cmocka_unit_test (the_volumetric_term_makes_any_poissons_ratio_stable),
        cmocka_unit_test (what_gains_energy_is_told),
        cmocka_unit_test (state_based_constants),
        cmocka_unit_test (units_and_threads_change_nothing),
        cmocka_unit_test (the_path_closes),
        cmocka_unit_test (no_lattice_no_symbol),
        cmocka_unit_test (each_allocation_may_fail),
    };
    return cmocka_run_group_tests_name ("mechanics/symbol/symbol", tests, NULL, NULL);
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * The same bond-based plate and block with LAMMPS' package PERI and with Perigal, one thread each: directed
 * bonds per second of the loops that sum forces (law: finite stretch, broken bonds looked for), and by how
 * much the displacements differ after a few hundred steps of velocity Verlet. Runs bench/lammps/block.in with
 * the program that LAMMPS names (default lmp); without one only Perigal's rows are printed. PERI scales a
 * neighbour's volume by (horizon + step/2 - r) / step where r > horizon - step/2, but has no bonds beyond the
 * horizon: the sums called `peri` here do the same; `linear` are Perigal's own, with bonds up to horizon +
 * step/2. Stiffness: under equal stretches, over that of a body without gaps; it is why the two move apart.
 * Milliseconds are processor time of one sum of forces, and with bonds per second and the ratio to LAMMPS
 * (package PERI, its mean) they are given as least, median and largest of the steps. */
#include "lattice.h"
#include "spread.h"
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

typedef struct { const char *name; int dim, count, steps; double dt; } shape;
static const shape shapes[] = { { "plate_400", 2, 400, 200, 2e-7 }, { "block_40", 3, 40, 100, 1e-7 } };
/* m, -, Pa, kg/m^3, m/s, 1/m */
static const double step = 1e-3, ratio = 3.015, E = 72e9, rho = 2440, speed = 1, wave = 40;

typedef struct {
    const shape *shape;
    lattice_body body;                                 /* plain: LAMMPS' displacements */
    double modulus, *moduli, *limit, *v;
} runner;

static void clear (runner *r)
{
    pg_free (r->moduli), pg_free (r->limit), pg_free (r->v);
    r->moduli = r->limit = r->v = NULL;
    lattice_clear (&r->body);
}

static void start (runner *r)
{
    lattice_body *b = &r->body;
    size_t dim = (size_t) b->cloud.dim;
    for (size_t i = 0; i < b->cloud.n; i++) {
        const double *x = b->cloud.x + i * dim;
        for (size_t d = 0; d < dim; d++) b->u[i*dim + d] = r->v[i*dim + d] = 0;
        r->v[i * dim] = speed * sin (wave * (x[0] + 2 * x[1])),
                 r->v[i * dim + 1] = speed * cos (wave * (2 * x[0] - x[1]));
    }
}

static pg_status build (runner *r, const shape *s, int peri, pg_evaluation evaluation)
{
    pg_status status = PG_OK;
    lattice_body *b = &r->body;
    *r = (runner) { .shape = s };
    PG_TRY (lattice_create (b, s->dim, (int[3]) { s->count, s->count, s->count }, step, s->dim));
    size_t n = b->cloud.n;
    PG_ALLOC (r->moduli, n);
    PG_ALLOC (r->limit, n);
    PG_ALLOC (r->v, n * (size_t) s->dim);
    if (s->dim == 2) b->cloud.thickness = step;
    for (size_t i = 0; i < n; i++) b->cloud.volume[i] = step * step * step;
    pg_sum_rule rule = { .mode = s->dim == 2 ? PG_PLANE_STRESS : PG_SOLID,
                         .kernel = pg_kernel_find ("constant"),
                         .horizon = ratio * step,
                         .partial = peri ? PG_PARTIAL_NONE : PG_PARTIAL_LINEAR,
                         .finite = 1,
                         .evaluation = evaluation };
    PG_TRY (lattice_bond (b, &rule, 0));
    pg_stencil *t = &b->sums->stencil;
    for (size_t k = 0; peri && k < t->n; k++)
        t->beta[k] = t->weight[k] = fmin (1, (rule.horizon + step / 2 - t->r[k]) / step);
    r->modulus = pg_bond_modulus (rule.mode, rule.kernel, rule.horizon, E, b->cloud.thickness);
    for (size_t i = 0; i < n; i++) r->moduli[i] = r->modulus, r->limit[i] = 1;
    start (r);
done:
    return status;
}

/* Velocity Verlet from the start to the end; seconds of each sum of forces. */
static pg_status go (runner *r, const char *set, char *name, spread *times)
{
    pg_status status = PG_OK;
    lattice_body *b = &r->body;
    size_t values = b->cloud.n * (size_t) b->cloud.dim;
    double half = r->shape->dt / 2 / (rho * b->cloud.volume[0]);
    pg_bond_loop *loop = NULL;
    pg_changes broken = { 0 };
    pg_bond_loop_setting setting = { .sums = b->sums,
                                     .family = &b->family,
                                     .modulus = r->moduli,
                                     .limit = r->limit,
                                     .threads = 1,
                                     .instructions = set };
    PG_TRY (pg_bond_loop_create (&loop, &setting));
    strcpy (name, pg_bond_loop_name (loop));
    start (r);
    *times = (spread){ 0 };
    for (int k = 0; k <= r->shape->steps; k++) {
        double now = lattice_seconds (1);
        PG_TRY (pg_bond_loop_force (loop, b->u, b->f, &broken));
        spread_add (times, lattice_seconds (1) - now);
        for (size_t i = 0; k > 0 && i < values; i++) r->v[i] += half * b->f[i];
        for (size_t i = 0; k < r->shape->steps && i < values; i++)
            r->v[i] += half * b->f[i], b->u[i] += r->shape->dt * r->v[i];
    }
    if (broken.n > 0) PG_FAIL (PG_E_EQUILIBRIUM, "%zu bonds broke", broken.n);
done:
    pg_bond_loop_free (&loop);
    pg_free (broken.bond);
    return status;
}

/* Displacements of LAMMPS' last state. */
static pg_status read_final (runner *r, const char *path)
{
    pg_status status = PG_OK;
    lattice_body *b = &r->body;
    size_t dim = (size_t) b->cloud.dim, count = (size_t) r->shape->count, got = 0;
    char line[256];
    FILE *file = fopen (path, "r");
    if (!file) PG_FAIL (PG_E_FILE, "%s is not there: LAMMPS failed", path);
    while (fgets (line, sizeof line, file)) {
        double x[3];
        size_t id, i = 0;
        if (sscanf (line, "%zu %lf %lf %lf", &id, x, x + 1, x + 2) != 4) continue;
        for (size_t d = dim; d-- > 0; ) i = i * count + (size_t) lround (x[d] / step);
        if (i >= b->cloud.n) PG_FAIL (PG_E_FILE, "%s: point %zu is outside the body", path, id);
        for (size_t d = 0; d < dim; d++) b->plain[i*dim + d] = x[d] - b->cloud.x[i*dim + d];
        got++;
    }
    if (got != b->cloud.n) PG_FAIL (PG_E_FILE, "%s: %zu points of %zu", path, got, b->cloud.n);
done:
    if (file) fclose (file);
    return status;
}

typedef struct { double bonds, pair, loop; } rival;    /* seconds of the processor, all steps */

/* LAMMPS on this body, one process, one thread; bonds = 0: there is no LAMMPS. */
static pg_status run_lammps (runner *b, rival *r)
{
    pg_status status = PG_OK;
    const char *program = getenv ("LAMMPS");
    char path[] = "/tmp/peri_race_XXXXXX", command[1024], line[512];
    double share = 100;
    FILE *pipe = NULL;
    memset (r, 0, sizeof *r);
    snprintf (command, sizeof command, "command -v '%s' > /dev/null", program ? program : "lmp");
    if (system (command) != 0) return PG_OK;
    int temporary = mkstemp (path);
    if (temporary < 0) PG_FAIL (PG_E_FILE, "no temporary file in /tmp");
    close (temporary);
    snprintf (command, sizeof command,
              "OMP_NUM_THREADS=1 '%s' -in bench/lammps/block.in -log none -var dim %d -var count %d -var "
              "step %.17g -var horizon %.17g"
              " -var c %.17g -var rho %.17g -var dt %.17g -var velocity %.17g -var wave %.17g -var steps %d "
              "-var final %s",
              program ? program : "lmp", b->shape->dim, b->shape->count, step, ratio * step, b->modulus, rho,
              b->shape->dt, speed, wave, b->shape->steps, path);
    if (!(pipe = popen (command, "r"))) PG_FAIL (PG_E_FILE, "LAMMPS could not be started");
    while (fgets (line, sizeof line, pipe)) {
        sscanf (line, " total # of bonds = %lf", &r->bonds);
        sscanf (line, "Loop time of %lf", &r->loop);
        sscanf (line, "Pair | %lf", &r->pair);
        if (strstr (line, "% CPU use")) sscanf (line, "%lf%%", &share);
        if (strstr (line, "ERROR")) PG_FAIL (PG_E_FILE, "LAMMPS: %s", line);
    }
    r->pair *= share / 100, r->loop *= share / 100;
    PG_TRY (read_final (b, path));
done:
    if (pipe) pclose (pipe);
    unlink (path);
    return status;
}

static void row (const runner *b, const char *program, const char *sums, double bonds, spread *times,
                 const rival *r, double off)
{
    const pg_sums *of = b->body.sums;
    double pair = r->bonds * b->shape->steps / r->pair;
    printf ("%s,%zu,%.0f,%s,%s,%d,", b->shape->name, b->body.cloud.n, bonds, program, sums, b->shape->steps);
    spread_print (times, 1e3);
    spread_print_rate (times, bonds * 1e-9);
    printf ("%.4f,", 1 / pg_stencil_calibration (&of->stencil, &of->rule));
    if (r->bonds > 0) {
        spread_print_rate (times, bonds / pair);
        printf ("%.3g\n", off);
    } else printf (",,,\n");
    fflush (stdout);
}

static pg_status race (const shape *s)
{
    static const struct { pg_evaluation evaluation; int peri; const char *set;
    } runs[] = {
        { PG_EVALUATE_LIST, 1, NULL },      { PG_EVALUATE_LIST, 1, "avx2" },
        { PG_EVALUATE_LIST, 1, "scalar" },  { PG_EVALUATE_STENCIL, 1, NULL },
        { PG_EVALUATE_STENCIL, 1, "avx2" }, { PG_EVALUATE_STENCIL, 1, "scalar" },
        { PG_EVALUATE_LIST, 0, NULL },      { PG_EVALUATE_STENCIL, 0, NULL },
    };
    pg_status status = PG_OK;
    runner b = { 0 };
    rival r = { 0, 0, 0 };
    spread times;
    double *other = NULL;
    for (size_t k = 0; k < sizeof runs / sizeof *runs; k++) {
        char name[64];
        PG_TRY (build (&b, s, runs[k].peri, runs[k].evaluation));
        if (k == 0) {
            PG_TRY (run_lammps (&b, &r));
            other = b.body.plain, b.body.plain = NULL;
            spread pair = { .n = 1, .value = { r.pair / s->steps } };
            spread whole = { .n = 1, .value = { r.loop / s->steps } };
            if (r.bonds > 0) {
                row (&b, "lammps pair", "peri", r.bonds, &pair, &r, 0);
                row (&b, "lammps step", "peri", r.bonds, &whole, &r, 0);
            }
        }
        status = go (&b, runs[k].set, name, &times);
        if (status == PG_OK)
            row (&b, name, runs[k].peri ? "peri" : "linear", (double) b.body.family.start[b.body.cloud.n],
                 &times, &r, lattice_apart (&b.body, b.body.u, other));
        else if (status != PG_E_USAGE) goto done;      /* usage: instructions that this machine lacks */
        status = PG_OK;
        clear (&b);
    }
done:
    clear (&b);
    pg_free (other);
    return status;
}

int main (void)
{
    puts ("body,points,directed_bonds,program,sums,steps,ms_per_sum_min,ms_per_sum_median,ms_per_sum_max,"
          "Gbonds_per_s_min,Gbonds_per_s_median,Gbonds_per_s_max,stiffness,"
          "times_lammps_min,times_lammps_median,times_lammps_max,displacement_difference");
    fflush (stdout);
    for (size_t k = 0; k < sizeof shapes / sizeof *shapes; k++)
        if (race (&shapes[k]) != PG_OK) {
            fprintf (stderr, "peri_race: %s\n", pg_last_error ());
            return 1;
        }
    return 0;
}

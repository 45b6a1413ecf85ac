/* SPDX-License-Identifier: GPL-3.0-or-later
 * A checkpoint with changed values and a checksum that fits them: the run goes on, or a fault says that it is
 * not of this run; then the report is written. Bytes: the first chooses a scene; then triples: a variable, a
 * place in it, what is written there (one of some nasty values or the byte). With a first byte of 0xff what
 * follows is the file itself. */
#include "fuzz.h"
#include "perigal.h"
#include <math.h>
#include <stdlib.h>
#include <unistd.h>

static const char *const checkpoint_scene[] = {
    "dimension: 2\nthickness: 0.1\nbody: [{add: {box: {low: [0, 0], high: [0.4, 0.3]}}}]\nspacing: "
    "0.1\nmaterials: {rock: {youngs_modulus: 1 GPa, poissons_ratio: 0.2, density: 2000}}\n"
    "failure: {criterion: stretch, critical_stretch: 1e-3, exclude: [bottom, top]}\n"
    "boundary: [{name: foot, set: bottom, displacement: {x: 0, y: 0}}, {name: head, set: top, displacement: "
    "{y: 2 mm}}]\n"
    "solver: {stepping: fixed, steps: 4}\noutput: {at: {broken: 4 %}, pictures: [], tips: [{name: tip, from: "
    "[0, 0.15], along: [1, 0]}]}\n",
    "dimension: 2\nthickness: 0.1\nbody: [{add: {box: {low: [0, 0], high: [0.4, 0.3]}}}]\nspacing: "
    "0.1\nmaterials: {rock: {youngs_modulus: 1 GPa, poissons_ratio: 0.3333, density: 2000}}\n"
    "method: {force: bond}\nfailure: {criterion: stretch, critical_stretch: 1e-3, exclude: [bottom, top]}\n"
    "boundary: [{name: foot, set: bottom, displacement: {x: 0, y: 0}}, {name: head, set: top, displacement: "
    "{y: 2 mm}}]\n"
    "solver: {stepping: event, max_events: 4}\noutput: {pictures: []}\n",
    "dimension: 2\nthickness: 0.1\nbody: [{add: {box: {low: [0, 0], high: [0.4, 0.3]}}}]\nspacing: "
    "0.1\nmaterials: {rock: {youngs_modulus: 1 GPa, poissons_ratio: 0.3333, density: 2000}}\n"
    "method: {force: lps}\nboundary: [{set: bottom, displacement: {x: 0, y: 0}}, {set: top, traction: {y: 1 "
    "MPa}}]\n"
    "solver: {kind: verlet, end: 0.5 ms}\noutput: {at: {rows: 8}, pictures: []}\n",
    "dimension: 2\nthickness: 0.1\nbody: [{add: {box: {low: [0, 0], high: [0.8, 0.7]}}}]\nspacing: 0.1\n"
    "cracks: [{from: [-0.1, 0.36], to: [0.33, 0.34]}, {from: [0.6, 0.1], to: [0.7, 0.15]}]\n"
    "materials: {rock: {youngs_modulus: 1 GPa, poissons_ratio: 0.2, density: 2000}}\n"
    "failure: {fracture_energy: 400 J/m2}\nboundary: [{name: foot, set: bottom, displacement: {x: 0, y: 0}}, "
    "{name: head, set: top, displacement: {y: 2 mm}}]\n"
    "solver: {stepping: event, max_events: 6}\noutput: {pictures: [], at: {levels: 1}}\n",
};
enum {
    CHECKPOINT_SCENES = sizeof checkpoint_scene / sizeof *checkpoint_scene,
    MOST_PARTS = 256,
    MOST_STEPS = 3
};
static char checkpoint_folder[] = "/tmp/perigal_checkpoint_XXXXXX";

typedef struct {
    pg_scene *scene;
    pg_problem *problem;
    pg_solver *solver;
    pg_state *state;
    pg_result *result;
} checkpoint_run;
/* All that the walk of a checkpoint has, in its order. */
typedef struct {
    char name[64], kind;
    size_t n;
    double *number;
    long *count;
    unsigned char *byte;
} checkpoint_part;
typedef struct { checkpoint_part part[MOST_PARTS]; size_t n, at; } checkpoint_parts;

static void remove_checkpoint (void)
{
    char command[80];
    snprintf (command, sizeof command, "rm -rf %s", checkpoint_folder);
    if (system (command) != 0) FUZZ_BROKEN ("the folder stays");
}

static void end_checkpoint_run (checkpoint_run *r)
{
    pg_result_free (&r->result);
    pg_solver_free (&r->solver), pg_state_free (&r->state), pg_problem_free (&r->problem),
        pg_scene_free (&r->scene);
}

static void begin_checkpoint_run (checkpoint_run *r, int which)
{
    pg_solver_options options;
    *r = (checkpoint_run) { 0 };
    FUZZ_EXPECT (pg_scene_parse (&r->scene, checkpoint_scene[which], "scene.yaml") == PG_OK);
    FUZZ_EXPECT (pg_problem_build (&r->problem, r->scene, 1) == PG_OK
                 && pg_solver_options_read (&options, r->problem, r->scene) == PG_OK);
    FUZZ_EXPECT (pg_solver_create (&r->solver, r->problem, &options) == PG_OK
                 && pg_state_create (&r->state, r->problem, pg_solver_components (r->solver)) == PG_OK);
}

/* Steps as far as they go, a report. Nothing of it may crash; what the state became is no matter. */
static void end_of_checkpoint_run (checkpoint_run *r)
{
    pg_step step;
    for (int k = 0; k < MOST_STEPS && !pg_solver_done (r->solver, r->state); k++)
        if (pg_solver_step (r->solver, r->state, &step) != PG_OK
            || pg_result_step (r->result, r->state, &step) != PG_OK)
            break;
    pg_result_finish (r->result, r->state, "a test", 0, 0);
}

/* ---- the walk of a checkpoint: of a file that was written, into memory; with changes, into a file ------ */
static size_t checkpoint_size (char kind) { return kind == 'b' ? 1 : 8; }
static void *checkpoint_value (checkpoint_part *p)
{
    return p->kind == 'n' ? (void *) p->number : p->kind == 'c' ? (void *) p->count : p->byte;
}

static pg_status record (checkpoint_parts *all, const char *called, char kind, size_t n, const void *value)
{
    if (n == 0) return PG_OK;
    FUZZ_EXPECT (all->n < MOST_PARTS);
    checkpoint_part *p = &all->part[all->n++];
    void *copy = pg_calloc (n, checkpoint_size (kind));
    FUZZ_EXPECT (copy);
    memcpy (copy, value, n * checkpoint_size (kind));
    snprintf (p->name, sizeof p->name, "%s", called);
    p->kind = kind, p->n = n;
    if (kind == 'n') p->number = copy;
    else if (kind == 'c') p->count = copy;
    else p->byte = copy;
    return PG_OK;
}
static pg_status record_numbers (void *all, const char *called, size_t n, double *value)
{
    return record (all, called, 'n', n, value);
}
static pg_status record_counts (void *all, const char *called, size_t n, long *value)
{
    return record (all, called, 'c', n, value);
}
static pg_status record_bytes (void *all, const char *called, size_t n, void *value)
{
    return record (all, called, 'b', n, value);
}

static pg_status write_parts (void *context, const pg_keeper *k)
{
    pg_status status = PG_OK;
    checkpoint_parts *all = context;
    for (size_t i = 0; i < all->n && status == PG_OK; i++) {
        checkpoint_part *p = &all->part[i];
        status = p->kind == 'n'   ? k->numbers (k->context, p->name, p->n, p->number)
                 : p->kind == 'c' ? k->counts (k->context, p->name, p->n, p->count)
                                  : k->bytes (k->context, p->name, p->n, p->byte);
    }
    return status;
}

/* What pg_result_checkpoint writes, caught on its way: every file of the folder stays as a run leaves it. */
static void catch_checkpoint (checkpoint_parts *all, int which)
{
    const pg_keeper keeper = { all, 0, record_numbers, record_counts, record_bytes };
    checkpoint_run r;
    pg_step step;
    FUZZ_EXPECT (pg_result_discard (checkpoint_folder) == PG_OK);
    begin_checkpoint_run (&r, which);
    FUZZ_EXPECT (pg_result_open (&r.result, checkpoint_folder, r.scene, r.problem, r.solver) == PG_OK);
    for (int k = 0; k < 2; k++)
        FUZZ_EXPECT (pg_solver_step (r.solver, r.state, &step) == PG_OK
                     && pg_result_step (r.result, r.state, &step) == PG_OK);
    FUZZ_EXPECT (pg_result_keep (r.result, r.state, &keeper) == PG_OK);
    end_checkpoint_run (&r);
}

static void change (checkpoint_parts *all, const uint8_t *data, size_t size)
{
    static const long nasty[] = {
        -1, 0, 1, 2, 17, 255, 1L << 31, 1L << 32, 1L << 50, 0x7fffffffffffffff, -0x7fffffffffffffff
    };
    static const double wild[] = { 0, -1, 1e308, -1e308, 5e-324, 1e17, (double) NAN, (double) INFINITY };
    for (size_t k = 0; k + 3 <= size && k < 24; k += 3) {
        checkpoint_part *p = &all->part[data[k] % all->n];
        size_t at = data[k + 1] % p->n;
        uint8_t to = data[k + 2];
        if (p->kind == 'b') p->byte[at] = to;
        else if (p->kind == 'c')
            p->count[at] = to < sizeof nasty / sizeof *nasty ? nasty[to] : (long) to - 128;
        else p->number[at] = to < sizeof wild / sizeof *wild ? wild[to] : to;
    }
}

int LLVMFuzzerTestOneInput (const uint8_t *data, size_t size)
{
    static int made;
    char path[80];
    if (size < 1 || size > LONGEST) return 0;
    if (!made++ && (!mkdtemp (checkpoint_folder) || atexit (remove_checkpoint)))
        FUZZ_BROKEN ("no temporary folder");
    size_t used = pg_memory_used ();
    int which = data[0] % CHECKPOINT_SCENES;
    checkpoint_parts all = { 0 };
    checkpoint_run r;
    pg_resumed from;
    catch_checkpoint (&all, which);
    snprintf (path, sizeof path, "%s/checkpoint.nc", checkpoint_folder);
    if (data[0] == 0xff) {
        FILE *file = fopen (path, "wb");
        FUZZ_EXPECT (file && fwrite (data + 1, 1, size - 1, file) == size - 1 && fclose (file) == 0);
    } else {
        change (&all, data + 1, size - 1);
        FUZZ_EXPECT (pg_checkpoint_write (path, write_parts, &all) == PG_OK);
    }
    for (size_t i = 0; i < all.n; i++) pg_free (checkpoint_value (&all.part[i]));
    begin_checkpoint_run (&r, which);
    pg_status status = pg_result_resume (&r.result, checkpoint_folder, r.scene, r.problem, r.solver, r.state,
                                         &from);
    if (status == PG_OK) end_of_checkpoint_run (&r);
    FUZZ_EXPECT (status == PG_OK || size > 1);         /* nothing changed: it goes on */
    end_checkpoint_run (&r);
    unlink (path);
    FUZZ_EXPECT (pg_memory_used () == used);
    return 0;
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * Chooses the loop that sums the bonds: the first kind that can, or transforms where these are faster, with
 * the best instructions that this machine has. */
#include "mechanics/sums/terms/bond_loop.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct pg_bond_loop {
    const pg_bond_loop_kind *kind;
    void *self;
    int   linear;                                      /* forces are linear in u */
    char  name[32], reason[160];
};

/* All kinds of loops, each in a file of its own; of those that suit a theory the first that does not
 * refuse is taken, so that lattices come before lists. */
static const pg_bond_loop_kind *const kinds[] = { &pg_bond_loop_stencil,      &pg_bond_loop_list,
                                                  &pg_bond_loop_fft,          &pg_bond_loop_state_stencil,
                                                  &pg_bond_loop_state_list,   &pg_bond_loop_state_fft,
                                                  &pg_bond_loop_beam_stencil, &pg_bond_loop_beam_list,
                                                  &pg_bond_loop_beam_volume };
enum { KINDS = sizeof kinds / sizeof *kinds };
static const char *const set_name[PG_INSTRUCTION_SETS] = { "scalar", "avx2", "avx512" };

const char *pg_instructions_name (pg_instructions set) { return set_name[set]; }

/* Has this processor an instruction set? Found when the program runs, so that one program serves all
 * machines. */
int pg_instructions_here (pg_instructions set)
{
    if (set == PG_SCALAR) return 1;
#ifdef __x86_64__
    int avx2 = __builtin_cpu_supports ("avx2") && __builtin_cpu_supports ("fma");
    if (set == PG_AVX2) return avx2;
    return avx2 && __builtin_cpu_supports ("avx512f") && __builtin_cpu_supports ("avx512bw")
           && __builtin_cpu_supports ("avx512dq") && __builtin_cpu_supports ("avx512vl");
#else
    return 0;
#endif
}

/* Chooses the instruction set by its name; name NULL: the best that this machine has. A named one that is
 * missing is an error, as others may differ in last digits, and tests compare them. */
static pg_status choose_instructions (pg_instructions *out, const char *name)
{
    pg_status status = PG_OK;
    int set = PG_INSTRUCTION_SETS - 1;
    if (!name) {
        while (!pg_instructions_here (set)) set--;
    } else {
        while (set >= 0 && strcmp (name, set_name[set]) != 0) set--;
        if (set < 0) PG_FAIL (PG_E_USAGE, "instructions %s: unknown; there are scalar, avx2, avx512", name);
        if (!pg_instructions_here (set))
            PG_FAIL (PG_E_USAGE, "instructions %s: this machine has none; leave the choice to the program",
                     name);
    }
    *out = (pg_instructions) set;
done:
    return status;
}

/* Takes transforms where their estimated time is below 0.8 of the stencil's: the estimates are of intact
 * bodies, and cracks cost some of what is saved. reason: both times in ns a point, for the plan. */
static void compare_transforms (const pg_bond_loop_kind **kind, const pg_bond_loop_setting *setting,
                                pg_instructions set, char *reason, size_t size)
{
    if (*kind != &pg_bond_loop_stencil || pg_bond_loop_fft.refusal (setting)) return;
    double n = (double) setting->sums->cloud->n, direct = pg_bond_loop_stencil.time (setting, set) / n,
           fast = pg_bond_loop_fft.time (setting, set) / n;
    if (fast < 0.8 * direct) *kind = &pg_bond_loop_fft;
    snprintf (reason, size, "auto: about %.2g ns a point by transforms, %.2g by stencil", fast, direct);
}

/* Chooses the first kind of loop that is made for the theory (0 bond-based, 1 state-based, 2 beams, 3 beams
 * and dilatation) and does not refuse; `only`: name of the one that the scene asks for. If there is none, the
 * error has the reason of the last refusal. */
static pg_status choose_kind (const pg_bond_loop_kind **out, const pg_bond_loop_setting *setting)
{
    static const char *const asked[] = { [PG_EVALUATE_AUTO] = NULL,
                                         [PG_EVALUATE_STENCIL] = "stencil",
                                         [PG_EVALUATE_LIST] = "list",
                                         [PG_EVALUATE_FFT] = "fft" };
    pg_status status = PG_OK;
    const char *only = asked[setting->sums->rule.evaluation], *why = "there is no such loop";
    int theory = (setting->beams ? 2 : 0) + (setting->sums->rule.state != 0);
    *out = NULL;
    for (size_t k = 0; k < KINDS && !*out; k++) {
        if (kinds[k]->state != theory || (only && theory < 3 && strcmp (only, kinds[k]->name) != 0)) continue;
        why = kinds[k]->refusal (setting);
        if (!why) *out = kinds[k];
    }
    if (!*out)
        PG_FAIL (PG_E_USAGE, "evaluation %s cannot sum these bonds: %s; try evaluation: auto",
                 only ? only : "auto", why);
done:
    return status;
}

/* Chooses instructions and kind and makes the loop; name and reason are kept as text for plans and
 * reports. */
pg_status pg_bond_loop_create (pg_bond_loop **out, const pg_bond_loop_setting *setting)
{
    pg_status status = PG_OK;
    pg_bond_loop *s = NULL;
    pg_instructions set = PG_SCALAR;
    *out = NULL;
    PG_ALLOC (s, 1);
    PG_TRY (choose_instructions (&set, setting->instructions));
    PG_TRY (choose_kind (&s->kind, setting));
    if (setting->sums->rule.evaluation != PG_EVALUATE_AUTO) strcpy (s->reason, "asked for");
    else compare_transforms (&s->kind, setting, set, s->reason, sizeof s->reason);
    strcpy (s->name, s->kind->name);
    if (!s->kind->plain) strcat (strcat (s->name, " "), set_name[set]);
    PG_TRY (s->kind->create (&s->self, setting, set));
    if (s->kind->remark) {
        size_t used = strlen (s->reason);
        snprintf (s->reason + used, sizeof s->reason - used, "%s%s", used ? "; " : "",
                  s->kind->remark (s->self));
    }
    s->linear = !setting->sums->rule.finite;
    *out = s, s = NULL;
done:
    pg_bond_loop_free (&s);
    return status;
}

void pg_bond_loop_free (pg_bond_loop **loop)
{
    if (!loop || !*loop) return;
    if ((*loop)->kind) (*loop)->kind->free ((*loop)->self);
    pg_free (*loop);
    *loop = NULL;
}

/* The functions below pass calls on to the chosen kind of loop. */
const char *pg_bond_loop_name (const pg_bond_loop *loop) { return loop->name; }

const char *pg_bond_loop_reason (const pg_bond_loop *loop) { return loop->reason; }

void pg_bond_loop_counted (const pg_bond_loop *loop, pg_bond_loop_counts *out)
{
    *out = (pg_bond_loop_counts) { 0 };
    if (loop->kind->counts) loop->kind->counts (loop->self, out);
}

void pg_bond_loop_bytes (const pg_bond_loop *loop, double *per_bond, double *per_point)
{
    loop->kind->bytes (loop->self, per_bond, per_point);
}

void pg_bond_loop_update (pg_bond_loop *loop, const unsigned char *alive, const pg_changes *changes)
{
    loop->kind->update (loop->self, alive, changes);
}

pg_status pg_bond_loop_force (pg_bond_loop *loop, const double *u, double *f, pg_changes *broken)
{
    return loop->kind->force (loop->self, u, f, broken);
}

double pg_bond_loop_energy (pg_bond_loop *loop, const double *u)
{
    return loop->kind->energy (loop->self, u);
}

/* The ends of a bond have opposite forces, so that f . u is a sum over bonds of force times relative
 * displacement: rounding errors have the size of these products, as in the loop that sums energies. */
int pg_bond_loop_halves (const pg_bond_loop *loop) { return loop->linear && loop->kind->apart; }

pg_status pg_bond_loop_energies (pg_bond_loop *loop, const double *u, double *W)
{
    return loop->kind->energies (loop->self, u, W);
}

pg_status pg_bond_loop_dilatation (pg_bond_loop *loop, const double *u, double *theta, double *q)
{
    if (!loop->kind->dilatation)
        return pg_error (PG_E_USAGE, PG_HERE, "a dilatation is known to state-based sums only");
    return loop->kind->dilatation (loop->self, u, theta, q);
}

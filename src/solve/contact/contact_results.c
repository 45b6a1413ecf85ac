/* SPDX-License-Identifier: GPL-3.0-or-later
 * Contact for results: the pieces of the last step, and the largest overlap of faces. */
#include "contact.h"
#include <math.h>

/* Puts the largest overlap into the report, measured at points on the faces where contact holds these apart:
 * ends of broken bonds beside a kink approach by strains that vary too fast for a mean of both ends. */
void contact_note_overlap (pg_system *s, const pg_state *state)
{
    const struct system_contact *c = s->contact;
    double overlap = 0;
    int points = contact_of_faces (c) && s->force->surfaces.jump;
    if (points && c->ncrack == 0) return;              /* there are none, or nothing has been solved yet */
    pg_contact_pieces cracks = { 0 };                  /* borrowed: without the pieces of platens */
    if (points) cracks = c->pieces, cracks.n = c->ncrack, cracks.npoint = cracks.first[c->ncrack];
    if (points && pg_contact_overlap (&overlap, &cracks, s->force, s->self, state, state->d) != PG_OK) return;
    if (!points && s->force->judge
        && s->force->judge (s->self, state, state->d, &(pg_judging){ .overlap = &overlap }) != PG_OK) return;
    s->report->contact.overlap_max = fmax (s->report->contact.overlap_max, overlap);
}

pg_status contact_show (pg_system *s, double scale)
{
    pg_status status = PG_OK;
    struct system_contact *c = s->contact;
    if (!c) return PG_OK;
    platens_show (s, scale);
    PG_GROW (c->shown, c->cap_shown, c->pieces.n);
    c->nshown = c->pieces.n;
    for (size_t k = 0; k < c->nshown; k++) {
        const pg_contact_piece *p = &c->pieces.piece[k];
        size_t i = c->pieces.dim * k;
        double force = c->is.active ? scale / (c->weight * p->area) : 0;
        c->shown[k] = (pg_contact_values) { .path = p->path, .platen = p->platen,
                                            .x = { p->x[0], p->x[1], p->x[2] },
                                            .normal = { p->normal[0], p->normal[1], p->normal[2] },
                                            .area = p->area, .length = p->length, .arc = p->arc,
                                            .pressure = force * c->force[i]
                                                        + scale * c->rebound[k] / p->area,
                                            .gap = scale * (c->gap[i] - (p->platen ? 0 : c->initial[i])),
                                            .status = c->is.active ? c->status[k] : PG_CONTACT_OPEN };
        contact_vector (&c->pieces, k, c->force + i + 1, force, c->shown[k].shear);
        contact_vector (&c->pieces, k, c->gap + i + 1, scale, c->shown[k].slip);
    }
done:
    return status;
}

const pg_contact_values *pg_solver_contact (const pg_solver *s, size_t *n)
{
    const struct system_contact *c = s->break_loop.system.contact;
    *n = c ? c->nshown : 0;
    return c ? c->shown : NULL;
}

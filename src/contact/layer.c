/* SPDX-License-Identifier: GPL-3.0-or-later
 * Rows of contact pieces from the bonds that crossed them (surfaces.faces of the force). */
#include "perigal/contact.h"

pg_status pg_contact_layer (pg_sparse *out, double *soft, double *stiffer, const pg_contact_pieces *pieces,
                            const pg_force_type *force, void *self, const pg_state *state)
{
    const pg_face_pieces faces = { .n = pieces->n, .dim = pieces->dim, .npoint = pieces->npoint,
                                   .first = pieces->first, .x = pieces->x, .normal = pieces->normal,
                                   .tangent = pieces->tangent, .weight = pieces->weight,
                                   .nknown = pieces->nknown, .nbroken = pieces->nbroken,
                                   .broken = pieces->broken, .place = pieces->place };
    return force->surfaces.faces (self, state, &faces, out, soft, stiffer);
}

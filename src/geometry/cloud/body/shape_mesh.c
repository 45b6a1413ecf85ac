/* SPDX-License-Identifier: GPL-3.0-or-later
 * A mesh as a shape: a position is inside where an element holds it; its distance is that from the nearest
 * face of the surface. And PG_STAIRS, the mesh represented by the lattice: each cell is inside if its centre
 * is. */
#include "shape.h"
#include "solid.h"
#include <math.h>
#include <string.h>

/* ---- mesh ---------------------------------------------------------------------------------------------- */
/* Reads a mesh; prepares the search for elements (inside or outside) and for faces (distance). */
pg_status shape_mesh_read (pg_shape *s, int dim, const pg_scene *scene, const char *at)
{
    pg_status status = PG_OK;
    (void) dim;
    PG_ALLOC (s->solid, 1);
    PG_TRY (mesh_body_at (&s->solid->part, scene, at));
    PG_TRY (pg_mesh_locator_create (&s->solid->locator, &s->solid->part.mesh));
    PG_TRY (pg_skin_create (&s->solid->skin, &s->solid->part.mesh));
done:
    if (status != PG_OK) shape_mesh_clear (s);
    return status;
}

void shape_mesh_clear (pg_shape *s)
{
    if (!s->solid) return;
    pg_skin_free (&s->solid->skin), pg_mesh_locator_free (&s->solid->locator);
    pg_mesh_body_clear (&s->solid->part), pg_alpha_shape_clear (&s->solid->cloud);
    facets_clear (&s->solid->facets);
    pg_free (s->solid->sign), pg_free (s->solid);
    s->solid = NULL;
}

/* Most positions are far from the surface, compared with reach: their depth within an element decides
 * quickly. The distance itself is computed only near the surface. */
double shape_mesh_distance (const pg_shape *s, int dim, const double *x, double reach)
{
    double near = 1000 * fabs (reach) / s->solid->part.smallest, xi[3];
    (void) dim;
    /* Most positions are far from the surface. */
    if (near < 0.1) {
        double depth = pg_mesh_locator_depth (s->solid->locator, x, fmax (near, 1e-8));
        if (fabs (depth) >= fmax (near, 1e-8)) return depth > 0 ? -HUGE_VAL : HUGE_VAL;
    }
    double d = pg_skin_distance (s->solid->skin, x, fabs (reach), NULL);
    return pg_mesh_locator_find (s->solid->locator, x, xi, NULL) >= 0 ? -d : d;
}

void shape_mesh_box (const pg_shape *s, int dim, double *low, double *high)
{
    (void) dim;
    pg_skin_box (s->solid->skin, low, high);
}

double shape_mesh_volume (const pg_shape *s, double *surface)
{
    double volume = 0;
    for (size_t e = 0; e < s->solid->part.mesh.n; e++) volume += s->solid->part.volume[e];
    *surface = pg_skin_size (s->solid->skin);
    return volume;
}

size_t pg_body_meshes (const pg_body *body)
{
    size_t n = 0;
    for (size_t i = 0; i < body->n; i++) n += pg_shape_meshed (&body->shape[i]) != 0;
    return n;
}

int pg_shape_meshed (const pg_shape *s) { return s->kind == PG_MESH || s->kind == PG_ALPHA_SHAPE; }

/* ---- side sets ----------------------------------------------------------------------------------------- */
/* Name of side set k, in the order of the file; NULL: there are no more. */
const char *pg_shape_side (const pg_shape *s, size_t k)
{
    const pg_mesh *m = &s->solid->part.mesh;
    return k < m->nsides ? m->sides[k].name : NULL;
}

/* Does the face nearest to x belong to that side set? */
int pg_shape_on_side (const pg_shape *s, const double *x, const char *side)
{
    long face;
    int element, at;
    pg_skin_distance (s->solid->skin, x, HUGE_VAL, &face);
    if (face < 0) return 0;
    pg_skin_face (s->solid->skin, (size_t) face, &element, &at);
    return pg_shape_face_on_side (s, element, at, side);
}

/* Several side sets of one name count as one. */
int pg_shape_face_on_side (const pg_shape *s, int element, int at, const char *side)
{
    const pg_mesh *m = &s->solid->part.mesh;
    for (size_t k = 0; k < m->nsides; k++)
        for (size_t i = 0; !strcmp (m->sides[k].name, side) && i < m->sides[k].n; i++)
            if (m->sides[k].element[i] == element && m->sides[k].side[i] == at) return 1;
    return 0;
}

/* ---- staircases on a lattice --------------------------------------------------------------------------- */
/* Computes the signs at the centres of all cells once: later tests take constant time. */
pg_status pg_stairs_create (pg_shape *out, const pg_shape *mesh, const pg_lattice *lattice)
{
    pg_status status = PG_OK;
    double tolerance = pg_lattice_tolerance (lattice);
    *out = *mesh;
    out->kind = PG_STAIRS, out->solid = NULL;
    PG_ALLOC (out->solid, 1);
    out->solid->lattice = *lattice, out->solid->lattice.in = NULL;
    PG_ALLOC (out->solid->sign,
              (size_t) lattice->count[0] * (size_t) lattice->count[1] * (size_t) lattice->count[2]);
    signed char *sign = out->solid->sign;
    for (int c = 0; c < lattice->count[2]; c++)
        for (int b = 0; b < lattice->count[1]; b++)
            for (int a = 0; a < lattice->count[0]; a++) {
                double i[3] = {a + 0.5, b + 0.5, c + 0.5}, x[3] = {0, 0, 0};
                for (int k = 0; k < lattice->dim; k++) x[k] = pg_lattice_at (lattice, k, i[k]);
                double d = pg_shape_types[mesh->kind].distance (mesh, lattice->dim, x, tolerance);
                *sign++ = (signed char) ((d > tolerance) - (d < -tolerance));
            }
done:
    if (status != PG_OK) pg_stairs_clear (out);
    return status;
}

void pg_stairs_clear (pg_shape *stairs) { shape_mesh_clear (stairs); }

/* Sign of the distance at the centre of cell i; 1 (outside) beyond the lattice. */
static int sign_at (const struct pg_solid *s, const int *i)
{
    const int *n = s->lattice.count;
    for (int k = 0; k < 3; k++) if (i[k] < 0 || i[k] >= n[k]) return 1;
    return s->sign[((size_t) i[2] * (size_t) n[1] + (size_t) i[1]) * (size_t) n[0] + (size_t) i[0]];
}

/* The distance is infinite, as only its sign is used. */
double shape_stairs_distance (const pg_shape *s, int dim, const double *x, double reach)
{
    const pg_lattice *l = &s->solid->lattice;
    int i[3] = {0, 0, 0};
    (void) reach;
    for (int k = 0; k < dim; k++) {
        double at = floor ((x[k] - l->origin[k]) / l->step[k]);
        i[k] = at < 0 ? -1 : at < l->count[k] ? (int) at : l->count[k];
    }
    int sign = sign_at (s->solid, i);
    return sign == 0 ? 0 : sign > 0 ? HUGE_VAL : -HUGE_VAL;
}

/* Is one of the two cells at this face inside the shape and the other outside? A centre on the surface
 * belongs to the body: it is inside an added shape and outside a subtracted one. */
int pg_stairs_step (const pg_shape *stairs, const int *i, int face)
{
    /* a centre on the surface belongs to the body */
    int beside[3] = {i[0], i[1], i[2]}, on = stairs->add ? 0 : -1;
    beside[face / 2] += face % 2 ? 1 : -1;
    return (sign_at (stairs->solid, i) <= on) != (sign_at (stairs->solid, beside) <= on);
}

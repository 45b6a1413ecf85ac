/* SPDX-License-Identifier: GPL-3.0-or-later
 * Points of the body with their volumes: vertices or centres of the kept lattice cells, x fastest, then y,
 * then z; or from a file. */
#include "perigal/cloud.h"
#include "place.h"
#include "geometry/cloud/body/points_file.h"
#include "subdomain.h"
#include <limits.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

/* ---- sites of the lattice ------------------------------------------------------------------------------ */
/* Adds one to all sites around a cell: its vertices (first = 0), or the cell and its neighbours (first =
 * -1). */
static void spread (sites *s, const pg_lattice *l, const int *cell, int first)
{
    int i[3], low[3], high[3];
    for (int k = 0; k < 3; k++) {
        /* Sites beyond the lattice are cut off. */
        low[k]  = k < l->dim ? cell[k] + first : 0;
        high[k] = k < l->dim ? cell[k] + 1 : 0;
        if (low[k] < 0) low[k] = 0;
        if (high[k] >= (int) s->size[k]) high[k] = (int) s->size[k] - 1;
    }
    for (i[2] = low[2]; i[2] <= high[2]; i[2]++)
        for (i[1] = low[1]; i[1] <= high[1]; i[1]++)
            for (i[0] = low[0]; i[0] <= high[0]; i[0]++)
                s->around[((size_t) i[2] * s->size[1] + (size_t) i[1]) * s->size[0] + (size_t) i[0]]++;
}

pg_status cloud_count_around (sites *s, const pg_lattice *l, int cells)
{
    pg_status status = PG_OK;
    memset (s, 0, sizeof *s);
    s->n = s->whole = 1;
    s->shift = cells ? 0.5 : 0;
    for (int k = 0; k < 3; k++) {
        s->size[k] = (size_t) l->count[k] + (k < l->dim && !cells);
        s->n *= s->size[k];
        /* A vertex inside has 2^dim cells around it; a centre, with its neighbours, 3^dim. */
        if (k < l->dim) s->whole *= cells ? 3 : 2;
    }
    PG_ALLOC (s->around, s->n);
    const unsigned char *in = l->in;
    for (int c = 0; c < l->count[2]; c++)
        for (int b = 0; b < l->count[1]; b++)
            for (int a = 0; a < l->count[0]; a++)
                if (*in++) spread (s, l, (int[]) {a, b, c}, cells ? -1 : 0);
    /* Centres of cells outside the body are no points, whatever lies around them. */
    for (size_t i = 0; cells && i < s->n; i++) if (!l->in[i]) s->around[i] = 0;
done:
    return status;
}

/* ---- building the cloud -------------------------------------------------------------------------------- */
/* Writes positions and volumes. Only sites with kept cells all around are shifted (perturb), so that the
 * boundary stays; the shift follows from their number in the whole lattice. */
static pg_status place_points (pg_cloud *c, const pg_lattice *l, const sites *s, double amount, uint64_t seed)
{
    pg_status status = PG_OK;
    size_t dim = (size_t) c->dim, n = 0, p = 0;
    double cell = c->thickness;
    for (size_t k = 0; k < dim; k++) cell *= l->step[k];
    for (size_t i = 0; i < s->n; i++) n += s->around[i] != 0;
    PG_ALLOC (c->x, n * dim);
    PG_ALLOC (c->volume, n);
    PG_ALLOC (c->block, n);
    c->n = n;
    for (size_t i = 0; i < s->n; i++) {
        size_t rest = i;
        if (!s->around[i]) continue;
        uint64_t number = l->whole[0] ? (uint64_t) cloud_site_number (s, l, i) : i;
        /* Index along each axis from the number of the site. */
        for (size_t k = 0; k < dim; k++, rest /= s->size[k - 1]) {
            double *x = &c->x[p*dim + k];
            *x = pg_lattice_at (l, (int) k, (double) (rest % s->size[k]) + s->shift);
            if (amount > 0 && s->around[i] == s->whole)
                *x += amount * l->step[k] * pg_place_shift (seed, number, (int) k);
        }
        c->volume[p++] = s->shift > 0 ? cell : s->around[i] * (cell / s->whole);
    }
done:
    return status;
}

void pg_place_bounds (pg_cloud *c)
{
    size_t dim = (size_t) c->dim;
    for (size_t k = 0; k < dim; k++) {
        c->low[k] = INFINITY, c->high[k] = -INFINITY;
        for (size_t i = 0; i < c->n; i++) {
            c->low[k]  = fmin (c->low[k], c->x[i*dim + k]);
            c->high[k] = fmax (c->high[k], c->x[i*dim + k]);
        }
    }
}

/* Reports points that lie outside the shapes that are to be their surface. */
static pg_status check_inside (const pg_cloud *c, const pg_body *body, const pg_scene *scene)
{
    size_t out = 0, first = 0, dim = (size_t) c->dim;
    for (size_t i = c->n; i-- > 0;)
        if (!pg_body_inside (body, c->x + i * dim, PG_NO_LENGTH * c->h)) out++, first = i;
    if (out)
        pg_scene_fault (
            scene, "points",
            "%zu of %zu points lie outside the body, the first of them number %zu at (%.6g%s%.6g) m: the "
            "shapes of body must hold all points",
            out, c->n, first + 1, c->x[first * dim], dim > 1 ? ", " : "",
            dim > 1 ? c->x[first * dim + 1] : 0);
    return pg_scene_verdict (scene);
}

/* Thickness in 2D (m), cross section in 1D (m^2); 1 in 3D. */
static double thickness_of (int dim, const pg_scene *scene)
{
    return dim == 3 ? 1 : pg_scene_number (scene, dim == 2 ? "thickness" : "cross_section");
}

static int is_itself (void *context, const double *place, size_t point)
{
    (void) place;
    return point == *(const size_t *) context;
}

/* Checks that volumes fit the distances: the median, over a sample, of a point's volume over that of a cube
 * (square) as wide as its nearest neighbour is away is 1 on a lattice and some units among random points.
 * Thousands are a wrong unit or a wrong column. */
static pg_status check_volumes (const pg_cloud *c, const pg_scene *scene)
{
    enum { SAMPLE = 1000 };
    static const double most = 1000;
    pg_status status = PG_OK;
    pg_nearest *near = NULL;
    double *ratio = NULL, total = 0;
    size_t stride = c->n / SAMPLE + 1, n = 0, dim = (size_t) c->dim;
    if (c->n < 2) return PG_OK;
    PG_TRY (pg_nearest_create (&near, c->dim, c->n, c->x));
    PG_ALLOC (ratio, c->n / stride + 1);
    for (size_t i = 0; i < c->n; i++) total += c->volume[i];
    for (size_t i = 0; i < c->n; i += stride) {
        long j = pg_nearest_find (near, c->x + i * dim, is_itself, &i);
        double away = 0;
        for (size_t k = 0; j >= 0 && k < dim; k++)
            away = hypot (away, c->x[(size_t) j * dim + k] - c->x[i * dim + k]);
        if (away > 0) ratio[n++] = c->volume[i] / c->thickness / pow (away, c->dim);
    }
    if (n == 0) goto done;
    pg_sort (ratio, n, sizeof *ratio, pg_ascending_numbers);
    if (ratio[n / 2] < most && ratio[n / 2] > 1 / most) goto done;
    pg_scene_fault (scene, "points",
                    "the volumes do not fit the distances: a point has %.3g times the volume that its "
                    "neighbours leave to it (all points together %.6g m^3); look at the units of the columns "
                    "(x [mm], volume [mm3]), at their order and at %s",
                    ratio[n / 2], total,
                    c->dim == 2 ? "thickness" : c->dim == 1 ? "cross_section" : "the file");
    status = pg_scene_verdict (scene);
done:
    pg_nearest_free (&near);
    pg_free (ratio);
    return status;
}

/* Reads the points of a file; their spacing h follows from the mean volume. */
static pg_status from_file (pg_cloud *c, const pg_body *body, const pg_scene *scene)
{
    pg_status status = PG_OK;
    double volume = 0;
    PG_TRY (pg_points_read (c, scene));
    PG_TRY (check_volumes (c, scene));
    for (size_t i = 0; i < c->n; i++) volume += c->volume[i];
    c->h = pow (volume / (double) c->n / c->thickness, 1.0 / c->dim);
    for (int k = 0; k < c->dim; k++) c->step[k] = c->h;
    if (pg_scene_count (scene, "body")) PG_TRY (check_inside (c, body, scene));
done:
    return status;
}

pg_status pg_cloud_divide (pg_cloud *c, double width, int **owner)
{
    pg_status status = PG_OK;
    cloud_division d = { 0 };
    int size = pg_rank_count ();
    PG_TRY (cloud_count_owned ((double) c->n, c->n < (size_t) size, size));
    PG_TRY (cloud_divide_points (&d, c, width, size));
    PG_TRY (cloud_subdomain_of_points (&c->subdomain, c, &d, pg_rank ()));
    *owner = d.owner, d.owner = NULL;
done:
    cloud_division_clear (&d);
    return status;
}

/* The spacing and offset that the scene gives. */
typedef struct { double spacing, offset[3]; int shifted, centred; } grid;
static pg_status read_grid (grid *g, const pg_scene *scene)
{
    const char *kind = pg_scene_text (scene, "lattice");
    *g = (grid) { .spacing = pg_scene_number (scene, "spacing"), .centred = kind && !strcmp (kind, "cells") };
    g->shifted = pg_scene_vector (scene, 3, g->offset, "lattice_offset") > 0;
    if (!(g->spacing > 0))
        pg_scene_fault (scene, "spacing", "is missing: the distance of points is needed to fill the body");
    return pg_scene_verdict (scene);
}

/* Turns the failure PG_E_LIMIT of a lattice into an error of the input file: the spacing is too fine. */
static pg_status judge_fit (pg_status status, const grid *g, const pg_body *body, const pg_scene *scene)
{
    double cells = 1;
    if (status != PG_E_LIMIT) return status;
    for (int k = 0; k < body->dim; k++) cells *= (body->high[k] - body->low[k]) / g->spacing;
    pg_scene_fault (scene, "spacing",
                    "too fine for this body: %.3g cells, and %d are possible (%.2g m or more)", cells,
                    INT_MAX, 1.01 * g->spacing * pow (cells / INT_MAX, 1.0 / body->dim));
    return pg_scene_verdict (scene);
}

/* Reports a spacing so coarse that no cell has its centre in the body. */
static pg_status check_cells (const pg_lattice *l, const pg_scene *scene)
{
    pg_status status = PG_OK;
    size_t n = (size_t) l->count[0] * (size_t) l->count[1] * (size_t) l->count[2];
    const int *count = l->whole[0] ? l->whole : l->count;
    double any = n > 0 && memchr (l->in, 1, n);
    PG_TRY (pg_ranks_most (1, &any));
    if (any > 0) return PG_OK;
    pg_scene_fault (scene, "spacing",
                    "no point: none of the %d x %d x %d lattice cells has its centre in the body", count[0],
                    count[1], count[2]);
    return pg_scene_verdict (scene);
done:
    return status;
}

static double spacing_of (const pg_lattice *l)
{
    double cell = 1;
    for (int k = 0; k < l->dim; k++) cell *= l->step[k];
    return l->dim == 1 ? cell : l->dim == 2 ? sqrt (cell) : cbrt (cell);
}

static int has_no_lattice (const pg_scene *scene)
{
    return pg_scene_given (scene, "points") || pg_scene_given (scene, "mesh");
}

/* All points of the body, from a file of points or from a mesh. */
static pg_status all_points (pg_cloud *c, const pg_body *body, const pg_scene *scene)
{
    pg_status status = PG_OK;
    pg_mesh_body mesh = { 0 };
    c->dim = body->dim, c->thickness = thickness_of (body->dim, scene);
    if (pg_scene_given (scene, "points")) PG_TRY (from_file (c, body, scene));
    else {
        PG_TRY (pg_mesh_body_read (&mesh, scene));
        PG_TRY (pg_mesh_body_cloud (c, &mesh, scene));
    }
done:
    pg_mesh_body_clear (&mesh);
    return status;
}

pg_status pg_cloud_spacing (double *h, const pg_body *body, const pg_scene *scene)
{
    pg_status status = PG_OK;
    pg_lattice l;
    pg_cloud c = { 0 };
    grid g;
    if (has_no_lattice (scene)) {
        PG_TRY (all_points (&c, body, scene));
        *h = c.h;
        goto done;
    }
    PG_TRY (read_grid (&g, scene));
    PG_TRY (judge_fit (pg_lattice_fit_part (&l, body, g.spacing, g.shifted ? g.offset : NULL, NULL), &g, body,
                       scene));
    *h = spacing_of (&l);
done:
    pg_cloud_clear (&c);
    return status;
}

/* Counts the points of all ranks, each of which must own some. */
static pg_status count_all (pg_subdomain *d)
{
    pg_status status = PG_OK;
    double total = (double) d->nowned, none = d->nowned == 0;
    PG_TRY (pg_ranks_sum (1, &total));
    PG_TRY (pg_ranks_most (1, &none));
    PG_TRY (cloud_count_owned (total, none > 0, pg_rank_count ()));
    d->total = (int64_t) total;
done:
    return status;
}

/* `lattice: cells` puts points at centres, else at vertices. part 1: builds only the part of this rank, with
 * a layer of ghosts of `width`, m. */
static pg_status from_lattice (pg_cloud *c, pg_lattice *l, const pg_body *body, const pg_scene *scene,
                               int part, double width)
{
    pg_status status = PG_OK;
    sites s = {0};
    grid g;
    pg_box *boxes = NULL;
    PG_TRY (read_grid (&g, scene));
    const double *offset = g.shifted ? g.offset : NULL;
    if (part) {
        PG_TRY (judge_fit (pg_lattice_fit_part (l, body, g.spacing, offset, NULL), &g, body, scene));
        PG_TRY (cloud_divide (&boxes, l, body, pg_rank_count ()));
        pg_box held = cloud_cells_held (&boxes[pg_rank ()], l, width, g.centred);
        PG_TRY (pg_lattice_fit_part (l, body, g.spacing, offset, &held));
    } else PG_TRY (judge_fit (pg_lattice_fit (l, body, g.spacing, offset), &g, body, scene));
    PG_TRY (check_cells (l, scene));
    for (int k = 0; k < c->dim; k++) c->step[k] = l->step[k];
    c->h = spacing_of (l);
    PG_TRY (cloud_count_around (&s, l, g.centred));
    PG_TRY (place_points (c, l, &s, pg_scene_number (scene, "perturb.amount"),
                          (uint64_t) pg_scene_integer (scene, "perturb.seed")));
    if (part) {
        PG_TRY (cloud_subdomain (&c->subdomain, &s, l, boxes, width, pg_rank (), pg_rank_count ()));
        PG_TRY (count_all (c->subdomain));
    }
    c->centred = g.centred;
    c->regular = !(pg_scene_number (scene, "perturb.amount") > 0);
done:
    pg_free (s.around), pg_free (boxes);
    return status;
}

/* Finds the bounding box of the points of all ranks. */
static pg_status bound_all (pg_cloud *c)
{
    pg_status status = PG_OK;
    double out[6];
    pg_place_bounds (c);
    for (int k = 0; k < 3; k++) out[k] = -c->low[k], out[3 + k] = c->high[k];
    PG_TRY (pg_ranks_most (6, out));
    for (int k = 0; k < c->dim; k++) c->low[k] = -out[k], c->high[k] = out[3 + k];
done:
    return status;
}

/* Builds the cloud from a file or from a lattice; on failure nothing remains. */
static pg_status build (pg_cloud *out, pg_lattice *lattice, const pg_body *body, const pg_scene *scene,
                        int part, double width)
{
    pg_status status = PG_OK;
    memset (out, 0, sizeof *out);
    memset (lattice, 0, sizeof *lattice);
    out->dim = body->dim;
    out->thickness = thickness_of (out->dim, scene);
    if (pg_scene_given (scene, "points")) {
        PG_TRY (from_file (out, body, scene));
        part = 0;
    } else PG_TRY (from_lattice (out, lattice, body, scene, part, width));
    if (part) PG_TRY (bound_all (out));
    else pg_place_bounds (out);
done:
    if (status != PG_OK) {
        pg_cloud_clear (out);
        pg_lattice_clear (lattice);
    }
    return status;
}

pg_status pg_cloud_build (pg_cloud *out, pg_lattice *lattice, const pg_body *body, const pg_scene *scene)
{
    return build (out, lattice, body, scene, 0, 0);
}

pg_status pg_cloud_build_part (pg_cloud *out, pg_lattice *lattice, const pg_body *body, const pg_scene *scene,
                               double width)
{
    return build (out, lattice, body, scene, pg_ranks_now () != NULL, width);
}

static pg_part_size size_of (const pg_subdomain *d)
{
    return (pg_part_size) { (double) d->nowned, (double) (d->n - d->nowned), (int) d->halo.n,
                            (double) d->halo.send_first[d->halo.n] };
}

/* Sizes of the parts of all ranks for points of a file or a mesh. */
static pg_status parts_of_file (pg_part_size *out, const pg_body *body, const pg_scene *scene, double width,
                                int size)
{
    pg_status status = PG_OK;
    pg_cloud c = { 0 };
    pg_subdomain *d = NULL;
    cloud_division how = { 0 };
    PG_TRY (all_points (&c, body, scene));
    PG_TRY (cloud_count_owned ((double) c.n, c.n < (size_t) size, size));
    PG_TRY (cloud_divide_points (&how, &c, width, size));
    for (int r = 0; r < size; r++) {
        PG_TRY (cloud_subdomain_of_points (&d, &c, &how, r));
        out[r] = size_of (d);
        pg_subdomain_free (&d);
    }
done:
    cloud_division_clear (&how);
    pg_cloud_clear (&c);
    return status;
}

/* On a lattice the parts are built one after the other as each rank would do, so that only one is in
 * memory. */
pg_status pg_cloud_parts (pg_part_size *out, const pg_body *body, const pg_scene *scene, double width,
                          int size)
{
    if (has_no_lattice (scene)) return parts_of_file (out, body, scene, width, size);
    pg_status status = PG_OK;
    pg_lattice whole = { 0 }, l = { 0 };
    pg_subdomain *d = NULL;
    sites s = { 0 };
    grid g;
    pg_box *boxes = NULL;
    double total = 0;
    int empty = 0;
    PG_TRY (read_grid (&g, scene));
    const double *offset = g.shifted ? g.offset : NULL;
    PG_TRY (judge_fit (pg_lattice_fit_part (&whole, body, g.spacing, offset, NULL), &g, body, scene));
    PG_TRY (cloud_divide (&boxes, &whole, body, size));
    for (int r = 0; r < size; r++) {
        pg_box held = cloud_cells_held (&boxes[r], &whole, width, g.centred);
        PG_TRY (pg_lattice_fit_part (&l, body, g.spacing, offset, &held));
        PG_TRY (cloud_count_around (&s, &l, g.centred));
        PG_TRY (cloud_subdomain (&d, &s, &l, boxes, width, r, size));
        out[r] = size_of (d);
        total += out[r].owned, empty |= d->nowned == 0;
        pg_subdomain_free (&d), pg_lattice_clear (&l), pg_free (s.around), s.around = NULL;
    }
    PG_TRY (cloud_count_owned (total, empty, size));
done:
    pg_subdomain_free (&d), pg_lattice_clear (&l), pg_lattice_clear (&whole);
    pg_free (s.around), pg_free (boxes);
    return status;
}

double pg_cloud_ratio (const pg_cloud *cloud, size_t i)
{
    return cloud->size ? cloud->size[i] / cloud->h : 1;
}

double pg_cloud_length2 (const pg_cloud *cloud, size_t i, const double *z)
{
    size_t dim = (size_t) cloud->dim;
    const double *A = cloud->metric ? cloud->metric + i * dim * dim : NULL;
    double sum = 0;
    for (size_t k = 0; k < dim; k++) {
        double row = 0;
        for (size_t l = 0; A && l < dim; l++) row += A[k * dim + l] * z[l];
        sum += z[k] * (A ? row : z[k]);
    }
    return sum;
}

double pg_cloud_slender (const pg_cloud *cloud, size_t i)
{
    size_t dim = (size_t) cloud->dim;
    double trace = 0;
    if (!cloud->metric) return 1;
    for (size_t k = 0; k < dim; k++) trace += cloud->metric[(i * dim + k) * dim + k];
    return sqrt (trace / (double) dim);
}

double pg_cloud_finest (const pg_cloud *cloud)
{
    double least = cloud->size ? INFINITY : cloud->h;
    for (size_t i = 0; cloud->size && i < cloud->n; i++) least = fmin (least, cloud->size[i]);
    return least;
}

double pg_cloud_same (const pg_cloud *cloud)
{
    return 1e-9 * cloud->h + pg_rounding (cloud->dim, cloud->low, cloud->high);
}

size_t pg_cloud_pieces (const pg_cloud *cloud, double length, double most)
{
    return (size_t) fmax (1, ceil ((length - pg_cloud_same (cloud)) / most));
}

void pg_cloud_clear (pg_cloud *cloud)
{
    pg_free (cloud->size);
    pg_free (cloud->metric);
    pg_free (cloud->x);
    pg_free (cloud->volume);
    pg_free (cloud->block);
    pg_subdomain_free (&cloud->subdomain);
    memset (cloud, 0, sizeof *cloud);
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * Draws 3D bodies: a cube around each point, its faces drawn as triangles with a depth
 * buffer, so that what is nearer to the eye hides what is behind. Faces between two cubes that
 * touch are not drawn.
 *
 * Displaced cubes share their corners: a corner moves by the mean displacement of the up to
 * eight points around it, which keeps the body closed. Two points whose displacements differ
 * by more than half a cell on the picture have separated; they do not share corners, and the
 * faces between them are drawn. */
#include "picture_private.h"
#include <math.h>

/* An empty screen: no owner, full brightness, infinitely far away. */
pg_status pg_screen_open (pg_screen *s, int width, int height)
{
    pg_status status = PG_OK;
    size_t n = (size_t) width * (size_t) height;
    s->width = width, s->height = height;
    PG_ALLOC (s->owner, n);
    PG_ALLOC (s->shade, n);
    PG_ALLOC (s->depth, n);
    for (size_t p = 0; p < n; p++) s->owner[p] = PG_EMPTY, s->shade[p] = 1, s->depth[p] = -INFINITY;
done:
    return status;
}

void pg_screen_close (pg_screen *s)
{
    pg_free (s->owner);
    pg_free (s->shade);
    pg_free (s->depth);
    pg_free (s->value);
    *s = (pg_screen) { 0 };
}

void pg_screen_place (const pg_screen *s, const pg_eye *e, const double *x, double at[3])
{
    at[0] = (pg_along (e->right, x, 3) - s->left) * s->scale;
    at[1] = (s->top - pg_along (e->up, x, 3)) * s->scale;
    at[2] = pg_along (e->toward, x, 3);
}

/* 1 if a point (pixels and depth) is not hidden at one of the nine pixels around it, to within
 * `slack` (m): the edges of a face must not vanish behind the face itself by rounding. */
int pg_in_sight (const pg_screen *s, const double *at, double slack)
{
    for (int k = 0; k < 9; k++) {
        double i = floor (at[0]) + k % 3 - 1, j = floor (at[1]) + k / 3 - 1;
        if (!(i >= 0 && i < s->width && j >= 0 && j < s->height)) return 1;
        if (s->depth[(size_t) j * (size_t) s->width + (size_t) i] <= at[2] + slack) return 1;
    }
    return 0;
}

/* Barycentric coordinates w of each pixel centre decide whether it is inside, with 1e-6
 * tolerance so that two triangles with a common edge leave no pixel out; depth and value are
 * linear in w. */
void pg_triangle (pg_screen *s, const double v[3][3], int owner, float shade, const double *value)
{
    double area = (v[1][0] - v[0][0]) * (v[2][1] - v[0][1]) - (v[2][0] - v[0][0]) * (v[1][1] - v[0][1]);
    if (!(fabs (area) > 1e-9)) return;
    int first[2], last[2], most[2] = { s->width, s->height };
    for (int a = 0; a < 2; a++) {
        double low = ceil (fmin (fmin (v[0][a], v[1][a]), v[2][a]) - 0.5 - 1e-6),
               high = floor (fmax (fmax (v[0][a], v[1][a]), v[2][a]) - 0.5 + 1e-6);
        first[a] = low < 0 ? 0 : low < most[a] ? (int) low : most[a];
        last[a] = high < 0 ? -1 : high < most[a] ? (int) high : most[a] - 1;
    }
    for (int j = first[1]; j <= last[1]; j++)
        for (int i = first[0]; i <= last[0]; i++) {
            double x = i + 0.5, y = j + 0.5, w[3];
            for (int k = 0; k < 3; k++) {
                const double *p = v[(k + 1) % 3], *q = v[(k + 2) % 3];
                w[k] = ((p[0] - x) * (q[1] - y) - (q[0] - x) * (p[1] - y)) / area;
            }
            if (w[0] < -1e-6 || w[1] < -1e-6 || w[2] < -1e-6) continue;
            float depth = (float) (w[0] * v[0][2] + w[1] * v[1][2] + w[2] * v[2][2]);
            size_t at = (size_t) j * (size_t) s->width + (size_t) i;
            if (!(depth > s->depth[at])) continue;
            s->depth[at] = depth, s->owner[at] = owner, s->shade[at] = shade;
            if (value) s->value[at] = w[0] * value[0] + w[1] * value[1] + w[2] * value[2];
        }
}

/* Light from above, slightly from the left and behind the eye. In side views with axes a face
 * towards the eye is fully bright and all others are a little darker. */
float pg_light_on (const pg_eye *e, const double *normal)
{
    double right = pg_along (e->right, normal, 3), up = pg_along (e->up, normal, 3),
           toward = pg_along (e->toward, normal, 3);
    if (e->framed) return toward > 0.5 ? 1 : 0.8f;
    double light = (-0.25 * right + 0.45 * up + 0.85 * toward) / 0.78;
    return (float) (0.70 + 0.30 * fmin (fmax (light, 0), 1));
}

/* 1 if there is a point (index >= 0) and it is one of those that are drawn. */
static int kept (const pg_solid *s, int point) { return point >= 0 && (!s->keep || s->keep[point]); }

/* 1 if two points have separated: their displacements on the picture differ by more than half a cell. If one
 * is nearly intact (damage below 0.1) they have not, however much displacements are magnified. */
static int torn (const pg_solid *s, int i, int j)
{
    if (s->damage && fmin (s->damage[i], s->damage[j]) < 0.1) return 0;
    for (int a = 0; s->u && a < 3; a++)
        if (fabs (s->magnify * (s->u[3 * (size_t) i + (size_t) a] - s->u[3 * (size_t) j + (size_t) a]))
            > 0.5 * s->grid->step[a])
            return 1;
    return 0;
}

/* Projects a corner (0 or 1 along each axis) of the cube of point i to pixels and depth. The corner moves
 * with the mean displacement of the up to eight points around it that have not separated from point i. */
static void corner_at (const pg_solid *s, const pg_screen *screen, int i, const int *cell, const int *corner,
                       double *out)
{
    const pg_grid *g = s->grid;
    double x[3], u[3] = { 0 }, n = 0;
    for (int a = 0; a < 3; a++) {
        if (g->loose) x[a] = s->cloud->x[3 * (size_t) i + (size_t) a] + (corner[a] - 0.5) * g->step[a];
        else
            x[a] = fmin (fmax (g->origin[a] + (cell[a] + corner[a] - 0.5) * g->step[a], g->low[a]),
                         g->high[a]);
    }
    for (int k = 0; s->u && k < 8; k++) {
        int other[3] = { cell[0] + corner[0] - (k & 1), cell[1] + corner[1] - (k >> 1 & 1),
                         cell[2] + corner[2] - (k >> 2) };
        int j = g->loose ? i : pg_grid_point (g, other);
        if (!kept (s, j) || torn (s, i, j)) continue;
        for (int a = 0; a < 3; a++) u[a] += s->u[3 * (size_t) j + (size_t) a];
        n++;
    }
    for (int a = 0; a < 3 && n > 0; a++) x[a] += s->magnify * u[a] / n;
    pg_screen_place (screen, s->eye, x, out);
}

/* Draws one face of a cube as two triangles; faces seen edge-on are set a little farther from the eye, so
 * that they do not show over neighbouring faces. */
static void draw_face (const pg_solid *s, pg_screen *screen, int i, const int *cell, int axis, int side)
{
    static const int round[4][2] = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } };
    double v[4][3], normal[3] = { 0 };
    normal[axis] = side ? 1 : -1;
    for (int k = 0; k < 4; k++) {
        int corner[3];
        corner[axis] = side, corner[(axis + 1) % 3] = round[k][0], corner[(axis + 2) % 3] = round[k][1];
        corner_at (s, screen, i, cell, corner, v[k]);
        /* edge-on: behind its neighbours */
        v[k][2] -= pg_along (s->eye->toward, normal, 3) < 0.1 ? 0.02 * s->grid->step[axis] : 0;
        if (!isfinite (v[k][0]) || !isfinite (v[k][1]) || !isfinite (v[k][2])) return;
    }
    float shade = pg_light_on (s->eye, normal);
    double second[3][3] = { { v[0][0], v[0][1], v[0][2] },
                            { v[2][0], v[2][1], v[2][2] },
                            { v[3][0], v[3][1], v[3][2] } };
    pg_triangle (screen, v, i, shade, NULL);
    pg_triangle (screen, second, i, shade, NULL);
}

/* Only faces of a cube without a neighbour, or with one that has separated, are drawn. */
void pg_solid_draw (const pg_solid *s, pg_screen *screen)
{
    for (size_t i = 0; i < s->cloud->n; i++) {
        int cell[3] = { 0 };
        if (!kept (s, (int) i)) continue;
        for (int a = 0; a < 3 && !s->grid->loose; a++)
            cell[a] = pg_grid_place (s->grid, a, s->cloud->x[3 * i + (size_t) a]);
        for (int f = 0; f < 6; f++) {
            int next[3] = { cell[0], cell[1], cell[2] };
            next[f / 2] += f % 2 ? 1 : -1;
            int j = s->grid->loose ? -1 : pg_grid_point (s->grid, next);
            if (!kept (s, j) || torn (s, (int) i, j)) draw_face (s, screen, (int) i, cell, f / 2, f % 2);
        }
    }
}

/* A pixel is on the outline if one of its four neighbours is farther away by more than the
 * jump, or outside the picture. */
int pg_on_outline (const pg_screen *s, int i, int j, double jump)
{
    static const int beside[4][2] = { { 1, 0 }, { -1, 0 }, { 0, 1 }, { 0, -1 } };
    float depth = s->depth[(size_t) j * (size_t) s->width + (size_t) i];
    for (int k = 0; k < 4; k++) {
        int x = i + beside[k][0], y = j + beside[k][1];
        if (x < 0 || y < 0 || x >= s->width || y >= s->height
            || depth - s->depth[(size_t) y * (size_t) s->width + (size_t) x] > jump)
            return 1;
    }
    return 0;
}

/* Draws the whole body grey, with an outline, under the points that were chosen. */
pg_status pg_ghost_draw (const pg_solid *solid, pg_screen *screen)
{
    pg_status status = PG_OK;
    pg_screen body = { .left = screen->left, .top = screen->top, .scale = screen->scale };
    pg_solid whole = *solid;
    double jump = 2 * fmax (fmax (solid->grid->step[0], solid->grid->step[1]), solid->grid->step[2]);
    whole.keep = NULL;
    PG_TRY (pg_screen_open (&body, screen->width, screen->height));
    pg_solid_draw (&whole, &body);
    for (int j = 0; j < body.height; j++)
        for (int i = 0; i < body.width; i++) {
            size_t p = (size_t) j * (size_t) body.width + (size_t) i;
            if (screen->owner[p] >= 0 || body.owner[p] < 0) continue;
            screen->owner[p] = pg_on_outline (&body, i, j, jump) ? PG_EDGE : PG_GHOST;
            screen->shade[p] = body.shade[p], screen->depth[p] = body.depth[p];
        }
done:
    pg_screen_close (&body);
    return status;
}

/* Draws an oblique plane through an undeformed lattice: each pixel shows the point of the cell that its
 * position in space falls into. */
void pg_slice_draw (const pg_grid *g, const pg_eye *e, pg_screen *s)
{
    for (int j = 0; j < s->height; j++)
        for (int i = 0; i < s->width; i++) {
            double a = s->left + (i + 0.5) / s->scale, b = s->top - (j + 0.5) / s->scale;
            int cell[3], inside = 1;
            for (int k = 0; k < 3; k++) {
                double x = a * e->right[k] + b * e->up[k] + e->at * e->toward[k];
                inside &= x >= g->low[k] && x <= g->high[k];
                cell[k] = pg_grid_place (g, k, x);
            }
            if (inside) s->owner[(size_t) j * (size_t) s->width + (size_t) i] = pg_grid_point (g, cell);
        }
}

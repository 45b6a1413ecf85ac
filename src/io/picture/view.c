/* SPDX-License-Identifier: GPL-3.0-or-later
 * The direction of view: a plane body, a section, a solid from one of its sides or obliquely;
 * always a parallel projection. Also the reading of sections, directions and file names from
 * text. */
#include "picture_private.h"
#include "perigal/vector.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

const char pg_view_names[] = "section|front|back|left|right|top|bottom|iso|crack";

double pg_along (const double *direction, const double *x, int dim)
{
    double s = 0;
    for (int k = 0; k < dim; k++) s += direction[k] * x[k];
    return s;
}

/* For the views front, back, left, right, top, bottom: which coordinate runs across and which
 * upwards, and with which sign. */
static const signed char side_axis[][2] = { { 0, 1 }, { 0, 1 }, { 2, 1 }, { 2, 1 }, { 0, 2 }, { 0, 2 } };
static const signed char side_sign[][2] = { { 1, 1 }, { -1, 1 }, { 1, 1 }, { -1, 1 }, { 1, -1 }, { 1, 1 } };

/* Sets an eye that looks along a coordinate axis: axis `across` to the right, `up` upwards. */
static void face (pg_eye *e, int across, int across_sign, int up, int up_sign)
{
    e->axis[0] = across, e->axis[1] = up, e->sign[0] = across_sign, e->sign[1] = up_sign;
    e->right[across] = across_sign, e->up[up] = up_sign;
    pg_cross3 (e->right, e->up, e->toward);
    e->framed = 1;
}

/* Sets an eye that looks along any direction, with y upwards; nearly along y with -z (from above)
 * or z (from below) upwards. An axis of the picture that happens to be a coordinate axis is
 * stored in e->axis, so that its label can name it. */
static void look (pg_eye *e, const double *direction)
{
    double size = sqrt (pg_along (direction, direction, 3)), vertical[3] = { 0, 1, 0 };
    for (int k = 0; k < 3; k++) e->toward[k] = direction[k] / size;
    if (fabs (e->toward[1]) > 0.999) vertical[1] = 0, vertical[2] = e->toward[1] > 0 ? -1 : 1;
    pg_cross3 (vertical, e->toward, e->right);
    size = sqrt (pg_along (e->right, e->right, 3));
    for (int k = 0; k < 3; k++) e->right[k] /= size;
    pg_cross3 (e->toward, e->right, e->up);
    for (int a = 0; a < 2; a++) {
        const double *v = a ? e->up : e->right;
        e->axis[a] = -1;
        for (int k = 0; k < 3; k++)
            if (fabs (v[k]) > 1 - 1e-9) e->axis[a] = k, e->sign[a] = v[k] > 0 ? 1 : -1;
    }
}

/* Decides by dimension, view and section what kind of picture it is. The mid-plane of z is the section of
 * a 3D body when none was asked for. */
pg_status pg_eye_open (pg_eye *e, const pg_cloud *cloud, const pg_picture_style *style)
{
    static const double usual[] = { 0.62, 0.46, 0.80 };
    pg_status status = PG_OK;
    int given = pg_along (style->direction, style->direction, 3) > 0;
    *e = (pg_eye) { .cut = -1 };
    if (cloud->dim < 3) {
        face (e, 0, 1, 1, 1);
    } else if (style->view >= PG_VIEW_ISO) {
        e->kind = PG_SOLID;
        look (e, given ? style->direction : usual);
    } else if (style->view != PG_SECTION) {
        int k = style->view - PG_VIEW_FRONT;
        e->kind = PG_SOLID;
        face (e, side_axis[k][0], side_sign[k][0], side_axis[k][1], side_sign[k][1]);
    } else if (style->section == 4) {
        if (!given) PG_FAIL (PG_E_USAGE, "an oblique section needs a direction");
        e->kind = PG_SLICE, e->framed = 1, e->at = style->at;
        look (e, style->direction);
    } else {
        e->kind = PG_LAYER;
        e->cut = style->section >= 1 && style->section <= 3 ? style->section - 1 : 2;
        face (e, e->cut == 0 ? 1 : 0, 1, e->cut == 2 ? 1 : 2, 1);
        e->at = style->section ? style->at : 0.5 * (cloud->low[2] + cloud->high[2]);
    }
done:
    return status;
}

/* Reads up to three numbers between commas from n characters; returns how many, 0 for anything
 * else. */
static int numbers_of (const char *text, size_t n, double *out)
{
    char copy[128], *s = copy, *end;
    int count = 0;
    if (n >= sizeof copy) return 0;
    memcpy (copy, text, n);
    copy[n] = 0;
    for (; count < 3; s = end + 1) {
        out[count] = strtod (s, &end);
        if (end == s || !isfinite (out[count])) return 0;
        count++;
        end += strspn (end, " ");
        if (*end != ',') break;
    }
    return *end == 0 ? count : 0;
}

pg_status pg_picture_direction (double direction[3], const char *text)
{
    pg_status status = PG_OK;
    double d[3] = { 0 };
    if (numbers_of (text, strlen (text), d) != 3 || !(pg_along (d, d, 3) > 0)
        || !isfinite (pg_along (d, d, 3)))
        PG_FAIL (PG_E_USAGE, "%s: expected a direction x,y,z that is not zero, such as 1,0.5,2", text);
    memcpy (direction, d, sizeof d);
done:
    return status;
}

/* Reads "z = 5 mm" or a normal and its distance, "1, 0, 1 = 5 mm"; a number without a unit is in metres. */
pg_status pg_picture_section (pg_picture_style *style, const char *text)
{
    pg_status status = PG_OK;
    const char *sign = strchr (text, '='), *first = text + strspn (text, " ");
    double normal[3] = { 0 }, at;
    if (!sign)
        PG_FAIL (PG_E_USAGE, "%s: expected AXIS = PLACE, such as z = 5 mm, or a normal: 1, 0, 1 = 5 mm",
                 text);
    int axis = *first && strchr ("xyz", *first) && first + 1 + strspn (first + 1, " ") == sign
                   ? *first - 'x' + 1
                   : 0;
    if (!axis
        && (numbers_of (text, (size_t) (sign - text), normal) != 3 || !(pg_along (normal, normal, 3) > 0)))
        PG_FAIL (PG_E_USAGE, "%s: expected AXIS = PLACE, such as z = 5 mm, or a normal: 1, 0, 1 = 5 mm",
                 text);
    if (numbers_of (sign + 1, strlen (sign + 1), (double[3]) { 0 }) == 1) at = strtod (sign + 1, NULL);
    else PG_TRY (pg_unit_parse (&at, sign + 1 + strspn (sign + 1, " "), "m"));
    style->view = PG_SECTION, style->section = axis ? axis : 4, style->at = at;
    if (!axis) memcpy (style->direction, normal, sizeof normal);
done:
    return status;
}

/* Keeps letters, digits and ". - _"; a run of other characters becomes one "_", none at the ends. */
void pg_picture_name (char *out, size_t size, const char *text)
{
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.-_";
    size_t n = strlen (out);
    for (; *text && n + 1 < size; text++) {
        if (strchr (plain, *text)) out[n++] = *text;
        else if (n > 0 && out[n - 1] != '_') out[n++] = '_';
    }
    while (n > 0 && out[n - 1] == '_') n--;
    out[n] = 0;
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * Statistics of the cracks that a scene gives, of all together and of every entry of `cracks` that holds
 * several: number, length, direction, intensity. */
#include "results_private.h"
#include <math.h>
#include <string.h>

/* Measures the cracks of one entry; the temporary list borrows them. */
static pg_status measure_entry (pg_crack_statistics *out, const pg_cracks *all, size_t entry,
                                const pg_scene *scene)
{
    pg_status status = PG_OK;
    pg_cracks some = { .dim = all->dim };
    PG_ALLOC (some.crack, all->n);
    for (size_t k = 0; k < all->n; k++)
        if (all->crack[k].entry == entry) some.crack[some.n++] = all->crack[k];
    if (some.n == 0) goto done;
    out->set[out->nset].entry = entry;
    PG_TRY (pg_network_measure (&out->set[out->nset++].of, &some, scene));
done:
    pg_free (some.crack);
    return status;
}

/* Measures all cracks together, and those of each entry if there are several entries, one of them with
 * several cracks. */
pg_status pg_crack_statistics_measure (pg_crack_statistics *out, const pg_cracks *all, const pg_scene *scene)
{
    pg_status status = PG_OK;
    size_t entries = pg_scene_count (scene, "cracks");
    memset (out, 0, sizeof *out);
    out->dim = all->dim;
    PG_TRY (pg_network_measure (&out->all, all, scene));
    if (entries < 2 || out->all.n <= entries) goto done;
    for (size_t e = 0; e < entries && out->nset < PG_CRACK_SETS; e++)
        PG_TRY (measure_entry (out, all, e, scene));
done:
    return status;
}

double pg_network_direction (const pg_network *n)
{
    return fmod (atan2 (n->axis[1], n->axis[0]) * 180 / acos (-1) + 180, 180);
}

/* Writes one set of statistics. Intensities have the names P21 and P32 of Dershowitz and Herda (1992): length
 * per area, area per volume. */
static void write_network (pg_json *j, const pg_network *n, int dim)
{
    pg_json_count (j, "count", n->n);
    pg_json_count (j, "slots", n->slots);
    pg_json_count (j, "crossing", n->crossing);
    pg_json_count (j, "leaving", n->leaving);
    pg_json_count (j, "outside", n->outside);
    pg_json_count (j, "drawn_in_vain", n->vain);
    pg_json_number (j, dim == 2 ? "length" : "area", n->size);
    pg_json_number (j, dim == 2 ? "length_inside" : "area_inside", n->inside);
    pg_json_number (j, dim == 2 ? "P21" : "P32", n->body > 0 ? n->inside / n->body : NAN);
    pg_json_number (j, "removed", n->removed);
    pg_json_number (j, "body", n->body);
    pg_json_number (j, "mean_length", n->mean);
    pg_json_number (j, "deviation", n->deviation);
    pg_json_number (j, "least_length", n->least);
    pg_json_number (j, "largest_length", n->most);
    if (dim == 2) pg_json_number (j, "direction", pg_network_direction (n));
    else {
        pg_json_open (j, "normal", '[');
        for (int k = 0; k < 3; k++) pg_json_number (j, NULL, n->axis[k]);
        pg_json_shut (j);
    }
    pg_json_number (j, "order", n->order);
    pg_json_number (j, "least_distance", n->nearest);
}

void pg_crack_statistics_json (pg_json *j, const char *name, const pg_crack_statistics *s)
{
    if (s->all.n == 0) return;
    pg_json_open (j, name, '{');
    write_network (j, &s->all, s->dim);
    if (s->nset) pg_json_open (j, "sets", '[');
    for (size_t k = 0; k < s->nset; k++) {
        pg_json_open (j, NULL, '{');
        pg_json_count (j, "entry", s->set[k].entry);
        write_network (j, &s->set[k].of, s->dim);
        pg_json_shut (j);
    }
    if (s->nset) pg_json_shut (j);
    pg_json_shut (j);
}

/* Measures the cracks of a run once, when its folder is opened. */
pg_status pg_result_network_read (pg_result *r, const pg_scene *scene)
{
    pg_status status = PG_OK;
    pg_cracks all = { 0 };
    PG_TRY (pg_network_read (&all, scene));
    PG_TRY (pg_crack_statistics_measure (&r->network, &all, scene));
done:
    pg_cracks_clear (&all);
    return status;
}

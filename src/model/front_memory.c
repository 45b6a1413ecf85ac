/* SPDX-License-Identifier: GPL-3.0-or-later
 * Memory of the fronts of cracks in space: arrays that grow with the number of vertices, and copies. */
#include "model.h"
#include <string.h>

#define RESIZE(p, n) \
    do { \
        void *more_ = pg_resize ((p), (n), sizeof *(p)); \
        if (!more_) PG_FAIL (PG_E_MEMORY, "no memory for a front of %zu vertices", (size_t) (n)); \
        (p) = more_; \
    } while (0)

/* Makes room for n vertices of a front, and as many more: it seldom moves while it grows one by one. */
pg_status pg_front_reserve (pg_front *f, size_t n)
{
    pg_status status = PG_OK;
    if (n <= f->capacity) return PG_OK;
    size_t most = 2 * n + 16;
    RESIZE (f->x, 3 * most);
    RESIZE (f->normal, 3 * most);
    RESIZE (f->ahead, 3 * most);
    RESIZE (f->offset, most);
    RESIZE (f->grown, most);
    RESIZE (f->meets, most);
    f->capacity = most;
done:
    return status;
}

pg_status pg_front_copy (pg_front *to, const pg_front *from)
{
    pg_status status = PG_OK;
    size_t n = from->n;
    PG_TRY (pg_front_reserve (to, n));
    PG_GROW (to->rim, to->rim_capacity, from->nrim);
    to->id = from->id, to->of = from->of;
    to->closed = from->closed, to->open = from->open, to->n = n, to->nrim = from->nrim;
    if (n) {
        memcpy (to->x, from->x, 3 * n * sizeof *to->x);
        memcpy (to->normal, from->normal, 3 * n * sizeof *to->x);
        memcpy (to->ahead, from->ahead, 3 * n * sizeof *to->x);
        memcpy (to->offset, from->offset, n * sizeof *to->x);
        memcpy (to->grown, from->grown, n * sizeof *to->x);
        memcpy (to->meets, from->meets, n);
    }
    if (from->nrim) memcpy (to->rim, from->rim, from->nrim * sizeof *to->rim);
done:
    return status;
}

void pg_front_clear (pg_front *f)
{
    pg_free (f->x), pg_free (f->normal), pg_free (f->ahead), pg_free (f->offset), pg_free (f->grown);
    pg_free (f->meets), pg_free (f->rim);
    memset (f, 0, sizeof *f);
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * Lists of records in checkpoints. A file has no structs, which would also carry the gaps between their
 * fields: each record is taken apart into whole numbers and numbers, and put together again from them. */
#include "perigal/base.h"

pg_status pg_keep_records (const pg_keeper *k, const pg_records *r)
{
    pg_status status = PG_OK;
    long *count = NULL;
    double *number = NULL;
    PG_ALLOC (count, r->counts * r->n + 1);
    PG_ALLOC (number, r->numbers * r->n + 1);
    for (size_t i = 0; !k->reading && i < r->n; i++)
        r->give (r->context, i, count + r->counts * i, number + r->numbers * i);
    PG_TRY (k->counts (k->context, r->count_name, r->counts * r->n, count));
    PG_TRY (k->numbers (k->context, r->number_name, r->numbers * r->n, number));
    for (size_t i = 0; k->reading && i < r->n; i++)
        PG_TRY (r->take (r->context, i, count + r->counts * i, number + r->numbers * i, k));
done:
    pg_free (count), pg_free (number);
    return status;
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * list_kernel.h: the traversal of a list of bonds, written once for all laws, dimensions and instruction sets
 * (private, no guard): list_instances.h includes it with LAW, LAW_BREAKS and LEAST_DIMENSION defined, and
 * defines its vectors. It uses of a law (LAW = pair_linear, say)
 *   LAW_columns (dim, check)   numbers of a record to be fetched
 *   LAW_sums (dim)             numbers that a point sums
 *   LAW_first, LAW_terms       the first number of a bond that it reads, and how many
 *   LAW_shared                 1: bonds of slots[0] give the opposite of their sums to the other end
 *   LAW_over (dim, own, other, limit, constant): lanes with bonds at or over their limit
 * LAW_add (dim, own, other, term, live, constant, out): what the bond adds to the own sums, 0 in lanes of
 * broken
 *                              bonds. */
#define OF_LAW(what) GLUE (LAW, what)

/* Breaks the bonds of a slot that are at or over their limit: clears their bits in `alive` and sets them in
 * `lost`. Returns the bits of intact bonds. __builtin_expect: this is rare. */
INLINE unsigned OF_LAW (_break) (const bond_slots *slots, size_t k, unsigned shift, unsigned live,
                                 const V *own,
                                 const V *other, const double *limit, const double *constant, const int dim,
                                 int *broke)
{
#if LAW_BREAKS
    unsigned over = OF_LAW (_over) (dim, own, other, V_LOAD (limit + shift), constant) & live;
    if (__builtin_expect (over != 0, 0)) {
        slots->alive[k] ^= (unsigned char) (over << shift);
        slots->lost[k] |= (unsigned char) (over << shift);
        live ^= over, *broke = 1;
    }
#else
    (void) slots, (void) k, (void) shift, (void) own, (void) other, (void) limit, (void) constant, (void) dim;
    (void) broke;
#endif
    return live;
}

/* Sums the slots of one slice and one sort: fetches the records of the other ends, checks limits, adds to the
 * own sums, and gives the opposite to the other ends if bonds are shared. Numbers and ends of later slots are
 * prefetched, as they are read once and in order. */
INLINE void OF_LAW (_slots) (const bond_list *list, const bond_slots *slots, size_t slice, const double *from,
                             const double *constant, double *sum, lanes *lane, const int dim, const int check,
                             const int gives, int *broke)
{
    enum { AHEAD = 64 };                               /* slots by which prefetching is ahead */
    const double *restrict limit = check ? list->limit + LIST_LANES * slots->limit_at[slice] : NULL;
    const size_t end = slots->start[slice + 1], step = check ? slots->limit_step[slice] : 0;
    const uint16_t *restrict near = slots->near;
    const uint32_t *restrict far = slots->far;
    const unsigned char *alive = slots->alive;
    const double *restrict terms[LIST_TERMS];
    UNROLL for (int t = 0; t < OF_LAW (_terms); t++) terms[t] = slots->term[OF_LAW (_first) + t];
    for (size_t k = slots->start[slice]; k < end; k++) {
        UNROLL for (int t = 0; t < OF_LAW (_terms); t++)
            __builtin_prefetch (terms[t] + LIST_LANES * (k + AHEAD));
        if (gives) __builtin_prefetch (near + LIST_LANES * (k + AHEAD));
        else __builtin_prefetch (far + LIST_LANES * (k + AHEAD));
        for (int part = 0; part < PARTS; part++) {
            const unsigned all = (1u << WIDTH) - 1, shift = (unsigned) (part * WIDTH);
            const size_t at = LIST_LANES * k + shift;
            lanes *l = &lane[part];
            unsigned live = (unsigned) alive[k] >> shift & all;
            V other[MOST_COLUMNS], term[LIST_TERMS], out[MOST_SUMS];
            if (gives) FETCH (from, near + at, OF_LAW (_columns) (dim, check), other);
            else FETCH (from, far + at, OF_LAW (_columns) (dim, check), other);
            UNROLL for (int t = 0; t < OF_LAW (_terms); t++) term[t] = V_LOAD (terms[t] + at);
            if (check) live = OF_LAW (_break) (slots, k, shift, live, l->own, other, limit, constant, dim,
                                               broke);
            OF_LAW (_add) (dim, l->own, other, term, live, constant, out);
            UNROLL for (int c = 0; c < OF_LAW (_sums) (dim); c++) l->sum[c] = l->sum[c] + out[c];
            if (gives) GIVE (sum, near + at, dim, out);
        }
        if (check) limit += step;
    }
}

/* Sums all bonds of a slice; `sum` is that of its chunk, whose first record is `first`. */
INLINE void OF_LAW (_slice) (const bond_list *list, const double *first, const size_t slice, double *sum,
                             const int dim, const int check, int *broke)
{
    const size_t pitch = (size_t) list->pitch;
    const double *own = list->record + pitch * LIST_LANES * slice;
    const size_t in_chunk = (size_t) (own - first) / (pitch * LIST_LANES);
    lanes lane[PARTS];
    double constant[LIST_CONSTANTS];
    uint32_t row[LIST_LANES];
    for (int c = 0; c < LIST_CONSTANTS; c++) constant[c] = list->constant[c];
    for (uint32_t l = 0; l < LIST_LANES; l++) row[l] = l * (uint32_t) pitch;
    for (int part = 0; part < PARTS; part++) {
        FETCH (own, row + part * WIDTH, OF_LAW (_columns) (dim, check), lane[part].own);
        UNROLL for (int c = 0; c < OF_LAW (_sums) (dim); c++) lane[part].sum[c] = V_SET (0);
    }
    if (OF_LAW (_shared))
        OF_LAW (_slots) (list, &list->slots[0], slice, first, constant, sum, lane, dim, check, 1, broke);
    OF_LAW (_slots) (list, &list->slots[1], slice, list->record, constant, sum, lane, dim, check, 0, broke);
    for (int part = 0; part < PARTS; part++) {
        V *total = lane[part].sum;
        if (OF_LAW (_shared)) {                        /* adds the own sums to those given by other slices */
            UNROLL for (int c = 0; c < OF_LAW (_sums) (dim); c++) total[c] = V_SET (0) - total[c];
            GIVE (sum + (own - first) / 2, row + part * WIDTH, dim, total);
        } else {
            double *to = sum + in_chunk * OF_LAW (_sums) (dim) * LIST_LANES + (size_t) (part * WIDTH);
            UNROLL for (int c = 0; c < OF_LAW (_sums) (dim); c++) V_STORE (to + c * LIST_LANES, total[c]);
        }
    }
}

/* Sums all slices of a chunk, in order; returns whether a bond broke. Sums of shared laws get contributions
 * of both ends and start at zero. */
INLINE int OF_LAW (_chunk) (const bond_list *list, size_t chunk, double *sum, const int dim, const int check)
{
    const size_t first = chunk * list->chunk / LIST_LANES, end = (chunk + 1) * list->chunk / LIST_LANES;
    const size_t last = end < list->slices ? end : list->slices;
    const double *record = list->record + (size_t) list->pitch * chunk * list->chunk;
    int broke = 0;
    const size_t sums = (last - first) * LIST_LANES * (size_t) list->pitch / 2;
    if (OF_LAW (_shared)) memset (sum, 0, sums * sizeof *sum);
    for (size_t slice = first; slice < last; slice++)
        OF_LAW (_slice) (list, record, slice, sum, dim, check, &broke);
    return broke;
}

#define LOOP_OF(dim, check) \
    static TARGET int GLUE (OF_LAW (_), GLUE (dim, check)) (const bond_list *list, size_t chunk, \
                                                            double *sum) \
    { \
        return OF_LAW (_chunk) (list, chunk, sum, dim, check); \
    }
/* A loop that does not exist is an enumerator of value 0, which becomes a null pointer in the table. */
#define NO_LOOP(dim, check) enum { GLUE (OF_LAW (_), GLUE (dim, check)) };
#if LEAST_DIMENSION == 1
LOOP_OF (1, 0) LOOP_OF (1, 1)
#else
NO_LOOP (1, 0) NO_LOOP (1, 1)
#endif
LOOP_OF (2, 0) LOOP_OF (3, 0)
#if LAW_BREAKS
LOOP_OF (2, 1) LOOP_OF (3, 1)
#else
NO_LOOP (2, 1) NO_LOOP (3, 1)
#endif
#undef LAW
#undef LEAST_DIMENSION
#undef LAW_BREAKS
#undef OF_LAW
#undef LOOP_OF
#undef NO_LOOP

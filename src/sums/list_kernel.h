/* SPDX-License-Identifier: GPL-3.0-or-later
 * The loop over the slots of a chunk, written once for all dimensions and instruction sets: included with DIM
 * defined by a file that defines
 *   SET, TARGET            suffix of names, attribute of functions
 *   V, WIDTH               a vector of WIDTH numbers
 *   V_LOAD V_STORE V_SET V_ROOT, V_KEEP (v, bits): 0 where a bit is 0, V_LEAST (a, b): bits where a >= b
 *   V_FETCH<dim> (record, o, ...): places and displacements at offsets o; V_GIVE<dim> (sum, o, ...):
 *     subtracts forces at half these offsets. No operation is contracted and the order is the same for every
 *     WIDTH: all instruction sets give the same bits. */
#define GLUE_(a, b, c) a##b##c
#define GLUE(a, b, c) GLUE_ (a, b, c)
#define NAME(what) GLUE (what, DIM, SET)
#define PARTS (LIST_LANES / WIDTH)
#if DIM == 1
#define PITCH 2
#define EACH(S) S (0)
#define DOT(a, b) (a##0 * b##0)
#elif DIM == 2
#define PITCH 4
#define EACH(S) S (0) S (1)
#define DOT(a, b) (a##0 * b##0 + a##1 * b##1)
#else
#define PITCH 8
#define EACH(S) S (0) S (1) S (2)
#define DOT(a, b) (a##0 * b##0 + a##1 * b##1 + a##2 * b##2)
#endif
#define FETCH(record, o) GLUE (V_FETCH, DIM,) (record, o)
#define GIVE(sum, o)     GLUE (V_GIVE, DIM,) (sum, o)

typedef struct { V x[DIM], u[DIM], f[DIM]; } NAME (lanes);

/* Slots of one slice and one sort. */
#define SLOTS(type, index, from, gives) \
    do { \
        const bond_slots *slots = &list->slots[1 - gives]; \
        const type *restrict to = slots->index; \
        const double *restrict pull = slots->a, *restrict limit = check ? list->limit \
                                                                              + LIST_LANES \
                                                                                    * slots->limit_at[slice] \
                                                                        : NULL; \
        unsigned char *restrict alive = slots->alive; \
        const size_t end = slots->start[slice + 1], step = check ? slots->limit_step[slice] : 0; \
        for (size_t k = slots->start[slice]; k < end; k++, limit = check ? limit + step : NULL) \
            for (int part = 0; part < PARTS; part++) { \
                const unsigned all = (1u << WIDTH) - 1, shift = (unsigned) (part * WIDTH); \
                NAME (lanes) *l = &lane[part]; \
                const type *o = to + LIST_LANES * k + shift; \
                unsigned live = (unsigned) alive[k] >> shift & all; \
                FETCH (from, o); \
                EACH (SEPARATE) \
                V dot = DOT (d, e), value = dot, a = V_LOAD (pull + LIST_LANES * k + shift), rr = V_SET (0); \
                if (finite || check) rr = DOT (d, d); \
                if (finite) value = dot + dot + DOT (e, e); \
                if (check) { \
                    unsigned over = V_LEAST (value, V_LOAD (limit + shift) * rr) & live; \
                    if (__builtin_expect (over != 0, 0)) { \
                        alive[k] ^= (unsigned char) (over << shift), \
                            slots->lost[k] |= (unsigned char) (over << shift); \
                        live ^= over, *broke = 1; \
                    } \
                } \
                if (finite) { \
                    EACH (DEFORM) \
                    V yy = DOT (d, d); \
                    a = a * value / (yy + V_ROOT (yy * rr)); \
                } else a = a * dot; \
                a = V_KEEP (a, live); \
                EACH (PULL) \
                if (gives) GIVE (sum, o); \
            } \
    } while (0)
#define SEPARATE(c) V d##c = x##c - l->x[c], e##c = u##c - l->u[c];
#define DEFORM(c)   d##c = d##c + e##c;
#define PULL(c)     V f##c = a * d##c; l->f[c] = l->f[c] + f##c;

static inline __attribute__ ((always_inline)) TARGET void NAME (slice) (
    const bond_list *list, const size_t chunk, const size_t slice, double *restrict sum, const int finite,
    const int check, int *broke)
{
    NAME (lanes) lane[PARTS];
    const double *own = list->record + (size_t) PITCH * LIST_LANES * slice,
                 *first = list->record + (size_t) PITCH * chunk * list->chunk;
    static const uint16_t row[LIST_LANES] = { 0,         PITCH,     2 * PITCH, 3 * PITCH,
                                              4 * PITCH, 5 * PITCH, 6 * PITCH, 7 * PITCH };
    for (int part = 0; part < PARTS; part++) {
        FETCH (own, row + part * WIDTH);
#define START(c) lane[part].x[c] = x##c, lane[part].u[c] = u##c, lane[part].f[c] = V_SET (0);
        EACH (START)
#undef START
    }
    SLOTS (uint16_t, near, first, 1);
    SLOTS (uint32_t, far, list->record, 0);
    double *mine = sum + (own - first) / 2;
    for (int part = 0; part < PARTS; part++) {
        V f0 = V_SET (0) - lane[part].f[0];
#if DIM > 1
        V f1 = V_SET (0) - lane[part].f[1];
#endif
#if DIM > 2
        V f2 = V_SET (0) - lane[part].f[2];
#endif
        GIVE (mine, row + part * WIDTH);
    }
}

static inline __attribute__ ((always_inline)) TARGET int NAME (chunk) (const bond_list *list, size_t chunk,
                                                                       double *sum, const int finite,
                                                                       const int check)
{
    size_t first = chunk * list->chunk / LIST_LANES, last = (chunk + 1) * list->chunk / LIST_LANES;
    int broke = 0;
    if (last > list->slices) last = list->slices;
    memset (sum, 0, (last - first) * LIST_LANES * (PITCH / 2) * sizeof *sum);
    for (size_t slice = first; slice < last; slice++)
        NAME (slice) (list, chunk, slice, sum, finite, check, &broke);
    return broke;
}

static TARGET int NAME (linear) (const bond_list *list, size_t chunk, double *sum)
{
    return NAME (chunk) (list, chunk, sum, 0, 0);
}
static TARGET int NAME (linear_check) (const bond_list *list, size_t chunk, double *sum)
{
    return NAME (chunk) (list, chunk, sum, 0, 1);
}
static TARGET int NAME (finite) (const bond_list *list, size_t chunk, double *sum)
{
    return NAME (chunk) (list, chunk, sum, 1, 0);
}
static TARGET int NAME (finite_check) (const bond_list *list, size_t chunk, double *sum)
{
    return NAME (chunk) (list, chunk, sum, 1, 1);
}

#undef DIM
#undef PITCH
#undef EACH
#undef DOT
#undef FETCH
#undef GIVE
#undef SLOTS
#undef SEPARATE
#undef DEFORM
#undef PULL

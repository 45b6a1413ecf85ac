/* SPDX-License-Identifier: GPL-3.0-or-later
 * base.h: status codes and messages, memory, checkpoint walks, clock, threads, small dense algebra,
 * disjoint sets. Knows no physics. */
#ifndef PERIGAL_BASE_H
#define PERIGAL_BASE_H
#include <limits.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

/* The shared library exports what the headers of include/perigal declare between PG_API_BEGIN and PG_API_END.
 * Everything else is compiled with -fvisibility=hidden: it can be neither called nor replaced from
 * outside. */
#define PG_API_BEGIN _Pragma ("GCC visibility push (default)")
#define PG_API_END   _Pragma ("GCC visibility pop")
PG_API_BEGIN

/* ---- status ------------------------------------------------------------------------------------------- */
/* Every function that can fail returns one of these. Three families: input (the user can mend the scene),
 * resource (memory, files, limits), numerical (the mechanics failed). */
#define PG_STATUS_LIST(X) \
    X (OK, "ok") \
    X (E_SCENE, "the scene is wrong") \
    X (E_USAGE, "wrong use of the library or the command line") \
    X (E_FILE, "a file could not be read or written") \
    X (E_MEMORY, "not enough memory") \
    X (E_LIMIT, "too large") \
    X (E_SINGULAR, "a matrix is singular") \
    X (E_NOT_SPD, "a matrix is not positive definite") \
    X (E_EQUILIBRIUM, "no equilibrium found") \
    X (E_INTERRUPTED, "interrupted")
typedef enum {
#define X(name, text) PG_##name,
    PG_STATUS_LIST (X)
#undef X
    PG_STATUS_COUNT
} pg_status;

/* A few words for a status. */
const char *pg_status_text (pg_status status);
/* Message of the last failure on this thread; "" when there was none. Borrowed, valid until the next
 * failure. */
const char *pg_last_error (void);
/* Records a message and returns `code`. `where` is "file:line" of the source, kept for
 * pg_last_error_where. */
pg_status pg_error (pg_status code, const char *where, const char *format, ...)
    __attribute__ ((format (printf, 3, 4)));
/* Source file and line of the last failure on this thread ("file:line"). */
const char *pg_last_error_where (void);

#define PG_STRING_(x) #x
#define PG_STRING(x) PG_STRING_ (x)
/* "file:line" of the source line in which the macro is used. */
#define PG_HERE __FILE__ ":" PG_STRING (__LINE__)
/* For functions with `pg_status status = PG_OK;` and a label `done:` that releases what was acquired: PG_FAIL
 * records a message and leaves with that code; PG_TRY leaves where a call fails, and keeps its message. */
#define PG_FAIL(code, ...) do { status = pg_error ((code), PG_HERE, __VA_ARGS__); goto done; } while (0)
#define PG_TRY(call) do { status = (call); if (status != PG_OK) goto done; } while (0)

/* ---- instruction sets --------------------------------------------------------------------------------- */
/* In front of a function whose loops gain from vectors of four (PG_WIDE) or eight (PG_WIDEST) numbers: it is
 * compiled for these instruction sets and for the one that every machine has, and the machine takes its own
 * when the program is loaded. The operations and their order are the same in all of them, so the bits of a
 * result do not depend on it. Empty on other machines and compilers, in debug builds (PG_DEBUG: one function
 * only) and under the thread sanitizer, which starts after the choice is made. */
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(PG_DEBUG) \
    && !defined(__SANITIZE_THREAD__)
#define PG_WIDE   __attribute__ ((target_clones ("avx2", "default")))
#define PG_WIDEST __attribute__ ((target_clones ("avx512f", "avx2", "default")))
#else
#define PG_WIDE
#define PG_WIDEST
#endif

/* Vector of eight doubles, of any alignment: sums in eight lanes round alike with all instruction sets. */
typedef double pg_eight __attribute__ ((vector_size (64), aligned (8), may_alias));

/* ---- fingerprint of bytes ----------------------------------------------------------------------------- */
/* Folds more bytes into a fingerprint, which begins with PG_FINGERPRINT; data NULL folds nothing. */
#define PG_FINGERPRINT 14695981039346656037u
uint64_t pg_fingerprint (uint64_t so_far, const void *data, size_t bytes);
/* Folds in every step-th of n numbers, eight bytes at a time: fast, for tables in memory alone. */
uint64_t pg_fingerprint_numbers (uint64_t so_far, size_t n, size_t step, const double *value);

/* ---- memory ------------------------------------------------------------------------------------------- */
/* All memory of the library passes through these: zero-filled, overflow-checked, counted, aligned to 64
 * bytes. n elements of `size` bytes; NULL when there is no memory; n = 0 gives a valid pointer. */
void  *pg_calloc  (size_t n, size_t size);
/* As realloc, the new part zero-filled; on failure NULL, and the old block stays valid. */
void  *pg_resize  (void *p, size_t n, size_t size);
/* Frees a block of pg_calloc or pg_resize; NULL is allowed. */
void   pg_free    (void *p);
/* A copy of the text, NULL when there is no memory. */
char  *pg_strdup  (const char *text);
/* Bytes allocated now; their largest value so far; number of allocations so far. */
size_t pg_memory_used  (void);
size_t pg_memory_peak  (void);
size_t pg_memory_calls (void);
/* For tests: the k-th allocation from now fails; 0: none does. */
void   pg_memory_fail_at (size_t k);
/* Peak resident memory of the whole process, bytes. */
size_t pg_memory_process_peak (void);
/* allocator.c: how the system hands out memory. pg_memory_keep: this process keeps what it frees.
 * pg_memory_large: asks for large pages under a block, if it is large; pg_calloc and pg_resize do so
 * themselves. */
void   pg_memory_keep  (void);
void   pg_memory_large (void *block, size_t bytes);
/* malloc, calloc and realloc of C in large pages, for libraries that take such functions. */
void  *pg_memory_malloc  (size_t bytes);
void  *pg_memory_calloc  (size_t n, size_t size);
void  *pg_memory_realloc (void *block, size_t bytes);

/* Allocates n elements for the pointer p; in a function with `status` and `done:`. */
#define PG_ALLOC(p, n) do { (p) = pg_calloc ((n), sizeof *(p)); \
    if (!(p)) PG_FAIL (PG_E_MEMORY, "no memory for %zu x %zu bytes", (size_t) (n), sizeof *(p)); } while (0)
/* Grows p (cap: its capacity in elements, updated) so that `need` elements fit; doubles, so that appending
 * one by one costs linear time. */
#define PG_GROW(p, cap, need) do { if ((size_t) (need) > (cap)) { \
    size_t cap_ = 2 * (size_t) (need) + 16; void *q_ = pg_resize ((p), cap_, sizeof *(p)); \
    if (!q_) PG_FAIL (PG_E_MEMORY, "no memory for %zu x %zu bytes", cap_, sizeof *(p)); \
    (p) = q_; (cap) = cap_; } } while (0)
/* Grows one of several arrays that share a capacity, with `each` values per element, as PG_GROW does, but
 * leaves `cap` as it is: PG_GROW of the last of the arrays updates it. */
#define PG_GROW_ALSO(p, each, cap, need) do { if ((size_t) (need) > (cap)) { \
    void *q_ = pg_resize ((p), (each) * (2 * (size_t) (need) + 16), sizeof *(p)); \
    if (!q_) PG_FAIL (PG_E_MEMORY, "no memory for %zu x %zu bytes", (size_t) (need), (each) * sizeof *(p)); \
    (p) = q_; } } while (0)

/* ---- checkpoints -------------------------------------------------------------------------------------- */
/* Writer or reader of checkpoints: the same calls write all that a run must remember, or read it back into
 * the same arrays. Each call names an array of n entries. */
typedef struct {
    /* Passed to the functions; reading = 1: values are read back into the arrays. */
    void *context;
    int   reading;
    pg_status (*numbers) (void *context, const char *name, size_t n, double *value);
    pg_status (*counts)  (void *context, const char *name, size_t n, long *value);
    pg_status (*bytes)   (void *context, const char *name, size_t n, void *value);
} pg_keeper;
/* Checks a value read back from a checkpoint: PG_E_FILE unless low <= value <= high. */
pg_status pg_kept_within (const char *what, long value, long low, long high);
#define PG_KEEP_BOUND(k, what, value, low, high) \
    do { if ((k)->reading) PG_TRY (pg_kept_within ((what), (long) (value), (long) (low), (long) (high))); } \
    while (0)

/* Describes a field of a struct that is written to checkpoints: its address and bytes, the distance to the
 * field of the next struct of a list (bytes), its type, and for whole numbers the bounds and the name in
 * messages. */
typedef enum {
    PG_KEPT_END, PG_KEPT_DOUBLE, PG_KEPT_LONG, PG_KEPT_INT, PG_KEPT_UNSIGNED, PG_KEPT_SIZE, PG_KEPT_CHAR,
    PG_KEPT_BYTE, PG_KEPT_TYPES
} pg_kept_type;
typedef struct {
    void *at;  size_t bytes, stride;  pg_kept_type type;  long low, high;  const char *what;
} pg_kept;
#define PG_KEPT_TYPE(x) _Generic ((x), double: PG_KEPT_DOUBLE, double *: PG_KEPT_DOUBLE, \
    double (*)[2]: PG_KEPT_DOUBLE, double (*)[2][2]: PG_KEPT_DOUBLE, long: PG_KEPT_LONG, \
    long *: PG_KEPT_LONG, int: PG_KEPT_INT, int *: PG_KEPT_INT, unsigned: PG_KEPT_UNSIGNED, \
    size_t: PG_KEPT_SIZE, size_t *: PG_KEPT_SIZE, char: PG_KEPT_CHAR, unsigned char: PG_KEPT_BYTE)
#define PG_KEPT_ROW(at, bytes, stride, x, low, high, what) \
    { (void *) (at), (bytes), (stride), PG_KEPT_TYPE (x), (long) (low), (long) (high), (what) }
#define PG_ROWS(...) (const pg_kept[]) { __VA_ARGS__, { 0 } }
/* Descriptions (pg_kept) of a variable or an array of fixed size; of a field of every struct of a list; of m
 * values of an array for every struct. ..._IN: whole numbers from low to high. */
#define PG_KEPT(x)            PG_KEPT_IN (x, LONG_MIN, LONG_MAX, NULL)
#define PG_EACH(list, field)  PG_EACH_IN (list, field, LONG_MIN, LONG_MAX, NULL)
#define PG_ITEMS(array, m)    PG_ITEMS_IN (array, m, LONG_MIN, LONG_MAX, NULL)
#define PG_KEPT_IN(x, low, high, what)  PG_KEPT_ROW (&(x), sizeof (x), 0, x, low, high, what)
#define PG_EACH_IN(list, field, low, high, what) \
    PG_KEPT_ROW ((list) ? &(list)->field : NULL, sizeof (list)->field, sizeof *(list), (list)->field, low, \
                 high, what)
#define PG_ITEMS_IN(array, m, low, high, what) \
    PG_KEPT_ROW (array, (m) * sizeof *(array), (m) * sizeof *(array), *(array), low, high, what)
/* Writes or reads the fields of n structs as two arrays of a checkpoint: OBJECT.COUNTS has the whole numbers,
 * OBJECT.NUMBERS the others, struct by struct in the order of the rows; NULL where there are none. When they
 * are read back, nothing changes unless all whole numbers are within their bounds. */
pg_status pg_keep_fields (const pg_keeper *k, const char *object, const char *counts, const char *numbers,
                          size_t n, const pg_kept *rows);
/* Writes or reads the length n of a list as OBJECT.NAME; grows the list when it is read. */
#define PG_KEEP_LENGTH(k, object, name, list, n, cap, most, what) \
    do { \
        PG_TRY (pg_keep_fields ((k), (object), (name), NULL, 1, PG_ROWS (PG_KEPT_IN (n, 0, most, what)))); \
        if ((k)->reading) PG_GROW (list, cap, n); \
    } while (0)
pg_status pg_keep_numbers (const pg_keeper *k, const char *object, const char *name, size_t n, double *value);
/* Write or read n bytes with values from 0 to `most`; a text of fixed size, which always ends with a zero. */
pg_status pg_keep_bytes   (const pg_keeper *k, const char *name, size_t n, unsigned char *byte, int most,
                           const char *what);
pg_status pg_keep_text    (const pg_keeper *k, const char *name, size_t size, char *text);

/* ---- clock and threads --------------------------------------------------------------------------------- */
/* Monotonic wall clock, s. */
double pg_seconds (void);
/* Body of a parallel loop: treats the items first .. last - 1, on thread number `thread`. */
typedef void (*pg_work) (void *context, size_t first, size_t last, int thread);
/* Calls work on disjoint ranges that cover [0, n). Which thread gets which range does not change a result
 * as long as each item writes only its own output. For many light items: fewer than 64 run on the calling
 * thread. */
void pg_parallel (int threads, size_t n, pg_work work, void *context);
/* pg_parallel for few items, each of them long enough to be worth a thread. */
void pg_parallel_heavy (int threads, size_t n, pg_work work, void *context);

/* pg_signals_hold blocks all signals sent from outside to this thread and to threads that it starts from now
 * on, until pg_signals_release; *before: the signals that were blocked already (a sigset_t). Signals of
 * faults in the thread itself (such as SIGSEGV) are not blocked. */
typedef struct { unsigned long set[16]; } pg_signals;
void pg_signals_hold    (pg_signals *before);
void pg_signals_release (const pg_signals *before);

/* ---- sorting, searching -------------------------------------------------------------------------------- */
/* Comparison of two elements for pg_sort and pg_search, which are qsort and bsearch for lists that may also
 * be empty (address NULL). */
typedef int (*pg_order) (const void *a, const void *b);
/* Comparisons for ascending order of numbers; the order of NaN is undefined. */
static inline int pg_ascending_sizes (const void *a, const void *b)
{
    size_t x = *(const size_t *) a, y = *(const size_t *) b;
    return (x > y) - (x < y);
}
static inline int pg_ascending_ints (const void *a, const void *b)
{
    int x = *(const int *) a, y = *(const int *) b;
    return (x > y) - (x < y);
}
static inline int pg_ascending_numbers (const void *a, const void *b)
{
    double x = *(const double *) a, y = *(const double *) b;
    return (x > y) - (x < y);
}
static inline void pg_sort (void *list, size_t n, size_t size, pg_order order)
{
    if (n > 1) qsort (list, n, size, order);
}
static inline void *pg_search (const void *key, const void *list, size_t n, size_t size, pg_order order)
{
    return n ? bsearch (key, list, n, size, order) : NULL;
}

/* ---- libraries that are loaded when they are needed ---------------------------------------------------- */
/* A function of a library loaded on demand, and the offset of its pointer in the table of functions,
 * bytes. */
typedef struct { const char *name; size_t at; } pg_library_function;
/* A library loaded on demand (dlopen), and the table of its functions that the program calls. */
typedef struct {
    /* File that is loaded ("libcairo.so.2"); for messages: the Debian package that has it, and what needs it
     * ("pictures"). */
    const char *file, *package, *purpose;
    /* The functions (n) and the table that receives their pointers. */
    size_t n;
    const pg_library_function *function;
    void  *table;
    /* 1: libraries that are loaded later find these functions too. */
    int    shared;
    /* 1: the table is filled. */
    int    ready;
} pg_library;
/* Loads the library and fills its table, once per process; later calls cost one comparison. PG_E_FILE: it
 * is not installed, or lacks a function. */
pg_status pg_library_load (pg_library *library);

/* ---- small dense algebra (row-major, n <= 16) ---------------------------------------------------------- */
/* A = L L' in place (lower triangle). Returns 0, or 1 + the row whose pivot fell to `tiny` times its
 * diagonal entry or below. */
int  pg_dense_cholesky (int n, double *A, double tiny);
/* b <- (L L')^-1 b. */
void pg_dense_solve    (int n, const double *L, double *b);
/* Eigenvalues lambda (n, descending) of a symmetric A, which is kept, and unless V is NULL the eigenvectors
 * as columns of V (n x n). Jacobi's method. */
void pg_dense_eigen    (int n, const double *A, double *lambda, double *V);
/* Determinant, n = 1, 2, 3. */
double pg_dense_det    (int n, const double *A);

/* ---- disjoint sets ------------------------------------------------------------------------------------- */
/* Sets of 0 .. n - 1 as trees: parent[i] leads from a member towards the root of its set; two members
 * belong to the same set if their roots are equal. At the start every member is a set of its own. */
void pg_disjoint_start (int *parent, size_t n);
/* The root of i. Path halving (every other node on the path comes to point to its grandparent) keeps the
 * trees flat without ranks. Defined here, for it runs once for every bond. */
static inline int pg_disjoint_root (int *parent, int i)
{
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
}
/* Unites the sets of a and b; the root of b becomes that of both and is returned, so that a caller can keep
 * data at that root. */
static inline int pg_disjoint_join (int *parent, int a, int b)
{
    int below = pg_disjoint_root (parent, a), root = pg_disjoint_root (parent, b);
    parent[below] = root;
    return root;
}

/* The name of "a|b|c" nearest to a word, for messages; NULL: none is near. Valid until the next call on
 * this thread. */
const char *pg_nearest_name (const char *word, const char *choices);
PG_API_END
#endif

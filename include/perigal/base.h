/* SPDX-License-Identifier: GPL-3.0-or-later
 * base.h: status codes and messages, memory, clock, threads, small dense algebra. Knows no physics. */
#ifndef PERIGAL_BASE_H
#define PERIGAL_BASE_H
#include <stddef.h>
#include <stdint.h>

/* The shared library exports what the headers of include/perigal declare between PG_API_BEGIN and PG_API_END.
 * Everything else is compiled with -fvisibility=hidden: it can be neither called nor replaced from outside. */
#define PG_API_BEGIN _Pragma ("GCC visibility push (default)")
#define PG_API_END   _Pragma ("GCC visibility pop")
PG_API_BEGIN

/* ---- status
 * ---------------------------------------------------------------------------------------------------------
 * Three families: input (the user can mend the scene), resource (memory, files), numerical (the mechanics
 * failed). */
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

const char *pg_status_text (pg_status status);
/* Message of the last failure on this thread; "" when there was none. Borrowed, valid until the next
 * failure. */
const char *pg_last_error (void);
/* Records a message and returns `code`. `where` is "file:line" of the source, kept for
 * pg_last_error_where. */
pg_status pg_error (pg_status code, const char *where, const char *format, ...)
    __attribute__ ((format (printf, 3, 4)));
const char *pg_last_error_where (void);

#define PG_STRING_(x) #x
#define PG_STRING(x) PG_STRING_ (x)
#define PG_HERE __FILE__ ":" PG_STRING (__LINE__)
/* Inside a function with `pg_status status = PG_OK;` and a label `done:`. */
#define PG_FAIL(code, ...) do { status = pg_error ((code), PG_HERE, __VA_ARGS__); goto done; } while (0)
#define PG_TRY(call) do { status = (call); if (status != PG_OK) goto done; } while (0)

/* ---- fingerprint of bytes ------------------------------------------------------------------------------- */
/* Folds more bytes into a fingerprint, which begins with PG_FINGERPRINT; data NULL folds nothing. */
#define PG_FINGERPRINT 14695981039346656037u
uint64_t pg_fingerprint (uint64_t so_far, const void *data, size_t bytes);

/* ---- memory
 * ---------------------------------------------------------------------------------------------------------
 * All memory of the library passes here: zero-filled, overflow-checked, counted. */
void  *pg_calloc  (size_t n, size_t size);  /* NULL when there is none left; n = 0 gives a valid pointer */
void  *pg_resize  (void *p, size_t n, size_t size);    /* as realloc; the old block stays valid on failure */
void   pg_free    (void *p);                           /* NULL-safe */
char  *pg_strdup  (const char *text);
size_t pg_memory_used  (void);                         /* bytes now held */
size_t pg_memory_peak  (void);                         /* largest value of pg_memory_used so far */
size_t pg_memory_calls (void);                         /* number of allocations so far */
void   pg_memory_fail_at (size_t k);  /* testing: the k-th allocation from now fails (0: never) */
size_t pg_memory_process_peak (void);                  /* peak resident bytes of the whole process */
/* allocator.c: how glibc hands out memory. This process keeps what it frees; programs that are started from here
 * on ask for large pages. */
void   pg_memory_keep (void);
void   pg_memory_large_pages (void);

#define PG_ALLOC(p, n) do { (p) = pg_calloc ((n), sizeof *(p)); \
    if (!(p)) PG_FAIL (PG_E_MEMORY, "no memory for %zu x %zu bytes", (size_t) (n), sizeof *(p)); } while (0)
/* Grows *p (capacity *cap entries) so that `need` entries fit; doubles. */
#define PG_GROW(p, cap, need) do { if ((size_t) (need) > (cap)) { \
    size_t cap_ = 2 * (size_t) (need) + 16; void *q_ = pg_resize ((p), cap_, sizeof *(p)); \
    if (!q_) PG_FAIL (PG_E_MEMORY, "no memory for %zu x %zu bytes", cap_, sizeof *(p)); \
    (p) = q_; (cap) = cap_; } } while (0)

/* ---- keeping
 * ------------------------------------------------------------------------------------------------------- One
 * walk over what a run must remember: writes it, or reads it back into the same places (reading = 1). */
typedef struct {
    void *context;
    int   reading;
    pg_status (*numbers) (void *context, const char *name, size_t n, double *value);
    pg_status (*counts)  (void *context, const char *name, size_t n, long *value);
    pg_status (*bytes)   (void *context, const char *name, size_t n, void *value);
} pg_keeper;

/* ---- clock and threads --------------------------------------------------------------------------------- */
double pg_seconds (void);                              /* monotonic wall clock, s */
/* Calls work (context, first, last, thread) on disjoint ranges covering [0, n). Which thread gets which range
 * never changes a result as long as each item writes only its own output. */
typedef void (*pg_work) (void *context, size_t first, size_t last, int thread);
void pg_parallel (int threads, size_t n, pg_work work, void *context);               /* many light items */
/* few items, each worth a thread */
void pg_parallel_heavy (int threads, size_t n, pg_work work, void *context);

/* ---- small dense algebra (row-major, n <= 16) ---------------------------------------------------------- */
/* A = L L' in place (lower triangle); returns 0, or 1 + the row whose pivot fell to <= tiny * its
 * diagonal. */
int  pg_dense_cholesky (int n, double *A, double tiny);
void pg_dense_solve    (int n, const double *L, double *b);          /* b <- (L L')^-1 b */
/* Eigenvalues (descending) and, if V is not NULL, eigenvectors as columns of V (n x n), of symmetric A
 * (kept). Jacobi. */
void pg_dense_eigen    (int n, const double *A, double *lambda, double *V);
double pg_dense_det    (int n, const double *A);                     /* n = 1, 2, 3 */

/* ---- disjoint sets ------------------------------------------------------------------------------------- */
/* parent[i] leads from a member towards the root of its set; two members of one set have the same root. */
void pg_disjoint_start (int *parent, size_t n);        /* every member is a set of its own */
int  pg_disjoint_root  (int *parent, int i);
int  pg_disjoint_join  (int *parent, int a, int b);    /* one set of two; the root of b is that of both */
PG_API_END
#endif

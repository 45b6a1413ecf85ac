/* SPDX-License-Identifier: GPL-3.0-or-later
 * Writes fields as VTK XML files, for ParaView and other readers. A moment is an output time:
 *
 *   result.0007.vtu          moment 7: points as vertices; values in binary form behind the XML
 *   result.0007.3.vtu        points of rank 3, if ranks divide the points; result.0007.pvtu names all parts
 *   result.0007.cracks.vtu   faces of cracks that have grown at that moment, once the run has ended
 *   result.pvd               the list of all moments with their times, which is what a reader opens
 *
 * A moment is written under another name, moved to its place when it is whole, and then added to the list by
 * one write over the list's end, so that the list is whole at any instant and names nothing that is not
 * there. Moments may be divided into parts differently (after a restart): each .pvtu names its own parts. */
#include "disk.h"
#include "entries.h"
#include "exodus.h"
#include "perigal/ranks.h"
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#if __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
#define ORDER "LittleEndian"
#else
#define ORDER "BigEndian"
#endif
#define VTK_FILE "<?xml version=\"1.0\"?>\n<VTKFile type=\"%s\" version=\"1.0\" byte_order=\"" ORDER \
                 "\" header_type=\"UInt64\">\n"
static const char data_end[] = "\n</AppendedData>\n</VTKFile>\n";
static const char list_end[] = "</Collection>\n</VTKFile>\n";

/* Describes the array of point coordinates in the XML. */
static const pg_field_view places = { "Points", "m", 3, NULL };
/* Longest path; VTK's numbers of cell types, by the number of nodes: 1 vertex, 2 line, 3 triangle. */
enum { PATH = 4096 };
static const unsigned char cell_kind[] = { 0, 1, 3, 5 };

/* n points at x (n x dim, m) with nview fields; each run of `each` consecutive points is a cell. */
typedef struct {
    int    dim, each;
    size_t n, nview;
    const double *x;
    const pg_field_view *view;
} grid;

/* An open result. */
typedef struct {
    const pg_field_request *request;
    /* The list result.pvd: file descriptor (-1: another rank writes it); bytes before its closing tags. */
    int    file;
    long   bytes;
    /* Numbers of moments that are written, and of those that are synced to the disk. */
    long   moments, synced;
    /* Views of the fields, of the volume and of the block number (nfield + 2); block numbers (n). */
    pg_field_view *view;
    double *block;
    char   list[PATH];
} result;

/* ---- a grid -------------------------------------------------------------------------------------------- */
/* Components of a field in the file: a vector gets three, by which readers recognise it. */
static int shown (const pg_field_view *v, int dim)
{
    return v->components > 1 && v->components == dim ? 3 : v->components;
}

/* Bytes of an array of n values in the binary data: 8 for its length, then `bytes` per value. */
static uint64_t size_of (uint64_t n, uint64_t bytes) { return 8 + n * bytes; }

static uint64_t size_of_view (const grid *g, const pg_field_view *v)
{
    return size_of (g->n, sizeof (double) * (uint64_t) shown (v, g->dim));
}

/* Writes the XML element of a field. offset: of its array in the binary data; NULL: none, in a .pvtu file. */
static void describe (FILE *f, const char *element, const pg_field_view *v, int dim, const uint64_t *offset)
{
    char suffix[16];
    int m = shown (v, dim);
    fprintf (f, "<%s type=\"Float64\" Name=\"%s\" unit=\"%s\" NumberOfComponents=\"%d\"", element, v->name,
             v->unit, m);
    for (int k = 0; m > 1 && v->components != dim && k < m; k++) {
        pg_exodus_suffix (dim, m, k, suffix, sizeof suffix);
        fprintf (f, " ComponentName%d=\"%s\"", k, suffix + 1);
    }
    if (offset) fprintf (f, " format=\"appended\" offset=\"%llu\"", (unsigned long long) *offset);
    fputs ("/>\n", f);
}

/* Writes the XML element of an array of the cells at offset *at, and advances *at by its bytes. */
static void describe_cells (FILE *f, const char *type, const char *name, uint64_t *at, uint64_t bytes)
{
    fprintf (f, "<DataArray type=\"%s\" Name=\"%s\" format=\"appended\" offset=\"%llu\"/>\n", type, name,
             (unsigned long long) *at);
    *at += bytes;
}

/* Writes the XML: what each array is and where it begins in the binary data. */
static void put_head (FILE *f, const grid *g, double time)
{
    uint64_t at = 0;
    size_t cells = g->n / (size_t) g->each;
    fprintf (f, VTK_FILE "<UnstructuredGrid>\n<FieldData>\n<DataArray type=\"Float64\" Name=\"TimeValue\" "
             "NumberOfTuples=\"1\" format=\"ascii\">%.17g</DataArray>\n</FieldData>\n"
             "<Piece NumberOfPoints=\"%zu\" NumberOfCells=\"%zu\">\n<PointData>\n", "UnstructuredGrid", time,
             g->n, cells);
    for (size_t k = 0; k < g->nview; at += size_of_view (g, &g->view[k]), k++)
        describe (f, "DataArray", &g->view[k], g->dim, &at);
    fputs ("</PointData>\n<Points>\n", f);
    describe (f, "DataArray", &places, 3, &at);
    at += size_of (g->n, 3 * sizeof (double));
    fputs ("</Points>\n<Cells>\n", f);
    describe_cells (f, "Int64", "connectivity", &at, size_of (g->n, 8));
    describe_cells (f, "Int64", "offsets", &at, size_of (cells, 8));
    describe_cells (f, "UInt8", "types", &at, size_of (cells, 1));
    fputs ("</Cells>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_", f);
}

/* Writes an array: its bytes, then n rows of `from` numbers, each filled up with zeros to `to` numbers. */
static void put_rows (FILE *f, size_t n, int from, int to, const double *value)
{
    double row[EXODUS_COMPONENTS] = { 0 };
    uint64_t bytes = size_of (n, sizeof *row * (uint64_t) to) - 8;
    fwrite (&bytes, sizeof bytes, 1, f);
    for (size_t i = 0; i < n; i++) {
        memcpy (row, value + i * (size_t) from, (size_t) from * sizeof *row);
        fwrite (row, sizeof *row, (size_t) to, f);
    }
}

/* Writes an array: its bytes, then the n integers first, first + step, ... */
static void put_sequence (FILE *f, size_t n, int64_t first, int64_t step)
{
    uint64_t bytes = 8 * n;
    fwrite (&bytes, sizeof bytes, 1, f);
    for (size_t i = 0; i < n; i++, first += step) fwrite (&first, sizeof first, 1, f);
}

static void put_data (FILE *f, const grid *g)
{
    size_t cells = g->n / (size_t) g->each;
    uint64_t bytes = cells;
    for (size_t k = 0; k < g->nview; k++)
        put_rows (f, g->n, g->view[k].components, shown (&g->view[k], g->dim), g->view[k].value);
    put_rows (f, g->n, g->dim, 3, g->x);
    put_sequence (f, g->n, 0, 1);
    put_sequence (f, cells, g->each, g->each);
    fwrite (&bytes, sizeof bytes, 1, f);
    for (size_t i = 0; i < cells; i++) fputc (cell_kind[g->each], f);
}

/* Creates PATH.new (returned in `fresh`), which `settle` renames to PATH if all of it was written. */
static pg_status create (FILE **f, char fresh[PATH + 8], const char *path)
{
    snprintf (fresh, PATH + 8, "%s.new", path);
    pg_status status = pg_file_create (f, fresh);
    errno = 0;
    return status;
}

static pg_status settle (FILE *f, const char *fresh, const char *path)
{
    int bad = ferror (f);
    bad |= fclose (f) != 0;
    if (!bad && rename (fresh, path) == 0) return PG_OK;
    int why = errno;
    remove (fresh);
    return pg_error (PG_E_FILE, PG_HERE, "%s: %s", path, strerror (why));
}

static pg_status write_grid (const char *path, const grid *g, double time)
{
    FILE *f;
    char fresh[PATH + 8];
    pg_status status = create (&f, fresh, path);
    if (status != PG_OK) return status;
    put_head (f, g, time);
    put_data (f, g);
    fputs (data_end, f);
    return settle (f, fresh, path);
}

/* ---- names --------------------------------------------------------------------------------------------- */
/* Name of the file of a moment: that of a part, or, with part < 0, the one that result.pvd names. */
static void name_of (char *out, size_t size, long moment, const pg_field_share *share, int part)
{
    if (share && part >= 0) snprintf (out, size, "result.%04ld.%d.vtu", moment, part);
    else snprintf (out, size, "result.%04ld.%s", moment, share ? "pvtu" : "vtu");
}

static void path_of (const result *r, char out[PATH], long moment, int part)
{
    char name[64];
    name_of (name, sizeof name, moment, r->request->share, part);
    snprintf (out, PATH, "%.4000s/%s", r->request->folder, name);
}

/* Number of the part of this process; 0 if it has all points. */
static int own (const result *r) { return r->request->share ? r->request->share->part : 0; }

/* 1 if this text may follow "result.NUMBER." in the name of a file of a moment. */
static int is_end (const char *end)
{
    size_t digits = strspn (end, "0123456789");
    if (strncmp (end, "cracks.", 7) == 0) end += 7;
    else if (digits && end[digits] == '.') end += digits + 1;
    end += *end == 'p';
    return strcmp (end, "vtu") == 0 || strcmp (end, "vtu.new") == 0;
}

/* Removes the files of moments from `first` on, and all files of crack faces and result.pvd.new. */
static void drop (const char *folder, long first)
{
    struct dirent *entry;
    char path[PATH];
    DIR *dir = opendir (folder);
    while (dir && (entry = readdir (dir))) {
        const char *name = entry->d_name;
        long moment;
        int used = 0;
        int is = sscanf (name, "result.%ld.%n", &moment, &used) == 1 && used && is_end (name + used);
        int at_end = strcmp (name, "result.pvd.new") == 0 || (is && strncmp (name + used, "cracks.", 7) == 0);
        if (!at_end && !(is && moment >= first)) continue;
        snprintf (path, sizeof path, "%.3800s/%.255s", folder, name);
        remove (path);
    }
    if (dir) closedir (dir);
}

/* ---- the list ------------------------------------------------------------------------------------------ */
/* Writes text over the closing tags of the list, and these behind it; if that fails the list is as it was. */
static pg_status extend (result *r, const char *text)
{
    char both[512];
    size_t n = strlen (text), whole = (size_t) snprintf (both, sizeof both, "%s%s", text, list_end);
    pg_status status = pg_disk_write (r->list, r->file, both, whole, r->bytes);
    if (status == PG_OK) r->bytes += (long) n;
    else if (pwrite (r->file, list_end, strlen (list_end), r->bytes) > 0) {
        int cut = ftruncate (r->file, r->bytes + (long) strlen (list_end));
        (void) cut;                                    /* if it failed: the rest is behind the tags */
    }
    return status;
}

static pg_status begin_list (result *r)
{
    char head[256];
    snprintf (head, sizeof head, VTK_FILE "<Collection>\n", "Collection");
    pg_status status = pg_disk_create (r->list, &r->file);
    return status == PG_OK ? extend (r, head) : status;
}

/* Opens the list to go on with it and cuts it to its length at the marks `at`. PG_E_FILE: the list is shorter
 * than that, or the file of a moment is missing. */
static pg_status open_list (result *r, const pg_field_marks *at)
{
    pg_status status = PG_OK;
    struct stat s;
    char path[PATH];
    r->file = open (r->list, O_RDWR | O_NOFOLLOW | O_CLOEXEC);
    if (r->file < 0 || fstat (r->file, &s) != 0) PG_FAIL (PG_E_FILE, "%s: %s", r->list, strerror (errno));
    if (s.st_size < at->keep)
        PG_FAIL (PG_E_FILE, "%s has %ld bytes, %ld are missing: it was changed since", r->list,
                 (long) s.st_size, at->keep - (long) s.st_size);
    for (long k = 0; k < at->moments; k++) {           /* written whole or in parts */
        snprintf (path, sizeof path, "%.3800s/result.%04ld.vtu", r->request->folder, k);
        if (access (path, F_OK) == 0) continue;
        snprintf (path, sizeof path, "%.3800s/result.%04ld.pvtu", r->request->folder, k);
        if (access (path, F_OK) != 0) PG_FAIL (PG_E_FILE, "%s: %s", path, strerror (errno));
    }
    r->bytes = at->keep;
    PG_TRY (extend (r, ""));
    PG_TRY (pg_disk_cut (r->list, r->file, r->bytes + (long) strlen (list_end)));
done:
    return status;
}

/* ---- the entry of the catalogue ------------------------------------------------------------------------ */
static void close_result (void **self)
{
    result *r = *self;
    if (!r) return;
    if (r->file >= 0) close (r->file);
    pg_free (r->view), pg_free (r->block);
    pg_free (r);
    *self = NULL;
}

/* Adds two fields to those of the run: the volume (m3) of each point and the number of its block. */
static pg_status prepare_views (result *r)
{
    pg_status status = PG_OK;
    const pg_field_request *q = r->request;
    PG_ALLOC (r->view, q->nfield + 2);
    PG_ALLOC (r->block, q->cloud->n);
    for (size_t i = 0; q->cloud->block && i < q->cloud->n; i++) r->block[i] = q->cloud->block[i];
    r->view[q->nfield] = (pg_field_view) { "volume", "m3", 1, q->cloud->volume };
    r->view[q->nfield + 1] = (pg_field_view) { "block", "", 1, r->block };
done:
    return status;
}

/* Of several ranks only rank 0 opens the list and removes what was written later. */
static pg_status open_result (void **self, const pg_field_request *q, const pg_field_marks *at)
{
    pg_status status = PG_OK;
    result *r = NULL;
    void *lost;
    PG_ALLOC (r, 1);
    *r = (result) { .request = q, .file = -1, .moments = at ? at->moments : 0 };
    r->synced = r->moments;
    snprintf (r->list, sizeof r->list, "%s/result.pvd", q->folder);
    PG_TRY (prepare_views (r));
    if (own (r) == 0) {
        PG_TRY (at ? open_list (r, at) : begin_list (r));
        drop (q->folder, r->moments);
    }
    *self = r;
    r = NULL;
done:
    lost = r;
    close_result (&lost);
    return status;
}

/* Writes the .pvtu file of a moment, which names the files of its parts. */
static pg_status write_parts (const result *r, const char *path, long moment)
{
    FILE *f;
    const pg_field_request *q = r->request;
    char fresh[PATH + 8], name[64];
    pg_status status = create (&f, fresh, path);
    if (status != PG_OK) return status;
    fprintf (f, VTK_FILE "<PUnstructuredGrid GhostLevel=\"0\">\n<PPointData>\n", "PUnstructuredGrid");
    for (size_t k = 0; k < q->nfield + 2; k++) describe (f, "PDataArray", &r->view[k], q->cloud->dim, NULL);
    fputs ("</PPointData>\n<PPoints>\n", f);
    describe (f, "PDataArray", &places, 3, NULL);
    fputs ("</PPoints>\n", f);
    for (int part = 0; part < q->share->size; part++) {
        name_of (name, sizeof name, moment, q->share, part);
        fprintf (f, "<Piece Source=\"%s\"/>\n", name);
    }
    fputs ("</PUnstructuredGrid>\n</VTKFile>\n", f);
    return settle (f, fresh, path);
}

/* The list names a moment when all ranks have written their parts of it. */
static pg_status write_moment (void *self, long moment, double time, const pg_field_view *field)
{
    pg_status status = PG_OK;
    result *r = self;
    const pg_field_request *q = r->request;
    char mine[PATH], whole[PATH], name[64], line[200];
    path_of (r, mine, moment, own (r)), path_of (r, whole, moment, -1);
    memcpy (r->view, field, q->nfield * sizeof *field);
    const grid g = { q->cloud->dim, 1, q->cloud->n, q->nfield + 2, q->cloud->x, r->view };
    status = write_grid (mine, &g, time);
    PG_TRY (q->share ? pg_ranks_agree (status) : status);
    if (r->file >= 0) {
        name_of (name, sizeof name, moment, q->share, -1);
        snprintf (line, sizeof line, "<DataSet timestep=\"%.17g\" part=\"0\" file=\"%s\"/>\n", time, name);
        if (q->share) PG_TRY (write_parts (r, whole, moment));
        PG_TRY (extend (r, line));
    }
    r->moments = moment + 1;
    if (r->synced > moment) r->synced = moment;        /* rewritten: another rank had failed */
done:
    if (status != PG_OK) remove (mine), remove (whole);
    return status;
}

static long keep_list (const void *self) { return ((const result *) self)->bytes; }

static pg_status sync_result (void *self)
{
    pg_status status = PG_OK;
    result *r = self;
    char path[PATH];
    for (; r->synced < r->moments; r->synced++) {
        path_of (r, path, r->synced, own (r));
        PG_TRY (pg_file_sync (path));
        path_of (r, path, r->synced, -1);
        if (r->file >= 0) PG_TRY (pg_file_sync (path));
    }
    if (r->file >= 0) PG_TRY (pg_file_sync (r->list));
done:
    return status;
}

/* ---- faces of cracks ----------------------------------------------------------------------------------- */
/* n crack faces as a grid g. x: their corners (m); view, value: fields at the corners, and `exists`, at one
 * moment after the other. */
typedef struct {
    size_t n;
    const pg_crack_face *face;
    grid   g;
    double *x, **value;
    pg_field_view *view;
} faces;

static pg_status make_faces (faces *a, const result *r)
{
    pg_status status = PG_OK;
    const pg_field_request *q = r->request;
    size_t dim = (size_t) q->cloud->dim, n = dim * a->n;
    PG_ALLOC (a->x, n * dim);
    PG_ALLOC (a->view, q->nfield + 1);
    PG_ALLOC (a->value, q->nfield + 1);
    for (size_t i = 0; i < n; i++) memcpy (a->x + dim * i, a->face[i / dim].x[i % dim], dim * sizeof *a->x);
    for (size_t k = 0; k <= q->nfield; k++) {
        a->view[k] = k < q->nfield ? q->field[k] : (pg_field_view) { .name = "exists", .components = 1 };
        PG_ALLOC (a->value[k], n * (size_t) a->view[k].components);
        a->view[k].value = a->value[k];
    }
    a->g = (grid) { q->cloud->dim, q->cloud->dim, n, q->nfield + 1, a->x, a->view };
done:
    return status;
}

/* Reads the values at the corners of the faces from the file of a moment, which ends with the arrays. */
static pg_status take_values (faces *a, const result *r, long moment, double time)
{
    pg_status status = PG_OK;
    const pg_field_request *q = r->request;
    const grid g = { q->cloud->dim, 1, q->cloud->n, q->nfield + 2, q->cloud->x, r->view };
    uint64_t bytes = size_of (g.n, 3 * sizeof (double)) + 2 * size_of (g.n, 8) + size_of (g.n, 1);
    size_t size, end = strlen (data_end), dim = (size_t) g.dim;
    char path[PATH], *text = NULL;
    for (size_t k = 0; k < g.nview; k++) bytes += size_of_view (&g, &g.view[k]);
    path_of (r, path, moment, 0);
    PG_TRY (pg_file_text (&text, &size, path));
    if (size < bytes + end) PG_FAIL (PG_E_FILE, "%s has %zu bytes: it was changed since", path, size);
    const char *at = text + (size - end - bytes);
    for (size_t k = 0; k < q->nfield; at += size_of_view (&g, &g.view[k]), k++) {
        size_t m = (size_t) g.view[k].components, wide = (size_t) shown (&g.view[k], g.dim);
        for (size_t i = 0; i < a->g.n; i++)
            memcpy (a->value[k] + i * m, at + 8 + a->face[i / dim].point[i % dim] * wide * sizeof (double),
                    m * sizeof (double));
    }
    for (size_t i = 0; i < a->g.n; i++) a->value[q->nfield][i] = time >= a->face[i / dim].since;
done:
    pg_free (text);
    return status;
}

/* Writes a .cracks.vtu file for every moment, and result.pvd.new, a list that names these files too. */
static pg_status write_faces (faces *a, const result *r)
{
    pg_status status = PG_OK;
    FILE *f = NULL;
    char fresh[PATH + 8], path[PATH], *list = NULL;
    long moment = 0;
    PG_TRY (pg_file_text (&list, NULL, r->list));
    PG_TRY (create (&f, fresh, r->list));
    for (char *line = list, *next; (next = strchr (line, '\n')); line = next + 1) {
        double time;
        fwrite (line, 1, (size_t) (next + 1 - line), f);
        if (sscanf (line, "<DataSet timestep=\"%lf", &time) != 1) continue;
        snprintf (path, sizeof path, "%.4000s/result.%04ld.cracks.vtu", r->request->folder, moment);
        PG_TRY (take_values (a, r, moment, time));
        PG_TRY (write_grid (path, &a->g, time));
        PG_TRY (pg_file_sync (path));
        fprintf (f, "<DataSet timestep=\"%.17g\" part=\"1\" file=\"%s\"/>\n", time, strrchr (path, '/') + 1);
        moment++;
    }
    status = settle (f, fresh, fresh);                 /* finish_result will rename it */
    f = NULL;
    PG_TRY (status);
    PG_TRY (pg_file_sync (fresh));
done:
    if (f) fclose (f);
    pg_free (list);
    return status;
}

static pg_status prepare_result (void *self, size_t n, const pg_crack_face *face)
{
    pg_status status = PG_OK;
    const result *r = self;
    faces a = { .n = n, .face = face };
    if (n == 0) return PG_OK;
    PG_TRY (make_faces (&a, r));
    PG_TRY (write_faces (&a, r));
done:
    for (size_t k = 0; a.value && k <= r->request->nfield; k++) pg_free (a.value[k]);
    pg_free (a.value), pg_free (a.view), pg_free (a.x);
    return status;
}

static pg_status finish_result (const char *folder, const pg_field_share *share, int done)
{
    char fresh[PATH], list[PATH];
    snprintf (list, sizeof list, "%.4000s/result.pvd", folder);
    snprintf (fresh, sizeof fresh, "%.4000s/result.pvd.new", folder);
    if (share) return PG_OK;
    if (!done) drop (folder, LONG_MAX);
    else if (rename (fresh, list) != 0 && errno != ENOENT)
        return pg_error (PG_E_FILE, PG_HERE, "%s: %s", fresh, strerror (errno));
    return PG_OK;
}

static void clear_results (const char *folder, int keep)
{
    char path[PATH];
    if (keep >= 0) return;
    drop (folder, 0);
    snprintf (path, sizeof path, "%.4000s/result.pvd", folder);
    remove (path);
}

const pg_writer pg_writer_vtk = {
    .name = "vtk",
    .summary = "result.pvd and a file for each moment, XML of VTK: for ParaView",
    .file = "result.pvd",
    .parts = PG_PARTS_STAY,
    .open = open_result,
    .step = write_moment,
    .keep = keep_list,
    .close = close_result,
    .sync = sync_result,
    .prepare = prepare_result,
    .finish = finish_result,
    .clear = clear_results,
};

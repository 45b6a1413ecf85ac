/* SPDX-License-Identifier: GPL-3.0-or-later
 * output.h: writes and reads files that hold plain arrays: fields at points in Exodus format, tables as CSV,
 * JSON, and checkpoints. This folder knows columns, fields and points; which of them a run writes, and when,
 * is decided by results.h.
 *
 * All writers: a file never contains an incomplete record. Whatever cannot be written completely is removed,
 * and the function returns PG_E_FILE with the path and the reason of the system (a full disk, missing
 * permission). PG_E_USAGE: the request itself is wrong; PG_E_MEMORY: no memory. */
#ifndef PERIGAL_OUTPUT_H
#define PERIGAL_OUTPUT_H
#include "perigal/cloud.h"
#include "perigal/mesh.h"
#include <stdio.h>

PG_API_BEGIN

/* ---- fields on points ---------------------------------------------------------------------------------- */
/* A field at the n points of a cloud, in arrays of the caller. */
typedef struct {
    /* Name without its component, such as "displacement", "damage", "stress". */
    char   name[32];
    /* SI unit, such as "m" or "Pa"; "" for a pure number. */
    char   unit[16];
    /* Values per point: 1 for a scalar, dim for a vector, 3 (2D) or 6 (3D) for a symmetric
     * tensor in Voigt order. */
    int    components;
    /* n x components, the components of a point side by side. */
    const double *value;
} pg_field_view;

/* A face of a piece of crack with its own nodes at its corners (2D: a line of 2, 3D: a triangle of 3): their
 * positions (m), the points whose values they take, and the first output time at which the face exists. */
typedef struct { double x[3][3]; size_t point[3]; double since; } pg_crack_face;

/* ---- writers: a catalogue of formats for the fields of a run ------------------------------------------- */
/* Output is written at moments: a moment has a number (from 0), a time, and the values of every field at that
 * time. */
/* Division of the points among processes: index of this process's part, number of parts, 1 if parts are
 * joined at the end of the run. Used while a writer is opened: global number of each point of this process,
 * from 0, possibly with gaps (n); total number of points, and number in each block 0 .. nblock - 1. */
typedef struct {
    int     part, size, joined;
    const int64_t *number;
    int64_t total;
    size_t  nblock;
    const int64_t *in_block;
} pg_field_share;
/* Request to a writer, which must remain valid until the writer is closed. folder: the result folder, common
 * to all parts. cloud: the points of this process. field: names, units and components (nfield). share NULL:
 * this process has all points. */
typedef struct {
    const char *folder, *title;
    const pg_cloud *cloud;
    size_t nfield;
    const pg_field_view *field;
    const pg_field_share *share;
} pg_field_request;
/* Position of a writer stored in a checkpoint: number of moments written, and the value of its `keep`. */
typedef struct { long moments, keep; } pg_field_marks;
/* Support of parallel runs by a writer: none; each process writes its own part; or the parts can be joined
 * into what one process would have written (output.join). */
enum { PG_PARTS_NONE, PG_PARTS_STAY, PG_PARTS_JOIN };
/* An entry of the catalogue: src/io/output/NAME.c and one line in list.h. Functions marked (NULL) may be
 * missing. Whatever ends the run, moments written so far can be read. Failures of files are PG_E_FILE with
 * the path and the reason of the system. */
typedef struct {
    /* The value of `output.format`, what it is, the file that readers open, and PG_PARTS_... */
    const char *name, *summary, *file;
    int parts;
    /* Begins: anew (at NULL), in the place of what an earlier run has left of this format; or goes on behind
     * the moments of `at`, and removes what was written later. PG_E_FILE: some of these moments are not there
     * any more; the folder stays as it is then. */
    pg_status (*open) (void **self, const pg_field_request *request, const pg_field_marks *at);
    /* Writes a moment: the fields of the request with values. Times ascend: s, in static runs load factors or
     * numbers of steps. All processes that divide the points call. If it fails the moment is not there, and
     * its number comes again. */
    pg_status (*step) (void *self, long moment, double time, const pg_field_view *field);
    /* What `open` needs, beside the number of moments, to go on behind those that are written: such as the
     * length of a file in bytes. */
    long      (*keep) (const void *self);
    void      (*close) (void **self);
    /* Waits until the system has put all moments on the disk (NULL: FOLDER/file is all there is). */
    pg_status (*sync) (void *self);
    /* Called after the last moment: writes what the finished result has in addition (the n faces of cracks,
     * or the joined parts) to separate files; `open` can still continue the run as if it had not been called
     * (NULL). */
    pg_status (*prepare) (void *self, size_t n, const pg_crack_face *face);
    /* done 1: the run is complete, and the files of `prepare` replace the result; 0: the run failed, and they
     * are removed. It is also called for a run that was killed after its end (share NULL then), and if
     * nothing was prepared (NULL). */
    pg_status (*finish) (const char *folder, const pg_field_share *share, int done);
    /* Removes the files of this format from a folder: all (keep -1), or those that do not belong to a run of
     * one process (keep 0) or of `keep` parts (NULL: FOLDER/file is the only one). */
    void      (*clear) (const char *folder, int keep);
    /* Reads back, so that a run can go on among other processes, which divide the points anew and write all
     * moments again: number and times of the moments in FOLDER; a field of one of them, at the points of part
     * `part` of `size` (size 0: of all). To be freed with pg_free. (Both NULL: moments stay as the processes
     * before have written them.) */
    pg_status (*times) (const char *folder, int size, size_t *n, double **time);
    pg_status (*read)  (const char *folder, int size, int part, long moment, const char *field, size_t *n,
                        int *components, double **value);
} pg_writer;
/* The writer of that name, NULL: unknown; all names, separated by |. */
const pg_writer *pg_writer_find  (const char *name);
const char      *pg_writer_names (void);
/* Removes the files of other formats from a folder, and those of `own` by its `clear` with `keep`. */
void             pg_writer_clear (const pg_writer *own, const char *folder, int keep);
/* PG_E_USAGE: the fields in the folder have a format that cannot be read back. */
pg_status        pg_writer_readable (const char *folder);
/* Finishes a result folder whose run was killed after its end, for any writer. PG_E_FILE. */
pg_status        pg_writer_complete (const char *folder);

/* ---- result.e: Exodus layout in classic netCDF, one SPHERE element and one node per point -------------- */
typedef struct pg_exodus pg_exodus;
/* Creates a file for fields of these names, units and components at the points of a cloud; the
 * values are ignored. The point volumes are written as one more field unless the caller has
 * one of that name. share: the file is a part of a whole (Nemesis, the parallel use of Exodus): programs that
 * read all parts, result.e.SIZE.RANK, show them as one; NULL: it is the whole. */
pg_status pg_exodus_create (pg_exodus **out, const char *path, const pg_cloud *cloud, const char *title,
                            size_t nfield, const pg_field_view *fields /* values ignored */,
                            const pg_field_share *share);
/* Makes FOLDER/result.e of its parts, the file that one process would have written, of the steps that all
 * parts have; the parts stay. Where there are no parts, or unless `again` a result.e that is newer than they
 * are, nothing is done. PG_E_FILE: a part is missing or is none of them, or none holds a step. */
pg_status pg_exodus_join (const char *folder, int again);
/* Opens a file in order to append to it: keeps the first `steps` steps, which end at byte
 * `bytes` as pg_exodus_size reported it, and cuts off what was written later. PG_E_FILE if
 * points or components differ or bytes are missing. */
pg_status pg_exodus_open (pg_exodus **out, const char *path, const pg_cloud *cloud, size_t nfield,
                          const pg_field_view *fields, long steps, long bytes);
/* Adds n faces to a file that is complete, as a block of elements named "cracks" (BAR2, TRI3). Each takes the
 * displacements of its own side, so that a crack is shown open. The element variable `exists` is 1 from the
 * `since` of a face on, else 0. Cloud, title and fields are those of its creation. The result is a copy under
 * the name PATH.new, which is on the disk when the call returns; the file itself stays, and can be appended
 * to. n 0: there is no copy. */
pg_status pg_exodus_prepare_pieces (const pg_exodus *file, const pg_cloud *cloud, const char *title, size_t n,
                                    const pg_crack_face *piece);
/* The copy, where there is one, takes the place of the file PATH, to which nothing more can be appended;
 * drop: the copy is removed. */
pg_status pg_exodus_commit_pieces (const char *path);
void      pg_exodus_drop_pieces   (const char *path);
/* Appends a step: the fields in the order of the creation, with values. `time` is in s (a load
 * factor in static runs). If it fails, the file is as it was before. */
pg_status pg_exodus_write  (pg_exodus *file, double time, const pg_field_view *fields);
/* Number of steps in the file and its length in bytes, for a checkpoint to remember. */
void      pg_exodus_size   (const pg_exodus *file, long *steps, long *bytes);
/* Waits until the system has put the file on the disk. */
pg_status pg_exodus_sync   (const pg_exodus *file);
void      pg_exodus_close  (pg_exodus **file);
/* Reads one field of one step; step -1 is the last one. *value (n x *components) is to be
 * freed with pg_free. PG_E_USAGE: no such field (with the nearest name) or step. */
pg_status pg_exodus_read (const char *path, const char *field, int step, size_t *n, int *components,
                          double **value);
/* Reads the points: fills x, n, dim, volume, block, box, h, step and thickness of the cloud,
 * whose arrays the caller frees. *nstep and *time (one value per step, to be freed with
 * pg_free) may be NULL. Files of other programs may lack volumes and spacing; these then stay
 * zero. */
pg_status pg_exodus_points (const char *path, pg_cloud *cloud /* x, n, dim, volume, box, h filled */,
                            size_t *nstep, double **time);
/* Names of the fields without component suffixes; *names is to be freed with pg_free. */
pg_status pg_exodus_fields (const char *path, char (**names)[32], size_t *n);
/* Unit of a field, "" if the file gives none. */
pg_status pg_exodus_unit   (const char *path, const char *field, char unit[16]);

/* Makes a folder and the folders above it; one that exists is no error. PG_E_FILE. */
pg_status pg_folder_make (const char *path);
/* Removes the plain files of a folder, and the folder if nothing else is in it. What cannot be removed
 * stays. */
void      pg_folder_remove (const char *path);

/* Creates a file for writing, to be closed with fclose. A file or a symbolic link in its place
 * is removed first, so that nothing is ever written through a link. PG_E_FILE. */
pg_status pg_file_create (FILE **out, const char *path);
/* Waits until the system has put a file or a folder on the disk. PG_E_FILE. */
pg_status pg_file_sync (const char *path);
/* Reads a whole file, also a pipe, into *text, which ends in a zero byte and is to be freed with pg_free;
 * *size (unless NULL): its bytes without that one. NULL on failure. PG_E_FILE. */
pg_status pg_file_text (char **text, size_t *size, const char *path);

/* ---- tables -------------------------------------------------------------------------------------------- */
/* CSV (RFC 4180): a header with "name [unit]" per column, then rows of numbers with 17 digits,
 * which give the same double back. Rows reach the file in the call that writes them. */
typedef struct pg_table pg_table;
/* Creates a table with n columns of these names. */
pg_status pg_table_create (pg_table **out, const char *path, size_t n, const char *const *columns);
/* Opens a table of these n columns in order to append to it: keeps the header and `rows` rows, and cuts off
 * the later ones. PG_E_FILE if the file has other columns or fewer rows; it stays as it was then. */
pg_status pg_table_open   (pg_table **out, const char *path, size_t n, const char *const *columns, long rows);
/* Rows in the file, the header not counted. */
long      pg_table_rows   (const pg_table *table);
/* Waits until the system has put the file on the disk. */
pg_status pg_table_sync   (const pg_table *table);
/* Appends a row of n numbers; NaN leaves its cell empty: the quantity was not measured. */
pg_status pg_table_row    (pg_table *table, const double *values);
/* Appends a row of n texts, quoted where necessary; NULL leaves its cell empty. */
pg_status pg_table_line   (pg_table *table, const char *const *values);
/* Appends a row of n texts to a buffer. pg_table_write writes the buffer to the file, as does the next row or
 * line; pg_table_close discards it, and so does a failure. */
pg_status pg_table_line_later (pg_table *table, const char *const *values);
pg_status pg_table_write  (pg_table *table);
void      pg_table_close  (pg_table **table);
/* A CSV table that was read back whole. To be freed with pg_csv_clear. */
typedef struct {
    size_t  ncolumn, nrow;
    /* Names as in the header, with their units, such as "force [N]" (ncolumn). */
    char  **name;
    /* The numbers (nrow x ncolumn); NAN for an empty cell or one that is no number. */
    double *value;
    /* The text of the file, which holds the names. */
    char   *text;
} pg_csv;
/* Reads a table. PG_E_FILE: it cannot be read, or is empty. Rows that are too short are filled
 * with NAN, and cells beyond the header are dropped. */
pg_status pg_csv_read   (pg_csv *csv, const char *path);
void      pg_csv_clear  (pg_csv *csv);
/* Column of a name, given as in the header or without its unit; -1: there is none. */
long      pg_csv_column (const pg_csv *csv, const char *wanted);
/* Length of the name at the beginning of a header cell, without " [unit]". */
size_t    pg_csv_name   (const char *column);

/* ---- matrices ------------------------------------------------------------------------------------------ */
/* A sparse matrix as a Matrix Market file (coordinate real, symmetric where A is), a vector as one of the
 * array kind; numbers with 17 digits, which give the same double back. comment: lines for its head, NULL:
 * none. PG_E_FILE. */
pg_status pg_matrix_market_write  (const pg_sparse *A, const char *path, const char *comment);
pg_status pg_matrix_market_vector (size_t n, const double *value, const char *path, const char *comment);

/* ---- checkpoint.nc: what a run must remember, in classic netCDF ---------------------------------------- */
/* A function that visits everything that a checkpoint holds, in a fixed order: it calls the
 * keeper (base.h) with a name, a length and an array for each piece. The same function serves
 * to write and to read, so that the two cannot differ. */
typedef pg_status (*pg_keep) (void *context, const pg_keeper *keeper);
/* Writes a checkpoint. `walk` is called twice, with the same names and lengths: to define the
 * variables and to write them. The file is written as PATH.new, synced and renamed, so that
 * PATH is at any instant the old file or the whole new one. */
pg_status pg_checkpoint_write (const char *path, pg_keep walk, void *context);
/* pg_checkpoint_write in two halves, so that ranks replace their checkpoints only when all have a new one:
 * `prepare` leaves PATH.new, whole and on the disk; `commit` renames it to PATH (PG_E_FILE). */
pg_status pg_checkpoint_prepare (const char *path, pg_keep walk, void *context);
pg_status pg_checkpoint_commit  (const char *path);
/* Removes PATH.new, if it is there. */
void      pg_checkpoint_drop    (const char *path);
/* A checkpoint opened for reading values by name in any order: its keeper; number of values under a name, 0:
 * none. The checksum is not verified here (pg_checkpoint_read does). */
typedef struct pg_checkpoint pg_checkpoint;
pg_status pg_checkpoint_open   (pg_checkpoint **out, const char *path);
const pg_keeper *pg_checkpoint_keeper (const pg_checkpoint *checkpoint);
size_t    pg_checkpoint_length (const pg_checkpoint *checkpoint, const char *name);
void      pg_checkpoint_close  (pg_checkpoint **file);
/* Reads a checkpoint by the same function. PG_E_FILE: damaged (the checksum differs), or a
 * name that the file lacks or holds with another length or type. */
pg_status pg_checkpoint_read  (const char *path, pg_keep walk, void *context);

/* ---- JSON ---------------------------------------------------------------------------------------------- */
/* A JSON text, written to PATH.tmp and renamed when it is closed. Faults of writing and of use
 * (brackets that do not match, a key inside a list) are remembered and reported by
 * pg_json_close; all functions accept j == NULL and do nothing then. */
typedef struct pg_json pg_json;
pg_status pg_json_create (pg_json **out, const char *path);
/* Begins an object ('{') or a list ('['); key is NULL inside lists. */
void      pg_json_open   (pg_json *j, const char *key, char bracket);
/* Ends the innermost object or list. */
void      pg_json_shut   (pg_json *j);
/* Writes a number with as few digits as give the same double back; NaN and infinities become
 * null. */
void      pg_json_number (pg_json *j, const char *key, double value);
void      pg_json_count  (pg_json *j, const char *key, size_t value);
/* Writes a text (UTF-8; other bytes become the replacement character); NULL becomes null. */
void      pg_json_text   (pg_json *j, const char *key, const char *value);
/* Ends what is still open, writes the file to the disk and moves it to its place; frees *j and
 * sets it to NULL. */
pg_status pg_json_close  (pg_json **j);
PG_API_END
#endif

/* SPDX-License-Identifier: GPL-3.0-or-later
 * Movies as animated PNG: the chunks of single pictures, which cairo has written, put into one file. The
 * first picture stays an ordinary one; the data of the others stand in chunks of their own with numbers
 * (PNG third edition, sections 5.2 and 11.3.6). Nothing is compressed or decompressed here. */
#include "perigal/output.h"
#include "picture_private.h"
#include <errno.h>
#include <math.h>
#include <string.h>
#include <strings.h>

static const unsigned char signature[8] = { 0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n' };
/* Length of a chunk's head (length, name) and of its checksum. */
enum { HEAD = 8, CHECKSUM = 4, LARGEST_CHUNK = 0x7fffffff };

struct pg_movie {
    FILE    *file;
    char    *path;
    /* Pictures promised and here; the number of the next numbered chunk; size in pixels. */
    size_t   frames, count;
    uint32_t number, width, height;
    /* Duration of a picture, s: numerator and denominator. */
    uint16_t delay[2];
};

/* ---- chunks ----------------------------------------------------------------------------------------- */
static uint32_t read_32 (const unsigned char *b)
{
    return (uint32_t) b[0] << 24 | (uint32_t) b[1] << 16 | (uint32_t) b[2] << 8 | b[3];
}
static void write_32 (unsigned char *b, uint32_t v)
{
    for (int k = 0; k < 4; k++) b[k] = (unsigned char) (v >> (24 - 8 * k));
}
static void write_16 (unsigned char *b, uint16_t v)
{
    b[0] = (unsigned char) (v >> 8), b[1] = (unsigned char) v;
}

/* Checksum of the PNG specification, annex D: the CRC of ISO 3309, bit by bit in a table of four bits. */
static uint32_t checksum (uint32_t crc, const unsigned char *data, size_t n)
{
    static const uint32_t table[16] = {
        0x00000000, 0x1db71064, 0x3b6e20c8, 0x26d930ac, 0x76dc4190, 0x6b6b51f4, 0x4db26158, 0x5005713c,
        0xedb88320, 0xf00f9344, 0xd6d6a3e8, 0xcb61b38c, 0x9b64c2b0, 0x86d3d2d4, 0xa00ae278, 0xbdbdf21c };
    for (size_t k = 0; k < n; k++) {
        crc = table[(crc ^ data[k]) & 15] ^ crc >> 4;
        crc = table[(crc ^ data[k] >> 4) & 15] ^ crc >> 4;
    }
    return crc;
}

/* Writes a chunk of two parts, the first of which may be empty. */
static pg_status put_chunk (pg_movie *m, const char *name, size_t n1, const unsigned char *part1, size_t n2,
                            const unsigned char *part2)
{
    pg_status status = PG_OK;
    unsigned char head[HEAD], tail[CHECKSUM];
    if (n1 + n2 > LARGEST_CHUNK) PG_FAIL (PG_E_LIMIT, "%s: the pictures are too large", m->path);
    write_32 (head, (uint32_t) (n1 + n2)), memcpy (head + 4, name, 4);
    uint32_t crc = checksum (0xffffffffu, head + 4, 4);
    if (n1) crc = checksum (crc, part1, n1);
    if (n2) crc = checksum (crc, part2, n2);
    write_32 (tail, ~crc);
    errno = 0;
    if (fwrite (head, 1, HEAD, m->file) != HEAD || (n1 && fwrite (part1, 1, n1, m->file) != n1)
        || (n2 && fwrite (part2, 1, n2, m->file) != n2) || fwrite (tail, 1, CHECKSUM, m->file) != CHECKSUM)
        PG_FAIL (PG_E_FILE, "%s: %s", m->path, strerror (errno ? errno : EIO));
done:
    return status;
}

/* How long the next picture stays, and that it covers the whole sheet. */
static pg_status put_control (pg_movie *m)
{
    unsigned char data[26] = { 0 };
    write_32 (data, m->number++), write_32 (data + 4, m->width), write_32 (data + 8, m->height);
    write_16 (data + 20, m->delay[0]), write_16 (data + 22, m->delay[1]);
    return put_chunk (m, "fcTL", 0, NULL, sizeof data, data);
}

/* The head of the movie: that of its first picture, and the number of all, repeated for ever. */
static pg_status put_head (pg_movie *m, const unsigned char *data, size_t n)
{
    pg_status status = PG_OK;
    unsigned char all[8] = { 0 };
    m->width = read_32 (data), m->height = read_32 (data + 4);
    errno = 0;
    if (fwrite (signature, 1, sizeof signature, m->file) != sizeof signature)
        PG_FAIL (PG_E_FILE, "%s: %s", m->path, strerror (errno ? errno : EIO));
    PG_TRY (put_chunk (m, "IHDR", 0, NULL, n, data));
    write_32 (all, (uint32_t) m->frames);
    PG_TRY (put_chunk (m, "acTL", 0, NULL, sizeof all, all));
done:
    return status;
}

/* One chunk of a picture: its head begins the movie or must agree with it, its data follow; what else the
 * first picture says (resolution) is kept. *begun: data have come. */
static pg_status take_chunk (pg_movie *m, const char *picture, const unsigned char *chunk, size_t n,
                             int *begun)
{
    pg_status status = PG_OK;
    const unsigned char *data = chunk + HEAD;
    char name[5] = { 0 };
    memcpy (name, chunk + 4, 4);
    if (strcmp (name, "IHDR") == 0 && n >= 13) {
        if (m->count == 0) PG_TRY (put_head (m, data, n));
        else if (read_32 (data) != m->width || read_32 (data + 4) != m->height)
            PG_FAIL (PG_E_USAGE, "%s: %u x %u pixels, but the movie has %u x %u", picture, read_32 (data),
                     read_32 (data + 4), m->width, m->height);
    } else if (strcmp (name, "IDAT") == 0) {
        unsigned char number[4];
        if (!*begun) PG_TRY (put_control (m));
        *begun = 1;
        if (m->count == 0) PG_TRY (put_chunk (m, "IDAT", 0, NULL, n, data));
        else {
            write_32 (number, m->number++);
            PG_TRY (put_chunk (m, "fdAT", sizeof number, number, n, data));
        }
    } else if (strcmp (name, "IEND") != 0 && m->count == 0 && !*begun)
        PG_TRY (put_chunk (m, name, 0, NULL, n, data));
done:
    return status;
}

/* ---- the movie -------------------------------------------------------------------------------------- */
static int ends_with (const char *path, const char *ending)
{
    size_t n = strlen (path), m = strlen (ending);
    return n >= m && strcasecmp (path + n - m, ending) == 0;
}

/* Whole rates are exact, others to a thousandth of a second or better. */
pg_status pg_movie_create (pg_movie **out, const char *path, size_t frames, double rate)
{
    pg_status status = PG_OK;
    pg_movie *m = NULL;
    if (!ends_with (path, ".png") && !ends_with (path, ".apng"))
        PG_FAIL (PG_E_USAGE, "%s: a movie's file ends in .png or .apng", path);
    if (!(rate >= 0.02 && rate <= 1000))
        PG_FAIL (PG_E_USAGE, "%g pictures in a second: must lie in [0.02, 1000]", rate);
    if (frames == 0 || frames > LARGEST_CHUNK) PG_FAIL (PG_E_USAGE, "%s: no pictures for a movie", path);
    PG_ALLOC (m, 1);
    m->frames = frames;
    if (rate == floor (rate)) m->delay[0] = 1, m->delay[1] = (uint16_t) rate;
    else m->delay[0] = (uint16_t) fmax (1, round (1000 / rate)), m->delay[1] = 1000;
    m->path = pg_strdup (path);
    if (!m->path) PG_FAIL (PG_E_MEMORY, "no memory for a path");
    PG_TRY (pg_file_create (&m->file, path));
    *out = m, m = NULL;
done:
    if (m) pg_free (m->path);
    pg_free (m);
    return status;
}

pg_status pg_movie_add (pg_movie *m, const char *picture)
{
    pg_status status = PG_OK;
    char *text = NULL;
    size_t size = 0, at = sizeof signature;
    int begun = 0;
    PG_TRY (pg_file_text (&text, &size, picture));
    const unsigned char *byte = (const unsigned char *) text;
    if (m->count == m->frames)
        PG_FAIL (PG_E_USAGE, "%s: more pictures than the %zu promised", m->path, m->frames);
    if (size < at || memcmp (byte, signature, at) != 0)
        PG_FAIL (PG_E_FILE, "%s is no PNG file", picture);
    while (at < size) {
        size_t room = size - at, n = room >= HEAD + CHECKSUM ? read_32 (byte + at) : room;
        if (room < HEAD + CHECKSUM || n > room - HEAD - CHECKSUM)
            PG_FAIL (PG_E_FILE, "%s is cut off", picture);
        PG_TRY (take_chunk (m, picture, byte + at, n, &begun));
        at += n + HEAD + CHECKSUM;
    }
    if (!begun) PG_FAIL (PG_E_FILE, "%s holds no picture", picture);
    m->count++;
done:
    pg_free (text);
    return status;
}

pg_status pg_movie_close (pg_movie **movie, pg_status so_far)
{
    pg_status status = so_far;
    pg_movie *m = *movie;
    if (!m) return status;
    if (status == PG_OK && m->count < m->frames) {
        pg_error (PG_E_USAGE, PG_HERE, "%s: %zu pictures instead of %zu", m->path, m->count, m->frames);
        status = PG_E_USAGE;
    }
    if (status == PG_OK) status = put_chunk (m, "IEND", 0, NULL, 0, NULL);
    errno = 0;
    if (fclose (m->file) != 0 && status == PG_OK) {
        pg_error (PG_E_FILE, PG_HERE, "%s: %s", m->path, strerror (errno ? errno : EIO));
        status = PG_E_FILE;
    }
    if (status != PG_OK) remove (m->path);
    pg_free (m->path), pg_free (m);
    *movie = NULL;
    return status;
}

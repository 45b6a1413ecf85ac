/* SPDX-License-Identifier: GPL-3.0-or-later
 * Writes movies as animated PNG: the chunks of single pictures, which cairo has written, in one file. The
 * first picture stays an ordinary one; the data of the others stand in chunks of their own with numbers
 * (PNG third edition, sections 5.2 and 11.3.6). Nothing is compressed or decompressed here. */
#include "perigal/output.h"
#include "picture_private.h"
#include <errno.h>
#include <math.h>
#include <string.h>

static const unsigned char signature[8] = { 0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n' };
/* Bytes of a chunk's head (length, name), of a number behind it, and of its checksum; most bytes of data. */
enum { HEAD = 8, NUMBER = 4, CHECKSUM = 4, LARGEST_CHUNK = 0x7fffffff };

struct pg_movie {
    FILE    *file;
    char    *path;
    /* Numbers of pictures promised and written; number of the next numbered chunk; size in pixels. */
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
static void write_number (unsigned char *b, size_t bytes, uint32_t v)
{
    for (size_t k = 0; k < bytes; k++) b[bytes - 1 - k] = (unsigned char) (v >> (8 * k));
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

static pg_status put (pg_movie *m, const unsigned char *data, size_t n)
{
    errno = 0;
    if (n == 0 || fwrite (data, 1, n, m->file) == n) return PG_OK;
    return pg_error (PG_E_FILE, PG_HERE, "%s: %s", m->path, strerror (errno ? errno : EIO));
}

/* Writes a chunk; numbered: its data begin with the next number. */
static pg_status put_chunk (pg_movie *m, const char *name, int numbered, const unsigned char *data, size_t n)
{
    pg_status status = PG_OK;
    unsigned char head[HEAD + NUMBER], tail[CHECKSUM];
    size_t size = numbered ? sizeof head : HEAD;
    if (n > LARGEST_CHUNK - NUMBER) PG_FAIL (PG_E_LIMIT, "%s: the pictures are too large", m->path);
    write_number (head, 4, (uint32_t) (n + size - HEAD)), memcpy (head + 4, name, 4);
    if (numbered) write_number (head + HEAD, NUMBER, m->number++);
    write_number (tail, CHECKSUM, ~checksum (checksum (0xffffffffu, head + 4, size - 4), data, n));
    PG_TRY (put (m, head, size));
    PG_TRY (put (m, data, n));
    PG_TRY (put (m, tail, CHECKSUM));
done:
    return status;
}

/* Writes the control chunk of the next picture: how long it stays, and that it covers the whole area. */
static pg_status put_control (pg_movie *m)
{
    unsigned char data[22] = { 0 };
    write_number (data, 4, m->width), write_number (data + 4, 4, m->height);
    write_number (data + 16, 2, m->delay[0]), write_number (data + 18, 2, m->delay[1]);
    return put_chunk (m, "fcTL", 1, data, sizeof data);
}

/* Writes the head of the movie: that of its first picture, and the number of pictures, repeated for ever. */
static pg_status put_head (pg_movie *m, const unsigned char *data, size_t n)
{
    pg_status status = PG_OK;
    unsigned char all[8] = { 0 };
    m->width = read_32 (data), m->height = read_32 (data + 4);
    write_number (all, 4, (uint32_t) m->frames);
    PG_TRY (put (m, signature, sizeof signature));
    PG_TRY (put_chunk (m, "IHDR", 0, data, n));
    PG_TRY (put_chunk (m, "acTL", 0, all, sizeof all));
done:
    return status;
}

/* Takes over one chunk of a picture: the head begins the movie or must agree with it, image data are copied,
 * all else is left out. *begun: 1 once image data have come. */
static pg_status take_chunk (pg_movie *m, const char *picture, const unsigned char *chunk, size_t n,
                             int *begun)
{
    pg_status status = PG_OK;
    const unsigned char *data = chunk + HEAD;
    if (memcmp (chunk + 4, "IHDR", 4) == 0 && n >= 13) {
        if (m->count == 0) PG_TRY (put_head (m, data, n));
        else if (read_32 (data) != m->width || read_32 (data + 4) != m->height)
            PG_FAIL (PG_E_USAGE, "%s: %u x %u pixels, but the movie has %u x %u", picture, read_32 (data),
                     read_32 (data + 4), m->width, m->height);
    } else if (memcmp (chunk + 4, "IDAT", 4) == 0) {
        if (!*begun) PG_TRY (put_control (m));
        *begun = 1;
        PG_TRY (put_chunk (m, m->count ? "fdAT" : "IDAT", m->count > 0, data, n));
    }
done:
    return status;
}

/* ---- the movie -------------------------------------------------------------------------------------- */
/* Whole rates are exact, others to a thousandth of a second or better. */
pg_status pg_movie_create (pg_movie **out, const char *path, size_t frames, double rate)
{
    pg_status status = PG_OK;
    pg_movie *m = NULL;
    if (!pg_ends_with (path, ".png") && !pg_ends_with (path, ".apng"))
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
    if (status == PG_OK) status = put_chunk (m, "IEND", 0, NULL, 0);
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

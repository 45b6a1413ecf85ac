/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: the hash that identifies a scene and its files in reports (FIPS 180-4). */
#ifndef PG_SCENE_SHA256_H
#define PG_SCENE_SHA256_H
#include <stddef.h>
#include <stdint.h>

/* State of a hash, the block being filled, and the number of bytes so far. */
typedef struct { uint32_t h[8]; unsigned char block[64]; uint64_t length; } pg_sha256;
void pg_sha256_start (pg_sha256 *s);
void pg_sha256_add   (pg_sha256 *s, const void *data, size_t n);
/* Writes 64 hexadecimal digits and a zero. */
void pg_sha256_end   (pg_sha256 *s, char hex[65]);
#endif

/* SPDX-License-Identifier: GPL-3.0-or-later
 * sha256.h: the hash that names a scene in reports (FIPS 180-4). */
#ifndef PG_SCENE_SHA256_H
#define PG_SCENE_SHA256_H
#include <stddef.h>
#include <stdint.h>

typedef struct { uint32_t h[8]; unsigned char block[64]; uint64_t length; } pg_sha256;
void pg_sha256_start (pg_sha256 *s);
void pg_sha256_add   (pg_sha256 *s, const void *data, size_t n);
void pg_sha256_end   (pg_sha256 *s, char hex[65]);
#endif

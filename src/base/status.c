/* SPDX-License-Identifier: GPL-3.0-or-later
 * Texts of the status codes, and the message of the last failure on each thread. */
#include "perigal/base.h"
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* The message, and "file:line" of the source that recorded it. */
static _Thread_local char message[16384];
static _Thread_local char place[256];

const char *pg_status_text (pg_status status)
{
    static const char *const text[] = {
#define X(name, words) words,
        PG_STATUS_LIST (X)
#undef X
    };
    return (unsigned) status < PG_STATUS_COUNT ? text[status] : "unknown status";
}

const char *pg_last_error (void) { return message; }
const char *pg_last_error_where (void) { return place; }

pg_status pg_error (pg_status code, const char *where, const char *format, ...)
{
    /* Formatted aside, since the arguments may point into the present message. */
    char text[sizeof message];
    va_list args;
    va_start (args, format);
    vsnprintf (text, sizeof text, format, args);
    va_end (args);
    memcpy (message, text, sizeof message);
    snprintf (place, sizeof place, "%s", where);
    return code;
}

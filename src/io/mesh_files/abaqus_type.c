/* SPDX-License-Identifier: GPL-3.0-or-later
 * Element types of Abaqus and CalculiX: which elements they are, the order of their nodes, and the numbers
 * of their faces in terms of Exodus. Elements that differ only in formulation or integration are the same
 * here, as only the geometry is read. */
#include "abaqus.h"
#include "perigal/scene.h"
#include <ctype.h>
#include <string.h>

/* Base names; letters that choose integration or formulation (R, I, H, T, P, E, ...) may follow. */
static const struct { const char *base; abaqus_type type;
} table[] = {
    { "C3D4", { PG_TET4, 4, 0 } },    { "C3D10", { PG_TET10, 10, 0 } },
    { "C3D5", { PG_PYRAMID5, 5, 0 } }, { "DC3D5", { PG_PYRAMID5, 5, 0 } },
    { "C3D6", { PG_WEDGE6, 6, 0 } },  { "C3D15", { PG_WEDGE15, 15, 0 } },
    { "C3D8", { PG_HEX8, 8, 0 } },    { "C3D20", { PG_HEX20, 20, 0 } },
    { "SC6", { PG_WEDGE6, 6, 0 } },   { "SC8", { PG_HEX8, 8, 0 } },
    { "DC3D4", { PG_TET4, 4, 0 } },   { "DC3D10", { PG_TET10, 10, 0 } },
    { "DC3D6", { PG_WEDGE6, 6, 0 } }, { "DC3D15", { PG_WEDGE15, 15, 0 } },
    { "DC3D8", { PG_HEX8, 8, 0 } },   { "DC3D20", { PG_HEX20, 20, 0 } },
    { "CPS3", { PG_TRI3, 3, 0 } },    { "CPS4", { PG_QUAD4, 4, 0 } },
    { "CPS6", { PG_TRI6, 6, 0 } },    { "CPS8", { PG_QUAD8, 8, 0 } },
    { "CPE3", { PG_TRI3, 3, 0 } },    { "CPE4", { PG_QUAD4, 4, 0 } },
    { "CPE6", { PG_TRI6, 6, 0 } },    { "CPE8", { PG_QUAD8, 8, 0 } },
    { "CPEG3", { PG_TRI3, 3, 0 } },   { "CPEG4", { PG_QUAD4, 4, 0 } },
    { "CPEG6", { PG_TRI6, 6, 0 } },   { "CPEG8", { PG_QUAD8, 8, 0 } },
    { "C2D3", { PG_TRI3, 3, 0 } },    { "C2D4", { PG_QUAD4, 4, 0 } },
    { "C2D6", { PG_TRI6, 6, 0 } },    { "C2D8", { PG_QUAD8, 8, 0 } },
    { "DC2D3", { PG_TRI3, 3, 0 } },   { "DC2D4", { PG_QUAD4, 4, 0 } },
    { "DC2D6", { PG_TRI6, 6, 0 } },   { "DC2D8", { PG_QUAD8, 8, 0 } },
    { "M3D3", { PG_TRI3, 3, 1 } },    { "M3D4", { PG_QUAD4, 4, 1 } },
    { "M3D6", { PG_TRI6, 6, 1 } },    { "M3D8", { PG_QUAD8, 8, 1 } },
    { "M3D9", { PG_QUAD9, 9, 1 } },   { "S3", { PG_TRI3, 3, 1 } },
    { "S4", { PG_QUAD4, 4, 1 } },     { "S6", { PG_TRI6, 6, 1 } },
    { "S8", { PG_QUAD8, 8, 1 } },     { "S9", { PG_QUAD9, 9, 1 } },
    { "STRI3", { PG_TRI3, 3, 1 } },   { "STRI65", { PG_TRI6, 6, 1 } },
    { "R3D3", { PG_TRI3, 3, 1 } },    { "R3D4", { PG_QUAD4, 4, 1 } },
    { "SFM3D3", { PG_TRI3, 3, 1 } },  { "SFM3D4", { PG_QUAD4, 4, 1 } },
    { "SFM3D6", { PG_TRI6, 6, 1 } },  { "SFM3D8", { PG_QUAD8, 8, 1 } },
    { "T2D2", { PG_BAR2, 2, 0 } },    { "T3D2", { PG_BAR2, 2, 0 } },
    { "T2D3", { PG_BAR3, 3, 0 } },    { "T3D3", { PG_BAR3, 3, 0 } },
    { "B21", { PG_BAR2, 2, 0 } },     { "B31", { PG_BAR2, 2, 0 } },
    { "B22", { PG_BAR3, 3, 0 } },     { "B32", { PG_BAR3, 3, 0 } },
    { "R2D2", { PG_BAR2, 2, 0 } },
};

/* Names of element types to suggest for an unknown one. */
static const char *const known = "C3D4|C3D5|C3D6|C3D8|C3D10|C3D15|C3D20|CPS3|CPS4|CPS6|CPS8|"
                                 "CPE3|CPE4|CPE6|CPE8|"
                                 "C2D3|C2D4|C2D6|C2D8|M3D3|M3D4|M3D6|M3D8|"
                                 "S3|S4|S6|S8|T2D2|T3D2|T3D3|B31|B32";

/* 1 if these letters may follow the base name of a type: R reduced, I incompatible modes, H hybrid, M
 * modified, T, P, E coupled fields, S; 5 of S4R5. */
static int is_variant (const char *s) { return s[strspn (s, "RIHMTPES5")] == 0 && strlen (s) <= 4; }

/* The type is that of the longest base name with which the name begins. */
int abaqus_find_type (const char *name, abaqus_type *type, char near[32])
{
    static const char *const points[] = { "MASS",   "ROTARYI", "SPRING", "DASHPOT", "GAP",
                                          "CONN2D", "CONN3D",  "DCOUP",  "JOINTC",  "HEATCAP" };
    size_t length = 0;
    near[0] = 0;
    for (size_t k = 0; k < sizeof table / sizeof *table; k++) {
        size_t n = strlen (table[k].base);
        if (n <= length || strncmp (name, table[k].base, n) != 0 || !is_variant (name + n)) continue;
        *type = table[k].type, length = n;
    }
    if (length) return 1;
    for (size_t k = 0; k < sizeof points / sizeof *points; k++)
        if (strncmp (name, points[k], strlen (points[k])) == 0) return 2;
    const char *found = pg_nearest_name (name, known);
    if (found) strncat (near, found, 31);
    return 0;
}

/* Abaqus lists the middles of the upper edges before those of the upright ones. */
void abaqus_node_order (pg_element kind, int order[PG_ELEMENT_NODES])
{
    for (int k = 0; k < PG_ELEMENT_NODES; k++) order[k] = k;
    int first = kind == PG_HEX20 ? 12 : kind == PG_WEDGE15 ? 9 : 0, n = kind == PG_HEX20 ? 4 : 3;
    /* Middles of the upright edges come before those of the upper ones in Exodus. */
    if (first)
        for (int k = 0; k < n; k++) order[first + k] = first + n + k, order[first + n + k] = first + k;
    /* Abaqus lists the nodes of a line in their order along it. */
    if (kind == PG_BAR3) order[1] = 2, order[2] = 1;
}

/* Side in the order of Exodus of face `number` (from 0) of a solid element in that of Abaqus. */
static int solid_side (pg_element kind, int number)
{
    /* Abaqus begins with the bottom (and the top), Exodus with the upright sides. */
    static const signed char tet[] = { 3, 0, 1, 2 }, pyramid[] = { 4, 0, 1, 2, 3 },
                             wedge[] = { 3, 4, 0, 1, 2 },
                             hex[] = { 4, 5, 0, 1, 2, 3 };
    int corners = pg_element_types[kind].corners;
    return corners == 4   ? tet[number]
           : corners == 5 ? pyramid[number]
           : corners == 6 ? wedge[number]
                          : hex[number];
}

/* The edges of shells are E1, E2 ..., or S3, S4 ... behind their two faces. */
int abaqus_side (pg_element kind, int shell, const char *face)
{
    int letter = toupper ((unsigned char) face[0]), second = letter ? toupper ((unsigned char) face[1]) : 0;
    int number = second - '1', ordinary = number >= 0 && number <= 5 && !face[2];
    if (letter == 'S' && (second == 'P' || second == 'N')) return shell ? -2 : -1;     /* SPOS, SNEG */
    if (!ordinary || !strchr ("SPE", letter)) return -1;
    /* S1 and S2 are the two faces of a shell, S3 and on its edges; edges are also E1 and on. */
    if (shell && letter != 'E') {
        if (number < 2) return -2;
        number -= 2;
    }
    if (number >= pg_element_types[kind].faces) return -1;
    return pg_element_types[kind].dim < 3 ? number : solid_side (kind, number);
}

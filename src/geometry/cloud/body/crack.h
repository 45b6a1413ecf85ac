/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: cracks while they are read. The list `cracks` of the input file becomes one list of pieces, sharp
 * cracks and slots; pg_cracks_read and pg_slots_read return one kind each. */
#ifndef PERIGAL_CLOUD_CRACK_H
#define PERIGAL_CLOUD_CRACK_H
#include "perigal/cloud.h"

/* Number of vertices of the polygon by which a disc is drawn, and of the polygon that replaces an ellipse. */
enum { CRACK_CORNERS = 64 };

/* ---- kinds of cracks (crack_kinds.c) ------------------------------------------------------------------- */
/* Each function here fills an empty crack. *why: what is wrong with it, in words that follow "the crack";
 * NULL: nothing. */
pg_status crack_segment (pg_crack *c, const double *from, const double *to, const char **why);
pg_status crack_polygon (pg_crack *c, size_t n, const double *vertex /* n x 3 */, const char **why);
pg_status crack_disc    (pg_crack *c, const double *centre, const double *normal, double radius,
                         const char **why);
/* An ellipse in the plane normal to `normal` whose long axis lies nearest to `along`: as a polygon of the
 * same area; lengths in m. */
pg_status crack_ellipse (pg_crack *c, const double *centre, const double *normal, const double *along,
                         double length, double breadth, const char **why);
/* A 2D outline, a polygon or an ellipse, inside of which the material is removed; angle: of the long axis
 * from x, rad. */
pg_status crack_outline (pg_crack *c, size_t n, const double *vertex /* n x 2 */, const char **why);
pg_status crack_slot_ellipse (pg_crack *c, const double *centre, double length, double breadth, double angle,
                              const char **why);
/* Two unit vectors e and f in the plane normal to the unit vector n. */
void      crack_plane (const double *n, double *e, double *f);

/* ---- list of cracks under construction (crack_read.c) -------------------------------------------------- */
typedef struct {
    const pg_scene *scene;
    /* The body without slots, but with layers; its n is 0 if points or a mesh are given instead of shapes. */
    const pg_body  *body;
    pg_cracks *all;
    size_t  capacity;
    /* The entry of `cracks` that is being read, and its path "cracks[3]" in the input file. */
    size_t  entry;
    char    at[64];
    /* Width of the cracks of this entry, m; 0: sharp. */
    double  width;
    /* Cracks of the random networks so far. */
    long    drawn;
} crack_list;
/* An empty crack at the end of the list; NULL: no memory. It has the entry's number and width. */
pg_crack *crack_next (crack_list *list);
/* Append the cracks of a file (crack_file.c), and those of a random network (crack_random.c). */
pg_status crack_read_file   (crack_list *list);
pg_status crack_read_random (crack_list *list);
/* Area (2D) or volume (3D) of a body of shapes without layers (crack_network.c), m^2 or m^3; 0: the body is
 * not given by shapes. */
pg_status crack_body_measure (double *out, const pg_body *body);

/* ---- does a crack meet the body? (crack_meet.c) -------------------------------------------------------- */
/* 0: the crack certainly does not meet the body. */
int       crack_may_meet (const pg_body *body, const pg_crack *c);

/* ---- slots (crack_slots.c) ----------------------------------------------------------------------------- */
/* Number of shapes that the slots among the cracks need, and these shapes, all subtracted. */
size_t    crack_slot_count  (const pg_cracks *all);
pg_status crack_slot_shapes (pg_shape *shape, const pg_cracks *all);
/* Does the input file give any crack that may remove material? */
int       crack_slots_given (const pg_scene *scene);

/* Reads all entries of `cracks`, sharp cracks and slots. */
pg_status crack_read_all (pg_cracks *out, const pg_scene *scene);
/* Read the body without its slots, and the body with these `slots` shapes, which it takes over,
 * subtracted. */
pg_status pg_body_read_uncut (pg_body *out, const pg_scene *scene);
pg_status pg_body_read_cut (pg_body *out, const pg_scene *scene, size_t slots, pg_shape *slot);
#endif

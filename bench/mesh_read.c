/* SPDX-License-Identifier: GPL-3.0-or-later
 * Times the reading of meshes: mesh_read [FILE...]. Without files a cube of 100^3 hexahedra and a square
 * of 10^6 triangles are written and read in every format. CSV: file, bytes, dimension, nodes, elements,
 * blocks, node sets, volume, processor seconds of reading and of finding the surface (each as least,
 * median, largest of five), faces of the surface. */
#include "perigal/mesh_files.h"
#include "spread.h"
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

enum { REPEATS = 5 };

/* ---- files --------------------------------------------------------------------------------------------- */
/* A cube or square of n cells along each side, two triangles in a cell of the square. */
typedef struct { int dim; long n, nodes, elements; } lattice;

static lattice lattice_of (int dim, long n)
{
    lattice l = { dim, n, (n + 1) * (n + 1), 2 * n * n };
    if (dim == 3) l.nodes *= n + 1, l.elements = n * n * n;
    return l;
}

static void node_of (const lattice *l, long k, double x[3])
{
    double h = 1.0 / (double) l->n;
    for (int a = 0; a < 3; a++, k /= l->n + 1) x[a] = a < l->dim ? (double) (k % (l->n + 1)) * h : 0;
}

static int element_of (const lattice *l, long e, long node[8])
{
    long d = l->n + 1, cell = l->dim == 3 ? e : e / 2,
         c = 1 + cell % l->n + cell / l->n % l->n * d + cell / (l->n * l->n) * d * d;
    if (l->dim == 3) {
        for (int k = 0; k < 2; k++)
            node[4 * k] = c + k * d * d, node[4 * k + 1] = c + 1 + k * d * d,
                     node[4 * k + 2] = c + 1 + d + k * d * d, node[4 * k + 3] = c + d + k * d * d;
        return 8;
    }
    node[0] = c, node[1] = e % 2 ? c + 1 + d : c + 1, node[2] = e % 2 ? c + d : c + 1 + d;
    return 3;
}

static void put_ints (FILE *f, size_t n, const long *value)
{
    for (size_t k = 0; k < n; k++) fwrite (&(int) { (int) value[k] }, 4, 1, f);
}

static void write_2 (FILE *f, const lattice *l, int binary)
{
    double x[3];
    long node[8], type = l->dim == 3 ? 5 : 2;
    fprintf (f, "$MeshFormat\n2.2 %d 8\n", binary);
    if (binary) put_ints (f, 1, (long[1]) { 1 }), fprintf (f, "\n");
    fprintf (f, "$EndMeshFormat\n$Nodes\n%ld\n", l->nodes);
    for (long k = 0; k < l->nodes; k++) {
        node_of (l, k, x);
        if (binary) put_ints (f, 1, (long[1]) { k + 1 }), fwrite (x, 8, 3, f);
        else fprintf (f, "%ld %.16g %.16g %.16g\n", k + 1, x[0], x[1], x[2]);
    }
    fprintf (f, "$EndNodes\n$Elements\n%ld\n", l->elements);
    if (binary) put_ints (f, 3, (long[3]) { type, l->elements, 2 });
    for (long e = 0; e < l->elements; e++) {
        int n = element_of (l, e, node);
        if (binary) put_ints (f, 3, (long[3]) { e + 1, 1, 1 }), put_ints (f, (size_t) n, node);
        else fprintf (f, "%ld %ld 2 1 1", e + 1, type);
        for (int k = 0; !binary && k < n; k++) fprintf (f, " %ld%s", node[k], k + 1 < n ? "" : "\n");
    }
    fprintf (f, "$EndElements\n");
}

static void write_4 (FILE *f, const lattice *l, int binary)
{
    double x[3];
    long node[8], type = l->dim == 3 ? 5 : 2,
                  head[2][4] = { { 1, l->nodes, 1, l->nodes }, { 1, l->elements, 1, l->elements } };
    fprintf (f, "$MeshFormat\n4.1 %d 8\n", binary);
    if (binary) put_ints (f, 1, (long[1]) { 1 }), fprintf (f, "\n");
    fprintf (f, "$EndMeshFormat\n$Nodes\n");
    if (binary)
        fwrite (head[0], 8, 4, f), put_ints (f, 3, (long[3]){ l->dim, 1, 0 }), fwrite (&l->nodes, 8, 1, f);
    else fprintf (f, "1 %ld 1 %ld\n%d 1 0 %ld\n", l->nodes, l->nodes, l->dim, l->nodes);
    for (long k = 1; k <= l->nodes; k++)
        if (binary) fwrite (&k, 8, 1, f);
        else fprintf (f, "%ld\n", k);
    for (long k = 0; k < l->nodes; k++) {
        node_of (l, k, x);
        if (binary) fwrite (x, 8, 3, f);
        else fprintf (f, "%.16g %.16g %.16g\n", x[0], x[1], x[2]);
    }
    fprintf (f, "$EndNodes\n$Elements\n");
    if (binary)
        fwrite (head[1], 8, 4, f), put_ints (f, 3, (long[3]){ l->dim, 1, type }),
            fwrite (&l->elements, 8, 1, f);
    else fprintf (f, "1 %ld 1 %ld\n%d 1 %ld %ld\n", l->elements, l->elements, l->dim, type, l->elements);
    for (long e = 1; e <= l->elements; e++) {
        int n = element_of (l, e - 1, node);
        if (binary) fwrite (&e, 8, 1, f), fwrite (node, 8, (size_t) n, f);
        else fprintf (f, "%ld", e);
        for (int k = 0; !binary && k < n; k++) fprintf (f, " %ld%s", node[k], k + 1 < n ? "" : "\n");
    }
    fprintf (f, "$EndElements\n");
}

static void write_inp (FILE *f, const lattice *l, int unused)
{
    double x[3];
    long node[8];
    (void) unused;
    fprintf (f, "*NODE, NSET=ALL\n");
    for (long k = 0; k < l->nodes; k++)
        node_of (l, k, x), fprintf (f, "%ld, %.16g, %.16g, %.16g\n", k + 1, x[0], x[1], x[2]);
    fprintf (f, "*ELEMENT, TYPE=%s, ELSET=BODY\n", l->dim == 3 ? "C3D8" : "CPS3");
    for (long e = 0; e < l->elements; e++) {
        int n = element_of (l, e, node);
        fprintf (f, "%ld", e + 1);
        for (int k = 0; k < n; k++) fprintf (f, ", %ld%s", node[k], k + 1 < n ? "" : "\n");
    }
}

static void write_frd (FILE *f, const lattice *l, int binary)
{
    double x[3];
    long node[8], kind = l->dim == 3 ? 1 : 7;
    fprintf (f, "    1C\n    2C%18s%12ld%37s%d\n", "", l->nodes, "", binary ? 3 : 1);
    for (long k = 0; k < l->nodes; k++) {
        node_of (l, k, x);
        if (binary) put_ints (f, 1, (long[1]) { k + 1 }), fwrite (x, 8, 3, f);
        else fprintf (f, " -1%10ld%12.5E%12.5E%12.5E\n", k + 1, x[0], x[1], x[2]);
    }
    if (!binary) fprintf (f, " -3\n");
    fprintf (f, "    3C%18s%12ld%37s%d\n", "", l->elements, "", binary ? 2 : 1);
    for (long e = 0; e < l->elements; e++) {
        int n = element_of (l, e, node);
        if (binary) put_ints (f, 4, (long[4]) { e + 1, kind, 0, 1 }), put_ints (f, (size_t) n, node);
        else fprintf (f, " -1%10ld%5ld%5d%5d\n -2", e + 1, kind, 0, 1);
        for (int k = 0; !binary && k < n; k++) fprintf (f, "%10ld%s", node[k], k + 1 < n ? "" : "\n");
    }
    if (!binary) fprintf (f, " -3\n");
    fprintf (f, " 9999\n");
}

/* The bytes of a classic netCDF file (64-bit offsets) by its published layout, most significant byte
 * first. */
static void big (FILE *f, int bytes, uint64_t v)
{
    for (int k = bytes - 1; k >= 0; k--) fputc ((int) (v >> (8 * k) & 255), f);
}

static void name (FILE *f, const char *text)
{
    big (f, 4, strlen (text)), fputs (text, f);
    for (size_t k = strlen (text); k % 4; k++) fputc (0, f);
}

static void variable (FILE *f, const char *text, const char *type, int dims, const int *dim, int kind,
                      uint64_t bytes, uint64_t begin)
{
    name (f, text), big (f, 4, (uint64_t) dims);
    for (int k = 0; k < dims; k++) big (f, 4, (uint64_t) dim[k]);
    if (type) big (f, 4, 12), big (f, 4, 1), name (f, "elem_type"), big (f, 4, 2), name (f, type);
    else big (f, 8, 0);
    big (f, 4, (uint64_t) kind), big (f, 4, bytes), big (f, 8, begin);
}

static void write_exodus (FILE *f, const lattice *l, int unused)
{
    const char *dimension[6] = { "num_nodes",      "num_elem",        "num_el_blk",
                                 "num_el_in_blk1", "num_nod_per_el1", "num_dim" };
    int corners = l->dim == 3 ? 8 : 3;
    uint64_t length[6] = { (uint64_t) l->nodes,    (uint64_t) l->elements, 1,
                           (uint64_t) l->elements, (uint64_t) corners,     (uint64_t) l->dim };
    uint64_t places = 8 * length[0], begin = 1024;         /* the header is shorter */
    double x[3];
    long node[8];
    (void) unused;
    fputs ("CDF\2", f), big (f, 4, 0), big (f, 4, 10), big (f, 4, 6);
    for (int k = 0; k < 6; k++) name (f, dimension[k]), big (f, 4, length[k]);
    big (f, 8, 0), big (f, 4, 11), big (f, 4, (uint64_t) l->dim + 1);
    for (int a = 0; a < l->dim; a++)
        variable (f,
                  a == 0   ? "coordx"
                  : a == 1 ? "coordy"
                           : "coordz",
                  NULL, 1, (int[1]){ 0 }, 6, places, begin + (uint64_t) a * places);
    variable (f, "connect1", l->dim == 3 ? "HEX8" : "TRI3", 2, (int[2]){ 3, 4 }, 4, 4 * length[1] * length[4],
              begin + length[5] * places);
    while (ftell (f) < (long) begin) fputc (0, f);
    for (int a = 0; a < l->dim; a++)
        for (long k = 0; k < l->nodes; k++) {
            uint64_t bits;
            node_of (l, k, x), memcpy (&bits, &x[a], 8), big (f, 8, bits);
        }
    for (long e = 0; e < l->elements; e++) {
        element_of (l, e, node);
        for (int k = 0; k < corners; k++) big (f, 4, (uint64_t) node[k]);
    }
}

/* ---- reading ------------------------------------------------------------------------------------------- */
static double volume_of (const pg_mesh *m)
{
    double sum = 0, xi[3 * PG_ELEMENT_POINTS], w[PG_ELEMENT_POINTS], x[3 * PG_ELEMENT_NODES];
    for (size_t e = 0; e < m->n; e++) {
        size_t d = (size_t) m->dim, n = m->start[e + 1] - m->start[e];
        for (size_t k = 0; k < n; k++)
            for (size_t a = 0; a < d; a++) x[k * d + a] = m->x[3 * (size_t) m->node[m->start[e] + k] + a];
        int q = pg_element_rule (m->kind[e], 3, xi, w);
        for (int p = 0; p < q; p++)
            sum += w[p] * pg_element_map (m->kind[e], m->dim, x, xi + p * m->dim, NULL, NULL);
    }
    return sum;
}

static pg_status time_file (const char *path, const char *name)
{
    pg_status status = PG_OK;
    pg_mesh mesh = { 0 };
    size_t faces;
    struct stat about;
    int *element = NULL, *side = NULL;
    spread reading = { 0 }, surface = { 0 };
    for (int k = 0; k < REPEATS; k++) {
        pg_mesh_clear (&mesh);
        pg_free (element), pg_free (side);
        element = side = NULL;
        double start = spread_processor ();
        PG_TRY (pg_mesh_read (&mesh, path));
        spread_add (&reading, spread_processor () - start);
        start = spread_processor ();
        PG_TRY (pg_mesh_surface (&mesh, &faces, &element, &side));
        spread_add (&surface, spread_processor () - start);
    }
    stat (path, &about);
    printf ("%s,%ld,%d,%zu,%zu,%zu,%zu,%.12g,", name, (long) about.st_size, mesh.dim, mesh.nnode, mesh.n,
            mesh.nblock, mesh.nnodes, volume_of (&mesh));
    spread_print (&reading, 1);
    spread_print (&surface, 1);
    printf ("%zu\n", faces);
    fflush (stdout);
done:
    if (status != PG_OK) fprintf (stderr, "mesh_read: %s\n", pg_last_error ());
    pg_mesh_clear (&mesh);
    pg_free (element), pg_free (side);
    return status;
}

typedef void (*writer) (FILE *f, const lattice *l, int binary);

static pg_status time_lattice (const lattice *l, const char *what)
{
    static const struct { const char *name; writer write; int binary;
    } variant[] = { { "msh 2.2 text", write_2, 0 }, { "msh 2.2 binary", write_2, 1 },
                    { "msh 4.1 text", write_4, 0 }, { "msh 4.1 binary", write_4, 1 },
                    { "inp", write_inp, 0 },        { "frd text", write_frd, 0 },
                    { "frd binary", write_frd, 1 }, { "exodus", write_exodus, 0 } };
    pg_status status = PG_OK;
    for (size_t k = 0; status == PG_OK && k < sizeof variant / sizeof *variant; k++) {
        char path[] = "/tmp/perigal_mesh_XXXXXX", name[80];
        int handle = mkstemp (path);
        FILE *f = handle < 0 ? NULL : fdopen (handle, "wb");
        if (!f) return pg_error (PG_E_FILE, PG_HERE, "%s: cannot be written", path);
        variant[k].write (f, l, variant[k].binary);
        if (fclose (f)) status = pg_error (PG_E_FILE, PG_HERE, "%s: cannot be written", path);
        snprintf (name, sizeof name, "%s %s", what, variant[k].name);
        if (status == PG_OK) status = time_file (path, name);
        unlink (path);
    }
    return status;
}

int main (int argc, char **argv)
{
    lattice cube = lattice_of (3, 100), square = lattice_of (2, 707);
    pg_status status = PG_OK;
    printf ("file,bytes,dimension,nodes,elements,blocks,node_sets,volume,"
            "read_s_min,read_s_median,read_s_max,surface_s_min,surface_s_median,surface_s_max,faces\n");
    for (int k = 1; k < argc; k++) if (time_file (argv[k], argv[k]) != PG_OK) status = PG_E_FILE;
    if (argc == 1) status = time_lattice (&cube, "hex8");
    if (argc == 1 && status == PG_OK) status = time_lattice (&square, "tri3");
    return status != PG_OK;
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * perigal-mesh: turns anything that Gmsh opens (.geo, .step, .iges, .brep, .stl, .msh, .unv,
 * .med ...) into a .msh file that Perigal reads, and meshes it if it is a geometry.
 *
 * It is a program of its own, built only where the library of Gmsh is installed (Debian:
 * libgmsh-dev), because loading that library takes longer than many a run. The steps: read the
 * command line, open the file in Gmsh, make elements unless there are some, name bodies and
 * sides, write, and read the result again as Perigal would, so that a file which Perigal
 * cannot use is noticed here. Exit codes: 0 done, 1 failed, 2 wrong arguments. */
#include "perigal/mesh_files.h"
#include <errno.h>
#include <gmshc.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What the command line asks for; 0 or NULL: not given. */
typedef struct { const char *input, *output; double size; int order, dim; } request;
/* Entities of a Gmsh model: n numbers, dimension and tag of each in turn. */
typedef struct { int *pair; size_t n; } entities;

static const char usage[] =
    "usage: perigal-mesh INPUT OUTPUT.msh [--size H] [--order 1|2] [--dim 2|3]\n"
    "Meshes a geometry (.geo, .step, .iges, .brep, .stl), or takes the elements of a mesh file, and writes "
    "Gmsh .msh 4.1.\n"
    "  --size H    length of the edges of elements, in the unit of the file (default: what the file says, "
    "else a tenth of the body)\n"
    "  --order N   1: straight elements, 2: with nodes on the middle of edges (default: as the file has "
    "them; 1 for a geometry)\n"
    "  --dim N     dimension of the mesh (default: that of the body; 3 for a closed surface .stl)\n"
    "Physical groups become blocks and sets; a body without any gets part_N (blocks) and side_N (sets).\n";

/* Prints the message with what Gmsh says about it, and returns 1. */
static int failed (const char *what, const char *path)
{
    char *text = NULL;
    int e;
    gmshLoggerGetLastError (&text, &e);
    fprintf (stderr, "perigal-mesh: %s: %s%s%s\n", path, what, text && *text ? ": Gmsh says: " : "",
             text && *text ? text : "");
    gmshFree (text);
    return 1;
}

/* ---- arguments ----------------------------------------------------------------------------------------- */
/* 1 if the whole text is a number from low to high. */
static int number_of (const char *text, double low, double high, double *value)
{
    char *end;
    *value = strtod (text, &end);
    return end != text && !*end && *value >= low && *value <= high;
}

/* Options that take a number: name, range, 1 if it must be an integer, and the words of the message about a
 * wrong value. */
enum { SIZE, ORDER, DIM };
static const struct { const char *name; double low, high; int whole; const char *needs; } options[] = {
    [SIZE] = { "--size", 1e-300, 1e300, 0, "a positive length" },
    [ORDER] = { "--order", 1, 2, 1, "1 or 2" },
    [DIM] = { "--dim", 2, 3, 1, "2 or 3" },
};

/* Index of an option that takes a number; -1 if the word is none. */
static int option_of (const char *word)
{
    for (int k = 0; k <= DIM; k++) if (strcmp (word, options[k].name) == 0) return k;
    return -1;
}

/* Reads the value of an option; 0 if it is missing, out of range, or not whole where it must
 * be. */
static int read_option (request *w, int option, const char *text)
{
    double v;
    if (!text || !number_of (text, options[option].low, options[option].high, &v)) return 0;
    if (options[option].whole && v != (int) v) return 0;
    if (option == SIZE) w->size = v;
    else *(option == ORDER ? &w->order : &w->dim) = (int) v;
    return 1;
}

/* 0 if both files are named and the one to write ends in .msh; else prints why not and returns
 * the exit code. */
static int check_files (const request *w)
{
    if (!w->output) {
        fprintf (stderr, "perigal-mesh: give a file to read and one to write\n%s", usage);
        return 2;
    }
    size_t n = strlen (w->output);
    if (n > 4 && strcmp (w->output + n - 4, ".msh") == 0) return 0;
    fprintf (stderr, "perigal-mesh: %s: the name of the file to write must end in .msh\n", w->output);
    return 2;
}

/* Reads the command line: 0 if it is right, else the exit code; -1 for --help. */
static int read_arguments (request *w, int argc, char **argv)
{
    for (int k = 1; k < argc; k++) {
        int option = option_of (argv[k]);
        if (!strcmp (argv[k], "--help") || !strcmp (argv[k], "-h")) return -1;
        if (option >= 0) {
            if (!read_option (w, option, k + 1 < argc ? argv[k + 1] : NULL)) {
                fprintf (stderr, "perigal-mesh: %s needs %s\n", argv[k], options[option].needs);
                return 2;
            }
            k++;
        } else if (argv[k][0] == '-' || w->output) {
            fprintf (stderr, "perigal-mesh: unknown argument '%s'\n%s", argv[k], usage);
            return 2;
        } else *(w->input ? &w->output : &w->input) = argv[k];
    }
    return check_files (w);
}

/* ---- meshing ------------------------------------------------------------------------------------------- */
/* 1 if the model has elements of that dimension. */
static int elements_of (int dim)
{
    int *type = NULL, e;
    size_t n = 0;
    gmshModelMeshGetElementTypes (&type, &n, dim, -1, &e);
    gmshFree (type);
    return n > 0;
}

/* Returns the entities of dimension dim; the caller frees .pair with gmshFree. */
static entities entities_of (int dim)
{
    entities list = { NULL, 0 };
    int e;
    gmshModelGetEntities (&list.pair, &list.n, dim, &e);
    return list;
}

/* A closed surface of triangles (.stl) becomes a body: its surface is divided into faces along
 * edges sharper than 40 degrees (0.698 rad), geometry is made of the faces, and a volume is
 * defined inside. Fails for surfaces with holes. */
static int fill_surface (const request *w)
{
    int e, bad = 0;
    gmshModelMeshClassifySurfaces (0.6981317, 1, 1, 3.1415926, 0, &e);
    bad |= e;
    if (!bad) gmshModelMeshCreateGeometry (NULL, 0, &e), bad |= e;
    if (bad) return failed ("its surface cannot be divided into faces", w->input);
    entities faces = entities_of (2);
    int *tag = malloc ((faces.n / 2 + 1) * sizeof *tag);
    for (size_t k = 0; tag && k < faces.n / 2; k++) tag[k] = faces.pair[2 * k + 1];
    int loop = gmshModelGeoAddSurfaceLoop (tag, faces.n / 2, -1, &e);
    bad |= e;
    if (!bad) gmshModelGeoAddVolume (&loop, 1, -1, &e), bad |= e;
    if (!bad) gmshModelGeoSynchronize (&e), bad |= e;
    gmshFree (faces.pair), free (tag);
    return bad ? failed ("its surface does not enclose a body", w->input) : 0;
}

/* 1 for files whose name ends in .stl. */
static int is_stl (const char *path)
{
    size_t n = strlen (path);
    return n > 4 && (!strcmp (path + n - 4, ".stl") || !strcmp (path + n - 4, ".STL"));
}

/* Meshes the loaded geometry with elements of dimension `want`; returns 0, or 1 if that fails. */
static int generate (const request *w, int want)
{
    int e;
    gmshModelMeshGenerate (want, &e);
    return e || !elements_of (want) ? failed ("could not be meshed", w->input) : 0;
}

/* Sets the edge length of elements; if the file has elements already they are kept, and a message says so. */
static void set_size (const request *w, int meshed)
{
    int e;
    if (!(w->size > 0)) return;
    gmshOptionSetNumber ("Mesh.MeshSizeMin", 0.5 * w->size, &e);
    gmshOptionSetNumber ("Mesh.MeshSizeMax", w->size, &e);
    if (meshed) fprintf (stderr, "perigal-mesh: %s: has elements already; --size is not used\n", w->input);
}

/* Returns 0 if a mesh of dimension `want` can be made: at most the dimension of the body, or 3 inside a
 * closed surface of triangles (.stl). */
static int check_dimension (const request *w, int dim, int want, int stl)
{
    if (dim < 1) return failed ("there is no body and no mesh in it", w->input);
    if (want <= dim || stl) return 0;
    fprintf (stderr, "perigal-mesh: %s: the body has dimension %d; a mesh of dimension %d cannot be made\n",
             w->input, dim, want);
    return 1;
}

/* Makes elements unless the file has some already, and sets their order. The dimension is that
 * of the body, or 3 for a closed surface; a mesh of a higher dimension than the body cannot be
 * made. Returns the exit code. */
static int make_mesh (const request *w)
{
    int e, dim = gmshModelGetDimension (&e), stl = dim == 2 && elements_of (2) && is_stl (w->input);
    int meshed = dim > 0 && elements_of (dim),
        want = w->dim ? w->dim
               : stl  ? 3
                      : dim,
        fill = stl && want == 3;
    if (check_dimension (w, dim, want, stl)) return 1;
    if (fill && fill_surface (w)) return 1;
    set_size (w, meshed && !stl);
    if ((!meshed || fill) && generate (w, want)) return 1;
    if (!w->order) return 0;
    gmshModelMeshSetOrder (w->order, &e);
    return e ? failed ("the order of the elements could not be changed", w->input) : 0;
}

/* ---- groups -------------------------------------------------------------------------------------------- */
/* Gives each entity of a dimension a physical group of its own, named as in the file or
 * STEM_TAG, so that scenes can refer to it as a block or a set. */
static void name_entities (int dim, const char *stem)
{
    entities list = entities_of (dim);
    for (size_t k = 0; k < list.n; k += 2) {
        char name[64], *given = NULL;
        int e, tag = list.pair[k + 1], group = gmshModelAddPhysicalGroup (dim, &tag, 1, -1, &e);
        if (e) continue;
        gmshModelGetEntityName (dim, tag, &given, &e);
        const char *last = given && strrchr (given, '/') ? strrchr (given, '/') + 1 : given;
        if (last && *last && strncmp (last, "Open CASCADE", 12)) snprintf (name, sizeof name, "%.63s", last);
        else snprintf (name, sizeof name, "%s_%d", stem, tag);
        gmshModelSetPhysicalName (dim, group, name, &e);
        gmshFree (given);
    }
    gmshFree (list.pair);
}

/* Writes version 4.1, binary. Names matter, because scenes refer to blocks and sets by them:
 * without any groups bodies and sides are named here; with groups of sides only, the bodies
 * are. Returns the exit code. */
static int write_mesh (const request *w)
{
    entities groups = { NULL, 0 }, top = { NULL, 0 };
    int e, dim = 3;
    while (dim > 1 && !elements_of (dim)) dim--;
    gmshModelGetPhysicalGroups (&groups.pair, &groups.n, -1, &e);
    gmshModelGetPhysicalGroups (&top.pair, &top.n, dim, &e);
    if (groups.n == 0) name_entities (dim, "part"), name_entities (dim - 1, "side");
    else if (top.n == 0) name_entities (dim, "part");
    gmshFree (groups.pair), gmshFree (top.pair);
    gmshOptionSetNumber ("Mesh.MshFileVersion", 4.1, &e), gmshOptionSetNumber ("Mesh.Binary", 1, &e);
    gmshWrite (w->output, &e);
    return e ? failed ("cannot be written", w->output) : 0;
}

/* Reads the file as Perigal will, and prints its dimension, elements, blocks and sets; 1 if it
 * cannot be used. */
static int look_at (const request *w)
{
    pg_mesh mesh;
    size_t count[PG_ELEMENTS] = { 0 };
    if (pg_mesh_read (&mesh, w->output) != PG_OK) {
        fprintf (stderr, "perigal-mesh: was written, but cannot be used: %s\n", pg_last_error ());
        return 1;
    }
    if (mesh.nforeign) {
        fprintf (stderr, "perigal-mesh: was written, but has elements that Perigal does not know%s: %s\n",
                 w->order == 2 ? " (--order 1 has fewer kinds)" : "", mesh.foreign[0].words);
        pg_mesh_clear (&mesh);
        return 1;
    }
    for (size_t k = 0; k < mesh.n; k++) count[mesh.kind[k]]++;
    printf ("%s: %dD, %zu nodes", w->output, mesh.dim, mesh.nnode);
    for (int k = 0; k < PG_ELEMENTS; k++)
        if (count[k]) printf (", %zu %s", count[k], pg_element_types[k].name);
    printf ("\nblocks:");
    for (size_t k = 0; k < mesh.nblock; k++) printf (" %s", mesh.blocks[k].name);
    printf ("\nsets:");
    for (size_t k = 0; k < mesh.nnodes; k++) printf (" %s", mesh.nodes[k].name);
    printf ("\n");
    pg_mesh_clear (&mesh);
    return 0;
}

/* Starts Gmsh without output of its own; its messages are kept for `failed`. gmshInitialize
 * has one more argument in newer versions. */
static void start (void)
{
    int e;
#ifdef GMSH_RUN
    gmshInitialize (0, NULL, 0, 0, &e);
#else
    gmshInitialize (0, NULL, 0, &e);
#endif
    gmshOptionSetNumber ("General.Terminal", 0, &e);
    gmshOptionSetNumber ("General.AbortOnError", 0, &e);
    gmshLoggerStart (&e);
}

/* Returns `code`, or 70 in place of 0 if standard output could not be written. */
static int all_written (int code)
{
    if (fflush (stdout) == 0 && !ferror (stdout)) return code;
    fprintf (stderr, "perigal-mesh: the output cannot be written: %s\n", strerror (errno ? errno : EIO));
    return code ? code : 70;
}

/* Input and output are tried before Gmsh starts, so that a wrong path is noticed at once. */
int main (int argc, char **argv)
{
    request w = { .size = 0 };
    int code = read_arguments (&w, argc, argv), e;
    if (code < 0) return fputs (usage, stdout), all_written (0);
    if (code) return code;
    FILE *f = fopen (w.input, "rb");
    if (!f) {
        fprintf (stderr, "perigal-mesh: %s: cannot be read\n", w.input);
        return 1;
    }
    fclose (f);
    f = fopen (w.output, "rb");
    int there = f != NULL;
    if (f) fclose (f);
    f = fopen (w.output, "ab");
    if (!f) {
        fprintf (stderr, "perigal-mesh: %s: cannot be written\n", w.output);
        return 1;
    }
    fclose (f);
    start ();
    gmshOpen (w.input, &e);
    code = e ? failed ("cannot be opened", w.input) : make_mesh (&w) || write_mesh (&w);
    gmshFinalize (&e);
    if (code && !there) remove (w.output);
    return all_written (code || look_at (&w));
}

/* SPDX-License-Identifier: GPL-3.0-or-later
 * The help of each command: synopsis and options, at most 100 columns wide. Shown by `perigal help COMMAND`,
 * by --help, and after a command line that could not be understood; .ci/man makes the man page of it. */
#include "cli.h"
#include <string.h>

static const char run[] =
    "perigal run SCENE.yaml [-o DIR] [--resume | --force] [--threads N] [--memory SIZE]\n"
    "            [--plain] [--set KEY=VALUE]... [--seeds N [-j N]] [--quiet]\n"
    "  Solves a scene and writes a result folder.\n"
    "  -o, --out DIR        result folder, created if needed; default: out/NAME, where NAME is that of\n"
    "                       the scene's folder or file\n"
    "      --resume         continue an interrupted run from DIR/checkpoint.nc, with the same scene and\n"
    "                       --set\n"
    "      --force          start anew in a folder with an interrupted run; its checkpoint and rows are\n"
    "                       lost\n"
    "      --threads N      0 (the default): OMP_NUM_THREADS, or one per processor\n"
    "      --memory SIZE    limit, such as 8GB; default: what the machine has free. A run that needs more\n"
    "                       is refused before it starts\n"
    "      --plain          without the shortcuts that spare work (solver.plain: on): slower, same answer\n"
    "  -s, --set KEY=VALUE  replace or add a value of the scene, such as method.horizon='2.5 spacing'\n"
    "      --seeds N        N runs with the seeds 1 to N for random fields, random cracks and perturb, in\n"
    "                       DIR/seed_1 ..., -j N of them at a time (--jobs, default 1); DIR/seeds.csv\n"
    "                       and seeds.png (histogram) have the peak loads. Called again it goes on\n"
    "  -q, --quiet          no progress and no summary; warnings are in DIR/report.json\n"
    "  Ctrl-C (SIGINT, SIGTERM, SIGHUP, SIGUSR1) writes a checkpoint after the current break round and\n"
    "  stops; a second one, half a second later or more, stops at once.\n";

static const char check[] =
    "perigal check SCENE.yaml [--json] [--solve] [--spectrum [-o DIR]] [--memory SIZE]\n"
    "              [--echo] [--matrix DIR] [--ranks N] [--set KEY=VALUE]... [--quiet]\n"
    "  Reports all faults of a scene with line and column; of a valid scene, what a run would do: points,\n"
    "  bonds, unknowns, memory, material constants, time steps, and what it will skip.\n"
    "      --solve          solve once at load factor 1: at which load the first bond breaks, and where;\n"
    "                       the stable time step\n"
    "      --spectrum       plane waves of the lattice: whether every motion is resisted, how fast long\n"
    "                       waves are, which time step is stable; with -o DIR also DIR/spectrum.csv and\n"
    "                       spectrum.png, the frequencies along the edges of the Brillouin zone\n"
    "      --json           the same as JSON\n"
    "      --echo           instead of all that: the scene itself as JSON, with --set applied\n"
    "      --matrix DIR     also the linear system at load factor 1 as Matrix Market files: DIR/K.mtx,\n"
    "                       f.mtx, T.mtx, g.mtx, N.mtx and points.csv: d = T q + g, (T' K T) q =\n"
    "                       T' (f - K g), displacement of the points N d\n"
    "      --ranks N        instead of all that: what N processes (mpirun -n N perigal-mpi run) would do:\n"
    "                       points and ghosts of each, memory, messages; or why they cannot. None of them\n"
    "                       is started\n"
    "      --memory SIZE    limit, such as 8GB; default: what the machine has free. A scene that needs\n"
    "                       more is refused\n";

static const char plot[] =
    "perigal plot DIR [--field damage|stress.yy|displacement.x ...] [--step N|all | --steps N,N,...]\n"
    "             [--view SIDE|iso|crack] [--section CUT] [--movie [--rate N]] ...\n"
    "perigal plot SCENE.yaml [--field material|youngs_modulus|...] [--out FILE]\n"
    "perigal plot DIR [DIR...] --curve X Y [--labels A,B,...] [--negate [x|y|xy]] [--out FILE]\n"
    "  Draws a field of DIR/result.e (by default damage at the last step), or two columns of\n"
    "  DIR/history.csv, as PNG or SVG; with --movie all steps as an animated PNG; or the body of a scene\n"
    "  before it runs. All options: perigal plot --help.\n";

static const char cracks[] =
    "perigal cracks SCENE.yaml [-o FILE.png] [--csv FILE.csv] [--set KEY=VALUE]... [--quiet]\n"
    "  The cracks of a scene alone, given or random: number, lengths, directions, distances. Computes\n"
    "  nothing: try seeds with --set 'cracks[0].random.seed=7'.\n"
    "  -o, --out FILE       a picture, PNG or SVG\n"
    "      --csv FILE       a table of the cracks, which cracks: [{file: FILE.csv}] reads back bit by bit;\n"
    "                       where kinds are mixed further tables are called FILE_polygon.csv ...\n";

static const char compare[] =
    "perigal compare DIR [REFERENCE] [--step N] [--field NAME] [--unit mm] [--shift X,Y,Z] [--scale S]\n"
    "                [--out FILE.png] [--json] [--quiet]\n"
    "  Norms of the difference between the result in DIR and a reference: that of its scene, or\n"
    "  REFERENCE, which may be a table (.csv with columns such as x [mm], y [mm], u_x [mm], s_xx [MPa]),\n"
    "  another result folder or a finite element result (CalculiX .frd, Exodus). Writes DIR/compare.csv,\n"
    "  compare.json, compare.png.\n"
    "      --step N         step of DIR/result.e, by default the last;  --reference-step N: of the\n"
    "                       reference\n"
    "      --field NAME     shown in the picture: displacement, stress, displacement.x, stress.xx ...\n"
    "      --unit mm        length unit of a finite element result, and of columns of a table without a\n"
    "                       unit\n"
    "      --shift X,Y,Z    move the reference, in m unless a unit is given;  --scale S: multiply its\n"
    "                       values\n";

static const char bench[] =
    "perigal bench [SCENE.yaml]... [--approximation A,B] [--integration A,B] [--basis A,B]\n"
    "              [--spacing A,B] [--perturb 0,0.2] ...\n"
    "  Runs every combination, each in its own process, and measures it against the reference of the\n"
    "  scene. Writes DIR/bench.csv, time_error.png, dofs_error.png. A list that is not given stands for\n"
    "  the whole catalogue; without --spacing: twice, once and half the spacing of the scene.\n"
    "      --force, --approximation, --integration, --basis LIST\n"
    "                       entries of the catalogues (perigal list)\n"
    "      --spacing, --horizon, --perturb, --cells LIST\n"
    "                       such as --spacing '1 mm,0.5 mm' or --horizon 2,2.5 (in spacings)\n"
    "      --fem            also solve the same bodies with CalculiX (ccx, one thread); --fem-element\n"
    "                       CPS4,CPS8 and --fem-size 8,16,32 choose elements and sizes\n"
    "      --mesh-size LIST sizes of scenes on a mesh of data/calculix/make_mesh.py, such as\n"
    "                       data/kirsch_mesh; default: those of --fem-size, or 8,16,32\n"
    "      --repeat N       run everything N times, one after the other; bench.csv then holds the least,\n"
    "                       the median and the largest CPU seconds, and the least are drawn\n"
    "      --threads N      per run, default 1\n"
    "  -o, --out DIR        default out/bench\n"
    "  -s, --set KEY=VALUE  for every run\n"
    "  -q, --quiet          print nothing\n";

static const char converge[] =
    "perigal converge SCENE.yaml [--spacing 4] [--ratio 2] [--horizon 2,2.5,3] [--delta | --m] [-o DIR]\n"
    "                 [--set KEY=VALUE]... [--threads N]\n"
    "  Runs a scene at decreasing spacings and finds, for every number that it gives (errors, reactions,\n"
    "  displacements, gauges, averages, energies), the order of convergence, Richardson's value and the\n"
    "  estimated error. Writes DIR/convergence.csv, convergence.png.\n"
    "      --spacing N      how many spacings: the scene's own and N - 1 smaller ones; default 4 (3 with\n"
    "                       --m)\n"
    "      --ratio R        of one spacing to the next, default 2\n"
    "      --horizon LIST   horizons in spacings, one study each; default: that of the scene\n"
    "      --delta          keep horizon / spacing constant, so that both go to 0 (the default)\n"
    "      --m              keep the horizon of the first spacing, so that the number of neighbours grows\n"
    "  -o, --out DIR        default out/converge\n"
    "  -q, --quiet          print nothing\n";

static const char sweep[] =
    "perigal sweep SCENE.yaml --set KEY=A,B,C [--set KEY=FROM:STEP:TO]... [--zip] [-j N] [-o DIR]\n"
    "              [--resume] [--quantity NAME,NAME...] [--threads N] [--memory SIZE] [--quiet]\n"
    "  Runs a scene with all combinations of the values given, each in a folder of its own with a readable\n"
    "  name, after all of them have passed `perigal check`. Writes DIR/sweep.csv, a row a run, renewed\n"
    "  after every run, and DIR/sweep.png: the first quantity over the key with most values, a histogram\n"
    "  for seeds and words. A run that fails does not end the sweep; its row says why.\n"
    "  -s, --set KEY=A,B,C  values of a key: a list, or a range FROM:TO, FROM:STEP:TO, with a unit behind:\n"
    "                       --set spacing='1:0.5:3 mm'; with one value: for every run. Commas inside\n"
    "                       brackets and quotes do not divide\n"
    "      --zip            the first values of all keys together, the second ones ...: no combinations\n"
    "  -j, --jobs N         so many runs at a time, default 1; they share processors and memory\n"
    "      --resume         go on in a folder with a sweep: finished runs are kept, interrupted ones\n"
    "                       continued, failed ones begun anew. Values and quantities may be added\n"
    "      --quantity LIST  columns of the table, the first one for the picture: peak, displacement,\n"
    "                       load_factor (at the peak), energy_strain, energy_kinetic, energy_external,\n"
    "                       energy_damping, energy_dissipated, broken, events, steps, crack_length,\n"
    "                       fragments, points, dofs, memory, seconds; or a column of history.csv:\n"
    "                       top.force_y (its last value), top.force_y:max, :min, :first, :peak (at the\n"
    "                       peak). Default: peak to energy_dissipated, broken, events, and gauges\n"
    "      --threads N      of each run; default: the processors divided by the jobs\n"
    "      --memory SIZE    limit of each run; default: what is free divided by the jobs\n"
    "  -o, --out DIR        default out/sweep\n"
    "  -q, --quiet          print nothing\n"
    "  Ctrl-C lets the runs write checkpoints and leaves table and pictures of what there is; a second one\n"
    "  stops at once.\n";

static const char new[] =
    "perigal new KIND [-o DIR]\n"
    "  Writes a commented scene that runs, DIR/scene.yaml, with the files that it names; never over other\n"
    "  files. Kinds: beam (notched, in bending), plate (with a hole), disk (Brazilian test with a crack),\n"
    "  mesh (a body from a mesh), explicit (a crack that branches), cloud (a body of points of a file).\n"
    "  -o, --out DIR        default: KIND\n";

static const char list[] = "perigal list\n"
                           "  The methods, kernels, criteria and solvers of this build, one line each.\n";

static const char help[] =
    "perigal help [KEY | COMMAND | --manual | --schema]\n"
    "  Explains one key of the scene file or one command; without an argument lists all keys; --manual\n"
    "  writes all keys as Markdown, --schema as a JSON schema, by which editors complete and check scenes.\n";

/* The commands in the order of the man page. */
static const struct { const char *name, *text; } usages[] = {
    { "run", run },         { "check", check }, { "plot", plot },         { "cracks", cracks },
    { "compare", compare }, { "bench", bench }, { "converge", converge }, { "sweep", sweep },
    { "new", new },         { "list", list },   { "help", help },
};

/* Prints the usage of a command; 0 for other words, so that help can go on with keys of the
 * scene. */
int command_usage (FILE *to, const char *name)
{
    for (size_t k = 0; k < sizeof usages / sizeof *usages; k++)
        if (strcmp (usages[k].name, name) == 0) return fputs (usages[k].text, to) >= 0;
    return 0;
}

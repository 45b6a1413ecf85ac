"""The group of bench/run that measures several ranks (doc/scale.md): steps and equilibria of perigal-mpi on one and two ranks, beside threads of
the plain program, LAMMPS, PETSc alone and transforms over all ranks; and a model of time and memory, checked against that.
"""
import csv
import io
import math
import os
import re
import shutil
import tempfile

from measured import Failure, command, short, spread, table

BLOCK, REST = "bench/ranks/block.yaml", "bench/ranks/rest.yaml"
STEPS = 40
# no partial volumes, as LAMMPS' package PERI has no bonds beyond the horizon either
BONDS = ["spacing=1.25 mm", "method.partial_volume=none", "solver.time_steps=%d" % STEPS]
HALF = ["body=[{add: {box: {low: [0, 0, 0], high: [50 mm, 100 mm, 100 mm]}}}]"]
REACH = 4                                               # layers of ghosts: ceil (3.015)
# numbers a network is expected to do: a message, s; bytes a second
LATENCY, BANDWIDTH = 2e-6, 10e9


def step_ms(reports):
    """Wall ms of a time step: forces, half kicks and messages."""
    return [1e3 * (r["seconds"]["force"] + r["seconds"]["solve"]) / STEPS for r in reports]


def share(report):
    s = report["seconds"]
    return "%.0f %%" % (100 * s["messages"] / s["total"]) if "messages" in s else "-"


def megabytes(report):
    return "%.0f" % (report["peak_bytes"] * 1e-6)


def words(ranks):
    return "%d rank%s" % (ranks, "s" * (ranks > 1))


def per_bond(ms, bonds):
    return spread([1e6 * v / bonds for v in ms])


def turns(bench, rows, usual):
    """rows: (name, ranks or 0 for the plain program, threads, scene, settings), in turn; reports of each by name."""
    found = {row[0]: [] for row in rows}
    for _ in range(bench.times(usual)):
        for name, ranks, threads, scene, settings in rows:
            found[name].append(bench.run("scale", scene, settings, ranks, threads))
    return found


# ---- explicit ----------------------------------------------------------------------------------------------------------
def lammps(bench, ranks, count=80, steps=10):
    """ns a bond and step, and bonds."""
    with tempfile.TemporaryDirectory() as folder:
        step = 1.25e-3
        run = [*bench.mpirun(ranks), os.environ.get("LAMMPS", "lmp"), "-in", "bench/lammps/block.in", "-log", "none"]
        for name, value in (("dim", 3), ("count", count), ("step", step), ("horizon", 3.015 * step), ("c", 1e22), ("rho", 8000),
                            ("dt", 8e-8), ("velocity", 1), ("wave", 40), ("steps", steps), ("final", folder + "/final")):
            run += ["-var", name, "%s" % value]
        text, _, _ = bench.output(run)
    bonds = float(re.search(r"total # of bonds = (\S+)", text).group(1))
    return 1e9 * float(re.search(r"Loop time of (\S+)", text).group(1)) / steps / bonds, bonds


def explicit(bench):
    finite = ["method.stretch=finite"]
    rows = [("1 rank, half the block", 1, 1, BLOCK, BONDS + HALF), ("1 rank", 1, 1, BLOCK, BONDS), ("2 ranks", 2, 1, BLOCK, BONDS),
            ("4 ranks on two cores", 4, 1, BLOCK, BONDS), ("1 thread", 0, 1, BLOCK, BONDS), ("2 threads", 0, 2, BLOCK, BONDS),
            ("1 rank, finite stretch", 1, 1, BLOCK, BONDS + finite), ("2 ranks, finite stretch", 2, 1, BLOCK, BONDS + finite)]
    found = turns(bench, rows, 2)
    longer = turns(bench, [(*row[:4], row[4] + ["solver.time_steps=%d" % (6 * STEPS)]) for row in rows[:6]], 1)
    lines, cpu = [], {}
    for name, _, _, _, _ in rows:
        reports, r = found[name], found[name][0]
        ms = step_ms(reports)
        if name in longer:
            cpu[name] = 1e3 * (longer[name][0]["cpu"] - min(x["cpu"] for x in reports)) / (5 * STEPS)
        lines.append([name, "%d" % r["points"], spread(ms), per_bond(ms, r["bonds"]), short(cpu.get(name)), share(r), spread([x["cpu"] for x in reports]),
                      megabytes(r)])
    if shutil.which(os.environ.get("LAMMPS", "lmp")):
        for ranks in (1, 2):
            times = [lammps(bench, ranks) for _ in range(bench.times(2))]
            ns = [t for t, _ in times]
            ms = [t * times[0][1] * 1e-6 for t in ns]
            lines.append(["LAMMPS, " + words(ranks), "%d" % 80 ** 3, spread(ms), spread(ns), "-", "-", "-", "-"])
    text = table(["a block by bonds", "points", "ms a step", "ns a bond and step", "CPU ms a step, all ranks", "messages, share of the run",
                  "CPU s of the run", "MB a rank"], lines)
    least = {name: min(step_ms(reports)) for name, reports in found.items()}
    half = "1 rank, half the block"
    text += table(["ratio of a step", "by least ms", "by CPU"], [
        ["two threads over two ranks (aim 0.9)", short(least["2 threads"] / least["2 ranks"]), short(cpu["2 threads"] / cpu["2 ranks"])],
        ["one thread over one rank", short(least["1 thread"] / least["1 rank"]), short(cpu["1 thread"] / cpu["1 rank"])],
        ["strong scaling: one rank over two ranks, of 2", short(least["1 rank"] / least["2 ranks"]), short(2 * cpu["1 rank"] / cpu["2 ranks"])],
        ["weak scaling: one rank with half the block over two with all, of 1", short(least[half] / least["2 ranks"]),
         short(2 * cpu[half] / cpu["2 ranks"])]])
    return text + model(found["1 rank"][0], cpu["1 rank"], found["2 ranks"][0], cpu["2 ranks"] / 2)


# ---- the model ---------------------------------------------------------------------------------------------------------
def held(edges, cut):
    """Points that a rank holds of its box: ghosts behind so many of its faces along each axis."""
    return math.prod(e + c * REACH for e, c in zip(edges, cut))


def predict(own, cut, second, byte):
    """Of a rank: points held, ms a step, MB; second, byte: a point held. Messages of displacements, 24 bytes a point."""
    points, inside = held(own, cut), math.prod(own)
    neighbours = 3 ** sum(c > 0 for c in cut) - 1 if max(cut) > 1 else sum(cut)
    return points, 1e3 * (points * second + neighbours * LATENCY + 24 * (points - inside) / BANDWIDTH), 1e-6 * points * byte


def model(one, ms_one, two, ms_two):
    """Time (CPU, which a busy machine changes least) and memory of a point come from one rank; two ranks are predicted, and what
    nobody here can measure."""
    base = 40e6                                         # MPI and PETSc, before anything is made
    second, byte = 1e-3 * ms_one / one["points"], (one["peak_bytes"] - base) / one["points"]
    lines = []
    half, cube = (1, 0, 0), (2, 2, 2)
    for name, own, cut, seen in (("2 ranks, measured beside", (40, 80, 80), half, (ms_two, two["peak_bytes"] * 1e-6)),
                                 ("8e6 points, 2 ranks", (100, 200, 200), half, None),
                                 ("1e8 points, 1000 ranks", (46.4, 46.4, 46.4), cube, None),
                                 ("1e9 points, 1000 ranks", (100, 100, 100), cube, None)):
        points, ms, size = predict(own, cut, second, byte)
        lines.append([name, "%.0f" % math.prod(own), short(points / math.prod(own)), short(ms), short(seen[0]) if seen else "-",
                      "%.0f" % (size + base * 1e-6), "%.0f" % seen[1] if seen else "-"])
    return table(["model", "points a rank owns", "held over owned", "ms a step", "measured", "MB a rank", "measured"], lines)


# ---- transforms --------------------------------------------------------------------------------------------------------
def transforms(bench):
    """FCBM by transforms of each rank's own points, and what transforms over all ranks take alone."""
    settings = BONDS + ["method.force=fcbm"]
    found = turns(bench, [("1", 1, 1, BLOCK, settings), ("2", 2, 1, BLOCK, settings)], 2)
    lines = []
    for ranks in (1, 2):
        force = [1e3 * r["seconds"]["force"] / STEPS for r in found[str(ranks)]]
        text, _, _ = bench.output([*bench.mpirun(ranks), bench.build + "/bench/ranks/slabs", "84", "20"])
        row = list(csv.DictReader(io.StringIO(text)))[0]
        lines.append(["%d" % ranks, spread(force), "%s, %s" % (short(float(row["least_ms"])), short(float(row["median_ms"])))])
    return table(["ranks", "fcbm: ms a sum of forces", "FFTW-MPI, six transforms of 84^3 alone: ms, least, median"], lines)


# ---- at rest -----------------------------------------------------------------------------------------------------------
def gamg(bench, spacing, ranks):
    with tempfile.TemporaryDirectory() as folder:
        bench.output([bench.build + "/perigal", "check", REST, "--set", "spacing=" + spacing, "--matrix", folder])
        text, _, _ = bench.output([*bench.mpirun(ranks), bench.build + "/bench/ranks/gamg", folder, "1e-10"])
    return list(csv.DictReader(io.StringIO(text)))[0]


def rest(bench):
    lines = []
    for spacing in ("4 mm", "2.5 mm", "1.6666666666666667 mm"):
        settings = ["spacing=" + spacing]
        rows = [("1 rank", 1, 1, REST, settings), ("2 ranks", 2, 1, REST, settings), ("2 threads", 0, 2, REST, settings)]
        found = turns(bench, rows, 1)
        for name, _, _, _, _ in rows:
            r = found[name][0]
            s = r["seconds"]
            lines.append([name, "%d" % r["dofs"], "%d" % r["cg_iterations"], short(s["factor"] + s["assemble"]), short(s["solve"]), share(r),
                          short(r["cpu"]), megabytes(r)])
        if spacing == "1.6666666666666667 mm":
            continue
        for ranks in (1, 2):
            row = gamg(bench, spacing, ranks)
            lines.append(["PETSc alone, " + words(ranks), row["unknowns"], row["iterations"], short(float(row["set_up_s"])),
                          short(float(row["solve_s"])), "-", "-", "-"])
    head = ["a block at rest", "unknowns", "iterations", "preconditioner s", "solve s", "messages", "CPU s of the run", "MB a rank"]
    return table(head, lines)


def ranks_(bench):
    if not shutil.which("mpirun") or not os.path.exists(bench.build + "/perigal-mpi"):
        raise Failure("ranks need perigal-mpi (packages petsc-dev mpi-default-dev mpi-default-bin)")
    return command("make bench T=ranks") + explicit(bench) + transforms(bench) + rest(bench)


GROUPS = {"ranks": (ranks_, 1, "one and two ranks of perigal-mpi, threads, LAMMPS and PETSc beside (doc/scale.md)")}

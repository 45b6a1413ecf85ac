"""Groups of bench/run that measure what shortcuts are worth: start of the program, solves in space, events, implicit and
explicit motion, each beside the same run with solver.plain, which takes none of them; and the profile of six scenes for
doc/performance.md, beside an older build where PERIGAL_BENCH_BEFORE names the folder of its program.
"""
import os
import random
import shutil
import subprocess

from measured import command, short, spread, table

QUIET = ["output.pictures=[]"]


def cpu(reports):
    return spread([r["cpu"] for r in reports])


def least(reports):
    return min(r["cpu"] for r in reports)


def megabytes(report):
    return "%.0f" % (report["peak_bytes"] * 1e-6)


def beside_plain(bench, group, cases, usual):
    """cases: (name, scene, settings, plain too): a line for each, and the ratio to the plain run where there is one."""
    rows = []
    for name, scene, settings, plain in cases:
        rows.append((name, scene, settings))
        if plain:
            rows.append((name + ", plain", scene, [*settings, "solver.plain=true"]))
    found = {name: reports for (name, _, _), reports in zip(rows, bench.runs(group, rows, usual))}
    lines = []
    for name, _, _, plain in cases:
        ours, other = found[name], found.get(name + ", plain")
        r = ours[0]
        lines.append([name, "%d" % r["points"], "%d" % r["dofs"], "%d" % r["steps"], "%d" % r["broken"], cpu(ours), cpu(other) if plain else "-",
                      short(least(other) / least(ours)) if plain else "-", megabytes(r)])
    return command("make bench T=" + group) + table(
        ["run", "points", "unknowns", "steps", "bonds broken", "CPU s", "plain, CPU s", "ratio", "peak MB"], lines)


# ---- groups ----------------------------------------------------------------------------------------------------------
def start(bench):
    """What a user pays before anything is computed."""
    bare = {k: v for k, v in os.environ.items() if not k.startswith(("OMP_", "OPENBLAS_", "PERIGAL_"))}
    tiny = ["run", "data/textbook_patch/scene.yaml", "-q", "--force", "-o", "out/bench/start"]
    ways = [("`perigal help`", ["help"]), ("`perigal check` of a patch test", ["check", "data/textbook_patch/scene.yaml"]),
            ("run of the patch test, no pictures", [*tiny, "--set", "output.pictures=[]"]), ("run of the patch test, with pictures", tiny)]
    seconds, inside = [[] for _ in ways], bench.environment
    bench.environment = bare
    for _ in range(bench.times(9)):
        for k, (_, words) in enumerate(ways):
            seconds[k].append(bench.output([bench.build + "/perigal", *words])[1])
    bench.environment = inside
    shutil.rmtree("out/bench/start", ignore_errors=True)
    return command("make bench T=start") + table(["command", "CPU s"], [[name, spread(s)] for (name, _), s in zip(ways, seconds)])


def block(side, plain):
    """Pure bending of a block with so many steps across its height."""
    return ("block, %d steps high" % side, "data/bending_3d/scene.yaml", QUIET + ["spacing=%.17g" % (1 / side)], plain)


def solved(bench, group, cases, usual):
    """Solves in space: iterations, and the seconds of the solve alone."""
    rows = [(name, scene, settings + (["solver.plain=true"] if plain else [])) for name, scene, settings, plain in cases]
    lines = []
    for (name, _, _), (_, _, _, plain), reports in zip(rows, cases, bench.runs(group, rows, usual)):
        r = reports[0]
        lines.append([name + (", plain" if plain else ""), "%d" % r["points"], "%d" % r["dofs"], "%d" % r["cg_iterations"] if r["cg_iterations"] else "-",
                      spread([x["seconds"]["analyse"] + x["seconds"]["factor"] for x in reports]), spread([x["seconds"]["solve"] for x in reports]),
                      cpu(reports), megabytes(r)])
    return command("make bench T=" + group) + table(
        ["run", "points", "unknowns", "iterations", "factorization or preconditioner s", "solve s", "CPU s of the run", "peak MB"], lines)


def solve_3d(bench):
    return solved(bench, "solve_3d", [block(7, 0), block(7, 1), block(10, 0), block(10, 1), block(15, 0), block(20, 0)], 3)


def solve_large(bench):
    return solved(bench, "solve_large", [block(28, 0), block(43, 0)], 3)


CUBE = """title: Cube, held at the bottom, pulled and sheared at the top
dimension: 3
body:
  - add: {box: {low: [0, 0, 0], high: [1, 1, 1]}}
%s
spacing: %.17g
materials: {m: {youngs_modulus: 10 GPa, poissons_ratio: 0.2}}
method: {approximation: rkpm, integration: gauss, kernel: cubic_spline, horizon: 2.0 spacing}
%sboundary:
  - {name: bottom, set: bottom, displacement: {x: 0, y: 0, z: 0}}
  - {name: top, set: top, traction: {y: 1 MPa, x: 0.3 MPa}}
solver: {kind: static, stepping: fixed, steps: 1, linear: pcg}
output: {at: {levels: 1}, pictures: []}
"""
CRACK = "cracks:\n  - disc: {center: [0.5, 0.5, 0.5], normal: [0.3, 1, 0.2], radius: 0.3}\n"
HOLE = "  - subtract: {sphere: {center: [0.5, 0.5, 0.5], radius: 0.27}}"
MOVED = "perturb={amount: 0.3, seed: 1}"
# what is varied: body, crack, settings; each at the two sizes
VARIED = [
    ("cube", "", "", []), ("points moved by 0.3 spacings", "", "", [MOVED]), ("penny crack", "", CRACK, []), ("penny crack, points moved", "", CRACK, [MOVED]),
    ("spherical hole, cut cells", HOLE, "", []), ("spherical hole, staircase", HOLE, "", ["cells=staircase"]),
    ("Poisson's ratio 0.4", "", "", ["materials.m.poissons_ratio=0.4"]), ("0.45", "", "", ["materials.m.poissons_ratio=0.45"]),
    ("0.49", "", "", ["materials.m.poissons_ratio=0.49"]),
    ("horizon 1.5 spacings", "", "", ["method.horizon=1.5 spacing"]), ("2.5 spacings", "", "", ["method.horizon=2.5 spacing"]),
    ("quadratic basis, 2.5 spacings", "", "", ["method.basis=quadratic", "method.horizon=2.5 spacing"]),
    ("penalty", "", "", ["method.essential=penalty"]), ("elimination", "", "", ["method.essential=transformation"]),
    ("consistent integration", "", "", ["method.integration=consistent"]), ("nodal integration", "", "", ["method.integration=nodal"]),
    ("NOSB, nodal", "", "", ["method.approximation=nosb", "method.integration=nodal"]),
    ("NOSB, nodal, penny crack", "", CRACK, ["method.approximation=nosb", "method.integration=nodal"]), ("PDDO", "", "", ["method.approximation=pddo"]),
]


def iterations(bench):
    """Iterations with finite elements as preconditioner, over what makes them more; a tolerance of 1e-9."""
    lines = []
    for side in (16, 24):
        for number, (name, body, crack, settings) in enumerate(VARIED):
            scene = "out/bench/cube_%d_%d.yaml" % (side, number)
            os.makedirs("out/bench", exist_ok=True)
            with open(scene, "w") as out:
                out.write(CUBE % (body, 1 / side, crack))
            r = bench.run("iterations", scene, settings)
            if side == 16:
                lines.append([name, "%d" % r["dofs"], "%d" % r["cg_iterations"], r["preconditioner"].split(",")[0], "", ""])
            else:
                lines[number][4:] = ["%d" % r["dofs"], "%d" % r["cg_iterations"]]
    return command("make bench T=iterations") + table(["cube", "unknowns", "iterations", "preconditioner", "unknowns", "iterations"], lines)


BOX_GEO = """SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 1, 1, 1};
Physical Volume("body") = {1};
"""
MESHED = """title: Cube of tetrahedra, held at the bottom, pulled and sheared at the top
dimension: 3
mesh: {file: %s}
materials: {m: {youngs_modulus: 10 GPa, poissons_ratio: 0.2}}
method: {approximation: rkpm, integration: gauss, kernel: cubic_spline, horizon: 2.0 spacing}
boundary:
  - {name: bottom, set: bottom, displacement: {x: 0, y: 0, z: 0}}
  - {name: top, set: top, traction: {y: 1 MPa, x: 0.3 MPa}}
solver: {kind: static, stepping: fixed, steps: 1, linear: pcg}
output: {at: {levels: 1}, pictures: []}
"""


def tetrahedra(bench):
    """Cubes meshed by Gmsh: iterations with finite elements as preconditioner, and the run by the diagonal and by a factor."""
    if not shutil.which("gmsh"):
        return ["No Gmsh on this machine: not measured.", ""]
    ways = [("finite elements", []), ("diagonal", ["solver.preconditioner=jacobi"]), ("factor", ["solver.linear=cholmod"])]
    os.makedirs("out/bench", exist_ok=True)
    with open("out/bench/box.geo", "w") as out:
        out.write(BOX_GEO)
    lines = []
    for order, title, sizes in ((1, "tetrahedra", (0.0895, 0.0605, 0.0385)), (2, "of second order", (0.178, 0.12, 0.0775))):
        for number, size in enumerate(sizes):
            mesh, scene = "box_%d_%d.msh" % (order, number), "out/bench/box_%d_%d.yaml" % (order, number)
            subprocess.run(["gmsh", "-v", "0", "-3", "-order", str(order), "-clmin", str(size), "-clmax", str(size), "-format", "msh41",
                            "-o", "out/bench/" + mesh, "out/bench/box.geo"], check=True)
            with open(scene, "w") as out:
                out.write(MESHED % mesh)
            for way, settings in ways if number < 2 else ways[:1]:
                r = bench.run("tetrahedra", scene, settings)
                lines.append([title, "%d" % r["dofs"], way, "%d" % r["cg_iterations"] if r["cg_iterations"] else "-", short(r["cpu"]), megabytes(r)])
    return command("make bench T=tetrahedra") + table(["cube", "unknowns", "solved by", "iterations", "CPU s of the run", "peak MB"], lines)


CLOUD = """title: Cube of points without cells, held at the bottom, pulled and sheared at the top
dimension: 3
points: %s
materials: {m: {youngs_modulus: 10 GPa, poissons_ratio: 0.2}}
method: {approximation: rkpm, integration: nodal, kernel: cubic_spline, horizon: 2.0 spacing}
sets:
  up: {where: "y > %.9g"}
  down: {where: "y < %.9g"}
boundary:
  - {name: bottom, set: down, displacement: {x: 0, y: 0, z: 0}}
  - {name: top, set: up, force: {y: 1 MN, x: 0.3 MN}}
solver: {kind: static, stepping: fixed, steps: 1, linear: pcg}
output: {at: {levels: 1}, pictures: []}
"""


def moved_points(side, draw):
    """Centres of the cells of a lattice, moved by up to 0.3 spacings along each axis."""
    return [tuple((i + 0.5 + draw.uniform(-0.3, 0.3)) / side for i in (x, y, z)) for x in range(side) for y in range(side) for z in range(side)]


def random_points(side, draw):
    """Points one after the other at random places, none nearer to another than 0.86 spacings."""
    apart, out, near = 0.86 / side, [], {}
    around = [(a, b, c) for a in (-1, 0, 1) for b in (-1, 0, 1) for c in (-1, 0, 1)]
    while len(out) < side**3:
        p = (draw.random(), draw.random(), draw.random())
        cell = tuple(int(v / apart) for v in p)
        others = [q for a in around for q in near.get(tuple(map(sum, zip(cell, a))), ())]
        if all(sum((s - t)**2 for s, t in zip(p, q)) >= apart**2 for q in others):
            near.setdefault(cell, []).append(p)
            out.append(p)
    return out


def clouds(bench):
    """Points of a file without cells: iterations and seconds by elements on a coarse grid, and by the diagonal."""
    lines = []
    os.makedirs("out/bench", exist_ok=True)
    for title, make in (("lattice, moved by 0.3", moved_points), ("random", random_points)):
        for side in (12, 17, 25):
            name = "cloud_%s_%d" % (title.split(",")[0], side)
            points = make(side, random.Random(1))
            with open("out/bench/%s.csv" % name, "w") as out:
                out.write("x,y,z,volume\n" + "".join("%.9g,%.9g,%.9g,%.9g\n" % (*p, 1 / len(points)) for p in points))
            with open("out/bench/%s.yaml" % name, "w") as out:
                out.write(CLOUD % (name + ".csv", 1 - 1 / side, 1 / side))
            for way, settings in (("coarse grid", []), ("diagonal", ["solver.preconditioner=jacobi"])):
                reports = [bench.run("clouds", "out/bench/%s.yaml" % name, settings) for _ in range(bench.times(2))]
                r = min(reports, key=lambda report: report["cpu"])
                lines.append([title, "%d" % r["dofs"], way, "%d" % r["cg_iterations"], short(r["cpu"]), megabytes(r)])
    return command("make bench T=clouds") + table(["points", "unknowns", "preconditioner", "iterations", "CPU s of the run", "peak MB"], lines)


EDGE = """title: Edge crack, from intact to cut in two, bond by bond
dimension: 2
plane: stress
thickness: 1 mm
body:
  - add: {box: {low: [0, 0], high: [100 mm, 100 mm]}}
spacing: 1 mm
lattice: cells
cracks:
  - {from: [-1 mm, 50 mm], to: [30 mm, 50 mm]}
materials:
  rock: {youngs_modulus: 10 GPa, poissons_ratio: 0.25, density: 2500 kg/m3}
failure: {criterion: stretch, critical_stretch: 1e-3, exclude: [grips]}
sets:
  grips: {where: "y <= 10 mm or y >= 90 mm"}
method: {approximation: rkpm, integration: gauss, kernel: cubic_spline, horizon: 2.01 spacing, essential: nitsche}
boundary:
  - {name: top, set: top, displacement: {x: 0, y: 50 um}}
  - {name: bottom, set: bottom, displacement: {x: 0, y: -50 um}}
solver: {kind: static, stepping: event, break: worst, max_events: 1000000}
output:
  at: {levels: 1}
  pictures: []
  fields: [displacement, damage]
"""
NOTCHED = """title: Notched block in tension, bond by bond
dimension: 3
body:
  - add: {box: {low: [0, 0, 0], high: [48 mm, 20 mm, 16 mm]}}
spacing: %s mm
cracks:
  - polygon: [[24.2 mm, -1 mm, -1 mm], [24.2 mm, 7 mm, -1 mm], [24.2 mm, 7 mm, 17 mm], [24.2 mm, -1 mm, 17 mm]]
materials: {rock: {youngs_modulus: 10 GPa, poissons_ratio: 0.25}}
failure: {criterion: stretch, critical_stretch: 1e-3, exclude: [ends]}
sets:
  ends: {where: "x <= 6 mm or x >= 42 mm"}
boundary:
  - {name: left, set: left, displacement: {x: 0, y: 0, z: 0}}
  - {name: right, set: right, displacement: {x: 0.1 mm}}
solver: {kind: static, stepping: event, break: worst}
output: {at: {levels: 1}, pictures: []}
"""


def events_run(bench, name, text, settings, repeats):
    os.makedirs("out/bench", exist_ok=True)
    scene = "out/bench/%s.yaml" % name
    with open(scene, "w") as out:
        out.write(text)
    return [bench.run(name, scene, settings) for _ in range(repeats)]


def cuts(bench):
    """Seconds an event: a run with some events less one with one event, over the events between them; as events are solved
    by themselves, with a factor or with the preconditioner of before, and with a factorization each (few events, 0: none)."""
    cases = [("edge crack, 1 mm, all its events", "edge", EDGE, [], 0, 400), ("edge crack, 0.5 mm", "edge", EDGE, ["spacing=0.5 mm"], 300, 12),
             ("notched block, 2 mm", "notched", NOTCHED % 2, [], 100, 25), ("notched block, 1.1 mm", "notched", NOTCHED % 1.1, [], 60, 4),
             ("the same, by iterations", "notched", NOTCHED % 1.1, ["solver.linear=pcg"], 20, 0),
             ("notched block, 0.75 mm, by iterations", "notched", NOTCHED % 0.75, [], 12, 0)]
    lines = []
    for title, name, text, settings, many, few in cases:
        row = []
        for plain, count in ((0, many), (1, few)) if few else ((0, many),):
            more = ["solver.plain=true"] if plain else []
            first = events_run(bench, name, text, [*settings, *more, "solver.max_events=1"], 1)[0]
            last = events_run(bench, name, text, [*settings, *more, *(["solver.max_events=%d" % count] if count else [])], 1)[0]
            row.append((last, (last["cpu"] - first["cpu"]) / (last["events"] - first["events"])))
        ours, each = row[0]
        plain = row[1][1] if few else None
        made = "factors: %d" % ours["factorizations"] if ours["factorizations"] else "preconditioners: %d, iterations: %d" % (ours["preconditioners"], ours["cg_iterations"])
        lines.append([title, "%d" % ours["points"], "%d" % ours["events"], short(ours["cpu"]), made, short(1e3 * each),
                      short(1e3 * plain) if few else "-", short(plain / each) if few else "-", megabytes(ours)])
    return command("make bench T=cuts") + table(
        ["scene", "points", "events", "CPU s of the run", "made", "ms an event", "plain, ms an event", "ratio", "peak MB"], lines)


def engines(bench):
    """Events of single bonds, as they are solved by themselves and with a factorization each."""
    return beside_plain(bench, "engines", [("disk in the plane, %s mm, 200 events" % h, "data/cui_disk_plane/scene.yaml",
                                            QUIET + ["spacing=%s mm" % h, "solver.max_events=200"], 1) for h in ("4", "2", "1.25")], 3)


def newmark(bench):
    """Bonds break in the last third of the first run; the second is of a rock of a fifth of the strength, and
    ends early in its cascade."""
    quiet = QUIET + ["output.views=[]"]
    return beside_plain(bench, "newmark", [
        ("disk, crack 10 mm deep, 5 mm, to the end", "data/cui_disk_10/scene.yaml",
         quiet + ["spacing=5 mm", "sets.platens.angle=[[80 deg, 100 deg], [260 deg, 280 deg]]"], 1),
        ("the same, 2 mm, weak rock, 50 us", "data/cui_disk_10/scene.yaml",
         quiet + ["failure.tensile_strength=0.1 MPa", "failure.cohesion=1 MPa", "solver.end=50 us"], 1)], 3)


def explicit(bench):
    return beside_plain(bench, "explicit", [
        ("centre crack", "data/zhou_2/scene.yaml", [], 1), ("glass that branches", "data/glass_branching/scene.yaml", [], 1),
        ("plate with a hole, relaxed", "data/zhou_1/scene.yaml", [], 1),
        ("the same, 157 376 points", "data/zhou_1/scene.yaml", QUIET + ["spacing=0.125 mm", "method.evaluation=stencil"], 1)], 3)


# ---- profile ---------------------------------------------------------------------------------------------------------
PROFILE = [
    ("Kirsch's plate, spacing 0.125", "data/kirsch/scene.yaml", QUIET + ["spacing=0.125"]),
    ("block in bending, 15 steps high", "data/bending_3d/scene.yaml", QUIET + ["spacing=%.17g" % (1 / 15)]),
    ("disk in the plane, single bonds by events", "data/cui_disk_plane/scene.yaml", []),
    ("disk, crack 10 mm deep, 50 us by Newmark", "data/cui_disk_10/scene.yaml", QUIET + ["solver.end=50 us"]),
    ("centre crack, explicit", "data/zhou_2/scene.yaml", []),
    ("plate with a hole, relaxed", "data/zhou_1/scene.yaml", []),
]
PHASES = [("search", ["search"]), ("shapes, assembly", ["shape", "assemble", "update"]), ("factors", ["analyse", "factor"]), ("solve, motion", ["solve"]),
          ("forces", ["force"]), ("breaking", ["break"]), ("writing", ["write"])]


def profile(bench):
    """Six scenes, phase by phase; of the older build, where one is given, alternately with this one."""
    before, now = os.environ.get("PERIGAL_BENCH_BEFORE"), bench.build
    builds = [("before", before)] if before else []
    builds.append(("now", now))
    lines = []
    for number, (name, scene, settings) in enumerate(PROFILE):
        found = {which: [] for which, _ in builds}
        for _ in range(bench.times(3)):
            for which, build in builds:
                bench.build = build
                found[which].append(bench.run("profile_%d" % number, scene, settings))
        bench.build = now
        for which, _ in builds:
            best = min(found[which], key=lambda r: r["cpu"])
            seconds = best["seconds"]
            lines.append([name, which, *(short(sum(seconds.get(p) or 0 for p in parts), 2) for _, parts in PHASES), cpu(found[which]), megabytes(best)])
    return command("make bench T=profile") + table(["scene", "", *(title for title, _ in PHASES), "CPU s of the run", "peak MB"], lines)


GROUPS = {
    "start": (start, 0, "start of the program, as a user pays it"),
    "solve_3d": (solve_3d, 0, "solves in space up to 107 000 unknowns, plain ones beside"),
    "engines": (engines, 0, "events of single bonds, plain ones beside"),
    "iterations": (iterations, 0, "iterations with finite elements as preconditioner, over what makes them more"),
    "clouds": (clouds, 0, "points without cells: iterations and seconds with a coarse grid as preconditioner and without"),
    "tetrahedra": (tetrahedra, 0, "meshes of tetrahedra: iterations with finite elements as preconditioner (needs Gmsh)"),
    "cuts": (cuts, 0, "events of single bonds up to the cut, plain ones beside"),
    "newmark": (newmark, 0, "implicit motion with breaking bonds, plain beside"),
    "explicit": (explicit, 0, "explicit motion and relaxation, plain beside"),
    "profile": (profile, 0, "six scenes by phases (doc/performance.md); PERIGAL_BENCH_BEFORE: folder of an older program"),
    "solve_large": (solve_large, 1, "solves in space of 285 000 and 1 000 000 unknowns"),
}

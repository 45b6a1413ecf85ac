"""Groups of bench/run that measure what shortcuts are worth: start of the program, solves in space, events, implicit and
explicit motion, each beside the same run with solver.plain, which takes none of them; and the profile of six scenes for
doc/performance.md, beside an older build where PERIGAL_BENCH_BEFORE names the folder of its program.
"""
import os
import shutil

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


def engines(bench):
    """Events of single bonds, as they are solved by themselves and with a factorization each."""
    return beside_plain(bench, "engines", [("disk in the plane, %s mm, 200 events" % h, "data/cui_disk_plane/scene.yaml",
                                            QUIET + ["spacing=%s mm" % h, "solver.max_events=200"], 1) for h in ("4", "2", "1.25")], 3)


def newmark(bench):
    return beside_plain(bench, "newmark", [
        ("disk, crack 10 mm deep, 4 mm, 100 us", "data/cui_disk_10/scene.yaml", QUIET + ["spacing=4 mm", "solver.end=100 us"], 1),
        ("disk, crack 10 mm deep, 2 mm, 50 us", "data/cui_disk_10/scene.yaml", QUIET + ["solver.end=50 us"], 1)], 3)


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
    "newmark": (newmark, 0, "implicit motion with breaking bonds, plain beside"),
    "explicit": (explicit, 0, "explicit motion and relaxation, plain beside"),
    "profile": (profile, 0, "six scenes by phases (doc/performance.md); PERIGAL_BENCH_BEFORE: folder of an older program"),
    "solve_large": (solve_large, 1, "solves in space of 285 000 and 1 000 000 unknowns"),
}

"""What consistent integration leaves in cells that the surface of the body cuts, for bench/accuracy: rigid motions, patch tests, bodies of
known answer, strips and cantilevers of known load on lattices that lie in every way, and what it costs beside Gauss points.

The seeds and offsets here were not among those by which the constants of src/discretization/approx/widen.c were chosen.
"""
import math
import os
import re
import resource

import fracture_scenes as scenes
from measured import Failure, command, number, percent, table

SEED = 2026
OFFSETS = [(0.19, 0.71), (0.83, 0.05), (0.456, 0.912)]

CANTILEVER = """dimension: 2
plane: stress
body: [{add: {polygon: {vertices: [%s]}}}, {subtract: {disk: {center: %s, radius: 0.25}}}]
spacing: %g
lattice: %s
lattice_offset: %s
%smaterials: {a: {youngs_modulus: 1000, poissons_ratio: 0.3}}
method: {integration: %s, basis: %s}
boundary: [{name: L, set: polygon.edge 4, displacement: {x: 0, y: 0}}, {name: R, set: polygon.edge 2, traction: %s}]
output: {pictures: [], at: {levels: 1}}
solver: {kind: static}
"""
TIP = -0.40310                          # finite elements

FALL = """dimension: %d
body: [{add: {%s}}]
spacing: %g
lattice_offset: %s
%smaterials: {a: {youngs_modulus: 1e9, poissons_ratio: 0.3, density: 1000}}
method: {integration: %s}
boundary: [{name: g, set: all, body_force: {y: -10000}}]
solver: {kind: newmark, dt: 0.02, end: 1, tolerance: 1e-12, mass: consistent}
output: {pictures: [], at: {levels: 1}}
"""
BODIES = [("disk", 2, "disk: {center: [0, 0], radius: 0.5}", 0.1), ("cylinder", 3, "cylinder: {center: [0, 0, 0], axis: [0, 0, 1], length: 0.5, radius: 0.4}", 0.2),
          ("sphere", 3, "sphere: {center: [0, 0, 0], radius: 0.5}", 0.2)]


def moved(amount):
    return "perturb: {amount: %g, seed: %d}\n" % (amount, SEED) if amount else ""


class Scene:
    """Runs of scenes that are written here."""

    def __init__(self, runner, out):
        self.runner, self.out = runner, out

    def run(self, name, text):
        """(report, processor seconds)"""
        folder = self.out + "/cuts"
        os.makedirs(folder, exist_ok=True)
        path = "%s/%s.yaml" % (folder, name)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        report = self.runner.run("cuts/" + name, path, [])
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        return report, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime

    def last(self, name, column):
        """The last value of a column of history.csv, named without its unit."""
        with open("%s/cuts/%s/history.csv" % (self.out, name), encoding="utf-8") as file:
            rows = [line.strip().split(",") for line in file]
        return float(rows[-1][[head.split(" [")[0] for head in rows[0]].index(column)])


# ---- rigid motions and patch tests: test/mechanics/force/test_rigid_motion.c -----------------------------------------------------
def motions(runner):
    more = {"PERIGAL_TEST_SIZE": "long", "PERIGAL_SEED": str(SEED)}
    both = [runner.test("mechanics/force/test_rigid_motion", **more), runner.test("mechanics/force/test_rigid_motion", GAUSS="1", **more)]
    form = (r"(\d)D body (\d), (\w+), (\d+) lattices\W+translation: median (\S+), worst (\S+)\W+rotation: median (\S+), worst (\S+)"
            r"\W+patch: median (\S+), worst (\S+)")
    found = [re.findall(form, text) for text in both]
    if len(found[0]) < 14 or len(found[1]) != len(found[0]):
        raise Failure("test_rigid_motion printed other lines")
    names = {"2": ["disk", "ring", "plate with a hole", "notched disk"], "3": ["cylinder", "sphere", "bored block"]}
    lines = []
    for ours, gauss in zip(*found):
        lines.append([names[ours[0]][int(ours[1])], ours[2], ours[3],
                      *("%s, %s" % (number(float(ours[k]), 0), number(float(ours[k + 1]), 0)) for k in (4, 6, 8)),
                      *("%s, %s" % (number(float(gauss[k]), 0), number(float(gauss[k + 1]), 0)) for k in (4, 6, 8))])
    return table(["body", "basis", "lattices", "translation: median, worst", "rotation", "patch test", "Gauss points: translation", "rotation", "patch test"], lines)


# ---- bodies of known answer --------------------------------------------------------------------------------------------
def cantilever_text(turn, lattice, offset, perturb, integration, basis, spacing=0.125):
    c, s = math.cos(math.radians(turn)), math.sin(math.radians(turn))

    def at(x, y):
        return "[%.15g, %.15g]" % (x * c - y * s, x * s + y * c)

    corners = ", ".join(at(*v) for v in ((0, 0), (10, 0), (10, 1), (0, 1)))
    force = "{x: %.15g, y: %.15g}" % (0.1 * s, -0.1 * c)
    return CANTILEVER % (corners, at(9.3, 0.5), spacing, lattice, "[%g, %g]" % offset, moved(perturb), integration, basis, force)


def cantilever(scene):
    """The work of the load is force times the mean displacement of the loaded edge."""
    cases = [("aligned", 0, "nodes", (0, 0), 0), *(("shifted %g, %g" % o, 0, "cells", o, 0) for o in OFFSETS),
             ("turned 17", 17, "cells", OFFSETS[0], 0), ("turned 38", 38, "cells", OFFSETS[1], 0), ("moved .2", 0, "nodes", (0, 0), 0.2)]
    lines = []
    for name, turn, lattice, offset, perturb in cases:
        line, cost = [name], []
        for integration, basis in (("consistent", "linear"), ("gauss", "linear"), ("consistent", "quadratic")):
            where = "cantilever_%s_%s_%s" % (name.replace(" ", "_").replace(",", ""), integration, basis)
            report, seconds = scene.run(where, cantilever_text(turn, lattice, offset, perturb, integration, basis))
            tip = -2 * report["energy"]["external"] / 0.1
            line += ["%.4f" % tip, percent(tip / TIP - 1)]
            if integration == "consistent":
                balance = report["balance"]
                line += [number(max(balance["forces"], balance["moments"]), 0)]
            cost.append(seconds)
        lines.append(line + ["%.2f" % (cost[0] / cost[1]), "%.2f" % (cost[2] / cost[1])])
    return table(["lattice", "deflection", "off", "balance", "Gauss points", "off", "quadratic", "off", "balance", "cost, consistent over Gauss",
                  "the same, quadratic"], lines)


def fall(scene):
    lines = []
    for name, dim, body, spacing in BODIES:
        for offset in ((0, 0, 0), OFFSETS[0] + (0.37,), OFFSETS[2] + (0.64,)):
            line = ["%s, offset %s" % (name, ", ".join("%g" % v for v in offset[:dim]))]
            for integration in ("consistent", "gauss"):
                where = "fall_%s_%s_%s" % (name, integration, "_".join("%g" % v for v in offset[:dim]))
                report, _ = scene.run(where, FALL % (dim, body, spacing, "[%s]" % ", ".join("%g" % v for v in offset[:dim]), "", integration))
                line += ["%.6f" % scene.last(where, "g.displacement_y"), number(report["energy"]["strain"], 0)]
                if integration == "consistent":
                    line += ["%s of %s" % (number(max(report["balance"]["forces"], report["balance"]["moments"]), 0), number(report["balance"]["allowed"], 0))]
            lines.append(line)
    return table(["body", "fall, m", "strain energy, J", "balance", "Gauss points", "strain energy, J"], lines)


# ---- cracks: strip and double cantilever --------------------------------------------------------------------------------
def cracks(scene):
    lattices = [scenes.Lattice("aligned"), *(scenes.Lattice("lattice by %g, %g" % o, offset=o) for o in OFFSETS),
                scenes.Lattice("turned 17", OFFSETS[0], 17), scenes.Lattice("turned 38", OFFSETS[1], 38), scenes.Lattice("moved .2", perturb=0.2, seed=SEED)]
    lines = []
    for kind in (scenes.Strip, scenes.DoubleCantilever):
        for lattice in lattices:
            line = [kind.title, lattice.name]
            for method in ("consistent linear", "gauss linear"):
                body = kind(scenes.Material(), lattice, 20)
                name = "_".join([body.name, lattice.name, method]).replace(" ", "_").replace(",", "")
                report, _ = scene.run(name, scenes.text(body, lattice, 20, method, events=2))
                load = scene_loads(scene, name)
                line += [percent(load[0] / body.theory(body.start) - 1, 2), percent(report["patch_error"], 2)]
            lines.append(line)
    return table(["body", "lattice", "load of first growth", "patch error", "Gauss points", "patch error"], lines)


def scene_loads(scene, name):
    with open("%s/cuts/%s/history.csv" % (scene.out, name), encoding="utf-8") as file:
        rows = [line.strip().split(",") for line in file]
    head = [h.split(" [")[0] for h in rows[0]]
    return [float(r[head.index("load_factor")]) for r in rows[1:] if r[head.index("event")] == "1"]


def cuts(runner, out):
    scene = Scene(runner, out)
    return (command("PERIGAL_SEED=%d PERIGAL_TEST_SIZE=long build/release/test/mechanics/force/test_rigid_motion" % SEED)
            + motions(runner) + cantilever(scene) + fall(scene) + cracks(scene))

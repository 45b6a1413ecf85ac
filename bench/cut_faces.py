#!/usr/bin/env python3
"""What cells that end at the surface are worth in space: the thick sphere of data/lame_sphere, as shapes and as a mesh of
hex20 elements in a lattice, with cells cut along the surface and as a staircase. Prints a table: error of the volume, of
the force of the pressure on the bore (exactly pi/4 N along each axis), of the displacement (L2), processor seconds.

    python3 bench/cut_faces.py build/release [largest number of cells over the radius, 16]
"""
import json
import math
import os
import re
import subprocess
import sys
import tempfile

EXACT = 7 * math.pi / 6
EDGES = [(0, 1), (0, 3), (0, 4), (1, 2), (1, 5), (2, 3), (2, 6), (3, 7), (4, 5), (4, 7), (5, 6), (6, 7)]
CUBE = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]


def write_mesh(path, across):
    """An eighth of the sphere from three blocks of across^3 elements, whose nodes lie on spheres."""
    numbers, places, elements = {}, [], []

    def node(block, i, j, k):
        d = [1.0, math.tan(math.pi / 4 * i / (2 * across)), math.tan(math.pi / 4 * j / (2 * across))]
        radius = 1 + k / (2 * across)
        x = [radius * d[(a - block) % 3] / math.hypot(*d) for a in range(3)]
        key = tuple(round(v, 9) + 0.0 for v in x)
        if key not in numbers:
            numbers[key] = len(places) + 1
            places.append(x)
        return numbers[key]

    for block in range(3):
        for c in range(across ** 3):
            at = [2 * (c % across), 2 * (c // across % across), 2 * (c // across ** 2)]
            corners = [[at[a] + 2 * q[a] for a in range(3)] for q in CUBE]
            middles = [[(corners[p][a] + corners[q][a]) // 2 for a in range(3)] for p, q in EDGES]
            elements.append([node(block, *q) for q in corners + middles])
    with open(path, "w", encoding="ascii") as out:
        out.write("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n%d\n" % len(places))
        for i, x in enumerate(places):
            out.write("%d %.17g %.17g %.17g\n" % (i + 1, *x))
        out.write("$EndNodes\n$Elements\n%d\n" % len(elements))
        for i, e in enumerate(elements):
            out.write("%d 17 2 1 1 %s\n" % (i + 1, " ".join(map(str, e))))
        out.write("$EndElements\n")


def mesh_scene(scene, path):
    """The scene with the mesh as its body, and sets that need no names of shapes."""
    body = scene.index("body:"), scene.index("spacing:")
    scene = scene[:body[0]] + "body: [{add: {mesh: {file: %s}}}]\n" % path + scene[body[1]:]
    sets = scene.index("sets:"), scene.index("method:")
    names = {"plane_x": "left", "plane_y": "bottom", "plane_z": "back"}
    scene = scene[:sets[0]] + "sets: {bore: {boundary: side, where: 'x^2 + y^2 + z^2 < 1.5 m^2 and x > 1e-3 and y > 1e-3 and z > 1e-3'}}\n" \
        + scene[sets[1]:]
    for name, side in names.items():
        scene = scene.replace("set: " + name, "set: " + side)
    return scene


def measure(program, scene, settings, folder):
    """(volume, force, error, processor seconds, points)"""
    options = [o for s in settings + ["output.pictures=[]"] for o in ("--set", s)]
    check = subprocess.run([program, "check", scene, *options], capture_output=True, text=True, check=True).stdout
    found = re.search(r"volume ([0-9.e+-]+) m", check)
    before = os.times()
    run = subprocess.run([program, "run", scene, *options, "--threads", "1", "-o", folder], capture_output=True, text=True, check=True)
    after = os.times()
    with open(os.path.join(folder, "report.json"), encoding="utf-8") as file:
        report = json.load(file)
    force = float(re.search(r"peak load: ([0-9.e+-]+) mN", run.stdout + run.stderr).group(1)) * 1e-3
    error = float(re.search(r"displacement: L2 ([0-9.e+-]+)", run.stdout + run.stderr).group(1))
    return found, force, error, after.children_user - before.children_user, report["points"]


def main():
    program = os.path.join(sys.argv[1], "perigal")
    finest = int(sys.argv[2]) if len(sys.argv) > 2 else 16
    scene = open("data/lame_sphere/scene.yaml", encoding="utf-8").read()
    print("| body | cells | integration | spacing | points | volume | force on the bore | displacement, L2 | CPU s |")
    print("|---|---|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for body in ("shapes", "mesh"):
            path = os.path.join(folder, body + ".yaml")
            if body == "mesh":
                write_mesh(os.path.join(folder, "octant.msh"), 6)
                scene = mesh_scene(scene, os.path.join(folder, "octant.msh"))
            with open(path, "w", encoding="utf-8") as out:
                out.write(scene)
            for cells in ("staircase", "cut"):
                for integration in ("gauss", "consistent"):
                    n = 4
                    while n <= finest:
                        volume, force, error, seconds, points = measure(
                            program, path, ["spacing=%g" % (2 / n), "cells=" + cells, "method.integration=" + integration], folder)
                        volume = "%.1e" % abs(float(volume.group(1)) / EXACT - 1) if volume else "-"
                        print("| %s | %s | %s | %g | %d | %s | %.1e | %.2e | %.1f |" % (
                            body, cells, integration, 2 / n, points, volume, abs(force * 4 / math.pi - 1), error, seconds), flush=True)
                        n *= 2


main()

#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a crack along a uniform stress does to the strain energy of a discretised body: nothing in truth.

    python3 bench/stress_along_crack.py build/release

A square of 40 spacings under uniform compression S has a crack along S, which is lengthened by half a spacing at a time. Printed: the change of the strain
energy per spacing, over S^2 h^2 t / 2E. Where a crack grows under a stress along it, as wings do under compression, each facet shows this besides G0 h t.

Then the same crack at 45 degrees to S, closed and stuck (friction 10): it should change nothing either. Printed: what it adds to the strain energy of the
square without it, all of it at its two tips, over S^2 h^2 t / 2E; where wings leave a tip it goes, and their facets take as much too little."""
import json
import math
import os
import subprocess
import sys
import tempfile

SCENE = """dimension: 2
plane: stress
thickness: 1
body: [{{add: {{box: {{low: [-20, -20], high: [20, 20]}}}}}}]
spacing: 1
lattice: cells
cracks: [{{from: [{x0:.9g}, {y0:.9g}], to: [{x1:.9g}, {y1:.9g}]}}]
materials: {{m: {{youngs_modulus: 1000, poissons_ratio: 0.15}}}}
method: {{integration: {integration}}}
boundary:
  - {{set: top, traction: {{x: {xy:.9g}, y: {yy:.9g}}}}}
  - {{set: bottom, traction: {{x: {xy_:.9g}, y: {yy_:.9g}}}}}
  - {{set: right, traction: {{x: {xx:.9g}, y: {xy:.9g}}}}}
  - {{set: left, traction: {{x: {xx_:.9g}, y: {xy_:.9g}}}}}
  - {{set: a, essential: penalty, displacement: {{x: 0, y: 0}}}}
  - {{set: b, essential: penalty, displacement: {{x: 0}}}}
sets: {{a: {{where: "x < -19 and y < -19"}}, b: {{where: "x < -19 and y > 19"}}}}
solver: {{kind: static, stepping: fixed, steps: 1}}
output: {{at: {{levels: 1}}}}
"""


def energy(program, folder, length, angle, integration, stuck=False):
    s, c = math.sin(math.radians(angle)), math.cos(math.radians(angle))
    ends = dict(x0=0.13 - 5 * s, y0=0.21 - 5 * c, x1=0.13 + length * s, y1=0.21 + length * c)
    if stuck:
        s, c = math.sin(math.radians(angle + 45)), math.cos(math.radians(angle + 45))
    values = dict(ends, xx=-s * s, yy=-c * c, xy=-s * c,
                  xx_=s * s, yy_=c * c, xy_=s * c, integration=integration)
    scene = os.path.join(folder, "scene.yaml")
    with open(scene, "w", encoding="utf-8") as file:
        file.write(SCENE.format(**values) + ("contact: {kind: friction, coefficient: 10}\n" if stuck else ""))
    subprocess.run([program, "run", scene, "--force", "-o", os.path.join(folder, "out")], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    with open(os.path.join(folder, "out", "report.json"), encoding="utf-8") as file:
        return json.load(file)["energy"]["strain"]


def main():
    program = os.path.join(sys.argv[1], "perigal")
    print("| integration | angle to the lattice | change of the strain energy per spacing, over S^2 h^2 t / 2E: least | largest | mean | closed and stuck, energy of both tips: least | largest |\n|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for integration in ("gauss", "consistent"):
            for angle in (0, 10, 20, 30, 45):
                values = [energy(program, folder, 5 + 0.5 * k, angle, integration) for k in range(11)]
                change = [(b - a) * 2000 for a, b in zip(values, values[2:])]
                tips = [energy(program, folder, 5 + 0.5 * k, angle, integration, True) * 2000 - 1600 for k in range(0, 11, 2)]
                print(f"| {integration} | {angle} | {min(change):.2f} | {max(change):.2f} | {sum(change) / len(change):.2f} | {min(tips):.2f} | {max(tips):.2f} |",
                      flush=True)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What facets of a confined flaw dissipate while it is compressed, over G0 x area, by spacing: data/confined_flaw.

    python3 bench/confined_energy.py build/release [CONFINEMENT_MPA...] [-- SPACING_MM...]

Single facets scatter by what the stress along the wings does to the strain energy of a discretised body
(bench/stress_along_crack.py), and by the straight line between the two equilibria of a facet, whose loads are far apart
for the first wings; both become smaller with the spacing."""
import csv
import os
import subprocess
import sys
import tempfile


def table(path):
    with open(path, encoding="utf-8") as file:
        rows = list(csv.reader(file))
    names = [name.split(" ")[0] for name in rows[0]]
    return [dict(zip(names, row)) for row in rows[1:]]


def run(program, confinement, spacing, length):
    with tempfile.TemporaryDirectory() as folder:
        out = os.path.join(folder, "out")
        subprocess.run([program, "run", "data/confined_flaw/scene.yaml", "-o", out, "--set", f"boundary[0].pressure={confinement} MPa",
                        "--set", f"boundary[1].pressure={confinement} MPa", "--set", f"spacing={spacing} mm",
                        "--set", f"stages[1].until.crack_length={length} mm"], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        rows = [row for row in table(os.path.join(out, "history.csv")) if row["stage"] == "2"]
        grown = {}
        for part in table(os.path.join(out, "cracks.csv")):
            size = ((float(part["x1"]) - float(part["x0"])) ** 2 + (float(part["y1"]) - float(part["y0"])) ** 2) ** 0.5
            grown[part["step"]] = grown.get(part["step"], 0) + size
    single, energy, area, before, loads = [], 0, 0, 0, []
    for row in rows:
        taken, new = float(row["energy_dissipated"]) - before, 5 * 0.03 * grown.get(row["step"], 0)
        before = float(row["energy_dissipated"])
        if new > 0:
            single.append(taken / new)
            loads.append(float(row["load_factor"]) - 1)
            energy, area = energy + taken, area + new
    return energy / area, single, loads


def main():
    words = sys.argv[2:]
    split = words.index("--") if "--" in words else len(words)
    confinements = [float(x) for x in words[:split]] or [0.5, 2]
    spacings = [float(x) for x in words[split + 1:]] or [1, 0.5]
    print("| confinement, MPa | spacing, mm | facets | dissipated over G0 x area | single facets | load of the second facet over that of the first |")
    print("|---|---|---|---|---|---|")
    for confinement in confinements:
        for spacing in spacings:
            whole, single, loads = run(os.path.join(sys.argv[1], "perigal"), confinement, spacing, 8)
            print(f"| {confinement:g} | {spacing:g} | {len(single)} | {whole:.3f} | {min(single):.2f} - {max(single):.2f} | {loads[1] / loads[0]:.2f} |",
                  flush=True)


if __name__ == "__main__":
    main()

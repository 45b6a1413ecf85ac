"""Loads behind a kink beside linear elastic fracture mechanics on the path that the program itself made, for bench/fracture.

A run grows some facets. For each of them the body is meshed anew with the crack as it was before (data/fracture_fem/reference.py: gmsh and
CalculiX, nothing shared with Perigal), and K_I, K_II of the tip that grew give the load by the largest hoop stress.
"""
import csv
import importlib.util
import math
import shutil

import fracture_scenes as scenes


STRAIGHT = [scenes.Lattice("centred"), scenes.Lattice("shifted .37, .21", (0.37, 0.21)), scenes.Lattice("shifted .11, .43", (0.11, 0.43)),
            scenes.Lattice("shifted -.29, .36", (-0.29, 0.36)), scenes.Lattice("moved .2, seed 1", perturb=0.2)]
TURNED = [STRAIGHT[0], STRAIGHT[1], scenes.Lattice("turned 23", (0.13, 0.29), 23), scenes.Lattice("turned 37", (0.13, 0.29), 37), STRAIGHT[4]]
FEWER = ("shifted .11, .43", "shifted -.29, .36", "turned 37")          # left out with twice as many spacings
# body, its width in half lengths of the crack, lattices (sides that are held across cannot be turned)
CASES = [(scenes.ShearNotch, 2, STRAIGHT), (scenes.CrackedDisk, 1 / 0.15, TURNED), (scenes.CrackedDisk15, 1 / 0.15, TURNED),
         (scenes.Inclined30, 1, TURNED), (scenes.Inclined, 1, TURNED), (scenes.Inclined60, 1, TURNED)]


SHOWN = 4                               # events behind a kink


def load_reference():
    place = importlib.util.spec_from_file_location("reference", "data/fracture_fem/reference.py")
    module = importlib.util.module_from_spec(place)
    place.loader.exec_module(module)
    return module


def missing():
    """What lacks, or nothing."""
    return [tool for tool in ("gmsh", "ccx") if not shutil.which(tool)]


def rows_of(path):
    with open(path, encoding="utf-8") as file:
        return [{k.split(" [")[0]: v for k, v in row.items()} for row in csv.DictReader(file)]


class Event:
    """One growth: load factor, the crack before it, which of its ends grew, K_I and K_II of the run."""

    def __init__(self, factor, crack, start, kinked, ratio, force):
        self.factor, self.crack, self.start, self.kinked, self.ratio, self.force = factor, crack, start, kinked, ratio, force


def clip(body, a, b):
    """A crack of the scene without what lies outside of the body: its mouth is put on the edge."""
    low = min(v[0] for v in body.outline)
    if a[0] < low:
        s = (low - a[0]) / (b[0] - a[0])
        a = (low, a[1] + s * (b[1] - a[1]))
    return a, b


def events_of(case, most):
    """The first facets of a run of one crack: a tip is 1 at the second end of the crack of the scene, 0 at the first."""
    body, frame = case.body, scenes.Frame(case.body, case.lattice)
    folder = case.folder + "/run/"
    a, b = clip(body, *body.cracks[0])
    crack, grown, out, tips = [a, b], [0, 0], [], {}
    pieces = [r for r in rows_of(folder + "cracks.csv") if int(r["tip"]) > 0]
    history = rows_of(folder + "history.csv")
    for step in sorted({int(r["step"]) for r in pieces}):
        row = next(r for r in history if int(r["step"]) == step)
        fresh, before = [r for r in pieces if int(r["step"]) == step], list(crack)
        for r in fresh:
            p, q = (frame.back((float(r["x" + k]), float(r["y" + k]))) for k in "01")
            at_end = min(math.dist(p, crack[-1]), math.dist(q, crack[-1])) < min(math.dist(p, crack[0]), math.dist(q, crack[0]))
            end = crack[-1] if at_end else crack[0]
            new = p if math.dist(q, end) < math.dist(p, end) else q
            crack = crack + [new] if at_end else [new] + crack
            tips.setdefault(at_end, int(r["tip"]))
            if r is fresh[0]:
                lead = (at_end, grown[at_end] > 0)
            grown[at_end] += 1
        number = tips[lead[0]]
        k1, k2 = (float(row.get("tip.%d.%s" % (number, k)) or "nan") for k in ("K_I", "K_II"))
        forces = [v for k, v in row.items() if k.endswith("force_y")]
        out.append(Event(float(row["load_factor"]), before, not lead[0], lead[1], k2 / k1, float(forces[-1]) if forces else math.nan))
        if len(out) == most:
            break
    return out


def intensities(reference, body, event, refine=1.0):
    """K_I, K_II of the tip that grew, at load factor 1, Pa m^(1/2)."""
    m = body.material
    nu = m.nu if m.plane == "strain" else m.nu / (1 + m.nu)
    reference.NU, reference.PRIME = nu, 1 / (1 - nu * nu)
    line = event.crack[::-1] if event.start else event.crack
    last = math.dist(line[-1], line[-2])
    outer = 0.9 * last if event.kinked else min(0.5 * last, 0.1)
    loads, held = {}, []
    scale = m.prime() / reference.PRIME
    for edge, kind, vector in body.loads:
        if kind == "traction":
            loads[edge + 1] = tuple(v / scale for v in vector)
        else:
            held.append((edge + 1, tuple(None if v is None else v / body.width for v in vector)))
    pins = []
    if body.pin:
        x, y = body.outline[0]
        far = body.outline[1]
        pins = [((x, y), 1), ((x, y), 2), (far, 2)]
    found, _, _ = reference.measure(body.outline, (), [event.crack], loads, pins, outer, outer / 14 / refine, 0.06 / refine * size_of(body), 0, event.start, held)
    root = scale * math.sqrt(body.width)
    return found[1] * root, found[2] * root


def size_of(body):
    return max(v[0] for v in body.outline) - min(v[0] for v in body.outline)


def judged(reference, case, most, refine=1.0):
    """Of each event: (kinked, load over that of LEFM, K_II / K_I of the run, of LEFM); up to the last that the tables show."""
    out = []
    for event in events_of(case, most):
        if sum(e[0] for e in out) == SHOWN:
            break
        k1, k2 = intensities(reference, case.body, event, refine)
        angle, k = reference.hoop(k1, k2)
        out.append((event.kinked, event.factor * k / case.body.material.toughness(), event.ratio, k2 / k1))
    return out

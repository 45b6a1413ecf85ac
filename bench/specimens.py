"""Laboratory specimens with cracks, drawn at random: geometry, loads as tractions on edges and pads, and K of the first growth by finite elements.

A Specimen is a Body of fracture_scenes.py whose dimensions are drawn from the range of its kind. Its loads are tractions alone, so that K depends neither on the elastic
constants nor on how it is held; data/fracture_fem/reference.py (gmsh, CalculiX; nothing shared with Perigal) gives K of the same outline under the same tractions.
Where a handbook has a formula for the kind, `handbook` is K by it, over the unit load, for comparison with the finite elements alone.

Sources of the formulas: see fracture_scenes.py, and
  compact plates             none: the load acts on strips of the outer edges here, not in holes
  double edge notch          H. Tada, P. C. Paris, G. R. Irwin: within 0.5 % (from memory)
"""
import math
import os
import sys

import fracture_scenes as scenes

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "data", "fracture_fem"))
import reference                                           # noqa: E402

FULL = scenes.FULL


class Specimen(scenes.Body):
    """unit: tractions of the unit load as (edge from 0, (x, y)), in units of the nominal stress; pins: (place, component from 1), three, where finite elements are held."""
    unit, pins, ring, fine, coarse = (), (), 0.0, 0.001, 0.06
    handbook = None
    tip = (0, False)                                       # number of the crack, its first end: the tip that grows first

    def __init__(self, random, material, lattice, per_crack):
        self.draw(random)
        least = min(self.crack_length(), self.ligament())
        n = max(4, round(per_crack / least))
        self.per_crack = n * least
        self.n = n
        super().__init__(material, lattice, n, width=self.size)

    def build(self):
        self.unit, self.pins = [], []
        self.lay_out()
        crack, first = self.tip
        cracks = [list(self.mouthed(c)) for c in self.cracks]
        found = reference.measure([tuple(v) for v in self.outline], (), cracks, {k + 1: v for k, v in self.unit}, self.pins, self.ring, self.fine, self.coarse, crack, first)[0]
        self.j, self.k1, self.k2 = found
        angle, self.k = scenes.hoop(abs(self.k1), self.k2)
        self.start = self.crack_length()
        stress = FULL * self.material.toughness() / (self.k * math.sqrt(self.width))
        self.loads = [(edge, "traction", (stress * x, stress * y)) for edge, (x, y) in self.unit]

    def mouthed(self, crack):
        return crack

    def theory(self, a):
        return 1 / FULL

    # what kinds give
    def draw(self, random):
        raise NotImplementedError

    def crack_length(self):
        return self.a

    def ligament(self):
        return 1 - self.a

    def lay_out(self):
        raise NotImplementedError

    def words(self):
        raise NotImplementedError


def between(random, low, high):
    return low + (high - low) * random.random()


class EdgeNotch(Specimen):
    name, title = "single_edge_notch", "Single edge notch in tension"

    def draw(self, random):
        self.size, self.a, self.half = between(random, 0.02, 0.2), between(random, 0.2, 0.7), between(random, 1.2, 2)

    def lay_out(self):
        b = self.half
        self.outline = [(0, -b), (1, -b), (1, b), (0, b)]
        self.cracks = [((0, self.dy), (self.a, self.dy))]
        self.unit, self.ring = [(0, (0, -1)), (2, (0, 1))], 0.4 * min(self.a, 1 - self.a)
        self.pins, self.pin = [((1, 0), 1), ((1, 0), 2), ((1, b), 1)], (0.97, self.dy)
        self.along = (1, 0)
        a = self.a
        self.handbook = math.sqrt(math.pi * a) * math.sqrt(2 / (math.pi * a) * math.tan(math.pi * a / 2)) * (0.752 + 2.02 * a + 0.37 * (1 - math.sin(math.pi * a / 2)) ** 3) \
            / math.cos(math.pi * a / 2)

    def words(self):
        return f"a/W {self.a:.3f}, H/W {2 * self.half:.2f}"


class DoubleEdgeNotch(Specimen):
    name, title, tips = "double_edge_notch", "Double edge notch in tension", 2

    def draw(self, random):
        self.size, self.a, self.half = between(random, 0.02, 0.2), between(random, 0.12, 0.38), between(random, 1.2, 2)

    def ligament(self):
        return 0.5 - self.a

    def lay_out(self):
        b, a = self.half, self.a
        self.outline = [(0, -b), (1, -b), (1, b), (0, b)]
        self.cracks = [((0, self.dy), (a, self.dy)), ((1, self.dy), (1 - a, self.dy))]
        self.unit, self.ring = [(0, (0, -1)), (2, (0, 1))], 0.4 * min(a, 0.5 - a)
        self.pins, self.pin = [((0.5, -b), 1), ((0.5, -b), 2), ((0.5, b), 1)], (0.03, 0.3 * b)
        x = 2 * a
        self.handbook = math.sqrt(math.pi * a) * (1.122 - 0.561 * x - 0.205 * x ** 2 + 0.471 * x ** 3 - 0.19 * x ** 4) / math.sqrt(1 - x)

    def words(self):
        return f"2a/W {2 * self.a:.3f}, H/W {2 * self.half:.2f}"


class CentreCrack(Specimen):
    """Of a plate of half width 1."""
    name, title, tips = "centre_crack", "Centre crack in tension", 2

    def draw(self, random):
        self.size, self.a, self.half = between(random, 0.02, 0.2), between(random, 0.2, 0.7), between(random, 1.8, 2.6)

    def lay_out(self):
        b, a = self.half, self.a
        self.outline = [(-1, -b), (1, -b), (1, b), (-1, b)]
        self.cracks = [((-a + self.dx, self.dy), (a + self.dx, self.dy))]
        self.unit, self.ring = [(0, (0, -1)), (2, (0, 1))], 0.4 * min(a, 1 - a)
        self.pins, self.pin = [((-1, 0), 1), ((-1, 0), 2), ((1, 0), 2)], (-0.97, self.dy)
        self.tip = (0, self.dx < 0)
        self.handbook = math.sqrt(math.pi * a) * (1 - 0.025 * a ** 2 + 0.06 * a ** 4) / math.sqrt(math.cos(math.pi * a / 2))

    def words(self):
        return f"a/b {self.a:.3f}, H/b {2 * self.half:.2f}"


class Bend(Specimen):
    """Three points; the middle force and the supports act on pads, the notch may lie off the middle."""
    name, title = "three_point_bend", "Notched beam in three-point bending"

    def draw(self, random):
        self.size, self.a, self.span = between(random, 0.02, 0.2), between(random, 0.2, 0.65), between(random, 3, 6)
        self.pad, self.off = between(random, 0.06, 0.15), 0.0

    def supports(self):
        """(place, force upwards) of forces on the lower edge; the same, downwards, on the upper."""
        s = self.span / 2
        return [(-s, 0.5), (s, 0.5)], [(0, 1.0)]

    def lay_out(self):
        below, above = self.supports()
        w, end = self.pad / 2, max(x for x, _ in below) + 0.25
        self.outline = [(-end, 0)]
        for x, _ in below:
            self.outline += [(x - w, 0), (x + w, 0)]
        self.outline += [(end, 0), (end, 1)]
        for x, _ in reversed(above):
            self.outline += [(x + w, 1), (x - w, 1)]
        self.outline += [(-end, 1)]
        nb = len(below)
        self.unit = [(2 * k + 1, (0, f / self.pad)) for k, (_, f) in enumerate(below)]
        self.unit += [(2 * nb + 3 + 2 * k, (0, -f / self.pad)) for k, (_, f) in enumerate(reversed(above))]
        x = self.off * self.span
        self.cracks = [((x + self.dx, 0), (x + self.dx, self.a))]
        self.ring = 0.4 * min(self.a, 1 - self.a)
        self.pins, self.pin = [((-end, 1), 1), ((-end, 1), 2), ((end, 1), 2)], (-end + 0.03, 0.97)
        if self.off == 0:
            self.along = (0, 1)

    def words(self):
        return f"a/W {self.a:.3f}, S/W {self.span:.2f}, pads {self.pad:.3f} W" + (f", notch {self.off:.3f} S off" if self.off else "")


class OffsetBend(Bend):
    name, title = "offset_notch", "Beam in three-point bending, notch beside the middle"

    def draw(self, random):
        super().draw(random)
        self.a, self.off = between(random, 0.25, 0.5), between(random, 0.05, 0.25)


class FourPointBend(Bend):
    name, title = "four_point_bend", "Notched beam in four-point bending"

    def draw(self, random):
        super().draw(random)
        self.span, self.inner = between(random, 3.5, 6), between(random, 0.8, 1.6)

    def supports(self):
        s, i = self.span / 2, self.inner / 2
        return [(-s, 0.5), (s, 0.5)], [(-i, 0.5), (i, 0.5)]

    def words(self):
        return super().words() + f", inner span {self.inner:.2f} W"


class Compact(Specimen):
    """A compact plate of width 1 from the line of its loads, which act on strips of the outer edges."""
    name, title = "compact_tension", "Compact tension, loaded on its edges"

    def draw(self, random):
        self.size, self.a, self.strip = between(random, 0.02, 0.2), between(random, 0.35, 0.7), between(random, 0.1, 0.2)

    def lay_out(self):
        w, a = self.strip / 2, self.a
        self.outline = [(-0.25, -0.6), (-w, -0.6), (w, -0.6), (1, -0.6), (1, 0.6), (w, 0.6), (-w, 0.6), (-0.25, 0.6)]
        self.cracks = [((-0.25, self.dy), (a, self.dy))]
        self.unit = [(1, (0, -1 / self.strip)), (5, (0, 1 / self.strip))]
        self.ring = 0.4 * min(a, 1 - a)
        self.pins, self.pin = [((1, -0.6), 1), ((1, -0.6), 2), ((1, 0.6), 1)], (0.97, self.dy)
        self.along = (1, 0)

    def words(self):
        return f"a/W {self.a:.3f}, strips {self.strip:.3f} W"


class HalfDisk(Specimen):
    """A half disk of radius 1 on two supports; arcs are polygons, here and there."""
    name, title, edges = "semi_circular_bend", "Semi-circular bend", 60

    def draw(self, random):
        self.size, self.a, self.span, self.pad = between(random, 0.02, 0.1), between(random, 0.25, 0.65), between(random, 0.5, 0.8), between(random, 0.06, 0.12)

    def lay_out(self):
        s, w = self.span, self.pad / 2
        arc = [(math.cos(math.pi * k / self.edges), math.sin(math.pi * k / self.edges)) for k in range(1, self.edges)]
        self.outline = [(-1, 0), (-s - w, 0), (-s + w, 0), (s - w, 0), (s + w, 0), (1, 0)] + arc
        at = 5 + self.edges // 2 - 1                       # the edges beside the top: from 5 the arc begins
        length = 2 * math.sin(math.pi / self.edges / 2)
        self.unit = [(1, (0, 0.5 / self.pad)), (3, (0, 0.5 / self.pad)), (at, (0, -0.5 / length)), (at + 1, (0, -0.5 / length))]
        self.cracks = [((self.dx, 0), (self.dx, self.a))]
        self.ring = 0.4 * min(self.a, 1 - self.a)
        self.pins, self.pin = [((-1, 0), 1), ((-1, 0), 2), ((1, 0), 2)], (-0.95, 0.04)

    def words(self):
        return f"a/R {self.a:.3f}, s/R {self.span:.2f}, pads {self.pad:.3f} R"


class CrackedDisk(Specimen):
    """A disk of radius 1 with a centre crack along the load."""
    name, title, tips, edges = "notched_brazilian", "Notched Brazilian disk, crack along the load", 2, 120

    def draw(self, random):
        self.size, self.a, self.arc = between(random, 0.02, 0.1), between(random, 0.2, 0.5), 2 + int(3 * random.random())

    def lay_out(self):
        turn = [2 * math.pi * k / self.edges for k in range(self.edges)]
        self.outline = [(math.cos(t), math.sin(t)) for t in turn]
        self.cracks = [((self.dx, self.dy - self.a), (self.dx, self.dy + self.a))]
        length, quarter = 2 * math.sin(math.pi / self.edges), self.edges // 4
        p = 1 / (2 * self.arc * length)
        self.unit = [(k, (0, -p)) for k in range(quarter - self.arc, quarter + self.arc)]
        self.unit += [(k, (0, p)) for k in range(3 * quarter - self.arc, 3 * quarter + self.arc)]
        self.ring = 0.4 * min(self.a, 1 - self.a)
        self.tip = (0, self.dy < 0)
        self.pins, self.pin = [((-1, 0), 1), ((-1, 0), 2), ((1, 0), 2)], (-0.97, 0)

    def words(self):
        return f"a/R {self.a:.3f}, loaded over {2 * self.arc * 360 / self.edges:.0f} degrees"


class Inclined(Specimen):
    """A crack of half length 1 at an angle to the load."""
    name, title, tips, diagonal, fine, coarse = "inclined_crack", "Inclined crack in tension", 2, True, 0.002, 0.15

    def draw(self, random):
        self.size, self.degrees, self.half = between(random, 0.01, 0.05), between(random, 30, 75), between(random, 2.5, 4)

    def crack_length(self):
        return 1.0

    def ligament(self):
        return 1.0

    def lay_out(self):
        b, t = self.half, math.radians(self.degrees)
        c, s = math.sin(t), math.cos(t)
        self.outline = [(-b, -b), (b, -b), (b, b), (-b, b)]
        self.cracks = [((self.dx - c, self.dy - s), (self.dx + c, self.dy + s))]
        self.unit, self.ring = [(0, (0, -1)), (2, (0, 1))], 0.5
        self.pins, self.pin = [((-b, 0), 1), ((-b, 0), 2), ((b, 0), 2)], (-0.97 * b, 0)

    def words(self):
        return f"{self.degrees:.1f} degrees to the load, plate {2 * self.half:.2f} half lengths"


class Slanted(Specimen):
    """An edge crack that is not across the load."""
    name, title, diagonal = "slanted_edge_crack", "Slanted edge crack in tension", True

    def draw(self, random):
        self.size, self.a, self.degrees = between(random, 0.02, 0.2), between(random, 0.25, 0.5), between(random, 15, 50)

    def lay_out(self):
        t = math.radians(self.degrees)
        c, s = self.a * math.cos(t), self.a * math.sin(t)
        self.outline = [(0, -1.5), (1, -1.5), (1, 1.5), (0, 1.5)]
        self.cracks = [((0, self.dy - s / 2), (c, self.dy + s / 2))]
        self.unit, self.ring = [(0, (0, -1)), (2, (0, 1))], 0.4 * min(self.a, 1 - c)
        self.pins, self.pin = [((1, 0), 1), ((1, 0), 2), ((1, 1.5), 1)], (0.97, 0.9)

    def words(self):
        return f"a/W {self.a:.3f}, {self.degrees:.1f} degrees"


KINDS = [EdgeNotch, DoubleEdgeNotch, CentreCrack, Bend, OffsetBend, FourPointBend, Compact, HalfDisk, CrackedDisk, Inclined, Slanted]

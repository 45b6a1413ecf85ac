"""The bodies of bench/fracture: plates and beams with cracks whose load of growth is known, laid on a lattice in any way.

A body is written down once, in its own axes, by the vertices of its outline. `text` writes it as a scene: its crack shifted against the
lattice, all of it turned (the body and its loads turn, the lattice stays), or on points moved at random (perturb). Loads are tractions or
whole displacement vectors of edges of the outline, so that they turn with the body; the body is held by a few points where stresses vanish.

Closed forms: theory (a) is the load factor at which a crack of length a grows, from its energy release rate G and the fracture energy G0.
The full load of every scene is FULL times the load of first growth, so that theory (first length) = 1/FULL.

Sources of the closed forms
  edge notch in tension      H. Tada, P. C. Paris, G. R. Irwin, The Stress Analysis of Cracks Handbook: within 0.5 %
                             (2.8266 at half the width; A. C. Kaya, F. Erdogan 1987 give 2.8246)
  three-point bend           J. E. Srawley, Int. J. Fracture 12 (1976) 475: span 4 widths, within 0.5 %
  double cantilever          A. D. Foote, V. T. Buchwald, Int. J. Fracture 29 (1985) 125: K sqrt (h) / P = sqrt (12) (a/h + 0.673)
  clamped strips             exact: the energy of the intact strip per length, of which nothing is left behind the tip
  centre crack               the secant of C. E. Feddersen 1966: within 0.3 % up to 0.8 of the width
  coupled criterion          D. Leguillon, Eur. J. Mech. A 21 (2002) 61: stress over the strength along the new crack and mean energy release
                             over the fracture energy, whichever needs more; its length is where that is least
  inclined crack             J. Eftis, H. Liebowitz 1972 and earlier: K_I = s sqrt (pi a) sin^2, K_II = s sqrt (pi a) sin cos in a wide plate;
                             direction and load by the largest hoop stress, F. Erdogan, G. C. Sih, J. Basic Eng. 85 (1963) 519
"""
import math

E, NU, G0 = 70e9, 0.22, 8.0            # glass: Pa, -, J/m2; other Poisson's ratios by the caller
FULL = 3.0                             # full load over the load of first growth


# ---- materials -------------------------------------------------------------------------------------------------------
class Material:
    """Elastic constants of the plane, and the fracture energy."""

    def __init__(self, nu=NU, plane="stress", modulus=E, energy=G0):
        self.nu, self.plane, self.modulus, self.energy = nu, plane, modulus, energy

    def prime(self):
        """E' of G = K^2 / E', Pa."""
        return self.modulus / (1 - self.nu ** 2) if self.plane == "strain" else self.modulus

    def shear(self):
        return self.modulus / (2 * (1 + self.nu))

    def held(self):
        """Stress over strain of a strip that cannot contract along its length, Pa."""
        if self.plane == "stress":
            return self.modulus / (1 - self.nu ** 2)
        return self.modulus * (1 - self.nu) / ((1 + self.nu) * (1 - 2 * self.nu))

    def toughness(self):
        return math.sqrt(self.prime() * self.energy)


# ---- bodies ----------------------------------------------------------------------------------------------------------
class Body:
    """One test in its own axes. Lengths in units of `width`, m.

    outline    vertices, counterclockwise; edge k runs from vertex k to the next (k from 0)
    cracks     pairs of places; an end outside the body is its mouth
    loads      (edge, "traction" | "displacement", (x, y)) at full load, in Pa or m
    pin        place where stresses vanish and the body is held; None: its loads hold it
    start      length of the crack at the start; theory (length) is the load factor at which it grows
    growth     length it may grow, over all tips
    path       facets follow this polyline (imposed); None: free
    straight   the crack should run along `along` (a unit vector)
    kink       degrees from the crack to the first facet, counterclockwise; None: not asked
    """
    holes = ()
    cracks = ()
    loads = ()
    pin = None
    path = None
    along = None
    interface = None                     # fracture energy between the two materials, J/m2
    slides = False                       # in mode II, whose energy is that of mode I
    diagonal = False                     # a crack at 45 degrees would run through points if nothing were shifted
    kink = None
    tips = 1
    materials = ()                       # (name, fracture energy, (distance, normal) of the half plane beyond which it is); none: one
    strength = None                      # tensile strength, Pa: cracks may come into being

    def __init__(self, material, lattice=None, n=20, width=0.1):
        self.material, self.width = material, width
        lattice = lattice or LATTICES[0]
        shift = (0.5, 0) if self.diagonal and not lattice.turn and not any(lattice.shift) else lattice.shift
        self.dx, self.dy = (v / n for v in (shift if not lattice.turn else (0, 0)))
        self.build()

    def build(self):
        raise NotImplementedError

    def theory(self, a):
        """Load factor; a in units of width."""
        raise NotImplementedError

    def taken(self, grown):
        """Fracture energy of that much new crack, J / thickness, grown in widths."""
        return self.material.energy * grown * self.width


class Strip(Body):
    """A strip of height 1 between two rigid grips that move apart: G is what the intact strip stores per length."""
    name, title = "strip", "Clamped strip, its grips moved apart"

    def build(self):
        # the free end ahead is felt over the height times the root of lambda / (12 mu)
        nu, strain = self.material.nu, self.material.plane == "strain"
        far = max(1.25, 5 * math.sqrt(nu / (6 * (1 - 2 * nu)))) if strain else 1.25
        self.start, self.growth, length = 1.25 + self.dx, 1.0, 2.25 + far
        self.outline = [(0, -0.5), (length, -0.5), (length, 0.5), (0, 0.5)]
        self.cracks = [((-0.2, self.dy), (self.start, self.dy))]
        self.along = (1, 0)
        # G = held (2 u)^2 / (2 height)
        u = FULL * 0.5 * math.sqrt(2 * self.material.energy * self.width / self.material.held())
        self.loads = [(0, "displacement", (0, -u)), (2, "displacement", (0, u))]

    def theory(self, a):
        return 1 / FULL


class ShearStrip(Strip):
    """The same strip, its grips moved along each other: mode II. A free crack would kink, so its path is imposed."""
    name, title, slides = "shear_strip", "Clamped strip in shear, path imposed", True

    def build(self):
        super().build()
        self.path = [(self.start, self.dy), (3.4, self.dy)]
        # G = mu (2 u)^2 / (2 height)
        u = FULL * 0.5 * math.sqrt(2 * self.material.energy * self.width / self.material.shear())
        self.loads = [(0, "displacement", (-u, 0)), (2, "displacement", (u, 0))]


class EdgeNotch(Body):
    """A plate of width 1 and height 3 with an edge crack across it, drawn at both ends by dead tractions."""
    name, title = "edge_notch", "Edge notch in tension"
    notch = 0.4

    def build(self):
        self.start, self.growth = self.notch + self.dx, 0.3
        self.outline = [(0, -1.5), (1, -1.5), (1, 1.5), (0, 1.5)]
        self.cracks = [((-0.2, self.dy), (self.start, self.dy))]
        self.along = (1, 0)
        self.unit = self.material.toughness() / (self.shape(self.start) * math.sqrt(self.width))
        s = FULL * self.unit
        self.loads = [(0, "traction", (0, -s)), (2, "traction", (0, s))]
        self.pin = (0.02, 0.4)

    @staticmethod
    def shape(a):
        """K / (stress sqrt (width)) (Tada, Paris, Irwin)."""
        half = math.pi * a / 2
        return math.sqrt(math.pi * a) * math.sqrt(math.tan(half) / half) * (
            0.752 + 2.02 * a + 0.37 * (1 - math.sin(half)) ** 3) / math.cos(half)

    def theory(self, a):
        return self.shape(self.start) / self.shape(a) / FULL


class Bend(Body):
    """A beam on two supports, span 4 depths, pressed in the middle; forces act on pads of a tenth of the depth."""
    name, title = "bend", "Three-point bend"
    patch, pad, span = 0.1, 0.05, 4.0

    def build(self):
        self.start, self.growth = 0.4 + self.dy, 0.3
        half, w, end = self.span / 2, self.patch / 2, self.span / 2 + 0.2
        self.outline = [(-end, 0)]
        for x in (self.dx - half, self.dx + half):
            self.outline += [(x - w, 0), (x - w, -self.pad), (x + w, -self.pad), (x + w, 0)]
        self.outline += [(end, 0), (end, 1), (self.dx + w, 1), (self.dx + w, 1 + self.pad), (self.dx - w, 1 + self.pad),
                         (self.dx - w, 1), (-end, 1)]
        self.cracks = [((self.dx, -0.2), (self.dx, self.start))]
        self.along = (0, 1)
        p = FULL * self.material.toughness() / (self.shape(self.start) * math.sqrt(self.width))      # force / (thickness width), Pa
        self.loads = self.forces(p)
        self.pin = (-end + 0.05, 0.95)

    def forces(self, p):
        """On the pads: the force p in the middle, half of it on each support."""
        return [(12, "traction", (0, -p / self.patch)), (2, "traction", (0, p / 2 / self.patch)), (6, "traction", (0, p / 2 / self.patch))]

    def shape(self, a):
        """K sqrt (width) thickness / force (Srawley 1976); the spread of the middle force takes w/(2 S) off the moment."""
        f = 3 * math.sqrt(a) * (1.99 - a * (1 - a) * (2.15 - 3.93 * a + 2.7 * a * a)) / (2 * (1 + 2 * a) * (1 - a) ** 1.5)
        return self.span * f * (1 - self.patch / (2 * self.span))

    def theory(self, a):
        return self.shape(self.start) / self.shape(a) / FULL


class DoubleCantilever(Body):
    """Two arms of height 1/2, drawn apart at their ends. A free crack leaves the middle (T-stress > 0): its path is imposed."""
    name, title = "double_cantilever", "Double cantilever, path imposed"

    def build(self):
        self.start, self.growth, length, d = 2.0 + self.dx, 0.5, 4.5, self.dy
        self.outline = [(0, -0.5), (length, -0.5), (length, 0.5), (0, 0.5), (0, d + 0.05), (0.1, d), (0, d - 0.05)]
        self.cracks = [((-0.2, d), (self.start, d))]
        self.path = [(self.start, d), (length, d)]
        self.along = (1, 0)
        p = FULL * self.material.toughness() * math.sqrt(self.width) / self.shape(self.start)        # force / thickness, N/m
        self.loads = [(6, "traction", (0, -p / ((0.45 + d) * self.width))), (3, "traction", (0, p / ((0.45 - d) * self.width)))]
        self.pin = (length - 0.1, -0.35)

    def shape(self, a):
        """sqrt (E' G) thickness sqrt (width) / force; arm height 1/2. A crack off the middle: the bending of two unequal arms."""
        uneven = ((1 - 2 * self.dy) ** -3 + (1 + 2 * self.dy) ** -3) / 2
        return math.sqrt(12 * uneven) * (a / 0.5 + 0.673) / math.sqrt(0.5)

    def theory(self, a):
        return self.shape(self.start) / self.shape(a) / FULL


def hoop(k1, k2):
    """(angle, K of that direction) of the largest hoop stress ahead of a tip (Erdogan, Sih 1963), rad, counterclockwise."""
    if k2 == 0:
        return 0.0, k1
    r = k1 / k2
    angle = 2 * math.atan((r - math.copysign(math.sqrt(r * r + 8), k2)) / 4)
    half = math.cos(angle / 2)
    return angle, half * (k1 * half * half - 1.5 * k2 * math.sin(angle))


class Inclined(Body):
    """A crack of half length 1 at an angle to the load, in a plate of 6 x 6: kinks at both tips."""
    degrees, diagonal = 45, True
    tips = 2
    # K_I, K_II / (stress sqrt (pi a)) over those of a wide plate: data/fracture_fem/intensity.csv
    finite = {30: (1.0, 1.0), 45: (1.0, 1.0), 60: (1.0, 1.0)}

    def build(self):
        self.name = "inclined_%d" % self.degrees
        self.title = "Centre crack at %d degrees to the load" % self.degrees
        self.start, self.growth = 2.0, 0.6
        b = math.radians(self.degrees)
        self.outline = [(-3, -3), (3, -3), (3, 3), (-3, 3)]
        c, s = math.sin(b), math.cos(b)                    # the load is along y
        self.cracks = [((self.dx - c, self.dy - s), (self.dx + c, self.dy + s))]
        k1, k2 = self.intensity()
        angle, k = hoop(k1, k2)
        self.kink = math.degrees(angle)
        stress = FULL * self.material.toughness() / (k * math.sqrt(self.width))
        self.loads = [(0, "traction", (0, -stress)), (2, "traction", (0, stress))]
        self.pin = (-2.9, 0)

    def intensity(self):
        """K_I, K_II of the tip at the upper right, over stress and the root of the half length; K_II < 0 kinks counterclockwise."""
        b = math.radians(self.degrees)
        f1, f2 = self.finite[self.degrees]
        root = math.sqrt(math.pi)
        return root * f1 * math.sin(b) ** 2, root * f2 * math.sin(b) * math.cos(b)

    def theory(self, a):
        return 1 / FULL if a <= self.start + 1e-9 else math.nan


class Inclined30(Inclined):
    degrees, diagonal = 30, False


class Inclined60(Inclined):
    degrees, diagonal = 60, False


class Slanted(Body):
    """An edge crack at 45 degrees in a plate of 1 x 2.5 in tension: its path bends across the plate. Reference: data/fracture_fem."""
    name, title = "slanted", "Slanted edge crack"
    diagonal = True
    curve = None                        # rows (x, y, length, K of the direction of growth) of data/fracture_fem/slanted.csv

    def build(self):
        self.start, self.growth = 0.35 * math.sqrt(2), 0.35
        self.outline = [(0, -1.25), (1, -1.25), (1, 1.25), (0, 1.25)]
        # along the edge alone, so that the length stays
        self.rise = self.dy - self.dx
        self.cracks = [((-0.1, -0.3 + self.rise), (0.35, 0.15 + self.rise))]
        stress = FULL * self.material.toughness() / (self.shape(self.start) * math.sqrt(self.width))
        self.loads = [(0, "traction", (0, -stress)), (2, "traction", (0, stress))]
        self.pin = (0.02, 0.6)

    def shape(self, a):
        """K of the direction of growth / (stress sqrt (width)), from the table; beyond its end not known."""
        rows = self.curve
        for low, high in zip(rows, rows[1:]):
            if a <= high[2] + 1e-9:
                share = (a - low[2]) / (high[2] - low[2])
                return low[3] + share * (high[3] - low[3])
        return math.nan

    def theory(self, a):
        return self.shape(self.start) / self.shape(a) / FULL


class Centre(Body):
    """A centre crack across the load in a plate of half width 1: both tips grow."""
    name, title, tips = "centre_crack", "Centre crack in tension, two tips", 2

    def build(self):
        self.start, self.growth = 0.8, 0.3                     # facets; two at a time where the lattice is symmetric
        self.outline = [(-1, -2), (1, -2), (1, 2), (-1, 2)]
        self.cracks = [((self.dx - 0.4, self.dy), (self.dx + 0.4, self.dy))]
        self.along = (1, 0)
        stress = FULL * self.material.toughness() / (self.shape(self.start) * math.sqrt(self.width))
        self.loads = [(0, "traction", (0, -stress)), (2, "traction", (0, stress))]
        self.pin = (-0.1, 0.12)

    @staticmethod
    def shape(a):
        """K / (stress sqrt (width)); a: the whole length."""
        return math.sqrt(math.pi * a / 2 / math.cos(math.pi * a / 4))

    def theory(self, a):
        """Of the first growth: whether both tips go on together decides the lattice."""
        return 1 / FULL if a <= self.start + 1e-9 else math.nan


class TwoEnergies(Strip):
    """The clamped strip of two materials that differ in their fracture energy alone: across their boundary the load grows by the root of 2."""
    name, title = "across", "Strip, crack across an interface to twice the fracture energy"
    border, ratio = 1.75, 2.0

    def build(self):
        super().build()
        m = self.material
        self.materials = [("glass", m.energy, None), ("tough", self.ratio * m.energy, (self.border, (1, 0)))]

    def theory(self, a):
        return (1 if a < self.border - 1e-9 else math.sqrt(self.ratio)) / FULL

    def taken(self, grown):
        tough = max(0.0, self.start + grown - self.border)
        return super().taken(grown - tough + self.ratio * tough)


class Along(Strip):
    """The strip glued along its middle by an interface of half the fracture energy, along which the crack runs."""
    name, title, weak = "along", "Strip, crack along an interface of half the fracture energy", 0.5

    def build(self):
        super().build()
        m = self.material
        self.materials = [("glass", m.energy, None), ("other", m.energy, (self.dy, (0, 1)))]
        self.interface = self.weak * m.energy

    def theory(self, a):
        return math.sqrt(self.weak) / FULL

    def taken(self, grown):
        return self.weak * super().taken(grown)


class Offset(Body):
    """Two edge cracks from opposite sides, one a little higher: they pass each other and join."""
    name, title, tips = "offset", "Two offset edge cracks", 2

    def build(self):
        self.start, self.growth = 0.5, 1.2
        self.outline = [(0, -1), (1, -1), (1, 1), (0, 1)]
        self.cracks = [((-0.1, 0.1 + self.dy), (0.25 + self.dx, 0.1 + self.dy)), ((1.1, -0.1 + self.dy), (0.75 + self.dx, -0.1 + self.dy))]
        stress = FULL * self.material.toughness() / math.sqrt(math.pi * 0.25 * self.width) / 1.12
        self.loads = [(0, "traction", (0, -stress)), (2, "traction", (0, stress))]
        self.pin = (0.02, 0.16)

    def theory(self, a):
        return math.nan


class IntoHole(Slanted):
    """An edge crack that passes below a hole and is drawn into it. Reference: data/fracture_fem."""
    name, title, diagonal = "into_hole", "Edge crack into a hole", False
    curve = None                        # data/fracture_fem/into_hole.csv

    def build(self):
        self.rise = self.dy
        self.start, self.growth = 0.3 + self.dx, 0.3
        self.outline = [(0, -1), (1, -1), (1, 1), (0, 1)]
        self.holes = [((0.6, 0.12 + self.dy), 0.1)]
        self.cracks = [((-0.1, self.dy), (self.start, self.dy))]
        stress = FULL * self.material.toughness() / (self.shape(self.start) * math.sqrt(self.width))
        self.loads = [(0, "traction", (0, -stress)), (2, "traction", (0, stress))]
        self.pin = (0.02, 0.06)

    def theory(self, a):
        """Not for the last facets, which go straight into the hole."""
        return super().theory(a) if a < 0.48 else math.nan


# ---- initiation ------------------------------------------------------------------------------------------------------
def coupled(stress, release, strength, energy, longest, steps=4000):
    """(load, length) of the coupled criterion. stress (l): at the end of a crack to come of length l under unit load; release (l): its energy
    release rate G under unit load; the least over l of the load that meets both."""
    best, total, before = (math.inf, 0.0), 0.0, 0.0
    for k in range(1, steps + 1):
        l = longest * k / steps
        middle = 0.5 * (l + before)
        total += release(middle) * (l - before)
        before = l
        if stress(l) <= 0:
            break
        need = max(strength / stress(l), math.sqrt(energy * l / total))
        if need < best[0]:
            best = (need, l)
    return best


class Beam(Bend):
    """The bend beam without a notch: the load at which a crack comes into being."""
    name, title = "beam", "Beam without a notch"
    length = 0.5                         # E' G0 / strength^2 over the depth

    def build(self):
        super().build()
        self.start, self.growth, self.cracks, self.along = 0.0, 0.2, [], None
        m, w = self.material, self.width
        self.strength = math.sqrt(m.prime() * m.energy / (self.length * w))
        # outer fibre stress of force 1 per width and thickness
        moment = 6 * (self.span / 4 - self.patch / 8)
        self.first, self.least = coupled(lambda l: moment * (1 - 2 * l),
                                         lambda l: self.shape(l) ** 2 * w / m.prime(),
                                         self.strength, m.energy, 0.45)
        p = FULL * self.first
        self.loads = self.forces(p)

    def theory(self, a):
        return 1 / FULL if a == 0 else math.nan


class Hole(Body):
    """A plate with a hole in tension, without a crack: initiation between the strength of a point and that of a plate without a hole."""
    name, title, tips = "hole", "Plate with a hole, no crack", 2
    radius, length = 0.1, 0.2

    def build(self):
        self.start, self.growth = 0.0, 0.2
        self.outline = [(-0.6, -0.9), (0.6, -0.9), (0.6, 0.9), (-0.6, 0.9)]
        self.holes = [((0, 0), self.radius)]
        m, w, r = self.material, self.width, self.radius
        self.strength = math.sqrt(m.prime() * m.energy / (self.length * w))
        def shape(l):
            """K / (stress sqrt (pi l)), a crack on each side of the hole (Tada, Paris, Irwin)."""
            s = l / (r + l)
            return 0.5 * (3 - s) * (1 + 1.243 * (1 - s) ** 3)
        self.first, self.least = coupled(lambda l: 0.5 * (2 + (r / (r + l)) ** 2 + 3 * (r / (r + l)) ** 4),
                                         lambda l: shape(l) ** 2 * math.pi * l * w / m.prime(), self.strength, m.energy, 0.3)
        s = FULL * self.first
        self.loads = [(0, "traction", (0, -s)), (2, "traction", (0, s))]
        self.pin = (-0.55, -0.85)

    def theory(self, a):
        return 1 / FULL if a == 0 else math.nan


# ---- lattices --------------------------------------------------------------------------------------------------------
class Lattice:
    """How the points lie: shift of the crack against them in spacings (of a turned body: of the lattice against it), angle by which the
    body is turned, degrees, random moves in spacings, shift of the lattice against body and crack together."""

    def __init__(self, name, shift=(0, 0), turn=0, perturb=0, seed=1, offset=None):
        self.name, self.shift, self.turn, self.perturb, self.seed = name, shift, turn, perturb, seed
        self.offset = offset or (shift if turn else None)


LATTICES = [
    Lattice("centred"),
    Lattice("shifted .37, .21", (0.37, 0.21)),
    Lattice("shifted .37, .40", (0.37, 0.40)),
    Lattice("shifted .10, -.45", (0.10, -0.45)),
    Lattice("turned 15", (0.13, 0.29), 15),
    Lattice("turned 30", (0.13, 0.29), 30),
    Lattice("turned 45", (0.13, 0.29), 45),
    Lattice("moved .2, seed 1", perturb=0.2, seed=1),
    Lattice("moved .2, seed 2", perturb=0.2, seed=2),
    Lattice("moved .2, seed 3", perturb=0.2, seed=3),
]


class Frame:
    """Turns the axes of a body into those of a scene."""

    def __init__(self, body, lattice):
        xs, ys = [v[0] for v in body.outline], [v[1] for v in body.outline]
        self.centre = (0.5 * (min(xs) + max(xs)), 0.5 * (min(ys) + max(ys)))
        self.c, self.s = math.cos(math.radians(lattice.turn)), math.sin(math.radians(lattice.turn))
        self.width = body.width

    def vector(self, v):
        return (self.c * v[0] - self.s * v[1], self.s * v[0] + self.c * v[1])

    def place(self, v):
        x, y = self.vector((v[0] - self.centre[0], v[1] - self.centre[1]))
        return (self.width * (x + self.centre[0]), self.width * (y + self.centre[1]))

    def back(self, x):
        """From a place of the scene, m, to the axes of the body, in widths."""
        u, v = x[0] / self.width - self.centre[0], x[1] / self.width - self.centre[1]
        return (self.c * u + self.s * v + self.centre[0], -self.s * u + self.c * v + self.centre[1])


# ---- scenes as text --------------------------------------------------------------------------------------------------
METHODS = {
    "gauss linear": "integration: gauss",
    "gauss linear 2.5": "integration: gauss, horizon: 2.5 spacing",
    "consistent linear": "integration: consistent",
    "gauss quadratic": "integration: gauss, basis: quadratic, horizon: 3 spacing",
    "consistent quadratic": "integration: consistent, basis: quadratic, horizon: 3 spacing",
}


def numbers(values, digits=12):
    return "[" + ", ".join("%.*g" % (digits, v) for v in values) + "]"


def component(v, largest):
    """Rounding of a turned vector is no load."""
    return 0.0 if abs(v) < 1e-12 * largest else v


def text(body, lattice, n, method="gauss linear", single=False, events=None):
    """The scene: n spacings in a width; single: breaks single bonds instead of growing facets."""
    frame, m, h = Frame(body, lattice), body.material, body.width / n
    lines = ["title: %s" % body.title, "dimension: 2", "plane: %s" % m.plane, "thickness: 1",
             "body:", "  - add: {polygon: {vertices: [%s]}}" % ", ".join(numbers(frame.place(v)) for v in body.outline)]
    for centre, radius in body.holes:
        lines += ["  - subtract: {disk: {center: %s, radius: %.12g}}" % (numbers(frame.place(centre)), radius * body.width)]
    lines += ["spacing: %.12g" % h, "lattice: cells"]
    if lattice.offset:
        lines += ["lattice_offset: %s" % numbers(lattice.offset)]
    if lattice.perturb:
        lines += ["perturb: {amount: %g, seed: %d}" % (lattice.perturb, lattice.seed)]
    if body.cracks:
        lines += ["cracks:"] + ["  - {from: %s, to: %s}" % (numbers(frame.place(a)), numbers(frame.place(b))) for a, b in body.cracks]
    lines += ["materials:"]
    for name, energy, _ in body.materials or [("glass", None, None)]:
        own = ", failure: {fracture_energy: %g}" % energy if energy else ""
        lines += ["  %s: {youngs_modulus: %.12g, poissons_ratio: %g%s}" % (name, m.modulus, m.nu, own)]
    if body.materials:
        lines += ["blocks:", "  - {material: %s, where: x == x}" % body.materials[0][0]]
        for name, _, (far, normal) in body.materials[1:]:
            along, p = frame.vector(normal), frame.place((far * normal[0], far * normal[1]))
            lines += ["  - {material: %s, where: %.12g * (x - %.12g) + %.12g * (y - %.12g) > 0}" % (name, along[0], p[0], along[1], p[1])]
    failure = "criterion: %s, fracture_energy: %g" % ("stretch" if single else "energy_release", m.energy)
    if not single:
        failure += ", shear_fracture_energy: %g" % m.energy if body.slides else ""
        failure += ", tensile_strength: %.12g" % body.strength if body.strength else ""
        failure += ", interfaces: [{between: [%s, %s], fracture_energy: %g}]" % (
            body.materials[0][0], body.materials[1][0], body.interface) if body.interface else ""
        failure += ", path: [%s]" % ", ".join(numbers(frame.place(v)) for v in body.path) if body.path else ""
    lines += ["failure: {%s}" % failure]
    if body.pin:
        lines += ["sets:", '  pin: {where: "hypot (x - %.12g, y - %.12g) < %.12g"}' % (*frame.place(body.pin), 1.1 * h)]
    lines += ["boundary:"]
    for k, (edge, kind, vector) in enumerate(body.loads):
        if None in vector:                                 # a component alone: bodies that are never turned
            which = ", ".join("%s: %.12g" % (n, v) for n, v in zip("xy", vector) if v is not None)
        else:
            size = math.hypot(*vector)
            which = "x: %.12g, y: %.12g" % tuple(component(v, size) for v in frame.vector(vector))
        lines += ["  - {name: load_%d, set: polygon.edge %d, %s: {%s}}" % (k + 1, edge + 1, kind, which)]
    if body.pin:
        lines += ["  - {name: pin, set: pin, displacement: {x: 0, y: 0}, essential: penalty}"]
    lines += ["method: {%s}" % METHODS[method]]
    if events is None:
        events = round(body.growth * n) * (60 if single else 1)
    lines += ["solver: {kind: static, max_events: %d}" % events]
    lines += ["output: {at: {levels: 1}, pictures: [damage]}", ""]
    return "\n".join(lines)


class ShearNotch(Body):
    """A square whose notch of half the width is sheared, its sides held across: the crack kinks."""
    name, title = "shear_notch", "Notch in shear, sides held"

    def build(self):
        self.start, self.growth = 0.5 + self.dx, 0.3
        self.outline = [(0, -0.5), (1, -0.5), (1, 0.5), (0, 0.5)]
        self.cracks = [((-0.2, self.dy), (self.start, self.dy))]
        u = FULL * self.width * math.sqrt(self.material.energy / (self.material.prime() * self.width))
        self.loads = [(0, "displacement", (0, 0)), (2, "displacement", (u, 0)), (1, "displacement", (None, 0)), (3, "displacement", (None, 0))]

    def theory(self, a):
        return 1 / FULL


class CrackedDisk(Body):
    """A disk (a polygon of 120 edges) between two platens, with a centre crack of three tenths of the diameter."""
    degrees, tips, edges = 27.2, 2, 120

    def build(self):
        self.name, self.title = "disk_%g" % self.degrees, "Disk, crack at %g degrees to the load" % self.degrees
        self.start, self.growth = 0.3, 0.2
        turn = [2 * math.pi * k / self.edges for k in range(self.edges)]
        self.outline = [(0.5 * math.cos(t), 0.5 * math.sin(t)) for t in turn]
        c, s = 0.15 * math.cos(math.radians(90 - self.degrees)), 0.15 * math.sin(math.radians(90 - self.degrees))
        self.cracks = [((self.dx - c, self.dy - s), (self.dx + c, self.dy + s))]
        stress = FULL * 6 * self.material.toughness() / math.sqrt(self.width)
        quarter = self.edges // 4
        self.loads = [(k, "traction", (0, -stress)) for k in range(quarter - 2, quarter + 2)]
        self.loads += [(k, "traction", (0, stress)) for k in range(3 * quarter - 2, 3 * quarter + 2)]
        self.pin = (0.5 * math.cos(turn[1]), 0)

    def theory(self, a):
        return 1 / FULL


class CrackedDisk15(CrackedDisk):
    degrees = 15


class HalfNotch(EdgeNotch):
    """The edge notch of half the width: K itself."""
    name, title, notch = "half_notch", "Edge notch of half the width", 0.5


BODIES = [Strip, EdgeNotch, Bend, Slanted, Inclined30, Inclined, Inclined60, ShearStrip, DoubleCantilever]
MORE = [Centre, TwoEnergies, Along, Offset, IntoHole]       # several tips, two materials, boundaries met on the way
BEGIN = [Beam, Hole]                                 # no crack at the start

#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""make_mesh.py CASE ELEMENT N [FILE.inp]: the benchmark cases as input of CalculiX.
CASE: cantilever, kirsch, lame (plane stress; lame_strain), plate_clamped, plate_sliding, bending_3d, cantilever_3d.
ELEMENT: 2D CPS3 CPS6 CPS4 CPS8 (R: reduced); 3D C3D8 C3D20 (I, R). N: elements across (see README.md).
Displacements are exact at the nodes, tractions become consistent nodal forces (5 Gauss points an edge or direction).
--measure FILE.frd: instead reads that result of the same case and prints relative L2 and energy errors (closed forms only)."""
import math, sys

GAUSS = [(-0.906179845938664, 0.236926885056189), (-0.538469310105683, 0.478628670499366), (0.0, 0.568888888888889),
         (0.538469310105683, 0.478628670499366), (0.906179845938664, 0.236926885056189)]
THICK = 0.01                                           # plane cases; CalculiX expands plane elements to bricks of this height


# ---- closed forms: u (x, y[, z]) and stress xx yy xy ------------------------------------------------------------------
def beam(E, nu, P=1000.0, I=144.0, L=48.0, c=6.0):
    def u(x, y, z=0.0):
        return (P * y / (6 * E * I) * ((6 * L - 3 * x) * x + (2 + nu) * (y * y - c * c)),
                -P / (6 * E * I) * (3 * nu * y * y * (L - x) + (4 + 5 * nu) * c * c * x + (3 * L - x) * x * x))
    def s(x, y, z=0.0):
        return P * (L - x) * y / I, 0.0, -P / (2 * I) * (c * c - y * y)
    return u, s


def kirsch(E=1e5, nu=0.3):                             # hole of radius 1, unit tension along x; plane stress
    G, kappa = E / (2 * (1 + nu)), (3 - nu) / (1 + nu)
    def u(x, y):
        r, t = math.hypot(x, y), math.atan2(y, x)
        return (1 / (8 * G) * (r * (kappa + 1) * math.cos(t) + 2 / r * ((1 + kappa) * math.cos(t) + math.cos(3 * t)) - 2 / r**3 * math.cos(3 * t)),
                1 / (8 * G) * (r * (kappa - 3) * math.sin(t) + 2 / r * ((1 - kappa) * math.sin(t) + math.sin(3 * t)) - 2 / r**3 * math.sin(3 * t)))
    def s(x, y):
        q, t = 1 / (x * x + y * y), math.atan2(y, x)
        return (1 - q * (1.5 * math.cos(2 * t) + math.cos(4 * t)) + 1.5 * q * q * math.cos(4 * t),
                -q * (0.5 * math.cos(2 * t) - math.cos(4 * t)) - 1.5 * q * q * math.cos(4 * t),
                -q * (0.5 * math.sin(2 * t) + math.sin(4 * t)) + 1.5 * q * q * math.sin(4 * t))
    return u, s


def lame(E, nu):                                       # radii 1 and 2, pressure 1 within; E, nu of plane stress
    def u(x, y):
        r = math.hypot(x, y)
        radial = ((1 - nu) * r + (1 + nu) * 4 / r) / (3 * E)
        return radial * x / r, radial * y / r
    def s(x, y):
        q = 1 / (x * x + y * y)
        a, b = (1 - 4 * q) / 3, (1 + 4 * q) / 3        # radial, hoop
        return (a * x * x + b * y * y) * q, (a * y * y + b * x * x) * q, (a - b) * x * y * q
    return u, s


def block(k=1e-3, nu=0.3):                             # pure bending, curvature k
    return lambda x, y, z: (k * x * y, -0.5 * k * (x * x + nu * (y * y - z * z)), -nu * k * y * z)


# ---- cases: map of the unit square or cube, elements in each direction, conditions on its sides ----------------------------
def ring(s, t, inner, outer):                          # inner, outer: curves of t; along each ray sizes grow with the radius
    a, b = inner(t), outer(t)
    ratio = math.hypot(*b) / math.hypot(*a)
    s = (ratio**s - 1) / (ratio - 1)
    return a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1])


def corner(t, c):                                      # from (c, 0) over (c, c) to (0, c), corner at t = 0.5
    return (c, c * math.tan(t * math.pi / 2)) if t <= 0.5 else (c * math.tan((1 - t) * math.pi / 2), c)


def around(t, c):                                      # the whole square from (c, 0), corners at t = 1/8, 3/8, ...
    side, w = int((t * 4 + 0.5) % 4), math.tan(((t * 4 + 0.5) % 1 * 2 - 1) * math.pi / 4)
    return [(c, c * w), (-c * w, c), (-c, -c * w), (c * w, -c)][side]


def circle(t, r, turn):
    return r * math.cos(turn * t), r * math.sin(turn * t)


def case_of(name, n):
    """map, (na, nb[, nc]), periodic, E, nu, plane type, prescribed (node place -> {dof: value}), loaded [(side, traction)], u, s"""
    quarter, tiny = math.pi / 2, 1e-9
    if name == 'cantilever':
        E, nu = 3e7, 0.3
        u, s = beam(E, nu)
        fixed = lambda x, y: dict(enumerate(u(x, y), 1)) if abs(x) < tiny else {}
        return dict(map=lambda a, b: (48 * a, 12 * b - 6), n=(4 * n, n), E=E, nu=nu, fixed=fixed, u=u, s=s, loads=[('a1', lambda x, y: (0.0, s(x, y)[2]))])
    if name == 'kirsch':
        u, s = kirsch()
        def pull(x, y):
            xx, yy, xy = s(x, y)
            return (xx, xy) if abs(x - 5) < 1e-6 else (xy, yy)
        fixed = lambda x, y: {k: 0.0 for k, c in ((1, x), (2, y)) if abs(c) < tiny}
        return dict(map=lambda a, b: ring(a, b, lambda t: circle(t, 1, quarter), lambda t: corner(t, 5)), n=(n, n), E=1e5, nu=0.3, fixed=fixed, u=u, s=s, loads=[('a1', pull)])
    if name in ('lame', 'lame_strain'):
        strain, E, nu = name != 'lame', 1.0, 0.3
        u, s = lame(E / (1 - nu * nu), nu / (1 - nu)) if strain else lame(E, nu)
        fixed = lambda x, y: {k: 0.0 for k, c in ((1, x), (2, y)) if abs(c) < tiny}
        return dict(map=lambda a, b: ring(a, b, lambda t: circle(t, 1, quarter), lambda t: circle(t, 2, quarter)), n=(n, 2 * n), E=E, nu=nu, strain=strain,
                    fixed=fixed, u=u, s=s, loads=[('a0', lambda x, y: (x / math.hypot(x, y), y / math.hypot(x, y)))])
    if name in ('plate_clamped', 'plate_sliding'):     # 50 mm, hole 5 mm, u2 = +-1 mm on y = +-25 mm; in mm and MPa
        def fixed(x, y):
            if abs(abs(y) - 25) > 1e-6: return {}
            return {**({1: 0.0} if name == 'plate_clamped' or abs(x) < 1e-6 and y > 0 else {}), 2: math.copysign(1.0, y)}
        return dict(map=lambda a, b: ring(a, b, lambda t: circle(t, 5, 4 * quarter), lambda t: around(t, 25)), n=(n, 8 * n), periodic=True, E=192e3, nu=1 / 3, fixed=fixed, loads=[])
    if name == 'bending_3d':                           # 4 x 1 x 1, E = 200 GPa, curvature 1e-3 / m
        E, nu, u = 2e11, 0.3, block()
        fixed = lambda x, y, z: dict(enumerate(u(x, y, z), 1)) if abs(x) < tiny else {}
        return dict(map=lambda a, b, c: (4 * a, b - 0.5, c - 0.5), n=(4 * n, n, n), E=E, nu=nu, fixed=fixed, u=u, loads=[('a1', lambda x, y, z: (E * 1e-3 * y, 0.0, 0.0))])
    if name in ('cantilever_3d', 'cantilever_3d_long'):  # the beam in plane strain between smooth walls z = 0 and z = 6
        E, nu = 3e7, 0.3
        u, s = beam(E / (1 - nu * nu), nu / (1 - nu))
        def fixed(x, y, z):
            at = dict(enumerate(u(x, y), 1)) if abs(x) < tiny else {}
            return {**at, 3: 0.0} if abs(x) < tiny or abs(z) < tiny or abs(z - 6) < tiny else at
        sizes = (4 * n, n, max(1, n // 2)) if name == 'cantilever_3d' else (2 * n, n, 1)
        return dict(map=lambda a, b, c: (48 * a, 12 * b - 6, 6 * c), n=sizes, E=E, nu=nu, fixed=fixed, u=lambda x, y, z: u(x, y) + (0.0,), s=s,
                    loads=[('a1', lambda x, y, z: (0.0, s(x, y)[2], 0.0))])
    sys.exit(f'make_mesh.py: there is no case {name}')


# ---- meshes on the doubled grid: linear elements use its even nodes --------------------------------------------------------
HEX20 = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2), (1, 0, 0), (2, 1, 0), (1, 2, 0), (0, 1, 0),
         (1, 0, 2), (2, 1, 2), (1, 2, 2), (0, 1, 2), (0, 0, 1), (2, 0, 1), (2, 2, 1), (0, 2, 1)]
QUAD8 = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1)]
TRI6 = [[(0, 0), (2, 0), (2, 2), (1, 0), (2, 1), (1, 1)], [(0, 0), (2, 2), (0, 2), (1, 1), (1, 2), (0, 1)]]


def patterns(element):
    """local nodes of each element in a cell of the doubled grid, order, dimension"""
    kind = element.rstrip('RI')
    table = {'CPS4': ([QUAD8[:4]], 1), 'CPS8': ([QUAD8], 2), 'CPS3': ([t[:3] for t in TRI6], 1), 'CPS6': (TRI6, 2), 'C3D8': ([HEX20[:8]], 1), 'C3D20': ([HEX20], 2)}
    if kind not in table: sys.exit(f'make_mesh.py: there is no element {element}')
    return table[kind] + (3 if kind.startswith('C3D') else 2,)


def build(case, element):
    cells, order, dim = patterns(element)
    n, wrap = case['n'], case.get('periodic')
    if len(n) != dim: sys.exit(f'make_mesh.py: {element} has another dimension than the case')
    number, places, elements = {}, [], []
    def node(g):
        if wrap: g = (g[0], g[1] % (2 * n[1])) + g[2:]
        if g not in number:
            number[g] = len(number) + 1
            places.append(case['map'](*(g[k] / (2 * n[k]) for k in range(dim))))
        return number[g]
    for e in range(math.prod(n)):
        at = [2 * (e // math.prod(n[:k]) % n[k]) for k in range(dim)]
        for cell in cells: elements.append([node(tuple(a + b for a, b in zip(at, p))) for p in cell])
    return number, places, elements, order, dim


def shapes(order, x):                                  # bar of 2 or 3 nodes: N, dN at x; nodes at -1, 1[, 0]
    if order == 1: return [(1 - x) / 2, (1 + x) / 2], [-0.5, 0.5]
    return [x * (x - 1) / 2, x * (x + 1) / 2, 1 - x * x], [x - 0.5, x + 0.5, -2 * x]


def forces(case, number, places, order, dim):
    """consistent nodal forces {(node, dof): value}"""
    sums, n = {}, case['n']
    def add(nodes, N, traction, weight):
        for i, shape in zip(nodes, N):
            for k, t in enumerate(traction, 1): sums[i, k] = sums.get((i, k), 0.0) + shape * t * weight
    for side, traction in case['loads']:
        first = 0 if side == 'a0' else 2 * n[0]
        steps = (0, 2) if order == 1 else (0, 2, 1)
        if dim == 2:
            for e in range(n[1]):
                nodes = [number[first, (2 * e + s) % (2 * n[1] if case.get('periodic') else 4 * n[1])] for s in steps]
                x = [places[i - 1] for i in nodes]
                for g, w in GAUSS:
                    N, D = shapes(order, g)
                    at = [sum(a * p[k] for a, p in zip(N, x)) for k in range(2)]
                    size = math.hypot(*(sum(a * p[k] for a, p in zip(D, x)) for k in range(2)))
                    add(nodes, N, traction(*at), w * size * THICK)
        else: face_forces(case, number, places, order, first, traction, add)
    return sums


def serendipity(order, a, b):                          # face of 4 or 8 nodes, order of QUAD8
    if order == 1: return [(1 + s * a) * (1 + t * b) / 4 for s, t in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    N = [(1 + s * a) * (1 + t * b) * (s * a + t * b - 1) / 4 for s, t in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    return N + [(1 - a * a) * (1 - b) / 2, (1 + a) * (1 - b * b) / 2, (1 - a * a) * (1 + b) / 2, (1 - a) * (1 - b * b) / 2]


def face_forces(case, number, places, order, first, traction, add):      # plane faces of boxes
    n = case['n']
    for e in range(n[1] * n[2]):
        at = 2 * (e % n[1]), 2 * (e // n[1])
        nodes = [number[first, at[0] + p[0], at[1] + p[1]] for p in QUAD8[:4 if order == 1 else 8]]
        x = [places[i - 1] for i in nodes]
        size = (x[1][1] - x[0][1]) * (x[3][2] - x[0][2]) / 4
        for a, wa in GAUSS:
            for b, wb in GAUSS:
                N = serendipity(order, a, b)
                add(nodes, N, traction(*(sum(s * p[k] for s, p in zip(N, x)) for k in range(3))), wa * wb * size)


def write(name, element, n, out):
    case = case_of(name, n)
    number, places, elements, order, dim = build(case, element)
    say = lambda *words: print(*words, sep=', ', file=out)
    kind = element.replace('CPS', 'CPE') if case.get('strain') else element
    say(f'** {name} {element} {n}: made by make_mesh.py')
    say('*NODE, NSET=NALL')
    for i, p in enumerate(places, 1): say(i, *(f'{c:.12g}' for c in p + (0.0,) * (3 - dim)))
    say(f'*ELEMENT, TYPE={kind}, ELSET=BODY')
    for e, nodes in enumerate(elements, 1):
        for k in range(0, len(nodes), 10): say(*([e] if k == 0 else []), str(nodes[k:k + 10])[1:-1] + (',' if k + 10 < len(nodes) else ''))
    say('*MATERIAL, NAME=M\n*ELASTIC')
    say(f'{case["E"]:.12g}', f'{case["nu"]:.12g}')
    say('*SOLID SECTION, ELSET=BODY, MATERIAL=M' + (f'\n{THICK}' if dim == 2 else ''))
    say('*STEP\n*STATIC\n*BOUNDARY')
    for i, p in enumerate(places, 1):
        for k, v in case['fixed'](*p).items(): say(i, k, k, f'{v:.12g}')
    loads = forces(case, number, places, order, dim)
    if loads: say('*CLOAD')
    for (i, k), v in sorted(loads.items()):
        if v: say(i, k, f'{v:.12g}')
    two = ', OUTPUT=2D' if dim == 2 else ''
    say(f'*NODE FILE{two}\nU\n*EL FILE{two}\nS\n*END STEP')


# ---- check of a result by other code than Perigal's ------------------------------------------------------------------------
def displacements(path):
    values, reading = {}, False
    for line in open(path):
        if line.startswith(' -4  DISP'): reading, values = True, {}
        elif line.startswith(' -3'): reading = False
        elif reading and line.startswith(' -1'): values[int(line[3:13])] = [float(line[13 + 12 * k:25 + 12 * k]) for k in range(3)]
    return values


def quad_shapes(order, a, b):
    if order == 1:
        return (serendipity(1, a, b), [s * (1 + t * b) / 4 for s, t in ((-1, -1), (1, -1), (1, 1), (-1, 1))],
                [t * (1 + s * a) / 4 for s, t in ((-1, -1), (1, -1), (1, 1), (-1, 1))])
    step = 1e-6                                        # derivatives of quadratics by central differences are exact up to rounding
    da = [(p - m) / (2 * step) for p, m in zip(serendipity(2, a + step, b), serendipity(2, a - step, b))]
    db = [(p - m) / (2 * step) for p, m in zip(serendipity(2, a, b + step), serendipity(2, a, b - step))]
    return serendipity(2, a, b), da, db


def measure(name, element, n, path):
    case = case_of(name, n)
    number, places, elements, order, dim = build(case, element)
    if dim != 2 or element[:4] not in ('CPS4', 'CPS8') or 'u' not in case: sys.exit('make_mesh.py: --measure knows quads with a closed form only')
    got, sums = displacements(path), [0.0] * 4
    E, nu = case['E'], case['nu']
    if case.get('strain'): E, nu = E / (1 - nu * nu), nu / (1 - nu)
    tables = [(quad_shapes(order, a, b), wa * wb) for a, wa in GAUSS for b, wb in GAUSS]
    for nodes in elements:
        x, v = [places[i - 1] for i in nodes], [got[i] for i in nodes]
        for (N, A, B), w in tables:
            dot = lambda S, f, k: sum(c * p[k] for c, p in zip(S, f))
            J = dot(A, x, 0), dot(A, x, 1), dot(B, x, 0), dot(B, x, 1)
            det = J[0] * J[3] - J[1] * J[2]
            grad = lambda k: ((J[3] * dot(A, v, k) - J[1] * dot(B, v, k)) / det, (J[0] * dot(B, v, k) - J[2] * dot(A, v, k)) / det)
            place = dot(N, x, 0), dot(N, x, 1)
            u, s, g = case['u'](*place), case['s'](*place), (grad(0), grad(1))
            exx, eyy, exy = g[0][0], g[1][1], g[0][1] + g[1][0]
            c = E / (1 - nu * nu)
            d = c * (exx + nu * eyy) - s[0], c * (eyy + nu * exx) - s[1], E / (2 + 2 * nu) * exy - s[2]
            energy = lambda t: (t[0]**2 + t[1]**2 - 2 * nu * t[0] * t[1] + 2 * (1 + nu) * t[2]**2) / E
            for k, term in enumerate((sum((dot(N, v, c) - u[c])**2 for c in range(2)), u[0]**2 + u[1]**2, energy(d), energy(s))): sums[k] += term * w * det
    print(f'{name},{element},{n},{len(elements)},{math.sqrt(sums[0] / sums[1]):.6g},{math.sqrt(sums[2] / sums[3]):.6g}')


if __name__ == '__main__':
    words = sys.argv[1:]
    result = words.pop(words.index('--measure') + 1) if '--measure' in words else None
    if result: words.remove('--measure')
    if len(words) not in (3, 4) or not words[2].isdigit() or int(words[2]) < 1: sys.exit(__doc__)
    if result: measure(words[0], words[1], int(words[2]), result)
    elif len(words) == 4:
        with open(words[3], 'w') as out: write(words[0], words[1], int(words[2]), out)
    else: write(words[0], words[1], int(words[2]), sys.stdout)

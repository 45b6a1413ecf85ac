#!/usr/bin/env python3
"""Stress intensities, crack paths and load curves by finite elements with remeshing: nothing here is shared with Perigal.

    reference.py path        two cracks grow in steps: slanted.csv, into_hole.csv
    reference.py intensity   K_I, K_II of the bodies of bench/fracture at given lengths: intensity.csv
    reference.py check       the same for a body whose K is known to four digits

Needs gmsh and CalculiX (apt-get install gmsh calculix-ccx). Every step: gmsh meshes the body with triangles of six nodes whose edges lie
on the crack, fine around the tips; the nodes of the crack are doubled here; CalculiX solves; J and the interaction integrals over a ring
around the tip give K_I and K_II; the crack grows straight by one step in the direction of the largest hoop stress.

All bodies are loaded by tractions alone, so that stresses and K depend neither on Poisson's ratio nor on plane stress or strain. Lengths in
widths of the body, stresses in units of the nominal stress, modulus 1.
"""
import math
import os
import subprocess
import sys
import tempfile

NU = 0.3
PRIME = 1 / (1 - NU * NU)               # E' of plane strain, which CalculiX's plane elements meet exactly
HERE = os.path.dirname(os.path.abspath(__file__))


# ---- mesh --------------------------------------------------------------------------------------------------------------
def mesh(outline, holes, cracks, fine, coarse):
    """(nodes {id: (x, y)}, triangles of six nodes, lines {edge: [three nodes]}) of a body whose cracks (lists of places, first the mouth) are
    open: their nodes are doubled. fine: size of the elements at the ends of the cracks; coarse: elsewhere at most."""
    lines, points, curves = [], 0, 0

    def point(p):
        nonlocal points
        points += 1
        lines.append("Point(%d) = {%.12g, %.12g, 0};" % (points, *p))
        return points

    def line(a, b):
        nonlocal curves
        curves += 1
        lines.append("Line(%d) = {%d, %d};" % (curves, a, b))
        return curves

    corner = {}
    for v in outline:
        corner[v] = point(v)
    ring, edges = [], []
    for k, v in enumerate(outline):                            # a mouth on an edge becomes a vertex of it
        w = outline[(k + 1) % len(outline)]
        on = sorted((math.hypot(c[0][0] - v[0], c[0][1] - v[1]), c[0]) for c in cracks if on_edge(v, w, c[0]) and c[0] not in corner)
        stops = [v] + [p for _, p in on] + [w]
        for p in stops[1:-1]:
            corner[p] = point(p)
        edges.append([line(corner[a], corner[b]) for a, b in zip(stops, stops[1:])])
        ring += edges[-1]
    lines.append("Curve Loop(1) = {%s};" % ", ".join(map(str, ring)))
    loops = [1]
    for k, (centre, radius) in enumerate(holes):
        c = point(centre)
        rim = [point((centre[0] + radius * math.cos(t), centre[1] + radius * math.sin(t))) for t in (0, math.pi / 2, math.pi, 1.5 * math.pi)]
        arcs = []
        for a, b in zip(rim, rim[1:] + rim[:1]):
            curves += 1
            lines.append("Circle(%d) = {%d, %d, %d};" % (curves, a, c, b))
            arcs.append(curves)
        lines.append("Curve Loop(%d) = {%s};" % (k + 2, ", ".join(map(str, arcs))))
        loops.append(k + 2)
    lines.append("Plane Surface(1) = {%s};" % ", ".join(map(str, loops)))
    tips, slits = [], []
    for crack in cracks:
        ids = [corner[crack[0]] if crack[0] in corner else point(crack[0])] + [point(p) for p in crack[1:]]
        slits.append([line(a, b) for a, b in zip(ids, ids[1:])])
        lines.append("Curve{%s} In Surface{1};" % ", ".join(map(str, slits[-1])))
        tips += [crack[-1]] + ([crack[0]] if crack[0] not in corner else [])
    size = ["%.6g + 0.12*Sqrt((x-(%.12g))*(x-(%.12g)) + (y-(%.12g))*(y-(%.12g)))" % (fine, t[0], t[0], t[1], t[1]) for t in tips]
    for k, s in enumerate(size):
        lines += ["Field[%d] = MathEval;" % (k + 1), 'Field[%d].F = "%s";' % (k + 1, s)]
    n = len(size)
    lines += ["Field[%d] = MathEval;" % (n + 1), 'Field[%d].F = "%.6g";' % (n + 1, coarse), "Field[%d] = Min;" % (n + 2),
              "Field[%d].FieldsList = {%s};" % (n + 2, ", ".join(str(k + 1) for k in range(n + 1))), "Background Field = %d;" % (n + 2),
              "Mesh.CharacteristicLengthExtendFromBoundary = 0;", "Mesh.CharacteristicLengthFromPoints = 0;", "Mesh.MshFileVersion = 2.2;",
              "Mesh.ElementOrder = 2;", "Mesh.SecondOrderLinear = 1;", "Mesh.Algorithm = 5;"]
    for k, e in enumerate(edges):
        lines.append("Physical Curve(%d) = {%s};" % (k + 1, ", ".join(map(str, e))))
    for k, s in enumerate(slits):
        lines.append("Physical Curve(%d) = {%s};" % (1001 + k, ", ".join(map(str, s))))
    lines.append("Physical Surface(5000) = {1};")
    with tempfile.TemporaryDirectory() as folder:
        geo, msh = folder + "/body.geo", folder + "/body.msh"
        with open(geo, "w", encoding="utf-8") as file:
            file.write("\n".join(lines) + "\n")
        subprocess.run(["gmsh", "-2", "-v", "0", geo, "-o", msh], check=True, stdout=subprocess.DEVNULL)
        nodes, triangles, sides = read(msh)
    for k, crack in enumerate(cracks):
        split(nodes, triangles, sides, sides.pop(1001 + k), crack, crack[0] in corner)
    return nodes, triangles, sides


def on_edge(a, b, p):
    length = math.hypot(b[0] - a[0], b[1] - a[1])
    off = ((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])) / length
    along = ((p[0] - a[0]) * (b[0] - a[0]) + (p[1] - a[1]) * (b[1] - a[1])) / length
    return abs(off) < 1e-9 and -1e-9 < along < length + 1e-9


def read(path):
    """gmsh's format 2.2: nodes, triangles of six nodes, three-node lines by physical group."""
    with open(path, encoding="utf-8") as file:
        rows = file.read().split("\n")
    at = rows.index("$Nodes")
    nodes = {}
    for row in rows[at + 2:at + 2 + int(rows[at + 1])]:
        word = row.split()
        nodes[int(word[0])] = (float(word[1]), float(word[2]))
    at = rows.index("$Elements")
    triangles, sides = [], {}
    for row in rows[at + 2:at + 2 + int(rows[at + 1])]:
        word = [int(w) for w in row.split()]
        body = word[3 + word[2]:]
        if word[1] == 9:
            triangles.append(body)
        elif word[1] == 8:
            sides.setdefault(word[3], []).append(body)
    used = {n for t in triangles for n in t}
    return {n: x for n, x in nodes.items() if n in used}, triangles, sides


def split(nodes, triangles, sides, slit, crack, mouth):
    """Doubles the nodes of a crack but its tips; triangles to its right take the doubles."""
    keep = [crack[-1]] + ([] if mouth else [crack[0]])
    double, fresh = {}, max(nodes) + 1
    for n in sorted({n for s in slit for n in s}):
        if min(math.hypot(nodes[n][0] - p[0], nodes[n][1] - p[1]) for p in keep) > 1e-9:
            double[n] = fresh
            nodes[fresh] = nodes[n]
            fresh += 1
    for t in triangles:
        if any(n in double for n in t):
            x = sum(nodes[n][0] for n in t[:3]) / 3, sum(nodes[n][1] for n in t[:3]) / 3
            if side(crack, x) < 0:
                t[:] = [double.get(n, n) for n in t]
    right = {n for t in triangles for n in t}
    for lines in sides.values():                               # the part of the edge right of the mouth
        for s in lines:
            if any(n in double for n in s):
                x = (nodes[s[0]][0] + nodes[s[1]][0]) / 2, (nodes[s[0]][1] + nodes[s[1]][1]) / 2
                if side(crack, x) < 0:
                    s[:] = [double.get(n, n) for n in s]
    assert all(n in right for n in double.values())


def side(crack, x):
    """> 0: x is to the left of the nearest segment."""
    best = None
    for a, b in zip(crack, crack[1:]):
        u, w = (b[0] - a[0], b[1] - a[1]), (x[0] - a[0], x[1] - a[1])
        s = min(1, max(0, (u[0] * w[0] + u[1] * w[1]) / (u[0] ** 2 + u[1] ** 2)))
        d = math.hypot(w[0] - s * u[0], w[1] - s * u[1])
        cross = (u[0] * w[1] - u[1] * w[0]) / math.hypot(*u)
        if best is None or d < best[0] - 1e-12 or (abs(d - best[0]) < 1e-12 and abs(cross) > abs(best[1])):
            best = (d, cross)
    return best[1]


# ---- solution ------------------------------------------------------------------------------------------------------------
def solve(nodes, triangles, sides, loads, pins, held=()):
    """Displacements {node: (x, y)} by CalculiX under tractions (edge from 1: (x, y)); pins: three (place, component) that stop rigid motion;
    held: (edge, (x, y)) of displacements of whole edges, None: free."""
    thick = 0.01
    force = {}
    for edge, (tx, ty) in loads.items():
        for a, b, m in sides[edge]:
            length = math.hypot(nodes[b][0] - nodes[a][0], nodes[b][1] - nodes[a][1])
            for n, share in ((a, 1 / 6), (b, 1 / 6), (m, 2 / 3)):
                old = force.get(n, (0, 0))
                force[n] = (old[0] + share * length * thick * tx, old[1] + share * length * thick * ty)
    text = ["*NODE, NSET=ALL"] + ["%d, %.11g, %.11g, 0" % (n, *x) for n, x in sorted(nodes.items())]
    text += ["*ELEMENT, TYPE=CPE6, ELSET=BODY"]
    text += ["%d, %s" % (k + 1, ", ".join(map(str, t))) for k, t in enumerate(triangles)]
    text += ["*MATERIAL, NAME=M", "*ELASTIC", "1, %g" % NU, "*SOLID SECTION, ELSET=BODY, MATERIAL=M", "%g" % thick, "*STEP", "*STATIC", "*BOUNDARY"]
    for place, k in pins:
        n = min(nodes, key=lambda n: math.hypot(nodes[n][0] - place[0], nodes[n][1] - place[1]))
        text.append("%d, %d, %d" % (n, k, k))
    given = {}
    for edge, vector in held:
        for n in {n for s in sides[edge] for n in s}:
            given.update({(n, k): v for k, v in enumerate(vector) if v is not None and (n, k) not in given})
    text += ["%d, %d, %d, %.12g" % (n, k + 1, k + 1, v) for (n, k), v in sorted(given.items())]
    text.append("*CLOAD")
    for n, f in sorted(force.items()):
        text += ["%d, %d, %.9g" % (n, k + 1, f[k]) for k in (0, 1) if f[k]]
    text += ["*NODE FILE, OUTPUT=2D", "U", "*END STEP", ""]
    with tempfile.TemporaryDirectory() as folder:
        with open(folder + "/body.inp", "w", encoding="utf-8") as file:
            file.write("\n".join(text))
        subprocess.run(["ccx", "-i", "body"], cwd=folder, check=True, stdout=subprocess.DEVNULL)
        found, inside = {}, False
        with open(folder + "/body.frd", encoding="utf-8") as file:
            for row in file:
                if row.startswith(" -4  DISP"):
                    inside = True
                elif inside and row.startswith(" -1"):
                    found[int(row[3:13])] = (float(row[13:25]), float(row[25:37]))
                elif inside and row.startswith(" -3"):
                    break
    return found


# ---- integrals over a ring around a tip -----------------------------------------------------------------------------------
# points (barycentric) and weights of a rule of degree 4
RULE = [(p, w) for a, w in ((0.445948490915965, 0.223381589678011), (0.091576213509771, 0.109951743655322))
        for p in ((a, a, 1 - 2 * a), (a, 1 - 2 * a, a), (1 - 2 * a, a, a))]


def shape_gradients(x, p):
    """Gradients of the six shape functions of a triangle with straight edges at a barycentric place, and its area."""
    (x1, y1), (x2, y2), (x3, y3) = x
    twice = (x2 - x1) * (y3 - y1) - (x3 - x1) * (y2 - y1)
    g = [((y2 - y3) / twice, (x3 - x2) / twice), ((y3 - y1) / twice, (x1 - x3) / twice), ((y1 - y2) / twice, (x2 - x1) / twice)]
    rows = [tuple((4 * p[k] - 1) * c for c in g[k]) for k in range(3)]
    for a, b in ((0, 1), (1, 2), (2, 0)):
        rows.append(tuple(4 * (p[a] * g[b][k] + p[b] * g[a][k]) for k in (0, 1)))
    return rows, abs(twice) / 2


def hooke(e):
    """Plane strain, modulus 1: stress (xx, yy, xy) of a displacement gradient."""
    lame, mu = NU / ((1 + NU) * (1 - 2 * NU)), 1 / (2 * (1 + NU))
    trace = e[0][0] + e[1][1]
    return lame * trace + 2 * mu * e[0][0], lame * trace + 2 * mu * e[1][1], mu * (e[0][1] + e[1][0])


def williams(mode, x, y):
    """Displacement of a tip at the origin, crack along -x, for K = 1."""
    r, t = math.hypot(x, y), math.atan2(y, x)
    mu, kappa = 1 / (2 * (1 + NU)), 3 - 4 * NU
    f, c, s = math.sqrt(r / (2 * math.pi)) / (2 * mu), math.cos(t / 2), math.sin(t / 2)
    if mode == 1:
        return f * c * (kappa - math.cos(t)), f * s * (kappa - math.cos(t))
    return f * s * (kappa + 2 + math.cos(t)), -f * c * (kappa - 2 + math.cos(t))


def williams_gradient(mode, x, y):
    """By central differences: exact to about nine digits."""
    d = 1e-5 * math.hypot(x, y)
    px, mx, py, my = (williams(mode, *v) for v in ((x + d, y), (x - d, y), (x, y + d), (x, y - d)))
    return [[(px[i] - mx[i]) / (2 * d), (py[i] - my[i]) / (2 * d)] for i in (0, 1)]


def intensities(nodes, triangles, u, tip, direction, outer):
    """(J, K_I, K_II) from the ring of the radii 0.3 and 1 times outer around the tip; the crack is straight over outer."""
    c, s = direction
    inner = 0.3 * outer
    total = [0.0, 0.0, 0.0]
    for t in triangles:
        x = [(c * (nodes[n][0] - tip[0]) + s * (nodes[n][1] - tip[1]), -s * (nodes[n][0] - tip[0]) + c * (nodes[n][1] - tip[1])) for n in t[:3]]
        r = [math.hypot(*v) for v in x]
        if min(r) > 1.5 * outer or max(r) < 0.5 * inner:
            continue
        local = [(c * u[n][0] + s * u[n][1], -s * u[n][0] + c * u[n][1]) for n in t]
        for p, w in RULE:
            place = [sum(p[k] * x[k][i] for k in range(3)) for i in (0, 1)]
            rho = math.hypot(*place)
            if not inner < rho < outer:
                continue
            z = (rho - inner) / (outer - inner)
            slope = -6 * z * (1 - z) / (outer - inner) / rho
            q = (slope * place[0], slope * place[1])
            rows, area = shape_gradients(x, p)
            h = [[sum(local[a][i] * rows[a][k] for a in range(6)) for k in (0, 1)] for i in (0, 1)]
            total[0] += w * area * energy_flux(h, h, q) / 2
            for mode in (1, 2):
                total[mode] += w * area * energy_flux(h, williams_gradient(mode, *place), q)
    return total[0], total[1] * PRIME / 2, total[2] * PRIME / 2


def energy_flux(h, a, q):
    """(s_ij a_i,1 + s(a)_ij h_i,1 - s_ij a_i,j delta) q_j: twice the integrand of J where both gradients are the same."""
    sh, sa = hooke(h), hooke(a)
    work = sh[0] * a[0][0] + sh[1] * a[1][1] + sh[2] * (a[0][1] + a[1][0])
    out = 0.0
    for g, st in ((a, sh), (h, sa)):
        out += (st[0] * g[0][0] + st[2] * g[1][0]) * q[0] + (st[2] * g[0][0] + st[1] * g[1][0]) * q[1]
    return out - work * q[0]


def hoop(k1, k2):
    """(angle, K) of the largest hoop stress, by search: no formula is shared."""
    best = max(range(-1400, 1401), key=lambda i: hoop_stress(k1, k2, i * 1e-3))
    fine = max((best + j * 1e-3 for j in range(-1000, 1001)), key=lambda i: hoop_stress(k1, k2, i * 1e-3))
    return fine * 1e-3, hoop_stress(k1, k2, fine * 1e-3)


def hoop_stress(k1, k2, t):
    return math.cos(t / 2) ** 2 * (k1 * math.cos(t / 2) - 3 * k2 * math.sin(t / 2))


# ---- the bodies --------------------------------------------------------------------------------------------------------------
def measure(outline, holes, cracks, loads, pins, outer, fine, coarse, crack=0, start=False, held=()):
    """K of one tip: the end of the crack (start: its first point)."""
    nodes, triangles, sides = mesh(outline, holes, cracks, fine, coarse)
    u = solve(nodes, triangles, sides, loads, pins, held)
    line = cracks[crack][::-1] if start else cracks[crack]
    a, b = line[-2], line[-1]
    length = math.hypot(b[0] - a[0], b[1] - a[1])
    found = intensities(nodes, triangles, u, b, ((b[0] - a[0]) / length, (b[1] - a[1]) / length), outer)
    return found, nodes, u


def opening(nodes, u, mouth):
    """Of the mouth of a crack: between its two nodes."""
    pair = [n for n, x in nodes.items() if math.hypot(x[0] - mouth[0], x[1] - mouth[1]) < 1e-9]
    return math.hypot(u[pair[0]][0] - u[pair[1]][0], u[pair[0]][1] - u[pair[1]][1])


SLANTED = [(0, -1.25), (1, -1.25), (1, 1.25), (0, 1.25)]
TENSION = {1: (0, -1), 3: (0, 1)}
HELD = [((1, 0), 1), ((1, 0), 2), ((1, 1.25), 1)]


def grow(name, outline, holes, crack, pins, steps, first_ring):
    """A crack that grows in steps of 0.014 in the direction of the largest hoop stress; one row per length."""
    step, grown = 0.014, 0.0
    rows = [("x [1]", "y [1]", "length [1]", "K_I/(s sqrt W) [1]", "K_II/(s sqrt W) [1]", "K of growth/(s sqrt W) [1]", "sqrt(E'J)/(s sqrt W) [1]",
             "mouth opening E'/(s W) [1]")]
    first = sum(math.hypot(b[0] - a[0], b[1] - a[1]) for a, b in zip(crack, crack[1:]))
    for k in range(steps + 1):
        outer = first_ring if k == 0 else 0.9 * step
        (j, k1, k2), nodes, u = measure(outline, holes, [crack], TENSION, pins, outer, 0.001, 0.05)
        angle, kt = hoop(k1, k2)
        rows.append(tuple("%.6g" % v for v in (*crack[-1], first + grown, k1, k2, kt, math.sqrt(j * PRIME), PRIME * opening(nodes, u, crack[0]))))
        print(*rows[-1], "%.2f degrees" % math.degrees(angle), len(nodes), flush=True)
        write(name, rows)
        a, b = crack[-2], crack[-1]
        t = math.atan2(b[1] - a[1], b[0] - a[0]) + angle
        crack = crack + [(b[0] + step * math.cos(t), b[1] + step * math.sin(t))]
        grown += step
        if any(math.hypot(crack[-1][0] - c[0], crack[-1][1] - c[1]) < r + step for c, r in holes):
            break


def path():
    """The slanted edge crack from (0.35, 0.15) on, and an edge crack that passes below a hole."""
    grow("slanted.csv", SLANTED, (), [(0.0, -0.2), (0.35, 0.15)], HELD, 25, 0.08)
    grow("into_hole.csv", [(0, -1), (1, -1), (1, 1), (0, 1)], [((0.6, 0.12), 0.1)], [(0.0, 0.0), (0.3, 0.0)], [((1, -1), 1), ((1, -1), 2), ((1, 0.5), 1)],
         40, 0.08)


def write(name, rows):
    with open(os.path.join(HERE, name), "w", encoding="utf-8") as file:
        file.write("".join(", ".join(row) + "\n" for row in rows))


def notch(a):
    outline = [(0, -1.5), (1, -1.5), (1, 1.5), (0, 1.5)]
    return measure(outline, (), [[(0.0, 0.0), (a, 0.0)]], TENSION, HELD, 0.15, 0.001, 0.06)[0]


def bend(a):
    """Force 1 per width and thickness on a tenth of the depth in the middle, half of it on each support."""
    outline = [(-2.2, 0), (-2.05, 0), (-1.95, 0), (1.95, 0), (2.05, 0), (2.2, 0), (2.2, 1), (0.05, 1), (-0.05, 1), (-2.2, 1)]
    loads = {8: (0, -10), 2: (0, 5), 4: (0, 5)}
    return measure(outline, (), [[(0.0, 0.0), (0.0, a)]], loads, [((-2.2, 1), 1), ((-2.2, 1), 2), ((2.2, 1), 2)], 0.15, 0.001, 0.06)[0]


def cantilever(a):
    """Force 1 per width and thickness on the end of each arm of height 1/2."""
    outline = [(0, -0.5), (4.5, -0.5), (4.5, 0.5), (0, 0.5), (0, 0)]
    return measure(outline, (), [[(0, 0), (a, 0.0)]], {5: (0, -2), 4: (0, 2)}, [((4.5, 0), 1), ((4.5, 0), 2), ((4.5, 0.5), 1)], 0.2, 0.001, 0.06)[0]


def inclined(degrees):
    """Half length 1, plate 6 x 6; over stress and the root of pi."""
    b = math.radians(degrees)
    c, s = math.sin(b), math.cos(b)
    outline = [(-3, -3), (3, -3), (3, 3), (-3, 3)]
    j, k1, k2 = measure(outline, (), [[(-c, -s), (0.0, 0.0), (c, s)]], TENSION, [((-3, 0), 1), ((-3, 0), 2), ((3, 0), 2)], 0.5, 0.002, 0.15)[0]
    root = math.sqrt(math.pi)
    return j, k1 / root, k2 / root


def intensity():
    rows = [("body", "length [1]", "K_I [1]", "K_II [1]", "sqrt(E'J) [1]")]
    for name, function, values in (("edge_notch", notch, (0.4, 0.5, 0.6, 0.7)), ("bend", bend, (0.4, 0.5, 0.6, 0.7)),
                                   ("double_cantilever", cantilever, (2.0, 2.25, 2.5)), ("inclined", inclined, (30, 45, 60))):
        for a in values:
            j, k1, k2 = function(a)
            total = math.sqrt(j * PRIME) / (math.sqrt(math.pi) if function is inclined else 1)
            rows.append((name, "%g" % a, "%.5g" % k1, "%.5g" % k2, "%.5g" % total))
            print(*rows[-1], flush=True)
    write("intensity.csv", rows)


def check():
    """Edge notch of half the width: 2.8246 stress sqrt (pi a) (Kaya, Erdogan 1987)."""
    j, k1, k2 = notch(0.5)
    exact = 2.8246 * math.sqrt(math.pi * 0.5)
    print("K_I %.5f, of J %.5f, K_II %.1e; exact %.5f: off by %+.3f %%, %+.3f %%" % (
        k1, math.sqrt(j * PRIME), k2, exact, 100 * (k1 / exact - 1), 100 * (math.sqrt(j * PRIME) / exact - 1)))


if __name__ == "__main__":
    {"path": path, "intensity": intensity, "check": check}[sys.argv[1]]()

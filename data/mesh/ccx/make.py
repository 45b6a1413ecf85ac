#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Patch tests for CalculiX: a block of 2 x 2 (x 2) cells, the vertex inside moved, all of its boundary moved by u = A x. Writes NAME.inp and
runs ccx -i NAME; only the .frd is kept. Nodes in the order of the manual of CalculiX."""
import itertools, os, subprocess
A = [[1e-3, 2e-4, 0], [-1e-4, -3e-4, 1e-4], [5e-5, 0, 2e-4]]
EDGES = {'C3D20': [(0,1),(1,2),(2,3),(3,0),(4,5),(5,6),(6,7),(7,4),(0,4),(1,5),(2,6),(3,7)], 'C3D15': [(0,1),(1,2),(2,0),(3,4),(4,5),(5,3),(0,3),(1,4),(2,5)],
         'C3D10': [(0,1),(1,2),(2,0),(0,3),(1,3),(2,3)], 'C3D8': [], 'C3D6': [], 'C3D4': [], 'CPS8': [(0,1),(1,2),(2,3),(3,0)], 'CPS6': [(0,1),(1,2),(2,0)]}
PARTS = {8: [range(8)], 6: [(0,1,2,4,5,6), (0,2,3,4,6,7)], 4: [(0,1,2,6),(0,2,3,6),(0,3,7,6),(0,7,4,6),(0,4,5,6),(0,5,1,6)]}

def block(kind):
    plane = kind.startswith('CP')
    corners = {'C3D20': 8, 'C3D8': 8, 'C3D15': 6, 'C3D6': 6, 'C3D10': 4, 'C3D4': 4, 'CPS8': 8, 'CPS6': 6}[kind]
    number, place = {}, []
    def node(key, x):
        if key not in number:
            number[key] = len(place) + 1
            place.append(x)
        return number[key]
    def vertex(v):
        x = [float(c) for c in v]
        if v == (1, 1, 1) or (plane and v[:2] == (1, 1)): x = [1.13, 0.91, 0 if plane else 1.07]
        return x
    elements = []
    for c in itertools.product((0,), (0, 1), (0, 1)) if plane else itertools.product((0, 1), repeat=3):
        v = [(c[2] + i, c[1] + j, c[0] + k) for k, (i, j) in itertools.product((0, 1), ((0, 0), (1, 0), (1, 1), (0, 1)))]
        for part in PARTS[corners]:
            e = [v[i] for i in part]
            if plane: e = e[:len(e) // 2]
            n = [node((p, p), vertex(p)) for p in e]
            for a, b in EDGES[kind]:
                p, q = sorted((e[a], e[b]))
                n.append(node((p, q), [(s + t) / 2 for s, t in zip(vertex(p), vertex(q))]))
            elements.append(n)
    return plane, place, elements

def write(name, kind, output, steps=1, options=''):
    plane, place, elements = block(kind)
    with open(name + '.inp', 'w') as f:
        f.write('*NODE, NSET=ALL\n' + ''.join(f'{i}, {x[0]:.8g}, {x[1]:.8g}, {x[2]:.8g}\n' for i, x in enumerate(place, 1)))
        f.write(f'*ELEMENT, TYPE={kind}, ELSET=BODY\n')
        for k, n in enumerate(elements, 1):
            words = [str(w) for w in [k] + n]
            f.write(',\n'.join(', '.join(words[s:s + 12]) for s in range(0, len(words), 12)) + '\n')
        f.write('*MATERIAL, NAME=STEEL\n*ELASTIC\n210e3, 0.3\n*SOLID SECTION, ELSET=BODY, MATERIAL=STEEL\n' + ('0.25\n' if plane else ''))
        for step in range(1, steps + 1):
            f.write('*STEP\n*STATIC\n*BOUNDARY\n')
            for i, x in enumerate(place, 1):
                if not any(abs(t) < 1e-9 or abs(t - 2) < 1e-9 for t in x[:2 if plane else 3]): continue
                for a in range(2 if plane else 3): f.write(f'{i}, {a + 1}, {a + 1}, {step * sum(A[a][b] * x[b] for b in range(3)):.9g}\n')
            f.write(f'*NODE {output}{options}\nU\n*{"ELEMENT" if output == "OUTPUT" else "EL"} {output}{options}\nS, E\n*END STEP\n')
    try:
        subprocess.run(['ccx', '-i', name], check=True, stdout=subprocess.DEVNULL)
    finally:
        if os.path.exists('spooles.out'): os.remove('spooles.out')
    for end in ('inp', 'sta', 'cvg', 'dat', '12d'):
        if os.path.exists(f'{name}.{end}'): os.remove(f'{name}.{end}')

os.chdir(os.path.dirname(os.path.abspath(__file__)))
for kind in ('C3D20', 'C3D15', 'C3D10', 'C3D8', 'C3D6', 'C3D4'): write(kind.lower(), kind, 'FILE')
write('c3d20_binary', 'C3D20', 'OUTPUT')
write('cps8_steps', 'CPS8', 'FILE', steps=2)
write('cps8_solid', 'CPS8', 'OUTPUT', options=', OUTPUT=3D')
write('cps6_solid', 'CPS6', 'FILE', options=', OUTPUT=3D')

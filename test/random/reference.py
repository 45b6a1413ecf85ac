"""Strain energy of an elastic random scene by finite elements: quadratic triangles or tetrahedra of Gmsh, solved by CalculiX.

Only scenes whose boundary conditions act on whole sides of a box, or on the whole body, have a reference: those sides are the same in both programs.
"""
import os
import shutil
import subprocess

SIDES = {'left': (0, 0), 'right': (0, 1), 'bottom': (1, 0), 'top': (1, 1), 'back': (2, 0), 'front': (2, 1)}
EDGE = (1 / 6, 1 / 6, 4 / 6)                              # of a constant traction on three nodes of an edge, on six of a face
FACE = (0.0, 0.0, 0.0, 1 / 3, 1 / 3, 1 / 3)
MOST_NODES = 40000


def available():
    return bool(shutil.which('gmsh') and shutil.which('ccx'))


def serves(data):
    """Are the body, the material and all conditions of a kind that the mesh can have?"""
    if data.get('cracks') or 'stages' in data or len(data['materials']) > 1 or 'points' in data or 'body' not in data:
        return False
    if any('temperature' in load or 'pressure' in load for load in data['boundary']):
        return False
    if any('model' in m for m in data['materials'].values()):
        return False
    if 'box' not in data['body'][0].get('add', {}):
        return False
    for part in data['body'][1:]:
        shape, values = next(iter(part.get('subtract', {'none': {}}).items()))
        if shape not in ('box', 'disk', 'cylinder'):
            return False
        if shape == 'box' and min(b - a for a, b in zip(values['low'], values['high'])) < data['spacing']:
            return False                                 # a slot that the points do not resolve
    held = {}
    for load in data['boundary']:
        for axis, value in load.get('displacement', {}).items():
            held.setdefault(axis, set()).add(value)
        if 'spring' in load or not ('gravity' in load or 'body_force' in load and load.get('set', 'all') == 'all' or load.get('set') in SIDES):
            return False
    sides = [load['set'] for load in data['boundary'] if 'displacement' in load]
    opposite = len(sides) == 2 and SIDES[sides[0]][0] == SIDES[sides[1]][0]
    return opposite or all(len(values) == 1 for values in held.values())    # two values at one edge: its energy is infinite


def box_of(data):
    box = data['body'][0]['add']['box']
    return box['low'], box['high']


def geometry(data, size):
    """The body for Gmsh (OpenCASCADE), elements so large."""
    d = data['dimension']
    low, high = box_of(data)
    lines = ['SetFactory("OpenCASCADE");', f'Mesh.CharacteristicLengthMax = {size!r};', 'Mesh.ElementOrder = 2;', 'Mesh.SecondOrderLinear = 0;',
             'Mesh.MshFileVersion = 2.2;', f'Mesh.CharacteristicLengthFromCurvature = {"12" if d == 2 else "8"};']
    extent = [b - a for a, b in zip(low, high)]
    if d == 2:
        lines.append(f'Rectangle(1) = {{{low[0]!r}, {low[1]!r}, 0, {extent[0]!r}, {extent[1]!r}}};')
    else:
        lines.append('Box(1) = {' + ', '.join(repr(v) for v in list(low) + extent) + '};')
    what = 'Surface' if d == 2 else 'Volume'
    for k, part in enumerate(data['body'][1:], 2):
        shape, v = next(iter(part['subtract'].items()))
        if shape == 'box':
            size_of = [b - a for a, b in zip(v['low'], v['high'])]
            if d == 2:
                lines.append(f'Rectangle({k}) = {{{v["low"][0]!r}, {v["low"][1]!r}, 0, {size_of[0]!r}, {size_of[1]!r}}};')
            else:
                lines.append(f'Box({k}) = {{' + ', '.join(repr(c) for c in v['low'] + size_of) + '};')
        elif shape == 'disk':
            lines.append(f'Disk({k}) = {{{v["center"][0]!r}, {v["center"][1]!r}, 0, {v["radius"]!r}, {v["radius"]!r}}};')
        else:
            lines.append(f'Cylinder({k}) = {{' + ', '.join(repr(c) for c in v['center'] + [0.0, 0.0, v['length'], v['radius']]) + '};')
    others = len(data['body']) - 1
    if others:
        lines.append(f'BooleanDifference {{ {what}{{1}}; Delete; }}{{ {what}{{2:{others + 1}}}; Delete; }}')
    return '\n'.join(lines) + '\n'


def turns_left(p):
    return (p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) > (p[1][1] - p[0][1]) * (p[2][0] - p[0][0])


def read_mesh(path, dimension):
    """Nodes {number: place}, elements, pieces of the surface, each a list of node numbers."""
    of_bulk, of_surface = (9, 8) if dimension == 2 else (11, 9)
    nodes, bulk, surface = {}, [], []
    with open(path, encoding='ascii') as file:
        lines = iter(file.read().splitlines())
    for line in lines:
        if line == '$Nodes':
            for _ in range(int(next(lines))):
                number, *place = next(lines).split()
                nodes[int(number)] = [float(v) for v in place]
        elif line == '$Elements':
            for _ in range(int(next(lines))):
                words = [int(v) for v in next(lines).split()]
                kind, at = words[1], words[3 + words[2]:]
                if kind == of_bulk:
                    bulk.append(at if dimension == 2 else at[:8] + [at[9], at[8]])
                elif kind == of_surface:
                    surface.append(at)
    if dimension == 2:                                   # counterclockwise
        bulk = [e if turns_left([nodes[n] for n in e[:3]]) else [e[0], e[2], e[1], e[5], e[4], e[3]] for e in bulk]
    used = {n for e in bulk for n in e}
    return {n: nodes[n] for n in sorted(used)}, bulk, surface


def area(places, dimension):
    a, b = places[0], places[1]
    if dimension == 2:
        return sum((p - q) ** 2 for p, q in zip(a, b)) ** 0.5
    u, v = [q - p for p, q in zip(a, b)], [q - p for p, q in zip(a, places[2])]
    n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
    return 0.5 * sum(c * c for c in n) ** 0.5


def pieces_of(data, mesh, side):
    nodes, _, surface = mesh
    axis, end = SIDES[side]
    at, near = box_of(data)[end][axis], 1e-6 * (box_of(data)[1][axis] - box_of(data)[0][axis])
    return [s for s in surface if all(abs(nodes[n][axis] - at) < near for n in s if n in nodes) and all(n in nodes for n in s)]


def number(value):
    """CalculiX reads twenty characters of a number."""
    return f'{value:.12e}'


def thin_of(data):
    """CalculiX makes solid elements of plane ones, which resist that their thickness varies: of a thin body hardly."""
    return 1e-3 * min(b - a for a, b in zip(*box_of(data)))


def input_of(data, mesh):
    """The input file of CalculiX."""
    d = data['dimension']
    nodes, bulk, _ = mesh
    material = next(iter(data['materials'].values()))
    thickness, thin = (data.get('thickness', 1.0), thin_of(data)) if d == 2 else (1.0, 1.0)
    kind = {2: 'CPS6' if data.get('plane', 'stress') == 'stress' else 'CPE6', 3: 'C3D10'}[d]
    text = ['*NODE, NSET=ALL'] + [f'{n}, ' + ', '.join(number(v) for v in p) for n, p in nodes.items()]
    text += [f'*ELEMENT, TYPE={kind}, ELSET=BODY'] + [f'{k}, ' + ', '.join(str(n) for n in e) for k, e in enumerate(bulk, 1)]
    text += ['*MATERIAL, NAME=ROCK', '*ELASTIC', f'{number(material["youngs_modulus"])}, {number(material["poissons_ratio"])}', '*DENSITY', number(material['density'])]
    text += ['*SOLID SECTION, ELSET=BODY, MATERIAL=ROCK', number(thin)]
    held, force, body = {}, {}, [0.0] * 3
    for load in data['boundary']:
        if 'gravity' in load:
            body = [b + material['density'] * g for b, g in zip(body, load['gravity'] + [0.0])]
        elif 'body_force' in load:
            body = [b + load['body_force'].get(a, 0.0) for b, a in zip(body, 'xyz')]
        else:
            pieces = pieces_of(data, mesh, load['set'])
            if 'displacement' in load:
                for n in {n for s in pieces for n in s}:
                    for a, v in load['displacement'].items():
                        held[n, 'xyz'.index(a)] = v
                continue
            whole = sum(area([nodes[n] for n in s], d) for s in pieces) * thickness
            for s in pieces:
                share = area([nodes[n] for n in s], d) * thickness / (whole if 'force' in load else 1.0)
                for n, w in zip(s, EDGE if d == 2 else FACE):
                    for a, v in load.get('force', load.get('traction')).items():
                        force[n, 'xyz'.index(a)] = force.get((n, 'xyz'.index(a)), 0.0) + w * share * v
    text += ['*STEP', '*STATIC', '*BOUNDARY'] + [f'{n}, {k + 1}, {k + 1}, {number(v)}' for (n, k), v in held.items()]
    if force:
        text += ['*CLOAD'] + [f'{n}, {k + 1}, {number(v * thin / thickness)}' for (n, k), v in force.items()]
    size = sum(b * b for b in body) ** 0.5
    if size:
        text += ['*DLOAD', 'BODY, GRAV, ' + ', '.join(number(v) for v in [size / material['density']] + [b / size for b in body])]
    text += ['*EL PRINT, ELSET=BODY, TOTALS=ONLY', 'ELSE', '*END STEP', '']
    return '\n'.join(text)


def energy(data, folder, size):
    """Strain energy, J, by elements of that size; None where the mesh would be too large or a program fails."""
    os.makedirs(folder, exist_ok=True)
    with open(os.path.join(folder, 'body.geo'), 'w', encoding='ascii') as file:
        file.write(geometry(data, size))
    d = data['dimension']
    quiet = {'cwd': folder, 'stdout': subprocess.PIPE, 'stderr': subprocess.STDOUT, 'check': False, 'timeout': 120}
    try:
        if subprocess.run(['gmsh', f'-{d}', 'body.geo', '-o', 'body.msh'], **quiet).returncode:
            return None
        mesh = read_mesh(os.path.join(folder, 'body.msh'), d)
        if not mesh[1] or len(mesh[0]) > MOST_NODES:
            return None
        with open(os.path.join(folder, 'body.inp'), 'w', encoding='ascii') as file:
            file.write(input_of(data, mesh))
        subprocess.run(['ccx', '-i', 'body'], env={**os.environ, 'OMP_NUM_THREADS': '1'}, **quiet)
        with open(os.path.join(folder, 'body.dat'), encoding='ascii') as file:
            found = [line.split() for line in file if line.strip()]
    except (OSError, subprocess.TimeoutExpired):
        return None
    for k, words in enumerate(found):
        if 'energy' in words:
            for later in found[k + 1:]:
                try:
                    return float(later[-1]) * (data.get('thickness', 1.0) / thin_of(data) if d == 2 else 1.0)
                except ValueError:
                    continue
    return None

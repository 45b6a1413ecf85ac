"""Scenes of the matrix, as dictionaries: bodies with a known answer, clouds and meshes that no lattice makes.

A scene is written as JSON, which YAML contains. Lengths are in units of 1 m, stresses of 1 GPa, unless a condition scales them.
"""
import copy
import json
import math
import os
import random

MODULUS = 1e9
STRESS = 1e6


def merged(scene, changes):
    """The scene with the changes of a method or a condition laid over it, map by map."""
    result = copy.deepcopy(scene)
    for key, value in changes.items():
        if isinstance(value, dict) and isinstance(result.get(key), dict):
            result[key] = merged(result[key], value)
        else:
            result[key] = copy.deepcopy(value)
    return result


def write(scene, folder, files=()):
    os.makedirs(folder, exist_ok=True)
    for name, text in files:
        with open(os.path.join(folder, name), 'w') as out:
            out.write(text)
    path = os.path.join(folder, 'scene.yaml')
    with open(path, 'w') as out:
        json.dump(scene, out)
    return path


def number(value):
    return f'{value:.17g}'


def tension(dimension, plane, nu, size=(1, 1, 1), spacing=0.1, stress=STRESS, modulus=MODULUS, low=(0, 0, 0)):
    """Uniform tension along x on rollers: the answer is linear in the coordinates, whatever the shape of the box."""
    axes = 'xyz'[:dimension]
    side = dict(zip(axes, ('left', 'bottom', 'back')))
    strain = {'x': stress / modulus, 'y': -nu * stress / modulus, 'z': -nu * stress / modulus}
    if dimension == 2 and plane == 'strain':
        strain = {'x': (1 - nu * nu) * stress / modulus, 'y': -nu * (1 + nu) * stress / modulus}
    scene = {
        'dimension': dimension,
        'body': [{'add': {'box': {'low': list(low[:dimension]), 'high': [low[k] + size[k] for k in range(dimension)]}}}],
        'spacing': spacing,
        'materials': {'m': {'youngs_modulus': modulus, 'poissons_ratio': nu, 'density': 2500}},
        'boundary': [{'name': f'hold_{a}', 'set': side[a], 'displacement': {a: 0}} for a in axes]
        + [{'name': 'pull', 'set': 'right', 'traction': {'x': stress}}],
        'solver': {'kind': 'static'},
        'output': {'at': {'levels': 1}, 'pictures': []},
        'reference': {'displacement': {a: f'{number(strain[a])}*({a} - {number(low[k])})' for k, a in enumerate(axes)}},
    }
    if dimension == 2:
        scene['plane'], scene['thickness'] = plane, 1
    return scene


def notched(spacing=0.05, offset=(0, 0), width=1.0, crack=0.5, half_height=2.0, nu=0.25, stress=STRESS, modulus=MODULUS):
    """Single edge notch in tension; the crack mouth opens by 9.8809 stress width / modulus at crack = width / 2, half height 2 width."""
    return {
        'dimension': 2, 'plane': 'stress', 'thickness': 1,
        'body': [{'add': {'box': {'low': [0, -half_height * width], 'high': [width, half_height * width]}}}],
        'spacing': spacing, 'lattice': 'cells', 'lattice_offset': list(offset),
        'cracks': [{'from': [-0.1 * width, 0], 'to': [crack * width, 0]}],
        'materials': {'m': {'youngs_modulus': modulus, 'poissons_ratio': nu, 'density': 2500}},
        'sets': {'pin': {'where': f'x > {0.99 * width - spacing} and abs(y) < {1.01 * spacing}'}},
        'boundary': [{'name': 'top', 'set': 'top', 'traction': {'y': stress}}, {'name': 'bottom', 'set': 'bottom', 'traction': {'y': -stress}},
                     {'name': 'pin', 'set': 'pin', 'displacement': {'x': 0, 'y': 0}, 'essential': 'penalty'}],
        'solver': {'kind': 'static'},
        'output': {'at': {'levels': 1}, 'pictures': [],
                   'gauges': [{'name': 'mouth', 'from': [0, -0.01 * width], 'to': [0, 0.01 * width]}]},
    }


def plate(spacing=0.1, nu=1 / 3, stretch=2e-3, modulus=72e9, scale=1.0):
    """A square plate with an edge crack, drawn apart at its ends until it has separated: events, in m."""
    s = scale
    return {
        'dimension': 2, 'plane': 'stress', 'thickness': s,
        'body': [{'add': {'box': {'low': [-s, -s], 'high': [s, s]}}}], 'spacing': spacing * s, 'lattice': 'cells',
        'cracks': [{'from': [-1.1 * s, 0], 'to': [0, 0]}],
        'materials': {'m': {'youngs_modulus': modulus, 'poissons_ratio': nu, 'density': 2440}},
        'failure': {'criterion': 'stretch', 'critical_stretch': stretch, 'exclude': ['top_grip', 'bottom_grip']},
        'sets': {'top_grip': {'where': f'y >= {0.7 * s}'}, 'bottom_grip': {'where': f'y <= {-0.7 * s}'}},
        'method': {'horizon': '2.5 spacing'},
        'boundary': [{'name': 'top', 'set': 'top_grip', 'displacement': {'x': 0, 'y': 2e-3 * s}},
                     {'name': 'bottom', 'set': 'bottom_grip', 'displacement': {'x': 0, 'y': -2e-3 * s}}],
        'solver': {'kind': 'static'},
        'output': {'at': {'levels': 4}, 'pictures': []},
    }


LIMITS = {
    'stretch': {'critical_stretch': 2e-3},
    'principal_stress': {'tensile_strength': 1e8},
    'mohr_coulomb': {'tensile_strength': 1e8, 'cohesion': 5e8, 'friction_angle': 0.7},
    'drucker_prager': {'tensile_strength': 1e8, 'cohesion': 5e8, 'friction_angle': 0.7},
    'node_energy': {'fracture_energy': 1e5},
    'beam_limits': {'fracture_energy': 1e5},
    'energy_release': {'fracture_energy': 1e5},
    'none': {},
}


def grid_lines(n, ratio):
    """n + 1 places from 0 to 1 whose last step is `ratio` times the first."""
    steps = [ratio ** (k / max(1, n - 1)) for k in range(n)]
    places, total = [0.0], sum(steps)
    for step in steps:
        places.append(places[-1] + step / total)
    places[-1] = 1.0
    return places


def cloud(dimension, n=10, ratio=1, moved=0.0, pair=None, seed=1):
    """CSV of points at the centres of a graded grid of boxes, moved at random by a share of their spacing; `pair`: distance, in
    spacings, of one point to a second one that takes half its volume."""
    rng, lines = random.Random(seed), grid_lines(n, ratio)
    boxes = [((a + b) / 2, b - a) for a, b in zip(lines, lines[1:])]
    even = [((k + 0.5) / n, 1 / n) for k in range(n)]
    axes = [boxes] + [even] * (dimension - 1)
    rows = []

    def add(k, place, volume, size):
        if k == dimension:
            rows.append((place, volume, size))
            return
        for centre, width in axes[k]:
            add(k + 1, place + [centre + moved * width * rng.uniform(-1, 1)], volume * width, min(size, width) if size else width)
    add(0, [], 1.0, 0)
    if pair is not None:
        k = len(rows) // 2 + n // 2
        place, volume, size = rows[k]
        rows[k] = (place, volume / 2, size)
        rows.append(([place[0] + pair * size] + place[1:], volume / 2, size))
    text = ','.join('xyz'[:dimension]) + ',volume,spacing\n'
    return text + ''.join(','.join(number(v) for v in place + [volume, size]) + '\n' for place, volume, size in rows)


def mesh(dimension, n=8, ratio=1, moved=0.0, seed=1):
    """Gmsh 2.2 text of a grid of quadrilaterals or hexahedra on the unit box, graded along x, inner nodes moved at random."""
    rng, x_lines, even = random.Random(seed), grid_lines(n, ratio), [k / n for k in range(n + 1)]
    m = n + 1
    nodes, elements = [], []
    for k in range(m if dimension == 3 else 1):
        for j in range(m):
            for i in range(m):
                place = [x_lines[i], even[j], even[k] if dimension == 3 else 0.0]
                inner = 0 < i < n and 0 < j < n and (dimension == 2 or 0 < k < n)
                if inner:
                    width = [min(x_lines[i + 1] - x_lines[i], x_lines[i] - x_lines[i - 1]), 1 / n, 1 / n]
                    for a in range(dimension):
                        place[a] += moved * width[a] * rng.uniform(-1, 1)
                nodes.append(place)

    def node(i, j, k):
        return 1 + i + m * (j + m * k)
    for k in range(n if dimension == 3 else 1):
        for j in range(n):
            for i in range(n):
                quad = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
                corners = [node(a, b, k) for a, b in quad]
                if dimension == 3:
                    corners += [node(a, b, k + 1) for a, b in quad]
                elements.append(corners)
    kind = 3 if dimension == 2 else 5
    text = '$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n%d\n' % len(nodes)
    text += ''.join('%d %s\n' % (1 + k, ' '.join(number(v) for v in p)) for k, p in enumerate(nodes))
    text += '$EndNodes\n$Elements\n%d\n' % len(elements)
    text += ''.join('%d %d 2 1 1 %s\n' % (1 + k, kind, ' '.join(map(str, e))) for k, e in enumerate(elements))
    return text + '$EndElements\n'


def from_points(scene, name):
    """The scene on the points of a file in place of its body."""
    result = {k: v for k, v in scene.items() if k not in ('body', 'spacing', 'lattice', 'lattice_offset')}
    return merged(result, {'points': name})


def from_mesh(scene, name):
    result = {k: v for k, v in scene.items() if k not in ('body', 'spacing', 'lattice', 'lattice_offset')}
    return merged(result, {'mesh': {'file': name}})


def turned(scene, axis):
    """The mirror image of a scene made of boxes, straight cracks, gauges, supports and loads, at the plane where `axis` is zero."""
    swap = {0: ('left', 'right'), 1: ('bottom', 'top')}[axis]
    letter = 'xyz'[axis]
    result = copy.deepcopy(scene)
    for part in result['body']:
        box = next(iter(part.values()))['box']
        box['low'][axis], box['high'][axis] = -box['high'][axis], -box['low'][axis]
    for crack in result.get('cracks', []):
        for end in ('from', 'to'):
            crack[end][axis] *= -1
    for gauge in result['output'].get('gauges', []):
        for end in ('from', 'to'):
            gauge[end][axis] *= -1
    for some in result.get('sets', {}).values():
        some['where'] = some['where'].replace(letter, f'(-{letter})')
    for load in result['boundary']:
        load['set'] = {swap[0]: swap[1], swap[1]: swap[0]}.get(load['set'], load['set'])
        for kind in ('displacement', 'traction', 'velocity'):
            if letter in load.get(kind, {}):
                load[kind][letter] = -load[kind][letter]
    return result


def finite(value):
    return isinstance(value, (int, float)) and math.isfinite(value)

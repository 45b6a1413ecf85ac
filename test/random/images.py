"""Images of a scene: turned, mirrored, moved, in another unit of length or stress; and what the numbers of its results become.

An image takes a place p to s Q p + c, stresses to m times themselves, and keeps times. Q is a signed permutation, or any rotation where the scene names no sides.
"""
import copy
import math
import re

AXES = 'xyz'
SIDES = [('left', 'right'), ('bottom', 'top'), ('back', 'front')]
PLACES = {'low', 'high', 'center', 'from', 'to', 'point', 'at', 'about'}            # vectors of places
PLACE_LISTS = {'vertices', 'polyline', 'polygon'}
DIRECTIONS = {'normal', 'axis', 'axis_1', 'axis_2', 'along'}
LENGTHS = {'radius', 'diameter', 'length', 'width', 'spacing', 'thickness', 'depth', 'facet', 'horizon', 'tip_offset', 'low_z', 'high_z', 'breadth'}
VECTOR_LOADS = {'displacement': 'm', 'velocity': 'm/s', 'traction': 'Pa', 'force': 'N', 'body_force': 'N/m3', 'spring': 'N/m', 'spring_end': 'm'}
SCALARS = {'youngs_modulus': 'Pa', **{f'youngs_modulus_{k}': 'Pa' for k in (1, 2, 3)}, **{f'shear_modulus_{k}': 'Pa' for k in (12, 13, 23)},
           'pressure': 'Pa', 'fracture_energy': 'J/m2', 'tensile_strength': 'Pa', 'density': 'kg/m3', 'cohesion': 'Pa', 'mass': 'kg'}


class Image:
    def __init__(self, dimension, matrix=None, shift=None, scale=1.0, stress=1.0):
        self.dimension = dimension
        self.matrix = matrix or [[float(i == j) for j in range(dimension)] for i in range(dimension)]
        self.shift = shift or [0.0] * dimension
        self.scale, self.stress = scale, stress
        m = self.matrix
        self.hand = m[0][0] if dimension == 1 else m[0][0] * m[1][1] - m[0][1] * m[1][0] if dimension == 2 else sum(
            m[0][i] * (m[1][(i + 1) % 3] * m[2][(i + 2) % 3] - m[1][(i + 2) % 3] * m[2][(i + 1) % 3]) for i in range(3))
        self.factors = {'m': scale, 'm/s': scale, 'm/s2': scale, 'Pa': stress, 'N': stress * scale ** 2, 'N m': stress * scale ** 3, 'J': stress * scale ** 3,
                        'N/m3': stress / scale, 'N/m': stress * scale, 'J/m2': stress * scale, 'J/m^2': stress * scale,
                        'kg/m3': stress / scale ** 2, 'kg': stress * scale, 'Pa m^(1/2)': stress * math.sqrt(scale), 'm2': scale ** 2, 'm^2': scale ** 2}

    # ---- of the scene
    def turned(self, v):
        return [sum(row[j] * v[j] for j in range(self.dimension)) for row in self.matrix]

    def place(self, p):
        return [self.scale * a + c for a, c in zip(self.turned(p), self.shift)]

    def components(self, values, factor):
        """{x: .., y: ..} of a vector; where components are missing the matrix must be a signed permutation."""
        result = {}
        for i, row in enumerate(self.matrix):
            used = [j for j in range(self.dimension) if row[j] and AXES[j] in values]
            if used:
                result[AXES[i]] = factor * sum(row[j] * values[AXES[j]] for j in used)
        return result

    def stiffness(self, values, factor):
        return {AXES[i]: factor * values[AXES[j]] for i, row in enumerate(self.matrix) for j in range(self.dimension) if row[j] and AXES[j] in values}

    def condition(self, text):
        """x, y, z of a condition are those of the place that this one is the image of."""
        def back(match):
            j = AXES.index(match.group(0))
            if j >= self.dimension:
                return match.group(0)
            terms = [f'({self.matrix[i][j]!r})*({AXES[i]} - ({self.shift[i]!r}))' for i in range(self.dimension) if self.matrix[i][j]]
            return f"(({' + '.join(terms)})/({self.scale!r}))"
        return re.sub(r'\b[xyz]\b', back, text)

    def side(self, name):
        """left, top.. and parts such as foot.left, where Q is a signed permutation."""
        for j, pair in enumerate(SIDES[:self.dimension]):
            if name in pair:
                i = next(i for i in range(self.dimension) if self.matrix[i][j])
                return SIDES[i][pair.index(name) if self.matrix[i][j] > 0 else 1 - pair.index(name)]
        return name

    def axes_of(self, material):
        """Where the axes of an orthotropic material come to lie."""
        if self.dimension == 2:
            a = material.get('angle', 0.0)
            x, y = self.turned([math.cos(a), math.sin(a)])
            return {'angle': math.atan2(y, x)}
        return {key: self.turned(material.get(key, [float(k == n) for k in range(3)])) for n, key in enumerate(('axis_1', 'axis_2'))}

    def scene(self, scene):
        return self.walk(copy.deepcopy(scene), '')

    def walk(self, value, key):
        if isinstance(value, dict):
            if key in VECTOR_LOADS and all(k in AXES for k in value):
                factor = self.factors[VECTOR_LOADS[key]]
                return self.stiffness(value, factor) if key == 'spring' else self.components(value, factor)
            if key == 'spring':
                return {'all': value['all'] * self.factors['N/m']}
            if key == 'box' or ('low' in value and 'high' in value and isinstance(value['low'], list)):
                low, high = self.place(value['low']), self.place(value['high'])
                return {**value, 'low': [min(a, b) for a, b in zip(low, high)], 'high': [max(a, b) for a, b in zip(low, high)]}
            if key == 'prism':
                vertices = [self.place(v + [0.0])[:2] for v in value['vertices']]
                ends = [self.place([0.0, 0.0, value[k]])[2] for k in ('low', 'high')]
                return {**value, 'vertices': vertices, 'low': min(ends), 'high': max(ends)}
            if key == 'cylinder':                       # its axis is z where none is given
                value = {'axis': [0.0, 0.0, 1.0], **value}
            if value.get('model') == 'orthotropic':
                value = {**value, **self.axes_of(value)}
                return {k: v if k in ('angle', 'axis_1', 'axis_2') else self.walk(v, k) for k, v in value.items()}
            return {k: self.walk(v, k) for k, v in value.items()}
        if isinstance(value, list):
            if key in PLACES:
                return self.place(value)
            if key in PLACE_LISTS:
                return [self.place(v) for v in value]
            if key in DIRECTIONS:
                return self.turned(value)
            if key == 'lattice_offset':
                return self.turned(value)
            if key == 'gravity':
                return [self.factors['m/s2'] * v for v in self.turned(value)]
            if key == 'boundary' and all(isinstance(v, str) for v in value):
                return [self.side(v) for v in value]
            return [self.walk(v, key) for v in value]
        if isinstance(value, bool):
            return value
        if isinstance(value, (int, float)):
            if key in LENGTHS:
                return value * self.scale
            if key in SCALARS:
                return value * self.factors[SCALARS[key]]
            return value
        if isinstance(value, str):
            if key == 'where':
                return self.condition(value)
            if key in ('set', 'boundary'):
                return self.side(value)
        return value

    def points(self, text):
        """A CSV file of points: x, y [, z], volume, spacing."""
        head, *rows = text.split('\n')
        out = [head]
        for row in rows:
            if row:
                v = [float(a) for a in row.split(',')]
                p = self.place(v[:self.dimension])
                # without a third axis the volume is per unit of thickness, which is scaled apart
                out.append(','.join(repr(a) for a in p + [v[self.dimension] * self.scale ** 3] + [self.scale * a for a in v[self.dimension + 1:]]))
        return '\n'.join(out) + '\n'

    # ---- of its results
    def column(self, name):
        """(factor, [(column of the image, weight)]): factor times the column of the scene is the weighted sum of those of its image."""
        word, unit = name[:name.rfind(' [')], name[name.rfind('[') + 1:-1]
        factor = self.factors.get(unit, 1.0)
        found = re.match(r'(.*\.)(force|displacement|velocity|moment|rotation)_([xyz])$', word)
        if found:
            head, kind, axis = found.groups()
            pseudo = kind in ('moment', 'rotation')
            if pseudo and self.dimension == 2:
                return factor, [(name, self.hand)]
            j, hand = AXES.index(axis), self.hand if pseudo else 1.0
            return factor, [(f'{head}{kind}_{AXES[i]} [{unit}]', hand * self.matrix[i][j]) for i in range(self.dimension) if self.matrix[i][j]]
        return factor, [(name, self.hand if word.endswith('.K_II') and self.dimension == 2 else 1.0)]


def mirror(dimension, axis=0):
    return Image(dimension, [[(-1.0 if i == axis else 1.0) if i == j else 0.0 for j in range(dimension)] for i in range(dimension)])


def quarter(dimension):
    """A turn by 90 degrees about z."""
    m = [[0.0, -1.0], [1.0, 0.0]]
    return Image(dimension, m if dimension == 2 else [m[0] + [0.0], m[1] + [0.0], [0.0, 0.0, 1.0]])


def turn(dimension, angle):
    c, s = math.cos(angle), math.sin(angle)
    return Image(dimension, [[c, -s], [s, c]] if dimension == 2 else [[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])

"""Random scenes: a seed makes one, of bodies, methods, loads and cracks that a user could have written, awkward places preferred.

A scene is a dictionary that is written as JSON (YAML contains it), all numbers in SI, every condition in x, y, z alone, so that images.py can turn, move and
scale it. `Scene.kind` says what is asked of it: elastic, tips (cracks that stay), facets, strength, motion, explicit, relaxed, contact.
"""
import importlib.util
import math
import os
import random


def beside(path):
    """A module of another folder of tests, which may have the name of one here."""
    path = os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', path)
    spec = importlib.util.spec_from_file_location('of_' + os.path.basename(path)[:-3], path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


stress = beside('stress/scenes.py')                  # meshes and clouds of the stress matrix

KINDS = [('elastic', 34), ('tips', 16), ('facets', 16), ('strength', 10), ('motion', 8), ('explicit', 8), ('relaxed', 4), ('contact', 8)]
BOND = ('bond', 'fcbm')


class Scene:
    def __init__(self, seed, kind, data, files=()):
        self.seed, self.kind, self.data, self.files = seed, kind, data, list(files)

    @property
    def dimension(self):
        return self.data['dimension']


class Maker:
    """What the choices so far have fixed: the body's box, its spacing, names of the places where it can be held and loaded."""

    def __init__(self, seed, kind=None):
        self.rng, self.rare = random.Random(seed), random.Random(f'rare {seed}')        # the second: what was added since changes no other seed
        self.seed, self.files, self.sets, self.heated = seed, [], {}, False
        self.kind = kind or self.rng.choices([k for k, _ in KINDS], [w for _, w in KINDS])[0]

    def chance(self, p):
        return self.rng.random() < p

    def between(self, a, b):
        return self.rng.uniform(a, b)

    def one(self, *values):
        return self.rng.choice(values)

    # ---- the body
    def spacing(self):
        if self.dimension == 3:
            return self.one(0.125, 0.15, 0.2, 1 / 7) * self.between(0.97, 1.03)
        return self.one(0.05, 0.0625, 0.08, 0.1) * self.between(0.95, 1.05)

    def box(self):
        self.low = [self.between(-1, 1) if self.chance(0.5) else 0.0 for _ in range(self.dimension)]
        size = [1.0, self.one(0.5, 1.0, self.between(0.4, 1.5)), self.one(0.5, self.between(0.4, 0.8))][:self.dimension]
        self.high = [a + s for a, s in zip(self.low, size)]
        self.sides = True
        return {'box': {'low': self.low, 'high': self.high}}

    def at(self, *shares):
        return [a + s * (b - a) for a, b, s in zip(self.low, self.high, shares)]

    def middle(self, a=0.3, b=0.7):
        return self.at(*[self.between(a, b) for _ in range(self.dimension)])

    def plane_body(self):
        which = self.one('box', 'box', 'hole', 'hole', 'disk', 'ring', 'polygon', 'corner', 'notch')
        if which == 'disk' or which == 'ring':
            c = [self.between(-0.3, 0.3), self.between(-0.3, 0.3)]
            self.low, self.high, self.sides = [v - 0.5 for v in c], [v + 0.5 for v in c], False
            body = [{'add': {'disk': {'center': c, 'radius': 0.5}}}]
            if which == 'ring':
                body.append({'subtract': {'disk': {'center': list(c), 'radius': self.between(0.1, 0.25)}}})
            return body
        if which == 'polygon':
            n, c = self.rng.randint(3, 7), [self.between(-0.3, 0.3), self.between(-0.3, 0.3)]
            angles = [2 * math.pi * (k + self.between(-0.2, 0.2)) / n for k in range(n)]
            vertices = [[c[0] + 0.6 * math.cos(a), c[1] + 0.6 * math.sin(a)] for a in angles]
            self.low = [min(v[k] for v in vertices) for k in range(2)]
            self.high = [max(v[k] for v in vertices) for k in range(2)]
            self.sides = False
            return [{'add': {'polygon': {'vertices': vertices}}}]
        body = [{'add': self.box()}]
        size = min(b - a for a, b in zip(self.low, self.high))
        if which == 'hole':
            for _ in range(self.one(1, 1, 2)):
                body.append({'subtract': {'disk': {'center': self.middle(), 'radius': size * self.between(0.08, 0.25)}}})
        elif which == 'corner':
            body.append({'subtract': {'box': {'low': self.at(0.5, 0.5), 'high': self.at(1.1, 1.1)}}})
        elif which == 'notch':
            y, w = self.between(0.3, 0.7), self.one(self.between(0.02, 0.2), self.between(0.002, 0.02))
            body.append({'subtract': {'box': {'low': self.at(-0.1, y), 'high': self.at(self.between(0.2, 0.6), y + w)}}})
        return body

    def solid_body(self):
        which = self.one('box', 'box', 'cylinder', 'sphere', 'bore', 'prism')
        if which == 'sphere':
            c = [self.between(-0.2, 0.2) for _ in range(3)]
            self.low, self.high, self.sides = [v - 0.5 for v in c], [v + 0.5 for v in c], False
            return [{'add': {'sphere': {'center': c, 'radius': 0.5}}}]
        if which == 'cylinder':
            c, length = [self.between(-0.2, 0.2) for _ in range(3)], self.between(0.5, 0.9)
            self.low, self.high, self.sides = [c[0] - 0.5, c[1] - 0.5, c[2]], [c[0] + 0.5, c[1] + 0.5, c[2] + length], False
            return [{'add': {'cylinder': {'center': c, 'radius': 0.5, 'length': length}}}]
        if which == 'prism':
            vertices = [[0.0, 0.0], [1.0, 0.0], [1.0, 0.45], [0.45, 0.5], [0.5, 1.0], [0.0, 1.0]]
            self.low, self.high, self.sides = [0.0, 0.0, 0.0], [1.0, 1.0, 0.5], False
            return [{'add': {'prism': {'vertices': vertices, 'low': 0.0, 'high': 0.5}}}]
        body = [{'add': self.box()}]
        if which == 'bore':
            c = self.middle()
            body.append({'subtract': {'cylinder': {'center': c[:2] + [self.low[2] - 0.1], 'radius': 0.15,
                                                   'length': self.high[2] - self.low[2] + 0.2}}})
        return body

    def points(self):
        """The body and its points, as keys of the scene."""
        data = {'body': self.plane_body() if self.dimension == 2 else self.solid_body(), 'spacing': self.spacing()}
        self.h = data['spacing']
        self.lattice = self.one('nodes', 'cells')
        data['lattice'] = self.lattice
        self.regular = True
        if self.chance(0.4):
            data['lattice_offset'] = [self.one(0.0, 0.25, self.between(-0.5, 0.5)) for _ in range(self.dimension)]
        if self.chance(0.15) and self.force != 'fcbm':
            data['perturb'] = {'amount': self.between(0.05, 0.3), 'seed': self.rng.randint(1, 99)}
            self.regular = False
        return data

    def meshed(self):
        """A mesh of the unit box in place of a body."""
        n = self.rng.randint(8, 14) if self.dimension == 2 else self.rng.randint(4, 6)
        self.low, self.high, self.h, self.sides = [0.0] * self.dimension, [1.0] * self.dimension, 1.0 / n, True
        self.lattice, self.regular = 'mesh', False
        self.files.append(('part.msh', stress.mesh(self.dimension, n, self.one(1, 1, 3), self.one(0, 0.2), self.rng.randint(1, 99))))
        return {'mesh': {'file': 'part.msh'}}

    def cloud(self):
        n = self.rng.randint(9, 13) if self.dimension == 2 else self.rng.randint(5, 6)
        self.low, self.high, self.h, self.sides = [0.0] * self.dimension, [1.0] * self.dimension, 1.0 / n, True
        self.lattice, self.regular = 'cloud', False
        self.files.append(('points.csv', stress.cloud(self.dimension, n, self.one(1, 1, 3), self.between(0, 0.25), seed=self.rng.randint(1, 99))))
        data = {'points': 'points.csv'}
        if self.chance(0.6):
            data['body'] = [{'add': {'box': {'low': list(self.low), 'high': list(self.high)}}}]
            data['spacing'] = self.h
        else:
            self.lattice = 'bare'
        return data

    # ---- how it is computed
    def method(self):
        if self.force in BOND + ('lps', 'gmpd'):
            # coarse bodies are off by more than a user would accept, and are asked all the same
            m = {'force': self.force, 'accept_inexact': True}
            if self.chance(0.4):
                m['horizon'] = f'{self.one(2.5, 3.0, 3.015, 3.5, self.between(2.2, 3.6)) if self.dimension == 2 else self.one(2.0, 2.5, 3.0)} spacing'
            if self.chance(0.3):
                m['kernel'] = self.one('constant', 'conical', 'inverse_r', 'quadratic', 'cubic_spline')
            if self.chance(0.2):
                m['partial_volume'] = self.one('none', 'linear', 'overlap' if self.regular else 'linear')
            return m
        m = {}
        if self.chance(0.6):
            m['approximation'] = self.one('rkpm', 'rkpm', 'pddo', 'nosb')
        if self.lattice == 'bare':
            m['integration'] = 'nodal'
        elif self.chance(0.6):
            m['integration'] = self.one('gauss', 'consistent', 'consistent', 'nodal')
        if self.chance(0.15) and self.kind in ('elastic', 'tips', 'motion'):
            m['basis'], m['horizon'] = 'quadratic', f'{self.between(2.5, 3.0) if self.dimension == 2 else 2.6} spacing'
        elif self.chance(0.4):
            m['horizon'] = f'{self.one(1.6, 2.0, 2.5, self.between(1.6, 2.9)) if self.dimension == 2 else self.between(1.6, 2.2)} spacing'
        if self.chance(0.3):
            m['kernel'] = self.one('quadratic', 'conical', 'quartic_spline', 'gaussian', 'constant', 'inverse_r', 'linear_r')
        if self.chance(0.1):
            m['support'] = 'tensor'
        if self.chance(0.2):
            m['essential'] = self.one('nitsche', 'transformation', 'penalty')
        return m

    def materials(self):
        nu = self.one(0.0, 0.2, 0.25, 0.3, 0.45)
        if self.force in BOND or (self.force == 'gmpd' and self.chance(0.7)):
            nu = 1 / 4 if self.dimension == 3 or self.plane == 'strain' else 1 / 3
        elif self.force == 'gmpd':
            nu = 0.2
        self.modulus = 1e9
        m = {'youngs_modulus': self.modulus, 'poissons_ratio': nu, 'density': 2500.0}
        if self.kind in ('elastic', 'motion') and self.force == 'galerkin' and self.chance(0.1):
            m = {'model': 'orthotropic', 'youngs_modulus_1': 1e9, 'youngs_modulus_2': 4e8, 'youngs_modulus_3': 5e8, 'poissons_ratio_12': 0.2,
                 'poissons_ratio_13': 0.15, 'poissons_ratio_23': 0.1, 'shear_modulus_12': 3e8, 'shear_modulus_13': 2.5e8, 'shear_modulus_23': 2e8,
                 'density': 2500.0}
            if self.dimension == 2:
                m = {k: v for k, v in m.items() if not k.endswith(('13', '23', '_3')) or self.plane == 'strain' and not k.startswith('shear')}
            return {'materials': {'rock': m}}
        data = {'materials': {'rock': m}}
        if self.kind in ('elastic', 'tips') and self.force != 'fcbm' and self.chance(0.1):
            data['materials']['soft'] = {**m, 'youngs_modulus': self.modulus * self.one(0.1, 0.5, 3.0)}
            x = self.low[0] + self.between(0.3, 0.7) * (self.high[0] - self.low[0])
            data['blocks'] = [{'material': 'rock', 'where': 'x > -1e9'}, {'material': 'soft', 'where': f'x > {x!r}'}]
        return data

    # ---- where it is held and loaded
    def end(self, axis, high, name):
        """The set of what lies at one end of the body: facets where it has a side there, a layer of points or a piece of the surface else."""
        letter, deep = 'xyz'[axis], self.one(1.2, 2.2) * self.h
        if self.sides and self.chance(0.7):
            return [('left', 'right'), ('bottom', 'top'), ('back', 'front')][axis][high]
        place = self.high[axis] - deep if high else self.low[axis] + deep
        condition = f'{letter} {">" if high else "<"} {place!r}'
        bare = self.lattice == 'bare'
        self.sets[name] = {'where': condition} if bare or self.chance(0.4) else {'boundary': ['all'], 'where': condition}
        return name

    def vector(self, size):
        """A random vector of that size, all components given."""
        v = [self.between(-1, 1) for _ in range(self.dimension)]
        norm = math.sqrt(sum(c * c for c in v)) or 1.0
        return {'xyz'[k]: size * c / norm for k, c in enumerate(v)}

    def stress_level(self):
        return 1e-3 * self.modulus

    def loads(self):
        axis = self.rng.randrange(self.dimension)
        foot, head = self.end(axis, 0, 'foot'), self.end(axis, 1, 'head')
        d, letters = self.dimension, 'xyz'[:self.dimension]
        zero = {a: 0.0 for a in letters}
        boundary = [{'name': 'foot', 'set': foot, 'displacement': dict(zero)}]
        if self.sides and self.lattice != 'cloud' and self.chance(0.25):
            names = ('left', 'bottom', 'back')
            boundary = [{'name': f'roll_{a}', 'set': names[k], 'displacement': {a: 0.0}} for k, a in enumerate(letters)]
            head = ('right', 'top', 'front')[axis]
        length = self.high[axis] - self.low[axis]
        how = self.one('traction', 'traction', 'force', 'displacement', 'displacement')
        if self.lattice in ('bare',) and how == 'traction':
            how = 'force'
        if how == 'displacement':
            pull = {a: 1e-3 * length * (1 if a == letters[axis] else self.one(0.0, self.between(-1, 1))) for a in letters}
            boundary.append({'name': 'head', 'set': head, 'displacement': pull})
        elif how == 'traction':
            boundary.append({'name': 'head', 'set': head, 'traction': self.vector(self.stress_level())})
        else:
            boundary.append({'name': 'head', 'set': head, 'force': self.vector(self.stress_level() * 0.3)})
        if self.chance(0.3) and self.kind in ('elastic', 'tips', 'motion', 'explicit'):
            boundary.append(self.extra())
        for entry in boundary:
            if 'temperature' not in entry:
                entry['about'] = [0.0] * d
        return boundary

    def extra(self):
        offered = ['body_force', 'gravity', 'spring']
        if self.sides and self.lattice not in ('cloud', 'bare'):
            offered.append('pressure')
        if self.force == 'galerkin' and self.kind in ('elastic', 'motion'):
            offered.append('temperature')
        which = self.one(*offered)
        if which == 'pressure':
            return {'name': 'extra', 'set': self.one('left', 'right', 'bottom', 'top'), 'about': [0.0] * self.dimension, 'pressure': self.stress_level() * self.between(-1, 1)}
        if which == 'temperature':
            self.heated = True
            return {'name': 'extra', 'temperature': self.between(-50, 50)}
        if which == 'body_force':
            return {'name': 'extra', 'set': 'all', 'body_force': self.vector(self.stress_level())}
        if which == 'gravity':
            return {'name': 'extra', 'gravity': list(self.vector(9.81).values())}
        return {'name': 'extra', 'set': 'all', 'spring': {'all': self.modulus * 10 ** self.between(-4, -1)}}

    # ---- cracks
    def cracks(self):
        size = [b - a for a, b in zip(self.low, self.high)]
        if self.dimension == 3:
            c = self.middle(0.4, 0.6)
            if self.chance(0.5):
                normal = list(self.vector(1.0).values()) if self.chance(0.5) else self.one([0.0, 0.0, 1.0], [0.0, 1.0, 0.0])
                return [{'disc': {'center': c, 'normal': normal, 'radius': 0.3 * min(size) * self.between(0.7, 1.0)}}]
            y = c[1]
            x0, x1 = self.low[0] - 0.1, self.low[0] + self.between(0.3, 0.6) * size[0]
            z0, z1 = self.low[2] - 0.1, self.high[2] + 0.1
            return [{'polygon': [[x0, y, z0], [x1, y, z0], [x1, y, z1], [x0, y, z1]]}]
        found = []
        for _ in range(self.one(1, 1, 1, 2)):
            if self.sides and self.chance(0.5):          # from the left side
                y = self.low[1] + size[1] * (self.between(0.3, 0.7) if self.chance(0.6) else 0.5)
                x = self.low[0] + size[0] * self.between(0.25, 0.55)
                slope = self.one(0.0, self.between(-0.5, 0.5))
                found.append({'from': [self.low[0] - 0.1 * size[0], y], 'to': [x, y + slope * (x - self.low[0])]})
            else:
                c, a, l = self.middle(0.4, 0.6), self.one(0.0, math.pi / 2, self.between(0, math.pi)), min(size) * self.between(0.12, 0.25)
                found.append({'from': [c[0] - l * math.cos(a), c[1] - l * math.sin(a)], 'to': [c[0] + l * math.cos(a), c[1] + l * math.sin(a)]})
        return found

    def failure(self):
        if self.kind == 'facets':
            # so that the crack grows well within the loads: G ~ s^2 pi a / E with a ~ .2, s ~ 1e-3 E
            self.energy = self.modulus * 1e-6 * 0.2 * self.between(0.05, 0.5)
            return {'criterion': 'energy_release', 'fracture_energy': self.energy}
        if self.force == 'galerkin' and self.chance(0.6):
            return {'criterion': 'principal_stress', 'tensile_strength': self.modulus * 1e-3 * self.between(0.3, 3)}
        return {'criterion': 'stretch', 'critical_stretch': 1e-3 * self.between(0.3, 3)}

    # ---- what else may be there
    def press(self, data):
        """Platens in place of supports: one below that is held, one above that comes down."""
        d, top = self.dimension, self.dimension - 1
        middle = self.at(*[0.5] * d)
        foot, head = list(middle), list(middle)
        foot[top], head[top] = self.low[top], self.high[top]
        axis = 'xyz'[top]
        rub = {'friction': self.between(0.05, 0.6)} if self.chance(0.6) else {}
        up = [float(k == top) for k in range(d)]
        down = [-v for v in up]
        moves = {'displacement': {axis: -1e-3 * (self.high[top] - self.low[top])}} if self.chance(0.5) else {'force': {axis: -2e5}}
        data['platens'] = [{'name': 'anvil', 'point': foot, 'normal': up, **rub}, {'name': 'ram', 'point': head, 'normal': down, **rub, **moves}]
        # what friction does not hold is held by springs that are soft
        data['boundary'] = [{'name': 'soft', 'set': 'all', 'spring': {'all': 1e-4 * self.modulus}}]
        data.pop('cracks', None)

    def stage(self, data):
        names = [b['name'] for b in data['boundary'] if any(k in b for k in ('traction', 'force', 'body_force', 'gravity'))
                 or any(v for v in b.get('displacement', {}).values())]
        if names:
            data['stages'] = [{'name': 'first', 'boundary': {names[0]: self.between(0.3, 1)}},
                              {'name': 'second', 'boundary': {n: self.between(0, 1) for n in names}}]

    def neighbour(self, data):
        """A second body beside the first, a gap from it that may be narrower than a spacing, on springs of its own."""
        low = [self.high[0] + self.one(0.05, 0.3, 1.5) * self.h] + self.low[1:]
        data['body'].append({'add': {'box': {'low': low, 'high': [low[0] + 6 * self.h] + self.high[1:]}}})
        data['boundary'].append({'name': 'afloat', 'set': 'all', 'spring': {'all': 1e-3 * self.modulus}, 'about': [0.0] * self.dimension})

    # ---- all of it
    def choose_force(self):
        if self.kind in ('explicit', 'relaxed'):
            return self.one('galerkin', 'bond', 'bond', 'fcbm', 'lps', 'gmpd')
        if self.kind in ('facets', 'contact', 'tips'):
            return self.one('galerkin', 'galerkin', 'galerkin', 'galerkin', 'bond', 'lps')
        return self.one(*['galerkin'] * 6, 'bond', 'fcbm', 'lps', 'gmpd')

    def make(self):
        self.dimension = 3 if self.chance(0.25) else 2
        self.plane = self.one('stress', 'strain')
        self.force = self.choose_force()
        if self.kind == 'facets' and self.force != 'galerkin':
            self.dimension = 2                           # facets of bonds are of the plane
        data = {'dimension': self.dimension}
        if self.dimension == 2:
            data.update(plane=self.plane, thickness=self.one(1.0, self.between(0.05, 2)))
        source = self.rng.random()
        data.update(self.points() if source < 0.84 or self.force == 'fcbm' else self.meshed() if source < 0.93 else self.cloud())
        data.update(self.materials())
        data['method'] = self.method()
        if self.kind in ('tips', 'facets', 'contact') or self.kind in ('strength', 'motion', 'explicit') and self.chance(0.4):
            data['cracks'] = self.cracks()
        if self.kind in ('facets', 'strength') or self.kind in ('motion', 'explicit', 'relaxed') and self.chance(0.4):
            data['failure'] = self.failure()
        data['boundary'] = self.loads()
        data['solver'] = self.solver(data)
        if self.heated:
            for material in data['materials'].values():
                material['expansion'] = 1e-5
            if data['solver']['kind'] == 'static':
                data['solver'].update(stepping='fixed', steps=2)
        if self.kind == 'contact' and self.sides and self.lattice in ('nodes', 'cells') and self.force == 'galerkin' and self.chance(0.4):
            self.press(data)
        elif self.kind == 'contact' and not self.sides and self.lattice in ('nodes', 'cells') and self.force == 'galerkin' and self.rare.random() < 0.4:
            self.press(data)                             # on a round body, that they touch in one place
        elif self.kind in ('elastic', 'strength') and not self.heated and self.chance(0.12):
            self.stage(data)
        if self.kind == 'elastic' and data.get('body') and self.lattice in ('nodes', 'cells') and self.sides is False and self.chance(0.3):
            self.neighbour(data)
        data['output'] = {'at': {'levels': 2}, 'pictures': []}
        if self.kind == 'tips':
            data['output']['stress_intensity'] = True
        if self.kind == 'contact' and 'platens' not in data:
            data['contact'] = self.one({'kind': 'normal'}, {'kind': 'friction', 'coefficient': self.between(0.1, 1)})
        if self.sets:
            data['sets'] = self.sets
        return Scene(self.seed, self.kind, data, self.files)

    def solver(self, data):
        if self.kind == 'motion':
            return {'kind': 'newmark', 'dt': self.h / math.sqrt(self.modulus / 2500) * self.between(0.5, 3), 'time_steps': self.rng.randint(4, 12)}
        if self.kind == 'explicit':
            how = {'dt': 0.15 * self.h / math.sqrt(self.modulus / 2500), 'time_steps': self.rng.randint(20, 60)}
            if self.chance(0.3):                         # as many steps as are stable
                how = {'end': self.between(4, 12) * self.h / math.sqrt(self.modulus / 2500)}
            return {'kind': self.one('verlet', 'central'), **how}
        if self.kind == 'relaxed':
            return {'kind': self.one('adr', 'relax'), 'stages': self.rng.randint(1, 3)}
        if self.kind in ('facets', 'strength'):
            how = {'kind': 'static', 'max_events': 6}
            if self.rare.random() < 0.2:
                how['linear'] = self.rare.choice(('cholmod', 'umfpack', 'pcg', 'cholmod')) if self.force != 'lps' else 'pcg'
            return how
        if self.kind == 'elastic' and self.chance(0.2):
            return {'kind': 'static', 'linear': 'pcg' if self.force == 'lps' else self.one('cholmod', 'umfpack', 'pcg', 'cholmod')}
        return {'kind': 'static'}


def make(seed, kind=None):
    return Maker(seed, kind).make()

"""Cracks that grow by facets in the plane, by fronts in space: load and energy against a strip of known energy release rate, and the same answer whatever should not matter.

Far ahead of its crack a strip between clamps, H high and drawn apart by u, stores M u^2 / (2 H) per area, behind it nothing: that is G, wherever the tip is. M is the
modulus of a strip that cannot contract along itself. The crack grows where the load reaches fracture energy, and goes straight on.
"""
import importlib.util
import math
import os

from cells import Cell, Run, residual, same
from scenes import MODULUS, from_mesh, mesh, merged

ENERGY, HEIGHT = 100.0, 1.0
LOAD_LIMIT, ENERGY_LIMIT = 0.05, 0.1
# Bonds: a strip ten points high; what they miss of G0 falls with the spacing, and their own patch test says that they are soft.


def images():
    """Images of scenes, of the random tests, which map every key of a scene."""
    path = os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', 'random', 'images.py')
    spec = importlib.util.spec_from_file_location('images', path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


IMAGES = images()


def clamped_modulus(plane, nu):
    return MODULUS / (1 - nu * nu) if plane == 'stress' else MODULUS * (1 - nu) / ((1 + nu) * (1 - 2 * nu))


def opening(modulus):
    """Twice what makes the crack grow, so that it does at half the load."""
    return 2 * math.sqrt(2 * HEIGHT * ENERGY / modulus)


def strip(method, plane='stress', spacing=0.1, events=4):
    nu = method.poisson(plane, 2)
    u = opening(clamped_modulus(plane, nu))
    return merged({
        'dimension': 2, 'plane': plane, 'thickness': 1,
        'body': [{'add': {'box': {'low': [0, -HEIGHT / 2], 'high': [3 * HEIGHT, HEIGHT / 2]}}}], 'spacing': spacing, 'lattice': 'cells',
        'cracks': [{'from': [-0.1, 0], 'to': [HEIGHT, 0]}],
        'materials': {'m': {'youngs_modulus': MODULUS, 'poissons_ratio': nu, 'density': 2500}},
        'failure': {'criterion': 'energy_release', 'fracture_energy': ENERGY},
        'boundary': [{'name': 'foot', 'set': 'bottom', 'displacement': {'x': 0, 'y': -u / 2}}, {'name': 'head', 'set': 'top', 'displacement': {'x': 0, 'y': u / 2}}],
        'solver': {'kind': 'static', 'max_events': events},
        'output': {'at': {'levels': 1}, 'pictures': []},
    }, method.changes)


def load_error(runs):
    """Largest error of the load at an event; 1 where nothing grew."""
    history = runs[0].history()
    loads = [f for f, event in zip(history['load_factor [1]'], history['event [1]']) if event]
    return max(abs(2 * f - 1) for f in loads) if loads else 1.0


def energy_of_area(runs):
    fracture = runs[0].report['fracture']
    ratio = fracture.get('dissipated_over_G0_length', fracture.get('dissipated_over_G0_area'))
    return abs(ratio - 1) if ratio is not None else 1.0


def strays(spacing, height=0.0):
    """How far the tip, or the front, has left its plane, in spacings; fronts are told by their area alone."""
    return lambda runs: max(abs(tip['y'] - height) for tip in runs[0].report['fracture']['tips']) / spacing


BALANCES = ('error of the energy', energy_of_area, ENERGY_LIMIT)


def facets(method):
    for plane in ('stress', 'strain'):
        scene = strip(method, plane)
        yield Cell('facets', f'plane {plane}', method.name, [Run(scene)], 'error of the load', load_error, LOAD_LIMIT,
                   also=[BALANCES, ('way off its plane, spacings', strays(0.1), 0.01)])
    nodal = ' nodal ' in method.name
    for value, changes, height in (('lattice shifted', {'lattice_offset': [0.37, 0.21]}, 0), ('crack along a row of points', {'lattice': 'nodes'}, 0),
                                   ('crack beside a row of points', {'lattice': 'nodes'}, 1e-3), ('points moved by 0.2 h', {'perturb': {'amount': 0.2}}, 0)):
        if method.needs_lattice and 'perturb' in changes:
            continue
        scene = merged(strip(method), changes)
        scene['cracks'] = [{'from': [-0.1, height], 'to': [HEIGHT, height]}]
        yield Cell('facets', value, method.name, [Run(scene)], 'error of the load', load_error, LOAD_LIMIT,
                   also=[BALANCES, ('way off its plane, spacings', strays(0.1, height), 1.0 if 'moved' in value or nodal else 0.3)])
    # a crack at 45 degrees turns across the tension: no closed form in a body so small, but energy and balance hold
    scene = strip(method, events=6)
    scene['cracks'] = [{'from': [1.3, -0.15], 'to': [1.65, 0.2]}]
    yield Cell('facets', 'inclined crack', method.name, [Run(scene)], 'error of the energy', energy_of_area, ENERGY_LIMIT, also=[('residual', residual, 1e-8)])
    if method.needs_lattice:
        return
    meshed = from_mesh(strip(method), 'strip.msh')
    meshed['cracks'] = [{'from': [-0.1, 0.5], 'to': [0.4, 0.5]}]
    u = opening(clamped_modulus('stress', meshed['materials']['m']['poissons_ratio']))
    for load, sign in zip(meshed['boundary'], (-1, 1)):
        load['displacement'] = {'x': 0, 'y': sign * u}
    yield Cell('facets', 'mesh', method.name, [Run(meshed, [('strip.msh', mesh(2, 12, 1, 0.1))])], 'error of the energy', energy_of_area, ENERGY_LIMIT,
               also=[('residual', residual, 1e-8)])


def same_answers(condition, scene, method):
    """Mirror image, unit, threads, and a run that was stopped and resumed."""
    dimension = scene['dimension']
    millimetres = IMAGES.Image(dimension, scale=1e3, stress=1e-6)
    back = {unit: 1 / factor for unit, factor in millimetres.factors.items()}
    # in the plane the thickness is scaled as well
    scaled = millimetres.scene(scene)
    yield Cell(condition, 'mirror image', method.name, [Run(scene), Run(IMAGES.mirror(dimension, 1).scene(scene))], 'change of the answer',
               same(signs=lambda name: '_y ' in name, only=is_load), 1e-6)
    yield Cell(condition, 'mm and MPa', method.name, [Run(scene), Run(scaled)], 'change of the answer', same(factors=back, only=is_load), 1e-6)
    yield Cell(condition, '2 threads for 1', method.name, [Run(scene), Run(scene, options=('--threads', '2'))], 'change of the answer', same(), 0.0)
    yield Cell(condition, 'interrupted and resumed', method.name, [Run(scene), Run(scene, interrupt=900)], 'change of the answer', same(), 0.0)


def is_load(name):
    return 'force_' in name or 'displacement_' in name or 'crack' in name


def plate_of_space(method, spacing=1 / 6, events=2):
    """The strip in space, held along z as well, with a straight front."""
    nu = method.poisson('', 3)
    u = opening(clamped_modulus('strain', nu))
    low, high, middle = -0.1, 0.6, 0.03
    return merged({
        'dimension': 3, 'body': [{'add': {'box': {'low': [0, -HEIGHT / 2, 0], 'high': [2 * HEIGHT, HEIGHT / 2, 0.5]}}}], 'spacing': spacing,
        'cracks': [{'polygon': [[-0.1, middle, low], [0.8, middle, low], [0.8, middle, high], [-0.1, middle, high]]}],
        'materials': {'m': {'youngs_modulus': MODULUS, 'poissons_ratio': nu, 'density': 2500}},
        'failure': {'criterion': 'energy_release', 'fracture_energy': ENERGY},
        'boundary': [{'name': 'foot', 'set': 'bottom', 'displacement': {'x': 0, 'y': -u / 2, 'z': 0}},
                     {'name': 'head', 'set': 'top', 'displacement': {'x': 0, 'y': u / 2, 'z': 0}},
                     {'name': 'back', 'set': 'back', 'displacement': {'z': 0}}, {'name': 'front', 'set': 'front', 'displacement': {'z': 0}}],
        'solver': {'kind': 'static', 'break': 'facet', 'max_events': events},
        'output': {'at': {'levels': 1}, 'pictures': []},
    }, method.changes)


def round_crack(method):
    """A penny in a block that is drawn apart, far from its surface by a radius."""
    scene = plate_of_space(method)
    scene['body'] = [{'add': {'box': {'low': [-0.6, -0.6, -0.6], 'high': [0.6, 0.6, 0.6]}}}]
    scene['spacing'] = 0.12
    scene['cracks'] = [{'disc': {'center': [0.01, 0.02, 0.01], 'normal': [0, 1, 0], 'radius': 0.3}}]
    scene['boundary'] = scene['boundary'][:2]
    for load, sign in zip(scene['boundary'], (-1, 1)):
        load['displacement'] = {'x': 0, 'y': sign * 3e-3, 'z': 0}
    return scene


def fronts(method):
    scene = plate_of_space(method)
    yield Cell('fronts', 'straight', method.name, [Run(scene)], 'error of the load', load_error, LOAD_LIMIT, also=[BALANCES])
    moved = merged(plate_of_space(method), {'perturb': {'amount': 0.2}})
    yield Cell('fronts', 'straight, points moved by 0.2 h', method.name, [Run(moved)], 'error of the load', load_error, LOAD_LIMIT, also=[BALANCES])
    yield Cell('fronts', 'round', method.name, [Run(round_crack(method))], 'error of the energy', energy_of_area, 0.15, also=[('residual', residual, 1e-8)])
    yield from same_answers('fronts', scene, method)


def in_motion(method):
    """The strip drawn apart in eight passes of a wave to a tenth more than what it takes: what the load does becomes crack, strain and motion."""
    nu = method.poisson('stress', 2)
    wave = math.sqrt(MODULUS / 2500)
    end = 8 * HEIGHT / wave
    u = 1.1 * opening(clamped_modulus('stress', nu)) / 2
    scene = strip(method)
    scene['boundary'] = [{'name': 'foot', 'set': 'bottom', 'velocity': {'x': 0, 'y': -u / 2 / end}}, {'name': 'head', 'set': 'top', 'velocity': {'x': 0, 'y': u / 2 / end}}]
    scene['solver'] = {'kind': method.changes['solver']['kind'], 'end': end}
    if 'newmark' in method.name:
        scene['solver']['dt'] = 0.05 / wave
    yield Cell('facets in motion', 'strip', method.name, [Run(scene)], 'error of the energy', energy_of_area, 0.15)
    yield Cell('facets in motion', '2 threads for 1', method.name, [Run(scene), Run(scene, options=('--threads', '2'))], 'change of the answer', same(), 0.0)
    yield Cell('facets in motion', 'interrupted and resumed', method.name, [Run(scene), Run(scene, interrupt=4000)], 'change of the answer', same(), 0.0)


def cells(method):
    if 'break' in method.kinds:
        yield from facets(method)
        yield from same_answers('facets, the same answer', strip(method), method)
        if method.force == 'galerkin':             # in space the program offers no other
            yield from fronts(method)
    if 'motion' in method.kinds:
        yield from in_motion(method)

"""Conditions with cracks: mouths that open right wherever the lattice lies, cracks in awkward places, events to the end."""
from cells import Cell, Run, residual, same
from scenes import LIMITS, MODULUS, STRESS, merged, notched, plate, turned

CMOD = 9.8809                # of the notched plate, in stress width / modulus (finite elements of high order)
SHIFTS = [(0, 0), (0.25, 0), (0.5, 0), (0.75, 0), (0, 0.25), (0.37, 0.21), (0.37, 0.4), (0.1, 0.45)]

CRACKS = {
    'through points': [{'from': [-1, 0.05], 'to': [0.35, 0.05]}],
    'on lattice lines': [{'from': [-1, 0], 'to': [0, 0]}],
    'end on a point': [{'from': [-1, 0.05], 'to': [0.05, 0.05]}],
    'crossing': [{'from': [-0.5, -0.3], 'to': [0.5, 0.3]}, {'from': [-0.5, 0.3], 'to': [0.5, -0.3]}],
    'isolating a part': [{'from': [-0.3, -0.3], 'to': [0.3, -0.3]}, {'from': [0.3, -0.3], 'to': [0.3, 0.3]},
                         {'from': [0.3, 0.3], 'to': [-0.3, 0.3]}, {'from': [-0.3, 0.3], 'to': [-0.3, -0.3]}],
    'shattering': [{'from': [-1.1, -0.65 + 0.1 * k + 0.05], 'to': [0.9, -0.6 + 0.1 * k]} for k in range(13)],
    'shorter than a spacing': [{'from': [0, 0], 'to': [0.04, 0]}],
    'through the whole body': [{'from': [-1.1, 0.01], 'to': [1.1, 0.01]}],
}


def openings(method):
    limit = 0.1 if method.force == 'galerkin' else 0.25
    for shift in SHIFTS:
        scene = merged(notched(offset=shift, nu=method.poisson('stress', 2)), method.changes)

        def error(runs):
            return abs(runs[0].history()['mouth [m]'][-1] * MODULUS / STRESS / CMOD - 1)
        yield Cell('crack mouth, lattice shifted', f'{shift[0]} h, {shift[1]} h', method.name, [Run(scene)], 'error of the opening', error, limit)


def scene_of(method, **options):
    scene = plate(nu=method.poisson('stress', 2), **options)
    horizon = scene['method'] if 'horizon' not in method.changes.get('method', {}) else {}
    return merged(merged(scene, {'method': horizon}), method.changes)


def awkward(method):
    for name, cracks in CRACKS.items():
        scene = scene_of(method)
        scene['cracks'] = cracks
        scene['solver']['max_events'] = 40
        yield Cell('awkward cracks', name, method.name, [Run(scene)], 'residual', residual, 1e-8)


def events(method):
    scene = scene_of(method)
    yield Cell('events until separation', 'plate', method.name, [Run(scene)], 'residual', residual, 1e-8)
    short = merged(scene, {'solver': {'max_events': 30}})
    yield Cell('mirror image, breaking', 'at the crack plane', method.name, [Run(short), Run(swapped(short))], 'change of the answer',
               same(signs=lambda name: '_y ' in name, only=is_load), 1e-6)
    yield Cell('units, breaking', 'mm', method.name, [Run(short), Run(merged(scene_of(method, scale=1e-3), {'solver': {'max_events': 30}}))],
               'change of the answer', same(factors={'m': 1e3, 'N': 1e6, 'J': 1e9}, only=is_load), 1e-6)
    yield Cell('threads, breaking', '2 for 1', method.name, [Run(short), Run(short, options=('--threads', '2'))], 'change of the answer', same(), 0.0)
    yield Cell('interrupted and resumed', 'event stepping', method.name, [Run(short), Run(short, interrupt=400)], 'change of the answer', same(), 0.0)
    fixed = merged(scene, {'solver': {'stepping': 'fixed', 'steps': 6, 'break': 'all'}})
    yield Cell('fixed steps, all over the limit', '6 steps', method.name, [Run(fixed)], 'residual', residual, 1e-8)
    cyclic = merged(fixed, {'solver': {'steps': 8}})
    for load in cyclic['boundary']:
        load['table'] = [[0, 0], [0.25, 0.6], [0.5, -0.3], [0.75, 0.8], [1, 0]]
    yield Cell('reversals, breaking', '8 steps', method.name, [Run(cyclic)], 'residual', residual, 1e-8)
    weak = scene_of(method, stretch=1e-9)
    weak['failure'].pop('exclude')
    weak['solver'] = {'kind': 'static', 'stepping': 'fixed', 'steps': 2, 'break': 'all'}
    yield Cell('everything breaks', 'critical stretch 1e-9', method.name, [Run(weak)], 'residual', residual, 1e-8)


def is_load(name):
    return 'force_' in name or 'displacement_' in name


def swapped(scene):
    """Mirror image at y = 0: the plate's sets are named by their side."""
    return turned(scene, 1)


def long_runs(method):
    if method.name in ('rkpm gauss linear', 'rkpm consistent linear', 'bond', 'lps', 'gmpd'):
        scene = merged(scene_of(method, spacing=1 / 15), {'solver': {'max_events': 10000, 'stop': {'stiffness': 0}}})
        yield Cell('10 000 events', 'plate', method.name, [Run(scene)], 'residual', residual, 1e-8, seconds=600)


def criteria(method):
    criterion = method.changes['failure']['criterion']
    scene = scene_of(method)
    scene['failure'] = {'criterion': criterion, **LIMITS.get(criterion, {}), 'exclude': ['top_grip', 'bottom_grip']}
    if criterion == 'none':
        scene['failure'].pop('exclude')
    if method.force in ('gmpd',):
        scene['materials']['m']['poissons_ratio'] = 0.2
    scene['solver']['max_events'] = 60
    yield Cell('criteria', '60 events', method.name, [Run(scene)], 'residual', residual, 1e-8)


def cells(method):
    if method.kinds & {'static', 'break'} and ', ' not in method.name:
        yield from openings(method)
    if 'break' in method.kinds:
        for group in (awkward, events, long_runs):
            yield from group(method)
    if 'criterion' in method.kinds:
        yield from criteria(method)

"""Surfaces that touch: faces of cracks, rigid platens, bodies that collide. A cut block that is pressed together is a block; what slides bears friction times pressure."""
from cells import Cell, Run, energy_error, last_over_peak, patch_error, residual, same
from scenes import MODULUS, STRESS, merged

STRAIN, FRICTION = 1e-3, 0.3
DENSITY, SPEED = 2500, 10.0
OBLIQUE = 5e-3               # in space the block widens while it slides, so that its faces rub a little across as well
OVERLAP = 0.05               # of the shortening of the block: pieces of faces are held apart in the mean


def block(method, dimension, nu=None, crack=(0.55, 0.55), contact=None, moves=None):
    """A block of 1 m, cut through across y, between supports that shorten it along y and let it widen; without a crack it strains uniformly."""
    nu = method.poisson('stress', dimension) if nu is None else nu
    axes = 'xyz'[:dimension]
    left, right = crack
    h = 0.1 if dimension == 2 else 0.2
    ends = [[-0.1, left], [1.1, right]]
    scene = {
        'dimension': dimension, 'body': [{'add': {'box': {'low': [0] * dimension, 'high': [1] * dimension}}}], 'spacing': h,
        'materials': {'m': {'youngs_modulus': MODULUS, 'poissons_ratio': nu, 'density': DENSITY}},
        'cracks': [{'from': ends[0], 'to': ends[1]}] if dimension == 2 else
        [{'polygon': [ends[0] + [-0.1], ends[1] + [-0.1], ends[1] + [1.1], ends[0] + [1.1]]}],
        'contact': contact or {'kind': 'normal'},
        'boundary': [{'name': f'hold_{a}', 'set': {'x': 'left', 'z': 'back'}[a], 'displacement': {a: 0}} for a in axes if a != 'y']
        + [{'name': 'foot', 'set': 'bottom', 'displacement': {'y': 0}}, {'name': 'head', 'set': 'top', 'displacement': moves or {'y': -STRAIN}}],
        'solver': {'kind': 'static'},
        'output': {'at': {'levels': 1}, 'pictures': []},
        'reference': {'displacement': {a: f'{nu * STRAIN!r}*{a}' if a != 'y' else f'{-STRAIN!r}*y' for a in axes}},
    }
    if dimension == 2:
        scene['plane'], scene['thickness'] = 'stress', 1
    return merged(scene, method.changes)


def overlap(runs):
    return runs[0].report['overlap_max'] / STRAIN


def friction_ratio(runs):
    """What the head bears along x over what it bears along y, against the coefficient, in every step that pressed."""
    history = runs[0].history()
    pairs = [(x, y) for x, y in zip(history['head.force_x [N]'], history['head.force_y [N]']) if y]
    return max(abs(abs(x / y) / FRICTION - 1) for x, y in pairs) if pairs else None


def friction_takes(runs):
    """Friction takes energy; it gives none."""
    return max(0.0, -runs[0].report['energy']['friction'] / runs[0].report['energy']['strain'])


PARTS = ('overlap of faces', overlap, OVERLAP)


def faces(method):
    for dimension in (2, 3):
        where = f'{dimension}D'
        for value, crack, contact in (('pressed', (0.55, 0.55), None), ('inclined, sticks', (0.35, 0.67), {'kind': 'friction', 'coefficient': 0.6})):
            yield Cell('closed faces', f'{value}, {where}', method.name, [Run(block(method, dimension, crack=crack, contact=contact))], 'error of the displacement',
                       patch_error, 0.05, also=[PARTS, ('residual', residual, 1e-8)])
    opened = merged(block(method, 2), {'solver': {'stepping': 'fixed', 'steps': 8}})
    opened['boundary'][-1]['table'] = [[0, 0], [0.25, 1], [0.5, -1], [0.75, 1], [1, 0]]
    del opened['reference']
    yield Cell('closed faces', 'pressed, opened, pressed, let go', method.name, [Run(opened)], 'left after unloading', last_over_peak('head.force_y [N]'), 1e-6, also=[PARTS])
    loose = block(method, 2)
    loose['boundary'][-1] = {'name': 'head', 'set': 'top', 'traction': {'y': -STRAIN * MODULUS}}
    if method.force != 'lps':                      # its parts cannot be held by contact alone: not offered
        yield Cell('closed faces', 'a part held by contact alone', method.name, [Run(loose)], 'error of the displacement', patch_error, 0.05, also=[PARTS])
    scene = block(method, 2, crack=(0.35, 0.67), contact={'kind': 'friction', 'coefficient': FRICTION})
    del scene['reference']
    yield Cell('closed faces', '2 threads for 1', method.name, [Run(scene), Run(scene, options=('--threads', '2'))], 'change of the answer', same(), 0.0)
    yield Cell('closed faces', 'forces of a tenth, moduli of a tenth', method.name, [Run(scene), Run(merged(scene, {'materials': {'m': {'youngs_modulus': MODULUS / 10}}}))],
               'change of the answer', same(factors={'N': 10, 'N m': 10, 'J': 10}), 1e-8)


def friction(method):
    for dimension in (2, 3):
        across = {'x': 0, 'y': 0, 'z': 0} if dimension == 3 else {'x': 0, 'y': 0}
        for value, table in (('slides', None), ('slides forth and back', [[0, 0], [0.5, 1], [1, -1]])):
            scene = block(method, dimension, contact={'kind': 'friction', 'coefficient': FRICTION})
            press = {'name': 'head', 'set': 'top', 'displacement': {**across, 'x': '2e-3*min(1, 2*t)' if not table else '2e-3*(min(1, 2*t) - 2*max(0, 2*t - 1))',
                                                                    'y': -STRAIN}, 'ramp': 'constant'}
            scene['boundary'] = [{'name': 'foot', 'set': 'bottom', 'displacement': across}, press]
            scene['solver'] = {'kind': 'static', 'stepping': 'fixed', 'steps': 8 if table else 2}
            del scene['reference']
            measure = friction_ratio if not table else last_friction_ratio
            yield Cell('friction', f'{value}, {dimension}D', method.name, [Run(scene)], 'error of friction over pressure', measure, 1e-6 if dimension == 2 else OBLIQUE,
                       also=[('energy that friction gave', friction_takes, 1e-9), ('residual', residual, 1e-8)])
    sticks = block(method, 2, contact={'kind': 'friction', 'coefficient': 0.9}, moves={'x': 1e-4, 'y': -STRAIN})
    sticks['boundary'] = [{'name': 'foot', 'set': 'bottom', 'displacement': {'x': 0, 'y': 0}}, sticks['boundary'][-1]]
    del sticks['reference']
    whole = {k: v for k, v in sticks.items() if k not in ('cracks', 'contact')}
    yield Cell('friction', 'sticks, against the block without a cut', method.name, [Run(whole), Run(sticks)], 'error of the load', same(only=lambda n: 'force_' in n), 0.05)


def last_friction_ratio(runs):
    history = runs[0].history()
    x, y = history['head.force_x [N]'][-1], history['head.force_y [N]'][-1]
    return abs(abs(x / y) / FRICTION - 1) if y else None


def platens(method):
    """Galerkin at rest; the faces of the block may slide on platens without friction, and it strains uniformly."""
    for dimension in (2, 3):
        scene = block(method, dimension)
        base, push = [0.0] * dimension, [0.5] * dimension
        up, down = [0.0] * dimension, [0.0] * dimension
        push[1], up[1], down[1] = 1.0, 1.0, -1.0
        for key in ('cracks', 'contact'):
            del scene[key]
        scene['boundary'] = [load for load in scene['boundary'] if load['name'].startswith('hold')]
        scene['platens'] = [{'name': 'foot', 'point': base, 'normal': up}, {'name': 'head', 'point': push, 'normal': down, 'displacement': {'y': -STRAIN}}]
        yield Cell('platens', f'flat, {dimension}D', method.name, [Run(scene)], 'error of the displacement', patch_error, 0.05, also=[('residual', residual, 1e-8)])
        by_force = merged(scene, {})
        by_force['platens'][1] = {'name': 'head', 'point': push, 'normal': down, 'force': {'y': -STRAIN * MODULUS}, 'tilt': 'free'}
        yield Cell('platens', f'by a force, free to tilt, {dimension}D', method.name, [Run(by_force)], 'error of the displacement', patch_error, 0.05,
                   also=[('residual', residual, 1e-8)])
        rough = merged(scene, {'solver': {'stepping': 'fixed', 'steps': 2}})
        del rough['reference']
        rough['boundary'] = [{'name': 'foot', 'set': 'bottom', 'displacement': {a: 0 for a in 'xyz'[:dimension]}}]
        rough['platens'] = [{'name': 'head', 'point': push, 'normal': down, 'friction': FRICTION, 'displacement': {'x': 5e-3, 'y': -STRAIN}}]
        yield Cell('platens', f'slides on the block, {dimension}D', method.name, [Run(rough)], 'error of friction over pressure', friction_ratio, 1e-6 if dimension == 2 else OBLIQUE,
                   also=[('residual', residual, 1e-8)])
        ball = merged(rough, {})
        ball['platens'] = [{'name': 'head', 'shape': 'cylinder' if dimension == 2 else 'sphere', 'point': [0.5, 1.5] + [0.5] * (dimension - 2), 'radius': 0.5,
                            'displacement': {'y': -STRAIN * 10}}]
        yield Cell('platens', 'cylinder' if dimension == 2 else 'sphere', method.name, [Run(ball)], 'residual', residual, 1e-8, also=[('force at the foot', bears('head'), 1e-8)])


def bears(name):
    """The head presses, and the foot bears what it presses: 0; 1 where nothing is pressed."""
    def number(runs):
        history = runs[0].history()
        head, foot = history[f'{name}.force_y [N]'][-1], history['foot.force_y [N]'][-1]
        return abs(head + foot) / abs(head) if head else 1.0
    return number


def collisions(method):
    """A bar hits an equal one that rests, end to end: it stops, and the other one goes on at its speed after 2 L / c, L its length, c the speed of waves in a bar."""
    nu = method.poisson('stress', 2)
    length, gap, h = 1.0, 0.1, 0.05
    wave, end = (MODULUS / DENSITY) ** 0.5, 0.025
    way = SPEED * (end - gap / SPEED - length / wave)
    base = merged({
        'dimension': 2, 'plane': 'stress', 'thickness': 1, 'spacing': h, 'lattice': 'cells',
        'body': [{'add': {'box': {'low': [0, 0], 'high': [length, 0.4]}}}, {'add': {'box': {'low': [length + gap, 0], 'high': [2 * length + gap, 0.4]}}}],
        'materials': {'m': {'youngs_modulus': MODULUS, 'poissons_ratio': nu, 'density': DENSITY}},
        'sets': {'striker': {'where': f'x < {length + gap / 2}'}, 'target': {'where': f'x > {length + gap / 2}'}},
        'initial': {'sets': [{'set': 'striker', 'velocity': {'x': SPEED}}]},
        'boundary': [{'name': name, 'set': name, 'force': {'x': 0}} for name in ('striker', 'target')],
        'output': {'at': {'levels': 1, 'rows': 50}, 'pictures': []},
    }, method.changes)
    base['solver'] = {**base['solver'], 'end': end}

    def way_error(runs):
        return abs(runs[0].history()['target.displacement_x [m]'][-1] / way - 1)

    def momentum(runs):
        """Both together move as far as the striker would alone."""
        history = runs[0].history()
        return abs((history['target.displacement_x [m]'][-1] + history['striker.displacement_x [m]'][-1]) / (SPEED * end) - 1)

    for enforcement in ('springs', 'impulses'):
        for kind in ('normal', 'friction'):
            contact = {'kind': kind, 'search': 'short_range', 'enforcement': enforcement, **({'coefficient': FRICTION} if kind == 'friction' else {})}
            scene = merged(base, {'contact': contact})
            yield Cell('collisions', f'{enforcement}, {kind}', method.name, [Run(scene)], 'error of the displacement', way_error, 0.05,
                       also=[('momentum lost', momentum, 1e-9), ('energy lost', energy_error, 0.02), ('overlap, spacings', lambda runs: runs[0].report['overlap_max'] / h, 0.1)])
    scene = merged(base, {'contact': {'kind': 'friction', 'coefficient': FRICTION, 'search': 'short_range', 'enforcement': 'impulses'}})
    yield Cell('collisions', '2 threads for 1', method.name, [Run(scene), Run(scene, options=('--threads', '2'))], 'change of the answer', same(), 0.0)
    yield Cell('collisions', 'interrupted and resumed', method.name, [Run(scene), Run(scene, interrupt=1500)], 'change of the answer', same(), 0.0)


def cells(method):
    if 'break' in method.kinds:
        yield from faces(method)
        yield from friction(method)
        if method.force == 'galerkin':             # at rest: forces of points show no surface
            yield from platens(method)
    if 'motion' in method.kinds and 'newmark' not in method.name and method.force != 'galerkin':
        yield from collisions(method)

"""Conditions without fracture: uniform tension must come out linear, on any points, in any unit, at any Poisson's ratio."""
from cells import Cell, Run, balanced, last_over_peak, patch_error, residual, same
from scenes import MODULUS, STRESS, cloud, from_mesh, from_points, merged, mesh, tension, turned

DIMENSIONS = ((2, 'stress'), (2, 'strain'), (3, ''))
PATCH_LIMIT = 0.05          # where a run must begin to warn
SAME = 1e-9                 # rounding of a solved system, seen through other numbers


def every_dimension(method):
    return (((1, ''),) if method.takes_bars else ()) + DIMENSIONS


def label(dimension, plane):
    return f'2D plane {plane}' if dimension == 2 else f'{dimension}D'


def across(method, dimension):
    """Points across the body: twice as many for forces of points, whose rows at the surface see half a family and bear the loads besides."""
    if method.force == 'galerkin':
        return 5 if dimension == 3 else 10
    return 12 if dimension == 3 else 20


def base(method, dimension, plane, **changes):
    options = {'spacing': 1 / across(method, dimension), **changes}
    nu = options.pop('nu', None)
    scene = tension(dimension, plane, method.poisson(plane, dimension) if nu is None else nu, **options)
    if method.force != 'galerkin' and dimension > 1:
        scene['lattice'] = 'cells'                 # its outermost points are whole ones
    return merged(scene, method.changes)


def patch(condition, value, method, scene, files=(), limit=PATCH_LIMIT, refusal=''):
    return Cell(condition, value, method.name, [Run(scene, files)], 'patch error', patch_error, limit, refusal)


def points(method):
    """Irregular points: of lattices, meshes and clouds, and two that nearly coincide."""
    for dimension, plane in every_dimension(method):
        for amount in (0,) if method.needs_lattice else (0, 0.1, 0.2, 0.3, 0.45):
            scene = base(method, dimension, plane)
            yield patch('moved lattice points', f'{amount} h, {label(dimension, plane)}', method, merged(scene, {'perturb': {'amount': amount}}))
    for dimension, plane in () if method.needs_lattice else ((2, 'stress'), (3, '')):
        n = (8 if dimension == 2 else 4) * (1 if method.force == 'galerkin' else 2)
        for ratio in (1, 4, 10):
            for moved in (0, 0.2):
                value = f'1:{ratio}, {moved} h, {label(dimension, plane)}'
                yield patch('graded mesh', value, method, from_mesh(base(method, dimension, plane), 'part.msh'),
                            [('part.msh', mesh(dimension, n, ratio, moved))])
                if takes_clouds(method):
                    yield patch('graded cloud', value, method, held_rim(base(method, dimension, plane), n),
                                [('points.csv', cloud(dimension, n, ratio, moved))])
    if takes_clouds(method):
        for pair in (1e-2, 1e-4, 1e-8, 0):
            yield patch('points that nearly coincide', f'{pair} h', method, held_rim(base(method, 2, 'stress'), 8),
                        [('points.csv', cloud(2, 8, pair=pair))],
                        refusal='two points are the same' if pair == 0 else 'a bond needs a length' if pair <= 1e-8 and method.force != 'galerkin' else '')


def takes_clouds(method):
    """Points of a file have no cells: they want integration at the nodes, or forces that need none."""
    return (method.force != 'galerkin' or ' nodal ' in method.name) and not method.needs_lattice


def held_rim(scene, n):
    """A cloud has no facets to load: the outermost points are held in the linear field, and those inside must follow."""
    result = from_points(scene, 'points.csv')
    axes = list(result['reference']['displacement'])
    rim = ' or '.join(f'{a} < {1 / n} or {a} > {1 - 1 / n}' for a in axes)
    result['sets'] = {'rim': {'where': rim}}
    result['boundary'] = [{'name': 'rim', 'set': 'rim', 'displacement': dict(result['reference']['displacement'])}]
    return result


def horizons(method):
    for dimension, plane in every_dimension(method):
        for m in (0.9, 1.01, 1.5, 2, 2.5, 3, 4.5, 6):
            yield patch('horizon', f'{m} h, {label(dimension, plane)}', method,
                        merged(base(method, dimension, plane), {'method': {'horizon': f'{m} spacing'}}),
                        refusal='no point sees a neighbour' if m < 1 else '')


def thin(method):
    for dimension, plane in DIMENSIONS:
        h = 0.1
        for count in (1, 2, 3):
            scene = base(method, dimension, plane, spacing=h, size=(1, count * h, count * h))
            yield patch('few points thick', f'{count}, {label(dimension, plane)}', method, merged(scene, {'lattice': 'cells'}),
                        refusal='one row of points shows no strain across it' if count == 1 and method.force == 'galerkin' else '')


SHAPES = {
    'sliver of 11 degrees': [[0, 0], [1, 0], [1, 0.2]],
    'notch': [[0, 0], [0.45, 0], [0.5, 0.5], [0.55, 0], [1, 0], [1, 1], [0, 1]],
    're-entrant corner': [[0, 0], [1, 0], [1, 0.5], [0.5, 0.5], [0.5, 1], [0, 1]],
}


def shapes(method):
    """No closed form: forces must balance, and the residual must be small."""
    for name, vertices in SHAPES.items():
        for plane in ('stress', 'strain'):
            scene = base(method, 2, plane, spacing=0.05)
            scene['body'] = [{'add': {'polygon': {'vertices': vertices}}}]
            scene['sets'] = {'foot': {'where': 'y <= 0.06'}}
            length = 0.2 if 'sliver' in name else 0.5 if 'corner' in name else 1.0
            scene['boundary'] = [{'name': 'foot', 'set': 'foot', 'displacement': {'x': 0, 'y': 0}},
                                 {'name': 'pull', 'set': 'right', 'traction': {'x': STRESS}}]
            del scene['reference']
            value = f'{name}, plane {plane}'
            yield Cell('slivers, notches, corners', value, method.name, [Run(scene)], 'imbalance of forces', balanced(STRESS * length), 1e-7)


def poissons_ratios(method):
    for dimension, plane in DIMENSIONS:
        for nu in (-0.9, -0.5, 0, 0.25, 0.33, 0.45, 0.49, 0.499, 0.4999):
            # beams of bonds would have to bear shear with a negative stiffness
            beyond = method.name == 'gmpd' and nu > (1 / 3 if plane == 'stress' else 0.25)
            yield patch("Poisson's ratio", f'{nu}, {label(dimension, plane)}', method, base(method, dimension, plane, nu=nu),
                        refusal='micropolar bonds bear no more than 1/4, in plane stress 1/3' if beyond else '')


def contrasts(method):
    """Two materials in series, without lateral contraction unless the method needs it: the soft half carries the elongation."""
    for dimension, plane in () if method.needs_lattice else DIMENSIONS:        # transforms take one material
        for contrast in (1e2, 1e4, 1e6):
            nu = method.poisson(plane, dimension) if method.force in ('bond', 'fcbm') else 0
            scene = base(method, dimension, plane, nu=nu)
            scene['materials']['hard'] = {'youngs_modulus': MODULUS * contrast, 'poissons_ratio': nu, 'density': 2500}
            scene['blocks'] = [{'material': 'm', 'where': 'x <= 0.5'}, {'material': 'hard', 'where': 'x > 0.5'}]
            soft, hard = STRESS / MODULUS, STRESS / MODULUS / contrast
            if plane == 'strain':
                soft, hard = soft * (1 - nu * nu), hard * (1 - nu * nu)
            scene['reference'] = {'displacement': {'x': f'{soft!r}*min(x, 0.5) + {hard!r}*max(x - 0.5, 0)'}}
            yield patch('contrast of stiffness', f'{contrast:g}, {label(dimension, plane)}', method, scene, limit=0.2)


def scaled(scene, length, modulus):
    """The same body in another unit of length, with another stiffness under another load: strains stay."""
    def walk(value, key=''):
        if isinstance(value, dict):
            return {k: walk(v, k) for k, v in value.items()}
        if isinstance(value, list):
            return [walk(v, key) for v in value]
        if isinstance(value, (int, float)) and not isinstance(value, bool):
            if key in ('low', 'high', 'spacing', 'thickness', 'from', 'to', 'critical_length'):
                return value * length
            if key == 'youngs_modulus':
                return value * modulus
        return value
    result = walk(scene)
    for load in result['boundary']:
        for kind, factor in (('traction', modulus), ('displacement', length)):
            if kind in load:
                load[kind] = {a: v * factor for a, v in load[kind].items()}
    return result


def plain(scene):
    return {k: v for k, v in scene.items() if k != 'reference'}


def mirrored(name):
    """Columns that change their sign in a mirror across x: vectors along x, moments about the other axes."""
    return ('_x ' in name) != ('.moment_' in name)


def invariance(method):
    """Another unit, place, load or number of threads, or the mirror image: the same answer."""
    for dimension, plane in DIMENSIONS:
        scene, where = plain(base(method, dimension, plane)), label(dimension, plane)
        volume = 2 if dimension == 2 else 3
        for length, modulus in ((1e-9, 1), (1e-3, 1e3), (1e3, 1e-9), (1, 1e3)):
            thickness = length if dimension == 2 else 1        # the thickness is scaled too
            force = length ** (volume - 1) * thickness * modulus
            back = {'m': 1 / length, 'N': 1 / force, 'N m': 1 / (force * length), 'J': 1 / (force * length)}
            yield Cell('units', f'{length:g} m, {modulus:g} GPa, {where}', method.name, [Run(scene), Run(scaled(scene, length, modulus))],
                       'change of the answer', same(factors=back), SAME * 10)
        for shift in (1e3, 1e6):
            away = plain(base(method, dimension, plane, low=(shift, -shift, shift)))
            yield Cell('far from the origin', f'{shift:g} lengths, {where}', method.name, [Run(scene), Run(away)], 'change of the answer', same(), shift * 1e-12)
        for load in (1e-6, 1e6):
            other = plain(base(method, dimension, plane, stress=STRESS * load))
            yield Cell('load', f'{load:g}, {where}', method.name, [Run(scene), Run(other)], 'change of the answer',
                       same(factors={'m': 1 / load, 'N': 1 / load, 'N m': 1 / load, 'J': 1 / load ** 2}), SAME)
        axis = 0
        yield Cell('mirror image', where, method.name, [Run(scene), Run(turned(scene, axis))], 'change of the answer',
                   same(signs=mirrored), SAME)
        yield Cell('threads', f'2 for 1, {where}', method.name, [Run(scene), Run(scene, options=('--threads', '2'))],
                   'change of the answer', same(), 0.0)


def supports(method):
    """What nothing holds, or what two supports contradict, is refused; so is what is only half held under a load that moves it."""
    for dimension, plane in ((2, 'stress'), (3, '')):
        where = label(dimension, plane)
        scene = plain(base(method, dimension, plane))
        pull = scene['boundary'][-1]
        free = merged(scene, {'boundary': [pull]})
        yield Cell('supports', f'nothing holds the body, {where}', method.name, [Run(free)], 'refused', residual, 0, refusal='nothing holds it')
        slipping = merged(scene, {'boundary': scene['boundary'][1:-1] + [pull]})
        yield Cell('supports', f'free along the load, {where}', method.name, [Run(slipping)], 'refused', residual, 0, refusal='nothing holds it along its load')
        torn = merged(scene, {'boundary': scene['boundary'] + [{'name': 'again', 'set': 'left', 'displacement': {'x': 1e-3}}]})
        yield Cell('supports', f'contradiction, {where}', method.name, [Run(torn)], 'refused', residual, 0,
                   refusal='two supports contradict each other')
        balanced_pull = merged(scene, {'boundary': [pull, {'name': 'back', 'set': 'left', 'traction': {'x': -STRESS}}]})
        yield Cell('supports', f'free, balanced load, {where}', method.name, [Run(balanced_pull)], 'residual', residual, 1e-8)


def reversals(method):
    for dimension, plane in DIMENSIONS:
        scene = plain(base(method, dimension, plane))
        scene['boundary'][-1]['table'] = [[0, 0], [0.25, 1], [0.5, 0], [0.75, -1], [1, 0]]
        scene['solver'] = merged(scene['solver'], {'stepping': 'fixed', 'steps': 8})
        scene['output'] = merged(scene['output'], {'at': {'levels': 8}})
        yield Cell('unloading and reversal', label(dimension, plane), method.name, [Run(scene)], 'left after unloading',
                   last_over_peak('pull.displacement_x [m]'), 1e-9)


def linear_solvers(method):
    for dimension, plane in DIMENSIONS:
        scene = base(method, dimension, plane)
        yield Cell('linear solver', label(dimension, plane), method.name, [Run(scene)], 'residual', residual, 1e-8)


def relaxed(method):
    for dimension, plane in DIMENSIONS:
        scene = base(method, dimension, plane, spacing=0.05 if dimension == 2 else 1 / 12)
        scene['lattice'] = 'cells'
        scene['solver']['stages'] = 1
        yield patch('relaxation', label(dimension, plane), method, scene)


def cells(method):
    if 'static' in method.kinds:
        groups = [points, horizons, thin]
        if 'gauss, ' not in method.name and 'bond, ' not in method.name:          # kernels meet the points alone
            groups += [shapes, poissons_ratios, contrasts, invariance, supports, reversals]
        for group in groups:
            yield from group(method)
    if 'linear' in method.kinds:
        yield from linear_solvers(method)
    if 'relaxed' in method.kinds:
        yield from relaxed(method)

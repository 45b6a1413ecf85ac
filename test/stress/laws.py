"""Materials that depend on the direction, springs, temperature and other free strains: uniform fields in closed form."""
import math

from cells import Cell, Run, last_over_peak, patch_error, residual, same
from elastic import DIMENSIONS, PATCH_LIMIT, base, label, plain
from scenes import MODULUS, STRESS, merged

E1, E2, E3, G = 1e9, 2e8, 4e8, 1.5e8
NU12, NU13, NU23 = 0.25, 0.2, 0.15
EXPANSION, WARMER = 1e-5, 100.0


def compliance(plane):
    """Rows xx, yy, xy of an orthotropic material along its axes; in plane strain what the third axis is held by is taken off."""
    s = [[1 / E1, -NU12 / E1, 0.0], [-NU12 / E1, 1 / E2, 0.0], [0.0, 0.0, 1 / G]]
    if plane == 'strain':
        third = [-NU13 / E1, -NU23 / E2]
        for i in range(2):
            for j in range(2):
                s[i][j] -= third[i] * third[j] * E3
    return s


def turned_strain(s, angle):
    """Strains xx, yy, xy (engineering) under a unit stress along x of a material whose first axis lies at an angle to x."""
    c, n = math.cos(angle), math.sin(angle)
    stress = [c * c, n * n, -c * n]                                      # along the axes of the material
    e = [sum(s[i][j] * stress[j] for j in range(3)) for i in range(3)]
    return (e[0] * c * c + e[1] * n * n - e[2] * c * n, e[0] * n * n + e[1] * c * c + e[2] * c * n,
            2 * c * n * (e[0] - e[1]) + e[2] * (c * c - n * n))


def orthotropic(method):
    for plane in ('stress', 'strain'):
        for degrees in (0, 30, 90, 135):
            xx, yy, xy = (STRESS * v for v in turned_strain(compliance(plane), math.radians(degrees)))
            scene = base(method, 2, plane)
            law = {'model': 'orthotropic', 'youngs_modulus_1': E1, 'youngs_modulus_2': E2, 'poissons_ratio_12': NU12, 'shear_modulus_12': G,
                   'angle': math.radians(degrees), 'density': 2500}
            if plane == 'strain':
                law.update(youngs_modulus_3=E3, poissons_ratio_13=NU13, poissons_ratio_23=NU23)
            scene['materials'] = {'m': law}
            # one side is held in the field, the other one pulled: the shear that comes with it is free
            scene['boundary'] = [{'name': 'hold', 'set': 'left', 'displacement': {'x': 0, 'y': f'{yy!r}*y'}}, {'name': 'pull', 'set': 'right', 'traction': {'x': STRESS}}]
            scene['reference'] = {'displacement': {'x': f'{xx!r}*x', 'y': f'{yy!r}*y + {xy!r}*x'}}
            yield Cell('orthotropic', f'axis at {degrees} degrees, plane {plane}', method.name, [Run(scene)], 'patch error', patch_error, PATCH_LIMIT)
    for name, axes, along in (('x', ([1, 0, 0], [0, 1, 0]), 1), ('y', ([0, 1, 0], [0, 0, 1]), 3), ('z', ([0, 0, 1], [1, 0, 0]), 2)):
        # strains along x, y, z of a pull along x, axis 1 lying along x, y or z, axis 2 after it in turn
        s = [[1 / E1, -NU12 / E1, -NU13 / E1], [-NU12 / E1, 1 / E2, -NU23 / E2], [-NU13 / E1, -NU23 / E2, 1 / E3]]
        order = {'x': (0, 1, 2), 'y': (2, 0, 1), 'z': (1, 2, 0)}[name]   # axis of the material that lies along x, y, z
        pulled = [STRESS * s[order[0]][k] for k in order]
        scene = base(method, 3, '')
        scene['materials'] = {'m': {'model': 'orthotropic', 'youngs_modulus_1': E1, 'youngs_modulus_2': E2, 'youngs_modulus_3': E3, 'poissons_ratio_12': NU12,
                                    'poissons_ratio_13': NU13, 'poissons_ratio_23': NU23, 'shear_modulus_12': G, 'shear_modulus_13': 2 * G, 'shear_modulus_23': G / 2,
                                    'axis_1': axes[0], 'axis_2': axes[1], 'density': 2500}}
        scene['reference'] = {'displacement': {a: f'{v!r}*{a}' for a, v in zip('xyz', pulled)}}
        yield Cell('orthotropic', f'axis 1 along {name}, 3D', method.name, [Run(scene)], 'patch error', patch_error, PATCH_LIMIT)


def springs(method):
    """A body on springs: the springs bear the load, and give by it over their stiffness; body and spring in series share an elongation."""
    stiffness = MODULUS
    for dimension, plane in DIMENSIONS:
        scene, where = plain(base(method, dimension, plane)), label(dimension, plane)
        scene['boundary'][0] = {'name': 'spring', 'set': 'left', 'spring': {'x': stiffness}}

        def gives(runs):
            return abs(runs[0].history()['spring.displacement_x [m]'][-1] / (STRESS / stiffness) - 1)

        yield Cell('springs', f'hold the body, {where}', method.name, [Run(scene)], 'error of what the springs give', gives, 1e-7, also=[('residual', residual, 1e-8)])
        series = plain(base(method, dimension, plane))
        nu = series['materials']['m']['poissons_ratio']
        bar = MODULUS / (1 - nu * nu) if plane == 'strain' else MODULUS
        series['boundary'][-1] = {'name': 'machine', 'set': 'right', 'spring': {'x': stiffness}, 'spring_end': {'x': STRESS / MODULUS}}

        def shares(runs, bar=bar):
            force = STRESS / MODULUS / (1 / stiffness + 1 / bar)
            return abs(runs[0].history()['machine.force_x [N]'][-1] / force - 1)

        yield Cell('springs', f'a machine that yields, {where}', method.name, [Run(series)], 'error of the load', shares, PATCH_LIMIT, also=[('residual', residual, 1e-8)])
    scene = plain(base(method, 2, 'stress'))
    scene['boundary'][0] = {'name': 'spring', 'set': 'left', 'spring': {'x': stiffness}}
    loaded = merged(scene, {'solver': {'stepping': 'fixed', 'steps': 8}})
    loaded['boundary'][-1]['table'] = [[0, 0], [0.25, 1], [0.5, 0], [0.75, -1], [1, 0]]
    yield Cell('springs', 'loaded forth and back', method.name, [Run(loaded)], 'left after unloading', last_over_peak('pull.displacement_x [m]'), 1e-9)
    only = merged(scene, {})
    only['boundary'] = [{'name': 'bed', 'set': 'all', 'spring': {'all': stiffness}}, scene['boundary'][-1]]
    yield Cell('springs', 'nothing but springs', method.name, [Run(only)], 'residual', residual, 1e-8)
    far = merged(scene, {})
    far['boundary'][0]['spring']['x'] = stiffness * 1e6
    yield Cell('springs', 'a million times as stiff as the body', method.name, [Run(far)], 'residual', residual, 1e-8)


def free_strains(method):
    """Free to move: the strain of temperature without a stress. Held along x: its stress, as a pull that takes the strain back would make it."""
    strain = EXPANSION * WARMER
    for dimension, plane in DIMENSIONS:
        where = label(dimension, plane)
        scene = base(method, dimension, plane)
        nu = scene['materials']['m']['poissons_ratio']
        scene['materials']['m']['expansion'] = EXPANSION
        axes = 'xyz'[:dimension]
        out_of_plane = 1 + nu if plane == 'strain' else 1                # the third axis is held, and pushes the others apart
        for value, load, factor in (('warmer', {'temperature': WARMER}, 1), ('shrinks', {'shrinkage': strain}, -1)):
            free = merged(scene, {'solver': {'stepping': 'fixed', 'steps': 2}})
            free['boundary'][-1] = {'name': value, **load}
            free['reference'] = {'displacement': {a: f'{factor * strain * out_of_plane!r}*{a}' for a in axes}}
            yield Cell('free strains', f'{value}, free, {where}', method.name, [Run(free)], 'error of the free strain', patch_error, 1e-6, energy=MODULUS * strain ** 2)
        held = merged(scene, {'solver': {'stepping': 'fixed', 'steps': 2}})
        held['boundary'][-1] = {'name': 'warmer', 'temperature': WARMER}
        held['boundary'].append({'name': 'wall', 'set': 'right', 'displacement': {'x': 0}})
        lateral = strain * out_of_plane * (1 + nu if plane != 'strain' else 1 / (1 - nu))
        held['reference'] = {'displacement': {a: '0' if a == 'x' else f'{lateral!r}*{a}' for a in axes}}
        yield Cell('free strains', f'warmer, held along x, {where}', method.name, [Run(held)], 'patch error', patch_error, PATCH_LIMIT, also=[('residual', residual, 1e-8)])
    back = plain(base(method, 2, 'stress'))
    back['materials']['m']['expansion'] = EXPANSION
    back['solver'] = merged(back['solver'], {'stepping': 'fixed', 'steps': 4})
    back['boundary'][-1] = {'name': 'warmer', 'temperature': f'{WARMER!r} K/m2*x*y', 'table': [[0, 0], [0.5, 1], [1, 0]]}
    back['output']['gauges'] = [{'name': 'across', 'from': [0.01, 0.5], 'to': [0.99, 0.5]}]
    yield Cell('free strains', 'warmer in a part, and cooled again', method.name, [Run(back)], 'left after cooling', last_over_peak('across [m]'), 1e-9)
    yield Cell('free strains', '2 threads for 1', method.name, [Run(back), Run(back, options=('--threads', '2'))], 'change of the answer', same(), 0.0)


def cells(method):
    if 'static' in method.kinds and 'gauss, ' not in method.name and 'bond, ' not in method.name:
        yield from springs(method)
        if method.force == 'galerkin':             # bonds are made from Young's modulus and Poisson's ratio, and have no free strains: not offered
            yield from orthotropic(method)
            yield from free_strains(method)

# SPDX-License-Identifier: GPL-3.0-or-later
"""checks.py ROOT FOLDER: the Python package, its answers and its errors, as TAP (run by test_package.sh)."""
import ctypes
import os
import subprocess
import sys
import warnings

import numpy
import perigal

root, work = sys.argv[1:]
demo = os.path.join(root, 'data', 'disk_crack', 'scene.yaml')
there = os.path.join(work, 'grün und weiß')
count, bad = 0, 0


def verdict(name, good):
    global count, bad
    count += 1
    bad += not good
    print(f'{"ok" if good else "not ok"} {count} - {name}')


def refused(name, kind, pattern, call):
    try:
        call()
        verdict(name + ' (no error)', False)
    except kind as fault:
        verdict(name, pattern in str(fault))


with warnings.catch_warnings(record=True) as caught:
    warnings.simplefilter('always')
    r = perigal.run(demo, out=os.path.join(there, 'öut'), threads=1,
                    set={'spacing': '4 mm', 'output.pictures': [], 'failure.fracture_energy': 20})
verdict('run: warnings are warnings', [str(w.message) for w in caught if w.category is perigal.PerigalWarning]
        == r.report['warnings'] and len(caught) > 0)
plan = perigal.check(demo, set={'spacing': '4 mm'})
verdict('check: as many points as the run had', plan['points'] == r.points and r.dimension == 2)
verdict('report', r.report['outcome'] == 'done')
h = r.history
verdict('history: a row a step', len(h) == r.report['steps'] and h.data.shape[1] == len(h.names))
verdict('history: the last row is the state of the report',
        abs(h['energy_strain'][-1] - r.report['energy']['strain']) <= 1e-15 * h['energy_strain'][-1])
verdict('history: units', h.units[h.names.index('top.force_y')] == 'N')
verdict('history: a loop over rows, the last one, some of them', len(list(h)) == len(h) and h[-1] == list(h)[-1]
        and h[-1]['top.force_y'] == h['top.force_y'][-1] and numpy.array_equal(h[1:3].data, h.data[1:3]))
verdict('history: columns as of a dict', h.keys() == h.names and all(numpy.array_equal(v, h[k]) for k, v in dict(h).items())
        and 'top.force_y' in h and len(h.values()) == len(h.items()) == len(h.names))
refused('history: a row behind the last', IndexError, f'there are {len(h)}', lambda: h[len(h)])
verdict('history: printed with names, units and numbers', f'{len(h)} rows' in repr(h) and 'top.force_y [N]: ' in repr(h) and ' ... ' in repr(h)
        and ' at 0x' not in repr(h))
verdict('a result: printed with points, steps and fields', f'{r.points} points in 2D' in repr(r) and 'stress [Pa]: xx, yy, xy' in repr(r))
e = r.events
verdict('events: a row a broken bond', len(e) == r.report['broken'] and e.names[-1] == 'kind_code')
s = r.field('stress', step=slice(None))
verdict('field: all steps', s.shape == (len(r.times), r.points, 3) and r.fields['stress'] == ['xx', 'yy', 'xy'])
verdict('field: one component', numpy.array_equal(r.field('stress', 'yy', step=[0, 2]), s[[0, 2], :, 1]))
verdict('field: the last step by default', numpy.array_equal(r.field('stress'), s[-1]))
verdict('field: units', r.units['stress'] == 'Pa')
x = r.field('place')
verdict('places and volumes', abs(r.field('point_volume').sum() / (numpy.pi * .05**2 * .01) - 1) < .02
        and (numpy.hypot(x[:, 0], x[:, 1]) < .05).all() and numpy.array_equal(r.field('place', 'y'), x[:, 1]))

scene = perigal.read_scene(demo, set={'spacing': '6 mm'})
verdict('scene: as written', scene['spacing'] == '6 mm' and scene['materials']['rock']['youngs_modulus'] == '10 GPa')
scene['output']['pictures'] = []
scene['boundary'][0]['displacement']['y'] = -1e-5 / 3
with warnings.catch_warnings():
    warnings.simplefilter('ignore')
    again = perigal.run(scene, out=os.path.join(there, 'dict'), threads=1)
copy = perigal.read_scene(os.path.join(again.folder, 'scene.yaml'))
verdict('run: a dict', again.report['outcome'] == 'done' and copy == scene)

n = 7
grid = (numpy.arange(n) + 1) / 7e3
places = numpy.stack(numpy.meshgrid(grid * (1 + 2e-16), grid + 1 / 3), axis=-1).reshape(-1, 2)
with open(os.path.join(there, 'points.csv'), 'w', encoding='utf-8') as file:
    file.write('x [m],y [m],volume [m3],spacing [m]\n')
    file.writelines(f'{p[0]!r},{p[1]!r},2e-11,{1 / 7e3!r}\n' for p in places.tolist())
scene = {'dimension': 2, 'plane': 'stress', 'thickness': '1 mm', 'points': os.path.join(there, 'points.csv'),
         'materials': {'glass': {'youngs_modulus': 7e10, 'poissons_ratio': .2}},
         'method': {'approximation': 'rkpm', 'integration': 'nodal', 'horizon': '2.5 spacing'},
         'boundary': [{'name': 'low', 'set': 'bottom', 'displacement': {'x': 0, 'y': 0}},
                      {'name': 'high', 'set': 'top', 'displacement': {'y': 1e-7}}],
         'solver': {'kind': 'static'}, 'output': {'pictures': []}}
with warnings.catch_warnings():
    warnings.simplefilter('ignore')
    cloud = perigal.run(scene, out=os.path.join(there, 'cloud'), threads=1)
verdict('places come back bit by bit', numpy.array_equal(cloud.field('place'), places))

bar = {'dimension': 2, 'plane': 'stress', 'thickness': '1 mm', 'spacing': '1 mm', 'lattice': 'cells',
       'body': [{'add': {'box': {'low': ['-8 mm', '-8 mm'], 'high': ['8 mm', '8 mm']}}}],
       'cracks': [{'from': ['-4 mm', 0], 'to': ['4 mm', 0]}],
       'materials': {'steel': {'youngs_modulus': '192 GPa', 'poissons_ratio': 1 / 3, 'density': '8000 kg/m3'}},
       'failure': {'criterion': 'stretch', 'critical_stretch': .002, 'exclude': ['top', 'bottom']},
       'method': {'force': 'bond', 'kernel': 'constant', 'horizon': '3.015 spacing', 'accept_inexact': True},
       'boundary': [{'name': 'top', 'set': 'top', 'velocity': {'y': 5}},
                    {'name': 'bottom', 'set': 'bottom', 'velocity': {'y': -5}}],
       'solver': {'kind': 'verlet', 'dt': 1e-7, 'time_steps': 40}, 'output': {'at': {'levels': 1}, 'pictures': []}}
swept = os.path.join(there, 'swéep')
lists = {'spacing': ['1 mm', '2 mm'], 'failure.critical_stretch': numpy.array([.002, .003]), 'cracks': [[]]}
t = perigal.sweep(bar, lists, out=swept, threads=1, jobs=2)
verdict('sweep: all combinations', t['spacing'].tolist() == [1, 1, 2, 2] and t.units[t.names.index('spacing')] == 'mm'
        and t['critical_stretch'].tolist() == [.002, .003] * 2 and t.status == ['done'] * 4 and len(t) == 4)
verdict('sweep: the peak of each', all(t.result(k).report['curve']['peak']['force'] == t['peak'][k] for k in range(4)))
t = perigal.sweep(bar, {'spacing': ['1 mm', '2 mm'], 'failure.criterion': ['stretch'],
                        'cracks[0].to': [['3 mm', 0], ['4 mm', 0]]}, out=swept + '2', zip=True, threads=1,
                  quantity=['broken', 'top.force_y:max'])
verdict('sweep: zip, quantities, words', t.names[:4] == ['number', 'spacing', 'broken', 'top.force_y:max']
        and t.words == {'to': ['["3 mm", 0]', '["4 mm", 0]']})
open_file = os.path.join(swept + '3', 'spacing=2mm')
os.makedirs(os.path.dirname(open_file))
open(open_file, 'w').close()
with warnings.catch_warnings(record=True) as caught:
    warnings.simplefilter('always')
    t = perigal.sweep(bar, {'spacing': ['1 mm', '2 mm']}, out=swept + '3', threads=1)
verdict('sweep: a run that fails is a warning', t.status == ['done', 'failed'] and 'is a file' in t.trouble[1]
        and numpy.isnan(t['peak'][1]) and len(caught) == 1)
refused('sweep: wrong key', perigal.SceneError, 'did you mean spacing', lambda: perigal.sweep(bar, {'spacng': [1, 2]}))
refused('sweep: it is there', perigal.UsageError, '--resume', lambda: perigal.sweep(bar, lists, out=swept))
refused('sweep: nothing to sweep', perigal.UsageError, 'several values', lambda: perigal.sweep(bar, {'spacing': 1}))

many = os.path.join(work, 'many.csv')
with open(many, 'w') as file:
    file.write('step [1],x [m],kind [name]\n' + ''.join(f'{k},,tension\n' for k in range(1000)) + '7,1')
table = perigal.Table(many)
verdict('table: empty places, an unfinished row', len(table) == 1000 and numpy.isnan(table['x']).all())

refused('open: no folder', FileNotFoundError, 'nowhere', lambda: perigal.open('nowhere'))
refused('open: no result', FileNotFoundError, 'result.e', lambda: perigal.open(there))
refused('field: unknown', KeyError, 'displacement, damage', lambda: r.field('stres'))
refused('field: component', KeyError, 'xx, yy', lambda: r.field('stress', 'q'))
refused('field: step', IndexError, '', lambda: r.field('stress', step=99))
refused('history: column', KeyError, 'energy_strain', lambda: r.history['enrgy'])
refused('run: wrong key', perigal.SceneError, 'did you mean spacing', lambda: perigal.run(demo, there, {'spacng': 3}))
refused('run: no file', perigal.SceneError, 'missing.yaml', lambda: perigal.run('missing.yaml', there))
refused('run: memory', perigal.Failed, 'memory', lambda: perigal.run(demo, os.path.join(there, 'm'), memory='1 kB'))
refused('run: memory, not a size', perigal.UsageError, 'size', lambda: perigal.run(demo, there, memory='much'))
refused('run: not a number', ValueError, '', lambda: perigal.run(dict(scene, spacing=float('nan')), there))
# the library itself: each structure has the fields, places and size that it has in the headers
kinds = perigal.library._Structure.__subclasses__()
with open(os.path.join(work, 'layout.c'), 'w') as file:
    file.write('#include "perigal/session.h"\n#include <stddef.h>\n#include <stdio.h>\nint main (void)\n{\n' + ''.join(
        ''.join(f'    printf ("{kind.of} {field[0]} %zu\\n", offsetof ({kind.of}, {field[0]}));\n' for field in kind._fields_)
        + f'    printf ("{kind.of} size %zu\\n", sizeof ({kind.of}));\n' for kind in kinds) + '    return 0;\n}\n')
subprocess.run([*os.environ.get('CC', 'gcc').split(), '-std=c17', '-I' + os.path.join(root, 'include'), '-o', os.path.join(work, 'layout'),
                file.name], check=True)
there_is = subprocess.run([os.path.join(work, 'layout')], check=True, capture_output=True, text=True).stdout.split('\n')[:-1]
verdict('structures: laid out as in the headers', len(kinds) == 7 and there_is == [
    line for kind in kinds for line in [*(f'{kind.of} {field[0]} {getattr(kind, field[0]).offset}' for field in kind._fields_),
                                        f'{kind.of} size {ctypes.sizeof(kind)}']])
rng = numpy.random.default_rng(5)
x = rng.random((80, 3))
start, node = perigal.families(x, .4)
verdict('families: those of brute force', all(
    numpy.array_equal(node[start[k]:start[k + 1]], numpy.flatnonzero(((x - x[k])**2).sum(1) <= .16)) for k in range(80)))
start, node = perigal.families(x, .2, centres=x[:5] + .1, tensor=True)
verdict('families: cubes around other places', len(start) == 6 and all(
    numpy.array_equal(node[start[k]:start[k + 1]], numpy.flatnonzero((abs(x - x[k] - .1) <= .2).all(1)))
    for k in range(5)))
grid = numpy.stack(numpy.meshgrid(numpy.arange(8.), numpy.arange(8.)), -1).reshape(-1, 2)
at = 2 + 3 * rng.random((20, 2))
N, dN, grade = perigal.shape_functions(grid, 3, at, spacing=1, order=2)
u = grid[:, 0] * grid[:, 1]
verdict('shape functions: a quadratic field to 1e-12', abs(N @ u - at[:, 0] * at[:, 1]).max() < 1e-12
        and abs(dN[0] @ u - at[:, 1]).max() < 1e-12 and abs(dN[1] @ u - at[:, 0]).max() < 1e-12 and not grade.any())
start, node = perigal.families(grid, 2.5, closed=False)
owner = numpy.repeat(numpy.arange(64), numpy.diff(start))
left = grid[:, 0] < 3.5
N, dN, grade = perigal.shape_functions(grid, 2.5, spacing=1, alive=left[owner] == left[node])
verdict('shape functions: a cut', abs(N @ left - left).max() < 1e-12 and abs(N.dense()[left][:, ~left]).max() == 0)
strip = dict(bar, method={'force': 'bond', 'horizon': '3 spacing'}, solver={'kind': 'static'},
             boundary=[{'name': 'top', 'set': 'top', 'displacement': {'y': 1e-5}},
                       {'name': 'bottom', 'set': 'bottom', 'displacement': {'x': 0, 'y': 0}}])
strip.pop('failure', None)
strip.pop('cracks', None)
e = perigal.stiffness(strip)
T, K = e.T.dense(), e.K.dense()
d = T @ numpy.linalg.solve(T.T @ K @ T, T.T @ (e.f - e.K @ e.g)) + e.g
with warnings.catch_warnings():
    warnings.simplefilter('ignore')
    r = perigal.run(strip, out=os.path.join(work, 'strip'), threads=1)
u = r.field('displacement')
verdict('stiffness: solved, it is the displacement of the run', numpy.array_equal(K, K.T)
        and abs((e.N @ d).reshape(u.shape) - u).max() <= 1e-10 * abs(u).max()
        and numpy.array_equal(e.place, r.field('place')) and len(e.free) + e.idle < len(e.f))
half = perigal.stiffness(strip, t=.5, set={'title': 'x'})
verdict('stiffness: half the load', abs(2 * half.g - e.g).max() <= 1e-15 * abs(e.g).max())
refused('families: horizon', perigal.UsageError, 'horizon', lambda: perigal.families(x, -1))
refused('families: points', perigal.UsageError, 'points', lambda: perigal.families(x[0], 1))
refused('shape functions: kernel', perigal.UsageError, 'cubic_spline',
        lambda: perigal.shape_functions(x, .5, spacing=.2, kernel='box'))
refused('shape functions: mask', perigal.UsageError, 'flags',
        lambda: perigal.shape_functions(x, .5, spacing=.2, alive=[1]))
refused('stiffness: wrong key', perigal.SceneError, 'did you mean spacing', lambda: perigal.stiffness(demo, {'spacng': 1}))
refused('stiffness: no matrix', perigal.UsageError, 'neighbours of neighbours',
        lambda: perigal.stiffness(strip, {'method.force': 'lps'}))
refused('stiffness: t', perigal.UsageError, 'number', lambda: perigal.stiffness(strip, t='x'))

os.environ['PERIGAL'] = '/nowhere/perigal'
refused('no program', FileNotFoundError, 'perigal', lambda: perigal.check(demo))
print(f'1..{count}')
sys.exit(bad > 0)

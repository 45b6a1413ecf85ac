"""Conditions in time: energy over seven decades of the time step, a million steps, interruptions."""
from cells import Cell, Run, energy_error, same
from scenes import merged, plate, tension


def bar(method):
    scene = {k: v for k, v in tension(2, 'stress', method.poisson('stress', 2), spacing=0.125).items() if k != 'reference'}
    scene['boundary'][-1]['ramp'] = 'constant'
    return merged(scene, method.changes)


def time_steps(method):
    implicit = 'newmark' in method.name
    for exponent in range(-9, -2):
        scene = bar(method)
        scene['solver'] = {**scene['solver'], 'dt': 10.0 ** exponent, 'time_steps': 200}
        yield Cell('time step', f'1e{exponent} s', method.name, [Run(scene)], 'energy lost', energy_error, 1e-6 if implicit else 0.02,
                   refusal='' if implicit or exponent < -3 else 'a wave passes more than four points in a step')


def breaking_scene(method):
    """A plate with a crack that is torn apart."""
    scene = merged(plate(nu=method.poisson('stress', 2), stretch=1e-3), method.changes)
    scene['boundary'] = [{'name': 'top', 'set': 'top_grip', 'velocity': {'x': 0, 'y': 10}},
                         {'name': 'bottom', 'set': 'bottom_grip', 'velocity': {'x': 0, 'y': -10}}]
    scene['solver'] = {**scene['solver'], 'end': 3e-4}
    if 'newmark' in method.name:
        scene['solver']['dt'] = 3e-6
    return scene


def breaking(method):
    scene = breaking_scene(method)
    yield Cell('threads, in motion', '2 for 1', method.name, [Run(scene), Run(scene, options=('--threads', '2'))], 'change of the answer', same(), 0.0)
    yield Cell('interrupted and resumed', 'in motion', method.name, [Run(scene), Run(scene, interrupt=400)], 'change of the answer', same(), 0.0)


def million(method):
    if 'verlet' in method.name and 'galerkin' not in method.name:
        scene = bar(method)
        scene['spacing'] = 0.25
        scene['boundary'] = scene['boundary'][:2]
        scene['initial'] = {'velocity': {'x': '0.01 s^-1*x', 'y': '-0.005 s^-1*y'}}
        scene['solver'] = {**scene['solver'], 'time_steps': 1000000}
        yield Cell('a million steps', 'free vibration', method.name, [Run(scene)], 'energy lost', energy_error, 0.02, seconds=600)


def cells(method):
    if 'motion' in method.kinds:
        for group in (time_steps, breaking, million):
            yield from group(method)

"""Runs that are interrupted: small scenes of every kind of run, by number."""
import math
import os
import random
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', 'random'))
import scenes  # noqa: E402

KINDS = ['facets', 'statics', 'bonds', 'newmark', 'explicit', 'contact', 'fronts', 'running', 'ranks', 'impact', 'stages', 'relaxed', 'unstable', 'tips', 'sweep',
         'closed']
CHECKPOINTS = [1e-6, 0.02, 300.0]
SLOW = ('ranks', 'sweep')                            # several processes: their signals come by the clock


class Case:
    """data, files: of the scene; sets: values of a sweep; ranks: how many, 0 without MPI."""

    def __init__(self, kind, scene, sets=(), ranks=0):
        self.kind, self.data, self.files, self.sets, self.ranks = kind, scene.data, scene.files, list(sets), ranks


def wave(data):
    """Time in which a wave passes the spacing of a scene of scenes.py, s."""
    return data.get('spacing', 0.1) / math.sqrt(1e9 / 2500)


def fixed(rng, data, steps):
    if data['solver']['kind'] == 'static' and 'stages' not in data:
        data['solver'].update(stepping='fixed', steps=rng.randint(2, steps))


def plain(rng, maker):
    return maker.make()


def statics(rng, maker):
    scene = maker.make()
    if rng.random() < 0.7:
        fixed(rng, scene.data, 6)
    return scene


def bonds(rng, maker):
    scene = maker.make()
    if rng.random() < 0.4:
        fixed(rng, scene.data, 4)
    elif 'stages' not in scene.data:
        scene.data['solver']['max_events'] = rng.randint(6, 40)
    return scene


def facets(rng, maker):
    scene = maker.make()
    if scene.data['dimension'] == 3:
        return None
    if rng.random() < 0.3:
        fixed(rng, scene.data, 4)
    return scene


def fronts(rng, maker):
    scene = maker.make()
    if scene.data['dimension'] == 2:
        return None
    scene.data['solver']['max_events'] = 3
    return scene


def running(rng, maker):
    scene = maker.make()
    if scene.data['dimension'] == 3:
        return None
    scene.data['solver'] = {'kind': 'newmark', 'dt': wave(scene.data) * rng.uniform(0.3, 1.5), 'time_steps': rng.randint(6, 16)}
    return scene


def unstable(rng, maker):
    scene = maker.make()
    if scene.data['dimension'] == 3:
        return None
    how = rng.choice(['hold', 'dynamic'])
    scene.data['solver'].update(on_instability=how, max_events=8)
    return scene


def impact(rng, maker):
    scene = maker.make()
    if 'platens' in scene.data:
        return None
    if rng.random() < 0.5:
        scene.data['solver'] = {'kind': 'newmark', 'dt': wave(scene.data) * rng.uniform(0.5, 3), 'time_steps': rng.randint(4, 10)}
    else:
        scene.data['solver'] = {'kind': rng.choice(['verlet', 'central']), 'dt': 0.1 * wave(scene.data), 'time_steps': rng.randint(20, 60)}
    return scene


def closed(rng, maker):
    """Cracks that grow and whose faces touch."""
    scene = facets(rng, maker)
    if scene:
        scene.data['contact'] = rng.choice([{'kind': 'normal'}, {'kind': 'friction', 'coefficient': rng.uniform(0.1, 0.8)}])
    return scene


def stages(rng, maker):
    scene = maker.make()
    if 'stages' not in scene.data and not maker.heated:
        maker.stage(scene.data)
    return scene if 'stages' in scene.data else None


def of_ranks(rng, maker):
    scene = maker.make()
    return scene if 'mesh' not in scene.data else None


def sweep(rng, maker):
    scene = maker.make()
    return scene if 'rock' in scene.data['materials'] and 'model' not in scene.data['materials']['rock'] else None


# kind of scenes.py, what is made of it
MADE = {'statics': ('elastic', statics), 'tips': ('tips', plain), 'bonds': ('strength', bonds), 'facets': ('facets', facets), 'fronts': ('facets', fronts),
        'newmark': ('motion', plain), 'explicit': ('explicit', plain), 'relaxed': ('relaxed', plain), 'contact': ('contact', plain), 'impact': ('contact', impact),
        'closed': ('facets', closed), 'running': ('facets', running), 'unstable': ('facets', unstable)}


def attempt(number, kind, attempt_of):
    """The scene of a number, at the so-manieth attempt; None: none of its kind comes of it."""
    seed = 1000 * number + attempt_of
    rng = random.Random(f'case {seed}')
    if kind == 'stages':
        scene = stages(rng, scenes.Maker(seed, rng.choice(['elastic', 'strength'])))
        return scene and Case(kind, scene)
    if kind == 'ranks':
        of = rng.choice(['explicit', 'explicit', 'facets', 'strength', 'motion', 'contact', 'elastic'])
        scene = of_ranks(rng, scenes.Maker(seed, of))
        return scene and Case(kind, scene, ranks=rng.choice([2, 3]))
    if kind == 'sweep':
        scene = sweep(rng, scenes.Maker(seed, rng.choice(['explicit', 'facets', 'strength', 'motion'])))
        return scene and Case(kind, scene, sets=['materials.rock.youngs_modulus=1e9,0.9e9,0.8e9'])
    of, make = MADE[kind]
    scene = make(rng, scenes.Maker(seed, of))
    return scene and Case(kind, scene)


def case(number, accept, kind=None):
    """The first scene of the number that `accept` takes; its checkpoints come at every occasion, at some, or at the interruption only."""
    kind = kind or KINDS[number % len(KINDS)]
    for k in range(60):
        found = attempt(number, kind, k)
        if not found:
            continue
        found.data.setdefault('output', {})['checkpoint'] = random.Random(f'checkpoint {number}').choice(CHECKPOINTS)
        if accept(found):
            return found
    raise LookupError(f'no scene of the kind {kind} for number {number}')

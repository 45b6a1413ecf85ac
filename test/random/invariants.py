"""What must hold of every run, whatever the scene. Each function is one invariant: it yields messages, none where it holds.

An invariant asks for the runs that it needs; where its scene is not for it (mirror image of moved points, doubled loads of a body that breaks) it yields
nothing. A refusal of an image of a scene that ran is a violation too: whether a scene can be computed does not depend on the unit or on the place.
"""
import copy
import math
import re

import reference
from images import Image, mirror, quarter, turn
from runs import DONE, FAILED, INTERRUPTED, REFUSED, SLOW, USAGE

LINEAR = ('elastic', 'tips')
SAME = 1e-7                    # rounding, seen through the condition of a system
EVENTS = 1e-5                  # loads of events, which follow each other


class Case:
    """A scene with the program that runs it; `base` is its own run."""

    def __init__(self, scene, program):
        self.scene, self.program = scene, program
        self.base = program.run(scene.data, scene.files)

    def run(self, change=None, files=None, **options):
        data = copy.deepcopy(self.scene.data)
        if change:
            data = change(data) or data
        return self.program.run(data, self.scene.files if files is None else files, **options)

    @property
    def data(self):
        return self.scene.data

    @property
    def lattice(self):
        return 'body' in self.data and 'points' not in self.data

    @property
    def linear(self):
        return self.scene.kind in LINEAR and 'contact' not in self.data

    @property
    def sided_platens(self):
        """Platens, if there are any, lie on whole sides of the body from the beginning."""
        return 'platens' not in self.data or 'box' in self.data['body'][0].get('add', {})

    def of_faces(self, name):
        """Is a set one of faces? Others are of points, on which a total force acts inside the body too."""
        return name in ('left', 'right', 'bottom', 'top', 'back', 'front') or 'boundary' in self.data.get('sets', {}).get(name, {})

    @property
    def names_sides(self):
        return any(load.get('set') in ('left', 'right', 'bottom', 'top', 'back', 'front') for load in self.data['boundary'])


def unit_of(name):
    return name[name.rfind('[') + 1:-1]


SKIPPED = ('residual', 'iterations', 'utilisation', 'step', 'level', 'event', 'time')
WITHOUT = ('_x', '_y', '_z')


def scales(case, least=1e-5):
    """The largest value of each unit over the run, but not what rounding leaves of a body that cracks have parted: forces at least 1e-5 of the strength
    that the loads stand for; moments at least forces on an arm of the body."""
    size = least * 1e6 * case.data.get('thickness', 1.0)
    scale = {'N': size, 'J': 1e-3 * size}
    for k, name in enumerate(case.base.names):
        values = [abs(row[k]) for row in case.base.rows if math.isfinite(row[k])]
        scale[unit_of(name)] = max([scale.get(unit_of(name), 0.0)] + values)
    if 'N' in scale:
        scale['N m'] = max(scale.get('N m', 0.0), scale['N'])
    return scale


def differs(case, other, image=None, tolerance=SAME, only_first=False, least=1e-5):
    """The worst column of the run of an image against the base; '' where all agree."""
    base = case.base
    if not other.done:
        return f'ends with {other.code}: {other.first_words()}'
    if not base.rows or not other.rows or len(base.rows) != len(other.rows) and not only_first:
        return f'{len(other.rows)} rows for {len(base.rows)}'
    image = image or Image(case.scene.dimension)
    scale, worst, text = scales(case, least), 0.0, ''
    # the place of a tip is no number that a scale can be had of
    for k, name in enumerate(base.names):
        word = name.rsplit(' [', 1)[0]
        if word in SKIPPED or word.startswith('tip.') and word[-2:] in ('.x', '.y') or not scale.get(unit_of(name)):
            continue
        factor, parts = image.column(name)
        if any(p not in other.names for p, _ in parts):
            return f'no column {name}'
        where = [(other.names.index(p), w) for p, w in parts]
        for r in [0] if only_first else range(len(base.rows)):
            mine, its = factor * base.rows[r][k], sum(w * other.rows[r][j] for j, w in where)
            if math.isnan(mine) and math.isnan(its):
                continue
            off = abs(mine - its) / (abs(factor) * scale[unit_of(name)])
            if not off <= worst:
                worst, text = off, f'{name} in row {r}: {its:.9g} for {mine:.9g}'
                if math.isnan(off):
                    return text
    return f'{worst:.2e} off: {text}' if worst > tolerance else ''


# ---- of the run alone
def sound(case):
    """It ends, with a result or with a reason; numbers are finite, steps in equilibrium, nothing over its limit is left."""
    run = case.base
    odd = re.search(r'.*(?<![a-z])(nan|inf)(?![a-z]).*', '\n'.join([run.said] + run.report.get('warnings', [])))
    if odd:
        yield f'a message names what is no number: {odd.group(0)}'
    if run.code not in (DONE, USAGE, REFUSED, FAILED, SLOW):
        yield f'exit code {run.code}: {run.first_words()}'
    elif run.code != DONE:
        if len(run.said.strip()) < 30:
            yield f'exit code {run.code} without a reason: {run.said.strip()}'
    else:
        if not run.report or not run.rows:
            yield 'no report or no rows'
            return
        optional = ('tip.', 'front.', 'utilisation')
        bad = [n for k, n in enumerate(run.names) if not n.startswith(optional) and any(not math.isfinite(r[k]) for r in run.rows)]
        if bad:
            yield f'not finite: {bad[0]}'
        if run.report.get('bonds_over_limit'):
            yield f'{run.report["bonds_over_limit"]} bonds over their limit'
        if case.scene.kind not in ('relaxed', 'explicit') and run.report.get('residual_max', 0) > 1.01e-8:
            yield f'residual {run.report["residual_max"]}'


def checked(case):
    """`check` refuses what a run refuses at its start, and nothing else: of the scene, and of all others made of it that were refused."""
    code, said = case.program.check(case.data, case.scene.files)
    refused = case.base.code in (REFUSED, USAGE)
    if code not in (DONE, REFUSED):
        yield f'check ends with {code}: {said.strip()[:200]}'
    elif (code == REFUSED) != refused:
        yield f'check ends with {code}, the run with {case.base.code}: {case.base.first_words()}'
    for data, files, run in case.program.alone():
        if run.code not in (REFUSED, USAGE) or run is case.base:
            continue
        code, _ = case.program.check(data, files)
        if code != REFUSED:
            yield f'check ends with {code}, the run with {run.code}: {run.first_words()}'
            return


def force_before(case):
    """Of a relaxation that ends with the body in pieces: the force that its work stands for."""
    moved = max((abs(v) for b in case.data['boundary'] for v in b.get('displacement', {}).values()), default=0.0)
    return case.base.report['energy']['external'] / moved if case.scene.kind == 'relaxed' and moved else 0.0


def balanced(case):
    """Forces and moments of all loads and supports of a body at rest add up to nothing."""
    if case.scene.kind in ('motion', 'explicit') or not case.base.done:
        return
    names, bound = case.base.names, 1e-4 if case.scene.kind == 'relaxed' else 1e-7
    # moments of platens are about their places
    for what in ('force',) if 'platens' in case.data else ('force', 'moment'):
        for a in 'xyz':
            columns = [k for k, n in enumerate(names) if f'.{what}_{a} [' in n]
            if not columns:
                continue
            size = max([scales(case)['N'], force_before(case)] + [sum(abs(row[k]) for k, n in enumerate(names) if '.force_' in n) for row in case.base.rows])
            for row in case.base.rows:
                total = sum(row[k] for k in columns)
                if size and abs(total) > bound * size and not case.base.warned('miss balance'):
                    yield f'{what} {a} out of balance by {total / size:.2e} of the forces'
                    break


def energies(case):
    """Work becomes energy: of linear bodies all of it, at rest and in motion; of others none is created."""
    report = case.base.report
    if not case.base.done or 'energy' not in report:
        return
    e = report['energy']
    size = max(abs(v) for v in e.values())
    if not size:
        return
    breaks = 'failure' in case.data
    if not breaks and case.scene.kind in ('elastic', 'tips', 'motion') and abs(e['dissipated']) > 1e-6 * size:
        yield f'elastic, yet {e["dissipated"] / size:.2e} of the energy is lost'
    if breaks and e['dissipated'] < -1e-6 * size and not case.base.warned('has fed'):
        yield f'energy is created: {e["dissipated"] / size:.2e}'


def facets(case):
    """Cracks that grow by facets take the fracture energy, or the run says that they do not; G = K^2 / E'."""
    if case.scene.kind != 'facets' or not case.base.done:
        return
    found = case.base.report.get('fracture', {})
    ratio = found.get('dissipated_over_G0_length', found.get('dissipated_over_G0_area'))
    # the last event has taken its energy at the load at which the next one would begin, which may lie beyond the end of the run
    events = max(1, sum(v > 0 for v in case.base.column('event')))
    if ratio is not None and found.get('area', 0) > 0 and not 0.7 * (1 - 1 / events) < ratio < 1.3 and not case.base.report['warnings']:
        yield f'{ratio:.2f} of the fracture energy was taken, without a word'


def prescribed(case):
    """What a support of shape functions is said to move by is what is prescribed."""
    if not case.base.done or case.data['method'].get('force', 'galerkin') != 'galerkin' or 'stages' in case.data or case.scene.kind in ('explicit', 'relaxed'):
        return
    factor = case.base.last('load_factor')
    for load in case.data['boundary']:
        for axis, value in load.get('displacement', {}).items():
            found = case.base.last(f'{load["name"]}.displacement_{axis}')
            if abs(found - factor * value) > 1e-9 * abs(value):
                yield f'{load["name"]}.displacement_{axis} is {found:.9g}, prescribed {factor * value:.9g}'


# ---- images
def told_rounding(case):
    """What a run says that weak motions make of rounding: so many times 1e-14, the rounding of sums over some dozen bonds. Where prescribed values are
    transformed rigid motions are reproduced up to the rounding of that transformation, of which the run tells what strains it makes."""
    words = '\n'.join(case.base.report.get('warnings', []))
    weak = 1e-14 * max([float(t) for t in re.findall(r'\((\S+) times less than usual\)', words)], default=0.0)
    if case.data['method'].get('essential') != 'transformation':
        return weak
    return weak + max([float(t) for t in re.findall(r'gives strains of (\S+) times the angle', words)], default=0.0)


def at_the_end(case, run):
    """Kernels that do not vanish at the horizon: a pair exactly there has a bond or none as coordinates are rounded; ten times its share of all bonds."""
    ends = case.data['method'].get('kernel', 'constant' if case.data['method'].get('force', 'galerkin') != 'galerkin' else 'cubic_spline')
    mine, its = case.base.report.get('bonds'), run.report.get('bonds') if run.done else None
    return 10 * abs(mine - its) / mine if ends in ('constant', 'linear_r', 'inverse_r') and mine and its else 0.0


def image_of(case, image, tolerance, what, files=None):
    breaks = 'failure' in case.data
    data = image.scene(case.data)
    files = [(n, image.points(t) if n.endswith('.csv') else t) for n, t in case.scene.files]
    run = case.program.run(data, files)
    text = differs(case, run, image, EVENTS if breaks else tolerance + told_rounding(case) + at_the_end(case, run))
    if text:
        yield f'{what}: {text}'


def rigid_points(case):
    return 'perturb' in case.data or 'mesh' in case.data


def mirrored(case):
    if not rigid_points(case):
        yield from image_of(case, mirror(case.scene.dimension, case.scene.seed % case.scene.dimension), SAME, 'mirror image')


def quarter_turned(case):
    if not rigid_points(case):
        yield from image_of(case, quarter(case.scene.dimension), SAME, 'turned by 90 degrees')


def moved(case):
    """Far away: what rounding of the coordinates makes, not more."""
    if 'mesh' in case.data:
        return
    for distance in (1e3, 1e6):
        away = [distance, -distance, distance][:case.scene.dimension]
        h = case.data.get('spacing', 0.1)
        yield from image_of(case, Image(case.scene.dimension, shift=away), SAME + 1e-12 * distance / h, f'moved by {distance:g} m')


def resized(case):
    if 'mesh' not in case.data:
        for scale, stress in ((1e-3, 1.0), (0.0254, 1e3), (1e3, 1e-3)):
            yield from image_of(case, Image(case.scene.dimension, scale=scale, stress=stress), SAME, f'{scale:g} times as large, {stress:g} times as stiff')


def nudged(case):
    """The last digits of the spacing and of the lattice's place change the last digits of the answer."""
    if not case.lattice or 'perturb' in case.data:      # of moved points the number decides, which may change with the offset
        return
    for name, change in (('spacing', 1e-13), ('spacing', -1e-13), ('offset', 3e-13)):
        def nudge(data, name=name, change=change):
            if name == 'spacing':
                data['spacing'] *= 1 + change
            else:
                data['lattice_offset'] = [v + change for v in data.get('lattice_offset', [0.0] * data['dimension'])]
        text = differs(case, case.run(nudge), tolerance=(1e-3 if 'failure' in case.data else 1e-6) + told_rounding(case))
        if text:
            yield f'{name} by {change:g}: {text}'


def threaded(case):
    text = differs(case, case.run(options=('--threads', '2')), tolerance=0.0)
    if text:
        yield f'two threads: {text}'


def resumed(case):
    run = case.run(kill_after=300)
    if run.code == INTERRUPTED:
        return                                          # before there was anything to keep
    text = differs(case, run, tolerance=0.0)
    if text:
        yield f'interrupted and resumed: {text}'


def on_ranks(case):
    ranks = 2 + case.scene.seed % 2
    def divide(data):
        if data['solver']['kind'] in ('static', 'newmark'):
            data['solver']['division'] = ('auto', 'subdomains', 'matrices')[case.scene.seed % 3]
    run = case.run(divide, options=(), ranks=ranks)
    if run.code is None:
        return
    if run.code in (REFUSED, USAGE):
        if 'rank' not in run.said:
            yield f'{ranks} ranks: refused without naming them: {run.first_words()}'
        return
    text = differs(case, run, tolerance=1e-4 if case.scene.kind == 'relaxed' else EVENTS)
    if text:
        yield f'{ranks} ranks: {text}'


# ---- other ways to the same answer
def same_way(case, run, what, tolerance=SAME):
    """A refusal is an answer: this way is not open to this scene; and one that is slower is not wrong."""
    if run.code in (REFUSED, USAGE, None):
        return
    breaks = 'failure' in case.data or 'contact' in case.data or 'platens' in case.data
    text = differs(case, run, tolerance=1e-4 if case.scene.kind == 'relaxed' else max(tolerance, EVENTS) if breaks else tolerance)
    if text:
        yield f'{what}: {text}'


def plain(case):
    """What spares work changes no answer."""
    run = case.run(options=('--threads', '1', '--plain'))
    if run.code in (REFUSED, USAGE):
        yield f'--plain is refused: {run.first_words()}'
    yield from same_way(case, run, '--plain')


def summed_otherwise(case):
    """Sums over bonds by a stencil, by lists or by transforms."""
    if case.data['method'].get('force', 'galerkin') == 'galerkin':
        return
    for way in ('list', 'stencil', 'fft'):
        yield from same_way(case, case.run(lambda d, way=way: d['method'].update(evaluation=way)), f'evaluation: {way}')


def solved_otherwise(case):
    """By another linear solver."""
    if case.data['solver']['kind'] != 'static':
        return
    ways = [w for w in ('cholmod', 'umfpack', 'pcg') if w != case.data['solver'].get('linear')]
    way = ways[case.scene.seed % len(ways)]
    yield from same_way(case, case.run(lambda d: d['solver'].update(linear=way)), f'linear: {way}', tolerance=EVENTS)


def as_total(case):
    """What a traction adds up to, given as a total force on the same faces, is that traction."""
    if case.data['solver']['kind'] != 'static' or 'stages' in case.data:
        return
    loads = [b['name'] for b in case.data['boundary'] if 'traction' in b and case.of_faces(b['set'])]
    factors = case.base.column('load_factor')
    row = max(range(len(factors)), key=lambda r: abs(factors[r]), default=None)
    if not loads or row is None or not factors[row]:
        return
    def total(data):
        for load in data['boundary']:
            if load['name'] in loads:
                load['force'] = {a: case.base.column(f'{load["name"]}.force_{a}')[row] / factors[row] for a in load.pop('traction')}
    run = case.run(total)
    text = differs(case, run, tolerance=EVENTS if 'failure' in case.data or 'contact' in case.data else SAME)
    if text:
        yield f'tractions as total forces: {text}'


def retimed(case):
    """In another unit of time, seconds that are so much shorter."""
    if case.scene.kind not in ('motion', 'explicit', 'relaxed'):
        return
    for T in (1e-3, 60.0):
        image = Image(case.scene.dimension)
        image.factors.update({'m/s': 1 / T, 'm/s2': 1 / T ** 2, 'kg/m3': T ** 2, 'kg': T ** 2, 's': T})
        data = image.scene(case.data)
        for key in ('dt', 'end'):
            if key in data['solver']:
                data['solver'][key] *= T
        run = case.program.run(data, case.scene.files)
        text = differs(case, run, image, 1e-4 if case.scene.kind == 'relaxed' else EVENTS if 'failure' in data else 1e-6)
        if text:
            yield f'seconds {1 / T:g} times as long: {text}'
            return


# ---- linear bodies
POWERS = {'N': 1, 'm': 1, 'N m': 1, 'J': 2, 'Pa m^(1/2)': 1, 'J/m^2': 2}


def scaled_loads(data, factor, names=None):
    for load in data['boundary']:
        if names is not None and load['name'] not in names:
            continue
        for kind in ('displacement', 'traction', 'force', 'body_force', 'velocity'):
            if kind in load:
                load[kind] = {a: v * factor for a, v in load[kind].items()}
        if 'gravity' in load:
            load['gravity'] = [v * factor for v in load['gravity']]
        for kind in ('pressure', 'temperature'):
            if kind in load:
                load[kind] *= factor
    for platen in data.get('platens', []):
        for kind in ('displacement', 'force'):
            if kind in platen:
                platen[kind] = {a: v * factor for a, v in platen[kind].items()}
    return data


def proportional(case):
    """Twice the load, backwards, and the smallest load: all answers in proportion, energies and J as its square. Contact is as proportional, but not backwards."""
    contact = case.scene.kind == 'contact' and case.sided_platens and 'stages' not in case.data
    for factor in (-2.0, 3e-12):
        if not case.linear and not (contact and factor > 0):
            continue
        run = case.run(lambda d, factor=factor: scaled_loads(d, factor))
        if not run.done:
            yield f'{factor:g} times the load ends with {run.code}: {run.first_words()}'
            return
        for name in case.base.names:
            word, unit = name.rsplit(' [', 1)[0], unit_of(name)
            size, power = scales(case).get(unit, 0), POWERS.get(unit, 0)
            if not size or not power or word.startswith(('tip.', 'front.')) and word[-2:] in ('.x', '.y', '.z'):
                continue
            mine, its = factor ** power * case.base.last(word), run.last(word)
            if math.isnan(mine) and math.isnan(its):
                continue
            if not abs(its - mine) <= (EVENTS if contact else SAME) * abs(factor) ** power * size:
                yield f'{factor:g} times the load: {name} {its:.9g} for {mine:.9g}'
                return


def superposed(case):
    """What two loads do together is the sum of what each does alone."""
    loads = [b['name'] for b in case.data['boundary'] if 'spring' not in b and not (set(b.get('displacement', {'x': 1}).values()) == {0.0})]
    if not case.linear or len(loads) < 2:
        return
    first = case.run(lambda d: scaled_loads(d, 0.0, loads[1:]))
    second = case.run(lambda d: scaled_loads(d, 0.0, loads[:1]))
    if not (first.done and second.done):
        return
    scale = scales(case)
    for name in case.base.names:
        word, unit = name.rsplit(' [', 1)[0], unit_of(name)
        if unit in ('N', 'm', 'N m') and not word.startswith(('tip.', 'front.')) and scale[unit]:
            off = abs(first.last(word) + second.last(word) - case.base.last(word)) / scale[unit]
            if not off <= SAME:
                yield f'sum of two loads: {name} off by {off:.2e}'
                return


def strained(case, run, what, strain, share, excused):
    """A run that should strain nothing: at most this share of the energy of such a strain in a body of size 1, or a refusal with one of these words."""
    if run.code == REFUSED and any(words in run.said for words in excused):
        return
    if not run.done:
        yield f'{what}: ends with {run.code}: {run.first_words()}'
        return
    size = 1e9 * strain ** 2 * case.data.get('thickness', 1.0) * 0.1
    energy = run.report['energy']['strain']
    if not abs(energy) <= share * size:
        yield f'{what}: strain energy {energy:.3g} J, {energy / size:.1e} of that of a strain as large'


def rigid(case):
    """Supports and loads that move the body as a rigid one strain nothing: no energy, no forces, no J."""
    if not case.linear or 'stages' in case.data or any('spring' in b for b in case.data['boundary']):
        return
    d, angle = case.scene.dimension, 1e-3
    def stiff(data):
        held = next(b for b in data['boundary'] if 'displacement' in b)
        move = {'x': f'0.002 m - {angle}*y', 'y': f'-0.001 m + {angle}*x'}
        if d == 3:
            move['z'] = '0.003 m'
        if set(held['displacement']) != set('xyz'[:d]):
            return None
        data['boundary'] = [{**held, 'displacement': move}]
        return data
    if set(next((b for b in case.data['boundary'] if 'displacement' in b), {'displacement': {}})['displacement']) != set('xyz'[:d]):
        return
    # by the patch test it may be refused, with this support alone
    yield from strained(case, case.run(stiff), 'moved as a rigid body', angle, 1e-12, ('uniform stress',))


def carried(case):
    """A rigid motion of all supports on top of the loads changes no force, no J and no K."""
    if not case.linear or 'stages' in case.data or any('spring' in b for b in case.data['boundary']):
        return
    d, angle = case.scene.dimension, 1e-2
    motion = {'x': f'0.02 m - {angle}*y', 'y': f'-0.01 m + {angle}*x', 'z': '0.03 m'}
    def carry(data):
        for load in data['boundary']:
            if 'displacement' in load:
                load['displacement'] = {a: f'{v!r} m + {motion[a]}' for a, v in load['displacement'].items()}
    if case.data['method'].get('essential') == 'penalty' or case.base.warned('miss balance'):
        return                                          # which is not exact; or the run says that a turn strains the body
    run = case.run(carry)
    if run.code == REFUSED and 'uniform stress' in run.said:
        return
    if not run.done or len(run.rows) != len(case.base.rows):
        yield f'carried along: ends with {run.code}: {run.first_words()}'
        return
    scale = scales(case)
    for name in case.base.names:
        word, unit = name.rsplit(' [', 1)[0], unit_of(name)
        if unit not in ('N', 'Pa m^(1/2)', 'J/m^2') or not scale.get(unit):
            continue
        # rounding of displacements a thousand times as large
        off = abs(run.last(word) - case.base.last(word)) / scale[unit]
        if off > 1e-5 or math.isnan(run.last(word)) != math.isnan(case.base.last(word)):
            yield f'carried along: {name} {run.last(word):.9g} for {case.base.last(word):.9g}'
            return


def heated(case):
    """Warm all over, held where it would go by itself: no stress."""
    if not case.linear or case.data['method'].get('force', 'galerkin') != 'galerkin' or case.data.get('plane') == 'strain':
        return
    if any('spring' in b for b in case.data['boundary']):
        return                                          # which may hold a second body
    held = next((b for b in case.data['boundary'] if set(b.get('displacement', {})) == set('xyz'[:case.scene.dimension])), None)
    if not held:
        return
    strain = 1e-3
    def warm(data):
        for material in data['materials'].values():
            material['expansion'] = 1e-5
        data.pop('stages', None)
        data['solver'] = {**data['solver'], 'stepping': 'fixed', 'steps': 2}
        data['boundary'] = [{**held, 'displacement': {a: f'{strain}*{a}' for a in held['displacement']}}, {'name': 'warmth', 'temperature': strain / 1e-5}]
    run = case.run(warm)
    # it may be refused by the patch test, and near Poisson's ratio 1/2
    yield from strained(case, run, 'warm without hindrance', strain, 1e-10, ('uniform stress', 'dilatation'))
    if not run.done:
        return
    if run.warned('miss balance') and not case.base.warned('miss balance'):
        yield f'warm without hindrance: {next(t for t in run.report["warnings"] if "miss balance" in t)}'
    def hold(data):
        warm(data)
        data.setdefault('sets', {})['skin'] = {'boundary': ['all']}
        data['boundary'][0] = {**held, 'set': 'skin', 'displacement': {a: 0.0 for a in held['displacement']}}
    run = case.run(hold)
    # a point between cracks that nothing holds bears no warmth
    if case.lattice and run.code not in (REFUSED, USAGE) and not run.done and 'nothing holds a part of the body' not in run.said:
        yield f'warm and held all round: ends with {run.code}: {run.first_words()}'


def returned(case):
    """Loads that return to zero leave an elastic body as it was."""
    if 'stages' in case.data or case.scene.kind not in ('elastic', 'tips', 'contact') or case.data.get('contact', {}).get('kind') == 'friction' or 'platens' in case.data:
        return
    names = [b['name'] for b in case.data['boundary'] if any(k in b for k in ('traction', 'force', 'body_force', 'gravity', 'pressure'))
             or any(v for v in b.get('displacement', {}).values())]
    if not names or any('temperature' in b for b in case.data['boundary']):
        return
    def there_and_back(data):
        data['stages'] = [{'name': 'there', 'boundary': {n: 1.0 for n in names}}, {'name': 'back', 'boundary': {n: 0.0 for n in names}}]
    run = case.run(there_and_back)
    if not run.done:
        yield f'there and back: ends with {run.code}: {run.first_words()}'
        return
    scale = scales(case)
    for name in case.base.names:
        word, unit = name.rsplit(' [', 1)[0], unit_of(name)
        if unit in ('N', 'm') and not word.startswith(('tip.', 'front.')) and scale[unit] and not abs(run.last(word)) <= 1e-6 * scale[unit]:
            yield f'there and back: {name} {run.last(word):.3g}, on the way {scale[unit]:.3g}'
            return
    if run.warned('miss balance') and not case.base.warned('miss balance'):
        yield f'there and back: {next(t for t in run.report["warnings"] if "miss balance" in t)}'


def turned_little(case):
    """Turned by 37 degrees the lattice lies otherwise: loads and energies change by the error of the discretisation."""
    if not case.linear or not case.lattice or case.names_sides or case.base.report.get('patch_error', 1) > 0.02 or case.scene.dimension == 3:
        return
    if any('box' in part.get('add', part.get('subtract', {})) for part in case.data['body']) or any('model' in m for m in case.data['materials'].values()):
        return
    acts = [load.get('set', 'all') for load in case.data['boundary']]
    if any('boundary' not in case.data['sets'].get(name, ['boundary']) for name in acts if name in case.data.get('sets', {})):
        return                                          # of so few points other ones are taken
    run = case.program.run(turn(2, math.radians(37)).scene(case.data), case.scene.files)
    if not run.done:
        return
    # sets hold whole facets: those of a curved side that a condition takes may be others, and more or fewer of them
    for load in case.data['boundary']:
        pushed = [math.hypot(*(r.last(f'{load["name"]}.force_{k}') for k in 'xy')) for r in (case.base, run)]
        if abs(pushed[0] - pushed[1]) > 0.05 * pushed[0]:
            return
    a, b = case.base.report['energy']['strain'], run.report['energy']['strain']
    allowed = max(0.15, 2 * case.base.report.get('error_estimate', {}).get('relative', 0))
    if a and abs(a - b) > allowed * abs(a):
        yield f'turned by 37 degrees: strain energy {b:.6g} for {a:.6g}'


def as_elements(case):
    """The strain energy is that of finite elements on the same body, within what the run says of its own error."""
    if case.scene.kind != 'elastic' or not reference.available() or not reference.serves(case.data) or not case.base.report['energy']['strain']:
        return
    h, folder = case.data['spacing'], case.program.folder({}, [])
    rough, fine = (reference.energy(case.data, folder, size) for size in (h, 0.5 * h))
    if not rough or not fine or abs(fine - rough) > 0.1 * fine:
        return                                          # too large for a test, or no reference
    galerkin = case.data['method'].get('force', 'galerkin') == 'galerkin'
    told = 3 * case.base.report['patch_error'] + (2 * case.base.report['error_estimate']['relative'] if galerkin else 0)
    told += sum(float(m) / 100 for w in case.base.report['warnings'] for m in re.findall(r'about ([\d.]+) % shorter', w))
    told += 0.5 if case.base.warned('may be off by half') else 0
    found = case.base.report['energy']['strain'] / fine - 1
    if abs(found) > told + abs(fine - rough) / fine + 1e-3:
        yield f'strain energy {100 * found:+.1f} % off that of finite elements, {case.base.report["energy"]["strain"]:.6g} for {fine:.6g} J; told: {100 * told:.1f} %'


# ---- small things that must not matter
def soft_spring(case):
    """A spring of 1e-9 of the stiffness of the body, on any points, changes nothing, J and K included."""
    if case.scene.kind not in ('elastic', 'tips', 'facets') or case.scene.dimension == 3 and case.scene.kind == 'facets':
        return
    def add(data):
        data['boundary'].append({'name': 'soft', 'set': 'all', 'spring': {'all': 1e-9 * 1e9 * data.get('thickness', 1.0)}})
    if case.base.warned('the load that this part bears is not known'):
        return
    run = case.run(add)
    # of a crack that grows the first event: what has nearly come apart hangs on the spring
    # (of facets the forces of the first event: J is told where rings fit)
    # a body in pieces may hang on it
    text = differs(case, run, tolerance=1e-4, only_first=case.scene.kind == 'facets', least=1e-2) if run.done or run.code != REFUSED else ''
    if text:
        yield f'with a soft spring: {text}'


def doubled_crack(case):
    """A crack that is listed twice is that crack."""
    if not case.data.get('cracks') or 'from' not in case.data['cracks'][0]:
        return
    run = case.run(lambda d: d['cracks'].append(dict(d['cracks'][0])))
    if run.code == REFUSED:
        return
    a, b = case.base.report.get('energy', {}).get('strain'), run.report.get('energy', {}).get('strain')
    if not run.done or a is None or abs(a - b) > 1e-3 * abs(a):
        yield f'a crack listed twice: ends with {run.code}, strain energy {b} for {a}'


def loose(case):
    """A second body that nothing holds, under a load, is refused, whatever solves."""
    if case.scene.kind != 'elastic' or 'stages' in case.data or not case.lattice or case.scene.dimension == 3 and case.data['method'].get('force') == 'fcbm':
        return
    if any('spring' in load for load in case.data['boundary']):
        return                                          # on all points, those of the second body too
    h, d = case.data['spacing'], case.scene.dimension
    def add(data):
        low = [3.0] * d
        data['body'].append({'add': {'box': {'low': low, 'high': [3.0 + 8 * h] * d}}})
        for places in data.get('sets', {}).values():
            places['where'] = f"({places['where']}) and x < 2.5"
        data.setdefault('sets', {})['lost'] = {'where': 'x > 2.9'}
        data['boundary'].append({'name': 'lost', 'set': 'lost', 'body_force': {'x': 1e6}})
        if case.data['method'].get('force') != 'lps' and 'linear' not in data['solver']:
            data['solver']['linear'] = ('auto', 'pcg', 'umfpack')[case.scene.seed % 3]
        # the sides of the bounding box are others now
        return data
    if case.names_sides:
        return
    run = case.run(add)
    if run.code != REFUSED:
        yield f'a body that nothing holds, under a load, ends with {run.code}'
    elif not any(w in run.said for w in ('hold', 'held', 'loose', 'free')):
        yield f'a body that nothing holds: the reason is not named: {run.first_words()}'


def slot(case):
    """A slot cut out of a body is the slot that `cracks` makes of the same width, however narrow."""
    if case.scene.kind != 'elastic' or not case.lattice or case.scene.dimension != 2 or any(b.get('set') == 'left' for b in case.data['boundary']):
        return
    low = [min(c) for c in zip(*corners(case.data))]
    high = [max(c) for c in zip(*corners(case.data))]
    y, w = low[1] + 0.52 * (high[1] - low[1]), (0.05 + 0.5 * ((case.scene.seed * 7919) % 97) / 97) * case.data['spacing']
    x = low[0] + 0.45 * (high[0] - low[0])
    if any('box' in part.get('subtract', {}) for part in case.data['body']):
        return                                          # what is left beside two slots may be as narrow as a spacing
    holes = [part['subtract']['disk'] for part in case.data['body'] if 'disk' in part.get('subtract', {})]
    if len(holes) > 1:
        return
    if holes:                                           # into it
        x, y = holes[0]['center'][0], holes[0]['center'][1] + 0.3 * holes[0]['radius']
    one = case.run(lambda d: d['body'].append({'subtract': {'box': {'low': [low[0] - 0.3, y - w / 2], 'high': [x, y + w / 2]}}}))
    two = case.run(lambda d: d.setdefault('cracks', []).append({'from': [low[0] - 0.3, y], 'to': [x, y], 'width': w}))
    if one.done and two.done:
        a, b = (r.report['energy']['strain'] for r in (one, two))
        # the run says of a narrow slot that the points do not resolve it; one that bonds bridge is off by more
        told = 0.5 if one.warned('do not resolve') else one.report.get('error_estimate', {}).get('relative', 0)
        if abs(a - b) > max(0.1, told) * max(abs(a), abs(b)):
            yield f'a slot {w / case.data["spacing"]:.2f} spacings wide: strain energy {a:.6g} as part of the body, {b:.6g} by cracks'


def corners(data):
    found = []
    for part in data['body']:
        shape = part.get('add', {})
        for kind, s in shape.items():
            if kind == 'box':
                found += [s['low'], s['high']]
            elif kind in ('disk', 'sphere'):
                found += [[c - s['radius'] for c in s['center']], [c + s['radius'] for c in s['center']]]
            elif kind == 'polygon':
                found += s['vertices']
    return found or [[0.0, 0.0], [1.0, 1.0]]


def falling(case):
    """A body that nothing holds falls as Galileo says, whatever its shape."""
    if case.scene.kind not in ('motion', 'explicit') or not case.base.done:
        return
    d = case.scene.dimension
    # lumped masses lie at the nodes, and the middle of those of cut cells not quite in the middle of the body, which turns for it
    exact = case.scene.kind == 'motion' and case.data['method'].get('force', 'galerkin') == 'galerkin'
    def fall(data):
        data.pop('failure', None)
        data.pop('cracks', None)
        data['boundary'] = [{'name': 'weight', 'gravity': [0.0, -10.0, 0.0][:d], 'ramp': 'constant'}]
        if exact:
            data['solver']['mass'] = 'consistent'
        else:                                            # what vibrates, as loads at points and masses at nodes differ, is small against a longer fall
            data['solver']['end' if 'end' in data['solver'] else 'time_steps'] *= 4
        data['output']['averages'] = [{'name': 'fall', 'set': 'all', 'field': 'displacement.y'}]
        return data
    run = case.run(fall)
    if run.code == REFUSED:
        return
    if not run.done:
        yield f'free fall ends with {run.code}: {run.first_words()}'
        return
    t, u = run.last('time'), run.last('fall')
    right = -5.0 * t * t
    if run.report['energy']['strain'] > (1e-9 if exact else 0.02) * abs(run.report['energy']['external']) or abs(u - right) > 0.02 * abs(right) + 1e-9:
        yield f'free fall: {u:.6g} m for {right:.6g}, strain energy {run.report["energy"]["strain"]:.3g} of work {run.report["energy"]["external"]:.3g} J'


def pushed(case):
    """A platen that lies on the body and moves into it bears from the first step."""
    for platen in case.data.get('platens', []):
        if 'displacement' not in platen or not case.base.done:
            continue
        axis = next(iter(platen['displacement']))
        factors, forces = case.base.column('load_factor'), case.base.column(f'{platen["name"]}.force_{axis}')
        for factor, force in zip(factors, forces):
            if factor > 0 and not force * platen['displacement'][axis] > 0:
                yield f'{platen["name"]} moved {factor * platen["displacement"][axis]:.3g} m into the body, its force is {force:.3g} N'
                break


INVARIANTS = [sound, balanced, energies, facets, prescribed, pushed, mirrored, quarter_turned, moved, resized, nudged, threaded, plain, summed_otherwise,
              solved_otherwise, resumed, on_ranks, retimed, proportional, superposed, rigid, carried, heated, returned, turned_little, as_total, as_elements,
              soft_spring, doubled_crack, loose, slot, falling, checked]
ALWAYS = (sound, checked)

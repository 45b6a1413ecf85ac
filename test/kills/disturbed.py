"""A run that is interrupted and resumed, against one that nobody disturbed."""
import csv
import glob
import json
import os
import random
import shutil
import signal
import subprocess
import time

import cases

DONE, INTERRUPTED, MOST_SECONDS, MOST_CALLS, LISTENS = 0, 130, 120, 20000, 10
LONGEST = 20                                             # s of a scene that nobody disturbs; a longer one is drawn anew
SIGNALS = [signal.SIGKILL, signal.SIGKILL, signal.SIGTERM, signal.SIGTERM, signal.SIGINT]
INSTANTS = ['clock', 'clock', 'clock', 'early', 'file', 'file', 'last', 'last clock', 'wall']
TICK = 1e-3                                              # s from one look at the clock to the next
TIMES = ('peak_bytes', 'scene', 'ranks')
# of the largest number, where PETSc adds in the order in which messages come: residuals of 1e-16 in matrices of condition 1e9
ROUNDING = 1e-7
BY_ROUNDING = ('solves', 'residual_max')                 # numbers of the report that rounding decides
MPI = {'OMPI_ALLOW_RUN_AS_ROOT': '1', 'OMPI_ALLOW_RUN_AS_ROOT_CONFIRM': '1', 'OMPI_MCA_mpi_yield_when_idle': '1', 'OMPI_MCA_btl_vader_single_copy_mechanism': 'none',
       'OMPI_MCA_rmaps_base_oversubscribe': '1', 'OMPI_MCA_pml': 'ob1', 'OMPI_MCA_hwloc_base_binding_policy': 'none'}


def without_times(value):
    """A report without times, memory, the name of its scene, and what a cache has spared that a resumed run makes again."""
    if isinstance(value, dict) and 'skipped' in value:
        value = {**value, 'skipped': [one for one in value['skipped'] if 'places around tips' not in one['what']]}
    if isinstance(value, dict):
        return {k: without_times(v) for k, v in value.items() if k not in TIMES and not k.startswith('seconds')}
    return [without_times(v) for v in value] if isinstance(value, list) else value


def without_seconds(text):
    """sweep.csv without its column of seconds and that of the folder."""
    rows = list(csv.reader(text.decode().splitlines()))
    left = [k for k, name in enumerate(rows[0]) if not name.startswith('seconds')]
    return [[row[k] for k in left] for row in rows]


def read(path):
    with open(path, 'rb') as file:
        return file.read()


def first_difference(name, a, b):
    """In words: the first line that differs, of a table the first column."""
    if not name.endswith('.csv'):
        return f'{name}: {len(b)} bytes for {len(a)}' if len(a) != len(b) else f'{name}: byte {next(k for k in range(len(a)) if a[k] != b[k])} of {len(a)}'
    one, two = (list(csv.reader(v.decode(errors='replace').splitlines())) for v in (a, b))
    for k, (x, y) in enumerate(zip(one, two)):
        for head, u, v in zip(one[0], x, y):
            if u != v:
                return f'{name}, row {k}, {head}: {v} for {u}'
    return f'{name}: {len(two)} rows for {len(one)}'


def size(value):
    """The magnitude of a number, also of its text; 0 for all else."""
    try:
        return abs(float(value))
    except (ValueError, TypeError):
        return 0.0


def close(a, b, largest):
    """Whether two words are the same, or numbers that differ by rounding."""
    try:
        return a == b or abs(float(a) - float(b)) <= ROUNDING * largest
    except (ValueError, TypeError):
        return False


def rounded_difference(name, a, b):
    """Of two tables whose numbers may differ by rounding, each against the largest of its row's kind; of other files the length alone."""
    if not name.endswith('.csv'):
        return first_difference(name, a, b) if len(a) != len(b) else ''
    one, two = (list(csv.reader(v.decode(errors='replace').splitlines())) for v in (a, b))
    if len(one) != len(two) or one[:1] != two[:1]:
        return first_difference(name, a, b)
    units = [head.rsplit('[', 1)[-1] for head in one[0]] if one else []
    for k, head in enumerate(one[0] if one else []):
        # moments are rounded as forces are: bodies of the scenes are a metre long
        alike = [j for j, unit in enumerate(units) if unit == units[k] or units[k] == 'N m]' and unit == 'N]'] if '[' in head else [k]
        largest = max((size(row[j]) for row in one[1:] for j in alike), default=0.0)
        for n, (x, y) in enumerate(zip(one, two)):
            if not close(x[k], y[k], largest):
                return f'{name}, row {n}, {head}: {y[k]} for {x[k]}, more than rounding'
    return ''


def by_petsc(folder):
    with open(os.path.join(folder, 'report.json'), encoding='utf-8') as file:
        return json.load(file).get('linear_solver') == 'petsc'


def report_difference(a, b, at='', largest=None):
    """largest: None, or the largest number beside these, of which rounding is measured; how often was solved may differ by it as well."""
    if isinstance(a, dict) and isinstance(b, dict) and a.keys() == b.keys():
        largest = None if largest is None else max(map(size, a.values()), default=0.0) if at else 0.0
        return next((d for d in (report_difference(a[k], b[k], f'{at}.{k}' if at else k, largest) for k in a) if d), '')
    if isinstance(a, dict) and isinstance(b, dict):
        return f'report.json, {at}: {sorted(a.keys() ^ b.keys())} more or less'
    if isinstance(a, list) and isinstance(b, list) and len(a) == len(b):
        return next((d for d in (report_difference(x, y, f'{at}[{k}]', largest) for k, (x, y) in enumerate(zip(a, b))) if d), '')
    # whole numbers are counts and have to agree; one that rounding has made whole stands beside a float
    if largest is not None and (at in BY_ROUNDING or float in (type(a), type(b)) and close(a, b, max(largest, size(a)))):
        return ''
    return '' if json.dumps(a) == json.dumps(b) else f'report.json, {at}: {json.dumps(b)[:120]} for {json.dumps(a)[:120]}'


def difference(whole, other):
    """Of the folder of a resumed run from that of a run that nobody disturbed; '': none. Where PETSc solves any two runs differ by rounding."""
    report = os.path.join(whole, 'report.json')
    rounded = os.path.exists(report) and by_petsc(whole)
    for path in sorted(glob.glob(os.path.join(whole, '*.csv')) + glob.glob(os.path.join(whole, 'result.e*'))):
        name = os.path.basename(path)
        if not os.path.exists(os.path.join(other, name)):
            return f'there is no {name}'
        a, b = read(path), read(os.path.join(other, name))
        if name == 'sweep.csv':
            a, b = without_seconds(a), without_seconds(b)
            if a != b:
                return f'sweep.csv: {next((y for x, y in zip(a, b) if x != y), len(b))}'
        elif a != b:
            found = rounded_difference(name, a, b) if rounded else first_difference(name, a, b)
            if found:
                return found
    if os.path.exists(report):
        with open(report, encoding='utf-8') as one, open(os.path.join(other, 'report.json'), encoding='utf-8') as two:
            found = report_difference(without_times(json.load(one)), without_times(json.load(two)), largest=0.0 if rounded else None)
        if found:
            return found
    kept, left = (sorted(n for n in os.listdir(f) if not n.endswith('.log')) for f in (whole, other))
    return '' if kept == left else f'the folder holds {sorted(set(left) ^ set(kept))} more or less'


class Trial:
    """One number: its scene, its interruptions, its outcome."""

    def __init__(self, build, tool, work, number):
        self.build, self.tool, self.work, self.number = os.path.abspath(build), tool, work, number
        self.rng = random.Random(f'trial {number}')
        self.kind, self.how, self.codes, self.case, self.whole_seconds = '', '', [], None, 0.0
        self.out = os.path.join(work, 'out')

    # ---- one run
    def words(self, out, resume):
        scene = os.path.join(self.work, 'scene.yaml')
        if self.case.sets:
            words = [os.path.join(self.build, 'perigal'), 'sweep', scene, '-o', out, '--threads', '1', '-j', '2']
            words += [w for text in self.case.sets for w in ('--set', text)]
        elif self.case.ranks:
            passed = [w for key in ('LD_PRELOAD', 'CALL', 'AT', 'SIGNAL', 'RANK', 'CLOCK', 'COUNTED') for w in ('-x', key)]
            words = ['mpirun', '--oversubscribe', '-n', str(self.case.ranks), *passed, os.path.join(self.build, 'perigal-mpi'), 'run', scene, '-o', out, '--quiet']
        else:
            words = [os.path.join(self.build, 'perigal'), 'run', scene, '-o', out, '--quiet', '--threads', '1']
        return words + ['--resume'] * resume

    def start(self, out, resume=False, call='none', at=0, number=0):
        """`number` comes at a call; the process."""
        shared = self.case.sets or self.case.ranks
        env = {**os.environ, **MPI, 'CALL': call, 'AT': str(at), 'SIGNAL': str(int(number)), 'RANK': '0', 'COUNTED': os.path.join(self.work, 'calls'),
               'CLOCK': str(TICK), 'LD_PRELOAD': self.tool}
        if shared and call == 'none':
            del env['LD_PRELOAD'], env['CLOCK']
        self.said = open(os.path.join(self.work, 'said'), 'w+b')
        words = self.words(out, resume)
        if self.case.ranks and 'LD_PRELOAD' not in env:
            words = [w for k, w in enumerate(words) if w != '-x' and words[k - 1] != '-x']
        return subprocess.Popen(words, stdout=self.said, stderr=self.said, stdin=subprocess.DEVNULL, env=env)

    def end(self, child, seconds=MOST_SECONDS):
        try:
            return child.wait(seconds)
        except subprocess.TimeoutExpired:
            child.kill()
            child.wait()
            self.wait_for_all()
            return None

    def last_words(self):
        self.said.seek(0)
        lines = [w for w in self.said.read().decode(errors='replace').splitlines() if w.strip() and 'warning: ' not in w]
        return ' | '.join(lines[:3])[:400]

    # ---- the run that nobody disturbs
    def accept(self, case):
        self.case, self.kind = case, case.kind
        shutil.rmtree(self.work, ignore_errors=True)
        os.makedirs(self.work)
        for name, text in case.files:
            with open(os.path.join(self.work, name), 'w', encoding='utf-8') as file:
                file.write(text)
        with open(os.path.join(self.work, 'scene.yaml'), 'w', encoding='utf-8') as file:
            json.dump(case.data, file)
        began = time.monotonic()
        call = 'none' if case.sets or case.ranks else 'clock_gettime'
        code = self.end(self.start(os.path.join(self.work, 'whole'), call=call), LONGEST)
        self.whole_seconds = time.monotonic() - began
        return code == DONE and (call == 'none' or self.counted() < MOST_CALLS)

    def counted(self):
        with open(os.path.join(self.work, 'calls'), encoding='ascii') as file:
            return int(file.read())

    def calls(self, call):
        """How often the run calls this function; 0: it cannot be told."""
        counted = os.path.join(self.work, 'counted')
        if self.end(self.start(counted, call=call)) != DONE:
            return 0
        shutil.rmtree(counted, ignore_errors=True)
        return self.counted()

    # ---- interruptions
    def instant(self):
        """(call, at): drawn; wall: at is a share of the time of the whole run."""
        which = 'wall' if self.case.sets or self.case.ranks and self.rng.random() < 0.5 else self.rng.choice(INSTANTS)
        if which == 'wall':
            return 'wall', self.rng.uniform(0.1, 0.95)
        call = 'file' if which in ('file', 'last') else 'clock_gettime'
        n = self.calls(call)
        if n < 12:
            return 'wall', self.rng.uniform(0.1, 0.95)
        low, high = {'early': (1, n // 10 + 1), 'last': (n - 12, n), 'last clock': (n - 12, n)}.get(which, (1, n))
        return call, self.rng.randint(low, high)

    def processes(self, child):
        """Of ranks those whose locks are there, and mpirun; else the one that was started."""
        found = [child.pid]
        for path in glob.glob(os.path.join(self.out, '**', 'run.lock'), recursive=True) if self.case.ranks else []:
            try:
                process = int(read(path).split()[0])     # that of a killed run may name another process by now
                if self.work.encode() in read(f'/proc/{process}/cmdline'):
                    found.append(process)
            except (OSError, ValueError, IndexError):
                pass
        return found

    def send(self, child, number):
        """By the wall clock: all ranks are killed, or one, or mpirun passes the signal on."""
        found = self.processes(child)
        if number == signal.SIGKILL and len(found) > 1:
            found = found if self.rng.random() < 0.5 else [self.rng.choice(found[1:])]
        else:
            found = found[:1]
        for process in found:
            try:
                os.kill(process, number)
            except ProcessLookupError:
                pass

    def interrupt(self, number, call, at, resume):
        """One run that gets a signal; its exit code."""
        child = self.start(self.out, resume, *([] if call == 'wall' else [call, at, number]))
        if call == 'wall':
            try:
                child.wait(at * self.whole_seconds)
            except subprocess.TimeoutExpired:
                self.send(child, number)
        code = self.end(child)
        self.wait_for_all()
        return code

    def wait_for_all(self):
        """Ranks and runs of a sweep may end behind the process that was started."""
        for _ in range(1000 * bool(self.case.ranks or self.case.sets)):
            if not self.is_running():
                break
            time.sleep(0.02)

    def is_running(self):
        """Whether a process of this trial still runs; it may be dead and not yet gone."""
        for path in glob.glob('/proc/[0-9]*/cmdline'):
            try:
                if self.work.encode() in read(path):
                    return True
            except OSError:
                pass
        return False

    def ended(self, code, number, call, at):
        """What is wrong with the end of an interrupted run."""
        killed = number == signal.SIGKILL
        if code == DONE or killed and code == -number:
            return ''
        if self.case.ranks and code is not None:         # mpirun has codes of its own
            return ''
        if code == INTERRUPTED and not killed or code == -number and (call == 'wall' or at < LISTENS):
            return ''                                    # it may come before the program listens
        return f'{number.name} ends it with {code}: {self.last_words()}'

    # ---- the outcome
    def outcome(self, kind=None):
        """'' or what is wrong."""
        self.kind = kind or ''
        self.case = cases.case(self.number, self.accept, kind)
        number, (call, at) = self.rng.choice(SIGNALS), self.instant()
        self.how = f'{call} {at:.3g} {number.name}' if call == 'wall' else f'{call} {at} {number.name}'
        times = self.rng.choice([1, 1, 2])
        for k in range(times):
            resume = os.path.exists(self.out)
            if k:
                call, at = ('wall', 0.5 * at) if call == 'wall' else (call, self.rng.randint(1, max(1, at)))
                self.how += f', then at {at:.3g}' if call == 'wall' else f', then at {at}'
            code = self.interrupt(number, call, at, resume)
            self.codes.append(code)
            wrong = self.ended(code, number, call, at)
            if wrong:
                return wrong
        code = self.end(self.start(self.out, os.path.exists(self.out)))
        self.codes.append(code)
        if code != DONE:
            return f'resumed it ends with {code}: {self.last_words()}'
        return difference(os.path.join(self.work, 'whole'), self.out) or self.sweep_difference()

    def sweep_difference(self):
        for path in sorted(glob.glob(os.path.join(self.work, 'whole', '*', 'report.json'))) if self.case.sets else []:
            name = os.path.basename(os.path.dirname(path))
            found = difference(os.path.dirname(path), os.path.join(self.out, name))
            if found:
                return f'{name}/{found}'
        return ''

"""A cell of the matrix: one condition met by one method. It knows its runs, and how their results become one number with a limit."""
import csv
import json
import os
import signal
import subprocess
import time

from scenes import finite, merged, write

EXIT_DONE, EXIT_USAGE, EXIT_SCENE, EXIT_FAILED = 0, 64, 65, 70
# What a warning must be about to excuse an inexact answer: these speak of something else.
BESIDE_THE_POINT = ("Poisson's ratio", 'checkpoint', 'grow bond by bond')
# Numbers that a coarse discretisation spoils, as each run says of itself by its patch error. Others hold in any: their runs accept it.
OF_THE_DISCRETISATION = ('patch error', 'error of the opening')


class Run:
    """One call of the program: a scene, files beside it, options of the command line."""

    def __init__(self, scene, files=(), options=(), interrupt=False):
        self.scene, self.files, self.options, self.interrupt = scene, files, tuple(options), interrupt
        self.code = self.error = self.report = self.folder = None
        self.seconds = 0.0

    def go(self, program, folder, limit):
        path = write(self.scene, folder, self.files)
        self.folder = os.path.join(folder, 'out')
        command = [program, 'run', path, '-o', self.folder, '--quiet', *self.options]
        if '--threads' not in self.options:
            command += ['--threads', '1']
        start = time.monotonic()
        self.call(command, limit, self.interrupt)
        if self.interrupt and self.code not in (EXIT_DONE, EXIT_SCENE):
            self.call(command + ['--resume'] if os.path.exists(os.path.join(self.folder, 'checkpoint.nc')) else command, limit, False)
        self.seconds = time.monotonic() - start
        try:
            with open(os.path.join(self.folder, 'report.json')) as file:
                self.report = json.load(file)
        except (OSError, ValueError):
            self.report = None

    def disagreement(self, program):
        """What check says of the scene against the run: the same refusal, or none of a run that began; '' where they agree."""
        path = os.path.join(os.path.dirname(self.folder), 'scene.yaml')
        said = subprocess.run([program, 'check', path, '--quiet', *self.options], capture_output=True, stdin=subprocess.DEVNULL, text=True, timeout=600)
        if said.returncode != (EXIT_SCENE if self.code == EXIT_SCENE else EXIT_DONE):
            return f'run ends with {self.code}, check with {said.returncode}: {first_line(self.error)} | {first_line(said.stderr)}'
        if self.code == EXIT_SCENE and said.stderr != self.error:
            return f'run and check refuse it in other words: {first_line(self.error)} | {first_line(said.stderr)}'
        return ''

    def call(self, command, limit, interrupt):
        # seconds of a processor, so that a machine with other work does not decide; five times as long on the clock for one that waits for ever
        child = subprocess.Popen(['prlimit', f'--cpu={limit}', *command], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, stdin=subprocess.DEVNULL, text=True)
        try:
            if interrupt:
                rows = os.path.join(self.folder, 'history.csv')
                while child.poll() is None and not (os.path.exists(rows) and os.path.getsize(rows) > interrupt):
                    time.sleep(0.001)
                if child.poll() is None:
                    child.send_signal(signal.SIGTERM)
            self.error = child.communicate(timeout=5 * limit)[1]
            self.code = child.returncode
            if self.code in (-signal.SIGXCPU, -signal.SIGKILL):
                self.code, self.error = None, f'no answer in {limit} s of a processor'
        except subprocess.TimeoutExpired:
            child.kill()
            child.communicate()
            self.code, self.error = None, f'no answer in {5 * limit} s'

    def history(self):
        """Columns of history.csv: {name with its unit: [numbers]}; an empty cell is 0."""
        with open(os.path.join(self.folder, 'history.csv'), newline='') as file:
            rows = list(csv.reader(file))
        return {name: [float(row[k] or 0) for row in rows[1:]] for k, name in enumerate(rows[0])}

    def warnings(self):
        return [w for w in (self.report or {}).get('warnings', []) if not any(b in w for b in BESIDE_THE_POINT)]


class Cell:
    """`number` takes the finished runs and returns the measured number; `refusal`: what is asked must be refused."""

    def __init__(self, condition, value, method, runs, quantity, number, limit, refusal=False, seconds=60):
        self.condition, self.value, self.method, self.runs = condition, str(value), method, runs
        self.quantity, self.number, self.limit, self.refusal, self.seconds = quantity, number, limit, refusal, seconds
        for run in runs:
            if quantity != 'patch error':
                run.scene = merged(run.scene, {'method': {'accept_inexact': True}})

    def name(self):
        return f'{self.condition}|{self.value}|{self.method}'

    def judge(self, program, folder, asks_check=True):
        """(number or None, verdict, reason): ok, refused (it says why), inexact (it warned) or defect. What a run refuses at its start check
        refuses as well; asks_check: of runs that began it is asked, too."""
        for k, run in enumerate(self.runs):
            run.go(program, os.path.join(folder, str(k)), self.seconds)
            if run.code == EXIT_SCENE or (asks_check and k == 0 and run.code is not None):
                wrong = run.disagreement(program)
                if wrong:
                    return None, 'defect', wrong
        for run in self.runs:
            if run.code not in (EXIT_DONE, EXIT_SCENE, EXIT_FAILED):
                return None, 'defect', f'exit code {run.code}: {first_line(run.error)}'
            if run.code != EXIT_DONE and len(run.error.strip()) < 30:
                return None, 'defect', f'exit code {run.code} without a reason: {run.error.strip()}'
        codes = {run.code for run in self.runs}
        if codes != {EXIT_DONE}:
            if EXIT_DONE in codes:
                return None, 'defect', 'refused or not, as the case may be: ' + '; '.join(first_line(r.error) for r in self.runs if r.code)
            return None, 'refused', first_line(self.runs[0].error)
        if self.refusal:
            return None, 'defect', 'was not refused'
        for run in self.runs:
            if run.report is None:
                return None, 'defect', 'no report.json'
            if not all(finite(v) for column in run.history().values() for v in column):
                return None, 'defect', 'a number in history.csv is not finite'
        value = self.number(self.runs)
        if not finite(value):
            return None, 'defect', f'{self.quantity} was not reported'
        if value <= self.limit:
            return value, 'ok', ''
        warned = [w for run in self.runs for w in run.warnings()]
        if self.quantity not in OF_THE_DISCRETISATION:
            warned = [w for w in warned if not w.startswith('under uniform stress')]
        if self.quantity != 'error of the opening':
            warned = [w for w in warned if not w.startswith('the opening of crack')]
        return value, 'inexact' if warned else 'defect', warned[0] if warned else 'no warning'


def first_line(text):
    lines = [line.strip() for line in (text or '').splitlines() if line.strip()]
    return lines[0][:300] if lines else ''


# ---- numbers -----------------------------------------------------------------------------------------------------------

def patch_error(runs):
    """Relative L2 error of the displacement against the linear field."""
    return runs[0].report.get('error', {}).get('displacement_l2', {}).get('relative')


def residual(runs):
    """Largest residual of an accepted step, or 1 if bonds over their limit were left alive."""
    report = runs[0].report
    return 1.0 if report['bonds_over_limit'] else report['residual_max']


def unit_of(name):
    return name[name.rfind('[') + 1:-1]


def difference(first, second, factors=None, signs=None, only=None):
    """Largest relative difference of two histories, each unit measured by the largest value that carries it in the first one;
    moments, of which symmetric loads have none, at least by the largest force on an arm of the body's length, 1 m.
    `factors`: what a unit of the second is multiplied by; `signs`: columns that change their sign."""
    a, b = first.history(), second.history()
    names = [n for n in a if only is None or only(n)]
    if any(n not in b for n in names) or len(next(iter(a.values()))) != len(next(iter(b.values()))):
        return 1.0
    largest, scale = 0.0, {}
    for n in names:
        scale[unit_of(n)] = max([scale.get(unit_of(n), 0.0)] + [abs(v) for v in a[n]])
    if 'N m' in scale:
        scale['N m'] = max(scale['N m'], scale.get('N', 0.0))
    for n in names:
        if 'residual' in n or not scale[unit_of(n)]:
            continue
        factor = (factors or {}).get(unit_of(n), 1.0) * (-1 if signs and signs(n) else 1)
        largest = max([largest] + [abs(u - factor * v) / scale[unit_of(n)] for u, v in zip(a[n], b[n])])
    return largest


def same(factors=None, signs=None, only=None):
    return lambda runs: difference(runs[0], runs[1], factors, signs, only)


def last_over_peak(column):
    """What is left of a column at the end, as a share of its largest value: unloading returns to where it came from."""
    def number(runs):
        values = runs[0].history()[column]
        return abs(values[-1]) / max(map(abs, values)) if any(values) else None
    return number


def energy_error(runs):
    """Elastic motion loses nothing: the energy that the balance lacks, relative to the largest energy of the run."""
    history = runs[0].history()
    whole = max(abs(v) for name in ('energy_strain [J]', 'energy_kinetic [J]') for v in history[name])
    return max(abs(v) for v in history['energy_dissipated [J]']) / whole if whole else None


def balanced(force):
    """Sum of the forces of all loads and supports along x and y, relative to the load given."""
    def number(runs):
        history = runs[0].history()
        worst = 0.0
        for axis in 'xyz':
            names = [n for n in history if f'.force_{axis} ' in n]
            if names:
                worst = max(worst, abs(sum(history[n][-1] for n in names)) / force)
        return worst
    return number

"""A cell of the matrix: one condition met by one method. It knows its runs, what is expected of them, and how their results become numbers with limits.

A cell is expected to run, or it must be refused, and says why; what may be refused although it is sound input is listed in MAY_REFUSE, with what shows that the
refusal is right. Any other refusal is a defect, of the program or of the matrix.
"""
import csv
import json
import os
import shutil
import signal
import subprocess
import sys
import time

from scenes import finite, merged, write

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', 'ranks'))
from launch import LAUNCH  # noqa: E402

EXIT_DONE, EXIT_USAGE, EXIT_SCENE, EXIT_FAILED = 0, 64, 65, 70
# What a warning must be about to excuse an inexact answer: these speak of something else.
BESIDE_THE_POINT = ("Poisson's ratio", 'checkpoint', 'grow bond by bond')
# Numbers that a coarse discretisation spoils, and words of the warnings that say so. Other numbers hold in any: no warning excuses them.
OF_THE_BODY = ('under uniform stress', 'inside the surface', 'too few points', 'see too few', 'next to nothing resists', 'lose all bonds', 'interface', 'eroded', 'carry no', 'times as stiff as')
OF_TIPS = OF_THE_BODY + ('energy release rate', 'facets in motion', 'dissipated')
EXCUSES = {
    'patch error': OF_THE_BODY,
    'error of the displacement': OF_THE_BODY + ('crack faces overlap',),
    'error of the opening': OF_THE_BODY + ('the opening of crack',),
    'error of the load': OF_TIPS,
    'error of the energy': OF_TIPS,
    'overlap of faces': ('crack faces overlap',),
}
# What may be refused although its input is sound: words of the message, why that is so. Where the first kind names the stress that the bodies of the matrix bear
# it is confirmed by the same run with method.accept_inexact: the error must be beyond the limit of the cell.
INEXACT_BODY, OF_THE_PULL = 'under uniform stress', 'under uniform stress xx'
MAY_REFUSE = (
    (INEXACT_BODY, 'the method is off by more than half in a body of so few points across: measured before the first step, and confirmed'),
    ('see too few points for a strain', 'a basis needs more neighbours than the horizon holds in a body so thin'),
    ('too few or too flat a set', 'moved points leave one of them with neighbours on a line'),
    ('K is ill-conditioned', "next to Poisson's ratio 1/2 the iterations of forces without a matrix do not arrive"),
    ('explicit steps are stable up to', 'the time step is beyond the stable one'),
    ('is singular', 'nothing but balanced loads holds the body, and this solver wants a support'),
)


def program_of_ranks(program):
    return program + '-mpi'


def has_ranks(program):
    return os.path.exists(program_of_ranks(program)) and shutil.which('mpirun') is not None


class Run:
    """One call of the program: a scene, files beside it, options of the command line."""

    def __init__(self, scene, files=(), options=(), interrupt=False, ranks=0):
        self.scene, self.files, self.options, self.interrupt, self.ranks = scene, files, tuple(options), interrupt, ranks
        self.code = self.error = self.report = self.folder = None
        self.seconds = 0.0

    def go(self, program, folder, limit):
        path = write(self.scene, folder, self.files)
        self.folder = os.path.join(folder, 'out')
        start = [program] if not self.ranks else [*LAUNCH, '-n', str(self.ranks), program_of_ranks(program)]
        command = [*start, 'run', path, '-o', self.folder, '--quiet', *self.options]
        if '--threads' not in self.options and not self.ranks:
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
        where = dict(os.environ)
        if '--threads' in command and command[command.index('--threads') + 1] != '1':
            for name in ('OMP_THREAD_LIMIT', 'OPENBLAS_NUM_THREADS'):      # which would leave one of the threads
                where.pop(name, None)
        child = subprocess.Popen(['prlimit', f'--cpu={limit}', *command], env=where, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, stdin=subprocess.DEVNULL, text=True)
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
    """`number` takes the finished runs and returns the measured number. `refusal`: why what is asked must be refused. `also`: further judgments, each a quantity,
    a function of the runs and a limit. `energy`: what to measure energies by where a run stores next to none."""

    def __init__(self, condition, value, method, runs, quantity, number, limit, refusal='', seconds=60, also=(), energy=0.0):
        self.condition, self.value, self.method, self.runs = condition, str(value), method, runs
        self.refusal, self.seconds, self.energy = refusal, seconds, energy
        self.judgments = [(quantity, number, limit), *also]
        self.quantity, self.limit = quantity, limit
        for run in runs:
            if quantity != 'patch error':
                run.scene = merged(run.scene, {'method': {'accept_inexact': True}})

    def name(self):
        return f'{self.condition}|{self.value}|{self.method}'

    def judge(self, program, folder, asks_check=True):
        """(number or None, verdict, reason): ok (refused, where it must be), refused (it says why), inexact (it warned) or defect. What a run refuses at its start
        check refuses as well; asks_check: of runs that began it is asked, too."""
        for k, run in enumerate(self.runs):
            run.go(program, os.path.join(folder, str(k)), self.seconds)
            if not run.ranks and (run.code == EXIT_SCENE or (asks_check and k == 0 and run.code is not None)):
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
            return self.refused(codes, program, folder)
        if self.refusal:
            return None, 'defect', f'was not refused: {self.refusal}'
        for run in self.runs:
            wrong = unsound(run, self.energy)
            if wrong:
                return None, 'defect', wrong
        return self.measured()

    def refused(self, codes, program, folder):
        reason = first_line(next(r.error for r in self.runs if r.code != EXIT_DONE))
        if EXIT_DONE in codes:
            return None, 'defect', f'refused or not, as the case may be: {reason}'
        if self.refusal:
            return None, 'ok', f'must be refused, {self.refusal}: {reason}'
        if not any(words in reason for words, _ in MAY_REFUSE):
            return None, 'defect', f'is refused, and should run: {reason}'
        if OF_THE_PULL in reason:
            wrong = self.unfounded(program, folder)
            if wrong:
                return None, 'defect', wrong
        return None, 'refused', reason

    def unfounded(self, program, folder):
        """The refused run with its error accepted: '' where that error is beyond the limit of the cell, so that the refusal was right."""
        bold = Run(merged(self.runs[0].scene, {'method': {'accept_inexact': True}}), self.runs[0].files, self.runs[0].options)
        bold.go(program, os.path.join(folder, 'bold'), self.seconds)
        if bold.code != EXIT_DONE:
            return ''
        value = self.judgments[0][1]([bold])
        return '' if value is None or not finite(value) or value > self.limit else f'refused as inexact, and with accept_inexact {self.quantity} is {value:.3g}'

    def measured(self):
        """The first judgment that is beyond its limit decides; else the number is that of the first one."""
        first = None
        for quantity, number, limit in self.judgments:
            value = number(self.runs)
            if not finite(value):
                return None, 'defect', f'{quantity} was not reported'
            first = value if first is None else first
            if value > limit:
                self.quantity, self.limit = quantity, limit
                warned = self.excuse(quantity)
                return value, 'inexact' if warned else 'defect', f'{quantity}: ' + (warned[0] if warned else 'no warning')
        return first, 'ok', ''

    def excuse(self, quantity):
        """Warnings of the runs that speak of this number. Residuals, balances, answers that must be the same are excused by none."""
        about = EXCUSES.get(quantity)
        if about is None:
            return []
        return [w for run in self.runs for w in run.warnings() if any(words in w for words in about)]


# Energy that explicit steps may miss, of the largest; equilibria and implicit steps a ten thousandth of that.
OF_STEPS = 0.02


def unsound(run, energy_scale=0.0):
    """What no run may show, whatever it computes; '' where all is well."""
    report = run.report
    if report is None:
        return 'no report.json'
    if not all(finite(v) for column in run.history().values() for v in column):
        return 'a number in history.csv is not finite'
    balance = report.get('balance')
    if balance and not any('balance' in w for w in report['warnings']):
        for what in ('forces', 'moments'):
            if balance.get(what, 0) > balance['allowed']:
                return f'{what} miss balance by {balance[what]:.2g}, allowed {balance["allowed"]:.2g}, without a warning'
    energy, history = report['energy'], run.history()
    whole = max([abs(v) for name, column in history.items() if name.startswith('energy_') for v in column]
                + [abs(v) for v in energy.values()] + [energy_scale])
    share = OF_STEPS if run.scene['solver'].get('kind') in ('verlet', 'central') else OF_STEPS / 1e4
    if energy['dissipated'] < -share * whole and not any('energy' in w or 'dissipated' in w for w in report['warnings']):
        return f'energy came into being: {-energy["dissipated"]:.3g} J of {whole:.3g} J, without a warning'
    if report['bonds_over_limit']:
        return f'{report["bonds_over_limit"]} bonds over their limit were left alive'
    return ''


def first_line(text):
    """What it ended with: the first line that is no warning."""
    lines = [line.strip() for line in (text or '').splitlines() if line.strip()]
    lines = [line for line in lines if not line.startswith('perigal: warning')] or lines
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

"""One run of the program on a random scene: its exit code, words, report and columns."""
import csv
import json
import math
import os
import resource
import shutil
import signal
import subprocess
import sys
import time

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', 'ranks'))
from launch import LAUNCH  # noqa: E402

DONE, USAGE, REFUSED, FAILED, INTERRUPTED = 0, 64, 65, 70, 130
SLOW = 'slow'                                           # it was asked to stop after its time, and did: at work, not caught in a loop
GRACE = 30                                              # seconds of a processor to stop in


class Run:
    def __init__(self, code, said, folder):
        self.code, self.said, self.folder = code, said, folder
        self.report, self.names, self.rows = {}, [], []
        try:
            with open(os.path.join(folder, 'report.json'), encoding='utf-8') as file:
                self.report = json.load(file)
            with open(os.path.join(folder, 'history.csv'), encoding='utf-8', newline='') as file:
                table = list(csv.reader(file))
            self.names = table[0]
            self.rows = [[float(v) if v else math.nan for v in row] for row in table[1:]]
        except (OSError, ValueError, IndexError):
            pass

    @property
    def done(self):
        return self.code == DONE

    def column(self, name):
        """Values of a column by its name without the unit; [] where there is none."""
        for k, whole in enumerate(self.names):
            if whole.rsplit(' [', 1)[0] == name:
                return [row[k] for row in self.rows]
        return []

    def last(self, name):
        values = self.column(name)
        return values[-1] if values else math.nan

    def warned(self, *words):
        return any(all(w in text for w in words) for text in self.report.get('warnings', []))

    def first_words(self):
        lines = [line for line in self.said.splitlines() if line.strip() and 'warning: ' not in line]
        return lines[0][:220] if lines else ''


def spent_by(process):
    """Seconds of a processor of a process, itself alone; 0: it has ended."""
    try:
        with open(f'/proc/{process}/stat', encoding='utf-8') as file:
            user, system = file.read().rsplit(')', 1)[1].split()[11:13]
        return (int(user) + int(system)) / os.sysconf('SC_CLK_TCK')
    except (OSError, ValueError):
        return 0.0


class Program:
    """Starts the program in folders of its own, each once for the same scene and options. A run has so many seconds of a processor, and ten times as long
    by the clock, since others may be at work; then it is asked to stop, which it does after the solution or break round at hand."""

    def __init__(self, build, work, seconds=60):
        self.program, self.mpi = os.path.abspath(os.path.join(build, 'perigal')), os.path.abspath(os.path.join(build, 'perigal-mpi'))
        self.work, self.seconds, self.count, self.known, self.asked = work, seconds, 0, {}, []
        self.spent = 0.0

    def folder(self, data, files):
        self.count += 1
        folder = os.path.join(self.work, str(self.count))
        shutil.rmtree(folder, ignore_errors=True)
        os.makedirs(folder)
        for name, text in files:
            with open(os.path.join(folder, name), 'w', encoding='utf-8') as file:
                file.write(text)
        with open(os.path.join(folder, 'scene.yaml'), 'w', encoding='utf-8') as file:
            json.dump(data, file)
        return folder

    def call(self, words, kill_after=None, where=None):
        """Exit code and what it said; kill_after (bytes of history.csv): SIGTERM once so much is written."""
        child = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL, text=True, errors='replace',
                                 preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (self.seconds + GRACE, self.seconds + GRACE)))
        if kill_after is not None:
            rows, began = os.path.join(where, 'history.csv'), time.monotonic()
            while child.poll() is None and time.monotonic() < began + 10 * self.seconds and not (os.path.exists(rows) and os.path.getsize(rows) > kill_after):
                time.sleep(0.002)
            if child.poll() is None:
                child.send_signal(signal.SIGTERM)
        ends, stopped = time.monotonic() + 10 * (self.seconds + GRACE), False
        while True:
            try:
                said, _ = child.communicate(timeout=1)
                break
            except subprocess.TimeoutExpired:
                if time.monotonic() > ends:
                    child.kill()
                elif not stopped and spent_by(child.pid) > self.seconds:
                    child.send_signal(signal.SIGTERM)
                    stopped = True
        if stopped and child.returncode == INTERRUPTED:
            return SLOW, f'at work after {self.seconds} s of a processor'
        if child.returncode in (-signal.SIGKILL, -signal.SIGTERM) or 'signal 9' in said:
            return None, f'no end within {self.seconds + GRACE} s of a processor'
        return child.returncode, said

    def run(self, data, files=(), options=('--threads', '1'), kill_after=None, ranks=0):
        key = json.dumps([data, list(files), list(options), kill_after, ranks], sort_keys=True)
        if key not in self.known:
            folder = self.folder(data, files)
            out = os.path.join(folder, 'out')
            program = [*LAUNCH, '-n', str(ranks), self.mpi] if ranks else [self.program]
            words = program + ['run', os.path.join(folder, 'scene.yaml'), '-o', out, '--quiet', *options]
            code, said = self.call(words, kill_after, out)
            if kill_after is not None and code not in (DONE, REFUSED) and os.path.exists(os.path.join(out, 'checkpoint.nc')):
                code, said = self.call(words + ['--resume'])
            self.known[key] = Run(code, said, out)
            if not ranks and kill_after is None and '--plain' not in options:
                self.asked.append((data, files, self.known[key]))
        return self.known[key]

    def alone(self):
        """Scene, files and run of all that ran on one process, undisturbed."""
        return self.asked

    def check(self, data, files=()):
        folder = self.folder(data, files)
        return self.call([self.program, 'check', os.path.join(folder, 'scene.yaml')])

    def clean(self):
        shutil.rmtree(self.work, ignore_errors=True)

# SPDX-License-Identifier: GPL-3.0-or-later
"""The program: where it is, how it is called, and what its exit codes mean."""
import json
import os
import shutil
import subprocess
import sys
import tempfile
import warnings


class Error(Exception):
    """What the program had to say when it did not succeed. The message is the program's own."""


class UsageError(Error):
    """Exit code 64: a wrong command line."""


class SceneError(Error):
    """Exit code 65: the scene is wrong; the message has file, line, key, value and what is allowed."""


class Failed(Error):
    """Exit code 70: numerics, memory or files; the message says what failed, where, and what to try."""


class Interrupted(Error):
    """Exit code 130: the run was stopped; run (..., resume=True) goes on."""


class PerigalWarning(UserWarning):
    """A warning of a run."""


def program():
    """Path of the program: $PERIGAL, the source tree around this package, or along PATH. Raises FileNotFoundError."""
    named = os.environ.get('PERIGAL')
    if named:
        return named
    tree = os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..', 'perigal')
    if os.path.exists(tree):
        return os.path.abspath(tree)
    found = shutil.which('perigal')
    if not found:
        raise FileNotFoundError('there is no program perigal: build it (make), put it on PATH, or name it by the '
                                'environment variable PERIGAL')
    return found


def run(scene, out=None, set=None, resume=False, force=False, threads=0, memory=None, plain=False, progress=False):
    """Runs a scene and returns its Result.

    scene: path of a scene file, or a dict such as read_scene returns (names of files in it must be absolute).
    out: result folder; default: out/NAME, NAME being that of the scene's folder or file.
    set: dict of keys and values that replace those of the scene, {'spacing': '2 mm'}; numbers without unit: SI.
    resume, force, threads, memory, plain: as in `perigal help run`. progress: print while it runs.
    Raises SceneError, Failed, Interrupted, UsageError; warnings of the run become PerigalWarning.
    """
    from perigal.result import Result
    if out is None:
        out = default_folder(scene)
    words = ['-o', os.fspath(out), '--threads', str(threads), *settings(set)]
    words += [word for word, given in (('--resume', resume), ('--force', force), ('--plain', plain),
                                       ('--quiet', not progress)) if given]
    if memory is not None:
        words += ['--memory', str(memory)]
    with scene_file(scene) as file:
        call(['run', file, *words], progress)
    result = Result(out)
    for text in result.report.get('warnings', []):
        warnings.warn(text, PerigalWarning, stacklevel=2)
    return result


def check(scene, set=None, solve=False, memory=None, matrix=None):
    """What a run would do, as a dict: points, bonds, dofs, memory, materials, ... (`perigal check --json`).

    matrix: a folder that gets the linear system at load factor 1 as Matrix Market files (`perigal help check`).
    """
    words = ['--json', '--quiet', *settings(set)] + (['--solve'] if solve else [])
    if memory is not None:
        words += ['--memory', str(memory)]
    if matrix is not None:
        words += ['--matrix', os.fspath(matrix)]
    with scene_file(scene) as file:
        return json.loads(call(['check', file, *words]))


def sweep(scene, set, out=None, zip=False, jobs=1, resume=False, quantity=None, threads=0, memory=None,
          progress=False):
    """Runs a scene with all combinations of some of its values; returns a Sweep.

    set: dict of keys and values, {'spacing': ['1 mm', '2 mm'], 'perturb.seed': range(1, 21), 'method.force': 'bond'};
    lists, tuples, ranges and arrays are lists of values, others one value for every run; a value that is itself a list
    is a list in a list. zip: the first values of all keys together, the second ones ... jobs: so many runs at a time.
    resume: go on in a folder with a sweep. quantity: list of columns (`perigal help sweep`). out: default out/sweep.
    All combinations are checked before the first run (SceneError). Runs that fail give a PerigalWarning, and their rows
    say why. Raises SceneError, Interrupted (resume=True goes on), Failed, UsageError.
    """
    from perigal.result import Sweep
    out = os.path.join('out', 'sweep') if out is None else os.fspath(out)
    words = ['-o', out, '--threads', str(threads), '--jobs', str(jobs)]
    for key, values in set.items():
        one = isinstance(values, (str, bytes, dict, bool, int, float)) or not hasattr(values, '__iter__')
        words += ['--set', f'{key}={",".join(value_text(v) for v in ([values] if one else values))}']
    words += [word for word, given in (('--zip', zip), ('--resume', resume), ('--quiet', not progress)) if given]
    if quantity:
        words += ['--quantity', quantity if isinstance(quantity, str) else ','.join(quantity)]
    if memory is not None:
        words += ['--memory', str(memory)]
    with scene_file(scene) as file:
        try:
            call(['sweep', file, *words], progress)
        except Failed as fault:
            if not os.path.exists(os.path.join(out, 'sweep.csv')):
                raise
            result = Sweep(out)
            if 'waiting' in result.status or 'failed' not in result.status:
                raise
            warnings.warn(str(fault), PerigalWarning, stacklevel=2)
            return result
    return Sweep(out)


def value_text(value):
    """A value of a list: texts as they are, unless the list would be cut in them; others as JSON, which is YAML."""
    if isinstance(value, str) and value and not any(c in value for c in '[]{}(),"\':#'):
        return value
    if hasattr(value, 'item') and not hasattr(value, '__len__'):      # a number of numpy
        value = value.item()
    return json.dumps(value, allow_nan=False)


def read_scene(file, set=None):
    """A scene file as dicts and lists: what is written in it, without defaults; values with units are texts."""
    return json.loads(call(['check', os.fspath(file), '--echo', *settings(set)]))


def settings(values):
    """{'spacing': '2 mm'} as --set spacing="2 mm" ...: JSON is YAML."""
    words = []
    for key, value in (values or {}).items():
        text = value if isinstance(value, str) else json.dumps(value, allow_nan=False)
        words += ['--set', f'{key}={text}']
    return words


class scene_file:
    """A scene as a file while a with block lasts: the path itself, or a dict written to a folder of its own."""

    def __init__(self, scene):
        self.scene, self.folder = scene, None

    def __enter__(self):
        if not isinstance(self.scene, dict):
            return os.fspath(self.scene)
        self.folder = tempfile.TemporaryDirectory()
        path = os.path.join(self.folder.name, 'scene.yaml')
        with open(path, 'w', encoding='utf-8') as file:
            json.dump(self.scene, file, ensure_ascii=False, allow_nan=False, indent=1)
        return path

    def __exit__(self, *ignored):
        if self.folder:
            self.folder.cleanup()


def default_folder(scene):
    """out/NAME, as the program itself names it."""
    if isinstance(scene, dict):
        return os.path.join('out', 'scene')
    name = os.path.splitext(os.path.basename(os.fspath(scene)))[0]
    folder = os.path.basename(os.path.dirname(os.path.abspath(os.fspath(scene))))
    return os.path.join('out', folder if name == 'scene' and folder else name)


def call(words, shown=False):
    """Runs the program; returns what it printed to stdout. Its messages become those of the exceptions."""
    process = subprocess.Popen([program(), *words], stdout=subprocess.PIPE, stderr=subprocess.STDOUT if shown else
                               subprocess.PIPE, text=True, encoding='utf-8', errors='replace')
    if shown:
        out = []
        for line in process.stdout:
            sys.stdout.write(line)
            out.append(line)
        process.wait()
        out, message = ''.join(out), ''.join(out[-40:])
    else:
        out, message = process.communicate()
    if process.returncode == 0:
        return out
    kind = {64: UsageError, 65: SceneError, 130: Interrupted, -2: Interrupted}.get(process.returncode, Failed)
    raise kind(message.strip() or f'perigal ended with exit code {process.returncode} and said nothing')

# SPDX-License-Identifier: GPL-3.0-or-later
"""Run scenes of the fracture solver Perigal and read their results.

    import perigal
    r = perigal.run('data/disk_crack/scene.yaml', out='out/disk', set={'spacing': '2 mm'})
    u = r.field('displacement')                    # points x components, last step
    force = r.history['top.force_y']               # one value a step, N
    r.report['curve']['peak']

Needs numpy and netCDF4, and the program perigal: the environment variable PERIGAL, the source tree that this package
lies in, or PATH.
"""
from perigal.program import (Error, SceneError, UsageError, Failed, Interrupted, PerigalWarning,
                             check, program, read_scene, run, sweep)
from perigal.result import Result, Sweep, Table
from perigal.library import Equations, Sparse, families, shape_functions, stiffness

__all__ = ['Error', 'SceneError', 'UsageError', 'Failed', 'Interrupted', 'PerigalWarning', 'Result', 'Sweep',
           'Table', 'check', 'open', 'program', 'read_scene', 'run', 'sweep',
           'Equations', 'Sparse', 'families', 'shape_functions', 'stiffness']


def open(folder):
    """The result in a folder, also of a run that is still going on: see Result."""
    return Result(folder)

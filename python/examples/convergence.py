# SPDX-License-Identifier: GPL-3.0-or-later
"""Convergence: the error of Kirsch's plate at falling spacings, and its order."""
import os

import numpy
import perigal

here = os.path.dirname(os.path.abspath(__file__))
scene = os.path.join(here, '..', '..', 'data', 'kirsch', 'scene.yaml')
if not os.path.exists(scene):                           # installed: share/perigal/scenes
    scene = os.path.join(here, '..', '..', 'scenes', 'kirsch', 'scene.yaml')
spacing = [.5, .25, .125]                               # m
t = perigal.sweep(scene, {'spacing': spacing, 'output.pictures': [[]]}, out='out/examples/convergence', resume=True)
relative = [t.result(k).report['error']['displacement_l2']['relative'] for k in range(len(t))]
order = numpy.diff(numpy.log(relative)) / numpy.diff(numpy.log(spacing))
for h, e in zip(spacing, relative):
    print(f'spacing {h:.3f} m: error {e:.2e}')
print('order', *(f'{p:.2f}' for p in order))

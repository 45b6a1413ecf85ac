# SPDX-License-Identifier: GPL-3.0-or-later
"""A parameter study with a histogram: how much does the load at which a plate with a notch breaks vary if the points are moved
at random?"""
import os

import perigal

here = os.path.dirname(os.path.abspath(__file__))
runs = 24
t = perigal.sweep(os.path.join(here, 'notch.yaml'), {'perturb.seed': range(1, runs + 1), 'perturb.amount': .2},
                  quantity=['peak', 'broken'], out='out/examples/random_study', resume=True, jobs=2)
peak = t['peak'] / 1e3                                  # kN
print(f'peak load of {runs} runs: mean {peak.mean():.3f} kN, standard deviation {100 * peak.std(ddof=1) / peak.mean():.1f} %; '
      'histogram out/examples/random_study/sweep.png')

# SPDX-License-Identifier: GPL-3.0-or-later
"""A criterion of one's own, tried on the exported matrix: at which load, and where, does a glass plate with a hole begin to
break if bonds along a weak direction bear only 60 % of the others? First the criterion of the program itself, as a check."""
import os

import numpy
import perigal


def matrix(file):
    """A matrix (dense) or vector of a Matrix Market file; scipy.io.mmread reads them as sparse ones."""
    with open(file) as lines:
        head = next(lines)
        n = next(line for line in lines if not line.startswith('%')).split()
        values = numpy.array(lines.read().split(), dtype=float)
    if 'array' in head:
        return values
    a = numpy.zeros((int(n[0]), int(n[1])))
    values = values.reshape(-1, 3)
    row, column = values[:, 0].astype(int) - 1, values[:, 1].astype(int) - 1
    a[row, column] = values[:, 2]
    if 'symmetric' in head:
        a[column, row] = values[:, 2]
    return a


here = os.path.dirname(os.path.abspath(__file__))
folder = 'out/examples/own_criterion'
plan = perigal.check(os.path.join(here, 'plate.yaml'), matrix=folder, solve=True)
K, T, N, f, g = (matrix(os.path.join(folder, name + '.mtx')) for name in 'KTNfg')
q = numpy.linalg.solve(T.T @ K @ T, T.T @ (f - K @ g))  # the equilibrium at the full load
u = (N @ (T @ q + g)).reshape(-1, 2)
x = numpy.loadtxt(os.path.join(folder, 'points.csv'), delimiter=',', skiprows=1)[:, :2]

# All bonds whose ends may break: shorter than the horizon, no end in the grips.
free = numpy.flatnonzero(abs(x[:, 1]) < x[:, 1].max() - 1e-9)
a, b = (free[k] for k in numpy.triu_indices(len(free), 1))
xi = x[b] - x[a]
near = (xi**2).sum(axis=1) <= (plan['horizon'] * (1 + 1e-9))**2
a, b, xi = a[near], b[near], xi[near]
stretch = (xi * (u[b] - u[a])).sum(axis=1) / (xi**2).sum(axis=1)

# The program's own: a bond breaks at a stretch of 1e-3; everything is proportional to the load.
factor = 1e-3 / stretch.max()
first = plan['first_break']['load_factor']
print(f'stretch:        first break at load factor {factor:.10f}, by the program {first:.10f}')

# My own: bonds within 20 degrees of 45 degrees are weak.
angle = numpy.degrees(numpy.arctan2(xi[:, 1], xi[:, 0])) % 180
limit = numpy.where(abs(angle - 45) < 20, .6e-3, 1e-3)
k = (stretch / limit).argmax()
own_factor = limit[k] / stretch[k]
place = (x[a[k]] + x[b[k]]) / 2
print(f'weak direction: first break at load factor {own_factor:.4f}, at ({1e3 * place[0]:.1f}, {1e3 * place[1]:.1f}) mm')

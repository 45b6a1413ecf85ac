"""The cells of the matrix, or a sample of them that never changes and holds each condition and each method."""
import hashlib
from collections import Counter

import breaking
import contact
import elastic
import growth
import laws
import motion
import ranks
from cells import has_ranks
from methods import methods

SAMPLE = {'short': 0, 'long': 2500}       # at least so many cells
LONGEST = 60
# the first takes as long as two thirds of the others of the short sample together, each of the others as five to ten cells
DEAR = {'short': {'interrupted and resumed|in motion|galerkin, newmark', 'relaxation|3D|galerkin, adr', 'horizon|6 h, 3D|rkpm gauss, constant',
                  'facets in motion|2 threads for 1|fcbm, verlet', 'facets in motion|interrupted and resumed|gmpd, central',
                  'facets in motion|strip|bond, verlet', 'linear solver|3D|bond, cholmod', 'events until separation|plate|rkpm consistent linear',
                  'linear solver|3D|bond, skyline', 'load|1e-06, 3D|gmpd volumetric', 'relaxation|3D|gmpd, relax', 'springs|hold the body, 3D|nosb gauss quadratic',
                  'unloading and reversal|3D|nosb gauss quadratic', 'facets in motion|strip|galerkin, verlet', 'relaxation|3D|lps, adr', 'linear solver|3D|bond, auto',
                  'fronts|2 threads for 1|rkpm consistent linear', 'facets in motion|strip|galerkin, newmark', 'mirror image|3D|rkpm gauss quadratic'}, 'long': set()}
LEAST = {'short': 1, 'long': 4}             # cells of each condition


def order(cell):
    return hashlib.sha256(cell.name().encode()).hexdigest()


def chosen(program, size):
    """All cells for `full`; else the first of each method and LEAST of each condition in an order that is as good as random, and more up to SAMPLE."""
    parts = [elastic, laws, breaking, growth, contact, motion] + ([ranks] if has_ranks(program) else [])
    cells = [cell for method in methods(program) for part in parts for cell in part.cells(method)]
    if size == 'full':
        return cells
    ranked = sorted((c for c in cells if c.seconds <= LONGEST and c.name() not in DEAR[size]), key=order)
    names, conditions, found = set(), Counter(), set()
    for cell in ranked:
        if conditions[cell.condition] < LEAST[size] or cell.method not in found:
            names.add(cell.name())
            conditions[cell.condition] += 1
            found.add(cell.method)
    rest = [c.name() for c in ranked if c.name() not in names]
    names.update(rest[:max(0, SAMPLE[size] - len(names))])
    return [c for c in cells if c.name() in names]

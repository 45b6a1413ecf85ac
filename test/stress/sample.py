"""The cells of the matrix, or a sample of them that never changes and holds each condition and each method."""
import hashlib

import breaking
import elastic
import motion
from methods import methods

SAMPLE = {'short': 500, 'long': 2500}
LONGEST = 60


def order(cell):
    return hashlib.sha256(cell.name().encode()).hexdigest()


def chosen(program, size):
    """All cells for `full`; else the first of each condition and method in an order that is as good as random, and more up to SAMPLE."""
    cells = [cell for method in methods(program) for part in (elastic, breaking, motion) for cell in part.cells(method)]
    if size == 'full':
        return cells
    ranked = sorted((c for c in cells if c.seconds <= LONGEST), key=order)
    names, seen = set(), set()
    for cell in ranked:
        if cell.condition not in seen or cell.method not in seen:
            names.add(cell.name())
            seen.update((cell.condition, cell.method))
    rest = [c.name() for c in ranked if c.name() not in names]
    names.update(rest[:max(0, SAMPLE[size] - len(names))])
    return [c for c in cells if c.name() in names]

#!/usr/bin/env python3
"""scattered.py DIMENSION N [AMOUNT]: points of a plate of 50 mm or a cube of 20 mm with a hole, N along an edge, each moved at random by at most
AMOUNT (default 0.25) of the spacing and as large as its cell; 0: a lattice. In an order that is none of their places. Lines x, y, [z,] volume."""
import random
import sys

dim, n, amount = int(sys.argv[1]), int(sys.argv[2]), float(sys.argv[3]) if len(sys.argv) > 3 else 0.25
random.seed(7)
size = 0.05 if dim == 2 else 0.02
h = size / n
points = []
for k in range(n ** dim):
    at = [(k // n ** axis % n + 0.5) * h - size / 2 for axis in range(dim)]
    if (at[0] - 0.2 * size) ** 2 + (at[1] - 0.24 * size) ** 2 < (0.08 * size) ** 2:
        continue
    points.append([x + amount * h * random.uniform(-1, 1) for x in at] + [h ** dim * (0.001 if dim == 2 else 1)])
random.shuffle(points)
print('x [m], y [m], ' + ('z [m], ' if dim == 3 else '') + 'volume [m3]')
for p in points:
    print(', '.join(f'{x:.15g}' for x in p))

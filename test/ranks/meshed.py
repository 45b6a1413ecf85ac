#!/usr/bin/env python3
"""meshed.py N [AMOUNT]: the plate of galerkin.yaml as a mesh (Abaqus, mm): quadrilaterals, N along x and 4/5 of that along y, without those in
the hole, their inner nodes moved at random by at most AMOUNT (default 0.2) of an edge, and every third column cut into triangles; ELSET of both
halves as blocks left_half and right_half, NSET grip of the left edge."""
import random
import sys

n, amount = int(sys.argv[1]), float(sys.argv[2]) if len(sys.argv) > 2 else 0.2
m, h = 4 * n // 5, 50 / n
random.seed(3)
def is_in(i, j):
    return 0 <= i < n and 0 <= j < m and ((i + 0.5) * h - 25 - 13) ** 2 + ((j + 0.5) * h - 20 - 9) ** 2 > 16
cells = [(i, j) for j in range(m) for i in range(n) if is_in(i, j)]
number = {}
for i, j in cells:
    for a, b in ((0, 0), (1, 0), (1, 1), (0, 1)):
        number.setdefault((i + a, j + b), len(number) + 1)
print('*NODE')
for (i, j), k in number.items():
    inner = all(is_in(i - a, j - b) for a in (0, 1) for b in (0, 1))
    x, y = (c * h + (amount * h * random.uniform(-1, 1) if inner else 0) for c in (i, j))
    print(f'{k}, {x - 25:.12g}, {y - 20:.12g}')
e = 0
for kind in ('CPS4', 'CPS3'):
    for name, side in (('left_half', 0), ('right_half', 1)):
        print(f'*ELEMENT, TYPE={kind}, ELSET={name}')
        for i, j in cells:
            if (2 * i >= n) != side or (i % 3 == 1) != (kind == 'CPS3'):
                continue
            at = [number[i + a, j + b] for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
            for nodes in ([at] if kind == 'CPS4' else [at[:3], [at[0], at[2], at[3]]]):
                e += 1
                print(f'{e}, ' + ', '.join(map(str, nodes)))
print('*NSET, NSET=grip')
print(',\n'.join(str(k) for (i, j), k in number.items() if i == 0))

#!/usr/bin/env python3
"""compare.py SHARE TABLE TABLE [COLUMN...]: are two tables the same? Numbers may differ by this share of the largest of their column, texts and
blanks not at all; columns named behind are left out (parts of their names). Says the largest difference."""
import csv
import sys


def number(text):
    try:
        return float(text)
    except ValueError:
        return None


share, out = float(sys.argv[1]), sys.argv[4:]
one, other = [list(csv.reader(open(path))) for path in sys.argv[2:4]]
if len(one) != len(other) or one[0] != other[0]:
    sys.exit(f'{len(one)} rows of {len(one[0])} columns, and {len(other)} of {len(other[0])}')
worst, where, faults = 0.0, '', []
for k, name in enumerate(one[0]):
    if any(word in name for word in out):
        continue
    most = max((abs(number(row[k])) for row in one[1:] if number(row[k]) is not None), default=0) or 1
    for i, (a, b) in enumerate(zip(one[1:], other[1:])):
        x, y = number(a[k]), number(b[k])
        if x is None or y is None:
            if a[k] != b[k]:
                faults.append(f'row {i + 1}, {name}: {a[k]!r}, {b[k]!r}')
        elif not abs(x - y) <= worst * most:
            worst, where = abs(x - y) / most, f'row {i + 1}, {name}: {a[k]}, {b[k]}'
if faults or not worst <= share:
    sys.exit('\n'.join(faults[:5]) or f'{worst:.1e} of the largest: {where}')

#!/usr/bin/env python3
"""compare.py SHARE TABLE TABLE [COLUMN...]: are two tables the same? Numbers may differ by this share of the largest of their column, texts and
blanks not at all; columns named behind are left out (parts of their names). Energies, forces, displacements, moments, stress intensities and
places are measured by the largest of all columns of their kind: what is a difference of others, or zero but for rounding, has no size of its own. Says the largest difference."""
import csv
import re
import sys


def number(text):
    try:
        return float(text)
    except ValueError:
        return None


def most(rows, k):
    return max((abs(number(row[k])) for row in rows if number(row[k]) is not None), default=0)


def kind(name):
    found = re.search(r'(energy|force|displacement|moment|rotation|K)_|(?:^|\.)([xyz][012]?)( \[m\])', name)
    return found and (found.group(1) or found.group(3))


share, out = float(sys.argv[1]), sys.argv[4:]
one, other = [list(csv.reader(open(path))) for path in sys.argv[2:4]]
if len(one) != len(other) or one[0] != other[0]:
    sys.exit(f'{len(one)} rows of {len(one[0])} columns, and {len(other)} of {len(other[0])}')
worst, where, faults = 0.0, '', []
for k, name in enumerate(one[0]):
    if any(word in name for word in out):
        continue
    like = [c for c, other_name in enumerate(one[0]) if c == k or (kind(name) and kind(other_name) == kind(name))]
    size = max(most(one[1:], c) for c in like) or 1
    for i, (a, b) in enumerate(zip(one[1:], other[1:])):
        x, y = number(a[k]), number(b[k])
        if x is None or y is None:
            if a[k] != b[k]:
                faults.append(f'row {i + 1}, {name}: {a[k]!r}, {b[k]!r}')
        elif not abs(x - y) <= worst * size:
            worst, where = abs(x - y) / size, f'row {i + 1}, {name}: {a[k]}, {b[k]}'
if faults or not worst <= share:
    sys.exit('\n'.join(faults[:5]) or f'{worst:.1e} of the largest: {where}')

#!/usr/bin/env python3
"""vtk_same.py SHARE DIR DIR: do the lists result.pvd of two folders name the same moments with the same points and values, in whatever order and parts? Numbers may
differ by this share of the largest of their field. Prints the numbers of parts of the moments of each."""
import array
import os
import re
import struct
import sys


def attribute(element, name):
    found = re.search(rf'\b{name}="([^"]*)"', element)
    return found and found.group(1)


def moment(folder, name):
    """Rows of numbers of every field of the points, by their places; and of how many files."""
    with open(os.path.join(folder, name), 'rb') as file:
        data = file.read()
    if name.endswith('.pvtu'):
        whole, pieces = {}, re.findall(r'<Piece Source="([^"]*)"/>', data.decode())
        for piece in pieces:
            rows, _ = moment(folder, piece)
            if whole.keys() & rows.keys():
                sys.exit(f'{name}: two parts have one point')
            whole.update(rows)
        described = re.findall(r'Name="(\w+)"', data.decode())
        if any([*list(row)[1:], 'Points'] != described for row in whole.values()):
            sys.exit(f'{name}: parts have other fields than {described}')
        return whole, len(pieces)
    head, _, values = data.partition(b'<AppendedData encoding="raw">\n_')
    columns = {}
    for element in re.findall(r'<DataArray[^>]*format="appended"[^>]*>', head.decode()):
        at, width = int(attribute(element, 'offset')), int(attribute(element, 'NumberOfComponents') or 0)
        if width:
            number, = struct.unpack_from('=Q', values, at)
            numbers = array.array('d', values[at + 8:at + 8 + number])
            columns[attribute(element, 'Name')] = [tuple(numbers[i:i + width]) for i in range(0, len(numbers), width)]
    x = columns.pop('Points')
    return {place: {'x': place, **{field: column[i] for field, column in columns.items()}} for i, place in enumerate(x)}, 1


def listed(folder):
    with open(os.path.join(folder, 'result.pvd'), encoding='ascii') as file:
        return re.findall(r'<DataSet timestep="([^"]*)" part="0" file="([^"]*)"/>', file.read())


share, (one, other) = float(sys.argv[1]), sys.argv[2:4]
first, second = listed(one), listed(other)
if not first or [time for time, _ in first] != [time for time, _ in second]:
    sys.exit(f'times {first} and {second}')
for (_, a), (_, b) in zip(first, second):
    (a, parts), (b, others) = moment(one, a), moment(other, b)
    print(parts, others)
    if a.keys() != b.keys():
        sys.exit(f'{len(a)} points and {len(b)}, or at other places')
    for field in next(iter(a.values())):
        most = max(abs(x) for row in a.values() for x in row[field]) or 1
        apart = max(abs(x - y) for place in a for x, y in zip(a[place][field], b[place][field])) / most
        if not apart <= share:
            sys.exit(f'{field}: {apart} of the largest')

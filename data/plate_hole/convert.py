#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""convert.py FOLDER: makes the tables of this folder from plate_hole_centre_lines.csv and plate_hole_first_rows.csv in FOLDER.
Their source: an independent finite element solution of degree 8 to 12 on graded meshes with exactly curved edges, two successive refinements
compared; relative error 1e-9 (grips sliding, A), 3e-8 (clamped, B); in mm for D = 1 mm, linear in D."""
import csv, os, sys

if len(sys.argv) != 2: sys.exit(__doc__)
read = lambda name: list(csv.DictReader(open(os.path.join(sys.argv[1], name))))
centre, rows = read('plate_hole_centre_lines.csv'), read('plate_hole_first_rows.csv')


def write(name, columns):                              # columns: (title, rows, column in the source)
    with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), name), 'w') as out:
        out.write(','.join(c[0] for c in columns) + '\n')
        for k in range(len(columns[0][1])): out.write(','.join(c[1][k][c[2]] for c in columns) + '\n')


for letter, grips in (('A', 'sliding'), ('B', 'clamped')):
    write(f'{grips}_x.csv', [('x [mm]', centre, 's_mm'), ('u_x [mm]', centre, f'u1{letter}_h')])
    write(f'{grips}_y.csv', [('y [mm]', centre, 's_mm'), ('u_y [mm]', centre, f'u2{letter}_v')])
    write(f'{grips}_row_x.csv', [('x [mm]', rows, 's_mm'), ('u_x [mm]', rows, f'u1_h{letter}'), ('u_y [mm]', rows, f'u2_h{letter}')])
    write(f'{grips}_row_y.csv', [('y [mm]', rows, 's_mm'), ('u_x [mm]', rows, f'u1_v{letter}'), ('u_y [mm]', rows, f'u2_v{letter}')])

#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""convert.py FOLDER: makes neutral_axis.csv of this folder from beam_neutral_axis.csv in FOLDER.
Its source: an independent finite element solution of degree 8 to 12 on graded meshes, two successive refinements compared; relative error 2e-8.
Column S1: supports are the bottom corner points, deflection relative to the end of the neutral axis (0, 0.05 m)."""
import csv, os, sys

if len(sys.argv) != 2: sys.exit(__doc__)
rows = csv.DictReader(open(os.path.join(sys.argv[1], 'beam_neutral_axis.csv')))
with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), 'neutral_axis.csv'), 'w') as out:
    out.write('x [m],u_y [m]\n')
    for r in rows: out.write(f"{float(r['x_m']):.6g},{r['wNA_S1_corner_pins_rel_NA_end']}\n")

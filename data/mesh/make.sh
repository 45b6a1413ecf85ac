#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Writes the samples of this folder with the program gmsh (4.8.4 when they were made): sh make.sh, in this folder.
g() { out=$1; shift; gmsh -v 1 "$@" -o "$out"; }
for v in "22 msh22 0" "22b msh22 1" "41 msh4 0" "41b msh4 1"; do
    set -- $v
    g disk_tri6_$1.msh disk.geo -2 -order 2 -format $2 -setnumber Mesh.Binary $3
    g box_hex20_$1.msh box.geo -3 -order 2 -format $2 -setnumber Mesh.Binary $3 -setnumber Mesh.SecondOrderIncomplete 1
    g disk_tri3_parametric_$1.msh disk.geo -2 -format $2 -setnumber Mesh.Binary $3 -setnumber Mesh.SaveParametric 1
done
g disk_tri3.msh disk.geo -2 -format msh4 -bin
g disk_quad4.msh disk.geo -2 -format msh4 -bin -setnumber quads 1
g disk_quad8.msh disk.geo -2 -order 2 -format msh4 -bin -setnumber quads 1 -setnumber Mesh.SecondOrderIncomplete 1
g disk_quad9.msh disk.geo -2 -order 2 -format msh4 -bin -setnumber quads 1
g box_hex8.msh box.geo -3 -format msh4 -bin
g box_hex27.msh box.geo -3 -order 2 -format msh4 -bin
g cylinder_wedge6.msh cylinder.geo -3 -format msh4 -bin
g cylinder_wedge15.msh cylinder.geo -3 -order 2 -format msh4 -bin -setnumber Mesh.SecondOrderIncomplete 1
g ball_tet4.msh ball.geo -3 -clmin 0.7 -format msh4 -bin
g ball_tet10.msh ball.geo -3 -clmin 0.9 -order 2 -format msh4 -bin

#!/bin/bash
# test_bench.sh BUILD: perigal bench and perigal converge on a small cantilever: tables, pictures, orders, what is refused and how.
. "$(dirname "$0")/expect.sh"
cd "$(dirname "$0")/../../.." || exit 1
beam=data/textbook_cantilever/scene.yaml
# column FILE NAME [FILTER]: the values of a column (unit dropped) in the rows that match
column() {
    awk -F, -v want="$2" -v filter="${3:-.}" 'NR == 1 { for (k = 1; k <= NF; k++) { split ($k, part, " \\["); if (part[1] == want) at = k } next } $0 ~ filter { print $at }' "$1"
}
picture() { [ -s "$1" ] && [ "$(head -c 8 "$1" | od -An -tx1 | tr -d ' \n')" = 89504e470d0a1a0a ] && [ "$(stat -c %s "$1")" -gt 15000 ]; }
between() { awk -v v="$1" -v low="$2" -v high="$3" 'BEGIN { exit !(v != "" && v >= low && v <= high) }'; }

expect "bench: two methods, two sizes" 0 'rkpm gauss linear .*dofs  L2' '' bench $beam --approximation rkpm --integration gauss,nodal --basis linear \
       --spacing 3,1.5 --repeat 2 -o "$work/bench"
table=$work/bench/bench.csv
[ "$(wc -l < "$table")" -eq 5 ]; verdict "a row for each run" $?
good=0
for name in case method points dofs l2 energy maximum assemble factor solve cpu wall peak; do
    [ "$(column "$table" $name | grep -c .)" -eq 4 ] || { good=1; echo "column $name" >> "$work/err"; }
done
verdict "every column is filled" $good
[ "$(column "$table" runs | sort -u)" = 2 ]; verdict "every run was repeated" $?
[ "$(column "$table" dofs gauss | tr '\n' ' ')" = "170 594 " ]; verdict "unknowns of both sizes" $?
between "$(column "$table" l2 'gauss,linear' | tail -1)" 2e-4 3.5e-4; verdict "the error of doc/accuracy.md" $?
picture "$work/bench/time_error.png"; verdict "time_error.png" $?
picture "$work/bench/dofs_error.png"; verdict "dofs_error.png" $?
grep -q 'L2 1e-03: perigal [0-9.]* s (rkpm gauss linear)' "$work/out"; verdict "the least seconds at an error, and whose" $?
grep -q 'L2 1e-05: perigal: not reached' "$work/out"; verdict "an error that was not reached is said so" $?
expect "bench: impossible combinations are named and skipped" 0 'skipped: .*horizon' '' bench $beam --approximation rkpm --basis linear --integration gauss \
       --horizon 0.5,2 --spacing 3 -o "$work/skip"
grep -q 'skipped' "$work/skip/bench.csv"; verdict "the table says so too" $?
expect "bench: --fem of a scene without a mesh" 0 'ccx .*skipped: no mesh of this scene' '' bench test/app/cli/plate.yaml --approximation rkpm --basis linear --integration nodal \
       --spacing '4 mm' --fem --set solver.max_events=1 -o "$work/fem"
if command -v python3 > /dev/null; then
    kirsch="data/kirsch/scene.yaml data/kirsch_mesh/scene.yaml --approximation rkpm --integration consistent --basis quadratic"
    expect "bench: a scene and the same on a mesh" 0 'kirsch_mesh .*rkpm consistent quadratic mesh .* 162 dofs' '' bench $kirsch --spacing 0.5 --mesh-size 4,8 -o "$work/mesh"
    table=$work/mesh/bench.csv
    [ "$(column "$table" dofs ' mesh,' | tr '\n' ' ')" = "50 162 " ]; verdict "the meshes asked for" $?
    # errors of these meshes at horizon 2.6: a reference or a mesh that is another gives others
    between "$(column "$table" l2 ' mesh,' | tail -1)" 4.6e-4 4.8e-4; verdict "the error on the mesh" $?
    picture "$work/mesh/time_error.png" && [ ! -e "$work/mesh/time_error_kirsch.png" ]; verdict "one picture of both" $?
    [ "$(grep -c 'least CPU seconds' "$work/out")" -eq 1 ] && grep -q 'L2 1e-03: perigal [0-9.]* s (rkpm consistent quadratic mesh)' "$work/out"; verdict "the best curve of both scenes" $?
    solid="data/cantilever_3d_mesh/scene.yaml --approximation rkpm --integration gauss --basis linear"
    expect "bench: a solid on a mesh" 0 'cantilever_3d_mesh .*rkpm gauss linear mesh .* 270 dofs' '' bench $solid --mesh-size 3,4 -o "$work/solid"
    table=$work/solid/bench.csv
    [ "$(column "$table" dofs ' mesh,' | tr '\n' ' ')" = "168 270 " ]; verdict "the meshes asked for" $?
    between "$(column "$table" l2 ' mesh,' | tail -1)" 3.0e-4 3.2e-4; verdict "the error of data/cantilever_3d_mesh/README.md" $?
    expect "bench: a size without elements" 0 'skipped: make_mesh.py' '' bench $kirsch --spacing 1 --mesh-size 0,4 -o "$work/mesh0"
    expect "bench: the plate with a hole on a mesh" 0 ' 1152 dofs' '' bench data/plate_hole_mesh/scene_sliding.yaml --approximation rkpm --integration consistent --basis quadratic \
           --mesh-size 8 -o "$work/hole"
    between "$(column "$work/hole/bench.csv" lines)" 3e-4 7e-4; verdict "its error on the lines" $?
fi
if command -v ccx > /dev/null && command -v python3 > /dev/null; then
    expect "bench: the same sizes for CalculiX, once for both scenes" 0 'ccx [0-9.]* s (ccx CPS8)' '' bench $kirsch --spacing 1 --mesh-size 4,8 --fem -o "$work/both"
    [ "$(column "$work/both/bench.csv" dofs CPS8 | tr '\n' ' ')" = "130 450 " ]; verdict "their unknowns" $?
    solid="data/cantilever_3d/scene.yaml data/cantilever_3d_mesh/scene.yaml --approximation rkpm --integration gauss --basis linear"
    expect "bench: CalculiX on the meshes of both scenes" 0 'ccx C3D20 mesh .* 96 dofs' '' bench $solid --spacing 6 --mesh-size 2 --fem-element C3D20 --fem-size 1 -o "$work/long"
    [ "$(column "$work/long/bench.csv" dofs C3D20 | tr '\n' ' ')" = "168 96 " ]; verdict "unknowns of cubes and of long hexahedra" $?
    expect "bench: CalculiX beside" 0 'ccx CPS4 .* 170 dofs' '' bench $beam --approximation rkpm --basis linear --integration gauss --spacing 1.5 --fem-element CPS4,CPS8 \
           --fem-size 4 --repeat 2 -o "$work/ccx"
    # the errors that data/calculix/make_mesh.py --measure gives, in code of its own
    between "$(column "$work/ccx/bench.csv" l2 CPS4)" 0.02930 0.02931; verdict "L2 error of CPS4" $?
    between "$(column "$work/ccx/bench.csv" energy CPS4)" 0.1754 0.1755; verdict "energy error of CPS4" $?
    between "$(column "$work/ccx/bench.csv" l2 CPS8)" 2.10e-5 2.12e-5; verdict "L2 error of CPS8" $?
    between "$(column "$work/ccx/bench.csv" peak CPS8)" 2e6 1e8; verdict "memory of the process of ccx" $?
    python3 data/calculix/make_mesh.py --measure "$work/ccx/fem/cantilever_CPS4_4.frd" cantilever CPS4 4 > "$work/out"
    between "$(cut -d, -f5 "$work/out")" 0.02930 0.02931; verdict "make_mesh.py --measure agrees" $?
    expect "bench: an element that make_mesh.py does not know" 0 'skipped: make_mesh.py .*no element CPS5' '' bench $beam --approximation rkpm --basis linear --integration nodal \
           --spacing 3 --fem-element CPS5 --fem-size 4 -o "$work/ccx5"
fi
expect "a result of CalculiX that is none"             70 '' 'nowhere.frd' bench --fem-row $beam nowhere.frd m
expect "bench: an entry that is none names the nearest" 64 '' 'did you mean rkpm' bench $beam --approximation rkpn
expect "bench: an option that is none"                 64 '' 'unknown option --spacin (did you mean --spacing' bench $beam --spacin 3
expect "bench: a list without its value"               64 '' '--spacing needs a list' bench $beam --spacing
expect "bench: a scene that is none"                   65 '' '^nowhere.yaml' bench nowhere.yaml -o "$work/none"
expect "bench --help"                                   0 'dofs_error.png' '' bench --help

expect "converge: nodal quadrature" 0 'delta-convergence' '' converge $beam --set spacing=3 --set method.integration=nodal --spacing 3 -o "$work/nodal"
table=$work/nodal/convergence.csv
between "$(column "$table" order 'L2 error' | tail -1)" 1.8 2.2; verdict "nodal quadrature: order 2" $?
[ "$(column "$table" value 'L2 error' | wc -l)" -eq 3 ]; verdict "a row for each size" $?
between "$(column "$table" limit 'end.displacement_y' | tail -1)" -0.00894 -0.00884; verdict "Richardson's value of the deflection is near the exact one" $?
grep -q 'end.force_x' "$table"; [ $? -ne 0 ]; verdict "a reaction that is rounding is left out" $?
picture "$work/nodal/convergence.png"; verdict "convergence.png" $?
expect "converge: Gauss quadrature, two horizons" 0 'horizon 2.5 spacings' '' converge $beam --set spacing=3 --spacing 3 --horizon 2,2.5 -o "$work/gauss"
between "$(column "$work/gauss/convergence.csv" order '^2,L2 error' | tail -1)" 2.4 3.2; verdict "Gauss quadrature on a lattice: better than order 2" $?
expect "converge: Kirsch's plate, moved points" 0 'L2 error' '' converge data/kirsch/scene.yaml --spacing 3 --set method.integration=consistent --set perturb.amount=0.2 -o "$work/kirsch"
between "$(column "$work/kirsch/convergence.csv" order 'L2 error' | tail -1)" 1.8 2.4; verdict "consistent integration on cut cells: order 2" $?
between "$(column "$work/kirsch/convergence.csv" value 'L2 error' | tail -1)" 2e-5 5e-5; verdict "and the error of doc/accuracy.md" $?
expect "converge --m keeps the horizon" 0 'm-convergence' '' converge $beam --set spacing=3 --m --ratio 1.5 --spacing 2 -o "$work/m"
expect "converge: points of a file cannot be refined"   65 '' 'needs a body and spacing' converge test/fuzz/seed_scene/points.yaml -o "$work/points"
expect "converge: --delta and --m"                     64 '' 'exclude each other' converge $beam --delta --m
expect "converge: no number"                           64 '' '--ratio x: a number from' converge $beam --ratio x
expect "converge without a scene"                      64 '' 'a scene file is needed' converge
expect "converge: a wrong scene"                       65 '' 'unknown key' converge test/app/cli/wrong/unknown_key.yaml -o "$work/wrong"
expect "converge --help"                                0 'Richardson' '' converge --help
finish

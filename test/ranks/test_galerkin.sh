#!/bin/bash
# test_galerkin.sh BUILD: equilibria by shape functions of ranks that divide the body: fields, rows and broken bonds of one process, for all integrations
# and approximations, with a crack along the boundary of two parts.
. "$(dirname "$0")/ranks.sh"

# equal NAME NUMBERS LEAST ARGUMENTS...: on so many ranks; at least so many bonds break, the same ones at the same loads, with the same fields and rows
equal() {
    local name=$1 numbers=$2 least=$3 r; shift 3
    alone "$scene" -o "$work/one" --force "$@" "${one[@]}"; verdict "$name: one process" $?
    [ "$(wc -l < "$work/one/events.csv")" -gt "$least" ]; verdict "$name: at least $least bonds break" $?
    for r in $numbers; do
        rm -rf "$work/some"
        ranks "$r" "$scene" -o "$work/some" "$@"; verdict "$name: $r ranks" $?
        [ "$r" = 1 ] || grep -q '"division": "subdomains"' "$work/some/report.json"; verdict "$name: $r ranks divide the body" $?
        python3 -S fields.py 1e-9 "$work/one/result.e" "$work/some/result.e" > "$work/why" 2>&1; verdict "$name: the same fields on $r ranks" $?
        alike 1e-8 "$work/one" "$work/some" history.csv residual moment $left; verdict "$name: the same rows on $r ranks" $?
        alike 1e-7 "$work/one" "$work/some" events.csv; verdict "$name: the same bonds on $r ranks" $?
    done
}
# iterations DIR MOST DIR: those of the first are at most so many times those of the second, where every solution is found by conjugate gradients
iterations() {
    python3 - "$@" > "$work/why" 2>&1 << 'PYTHON'
import json, sys
a, b = (json.load(open(d + '/report.json'))['cg_iterations'] for d in (sys.argv[1], sys.argv[3]))
print(a, b)
sys.exit(not 0 < a <= float(sys.argv[2]) * b)
PYTHON
}
long() { [ "$PERIGAL_TEST_SIZE" = long ]; }
events=(--set 'solver={kind: static, stepping: event, max_events: 12, division: subdomains}' --set output.at.levels=2)
bonds=(--set method.horizon='2.5 spacing' --set 'failure={criterion: stretch, critical_stretch: 6e-4}' --set materials.glass.poissons_ratio=0.25)
all=3 && long && all='1 2 3 4'
scene=galerkin.yaml left= one=()
equal gauss 2 70
equal consistent 3 100 --set method.integration=consistent
long && equal nodal 2 20 --set method.integration=nodal --set failure.tensile_strength='6 MPa'
long && equal pddo 4 20 --set method.approximation=pddo
equal nosb 2 10 --set method.approximation=nosb --set method.integration=nodal --set failure.tensile_strength='6.5 MPa'
equal 'nu 0.45' 2 10 --set plane=strain --set materials.rock.poissons_ratio=0.45 --set failure.tensile_strength='11 MPa'

# small bodies are factored by every rank; finite elements, as of larger ones
elements=(--set solver.preconditioner=multilevel)
# coarse functions are split at cracks, as those of one process are: as many iterations; a long crack, of which no end is in the middle
alone "$scene" -o "$work/one" --force --set solver.linear=pcg --set 'cracks=[{from: [0.1 mm, -12 mm], to: [0.1 mm, 12 mm]}]'
for r in $all; do
    rm -rf "$work/some"
    ranks "$r" "$scene" -o "$work/some" "${elements[@]}" --set 'cracks=[{from: [0.1 mm, -12 mm], to: [0.1 mm, 12 mm]}]' && iterations "$work/some" 1.15 "$work/one"
    verdict "iterations of one process on $r ranks" $?
done

# supports by stiff penalties, which are springs of all ranks, on points of two parts; by iterations in one process too: of a penalty of 1e6, a factor and
# iterations differ by 1.2e-9 there
one=(--set solver.linear=pcg)
equal 'stiff supports' "$all" 20 "${elements[@]}" --set 'layers=[{name: lid, side: top, thickness: 2 spacing}, {name: foot, side: bottom, thickness: 2 spacing}]' \
      --set 'boundary=[{name: a, set: lid, displacement: {x: 0, y: 3 um}}, {name: b, set: foot, displacement: {x: 0, y: -3 um}}]' --set solver.steps=2 \
      --set failure.tensile_strength='6 MPa' --set solver.tolerance=1e-10
one=()

# from event to event
left='force_x displacement_x'
equal events "$all" 12 "${events[@]}" --set failure.tensile_strength='6 MPa'
long && equal 'events, nodal' "$all" 12 "${events[@]}" --set failure.tensile_strength='5 MPa' --set method.integration=nodal

# a block with a crack, of shape functions and of two kinds of bonds
scene=solid.yaml left='force_y force_z displacement_y displacement_z'
equal 'in space' "$all" 30 "${elements[@]}" --set solver.steps=$(long && echo 2 || echo 1)
long && equal 'in space, events' "$all" 5 "${events[@]}" --set solver.max_events=6
long && equal 'in space, lps' "$all" 30 "${bonds[@]}" --set method.force=lps
long && equal 'in space, bond' "$all" 30 "${bonds[@]}" --set method.force=bond

# consistent integration in cells that end at a crack, and (long) in cut cells: fields of one process on three ranks; the same cells held or not
one=(--set solver.linear=pcg)
for scene in $(long && echo cut_cells) crack_through; do
    alone $scene.yaml -o "$work/one" --force "${one[@]}" --set solver.division=auto; verdict "$scene: one process" $?
    rm -rf "$work/some"
    ranks 3 $scene.yaml -o "$work/some"; verdict "$scene: 3 ranks" $?
    python3 -S fields.py 1e-9 "$work/one/result.e" "$work/some/result.e" > "$work/why" 2>&1; verdict "$scene: the same fields on 3 ranks" $?
done
finish

#!/bin/bash
# test_scattered.sh BUILD: shape functions on points that are no lattice, on ranks that divide the body: perturbed lattices, points of a file with and
# without their surface, meshes; at rest, from event to event and in motion. Also forces between the points of a mesh.
. "$(dirname "$0")/ranks.sh"
cp galerkin.yaml motion.yaml solid.yaml cloud.yaml "$work/"

# equal NAME NUMBERS LEAST SCENE ARGUMENTS...: on so many ranks; at least so many bonds break, the same ones at the same loads, with the same fields and rows
equal() {
    local name=$1 numbers=$2 least=$3 scene=$work/$4 r; shift 4
    alone "$scene" -o "$work/one" --force "$@" "${one[@]}"; verdict "$name: one process" $?
    [ "$(wc -l < "$work/one/events.csv")" -gt "$least" ]; verdict "$name: at least $least bonds break" $?
    for r in $numbers; do
        rm -rf "$work/some"
        ranks "$r" "$scene" -o "$work/some" "$@" && grep -q '"division": "subdomains"' "$work/some/report.json"; verdict "$name: $r ranks divide the body" $?
        python3 -S fields.py "$share" "$work/one/result.e" "$work/some/result.e" > "$work/why" 2>&1; verdict "$name: the same fields on $r ranks" $?
        alike 1e-8 "$work/one" "$work/some" history.csv residual moment $left; verdict "$name: the same rows on $r ranks" $?
        alike 1e-7 "$work/one" "$work/some" events.csv; verdict "$name: the same bonds on $r ranks" $?
    done
}
long() { [ "$PERIGAL_TEST_SIZE" = long ]; }
all=3 && long && all='2 3 4'
events=(--set 'solver={kind: static, stepping: event, max_events: 12, division: subdomains}' --set output.at.levels=2)
share=1e-9 left= one=()

# perturbed lattices
moved=(--set perturb.amount=0.25)
equal 'a perturbed lattice' "$all" 50 galerkin.yaml "${moved[@]}"
long && equal 'consistent' 2 50 galerkin.yaml "${moved[@]}" --set method.integration=consistent
long && equal 'nodal' 4 20 galerkin.yaml "${moved[@]}" --set method.integration=nodal --set failure.tensile_strength='6 MPa'
long && equal 'nu 0.45' 2 10 galerkin.yaml "${moved[@]}" --set plane=strain --set materials.rock.poissons_ratio=0.45 --set failure.tensile_strength='11 MPa'
left='force_x displacement_x'
long && equal 'events' 2 12 galerkin.yaml "${moved[@]}" "${events[@]}" --set failure.tensile_strength='6 MPa'
left='force_y force_z displacement_y displacement_z'
long && equal 'in space' "$all" 100 solid.yaml "${moved[@]}" --set failure.tensile_strength='43 MPa'
left='force_x displacement_x'
equal 'Newmark' 2 10 galerkin.yaml "${moved[@]}" --set materials.rock.density='2500 kg/m3' --set output.fields='[displacement, velocity, damage]' --set output.at.levels=2 \
      --set 'solver={kind: newmark, dt: 1e-5 s, time_steps: 4, tolerance: 1e-11, division: subdomains}' \
      --set 'boundary=[{name: left, set: left, velocity: {x: -0.1 m/s, y: 0}}, {name: right, set: right, velocity: {x: 0.1 m/s, y: 0}}]'
left=

# points of a file: nodal integration, which needs no cells; with their surface, Gauss points in the cells of a grid
python3 scattered.py 2 20 > "$work/cloud.csv"
sed '/^body:/,/^spacing/c points: cloud.csv' galerkin.yaml > "$work/points.yaml"
sed '/^body:/,/^spacing/c points: cloud.csv\nbody: [{add: {box: {low: [-25 mm, -25 mm], high: [25 mm, 25 mm]}}}, {subtract: {disk: {center: [10 mm, 12 mm], radius: 3 mm}}}]' galerkin.yaml > "$work/shaped.yaml"
held=(--set 'boundary=[{name: left, set: left, essential: penalty, displacement: {x: -4 um, y: 0}}, {name: right, set: right, essential: penalty, displacement: {x: 4 um, y: 0}}]'
      --set solver.tolerance=1e-10 --set method.penalty_factor=1e4 --set method.integration=nodal)
one=(--set solver.linear=pcg)
equal 'points of a file' "$all" 5 points.yaml "${held[@]}" --set failure.tensile_strength='5.5 MPa' --set solver.steps=1
one=()
equal 'points and their surface' 2 20 shaped.yaml --set failure.tensile_strength='7 MPa' --set solver.steps=$(long && echo 2 || echo 1) --set solver.preconditioner=multilevel

# meshes: their elements are the cells
python3 meshed.py 20 > "$work/mesh.inp"
sed '/^body:/,/^spacing/c mesh: {file: mesh.inp, unit: mm}' galerkin.yaml > "$work/mesh.yaml"
equal 'a mesh' "$all" 20 mesh.yaml --set failure.tensile_strength='6.3 MPa' --set solver.preconditioner=multilevel
grep -q '"preconditioner": "finite elements, GAMG' "$work/some/report.json"; verdict "by finite elements and GAMG" $?
long && equal 'a mesh, two materials' 2 5 mesh.yaml --set 'materials={rock: {youngs_modulus: 20 GPa, poissons_ratio: 0.25}, ore: {youngs_modulus: 15 GPa, poissons_ratio: 0.2}}' \
      --set 'blocks=[{block: left_half, material: rock}, {block: right_half, material: ore}]' --set 'boundary[0]={name: left, set: grip, displacement: {x: -4 um, y: 0}}' \
      --set failure.tensile_strength='6 MPa'

# forces between the points of a mesh, and a traction on its facets
bonds=(--set 'method={force: bond, horizon: 3 spacing, accept_inexact: yes}' --set 'failure={criterion: stretch, critical_stretch: 4e-4}' --set materials.rock.density='2500 kg/m3'
       --set 'solver={kind: verlet, dt: 2e-7 s, time_steps: 60}' --set output.fields='[displacement, damage]'
       --set 'boundary=[{name: left, set: left, velocity: {x: -1 m/s}}, {name: right, set: right, velocity: {x: 1 m/s}}, {name: lid, set: top, pressure: 0.1 MPa}]')
equal 'bonds of a mesh' "$all" 20 mesh.yaml "${bonds[@]}"

# what goes with one process only
"$perigal" check "$work/mesh.yaml" --ranks 2 --set plane=strain --set materials.rock.poissons_ratio=0.49 > "$work/out" 2> "$work/err"
[ $? -eq 65 ] && grep -q 'method.dilatation: 2 ranks: patches of points that no lattice gives' "$work/err"; verdict "patches of a mesh are refused, and what to do" $?
"$perigal" check "$work/points.yaml" --ranks 2 --set method.integration=nodal --set 'boundary=[{set: left, displacement: {x: 0, y: 0}}]' > "$work/out" 2> "$work/err"
[ $? -eq 65 ] && grep -q '2 ranks: essential: transformation couples all points' "$work/err"; verdict "elimination is refused, and what to do" $?
finish

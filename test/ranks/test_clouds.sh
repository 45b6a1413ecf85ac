#!/bin/bash
# test_clouds.sh BUILD: points that are no lattice, divided among ranks by their coordinates: scattered points of a file, perturbed lattices, in
# explicit runs and at rest; parts that are narrower than the horizon; a crack along the boundary of parts.
. "$(dirname "$0")/ranks.sh"

# equal NAME SCENE NUMBERS ARGUMENTS...: on so many ranks the events, rows and fields of one process, to rounding
equal() {
    local name=$1 scene=$2 numbers=$3 r; shift 3
    rm -rf "$work/one"
    alone "$scene" -o "$work/one" "$@"; verdict "$name: one process" $?
    [ "$(wc -l < "$work/one/events.csv")" -gt "$least" ]; verdict "$name: something breaks" $?
    for r in $numbers; do
        rm -rf "$work/some"
        ranks "$r" "$scene" -o "$work/some" "$@" && grep -q '"division": "subdomains"' "$work/some/report.json"; verdict "$name: $r ranks" $?
        alike "$share" "$work/one" "$work/some" events.csv; verdict "$name: the same bonds on $r ranks" $?
        alike "$share" "$work/one" "$work/some" history.csv $out; verdict "$name: the same rows on $r ranks" $?
        python3 -S fields.py "$share" "$work/one/result.e" "$work/some/result.e" > "$work/why" 2>&1; verdict "$name: the same fields on $r ranks" $?
    done
}
cp ./*.yaml "$work/"; here=$work least=20 share=1e-9 out=
python3 scattered.py 2 32 > "$work/cloud.csv"
long() { [ "$PERIGAL_TEST_SIZE" = long ]; }
some=3 all=4 halves=2
[ "$PERIGAL_TEST_SIZE" = long ] && some='2 4 8' all='2 3 4' halves='2 4'
equal "scattered points" "$here/cloud.yaml" "$all"
long && equal "lps" "$here/cloud.yaml" "$some" --set method.force=lps --set materials.steel.poissons_ratio=0.2
long && equal "gmpd" "$here/cloud.yaml" "$some" --set method.force=gmpd --set materials.steel.poissons_ratio=0.2 \
      --set 'failure={criterion: beam_limits, fracture_energy: 20 kJ/m2}'
equal "volumes of surfaces corrected" "$here/cloud.yaml" "$some" --set method.surface_correction=volume
equal "a perturbed lattice" "$here/plate.yaml" "$some" --set spacing='1.5 mm' --set solver.dt='1.5e-7 s' --set solver.time_steps=120 --set perturb.amount=0.2
python3 scattered.py 2 32 0 > "$work/cloud.csv"
equal "points of a file that are a lattice" "$here/cloud.yaml" "$some"
python3 scattered.py 3 9 > "$work/cloud.csv"
equal "in space" "$here/cloud_space.yaml" "$some"

# at rest: to the tolerance of equilibria
least=5 share=1e-7 out='residual force_x displacement_x moment'
python3 scattered.py 2 24 > "$work/cloud.csv"
equal "scattered points at rest" "$here/cloud.yaml" "$some" --set 'solver={kind: static, stepping: fixed, steps: 3, division: subdomains}' --set method.accept_inexact=yes \
      --set 'boundary=[{name: top, set: upper, displacement: {x: 0, y: 0.2 mm}}, {name: bottom, set: lower, displacement: {x: 0, y: -0.2 mm}}]'

# parts of a bar that are narrower than the horizon: ghosts reach beyond the next neighbours
least=5 share=1e-9 out=
bar=(--set 'body=[{add: {box: {low: [-12 mm, -2 mm], high: [12 mm, 2 mm]}}}]' --set spacing='1 mm' --set 'layers=[]' --set solver.dt='1e-7 s' --set solver.time_steps=300 --set lattice=cells --set method.accept_inexact=yes
     --set 'cracks=[{from: [0, -3 mm], to: [0, 0.3 mm]}]' --set 'boundary=[{name: top, set: right, velocity: {x: 20 m/s}}, {name: bottom, set: left, velocity: {x: -20 m/s}}]')
out='force_y moment'
equal "parts narrower than the horizon" "$here/plate.yaml" 8 "${bar[@]}" --set 'output.gauges=[]'
grep -q '"neighbours": [4-9]' "$work/some/report.json"; verdict "ghosts reach beyond the next neighbours" $?

# the body is cut where its crack is: both halves are the same
out=moment
equal "a crack along the boundary of parts" "$here/plate.yaml" "$halves" --set 'body=[{add: {box: {low: [-25 mm, -25 mm], high: [25 mm, 25 mm]}}}]' --set spacing='1.25 mm' \
      --set solver.dt='1.5e-7 s' --set solver.time_steps=120 --set lattice=cells --set 'cracks=[{from: [-12 mm, 0], to: [12 mm, 0]}]'

python3 scattered.py 2 3 > "$work/cloud.csv"
ranks 12 "$here/cloud.yaml" -o "$work/no" --set method.horizon='1.5 spacing' --set 'cracks=[]'; [ $? -ne 0 ] && grep -q 'a rank would have no point: the body has 9, take fewer ranks than 12' "$work/err"
verdict "more ranks than points" $?
finish

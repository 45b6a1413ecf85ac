#!/bin/bash
# test_loads.sh BUILD: planes of symmetry, forces and springs at a place, and stages of loading on ranks that divide the body: rows, fields and broken
# bonds of one process.
. "$(dirname "$0")/ranks.sh"

# equal NAME LEAST SCENE ARGUMENTS...: at least so many bonds break, the same ones at the same loads
equal() {
    local name=$1 least=$2 scene=$3 r; shift 3
    alone "$scene" -o "$work/one" --force "$@"; verdict "$name: one process" $?
    [ "$(wc -l < "$work/one/events.csv")" -gt "$least" ]; verdict "$name: at least $least bonds break" $?
    for r in $numbers; do
        rm -rf "$work/some"
        ranks "$r" "$scene" -o "$work/some" "$@"; verdict "$name: $r ranks" $?
        [ "$r" = 1 ] || grep -q '"division": "subdomains"' "$work/some/report.json"; verdict "$name: $r ranks divide the body" $?
        python3 -S fields.py 1e-9 "$work/one/result.e" "$work/some/result.e" > "$work/why" 2>&1; verdict "$name: the same fields on $r ranks" $?
        alike 1e-8 "$work/one" "$work/some" history.csv residual $left; verdict "$name: the same rows on $r ranks" $?
        alike 1e-7 "$work/one" "$work/some" events.csv; verdict "$name: the same bonds on $r ranks" $?
    done
}
stages() {
    python3 -c 'import json, sys
a, b = (json.load(open(d + "/report.json"))["stages"] for d in sys.argv[1:])
print(a, b)
near = lambda x, y: abs (x - y) <= 1e-6 * max (abs (x), abs (y), 1e-9) if isinstance (x, float) else x == y
sys.exit(not (len(a) == len(b) and all(near(x[k], y[k]) for x, y in zip(a, b) for k in x if k not in ("gauges", "energy")) and
    all(near(x["energy"]["external"], y["energy"]["external"]) for x, y in zip(a, b) if "energy" in x)))' "$work/one" "$work/some" > "$work/why" 2>&1
}
numbers=3 left=
long() { [ "$PERIGAL_TEST_SIZE" = long ]; }
[ "$PERIGAL_TEST_SIZE" = long ] && numbers='1 2 3 4'
# the half of a plate; a force at a place near the boundary of two parts, held against by a spring elsewhere
half=(--set 'boundary=[{name: middle, set: left, symmetry: on}, {name: foot, set: bottom, displacement: {x: 0, y: 0}}, {name: pull, at: [3.3 mm, 19 mm], force: {x: 20 N, y: 60 N}}, {name: hold, at: [20 mm, -7.7 mm], spring: {x: 1e6 N/m, y: 1e6 N/m}}]')
equal 'symmetry, places' 0 galerkin.yaml "${half[@]}" --set failure.tensile_strength='80 MPa' --set solver.steps=1
equal 'the same by bonds' 0 rest.yaml "${half[@]}" --set lattice=nodes --set solver.steps=1
# a hole that is dug where the parts meet
dug=(--set spacing='1.25 m' --set 'solver={kind: static, stepping: fixed, steps: 3, division: subdomains}' --set output.at.levels=3)
left=moment                                            # about the middle of the floor: little is left of much
equal 'excavation' 0 ../../data/tunnel/scene.yaml "${dug[@]}"; stages; verdict "excavation: the stages end alike" $?
equal 'excavation by bonds' 0 ../../data/tunnel/scene.yaml "${dug[@]}" --set 'method={force: bond, accept_inexact: yes}'
left=
# pressed, then pulled until a gauge has opened, then let go
steps=(--set 'stages=[{name: press, boundary: {lid: 1}}, {name: pull, boundary: {left: 1, right: 1}, until: {gauge: g, opening: 3 um}}, {name: back, boundary: {left: 0, right: 0}}]' --set solver.steps=2)
equal 'stages, fixed' 20 galerkin.yaml "${steps[@]}"; stages; verdict "stages, fixed: they end alike" $?
long && equal 'stages, events' 5 galerkin.yaml "${steps[@]}" --set 'solver={kind: static, stepping: event, max_events: 8, division: subdomains}' \
     --set failure.tensile_strength='6 MPa' && { stages; verdict "stages, events: they end alike" $?; }
finish

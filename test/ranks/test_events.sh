#!/bin/bash
# test_events.sh BUILD: event stepping of ranks that divide the body: the same bonds break in the same order, at the same loads, as in one process.
. "$(dirname "$0")/ranks.sh"

# equal NAME SCENE NUMBERS ARGUMENTS...
equal() {
    local name=$1 scene=$2 numbers=$3 r; shift 3
    alone "$scene" -o "$work/one" --force "$@"; verdict "$name: one process" $?
    [ "$(wc -l < "$work/one/events.csv")" -gt 20 ]; verdict "$name: something breaks" $?
    for r in $numbers; do
        rm -rf "$work/some"
        ranks "$r" "$scene" -o "$work/some" "$@" && alike 1e-8 "$work/one" "$work/some" events.csv
        verdict "$name: the same bonds at the same loads on $r ranks" $?
        # sums of forces that are zero but for rounding have no size of their own
        alike 1e-8 "$work/one" "$work/some" history.csv residual force_x displacement_x moment; verdict "$name: the same rows on $r ranks" $?
        python3 -S fields.py 1e-9 "$work/one/result.e" "$work/some/result.e" > "$work/why" 2>&1; verdict "$name: the same fields on $r ranks" $?
    done
}
events=(--set 'solver={kind: static, stepping: event, max_events: 16, division: subdomains}' --set output.at.levels=2)
all=4 some=3 halves=2
[ "$PERIGAL_TEST_SIZE" = long ] && all='1 2 3 4' some=$all halves='2 3'
equal "bond" rest.yaml "$all" "${events[@]}"
grep -q '"warnings"' "$work/some/report.json" && grep -q "no factor that serves many events" "$work/some/report.json"
verdict "what ranks do without is said" $?
grep -q '"preconditioners": [12],' "$work/some/report.json"; verdict "the preconditioner is kept from event to event" $?
# two cracks that mirror each other, one on either side of the boundary of the parts; their ends break together
equal "ties across the boundary" ties.yaml "$halves"
python3 - "$work/some/events.csv" > "$work/why" 2>&1 << 'PYTHON'
import csv, sys
rows = list(csv.DictReader(open(sys.argv[1])))
for step in {row['step [1]'] for row in rows}:
    place = sorted(float(row['x [m]']) for row in rows if row['step [1]'] == step)
    assert place[0] < 0 and all(abs(a + b) < 1e-12 for a, b in zip(place, reversed(place))), (step, place)
PYTHON
verdict "both ends break together" $?
[ "$PERIGAL_TEST_SIZE" != long ] || equal "lps" rest.yaml "$some" "${events[@]}" --set method.force=lps --set materials.steel.poissons_ratio=0.2
equal "gmpd" rest.yaml "$some" "${events[@]}" --set method.force=gmpd --set materials.steel.poissons_ratio=0.2 \
      --set 'failure={criterion: beam_limits, fracture_energy: 20 kJ/m2}'
equal "points that fail by their energy, and are alone then" rest.yaml "$some" "${events[@]}" --set 'failure={criterion: node_energy, fracture_energy: 20 kJ/m2}'
equal "the load held where growth goes on by itself" rest.yaml "$some" "${events[@]}" --set solver.on_instability=hold
equal "a constant load beside" rest.yaml "$some" "${events[@]}" --set 'boundary[1]={name: bottom, set: grip_bottom, displacement: {x: 0, y: 0}}' \
      --set 'boundary[2]={name: side, set: right, depth: 1 spacing, traction: {x: 40 MPa, y: 20 MPa}, ramp: constant}' --set failure.critical_stretch=0.01

finish

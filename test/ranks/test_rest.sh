#!/bin/bash
# test_rest.sh BUILD: equilibria of ranks that divide the body: fields of one process, the same bonds break at the same loads on any number of ranks.
. "$(dirname "$0")/ranks.sh"

# equal NAME SCENE NUMBERS ARGUMENTS...: on so many ranks the displacements of one process, events and rows to the tolerance of equilibria
equal() {
    local name=$1 scene=$2 numbers=$3 r; shift 3
    alone "$scene" -o "$work/one" --force "$@"; verdict "$name: one process" $?
    for r in $numbers; do
        rm -rf "$work/some"
        ranks "$r" "$scene" -o "$work/some" "$@"; verdict "$name: $r ranks" $?
        [ "$r" = 1 ] || grep -q '"division": "subdomains"' "$work/some/report.json"; verdict "$name: they divide the body" $?
        "$perigal" compare "$work/one" "$work/some" --json > "$work/norms" 2> "$work/why"
        python3 -c 'import json, sys; n = json.load(open(sys.argv[1]))["displacement_l2"]; print(n); sys.exit(not n["relative"] < 1e-9)' "$work/norms" > "$work/why" 2>&1
        verdict "$name: the same displacements on $r ranks" $?
        alike 1e-8 "$work/one" "$work/some" history.csv residual force_x force_z displacement_x displacement_z moment; verdict "$name: the same rows on $r ranks" $?
        alike 1e-7 "$work/one" "$work/some" events.csv; verdict "$name: the same bonds on $r ranks" $?
    done
}
equal "bond" rest.yaml "1 2 3 4"
[ "$(wc -l < "$work/one/events.csv")" -gt 20 ]; verdict "something breaks" $?
equal "by the diagonal" rest.yaml 3 --set solver.preconditioner=jacobi --set solver.steps=2
finish

#!/bin/bash
# test_lockstep.sh BUILD: equilibria on several ranks that share the factor of the matrix (PETSc, MUMPS): the same facets in the same order, at
# the same loads, on any number of ranks.
. "$(dirname "$0")/ranks.sh"

# grows NAME SCENE TABLE NUMBERS-OF-RANKS: cracks, what was measured at their ends, broken bonds, rows
grows() {
    local name=$1 scene=$2 table=$3 r; shift 3
    alone "$scene" -o "$work/one" --force --set solver.linear=cholmod; verdict "$name: one process" $?
    for r in "$@"; do
        rm -rf "$work/some"
        ranks "$r" "$scene" -o "$work/some" --set solver.linear=petsc; verdict "$name: $r ranks" $?
        grep -q '"linear_solver": "petsc"' "$work/some/report.json" && grep -q "\"ranks\": $r" "$work/some/report.json"
        verdict "$name: by the factor of $r ranks" $?
        alike 1e-7 "$work/one" "$work/some" cracks.csv; verdict "$name: the same facets in the same order on $r ranks" $?
        alike 1e-7 "$work/one" "$work/some" "$table"; verdict "$name: the same energy release rates on $r ranks" $?
        alike 1e-8 "$work/one" "$work/some" history.csv residual displacement_x displacement_y; verdict "$name: the same loads on $r ranks" $?
        alike 1e-8 "$work/one" "$work/some" events.csv; verdict "$name: the same bonds on $r ranks" $?
    done
}
on() { numbers=$1; [ "$PERIGAL_TEST_SIZE" = long ] && numbers='2 3 8'; }
on 3
grows "several cracks" facets.yaml tips.csv $numbers
left() { [ ! -e "$work/some/ranks" ] && [ ! -e "$work/some/checkpoint.nc" ] && [ -s "$work/some/result.e" ]; verdict "$1: the folder is that of one process" $?; }
left "several cracks"
on 2
grows "a closed crack with friction" contact.yaml tips.csv $numbers
# fronts on two ranks in short size: test_scenes.sh
[ "$PERIGAL_TEST_SIZE" != long ] || grows "in space" space.yaml fronts.csv $numbers

[ "$PERIGAL_TEST_SIZE" != long ] || { ranks 3 facets.yaml -o "$work/some" --force && left "in an older folder"; }
finish

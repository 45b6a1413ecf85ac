#!/bin/bash
# test_explicit.sh BUILD: explicit runs that ranks share by subdomains: the same bonds break in the same order on any number of ranks.
. "$(dirname "$0")/ranks.sh"

# equal NAME SCENE ARGUMENTS...: on $numbers ranks the same events (the energy of a step to rounding), rows to rounding, fields byte by byte
equal() {
    local name=$1 scene=$2 r; shift 2
    alone "$scene" -o "$work/one" --force "$@"; verdict "$name: one process" $?
    [ "$(wc -l < "$work/one/events.csv")" -gt 20 ]; verdict "$name: something breaks" $?
    for r in $numbers; do
        rm -rf "$work/some"
        ranks "$r" "$scene" -o "$work/some" "$@" && alike 1e-9 "$work/one" "$work/some" events.csv
        verdict "$name: the same bonds on $r ranks" $?
        alike 1e-9 "$work/one" "$work/some" history.csv; verdict "$name: the same rows on $r ranks" $?
        [ "$digits" = last ] && continue
        cmp "$work/one/result.e" "$work/some/result.e" > "$work/why" 2>&1; verdict "$name: the same fields on $r ranks" $?
    done
}
small=(--set spacing='1.25 mm' --set solver.dt='1.5e-7 s' --set solver.time_steps=120)
numbers=4
[ "$PERIGAL_TEST_SIZE" = long ] && numbers='1 2 3 4'
equal "bond, verlet" plate.yaml
[ "$PERIGAL_TEST_SIZE" = long ] || numbers=3
equal "bond, central, centres of cells" plate.yaml "${small[@]}" --set solver.kind=central --set lattice=cells
equal "lps" plate.yaml "${small[@]}" --set method.force=lps --set materials.steel.poissons_ratio=0.2
equal "gmpd" plate.yaml "${small[@]}" --set method.force=gmpd --set materials.steel.poissons_ratio=0.2 \
      --set 'failure={criterion: beam_limits, fracture_energy: 20 kJ/m2}'
# sums by lists go through the points in blocks that differ from part to part: the last digits of displacements do so too
digits=last
equal "plane strain, volumes of surfaces corrected" plate.yaml "${small[@]}" --set plane=strain --set method.surface_correction=volume

# the stable step is that of the body, not that of a part with ghosts whose families end
times() { awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == "time [s]") at = i } NR > 1 { printf "%.13e\n", $at }' "$1/history.csv"; }
alone round.yaml -o "$work/round"; verdict "a stable time step: one process" $?
for r in 3 $([ "$PERIGAL_TEST_SIZE" != long ] || echo 4); do
    rm -rf "$work/some"; ranks "$r" round.yaml -o "$work/some" && cmp <(times "$work/round") <(times "$work/some") > "$work/why" 2>&1
    verdict "the same stable time step on $r ranks" $?
done
ranks 2 plate.yaml -o "$work/no" --set contact.kind=normal; [ $? -eq 65 ] && grep -q "2 ranks: contact is for one process only" "$work/err"
verdict "what cannot be shared so far is refused, with the key" $?
finish

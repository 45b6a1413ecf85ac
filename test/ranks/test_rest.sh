#!/bin/bash
# test_rest.sh BUILD: equilibria of ranks that divide the body: fields of one process, the same bonds break at the same loads on any number of ranks.
. "$(dirname "$0")/ranks.sh"

# equal NAME SCENE NUMBERS ARGUMENTS...: on so many ranks the displacements of one process, events and rows to the tolerance of equilibria
equal() {
    local name=$1 scene=$2 numbers=$3 r; shift 3
    alone "$scene" -o "$work/one" --force "$@"; verdict "$name: one process" $?
    for r in $numbers; do
        # as coarse has made it, where that asked for the same run
        [ "$r" = "$made" ] || { rm -rf "$work/some"; ranks "$r" "$scene" -o "$work/some" "$@"; }; verdict "$name: $r ranks" $?
        [ "$r" = 1 ] || grep -q '"division": "subdomains"' "$work/some/report.json"; verdict "$name: they divide the body" $?
        "$perigal" compare "$work/one" "$work/some" --json > "$work/norms" 2> "$work/why"
        python3 -c 'import json, sys; n = json.load(open(sys.argv[1]))["displacement_l2"]; print(n); sys.exit(not n["relative"] < 1e-9)' "$work/norms" > "$work/why" 2>&1
        verdict "$name: the same displacements on $r ranks" $?
        alike 1e-8 "$work/one" "$work/some" history.csv residual force_x force_z displacement_x displacement_z moment; verdict "$name: the same rows on $r ranks" $?
        alike 1e-7 "$work/one" "$work/some" events.csv; verdict "$name: the same bonds on $r ranks" $?
    done
}
long() { [ "$PERIGAL_TEST_SIZE" = long ]; }
all='1 4' some=4 made=
long && all='1 2 3 4' some=$all
equal "bond" rest.yaml "$some"
[ "$(wc -l < "$work/one/events.csv")" -gt 20 ]; verdict "something breaks" $?

# coarse NAME SCENE NUMBERS PATTERN ARGUMENTS...: on any of these numbers of ranks the coarse grids have the same functions, and the same iterations do (one
# more or less by rounding; `most` where the grid of one process differs); the preconditioner is of the kind that the pattern says
coarse() {
    local name=$1 scene=$2 numbers=$3 pattern=$4 r; shift 4
    alone "$scene" -o "$work/one" --force --set solver.linear=pcg "$@"; verdict "$name: one process" $?
    rm -f "$work/kinds"
    for r in $numbers; do
        rm -rf "$work/some"
        ranks "$r" "$scene" -o "$work/some" "$@" && python3 - "$work/one" "$work/some" "$pattern" "$work/kinds" > "$work/why" 2>&1 << 'PYTHON'
import json, os, re, sys
one, some = (json.load(open(d + '/report.json')) for d in sys.argv[1:3])
kind = some['preconditioner']
print(kind, some['cg_iterations'], one['cg_iterations'])
assert re.search(sys.argv[3], kind), kind
assert some['cg_iterations'] <= 1.15 * one['cg_iterations'] + 1
kept = sys.argv[4]
first = open(kept).read() if os.path.exists(kept) else kind
open(kept, 'w').write(first)
levels = lambda text: re.findall('[0-9]+', text)[:3]
assert levels(kind) == levels(first), (kind, first)
PYTHON
        verdict "$name: coarse functions and iterations of $r ranks" $?
    done
}
# cracks that end in, cross and follow the borders of the parts (x = 0, y = 0), a comb whose teeth hang together in one part only, an island, supports
comb='cracks=[{from: [-26 mm, -5.1 mm], to: [5 mm, -5.1 mm]}, {from: [-26 mm, -1.1 mm], to: [7 mm, -1.1 mm]}, {from: [-26 mm, 2.9 mm], to: [9 mm, 2.9 mm]},
       {from: [0.1 mm, 8 mm], to: [0.1 mm, 18 mm]}, {from: [-9 mm, 9 mm], to: [3 mm, 17 mm]}, {from: [9 mm, -17 mm], to: [17 mm, -17 mm]},
       {from: [17 mm, -17 mm], to: [17 mm, -9 mm]}, {from: [17 mm, -9 mm], to: [9 mm, -9 mm]}, {from: [9 mm, -9 mm], to: [9 mm, -17 mm]}]'
one=(--set solver.steps=1 --set failure.critical_stretch=10)
coarse "a cracked plate" rest.yaml "$all" 'multilevel, .* on every rank' "${one[@]}" --set "$comb" --set spacing='1 mm'
long && coarse "a cracked plate, lps" rest.yaml "1 4" 'multilevel, .* on every rank' "${one[@]}" --set "$comb" --set spacing='1 mm' --set method.force=lps
coarse "coarse levels of PETSc" rest.yaml "4" 'multilevel, .* GAMG .PETSc.' "${one[@]}" --set "$comb" --set spacing='0.5 mm' --set method.horizon='2.015 spacing'
made=4
equal "coarse levels of PETSc" rest.yaml "4" "${one[@]}" --set "$comb" --set spacing='0.5 mm' --set method.horizon='2.015 spacing'
made=
equal "points off the lattice" rest.yaml "3" --set solver.steps=$(long && echo 2 || echo 1) --set perturb.amount=0.1
grep -q '"preconditioner": "GAMG (PETSc)' "$work/some/report.json"; verdict "have the preconditioner of PETSc" $?
# of tips every rank knows the whole, or none may be asked for
tips=(--set solver.steps=1 --set failure.critical_stretch=10 --set method.force=lps --set materials.steel.poissons_ratio=0.25 --set output.stress_intensity=yes)
rm -rf "$work/some"
alone rest.yaml -o "$work/one" --force "${tips[@]}" --set solver.division=auto && ranks 3 rest.yaml -o "$work/some" "${tips[@]}" --set solver.division=matrices \
    && grep -q 'tip.1.K_I ' "$work/some/history.csv" && alike 1e-8 "$work/one" "$work/some" history.csv residual; verdict "J and K of tips are the same on 3 ranks" $?
ranks 2 rest.yaml -o "$work/none" "${tips[@]}"
[ $? -eq 65 ] && grep -q output.stress_intensity "$work/err"; verdict "parts of a body have no J and K, and it is said" $?
long && equal "by the diagonal" rest.yaml 3 --set solver.preconditioner=jacobi --set solver.steps=2
finish

#!/bin/bash
# test_check.sh BUILD: `perigal check SCENE --ranks N` says what N ranks would do, without starting any: the parts that they then hold, their
# memory within a quarter, and refusals in the words of the run. With --accept as a second word it keeps the plans of plans/ as they are now.
. "$(dirname "$0")/../app/cli/expect.sh"
cd "$(dirname "$0")" || exit 1
mpi=$(dirname "$perigal")/perigal-mpi accept=$2
long() { [ "$PERIGAL_TEST_SIZE" = long ]; }

# plan NAME SCENE RANKS ARGUMENTS...: exactly the words of plans/NAME.txt
plan() {
    local name=$1 scene=$2 r=$3; shift 3
    "$perigal" check "$scene" --ranks "$r" "$@" > "$work/out" 2> "$work/err"; code=$?
    [ "$accept" = --accept ] && cp "$work/out" "plans/$name.txt"
    [ $code -eq 0 ] && diff "plans/$name.txt" "$work/out" > "$work/why"; verdict "$name: what $r ranks would do" $?
}
plan plate plate.yaml 3
plan rest rest.yaml 4
plan facets facets.yaml 2
plan space space.yaml 6 --set 'method={force: bond, horizon: 2.015 spacing}' --set 'failure={criterion: stretch, fracture_energy: 8 J/m2}' \
     --set materials.glass.poissons_ratio=0.25 --set materials.glass.density='2500 kg/m3' --set 'cracks=[]' --set spacing='0.5 mm' \
     --set 'solver={kind: verlet, end: 1 us}' --set 'boundary=[{name: head, set: front, displacement: {x: 0, y: 0, z: 5 um}}]'

# refused NAME CODE PATTERN SCENE RANKS ARGUMENTS...
refused() {
    local name=$1 code=$2 pattern=$3 scene=$4 r=$5; shift 5
    "$perigal" check "$scene" --ranks "$r" "$@" > "$work/out" 2> "$work/err"; k=$?
    [ $k -eq "$code" ] && [ ! -s "$work/out" ] && grep -q "$pattern" "$work/err"; verdict "$name" $?
}
touching=(--set contact.kind=normal --set output.at.rows=5)
# what a run on ranks warns of before its first step, whether or not they divide the body
told='warning: s acts at points 0.05 m inside the surface, 0.5 spacings: the body is about 5.6 % shorter'
inside=(../defects/small_hole.yaml --set method.essential=penalty)
"$perigal" check "${inside[@]}" --ranks 2 > "$work/out" 2> "$work/err" && grep -q "$told" "$work/out"; verdict "supports inside the surface are told" $?

refused "what is not divided so far: key and why" 65 'contact.kind = normal: 3 ranks: contact is for one process only so far' plate.yaml 3 "${touching[@]}"
sed 's/^failure/contact: {kind: normal}\n&/' plate.yaml > "$work/touching.yaml"
refused "file and line too" 65 '^[^ ]*touching.yaml:[0-9]*:[0-9]*: contact.kind = normal: 3 ranks: contact' "$work/touching.yaml" 3
refused "more ranks than the body has planes" 70 'too small to be divided among 3000 ranks: take fewer' plate.yaml 3000
refused "a rank without points" 70 'a rank would have no point: the body has 18, take fewer ranks than 8' islands.yaml 8
refused "faults of the scene itself" 65 'materials.steel.youngs_modulus' plate.yaml 2 --set materials.steel.youngs_modulus=-1
refused "no number of ranks" 64 'a number of processes' plate.yaml x
"$perigal" check islands.yaml --ranks 2 > "$work/out" 2> "$work/err"; verdict "two islands on two ranks" $?
# larger than any machine: counted part by part
"$perigal" check plate.yaml --ranks 4 --memory 30MB > "$work/out" 2> "$work/err" && grep -q 'too large to be built by this machine' "$work/out" && grep -q 'points of a rank    1054 to 1164' "$work/out"
verdict "a body that the machine cannot hold is divided all the same" $?

if [ ! -x "$mpi" ] || ! command -v mpirun > /dev/null; then finish; fi
. ./mpirun.sh
"$mpi" check plate.yaml --ranks 3 > "$work/out" 2> "$work/err" && diff plans/plate.txt "$work/out" > "$work/why"; verdict "perigal-mpi check says the same" $?

for division in $(long && echo matrices) subdomains; do
    ranks 3 "${inside[@]}" -o "$work/inside" --set body='[{add: {box: {low: [0, 0], high: [1, 1]}}}]' --set "solver={kind: static, division: $division}" && grep -q "$told" "$work/err"
    verdict "by the run too: $division" $?
    rm -rf "$work/inside"
done

# met NAME RANKS SCENE ARGUMENTS...: the parts of the report are those of the plan; peak memory of each rank within a quarter
met() {
    local name=$1 r=$2 scene=$3; shift 3
    rm -rf "$work/some"
    "$mpi" check "$scene" --ranks "$r" --json "$@" > "$work/plan" 2> "$work/err" && ranks "$r" "$scene" -o "$work/some" "$@"; verdict "$name: $r ranks run" $?
    python3 - "$work/plan" "$work/some/report.json" > "$work/why" 2>&1 <<'PYTHON'
import json, sys
plan, report = [json.load(open(path)) for path in sys.argv[1:]]
assert plan['ranks'] == report['ranks'] == len(plan['parts']) == len(report['parts']) and plan['division'] == report['division']
assert plan['points'] == report['points']
for p, r in zip(plan['parts'], report['parts']):
    assert all(p[key] == r[key] for key in ('owned', 'ghosts', 'neighbours', 'sent')), (p, r)
    share = p['peak_bytes'] / r['peak_bytes']
    print(f'{share:.2f}')
    assert 0.75 < share < 1.25, (p, r)
PYTHON
    verdict "$name: parts and memory as foreseen" $?
}
met "explicit" 3 plate.yaml --set spacing='0.4 mm' --set solver.dt='1e-8 s' --set solver.time_steps=10 --set output.at.rows=5
met "at rest" 3 rest.yaml --set spacing='0.5 mm' --set solver.steps=1 --set failure.critical_stretch=10
long && met "at rest, larger" 2 rest.yaml --set spacing='0.25 mm' --set solver.steps=1 --set failure.critical_stretch=10
long && met "at rest in space" 2 ../../bench/ranks/rest.yaml --set spacing='3 mm'
met "shape functions" 3 galerkin.yaml --set spacing='0.5 mm' --set solver.steps=1 --set failure.tensile_strength='8 GPa'
long && met "shape functions in space" 2 solid.yaml --set spacing='1.25 mm' --set solver.steps=1 --set failure.tensile_strength='1 GPa'
long && met "shape functions, perturbed" 2 galerkin.yaml --set spacing='0.5 mm' --set perturb.amount=0.25 --set solver.steps=1 --set failure.tensile_strength='8 GPa'
if long; then
    python3 meshed.py 100 > "$work/mesh.inp"
    sed '/^body:/,/^spacing/c mesh: {file: mesh.inp, unit: mm}' galerkin.yaml > "$work/mesh.yaml"
    met "shape functions on a mesh" 2 "$work/mesh.yaml" --set solver.steps=1 --set failure.tensile_strength='8 GPa' --set solver.preconditioner=multilevel
    met "shape functions on a mesh in space" 2 ../../data/bracket/scene.yaml --set solver.division=subdomains
fi
# eight small parts of many points, all of which each reads
python3 scattered.py 2 180 > "$work/cloud.csv"; cp cloud.yaml "$work/"
met "points of a file" 8 "$work/cloud.yaml" --set 'cracks=[]' --set solver.time_steps=1 --set solver.dt='1 ns' --set output.at.levels=1 --set 'output.gauges=[]' --set output.join=no
met "shared factor" 2 facets.yaml --set spacing='0.8 mm' --set solver.linear=petsc --set solver.max_events=1
"$perigal" check plate.yaml --ranks 3 "${touching[@]}" 2> "$work/words" > "$work/out"
ranks 3 plate.yaml -o "$work/no" "${touching[@]}"; [ $? -eq 65 ] && [ -s "$work/words" ] && [ "$(head -n "$(wc -l < "$work/words")" "$work/err")" = "$(cat "$work/words")" ]
verdict "refused in the words of the run" $?
finish

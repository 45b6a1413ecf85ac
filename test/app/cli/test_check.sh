#!/bin/bash
# test_check.sh BUILD [--accept]: perigal check: the plan of every shipped scene (plans/NAME.txt; without memory, whose bytes follow the
# code), the forecast against runs, refusals. After a deliberate change: test/app/cli/test_check.sh BUILD --accept, and read the differences.
. "$(dirname "$0")/expect.sh"; accept=$2
cd "$(dirname "$0")" || exit 1
long() { [ "$PERIGAL_TEST_SIZE" = long ]; }
number() { sed -n "s/^ *\"$1\": \([0-9.e+-]*\),*$/\1/p" "$2" | head -1; }
within() { awk -v a="$1" -v b="$2" -v t="$3" 'BEGIN { exit !(a > 0 && b > 0 && a <= b * (1 + t) && a >= b * (1 - t)) }'; }

# ---- plans of the shipped scenes ----------------------------------------------------------------------------------------
for scene in plate.yaml ../../../data/*/scene.yaml; do
    name=$(basename "${scene%/scene.yaml}" .yaml)
    [ -e "plans/$name.txt" ] || continue              # an empty one and --accept: a new plan
    # the largest bodies in long size alone
    case $name in cloud_shape|disk_uncracked|lame_sphere) long || [ "$accept" = --accept ] || continue ;; esac
    "$perigal" check "$scene" > "$work/all" 2> "$work/err"; code=$?
    grep -v -e '^  memory ' -e '^    ' -e ': the scene is valid$' "$work/all" > "$work/out"
    [ "$accept" = --accept ] && cp "$work/out" "plans/$name.txt"
    [ $code -eq 0 ] && diff "plans/$name.txt" "$work/out" > "$work/diff"; verdict "plan of $name" $?
    [ ! -s "$work/diff" ] || sed 's/^/# /' "$work/diff"
done

# ---- the forecast and the run --------------------------------------------------------------------------------------------
cat > "$work/solid.yaml" <<'EOF'
dimension: 3
body: [{add: {box: {low: [0, 0, 0], high: [1, 1, 1]}}}]
spacing: 0.1
materials: {rock: {youngs_modulus: 10 GPa, poissons_ratio: 0.25, density: 2500 kg/m3}}
failure: {criterion: principal_stress, tensile_strength: 1 MPa}
boundary:
  - {name: base, set: bottom, displacement: {x: 0, y: 0, z: 0}}
  - {name: lid, set: top, displacement: {y: 0.1 mm}}
solver: {max_events: 1}
output: {at: {levels: 1}, pictures: []}
EOF
compare() {   # name, tolerance, scene, settings...: bytes against the peak of the process, entries of the factor exactly
    local name=$1 tolerance=$2 scene=$3; shift 3
    "$perigal" check "$scene" --json "$@" > "$work/out" 2> "$work/err"
    "$perigal" run "$scene" --quiet --threads 1 -o "$work/run" "$@" > /dev/null 2>> "$work/err"
    within "$(number peak "$work/out")" "$(number peak_bytes "$work/run/report.json")" "$tolerance"; verdict "$name: memory as forecast" $?
    local told found
    told=$(number factor_entries "$work/out") found=$(number factor_entries "$work/run/report.json")
    [ "${told:-0}" = "$found" ]; verdict "$name: factor entries as forecast (${told:-0}, $found)" $?
}
asan=$(nm "$perigal" 2> /dev/null | grep -c __asan_init)
if [ "$asan" -eq 0 ]; then
    compare "plane"  0.3 ../../../data/cui_disk_plane/scene.yaml --set spacing='1.5 mm' --set solver.max_events=1
    long && compare "solid"  0.3 "$work/solid.yaml"
    # with a crack every point has a row of its own; where nothing breaks points share them
    disc='[{disc: {center: [0.52, 0.51, 0.53], normal: [0, 0, 1], radius: 0.2}}]'
    compare "no factor" 0.3 "$work/solid.yaml" --set solver.linear=pcg --set cracks="$disc"
    long && compare "no factor, shared rows" 0.3 "$work/solid.yaml" --set solver.linear=pcg --set failure='{criterion: none}' --set spacing=0.08
    bond=(--set method.force=bond --set failure='{criterion: stretch, critical_stretch: 1 %}' --set method.accept_inexact=yes --set spacing=0.045)
    moving=(--set solver='{kind: verlet, time_steps: 2, dt: 1 ns}')
    compare "bonds, no factor" 0.2 "$work/solid.yaml" "${bond[@]}" --set solver.linear=pcg
    long && compare "bonds that cannot break" 0.2 "$work/solid.yaml" "${bond[@]}" --set solver.linear=pcg --set failure='{criterion: none}'
    compare "bonds by stencil" 0.2 "$work/solid.yaml" "${bond[@]}" "${moving[@]}"
    long && compare "bonds by list" 0.2 "$work/solid.yaml" "${bond[@]}" "${moving[@]}" --set method.evaluation=list --set spacing=0.06
    compare "small time steps" 0.3 "$work/solid.yaml" --set solver='{kind: newmark, dt: 2 us, end: 4 us}' --set failure='{criterion: none}'
fi

# ---- the first break -----------------------------------------------------------------------------------------------------
"$perigal" run plate.yaml --quiet --threads 1 -o "$work/plate" --set solver.max_events=1 --set output.pictures='[]' > /dev/null 2>&1
factor=$(awk -F, 'NR == 2 { printf "%.5g", $2 }' "$work/plate/events.csv")
expect "--solve finds the first event of a run ($factor)" 0 "first break  *at load factor $factor, a .* bond in tension at" '' check plate.yaml --solve
# the top is moved by 10 um; only the faces of the crack go further
expect "--solve tells the largest displacement" 0 'largest displacement 1.0[5-8][0-9]*e-05 m' '' check plate.yaml --solve
"$perigal" check plate.yaml --solve --json --set 'boundary[0]={name: pull, set: top, displacement: {y: 10 um}, table: [[0, 0.5], [1, 1]]}' > "$work/out" 2> "$work/err"
python3 -c "import json, sys; b = json.load (open (sys.argv[1]))['first_break']; sys.exit (not abs (b['load_factor'] * b['utilisation'] - 1) < 1e-12 or abs (b['utilisation'] - 1) < 0.1)" "$work/out"
verdict "--solve under loads that are not proportional: the factor on the whole load" $?
expect "--solve warns where nothing breaks"  0 'warning: nothing breaks up to load factor 1: the first bond needs' '' check plate.yaml --solve --set failure.tensile_strength='30 GPa'
expect "--solve warns where nothing can"     0 'warning: no bond can break' '' check plate.yaml --solve --set failure.exclude='[all]'
expect "--solve without a criterion"         0 'there is no failure criterion' '' check plate.yaml --solve --set failure='{criterion: none}'
expect "--solve measures the time step"      0 'stable up to .*(2 / largest frequency)' '' check plate.yaml --solve --set materials.glass.density='2500 kg/m3'
expect "without --solve it is an estimate"   0 'stable up to .*(estimate' '' check plate.yaml --set materials.glass.density='2500 kg/m3'
expect "newmark: its steps"                  0 'time steps  *1000 of 1e-07 s, c_p dt / h = ' '' check plate.yaml \
    --set materials.glass.density='2500 kg/m3' --set solver='{kind: newmark, dt: 0.1 us, end: 0.1 ms}'
expect "newmark: what a small step skips"    0 'skipped  *stiffness matrix and factorization (small time step' '' check plate.yaml \
    --set materials.glass.density='2500 kg/m3' --set solver='{kind: newmark, dt: 0.1 us, end: 0.1 ms}'

# ---- plane waves ---------------------------------------------------------------------------------------------------------
nosb=(--set method='{accept_inexact: yes, approximation: nosb, integration: nodal, kernel: constant, horizon: 3.015 spacing, stabilization: none}')
expect "--spectrum: a stable lattice"        0 'verdict  *stable: every motion is resisted' '' check plate.yaml --spectrum
expect "nosb without stabilisation"          0 'verdict  *unstable: nothing resists 6 motions of .* (checkerboard); try method.stabilization: silling' '' check plate.yaml --spectrum "${nosb[@]}"
expect "-o writes table and picture"         0 'largest frequency  *[0-9.]* c_p / h, ' '' check plate.yaml --spectrum -o "$work/waves"
[ "$(head -1 "$work/waves/spectrum.csv" | tr , '\n' | wc -l)" -eq 8 ] && [ "$(wc -l < "$work/waves/spectrum.csv")" -eq 122 ] && [ -s "$work/waves/spectrum.png" ]
verdict "they hold two branches along three legs" $?
"$perigal" check plate.yaml --json --spectrum --solve --set materials.glass.density='2500 kg/m3' --set spacing='0.4 mm' > "$work/out" 2> "$work/err" \
    && python3 -m json.tool "$work/out" > /dev/null 2>> "$work/err" && within "$(number explicit_dt "$work/out")" "$(number stable_dt "$work/out")" 0.02
verdict "the time step of the infinite lattice is that of the plate ($(number stable_dt "$work/out"), $(number explicit_dt "$work/out") s)" $?
expect "a mesh has no plane waves"           64 '' '^perigal: the points of a mesh lie on no lattice' check ../../../data/kirsch_mesh/scene.yaml --spectrum
expect "--spectrum is for check"             64 '' 'unknown option --spectrum' run plate.yaml --spectrum

# ---- refusals ------------------------------------------------------------------------------------------------------------
expect "a run that does not fit is refused"  70 '' '^perigal: the run would need about .* of memory, and 1 MB are available' run plate.yaml --memory 1MB -o "$work/none"
[ ! -e "$work/none" ]; verdict "it leaves no folder" $?
expect "check refuses it too"                70 '' 'are available' check plate.yaml --memory 1MB
# what only the built problem knows: the bonds of a mesh
"$perigal" check ../../../data/plate_hole_mesh/scene.yaml --json > "$work/mesh.json" 2> "$work/err"
expect "a mesh that lacks a thirtieth of what it needs" 70 '' 'are available' check ../../../data/plate_hole_mesh/scene.yaml \
    --memory "$(awk -v b="$(number peak "$work/mesh.json")" 'BEGIN { printf "%.0fB", 0.97 * b }')"
expect "what fits is not refused"             0 'of 2.15 GB available' '' check plate.yaml --memory 2GiB
expect "--memory without a size"             64 '' '--memory lots: a size is needed' run plate.yaml --memory lots
expect "--memory 0"                          64 '' '--memory 0' run plate.yaml --memory 0
expect "--json is for check"                 64 '' 'unknown option --json' run plate.yaml --json
"$perigal" check plate.yaml --json > "$work/out" 2> "$work/err" && python3 -m json.tool "$work/out" > /dev/null 2>> "$work/err"; verdict "--json is JSON" $?
(ulimit -t $((asan ? 200 : 20)); exec "$perigal" run "$work/solid.yaml" --set spacing='1 mm' --memory 20GB -o "$work/none") > "$work/out" 2> "$work/err"
[ $? -eq 70 ] && [ ! -s "$work/out" ] && grep -q 'a spacing of .* m or more fits' "$work/err"; verdict "a huge body is refused before it is built (20 s of CPU time at the most)" $?
expect "more cells than numbers is a fault"  65 '' 'spacing = 1 nm: too fine for this body: 1e+27 cells' check "$work/solid.yaml" --set spacing='1 nm'
expect "faults come before sizes"            65 '' 'youngs_modulus' check "$work/solid.yaml" --memory 1MB --set materials.rock.youngs_modulus='-1 GPa'
finish

#!/bin/bash
# test_starts.sh BUILD: check refuses what a run refuses at its start, with the same code, file, line and words; what both warn of before the
# first step. (Every scene of wrong/: test_golden.sh; of the matrix of conditions: stress/test_matrix.sh.)
. "$(dirname "$0")/expect.sh"
cd "$(dirname "$0")/../../defects" || exit 1
# refused NAME PATTERN SCENE SETTINGS...: by both
refused() {
    local name=$1 words=$2 scene=$3 set=(); shift 3
    for s in "$@"; do set+=(--set "$s"); done
    expect "$name: refused by check" 65 '' "$words" check "$scene" "${set[@]}"; cp "$work/err" "$work/said"
    expect "$name: by run"           65 '*' "$words" run "$scene" -o "$work/result" "${set[@]}"
    cmp -s "$work/said" "$work/err" && [ ! -e "$work/result" ]; verdict "$name: in the same words, and nothing is written" $?
}
column='body=[{add: {box: {low: [0, 0], high: [1, 1]}}}]'
refused "faces too close for a gap" '^contact_of_close_faces.yaml:13:1: contact: within 2.5 spacings of (0.00444125, 0.00368469) m' contact_of_close_faces.yaml
refused "new cracks without a factor of K itself" '^contact_strength_elimination.yaml:12:1: method.essential: with contact.kind new cracks are' \
    contact_strength_elimination.yaml
refused "new cracks without a factor" '^--set solver.linear=pcg: solver.linear = pcg: with contact.kind new cracks' contact_strength_elimination.yaml \
    solver.linear=pcg method.essential=nitsche
refused "a platen in the body" '^--set platens=.*: platens\[0\]: the platen head overlaps the body by 0.5 m' nothing_holds.yaml \
    'platens=[{name: head, point: [0.5, 0.5], normal: [0, -1]}]' solver.stepping=fixed "$column"

# ---- warnings before the first step --------------------------------------------------------------------------------------
# warned NAME PATTERN SCENE SETTINGS...: by check, and by run above its first step
warned() {
    local name=$1 words=$2 scene=$3 set=(); shift 3
    for s in "$@"; do set+=(--set "$s"); done
    expect "$name: check warns" 0 "warning: $words" '' check "$scene" "${set[@]}"
    "$perigal" run "$scene" -o "$work/result" --force "${set[@]}" > "$work/out" 2> "$work/err"
    awk '/ time steps in |break rounds/ { exit } 1' "$work/out" | grep -q "warning: $words"; verdict "$name: run warns before its first step" $?
}
# silent NAME PATTERN SCENE SETTINGS...
silent() {
    local name=$1 words=$2 scene=$3 set=(); shift 3
    for s in "$@"; do set+=(--set "$s"); done
    "$perigal" check "$scene" "${set[@]}" > "$work/out" 2> "$work/err" && ! grep -q "warning: $words" "$work/out"; verdict "$name: no word of it" $?
}
tears='top pulls with 1.2e+07 Pa at points that bear about [3-6]'
warned "loaded rows that tear off" "$tears" glass_rows.yaml
[ "$(wc -l < "$work/result/events.csv")" -gt 100 ]; verdict "they do" $?
pull() { echo "boundary=[{set: top, traction: {y: $1 MPa}, ramp: constant}, {set: bottom, traction: {y: -$1 MPa}, ramp: constant}]"; }
silent "a load that they bear" 'top pulls' glass_rows.yaml "$(pull 2)"
silent "a load that presses" 'top pulls' glass_rows.yaml "$(pull -12)"
silent "rows that never break" 'top pulls' glass_rows.yaml 'failure.exclude=[top, bottom]'
template=../../data/new/beam/scene.yaml
silent "rollers of the template" '.*as a clamp does' $template
wide='sets={load: {boundary: top, where: "abs(x) <= 5 mm"}, left_support: {boundary: bottom, where: "abs(x + 100 mm) <= 5 mm"}, right_support: {boundary: bottom, where: "abs(x - 100 mm) <= 5 mm"}}'
long() { [ "$PERIGAL_TEST_SIZE" = long ]; }
for load in load $(long && echo left right); do
    expect "$load, wide: told to be a clamp" 0 "warning: $load: displacements along y of points up to 0.008 m apart along x keep the surface there from turning" '' check $template --set "$wide"
done
long && silent "a bolt hole that holds the body alone has to be a clamp" '.*as a clamp does' ../../data/bracket/scene.yaml
silent "platens that face each other" '.*as a clamp does' ../../data/disk_crack/scene.yaml spacing='2.5 mm'
inside='s acts at points 0.05 m inside the surface, 0.5 spacings: the body is about 5.6 % shorter'
for how in transformation penalty; do
    warned "supports on centres of cells, $how" "$inside" small_hole.yaml method.essential=$how
done
silent "supports on the surface" '.*inside the surface' small_hole.yaml method.essential=nitsche
silent "supports on nodes" '.*inside the surface' small_hole.yaml method.essential=transformation lattice=nodes
warned "a hole smaller than a spacing" 'body.1.: a hole of 0.04 m is smaller than the spacing there, 0.1 m' small_hole.yaml
warned "a wall thinner than a spacing" "body.1.: the wall beside this hole at .* m is 0.05 m thick, 0.5 of the spacing there" small_hole.yaml "body=[{add: {box: {low: [0, 0], high: [1, 0.5]}}}, {subtract: {disk: {center: [0.5, 0.2], radius: 0.15}}}]"
silent "a hole that opens into the side, beside a wall of a spacing" ".*the wall beside" small_hole.yaml "body=[{add: {box: {low: [0, 0], high: [1, 0.5]}}}, {subtract: {disk: {center: [0.5, 0.15], radius: 0.25}}}]"
cat > "$work/held.yaml" << 'S'
dimension: 3
body: [{add: {cylinder: {center: [0.134, -0.145, 0.059], radius: 0.5, length: 0.73}}}]
spacing: 0.1264
lattice: nodes
materials: {m: {youngs_modulus: 1 GPa, poissons_ratio: 0.25, density: 2500}}
method: {force: gmpd, accept_inexact: true}
sets: {foot: {where: x < -0.21}}
boundary: [{name: foot, set: foot, displacement: {x: 0, y: 0, z: 0}}]
solver: {kind: newmark, dt: 0.1 ms, time_steps: 1}
S
silent "rotations that nothing resists, which are held" ".*next to nothing resists some motion" "$work/held.yaml"
silent "an evaluation point between the arms of a kink, which a wider support serves" 'sees* too little' kinked_wedge.yaml
warned "an evaluation point that cracks enclose" '1 evaluation point beside cracks, such as that at (0.376268, 0.273532) m, sees too little for a strain' kinked_wedge.yaml 'cracks=[{polyline: [[0.355, 0.26], [0.41, 0.26], [0.376, 0.29], [0.355, 0.26]]}]'
warned "facets that have nowhere to begin" 'no crack can grow: there is no crack, and no strength' small_hole.yaml 'failure={criterion: energy_release, fracture_energy: 10 J/m2}'
silent "facets that begin at a strength" 'no crack can grow' small_hole.yaml 'failure={criterion: energy_release, fracture_energy: 10 J/m2, tensile_strength: 5 MPa}'
silent "a hole that is seen" '.*a hole of' small_hole.yaml 'spacing=0.035'

# ---- families that turn ------------------------------------------------------------------------------------------------
turns='warning: families of points turn: 0.1 rad from 2.[0-9]*e-05 s on, [01][0-9.]* rad at most'
expect "linear stretches of a body that turns: told"  0 "$turns" '*' run spin.yaml -o "$work/spin"
sed '/^initial/d' spin.yaml > "$work/rest.yaml"; turned='displacement: {x: "-0.3*y", y: "0.3*x"}'
expect "at rest and by shape functions too" 0 'points turn: 0.1 rad from 0.35 of the load on, 0.29 rad at most' '*' run "$work/rest.yaml" -o "$work/spin2" \
    --set 'method={approximation: rkpm, integration: nodal}' --set 'failure={criterion: none}' --set 'solver={kind: static}' --set "boundary=[{set: left, $turned}, {set: right, $turned}]"
"$perigal" run spin.yaml -o "$work/spin3" --set method.stretch=finite > "$work/out" 2>&1; ! grep -q 'points turn' "$work/out"; verdict "not of finite stretches" $?

# ---- scenes that would have no answer: refused in a second or two, by check and by run ----------------------------------------
plate='dimension: 2\nbody: [{add: {box: {low: [0, 0], high: [1, 1]}}}]\nspacing: 0.1\nmaterials: {a: {youngs_modulus: 1 GPa, poissons_ratio: 0.2}}\nboundary: [{set: left, displacement: {x: 0, y: 0}}]\n'
# answered NAME PATTERN FILE SETTINGS...
answered() {
    local name=$1 words=$2 file=$3 set=(); shift 3
    for s in "$@"; do set+=(--set "$s"); done
    for verb in check run; do
        ( ulimit -t 6; exec "$perigal" $verb "$file" "${set[@]}" $([ $verb = run ] && echo -o "$work/none") > "$work/out" 2> "$work/err" )
        [ $? -eq 65 ] && grep -q -- "$words" "$work/err" && [ "$(wc -c < "$work/err")" -lt 20000 ]; verdict "$verb: $name" $?
    done
}
printf "$plate" > "$work/plate.yaml"
{ printf "$plate"; seq -f 'key%.0f: 1' 100000; } > "$work/keys.yaml"
answered "100000 unknown keys" 'keys.yaml:16:1: 99990 more of the 100005 keys here are unknown' "$work/keys.yaml"
grep -q 'keys.yaml:15:1: key10 = 1: unknown key' "$work/err"; verdict "the first ten are named" $?
{ printf "$plate"; echo sets:; seq -f '  s%.0f: {where: "x < 1"}' 5000; } > "$work/sets.yaml"
answered "5000 sets" 'sets: has 5000 entries; their number must lie in .0, 1000.' "$work/sets.yaml"
{ printf "$plate"; echo cracks:; awk 'BEGIN { for (k = 1; k <= 11000; k++) print "  - {from: [0.1, 0." k "], to: [0.2, 0." k "]}" }'; } > "$work/cracks.yaml"
answered "11000 cracks" 'cracks: has 11000 entries; their number must lie in .0, 10000.' "$work/cracks.yaml"
answered "a million random cracks" 'random.count = 1000000: must lie in .1, 20000.' "$work/plate.yaml" 'cracks=[{random: {count: 1000000, length: 0.1}}]'
for more in 'count: 15000' 'intensity: 1500'; do
    answered "two networks that are too much together, the second by ${more%%:*}" "cracks.1..random.${more%%:*} = 15000*: .*at most 20000 .*drawn in all networks together, 6000 of them in those above: must lie in .[01], 1[0-9.e+]*" "$work/plate.yaml" \
        "cracks=[{random: {count: 6000, length: 0.1, inside: middle}}, {random: {$more, length: 0.1, inside: middle}}]"
done
answered "an absurd intensity" 'random.intensity = 1e12: takes about 1e+13 cracks .*(0, 2e+03. 1/m' "$work/plate.yaml" 'cracks=[{random: {intensity: 1e12, length: 0.1}}]'
answered "a fraction of slots of no width" 'random.fraction = 0.9: takes about 9e+09 cracks' "$work/plate.yaml" 'cracks=[{random: {fraction: 0.9, length: 0.1}, width: 1e-9}]'
answered "cracks that find no place" 'only [0-9]* of 1000 cracks found a place' "$work/plate.yaml" 'cracks=[{random: {count: 1000, length: 0.9, distance: 0.2}}]'
answered "a spacing of 1e-9" 'spacing = 1e-9: too fine' "$work/plate.yaml" spacing=1e-9
# the last of many names is known as well
{ printf "$plate" | sed 's/materials: {/&'"$(seq -s ' ' -f 'a_material_of_a_long_name_%.0f: {youngs_modulus: 1 GPa, poissons_ratio: 0.2},' 300)"'/'; echo 'blocks: [{material: a, where: "x < 2"}]'; } > "$work/names.yaml"
"$perigal" check "$work/names.yaml" > "$work/out" 2> "$work/err"; grep -q 'long_name_1: is used by no block' "$work/err" && ! grep -q 'no material of this name' "$work/err"
verdict "the last of 301 materials is known" $?

# ---- units of temperature, a stiffness without one ----------------------------------------------------------------------
for unit in '10 K' '10 degC' '10 C' '10 °C' '"10 degC * x / (1 m)"'; do
    expect "temperature: $unit" 0 '*' '' check "$work/plate.yaml" --set 'method.integration=gauss' --set 'solver.stepping=fixed' \
        --set "boundary=[{set: left, displacement: {x: 0, y: 0}}, {temperature: $unit}]" --set 'materials={a: {youngs_modulus: 1 GPa, poissons_ratio: 0.2, expansion: 1e-5 1/degC}}'
done
for unit in 1/K /K 1/C 1/degC um/m/C 'K-1' '/°C'; do
    "$perigal" check "$work/plate.yaml" --set "materials={a: {youngs_modulus: 1 GPa, poissons_ratio: 0.2, expansion: 1e-5 $unit}}" > "$work/out" 2> "$work/err"; verdict "expansion: 1e-5 $unit" $?
done
expect "a temperature in coulomb is none, a pressure per kelvin no pressure" 65 '' "the result is in m^-1 kg s^-2 K^-1, expected Pa" check "$work/plate.yaml" --set 'materials.a.youngs_modulus=1 Pa/C'
expect "a stiffness without a unit beside lengths with one: told" 0 'warning: line 0*[0-9]*: materials.a.youngs_modulus = 210000 has no unit' '' check "$work/plate.yaml" --set 'materials.a.youngs_modulus=210000' --set 'spacing=100 mm'
silent "a scene without any unit" '.*has no unit' "$work/plate.yaml" 'materials.a.youngs_modulus=210000'

# ---- interfaces of materials, spacings of graded points -----------------------------------------------------------------------
two='materials={a: {youngs_modulus: 1 GPa, poissons_ratio: 0.2}, b: {youngs_modulus: 2 GPa, poissons_ratio: 0.2}}'
"$perigal" check "$work/plate.yaml" --set "$two" --set 'blocks=[{material: a, where: "x < 2"}, {material: b, where: "x < 0.5"}]' > "$work/out" 2> "$work/err"
grep -q 'at interfaces of materials the error falls with the first power of the spacing' "$work/out"; verdict "two materials: the order at interfaces is told" $?
"$perigal" check "$work/plate.yaml" --set "$two" --set 'blocks=[{material: a, where: "x < 2"}]' > "$work/out" 2> "$work/err"
! grep -q 'at interfaces' "$work/out"; verdict "not where one of them is used" $?

# ---- a penalty that no iteration can follow: the hint names it and a key that there is, not a loose part --------------------------
cat > "$work/penalty.yaml" <<'S'
dimension: 3
body: [{add: {box: {low: [0, 0, 0], high: [1, 1, 1]}}}]
spacing: 0.25
materials: {a: {youngs_modulus: 1 GPa, poissons_ratio: 0.2}}
method: {essential: penalty, penalty_factor: 1e11}
boundary: [{set: left, displacement: {x: 0, y: 0, z: 0}}, {set: right, displacement: {x: 1 mm}}]
solver: {kind: static, linear: pcg}
S
expect "a stiff penalty under pcg in space" 70 '*' 'supports hold every part of the body; the penalty of left, 1e+11 E / spacing.* or a smaller method.penalty_factor' run "$work/penalty.yaml" -o "$work/stiff"
! grep -q loose "$work/err"; verdict "no word of a loose part" $?

# ---- a full device: no command says that all went well when nobody could read it --------------------------------------
full() {
    "$@" > /dev/full 2> "$work/err"; [ $? -eq 70 ] && grep -q 'the output cannot be written: No space left on device' "$work/err"
    verdict "${*:2}, to a full device" $?
}
"$perigal" run small_hole.yaml -o "$work/result" --quiet > "$work/out" 2>&1
for words in --version --help "check small_hole.yaml" "check small_hole.yaml --json" list "help horizon" "help --manual" "run small_hole.yaml --force -o $work/full" \
             "plot $work/result" "cracks contact_strength_elimination.yaml -o $work/cracks.png" "compare $work/result $work/result" "new plate -o $work/new.yaml" \
             "sweep small_hole.yaml --set solver.tolerance=1e-9,1e-10 -o $work/sweep" "converge small_hole.yaml --spacing 2 --ratio 1.2 -o $work/converge" \
             "bench small_hole.yaml --spacing 1 -o $work/bench" "run --help" "plot --help"; do
    full "$perigal" $words
done
mesh=$(dirname "$perigal")/perigal-mesh
[ ! -x "$mesh" ] || full "$mesh" --help
mpi=$(dirname "$perigal")/perigal-mpi
[ ! -x "$mpi" ] || full "$mpi" check small_hole.yaml --ranks 2

# ---- long paths: whole, or refused ---------------------------------------------------------------------------------------
part=$(printf 'x%.0s' $(seq 200)); long=$work/long
for k in $(seq 14); do long=$long/$part; done
expect "results under a path of ${#long} bytes" 0 '*' '*' run small_hole.yaml -o "$long" --quiet && [ -s "$long/report.json" ]; verdict "they are there" $?
expect "again, by --force" 0 '*' '*' run small_hole.yaml -o "$long" --quiet --force
expect "a path of 3300 bytes is refused" 70 '*' 'has a path of 3[0-9]* bytes, more than the 3000' run small_hole.yaml -o "$long/$part/$part" --quiet
[ ! -e "$long/$part" ]; verdict "nothing of it is made" $?

# ---- files that are no such table: nothing of them is shown --------------------------------------------------------------
printf 'SECRET:x:0:0:root\nSECRET2 3\n' > "$work/other.csv"
for key in points 'cracks=[{file' 'mesh={file' 'reference={file'; do
    case $key in *=*) set="$key: $work/other.csv}";; *) set="$key=$work/other.csv";; esac
    case $key in cracks*) set="$set]";; esac
    "$perigal" check small_hole.yaml --set "$set" > "$work/out" 2> "$work/err"; [ $? -eq 65 ] && ! grep -q SECRET "$work/err"; verdict "a foreign file as ${key%%=*}: nothing of it" $?
done
finish

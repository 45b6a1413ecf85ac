#!/bin/bash
# test_signals.sh BUILD: signals at chosen calls of a run (test/kills/signal_at.c). TERM at any moment ends in a checkpoint or in words, KILL while a
# run finishes can be gone on with: then the files are those of a run that nobody disturbed.
. "$(dirname "$0")/expect.sh"
cd "$(dirname "$0")" || exit 1
case $1 in *asan*|*tsan*) echo "ok 1 - # SKIP a sanitizer wants to be loaded first"; echo 1..1; exit 0 ;; esac
${CC:-gcc} -shared -fPIC -o "$work/at.so" ../../kills/signal_at.c -ldl > "$work/out" 2> "$work/err" || { verdict "signal_at.c" 1; finish; }

cat > "$work/facets.yaml" <<'S'
dimension: 2
body: [{add: {box: {low: [0 mm, 0 mm], high: [20 mm, 20 mm]}}}]
spacing: 2 mm
cracks: [{from: [-1 mm, 10 mm], to: [8 mm, 10 mm]}]
materials: {rock: {youngs_modulus: 10 GPa, poissons_ratio: 0.2}}
failure: {criterion: energy_release, fracture_energy: 20 J/m2}
boundary: [{name: lo, set: bottom, displacement: {y: 0, x: 0}}, {name: hi, set: top, displacement: {y: 0.02 mm}}]
solver: {stepping: event, max_events: 3}
output: {at: {levels: 4}, pictures: [damage], checkpoint: 1 us}
S
cat > "$work/closed.yaml" <<'S'
dimension: 2
body: [{add: {box: {low: [0 mm, 0 mm], high: [20 mm, 20 mm]}}}]
spacing: 2 mm
cracks: [{from: [4 mm, 9 mm], to: [14 mm, 12 mm]}]
materials: {rock: {youngs_modulus: 10 GPa, poissons_ratio: 0.2, density: 2500 kg/m3}}
failure: {criterion: stretch, critical_stretch: 5e-2}
contact: {kind: friction, coefficient: 0.1}
boundary: [{name: lo, set: bottom, displacement: {x: 0, y: 0}}, {name: hi, set: top, traction: {y: -5 MPa}}]
solver: {kind: newmark, dt: 0.2 us, time_steps: 3}
output: {pictures: [], checkpoint: 1 us}
S
cat > "$work/block.yaml" <<'S'
dimension: 3
body: [{add: {box: {low: [0, 0, 0], high: [11, 11, 11]}}}]
spacing: 1
materials: {rock: {youngs_modulus: 1 GPa, poissons_ratio: 0.25}}
method: {force: bond, horizon: 1.5 spacing}
failure: {criterion: stretch, critical_stretch: 1}
boundary: [{set: back, displacement: {x: 0, y: 0, z: 0}}, {set: front, displacement: {z: 1 mm}}]
solver: {stepping: fixed, steps: 2, linear: cholmod}
output: {pictures: []}
S
# run SIGNAL CALL AT SCENE ARGUMENTS...: code, and the number of such calls in $calls
run() {
    local number=$1 call=$2 at=$3 scene=$4; shift 4
    { SIGNAL=$number CALL=$call AT=$at COUNTED=$work/calls LD_PRELOAD=$work/at.so \
        "$perigal" run "$work/$scene.yaml" --quiet --threads 1 "$@" > "$work/out" 2> "$work/err"; code=$?; } 2> /dev/null
    [ $code -gt 130 ] || calls=$(cat "$work/calls")
}
# as_if_undisturbed SCENE DIR: goes on, or begins anew where nothing had been computed yet
as_if_undisturbed() {
    local f
    if [ -e "$2/checkpoint.nc" ] || grep -q '"outcome": "done"' "$2/report.json" 2> /dev/null
    then run 0 none 0 "$1" -o "$2" --resume; else run 0 none 0 "$1" -o "$2"; fi
    [ $code -eq 0 ] || return 1
    for f in history.csv events.csv result.e cracks.csv tips.csv contact.csv; do
        [ ! -e "$work/$1/$f" ] || cmp "$work/$1/$f" "$2/$f" > "$work/why" || return 1
    done
    [ ! -e "$2/checkpoint.nc" ] && [ ! -e "$2/checkpoint.nc.new" ] && [ ! -e "$2/result.e.new" ]
}
for scene in facets closed; do
    run 0 none 0 $scene -o "$work/$scene"; verdict "$scene: a run that nobody disturbs" $code
done

# ---- TERM: at moments all over the run, the first of them before anything is solved
for scene in facets closed; do
    run 0 clock_gettime 0 $scene -o "$work/counted"; all=$calls bad_at=
    for k in 4 $((all / 8)) $((all / 3)) $((all * 2 / 3)) $((all * 9 / 10)); do
        rm -rf "$work/half"
        run 15 clock_gettime "$k" $scene -o "$work/half"
        { [ $code -eq 0 ] || { [ $code -eq 130 ] && grep -q 'continue with\|the same command begins anew' "$work/err"; }; } \
            && as_if_undisturbed $scene "$work/half" || bad_at="$bad_at $k"
    done
    echo "at $bad_at of $all" > "$work/why"
    [ -z "$bad_at" ]; verdict "$scene: TERM at any moment, a checkpoint or a word, and on to the same files" $?
done
run 15 signal 1 block -o "$work/block"
[ $code -eq 130 ] && grep -q 'continue with' "$work/err" && [ -e "$work/block/checkpoint.nc" ] && [ "$calls" -gt 0 ]
verdict "TERM while METIS orders the nodes and takes it for a failure of its own: a checkpoint" $?

rm -rf "$work/half"; run 15 clock_gettime 3 facets -o "$work/half"
[ $code -eq 130 ] && grep -q 'before its first step: the same command begins anew' "$work/err" && [ ! -e "$work/half" ]
verdict "TERM while the run is prepared: the end at once, without a folder" $?

# ---- TERM twice: what comes at once is one request, as of timeout, which sends its signal to process and group
rm -rf "$work/half"; run 15 twice 1 facets -o "$work/half"
[ $code -eq 130 ] && grep -q 'continue with\|the same command begins anew' "$work/err" && as_if_undisturbed facets "$work/half"
verdict "TERM twice within a millisecond: a checkpoint or a word, and on to the same files" $?
rm -rf "$work/half"; run 15 late 1 facets -o "$work/half"
[ $code -eq 143 ]; verdict "TERM again after more than half a second: the end at once" $?

# ---- KILL: at the last calls that change what the folder holds
for call in rename remove; do
    run 0 $call 0 facets -o "$work/counted" --force; all=$calls bad_at= killed=0
    for k in $((all - 3)) $((all - 2)) $((all - 1)) $all; do
        [ "$k" -gt 0 ] || continue
        rm -rf "$work/half"
        run 9 $call "$k" facets -o "$work/half"
        # a run that is slower writes fewer checkpoints: it may end before such a call comes
        [ $code -eq 0 ] && [ "$calls" -lt "$k" ] && continue
        killed=$((killed + 1))
        [ $code -eq 137 ] && as_if_undisturbed facets "$work/half" || bad_at="$bad_at $k"
    done
    echo "at $bad_at of $all, killed $killed times" > "$work/why"
    [ -z "$bad_at" ] && [ $killed -gt 0 ]; verdict "KILL at the last calls of $call: on to the same files" $?
done
finish

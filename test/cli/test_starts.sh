#!/bin/bash
# test_starts.sh BUILD: check refuses what a run refuses at its start, with the same code, file, line and words; what both warn of before the
# first step. (Every scene of wrong/: test_golden.sh; of the matrix of conditions: stress/test_matrix.sh.)
. "$(dirname "$0")/expect.sh"
cd "$(dirname "$0")/../defects" || exit 1
# refused NAME PATTERN SCENE SETTINGS...: by both
refused() {
    local name=$1 words=$2 scene=$3 set=(); shift 3
    for s in "$@"; do set+=(--set "$s"); done
    expect "$name: refused by check" 65 '' "$words" check "$scene" "${set[@]}"; cp "$work/err" "$work/said"
    expect "$name: by run"           65 '*' "$words" run "$scene" -o "$work/result" "${set[@]}"
    cmp -s "$work/said" "$work/err" && [ ! -e "$work/result" ]; verdict "$name: in the same words, and nothing is written" $?
}
column='body=[{add: {box: {low: [0, 0], high: [1, 1]}}}]'
refused "faces too close for a gap" '^contact_of_close_faces.yaml:13:1: contact: within 2.5 spacings of (0.00376988, 0.00492108) m' contact_of_close_faces.yaml
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
finish

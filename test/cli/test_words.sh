#!/bin/bash
# test_words.sh BUILD: what a user reads is true and leads on: warnings, progress, faults that come together, hints.
. "$(dirname "$0")/expect.sh"
cd "$(dirname "$0")" || exit 1
once=(--threads 1 --set solver.max_events=1 --set output.pictures='[]')
# holds NAME FILE PATTERN: is the pattern there?
holds() { local good=1; grep -q -- "$3" "$2" && good=0; verdict "$1" $good; [ $good -eq 0 ] || sed 's/^/# /' "$2" | head -30; }

# ---- warnings are of the run, not of the screen -----------------------------------------------------------------------------
loose=(--set 'boundary[1].displacement={y: 0}' --set 'method={force: bond}' --set 'failure={criterion: stretch, critical_stretch: 1e-3}')
loose+=(--set 'boundary[0].essential=penalty' --set spacing='0.5 mm')
expect "a quiet run prints nothing"             0 '' '' run plate.yaml --quiet -o "$work/loose" "${once[@]}" "${loose[@]}"
holds "report.json: nothing holds the body"     "$work/loose/report.json" '"nothing holds the body along x: '
holds "report.json: another Poisson's ratio"    "$work/loose/report.json" "^ *\"material glass: Poisson's ratio is 0.3333, not 0.22"
holds "report.json: keys without meaning"       "$work/loose/report.json" '"without meaning for force: bond: boundary\[0\].essential'
python3 -c "import json, sys; w = json.load (open (sys.argv[1]))['warnings']; sys.exit (len (w) < 3 or len (set (w)) != len (w))" "$work/loose/report.json"
verdict "each of them once" $?
"$perigal" check plate.yaml --json "${loose[@]}" > "$work/out" 2> "$work/err"
python3 -c "import json, sys; r = json.load (open (sys.argv[1])); sys.exit (len (r['warnings']) != 2 or len (r['notes']) < 1)" "$work/out"
verdict "check --json has them too" $?
"$perigal" run plate.yaml -o "$work/loud" "${once[@]}" "${loose[@]}" > "$work/out" 2> "$work/err"
[ "$(grep -c 'warning: nothing holds the body along x' "$work/out")" -eq 1 ]; verdict "on the screen each comes once" $?
finish

#!/bin/bash
# test_sweep.sh BUILD: perigal sweep: all combinations, ranges, --zip, the table, the picture, a sweep of 12 runs that is interrupted and goes on to
# what the uninterrupted one gives, failures that do not end it, and what is refused and how.
. "$(dirname "$0")/expect.sh"
cd "$(dirname "$0")/../../.." || exit 1
picture() { [ -s "$1" ] && [ "$(head -c 8 "$1" | od -An -tx1 | tr -d ' \n')" = 89504e470d0a1a0a ] && [ "$(stat -c %s "$1")" -gt 5000 ]; }
cell() { # FILE ROW COLUMN: of a table without quotes, the column by its heading
    awk -F, -v r="$2" -v c="$3" 'NR == 1 { for (k = 1; k <= NF; k++) if ($k == c) at = k } NR == r + 1 { print at ? $at : "no column " c }' "$1"; }
same() { awk -v a="$1" -v b="$2" 'BEGIN { exit !(a == b && a != "") }'; }
scene=$work/bar.yaml
cat > "$scene" <<'END'
title: Plate that is torn
dimension: 2
plane: stress
thickness: 1 mm
body:
  - add: {box: {low: [-10 mm, -10 mm], high: [10 mm, 10 mm]}}
spacing: 1 mm
lattice: cells
cracks: [{from: [-4 mm, 0], to: [4 mm, 0]}]
materials:
  steel: {youngs_modulus: 192 GPa, poissons_ratio: 0.333333333333, density: 8000 kg/m3}
failure: {criterion: stretch, critical_stretch: 0.002, exclude: [top, bottom]}
method: {force: bond, kernel: constant, horizon: 3.015 spacing}
boundary:
  - {name: top, set: top, velocity: {y: 5 m/s}}
  - {name: bottom, set: bottom, velocity: {y: -5 m/s}}
solver: {kind: verlet, dt: 1e-7 s, time_steps: 60}
output: {at: {levels: 1}, pictures: [], gauges: [{name: opening, from: [0, -2 mm], to: [0, 2 mm]}]}
END

# ---- twelve runs, a third of them long enough to be caught in the middle
twelve=(--set failure.critical_stretch=0.0015,0.002,0.0025 --set solver.time_steps=40,60,20000,80 --threads 1)
expect "twelve runs" 0 '12 of 12 runs are done' '' sweep "$scene" "${twelve[@]}" -o "$work/a" -j 2
a=$work/a/sweep.csv
[ "$(wc -l < "$a")" -eq 13 ] && [ "$(grep -c ',done,' "$a")" -eq 12 ]; verdict "a row for each" $?
picture "$work/a/sweep.png"; verdict "the picture" $?
[ "$(find "$work/a" -name report.json | wc -l)" -eq 12 ] && [ -s "$work/a/critical_stretch=0.002_time_steps=60/report.json" ]; verdict "folders with readable names" $?
! find "$work/a" -name '*.log' -o -name '*.check' -o -name '*.new' | grep -q .; verdict "nothing is left beside them" $?
"$perigal" run "$scene" --set failure.critical_stretch=0.002 --set solver.time_steps=60 -o "$work/one" --threads 1 -q
cmp "$work/one/history.csv" "$work/a/critical_stretch=0.002_time_steps=60/history.csv" > "$work/why" 2>&1; verdict "a run of a sweep is the run of its values" $?
one=$work/one/history.csv
same "$(cell "$a" 6 'opening [m]')" "$(cell "$one" 60 'opening [m]')"; verdict "the gauge in its row is that of history.csv" $?
same "$(cell "$a" 6 'energy_strain [J]')" "$(grep -A2 '"energy"' "$work/one/report.json" | sed -n 's/.*"strain": \(.*\),/\1/p')"; verdict "the energy that of report.json" $?

rows() { wc -l 2> /dev/null < "$1" || echo 0; }
"$perigal" sweep "$scene" "${twelve[@]}" -o "$work/b" > "$work/out" 2> "$work/err" &
process=$!
caught="$work/b/critical_stretch=0.0015_time_steps=20000"
for ((k = 0; k < 6000; k++)); do
    [ "$(rows "$caught/history.csv")" -gt 20 ] && break
    kill -0 $process 2> /dev/null || break
    sleep 0.01
done
kill -INT $process; wait $process; code=$?
[ $code -eq 130 ]; verdict "interrupted: exit code 130" $?
grep -q 'interrupted: 10 of 12 runs are not finished' "$work/err" && grep -q 'with --resume goes on' "$work/err"; verdict "it says how many are left and how to go on" $?
b=$work/b/sweep.csv
[ "$(cell "$b" 2 'status [name]')$(cell "$b" 3 'status [name]')$(cell "$b" 4 'status [name]')" = doneinterruptedwaiting ]; verdict "the table says what became of each" $?
[ -s "$caught/checkpoint.nc" ] && [ "$(rows "$caught/history.csv")" -lt "$(rows "$work/a/${caught##*/}/history.csv")" ]; verdict "the run that was caught left a checkpoint" $?
cp -r "$work/b" "$work/c"; echo damaged > "$work/c/${caught##*/}/checkpoint.nc"
expect "a run goes on from its checkpoint, not from a damaged one" 70 '11 of 12 runs are done, 1 failed' 'runs failed' sweep "$scene" "${twelve[@]}" -o "$work/c" --resume -j 2
grep -q '^3,.*failed,.*checkpoint' "$work/c/sweep.csv"; verdict "and its row says so" $?
done_at=$(stat -c %Y.%s "$work/b/critical_stretch=0.0015_time_steps=40/result.e")
expect "a sweep that is there is not touched unasked" 64 '' 'holds a sweep: --resume' sweep "$scene" "${twelve[@]}" -o "$work/b"
touch "$caught.check"                                  # of a check that was killed
expect "resumed" 0 '12 of 12 runs are done' '' sweep "$scene" "${twelve[@]}" -o "$work/b" --resume -j 3
[ ! -e "$caught.check" ]; verdict "nothing is left of a check that was killed" $?
[ "$done_at" = "$(stat -c %Y.%s "$work/b/critical_stretch=0.0015_time_steps=40/result.e")" ]; verdict "what was finished was kept" $?
without_seconds() { awk -F, 'NR == 1 { for (k = 1; k <= NF; k++) if ($k == "seconds [s]") at = k } { $at = ""; print }' "$1"; }
cmp <(without_seconds "$a") <(without_seconds "$b") > "$work/why" 2>&1; verdict "the table is that of the uninterrupted sweep, seconds aside" $?
for f in "$work"/a/*/; do
    for table in history.csv events.csv; do cmp "$f$table" "$work/b/$(basename "$f")/$table"; done
done > "$work/why" 2>&1; [ ! -s "$work/why" ]; verdict "and so are all histories and events, byte by byte" $?
expect "nothing is left to do" 0 '12 of 12 runs are done' '' sweep "$scene" "${twelve[@]}" -o "$work/b" --resume

# ---- lists
expect "a range with a unit, --zip, quantities" 0 '3 of 3 runs are done' '' sweep "$scene" --zip --set 'solver.dt=5e-8:0.5e-7:1.5e-7 s' \
    --set failure.critical_stretch=0.002,0.003,0.004 --set solver.time_steps=30 --quantity broken,top.force_y:min --quantity opening:peak,top.force_y -o "$work/zip"
head -n 1 "$work/zip/sweep.csv" > "$work/why"
grep -q '^number \[1\],dt \[s\],critical_stretch,broken \[1\],top.force_y:min \[N\],opening:peak \[m\],top.force_y \[N\],warnings \[1\],seconds \[s\],status \[name\]' "$work/why"; verdict "the columns" $?
[ "$(cut -d, -f2,3 "$work/zip/sweep.csv" | tr '\n' ' ')" = 'dt [s],critical_stretch 4.9999999999999998e-08,0.002 9.9999999999999995e-08,0.0030000000000000001 1.4999999999999999e-07,0.0040000000000000001 ' ]; verdict "the values go together" $?
h="$work/zip/$(cell "$work/zip/sweep.csv" 2 'folder [name]')/history.csv"
least=$(awk -F, 'NR == 1 { for (k = 1; k <= NF; k++) if ($k == "top.force_y [N]") at = k } NR > 1 && (NR == 2 || $at < m) { m = $at } END { print m }' "$h")
awk -v a="$least" -v b="$(cell "$work/zip/sweep.csv" 2 'top.force_y:min [N]')" 'BEGIN { exit !(a != 0 && (a / b - 1) ^ 2 < 1e-8) }'; verdict "the least force" $?
same "$(cell "$work/zip/sweep.csv" 2 'top.force_y [N]')" "$(cell "$h" 30 'top.force_y [N]')"; verdict "the last force" $?
picture "$work/zip/sweep.png" && picture "$work/zip/sweep_top.force_y-min.png"; verdict "a picture of each quantity" $?
expect "words and brackets" 0 '2 of 2 runs' '' sweep "$scene" --set 'cracks[0].from=[-4 mm, 0],[-2 mm, 0]' --set solver.time_steps=20 -o "$work/words"
grep -q '^2,.*,"\[-2 mm, 0\]",done,from=-2mm-0,$' "$work/words/sweep.csv"; verdict "values that are no numbers stand behind the numbers" $?
picture "$work/words/sweep.png"; verdict "and give a histogram" $?
expect "seeds" 0 '5 of 5 runs' '' sweep "$scene" --set perturb.seed=1:5 --set perturb.amount=0.1 --set solver.time_steps=40 -o "$work/seeds" -j 2
[ "$(cut -d, -f3 "$work/seeds/sweep.csv" | sort -u | wc -l)" -eq 6 ] && picture "$work/seeds/sweep.png"; verdict "five different peaks, a histogram" $?
expect "a sweep may grow" 0 '6 of 6 runs' '' sweep "$scene" --set perturb.seed=1:6 --set perturb.amount=0.1 --set solver.time_steps=40 -o "$work/seeds" --resume -j 2
[ "$(grep -c 'was there' "$work/out")" -eq 5 ]; verdict "by what is new only" $?

# ---- a run that fails is told and does not end the sweep
mkdir "$work/f"; : > "$work/f/dt=1e-7"
expect "one run fails" 70 '2 of 3 runs are done, 1 failed' '1 of 3 runs failed' sweep "$scene" --set solver.dt=5e-8,1e-7,1.5e-7 --set solver.time_steps=20 -o "$work/f"
[ "$(cell "$work/f/sweep.csv" 2 'status [name]')" = failed ] && grep -q '^2,.*dt=1e-7 is a file' "$work/f/sweep.csv"; verdict "its row says why" $?
[ "$(cell "$work/f/sweep.csv" 3 'status [name]')" = done ]; verdict "the next one was run" $?
rm "$work/f/dt=1e-7"
expect "what failed begins anew" 0 '3 of 3 runs are done' '' sweep "$scene" --set solver.dt=5e-8,1e-7,1.5e-7 --set solver.time_steps=20 -o "$work/f" --resume

# ---- refusals, all before the first run
expect "a misspelt key" 65 '' 'spacng = 2 mm: unknown key; did you mean spacing?' sweep "$scene" --set 'spacng=1 mm,2 mm' -o "$work/no"
grep -q "bar.yaml: 2 of 2 combinations are wrong; no run was started" "$work/err"; verdict "with the file" $?
expect "wrong values" 65 '' 'critical_stretch = -1: must' sweep "$scene" --set failure.critical_stretch=0.002,-1,-2 --set 'spacing=1 mm,2 mm' -o "$work/no"
grep -q '4 of 6 combinations are wrong' "$work/err" && [ "$(grep -c critical_stretch "$work/err")" -eq 2 ]; verdict "each told once" $?
expect "what only the whole check finds" 65 '' 'does not pass `perigal check`; no run was started' sweep "$scene" --set 'method.horizon=3.015 spacing,0.5 spacing' -o "$work/no"
grep -q 'a point would see no neighbour' "$work/err" && grep -q '^horizon=0.5spacing' "$work/err"; verdict "the fault and the combination" $?
expect "memory" 70 '' 'memory' sweep "$scene" --set failure.critical_stretch=0.002,0.003 --memory 1kB -o "$work/no"
[ -z "$(ls "$work/no")" ]; verdict "nothing was begun" $?
expect "an unknown quantity" 64 '*' 'did you mean top.force_y?' sweep "$scene" --set failure.critical_stretch=0.002,0.003 --set solver.time_steps=20 --quantity top.forcey -o "$work/q"
expect "quantity: what of it" 64 '' 'one of last, first, min, max, peak' sweep "$scene" --set failure.critical_stretch=1,2 --quantity top.force_y:mean -o "$work/no"
expect "no key has several values" 64 '' 'no key has several values' sweep "$scene" --set 'spacing=1 mm' -o "$work/no"
expect "a value is missing" 64 '' 'a value is missing' sweep "$scene" --set 'spacing=1 mm,' -o "$work/no"
expect "a value twice" 64 '' 'is there twice' sweep "$scene" --set 'spacing=1 mm,2 mm,1 mm' -o "$work/no"
expect "a range backwards" 64 '' 'must lead from its first' sweep "$scene" --set 'spacing=3:1 mm' -o "$work/no"
expect "lists of different lengths" 64 '' 'has 2 values and .* has 3' sweep "$scene" --zip --set 'spacing=1 mm,2 mm' --set failure.critical_stretch=1,2,3 -o "$work/no"
expect "too many" 64 '' 'are more than 1000' sweep "$scene" --set perturb.seed=1:500 --set failure.critical_stretch=1,2,3 -o "$work/no"
expect "a misspelt option" 64 '' 'did you mean --jobs' sweep "$scene" --job 2
expect "no scene" 64 '' 'a scene file is needed' sweep --set spacing=1,2
expect "no such file" 65 '' 'missing.yaml' sweep missing.yaml --set spacing=1,2 -o "$work/no"
expect "another scene in the folder" 64 '' 'holds a finished run of another scene' sweep "$scene" --set perturb.seed=1:5 --set perturb.amount=0.2 --set solver.time_steps=40 -o "$work/seeds" --resume
expect "help" 0 'resume' '' sweep --help
finish

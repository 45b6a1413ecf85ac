#!/bin/bash
# test_cracks.sh BUILD: perigal cracks (numbers, picture, table read back) and perigal run --seeds (folders, table, histogram, going on, refusals).
. "$(dirname "$0")/expect.sh"
cd "$(dirname "$0")/../../.." || exit 1
picture() { [ -s "$1" ] && [ "$(head -c 8 "$1" | od -An -tx1 | tr -d ' \n')" = 89504e470d0a1a0a ] && [ "$(stat -c %s "$1")" -gt 5000 ]; }
scene=$work/network.yaml
cat > "$scene" <<'END'
title: Plate with random cracks
dimension: 2
plane: stress
thickness: 1 mm
body:
  - add: {box: {low: [-10 mm, -10 mm], high: [10 mm, 10 mm]}}
spacing: 1 mm
lattice: cells
cracks:
  - {random: {seed: 5, count: 4, length: {distribution: uniform, min: 2 mm, max: 6 mm}, distance: 1 mm}}
  - {from: [8 mm, -7 mm], to: [12 mm, -7 mm], width: 1 mm}
materials:
  steel: {youngs_modulus: 192 GPa, poissons_ratio: 0.333333333333, density: 8000 kg/m3}
failure: {criterion: stretch, critical_stretch: 0.002, exclude: [top, bottom]}
method: {force: bond, kernel: constant, horizon: 3.015 spacing}
boundary:
  - {name: top, set: top, velocity: {y: 5 m/s}}
  - {name: bottom, set: bottom, velocity: {y: -5 m/s}}
solver: {kind: verlet, dt: 1e-7 s, time_steps: 60}
output: {at: {levels: 1}}
END
expect "cracks: what a network amounts to" 0 'cracks  *5, 1 of them slots, lengths ' '' cracks "$scene" -o "$work/n.png" --csv "$work/n.csv"
grep -q '1 reaches out of the body: cut off at its surface' "$work/out"; verdict "a crack that leaves the body is said so" $?
picture "$work/n.png"; verdict "the picture" $?
[ "$(wc -l < "$work/n.csv")" -eq 6 ]; verdict "a line for each crack" $?
sed '/random:/d; s/.*from:.*/  - {file: n.csv}/' "$scene" > "$work/again.yaml"
expect "cracks: the table is read back" 0 'cracks  *5, 1 of them slots' '' cracks "$work/again.yaml" --csv "$work/m.csv"
cmp -s "$work/n.csv" "$work/m.csv"; verdict "and is the same, byte by byte" $?
expect "a run of the seed" 0 '' '*' run "$scene" -o "$work/a" --quiet --threads 1
expect "a run of its table" 0 '' '*' run "$work/again.yaml" -o "$work/b" --quiet --threads 1
cmp -s "$work/a/history.csv" "$work/b/history.csv" && cmp -s "$work/a/events.csv" "$work/b/events.csv"; verdict "give the same bits" $?
expect "cracks: another seed" 0 'cracks' '' cracks "$scene" --set 'cracks[0].random.seed=6' --csv "$work/o.csv"
cmp -s "$work/n.csv" "$work/o.csv"; [ $? -eq 1 ]; verdict "is another network" $?
expect "check says the same of cracks" 0 'crack intensity' '' check "$scene"
expect "cracks: none in the scene" 64 '' 'has no cracks' cracks test/app/cli/plate.yaml --set 'cracks=[]'
expect "cracks: a misspelt option" 64 '' 'did you mean --csv' cracks "$scene" --cvs x
expect "cracks: a picture of no kind" 64 '*' 'png' cracks "$scene" -o "$work/n.gif"

expect "seeds: three runs" 0 'peak load of 3 of 3 runs: mean .*standard deviation' '' run "$scene" --seeds 3 -o "$work/s" --threads 1
[ "$(wc -l < "$work/s/seeds.csv")" -eq 4 ] && [ -s "$work/s/seed_3/report.json" ]; verdict "a row and a folder for each" $?
picture "$work/s/seeds.png"; verdict "the histogram" $?
[ "$(cut -d, -f2 "$work/s/seeds.csv" | sort -u | wc -l)" -eq 4 ]; verdict "no two peaks are equal" $?
# the numbers of the summary, from the table
awk -F, 'NR > 1 { s += $2; q += $2 * $2; n++ } END { m = s / n; printf "%.4g %.4g\n", m, sqrt ((q - n * m * m) / (n - 1)) }' "$work/s/seeds.csv" > "$work/spread"
read -r mean deviation < "$work/spread"
awk -v m="$mean" -v d="$deviation" '/mean/ { for (k = 1; k < NF; k++) { if ($k == "mean") { a = $(k + 1) * ($(k + 2) ~ /^k/ ? 1000 : 1) }
    if ($k == "deviation") { b = $(k + 1) * ($(k + 2) ~ /^k/ ? 1000 : 1) } } } END { exit !(a / m > .999 && a / m < 1.001 && b / d > .995 && b / d < 1.005) }' "$work/out"
verdict "mean and deviation are those of the table" $?
cp "$work/s/seeds.csv" "$work/first.csv"; rm -r "$work/s/seed_2"
expect "seeds: goes on where it was" 0 'seed_1 .*was there' '' run "$scene" --seeds 3 -o "$work/s" --threads 1
cmp -s <(cut -d, -f1-5 "$work/first.csv") <(cut -d, -f1-5 "$work/s/seeds.csv"); verdict "to the same table" $?
expect "seeds: several at a time" 0 'peak load of 3 of 3 runs' '' run "$scene" --seeds 3 -j 3 -o "$work/j"
cmp -s <(cut -d, -f1-5 "$work/first.csv") <(cut -d, -f1-5 "$work/j/seeds.csv"); verdict "the same table" $?
expect "one run has no jobs" 64 '' 'is for --seeds' run "$scene" -j 2 -o "$work/t"
expect "seeds: other values in the same folder" 65 '*' 'choose another folder' run "$scene" --seeds 3 -o "$work/s" --set 'failure.critical_stretch=0.003' --threads 1
expect "seeds: nothing has a seed" 65 '*' 'nothing in this scene has a seed' run "$work/again.yaml" --seeds 2 -o "$work/t"
expect "seeds: no number" 64 '' 'a number of runs' run "$scene" --seeds none
expect "seeds: not with --force" 64 '' 'goes on where it was' run "$scene" --seeds 2 --force -o "$work/s"
expect "seeds: a wrong scene" 65 '*' 'unknown key' run "$scene" --seeds 2 --set 'method.horizn=3' -o "$work/u"
finish

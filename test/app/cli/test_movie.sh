#!/bin/bash
# test_movie.sh BUILD: perigal plot --movie: as many frames as steps, each of them the picture of that step, at the rate asked for; deformed bodies in
# one frame; in 3D; what is refused.
. "$(dirname "$0")/expect.sh"
cd "$(dirname "$0")/../../.." || exit 1
movie() { python3 test/app/cli/frames.py "$@" > "$work/why" 2>&1; }
"$perigal" run data/disk_crack/scene.yaml -q -o "$work/disk" --threads 1 --set spacing='4 mm' --set output.pictures=[] --set output.at.levels=4
disk=$work/disk
steps=$("$perigal" plot "$disk" --list | wc -l)
expect "a movie of damage" 0 'disk/damage_movie.png$' '' plot "$disk" --movie
[ "$(wc -l < "$work/out")" -eq 1 ] && [ ! -e "$disk/damage_movie.png.frame.png" ]; verdict "one file and nothing beside" $?
"$perigal" plot "$disk" --step all --out "$work/each.png" > "$work/out"
[ "$steps" -gt 3 ] && movie "$disk/damage_movie.png" 10 "$work"/each_0*.png; verdict "its frames are the pictures of all steps" $?
expect "of a field, in a range, at a rate" 0 'm.apng' '' plot "$disk" --field stress.yy --range -1e8,1e8 --movie --rate 2.5 --steps 0,-1,1 --out "$work/m.apng"
for k in 0 -1 1; do "$perigal" plot "$disk" --field stress.yy --range -1e8,1e8 --step "$k" --out "$work/one$k.png" > "$work/out"; done
movie "$work/m.apng" 2.5 "$work/one0.png" "$work/one-1.png" "$work/one1.png"; verdict "its frames are the pictures of these steps, in this order" $?
expect "deformed" 0 'd.png' '' plot "$disk" --movie --magnify 300 --out "$work/d.png"
dashes=(); for ((k = 0; k < steps; k++)); do dashes+=(-); done
movie "$work/d.png" 10 "${dashes[@]}"; verdict "all frames have one size, and each differs" $?
"$perigal" plot "$disk" --magnify 300 --out "$work/last.png" > "$work/out"
! movie "$work/d.png" 10 "${dashes[@]:1}" "$work/last.png"; verdict "the test can tell pictures apart" $?

cat > "$work/solid.yaml" <<'END'
dimension: 3
body: [{add: {box: {low: [0, 0, 0], high: [10 mm, 12 mm, 10 mm]}}}]
spacing: 2 mm
cracks: [{polygon: [[0, 6 mm, 0], [5 mm, 6 mm, 0], [5 mm, 6 mm, 10 mm], [0, 6 mm, 10 mm]]}]
materials: {rock: {youngs_modulus: 10 GPa, poissons_ratio: 0.2}}
method: {force: bond, accept_inexact: yes}
boundary: [{set: bottom, displacement: {x: 0, y: 0, z: 0}}, {set: top, displacement: {y: 10 um}}]
output: {at: {levels: 3}, pictures: []}
END
"$perigal" run "$work/solid.yaml" -q -o "$work/solid" --threads 1 --set solver.steps=3 > "$work/out" 2>&1
steps=$("$perigal" plot "$work/solid" --list | wc -l)
dashes=(); for ((k = 0; k < steps; k++)); do dashes+=(-); done
expect "in space" 0 'solid/displacement.y_iso_movie.png' '' plot "$work/solid" --field displacement.y --view iso --magnify 50 --movie
[ "$steps" -gt 2 ] && movie "$work/solid/displacement.y_iso_movie.png" 10 "${dashes[@]}"; verdict "a frame each" $?

expect "a kind of file that is none" 64 '' 'ends in .png or .apng' plot "$disk" --movie --out "$work/m.gif"
[ ! -e "$work/m.gif" ]; verdict "nothing is left of it" $?
expect "a rate" 64 '' 'must be 0.02 or more' plot "$disk" --movie --rate 0
expect "a rate without a movie" 64 '' 'for movies' plot "$disk" --rate 5
expect "a movie has no columns" 64 '' 'exclude each other' plot "$disk" --movie --columns 2
expect "one step is no movie" 64 '' '--steps N,N' plot "$disk" --movie --step 2
expect "a step that does not exist" 64 '' 'has no step 99' plot "$disk" --movie --steps 0,99
expect "an unknown field" 64 '' "did you mean 'damage'" plot "$disk" --movie --field damag
expect "a folder that cannot be written" 70 '' 'nowhere' plot "$disk" --movie --out "$work/nowhere/m.png"
expect "meshes do not move" 64 '' 'for result folders' plot "$work/solid.yaml" --movie
finish

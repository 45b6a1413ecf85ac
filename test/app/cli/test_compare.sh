#!/bin/bash
# test_compare.sh BUILD: perigal compare as a user meets it, and the norms of the textbook scenes (doc/accuracy.md).
. "$(dirname "$0")/expect.sh"
cd "$(dirname "$0")/../../.." || exit 1
compare() { local of=("${@:1:4}"); shift 4; expect "${of[@]}" compare "$@"; }
# within FILE KEYS LOW HIGH: a number of a JSON file, keys separated by dots
within() {
    python3 - "$@" > "$work/out" 2> "$work/err" << 'END'
import json, sys
v = json.load(open(sys.argv[1]))
for key in sys.argv[2].split('.'): v = v[int(key)] if isinstance(v, list) else v[key]
print(sys.argv[2], v)
sys.exit(not float(sys.argv[3]) <= v <= float(sys.argv[4]))
END
}
run() { "$perigal" run "$@" --threads 1 > "$work/out" 2> "$work/err"; }

run data/textbook_cantilever/scene.yaml -o "$work/two" --set spacing=2 && grep -q 'against the reference: displacement: L2 5.9' "$work/out"
verdict "a run prints its norms" $?
run data/textbook_cantilever/scene.yaml -o "$work/one" --set spacing=1 -q; verdict "finer run" $?
within "$work/two/report.json" error.displacement_l2.relative 5.8e-4 6.1e-4; verdict "L2 at spacing 2 as in doc/accuracy.md" $?
within "$work/one/report.json" error.displacement_l2.relative 8.2e-5 8.6e-5; verdict "L2 at spacing 1 as in doc/accuracy.md" $?
within "$work/one/report.json" error.energy.relative 5e-3 1.4e-2; verdict "energy at spacing 1" $?
[ -s "$work/one/error.png" ]; verdict "error.png" $?
run data/textbook_patch/scene.yaml -o "$work/patch" -q; within "$work/patch/report.json" error.displacement_maximum.relative 1e-3 5e-3; verdict "patch" $?

compare "a run against its scene's reference"  0 'energy norm 2.2' '' "$work/two"
cp "$work/two/compare.json" "$work/scene.json"
within "$work/scene.json" displacement_l2.relative 5.8e-4 6.1e-4; verdict "the same numbers as the run" $?
compare "a run against itself"                 0 'by its own shape functions' '' "$work/two" "$work/two"
within "$work/two/compare.json" displacement_l2.relative 0 1e-14; verdict "is 0" $?
within "$work/two/compare.json" energy.relative 0 1e-13; verdict "stresses too" $?
turning=(--set spacing=2 --set lattice=cells --set method.force=gmpd --set method.horizon='3 spacing')
run data/textbook_cantilever/scene.yaml -o "$work/turning" -q "${turning[@]}" --set 'output.fields=[displacement, rotation, stress]'; verdict "points that turn" $?
compare "against themselves"                   0 'by its own shape functions' '' "$work/turning" "$work/turning"
within "$work/turning/compare.json" displacement_l2.relative 0 1e-14; verdict "is 0 with rotations" $?
within "$work/turning/compare.json" energy.relative 0 1e-13; verdict "stresses too, which shear makes with them" $?
compare "against the reference of the scene"   0 'energy norm' '' "$work/turning"
python3 - "$work/turning" > "$work/out" 2> "$work/err" << 'END'
import json, sys
run, asked = (json.load(open(sys.argv[1] + name)) for name in ('/report.json', '/compare.json'))
a, b = run['error']['displacement_l2']['relative'], asked['displacement_l2']['relative']
print(a, b)
sys.exit(not abs(a - b) <= 1e-9 * abs(a))
END
verdict "as the run found it" $?
run data/textbook_cantilever/scene.yaml -o "$work/straight" -q "${turning[@]}" --set 'output.fields=[displacement, stress]'
compare "rotations that are not stored"        0 'it has no field rotation' '' "$work/straight"
compare "against a finer run"                  0 'displacement: L2' '' "$work/two" "$work/one/result.e"
within "$work/two/compare.json" displacement_l2.relative 4.5e-4 6e-4; verdict "about the difference of their errors" $?
[ "$(wc -l < "$work/two/compare.csv")" -eq $((49 * 13 + 1)) ]; verdict "a row for each point of the finer one" $?
compare "half of it"                           0 'displacement' '' "$work/two" "$work/two" --scale 0.5 --field displacement.y --out "$work/half.png"
within "$work/two/compare.json" displacement_l2.relative 0.999 1.001; verdict "differs by 1" $?
[ -s "$work/half.png" ]; verdict "picture where asked" $?
compare "bodies apart"                         64 '' 'no place in common' "$work/two" "$work/two" --shift 500,0
printf 'x [m],y [m],u_y [mm],s_xx [kPa]\n24,0,-2781,0\n48,0,-8900,0\n24,3,,500\n60,3,1,500\n' > "$work/line.csv"
compare "against a table"                      0 'line.csv u_y' '' "$work/one" "$work/line.csv"
within "$work/one/compare.json" lines.0.missed 2 2; verdict "an empty cell and a place outside are missed" $?
head -1 "$work/one/compare.csv" | grep -q '^x \[m\],y \[m\],u_y \[m\],reference_u_y \[m\],difference_u_y \[m\],s_xx'; verdict "columns of compare.csv" $?
compare "--json"                               0 '"displacement_l2"' '' "$work/one" --json
python3 -m json.tool "$work/out" > /dev/null 2>> "$work/err"; verdict "is JSON" $?
compare "a table of nothing"                   70 '' 'no column of values' "$work/one" test/app/cli/wrong/reference_columns.csv
compare "no such field"                        64 '' 'displacement.x' "$work/one" --field u
compare "no folder"                            64 '' 'is no result folder' "$work/nowhere"
compare "no such reference"                    70 '' 'nowhere' "$work/one" "$work/nowhere"
compare "no such step"                         64 '' 'its steps are 0 to 0' "$work/one" --step 3
compare "no such step of the reference"        64 '' 'one/result.e has no step 3' "$work/two" "$work/one" --reference-step 3
compare "unknown option"                       64 '' 'unknown option --foo' "$work/one" --foo
compare "nothing"                              64 '' 'perigal compare DIR' 
finish

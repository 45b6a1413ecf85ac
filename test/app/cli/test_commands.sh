#!/bin/bash
# test_commands.sh BUILD: the program as a user meets it: exit codes, what goes to which stream, result folders.
. "$(dirname "$0")/expect.sh"
cd "$(dirname "$0")" || exit 1

expect "no command: usage on stderr"          64 ''  'usage:' 
expect "--help: usage on stdout"               0 'usage:' '' --help
expect "--version"                             0 '^perigal [0-9]' '' --version
expect "unknown command names the nearest"    64 '' 'did you mean check?' chek
expect "run without a scene"                  64 '' 'needs exactly one scene file' run
expect "run with two scenes"                  64 '' 'needs exactly one scene file' run plate.yaml plate.yaml
expect "run --help"                            0 'result folder' '' run --help
expect "unknown option is named"              64 '' 'unknown option --foo' run plate.yaml --foo
expect "option without its value"             64 '' '--out needs a value' run plate.yaml --out
expect "wrong number of threads"              64 '' '--threads x' run plate.yaml --threads x
expect "--set without ="                      64 '' 'KEY=VALUE is needed' run plate.yaml --set spacing
expect "missing scene file"                   65 '' '^nowhere.yaml: cannot be opened' run nowhere.yaml
expect "a folder is no scene"                 65 '' 'Is a directory' run wrong
mkfifo "$work/pipe"; timeout 20 "$perigal" check "$work/pipe" > "$work/out" 2> "$work/err"
[ $? -eq 65 ] && grep -q 'a scene is a regular file, no pipe' "$work/err"; verdict "a pipe is no scene, and is not waited for" $?
expect "help KEY by its last word"             0 '^method.horizon' '' help horizon
expect "help of an unknown key"               64 '' 'did you mean' help horizn
expect "help of a command"                     0 '--threads' '' help run
expect "help without a key lists the keys"     0 '^  solver.stepping' '' help
expect "help --manual is markdown"             0 '^| `method.horizon`' '' help --manual
expect "list explains its entries"             0 'mohr_coulomb .*cut-off' '' list
expect "check prints the plan"                 0 'points  *66, spacing 0.002 0.002 m' '' check plate.yaml
expect "check: --set is applied"               0 'points  *231,' '' check plate.yaml --set spacing='1 mm'
expect "check: faults of --set name it"       65 '' '^--set spcing=1: .*did you mean spacing?' check plate.yaml --set spcing=1
expect "check: a path that is none"           65 '' 'is not a path' check plate.yaml --set a..b=1
expect "a body that nothing holds is doubted"  0 'nothing holds the body along x' '' check plate.yaml --set 'boundary[1].displacement={y: 0}'
expect "a body that nothing loads is doubted"  0 'nothing loads the body' '' check plate.yaml --set 'boundary[0].displacement={y: 0}'
expect "loads without a name are told apart"   0 'boundary top_4 ' '' check plate.yaml --set 'boundary[2]={set: top, traction: {x: 1 Pa}}' --set 'boundary[3]={set: top, traction: {x: 2 Pa}}'
out=$work/deep/er/result
expect "run makes the folder and its parents"  0 'results in' '*' run plate.yaml -o "$out" --threads 1 --set solver.max_events=3
good=0; for f in result.e history.csv events.csv report.json scene.yaml damage.png load_displacement.png; do [ -s "$out/$f" ] || good=1; done
verdict "all files are there" $good
[ "$(head -c 8 "$out/damage.png" | od -An -tx1 | tr -d ' \n')" = 89504e470d0a1a0a ]; verdict "pictures are PNG" $?
rows=$(($(wc -l < "$out/history.csv") - 1)); grep -q "\"steps\": $rows," "$out/report.json"; verdict "history.csv has one row a step" $?
broken=$(($(wc -l < "$out/events.csv") - 1)); [ $broken -gt 0 ] && grep -q "\"broken\": $broken," "$out/report.json"; verdict "events.csv has one row a bond" $?
grep -q '^# --set solver.max_events=3$' "$out/scene.yaml"; verdict "the copy of the scene tells the overrides" $?
expect "the copy is a scene"                   0 'the scene is valid' '' check "$out/scene.yaml"
expect "run --quiet says nothing but warnings" 0 '' 'warning' run plate.yaml -o "$work/quiet" --quiet --threads 1 --set 'failure={criterion: none}'
! grep -v '^perigal: warning: ' "$work/err"; verdict "each line of it is a warning" $?
expect "a run ends where a wrong scene does"  65 '' 'unknown key' run wrong/unknown_key.yaml -o "$work/none"
[ ! -e "$work/none" ]; verdict "a wrong scene leaves no folder" $?
long=$work/long; for k in $(seq 20); do long=$long/$(printf 'x%.0s' $(seq 200)); done
expect "a folder with too long a path"        70 '*' 'has a path of .* bytes, more than' run plate.yaml -o "$long"
[ ! -e "$work/long" ]; verdict "nothing of it is made" $?

expect "plot draws a field"                    0 '/stress.yy.png$' '' plot "$out" --field stress --component yy
expect "plot names fields as output.pictures"  0 '/stress.yy.png$' '' plot "$out" --field stress.yy
expect "plot: two parts of one field"         64 '' 'which part' plot "$out" --field stress.yy --component xx
expect "a run calls its picture alike"         0 '' '*' run plate.yaml --quiet -o "$work/quiet" --threads 1 --set 'failure={criterion: none}' --set output.pictures='[stress.yy]'
[ -s "$work/quiet/stress.yy.png" ]; verdict "stress.yy.png by a run" $?
expect "plot takes result.e for its folder"     0 'damage.png' '' plot "$out/result.e"
expect "plot draws SVG"                        0 'a.svg' '' plot "$out" --out "$work/a.svg"
grep -q '<svg' "$work/a.svg"; verdict "SVG is SVG" $?
expect "plot draws panels"                     0 'damage_steps.png' '' plot "$out" --steps 0,-1 --columns 1
expect "plot draws every step"                 0 'each_0001.png' '' plot "$out" --step all --out "$work/each.png"
expect "plot: sides are for 3D"               64 '' 'are for 3D results' plot "$out" --view back
expect "check writes the matrix"                0 'is valid' '' check plate.yaml --matrix "$work/mat" --quiet
[ "$(head -n 1 "$work/mat/K.mtx")" = '%%MatrixMarket matrix coordinate real symmetric' ] && [ "$(ls "$work/mat" | tr '\n' ' ')" = 'K.mtx N.mtx T.mtx f.mtx g.mtx points.csv ' ]; verdict "and what belongs to it" $?
expect "check: a matrix that cannot be written"   70 '' 'nowhere' check plate.yaml --matrix /proc/nowhere --quiet
expect "run writes no matrix"                    64 '' 'unknown option --matrix' run plate.yaml "--matrix=$work/mat"
expect "plot names the nearest view"          64 '' 'did you mean back?' plot "$out" --view bak
expect "plot: what a section is"              64 '' 'expected AXIS=VALUE' plot "$out" --section 5
expect "plot: what a direction is"            64 '' 'expected X,Y,Z' plot "$out" --direction 1,0
expect "plot: what a range is"                64 '' 'expected LOW,HIGH' plot "$out" --range 2,1
expect "plot: one step or several"            64 '' 'exclude each other' plot "$out" --step all --steps 0,1
expect "plot draws a curve"                    0 '.png' '' plot "$out" --curve pull.displacement_y pull.force_y
expect "plot draws curves of several runs"     0 'ab.svg' '' plot "$out" "$work/quiet" --curve step pull.force_y --labels 'a run,another' --abs --out "$work/ab.svg"
grep -q '<svg' "$work/ab.svg"; verdict "curves as SVG" $?
expect "plot draws a curve of a table"         0 'table.png' '' plot "$out/history.csv" --curve step pull.force_y --out "$work/table.png"
expect "plot counts the labels"               64 '' '1 names for 2 folders' plot "$out" "$work/quiet" --curve step pull.force_y --labels one
expect "plot: a column that one run lacks"    64 '' "quiet/history.csv has no column 'pull'" plot "$work/quiet" --curve step pull
expect "plot --negate or --abs"               64 '' 'exclude each other' plot "$out" --curve step pull.force_y --abs --negate
expect "plot --negate x --abs y"                0 '.png' '' plot "$out" --curve step pull.force_y --negate x --abs y
awk 'BEGIN { print "a [m],b [N]"; for (i = 0; i < 60; i++) print 0.5 + 0.1 * i "," sin (0.1 * i) * (1 + i) }' > "$work/signs.csv"
awk -F, 'NR == 1; NR > 1 { print $1 "," 0 - $2 }' "$work/signs.csv" > "$work/turned.csv"
line_of() { grep 'fill:none' "$1" | grep -oE ' d="M [^"]*"' | awk 'length ($0) > n { n = length ($0); d = $0 } END { print d }'; }       # the longest line
for k in 'signs n --negate' 'turned t' 'signs xy --negate xy'; do
    read -r table name options <<< "$k"
    "$perigal" plot "$work/$table.csv" --curve a b --out "$work/$name.svg" $options > "$work/out" 2> "$work/err"
done
[ -n "$(line_of "$work/n.svg")" ] && [ "$(line_of "$work/n.svg")" = "$(line_of "$work/t.svg")" ] && [ "$(line_of "$work/n.svg")" != "$(line_of "$work/xy.svg")" ]; verdict "--negate turns y alone" $?
# of event stepping: the thick line never goes back, the thin one behind it does
pen_of() { grep "stroke-width:$2;" "$1" | grep -oE ' d="M [^"]*"' | awk 'length ($0) > n { n = length ($0); d = $0 } END { print d }'; }
goes_back() { tr -d 'dML="' | awk '{ for (i = 3; i < NF; i += 2) if ($i < $(i - 2) - 1e-3) back = 1 } END { exit !back }'; }
"$perigal" run plate.yaml --quiet --threads 1 --set solver.max_events=20 -o "$work/events" > "$work/out" 2> "$work/err"        # by three events the load rises on
# the ring is where the report has the peak: the largest row in which every crack tip was judged
mkdir -p "$work/ring" && printf 'step [1],u [m],a.force_x [N]\n0,0,0\n1,1,3\n2,2,4\n3,3,9\n' > "$work/ring/history.csv"
for step in 3 2; do
    printf '{\n  "curve": {\n    "load": "a",\n    "component": "x",\n    "peak": {\n      "step": %d\n    }\n  }\n}\n' $step > "$work/ring/report.json"
    "$perigal" plot "$work/ring" --curve u a.force_x --out "$work/ring$step.svg" > "$work/out" 2> "$work/err"; verdict "plot of a peak in step $step" $?
done
rm "$work/ring/report.json"; "$perigal" plot "$work/ring" --curve u a.force_x --out "$work/ring.svg" > "$work/out"
cmp -s "$work/ring.svg" "$work/ring3.svg" && ! cmp -s "$work/ring.svg" "$work/ring2.svg"; verdict "plot --curve rings the peak of the report" $?

"$perigal" plot "$work/events" --curve pull.displacement_y pull.force_y --out "$work/events.svg" > "$work/out" 2> "$work/err"
pen_of "$work/events.svg" 1 | goes_back && ! pen_of "$work/events.svg" 3 | goes_back; verdict "plot --curve: the line of an event path is its envelope" $?
expect "plot names the nearest curve option"  64 '' 'did you mean --labels' plot "$out" --curve step pull.force_y --label a
expect "plot names the nearest field"         64 '' "did you mean 'damage'" plot "$out" --field damag
expect "plot names the nearest column"        64 '' "did you mean 'pull.force_y'" plot "$out" --curve step pull.force_yy
"$perigal" run plate.yaml -o "$work/vtk" --threads 1 --set output.format=vtk --set 'output.pictures=[]' --quiet > "$work/out" 2>&1
expect "plot of a format for other programs"   64 '' 'vtk/result.pvd is for other programs (output.format: vtk), and this one cannot read it' plot "$work/vtk"
expect "compare with such a format"            64 '' 'run the scene with output.format: exodus' compare "$out" "$work/vtk"
expect "plot of no folder"                    70 '' 'No such file' plot "$work/nowhere"
cat > "$work/two.msh" <<'END'
$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
2
1 7 "foot"
2 8 "steel"
$EndPhysicalNames
$Nodes
6
1 0 0 0
2 1 0 0
3 2 0 0
4 0 1 0
5 1 1 0
6 2 1 0
$EndNodes
$Elements
4
1 1 2 7 1 1 2
2 1 2 7 1 2 3
3 3 2 8 1 1 2 5 4
4 3 2 8 1 2 3 6 5
$EndElements
END
cat > "$work/two.frd" <<'END'
    1C
    2C                             4                                     1
 -1         1 0.00000E+00 0.00000E+00 0.00000E+00
 -1         2 1.00000E+00 0.00000E+00 0.00000E+00
 -1         3 1.00000E+00 1.00000E+00 0.00000E+00
 -1         4 0.00000E+00 1.00000E+00 0.00000E+00
 -3
    3C                             1                                     1
 -1         1    9    0    1
 -2         1         2         3         4
 -3
    1PSTEP                         1           1           1
  100CL  101 1.00000E+00           4                     0    1           1
 -4  DISP        4    1
 -5  D1          1    2    1    0
 -5  D2          1    2    2    0
 -5  D3          1    2    3    0
 -5  ALL         1    2    0    0    1ALL
 -1         1 0.00000E+00 0.00000E+00 0.00000E+00
 -1         2 1.00000E-01 0.00000E+00 0.00000E+00
 -1         3 1.00000E-01 2.00000E-01 0.00000E+00
 -1         4 0.00000E+00 0.00000E+00 0.00000E+00
 -3
 9999
END
expect "plot draws a mesh"                     0 'two.png' '' plot "$work/two.msh" --unit mm
expect "plot draws the sets of a mesh"         0 'two_sets.png' '' plot "$work/two.msh" --sets
expect "plot draws a field of a mesh"          0 'two_displacement.y.png' '' plot "$work/two.frd" --field displacement --component y --magnify 1
expect "plot names the nearest field of a mesh" 64 '' 'did you mean displacement' plot "$work/two.frd" --field displacment
expect "plot: components of a field"          64 '' 'one of x|y, magnitude' plot "$work/two.frd" --field displacement --component z
expect "plot: a mesh without fields"          70 '' 'holds no fields' plot "$work/two.msh" --field stress
expect "plot: --field or --sets"              64 '' 'exclude each other' plot "$work/two.msh" --field stress --sets
expect "plot: --unit of a length"             64 '' 'expected a unit of length' plot "$work/two.msh" --unit kg
expect "plot: sets are of meshes"             64 '' 'are for mesh files' plot "$out" --sets
expect "plot: steps are of folders"           64 '' 'for result folders' plot "$work/two.frd" --field displacement --step all
expect "plot draws decades"                    0 'log.png' '' plot "$out" --field stress --component yy --log --out "$work/log.png"
expect "plot draws curves with markers"        0 'm.png' '' plot "$out" --curve step pull.force_y --log y --abs --markers --out "$work/m.png"
expect "plot: --log of a curve"               64 '' 'expected x, y or xy' plot "$out" --curve step pull.force_y --log z
expect "plot --help"                           0 'usage' '' plot --help

: > "$work/file"
expect "a file where the folder should be"    64 '' 'file is a file: results need a folder, name another with -o' run plate.yaml -o "$work/file" --threads 1
mkdir "$work/locked"; chmod a-w "$work/locked"
if [ -w "$work/locked" ]; then                         # root may write anywhere; a kernel file system refuses it too
    expect "a folder that cannot be made"     70 '*' 'cannot make the folder' run plate.yaml -o /proc/perigal --threads 1
else
    expect "a folder that cannot be made"     70 '*' 'cannot make the folder' run plate.yaml -o "$work/locked/x" --threads 1
fi

"$perigal" run plate.yaml -o "$work/stopped" --threads 1 --set spacing='0.25 mm' > "$work/out" 2> "$work/err" & pid=$!
for _ in $(seq 200); do [ "$(cat "$work/stopped/history.csv" 2> /dev/null | wc -l)" -gt 5 ] && break; sleep 0.05; done
kill -INT $pid; wait $pid; code=$?
[ $code -eq 130 ]; verdict "SIGINT: exit code 130 (got $code)" $?
grep -q 'interrupted' "$work/stopped/report.json"; verdict "SIGINT: the report tells it" $?
expect "an unfinished run is not replaced"    64 '' 'continue with --resume, start anew with --force' run plate.yaml -o "$work/stopped" --threads 1
grep -q 'interrupted' "$work/stopped/report.json" && [ -s "$work/stopped/checkpoint.nc" ]; verdict "it stays as it was" $?
expect "SIGINT: results are readable"          0 'damage.png' '' plot "$work/stopped"
expect "--force begins anew"                   0 'results in' '*' run plate.yaml -o "$work/stopped" --threads 1 --set solver.max_events=1 --force
[ ! -e "$work/stopped/checkpoint.nc" ] && [ ! -e "$work/stopped/run.lock" ]; verdict "nothing is left of the old run" $?
expect "a finished run is run again"           0 'results in' '*' run plate.yaml -o "$work/stopped" --threads 1 --set solver.max_events=2
expect "--force and --resume"                 64 '' 'exclude each other' run plate.yaml -o "$work/stopped" --force --resume
mkdir "$work/own"; cp plate.yaml "$work/own/scene.yaml"
expect "a scene in its own result folder"     64 '' 'is the scene itself' run "$work/own/scene.yaml" -o "$work/own" --threads 1 --set solver.max_events=1
expect "another scene over one of the user"   64 '' 'was not written by a run' run plate.yaml -o "$work/own" --threads 1 --set solver.max_events=1
cmp plate.yaml "$work/own/scene.yaml" > "$work/out" 2>&1; verdict "the scene is as it was" $?
finish

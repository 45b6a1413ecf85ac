#!/bin/bash
# test_doc_commands.sh BUILD: every command that a document shows is one: its options are known, its scene is right with the same --set,
# its make target, test or bench program is there. Commands are lines of indented or fenced blocks, and `perigal ... data/...` in a text.
# What works on the demo, on DIR (a small solid here) and on out/beam is done in full, so are help and list, and the snippets of doc/guide.md in
# Python and Octave where these are installed; other plots and comparisons go as far as they can without their results, which take too long.
perigal=$(realpath "$1/perigal"); n=0; bad=0
cd "$(dirname "$0")/../../.." || exit 1
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT
. test/app/cli/coarse.sh
long() { [ "$PERIGAL_TEST_SIZE" = long ]; }
any=data/zhou_1/scene.yaml                             # where a document says SCENE
nowhere=/proc/perigal                                  # no folder can be made there: a command stops once it knows what to do
# shown PAGE: its commands, one a line
shown() {
    { sed -e ':a' -e '/\\$/N; s/\\\n *//; ta' "$1" | grep -oE "^( {4,}|system \(')?(\./)?(perigal|make|bench/run|bench/accuracy|build/release/[a-z]+/[a-z_/0-9]+)( .*|$)" | sed "s/^ *//; s/^system ('//; s/');$//"
      grep -oE '`(\./)?perigal [a-z]+ [^`]*data/[^`]*`' "$1" | tr -d '`'; } | sed 's|^\./||'
}
# run or check SCENE OPTIONS: as check
scene_of() {
    local options=() word=$1; shift
    [ "$word" != SCENE ] || word=$any
    options=("$word")
    while [ $# -gt 0 ]; do
        case $1 in
            -o|--memory|--seeds) shift ;;
            -q|--quiet|--resume) ;;
            spacing=*)                                 # a fine one takes minutes to check: its value alone is looked at
                [[ $1 =~ ^spacing=[0-9.]+(e-?[0-9]+)?\ ?(m|mm|um)?$ ]] || return 1
                [ "${options[-1]}" != --set ] || unset 'options[-1]' ;;
            *) options+=("$1") ;;
        esac
        shift
    done
    if [ ${#options[@]} -eq 1 ]; then [ -e "$word" ] || [ -e "$work/$word" ]; return; fi        # test_docs.sh checks all scenes of data/
    # in short size all that is known before a body is built (PERIGAL_TEST_SIZE=long: on a lattice of twice the spacing, where that does not suit as it stands)
    if ! long; then known "${options[@]}"; return; fi
    wider "$word" 2 "${options[@]:1}" || "$perigal" check "${options[@]}" > "$work/out" 2> "$work/err"
}
# stops CODE PATTERN ARGUMENTS...: ends for want of its folder, so that all else was understood
stops() {
    local code=$1 why=$2; shift 2
    "$perigal" "$@" > "$work/out" 2> "$work/err"
    [ $? -eq "$code" ] && grep -q -- "$why" "$work/err"
}
absent() { local w; for w in "$@"; do case $w in out/*|DIR) echo "$work/none" ;; SCENE) echo "$any" ;; *) echo "$w" ;; esac; done; }
# ---- results to work on --------------------------------------------------------------------------------------------------------
ours() { case $1 in out/demo|out/beam|out/finer|line.csv) echo "$work/$(basename "$1")" ;; DIR) echo "$work/solid" ;; *) echo "$1" ;; esac; }
cat > "$work/solid.yaml" <<'EOF'
dimension: 3
body: [{add: {box: {low: [0, 0, 0], high: [12 mm, 12 mm, 10 mm]}}}]
spacing: 2 mm
cracks: [{polygon: [[0, 6 mm, 0], [5 mm, 6 mm, 0], [5 mm, 6 mm, 10 mm], [0, 6 mm, 10 mm]]}]
materials: {rock: {youngs_modulus: 10 GPa, poissons_ratio: 0.2}}
method: {force: bond, accept_inexact: yes}
boundary: [{set: bottom, displacement: {x: 0, y: 0, z: 0}}, {set: top, displacement: {y: 10 um}}]
output: {at: {levels: 8}, pictures: []}
EOF
printf 'x [mm], y [mm], u_y [mm]\n%s\n%s\n' '10, 0, -0.01' '20, 0, -0.02' > "$work/line.csv"
beam=data/textbook_cantilever/scene.yaml
{ "$perigal" run data/disk_crack/scene.yaml -q -o "$work/demo" --set spacing='4 mm' && "$perigal" run "$work/solid.yaml" -q -o "$work/solid" \
    && "$perigal" run $beam -q -o "$work/beam" && "$perigal" run $beam -q -o "$work/finer" --set method.kernel=conical; } > "$work/out" 2>&1 ||
    { echo "not ok 1 - results to work on"; sed 's/^/# /' "$work/out"; echo "1..1"; exit 1; }

cat > "$work/network.yaml" <<'EOF'
dimension: 2
body: [{add: {box: {low: [0, 0], high: [50 mm, 50 mm]}}}]
spacing: 2 mm
cracks: [{random: {seed: 3, count: 5, length: 8 mm}}]
materials: {rock: {youngs_modulus: 10 GPa, poissons_ratio: 0.2}}
boundary: [{name: low, set: bottom, displacement: {x: 0, y: 0}}, {name: high, set: top, displacement: {y: 0.1 mm}}]
EOF
good() {   # the command as words
    local words k
    case $1 in
        make) shift; for k in "$@"; do case $k in *=*|-*) ;; *) grep -qE "^([a-z-]+ )*$k( [a-z-]+)*:" Makefile || return 1 ;; esac; done; return 0 ;;
        bench/run|bench/accuracy) case $3 in list|--*) ;; *) "$1" "$2" list | grep -q "^$3 " ;; esac; return ;;
        build/release/test/*) [ -e "test/${1#build/release/test/}.c" ]; return ;;
        build/release/bench/*) [ -e "bench/${1#build/release/bench/}.c" ]; return ;;
    esac
    shift
    case $1 in
        run|check) shift; scene_of "$@" ;;
        cracks) mapfile -t words < <(for k in "$@"; do case $k in SCENE) echo "$work/network.yaml" ;; *.png|*.csv) echo "$work/$(basename "$k")" ;; *) echo "$k" ;; esac; done)
            "$perigal" "${words[@]}" > "$work/out" 2> "$work/err" ;;
        new) "$perigal" new "$2" -o "$work/${4:-$2}" > "$work/out" 2> "$work/err" ;;
        help|list) "$perigal" "$@" > "$work/out" 2> "$work/err" ;;
        plot|compare)
            if [ "$1" = plot ] && [[ $2 = *.yaml ]]; then
                mapfile -t words < <(for k in "$@"; do case $k in *.png|*.svg) echo "$work/$(basename "$k")" ;; *) echo "$k" ;; esac; done)
                "$perigal" "${words[@]}" > "$work/out" 2> "$work/err"; return
            fi
            if [ "$(ours "$2")" != "$2" ] && [[ $3 != *.frd ]]; then     # whatever else out/ may hold
                mapfile -t words < <(for k in "$@"; do ours "$k"; done)
                "$perigal" "${words[@]}" > "$work/out" 2> "$work/err"; return
            fi
            mapfile -t words < <(absent "$@")
            if [ "$1" = plot ]; then stops 70 'No such file or ' "${words[@]}"; else stops 64 'is no result folder' "${words[@]}"; fi ;;
        bench|converge|sweep) mapfile -t words < <(absent "$@"); stops 70 "$nowhere" "${words[@]}" -o $nowhere ;;
        *) return 1 ;;
    esac
}
declare -A seen
count=0
for page in README.md doc/*.md data/*/README.md matlab-compat/README.md matlab-compat/examples/README.md python/README.md python/examples/README.md; do
    [ $page != doc/input.md ] || continue
    : > "$work/bad"
    while IFS= read -r line; do
        eval "set -- $line" 2> "$work/err" || { echo "$line" >> "$work/bad"; continue; }
        count=$((count + 1))
        [ -z "${seen["$*"]}" ] || continue
        seen["$*"]=1
        good "$@" || { echo "$line"; sed 's/^/    /' "$work/err" | head -5; } >> "$work/bad"
    done < <(shown "$page")
    n=$((n + 1))
    if [ ! -s "$work/bad" ]; then echo "ok $n - commands of $page"; else bad=1; echo "not ok $n - commands of $page"; sed 's/^/# /' "$work/bad"; fi
done
# ---- snippets ------------------------------------------------------------------------------------------------------------------
# snippet LANGUAGE PAGE: the code of the page, on the demo of here, and a run of its own as coarse as that in short size
wide="s/'2 mm'/'4 mm'/"; long && wide=
snippet() { sed -n "/^\`\`\`$1/,/^\`\`\`/p" "$2" | grep -v '^```' | sed "s|out/demo|$work/demo|g; s|out/coarse|$work/coarse|g; /^system/d; $wide"; }
try() {   # name, what it takes, command, file
    n=$((n + 1))
    if ! eval "$2" > "$work/out" 2>&1; then echo "ok $n - $1 # skipped, it needs: $2"; return; fi
    if $3 "$4" > "$work/out" 2>&1; then echo "ok $n - $1"; else bad=1; echo "not ok $n - $1"; sed 's/^/# /' "$work/out" | head -20; fi
}
{ snippet python doc/guide.md; echo "assert len (damage) == len (x) and damage.max () > 0.5"; } > "$work/a.py"
{ echo "graphics_toolkit ('gnuplot'); figure ('visible', 'off');"; snippet matlab doc/guide.md; echo "assert (max (damage(:, end)) > 0.5)"; } > "$work/a.m"
python=python3; "$python" -c 'import netCDF4' 2> /dev/null || python=/usr/bin/python3      # Debian's packages are those of its own Python
export PYTHONPATH=python PYTHONDONTWRITEBYTECODE=1 PERIGAL="$perigal"
try "doc/guide.md in Python" "$python -c 'import netCDF4'" "$python" "$work/a.py"
try "doc/guide.md in Octave" 'octave-cli --eval "pkg load netcdf"' octave-cli "$work/a.m"
n=$((n + 1))
if [ $count -ge 100 ]; then echo "ok $n - $count commands were found"; else bad=1; echo "not ok $n - only $count commands were found"; fi
echo "1..$n"
exit $bad

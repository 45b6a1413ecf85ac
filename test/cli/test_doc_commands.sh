#!/bin/bash
# test_doc_commands.sh BUILD: every command that a document shows is one: its options are known, its scene is right with the same --set,
# its make target, test or bench program is there. Commands are lines of indented or fenced blocks, and `perigal ... data/...` in a text.
perigal=$(realpath "$1/perigal"); n=0; bad=0
cd "$(dirname "$0")/../.." || exit 1
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT
any=data/zhou_1/scene.yaml                             # where a document says SCENE
nowhere=/proc/perigal                                  # no folder can be made there: a command stops once it knows what to do
# shown PAGE: its commands, one a line
shown() {
    { sed -e ':a' -e '/\\$/N; s/\\\n *//; ta' "$1" | grep -oE "^( {4,}|system \(')?(\./)?(perigal|make|bench/run|build/release/[a-z]+/[a-z_/0-9]+)( .*|$)" | sed "s/^ *//; s/^system ('//; s/');$//"
      grep -oE '`(\./)?perigal [a-z]+ [^`]*data/[^`]*`' "$1" | tr -d '`'; } | sed 's|^\./||'
}
# run or check SCENE OPTIONS: as check
scene_of() {
    local options=() word=$1; shift
    [ "$word" != SCENE ] || word=$any
    options=("$word")
    while [ $# -gt 0 ]; do
        case $1 in
            -o|--memory) shift ;;
            -q|--quiet|--resume) ;;
            *) options+=("$1") ;;
        esac
        shift
    done
    if [ ${#options[@]} -eq 1 ]; then [ -e "$word" ]; return; fi        # test_docs.sh checks all scenes of data/
    "$perigal" check "${options[@]}" > "$work/out" 2> "$work/err"
}
# stops CODE PATTERN ARGUMENTS...: ends for want of its folder, so that all else was understood
stops() {
    local code=$1 why=$2; shift 2
    "$perigal" "$@" > "$work/out" 2> "$work/err"
    [ $? -eq "$code" ] && grep -q -- "$why" "$work/err"
}
absent() { local w; for w in "$@"; do case $w in out/*|DIR) echo "$work/none" ;; SCENE) echo "$any" ;; *) echo "$w" ;; esac; done; }
good() {   # the command as words
    local words k
    case $1 in
        make) shift; for k in "$@"; do case $k in *=*|-*) ;; *) grep -qE "^$k:" Makefile || return 1 ;; esac; done; return 0 ;;
        bench/run) grep -qE "(^|[ |(])$3([ |)]|$)" bench/run; return ;;
        build/release/test/*) [ -e "test/${1#build/release/test/}.c" ]; return ;;
        build/release/bench/*) [ -e "bench/${1#build/release/bench/}.c" ]; return ;;
    esac
    shift
    case $1 in
        run|check) shift; scene_of "$@" ;;
        help|list) "$perigal" "$@" > "$work/out" 2> "$work/err" ;;
        plot) mapfile -t words < <(absent "$@"); stops 70 'No such file or ' "${words[@]}" ;;
        compare) mapfile -t words < <(absent "$@"); stops 64 'is no result folder' "${words[@]}" ;;
        bench|converge) mapfile -t words < <(absent "$@"); stops 70 "$nowhere" "${words[@]}" -o $nowhere ;;
        *) return 1 ;;
    esac
}
declare -A seen
count=0
for page in README.md doc/*.md data/*/README.md matlab-compat/README.md; do
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
n=$((n + 1))
if [ $count -ge 100 ]; then echo "ok $n - $count commands were found"; else bad=1; echo "not ok $n - only $count commands were found"; fi
echo "1..$n"
exit $bad

# coarse.sh, to be read by tests that ask `check` about many scenes.
# coarse SCENE TIMES: sets $wide to so many times the spacing of a lattice; fails where the scene names none.
coarse() { wide=$(sed -nE 's/^spacing: ([0-9.]+) *([a-z]*) *(#.*)?$/\1 \2/p' "$1" | awk -v k="$2" '{ print k * $1, $2 }'); [ -n "$wide" ]; }
# Multiples that `wider` tries in short size: what does not suit a lattice is refused at once, and a check takes the cube of what it is too fine.
widest='6 4 3'
# wider SCENE LIST OPTIONS...: `check` agrees on a lattice of one of these multiples of the spacing, whose words are in $work/out and $work/err
wider() {
    local scene=$1 list=$2 k; shift 2
    for k in $list; do coarse "$scene" "$k" && "$perigal" check "$scene" "$@" --set spacing="$wide" > "$work/out" 2> "$work/err" && return; done
    return 1
}
# known SCENE OPTIONS...: `check` agrees with all that is known before a body is built, which memory for none ends
known() { "$perigal" check "$@" --memory 1MB > "$work/out" 2> "$work/err" || { [ $? -eq 70 ] && grep -q 'of memory, and 1 MB are available' "$work/err"; }; }

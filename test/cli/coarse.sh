# coarse.sh, to be read by tests that ask `check` about many scenes.
# coarse SCENE: sets $twice to twice the spacing of a lattice; fails where the scene names none.
coarse() { twice=$(sed -nE 's/^spacing: ([0-9.]+) *([a-z]*) *(#.*)?$/\1 \2/p' "$1" | awk '{ print 2 * $1, $2 }'); [ -n "$twice" ]; }

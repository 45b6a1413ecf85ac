#!/bin/bash
# test_mesh.sh BUILD: every sample of a mesh file is the body of a scene (its own cells; a shape that a lattice fills) and a picture that shows something.
. "$(dirname "$0")/expect.sh"
cd "$(dirname "$0")/../../.." || exit 1
# shows FOLDER LEAST: PNGs of so many different rows at least
shows() {
    python3 - "$@" > "$work/out" 2> "$work/err" << 'END'
import glob, struct, sys, zlib
few = 0
for path in sorted(glob.glob(sys.argv[1] + '/*.png')):
    png = open(path, 'rb').read()
    at, data, tall = 8, b'', 0
    while at < len(png):
        size, name = struct.unpack('>I4s', png[at:at + 8])
        body = png[at + 8:at + 8 + size]
        if name == b'IHDR': tall = struct.unpack('>II', body[:8])[1]
        if name == b'IDAT': data += body
        at += 12 + size
    data = zlib.decompress(data)
    step = len(data) // tall
    rows = len({data[k:k + step] for k in range(0, len(data), step)})
    if rows < int(sys.argv[2]): few += 1; print(path, rows, 'different rows')
sys.exit(few > 0)
END
}
# colours FILE FILE: two PNGs of other shapes in the same colours
colours() {
    python3 - "$@" > "$work/out" 2> "$work/err" << 'END'
import itertools, struct, sys, zlib
def near(left, up, corner):
    d = abs(up - corner), abs(left - corner), abs(left + up - 2 * corner)
    return left if d[0] == min(d) else up if d[1] == min(d) else corner
def colours(path):
    png, at, data = open(path, 'rb').read(), 8, b''
    while at < len(png):
        size, name = struct.unpack('>I4s', png[at:at + 8])
        if name == b'IHDR': wide, tall, _, kind = struct.unpack('>IIBB', png[at + 8:at + 18])
        if name == b'IDAT': data += png[at + 8:at + 8 + size]
        at += 12 + size
    data, m, found = zlib.decompress(data), {2: 3, 6: 4}[kind], set()
    step, above = wide * m + 1, bytearray(wide * m)
    for y in range(tall):
        how, row = data[y * step], bytearray(data[y * step + 1:(y + 1) * step])
        if how == 2: row = bytearray((a + b) & 255 for a, b in zip(row, above)) if any(row) else above
        elif how == 1:
            for c in range(m): row[c::m] = bytes(v & 255 for v in itertools.accumulate(row[c::m]))
        for i in range(len(row) if how > 2 else 0):
            left, up, corner = row[i - m] if i >= m else 0, above[i], above[i - m] if i >= m else 0
            row[i] = (row[i] + ((left + up) // 2 if how == 3 else near(left, up, corner))) & 255
        if row != above or y == 0: found.update(zip(*(row[c::m] for c in range(m))))
        above = row
    return found
one, other = colours(sys.argv[1]), colours(sys.argv[2])
print(len(one), 'colours,', len(other), 'colours,', len(one & other), 'in both')
sys.exit(one != other)
END
}
points() { sed -n 's/^  points *\([0-9]*\),.*/\1/p' "$work/out"; }
# scene FILE DIMENSION UNIT [SPACING]: a run on the mesh, then a lattice in it, if its spacing is given
scene() {
    local name; name=$(basename "$1")
    local rest="materials: {steel: {youngs_modulus: 200 GPa, poissons_ratio: 0.3}}
boundary: [{set: all, displacement: {x: 0, y: 0}}]
solver: {steps: 1, stepping: fixed}
output: {at: {levels: 1}, pictures: []}"
    printf 'dimension: %d\nmesh: {file: %s, unit: %s}\n%s\n' "$2" "$PWD/$1" "$3" "$rest" > "$work/own.yaml"
    printf 'dimension: %d\nbody: [{add: {mesh: {file: %s, unit: %s}}}]\nspacing: %s\n%s\n' "$2" "$PWD/$1" "$3" "$4" "$rest" > "$work/shape.yaml"
    "$perigal" check "$work/own.yaml" > "$work/out" 2> "$work/err" && [ "$(points)" -ge 4 ]; verdict "$name: a scene's cells" $?
    if [ "$4" ]; then
        "$perigal" check "$work/shape.yaml" > "$work/out" 2> "$work/err" && [ "$(points)" -ge 20 ] && ! grep -q 'staircase' "$work/out"
        verdict "$name: a shape of a scene" $?
    fi
    drawn "$1"
}
# of the forms of one mesh as files, which are read above, the first is drawn in short size
drawn() {
    case $1 in *_22b.msh|*_41.msh|*_41b.msh) long || return ;; esac
    pictures=$((pictures + 1))
    "$perigal" plot "$1" --out "$work/pictures/$(basename "$1").png" > "$work/out" 2> "$work/err"; verdict "$(basename "$1"): a picture" $?
}
mkdir "$work/pictures"
# a lattice in the bracket takes as long as all other checks here, for its many facets; its cells and a lattice in curved tetrahedra a third of that
long() { [ "$PERIGAL_TEST_SIZE" = long ]; }
ball= wide='1 mm'; long && ball='0.7 mm' wide='0.7 mm'
pictures=0
for file in data/mesh/*.msh; do
    case $file in */ball_tet10.msh) scene "$file" 3 mm "$ball" ;; */disk_*) scene "$file" 2 mm '0.2 mm' ;; */box_*) scene "$file" 3 mm '0.5 mm' ;; *) scene "$file" 3 mm "$wide" ;; esac
done
scene test/fuzz/seed_mesh/tri.e 2 mm '0.1 mm'
scene test/fuzz/seed_mesh/plane.inp 2 mm '0.1 mm'
if long; then scene data/bracket/bracket.inp 3 mm '12 mm'; else drawn data/bracket/bracket.inp; fi
for file in data/mesh/ccx/*.frd; do                    # short: every other one
    long || [ $((frd++ % 2)) -eq 1 ] || continue
    pictures=$((pictures + 1))
    "$perigal" plot "$file" --field stress --out "$work/pictures/$(basename "$file").png" > "$work/out" 2> "$work/err"; verdict "$(basename "$file"): a picture of its stress" $?
done

# ---- fields of a run on a mesh: on its elements while it is whole and its file is there -----------------------------------------------
mkdir "$work/here" "$work/elsewhere"
cp data/mesh/disk_tri6_41.msh "$work/here/disk.msh"
cat > "$work/here/disk.yaml" << 'END'
dimension: 2
mesh: {file: disk.msh, unit: mm, points: corners}
materials: {steel: {youngs_modulus: 200 GPa, poissons_ratio: 0.3}}
failure: {criterion: principal_stress, tensile_strength: 300 MPa}
boundary: [{set: low, displacement: {x: 0, y: 0}}, {set: high, displacement: {y: 2 um}}]
sets: {low: {where: 'y < -0.7 mm'}, high: {where: 'y > 0.7 mm'}}
solver: {steps: 2, stepping: fixed}
output: {at: {levels: 2}, pictures: [displacement]}
END
draw() { (cd "$work/elsewhere" && "$perigal" plot "$work/$1" --field displacement "${@:3}" --out "$work/$2.png") > "$work/out" 2> "$work/err"; }
differ() { [ -s "$work/$1.png" ] && [ -s "$work/$2.png" ] && ! cmp -s "$work/$1.png" "$work/$2.png"; }
(cd "$work/here" && "$perigal" run disk.yaml --quiet -o ../whole --set 'failure={criterion: none}' && "$perigal" run disk.yaml --quiet -o ../broken) > "$work/out" 2> "$work/err"
verdict "runs on a mesh" $?
draw whole whole_there && draw whole whole_large --magnify 100 && draw broken broken_there; verdict "drawn from another folder" $?
mv "$work/here/disk.msh" "$work/here/away.msh"
draw whole whole_gone && draw broken broken_gone; verdict "drawn without the mesh" $?
differ whole_there whole_gone; verdict "elements where the mesh is there, points where it is gone" $?
differ whole_there whole_large; verdict "elements move with their nodes" $?
colours "$work/broken_there.png" "$work/broken_gone.png"; verdict "points where bonds are broken" $?
differ broken_there broken_gone; verdict "their cells end where the elements do" $?
cp data/mesh/disk_quad4.msh "$work/here/disk.msh"; draw whole whole_other && cmp "$work/whole_gone.png" "$work/whole_other.png" > "$work/out" 2>&1
verdict "points where the mesh is another now" $?

[ "$(ls "$work/pictures" | wc -l)" -eq $pictures ] && shows "$work/pictures" 100; verdict "$pictures pictures show something" $?
finish

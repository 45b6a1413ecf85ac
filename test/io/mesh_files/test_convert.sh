#!/bin/bash
# test_convert.sh BUILD: perigal-mesh, where Gmsh's library is installed: geometries, meshes of other formats, refusals.
program=$(realpath "$1")/perigal-mesh; data=$(realpath data/mesh); n=0; bad=0
export ASAN_OPTIONS=detect_leaks=0                      # what Gmsh keeps is not ours
if [ ! -x "$program" ]; then echo "ok 1 - perigal-mesh is not built here # SKIP no libgmsh-dev"; exit 0; fi
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT; cd "$work" || exit 1
# expect NAME CODE STDOUT STDERR ARGUMENTS...: patterns, an empty one wants an empty stream
expect() {
    local name=$1 code=$2 out=$3 err=$4 k good=1; shift 4
    "$program" "$@" > out 2> err; k=$?
    [ $k -eq "$code" ] || good=0
    if [ -n "$out" ]; then grep -q -- "$out" out || good=0; else [ ! -s out ] || good=0; fi
    if [ -n "$err" ]; then grep -q -- "$err" err || good=0; else [ ! -s err ] || good=0; fi
    n=$((n + 1))
    if [ $good -eq 1 ]; then echo "ok $n - $name"; else bad=1; echo "not ok $n - $name"; sed 's/^/# /' out err; fi
}
cat > plate.geo <<END
SetFactory("OpenCASCADE");
Rectangle(1) = {0, 0, 0, 2, 1};
END
cat > cut.stl <<END
solid open
facet normal 0 0 1
outer loop
vertex 0 0 0
vertex 1 0 0
vertex 0 1 0
endloop
endfacet
endsolid open
END
cat > pyramid.msh <<END
\$MeshFormat
2.2 0 8
\$EndMeshFormat
\$Nodes
5
1 0 0 0
2 1 0 0
3 1 1 0
4 0 1 0
5 0 0 1
\$EndNodes
\$Elements
1
7 7 2 1 1 1 2 3 4 5
\$EndElements
END
printf 'Point(1) = {0, 0, 0};\nLine(' > broken.geo
expect "geometry with groups"         0 "2D, .* tri3" ""                                       "$data/disk.geo" o.msh
grep -q '^blocks: outside inside$' out && grep -q '^sets: rim hole interface corner$' out; k=$?
n=$((n + 1)); [ $k -eq 0 ] && echo "ok $n - groups keep their names" || { bad=1; echo "not ok $n - groups keep their names"; }
expect "geometry without groups"      0 "^sets: side_1 side_2 side_3 side_4$" ""               plate.geo o.msh --size 0.5
expect "second order"                 0 "3D, .* hex27" ""                                      "$data/box.geo" o.msh --order 2
expect "surface of a body"            1 "" "z goes from"                                       "$data/box.geo" o.msh --dim 2
expect "first order of a mesh"        0 "2D, .* 64 tri3" ""                                    "$data/disk_tri6_22.msh" o.msh --order 1
expect "size of a mesh is its own"    0 "64 tri6" "has elements already; --size is not used"   "$data/disk_tri6_22.msh" o.msh --size 1
expect "pyramids"                     0 "3D, .* pyramid5" ""                                   pyramid.msh o.msh
# hexahedra, pyramids on them, tetrahedra
cat > layers.geo <<END
Point(1) = {0, 0, 0}; Point(2) = {1, 0, 0}; Point(3) = {1, 1, 0}; Point(4) = {0, 1, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Transfinite Curve{1, 2, 3, 4} = 3; Transfinite Surface{1}; Recombine Surface{1};
a[] = Extrude {0, 0, 1} { Surface{1}; Layers{2}; Recombine; };
b[] = Extrude {0, 0, 1} { Surface{a[0]}; Layers{2}; QuadTriAddVerts; Recombine; };
END
expect "pyramids beside others"       0 "3D, .* tet4, 8 hex8, [0-9]* pyramid5" ""              layers.geo o.msh
expect "pyramids of second order"     1 "" "elements that Perigal does not know (--order 1 .*pyramid" layers.geo o.msh --order 2
expect "an open surface"              1 "" "cut.stl"                                           cut.stl o.msh
expect "dimension too high"           1 "" "the body has dimension 2; a mesh of dimension 3"   plate.geo o.msh --dim 3
expect "broken geometry"              1 "" "broken.geo: there is no body and no mesh in it: Gmsh says: .*syntax error" broken.geo fresh.msh
expect "no such file"                 1 "" "none.geo: cannot be read"                          none.geo o.msh
[ ! -e fresh.msh ]; k=$?
n=$((n + 1)); [ $k -eq 0 ] && echo "ok $n - a failure leaves no file" || { bad=1; echo "not ok $n - a failure leaves no file"; }
expect "no such folder"               1 "" "nowhere/o.msh: cannot be written"                  plate.geo nowhere/o.msh
expect "name of the output"           2 "" "must end in .msh"                                  plate.geo o.txt
expect "order 3"                      2 "" "--order needs 1 or 2"                              plate.geo o.msh --order 3
expect "size 0"                       2 "" "--size needs a positive length"                    plate.geo o.msh --size 0
expect "unknown option"               2 "" "unknown argument '--fine'"                           plate.geo o.msh --fine
expect "no output"                    2 "" "give a file to read and one to write"              plate.geo
expect "help"                         0 "usage: perigal-mesh" ""                               --help
exit $bad

#!/bin/bash
# test_imports.sh BUILD: files of other programs, of which something is not known, is unusual, or is left out: what is read is right, what is
# passed over is printed by check and at the start of a run.
. "$(dirname "$0")/expect.sh"
cd "$work" || exit 1
# scene FILE REST: a scene of that mesh, or of points
scene() { printf 'mesh: {file: %s}\nmaterials: {a: {youngs_modulus: 1 GPa, poissons_ratio: 0.3}}\nmethod: {integration: gauss, accept_inexact: yes}\n%s\n' "$1" "$2" > scene.yaml; }
has() { local name=$1 p; shift; "$perigal" check scene.yaml > out 2> err; for p in "$@"; do grep -q -- "$p" out || { verdict "$name: $p" 1; return; }; done; verdict "$name" 0; }
nodes='*NODE, NSET=N\n1,0,0\n2,1,0\n3,2,0\n4,0,1\n5,1,1\n6,2,1\n'
held='boundary: [{name: g, set: left, displacement: {x: 0, y: 0}}, {name: t, set: right, displacement: {x: 1 mm}}]'

printf "$nodes"'*ELEMENT,TYPE=CPS4,ELSET=A\n1,1,2,5,4\n*SOLID SECTION,ELSET=A,MATERIAL=M\n1.\n *ELEMENT,TYPE=CPS4,ELSET=B\n2,2,3,6,5\n*MATERIAL,NAME=M\n*ELASTIC\n1000.,.3\n*BOUNDARY\n1,1,2\n*STEP\n*CLOAD\n3,1,1.\n*CLOAD\n6,1,1.\n*END STEP\n' > job.inp
scene job.inp "dimension: 2
$held"
has "an indented keyword is one; cards that are not used are told once each" '2 quad4' 'passed over  *\*MATERIAL' 'passed over  *\*CLOAD, 2 times' 'passed over  *\*BOUNDARY'
"$perigal" run scene.yaml -o r > out 2> err && grep -q 'passed over .*\*MATERIAL' out; verdict "also at the start of a run" $?
"$perigal" check scene.yaml --json | grep -q '"\*CLOAD": 2'; verdict "and as JSON" $?

printf '** a tool\n*\n'"$nodes"'*ELEMENT,TYPE=CPE4,ELSET=A\n1,1,2,5,4,0\n2,2,3,6,5,0\n*SUBMODEL,TYPE=NODE,INPUT=coarse.frd\nA\n*NSET,NSET=TOP\n4,6\n' > job.inp
scene job.inp "dimension: 2
plane: stress
$held"
has "numbers behind the nodes, a lone asterisk, sets but for their case" '2 quad4' 'numbers behind the last node.*2 times' 'set TOP  *of the mesh is not .top.'
strain='warning: elements CPE4 of the mesh are meant for plane strain, and the scene has plane: stress'
has "elements of plane strain in a scene of plane stress" "$strain"
"$perigal" run scene.yaml -o cpe > out 2> err; awk '/ steps, / { exit } 1' out | grep -q "$strain"; verdict "told before the first step as well" $?
sed -i 's/^plane: stress/plane: strain/' scene.yaml; "$perigal" check scene.yaml > out 2> err && ! grep -q CPE4 out; verdict "no word of it in plane strain" $?

printf "$nodes"'11,0,1\n12,1,1\n*ELEMENT,TYPE=CPS4,ELSET=A\n1,1,2,5,4\n*ELEMENT,TYPE=COH2D4,ELSET=COH\n7,4,5,12,11\n*ELSET,ELSET=ALL\n1,7\n' > job.inp
scene job.inp "dimension: 2
$held"
"$perigal" check scene.yaml > out 2> err; [ $? -eq 65 ] && grep -q "line 12: elements of type 'COH2D4' are not known.*(block COH: leave it out by .blocks.)" err; verdict "elements that are not known bar the file" $?
sed -i 's/job.inp/job.inp, blocks: [A]/' scene.yaml
has "unless their block is left out" '1 quad4' 'passed over  *elements COH2D4 of COH'
sed -i 's/COH2D4/CAX4/' job.inp; sed -i 's/, blocks: .A.//' scene.yaml
"$perigal" check scene.yaml > out 2> err; grep -q 'CAX4.*axisymmetric' err && ! grep -q C3D4\' err; verdict "axisymmetric elements are called that" $?

printf '*NODE\n1,0,0,0\n2,1,0,0\n3,0,1,0\n4,1,1,0\n5,0,0,1\n6,1,0,1\n7,0,1,1\n8,1,1,1\n*ELEMENT,TYPE=C3D8,ELSET=SOL\n1,1,2,4,3,5,6,8,7\n*ELEMENT,TYPE=S4,ELSET=SKIN\n2,5,6,8,7\n*SURFACE,NAME=LOAD,TYPE=ELEMENT\nSKIN,SPOS\n*SURFACE,NAME=ODD,TYPE=ELEMENT\nSOL,S9\n' > job.inp
scene job.inp 'dimension: 3
boundary: [{name: g, set: LOAD, displacement: {x: 0, y: 0}}]'
has "the face of a skin is the face of its solid; a surface with a face that is not known bars nothing else" 'set LOAD  *4 points, 1 facets' 'passed over  *surface ODD (element 1, hex8, has no face S9)'

cat > part.msh <<'S'
$MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
2
1 9 "edge"
2 7 "A"
$EndPhysicalNames
$Entities
0 1 1 0
1 0 0 0 0 1 0 1 9 0
1 0 0 0 2 1 0 1 7 1 1
$EndEntities
$PartitionedEntities
2
0
0 2 2 0
11 1 1 1 1 0 0 0 0 1 0 1 9 0
12 2 1 2 1 2 1 0 0 1 1 0 1 7 0
21 2 1 1 1 0 0 0 1 1 0 1 7 0
22 2 1 1 2 1 0 0 2 1 0 1 7 0
$EndPartitionedEntities
$Nodes
1 6 1 6
2 1 0 6
1
2
3
4
5
6
0 0 0
1 0 0
2 0 0
0 1 0
1 1 0
2 1 0
$EndNodes
$Elements
4 4 1 4
1 11 1 1
1 1 4 
1 12 1 1
2 2 5 
2 21 3 1
3 1 2 5 4 
2 22 3 1
4 2 3 6 5 
$EndElements
$NodeData
0
$EndNodeData
S
scene part.msh 'dimension: 2
boundary: [{name: g, set: edge, displacement: {x: 0, y: 0}}]'
has "a partitioned mesh keeps blocks and sets, and gets none from what lies between partitions" 'block A  *2 elements' 'set edge  *2 points, 1 facets' 'passed over  *section \$NodeData'
[ "$(grep -c '^  set ' out)" -eq 1 ]; verdict "no further set" $?

printf 'dimension: 2\nbody: [{add: {box: {low: [0, 0], high: [6, 4]}}}]\nspacing: 1\nmaterials: {a: {youngs_modulus: 1 GPa, poissons_ratio: 0.3, density: 2000}}\nmethod: {force: bond, accept_inexact: yes}\nplatens: [{name: ram, shape: plane, point: [3, 4.5], normal: [0, -1], displacement: {y: -2 mm}}]\nsolver: {kind: verlet, end: 200 us}\noutput: {pictures: []}\n' > scene.yaml
"$perigal" run scene.yaml -o ram --quiet > out 2> err
awk -F, 'NR == 1 { for (k = 1; k <= NF; k++) if ($k ~ /ram.displacement_y/) c = k } END { exit !($c > -0.0020001 && $c < -0.0019999) }' ram/history.csv; verdict "a platen with ramp: linear has gone its way at the end of an explicit run" $?

# ---- a seam: doubled nodes of a mesh are a crack that is open from the start -----------------------------------------------------
printf '*NODE\n' > job.inp
awk 'BEGIN { for (j = 0; j < 3; j++) for (i = 0; i < 5; i++) printf "%d,%d,%d\n", 5*j + i + 1, i, j; for (i = 0; i < 2; i++) printf "%d,%d,1\n", 106 + i, i
    print "*ELEMENT,TYPE=CPS4,ELSET=A"; for (j = 0; j < 2; j++) for (i = 0; i < 4; i++) { a = 5*j + i + 1; b = a + 1; if (j == 1 && i < 2) a += 100; if (j == 1 && i < 1) b += 100; printf "%d,%d,%d,%d,%d\n", 4*j + i + 1, a, b, 5*j + i + 7, 5*j + i + 6 } }' >> job.inp
scene job.inp 'dimension: 2
boundary: [{name: g, set: bottom, displacement: {x: 0, y: 0}}, {name: t, set: top, displacement: {y: 1 mm}}]
output: {gauges: [{name: seam, from: [0, 0.999], to: [0, 1.001]}, {name: joined, from: [4, 0.999], to: [4, 1.001]}], pictures: []}'
has "doubled nodes are faces" 'points  *17, spacing' 'boundary facets 16' 'bonds across slots, gaps and corners of the body are none'
"$perigal" run scene.yaml -o seam --quiet > out 2> err
awk -F, 'NR == 1 { for (k = 1; k <= NF; k++) { if ($k ~ /^seam/) s = k; if ($k ~ /^joined/) j = k } } END { exit !($s > 20 * $j && $j > 0) }' seam/history.csv; verdict "the seam opens, what is joined does not" $?

# ---- Exodus: numbers of blocks; a node set and a side set of one number -----------------------------------------------------------
defects=$OLDPWD/test/defects; [ -d "$defects" ] || defects=$(dirname "$0")/../../defects
if command -v ncgen > /dev/null; then
    ncgen -o block_ids.e "$defects/block_ids.cdl" && ncgen -o set_ids.e "$defects/set_ids.cdl" || exit 1
    cat > scene.yaml <<'S'
dimension: 2
mesh: {file: block_ids.e}
materials: {soft: {youngs_modulus: 1 GPa, poissons_ratio: 0}, hard: {youngs_modulus: 100 GPa, poissons_ratio: 0}}
blocks: [{material: soft, block: 1}, {material: hard, block: 2}]
boundary: [{name: b, set: "1", displacement: {x: 0, y: 0}}, {name: t, set: "2", displacement: {y: 1 mm}}]
output: {gauges: [{name: low, from: [2, 0], to: [2, 1]}, {name: high, from: [2, 1], to: [2, 2]}], pictures: []}
method: {accept_inexact: yes}
S
    "$perigal" run scene.yaml -o ids --quiet > out 2> err
    awk -F, 'NR == 1 { for (k = 1; k <= NF; k++) { if ($k ~ /^low/) l = k; if ($k ~ /^high/) h = k } } END { exit !($h > 8 * $l && $l > 0) }' ids/history.csv; verdict "blocks have the numbers of the file: the upper one is soft" $?
    scene set_ids.e 'dimension: 2
boundary: [{name: g, set: "1", displacement: {x: 0, y: 0}}]'
    "$perigal" check scene.yaml > out 2> err; [ $? -eq 65 ] && grep -q 'boundary.0..set = 1: there is no set of this name' err; verdict "a number that two sets have names neither" $?
else
    verdict "numbers of blocks and sets of Exodus files # SKIP no ncgen (netcdf-bin)" 0
fi

# ---- pyramids: on hexahedra, below tetrahedra, and blocks of them left out -----------------------------------------------------------
printf '$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n9\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 0 0 1\n6 1 0 1\n7 1 1 1\n8 0 1 1\n9 0.5 0.5 1.5\n$EndNodes\n$Elements\n2\n1 5 2 1 1 1 2 3 4 5 6 7 8\n2 7 2 2 1 5 6 7 8 9\n$EndElements\n' > part.msh
scene part.msh 'dimension: 3
boundary: [{name: g, set: bottom, displacement: {x: 0, y: 0, z: 0}}]'
has "a pyramid on a cube" '1 hex8.*1 pyramid5\|1 pyramid5.*1 hex8' 'volume  *1.1666667 m3, surface 6.4142136 m2'
! grep -q ' hang' out; verdict "its base is no surface" $?
sed -i 's/part.msh/part.msh, blocks: [1]/' scene.yaml; has "left out with its block" 'volume  *1 m3, surface 6 m2'
sed 's/^2 7 2 2/2 19 2 2/; s/5 6 7 8 9$/5 6 7 8 9 5 6 7 8 5 6 7 8/' part.msh > quadratic.msh; sed -i 's/part.msh/quadratic.msh/' scene.yaml
has "pyramids of second order as well" 'passed over  *elements pyramid of 13 nodes of 2' 'volume  *1 m3'

# ---- nodes that hang on the faces of larger elements ------------------------------------------------------------------------
printf '*NODE\n1,0,0\n2,2,0\n3,2,2\n4,0,2\n15,2,1\n6,3,0\n7,3,1\n8,3,2\n*ELEMENT,TYPE=CPS4,ELSET=A\n1,1,2,3,4\n2,2,6,7,15\n3,15,7,8,3\n' > job.inp
scene job.inp "dimension: 2
$held"
has "a node that hangs, in the plane" 'warning: 1 node of the mesh, node 15 at (2, 1) m first, hangs on faces'
"$perigal" run scene.yaml -o hang > out 2> err; awk '/ steps, / { exit } 1' out | grep -q 'node 15 at (2, 1) m first'; verdict "told before the first step as well" $?
sed -i 's/^2,2,0$/&\n20,2,0\n30,2,2/; s/^2,2,6,7,15/2,20,6,7,15/; s/^3,15,7,8,3/3,15,7,8,30/' job.inp
has "of another part, whose other nodes are doubled" 'warning: 1 node of the mesh, node 15 at (2, 1) m first, hangs on faces'
printf '*NODE\n1,0,0,0\n2,2,0,0\n3,2,2,0\n4,0,2,0\n5,0,0,2\n6,2,0,2\n7,2,2,2\n8,0,2,2\n11,3,0,0\n12,3,1,0\n13,2,1,0\n14,3,0,2\n15,3,1,2\n16,2,1,2\n17,3,2,0\n18,3,2,2\n*ELEMENT,TYPE=C3D8,ELSET=A\n1,1,2,3,4,5,6,7,8\n2,2,11,12,13,6,14,15,16\n3,13,12,17,3,16,15,18,7\n' > job.inp
scene job.inp "dimension: 3
$held"
has "in space" 'warning: 2 nodes of the mesh, node 13 at (2, 1, 0) m first, hang on faces'
printf "$nodes"'*ELEMENT,TYPE=CPS4,ELSET=A\n1,1,2,5,4\n2,2,3,6,5\n' > job.inp
scene job.inp "dimension: 2
$held"
"$perigal" check scene.yaml > out 2> err && ! grep -q ' hang' out; verdict "none in a mesh that fits" $?
printf '*NODE\n1,0,0\n2,2,0\n3,2,2\n4,0,2\n5,1,0\n6,2.1,1\n7,1,2\n8,0,1\n9,3,0\n10,3,1\n11,2.5,0\n12,3,.5\n13,2.55,1\n14,2.075,.5\n15,3,2\n16,3,1.5\n17,2.5,2\n18,2.075,1.5\n*ELEMENT,TYPE=CPS8,ELSET=A\n1,1,2,3,4,5,6,7,8\n2,2,9,10,6,11,12,13,14\n3,6,10,15,3,13,16,17,18\n' > job.inp
scene job.inp "dimension: 2
$held"
has "a corner on the middle node of a curved edge" 'warning: 1 node of the mesh, node 6 at (2.1, 1) m first, hangs on faces'

# ---- tables of points: semicolons, decimal commas, numbers of the points; keys in spacings beside graded points --------------------------
table() { printf 'dimension: 2\nthickness: 1 mm\npoints: p.csv\nmaterials: {a: {youngs_modulus: 1 GPa, poissons_ratio: 0.3}}\nmethod: {integration: nodal, accept_inexact: yes}\n%s\n' "$held" > scene.yaml; }
awk 'BEGIN { print "id;x [mm];y [mm];volume [mm3]"; for (j = 0; j < 5; j++) for (i = 0; i < 5; i++) printf "%d;%d,5;%d,5;1\n", 7 + i + 5*j, i, j }' > p.csv
table; has "semicolons, decimal commas and an id column" 'points  *25, spacing' 'x 0.0005 to 0.0045 m'
sed 's/,5/.5/g; s/;/,/g' p.csv > q.csv; cp q.csv p.csv
has "an id column among commas" 'points  *25, spacing' 'x 0.0005 to 0.0045 m' 'passed over  *column id$'
"$perigal" run scene.yaml -o ids_run > out 2> err; grep -q 'passed over  *column id$' out; verdict "passed over also at the start of a run" $?
"$perigal" check scene.yaml --json | grep -q '"columns_passed_over": "id"'; verdict "and as JSON" $?
sed -i '1s/^id,/Label,/' p.csv; has "under another name" 'passed over  *column Label$'
printf '*NODE\n' > job.inp
awk 'BEGIN { split ("0 .1 .2 .3 .4 .5 1 1.5 2 2.5", x, " "); for (j = 0; j < 6; j++) for (i = 1; i <= 10; i++) printf "%d,%s,%g\n", 10*j + i, x[i], .2 * j
    print "*ELEMENT,TYPE=CPS4,ELSET=A"; for (j = 0; j < 5; j++) for (i = 1; i < 10; i++) printf "%d,%d,%d,%d,%d\n", 10*j + i, 10*j + i, 10*j + i + 1, 10*j + i + 11, 10*j + i + 10 }' >> job.inp
scene job.inp "dimension: 2
$held
failure: {criterion: energy_release, fracture_energy: 10}
cracks: [{from: [0, 0.5], to: [0.25, 0.5]}]
solver: {kind: static, facet: 1 spacing}"
has "a facet in spacings beside graded points" 'warning: line 8: solver.facet = 1 spacing counts the mean, 0.[0-9]* m, and the points are 0.[0-9]* to 0.[0-9]* m apart'
sed -i 's/facet: 1 spacing/facet: 0.1/' scene.yaml; "$perigal" check scene.yaml > out 2> err; ! grep -q 'counts the mean' out; verdict "a length of its own is none of it" $?

# pictures: libraries that cannot be loaded, a section through no points
mkdir lib; echo broken > lib/libcairo.so.2
printf 'dimension: 2\nbody: [{add: {box: {low: [0, 0], high: [6, 4]}}}]\nspacing: 1\nmaterials: {a: {youngs_modulus: 1 GPa, poissons_ratio: 0.3}}\n%s\n' "$held" > scene.yaml
LD_LIBRARY_PATH=$PWD/lib "$perigal" run scene.yaml -o bare > out 2> err; code=$?
[ $code -eq 0 ] && grep -q '"pictures could not be drawn, damage.png among them: ' bare/report.json && grep -q '"outcome": "done"' bare/report.json && [ ! -e bare/checkpoint.nc ]
verdict "without the library of pictures a run is done, with a warning" $?
finish

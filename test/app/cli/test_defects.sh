#!/bin/bash
# test_defects.sh BUILD: the scenes of test/defects, each of which once gave a wrong answer without a word, by `perigal run`: the right answer
# within a limit, or a refusal whose message names the cause. Their first lines say what each showed.
. "$(dirname "$0")/expect.sh"
cd "$(dirname "$0")/../../defects" || exit 1
out=$work/result
# run NAME CODE PATTERN-OF-STDOUT PATTERN-OF-STDERR SCENE SETTINGS...: the results in $out. Progress is on stderr.
run() {
    local name=$1 code=$2 told=$3 err=$4 scene=$5 set=(); shift 5
    for s in "$@"; do set+=(--set "$s"); done
    rm -rf "$out"
    expect "$name" "$code" "$told" "$err" run "$scene" -o "$out" --threads 1 "${set[@]}"
}
# near NAME VALUE WANTED SHARE: |VALUE - WANTED| <= SHARE * |WANTED|
near() { awk -v a="$2" -v b="$3" -v t="$4" 'BEGIN { exit !(a != "" && (a - b) ^ 2 <= (t * b) ^ 2) }'; verdict "$1 ($2)" $?; }
entry() { sed -n "s/^ *\"$1\": \([-+0-9.e]*\),*$/\1/p" "$out/report.json" | head -n 1; }
column() { awk -F, -v name="$1" 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == name) at = i } NR > 1 { print $at }' "$out/history.csv"; }

# ---- a bond without a length ---------------------------------------------------------------------------------------------
first() { awk -F, 'NR == 2 { printf "%.9g", $2 }' "$out/events.csv"; }
body() { echo "body=[{add: {box: {low: [$1, $2], high: [$3, $4]}}}]"; }
mirrored='boundary=[{name: t, set: bottom, displacement: {y: -20 mm}}, {name: b, set: top, displacement: {x: 0, y: 0}}]'
run "middle Gauss points on nodes: runs" 0 '1 steps, 1 events' '1 event, load factor 0.45' zero_length_bond.yaml
reference=$(first)
near "middle Gauss points on nodes: first break" "$reference" 0.449 0.01
for place in '-2 0 -1 1' '7 3 8 4' '1000 -1000 1001 -999' '-0.3183 0.1 0.6817 1.1'; do
    run "moved to $place: runs" 0 '*' '*' zero_length_bond.yaml "$(body $place)"; near "moved to $place: the same break" "$(first)" "$reference" 1e-6
done
run "mirrored: runs" 0 '*' '*' zero_length_bond.yaml "$mirrored"; near "mirrored: the same break" "$(first)" "$reference" 1e-9
run "five Gauss points: runs" 0 '*' '*' zero_length_bond.yaml method.gauss_points=5; near "five Gauss points: first break" "$(first)" 0.449 0.01

# ---- voids between irregular points ------------------------------------------------------------------------------------
run "voids between points: told"   0 'points looked at have voids beside them, 0.71 spacings away .* (body: beside points:)' '*' voids.yaml
run "shapes as the surface: the crack runs through"   0 'the body has separated' '*' voids.yaml 'body=[{add: {box: {low: [0, 0], high: [40 mm, 12 mm]}}}]'
! grep -q 'voids beside them' "$work/out"; verdict "shapes as the surface: no word of voids" $?

# ---- a hole within 1.5 spacings of a path -----------------------------------------------------------------------------------
aside='went aside into the surface since it came within [01][.0-9]* spacings of it (1.5 are needed to judge it): refine to decide'
run "a hole beside a path: told"   0 "warning: crack tip 1 at (0.9.*, 0.05.*) m $aside" '*' hole_beside_path.yaml
grep -q "$aside" "$out/report.json"; verdict "in the report as well" $?
run "a hole ahead: entered"        0 'no open tip any more' '*' hole_beside_path.yaml 'body=[{add: {box: {low: [0, -0.5], high: [2, 0.5]}}}, {subtract: {disk: {center: [1, 0.01], radius: 0.15}}}]'
! grep -q 'went aside' "$work/out"; verdict "without a word of it" $?

# ---- points that do not see each other, and what hangs on nothing --------------------------------------------------------
run "points apart: refused with the point"   65 '' 'method.horizon = 2.2 spacing: point 19 at (0.868337) m sees 1 points, too few .* a column spacing' cloud_apart.yaml
[ ! -e "$out" ]; verdict "points apart: no results" $?
run "a horizon that joins them: measured"    65 '*' 'method: under uniform stress xx the displacement is off by [0-9.]* %; most of all at (.*) m; points without cells are integrated by their volumes' \
    cloud_apart.yaml method.horizon='4 spacing'
run "two squares: the loose one stays"         0 'warning: the body is in 2 parts that no bond joins' '*' points_apart.yaml
run "loaded it is refused and named"          65 '*' ':9:1: boundary: a loose part of the body, .* is held by nothing: it is free to move along x (.* N)' points_apart.yaml \
    'sets.far.where="x > 1.1"' 'boundary[2]={name: pull, set: far, body_force: {x: 1 MN/m3}}'
run "points alone: told"                      0 'warning: the cracks leave 1 point without a bond, such as that at (0.5, 0.5) m' '*' points_alone.yaml
grep -q 'warning: 2 points lie on a pre-crack and lose all bonds to both sides' "$work/out" && grep -q '2 points lie on a pre-crack' "$out/report.json" \
    && grep -q 'the cracks leave 1 point' "$out/report.json"
verdict "points alone, points on a crack: told by the run and in report.json" $?

# Points of a file nearly at one place: a bond needs a length, the scene is at fault.
{ cat points_apart.csv; tail -n 1 points_apart.csv | awk -F, '{ printf "%.12g,%s,%s\n", $1 + 1e-8, $2, $3 }'; } > "$work/twins.csv"
run "points nearly at one place: a fault that names both" 65 '' 'method.force = bond: bond: points [0-9]* and [0-9]* coincide, at (.*) m: a bond needs a length' points_apart.yaml \
    "points=$work/twins.csv" 'method={force: bond, horizon: 3.015 spacing}'
sed -e '/^thickness/d' -e 's/\[1, 1\]/[1, 2]/' points_alone.yaml > "$work/bare.yaml"
run "where the body lies, and a thickness that nobody gave" 0 '^  body x 0 to 1 m, y 0 to 2 m; thickness 1 m (the scene gives none)$' '*' "$work/bare.yaml"
run "a spacing larger than the body: told"    0 'warning: the spacing, 3 m, is larger than the body, which measures 1 m along x' '*' "$work/bare.yaml" spacing=3 cracks='[]'
run "a crack through the whole body: told"    0 'warning: the cracks cut the body into 2 parts: ' '*' "$work/bare.yaml" cracks='[{from: [-1, 0.55], to: [2, 0.55]}]'

# ---- unloading -----------------------------------------------------------------------------------------------------------
run "down to zero load: runs"                 0 '4 steps, 0 events' '100.0 %, step 4, load factor 1' unloading.yaml
column 't.force_y [N]' > "$work/force"
near "the force at half the way"  "$(sed -n 2p "$work/force")" 1018643 0.01
near "it falls as it rose"        "$(sed -n 3p "$work/force")" "$(sed -n 1p "$work/force")" 1e-9
awk 'NR == 2 { top = $1 } NR == 4 { exit !($1 * $1 <= (1e-12 * top) ^ 2) }' "$work/force"; verdict "it ends at zero" $?
run "through zero: runs"                      0 '*' '*' unloading.yaml 'boundary[0].table=[[0, 0], [0.25, 1], [1, -1]]' solver.steps=8
column 't.force_y [N]' > "$work/force"
near "as far to the other side"   "$(sed -n 8p "$work/force")" "-$(sed -n 2p "$work/force")" 1e-9

# ---- supports --------------------------------------------------------------------------------------------------------------
run "contradicting supports: a fault with both lines" 65 '' ':9:40: boundary\[1\].displacement.x = 1 mm: contradicts boundary\[0\].displacement.x (line 8)' contradiction.yaml
run "equal supports are fine"                 0 '*' '*' contradiction.yaml 'boundary[1].displacement.x=0' 'boundary[2].displacement.y=1 mm'
for method in '{approximation: pddo}' '{approximation: nosb}' '{approximation: rkpm}' '{approximation: pddo, integration: consistent}' '{approximation: rkpm, integration: nodal}' \
              '{force: bond, accept_inexact: yes}' '{force: lps}'; do
    run "nothing holds the body, $method" 65 'warning: nothing holds the body along x' 'boundary: nothing holds the body: it is free to move along x (' nothing_holds.yaml "method=$method"
done

# ---- discretisations that do not carry a linear field ----------------------------------------------------------------------
run "nosb, horizon 2.5 spacings: warned"      0 'warning: under uniform stress xx the displacement is off by 15 %; use integration: consistent' '*' nosb_horizon.yaml method.horizon='2.5 spacing'
for horizon in 3 4.5 6; do
    run "nosb, horizon $horizon spacings: refused" 65 'warning: under uniform stress' ': method: under uniform stress .* the displacement is off by .* %; most of all at (.*) m; use integration: consistent' \
        nosb_horizon.yaml "method.horizon=$horizon spacing"
done
run "nosb, wide horizon, consistent and nitsche: runs" 0 'against the reference: displacement: L2 [0-9.]*e-1[0-9]' '*' nosb_horizon.yaml \
    'method={approximation: nosb, integration: consistent, essential: nitsche, horizon: 4.5 spacing}'
run "degenerate points: refused with how many" 65 'warning: under uniform stress' 'method.horizon = 1.01 spacing: 400 of 900 evaluation points, such as that at (.*) m, see too few points' all_degenerate.yaml
for method in 'approximation: pddo' 'integration: consistent' 'integration: nodal'; do
    run "degenerate points, $method: refused" 65 '*' 'horizon = 1.01 spacing: [0-9]* of [0-9]* evaluation points, such as that at (.*) m, see too few points' all_degenerate.yaml \
        "method={basis: quadratic, horizon: 1.01 spacing, $method}"
done
run "nodal integration of moved points: refused" 65 'warning: under uniform stress' 'the displacement is off by 9[0-9] %' all_degenerate.yaml perturb.amount=0.3 \
    'method={approximation: pddo, integration: nodal}'
run "nosb, nodal, moved points: warned"       0 'warning: under uniform stress xx the displacement is off by 1[0-9] %' '*' all_degenerate.yaml perturb.amount=0.3 \
    'method={approximation: nosb, integration: nodal, horizon: 2.5 spacing}'
for horizon in 1.1 1.2 1.3 1.4; do
    run "quadratic basis, horizon $horizon spacings: right" 0 'against the reference: displacement: L2 [0-9.]*e-\(0[4-9]\|1\)' '*' all_degenerate.yaml "method.horizon=$horizon spacing"
    awk -v e="$(entry patch_error)" 'BEGIN { exit !(e > 0 && e < 0.01) }'; verdict "its patch error stands in report.json ($(entry patch_error))" $?
done

# ---- what a crack in space leaves ----------------------------------------------------------------------------------------
run "the last corners of a block: told"       0 'warning: the cracks that grew have dissipated [0-9.]* times what their area takes' '*' last_corner.yaml
finish

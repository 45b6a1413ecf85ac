#!/bin/bash
# test_methods.sh BUILD: one scene by every force and every solver, one key changed at a time. Each pair either runs to its end, in equilibrium
# where it says so, or is refused with the reason before anything is computed. Galerkin forces may stiffen when single bonds break; explicit ones then end with that.
. "$(dirname "$0")/expect.sh"
cd "$(dirname "$0")" || exit 1
number() { sed -n "s/^ *\"$2\": \([-+0-9.e]*\),*$/\1/p" "$1/report.json" | head -n 1; }
at_most() { awk -v a="$1" -v b="$2" 'BEGIN { exit !(a != "" && a + 0 <= b + 0) }'; }

names_of() { "$perigal" list | awk -v key="$1" '/^[^ ]/ { on = $1 == key; next } on { print $1 }'; }
forces=$(names_of method.force) solvers=$(names_of solver.kind)
[ -n "$forces" ] && [ -n "$solvers" ]; verdict "the program lists its forces and solvers" $?
# in short size what follows the table of all pairs goes without the solvers that take longest
some=${solvers/newmark/} stable_by=verlet wide='1.6666667 mm'; [ "$PERIGAL_TEST_SIZE" = long ] && some=$solvers stable_by='verlet central relax' wide='1.25 mm'

# pair NAME FORCE SOLVER SETTINGS...
pair() {
    local name=$1 force=$2 solver=$3 folder=$work/$2_$3_$n code good=0 set=(); shift 3
    for s in "$@"; do set+=(--set "$s"); done
    "$perigal" run methods.yaml -o "$folder" --quiet --threads 1 --set method.force="$force" --set solver.kind="$solver" "${set[@]}" > "$work/out" 2> "$work/err"
    code=$?
    case $code in
    0)  broken=$(number "$folder" broken) dof=$(number "$folder" dofs)
        [ -s "$folder/result.e" ] && [ -s "$folder/history.csv" ] || good=1
        ! grep -qiw 'nan\|inf' "$folder/history.csv" || good=1
        [ "${dof:-0}" -gt 0 ] && [ "${broken:-0}" -gt 0 ] || good=1
        case $solver in static|newmark) at_most "$(number "$folder" residual_max)" 1e-8 && [ "$(number "$folder" bonds_over_limit)" = 0 ] || good=1 ;; esac
        verdict "$name: runs, $broken bonds broken" $good ;;
    65) grep -q '\(solver\|method\|materials\|failure\)\.[a-z_.]* ' "$work/err" && [ "$(wc -c < "$work/err")" -gt 60 ] && [ ! -e "$folder/result.e" ] || good=1
        verdict "$name: refused: $(head -n 1 "$work/err" | cut -c1-150)" $good ;;
    70) [ "$force" = galerkin ] && grep -q '^perigal: .* is refused: .*; try ' "$work/err" && [ -s "$folder/result.e" ] || good=1
        verdict "$name: ends: $(sed 's/^.* is refused: //' "$work/err" | head -n 1 | cut -c1-150)" $good ;;
    *)  verdict "$name: exit code $code" 1 ;;
    esac
}
# shape functions on fewer points, as their every break costs most; in motion less of the load breaks some bonds, the whole of it nearly all
for force in $forces; do for solver in $solvers; do
    case "$force $solver" in 'galerkin newmark') less=('spacing=1.25 mm' 'boundary[0].displacement.y=8 um' 'boundary[1].displacement.y=-8 um' 'solver.end=25 us') ;; galerkin*) less=(spacing="$wide") ;; *) less=() ;; esac
    pair "$force x $solver" "$force" "$solver" "${less[@]}"
done; done
# a Poisson's ratio beyond that of bonds, with the dilatation that bears the difference
for solver in $some; do pair "gmpd x $solver, volumetric" gmpd $solver method.volumetric=on materials.glass.poissons_ratio=0.4; grep -q runs <<< "$latest" || bad=1; done
pair "gmpd x static, more than bonds bear" gmpd static materials.glass.poissons_ratio=0.4; grep -q 'refused.*0.333333' <<< "$latest" || bad=1
# points that die by their energy instead of bonds that break by their stretch
energy='failure={criterion: node_energy, fracture_energy: 0.4, exclude: [top_grip, bottom_grip]}'
for solver in $some; do pair "fcbm x $solver, energies of points" fcbm "$solver" "$energy"; grep -q runs <<< "$latest" || bad=1; done
pair "bond x static, energies of points, fixed steps" bond static "$energy" 'solver={stepping: fixed, steps: 5, break: all}'; grep -q runs <<< "$latest" || bad=1
# points that turn: at a Poisson's ratio below the bound bonds bear shear and bending, which break them too
turning=(materials.glass.poissons_ratio=0.2 'failure={criterion: beam_limits, fracture_energy: 400 J/m2, exclude: [top_grip, bottom_grip]}')
for solver in $some; do pair "gmpd x $solver, points that turn" gmpd "$solver" "${turning[@]}"; grep -q runs <<< "$latest" || bad=1; done
# what was refused above for its time step
for solver in $stable_by; do
    # fewer points, which bear larger steps; motion that comes to rest takes the most steps
    case $solver in relax) stable=('solver.dt=50 ns' 'spacing=2 mm') ;; *) stable=('solver.dt=30 ns' 'spacing=1.25 mm') ;; esac
    pair "galerkin x $solver, a stable time step" galerkin $solver "${stable[@]}"; grep -q 'runs\|ends' <<< "$latest" || bad=1
done
finish

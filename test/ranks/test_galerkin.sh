#!/bin/bash
# test_galerkin.sh BUILD: equilibria by shape functions of ranks that divide the body: fields, rows and broken bonds of one process, for all integrations
# and approximations, with a crack along the boundary of two parts.
. "$(dirname "$0")/ranks.sh"

# equal NAME RANKS LEAST ARGUMENTS...: at least so many bonds break, the same ones at the same loads, with the same fields and rows
equal() {
    local name=$1 r=$2 least=$3; shift 3
    alone galerkin.yaml -o "$work/one" --force "$@"; verdict "$name: one process" $?
    [ "$(wc -l < "$work/one/events.csv")" -gt "$least" ]; verdict "$name: at least $least bonds break" $?
    rm -rf "$work/some"
    ranks "$r" galerkin.yaml -o "$work/some" "$@"; verdict "$name: $r ranks" $?
    grep -q '"division": "subdomains"' "$work/some/report.json"; verdict "$name: they divide the body" $?
    python3 fields.py 1e-9 "$work/one/result.e" "$work/some/result.e" > "$work/why" 2>&1; verdict "$name: the same fields on $r ranks" $?
    alike 1e-8 "$work/one" "$work/some" history.csv residual moment; verdict "$name: the same rows on $r ranks" $?
    alike 1e-7 "$work/one" "$work/some" events.csv; verdict "$name: the same bonds on $r ranks" $?
}
equal gauss 2 70
equal consistent 3 100 --set method.integration=consistent
equal nodal 2 20 --set method.integration=nodal --set failure.tensile_strength='6 MPa'
equal pddo 4 20 --set method.approximation=pddo
equal nosb 2 10 --set method.approximation=nosb --set method.integration=nodal --set failure.tensile_strength='6.5 MPa'
equal 'nu 0.45' 2 10 --set plane=strain --set materials.rock.poissons_ratio=0.45 --set failure.tensile_strength='11 MPa'
finish

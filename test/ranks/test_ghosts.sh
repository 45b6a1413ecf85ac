#!/bin/bash
# test_ghosts.sh BUILD: ranks hold as wide a layer of ghosts as the method sees, and forces by transforms of each rank's own points are those of one
# process: nothing of a convolution reaches further than the bonds do.
. "$(dirname "$0")/ranks.sh"

# equal NAME SCENE BROKEN ARGUMENTS...: at least so many events; the same rows, bonds and fields
equal() {
    local name=$1 scene=$2 broken=$3 r; shift 3
    alone "$scene" -o "$work/one" --force "$@"; verdict "$name: one process" $?
    [ "$(wc -l < "$work/one/events.csv")" -gt "$broken" ]; verdict "$name: more than $broken bonds break" $?
    for r in $numbers; do
        rm -rf "$work/some"
        ranks "$r" "$scene" -o "$work/some" "$@" && alike 1e-9 "$work/one" "$work/some" events.csv; verdict "$name: the same bonds on $r ranks" $?
        alike 1e-9 "$work/one" "$work/some" history.csv $out; verdict "$name: the same rows on $r ranks" $?
        python3 -S fields.py 1e-9 "$work/one/result.e" "$work/some/result.e" > "$work/why" 2>&1; verdict "$name: the same fields on $r ranks" $?
    done
}
steel=(--set 'materials.steel.youngs_modulus=192 GPa')
energy=(--set 'failure={criterion: node_energy, fracture_energy: 2 kJ/m2}')
# without anything that breaks: surface corrections look at the families of both ends
sed -e '/^failure/d' -e '/^  tips:/,/"y >/d' -e 's/, stop: .*}/}/' outputs.yaml > "$work/sound.yaml"
numbers=3 out=
for correction in product volume; do
    for force in bond gmpd; do
        case $force-$correction in bond-volume|gmpd-product) [ "$PERIGAL_TEST_SIZE" = long ] || continue ;; esac
        equal "$force, $correction" "$work/sound.yaml" 0 "${steel[@]}" --set method.force=$force --set materials.steel.poissons_ratio=0.2 \
              --set method.surface_correction=$correction --set solver.time_steps=80
    done
done
equal "points that die by their energy, corrected" outputs.yaml 1000 "${steel[@]}" --set method.surface_correction=product "${energy[@]}"
numbers=3
[ "$PERIGAL_TEST_SIZE" = long ] && numbers='2 3 4'
[ "$PERIGAL_TEST_SIZE" != long ] || equal "fcbm" outputs.yaml 1000 "${steel[@]}" --set method.force=fcbm "${energy[@]}"
equal "fcbm, stretch" outputs.yaml 1000 "${steel[@]}" --set method.force=fcbm
"$perigal" check outputs.yaml "${steel[@]}" --set method.force=fcbm | grep -q 'summed by fft'; verdict "that was by transforms" $?
equal "fcbm, finite stretch is summed by bonds" outputs.yaml 1000 "${steel[@]}" --set method.force=fcbm --set method.evaluation=auto --set method.stretch=finite
numbers=2 out=moment                                   # about the middle: zero but for rounding
[ "$PERIGAL_TEST_SIZE" = long ] && numbers='2 4'
equal "fcbm in space" block.yaml 100 --set method.force=fcbm
finish

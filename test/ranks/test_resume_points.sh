#!/bin/bash
# test_resume_points.sh BUILD: runs of ranks on points that are no lattice - of a file, of a mesh, moved off a lattice - are interrupted and go on
# among as many ranks and among fewer, to the files of one process.
. "$(dirname "$0")/ranks.sh"
. ./interrupt.sh
cp ./*.yaml "$work/"
python3 scattered.py 2 20 > "$work/cloud.csv"
python3 meshed.py 20 > "$work/mesh.inp"
sed '/^body:/,/^spacing/c mesh: {file: mesh.inp, unit: mm}' galerkin.yaml > "$work/mesh.yaml"

# goes_on NAME ROWS BROKEN SCENE ARGUMENTS...: interrupted after so many rows; at least so many bonds break
goes_on() {
    local name=$1 rows=$2 broken=$3 r; shift 3
    alone "$@" "${often[@]}" -o "$work/one" --force && [ "$(wc -l < "$work/one/events.csv")" -gt "$broken" ]; verdict "$name: one process, more than $broken bonds" $?
    rm -rf "$work/some"
    begin "$rows" "$work/some" "$@" && kill -USR1 $run; ended
    [ $code -eq 130 ] && grep -q 'continue with: mpirun -n 3' "$work/err"; verdict "$name: three ranks are interrupted" $?
    for r in 3 2; do
        rm -rf "$work/moved"; cp -r "$work/some" "$work/moved"
        ranks "$r" "$@" "${often[@]}" -o "$work/moved" --resume && alike 1e-7 "$work/one" "$work/moved" events.csv $rough \
            && alike 1e-8 "$work/one" "$work/moved" history.csv residual force_x displacement_x moment && counted "$work/one" "$work/moved" \
            && python3 -S fields.py 1e-8 "$work/one/result.e" "$work/moved/result.e" > "$work/why" 2>&1
        verdict "$name: $r go on" $?
    done
}
rough=
goes_on "points of a file, explicit" 20 20 "$work/cloud.yaml" --set solver.time_steps=600 --set output.at.rows=100
goes_on "a mesh at rest" 1 20 "$work/mesh.yaml" --set failure.tensile_strength='6.3 MPa' --set solver.steps=6
rough=utilisation                                      # of rounds that one process solves roughly
goes_on "a perturbed lattice in motion" 1 10 "$work/galerkin.yaml" --set perturb.amount=0.25 --set materials.rock.density='2500 kg/m3' --set output.fields='[displacement, velocity, damage]' \
    --set output.at.levels=2 --set 'solver={kind: newmark, dt: 1e-5 s, time_steps: 4, tolerance: 1e-11, division: subdomains}' \
    --set 'boundary=[{name: left, set: left, velocity: {x: -0.1 m/s, y: 0}}, {name: right, set: right, velocity: {x: 0.1 m/s, y: 0}}]'
finish

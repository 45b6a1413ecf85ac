#!/bin/bash
# test_motion.sh BUILD: Newmark's method and relaxation on ranks that divide the body: the same bonds break in the same steps as in one process, rows and
# fields are the same.
. "$(dirname "$0")/ranks.sh"

# equal NAME LEAST SCENE NUMBERS ARGUMENTS...: with at least so many broken bonds
equal() {
    local name=$1 least=$2 scene=$3 numbers=$4 r; shift 4
    alone "$scene" -o "$work/one" --force "$@"; verdict "$name: one process" $?
    [ "$(wc -l < "$work/one/events.csv")" -gt "$least" ]; verdict "$name: at least $least bonds break" $?
    for r in $numbers; do
        rm -rf "$work/some"
        ranks "$r" "$scene" -o "$work/some" "$@" && alike 1e-8 "$work/one" "$work/some" events.csv $rough
        verdict "$name: the same bonds on $r ranks" $?
        # sums of forces that are zero but for rounding have no size of their own
        alike 1e-8 "$work/one" "$work/some" history.csv residual force_x displacement_x moment; verdict "$name: the same rows on $r ranks" $?
        python3 -S fields.py 1e-9 "$work/one/result.e" "$work/some/result.e" > "$work/why" 2>&1; verdict "$name: the same fields on $r ranks" $?
        counted "$work/one" "$work/some"; verdict "$name: as many events and iterations on $r ranks" $?
    done
}
long() { [ "$PERIGAL_TEST_SIZE" = long ]; }
rough=                                                 # columns of events.csv that are known less well
all=4 some=3 few=2 events=2 steps=4 least=10
[ "$PERIGAL_TEST_SIZE" = long ] && all='2 3 4' some='2 3 4' few='2 3' events=4 steps=5 least=40
equal "Newmark, bond" 10 motion.yaml "$all"
grep -q '"preconditioner": "jacobi"' "$work/some/report.json"; verdict "in small steps the diagonal does" $?
large=(--set solver.dt="12e-6 s" --set output.at.levels=1 --set solver.time_steps=5)
equal "Newmark, large steps" 3 motion.yaml "$some" "${large[@]}" --set 'boundary[0].velocity.y=4 m/s' --set 'boundary[1].velocity.y=-4 m/s'
grep -q 'multilevel' "$work/some/report.json" && grep -q '"preconditioners": [12],' "$work/some/report.json"; verdict "in large ones a cycle that is kept from step to step" $?
damped=(--set solver.alpha=-0.1 --set solver.rayleigh.mass='1000 1/s' --set solver.rayleigh.stiffness='1e-8 s')
long && equal "Newmark, lps, damped" 4 motion.yaml "$some" "${damped[@]}" --set method.force=lps --set materials.steel.poissons_ratio=0.2 \
      --set failure.critical_stretch=0.0185
equal "motion where growth goes on by itself" 40 ties.yaml 2 --set solver.max_events=5 --set solver.on_instability=dynamic
grep -q '"motion_time": [1-9]' "$work/some/report.json"; verdict "it was in motion" $?

# shape functions; in rounds of breaking one process is content with rougher equilibria, whose utilisations are those of the same bonds
shapes=(--set 'solver={kind: newmark, dt: 1e-6 s, time_steps: 11, tolerance: 1e-11, division: subdomains}' --set materials.rock.density='2500 kg/m3'
        --set 'boundary=[{name: left, set: left, velocity: {x: -0.5 m/s, y: 0}}, {name: right, set: right, velocity: {x: 0.5 m/s, y: 0}}]'
        --set output.fields='[displacement, velocity, damage]' --set output.at.levels=2)
rough=utilisation
long && equal "Newmark, shape functions, nodal" 10 galerkin.yaml "$all" "${shapes[@]}" --set method.integration=nodal
equal "Newmark, shape functions, large damped steps" $least galerkin.yaml "$some" "${shapes[@]}" "${damped[@]}" --set solver.dt='1e-5 s' --set solver.time_steps=$steps \
      --set solver.preconditioner=multilevel \
      --set 'boundary[0].velocity.x=-0.1 m/s' --set 'boundary[1].velocity.x=0.1 m/s'
grep -q '"preconditioner": "finite elements' "$work/some/report.json"; verdict "by finite elements" $?
# one bond a round, wide supports: of polynomials of N each solve takes a hundred iterations of sixty messages; a small body is factored by every rank
equal "Newmark, pddo, large steps" 10 galerkin.yaml "$few" "${shapes[@]}" --set method.approximation=pddo --set method.horizon='2.5 spacing' \
      --set spacing='2.5 mm' --set solver.break=worst --set solver.dt='1e-5 s' --set solver.time_steps=2 --set 'boundary[0].velocity.x=-0.2 m/s' \
      --set 'boundary[1].velocity.x=0.2 m/s'
grep -q 'unknowns on every rank' "$work/some/report.json"; verdict "by a factor of all ranks" $?
python3 -c 'import json, sys; r = json.load(open(sys.argv[1])); sys.exit(r["cg_iterations"] > 12 * r["solves"])' "$work/some/report.json"; verdict "in few iterations" $?
equal "shape functions in motion where growth goes on by itself" 5 galerkin.yaml 2 --set materials.rock.density='2500 kg/m3' \
      --set "solver={kind: static, stepping: event, max_events: $events, on_instability: dynamic, tolerance: 1e-11, division: subdomains}" \
      --set 'cracks=[{from: [-30 mm, 0.1 mm], to: [3 mm, 0.1 mm]}]' --set output.gauges=[] --set output.at.levels=1 \
      --set 'boundary=[{name: bottom, set: bottom, displacement: {x: 0, y: -10 um}}, {name: top, set: top, displacement: {x: 0, y: 10 um}}]'
grep -q '"motion_time": [1-9]' "$work/some/report.json"; verdict "it was in motion" $?
if [ "$PERIGAL_TEST_SIZE" = long ]; then
    equal "Newmark, shape functions, Gauss" 40 galerkin.yaml "$some" "${shapes[@]}"
    equal "Newmark, shape functions, consistent" 40 galerkin.yaml "$some" "${shapes[@]}" --set method.integration=consistent
    equal "Newmark, interpolating shape functions" 10 galerkin.yaml "$some" "${shapes[@]}" --set method.approximation=nosb --set method.integration=nodal
fi
rough=

equal "adr" 20 relaxed.yaml "$all"
equal "relax, bonds that break while it moves" 20 relaxed.yaml "$some" --set solver.kind=relax --set solver.break=passing
long && equal "relax, no stage is held" 10 relaxed.yaml "$some" --set solver.kind=relax --set solver.hold=off --set solver.stages=300
long && equal "adr, lps, a traction" 10 relaxed.yaml "$some" --set method.force=lps --set materials.steel.poissons_ratio=0.2 \
      --set 'boundary[0]={name: bottom, set: grip_bottom, displacement: {x: 0, y: 0}}' \
      --set 'boundary[1]={name: side, set: right, depth: 1 spacing, traction: {x: 1 GPa, y: 500 MPa}}'
finish

#!/bin/bash
# test_scenes.sh BUILD: scenes of data/, coarse, on several ranks (long: on 1 to 4) against the plain program: the same fields to 1e-9, the same bonds broken at the
# same loads.
. "$(dirname "$0")/ranks.sh"
data=../../data

# same SCENE LEAST EVENTS-COLUMNS-LEFT-OUT ARGUMENTS...: with at least so many broken bonds
same() {
    local scene=$1 least=$2 out=$3 r name; shift 3
    name=${scene%/scene.yaml}
    alone "$data/$scene" -o "$work/one" --force "$@"; verdict "$name: one process" $?
    [ "$(wc -l < "$work/one/events.csv")" -gt "$least" ]; verdict "$name: at least $least bonds break" $?
    for r in $numbers; do
        rm -rf "$work/some"
        ranks "$r" "$data/$scene" -o "$work/some" "$@"; verdict "$name: $r ranks" $?
        alike 1e-9 "$work/one" "$work/some" events.csv; verdict "$name: the same bonds at the same loads on $r ranks" $?
        alike 1e-9 "$work/one" "$work/some" history.csv residual $out; verdict "$name: the same rows on $r ranks" $?
        python3 -S fields.py 1e-9 "$work/one/result.e" "$work/some/result.e" > "$work/why" 2>&1
        verdict "$name: the same fields on $r ranks" $?
    done
}
spacing='5 mm'; [ "$PERIGAL_TEST_SIZE" = long ] && spacing='4 mm'
# on NUMBERS: these, in the long test all
on() { numbers=$1; [ "$PERIGAL_TEST_SIZE" = long ] && numbers='1 2 3 4'; }
# moments about the centre of what is pulled there are zero but for rounding
on 4
same cui_disk_plane/scene.yaml 20 moment --set spacing='5 mm' --set solver.max_events=10
on 3
[ "$PERIGAL_TEST_SIZE" != long ] || same cui_disk_10/scene.yaml 20 moment --set spacing='5 mm' --set solver.end='320 us' --set solver.dt='8 us'
on 2
same l_panel/scene.yaml 20 moment --set spacing='25 mm' --set solver.max_events=12
numbers=3
[ "$PERIGAL_TEST_SIZE" = long ] && numbers='2 3 4'
same l_panel/scene.yaml 20 moment --set spacing='25 mm' --set solver.max_events=12 --set solver.division=subdomains
grep -q '"division": "subdomains"' "$work/some/report.json"; verdict "l_panel: they divided the body" $?
on 3
same zhou_2/scene.yaml 1000 moment --set spacing='1 mm' --set solver.dt='1e-7 s' --set solver.time_steps=400
on 2
same chen_cube/scene.yaml 50 moment --set spacing='4 mm' --set solver.end='0.45 ms'

# fronts of a body that is its own mirror image, which nothing holds along z: rounding, which is another one with every number of ranks, decides nothing
mirror=(--set spacing="$spacing" --set solver.max_events=2 --set 'output.pictures=[]' --set 'output.views=[]')
alone $data/cui_disk_10/scene_facets.yaml -o "$work/one" --force "${mirror[@]}"; verdict "mirror images: one process" $?
[ "$PERIGAL_TEST_SIZE" = long ] && numbers='2 3 8' || numbers='2'
for r in $numbers; do
    rm -rf "$work/some"
    ranks "$r" $data/cui_disk_10/scene_facets.yaml -o "$work/some" "${mirror[@]}" --set solver.linear=petsc \
        && alike 1e-8 "$work/one" "$work/some" cracks.csv; verdict "mirror images: the same facets on $r ranks" $?
    alike 1e-8 "$work/one" "$work/some" history.csv residual moment displacement_z; verdict "mirror images: the same loads on $r ranks" $?
done
finish

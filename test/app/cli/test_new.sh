#!/bin/bash
# test_new.sh BUILD: perigal new writes scenes that are the files of data/new, that pass check, and that run without a warning of a fault; what
# it refuses.
. "$(dirname "$0")/expect.sh"
root=$(realpath "$(dirname "$0")/../../..")
export OMP_THREAD_LIMIT=1 OPENBLAS_NUM_THREADS=1
cd "$work" || exit 1
long() { [ "$PERIGAL_TEST_SIZE" = long ]; }
kinds=$(cd "$root/data/new" && ls -d -- */ | tr -d /)
for kind in $kinds; do
    expect "new $kind" 0 "perigal run mine/$kind/scene.yaml" '' new "$kind" -o "mine/$kind"
    same=0; for f in "$root/data/new/$kind"/*; do cmp -s "$f" "mine/$kind/${f##*/}" || same=1; done
    verdict "$kind: the files of data/new" $same
    expect "$kind is one of the usage" 0 "$kind (" '' new --help
    case $kind in disk|plate) long || continue ;; esac   # these take longest
    expect "$kind is checked" 0 'the scene is valid' '' check "mine/$kind/scene.yaml" --quiet
    expect "$kind runs" 0 '' '*' run "mine/$kind/scene.yaml" -o "results/$kind" --threads 1 --quiet
    grep -q '"outcome": "done"' "results/$kind/report.json" && [ -s "results/$kind/result.e" ] && ls "results/$kind"/*.png > /dev/null
    verdict "$kind: done, with fields and pictures" $?
done
# cracks grow where the scene says that they do
for kind in beam $(long && echo disk) mesh explicit; do
    [ "$(wc -l < "results/$kind/events.csv")" -gt 100 ]; verdict "$kind: bonds break" $?
done
sed '/^body:/,/add:/d' mine/cloud/scene.yaml > mine/cloud/bare.yaml
expect 'points without shapes have no cells: integration at the nodes' 0 'cubic_spline kernel, nodal integration' '*' check mine/cloud/bare.yaml
expect 'without -o: a folder of that name' 0 'plate/scene.yaml' '' new plate
expect 'never over another file' 70 '' 'plate/scene.yaml exists already: choose another folder' new plate
expect 'a kind that is misspelt' 64 '' 'no kind plat (did you mean plate?); there are: beam, cloud' new plat
expect 'no kind' 64 '' 'needs one kind: beam' new
expect 'two kinds' 64 '' 'needs one kind' new beam plate
expect 'an option that is not there' 64 '' '--ot is no option' new beam --ot x
expect 'a folder that cannot be made' 70 '' 'plate/scene.yaml/x: cannot be made: Not a directory' new beam -o plate/scene.yaml/x
finish

#!/bin/bash
# test_kills.sh BUILD: some of the interrupted runs of make kills. PERIGAL_TEST_SIZE=short takes four kinds and those that found something, long the others and 64 more.
build=$1
case $build in *asan*|*tsan*) echo "ok 1 - # SKIP a sanitizer wants to be loaded first"; echo 1..1; exit 0 ;; esac
out=$(mktemp -d) || exit 1
trap 'rm -rf "$out"' EXIT
# python of the system: a plain python3 on the path may be a slow wrapper
python=/usr/bin/python3; [ -x "$python" ] || python=python3
[ -x "$build/perigal-mpi" ] || echo "# skipped: ranks (packages petsc-dev, mpi-default-dev and mpi-default-bin)"
kills() { "$python" "$(dirname "$0")/run" "$build" "$@" JOBS=1 OUT="$out"; }
if [ "$PERIGAL_TEST_SIZE" = long ]; then
    kills FROM=9 COUNT=8 TAP=1; code=$?
    kills FROM=101 COUNT=64 TAP=1 || code=1
    kills FROM=5 COUNT=4 TAP=1 || code=1
    exit $code
fi
kills FROM=1 COUNT=4 TAP=1; code=$?
# contact; a measurement of tips that was made twice; a preconditioner that the start of a resumed run had left; why a run ended; tips of a motion that
# nothing judged
n=5
for one in "21 contact" "16 facets" "20 facets" "256 facets" "605 running"; do
    kills FROM="${one% *}" COUNT=1 KIND="${one#* }" > "$out/said" && word=ok || { word="not ok" code=1; sed 's/^/# /' "$out/said"; }
    echo "$word $n - number ${one% *}, ${one#* }"; n=$((n + 1))
done
exit $code

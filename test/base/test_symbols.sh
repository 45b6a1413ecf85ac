#!/bin/bash
# test_symbols.sh BUILD: the shared library exports its own names (pg_...) and no other.
build=$1; n=0
check() {   # NAME, lines that should not be there
    n=$((n + 1))
    if [ -z "$2" ]; then echo "ok $n - $1"; else echo "not ok $n - $1"; sed 's/^/# /' <<< "$2"; fi
}
library=$build/libperigal.so.0
case $build in *release) ;; *) echo "ok 1 - skipped: sanitizers add names, make mutate shows all of them"; exit 0 ;; esac
[ -e "$library" ] || { echo "not ok 1 - there is no $library (make all)"; exit 1; }
exported=$(nm -D --defined-only "$library" | awk '{ print $3 }')
check "every exported name begins with pg_" "$(grep -v '^pg_' <<< "$exported")"
check "every exported name stands in a public header" \
    "$(comm -23 <(sort -u <<< "$exported") <(grep -ohE '[A-Za-z0-9_]+' include/perigal/*.h | sort -u))"
check "what users call is exported" "$(for name in pg_scene_load pg_problem_build pg_solver_step; do grep -qx "$name" <<< "$exported" || echo "$name"; done)"

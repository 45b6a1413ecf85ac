#!/bin/bash
# test_mex.sh BUILD: the compiled functions of matlab-compat in Octave, and that the same C is accepted with the signatures of MATLAB's MEX API.
# PERIGAL_TEST_SIZE=long: steps of one more kind, more rounds of memory.
# Skipped, with a line that says so, where there is no Octave, no package netcdf of it, or no mkoctfile (package octave-dev).
. "$(dirname "$0")/../app/cli/expect.sh"
root=$(realpath "$(dirname "$0")/../.."); build=$(realpath "$1")
octave=$(command -v octave-cli) || { echo "ok 1 - skipped: there is no octave-cli"; echo "1..1"; exit 0; }
"$octave" -qf --eval 'pkg load netcdf' > /dev/null 2>&1 || { echo "ok 1 - skipped: Octave has no package netcdf"; echo "1..1"; exit 0; }
command -v mkoctfile > /dev/null || { echo "ok 1 - skipped: there is no mkoctfile (package octave-dev)"; echo "1..1"; exit 0; }
case $build in *release) ;; *) echo "ok 1 - skipped: sanitizers cannot be loaded into Octave"; echo "1..1"; exit 0 ;; esac
make -s -C "$root" mex > "$work/out" 2>&1 || { echo "not ok 1 - make mex"; sed 's/^/# /' "$work/out"; exit 1; }
for c in "$root"/matlab-compat/mex/*.c; do
    gcc -std=c17 -D_POSIX_C_SOURCE=200809L -Wall -Wextra -Werror -fsyntax-only -I"$root/test/matlab/api" -I"$root/include" "$c" > "$work/out" 2>&1
    verdict "$(basename "$c") with MATLAB's signatures" $?
done
gcc -std=c17 -D_POSIX_C_SOURCE=200809L -I"$root/include" "$root/test/matlab/export_matrix.c" "$build/libperigal.a" \
    -lfftw3 -lyaml -ludunits2 -lm -lpthread -ldl -o "$work/export_matrix" 2> "$work/err" || { echo "not ok - export_matrix"; sed 's/^/# /' "$work/err"; exit 1; }
export OMP_THREAD_LIMIT=1 OPENBLAS_NUM_THREADS=1 PERIGAL="$perigal"
cd "$work" || exit 1
"$octave" -qf --eval "addpath ('$root/matlab-compat'); addpath ('$build/matlab'); addpath ('$root/test/matlab'); mex_checks ('$root', '$work')" 2> err | tee log
[ "${PIPESTATUS[0]}" -eq 0 ] || { echo "not ok - the checks did not come to their end"; sed 's/^/# /' err; exit 1; }
[ $bad -eq 0 ] && ! grep -q '^not ok' log

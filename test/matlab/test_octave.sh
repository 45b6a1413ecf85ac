#!/bin/bash
# test_octave.sh BUILD: the functions of matlab-compat in Octave: right answers, and errors with the right identifiers. Skipped, with a line
# that says so, where there is no Octave or no package netcdf of it.
. "$(dirname "$0")/../app/cli/expect.sh"
root=$(realpath "$(dirname "$0")/../..")
octave=$(command -v octave-cli) || { echo "ok 1 - skipped: there is no octave-cli"; echo "1..1"; exit 0; }
"$octave" -qf --eval 'pkg load netcdf' > /dev/null 2>&1 || { echo "ok 1 - skipped: Octave has no package netcdf"; echo "1..1"; exit 0; }
export OMP_THREAD_LIMIT=1 OPENBLAS_NUM_THREADS=1 PERIGAL="$perigal"
cd "$work" || exit 1
"$octave" -qf --eval "addpath ('$root/matlab-compat'); addpath ('$root/test/matlab'); checks ('$root', '$work')" 2> err | tee out
[ "${PIPESTATUS[0]}" -eq 0 ] || { echo "not ok - the checks did not come to their end"; sed 's/^/# /' err; exit 1; }
! grep -q '^not ok' out

#!/bin/bash
# test_package.sh BUILD: the Python package runs scenes and reads results; errors are of the right kind. Skipped, with a line that says so, where
# numpy or netCDF4 is missing.
. "$(dirname "$0")/../app/cli/expect.sh"
root=$(realpath "$(dirname "$0")/../..")
python=                                         # Debian's own packages belong to /usr/bin/python3, which need not be the first on PATH
for p in python3 /usr/bin/python3; do "$p" -c 'import numpy, netCDF4' 2> /dev/null && { python=$p; break; }; done
[ -n "$python" ] || { echo "ok 1 - skipped: Python has no numpy or no netCDF4"; echo "1..1"; exit 0; }
export OMP_THREAD_LIMIT=1 OPENBLAS_NUM_THREADS=1 PERIGAL="$perigal" PERIGAL_LIBRARY="$(dirname "$perigal")/libperigal.so.0" PYTHONPATH="$root/python" PYTHONDONTWRITEBYTECODE=1
cd "$work" && exec_status=0
"$python" "$root/test/python/checks.py" "$root" "$work" 2> err || exec_status=$?
[ $exec_status -eq 0 ] || { sed 's/^/# /' err; exit 1; }

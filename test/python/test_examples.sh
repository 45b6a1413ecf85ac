#!/bin/bash
# test_examples.sh BUILD: the examples of python/examples and matlab-compat/examples run and give the numbers of their README, the same in both
# languages. What is not installed is skipped, with a line that says so.
. "$(dirname "$0")/../cli/expect.sh"
root=$(realpath "$(dirname "$0")/../..")
export OMP_THREAD_LIMIT=1 OPENBLAS_NUM_THREADS=1 PERIGAL="$perigal" PYTHONPATH="$root/python" PYTHONDONTWRITEBYTECODE=1
python=
for p in python3 /usr/bin/python3; do "$p" -c 'import numpy, netCDF4' 2> /dev/null && { python=$p; break; }; done
octave=$(command -v octave-cli) && "$octave" -qf --eval 'pkg load netcdf' > /dev/null 2>&1 || octave=
runs_python() { "$python" -W ignore "$root/python/examples/$1.py" > "$work/out" 2> "$work/err"; }
runs_octave() {
    "$octave" -qf --eval "addpath ('$root/matlab-compat'); addpath ('$root/matlab-compat/examples'); warning ('off', 'all');
        if any (strcmp (available_graphics_toolkits (), 'gnuplot')), graphics_toolkit ('gnuplot'); end
        figure ('visible', 'off'); $1" > "$work/out" 2> "$work/err"
}
says() { # NAME PATTERN FILE...: what was printed, and what must be there
    local name=$1 pattern=$2 good=0 f; shift 2
    grep -q -- "$pattern" "$work/out" || good=1
    for f in "$@"; do [ -s "$f" ] || good=1; done
    verdict "$name" $good
}
examples() { # LANGUAGE
    mkdir -p "$work/$1" && cd "$work/$1" || exit 1
    local at=out/examples
    runs_$1 plate_with_hole; says "$1: plate with a hole" 'over that of the load: 2.39 ' $at/plate_with_hole/result.e
    runs_$1 convergence; says "$1: convergence" 'order.* 2.17' $at/convergence/sweep.csv
    runs_$1 own_criterion; says "$1: the program's criterion" 'factor 0.3895275833, by the program 0.3895275833'
    says "$1: an own criterion" 'weak direction: first break at load factor 0.3571'
    runs_$1 random_study; says "$1: study" 'mean 2.380 kN, standard deviation 6.1' $at/random_study/sweep.png
}
if [ -n "$python" ]; then examples python; else verdict "skipped: Python has no numpy or no netCDF4" 0; fi
if [ -n "$octave" ]; then examples octave; else verdict "skipped: there is no Octave, or no package netcdf of it" 0; fi
finish

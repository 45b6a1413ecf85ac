#!/bin/bash
# test_examples.sh BUILD: the examples of python/examples and matlab-compat/examples run and give the numbers of their README, the same in both
# languages; in short size each example in one of them, the program's criterion in both. What is not installed is skipped, with a line that says so.
. "$(dirname "$0")/../app/cli/expect.sh"
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
examples() { # LANGUAGE EXAMPLE...: these, in long size all
    mkdir -p "$work/$1" && cd "$work/$1" || exit 1
    local at=out/examples language=$1 name; shift
    [ "$PERIGAL_TEST_SIZE" = long ] && set -- plate_with_hole convergence own_criterion random_study
    for name in "$@"; do
        runs_$language $name
        case $name in
            plate_with_hole) says "$language: plate with a hole" 'over that of the load: 2.39 ' $at/plate_with_hole/result.e ;;
            convergence) says "$language: convergence" 'order.* 2.17' $at/convergence/sweep.csv ;;
            own_criterion) says "$language: the program's criterion" 'factor 0.3895275833, by the program 0.3895275833'
                           says "$language: an own criterion" 'weak direction: first break at load factor 0.3571' ;;
            random_study) says "$language: study" 'mean 2.380 kN, standard deviation 6.1' $at/random_study/sweep.png ;;
        esac
    done
}
if [ -n "$python" ]; then examples python plate_with_hole own_criterion; else verdict "skipped: Python has no numpy or no netCDF4" 0; fi
if [ -n "$octave" ]; then examples octave convergence own_criterion random_study; else verdict "skipped: there is no Octave, or no package netcdf of it" 0; fi
finish

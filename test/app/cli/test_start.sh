#!/bin/bash
# test_start.sh BUILD: what a run does not need is not loaded, and the environment is settled before libraries read it.
. "$(dirname "$0")/expect.sh"
cd "$(dirname "$0")" || exit 1
case $1 in *release) ;; *) echo "ok 1 - skipped: a linker of another build may keep what nobody calls"; exit 0 ;; esac

# Libraries that the program itself asks for. A function of BLAS, CHOLMOD, UMFPACK, cairo or netCDF that is called directly brings its library in
# again: it belongs into the table of linalg/suitesparse.h or io/picture/cairo_calls.h.
asked=$(readelf -d "$perigal" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p')
! grep -E 'cholmod|umfpack|openblas|blas|lapack|cairo|netcdf|gomp' <<< "$asked"; verdict "large libraries are not loaded at the start" $?
[ "$(ldd "$perigal" | wc -l)" -lt 16 ]; verdict "few libraries are" $?

loaded() {   # names of the libraries that a command loads, at any time
    LD_DEBUG=files "$perigal" "$@" 2>&1 > /dev/null | sed -n 's/.*calling init: .*\/\(lib[a-z_]*\).*/\1/p' | sort -u
}
explicit=$(loaded run moving.yaml --set 'solver={kind: verlet, end: 6 us}' -o "$work/explicit" --force --threads 1 --set output.pictures=[])
[ -s "$work/explicit/result.e" ]; verdict "an explicit run without pictures runs" $?
! grep -E 'cholmod|umfpack|openblas|cairo|netcdf|hdf5' <<< "$explicit"; verdict "and loads neither solvers nor cairo nor netCDF" $?
static=$(loaded run plate.yaml -o "$work/static" --force --threads 1 --set output.pictures=[] --set 'failure={criterion: none}')
grep -q cholmod <<< "$static" && ! grep -E 'cairo|netcdf|umfpack' <<< "$static"; verdict "a static run loads CHOLMOD alone" $?
drawn=$(loaded plot "$work/static" --out "$work/drawn.png")
grep -q cairo <<< "$drawn" && ! grep -E 'cholmod|openblas|netcdf' <<< "$drawn"; verdict "a picture loads cairo alone" $?

# The number of threads reaches the libraries, which read it from the environment when they are loaded. A small library of our own in front
# of the C library shows every variable that is set. One program only is started: setting them must not take a second start.
cat > "$work/shown.c" << 'C'
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdio.h>
int setenv (const char *name, const char *value, int overwrite)
{
    fprintf (stderr, "setenv %s=%s\n", name, value);
    return ((int (*) (const char *, const char *, int)) dlsym (RTLD_NEXT, "setenv")) (name, value, overwrite);
}
C
${CC:-gcc} -shared -fPIC -o "$work/shown.so" "$work/shown.c"; verdict "a library that shows the environment" $?
first() {   # the first number of threads that a run with these options sets
    env -u OMP_THREAD_LIMIT -u OPENBLAS_NUM_THREADS LD_PRELOAD="$work/shown.so" "$perigal" check plate.yaml "$@" 2>&1 > /dev/null \
        | sed -n 's/^setenv OPENBLAS_NUM_THREADS=//p' | head -1
}
[ "$(first --threads 3)" = 3 ] && [ "$(first --threads=3)" = 3 ] && [ "$(first --thr=5)" = 5 ] && [ "$(first --threads 2 --threads=4)" = 4 ]
verdict "--threads reaches the libraries, in every spelling" $?
set=$(env -u OMP_THREAD_LIMIT LD_PRELOAD="$work/shown.so" "$perigal" run plate.yaml -o "$work/set" --threads 2 --plain --set 'failure={criterion: none}' 2>&1 > /dev/null)
grep -q '^setenv OMP_THREAD_LIMIT=1$' <<< "$set" && [ "$(grep '^setenv OPENBLAS' <<< "$set" | tail -1)" = "setenv OPENBLAS_NUM_THREADS=1" ]
verdict "a small system is solved by one thread of BLAS" $?
of() { OMP_NUM_THREADS=$1 "$perigal" run plate.yaml -o "$work/of" --force --set output.pictures=[] "${@:2}" > "$work/out" 2>&1 && sed -n 's/.*"threads": \([0-9]*\).*/\1/p' "$work/of/report.json" | head -1; }
[ "$(of 3)" = 3 ] && [ "$(of 3 --threads 2)" = 2 ] && [ "$(of 0)" = "$(getconf _NPROCESSORS_ONLN)" ]; verdict "OMP_NUM_THREADS where no threads are asked for" $?
user=$(OMP_THREAD_LIMIT=2 LD_PRELOAD="$work/shown.so" "$perigal" check plate.yaml 2>&1 > /dev/null)
! grep -q '^setenv' <<< "$user"; verdict "what the user has settled is left alone" $?
finish

#!/bin/bash
# test_vtk.sh BUILD: fields of ranks as files of VTK: parts, named by a file for each moment, have the values of one process; a run that is ended and goes on
# among as many ranks leaves the bytes of one that nobody disturbed, and among others moments that are divided as those before have divided them.
. "$(dirname "$0")/ranks.sh"
. ./interrupt.sh
plate=(plate.yaml --set output.format=vtk --set spacing='2.5 mm' --set method.accept_inexact=yes --set solver.dt='3e-8 s' --set solver.time_steps=1000 --set output.at.rows=200 --set output.at.levels=10)
fields() { (cd "$1" && ls result* && cat result*) | cksum; }
same() { python3 -S vtk_same.py 1e-9 "$work/one" "$1" > "$work/out" 2> "$work/why"; }

alone "${plate[@]}" -o "$work/one" && [ "$(ls "$work/one"/result.*.vtu | wc -l)" -eq 10 ]; verdict "one process" $?
ranks 3 "${plate[@]}" -o "$work/three" && same "$work/three" && [ "$(sort -u "$work/out")" = "1 3" ]; verdict "three ranks: the same values in three parts" $?
[ "$(ls "$work/three"/result.*.pvtu | wc -l)" -eq 10 ] && [ ! -e "$work/three/ranks" ] && [ ! -e "$work/three/result.0000.vtu" ]; verdict "a file names the parts of each moment" $?
begin 60 "$work/some" "${plate[@]}"; kill -USR1 $run; ended; [ $code -eq 130 ]; verdict "a run that is ended" $?
cp -r "$work/some" "$work/moved"
ranks 3 "${plate[@]}" -o "$work/some" "${often[@]}" --resume && [ "$(fields "$work/three")" = "$(fields "$work/some")" ]; verdict "goes on among three to the same bytes" $?
alone "${plate[@]}" "${often[@]}" -o "$work/moved" --resume && same "$work/moved" && [ "$(sort -u "$work/out" | xargs)" = "1 1 1 3" ]
verdict "one process goes on behind the moments of three ranks" $?
finish

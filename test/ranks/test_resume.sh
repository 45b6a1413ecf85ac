#!/bin/bash
# test_resume.sh BUILD: runs of several ranks that are interrupted, killed as a whole, lose one rank or the disk of one rank go on from their
# checkpoints to the files of a run that nobody disturbed.
. "$(dirname "$0")/ranks.sh"
. ./interrupt.sh
explicit=(plate.yaml --set spacing='1.25 mm' --set solver.dt='1.5e-7 s' --set solver.time_steps=1200 --set output.at.rows=120 --set output.at.levels=12)
rest=(rest.yaml --set solver.steps=8 --set output.at.levels=8)
facets=(facets.yaml --set solver.linear=petsc)
long() { [ "$PERIGAL_TEST_SIZE" = long ]; }
# one row of many time steps, which ends in its middle
row=(plate.yaml --set spacing='2.5 mm' --set method.accept_inexact=yes --set solver.dt='3e-8 s' --set solver.time_steps=3000 --set output.at.rows=1 --set output.at.levels=1)

# pid DIR RANK: of its process, which the lock of its folder names
pid() { [ "$2" = 0 ] && cut -d' ' -f1 "$1/run.lock" || cut -d' ' -f1 "$1/ranks/$2/run.lock"; }
# same NAME DIR: goes on; then tables and fields are those of $work/NAME, byte by byte; where PETSc solves, which adds in the order in which
# messages come, so that two runs differ by rounding, to that
same() {
    local name=$1 dir=$2 f; shift 2
    declare -n arguments=$name
    ranks 3 "${arguments[@]}" -o "$dir" "${often[@]}" --resume || return 1
    if [ "$name" = explicit ] || [ "$name" = row ]; then
        for f in history.csv events.csv result.e; do cmp "$work/$name/$f" "$dir/$f" > "$work/why" 2>&1 || return 1; done
    else
        alike 1e-7 "$work/$name" "$dir" events.csv && alike 1e-8 "$work/$name" "$dir" history.csv residual force_x displacement_x moment || return 1
        python3 -S fields.py 1e-8 "$work/$name/result.e" "$dir/result.e" > "$work/why" 2>&1 || return 1
    fi
    counted "$work/$name" "$dir" && [ ! -e "$dir/ranks" ] && [ ! -e "$dir/checkpoint.nc" ] && [ ! -e "$dir/result.e.3.0" ]
}
for name in explicit row rest $(long && echo facets); do
    declare -n arguments=$name
    ranks 3 "${arguments[@]}" -o "$work/$name" "${often[@]}"; verdict "$name: the run that nobody disturbs" $?
done
grep -c '"peak_bytes"' "$work/explicit/report.json" | grep -q '^4$'; verdict "the report has the memory of each rank" $?

# in long size each way to end with explicit steps, one of them with the others
for way in "explicit signal" "explicit kill" "row signal" "rest kill" "facets signal"; do
    name=${way% *}
    case $way in 'explicit kill'|facets*) long || continue ;; esac
    declare -n arguments=$name
    case $name in explicit) rows=20 ;; row) rows=0 ;; *) rows=2 ;; esac
    if [ "${way#* }" = signal ]; then
        begin $rows "$work/some" "${arguments[@]}"; kill -USR1 $run; ended
        [ $code -eq 130 ] && grep -q 'continue with: mpirun -n 3 perigal-mpi run' "$work/err"; verdict "$name: a signal that mpirun passes on ends it, said how to go on" $?
    else
        begin $rows "$work/some" "${arguments[@]}"; left=$(pid "$work/some" 0; pid "$work/some" 1; pid "$work/some" 2)
        # without mpirun ranks may come to their end; those of rest are to leave checkpoints
        kill -KILL $run; [ $name = rest ] && kill -KILL $left 2> /dev/null; ended
        [ ! -e "$work/some/report.json" ]; verdict "$name: mpirun is killed" $?
        while kill -0 $left 2> /dev/null; do sleep 0.1; done
    fi
    [ $name = rest ] && cp -r "$work/some" "$work/rest3"
    same $name "$work/some"; verdict "$name: it goes on to the same files" $?
    rm -rf "$work/some"
done

begin 20 "$work/some" "${explicit[@]}"; kill -TERM "$(pid "$work/some" 1)"; ended
[ $code -eq 130 ]; verdict "a signal to one rank ends all" $?
cp -r "$work/some" "$work/half"

# other numbers of ranks, and one process: to rounding, with nothing left of the three
# moved NAME RANKS DIR: goes on there (0: without MPI), DIR being a copy
moved() {
    local name=$1 r=$2 dir=$3 share=1e-9 left=residual
    declare -n arguments=$name
    [ "$name" = rest ] && share=1e-8 left='residual force_x displacement_x moment'
    if [ "$r" = 0 ]; then alone "${arguments[@]}" "${often[@]}" -o "$dir" --resume; else ranks "$r" "${arguments[@]}" "${often[@]}" -o "$dir" --resume; fi || return 1
    grep -q 'the checkpoint was written by .* the last digits may differ' "$work/err" || return 1
    alike 1e-7 "$work/$name" "$dir" events.csv && alike $share "$work/$name" "$dir" history.csv $left || return 1
    python3 -S fields.py $share "$work/$name/result.e" "$dir/result.e" > "$work/why" 2>&1 || return 1
    [ ! -e "$dir/ranks" ] && [ ! -e "$dir/checkpoint.nc" ] && ! ls "$dir"/result.e.* > /dev/null 2>&1
}
for r in $(long && echo 4) 0; do
    cp -r "$work/half" "$work/moved"; moved explicit $r "$work/moved"; verdict "explicit: 3 ranks, then $r" $?
    rm -rf "$work/moved"
done
for r in 2 $(long && echo 0); do
    cp -r "$work/rest3" "$work/moved"; moved rest $r "$work/moved"; verdict "rest: 3 ranks, then $r" $?
    rm -rf "$work/moved"
done
"$perigal" run "${explicit[@]}" "${often[@]}" "${bare[@]}" -o "$work/moved" --quiet --threads 1 > "$work/out" 2> "$work/err" & run=$!
for k in $(seq 3000); do [ -e "$work/moved/checkpoint.nc" ] || ! kill -0 $run 2> /dev/null && break; sleep 0.02; done; kill -USR1 $run; ended
[ $code -eq 130 ] && moved explicit 2 "$work/moved"; verdict "explicit: one process, then 2 ranks" $?
rm -rf "$work/moved"
# two ranks go on, are killed between the renames of their first checkpoints, and three go on from that: rank 0 still has that of three under its
# name, beside the one of two, rank 1 that of two
soon=$(($(wc -l < "$work/half/history.csv") + 3))
cp -r "$work/half" "$work/moved"; number=2 begin $soon "$work/moved" "${explicit[@]}" --resume; kill -USR1 $run; ended
grep -q 'continue with: mpirun -n 2 perigal-mpi run' "$work/err"; verdict "two ranks in place of three are interrupted" $?
mv "$work/moved/checkpoint.nc" "$work/moved/checkpoint.nc.new"; cp "$work/half/checkpoint.nc" "$work/moved/"
mkdir -p "$work/moved/ranks/2"; cp "$work/half/ranks/2/checkpoint.nc" "$work/moved/ranks/2/"
moved explicit 3 "$work/moved"; verdict "killed while the checkpoints of two ranks took their places: three go on from these" $?
rm -rf "$work/moved" "$work/rest3"
long && { same explicit "$work/some"; verdict "the folder was left as it was" $?; }

# killed between the renames of two ranks: one has the newer checkpoint under its name, the other one beside it. The newer one is of the same run, as
# checkpoints are numbered within a run
cp -r "$work/half" "$work/later"; begin $soon "$work/later" "${explicit[@]}" --resume; kill -USR1 $run; ended
cp -r "$work/later" "$work/some1"; mv "$work/some1/ranks/1/checkpoint.nc" "$work/some1/ranks/1/checkpoint.nc.new"
cp "$work/half/ranks/1/checkpoint.nc" "$work/some1/ranks/1/"
same explicit "$work/some1"; verdict "killed while checkpoints were renamed: all ranks take the newer one" $?
# killed before all had written theirs: the newer one of one rank does not count
cp -r "$work/later" "$work/some2"; cp "$work/later/ranks/1/checkpoint.nc" "$work/some2/ranks/1/checkpoint.nc.new"
for r in . ranks/1 ranks/2; do cp "$work/half/$r/checkpoint.nc" "$work/some2/$r/"; done
same explicit "$work/some2"; verdict "killed while checkpoints were written: all ranks take the older one" $?
cp "$work/half/ranks/1/checkpoint.nc" "$work/later/ranks/1/"
ranks 3 "${explicit[@]}" "${often[@]}" -o "$work/later" --resume; [ $? -eq 70 ] && grep -q 'no checkpoint of one moment' "$work/err"
verdict "checkpoints of two moments are refused" $?
rm -rf "$work/later" "$work/half" "$work"/some*
# the first checkpoints of two runs have one number
long && for rows in 10 30; do
    "${launch[@]}" -n 3 "$mpi" run "${explicit[@]}" "${bare[@]}" -o "$work/first$rows" --quiet > "$work/out" 2> "$work/err" & run=$!
    for k in $(seq 3000); do [ "$(wc -l 2> /dev/null < "$work/first$rows/history.csv" || echo 0)" -gt $rows ] && break; sleep 0.02; done
    kill -USR1 $run; ended
done
if long; then
    cp "$work/first10/ranks/1/checkpoint.nc" "$work/first30/ranks/1/"
    ranks 3 "${explicit[@]}" -o "$work/first30" --resume; [ $? -eq 70 ] && grep -q 'no checkpoint of one moment' "$work/err"
    verdict "two moments under one number are refused" $?
    rm -rf "$work"/first*
fi

begin 20 "$work/some" "${explicit[@]}"; kill -KILL "$(pid "$work/some" 1)"; ended
[ $code -ne 0 ] && grep -q 'rank 1' "$work/err"; verdict "a rank that is killed ends the run, said which" $?
same explicit "$work/some"; verdict "its checkpoints serve" $?
rm -rf "$work/some"

# a file that one rank cannot write: the limit is far below what its fields will take
begin 20 "$work/some" "${explicit[@]}"; prlimit --pid "$(pid "$work/some" 1)" --fsize=$(($(stat -c %s "$work/some/result.e.3.1") + 2000)); ended
[ $code -eq 70 ] && grep -q 'result.e.3.1: File too large' "$work/err" && grep -q 'continue with: mpirun -n 3' "$work/err"; verdict "the disk of one rank is full: all end, said why and how to go on" $?
same explicit "$work/some"; verdict "with room they go on to the same files" $?
if long; then
    rm -rf "$work/some"
    begin 20 "$work/some" "${explicit[@]}"; prlimit --pid "$(pid "$work/some" 2)" --fsize=1000; ended
    [ $code -eq 70 ] && grep -q 'ranks/2/.*: File too large' "$work/err"; verdict "so do tables and checkpoints" $?
    same explicit "$work/some"; verdict "the checkpoints before it serve" $?
fi

# killed behind the end, when the folders of some ranks are gone already: the run is whole, and what the others left goes
mkdir -p "$work/some/ranks/2"; cp "$work/some/history.csv" "$work/some/report.json" "$work/some/ranks/2/"; cp "$work/some/result.e" "$work/some/result.e.3.0"
same explicit "$work/some"; verdict "what ranks left that were killed behind the end of their run goes" $?
# where the parts are the result they stay, and no other run's result.e does
cp "$work/some/result.e" "$work/old.e"
parts=("${row[@]}" --set output.join=no --set solver.time_steps=30 -o "$work/parts")
mkdir -p "$work/parts"; mv "$work/old.e" "$work/parts/result.e"
ranks 3 "${parts[@]}" --force && [ ! -e "$work/parts/result.e" ]; verdict "fields that stay in parts: the result.e of an earlier run goes" $?
mkdir -p "$work/parts/ranks/1"; ranks 3 "${parts[@]}" --resume && [ ! -e "$work/parts/ranks" ] && [ -e "$work/parts/result.e.3.2" ]
verdict "parts that are the result stay" $?

# what other numbers of ranks have left is not in the way
rm "$work/some/report.json"; mkdir -p "$work/some/ranks/7"; : > "$work/some/result.e.8.7"; mkdir -p "$work/some/ranks/3" "$work/some/ranks/4"
ranks 3 "${explicit[@]}" --set solver.time_steps=120 -o "$work/some" --force && [ ! -e "$work/some/ranks/3" ] && [ ! -e "$work/some/result.e.8.7" ]
verdict "an earlier run of more ranks leaves nothing" $?
finish

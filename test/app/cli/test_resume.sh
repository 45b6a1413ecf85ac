#!/bin/bash
# test_resume.sh BUILD: runs that are interrupted at random moments (short: 4 by TERM and 5 by KILL, long: 14 each, some again while they go on) and resumed end
# with the files of a run that nobody disturbed; finished, foreign and missing checkpoints; disks that are full or read-only.
. "$(dirname "$0")/expect.sh"
cd "$(dirname "$0")" || exit 1
trap 'umount "$work/small" 2> /dev/null; chmod -R u+w "$work"; rm -rf "$work"' EXIT
now() { date +%s%N; }
run() { "$perigal" run "$@" --quiet --threads 1 --set output.checkpoint='0.05 s' > "$work/out" 2> "$work/err"; }

event=(plate.yaml --set spacing='0.5 mm' --set solver.max_events=60 --set output.at.events=10)
fixed=(plate.yaml --set spacing='1.25 mm' --set 'solver={stepping: fixed, steps: 8, break: fraction, break_fraction: 2 %}'
       --set 'output={at: {broken: 2 %, levels: 4}}')
newmark=(moving.yaml); [ "$PERIGAL_TEST_SIZE" = long ] || newmark+=(--set solver.end='2.8 us')
explicit=(bonds.yaml)
dying=(bonds.yaml --set method.force=fcbm --set 'failure={fracture_energy: 21 J/m2}')
state=(bonds.yaml --set method.force=lps --set method.weighted_volume=live)
relaxed=(bonds.yaml --set 'solver={kind: adr, stages: 6}' --set 'boundary[1]={name: pull, set: right, displacement: {x: 60 um}}')
turning=(bonds.yaml --set method.force=gmpd --set materials.stone.poissons_ratio=0.2 --set 'failure={criterion: beam_limits, fracture_energy: 12 J/m2}'
         --set 'output.fields=[displacement, rotation, damage]')
swelling=(bonds.yaml --set method.force=gmpd --set method.volumetric=on --set method.weighted_volume=live --set materials.stone.poissons_ratio=0.4
          --set 'failure={criterion: beam_limits, fracture_energy: 12 J/m2}')

# same DIR1 DIR2: tables, fields and pictures byte by byte, report.json without times and memory
same() {
    for f in history.csv events.csv result.e damage.png load_displacement.png; do cmp "$1/$f" "$2/$f" || return 1; done
    diff <(plain "$1/report.json") <(plain "$2/report.json") || return 1
    [ ! -e "$2/checkpoint.nc" ] && [ ! -e "$2/checkpoint.nc.new" ]
}
plain() { sed -e '/"seconds": {/,/}/d' -e '/"peak_bytes"/d' -e '/"seconds_saved"/d' "$1"; }

declare -A took
for kind in event fixed newmark explicit relaxed dying state turning swelling; do
    declare -n scene=$kind; t0=$(now)
    run "${scene[@]}" -o "$work/$kind"; code=$?
    took[$kind]=$((($(now) - t0) / 1000000))
    verdict "$kind: the run that nobody disturbs (${took[$kind]} ms)" $code
done
[ "$(grep -c , "$work/fixed/history.csv")" -eq 9 ] && [ "$("$perigal" plot "$work/fixed" --list | grep -c '^ *[0-9]')" -gt 12 ]
verdict "stages in the middle of a step are in result.e, not in history.csv" $?

# disturb SIGNAL DELAY-MS ARGUMENTS...: 0 when the signal came before the end of the run
disturb() {
    local signal=$1 delay=$2; shift 2
    "$perigal" run "$@" --quiet --threads 1 --set output.checkpoint='0.05 s' > "$work/out" 2> "$work/err" & local pid=$!
    sleep "$(printf '%d.%03d' $((delay / 1000)) $((delay % 1000)))"
    kill -s "$signal" $pid 2> /dev/null
    wait $pid 2> /dev/null; code=$?
    [ $code -eq 130 ] || [ $code -eq 137 ] || [ $code -eq 143 ]        # 143: before the program listens
}
# resumed ARGUMENTS...: goes on; from the beginning where there was no checkpoint yet
resumed() {
    if [ -e "$out/checkpoint.nc" ]; then run "$@" --resume; else run "$@"; fi
}
RANDOM=20220
kinds=(event fixed newmark explicit relaxed)
numbers='1 4 7 10 13 21 24 25 28'; [ "$PERIGAL_TEST_SIZE" = long ] && numbers=$(seq 28)
for k in $numbers; do
    [ $k -le 20 ] && kind=${kinds[$((k % 5))]} || kind=dying
    [ $k -le 22 ] || kind=state
    [ $k -le 24 ] || kind=turning
    [ $k -le 26 ] || kind=swelling
    declare -n scene=$kind; out=$work/run$k; times=1
    [ $((k % 2)) -eq 0 ] && signal=TERM || signal=KILL
    limit=${took[$kind]}
    until disturb $signal $((limit * (RANDOM % 900 + 80) / 1000)) "${scene[@]}" -o "$out"; do limit=$((limit * 3 / 4 + 1)); done
    if [ $((k % 4)) -lt 2 ] && [ -e "$out/checkpoint.nc" ]; then      # once or twice more
        for _ in $(seq $((RANDOM % 2 + 1))); do
            disturb $signal $((limit * (RANDOM % 500 + 50) / 1000)) "${scene[@]}" -o "$out" --resume && times=$((times + 1))
            [ -e "$out/checkpoint.nc" ] || break
        done
    fi
    if [ $signal = TERM ] && [ -e "$out/checkpoint.nc" ]; then grep -q -- '--resume\|the same command begins anew' "$work/err" || [ ! -s "$work/err" ]; verdict "$k $kind: TERM tells how to go on" $?; fi
    if grep -q '"outcome": "done"' "$out/report.json" 2> /dev/null && [ ! -e "$out/checkpoint.nc" ]; then code=0; else resumed "${scene[@]}" -o "$out"; code=$?; fi
    same "$work/$kind" "$out" > "$work/why" 2>&1; other=$?
    verdict "$k $kind: $times times $signal, then the files of an undisturbed run" $((code + other))
    rm -rf "$out"
done

# ---- before the first step: nothing to go on with, and nothing that a picture would show
early=(plate.yaml --set spacing='0.2 mm'); delay=200
for _ in $(seq 20); do                                 # 143: before the program listens; else after its first step
    disturb TERM $delay "${early[@]}" -o "$work/early"
    [ $code -eq 130 ] && [ ! -e "$work/early/checkpoint.nc" ] && break
    [ $code -eq 143 ] && delay=$((delay * 3 / 2)) || delay=$((delay / 2))
    rm -rf "$work/early"
done
[ $code -eq 130 ] && grep -q 'the same command begins anew' "$work/err" && ! grep -q -- --resume "$work/err"
verdict "TERM before the first step: said, and what to do" $?
! ls "$work/early"/*.png > /dev/null 2>&1; verdict "no pictures of nothing" $?
run plate.yaml -o "$work/early"; code=$?; [ $code -eq 0 ] && [ -s "$work/early/damage.png" ]; verdict "the same command begins anew" $?

# ---- refusals
"$perigal" run "${event[@]}" --quiet --threads 1 --set output.checkpoint='0.05 s' -o "$work/event" --resume > "$work/out" 2> "$work/err"
verdict "a finished run has nothing to go on with" $?
run plate.yaml -o "$work/none" --resume; [ $? -eq 64 ] && grep -q 'no .*checkpoint.nc' "$work/err" && [ ! -e "$work/none" ]
verdict "no checkpoint: said, nothing made" $?
# killed before its first checkpoint, it begins anew; so it does not in the folder of another scene
longer=("${newmark[@]}" --set output.checkpoint=0); delay=$((took[newmark] * 6 / 10))
until "$perigal" run "${longer[@]}" --quiet --threads 1 -o "$work/killed" > "$work/out" 2> "$work/err" & pid=$!
    sleep "$(printf '%d.%03d' $((delay / 1000)) $((delay % 1000)))"; kill -KILL $pid 2> /dev/null; wait $pid 2> /dev/null; [ $? -eq 137 ] && [ -e "$work/killed/history.csv" ]
do [ -e "$work/killed/report.json" ] && delay=$((delay / 2)) || delay=$((delay * 3 / 2 + 1)); rm -rf "$work/killed"; done
"$perigal" run "${longer[@]}" --set solver.dt='1e-7 s' --quiet --threads 1 -o "$work/killed" --resume > "$work/out" 2> "$work/err"
[ $? -eq 64 ] && grep -q 'no .*checkpoint.nc' "$work/err"; verdict "killed before its first checkpoint: another scene is refused" $?
"$perigal" run "${longer[@]}" --quiet --threads 1 -o "$work/killed" --resume > "$work/out" 2> "$work/err"; code=$?
[ $code -eq 0 ] && grep -q 'before its first checkpoint: it begins anew' "$work/err" && cmp "$work/newmark/history.csv" "$work/killed/history.csv" > "$work/why" 2>&1 && [ ! -e "$work/killed/run.lock" ]
verdict "it begins anew by --resume, to the files of an undisturbed run" $?
delay=$((took[event] * 7 / 10))
for _ in $(seq 60); do                                 # too late: earlier; before there was anything to go on with: later
    if ! disturb TERM $delay "${event[@]}" -o "$work/half"; then delay=$((delay * 9 / 10)); continue; fi
    [ -e "$work/half/checkpoint.nc" ] && break
    delay=$((delay * 11 / 10 + 5))
done
[ $code -eq 130 ] && grep -q 'continue with: perigal run plate.yaml -o .*--set .spacing=0.5 mm. .*--resume' "$work/err"; verdict "TERM: exit code 130 and the command to go on" $?
grep -q '"outcome": "interrupted' "$work/half/report.json"; verdict "TERM: the report tells it" $?
sum=$(cd "$work/half" && cat checkpoint.nc history.csv result.e | cksum)
run "${event[@]}" --set solver.tie=1e-9 -o "$work/half" --resume; [ $? -eq 64 ] && grep -q 'of another scene' "$work/err" && [ "$sum" = "$(cd "$work/half" && cat checkpoint.nc history.csv result.e | cksum)" ]
verdict "a changed scene is refused, the folder stays" $?
head -c 3000 "$work/half/checkpoint.nc" > "$work/cut" && cp -r "$work/half" "$work/torn" && cp "$work/cut" "$work/torn/checkpoint.nc"
run "${event[@]}" -o "$work/torn" --resume; [ $? -eq 70 ] && grep -q 'checkpoint.nc' "$work/err"; verdict "a torn checkpoint is refused" $?
run "${event[@]}" -o "$work/half"; [ $? -eq 64 ] && grep -q 'holds an unfinished run' "$work/err"; verdict "without --resume or --force it is not replaced" $?
run "${event[@]}" -o "$work/half" --force; code=$?; same "$work/event" "$work/half" > "$work/why" 2>&1; verdict "with --force it begins anew" $((code + $?))

# ---- disks: limited file size (EFBIG), a small disk (ENOSPC), a folder that cannot be written
readable() { "$perigal" plot "$1" --list > /dev/null 2>&1 && head -1 "$1/history.csv" | grep -q 'load_factor' && [ "$(tail -c 1 "$1/history.csv" | od -An -c | tr -d ' ')" = '\n' ]; }
(ulimit -f $(($(stat -c %s "$work/fixed/result.e") * 6 / 10240)); exec "$perigal" run "${fixed[@]}" --quiet --threads 1 --set output.checkpoint='0.05 s' -o "$work/limited") > "$work/out" 2> "$work/err"
[ $? -eq 70 ] && grep -q 'File too large' "$work/err"; verdict "a file that may not grow: exit code 70 and the reason" $?
readable "$work/limited"; verdict "its results are readable" $?
[ ! -e "$work/limited/checkpoint.nc" ] || { run "${fixed[@]}" -o "$work/limited" --resume && same "$work/fixed" "$work/limited"; } > "$work/why" 2>&1; verdict "it can be gone on with" $?
mkdir "$work/small"
if mount -t tmpfs -o size=400k tmpfs "$work/small" 2> /dev/null; then
    run "${event[@]}" --set 'output.at.events=1' -o "$work/small/out"
    [ $? -eq 70 ] && grep -q 'No space left' "$work/err"; verdict "a full disk: exit code 70 and the reason" $?
    readable "$work/small/out"; verdict "its results are readable" $?
    if [ -e "$work/small/out/checkpoint.nc" ]; then
        cp -r "$work/small/out" "$work/moved"; run "${event[@]}" --set 'output.at.events=1' -o "$work/moved" --resume; code=$?
        run "${event[@]}" --set 'output.at.events=1' -o "$work/whole"; same "$work/whole" "$work/moved" > "$work/why" 2>&1; verdict "moved to a larger disk it goes on" $((code + $?))
    fi
    mount -o remount,ro "$work/small"
    run "${event[@]}" -o "$work/small/out" --force; [ $? -eq 70 ] && grep -q 'small/out.*Read-only' "$work/err"; verdict "a read-only disk: exit code 70 and the reason" $?
    umount "$work/small"
fi
finish

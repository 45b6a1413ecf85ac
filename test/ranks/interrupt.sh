# interrupt.sh, for test_resume*.sh to read after ranks.sh: runs that go on beside the test, which ends them when they have come to some row.
often=(--set output.checkpoint='0.01 s')
# begin ROWS DIR ARGUMENTS...: a run on 3 ranks, or on $number (mpirun: $run) that goes on when this returns, history.csv having so many rows, all ranks a checkpoint
begin() {
    local rows=$1 dir=$2 k; shift 2
    "${launch[@]}" -n "${number:-3}" "$mpi" run "$@" -o "$dir" --quiet "${often[@]}" "${bare[@]}" > "$work/out" 2> "$work/err" & run=$!
    for k in $(seq 3000); do
        [ "$(wc -l 2> /dev/null < "$dir/history.csv" || echo 0)" -gt "$rows" ] && [ -e "$dir/checkpoint.nc" ] && [ -e "$dir/ranks/$((${number:-3} - 1))/checkpoint.nc" ] && return
        kill -0 $run 2> /dev/null || break
        sleep 0.02
    done
    return 1
}
ended() { wait $run 2> /dev/null; code=$?; }
